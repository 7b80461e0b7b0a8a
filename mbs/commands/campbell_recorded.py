"""Recorded runs in `mbs campbell`: alone, in place of a scene, or measured ones beside simulated ones."""

from __future__ import annotations

import argparse
import dataclasses
import math
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ehdmaps.errors import InputError, Problems, problems_after
from ehdmaps.outputs import FIGURE, Output, output_problems
from ehdmaps.units import RPM, short
from mbs.analyses.campbell import CampbellResult, waterfall_of
from mbs.analyses.ramp import rehearsed, run_course
from mbs.analyses.recorded import (
    RecordedResult,
    RecordedRun,
    at_speeds_of,
    channels_beside,
    recorded_campbell,
    recorded_run_of,
)
from mbs.analyses.sensors import ALL_SENSORS, chosen_sensors, followed_orders
from mbs.commands.common import out_of_place, read_band, write, write_plot
from mbs.output.campbell_table import highest_line, peak_lines, resolution_lines, sensor_line
from mbs.output.files import RESULT
from mbs.output.time_files import is_time_data, read_time_data, signal_outputs, write_time_data
from mbs.scene.assembly import Model
from mbs.scene.choices import OPTIONS
from mbs.settings import CampbellSettings
from mbs.spectral.campbell import RunUpSpectra
from mbs.spectral.levels import Reference, difference_text
from mbs.timedata.records import TimeChannel, TimeData
from mbs.timedata.speed import AS_IT_IS, SpeedSource, with_speed
from mbs.timedata.wav_file import SOUND

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_MOST_ORDERS, _LARGEST_ORDER = 50, 1e4
_OF_A_SCENE = (
    *(choice.key for choice in OPTIONS),
    *("bands", "tolerance", "modes", "auto", "measured", "channel"),
)
"""Options that say something of a simulation, and nothing of a run that is recorded."""

OF_A_SPEED = ("speed_channel", "tacho", "pulses", "speed_table")


@dataclass(frozen=True, eq=False)
class Look:
    """Options of the command line for what is looked at.

    Attributes
    ----------
    sensors : list of str
        Names of sensors; none for that of the scene.
    band : dict
        Highest frequency [Hz] and length of the windows [s], where they are given, as `CampbellSettings` calls them.
    orders : tuple of float
        Orders to follow; none for those of the machine.
    source : SpeedSource
        Place of the speed of a record.
    measured : str or None
        File of a measured run.
    channels : list of str
        Channels of the measured run, in the order of the sensors.
    """

    sensors: list[str]
    band: dict[str, Any]
    orders: tuple[float, ...]
    source: SpeedSource
    measured: str | None
    channels: list[str]

    @property
    def files(self) -> list[str | Path]:
        """Files that are read besides scene and maps."""
        return [entry for entry in (self.measured, self.source.table) if entry is not None]

    def settings(self, given: CampbellSettings) -> CampbellSettings:
        """Settings of a scene, with what the command line says instead."""
        return dataclasses.replace(
            given,
            sensor=self.sensors[0] if self.sensors and ALL_SENSORS not in self.sensors else given.sensor,
            **self.band,
            orders=self.orders or given.orders,
        )


def read_look(arguments: argparse.Namespace, problems: Problems) -> Look:
    """Read the options of what is looked at.

    Parameters
    ----------
    arguments : argparse.Namespace
        Arguments of the command.
    problems : Problems
        What is wrong is appended.
    """
    band, source = read_band(arguments, problems), read_source(arguments, problems)
    measured = getattr(arguments, "measured", None)
    if measured is None:
        idle = ("channel", *OF_A_SPEED) if _is_scene(arguments) else ()
        words = "stands without --measured; allowed: with it, or with a recorded run"
        problems += out_of_place(arguments, idle, words)
    sensors, channels = (_list(arguments, name) for name in ("sensor", "channel"))
    return Look(sensors, band, _orders(arguments, problems), source, measured, channels)


def read_source(arguments: argparse.Namespace, problems: Problems) -> SpeedSource:
    """Read where the speed of a recorded run is.

    Parameters
    ----------
    arguments : argparse.Namespace
        Arguments of the command.
    problems : Problems
        What is wrong is appended.
    """
    channel, tacho, pulses, table = (getattr(arguments, name, None) for name in OF_A_SPEED)
    try:
        count = 1.0 if pulses is None else float(pulses)
    except ValueError:
        count = math.nan
    if pulses is not None and tacho is None:
        problems.append("--pulses: stands without --tacho; allowed: with it")
    with problems.after("--speed-channel, --tacho, --pulses, --speed-table: "):
        return SpeedSource(channel, tacho, count, None if table is None else Path(table))
    return AS_IT_IS


def signal_problems(arguments: argparse.Namespace, read: list[str | Path], laws: int) -> list[str]:
    """List problems with all files that are written, those of --signals among them.

    Parameters
    ----------
    arguments : argparse.Namespace
        Arguments of the command.
    read : list of str or Path
        All files that are read.
    laws : int
        How many records --signals would hold.
    """
    outputs, problems = signal_outputs("--signals", getattr(arguments, "signals", None), laws)
    others = [
        Output("-o", arguments.output, RESULT),
        Output("--plot", arguments.plot, FIGURE),
        Output("--waterfall", getattr(arguments, "waterfall", None), FIGURE),
    ]
    sound = getattr(arguments, "sound", None)
    if sound is not None:
        others.append(Output("--sound", sound[0], SOUND))
        if len(sound) > 2:
            problems.append(f"--sound: got {len(sound)} values; allowed: a file, and a sensor")
        if laws > 1:
            problems.append(f"--sound: got {laws} laws; allowed: one, one law at a time")
    return problems + output_problems([*others, *outputs], read)


def measured_run(look: Look, model: Model, settings: CampbellSettings) -> RecordedRun:
    """The measured run, with windows as long as those of the simulated ones.

    Parameters
    ----------
    look : Look
        What is asked for, with a measured file.
    model : Model
        Model that is simulated.
    settings : CampbellSettings
        What is looked at.

    Raises
    ------
    InputError
        With what is wrong about the file, or does not fit.
    """
    assert look.measured is not None
    problems = Problems()
    sensors = chosen_sensors(model.scene, settings, look.sensors, problems)
    course = run_course(model.scene, settings.highest, problems)
    if problems or course is None:
        raise InputError(problems)
    orders = followed_orders(model, settings, course)
    window = rehearsed(settings, course, orders).campbell.window
    (record, *others) = read_time_data(look.measured).records
    if others:
        raise InputError(f"--measured: {look.measured} has {1 + len(others)} runs; allowed: one")
    with problems_after(f"--measured {look.measured}: "):
        turned = with_speed(record, look.source)
        channels = channels_beside(turned.record, sensors, look.channels)
        alike = dataclasses.replace(settings, window=window, orders=tuple(order for order, _ in orders))
        found = recorded_run_of(turned.record, channels, alike)
    return dataclasses.replace(found, notes=turned.notes)


def measured_lines(measured: RecordedRun, found: CampbellResult) -> list[str]:
    """Lines on a measured run, and on how far each simulated one is from it.

    Parameters
    ----------
    measured : RecordedRun
        The measured run.
    found : CampbellResult
        The simulated ones.
    """
    lines = _run_lines(f"measured: {measured.record.label}", measured)
    lines.append("sum level at the same speed, simulated less measured")
    for entry in found.runs:
        for sensor, one, other in zip(found.sensors, entry.spectra, measured.spectra, strict=True):
            pair = at_speeds_of(one, other)
            text = "no speed in common" if pair is None else difference_text(pair[1], pair[0])
            lines.append(f"  {entry.case.label}{f', {sensor.name}' if found.sensors[1:] else ''}: {text}")
    return lines


def recorded_runs(arguments: argparse.Namespace) -> tuple[str, int]:
    """Look at the runs of a file, without simulating anything.

    Parameters
    ----------
    arguments : argparse.Namespace
        Arguments of the command; `scene` is the file.
    """
    data, look = recorded_data(arguments, _OF_A_SCENE)
    settings = look.settings(data.look or CampbellSettings())
    found = recorded_campbell(data, settings, look.sensors, look.source)
    runs = found.runs
    speeds = runs[0].record.speed
    assert speeds is not None  # spectra were made with them
    names = ", ".join(f"{channel.name} ({_reference(channel).text})" for channel in runs[0].channels)
    lines = [
        f"{data.title or Path(arguments.scene).name}: recorded run from {RPM.text(float(speeds[0]))} to "
        f"{RPM.text(float(speeds[-1]))}; {'sensors' if runs[0].channels[1:] else 'sensor'} {names}",
        *resolution_lines(runs[0].spectra[0], settings.highest),
    ]
    for run in runs:
        lines += _run_lines(run.record.label, run)
    if runs[1:]:
        lines.append("sum level at the same speed")
    for run in runs[1:]:
        for channel, one, other in zip(run.channels, runs[0].spectra, run.spectra, strict=True):
            text = difference_text(one.campbell.sum_level, other.campbell.sum_level)
            at = f", {channel.name}" if run.channels[1:] else ""
            lines.append(f"  {run.record.label} beside {runs[0].record.label}{at}: {text}")
    lines += write(arguments, found.dataset, _figure(data, found) if arguments.plot else None)
    if arguments.waterfall:
        title = f"{data.title or runs[0].record.label}\nsensor {runs[0].channels[0].name}; recorded run"
        labels, spectra = [run.record.label for run in runs], [run.spectra[0] for run in runs]
        figure = waterfall_of(title, labels, spectra, _reference(runs[0].channels[0]), found.orders)
        lines += write_plot(figure, arguments.waterfall)
    if arguments.signals:
        lines += write_time_data(arguments.signals, dataclasses.replace(data, records=tuple(r.record for r in runs)))
    return "\n".join(lines), 0


def recorded_data(arguments: argparse.Namespace, of_a_scene: tuple[str, ...]) -> tuple[TimeData, Look]:
    """Read a file of recorded runs that stands in place of a scene; all problems of the options at once.

    Parameters
    ----------
    arguments : argparse.Namespace
        Arguments of the command.
    of_a_scene : tuple of str
        Options that say nothing of a recorded run.

    Raises
    ------
    InputError
        With every problem.
    """
    beside = f"stands beside {short(arguments.scene)}, a run that is recorded"
    problems = Problems(out_of_place(arguments, of_a_scene, f"{beside}; allowed: with a scene, which is simulated"))
    look = read_look(arguments, problems)
    problems += signal_problems(arguments, [arguments.scene, *look.files], 1)
    problems.check()
    data = read_time_data(arguments.scene)
    problems += signal_outputs("--signals", arguments.signals, len(data.records))[1]
    if arguments.plot:
        from mbs.output.campbell_plot import MOST_LAWS

        if len(data.records) > MOST_LAWS:
            problems.append(f"--plot: got {len(data.records)} runs in {arguments.scene}; allowed: up to {MOST_LAWS}")
    problems.check()
    return data, look


def _run_lines(label: str, run: RecordedRun) -> list[str]:
    """Lines of one recorded run."""
    lines = [label, *(f"  {note}" for note in run.notes)]
    if run.channels[1:]:
        pairs = zip(run.channels, run.spectra, strict=True)
        return lines + [sensor_line(channel.name, _reference(channel), found) for channel, found in pairs]
    return [*lines, f"  {highest_line(run.spectra[0])}", *peak_lines(run.spectra[0])]


def _figure(data: TimeData, found: RecordedResult) -> Figure:
    """The figure of recorded runs."""
    from mbs.output.campbell_plot import campbell_figure, sensors_figure

    labels = [run.record.label for run in found.runs]
    channels = found.runs[0].channels
    results: list[tuple[RunUpSpectra, ...]] = [run.spectra for run in found.runs]
    if channels[1:]:
        sensors = [(channel.name, _reference(channel)) for channel in channels]
        return sensors_figure(data.title, labels, results, sensors, found.orders)
    title = f"{data.title or labels[0]}\nsensor {channels[0].name}; recorded run"
    return campbell_figure(title, labels, [spectra[0] for spectra in results], _reference(channels[0]), found.orders)


def _reference(channel: TimeChannel) -> Reference:
    """Reference of a channel that has levels."""
    reference = channel.reference
    assert reference is not None  # channels are chosen by it
    return reference


def _orders(arguments: argparse.Namespace, problems: Problems) -> tuple[float, ...]:
    """Read --orders."""
    found = []
    for text in _list(arguments, "orders"):
        try:
            order = float(text)
        except ValueError:
            order = math.nan
        if not 0.0 < order <= _LARGEST_ORDER:
            problems.append(f"--orders: got {text!r:.40}; allowed: numbers above 0 up to {_LARGEST_ORDER:g}")
        found.append(order)
    if len(found) > _MOST_ORDERS:
        problems.append(f"--orders: got {len(found)}; allowed: up to {_MOST_ORDERS}")
    return () if problems else tuple(found)


def _list(arguments: argparse.Namespace, name: str) -> list[str]:
    """List the values given for an option that takes one or more."""
    value = getattr(arguments, name, None)
    return [] if value is None else [value] if isinstance(value, str) else list(value)


def _is_scene(arguments: argparse.Namespace) -> bool:
    """Tell whether the command is about a scene, which is simulated."""
    return not is_time_data(arguments.scene)
