"""`mbs stability`: law, bearing element, integrator and readers at the extremes, as a table."""

from __future__ import annotations

import argparse
from pathlib import Path

from ehdmaps.errors import InputError
from ehdmaps.outputs import Output, output_problems
from ehdmaps.program import tell
from ehdmaps.stability.findings import Check
from ehdmaps.stability.report import CHECKS, checks_json, checks_text, write_checks
from ehdmaps.units import closest
from mbs.stability.element import element_checks
from mbs.stability.integrator import integrator_checks
from mbs.stability.readers import reader_checks

PARTS = ("element", "integrator", "readers")


def run(arguments: argparse.Namespace) -> tuple[str, int]:
    """Search; status 1 where something failed."""
    problems = output_problems([Output("-o", arguments.output, CHECKS)], [])
    if arguments.only is not None and arguments.only not in PARTS:
        problems.append(
            f"--only: got {arguments.only!r:.60}{closest(arguments.only, PARTS)}; allowed: {', '.join(PARTS)}"
        )
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
    if arguments.output is not None:
        write_checks(Path(arguments.output), head, checks)
    text = checks_json(checks) if arguments.json else f"{head}\n{checks_text(checks)}"
    return text, 1 if any(check.failed for check in checks) else 0
