"""Answer of a measurement: which choice keeps a tolerance at the least cost, how good the default is, the error budget.

A budget has a line for each source of error: by how much a quantity is wrong where the source is left out, or is not
known, and what it costs to have it. Everything is read from the rows of the measurement.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import groupby

from ehdmaps.trade.record import Choice, ErrorSummary, Scope, Trade

TOLERANCES = (0.1, 1.0, 5.0)
"""Tolerances for which a choice is named [% or dB]."""

FACTORS = {"1": 100.0, "dB": 1.0}
"""From an error to what is printed, by the unit of the quantity."""

UNITS = {"1": "%", "dB": "dB"}


@dataclass(frozen=True)
class Bar:
    """Line of an error budget.

    Attributes
    ----------
    name : str
        Source of the error.
    errors : mapping of str to ErrorSummary
        Errors by the name of the quantity, where the source is left out.
    cost : float
        Cost with the source over that without it; NaN where nothing has it.
    against : str
        What the errors are relative to.
    """

    name: str
    errors: Mapping[str, ErrorSummary]
    cost: float
    against: str

    def largest(self, trade: Trade) -> float:
        """Largest 95 % quantile of its errors, as printed.

        Parameters
        ----------
        trade : Trade
            The measurement, which knows the units.
        """
        return max((size(trade, name, found.high) for name, found in self.errors.items()), default=0.0)


def size(trade: Trade, name: str, error: float) -> float:
    """An error as it is printed: in per cent, or dB.

    Parameters
    ----------
    trade : Trade
        The measurement, which knows the units.
    name : str
        The quantity.
    error : float
        Error of the quantity.
    """
    (unit,) = (judged.unit for judged in trade.judged if judged.name == name)
    return error * FACTORS[unit]


def cheapest(trade: Trade, scope: Scope, tolerance: float) -> tuple[Choice, ...]:
    """The cheapest choices of a scope that keep a tolerance at 95 % of the points; nothing where some group has none.

    Parameters
    ----------
    trade : Trade
        The measurement.
    scope : Scope
        What is answered.
    tolerance : float
        Tolerance [% or dB].
    """
    chosen = []
    for groups in scope.groups:
        kept = [
            choice
            for choice in trade.choices
            if choice.group in groups and choice.solved == choice.asked and _error(trade, scope, choice) <= tolerance
        ]
        if not kept:
            return ()
        chosen.append(min(kept, key=lambda choice: choice.seconds))
    return tuple(chosen)


def default(trade: Trade, scope: Scope) -> tuple[Choice, ...]:
    """The choices of a scope that are used where nothing is said; the cheapest, where there are more in a group.

    Parameters
    ----------
    trade : Trade
        The measurement.
    scope : Scope
        What is answered.
    """
    chosen = []
    for groups in scope.groups:
        usual = [choice for choice in trade.choices if choice.group in groups and choice.default]
        if usual:
            chosen.append(min(usual, key=lambda choice: _error(trade, scope, choice)))
    return tuple(chosen)


def budget(trade: Trade) -> tuple[Bar, ...]:
    """Lines of the error budget, the largest error first; sources that were not measured are left out.

    Parameters
    ----------
    trade : Trade
        The measurement.
    """
    bars = []
    for source in trade.sources:
        off = [choice for choice in trade.choices if choice.label == source.off]
        on = [choice for choice in trade.choices if choice.label == source.on]
        errors = {
            name: choice.errors[name]
            for choice in off
            for name in trade.shown
            if name in choice.errors and choice.errors[name].points
        }
        if not errors:
            continue
        # of a linear analysis and of a run the dearer one, which is the last
        costs = [
            having.seconds / choice.seconds
            for choice in off
            for having in on
            if choice.seconds and (having.group == choice.group or len(off) == len(on) == 1)
        ]
        against = next((choice.reference for choice in off if choice.reference), trade.reference)
        if max(found.high for found in errors.values()) > 0.0:
            bars.append(Bar(source.name, errors, costs[-1] if costs else math.nan, against))
    return tuple(sorted(bars, key=lambda bar: -bar.largest(trade)))


BUDGET_WORDS = "wrong by, where it is left out or not known: median to 95 % of the points"
"""What the axis of a budget shows."""

_DECADES = 1e-5
"""Lowest value of an axis over the largest one, but where a whole bar would lie below."""


@dataclass(frozen=True)
class Mark:
    """Bar of a drawn budget.

    Attributes
    ----------
    row, place : int
        Place of its source among the lines of the budget, and of its quantity among those that are shown.
    low, high : float
        Median and 95 % quantile, as printed; the median may be zero.
    """

    row: int
    place: int
    low: float
    high: float


def budget_marks(trade: Trade, bars: Sequence[Bar]) -> tuple[Mark, ...]:
    """Bars of a drawn budget; a quantity without an error above zero has none.

    Parameters
    ----------
    trade : Trade
        The measurement.
    bars : sequence of Bar
        Lines of its budget.
    """
    return tuple(
        Mark(row, place, size(trade, name, found.median), size(trade, name, found.high))
        for row, bar in enumerate(bars)
        for place, name in enumerate(trade.shown)
        if (found := bar.errors.get(name)) is not None and found.high > 0.0
    )


def budget_axis(trade: Trade, bars: Sequence[Bar]) -> tuple[float, float]:
    """Ends of the logarithmic axis of a budget, as printed: no bar lies below it as a whole.

    Parameters
    ----------
    trade : Trade
        The measurement.
    bars : sequence of Bar
        Lines of its budget; at least one.
    """
    marks = budget_marks(trade, bars)
    least, most = min(mark.high for mark in marks), max(mark.high for mark in marks)
    return min(0.3 * least, max(0.5 * min(mark.low for mark in marks), _DECADES * most)), 4.0 * most


def answer_lines(trade: Trade) -> Iterator[str]:
    """Lines that say what to use.

    Parameters
    ----------
    trade : Trade
        The measurement.
    """
    for scope in trade.scopes:
        usual = default(trade, scope)
        yield f"{scope.words}: what to use where 95 % of the points may be wrong by no more than"
        units = " or ".join(dict.fromkeys(UNITS[one.unit] for one in trade.judged if one.name in scope.judged))
        for chosen, alike in groupby(TOLERANCES, key=lambda tolerance: cheapest(trade, scope, tolerance)):
            head = f"{', '.join(f'{tolerance:g}' for tolerance in alike)} {units}"
            if chosen:
                ratio = _ratio(chosen, usual)
                yield f"  {head:12s} {_names(chosen)}: {_cost(trade, chosen, usual)}{_of_default(ratio)}"
            else:
                yield f"  {head:12s} nothing that was measured keeps it"
        if usual:
            errors = ", ".join(_words(trade, scope, usual))
            yield f"  {'default':12s} {_names(usual)}: {_cost(trade, usual, usual)}; wrong by {errors}"


def budget_lines(trade: Trade) -> Iterator[str]:
    """The error budget as a table.

    Parameters
    ----------
    trade : Trade
        The measurement.
    """
    bars = budget(trade)
    if not bars:
        return
    units = {judged.name: UNITS[judged.unit] for judged in trade.judged}
    yield "error budget: what is left out or not known, and by how much it is wrong then (median / 95 % of the points)"
    width = max(len(bar.name) for bar in bars) + 2
    heads = "".join(f"{f'{name}, {units[name]}':>20s}" for name in trade.shown)
    yield f"  {'':{width}s}{heads}   cost with it"
    for bar in bars:
        cells = "".join(f"{_cell(trade, name, bar.errors.get(name)):>20s}" for name in trade.shown)
        cost = f"x {number(bar.cost)}" if math.isfinite(bar.cost) else "-"
        yield f"  {bar.name:{width}s}{cells}   {cost}"


def number(value: float) -> str:
    """Return a number to two digits, without an exponent where that is short.

    Parameters
    ----------
    value : float
        The number; "-" if it is not finite.

    Examples
    --------
    >>> number(0.01234), number(1.2e-7), number(99.7), number(12345.0), number(float("nan"))
    ('0.012', '1.2e-07', '100', '12345', '-')
    """
    if not math.isfinite(value):
        return "-"
    return f"{value:.0f}" if 99.5 <= abs(value) < 1e6 else f"{value:.2g}"


def time_text(seconds: float) -> str:
    """Return a time to two digits, in us, ms or s.

    Parameters
    ----------
    seconds : float
        The time [s].

    Examples
    --------
    >>> time_text(2.2e-3), time_text(8.4e-5), time_text(72.0)
    ('2.2 ms', '84 us', '72 s')
    """
    for unit, factor in (("us", 1e6), ("ms", 1e3)):
        if seconds * factor < 1e3:
            return f"{number(seconds * factor)} {unit}"
    return f"{number(seconds)} s"


def _error(trade: Trade, scope: Scope, choice: Choice) -> float:
    """Largest 95 % quantile over what the scope judges, as printed; infinite where something is not known."""
    known = [
        size(trade, name, choice.errors[name].high) if name in choice.errors else math.inf for name in scope.judged
    ]
    return max((math.inf if math.isnan(value) else value for value in known), default=math.inf)


def _words(trade: Trade, scope: Scope, chosen: tuple[Choice, ...]) -> Iterator[str]:
    """Yield each quantity with the largest 95 % quantile over the choices."""
    units = {judged.name: UNITS[judged.unit] for judged in trade.judged}
    for name in scope.judged:
        worst = max(
            (size(trade, name, one.errors[name].high) for one in chosen if name in one.errors), default=math.nan
        )
        yield f"{number(worst)} {units[name]} of {name}"


def _names(chosen: tuple[Choice, ...]) -> str:
    """The choices in one phrase."""
    return " + ".join(choice.label for choice in chosen)


def _ratio(chosen: tuple[Choice, ...], usual: tuple[Choice, ...]) -> float:
    """Cost of choices that are made together over that of the default: the product of what each of them alone makes."""
    if len(chosen) != len(usual) or not all(choice.seconds > 0.0 for choice in usual):
        return math.nan
    return math.prod(one.seconds / other.seconds for one, other in zip(chosen, usual, strict=True))


def _cost(trade: Trade, chosen: tuple[Choice, ...], usual: tuple[Choice, ...]) -> str:
    """Cost of choices that are made together; of several, by that of the default."""
    ratio = _ratio(chosen, usual)
    alone = len(chosen) == 1 or not math.isfinite(ratio)
    seconds = max(choice.seconds for choice in (chosen if alone else usual)) * (1.0 if alone else ratio)
    return f"{time_text(seconds)}{trade.cost.removeprefix('s')}"


def _of_default(ratio: float) -> str:
    """Cost over that of the default, in words."""
    return f", {number(ratio)} of the default's" if math.isfinite(ratio) and abs(ratio - 1.0) > 0.05 else ""


def _cell(trade: Trade, name: str, found: ErrorSummary | None) -> str:
    """Median and 95 % quantile of one cell."""
    if found is None:
        return "-"
    return f"{number(size(trade, name, found.median))} / {number(size(trade, name, found.high))}"
