"""The command line `mbs`: what it takes is in `commands.toml`, the work in `mbs.commands`."""

from __future__ import annotations

import argparse
import importlib
import sys
from collections.abc import Sequence
from functools import cache

from ehdmaps.command_table import program
from ehdmaps.errors import AnalysisError
from ehdmaps.program import Program, run
from mbs.scene.choices import OPTIONS, VARIED

_ROOMS = {
    **dict.fromkeys(("stability", "tradeoff", "variants"), "mbs.laboratory.commands"),
    **dict.fromkeys(("check", "importing", "new", "reduce"), "mbs.commands.scenes"),
}
"""Packages of commands that measure the program, and of those on scenes and bodies; of the others `mbs.commands`."""


@cache
def parser() -> Program:
    """Return the parser of all commands."""
    top, commands = program("mbs", OPTIONS, "scene", several=True, varied=", ".join(VARIED))
    top.shared.set_defaults(auto=None)
    commands["report"].set_defaults(plot=None)
    # The command asks for the others by their own words.
    commands["run"].set_defaults(parse=top.parse_args)
    return top


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
    return run(parser(), _command, argv, no_result=AnalysisError)


def _command(arguments: argparse.Namespace) -> tuple[str, int]:
    """Load the command that is asked for, and do it."""
    # A module cannot be called import.
    name = {"import": "importing"}.get(arguments.command, arguments.command.replace("-", "_"))
    result: tuple[str, int] = importlib.import_module(f"{_ROOMS.get(name, 'mbs.commands')}.{name}").run(arguments)
    return result


if __name__ == "__main__":
    sys.exit(main())
