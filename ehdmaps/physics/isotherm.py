"""The isotherm of an oil: viscosity and density over pressure at one temperature, the only place of their formulas.

`Isotherm` is the law as plain numbers; `log_viscosity` and `density` evaluate it. They call nothing but numpy, and
branch on the law alone, so that the same lines work for a float, for an array, and compiled for a solver by numba.
`PressureViscosity` and `FreeVolume` are the isotherms as checked values with names.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, ClassVar, NamedTuple

import numpy as np

from ehdmaps.arrays import Values, as_given
from ehdmaps.errors import InputError

DENSITY_PRESSURE = 0.59e9
"""Pressure in the density law of Dowson and Higginson [Pa]."""

DENSITY_RISE = 0.34
"""rho/rho0 - 1 at infinite pressure in that law."""

MOST_FREE_VOLUME_USED = 0.9
"""Part of the free volume above whose loss ln(eta) of `FreeVolume` goes on along its tangent."""

LINEAR, RATIONAL, LOGARITHMIC, POWER, FREE_VOLUME = range(5)
"""Forms of ln(eta/eta0), see `log_viscosity`."""


class Isotherm(NamedTuple):
    """One isotherm in plain numbers, with pressures in a unit of the caller's choice.

    Attributes
    ----------
    form : int
        One of the forms of `log_viscosity`.
    alpha : float
        d ln(eta)/dp at p = 0 [1/unit].
    curvature : float
        q = unit/p_c of the viscosity [1/unit].
    shape : float
        z or c of the form, dimensionless.
    density_curvature : float
        kappa = unit/0.59 GPa of the density [1/unit]; 0 is incompressible.
    """

    form: int
    alpha: float
    curvature: float
    shape: float
    density_curvature: float

    def scaled(self, factor: float) -> Isotherm:
        """The same isotherm with pressures in a unit that is `factor` times as large."""
        return self._replace(
            alpha=self.alpha * factor,
            curvature=self.curvature * factor,
            density_curvature=self.density_curvature * factor,
        )


def log_viscosity(law: Isotherm, p: Any) -> tuple[Any, Any]:
    """ln(eta/eta0) and its derivative.

    ============  =====================================================  ==========================================
    LINEAR        alpha p                                                Barus
    RATIONAL      alpha p/(1 + q p)                                      FVA 3
    LOGARITHMIC   (alpha/q) ln(1 + q p)                                  POWER in the limit z = 0
    POWER         (alpha/(z q)) ((1 + q p)^z - 1)                        Roelands
    FREE_VOLUME   (alpha/q) g/(1 - g/c), g = ln(1 + q p)                 Doolittle and Tait, see `FreeVolume`
    ============  =====================================================  ==========================================

    Parameters
    ----------
    law : Isotherm
        The law.
    p : float or ndarray
        Pressures in the unit of the law, >= 0.
    """
    alpha, q, shape = law.alpha, law.curvature, law.shape
    if law.form == LINEAR:
        return alpha * p, alpha + 0.0 * p
    if law.form == RATIONAL:
        f = 1.0 / (1.0 + q * p)
        return alpha * p * f, alpha * f * f
    if law.form == LOGARITHMIC:
        return alpha / q * np.log1p(q * p), alpha / (1.0 + q * p)
    if law.form == POWER:
        growth = np.expm1(shape * np.log1p(q * p))
        return alpha / (shape * q) * growth, alpha * (1.0 + growth) / (1.0 + q * p)
    # FREE_VOLUME: along the tangent where hardly any free volume is left, as the law ends at a finite pressure
    inside = np.minimum(p, np.expm1(MOST_FREE_VOLUME_USED * shape) / q)
    g = np.log1p(q * inside)
    left = 1.0 - g / shape
    slope = alpha / ((1.0 + q * inside) * left * left)
    return alpha / q * g / left + slope * (p - inside), slope


def density(law: Isotherm, p: Any) -> tuple[Any, Any]:
    """rho/rho0 = (1 + 1.34 kappa p)/(1 + kappa p) and its derivative.

    Parameters
    ----------
    law : Isotherm
        The law.
    p : float or ndarray
        Pressures in the unit of the law, >= 0.

    References
    ----------
    D. Dowson, G. R. Higginson, Elasto-Hydrodynamic Lubrication, Pergamon, 1966.
    """
    t = law.density_curvature * p
    ratio = (1.0 + (1.0 + DENSITY_RISE) * t) / (1.0 + t)
    return ratio, DENSITY_RISE * law.density_curvature / (1.0 + t) ** 2


class _OverPressure:
    """Common part of the isotherms with names."""

    def isotherm(self, pressure_unit: float = 1.0, compressible: bool = False) -> Isotherm:
        """Plain numbers of the law, see the classes."""
        raise NotImplementedError

    def log_ratio(self, p: Values) -> Values:
        """ln(eta/eta0) at the pressures p [Pa], >= 0."""
        return as_given(log_viscosity(self.isotherm(), p)[0], p)

    def log_ratio_slope(self, p: Values) -> Values:
        """D ln(eta)/dp [1/Pa] at the pressures p [Pa], >= 0."""
        return as_given(log_viscosity(self.isotherm(), p)[1], p)


@dataclass(frozen=True)
class PressureViscosity(_OverPressure):
    """One isotherm of the family ln(eta/eta0) = (alpha p_c/z) [(1 + p/p_c)^z - 1].

    z = 1 is Barus' law alpha p, for any p_c; z = 0 is the limit alpha p_c ln(1 + p/p_c); Roelands has
    p_c = 1.96e8 Pa and alpha = z (ln eta0 + 9.67)/p_c; z = -1 is p/(a + b p) with alpha = 1/a, p_c = a/b.

    Attributes
    ----------
    pressure_viscosity : float
        alpha = d ln eta/dp at p = 0 [1/Pa], >= 0.
    exponent : float
        Exponent z of the law.
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
        problems = _coefficient_problem(self.pressure_viscosity)
        if not math.isfinite(self.exponent):
            problems.append(f"exponent: got {self.exponent!r}; allowed: finite")
        if not self.pressure_scale > 0 or (math.isinf(self.pressure_scale) and self.exponent != 1.0):
            problems.append(
                f"pressure_scale: got {self.pressure_scale!r} Pa with the exponent {self.exponent!r}; "
                "allowed: > 0 Pa, and inf only with the exponent 1"
            )
        if problems:
            raise InputError(problems)

    def isotherm(self, pressure_unit: float = 1.0, compressible: bool = False) -> Isotherm:
        """The law in plain numbers.

        Parameters
        ----------
        pressure_unit : float
            Unit of its pressures [Pa].
        compressible : bool
            Density after Dowson and Higginson if true, constant if false.
        """
        form = {1.0: LINEAR, -1.0: RATIONAL, 0.0: LOGARITHMIC}.get(self.exponent, POWER)
        curvature = pressure_unit / self.pressure_scale
        if curvature == 0.0:
            form = LINEAR
        alpha = self.pressure_viscosity * pressure_unit
        return Isotherm(form, alpha, curvature, self.exponent, _density_curvature(pressure_unit, compressible))

    @property
    def case_name(self) -> str:
        """Name of the law in a case of ehlFoam."""
        return {1.0: "Barus", -1.0: "FVA3"}.get(self.exponent, "Roelands")

    def case_numbers(self) -> dict[str, float]:
        """Its numbers there, by attribute.

        Raises
        ------
        InputError
            With an exponent that no law of ehlFoam has.
        """
        numbers = {"pressure_viscosity": self.pressure_viscosity}
        if self.exponent == 1.0:
            return numbers
        if self.exponent == -1.0:
            return numbers | {"pressure_scale": self.pressure_scale}
        if not self.exponent > 0.0:
            raise InputError(
                f"exponent: got {self.exponent!r}; allowed: > 0 (Roelands), 1 (Barus) or -1 (FVA 3); "
                "use the solver reynolds for other laws"
            )
        return numbers | {"exponent": self.exponent, "pressure_scale": self.pressure_scale}


@dataclass(frozen=True)
class FreeVolume(_OverPressure):
    """One isotherm of Doolittle's free-volume law with the volume of Tait's equation.

    Doolittle: ln eta = const + B/(V/V_occ - 1); Tait: V/V0 = 1 - ln(1 + (1 + K0') p/K0)/(1 + K0'). With the
    occupied part r = V_occ/V0 of the volume at p = 0 both together are

        ln(eta/eta0) = alpha p_c g/(1 - g/c),   g = ln(1 + p/p_c),
        p_c = K0/(1 + K0'),  c = (1 + K0') (1 - r),  alpha = B r/((1 - r)^2 K0).

    Unlike the other laws it can bend up: at high pressures viscosity grows faster than by exp(alpha p).

    Attributes
    ----------
    pressure_viscosity : float
        alpha = d ln eta/dp at p = 0 [1/Pa], >= 0.
    pressure_scale : float
        p_c [Pa], > 0.
    free_volume : float
        c, the value of g at which no free volume is left, > 0 and at most 500. Above g = 0.9 c, far outside of what
        can be measured, ln eta goes on along its tangent, since the law ends at a finite pressure.

    Raises
    ------
    InputError
        With every value out of these limits.

    References
    ----------
    A. K. Doolittle, Studies in Newtonian flow II: the dependence of the viscosity of liquids on free-space, J. Appl.
    Phys. 22, 1951, 1471-1475. J. H. Dymond, R. Malhotra, The Tait equation: 100 years on, Int. J. Thermophys. 9,
    1988, 941-951.

    Examples
    --------
    Half of the free volume is used up where g = c/2:

    >>> law = FreeVolume(2e-8, pressure_scale=1e8, free_volume=4.0)
    >>> round(law.log_ratio(1e8 * math.expm1(2.0)), 6), 2e-8 * 1e8 * 2.0 / 0.5
    (8.0, 8.0)
    """

    case_name: ClassVar[str] = "freeVolume"
    """Name of the law in a case of ehlFoam."""

    pressure_viscosity: float
    pressure_scale: float
    free_volume: float

    def __post_init__(self) -> None:
        problems = _coefficient_problem(self.pressure_viscosity)
        if not 0 < self.pressure_scale < math.inf:
            problems.append(f"pressure_scale: got {self.pressure_scale!r} Pa; allowed: finite and > 0 Pa")
        if not 0 < self.free_volume <= 500.0:
            problems.append(f"free_volume: got {self.free_volume!r}; allowed: > 0 and at most 500; oils have about 4")
        if problems:
            raise InputError(problems)

    def isotherm(self, pressure_unit: float = 1.0, compressible: bool = False) -> Isotherm:
        """The law in plain numbers; parameters as those of `PressureViscosity.isotherm`."""
        return Isotherm(
            FREE_VOLUME,
            self.pressure_viscosity * pressure_unit,
            pressure_unit / self.pressure_scale,
            self.free_volume,
            _density_curvature(pressure_unit, compressible),
        )

    def case_numbers(self) -> dict[str, float]:
        """Its numbers in a case of ehlFoam, by attribute."""
        return {
            "pressure_viscosity": self.pressure_viscosity,
            "pressure_scale": self.pressure_scale,
            "free_volume": self.free_volume,
        }


IsothermLaw = PressureViscosity | FreeVolume


def _density_curvature(pressure_unit: float, compressible: bool) -> float:
    """Kappa of the density law."""
    return pressure_unit / DENSITY_PRESSURE if compressible else 0.0


def _coefficient_problem(alpha: float) -> list[str]:
    """Problems of a pressure-viscosity coefficient."""
    if math.isfinite(alpha) and alpha >= 0:
        return []
    return [
        f"pressure_viscosity: got {alpha!r} 1/Pa; allowed: finite and >= 0; mineral oils have about 2e-8 1/Pa",
    ]


@dataclass(frozen=True)
class LubricantState:
    """An oil at one temperature: all that an isothermal solver needs.

    Attributes
    ----------
    temperature : float
        [K].
    viscosity : float
        eta0 at ambient pressure [Pa s].
    density : float
        rho0 at ambient pressure [kg/m3].
    pressure_viscosity : PressureViscosity or FreeVolume
        The isotherm ln(eta/eta0) over pressure.
    compressible : bool
        Density after Dowson and Higginson if true, constant if false.
    fitted_pressure : float
        Highest pressure [Pa] at which the viscosity law was fitted; it is extrapolated above; inf if unknown.
    """

    temperature: float
    viscosity: float
    density: float
    pressure_viscosity: IsothermLaw
    compressible: bool
    fitted_pressure: float

    def isotherm(self, pressure_unit: float = 1.0) -> Isotherm:
        """Viscosity and density over pressure as plain numbers, with pressures in `pressure_unit` [Pa]."""
        return self.pressure_viscosity.isotherm(pressure_unit, self.compressible)

    def viscosity_at(self, p: Values) -> Values:
        """Viscosity eta [Pa s] at the pressures p [Pa], >= 0; inf where it exceeds the range of floats."""
        with np.errstate(over="ignore"):
            return as_given(self.viscosity * np.exp(self.pressure_viscosity.log_ratio(p)), p)

    def density_ratio(self, p: Values) -> Values:
        """rho/rho0 at the pressures p [Pa], >= 0, after Dowson and Higginson; 1 if incompressible."""
        return as_given(density(self.isotherm(), p)[0], p)

    def density_ratio_slope(self, p: Values) -> Values:
        """d(rho/rho0)/dp [1/Pa] at the pressures p [Pa], >= 0."""
        return as_given(density(self.isotherm(), p)[1], p)
