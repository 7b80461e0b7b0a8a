"""Shafts of a scene: a table [[shafts]] is read, with what stands on it by its position, and becomes a body."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from pathlib import Path

from ehdmaps.errors import InputError
from ehdmaps.jobs.table import Table
from ehdmaps.units import LENGTH, Display, short
from mbs.flexible.shaft_parts import Disc
from mbs.model.body import FREEDOMS, Body, Inertia
from mbs.scene import fields
from mbs.scene.fields import HERTZ
from mbs.scene.shafts.rows import read_sections
from mbs.scene.shafts.standing import by_lengths
from mbs.scene.specs import ORIGIN, ShaftSpec

BENDING = ("y", "z", "theta_y", "theta_z")
"""Freedoms of a shaft that states none: cylindrical roller bearings hold no axis."""

CUTOFF = 5e3
"""Cut-off of a shaft that states none [Hz]; none, where the theory of beams does not hold there."""

MOMENTS = ("polar_inertia", "transverse_inertia")
"""Keys of the moments of inertia; both, or none."""

_INERTIA = Display("kg m^2")


def read_shaft(
    section: Table, name: str, folder: Path | None = None, mounted: Mapping[str, float] | None = None
) -> ShaftSpec | None:
    """Read a flexible shaft.

    Parameters
    ----------
    section : Table
        One table of [[shafts]]; it is not closed here.
    name : str
        Name of the shaft, read before.
    folder : Path, optional
        Folder in which the path of a file of sections begins; that of the shipped systems if left out.
    mounted : mapping of str to float, optional
        Positions of what stands on it, which become places of that name [m].

    Returns
    -------
    ShaftSpec or None
        None where a problem was noted.
    """
    before = len(section.problems)
    freedoms = fields.words(section, "freedoms", FREEDOMS) if "freedoms" in section else BENDING
    position = fields.lengths(section, "position", section.get("position"))
    spin = section.number("spin", -1e3, 1e3)
    sections, files = read_sections(section, folder)
    discs, named = _discs(section)
    mounted = mounted or {}
    for key in sorted({*named} & {*mounted}):
        section.note("discs", f"got the name {short(key)}, which a bearing on the shaft has; allowed: another name")
    frames = _frames(section, {**named, **mounted})
    cutoff = section.quantity("cutoff", "Hz", 1.0, 1e6, HERTZ)
    largest = section.quantity("largest_element", "m", 1e-6, 100.0, LENGTH)
    ratio = section.number("damping_ratio", 0.0, 0.5)
    if len(section.problems) > before or freedoms is None:
        return None
    table = by_lengths({"sections": section.get("sections")})

    def made(cutoff: float | None, stated: bool = True) -> ShaftSpec:
        return ShaftSpec(
            name=name,
            sections=sections,
            freedoms=freedoms,
            frames=frames,
            cutoff=cutoff,
            discs=discs,
            position=position or ORIGIN,
            spin=float(table) if spin is None else spin,
            largest_element=largest,
            damping_ratio=ratio or 0.0,
            cutoff_stated=stated,
            files=files,
        )

    def unstated() -> ShaftSpec:
        try:
            return made(CUTOFF, stated=False)
        except InputError:
            return made(None)

    return section.made(unstated if cutoff is None else lambda: made(cutoff))


def build_shaft(spec: ShaftSpec) -> Body:
    """The body of a flexible shaft.

    Parameters
    ----------
    spec : ShaftSpec
        The shaft.

    Raises
    ------
    InputError
        With everything that does not fit together.
    """
    from mbs.flexible.shaft import flexible_shaft  # with its finite elements; reading stays quick

    return flexible_shaft(
        spec.name,
        spec.sections,
        spec.discs,
        spec.freedoms,
        spec.position,
        spec.frames,
        spec.spin,
        spec.largest_element,
        spec.cutoff,
        spec.damping_ratio,
    )


def _frames(section: Table, standing: Mapping[str, float]) -> dict[str, float]:
    """Places of a shaft along its axis [m]: those of its table, and those of what stands on it."""
    frames: dict[str, float] = {}
    required = "" if standing else '{ left = "40 mm", right = "200 mm" }, along the axis; or a bearing with shaft'
    given = section.table("frames", f"{section.where} frames", required)
    for key in given.entries() if given else ():
        assert given is not None
        fields.named(given, key)
        frames[key] = given.quantity(key, "m", -100.0, 100.0, LENGTH) or 0.0
        if key in standing:
            given.note(key, "is the name of a disc or of a bearing on the shaft; allowed: another name")
    return {**frames, **standing}


def _discs(section: Table) -> tuple[list[Disc], dict[str, float]]:
    """Read the rigid parts of a shaft, and the places of those that have a name [m]."""
    allowed = "a list of tables with at, diameter, width, or at, mass, and if wanted polar_inertia, transverse_inertia"
    discs, places = [], {}
    for table in section.tables("discs", allowed):
        name = fields.text(table, "name")
        disc = _disc(table)
        if name in places:
            table.note("name", f"got {short(name)} twice; allowed: a name of its own")
        if disc is not None:
            discs.append(disc)
            places.update({name: disc.position} if name else {})
    return discs, places


def _disc(table: Table) -> Disc | None:
    """Read a rigid part: mass and moments of inertia at a place, or a cylinder by its middle, or by its ends."""
    if "at" not in table and "mass" not in table:
        cylinder = fields.cylinder(table)
        return None if cylinder is None else Disc(cylinder.offset, dataclasses.replace(cylinder, offset=0.0))
    place = table.quantity("at", "m", -100.0, 100.0, LENGTH, required=True)
    inertia = _middle_cylinder(table) if "diameter" in table or "width" in table else _inertia(table)
    return None if place is None or inertia is None else Disc(place, inertia)


def _middle_cylinder(table: Table) -> Inertia | None:
    """Read a hollow cylinder of a width about its middle."""
    width = table.quantity("width", "m", 1e-6, 100.0, LENGTH, required=True)
    diameter = table.quantity("diameter", "m", 1e-5, 100.0, LENGTH, required=True)
    bore = table.quantity("bore", "m", 0.0, 100.0, LENGTH)
    density = fields.material(table).density
    table.close(("mass", "polar_inertia", "transverse_inertia"))
    if width is None or diameter is None:
        return None
    return fields.solid_cylinder(table, -0.5 * width, 0.5 * width, diameter, bore, density)


def _inertia(table: Table) -> Inertia | None:
    """Read mass and moments of inertia; a point mass has none."""
    mass = table.quantity("mass", "kg", 1e-6, 1e6, Display("kg"), required=True)
    given = any(key in table for key in MOMENTS)
    polar, transverse = (table.quantity(key, "kg m^2", 0.0, 1e6, _INERTIA, required=given) for key in MOMENTS)
    table.close(("diameter", "width", "bore"))
    if mass is None:
        return None
    if not given:
        return table.made(lambda: Inertia(mass, 0.0, 0.0))
    if polar is None or transverse is None:
        return None
    return table.made(lambda: Inertia(mass, polar, transverse))
