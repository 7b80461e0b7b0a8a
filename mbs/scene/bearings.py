"""Bearings of a scene: a table [[bearings]] is read, and becomes an element of the system."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ehdmaps.jobs.problem import read_contacts
from ehdmaps.jobs.supply import read_supply
from ehdmaps.jobs.table import Table
from ehdmaps.units import short
from mbs.bearings.bearing import MOST_COUPLED
from mbs.scene import fields
from mbs.scene.fields import DEGREE
from mbs.scene.matrices import MatrixSpec, read_table_bearing
from mbs.scene.profiles import read_profile
from mbs.scene.specs import BearingSpec
from mbs.scene.thermal import read_mounting, read_thermal

if TYPE_CHECKING:
    from mbs.scene.surroundings import Built, Surroundings


def read_bearing(section: Table, name: str) -> BearingSpec | MatrixSpec | None:
    """Read a bearing of rollers, or one by matrices with kind = "table"; None where a problem was noted.

    Parameters
    ----------
    section : Table
        The table; the caller closes it.
    name : str
        Name of the bearing.
    """
    if section.choice("kind", ("rollers", "table")) == "table":
        return read_table_bearing(section, name)
    inner, outer = fields.place(section, "inner"), fields.place(section, "outer")
    given = section.get("geometry", required='{ name = "NU308" } or dimensions, as [bearing] of a job file')
    problems: list[str] = []
    geometry = None
    if "geometry" in section:
        geometry, _ = read_contacts(Table({"bearing": given}, "geometry", problems), None)
    for problem in problems:
        section.note("geometry", problem.removeprefix("[bearing] ").removeprefix("[bearing]: "))
    profile = read_profile(section, geometry)
    slices = section.integer("slices", 1, 10000) or 41
    angle = section.quantity("start_angle", "rad", -7.0, 7.0, DEGREE) or 0.0
    rollers = section.choice("rollers", ("massless", "bodies")) or "massless"
    centrifugal = section.get("centrifugal")
    if "centrifugal" in section and not isinstance(centrifugal, bool):
        section.note("centrifugal", f"got {short(centrifugal)}; allowed: true, false")
    coupled = section.get("slices_coupled")
    if "slices_coupled" in section and not isinstance(coupled, bool):
        section.note("slices_coupled", f"got {short(coupled)}; allowed: true, false")
    elif coupled and rollers == "bodies":
        section.note("slices_coupled", "got true with rollers = 'bodies'; allowed: with rollers = 'massless'")
    elif coupled and slices > MOST_COUPLED:
        section.note("slices", f"got {slices} with slices_coupled; allowed: at most {MOST_COUPLED}")
    thermal, mounting = read_thermal(section), read_mounting(section)
    supply = section.optional("supply", f"{section.where} supply", read_supply)
    if inner is None or outer is None or geometry is None:
        return None
    return BearingSpec(
        name,
        inner,
        outer,
        geometry,
        profile,
        slices,
        angle,
        rollers == "bodies",
        centrifugal is True,
        thermal,
        mounting,
        supply,
        coupled is True,
    )


def bearing_problems(spec: BearingSpec, surroundings: Surroundings) -> list[str]:
    """What is wrong about a bearing: the map in force is not its own, or it has one body only.

    Parameters
    ----------
    spec : BearingSpec
        The bearing.
    surroundings : Surroundings
        What it is built into.
    """
    problems = surroundings.laws.bearing_problems(spec.name, spec.geometry)
    if spec.inner.partition(":")[0] == spec.outer.partition(":")[0]:
        problems.append(f"bearing {spec.name!r}: got {spec.inner} and {spec.outer}; allowed: rings on two bodies")
    if spec.mounting is not None:
        problems += [f"bearing {spec.name!r}, {found}" for found in spec.mounting.problems(spec.geometry)]
    return problems


def build_bearing(spec: BearingSpec, surroundings: Surroundings) -> Built:
    """The element of a bearing, with a body of its rollers where they are bodies.

    Parameters
    ----------
    spec : BearingSpec
        The bearing; its places exist.
    surroundings : Surroundings
        What it is built into.

    Raises
    ------
    InputError
        With every value that no bearing has.
    """
    from mbs.bearings.bearing import Bearing
    from mbs.bearings.bearing_element import BearingElement
    from mbs.bearings.bearing_force import BearingForce
    from mbs.scene.surroundings import Built

    bearing = Bearing(spec.geometry, spec.profile, spec.slices, coupled=spec.slices_coupled)
    laws = surroundings.laws.of(bearing, surroundings.laws.supply(spec))
    memory = surroundings.laws.memory == "memory"
    kind = BearingElement
    if memory and not spec.rollers_as_bodies:
        from mbs.bearings.bearing_element import MemoryBearing

        kind = MemoryBearing
    plain = kind(
        name=spec.name,
        inner=spec.inner,
        outer=spec.outer,
        bearing=bearing,
        force=BearingForce(bearing, laws.series),
        temperature=surroundings.temperature,
        inner_spin=surroundings.places.spin(spec.inner),
        outer_spin=surroundings.places.spin(spec.outer),
        start_angle=spec.start_angle,
        centrifugal=spec.centrifugal,
    )
    if not spec.rollers_as_bodies:
        return Built(plain, plain)
    from mbs.bearings.bearing_element import RollerElement, roller_body
    from mbs.bearings.roller_contacts import RollerContacts

    body = roller_body(f"{spec.name}_rollers", bearing)
    contacts = RollerContacts(bearing, *laws.single)
    if not memory:
        return Built(RollerElement(plain, contacts, body.name), plain, (body,))
    from mbs.bearings.bearing_element import MemoryRollers

    return Built(MemoryRollers(plain, contacts, body.name), plain, (body,))
