"""One column of a film: the oil's laws and groups of heat for compiled code, how much it lets flow, what it carries.

Groups of heat of one line contact, and the oil's laws over temperature as compiled code takes them.

`Lubricant.at` is called at temperatures some kelvin apart, that of the surfaces among them. At a pressure ln eta is
taken from the isotherms of the four nearest by a cubic: with `STEP` it errs by less than 1e-4 for FVA 3 above 0 degC,
by its fourth derivative elsewhere, and not at all at the temperature of the surfaces. Density is linear in temperature.

One column of an isothermal film whose oil answers to shear by any law: how much it lets flow, and what it carries.

The stress is linear across the film, tau = tau_0 + zeta s with zeta = z/h and s = h dp/dx. One number a column is
unknown, tau_0, for which the oil shears by the difference of the walls' speeds. With f = eta rate/tau >= 1 of the law
and A_k = Int f zeta^k dzeta the generalised Reynolds equation (H. G. Yang, S. Z. Wen, J. Tribology 112 (1990) 631-636)
has two factors, both 1 of a Newtonian oil:

    mobility   12 (A_2 - A_1^2/A_0)                 on the flow by pressure
    carriage   1 + (1/2 - A_1/A_0) (U_2 - U_1)      on the oil that the walls carry, speeds in units of their mean
"""

from __future__ import annotations

import math
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.compiled import njit
from ehdmaps.ehl.grid import ACROSS, Across, points_across
from ehdmaps.errors import InputError
from ehdmaps.physics.heat import HeatData
from ehdmaps.physics.isotherm import Isotherm, log_viscosity
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.rheology import LIMITING, ShearLaw, thinning, yielding

STEP = 4.0
"""Distance of the temperatures at which the oil's laws are taken [K]."""

COLDEST, HOTTEST = -120.0, 400.0
"""Reach of these temperatures about that of the surfaces [K], as far as the laws go: oil that expands behind a pressure
spike cools by tens of kelvin."""

FLOW_AT_REST = 1.0
"""Least Peclet number of a surface, rho c u b/(2 k): the conduction along a slower one is not modelled."""


class Heat(NamedTuple):
    """Groups of heat, with temperatures in K above that of the surfaces before the contact.

    Attributes
    ----------
    convection : float
        rho_0 c u hs^2/(k b), with hs = b^2/R.
    dissipation : float
        eta_0 u^2/k [K].
    compression : float
        u p_H hs^2/(b k) [K/K].
    lower, upper : float
        (k/hs) sqrt(b/(pi rho_s c_s k_s u_s)) of both walls.
    temperature : float
        T_0 of the surfaces before the contact [K].
    density_slope : float
        d(rho/rho_0)/dT at p = 0 [1/K].
    coldest : float
        First temperature of the laws [K above T_0].
    log_eta, alpha, curvature, shape : ndarray, shape (k,)
        ln(eta/eta_0) at p = 0, and the numbers of the isotherm, every `STEP`; of no length in an isothermal film.
    across : Across
        Points across the film at which temperatures stand.
    """

    convection: float
    dissipation: float
    compression: float
    lower: float
    upper: float
    temperature: float
    density_slope: float
    coldest: float
    log_eta: FloatArray
    alpha: FloatArray
    curvature: FloatArray
    shape: FloatArray
    across: Across

    def scaled(self, factor: float) -> Heat:
        """The same contact, oil and speed at `factor` times the load: p_H and b go with its square root."""
        root = math.sqrt(factor)
        walls = factor**-0.75
        return self._replace(
            convection=self.convection * factor * root,
            compression=self.compression * factor * factor,
            lower=self.lower * walls,
            upper=self.upper * walls,
            alpha=self.alpha * root,
            curvature=self.curvature * root,
        )


NO_HEAT = Heat(
    0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, np.empty(0), np.empty(0), np.empty(0), np.empty(0), points_across(ACROSS)
)
"""Heat of an isothermal film."""


def heat_groups(
    lubricant: Lubricant, data: HeatData, temperature: float, half: float, radius: float, peak: float, walls: FloatArray
) -> Heat:
    """Groups of heat of one operating point.

    Parameters
    ----------
    lubricant : Lubricant
        The oil.
    data : HeatData
        How oil and surfaces take and lead heat.
    temperature : float
        T_0 [K].
    half, radius, peak : float
        b [m], R [m], p_H [Pa].
    walls : ndarray, shape (2,)
        Speeds of the lower and the upper wall [m/s].
    """
    state = lubricant.at(temperature)
    speed = 0.5 * float(walls[0] + walls[1])
    scale = half**2 / radius
    conductivity = data.oil_conductivity
    taken = data.solid_density * data.solid_heat_capacity * data.solid_conductivity
    slowest = FLOW_AT_REST * 2.0 * data.solid_conductivity / (data.solid_density * data.solid_heat_capacity * half)
    lower, upper = (
        conductivity / scale * math.sqrt(half / (math.pi * taken * max(abs(float(wall)), slowest))) for wall in walls
    )
    coldest, laws = _laws(lubricant, temperature)
    return Heat(
        convection=state.density * data.oil_heat_capacity * speed * scale**2 / (conductivity * half),
        dissipation=state.viscosity * speed**2 / conductivity,
        compression=speed * peak * scale**2 / (half * conductivity),
        lower=lower,
        upper=upper,
        temperature=temperature,
        density_slope=lubricant.density_slope / state.density,
        coldest=coldest,
        log_eta=laws[0].copy(),
        alpha=laws[1] * peak,
        curvature=laws[2] * peak,
        shape=laws[3].copy(),
        across=points_across(ACROSS),
    )


@lru_cache(maxsize=64)
def _laws(lubricant: Lubricant, temperature: float) -> tuple[float, FloatArray]:
    """First temperature [K above], and ln(eta/eta_0), alpha, curvature and shape in SI, as far as the laws reach."""
    here = lubricant.at(temperature)
    form = here.isotherm().form
    rows: dict[int, tuple[float, float, float, float]] = {}
    for way, last in ((1, round(HOTTEST / STEP)), (-1, round(-COLDEST / STEP))):
        for count in range(last + 1):
            try:
                state = lubricant.at(temperature + way * count * STEP)
            except InputError:
                break
            law = state.isotherm()
            if law.form != form or not (math.isfinite(state.viscosity) and state.viscosity > 0.0):
                break
            rows[way * count] = math.log(state.viscosity / here.viscosity), law.alpha, law.curvature, law.shape
    places = sorted(rows)
    return places[0] * STEP, np.array([rows[place] for place in places]).T.copy()


_log_viscosity = njit(log_viscosity)


@njit
def warm_viscosity(
    isotherm: Isotherm,
    heat: Heat,
    pressure: float,
    rises: FloatArray,
    log_eta: FloatArray,
    by_rise: FloatArray,
    by_pressure: FloatArray,
) -> None:
    """Fill ln(eta/eta_0) and its derivatives at one pressure and several temperatures.

    Parameters
    ----------
    isotherm : Isotherm
        Form of the law over pressure.
    heat : Heat
        Laws over temperature.
    pressure : float
        P [p_H], >= 0.
    rises : ndarray, shape (k,)
        Temperatures [K above T_0]; beyond the reach of the laws the value at their end stands.
    log_eta, by_rise, by_pressure : ndarray, shape (k,)
        ln(eta/eta_0), its derivatives by temperature and by pressure.
    """
    count = heat.log_eta.size
    known, slopes = np.full(count, np.nan), np.empty(count)
    for k in range(rises.size):
        place = (rises[k] - heat.coldest) / STEP
        inside = 0.0 <= place <= count - 1.0
        place = min(max(place, 0.0), count - 1.0)
        j = min(max(int(place), 1), count - 3)
        s = place - j
        values = (
            -s * (s - 1.0) * (s - 2.0) / 6.0,
            (s * s - 1.0) * (s - 2.0) / 2.0,
            -s * (s + 1.0) * (s - 2.0) / 2.0,
            s * (s * s - 1.0) / 6.0,
        )
        turns = (
            -(3.0 * s * s - 6.0 * s + 2.0) / 6.0,
            (3.0 * s * s - 4.0 * s - 1.0) / 2.0,
            -(3.0 * s * s - 2.0 * s - 2.0) / 2.0,
            (3.0 * s * s - 1.0) / 6.0,
        )
        log_eta[k], by_rise[k], by_pressure[k] = 0.0, 0.0, 0.0
        for q in range(4):
            i = j - 1 + q
            if math.isnan(known[i]):
                law = Isotherm(isotherm.form, heat.alpha[i], heat.curvature[i], heat.shape[i], 0.0)
                value, slope = _log_viscosity(law, pressure)
                known[i], slopes[i] = heat.log_eta[i] + value, slope
            log_eta[k] += values[q] * known[i]
            by_rise[k] += turns[q] * known[i] / STEP
            by_pressure[k] += values[q] * slopes[i]
        if not inside:
            by_rise[k] = 0.0


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
