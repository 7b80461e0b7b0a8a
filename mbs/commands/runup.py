"""`mbs runup`: integrate the nonlinear system in time over its speed profile, from its equilibrium, with each law."""

from __future__ import annotations

import argparse
import dataclasses
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.choices import read_option
from ehdmaps.errors import InputError, Problems
from ehdmaps.figures import COLOURS
from ehdmaps.units import RPM, closest
from mbs.analyses.case import Case, Workers
from mbs.analyses.film_errors import film_course
from mbs.analyses.ramp import resolution, silent_run, step_lines
from mbs.analyses.reach import POINTS, Fade, axes_outside, fade_lines, fade_of, outside_lines, source_of, sources_of
from mbs.analyses.recorded import amplitudes_at, simulated
from mbs.analyses.runup import RunUpResult, RunUps, runup_figure, runup_problems, runups
from mbs.analyses.soundness import Judged
from mbs.analyses.step_error import StepCheck
from mbs.commands.auto import analysed
from mbs.commands.campbell_recorded import OF_A_SPEED, read_source, signal_problems
from mbs.commands.cases import files_read, load_cases
from mbs.commands.common import Looked, Told, chosen_workers, out_of_place, read_band, write
from mbs.output.files import described
from mbs.output.model_text import heading, held_lines
from mbs.output.result_text import drive_lines, energy_lines, signal_lines
from mbs.output.results import with_spectra
from mbs.output.time_files import is_time_data, read_time_data, write_time_data
from mbs.planning.question import in_time
from mbs.planning.tolerance import Tolerated, asked_tolerance, several_problems, tolerated_run
from mbs.scene.scene import Scene
from mbs.settings import HIGHEST
from mbs.spectral.spectra import AmplitudeSpectrum
from mbs.timedata.netcdf_file import signal_variables
from mbs.timedata.records import TimeChannel, TimeData, TimeRecord
from mbs.timedata.speed import SpeedSource, with_speed
from mbs.timedata.wav_file import sound_channel, write_sound

_MOST_SPECTRA = 4
_LARGEST_SPEED = 1e6 / RPM.factor
_OF_A_SCENE = (
    "law", "map", "structural_law", "films", "supply", "clearance", "auto", "physics", "tolerance",
)  # fmt: skip


@dataclass(frozen=True, eq=False)
class _Spectra:
    """About which speeds spectra are wanted [rad/s], and with which window [s] and highest frequency [Hz]."""

    speeds: tuple[float, ...]
    window: float | None
    highest: float | None


@dataclass(frozen=True, eq=False)
class _Asked:
    """Laws that are run, which spectra are wanted, and the tolerance of levels if there is one [dB]."""

    cases: list[Case]
    spectra: _Spectra
    tolerance: float | None = None


def run(arguments: argparse.Namespace) -> tuple[str, int]:
    """Run with each law, and say what was found; or look at a recorded run."""
    if is_time_data(arguments.scene):
        return _recorded(arguments)
    with chosen_workers(arguments) as workers:
        done = analysed(
            arguments,
            _asked,
            # The file has the motion of all coordinates, which is many times what all else takes.
            lambda asked: _ran(asked, workers, states=bool(arguments.output)),
            lambda asked: _looks_at(asked.cases[0].model.scene),
        )
    found, asked, tolerated = done.result
    names = tuple(label if found.runs[1:] else entry.model.label for label, entry in _pairs(found))
    data = _signals(found, names)
    spectra = _spectra_of(data, asked.spectra, found.runs[0].model.scene) if data else []
    figure = runup_figure(found.runs, data.records if data else (), spectra) if arguments.plot else None
    judged = Judged([(label, entry.findings) for label, entry in _pairs(found)])
    lines = [*judged.first, *done.lines, *(tolerated.lines if tolerated else ())]
    outside = bool(judged.status) or (tolerated is not None and not tolerated.met)
    for label, entry in _pairs(found):
        lines += [*([label] if found.runs[1:] else []), *_report(entry)]
        outside = outside or any(entry.record.outside.values())
    lines += signal_lines(data.records) if data else []
    lines += [*judged.last, *(f"warning: {line}" for line in found.failed)]
    dataset = judged.marked(with_spectra(found.dataset, spectra, _sensors(data)))
    dataset = dataset.assign_attrs(tolerance="\n".join(tolerated.lines)) if tolerated else dataset
    lines += write(arguments, dataset, figure)
    if getattr(arguments, "signals", None) and data:
        lines += write_time_data(arguments.signals, data)
    lines += _sound(arguments, data) if data else []
    return "\n".join(lines), 1 if outside or found.failed else 0


def _ran(asked: _Asked, workers: Workers, *, states: bool) -> tuple[RunUps, _Asked, Tolerated | None]:
    """Run, with step and slices that are chosen where a tolerance is given."""

    def run(cases: list[Case]) -> tuple[RunUps, StepCheck | None]:
        found = runups(cases, Told("step"), keep_partial=True, workers=workers, states=states)
        return found, found.runs[0].steps

    found, tolerated = tolerated_run(asked.cases, asked.tolerance, run, progress=Told("trial"))
    return found, asked, tolerated


def _asked(arguments: argparse.Namespace) -> _Asked:
    """Laws, spectra and tolerance; all problems at once, before anything runs."""
    problems = Problems()
    tolerance = asked_tolerance(arguments, problems)
    wanted = _read_spectra(arguments, problems)
    problems += out_of_place(
        arguments, OF_A_SPEED, "stands beside a scene, whose speed is known; allowed: with a recorded run"
    )
    cases: list[Case] = []
    with problems:
        cases = load_cases(arguments, needs=runup_problems, most=len(COLOURS))
    if not cases:
        raise InputError(problems)
    scene = cases[0].model.scene
    problems += several_problems(tolerance, cases)
    problems += signal_problems(arguments, files_read(arguments, scene), len(cases))
    sound = getattr(arguments, "sound", None)
    if (getattr(arguments, "signals", None) or sound or wanted.speeds) and not scene.sensors:
        problems.append(
            f"{scene.name}: got no [[sensors]]; allowed with --signals, --sound and --spectrum-at: at least one"
        )
    names = tuple(sensor.name for sensor in scene.sensors)
    if sound and names and sound[1:] and sound[1].lower() not in map(str.lower, names):
        problems.append(
            f"--sound: {sound[1]!r:.60} is not there{closest(sound[1], names)}; allowed: {', '.join(names)}"
        )
    if scene.run_up is not None and wanted.speeds and not problems:
        course = scene.run_up
        fine = dataclasses.replace(course, settings=dataclasses.replace(course.settings, sample=course.settings.step))
        silent = silent_run(fine)
        channel = TimeChannel("silent", "acceleration", "m/s2")
        record = TimeRecord("run", silent.time, (channel,), silent.signal[:, None], silent.speed, silent.angle)
        with problems.after("--spectrum-at: "):
            amplitudes_at(record, wanted.speeds, wanted.window, wanted.highest or scene.campbell.highest)
    problems.check()
    return _Asked(cases, wanted, tolerance)


def _read_spectra(arguments: argparse.Namespace, problems: Problems) -> _Spectra:
    """Read which spectra are wanted."""
    given = getattr(arguments, "spectrum_at", None) or []
    limits = (0.0, _LARGEST_SPEED)
    speeds = [read_option("--spectrum-at", text, "rad/s", limits, RPM, problems) for text in given]
    if len(given) > _MOST_SPECTRA:
        problems.append(f"--spectrum-at: got {len(given)} speeds; allowed: up to {_MOST_SPECTRA}")
    if not given:
        problems += out_of_place(arguments, ("window", "highest"), "stands without --spectrum-at; allowed: with it")
    band = read_band(arguments, problems)
    return _Spectra(tuple(speed for speed in speeds if speed is not None), band.get("window"), band.get("highest"))


def _recorded(arguments: argparse.Namespace) -> tuple[str, int]:
    """Look at the runs of a file, without simulating anything."""
    words = "stands beside a run that is recorded; allowed: with a scene, which is simulated"
    problems = Problems(out_of_place(arguments, _OF_A_SCENE, words))
    wanted, source = _read_spectra(arguments, problems), read_source(arguments, problems)
    read = [arguments.scene, *([source.table] if source.table else [])]
    problems += signal_problems(arguments, read, 1)
    problems.check()
    data = read_time_data(arguments.scene)
    problems += signal_problems(arguments, read, len(data.records))
    problems.check()
    # Signals alone can be looked at, and written, without a speed.
    speedless = data.records[0].speed is None and not wanted.speeds and source == SpeedSource()
    turned = [] if speedless else [with_speed(record, source) for record in data.records]
    notes = turned[0].notes if turned else ()
    data = dataclasses.replace(data, records=tuple(entry.record for entry in turned) or data.records)
    if not data.records[0].sensors:
        names = ", ".join(data.records[0].names)
        raise InputError(f"{arguments.scene}: has no channel of a motion among {names}; allowed: at least one")
    spectra = _spectra_of(data, wanted, None)
    first = data.records[0]
    lines = [
        f"{data.title or Path(arguments.scene).name}: recorded run of {first.time[-1] - first.time[0]:.4g} s, "
        f"{first.time.size} samples",
        *(f"  {note}" for note in notes),
        *signal_lines(data.records),
    ]
    attributes = {key: words for key, words in (data.attributes or {}).items() if not key.endswith("version")}
    dataset = described(signal_variables(data), **attributes)
    figure = None
    if arguments.plot:
        from mbs.output.run_plot import signals_figure

        figure = signals_figure(data, spectra)
    lines += write(arguments, with_spectra(dataset, spectra, _sensors(data)), figure)
    if arguments.signals:
        lines += write_time_data(arguments.signals, data)
    return "\n".join([*lines, *_sound(arguments, data)]), 0


def _sound(arguments: argparse.Namespace, data: TimeData) -> list[str]:
    """Write the sound of a sensor where it is asked for."""
    given = getattr(arguments, "sound", None)
    if given is None:
        return []
    record = data.records[0]
    return write_sound(Path(given[0]), record, sound_channel(record, (*given[1:], None)[0], "--sound"))


def _spectra_of(data: TimeData, wanted: _Spectra, scene: Scene | None) -> list[list[tuple[AmplitudeSpectrum, ...]]]:
    """Spectra about each speed, of each run, of each sensor."""
    highest = wanted.highest or (scene.campbell.highest if scene else HIGHEST)
    each = [amplitudes_at(record, wanted.speeds, wanted.window, highest) for record in data.records]
    return [[run[place] for run in each] for place in range(len(wanted.speeds))]


def _sensors(data: TimeData | None) -> list[str]:
    """Names of the sensors of runs."""
    return [channel.name for channel in data.records[0].sensors] if data else []


def _pairs(found: RunUps) -> list[tuple[str, RunUpResult]]:
    """Labels and runs."""
    return list(zip(found.labels, found.runs, strict=True))


def _signals(found: RunUps, names: tuple[str, ...]) -> TimeData | None:
    """Signals of all runs; None of a scene without sensors."""
    if not found.runs[0].model.scene.sensors:
        return None
    return simulated([(name, entry.model, entry.record) for name, entry in zip(names, found.runs, strict=True)])


def _report(found: RunUpResult) -> list[str]:
    """Lines of one law."""
    model, result, outside = found.model, found.record, found.record.outside
    fade = fade_of(model)
    first, last = (RPM.text(float(speed)) for speed in (result.speed[0], result.speed[-1]))
    lines = [
        *heading(model),
        *held_lines(model),
        f"from {first} to {last} in {found.course.duration:.4g} s: {result.steps} steps, {result.halved} taken back, "
        f"{result.iterations / max(result.steps, 1):.3g} Newton iterations a step, "
        f"{1e6 * found.seconds / max(result.steps, 1):.0f} us of processor time a step",
        *step_lines(resolution(model, found.course)),
        *(found.steps.lines if found.steps else ()),
        *(f"note: {line}" for line in result.notes),
    ]
    end = POINTS if source_of(model) == POINTS else "the map"
    for bearing, force in zip(model.bearings, result.forces, strict=False):
        size = np.hypot(force[:, 1], force[:, 2])
        lines.append(
            f"{bearing.name}: {size[0]:.5g} N at the beginning, {size.min():.5g} to {size.max():.5g} N, "
            f"{size[-1]:.5g} N at the end; largest change from sample to sample {_changes(size, result.speed, fade)}; "
            f"{outside[bearing.name]} calls outside {end}"
        )
    names = [entry.element.name for entry in model.system.elements]
    others = [entry.name for entry in model.located]
    lines += [_located_line(name, result.forces[names.index(name)]) for name in others]
    lines += drive_lines(result.drive) + energy_lines(result.energy)
    lines += fade_lines(model, result.speed, "the run")
    fastest = float(np.abs(result.speed).max())
    lines += outside_lines(outside, "{} calls outside the map", axes_outside(model, fastest), sources=sources_of(model))
    # The equilibria of this line are no part of the run, whose calls were counted above.
    return lines + film_course(model, (float(result.speed[0]), float(result.speed[-1])))


def _located_line(name: str, force: FloatArray) -> str:
    """Line on the forces (samples, 6) of a bearing that carries axial load on its inner ring."""
    along, across = force[:, 0], np.hypot(force[:, 1], force[:, 2])
    return (
        f"{name}: {along[0]:.5g} N along x at the beginning, {along.min():.5g} to {along.max():.5g} N, "
        f"{along[-1]:.5g} N at the end; {across.min():.5g} to {across.max():.5g} N across it"
    )


def _looks_at(scene: Scene) -> Looked:
    """Scope of the run; frequencies up to those of a Campbell diagram."""
    return Looked(in_time(scene), scene.campbell.highest)


def _changes(size: FloatArray, speed: FloatArray, fade: Fade | None) -> str:
    """Largest change of a force from sample to sample, inside and outside the fade below the map."""
    change = np.abs(np.diff(size))
    slow = np.zeros(speed.size, dtype=np.bool_) if fade is None else fade.below(speed)
    inside = slow[1:] | slow[:-1]
    if fade is None or not inside.any():
        return f"{change.max(initial=0.0):.3g} N"
    words = f"{change[inside].max():.3g} N below {RPM.text(fade.speed)}, where the film fades"
    if inside.all():
        return words
    worst = int(np.argmax(np.where(inside, -1.0, change)))
    return f"{words}, and {change[worst]:.3g} N above, at {RPM.text(float(abs(speed[worst])))}"
