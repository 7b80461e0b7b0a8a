"""`ehdmaps submit`: the script of a job array that makes shards, or the array submitted."""

from __future__ import annotations

import argparse
from pathlib import Path

from ehdmaps.jobs.cluster import Array, check_shards, script, submit
from ehdmaps.jobs.work import read_work


def run(arguments: argparse.Namespace) -> tuple[str, int]:
    """Print the script, or submit."""
    array = Array(arguments.array, arguments.cpus, arguments.time, arguments.partition)
    work = read_work(arguments.job, arguments.output, arguments.solver)
    check_shards(work, array)
    if arguments.submit:
        return submit(work, arguments.solver, array), 0
    return script(work, arguments.solver, array, Path.cwd()), 0
