"""Target `nastran`: a bearing as CBUSH with PBUSH, and PBUSHT over frequency; as matrices where its axes are coupled.

A CBUSH has stiffness and damping along the axes of its coordinate system and about them, without terms between them.
That system is turned about the axis of the bearing to where Kyz is zero. Balls couple radial, axial and tilting motion;
at one frequency their matrices are written whole, as DMIG. Source: MSC Nastran Quick Reference Guide,
CBUSH, PBUSH, PBUSHT, TABLED1, CORD2R, DMIG; fields of 16 characters.
"""

from __future__ import annotations

import argparse
import math

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import Problems
from ehdmaps.outputs import Kind, has_mark
from mbs.exports.linear_bearing import Format, LinearBearing, refuse_speeds, whole
from mbs.exports.linear_table import target

KIND = Kind("a bearing for Nastran made by ehdmaps", (".bdf",), has_mark)

_WIDTH, _FIELDS = 16, 4
Field = int | float | str


def _add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the options that only Nastran has."""
    parser.add_argument("--node", metavar="N", default="1", help="grid of the inner ring (1)")
    parser.add_argument("--outer-node", metavar="N", help="grid of the outer ring at the same place; default: ground")
    parser.add_argument("--first-id", metavar="N", default="900001", help="first number of new entries (900001)")


def _text(bearing: LinearBearing, header: tuple[str, ...], arguments: argparse.Namespace) -> str:
    """Write the bulk data."""
    problems = Problems()
    refuse_speeds(bearing, problems)
    node = whole("--node", arguments.node, problems)
    outer = None if arguments.outer_node is None else whole("--outer-node", arguments.outer_node, problems)
    first = whole("--first-id", arguments.first_id, problems)
    problems.check()
    if bearing.axial and bearing.frequencies.size == 1:
        return _matrices(bearing, header, node, outer, first)
    angle = _principal(bearing.stiffness[0, 0])
    cosine, sine = math.cos(angle), math.sin(angle)
    turned = np.kron(np.eye(2), np.array([[1.0, 0.0, 0.0], [0.0, cosine, sine], [0.0, -sine, cosine]]))
    k, c = (turned @ matrices[0] @ turned.T for matrices in (bearing.stiffness, bearing.damping))
    notes = (
        f"coordinate system {first}: turned by {math.degrees(angle):.6g} deg from y towards z, where Kyz is zero",
        f"left out: what is beside the diagonal there, at most {_beside(k):.1e} of K and {_beside(c):.1e} of C",
        "PBUSHT is for frequency response; Nastran goes on beyond the tables without a word: stay within",
    )
    lines = [f"$ {line}" for line in (*header, *notes)]
    z, y = (turned[2, :3], turned[1, :3])
    lines += _card("CORD2R", first, "", 0.0, 0.0, 0.0, *z, *np.cross(y, z) + 0.0)
    ends: tuple[Field, ...] = (node, "") if outer is None else (outer, node)
    lines += _card("CBUSH", first, first, *ends, "", "", "", first)
    lines += _card("PBUSH", first, "K", *np.diag(k[0]), "", "B", *np.diag(c[0]))
    if bearing.frequencies.size > 1:
        ids = np.arange(first + 1, first + 13).reshape(2, 6)
        lines += _card("PBUSHT", first, "K", *map(int, ids[0]), "", "B", *map(int, ids[1]))
        for numbers, matrices in zip(ids, (k, c), strict=True):
            for axis, number in enumerate(numbers):
                pairs = zip(bearing.frequencies, matrices[:, axis, axis], strict=True)
                lines += _card("TABLED1", int(number), *[""] * 7, *(float(v) for pair in pairs for v in pair), "ENDT")
    return "\n".join(lines) + "\n"


def _matrices(bearing: LinearBearing, header: tuple[str, ...], node: int, outer: int | None, first: int) -> str:
    """Write both matrices whole: their symmetric parts, which K2GG and B2GG take."""
    names = f"K{first}"[:8], f"B{first}"[:8]
    k, c = bearing.stiffness[0, 0], bearing.damping[0, 0]
    unsymmetric = [float(np.max(np.abs(m - m.T)) / max(np.max(np.abs(m)), 1e-300)) for m in (k, c)]
    notes = (
        f"case control: K2GG = {names[0]} and B2GG = {names[1]}; both grids have the axes of the bearing",
        f"left out: the unsymmetric part, {unsymmetric[0]:.1e} of K and {unsymmetric[1]:.1e} of C",
    )
    lines = [f"$ {line}" for line in (*header, *notes)]
    grids = [node] if outer is None else [node, outer]
    signs = np.array([[1.0, -1.0], [-1.0, 1.0]])[: len(grids), : len(grids)]
    places = [(grid, axis) for grid in grids for axis in range(1, 7)]
    for name, matrix in zip(names, (k, c), strict=True):
        whole_matrix = np.kron(signs, 0.5 * (matrix + matrix.T))
        lines += _card("DMIG", name, 0, 6, 2, 0)
        for column, (grid, axis) in enumerate(places):
            rows = [row for row in range(column, len(places)) if whole_matrix[row, column]]
            entries = [field for row in rows for field in (*places[row], float(whole_matrix[row, column]), "")]
            if entries:
                lines += _card("DMIG", name, grid, axis, "", *entries)
    return "\n".join(lines) + "\n"


def _principal(matrix: FloatArray) -> float:
    """Angle from y towards z at which the radial terms of a matrix (6, 6) beside the diagonal are zero [rad]."""
    across = 0.5 * float(matrix[1, 2] + matrix[2, 1])
    return 0.5 * math.atan2(2.0 * across, float(matrix[1, 1] - matrix[2, 2]))


def _beside(matrices: FloatArray) -> float:
    """Largest term of translations beside the diagonal over the largest on it."""
    part = matrices[:, :3, :3]
    diagonal = np.diagonal(part, axis1=1, axis2=2)
    return float(np.max(np.abs(part - diagonal[:, :, None] * np.eye(3))) / np.max(np.abs(diagonal)))


def _card(name: str, *fields: Field) -> list[str]:
    """Write an entry in lines of four wide fields."""
    texts = [_field(field) for field in fields]
    while texts and not texts[-1].strip():
        texts.pop()
    lines = []
    for begin in range(0, len(texts), _FIELDS):
        head = f"{name}*" if begin == 0 else "*"
        lines.append((f"{head:8}" + "".join(texts[begin : begin + _FIELDS])).rstrip())
    if len(lines) % 2:
        lines.append("*")
    return lines


def _field(value: Field) -> str:
    """Write a field of 16 characters."""
    text = f"{value:.9E}" if isinstance(value, float) else str(value)
    return f"{text:>{_WIDTH}}" if not isinstance(value, str) else f"{text:<{_WIDTH}}"


FORMAT = Format(
    KIND,
    "CBUSH with PBUSH, and PBUSHT over frequency",
    "pyNastran (tests.benchmarks.nastran_export)",
    _text,
    _add_arguments,
    one_speed=True,
)
TARGET = target(FORMAT)
