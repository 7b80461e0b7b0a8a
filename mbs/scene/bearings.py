"""Bearings of a scene: a table [[bearings]] is read, with heat and fits, and becomes an element."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from ehdmaps.jobs.problem import read_contacts
from ehdmaps.jobs.profiles import read_profile
from ehdmaps.jobs.supply import read_supply
from ehdmaps.jobs.table import Table
from ehdmaps.physics.bearing import BearingGeometry
from ehdmaps.physics.contact import OIL_TEMPERATURES
from ehdmaps.physics.designations.reader import ROLLERS, plain_name
from ehdmaps.physics.solids import STEEL, Material
from ehdmaps.units import LENGTH, PRESSURE, TEMPERATURE, Display, short
from mbs.bearings.bearing import MOST_COUPLED
from mbs.bearings.thermal import EXPANSIONS, STEEL_EXPANSION, GivenTemperatures, HeatPaths, Mounting, Seat
from mbs.scene import fields
from mbs.scene.fields import DEGREE, MICROMETRE
from mbs.scene.matrices import MatrixSpec, read_table_bearing
from mbs.scene.shafts.standing import read_rings
from mbs.scene.specs import RIB_KEYS, BearingSpec, LocatingSpec

if TYPE_CHECKING:
    from mbs.scene.surroundings import Built, Surroundings


CONDUCTANCE = Display("W/K")
POWER = Display("W")
EXPANSION = Display("1/K")

_MOST_CONDUCTANCE, _MOST_POWER = 1e6, 1e6
_TIGHTEST = 1e-3
_CONDUCTANCES = ("shaft", "housing", "oil_flow", "raceways_to_oil", "between_raceways")
_SURROUNDINGS = ("shaft_temperature", "housing_temperature", "oil_inlet")
_FRICTION = {"load_friction": 0.1, "palmgren": 100.0}


def read_thermal(section: Table) -> GivenTemperatures | HeatPaths | None:
    """Read `thermal` of a bearing: temperatures of its raceways, or where its heat goes; None if absent or wrong.

    Parameters
    ----------
    section : Table
        The table of the bearing.
    """
    table = section.table("thermal", f"{section.where} thermal")
    if table is None:
        return None
    before = len(section.problems)
    inner, outer = (table.quantity(key, "K", *OIL_TEMPERATURES, TEMPERATURE) for key in ("inner_ring", "outer_ring"))
    paths = {key: table.quantity(key, "W/K", 0.0, _MOST_CONDUCTANCE, CONDUCTANCE) for key in _CONDUCTANCES}
    around = {key: table.quantity(key, "K", *OIL_TEMPERATURES, TEMPERATURE) for key in _SURROUNDINGS}
    friction = {key: table.number(key, 0.0, largest) for key, largest in _FRICTION.items()}
    power = table.quantity("constant_power", "W", 0.0, _MOST_POWER, POWER)
    table.close()
    rings = [key for key in ("inner_ring", "outer_ring") if key in table]
    balance = [key for key in (*_CONDUCTANCES, *_SURROUNDINGS, *_FRICTION, "constant_power") if key in table]
    idle = [
        f"{temperature} without {path}"
        for path, temperature in zip(("shaft", "housing", "oil_flow"), _SURROUNDINGS, strict=True)
        if temperature in table and path not in table
    ]
    if rings and balance:
        table.note(
            "",
            f"got {', '.join(rings)} and {', '.join(balance)}; allowed: temperatures of the rings, or paths "
            "of heat from which they follow",
        )
    elif not rings and not balance:
        table.note("", "got nothing; allowed: inner_ring and outer_ring, or paths of heat: " + ", ".join(_CONDUCTANCES))
    elif idle:
        table.note("", f"got {', '.join(idle)}; allowed: a temperature of what has a path of heat")
    if len(section.problems) > before:
        return None
    if rings:
        return GivenTemperatures(inner, outer)
    values = {**paths, **around, **friction, "constant_power": power}
    given = {key: value for key, value in values.items() if value is not None}
    return fields.built(table, lambda: HeatPaths(**given))


def read_mounting(section: Table) -> Mounting | None:
    """Read `fit` and `expansion` of a bearing; None if both are absent, or wrong.

    Parameters
    ----------
    section : Table
        The table of the bearing.
    """
    expansion = _expansion(section)
    if "expansion" in section and "fit" not in section and "thermal" not in section:
        section.note("expansion", "has no effect; allowed: with thermal or fit")
    table = section.table("fit", f"{section.where} fit")
    if table is None:
        return None if expansion is None else Mounting(expansion=expansion)
    shaft = _seat(table, "inner", "bore", required=False)
    housing = _seat(table, "outer", "diameter", required=True)
    if "inner" not in table and "outer" not in table:
        table.note("", "got nothing; allowed: inner = { interference, seat }, outer = { interference, seat, diameter }")
    table.close()
    return Mounting(shaft, housing, STEEL_EXPANSION if expansion is None else expansion)


def _seat(fit: Table, key: str, far: str, *, required: bool) -> Seat | None:
    """Read the seat of a ring; `far` is the key of the bore of a shaft, or of the outside of a housing."""
    table = fit.table(key, f"{fit.where} {key}")
    if table is None:
        return None
    interference = table.quantity("interference", "m", -_TIGHTEST, _TIGHTEST, MICROMETRE, required=True)
    seat = table.quantity("seat", "m", 1e-5, 100.0, LENGTH, required=True)
    far_diameter = table.quantity(far, "m", 0.0, 100.0, LENGTH, required=required)
    modulus = table.quantity("youngs_modulus", "Pa", 1e6, 1e13, PRESSURE)
    ratio = table.number("poisson_ratio", -0.99, 0.499)
    expansion = _expansion(table)
    table.close()
    if interference is None or seat is None or (required and far_diameter is None):
        return None
    material = Material(
        STEEL.youngs_modulus if modulus is None else modulus, STEEL.poisson_ratio if ratio is None else ratio
    )
    return Seat(interference, seat, far_diameter or 0.0, material, STEEL_EXPANSION if expansion is None else expansion)


def _expansion(table: Table) -> float | None:
    """Read a coefficient of thermal expansion."""
    return table.quantity("expansion", "1/K", *EXPANSIONS, EXPANSION)


def read_bearing(section: Table, name: str) -> BearingSpec | LocatingSpec | MatrixSpec | None:
    """Read a bearing of rollers or balls, or one by matrices with kind = "table"; None where a problem was noted.

    Parameters
    ----------
    section : Table
        The table; the caller closes it.
    name : str
        Name of the bearing.
    """
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
    memory = surroundings.laws.memory == "memory"
    kind = BearingElement
    if memory and not spec.rollers_as_bodies:
        from mbs.bearings.memory_element import MemoryBearing

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
        source=surroundings.laws.films(bearing, supply),
    )
    if not spec.rollers_as_bodies:
        return Built(plain, plain)
    from mbs.bearings.roller_contacts import RollerContacts
    from mbs.bearings.roller_element import RollerElement, roller_body

    body = roller_body(f"{spec.name}_rollers", bearing)
    contacts = RollerContacts(bearing, *laws.single)
    if not memory:
        return Built(RollerElement(plain, contacts, body.name), plain, (body,))
    from mbs.bearings.memory_element import MemoryRollers

    return Built(MemoryRollers(plain, contacts, body.name), plain, (body,))
