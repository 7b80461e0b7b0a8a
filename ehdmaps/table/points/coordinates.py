"""Coordinates of the table of points: zeta, L, kappa, alpha and bend; the units that leave nothing else.

A smooth, flooded, isothermal point contact in pure rolling is told by Moes' groups M = F/(E' Rx^2) U^(-3/4) and
L = alpha E' U^(1/4), U = 2 eta0 u/(E' Rx), by the ellipticity kappa, and by the form of the oil's law: alpha itself,
which says how far the pressures reach into Roelands' law and that of the density, and the bend of
`ehdmaps.table.coordinates`. At one speed and temperature all but M stand still, so that film compliance is the slope of
the film offset along zeta.

Between rigid and elastic films stiffness rises from next to nothing to that of the dry contact, within a factor of two
in M where L is large, and damping dives beside it. Where that happens was fitted, so that it stands at zeta = 0:

    zeta = ln M - ln(4 kappa^0.92) + 0.13 ln(L/12).

It is a coordinate, never a result.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.physics.point.ellipse import Ellipse
from ehdmaps.table.interpolation import knots_of

KNEE, KNEE_OF_KAPPA, KNEE_OF_L, KNEE_L = 4.0, 0.92, 0.13, 12.0
"""Numbers of zeta."""


def point_zeta(load_number: FloatArray, oil_number: FloatArray, ellipticity: FloatArray) -> FloatArray:
    """Coordinate zeta.

    Parameters
    ----------
    load_number, oil_number, ellipticity : ndarray
        M > 0, L > 0, kappa > 0; broadcast.
    """
    place = np.log(KNEE) + KNEE_OF_KAPPA * np.log(ellipticity) - KNEE_OF_L * np.log(oil_number / KNEE_L)
    return np.asarray(np.log(load_number) - place)


def point_load_number(zeta: FloatArray, oil_number: FloatArray, ellipticity: FloatArray) -> FloatArray:
    """Moes' M of a place zeta, the inverse of `point_zeta`.

    Parameters
    ----------
    zeta, oil_number, ellipticity : ndarray
        zeta, L > 0, kappa > 0; broadcast.

    Examples
    --------
    >>> M = point_load_number(np.array(0.5), np.array(10.0), np.array(7.0))
    >>> round(float(point_zeta(M, np.array(10.0), np.array(7.0))), 12)
    0.5
    """
    return np.asarray(
        KNEE * np.exp(zeta) * ellipticity**KNEE_OF_KAPPA * (np.asarray(oil_number) / KNEE_L) ** -KNEE_OF_L
    )


@dataclass(frozen=True, eq=False)
class PointAxes:
    """Nodes of the table along its five coordinates, rising.

    Attributes
    ----------
    zeta, size, shape, alpha, bend : ndarray
        zeta, ln L, ln kappa (four nodes or more each), ln alpha [ln 1/Pa], and the bend.
    """

    zeta: FloatArray
    size: FloatArray
    shape: FloatArray
    alpha: FloatArray
    bend: FloatArray

    @property
    def all(self) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray, FloatArray]:
        """The five axes in their order."""
        return self.zeta, self.size, self.shape, self.alpha, self.bend

    @property
    def nodes(self) -> tuple[int, ...]:
        """Nodes along each axis."""
        return tuple(axis.size for axis in self.all)

    @property
    def cells(self) -> tuple[int, ...]:
        """Cells between them."""
        return tuple(axis.size - 1 for axis in self.all)

    @cached_property
    def knots(self) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Knots of the splines along zeta, ln L and ln kappa."""
        return knots_of(self.zeta), knots_of(self.size), knots_of(self.shape)


class PointUnits(NamedTuple):
    """Units by which numbers of films are divided: Moes' own, in which the load is M.

    Attributes
    ----------
    film : ndarray
        Rx U^(1/2) [m].
    stiffness : ndarray
        E' Rx U^(1/4) [N/m].
    damping : ndarray
        E' Rx^2 U^(1/2)/u [N s/m].
    pressure : ndarray
        Largest pressure of Hertz [Pa].
    """

    film: FloatArray
    stiffness: FloatArray
    damping: FloatArray
    pressure: FloatArray


def point_units(ellipse: Ellipse, load: FloatArray, speed: FloatArray, viscosity: FloatArray) -> PointUnits:
    """Units of the films of points; arrays of one shape.

    Parameters
    ----------
    ellipse : Ellipse
        The dry contact.
    load, speed, viscosity : ndarray
        F [N], u [m/s] > 0, eta0 [Pa s].
    """
    modulus, radius = ellipse.reduced_modulus, ellipse.rolling_radius
    number = 2.0 * viscosity * speed / (modulus * radius)
    root = np.sqrt(number)
    return PointUnits(
        film=radius * root,
        stiffness=modulus * radius * np.sqrt(root),
        damping=modulus * radius**2 * root / speed,
        pressure=np.asarray(ellipse.max_pressure(load)),
    )
