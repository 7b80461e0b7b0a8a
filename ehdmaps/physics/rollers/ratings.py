"""Load ratings of radial roller bearings, and the rollers that the two ratings of a catalogue tell.

C0 = 44 (1 - gamma) Z L D cos(alpha) (ISO 76) and C = b_m f_c (L cos(alpha))^(7/9) Z^(3/4) D^(29/27) (ISO 281), in N
and mm, gamma = D cos(alpha)/d_m, one row. At a given share of the pitch circle that rollers fill, both together tell
diameter, length and number; the diameter hardly depends on that share: 0.7 % from 0.75 to 0.85.

References
----------
ISO 76, Rolling bearings - Static load ratings. ISO 281, Rolling bearings - Dynamic load ratings and rating life; its
factor f_c as a formula: G. Lundberg, A. Palmgren, Acta Polytechnica, Mechanical Engineering Series 2 (1952) no. 4, with
the reduction 0.83 for line contacts.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

from ehdmaps.errors import InputError

if TYPE_CHECKING:
    from ehdmaps.physics.bearing import BearingGeometry

RATING = 44e6
"""Factor of ISO 76 for radial roller bearings [N/m2]."""

_MM = 1e-3


class Rollers(NamedTuple):
    """Rollers of a row: diameter and effective length [m], and a number that need not be whole."""

    diameter: float
    length: float
    number: float


def rating_factor(gamma: float) -> float:
    """Factor f_c of ISO 281 for radial roller bearings, by D cos(alpha)/d_m.

    Parameters
    ----------
    gamma : float
        D cos(alpha)/d_m, between 0 and 1.

    Examples
    --------
    Table 7 of the standard has 74.1, 88.7 and 83.8 at 0.05, 0.2 and 0.3:

    >>> [round(rating_factor(gamma), 1) for gamma in (0.05, 0.2, 0.3)]
    [74.1, 88.7, 83.8]
    """
    both = (1.04 * ((1.0 - gamma) / (1.0 + gamma)) ** (143.0 / 108.0)) ** 4.5
    own = gamma ** (2.0 / 9.0) * (1.0 - gamma) ** (29.0 / 27.0) / (1.0 + gamma) ** 0.25
    return float(207.9 * 0.83 * own * (1.0 + both) ** (-2.0 / 9.0))


def static_rating(rollers: Rollers, pitch: float, angle: float = 0.0) -> float:
    """C0 of ISO 76 [N].

    Parameters
    ----------
    rollers : Rollers
        Rollers of the row.
    pitch, angle : float
        Pitch diameter [m], contact angle [rad].
    """
    gamma = rollers.diameter * math.cos(angle) / pitch
    return RATING * (1.0 - gamma) * rollers.number * rollers.length * rollers.diameter * math.cos(angle)


def dynamic_rating(rollers: Rollers, pitch: float, angle: float = 0.0, quality: float = 1.1) -> float:
    """C of ISO 281 [N].

    Parameters
    ----------
    rollers : Rollers
        Rollers of the row.
    pitch, angle : float
        Pitch diameter [m], contact angle [rad].
    quality : float
        Factor b_m: 1.1 for cylindrical and tapered rollers and for needles with machined rings.
    """
    diameter, length = rollers.diameter / _MM, rollers.length * math.cos(angle) / _MM
    factor = quality * rating_factor(rollers.diameter * math.cos(angle) / pitch)
    return float(factor * length ** (7.0 / 9.0) * rollers.number**0.75 * diameter ** (29.0 / 27.0))


def ratings(rollers: Rollers, pitch: float, angle: float = 0.0) -> tuple[float, float]:
    """C of ISO 281 and C0 of ISO 76 [N].

    Parameters
    ----------
    rollers, pitch, angle
        See `dynamic_rating`.
    """
    return dynamic_rating(rollers, pitch, angle), static_rating(rollers, pitch, angle)


def cylindrical_ratings(geometry: BearingGeometry) -> tuple[float, float]:
    """C of ISO 281 and C0 of ISO 76 of a cylindrical roller bearing by its inner geometry [N].

    Parameters
    ----------
    geometry : BearingGeometry
        The bearing.
    """
    rollers = Rollers(geometry.roller_diameter, geometry.roller_length, geometry.rollers)
    dynamic, static = ratings(rollers, geometry.pitch_diameter)
    return geometry.row_count ** (7.0 / 9.0) * dynamic, geometry.row_count * static


def with_static_rating(diameter: float, count: float, pitch: float, rating: float, angle: float = 0.0) -> Rollers:
    """Rollers of a diameter and number whose length gives a static rating.

    Parameters
    ----------
    diameter, count, pitch : float
        D [m], Z, d_m [m].
    rating : float
        C0 [N].
    angle : float
        Contact angle [rad].
    """
    return Rollers(diameter, rating / static_rating(Rollers(diameter, 1.0, count), pitch, angle), count)


def by_ratings(
    pitch: float, ratings: tuple[float, float], filled: float, angle: float = 0.0, quality: float = 1.1
) -> Rollers:
    """Rollers by both ratings of a catalogue.

    Parameters
    ----------
    pitch : float
        d_m [m].
    ratings : (float, float)
        C and C0 [N].
    filled : float
        Share of the pitch circle that the rollers take.
    angle, quality : float
        Contact angle [rad], factor b_m of ISO 281.

    Raises
    ------
    InputError
        If no diameter fits both.

    Examples
    --------
    NU308 of a catalogue, whose rollers have 14 mm:

    >>> found = by_ratings(66e-3, (83.0e3, 81.5e3), 0.8)
    >>> round(1e3 * found.diameter, 2)
    13.94
    """

    def rollers(diameter: float) -> Rollers:
        return with_static_rating(diameter, filled * math.pi * pitch / diameter, pitch, ratings[1], angle)

    low, high = 1e-2 * pitch, 0.6 * pitch
    if not dynamic_rating(rollers(low), pitch, angle, quality) < ratings[0]:
        high = low
    for _ in range(60):
        middle = 0.5 * (low + high)
        too_small = dynamic_rating(rollers(middle), pitch, angle, quality) < ratings[0]
        low, high = (middle, high) if too_small else (low, middle)
    if not 0.011 * pitch < low < 0.59 * pitch:
        raise InputError(
            f"bearing estimate: got C = {ratings[0]:.6g} N, C0 = {ratings[1]:.6g} N, to which no roller fits; allowed: "
            "both ratings of ISO 281 and ISO 76, C first"
        )
    return rollers(low)
