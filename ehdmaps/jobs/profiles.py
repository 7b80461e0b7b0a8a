"""The profile of rollers, of a bearing in a scene or as text on a command line: by name, as an arc, or as a table."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ehdmaps.errors import Problems
from ehdmaps.physics.bearing import BearingGeometry
from ehdmaps.physics.surface import CrownedProfile, TabulatedProfile
from ehdmaps.units import FILM, LENGTH, closest, short

if TYPE_CHECKING:
    from ehdmaps.jobs.table import Table

RollerProfile = str | CrownedProfile | TabulatedProfile
"""What a scene holds as the profile of rollers: "iso", "straight", or an arc or table."""

NAMES = ("iso", "straight")
_ALLOWED = (
    'iso, straight, { crown_radius = "5 m" } or { crown_drop = "10 um" }, either with straight = "9 mm" for a straight '
    'middle, or { positions = ["0 mm", "7.5 mm"], depths = ["0 um", "4 um"] }'
)


def read_profile(section: Table, geometry: BearingGeometry | None) -> RollerProfile:
    """Read the profile of the rollers of a bearing; "iso" where there is none, or a problem was noted.

    Parameters
    ----------
    section : Table
        Table of the bearing.
    geometry : BearingGeometry or None
        Geometry of the bearing; None where a problem of it was noted.
    """
    value = section.get("profile")
    if "profile" not in section or value in NAMES:
        return value or "iso"
    if not isinstance(value, dict) or len({"crown_radius", "crown_drop", "positions"} & set(value)) != 1:
        section.note("profile", f"got {short(value)}{_closest(value)}; allowed: {_ALLOWED}")
        return "iso"
    from ehdmaps.jobs.table import Table

    problems = Problems()
    table = Table(value, "profile", problems)
    found: RollerProfile | None = None
    with problems:
        found = _tabulated(table) if "positions" in value else _crowned(table, geometry)
    table.close()
    if found is not None and not problems and geometry is not None:
        problems += _reach_problems(found, geometry)
    for problem in problems:
        section.note("profile", problem.removeprefix("profile "))
    return found or "iso"


def profile_from_text(text: str, geometry: BearingGeometry | None, problems: list[str]) -> RollerProfile:
    """Read a profile as a scene writes its value; "iso" where a problem was noted.

    Parameters
    ----------
    text : str
        A name, or an arc or table in braces.
    geometry : BearingGeometry or None
        Geometry of the bearing; None where a problem of it was noted.
    problems : list of str
        What is wrong is appended.

    Examples
    --------
    >>> profile_from_text('{ crown_radius = "5 m" }', None, [])
    CrownedProfile(radius=5.0, straight=0.0)
    """
    if text in NAMES:
        return text
    from ehdmaps.jobs.table import Table, inline

    value: object = text
    if text.lstrip().startswith("{") and (value := inline(text, "--profile", problems)) is None:
        return "iso"
    noted: list[str] = []
    found = read_profile(Table({"profile": value}, "--profile", noted), geometry)
    # Of the scene's words those of the key are the option's.
    problems += [problem.replace("--profile profile", "--profile", 1) for problem in noted]
    return found


def _crowned(table: Table, geometry: BearingGeometry | None) -> CrownedProfile | None:
    """Read an arc, by its radius or by its depth at the ends."""
    straight = table.quantity("straight", "m", 0.0, 1.0, LENGTH) or 0.0
    if "crown_radius" in table:
        radius = table.quantity("crown_radius", "m", 1e-3, 1e6, LENGTH)
        return None if radius is None else CrownedProfile(radius, straight)
    drop = table.quantity("crown_drop", "m", 1e-9, 1e-2, FILM)
    if drop is None or geometry is None:
        return None
    return CrownedProfile.of_drop(drop, geometry.roller_length, straight)


def _closest(value: object) -> str:
    """The name that may be meant."""
    return closest(value, NAMES) if isinstance(value, str) else ""


def _tabulated(table: Table) -> TabulatedProfile | None:
    """Read a table of places and depths."""
    positions = _lengths(table, "positions", 1.0)
    depths = _lengths(table, "depths", 1e-2)
    return None if positions is None or depths is None else TabulatedProfile(positions, depths)


def _lengths(table: Table, key: str, largest: float) -> list[float] | None:
    """Read a list of lengths [m], each within +- `largest`."""
    value: Any = table.get(key, "a list of lengths")
    if not isinstance(value, list):
        if key in table:
            table.note(key, f"got {short(value)}; allowed: a list of lengths")
        return None
    read = [table.quantity_of(part, f"{key}[{i}]", "m", -largest, largest, LENGTH) for i, part in enumerate(value)]
    known = [part for part in read if part is not None]
    return known if len(known) == len(read) else None


def _reach_problems(profile: CrownedProfile | TabulatedProfile | str, geometry: BearingGeometry) -> list[str]:
    """Problems with a profile that does not reach the ends of the roller."""
    half = 0.5 * geometry.roller_length
    if isinstance(profile, CrownedProfile) and profile.straight >= geometry.roller_length:
        return [f"straight: got {LENGTH.text(profile.straight)}; allowed: below the roller's {LENGTH.text(2.0 * half)}"]
    if isinstance(profile, CrownedProfile) and profile.radius < half - 0.5 * profile.straight:
        return [f"crown_radius: got {LENGTH.text(profile.radius)}; allowed: an arc that reaches the ends of the roller"]
    if not isinstance(profile, TabulatedProfile):
        return []
    first, last = profile.positions[0], profile.positions[-1]
    least = half * (1.0 - 1e-9)
    if last >= least and (first == 0.0 or first <= -least):
        return []
    return [
        f"positions: got {LENGTH.text(first)} to {LENGTH.text(last)}; allowed: from 0, or from {LENGTH.text(-half)} at "
        f"most, to {LENGTH.text(half)} at least, the end of the roller"
    ]
