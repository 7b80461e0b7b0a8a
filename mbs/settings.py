"""Settings of the analyses: what a scene file may say of them, and what they take. Light to import.

A reader of scenes needs these classes and nothing of the analyses themselves.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import InputError, Problems
from mbs.model.profiles import SpeedProfile

MOST_SPEEDS = 2000
"""Speeds of a sweep."""

CAGE_ANGLES, MOST_ANGLES = 4, 1000
"""Cage angles over which linear analyses average where none are asked for, and the most that may be asked for."""

NUMERICS = "numerics"
"""What `--bands` is called that leaves bands of what is not known out."""

HIGHEST = 5000.0
"""Highest frequency of a Campbell diagram where none is given [Hz]."""


LOWEST_HIGHEST, HIGHEST_HIGHEST = 1.0, 1e6
"""Limits of the highest frequency [Hz]."""

SHORTEST, LONGEST = 1e-6, 1e3
"""Limits of the window of a Campbell diagram [s]."""


ROUND_OFF = 1e-12
"""Size below which a part or a ratio is shown as zero: round-off."""


@dataclass(frozen=True)
class Settings:
    """Settings of the integration.

    Attributes
    ----------
    step : float
        Longest time step [s].
    sample : float
        Time between recorded states [s]; a whole multiple of the step.
    spectral_radius : float
        Spectral radius at the highest frequencies, 0 to 1: 1 dissipates nothing, 0 all of it within a step.
    tolerance : float
        Largest error a step may make in a coordinate [m or rad], by estimate; steps are halved where it is larger.
        Infinite: steps are equal.
    residual : float
        Remaining force after Newton, as a part of the forces in the system.

    Raises
    ------
    InputError
        With every value that is not possible.
    """

    step: float
    sample: float
    spectral_radius: float = 0.8
    tolerance: float = math.inf
    residual: float = 1e-10

    def __post_init__(self) -> None:
        problems = Problems()
        if not (math.isfinite(self.step) and self.step > 0.0):
            problems.append(f"integration, step: got {self.step!r} s; allowed: finite and > 0")
        elif not (math.isfinite(self.sample) and _whole(self.sample / self.step)):
            problems.append(
                f"integration, sample: got {self.sample!r} s; allowed: a whole multiple of the step {self.step!r} s"
            )
        if not 0.0 <= self.spectral_radius <= 1.0:
            problems.append(f"integration, spectral_radius: got {self.spectral_radius!r}; allowed: 0 to 1")
        if not self.tolerance > 0.0:
            problems.append(f"integration, tolerance: got {self.tolerance!r}; allowed: > 0 (m or rad)")
        if not 0.0 < self.residual < 1.0:
            problems.append(f"integration, residual: got {self.residual!r}; allowed: between 0 and 1")
        problems.check()

    @property
    def steps_per_sample(self) -> int:
        """Number of steps between recorded states."""
        return round(self.sample / self.step)


@dataclass(frozen=True)
class RunUp:
    """Speed over time, and how to integrate.

    Attributes
    ----------
    speed : SpeedProfile
        Prescribed speed.
    duration : float
        [s].
    settings : Settings
        Steps and method.
    """

    speed: SpeedProfile
    duration: float
    settings: Settings


@dataclass(frozen=True)
class SweepRange:
    """Speeds of a sweep, equally far apart.

    Attributes
    ----------
    begin, end : float
        Lowest and highest speed [rad/s].
    points : int
        How many.

    Raises
    ------
    InputError
        If they do not rise from 0 on, or are too few or too many.
    """

    begin: float
    end: float
    points: int

    def __post_init__(self) -> None:
        problems = Problems()
        if not 2 <= self.points <= MOST_SPEEDS:
            problems.append(f"points: got {self.points}; allowed: a whole number from 2 to {MOST_SPEEDS}")
        if not 0.0 <= self.begin < self.end < np.inf:
            problems.append(
                f"from, to: got {self.begin:.6g} to {self.end:.6g} rad/s; allowed: rising, from 0 rpm on; exchange "
                "them, or set them apart"
            )
        problems.check()

    @property
    def speeds(self) -> FloatArray:
        """All of them, shape (points,) [rad/s]."""
        return np.linspace(self.begin, self.end, self.points)


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
        problems = Problems()
        if not (math.isfinite(self.highest) and self.highest > 0.0):
            problems.append(f"campbell, highest: got {self.highest!r} Hz; allowed: finite and > 0")
        if self.window is not None and not (math.isfinite(self.window) and self.window > 0.0):
            problems.append(f"campbell, window: got {self.window!r} s; allowed: finite and > 0")
        if not all(math.isfinite(order) and order > 0.0 for order in self.orders):
            problems.append(f"campbell, orders: got {list(self.orders)!r:.80}; allowed: finite numbers > 0")
        problems.check()


def _whole(ratio: float) -> bool:
    """Tell whether a ratio is a whole number >= 1, to rounding."""
    return round(ratio) >= 1 and abs(ratio - round(ratio)) <= 1e-6 * ratio


def check_cage_angles(where: str, count: int) -> None:
    """Refuse a number of cage angles that is not possible.

    Parameters
    ----------
    where : str
        What asks, for the message.
    count : int
        The number.

    Raises
    ------
    InputError
        If it is not one from 1 to `MOST_ANGLES`.
    """
    if not 1 <= count <= MOST_ANGLES:
        raise InputError(f"{where}, cage angles: got {count}; allowed: a whole number from 1 to {MOST_ANGLES}")
