"""Points of a ball bearing, and ball bearings of a machine: what `mbs.output.one_bearing.kind` asks of balls."""

from __future__ import annotations

import math

import numpy as np

from ehdmaps.physics.hertz import POINT_LIMIT
from ehdmaps.physics.point.ball_geometry import BallGeometry
from ehdmaps.units import PRESSURE, RPM, SPEED, TEMPERATURE, Display
from mbs.bearings.balls.ball_findings import ball_pressures
from mbs.bearings.balls.ball_motion import ball_motion
from mbs.bearings.balls.ball_point import BallPoint
from mbs.bearings.locating.locating_force import Settled
from mbs.output.one_bearing.kind import (
    CONTACT_SIDES,
    Column,
    Description,
    Kind,
    Number,
    Pair,
    Row,
    columns_of,
    no_dust,
    numbers_of,
    tilting,
)
from mbs.output.state_text import beside_class
from mbs.scene.fields import DEGREE, FORCE, MICROMETRE

_ERRORS = (
    ("film_offset_error", "largest stated error of the film offset"),
    ("central_film_error", "largest stated error of the central film"),
    ("minimum_film_error", "largest stated error of the smallest film"),
    ("damping_error", "largest stated error of the damping"),
)
_PERCENT = Display("%", 100.0)
_SPIN = Display("rad/s")


def _error(place: int) -> Number:
    """A stated error."""
    name, words = _ERRORS[place]
    return Number(name, "1", words, lambda point, _: point.film_errors[:, place])


def _largest(point: BallPoint, name: str) -> list[float]:
    """Largest slip or spin of the loaded contacts, inner and outer."""
    values = np.where(point.elements.load > 0.0, np.abs(getattr(point.motion, name)), 0.0)
    return [float(side.max()) for side in values]


_TRACTION = "largest traction that holds a gyroscopic moment, over the load at its raceway"
_CONTROL = "Harris' criterion, Q_o a_o E_o cos(a_i - a_o) over Q_i a_i E_i: outer race control above 1"
_SPEEDS = (
    Number("cage_speed", "rad/s", "speed of the cage, mean of the balls by their loads"),
    Number("centrifugal_load", "N", "largest centrifugal load of a ball"),
    Number("gyroscopic_traction", "1", _TRACTION),
    Number("race_control", "1", _CONTROL),
)
_SPIN_WORDS = "largest drilling of the ring against a ball, about the normal"
_SIDES = (
    *CONTACT_SIDES,
    Number(
        "contact_angle", "rad", "mean contact angle, by the loads", lambda p, _: [*map(p.elements.mean_angle, (0, 1))]
    ),
    Number("contact_speed", "m/s", "entrainment speed, mean by the loads", lambda p, _: p.motion.mean(p.elements)),
    Number("slip", "m/s", "largest slip of the ring against a ball in the middle", lambda p, _: _largest(p, "slip")),
    Number("spin", "rad/s", _SPIN_WORDS, lambda p, _: _largest(p, "spin")),
    *map(_error, range(len(_ERRORS))),
)
_SLIP = "speed of the ring less that of the ball in the middle of the contact"
_DRILLING = "drilling of the ring less that of the ball, about the normal"
_AROUND = "speed of the ball around the axis of the bearing"
_BOTH = ("contact", "ball")
_EACH = (
    Number("ball_load", "N", "load of the contact of the ball", lambda p, _: p.elements.load, _BOTH),
    Number("ball_contact_angle", "rad", "contact angle of the ball", lambda p, _: p.elements.contact_angle, _BOTH),
    Number("ball_slip", "m/s", _SLIP, lambda p, _: p.motion.slip, _BOTH),
    Number("ball_spin", "rad/s", _DRILLING, lambda p, _: p.motion.spin, _BOTH),
    Number("ball_speed", "rad/s", _AROUND, lambda p, _: p.elements.speed, ("ball",)),
)


def _angles(row: Row) -> str:
    """Both mean contact angles."""
    return " ".join(f"{no_dust(DEGREE.value(angle)):6.1f}" for angle in row["contact_angle"])


def preload_words(geometry: BallGeometry) -> str:
    """Preload of rows that press each other, in words; empty for others."""
    if not geometry.axial_play:
        return ""
    from ehdmaps.physics.point.row_catalogue import preload_of  # with what few bearings need

    force = preload_of(geometry)
    return f"; preload {FORCE.text(force)} at rest, centred" if force > 0.0 else "; no preload"


def _about(description: Description, point: BallPoint) -> list[str]:
    """Lines on the geometry and the load."""
    geometry = point.force.geometry
    play = "axial clearance" if geometry.axial_play else "clearance"
    record = geometry.record()
    materials = [f"{part}s of {record[key]}" for part in ("ball", "ring") if (key := f"{part}_material") in record]
    return [
        f"{geometry.balls} balls of {1e3 * geometry.ball_diameter:.4g} mm on {1e3 * geometry.pitch_diameter:.4g} mm, "
        f"grooves {geometry.inner_conformity:.4g} and {geometry.outer_conformity:.4g}, contact angle "
        f"{DEGREE.value(geometry.contact_angle):.4g} deg"
        + f", {play} {MICROMETRE.text(geometry.clearance)}{beside_class(geometry)}"
        * geometry.has_clearance,
        *([geometry.row_words + preload_words(geometry)] if geometry.row_words else []),
        *(["; ".join(materials)] if materials else []),
        f"{TEMPERATURE.text(description.temperature)}, {tilting(description, 'ball')}",
    ]


_CONTACTS = (
    Pair("mean contact angle", DEGREE, "contact_angle"),
    Pair("entrainment speed", SPEED, "contact_speed"),
    Pair("slip in the middle", SPEED, "slip"),
    Pair("spin of the ring on the ball", _SPIN, "spin"),
)
_STATED = (
    Pair("stated error of film offset", _PERCENT, "film_offset_error"),
    Pair("stated error of smallest film", _PERCENT, "minimum_film_error"),
    Pair("stated error of contact damping", _PERCENT, "damping_error"),
)


def _closing(point: BallPoint, _: Row) -> list[str]:
    """A line on the cage and the balls."""
    return [
        f"cage {RPM.text(point.cage_speed)}, centrifugal load of a ball up to {FORCE.text(point.centrifugal_load)}, "
        f"gyroscopic traction up to {point.gyroscopic_traction:.2g} of the load at a raceway",
        f"balls turn by {point.force.geometry.hypothesis}; Harris' criterion {point.race_control:.3g} (outer race "
        "control above 1, inner below)",
    ]


def _of_one(point: BallPoint, index: int) -> str:
    """Loads, contact angles and pressures of a ball."""
    (inner, outer), angles = point.elements.load[:, index], point.elements.contact_angle[:, index]
    first, second = (no_dust(DEGREE.value(float(angle))) for angle in angles)
    pressures = 1e-9 * point.pressure[:, index]
    return f"{inner:9.5g} {outer:9.5g} {first:11.4g} {second:9.4g} {pressures[0]:11.3g} {pressures[1]:9.3g}"


BALLS = Kind(
    element="ball",
    words="ball bearing",
    static_limit=POINT_LIMIT,
    axial=True,
    numbers=numbers_of(_SPEEDS, axial=True),
    sides=_SIDES,
    each=_EACH,
    columns=columns_of("ball", [Column("angles", "deg", 13, _angles)], [], axial=True),
    about=_about,
    closing=_closing,
    heads=(
        f"{'load, N':>19s} {'contact angle, deg':>21s} {'Hertz pressure, GPa':>21s}",
        f"{'inner':>9s} {'outer':>9s} {'inner':>11s} {'outer':>9s} {'inner':>11s} {'outer':>9s}",
    ),
    of_one=_of_one,
    pairs=lambda point: (_CONTACTS, _STATED if np.any(np.isfinite(point.film_errors)) else ()),
)
"""Ball bearings."""


def _moving(at: Settled) -> list[str]:
    """A line on the speeds of balls that roll; none at rest."""
    inner, outer = at.conditions["inner_speed"], at.conditions["outer_speed"]
    if inner == outer:
        return []
    motion, carries = ball_motion(at.force, at.loads, inner, outer), at.loads.load > 0.0
    slip, spin = (np.where(carries, np.abs(values), 0.0).max(axis=1) for values in (motion.slip, motion.spin))
    return [
        f"  cage {RPM.text(at.loads.cage_speed)}; slip up to {no_dust(slip[0]):.3g} m/s inner, {no_dust(slip[1]):.3g} "
        f"outer; spin up to {no_dust(spin[0]):.4g} rad/s inner, {no_dust(spin[1]):.4g} outer; gyroscopic traction up "
        f"to {at.loads.gyroscopic_traction:.2g} of the load"
    ]


def ball_words(at: Settled) -> tuple[str, list[str]]:
    """Contact angles of a ball bearing of a machine, and lines on the loads, pressures and speeds of its balls.

    Parameters
    ----------
    at : Settled
        The bearing at rest.
    """
    loads = at.loads.load
    angles = [math.degrees(at.loads.mean_angle(side)) for side in (0, 1)]
    pressures = ball_pressures(at.force, at.loads).max(axis=1)
    return f"contact angle {angles[0]:.4g} deg inner, {angles[1]:.4g} outer", [
        f"  {at.loads.loaded} of {loads.shape[1]} balls loaded, {loads[0].min():.4g} to "
        f"{loads[0].max():.5g} N at the inner raceway; Hertz pressure up to {PRESSURE.value(pressures[0]):.4g} "
        f"inner, {PRESSURE.text(pressures[1])} outer",
        *_moving(at),
    ]
