"""Files of a ball bearing for other programs, by their endings: linear programs, C, Functional Mock-up Units."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ehdmaps.errors import SolverError
from ehdmaps.units import RPM
from mbs.bearings.balls.ball_bearing import BallForce
from mbs.bearings.balls.laws import BallLaw
from mbs.commands.one_bearing.bearing_files import (
    DRY,
    SOURCE,
    UNIT,
    bearing_header,
    film_words,
    start_of,
    turning_speeds,
    unit_header,
)
from mbs.commands.one_bearing.linear_files import Oscillating, ending_of, is_linear, write_linear
from mbs.output.ball_table import BallDescription, ball_heading

if TYPE_CHECKING:
    from mbs.bearings.balls.ball_point import BallPoint
    from mbs.exports.balls.speed_laws import SpeedLaws

ROSS = ".toml"
"""Ending of files that may hold K and C of films with memory."""

FREQUENCIES = np.array([0.0, *np.geomspace(10.0, 2e4, 34)])
"""Frequencies of films with memory at one speed [Hz], ten in a decade: K and C are cubics between them in ROSS."""


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
    memory : bool
        Whether films have a memory.
    """

    force: BallForce
    description: BallDescription
    points: Sequence[BallPoint]
    outer_speed: float
    films: Callable[[float], BallLaw] | None
    memory: bool = False


def has_memory(path: str | None) -> bool:
    """Tell whether films may have a memory in a file.

    Parameters
    ----------
    path : str or None
        Path of -o.
    """
    return ending_of(path) in (ROSS, SOURCE, UNIT)


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
    heading = ball_heading(given.description, given.points[0])
    if is_linear(path):
        oscillating = _oscillating(given) if given.memory else None
        return write_linear(path, given.force.geometry.name, heading, given.points, given.outer_speed, oscillating)
    laws, words = _speed_laws(given)
    header = bearing_header(heading, given.description.temperature, given.description.law, words)
    if ending_of(path) == SOURCE:
        from mbs.exports.balls.source import write_source

        return write_source(path, given.force, laws, header)
    from mbs.exports.balls.unit import write_ball_unit

    return write_ball_unit(path, given.force, laws, start_of(given.points[0]), unit_header(header, given.points))


def _oscillating(given: BallExport) -> Oscillating:
    """K and C of films with memory: of one speed over frequency, of several at the frequency of turning of each."""
    from mbs.bearings.balls.ball_point import ball_dynamic_stiffness

    one = len(given.points) == 1
    found = []
    for point in given.points:
        if not (point.force.law.dry or point.force.law.responses):
            raise SolverError(
                f"films with memory at {RPM.text(point.inner_speed)}: those that are solved have no response over "
                "frequency; take speeds and oils that --law table has, or leave --films out"
            )
        omega = 2.0 * np.pi * FREQUENCIES if one else np.array([abs(point.inner_speed)])
        z = ball_dynamic_stiffness(point, omega)
        rate = z.imag / np.where(omega > 0.0, omega, 1.0)[:, None, None]
        found.append([z.real, np.where(omega[:, None, None] > 0.0, rate, point.damping)])
    if one:
        return Oscillating("of films with memory over the frequency, 0: slow motion", FREQUENCIES, np.array(found))
    words = "of films with memory at the frequency of turning of the inner ring: of unbalances"
    return Oscillating(words, np.zeros(1), np.array(found))


def _speed_laws(given: BallExport) -> tuple[SpeedLaws, str]:
    """Laws over the speeds of the points, and what they are in words."""
    from mbs.bearings.balls.response import SHORTER
    from mbs.exports.balls.speed_laws import dry_speed_laws, film_speed_laws

    ends = turning_speeds(given.force.geometry, given.points, given.outer_speed)
    if given.films is None or ends is None:
        law = given.force.law
        return dry_speed_laws(law.inner, law.outer), DRY
    laws = film_speed_laws(given.films, *ends, shorter=SHORTER if given.memory else ())
    return laws, film_words(laws, given.films)
