"""The band of a result: what it may be where a machine is not known, one unknown at a time.

The centre is the result as it is printed, with stiffness and damping that are means over some cage angles. Each unknown
is taken to both ends of its range, everything else as stated, and the whole analysis is done again: that is a look. A
look that one side lacks, since it would cost a new law for little, is the other one reflected. Each side of the band
adds its own changes d as squares, with what numerics leave open as one more term; what is one thing or another, such as
a profile, and no spread, is added as it is, so that a band encloses those of both:

    high = value + sum members max(d, 0) + sqrt(sum max(d, 0)^2 + numerics^2),    low likewise.

Frequencies, damping ratios, K, C and all else that has one sign are taken by their logarithms: what makes a value three
times as large and what doubles it make it six times as large together. Levels and other values of either sign are
added.

For many independent unknowns, each uniform within its half-width a, 1.645 standard deviations of the sum are
0.95 sqrt(sum a^2): a band of about 90 %. Sides are kept apart, for clearances and cages move damping far more one way
than the other. Where a cage stands is one unknown more: its term is the range over machines whose cages do not turn,
which means hide.

Derivatives do not do: 20 um of clearance change a damping ratio by a factor of four.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from ehdmaps.arrays import BoolArray, FloatArray, IntArray
from ehdmaps.errors import AnalysisError, InputError
from mbs.scene.scene import Scene
from mbs.unknowns.unknown import Unknown

Look = Callable[[Scene, bool], FloatArray]
"""Values of a scene, in the order of the centre; NaN for what it has no longer. True: its cages do not turn."""

UNSURE = 0.5
"""Part of a value from which on a side of its band makes it unsure."""


@dataclass(frozen=True, eq=False)
class Term:
    """Changes of values by one unknown.

    Attributes
    ----------
    name, group : str
        What it is, and what a statement of it is called.
    rise, fall : array of any shape
        Change by which each value may be larger, and smaller, both >= 0, in its unit.
    member : bool
        Whether it is one thing or another, and no spread.
    """

    name: str
    group: str
    rise: FloatArray
    fall: FloatArray
    member: bool = False

    @property
    def size(self) -> FloatArray:
        """The larger side."""
        return np.maximum(self.rise, self.fall)

    def of(self, place: Any) -> Term:
        """The changes of some of the values, by any index of arrays."""
        return dataclasses.replace(self, rise=self.rise[place], fall=self.fall[place])

    def scaled(self, factor: float) -> Term:
        """The changes in another unit."""
        return dataclasses.replace(self, rise=factor * self.rise, fall=factor * self.fall)


@dataclass(frozen=True, eq=False)
class Band:
    """Values with what they may be: 90 % of what is not known.

    Attributes
    ----------
    value : array of any shape
        The results, in their units; values that are never negative have no negative bound.
    numerics : array of the same shape
        What numerics leave open, either way.
    terms : tuple of Term
        Changes by each unknown.
    lost : array of int, same shape
        Number of looks in which a value was not found again; these count as no change.
    looks : int
        Number of looks.
    refused : tuple of str
        Unknowns that could not be looked at, each with the reason.
    signed : array of bool, same shape, or None
        True for values that may have either sign, such as levels and coupling stiffnesses; None: none of them.
    beside : tuple of Term
        Changes by alternatives, which are no spread and in no bound.
    """

    value: FloatArray
    numerics: FloatArray
    terms: tuple[Term, ...]
    lost: IntArray
    looks: int = 0
    refused: tuple[str, ...] = ()
    signed: BoolArray | None = None
    beside: tuple[Term, ...] = ()

    @cached_property
    def rise(self) -> FloatArray:
        """Distance from the value to the upper bound."""
        size = np.abs(self.value)
        total = self._together(lambda term: term.rise, np.log1p)
        return np.asarray(np.where(self._by_factors, size * np.expm1(np.where(self._by_factors, total, 0.0)), total))

    @cached_property
    def fall(self) -> FloatArray:
        """Distance from the value to the lower bound."""
        size = np.abs(self.value)
        total = self._together(lambda term: term.fall, lambda part: -np.log1p(-np.minimum(part, 1.0)))
        least = np.where(self._by_factors, -size * np.expm1(-total), total)
        return np.asarray(np.where(self._either_sign, least, np.minimum(least, self.value)))

    @cached_property
    def high(self) -> FloatArray:
        """Upper bounds."""
        return self.value + self.rise

    @cached_property
    def low(self) -> FloatArray:
        """Lower bounds."""
        return self.value - self.fall

    @property
    def _either_sign(self) -> BoolArray:
        """Values that may have either sign."""
        signed = np.zeros(self.value.shape, dtype=np.bool_) if self.signed is None else self.signed
        return np.asarray(signed | (self.value < 0.0))

    @property
    def _by_factors(self) -> BoolArray:
        """Values whose changes multiply."""
        return np.asarray(~self._either_sign & (self.value > 0.0))

    @property
    def smaller(self) -> FloatArray:
        """The smaller side, whose first two digits are what a value deserves."""
        return np.minimum(self.rise, self.fall)

    @property
    def unsure(self) -> BoolArray:
        """True where a side is larger than `UNSURE` of the value."""
        return np.asarray(np.maximum(self.rise, self.fall) > UNSURE * np.abs(self.value))

    def without(self, *groups: str) -> Band:
        """The band if all of some groups were stated exactly."""
        return dataclasses.replace(self, terms=tuple(term for term in self.terms if term.group not in groups))

    def of(self, place: Any) -> Band:
        """The band of some of the values, by any index of arrays."""
        return dataclasses.replace(
            self,
            value=self.value[place],
            numerics=self.numerics[place],
            terms=tuple(term.of(place) for term in self.terms),
            lost=self.lost[place],
            signed=None if self.signed is None else self.signed[place],
            beside=tuple(term.of(place) for term in self.beside),
        )

    def scaled(self, factor: float) -> Band:
        """The band in another unit."""
        return dataclasses.replace(
            self,
            value=factor * self.value,
            numerics=factor * self.numerics,
            terms=tuple(term.scaled(factor) for term in self.terms),
            beside=tuple(term.scaled(factor) for term in self.beside),
        )

    def largest(self, place: Any = ..., count: int = 2) -> list[Term]:
        """The terms that decide some of the values: their root mean squares, in parts of the values, are largest.

        Parameters
        ----------
        place : index
            Which of the values.
        count : int
            How many terms at most; fewer where others do nothing.
        """
        with np.errstate(divide="ignore", invalid="ignore"):
            parts = {t.name: _mean_square(t.size[place] / np.abs(self.value[place])) for t in self.terms}
        some = [term for term in self.terms if parts[term.name] > 0.0]
        return sorted(some, key=lambda term: -parts[term.name])[:count]

    def _together(self, side: Callable[[Term], FloatArray], log: Callable[[FloatArray], FloatArray]) -> FloatArray:
        """One side of all terms and of the numerics; by `log` of its parts of the values where changes multiply."""
        size = np.where(self._by_factors, self.value, 1.0)

        def measure(change: FloatArray) -> FloatArray:
            with np.errstate(divide="ignore"):  # a value that may be nothing
                return np.asarray(np.where(self._by_factors, log(change / size), change))

        squares, members = measure(np.nan_to_num(self.numerics)) ** 2, np.zeros(self.value.shape)
        for term in self.terms:
            if term.member:
                members = members + measure(side(term))
            else:
                squares = squares + measure(side(term)) ** 2
        return np.asarray(members + np.sqrt(squares) + 0.0 * self.value)  # no band where there is no value


def band(look: Look, centre: FloatArray, unknowns: Sequence[Unknown], numerics: FloatArray) -> Band:
    """Find the band of results.

    Parameters
    ----------
    look : callable
        Does the analysis of a scene again.
    centre : array
        The results, as printed.
    unknowns : sequence of Unknown
        What is not known of the scene that they are of.
    numerics : array
        What numerics leave open of the results, either way; NaN where that is not known.

    Notes
    -----
    A look without a result, as of a shaft that no longer rests on anything, is left out; the other side is then
    reflected. Where all fail the unknown is named in `refused`.
    """
    terms, beside, refused = list[Term](), list[Term](), list[str]()
    lost, looks = np.zeros(centre.shape, dtype=np.int64), 0
    for unknown in unknowns:
        changes, reasons = [], []
        for scene in unknown.looks:
            try:
                changes.append(look(scene, unknown.frozen_cage) - centre)
            except (AnalysisError, InputError) as error:
                reasons.append(str(error).splitlines()[0])
        looks += len(changes)
        if reasons and not changes:
            refused.append(f"{unknown.name}: {reasons[0]}")
        if not changes:
            continue
        lost += np.sum([np.isnan(change) for change in changes], axis=0)
        both = unknown.reflected or len(unknown.looks) == 2
        term = _term(unknown, _both_ways(changes) if both else changes)
        (beside if unknown.beside else terms).append(term)
    lost = np.where(np.isnan(centre), 0, lost)
    return Band(centre, numerics, tuple(terms), lost, looks, tuple(refused), beside=tuple(beside))


def _both_ways(sides: list[FloatArray]) -> list[FloatArray]:
    """Changes of both looks; where one has no value, or was not made, that of the other reflected."""
    low, high = sides[0], sides[-1] if len(sides) > 1 else -sides[0]
    return [np.where(np.isnan(low), -high, low), np.where(np.isnan(high), -low, high)]


def _term(unknown: Unknown, changes: Sequence[FloatArray]) -> Term:
    """The term of some changes: the largest of each side."""
    known = np.nan_to_num(np.array(changes))
    rise, fall = np.maximum(known.max(axis=0), 0.0), np.maximum(-known.min(axis=0), 0.0)
    return Term(unknown.name, unknown.group, rise, fall, unknown.is_member)


def _mean_square(parts: FloatArray) -> float:
    """Mean square of what is finite; 0 of nothing."""
    finite = np.atleast_1d(parts)[np.isfinite(np.atleast_1d(parts))]
    return float(np.mean(finite**2)) if finite.size else 0.0
