"""The command line `mbs`: arguments, exit status, messages. The work is in `mbs.commands`."""

from __future__ import annotations

import argparse
import importlib
import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from ehdmaps.choices import add_choices
from ehdmaps.errors import AnalysisError
from ehdmaps.program import Program, count, run
from mbs.scene.choices import OPTIONS, VARIED

_MEASURING = ("stability", "tradeoff", "variants")
"""Commands that measure the program and its choices."""

_LOOK, _LINEAR, _TIME, _MEASURED = "look", "linear", "in time", "measured"
_PREPARE, _LABORATORY = "maps and bodies", "laboratory"

_SCENES = ("check", "importing", "new")
"""Modules of commands on scene files themselves."""

_OWN_PHYSICS = ("auto", "auto_tolerance")

_UFF = "universal files need pip install 'ehdmaps[modal]'"
"""What is said where such files are read or written."""

_RENAMED = {
    "--speeds": "--speed FROM TO POINTS",
    "--structure": "--structural-law",
    "--tolerance": "--auto-tolerance, or --tolerance of runup and campbell,",
}


@dataclass(frozen=True)
class _OnScene:
    """A command on a scene: group in --help, what it does, options of its own, whether it compares several choices."""

    group: str
    words: str
    options: tuple[Callable[[argparse.ArgumentParser], None], ...] = ()
    compares: bool = False


def parser() -> argparse.ArgumentParser:
    """Return the parser of all commands."""
    top = Program(
        prog="mbs",
        description="Statics, modes, linear analysis, speed sweeps and run-ups of systems with roller and ball "
        "bearings, and modal identification.",
        epilog="SCENE is a scene file or the name of a shipped system: n1014_rigid, n1014_testrig, nu308_rigid, "
        "nu308_flexible, gearbox, two_stage, nu2210_shaft, overhung_rotor, electric_drive, spindle. Exit status: 0 "
        "done; 1 done outside the map, or no result from valid input; 2 bad input, nothing written; 130 stopped with "
        "Ctrl-C, 143 by SIGTERM.",
        renamed=_RENAMED,
    )
    add_choices(top.shared, OPTIONS, "scene", several=True)
    _auto(top.shared)
    for name, row in _ON_SCENES.items():
        command = _scene_command(top, name, row)
        for add in row.options:
            add(command)
    _bearing(top)
    _check(top)
    _import(top)
    _modal_fit(top)
    _new(top)
    _plan(top)
    _reduce(top)
    _run(top)
    _tradeoff(top)
    _stability(top)
    return top


def _stability(top: Program) -> None:
    """Add the command `stability`."""
    words = "law, bearing element, integrator and readers at the extremes; takes an hour as it is"
    command = top.add_command(_LABORATORY, "stability", words)
    command.add_argument("--runs", metavar="N", type=_count, default=1000, help="cases of each check; 1000")
    command.add_argument(
        "--mutations", metavar="N", type=_count, default=10_000, help="damaged files for each reader; 10000"
    )
    command.add_argument("--seed", metavar="S", type=_count, default=1, help="seed of all chance; default: 1")
    command.add_argument("--only", metavar="NAME", help="element | integrator | readers; default: all")
    command.add_argument("--json", action="store_true", help="the checks as JSON")
    command.add_argument("-o", "--output", metavar="FILE", help="the same into a file, .txt or .json")


def _modes(command: argparse.ArgumentParser) -> None:
    """Add the option of modes."""
    command.add_argument(
        "--highest",
        metavar="FREQUENCY",
        help='highest frequency listed and drawn, such as "5 kHz"; default: the highest of [linear], else 10 kHz',
    )


def _shapes(command: argparse.ArgumentParser) -> None:
    """Add pictures and files of mode shapes."""
    command.add_argument(
        "--shapes", metavar="FIG.png", help="picture of mode shapes in space; also .pdf, .svg; .html: a page that moves"
    )
    command.add_argument(
        "--shapes-file", metavar="SHAPES.vtu", help="mode shapes for ParaView; .pvd: a series over a period"
    )
    command.add_argument(
        "--shape-modes", metavar="N", nargs="+", help="numbers of the modes there; default: those listed, six a picture"
    )


def _state_space(command: argparse.ArgumentParser) -> None:
    """Add the file of a state space."""
    command.add_argument(
        "--state-space", metavar="SPACE.mat", help="A, B, C, D with names and units, for MATLAB and Octave"
    )


def _at_speed(command: argparse.ArgumentParser) -> None:
    """Add the speed of an analysis at one speed."""
    command.add_argument("--speed", metavar="SPEED", help='such as "1500 rpm"; default: that of [operation]')


def _report(command: argparse.ArgumentParser) -> None:
    """Add the options of a report; its -o is a page."""
    command.add_argument(
        "-o", "--output", metavar="REPORT.html", help="default: the scene's name with .html, in this folder"
    )
    command.add_argument(
        "--result",
        metavar="RESULT.nc",
        help="Campbell diagram of a result of `mbs sweep -o` or `mbs campbell -o` in place of a short sweep",
    )


def _runup(command: argparse.ArgumentParser) -> None:
    """Add the options of runs in time."""
    _parallel(command)
    _level_tolerance(command)
    command.add_argument(
        "--spectrum-at",
        metavar="SPEED",
        action="append",
        help='amplitude spectra of all sensors about a speed, such as "1500 rpm"; up to four times',
    )
    command.add_argument("--window", metavar="TIME", help='length of their windows, such as "50 ms"')
    command.add_argument("--highest", metavar="FREQUENCY", help='their highest frequency, such as "5 kHz"')
    command.add_argument(
        "--sound",
        nargs="+",
        metavar=("FILE.wav", "SENSOR"),
        help="a sensor to listen to, of 16 bits and 48 kHz; default: the first of an acceleration",
    )
    _recorded(command)


def _parallel(command: argparse.ArgumentParser) -> None:
    """Add the number of processes."""
    command.add_argument(
        "--workers", metavar="N", type=count, help="processes that compute cases side by side; default: all cores"
    )


def _cage_angles(command: argparse.ArgumentParser) -> None:
    """Add the number of cage angles."""
    command.add_argument(
        "--cage-angles",
        metavar="COUNT",
        help="angles within one pitch of the rollers over which k and c of the bearings are averaged (1)",
    )


def _speeds(command: argparse.ArgumentParser) -> None:
    """Add the speeds of a sweep."""
    command.add_argument(
        "--speed",
        nargs=3,
        metavar=("FROM", "TO", "POINTS"),
        help='such as "500 rpm" "2500 rpm" 40, in place of [sweep] of the scene',
    )


def _waterfall(command: argparse.ArgumentParser) -> None:
    """Add the waterfall of levels."""
    command.add_argument(
        "--waterfall", metavar="FIG.png", help="levels as a map and as spectra over speed, with lines of orders"
    )


def _campbell(command: argparse.ArgumentParser) -> None:
    """Add the options of a Campbell diagram."""
    _parallel(command)
    command.add_argument(
        "--sensor",
        metavar="NAME",
        action="append",
        help="a sensor, more than once for several of one run, or all; default: the first of an acceleration",
    )
    command.add_argument("--highest", metavar="FREQUENCY", help='highest frequency, such as "5 kHz"')
    command.add_argument("--window", metavar="TIME", help='length of the windows, such as "50 ms"')
    command.add_argument(
        "--orders",
        metavar="ORDER",
        nargs="+",
        help="to draw and follow, such as 21 42; default: of gears or rollers, and of unbalances and excitations",
    )
    _recorded(command)
    command.add_argument(
        "--measured",
        metavar="FILE",
        help=f"a measured run beside the simulated ones: .csv, .uff, .wav or .nc with a speed; {_UFF}",
    )
    command.add_argument(
        "--channel",
        metavar="NAME",
        action="append",
        help="its channel for the sensor, once for each --sensor; default: the one of that name, else the only one",
    )
    command.add_argument(
        "--bands",
        metavar="N",
        help="runs more of each law, up to 8, with laws that are wrong by the errors of the map: a band of the sum "
        "level; each costs a run (0)",
    )
    _level_tolerance(command)
    command.add_argument("--modes", action="store_true", help="draw in the linear modes, with the films of each run")


def _level_tolerance(command: argparse.ArgumentParser) -> None:
    """Add the tolerance of the levels of a run-up."""
    command.add_argument(
        "--tolerance",
        metavar="LEVEL",
        help="of one law: choose step and slices by short trials so that the sum level at equal speed keeps "
        'it, such as "1 dB"; with --auto films, too',
    )


def _recorded(command: argparse.ArgumentParser) -> None:
    """Add where the speed of a recorded run is, and where signals are written."""
    command.add_argument(
        "--signals",
        metavar="FILE",
        help=f"the signals of all sensors with the speed: .csv, .uff, .wav, or .nc; {_UFF}",
    )
    command.add_argument(
        "--speed-channel", metavar="NAME", help="speed of a recorded run; default: its only channel in rpm, Hz or 1/min"
    )
    command.add_argument("--tacho", metavar="NAME", help="a channel of pulses instead, with --pulses")
    command.add_argument(
        "--pulses", metavar="N", help="pulses of the tacho a turn of the system, with those of missing teeth (1)"
    )
    command.add_argument("--speed-table", metavar="FILE.csv", help="a table of time and speed instead")


def _tradeoff(top: Program) -> None:
    """Add the command that measures speed against accuracy; the laws are its own."""
    words = "speed against accuracy of a scene, measured: laws, supplies, maps, slices, cut-off, step, cage angles"
    chosen = _choices("law", "physics", "films", "supply", "start-angle")
    more = "; the first map is the reference, more make rows; without one the film formula is the reference"
    command = top.add_command(_LABORATORY, "tradeoff", words, chosen, more)
    command.add_argument("scene", metavar="SCENE")
    command.add_argument("--sensor", metavar="NAME", help="of the sum level; default: the first of an acceleration")
    command.add_argument("--highest", metavar="FREQUENCY", help='highest frequency, such as "5 kHz"')
    command.add_argument("--window", metavar="TIME", help='length of the windows, such as "50 ms"')
    command.add_argument("--linear-only", action="store_true", help="no run-ups, which take minutes")
    command.add_argument("--all", action="store_true", help="all tables, and the worst place of each choice")
    command.add_argument("--json", action="store_true", help="print JSON instead of tables")
    command.add_argument("-o", "--output", metavar="OUT.nc", help="result as netCDF")
    command.add_argument("--plot", metavar="FIG.png", help="figure; also .pdf, .svg")


def _variants(command: argparse.ArgumentParser) -> None:
    """Add the options of single changes."""
    _parallel(command)
    command.add_argument(
        "--vary",
        nargs="+",
        action="append",
        default=[],
        metavar=("KEY", "VALUE"),
        help="a key and its values, such as clearance '0 um' '15 um', one at a time around the base; more than once "
        f"for more keys, left out: the base alone. Keys: {', '.join(VARIED)}",
    )
    command.add_argument("--highest", metavar="FREQUENCY", help='highest frequency, such as "5 kHz"')
    command.add_argument("--window", metavar="TIME", help='length of the windows, such as "50 ms"')


def _bearing(top: Program) -> None:
    """Add the command on one bearing, without a scene."""
    words = "one bearing without a scene: stiffness, damping, loads of rollers or balls, pressures, films"
    chosen = _choices("physics", "load-factor", "start-angle")
    command = top.add_command(_LOOK, "bearing", words, chosen)
    command.add_argument(
        "bearing", metavar="BEARING", help="N1014, NU308, 6208, 7208B, or a TOML file with [bearing] (a job)"
    )
    for option, example, what in (
        ("--load", '"5 kN"', "on the inner ring"),
        ("--speed", '"1500 rpm"', "of the inner ring; 0 rpm for dry contacts at rest"),
    ):
        command.add_argument(
            option,
            nargs="+",
            action="append",
            required=True,
            metavar="VALUE",
            help=f"{what}, such as {example}, or FROM TO POINTS; more than once for a list",
        )
    command.add_argument(
        "--direction",
        nargs="+",
        metavar="ANGLE",
        help='of the load from y, where a roller is, towards z, such as "15 deg"; or its parts along y and z (0 deg)',
    )
    command.add_argument(
        "--axial", metavar="LOAD", help="on the inner ring of balls, tapered rollers, NJ, NUP, along x (0 N)"
    )
    command.add_argument("--outer-speed", metavar="SPEED", help="of the outer ring of a ball bearing (0 rpm)")
    command.add_argument("--tilts", action="store_true", help="the inner ring of a ball bearing tilts freely")
    for side in ("inner", "outer"):
        command.add_argument(
            f"--{side}-ring-temperature",
            metavar="TEMPERATURE",
            help=f"of the {side} ring alone, such as '60 degC'; it changes the clearance; the law takes the mean of "
            "both",
        )
    command.add_argument(
        "--oil", metavar="NAME", help="oil without a map: FVA3, ISO VG 46; default: the file's, else FVA3"
    )
    command.add_argument(
        "--profile",
        metavar="PROFILE",
        default="iso",
        help="of the rollers: iso | straight | an arc or measured points as in scenes, such as "
        """'{ crown_drop = "10 um" }' or '{ positions = ["0 mm", "7.5 mm"], depths = ["0 um", "4 um"] }' (iso)""",
    )
    command.add_argument("--slices", metavar="N", default="41", help="of a roller (41)")
    command.add_argument("--coupled", action="store_true", help="slices coupled elastically, as in three dimensions")
    command.add_argument(
        "-o",
        "--output",
        metavar="OUT.nc",
        help="result as netCDF, a row a point as .csv; balls, tapered also .toml | .bdf | .inp | .txt | .c | .fmu",
    )
    command.add_argument("--plot", metavar="FIG.png", help="figure; also .pdf, .svg")


def _check(top: Program) -> None:
    """Add the command that solves nothing."""
    words = "every problem of a scene at once, and what will be solved: bodies, bearings, analyses"
    command = top.add_command(_LOOK, "check", words, _choices())
    command.add_argument("scene", metavar="SCENE")


def _new(top: Program) -> None:
    """Add the command that writes a scene."""
    words = "a commented scene of a shaft on two bearings, to begin your own machine with"
    command = top.add_command(_PREPARE, "new", words)
    command.add_argument("what", choices=("shaft",), help="what the scene is of")
    command.add_argument(
        "--csv",
        metavar="SECTIONS.csv",
        help="sections of the shaft: length [mm], outer diameter [mm], inner diameter [mm]",
    )
    command.add_argument("-o", "--output", metavar="SCENE.toml", help="default: shaft.toml in this folder")


def _import(top: Program) -> None:
    """Add the command that makes a scene of a rotor of another program."""
    words = "a scene of a rotor that ROSS 2 saved: shaft, discs, bearings, seals, supports"
    command = top.add_command(_PREPARE, "import", words)
    command.add_argument("rotor", metavar="ROTOR", help="file of Rotor.save, .toml or .json")
    command.add_argument("-o", "--output", metavar="SCENE.toml", help="default: ROTOR_scene.toml in this folder")


def _plan(top: Program) -> None:
    """Add the command that plans the contact map of a scene; its -o is a job."""
    words = "which ranges a scene needs of a contact map, and the job that covers just these"
    command = top.add_command(_PREPARE, "plan", words, ("temperature", "clearance", "load_factor"))
    command.add_argument("scene", metavar="SCENE")
    command.add_argument(
        "--margin", metavar="FACTOR", help="highest load of the map over the largest one at rest, for what moves (3)"
    )
    command.add_argument(
        "-o", "--output", metavar="JOB.toml", help="job for `ehdmaps generate`; one for each type of bearing"
    )


def _reduce(top: Program) -> None:
    """Add the command that reads a table of a body instead of a scene."""
    words = "reduce a finite-element body to its interfaces and modes, for [[flexible]] tables"
    command = top.add_command(_PREPARE, "reduce", words)
    command.add_argument("body", metavar="BODY.toml")
    command.add_argument("-o", "--output", metavar="OUT.nc", help="also .npz; BODY.nc if left out")


def _hammer(command: argparse.ArgumentParser) -> None:
    """Add the options of a simulated hammer test; its -o is a universal file."""
    command.add_argument("--hits", type=int, default=8, metavar="N", help="at each input of the scene (8)")
    command.add_argument(
        "--noise", type=float, default=0.01, metavar="PART", help="standard deviation over the peak of a channel (0.01)"
    )
    command.add_argument("--seed", type=int, default=0, metavar="N", help="of heights and noise (0)")
    command.add_argument("--highest", metavar="FREQUENCY", help='of interest, such as "5 kHz"; else that of [linear]')
    command.add_argument("--duration", metavar="TIME", help='of a record, such as "1 s"; else by the slowest mode')
    command.add_argument("--nonlinear", action="store_true", help="integrate the nonlinear system for each hit")


def _modal_fit(top: Program) -> None:
    """Add the command that reads a universal file instead of a scene."""
    words = "frequencies and damping ratios from hammer hits or frequency responses"
    command = top.add_command(_MEASURED, "modal-fit", words)
    command.add_argument("file", metavar="FILE", help=f"universal file (UFF), measured or made by `mbs hammer`; {_UFF}")
    command.add_argument("--band", nargs=2, metavar=("FROM", "TO"), help='such as "100 Hz" "5 kHz"')
    command.add_argument("--modes", type=int, metavar="N", help="how many to keep at most")
    command.add_argument("--order", type=int, metavar="N", help="highest number of pole pairs (40)")
    command.add_argument("--estimator", choices=("h1", "h2"), default="h1", help="noise on the responses, on the force")
    command.add_argument(
        "--window-decay",
        metavar="TIME",
        help='time constant of an exponential window, such as "0.2 s", or none; else by the decay of the hits. Of '
        "frequency responses: the window that they have been through",
    )
    command.add_argument(
        "--windowed",
        nargs="+",
        metavar=("TIME", "force"),
        help='exponential window that an analyser has put on the responses: its time constant, such as "50 ms", or '
        'what it leaves at the end of a record, such as "1 %%"; with the word force where the hits have been through '
        "it, too",
    )
    command.add_argument("--no-refine", action="store_true", help="poles as the method finds them")
    command.add_argument("-o", "--output", metavar="OUT.nc", help="result as netCDF")
    command.add_argument("--responses", metavar="FRF.uff", help="estimated responses and coherences")
    command.add_argument("--plot", metavar="FIG.png", help="figure; also .pdf, .svg")


_ON_SCENES = {
    "statics": _OnScene(
        _LOOK, "equilibrium, loads of the rollers, stiffness and damping of the bearings", (_at_speed,)
    ),
    "report": _OnScene(_LOOK, "the scene as one page to send: no network needed, prints to PDF", (_report, _speeds)),
    "modes": _OnScene(
        _LINEAR, "frequencies, damping ratios and where the strain energy is", (_modes, _shapes, _at_speed)
    ),
    "lsa": _OnScene(
        _LINEAR,
        "linear system analysis: state space and frequency responses",
        (_state_space, _cage_angles, _at_speed),
        compares=True,
    ),
    "sweep": _OnScene(
        _LINEAR,
        "modes, bearings and frequency responses over speed",
        (_parallel, _speeds, _cage_angles, _waterfall),
        compares=True,
    ),
    "critical": _OnScene(
        _LINEAR, "critical speeds, and the response to unbalances and orders over speed", (_speeds,), compares=True
    ),
    "runup": _OnScene(
        _TIME,
        "integrate the nonlinear system in time over its speed profile; SCENE may be a recorded run",
        (_runup,),
        compares=True,
    ),
    "campbell": _OnScene(
        _TIME,
        "run-up in time as levels over speed and frequency; SCENE may be a recorded run (.nc, .csv, .uff, .wav)",
        (_campbell, _waterfall),
        compares=True,
    ),
    "variants": _OnScene(
        _TIME, "a difference between two laws in a run-up under single changes, as a table", (_variants,), compares=True
    ),
    "hammer": _OnScene(
        _TIME,
        f"a simulated hammer test: records as a universal file; {_UFF}",
        (_parallel, _hammer, _at_speed),
        compares=True,
    ),
}
"""Commands that take a scene, its choices, and physics of their own."""


def _choices(*but: str) -> tuple[str, ...]:
    """Keys of the choices of a scene, but for some."""
    return tuple(choice.key for choice in OPTIONS if choice.name not in but)


def _scene_command(top: Program, name: str, row: _OnScene) -> argparse.ArgumentParser:
    """Add a command on a scene; one that compares takes several values of a choice."""
    # Variants stand beside a base that is stated; --auto would choose another for each.
    shared = _choices() if name == "variants" else (*_choices(), *_OWN_PHYSICS)
    more = "; choices more than once to compare" if row.compares else ""
    command = top.add_command(row.group, name, row.words, shared, more)
    command.add_argument("scene", metavar="SCENE")
    if name == "report":
        command.set_defaults(plot=None)
    else:
        command.add_argument("-o", "--output", metavar="OUT.nc", help="result as netCDF")
        command.add_argument("--plot", metavar="FIG.png", help="figure; also .pdf, .svg")
    return command


def _auto(shared: argparse.ArgumentParser) -> None:
    """Add what chooses the physics."""
    group = shared.add_argument_group("physics by the question")
    group.add_argument(
        "--auto",
        action="store_true",
        default=None,
        help="films of the film table, with film memory and heat in the inlet where these matter; says what does",
    )
    group.add_argument(
        "--auto-tolerance",
        metavar="PART",
        help="change of a stiffness or damping above which physics matters to --auto, such as '5 %%', or of "
        "a level, such as '1 dB'; default: --tolerance of runup and campbell, else 5 %%",
    )


def _run(top: Program) -> None:
    """Add the command that does every analysis for which the scene has a table."""
    words = (
        "every analysis for which the scene has a table: statics, modes, lsa, sweep, critical, and campbell or runup"
    )
    command = top.add_command(_LOOK, "run", words, (*_choices(), *_OWN_PHYSICS))
    command.add_argument("scene", metavar="SCENE")
    command.add_argument(
        "-o",
        "--output",
        metavar="FOLDER",
        help="of results, figures and texts of all analyses; default: the scene's name with _results, in this folder",
    )
    # The command asks for the others by their own words.
    command.set_defaults(parse=top.parse_args)


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
    rooms = {
        **dict.fromkeys(_MEASURING, "mbs.laboratory.commands"),
        **dict.fromkeys(_SCENES, "mbs.commands.scenes"),
    }
    room = rooms.get(name, "mbs.commands")
    result: tuple[str, int] = importlib.import_module(f"{room}.{name}").run(arguments)
    return result


def _count(text: str) -> int:
    """Read a whole number >= 0."""
    if not (text.isascii() and text.isdigit() and len(text) <= 9):
        raise argparse.ArgumentTypeError(f"got {text[:40]!r}; allowed: a whole number from 0 to 999999999")
    return int(text)


if __name__ == "__main__":
    sys.exit(main())
