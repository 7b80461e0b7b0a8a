"""Settings of a run-up's Campbell diagram; light to import, because reading a scene needs them."""

from __future__ import annotations

import math
from dataclasses import dataclass

from ehdmaps.errors import InputError

HIGHEST = 5000.0
"""Highest frequency where none is given [Hz]."""


@dataclass(frozen=True)
class CampbellSettings:
    """Settings of a Campbell diagram.

    Attributes
    ----------
    sensor : str or None
        Name of a sensor; None for the first one of an acceleration.
    highest : float
        Highest frequency [Hz].
    window : float or None
        Length of the windows [s]; None for the one in which the highest order sweeps by the width of a line.
    orders : tuple of float
        Orders to draw and to follow; empty for those that the gears or bearings of the system make.

    Raises
    ------
    InputError
        With every value that is not possible.
    """

    sensor: str | None = None
    highest: float = HIGHEST
    window: float | None = None
    orders: tuple[float, ...] = ()

    def __post_init__(self) -> None:
        problems = []
        if not (math.isfinite(self.highest) and self.highest > 0.0):
            problems.append(f"campbell, highest: got {self.highest!r} Hz; allowed: finite and > 0")
        if self.window is not None and not (math.isfinite(self.window) and self.window > 0.0):
            problems.append(f"campbell, window: got {self.window!r} s; allowed: finite and > 0")
        if not all(math.isfinite(order) and order > 0.0 for order in self.orders):
            problems.append(f"campbell, orders: got {list(self.orders)!r:.80}; allowed: finite numbers > 0")
        if problems:
            raise InputError(problems)
