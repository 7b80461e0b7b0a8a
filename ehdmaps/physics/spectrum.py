"""A contact whose load oscillates: film compliance, dynamic stiffness, stiffness and damping over frequency.

Of the film S(omega) = film compliance - i omega loss compliance at that frequency, of the contact

    1/K(omega) = d(delta_el)/dw + S(omega),    K = k + i omega c.

The solids are those at rest: their compliance is taken as independent of frequency.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ehdmaps.arrays import ComplexArray, FloatArray, IndexArray
from ehdmaps.errors import InputError
from ehdmaps.physics.contact import LineContact, OperatingPoint
from ehdmaps.physics.solution import ContactSolution, FilmSpectrum, contact_solution

LOWEST_FREQUENCY, HIGHEST_FREQUENCY = 1e-3, 1e7
"""Frequencies at which a response may be asked for [Hz]."""

MOST_FREQUENCIES = 2000
"""Frequencies of one response."""

NEIGHBOUR = 2.0
"""Ratio of a frequency to its neighbours, an octave: the difference of two grids changes sign over frequency, and its
size where that happens is read beside it."""


@dataclass(frozen=True)
class ContactSpectrum:
    """Dynamic stiffness of one contact over frequency, per unit length.

    Attributes
    ----------
    solution : ContactSolution
        The contact in the limit of slow motion, with status and reason.
    frequencies : ndarray, shape (k,)
        [Hz].
    film_compliance : ndarray, shape (k,)
        S, complex [m2/N].
    dynamic_stiffness : ndarray, shape (k,)
        K = k + i omega c of film and solids, complex [N/m2].
    film_compliance_error, dynamic_stiffness_error : ndarray, shape (k,)
        Estimated numerical errors, relative to abs(S) and abs(K).
    stiffness_error, damping_error : ndarray, shape (k,)
        Relative to abs(k) and abs(c).
    """

    solution: ContactSolution
    frequencies: FloatArray
    film_compliance: ComplexArray
    dynamic_stiffness: ComplexArray
    film_compliance_error: FloatArray
    dynamic_stiffness_error: FloatArray
    stiffness_error: FloatArray
    damping_error: FloatArray

    @property
    def film_stiffness(self) -> ComplexArray:
        """1/S, the dynamic stiffness of the film alone, complex, shape (k,) [N/m2]; relative error as that of S."""
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.asarray(1.0 / self.film_compliance)

    @property
    def stiffness(self) -> FloatArray:
        """Stiffness k at each frequency, shape (k,) [N/m2]."""
        return np.asarray(self.dynamic_stiffness.real)

    @property
    def damping(self) -> FloatArray:
        """Damping c at each frequency, shape (k,) [N s/m2]; negative where the contact feeds an oscillation."""
        return np.asarray(self.dynamic_stiffness.imag / (2.0 * math.pi * self.frequencies))

    def at(self, index: int) -> ContactSolution:
        """The contact as at one of the frequencies: its stiffness, damping and their errors are those there.

        Parameters
        ----------
        index : int
            Index of the frequency.
        """
        error = float(self.film_compliance_error[index] * abs(self.film_compliance[index]))
        real = abs(float(self.film_compliance[index].real))
        return replace(
            self.solution,
            stiffness=float(self.stiffness[index]),
            damping=float(self.damping[index]),
            film_compliance_error=0.0 if error == 0.0 else error / real if real > 0.0 else math.nan,
            stiffness_error=float(self.stiffness_error[index]),
            damping_error=float(self.damping_error[index]),
        )


def checked_frequencies(frequencies: Sequence[float] | FloatArray) -> FloatArray:
    """Return frequencies as an array.

    Parameters
    ----------
    frequencies : sequence of float or ndarray, shape (k,)
        [Hz].

    Raises
    ------
    InputError
        If there are none, too many, or one that is no number or outside of what is allowed.
    """
    values = np.atleast_1d(np.asarray(frequencies, dtype=float))
    if values.ndim != 1 or not 1 <= values.size <= MOST_FREQUENCIES:
        raise InputError(
            f"frequencies: got an array of shape {values.shape}; allowed: 1 to {MOST_FREQUENCIES} of them in one dim"
        )
    wrong = values[~((values >= LOWEST_FREQUENCY) & (values <= HIGHEST_FREQUENCY))]
    if wrong.size:
        raise InputError(
            f"frequencies: got {float(wrong[0])!r} Hz; allowed: {LOWEST_FREQUENCY:g} to {HIGHEST_FREQUENCY:g} Hz; the "
            "limit of slow motion is what a solve without frequencies gives"
        )
    return values


def neighbours(frequencies: FloatArray) -> FloatArray:
    """Return where the difference of two grids is read for its error at each frequency, shape (k, 3).

    Parameters
    ----------
    frequencies : ndarray, shape (k,)
        Frequencies in any unit.
    """
    return np.column_stack([frequencies, frequencies * NEIGHBOUR, frequencies / NEIGHBOUR])


def read_beside(
    difference: ComplexArray, where: FloatArray, index: IndexArray, frequencies: FloatArray
) -> ComplexArray:
    """Return differences of film compliance at other frequencies as they would stand at each frequency, shape (k, m).

    The imaginary part goes with the frequency: what is carried over is the loss compliance.

    Parameters
    ----------
    difference : ndarray, shape (n,)
        Differences, complex.
    where : ndarray, shape (n,)
        Frequencies at which they are known.
    index : ndarray, shape (k, m)
        Which of them are read for each frequency.
    frequencies : ndarray, shape (k,)
        Frequencies at which they are to stand.
    """
    return np.asarray(difference.real[index] + 1j * (difference.imag / where)[index] * frequencies[:, None])


def contact_spectrum(spectrum: FilmSpectrum, contact: LineContact, point: OperatingPoint) -> ContactSpectrum:
    """Add the solids to a film.

    An error dS of the film compliance is one of -K^2 dS of the dynamic stiffness, to first order; k has its real part,
    omega c its imaginary part, and a twentieth of the magnitudes that make these up in case they cancel, as in
    `contact_solution`.

    Parameters
    ----------
    spectrum : FilmSpectrum
        Film of one contact.
    contact : LineContact
        The contact, with its structural law.
    point : OperatingPoint
        Load, speed and temperature of the film.
    """
    film = spectrum.compliance
    with np.errstate(invalid="ignore", divide="ignore"):
        stiffness = 1.0 / (contact.structural_compliance(point.load) + film)
        squared, errors = (stiffness**2)[:, None], spectrum.errors
        change = squared * errors
        aligned = np.abs(squared.real * errors.real) + np.abs(squared.imag * errors.imag)
        across = np.abs(squared.imag * errors.real) + np.abs(squared.real * errors.imag)
        largest = np.max(np.abs(errors), axis=1)
        real = np.max(np.abs(change.real) + 0.05 * aligned, axis=1)
        imaginary = np.max(np.abs(change.imag) + 0.05 * across, axis=1)
        return ContactSpectrum(
            solution=contact_solution(spectrum.film, contact, point),
            frequencies=spectrum.frequencies,
            film_compliance=film,
            dynamic_stiffness=stiffness,
            film_compliance_error=spectrum.largest_error,
            dynamic_stiffness_error=_relative(largest * np.abs(stiffness) ** 2, np.abs(stiffness)),
            stiffness_error=_relative(real, np.abs(stiffness.real)),
            damping_error=_relative(imaginary, np.abs(stiffness.imag)),
        )


def _relative(error: FloatArray, value: FloatArray) -> FloatArray:
    """An error over its value; no error of nothing is none."""
    return np.where(error == 0.0, 0.0, error / value)
