"""Bands of modes and critical speeds over speed: looks at three speeds, relative bands between them.

What is open moves a mode at neighbouring speeds by nearly equal parts, so that the parts at the first, the middle and
the last speed are interpolated over the speed. A critical speed is where order times speed meets the frequency f of a
mode: to first order it moves by the part of f over 1 - s, with the slope s = d ln f/d ln Omega there, since the mode
moves with the speed as well.
"""

from __future__ import annotations

import math
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
    responses : Band
        Bands of the largest responses, in the order of `Responses.values`.
    """

    places: tuple[int, ...]
    at: tuple[ModeBands, ...]
    tracks: tuple[IntArray, ...]
    frequency: FloatArray
    damping_ratio: FloatArray
    responses: Band

    @property
    def told(self) -> dict[str, Band]:
        """Bands of modes at the last speed, by what they are of, in words."""
        return self.at[-1].told


def bands_over_speed(model: Model, found: Sweep, highest: float, responses: Responses | None = None) -> SpeedBands:
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
    centre = np.concatenate([look.centre.reshape(-1) for look in looks])
    largest = np.zeros(0) if responses is None else responses.values
    numerics = np.concatenate([*(look.numerics.reshape(-1) for look in looks), np.zeros(largest.size)])
    scale = np.ones(largest.size)

    def look(scene: Scene, standing: bool) -> FloatArray:
        other = model.again(scene)
        balances = [looked_at(other, one.balance, standing) for one in looks]
        values = [
            one.paired(balance, modes(balance, errors=False)) for one, balance in zip(looks, balances, strict=True)
        ]
        return np.concatenate([*(value.reshape(-1) for value in values), scale * answered(balances, values)])

    def answered(balances: Sequence[Equilibrium], values: Sequence[FloatArray]) -> FloatArray:
        if responses is None:
            return np.zeros(0)
        orders = sorted({abs(load.order) for load in balances[0].system.turning})
        crossings = _crossings(found.speeds[list(places)], values, tracks, orders, found.speeds)
        try:
            return responses.largest(responses_between(balances, found.speeds, crossings))
        except np.linalg.LinAlgError:
            raise AnalysisError("responses: there is none at an undamped resonance") from None

    if responses is not None:
        # what three equilibria miss of the printed responses is in all looks alike
        own_values = answered([one.balance for one in looks], [one.centre for one in looks])
        scale = np.divide(largest, own_values, out=np.ones(largest.size), where=own_values > 0.0)
    both = band(look, np.concatenate([centre, largest]), held_open_of(model), numerics)
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
    return SpeedBands(places, tuple(at), tuple(tracks), frequency, ratio, both.of(slice(first, None)))


def _crossings(
    known: FloatArray,
    values: Sequence[FloatArray],
    tracks: Sequence[IntArray],
    orders: Sequence[float],
    speeds: FloatArray,
) -> list[tuple[float, float, float]]:
    """Orders, speeds and damping ratios at which modes of a look meet orders; modes are linear between its speeds."""
    found = []
    for track in range(tracks[0].size):
        own = [
            value[:, places[track]] if places[track] >= 0 else (np.nan, np.nan)
            for value, places in zip(values, tracks, strict=True)
        ]
        frequency, ratio = np.array(own).T
        damped = 2.0 * math.pi * frequency * np.sqrt(np.maximum(1.0 - ratio**2, 0.0))
        if not np.all(np.isfinite(damped)):
            continue
        fine = np.linspace(speeds[0], speeds[-1], _FINE)
        swings = np.interp(fine, known, damped)
        for order in orders:
            apart = swings - order * fine
            for k in np.flatnonzero(apart[:-1] * apart[1:] <= 0.0).tolist():
                part = apart[k] / (apart[k] - apart[k + 1]) if apart[k] != apart[k + 1] else 0.0
                speed = float(fine[k] + part * (fine[k + 1] - fine[k]))
                found.append((order, speed, float(np.interp(speed, known, ratio))))
    return found


def critical_bounds(bands: SpeedBands, found: Sweep, critical: Sequence[CriticalSpeed]) -> FloatArray:
    """Bounds of critical speeds and of damping ratios there, shape (critical, 4), NaN where they are not known.

    Parameters
    ----------
    bands : SpeedBands
        Bands of the modes of the sweep.
    found : Sweep
        The sweep.
    critical : sequence of CriticalSpeed
        Critical speeds of the machine.

    Returns
    -------
    array
        Low and high speed [rad/s], low and high damping ratio.
    """
    bounds = np.full((len(critical), 4), np.nan)
    with np.errstate(divide="ignore", invalid="ignore"):
        slopes = np.gradient(found.damped.frequency, found.speeds, axis=0) * found.speeds[:, None]
        slopes = slopes / found.damped.frequency
    for row, entry in zip(bounds, critical, strict=True):
        imaginary = [_at(found.speeds, values, entry.speed) for values in found.damped.eigenvalues.imag.T]
        apart = np.abs(np.array(imaginary) - entry.eigenvalue.imag)
        if not np.isfinite(apart).any():
            continue
        track = int(np.nanargmin(apart))
        fall, rise = (_at(found.speeds, side[:, track], entry.speed) for side in bands.frequency)
        weaker, stronger = (_at(found.speeds, side[:, track], entry.speed) for side in bands.damping_ratio)
        own = 1.0 - _at(found.speeds, slopes[:, track], entry.speed)
        if not own > 0.0:
            continue  # the mode runs along with the order: no first order
        row[:2] = entry.speed * max(1.0 - fall / own, 0.0), entry.speed * (1.0 + rise / own)
        row[2:] = entry.damping_ratio * max(1.0 - weaker, 0.0), entry.damping_ratio * (1.0 + stronger)
    return bounds


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
