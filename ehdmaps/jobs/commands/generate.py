"""`ehdmaps generate`: make a map, or go on with one."""

from __future__ import annotations

import argparse
from pathlib import Path

from ehdmaps.errors import InputError
from ehdmaps.jobs import solvers
from ehdmaps.jobs.generate import generate
from ehdmaps.jobs.law_check import unmet
from ehdmaps.jobs.progress import progress
from ehdmaps.jobs.reader import is_map, read_job
from ehdmaps.jobs.report import holes
from ehdmaps.jobs.store import store_path
from ehdmaps.jobs.summary import summary
from ehdmaps.jobs.tolerance import read_tolerance, unmet_tolerance
from ehdmaps.outputs import MAP, Output, check_outputs
from ehdmaps.program import tell

INTERRUPTED = 130
"""Exit status after Ctrl-C, as shells have it."""


def run(arguments: argparse.Namespace) -> tuple[str, int]:
    """Make the map; status 1 if points have no solution, or a contact law is not as good as it should be."""
    tolerance = None if arguments.tolerance is None else read_tolerance(arguments.tolerance)
    job = read_job(arguments.job, arguments.solver, to_run=True)
    if arguments.output is None and is_map(arguments.job):
        raise InputError(f"-o: missing; {arguments.job} is a map itself; give the map to write with -o")
    output = Path(arguments.output or f"{job.name}.nc")
    check_outputs([Output("-o", output, MAP)], [arguments.job])
    solver = solvers.build(job.solver, {**job.solver_options, **solvers.case_options(job.solver, arguments.keep_cases)})
    try:
        generated = generate(job, output, arguments.workers, arguments.fresh, progress, solver, tolerance)
    except KeyboardInterrupt:
        tell(f"\nstopped; what is solved is kept in {store_path(output)}: the same command goes on from there")
        return "", INTERRUPTED
    missed = [
        *unmet(generated.dataset, generated.backbone is not None),
        *unmet_tolerance(generated.dataset.attrs),
    ]
    return "\n".join([summary(generated, output), *missed]), 1 if holes(generated.dataset) or missed else 0
