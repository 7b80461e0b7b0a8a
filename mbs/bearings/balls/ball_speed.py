"""Speed of the cage of a ball bearing by its contact angles, and loads of the balls by that speed, compiled."""

from __future__ import annotations

import math

from ehdmaps.arrays import FloatArray
from ehdmaps.compiled import njit


@njit(error_model="numpy")
def ball_loads(masses: FloatArray, cage: float, outer: float) -> tuple[float, float]:
    """Centrifugal load F_c of a ball [N], and factor G of its gyroscopic moment G sin(alpha_o) [N m].

    F_c = m (d_m/2) w_c^2 and G = J w_c (w_c - w_o) d_m/Dw, J = m Dw^2/10. The traction of rings that turn against each
    other, with a cage that is slow, would drive an idle ball out of its groove: G is at least -F_c Dw/4, by which it
    stays.

    Parameters
    ----------
    masses : array (4,)
        m d_m/2 [kg m], J d_m/Dw [kg m2], Dw [m], Dw/d_m.
    cage, outer : float
        Speeds of the cage and of the outer ring [rad/s].
    """
    centrifugal = masses[0] * cage * cage
    return centrifugal, max(masses[1] * cage * (cage - outer), -0.25 * masses[2] * centrifugal)


@njit(error_model="numpy")
def mean_angles(balls: FloatArray) -> tuple[float, float]:
    """Mean contact angles of the inner and the outer side, by the loads of the balls [rad]; zero without load.

    Parameters
    ----------
    balls : array (Z, 16)
        What `place_ball` writes of each ball.
    """
    load_i = load_o = angle_i = angle_o = 0.0
    for j in range(balls.shape[0]):
        load_i += balls[j, 10]
        load_o += balls[j, 11]
        angle_i += balls[j, 10] * balls[j, 12]
        angle_o += balls[j, 11] * balls[j, 13]
    return (angle_i / load_i if load_i > 0.0 else 0.0), (angle_o / load_o if load_o > 0.0 else 0.0)


@njit(error_model="numpy")
def rolling(ratio: float, angles: tuple[float, float], inner: float, outer: float) -> float:
    """Speed of the cage by pure rolling at mean contact angles, in the unit of the rings' speeds.

    Parameters
    ----------
    ratio : float
        Dw/d_m.
    angles : (float, float)
        Contact angles of the inner and the outer side [rad].
    inner, outer : float
        Speeds of the rings.
    """
    at_inner, at_outer = 1.0 - ratio * math.cos(angles[0]), 1.0 + ratio * math.cos(angles[1])
    return (inner * at_inner + outer * at_outer) / (at_inner + at_outer)
