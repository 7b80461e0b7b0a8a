"""Frequency responses and coherence from averaged hammer hits, with the windows that hits need.

Windows for hammer hits, and what the exponential one does to a pole.

A response is the convolution of force and impulse response, y = h * f. Multiplied by exp(-a t), with a = 1/tau, all
three stay a convolution: e y = (e h) * (e f). So if force and response get the same exponential window, their ratio
is the frequency response at s = j omega + a, without any approximation, and a pole p appears at p - a. The common
correction zeta - 1/(tau omega) is its first order for light damping.

An analyser may have windowed the responses alone: then the force gets the same window here, and the same holds. Where
its window begins, before the hit, changes the size of the responses alone. A window that is 1 about the pulse of the
force and 0 elsewhere, as analysers have it too, changes nothing.

Frequency responses and coherence from averaged hammer hits.

Sums over hits of the spectra X of a response and F of the force: H1 = sum(X F*)/sum(F F*) has no bias from noise on
the response, H2 = sum(X X*)/sum(F X*) none from noise on the force, and coherence = H1/H2 =
|G_XF|^2/(G_XX G_FF). The library pyFRF has them too, but wants a sampling rate of whole hertz, and does not take its
windows out again.

References
----------
J. S. Bendat, A. G. Piersol, Random Data, 4th ed., Wiley 2010, sections 6 and 9.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Literal

import numpy as np
import scipy  # its parts at first use: scipy.signal takes half a second

from ehdmaps.arrays import ComplexArray, FloatArray
from ehdmaps.errors import AnalysisError, InputError
from mbs.modal.records import Channel, Hits, Responses

LEFT = 0.01
"""What an exponential window leaves at the end of records that have not decayed by themselves: cutting a mode off at
this part of its size changes its responses by as much, and its damping by less."""

_LAST = 20
"""One part in so many of a record is its end."""


def exponential_window(samples: int, step: float, decay: float) -> FloatArray:
    """exp(-decay t), from the first sample on.

    Parameters
    ----------
    samples : int
        Number of samples of a record.
    step : float
        [s].
    decay : float
        1/tau [1/s]; 0 gives ones.

    Returns
    -------
    array, shape (samples,)

    Raises
    ------
    InputError
        If the decay is negative, not finite, or leaves nothing of the record.
    """
    if not (math.isfinite(decay) and decay >= 0.0):
        raise InputError(f"exponential window: got a decay of {decay!r} 1/s; allowed: finite and >= 0")
    # Beyond that the record is a few samples long, whatever it was.
    if decay * step > 1.0:
        raise InputError(
            f"exponential window: got a time constant of {1.0 / decay:.3g} s; allowed: longer than the step "
            f"{step:.3g} s, and best a fifth of the record or more"
        )
    return np.asarray(np.exp(-decay * step * np.arange(samples)), dtype=np.float64)


def without_window(poles: ComplexArray, decay: float) -> ComplexArray:
    """Poles of the structure from poles of responses that had the exponential window; exact.

    Parameters
    ----------
    poles : array of complex
        Poles as identified [1/s].
    decay : float
        1/tau of the window [1/s].
    """
    return np.asarray(poles + decay, dtype=np.complex128)


def force_window(force: FloatArray) -> FloatArray:
    """Window of 1 around the pulses of a hit and 0 elsewhere, with cosine flanks.

    A hammer is silent but for its pulses; what the channel shows besides is noise. The window reaches three pulse
    widths, at least 16 samples, to either side of where the force exceeds a tenth of its peak: an anti-aliasing filter
    rings about as long. It has a second pulse too, where the hammer bounced: without it the response would be that of
    a force that is not there.

    Parameters
    ----------
    force : array, shape (samples,)
        [N].

    Returns
    -------
    array, shape (samples,)
    """
    first, last = pulse(force)
    windows = [_around(force.size, first, last, last - first + 1)]
    windows += [_around(force.size, at, at, last - first + 1) for at, _ in second_pulses(force)]
    return np.asarray(np.max(windows, axis=0), dtype=np.float64)


def _around(samples: int, first: int, last: int, width: int) -> FloatArray:
    """Window around some samples, for a pulse of a width."""
    reach = max(3 * width, _MARGIN)
    index = np.arange(samples)
    beyond = np.maximum(np.maximum(first - index, index - last), 0)
    flank = np.clip((beyond - reach / 2) / (reach / 2), 0.0, 1.0)
    return np.asarray(0.5 * (1.0 + np.cos(np.pi * flank)), dtype=np.float64)


def second_pulses(force: FloatArray) -> list[tuple[int, float]]:
    """Samples of the peaks of further pulses of a hit, and their height over that of the first one.

    Parameters
    ----------
    force : array, shape (samples,)
        [N].

    Returns
    -------
    list of (int, float)
        Pulses above a hundredth that stand out of the noise; none where they are so many that they are no bounces.
    """
    first, last = pulse(force)
    width, peak = last - first + 1, float(np.max(np.abs(force)))
    reach = max(3 * width, _MARGIN) // 2
    open_ = np.ones(force.size, dtype=np.bool_)
    open_[max(first - reach, 0) : last + reach + 1] = False
    if not open_.any() or peak == 0.0:
        return []
    away = np.where(open_, np.abs(force - np.median(force[open_])), 0.0)
    level = max(_STANDS_OUT * 1.4826 * float(np.median(away[open_])), _SMALLEST_SECOND * peak)
    found = scipy.signal.find_peaks(away, height=level, distance=width + reach + 1)[0]
    found = found[np.argsort(-away[found], kind="stable")]
    return [] if found.size > _MOST_BOUNCES else [(int(at), float(away[at]) / peak) for at in found]


def pulse(force: FloatArray, level: float = 0.1) -> tuple[int, int]:
    """First and last sample around the peak where the force stays above a part of it."""
    size = np.abs(force)
    peak = int(np.argmax(size))
    below = np.nonzero(size < level * size[peak])[0]
    after = below[below > peak]
    before = below[below < peak]
    return (int(before[-1]) + 1 if before.size else 0), (int(after[0]) - 1 if after.size else force.size - 1)


def needed_decay(response: FloatArray, step: float) -> float:
    """Decay of an exponential window for records that have not decayed to a hundredth of their peaks at their ends.

    It brings everything down to a hundredth by itself, because the slowest mode need not be the one that has the peak.

    Parameters
    ----------
    response : array, shape (..., samples)
        Records of the responses.
    step : float
        [s].

    Returns
    -------
    float
        1/tau [1/s]; 0 where all records have decayed.
    """
    samples = response.shape[-1]
    peak = np.max(np.abs(response), axis=-1)
    end = np.sqrt(2.0 * np.mean(response[..., -max(samples // _LAST, 1) :] ** 2, axis=-1))
    # A channel that shows nothing says nothing about decay.
    ratio: FloatArray = np.divide(end, peak, out=np.zeros_like(peak), where=peak > 0.0)
    # Twice: a hundredth of noise is no decaying mode.
    left = float(np.max(ratio, initial=0.0))
    return -math.log(LEFT) / (samples * step) if left > 2.0 * LEFT else 0.0


Estimator = Literal["h1", "h2"]
Reason = Literal["double hit", "overload", "no hit", "not finite"]

_MARGIN = 16
"""Samples beside a pulse in which an anti-aliasing filter may ring."""

_STANDS_OUT, _SMALLEST_SECOND, _MOST_BOUNCES = 6.0, 0.01, 4
"""Pulses besides the first one: over the deviation of the noise, over the first one, and how many."""

_FLAT = 3
"""Equal samples at the top of a record that mean that the channel was overloaded."""

_DOUBLE, _SILENT = 0.1, 10.0
"""Largest second pulse, as a part of the first one, and smallest peak of the force, over the rms of the rest of its
record, of hits that are not left out."""


@dataclass(frozen=True)
class Rejected:
    """A hit that was left out, or is told of.

    Attributes
    ----------
    hit : int
        Number of the hit, from 1.
    reference : Channel
        The place hit.
    reason : {"double hit", "overload", "no hit", "not finite"}
        Reason for that.
    detail : str
        What was seen.
    """

    hit: int
    reference: Channel
    reason: Reason
    detail: str


@dataclass(frozen=True, eq=False)
class Estimate:
    """Frequency responses from hits, and what was left out.

    Attributes
    ----------
    responses : Responses
        All places hit, one after the other.
    used : tuple of int
        Hits that were averaged at each place.
    rejected : tuple of Rejected
        The others.
    bounced : tuple of Rejected
        Hits that were averaged though they have a small second pulse, which was taken with the first one.
    """

    responses: Responses
    used: tuple[int, ...]
    rejected: tuple[Rejected, ...] = field(default=())
    bounced: tuple[Rejected, ...] = field(default=())


def estimate(
    records: Sequence[Hits],
    estimator: Estimator = "h1",
    decay: float = 0.0,
) -> Estimate:
    """Frequency responses and coherence of all places hit.

    Parameters
    ----------
    records : sequence of Hits
        An entry for each place hit; same step and number of samples.
    estimator : {"h1", "h2"}
        H1 where noise is on the responses, H2 where it is on the force.
    decay : float
        1/tau of an exponential window that force and response get [1/s], beside that which they have been through.

    Raises
    ------
    InputError
        If records differ in step, length or the window that they have been through.
    AnalysisError
        If no hit of a place is left.
    """
    grids = {(entry.step, entry.force.shape[1]) for entry in records}
    if len(grids) != 1:
        shown = ", ".join(f"{samples} samples every {step:.6g} s" for step, samples in sorted(grids))
        raise InputError(
            f"hits: got records of {shown or 'no place'}; allowed: the same step and length for all places"
        )
    ((step, samples),) = grids
    windows = {entry.decay for entry in records}
    if len(windows) != 1:
        shown = ", ".join(f"{1.0 / one:.4g} s" if one else "none" for one in sorted(windows))
        raise InputError(f"hits: got records that have been through windows of {shown}; allowed: one for all places")
    responses, coherences, pairs, used, rejected, bounced = [], [], [], [], [], []
    for entry in records:
        bad = _rejected(entry)
        kept = [hit for hit in range(entry.force.shape[0]) if hit + 1 not in {one.hit for one in bad}]
        if not kept:
            reasons = "; ".join(f"hit {one.hit}: {one.reason}, {one.detail}" for one in bad)
            raise AnalysisError(f"hits at {entry.reference.label}: none is left ({reasons}); hit again")
        force, response = entry.force[kept], entry.response[kept]
        # A hammer is silent but for its pulses.
        force = force * np.stack([force_window(record) for record in force])
        window = exponential_window(samples, step, decay)
        same = window if entry.force_decays else window * exponential_window(samples, step, entry.decay)
        H, gamma = transfer(force * same, response * window, estimator)
        responses.append(H)
        coherences.append(gamma)
        pairs += [(sensor, entry.reference) for sensor in entry.sensors]
        used.append(len(kept))
        rejected += bad
        bounced += [
            Rejected(
                hit + 1,
                entry.reference,
                "double hit",
                f"a second pulse of {100.0 * part:.3g} % of the first one, at {step * at:.4g} s",
            )
            for hit in kept
            for at, part in second_pulses(entry.force[hit])
        ]
    frequency = np.asarray(np.fft.rfftfreq(samples, step), dtype=np.float64)
    means = Responses(
        frequency, np.concatenate(responses), np.concatenate(coherences), tuple(pairs), min(used), decay + windows.pop()
    )
    return Estimate(means, tuple(used), tuple(rejected), tuple(bounced))


def transfer(force: FloatArray, response: FloatArray, estimator: Estimator = "h1") -> tuple[ComplexArray, FloatArray]:
    """H1 or H2, and the coherence, of records as they are.

    Parameters
    ----------
    force : array, shape (hits, samples)
        Forces of hits at the same place.
    response : array, shape (hits, sensors, samples)
        Responses to the same hits.
    estimator : {"h1", "h2"}
        Estimator of the frequency responses.

    Returns
    -------
    response : array of complex, shape (sensors, lines)
        Values at the frequencies of `numpy.fft.rfftfreq`. Zero where the force has nothing.
    coherence : array, shape (sensors, lines)
        0 to 1; NaN of a single hit, whose coherence is 1 whatever it was.
    """
    hits, samples = force.shape
    # Averages over hits are Welch's averages over segments without window and overlap.
    average = functools.partial(scipy.signal.csd, nperseg=samples, noverlap=0, window="boxcar", detrend=False)
    f, x = force.ravel(), np.moveaxis(response, 1, 0).reshape(-1, hits * samples)
    by_force, by_response = average(f, f)[1].real, average(x, x)[1].real
    cross = average(f, x)[1]
    numerator, denominator = (cross, by_force + 0j * by_response) if estimator == "h1" else (by_response, cross.conj())
    H = np.divide(numerator, denominator, out=np.zeros_like(cross), where=np.abs(denominator) > 0.0)
    product = by_force * by_response
    gamma = np.divide(np.abs(cross) ** 2, product, out=np.zeros_like(product), where=product > 0.0)
    if hits < 2:
        gamma = np.full_like(gamma, np.nan)
    return H, np.minimum(gamma, 1.0)


def relative_deviation(coherence: FloatArray, hits: int) -> FloatArray:
    """Standard deviation of the magnitude of H1 over the magnitude, sqrt((1 - c)/(2 n c)).

    Parameters
    ----------
    coherence : array
        c, 0 to 1.
    hits : int
        n averages.

    References
    ----------
    Bendat and Piersol, section 9.1: for many independent averages.
    """
    clipped = np.clip(coherence, 1e-12, 1.0)
    return np.asarray(np.sqrt((1.0 - clipped) / (2.0 * max(hits, 1) * clipped)))


def _rejected(entry: Hits) -> list[Rejected]:
    """Hits that are not fit for use."""
    rejected = []
    for hit, (force, response) in enumerate(zip(entry.force, entry.response, strict=True), start=1):
        verdict = _verdict(force, response, entry)
        if verdict:
            rejected.append(Rejected(hit, entry.reference, *verdict))
    return rejected


def _verdict(force: FloatArray, response: FloatArray, entry: Hits) -> tuple[Reason, str] | None:
    """Reason why a hit is not fit for use, and what was seen; None if it is fit."""
    channels = (("the force", force), *zip((sensor.label for sensor in entry.sensors), response, strict=True))
    for name, record in channels:
        if not np.all(np.isfinite(record)):
            return "not finite", f"{name} has values that are no numbers"
        size = np.abs(record)
        top = float(size.max())
        flat = size >= top * (1.0 - 1e-9)
        longest = np.max(np.convolve(flat, np.ones(_FLAT), mode="valid"))
        if top > 0.0 and longest >= _FLAT:
            return "overload", f"{name} stays at {top:.4g}"
    first, last = pulse(force)
    margin = max(last - first + 1, _MARGIN)
    rest = np.concatenate([force[: max(first - margin, 0)], force[last + 1 + margin :]])
    peak = float(np.abs(force).max())
    if peak == 0.0 or (rest.size and peak < _SILENT * float(np.sqrt(np.mean(rest**2)))):
        return "no hit", f"the force of {peak:.3g} does not stand out of its noise"
    second = float(np.abs(rest).max(initial=0.0))
    if second > _DOUBLE * peak:
        return "double hit", f"a second pulse of {100.0 * second / peak:.3g} % of the first"
    return None
