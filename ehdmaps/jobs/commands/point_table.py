"""Make the film table of point contacts, or tell what it holds, for `ehdmaps table`."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from ehdmaps.outputs import MADE_AS, Output, check_outputs, dataset_kind, root_attributes, written_aside
from ehdmaps.program import tell
from ehdmaps.table.nodes import decoded
from ehdmaps.table.points.file import KIND, read_point_table, shipped_point_table, write_point_table
from ehdmaps.table.points.films import PointTable
from ehdmaps.table.points.nodes import ERRORS, FILMS, HOLE, SLOPE

_TOLD_EVERY = 10


def make(path: Path) -> tuple[str, int]:
    """Solve all nodes and write them.

    Parameters
    ----------
    path : Path
        The file.
    """
    from ehdmaps.jobs.make.points.table import make_point_table

    kind = dataset_kind("a film table of points of ehdmaps", KIND, (".nc",))
    check_outputs([Output("-o", path, kind)])

    def progress(done: int, of: int) -> None:
        if done % _TOLD_EVERY == 0 or done == of:
            tell(f"ehdmaps table: {done} of {of} lines")

    table = make_point_table(progress=progress)
    with written_aside(path, kind) as aside:
        write_point_table(aside, table)
    return f"{path}: written\n{_shown(table)}", 0


def is_one(path: Path) -> bool:
    """Tell whether a file is a table of points; False where it cannot be read.

    Parameters
    ----------
    path : Path
        The file.
    """
    return root_attributes(path).get(MADE_AS) == KIND


def shown(path: Path | None = None) -> str:
    """Nodes, provenance, holes and errors of a file, or of the table that is shipped.

    Parameters
    ----------
    path : Path, optional
        The file.
    """
    return _shown(shipped_point_table() if path is None else read_point_table(path))


def _shown(table: PointTable) -> str:
    """Nodes, provenance, holes and errors as text."""
    axes, codes = table.nodes.axes, table.nodes.codes
    lines = [f"{name}: {value}" for name, value in sorted(table.attributes.items())]
    ends = (
        ("zeta", axes.zeta, ""), ("L", np.exp(axes.size), ""), ("ellipticity", np.exp(axes.shape), ""),
        ("alpha", 1e9 * np.exp(axes.alpha), " 1/GPa"), ("bend", axes.bend, ""),
    )  # fmt: skip
    lines.append(", ".join(f"{name} {x[0]:.3g} to {x[-1]:.3g}{unit} ({x.size})" for name, x, unit in ends))
    holes, continued = codes[..., 0] == HOLE, table.nodes.continued
    lines.append(
        f"{holes.size} cells, {np.count_nonzero(holes)} of them holes: a corner has no solution; "
        f"{np.count_nonzero(continued)} of heavy contacts, continued from lighter loads, not in the errors below"
    )
    errors = 100.0 * decoded(codes[~holes & ~continued])
    for name in (*(field.name for field in FILMS), SLOPE):
        column = errors[:, ERRORS.index(name)]
        lines.append(
            f"error of {name}: median {np.median(column):.2g} %, 95 of 100 below {np.percentile(column, 95):.2g} %"
        )
    return "\n".join(lines)
