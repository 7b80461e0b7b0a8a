"""Error budget of a measurement: by how much a quantity is wrong where a source is left out, or is not known.

A budget has a line for each source of error, with what it costs to have it. All is read from the rows of the
measurement.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from ehdmaps.trade.record import ErrorSummary, Trade


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
        return max((trade.quantity(name).printed(found.high) for name, found in self.errors.items()), default=0.0)


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
    marks = []
    for row, bar in enumerate(bars):
        for place, name in enumerate(trade.shown):
            found, printed = bar.errors.get(name), trade.quantity(name).printed
            if found is not None and found.high > 0.0:
                marks.append(Mark(row, place, printed(found.median), printed(found.high)))
    return tuple(marks)


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
