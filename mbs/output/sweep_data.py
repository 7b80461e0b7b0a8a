"""Results over speed as labelled datasets: a sweep, critical speeds, responses to orders."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt
import xarray as xr

from ehdmaps.arrays import ComplexArray, FloatArray
from mbs.linearised.critical import CriticalSpeed, OrderResponse, orbit, turning_places
from mbs.linearised.sweep_result import Sweep
from mbs.model.elements import Sensor
from mbs.model.system import System
from mbs.output.results import BAND, REDUCED

_Entry = tuple[tuple[str, ...], Any, dict[str, str]]
"""A variable as xarray takes it."""

UNDAMPED = ("case", "speed", "mode")
DAMPED = ("case", "speed", "complex_mode")
BEARING = ("case", "speed", "bearing")
RESPONSE = ("case", "speed", "response_frequency", "sensor", "input")
PEAK = ("case", "speed", "response_peak", "sensor", "input")

RESPONSE_UNITS = "m, m/s or m/s2 by the sensor's quantity (rad for rotations), per N, N m or m"


@dataclass(frozen=True)
class Variable:
    """One variable of the dataset.

    Attributes
    ----------
    name, units, long_name : str
        Name, units and meaning, written to the file.
    dims : tuple of str
        Dims of the variable, the cases first.
    read : callable
        Takes it from the sweep of one case, in the order of the other dims.
    """

    name: str
    units: str
    long_name: str
    dims: tuple[str, ...]
    read: Callable[[Sweep], npt.ArrayLike]

    def entry(self, sweeps: Sequence[Sweep]) -> _Entry:
        """Return the variable of some cases side by side; complex modes and peaks beyond those of a case are NaN."""
        values = [np.asarray(self.read(sweep)) for sweep in sweeps]
        for own in {"complex_mode", "response_peak"}.intersection(self.dims):
            values = _filled(values, self.dims.index(own) - 1)
        return self.dims, np.stack(values), _said(self.units, self.long_name)


VARIABLES = (
    Variable(
        "frequency",
        "Hz",
        "frequency of mass and stiffness, without damping and gyroscopic terms",
        UNDAMPED,
        lambda sweep: sweep.undamped.frequency,
    ),
    Variable("frequency_error", "Hz", f"{BAND} the frequency", UNDAMPED, lambda sweep: sweep.undamped.frequency_error),
    Variable(
        "frequency_spread",
        "Hz",
        "half of what the frequency varies over the cage angles, to first order",
        UNDAMPED,
        lambda sweep: sweep.undamped.frequency_spread,
    ),
    Variable("damping_ratio", "1", "modal damping ratio", UNDAMPED, lambda sweep: sweep.undamped.damping_ratio),
    Variable(
        "energy_share",
        "1",
        "part of the strain energy of the mode",
        ("case", "part", "speed", "mode"),
        lambda sweep: sweep.undamped.shares,
    ),
    Variable(
        "bearing_share",
        "1",
        "part of the strain energy in all bearings",
        UNDAMPED,
        lambda sweep: sweep.undamped.bearing_share,
    ),
    Variable(
        "assurance",
        "1",
        "modal assurance on the way from the speed before",
        UNDAMPED,
        lambda sweep: sweep.undamped.assurance,
    ),
    Variable(
        "summed_shift",
        "1",
        "change of the frequency from the first speed by energy, summed over the steps",
        UNDAMPED,
        lambda sweep: sweep.undamped.summed_shift,
    ),
    Variable(
        "direct_shift",
        "1",
        "change of the frequency from first to last speed by energy, in one step",
        ("case", "mode"),
        lambda sweep: sweep.undamped.direct_shift,
    ),
    Variable(
        "complex_frequency",
        "Hz",
        "|eigenvalue|/(2 pi) of oscillating complex modes",
        DAMPED,
        lambda sweep: sweep.damped.frequency,
    ),
    Variable(
        "complex_damping_ratio",
        "1",
        "damping ratio of complex modes",
        DAMPED,
        lambda sweep: sweep.damped.damping_ratio,
    ),
    Variable(
        "complex_frequency_error",
        "Hz",
        f"{BAND} the frequency of the complex mode",
        DAMPED,
        lambda sweep: sweep.damped.frequency_error,
    ),
    Variable(
        "complex_damping_ratio_error",
        "1",
        f"{BAND} the damping ratio of the complex mode",
        DAMPED,
        lambda sweep: sweep.damped.damping_ratio_error,
    ),
    Variable(
        "complex_frequency_reduction",
        "Hz",
        f"{REDUCED} of the frequency of the complex mode",
        DAMPED,
        lambda sweep: sweep.damped.reduction.frequency,
    ),
    Variable(
        "complex_damping_ratio_reduction",
        "1",
        f"{REDUCED} of the damping ratio of the complex mode",
        DAMPED,
        lambda sweep: sweep.damped.reduction.damping_ratio,
    ),
    Variable(
        "complex_frequency_spread",
        "Hz",
        "half of what the frequency of the complex mode varies over the cage angles, to first order",
        DAMPED,
        lambda sweep: sweep.damped.frequency_spread,
    ),
    Variable(
        "complex_damping_ratio_spread",
        "1",
        "half of what the damping ratio of the complex mode varies over the cage angles, to first order",
        DAMPED,
        lambda sweep: sweep.damped.damping_ratio_spread,
    ),
    Variable("eigenvalue_real", "1/s", "decay", DAMPED, lambda sweep: sweep.damped.eigenvalues.real),
    Variable(
        "eigenvalue_imaginary",
        "rad/s",
        "damped frequency",
        DAMPED,
        lambda sweep: sweep.damped.eigenvalues.imag,
    ),
    Variable(
        "complex_energy_share",
        "1",
        "part of the strain energy of the complex mode",
        ("case", "part", "speed", "complex_mode"),
        lambda sweep: sweep.damped.shares,
    ),
    Variable(
        "complex_bearing_share",
        "1",
        "part of the strain energy of the complex mode in all bearings",
        DAMPED,
        lambda sweep: sweep.damped.bearing_share,
    ),
    Variable(
        "whirl",
        "1",
        "d omega/d Omega by gyroscopic terms: positive forward, negative backward",
        DAMPED,
        lambda sweep: sweep.damped.whirl,
    ),
    Variable(
        "complex_assurance",
        "1",
        "assurance of the complex mode on the way from the speed before",
        DAMPED,
        lambda sweep: sweep.damped.assurance,
    ),
    Variable(
        "complex_number",
        "1",
        "number of the undamped mode that the complex one is nearest to where it begins",
        ("case", "complex_mode"),
        lambda sweep: sweep.damped.number + 1.0,
    ),
    Variable(
        "resembles",
        "1",
        "number of the mode whose shape at the last speed is most like that of this one at the first",
        ("case", "mode"),
        lambda sweep: sweep.undamped.resembles + 1.0,
    ),
    Variable("bearing_load", "N", "radial force", BEARING, lambda sweep: sweep.bearings.load),
    Variable(
        "bearing_stiffness",
        "N/m",
        "stiffness of the bearing along its force",
        BEARING,
        lambda sweep: sweep.bearings.stiffness,
    ),
    Variable(
        "bearing_damping",
        "N s/m",
        "damping of the bearing along its force",
        BEARING,
        lambda sweep: sweep.bearings.damping,
    ),
    Variable(
        "bearing_stiffness_error",
        "N/m",
        f"{BAND} the stiffness",
        BEARING,
        lambda sweep: sweep.bearings.stiffness_error,
    ),
    Variable(
        "bearing_damping_error",
        "N s/m",
        f"{BAND} the damping",
        BEARING,
        lambda sweep: sweep.bearings.damping_error,
    ),
    Variable(
        "bearing_stiffness_spread",
        "1",
        "half of what the stiffness varies over the cage angles, as a part of the mean",
        BEARING,
        lambda sweep: sweep.bearings.stiffness_spread,
    ),
    Variable(
        "bearing_damping_spread",
        "1",
        "half of what the damping varies over the cage angles, as a part of the mean",
        BEARING,
        lambda sweep: sweep.bearings.damping_spread,
    ),
    Variable("between", "1", "speeds put in between to follow the modes", ("case",), lambda sweep: sweep.between),
)
"""Of every sweep."""

RESPONSES = (
    Variable(
        "response_real",
        RESPONSE_UNITS,
        "real part of the response",
        RESPONSE,
        lambda sweep: sweep.responses.values.real,
    ),
    Variable(
        "response_imaginary",
        RESPONSE_UNITS,
        "imaginary part of the response",
        RESPONSE,
        lambda sweep: sweep.responses.values.imag,
    ),
    Variable(
        "peak_frequency",
        "Hz",
        "frequency of each peak of the response, with more frequencies around lightly damped modes",
        PEAK,
        lambda sweep: sweep.responses.peak_frequency,
    ),
    Variable("peak_size", RESPONSE_UNITS, "size of each peak", PEAK, lambda sweep: sweep.responses.peak_size),
    Variable(
        "response_error",
        "1",
        "largest relative error seen beside direct solutions",
        ("case", "speed"),
        lambda sweep: sweep.responses.error,
    ),
)
"""Of a sweep with inputs, sensors and frequencies."""


def sweep_dataset(
    sweeps: Sequence[Sweep],
    labels: Sequence[str],
    laws: Sequence[str],
    clearances: Sequence[float],
    load_factors: Sequence[float],
) -> xr.Dataset:
    """Sweeps of one scene at the same speeds, side by side.

    Parameters
    ----------
    sweeps : sequence of Sweep
        One a case. Complex modes are as many as in the case that has most; the others are filled with NaN.
    labels, laws : sequence of str
        What each case is, and its law in words.
    clearances : sequence of float
        Diametral clearance [m].
    load_factors : sequence of float
        Factors of the loads of the scene.
    """
    first = sweeps[0]
    modes = max(sweep.damped.eigenvalues.shape[1] for sweep in sweeps)
    variables = {entry.name: entry.entry(sweeps) for entry in VARIABLES}
    variables |= {
        "law": (("case",), list(laws), {"long_name": "contact law"}),
        "clearance": (("case",), np.array(clearances), _said("m", "diametral clearance")),
        "load_factor": (("case",), np.array(load_factors), _said("1", "factor of all loads of the scene")),
    }
    coordinates: dict[str, Any] = {
        "case": list(labels),
        "speed": ("speed", first.speeds, _said("rad/s", "speed of the system")),
        "mode": np.arange(1, first.undamped.frequency.shape[1] + 1),
        "complex_mode": np.arange(1, modes + 1),
        "part": list(first.parts),
        "bearing": np.array(first.bearings.names, dtype=np.str_),
    }
    responses = first.responses
    if responses.values.size:
        variables |= {entry.name: entry.entry(sweeps) for entry in RESPONSES}
        quantities = [sensor.quantity for sensor in responses.sensors]
        variables["quantity"] = (("sensor",), quantities, {"long_name": "what the sensor measures"})
        coordinates |= {
            "response_frequency": ("response_frequency", responses.frequencies, _said("Hz", "frequency")),
            "sensor": [sensor.name for sensor in responses.sensors],
            "input": [entry.name for entry in responses.inputs],
        }
    return xr.Dataset(variables, coords=coordinates, attrs={"cage_angles": first.bearings.angles})


def _filled(values: Sequence[npt.NDArray[Any]], axis: int) -> list[npt.NDArray[Any]]:
    """Values as long along an axis as the longest of them, by NaN."""
    most = max(value.shape[axis] for value in values)
    missing = [[(0, most - value.shape[axis] if k == axis else 0) for k in range(value.ndim)] for value in values]
    return [np.pad(value, pad, constant_values=np.nan) for value, pad in zip(values, missing, strict=True)]


def _said(units: str, words: str) -> dict[str, str]:
    """Attributes of a variable."""
    return {"units": units, "long_name": words}


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
    amplitudes = np.zeros((speeds.size, len(sensors)), dtype=np.complex128)
    for index, sensor in enumerate(sensors):
        row = sensor.direction @ system.relative(sensor.on, sensor.against)
        rate = (1j * response.order * speeds) ** _DIFFERENTIATED[sensor.quantity]
        amplitudes[:, index] = rate * (response.motion @ row)
    return amplitudes


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
        amplitudes = np.array([sensed(system, sensors, speeds, entry) for entry in responses])
        dims = ("order", "speed", "sensor")
        for name, part in (("real", amplitudes.real), ("imaginary", amplitudes.imag)):
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
    """Loads that belong to each order."""
    return "; ".join(f"order {entry.order:g}: {', '.join(entry.names)}" for entry in responses)
