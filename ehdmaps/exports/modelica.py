"""Target `modelica` of `ehdmaps export`: the contact law at one speed and temperature as a Modelica package.

At one speed and temperature the law is a table of cubics: w^(1/3) and ln(c/w) over
s = asinh((approach - offset)/scale). The cells of s are evenly spaced. The package has these very cubics, so that it
differs from the law by round-off only. The derivative of the function in time is a function, too, and exact, so that no
tool has to take difference quotients for it.

Films with memory in the Modelica package: a state for each contact, the approach at which its film would be at rest.

    approach = a(w) + y(xi),    xi' = (w^2 - p^2)/(2 w)/(dG/dxi)

The package has the cubics of `ehdmaps.maps.kernels.memory_table`, as far as the loads of the map reach, and the rate of
the kernel in C (`ehd_film_rate`), so that it differs from that by round-off only.
"""

from __future__ import annotations

import argparse
import math
import re
from collections.abc import Iterable
from importlib import resources
from pathlib import Path

import numpy as np

from ehdmaps.errors import InputError, Problems
from ehdmaps.exports.target import Target, chosen_kind, chosen_place, origin
from ehdmaps.maps.emap import EHDMap
from ehdmaps.maps.kernels import memory_table
from ehdmaps.maps.law_films import LawAtPoint
from ehdmaps.outputs import Kind, Output, check_outputs, has_mark, write_text
from ehdmaps.program import plain
from ehdmaps.units import SPEED, TEMPERATURE

PACKAGE = Kind("a Modelica package of ehdmaps", (".mo",), has_mark)

_WORDS = """
    algorithm and annotation assert block break class connect connector constant constrainedby der
    discrete each else elseif elsewhen encapsulated end enumeration equation expandable extends external
    false final flow for function if import impure in initial inner input loop model not operator or
    outer output package parameter partial protected public pure record redeclare replaceable return
    stream then true type when while within
"""
"""Words of the language (Modelica Language Specification 3.5, section 2.3.3)."""

_OWN = ("Table", "atRest", "force", "forceDerivative", "Example", "Film", "cellOf", "loadAt", "film", "ExampleMemory")
"""Names inside the package."""

_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]{0,62}")


SHORTEST_MEMORY, OPENING = 1e-12, 0.003
"""What keeps rates finite where there is hardly a load: as `EHD_SHORTEST_MEMORY` [s] and `EHD_OPENING` in film.h."""

_DIGITS = 32
"""Cells to each doubling."""


def package(law: LawAtPoint, name: str, lines: Iterable[str], memory: bool = False) -> str:
    """Return a law at one speed and temperature as a Modelica package.

    Parameters
    ----------
    law : LawAtPoint
        The law; with its whole film, and without a centrifugal load.
    name : str
        Name of the package.
    lines : iterable of str
        Lines of its header; the first carries our mark.
    memory : bool
        Whether it has films with memory, too.

    Raises
    ------
    InputError
        If the name is not allowed in Modelica, or if the speed is below the mapped ones, where films fade.
    """
    if not _NAME.fullmatch(name) or name in _WORDS.split() or name in _OWN:
        raise InputError(
            f"--name: got {name!r:.60}; allowed: up to 63 letters, digits and _, a letter first, no word of Modelica"
        )
    point = law.point
    if point.film < 1.0 or point.centrifugal_load > 0.0:
        raise InputError("--speed: below the lowest speed of the map the film fades; allowed: speeds of the map")
    line = point.own
    highest = law.approach(point.highest_load)
    load = point.highest_load * 0.1
    begin = law.approach(load)
    _, stiffness, damping = law(begin, 0.0)
    # The mass oscillates at 1 kHz, and begins 1 % of its approach off its place.
    mass = float(stiffness) / (2.0e3 * math.pi) ** 2
    text = _template("contact_law.mo").format(
        name=name,
        title="EHD contact law at one speed and temperature",
        lines="\n  // ".join(_comment(one) for one in lines),
        cells=len(line.coefficients),
        offset=_number(line.offset),
        inverse_scale=_number(line.inverse_scale),
        start=_number(line.start),
        step=_number(line.step),
        highest=_number(highest),
        rows=_rows(line.coefficients),
        nominal=f"{1.0 / line.inverse_scale:.1g}",
        load=_number(load),
        stiffness=f"{float(stiffness):.1g}",
        damping=f"{max(float(damping), 1.0):.1g}",
        mass=_number(mass),
        begin=_number(1.01 * begin),
    )
    if memory:
        words = {"nominal": f"{1.0 / line.inverse_scale:.1g}", "nominal_load": _number(load), "mass": _number(mass)}
        end = text.rindex(f"end {name};")
        text = f"{text[:end]}\n{memory_text(law, {**words, 'begin': _number(1.01 * begin)})}{text[end:]}"
    return text


def _template(name: str) -> str:
    """A text of a package, with places for `str.format`."""
    return (resources.files(__package__) / name).read_text(encoding="utf-8")


def _number(value: float) -> str:
    """Return a number with all digits."""
    return repr(float(value))


def _comment(text: str) -> str:
    """Return a text for a comment of one line, in ASCII."""
    return plain(text).encode("ascii", "backslashreplace").decode("ascii")


def _add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add where the law is taken."""
    parser.add_argument("--speed", required=False, help='entrainment speed, such as "1.7 m/s"; a map of one has it')
    parser.add_argument("--temperature", help='of the raceways, such as "40 degC"; a map of one has it')
    parser.add_argument("--contact", metavar="NAME", help="series | inner | outer | line; default: series, of a line")
    parser.add_argument(
        "--films", choices=("slow", "memory"), default="slow",
        help="films follow at once (the default), or also relax: function film, model ExampleMemory",
    )  # fmt: skip
    parser.add_argument("--name", default="EhdContact", help="name of the package; EhdContact if left out")


def _write(emap: EHDMap, path: Path, output: Path | None, arguments: argparse.Namespace) -> str:
    """Write the package; by default beside the map."""
    output = output or path.with_suffix(".mo")
    check_outputs([Output("-o", output, PACKAGE)], [path])
    problems = Problems()
    kind = chosen_kind(emap, arguments.contact, problems)
    speed, temperature = (
        chosen_place(emap, axis, text, unit, display, problems)
        for axis, text, unit, display in (
            ("entrainment_speed", arguments.speed, "m/s", SPEED),
            ("temperature", arguments.temperature, "K", TEMPERATURE),
        )
    )
    problems.check()
    law = emap.law(kind).at(speed, temperature)
    header = (
        *origin(emap, path.name),
        f"contact: {kind}, entrainment speed {SPEED.text(speed)}, temperature {TEMPERATURE.text(temperature)}",
        "units: SI, per unit length of contact; approach and load are positive together",
        "above the highest load of the map an assertion fails; function force: stiffness and damping of slow motion",
    )
    write_text(output, package(law, arguments.name, header, arguments.films == "memory"), PACKAGE)
    return f"{output}: written"


def memory_text(law: LawAtPoint, words: dict[str, str]) -> str:
    """Return what a package with memory has besides.

    Parameters
    ----------
    law : LawAtPoint
        The law at one speed and temperature.
    words : dict of str to str
        Numbers of the package: nominal, nominal_load, mass, begin.
    """
    table, highest = law.memory.table, law.point.highest_load
    reach = [law.approach(highest), table.lift_off]
    above, below = (_cells(1.0 + abs(place - table.centre) * table.inverse_scale) for place in reach)
    above, below = min(above, memory_table.ROWS), min(below, memory_table.ROWS)
    loads = min(_cells(1.0 + highest / memory_table.LIGHTEST), memory_table.LOAD_ROWS)
    cells = np.concatenate([table.cells[:above], table.cells[memory_table.ROWS : memory_table.ROWS + below]])
    slope = table.load_cells[loads - 1, 1]
    return _template("contact_memory.mo").format(
        above=above,
        below=below,
        loads=loads,
        rows=len(cells),
        centre=_number(table.centre),
        inverse_scale=_number(table.inverse_scale),
        lift_off=_number(table.lift_off),
        least_damping=_number(SHORTEST_MEMORY * memory_table.LIGHTEST / float(slope)),
        opening=OPENING,
        film=_rows(np.delete(cells, 8, axis=1)),
        load=_rows(table.load_cells[:loads]),
        digits=_DIGITS,
        last=_DIGITS - 1,
        **words,
    )


def _cells(end: float) -> int:
    """Number of cells from 1 to a number, and one more for solvers that go beyond."""
    octave = math.floor(math.log2(end))
    return octave * _DIGITS + math.floor((end / 2.0**octave - 1.0) * _DIGITS) + 2


def _rows(values: np.ndarray) -> str:
    """Return rows of an array in Modelica."""
    return ",\n      ".join("{" + ", ".join(_number(value) for value in row) + "}" for row in values)


TARGET = Target(
    summary="the contact law at one speed and temperature as pure functions, with an example",
    writes="MAP.mo",
    read_back_by="rumoca",
    add_arguments=_add_arguments,
    write=_write,
)
