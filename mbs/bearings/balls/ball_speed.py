"""Speed of the cage of a ball bearing by its contact angles, loads of the balls by it, and their work, compiled.

Contacts at rest store U, the sum of the integrals of their loads over the approaches. With the balance of each ball

    dU/dt = Q_i e_i . dd/dt + (F_c (0, 1) + T) . dv/dt,

T the traction: the first part is the work of the ring and of the turning cage, the second one that of speed.
"""

from __future__ import annotations

import math

from ehdmaps.arrays import FloatArray
from ehdmaps.compiled import njit


@njit(error_model="numpy", _nrt=False)
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


@njit(error_model="numpy", _nrt=False)
def mean_angles(balls: FloatArray) -> tuple[float, float]:
    """Mean contact angles of the inner and the outer side, by the loads of the balls [rad]; zero without load.

    Parameters
    ----------
    balls : array (Z, COLUMNS)
        What `place_ball` writes of each ball.
    """
    load_i = load_o = angle_i = angle_o = 0.0
    for j in range(balls.shape[0]):
        load_i += balls[j, 10]
        load_o += balls[j, 11]
        angle_i += balls[j, 10] * balls[j, 12]
        angle_o += balls[j, 11] * balls[j, 13]
    return (angle_i / load_i if load_i > 0.0 else 0.0), (angle_o / load_o if load_o > 0.0 else 0.0)


@njit(error_model="numpy", _nrt=False)
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


@njit(error_model="numpy", _nrt=False)
def speed_work(balls: FloatArray, loads: FloatArray, arm: float, last: FloatArray) -> float:
    """Work of the centrifugal loads and tractions on the balls since the last call [J], by the trapezoidal rule.

    Parameters
    ----------
    balls : array (Z, COLUMNS)
        What `place_ball` writes of each ball.
    loads : array (2,)
        F_c, and 2 G/Dw [N].
    arm : float
        Distance of the outer groove's centre and the centre of a ball that touches it [m].
    last : array (Z, 4)
        Centres [m] and forces [N] of the last call, axial and radial; written.
    """
    work = 0.0
    for j in range(balls.shape[0]):
        reach, sin, cos = arm + balls[j, 15], balls[j, 18], balls[j, 19]
        x, r = reach * sin, reach * cos
        along, outward = -loads[1] * sin * cos, loads[0] + loads[1] * sin * sin
        work += 0.5 * ((along + last[j, 2]) * (x - last[j, 0]) + (outward + last[j, 3]) * (r - last[j, 1]))
        last[j, 0], last[j, 1], last[j, 2], last[j, 3] = x, r, along, outward
    return work


@njit(error_model="numpy", _nrt=False)
def turned_by(pose: FloatArray, force: FloatArray) -> float:
    """Moment that the bearing asks of its cage [N m], by pose and force at rest of its inner ring, (6,) each."""
    radial: float = pose[1] * force[2] - pose[2] * force[1]
    tilts: float = pose[4] * force[5] - pose[5] * force[4]
    return radial + tilts


def dry_energy(balls: FloatArray) -> float:
    """Energy of dry contacts [J], 2/5 F times the approach of each.

    Parameters
    ----------
    balls : array (Z, COLUMNS)
        What `place_ball` writes of each ball.
    """
    return 0.4 * float((balls[:, 10:12] * balls[:, 14:16].clip(min=0.0)).sum())
