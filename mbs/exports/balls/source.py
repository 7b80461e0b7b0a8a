"""A ball bearing in C: the kernel that Python calls, numbers of one bearing, what callers see; what others share."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from pathlib import Path

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import InputError
from ehdmaps.exports.c.text import comment, define, number, renamed, template
from ehdmaps.outputs import Kind, has_mark, write_text
from mbs.bearings.balls.ball_bearing import BallForce
from mbs.bearings.balls.normal_law import NormalLaw
from mbs.exports.balls.speed_laws import SpeedLaws

SOURCE = Kind("a bearing in C made by ehdmaps", (".c",), has_mark)
HEADER = Kind("the header of a bearing in C made by ehdmaps", (".h",), has_mark)

_BODIES, _FILMS, _LAW = "ball_bearing", "ball_films", "bearing_law"
_KERNEL = ("ball/ball.h", "ball/ball_balance.c", "ball/ball_bearing.c")

_WORDS = re.compile(r"[^a-z0-9_]+")


def prefix_of(path: str | Path, kind: str = "ball") -> str:
    """Prefix of all names in the sources of a file, by its own: `front.c` has `front_bearing_call`.

    Parameters
    ----------
    path : str or Path
        File of the source.
    kind : str
        What stands before a name that begins with no letter.
    """
    name = _WORDS.sub("_", Path(path).stem.lower())
    return name if name[:1].isalpha() else f"{kind}_{name}"


def header_of(path: str | Path) -> Path:
    """File of the header beside a source.

    Parameters
    ----------
    path : str or Path
        File of the source.
    """
    return Path(path).with_suffix(".h")


def write_source(path: str | Path, force: BallForce, laws: SpeedLaws, header: Sequence[str]) -> str:
    """Write source and header, and return what was written in words.

    Parameters
    ----------
    path : str or Path
        File of the source; the header goes beside it.
    force : BallForce
        Geometry and material.
    laws : SpeedLaws
        Laws of the contacts.
    header : sequence of str
        Lines that say where it comes from.

    Raises
    ------
    InputError
        If a file may not be replaced or cannot be written.
    """
    return write_texts(path, source_texts(force, laws, header, prefix_of(path), header_of(path).name), prefix_of(path))


def write_texts(path: str | Path, texts: Mapping[str, str], prefix: str) -> str:
    """Write header and source, and return what was written in words.

    Parameters
    ----------
    path : str or Path
        File of the source; the header goes beside it.
    texts : mapping of str to str
        Texts of the header, `h`, and of the source, `c`.
    prefix : str
        What all public names begin with.

    Raises
    ------
    InputError
        If a file may not be replaced or cannot be written.
    """
    write_text(header_of(path), texts["h"], HEADER)
    write_text(path, texts["c"], SOURCE)
    return f"{path}, {header_of(path)}: written (C99, names begin with {prefix}_)"


def source_texts(
    force: BallForce, laws: SpeedLaws, header: Sequence[str], prefix: str = "ehd", include: str = "bearing.h"
) -> dict[str, str]:
    """Texts of the header, `h`, and of the source, `c`.

    Parameters
    ----------
    force : BallForce
        Geometry and material.
    laws : SpeedLaws
        Laws of the contacts.
    header : sequence of str
        Lines that say where it comes from, put first.
    prefix : str
        What all public names begin with, in lower case.
    include : str
        Name of the header.

    Raises
    ------
    InputError
        For a bearing that is mirrored already: the source does that.
    """
    if force.geometry.contact_angle < 0.0:
        raise InputError(
            "export of a ball bearing, contact angle: got one below zero; allowed: >= 0; the source mirrors it"
        )
    memory = [_FILMS] if laws.memory else []
    kernel = (*pair_files(laws), *_KERNEL, *(f"ball/{name}.c" for name in memory))
    headers, bodies = ([_template(f"{name}.{end}") for name in (_BODIES, *memory)] for end in "hc")
    numbers = _public_numbers(force, laws), _private_numbers(force, laws)
    return joined(header, numbers, kernel, headers, bodies, prefix, include)


def pair_files(laws: SpeedLaws) -> tuple[str, ...]:
    """Files of the kernel with the laws of contacts.

    Parameters
    ----------
    laws : SpeedLaws
        Laws of the contacts.
    """
    speeds, memory = () if laws.dry else ("pair/pair_speeds.c",), ("pair/pair_memory.c",) if laws.memory else ()
    return ("numbers.h", "pair/pair_law.h", "pair/pair_law.c", *speeds, *memory)


def joined(
    header: Sequence[str],
    numbers: tuple[str, str],
    kernel: Sequence[str],
    headers: Sequence[str],
    bodies: Sequence[str],
    prefix: str,
    include: str,
) -> dict[str, str]:
    """Texts of the header, `h`, and of the source, `c`, with the laws of contacts.

    Parameters
    ----------
    header : sequence of str
        Lines that say where it comes from, put first.
    numbers : (str, str)
        Constants that callers may read, and those that only the functions read.
    kernel : sequence of str
        Files of the kernel, `.h` and `.c`.
    headers, bodies : sequence of str
        Declarations and functions of the bearing.
    prefix : str
        What all public names begin with, in lower case.
    include : str
        Name of the header.
    """
    banner, guard = comment(header), "EHD_BEARING_H"
    top = [
        banner, f"#ifndef {guard}\n#define {guard}\n\n#include <stddef.h>\n",
        numbers[0],
        '#ifdef __cplusplus\nextern "C" {\n#endif\n',
        _template(f"{_LAW}.h"), *headers,
        f"#ifdef __cplusplus\n}}\n#endif\n\n#endif /* {guard} */\n",
    ]  # fmt: skip
    source = [
        banner, '#include "@HEADER@"\n',
        *(_kernel(name) for name in kernel if name.endswith(".h")),
        numbers[1],
        *(_kernel(name) for name in kernel if name.endswith(".c")),
        _template(f"{_LAW}.c"), *bodies,
    ]  # fmt: skip
    texts = {"h": "\n".join(top), "c": "\n".join(source)}
    return {name: renamed(text, prefix).replace("@HEADER@", include) for name, text in texts.items()}


def _template(name: str) -> str:
    """Text of a file of this package."""
    return template("mbs.exports.balls", name)


def _kernel(name: str) -> str:
    """Text of a file of the kernel."""
    return template("ehdmaps.kernel", f"c/{name}")


def _public_numbers(force: BallForce, laws: SpeedLaws) -> str:
    """Constants that callers may read."""
    geometry = force.geometry
    return "".join(
        (
            define("EHD_BALLS", geometry.balls, "number of balls"),
            define("EHD_BALL_DIAMETER", geometry.ball_diameter, "[m]"),
            define("EHD_PITCH_DIAMETER", geometry.pitch_diameter, "[m]"),
            define("EHD_CONTACT_ANGLE", geometry.contact_angle, "nominal [rad]"),
            define("EHD_CLEARANCE", geometry.clearance, "diametral clearance of the export [m]"),
            define("EHD_CAGE_INNER", 0.5 * (1.0 - geometry.gamma), "turns of the cage for each of the inner ring"),
            define("EHD_CAGE_OUTER", 0.5 * (1.0 + geometry.gamma), "turns of the cage for each of the outer ring"),
            define("EHD_ENTRAINMENT", geometry.entrainment_speed(1.0, 0.0), "entrainment speed [m/rad], see below"),
            public_law(laws),
        )
    )


def public_law(laws: SpeedLaws) -> str:
    """Constants of the laws that callers may read.

    Parameters
    ----------
    laws : SpeedLaws
        Laws of the contacts.
    """
    slow, fast = (laws.speeds[0], laws.speeds[-1]) if laws.speeds.size else (0.0, math.inf)
    return "".join(
        (
            define("EHD_SPEEDS", int(laws.speeds.size), "entrainment speeds of the films; 0 for dry contacts"),
            define("EHD_LOWEST_SPEED", float(slow), "the first of them [m/s]"),
            define("EHD_HIGHEST_SPEED", float(fast), "the last of them [m/s]"),
            define("EHD_MEMORY", int(laws.memory), "1: films have a memory, see ehd_films"),
            define("EHD_SPRINGS", len(laws.shorter), "springs of a contact with memory"),
            define("EHD_ROWS", int(laws.tables.shape[2]), "nodes of approaches of a film; 0 for dry contacts"),
        )
    )


def _private_numbers(force: BallForce, laws: SpeedLaws) -> str:
    """Constants and tables that only the functions read."""
    geometry, shape, drive = force.geometry, force.shape, force.drive
    parts = [
        define("GROOVE_DISTANCE", geometry.groove_distance, "of the grooves' centres where balls just touch [m]")
        + define("INNER_ARM", shape.inner_arm, "of the inner groove's centre and the centre of a ball that touches [m]")
        + define("OUTER_ARM", shape.outer_arm, "the same of the outer one [m]")
        + define("CENTRIFUGAL", drive.centrifugal, "centrifugal load of a ball over the square of its speed [kg m]")
        + define("GYROSCOPIC", drive.gyroscopic, "the same of the traction of its gyroscopic moment [kg m]"),
        private_law(laws),
    ]
    return "\n".join(parts)


def private_law(laws: SpeedLaws) -> str:
    """Constants and tables of the laws that only the functions read.

    Parameters
    ----------
    laws : SpeedLaws
        Laws of the contacts.
    """
    parts = [_contact("INNER", laws.inner) + _contact("OUTER", laws.outer)]
    if laws.dry:
        return "\n".join(parts)
    times = ", ".join(map(number, laws.shorter))
    if laws.memory:
        words = "/* Of the springs of a film, over the longest. */"
        parts.append(f"{words}\nstatic const double TIMES[EHD_SPRINGS] = {{{times}}};\n")
    for side, name in enumerate(("INNER", "OUTER")):
        places, tables = laws.places[:, side], laws.tables[:, side]
        parts += [
            f"/* Centre and scale at each speed. */\nstatic const double {name}_PLACE[EHD_SPEEDS][2] = {{\n"
            + "".join(f"    {{{number(c)}, {number(s)}}},\n" for c, s in places.tolist())
            + "};\n",
            f"/* By speed and node: ln g and its slope, ln c and its slope. */\n"
            f"static const double {name}_TABLE[EHD_SPEEDS][EHD_ROWS][4] = {{\n"
            + "".join(_table(table) for table in tables)
            + "};\n",
        ]
        if laws.memory:
            parts.append(
                f"/* By speed and node: parts of the damping that the springs have, ln of the longest time. */\n"
                f"static const double {name}_SPRINGS[EHD_SPEEDS][EHD_ROWS][EHD_SPRINGS + 1] = {{\n"
                + "".join(_table(table) for table in laws.springs[:, side])
                + "};\n"
            )
    return "\n".join((*parts, _speeds(laws)))


def _speeds(laws: SpeedLaws) -> str:
    """Laws of both contacts over the speed, as the kernel reads them."""
    ends = ", ".join(map(number, (math.log(laws.speeds[0]), laws.per_log, laws.highest)))
    places, tables = "{&INNER_PLACE[0][0], &OUTER_PLACE[0][0]}", "{&INNER_TABLE[0][0][0], &OUTER_TABLE[0][0][0]}"
    shares = "{&INNER_SPRINGS[0][0][0], &OUTER_SPRINGS[0][0][0]}" if laws.memory else "{NULL, NULL}"
    return (
        "static const ehd_pair_speeds SPEEDS = {\n"
        "    EHD_SPEEDS, EHD_ROWS, EHD_SPRINGS, EHD_LOWEST_SPEED, EHD_HIGHEST_SPEED,\n"
        f"    {ends}, /* ln of the first speed; speeds in a unit of ln u; load up to which films were made [N] */\n"
        f"    {'TIMES' if laws.memory else 'NULL'},\n    {places},\n    {tables},\n    {shares}}};\n"
    )


def _table(table: FloatArray) -> str:
    """A table at one speed."""
    lines = ",\n".join("    {" + ", ".join(map(number, row)) + "}" for row in table.tolist())
    return f"    {{\n{lines}}},\n"


def _contact(name: str, law: NormalLaw) -> str:
    """Numbers of a contact, without its table."""
    values = ", ".join(
        map(number, (law.coefficient, law.damping, law.damping_time, law.centre, law.scale, law.first, law.step))
    )
    return f"static const ehd_contact {name} = {{{values}, {{{{0.0}}}}, {{{{0.0}}}}}};\n"
