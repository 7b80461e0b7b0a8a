"""Bands of modes and critical speeds over speed: looks at three speeds, relative bands between them.

What is open moves a mode at neighbouring speeds by nearly equal parts, so that the parts at the first, the middle and
the last speed are interpolated over the speed. A critical speed is where order times speed meets the frequency f of a
mode: to first order it moves by the part of f over 1 - s, with the slope s = d ln f/d ln Omega there, since the mode
moves with the speed as well.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ehdmaps.arrays import ComplexArray, FloatArray, IntArray
from mbs.analyses.operating import operating
from mbs.linearised.averaged import mean_equilibrium
from mbs.linearised.critical import CriticalSpeed
from mbs.linearised.modes import modes
from mbs.linearised.sweep_result import Sweep
from mbs.model.elements import Operation
from mbs.scene.assembly import Model
from mbs.unknowns.looks import Band
from mbs.unknowns.of_modes import ModeBands, bands_of

_SAME = 1e-4
"""Part of an eigenvalue within which a mode of a sweep and one of its speed alone are one."""


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
    """

    places: tuple[int, ...]
    at: tuple[ModeBands, ...]
    tracks: tuple[IntArray, ...]
    frequency: FloatArray
    damping_ratio: FloatArray


def bands_over_speed(model: Model, found: Sweep, highest: float) -> SpeedBands:
    """Look at the modes of a sweep at its first, middle and last speed.

    Parameters
    ----------
    model : Model
        Scene with its law.
    found : Sweep
        The sweep.
    highest : float
        Frequency up to which modes have bands [Hz].
    """
    count = found.speeds.size
    places = tuple(dict.fromkeys((0, count // 2, count - 1)))
    at, tracks = [], []
    for place in places:
        operation = Operation(float(found.speeds[place]))
        system = operating(model, operation.speed).system
        balance = mean_equilibrium(system, operation, found.bearings.angles)
        own = modes(balance)
        at.append(bands_of(model, balance, own, highest))
        tracks.append(_places(found.damped.eigenvalues[place], own.eigenvalues[at[-1].chosen]))
    both = [
        np.array([_parts(getattr(bands, name), track) for bands, track in zip(at, tracks, strict=True)])
        for name in ("frequency", "damping_ratio")
    ]
    frequency, ratio = (_between(found.speeds, np.array(places), parts) for parts in both)
    return SpeedBands(places, tuple(at), tuple(tracks), frequency, ratio)


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
