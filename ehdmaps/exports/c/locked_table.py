"""Locked film of a map, as a table over speed, temperature and load for programs without the map.

`ContactLaw.locked_factors` reads the responses of the films in the map. An export has its factors at places that are
even in ln u, 1/(T - `COLDEST`) and ln of the load, and goes straight between them.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.maps.kernels.locked_film import FORMULA, LockedFactors
from ehdmaps.maps.kernels.tables import COLDEST
from ehdmaps.maps.law import ContactLaw

SPEED_STEP, LOAD_STEP = 0.25, 0.1
"""Largest steps of ln u and of ln of the load. With them a quick change of load of the shipped map's law is right
within 1e-3, where the law itself is right within some 5 %."""

TEMPERATURES = 11
"""Places of the temperature, where a map has more than one."""

_DIGITS = 6
_STANDSTILL = 1e-300


@dataclass(frozen=True)
class Axis:
    """Even places.

    Attributes
    ----------
    start : float
        The first one.
    per_step : float
        Inverse distance of two; 0 where there is one.
    count : int
        How many.
    """

    start: float
    per_step: float
    count: int

    @classmethod
    def over(cls, first: float, last: float, count: int) -> Axis:
        """Places from one to another; one place where they are alike.

        Parameters
        ----------
        first, last : float
            The ends.
        count : int
            How many, if the ends differ.
        """
        return cls(first, (count - 1) / (last - first), count) if last != first else cls(first, 0.0, 1)

    @property
    def places(self) -> FloatArray:
        """All places, shape (count,)."""
        return self.start + np.arange(self.count) / (self.per_step or 1.0)

    def between(self, place: float) -> tuple[int, int, float]:
        """Neighbours of a place, which is held at the ends, and the weight of the second one.

        Parameters
        ----------
        place : float
            The place on the axis.
        """
        held = min(max((place - self.start) * self.per_step, 0.0), self.count - 1.0)
        first = min(int(held), max(self.count - 2, 0))
        return first, min(first + 1, self.count - 1), held - first


@dataclass(frozen=True, eq=False)
class LockedTable:
    """Factors of the closed formula of the locked film.

    Attributes
    ----------
    speeds, temperatures, loads : Axis
        Places of ln u, of 1/(T - `COLDEST`) and of ln of the load [N/m].
    factors : array (n_u, n_T, n_w)
        The factors there.
    """

    speeds: Axis
    temperatures: Axis
    loads: Axis
    factors: FloatArray

    def at(self, entrainment_speed: float, temperature: float) -> LockedFactors:
        """Factors over the load at a speed and temperature, as the export has them.

        Parameters
        ----------
        entrainment_speed, temperature : float
            u [m/s], of either sign, and T [K]; held at the ends of the table.
        """
        i, up, a = self.speeds.between(math.log(max(abs(entrainment_speed), _STANDSTILL)))
        j, on, b = self.temperatures.between(1.0 / (temperature - COLDEST))
        low, high = (self.factors[k, j] + b * (self.factors[k, on] - self.factors[k, j]) for k in (i, up))
        values = low + a * (high - low)
        return LockedFactors(self.loads.start, self.loads.per_step, values if values.size > 1 else np.repeat(values, 2))


def locked_table(law: ContactLaw) -> LockedTable:
    """Table of the factors of a law, over the speeds and temperatures of its map.

    Parameters
    ----------
    law : ContactLaw
        The law.
    """
    (slow, fast), (cold, hot) = law.speed_range, law.temperature_range
    begin, end = (math.log(u) if u > 0.0 else 0.0 for u in (slow, fast))
    speeds = Axis.over(begin, end, 2 + math.ceil((end - begin) / SPEED_STEP))
    temperatures = Axis.over(1.0 / (cold - COLDEST), 1.0 / (hot - COLDEST), TEMPERATURES)
    known = [
        [law.locked_factors(float(u), float(T)) for T in 1.0 / temperatures.places + COLDEST]
        for u in np.exp(speeds.places)
    ]
    if any(factors is FORMULA for line in known for factors in line):
        return LockedTable(Axis(begin, 0.0, 1), Axis(temperatures.start, 0.0, 1), Axis(0.0, 0.0, 1), np.ones((1, 1, 1)))
    lowest, highest = min(factors.lowest for line in known for factors in line), math.log(law.load_range[1])
    loads = Axis.over(lowest, highest, 2 + math.ceil((highest - lowest) / LOAD_STEP))
    table = np.array([[np.interp(loads.places, _loads(factors), factors.values) for factors in line] for line in known])
    # with fewer digits: a file of them is a third as long
    rounded = np.array([float(f"{value:.{_DIGITS}g}") for value in table.reshape(-1).tolist()]).reshape(table.shape)
    return LockedTable(speeds, temperatures, loads, rounded)


def _loads(factors: LockedFactors) -> FloatArray:
    """Places of factors in ln of the load."""
    return np.asarray(factors.lowest + np.arange(factors.values.size) / factors.per_log)
