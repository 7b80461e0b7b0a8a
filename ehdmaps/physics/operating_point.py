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
        Oil temperature [K], > 0.

    Raises
    ------
    InputError
        If a value is not finite or out of these limits.
    """

    load: float
    entrainment_speed: float
    temperature: float

    def __post_init__(self) -> None:
        problems = []
        if not (math.isfinite(self.load) and self.load > 0):
            problems.append(f"load: got {self.load!r} N/m; allowed: finite and > 0")
        if not (math.isfinite(self.entrainment_speed) and self.entrainment_speed >= 0):
            problems.append(
                f"entrainment_speed: got {self.entrainment_speed!r} m/s; allowed: finite and >= 0; give its magnitude"
            )
        if not (math.isfinite(self.temperature) and self.temperature > 0):
            problems.append(f"temperature: got {self.temperature!r} K; allowed: finite and > 0 K")
        if problems:
            raise InputError(problems)
