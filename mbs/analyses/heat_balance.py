"""Temperatures of the raceways and clearances of the bearings of a model at which all heat is carried away."""

from __future__ import annotations

import dataclasses
import math
from typing import Any

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import AnalysisError, InputError
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.units import RPM, TEMPERATURE
from mbs.analyses.losses import contacts_and_losses
from mbs.bearings.bearing_element import BearingElement
from mbs.bearings.contact_report import RollingLoss, load_torque, viscous_torque
from mbs.bearings.thermal import (
    BearingHeat,
    BearingState,
    HeatPaths,
    Mounting,
    heat_of_contacts,
    operating_clearance,
    steady_temperatures,
)
from mbs.linearised.averaged import steady_system
from mbs.model.elements import Operation
from mbs.model.equilibrium import equilibrium
from mbs.scene.assembly import Model
from mbs.scene.specs import BearingSpec


def in_operation(model: Model, speed: float) -> Model:
    """The model with the temperatures and clearances of its bearings at a speed; see `mbs.analyses.operating`.

    Parameters
    ----------
    model : Model
        Scene with its law, as it was assembled.
    speed : float
        Speed of the system [rad/s].

    Raises
    ------
    InputError
        For heat without friction.
    AnalysisError
        For a bearing whose heat is not carried away, and where there is no equilibrium.
    """
    paths = {
        index: spec.thermal.within(model.scene.temperature)
        for index, spec in enumerate(model.scene.bearings)
        if isinstance(spec.thermal, HeatPaths)
    }
    raceways = np.array([_given(spec, model.scene.temperature) for spec in model.scene.bearings])
    if not paths:
        return _moved(model, raceways)
    try:
        return _balanced(model, Operation(speed), paths, raceways)
    except AnalysisError as error:
        raise AnalysisError(f"heat of the bearings at {RPM.text(speed)}: {error}") from error


def _balanced(model: Model, operation: Operation, paths: dict[int, HeatPaths], raceways: FloatArray) -> Model:
    """The model at the temperatures (bearings, 2) [K] of the raceways at which all heat is carried away."""
    here = list(paths)
    start: list[FloatArray] = []
    friction: dict[int, tuple[float, float, float]] = {}

    def heat(temperatures: FloatArray) -> FloatArray:
        raceways[here] = temperatures
        moved = _moved(model, raceways)
        system = steady_system(moved.system)
        balance = equilibrium(system, operation, start[-1] if start else None)
        start[:] = [balance.displacement]
        losses = [loss for _, loss in contacts_and_losses(moved, balance.displacement, operation)]
        for index in here:
            load = float(np.hypot(*balance.forces[index][1:3]))
            friction[index] = _friction(moved, index, paths[index], losses[index], load)
        return np.array([heat_of_contacts(*friction[index]) for index in here])

    names = [model.bearings[index].name for index in here]
    found = steady_temperatures(names, [paths[index] for index in here], heat)
    heat(found)
    return _moved(model, raceways, paths, friction)


def _friction(model: Model, index: int, paths: HeatPaths, loss: RollingLoss, load: float) -> tuple[float, float, float]:
    """Friction of the inner and of the outer contacts, and what is added [W]."""
    bearing = model.bearings[index]
    geometry, ring_speed = bearing.bearing.geometry, loss.ring_speed
    if ring_speed == 0.0:
        return 0.0, 0.0, 0.0
    added = load_torque(paths.load_friction, load, geometry.pitch_diameter) * ring_speed + paths.constant_power
    if paths.palmgren is None:
        inner, outer = loss.power.sum(axis=1).tolist()
        if not math.isfinite(inner + outer):
            raise InputError(
                f"bearing {bearing.name!r}, thermal: the law {model.law!r:.80} knows no rolling force at "
                f"{TEMPERATURE.text(bearing.temperature)}, so that its friction is not known; allowed: a map that has "
                "rolling forces; or palmgren = 2 or another factor f0; or inner_ring and outer_ring"
            )
        return inner, outer, added
    torque = viscous_torque(paths.palmgren, _viscosity(model, bearing), ring_speed, geometry.pitch_diameter)
    return 0.5 * torque * ring_speed, 0.5 * torque * ring_speed, added


def _viscosity(model: Model, bearing: BearingElement) -> float:
    """Kinematic viscosity of the oil at the temperature of a bearing [m2/s]."""
    oil: Lubricant | None = bearing.lubricant or model.scene.lubricant
    if oil is None:
        raise InputError(
            f"bearing {bearing.name!r}, thermal: palmgren needs an oil; allowed: with --map, or a table [lubricant]"
        )
    try:
        state = oil.at(bearing.temperature)
    except InputError as error:
        raise AnalysisError(f"bearing {bearing.name!r}: {error}") from error
    return state.viscosity / state.density


def _given(spec: BearingSpec, temperature: float) -> tuple[float, float]:
    """Temperatures of the raceways of a bearing [K], of the scene where it has none."""
    if spec.thermal is None or isinstance(spec.thermal, HeatPaths):
        return temperature, temperature
    inner, outer = spec.thermal.inner, spec.thermal.outer
    return temperature if inner is None else inner, temperature if outer is None else outer


def _moved(
    model: Model,
    raceways: FloatArray,
    paths: dict[int, HeatPaths] | None = None,
    friction: dict[int, tuple[float, float, float]] | None = None,
) -> Model:
    """The model with raceways (bearings, 2) of these temperatures [K], and what is known of its heat."""
    elements: list[Any] = [connected.element for connected in model.system.elements]
    bearings, states = list(model.bearings), []
    for index, (spec, bearing) in enumerate(zip(model.scene.bearings, model.bearings, strict=True)):
        state = _state(spec, bearing, raceways[index])
        if paths is not None and friction is not None and index in paths:
            inner, outer, added = friction[index]
            flows = paths[index].flows(raceways[index])
            oil = paths[index].oil_temperature(raceways[index])
            state = dataclasses.replace(state, oil=oil, heat=BearingHeat(inner + outer, added, *flows))
        states.append(state)
        if spec.changes_in_operation:
            geometry = dataclasses.replace(bearing.bearing.geometry, diametral_clearance=state.clearance.operating)
            other = dataclasses.replace(bearing.bearing, geometry=geometry)
            elements[index] = elements[index].in_state(other, state.film_temperature)
            bearings[index] = elements[index].plain
    return dataclasses.replace(
        model,
        system=model.system.with_elements(elements),
        bearings=tuple(bearings),
        states=tuple(states),
    )


def _state(spec: BearingSpec, bearing: BearingElement, raceways: FloatArray) -> BearingState:
    """A bearing at the temperatures (2,) [K] of its raceways."""
    inner, outer = raceways.tolist()
    mounting = spec.mounting or Mounting()
    clearance = operating_clearance(spec.geometry, mounting, inner, outer, bearing.bearing.material)
    if not spec.changes_in_operation:
        clearance = dataclasses.replace(clearance, by_temperature=0.0)
    return BearingState(spec.name, inner, outer, clearance)
