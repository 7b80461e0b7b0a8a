"""`mbs stability`: law, bearing element, integrator and readers at the extremes, as a table."""

from __future__ import annotations

import argparse

from ehdmaps.errors import InputError
from ehdmaps.outputs import Output, output_problems
from ehdmaps.program import tell
from ehdmaps.stability.findings import CHECKS, Check, told, unknown_part
from mbs.instruments.element import element_checks
from mbs.instruments.integrator import integrator_checks
from mbs.instruments.readers import reader_checks

PARTS = ("element", "integrator", "readers")


def run(arguments: argparse.Namespace) -> tuple[str, int]:
    """Search; status 1 where something failed."""
    problems = output_problems([Output("-o", arguments.output, CHECKS)], [])
    problems += unknown_part(arguments.only, PARTS)
    if problems:
        raise InputError(problems)
    parts = PARTS if arguments.only is None else (arguments.only,)
    checks: list[Check] = []
    for part in parts:
        tell(f"mbs stability: {part}")
        if part == "element":
            checks += element_checks(arguments.runs, arguments.seed)
        elif part == "integrator":
            checks += integrator_checks(arguments.runs, arguments.seed)
        else:
            checks += reader_checks(arguments.mutations, arguments.seed)
    head = f"law, bearing element, integrator and readers of mbs, seed {arguments.seed}"
    return told(head, checks, arguments.output, arguments.json)
