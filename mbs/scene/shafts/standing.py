"""Bearings that stand on a shaft by their position along it, and the weight of a machine that is given this way.

A bearing with `shaft` and `position` has its inner ring at a place of its own name on that shaft, and its outer ring on
the ground unless `outer` says where.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Generic, NamedTuple, TypeVar

from ehdmaps.units import LENGTH, short
from mbs.model.elements import GROUND
from mbs.scene import fields

if TYPE_CHECKING:
    from ehdmaps.jobs.table import Table

FARTHEST = 1e-3
"""Largest axial offset of a bearing, either way [m]."""

_STANDARD_GRAVITY = 9.80665
"""Acceleration of gravity by definition (ISO 80000-3) [m/s2]."""

DOWN = (0.0, -_STANDARD_GRAVITY, 0.0)
"""Weight of a scene with a shaft by lengths that states no gravity: against y, so that a roller is below [m/s2]."""


def by_lengths(values: object) -> bool:
    """Tell whether a shaft of a file is given as a table of lengths: as a CSV file, or by rows that have one.

    Parameters
    ----------
    values : object
        The table of the shaft, as it was read from TOML.
    """
    given = values.get("sections") if isinstance(values, dict) else None
    rows = given if isinstance(given, list) else []
    return isinstance(given, str) or any(isinstance(row, dict) and "length" in row for row in rows)


def mounts(shafts: object, bearings: object) -> dict[str, dict[str, float]]:
    """Positions of the bearings that stand on each shaft [m], by the names of shaft and bearing.

    What is wrong about them is left out here, and noted where the bearing is read.

    Parameters
    ----------
    shafts, bearings : object
        [[shafts]] and [[bearings]], as they were read from TOML.
    """
    from ehdmaps.jobs.table import Table

    named = [entry.get("name") for entry in _tables(shafts)]
    found: dict[str, dict[str, float]] = {name: {} for name in named if isinstance(name, str)}
    for entry in _tables(bearings):
        name, shaft = entry.get("name"), entry.get("shaft")
        if isinstance(name, str) and isinstance(shaft, str) and shaft in found:
            position = _position(Table(entry, f"[[bearings]] {name}", []))
            if position is not None:
                found[shaft][name] = position
    return found


def read_rings(section: Table, name: str) -> tuple[str | None, str | None]:
    """Read the places of both rings of a bearing; None where a problem was noted.

    Parameters
    ----------
    section : Table
        The table of the bearing.
    name : str
        Name of the bearing.
    """
    if "shaft" not in section and "position" not in section:
        return fields.place(section, "inner"), fields.place(section, "outer")
    shaft = section.get("shaft", "the name of a shaft, beside position")
    position = _position(section)
    if "inner" in section:
        section.get("inner")
        section.note("inner", "stands beside shaft and position; allowed: one of the two; delete one")
    if "shaft" in section and (not isinstance(shaft, str) or not shaft or ":" in shaft):
        section.note("shaft", f"got {short(shaft)}; allowed: the name of a shaft")
        shaft = None
    outer = fields.place(section, "outer") if "outer" in section else GROUND
    return (None if position is None or shaft is None else f"{shaft}:{name}"), outer


Geometry = TypeVar("Geometry")


class Located(NamedTuple, Generic[Geometry]):
    """Bearing that holds its shaft along the axis too, as a table [[bearings]] with its designation has it.

    Attributes
    ----------
    inner, outer : str or None
        Places of both rings; None where a problem was noted.
    geometry : geometry or None
        Geometry as its catalogue has it; None where a problem was noted.
    mirrored : bool
        Whether it is turned round.
    start_angle, axial_offset : float
        [rad], [m].
    """

    inner: str | None
    outer: str | None
    geometry: Geometry | None
    mirrored: bool
    start_angle: float
    axial_offset: float


def read_located(section: Table, name: str, estimate: Callable[[str], Geometry]) -> Located[Geometry]:
    """Read a bearing by its designation, and how it stands.

    Parameters
    ----------
    section : Table
        The table; the caller closes it.
    name : str
        Name of the bearing.
    estimate : callable
        Designation to geometry, as a catalogue has it; raises an InputError.
    """
    inner, outer = read_rings(section, name)
    geometry = section.made(lambda: estimate(str(section.get("bearing"))), "bearing", "bearing designation: ")
    mirrored = section.flag("mirrored")
    angle = section.quantity("start_angle", "rad", -7.0, 7.0, fields.DEGREE) or 0.0
    offset = section.quantity("axial_offset", "m", -FARTHEST, FARTHEST, fields.MICROMETRE) or 0.0
    return Located(inner, outer, geometry, mirrored, angle, offset)


def read_gravity(operation: Table, shafts: object) -> tuple[float, float, float] | None:
    """Read the acceleration of gravity [m/s2]; None where a problem was noted.

    Parameters
    ----------
    operation : Table
        [operation] of the scene.
    shafts : object
        [[shafts]], as they were read from TOML; with one by lengths, weight is on where no gravity is stated.
    """
    stated = fields.vector(operation, "gravity", "m/s^2", fields.ACCELERATION, 1e4)
    return DOWN if "gravity" not in operation and any(map(by_lengths, _tables(shafts))) else stated


def _position(section: Table) -> float | None:
    """Position of a bearing along its shaft [m]; None where a problem was noted."""
    return section.quantity("position", "m", -100.0, 100.0, LENGTH, required=True)


def _tables(entries: object) -> list[dict[str, object]]:
    """Tables of a list of them; what is no table is noted elsewhere."""
    return [entry for entry in entries if isinstance(entry, dict)] if isinstance(entries, list) else []
