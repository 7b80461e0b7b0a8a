"""The analysis of a command; where `--auto` asks for maps of its own, `mbs.commands.auto_maps` makes them."""

from __future__ import annotations

import argparse
from collections.abc import Callable
from typing import TypeVar

from ehdmaps.errors import InputError
from mbs.commands.common import Done, Looked
from mbs.scene.scene import Scene

A = TypeVar("A")
R = TypeVar("R")


def analysed(
    arguments: argparse.Namespace,
    ask: Callable[[argparse.Namespace], A],
    analyse: Callable[[A], R],
    looks_at: Callable[[A], Looked],
) -> Done[R]:
    """The analysis of a command, with a map of its own where `--auto` asks for one.

    Parameters
    ----------
    arguments : argparse.Namespace
        Arguments of the command.
    ask : callable
        Reads them into what the analysis takes; `arguments.subject` is the scene with its law, where there is one.
    analyse : callable
        The analysis.
    looks_at : callable
        What it looks at.

    Raises
    ------
    InputError
        With every problem of the arguments; before a map is made.
    """
    if not getattr(arguments, "auto", False):
        if problems := _only_with_auto(arguments):
            raise InputError(problems)
        asked = ask(arguments)
        return Done(analyse(asked), _left_out(arguments, looks_at(asked).scene))
    from mbs.commands.auto_maps import with_own_maps  # with all that makes maps

    return with_own_maps(arguments, ask, analyse, looks_at)


def _only_with_auto(arguments: argparse.Namespace) -> list[str]:
    """List problems with options that belong to `--auto`."""
    options = ("maps", "physics", "shear", "auto_tolerance")
    given = [option.replace("_", "-") for option in options if getattr(arguments, option, None) is not None]
    return [f"--{option}: stands without --auto; allowed: with it" for option in given]


def _left_out(arguments: argparse.Namespace, scene: Scene) -> tuple[str, ...]:
    """A line on what films of the film table leave out and `--auto` looks at; none for other laws."""
    others = ("map", "law", "structural_law")
    if not hasattr(arguments, "auto") or any(getattr(arguments, option, None) for option in others):
        return ()
    if scene.lubricant is None or not scene.bearings:
        return ()
    from mbs.planning.left_out import left_out_line  # not for laws without films

    line = left_out_line(scene)
    return (line,) if line else ()
