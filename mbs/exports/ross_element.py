"""A bearing as an element of ROSS, the rotordynamics library: the file that `BearingElement.load` reads.

In ROSS x and y are radial and z is axial. Source: documentation of ross-rotordynamics 2.3 and 3.1, class
BearingElement.
"""

from __future__ import annotations

import re

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.outputs import Kind, has_mark

KIND = Kind("a bearing for ROSS made by ehdmaps", (".toml",), has_mark)

AXES = {"x": 1, "y": 2, "z": 0}
"""Place in our displacements (x axial, y, z) of each axis of ROSS."""

_TERMS = ("xx", "xy", "yx", "yy", "zz")

BEYOND = "ROSS extrapolates beyond the tables: its responses and Campbell diagrams warn of it, run_modal does not"
"""What ROSS 2.3 and 3.1 do there, for the file and the page."""

_NOTES = (
    "ROSS: x is y of the bearing, y is z of it, z is the axis; there is no place for the tilting of the ring",
    f"{BEYOND}; stay within the speeds and frequencies above",
    "read by: ross.BearingElement.load(FILE)",
)


def ross_text(
    bearing: str,
    axes: dict[str, FloatArray],
    matrices: tuple[FloatArray, FloatArray],
    header: tuple[str, ...],
    node: int = 0,
) -> str:
    """Write the element of a bearing.

    Parameters
    ----------
    bearing : str
        Name of the bearing.
    axes : dict of str to array
        Axes of the tables by their names in ROSS [rad/s]; empty for numbers.
    matrices : (array, array), shape (..., 6, 6)
        K [N/m, N, N m] and C of x (axial), y, z and the rotations about them, over the axes.
    header : tuple of str
        Lines that say where these come from.
    node : int
        Node of the rotor.
    """
    name = re.sub(r"[^A-Za-z0-9]+", "_", bearing).strip("_") or "bearing"
    lines = [f"# {line}" for line in (*header, *_NOTES)]
    lines += ["", f"[BearingElement_{name}]", f"n = {node}", f'tag = "{name} at {node}"', "scale_factor = 1"]
    lines += [f"{key} = {_array(values)}" for key, values in axes.items()]
    shape = [axis.size for axis in axes.values()]
    for letter, matrix in zip("kc", matrices, strict=True):
        for term in _TERMS:
            values = matrix[..., AXES[term[0]], AXES[term[1]]]
            lines.append(f"{letter}{term} = {_array(values.reshape(shape))}")
    return "\n".join(lines) + "\n"


def _array(values: FloatArray) -> str:
    """Write numbers with all their digits, nested as ROSS nests them."""
    if np.ndim(values) == 0:
        return repr(float(values))
    return "[" + ", ".join(_array(value) for value in values) + "]"
