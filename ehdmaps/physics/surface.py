"""Surfaces of rollers: the profile along them, and the roughness of both surfaces together.

What asperities carry is in `ehdmaps.maps.rough_layer`.

References
----------
J. A. Greenwood, J. H. Tripp, "The contact of two nominally flat rough surfaces", Proc. IMechE 185, 1970, 625: the
statistics of asperities. Usual values of eta sigma beta (0.03 to 0.05) and sigma/beta (0.0001 to 0.01) of steel: M.
Teodorescu, S. Balakrishnan, H. Rahnejat, "Integrated tribological analysis within a multi-physics approach to system
dynamics", Tribology and Interface Engineering Series 48, 2005, 725.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from types import MappingProxyType

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import InputError, Problems

_LONG = 2.5


def iso_profile(x: FloatArray, roller_diameter: float, roller_length: float) -> FloatArray:
    """Profile of a roller: how far its surface lies below the cylinder, on one side [m].

    P(x) = 0.00035 D ln(1/(1 - (2x/L)^2)) for L <= 2.5 D. Longer rollers are straight in the middle, with
    P(x) = 0.0005 D ln(1/(1 - ((2|x| - (L - 2.5 D))/(2.5 D))^2)) outside it.

    Parameters
    ----------
    x : array
        Distance from the middle of the roller [m], |x| < L/2.
    roller_diameter, roller_length : float
        D and L [m].

    References
    ----------
    ISO/TS 16281:2008; DIN 26281:2010.

    Examples
    --------
    A quarter of the length from the middle of the roller of an NU308:

    >>> float(round(1e6 * iso_profile(np.array([3.75e-3]), 14e-3, 15e-3)[0], 4))
    1.4096
    """
    if roller_length <= _LONG * roller_diameter:
        part, depth = 2.0 * np.abs(x) / roller_length, 0.00035 * roller_diameter
    else:
        crowned = _LONG * roller_diameter
        part = np.maximum(2.0 * np.abs(x) - (roller_length - crowned), 0.0) / crowned
        depth = 0.0005 * roller_diameter
    return np.asarray(-depth * np.log1p(-(part**2)))


@dataclass(frozen=True)
class CrownedProfile:
    """Profile of a roller with an arc: P(x) = R - sqrt(R^2 - t^2), t how far x is beyond the straight middle.

    Attributes
    ----------
    radius : float
        Radius R of the arc along the roller [m]. It may be much larger than the roller, not smaller than its half
        length.
    straight : float
        Length of the straight middle [m]; 0 for a roller that is crowned all along.

    Raises
    ------
    InputError
        If the radius is not finite and above zero, or the straight length not finite and at least zero.

    Examples
    --------
    >>> profile = CrownedProfile.of_drop(10e-6, 15e-3, straight=9e-3)
    >>> profile(np.array([0.0, 4.5e-3, 7.5e-3])).round(12).tolist()
    [0.0, 0.0, 1e-05]
    """

    radius: float
    straight: float = 0.0

    def __post_init__(self) -> None:
        problems = Problems()
        if not (math.isfinite(self.radius) and self.radius > 0.0):
            problems.append(f"crowned profile, radius: got {self.radius!r} m; allowed: finite and > 0")
        if not (math.isfinite(self.straight) and self.straight >= 0.0):
            problems.append(f"crowned profile, straight: got {self.straight!r} m; allowed: finite and >= 0")
        problems.check()

    @classmethod
    def of_drop(cls, drop: float, roller_length: float, straight: float = 0.0) -> CrownedProfile:
        """The arc that lies a given depth below the cylinder at the ends of the roller.

        Parameters
        ----------
        drop : float
            Depth at the ends [m].
        roller_length : float
            Length of the roller [m].
        straight : float
            Length of the straight middle [m].

        Raises
        ------
        InputError
            If no arc has that depth.
        """
        beyond = 0.5 * (roller_length - straight)
        if not (0.0 < drop <= beyond):
            raise InputError(
                f"crowned profile, drop: got {drop!r} m with {straight!r} m straight of {roller_length!r} m; allowed: "
                "above 0, with a straight middle that leaves more than the drop at either end"
            )
        return cls(0.5 * (beyond * beyond + drop * drop) / drop, straight)

    def __call__(self, x: FloatArray) -> FloatArray:
        """Depth below the cylinder on one side [m]; infinite, as NaN, where the arc has ended.

        Parameters
        ----------
        x : array
            Distance from the middle of the roller [m].
        """
        beyond = np.maximum(np.abs(x) - 0.5 * self.straight, 0.0)
        with np.errstate(invalid="ignore"):
            # R - sqrt(R^2 - t^2) without the difference of two large numbers
            return np.asarray(beyond**2 / (self.radius + np.sqrt(self.radius**2 - beyond**2)))

    def __str__(self) -> str:
        """The profile in a few words."""
        middle = f", {1e3 * self.straight:.4g} mm straight" if self.straight else ""
        return f"crowned with a radius of {self.radius:.4g} m{middle}"


@dataclass(frozen=True)
class TabulatedProfile:
    """Profile of a roller through measured points, with straight lines between them.

    Attributes
    ----------
    positions : tuple of float
        Distances from the middle of the roller [m], rising; from zero on for a symmetric roller.
    depths : tuple of float
        Depths below the cylinder there, on one side [m]; negative where the roller is thicker.

    Raises
    ------
    InputError
        If the points are no course.

    Examples
    --------
    >>> TabulatedProfile((0.0, 5e-3, 7e-3), (0.0, 0.0, 4e-6))(np.array([-6e-3, 1e-3])).tolist()
    [2e-06, 0.0]
    """

    positions: Sequence[float]
    depths: Sequence[float]

    def __post_init__(self) -> None:
        for name in ("positions", "depths"):
            object.__setattr__(self, name, tuple(getattr(self, name)))
        if len(self.positions) != len(self.depths) or len(self.positions) < 2:
            raise InputError(
                f"profile table: got {len(self.positions)} positions and {len(self.depths)} depths; allowed: as many "
                "of each, at least two"
            )
        if not (np.all(np.isfinite(self.positions)) and np.all(np.diff(self.positions) > 0.0)):
            raise InputError(f"profile table, positions: got {self.positions!r:.80} m; allowed: finite and rising")
        if not np.all(np.isfinite(self.depths)):
            raise InputError(f"profile table, depths: got {self.depths!r:.80} m; allowed: finite")

    def __call__(self, x: FloatArray) -> FloatArray:
        """Depth below the cylinder on one side [m]; NaN outside the table.

        Parameters
        ----------
        x : array
            Distance from the middle of the roller [m].
        """
        places = np.abs(x) if self.positions[0] >= 0.0 else x
        return np.interp(places, self.positions, self.depths, left=math.nan, right=math.nan)

    def __str__(self) -> str:
        """The profile in a few words."""
        return f"of {len(self.positions)} points"


FINEST, ROUGHEST = 1e-9, 1e-5
"""Roughness that is taken [m]: below a nanometre there is no continuum, above ten micrometres no rolling surface."""

HARDNESS = 7e9
"""Hardness of through-hardened bearing steel of 60 HRC [Pa], some 700 HV."""

LIMITS: Mapping[str, tuple[float, float]] = MappingProxyType(
    {"asperity_product": (0.02, 0.5), "asperity_slope": (1e-4, 0.1), "hardness": (1e9, 1e11)}
)
"""Smallest and largest value of each property of asperities that is taken; hardness in Pa."""

USUAL: Mapping[str, tuple[float, float]] = MappingProxyType(
    {"asperity_product": (0.03, 0.05), "asperity_slope": (1e-4, 1e-2)}
)
"""Range of steel surfaces of each property that is seldom known (Teodorescu et al. 2005), from soft to stiff."""

_UNITS = {"hardness": " Pa"}


@dataclass(frozen=True)
class Surface:
    """Roughness of the two surfaces of a contact together.

    Attributes
    ----------
    roughness : float
        Combined root mean square roughness sigma = sqrt(sigma_1^2 + sigma_2^2) [m]; 0 where the surfaces are smooth.
    asperity_product : float
        eta sigma beta of density eta [1/m2] and radius beta [m] of the asperities; usually 0.03 to 0.05. Left out, the
        stiff end.
    asperity_slope : float
        sigma/beta; usually 0.0001 to 0.01. Left out, the stiff end.
    hardness : float
        Most pressure within the spots where asperities touch [Pa].

    Raises
    ------
    InputError
        With every value that is out of its limits.
    """

    roughness: float
    asperity_product: float = 0.05
    asperity_slope: float = 0.01
    hardness: float = HARDNESS

    def __post_init__(self) -> None:
        problems = Problems()
        if not (self.roughness == 0.0 or FINEST <= self.roughness <= ROUGHEST):
            problems.append(
                f"surface, roughness: got {self.roughness!r} m; allowed: {FINEST:g} to {ROUGHEST:g} m, or 0 (smooth)"
            )
        for name, (least, most) in LIMITS.items():
            value, unit = getattr(self, name), _UNITS.get(name, "")
            if not least <= value <= most:
                problems.append(f"surface, {name}: got {value!r}{unit}; allowed: {least:g} to {most:g}{unit}")
        problems.check()

    @property
    def smooth(self) -> bool:
        """True where there are no asperities."""
        return self.roughness == 0.0

    @property
    def corners(self) -> tuple[Surface, Surface]:
        """The same roughness with the softest and with the stiffest usual asperities.

        What is not at its default was stated: it is known, and stays.

        Examples
        --------
        >>> [(each.asperity_product, each.asperity_slope) for each in Surface(2e-7, 0.04).corners]
        [(0.04, 0.0001), (0.04, 0.01)]
        """
        usual = Surface(self.roughness)
        open_ends = {name: ends for name, ends in USUAL.items() if getattr(self, name) == getattr(usual, name)}
        soft, stiff = (replace(self, **{name: ends[i] for name, ends in open_ends.items()}) for i in (0, 1))
        return soft, stiff

    @property
    def label(self) -> str:
        """Name for tables, legends and messages."""
        return "smooth" if self.smooth else f"roughness {1e6 * self.roughness:.3g} um"


SMOOTH = Surface(0.0)
"""Surfaces without asperities."""
