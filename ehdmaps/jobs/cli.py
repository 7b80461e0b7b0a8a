"""The command line `ehdmaps`: what it takes is in `commands.toml`, the work in `ehdmaps.jobs.commands`."""

from __future__ import annotations

import argparse
import importlib
import sys
from collections.abc import Sequence
from functools import partial

from ehdmaps.choices import MAP_CHOICES, PHYSICS, SHEAR, add_choices
from ehdmaps.command_table import program
from ehdmaps.errors import InputError
from ehdmaps.program import Parser, Program, run

_MEASURING = ("stability", "tradeoff")
"""Commands whose work is in `mbs.laboratory`: no room of ehdmaps imports it."""


def parser() -> Program:
    """Return the parser of all commands."""
    top, commands = program("ehdmaps.jobs", MAP_CHOICES, "job", several=False)
    add_choices(commands["solve"], (PHYSICS, SHEAR), "job", several=False)
    commands["export"].complete = partial(_add_arguments_of_target, commands["export"])
    return top


def _place_bearing(arguments: argparse.Namespace) -> None:
    """Put the bearing that is given in the place of the job or map, one of which a command needs."""
    if "bearing" not in arguments:
        return
    from ehdmaps.jobs.defaults import bearing_source

    name = next(name for name in ("jobs", "job", "map") if name in arguments)
    given = getattr(arguments, name)
    needed = not (getattr(arguments, "list", False) or getattr(arguments, "catalogue", False))
    source = bearing_source(arguments.bearing, arguments.oil, given or None, needed)
    if source is not None:
        setattr(arguments, name, [source] if name == "jobs" else source)


def _add_arguments_of_target(export: Parser, argv: Sequence[str]) -> None:
    """Add the arguments of the target of `ehdmaps export`, once it is known."""
    from ehdmaps.exports.target import find

    chosen = argparse.ArgumentParser(add_help=False, allow_abbrev=False)
    chosen.add_argument("--to", nargs="?", default=export.get_default("to"))
    name = chosen.parse_known_args(argv)[0].to
    if name and "--list" not in argv:
        try:
            find(name).add_arguments(export)
        except InputError as error:
            export.error(error.problems[0])


def main(argv: Sequence[str] | None = None) -> int:
    """Run a command.

    Parameters
    ----------
    argv : sequence of str, optional
        Arguments of the command line; those of the process if left out.

    Returns
    -------
    int
        Exit status.
    """
    return run(parser(), _command, argv)


def _has_balls(text: str) -> bool:
    """Tell whether keys in braces, or a file, are those of a ball bearing."""
    if not (text.lstrip().startswith("{") or text.lower().endswith(".toml")):
        return False
    from ehdmaps.jobs.balls import balls_of

    try:
        return balls_of(text) is not None
    except InputError:
        return True  # its reader says what is wrong


def _command(arguments: argparse.Namespace) -> tuple[str, int]:
    """Load the command that is asked for, and do it."""
    if arguments.command == "solve":
        from ehdmaps.physics.designations.reader import BALLS, plain_name

        asked = [text for text in (arguments.job, arguments.bearing) if text]
        if any(plain_name(text, BALLS) or _has_balls(text) for text in asked):
            from ehdmaps.jobs.solve.ball_points import run as solve_balls

            return solve_balls(arguments)
    if arguments.command in ("generate", "show", "plot", "export"):
        from ehdmaps.jobs.make.points_asked import points_source

        if source := points_source(arguments):
            from ehdmaps.jobs.commands.points import run as run_points

            return run_points(arguments, source)
    _place_bearing(arguments)
    if arguments.command == "solve" and (arguments.solver or "").startswith("roller"):
        from ehdmaps.jobs.solve.roller_ends import is_roller
        from ehdmaps.jobs.solve.roller_ends import run as solve_rollers

        if is_roller(arguments.solver):
            return solve_rollers(arguments)
    result: tuple[str, int]
    if arguments.command in _MEASURING:
        result = importlib.import_module(f"mbs.laboratory.commands.{arguments.command}").run_contacts(arguments)
    else:
        result = importlib.import_module(f"ehdmaps.jobs.commands.{arguments.command}").run(arguments)
    return result


if __name__ == "__main__":
    sys.exit(main())
