"""What a run of `generate` did, in words."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from ehdmaps.jobs.correction_report import correction_lines
from ehdmaps.jobs.generate import Generated
from ehdmaps.jobs.report import (
    error_lines,
    extrapolated_lines,
    films_lines,
    holes,
    law_lines,
    status_lines,
)
from ehdmaps.maps.records import record_from_json


def summary(generated: Generated, output: Path) -> str:
    """Return the summary that is printed after a run.

    Parameters
    ----------
    generated : Generated
        The finished map.
    output : Path
        File of the map.
    """
    return "\n".join(_lines(generated, output))


def _lines(generated: Generated, output: Path) -> Iterator[str]:
    dataset, sweep = generated.dataset, generated.sweep
    yield f"{output}: {dataset.attrs['title']}"
    if estimated := record_from_json(dataset.attrs["geometry"], "geometry").get("estimated"):
        yield f"  bearing: {estimated}"
    counts = f"{sweep.taken_over} taken over, {sweep.solved} solved now"
    yield f"points: {counts}, {holes(dataset)} without a solution"
    yield from films_lines(dataset)
    if sweep.damaged:
        yield f"store: {sweep.damaged} damaged entries were solved again"
    yield from status_lines(dataset)
    yield from extrapolated_lines(dataset)
    yield "accuracy"
    yield from error_lines(dataset)
    yield from law_lines(dataset)
    yield from correction_lines(dataset)
    seconds = float(np.nansum(dataset["solve_seconds"].values))
    yield f"time: {sweep.wall_seconds:.1f} s now; {seconds:.1f} s of solving in the whole map, all cores"
    if int(dataset.attrs["lubricant_verified"]) == 0:
        estimated = json.loads(dataset.attrs["lubricant"]).get("estimated")
        yield f"lubricant: {estimated or 'its data are not verified; see the reference page'}"
