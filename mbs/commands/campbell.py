"""`mbs campbell`: the nonlinear run-up with each contact law, as levels over speed, frequency and order."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import InputError, Problems
from ehdmaps.units import RPM
from mbs.analyses.campbell import MOST_BANDS, MOST_DAMPED, CampbellResult, LawRun, campbell, campbell_problems, fading
from mbs.analyses.case import Case, Workers
from mbs.analyses.film_errors import film_course
from mbs.analyses.ramp import resolution, step_lines
from mbs.analyses.reach import axes_outside, fade_lines, outside_lines, sources_of
from mbs.analyses.recorded import RecordedRun, simulated_campbell
from mbs.analyses.soundness import Judged
from mbs.analyses.step_error import StepCheck
from mbs.commands.auto import analysed
from mbs.commands.campbell_recorded import measured_lines, measured_run, read_look, recorded_runs, signal_problems
from mbs.commands.cases import files_read, load_cases
from mbs.commands.common import Looked, Told, chosen_workers, write, write_plot
from mbs.linearised.sweep_result import ComplexSweep, Sweep
from mbs.model.elements import Sensor
from mbs.output.campbell_table import (
    PEAKS,
    highest_line,
    peak_line,
    peak_lines,
    resolution_lines,
    sensor_line,
    with_measured,
)
from mbs.output.model_text import band_lines, heading, held_lines
from mbs.output.result_text import drive_lines, energy_lines
from mbs.output.time_files import is_time_data, write_time_data
from mbs.planning.question import in_time
from mbs.planning.tolerance import Tolerated, asked_tolerance, several_problems, tolerated_run
from mbs.settings import CampbellSettings
from mbs.spectral.levels import Reference, difference_text
from mbs.spectral.orders import OrderPeak


def run(arguments: argparse.Namespace) -> tuple[str, int]:
    """Run up with each law, and compare; or look at runs that are recorded."""
    if is_time_data(arguments.scene):
        return recorded_runs(arguments)
    with chosen_workers(arguments) as workers:
        done = analysed(arguments, _asked, lambda asked: _ran(asked, arguments.modes, workers), _looks_at)
    found, tolerated, beside = done.result.run, done.result.tolerated, done.result.measured
    settings, runs, course, bands = found.settings, found.runs, found.course, int(arguments.bands or "0")
    judged = Judged([(entry.case.label, entry.findings) for entry in runs])
    lines = [
        *judged.first,
        *done.lines,
        f"{runs[0].case.model.scene.title}: run-up from {RPM.text(course.speed.at(0.0)[0])} to "
        f"{RPM.text(course.speed.at(course.duration)[0])} in {course.duration:.4g} s; {_sensor_words(found.sensors)}",
        *resolution_lines(runs[0].spectra[0], settings.highest),
        *(tolerated.lines if tolerated else ()),
        *step_lines(resolution(runs[0].case.model, course)),
    ]
    for entry in runs:
        lines += [*_report(entry, found.sensors), *_band(entry, bands, found.sensors)]
    lines += measured_lines(beside, found) if beside else []
    lines += [*_differences(runs, found.sensors), *judged.last, *(f"warning: {line}" for line in found.failed)]
    dataset = found.dataset.assign_attrs(tolerance="\n".join(tolerated.lines)) if tolerated else found.dataset
    dataset = with_measured(dataset, beside.dataset) if beside else dataset
    measured = None if beside is None else (beside.record.label, beside.spectra)
    lines += write(arguments, dataset, found.plot(measured) if arguments.plot else None)
    if arguments.waterfall:
        lines += write_plot(found.waterfall(), arguments.waterfall)
    if getattr(arguments, "signals", None):
        lines += write_time_data(arguments.signals, simulated_campbell(runs))
    outside = any(any(entry.record.outside.values()) for entry in runs)
    missed = judged.status or found.failed or outside or (tolerated is not None and not tolerated.met)
    return "\n".join(lines), 1 if missed else 0


class _Asked(NamedTuple):
    """Laws that are run, what is looked at, runs of a band, the tolerance if there is one [dB], a measured run."""

    cases: list[Case]
    settings: CampbellSettings
    sensors: list[str]
    bands: int
    tolerance: float | None
    measured: RecordedRun | None


class _Ran(NamedTuple):
    """The run-ups, how their step, slices and cut-off were chosen, and a measured run beside them."""

    run: CampbellResult
    tolerated: Tolerated | None
    measured: RecordedRun | None


def _ran(asked: _Asked, with_modes: bool, workers: Workers) -> _Ran:
    """Run up, with step and slices that are chosen where a tolerance is given."""

    def run(cases: list[Case]) -> tuple[CampbellResult, StepCheck | None]:
        found = campbell(
            cases,
            asked.settings,
            Told("step"),
            sensors=asked.sensors,
            with_modes=with_modes,
            keep_partial=True,
            bands=asked.bands,
            workers=workers,
        )
        return found, found.runs[0].steps

    return _Ran(*tolerated_run(asked.cases, asked.tolerance, run, asked.settings, Told("trial")), asked.measured)


def _looks_at(asked: _Asked) -> Looked:
    """The scene with the largest loads, and the highest frequency."""
    scene = max(asked.cases, key=lambda case: case.load_factor).model.scene
    return Looked(in_time(scene), asked.settings.highest)


def _asked(arguments: argparse.Namespace) -> _Asked:
    """Laws, what is looked at, runs of a band, and the tolerance if there is one; all problems at once."""
    problems = Problems()
    text = arguments.bands or "0"
    bands = int(text) if text.isascii() and text.isdigit() and len(text) < 4 else -1
    if not 0 <= bands <= MOST_BANDS:
        problems.append(f"--bands: got {text!r:.40}; allowed: a whole number of runs, 0 to {MOST_BANDS}")
    tolerance = asked_tolerance(arguments, problems)
    from mbs.output.campbell_plot import MOST_LAWS

    looked = read_look(arguments, problems)
    cases: list[Case] = []
    with problems:
        cases = load_cases(
            arguments,
            needs=lambda scene: campbell_problems(scene, looked.settings(scene.campbell), looked.sensors),
            most=MOST_LAWS,
        )
    if not cases:
        raise InputError(problems)
    problems += several_problems(tolerance, cases)
    scene = cases[0].model.scene
    settings = looked.settings(scene.campbell)
    problems += signal_problems(arguments, [*files_read(arguments, scene), *looked.files], len(cases))
    measured = None
    if looked.measured and not problems:
        if len(cases) >= MOST_LAWS:
            problems.append(f"--measured: got {len(cases)} laws beside it; allowed: up to {MOST_LAWS - 1}")
        else:
            measured = measured_run(looked, cases[0].model, settings)
    problems.check()
    return _Asked(cases, settings, looked.sensors, bands, tolerance, measured)


def _report(entry: LawRun, sensors: Sequence[Sensor]) -> list[str]:
    """Lines of one law: cost, highest sum level, peaks along the orders."""
    found, record = entry.spectra[0].campbell, entry.record
    lines = [
        f"{entry.case.label}: {entry.case.model.law}",
        *heading(entry.case.model)[1:],
        *held_lines(entry.case.model),
        f"  {record.steps} steps, {record.halved} taken back, {1e6 * entry.seconds / max(record.steps, 1):.3g} us of "
        f"processor time a step, {entry.seconds:.3g} s in all",
        *(
            f"{sensor_line(sensor.name, Reference.of(sensor), spectra)}{_elsewhere(entry, place)}"
            if sensors[1:]
            else f"  {highest_line(spectra)}{_elsewhere(entry, place)}"
            for place, (sensor, spectra) in enumerate(zip(sensors, entry.spectra, strict=True))
        ),
        *(f"  note: {line}" for line in record.notes),
        *(f"  {line}" for line in (entry.steps.lines if entry.steps else ())),
    ]
    if not sensors[1:] and entry.modes is not None and entry.spectra[0].peaks:
        lines += [PEAKS, *(_peak(peak, entry.modes) for peak in entry.spectra[0].peaks)]
    elif not sensors[1:]:
        lines += peak_lines(entry.spectra[0])
    lines += outside_lines(
        record.outside,
        "{} calls outside the map",
        axes_outside(entry.case.model, float(np.abs(record.speed).max())),
        entry.case.label,
        sources_of(entry.case.model),
    )
    lines += [f"  {line}" for line in (*drive_lines(record.drive), *energy_lines(record.energy))]
    ends = (float(found.speeds[0]), float(found.speeds[-1]))
    return [*lines, *fade_lines(entry.case.model, record.speed, "the run"), *film_course(entry.case.model, ends)]


def _band(entry: LawRun, runs: int, sensors: Sequence[Sensor]) -> list[str]:
    """Lines on the band of the sum level, where runs for it were asked for."""
    if not runs:
        return []
    if entry.level_error is None and entry.case.model.scene.located:
        return ["  no band of the sum level: runs with wrong laws are those of machines on cylindrical rollers alone"]
    words = band_lines(entry.case.model)
    for place, wrong in enumerate(entry.level_error or ()):
        found = entry.spectra[place].campbell
        worst = int(np.argmax(wrong))
        middle, at = float(np.median(wrong)), RPM.text(float(found.speeds[worst]))
        highest = float(wrong[int(np.argmax(found.sum_level))])
        of = f" of {sensors[place].name}" if sensors[1:] else ""
        words.insert(
            place,
            f"  band of the sum level{of} by {runs} runs with laws wrong by the errors of the map: +- {middle:.2g} dB "
            f"in the median of the windows, +- {highest:.2g} dB at the highest level, at most +- {wrong[worst]:.2g} "
            f"dB, at {at}",
        )
    return words


def _differences(found: Sequence[LawRun], sensors: Sequence[Sensor]) -> list[str]:
    """Lines on the sum levels of each law beside that of the first one with the same clearance and loads."""
    lines = []
    first: dict[tuple[str, float, float | None], LawRun] = {}
    for entry in found:
        beside = first.setdefault((repr(entry.case.clearance), entry.case.load_factor, entry.case.start_angle), entry)
        if beside is not entry:
            for sensor, one, other in zip(sensors, beside.spectra, entry.spectra, strict=True):
                at = f", {sensor.name}" if sensors[1:] else ""
                text = difference_text(one.campbell.sum_level, other.campbell.sum_level)
                lines.append(f"  {entry.case.label} beside {beside.case.label}{at}: {text}")
    return ["sum level at the same speed", *lines] if lines else []


def _elsewhere(entry: LawRun, place: int = 0) -> str:
    """Highest level above the fade, where the window of the highest sum level of a sensor lies in it."""
    found, faded = entry.spectra[place].campbell, fading(entry)
    at = int(np.argmax(found.sum_level))
    if not faded[at]:
        return ""
    if faded.all():
        return ", as all windows with the film fading below the map"
    best = int(np.argmax(np.where(faded, -np.inf, found.sum_level)))
    return (
        f", where the film fades below the map; in windows that do not reach there {found.sum_level[best]:.1f} dB at "
        f"{RPM.text(float(found.speeds[best]))}"
    )


def _peak(peak: OrderPeak, modes: Sweep) -> str:
    """Line of a peak, with the nearest natural frequency of the linear system at its speed."""
    text = peak_line(peak)
    near = _nearest(modes.damped, modes.speeds, peak)
    return text if near is None else f"{text}   nearest linear mode {near[0]:.5g} Hz, damping ratio {near[1]:.2g}"


def _nearest(found: ComplexSweep, speeds: FloatArray, peak: OrderPeak) -> tuple[float, float] | None:
    """Frequency and damping ratio of the mode nearest to a peak at its speed; None where none oscillates."""
    values = [np.interp(peak.speed, speeds, column) for column in (*found.frequency.T, *found.damping_ratio.T)]
    frequency, ratio = np.reshape(values, (2, -1))
    # A mode that begins or ends between two of the speeds has no number there.
    there = np.isfinite(frequency) & (ratio <= MOST_DAMPED)
    if not there.any():
        return None
    best = int(np.argmin(np.where(there, np.abs(frequency - peak.frequency), np.inf)))
    return float(frequency[best]), float(ratio[best])


def _sensor_words(sensors: Sequence[Sensor]) -> str:
    """Names of the sensors, with the reference of one alone."""
    if sensors[1:]:
        return f"sensors {', '.join(sensor.name for sensor in sensors)}"
    return f"sensor {sensors[0].name}, {Reference.of(sensors[0]).text}"
