"""`stability` of both programs: contacts, bearings, integrator and readers at the extremes, as a table."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterator, Mapping
from functools import partial

from ehdmaps.errors import DependencyError
from ehdmaps.jobs.reader import read_job
from ehdmaps.program import tell
from mbs.laboratory.extremes.bearings import element_checks
from mbs.laboratory.extremes.check import Check, searched
from mbs.laboratory.extremes.contacts import contact_checks
from mbs.laboratory.extremes.fuzzing import Reader, fuzz
from mbs.laboratory.extremes.integrator import integrator_checks
from mbs.laboratory.extremes.machine_readers import READERS
from mbs.laboratory.extremes.map_readers import READERS as MAP_READERS


def run(arguments: argparse.Namespace) -> tuple[str, int]:
    """`mbs stability`: bearing element, integrator and readers; status 1 where something failed."""
    runs, seed = arguments.runs, arguments.seed
    parts: dict[str, Callable[[], Iterator[Check]]] = {
        "element": lambda: element_checks(runs, seed),
        "integrator": lambda: integrator_checks(runs, seed),
        "readers": lambda: _damaged(READERS, arguments),
    }
    return searched(
        arguments,
        {name: partial(_announced, f"mbs stability: {name}", make) for name, make in parts.items()},
        f"law, bearing element, integrator and readers of mbs, seed {seed}",
    )


def run_contacts(arguments: argparse.Namespace) -> tuple[str, int]:
    """`ehdmaps stability`: contacts and readers; status 1 where something failed."""
    job, seed = read_job(arguments.job), arguments.seed
    parts: dict[str, Callable[[], Iterator[Check]]] = {
        "contact": lambda: contact_checks(
            job, arguments.points, seed, arguments.openfoam, lambda line: tell(f"ehdmaps stability: {line}")
        )
    }
    for name, make in MAP_READERS.items():
        words = f"ehdmaps stability: {arguments.mutations} damaged files for: {name}"
        parts[name] = partial(_announced, words, partial(_damaged, {name: make}, arguments))
    return searched(arguments, parts, f"{job.title}, {job.lubricant.title}, seed {seed}", arguments.job)


def _announced(words: str, make: Callable[[], Iterator[Check]]) -> Iterator[Check]:
    """Say what is searched, and search it."""
    tell(words)
    yield from make()


def _damaged(readers: Mapping[str, Callable[[], Reader]], arguments: argparse.Namespace) -> Iterator[Check]:
    """Give readers damaged files; there is no case where one needs a package that is not installed."""
    for name, make in readers.items():
        try:
            yield fuzz(make(), arguments.mutations, arguments.seed)
        except DependencyError as error:
            yield Check(f"{name}, damaged", 0, 0, 0, f"not tried: {error}")
