"""Runs that are recorded, measured or simulated before: time data, and their levels over speed and frequency."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import xarray as xr

from ehdmaps.errors import InputError, Problems
from mbs.analyses.campbell import LawRun
from mbs.analyses.sensors import ALL_SENSORS, excited_orders, orders_in_band
from mbs.model.elements import Sensor
from mbs.output.campbell_table import campbell_dataset, of_sensors
from mbs.output.files import described
from mbs.scene.assembly import Model, law_attributes
from mbs.settings import CampbellSettings
from mbs.spectral.campbell import RunUpSpectra, run_up_spectra
from mbs.spectral.levels import Reference, at_equal_speeds
from mbs.spectral.run_signal import RunSignal
from mbs.spectral.spectra import (
    LEAST_OVERSAMPLING,
    LEAST_PERIODS,
    AmplitudeSpectrum,
    amplitude_spectrum,
    default_window,
)
from mbs.timedata.records import TimeChannel, TimeData, TimeRecord, chosen
from mbs.timedata.speed import AS_IT_IS, SpeedSource, with_speed
from mbs.transient.run import Recording

_STEADY, _STEADY_PART = 1e-6, 0.25
"""Change of a speed that counts as none, and the part of such a run that a window is."""


@dataclass(frozen=True, eq=False)
class RecordedRun:
    """A recorded run with its levels.

    Attributes
    ----------
    record : TimeRecord
        The run, with its speed.
    channels : tuple of TimeChannel
        What is looked at.
    spectra : tuple of RunUpSpectra
        Levels of each of them.
    notes : tuple of str
        How the speed was found.
    dataset : xarray.Dataset
        The levels, with the dim law of one entry.
    """

    record: TimeRecord
    channels: tuple[TimeChannel, ...]
    spectra: tuple[RunUpSpectra, ...]
    notes: tuple[str, ...]
    dataset: xr.Dataset


@dataclass(frozen=True, eq=False)
class RecordedResult:
    """Recorded runs of one file as levels.

    Attributes
    ----------
    runs : tuple of RecordedRun
        One a record.
    orders : tuple of (float, str)
        Orders that were followed, with their names.
    dataset : xarray.Dataset
        What `mbs campbell FILE -o` writes.
    """

    runs: tuple[RecordedRun, ...]
    orders: tuple[tuple[float, str], ...]
    dataset: xr.Dataset


def simulated(runs: Sequence[tuple[str, Model, Recording]]) -> TimeData:
    """The signals of simulated runs as time data, with the orders that the machine excites.

    Parameters
    ----------
    runs : sequence of (str, Model, Recording)
        Label, model and recording of each law; all of one scene and one course, with all sensors recorded.

    Raises
    ------
    InputError
        If the scene has no sensor.
    """
    _, model, first = runs[0]
    sensors = model.scene.sensors
    if not sensors:
        raise InputError(f"{model.scene.name}: got no [[sensors]]; allowed: at least one, whose signals are written")
    channels = tuple(TimeChannel(s.name, s.quantity, Reference.of(s).unit) for s in sensors)
    records = tuple(
        TimeRecord(label, run.signal_time, channels, run.signals, run.signal_speed, run.signal_angle)
        for label, _, run in runs
    )
    attributes = dict(law_attributes(model))
    attributes["law"] = "; ".join(f"{label}: {entry.law}" for label, entry, _ in runs)
    look = model.scene.campbell
    turns = float(np.ptp(first.signal_angle)) / (2.0 * np.pi)
    orders = [(order, f"{order:g}") for order in look.orders] or excited_orders(model, turns)
    return TimeData(model.scene.title, records, tuple(orders), attributes, look)


def simulated_campbell(runs: Sequence[LawRun]) -> TimeData:
    """The signals of the runs of a Campbell diagram.

    Parameters
    ----------
    runs : sequence of LawRun
        Runs of one result.
    """
    return simulated([(entry.case.label, entry.case.model, entry.record) for entry in runs])


def recorded_campbell(
    data: TimeData, settings: CampbellSettings, sensors: Sequence[str] = (), source: SpeedSource = AS_IT_IS
) -> RecordedResult:
    """Levels over speed, frequency and order of recorded runs, without simulating anything.

    Parameters
    ----------
    data : TimeData
        Recorded runs, from `mbs.output.time_files.read_time_data` or `simulated`.
    settings : CampbellSettings
        What is looked at; orders that it does not name are those of the data.
    sensors : sequence of str
        Names of channels, or `ALL_SENSORS`; that of the settings, or the first one of an acceleration, if left out.
    source : SpeedSource
        Place of the speed of records that do not have it themselves.

    Raises
    ------
    InputError
        With what is not possible.
    """
    turned = [with_speed(record, source) for record in data.records]
    channels = channels_of(turned[0].record, sensors or ((settings.sensor,) if settings.sensor else ()))
    slowest = min(float(np.min(np.abs(entry.record.speed))) for entry in turned)  # type: ignore[arg-type]
    orders = tuple(
        [(order, f"{order:g}") for order in settings.orders] or orders_in_band(data.orders, settings.highest, slowest)
    )
    settings = dataclasses.replace(settings, orders=tuple(order for order, _ in orders))
    runs = []
    for entry in turned:
        run = recorded_run_of(entry.record, channels, settings)
        runs.append(dataclasses.replace(run, notes=entry.notes))
    labels = [run.record.label for run in runs]
    parts = [
        campbell_dataset(labels, [run.spectra[place] for run in runs], _reference(channel), channel.name)
        for place, channel in enumerate(channels)
    ]
    attributes = {key: words for key, words in (data.attributes or {}).items() if not key.endswith("version")}
    dataset = described(of_sensors(parts), **{**attributes, "title": data.title})
    return RecordedResult(tuple(runs), orders, dataset)


def recorded_run_of(record: TimeRecord, channels: Sequence[TimeChannel], settings: CampbellSettings) -> RecordedRun:
    """Levels of some channels of a record that has its speed.

    Parameters
    ----------
    record : TimeRecord
        The record.
    channels : sequence of TimeChannel
        What is looked at.
    settings : CampbellSettings
        Highest frequency, window and orders.

    Raises
    ------
    InputError
        If they do not fit the record.
    """
    spectra = tuple(
        run_up_spectra(
            record.signal(channel), _reference(channel).value, settings.highest, settings.window, settings.orders
        )
        for channel in channels
    )
    parts = [
        campbell_dataset([record.label], [found], _reference(channel), channel.name)
        for channel, found in zip(channels, spectra, strict=True)
    ]
    return RecordedRun(record, tuple(channels), spectra, (), of_sensors(parts))


def channels_of(record: TimeRecord, names: Sequence[str]) -> tuple[TimeChannel, ...]:
    """The channels of some names; the first one of an acceleration without any.

    Parameters
    ----------
    record : TimeRecord
        The record.
    names : sequence of str
        Names, or `ALL_SENSORS` for all channels that have levels.

    Raises
    ------
    InputError
        If there is none of a name, or it has no levels.
    """
    there = ", ".join(f"{channel.name} [{channel.unit}]" for channel in record.sensors) or "none"
    if ALL_SENSORS in names and record.sensors:
        return record.sensors
    if not names:
        for channel in record.sensors:
            if channel.recorded == "acceleration":
                return (channel,)
        raise InputError(f"{record.label}: has no channel of an acceleration; allowed: --sensor with one of {there}")
    found = [chosen(record, name, "--sensor") for name in names]
    problems = Problems(
        f"--sensor: {channel.name!r:.60} is in {channel.unit}, of which there is no level; allowed: one of {there}"
        for channel in found
        if channel.reference is None
    )
    problems.check()
    return tuple(dict.fromkeys(found))


def channels_beside(record: TimeRecord, sensors: Sequence[Sensor], names: Sequence[str]) -> tuple[TimeChannel, ...]:
    """The channels of a measured run that stand beside sensors of a scene.

    Parameters
    ----------
    record : TimeRecord
        The measured run.
    sensors : sequence of Sensor
        Sensors of the scene.
    names : sequence of str
        Names of the channels in the order of the sensors; if left out, channels of their names, or the only one of
        their quantity.

    Raises
    ------
    InputError
        If a sensor has none.
    """
    if names and len(names) != len(sensors):
        raise InputError(f"--channel: got {len(names)} names for {len(sensors)} sensors; allowed: one each, in order")
    found, problems = [], []
    for place, sensor in enumerate(sensors):
        unit = Reference.of(sensor).unit
        same = [channel for channel in record.sensors if channel.unit == unit]
        called = [channel for channel in same if channel.name.lower() == sensor.name.lower()]
        if names:
            channel = chosen(record, names[place], "--channel")
            if channel.unit != unit:
                problems.append(
                    f"--channel: {channel.name!r:.60} is in {channel.unit} and sensor {sensor.name} in {unit}; "
                    "allowed: channels of the same quantity"
                )
            found.append(channel)
        elif called or (len(same) == 1 and len(sensors) == 1):
            found.append((called or same)[0])
        else:
            problems.append(
                f"{record.label}: has no channel {sensor.name!r:.60} in {unit}; allowed: {', '.join(record.names)}; "
                "name the channels in the order of the sensors (--channel)"
            )
    if problems:
        raise InputError(problems)
    return tuple(found)


def amplitudes_at(
    record: TimeRecord, speeds: Sequence[float], window: float | None, highest: float
) -> list[tuple[AmplitudeSpectrum, ...]]:
    """Amplitude spectra of all channels of motion about some speeds, an entry a speed.

    Parameters
    ----------
    record : TimeRecord
        A run with its speed: a ramp, or at constant speed.
    speeds : sequence of float
        [rad/s].
    window : float or None
        Length of the windows [s]; None for that of a Campbell diagram, at constant speed a quarter of the run.
    highest : float
        Highest frequency [Hz]; less where the record is too coarse for it.

    Raises
    ------
    InputError
        If the run does not pass a speed, or the window does not fit.
    """
    if not speeds:
        return []
    signals = [record.signal(channel) for channel in record.sensors]
    top = min(highest, signals[0].rate / LEAST_OVERSAMPLING)
    length = _window(signals[0], top) if window is None else window
    return [tuple(amplitude_spectrum(signal, speed, length, top) for signal in signals) for speed in speeds]


def _window(run: RunSignal, highest: float) -> float:
    """Length of a window where none is given [s]."""
    shortest = LEAST_PERIODS / highest
    fastest = float(run.speed.max())
    if float(np.ptp(run.speed)) <= _STEADY * fastest:
        return max(_STEADY_PART * run.duration, shortest)
    return max(default_window(run, 2.0 * np.pi * highest / fastest), shortest)


def at_speeds_of(run: RunUpSpectra, other: RunUpSpectra) -> tuple[np.ndarray, np.ndarray] | None:
    """Sum levels of two runs at the same speeds [dB], those of the first within both; None where they share none.

    Parameters
    ----------
    run, other : RunUpSpectra
        The levels of the second are interpolated as mean squares.
    """
    one, two = run.campbell, other.campbell
    return at_equal_speeds(one.speeds, one.sum_level, two.speeds, two.sum_level)


def _reference(channel: TimeChannel) -> Reference:
    """Reference of a channel that has levels."""
    reference = channel.reference
    assert reference is not None  # channels are chosen by it
    return reference
