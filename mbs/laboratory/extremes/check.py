"""Findings of a search over wild input: cases that are judged one by one, counted, and told."""

from __future__ import annotations

import argparse
import dataclasses
import json
import os
import textwrap
from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import NamedTuple

from ehdmaps.errors import Problems
from ehdmaps.outputs import MARK, Kind, Output, has_mark, output_problems, write_text
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


class Verdict(NamedTuple):
    """End of one case: refused for a reason, wrong, or right.

    Attributes
    ----------
    case : str
        The input, complete enough to repeat it; of a right one with its number.
    share : float
        How much of its bound a right one takes, 0 to 1; the largest one is the worst.
    wrong : str
        What is wrong; empty where nothing is.
    refused : str
        Why it was refused, in words that are alike for alike cases; empty where it was not.
    """

    case: str = ""
    share: float = 0.0
    wrong: str = ""
    refused: str = ""


def checked(name: str, rule: str, verdicts: Iterable[Verdict], more: Callable[[], str] = str) -> Check:
    """Count the cases of a check while they are judged.

    Parameters
    ----------
    name, rule : str
        Those of the `Check`.
    verdicts : iterable of Verdict
        The cases, which are made one after the other.
    more : callable
        What is told behind the worst case, once all are judged.
    """
    began, right, nearest, worst = _processor_seconds(), 0, -1.0, ""
    failures: list[Failure] = []
    reasons: Counter[str] = Counter()
    for one in verdicts:
        if one.wrong:
            failures.append(Failure(one.case, one.wrong))
        elif one.refused:
            reasons[one.refused] += 1
        else:
            right += 1
            if one.case and one.share > nearest:
                nearest, worst = one.share, one.case
    return Check(
        name=name,
        tried=right + reasons.total() + len(failures),
        right=right,
        refused=reasons.total(),
        rule=rule,
        failures=tuple(failures[:MOST_FAILURES]),
        failed=len(failures),
        worst=worst + more(),
        reasons=dict(reasons.most_common()),
        seconds=_processor_seconds() - began,
    )


def _processor_seconds() -> float:
    """Processor time of this process and of its children that have ended [s]."""
    times = os.times()
    return times.user + times.system + times.children_user + times.children_system


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


def searched(
    arguments: argparse.Namespace, parts: Mapping[str, Callable[[], Iterable[Check]]], head: str, *read: str
) -> tuple[str, int]:
    """Search the parts that a command asks for, write what is found, and return what is printed of it.

    Parameters
    ----------
    arguments : argparse.Namespace
        Arguments of a command: output, json, and only where the command has several parts.
    parts : mapping of str to callable
        What makes the checks of each part, in their order.
    head : str
        What is searched; first line of the table.
    *read : str
        Files that the command reads, which are not written over.

    Returns
    -------
    (str, int)
        Text, and 1 where something failed.

    Raises
    ------
    InputError
        If there is no such part, or the file cannot be written.
    """
    only: str | None = getattr(arguments, "only", None)
    output = arguments.output
    problems = Problems(output_problems([Output("-o", output, CHECKS)], read))
    if only is not None and only not in parts:
        problems.append(f"--only: got {only!r:.60}{closest(only, tuple(parts))}; allowed: {', '.join(parts)}")
    problems.check()
    checks = [check for name, make in parts.items() if only in (None, name) for check in make()]
    table, record = checks_text(checks), checks_json(checks)
    if output is not None:
        text = record if Path(output).suffix == ".json" else f"{head} ({MARK})\n{table}"
        write_text(Path(output), f"{text}\n", CHECKS)
    return f"{head}\n{table}", int(any(check.failed for check in checks))


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
