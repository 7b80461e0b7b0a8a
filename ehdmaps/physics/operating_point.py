"""Where on the map: load, speed and temperature of one contact."""

from __future__ import annotations

import math
from dataclasses import dataclass

from ehdmaps.errors import InputError

OIL_TEMPERATURES = (213.15, 573.15)
"""Lowest and highest temperature that an input may give to an oil, -60 and 300 degC [K]: a number beyond stands in
the wrong unit. The laws of an oil break down earlier, and say so."""


@dataclass(frozen=True)
class OperatingPoint:
    """One point of a map.

    Attributes
    ----------
    load : float
        Load per unit length w [N/m], > 0.
    entrainment_speed : float
        Mean u of the two surface speeds [m/s], >= 0 (the contact does not care about the sign).
    temperature : float
        Temperature of both surfaces, and so of the oil between them [K], > 0.

    Raises
    ------
    InputError
        If a value is no number, not finite or out of these limits.
    """

    load: float
    entrainment_speed: float
    temperature: float

    def __post_init__(self) -> None:
        problems = []
        for name, unit, allowed, standstill in (
            ("load", "N/m", "finite and > 0", False),
            ("entrainment_speed", "m/s", "finite and >= 0; give its magnitude", True),
            ("temperature", "K", "finite and > 0 K", False),
        ):
            value = getattr(self, name)
            try:
                possible = math.isfinite(value) and (value > 0 or (standstill and value == 0))
            except (TypeError, OverflowError):
                problems.append(f"{name}: got {value!r:.60}, no number of type float; allowed: [{unit}], {allowed}")
            else:
                if not possible:
                    problems.append(f"{name}: got {value!r} {unit}; allowed: {allowed}")
        if problems:
            raise InputError(problems)
