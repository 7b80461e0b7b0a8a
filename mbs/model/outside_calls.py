"""Calls outside the map during a piece of work, from counters that only rise."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager


@contextmanager
def calls_outside(counters: Callable[[], Mapping[str, int]]) -> Iterator[dict[str, int]]:
    """Count calls outside the map by what the counters have risen when the block ends.

    Parameters
    ----------
    counters : callable
        Gives how often each element was outside so far, by name, such as ``lambda: model.outside_calls``.

    Yields
    ------
    dict of str to int
        Calls by element; empty until the block has ended.
    """
    before = dict(counters())
    found: dict[str, int] = {}
    yield found
    found.update({name: calls - before[name] for name, calls in counters().items()})
