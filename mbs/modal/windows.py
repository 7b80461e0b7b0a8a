"""Windows for hammer hits, and what the exponential one does to a pole.

A response is the convolution of force and impulse response, y = h * f. Multiplied by exp(-a t), with a = 1/tau, all
three stay a convolution: e y = (e h) * (e f). So if force and response get the same exponential window, their ratio
is the frequency response at s = j omega + a, without any approximation, and a pole p appears at p - a. The common
correction zeta - 1/(tau omega) is its first order for light damping.
"""

from __future__ import annotations

import math

import numpy as np

from ehdmaps.arrays import ComplexArray, FloatArray
from ehdmaps.errors import InputError

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
    """Window of 1 around the pulse of a hit and 0 elsewhere, with cosine flanks.

    A hammer is silent but for its pulse; what the channel shows besides is noise. The window reaches three pulse
    widths, at least 16 samples, to either side of where the force exceeds a tenth of its peak: an anti-aliasing filter
    rings about as long.

    Parameters
    ----------
    force : array, shape (samples,)
        [N].

    Returns
    -------
    array, shape (samples,)
    """
    first, last = pulse(force)
    reach = max(3 * (last - first + 1), 16)
    index = np.arange(force.size)
    beyond = np.maximum(np.maximum(first - index, index - last), 0)
    flank = np.clip((beyond - reach / 2) / (reach / 2), 0.0, 1.0)
    return np.asarray(0.5 * (1.0 + np.cos(np.pi * flank)), dtype=np.float64)


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
