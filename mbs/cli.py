"""The command line `mbs`: arguments, exit status, messages. The work is in `mbs.commands`."""

from __future__ import annotations

import argparse
import importlib
import os
import sys
from collections.abc import Sequence

from ehdmaps.errors import EhdmapsError, InputError

DONE, NOT_MET, BAD_INPUT = 0, 1, 2
"""0: done; 1: done outside the map, or no result from valid input; 2: bad input, nothing written."""

_LAW = "hertz | formula | constant:NAME | map; default: map with --map, else hertz. NAME is a table [laws.NAME]"


def parser() -> argparse.ArgumentParser:
    """Return the parser of all commands."""
    top = argparse.ArgumentParser(
        prog="mbs",
        description="Statics, modes, linear analysis and run-ups of systems with cylindrical roller bearings.",
        epilog="SCENE is a scene file or the name of a shipped system: n1014_rigid, nu308_rigid. Exit status: 0 done; "
        "1 done outside the map, or no equilibrium found; 2 bad input, nothing written.",
    )
    commands = top.add_subparsers(dest="command", required=True, metavar="COMMAND")
    for name, words in (
        ("statics", "equilibrium, loads of the rollers, stiffness and damping of the bearings"),
        ("modes", "frequencies, damping ratios and where the strain energy is; over speed with --speeds"),
        ("lsa", "linear system analysis: state space and frequency responses"),
        ("runup", "integrate the nonlinear system in time over its speed profile"),
    ):
        command = commands.add_parser(name, help=words, description=words)
        command.add_argument("scene", metavar="SCENE")
        command.add_argument("--map", metavar="MAP.nc", help="made by `ehdmaps generate` for the same bearing")
        command.add_argument("--law", metavar="LAW", help=_LAW)
        command.add_argument(
            "--clearance",
            metavar="LENGTH",
            action="append",
            help='diametral clearance of all bearings, such as "20 um", in place of the scene\'s'
            + ("; with --speeds more than once, to compare" if name == "modes" else ""),
        )
        command.add_argument("-o", "--output", metavar="OUT.nc", help="result as netCDF")
        command.add_argument("--plot", metavar="FIG.png", help="figure; also .pdf, .svg")
        if name == "modes":
            command.add_argument(
                "--speeds", nargs=3, metavar=("FROM", "TO", "POINTS"), help='such as "200 rpm" "2000 rpm" 10'
            )
    return top


def main(argv: Sequence[str] | None = None) -> int:
    """Run a command.

    Parameters
    ----------
    argv : sequence of str, optional
        Arguments; those of the process if left out.

    Returns
    -------
    int
        Exit status.
    """
    arguments = parser().parse_args(argv)
    # Before numpy loads: the matrices are small, and threads only get in each other's way.
    for name in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"):
        os.environ.setdefault(name, "1")
    try:
        text, status = importlib.import_module(f"mbs.commands.{arguments.command}").run(arguments)
    except EhdmapsError as error:
        from mbs.errors import AnalysisError

        problems = error.problems if isinstance(error, InputError) else tuple(str(error).splitlines())
        head = f"mbs {arguments.command}: {len(problems)} problem{'s' if len(problems) > 1 else ''}"
        sys.stderr.write("\n".join([head, *(f"  {problem}" for problem in problems)]) + "\n")
        return NOT_MET if isinstance(error, AnalysisError) else BAD_INPUT
    except KeyboardInterrupt:
        sys.stderr.write("\nstopped\n")
        return 130
    try:
        print(text)
        sys.stdout.flush()
    except BrokenPipeError:
        # The interpreter flushes again at its end: give it somewhere to write.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    return int(status)


if __name__ == "__main__":
    sys.exit(main())
