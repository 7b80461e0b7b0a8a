"""What a bearing is in operation: temperatures, clearance, friction, and where its heat goes."""

from __future__ import annotations

import math
from dataclasses import dataclass

from mbs.bearings.fits import Clearance


@dataclass(frozen=True)
class BearingHeat:
    """Friction of a bearing and where it goes, all in W.

    Attributes
    ----------
    rolling : float
        Friction of the films, or of Palmgren's viscous torque in their place.
    added : float
        What the scene adds.
    to_shaft, to_housing, to_oil : float
        Heat that goes there; negative where it comes from there.
    """

    rolling: float
    added: float
    to_shaft: float
    to_housing: float
    to_oil: float

    @property
    def friction(self) -> float:
        """All of the friction [W]."""
        return self.rolling + self.added

    @property
    def left(self) -> float:
        """Friction that nothing carries away [W]: what the balance is not closed by."""
        return self.friction - self.to_shaft - self.to_housing - self.to_oil


@dataclass(frozen=True)
class BearingState:
    """A bearing in operation.

    Attributes
    ----------
    name : str
        Name of the bearing.
    inner, outer : float
        Temperatures of the raceways [K].
    clearance : Clearance
        Diametral clearance.
    oil : float
        Temperature of the oil in the bearing [K]; NaN where no oil flows through it.
    heat : BearingHeat or None
        Friction and where it goes; None where the temperatures are given.
    """

    name: str
    inner: float
    outer: float
    clearance: Clearance
    oil: float = math.nan
    heat: BearingHeat | None = None

    @property
    def film_temperature(self) -> float:
        """Temperature of the law [K]: the mean of both raceways."""
        return 0.5 * (self.inner + self.outer)
