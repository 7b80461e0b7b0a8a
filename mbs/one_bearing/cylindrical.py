"""`mbs bearing` of cylindrical rollers and needles, with maps and films: its row of the families.

The bearing is a designation, a shipped job, or a file.
"""

from __future__ import annotations

import argparse
import dataclasses
import os
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from ehdmaps.choices import STRUCTURE
from ehdmaps.errors import InputError, Problems
from ehdmaps.inputs import first_bytes, read_text
from ehdmaps.physics.bearing import BEARINGS, BearingGeometry
from ehdmaps.physics.catalogue import designated, designations
from ehdmaps.physics.designations.families import nearest
from ehdmaps.physics.designations.reader import ROLLERS, plain_name
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.rollers.needle_catalogue import needle_designations
from ehdmaps.physics.solids import Material
from ehdmaps.physics.surface import Surface
from ehdmaps.units import OF_JOBS, read_tolerances, short
from mbs.analyses.bearing_point import bearing_point
from mbs.bearings import laws
from mbs.bearings.bearing import MOST_COUPLED, Bearing
from mbs.bearings.bearing_force import BearingForce
from mbs.bearings.contact_report import BearingPoint
from mbs.bearings.films import FilmSource, FormulaFilms, MapFilms
from mbs.bearings.laws import Law
from mbs.bearings.thermal import BearingState, Mounting, operating_clearance
from mbs.one_bearing.family import Asked, AtSpeed, Family, Operating, Request
from mbs.one_bearing.shared import (
    assumed_clearance,
    read_profile_text,
    read_rings,
    read_whole,
)
from mbs.output.one_bearing.cylindrical import CYLINDRICAL, asperity_band
from mbs.output.one_bearing.kind import Points
from mbs.scene.choices import LACKS
from mbs.scene.contact_laws import TABLE_FORM, dry_words, read_law, table_path, table_problems
from mbs.scene.map_set import OTHER_OIL, TABLE_LAW, geometry_problems, structure_words
from mbs.scene.specs import BearingSpec
from mbs.scene.subject import opened_map

if TYPE_CHECKING:
    from ehdmaps.maps.emap import EHDMap

MOST_SLICES = 1000

MOST_SLICES_IN_ALL = 5_000_000
"""Of all rollers at all points: half a gigabyte."""

FORMULA_LOADS = (100.0, 1e8)
"""Loads for which the law of the formula is made [N/m]; far beyond 4 GPa in any bearing of steel."""


def _read(arguments: argparse.Namespace, chosen: Mapping[str, Any], problems: Problems) -> Asked | None:
    """The bearing with its map, clearance, profile, slices and the temperatures of its rings."""
    given: Asked | None = None
    with problems:
        given = read_given(arguments.bearing)
    emap = opened_map(chosen["map"], problems) if "map" in chosen else None
    law = chosen.get("law", TABLE_LAW)
    structure, of_table = chosen.get(STRUCTURE.name), law == TABLE_LAW and "map" not in chosen
    with problems:
        emap = _structured(emap, structure)
    if structure is not None and emap is None and not of_table and "map" not in chosen:
        problems.append(f"--{STRUCTURE.name}: got {structure} {LACKS['maps']}")
    if law == "map" and "map" not in chosen:
        problems.append("--law: got 'map' without a map; allowed: with --map MAP.nc, made by `ehdmaps generate`")
    if "map" in chosen and law in (*laws.FORMULAS, TABLE_LAW) and "law" in chosen:
        problems.append(f"--law: got {law!r} with a map; allowed: hertz or map with --map; leave one of the two out")
    if "map" in chosen and arguments.oil is not None:
        got = short(arguments.oil)
        problems.append(f"--oil: got {got} with a map, which was made for an oil; leave one of the two out")
    _refuse_axial(arguments, problems)
    before = len(problems)
    profile = read_profile_text(arguments.profile, given.geometry if given else None, problems)
    slices = read_whole("--slices", arguments.slices, 1, MOST_COUPLED if arguments.coupled else MOST_SLICES, problems)
    rings = read_rings(arguments, chosen, problems)
    if given is None:
        return None
    geometry, state = given.geometry, None
    open_to_all = geometry.clearance_range is not None or geometry.diametral_clearance == 0.0
    assumed = tuple(assumed_clearance(geometry, "clearance" in chosen)) if open_to_all else ()
    if "clearance" in chosen:
        with problems.after("--clearance: "):
            geometry = geometry.with_clearance(chosen["clearance"])
    if len(problems) == before and arguments.ring_temperatures is not None:
        warm = operating_clearance(geometry, Mounting(), *rings, given.material)
        state = BearingState("bearing", *rings, warm)
        geometry = dataclasses.replace(geometry, diametral_clearance=warm.operating)
    if emap is not None:
        problems += geometry_problems("the bearing", geometry, emap)
        given = given._replace(
            oil=emap.lubricant, supply=given.supply or emap.supply, surface=given.surface or emap.surface
        )
    options = {"profile": profile, "slices": slices, "slices_coupled": arguments.coupled}
    return given._replace(
        geometry=geometry, options=options, assumed=assumed, state=state, emap=emap, structure=structure
    )


def read_given(source: str) -> Asked:
    """The bearing of a name, a shipped job or a file.

    Parameters
    ----------
    source : str
        The argument.

    Raises
    ------
    InputError
        With what is wrong.
    """
    if source in BEARINGS:
        return Asked(BEARINGS[source], {})
    from ehdmaps.jobs.defaults import SHIPPED  # with the readers of all tables of a job

    problems = Problems()
    if source.lstrip().startswith("{"):
        from ehdmaps.jobs.table import inline

        values = inline(source, "BEARING", problems)
        problems.check()
        return _of_tables({"bearing": values}, "BEARING")
    is_file = "\0" not in source and os.path.isfile(source)
    if plain_name(source, ROLLERS) and not is_file and source not in SHIPPED:
        with problems.after("BEARING: "):
            return Asked(designated(source), {})
        problems.check()
    from ehdmaps.jobs.reader import shipped_jobs

    allowed = "a designation such as NU308 or NU210, or a TOML file with [bearing], such as a job"
    if source not in shipped_jobs() and not is_file:
        near = nearest(source, (*BEARINGS, *designations(), *needle_designations()))
        raise InputError(f"BEARING: got {short(source)}{near}; allowed: {allowed}")
    return _from_file(source)


def _from_file(source: str) -> Asked:
    """The bearing of a job, or of a file that holds no more than the bearing, material, oil, supply and surfaces."""
    from ehdmaps.jobs.reader import read_job, shipped_jobs

    if source not in shipped_jobs():
        alone = _alone(source)
        if alone is not None:
            return alone
    job = read_job(source)
    if job.bearing is None:
        raise InputError(f"{source}: is the job of a bare [contact]; allowed: one with [bearing]")
    material = job.contacts[0].material
    return Asked(job.bearing, {}, (), material, job.lubricant, job.supply, job.surface, tolerances=job.tolerances)


def _alone(source: str) -> Asked | None:
    """The bearing of a file without [grid] and [solver]; None for a job or a map, which have a reader of their own."""
    from ehdmaps.jobs import table
    from ehdmaps.jobs.reader import LONGEST_FILE

    allowed = "a TOML file with [bearing]"
    if first_bytes(source, 4, allowed).startswith((b"CDF", b"\x89HDF")):
        return None
    values = table.parse(read_text(source, LONGEST_FILE, allowed), source)
    return None if "grid" in values or "solver" in values else _of_tables(values, source)


def _of_tables(values: dict[str, Any], source: str) -> Asked:
    """The bearing of tables without [grid] and [solver]."""
    from ehdmaps.jobs.problem import read_contacts, read_lubricant
    from ehdmaps.jobs.reader import taken_out
    from ehdmaps.jobs.supply import read_supply, read_surface
    from ehdmaps.jobs.table import Table

    problems = Problems()
    values, typed = taken_out(values, problems)
    top = Table(values, "bearing file", problems)
    top.get("schema")
    geometry, contacts = read_contacts(top, "iso16281")
    section = top.table("lubricant", "[lubricant]")
    oil = read_lubricant(section) if section else None
    supply = top.optional("supply", "[supply]", read_supply)
    surface = top.optional("surface", "[surface]", read_surface)
    stated = top.optional("tolerances", "[tolerances]", lambda section: read_tolerances(section, OF_JOBS)) or {}
    top.close(others=("schema", "bearing", "material", "lubricant", "supply", "surface", "tolerances"))
    if geometry is None and not problems:
        problems.append("bearing file: has [contact]; allowed: [bearing] with a name or dimensions")
    if problems or geometry is None:
        raise InputError([f"{source}: {problem}" for problem in problems])
    return Asked(geometry, {}, (), contacts[0].material, oil, supply, surface, tolerances={**stated, **typed})


def _refuse_axial(arguments: argparse.Namespace, problems: Problems) -> None:
    """Note options that are for bearings that carry axial load."""
    given = [f"--{name}" for name in ("axial", "outer-speed") if getattr(arguments, name.replace("-", "_"), None)]
    given += ["--tilts"] * bool(getattr(arguments, "tilts", False))
    if given:
        from ehdmaps.physics.rollers.ribbed_geometry import NO_RIBS

        problems.append(
            f"{', '.join(given)}: got cylindrical rollers without --axial, or without ribs for it; {NO_RIBS}; leave "
            "it out"
        )


def _too_many(asked: Asked, operating: Operating) -> str:
    """A problem with the number of slices at all points; empty without one."""
    points, slices = len(operating.loads) * len(operating.speeds), asked.options["slices"]
    if asked.geometry.rolling_elements * slices * points <= MOST_SLICES_IN_ALL:
        return ""
    return (
        f"--slices: got {slices} for all rollers at {points} points; allowed: {MOST_SLICES_IN_ALL} slices in all; take "
        "fewer slices or points"
    )


def _structured(emap: EHDMap | None, structure: str | None) -> EHDMap | None:
    """The map by the structural law that was chosen."""
    if emap is None or structure is None:
        return emap
    problems = Problems()
    with problems.after(f"--{STRUCTURE.name}: "):
        return STRUCTURE.change(emap, structure)
    raise InputError(problems)


def _with_map(request: Request) -> Request:
    """The request with the map of the film table; a map from a file must be that of the bearing and its oil."""
    asked, emap = request.asked, request.asked.emap
    if emap is None and request.law != TABLE_LAW:
        return request
    if emap is not None and not request.trial:
        return request
    if emap is not None and not emap.from_table:
        wrong = geometry_problems("the bearing", asked.geometry, emap)
        if wrong := [*wrong, *([OTHER_OIL] if emap.lubricant != request.oil else [])]:
            raise InputError(wrong)
        return request
    # by default films that have to be solved are isothermal
    heat = emap.inlet_heat if emap is not None else request.conditions.inlet_heat if request.physics else None
    speeds, kelvin = request.operating.speeds, request.description.temperature
    made = _table_map(asked.geometry, request.oil, asked.material, speeds, kelvin, heat)
    return dataclasses.replace(request, asked=asked._replace(emap=_structured(made, asked.structure)))


def _table_map(
    geometry: BearingGeometry,
    oil: Lubricant,
    material: Material,
    speeds: Sequence[float],
    temperature: float,
    inlet_heat: bool | None,
) -> EHDMap:
    """Map in memory over the usual loads, and over the speeds [rad/s] and the temperature [K] that are asked for."""
    from ehdmaps.jobs.make.table_law import SPEEDS, table_map

    entrainment = [geometry.entrainment_speed(speed) for speed in speeds]
    turning = [u for u in entrainment if u > 0.0]
    slow, fast = (min(turning), max(turning)) if turning else SPEEDS
    return table_map(
        geometry.without_clearance,
        oil,
        entrainment_speeds=(slow if len(turning) == len(speeds) else min(slow, SPEEDS[0]), fast),
        temperatures=(temperature, temperature),
        material=material,
        inlet_heat=inlet_heat,
    )


def _words_of(request: Request) -> tuple[str, str]:
    """Law and films."""
    law, emap, oil = request.law, request.asked.emap, request.oil
    if law in ("map", TABLE_LAW) and emap is not None:
        heat = ", inlet heat" if emap.inlet_heat else ", isothermal"
        table = f"film table, {oil.title}{heat}" if emap.from_table else f"map of {oil.title}, solver {emap.solver}"
        words = table + structure_words(emap)
    elif (formula := laws.FORMULAS.get(law)) is not None:
        words = f"{formula.words}, {oil.title}{formula.remark}"
    else:
        words = dry_words(law)
    return words, _films(request).words


def _films(request: Request) -> FilmSource:
    """Pressures and films."""
    asked = request.asked
    if asked.emap is not None:
        return MapFilms(asked.emap, request.conditions.supply)
    return FormulaFilms(asked.geometry.contacts(asked.material, "iso16281"), request.oil, request.conditions.supply)


def _force(request: Request) -> BearingForce:
    """The force with the law over what is asked of it."""
    asked, options = request.asked, request.asked.options
    profile, slices, coupled = (options[name] for name in ("profile", "slices", "slices_coupled"))
    bearing = Bearing(asked.geometry, profile, slices, asked.material, coupled)
    return BearingForce(bearing, _law_of(request, bearing))


def _law_of(request: Request, bearing: Bearing) -> Law:
    """The law of a roller between both raceways."""
    law, emap, supply, surface = request.law, request.asked.emap, request.conditions.supply, request.conditions.surface
    if law in ("map", TABLE_LAW) and emap is not None:
        return emap.law("series", outside="clamp", supply=supply, surface=surface)
    if law in laws.FORMULAS:
        turning = [speed for speed in request.operating.speeds if speed > 0.0] or [1.0]
        u = [bearing.geometry.entrainment_speed(speed) for speed in (min(turning), max(turning))]
        kelvin = request.description.temperature
        return laws.formula(
            bearing,
            request.oil,
            load=FORMULA_LOADS,
            entrainment_speed=(u[0] / 1.1, u[1] * 1.1),
            temperature=(kelvin, kelvin + 2.0),
            damping=laws.FORMULAS[law].damping,
            outside="clamp",
            supply=supply,
            surface=surface,
        )
    if (path := table_path(law)) is not None:
        return read_law(path, bearing.geometry.roller_length)
    return laws.hertz(bearing, request.damper.constant, request.damper.time)


def _at_speed(request: Request) -> Callable[[float], AtSpeed]:
    """The force, whose law is that of all speeds."""
    at = AtSpeed(request.force, _films(request))
    return lambda speed: at


def _point(
    force: BearingForce,
    load: Sequence[float],
    speed: float,
    _: float,
    *,
    temperature: float,
    films: FilmSource,
    **__: Any,
) -> BearingPoint:
    """The point at a load across the axis."""
    return bearing_point(force, films, load[1:], speed, temperature)


def _beside(request: Request, points: Points) -> list[str]:
    """Lines on one point with the softest and with the stiffest usual asperities; none of smooth surfaces."""
    from mbs.one_bearing.request import points_of

    conditions = request.conditions
    if request.description.surface.smooth or len(points) * len(points[0]) > 1:
        return []

    def at(corner: Surface) -> BearingPoint:
        other = dataclasses.replace(request, conditions=dataclasses.replace(conditions, surface=corner))
        point: BearingPoint = (points if corner == conditions.surface else points_of(other))[0][0]
        return point

    return asperity_band([at(corner) for corner in conditions.surface.corners])


CYLINDERS = Family(
    kind=CYLINDRICAL,
    words="cylindrical roller bearing",
    taken=("law", "map", "physics", "structural-law", "supply", "roughness", "temperature", "clearance", "films"),
    own=("ring-temperatures", "profile", "slices", "coupled"),
    film_laws=(*laws.FORMULAS, TABLE_LAW, "map"),
    beside_laws=f"; {TABLE_FORM}",
    memory=(".fmu",),
    spec=BearingSpec,
    read=_read,
    wrong=_too_many,
    force=_force,
    words_of=_words_of,
    at_speed=_at_speed,
    point=_point,
    own_law=lambda law: None if table_path(law) is None else table_problems(law),
    finished=_with_map,
    beside=_beside,
)
"""Cylindrical roller bearings and needle bearings."""
