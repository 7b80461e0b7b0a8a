"""Targets `calculix` and `abaqus`: a bearing as springs and dashpots, to be included in a deck of CalculiX or Abaqus.

Both have springs and dashpots along lines between nodes. Lines along the axes and halfway between them carry any
symmetric stiffness and damping; in the plane

    K = (Kyy - Kyz) y y' + (Kzz - Kyz) z z' + 2 Kyz d d',    d = (y + z)/sqrt(2),

and the same for C. Bearings that are stiff along their axis have six lines, others the three of the radial plane.
Nodes of solids do not turn, so that tilting has no place here. Dashpots may depend on frequency in
both programs; springs may in Abaqus, in steady-state dynamics by direct solution or subspace projection, and may not in
CalculiX. Sources: CalculiX CrunchiX USER'S MANUAL 2.20, and Abaqus Keywords Reference, *SPRING, *DASHPOT.
"""

from __future__ import annotations

import argparse
import re

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import Problems
from ehdmaps.outputs import Kind, has_mark
from mbs.exports.linear_bearing import Format, LinearBearing, refuse_speeds, whole
from mbs.exports.linear_table import target

KIND = Kind("a bearing for CalculiX made by ehdmaps", (".inp",), has_mark)
ABAQUS_KIND = Kind("a bearing for Abaqus made by ehdmaps", (".inp",), has_mark)

_LINES = {"Y": (1, 1), "Z": (2, 2), "D": (1, 2), "X": (0, 0), "XY": (0, 1), "XZ": (0, 2)}
"""Lines, and the two axes between which each goes; the first three lie in the radial plane."""

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


def _calculix(bearing: LinearBearing, header: tuple[str, ...], arguments: argparse.Namespace) -> str:
    """Write the deck for CalculiX."""
    k = bearing.stiffness[0]
    spread = float(np.ptp(np.diagonal(k, axis1=1, axis2=2)[:, 1:3], axis=0).max() / np.max(np.abs(k[0])))
    notes = (
        f"springs: at {bearing.frequencies[0]:.6g} Hz, the first frequency; over the frequencies K changes by "
        f"{spread:.2%}; dashpots: over frequency",
        "CalculiX holds the dashpots at their ends beyond the frequencies above: stay within",
        "beams beside these springs: *STEADY STATE DYNAMICS of CalculiX 2.20 gave zeros with B31 and wrong values with "
        "B32R, where *STATIC was right; make the shaft of solids",
    )
    return _deck(bearing, (*header, *notes), arguments, bearing.frequencies[:1])


def _abaqus(bearing: LinearBearing, header: tuple[str, ...], arguments: argparse.Namespace) -> str:
    """Write the deck for Abaqus."""
    notes = (
        "springs and dashpots over frequency: for *STEADY STATE DYNAMICS, DIRECT or SUBSPACE PROJECTION",
        "Abaqus holds them at their ends beyond the frequencies above: stay within",
    )
    return _deck(bearing, (*header, *notes), arguments, bearing.frequencies)


def _deck(
    bearing: LinearBearing, header: tuple[str, ...], arguments: argparse.Namespace, of_springs: FloatArray
) -> str:
    """Write nodes, springs at some of the frequencies, dashpots at all."""
    problems = Problems()
    refuse_speeds(bearing, problems)
    node = whole("--node", arguments.node, problems)
    first = whole("--first-id", arguments.first_id, problems)
    place = _place(arguments.at, problems)
    problems.check()
    k, c = bearing.stiffness[0], bearing.damping[0]
    lines_at = dict(list(_LINES.items())[: 6 if bearing.axial else 3])
    name = re.sub(r"[^A-Z0-9]+", "_", bearing.name.upper()).strip("_")[:20] or "BEARING"
    notes = (
        f"left out: tilting of the ring, and the unsymmetric part of K ({_unsymmetric(k):.1e}) and C "
        f"({_unsymmetric(c):.1e})",
        "a housing: take the *BOUNDARY away and tie the nodes of the set to it",
    )
    lines = [f"** {line}" for line in (*header, *notes, *bearing.left_out(axial_terms=False))]
    lines += [f"*NODE, NSET=EHD_{name}_GROUND"]
    for index, axes in enumerate(lines_at.values()):
        along = np.eye(3)[list(axes)].sum(axis=0)
        x, y, z = np.array(place) - _LENGTH * along / np.linalg.norm(along)
        lines.append(f"{first + index}, {_decimal(x)}, {_decimal(y)}, {_decimal(z)}")
    for kind, offset, card, matrices, frequencies in (
        ("SPRINGA", 0, "SPRING", k, of_springs),
        ("DASHPOTA", len(lines_at), "DASHPOT", c, bearing.frequencies),
    ):
        values = np.array([_along_lines(matrix, lines_at) for matrix in matrices[: frequencies.size]]).T
        rows = _rows(values, frequencies, always=card == "DASHPOT")
        for index, (line, numbers) in enumerate(zip(lines_at, rows, strict=True)):
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


def _rows(values: FloatArray, frequencies: FloatArray, always: bool) -> list[list[str]]:
    """Lines of data of each of the lines between nodes: value and frequency, which a single value may lack."""
    if frequencies.size == 1 and not always:
        return [[_decimal(value)] for (value,) in values]
    return [
        [f"{_decimal(value)}, {_decimal(at)}" for value, at in zip(one, frequencies, strict=True)] for one in values
    ]


def _along_lines(matrix: FloatArray, lines: dict[str, tuple[int, int]]) -> list[float]:
    """Values of the lines that make the symmetric part of a matrix (6, 6)."""
    part = 0.5 * (matrix[:3, :3] + matrix[:3, :3].T)
    return [float(2.0 * part[i, i] - part[i].sum() if i == j else 2.0 * part[i, j]) for i, j in lines.values()]


def _unsymmetric(matrices: FloatArray) -> float:
    """Largest difference between terms that symmetry makes alike, over the largest term."""
    part = matrices[..., :3, :3]
    return float(np.max(np.abs(part - np.swapaxes(part, -1, -2))) / max(np.max(np.abs(part)), 1e-300))


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


FORMAT = Format(
    KIND,
    "springs and dashpots over frequency, to be included in a deck",
    "CalculiX",
    _calculix,
    _add_arguments,
    one_speed=True,
)
ABAQUS_FORMAT = Format(
    ABAQUS_KIND,
    "springs and dashpots, both over frequency, to be included in a deck",
    "",
    _abaqus,
    _add_arguments,
    one_speed=True,
)
TARGET = target(FORMAT)
ABAQUS = target(ABAQUS_FORMAT)
