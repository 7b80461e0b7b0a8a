"""From poles to residues and back to responses: linear least squares, and its nonlinear refinement.

A response of quantity q (0 displacement, 1 velocity, 2 acceleration) is taken as

    H(s) = s^q (sum over modes of [r/(s - p) + r*/(s - p*)] + L/s^2 + U),    s = j omega + 1/tau

with L for the modes below the band (inertia) and U for those above it (flexibility), and 1/tau of the exponential
window that the responses have been through.

sdypy-EMA has residues too (`get_constants`), but with complex L and U, one quantity for all rows, no weights and no
window, and it refines no pole and states no uncertainty. Differences in place of the Jacobian take ten times as long.

References
----------
G. H. Golub, V. Pereyra, Inverse Problems 19 (2003) R1-R26 (variable projection; the Jacobian is Kaufman's).
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from scipy.ndimage import uniform_filter1d
from scipy.optimize import least_squares

from ehdmaps.arrays import ComplexArray, FloatArray

TERMS = 2
"""Residual terms, L and U."""

_NEIGHBOURS = 5
"""Independent lines over which the error that remains is averaged: about as many as a resonance has, which noise may
follow."""


@dataclass(frozen=True, eq=False)
class Parts:
    """Residues of all rows for given poles.

    Attributes
    ----------
    residues : array of complex, shape (modes, rows)
        r, for each pole with positive imaginary part.
    below, above : array, shape (rows,)
        L and U.
    """

    residues: ComplexArray
    below: FloatArray
    above: FloatArray


def laplace(frequency: FloatArray, decay: float) -> ComplexArray:
    """s = j omega + decay at frequencies [Hz], shape (lines,) [1/s]."""
    return np.asarray(2j * np.pi * frequency + decay, dtype=np.complex128)


def fit_residues(
    s: ComplexArray, response: ComplexArray, weight: FloatArray, derivatives: tuple[int, ...], poles: ComplexArray
) -> Parts:
    """Residues and residual terms by weighted linear least squares.

    Parameters
    ----------
    s : array of complex, shape (lines,)
        See `laplace`.
    response : array of complex, shape (rows, lines)
        What is fitted.
    weight : array, shape (rows, lines)
        One over the standard deviation.
    derivatives : tuple of int, shape (rows,)
        q of each row.
    poles : array of complex, shape (modes,)
        Those with positive imaginary part.
    """
    shapes = _shapes(s, poles)
    by_row = []
    for columns, rows, values in _grouped(s, shapes, response, weight, derivatives):
        by_row += list(zip(rows, _solve(columns, values).T, strict=True))
    solution = np.stack([parameters for _, parameters in sorted(by_row, key=lambda pair: pair[0])], axis=1)
    modes = poles.size
    scaled = solution[TERMS:]
    reference = _reference(s)
    return Parts(
        scaled[:modes] + 1j * scaled[modes:], solution[0] * reference**2, np.asarray(solution[1], dtype=np.float64)
    )


def synthesise(s: ComplexArray, derivatives: tuple[int, ...], poles: ComplexArray, parts: Parts) -> ComplexArray:
    """Responses of modes and residual terms, shape (rows, lines).

    Parameters
    ----------
    s : array of complex, shape (lines,)
        See `laplace`.
    derivatives : tuple of int, shape (rows,)
        q of each row.
    poles : array of complex, shape (modes,)
        Those with positive imaginary part.
    parts : Parts
        Residues of the modes.
    """
    reference = _reference(s)
    parameters = np.stack([parts.below / reference**2, parts.above, *parts.residues.real, *parts.residues.imag])
    return np.asarray((_shapes(s, poles) @ parameters).T * s ** np.array(derivatives)[:, None], dtype=np.complex128)


def refine(
    s: ComplexArray, response: ComplexArray, weight: FloatArray, derivatives: tuple[int, ...], poles: ComplexArray
) -> tuple[ComplexArray, FloatArray, FloatArray]:
    """Poles of the least weighted error of the responses, which is the likeliest one for Gaussian noise.

    The equation error of a rational fit, however weighted, has a bias where there is noise; this has none of first
    order.

    Parameters
    ----------
    s, response, weight, derivatives
        The same as for `fit_residues`.
    poles : array of complex, shape (modes,)
        Poles to begin with.

    Returns
    -------
    poles : array of complex, shape (modes,)
        The refined ones.
    deviation : array, shape (modes, 2)
        Standard deviations of real and imaginary part [1/s], by the error that remains around each line, so that noise
        may grow with the response; with an exponential window by the mean error, for noise that is white in time before
        it. What else is wrong, such as a record cut off, is not in them.
    strayed : array, shape (modes,)
        How far each moved, over the larger of its half widths before and after. Above about 1 it went elsewhere: it
        was no mode.
    """
    modes = poles.size
    # A pole is known to a fraction of its half width in the data, which is the natural unit of its change.
    unit = np.abs(poles.real - s[0].real) + 1e-9 * np.abs(poles)

    def at(parameters: FloatArray) -> ComplexArray:
        return np.asarray(poles + unit * (parameters[:modes] + 1j * parameters[modes:]), dtype=np.complex128)

    def error(parameters: FloatArray) -> FloatArray:
        shapes = _shapes(s, at(parameters))
        pieces = [
            (values - columns @ _solve(columns, values)).T.ravel()
            for columns, _, values in _grouped(s, shapes, response, weight, derivatives)
        ]
        return np.concatenate(pieces)

    def slope(parameters: FloatArray) -> FloatArray:
        now = at(parameters)
        shapes = _shapes(s, now)
        pieces = []
        for columns, rows, values in _grouped(s, shapes, response, weight, derivatives):
            solution = _solve(columns, values)
            q, _ = np.linalg.qr(columns)
            scale = weight[rows[0]] * s ** derivatives[rows[0]]
            block = np.empty((values.shape[1], values.shape[0], 2 * modes))
            for k in range(modes):
                residue = solution[TERMS + k] + 1j * solution[TERMS + modes + k]
                plus = residue[None, :] / (s[:, None] - now[k]) ** 2
                minus = residue.conj()[None, :] / (s[:, None] - now[k].conjugate()) ** 2
                for column, change in ((k, plus + minus), (modes + k, 1j * (plus - minus))):
                    stacked = _stacked(change.T * scale * unit[k])
                    block[:, :, column] = -(stacked - q @ (q.T @ stacked)).T
            pieces.append(block.reshape(-1, 2 * modes))
        return np.concatenate(pieces)

    fit = least_squares(error, np.zeros(2 * modes), jac=slope, method="trf", x_scale=1.0, max_nfev=50)
    refined = at(np.asarray(fit.x, dtype=np.float64))
    degrees = max(fit.fun.size - 2 * modes - response.shape[0] * 2 * (modes + 1), 1)
    jacobian = np.asarray(fit.jac, dtype=np.float64)
    inverse = np.linalg.pinv(jacobian.T @ jacobian)
    sized = jacobian * (math.sqrt(fit.fun.size / degrees) * _local(fit.fun, s))[:, None]
    covariance = inverse @ _information(sized, s) @ inverse
    deviation = np.sqrt(np.maximum(np.diag(covariance), 0.0)).reshape(2, modes).T * unit[:, None]
    strayed = np.abs(refined - poles) / np.maximum(unit, np.abs(refined.real - s[0].real))
    return refined, deviation, np.where(refined.imag > 0.0, strayed, np.inf)


def _local(error: FloatArray, s: ComplexArray) -> FloatArray:
    """Rms of the error over neighbouring lines of a row, of real and imaginary parts together, of the same shape."""
    lines = s.size
    squares = error.reshape(-1, 2, lines) ** 2
    if s[0].real > 0.0:  # of a window: few lines are independent of each other, and their mean is what is known
        return np.full(error.shape, math.sqrt(float(squares.mean())))
    smooth = uniform_filter1d(squares.mean(axis=1), min(_NEIGHBOURS, lines), axis=1, mode="nearest")
    return np.asarray(np.sqrt(np.repeat(smooth[:, None], 2, axis=1)).ravel(), dtype=np.float64)


def _information(jacobian: FloatArray, s: ComplexArray) -> FloatArray:
    """J' R J for errors of correlation R, the rows of J in units of their size, shape (parameters, parameters).

    An exponential window w(t) makes the errors of neighbouring lines alike: R is the transform of w^2. So the columns
    are transformed back to time and weighted there. Without a window it is J' J.
    """
    decay, lines = float(s[0].real), s.size
    spacing = float(s[-1].imag - s[0].imag) / (2.0 * np.pi * (lines - 1))
    first = round(float(s[0].imag) / (2.0 * np.pi * spacing))
    if decay == 0.0:
        return np.asarray(jacobian.T @ jacobian)
    samples = 2 * (first + lines)
    power = np.exp(-2.0 * decay * np.arange(samples) / (samples * spacing))
    power /= np.mean(power)
    total = np.zeros((jacobian.shape[1], jacobian.shape[1]))
    # Real parts of the lines of a row, then imaginary parts.
    for block in jacobian.reshape(-1, 2 * lines, jacobian.shape[1]):
        spectrum = np.zeros((samples // 2 + 1, jacobian.shape[1]), dtype=np.complex128)
        spectrum[first : first + lines] = block[:lines] + 1j * block[lines:]
        course = np.fft.irfft(spectrum, samples, axis=0)
        total += 0.5 * samples * (course * power[:, None]).T @ course
    return total


def _reference(s: ComplexArray) -> float:
    """Frequency that makes the columns of about one size [1/s]."""
    return float(np.sqrt(np.abs(s[0]) * np.abs(s[-1])))


def _shapes(s: ComplexArray, poles: ComplexArray) -> ComplexArray:
    """Responses of unit parameters for q = 0: L, U, then real and imaginary parts of the residues."""
    plus = 1.0 / (s[:, None] - poles)
    minus = 1.0 / (s[:, None] - poles.conj())
    terms = np.stack([(_reference(s) / s) ** 2, np.ones(s.size)], axis=1)
    return np.concatenate([terms, plus + minus, 1j * (plus - minus)], axis=1)


def _grouped(
    s: ComplexArray,
    shapes: ComplexArray,
    response: ComplexArray,
    weight: FloatArray,
    derivatives: tuple[int, ...],
) -> Iterator[tuple[FloatArray, list[int], FloatArray]]:
    """Yield columns, rows and values of the rows that share a weight and a quantity: one factorisation serves all."""
    left = list(range(response.shape[0]))
    while left:
        first = left[0]
        rows = [
            row
            for row in left
            if derivatives[row] == derivatives[first] and (row == first or np.array_equal(weight[row], weight[first]))
        ]
        left = [row for row in left if row not in rows]
        factor = weight[first] * s ** derivatives[first]
        yield _stacked((shapes * factor[:, None]).T), rows, _stacked(response[rows] * weight[first])


def _stacked(rows: ComplexArray) -> FloatArray:
    """Real above imaginary parts, a column a row."""
    return np.concatenate([rows.real, rows.imag], axis=1).T


def _solve(columns: FloatArray, values: FloatArray) -> FloatArray:
    """Least squares with columns scaled to one."""
    size = np.linalg.norm(columns, axis=0)
    size = np.where(size > 0.0, size, 1.0)
    solution = np.linalg.lstsq(columns / size, values, rcond=None)[0]
    return np.asarray(solution / size[:, None], dtype=np.float64)
