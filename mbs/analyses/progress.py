"""How an analysis tells how far it is."""

from __future__ import annotations

from collections.abc import Callable

Progress = Callable[[int, int], None]
"""Called with what is done and what there is to do in all: first with (0, total), last with (total, total)."""


def silent(done: int, total: int) -> None:
    """Tell nobody."""
