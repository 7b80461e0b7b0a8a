"""Poles of measured responses: the least-squares complex frequency-domain method, and rational fraction polynomials.

Poles by the least-squares complex frequency-domain method (p-LSCF with a common denominator), from sdypy-EMA.

It fits a discrete-time fraction, polynomials in exp(-j omega T) with an unweighted equation error: very well
conditioned up to high orders, with a bias where resonances stand little out of the noise. The library takes lines from
0 Hz to the end of the band, of which a narrow band fills but an arc of the unit circle. So the band is moved down, its
first line to 0 Hz, and the poles back up: what the conjugate poles have there is smooth, and left to the numerators.

Rational fraction polynomials: H_i(s) = N_i(s)/D(s) on s = j omega, one denominator for all responses.

The equation error N_i - H_i D is linear in the coefficients, but in powers of s its columns are nearly dependent, and
it weighs every line by |D|, so that noise away from the resonances wins. Two remedies: polynomials that are orthogonal
on the lines with the weights of the fit (Forsythe's recurrence, as an Arnoldi process with all coefficients kept), and
the weights 1/|D| of the pass before, which turn the equation error into the error of the response (Sanathanan and
Koerner). Coefficients are real, so that poles are real or conjugate pairs; the numerators have two powers more than
a proper fraction, which stand for modes above the band.

References
----------
P. Verboven, Frequency-domain system identification for modal analysis, PhD thesis, Vrije Universiteit Brussel, 2002;
sdypy-EMA, https://github.com/sdypy/sdypy-EMA.
M. H. Richardson, D. L. Formenti, Proc. 1st Int. Modal Analysis Conf. (1982) 167-181; C. K. Sanathanan, J. Koerner,
IEEE Trans. Automatic Control 8 (1963) 56-58; P. D. Brubeck, Y. Nakatsukasa, L. N. Trefethen, SIAM Review 63 (2021)
405-415 (the recurrence).
"""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ehdmaps.arrays import ComplexArray, FloatArray
from ehdmaps.errors import AnalysisError, InputError
from ehdmaps.extras import needs

_UNEVEN = 1e-3
"""Largest change of the spacing of the lines, as a part of it."""


def lscf_poles(frequency: FloatArray, response: ComplexArray, orders: Sequence[int]) -> list[ComplexArray]:
    """Poles of fits of rising order.

    Parameters
    ----------
    frequency : array, shape (lines,)
        Frequencies of the band, evenly spaced, > 0 [Hz].
    response : array of complex, shape (rows, lines)
        Any unit; rows are scaled to their rms.
    orders : sequence of int
        Rising numbers of pole pairs.

    Returns
    -------
    list of array of complex
        Poles with positive imaginary part for each order [1/s].

    Raises
    ------
    InputError
        If the lines are not evenly spaced.
    DependencyError
        If the library is not installed.
    AnalysisError
        If the normal equations are singular.
    """
    with needs("modal", "sdypy-EMA", "--method lscf"):
        # It takes a display toolkit along, which is only loaded, never used.
        from sdypy.EMA import Model
    spacing = float(frequency[-1] - frequency[0]) / (frequency.size - 1)
    if np.abs(np.diff(frequency) - spacing).max() > _UNEVEN * spacing:
        raise InputError(
            "--method lscf: got lines that are not evenly spaced; allowed: the lines of a Fourier transform; or use "
            "--method rfp"
        )
    # The library leaves out the last line, and needs one below its lower end.
    lines = np.arange(frequency.size + 2) * spacing
    size = np.sqrt(np.mean(np.abs(response) ** 2, axis=1, keepdims=True))
    values = np.zeros((response.shape[0], lines.size), dtype=np.complex128)
    values[:, 1:-1] = response / np.where(size > 0.0, size, 1.0)
    try:
        with warnings.catch_warnings():
            # Of numpy and of the library about poles that are left out later.
            warnings.simplefilter("ignore")
            model = Model(
                values,
                lines,
                lower=float(lines[1]),
                upper=float(lines[-1]),
                pol_order_high=int(orders[-1]),
                frf_form="accelerance",
            )
            model.get_poles(method="lscf", show_progress=False)
    except (np.linalg.LinAlgError, ValueError, FloatingPointError) as error:
        raise AnalysisError(
            f"p-LSCF: no poles up to order {orders[-1]} ({error}); widen the band or lower the order"
        ) from error
    moved = 2j * np.pi * (frequency[0] - lines[1])
    poles = [np.asarray(values, dtype=np.complex128) for values in model.all_poles]
    return [_upper(poles[order - 1], moved) for order in orders]


def _upper(poles: ComplexArray, moved: complex) -> ComplexArray:
    """Poles above 0 Hz of the moved band, moved back."""
    kept = np.isfinite(poles) & (poles.imag > 0.0)
    return np.asarray(poles[kept] + moved, dtype=np.complex128)


IMPROPER = 2
"""Powers of the numerators above those of a proper fraction."""

PASSES = 2
"""Reweighted passes for each order; the weights go on from the order before."""

_SMALLEST = 1e-9
"""Size of a denominator on a line, against the largest, below which it is taken for rounding."""


@dataclass(frozen=True, eq=False)
class Basis:
    """Polynomials in s with real coefficients, orthonormal on the lines with weights.

    Attributes
    ----------
    values : array of complex, shape (lines, degree + 1)
        Weight times polynomial on the lines.
    recurrence : array, shape (degree + 1, degree)
        s times polynomial k = sum over j of recurrence[j, k] times polynomial j.
    """

    values: ComplexArray
    recurrence: FloatArray


def orthogonal_basis(s: ComplexArray, weight: FloatArray, degree: int) -> Basis:
    """Polynomials that are orthonormal in Re sum(conj(p) q weight^2).

    On the lines and their mirror images at negative frequency that is the sum itself, so the coefficients stay real.

    Parameters
    ----------
    s : array of complex, shape (lines,)
        Points of the basis.
    weight : array, shape (lines,)
        Positive on more lines than the degree.
    degree : int
        Highest degree.

    Raises
    ------
    AnalysisError
        If there are not enough lines for the degree.
    """
    values = np.empty((s.size, degree + 1), dtype=np.complex128)
    recurrence = np.zeros((degree + 1, degree))
    values[:, 0] = weight / np.linalg.norm(weight)
    for k in range(degree):
        column = s * values[:, k]
        size = float(np.linalg.norm(column))
        # Twice, because once leaves what rounding brought in.
        for _ in range(2):
            part = (values[:, : k + 1].conj().T @ column).real
            column = column - values[:, : k + 1] @ part
            recurrence[: k + 1, k] += part
        recurrence[k + 1, k] = np.linalg.norm(column)
        if not recurrence[k + 1, k] > 1e-13 * size:
            raise AnalysisError(
                f"rational fit: {s.size} lines do not carry polynomials of degree {k + 1}; widen the band, or lower "
                "the order"
            )
        values[:, k + 1] = column / recurrence[k + 1, k]
    return Basis(values, recurrence)


def roots(basis: Basis, coefficients: FloatArray) -> ComplexArray:
    """Zeros of a polynomial given in the basis: eigenvalues of its comrade matrix.

    Parameters
    ----------
    basis : Basis
        Basis of the degree of the polynomial.
    coefficients : array, shape (degree + 1,)
        The last one not zero.
    """
    degree = coefficients.size - 1
    comrade = basis.recurrence[:degree, :degree].copy()
    comrade[:, -1] -= basis.recurrence[degree, degree - 1] * coefficients[:degree] / coefficients[degree]
    return np.asarray(np.linalg.eigvals(comrade), dtype=np.complex128)


def rational_poles(
    frequency: FloatArray, response: ComplexArray, weight: FloatArray, orders: Sequence[int], passes: int = PASSES
) -> list[ComplexArray]:
    """Poles of common-denominator fits of rising order.

    Parameters
    ----------
    frequency : array, shape (lines,)
        Frequencies of the band, > 0 [Hz].
    response : array of complex, shape (rows, lines)
        Any unit.
    weight : array, shape (rows, lines)
        One over the standard deviation of each value, or relative to it.
    orders : sequence of int
        Rising numbers of pole pairs.
    passes : int
        Reweighted passes for each order.

    Returns
    -------
    list of array of complex
        2 order poles for each order, real or in conjugate pairs [1/s]; an order whose fit degenerates has none.

    Raises
    ------
    AnalysisError
        If there are not enough lines for the highest order.
    """
    scale = 2.0 * np.pi * float(frequency[-1])
    s = np.asarray(2j * np.pi * frequency / scale, dtype=np.complex128)
    size = np.ones(frequency.size)
    of_orders = []
    for order in orders:
        poles = np.zeros(0, dtype=np.complex128)
        for _ in range(passes):
            fitted = _denominator(s, response, weight / size, order)
            if fitted is None:
                poles, size = np.zeros(0, dtype=np.complex128), np.ones(frequency.size)
                break
            poles, size = fitted
        of_orders.append(poles * scale)
    return of_orders


def _denominator(
    s: ComplexArray, response: ComplexArray, weight: FloatArray, order: int
) -> tuple[ComplexArray, FloatArray] | None:
    """Zeros of the best denominator for given weights (rows, lines), and its size on the lines; None if degenerate."""
    degree = 2 * order
    weighted = response * weight
    common = np.linalg.norm(weighted, axis=0)
    # A line without any response carries no weight in the denominator.
    safe = np.maximum(common, 1e-12 * float(common.max()))
    if not (np.all(np.isfinite(safe)) and safe.min() > 0.0):
        return None
    below = orthogonal_basis(s, safe, degree)
    triangles = []
    above: Basis | None = None
    for i in range(response.shape[0]):
        # Rows often have the same weights but for a factor, which the basis does not feel.
        if above is None or not np.allclose(weight[i] * weight[i - 1, 0], weight[i - 1] * weight[i, 0], rtol=1e-9):
            above = orthogonal_basis(s, weight[i], degree - 1 + IMPROPER)
        columns = (weighted[i] / safe)[:, None] * below.values
        columns = columns - above.values @ (above.values.conj().T @ columns).real
        triangles.append(np.linalg.qr(np.concatenate([columns.real, columns.imag]), mode="r"))
    coefficients = np.linalg.svd(np.concatenate(triangles))[2][-1]
    if not np.all(np.isfinite(coefficients)) or abs(coefficients[-1]) < 1e-14:
        return None
    values = np.abs(below.values @ coefficients) / safe
    # Only the shape matters; an exact zero on a line would make its weight infinite.
    return roots(below, coefficients), np.maximum(values / values.max(), _SMALLEST)
