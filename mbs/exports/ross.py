"""Target `ross`: a bearing for ROSS, the rotordynamics library, as the file that `BearingElement.load` reads.

In ROSS x and y are radial and z is axial. ROSS 2 has one axis, `frequency`, for spin speeds or for
frequencies; ROSS 3 has both axes,
`speed` and `frequency`, and tables over both. Source: documentation of ross-rotordynamics 2.3 and 3.1, class
BearingElement.
"""

from __future__ import annotations

import argparse
import math
import re

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import Problems
from ehdmaps.outputs import Kind, has_mark
from ehdmaps.units import whole_number
from mbs.exports.linear_bearing import Format, LinearBearing
from mbs.exports.linear_table import target

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

_AT_FREQUENCY = (
    "tables are over the frequency of the oscillation, at one speed: rotor.A(SPEED, FREQUENCY) reads them there, other "
    "analyses of ROSS 2 at the frequency of turning"
)

_VERSIONS = ("2", "3")


def _add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the options that only ROSS has."""
    parser.add_argument("--ross", metavar="VERSION", default="2", help="2 | 3, the release whose names are used (2)")
    parser.add_argument("--node", metavar="N", default="0", help="node of the rotor at which the bearing is (0)")


def _text(bearing: LinearBearing, header: tuple[str, ...], arguments: argparse.Namespace) -> str:
    """Write the element."""
    problems = Problems()
    if arguments.ross not in _VERSIONS:
        problems.append(f"--ross: got {arguments.ross!r:.60}; allowed: {', '.join(_VERSIONS)}")
    with problems.after("--node: "):
        node = whole_number(arguments.node, 0, 999_999)
    if arguments.ross == "2" and bearing.frequencies.size > 1 and bearing.speeds.size > 1:
        problems.append(
            f"--frequency: got {bearing.frequencies.size} values for {bearing.speeds.size} speeds; ROSS 2 takes one of "
            "both; allowed: one frequency, one speed, or --ross 3"
        )
    problems.check()
    name = re.sub(r"[^A-Za-z0-9]+", "_", bearing.name).strip("_") or "bearing"
    axes = _axes(bearing, arguments.ross)
    notes = (*_NOTES, _AT_FREQUENCY) if arguments.ross == "2" and bearing.frequencies.size > 1 else _NOTES
    lines = [f"# {line}" for line in (*header, *notes, *bearing.left_out(axial_terms=True))]
    lines += ["", f"[BearingElement_{name}]", f"n = {node}", f'tag = "{name} at {node}"', "scale_factor = 1"]
    lines += [f"{key} = {_array(values)}" for key, values in axes.items()]
    shape = [axis.size for axis in axes.values()]
    for letter, matrix in (("k", bearing.stiffness), ("c", bearing.damping)):
        for term in _TERMS:
            values = matrix[..., AXES[term[0]], AXES[term[1]]]
            lines.append(f"{letter}{term} = {_array(values.reshape(shape))}")
    return "\n".join(lines) + "\n"


def _axes(bearing: LinearBearing, version: str) -> dict[str, FloatArray]:
    """Axes of the tables by their names in ROSS [rad/s]; none of a single value."""
    axes = {}
    if bearing.speeds.size > 1:
        axes["frequency" if version == "2" else "speed"] = bearing.speeds
    if bearing.frequencies.size > 1:
        axes["frequency"] = 2.0 * math.pi * bearing.frequencies
    return axes


def _array(values: FloatArray) -> str:
    """Write numbers with all their digits, nested as ROSS nests them."""
    if np.ndim(values) == 0:
        return repr(float(values))
    return "[" + ", ".join(_array(value) for value in values) + "]"


FORMAT = Format(
    KIND,
    "stiffness and damping of the bearing over speed, for ross.BearingElement.load",
    "ROSS (tests.benchmarks.ross_export)",
    _text,
    _add_arguments,
)
TARGET = target(FORMAT)
