"""A sweep over speed as a labelled dataset with units."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import xarray as xr

from ehdmaps.arrays import FloatArray
from mbs.linearised.sweep_result import Sweep

_Variable = tuple[tuple[str, ...], Any, dict[str, str]]


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
    most = max(entry.damped.eigenvalues.shape[1] for entry in sweeps)

    def stacked(read: Callable[[Sweep], FloatArray]) -> FloatArray:
        return np.stack([read(entry) for entry in sweeps])

    def filled(read: Callable[[Sweep], FloatArray]) -> FloatArray:
        values = [read(entry) for entry in sweeps]
        return np.stack(
            [
                np.pad(value, [(0, 0)] * (value.ndim - 1) + [(0, most - value.shape[-1])], constant_values=np.nan)
                for value in values
            ]
        )

    plain, damped, bearing = (
        ("case", "speed", "mode"),
        ("case", "speed", "complex_mode"),
        ("case", "speed", "bearing"),
    )
    variables: dict[str, _Variable] = {
        "frequency": (
            plain,
            stacked(lambda entry: entry.undamped.frequency),
            _said("Hz", "frequency of mass and stiffness, without damping and gyroscopic terms"),
        ),
        "damping_ratio": (
            plain,
            stacked(lambda entry: entry.undamped.damping_ratio),
            _said("1", "modal damping ratio"),
        ),
        "energy_share": (
            ("case", "part", "speed", "mode"),
            stacked(lambda entry: entry.undamped.shares),
            _said("1", "part of the strain energy of the mode"),
        ),
        "bearing_share": (
            plain,
            stacked(lambda entry: entry.undamped.bearing_share),
            _said("1", "part of the strain energy in all bearings"),
        ),
        "assurance": (
            plain,
            stacked(lambda entry: entry.undamped.assurance),
            _said("1", "modal assurance on the way from the speed before"),
        ),
        "summed_shift": (
            plain,
            stacked(lambda entry: entry.undamped.summed_shift),
            _said("1", "change of the frequency from the first speed by energy, summed over the steps"),
        ),
        "direct_shift": (
            ("case", "mode"),
            stacked(lambda entry: entry.undamped.direct_shift),
            _said("1", "change of the frequency from first to last speed by energy, in one step"),
        ),
        "complex_frequency": (
            damped,
            filled(lambda entry: entry.damped.frequency),
            _said("Hz", "|eigenvalue|/(2 pi) of oscillating complex modes"),
        ),
        "complex_damping_ratio": (
            damped,
            filled(lambda entry: entry.damped.damping_ratio),
            _said("1", "damping ratio of complex modes"),
        ),
        "eigenvalue_real": (damped, filled(lambda entry: entry.damped.eigenvalues.real), _said("1/s", "decay")),
        "eigenvalue_imaginary": (
            damped,
            filled(lambda entry: entry.damped.eigenvalues.imag),
            _said("rad/s", "damped frequency"),
        ),
        "complex_energy_share": (
            ("case", "part", "speed", "complex_mode"),
            filled(lambda entry: entry.damped.shares),
            _said("1", "part of the strain energy of the complex mode"),
        ),
        "complex_bearing_share": (
            damped,
            filled(lambda entry: entry.damped.bearing_share),
            _said("1", "part of the strain energy of the complex mode in all bearings"),
        ),
        "whirl": (
            damped,
            filled(lambda entry: entry.damped.whirl),
            _said("1", "d omega/d Omega by gyroscopic terms: positive forward, negative backward"),
        ),
        "complex_assurance": (
            damped,
            filled(lambda entry: entry.damped.assurance),
            _said("1", "assurance of the complex mode on the way from the speed before"),
        ),
        "complex_number": (
            ("case", "complex_mode"),
            filled(lambda entry: np.asarray(entry.damped.number + 1.0, dtype=np.float64)),
            _said("1", "number of the undamped mode that the complex one is nearest to where it begins"),
        ),
        "resembles": (
            ("case", "mode"),
            stacked(lambda entry: np.asarray(entry.undamped.resembles + 1.0, dtype=np.float64)),
            _said("1", "number of the mode whose shape at the last speed is most like that of this one at the first"),
        ),
        "bearing_load": (
            bearing,
            stacked(lambda entry: entry.bearings.load),
            _said("N", "radial force"),
        ),
        "bearing_stiffness": (
            bearing,
            stacked(lambda entry: entry.bearings.stiffness),
            _said("N/m", "stiffness of the bearing along its force"),
        ),
        "bearing_damping": (
            bearing,
            stacked(lambda entry: entry.bearings.damping),
            _said("N s/m", "damping of the bearing along its force"),
        ),
        "bearing_stiffness_spread": (
            bearing,
            stacked(lambda entry: entry.bearings.stiffness_spread),
            _said("1", "half of what the stiffness varies over the cage angles, as a part of the mean"),
        ),
        "bearing_damping_spread": (
            bearing,
            stacked(lambda entry: entry.bearings.damping_spread),
            _said("1", "half of what the damping varies over the cage angles, as a part of the mean"),
        ),
        "between": (
            ("case",),
            np.array([entry.between for entry in sweeps]),
            _said("1", "speeds put in between to follow the modes"),
        ),
        "law": (("case",), list(laws), {"long_name": "contact law"}),
        "clearance": (("case",), np.array(clearances), _said("m", "diametral clearance")),
        "load_factor": (("case",), np.array(load_factors), _said("1", "factor of all loads of the scene")),
    }
    coordinates: dict[str, Any] = {
        "case": list(labels),
        "speed": ("speed", first.speeds, _said("rad/s", "speed of the system")),
        "mode": np.arange(1, first.undamped.frequency.shape[1] + 1),
        "complex_mode": np.arange(1, most + 1),
        "part": list(first.parts),
        "bearing": np.array(first.bearings.names, dtype=np.str_),
    }
    if first.responses.values.size:
        found = first.responses
        dims = ("case", "speed", "response_frequency", "sensor", "input")
        units = "m, m/s or m/s2 by the sensor's quantity (rad for rotations), per N or N m"
        variables |= {
            "response_real": (
                dims,
                stacked(lambda entry: entry.responses.values.real),
                _said(units, "real part of the response"),
            ),
            "response_imaginary": (
                dims,
                stacked(lambda entry: entry.responses.values.imag),
                _said(units, "imaginary part of the response"),
            ),
            "response_error": (
                ("case", "speed"),
                stacked(lambda entry: entry.responses.error),
                _said("1", "largest relative error seen beside direct solutions"),
            ),
            "quantity": (
                ("sensor",),
                [sensor.quantity for sensor in found.sensors],
                {"long_name": "what the sensor measures"},
            ),
        }
        coordinates |= {
            "response_frequency": ("response_frequency", found.frequencies, _said("Hz", "frequency")),
            "sensor": [sensor.name for sensor in found.sensors],
            "input": [entry.name for entry in found.inputs],
        }
    return xr.Dataset(variables, coords=coordinates, attrs={"cage_angles": first.bearings.angles})


def _said(units: str, words: str) -> dict[str, str]:
    """Attributes of a variable."""
    return {"units": units, "long_name": words}
