"""The command line `ehdmaps`: arguments, exit status, messages. The work is in `ehdmaps.jobs.commands`."""

from __future__ import annotations

import argparse
import importlib
import sys
from collections.abc import Sequence

from ehdmaps.choices import MAP_CHOICES, PHYSICS, SHEAR, add_choices
from ehdmaps.errors import InputError
from ehdmaps.program import Program, count, run

_KEEP = "openfoam: keep the case folders of all runs; default folder: ehdmaps-cases"
_SOLVER = (
    "hertz | formula | reynolds | openfoam; instead of the job's, with the physics and shear of the "
    "job where it has them, and default settings"
)

_TARGET = "csv"

_MAKE, _LOOK, _GIVE, _MEASURE = "make a map", "look", "hand over", "laboratory"

_OF_BEARING = ("bearing", "oil")
_OF_MAPS = (*(choice.key for choice in MAP_CHOICES), *_OF_BEARING)

_MEASURING = ("stability", "tradeoff")
"""Commands whose work is in `mbs.laboratory`: no room of ehdmaps imports it."""

_RENAMED = {
    "--tolerance": "--law-tolerance of generate",
    "--frequencies": "--frequency FROM TO POINTS",
    "--eyring-stress": "--shear-stress",
    "--structure": "--structural-law",
}


def parser() -> argparse.ArgumentParser:
    """Return the parser of all commands."""
    top = Program(
        prog="ehdmaps",
        description="Elastohydrodynamic contact maps for roller bearings.",
        epilog="JOB is a job file, a map (its job is repeated), or the name of a shipped job: nu308, n1014, "
        "nu308_cfd, nu308_openfoam, nu308_night; for generate, check and status also a batch file, of many maps. "
        "Exit status: 0 done; 1 done, with failed points or laws beyond their error limits; 2 bad input, nothing "
        "written; 130 stopped with Ctrl-C, 143 by SIGTERM.",
        renamed=_RENAMED,
    )
    add_choices(top.shared, MAP_CHOICES, "job", several=False)
    instead = top.shared.add_argument_group("instead of a file")
    instead.add_argument("--bearing", metavar="NAME", help="a bearing by its designation, such as NU210")
    instead.add_argument("--oil", metavar="NAME", help='its oil, such as "ISO VG 46, VI 120"; default: FVA3')

    generate = top.add_command(
        _MAKE, "generate", "make a map; after an interruption the same command continues", _OF_BEARING
    )
    generate.add_argument("jobs", metavar="JOB", nargs="*", help="of several, one map after the other")
    generate.add_argument(
        "-o",
        "--output",
        metavar="MAP.nc",
        help="of one job; default: the job's name with .nc, in this folder; of a batch a folder, default: its name",
    )
    generate.add_argument("--solver", metavar="NAME", help=_SOLVER)
    generate.add_argument("--workers", metavar="N", type=count, help="processes; default: all cores")
    generate.add_argument(
        "--executor",
        metavar="ENGINE",
        help="what solves the points in place of processes on this machine: dask:ADDRESS, executorlib:local, "
        "executorlib:slurm or mpi; the map and what is solved stay here",
    )
    generate.add_argument("--fresh", action="store_true", help="do not use what is solved already")
    generate.add_argument(
        "--fresh-films",
        action="store_true",
        help='reynolds: have all films solved, none read from the film table; as films = "solved" of [solver]',
    )
    generate.add_argument(
        "--law-tolerance",
        metavar="SHARE",
        help='of k, c and film offset of the contact laws, "1 %%": fresh solves confirm it at 99 %% of random points '
        "(95 %% in the damping valley); solved lines are refined until then; default: the usual error limits",
    )
    generate.add_argument("--keep-cases", metavar="FOLDER", nargs="?", const="ehdmaps-cases", help=_KEEP)

    status = top.add_command(_MAKE, "status", "progress of a map that is being made, or was interrupted")
    status.add_argument(
        "map",
        metavar="MAP.nc",
        nargs="?",
        help="or its store, its JOB, or a batch file; default: all maps in this folder",
    )
    status.add_argument(
        "-o", "--output", metavar="MAP.nc", help="of the job, or the folder of the batch, as for generate"
    )

    check = top.add_command(_MAKE, "check", "list every problem of a job; estimate points, time, memory", _OF_BEARING)
    _add_job(check)
    check.add_argument("--solver", metavar="NAME", help=_SOLVER)

    show = top.add_command(_LOOK, "show", "what a map contains", _OF_MAPS)
    _add_job(show, "map")

    plot = top.add_command(
        _LOOK,
        "plot",
        "stiffness, damping and films on one page; of rough surfaces Lambda and the share of the films instead",
        _OF_MAPS,
    )
    _add_job(plot, "map")
    plot.add_argument("-o", "--output", metavar="FIG.png", help="default: the map's name with .png; also .pdf, .svg")

    report = top.add_command(_LOOK, "report", "a map as one page to send: no network needed, prints to PDF", _OF_MAPS)
    _add_job(report, "map")
    report.add_argument("-o", "--output", metavar="REPORT.html", help="default: the map's name with .html")

    solve = top.add_command(_MAKE, "solve", "one operating point, as a table", ["supply", *_OF_BEARING])
    _add_job(solve)
    solve.add_argument("--load", required=True, help='such as "62 N" (with --length) or "88 N/mm"; of a ball: "100 N"')
    solve.add_argument("--length", help='that carries the load, such as "0.7 mm"')
    solve.add_argument(
        "--speed", required=True, help='entrainment speed, such as "1.7 m/s", or of the inner ring, "500 rpm"'
    )
    solve.add_argument("--temperature", required=True, help='of the raceways, such as "40 degC"')
    solve.add_argument(
        "--frequency",
        nargs="+",
        metavar="VALUE",
        help='of small oscillations, such as "1 kHz"; default: the low-frequency limit. FROM TO POINTS: the response '
        "over frequency, spaced logarithmically, such as 10Hz 20kHz 60; with --plot as a picture",
    )
    add_choices(solve, (PHYSICS, SHEAR), "job", several=False)
    solve.add_argument(
        "--shear-stress",
        metavar="STRESS",
        help='of --shear, such as "6 MPa"; default: of that law. Beside --slide-to-roll FROM TO POINTS: that of '
        "Eyring's law",
    )
    solve.add_argument(
        "--slide-to-roll",
        nargs="+",
        metavar="RATIO",
        help="one value: the film is solved with this sliding, (u2 - u1)/u from -2 to 2; FROM TO POINTS: reynolds, "
        "traction on the film of pure rolling over the ratio, spaced logarithmically: 0.001 1 7",
    )
    solve.add_argument(
        "--limiting-ratio",
        metavar="RATIO",
        help="limiting stress over pressure, of --shear limiting or --slide-to-roll FROM TO POINTS; default: 0.05",
    )
    solve.add_argument(
        "--solver",
        metavar="NAME",
        help=_SOLVER + "; or roller, roller:PROFILE: rollers of finite length under --load",
    )
    solve.add_argument(
        "--films", metavar="FILMS", help="of balls: solved | table; table: read from the film table; default: solved"
    )
    solve.add_argument("--json", action="store_true", help="one object a contact, SI, per unit length")
    solve.add_argument("--keep-cases", metavar="FOLDER", nargs="?", const="ehdmaps-cases", help=_KEEP)
    solve.add_argument(
        "--fields", metavar="FILE", help="openfoam: fields of the film as .vtu or .xdmf, a file a contact"
    )
    solve.add_argument(
        "--plot",
        metavar="FIG.png",
        help="with --frequency FROM TO POINTS: complex stiffness; of balls: film and pressure in plan view; else "
        "openfoam: pressure, film and velocity; also .pdf, .svg",
    )

    length = top.add_command(
        _LOOK, "length", "load and pressure over the length of a roller, and finite elements", _OF_BEARING
    )
    _add_job(length, help="with [bearing]; finite elements are shipped for NU308 and N1014")
    length.add_argument("--plot", metavar="FIG.png", help="all cases on one page; also .pdf, .svg")
    length.add_argument("--reference", metavar="FILE.json", help="finite elements of another bearing, made by --solve")
    length.add_argument(
        "--solve", metavar="FILE.json", help="solve the finite elements anew and write them; needs CalculiX (ccx)"
    )

    _add_export(top)
    openfoam = top.add_command(_MEASURE, "openfoam", "build ehlFoam, which the solver openfoam runs; see --install")
    way = openfoam.add_mutually_exclusive_group()
    way.add_argument(
        "--install", action="store_true", help="Debian 12: install OpenFOAM and a compiler first, by apt-get"
    )
    way.add_argument(
        "--check",
        action="store_true",
        help="check whether the executable is up to date, and solve a point with it; build nothing",
    )

    _add_solids(top)
    _add_compare(top)
    _add_tradeoff(top)
    _add_stability(top)
    _add_table(top)
    return top


def _add_job(command: argparse.ArgumentParser, name: str = "job", help: str | None = None) -> None:
    """Add a job or map, in the place of which a bearing may stand: see `_OF_BEARING`."""
    command.add_argument(name, metavar="JOB" if name == "job" else "MAP.nc", nargs="?", help=help)


def _place_bearing(arguments: argparse.Namespace) -> None:
    """Put the bearing that is given in the place of the job or map, one of which a command needs."""
    if "bearing" not in arguments:
        return
    from ehdmaps.jobs.defaults import bearing_source

    name = next(name for name in ("jobs", "job", "map") if name in arguments)
    given = getattr(arguments, name)
    needed = not getattr(arguments, "list", False)
    source = bearing_source(arguments.bearing, arguments.oil, given or None, needed)
    if source is not None:
        setattr(arguments, name, [source] if name == "jobs" else source)


def _add_export(top: Program) -> None:
    """Add the arguments of `ehdmaps export`: those of all targets, and, once the target is known, its own."""
    export = top.add_command(
        _GIVE,
        "export",
        "a map in the format of another program",
        _OF_MAPS,
        epilog="`ehdmaps export --list` names the targets, `ehdmaps export --to TARGET --help` their options.",
    )
    _add_job(export, "map")
    export.add_argument("--list", action="store_true", help="list the targets")
    export.add_argument("--to", metavar="TARGET", default=_TARGET, help="default: csv, curves over load as a table")
    export.add_argument("-o", "--output", metavar="PATH", help="default: the map's name with the target's ending")

    def add_arguments_of_target(argv: Sequence[str]) -> None:
        from ehdmaps.exports.target import find

        chosen = argparse.ArgumentParser(add_help=False, allow_abbrev=False)
        chosen.add_argument("--to", nargs="?", default=_TARGET)
        name = chosen.parse_known_args(argv)[0].to
        if name and "--list" not in argv:
            try:
                find(name).add_arguments(export)
            except InputError as error:
                export.error(error.problems[0])

    export.complete = add_arguments_of_target


def _add_solids(top: Program) -> None:
    """Add the arguments of `ehdmaps solids`."""
    solids = top.add_command(
        _MEASURE, "solids", "the structural law of a bearing by finite elements, once per bearing", _OF_BEARING
    )
    _add_job(solids)
    solids.add_argument("-o", "--output", metavar="FILE.json", help="all that was found; default: none")
    solids.add_argument("--mesh-convergence", action="store_true", help="three meshes, and other seats of the rings")
    solids.add_argument("--contact", action="store_true", help="CalculiX solves the contact too; some minutes")
    solids.add_argument(
        "--compare",
        action="store_true",
        help="k by all structural laws; solves only where the law fe is unknown",
    )
    solids.add_argument("--plot", metavar="FIG.png", help="meshes, and the laws over load; also .pdf, .svg")
    solids.add_argument("--json", action="store_true", help="the numbers as one object, SI")


def _add_compare(top: Program) -> None:
    """Add the arguments of `ehdmaps compare`."""
    compare = top.add_command(_LOOK, "compare", "differences between two maps")
    compare.add_argument("first", metavar="A.nc")
    compare.add_argument("second", metavar="B.nc")
    compare.add_argument("--json", action="store_true", help="the differences as one object")


def _add_tradeoff(top: Program) -> None:
    """Add the arguments of `ehdmaps tradeoff`."""
    tradeoff = top.add_command(
        _MEASURE, "tradeoff", "measured speed and accuracy of solvers, settings and physics", _OF_BEARING
    )
    _add_job(tradeoff)
    tradeoff.add_argument("--points", metavar="N", type=count, default=60, help="random points; default: 60")
    tradeoff.add_argument("--seed", metavar="S", type=_count, default=1, help="seed of the points; default: 1")
    tradeoff.add_argument(
        "--openfoam",
        metavar="N",
        type=_count,
        default=3,
        help="how many of the points openfoam solves, some ten to hundred seconds each; 0: none; default: 3",
    )
    tradeoff.add_argument("-o", "--output", metavar="OUT.nc", help="the numbers as netCDF; default: none")
    tradeoff.add_argument("--all", action="store_true", help="all tables, and the worst place of each choice")
    tradeoff.add_argument("--json", action="store_true", help="the numbers as one object")
    tradeoff.add_argument("--plot", metavar="FIG.png", help="the error budget, and error over cost; also .pdf, .svg")


def _add_stability(top: Program) -> None:
    """Add the command `stability`."""
    stability = top.add_command(
        _MEASURE, "stability", "search the extremes of what contacts and readers may be given; takes an hour as it is"
    )
    stability.add_argument("job", metavar="JOB", nargs="?", default="nu308", help="whose contacts are tried; nu308")
    stability.add_argument("--points", metavar="N", type=_count, default=100_000, help="by each quick solver; 100000")
    stability.add_argument("--openfoam", metavar="N", type=_count, default=200, help="points by openfoam; 200")
    stability.add_argument("--mutations", metavar="N", type=_count, default=10_000, help="for each reader; 10000")
    stability.add_argument("--seed", metavar="S", type=_count, default=1, help="of all chance; default: 1")
    stability.add_argument("--only", metavar="NAME", help="contact, or a reader such as map; default: all")
    stability.add_argument("--json", action="store_true", help="the checks as JSON")
    stability.add_argument("-o", "--output", metavar="FILE", help="the same into a file, .txt or .json")


def _add_table(top: Program) -> None:
    """Add the command `table`."""
    table = top.add_command(_MEASURE, "table", "the film table, from which films are read without solving")
    parts = table.add_subparsers(dest="part", required=True, metavar="PART")
    make = parts.add_parser("make", help="solve it anew; minutes of one core")
    make.add_argument("-o", "--output", metavar="FILE.nc", help="default: film_table.nc, or point_table.nc")
    make.add_argument("--points", action="store_true", help="the table of point contacts, not that of lines")
    show = parts.add_parser("show", help="nodes, provenance and errors")
    show.add_argument("file", metavar="FILE.nc", nargs="?", help="default: the tables that are shipped")


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


def _command(arguments: argparse.Namespace) -> tuple[str, int]:
    """Load the command that is asked for, and do it."""
    if arguments.command == "solve":
        from ehdmaps.physics.point.ball_catalogue import plain_ball_designation

        if any(plain_ball_designation(text or "") for text in (arguments.job, arguments.bearing)):
            from ehdmaps.jobs.solve.ball_points import run as solve_balls

            return solve_balls(arguments)
    if arguments.command in ("generate", "show", "plot", "export"):
        from ehdmaps.jobs.make.points.asked import points_source

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


def _count(text: str) -> int:
    """Read a whole number >= 0."""
    if not (text.isascii() and text.isdigit() and len(text) <= 9):
        raise argparse.ArgumentTypeError(f"got {text[:40]!r}; allowed: a whole number from 0 to 999999999")
    return int(text)


if __name__ == "__main__":
    sys.exit(main())
