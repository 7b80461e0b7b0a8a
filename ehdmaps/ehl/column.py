"""One column of an isothermal film whose oil answers to shear by any law: how much it lets flow, and what it carries.

The stress is linear across the film, tau = tau_0 + zeta s with zeta = z/h and s = h dp/dx. One number a column is
unknown, tau_0, for which the oil shears by the difference of the walls' speeds. With f = eta rate/tau >= 1 of the law
and A_k = Int f zeta^k dzeta the generalised Reynolds equation (H. G. Yang, S. Z. Wen, J. Tribology 112 (1990) 631-636)
has two factors, both 1 of a Newtonian oil:

    mobility   12 (A_2 - A_1^2/A_0)                 on the flow by pressure
    carriage   1 + (1/2 - A_1/A_0) (U_2 - U_1)      on the oil that the walls carry, speeds in units of their mean
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from ehdmaps.compiled import njit
from ehdmaps.physics.rheology import LIMITING, ShearLaw, thinning, yielding

POINTS = 24
"""Gauss points across the film. The stress is linear there; the limiting law alone has a layer at the walls, of some
thousandths of the film, in which it is not smooth."""

MOST_STEPS = 200
"""Steps towards tau_0."""

SMALL_MOVE, ROUNDING = 1e-8, 1e-14
"""Relative move after which tau_0 stands, of Newton, which leaves its square, and of halving."""

FLAT = 1e-5
"""Stress over that of the law below which the oil is Newtonian: the factors differ from one by its square."""

_places, _weights = np.polynomial.legendre.leggauss(POINTS)
_ZETA, _WEIGHT = 0.5 * (_places + 1.0), 0.5 * _weights

_thinning, _yielding = njit(thinning), njit(yielding)


class Column(NamedTuple):
    """Factors of one column, each with its derivatives by s, by the Newtonian stress of sliding, and by pressure.

    Attributes
    ----------
    mobility, mobility_by_rise, mobility_by_slide, mobility_by_pressure : float
        Factor on the flow by pressure.
    carriage, carriage_by_rise, carriage_by_slide, carriage_by_pressure : float
        Factor on what the walls carry.
    mean_stress : float
        tau_0 + s/2 [unit of stress].
    """

    mobility: float
    mobility_by_rise: float
    mobility_by_slide: float
    mobility_by_pressure: float
    carriage: float
    carriage_by_rise: float
    carriage_by_slide: float
    carriage_by_pressure: float
    mean_stress: float


@njit
def mean_stress(law: ShearLaw, pressure: float, rise: float, sliding: float) -> float:
    """Mean stress tau_0 + s/2 of a column, of the sign of `sliding`.

    The gradient makes the oil yield more at the same mean stress. So this lies between zero and the stress of plain
    sliding, and that one below its Newtonian value. Newton on the logarithm of the rate, kept in that bracket.

    Parameters
    ----------
    law : ShearLaw
        The law.
    pressure : float
        p [unit of pressure].
    rise : float
        s, stress at one wall less that at the other [unit of stress].
    sliding : float
        eta dU/h, the stress of a Newtonian oil [unit of stress].
    """
    wanted = abs(sliding)
    if wanted == 0.0:
        return 0.0
    low, high = 0.0, wanted * _yielding(law, wanted, pressure)[0]
    trial = high
    for _ in range(MOST_STEPS):
        total, slope = 0.0, 0.0
        for k in range(_ZETA.size):
            tau = trial + (_ZETA[k] - 0.5) * rise
            factor, steep = _thinning(law, tau, pressure)
            total += _WEIGHT[k] * factor * tau
            slope += _WEIGHT[k] * steep
        if total > wanted:
            high = trial
        else:
            low = trial
        move, quadratic = 0.5 * (low + high) - trial, False
        if total > 0.0 and slope > 0.0 and math.isfinite(total) and math.isfinite(slope):
            newton = total / slope * math.log(wanted / total)
            if low <= trial + newton <= high:
                move, quadratic = newton, True
        trial += move
        if abs(move) <= (SMALL_MOVE if quadratic else ROUNDING) * trial:
            break
    return math.copysign(trial, sliding)


@njit
def sheared_column(law: ShearLaw, pressure: float, rise: float, sliding: float, slide: float) -> Column:
    """Factors of one column with their exact derivatives.

    Parameters
    ----------
    law : ShearLaw
        The law.
    pressure : float
        p [unit of pressure].
    rise : float
        s = h dp/dx [unit of stress].
    sliding : float
        eta dU/h, the stress of a Newtonian oil [unit of stress].
    slide : float
        dU = U_2 - U_1, the slide-to-roll ratio.
    """
    if 0.5 * abs(rise) + abs(sliding) < FLAT * law.stress:
        return Column(1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, sliding)
    mean = mean_stress(law, pressure, rise, sliding)
    # integrals of f (0), of d f by tau (1) and of d f by p (2) with zeta^0, 1, 2; of rates with zeta^0, 1
    a0 = a1 = a2 = 0.0
    t0 = t1 = t2 = t3 = 0.0
    p0 = p1 = p2 = 0.0
    g0 = g1 = gp = 0.0
    bounded = law.form == LIMITING and pressure > 0.0
    for k in range(_ZETA.size):
        zeta, weight = _ZETA[k], _WEIGHT[k]
        tau = mean + (zeta - 0.5) * rise
        factor, steep = _thinning(law, tau, pressure)
        by_stress = (steep - factor) / tau if tau != 0.0 else 0.0
        a0 += weight * factor
        a1 += weight * factor * zeta
        a2 += weight * factor * zeta * zeta
        t0 += weight * by_stress
        t1 += weight * by_stress * zeta
        t2 += weight * by_stress * zeta * zeta
        t3 += weight * by_stress * zeta**3
        g0 += weight * steep
        g1 += weight * steep * zeta
        if bounded:
            by_pressure = -(steep - factor) * law.ratio / (law.stress + law.ratio * pressure)
            p0 += weight * by_pressure
            p1 += weight * by_pressure * zeta
            p2 += weight * by_pressure * zeta * zeta
            gp += weight * by_pressure * tau
    ratio = a1 / a0
    # tau_0 moves so that the walls keep their speeds
    by_rise, by_slide, by_pressure = -g1 / g0, 1.0 / g0, -gp / g0
    d0, d1, d2 = by_rise * t0 + t1, by_rise * t1 + t2, by_rise * t2 + t3
    e0, e1, e2 = by_slide * t0, by_slide * t1, by_slide * t2
    q0, q1, q2 = by_pressure * t0 + p0, by_pressure * t1 + p1, by_pressure * t2 + p2
    square = ratio * ratio
    lever = slide / a0
    return Column(
        12.0 * (a2 - a1 * ratio),
        12.0 * (d2 - 2.0 * ratio * d1 + square * d0),
        12.0 * (e2 - 2.0 * ratio * e1 + square * e0),
        12.0 * (q2 - 2.0 * ratio * q1 + square * q0),
        1.0 + slide * (0.5 - ratio),
        -lever * (d1 - ratio * d0),
        -lever * (e1 - ratio * e0),
        -lever * (q1 - ratio * q0),
        mean,
    )
