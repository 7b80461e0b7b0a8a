"""Interference fits of bearing rings, and what they and the temperature of the rings leave of a bearing's clearance.

A ring that is pressed on a shaft grows at its raceway, one that is pressed into a housing shrinks there. Ring, shaft
and housing are taken as cylinders of one length in plane stress (Lame's thick rings): the inner ring from its seat to
its raceway, the outer ring from its raceway to its seat. With the interference I of the diameters, the pressure
between an inside cylinder (diameters a to s, E_1, nu_1) and an outside one (s to b, E_2, nu_2) is

    p = I / {s [((b^2 + s^2)/(b^2 - s^2) + nu_2)/E_2 + ((s^2 + a^2)/(s^2 - a^2) - nu_1)/E_1]},

the outside diameter b grows by 2 p b s^2/(E_2 (b^2 - s^2)), and the bore a shrinks by 2 p a s^2/(E_1 (s^2 - a^2)).

A diameter d grows by alpha d (T - 20 degC). Rings have the temperature of their raceways, and their seats have it too;
rollers have the mean of both raceways. Left out: the growth of rings by their rotation, lobing, and the roughness of
seats, which flattens and takes some micrometres of interference.

References
----------
S. Timoshenko, J. N. Goodier, Theory of Elasticity, McGraw-Hill, 1951, "Stress distribution symmetrical about an axis".
T. A. Harris, M. N. Kotzalas, Essential Concepts of Bearing Technology, CRC, 2007, "Interference fitting and clearance".
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from ehdmaps.errors import InputError
from ehdmaps.physics.bearing import BearingGeometry
from ehdmaps.physics.solids import STEEL, Material
from ehdmaps.units import LENGTH

REFERENCE_TEMPERATURE = 293.15
"""Where clearances and interferences are measured [K]: 20 degC, ISO 1."""

STEEL_EXPANSION = 11.7e-6
"""Coefficient of thermal expansion of bearing steel [1/K]; Harris and Kotzalas."""

EXPANSIONS = (-1e-5, 1e-4)
"""Coefficients of expansion that an input may state [1/K]."""


def pressed_on(
    inside: Material, outside: Material, bore: float, seat: float, outer: float, interference: float
) -> tuple[float, float]:
    """What the press fit of two cylinders does: growth of the outside diameter, and shrinkage of the bore [m].

    Parameters
    ----------
    inside, outside : Material
        Materials of both cylinders.
    bore, seat, outer : float
        Diameters a < s < b [m]; a = 0 for a solid shaft.
    interference : float
        I [m], of the diameters; <= 0 is a loose fit, which does nothing.

    Examples
    --------
    The inner ring of an NU308, pressed on a solid shaft of steel: 77 % of the interference arrive at the raceway.

    >>> growth, _ = pressed_on(STEEL, STEEL, 0.0, 40e-3, 52e-3, 10e-6)
    >>> round(1e6 * growth, 2)
    7.69
    """
    if interference <= 0.0:
        return 0.0, 0.0
    ring = (outer**2 + seat**2) / (outer**2 - seat**2) + outside.poisson_ratio
    core = (seat**2 + bore**2) / (seat**2 - bore**2) - inside.poisson_ratio
    pressure = interference / (seat * (ring / outside.youngs_modulus + core / inside.youngs_modulus))
    growth = 2.0 * pressure * outer * seat**2 / (outside.youngs_modulus * (outer**2 - seat**2))
    shrinkage = 2.0 * pressure * bore * seat**2 / (inside.youngs_modulus * (seat**2 - bore**2))
    return growth, shrinkage


@dataclass(frozen=True)
class Seat:
    """What a ring sits on: a shaft, or a housing.

    Attributes
    ----------
    interference : float
        Interference of the diameters of ring and seat at 20 degC [m]; negative for a loose fit.
    diameter : float
        Diameter of the seat [m].
    far_diameter : float
        Bore of the shaft, 0 for a solid one; or outside diameter of the housing [m].
    material : Material
        Material of shaft or housing.
    expansion : float
        Coefficient of thermal expansion of shaft or housing [1/K].
    """

    interference: float
    diameter: float
    far_diameter: float
    material: Material = STEEL
    expansion: float = STEEL_EXPANSION

    def interference_at(self, temperature: float, ring_expansion: float, *, holds: bool) -> float:
        """Interference where ring and seat are warm [m].

        Parameters
        ----------
        temperature : float
            Temperature of both [K].
        ring_expansion : float
            Coefficient of thermal expansion of the ring [1/K].
        holds : bool
            Whether the seat holds the ring inside it, as a housing does.
        """
        apart = (self.expansion - ring_expansion) * self.diameter * (temperature - REFERENCE_TEMPERATURE)
        return self.interference + (-apart if holds else apart)


@dataclass(frozen=True)
class Mounting:
    """How a bearing is mounted, and how its rings expand.

    Attributes
    ----------
    shaft, housing : Seat or None
        What the inner and the outer ring sit on; None where the fit is part of the stated clearance.
    expansion : float
        Coefficient of thermal expansion of rings and rollers [1/K].
    """

    shaft: Seat | None = None
    housing: Seat | None = None
    expansion: float = STEEL_EXPANSION

    def problems(self, geometry: BearingGeometry) -> list[str]:
        """In which dimensions seats and rings do not fit together.

        Parameters
        ----------
        geometry : BearingGeometry
            Raceways of the bearing.
        """
        inner, outer = geometry.inner_raceway_diameter, geometry.outer_raceway_diameter
        problems = []
        if self.shaft is not None and not 0.0 <= self.shaft.far_diameter < self.shaft.diameter < inner:
            problems.append(
                f"fit of the inner ring: got a bore of {LENGTH.text(self.shaft.far_diameter)} and a seat of "
                f"{LENGTH.text(self.shaft.diameter)}; allowed: bore < seat < inner raceway, {LENGTH.text(inner)}"
            )
        if self.housing is not None and not outer < self.housing.diameter < self.housing.far_diameter:
            problems.append(
                f"fit of the outer ring: got a seat of {LENGTH.text(self.housing.diameter)} and a housing of "
                f"{LENGTH.text(self.housing.far_diameter)} outside; allowed: outer raceway, {LENGTH.text(outer)} < "
                "seat < outside of the housing"
            )
        return problems


@dataclass(frozen=True)
class Clearance:
    """The diametral clearance of a bearing in operation.

    Attributes
    ----------
    stated : float
        Clearance of the bearing at 20 degC, before it is mounted [m].
    by_temperature, by_fits : float
        What the expansion of raceways and rollers, and what the fits add to it [m].
    """

    stated: float
    by_temperature: float = 0.0
    by_fits: float = 0.0

    @property
    def operating(self) -> float:
        """In operation [m]; negative where the rollers are preloaded."""
        return self.stated + self.by_temperature + self.by_fits


def operating_clearance(
    geometry: BearingGeometry, mounting: Mounting, inner: float, outer: float, ring: Material = STEEL
) -> Clearance:
    """The clearance of a mounted bearing with warm rings.

    Parameters
    ----------
    geometry : BearingGeometry
        Raceways, rollers, and the stated clearance.
    mounting : Mounting
        Fits and expansion.
    inner, outer : float
        Temperatures of inner and outer ring [K].
    ring : Material
        Material of the rings.

    Raises
    ------
    InputError
        If seats and rings do not fit together.

    Examples
    --------
    An inner ring that is 5 K warmer than the outer one takes alpha d_m 5 K of an NU308's clearance:

    >>> found = operating_clearance(BearingGeometry.named("NU308"), Mounting(), 328.15, 323.15)
    >>> round(1e6 * found.by_temperature, 3)
    -3.861
    """
    problems = mounting.problems(geometry)
    if problems or not (math.isfinite(inner) and math.isfinite(outer)):
        raise InputError(problems or [f"temperatures of the rings: got {inner!r} and {outer!r} K; allowed: finite"])
    warm_inner, warm_outer = inner - REFERENCE_TEMPERATURE, outer - REFERENCE_TEMPERATURE
    raceways = geometry.outer_raceway_diameter * warm_outer - geometry.inner_raceway_diameter * warm_inner
    rollers = 2.0 * geometry.roller_diameter * 0.5 * (warm_inner + warm_outer)
    fits = 0.0
    if (seat := mounting.shaft) is not None:
        tight = seat.interference_at(inner, mounting.expansion, holds=False)
        fits -= pressed_on(
            seat.material, ring, seat.far_diameter, seat.diameter, geometry.inner_raceway_diameter, tight
        )[0]
    if (seat := mounting.housing) is not None:
        tight = seat.interference_at(outer, mounting.expansion, holds=True)
        fits -= pressed_on(
            ring, seat.material, geometry.outer_raceway_diameter, seat.diameter, seat.far_diameter, tight
        )[1]
    return Clearance(geometry.diametral_clearance, mounting.expansion * (raceways - rollers), fits)
