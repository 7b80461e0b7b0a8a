"""Make a film table anew: `python -m examples.tables lines` or `points`, in a clone."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

from ehdmaps.outputs import Output, check_outputs, dataset_kind, written_aside
from ehdmaps.program import Parser, run, tell
from ehdmaps.table.file import KIND
from ehdmaps.table.points import file as points_file
from examples.tables.files import write_point_table, write_tables
from examples.tables.lines import make_tables
from examples.tables.points import make_point_table

_TOLD_EVERY = 20


def parser() -> argparse.ArgumentParser:
    """Return the parser."""
    found = Parser(prog="python -m examples.tables", description="Solve the films of a table that comes with ehdmaps.")
    found.add_version()
    found.add_argument("table", choices=("lines", "points"), help="of line contacts, or of point contacts")
    found.add_argument("-o", "--output", metavar="FILE.nc", help="default: film_table.nc, or point_table.nc")
    return found


def main(argv: Sequence[str] | None = None) -> int:
    """Run the command and return its exit status."""
    return run(parser(), _command, argv)


def _command(arguments: argparse.Namespace) -> tuple[str, int]:
    """Solve all nodes and write them."""
    lines = arguments.table == "lines"
    path = Path(arguments.output or ("film_table.nc" if lines else "point_table.nc"))
    words = ("a film table of ehdmaps", KIND) if lines else ("a film table of points of ehdmaps", points_file.KIND)
    kind = dataset_kind(*words, (".nc",))
    check_outputs([Output("-o", path, kind)])
    if lines:
        made = make_tables(lambda law, done, of: _tell(f"{law}, ", done, of))
        with written_aside(path, kind) as aside:
            write_tables(aside, made)
    else:
        table = make_point_table(progress=lambda done, of: _tell("", done, of))
        with written_aside(path, kind) as aside:
            write_point_table(aside, table)
    return f"{path}: written", 0


def _tell(law: str, done: int, of: int) -> None:
    """Say now and then how far it is."""
    if done % _TOLD_EVERY == 0 or done == of:
        tell(f"{law}{done} of {of} lines")


if __name__ == "__main__":
    sys.exit(main())
