"""`mbs campbell`: the nonlinear run-up with each contact law, as levels over speed, frequency and order."""

from __future__ import annotations

import argparse
import dataclasses
import math
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from ehdmaps.errors import InputError
from ehdmaps.jobs.progress import progress
from ehdmaps.units import TEMPERATURE, closest
from mbs.assembly import Model
from mbs.commands.cases import Case, load_cases
from mbs.commands.common import film_course, heading, lowest_limits, read_option, write
from mbs.commands.reach import axes_outside, fade_lines, fade_of, outside_lines
from mbs.elements import Operation, Sensor
from mbs.equilibrium import equilibrium
from mbs.errors import AnalysisError
from mbs.linearised.sweep import sweep
from mbs.linearised.sweep_result import Sweep
from mbs.output.campbell_data import campbell_dataset
from mbs.output.campbell_plot import MOST_LAWS, Overlay, Reach, campbell_figure
from mbs.reading.campbell import HIGHEST_HIGHEST, LONGEST, LOWEST_HIGHEST, SHORTEST
from mbs.reading.fields import HERTZ, MICROMETRE, MILLISECOND, RPM
from mbs.scene import RunUp, Scene
from mbs.spectral.campbell import RunUpSpectra, run_up_spectra
from mbs.spectral.levels import Reference, difference_text
from mbs.spectral.orders import OrderPeak
from mbs.spectral.run_signal import RunSignal
from mbs.spectral.settings import CampbellSettings
from mbs.spectral.spectra import LEAST_OVERSAMPLING
from mbs.transient.run import Recording
from mbs.transient.run import run as run_system

LEAST_SAMPLES, MOST_SAMPLES = 64, 5_000_000
"""Steps of a run: the fewest that have a spectrum, and 50 s of 10 us, beyond any run-up that is waited for."""

_MESH_HARMONICS = 5
_PASS_HARMONICS = 3
_MODE_SPEEDS = 9
_LEAST_SHARE = 0.05
"""Of the strain energy in bearings, of a mode that is drawn in."""


@dataclass(frozen=True, eq=False)
class _Found:
    """What one contact law led to."""

    case: Case
    record: Recording
    spectra: RunUpSpectra
    modes: Sweep | None
    seconds: float


def run(arguments: argparse.Namespace) -> tuple[str, int]:
    """Run up with each law, and compare."""
    cases, settings, sensor, course = _asked(arguments)
    scene = cases[0].model.scene
    reference = Reference.of(sensor)
    orders = _orders(cases[0].model, settings, course)
    _rehearse(settings, course, orders)
    bar = progress(len(cases) * round(course.duration / course.settings.sample), "step")
    bar.begin()
    found, failed = [], []
    for case in cases:
        try:
            found.append(_one(case, settings, sensor, course, orders, bar.solved, arguments.modes))
        except AnalysisError as error:
            # The run-ups with the other laws are worth minutes; keep them.
            failed.append(f"warning: {case.label}: {error}")
        except KeyboardInterrupt:
            if not found:
                raise
            failed += [f"warning: {left.label}: stopped, no result" for left in cases[len(found) + len(failed) :]]
            break
    if not found:
        raise AnalysisError("\n".join(failed))
    lines = [
        f"{scene.title}: run-up from {RPM.text(course.speed.at(0.0)[0])} to "
        f"{RPM.text(course.speed.at(course.duration)[0])} in {course.duration:.4g} s; "
        f"sensor {sensor.name}, {reference.text}",
        *_resolution(found[0].spectra, settings),
    ]
    for entry in found:
        lines += _report(entry)
    lines += [*_differences(found), *failed]
    names = [entry.case.label for entry in found]
    spectra = [entry.spectra for entry in found]
    dataset = campbell_dataset(names, spectra, reference, sensor.name)
    figure = None
    if arguments.plot:
        title = _title(found[0].case.model, sensor)
        figure = campbell_figure(
            title,
            names,
            spectra,
            reference,
            orders,
            [_overlay(entry) for entry in found],
            [_reach(entry) for entry in found],
        )
    # The file says of each law what it is.
    several = dataclasses.replace(
        found[0].case.model, law="; ".join(f"{entry.case.label}: {entry.case.model.law}" for entry in found)
    )
    lines += write(arguments, several, dataset, figure)
    return "\n".join(lines), 1 if failed or any(any(entry.record.outside.values()) for entry in found) else 0


def _asked(arguments: argparse.Namespace) -> tuple[list[Case], CampbellSettings, Sensor, RunUp]:
    """Laws, what is looked at, and the run with a sample a step; all problems at once."""
    problems: list[str] = []
    highest = read_option("--highest", arguments.highest, "Hz", (LOWEST_HIGHEST, HIGHEST_HIGHEST), HERTZ, problems)
    window = read_option("--window", arguments.window, "s", (SHORTEST, LONGEST), MILLISECOND, problems)
    try:
        cases = load_cases(arguments)
    except InputError as error:
        raise InputError((*problems, *error.problems)) from error
    if len(cases) > MOST_LAWS:
        problems.append(
            f"--law, --map, --clearance, --load-factor: got {len(cases)} combinations; allowed: up to {MOST_LAWS} "
            "side by side"
        )
    scene = cases[0].model.scene
    settings = dataclasses.replace(
        scene.campbell,
        highest=scene.campbell.highest if highest is None else highest,
        window=scene.campbell.window if window is None else window,
    )
    sensor = _sensor(arguments.sensor or settings.sensor, scene, problems)
    course = _course(scene, settings.highest, problems)
    if problems or sensor is None or course is None:
        raise InputError(tuple(dict.fromkeys(problems)))
    return cases, settings, sensor, course


def _course(scene: Scene, highest: float, problems: list[str]) -> RunUp | None:
    """The run of the scene with a sample a step, so that nothing above the band is folded into it."""
    course = scene.run_up
    if course is None:
        problems.append(f"{scene.name}: [runup] missing; a run-up needs from, to, duration and step")
        return None
    longest = 1.0 / (LEAST_OVERSAMPLING * highest)
    if course.settings.step > longest * (1.0 + 1e-6):
        problems.append(
            f"{scene.name}: [runup] step: got {1e6 * course.settings.step:.4g} us; allowed: up to "
            f"{1e6 * longest:.4g} us for frequencies up to {HERTZ.text(highest)}; take smaller steps, or a "
            "lower --highest"
        )
    samples = course.duration / course.settings.step
    if not LEAST_SAMPLES <= samples <= MOST_SAMPLES:
        problems.append(
            f"{scene.name}: [runup] duration: got {course.duration:.4g} s, which is {samples:.4g} steps; allowed: "
            f"{LEAST_SAMPLES} to {MOST_SAMPLES}"
        )
        return None
    every_step = dataclasses.replace(course.settings, sample=course.settings.step)
    return dataclasses.replace(course, settings=every_step)


def _sensor(name: str | None, scene: Scene, problems: list[str]) -> Sensor | None:
    """The sensor of a name, or the first one of an acceleration."""
    names = tuple(sensor.name for sensor in scene.sensors)
    if name is not None:
        for sensor in scene.sensors:
            if sensor.name == name:
                return sensor
        problems.append(
            f"{scene.name}: sensor {name!r:.60} is not there{closest(name, names)}; allowed: "
            f"{', '.join(names) or 'none'}"
        )
        return None
    for sensor in scene.sensors:
        if sensor.quantity == "acceleration":
            return sensor
    problems.append(
        f"{scene.name}: has no sensor of an acceleration; allowed: one of {', '.join(names) or 'none'} with --sensor, "
        "or a [[sensors]] more"
    )
    return None


def _orders(model: Model, settings: CampbellSettings, course: RunUp) -> list[tuple[float, str]]:
    """Orders to follow, with their names: those of the settings, else of the gears, else of passing rollers."""
    if settings.orders:
        return [(order, f"{order:g}") for order in settings.orders]
    scene = model.scene
    spins = {body.name: abs(body.spin) for body in scene.bodies}
    mesh = [spins.get(pair.on.partition(":")[0], 0.0) * pair.teeth[0] for pair in scene.gears]
    passing = [
        entry.bearing.geometry.rollers * abs(entry.bearing.cage_angle(entry.inner_spin, entry.outer_spin))
        for entry in model.bearings
    ]
    count = _MESH_HARMONICS if any(mesh) else _PASS_HARMONICS
    # Rounded, for bearings that differ in the last bit only.
    bases = sorted({round(order, 9) for order in (mesh if any(mesh) else passing) if order > 0.0})
    found = {harmonic * base: f"{harmonic * base:.4g}" for base in bases for harmonic in range(1, count + 1)}
    # None that lies above the band at every speed.
    slowest = min(course.speed.at(0.0)[0], course.speed.at(course.duration)[0])
    highest = 2.0 * math.pi * settings.highest / slowest if slowest > 0.0 else math.inf
    return sorted((order, name) for order, name in found.items() if order < highest)


def _rehearse(settings: CampbellSettings, course: RunUp, orders: list[tuple[float, str]]) -> None:
    """Look at a silent run of the same course: what does not fit it is said before minutes are spent, not after."""
    samples = math.ceil(course.duration / course.settings.sample - 1e-9)
    times = np.asarray(np.arange(samples + 1) * course.settings.sample, dtype=np.float64)
    speed, angle = np.array([course.speed.at(at) for at in times.tolist()]).T
    silence = RunSignal(times, speed, angle, np.zeros_like(times))
    run_up_spectra(silence, 1.0, settings.highest, settings.window, [order for order, _ in orders])


def _one(
    case: Case,
    settings: CampbellSettings,
    sensor: Sensor,
    course: RunUp,
    orders: list[tuple[float, str]],
    solved: Callable[[int], None],
    with_modes: bool,
) -> _Found:
    """Run up with one law."""
    model = case.model
    start = equilibrium(model.system, Operation(course.speed.at(0.0)[0]))
    done = 0

    def told(samples: int) -> None:
        nonlocal done
        solved(samples - done)
        done = samples

    begin = time.perf_counter()
    record = run_system(
        model.system,
        course.speed,
        course.duration,
        course.settings,
        sensors=(sensor,),
        displacement=start.displacement,
        progress=told,
    )
    seconds = time.perf_counter() - begin
    signal = RunSignal(record.time, record.speed, record.angle, record.signals[:, 0])
    spectra = run_up_spectra(
        signal,
        Reference.of(sensor).value,
        settings.highest,
        settings.window,
        [order for order, _ in orders],
    )
    return _Found(case, record, spectra, _modes(model, spectra) if with_modes else None, seconds)


def _modes(model: Model, spectra: RunUpSpectra) -> Sweep:
    """Modes of the linear system at some speeds of the run, rising."""
    speeds = spectra.campbell.speeds
    return sweep(model.system, np.linspace(speeds.min(), speeds.max(), _MODE_SPEEDS))


def _overlay(entry: _Found) -> Overlay | None:
    """Natural frequencies to draw: of modes with strain energy in the bearings."""
    if entry.modes is None:
        return None
    shown = np.nanmax(entry.modes.undamped.bearing_share, axis=0) >= _LEAST_SHARE
    return Overlay(entry.modes.speeds, entry.modes.undamped.frequency[:, shown])


def _reach(entry: _Found) -> Reach:
    """Where the films of a law are not valid, over the speeds of the run."""
    speeds = entry.spectra.campbell.speeds
    at = np.linspace(float(speeds.min()), float(speeds.max()), _MODE_SPEEDS)
    return Reach(at, lowest_limits(entry.case.model, at), float(speeds[_fading(entry)].max(initial=0.0)))


def _fading(entry: _Found) -> npt.NDArray[np.bool_]:
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


def _report(entry: _Found) -> list[str]:
    """Lines of one law: cost, highest sum level, peaks along the orders."""
    found, record = entry.spectra.campbell, entry.record
    at = int(np.argmax(found.sum_level))
    lines = [
        f"{entry.case.label}: {entry.case.model.law}",
        *heading(entry.case.model)[1:],
        f"  {record.steps} steps, {record.halved} taken back, {1e6 * entry.seconds / max(record.steps, 1):.3g} us a "
        f"step, {entry.seconds:.3g} s",
        f"  highest sum level {found.sum_level[at]:.1f} dB at {RPM.text(float(found.speeds[at]))}"
        f"{_elsewhere(entry, at)}",
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
    ends = (float(found.speeds[0]), float(found.speeds[-1]))
    return [*lines, *fade_lines(entry.case.model, record.speed, "the run"), *film_course(entry.case.model, ends)]


def _differences(found: Sequence[_Found]) -> list[str]:
    """Lines on the sum level of each law beside that of the first one with the same clearance and loads."""
    lines = []
    first: dict[tuple[str, float, float | None], _Found] = {}
    for entry in found:
        beside = first.setdefault((repr(entry.case.clearance), entry.case.load_factor, entry.case.start_angle), entry)
        if beside is not entry:
            levels = (beside.spectra.campbell.sum_level, entry.spectra.campbell.sum_level)
            lines.append(f"  {entry.case.label} beside {beside.case.label}: {difference_text(*levels)}")
    return ["sum level at the same speed", *lines] if lines else []


def _elsewhere(entry: _Found, at: int) -> str:
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
    frequencies = np.array([np.interp(peak.speed, modes.speeds, mode) for mode in modes.undamped.frequency.T])
    return f"{text}   nearest linear mode {frequencies[np.argmin(np.abs(frequencies - peak.frequency))]:.5g} Hz"


def _title(model: Model, sensor: Sensor) -> str:
    """Heading of the figure."""
    clearances = sorted({entry.geometry.diametral_clearance for entry in model.scene.bearings})
    shown = ", ".join(MICROMETRE.text(value) for value in clearances).replace("um", "µm")
    temperature = TEMPERATURE.text(model.scene.temperature).replace("deg", "°")
    return f"{model.scene.title}\nsensor {sensor.name}; {temperature}" + (f", clearance {shown}" if shown else "")
