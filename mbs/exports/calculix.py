"""Target `calculix`: a bearing as springs and dashpots, to be included in a deck of CalculiX.

CalculiX has springs and dashpots along lines between nodes. Three lines in the radial plane, along y, along z and
between them, carry any symmetric stiffness and damping of the plane:

    K = (Kyy - Kyz) y y' + (Kzz - Kyz) z z' + 2 Kyz d d',    d = (y + z)/sqrt(2),

and the same for C. Nodes of CalculiX's solids do not turn, so that tilting has no place here. Its dashpots may depend
on frequency, its springs may not. Source: CalculiX CrunchiX USER'S MANUAL 2.20, *SPRING, *DASHPOT.
"""

from __future__ import annotations

import argparse
import math
import re

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import InputError
from ehdmaps.outputs import Kind, has_mark
from mbs.exports.linear_table import LinearTable, one_speed, target, whole

KIND = Kind("a bearing for CalculiX made by ehdmaps", (".inp",), has_mark)

_LINES = ("Y", "Z", "D")
_DIRECTIONS = ((0.0, 1.0, 0.0), (0.0, 0.0, 1.0), (0.0, math.sqrt(0.5), math.sqrt(0.5)))
_LENGTH = 0.1
"""Distance of the ground nodes from the bearing [m]; only directions matter."""


def _add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the options that only CalculiX has."""
    parser.add_argument("--node", metavar="N", default="1", help="node of the inner ring (1)")
    parser.add_argument(
        "--at", metavar="X,Y,Z", default="0,0,0", help="coordinates of that node in metres, such as 0.1,0,0 (0,0,0)"
    )
    parser.add_argument(
        "--first-id", metavar="N", default="900001", help="first number of new nodes and elements (900001)"
    )


def _text(table: LinearTable, header: tuple[str, ...], arguments: argparse.Namespace) -> str:
    """Write the deck."""
    problems: list[str] = []
    one_speed(table, problems)
    node = whole("--node", arguments.node, problems)
    first = whole("--first-id", arguments.first_id, problems)
    place = _place(arguments.at, problems)
    if problems:
        raise InputError(problems)
    k, c = table.stiffness[0], table.damping[0]
    unsymmetric = max(abs(float(m[1, 2] - m[2, 1])) for m in (*k, *c)) / float(np.max(np.abs(c)))
    spread = float(np.ptp(np.diagonal(k, axis1=1, axis2=2)[:, 1:3], axis=0).max() / np.max(np.abs(k[0])))
    name = re.sub(r"[^A-Z0-9]+", "_", table.request.bearing.geometry.name.upper()).strip("_")[:20] or "BEARING"
    notes = (
        f"springs: at {table.frequencies[0]:.6g} Hz, the first frequency; over the frequencies K changes by "
        f"{spread:.2%}; dashpots: over frequency",
        f"left out: tilting of the ring, and the unsymmetric part of K and C ({unsymmetric:.1e})",
        "CalculiX holds the dashpots at their ends beyond the frequencies above: stay within",
        "a housing: take the *BOUNDARY away and tie the nodes of the set to it",
    )
    lines = [f"** {line}" for line in (*header, *notes)]
    lines += [f"*NODE, NSET=EHD_{name}_GROUND"]
    for index, direction in enumerate(_DIRECTIONS):
        x, y, z = (p - _LENGTH * d for p, d in zip(place, direction, strict=True))
        lines.append(f"{first + index}, {_decimal(x)}, {_decimal(y)}, {_decimal(z)}")
    for kind, offset, card, rows in (
        ("SPRINGA", 0, "SPRING", [[f"{_decimal(value)}"] for value in _along_lines(k[0])]),
        (
            "DASHPOTA",
            len(_LINES),
            "DASHPOT",
            [
                [
                    f"{_decimal(value)}, {_decimal(frequency)}"
                    for value, frequency in zip(v, table.frequencies, strict=True)
                ]
                for v in np.array([_along_lines(one) for one in c]).T
            ],
        ),
    ):
        for index, (line, numbers) in enumerate(zip(_LINES, rows, strict=True)):
            group = f"EHD_{name}_{card[0]}{line}"
            lines += [
                f"*ELEMENT, TYPE={kind}, ELSET={group}",
                f"{first + offset + index}, {first + index}, {node}",
                f"*{card}, ELSET={group}",
                "",
                *numbers,
            ]
    lines += ["*BOUNDARY", f"EHD_{name}_GROUND, 1, 3"]
    return "\n".join(lines) + "\n"


def _along_lines(matrix: FloatArray) -> tuple[float, float, float]:
    """Values of the three lines that make the radial part of a matrix (6, 6)."""
    across = 0.5 * float(matrix[1, 2] + matrix[2, 1])
    return float(matrix[1, 1]) - across, float(matrix[2, 2]) - across, 2.0 * across


def _decimal(value: float) -> str:
    """Write a number within the 20 characters that CalculiX reads, with its point: without one it is a whole number."""
    return f"{value:.12e}"


def _place(text: str, problems: list[str]) -> tuple[float, ...]:
    """Read three coordinates [m]."""
    try:
        place = tuple(float(part) for part in text.split(","))
    except ValueError:
        place = ()
    if len(place) != 3 or not np.all(np.isfinite(place)):
        problems.append(f"--at: got {text!r:.60}; allowed: three numbers with commas between them, in metres")
        return (0.0, 0.0, 0.0)
    return place


TARGET = target(
    KIND,
    "springs and dashpots over frequency, to be included in a deck",
    "CalculiX",
    _text,
    _add_arguments,
)
