"""Ratings of ball bearings by their inner geometry, and balls by a static rating.

Those of thrust bearings are axial: C0 = 61.6 Z Dw^2 of ISO 76 at 90 degrees, and C = 1.3 f_c Z^(2/3) Dw^1.8 with f_c
of table 4 of ISO 281, which goes with (Dw/d_m)^0.3 in all its digits.

References
----------
ISO 76: static ratings, factors f0 (table 1). ISO 281: dynamic ratings.
"""

from __future__ import annotations

import math

from ehdmaps.errors import InputError
from ehdmaps.physics.designations.reader import table
from ehdmaps.physics.point.ball_geometry import BallGeometry
from ehdmaps.physics.solids import SILICON_NITRIDE

INNER_CONFORMITY, OUTER_CONFORMITY = 0.515, 0.52
"""Groove radius over ball diameter. Their sum is that of NSK's table 15.4 (1.035 +- 0.002); its shares are assumed.
ISO 281 takes at most 0.52 and 0.53, which others use."""

HYBRID_RATING = 0.7
"""Static rating of a bearing with balls of silicon nitride over that with steel ones, as GMN's catalogue has it: equal
pressure at the load of the rating takes (1/1.181)^2 = 0.717."""

FACTORS: list[float] = table("balls")["factors"]
"""Factors f0 of ISO 76, by 100 Dw cos(alpha)/d_m."""

_MM = 1e-3


def static_factor(gamma: float, *, of_inner: bool = False) -> float:
    """Factor f0 of ISO 76 for radial and angular contact ball bearings, by Dw cos(alpha)/d_m, 0 to 0.4.

    Below 0.09 the outer contact decides, with a groove of 0.53. That of a tighter one does not: the factor goes on as
    that of the inner contact, by Hertz.

    Parameters
    ----------
    gamma : float
        Dw cos(alpha)/d_m.
    of_inner : bool
        Whether the inner contact decides everywhere, as in NSK's catalogue.

    Examples
    --------
    >>> static_factor(0.2), static_factor(0.06), round(static_factor(0.06, of_inner=True), 2)
    (14.0, 15.9, 17.42)
    """
    if of_inner and gamma < _BRANCH:
        return static_factor(_BRANCH) + _INNER_SLOPE * (_BRANCH - gamma)
    place = 100.0 * min(max(gamma, 0.0), 0.4)
    low = min(int(place), len(FACTORS) - 2)
    return FACTORS[low] + (place - low) * (FACTORS[low + 1] - FACTORS[low])


def ball_static_rating(geometry: BallGeometry) -> float:
    """Static rating C0 of ISO 76 [N], axial of thrust bearings; of balls of silicon nitride `HYBRID_RATING` of it."""
    if geometry.thrust:
        steel = THRUST_FACTOR * geometry.balls * (geometry.ball_diameter / _MM) ** 2
        return HYBRID_RATING * steel if geometry.ball_material == SILICON_NITRIDE else steel
    steel = geometry.balls * rating_of_ball(geometry.ball_diameter, geometry.pitch_diameter, geometry.contact_angle)
    steel *= geometry.ball_rows
    return HYBRID_RATING * steel if geometry.ball_material == SILICON_NITRIDE else steel


def ball_dynamic_rating(geometry: BallGeometry, quality: float = 1.3) -> float:
    """Dynamic rating C of ISO 281 by the inner geometry [N].

    Parameters
    ----------
    geometry : BallGeometry
        The bearing. Grooves that are tighter than those of the standard, 0.52 of the ball, add nothing.
    quality : float
        Factor b_m: 1.3 for deep groove and angular contact bearings.

    Examples
    --------
    >>> round(1e-3 * ball_dynamic_rating(BallGeometry("6208", 11.91e-3, 60e-3, 9, 0.515, 0.52)), 1)
    28.9
    """
    diameter = geometry.ball_diameter / _MM
    size = diameter**1.8 if diameter <= _LARGE else 3.647 * diameter**1.4
    if geometry.thrust:
        factor = _THRUST_DYNAMIC * (geometry.ball_diameter / geometry.pitch_diameter) ** 0.3
        return float(quality * factor * geometry.balls ** (2.0 / 3.0) * size)
    angle, gamma = geometry.contact_angle, geometry.gamma
    conformity = max(_GROOVE, geometry.inner_conformity), max(_GROOVE, geometry.outer_conformity)
    across = [f / (2.0 * f - 1.0) for f in conformity]
    both = 1.04 * ((1.0 - gamma) / (1.0 + gamma)) ** 1.72 * (across[0] / across[1]) ** 0.41
    factor = 0.95 * 39.9 * (1.0 + both ** (10.0 / 3.0)) ** -0.3 * (2.0 * across[0]) ** 0.41
    factor *= gamma**0.3 * (1.0 - gamma) ** 1.39 / (1.0 + gamma) ** (1.0 / 3.0)
    return float(
        quality * geometry.ball_rows**0.7 * factor * math.cos(angle) ** 0.7 * geometry.balls ** (2.0 / 3.0) * size
    )


def rating_of_ball(diameter: float, pitch: float, angle: float, *, of_inner: bool = False) -> float:
    """Static rating of a ball [N].

    Parameters
    ----------
    diameter, pitch : float
        Dw and d_m [m].
    angle : float
        Contact angle [rad].
    of_inner : bool
        See `static_factor`.
    """
    cosine = math.cos(angle)
    return static_factor(diameter * cosine / pitch, of_inner=of_inner) * (diameter / _MM) ** 2 * cosine


def ball_diameter(
    name: str, rating: float, pitch: float, angle: float, section: float, *, of_inner: bool = False
) -> float:
    """Diameter of the balls by the rating of one of them [m].

    Parameters
    ----------
    name : str
        Name of the bearing, for messages.
    rating : float
        Static rating of a ball [N].
    pitch, angle, section : float
        d_m [m], contact angle [rad], height of the section of both rings [m].
    of_inner : bool
        See `static_factor`.

    Raises
    ------
    InputError
        If no balls fit.
    """
    low, high = 0.2 * section, 0.95 * section

    def found(diameter: float) -> float:
        return rating_of_ball(diameter, pitch, angle, of_inner=of_inner)

    if not found(low) < rating < found(high):
        raise InputError(
            f"ball bearing estimate of {name}: no balls fit its static rating between {low / _MM:.3g} and "
            f"{high / _MM:.3g} mm; allowed: C0, not C, in N"
        )
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if found(middle) < rating else (low, middle)
    return 0.5 * (low + high)


THRUST_FACTOR, _THRUST_DYNAMIC = 61.6, 146.1
"""Factors of thrust ball bearings: f0 of ISO 76, and f_c of ISO 281 over (Dw/d_m)^0.3."""

_BRANCH, _INNER_SLOPE = 0.1, 25.6
"""Dw cos(alpha)/d_m from which on the inner contact decides, and the slope of its f0, of Hertz' pressure of 4.2 GPa in
a groove of 0.52."""

_GROOVE = 0.52
"""Conformity of both grooves with which ISO 281 rates."""

_LARGE = 25.4
"""Diameter of a ball above which ratings grow less with it [mm]."""
