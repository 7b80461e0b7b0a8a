"""Critical speeds and responses to orders as a labelled dataset."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import xarray as xr

from ehdmaps.arrays import ComplexArray, FloatArray
from mbs.linearised.critical import CriticalSpeed, OrderResponse, orbit, turning_places
from mbs.linearised.sweep_result import Sweep
from mbs.model.elements import Sensor
from mbs.model.system import System

_DIFFERENTIATED = {"displacement": 0, "velocity": 1, "acceleration": 2}
_RESPONSE_UNITS = "m, m/s or m/s2 by the sensor's quantity (rad for rotations)"


def sensed(system: System, sensors: Sequence[Sensor], speeds: FloatArray, response: OrderResponse) -> ComplexArray:
    """Amplitudes of all sensors, shape (speeds, sensors): the signal is Re[amplitude exp(i order angle)].

    Parameters
    ----------
    system : System
        The system.
    sensors : sequence of Sensor
        What is sensed.
    speeds : array, shape (speeds,)
        Speeds of the response [rad/s].
    response : OrderResponse
        The response.
    """
    found = np.zeros((speeds.size, len(sensors)), dtype=np.complex128)
    for index, sensor in enumerate(sensors):
        row = sensor.direction @ system.relative(sensor.on, sensor.against)
        rate = (1j * response.order * speeds) ** _DIFFERENTIATED[sensor.quantity]
        found[:, index] = rate * (response.motion @ row)
    return found


def orbits(system: System, response: OrderResponse) -> tuple[tuple[str, ...], FloatArray]:
    """Orbits of the places of turning bodies.

    Parameters
    ----------
    system : System
        The system.
    response : OrderResponse
        The response.

    Returns
    -------
    places, axes : tuple of str, array (speeds, places, 2)
        Names of the places; semi-axes [m], the minor one negative where a place goes from z to y.
    """
    places = [place for place, _ in turning_places(system)]
    axes = [orbit(*(response.motion @ system.relative(place)[1:3].T).T) for place in places]
    return tuple(places), np.moveaxis(np.array(axes).reshape(len(places), 2, -1), -1, 0)


def critical_dataset(
    system: System,
    sensors: Sequence[Sensor],
    sweep: Sweep,
    found: Sequence[CriticalSpeed],
    speeds: FloatArray,
    responses: Sequence[OrderResponse],
) -> xr.Dataset:
    """Critical speeds, damped modes over speed, and responses over speed.

    Parameters
    ----------
    system : System
        The system.
    sensors : sequence of Sensor
        What is sensed.
    sweep : Sweep
        Modes over speed.
    found : sequence of CriticalSpeed
        Critical speeds.
    speeds : array, shape (speeds,)
        Speeds of the responses [rad/s].
    responses : sequence of OrderResponse
        One an order.
    """

    def column(unit: str, words: str, values: Sequence[float]) -> tuple[str, FloatArray, dict[str, str]]:
        return "critical", np.array(values, dtype=np.float64), {"units": unit, "long_name": words}

    variables = {
        "critical_speed": column("rad/s", "critical speed of the system", [entry.speed for entry in found]),
        "critical_order": column("1", "order that meets the mode", [entry.order for entry in found]),
        "critical_frequency": column(
            "Hz", "frequency of the damped oscillation", [entry.eigenvalue.imag / (2.0 * np.pi) for entry in found]
        ),
        "critical_damping_ratio": column("1", "damping ratio of the mode", [entry.damping_ratio for entry in found]),
        "critical_whirl": column(
            "1", "direction of whirl: 1 with the spin on circles, -1 against it, 0 in a plane",
            [entry.whirl for entry in found],
        ),
        "damped_frequency": (
            ("sweep_speed", "complex_mode"),
            sweep.damped.eigenvalues.imag / (2.0 * np.pi),
            {"units": "Hz", "long_name": "frequency of the damped oscillation; none where overdamped"},
        ),
        "damping_ratio": (
            ("sweep_speed", "complex_mode"),
            sweep.damped.damping_ratio,
            {"units": "1", "long_name": "damping ratio of the complex mode"},
        ),
    }  # fmt: skip
    coordinates = {
        "sweep_speed": ("sweep_speed", sweep.speeds, {"units": "rad/s", "long_name": "speed of the system"}),
        "speed": ("speed", speeds, {"units": "rad/s", "long_name": "speed of the system"}),
        "order": ("order", [entry.order for entry in responses], {"units": "1", "long_name": "order of the loads"}),
        "sensor": [sensor.name for sensor in sensors],
    }
    if responses:
        seen = np.array([sensed(system, sensors, speeds, entry) for entry in responses])
        dims = ("order", "speed", "sensor")
        for name, part in (("real", seen.real), ("imag", seen.imag)):
            words = f"{name} part of the amplitude: the signal is Re[amplitude exp(i order angle)]"
            variables[f"response_{name}"] = (dims, part, {"units": _RESPONSE_UNITS, "long_name": words})
        ellipses = [orbits(system, entry) for entry in responses]
        coordinates["place"] = list(ellipses[0][0])
        axes = np.array([part for _, part in ellipses])
        for index, name in enumerate(("major", "minor")):
            words = f"{name} semi-axis of the orbit" + (", negative from z to y" if index else "")
            variables[f"orbit_{name}"] = (
                ("order", "speed", "place"), axes[..., index], {"units": "m", "long_name": words},
            )  # fmt: skip
        coordinates["element"] = [connected.element.name for connected in system.elements]
        sizes = np.array([orbit(entry.forces[..., 0], entry.forces[..., 1])[0] for entry in responses])
        variables["element_force"] = (
            ("order", "speed", "element"),
            sizes,
            {"units": "N", "long_name": "largest radial force of a bearing or table over a turn, without its mean"},
        )
    return xr.Dataset(variables, coords=coordinates, attrs={"loads": _loads(responses)})


def _loads(responses: Sequence[OrderResponse]) -> str:
    """Which loads belong to each order."""
    return "; ".join(f"order {entry.order:g}: {', '.join(entry.names)}" for entry in responses)
