"""Notes of what the readers of jobs and scenes ask for: keys by tables, with what is allowed."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, field
from typing import Any
from unittest.mock import patch

from ehdmaps.jobs.table import Table

_INDEX = re.compile(r"\[\d+\]")
_LIMITED = ("quantity", "quantity_of", "number", "integer", "choice")


@dataclass
class Reading:
    """How a key is read: what is allowed, in words, and whether it must be there wherever it is asked for.

    Attributes
    ----------
    required : bool
        It must be there wherever it is asked for.
    form : str
        What a message says that a missing key should be.
    allowed : list of str
        Limits, or words, of each way in which it is read.
    """

    required: bool = True
    form: str = ""
    allowed: list[str] = field(default_factory=list)


Readings = dict[str, dict[str, Reading]]
"""Readings by tables, as messages call them, and by keys."""


@contextmanager
def recording() -> Iterator[Readings]:
    """Note all that tables are asked for while this is open."""
    found: Readings = {}

    def reading(table: Table, key: str) -> Reading:
        return found.setdefault(_INDEX.sub("", table.where), {}).setdefault(_INDEX.sub("", key), Reading())

    def get(self: Table, key: str, required: str = "") -> Any:
        entry = reading(self, key)
        entry.required &= bool(required)
        entry.form = entry.form or required
        return original["get"](self, key, required)

    def limited(method: str) -> Callable[..., Any]:
        def read(self: Table, *arguments: Any, **words: Any) -> Any:
            key, *limits = arguments[1:] if method == "quantity_of" else arguments
            allowed = reading(self, key).allowed
            if (text := _allowed(method, *limits)) not in allowed:
                allowed.append(text)
            return original[method](self, *arguments, **words)

        return read

    original: dict[str, Callable[..., Any]] = {name: getattr(Table, name) for name in ("get", *_LIMITED)}
    with ExitStack() as stack:
        stack.enter_context(patch.object(Table, "get", get))
        for name in _LIMITED:
            stack.enter_context(patch.object(Table, name, limited(name)))
        yield found


def _allowed(method: str, *limits: Any) -> str:
    """What a reading method allows, by its arguments behind the key."""
    if method == "choice":
        return ", ".join(f'`"{word}"`' for word in limits[0])
    if method.startswith("quantity"):
        _, low, high, display = limits
        return f"{shortest(display.value(low))} to {shortest(display.value(high))} {display.unit}"
    low, high = limits
    return f"{shortest(low)} to {shortest(high)}{', whole' if method == 'integer' else ''}"


def shortest(value: float) -> str:
    """A number in four digits, without the signs and zeros of its exponent."""
    return re.sub(r"e([-+])0*", lambda sign: "e-" if sign[1] == "-" else "e", f"{value:.4g}")
