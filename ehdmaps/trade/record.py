"""Speed against accuracy as it was measured: rows of contacts and of machines, and the error budget made of them.

`Entry` is a way to an answer as it will be measured, beside what it is held against; `Trade` has choices with their
cost and their errors. A budget has a line for each source of error: by how much a quantity is wrong where it is left
out, or is not known, and what it costs to have it.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Generic, TypeVar

import numpy as np

from ehdmaps.arrays import FloatArray

Way_co = TypeVar("Way_co", covariant=True)
"""A way to an answer: a model of a contact, or a scene with its law."""


@dataclass(frozen=True)
class Group(Generic[Way_co]):
    """Entries with one truth.

    Attributes
    ----------
    name : str
        What is chosen, in words.
    truth : object
        What the entries are held against, such as the best affordable solution of the same physics.
    reference : str
        The truth in words, where it is not that of the measurement.
    least_film : float
        Film that errors of films are relative to at least [m], where films go through zero.
    """

    name: str
    truth: Way_co
    reference: str = ""
    least_film: float = 0.0


@dataclass(frozen=True)
class Entry(Generic[Way_co]):
    """One way to an answer, as it is measured.

    Attributes
    ----------
    group : Group
        Group that it stands in.
    label : str
        Name in the table, different from all others of its group.
    way : object
        What answers.
    finest : object, optional
        Finest affordable solution of the same model; None where it has no discretisation, or that is not affordable.
    closed : bool
        Whether it is a closed form: all of its error is that of the model.
    default : bool
        Whether it is what is used where nothing is said.
    few : bool
        Whether a point takes seconds: it is asked at a few points only.
    lacks, has : str
        Source of error, for the error budget, that it leaves out, and one that it has; empty where it stands for none.
    """

    group: Group[Way_co]
    label: str
    way: Way_co
    finest: Way_co | None = None
    closed: bool = False
    default: bool = False
    few: bool = False
    lacks: str = ""
    has: str = ""

    def choice(self, kind: str, seconds: float, errors: Mapping[str, ErrorSummary], **further: Any) -> Choice:
        """The row of what was measured.

        Parameters
        ----------
        kind : str
            Begin of the name of its group, such as "run-up: ".
        seconds : float
            Processor time, as `Trade.cost` says.
        errors : mapping of str to ErrorSummary
            Errors by the name of the quantity; those without a point are left out.
        **further
            Other fields of `Choice`.
        """
        known = {name: found for name, found in errors.items() if found.points}
        return Choice(
            f"{kind}{self.group.name}",
            self.label,
            seconds,
            known,
            default=self.default,
            reference=self.group.reference,
            **further,
        )


@dataclass(frozen=True)
class Judged:
    """A quantity that a user looks at.

    Attributes
    ----------
    name : str
        Name in words, such as "stiffness".
    unit : {"1", "dB"}
        Unit of its error: relative to the reference, or a difference of levels.
    """

    name: str
    unit: str = "1"

    @property
    def printed_unit(self) -> str:
        """Unit of an error as it is printed."""
        return "%" if self.unit == "1" else self.unit

    def printed(self, error: float) -> float:
        """An error as it is printed: in per cent, or dB.

        Parameters
        ----------
        error : float
            Error of the quantity.
        """
        return error * 100.0 if self.unit == "1" else error


@dataclass(frozen=True)
class ErrorSummary:
    """Sizes of the errors of one quantity over the points of a sample.

    Attributes
    ----------
    points : int
        How many points were compared.
    median, high, largest : float
        Median, 95 % quantile and largest value of the sizes; NaN without a point.
    bias : float
        Median of the signed errors.
    worst : str
        Place of the largest one, in words; empty without a point.
    stated : float
        Median of the errors that the choice states of itself; NaN where it states none.
    covered : float
        Share of the points whose error is not above the stated one; NaN where none is stated.
    """

    points: int
    median: float
    high: float
    largest: float
    bias: float
    worst: str
    stated: float = np.nan
    covered: float = np.nan

    @classmethod
    def of(cls, errors: FloatArray, places: Sequence[str], stated: FloatArray | None = None) -> ErrorSummary:
        """Sum up signed errors.

        Parameters
        ----------
        errors : array (n,)
            Signed errors; those that are not finite are left out.
        places : sequence of str
            Place of each error, in words.
        stated : array (n,), optional
            Error that the choice states of each point; NaN where it states none.

        Examples
        --------
        >>> import numpy as np
        >>> summary = ErrorSummary.of(np.array([-0.02, 0.01, np.nan]), ["a", "b", "c"], np.array([0.03, 0.005, 0.1]))
        >>> summary.points, summary.largest, summary.worst, summary.covered
        (2, 0.02, 'a', 0.5)
        """
        known = np.isfinite(errors)
        if not known.any():
            return cls(0, np.nan, np.nan, np.nan, np.nan, "")
        sizes = np.abs(errors[known])
        middle, high, largest = (float(value) for value in np.quantile(sizes, (0.5, 0.95, 1.0)))
        worst = np.asarray(places, dtype=object)[known][int(np.argmax(sizes))]
        own = np.full(sizes.shape, np.nan) if stated is None else np.asarray(stated, dtype=np.float64)[known]
        has_own = np.isfinite(own)
        return cls(
            points=sizes.size,
            median=middle,
            high=high,
            largest=largest,
            bias=float(np.median(errors[known])),
            worst=str(worst),
            stated=float(np.median(own[has_own])) if has_own.any() else np.nan,
            covered=float(np.mean(sizes[has_own] <= own[has_own])) if has_own.any() else np.nan,
        )


@dataclass(frozen=True)
class Choice:
    """One choice of model or setting, with its cost and its errors.

    Attributes
    ----------
    group : str
        What is chosen, such as "resolution" or "law"; choices of a group stand together.
    label : str
        The choice, such as "reynolds, density 12".
    seconds : float
        Cost, as `Trade.cost` says: processor time.
    errors : mapping of str to ErrorSummary
        Errors against the reference, by the name of the quantity; a quantity that was not judged is left out.
    numerical : mapping of str to ErrorSummary
        The part of them that a finer solution of the same model takes away; empty where it was not told apart.
    model : mapping of str to ErrorSummary
        The part that stays with the finest solution of the same model; empty where it was not told apart.
    solved, asked : int
        Points with a usable answer, of how many.
    lost : tuple of str
        Points without one, each with its place and cause.
    default : bool
        Whether this is what is used where a user says nothing.
    reference : str
        What its errors are relative to where that is not the reference of the trade; empty where it is.
    """

    group: str
    label: str
    seconds: float
    errors: Mapping[str, ErrorSummary]
    numerical: Mapping[str, ErrorSummary] = field(default_factory=dict)
    model: Mapping[str, ErrorSummary] = field(default_factory=dict)
    solved: int = 1
    asked: int = 1
    lost: tuple[str, ...] = ()
    default: bool = False
    reference: str = ""


@dataclass(frozen=True)
class Scope:
    """Something to be answered: one choice of each of its sets of groups.

    Attributes
    ----------
    words : str
        What is answered.
    groups : tuple of tuple of str
        Sets of groups: of the choices in the groups of one set, one is taken.
    judged : tuple of str
        Names of the quantities that have to keep a tolerance.
    """

    words: str
    groups: tuple[tuple[str, ...], ...]
    judged: tuple[str, ...]


@dataclass(frozen=True)
class Source:
    """A source of error, for the error budget.

    Attributes
    ----------
    name : str
        What is left out, or is not known.
    off : str
        Label of the choice that leaves it out.
    on : str
        Label of the choice that has it; empty where nothing has.
    """

    name: str
    off: str
    on: str = ""


@dataclass(frozen=True)
class Trade:
    """A measurement of speed against accuracy.

    Attributes
    ----------
    level : {"contact", "map", "system"}
        Level of the model that was varied.
    title : str
        What was measured on, in words.
    cost : str
        What `Choice.seconds` counts, such as "s a point" or "s a run".
    reference : str
        What errors are relative to, in words.
    judged : tuple of Judged
        The quantities, in the order of the columns.
    choices : tuple of Choice
        The rows.
    frame : tuple of str
        What a reader must know besides: seed, sample, sensor, clearance, and what could not be compared.
    scopes : tuple of Scope
        What is answered first.
    sources : tuple of Source
        Lines of the error budget.
    shown : tuple of str
        Quantities of the error budget, by name.
    """

    level: str
    title: str
    cost: str
    reference: str
    judged: tuple[Judged, ...]
    choices: tuple[Choice, ...]
    frame: tuple[str, ...] = ()
    scopes: tuple[Scope, ...] = ()
    sources: tuple[Source, ...] = ()
    shown: tuple[str, ...] = ()

    def quantity(self, name: str) -> Judged:
        """One of the quantities.

        Parameters
        ----------
        name : str
            Name of the quantity.
        """
        return next(judged for judged in self.judged if judged.name == name)


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
