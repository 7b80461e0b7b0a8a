"""The maps of a batch as a table: for readers, and as CSV for programs."""

from __future__ import annotations

import csv
import io
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from ehdmaps.jobs.make.batch import SUMMARY
from ehdmaps.jobs.make.batch_generate import FAILED, READ, BatchResult, Outcome
from ehdmaps.jobs.make.status import duration
from ehdmaps.outputs import MARK, TABLE, write_text

_SHOWN = 30
"""Maps that are not good and that are named on a terminal; all stand in the table."""

_COLUMNS = ("map", "bearing", "oil", "override", "state", "films", "points_without_solution", "laws_miss", "seconds")


def write_table(result: BatchResult, folder: Path) -> Path:
    """Write the table of all maps into their folder, and return its file.

    Parameters
    ----------
    result : BatchResult
        What became of the maps.
    folder : Path
        Folder of the maps.

    Raises
    ------
    InputError
        If it may not be replaced, or cannot be written.
    """
    path = folder / SUMMARY
    write_text(path, table(result), TABLE)
    return path


def table(result: BatchResult) -> str:
    """Return the table as CSV: a comment with the mark of the program, a header with units, one line a map.

    Parameters
    ----------
    result : BatchResult
        What became of the maps.
    """
    figures = next((tuple(outcome.figures) for outcome in result.outcomes if outcome.figures), ())
    out = io.StringIO()
    out.write(
        f"# {MARK}: maps of the batch {result.batch.name}; numbers of the first contact at the middle of the axes\n"
    )
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow([*_COLUMNS, *figures, "reason"])
    for outcome in result.outcomes:
        member = outcome.member
        writer.writerow(
            [
                outcome.output.name,
                member.bearing,
                member.oil,
                member.override,
                outcome.state,
                outcome.films,
                outcome.lost if outcome.state != FAILED else "",
                "; ".join(outcome.missed),
                f"{outcome.seconds:.2f}",
                *(f"{outcome.figures[name]:.6g}" if name in outcome.figures else "" for name in figures),
                " ".join(outcome.reason.split()),
            ]
        )
    return out.getvalue()


def table_dataset(result: BatchResult) -> xr.Dataset:
    """Return the table as a dataset over the names of the maps.

    Parameters
    ----------
    result : BatchResult
        What became of the maps.
    """
    outcomes = result.outcomes
    texts = {
        "file": [str(outcome.output) for outcome in outcomes],
        "bearing": [outcome.member.bearing for outcome in outcomes],
        "oil": [outcome.member.oil for outcome in outcomes],
        "override": [outcome.member.override for outcome in outcomes],
        "state": [outcome.state for outcome in outcomes],
        "films": [outcome.films for outcome in outcomes],
        "laws_miss": ["; ".join(outcome.missed) for outcome in outcomes],
        "reason": [outcome.reason for outcome in outcomes],
    }
    values: dict[str, tuple[str, Any, dict[str, str]]] = {name: ("map", column, {}) for name, column in texts.items()}
    values["points_without_solution"] = ("map", [outcome.lost for outcome in outcomes], {})
    values["seconds"] = ("map", [outcome.seconds for outcome in outcomes], {"units": "s"})
    for name in next((tuple(outcome.figures) for outcome in outcomes if outcome.figures), ()):
        word, _, unit = name.removesuffix("]").partition(" [")
        values[word] = ("map", [outcome.figures.get(name, np.nan) for outcome in outcomes], {"units": unit})
    return xr.Dataset(values, coords={"map": [outcome.member.name for outcome in outcomes]})


def summary(result: BatchResult, written: Path) -> str:
    """Return what is printed after a run.

    Parameters
    ----------
    result : BatchResult
        What became of the maps.
    written : Path
        File of the table.
    """
    return "\n".join(_lines(result, written))


def _lines(result: BatchResult, written: Path) -> Iterator[str]:
    """Yield the lines of the summary."""
    counts = Counter(outcome.state for outcome in result.outcomes)
    states = ", ".join(f"{count} {state}" for state, count in sorted(counts.items(), reverse=True))
    yield f"{result.batch.name}: {len(result.outcomes)} maps: {states}"
    if read := sum(outcome.films == READ for outcome in result.outcomes):
        yield f"films: {read} maps read from the film table"
    yield f"points: {result.sweep.taken_over} taken over, {result.sweep.solved} solved now"
    if result.sweep.damaged:
        yield f"store: {result.sweep.damaged} damaged entries were solved again"
    bad = [outcome for outcome in result.outcomes if not outcome.good]
    for outcome in bad[:_SHOWN]:
        yield f"{outcome.output.name}: {_words(outcome)}"
    if len(bad) > _SHOWN:
        yield f"and {len(bad) - _SHOWN} more, see the table"
    yield f"wall time: {duration(result.wall_seconds)}"
    yield f"table: {written}"


def _words(outcome: Outcome) -> str:
    """Shortcomings of a map, in words."""
    if outcome.state == FAILED:
        return f"failed: {outcome.reason}"
    shortcomings = [f"{outcome.lost} points without a solution"] if outcome.lost else []
    return "; ".join([*shortcomings, *outcome.missed])
