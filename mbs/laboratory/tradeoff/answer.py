"""Answer of a measurement: which choice keeps a tolerance at the least cost, how good the default is, the error budget.

Everything is read from the rows of the measurement.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import groupby

from ehdmaps.trade.record import Choice, ErrorSummary, Scope, Trade, budget

TOLERANCES = (0.1, 1.0, 5.0)
"""Tolerances for which a choice is named [% or dB]."""


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
        units = " or ".join(dict.fromkeys(one.printed_unit for one in trade.judged if one.name in scope.judged))
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
    yield "error budget: what is left out or not known, and by how much it is wrong then (median / 95 % of the points)"
    width = max(len(bar.name) for bar in bars) + 2
    heads = "".join(f"{f'{name}, {trade.quantity(name).printed_unit}':>20s}" for name in trade.shown)
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
        trade.quantity(name).printed(choice.errors[name].high) if name in choice.errors else math.inf
        for name in scope.judged
    ]
    return max((math.inf if math.isnan(value) else value for value in known), default=math.inf)


def _words(trade: Trade, scope: Scope, chosen: tuple[Choice, ...]) -> Iterator[str]:
    """Yield each quantity with the largest 95 % quantile over the choices."""
    for name in scope.judged:
        judged = trade.quantity(name)
        worst = max((judged.printed(one.errors[name].high) for one in chosen if name in one.errors), default=math.nan)
        yield f"{number(worst)} {judged.printed_unit} of {name}"


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
    printed = trade.quantity(name).printed
    return f"{number(printed(found.median))} / {number(printed(found.high))}"
