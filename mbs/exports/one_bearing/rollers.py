"""Tapered rollers, and cylindrical ones between ribs, as C sources and units: what differs of them."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Sequence

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.exports.c.text import array, define, number
from mbs.bearings.tapered.kernel_structs import RIB_NUMBERS, rib_rows
from mbs.bearings.tapered.tapered_bearing import TaperedForce
from mbs.exports.one_bearing.kind import ExportKind

_KERNEL = (
    "elementary.h", "taper/taper.h", "taper/taper_lines.c", "taper/taper_balance.c", "taper/taper_bearing.c",
)  # fmt: skip


def _dry_approach(force: TaperedForce) -> Callable[[float], float]:
    """Approach of a dry line by its load."""
    return lambda load: float((load / force.dry_law.inner.coefficient) ** 0.9)


def _public(force: TaperedForce, play: float = 0.0) -> str:
    """Constants that callers may read."""
    geometry = force.geometry
    inner, outer = geometry.cage_speed(1.0, 0.0), geometry.cage_speed(0.0, 1.0)
    return "".join(
        (
            define("EHD_ROLLERS", geometry.rolling_elements, "number of rollers"),
            define("EHD_ROW_ROLLERS", geometry.rollers, "number of rollers of a row"),
            define("EHD_ROLLER_DIAMETER", geometry.roller_diameter, "in the middle [m]"),
            define("EHD_ROLLER_LENGTH", geometry.roller_length, "[m]"),
            define("EHD_PITCH_DIAMETER", geometry.pitch_diameter, "[m]"),
            define("EHD_CONTACT_ANGLE", geometry.contact_angle, "of the cup; 0 of cylindrical rollers [rad]"),
            define("EHD_PLAY", play, "see ehd_bearing_make [m]"),
            define("EHD_SLICES", int(force.positions.size), "of a roller"),
            define("EHD_RIBS", len(force.ribs), "that a roller may lean on"),
            define("EHD_CAGE_INNER", inner, "turns of the cage for each of the inner ring"),
            define("EHD_CAGE_OUTER", outer, "turns of the cage for each of the outer ring"),
            define("EHD_ENTRAINMENT", geometry.entrainment_speed(1.0), "entrainment speed [m/rad], see below"),
        )
    )


def _private(force: TaperedForce) -> str:
    """Constants that only the functions read."""
    geometry = force.geometry
    along, across = geometry.roller_inertia(force.material)
    return "\n".join(
        [
            define("TAPERED", int(geometry.contact_angle > 0.0), "0: cylindrical rollers")
            + define("CENTRIFUGAL", force.speed_loads(0.0, cage_speed=1.0)[0], "load at 1 rad/s of the cage [kg m]")
            + define("ROLLER_SPEED", geometry.roller_speed(1.0), "about its axis against the cage, by the rings'"),
            _row("INERTIA", (along, across), "along and across a roller [kg m2]")
            + _row("AXIS", (math.cos(geometry.axis_angle), math.sin(geometry.axis_angle)), "of a roller"),
            _data(force),
        ]
    )


def _data(force: TaperedForce) -> str:
    """The bearing as the kernel reads it, but for what `ehd_bearing_make` writes."""
    shape, line = force.shape, force.dry_law.inner
    ribs = rib_rows(shape.ribs) if force.ribs else np.zeros((1, RIB_NUMBERS))
    pairs = "}, {".join(", ".join(map(number, pair)) for pair in (shape.cup, shape.cone))
    play = force.geometry.raceway_play
    rows = ", ".join(number(one) for one in (shape.rows[0], shape.rows[-1]))
    sizes = f"EHD_ROLLERS, EHD_SLICES, EHD_RIBS, EHD_ROW_ROLLERS, {{{rows}}}, {number(shape.pitch_radius)}"
    dampers = line.damping, line.damping_time
    numbers = map(number, (play, shape.most_travel, shape.most_tilt, 2.0 * line.coefficient, *dampers))
    return (
        _row("LEVER", shape.levers, "of the normals in slices [m]")
        + _row("PROFILE", shape.profile - play, "depth of slices at either raceway [m]")
        + "/* Of each rib normal, lever, play, coefficient, and 1 on the outer ring. */\n"
        + array("RIB", ribs)
        + f"static const ehd_taper_data DATA = {{\n    {sizes},\n    {{{pairs}}},\n    {', '.join(numbers)},\n"
        + "    RIB, LEVER, PROFILE, NULL, NULL, NULL, NULL};\n"
    )


def _row(name: str, values: Sequence[float] | FloatArray, words: str) -> str:
    """Some constants in a row."""
    numbers = ", ".join(number(float(value)) for value in values)
    return f"/* {words[:1].upper()}{words[1:]}. */\nstatic const double {name}[{len(values)}] = {{{numbers}}};\n"


TAPERED = ExportKind(
    words="tapered bearing",
    title=lambda geometry: f"Tapered roller bearing {geometry.title}",
    element="roller",
    files="tapered",
    kernel=_KERNEL,
    film_kernel=("taper/taper_films.c",),
    mirrored=lambda geometry: geometry.contact_angle < 0.0,
    public=_public,
    private=_private,
    play=lambda geometry: 0.0,
    motion=(
        "x is the axis of the bearing; the frame is that of the outer ring, in the plane of the middles of the "
        "rollers, and does not spin. There is no moment about x. In the pose zero tapered rollers just touch and "
        "cylindrical ones are in the middle of their play; tapered rollers and NJ carry an axial force on the inner "
        "ring in +x, mirrored ones in -x. Inputs start at rest under the load of the export.",
        "pose, velocity and force are those of the inner ring, right-handed. The derivatives of the outputs by the "
        "pose are -K, by the velocity -C, at speeds that are held; those by the others are quotients of differences.",
        "The rollers stand where the spins bring them, with a cage in pure rolling; the first one stands on the y axis "
        "at spins of zero. Each is in balance at once between raceways and ribs, with its centrifugal load and "
        "gyroscopic moment.",
    ),
    slow="Films follow at once: there are no states.",
    memory=(
        "Films need time to follow: each slice of both raceways has a spring in series with a damper, which begin at "
        "rest"
    ),
    own_words={"axial_offset": "Way of the inner ring along x against the outer one in the pose zero, which preloads"},
    play_name="axial_offset",
    dry_approach=_dry_approach,
    step=0.1,  # half that of balls, as damping of lines bends sharply over the load
    of_largest=True,
)
"""Tapered rollers."""

RIBBED = dataclasses.replace(
    TAPERED,
    words="ribbed bearing",
    title=lambda geometry: f"Cylindrical roller bearing {geometry.title}",
    mirrored=lambda geometry: geometry.carries == "-x",
    public=lambda force: _public(force, force.geometry.diametral_clearance),
    play=lambda geometry: geometry.diametral_clearance,
    play_name="clearance",
)
"""Cylindrical rollers between ribs: NJ and NUP."""
