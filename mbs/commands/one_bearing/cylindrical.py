"""`mbs bearing` of cylindrical rollers and needles: its options, with maps and films; every problem at once.

The bearing argument of `mbs bearing` of cylindrical rollers: a designation, a shipped job, or a file.
"""

from __future__ import annotations

import argparse
import dataclasses
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

from ehdmaps.choices import STRUCTURE
from ehdmaps.errors import EhdmapsError, InputError
from ehdmaps.outputs import FIGURE, Output, output_problems
from ehdmaps.physics.bearing import BEARINGS, BearingGeometry
from ehdmaps.physics.contact import OIL_TEMPERATURES
from ehdmaps.physics.designations.reader import ROLLERS, plain_name
from ehdmaps.physics.lubricant import DEFAULT_OIL, Lubricant
from ehdmaps.physics.oil_supply import FLOODED, OilSupply
from ehdmaps.physics.rollers.ribbed_geometry import NO_RIBS
from ehdmaps.physics.solids import STEEL, Material
from ehdmaps.physics.surface import SMOOTH, CrownedProfile, Surface, TabulatedProfile
from ehdmaps.units import TEMPERATURE, closest, short
from mbs.analyses.bearing_point import bearing_points
from mbs.bearings import laws
from mbs.bearings.bearing import MOST_COUPLED, Bearing
from mbs.bearings.contact_report import BearingPoint
from mbs.bearings.films import SIDES, FilmSource, FormulaFilms, MapFilms
from mbs.bearings.laws import Law
from mbs.bearings.thermal import BearingState, Mounting, operating_clearance
from mbs.commands.one_bearing.bands import NAME, point_bands, scene_of, turned
from mbs.commands.one_bearing.shared import (
    CELSIUS_40,
    ROUGHNESS,
    Given,
    assumed_clearance,
    read_choices,
    read_heat,
    read_oil,
    read_one,
    read_operating,
    read_profile_text,
    read_whole,
)
from mbs.output.files import result_kind
from mbs.output.one_bearing.cylindrical import CYLINDRICAL, asperity_band
from mbs.output.one_bearing.kind import Description, Points
from mbs.scene.choices import LACKS
from mbs.scene.contact_laws import (
    HERTZ_FORMS,
    TABLE_FORM,
    Damper,
    dry_words,
    hertz_damper,
    read_law,
    table_path,
    table_problems,
)
from mbs.scene.fields import MICROMETRE
from mbs.scene.map_set import OTHER_OIL, TABLE_LAW, geometry_problems, structure_words
from mbs.scene.scene import Scene
from mbs.scene.specs import BearingSpec
from mbs.unknowns.looks import Band

if TYPE_CHECKING:
    from ehdmaps.maps.emap import EHDMap

import os

from ehdmaps.inputs import first_bytes, read_text
from ehdmaps.physics.catalogue import designated, designations
from ehdmaps.physics.rollers.needle_catalogue import needle_designations


def read_given(source: str, problems: list[str]) -> Given | None:
    """The bearing of a name, a shipped job or a file; None where a problem was noted.

    Parameters
    ----------
    source : str
        The argument.
    problems : list of str
        List that takes what is wrong.
    """
    from ehdmaps.jobs.defaults import SHIPPED  # with the readers of all tables of a job

    is_file = "\0" not in source and os.path.isfile(source)
    if plain_name(source, ROLLERS) and not is_file and source not in SHIPPED:
        try:
            return Given(designated(source), STEEL)
        except InputError as error:
            problems += [f"BEARING: {problem}" for problem in error.problems]
            return None
    from ehdmaps.jobs.reader import shipped_jobs

    allowed = "a designation such as NU308 or NU210, or a TOML file with [bearing], such as a job"
    if source not in shipped_jobs() and not is_file:
        near = closest(source.upper(), (*BEARINGS, *designations(), *needle_designations()))
        problems.append(f"BEARING: got {short(source)}{near}; allowed: {allowed}")
        return None
    try:
        return _from_file(source)
    except InputError as error:
        problems += error.problems
        return None


def _from_file(source: str) -> Given:
    """The bearing of a job, or of a file that holds no more than the bearing, material, oil, supply and surfaces."""
    from ehdmaps.jobs.reader import read_job, shipped_jobs

    if source not in shipped_jobs():
        alone = _alone(source)
        if alone is not None:
            return alone
    job = read_job(source)
    if job.bearing is None:
        raise InputError(f"{source}: is the job of a bare [contact]; allowed: one with [bearing]")
    return Given(job.bearing, job.contacts[0].material, job.lubricant, job.supply, job.surface)


def _alone(source: str) -> Given | None:
    """The bearing of a file without [grid] and [solver]; None for a job or a map, which have a reader of their own."""
    from ehdmaps.jobs import table
    from ehdmaps.jobs.problem import read_contacts, read_lubricant
    from ehdmaps.jobs.reader import LONGEST_FILE
    from ehdmaps.jobs.supply import read_supply, read_surface
    from ehdmaps.jobs.table import Table

    allowed = "a TOML file with [bearing]"
    if first_bytes(source, 4, allowed).startswith((b"CDF", b"\x89HDF")):
        return None
    values = table.parse(read_text(source, LONGEST_FILE, allowed), source)
    if "grid" in values or "solver" in values:
        return None
    problems: list[str] = []
    top = Table(values, "bearing file", problems)
    top.get("schema")
    geometry, contacts = read_contacts(top, "iso16281")
    section = top.table("lubricant", "[lubricant]")
    oil = read_lubricant(section) if section else None
    supply = top.optional("supply", "[supply]", read_supply)
    surface = top.optional("surface", "[surface]", read_surface)
    top.close(others=("schema", "bearing", "material", "lubricant", "supply", "surface"))
    if geometry is None and not problems:
        problems.append("bearing file: has [contact]; allowed: [bearing] with a name or dimensions")
    if problems or geometry is None:
        raise InputError([f"{source}: {problem}" for problem in problems])
    return Given(geometry, contacts[0].material, oil, supply, surface)


LAWS = ("hertz", "formula", TABLE_LAW, "map")

MOST_SLICES = 1000

MOST_SLICES_IN_ALL = 5_000_000
"""Of all rollers at all points: half a gigabyte."""

FORMULA_LOADS = (100.0, 1e8)
"""Loads for which the law of the formula is made [N/m]; far beyond 4 GPa in any bearing of steel."""


@dataclass(frozen=True, eq=False)
class BearingRequest:
    """Request to be answered.

    Attributes
    ----------
    bearing : Bearing
        Geometry with its clearance, profile, slices.
    law : str
        Law of the contacts: hertz, hertz:TIME, hertz:DAMPING, table:FILE, formula or map.
    emap : EHDMap or None
        The map.
    oil : Lubricant
        The oil.
    supply : OilSupply
        Oil supply of the contacts.
    surface : Surface
        Surfaces of the contacts, smooth where the roughness is only assumed.
    films : FilmSource
        Pressures and films.
    loads : tuple of float
        Sizes of the load on the inner ring [N].
    direction : (float, float)
        Direction of the load, y and z; a unit vector.
    speeds : tuple of float
        Speeds of the inner ring [rad/s].
    temperature, roughness : float
        Mean temperature of both raceways, which the law takes [K]; [m].
    description : Description
        The same in words.
    """

    bearing: Bearing
    law: str
    emap: EHDMap | None
    oil: Lubricant
    supply: OilSupply
    surface: Surface
    films: FilmSource
    loads: tuple[float, ...]
    direction: tuple[float, float]
    speeds: tuple[float, ...]
    temperature: float
    roughness: float
    description: Description

    @property
    def load_vectors(self) -> list[tuple[float, float]]:
        """Loads on the inner ring, y and z [N]."""
        return [(load * self.direction[0], load * self.direction[1]) for load in self.loads]

    def points(self) -> list[list[BearingPoint]]:
        """Points by load, then by speed."""
        law, loads = law_of(self), self.load_vectors
        return bearing_points(self.bearing, law, self.films, loads, self.speeds, self.temperature)

    @property
    def scene(self) -> Scene:
        """The bearing as the only one of a scene, to ask what is not known of it."""
        bearing = self.bearing
        # profiles of requests are those of scenes
        profile = cast("str | CrownedProfile | TabulatedProfile", bearing.profile)
        spec = BearingSpec(NAME, "", "", bearing.geometry, profile, bearing.slices)
        return scene_of(spec, self.oil, self.description)

    def again(self, scene: Scene) -> BearingRequest:
        """The same request of a scene that is a little different; a map from a file stays what it is.

        Raises
        ------
        InputError
            For a map from a file that was made for other rollers, and where heat is stated of the rings.
        """
        (spec,) = scene.bearings
        bearing = dataclasses.replace(self.bearing, geometry=spec.geometry, profile=spec.profile)
        oil, emap, kelvin = scene.lubricant or self.oil, self.emap, scene.temperature
        if emap is not None and emap.from_table:
            structure = emap.structural_law
            made = _table_map(spec.geometry, oil, bearing.material, self.speeds, kelvin, emap.inlet_heat)
            emap = made.with_structure(structure)
        elif emap is not None:
            wrong = geometry_problems("the bearing", spec.geometry, emap)
            if wrong := [*wrong, *([OTHER_OIL] if scene.lubricant != self.oil else [])]:
                raise InputError(wrong)
        contacts = spec.geometry.contacts(bearing.material, "iso16281")
        return dataclasses.replace(
            self,
            bearing=bearing,
            emap=emap,
            oil=oil,
            films=MapFilms(emap, self.supply) if emap is not None else FormulaFilms(contacts, oil, self.supply),
            direction=turned(self.direction, spec.start_angle),
            temperature=kelvin,
            description=dataclasses.replace(self.description, oil=oil, temperature=kelvin),
        )

    def bands(self, points: Points) -> dict[str, Band]:
        """Bands of what is not known of a single point, by the names of its numbers; none of several.

        Parameters
        ----------
        points : sequence of sequence
            Points by load, then by speed.
        """
        if len(self.loads) * len(self.speeds) > 1 or points[0][0].failed:
            return {}

        def again(scene: Scene) -> tuple[Description, BearingPoint]:
            other = self.again(scene)
            return other.description, other.points()[0][0]

        return point_bands(CYLINDRICAL, self.description, points[0][0], self.scene, again)

    def beside(self, points: Points) -> list[str]:
        """Lines on one point with the softest and with the stiffest usual asperities; none of smooth surfaces.

        Parameters
        ----------
        points : sequence of sequence
            Points by load, then by speed.
        """
        if self.description.surface.smooth or len(self.loads) * len(self.speeds) > 1:
            return []
        corners = self.surface.corners
        return asperity_band(
            [
                (points if corner == self.surface else dataclasses.replace(self, surface=corner).points())[0][0]
                for corner in corners
            ]
        )


def read_request(arguments: argparse.Namespace) -> BearingRequest:
    """Read the bearing, the map and all options.

    Raises
    ------
    InputError
        With every problem.
    """
    problems: list[str] = []
    given = _given(arguments.bearing, problems)
    chosen = read_choices(arguments, problems)
    if "films" in chosen:
        problems.append("--films: not for one bearing of rollers, whose K and C are those of slow motion; leave it out")
    emap = _map(chosen.get("map"), problems)
    law = _law(chosen.get("law"), "map" in chosen, problems)
    emap = _structured(emap, law, chosen, problems)
    _refuse_axial(arguments, problems)
    asked = read_operating(arguments, problems, axial=False)
    points = len(asked.loads) * len(asked.speeds)
    if _all_slices(given, arguments.slices) * points > MOST_SLICES_IN_ALL:
        problems.append(
            f"--slices: got {short(arguments.slices)} for all rollers at {points} points; allowed: "
            f"{MOST_SLICES_IN_ALL} slices in all; take fewer slices or points"
        )
    around = chosen.get("temperature", CELSIUS_40)
    inner, outer = (
        read_one(
            f"--{side}-ring-temperature",
            getattr(arguments, f"{side}_ring_temperature"),
            "K",
            OIL_TEMPERATURES,
            TEMPERATURE,
            around,
            problems,
        )
        for side in SIDES
    )
    temperature = 0.5 * (inner + outer)
    if "temperature" in chosen and None not in (arguments.inner_ring_temperature, arguments.outer_ring_temperature):
        problems.append(
            f"--temperature: got {TEMPERATURE.text(around)} with --inner-ring-temperature and "
            "--outer-ring-temperature; allowed: two of the three; it is that of a ring that has none"
        )
    stated = _surface(given, emap)
    surface = dataclasses.replace(stated, roughness=chosen["roughness"].roughness) if "roughness" in chosen else stated
    roughness = ROUGHNESS if surface.smooth else surface.roughness
    bearing = _sliced(given, chosen.get("clearance"), arguments, problems)
    state = None
    if bearing is not None and (arguments.inner_ring_temperature, arguments.outer_ring_temperature) != (None, None):
        warm = operating_clearance(bearing.geometry, Mounting(), inner, outer, bearing.material)
        state = BearingState("bearing", inner, outer, warm)
        geometry = dataclasses.replace(bearing.geometry, diametral_clearance=warm.operating)
        bearing = dataclasses.replace(bearing, geometry=geometry)
    if bearing is not None and emap is not None:
        problems += geometry_problems("the bearing", bearing.geometry, emap)
    oil = _oil(arguments.oil, given, emap, "map" in chosen, temperature, problems)
    lack = "" if law == TABLE_LAW else f"without films of the film table; allowed: with --law {TABLE_LAW}"
    heat = read_heat(chosen, oil, lack, problems)
    stated_supply = None if given is None else given.supply
    supply = chosen.get("supply") or stated_supply or (FLOODED if emap is None else emap.supply)
    outputs = (
        Output("-o", arguments.output, result_kind(arguments.output)),
        Output("--plot", arguments.plot, FIGURE),
    )
    read = (arguments.bearing, chosen.get("map"), table_path(law))
    beside = _elsewhere(arguments)
    wrong = output_problems(outputs, [path for path in read if path])
    problems += [problem + beside if problem.startswith("-o: ") else problem for problem in wrong]
    if problems or bearing is None or given is None or oil is None:
        raise InputError(tuple(dict.fromkeys(problems)))
    if law == TABLE_LAW:
        made = _table_map(bearing.geometry, oil, given.material, asked.speeds, temperature, heat)
        law, emap = "map", _structured(made, "map", chosen, problems)
        if problems:
            raise InputError(problems)
    contacts = bearing.geometry.contacts(given.material, "iso16281")
    films = MapFilms(emap, supply) if emap is not None else FormulaFilms(contacts, oil, supply)
    return BearingRequest(
        bearing=bearing,
        law=law,
        emap=emap,
        oil=oil,
        supply=supply,
        surface=surface,
        films=films,
        loads=asked.loads,
        direction=asked.way,
        speeds=asked.speeds,
        temperature=temperature,
        roughness=roughness,
        description=Description(
            law=_law_words(law, emap, oil),
            films=films.words + ("" if oil.verified else " (unverified data of the oil)"),
            supply=supply,
            surface=surface if law in ("map", "formula") else SMOOTH,
            oil=oil,
            direction=math.degrees(math.atan2(asked.way[1], asked.way[0])),
            temperature=temperature,
            roughness=roughness,
            tilts=False,
            assumed=_assumed(arguments, chosen, given, surface),
            state=state,
            known=chosen.get("know", ()),
        ),
    )


def _given(source: str, problems: list[str]) -> Given | None:
    """The bearing of a name, a shipped job or a file."""
    if source in BEARINGS:
        return Given(BEARINGS[source], STEEL)

    return read_given(source, problems)


def _elsewhere(arguments: argparse.Namespace) -> str:
    """Command that writes a bearing of rollers where -o has a file of balls alone; empty for other files."""
    ending = Path(arguments.output or "").suffix.lower()
    if ending not in (".c", ".fmu"):
        return ""
    return f"; a bearing of rollers as {ending}: `ehdmaps export BEARING --to {ending[1:]}`"


def _refuse_axial(arguments: argparse.Namespace, problems: list[str]) -> None:
    """Note options that are for ball bearings."""
    given = [f"--{name}" for name in ("axial", "outer-speed") if getattr(arguments, name.replace("-", "_"), None)]
    given += ["--tilts"] * bool(getattr(arguments, "tilts", False))
    if given:
        problems.append(
            f"{', '.join(given)}: got cylindrical rollers without --axial, or without ribs for it; {NO_RIBS}; leave "
            "it out"
        )


def _all_slices(given: Given | None, slices: str) -> int:
    """Slices of all rollers of a bearing; 0 where either is wrong."""
    return given.geometry.rollers * int(slices) if given is not None and slices.isdecimal() and len(slices) < 10 else 0


def _surface(given: Given | None, emap: EHDMap | None) -> Surface:
    """Surfaces that file or map state, the file first."""
    if given is not None and given.surface is not None:
        return given.surface
    return SMOOTH if emap is None else emap.surface


def _assumed(
    arguments: argparse.Namespace, chosen: Mapping[str, Any], given: Given, surface: Surface
) -> tuple[str, ...]:
    """Values that were not given, in words."""
    found = []
    if "temperature" not in chosen and None in (arguments.inner_ring_temperature, arguments.outer_ring_temperature):
        found.append(f"temperature {TEMPERATURE.text(CELSIUS_40)}")
    if surface.smooth:
        found.append(f"combined rms roughness {MICROMETRE.text(ROUGHNESS)} (for Lambda only)")
    if given.geometry.clearance_range is not None or given.geometry.diametral_clearance == 0.0:
        found += assumed_clearance(given.geometry, "clearance" in chosen)
    if arguments.oil is None and given.oil is None and "map" not in chosen:
        found.append(f"oil {DEFAULT_OIL}")
    return tuple(found)


def _table_map(
    geometry: BearingGeometry,
    oil: Lubricant,
    material: Material,
    speeds: Sequence[float],
    temperature: float,
    inlet_heat: bool,
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


def _law_words(law: str, emap: EHDMap | None, oil: Lubricant) -> str:
    """The law, for people."""
    if law == "map" and emap is not None and emap.from_table:
        return f"film table, {oil.title}{', inlet heat' if emap.inlet_heat else ''}{structure_words(emap)}"
    if law == "map" and emap is not None:
        return f"map of {oil.title}, solver {emap.solver}{structure_words(emap)}"
    words = f"film formula moes, {oil.title} (its damping is far too low for loaded contacts)"
    return words if law == "formula" else dry_words(law)


def _sliced(
    given: Given | None, clearance: float | None, arguments: argparse.Namespace, problems: list[str]
) -> Bearing | None:
    """The bearing with clearance, profile and slices; without the last three where they are wrong."""
    before = len(problems)
    profile = read_profile_text(arguments.profile, given.geometry if given else None, problems)
    slices = read_whole("--slices", arguments.slices, 1, MOST_COUPLED if arguments.coupled else MOST_SLICES, problems)
    if given is None:
        return None
    geometry = given.geometry
    if clearance is not None:
        try:
            geometry = geometry.with_clearance(clearance)
        except InputError as error:
            problems += [f"--clearance: {problem}" for problem in error.problems]
    if len(problems) > before:
        return Bearing(given.geometry, "iso", 41, given.material)
    return Bearing(geometry, profile, slices, given.material, arguments.coupled)


def _map(path: str | None, problems: list[str]) -> EHDMap | None:
    """The map."""
    if path is None:
        return None
    from ehdmaps.jobs.show.opening import open_given

    try:
        return open_given(path)
    except InputError as error:
        problems += error.problems
        return None
    except EhdmapsError as error:
        problems += [f"--map: {line}" for line in str(error).splitlines()]
        return None


def _structured(emap: EHDMap | None, law: str, chosen: Mapping[str, Any], problems: list[str]) -> EHDMap | None:
    """The map by the structural law that was chosen."""
    structure = chosen.get(STRUCTURE.name)
    if structure is None:
        return emap
    if emap is None:
        if law != TABLE_LAW and "map" not in chosen:
            problems.append(f"--{STRUCTURE.name}: got {structure} {LACKS['maps']}")
        return None
    try:
        return STRUCTURE.change(emap, structure)
    except InputError as error:
        problems += [f"--{STRUCTURE.name}: {problem}" for problem in error.problems]
        return None


def _law(name: str | None, with_map: bool, problems: list[str]) -> str:
    """The law that is meant."""
    if name is None:
        return "map" if with_map else TABLE_LAW
    try:
        damper = hertz_damper(name)
    except InputError as error:
        problems += error.problems
        return name
    if table_path(name) is not None:
        problems += table_problems(name)
    elif name not in LAWS and damper is None:
        allowed = f"{', '.join(LAWS)}; {HERTZ_FORMS}; {TABLE_FORM}"
        problems.append(f"--law: got {short(name)}{closest(name, LAWS)}; allowed: {allowed}")
    elif name == "map" and not with_map:
        problems.append("--law: got 'map' without a map; allowed: with --map MAP.nc, made by `ehdmaps generate`")
    elif name in ("formula", TABLE_LAW) and with_map:
        problems.append(f"--law: got {name!r} with a map; allowed: hertz or map with --map; leave one of the two out")
    return name


def _oil(
    name: str | None,
    given: Given | None,
    emap: EHDMap | None,
    with_map: bool,
    temperature: float,
    problems: list[str],
) -> Lubricant | None:
    """The oil: that of the map, of --oil, of the file, or FVA 3; the temperature must suit it."""
    if name is not None and with_map:
        problems.append(f"--oil: got {short(name)} with a map, which was made for an oil; leave one of the two out")
    stated = given.oil if given is not None else None
    return read_oil(None if with_map else name, temperature, problems, stated if emap is None else emap.lubricant)


def law_of(request: BearingRequest) -> Law:
    """The law of a roller between both raceways, over what is asked of it."""
    if request.law == "map" and request.emap is not None:
        return request.emap.law("series", outside="clamp", supply=request.supply, surface=request.surface)
    if request.law == "formula":
        turning = [speed for speed in request.speeds if speed > 0.0] or [1.0]
        u = [request.bearing.geometry.entrainment_speed(speed) for speed in (min(turning), max(turning))]
        return laws.formula(
            request.bearing,
            request.oil,
            load=FORMULA_LOADS,
            entrainment_speed=(u[0] / 1.1, u[1] * 1.1),
            temperature=(request.temperature, request.temperature + 2.0),
            outside="clamp",
            supply=request.supply,
            surface=request.surface,
        )
    if (path := table_path(request.law)) is not None:
        return read_law(path, request.bearing.geometry.roller_length)
    damper = hertz_damper(request.law) or Damper()
    return laws.hertz(request.bearing, damper.constant, damper.time)
