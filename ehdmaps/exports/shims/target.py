"""The targets `adams`, `recurdyn` and `simpack`: folders of the kernel in C and a user routine over it.

No foreign program reads them back: their interfaces are those of the makers' documentation, and the tests call the
routines through stand-ins for these programs.
"""

from __future__ import annotations

import argparse
from importlib.resources import files
from pathlib import Path

import numpy as np
from scipy.optimize import brentq

from ehdmaps.errors import InputError
from ehdmaps.exports.c.kernel import BEYOND, kernel_files
from ehdmaps.exports.c.target import add_law_arguments, options_of
from ehdmaps.exports.target import BEARING_AXES, Target, check_folder, origin, write_folder
from ehdmaps.maps.emap import EHDMap
from ehdmaps.units import quantity

_HISTORY = ("film_history.h", "film_history.c")
_SLOT = ("bearing_slot.h", "bearing_slot.c", *_HISTORY)
_CURVE_POINTS = 120
_LEAST = 1e-3
"""Load at which the spline of Adams begins, over the highest load of the map."""

_PLACES = (-1e-3, 1e-3)
"""Approaches between which all loads of a map lie [m]."""


def _target(program: str, routine: str, parts: tuple[str, ...], build: str) -> Target:
    """Make the target of a program.

    Parameters
    ----------
    program : str
        Name of the program, for people.
    routine : str
        File of the user routine.
    parts : tuple of str
        Other files of this package that it needs.
    build : str
        How it is compiled.
    """
    short = routine.split(".", maxsplit=1)[0]

    def add(parser: argparse.ArgumentParser) -> None:
        add_law_arguments(parser)
        if short == "adams":
            parser.add_argument("--speed", help='entrainment speed of a spline, "1.7 m/s"; default: none')
            parser.add_argument("--temperature", help='temperature of the spline, such as "40 degC"')

    def write(emap: EHDMap, path: Path, output: Path | None, arguments: argparse.Namespace) -> str:
        if emap.bearing is None:
            raise InputError(f"export {short}: the map is of a bare contact line; allowed: a map of a bearing")
        options = options_of(arguments)
        folder = output or path.with_name(f"{short}_{path.stem}")
        check_folder(folder, [path])
        header = origin(emap, path.name, BEYOND[options.outside])
        written = dict(kernel_files(emap, options, header))
        for name in (routine, *parts):
            text = (files("ehdmaps.exports.shims") / name).read_text(encoding="utf-8")
            begin, end = ("! ", "") if name.endswith(".f90") else ("/* ", " */")
            written[name] = f"{begin}{header[0]}{end}\n{text}"
        if getattr(arguments, "speed", None) or getattr(arguments, "temperature", None):
            written["spline.adm"] = _spline(emap, header, arguments)
        lines = [*header, "", *BEARING_AXES, "", f"{program}: {routine} says its parameters, axes and units.", build]
        written["README.txt"] = "\n".join(lines) + "\n"
        write_folder(folder, written)
        return f"{folder}: written ({', '.join(sorted(written))})"

    return Target(
        summary=f"user routine of {program} over the kernel in C",
        writes="a folder of sources",
        read_back_by="",
        add_arguments=add,
        write=write,
    )


def _spline(emap: EHDMap, header: tuple[str, ...], arguments: argparse.Namespace) -> str:
    """Write load over approach as SPLINE of Adams: both contacts of a roller in series, at rest, per metre of it."""
    if not (arguments.speed and arguments.temperature):
        raise InputError("--speed, --temperature: one of them is missing; the spline is made at both")
    place = quantity(arguments.speed, "m/s"), quantity(arguments.temperature, "K")
    emap.law("series", "error")(0.0, 0.0, *place)  # refuses what lies outside of the map
    law = emap.law("series", "clamp").at(*place)
    highest = float(emap.dataset["load"].values[-1])
    loads = np.geomspace(_LEAST * highest, (1.0 - 1e-9) * highest, _CURVE_POINTS)
    approach = [brentq(lambda at, w=load: float(law(at, 0.0)[0]) - w, *_PLACES, xtol=1e-16) for load in loads]
    rows = [f"! {line}" for line in header]
    rows.append(
        f"! load [N/m] per length of roller over approach [m], both contacts in series, at rest, at {arguments.speed}, "
        f"{arguments.temperature}; Adams goes on beyond the ends without a word"
    )
    for name, values in (("X", approach), ("Y", loads.tolist())):
        numbers = [f", {value:.10e}" for value in values]
        rows.append(("SPLINE/1\n" if name == "X" else "") + f", {name} =" + numbers[0][1:])
        rows += numbers[1:]
    return "\n".join(rows) + "\n"


ADAMS = _target(
    "Adams",
    "adams.c",
    _SLOT,
    "Compile ehd.c, bearing_slot.c, film_history.c and adams.c with slv_c_utils.h of your Adams into the library "
    "`bearing`.",
)
RECURDYN = _target(
    "RecurDyn", "recurdyn.c", _HISTORY, "Compile ehd.c, film_history.c and recurdyn.c into a library of user routines."
)
SIMPACK = _target(
    "Simpack",
    "simpack.f90",
    _SLOT,
    "Compile simpack.f90 with the module simpack of your installation, ehd.c, bearing_slot.c and film_history.c into "
    "user routines.",
)
