"""Modes, bearings and frequency responses over speed, of one or more models."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import xarray as xr

from ehdmaps.errors import AnalysisError, InputError
from mbs.analyses.case import Case, as_cases
from mbs.analyses.losses import losses_over_speed
from mbs.analyses.operating import operating, states_of
from mbs.analyses.progress import Progress, silent
from mbs.analyses.side_by_side import Failed, side_by_side
from mbs.linearised.sweep import sweep as sweep_system
from mbs.linearised.sweep_result import Sweep
from mbs.output.files import described
from mbs.output.results import with_states
from mbs.output.sweep_data import sweep_dataset
from mbs.scene.assembly import Model, law_attributes, supply_attributes
from mbs.scene.scene import Scene
from mbs.settings import SweepRange


@dataclass(frozen=True)
class SweepSettings:
    """Over what is swept.

    Attributes
    ----------
    speeds : SweepRange or None
        None for [sweep] of the scene.
    cage_angles : int
        Angles within one pitch of the rollers over which stiffness and damping of the bearings are averaged, for
        modes and responses too.
    """

    speeds: SweepRange | None = None
    cage_angles: int = 1


@dataclass(frozen=True, eq=False)
class SweepResult:
    """Sweeps of one or more models over the same speeds.

    Attributes
    ----------
    cases : tuple of Case
        The models with their labels.
    sweeps : tuple of Sweep
        One a case.
    outside : tuple of mapping of str to int
        Number of speeds at which each bearing lies outside the map, one a case.
    dataset : xarray.Dataset
        What `mbs sweep -o` writes.
    """

    cases: tuple[Case, ...]
    sweeps: tuple[Sweep, ...]
    outside: tuple[Mapping[str, int], ...]
    dataset: xr.Dataset


def sweep(
    models: Model | Case | Sequence[Model | Case],
    settings: SweepSettings | None = None,
    progress: Progress | None = None,
    workers: int = 1,
) -> SweepResult:
    """Sweep over speed.

    Parameters
    ----------
    models : Model, Case, or a sequence of them
        One scene with one or more laws, clearances or loads.
    settings : SweepSettings, optional
        Speeds and cage angles; the speeds of the scene at one angle if left out.
    progress : callable, optional
        Told how many models are done, and of how many.
    workers : int
        Number of processes among which the models are divided.

    Raises
    ------
    InputError
        If there are no speeds, or what is asked for is more than memory should hold.
    AnalysisError
        If there is no equilibrium at a speed.

    Examples
    --------
    >>> from mbs import SweepRange, SweepSettings, assemble, read_scene, sweep
    >>> model = assemble(read_scene("nu308_rigid"))
    >>> found = sweep(model, SweepSettings(SweepRange(100.0, 200.0, 3)))
    >>> dict(found.dataset.sizes)["speed"]
    3
    """
    cases = as_cases(models)
    settings = settings or SweepSettings()
    speeds = settings.speeds or cases[0].model.scene.sweep
    if speeds is None:
        raise InputError(sweep_problems(cases[0].model.scene))
    tell = progress or silent
    tell(0, len(cases))
    found: list[Sweep] = []
    for entry in side_by_side(
        lambda index, _: _one(cases[index], speeds, settings.cage_angles),
        [1] * len(cases),
        workers,
        lambda done: tell(done, len(cases)),
        lambda index: cases[index].label,
    ):
        if isinstance(entry, Failed):
            raise entry.error
        found.append(entry)
    outside = tuple({name: int(np.count_nonzero(there)) for name, there in entry.outside.items()} for entry in found)
    return SweepResult(cases, tuple(found), outside, _dataset(cases, found))


def sweep_problems(scene: Scene) -> list[str]:
    """What a scene lacks for a sweep without speeds of its own.

    Parameters
    ----------
    scene : Scene
        The scene.
    """
    if scene.sweep is not None:
        return []
    return [
        f'{scene.name}: no speeds; allowed: --speeds "500 rpm" "2500 rpm" 40, or a table [sweep] in the scene with '
        "from, to and points"
    ]


def _one(case: Case, speeds: SweepRange, cage_angles: int) -> Sweep:
    """Sweep one model."""
    scene = case.model.scene
    try:
        return sweep_system(
            lambda speed: operating(case.model, speed).system,
            speeds.speeds,
            0.0,
            scene.inputs,
            scene.sensors,
            np.array(scene.frequencies),
            cage_angles,
        )
    except AnalysisError as error:
        raise AnalysisError(f"{case.label}: {error}") from error


def _dataset(cases: Sequence[Case], found: Sequence[Sweep]) -> xr.Dataset:
    """All sweeps, with what the law of each is."""
    dataset = sweep_dataset(
        found,
        [case.label for case in cases],
        [case.model.law for case in cases],
        [case.clearance for case in cases],
        [case.load_factor for case in cases],
    )
    named = [f"{case.label}: {case.model.law}" for case in cases] if len(cases) > 1 else [cases[0].model.law]
    models = [[operating(case.model, speed) for speed in found[0].speeds.tolist()] for case in cases]
    losses = [
        losses_over_speed(there, entry.speeds, entry.displacement) for there, entry in zip(models, found, strict=True)
    ]
    for name, unit, words, part in (
        ("rolling_torque", "N m", "torque that rolling takes", 0),
        ("rolling_power", "W", "power that the films of all rollers take", 1),
    ):
        values = np.stack([both[part] for both in losses])
        attributes = {"units": unit, "long_name": f"{words}; none without a map with rolling forces"}
        dataset[name] = (("case", "speed", "bearing"), values, attributes)
    supplies = supply_attributes([(case.label, case.model) for case in cases])
    dataset = with_states(dataset, [[states_of(there) for there in row] for row in models], ("case", "speed"))
    return described(dataset, **{**law_attributes(cases[0].model), "law": "; ".join(named), **supplies})
