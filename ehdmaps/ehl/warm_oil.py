"""Groups of heat of one line contact, and the oil's laws over temperature as compiled code takes them.

`Lubricant.at` is called at temperatures some kelvin apart, that of the surfaces among them. At a pressure ln eta is
taken from the isotherms of the four nearest by a cubic: with `STEP` it errs by less than 1e-4 for FVA 3 above 0 degC,
by its fourth derivative elsewhere, and not at all at the temperature of the surfaces. Density is linear in temperature.
"""

from __future__ import annotations

import math
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.compiled import njit
from ehdmaps.errors import InputError
from ehdmaps.physics.heat import HeatData
from ehdmaps.physics.isotherm import Isotherm, log_viscosity
from ehdmaps.physics.lubricant import Lubricant

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


NO_HEAT = Heat(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, np.empty(0), np.empty(0), np.empty(0), np.empty(0))
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
