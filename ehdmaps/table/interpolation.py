"""Between the nodes: cubic splines along zeta and ln L, polynomials through all nodes of ln alpha and the bend.

Beyond the ends the numbers go on with the slope that they have there. Below the lowest zeta they go over to the powers
of a rigid film. Above the highest one films go on as powers of M, film compliance and loss fade, and responses come to
rest. Below the lowest L all are linear in L, as an oil of hardly any piezoviscosity is.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.interpolate import BSpline, make_interp_spline
from scipy.ndimage import maximum_filter1d

from ehdmaps.arrays import FloatArray, IndexArray
from ehdmaps.table.fields import Field

DEGREE = 3
_BLOCK = 4096
"""Points that are read at a time: their coefficients stay in the cache of the processor."""


@dataclass(frozen=True, eq=False)
class Axes:
    """Nodes of the table along its four coordinates.

    Attributes
    ----------
    zeta, log_l, log_alpha, bend : ndarray
        Rising nodes of zeta, ln L, ln alpha [ln 1/Pa] and the bend, see `ehdmaps.table.coordinates`.
    """

    zeta: FloatArray
    log_l: FloatArray
    log_alpha: FloatArray
    bend: FloatArray

    @property
    def shape(self) -> tuple[int, int, int, int]:
        """Nodes along each axis."""
        return self.zeta.size, self.log_l.size, self.log_alpha.size, self.bend.size

    @cached_property
    def knots(self) -> tuple[FloatArray, FloatArray]:
        """Knots of the splines along zeta and ln L."""
        return _knots(self.zeta), _knots(self.log_l)


@dataclass(frozen=True, eq=False)
class Place:
    """Where points stand among the nodes, and with what weights these count.

    Attributes
    ----------
    first : ndarray, shape (n, 2)
        First coefficient along zeta and ln L.
    zeta, log_l : ndarray, shape (n, 4)
        Weights of four coefficients each.
    zeta_slope, log_l_slope : ndarray, shape (n, 4)
        Their derivatives.
    oil : ndarray, shape (n, n_alpha n_bend)
        Weights of the nodes of ln alpha and the bend.
    below, above : ndarray, shape (n,)
        How far zeta lies below the first node, <= 0, and above the last, >= 0.
    flatter : ndarray, shape (n,)
        L over that of the first node, less one, where it lies below; 0 elsewhere.
    nearest : ndarray, shape (n,)
        Nearest node of the table, counted through all axes.
    """

    first: IndexArray
    zeta: FloatArray
    log_l: FloatArray
    zeta_slope: FloatArray
    log_l_slope: FloatArray
    oil: FloatArray
    below: FloatArray
    above: FloatArray
    flatter: FloatArray
    nearest: IndexArray


def place_of(axes: Axes, zeta: FloatArray, log_l: FloatArray, log_alpha: FloatArray, bend: FloatArray) -> Place:
    """Place of points, arrays of one shape (n,); ln alpha and the bend have to lie within their nodes.

    Parameters
    ----------
    axes : Axes
        Nodes of the table.
    zeta, log_l, log_alpha, bend : ndarray, shape (n,)
        Coordinates of the points.
    """
    held, held_l = np.clip(zeta, axes.zeta[0], axes.zeta[-1]), np.clip(log_l, axes.log_l[0], axes.log_l[-1])
    away = zeta - held
    (i, along, slope), (j, along_l, slope_l) = (
        _weights(knots, x) for knots, x in zip(axes.knots, (held, held_l), strict=True)
    )
    by_alpha, by_bend = lagrange_weights(axes.log_alpha, log_alpha), lagrange_weights(axes.bend, bend)
    near = [
        _nearest(nodes, x)
        for nodes, x in zip(
            (axes.zeta, axes.log_l, axes.log_alpha, axes.bend), (held, held_l, log_alpha, bend), strict=True
        )
    ]
    return Place(
        first=np.column_stack([i, j]),
        zeta=along,
        log_l=along_l,
        zeta_slope=slope,
        log_l_slope=slope_l,
        oil=(by_alpha[:, :, None] * by_bend[:, None, :]).reshape(zeta.size, by_alpha.shape[1] * by_bend.shape[1]),
        below=np.minimum(away, 0.0),
        above=np.maximum(away, 0.0),
        flatter=np.expm1(np.minimum(log_l - held_l, 0.0)),
        nearest=np.ravel_multi_index(near, axes.shape),
    )


def coefficients(axes: Axes, values: FloatArray) -> FloatArray:
    """Spline coefficients of values at the nodes, for `read`.

    Parameters
    ----------
    axes : Axes
        The nodes.
    values : ndarray, shape (n_zeta, n_L, n_alpha, n_bend, fields)
        Values there.

    Returns
    -------
    ndarray, shape (n_zeta, n_L, n_alpha n_bend, fields)
    """
    n, m, k, p, fields = values.shape
    first, second = (_inverse(nodes, knots) for nodes, knots in zip((axes.zeta, axes.log_l), axes.knots, strict=True))
    along = (first @ values.reshape(n, -1)).reshape(n, m, k * p * fields)
    return np.ascontiguousarray((second @ along).reshape(n, m, k * p, fields))


def read(place: Place, coefficients: FloatArray, fields: Sequence[Field]) -> FloatArray:
    """Smooth forms of some fields at points, shape (n, fields).

    Parameters
    ----------
    place : Place
        The points.
    coefficients : ndarray, shape (n_zeta, n_L, oils, fields)
        Coefficients of these fields.
    fields : sequence of Field
        The fields.
    """
    found = np.empty((place.below.size, len(fields)))
    for start in range(0, found.shape[0], _BLOCK):
        part = slice(start, start + _BLOCK)
        found[part] = _read(place, part, coefficients)
    if np.any(place.below) or np.any(place.above) or np.any(place.flatter):
        _go_on(place, coefficients, fields, found)
    return found


def _read(
    place: Place, part: slice | IndexArray, coefficients: FloatArray, zeta: bool = False, log_l: bool = False
) -> FloatArray:
    """Values of some points, or their derivatives along zeta or ln L, shape (n, fields)."""
    by_zeta = (place.zeta_slope if zeta else place.zeta)[part]
    by_l = (place.log_l_slope if log_l else place.log_l)[part]
    first, four = place.first[part], np.arange(DEGREE + 1)
    near = coefficients[(first[:, 0, None] + four)[:, :, None], (first[:, 1, None] + four)[:, None, :]]
    n, fields = first.shape[0], coefficients.shape[-1]
    weights = (by_zeta[:, :, None] * by_l[:, None, :]).reshape(n, 1, -1)
    oils = coefficients.shape[2]
    summed = np.matmul(weights, near.reshape(n, (DEGREE + 1) ** 2, oils * fields)).reshape(n, oils, fields)
    return np.asarray(np.matmul(place.oil[part][:, None, :], summed)[:, 0, :])


def _go_on(place: Place, coefficients: FloatArray, fields: Sequence[Field], found: FloatArray) -> None:
    """Continue values beyond the nodes, in place: along zeta at the last L, and the derivative of this along L."""
    away = np.flatnonzero((place.below < 0.0) | (place.above > 0.0) | (place.flatter < 0.0))
    below, above, flatter = place.below[away], place.above[away], place.flatter[away]
    value, slope = found[away], _read(place, away, coefficients, zeta=True)
    by_l, slope_by_l = (_read(place, away, coefficients, zeta=zeta, log_l=True) for zeta in (False, True))
    for k, field in enumerate(fields):
        # all but what fades is linear in value and slope
        v, s = value[:, k] + flatter * by_l[:, k], slope[:, k] + flatter * slope_by_l[:, k]
        rigid = field.rigid_slope * (np.sign(v) if field.scale else 1.0)
        lighter = v + rigid * below + (s - rigid) * np.expm1(below)
        if field.fades:
            rate = np.minimum(slope[:, k] / value[:, k], 0.0)
            heavier = (v + flatter * above * (slope_by_l[:, k] - rate * by_l[:, k])) * np.exp(rate * above)
        else:
            heavier = v - s * np.expm1(-above) if field.scale else v + s * above
        found[away, k] = np.where(below < 0.0, lighter, heavier)


def _knots(nodes: FloatArray) -> FloatArray:
    """Knots of the cubic spline through nodes, that has no knot at the last node but one at either end."""
    return np.concatenate([(nodes[0],) * (DEGREE + 1), nodes[2:-2], (nodes[-1],) * (DEGREE + 1)])


def _inverse(nodes: FloatArray, knots: FloatArray) -> FloatArray:
    """Matrix from values at nodes to the coefficients of their spline."""
    return np.asarray(np.linalg.inv(BSpline.design_matrix(nodes, knots, DEGREE).toarray()))


def _weights(knots: FloatArray, x: FloatArray) -> tuple[IndexArray, FloatArray, FloatArray]:
    """First coefficient that counts at places, weights of four, and their derivatives."""
    cell = np.clip(np.searchsorted(knots, x, side="right") - 1, DEGREE, knots.size - DEGREE - 2)
    basis = [np.ones_like(x)]
    lower = basis
    for degree in range(1, DEGREE + 1):
        lower = basis
        basis = [np.zeros_like(x)]
        for r in range(degree):
            right, left = knots[cell + r + 1], knots[cell + 1 - degree + r]
            share = lower[r] / (right - left)
            basis[r] = basis[r] + (right - x) * share
            basis.append((x - left) * share)
    # derivative: DEGREE (N_{i,2}/(t_{i+3} - t_i) - N_{i+1,2}/(t_{i+4} - t_{i+1}))
    slope = [np.zeros_like(x) for _ in range(DEGREE + 1)]
    for r in range(DEGREE):
        share = DEGREE * lower[r] / (knots[cell + r + 1] - knots[cell + 1 - DEGREE + r])
        slope[r] = slope[r] - share
        slope[r + 1] = slope[r + 1] + share
    return cell - DEGREE, np.stack(basis, axis=-1), np.stack(slope, axis=-1)


def lagrange_weights(nodes: FloatArray, x: FloatArray) -> FloatArray:
    """Weights of the polynomial through all nodes, shape (n, nodes).

    Parameters
    ----------
    nodes : ndarray, shape (nodes,)
        Places at which it is known.
    x : ndarray, shape (n,)
        Places at which it is read.
    """
    apart = x[:, None] - nodes
    weights = np.empty_like(apart)
    for k in range(nodes.size):
        others = np.delete(np.arange(nodes.size), k)
        weights[:, k] = np.prod(apart[:, others], axis=1) / np.prod(nodes[k] - nodes[others])
    return weights


def _nearest(nodes: FloatArray, x: FloatArray) -> IndexArray:
    """Index of the nearest node."""
    return np.searchsorted(0.5 * (nodes[1:] + nodes[:-1]), x)


def left_out(axes: Axes, values: FloatArray) -> FloatArray:
    """What reading between the nodes is wrong by, at each node, from leaving nodes out; shape of the values.

    Along zeta and ln L each value is read from the spline through every second node and from that through every fourth.
    What all nodes leave is what every second one does, times the ratio of the two: a sixteenth where the spline
    converges, all of it where values scatter. Along ln alpha and the bend each node is read from all others; the
    polynomial with one node more is taken to be wrong by a third of that.

    Parameters
    ----------
    axes : Axes
        The nodes.
    values : ndarray, shape (n_zeta, n_L, n_alpha, n_bend, fields)
        Values there.
    """
    total = np.zeros_like(values)
    for axis, nodes in enumerate((axes.zeta, axes.log_l, axes.log_alpha, axes.bend)):
        moved = np.moveaxis(values, axis, 0)
        found = _spline_error(nodes, moved) if axis < 2 else _node_left_out(nodes, moved) / 3.0
        total += np.moveaxis(found, 0, axis)
    return total


def _spline_error(nodes: FloatArray, values: FloatArray) -> FloatArray:
    """What the spline through all nodes is wrong by between them, at each node."""
    second, fourth = _spline_left_out(nodes, values, 2), _spline_left_out(nodes, values, 4)
    with np.errstate(invalid="ignore", divide="ignore"):
        ratio = np.where(fourth > 0.0, second / fourth, 1.0)
    return np.asarray(second * np.clip(ratio, 1.0 / 16.0, 1.0))


def _spline_left_out(nodes: FloatArray, values: FloatArray, every: int) -> FloatArray:
    """Largest difference nearby of values from splines through every so many nodes."""
    found = np.zeros_like(values)
    for start in range(every):
        kept = np.unique(np.r_[0, np.arange(start, nodes.size, every), nodes.size - 1])
        if kept.size <= DEGREE:
            return np.full_like(values, np.inf) if every == 2 else np.zeros_like(values)
        spline = make_interp_spline(nodes[kept], values[kept], k=DEGREE)
        found = np.maximum(found, np.abs(spline(nodes) - values))
    return np.asarray(maximum_filter1d(found, 2 * every + 1, axis=0, mode="nearest"))


def _node_left_out(nodes: FloatArray, values: FloatArray) -> FloatArray:
    """Difference of each node's value from the polynomial through all others."""
    found = np.empty_like(values)
    for k in range(nodes.size):
        others = np.delete(np.arange(nodes.size), k)
        weights = lagrange_weights(nodes[others], nodes[k : k + 1])[0]
        found[k] = np.abs(np.tensordot(weights, values[others], axes=1) - values[k])
    return found
