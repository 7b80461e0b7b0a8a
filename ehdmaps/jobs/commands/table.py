"""`ehdmaps table`: make the film table, or tell what it holds; and that of points."""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np

from ehdmaps.outputs import Output, check_outputs, dataset_kind, written_aside
from ehdmaps.program import tell
from ehdmaps.table.file import KIND, TableFile, read_tables, shipped_tables, write_tables

_TOLD_EVERY = 20


def run(arguments: argparse.Namespace) -> tuple[str, int]:
    """Make a table, or show one; without a file, those that are shipped."""
    from ehdmaps.jobs.commands import point_table

    if arguments.part == "make" and arguments.points:
        return point_table.make(Path(arguments.output or "point_table.nc"))
    if arguments.part == "make":
        return _make(Path(arguments.output or "film_table.nc"))
    if arguments.file is None:
        return f"{_shown(shipped_tables())}\n\n{point_table.shown()}", 0
    path = Path(arguments.file)
    return point_table.shown(path) if point_table.is_one(path) else _shown(read_tables(path)), 0


def _make(path: Path) -> tuple[str, int]:
    """Solve all nodes and write them."""
    from ehdmaps.jobs.make.table_make import make_tables

    kind = dataset_kind("a film table of ehdmaps", KIND, (".nc",))
    check_outputs([Output("-o", path, kind)])

    def progress(law: str, done: int, of: int) -> None:
        if done % _TOLD_EVERY == 0 or done == of:
            tell(f"ehdmaps table: {law}, {done} of {of} lines")

    tables = make_tables(progress)
    with written_aside(path, kind) as aside:
        write_tables(aside, tables)
    return f"{path}: written\n{_shown(tables)}", 0


def _shown(tables: TableFile) -> str:
    """Nodes, provenance and errors as text."""
    lines = [f"{name}: {value}" for name, value in sorted(tables.attributes.items())]
    for law, table in tables.tables.items():
        piezo, iso = table.piezoviscous.axes, table.isoviscous.axes
        for part, shape, ends in (
            ("piezoviscous", piezo.shape, (
                ("zeta", piezo.zeta, ""), ("L", np.exp(piezo.size), ""),
                ("alpha", 1e9 * np.exp(piezo.alpha), " 1/GPa"), ("bend", piezo.bend, ""),
            )),
            ("isoviscous", iso.shape, (
                ("zeta", iso.zeta, ""), ("L/alpha", 1e-9 * np.exp(iso.size), " GPa"),
                ("alpha", 1e9 * iso.alpha, " 1/GPa"), ("1 - z", iso.bend, ""),
            )),
        ):  # fmt: skip
            nodes = ", ".join(f"{name} {x[0]:.3g} to {x[-1]:.3g}{unit} ({x.size})" for name, x, unit in ends)
            lines.append(f"{law}, {part}: {nodes}; {np.prod(shape)} films")
    return "\n".join(lines)
