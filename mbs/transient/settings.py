"""How a run in time is integrated: a light module, which reading a scene needs."""

from __future__ import annotations

import math
from dataclasses import dataclass

from ehdmaps.errors import InputError


@dataclass(frozen=True)
class Settings:
    """How to integrate.

    Attributes
    ----------
    step : float
        Longest time step [s].
    sample : float
        Time between recorded states [s]; a whole multiple of the step.
    spectral_radius : float
        Of the highest frequencies, 0 to 1: 1 dissipates nothing, 0 all of it within a step.
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
        problems = []
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
        if problems:
            raise InputError(problems)

    @property
    def steps_per_sample(self) -> int:
        """How many steps lie between recorded states."""
        return round(self.sample / self.step)


def _whole(ratio: float) -> bool:
    """Whether a ratio is a whole number >= 1, to rounding."""
    return round(ratio) >= 1 and abs(ratio - round(ratio)) <= 1e-6 * ratio
