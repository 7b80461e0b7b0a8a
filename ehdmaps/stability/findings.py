"""What a search over wild input found, as frozen values."""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, field


@dataclass(frozen=True)
class Failure:
    """A case that should not be.

    Attributes
    ----------
    case : str
        The input, complete enough to repeat it.
    what : str
        What went wrong with it.
    """

    case: str
    what: str


@dataclass(frozen=True)
class Check:
    """One kind of case, and how the cases of it ended.

    Attributes
    ----------
    name : str
        What was asked, such as "contact: reynolds, value or status".
    tried : int
        How many cases.
    right : int
        Cases with a value that was checked, by the rule of `rule`.
    refused : int
        Cases refused by a typed status or error with a reason.
    rule : str
        When a value counts as right, with the error that its bound allows.
    failures : tuple of Failure
        All the others: at most `MOST_FAILURES` of them are kept.
    failed : int
        How many there were.
    worst : str
        The case nearest to the bound, with its number.
    reasons : mapping of str to int
        Why cases were refused, with counts.
    seconds : float
        Processor time.
    """

    name: str
    tried: int
    right: int
    refused: int
    rule: str
    failures: tuple[Failure, ...] = ()
    failed: int = 0
    worst: str = ""
    reasons: Mapping[str, int] = field(default_factory=dict)
    seconds: float = 0.0


MOST_FAILURES = 20
"""Failures that are kept of a check."""


def processor_seconds() -> float:
    """Processor time of this process and of its children that have ended [s]."""
    times = os.times()
    return times.user + times.system + times.children_user + times.children_system


class Tally:
    """Counts the cases of a check while it is made.

    Parameters
    ----------
    name, rule : str
        Those of the `Check`.
    """

    def __init__(self, name: str, rule: str) -> None:
        self._name, self._rule = name, rule
        self._right = self._failed = 0
        self._reasons: Counter[str] = Counter()
        self._failures: list[Failure] = []
        self._nearest, self._worst = -1.0, ""
        self._began = processor_seconds()

    def right(self, case: str = "", share: float = 0.0) -> None:
        """Count a case that is as it should be.

        Parameters
        ----------
        case : str
            The case with its number.
        share : float
            How much of its bound it takes, 0 to 1; the largest one is the worst.
        """
        self._right += 1
        if case and share > self._nearest:
            self._nearest, self._worst = share, case

    def refused(self, reason: str) -> None:
        """Count a case that was refused, and why.

        Parameters
        ----------
        reason : str
            Why, in words that are alike for alike cases.
        """
        self._reasons[reason] += 1

    def failed(self, case: str, what: str) -> None:
        """Count a case that should not be.

        Parameters
        ----------
        case, what : str
            Those of the `Failure`.
        """
        self._failed += 1
        if len(self._failures) < MOST_FAILURES:
            self._failures.append(Failure(case, what))

    def check(self) -> Check:
        """Return what was counted."""
        refused = self._reasons.total()
        return Check(
            name=self._name,
            tried=self._right + refused + self._failed,
            right=self._right,
            refused=refused,
            rule=self._rule,
            failures=tuple(self._failures),
            failed=self._failed,
            worst=self._worst,
            reasons=dict(self._reasons.most_common()),
            seconds=processor_seconds() - self._began,
        )
