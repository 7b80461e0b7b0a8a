"""Files that hold a bearing of balls, tapered rollers or ribs itself: which they are, and what stands in them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Protocol

from ehdmaps.arrays import FloatArray
from ehdmaps.outputs import Output
from ehdmaps.units import TEMPERATURE
from mbs.commands.one_bearing.linear_files import AtLoad, around, ending_of, header_of, is_linear, linear_outputs

if TYPE_CHECKING:
    from mbs.bearings.balls.film_tables import PairLaw
    from mbs.exports.balls.speed_laws import SpeedLaws

SOURCE, UNIT = ".c", ".fmu"
"""Endings of files that hold the bearing itself."""

DRY = "films: none, dry contacts"
"""What is said of laws without films."""


class Rolling(Protocol):
    """Geometry of a bearing whose elements roll."""

    def entrainment_speed(self, inner_speed: float, outer_speed: float = 0.0) -> float:
        """Entrainment speed [m/s] by the speeds of the rings [rad/s]."""


class Held(AtLoad, Protocol):
    """A point with the pose of its inner ring."""

    @property
    def pose(self) -> FloatArray:
        """Pose of the inner ring, (6,) [m], [rad]."""

    @property
    def outer_speed(self) -> float:
        """Speed of the outer ring [rad/s]."""


def is_export(path: str | None) -> bool:
    """Test whether a result is a file for another program.

    Parameters
    ----------
    path : str or None
        Path of -o.
    """
    return is_linear(path) or is_source(path)


def is_source(path: str | None) -> bool:
    """Test whether a result is a bearing in C, or a unit of it.

    Parameters
    ----------
    path : str or None
        Path of -o.
    """
    return ending_of(path) in (SOURCE, UNIT)


def bearing_outputs(path: str | None) -> tuple[Output, ...]:
    """All files that -o asks for.

    Parameters
    ----------
    path : str or None
        Path of -o.
    """
    ending = ending_of(path)
    if path is not None and ending == SOURCE:
        from mbs.exports.balls import source

        return Output("-o", path, source.SOURCE), Output("-o", str(source.header_of(path)), source.HEADER)
    if ending == UNIT:
        from ehdmaps.exports.fmu.unit import UNIT as KIND_OF_UNITS

        return (Output("-o", path, KIND_OF_UNITS),)
    return linear_outputs(path, (SOURCE, UNIT))


def turning_speeds(geometry: Rolling, points: Sequence[AtLoad], outer_speed: float) -> tuple[float, float] | None:
    """Lowest and highest entrainment speed of points [m/s]; None where nothing rolls.

    Parameters
    ----------
    geometry : Rolling
        The bearing.
    points : sequence of AtLoad
        Points over speed.
    outer_speed : float
        Speed of the outer ring [rad/s].
    """
    asked = [geometry.entrainment_speed(point.inner_speed, outer_speed) for point in points]
    turning = [u for u in asked if u > 0.0]
    return (min(turning), max(turning)) if turning else None


def film_words(laws: SpeedLaws, films: Callable[[float], PairLaw], *, of_largest: bool = False) -> str:
    """Speeds of films and how right they are between them, in words.

    Parameters
    ----------
    laws : SpeedLaws
        Laws over the speed, with films.
    films : callable
        What they were made of: law with the films of an entrainment speed [m/s].
    of_largest : bool
        Whether errors of the damping are parts of its largest value.
    """
    from mbs.exports.balls.speed_laws import LIGHT, error_between

    kind, (slow, fast) = "films with memory" if laws.memory else "films", laws.speeds[[0, -1]].tolist()
    words = f"{kind}: at {laws.speeds.size} entrainment speeds from {slow:.6g} to {fast:.6g} m/s"
    if laws.speeds.size == 1:
        return f"{words}; held at any other"
    load, stiffness, damping = error_between(laws, films, of_largest=of_largest)
    return (
        f"{words}, held beyond; between them right within {load:.1e} of the load, {stiffness:.1e} of the stiffness and "
        f"{damping:.1e} of the {'largest ' * of_largest}damping of a contact, from {LIGHT:.0%} of its highest load on"
    )


def bearing_header(heading: Sequence[str], temperature: float, law: str, films: str) -> tuple[str, ...]:
    """Lines that say where a file comes from.

    Parameters
    ----------
    heading : sequence of str
        What was computed, as it is told to people.
    temperature : float
        Temperature of the raceways [K].
    law, films : str
        Law and films in words.
    """
    return (*header_of(heading), f"temperature: {TEMPERATURE.text(temperature)}", f"law: {law}", films)


def unit_header(header: Sequence[str], points: Sequence[AtLoad]) -> tuple[str, ...]:
    """The same of a unit, with the load at its start.

    Parameters
    ----------
    header : sequence of str
        Lines that say where it comes from.
    points : sequence of AtLoad
        Points at the one load.
    """
    return (*header, *around(points), "start: the first of the speeds")


def start_of(point: Held) -> dict[str, float]:
    """Pose and speeds at a point, by the names of the variables of a unit.

    Parameters
    ----------
    point : Held
        The point.
    """
    names = ("pose.x", "pose.y", "pose.z", "", "pose.theta_y", "pose.theta_z")
    start = {name: float(value) for name, value in zip(names, point.pose, strict=True) if name}
    return start | {"speed.inner": point.inner_speed, "speed.outer": point.outer_speed}
