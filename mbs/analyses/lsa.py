"""State space and frequency responses of the system linearised at its equilibrium."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass

import numpy as np
import xarray as xr

from ehdmaps.arrays import ComplexArray, FloatArray
from ehdmaps.errors import InputError
from mbs.analyses.film_errors import film_errors
from mbs.analyses.operating import operating, states_of
from mbs.linearised.level_bands import level_bands
from mbs.linearised.linear import StateSpace, sensed, state_space, with_peaks
from mbs.linearised.linear import responses as responses_of
from mbs.linearised.modes import modes_of, state_modes, undamped_modes
from mbs.linearised.steady import steady_system
from mbs.linearised.validity import DynamicLoad, FilmError, dynamic_loads
from mbs.model.elements import Operation
from mbs.model.equilibrium import Equilibrium, equilibrium
from mbs.output.results import described, linear_dataset
from mbs.output.state_data import with_states
from mbs.scene.assembly import Model, law_attributes
from mbs.scene.scene import Scene


@dataclass(frozen=True)
class LsaSettings:
    """What of a linear system is computed.

    Attributes
    ----------
    frequencies : tuple of float or None
        Frequencies of the responses [Hz]; None for those of [linear] in the scene. More are added around lightly damped
        modes.
    operation : Operation or None
        Speed, angle and time of the loads; None for the operating speed of the scene.
    """

    frequencies: tuple[float, ...] | None = None
    operation: Operation | None = None


@dataclass(frozen=True, eq=False)
class LsaResult:
    """A linear system, and its responses.

    Attributes
    ----------
    model : Model
        Scene with its law.
    balance : Equilibrium
        Equilibrium at which the system was linearised, gear meshes with their mean stiffness.
    space : StateSpace
        State space from the inputs of the scene to its sensors.
    asked : int
        How many frequencies were asked for; the others are around lightly damped modes.
    frequencies : array, shape (frequencies,)
        [Hz].
    responses : array of complex, shape (frequencies, sensors, inputs)
        Responses in the unit of the sensor's quantity, per N or N m.
    level_error : array, shape (frequencies, sensors, inputs), or None
        Bands of the levels of the responses, either way [dB], from the errors that the map states; None for laws that
        state none.
    errors : tuple of FilmError
        How wrong the films of each bearing are estimated to be; empty for laws without films.
    lifting : tuple of DynamicLoad
        Loads that exceed the static ones, so that contacts lift off.
    dataset : xarray.Dataset
        What `mbs lsa -o` writes.
    """

    model: Model
    balance: Equilibrium
    space: StateSpace
    asked: int
    frequencies: FloatArray
    responses: ComplexArray
    level_error: FloatArray | None
    errors: tuple[FilmError, ...]
    lifting: tuple[DynamicLoad, ...]
    dataset: xr.Dataset


def lsa_problems(scene: Scene) -> list[str]:
    """What a scene lacks for a linear analysis.

    Parameters
    ----------
    scene : Scene
        The scene.
    """
    return [
        f"{scene.name}: {key} missing; a linear analysis needs {words}"
        for key, there, words in (
            ("[[inputs]]", scene.inputs, "at least one input"),
            ("[[sensors]]", scene.sensors, "at least one sensor"),
            ("[linear] frequencies", scene.frequencies, "frequencies"),
        )
        if not there
    ]


def lsa(model: Model, settings: LsaSettings | None = None) -> LsaResult:
    """Linearise, and compute the responses over frequency.

    Parameters
    ----------
    model : Model
        Scene with its law, with inputs and sensors.
    settings : LsaSettings, optional
        Frequencies and operation; those of the scene if left out.

    Raises
    ------
    InputError
        With everything that is missing.
    AnalysisError
        If there is no equilibrium, or its matrices are not finite.

    Examples
    --------
    >>> from mbs import LsaSettings, assemble, lsa, read_scene
    >>> found = lsa(assemble(read_scene("nu308_rigid")), LsaSettings(frequencies=(100.0, 200.0)))
    >>> found.dataset["response_real"].dims
    ('frequency', 'sensor', 'input')
    """
    settings = settings or LsaSettings()
    scene = model.scene
    asked = scene.frequencies if settings.frequencies is None else settings.frequencies
    missing = lsa_problems(dataclasses.replace(scene, frequencies=tuple(asked)))
    if missing:
        raise InputError(missing)
    operation = settings.operation or model.operation
    model = operating(model, operation.speed)
    balance = equilibrium(steady_system(model.system), operation)
    states = state_modes(balance, undamped_modes(balance))
    frequencies = with_peaks(np.array(asked), modes_of(balance, states).eigenvalues)
    motion = responses_of(balance, scene.inputs, frequencies)
    responses = sensed(balance, scene.sensors, frequencies, motion)
    level_error = level_bands(balance, states, scene.sensors, frequencies, motion, responses)
    space = state_space(balance, scene.inputs, scene.sensors)
    lifting = tuple(load for load in dynamic_loads(balance, scene.inputs, frequencies, motion) if load.exceeds)
    dataset = linear_dataset(balance, space, responses, frequencies, scene.inputs, scene.sensors, level_error)
    return LsaResult(
        model=model,
        balance=balance,
        space=space,
        asked=len(asked),
        frequencies=frequencies,
        responses=responses,
        level_error=level_error,
        errors=tuple(film_errors(model, balance.displacement, balance.operation)),
        lifting=lifting,
        dataset=described(with_states(dataset, states_of(model)), **law_attributes(model)),
    )
