"""Findings of a search over wild input, and how they are told."""

from __future__ import annotations

import dataclasses
import json
import os
import textwrap
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from ehdmaps.outputs import MARK, Kind, has_mark, write_text
from ehdmaps.units import closest


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


CHECKS = Kind("a table of checks of ehdmaps or mbs", (".txt", ".json"), has_mark)

MOST_REASONS = 6
"""Reasons of refusals that are printed of a check; JSON has all."""

_WIDTH = 120


def checks_text(checks: Sequence[Check]) -> str:
    """Return the checks as a table: counts first, then how a value is judged, the worst case, and what failed.

    Parameters
    ----------
    checks : sequence of Check
        What was found, in the order in which it is shown.
    """
    width = max([len("total"), *(len(check.name) for check in checks)]) + 2
    columns = ("tried", "right", "refused", "failed", "CPU s")
    lines = ["".ljust(width) + "".join(f"{name:>10}" for name in columns)]
    for check in checks:
        counts = (check.tried, check.right, check.refused, check.failed)
        lines.append(check.name.ljust(width) + "".join(f"{count:>10}" for count in counts) + f"{check.seconds:>10.3g}")
    sums = [sum(getattr(check, name) for check in checks) for name in columns[:4]]
    seconds = sum(check.seconds for check in checks)
    lines.append("total".ljust(width) + "".join(f"{count:>10}" for count in sums) + f"{seconds:>10.3g}")
    for check in checks:
        lines += ["", check.name]
        lines += _paragraph("right: ", check.rule)
        if check.worst:
            lines += _paragraph("worst: ", check.worst)
        lines += _paragraph("refused: ", _reasons(check)) if check.reasons else []
        for failure in check.failures:
            lines += _paragraph("FAILED: ", f"{failure.what}; case: {failure.case}")
        if check.failed > len(check.failures):
            lines += _paragraph("FAILED: ", f"{check.failed - len(check.failures)} more")
    return "\n".join(lines)


def checks_json(checks: Sequence[Check]) -> str:
    """Return the checks as JSON: under "checks" a list of objects with the attributes of `Check`.

    Parameters
    ----------
    checks : sequence of Check
        What was found.
    """
    entries = [dataclasses.asdict(check) | {"reasons": dict(check.reasons)} for check in checks]
    return json.dumps({"mark": MARK, "checks": entries}, indent=1)


def write_checks(path: Path, head: str, checks: Sequence[Check]) -> None:
    """Write checks, by the rule of all files that are written.

    Parameters
    ----------
    path : Path
        .txt for the table, .json for JSON.
    head : str
        What was searched; first line of the table.
    checks : sequence of Check
        What was found.

    Raises
    ------
    InputError
        If it cannot be written.
    """
    text = checks_json(checks) if path.suffix == ".json" else f"{head} ({MARK})\n{checks_text(checks)}"
    write_text(path, f"{text}\n", CHECKS)


def unknown_part(only: str | None, names: tuple[str, ...]) -> list[str]:
    """Problems with the part that `--only` names; nothing where it is left out.

    Parameters
    ----------
    only : str or None
        What was given.
    names : tuple of str
        Names of all parts.
    """
    if only is None or only in names:
        return []
    return [f"--only: got {only!r:.60}{closest(only, names)}; allowed: {', '.join(names)}"]


def told(head: str, checks: Sequence[Check], output: str | None, as_json: bool) -> tuple[str, int]:
    """Write checks where a file is asked for, and return what a command prints of them with its status.

    Parameters
    ----------
    head : str
        What was searched.
    checks : sequence of Check
        What was found.
    output : str or None
        File of `-o`.
    as_json : bool
        Whether JSON is printed.

    Returns
    -------
    (str, int)
        Text, and 1 where something failed.

    Raises
    ------
    InputError
        If the file cannot be written.
    """
    if output is not None:
        write_checks(Path(output), head, checks)
    text = checks_json(checks) if as_json else f"{head}\n{checks_text(checks)}"
    return text, 1 if any(check.failed for check in checks) else 0


def _reasons(check: Check) -> str:
    """Reasons for which cases were refused, the most frequent first."""
    ordered = sorted(check.reasons.items(), key=lambda entry: -entry[1])
    shown = [f"{count} {reason}" for reason, count in ordered[:MOST_REASONS]]
    left = sum(count for _, count in ordered[MOST_REASONS:])
    return "; ".join(shown + ([f"{left} for {len(ordered) - MOST_REASONS} other reasons"] if left else []))


def _paragraph(begin: str, text: str) -> list[str]:
    """Lines of a text below its check."""
    flat = " ".join(text.split())
    return textwrap.wrap(flat, _WIDTH, initial_indent=f"    {begin}", subsequent_indent=" " * 8)
