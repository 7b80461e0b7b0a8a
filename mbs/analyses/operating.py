"""A model as it is in operation: temperatures of the raceways and clearances of its bearings at a speed.

Every analysis that takes a speed asks here before it looks for an equilibrium. A bearing whose scene states neither
temperatures nor heat nor fits stays as it is, and a model without such bearings is returned as it came.

The law of a bearing takes the mean of both raceways. Each contact lies between a raceway and a roller, whose
temperature is that mean, so that the walls of the inner contact are a quarter of the difference between the raceways
warmer than it, on average, and those of the outer contact as much colder. In series, what the film of the one is too
thin, that of the other is too thick.
"""

from __future__ import annotations

import math

from mbs.bearings.thermal import BearingState, Clearance
from mbs.scene.assembly import Model


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
