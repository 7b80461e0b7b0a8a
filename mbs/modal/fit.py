"""Modal identification of a band: poles of rising order, their stabilisation, residues, refinement.

Poles come by the least-squares complex frequency-domain method, p-LSCF, of the library sdypy-EMA.

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

import math
import warnings
from collections.abc import Sequence

import numpy as np
from scipy.ndimage import uniform_filter1d

from ehdmaps.arrays import ComplexArray, FloatArray, IntArray
from ehdmaps.errors import AnalysisError, InputError, Problems
from ehdmaps.extras import needs
from mbs.modal.estimation import relative_deviation, without_window
from mbs.modal.records import Responses
from mbs.modal.residues import Parts, fit_residues, laplace, refine, synthesise
from mbs.modal.result import ModalFit
from mbs.modal.stabilisation import Stabilisation, stabilise

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


ORDER = 40
"""Highest number of pole pairs, if it is left out."""

MOST = 100
"""Highest number of pole pairs that is taken."""

_SIGNIFICANT = 6.0
"""A pole counts as a mode only if leaving it out raises the error by the square of this, in variances of one value."""

_STRAYED = 1.0
"""Half widths that a pole may move when it is refined; one that moves farther is not a mode."""

_SMOOTH = 100
"""One part in so many of the lines over which the noise is averaged."""

_APART = 2.0
"""Half widths between a mode that is found in what others left and any other: nearer, it mends the model of a strong
one."""

_FLOOR = 1e-6
"""Least deviation of a value, against the rms of its response: the noise of noiseless data."""


def identify(
    responses: Responses,
    band: tuple[float, float] | None = None,
    order: int | None = None,
    modes: int | None = None,
    refined: bool = True,
) -> ModalFit:
    """Modes of a band, by their poles in all responses at once.

    Parameters
    ----------
    responses : Responses
        Responses, with an exponential window or without; its decay is taken out of the poles.
    band : (float, float), optional
        Limits of the band, from and to [Hz]; all if left out.
    order : int, optional
        Highest number of pole pairs, 1 to 100; 40 if left out, or what the lines allow.
    modes : int, optional
        How many modes to keep at most, those with the most energy in the responses; all stable ones if left out.
    refined : bool
        Whether the poles are moved to the least error of the responses.

    Raises
    ------
    InputError
        If band, order and number of modes are not possible.
    AnalysisError
        If no mode is stable.
    """
    problems = Problems()
    low, high = band or (0.0, float(responses.frequency[-1]))
    if not (np.isfinite(low) and np.isfinite(high) and 0.0 <= low < high):
        problems.append(f"band: got {low!r} Hz to {high!r} Hz; allowed: rising, from 0 Hz on")
    if order is not None and not 1 <= order <= MOST:
        problems.append(f"order: got {order!r}; allowed: 1 to {MOST} pole pairs")
    if modes is not None and not 1 <= modes <= MOST:
        problems.append(f"modes: got {modes!r}; allowed: 1 to {MOST}")
    problems.check()
    inside = responses.within(low, high)
    # Real and imaginary parts of the lines, shared by numerators and the denominator, and half of them to spare.
    possible = (inside.frequency.size - 1) // 4
    if possible < 1:
        raise InputError(f"band: got {inside.frequency.size} lines; allowed: 8 or more, and many for a good fit")
    orders = range(1, min(order or ORDER, possible) + 1)
    s, weight = laplace(inside.frequency, inside.decay), weights(inside)
    even = np.repeat(1.0 / _rms(inside.response)[:, None], inside.frequency.size, axis=1)
    stable = stabilise(
        lscf_poles(inside.frequency, inside.response, orders),
        orders,
        (float(inside.frequency[0]), float(inside.frequency[-1])),
        lambda poles: (
            fit_residues(s, inside.response, even, inside.derivatives, without_window(poles, inside.decay)).residues
        ),
    )
    chosen, poles, deviation = _significant(s, inside, weight, stable, modes, refined)
    while refined and chosen.size and (modes is None or chosen.size < modes):
        wider = stable.of(chosen).and_one(_left_over(s, inside, weight, poles))
        further = _significant(s, inside, weight, wider, modes, refined)
        if further[0].size <= chosen.size or _nearest(further[1], int(np.argmax(further[0]))) < _APART:
            break
        stable, (chosen, poles, deviation) = wider, further
    if not chosen.size:
        raise AnalysisError(
            f"modal fit: no stable mode from {inside.frequency[0]:.6g} Hz to {inside.frequency[-1]:.6g} Hz "
            f"up to order {orders[-1]}; choose a band around a resonance, average more hits, or raise the order"
        )
    parts = fit_residues(s, inside.response, weight, inside.derivatives, poles)
    rising = np.argsort(np.abs(poles))
    parts = Parts(parts.residues[rising], parts.below, parts.above)
    left = inside.response - synthesise(s, inside.derivatives, poles[rising], parts)
    return ModalFit(
        responses=inside,
        poles=poles[rising],
        deviation=deviation[rising],
        scatter=stable.scatter[chosen][rising],
        counts=tuple(stable.counts[chosen[k]] for k in rising),
        parts=parts,
        error=np.sqrt(np.mean(np.abs(left) ** 2, axis=1)) / _rms(inside.response),
        candidates=stable.candidates,
        refined=refined,
    )


def _left_over(s: ComplexArray, inside: Responses, weight: FloatArray, poles: ComplexArray) -> complex:
    """A pole at the line at which most is left, as much damped as the others, with what a window adds [1/s].

    Beside stronger modes the poles of a fit of the whole band may not settle on a weak one.
    """
    parts = fit_residues(s, inside.response, weight, inside.derivatives, poles)
    left = inside.response - synthesise(s, inside.derivatives, poles, parts)
    peak = int(np.argmax(np.sum(np.abs(weight * left) ** 2, axis=0)))
    omega = 2.0 * math.pi * float(inside.frequency[peak])
    return complex(float(np.median(poles.real / np.abs(poles))) * omega - inside.decay, omega)


def _nearest(poles: ComplexArray, which: int) -> float:
    """Smallest distance of a pole to the others, in half widths of the wider one."""
    others = np.delete(poles, which)
    half = np.maximum(-others.real, -poles[which].real)
    return float(np.min(np.abs(others - poles[which]) / half, initial=math.inf))


def weights(responses: Responses) -> FloatArray:
    """One over the standard deviation of each value, shape (rows, lines).

    From coherence and number of hits, averaged over neighbouring lines, because the coherence of a few hits is itself
    uncertain; where coherence is not known, the same for all lines of a row.
    """
    size = _rms(responses.response)[:, None]
    known = np.all(np.isfinite(responses.coherence), axis=1) & (responses.hits > 1)
    width = max(responses.frequency.size // _SMOOTH, 9)
    coherence = np.where(known[:, None], responses.coherence, 1.0)
    variance = (np.abs(responses.response) * relative_deviation(coherence, responses.hits)) ** 2
    smooth = uniform_filter1d(variance, min(width, responses.frequency.size), axis=1, mode="nearest")
    deviation = np.sqrt(np.maximum(smooth, 0.0) + (_FLOOR * size) ** 2)
    return np.asarray(1.0 / np.where(known[:, None], deviation, size))


def alike(responses: Responses) -> float:
    """Neighbouring lines that an exponential window gives about the same noise; 1 without a window."""
    spacing = float(np.diff(responses.frequency).mean())
    exponent = 2.0 * responses.decay / spacing
    # Mean of the squared window, inverted.
    return exponent / -math.expm1(-exponent) if exponent > 0.0 else 1.0


def _significant(
    s: ComplexArray, inside: Responses, weight: FloatArray, stable: Stabilisation, modes: int | None, refined: bool
) -> tuple[IntArray, ComplexArray, FloatArray]:
    """Stable poles without which the error would rise by more than noise explains: which, their values, deviations.

    The least needed half of those that are not needed is taken out first, because two may stand for one mode, and the
    others are fitted again.
    """
    chosen = np.arange(stable.poles.size)
    while chosen.size:
        poles = without_window(stable.poles[chosen], inside.decay)
        deviation = np.full((chosen.size, 2), np.nan)
        if refined:
            poles, deviation, strayed = refine(s, inside.response, weight, inside.derivatives, poles)
            if strayed.max() > _STRAYED:
                chosen = _without_half(chosen, -strayed, -_STRAYED)
                continue
        error = _error(s, inside, weight, poles)
        rise = np.array([_error(s, inside, weight, np.delete(poles, k)) - error for k in range(chosen.size)])
        limit = _SIGNIFICANT**2 * alike(inside) * error / inside.response.size
        if rise.min() > limit and (modes is None or chosen.size <= modes):
            return chosen, poles, deviation
        chosen = _without_half(chosen, rise, limit)
    return chosen, np.zeros(0, dtype=np.complex128), np.zeros((0, 2))


def _without_half(chosen: IntArray, worth: FloatArray, limit: float) -> IntArray:
    """The poles without the worse half of those that are worth no more than the limit, and without one at least."""
    count = max((int(np.count_nonzero(worth <= limit)) + 1) // 2, 1)
    return np.delete(chosen, np.argsort(worth, kind="stable")[:count])


def _error(s: ComplexArray, inside: Responses, weight: FloatArray, poles: ComplexArray) -> float:
    """Weighted sum of squares of what the best residues leave."""
    parts = fit_residues(s, inside.response, weight, inside.derivatives, poles)
    left = weight * (inside.response - synthesise(s, inside.derivatives, poles, parts))
    return float(np.sum(np.abs(left) ** 2))


def _rms(values: ComplexArray) -> FloatArray:
    """RMS of each row; 1 for a row of zeros."""
    size = np.sqrt(np.mean(np.abs(values) ** 2, axis=1))
    return np.asarray(np.where(size > 0.0, size, 1.0), dtype=np.float64)
