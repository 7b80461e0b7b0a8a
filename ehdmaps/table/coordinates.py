"""Coordinates of the table: zeta, ln L, ln alpha and the bend of ln eta over pressure.

The equations of a smooth, flooded, Newtonian, isothermal line contact know, in Hertz' units, the wedge 3 pi^2/(8 M^2),
and of the oil alpha p_H = L sqrt(M/(2 pi)), the curvature p_H/p_0 of its viscosity with the exponent z, and p_H/p_r of
its density, p_r = 0.59 GPa. p_0 of Roelands and p_r are pressures that all oils share, so that with M and L the numbers
alpha and z say all: neither the viscosity nor E' or R is left over, and one table serves every material.

zeta is counted from the bottom of the damping valley, so that what happens there stands at the same place for all oils:

    zeta = ln(M/M_valley(L)) - shift,    shift = 0.17 ln(1 + (L/40)^2) + 1.5 q/(1 + (18/L)^2),

q = (1 - z)/(alpha p_0). The shift is a fit to solved films, within 0.05; it is a coordinate, never a result.

z itself is no good axis: of two oils with the same z the one with the smaller alpha bends more before its film is shut
in. With bend = (1 - z) sqrt(ALPHA/alpha) the nodes of all alpha hold oils that there are. Barus' law has the bend 0.
"""

from __future__ import annotations

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.physics.moes import valley_load_number
from ehdmaps.physics.pressure_viscosity import ROELANDS_PRESSURE

ALPHA = 17e-9
"""alpha at which the bend is 1 - z [1/Pa]."""

HARDENING_L, BENDING_L = 40.0, 18.0
"""L at which the valley begins to move with L, and with the curvature of ln eta."""


def bend_of(alpha: FloatArray, exponent: FloatArray) -> FloatArray:
    """Bend of an oil.

    Parameters
    ----------
    alpha : ndarray
        Pressure-viscosity coefficient [1/Pa], > 0.
    exponent : ndarray
        z of Roelands' law.
    """
    return np.asarray((1.0 - exponent) * np.sqrt(ALPHA / alpha))


def exponent_of(alpha: float, bend: float) -> float:
    """Roelands' z of a bend, the inverse of `bend_of`.

    Parameters
    ----------
    alpha : float
        Pressure-viscosity coefficient [1/Pa], > 0.
    bend : float
        The bend.
    """
    return float(1.0 - bend * np.sqrt(alpha / ALPHA))


def valley_shift(oil_number: FloatArray, alpha: FloatArray, exponent: FloatArray) -> FloatArray:
    """How far the valley lies above its formula, in ln M.

    Parameters
    ----------
    oil_number : ndarray
        L, > 0.
    alpha : ndarray
        Pressure-viscosity coefficient [1/Pa].
    exponent : ndarray
        z of Roelands' law.
    """
    curvature = (1.0 - exponent) / (alpha * ROELANDS_PRESSURE)
    squared = np.square(oil_number)
    return np.asarray(
        0.17 * np.log1p(squared / HARDENING_L**2) + 1.5 * curvature * squared / (squared + BENDING_L**2), dtype=float
    )


def zeta_of(load_number: FloatArray, oil_number: FloatArray, alpha: FloatArray, exponent: FloatArray) -> FloatArray:
    """Coordinate zeta of Moes' M; other arguments as of `valley_shift`.

    Parameters
    ----------
    load_number : ndarray
        M, > 0.
    oil_number, alpha, exponent : ndarray
        The arguments of `valley_shift`.
    """
    place = np.log(load_number / valley_load_number(oil_number))
    return np.asarray(place - valley_shift(oil_number, alpha, exponent))


def load_number_at(zeta: FloatArray, oil_number: FloatArray, alpha: FloatArray, exponent: FloatArray) -> FloatArray:
    """Moes' M of a place zeta, the inverse of `zeta_of`.

    Parameters
    ----------
    zeta : ndarray
        The coordinate.
    oil_number, alpha, exponent : ndarray
        The arguments of `valley_shift`.
    """
    place = zeta + valley_shift(oil_number, alpha, exponent)
    return np.asarray(np.exp(place) * valley_load_number(oil_number))
