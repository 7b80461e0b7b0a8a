"""`ehdmaps stability`: contacts and readers at the extremes of what they may be given, as a table."""

from __future__ import annotations

import argparse
from pathlib import Path

from ehdmaps.errors import InputError
from ehdmaps.jobs.reader import read_job
from ehdmaps.jobs.stability_contact import contact_checks
from ehdmaps.jobs.stability_readers import READERS
from ehdmaps.outputs import Output, output_problems
from ehdmaps.program import tell
from ehdmaps.stability.findings import Check
from ehdmaps.stability.fuzzing import fuzz
from ehdmaps.stability.report import CHECKS, checks_json, checks_text, write_checks
from ehdmaps.units import closest

_CONTACT = "contact"


def run(arguments: argparse.Namespace) -> tuple[str, int]:
    """Search; status 1 where something failed."""
    job = read_job(arguments.job)
    problems = output_problems([Output("-o", arguments.output, CHECKS)], [arguments.job])
    names = (_CONTACT, *READERS)
    if arguments.only is not None and arguments.only not in names:
        problems.append(
            f"--only: got {arguments.only!r:.60}{closest(arguments.only, names)}; allowed: {', '.join(names)}"
        )
    if problems:
        raise InputError(problems)
    checks: list[Check] = []
    if arguments.only in (None, _CONTACT):
        checks += contact_checks(job, arguments.points, arguments.seed, arguments.openfoam, _told)
    for name, make in READERS.items():
        if arguments.only in (None, name):
            _told(f"{arguments.mutations} damaged files for: {name}")
            checks.append(fuzz(make(), arguments.mutations, arguments.seed))
    head = f"{job.title}, {job.lubricant.title}, seed {arguments.seed}"
    if arguments.output is not None:
        write_checks(Path(arguments.output), head, checks)
    text = checks_json(checks) if arguments.json else f"{head}\n{checks_text(checks)}"
    return text, 1 if any(check.failed for check in checks) else 0


def _told(line: str) -> None:
    """Tell how far it is."""
    tell(f"ehdmaps stability: {line}")
