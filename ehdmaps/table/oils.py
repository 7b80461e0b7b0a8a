"""Oils in the coordinates of the table: alpha and Roelands' z of an isotherm, or why it has none.

Roelands' law with his p_0 is on the axes as it is, and Barus' law is its z = 1. Another isotherm gets the z with which
Roelands' law has the same viscosity at one pressure, besides the same slope at no pressure. Which pressure that is says
the film: what an inlet feels of an oil are pressures of some 1/alpha, higher ones for larger L, and still higher ones
where film compliance and loss dive through the damping valley. `matched_pressure` was fitted to solved films of FVA 3.
The z of twice that pressure tells what this is worth; of oils with another law more than that, see `MAPPED`.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import InputError
from ehdmaps.physics.isotherm import PressureViscosity
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.viscosity import ROELANDS_PRESSURE
from ehdmaps.table.interpolation import lagrange_weights

MATCHED = (0.7, 1.4, 2.8, 5.6)
"""alpha p at which the z of a law of another form is found; between them its polynomial in ln(alpha p) is read."""

BESIDE = 2.0
"""Factor of the pressure at which a mapping is tried."""

MAPPED = {
    "film_compliance": (1.0, 7.0),
    "loss_compliance": (0.5, 3.0),
    "rolling_force": (1.5, 3.0),
    "wall_stress": (1.0, 5.0),
}
MAPPED_ELSE = 1.0, 3.0
"""By what the difference of both mappings is multiplied as the error of a number: for the form of FVA 3, for which the
matched pressure was fitted, and for others. With it 95 of 100 numbers are as good as is said, with FVA 3 and a law of
its form and 22 /GPa, and with squalane's law of Tait and Doolittle."""

VALLEY_WIDTH = 0.35
"""Width in zeta of the damping valley for `matched_pressure`."""

_HIGHEST, _ROUNDS, _SMALL = 30.0, 8, 1e-5
_MATCHED = np.array(MATCHED)


@dataclass(frozen=True, eq=False)
class OilStates:
    """An oil at several temperatures, arrays of shape (n,).

    Attributes
    ----------
    viscosity, density : ndarray
        eta0 [Pa s] and rho0 [kg/m3]; NaN where the oil has no state.
    alpha : ndarray
        Pressure-viscosity coefficient [1/Pa].
    exponents : ndarray, shape (n, 4)
        z of Roelands' law, matched at the pressures of `MATCHED`; of Roelands' law itself four times the same.
    compressible : bool
        Whether the density is that of Dowson and Higginson; constant if not.
    fitted_pressure : float
        Highest pressure at which the viscosity law was fitted [Pa].
    reasons : tuple of str
        Why the oil has no state; empty where it has one.
    fitted : bool
        Whether it needs no mapping, or one that was fitted to a law of its form.
    """

    viscosity: FloatArray
    density: FloatArray
    alpha: FloatArray
    exponents: FloatArray
    compressible: bool
    fitted_pressure: float
    reasons: tuple[str, ...]
    fitted: bool


def oil_states(lubricant: Lubricant, temperatures: Sequence[float] | FloatArray) -> OilStates:
    """The oil at some temperatures.

    Parameters
    ----------
    lubricant : Lubricant
        The oil.
    temperatures : sequence of float
        [K].
    """
    nothing = (math.nan,) * 3
    rows, reasons = [], []
    exponents = np.full((len(temperatures), len(MATCHED)), math.nan)
    wanted = np.full_like(exponents, math.nan)
    fitted = True
    for i, temperature in enumerate(temperatures):
        try:
            state = lubricant.at(float(temperature))
        except InputError as error:
            rows.append(nothing)
            reasons.append("; ".join(error.problems))
            continue
        law = state.pressure_viscosity
        rows.append((state.viscosity, state.density, law.pressure_viscosity))
        reasons.append("")
        if law.pressure_viscosity == 0.0:
            exponents[i] = 1.0
        elif isinstance(law, PressureViscosity) and (law.exponent == 1.0 or law.pressure_scale == ROELANDS_PRESSURE):
            exponents[i] = law.exponent
        else:
            wanted[i] = law.log_ratio(_MATCHED / law.pressure_viscosity)
            fitted = isinstance(law, PressureViscosity) and law.exponent == -1.0
    viscosity, density, alpha = np.array(rows, dtype=float).reshape(-1, 3).T
    mapped = np.isfinite(wanted[:, 0])
    if np.any(mapped):
        exponents[mapped] = matched_exponents(alpha[mapped], wanted[mapped])
    compressible = lubricant.density_law != "incompressible"
    return OilStates(
        viscosity, density, alpha, exponents, compressible, lubricant.fitted_pressure, tuple(reasons), fitted
    )


def matched_pressure(zeta: FloatArray, oil_number: FloatArray) -> FloatArray:
    """Return the alpha p at which an oil of another law is matched.

    Parameters
    ----------
    zeta, oil_number : ndarray
        zeta of the table, and L.
    """
    dive = np.exp(-np.square(zeta / VALLEY_WIDTH)) * np.square(oil_number) / (np.square(oil_number) + 100.0)
    return np.asarray(np.clip(0.9 * oil_number**0.28, 0.9, 2.6) * (1.0 + dive))


def exponent_at(exponents: FloatArray, matched: FloatArray) -> FloatArray:
    """Return z at some alpha p, shape (n,).

    Parameters
    ----------
    exponents : ndarray, shape (n, 4)
        z at those of `MATCHED`.
    matched : ndarray, shape (n,)
        alpha p.
    """
    return np.asarray(np.sum(lagrange_weights(np.log(MATCHED), np.log(matched)) * exponents, axis=1))


def matched_exponents(alpha: FloatArray, wanted: FloatArray) -> FloatArray:
    """Z with which Roelands' law has a viscosity at the pressures of `MATCHED`, shape (n, 4).

    Parameters
    ----------
    alpha : ndarray, shape (n,)
        Pressure-viscosity coefficient [1/Pa], > 0.
    wanted : ndarray, shape (n, 4)
        ln(eta/eta0) at alpha p of `MATCHED`, > 0.

    Examples
    --------
    >>> law = PressureViscosity(2e-8, 0.6, 1.96e8)
    >>> np.round(matched_exponents(np.array([2e-8]), law.log_ratio(np.array([MATCHED]) / 2e-8)), 9)
    array([[0.6, 0.6, 0.6, 0.6]])
    """
    scale = alpha[:, None] * ROELANDS_PRESSURE
    growth = np.log1p(_MATCHED / scale)
    target = np.log(wanted / scale)
    z = np.full_like(wanted, 0.5)
    for _ in range(_ROUNDS):
        # ln((e^(z g) - 1)/z), nearly linear in z, and its slope; at z = 0 their limits
        small = np.abs(z) < _SMALL
        held = np.where(small, 1.0, z)
        rise = np.expm1(held * growth)
        value = np.where(small, np.log(growth) + 0.5 * z * growth, np.log(rise / held))
        slope = np.where(small, 0.5 * growth, growth * (1.0 + 1.0 / rise) - 1.0 / held)
        z = np.clip(z - (value - target) / slope, -_HIGHEST, _HIGHEST)
    return z


def mapping_factor(field: str, fitted: bool) -> float:
    """Factor by which the difference of two mappings is multiplied as the error of a number.

    Parameters
    ----------
    field : str
        Name of the number.
    fitted : bool
        That of `OilStates`.
    """
    return MAPPED.get(field, MAPPED_ELSE)[0 if fitted else 1]
