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

Nodes of the table of points: values, errors of the cells between them, holes; how they are read.

Cubic splines along zeta, ln L and ln kappa, linear between the oils. A cell is a hole where one of its corners has no
solution; what the splines run over there is no film, and is never given out. Below the lowest zeta all numbers go on as
powers of M, those of a rigid contact. Under heavy loads, where grids do not resolve them, they go on from lighter ones,
and cells say so; above the highest zeta there is none.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
import numpy.typing as npt
from scipy.interpolate import BSpline

from ehdmaps.arrays import BoolArray, ByteArray, FloatArray, IndexArray
from ehdmaps.physics.point.ellipse import Ellipse
from ehdmaps.table.fields import NATURAL_FREQUENCIES, Field
from ehdmaps.table.interpolation import DEGREE, cell_of, knots_of, lagrange_weights, spline_weights
from ehdmaps.table.nodes import CODES, decoded

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


FILMS = (
    Field("film_offset", 0.0, -2.0),
    Field("damping", 0.0, 2.0),
    Field("central_film", 0.0, -2.0),
    Field("minimum_film", 0.0, -2.0),
    Field("max_pressure", 0.0, 8.0 / 3.0),
)
"""Films at rest, held as logarithms of reduced numbers; slopes along zeta of a rigid contact."""

RESPONSES = tuple(
    Field(f"{part}_{natural:g}", 0.0, slope)
    for natural in NATURAL_FREQUENCIES
    for part, slope in (("stiffness", 3.0), ("damping", 0.0))
)
"""k at the natural frequencies omega sqrt(a^2 + 2 h Rx)/u as a logarithm, c over that of slow motion as it is: it turns
negative where L is large."""

FIELDS = FILMS + RESPONSES

SLOPE = "stiffness"
"""Error that is held beside those of `FIELDS`: of k, whose film compliance is the slope of the film offset."""

ERRORS = (*(field.name for field in FIELDS), SLOPE)
"""What errors are held of."""

HOLE = CODES
"""Code of the film offset in a cell without films; of another number it is the largest error."""

_OFFSET = FIELDS.index(FILMS[0])


_ALIKE = 1e-13
"""Difference of weights of points that are alike: some times their round-off."""


@dataclass(frozen=True, eq=False)
class PointPlace:
    """Place of points among the nodes.

    Attributes
    ----------
    first : tuple of ndarray, shape (n,)
        First coefficient along zeta, ln L and ln kappa.
    zeta, slope, size, shape : ndarray, shape (n, 4)
        Weights of four coefficients each; `slope` those of the derivative by zeta.
    oil : ndarray, shape (n, oils)
        Weights of the oils.
    below : ndarray, shape (n,)
        How far zeta lies below the first node, <= 0.
    cell : ndarray, shape (n,)
        Cell, counted through all axes.
    """

    first: tuple[IndexArray, IndexArray, IndexArray]
    zeta: FloatArray
    slope: FloatArray
    size: FloatArray
    shape: FloatArray
    oil: FloatArray
    below: FloatArray
    cell: IndexArray

    @property
    def alike(self) -> bool:
        """Tell whether points differ along zeta only, as films of a contact over load, but for round-off."""
        rows = (*self.first[1:], self.size, self.shape, self.oil)
        return self.below.size > 1 and all(bool(np.all(np.ptp(row, axis=0) <= _ALIKE)) for row in rows)


@dataclass(frozen=True, eq=False)
class PointNodes:
    """Values at the nodes, and errors between them.

    Attributes
    ----------
    axes : PointAxes
        The nodes.
    values : ndarray of float32, shape (n_zeta, n_size, n_shape, n_alpha, n_bend, fields)
        Forms of `FIELDS` there.
    codes : ndarray of uint8, shape (cells along each axis, errors)
        Their errors in each cell in the order of `ERRORS`, see `ehdmaps.table.nodes.decoded`; `HOLE` where a corner has
        no solution.
    continued : ndarray of bool, shape (cells along each axis)
        Cells with a number that goes on from lighter loads.
    """

    axes: PointAxes
    values: npt.NDArray[np.float32]
    codes: ByteArray
    continued: BoolArray

    def place(self, zeta: FloatArray, size: FloatArray, shape: FloatArray, oil: tuple[FloatArray, FloatArray]) -> (
        PointPlace
    ):  # fmt: skip
        """Place of points, arrays (n,); within the nodes but for zeta, which may lie below.

        Parameters
        ----------
        zeta, size, shape : ndarray, shape (n,)
            zeta, ln L, ln kappa.
        oil : (ndarray, ndarray)
            ln alpha and bend.
        """
        axes = self.axes
        held = [np.clip(x, nodes[0], nodes[-1]) for x, nodes in zip((zeta, size, shape, *oil), axes.all, strict=True)]
        along = [spline_weights(knots, x) for knots, x in zip(axes.knots, held[:3], strict=True)]
        by_alpha, by_bend = lagrange_weights(axes.alpha, held[3]), lagrange_weights(axes.bend, held[4])
        cell = [cell_of(nodes, x) for nodes, x in zip(axes.all, held, strict=True)]
        (i, by_zeta, slope), (j, by_size, _), (k, by_shape, _) = along
        return PointPlace(
            first=(i, j, k),
            zeta=by_zeta,
            slope=slope,
            size=by_size,
            shape=by_shape,
            oil=(by_alpha[:, :, None] * by_bend[:, None, :]).reshape(zeta.size, by_alpha.shape[1] * by_bend.shape[1]),
            below=np.minimum(zeta - axes.zeta[0], 0.0),
            cell=np.asarray(np.ravel_multi_index(cell, axes.cells)),
        )

    def read(self, place: PointPlace, fields: tuple[Field, ...] = FILMS) -> tuple[FloatArray, FloatArray]:
        """Forms of reduced numbers and their slopes by zeta, both (n, fields); in holes they mean nothing.

        Parameters
        ----------
        place : PointPlace
            The points.
        fields : tuple of Field
            `FILMS` or `RESPONSES`.
        """
        coefficients = self._films if fields is FILMS else self._responses
        i, j, k = place.first
        values, slopes = (np.zeros((i.size, len(fields))) for _ in range(2))
        line = _along(coefficients, place) if place.alike else None
        for p in range(DEGREE + 1):
            part = np.zeros_like(values) if line is None else line[i + p]
            for q, r in itertools.product(range(DEGREE + 1), repeat=2) if line is None else ():
                near = coefficients[i + p, j + q, k + r]
                weight = (place.size[:, q] * place.shape[:, r])[:, None] * place.oil
                part += np.einsum("no,nof->nf", weight, near)
            values += place.zeta[:, p, None] * part
            slopes += place.slope[:, p, None] * part
        rigid = np.array([field.rigid_slope for field in fields])
        lighter = place.below < 0.0
        values[lighter] += rigid * place.below[lighter, None]
        slopes[lighter] = rigid
        return values, slopes

    def errors(self, place: PointPlace) -> tuple[FloatArray, npt.NDArray[np.bool_]]:
        """Errors in the order of `ERRORS`, shape (n, errors), and whether a point lies in a hole.

        Below the lowest zeta they grow by what the slope there differs from that of a rigid contact.

        Parameters
        ----------
        place : PointPlace
            The points.
        """
        codes = self.codes.reshape(-1, len(ERRORS))[place.cell]
        found = decoded(codes)
        lighter = np.flatnonzero(place.below < 0.0)
        if lighter.size:
            found[lighter] += self._bent[None, :] * -place.below[lighter, None]
        return found, codes[:, _OFFSET] == HOLE

    @cached_property
    def _bent(self) -> FloatArray:
        """Largest difference of the slopes at the lowest zeta from those of a rigid contact, (errors,)."""
        step = self.axes.zeta[1] - self.axes.zeta[0]
        slopes = (self.values[1] - self.values[0]).reshape(-1, len(FIELDS)) / step
        rigid = np.array([field.rigid_slope for field in FIELDS])
        bent = np.max(np.abs(slopes - rigid), axis=0)
        return np.asarray(np.r_[bent, bent[_OFFSET]])

    @cached_property
    def _films(self) -> FloatArray:
        return self._coefficients(slice(0, len(FILMS)))

    @cached_property
    def _responses(self) -> FloatArray:
        return self._coefficients(slice(len(FILMS), None))

    def _coefficients(self, part: slice) -> FloatArray:
        """Coefficients of the splines of some fields, (n_zeta, n_size, n_shape, oils, fields)."""
        found = self.values[..., part].astype(float)
        for axis, (nodes, knots) in enumerate(zip(self.axes.all[:3], self.axes.knots, strict=True)):
            matrix = np.linalg.inv(BSpline.design_matrix(nodes, knots, DEGREE).toarray())
            found = np.moveaxis(np.tensordot(matrix, found, (1, axis)), 0, axis)
        *along, alphas, bends, fields = found.shape
        return np.ascontiguousarray(found.reshape(*along, alphas * bends, fields))


def _along(coefficients: FloatArray, place: PointPlace) -> FloatArray:
    """Coefficients along zeta alone, (n_zeta, fields), of points that differ in zeta only."""
    _, j, k = (int(first[0]) for first in place.first)
    near = coefficients[:, j : j + DEGREE + 1, k : k + DEGREE + 1]
    weight = place.size[0][:, None, None] * place.shape[0][:, None] * place.oil[0]
    return np.asarray(np.tensordot(near, weight, ([1, 2, 3], [0, 1, 2])))
