"""Files of a ball bearing for other programs, by their endings: linear programs, C, Functional Mock-up Units."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from ehdmaps.exports.target import BEARING_AXES
from ehdmaps.outputs import MARK, Kind, Output, write_text
from ehdmaps.units import RPM, TEMPERATURE
from ehdmaps.version import version
from mbs.bearings.balls.ball_bearing import BallForce
from mbs.bearings.balls.laws import BallLaw
from mbs.output.ball_table import BallDescription, ball_heading
from mbs.output.bearing_table import result_kind
from mbs.scene.fields import FORCE

if TYPE_CHECKING:
    from mbs.bearings.balls.ball_point import BallPoint
    from mbs.exports.balls.speed_laws import SpeedLaws
    from mbs.exports.linear_bearing import Format

LINEAR = (".toml", ".bdf", ".inp", ".txt")
"""Endings of files for linear programs: ROSS, Nastran, CalculiX or Abaqus, Ansys; see `mbs.exports.linear_bearing`."""

SOURCE, UNIT = ".c", ".fmu"
"""Endings of files that hold the bearing itself."""


@dataclass(frozen=True, eq=False)
class BallExport:
    """Request and points of which a file for another program is made.

    Attributes
    ----------
    force : BallForce
        Geometry, and the dry law.
    description : BallDescription
        The request in words.
    points : sequence of BallPoint
        Points at the one load, over the speeds.
    outer_speed : float
        Speed of the outer ring [rad/s].
    films : callable or None
        Law with the films of an entrainment speed [m/s]; None where the law is dry.
    """

    force: BallForce
    description: BallDescription
    points: Sequence[BallPoint]
    outer_speed: float
    films: Callable[[float], BallLaw] | None


def is_export(path: str | None) -> bool:
    """Test whether a result is a file for another program.

    Parameters
    ----------
    path : str or None
        Path of -o.
    """
    return _ending(path) in (*LINEAR, SOURCE, UNIT)


def ball_outputs(path: str | None) -> tuple[Output, ...]:
    """All files that -o asks for.

    Parameters
    ----------
    path : str or None
        Path of -o.
    """
    ending = _ending(path)
    if path is None or not is_export(path):
        kind = result_kind(path)
        if ".nc" in kind.endings:
            kind = dataclasses.replace(kind, endings=(*kind.endings, *LINEAR, SOURCE, UNIT))
        return (Output("-o", path, kind),)
    if ending == SOURCE:
        from mbs.exports.balls import source

        return Output("-o", path, source.SOURCE), Output("-o", str(source.header_of(path)), source.HEADER)
    return (Output("-o", path, _kind(ending)),)


def count_problems(path: str | None, loads: int, speeds: int) -> list[str]:
    """Problems with more loads or speeds than a file for another program has.

    Parameters
    ----------
    path : str or None
        Path of -o.
    loads, speeds : int
        How many there are.
    """
    ending = _ending(path)
    one_speed = ending in LINEAR and _format(ending).one_speed
    if not is_export(path) or (loads <= 1 and (speeds <= 1 or not one_speed)):
        return []
    return [
        f"-o: got {path} for {loads} loads and {speeds} speeds; allowed: one load"
        + (", one speed" if one_speed else "")
        + ", or a file .nc or .csv"
    ]


def write_export(path: str, given: BallExport) -> str:
    """Write a file for another program, and return what was written in words.

    Parameters
    ----------
    path : str
        Path of -o; `is_export` holds.
    given : BallExport
        Request and points.

    Raises
    ------
    SolverError
        If a speed between those that were asked for has no films.
    InputError
        If it cannot be written.
    """
    ending = _ending(path)
    if ending in LINEAR:
        write_text(path, _linear_text(given, _format(ending)), _kind(ending))
        return f"{path}: written"
    laws, words = _speed_laws(given)
    header = (
        *_header(given),
        f"temperature: {TEMPERATURE.text(given.description.temperature)}",
        f"law: {given.description.law}",
        words,
    )
    if ending == SOURCE:
        from mbs.exports.balls.source import write_source

        return write_source(path, given.force, laws, header)
    from mbs.exports.balls.unit import write_ball_unit

    point = given.points[0]
    names = ("pose.x", "pose.y", "pose.z", "", "pose.theta_y", "pose.theta_z")
    start = {name: float(value) for name, value in zip(names, point.pose, strict=True) if name}
    start |= {"speed.inner": point.inner_speed, "speed.outer": point.outer_speed}
    return write_ball_unit(path, given.force, laws, start, (*header, *_around(given), "start: the first of the speeds"))


def _ending(path: str | None) -> str:
    """Ending of a path."""
    return "" if path is None else Path(path).suffix.lower()


def _format(ending: str) -> Format:
    """Format of a linear program."""
    from mbs.exports.linear_bearing import format_of

    return format_of(ending)


def _kind(ending: str) -> Kind:
    """Kind of a file of one part."""
    if ending in LINEAR:
        return _format(ending).kind
    from ehdmaps.exports.fmu.unit import UNIT as KIND_OF_UNITS

    return KIND_OF_UNITS


def _header(given: BallExport) -> tuple[str, ...]:
    """Lines that say where a file comes from; the first one carries the mark of our files."""
    heading = (line.strip() for line in ball_heading(given.description, given.points[0]))
    return (f"{MARK} {version()}", *BEARING_AXES, *heading)


def _around(given: BallExport) -> tuple[str, ...]:
    """The load of the points, and what is to be known of them."""
    point = given.points[0]
    return (
        f"linear around: radial {FORCE.text(point.size)}, axial {FORCE.text(point.axial)} on the inner ring",
        *dict.fromkeys(line for point in given.points for line in (*point.problems, *point.notes)),
    )


def _linear_text(given: BallExport, program: Format) -> str:
    """Text of the bearing over speed for a linear program."""
    from mbs.exports.linear_bearing import LinearBearing

    load, *notes = _around(given)
    slow = "K and C of slow motion; the outer ring turns with " + RPM.text(given.outer_speed)
    matrices = np.array([[point.stiffness, point.damping] for point in given.points])[:, None]
    speeds = np.array([point.inner_speed for point in given.points])
    bearing = LinearBearing(given.force.geometry.name, speeds, np.zeros(1), matrices[:, :, 0], matrices[:, :, 1])
    return program.plain(bearing, (*_header(given), load, slow, *notes))


def _speed_laws(given: BallExport) -> tuple[SpeedLaws, str]:
    """Laws over the speeds of the points, and what they are in words."""
    from mbs.exports.balls.speed_laws import LIGHT, dry_speed_laws, error_between, film_speed_laws

    geometry = given.force.geometry
    asked = [geometry.entrainment_speed(point.inner_speed, point.outer_speed) for point in given.points]
    turning = [u for u in asked if u > 0.0]
    if given.films is None or not turning:
        return dry_speed_laws(given.force.law), "films: none, dry contacts"
    laws = film_speed_laws(given.films, min(turning), max(turning))
    words = f"films: at {laws.speeds.size} entrainment speeds from {min(turning):.6g} to {max(turning):.6g} m/s"
    if laws.speeds.size == 1:
        return laws, f"{words}; held at any other"
    load, stiffness, damping = error_between(laws, given.films)
    return laws, (
        f"{words}, held beyond; between them right within {load:.1e} of the load, {stiffness:.1e} of the stiffness and "
        f"{damping:.1e} of the damping of a contact, from {LIGHT:.0%} of its highest load on"
    )
