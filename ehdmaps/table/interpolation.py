"""Between the nodes: cubic splines along zeta and the size, polynomials through all nodes of the oil's two coordinates.

Beyond the ends the numbers go on with the slope that they have there. Below the lowest zeta they go over to the powers
of a rigid film. Above the highest one films go on as powers of M, film compliance and loss fade, and responses come to
rest. Below the lowest L or P all are linear in it, as an oil of hardly any piezoviscosity and compressibility is.
"""

from __future__ import annotations

import ctypes
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache, cached_property

import numpy as np
from scipy.interpolate import BSpline

from ehdmaps.arrays import FloatArray, IndexArray
from ehdmaps.kernel import library
from ehdmaps.kernel.record import at
from ehdmaps.table.fields import Field

DEGREE = 3


@dataclass(frozen=True, eq=False)
class Axes:
    """Nodes of the table along its four coordinates.

    Attributes
    ----------
    zeta, size, alpha, bend : ndarray
        Rising nodes. Size, alpha and bend are ln L, ln alpha [ln 1/Pa] and the bend in the piezoviscous part of a
        table, and ln P [ln Pa], alpha [1/Pa] and 1 - z in the isoviscous one, see `ehdmaps.table.coordinates`.
    """

    zeta: FloatArray
    size: FloatArray
    alpha: FloatArray
    bend: FloatArray

    @property
    def shape(self) -> tuple[int, int, int, int]:
        """Nodes along each axis."""
        return self.zeta.size, self.size.size, self.alpha.size, self.bend.size

    @property
    def cells(self) -> tuple[int, int, int, int]:
        """Cells between them."""
        n, m, k, p = self.shape
        return n - 1, m - 1, k - 1, p - 1

    @cached_property
    def knots(self) -> tuple[FloatArray, FloatArray]:
        """Knots of the splines along zeta and the size."""
        return knots_of(self.zeta), knots_of(self.size)


@dataclass(frozen=True, eq=False)
class Place:
    """Place of points among the nodes, and the weights with which these count.

    Attributes
    ----------
    first : ndarray, shape (n, 2)
        First coefficient along zeta and the size.
    zeta, size : ndarray, shape (n, 4)
        Weights of four coefficients each.
    zeta_slope, size_slope : ndarray, shape (n, 4)
        Their derivatives.
    oil : ndarray, shape (n, n_alpha n_bend)
        Weights of the nodes of alpha and bend.
    below, above : ndarray, shape (n,)
        How far zeta lies below the first node, <= 0, and above the last, >= 0.
    flatter : ndarray, shape (n,)
        L or P over that of the first node, less one, where it lies below; 0 elsewhere.
    cell : ndarray, shape (n,)
        Cell of the table, counted through all axes.
    """

    first: IndexArray
    zeta: FloatArray
    size: FloatArray
    zeta_slope: FloatArray
    size_slope: FloatArray
    oil: FloatArray
    below: FloatArray
    above: FloatArray
    flatter: FloatArray
    cell: IndexArray


def place_of(axes: Axes, zeta: FloatArray, size: FloatArray, alpha: FloatArray, bend: FloatArray) -> Place:
    """Place of points, arrays of one shape (n,); alpha and bend have to lie within their nodes.

    Parameters
    ----------
    axes : Axes
        Nodes of the table.
    zeta, size, alpha, bend : ndarray, shape (n,)
        Coordinates of the points.
    """
    held, held_size = np.clip(zeta, axes.zeta[0], axes.zeta[-1]), np.clip(size, axes.size[0], axes.size[-1])
    away = zeta - held
    (i, along, slope), (j, along_size, slope_size) = (
        spline_weights(knots, x) for knots, x in zip(axes.knots, (held, held_size), strict=True)
    )
    by_alpha, by_bend = lagrange_weights(axes.alpha, alpha), lagrange_weights(axes.bend, bend)
    all_nodes = axes.zeta, axes.size, axes.alpha, axes.bend
    cell = [cell_of(nodes, x) for nodes, x in zip(all_nodes, (zeta, size, alpha, bend), strict=True)]
    return Place(
        first=np.column_stack([i, j]),
        zeta=along,
        size=along_size,
        zeta_slope=slope,
        size_slope=slope_size,
        oil=(by_alpha[:, :, None] * by_bend[:, None, :]).reshape(zeta.size, by_alpha.shape[1] * by_bend.shape[1]),
        below=np.minimum(away, 0.0),
        above=np.maximum(away, 0.0),
        flatter=np.expm1(np.minimum(size - held_size, 0.0)),
        cell=np.ravel_multi_index(cell, axes.cells),
    )


def coefficients(axes: Axes, values: FloatArray) -> FloatArray:
    """Spline coefficients of values at the nodes, for `read`.

    Parameters
    ----------
    axes : Axes
        The nodes.
    values : ndarray, shape (n_zeta, n_size, n_alpha, n_bend, fields)
        Values there.

    Returns
    -------
    ndarray, shape (n_zeta, n_size, n_alpha n_bend, fields)
    """
    n, m, k, p, fields = values.shape
    # matrices from values at nodes to the coefficients of their splines
    first, second = (
        np.linalg.inv(BSpline.design_matrix(nodes, knots, DEGREE).toarray())
        for nodes, knots in zip((axes.zeta, axes.size), axes.knots, strict=True)
    )
    along = (first @ values.reshape(n, -1)).reshape(n, m, k * p * fields)
    return np.ascontiguousarray((second @ along).reshape(n, m, k * p, fields))


def read(place: Place, coefficients: FloatArray, fields: Sequence[Field]) -> FloatArray:
    """Smooth forms of some fields at points, shape (n, fields).

    Parameters
    ----------
    place : Place
        The points.
    coefficients : ndarray, shape (n_zeta, n_size, oils, fields)
        Coefficients of these fields.
    fields : sequence of Field
        The fields.
    """
    values = _read(place, slice(None), coefficients)
    if np.any(place.below) or np.any(place.above) or np.any(place.flatter):
        _go_on(place, coefficients, fields, values)
    return values


@cache
def _sums() -> Callable[..., None]:
    """The function of the C library that sums coefficients up."""
    pointer, count = ctypes.c_void_p, ctypes.c_int64
    return library.function("ehd_table_sums", pointer, *[count] * 4, *[pointer] * 6, result=None)


def _read(
    place: Place, part: slice | IndexArray, coefficients: FloatArray, zeta: bool = False, size: bool = False
) -> FloatArray:
    """Values of some points, or their derivatives along zeta or the size, shape (n, fields)."""
    by_zeta = (place.zeta_slope if zeta else place.zeta)[part]
    by_size = (place.size_slope if size else place.size)[part]
    sizes, oils, fields = coefficients.shape[1:]
    values = np.empty((by_zeta.shape[0], fields))
    numbers = [np.ascontiguousarray(part, np.float64) for part in (coefficients, by_zeta, by_size, place.oil[part])]
    first = np.ascontiguousarray(place.first[part], np.int64)
    room = np.empty(oils * fields)
    _sums()(
        at(numbers[0]), sizes, oils, fields, by_zeta.shape[0], at(first), *map(at, numbers[1:]), at(room), at(values)
    )
    return values


def _go_on(place: Place, coefficients: FloatArray, fields: Sequence[Field], values: FloatArray) -> None:
    """Continue values beyond the nodes, in place: along zeta at the last size, and the derivative of this along it."""
    away = np.flatnonzero((place.below < 0.0) | (place.above > 0.0) | (place.flatter < 0.0))
    below, above, flatter = place.below[away], place.above[away], place.flatter[away]
    value, slope = values[away], _read(place, away, coefficients, zeta=True)
    by_size, slope_by_size = (_read(place, away, coefficients, zeta=zeta, size=True) for zeta in (False, True))
    for k, field in enumerate(fields):
        # all but what fades is linear in value and slope
        v, s = value[:, k] + flatter * by_size[:, k], slope[:, k] + flatter * slope_by_size[:, k]
        rigid = field.rigid_slope * (np.sign(v) if field.scale else 1.0)
        lighter = v + rigid * below + (s - rigid) * np.expm1(below)
        heavier = heavier_films(field, v, s, above)
        if field.fades:
            rate = np.minimum(slope[:, k] / value[:, k], 0.0)
            heavier = (v + flatter * above * (slope_by_size[:, k] - rate * by_size[:, k])) * np.exp(rate * above)
        values[away, k] = np.where(below < 0.0, lighter, heavier)


def heavier_films(field: Field, value: FloatArray, slope: FloatArray, above: FloatArray) -> FloatArray:
    """Smooth forms above a place where value and slope along zeta are known.

    Parameters
    ----------
    field : Field
        The number.
    value, slope : ndarray
        Smooth form there, and the derivative of it.
    above : ndarray
        How far zeta lies above, >= 0.
    """
    if field.fades:
        return np.asarray(value * np.exp(np.minimum(slope / value, 0.0) * above))
    return np.asarray(value - slope * np.expm1(-above) if field.scale else value + slope * above)


@cache
def _weights() -> tuple[Callable[..., None], ...]:
    """The functions of the C library for weights of splines and of polynomials."""
    pointer, count = ctypes.c_void_p, ctypes.c_int64
    return (
        library.function("ehd_spline_weights", pointer, count, count, *[pointer] * 4, result=None),
        library.function("ehd_lagrange_weights", pointer, count, count, pointer, pointer, result=None),
    )


def knots_of(nodes: FloatArray) -> FloatArray:
    """Knots of the cubic spline through nodes, that has no knot at the last node but one at either end.

    Parameters
    ----------
    nodes : ndarray, shape (nodes,)
        Places at which it is known, four or more.
    """
    return np.concatenate([(nodes[0],) * (DEGREE + 1), nodes[2:-2], (nodes[-1],) * (DEGREE + 1)])


def spline_weights(knots: FloatArray, x: FloatArray) -> tuple[IndexArray, FloatArray, FloatArray]:
    """First coefficient that counts at places, weights of four, and their derivatives.

    Parameters
    ----------
    knots : ndarray
        Those of `knots_of`.
    x : ndarray, shape (n,)
        Places between the nodes.

    Returns
    -------
    first : ndarray, shape (n,)
    weights, slopes : ndarray, shape (n, 4)
    """
    first, (weights, slopes) = np.empty(x.size, dtype=np.int64), np.empty((2, x.size, DEGREE + 1))
    knots, x = (np.ascontiguousarray(part, np.float64) for part in (knots, x))
    _weights()[0](at(knots), knots.size, x.size, *map(at, (x, first, weights, slopes)))
    return first, weights, slopes


def lagrange_weights(nodes: FloatArray, x: FloatArray) -> FloatArray:
    """Weights of the polynomial through all nodes, shape (n, nodes).

    Parameters
    ----------
    nodes : ndarray, shape (nodes,)
        Places at which it is known.
    x : ndarray, shape (n,)
        Places at which it is read.
    """
    weights = np.empty((x.size, nodes.size))
    nodes, x = (np.ascontiguousarray(part, np.float64) for part in (nodes, x))
    _weights()[1](at(nodes), nodes.size, x.size, at(x), at(weights))
    return weights


def cell_of(nodes: FloatArray, x: FloatArray) -> IndexArray:
    """Index of the cell between nodes; that at the end for places beyond.

    Parameters
    ----------
    nodes : ndarray, shape (nodes,)
        Nodes, rising.
    x : ndarray, shape (n,)
        Places that are looked up.
    """
    return np.clip(np.searchsorted(nodes, x, side="right") - 1, 0, nodes.size - 2)
