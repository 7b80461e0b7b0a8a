"""Reduction of the film by inlet shear heating: the thermal loading, and a published factor.

Multiply an isothermal film by the factor. No solver applies it: `ehdmaps.physics.inlet_heat` has a factor that holds at
light loads too.
"""

from __future__ import annotations

import math

from ehdmaps.errors import InputError
from ehdmaps.physics.lubricant import Lubricant

_KELVIN = 0.01
"""Step of the difference quotient by temperature."""


def viscosity_slope(lubricant: Lubricant, temperature: float) -> float:
    """d eta0/dT [Pa s/K], <= 0, of an oil at a temperature [K].

    Parameters
    ----------
    lubricant : Lubricant
        The oil.
    temperature : float
        T [K].

    Examples
    --------
    >>> round(1e3 * viscosity_slope(Lubricant.named("FVA3"), 313.15), 2)
    -4.31
    """
    at, above = (lubricant.at(temperature + more).viscosity for more in (0.0, _KELVIN))
    return min((above - at) / _KELVIN, 0.0)


def thermal_loading(viscosity_slope: float, speed: float, conductivity: float) -> float:
    """Thermal loading parameter L = -(d eta0/dT) u^2/k_f [-].

    Parameters
    ----------
    viscosity_slope : float
        d eta0/dT at the inlet temperature [Pa s/K], <= 0.
    speed : float
        Entrainment speed u, the mean of the surface speeds [m/s].
    conductivity : float
        Thermal conductivity k_f of the oil [W/(m K)], > 0.

    Raises
    ------
    InputError
        With every value that is not finite or out of these limits.

    Examples
    --------
    FVA 3 at 40 degC, where d eta0/dT = -B/(C + theta)^2 eta0 = -4.31e-3 Pa s/K:

    >>> round(thermal_loading(-4.31e-3, speed=10.0, conductivity=0.134), 2)
    3.22
    """
    problems = []
    if not (math.isfinite(viscosity_slope) and viscosity_slope <= 0):
        problems.append(f"viscosity_slope: got {viscosity_slope!r} Pa s/K; allowed: finite and <= 0; check its sign")
    if not math.isfinite(speed):
        problems.append(f"speed: got {speed!r} m/s; allowed: finite")
    if not (math.isfinite(conductivity) and conductivity > 0):
        problems.append(
            f"conductivity: got {conductivity!r} W/(m K); allowed: finite and > 0; mineral oils have about 0.13"
        )
    if problems:
        raise InputError(problems)
    return -viscosity_slope * speed**2 / conductivity


def inlet_shear_heating_factor(
    max_pressure: float, reduced_modulus: float, thermal_loading: float, slide_to_roll: float = 0.0
) -> float:
    """Factor C_T on the isothermal film [-].

    C_T = (1 - 13.2 (p_H/E') L^0.42)/(1 + 0.213 (1 + 2.23 S^0.83) L^0.64).

    Parameters
    ----------
    max_pressure : float
        p_H [Pa], >= 0.
    reduced_modulus : float
        E' = 2/(...) [Pa], > 0.
    thermal_loading : float
        L of `thermal_loading`, >= 0.
    slide_to_roll : float
        S = |u1 - u2|/u with the mean speed u, >= 0.

    Raises
    ------
    InputError
        With every value out of its limits, and where 13.2 (p_H/E') L^0.42 >= 1: the regression gives no
        film there and is outside its range. It is never clipped.

    Notes
    -----
    A regression of thermal solutions of hard contacts. The original was not at hand: coefficients and the
    meaning of its symbols (mean speed, E' = 2/(...)) follow the textbooks that quote it, and the range of
    its fit is not known here.

    References
    ----------
    P. K. Gupta, H. S. Cheng, D. Zhu, N. H. Forster, J. B. Schrand, Viscoelastic effects in MIL-L-7808-type
    lubricant, part I: analytical formulation, Tribology Transactions 35, 1992, 269-274.

    Examples
    --------
    >>> round(inlet_shear_heating_factor(1e9, 230.77e9, thermal_loading=1.0), 4)
    0.7772
    """
    problems = [
        f"{key}: got {value!r}; allowed: finite and >= 0"
        for key, value in (
            ("max_pressure", max_pressure),
            ("thermal_loading", thermal_loading),
            ("slide_to_roll", slide_to_roll),
        )
        if not (math.isfinite(value) and value >= 0)
    ]
    if not (math.isfinite(reduced_modulus) and reduced_modulus > 0):
        problems.append(f"reduced_modulus: got {reduced_modulus!r} Pa; allowed: finite and > 0")
    if problems:
        raise InputError(problems)
    reduction: float = 13.2 * max_pressure / reduced_modulus * thermal_loading**0.42
    if reduction >= 1.0:
        raise InputError(
            f"inlet shear heating: got 13.2 (p_H/E') L^0.42 = {reduction:.4g}, outside the range of the "
            "regression; "
            "allowed: < 1; lower the speed or the pressure, or solve with temperatures"
        )
    heating: float = 0.213 * (1.0 + 2.23 * slide_to_roll**0.83) * thermal_loading**0.64
    return (1.0 - reduction) / (1.0 + heating)
