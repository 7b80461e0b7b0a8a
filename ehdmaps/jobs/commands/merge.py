"""`ehdmaps merge`: the map of a job, or the maps of a batch, from the stores of shards."""

from __future__ import annotations

import argparse

from ehdmaps.jobs.commands import generate
from ehdmaps.jobs.shards import merged_text
from ehdmaps.jobs.work import merge, read_work


def run(arguments: argparse.Namespace) -> tuple[str, int]:
    """Merge, and make the maps where nothing is missing; status 1 where something is."""
    work = read_work(arguments.job, arguments.output, arguments.solver)
    merged = merge(work)
    text = merged_text(merged, work.source)
    if not merged.whole and not arguments.rest:
        advice = "no map is made; run the shards that are missing, or have the rest solved here with --rest"
        return f"{text}\n{advice}", 1
    made, status = generate.run(
        argparse.Namespace(
            jobs=[arguments.job],
            output=arguments.output,
            solver=arguments.solver,
            tolerance=None,
            workers=arguments.workers,
            fresh=False,
            fresh_films=False,
            keep_cases=None,
            shard=None,
        )
    )
    return f"{text}\n{made}" if made else text, status
