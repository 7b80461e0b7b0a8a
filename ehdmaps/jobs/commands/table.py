"""`ehdmaps table show`: what the film tables hold, of lines and of points."""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from ehdmaps.outputs import MADE_AS, root_attributes
from ehdmaps.table.file import TableFile, read_tables, shipped_tables
from ehdmaps.table.nodes import decoded
from ehdmaps.table.points.file import KIND, read_point_table, shipped_point_table
from ehdmaps.table.points.films import PointTable
from ehdmaps.table.points.nodes import ERRORS, FILMS, HOLE, SLOPE

_Ends = tuple[str, np.ndarray, str]


def run(arguments: argparse.Namespace) -> tuple[str, int]:
    """Show a table; without a file, those that are shipped."""
    if arguments.file is None:
        return f"{shown(shipped_tables())}\n\n{shown(shipped_point_table())}", 0
    path = Path(arguments.file)
    of_points = root_attributes(path).get(MADE_AS) == KIND
    return shown(read_point_table(path) if of_points else read_tables(path)), 0


def shown(table: TableFile | PointTable) -> str:
    """Nodes, provenance and errors of a table as text.

    Parameters
    ----------
    table : TableFile or PointTable
        That of lines, or that of points.

    Returns
    -------
    str
        The table as it is printed.
    """
    provenance = [f"{name}: {value}" for name, value in sorted(table.attributes.items())]
    more = _of_lines(table) if isinstance(table, TableFile) else _of_points(table)
    return "\n".join([*provenance, *more])


def _of_lines(file: TableFile) -> Iterator[str]:
    """Nodes of both parts of each table of lines."""
    for law, table in file.tables.items():
        piezo, iso = table.piezoviscous.axes, table.isoviscous.axes
        alpha, number = ("alpha", 1e9 * np.exp(piezo.alpha), " 1/GPa"), ("L", np.exp(piezo.size), "")
        nodes = _ends(("zeta", piezo.zeta, ""), number, alpha, ("bend", piezo.bend, ""))
        yield f"{law}, piezoviscous: {nodes}; {np.prod(piezo.shape)} films"
        alpha, number = ("alpha", 1e9 * iso.alpha, " 1/GPa"), ("L/alpha", 1e-9 * np.exp(iso.size), " GPa")
        nodes = _ends(("zeta", iso.zeta, ""), number, alpha, ("1 - z", iso.bend, ""))
        yield f"{law}, isoviscous: {nodes}; {np.prod(iso.shape)} films"


def _of_points(table: PointTable) -> Iterator[str]:
    """Nodes, holes and errors of the table of points."""
    axes, codes = table.nodes.axes, table.nodes.codes
    yield _ends(
        ("zeta", axes.zeta, ""),
        ("L", np.exp(axes.size), ""),
        ("ellipticity", np.exp(axes.shape), ""),
        ("alpha", 1e9 * np.exp(axes.alpha), " 1/GPa"),
        ("bend", axes.bend, ""),
    )
    holes, continued = codes[..., 0] == HOLE, table.nodes.continued
    yield (
        f"{holes.size} cells, {np.count_nonzero(holes)} of them holes: a corner has no solution; "
        f"{np.count_nonzero(continued)} of heavy contacts, continued from lighter loads, not in the errors below"
    )
    errors = 100.0 * decoded(codes[~holes & ~continued])
    for name in (*(field.name for field in FILMS), SLOPE):
        column = errors[:, ERRORS.index(name)]
        most = np.percentile(column, 95)
        yield f"error of {name}: median {np.median(column):.2g} %, 95 of 100 below {most:.2g} %"


def _ends(*axes: _Ends) -> str:
    """First and last node of some axes, and how many they have."""
    return ", ".join(f"{name} {x[0]:.3g} to {x[-1]:.3g}{unit} ({x.size})" for name, x, unit in axes)
