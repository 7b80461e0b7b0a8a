"""`ehdmaps stability`: contacts and readers at the extremes of what they may be given, as a table."""

from __future__ import annotations

import argparse

from ehdmaps.errors import InputError
from ehdmaps.jobs.instruments.stability_contact import contact_checks
from ehdmaps.jobs.instruments.stability_readers import READERS
from ehdmaps.jobs.reader import read_job
from ehdmaps.outputs import Output, output_problems
from ehdmaps.program import tell
from ehdmaps.stability.findings import CHECKS, Check, told, unknown_part
from ehdmaps.stability.fuzzing import fuzz

_CONTACT = "contact"


def run(arguments: argparse.Namespace) -> tuple[str, int]:
    """Search; status 1 where something failed."""
    job = read_job(arguments.job)
    problems = output_problems([Output("-o", arguments.output, CHECKS)], [arguments.job])
    names = (_CONTACT, *READERS)
    problems += unknown_part(arguments.only, names)
    if problems:
        raise InputError(problems)
    checks: list[Check] = []
    if arguments.only in (None, _CONTACT):
        checks += contact_checks(job, arguments.points, arguments.seed, arguments.openfoam, _announce)
    for name, make in READERS.items():
        if arguments.only in (None, name):
            _announce(f"{arguments.mutations} damaged files for: {name}")
            checks.append(fuzz(make(), arguments.mutations, arguments.seed))
    head = f"{job.title}, {job.lubricant.title}, seed {arguments.seed}"
    return told(head, checks, arguments.output, arguments.json)


def _announce(line: str) -> None:
    """Tell how far it is."""
    tell(f"ehdmaps stability: {line}")
