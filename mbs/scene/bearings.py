"""Bearings of a scene: a table [[bearings]] is read, with heat and fits, and becomes an element."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from ehdmaps.jobs.problem import read_contacts
from ehdmaps.jobs.profiles import read_profile
from ehdmaps.jobs.supply import read_supply
from ehdmaps.jobs.table import Table
from ehdmaps.physics.bearing import BearingGeometry
from ehdmaps.physics.designations.reader import ROLLERS, plain_name
from ehdmaps.units import short
from mbs.bearings.bearing import MOST_COUPLED
from mbs.scene.fields import DEGREE, MICROMETRE
from mbs.scene.matrices import MatrixSpec, read_table_bearing
from mbs.scene.shafts.standing import read_rings
from mbs.scene.specs import RIB_KEYS, BearingSpec, LocatingSpec

if TYPE_CHECKING:
    from mbs.scene.surroundings import Built, Surroundings


def read_bearing(section: Table, name: str) -> BearingSpec | LocatingSpec | MatrixSpec | None:
    """Read a bearing, see `_perfect`, with deviations from its form.

    Parameters
    ----------
    section : Table
        The table; the caller closes it.
    name : str
        Name of the bearing.
    """
    spec = _perfect(section, name)
    stated = [key in section for key in ("waviness", "size_difference", "spall")]
    if not any(stated):
        return spec
    from mbs.scene.locating.deviations import read_deviations  # with what few scenes state

    deviating: BearingSpec | LocatingSpec | MatrixSpec | None = read_deviations(section, spec)
    return deviating


def _perfect(section: Table, name: str) -> BearingSpec | LocatingSpec | MatrixSpec | None:
    """Read a bearing of rollers or balls, or one by matrices with kind = "table"; None where a problem was noted."""
    if section.choice("kind", ("rollers", "table")) == "table":
        return read_table_bearing(section, name)
    stated = section.get("geometry")
    named = stated.get("name") if isinstance(stated, Mapping) else stated
    of_rollers = isinstance(named, str) and bool(plain_name(named, ROLLERS))
    if "bearing" in section or not of_rollers:  # catalogues of others are loaded where they may be meant
        from mbs.scene.locating.reading import reader_of

        if (read := reader_of(section)) is not None:
            return read(section, name)
    inner, outer = read_rings(section, name)
    geometry = _geometry(section)
    profile = read_profile(section, geometry)
    slices = section.integer("slices", 1, 10000) or 41
    angle = section.quantity("start_angle", "rad", -7.0, 7.0, DEGREE) or 0.0
    rollers = section.choice("rollers", ("massless", "bodies")) or "massless"
    centrifugal, coupled = section.flag("centrifugal"), section.flag("slices_coupled")
    if coupled and rollers == "bodies":
        section.note("slices_coupled", "got true with rollers = 'bodies'; allowed: with rollers = 'massless'")
    elif coupled and slices > MOST_COUPLED:
        section.note("slices", f"got {slices} with slices_coupled; allowed: at most {MOST_COUPLED}")
    pocket = section.quantity("pocket_clearance", "m", 1e-6, 0.01, MICROMETRE)
    thermal = mounting = None
    if any(key in section for key in ("thermal", "fit", "expansion")):
        from mbs.scene.locating.mounting import read_mounting, read_thermal  # with what few scenes state

        thermal, mounting = read_thermal(section), read_mounting(section)
    supply = section.optional("supply", f"{section.where} supply", read_supply)
    if inner is None or outer is None or geometry is None:
        for key in RIB_KEYS:
            section.get(key)
        return None
    spec = BearingSpec(
        name,
        inner,
        outer,
        geometry,
        profile,
        slices,
        angle,
        rollers == "bodies",
        centrifugal,
        thermal,
        mounting,
        supply,
        coupled,
        pocket,
    )
    if not (isinstance(section.get("bearing"), str) or any(key in section for key in RIB_KEYS)):
        return spec
    from mbs.scene.locating.ribs import read_ribs

    return read_ribs(section, spec)


def _geometry(section: Table) -> BearingGeometry | None:
    """Read `bearing`, a designation with its clearance, or `geometry`; None where a problem was noted."""
    key, given = "geometry", section.get("geometry")
    if "bearing" in section:
        designation = section.get("bearing")
        if "geometry" in section:
            section.note("geometry", "stands beside bearing; allowed: one of the two; delete one")
        if not isinstance(designation, str):
            section.note("bearing", f'got {short(designation)}; allowed: a designation such as "NU210"')
            return None
        key, given = "bearing", {"name": designation}
        if "diametral_clearance" in section:
            given["diametral_clearance"] = section.get("diametral_clearance")
    elif "geometry" not in section:
        section.note(
            "bearing", 'missing; allowed: a designation such as "NU210"; or geometry, as [bearing] of a job file'
        )
        return None
    elif isinstance(given, str):
        given = {"name": given}
    problems: list[str] = []
    geometry, _ = read_contacts(Table({"bearing": given}, "geometry", problems), None)
    for problem in problems:
        plain = problem.removeprefix("[bearing] ").removeprefix("[bearing]: ")
        section.note(key, plain.removeprefix("name: bearing designation: "))
    return geometry


def bearing_problems(spec: BearingSpec, surroundings: Surroundings) -> list[str]:
    """Problems with a bearing: the map in force is not its own, or it has one body only.

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

    bearing = Bearing(
        spec.geometry,
        spec.profile,
        spec.slices,
        coupled=spec.slices_coupled,
        pocket_clearance=spec.pocket_clearance,
    )
    supply = surroundings.laws.supply(spec)
    laws = surroundings.laws.of(bearing, supply)
    films = surroundings.laws.memory
    plain = BearingElement(
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
        films="slow" if spec.rollers_as_bodies else films,
        source=surroundings.laws.films(bearing, supply),
        deviations=spec.deviations,
    )
    if not spec.rollers_as_bodies:
        return Built(plain, plain)
    from mbs.bearings.roller_contacts import RollerContacts
    from mbs.bearings.roller_element import RollerElement, roller_body

    body = roller_body(f"{spec.name}_rollers", bearing)
    return Built(RollerElement(plain, RollerContacts(bearing, *laws.single), body.name, films), plain, (body,))
