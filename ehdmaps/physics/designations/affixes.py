"""Prefixes and suffixes of the plain designation of a bearing: seals, cages, accuracy, materials, clearance.

Meanings are rows of a file. Suffixes may stand behind each other without a blank; one that is in no row is read where a
blank, a hyphen, a stroke or a dot sets it apart, and told.
"""

from __future__ import annotations

import re
import tomllib
from functools import cache
from importlib import resources
from typing import NamedTuple

HYBRID, CLEARANCE, MOUNTING, REFUSED, UNKNOWN, SET, PAIR = (
    "hybrid", "clearance", "mounting", "refused", "unknown", "set", "pair",
)  # fmt: skip
"""Effects of a prefix or suffix beside having a meaning; empty where forces do not know it."""


class Affix(NamedTuple):
    """A prefix or suffix.

    Attributes
    ----------
    text : str
        The affix as it was typed, in capitals.
    meaning : str
        Meaning of the affix.
    effect : str
        Effect of the affix, see `HYBRID`.
    """

    text: str
    meaning: str
    effect: str

    @property
    def words(self) -> str:
        """Text and meaning."""
        return f"{self.text}: {self.meaning}"


class _Row(NamedTuple):
    """Row of the file."""

    pattern: re.Pattern[str]
    meaning: str
    effect: str


@cache
def _rows(place: str, kind: str) -> tuple[_Row, ...]:
    """Rows of prefixes ("before") or suffixes ("behind") of a kind, those of every kind behind its own."""
    text = (resources.files("ehdmaps.physics") / "shipped" / "designations.toml").read_text(encoding="utf-8")
    table = tomllib.loads(text)[place]
    rows = [*table.get(kind, ()), *table["every"]]
    return tuple(_Row(re.compile(row[0]), row[1], row[2] if len(row) > 2 else "") for row in rows)


def prefix(text: str, kind: str) -> Affix | None:
    """The prefix of a kind; None for what is none.

    Parameters
    ----------
    text : str
        Part before the designation, in capitals.
    kind : str
        Kind of the bearing.

    Examples
    --------
    >>> prefix("HCB", "angular contact ball bearing").effect
    'hybrid'
    """
    text = text.strip(" ")
    return next((Affix(text, row.meaning, row.effect) for row in _rows("before", kind) if _whole(row, text)), None)


def _whole(row: _Row, text: str) -> bool:
    """Tell whether a row has the text, with or without a hyphen."""
    return any(row.pattern.fullmatch(one) for one in (text, text.rstrip("-"), f"{text}-"))


@cache
def suffixes(text: str, kind: str) -> tuple[Affix, ...] | None:
    """The suffixes of a designation, one by one; None where one is not set apart and in no row.

    A class of clearance, or silicon nitride, counts with something behind it that is not understood, too.

    Parameters
    ----------
    text : str
        Part behind the designation, in capitals.
    kind : str
        Kind of the bearing.

    Examples
    --------
    >>> [one.text for one in suffixes("-2RSLTN9/HC5C3", "deep groove ball bearing")]
    ['2RSL', 'TN9', 'HC5', 'C3']
    >>> [one.text for one in suffixes("/C3XX1", "deep groove ball bearing")]
    ['C3', 'XX1']
    >>> suffixes(" 2RS GE9", "deep groove ball bearing")[1].effect, suffixes("X", "deep groove ball bearing")
    ('unknown', None)
    """
    body = text.lstrip(" .,/-")
    if not body:
        return ()
    counts: Affix | None = None
    for end in range(len(body), 0, -1):  # the longest first
        row = next((row for row in _rows("behind", kind) if row.pattern.fullmatch(body[:end])), None)
        if row is None:
            continue
        one = Affix(body[:end], row.meaning, row.effect)
        if (rest := suffixes(body[end:], kind)) is not None:
            return (one, *rest)
        counts = one if row.effect in (CLEARANCE, HYBRID) else counts
    alone = re.match("[A-Z0-9]+", body) if body != text else None
    if alone is None or (rest := suffixes(body[alone.end() :], kind)) is None:
        return None
    begun = () if counts is None or len(counts.text) > alone.end() else (counts,)
    unknown = alone[0][sum(len(one.text) for one in begun) :]
    return (*begun, *([Affix(unknown, "not understood, and left out", UNKNOWN)] if unknown else []), *rest)
