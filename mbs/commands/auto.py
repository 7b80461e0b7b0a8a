"""The analysis of a command, with lines on the physics that matters; `--auto` chooses that of the films."""

from __future__ import annotations

import argparse
import math
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, TypeVar

from ehdmaps.choices import texts_of
from ehdmaps.errors import AnalysisError, InputError, Problems
from mbs.commands.common import Done, Looked
from mbs.model.relaxation import DEFAULT_FILMS
from mbs.scene.choices import CHOICES
from mbs.scene.map_set import TABLE_LAW

if TYPE_CHECKING:
    from mbs.planning.physics import AutoSettings, Verdict

A = TypeVar("A")
R = TypeVar("R")

_ONE = ("clearance", "temperature", "roughness", "films", "supply", "physics", "law")
"""Choices that `--auto` takes once."""


def analysed(
    arguments: argparse.Namespace,
    ask: Callable[[argparse.Namespace], A],
    analyse: Callable[[A], R],
    looks_at: Callable[[A], Looked],
) -> Done[R]:
    """The analysis of a command, with films that `--auto` chooses, and lines on physics that matters.

    Parameters
    ----------
    arguments : argparse.Namespace
        Arguments of the command.
    ask : callable
        Reads them into what the analysis takes.
    analyse : callable
        The analysis.
    looks_at : callable
        What it looks at.

    Raises
    ------
    InputError
        With every problem of the arguments.
    """
    auto = bool(getattr(arguments, "auto", False))
    problems = Problems(_problems(arguments, auto))
    tolerance = read_tolerance(arguments, problems) if auto else None
    with problems:
        asked = ask(arguments)
    problems.check()
    if not auto:
        found = judged(arguments, looks_at(asked)) if hasattr(arguments, "auto") else ()
        return Done(
            analyse(asked), tuple(f"note: {one.line}" for one in found if one.matters and (one.fails or not one.on))
        )
    from mbs.planning.physics import switched, verdicts

    looked = looks_at(asked)
    found = verdicts(looked.scene, _settings(arguments, looked.highest, tolerance))
    chosen = {name: value for name, value in switched(found).items() if value != _in_force(arguments)[name]}
    if chosen:
        asked = ask(argparse.Namespace(**{**vars(arguments), **{name: [value] for name, value in chosen.items()}}))
    return Done(analyse(asked), tuple(f"auto: {one.line}" for one in found))


def judged(arguments: argparse.Namespace, looked: Looked) -> tuple[Verdict, ...]:
    """Verdicts on films of the film table with the physics that was asked for; none of other laws.

    Parameters
    ----------
    arguments : argparse.Namespace
        Arguments of a command.
    looked : Looked
        What it looks at.
    """
    if getattr(arguments, "map", None) or texts_of(arguments, CHOICES["law"]) not in ([], [TABLE_LAW]):
        return ()
    if looked.scene.lubricant is None or not looked.scene.has_bearings:
        return ()
    from mbs.planning.physics import verdicts  # not for laws without films

    try:
        return verdicts(looked.scene, _settings(arguments, looked.highest, None, _in_force(arguments)["physics"]))
    except (AnalysisError, InputError):  # the analysis itself tells what is wrong
        return ()


def _in_force(arguments: argparse.Namespace) -> dict[str, str]:
    """Films and physics that a command has, chosen or by default."""
    usual = {"films": DEFAULT_FILMS, "physics": "inlet-heat"}
    return {name: next(iter(texts_of(arguments, CHOICES[name])), value) for name, value in usual.items()}


def _settings(
    arguments: argparse.Namespace, highest: float, tolerance: float | None, physics: str | None = None
) -> AutoSettings:
    """Settings by which physics is judged; what is given by an option is not chosen."""
    from mbs.planning.physics import TOLERANCE, AutoSettings

    def first(name: str) -> Any:
        choice = CHOICES[name]
        return next(iter(choice.values(texts_of(arguments, choice), Problems())), None)

    stated = {name: first(name) for name in ("clearance", "films", "supply", "physics")}
    stated["physics"] = physics or stated["physics"]
    return AutoSettings(tolerance=tolerance or TOLERANCE, highest=highest, **stated)


def _problems(arguments: argparse.Namespace, auto: bool) -> list[str]:
    """List problems with options that do not go together."""
    if not auto:
        given = getattr(arguments, "auto_tolerance", None) is not None
        return ["--auto-tolerance: stands without --auto; allowed: with it"] if given else []
    problems = ["--map: stands beside --auto, which chooses of the film table; leave one of them out"]
    problems = problems if getattr(arguments, "map", None) else []
    laws = [law for law in texts_of(arguments, CHOICES["law"]) if law != TABLE_LAW]
    problems += [f"--law: got {law!r:.60} beside --auto; allowed: {TABLE_LAW}, which is the default" for law in laws]
    return problems + [
        f"--{name}: got {len(texts)} of them; allowed with --auto: one"
        for name in _ONE
        if len(texts := texts_of(arguments, CHOICES[name])) > 1
    ]


def read_tolerance(arguments: argparse.Namespace, problems: Problems) -> float | None:
    """Read --auto-tolerance: a part of a stiffness or damping, such as "5 %", or of a level, such as "1 dB".

    A run-up that has a --tolerance of its levels alone has that.

    A level at a resonance goes with 1/c, one held by stiffness with 1/k, so that a decibel is a change of k or c by
    12 %.

    Parameters
    ----------
    arguments : argparse.Namespace
        Arguments of a command.
    problems : Problems
        Appended to.
    """
    from mbs.planning.physics import MOST_TOLERANCE

    own, of_levels = (getattr(arguments, key, None) for key in ("auto_tolerance", "tolerance"))
    option, text = ("--tolerance", of_levels) if own is None else ("--auto-tolerance", own)
    if text is None:
        return None
    number, _, unit = text.strip().partition(" ")
    try:
        value = float(number)
        part = {"%": value / 100.0, "dB": math.pow(10.0, value / 20.0) - 1.0}[unit.strip()]
    except (KeyError, ValueError, OverflowError):
        part = math.nan
    if not 0.0 < part <= MOST_TOLERANCE * (1.0 + 1e-9):
        problems.append(f"{option}: got {text!r:.40}; allowed: above 0 up to 900 % or 20 dB, such as '5 %' or '1 dB'")
        return None
    return min(part, MOST_TOLERANCE)
