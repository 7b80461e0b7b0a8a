"""Calls of a contact law outside its map: how many, along which axis, on which side, and how far."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.maps.kernel import EDGE_TOLERANCE, LOAD_TOLERANCE

Axis = Literal["load", "entrainment_speed", "temperature"]
Side = Literal["above", "below"]

UNITS = {"load": "N/m", "entrainment_speed": "m/s", "temperature": "K"}


@dataclass(frozen=True)
class Excursion:
    """Calls beyond one end of one axis of the map.

    Attributes
    ----------
    axis : {"load", "entrainment_speed", "temperature"}
    side : {"above", "below"}
        Speeds are never below: films of lower ones are part of the law. Loads are where the film there is a guess, see
        `ehdmaps.maps.low_loads`.
    calls : int
        How many points.
    extreme : float
        The one farthest outside [N/m], [m/s], [K]; loads without the part of damping.
    limit : float
        End of the map on this axis.
    """

    axis: Axis
    side: Side
    calls: int
    extreme: float
    limit: float

    @property
    def text(self) -> str:
        """In words, such as 'load 1.2e+06 N/m above the map, which ends at 1e+06 N/m'."""
        unit, ends = UNITS[self.axis], "ends" if self.side == "above" else "begins"
        about = f"{self.extreme:.6g} {unit}"
        return f"{self.axis} {about} {self.side} the map, which {ends} at {self.limit:.6g} {unit}"

    def __add__(self, other: Excursion) -> Excursion:
        farthest = max if self.side == "above" else min
        return replace(self, calls=self.calls + other.calls, extreme=farthest(self.extreme, other.extreme))


@dataclass(frozen=True)
class Range:
    """What is known along an axis; `low` is -inf where nothing can be below."""

    axis: Axis
    low: float
    high: float

    def excursions(self, values: FloatArray) -> list[Excursion]:
        """What of some values lies outside."""
        tolerance = LOAD_TOLERANCE if self.axis == "load" else EDGE_TOLERANCE
        values = np.abs(values) if self.axis == "entrainment_speed" else values
        above = values[values > self.high * (1.0 + tolerance)]
        # no load at all is no question of films
        below = values[(values < self.low * (1.0 - tolerance)) & (values > 0.0)] if self.low > 0.0 else values[:0]
        found = []
        if above.size:
            found.append(Excursion(self.axis, "above", int(above.size), float(np.max(above)), self.high))
        if below.size:
            found.append(Excursion(self.axis, "below", int(below.size), float(np.min(below)), self.low))
        return found
