"""A model as it is in operation: temperatures of the raceways and clearances of its bearings, cut-offs of its shafts.

Every analysis that takes a speed asks here before it looks for an equilibrium. A bearing whose scene states neither
temperatures nor heat nor fits stays as it is, and a model without such bearings is returned as it came.

The law of a bearing takes the mean of both raceways. Each contact lies between a raceway and a roller, whose
temperature is that mean, so that the walls of the inner contact are a quarter of the difference between the raceways
warmer than it, on average, and those of the outer contact as much colder. In series, what the film of the one is too
thin, that of the other is too thick.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Sequence

import numpy as np

from ehdmaps.errors import InputError
from mbs.bearings.thermal import BearingState, Clearance
from mbs.model.elements import Operation
from mbs.model.equilibrium import equilibrium
from mbs.scene.assembly import Model, with_bodies
from mbs.scene.specs import BodySpec, ShaftSpec


def operating(model: Model, speed: float) -> Model:
    """The model with the temperatures and clearances of its bearings at a speed.

    Parameters
    ----------
    model : Model
        Scene with its law, as it was assembled; one that is in operation already is returned as it is.
    speed : float
        Speed of the system [rad/s].

    Returns
    -------
    Model
        The model with its `states`; the same model where no bearing has temperatures, heat or fits of its own. It is
        found once for each speed.

    Raises
    ------
    InputError
        For heat without friction: a law without rolling forces, where no other friction is stated in their place.
    AnalysisError
        For a bearing whose heat is not carried away, and where there is no equilibrium.

    Notes
    -----
    Temperatures belong to the cages at their start angles, the loads of time zero, and gear meshes with their mean
    stiffness. They do not follow the turning of the cage, or a motion.
    """
    if model.states or not any(spec.changes_in_operation for spec in model.scene.bearings):
        return model
    if speed not in model.found:
        from mbs.analyses.heat_balance import in_operation

        model.found[speed] = in_operation(model, speed)
    return model.found[speed]


def held(model: Model) -> Model:
    """The model for a run in time: temperatures and clearances of the operating speed, whatever the run does.

    A bearing needs minutes to warm up, a run-up takes seconds.

    Parameters
    ----------
    model : Model
        Scene with its law.
    """
    return operating(model, model.scene.speed)


def states_of(model: Model) -> tuple[BearingState, ...]:
    """Temperatures and clearances of all bearings of a model, those of the scene where it is not in operation.

    Balls, tapered rollers and rollers between ribs keep those of the scene; tapered rollers have no clearance.

    Parameters
    ----------
    model : Model
        Scene with its law.
    """
    found = model.states or tuple(
        BearingState(
            entry.name, entry.temperature, entry.temperature, Clearance(entry.bearing.geometry.diametral_clearance)
        )
        for entry in model.bearings
    )
    scene = model.scene
    clearances = {
        spec.name: math.nan if spec.geometry.clearance is None else spec.geometry.clearance for spec in scene.located
    }
    others = model.located
    kelvin = scene.temperature
    return (*found, *(BearingState(one.name, kelvin, kelvin, Clearance(clearances[one.name])) for one in others))


FELT = 5e-4
"""Part of a frequency up to which modes that are left out are not felt."""


def settled(models: Sequence[Model], speed: float, highest: float | None = None) -> list[Model]:
    """Models whose shafts without a stated cut-off have one that leaves their modes as they are.

    The cut-off is doubled until what is left out moves no undamped mode by more than `FELT`, or the theory of beams
    does not go on; all models have the same one. What remains is told with the modes (`mbs.linearised.reduction`).

    Parameters
    ----------
    models : sequence of Model
        One scene with its laws, not in operation.
    speed : float
        Speed of the system [rad/s].
    highest : float, optional
        Frequency up to which modes are looked at [Hz]; the highest of [linear] of the scene, else that of its Campbell
        diagram, if left out.

    Raises
    ------
    AnalysisError
        If there is no equilibrium.
    """
    found = list(models)
    if not any(_is_open(body) for model in models for body in model.scene.bodies):
        return found
    while max(_felt(model, speed, highest) for model in found) > FELT:
        try:
            found = [
                with_bodies(model, [_raised(body, _top(model, highest)) for body in model.scene.bodies])
                for model in found
            ]
        except InputError:  # beyond the theory of beams
            break
    return [_closed(model) for model in found]


def _top(model: Model, highest: float | None) -> float:
    """Frequency up to which modes are looked at [Hz]."""
    scene = model.scene
    return max(scene.frequencies, default=scene.campbell.highest) if highest is None else highest


def _felt(model: Model, speed: float, highest: float | None) -> float:
    """By which part of it what open shafts leave out moves a mode at most."""
    from mbs.linearised.averaged import steady_system  # statics needs nothing of them
    from mbs.linearised.modes import free_motions, undamped_modes
    from mbs.linearised.reduction import undamped_part

    top = _top(model, highest)
    balance = equilibrium(steady_system(model.system), Operation(speed))
    modes = undamped_modes(balance)
    seen = (modes.frequency <= top) & ~free_motions(modes.frequency)
    shafts = [body.name for body in model.scene.bodies if _is_open(body)]
    moved = undamped_part(balance.system, modes.frequency[seen], modes.shapes[:, seen], shafts)
    return float(np.max(np.abs(moved), initial=0.0))


def _is_open(body: BodySpec) -> bool:
    """Tell whether a body is a shaft whose cut-off is not stated."""
    return isinstance(body, ShaftSpec) and not body.cutoff_stated


def _raised(body: BodySpec, highest: float) -> BodySpec:
    """An open shaft with twice its cut-off; other bodies as they are.

    Where that takes too many elements they are as long as the waves of the highest frequency that is looked at allow:
    of modes above, what is static counts.
    """
    if not (isinstance(body, ShaftSpec) and not body.cutoff_stated and body.cutoff is not None):
        return body
    try:
        return dataclasses.replace(body, cutoff=2.0 * body.cutoff)
    except InputError:
        from mbs.flexible.shaft_parts import longest_element

        longest = body.largest_element or longest_element(body.sections, highest)
        return dataclasses.replace(body, cutoff=2.0 * body.cutoff, largest_element=longest)


def _closed(model: Model) -> Model:
    """The model with the cut-offs that it has as if they were stated."""
    bodies = [
        dataclasses.replace(body, cutoff_stated=True) if isinstance(body, ShaftSpec) else body
        for body in model.scene.bodies
    ]
    return dataclasses.replace(model, scene=dataclasses.replace(model.scene, bodies=bodies))
