"""`stability` of both programs: contacts, bearings and integrator at the extremes, as a table."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterator
from functools import partial

from ehdmaps.jobs.reader import read_job
from ehdmaps.program import tell
from mbs.laboratory.extremes.bearings import element_checks
from mbs.laboratory.extremes.check import Check, searched
from mbs.laboratory.extremes.contacts import contact_checks
from mbs.laboratory.extremes.integrator import integrator_checks


def run(arguments: argparse.Namespace) -> tuple[str, int]:
    """`mbs stability`: bearing element and integrator; status 1 where something failed."""
    runs, seed = arguments.runs, arguments.seed
    parts: dict[str, Callable[[], Iterator[Check]]] = {
        "element": lambda: element_checks(runs, seed),
        "integrator": lambda: integrator_checks(runs, seed),
    }
    return searched(
        arguments,
        {name: partial(_announced, f"mbs stability: {name}", make) for name, make in parts.items()},
        f"law, bearing element and integrator of mbs, seed {seed}",
    )


def run_contacts(arguments: argparse.Namespace) -> tuple[str, int]:
    """`ehdmaps stability`: contacts; status 1 where something failed."""
    job, seed = read_job(arguments.job), arguments.seed

    def contacts() -> Iterator[Check]:
        yield from contact_checks(
            job, arguments.points, seed, arguments.openfoam, lambda line: tell(f"ehdmaps stability: {line}")
        )

    return searched(arguments, {"contact": contacts}, f"{job.title}, {job.lubricant.title}, seed {seed}", arguments.job)


def _announced(words: str, make: Callable[[], Iterator[Check]]) -> Iterator[Check]:
    """Say what is searched, and search it."""
    tell(words)
    yield from make()
