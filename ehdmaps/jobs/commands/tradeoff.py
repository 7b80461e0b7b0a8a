"""`ehdmaps tradeoff`: speed against accuracy of the solvers and settings, measured on a sample of a job."""

from __future__ import annotations

import argparse

from ehdmaps.jobs.reader import read_job
from ehdmaps.jobs.tradeoff import contestants, measure, table


def run(arguments: argparse.Namespace) -> tuple[str, int]:
    """Measure and print the table."""
    job = read_job(arguments.job)
    entries, reference = contestants(job)
    measured, truth = measure(job, arguments.lines, entries, reference)
    points = truth.solved if not measured else max(truth.solved, *(entry.solved for entry in measured))
    return f"{job.title}, {job.lubricant.title}\n{table(measured, truth, points)}", 0
