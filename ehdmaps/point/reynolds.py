"""The discrete Reynolds equation of a point contact with its exact derivatives, as bands over neighbouring nodes.

A node's equation is the balance of its cell: what flows out less what flows in. As in the line contact

- the flow by pressure is exponentially fitted: ln(eta) a straight line in P between two nodes, in both directions;
- what the walls carry is interpolated from four nodes, (1, -5, 15, 5)/16, three of them upstream;
- nodes at the far end of the grid have the pressure of the tail as their equation, see `tail`.

Where the oil would have to pull, the pressure is zero instead; `newton` chooses these nodes.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from ehdmaps.arrays import BoolArray, FloatArray
from ehdmaps.compiled import njit
from ehdmaps.physics.isotherm import Isotherm, density, log_viscosity

BANDS = 7
"""Nodes that an equation looks at: itself, before, behind, both sides, two before, three before."""

_log_viscosity, _density = njit(log_viscosity), njit(density)


class Balance(NamedTuple):
    """Equations at the nodes and their derivatives.

    Attributes
    ----------
    residual : ndarray, shape (n, m)
        Outflow less inflow of each node's cell.
    by_pressure, by_film : ndarray, shape (n, m, 7)
        Derivatives by the pressures and films at the nodes of `BANDS`.
    density, density_slope, viscosity_slope : ndarray, shape (n, m)
        rho, its derivative by P, and that of ln(eta).
    """

    residual: FloatArray
    by_pressure: FloatArray
    by_film: FloatArray
    density: FloatArray
    density_slope: FloatArray
    viscosity_slope: FloatArray


@njit(error_model="numpy")
def _fluidity(first: float, second: float) -> tuple[float, float, float]:
    """Mean of 1/eta where ln(eta) goes straight from one value to another, and its derivatives by both."""
    step = second - first
    if abs(step) < 1e-3:
        mean = math.exp(-0.5 * (first + second))
        bent = 1.0 + step * step / 24.0
        return mean * bent, mean * (-0.5 * bent - step / 12.0), mean * (-0.5 * bent + step / 12.0)
    before, behind = math.exp(-first), math.exp(-second)
    mean = (before - behind) / step
    return mean, (mean - before) / step, (behind - mean) / step


@njit
def _carried(i: int) -> tuple[float, float, float, float]:
    """Weights of rho H at the nodes i-2, i-1, i, i+1 in what the walls carry from node i to the next one."""
    if i > 1:
        return 0.0625, -0.3125, 0.9375, 0.3125
    if i > 0:
        return 0.0, -0.125, 0.75, 0.375
    return 0.0, 0.0, 0.5, 0.5


@njit(error_model="numpy")
def balance(
    x: FloatArray,
    y: FloatArray,
    pressure: FloatArray,
    film: FloatArray,
    wedge: float,
    isotherm: Isotherm,
    far: BoolArray,
    rolling: FloatArray,
) -> Balance:
    """Equations at all nodes with their derivatives.

    Parameters
    ----------
    x, y : ndarray, shape (n,), (m,)
        Places of the nodes.
    pressure, film : ndarray, shape (n, m)
        P >= 0 and H > 0.
    wedge : float
        Wedge number lambda.
    isotherm : Isotherm
        The oil, pressures in p_H.
    far : ndarray of bool, shape (n, m)
        Nodes with the pressure of the tail.
    rolling : ndarray, shape (n, m)
        Their pressure times H^2/lambda, see `Tail`.
    """
    n, m = x.size, y.size
    log_eta, slope, rho, rise = np.empty((n, m)), np.empty((n, m)), np.empty((n, m)), np.empty((n, m))
    for i in range(n):
        for j in range(m):
            log_eta[i, j], slope[i, j] = _log_viscosity(isotherm, pressure[i, j])
            rho[i, j], rise[i, j] = _density(isotherm, pressure[i, j])
    residual = np.zeros((n, m))
    by_pressure, by_film = np.zeros((n, m, BANDS)), np.zeros((n, m, BANDS))
    for i in range(n - 1):
        distance = x[i + 1] - x[i]
        w2, w1, w0, wn = _carried(i)
        for j in range(m - 1):
            width = 0.5 * (y[j + 1] - y[j - 1]) if j > 0 else 0.5 * y[1]
            height, heavy = 0.5 * (film[i, j] + film[i + 1, j]), 0.5 * (rho[i, j] + rho[i + 1, j])
            thin, thin0, thin1 = _fluidity(log_eta[i, j], log_eta[i + 1, j])
            fall = (pressure[i + 1, j] - pressure[i, j]) / distance
            cube = width * height**3 / wedge
            conductance = cube * heavy * thin
            flow = -conductance * fall
            p0 = conductance / distance - cube * fall * (heavy * thin0 * slope[i, j] + 0.5 * rise[i, j] * thin)
            p1 = -conductance / distance - cube * fall * (heavy * thin1 * slope[i + 1, j] + 0.5 * rise[i + 1, j] * thin)
            h0 = h1 = -1.5 * conductance * fall / height
            flow += width * (w0 * rho[i, j] * film[i, j] + wn * rho[i + 1, j] * film[i + 1, j])
            p0 += width * w0 * rise[i, j] * film[i, j]
            p1 += width * wn * rise[i + 1, j] * film[i + 1, j]
            h0 += width * w0 * rho[i, j]
            h1 += width * wn * rho[i + 1, j]
            pb = hb = pc = hc = 0.0
            if i > 0:
                flow += width * w1 * rho[i - 1, j] * film[i - 1, j]
                pb, hb = width * w1 * rise[i - 1, j] * film[i - 1, j], width * w1 * rho[i - 1, j]
            if i > 1:
                flow += width * w2 * rho[i - 2, j] * film[i - 2, j]
                pc, hc = width * w2 * rise[i - 2, j] * film[i - 2, j], width * w2 * rho[i - 2, j]
            for k, sign in ((i, 1.0), (i + 1, -1.0)):  # out of the one node, into the next
                s = k - i
                residual[k, j] += sign * flow
                by_pressure[k, j, 0 if s == 0 else 1] += sign * p0
                by_pressure[k, j, 2 if s == 0 else 0] += sign * p1
                by_pressure[k, j, 1 if s == 0 else 5] += sign * pb
                by_pressure[k, j, 5 if s == 0 else 6] += sign * pc
                by_film[k, j, 0 if s == 0 else 1] += sign * h0
                by_film[k, j, 2 if s == 0 else 0] += sign * h1
                by_film[k, j, 1 if s == 0 else 5] += sign * hb
                by_film[k, j, 5 if s == 0 else 6] += sign * hc
    for i in range(1, n - 1):
        length = 0.5 * (x[i + 1] - x[i - 1])
        for j in range(m - 1):
            distance = y[j + 1] - y[j]
            height, heavy = 0.5 * (film[i, j] + film[i, j + 1]), 0.5 * (rho[i, j] + rho[i, j + 1])
            thin, thin0, thin1 = _fluidity(log_eta[i, j], log_eta[i, j + 1])
            fall = (pressure[i, j + 1] - pressure[i, j]) / distance
            cube = length * height**3 / wedge
            conductance = cube * heavy * thin
            p0 = conductance / distance - cube * fall * (heavy * thin0 * slope[i, j] + 0.5 * rise[i, j] * thin)
            p1 = -conductance / distance - cube * fall * (heavy * thin1 * slope[i, j + 1] + 0.5 * rise[i, j + 1] * thin)
            h0 = -1.5 * conductance * fall / height
            residual[i, j] -= conductance * fall
            by_pressure[i, j, 0] += p0
            by_pressure[i, j, 4] += p1
            by_film[i, j, 0] += h0
            by_film[i, j, 4] += h0
            residual[i, j + 1] += conductance * fall
            by_pressure[i, j + 1, 3] -= p0
            by_pressure[i, j + 1, 0] -= p1
            by_film[i, j + 1, 3] -= h0
            by_film[i, j + 1, 0] -= h0
    for i in range(n):
        for j in range(m):
            if far[i, j]:
                tail = wedge * rolling[i, j] / film[i, j] ** 2
                residual[i, j] = pressure[i, j] - tail
                for k in range(BANDS):
                    by_pressure[i, j, k] = by_film[i, j, k] = 0.0
                by_pressure[i, j, 0] = 1.0
                by_film[i, j, 0] = 2.0 * tail / film[i, j]
    return Balance(residual, by_pressure, by_film, rho, rise, slope)


@njit
def changed(found: Balance, pressure: FloatArray, film: FloatArray) -> FloatArray:
    """Change of the residual by changes of pressure and film, to first order, all of shape (n, m).

    Parameters
    ----------
    found : Balance
        The equations.
    pressure, film : ndarray, shape (n, m)
        Changes of both.
    """
    n, m = pressure.shape
    total = np.empty((n, m))
    bands, gaps = found.by_pressure, found.by_film
    for i in range(n):
        for j in range(m):
            value = bands[i, j, 0] * pressure[i, j] + gaps[i, j, 0] * film[i, j]
            for band, back in ((1, 1), (5, 2), (6, 3)):
                if i >= back:
                    value += bands[i, j, band] * pressure[i - back, j] + gaps[i, j, band] * film[i - back, j]
            if i < n - 1:
                value += bands[i, j, 2] * pressure[i + 1, j] + gaps[i, j, 2] * film[i + 1, j]
            if j > 0:
                value += bands[i, j, 3] * pressure[i, j - 1] + gaps[i, j, 3] * film[i, j - 1]
            if j < m - 1:
                value += bands[i, j, 4] * pressure[i, j + 1] + gaps[i, j, 4] * film[i, j + 1]
            total[i, j] = value
    return total


@njit(error_model="numpy")
def jacobian(
    found: Balance, kernel: FloatArray, free: BoolArray, weights: FloatArray, tail_slope: float
) -> tuple[FloatArray, FloatArray]:
    """Derivatives of the equations of free nodes, and of the load, by their pressures and H0.

    Parameters
    ----------
    found : Balance
        The equations.
    kernel : ndarray, shape (n m, n m)
        Deflection by pressures.
    free : ndarray of bool, shape (n, m)
        Nodes whose pressure is unknown; the others keep theirs.
    weights : ndarray, shape (n, m)
        Weights of the pressures in the load.
    tail_slope : float
        Derivative of the tail's load by H0.

    Returns
    -------
    matrix : ndarray, shape (k + 1, k + 1)
        The last row is the load, the last column H0. Rows are scaled to a largest entry of one.
    scale : ndarray, shape (k + 1,)
        What they were multiplied by; infinite for a row of zeros.
    """
    n, m = free.shape
    last = n * m - 1
    nodes = np.flatnonzero(free)
    count = nodes.size
    place = np.full(n * m, -1)
    moved = np.empty((n * m, count))  # of the kernel, what free pressures move
    for c in range(count):
        place[nodes[c]] = c
    for node in range(n * m):
        line, whole = moved[node], kernel[node]
        for c in range(count):
            line[c] = whole[nodes[c]]
    offsets = (0, -m, m, -1, 1, -2 * m, -3 * m)
    matrix, scale = np.empty((count + 1, count + 1)), np.empty(count + 1)
    for row in range(count):
        own, out = nodes[row], matrix[row]
        i, j = divmod(own, m)
        slopes = found.by_film[i, j]
        s0, s1, s2, s3, s4, s5, s6 = slopes[0], slopes[1], slopes[2], slopes[3], slopes[4], slopes[5], slopes[6]
        # where there is no such node its slope is zero
        h0, h1, h2 = moved[own], moved[max(own - m, 0)], moved[min(own + m, last)]
        h3, h4 = moved[max(own - 1, 0)], moved[min(own + 1, last)]
        h5, h6 = moved[max(own - 2 * m, 0)], moved[max(own - 3 * m, 0)]
        for c in range(count):
            out[c] = s0 * h0[c] + s1 * h1[c] + s2 * h2[c] + s3 * h3[c] + s4 * h4[c] + s5 * h5[c] + s6 * h6[c]
        out[count] = s0 + s1 + s2 + s3 + s4 + s5 + s6
        for k in range(BANDS):
            slope = found.by_pressure[i, j, k]
            if slope != 0.0 and place[own + offsets[k]] >= 0:
                out[place[own + offsets[k]]] += slope
    for c in range(count):
        matrix[count, c] = weights[nodes[c] // m, nodes[c] % m]
    matrix[count, count] = tail_slope
    for row in range(count + 1):
        out, largest = matrix[row], 0.0
        for c in range(count + 1):
            largest = max(largest, abs(out[c]))
        scale[row] = 1.0 / largest
        if largest > 0.0:
            for c in range(count + 1):
                out[c] *= scale[row]
    return matrix, scale
