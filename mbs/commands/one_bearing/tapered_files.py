"""Files of a bearing of tapered rollers or ribs for other programs: linear programs, C, Functional Mock-up Units."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from mbs.bearings.tapered.line_film import LineFilms
from mbs.bearings.tapered.tapered_bearing import TaperedForce
from mbs.bearings.tapered.tapered_point import TaperedPoint
from mbs.commands.one_bearing.bearing_files import (
    DRY,
    SOURCE,
    bearing_header,
    film_words,
    start_of,
    turning_speeds,
    unit_header,
)
from mbs.commands.one_bearing.linear_files import ending_of, is_linear, write_linear
from mbs.commands.one_bearing.tapered_table import TaperedDescription, tapered_heading


@dataclass(frozen=True, eq=False)
class TaperedExport:
    """Request and points of which a file for another program is made.

    Attributes
    ----------
    force : TaperedForce
        Geometry, and the dry law.
    description : TaperedDescription
        The request in words.
    points : sequence of TaperedPoint
        Points at the one load, over the speeds.
    outer_speed : float
        Speed of the outer ring [rad/s].
    films : callable or None
        Law with the films of an entrainment speed [m/s]; None where the law is dry.
    memory : bool
        Whether films have a memory.
    """

    force: TaperedForce
    description: TaperedDescription
    points: Sequence[TaperedPoint]
    outer_speed: float
    films: Callable[[float], LineFilms] | None
    memory: bool = False


def write_export(path: str, given: TaperedExport) -> str:
    """Write a file for another program, and return what was written in words.

    Parameters
    ----------
    path : str
        Path of -o, whose file is no result.
    given : TaperedExport
        Request and points.

    Raises
    ------
    InputError
        If it cannot be written, or a speed between those that were asked for has no films.
    """
    heading = tapered_heading(given.description, given.points[0])
    if is_linear(path):
        return write_linear(path, given.force.geometry.name, heading, given.points, given.outer_speed)
    from mbs.exports.tapered.source import line_speed_laws, write_source

    ends, words = turning_speeds(given.force.geometry, given.points, given.outer_speed), DRY
    if given.films is None or ends is None:
        laws = line_speed_laws(given.force)
    else:
        laws = line_speed_laws(given.force, given.films, ends, memory=given.memory)
        words = film_words(laws, given.films, of_largest=True)
    header = bearing_header(heading, given.description.temperature, given.description.law, words)
    if ending_of(path) == SOURCE:
        return write_source(path, given.force, laws, header)
    from mbs.exports.tapered.unit import write_tapered_unit

    return write_tapered_unit(path, given.force, laws, start_of(given.points[0]), unit_header(header, given.points))
