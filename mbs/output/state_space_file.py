"""State spaces of `mbs lsa` as a MATLAB v5 file: A, B, C, D with the names and units of states, inputs and outputs."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

from ehdmaps.exports.mat import ascii_text, write_matlab
from ehdmaps.exports.target import BEARING_AXES
from ehdmaps.outputs import MARK
from ehdmaps.units import RPM
from ehdmaps.version import version
from mbs.linearised.linear import sensor_unit
from mbs.output.model_text import clearance_text, temperature_text

if TYPE_CHECKING:
    import xarray as xr

    from mbs.linearised.linear import StateSpace
    from mbs.model.equilibrium import Equilibrium
    from mbs.scene.assembly import Model

_RATES = {"m": "m/s", "rad": "rad/s", "1": "1/s"}

_FILM_UNIT = "N^0.5 m^0.5"
"""Unit of a state of the films, see `StateSpace`."""

_NOTES = (
    "x' = A x + B u, y = C x + D u: x are displacements from the equilibrium, their rates, then states of the films",
    "valid for small motion about the equilibrium at this speed and cage angle, while no contact lifts off",
    "u is the amplitude of a load, y an output; fields amplitude: loads in operation",
    "films that relax are few states in place of all slices, within 1e-8 of their dynamic stiffness",
)


class LinearSystem(Protocol):
    """System of which a state space is written: the result of `mbs lsa`."""

    @property
    def model(self) -> Model:
        """Scene with its law."""
        ...

    @property
    def balance(self) -> Equilibrium:
        """Equilibrium at which the system was linearised."""
        ...

    @property
    def space(self) -> StateSpace:
        """State space from the inputs of the scene to its sensors."""
        ...

    @property
    def dataset(self) -> xr.Dataset:
        """The result, with the names of its states."""
        ...


def write_spaces(path: Path, found: Sequence[tuple[str, LinearSystem]]) -> None:
    """Write the struct array `space`, one struct a law.

    Parameters
    ----------
    path : Path
        The file; look at it with `check_outputs` and `KIND` of `ehdmaps.exports.mat` first.
    found : sequence of (str, LinearSystem)
        Label and result of each law.

    Raises
    ------
    InputError
        If it cannot be written, or something else stands there.
    """
    structs = [_struct(label, result) for label, result in found]
    fields = list(structs[0])
    array = np.empty((1, len(structs)), dtype=[(field, object) for field in fields])
    for index, struct in enumerate(structs):
        for field in fields:
            array[0, index][field] = struct[field]
    write_matlab(path, {"space": array}, "use -o for a netCDF file")


def _struct(label: str, result: LinearSystem) -> dict[str, Any]:
    """Return the fields of one state space."""
    model, balance, space, scene = result.model, result.balance, result.space, result.model.scene
    units = list(balance.system.units)
    states = [str(name) for name in result.dataset["state"].values]
    films = len(states) - 2 * len(units)
    header = (
        f"{MARK} {version()}",
        f"scene: {scene.name}",
        f"law: {model.law}",
        f"linearised at {RPM.text(balance.operation.speed)}, {temperature_text(model)}, "
        f"clearance {clearance_text(model) or 'none'}, angle turned {balance.operation.angle:.6g} rad, "
        "loads of the scene; x = 0 is `equilibrium`",
        *BEARING_AXES,
        *_NOTES,
    )
    return {
        "case": ascii_text(label),
        "A": space.A,
        "B": space.B,
        "C": space.C,
        "D": space.D,
        "states": _cells(states),
        "state_units": _cells([*units, *(_RATES[unit] for unit in units), *[_FILM_UNIT] * films]),
        "inputs": _cells([entry.name for entry in scene.inputs]),
        "input_units": _cells(["N m" if entry.unit == "N m" else "N" for entry in scene.inputs]),
        "amplitude": np.array([entry.amplitude for entry in scene.inputs], dtype=float)[:, None],
        "outputs": _cells([sensor.name for sensor in scene.sensors]),
        "output_units": _cells([sensor_unit(sensor) for sensor in scene.sensors]),
        "equilibrium": np.asarray(balance.displacement, dtype=float)[:, None],
        "equilibrium_residual": float(balance.residual),
        "speed_rad_per_s": float(balance.operation.speed),
        "scene": ascii_text(scene.name),
        "law": ascii_text(model.law),
        "header": _cells(header),
    }


def _cells(texts: Sequence[str]) -> Any:
    """Return texts as a column of cells."""
    cells = np.empty((len(texts), 1), dtype=object)
    cells[:, 0] = [ascii_text(text) for text in texts]
    return cells
