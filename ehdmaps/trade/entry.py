"""Ways to an answer as they will be measured: rows of contacts and of machines, each beside what it is held against."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Generic, TypeVar

from ehdmaps.trade.record import Choice, ErrorSummary

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
