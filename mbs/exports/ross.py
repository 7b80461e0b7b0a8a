"""Target `ross`: a bearing for ROSS, the rotordynamics library, as the file that `BearingElement.load` reads.

In ROSS x and y are radial and z is axial. ROSS 2 calls the axis of spin speeds `frequency`; ROSS 3 has both axes,
`speed` and `frequency`, and tables over both. Source: documentation of ross-rotordynamics 2.3 and 3.1, class
BearingElement.
"""

from __future__ import annotations

import argparse
import math

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import InputError
from mbs.exports.linear_table import LinearTable, target
from mbs.exports.ross_element import KIND, ross_text

_VERSIONS = ("2", "3")


def _add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the options that only ROSS has."""
    parser.add_argument("--ross", metavar="VERSION", default="2", help="2 | 3, the release whose names are used (2)")
    parser.add_argument("--node", metavar="N", default="0", help="node of the rotor at which the bearing is (0)")


def _text(table: LinearTable, header: tuple[str, ...], arguments: argparse.Namespace) -> str:
    """Write the element."""
    problems = []
    if arguments.ross not in _VERSIONS:
        problems.append(f"--ross: got {arguments.ross!r:.60}; allowed: {', '.join(_VERSIONS)}")
    node = arguments.node
    if not (node.isascii() and node.isdigit() and len(node) < 7):
        problems.append(f"--node: got {node!r:.60}; allowed: a whole number from 0 to 999999")
    if arguments.ross == "2" and table.frequencies.size > 1:
        problems.append(
            f"--frequency: got {table.frequencies.size} values; ROSS 2 takes one; allowed: one, or --ross 3"
        )
    if problems:
        raise InputError(problems)
    return ross_text(
        table.request.bearing.geometry.name,
        _axes(table, arguments.ross),
        (table.stiffness, table.damping),
        header,
        int(node),
    )


def _axes(table: LinearTable, version: str) -> dict[str, FloatArray]:
    """Axes of the tables by their names in ROSS [rad/s]; none of a single value."""
    axes = {}
    if table.speeds.size > 1:
        axes["frequency" if version == "2" else "speed"] = table.speeds
    if table.frequencies.size > 1:
        axes["frequency"] = 2.0 * math.pi * table.frequencies
    return axes


TARGET = target(
    KIND,
    "stiffness and damping of the bearing over speed, for ross.BearingElement.load",
    "ROSS (tests.benchmarks.ross_export)",
    _text,
    _add_arguments,
)
