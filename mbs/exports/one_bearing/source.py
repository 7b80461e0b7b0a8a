"""A bearing as a C source: the kernel that Python calls, numbers of one bearing, and what callers see."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import InputError
from ehdmaps.exports.c.deviations import deviation_texts
from ehdmaps.exports.c.text import comment, define, number, renamed, template
from ehdmaps.outputs import Kind, has_mark, write_text
from mbs.bearings.deviating.tables import DeviationData
from mbs.bearings.locating.normal_law import NormalLaw
from mbs.exports.one_bearing.kind import ExportKind
from mbs.exports.one_bearing.speed_laws import SpeedLaws

SOURCE = Kind("a bearing in C made by ehdmaps", (".c",), has_mark)
HEADER = Kind("the header of a bearing in C made by ehdmaps", (".h",), has_mark)

_WORDS = re.compile(r"[^a-z0-9_]+")


def prefix_of(path: str | Path, kind: str) -> str:
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


def write_source(
    kind: ExportKind,
    path: str | Path,
    force: Any,
    laws: SpeedLaws,
    header: Sequence[str],
    deviations: DeviationData | None = None,
) -> str:
    """Write source and header, and return what was written in words.

    Parameters
    ----------
    kind : ExportKind
        Kind of the bearing.
    path : str or Path
        File of the source; the header goes beside it.
    force : BallForce or TaperedForce
        The bearing, dry.
    laws : SpeedLaws
        Laws of the contacts.
    header : sequence of str
        Lines that say where it comes from.
    deviations : DeviationData or None
        Deviations of the bearing from its form.

    Raises
    ------
    InputError
        If a file may not be replaced or cannot be written.
    """
    prefix, beside = prefix_of(path, kind.element), header_of(path)
    texts = source_texts(kind, force, laws, header, prefix, beside.name, deviations)
    write_text(beside, texts["h"], HEADER)
    write_text(path, texts["c"], SOURCE)
    return f"{path}, {beside}: written (C99, names begin with {prefix}_)"


def source_texts(
    kind: ExportKind,
    force: Any,
    laws: SpeedLaws,
    header: Sequence[str],
    prefix: str = "ehd",
    include: str = "bearing.h",
    deviations: DeviationData | None = None,
) -> dict[str, str]:
    """Texts of the header, `h`, and of the source, `c`.

    Parameters
    ----------
    kind : ExportKind
        Kind of the bearing.
    force : BallForce or TaperedForce
        The bearing, dry.
    laws : SpeedLaws
        Laws of the contacts.
    header : sequence of str
        Lines that say where it comes from, put first.
    prefix : str
        What all public names begin with, in lower case.
    include : str
        Name of the header.
    deviations : DeviationData or None
        Deviations of the bearing from its form.

    Raises
    ------
    InputError
        For a bearing that is mirrored already: the source does that.
    """
    if kind.mirrored(force.geometry):
        raise InputError(
            f"export of a {kind.words}: got one that carries along -x; allowed: along +x; the source mirrors it"
        )
    speeds, memory = () if laws.dry else ("pair/pair_speeds.c",), ("pair/pair_memory.c",) if laws.memory else ()
    kernel = ("numbers.h", "pair/pair_law.h", "pair/pair_law.c", *speeds, *memory, *kind.kernel)
    kernel = (*kernel, *kind.film_kernel) if laws.memory else kernel
    bodies = (f"{kind.files}_bearing", *([f"{kind.files}_films"] if laws.memory else []))
    banner, guard, (own_head, own_body) = comment(header), "EHD_BEARING_H", deviation_texts(deviations)
    top = [
        banner, f"#ifndef {guard}\n#define {guard}\n\n#include <stddef.h>\n#include <stdint.h>\n",
        kind.public(force) + _public_law(laws),
        '#ifdef __cplusplus\nextern "C" {\n#endif\n',
        _template("bearing_law.h"), *(_template(f"{name}.h") for name in bodies), own_head,
        f"#ifdef __cplusplus\n}}\n#endif\n\n#endif /* {guard} */\n",
    ]  # fmt: skip
    source = [
        banner, '#include "@HEADER@"\n',
        *(_kernel(name) for name in kernel if name.endswith(".h")),
        kind.private(force) + "\n" + _private_law(laws),
        *(_kernel(name) for name in kernel if name.endswith(".c")),
        _template("bearing_law.c"), *(_template(f"{name}.c") for name in bodies), own_body,
    ]  # fmt: skip
    texts = {"h": "\n".join(top), "c": "\n".join(source)}
    return {name: renamed(text, prefix).replace("@HEADER@", include) for name, text in texts.items()}


def _template(name: str) -> str:
    """Text of a file of this package."""
    return template("mbs.exports.one_bearing", name)


def _kernel(name: str) -> str:
    """Text of a file of the kernel."""
    return template("ehdmaps.kernel", f"c/{name}")


def _public_law(laws: SpeedLaws) -> str:
    """Constants of the laws that callers may read."""
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


def _private_law(laws: SpeedLaws) -> str:
    """Constants and tables of the laws that only the functions read."""
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
