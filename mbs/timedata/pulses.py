"""Pulses of a tacho: when they come, and how many there should be.

Distances of pulses change slowly, but where one is missing, or is counted twice. From the steadiest place on, forwards
and backwards, each distance is compared with the one that those before it let expect: about n times as long has n - 1
pulses too few, of two that are together as long as one the pulse between is too many. A wheel with a gap, such as one
of 60 - 2 teeth, has pulses too few once a turn. At either end, next to standstill, distances change faster: what is not
one distance there is left out. No library was found that counts pulses which are not there; `scipy.signal.find_peaks`
takes each for one.
"""

from __future__ import annotations

import math
from collections import Counter
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from ehdmaps.arrays import FloatArray, IntArray
from ehdmaps.errors import InputError

FEWEST = 8
"""Pulses."""

_LOW, _HIGH = 0.4, 0.6
"""Where pulses begin and end, as parts of their height: noise between counts none twice."""

_SHORT, _LONG = 0.6, 1.6
"""Distances that count as one, over the expected one: torsional vibration and fast ramps stay within."""

_TOGETHER = (0.7, 1.4)
"""Two distances that count as one, likewise."""

_OFF = 0.25
"""Distance from a whole number of distances, over that number, beyond which nobody knows how many there are."""

_TREND = 1.25
"""Change from one distance to the next that is expected at most."""

_MOST_MENDED = 0.1
"""Part of the pulses that may be mended, but for the gap of a wheel."""

_EDGE = 3
"""Pulses at either end that may be left out."""

_STEADY, _SCATTER = 8, 0.3
"""Distances whose mean says how many are missing in a longer one; and the mean of their steps over their spread, above
which they scatter, as few samples a pulse make them, and do not swing."""

_EXTRA_IN_A_ROW = 2
"""Pulses too many, one after the other; more of them are a sudden slowness."""


class Pulses(NamedTuple):
    """Pulses as they should be.

    Attributes
    ----------
    times : array, shape (pulses,)
        Times of the pulses [s].
    counts : array of int, shape (pulses,)
        Number of each from the first one on, with those that are missing.
    wheel : (int, int) or None
        Teeth of a wheel with a gap: those that are there, and all.
    notes : tuple of str
        What was mended.
    """

    times: FloatArray
    counts: IntArray
    wheel: tuple[int, int] | None
    notes: tuple[str, ...]


def rising_flanks(time: FloatArray, values: FloatArray) -> FloatArray:
    """Times at which pulses rise [s].

    Parameters
    ----------
    time, values : array, shape (samples,)
        Times [s], and the voltage or whatever shows the pulses.
    """
    low, high = float(values.min()), float(values.max())
    above = _above(values, low + _LOW * (high - low), low + _HIGH * (high - low))
    rises = np.flatnonzero(~above[:-1] & above[1:])
    if not high > low or rises.size == 0:
        return np.zeros(0)
    # Where the flank passes the middle, between two samples.
    middle = low + _HIGH * (high - low)
    slope = values[rises + 1] - values[rises]
    step = time[1] - time[0]
    return np.asarray(time[rises] + step * np.clip((middle - values[rises]) / slope, 0.0, 1.0))


def _above(values: FloatArray, low: float, high: float) -> np.ndarray[tuple[int, ...], np.dtype[np.bool_]]:
    """True where a pulse is on: from where it passes `high` to where it falls below `low`."""
    state = np.where(values > high, 1, np.where(values < low, 0, -1))
    known = np.maximum.accumulate(np.where(state >= 0, np.arange(values.size), 0))
    return np.asarray(state[known] == 1)


def counted(times: FloatArray) -> Pulses:
    """Count pulses, with those that are missing and without those that are too many.

    Parameters
    ----------
    times : array, shape (pulses,)
        Times of at least `FEWEST` pulses [s].

    Raises
    ------
    InputError
        Where nobody knows how many pulses there should be, or much would be mended; the caller says of what.
    """
    # The steadiest three distances; of these the middle one is the first of both tracks.
    turn = np.abs(np.diff(np.log(np.diff(times))))
    start = int(np.argmin(turn[:-1] + turn[1:])) + 1
    forth, back = _followed(times[start:]), _followed(times[: start + 2][::-1])
    kept = np.array([*back.times[:1:-1], *forth.times])
    counts = np.concatenate([[0], np.cumsum([*back.steps[:0:-1], *forth.steps])]).astype(np.int64)
    wheel, notes = _told(kept, counts, sorted(back.missing + forth.missing), sorted(back.extra + forth.extra))
    left = times.size - kept.size - len(back.extra) - len(forth.extra)
    if left:
        notes.append(f"{left} pulse{'s' * (left > 1)} next to standstill left out")
    return Pulses(kept, counts, wheel, tuple(notes))


@dataclass
class _Track:
    """Pulses in one direction: times, steps between them, and what was mended."""

    times: list[float]
    steps: list[int] = field(default_factory=list)
    missing: list[tuple[float, int]] = field(default_factory=list)
    extra: list[float] = field(default_factory=list)


def _followed(times: FloatArray) -> _Track:
    """Pulses from a steady place on, towards later or earlier times; the first distance is taken as it is."""
    gaps = np.abs(np.diff(times))
    track = _Track([float(times[0]), float(times[1])], [1])
    pitches = [float(gaps[0])]
    k, in_a_row = 1, 0
    while k < gaps.size:
        expected = _next(pitches)
        here, after = gaps[k] / expected, (gaps[k + 1] / expected if k + 1 < gaps.size else math.inf)
        count = 1
        both = here + after
        # Of two short ones the second may be the first of the next two.
        nearer = abs(math.log(both)) < abs(math.log(here))
        if nearer and min(here, after) < _SHORT and _TOGETHER[0] <= both <= _TOGETHER[1] and in_a_row < _EXTRA_IN_A_ROW:
            track.extra.append(float(times[k + 1]))
            here, k, in_a_row = both, k + 1, in_a_row + 1
        elif _SHORT <= here <= _LONG:
            in_a_row = 0
        else:
            if gaps.size - k <= _EDGE:
                break
            # Of those that scatter the mean, else the mean of a distance before and one behind.
            recent = np.array(pitches[-_STEADY:])
            spread = float(np.ptp(recent))
            scatters = recent.size == _STEADY and np.mean(np.abs(np.diff(recent))) > _SCATTER * spread
            if scatters and spread < (_TREND - 1.0) * recent.min():
                here = gaps[k] / float(np.mean(recent))
            elif _SHORT <= after <= _LONG:
                here /= math.sqrt(after)
            count, in_a_row = round(here), 0
            if count < 2 or abs(here - count) > _OFF * count or track.steps[-1] > 1:
                raise InputError(
                    f"got {expected:.4g} s and then {gaps[k]:.4g} s between pulses at {times[k]:.6g} s; allowed: "
                    "distances that change by less than 60 %, or a whole number of them where pulses are missing; look "
                    "at the channel, or cut the record"
                )
            track.missing.append((float(min(times[k], times[k + 1])), count - 1))
        track.times.append(float(times[k + 1]))
        track.steps.append(count)
        pitches.append(float(abs(times[k + 1] - track.times[-2])) / count)
        k += 1
    return track


def _next(pitches: list[float]) -> float:
    """Distance that those before it let expect: the last one, and the trend of three."""
    before = pitches[-3:]
    trend = math.pow(before[-1] / before[0], 1.0 / max(len(before) - 1, 1))
    return before[-1] * min(max(trend, 1.0 / _TREND), _TREND)


def _told(
    times: FloatArray, counts: IntArray, missing: list[tuple[float, int]], extra: list[float]
) -> tuple[tuple[int, int] | None, list[str]]:
    """Teeth of a wheel with a gap, those that are there and all; and sentences on what was mended."""
    notes, wheel = [], None
    places = [int(counts[np.argmin(np.abs(times - at))]) for at, _ in missing]
    turn, often = Counter(np.diff(places).tolist()).most_common(1)[0] if len(places) > 1 else (0, 0)
    if often >= 2 and often >= 0.8 * (len(missing) - 1):
        gap = Counter(count for _, count in missing).most_common(1)[0][0]
        wheel = (turn - gap, turn)
        notes.append(f"a wheel with {turn - gap} of {turn} teeth; those that are missing are counted")
        gaps = [place for place, (_, count) in zip(places, missing, strict=True) if count == gap]
        missing = [entry for entry in missing if entry[1] != gap]
        if np.any(np.diff(gaps) % turn):
            raise InputError(
                f"got gaps of {gap} teeth that do not come every {turn} ones; allowed: a wheel with one gap; look at "
                "the channel, or cut the record to a steadier speed"
            )
    mended = []
    for entries, words in (([at for at, _ in missing], "missing and counted"), (extra, "too many and left out")):
        if entries:
            shown = ", ".join(f"{at:.6g}" for at in entries[:5]) + (" ..." if len(entries) > 5 else "")
            mended.append(f"{len(entries)} pulse{'s' * (len(entries) > 1)} {words}, at {shown} s")
    if len(missing) + len(extra) > _MOST_MENDED * times.size:
        raise InputError(
            f"got {'; '.join(mended)}; allowed: a tenth of {times.size} pulses; look at the channel and its range"
        )
    return wheel, [*notes, *mended]
