"""Targets `calculix` and `abaqus`: a bearing as springs and dashpots, to be included in a deck of CalculiX or Abaqus.

Both have springs and dashpots along lines between nodes. Three lines in the radial plane, along y, along z and
between them, carry any symmetric stiffness and damping of the plane:

    K = (Kyy - Kyz) y y' + (Kzz - Kyz) z z' + 2 Kyz d d',    d = (y + z)/sqrt(2),

and the same for C. Nodes of solids do not turn, so that tilting has no place here. Dashpots may depend on frequency in
both programs; springs may in Abaqus, in steady-state dynamics by direct solution or subspace projection, and may not in
CalculiX. Sources: CalculiX CrunchiX USER'S MANUAL 2.20, and Abaqus Keywords Reference, *SPRING, *DASHPOT.
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
ABAQUS_KIND = Kind("a bearing for Abaqus made by ehdmaps", (".inp",), has_mark)

_LINES = ("Y", "Z", "D")
_DIRECTIONS = ((0.0, 1.0, 0.0), (0.0, 0.0, 1.0), (0.0, math.sqrt(0.5), math.sqrt(0.5)))
_LENGTH = 0.1
"""Distance of the ground nodes from the bearing [m]; only directions matter."""


def _add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the options of decks."""
    parser.add_argument("--node", metavar="N", default="1", help="node of the inner ring (1)")
    parser.add_argument(
        "--at", metavar="X,Y,Z", default="0,0,0", help="coordinates of that node in metres, such as 0.1,0,0 (0,0,0)"
    )
    parser.add_argument(
        "--first-id", metavar="N", default="900001", help="first number of new nodes and elements (900001)"
    )


def _calculix(table: LinearTable, header: tuple[str, ...], arguments: argparse.Namespace) -> str:
    """Write the deck for CalculiX."""
    k = table.stiffness[0]
    spread = float(np.ptp(np.diagonal(k, axis1=1, axis2=2)[:, 1:3], axis=0).max() / np.max(np.abs(k[0])))
    notes = (
        f"springs: at {table.frequencies[0]:.6g} Hz, the first frequency; over the frequencies K changes by "
        f"{spread:.2%}; dashpots: over frequency",
        "CalculiX holds the dashpots at their ends beyond the frequencies above: stay within",
        "beams beside these springs: *STEADY STATE DYNAMICS of CalculiX 2.20 gave zeros with B31 and wrong values with "
        "B32R, where *STATIC was right; make the shaft of solids",
    )
    return _deck(table, (*header, *notes), arguments, table.frequencies[:1])


def _abaqus(table: LinearTable, header: tuple[str, ...], arguments: argparse.Namespace) -> str:
    """Write the deck for Abaqus."""
    notes = (
        "springs and dashpots over frequency: for *STEADY STATE DYNAMICS, DIRECT or SUBSPACE PROJECTION",
        "Abaqus holds them at their ends beyond the frequencies above: stay within",
    )
    return _deck(table, (*header, *notes), arguments, table.frequencies)


def _deck(table: LinearTable, header: tuple[str, ...], arguments: argparse.Namespace, of_springs: FloatArray) -> str:
    """Write nodes, springs at some of the frequencies, dashpots at all."""
    problems: list[str] = []
    one_speed(table, problems)
    node = whole("--node", arguments.node, problems)
    first = whole("--first-id", arguments.first_id, problems)
    place = _place(arguments.at, problems)
    if problems:
        raise InputError(problems)
    k, c = table.stiffness[0], table.damping[0]
    unsymmetric = max(abs(float(m[1, 2] - m[2, 1])) for m in (*k, *c)) / float(np.max(np.abs(c)))
    name = re.sub(r"[^A-Z0-9]+", "_", table.request.bearing.geometry.name.upper()).strip("_")[:20] or "BEARING"
    notes = (
        f"left out: tilting of the ring, and the unsymmetric part of K and C ({unsymmetric:.1e})",
        "a housing: take the *BOUNDARY away and tie the nodes of the set to it",
    )
    lines = [f"** {line}" for line in (*header, *notes)]
    lines += [f"*NODE, NSET=EHD_{name}_GROUND"]
    for index, direction in enumerate(_DIRECTIONS):
        x, y, z = (p - _LENGTH * d for p, d in zip(place, direction, strict=True))
        lines.append(f"{first + index}, {_decimal(x)}, {_decimal(y)}, {_decimal(z)}")
    for kind, offset, card, matrices, frequencies in (
        ("SPRINGA", 0, "SPRING", k, of_springs),
        ("DASHPOTA", len(_LINES), "DASHPOT", c, table.frequencies),
    ):
        rows = _rows(matrices, frequencies, always=card == "DASHPOT")
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


def _rows(matrices: FloatArray, frequencies: FloatArray, always: bool) -> list[list[str]]:
    """Lines of data of each of the three lines between nodes: value and frequency, which a single value may lack."""
    values = np.array([_along_lines(matrix) for matrix in matrices[: frequencies.size]]).T
    if frequencies.size == 1 and not always:
        return [[_decimal(value)] for (value,) in values]
    return [
        [f"{_decimal(value)}, {_decimal(at)}" for value, at in zip(one, frequencies, strict=True)] for one in values
    ]


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
    _calculix,
    _add_arguments,
)
ABAQUS = target(
    ABAQUS_KIND, "springs and dashpots, both over frequency, to be included in a deck", "", _abaqus, _add_arguments
)
