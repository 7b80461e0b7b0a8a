"""Critical speeds of a scene, and its response to unbalances and orders over speed."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import xarray as xr

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import AnalysisError, InputError
from mbs.analyses.operating import operating
from mbs.analyses.sweep import SweepSettings
from mbs.linearised.critical import (
    CriticalSpeed,
    OrderResponse,
    critical_speeds,
    order_responses,
    turning_places,
    with_critical,
)
from mbs.linearised.sweep import sweep as sweep_system
from mbs.linearised.sweep_result import Sweep
from mbs.model.system import System
from mbs.output.files import described
from mbs.output.sweep_data import critical_dataset
from mbs.scene.assembly import Model, law_attributes, laws_attributes


@dataclass(frozen=True, eq=False)
class CriticalResult:
    """Critical speeds and responses of a model.

    Attributes
    ----------
    model : Model
        Scene with its law.
    sweep : Sweep
        Modes over the speeds that were asked for.
    found : tuple of CriticalSpeed
        Critical speeds, for each order in turn.
    speeds : array, shape (speeds,)
        Speeds of the responses: those of the sweep, and some around each critical one, of all laws [rad/s].
    responses : tuple of OrderResponse
        Response to all loads of each order; none without unbalances and excitations.
    dataset : xarray.Dataset
        What `mbs critical -o` writes.
    """

    model: Model
    sweep: Sweep
    found: tuple[CriticalSpeed, ...]
    speeds: FloatArray
    responses: tuple[OrderResponse, ...]
    dataset: xr.Dataset

    @property
    def outside(self) -> Mapping[str, int]:
        """Number of speeds of the sweep at which each bearing lies outside its map."""
        return {name: int(np.count_nonzero(there)) for name, there in self.sweep.outside.items()}


def critical(model: Model, settings: SweepSettings | None = None) -> CriticalResult:
    """Find critical speeds, and the response to unbalances and excitations by orders over speed.

    Parameters
    ----------
    model : Model
        Scene with its law.
    settings : SweepSettings, optional
        Settings with the speeds; those of [sweep] of the scene if left out.

    Raises
    ------
    InputError
        If there are no speeds, or no body spins.
    AnalysisError
        If there is no equilibrium at a speed.

    Notes
    -----
    Orders are those of the unbalances and excitations, and without any the spins of the bodies. Cages stand at their
    start angles, gear meshes have their mean stiffness.

    Examples
    --------
    >>> from mbs import SweepRange, SweepSettings, assemble, critical, read_scene
    >>> model = assemble(read_scene("nu308_rigid"))
    >>> found = critical(model, SweepSettings(SweepRange(100.0, 200.0, 3)))
    >>> found.dataset.sizes["critical"]
    0
    """
    return critical_of([model], settings)[0]


def critical_of(models: Sequence[Model], settings: SweepSettings | None = None) -> list[CriticalResult]:
    """Find critical speeds and responses of one scene with several laws, responses at the same speeds.

    Parameters
    ----------
    models : sequence of Model
        Scene with each law. Speeds around the critical ones of any of them are added for all.
    settings : SweepSettings, optional
        Settings with the speeds; those of [sweep] of the scene if left out.

    Raises
    ------
    InputError
        If there are no speeds, or no body spins.
    AnalysisError
        If there is no equilibrium at a speed.
    """
    found = [_swept(model, settings or SweepSettings()) for model in models]
    refined = np.unique(np.concatenate([with_critical(entry.sweep.speeds, entry.found) for entry in found]))
    return [_responded(entry, refined) for entry in found]


class _Swept(NamedTuple):
    """A model with its modes over speed."""

    model: Model
    system_at: Callable[[float], System]
    sweep: Sweep
    found: tuple[CriticalSpeed, ...]


def _swept(model: Model, settings: SweepSettings) -> _Swept:
    """Modes and critical speeds of one model."""
    speeds = settings.speeds or model.scene.sweep
    if speeds is None:
        raise InputError(
            f'{model.scene.name}: no speeds; allowed: --speeds "500 rpm" "2500 rpm" 40, or a table [sweep] in the '
            "scene with from, to and points"
        )
    if not turning_places(model.system):
        raise InputError(
            f"{model.scene.name}: no body spins, so that no speed is critical; allowed: a body with a spin, such as "
            "spin = 1"
        )

    def system_at(speed: float) -> System:
        return operating(model, speed).system

    sweep = sweep_system(system_at, speeds.speeds)
    found = critical_speeds(system_at, sweep.speeds, sweep.damped, orders(model.system))
    return _Swept(model, system_at, sweep, found)


def _responded(swept: _Swept, speeds: FloatArray) -> CriticalResult:
    """The responses of one model at some speeds."""
    model, system_at, sweep, found = swept
    responses: tuple[OrderResponse, ...] = ()
    if model.system.turning:
        try:
            responses = order_responses(system_at, speeds)
        except np.linalg.LinAlgError as error:
            raise AnalysisError(
                "responses: one of the speeds is just that of an undamped resonance, where there is none; move the "
                "speeds, or add damping"
            ) from error
    dataset = critical_dataset(model.system, model.scene.sensors, sweep, found, speeds, responses)
    return CriticalResult(model, sweep, found, speeds, responses, described(dataset, **law_attributes(model)))


def dataset_of_laws(labels: Sequence[str], results: Sequence[CriticalResult]) -> xr.Dataset:
    """What `mbs critical -o` writes: of one law its result, of several all of them over the dim law.

    There are as many critical speeds as the law with most of them has; what a law has not is not a number.

    Parameters
    ----------
    labels : sequence of str
        What each is called.
    results : sequence of CriticalResult
        Results of `critical_of`.
    """
    parts = [result.dataset for result in results]
    if len(parts) == 1:
        return parts[0]
    # Dims without coordinates, whose lengths differ, are numbered for the while.
    bare = {name for part in parts for name in part.dims if name not in part.coords}
    numbered = [part.assign_coords({name: np.arange(part.sizes[name]) for name in bare}) for part in parts]
    law = xr.DataArray(np.array(labels, dtype=np.str_), dims="law", name="law")
    joined = xr.concat(numbered, law, data_vars="all", join="outer", combine_attrs="override").drop_vars(list(bare))
    return joined.assign_attrs({**parts[0].attrs, **laws_attributes(labels, [result.model for result in results])})


def orders(system: System) -> tuple[float, ...]:
    """Orders for which speeds may be critical: those of the loads that turn, else the spins of the bodies.

    Parameters
    ----------
    system : System
        The system.
    """
    found = {abs(load.order) for load in system.turning} or {abs(body.spin) for body in system.bodies if body.spin}
    return tuple(sorted(order for order in found if math.isfinite(order)))
