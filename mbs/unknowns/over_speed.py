"""Bands of modes and critical speeds over speed: looks at three speeds, relative bands between them.

What is open moves a mode at neighbouring speeds by nearly equal parts, so that the parts at the first, the middle and
the last speed are interpolated over the speed. A critical speed is where the mode, changed by these parts, meets its
order; its damping ratio is that of the mode there. The largest responses over speed to loads that turn are found anew
in each look, with what the three equilibria have between their speeds and each resonance where the look has it.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ehdmaps.arrays import ComplexArray, FloatArray, IntArray
from ehdmaps.errors import AnalysisError
from mbs.analyses.operating import operating
from mbs.linearised.averaged import mean_equilibrium
from mbs.linearised.critical import CriticalSpeed, OrderResponse, responses_between
from mbs.linearised.modes import modes
from mbs.linearised.sweep_result import Sweep
from mbs.model.elements import Operation
from mbs.model.equilibrium import Equilibrium
from mbs.scene.assembly import Model
from mbs.scene.scene import Scene
from mbs.unknowns.held_open import held_open_of
from mbs.unknowns.looks import Band, band
from mbs.unknowns.of_modes import ModeBands, ModeLook, banded, looked_at

_SAME = 1e-4
"""Part of an eigenvalue within which a mode of a sweep and one of its speed alone are one."""

_LEAST = 1e-12

_FINE = 401
"""Speeds between which it is looked where modes meet orders."""


class Responses(NamedTuple):
    """Largest responses over speed, which have bands.

    Attributes
    ----------
    values : array, shape (responses,)
        Values as they are printed, in SI.
    largest : callable
        Finds them of responses of all orders.
    """

    values: FloatArray
    largest: Callable[[Sequence[OrderResponse]], FloatArray]


@dataclass(frozen=True, eq=False)
class SpeedBands:
    """Parts by which modes of a sweep may be larger or smaller, NaN where that is not known.

    Attributes
    ----------
    places : tuple of int
        Speeds of the sweep that were looked at.
    at : tuple of ModeBands
        Bands of all modes there.
    tracks : tuple of array of int, shape (tracks,)
        Place among these of each mode of the sweep; -1 where it has none.
    frequency, damping_ratio : array, shape (2, speeds, tracks)
        Parts of fall and rise, both >= 0.
    critical : Band
        Bands of critical speeds [rad/s] and of the damping ratios there, shape (2, critical).
    responses : Band
        Bands of the largest responses, in the order of `Responses.values`.
    """

    places: tuple[int, ...]
    at: tuple[ModeBands, ...]
    tracks: tuple[IntArray, ...]
    frequency: FloatArray
    damping_ratio: FloatArray
    critical: Band
    responses: Band

    @property
    def told(self) -> dict[str, Band]:
        """Bands of modes at the last speed, by what they are of, in words."""
        return self.at[-1].told


def bands_over_speed(
    model: Model,
    found: Sweep,
    highest: float,
    responses: Responses | None = None,
    critical: Sequence[CriticalSpeed] = (),
) -> SpeedBands:
    """Look at the modes of a sweep, and at responses, at its first, middle and last speed.

    Parameters
    ----------
    model : Model
        Scene with its law.
    found : Sweep
        The sweep.
    highest : float
        Frequency up to which modes have bands [Hz].
    responses : Responses, optional
        Largest responses to loads that turn, which have bands, too.
    critical : sequence of CriticalSpeed
        Critical speeds of the machine, which have bands, too.
    """
    count = found.speeds.size
    places = tuple(dict.fromkeys((0, count // 2, count - 1)))
    looks, tracks = list[ModeLook](), list[IntArray]()
    for place in places:
        operation = Operation(float(found.speeds[place]))
        balance = mean_equilibrium(operating(model, operation.speed).system, operation, found.bearings.angles)
        own = modes(balance)
        looks.append(ModeLook(model, balance, own, banded(own, highest)))
        tracks.append(_places(found.damped.eigenvalues[place], own.eigenvalues[looks[-1].chosen]))
    centres = [look.centre for look in looks]
    known, owners = found.speeds[list(places)], [_track_of(found, entry) for entry in critical]
    orders = sorted({abs(load.order) for load in looks[0].balance.system.turning})

    def more(balances: Sequence[Equilibrium], values: Sequence[FloatArray]) -> FloatArray:
        """Critical speeds and damping ratios there, then the largest responses."""
        course = _course(found, known, centres, values, tracks)
        met = np.full((2, len(critical)), np.nan)
        for k, (entry, track) in enumerate(zip(critical, owners, strict=True)):
            crossings = course.crossings(entry.order, track)
            if crossings:
                met[:, k] = min(crossings, key=lambda one: abs(one[0] - entry.speed))
        if responses is None:
            return met.reshape(-1)
        where = [
            (order, *one)
            for order in orders
            for track in range(tracks[0].size)
            for one in course.crossings(order, track)
        ]
        try:
            return np.append(met, responses.largest(responses_between(balances, found.speeds, where)))
        except np.linalg.LinAlgError:
            raise AnalysisError("responses: there is none at an undamped resonance") from None

    def look(scene: Scene, standing: bool) -> FloatArray:
        other = model.again(scene)
        balances = [looked_at(other, one.balance, standing) for one in looks]
        values = [
            one.paired(balance, modes(balance, errors=False)) for one, balance in zip(looks, balances, strict=True)
        ]
        return np.concatenate([*(value.reshape(-1) for value in values), scale * more(balances, values)])

    printed = np.concatenate(
        [
            [entry.speed for entry in critical],
            [entry.damping_ratio for entry in critical],
            np.zeros(0) if responses is None else responses.values,
        ]
    )
    # what three equilibria miss of what is printed is in all looks alike
    missed = more([one.balance for one in looks], centres)
    scale = np.divide(printed, missed, out=np.ones(printed.size), where=missed > 0.0)
    numerics = np.concatenate([*(one.numerics.reshape(-1) for one in looks), np.zeros(printed.size)])
    centre = np.concatenate([*(one.reshape(-1) for one in centres), printed])
    both = band(look, centre, held_open_of(model), numerics)
    at, first = [], 0
    for one in looks:
        size = one.chosen.size
        at.append(ModeBands(one.chosen, *(both.of(first + part * size + np.arange(size)) for part in (0, 1))))
        first += 2 * size
    parts = [
        np.array([_parts(getattr(bands, name), track) for bands, track in zip(at, tracks, strict=True)])
        for name in ("frequency", "damping_ratio")
    ]
    frequency, ratio = (_between(found.speeds, np.array(places), part) for part in parts)
    ends = first + np.arange(2 * len(critical)).reshape(2, -1)
    met, largest = both.of(ends), both.of(slice(first + ends.size, None))
    return SpeedBands(places, tuple(at), tuple(tracks), frequency, ratio, met, largest)


class _Course(NamedTuple):
    """Course of the modes of a look over speed, shape (fine speeds, tracks): those of the sweep, changed by parts."""

    speeds: FloatArray
    swings: FloatArray
    ratio: FloatArray

    def crossings(self, order: float, track: int) -> list[tuple[float, float]]:
        """Speeds at which a mode meets an order, and its damping ratios there."""
        apart = self.swings[:, track] - order * self.speeds
        found = []
        for k in np.flatnonzero(apart[:-1] * apart[1:] <= 0.0).tolist():
            part = apart[k] / (apart[k] - apart[k + 1]) if apart[k] != apart[k + 1] else 0.0
            speed = float(self.speeds[k] + part * (self.speeds[k + 1] - self.speeds[k]))
            found.append((speed, float(np.interp(speed, self.speeds, self.ratio[:, track]))))
        return found


def _course(
    found: Sweep,
    known: FloatArray,
    centres: Sequence[FloatArray],
    values: Sequence[FloatArray],
    tracks: Sequence[IntArray],
) -> _Course:
    """Course of modes whose frequencies and damping ratios (2, modes) at some speeds are changed from the centres."""
    fine = np.linspace(found.speeds[0], found.speeds[-1], _FINE)
    swings, ratios = np.full((2, _FINE, tracks[0].size), np.nan)
    for track in range(tracks[0].size):
        there = [k for k, places in enumerate(tracks) if places[track] >= 0]
        pairs = [np.array([part[k][:, tracks[k][track]] for k in there]).reshape(-1, 2).T for part in (values, centres)]
        (frequency, ratio), (own_frequency, own_ratio) = pairs
        seen = np.isfinite(frequency)
        if not seen.any():
            continue
        undamped = np.sqrt(np.maximum(1.0 - ratio**2, 0.0) / np.maximum(1.0 - own_ratio**2, _LEAST))
        stronger = np.divide(ratio, own_ratio, out=np.ones(ratio.size), where=own_ratio > 0.0)
        at = known[there][seen]
        grown, damped = (np.interp(fine, at, part[seen]) for part in (frequency / own_frequency * undamped, stronger))
        swings[:, track] = grown * np.interp(fine, found.speeds, found.damped.eigenvalues.imag[:, track])
        ratios[:, track] = damped * np.interp(fine, found.speeds, found.damped.damping_ratio[:, track])
    return _Course(fine, swings, ratios)


def _track_of(found: Sweep, entry: CriticalSpeed) -> int:
    """Mode of a sweep that a critical speed is of."""
    imaginary = np.array([_at(found.speeds, values, entry.speed) for values in found.damped.eigenvalues.imag.T])
    apart = np.abs(imaginary - entry.eigenvalue.imag)
    return int(np.nanargmin(apart)) if np.isfinite(apart).any() else 0


def _places(tracks: ComplexArray, modes_there: ComplexArray) -> IntArray:
    """Place of each mode of a sweep among the modes of a speed; -1 where it is none of them."""
    found = np.full(tracks.size, -1)
    for k, value in enumerate(tracks):
        if np.isfinite(value) and modes_there.size:
            nearest = int(np.argmin(np.abs(modes_there - value)))
            if abs(modes_there[nearest] - value) <= _SAME * abs(value):
                found[k] = nearest
    return found


def _parts(band: Band, track: IntArray) -> FloatArray:
    """Fall and rise of each track in parts of its value, shape (2, tracks)."""
    with np.errstate(divide="ignore", invalid="ignore"):
        parts = np.array([band.fall, band.rise]) / np.abs(band.value)
    found = np.full((2, track.size), np.nan)
    found[:, track >= 0] = parts[:, track[track >= 0]]
    return found


def _between(speeds: FloatArray, places: IntArray, parts: FloatArray) -> FloatArray:
    """Parts (looks, 2, tracks) at all speeds, shape (2, speeds, tracks): those of the nearest look beyond the last."""
    found = np.full((2, speeds.size, parts.shape[2]), np.nan)
    for side, track in np.ndindex(2, parts.shape[2]):
        known = np.isfinite(parts[:, side, track])
        if known.any():
            found[side, :, track] = np.interp(speeds, speeds[places[known]], parts[known, side, track])
    return found


def _at(speeds: FloatArray, values: FloatArray, speed: float) -> float:
    """A value between the speeds of a sweep; NaN beyond those that are known."""
    known = np.isfinite(values)
    return float(np.interp(speed, speeds[known], values[known], np.nan, np.nan)) if known.any() else float("nan")
