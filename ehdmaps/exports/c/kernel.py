"""A contact law and a bearing in C: templates, in which the law's mathematics is, and the numbers of one map.

Locked film of a map, as a table over speed, temperature and load for programs without the map.

`ContactLaw.locked_factors` reads the responses of the films in the map. An export has its factors at places that are
even in ln u, 1/(T - `COLDEST`) and ln of the load, and goes straight between them.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import InputError, Problems
from ehdmaps.exports.c.deviations import deviation_texts
from ehdmaps.exports.c.text import array, comment, define, number, renamed, template
from ehdmaps.maps.emap import EHDMap
from ehdmaps.maps.kernels import locked_film
from ehdmaps.maps.kernels.locked_film import FORMULA, LockedFactors
from ehdmaps.maps.kernels.tables import COLDEST, HALF_SPACE, ApproachTable, LawTable
from ehdmaps.maps.law import ContactLaw, LawKind, OutsidePolicy
from ehdmaps.physics.bearing import BearingGeometry

SPEED_STEP, LOAD_STEP = 0.25, 0.1
"""Largest steps of ln u and of ln of the load. With them a quick change of load of the shipped map's law is right
within 1e-3, where the law itself is right within some 5 %."""

TEMPERATURES = 11
"""Places of the temperature, where a map has more than one."""

_DIGITS = 6
_STANDSTILL = 1e-300


@dataclass(frozen=True)
class Axis:
    """Even places.

    Attributes
    ----------
    start : float
        The first one.
    per_step : float
        Inverse distance of two; 0 where there is one.
    count : int
        How many.
    """

    start: float
    per_step: float
    count: int

    @classmethod
    def over(cls, first: float, last: float, count: int) -> Axis:
        """Places from one to another; one place where they are alike.

        Parameters
        ----------
        first, last : float
            The ends.
        count : int
            How many, if the ends differ.
        """
        return cls(first, (count - 1) / (last - first), count) if last != first else cls(first, 0.0, 1)

    @property
    def places(self) -> FloatArray:
        """All places, shape (count,)."""
        return self.start + np.arange(self.count) / (self.per_step or 1.0)

    def between(self, place: float) -> tuple[int, int, float]:
        """Neighbours of a place, which is held at the ends, and the weight of the second one.

        Parameters
        ----------
        place : float
            The place on the axis.
        """
        held = min(max((place - self.start) * self.per_step, 0.0), self.count - 1.0)
        first = min(int(held), max(self.count - 2, 0))
        return first, min(first + 1, self.count - 1), held - first


@dataclass(frozen=True, eq=False)
class LockedTable:
    """Factors of the closed formula of the locked film.

    Attributes
    ----------
    speeds, temperatures, loads : Axis
        Places of ln u, of 1/(T - `COLDEST`) and of ln of the load [N/m].
    factors : array (n_u, n_T, n_w)
        The factors there.
    """

    speeds: Axis
    temperatures: Axis
    loads: Axis
    factors: FloatArray

    def at(self, entrainment_speed: float, temperature: float) -> LockedFactors:
        """Factors over the load at a speed and temperature, as the export has them.

        Parameters
        ----------
        entrainment_speed, temperature : float
            u [m/s], of either sign, and T [K]; held at the ends of the table.
        """
        i, up, a = self.speeds.between(math.log(max(abs(entrainment_speed), _STANDSTILL)))
        j, on, b = self.temperatures.between(1.0 / (temperature - COLDEST))
        low, high = (self.factors[k, j] + b * (self.factors[k, on] - self.factors[k, j]) for k in (i, up))
        values = low + a * (high - low)
        return LockedFactors(self.loads.start, self.loads.per_step, values if values.size > 1 else np.repeat(values, 2))


def locked_table(law: ContactLaw) -> LockedTable:
    """Table of the factors of a law, over the speeds and temperatures of its map.

    Parameters
    ----------
    law : ContactLaw
        The law.
    """
    (slow, fast), (cold, hot) = law.speed_range, law.temperature_range
    begin, end = (math.log(u) if u > 0.0 else 0.0 for u in (slow, fast))
    speeds = Axis.over(begin, end, 2 + math.ceil((end - begin) / SPEED_STEP))
    temperatures = Axis.over(1.0 / (cold - COLDEST), 1.0 / (hot - COLDEST), TEMPERATURES)
    known = [
        [law.locked_factors(float(u), float(T)) for T in 1.0 / temperatures.places + COLDEST]
        for u in np.exp(speeds.places)
    ]
    if any(factors is FORMULA for line in known for factors in line):
        return LockedTable(Axis(begin, 0.0, 1), Axis(temperatures.start, 0.0, 1), Axis(0.0, 0.0, 1), np.ones((1, 1, 1)))
    lowest, highest = min(factors.lowest for line in known for factors in line), math.log(law.load_range[1])
    loads = Axis.over(lowest, highest, 2 + math.ceil((highest - lowest) / LOAD_STEP))
    table = np.array([[np.interp(loads.places, _loads(factors), factors.values) for factors in line] for line in known])
    # with fewer digits: a file of them is a third as long
    rounded = np.array([float(f"{value:.{_DIGITS}g}") for value in table.reshape(-1).tolist()]).reshape(table.shape)
    return LockedTable(speeds, temperatures, loads, rounded)


def _loads(factors: LockedFactors) -> FloatArray:
    """Places of factors in ln of the load."""
    return np.asarray(factors.lowest + np.arange(factors.values.size) / factors.per_log)


ProfileName = Literal["iso", "straight"]

_MOST_SLICES = 201
_NAME = re.compile(r"[a-z][a-z0-9_]*")
_ALL, _WRONG = 127, 127 - (1 + 2 + 4)
"""All parts of a status of `law.h`, and those that are no matter of the range of the map."""

_LAW_NUMBERS = (
    "film_speed", "lowest_speed", "highest_speed", "lowest_temperature", "highest_temperature",
    "highest_load", "known_load", "held_load", "counted_speed", "counted_cold", "counted_hot",
)  # fmt: skip
"""Numbers of `ehdmaps.maps.kernels.tables.LawTable` that the law has in C by the same names."""

_TABLES = {"own": "the law", "inner": "the inner contact", "outer": "the outer contact"}


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
        problems = Problems()
        if not _NAME.fullmatch(self.prefix):
            problems.append(
                f"export c, prefix: got {self.prefix!r}; allowed: lower-case letters, digits and _, a letter first"
            )
        if not 1 <= self.slices <= _MOST_SLICES:
            problems.append(f"export c, slices: got {self.slices!r}; allowed: 1 to {_MOST_SLICES}")
        if self.clearance is not None and not math.isfinite(self.clearance):
            problems.append(f"export c, clearance: got {self.clearance!r}; allowed: a finite number of metres")
        problems.check()


def kernel_files(
    emap: EHDMap, options: KernelOptions, header: Sequence[str], deviations: Any | None = None
) -> dict[str, str]:
    """Names and texts of the files of an export.

    Parameters
    ----------
    emap : EHDMap
        The map.
    options : KernelOptions
        What is exported of it.
    header : sequence of str
        Lines that say where it comes from, put first.
    deviations : record or None
        Deviations of the bearing from its form, see `ehdmaps.exports.c.deviations`.

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
    heads, bodies = ["status", "law/law", "film/film"], ["status", "law/law", "law/cells", "film/film"]
    facades = ["law_facade"]
    if bearing is not None:
        parts = [f"cylinder/{part}" for part in ("cylinder_law", "cylinder", "cylinder_films")]
        heads, bodies = heads + parts, [*bodies, "law/law_block", *parts]
        facades += ["bearing_facade"]
    guard, (own_head, own_body) = "EHD_H", deviation_texts(deviations)
    top = [
        banner, f"#ifndef {guard}\n#define {guard}\n\n#include <stddef.h>\n#include <stdint.h>\n",
        _public_numbers(law, bearing, options),
        '#ifdef __cplusplus\nextern "C" {\n#endif\n',
        *(template("ehdmaps.kernel", f"c/{part}.h") for part in heads),
        *(_template(f"{part}.h") for part in facades),
        own_head,
        f"#ifdef __cplusplus\n}}\n#endif\n\n#endif /* {guard} */\n",
    ]  # fmt: skip
    source = [
        banner, '#include "ehd.h"\n',
        template("ehdmaps.kernel", "c/numbers.h"),
        template("ehdmaps.kernel", "c/elementary.h"),
        *(template("ehdmaps.kernel", f"c/{part}.c") for part in bodies),
        _law_data(law, options.centrifugal),
        _film_data(law),
        "" if bearing is None else _bearing_data(bearing),
        *(_template(f"{part}.c") for part in facades),
        own_body,
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
            define("EHD_ROLLERS", bearing.rolling_elements, f"number of rollers{bearing.row_words}"),
            define("EHD_ROLLER_LENGTH", bearing.roller_length, "[m]"),
            define("EHD_ROLLER_DIAMETER", bearing.roller_diameter, "[m]"),
            define("EHD_ISO_PROFILE", int(options.profile == "iso"), "1: profile of ISO/TS 16281, 0: straight"),
            define("EHD_CLEARANCE", clearance, "diametral clearance of the export [m]"),
            define("EHD_SLICES", options.slices, "slices of a roller of the export"),
            define("EHD_CAGE_INNER", 0.5 * (1.0 - bearing.gamma), "turns of the cage for each of the inner ring"),
            define("EHD_CAGE_OUTER", 0.5 * (1.0 + bearing.gamma), "turns of the cage for each of the outer ring"),
            define("EHD_ENTRAINMENT", bearing.entrainment_speed(1.0, 0.0), "entrainment speed [m/rad], see below"),
        ]
    return "".join(lines)


def _law_data(law: ContactLaw, centrifugal: bool) -> str:
    """Numbers and tables of the law."""
    table: LawTable = law.table if centrifugal else law.plain_table
    tables = {"own": table.own, "inner": table.inner, "outer": table.outer}
    if not centrifugal:
        del tables["inner"], tables["outer"]
    rows = [value for kind, a, b in table.structure.tolist() for value in (float(kind == HALF_SPACE), a, b)]
    fields = {
        "refused": "EHD_REFUSED",
        "contacts": "EHD_CONTACTS",
        "centrifugal": "EHD_HAS_CENTRIFUGAL",
        **{name: number(getattr(table, name)) for name in _LAW_NUMBERS},
        "structure": "STRUCTURE",
        "end_rows": str(table.ends.shape[0]),
        "end_columns": str(table.ends.shape[1]),
        "ends": "ENDS",
    }
    return "\n".join(
        (
            *(_coefficients(name, part) for name, part in tables.items()),
            "/* Laws of the contacts without films: kind, and two numbers. */",
            array("STRUCTURE", np.array(rows)),
            "/* Loads up to which films are mapped [N/m], over ln u and T. */",
            array("ENDS", table.ends),
            _data("ehd_law_data", "LAW", fields | {name: _axes(name, part) for name, part in tables.items()}),
        )
    )


def _film_data(law: ContactLaw) -> str:
    """Numbers and the table of films with memory."""
    table, film = locked_table(law), locked_film.film_of(law.contacts, 0.0)
    fields = {
        "law": "&LAW",
        "contacts": f"{{{film.contacts}, {number(film.radius)}, {number(film.modulus)}}}",
        "lowest_speed": "EHD_LOWEST_SPEED",
    }
    for axis, places, name in (
        ("speeds", table.speeds, "log_speed"),
        ("temperatures", table.temperatures, "temperature"),
        ("loads", table.loads, "log_load"),
    ):
        fields[axis] = str(places.count)
        fields[f"{name}_start"], fields[f"{name}_step"] = number(places.start), number(places.per_step)
    return "\n".join(
        (
            "/* Factors of the closed formula of the locked film. */",
            array("FACTORS", table.factors),
            _data("ehd_film_data", "FILMS_WITH_MEMORY", fields | {"factors": "FACTORS"}),
        )
    )


def _bearing_data(bearing: BearingGeometry) -> str:
    """Directions of the rollers, and places of their rows."""
    angles = np.tile(2.0 * math.pi * np.arange(bearing.rollers) / bearing.rollers, bearing.row_count)
    return "\n".join(
        (
            "/* Directions of the rollers in the cage. */",
            array("COSINES", np.cos(angles)),
            array("SINES", np.sin(angles)),
            "/* Places of their rows along x [m]. */",
            array("ROW_PLACES", np.repeat(np.array(bearing.row_places), bearing.rollers)),
        )
    )


def _data(kind: str, name: str, fields: Mapping[str, str]) -> str:
    """A structure with its fields."""
    lines = "".join(f"    .{field} = {value},\n" for field, value in fields.items())
    return f"static const {kind} {name} = {{\n{lines}}};\n"


def _places(table: ApproachTable) -> int:
    """Number of coefficients over the approach."""
    return int(table.coefficients.shape[2]) // 2


def _coefficients(name: str, table: ApproachTable) -> str:
    """Arrays of a table."""
    speeds, temperatures, _ = table.coefficients.shape
    sizes = f"{speeds} speeds, {temperatures} temperatures, {_places(table)} places"
    return "\n".join(
        (
            f"/* Coefficients of {_TABLES[name]}, over {sizes}. */",
            array(f"{name.upper()}_COEFFICIENTS", table.coefficients),
            f"/* Offset and inverse scale of {_TABLES[name]}. */",
            array(f"{name.upper()}_PLACE", table.place),
        )
    )


def _axes(name: str, table: ApproachTable) -> str:
    """A table as a field of the law's data."""
    speeds, temperatures, _ = table.coefficients.shape
    axes = ", ".join(number(value) for value in table[2:])
    return (
        f"{{{speeds}, {temperatures}, {_places(table)}, {axes},\n"
        f"            {name.upper()}_COEFFICIENTS, {name.upper()}_PLACE}}"
    )
