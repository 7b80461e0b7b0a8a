"""The nonlinear system in time over its speed profile, from its equilibrium."""

from __future__ import annotations

import math
import time
from dataclasses import dataclass

import xarray as xr

from ehdmaps.errors import InputError
from mbs.analyses.drive import course_of
from mbs.analyses.operating import held, states_of
from mbs.analyses.progress import Progress, silent
from mbs.model.elements import Operation
from mbs.model.equilibrium import equilibrium
from mbs.output.energy_data import with_energy
from mbs.output.results import described, run_dataset
from mbs.output.state_data import with_states
from mbs.scene.assembly import Model, law_attributes
from mbs.settings import RunUp
from mbs.transient.run import WITH_STATES, Recording
from mbs.transient.run import run as run_system


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
        Recorded states and forces, and how often each element was outside its map.
    seconds : float
        How long the integration took [s].
    dataset : xarray.Dataset
        What `mbs runup -o` writes.
    """

    model: Model
    course: RunUp
    record: Recording
    seconds: float
    dataset: xr.Dataset


def runup(model: Model, settings: RunUp | None = None, progress: Progress | None = None) -> RunUpResult:
    """Integrate the nonlinear system in time over a speed profile, from its equilibrium.

    Parameters
    ----------
    model : Model
        Scene with its law.
    settings : RunUp, optional
        Speed over time, duration and steps; [runup] of the scene if left out.
    progress : callable, optional
        Told how many steps are done, and of how many.

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
    >>> model = assemble(read_scene("nu308_rigid"))
    >>> short = dataclasses.replace(model.scene.run_up, duration=1e-3)
    >>> runup(model, short).dataset.sizes["time"]
    11
    """
    course = settings or model.scene.run_up
    if course is None:
        raise InputError(f"{model.scene.name}: [runup] missing; a run needs from, to, duration and step")
    tell, model = progress or silent, held(model)
    start = equilibrium(model.system, Operation(course.speed.at(0.0)[0]))
    steps = course.settings.steps_per_sample
    total = math.ceil(course.duration / course.settings.sample - 1e-9) * steps
    tell(0, total)
    begin = time.perf_counter()
    record = run_system(
        model.system,
        course_of(model, course),
        course.duration,
        course.settings,
        displacement=start.displacement,
        progress=lambda done: tell(done * steps, total),
        options=WITH_STATES,
    )
    seconds = time.perf_counter() - begin
    dataset = with_energy(run_dataset(model.system, record), record.energy)
    dataset = with_states(dataset, states_of(model))
    dataset = described(dataset, **law_attributes(model))
    return RunUpResult(model, course, record, seconds, dataset)
