"""Poles by the least-squares complex frequency-domain method (p-LSCF with a common denominator), from sdypy-EMA.

It fits a discrete-time fraction, polynomials in exp(-j omega T) with an unweighted equation error: very well
conditioned up to high orders, with a bias where resonances stand little out of the noise. The library takes lines from
0 Hz to the end of the band, of which a narrow band fills but an arc of the unit circle. So the band is moved down, its
first line to 0 Hz, and the poles back up: what the conjugate poles have there is smooth, and left to the numerators.

References
----------
P. Verboven, Frequency-domain system identification for modal analysis, PhD thesis, Vrije Universiteit Brussel, 2002;
sdypy-EMA, https://github.com/sdypy/sdypy-EMA.
"""

from __future__ import annotations

import warnings
from collections.abc import Sequence

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
    poles = [np.asarray(found, dtype=np.complex128) for found in model.all_poles]
    return [_upper(poles[order - 1], moved) for order in orders]


def _upper(poles: ComplexArray, moved: complex) -> ComplexArray:
    """Poles above 0 Hz of the moved band, moved back."""
    kept = np.isfinite(poles) & (poles.imag > 0.0)
    return np.asarray(poles[kept] + moved, dtype=np.complex128)
