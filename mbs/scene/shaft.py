"""Flexible shafts of a scene: a table [[shafts]] is read, and becomes a body."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable

from ehdmaps.jobs.table import Table
from ehdmaps.physics.solids import STEEL
from ehdmaps.units import LENGTH, PRESSURE, Display, short
from mbs.flexible.shaft_parts import Disc, Section
from mbs.model.body import FREEDOMS, Body, Inertia
from mbs.scene import fields
from mbs.scene.fields import HERTZ, Built
from mbs.scene.specs import ORIGIN, ShaftSpec

_DENSITY = Display("kg/m^3")
_INERTIA = Display("kg m^2")


def read_shaft(section: Table, name: str) -> ShaftSpec | None:
    """Read a flexible shaft.

    Parameters
    ----------
    section : Table
        One table of [[shafts]]; it is not closed here.
    name : str
        Name of the shaft, read before.

    Returns
    -------
    ShaftSpec or None
        None where a problem was noted.
    """
    before = len(section.problems)
    freedoms = fields.words(section, "freedoms", FREEDOMS)
    position = fields.lengths(section, "position", section.get("position"))
    spin = section.number("spin", -1e3, 1e3)
    sections = _each(section, "sections", "from, to, diameter", _section, required=True)
    discs = _each(section, "discs", "at, mass, polar_inertia, transverse_inertia, or from, to, diameter", _disc)
    frames = {}
    given = section.table("frames", f"{section.where} frames", '{ left = "40 mm", right = "200 mm" }, along the axis')
    if given:
        for key in given.entries():
            fields.named(given, key)
            frames[key] = given.quantity(key, "m", -100.0, 100.0, LENGTH) or 0.0
    cutoff = section.quantity("cutoff", "Hz", 1.0, 1e6, HERTZ, required=True)
    largest = section.quantity("largest_element", "m", 1e-6, 100.0, LENGTH)
    ratio = section.number("damping_ratio", 0.0, 0.5)
    if len(section.problems) > before or freedoms is None:
        return None
    return fields.built(
        section,
        lambda: ShaftSpec(
            name=name,
            sections=sections,
            freedoms=freedoms,
            frames=frames,
            cutoff=cutoff,
            discs=discs,
            position=position or ORIGIN,
            spin=spin or 0.0,
            largest_element=largest,
            damping_ratio=ratio or 0.0,
        ),
    )


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


def _each(
    section: Table, key: str, keys: str, read: Callable[[Table], Built | None], *, required: bool = False
) -> list[Built]:
    """Read each table of a list."""
    allowed = f"a list of tables with {keys}"
    given = section.get(key, allowed if required else "")
    if key not in section:
        return []
    if not isinstance(given, list):
        section.note(key, f"got {short(given)}; allowed: {allowed}")
        return []
    found = [
        read(Table(values, f"{section.where} {key}[{index}]", section.problems)) for index, values in enumerate(given)
    ]
    return [part for part in found if part is not None]


def _section(table: Table) -> Section | None:
    """Read a cylinder that bends."""
    begin = table.quantity("from", "m", -100.0, 100.0, LENGTH, required=True)
    end = table.quantity("to", "m", -100.0, 100.0, LENGTH, required=True)
    diameter = table.quantity("diameter", "m", 1e-5, 100.0, LENGTH, required=True)
    bore = table.quantity("bore", "m", 0.0, 100.0, LENGTH)
    modulus = table.quantity("youngs_modulus", "Pa", 1e8, 2e12, PRESSURE)
    ratio = table.number("poisson_ratio", 0.0, 0.499)
    density = table.quantity("density", "kg/m^3", 100.0, 25000.0, _DENSITY)
    table.close()
    if begin is None or end is None or diameter is None:
        return None
    return fields.built(
        table,
        lambda: Section(
            begin,
            end,
            diameter,
            bore or 0.0,
            STEEL.youngs_modulus if modulus is None else modulus,
            STEEL.poisson_ratio if ratio is None else ratio,
            STEEL.density if density is None else density,
        ),
    )


def _disc(table: Table) -> Disc | None:
    """Read a rigid part: mass and moments of inertia at a place, or a cylinder."""
    if "at" not in table and "mass" not in table:
        cylinder = fields.cylinder(table)
        return None if cylinder is None else Disc(cylinder.offset, dataclasses.replace(cylinder, offset=0.0))
    place = table.quantity("at", "m", -100.0, 100.0, LENGTH, required=True)
    mass = table.quantity("mass", "kg", 1e-6, 1e6, Display("kg"), required=True)
    polar = table.quantity("polar_inertia", "kg m^2", 1e-12, 1e6, _INERTIA, required=True)
    transverse = table.quantity("transverse_inertia", "kg m^2", 1e-12, 1e6, _INERTIA, required=True)
    table.close()
    if place is None or mass is None or polar is None or transverse is None:
        return None
    inertia = fields.built(table, lambda: Inertia(mass, polar, transverse))
    return None if inertia is None else Disc(place, inertia)
