"""The nonlinear system in time over its speed profile, from its equilibrium."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, NamedTuple

import xarray as xr

from ehdmaps.compiling import cpu_seconds
from ehdmaps.errors import AnalysisError, InputError
from ehdmaps.units import RPM
from mbs.analyses.case import Case, Failed, Progress, Workers, side_by_side, silent
from mbs.analyses.operating import held, states_of
from mbs.analyses.ramp import course_of
from mbs.analyses.reach import fade_of
from mbs.analyses.recorded import simulated
from mbs.analyses.soundness import findings_in_run, with_findings
from mbs.analyses.step_error import StepCheck, step_check
from mbs.model.elements import Operation
from mbs.model.equilibrium import equilibrium
from mbs.model.findings import Finding, is_unsound
from mbs.output.files import described
from mbs.output.results import STEP_ERROR, of_laws, run_dataset, with_energy, with_states
from mbs.scene.assembly import Model, law_attributes, laws_attributes
from mbs.scene.scene import Scene
from mbs.settings import RunUp
from mbs.timedata.netcdf_file import signal_variables
from mbs.transient.run import Options, Recording
from mbs.transient.run import run as run_system

if TYPE_CHECKING:
    from mbs.output.files import Figure
    from mbs.spectral.spectra import AmplitudeSpectrum
    from mbs.timedata.records import TimeRecord

_KEPT = Options(every_step=True, marks=True)
"""Sensors at every step: fewer would fold what lies above their band into it."""


@dataclass(frozen=True, eq=False)
class RunUpResult:
    """A run, and what it was a run of.

    Attributes
    ----------
    model : Model
        Scene with its law.
    course : RunUp
        Speed, duration, and how it was integrated.
    record : Recording
        Recorded forces and signals, motion of the coordinates where asked for, and how often each element was outside
        its map.
    seconds : float
        How long the integration took, without compiling [s].
    dataset : xarray.Dataset
        What `mbs runup -o` writes.
    findings : tuple of Finding
        What is beyond the laws of its bearings, and whether the run itself is sound.
    steps : StepCheck or None
        Errors of its signals by its step, estimated; None where that was not possible.
    """

    model: Model
    course: RunUp
    record: Recording
    seconds: float
    dataset: xr.Dataset
    findings: tuple[Finding, ...] = ()
    steps: StepCheck | None = None

    def plot(self) -> Figure:
        """Figure that `mbs runup --plot` writes: bearing forces and displacements, speed, signals of the sensors."""
        sensed = self.model.scene.sensors
        return runup_figure([self], simulated([(self.model.label, self.model, self.record)]).records if sensed else ())


def runup_problems(scene: Scene) -> list[str]:
    """List what a scene lacks for a run-up.

    Parameters
    ----------
    scene : Scene
        The scene.
    """
    return [] if scene.run_up else [f"{scene.name}: [runup] missing; a run needs from, to, duration and step"]


def runup(
    model: Model, settings: RunUp | None = None, progress: Progress | None = None, *, states: bool = True
) -> RunUpResult:
    """Integrate the nonlinear system in time over a speed profile, from its equilibrium.

    Parameters
    ----------
    model : Model
        Scene with its law.
    settings : RunUp, optional
        Speed over time, duration and steps; [runup] of the scene if left out.
    progress : callable, optional
        Told how many steps are done, and of how many.
    states : bool
        Whether the motion of all coordinates is kept at the samples, 24 bytes a coordinate and sample; else forces of
        the bearings at the samples and signals of the sensors at every step alone, which are the same numbers.

    Raises
    ------
    InputError
        If neither says how the speed goes, or for more samples than can be recorded.
    AnalysisError
        If there is no equilibrium at the first speed, or a step finds no solution.

    Examples
    --------
    >>> import dataclasses
    >>> from mbs import assemble, read_scene, runup
    >>> model = assemble(read_scene("nu308_rigid"), "hertz")
    >>> short = dataclasses.replace(model.scene.run_up, duration=1e-3)
    >>> runup(model, short).dataset.sizes["time"]
    11
    """
    tell = progress or silent
    total = _steps(_course(model, settings))
    tell(0, total)
    return RunUpResult(held(model), *_run(model, lambda done: tell(done, total), settings, states=states))


class _Made(NamedTuple):
    """A run, as of `RunUpResult`."""

    course: RunUp
    record: Recording
    seconds: float
    dataset: xr.Dataset
    findings: tuple[Finding, ...]
    steps: StepCheck | None


def _course(model: Model, settings: RunUp | None = None) -> RunUp:
    """Course that is run: that of the scene if nothing else is given."""
    course = settings or model.scene.run_up
    if course is None:
        raise InputError(runup_problems(model.scene))
    return course


def _steps(course: RunUp) -> int:
    """Steps of a run, in whole samples."""
    return math.ceil(course.duration / course.settings.sample - 1e-9) * course.settings.steps_per_sample


def _run(model: Model, told: Callable[[int], None], settings: RunUp | None = None, *, states: bool = True) -> _Made:
    """Integrate over a speed profile, that of the scene if none is given; what is told are steps."""
    course, model = _course(model, settings), held(model)
    start = equilibrium(model.system, Operation(course.speed.at(0.0)[0]))
    steps, sensors = course.settings.steps_per_sample, model.scene.sensors
    begin = cpu_seconds()
    record = run_system(
        model.system,
        course_of(model, course),
        course.duration,
        course.settings,
        sensors=sensors,
        displacement=start.displacement,
        progress=lambda done: told(done * steps),
        options=dataclasses.replace(_KEPT, states=states),
    )
    seconds = cpu_seconds() - begin
    dataset = with_energy(run_dataset(model.system, record), record.energy)
    dataset = with_states(dataset, states_of(model))
    dataset = described(dataset, **law_attributes(model))
    if sensors:
        signals = signal_variables(simulated([(model.label, model, record)]))
        dataset = dataset.merge(signals).assign_attrs({**signals.attrs, **dataset.attrs})
    findings = findings_in_run(model, record)
    checked = None if is_unsound(findings) else step_check(model, course, record)
    if checked is not None:
        dataset["step_error"] = ("sensor", checked.largest, STEP_ERROR)
    return _Made(course, record, seconds, with_findings(dataset, findings), findings, checked)


class RunUps(NamedTuple):
    """Runs of one scene with several laws.

    Attributes
    ----------
    labels : tuple of str
        What each is called.
    runs : tuple of RunUpResult
        Those that came to the end.
    failed : tuple of str
        Why the others did not, each with its label.
    """

    labels: tuple[str, ...]
    runs: tuple[RunUpResult, ...]
    failed: tuple[str, ...]

    @property
    def dataset(self) -> xr.Dataset:
        """Data set that `mbs runup -o` writes: of one law its result, of several all of them over the dim law."""
        if len(self.runs) == 1:
            return self.runs[0].dataset
        return _of_laws(self)


def runups(
    cases: Sequence[Case],
    progress: Progress | None = None,
    *,
    keep_partial: bool = False,
    workers: Workers = 1,
    states: bool = True,
) -> RunUps:
    """Integrate the run of one scene with several laws.

    Parameters
    ----------
    cases : sequence of Case
        Models, with their labels.
    progress : callable, optional
        Told how many steps are done, and of how many, over all laws.
    keep_partial : bool
        Whether Ctrl-C returns the laws that have come to the end, if there are any; else it is raised.
    workers : int or concurrent.futures.Executor
        Number of processes among which the laws are divided, or what computes them in their place.
    states : bool
        Whether the motion of all coordinates is kept, as for `runup`.

    Raises
    ------
    InputError
        As `runup` does.
    AnalysisError
        If no law came to the end.

    Examples
    --------
    >>> import dataclasses
    >>> from mbs import Case, assemble, read_scene
    >>> scene = read_scene("nu308_rigid")
    >>> scene = dataclasses.replace(scene, run_up=dataclasses.replace(scene.run_up, duration=1e-3))
    >>> laws = ("hertz", "constant:hertz")
    >>> found = runups([Case(law, assemble(scene, law), 0.0) for law in laws])
    >>> found.dataset["signal"].dims
    ('law', 'signal_time', 'sensor')
    """
    sizes = [_steps(_course(case.model)) for case in cases]
    runs: dict[int, RunUpResult] = {}
    failed: list[str] = []
    made = side_by_side(
        partial(_run, states=states),
        [case.model for case in cases],
        sizes,
        workers,
        progress,
        lambda index: cases[index].label,
    )
    try:
        for index, found in enumerate(made):
            if not isinstance(found, Failed):
                runs[index] = RunUpResult(held(cases[index].model), *found)
            elif isinstance(found.error, AnalysisError) and cases[1:]:
                failed.append(f"{cases[index].label}: {found.error}")
            else:
                raise found.error
    except KeyboardInterrupt:
        if not (runs and keep_partial):
            raise
        failed += [f"{left.label}: stopped, no result" for left in cases[len(runs) + len(failed) :]]
    if not runs:
        raise AnalysisError("\n".join(f"warning: {line}" for line in failed))
    return RunUps(tuple(cases[index].label for index in runs), tuple(runs.values()), tuple(failed))


_SHARED = ("speed", "angle", "quantity", "signal_unit", "signal_speed", "signal_angle", "followed_order")
"""Variables that are the same whatever the law."""


def _of_laws(found: RunUps) -> xr.Dataset:
    """The results of all laws over the dim law; what a law has not is not a number."""
    parts = [run.dataset for run in found.runs]
    counts = {
        key: sum(int(part.attrs[key]) for part in parts) for key in ("steps", "steps_halved", "newton_iterations")
    }
    laws = laws_attributes(found.labels, [run.model for run in found.runs])
    return of_laws(found.labels, parts, _SHARED).assign_attrs({**parts[0].attrs, **counts, **laws})


def runup_figure(
    runs: Sequence[RunUpResult],
    records: Sequence[TimeRecord] = (),
    spectra: Sequence[Sequence[Sequence[AmplitudeSpectrum]]] = (),
) -> Figure:
    """Figure of runs of one scene, with the fade of the first law shaded.

    Parameters
    ----------
    runs : sequence of RunUpResult
        One a law.
    records : sequence of TimeRecord
        Signals of the sensors, one a run; none are drawn without.
    spectra : sequence
        Amplitude spectra, by run, speed and sensor.
    """
    from mbs.output.run_plot import run_figure

    first, *others = [(entry.model, entry.record) for entry in runs]
    fade = fade_of(first[0])
    words = ""
    if fade is not None:
        words = (
            f"below {fade.source} (below {RPM.text(fade.speed)}, entrainment speed {fade.entrainment_speed:.4g} m/s): "
            "the film fades to the dry contact"
        )
    return run_figure(*first, fade.speed if fade else 0.0, words, others, records, spectra)
