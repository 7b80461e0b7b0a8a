"""A bearing of tapered rollers, or of cylindrical ones between ribs, in C: the kernel that Python calls, numbers."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import InputError
from ehdmaps.exports.c.text import array, define, number, template
from ehdmaps.physics.rollers.ribbed_geometry import RibbedGeometry
from mbs.bearings.balls.film_tables import PairLaw
from mbs.bearings.balls.normal_law import NormalLaw, empty_table
from mbs.bearings.tapered.kernel_structs import RIB_NUMBERS, rib_rows
from mbs.bearings.tapered.tapered_bearing import TaperedForce
from mbs.bearings.tapered.tapered_shape import RollerLaws
from mbs.exports.balls.source import header_of, joined, pair_files, prefix_of, private_law, public_law, write_texts
from mbs.exports.balls.speed_laws import SpeedLaws, dry_speed_laws, film_speed_laws

STEP = 0.1
"""Largest distance of two speeds in ln u: half that of balls, as damping of lines bends sharply over the load."""

_BODY, _FILMS = "tapered_bearing", "tapered_films"
_KERNEL = (
    "elementary.h", "taper/taper.h", "taper/taper_lines.c", "taper/taper_balance.c", "taper/taper_bearing.c",
)  # fmt: skip
_SHORTER = (1.0,)
"""Times of the springs of a film over the longest one: there is one."""


def line_speed_laws(
    force: TaperedForce,
    films: Callable[[float], PairLaw] | None = None,
    speeds: tuple[float, float] = (0.0, 0.0),
    *,
    memory: bool = False,
) -> SpeedLaws:
    """Laws of both lines over the speed.

    Parameters
    ----------
    force : TaperedForce
        The bearing, dry.
    films : callable, optional
        Law with the films of an entrainment speed [m/s]; dry lines if left out.
    speeds : (float, float)
        Lowest and highest of these speeds [m/s], > 0.
    memory : bool
        Whether films have a memory.

    Raises
    ------
    InputError
        If a speed has no films.
    """
    laws = force.laws
    if films is not None:
        shorter = _SHORTER if memory else ()
        return film_speed_laws(
            films, *speeds, shorter=shorter, dry=lambda load: float((load / laws.cone) ** 0.9), step=STEP
        )
    inner, outer = (
        NormalLaw(c, laws.damping, laws.damping_time, 0.0, 1.0, 0.0, 1.0, 0.0, 0.0, 0.0, empty_table())
        for c in (laws.cone, laws.cup)
    )
    return dry_speed_laws(inner, outer)


def write_source(path: str | Path, force: TaperedForce, laws: SpeedLaws, header: Sequence[str]) -> str:
    """Write source and header, and return what was written in words.

    Parameters
    ----------
    path : str or Path
        File of the source; the header goes beside it.
    force : TaperedForce
        The bearing, dry.
    laws : SpeedLaws
        Laws of both lines, of `line_speed_laws`.
    header : sequence of str
        Lines that say where it comes from.

    Raises
    ------
    InputError
        If a file may not be replaced or cannot be written.
    """
    prefix = prefix_of(path, "roller")
    return write_texts(path, source_texts(force, laws, header, prefix, header_of(path).name), prefix)


def source_texts(
    force: TaperedForce, laws: SpeedLaws, header: Sequence[str], prefix: str = "ehd", include: str = "bearing.h"
) -> dict[str, str]:
    """Texts of the header, `h`, and of the source, `c`.

    Parameters
    ----------
    force : TaperedForce
        The bearing, dry.
    laws : SpeedLaws
        Laws of both lines.
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
    geometry = force.geometry
    if geometry.contact_angle < 0.0 or (isinstance(geometry, RibbedGeometry) and geometry.carries == "-x"):
        raise InputError(
            f"export of a {geometry.kind}: got one that carries along -x; allowed: along +x; the source mirrors it"
        )
    numbers = _public_numbers(force, laws), _private_numbers(force, laws)
    memory = [_FILMS] if laws.memory else []
    kernel = (*pair_files(laws), *_KERNEL, *(["taper/taper_films.c"] if laws.memory else []))
    headers, bodies = ([template("mbs.exports.tapered", f"{name}.{end}") for name in (_BODY, *memory)] for end in "hc")
    return joined(header, numbers, kernel, headers, bodies, prefix, include)


def exported_play(force: TaperedForce) -> float:
    """Play in the sense of `ehd_bearing_make` [m]: diametral clearance between ribs; no axial offset of tapered ones.

    Parameters
    ----------
    force : TaperedForce
        The bearing.
    """
    return force.geometry.diametral_clearance if isinstance(force.geometry, RibbedGeometry) else 0.0


def _public_numbers(force: TaperedForce, laws: SpeedLaws) -> str:
    """Constants that callers may read."""
    geometry = force.geometry
    inner, outer = geometry.cage_speed(1.0, 0.0), geometry.cage_speed(0.0, 1.0)
    return "".join(
        (
            define("EHD_ROLLERS", geometry.rollers, "number of rollers"),
            define("EHD_ROLLER_DIAMETER", geometry.roller_diameter, "in the middle [m]"),
            define("EHD_ROLLER_LENGTH", geometry.roller_length, "[m]"),
            define("EHD_PITCH_DIAMETER", geometry.pitch_diameter, "[m]"),
            define("EHD_CONTACT_ANGLE", geometry.contact_angle, "of the cup; 0 of cylindrical rollers [rad]"),
            define("EHD_PLAY", exported_play(force), "see ehd_bearing_make [m]"),
            define("EHD_SLICES", int(force.positions.size), "of a roller"),
            define("EHD_RIBS", len(force.ribs), "that a roller may lean on"),
            define("EHD_CAGE_INNER", inner, "turns of the cage for each of the inner ring"),
            define("EHD_CAGE_OUTER", outer, "turns of the cage for each of the outer ring"),
            define("EHD_ENTRAINMENT", geometry.entrainment_speed(1.0), "entrainment speed [m/rad], see below"),
            public_law(laws),
        )
    )


def _private_numbers(force: TaperedForce, laws: SpeedLaws) -> str:
    """Constants that only the functions read."""
    geometry, dry = force.geometry, force.laws
    along, across = geometry.roller_inertia(force.material)
    return "\n".join(
        [
            define("TAPERED", int(geometry.contact_angle > 0.0), "0: cylindrical rollers")
            + define("CENTRIFUGAL", force.speed_loads(0.0, cage_speed=1.0)[0], "load at 1 rad/s of the cage [kg m]")
            + define("ROLLER_SPEED", geometry.roller_speed(1.0), "about its axis against the cage, by the rings'"),
            _row("INERTIA", (along, across), "along and across a roller [kg m2]")
            + _row("AXIS", (math.cos(geometry.axis_angle), math.sin(geometry.axis_angle)), "of a roller"),
            _data(force, dry),
            private_law(laws),
        ]
    )


def _data(force: TaperedForce, dry: RollerLaws) -> str:
    """The bearing as the kernel reads it, but for what `ehd_bearing_make` writes."""
    shape = force.shape
    ribs = rib_rows(shape.ribs) if force.ribs else np.zeros((1, RIB_NUMBERS))
    pairs = "}, {".join(", ".join(map(number, pair)) for pair in (shape.cup, shape.cone))
    play = force.geometry.raceway_play
    sizes = f"EHD_ROLLERS, EHD_SLICES, EHD_RIBS, {number(shape.pitch_radius)}"
    numbers = map(number, (play, shape.most_travel, shape.most_tilt, dry.cup + dry.cone, dry.damping, dry.damping_time))
    return (
        _row("LEVER", shape.levers, "of the normals in slices [m]")
        + _row("PROFILE", shape.profile - play, "depth of slices at either raceway [m]")
        + "/* Of each rib normal, lever, play, coefficient, and 1 on the outer ring. */\n"
        + array("RIB", ribs)
        + f"static const ehd_taper_data DATA = {{\n    {sizes},\n    {{{pairs}}},\n    {', '.join(numbers)},\n"
        + "    RIB, LEVER, PROFILE, NULL, NULL};\n"
    )


def _row(name: str, values: Sequence[float] | FloatArray, words: str) -> str:
    """Some constants in a row."""
    numbers = ", ".join(number(float(value)) for value in values)
    return f"/* {words[:1].upper()}{words[1:]}. */\nstatic const double {name}[{len(values)}] = {{{numbers}}};\n"
