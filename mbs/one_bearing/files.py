"""Files of a bearing for other programs: linear programs, C, Functional Mock-up Units."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from ehdmaps.errors import InputError
from ehdmaps.outputs import Output
from ehdmaps.units import TEMPERATURE
from mbs.one_bearing.linear_files import around, ending_of, header_of, is_linear, linear_outputs, write_linear
from mbs.output.one_bearing.kind import Description
from mbs.output.one_bearing.table import heading
from mbs.scene.map_set import TABLE_LAW

if TYPE_CHECKING:
    from ehdmaps.maps.emap import EHDMap
    from mbs.bearings.deviating.tables import Deviations
    from mbs.bearings.locating.normal_law import PairLaw
    from mbs.exports.one_bearing.speed_laws import SpeedLaws
    from mbs.one_bearing.family import Family

SOURCE, UNIT = ".c", ".fmu"
"""Endings of files that hold the bearing itself."""

DRY = "films: none, dry contacts"
"""What is said of laws without films."""


@dataclass(frozen=True, eq=False)
class Export:
    """Request and points of which a file for another program is made.

    Attributes
    ----------
    family : Family
        Family of the bearing.
    force : BallForce or TaperedForce
        Geometry, and the dry law.
    description : Description
        The request in words.
    points : sequence
        Points at the one load, over the speeds.
    outer_speed : float
        Speed of the outer ring [rad/s].
    films : callable or None
        Law with the films of an entrainment speed [m/s]; None where the law is dry.
    memory : bool
        Whether films have a memory.
    emap : EHDMap or None
        Map of the films of bearings that have one.
    deviations : Deviations or None
        Deviations of the bearing from its form.
    """

    family: Family
    force: Any
    description: Description
    points: Sequence[Any]
    outer_speed: float
    films: Callable[[float], PairLaw] | None
    memory: bool = False
    emap: EHDMap | None = None
    deviations: Deviations | None = None


def is_export(path: str | None) -> bool:
    """Test whether a result is a file for another program.

    Parameters
    ----------
    path : str or None
        Path of -o.
    """
    return is_linear(path) or ending_of(path) in (SOURCE, UNIT)


def bearing_outputs(path: str | None) -> tuple[Output, ...]:
    """All files that -o asks for.

    Parameters
    ----------
    path : str or None
        Path of -o.
    """
    ending = ending_of(path)
    if path is not None and ending == SOURCE:
        from mbs.exports.one_bearing import source

        return Output("-o", path, source.SOURCE), Output("-o", str(source.header_of(path)), source.HEADER)
    if ending == UNIT:
        from ehdmaps.exports.fmu.unit import UNIT as KIND_OF_UNITS

        return (Output("-o", path, KIND_OF_UNITS),)
    return linear_outputs(path, (SOURCE, UNIT))


def write_export(path: str, given: Export) -> str:
    """Write a file for another program, and return what was written in words.

    Parameters
    ----------
    path : str
        Path of -o; `is_export` holds.
    given : Export
        Request and points.

    Raises
    ------
    SolverError, InputError
        If a speed between those that were asked for has no films; if it cannot be written.
    """
    family, points, deviations = given.family, given.points, None
    if given.deviations is not None:
        from mbs.bearings.deviating.tables import deviation_data

        bearing = given.force.bearing if family.exported is None else given.force
        places = bearing.roller_angles if family.exported is None else bearing.angles
        deviations = deviation_data(given.deviations, bearing.geometry, (1.0, 0.0), 0.0, places)
    heads = heading(family.kind, given.description, points[0])
    if is_linear(path):
        oscillating = family.oscillating(points) if given.memory and family.oscillating else None
        return write_linear(path, points[0].geometry.name, heads, points, given.outer_speed, oscillating)
    if family.exported is None:
        from mbs.exports.one_bearing.of_map import write_of_map

        if given.emap is None:
            raise InputError(
                f"-o {path}: got the law {given.description.law}; allowed: --law {TABLE_LAW}, or --map MAP.nc"
            )
        return write_of_map(path, given.emap, given.force.bearing, memory=given.memory, deviations=deviations)
    kind, ends, words = family.exported(), _turning_speeds(given), DRY
    films = None if ends is None else given.films
    laws = kind.speed_laws(given.force, films, ends or (0.0, 0.0), memory=given.memory)
    if films is not None:
        words = _film_words(laws, films, of_largest=kind.of_largest)
    temperature = f"temperature: {TEMPERATURE.text(given.description.temperature)}"
    header = (*header_of(heads), temperature, f"law: {given.description.law}", words)
    if ending_of(path) == SOURCE:
        from mbs.exports.one_bearing.source import write_source

        return write_source(kind, path, given.force, laws, header, deviations)
    from mbs.exports.one_bearing.unit import write_bearing_unit

    header = (*header, *around(points), "start: the first of the speeds")
    return write_bearing_unit(kind, path, given.force, laws, _start_of(points[0]), header, deviations)


def _turning_speeds(given: Export) -> tuple[float, float] | None:
    """Lowest and highest entrainment speed of points [m/s]; None where nothing rolls."""
    geometry = given.force.geometry
    asked = [geometry.entrainment_speed(point.inner_speed, given.outer_speed) for point in given.points]
    turning = [u for u in asked if u > 0.0]
    return (min(turning), max(turning)) if turning else None


def _film_words(laws: SpeedLaws, films: Callable[[float], PairLaw], *, of_largest: bool) -> str:
    """Speeds of films and how right they are between them, in words."""
    from mbs.exports.one_bearing.speed_laws import LIGHT, error_between

    kind, (slow, fast) = "films with memory" if laws.memory else "films", laws.speeds[[0, -1]].tolist()
    words = f"{kind}: at {laws.speeds.size} entrainment speeds from {slow:.6g} to {fast:.6g} m/s"
    if laws.speeds.size == 1:
        return f"{words}; held at any other"
    load, stiffness, damping = error_between(laws, films, of_largest=of_largest)
    return (
        f"{words}, held beyond; between them right within {load:.1e} of the load, {stiffness:.1e} of the stiffness and "
        f"{damping:.1e} of the {'largest ' * of_largest}damping of a contact, from {LIGHT:.0%} of its highest load on"
    )


def _start_of(point: Any) -> dict[str, float]:
    """Pose and speeds at a point, by the names of the variables of a unit."""
    names = ("pose.x", "pose.y", "pose.z", "", "pose.theta_y", "pose.theta_z")
    start = {name: float(value) for name, value in zip(names, point.pose, strict=True) if name}
    return start | {"speed.inner": point.inner_speed, "speed.outer": point.outer_speed}
