"""`ehdmaps length`: load and pressure over the length of a roller, beside finite elements."""

from __future__ import annotations

import argparse
from pathlib import Path

from ehdmaps.errors import InputError
from ehdmaps.jobs.reader import read_job
from ehdmaps.jobs.show.solids_plot import length_figure
from ehdmaps.jobs.show.solids_report import length_text
from ehdmaps.outputs import FIGURE, Output, output_problems, write_figure
from ehdmaps.program import tell
from ehdmaps.solids.three_d_compare import compare_lengths
from ehdmaps.solids.three_d_reference import make_reference, read_reference, save_reference, shipped_reference


def run(arguments: argparse.Namespace) -> tuple[str, int]:
    """Compare, or make the finite elements anew first."""
    job = read_job(arguments.job)
    bearing = job.bearing
    problems = output_problems([Output("--plot", arguments.plot, FIGURE)], [arguments.job])
    if bearing is None:
        problems.append(f"{arguments.job}: is the job of a bare [contact]; allowed: one with [bearing]")
    if arguments.solve is not None and arguments.reference is not None:
        problems.append("--solve, --reference: got both; allowed: one; --solve shows what it has written")
    if arguments.solve is not None and Path(arguments.solve).suffix.lower() != ".json":
        problems.append(f"--solve: got {arguments.solve!r:.80}; allowed: a new file that ends with .json")
    if problems or bearing is None:
        raise InputError(problems)
    lines = []
    if arguments.solve is not None:
        tell("ehdmaps length: finite elements on three meshes; minutes of one core, and some gigabytes")
        reference = make_reference(bearing)
        save_reference(reference, Path(arguments.solve))
        lines.append(f"{arguments.solve}: written")
    elif arguments.reference is not None:
        reference = read_reference(arguments.reference)
    else:
        reference = shipped_reference(bearing.name)
    cases = compare_lengths(reference, bearing)
    lines = length_text(reference, cases) + lines
    if arguments.plot is not None:
        write_figure(length_figure(reference, cases), arguments.plot)
        lines.append(f"{arguments.plot}: written")
    return "\n".join(lines), 0
