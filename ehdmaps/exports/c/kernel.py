"""A contact law and a bearing in C: templates, in which the law's mathematics is, and the numbers of one map."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import InputError
from ehdmaps.exports.c.locked_table import locked_table
from ehdmaps.exports.c.text import array, comment, define, number, renamed, template
from ehdmaps.maps.emap import EHDMap
from ehdmaps.maps.kernels import locked_film
from ehdmaps.maps.kernels.tables import HALF_SPACE, ApproachTable, LawTable
from ehdmaps.maps.law import ContactLaw, LawKind, OutsidePolicy
from ehdmaps.physics.bearing import BearingGeometry

ProfileName = Literal["iso", "straight"]

_LEAST_SLICES = 201
_NAME = re.compile(r"[a-z][a-z0-9_]*")
_ALL, _WRONG = 127, 127 - (1 + 2 + 4)
"""All parts of a status of `law.h`, and those that are no matter of the range of the map."""

_INCLUDES = ("float.h", "math.h", "stddef.h", "stdint.h", "string.h")


BEYOND: Mapping[OutsidePolicy, str] = {"error": "refused", "clamp": "held", "asymptote": "extended"}
"""What happens outside the map, for `ehdmaps.exports.target.origin`."""


@dataclass(frozen=True)
class KernelOptions:
    """Selection of what is exported of a map.

    Attributes
    ----------
    kind : {"series", "inner", "outer", "line"}, optional
        Which law; a roller between both raceways, or the one contact of the map, if left out.
    outside : {"error", "clamp", "asymptote"}
        What happens outside the map, see `ehdmaps.maps.law.ContactLaw`: calls are refused, or held and told.
    centrifugal : bool
        Whether the law takes centrifugal loads: three times as much code.
    clearance : float, optional
        Diametral clearance that the export names [m]; that of the map's bearing if left out.
    slices : int
        Number of slices that the export names.
    profile : {"iso", "straight"}
        Profile of the rollers.
    prefix : str
        What all names begin with, in lower case: two maps in one program need two.
    """

    kind: LawKind | None = None
    outside: OutsidePolicy = "error"
    centrifugal: bool = False
    clearance: float | None = None
    slices: int = 41
    profile: ProfileName = "iso"
    prefix: str = "ehd"

    def __post_init__(self) -> None:
        problems = []
        if not _NAME.fullmatch(self.prefix):
            problems.append(
                f"export c, prefix: got {self.prefix!r}; allowed: lower-case letters, digits and _, a letter first"
            )
        if not 1 <= self.slices <= _LEAST_SLICES:
            problems.append(f"export c, slices: got {self.slices!r}; allowed: 1 to {_LEAST_SLICES}")
        if self.clearance is not None and not math.isfinite(self.clearance):
            problems.append(f"export c, clearance: got {self.clearance!r}; allowed: a finite number of metres")
        if problems:
            raise InputError(problems)


def kernel_files(emap: EHDMap, options: KernelOptions, header: Sequence[str]) -> dict[str, str]:
    """Names and texts of the files of an export.

    Parameters
    ----------
    emap : EHDMap
        The map.
    options : KernelOptions
        What is exported of it.
    header : sequence of str
        Lines that say where it comes from, put first.

    Raises
    ------
    InputError
        For a law that the map does not have, and for centrifugal loads of a single contact.
    MapError
        If no law can be made of the map.
    """
    kind: LawKind = options.kind or ("series" if emap.bearing is not None else "line")
    if options.centrifugal and kind != "series":
        raise InputError(f"export c, centrifugal: got the law {kind!r}; allowed: the law 'series' of a bearing's map")
    law = emap.law(kind, options.outside)
    bearing = emap.bearing if kind == "series" else None
    banner = comment(header)
    heads, bodies = ["law", "film"], ["law", "cells", "film"]
    if bearing is not None:
        heads += ["bearing", "film_bearing"]
        bodies += ["prepare", "bearing", "film_bearing"]
    guard = "EHD_H"
    top = [
        banner, f"#ifndef {guard}\n#define {guard}\n\n#include <stddef.h>\n",
        _public_numbers(law, bearing, options),
        '#ifdef __cplusplus\nextern "C" {\n#endif\n',
        *(_template(f"{part}.h") for part in heads),
        f"#ifdef __cplusplus\n}}\n#endif\n\n#endif /* {guard} */\n",
    ]  # fmt: skip
    source = [
        banner, "".join(f"#include <{name}>\n" for name in _INCLUDES) + '\n#include "ehd.h"\n',
        _template("tables.c"),
        _private_numbers(law, options.centrifugal),
        _film_numbers(law),
        *(_template(f"{part}.c") for part in bodies),
    ]  # fmt: skip
    texts = {"ehd.h": "\n".join(top), "ehd.c": "\n".join(source)}
    if bearing is not None:
        texts["ehd.f90"] = "".join(f"! {line}".rstrip() + "\n" for line in header) + "\n" + _template("interface.f90")
    return {name.replace("ehd", options.prefix): renamed(text, options.prefix) for name, text in texts.items()}


def _template(name: str) -> str:
    """Text of a template."""
    return template("ehdmaps.exports.c", name)


def _public_numbers(law: ContactLaw, bearing: BearingGeometry | None, options: KernelOptions) -> str:
    """Constants that callers may read."""
    table = law.plain_table
    refused = _ALL if law.outside == "error" else _WRONG
    tables = (law.table.own, law.table.inner, law.table.outer) if options.centrifugal else (table.own,)
    lines = [
        define("EHD_REFUSED", refused, f"parts of a status that refuse: the policy is {law.outside!r}"),
        define("EHD_HAS_CENTRIFUGAL", int(options.centrifugal), "whether centrifugal loads are taken"),
        define("EHD_CONTACTS", len(law.contacts), "contacts in series: " + ", ".join(c.name for c in law.contacts)),
        define("EHD_HIGHEST_LOAD", table.highest_load, "highest mapped load, at some speeds less [N/m]"),
        define("EHD_LOWEST_SPEED", law.speed_range[0], "lowest mapped speed [m/s]"),
        define("EHD_HIGHEST_SPEED", table.counted_speed, "highest mapped entrainment speed [m/s]"),
        define("EHD_LOWEST_TEMPERATURE", table.counted_cold, "lowest mapped temperature [K]"),
        define("EHD_HIGHEST_TEMPERATURE", table.counted_hot, "highest mapped temperature [K]"),
        define("EHD_MOST_CELLS", max(_places(entry) - 3 for entry in tables), "cells of a line"),
    ]
    if bearing is not None:
        clearance = bearing.diametral_clearance if options.clearance is None else options.clearance
        lines += [
            "\n",
            define("EHD_ROLLERS", bearing.rollers, "number of rollers"),
            define("EHD_ROLLER_LENGTH", bearing.roller_length, "[m]"),
            define("EHD_ROLLER_DIAMETER", bearing.roller_diameter, "[m]"),
            define("EHD_ISO_PROFILE", int(options.profile == "iso"), "1: profile of ISO/TS 16281, 0: straight"),
            define("EHD_CLEARANCE", clearance, "diametral clearance of the export [m]"),
            define("EHD_SLICES", options.slices, "slices of a roller of the export"),
            define("EHD_MOST_SLICES", max(options.slices, _LEAST_SLICES), "room for slices"),
            define("EHD_CAGE_INNER", 0.5 * (1.0 - bearing.gamma), "turns of the cage for each of the inner ring"),
            define("EHD_CAGE_OUTER", 0.5 * (1.0 + bearing.gamma), "turns of the cage for each of the outer ring"),
            define("EHD_ENTRAINMENT", bearing.entrainment_speed(1.0, 0.0), "entrainment speed [m/rad], see below"),
        ]
    return "".join(lines)


def _private_numbers(law: ContactLaw, centrifugal: bool) -> str:
    """Constants and tables that only the functions read."""
    table: LawTable = law.table if centrifugal else law.plain_table
    rows = "".join(
        f"    {{{int(kind == HALF_SPACE)}, {number(a)}, {number(b)}}},\n" for kind, a, b in table.structure.tolist()
    )
    parts = [
        define("FILM_SPEED", table.film_speed, "speed below which films fade [m/s]")
        + define("LOWEST_SPEED", table.lowest_speed, "speeds of the table [m/s]")
        + define("HIGHEST_SPEED", table.highest_speed, "beyond it the law is held")
        + define("LOWEST_TEMPERATURE", table.lowest_temperature, "temperatures of the table [K]")
        + define("HIGHEST_TEMPERATURE", table.highest_temperature, "beyond them the law is held")
        + define("KNOWN_LOAD", table.known_load, "load that is mapped at all speeds and temperatures [N/m]")
        + define("HELD_LOAD", table.held_load, "load above which the law is its tangent [N/m]"),
        f"static const structure STRUCTURE[EHD_CONTACTS] = {{\n{rows}}};\n",
        _ends(table.ends),
        _table("OWN", table.own, "the law"),
    ]
    if centrifugal:
        parts += [_table("INNER", table.inner, "the inner contact"), _table("OUTER", table.outer, "the outer contact")]
    return "\n".join(parts)


def _ends(ends: FloatArray) -> str:
    """Loads up to which films are mapped."""
    speeds, kelvins = (", ".join(map(number, axis.tolist())) for axis in (ends[1:, 0], ends[0, 1:]))
    rows = ",\n".join("    {" + ", ".join(map(number, row)) + "}" for row in ends[1:, 1:].tolist())
    return (
        define("END_SPEEDS", ends.shape[0] - 1, "places of ln u with highest mapped loads")
        + define("END_TEMPERATURES", ends.shape[1] - 1, "temperatures with them")
        + f"static const double END_LOG_SPEEDS[END_SPEEDS] = {{{speeds}}};\n"
        f"static const double END_KELVINS[END_TEMPERATURES] = {{{kelvins}}};\n"
        f"static const double ENDS[END_SPEEDS][END_TEMPERATURES] = {{\n{rows}}}; /* [N/m] */\n"
    )


def _film_numbers(law: ContactLaw) -> str:
    """Constants and the table of films with memory."""
    table, film = locked_table(law), locked_film.film_of(law.contacts, 0.0)
    speeds, temperatures, loads = table.speeds, table.temperatures, table.loads
    rows = ",\n".join(
        "    {" + ",\n     ".join("{" + ", ".join(map(number, line)) + "}" for line in part) + "}"
        for part in table.factors.tolist()
    )
    return "\n".join(
        (
            define("FILM_PI", math.pi, "pi")
            + define("FILM_RADIUS", film.radius, "mean reduced radius of the contacts [m]")
            + define("FILM_MODULUS", film.modulus, "E' [Pa]")
            + define("LOCKED", locked_film.LOCKED, "closed formula of the locked film")
            + define("LOCKED_BY_LOAD", locked_film.LOCKED_BY_LOAD, "its part that goes with the film's exponent")
            + define("MOST_LOCKED", locked_film.MOST_LOCKED, "most of the structure's compliance that it takes off")
            + define("LONGEST", locked_film.LONGEST, "longest relaxation time, in natural times")
            + define("FACTOR_SPEEDS", speeds.count, "places of ln u")
            + define("FACTOR_LOG_SPEED", speeds.start, "the first one")
            + define("FACTOR_SPEED_STEP", speeds.per_step, "inverse distance of two")
            + define("FACTOR_TEMPERATURES", temperatures.count, "places of 1/(T - COLDEST)")
            + define("FACTOR_COLD", temperatures.start, "the first one")
            + define("FACTOR_COLD_STEP", temperatures.per_step, "inverse distance of two")
            + define("FACTOR_LOADS", loads.count, "places of ln of the load")
            + define("FACTOR_LOG_LOAD", loads.start, "the first one")
            + define("FACTOR_LOAD_STEP", loads.per_step, "inverse distance of two"),
            "/* Factors of the closed formula of the locked film. */\n"
            f"static const double FACTORS[FACTOR_SPEEDS][FACTOR_TEMPERATURES][FACTOR_LOADS] = {{\n{rows}}};\n",
        )
    )


def _places(table: ApproachTable) -> int:
    """Number of coefficients over the approach."""
    return int(table.coefficients.shape[2]) // 2


def _table(name: str, table: ApproachTable, words: str) -> str:
    """A table with its axes."""
    speeds, temperatures, _ = table.coefficients.shape
    sizes = f"{speeds} speeds, {temperatures} temperatures, {_places(table)} places"
    axes = ", ".join(number(value) for value in table[2:])
    return "\n".join(
        (
            f"/* Coefficients of {words}, over {sizes}. */",
            array(f"{name}_COEFFICIENTS", table.coefficients),
            f"/* Offset and inverse scale of {words}. */",
            array(f"{name}_PLACE", table.place),
            f"static const axes {name} = {{\n    {speeds}, {temperatures}, {_places(table)}, {axes},\n"
            f"    {name}_COEFFICIENTS, {name}_PLACE}};\n",
        )
    )
