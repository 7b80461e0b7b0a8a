"""The nonlinear run-up with one or more contact laws, as levels over speed, frequency and order."""

from __future__ import annotations

import dataclasses
import math
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import xarray as xr

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import AnalysisError, InputError
from ehdmaps.units import closest
from mbs.analyses.case import Case, as_cases
from mbs.analyses.changed_laws import SIGNS, law_changes, with_changed_laws
from mbs.analyses.operating import held, states_of
from mbs.analyses.progress import Progress, silent
from mbs.analyses.side_by_side import Failed, side_by_side
from mbs.linearised.sweep import sweep
from mbs.linearised.sweep_result import Sweep
from mbs.model.elements import Operation, Sensor
from mbs.model.equilibrium import equilibrium
from mbs.output.campbell_data import campbell_dataset, of_sensors
from mbs.output.results import BAND, described
from mbs.output.state_data import with_states
from mbs.scene.assembly import Model, law_attributes, supply_attributes
from mbs.scene.fields import HERTZ
from mbs.scene.scene import Scene
from mbs.settings import CampbellSettings, RunUp
from mbs.spectral.campbell import RunUpSpectra, run_up_spectra
from mbs.spectral.levels import Reference
from mbs.spectral.run_signal import RunSignal
from mbs.spectral.spectra import LEAST_OVERSAMPLING
from mbs.transient.run import Recording
from mbs.transient.run import run as run_system

LEAST_SAMPLES, MOST_SAMPLES = 64, 5_000_000
"""Steps of a run: the fewest that have a spectrum, and 50 s of 10 us, beyond any run-up that is waited for."""

MOST_BANDS = len(SIGNS)
"""Runs of a law for its band, at most."""

ALL_SENSORS = "all"
"""Stands for all sensors of a scene, or of a file."""

MODE_SPEEDS = 9
"""Speeds of the run at which modes are computed."""


@dataclass(frozen=True, eq=False)
class LawRun:
    """What one contact law led to.

    Attributes
    ----------
    case : Case
        The model, with its label.
    record : Recording
        The run in time.
    spectra : tuple of RunUpSpectra
        Levels of the run over speed, frequency and order, one a sensor.
    modes : Sweep or None
        Modes of the linear system at some speeds of the run, if they were asked for.
    seconds : float
        How long the run took [s].
    level_error : tuple of array, shape (windows,), or None
        Band of the sum level of each sensor, either way [dB]: its largest difference in runs whose laws are wrong by
        the errors that the map states. None where no such runs were asked for, or the law states no errors.
    """

    case: Case
    record: Recording
    spectra: tuple[RunUpSpectra, ...]
    modes: Sweep | None
    seconds: float
    level_error: tuple[FloatArray, ...] | None = None


@dataclass(frozen=True, eq=False)
class CampbellResult:
    """Run-ups with one or more contact laws, as levels.

    Attributes
    ----------
    settings : CampbellSettings
        What was looked at.
    sensors : tuple of Sensor
        Whose signals they are.
    course : RunUp
        The run, with a sample a step.
    orders : tuple of (float, str)
        Orders that were followed, with their names.
    runs : tuple of LawRun
        Runs of the laws that came to the end.
    failed : tuple of str
        Why the others did not, each with its label.
    dataset : xarray.Dataset
        What `mbs campbell -o` writes.
    """

    settings: CampbellSettings
    sensors: tuple[Sensor, ...]
    course: RunUp
    orders: tuple[tuple[float, str], ...]
    runs: tuple[LawRun, ...]
    failed: tuple[str, ...]
    dataset: xr.Dataset


def campbell(
    models: Model | Case | Sequence[Model | Case],
    settings: CampbellSettings | None = None,
    progress: Progress | None = None,
    *,
    sensors: Sequence[str] = (),
    with_modes: bool = False,
    keep_partial: bool = False,
    bands: int = 0,
    workers: int = 1,
) -> CampbellResult:
    """Run up with each contact law, and compute levels over speed, frequency and order.

    Parameters
    ----------
    models : Model, Case, or a sequence of them
        One scene with one or more laws; its [runup] says how the speed goes.
    settings : CampbellSettings, optional
        What is looked at; [campbell] of the scene if left out.
    progress : callable, optional
        Told how many steps are done, and of how many, over all laws.
    sensors : sequence of str
        Names of sensors that are looked at, or `ALL_SENSORS`; all from one run. That of the settings if left out.
    with_modes : bool
        Whether modes of the linear system are computed at `MODE_SPEEDS` speeds of the run.
    keep_partial : bool
        Whether Ctrl-C returns the laws that have come to the end, if there are any; else it is raised.
    bands : int
        Runs more of each law that states errors, up to `MOST_BANDS`: its stiffness, damping and films are wrong there
        by the bounds of these errors, with all signs in turn (`mbs.analyses.changed_laws`). Each costs a run.
    workers : int
        Number of processes among which the runs are divided.

    Raises
    ------
    InputError
        With everything about run, sensor and settings that is not possible; before anything runs.
    AnalysisError
        If no law came to the end. If some did, `CampbellResult.failed` says why the others did not.

    Examples
    --------
    The shipped scene takes some seconds; with a coarser look at it::

        model = assemble(read_scene("nu308_rigid"))
        found = campbell(model, CampbellSettings(sensor="S1", highest=2000.0))
        found.dataset["sum_level"]
    """
    cases = as_cases(models)
    scene = cases[0].model.scene
    settings = settings or scene.campbell
    problems: list[str] = []
    seen = chosen_sensors(scene, settings, sensors, problems)
    course = run_course(scene, settings.highest, problems)
    if not 0 <= bands <= MOST_BANDS:
        problems.append(f"bands: got {bands} runs; allowed: 0 to {MOST_BANDS}")
    if problems or course is None:
        raise InputError(tuple(dict.fromkeys(problems)))
    orders = followed_orders(cases[0].model, settings, course)
    cases = tuple(dataclasses.replace(case, model=held(case.model)) for case in cases)
    rehearsed(settings, course, orders)
    look = _Look(settings, tuple(seen), course, tuple(orders))
    runs, failed = _runs(cases, look, progress or silent, with_modes, keep_partial, bands, workers)
    if not runs:
        raise AnalysisError("\n".join(f"warning: {line}" for line in failed))
    labels, known = [entry.case.label for entry in runs], runs[0].spectra[0].campbell.speeds
    words = f"{BAND} the sum level: largest difference of {bands} runs with wrong laws"
    parts = []
    for place, sensor in enumerate(seen):
        part = campbell_dataset(labels, [entry.spectra[place] for entry in runs], Reference.of(sensor), sensor.name)
        errors = [np.full(known.size, np.nan) if run.level_error is None else run.level_error[place] for run in runs]
        part["sum_level_error"] = (("law", "speed"), np.array(errors), {"units": "dB", "long_name": words})
        parts.append(part)
    dataset = of_sensors(parts)
    dataset = with_states(dataset, [states_of(entry.case.model) for entry in runs], ("law",))
    # The dataset says of each law what it is.
    laws = "; ".join(f"{entry.case.label}: {entry.case.model.law}" for entry in runs)
    supplies = supply_attributes([(entry.case.label, entry.case.model) for entry in runs])
    dataset = described(dataset, **{**law_attributes(runs[0].case.model), "law": laws, **supplies})
    return CampbellResult(settings, tuple(seen), course, tuple(orders), tuple(runs), tuple(failed), dataset)


def looked_at(scene: Scene, settings: CampbellSettings) -> tuple[Sensor, ...]:
    """The sensor of a diagram, then all others of an acceleration.

    Parameters
    ----------
    scene : Scene
        The scene.
    settings : CampbellSettings
        The sensor's name, if one is named.

    Raises
    ------
    InputError
        If there is no such sensor.
    """
    problems: list[str] = []
    sensor = _sensor(settings.sensor, scene, problems)
    if sensor is None:
        raise InputError(problems)
    others = (other for other in scene.sensors if other.quantity == "acceleration" and other.name != sensor.name)
    return sensor, *others


def chosen_sensors(scene: Scene, settings: CampbellSettings, names: Sequence[str], problems: list[str]) -> list[Sensor]:
    """The sensors of some names, without doubles.

    Parameters
    ----------
    scene : Scene
        The scene.
    settings : CampbellSettings
        Its sensor is taken where no name is given.
    names : sequence of str
        Names, or `ALL_SENSORS` for all of the scene.
    problems : list of str
        What is wrong about them is appended.
    """
    if ALL_SENSORS in names and scene.sensors and all(sensor.name != ALL_SENSORS for sensor in scene.sensors):
        return list(scene.sensors)
    found = [_sensor(name, scene, problems) for name in names or (settings.sensor,)]
    return list({sensor.name: sensor for sensor in found if sensor is not None}.values())


def campbell_problems(scene: Scene, settings: CampbellSettings, sensors: Sequence[str] = ()) -> list[str]:
    """Everything about the run and the sensors of a scene that is not possible with some settings."""
    problems: list[str] = []
    chosen_sensors(scene, settings, sensors, problems)
    run_course(scene, settings.highest, problems)
    return problems


@dataclass(frozen=True, eq=False)
class _Look:
    """What is looked at in each run."""

    settings: CampbellSettings
    sensors: tuple[Sensor, ...]
    course: RunUp
    orders: tuple[tuple[float, str], ...]


def _runs(
    cases: Sequence[Case],
    look: _Look,
    tell: Progress,
    with_modes: bool,
    keep_partial: bool,
    bands: int,
    workers: int,
) -> tuple[list[LawRun], list[str]]:
    """The run of each case, and why some have none; those of its band after it."""
    course = look.course
    each = round(course.duration / course.settings.sample)
    speeds = [course.speed.at(part * course.duration)[0] for part in (0.0, 0.5, 1.0)]
    changes = [law_changes(case.model, speeds) if bands else None for case in cases]
    pieces = [
        (index, signs)
        for index, change in enumerate(changes)
        for signs in (None, *(SIGNS[:bands] if change is not None else ()))
    ]
    total = each * len(pieces)
    runs: dict[int, LawRun] = {}
    lost: dict[int, str] = {}
    levels: dict[int, list[FloatArray]] = {}

    def work(piece: int, told: Callable[[int], None]) -> _Made | FloatArray:
        (index, signs), change = pieces[piece], changes[pieces[piece][0]]
        if signs is None or change is None:
            return _one(cases[index].model, look, told, with_modes)
        if index in lost:
            raise AnalysisError(lost[index])
        return _sum_levels(_one(with_changed_laws(cases[index].model, change, signs), look, told, False).spectra)

    tell(0, total)
    made = side_by_side(
        work,
        [each] * len(pieces),
        workers,
        lambda done: tell(done, total),
        lambda piece: cases[pieces[piece][0]].label,
    )
    stopped: list[str] = []
    try:
        for (index, signs), found in zip(pieces, made, strict=True):
            if isinstance(found, Failed):
                # The run-ups with the other laws are worth minutes; keep them.
                if not isinstance(found.error, AnalysisError):
                    raise found.error
                part = "" if signs is None else ", a run of its band"
                lost.setdefault(index, f"{cases[index].label}{part}: {found.error}")
            elif isinstance(found, _Made):
                runs[index] = LawRun(cases[index], *found)
            elif index not in lost:
                levels.setdefault(index, []).append(found)
                if len(levels[index]) == bands:
                    wrong = np.abs(np.array(levels[index]) - _sum_levels(runs[index].spectra)).max(axis=0)
                    runs[index] = dataclasses.replace(runs[index], level_error=tuple(wrong))
    except KeyboardInterrupt:
        if not (runs and keep_partial):
            raise
        stopped = [
            f"{case.label}: stopped, no result"
            for index, case in enumerate(cases)
            if index not in runs and index not in lost
        ]
    return list(runs.values()), [*lost.values(), *stopped]


def run_course(scene: Scene, highest: float, problems: list[str]) -> RunUp | None:
    """The run of the scene with a sample a step, so that nothing above the band is folded into it.

    Parameters
    ----------
    scene : Scene
        The scene.
    highest : float
        Highest frequency that is looked at [Hz].
    problems : list of str
        What is wrong about it is appended.

    Returns
    -------
    RunUp or None
        None where there is no run, or none of a possible length.
    """
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


def followed_orders(model: Model, settings: CampbellSettings, course: RunUp) -> list[tuple[float, str]]:
    """Orders to follow, with their names: those of the settings, else what the elements excite.

    Parameters
    ----------
    model : Model
        Scene with a law.
    settings : CampbellSettings
        Orders, if any are named, and the highest frequency.
    course : RunUp
        The run.
    """
    if settings.orders:
        return [(order, f"{order:g}") for order in settings.orders]
    # None that lies above the band at every speed.
    slowest = min(course.speed.at(0.0)[0], course.speed.at(course.duration)[0])
    return orders_in_band(excited_orders(model), settings.highest, slowest)


def orders_in_band(orders: Sequence[tuple[float, str]], highest: float, slowest: float) -> list[tuple[float, str]]:
    """Those of some orders that do not lie above a band at every speed.

    Parameters
    ----------
    orders : sequence of (float, str)
        Orders, with their names.
    highest : float
        Highest frequency [Hz].
    slowest : float
        Lowest speed of the run [rad/s].

    Examples
    --------
    >>> orders_in_band([(2.0, "2"), (200.0, "200")], 1000.0, 62.8)
    [(2.0, '2')]
    """
    top = 2.0 * math.pi * highest / slowest if slowest > 0.0 else math.inf
    return [(order, name) for order, name in orders if order < top]


def excited_orders(model: Model) -> list[tuple[float, str]]:
    """Orders that the elements of a model excite, with their names: of gears, else of passing rollers.

    Parameters
    ----------
    model : Model
        Scene with a law.
    """
    given = [one for entry in model.system.elements if (one := entry.element.excitation) is not None]
    highest_rank = max((entry.rank for entry in given), default=0)
    # Rounded, for bearings that differ in the last bit only.
    bases = sorted({(round(entry.order, 9), entry.harmonics) for entry in given if entry.rank == highest_rank})
    found = {k * base: f"{k * base:.4g}" for base, count in bases for k in range(1, count + 1)}
    return sorted(found.items())


def silent_run(course: RunUp) -> RunSignal:
    """A silent run of a course: what does not fit it is said before minutes are spent, not after.

    Parameters
    ----------
    course : RunUp
        The run.

    Raises
    ------
    InputError
        If there is none.
    """
    samples = math.ceil(course.duration / course.settings.sample - 1e-9)
    times = np.asarray(np.arange(samples + 1) * course.settings.sample, dtype=np.float64)
    speed, angle = np.array([course.speed.at(at) for at in times.tolist()]).T
    return RunSignal(times, speed, angle, np.zeros_like(times))


def rehearsed(settings: CampbellSettings, course: RunUp, orders: Sequence[tuple[float, str]]) -> RunUpSpectra:
    """What a silent run of a course gives: windows, speeds and frequencies of any signal of it.

    Parameters
    ----------
    settings : CampbellSettings
        What is looked at.
    course : RunUp
        The run.
    orders : sequence of (float, str)
        Orders to follow, with their names.

    Raises
    ------
    InputError
        If settings and orders do not fit the run.
    """
    return run_up_spectra(silent_run(course), 1.0, settings.highest, settings.window, [order for order, _ in orders])


def _sum_levels(spectra: Sequence[RunUpSpectra]) -> FloatArray:
    """Sum levels of all sensors, shape (sensors, windows) [dB]."""
    return np.array([each.campbell.sum_level for each in spectra])


class _Made(NamedTuple):
    """A run with one law, as of `LawRun`."""

    record: Recording
    spectra: tuple[RunUpSpectra, ...]
    modes: Sweep | None
    seconds: float


def _one(model: Model, look: _Look, told: Callable[[int], None], with_modes: bool) -> _Made:
    """Run up with one law; all sensors of the scene are recorded."""
    begin = time.perf_counter()
    record = recorded_run(model, look.course, model.scene.sensors, told)
    seconds = time.perf_counter() - begin
    settings, orders = look.settings, [order for order, _ in look.orders]
    spectra = []
    places = {sensor.name: place for place, sensor in enumerate(model.scene.sensors)}
    for sensor in look.sensors:
        signal = RunSignal(record.time, record.speed, record.angle, record.signals[:, places[sensor.name]])
        reference = Reference.of(sensor).value
        spectra.append(run_up_spectra(signal, reference, settings.highest, settings.window, orders))
    return _Made(record, tuple(spectra), _modes(model, spectra[0]) if with_modes else None, seconds)


def recorded_run(
    model: Model,
    course: RunUp,
    sensors: Sequence[Sensor],
    told: Callable[[int], None] | None = None,
    *,
    nudge: float = 0.0,
) -> Recording:
    """Run up from the equilibrium at the first speed, and record sensors.

    Parameters
    ----------
    model : Model
        Scene with a law.
    course : RunUp
        The run.
    sensors : sequence of Sensor
        What is recorded.
    told : callable, optional
        Told the number of samples done.
    nudge : float
        Distance of all coordinates from their equilibrium at the beginning [m or rad], to see what becomes of it.

    Raises
    ------
    AnalysisError
        If there is no equilibrium, or a step finds no solution.
    """
    start = equilibrium(model.system, Operation(course.speed.at(0.0)[0]))
    return run_system(
        model.system,
        course.speed,
        course.duration,
        course.settings,
        sensors=sensors,
        displacement=start.displacement + nudge,
        progress=told,
    )


def _modes(model: Model, spectra: RunUpSpectra) -> Sweep:
    """Modes of the linear system at some speeds of the run, rising."""
    speeds = spectra.campbell.speeds
    return sweep(model.system, np.linspace(speeds.min(), speeds.max(), MODE_SPEEDS))
