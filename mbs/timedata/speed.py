"""Speed and angle of a measured run: a channel of the speed, pulses of a tacho, or a table of speeds.

Spectra over speed need a ramp: a speed that only rises, or only falls. A measured speed has noise; where it is no ramp
as it stands, a cubic spline of 20 parts is fitted to it (least squares), and of that the longest ramp is taken. The
angle is that of the measured speed, or of the pulses, and is not smoothed.

References
----------
K. R. Fyfe, E. D. S. Munck, Mech. Syst. Signal Process. 11 (1997) 187-205 (angle from the pulses of a tacho).
"""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.interpolate import PchipInterpolator, make_lsq_spline

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import InputError, Problems, problems_after
from ehdmaps.units import RPM
from mbs.timedata.csv_file import read_table
from mbs.timedata.pulses import FEWEST, counted, rising_flanks
from mbs.timedata.records import SPEED_UNITS, TimeRecord, chosen

MOST_PULSES = 100_000
"""A turn."""

_PARTS = 20
"""Of the spline through a speed with noise, over the record."""

_LEAST_RANGE = 0.5
"""Of the range of a speed that a ramp has to cover."""

_FEWEST = 64
"""Samples that a spectrum needs."""

_HELD = 1e-12


@dataclass(frozen=True)
class SpeedSource:
    """Source of the speed of a record; at most one of the three.

    Attributes
    ----------
    channel : str or None
        Channel of the speed; None for the only one in a unit of a speed.
    tacho : str or None
        Channel of pulses.
    pulses : float
        Pulses of the tacho a turn of the system; those of missing teeth are counted.
    table : Path or None
        A table of time and speed (.csv), on the clock of the record.

    Raises
    ------
    InputError
        If more than one is given, or pulses are not possible.
    """

    channel: str | None = None
    tacho: str | None = None
    pulses: float = 1.0
    table: Path | None = None

    def __post_init__(self) -> None:
        given = [
            name
            for name, value in (("channel", self.channel), ("tacho", self.tacho), ("table", self.table))
            if value is not None
        ]
        problems = Problems()
        if len(given) > 1:
            problems.append(f"speed: got {' and '.join(given)}; allowed: one of them")
        if not 0.0 < self.pulses <= MOST_PULSES:
            problems.append(f"speed, pulses: got {self.pulses!r} a turn; allowed: above 0 up to {MOST_PULSES}")
        problems.check()


AS_IT_IS = SpeedSource()
"""The speed that a record has, else its only channel of a speed."""


@dataclass(frozen=True, eq=False)
class Turned:
    """A record with its speed.

    Attributes
    ----------
    record : TimeRecord
        The part of it in which the speed is a ramp, with speed and angle.
    notes : tuple of str
        How they were found, and what was left out.
    """

    record: TimeRecord
    notes: tuple[str, ...]


def with_speed(record: TimeRecord, source: SpeedSource) -> Turned:
    """Find speed and angle of a record, and cut it to a ramp.

    Parameters
    ----------
    record : TimeRecord
        The record; one that has its speed already keeps it if the source names none.
    source : SpeedSource
        Place of the speed.

    Raises
    ------
    InputError
        If there is no speed, or it is no ramp.
    """
    if record.speed is not None and source == AS_IT_IS:
        return Turned(record, ())
    if source.tacho is not None:
        turned = _by_tacho(record, source.tacho, source.pulses)
    elif source.table is not None:
        turned = _by_table(record, source.table)
    else:
        turned = _by_channel(record, source.channel)
    ramp = _ramp(turned.record)
    return Turned(ramp.record, (*turned.notes, *ramp.notes))


def _by_channel(record: TimeRecord, name: str | None) -> Turned:
    """Speed of a channel."""
    if name is None:
        channels = [channel for channel in record.channels if channel.recorded == "speed"]
        if len(channels) != 1:
            raise InputError(
                f"{record.label}: got {len(channels)} channels of a speed among {', '.join(record.names)}; allowed: "
                f"one in {', '.join(SPEED_UNITS)}; name it (--speed-channel), or give pulses (--tacho) or a table "
                "(--speed-table)"
            )
        channel = channels[0]
    else:
        channel = chosen(record, name, "--speed-channel")
        if channel.unit != "rad/s":
            raise InputError(
                f"--speed-channel: {channel.name!r:.60} is in {channel.unit}; allowed: a channel in "
                f"{', '.join(SPEED_UNITS)}"
            )
    return Turned(_turned(record, record.column(channel)), (f"speed of the channel {channel.name}",))


def _by_table(record: TimeRecord, path: Path) -> Turned:
    """Speed of a table, for the part of the record that it covers."""
    channels, factors, values = read_table(path)
    clocks = [place for place, channel in enumerate(channels) if channel.recorded == "time"]
    speeds = [place for place, channel in enumerate(channels) if channel.recorded == "speed"]
    if len(clocks) != 1 or len(speeds) != 1:
        raise InputError(
            f"{path}: got {len(clocks)} columns of a time and {len(speeds)} of a speed; allowed: one of each, such as "
            "time [s],speed [rpm]"
        )
    values = values * factors
    time, speed = values[:, clocks[0]], values[:, speeds[0]]
    if not (np.all(np.isfinite(time)) and np.all(np.isfinite(speed)) and time.size >= 2 and np.all(np.diff(time) > 0)):
        raise InputError(f"{path}: got times or speeds that are not finite, or times that do not rise; sort the rows")
    inside = np.flatnonzero((record.time >= time[0]) & (record.time <= time[-1]))
    if inside.size < _FEWEST:
        raise InputError(
            f"{path}: got speeds from {time[0]:.6g} to {time[-1]:.6g} s for a record from {record.time[0]:.6g} to "
            f"{record.time[-1]:.6g} s; allowed: a table on the clock of the record"
        )
    part = record.part(int(inside[0]), int(inside[-1]) + 1)
    return Turned(_turned(part, np.interp(part.time, time, speed)), (f"speed of the table {path}",))


def _by_tacho(record: TimeRecord, name: str, pulses: float) -> Turned:
    """Speed and angle of the pulses of a tacho, between the first and the last one."""
    channel = chosen(record, name, "--tacho")
    where = f"{record.label}, tacho {channel.name!r:.60}"
    values = record.column(channel)
    flanks = rising_flanks(record.time, values)
    if flanks.size < FEWEST:
        raise InputError(
            f"{where}: got {flanks.size} pulses between {values.min():.4g} and {values.max():.4g} {channel.unit}; "
            f"allowed: at least {FEWEST}; look at the channel and its range"
        )
    with problems_after(f"{where}: "):
        found = counted(flanks)
    if found.wheel is not None and found.wheel[0] == pulses:
        raise InputError(
            f"{where}: got {pulses:g} pulses a turn of a wheel with {found.wheel[0]} of {found.wheel[1]} teeth; "
            f"allowed: {found.wheel[1]}, those that are missing counted"
        )
    times = found.times
    turns = PchipInterpolator(times, found.counts / pulses)
    inside = np.flatnonzero((record.time >= times[0]) & (record.time <= times[-1]))
    if inside.size < _FEWEST:
        raise InputError(f"{record.label}, tacho: got {inside.size} samples between its pulses; allowed: {_FEWEST}")
    part = record.part(int(inside[0]), int(inside[-1]) + 1)
    angle = 2.0 * np.pi * np.asarray(turns(part.time))
    speed = 2.0 * np.pi * np.asarray(turns.derivative()(part.time))
    words = f"speed of {times.size} pulses of {channel.name}, {pulses:g} a turn"
    notes = (words, *(f"tacho {channel.name}: {note}" for note in found.notes))
    return Turned(dataclasses.replace(part, speed=speed, angle=angle), notes)


def _turned(record: TimeRecord, speed: FloatArray) -> TimeRecord:
    """A record with a speed and its integral."""
    step = float(record.time[-1] - record.time[0]) / (record.time.size - 1)
    angle = np.concatenate([[0.0], np.cumsum(0.5 * (speed[1:] + speed[:-1]) * step)])
    return dataclasses.replace(record, speed=np.asarray(speed, dtype=np.float64), angle=angle)


def _ramp(record: TimeRecord) -> Turned:
    """The longest part of a record in which the speed only rises or only falls; of a smooth one, if need be."""
    assert record.speed is not None
    begin, end = _longest(record.speed)
    notes: list[str] = []
    whole = float(np.ptp(record.speed))
    if not whole > 0.0:
        raise InputError(
            f"{record.label}: got a speed of {RPM.text(float(record.speed[0]))} throughout; allowed: a run-up or a "
            "coast-down"
        )
    if abs(record.speed[end] - record.speed[begin]) < 0.999 * whole:
        smooth = _smooth(record)
        left = float(np.sqrt(np.mean((smooth - record.speed) ** 2)))
        record = dataclasses.replace(record, speed=smooth)
        notes.append(f"speed smoothed by a spline of {_PARTS} parts, which leaves {RPM.text(left, 3)} (rms)")
        begin, end = _longest(smooth)
        whole = float(np.ptp(smooth))
    assert record.speed is not None
    covered = abs(float(record.speed[end] - record.speed[begin]))
    if covered < _LEAST_RANGE * whole or end + 1 - begin < _FEWEST:
        raise InputError(
            f"{record.label}: got a speed that turns round: of {RPM.text(float(record.speed.min()))} to "
            f"{RPM.text(float(record.speed.max()))} its longest ramp, from {record.time[begin]:.6g} to "
            f"{record.time[end]:.6g} s, has {100.0 * covered / whole:.3g} %; allowed: {100.0 * _LEAST_RANGE:g} % and "
            "more; cut the record into ramps"
        )
    if begin > 0 or end < record.speed.size - 1:
        notes.append(
            f"part of {record.time[begin]:.6g} to {record.time[end]:.6g} s, in which the speed goes from "
            f"{RPM.text(float(record.speed[begin]))} to {RPM.text(float(record.speed[end]))}"
        )
    return Turned(record.part(begin, end + 1), tuple(notes))


def _longest(speed: FloatArray) -> tuple[int, int]:
    """First and last sample of the ramp that changes the speed most."""
    change = np.diff(speed)
    held = _HELD * float(np.max(np.abs(speed)))
    best, ramp = -1.0, (0, 0)
    for direction in (1.0, -1.0):
        edges = np.flatnonzero(np.diff(np.concatenate([[0], (direction * change > held).astype(np.int64), [0]])))
        for begin, end in zip(edges[::2].tolist(), edges[1::2].tolist(), strict=True):
            if (covered := abs(float(speed[end] - speed[begin]))) > best:
                best, ramp = covered, (begin, end)
    return ramp


def _smooth(record: TimeRecord) -> FloatArray:
    """The speed without its noise."""
    assert record.speed is not None
    place = np.linspace(0.0, 1.0, record.speed.size)
    knots = np.concatenate([np.zeros(3), np.linspace(0.0, 1.0, _PARTS + 1), np.ones(3)])
    return np.asarray(make_lsq_spline(place, record.speed, knots)(place), dtype=np.float64)
