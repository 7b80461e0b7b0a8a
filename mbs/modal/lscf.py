"""Poles of measured responses: the least-squares complex frequency-domain method, p-LSCF, of the library sdypy-EMA.

It fits a discrete-time fraction with a common denominator, polynomials in exp(-j omega T) with an unweighted equation
error: very well conditioned up to high orders, with a bias of the damping where resonances stand little out of the
noise, which `mbs.modal.residues.refine` takes out. The library takes lines from 0 Hz to the end of the band, of which a
narrow band fills but an arc of the unit circle. So the band is moved down, its first line to 0 Hz, and the poles back
up: what the conjugate poles have there is smooth, and left to the numerators.

Its rational fractions ("rfp") are not used: they are cut off at ten pole pairs and go by powers of frequency, which
found a twentieth of the modes of synthetic systems with noise. Its selection of poles asks a person.

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
from ehdmaps.errors import AnalysisError
from ehdmaps.extras import needs

_MOST_LINES = 2**16
"""Of the even lines to which uneven ones are interpolated."""


def lscf_poles(frequency: FloatArray, response: ComplexArray, orders: Sequence[int]) -> list[ComplexArray]:
    """Poles of fits of rising order.

    Parameters
    ----------
    frequency : array, shape (lines,)
        Frequencies of the band, > 0 [Hz]. Lines that are not evenly spaced are interpolated, as densely as they lie
        where they are densest.
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
    DependencyError
        If the library is not installed.
    AnalysisError
        If the normal equations are singular.
    """
    with needs("modal", "sdypy-EMA", "modal fits"):
        # It takes a display toolkit along, which is only loaded, never used.
        from sdypy.EMA import Model
    whole = float(frequency[-1] - frequency[0])
    even = np.linspace(
        frequency[0], frequency[-1], min(round(whole / float(np.diff(frequency).min())) + 1, _MOST_LINES)
    )
    # The library leaves out the last line, and needs one below its lower end.
    lines = np.arange(even.size + 2) * (whole / (even.size - 1))
    size = np.sqrt(np.mean(np.abs(response) ** 2, axis=1, keepdims=True))
    values = np.zeros((response.shape[0], lines.size), dtype=np.complex128)
    values[:, 1:-1] = [np.interp(even, frequency, row) for row in response / np.where(size > 0.0, size, 1.0)]
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
    of_orders = [np.asarray(model.all_poles[order - 1], dtype=np.complex128) for order in orders]
    return [poles[np.isfinite(poles) & (poles.imag > 0.0)] + moved for poles in of_orders]
