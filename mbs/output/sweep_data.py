"""Results over speed as labelled datasets: a sweep, critical speeds, responses to orders."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from operator import attrgetter
from typing import Any

import numpy as np
import numpy.typing as npt
import xarray as xr

from ehdmaps.arrays import ComplexArray, FloatArray, variable
from mbs.linearised.critical import CriticalSpeed, OrderResponse, orbit, turning_places
from mbs.linearised.sweep_result import Sweep
from mbs.model.elements import Sensor
from mbs.model.system import System
from mbs.output.results import BAND, MOTION_UNITS, REDUCED, RESPONSE_UNITS

_Entry = tuple[tuple[str, ...], Any, dict[str, str]]
"""A variable as xarray takes it."""

UNDAMPED = ("case", "speed", "mode")
DAMPED = ("case", "speed", "complex_mode")
BEARING = ("case", "speed", "bearing")
RESPONSE = ("case", "speed", "response_frequency", "sensor", "input")
_PART_OF_MODE, _PART_OF_DAMPED = ("case", "part", "speed", "mode"), ("case", "part", "speed", "complex_mode")
PEAK = ("case", "speed", "response_peak", "sensor", "input")


@dataclass(frozen=True)
class Variable:
    """One variable of the dataset.

    Attributes
    ----------
    name, units, long_name : str
        Name, units and meaning, written to the file.
    dims : tuple of str
        Dims of the variable, the cases first.
    path : str
        Attribute of the sweep of one case that it is, in the order of the other dims.
    from_one : bool
        Whether it is a number of a mode, which files count from one on.
    """

    name: str
    units: str
    long_name: str
    dims: tuple[str, ...]
    path: str
    from_one: bool = False

    def entry(self, sweeps: Sequence[Sweep]) -> _Entry:
        """Return the variable of some cases side by side; complex modes and peaks beyond those of a case are NaN."""
        values = [np.asarray(attrgetter(self.path)(sweep)) for sweep in sweeps]
        values = [value + 1.0 for value in values] if self.from_one else values
        for own in {"complex_mode", "response_peak"}.intersection(self.dims):
            values = _filled(values, self.dims.index(own) - 1)
        return self.dims, np.stack(values), _said(self.units, self.long_name)


def _of(part: str, prefix: str, dims: tuple[str, ...], *rows: tuple[str, str, str]) -> tuple[Variable, ...]:
    """Variables of a part of a sweep that are called as its attributes, behind a prefix."""
    return tuple(Variable(f"{prefix}{name}", units, words, dims, f"{part}.{name}") for name, units, words in rows)


_OVER_PITCH = "varies over the cage angles"
_FREQUENCY = f"half of what the frequency of the complex mode {_OVER_PITCH}"
_RATIO = f"half of what the damping ratio of the complex mode {_OVER_PITCH}"
_NEAREST = "number of the undamped mode that the complex one is nearest to where it begins"
_LIKE = "number of the mode whose shape at the last speed is most like that of this one at the first"

VARIABLES = (
    *_of(
        "undamped", "", UNDAMPED,
        ("frequency", "Hz", "frequency of mass and stiffness, without damping and gyroscopic terms"),
        ("frequency_error", "Hz", f"{BAND} the frequency"),
        ("frequency_spread", "Hz", f"half of what the frequency {_OVER_PITCH}, to first order"),
        ("damping_ratio", "1", "modal damping ratio"),
        ("bearing_share", "1", "part of the strain energy in all bearings"),
        ("assurance", "1", "modal assurance on the way from the speed before"),
        ("summed_shift", "1", "change of the frequency from the first speed by energy, summed over the steps"),
    ),
    Variable("energy_share", "1", "part of the strain energy of the mode", _PART_OF_MODE, "undamped.shares"),
    *_of(
        "undamped", "", ("case", "mode"),
        ("direct_shift", "1", "change of the frequency from first to last speed by energy, in one step"),
    ),
    Variable("resembles", "1", _LIKE, ("case", "mode"), "undamped.resembles", from_one=True),
    *_of(
        "damped", "complex_", DAMPED,
        ("frequency", "Hz", "|eigenvalue|/(2 pi) of oscillating complex modes"),
        ("damping_ratio", "1", "damping ratio of complex modes"),
        ("frequency_error", "Hz", f"{BAND} the frequency of the complex mode"),
        ("damping_ratio_error", "1", f"{BAND} the damping ratio of the complex mode"),
        ("frequency_spread", "Hz", f"{_FREQUENCY}, to first order"),
        ("damping_ratio_spread", "1", f"{_RATIO}, to first order"),
        ("bearing_share", "1", "part of the strain energy of the complex mode in all bearings"),
        ("assurance", "1", "assurance of the complex mode on the way from the speed before"),
    ),
    *(
        Variable(f"complex_{name}_reduction", unit, f"{REDUCED} of the {words} of the complex mode", DAMPED,
                 f"damped.reduction.{name}")
        for name, unit, words in (("frequency", "Hz", "frequency"), ("damping_ratio", "1", "damping ratio"))
    ),
    Variable("complex_energy_share", "1", "part of the strain energy of the complex mode", _PART_OF_DAMPED,
             "damped.shares"),
    Variable("complex_number", "1", _NEAREST, ("case", "complex_mode"), "damped.number", from_one=True),
    Variable("eigenvalue_real", "1/s", "decay", DAMPED, "damped.eigenvalues.real"),
    Variable("eigenvalue_imaginary", "rad/s", "damped frequency", DAMPED, "damped.eigenvalues.imag"),
    *_of(
        "damped", "", DAMPED,
        ("whirl", "1", "d omega/d Omega by gyroscopic terms: positive forward, negative backward"),
    ),
    *_of(
        "bearings", "bearing_", BEARING,
        ("load", "N", "radial force"),
        ("stiffness", "N/m", "stiffness of the bearing along its force"),
        ("damping", "N s/m", "damping of the bearing along its force"),
        ("stiffness_error", "N/m", f"{BAND} the stiffness"),
        ("damping_error", "N s/m", f"{BAND} the damping"),
        ("stiffness_spread", "1", f"half of what the stiffness {_OVER_PITCH}, as a part of the mean"),
        ("damping_spread", "1", f"half of what the damping {_OVER_PITCH}, as a part of the mean"),
    ),
    Variable("between", "1", "speeds put in between to follow the modes", ("case",), "between"),
)  # fmt: skip
"""Of every sweep."""

_AROUND = "frequency of each peak of the response, with more frequencies around lightly damped modes"

RESPONSES = (
    Variable("response_real", RESPONSE_UNITS, "real part of the response", RESPONSE, "responses.values.real"),
    Variable("response_imaginary", RESPONSE_UNITS, "imaginary part of the response", RESPONSE, "responses.values.imag"),
    *_of("responses", "", PEAK, ("peak_frequency", "Hz", _AROUND), ("peak_size", RESPONSE_UNITS, "size of each peak")),
    *_of(
        "responses", "response_", ("case", "speed"),
        ("error", "1", "largest relative error seen beside direct solutions"),
    ),
)  # fmt: skip
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
        "law": variable(("case",), list(laws), "", "contact law"),
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
        variables["quantity"] = variable(("sensor",), quantities, "", "what the sensor measures")
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
        rate = (1j * response.order * speeds) ** sensor.order
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


LARGEST = {
    "orbit_largest": (("order", "place"), {"units": "m", "long_name": "largest semi-axis of the orbit over speed"}),
    "response_largest": (
        ("order", "sensor"),
        {"units": MOTION_UNITS, "long_name": "largest amplitude of the sensor over speed"},
    ),
    "element_force_largest": (
        ("order", "element"),
        {"units": "N", "long_name": "largest radial force over speed, without its mean"},
    ),
}
"""Dimensions and attributes of the largest responses over speed, which have bands."""


def largest_responses(
    system: System, sensors: Sequence[Sensor], speeds: FloatArray, responses: Sequence[OrderResponse]
) -> dict[str, FloatArray]:
    """Largest responses over speed by the names of `LARGEST`, shape (orders, places, sensors or elements).

    Parameters
    ----------
    system : System
        The system.
    sensors : sequence of Sensor
        What is sensed.
    speeds : array, shape (speeds,)
        Speeds of responses that have none of their own [rad/s].
    responses : sequence of OrderResponse
        One an order.
    """
    found: dict[str, list[FloatArray]] = {}
    for one in responses:
        at = speeds if one.speeds is None else one.speeds
        sizes = (
            orbits(system, one)[1][..., 0],
            np.abs(sensed(system, sensors, at, one)),
            orbit(one.forces[..., 0], one.forces[..., 1])[0],
        )
        for name, size in zip(LARGEST, sizes, strict=True):
            found.setdefault(name, []).append(size.max(axis=0))
    return {name: np.array(rows) for name, rows in found.items()}


def side_by_side_laws(labels: Sequence[str], parts: Sequence[xr.Dataset]) -> xr.Dataset:
    """Datasets of several laws over the dim law, as long as the longest.

    Parameters
    ----------
    labels : sequence of str
        Name of each law.
    parts : sequence of Dataset
        One a law.
    """
    # Dims without coordinates, whose lengths differ, are numbered for the while.
    bare = {name for part in parts for name in part.dims if name not in part.coords}
    numbered = [part.assign_coords({name: np.arange(part.sizes[name]) for name in bare}) for part in parts]
    law = xr.DataArray(np.array(labels, dtype=np.str_), dims="law", name="law")
    joined = xr.concat(numbered, law, data_vars="all", join="outer", combine_attrs="override")
    return joined.drop_vars(list(bare)).assign_attrs(parts[0].attrs)


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

    def column(unit: str, words: str, values: Sequence[float]) -> tuple[Any, Any, dict[str, str]]:
        return variable("critical", np.array(values, dtype=np.float64), unit, words)

    over_speed, none = ("sweep_speed", "complex_mode"), "frequency of the damped oscillation; none where overdamped"
    damped = sweep.damped.eigenvalues.imag / (2.0 * np.pi)

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
        "damped_frequency": variable(over_speed, damped, "Hz", none),
        "damping_ratio": variable(over_speed, sweep.damped.damping_ratio, "1", "damping ratio of the complex mode"),
    }  # fmt: skip
    coordinates = {
        "sweep_speed": variable("sweep_speed", sweep.speeds, "rad/s", "speed of the system"),
        "speed": variable("speed", speeds, "rad/s", "speed of the system"),
        "order": variable("order", [entry.order for entry in responses], "1", "order of the loads"),
        "sensor": [sensor.name for sensor in sensors],
    }
    if responses:
        amplitudes = np.array([sensed(system, sensors, speeds, entry) for entry in responses])
        dims = ("order", "speed", "sensor")
        for name, part in (("real", amplitudes.real), ("imaginary", amplitudes.imag)):
            words = f"{name} part of the amplitude: the signal is Re[amplitude exp(i order angle)]"
            variables[f"response_{name}"] = variable(dims, part, MOTION_UNITS, words)
        ellipses = [orbits(system, entry) for entry in responses]
        coordinates["place"] = list(ellipses[0][0])
        axes = np.array([part for _, part in ellipses])
        for index, name in enumerate(("major", "minor")):
            words = f"{name} semi-axis of the orbit" + (", negative from z to y" if index else "")
            variables[f"orbit_{name}"] = variable(("order", "speed", "place"), axes[..., index], "m", words)
        coordinates["element"] = [connected.element.name for connected in system.elements]
        sizes = np.array([orbit(entry.forces[..., 0], entry.forces[..., 1])[0] for entry in responses])
        variables["element_force"] = variable(
            ("order", "speed", "element"),
            sizes,
            "N",
            "largest radial force of a bearing or table over a turn, without its mean",
        )
    return xr.Dataset(variables, coords=coordinates, attrs={"loads": _loads(responses)})


def _loads(responses: Sequence[OrderResponse]) -> str:
    """Loads that belong to each order."""
    return "; ".join(f"order {entry.order:g}: {', '.join(entry.names)}" for entry in responses)
