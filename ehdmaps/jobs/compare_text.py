"""A comparison of two maps as the table that is printed, and as JSON."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict
from typing import Any

from ehdmaps.jobs.compare import Comparison, Difference
from ehdmaps.jobs.report import AXES, NONE_STATED


def comparison_text(found: Comparison) -> str:
    """Return a comparison as the table that is printed.

    Parameters
    ----------
    found : Comparison
        The comparison.
    """
    return "\n".join(_lines(found))


def comparison_json(found: Comparison) -> str:
    """Return a comparison as JSON: its fields by their names, without single points; null for what is not known.

    Parameters
    ----------
    found : Comparison
        The comparison.
    """
    between = found.between
    record = {
        "names": found.names,
        "titles": found.titles,
        "points": found.points,
        "common": found.common,
        "solved": found.solved,
        "differing": found.differing,
        "differences": _records(found.differences),
        "between": None
        if between is None
        else {
            "points": len(between.sample.places),
            "seed": between.sample.seed,
            "ranges": between.sample.ranges,
            "differences": _records(between.differences),
        },
        "not_between": found.not_between,
    }
    return json.dumps(record, indent=2, allow_nan=False, ensure_ascii=False)


def _records(differences: Sequence[Difference]) -> list[dict[str, Any]]:
    """Differences as plain values."""
    return [
        {
            key: None if isinstance(value, float) and not math.isfinite(value) else value
            for key, value in asdict(entry).items()
        }
        for entry in differences
    ]


def _lines(found: Comparison) -> Iterator[str]:
    yield f"A  {found.names[0]}: {found.titles[0]}"
    yield f"B  {found.names[1]}: {found.titles[1]}"
    yield f"   differ in {', '.join(found.differing)}" if found.differing else "   made from the same settings"
    yield (
        f"   {found.common} points in common, {found.solved} of them solved in both "
        f"(A has {found.points[0]}, B {found.points[1]})"
    )
    yield from _table(found.differences, True)
    if found.between is not None:
        sample = found.between.sample
        ranges = ", ".join(_range(sample.ranges[axis], display) for axis, display in AXES)
        yield (
            f"   not all points are shared: films between them, as contact laws read them, at {len(sample.places)} "
            f"random points (seed {sample.seed}) of the common range, {ranges}; what each map is off by between its "
            "points is part of the differences"
        )
        yield from _table(found.between.differences, False)
    if found.not_between:
        yield f"   not all points are shared, and nothing is compared between them: {found.not_between}"


def _range(ends: tuple[float, float], display: Any) -> str:
    """A range in words."""
    return f"{display.text(ends[0])} to {display.text(ends[1])}"


def _table(differences: Sequence[Difference], stated: bool) -> Iterator[str]:
    """Yield a table of differences."""
    if not differences:
        return
    heads = f"{'over stated error':>20s}" if stated else ""
    yield f"{'(B - A)/|A|':27s}{'median size':>13s} {'95 %':>10s} {'largest':>10s} {'median':>10s}{heads}  largest at"
    for entry in differences:
        note = f"  ({entry.left_out} points where A is zero left out)" if entry.left_out else ""
        if not entry.place:
            yield f"  {entry.variable:25s} no point to compare{note}"
            continue
        numbers = f"{entry.median:13.3g} {entry.high:10.3g} {_signed(entry.worst):>10s} {_signed(entry.bias):>10s}"
        over = f"{_over(entry):>20s}" if stated else ""
        yield f"  {entry.variable:25s} {numbers}{over}  {_place(entry.place)}{note}"


def _signed(value: float) -> str:
    """A difference with its sign, nothing as 0."""
    return f"{value:+.3g}" if value else "0"


def _over(entry: Difference) -> str:
    """Median of the difference over stated errors, and share of the points above one."""
    if not math.isfinite(entry.over_stated):
        return NONE_STATED
    return f"{entry.over_stated:.2g}, {entry.beyond_stated:.0%} > 1"


def _place(place: Mapping[str, str | float]) -> str:
    """Say where a point lies."""
    return ", ".join([str(place["contact"]), *(display.text(float(place[name])) for name, display in AXES)])
