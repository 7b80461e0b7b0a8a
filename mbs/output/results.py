"""Results of the analyses as labelled datasets with units, and how they are written."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt
import xarray as xr

from ehdmaps.arrays import ComplexArray, FloatArray
from mbs.bearings.bearing_element import RingElement, error_words, ring_matrices
from mbs.bearings.films import SIDES
from mbs.model.body import FREEDOMS
from mbs.model.elements import Input, Sensor
from mbs.model.system import System

if TYPE_CHECKING:
    from mbs.bearings.contact_report import BearingContacts, RollingLoss
    from mbs.linearised.linear import StateSpace
    from mbs.linearised.modes import Modes
    from mbs.model.equilibrium import Equilibrium
    from mbs.transient.run import Recording

BAND = "band, either way, by the errors that the map states, of"
"""How datasets call the bands; they are NaN where none is stated."""

LEFT_OUT = "what the film law with memory leaves out, true less found, to first order,"
"""How datasets call the part of the film law; it is NaN where it is not known."""

_KINDS = (("translation", "m", "displacement"), ("rotation", "rad", "rotation"), ("modal", "1", "modal amplitude"))
_UNITS = {"m": "m", "rad": "rad", "1": "1"}
_ORDERS = {"displacement": "", "velocity": "/s", "acceleration": "/s2"}


_CONTACTS = (
    ("hertz_pressure", "Pa", "largest Hertz pressure of the rollers on the raceway"),
    ("central_film", "m", "smallest central film of the rollers on the raceway; none without an oil"),
    ("minimum_film", "m", "smallest film of the rollers on the raceway; none without an oil"),
)


def statics_dataset(
    balance: Equilibrium,
    contacts: Sequence[BearingContacts] = (),
    losses: Sequence[RollingLoss] = (),
    warnings: Sequence[str] = (),
) -> xr.Dataset:
    """Equilibrium: displacements, bearing forces, K and C of the bearings, what their contacts feel and rolling costs.

    Parameters
    ----------
    balance : Equilibrium
        What is described.
    contacts : sequence of BearingContacts
        Pressures and films, one a bearing; left out if there are none.
    losses : sequence of RollingLoss
        What rolling costs, one a bearing; left out if there are none.
    warnings : sequence of str
        Why the result may not hold; becomes the attribute `warnings`.
    """
    variables = {
        **_by_kind(balance.system, balance.displacement, (), "displacement"),
        **_ring_variables(balance.system, balance.forces, ()),
    }
    bearings = balance.system.select(RingElement)
    pairs = [ring_matrices(balance.element_stiffness[i], balance.element_damping[i]) for i in bearings]
    for index, (name, unit) in enumerate((("stiffness", "N/m"), ("damping", "N s/m"))):
        rings = [pair[index] for pair in pairs]
        variables[f"bearing_{name}"] = (
            ("bearing", "freedom", "with_respect_to"),
            np.stack(rings) if rings else np.zeros((0, 6, 6)),
            {
                "units": f"{unit}, N m and rad in place of N and m for tilts",
                "long_name": f"{name} of the bearing on its inner ring",
            },
        )
    coordinates = {
        "bearing": _bearing_names(balance.system),
        "freedom": list(FREEDOMS),
        "with_respect_to": list(FREEDOMS),
    }
    if contacts:
        coordinates["contact"] = list(SIDES)
        for name, unit, words in _CONTACTS:
            values = np.stack([getattr(state, name) for state in contacts])
            variables[name] = (("bearing", "contact"), values, {"units": unit, "long_name": words})
    if losses:
        known = "none without a map with rolling forces"
        variables["rolling_torque"] = (
            "bearing",
            np.array([loss.torque for loss in losses]),
            {"units": "N m", "long_name": f"torque that rolling takes; {known}"},
        )
        variables["rolling_power"] = (
            "bearing",
            np.array([loss.total for loss in losses]),
            {"units": "W", "long_name": f"power that the films of all rollers take; {known}"},
        )
    attributes = {**_operation(balance), "warnings": "\n".join(warnings)}
    return xr.Dataset(variables, coords={**_coordinates(balance.system), **coordinates}, attrs=attributes)


def modes_dataset(found: Modes, balance: Equilibrium) -> xr.Dataset:
    """Modes: frequency, damping ratio, shapes and strain-energy shares."""
    real, imaginary = (
        _by_kind(balance.system, part.T, ("mode",), f"shape_{name}")
        for name, part in (("real", found.shapes.real), ("imaginary", found.shapes.imag))
    )
    none = np.full(found.frequency.shape, np.nan)
    frequency_band, damping_band = (none, none) if found.bands is None else found.bands
    frequency_law, damping_law = (none, none) if found.film_law is None else found.film_law
    variables = {
        "frequency": ("mode", found.frequency, {"units": "Hz", "long_name": "|eigenvalue|/(2 pi)"}),
        "damping_ratio": ("mode", found.damping_ratio, {"units": "1", "long_name": "damping ratio"}),
        "frequency_error": ("mode", frequency_band, {"units": "Hz", "long_name": f"{BAND} the frequency"}),
        "damping_ratio_error": ("mode", damping_band, {"units": "1", "long_name": f"{BAND} the damping ratio"}),
        "frequency_film_law": ("mode", frequency_law, {"units": "Hz", "long_name": f"{LEFT_OUT} of the frequency"}),
        "damping_ratio_film_law": (
            "mode",
            damping_law,
            {"units": "1", "long_name": f"{LEFT_OUT} of the damping ratio"},
        ),
        "eigenvalue_real": ("mode", found.eigenvalues.real, {"units": "1/s", "long_name": "decay"}),
        "eigenvalue_imaginary": ("mode", found.eigenvalues.imag, {"units": "rad/s", "long_name": "damped frequency"}),
        "energy_share": (
            ("part", "mode"),
            found.shares,
            {"units": "1", "long_name": "part of the strain energy of the mode"},
        ),
        **real,
        **imaginary,
    }
    coordinates = {"part": list(found.parts), "mode": np.arange(1, found.eigenvalues.size + 1)}
    return xr.Dataset(variables, coords={**_coordinates(balance.system), **coordinates}, attrs=_operation(balance))


def linear_dataset(
    balance: Equilibrium,
    space: StateSpace,
    responses: ComplexArray,
    frequencies: FloatArray,
    inputs: Sequence[Input],
    sensors: Sequence[Sensor],
    level_error: FloatArray | None = None,
) -> xr.Dataset:
    """State space and frequency responses.

    Parameters
    ----------
    balance : Equilibrium
        The equilibrium.
    space : StateSpace
        State space about it.
    responses : ndarray
        Shape (frequencies, sensors, inputs).
    frequencies : ndarray
        [Hz].
    inputs : sequence of Input
        Inputs, where forces act.
    sensors : sequence of Sensor
        Sensors, where motion is measured.
    level_error : ndarray, optional
        Bands of the levels [dB], in the shape of the responses; NaN if left out.
    """
    names = list(balance.system.coordinates)
    films = space.A.shape[0] - 2 * len(names)
    states = [*names, *(f"{name}.rate" for name in names), *(f"film_{index + 1}" for index in range(films))]
    dims = ("frequency", "sensor", "input")
    quantities = [sensor.quantity for sensor in sensors]
    units = "m, m/s or m/s2 by the sensor's quantity (rad for rotations), per N or N m"
    variables = {
        "response_real": (dims, responses.real, {"units": units, "long_name": "real part of the response"}),
        "response_imaginary": (dims, responses.imag, {"units": units, "long_name": "imaginary part of the response"}),
        "response_level_error": (
            dims,
            np.full(responses.shape, np.nan) if level_error is None else level_error,
            {"units": "dB", "long_name": f"{BAND} the level of the response"},
        ),
        "A": (("state", "of_state"), space.A, {"units": "SI", "long_name": "system matrix"}),
        "B": (("state", "input"), space.B, {"units": "SI", "long_name": "input matrix"}),
        "C": (("sensor", "of_state"), space.C, {"units": "SI", "long_name": "output matrix"}),
        "D": (("sensor", "input"), space.D, {"units": "SI", "long_name": "feedthrough"}),
        "quantity": ("sensor", quantities, {"long_name": "what the sensor measures"}),
        "amplitude": (
            "input",
            [entry.amplitude for entry in inputs],
            {"units": "N or N m", "long_name": "amplitude in operation"},
        ),
    }
    coordinates = {
        "frequency": ("frequency", frequencies, {"units": "Hz", "long_name": "frequency"}),
        "sensor": [sensor.name for sensor in sensors],
        "input": [entry.name for entry in inputs],
        "state": states,
        "of_state": states,
    }
    return xr.Dataset(variables, coords=coordinates, attrs=_operation(balance))


def run_dataset(system: System, run: Recording) -> xr.Dataset:
    """Trajectory of a run: motion of all coordinates, and forces of the bearings.

    Parameters
    ----------
    system : System
        Whose run it is.
    run : Recording
        What was recorded, with the states.
    """
    variables: dict[str, Any] = {
        "speed": ("time", run.speed, {"units": "rad/s", "long_name": "speed of the system"}),
        "angle": ("time", run.angle, {"units": "rad", "long_name": "angle turned"}),
        **_ring_variables(system, run.forces, ("time",)),
    }
    for order, values in (
        ("displacement", run.states.displacement),
        ("velocity", run.states.velocity),
        ("acceleration", run.states.acceleration),
    ):
        variables |= _by_kind(system, values, ("time",), order)
    names = _bearing_names(system)
    variables["outside_calls"] = (
        "bearing",
        np.array([run.outside[str(name)] for name in names], dtype=np.int64),
        {"units": "1", "long_name": "law calls outside the map"},
    )
    coordinates = {
        "time": ("time", run.time, {"units": "s", "long_name": "time"}),
        "bearing": names,
    }
    attributes = {"steps": run.steps, "steps_halved": run.halved, "newton_iterations": run.iterations}
    return xr.Dataset(variables, coords={**_coordinates(system), **coordinates}, attrs=attributes)


def _by_kind(system: System, values: FloatArray, dims: tuple[str, ...], order: str) -> dict[str, Any]:
    """Variables of a quantity of all coordinates, apart by unit; the last axis is that of the coordinates."""
    found = {}
    units = np.array(system.units)
    for dim, unit, words in _KINDS:
        here = units == unit
        if here.any():
            per = _ORDERS.get(order, "")
            shape = order.startswith("shape")
            name = order if dim == "translation" else f"{dim}_{order}"
            if dim == "rotation" and order == "displacement":
                name = "rotation"
            found[name] = (
                (*dims, f"{dim}_coordinate"),
                values[..., here],
                {
                    "units": f"{unit}, scaled" if shape else f"{unit}{per}",
                    "long_name": f"{order.replace('_', ' ')}, {words}" if shape or per else words,
                },
            )
    return found


def _coordinates(system: System) -> dict[str, Any]:
    """Names of the coordinates, apart by unit."""
    names, units = np.array(system.coordinates), np.array(system.units)
    return {f"{dim}_coordinate": names[units == unit].tolist() for dim, unit, _ in _KINDS if (units == unit).any()}


def _ring_variables(
    system: System, forces: Sequence[FloatArray], dims: tuple[str, ...]
) -> dict[str, tuple[tuple[str, ...], FloatArray, dict[str, str]]]:
    """Force and moment of the bearings on their inner rings."""
    bearings = system.select(RingElement)
    if not bearings:
        return {}
    rings = np.stack([forces[i][..., :6] for i in bearings], axis=len(dims))
    return {
        name: (
            (*dims, "bearing", "direction"),
            rings[..., part],
            {"units": unit, "long_name": f"{name.split('_')[1]} of the bearing on its inner ring: x, y, z"},
        )
        for name, unit, part in (("bearing_force", "N", slice(0, 3)), ("bearing_moment", "N m", slice(3, 6)))
    }


def _bearing_names(system: System) -> npt.NDArray[np.str_]:
    """Names of the bearings; texts also where there is none."""
    return np.array([system.elements[i].element.name for i in system.select(RingElement)], dtype=np.str_)


def _operation(balance: Equilibrium) -> dict[str, Any]:
    """Speed and quality of an equilibrium."""
    return {
        "speed_rad_per_s": balance.operation.speed,
        "angle_rad": balance.operation.angle,
        "bands": error_words(balance.system),
        "residual": balance.residual,
        "newton_steps": balance.steps,
    }
