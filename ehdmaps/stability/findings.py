"""What a search over wild input found, as frozen values."""

from __future__ import annotations

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
