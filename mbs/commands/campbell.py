"""`mbs campbell`: the nonlinear run-up with each contact law, as levels over speed, frequency and order."""

from __future__ import annotations

import argparse
import dataclasses
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from matplotlib.figure import Figure

from ehdmaps.arrays import BoolArray, FloatArray
from ehdmaps.errors import InputError
from ehdmaps.figures import typeset
from ehdmaps.units import RPM
from mbs.analyses.campbell import MODE_SPEEDS, MOST_BANDS, CampbellResult, LawRun, campbell, campbell_problems
from mbs.analyses.case import Case, clearance_text, common_supply, temperature_text
from mbs.analyses.film_errors import notable_from
from mbs.analyses.reach import axes_outside, fade_of
from mbs.analyses.tolerance import Tolerated, read_tolerance, within
from mbs.commands.auto import Looked, analysed
from mbs.commands.cases import load_cases
from mbs.commands.common import Told, band_lines, film_course, heading, held_lines, read_option, write
from mbs.commands.reach import fade_lines, outside_lines
from mbs.linearised.sweep_result import ComplexSweep, Sweep
from mbs.model.elements import Sensor
from mbs.output.campbell_plot import MOST_LAWS, Overlay, Reach, campbell_figure
from mbs.output.energy_text import drive_lines, energy_lines
from mbs.scene.assembly import Model
from mbs.scene.campbell import HIGHEST_HIGHEST, LONGEST, LOWEST_HIGHEST, SHORTEST
from mbs.scene.fields import HERTZ, MILLISECOND
from mbs.settings import CampbellSettings
from mbs.spectral.campbell import RunUpSpectra
from mbs.spectral.levels import Reference, difference_text
from mbs.spectral.orders import OrderPeak

_LEAST_SHARE = 0.05
"""Of the strain energy in bearings, of a mode that is drawn in."""

_MOST_DAMPED = 0.5
"""Damping ratio up to which a mode is drawn in: above, a response has no peak by it, or hardly one (1/sqrt 2)."""


def run(arguments: argparse.Namespace) -> tuple[str, int]:
    """Run up with each law, and compare."""
    done = analysed(arguments, _asked, lambda asked: _ran(asked, arguments.modes), _looks_at, own_tolerance=True)
    found, tolerated = done.result.run, done.result.tolerated
    settings, runs, course, bands = found.settings, found.runs, found.course, int(arguments.bands or "0")
    lines = [
        *done.lines,
        f"{runs[0].case.model.scene.title}: run-up from {RPM.text(course.speed.at(0.0)[0])} to "
        f"{RPM.text(course.speed.at(course.duration)[0])} in {course.duration:.4g} s; "
        f"sensor {found.sensor.name}, {Reference.of(found.sensor).text}",
        *_resolution(runs[0].spectra, settings),
        *(tolerated.lines if tolerated else ()),
    ]
    for entry in runs:
        lines += [*_report(entry), *_band(entry, bands)]
    lines += [*_differences(runs), *(f"warning: {line}" for line in found.failed)]
    dataset = found.dataset.assign_attrs(tolerance="\n".join(tolerated.lines)) if tolerated else found.dataset
    lines += write(arguments, dataset, _figure(found) if arguments.plot else None)
    outside = any(any(entry.record.outside.values()) for entry in runs)
    unsound = found.failed or outside or (tolerated is not None and not tolerated.met)
    return "\n".join(lines), 1 if unsound else done.status


class _Asked(NamedTuple):
    """Laws that are run, what is looked at, how many runs a band has, and the tolerance if there is one [dB]."""

    cases: list[Case]
    settings: CampbellSettings
    bands: int
    tolerance: float | None


class _Ran(NamedTuple):
    """The run-ups, and how their step, slices and cut-off were chosen."""

    run: CampbellResult
    tolerated: Tolerated | None


def _ran(asked: _Asked, with_modes: bool) -> _Ran:
    """Choose the numerical settings where a tolerance is given, and run up."""
    cases, tolerated = asked.cases, None
    if asked.tolerance is not None and cases[0].subject is not None:
        tolerated = within(cases[0].subject, asked.tolerance, asked.settings, Told("trial"))
        cases = [dataclasses.replace(cases[0], model=tolerated.subject.model(), subject=tolerated.subject)]
    found = campbell(cases, asked.settings, Told("step"), with_modes=with_modes, keep_partial=True, bands=asked.bands)
    return _Ran(found, tolerated)


def _looks_at(asked: _Asked) -> Looked:
    """The scene with the largest loads, and the highest frequency."""
    return Looked(max(asked.cases, key=lambda case: case.load_factor).model.scene, asked.settings.highest)


def _asked(arguments: argparse.Namespace) -> _Asked:
    """Laws, what is looked at, runs of a band, and the tolerance if there is one; all problems at once."""
    problems: list[str] = []
    text = arguments.bands or "0"
    bands = int(text) if text.isascii() and text.isdigit() and len(text) < 4 else -1
    if not 0 <= bands <= MOST_BANDS:
        problems.append(f"--bands: got {text!r:.40}; allowed: a whole number of runs, 0 to {MOST_BANDS}")
    tolerance = None
    # A part of a stiffness or damping is for --auto alone, which chooses physics by it.
    of_levels = not (getattr(arguments, "auto", False) and (arguments.tolerance or "").rstrip().endswith("%"))
    if arguments.tolerance is not None and of_levels:
        try:
            tolerance = read_tolerance(arguments.tolerance)
        except InputError as error:
            problems.append(f"--tolerance: {error.problems[0]}")
    highest = read_option("--highest", arguments.highest, "Hz", (LOWEST_HIGHEST, HIGHEST_HIGHEST), HERTZ, problems)
    window = read_option("--window", arguments.window, "s", (SHORTEST, LONGEST), MILLISECOND, problems)
    try:
        cases = load_cases(arguments)
    except InputError as error:
        raise InputError((*problems, *error.problems)) from error
    if len(cases) > MOST_LAWS:
        problems.append(
            f"--law, --map, --films, --supply, --clearance, --load-factor: got {len(cases)} combinations; allowed: up "
            f"to {MOST_LAWS} side by side"
        )
    if arguments.tolerance is not None and of_levels and len(cases) > 1:
        problems.append(
            f"--tolerance: got {len(cases)} combinations of laws, films and the like; allowed: one, for which step, "
            "slices and cut-off are chosen"
        )
    scene = cases[0].model.scene
    settings = dataclasses.replace(
        scene.campbell,
        sensor=arguments.sensor or scene.campbell.sensor,
        highest=scene.campbell.highest if highest is None else highest,
        window=scene.campbell.window if window is None else window,
    )
    problems += campbell_problems(scene, settings)
    if problems:
        raise InputError(tuple(dict.fromkeys(problems)))
    return _Asked(cases, settings, bands, tolerance)


def _figure(found: CampbellResult) -> Figure:
    """The figure, with modes and with what is not valid marked."""
    return campbell_figure(
        _title([entry.case.model for entry in found.runs], found.sensor),
        [entry.case.label for entry in found.runs],
        [entry.spectra for entry in found.runs],
        Reference.of(found.sensor),
        found.orders,
        [_overlay(entry) for entry in found.runs],
        [_reach(entry) for entry in found.runs],
        [entry.level_error for entry in found.runs],
    )


def _overlay(entry: LawRun) -> Overlay | None:
    """Natural frequencies to draw: of modes with strain energy in the bearings that are no mere decay."""
    if entry.modes is None:
        return None
    found = entry.modes.damped
    shown = (np.nan_to_num(found.bearing_share) >= _LEAST_SHARE).any(axis=0)
    swinging = found.damping_ratio <= _MOST_DAMPED
    return Overlay(entry.modes.speeds, np.where(swinging, found.frequency, np.nan)[:, shown])


def _reach(entry: LawRun) -> Reach:
    """Where the films of a law are not valid, over the speeds of the run."""
    speeds = entry.spectra.campbell.speeds
    at = np.linspace(float(speeds.min()), float(speeds.max()), MODE_SPEEDS)
    return Reach(at, notable_from(entry.case.model, at), float(speeds[_fading(entry)].max(initial=0.0)))


def _fading(entry: LawRun) -> BoolArray:
    """Which windows reach below the map, where the film fades to the dry contact, shape (windows,)."""
    found, record = entry.spectra.campbell, entry.record
    fade = fade_of(entry.case.model)
    if fade is None:
        return np.zeros(found.time.size, dtype=np.bool_)
    ends = [np.interp(found.time + part * found.window, record.time, np.abs(record.speed)) for part in (-0.5, 0.5)]
    return fade.below(np.minimum(*ends))


def _resolution(spectra: RunUpSpectra, settings: CampbellSettings) -> list[str]:
    """How finely speed and frequency are resolved."""
    found = spectra.campbell
    return [
        f"band {HERTZ.text(found.frequencies[0])} to {HERTZ.text(settings.highest)}; windows of "
        f"{MILLISECOND.text(found.window)}: lines are {found.line_width:.3g} Hz wide, the highest order sweeps by "
        f"{found.smear:.3g} Hz in one; order spectra over {spectra.spectra.window:.3g} turns"
        + (f", single orders over {spectra.tracks.window:.3g} turns" if spectra.tracks else "")
    ]


def _report(entry: LawRun) -> list[str]:
    """Lines of one law: cost, highest sum level, peaks along the orders."""
    found, record = entry.spectra.campbell, entry.record
    at = int(np.argmax(found.sum_level))
    lines = [
        f"{entry.case.label}: {entry.case.model.law}",
        *heading(entry.case.model)[1:],
        *held_lines(entry.case.model),
        f"  {record.steps} steps, {record.halved} taken back, {1e6 * entry.seconds / max(record.steps, 1):.3g} us a "
        f"step, {entry.seconds:.3g} s",
        f"  highest sum level {found.sum_level[at]:.1f} dB at {RPM.text(float(found.speeds[at]))}"
        f"{_elsewhere(entry, at)}",
        *(f"  note: {line}" for line in record.notes),
    ]
    if entry.spectra.peaks:
        lines.append("  peaks along the orders: order   speed/rpm   frequency/Hz   level/dB   above its valleys/dB")
        lines += [_peak(peak, entry.modes) for peak in entry.spectra.peaks]
    elif entry.spectra.tracks:
        lines.append("  no peak along the orders")
    lines += outside_lines(
        record.outside,
        "{} calls outside the map",
        axes_outside(entry.case.model, float(np.abs(record.speed).max())),
        entry.case.label,
    )
    lines += [f"  {line}" for line in (*drive_lines(record.drive), *energy_lines(record.energy))]
    ends = (float(found.speeds[0]), float(found.speeds[-1]))
    return [*lines, *fade_lines(entry.case.model, record.speed, "the run"), *film_course(entry.case.model, ends)]


def _band(entry: LawRun, runs: int) -> list[str]:
    """Lines on the band of the sum level, where runs for it were asked for."""
    if not runs:
        return []
    words = band_lines(entry.case.model)
    if entry.level_error is None:
        return words
    found = entry.spectra.campbell
    worst = int(np.argmax(entry.level_error))
    middle, at = float(np.median(entry.level_error)), RPM.text(float(found.speeds[worst]))
    highest = float(entry.level_error[int(np.argmax(found.sum_level))])
    return [
        f"  band of the sum level by {runs} runs with laws wrong by the errors of the map: +- {middle:.2g} dB in the "
        f"median of the windows, +- {highest:.2g} dB at the highest level, at most +- "
        f"{entry.level_error[worst]:.2g} dB, at {at}",
        *words,
    ]


def _differences(found: Sequence[LawRun]) -> list[str]:
    """Lines on the sum level of each law beside that of the first one with the same clearance and loads."""
    lines = []
    first: dict[tuple[str, float, float | None], LawRun] = {}
    for entry in found:
        beside = first.setdefault((repr(entry.case.clearance), entry.case.load_factor, entry.case.start_angle), entry)
        if beside is not entry:
            levels = (beside.spectra.campbell.sum_level, entry.spectra.campbell.sum_level)
            lines.append(f"  {entry.case.label} beside {beside.case.label}: {difference_text(*levels)}")
    return ["sum level at the same speed", *lines] if lines else []


def _elsewhere(entry: LawRun, at: int) -> str:
    """What is highest above the fade, where the window `at` of the highest sum level lies in it."""
    found, fading = entry.spectra.campbell, _fading(entry)
    if not fading[at]:
        return ""
    if fading.all():
        return ", as all windows with the film fading below the map"
    best = int(np.argmax(np.where(fading, -np.inf, found.sum_level)))
    return (
        f", where the film fades below the map; in windows that do not reach there {found.sum_level[best]:.1f} dB at "
        f"{RPM.text(float(found.speeds[best]))}"
    )


def _peak(peak: OrderPeak, modes: Sweep | None) -> str:
    """Line of a peak, with the nearest natural frequency of the linear system at its speed where they are known."""
    text = (
        f"  {peak.order:29.5g} {RPM.value(peak.speed):11.1f} {peak.frequency:14.5g} {peak.level:10.1f} "
        f"{peak.prominence:22.1f}"
    )
    if modes is None:
        return text
    near = _nearest(modes.damped, modes.speeds, peak)
    return text if near is None else f"{text}   nearest linear mode {near[0]:.5g} Hz, damping ratio {near[1]:.2g}"


def _nearest(found: ComplexSweep, speeds: FloatArray, peak: OrderPeak) -> tuple[float, float] | None:
    """Frequency and damping ratio of the mode nearest to a peak at its speed; None where none oscillates."""
    values = [np.interp(peak.speed, speeds, column) for column in (*found.frequency.T, *found.damping_ratio.T)]
    frequency, ratio = np.reshape(values, (2, -1))
    # A mode that begins or ends between two of the speeds has no number there.
    there = np.isfinite(frequency) & (ratio <= _MOST_DAMPED)
    if not there.any():
        return None
    best = int(np.argmin(np.where(there, np.abs(frequency - peak.frequency), np.inf)))
    return float(frequency[best]), float(ratio[best])


def _title(models: Sequence[Model], sensor: Sensor) -> str:
    """Heading of the figure."""
    model = models[0]
    clearance, supply = clearance_text(model), common_supply(models)
    parts = [temperature_text(model), f"clearance {clearance}" if clearance else "", supply]
    at = ", ".join(part for part in parts if part)
    return f"{model.scene.title}\nsensor {sensor.name}; {typeset(at)}"
