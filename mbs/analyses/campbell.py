"""The nonlinear run-up with one or more contact laws, as levels over speed, frequency and order, with their errors.

What a linear analysis takes from each slice at its own load is here one change of a whole law: the bounds of the slices
at rest, in the mean with their stiffness (of damping: with their damping) as weight, the largest one of some speeds.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import xarray as xr

from ehdmaps.arrays import BoolArray, FloatArray
from ehdmaps.compiling import cpu_seconds
from ehdmaps.errors import AnalysisError, InputError, Problems
from ehdmaps.figures import typeset
from ehdmaps.maps.law import ContactLaw
from ehdmaps.maps.law_errors import LawChange
from mbs.analyses.case import Case, Failed, Progress, Workers, as_cases, side_by_side
from mbs.analyses.film_errors import notable_from
from mbs.analyses.operating import held, operating, settled, states_of
from mbs.analyses.ramp import recorded_run, rehearsed, run_course, silent_run
from mbs.analyses.reach import fade_of
from mbs.analyses.sensors import chosen_sensors, followed_orders
from mbs.analyses.soundness import Judged, findings_in_run
from mbs.analyses.step_error import StepCheck, step_check
from mbs.linearised.averaged import steady_system
from mbs.linearised.sweep import sweep
from mbs.linearised.sweep_result import Sweep
from mbs.model.drive import DrivenSpeed
from mbs.model.elements import OnRings, Operation, Sensor
from mbs.model.equilibrium import equilibrium
from mbs.model.findings import Finding
from mbs.output.campbell_table import campbell_dataset, of_sensors
from mbs.output.files import described
from mbs.output.model_text import clearance_text, common_supply, temperature_text
from mbs.output.results import BAND, STEP_ERROR, with_states
from mbs.scene.assembly import Model, law_attributes, laws_attributes
from mbs.scene.scene import Scene
from mbs.settings import CAGE_ANGLES, CampbellSettings, RunUp
from mbs.spectral.campbell import RunUpSpectra, run_up_spectra
from mbs.spectral.levels import Reference
from mbs.spectral.run_signal import RunSignal
from mbs.transient.run import Recording

SIGNS = (
    (1.0, 1.0, 1.0),
    (-1.0, -1.0, -1.0),
    (1.0, -1.0, 1.0),
    (-1.0, 1.0, -1.0),
    (1.0, 1.0, -1.0),
    (-1.0, -1.0, 1.0),
    (1.0, -1.0, -1.0),
    (-1.0, 1.0, 1.0),
)
"""Signs of the changes of stiffness, damping and film of each sample: all corners, each beside the opposite one."""

Changes = dict[str, tuple[LawChange, ...]]
"""By the names of the bearings: a change for each law of a bearing, that of massless rollers, or both of rollers."""


def law_changes(model: Model, speeds: Sequence[float]) -> Changes | None:
    """By how much the laws of each bearing may be wrong; None where a law states no errors.

    None for machines with balls or tapered rollers, too: these have no laws that are wrong on purpose.

    Parameters
    ----------
    model : Model
        Scene with its law.
    speeds : sequence of float
        Speeds of the system [rad/s]; that of standstill is passed over, as there are no films.

    Raises
    ------
    AnalysisError
        If there is no equilibrium at a speed.
    """
    found: dict[str, list[list[LawChange]]] = {}
    for speed in speeds:
        if speed == 0.0:
            continue
        operation = Operation(speed)
        balance = equilibrium(steady_system(operating(model, speed).system), operation)
        for index in balance.system.select(OnRings):
            connected = balance.system.elements[index]
            assert isinstance(connected.element, OnRings)
            sides = connected.element.sides(connected.transform @ balance.displacement, operation)
            changes = []
            for side in sides:
                load, stiffness, damping = (part.ravel() for part in side.state())
                bounds = side.law.bounds(load)
                if bounds is None:
                    return None
                changes.append(
                    LawChange(
                        _mean(bounds.stiffness, stiffness),
                        _mean(bounds.damping, damping),
                        _mean(bounds.film_offset, stiffness),
                    )
                )
            if not changes:
                return None
            found.setdefault(connected.element.name, []).append(changes)
    if not found:
        return None
    return {
        name: tuple(LawChange(*np.max(of_law, axis=0).tolist()) for of_law in zip(*at_speeds, strict=True))
        for name, at_speeds in found.items()
    }


def _mean(values: FloatArray, weights: FloatArray) -> float:
    """Mean with weights; that of all where nothing has any."""
    total = float(weights.sum())
    return float(values @ weights / total) if total > 0.0 else float(values.mean())


def with_changed_laws(model: Model, changes: Changes, signs: tuple[float, float, float]) -> Model:
    """The model with laws that are wrong on purpose.

    Parameters
    ----------
    model : Model
        Scene with its law, for a run in time.
    changes : Changes
        What `law_changes` finds.
    signs : tuple of float
        Factors of the changes of stiffness, damping and film, such as one of `SIGNS`.
    """
    made: dict[tuple[int, LawChange], ContactLaw] = {}

    def changed(law: object, change: LawChange) -> ContactLaw:
        assert isinstance(law, ContactLaw)  # others state no errors
        key = id(law), change
        if key not in made:
            made[key] = law.changed(change)
        return made[key]

    elements: list[Any] = [connected.element for connected in model.system.elements]
    bearings = list(model.bearings)
    for index, bearing in enumerate(bearings):
        own, element = [change.times(signs) for change in changes[bearing.name]], elements[index]
        laws = [changed(law, change) for law, change in zip(element.film_laws, own, strict=True)]
        elements[index] = element.with_laws(laws)
        bearings[index] = elements[index].plain
    return dataclasses.replace(model, system=model.system.with_elements(elements), bearings=tuple(bearings))


MOST_BANDS = len(SIGNS)
"""Runs of a law for its band, at most."""

if TYPE_CHECKING:
    from mbs.output.campbell_plot import Overlay, Reach
    from mbs.output.files import Figure

_LEAST_SHARE = 0.05
"""Of the strain energy in bearings, of a mode that is drawn in."""

MOST_DAMPED = 0.5
"""Damping ratio up to which a mode is drawn in: above, a response has no peak by it, or hardly one (1/sqrt 2)."""

MODE_SPEEDS = 9
"""Speeds of the run at which modes are computed."""


@dataclass(frozen=True, eq=False)
class LawRun:
    """Results of one contact law.

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
        How long the run took, without compiling [s].
    level_error : tuple of array, shape (windows,), or None
        Band of the sum level of each sensor, either way [dB]: its largest difference in runs whose laws are wrong by
        the errors that the map states. None where no such runs were asked for, or the law states no errors.
    steps : StepCheck or None
        Errors of its levels by its step, up to the highest frequency; None where that was not possible.
    findings : tuple of Finding
        What is beyond the laws of the bearings, and whether the run itself is sound.
    """

    case: Case
    record: Recording
    spectra: tuple[RunUpSpectra, ...]
    modes: Sweep | None
    seconds: float
    level_error: tuple[FloatArray, ...] | None = None
    steps: StepCheck | None = None
    findings: tuple[Finding, ...] = ()


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

    def plot(self, measured: tuple[str, tuple[RunUpSpectra, ...]] | None = None) -> Figure:
        """Figure that `mbs campbell --plot` writes, with modes and what is not valid; of several sensors the levels.

        Parameters
        ----------
        measured : (str, tuple of RunUpSpectra), optional
            Label and levels of a run that is drawn first, as what the others are compared with.
        """
        from mbs.output.campbell_plot import campbell_figure, sensors_figure

        labels = [entry.case.label for entry in self.runs]
        results = [entry.spectra for entry in self.runs]
        if measured is not None:
            labels, results = [f"measured: {measured[0]}", *labels], [measured[1], *results]
        title = _title([entry.case.model for entry in self.runs], self.sensors)
        if self.sensors[1:]:
            sensors = [(sensor.name, Reference.of(sensor)) for sensor in self.sensors]
            return sensors_figure(title, labels, results, sensors, self.orders)
        # The measured run stands first, as what the others are compared with; it has no films and no modes.
        first: list[None] = [None] * (measured is not None)
        return campbell_figure(
            title,
            labels,
            [spectra[0] for spectra in results],
            Reference.of(self.sensors[0]),
            self.orders,
            [*first, *(_overlay(entry) for entry in self.runs)],
            [*first, *(_reach(entry) for entry in self.runs)],
            [*first, *(entry.level_error[0] if entry.level_error else None for entry in self.runs)],
        )

    def waterfall(self) -> Figure:
        """Figure that `mbs campbell --waterfall` writes: levels of the first sensor with each law, and the orders."""
        labels = [entry.case.label for entry in self.runs]
        title = _title([entry.case.model for entry in self.runs], self.sensors[:1])
        spectra = [entry.spectra[0] for entry in self.runs]
        return waterfall_of(title, labels, spectra, Reference.of(self.sensors[0]), self.orders)


def waterfall_of(
    title: str,
    labels: Sequence[str],
    spectra: Sequence[RunUpSpectra],
    reference: Reference,
    orders: Sequence[tuple[float, str]],
) -> Figure:
    """Waterfall of runs.

    Parameters
    ----------
    title : str
        Heading of the page.
    labels : sequence of str
        What each run is.
    spectra : sequence of RunUpSpectra
        Levels of each run.
    reference : Reference
        Reference of the levels.
    orders : sequence of (float, str)
        Lines to draw in, with their names.
    """
    from mbs.output.campbell_plot import reference_text
    from mbs.output.waterfall_plot import Waterfall, waterfall_figure

    cases = [
        Waterfall(label, found.campbell.speeds, found.campbell.frequencies, found.campbell.level)
        for label, found in zip(labels, spectra, strict=True)
    ]
    return waterfall_figure(title, cases, f"{reference.quantity} level, {reference_text(reference)}", orders)


def campbell(
    models: Model | Case | Sequence[Model | Case],
    settings: CampbellSettings | None = None,
    progress: Progress | None = None,
    *,
    sensors: Sequence[str] = (),
    with_modes: bool = False,
    keep_partial: bool = False,
    bands: int = 0,
    workers: Workers = 1,
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
        by the bounds of these errors, with all signs in turn (`mbs.analyses.campbell`). Each costs a run.
    workers : int or concurrent.futures.Executor
        Number of processes among which the runs are divided, or what computes them in their place.

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
    if course is not None and isinstance(course.speed, DrivenSpeed) and (cases[1:] or bands):
        problems.append(
            f"{scene.name}: [drive]: got {len(cases)} cases and {bands} runs of bands; allowed: one case without "
            "bands, as films resist with a torque of their own, so that each run has other speeds; run each case "
            "alone, or compare two laws at equal speeds with `mbs variants`"
        )
    if problems or course is None:
        raise InputError(problems)
    orders = followed_orders(cases[0].model, settings, course)
    cases = tuple(dataclasses.replace(case, model=held(case.model)) for case in cases)
    rehearsed(settings, course, orders)
    look = _Look(settings, tuple(seen), course, tuple(orders))
    runs, failed = _runs(cases, look, progress, with_modes, keep_partial, bands, workers)
    if not runs:
        raise AnalysisError("\n".join(f"warning: {line}" for line in failed))
    labels, known = [entry.case.label for entry in runs], runs[0].spectra[0].campbell.speeds
    words = f"{BAND} the sum level: largest difference of {bands} runs with wrong laws"
    parts = []
    for place, sensor in enumerate(seen):
        part = campbell_dataset(labels, [entry.spectra[place] for entry in runs], Reference.of(sensor), sensor.name)
        errors = [np.full(known.size, np.nan) if run.level_error is None else run.level_error[place] for run in runs]
        part["sum_level_error"] = (("law", "speed"), np.array(errors), {"units": "dB", "long_name": words})
        by_step = [np.nan if run.steps is None else run.steps.of(sensor.name) for run in runs]
        part["step_error"] = ("law", np.array(by_step), STEP_ERROR)
        parts.append(part)
    dataset = of_sensors(parts)
    dataset = with_states(dataset, [states_of(entry.case.model) for entry in runs], ("law",))
    # The dataset says of each law what it is.
    laws = laws_attributes(labels, [entry.case.model for entry in runs])
    dataset = described(dataset, **{**law_attributes(runs[0].case.model), **laws})
    dataset = Judged([(entry.case.label, entry.findings) for entry in runs]).marked(dataset)
    return CampbellResult(settings, tuple(seen), course, tuple(orders), tuple(runs), tuple(failed), dataset)


def campbell_problems(scene: Scene, settings: CampbellSettings, sensors: Sequence[str] = ()) -> list[str]:
    """Everything about the run and the sensors of a scene that is not possible with some settings."""
    problems = Problems()
    chosen_sensors(scene, settings, sensors, problems)
    course = run_course(scene, settings.highest, problems)
    if course is not None and not problems:
        with problems:
            silent_run(course).ramp()
    return problems


@dataclass(frozen=True, eq=False)
class _Look:
    """Choice of what is looked at in each run."""

    settings: CampbellSettings
    sensors: tuple[Sensor, ...]
    course: RunUp
    orders: tuple[tuple[float, str], ...]


def _runs(
    cases: Sequence[Case],
    look: _Look,
    progress: Progress | None,
    with_modes: bool,
    keep_partial: bool,
    bands: int,
    workers: Workers,
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
    runs: dict[int, LawRun] = {}
    lost: dict[int, str] = {}
    levels: dict[int, list[FloatArray]] = {}

    made = side_by_side(
        partial(_piece, look, with_modes, lost),
        [(index, cases[index].model, changes[index], signs) for index, signs in pieces],
        [each] * len(pieces),
        workers,
        progress,
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
                findings = findings_in_run(cases[index].model, found.record)
                runs[index] = LawRun(cases[index], *found[:4], steps=found.steps, findings=findings)
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


def _piece(
    look: _Look,
    with_modes: bool,
    lost: Mapping[int, str],
    piece: tuple[int, Model, Changes | None, tuple[float, float, float] | None],
    told: Callable[[int], None],
) -> _Made | FloatArray:
    """The run of a case by its index, or the sum levels of one of its band; none of those whose run has no result."""
    index, model, change, signs = piece
    if signs is None or change is None:
        return _one(model, look, told, with_modes)
    if index in lost:
        raise AnalysisError(lost[index])
    return _sum_levels(_one(with_changed_laws(model, change, signs), look, told, False, False).spectra)


def _sum_levels(spectra: Sequence[RunUpSpectra]) -> FloatArray:
    """Sum levels of all sensors, shape (sensors, windows) [dB]."""
    return np.array([each.campbell.sum_level for each in spectra])


class _Made(NamedTuple):
    """A run with one law, as of `LawRun`."""

    record: Recording
    spectra: tuple[RunUpSpectra, ...]
    modes: Sweep | None
    seconds: float
    steps: StepCheck | None


def _one(model: Model, look: _Look, told: Callable[[int], None], with_modes: bool, check: bool = True) -> _Made:
    """Run up with one law, and check its step; all sensors of the scene are recorded."""
    begin = cpu_seconds()
    record = recorded_run(model, look.course, model.scene.sensors, told, marks=check)
    seconds = cpu_seconds() - begin
    checked = step_check(model, look.course, record, look.settings.highest) if check else None
    settings, orders = look.settings, [order for order, _ in look.orders]
    spectra = []
    places = {sensor.name: place for place, sensor in enumerate(model.scene.sensors)}
    for sensor in look.sensors:
        signal = RunSignal(record.time, record.speed, record.angle, record.signals[:, places[sensor.name]])
        reference = Reference.of(sensor).value
        spectra.append(run_up_spectra(signal, reference, settings.highest, settings.window, orders))
    return _Made(record, tuple(spectra), _modes(model, spectra[0]) if with_modes else None, seconds, checked)


def _modes(model: Model, spectra: RunUpSpectra) -> Sweep:
    """Modes of the linear system at some speeds of the run, rising."""
    speeds = spectra.campbell.speeds
    system = settled([model], float(speeds.max()))[0].system
    return sweep(system, np.linspace(speeds.min(), speeds.max(), MODE_SPEEDS), cage_angles=CAGE_ANGLES)


def _overlay(entry: LawRun) -> Overlay | None:
    """Natural frequencies to draw: of modes with strain energy in the bearings that are no mere decay."""
    from mbs.output.campbell_plot import Overlay

    if entry.modes is None:
        return None
    found = entry.modes.damped
    shown = (np.nan_to_num(found.bearing_share) >= _LEAST_SHARE).any(axis=0)
    swinging = found.damping_ratio <= MOST_DAMPED
    return Overlay(entry.modes.speeds, np.where(swinging, found.frequency, np.nan)[:, shown])


def _reach(entry: LawRun) -> Reach:
    """Range where the films of a law are not valid, over the speeds of the run."""
    from mbs.output.campbell_plot import Reach

    speeds = entry.spectra[0].campbell.speeds
    at = np.linspace(float(speeds.min()), float(speeds.max()), MODE_SPEEDS)
    return Reach(at, notable_from(entry.case.model, at), float(speeds[fading(entry)].max(initial=0.0)))


def fading(entry: LawRun) -> BoolArray:
    """True for windows that reach below the map, where the film fades to the dry contact, shape (windows,)."""
    found, record = entry.spectra[0].campbell, entry.record
    fade = fade_of(entry.case.model)
    if fade is None:
        return np.zeros(found.time.size, dtype=np.bool_)
    ends = [np.interp(found.time + part * found.window, record.time, np.abs(record.speed)) for part in (-0.5, 0.5)]
    return fade.below(np.minimum(*ends))


def _title(models: Sequence[Model], sensors: Sequence[Sensor]) -> str:
    """Heading of the figure."""
    model = models[0]
    clearance, supply = clearance_text(model), common_supply(models)
    parts = [temperature_text(model), f"clearance {clearance}" if clearance else "", supply]
    at = ", ".join(part for part in parts if part)
    names = f"sensor {sensors[0].name}; " if not sensors[1:] else ""
    return f"{model.scene.title}\n{names}{typeset(at)}"
