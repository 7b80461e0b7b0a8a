"""A measurement of speed against accuracy as printed tables."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from itertools import groupby

from ehdmaps.trade.record import Choice, Judged, Trade
from mbs.laboratory.tradeoff.answer import answer_lines, budget_lines, number

_COLUMNS, _CELL, _GAP = 4, 18, 2
"""Quantities beside each other, least width of one, and the gap before its name."""

_NOTHING = "-"


def trade_text(trade: Trade, everything: bool = True) -> str:
    """Return a measurement as it is printed: what to use, the error budget, and all tables.

    Parameters
    ----------
    trade : Trade
        The measurement.
    everything : bool
        Whether the tables follow, the errors apart, the worst places and what has no answer.
    """
    lines = [trade.title, *(trade.frame[:1] if trade.scopes else ()), *answer_lines(trade)]
    if table := list(budget_lines(trade)):
        lines += ["", *table]
    if everything:
        return "\n".join([*lines, *([""] if trade.scopes else []), *_lines(trade)])
    return "\n".join([*lines, "", "all tables, their frame and the worst places: --all; all numbers: -o or --json"])


def _lines(trade: Trade) -> Iterator[str]:
    yield f"reference: {trade.reference}"
    yield from trade.frame
    yield ""
    yield "errors against the reference, median / 95 %"
    yield from _table(trade, _error)
    if any(choice.default for choice in trade.choices):
        yield "* what is used where nothing is said"
    if any(choice.numerical or choice.model for choice in trade.choices):
        yield ""
        yield "the same apart, medians: numerical error, which a finer solution takes away / error of the model"
        yield from _table(trade, _apart, lambda choice: bool(choice.numerical or choice.model))
    if any(_states(choice) for choice in trade.choices):
        yield ""
        yield "error that each states of itself, median / share of the points whose numerical error is not above it"
        yield from _table(trade, _stated, _states)
    yield ""
    yield "largest error of each, and where"
    for choice in trade.choices:
        yield from _worst(choice, trade.judged)
    yield from _unanswered(trade)


def _table(
    trade: Trade,
    cell: Callable[[Choice, Judged], str],
    wanted: Callable[[Choice], bool] = lambda choice: True,
) -> Iterator[str]:
    """Yield tables of the choices that are wanted, by group: so many that their lines do not become too long."""
    width = max(len(choice.label) for choice in trade.choices) + 4
    for first in range(0, len(trade.judged), _COLUMNS):
        columns = trade.judged[first : first + _COLUMNS]
        names = [f"{judged.name}, {judged.printed_unit}" for judged in columns]
        widths = [max(_CELL, len(name) + _GAP) for name in names]
        heads = "".join(f"{name:>{wide}s}" for name, wide in zip(names, widths, strict=True))
        yield f"{'':{width}s}{trade.cost:>12s}{'solved':>12s}{heads}"
        rows = [(choice, [cell(choice, one) for one in columns]) for choice in trade.choices if wanted(choice)]
        # what has nothing to say in any table stands in the first one
        silent = [first == 0 and all(cell(choice, one) == _NOTHING for one in trade.judged) for choice, _ in rows]
        shown = [row for row, mute in zip(rows, silent, strict=True) if mute or set(row[1]) != {_NOTHING}]
        for (group, reference), chosen in groupby(shown, key=lambda row: (row[0].group, row[0].reference)):
            yield f"{group}, against {reference}" if reference else group
            for choice, texts in chosen:
                mark = "*" if choice.default else " "
                cells = "".join(f"{text:>{wide}s}" for text, wide in zip(texts, widths, strict=True))
                solved = f"{choice.solved}/{choice.asked}"
                yield f"{mark} {choice.label:{width - 2}s}{number(choice.seconds):>12s}{solved:>12s}{cells}"


def _error(choice: Choice, judged: Judged) -> str:
    """Median and 95 % quantile."""
    summary = choice.errors.get(judged.name)
    return _NOTHING if summary is None else _pair(summary.median, summary.high, judged)


def _apart(choice: Choice, judged: Judged) -> str:
    """Medians of the numerical error and of that of the model."""
    numerical, model = (
        math.nan if part is None else part.median
        for part in (choice.numerical.get(judged.name), choice.model.get(judged.name))
    )
    return _pair(numerical, model, judged)


def _stated(choice: Choice, judged: Judged) -> str:
    """Error that is stated, and how often it holds."""
    # the numerical ones, where they are told apart
    summary = choice.numerical.get(judged.name) or choice.errors.get(judged.name)
    if summary is None or not math.isfinite(summary.stated):
        return _NOTHING
    return f"{number(judged.printed(summary.stated))} / {summary.covered:.0%}"


def _states(choice: Choice) -> bool:
    """Tell whether a choice states errors of itself."""
    return any(
        math.isfinite(summary.stated)
        for summary in (*choice.numerical.values(), *choice.errors.values())
        if summary.points
    )


def _pair(first: float, second: float, judged: Judged) -> str:
    """Two errors in the unit of the column."""
    if not (math.isfinite(first) or math.isfinite(second)):
        return _NOTHING
    return f"{number(judged.printed(first))} / {number(judged.printed(second))}"


def _worst(choice: Choice, judged: tuple[Judged, ...]) -> Iterator[str]:
    """Yield the largest errors of a choice; one line for all quantities that have it at the same place."""
    places: dict[str, list[str]] = {}
    for quantity in judged:
        summary = choice.errors.get(quantity.name)
        if summary is not None and summary.points and summary.largest > 0.0:
            words = f"{quantity.name} {number(quantity.printed(summary.largest))} {quantity.printed_unit}"
            places.setdefault(summary.worst, []).append(words)
    for place, errors in places.items():
        yield f"  {choice.label}: {', '.join(errors)}" + (f" at {place}" if place else "")


def _unanswered(trade: Trade) -> Iterator[str]:
    """Yield what has no answer, and is in no error."""
    if any(choice.lost for choice in trade.choices):
        yield ""
        yield "without an answer, and in no error"
        for choice in trade.choices:
            for point in choice.lost:
                yield f"  {choice.label}: {point}"
