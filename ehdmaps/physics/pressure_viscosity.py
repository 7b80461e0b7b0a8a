"""Viscosity over pressure: Barus, Roelands and the law of FVA 3 as one family, over temperature.

Three laws of an oil (`Barus`, `Roelands`, `Fva3`) say how the family depends on temperature; each gives the
`PressureViscosity` of a temperature by `at(temperature, viscosity)`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ehdmaps.errors import InputError
from ehdmaps.physics._values import Values, as_given

ZERO_CELSIUS = 273.15
ROELANDS_PRESSURE = 1.96e8
"""p0 of Roelands' law [Pa]."""
ROELANDS_LOG = 9.67
"""-ln of the viscosity 6.31e-5 Pa s at which Roelands' isotherms meet."""

_COLD, _HOT = 40.0, 100.0  # degC, at which a pressure-viscosity coefficient over temperature is given


@dataclass(frozen=True)
class PressureViscosity:
    """One isotherm: ln(eta/eta0) = (alpha p_c/z) [(1 + p/p_c)^z - 1].

    z = 1 is Barus' law alpha p, for any p_c; z = 0 is the limit alpha p_c ln(1 + p/p_c); Roelands has
    p_c = 1.96e8 Pa and alpha = z (ln eta0 + 9.67)/p_c; z = -1 is p/(a + b p) with alpha = 1/a, p_c = a/b.

    Attributes
    ----------
    pressure_viscosity : float
        alpha = d ln eta/dp at p = 0 [1/Pa], >= 0.
    exponent : float
        z.
    pressure_scale : float
        p_c [Pa], > 0; inf is allowed with z = 1.

    Raises
    ------
    InputError
        With every value out of these limits.

    References
    ----------
    C. J. A. Roelands, Correlational aspects of the viscosity-temperature-pressure relationship of lubricating
    oils, PhD thesis, TH Delft, 1966.

    Examples
    --------
    >>> barus = PressureViscosity(2e-8, exponent=1.0, pressure_scale=math.inf)
    >>> barus.log_ratio(1e9)
    20.0
    >>> fva3 = PressureViscosity(1.0 / 44.7e6, exponent=-1.0, pressure_scale=44.7e6 / 0.01646)
    >>> round(fva3.log_ratio(1e9), 6), round(1e9 / (44.7e6 + 0.01646 * 1e9), 6)
    (16.350556, 16.350556)
    """

    pressure_viscosity: float
    exponent: float
    pressure_scale: float

    def __post_init__(self) -> None:
        problems = []
        if not (math.isfinite(self.pressure_viscosity) and self.pressure_viscosity >= 0):
            problems.append(
                f"pressure_viscosity: got {self.pressure_viscosity!r} 1/Pa; allowed: finite and >= 0; "
                "mineral oils have about 2e-8 1/Pa"
            )
        if not math.isfinite(self.exponent):
            problems.append(f"exponent: got {self.exponent!r}; allowed: finite")
        if not self.pressure_scale > 0 or (math.isinf(self.pressure_scale) and self.exponent != 1.0):
            problems.append(
                f"pressure_scale: got {self.pressure_scale!r} Pa with the exponent {self.exponent!r}; "
                "allowed: > 0 Pa, and inf only with the exponent 1"
            )
        if problems:
            raise InputError(problems)

    def log_ratio(self, p: Values) -> Values:
        """ln(eta/eta0) at the pressures p [Pa], >= 0."""
        if self.exponent == 1.0:
            return as_given(self.pressure_viscosity * p, p)
        growth = np.log1p(p / self.pressure_scale)
        if self.exponent != 0.0:
            growth = np.expm1(self.exponent * growth) / self.exponent
        return as_given(self.pressure_viscosity * self.pressure_scale * growth, p)

    def log_ratio_slope(self, p: Values) -> Values:
        """D ln(eta)/dp [1/Pa] at the pressures p [Pa], >= 0: alpha (1 + p/p_c)^(z - 1)."""
        if self.exponent == 1.0:
            return as_given(self.pressure_viscosity * np.ones_like(p), p)
        growth = (1.0 + p / self.pressure_scale) ** (self.exponent - 1.0)
        return as_given(self.pressure_viscosity * growth, p)


@dataclass(frozen=True)
class Barus:
    """Barus' law, ln(eta/eta0) = alpha p, with ln alpha linear in temperature.

    Attributes
    ----------
    pressure_viscosity_40, pressure_viscosity_100 : float
        alpha at 40 and 100 degC [1/Pa]; alike for a constant.

    References
    ----------
    C. Barus, Isothermals, isopiestics and isometrics relative to viscosity, Am. J. Science 45, 1893, 87-96.
    """

    pressure_viscosity_40: float
    pressure_viscosity_100: float

    def __post_init__(self) -> None:
        _check_coefficients(self.pressure_viscosity_40, self.pressure_viscosity_100)

    def at(self, temperature: float, viscosity: float) -> PressureViscosity:
        """The isotherm of a temperature [K]; `viscosity` eta0 [Pa s] does not matter here."""
        alpha = _coefficient(self.pressure_viscosity_40, self.pressure_viscosity_100, temperature)
        return PressureViscosity(alpha or 0.0, exponent=1.0, pressure_scale=math.inf)


@dataclass(frozen=True)
class Roelands:
    """Roelands' law, ln(eta/eta0) = (ln eta0 + 9.67) [(1 + p/p0)^z - 1], p0 = 1.96e8 Pa.

    Given are z, or the pressure-viscosity coefficient, or both. One alone gives the other at each
    temperature by alpha = z (ln eta0 + 9.67)/p0. Both hold as stated where both are given: the factor (ln
    eta0 + 9.67) is then replaced by alpha p0/z.

    Attributes
    ----------
    exponent : float or None
        z, > 0.
    pressure_viscosity_40, pressure_viscosity_100 : float or None
        alpha at 40 and 100 degC [1/Pa], ln alpha linear in temperature; alike for a constant.
    """

    exponent: float | None
    pressure_viscosity_40: float | None
    pressure_viscosity_100: float | None

    def __post_init__(self) -> None:
        if self.exponent is not None and not (math.isfinite(self.exponent) and self.exponent > 0):
            raise InputError(f"roelands_z: got {self.exponent!r}; allowed: finite and > 0; oils have 0.4 to 0.8")
        _check_coefficients(self.pressure_viscosity_40, self.pressure_viscosity_100)
        if self.exponent is None and self.pressure_viscosity_40 is None:
            raise InputError(
                "viscosity_law roelands: got neither pressure_viscosity nor roelands_z; "
                "allowed: one of them or both; "
                "give pressure_viscosity [1/Pa]"
            )

    def at(self, temperature: float, viscosity: float) -> PressureViscosity:
        """The isotherm of a temperature [K], at which the oil has the viscosity eta0 [Pa s]."""
        alpha = _coefficient(self.pressure_viscosity_40, self.pressure_viscosity_100, temperature)
        if alpha is not None and self.exponent is not None:
            return PressureViscosity(alpha, self.exponent, ROELANDS_PRESSURE)
        log_viscosity = math.log(viscosity) + ROELANDS_LOG
        if log_viscosity <= 0:
            raise InputError(
                f"viscosity: got {viscosity:.4g} Pa s at {temperature - ZERO_CELSIUS:.6g} degC; "
                "allowed: above "
                f"{math.exp(-ROELANDS_LOG):.3g} Pa s for viscosity_law roelands; "
                "use barus, or give both roelands_z "
                "and pressure_viscosity"
            )
        if self.exponent is not None:
            alpha = self.exponent * log_viscosity / ROELANDS_PRESSURE
            return PressureViscosity(alpha, self.exponent, ROELANDS_PRESSURE)
        if not alpha:  # z = 0: isoviscous, which is the same oil as Barus' with alpha = 0
            return PressureViscosity(0.0, exponent=1.0, pressure_scale=math.inf)
        return PressureViscosity(alpha, alpha * ROELANDS_PRESSURE / log_viscosity, ROELANDS_PRESSURE)


@dataclass(frozen=True)
class Fva3:
    """Law of the FVA reference oils, ln(eta/eta0) = p/(a1 + a2 theta + (b1 + b2 theta) p), theta in degC.

    Attributes
    ----------
    a1, a2 : float
        [Pa], [Pa/K].
    b1, b2 : float
        [-], [1/K].
    pressure_viscosity_40, pressure_viscosity_100 : float or None
        If given, alpha [1/Pa] at these temperatures takes the place of 1/(a1 + a2 theta).

    References
    ----------
    Lubricants 11, 2023, 369, table A1 (with p in bar there).
    """

    a1: float = 327.7918e5
    a2: float = 2.9862e5
    b1: float = 4.419e-3
    b2: float = 3.0115e-4
    pressure_viscosity_40: float | None = None
    pressure_viscosity_100: float | None = None

    def __post_init__(self) -> None:
        _check_coefficients(self.pressure_viscosity_40, self.pressure_viscosity_100)

    def at(self, temperature: float, viscosity: float) -> PressureViscosity:
        """The isotherm of a temperature [K]; `viscosity` eta0 [Pa s] does not matter here."""
        celsius = temperature - ZERO_CELSIUS
        a = self.a1 + self.a2 * celsius
        b = self.b1 + self.b2 * celsius
        if a <= 0 or b < 0:
            raise InputError(
                f"temperature: got {celsius:.6g} degC; the law of FVA 3 over pressure has a1 + a2 theta = "
                f"{a:.4g} Pa and "
                f"b1 + b2 theta = {b:.4g} there, which makes the viscosity infinite at a finite pressure; "
                "allowed: a > 0 and b >= 0, which is -14.67 degC and above for FVA 3; raise the temperature"
            )
        given = _coefficient(self.pressure_viscosity_40, self.pressure_viscosity_100, temperature)
        alpha = 1.0 / a if given is None else given
        if alpha * b == 0.0:
            return PressureViscosity(alpha, exponent=1.0, pressure_scale=math.inf)
        return PressureViscosity(alpha, exponent=-1.0, pressure_scale=1.0 / (alpha * b))


PressureViscosityLaw = Barus | Roelands | Fva3


def _check_coefficients(cold: float | None, hot: float | None) -> None:
    """Refuse coefficients between which no logarithm can be interpolated, and one without the other."""
    if cold is None and hot is None:
        return
    problems = [
        f"{key}: got {value!r} 1/Pa; allowed: finite and >= 0, > 0 if it varies; mineral oils have about 2e-8 1/Pa"
        for key, value in (("pressure_viscosity_40", cold), ("pressure_viscosity_100", hot))
        if value is None or not (math.isfinite(value) and value >= 0 and (value > 0 or cold == hot))
    ]
    if problems:
        raise InputError(problems)


def _coefficient(cold: float | None, hot: float | None, temperature: float) -> float | None:
    """Alpha with its logarithm linear in temperature; None if it is not given."""
    if cold is None or hot is None or cold == hot:
        return cold
    part = (temperature - ZERO_CELSIUS - _COLD) / (_HOT - _COLD)
    return cold * math.exp(part * math.log(hot / cold))
