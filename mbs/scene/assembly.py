"""From a scene and a contact law to a system: the law is chosen, made once for each geometry, and put into bearings."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import get_args

import numpy as np

from ehdmaps.errors import InputError
from ehdmaps.maps.emap import EHDMap, open_map
from ehdmaps.maps.law import LawKind
from ehdmaps.physics.bearing import BearingGeometry
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.units import closest
from mbs.bearings import laws
from mbs.bearings.bearing import Bearing
from mbs.bearings.bearing_element import NO_CENTRIFUGAL, BearingElement
from mbs.bearings.bearing_force import BearingForce
from mbs.bearings.films import DryContacts, FilmSource, FormulaFilms, MapFilms
from mbs.bearings.laws import DryLaw, Law
from mbs.bearings.roller_contacts import RollerContacts
from mbs.bearings.roller_element import RollerElement, roller_body
from mbs.gears.gear import GearMesh, gear_mesh
from mbs.gears.pair import GearPair
from mbs.model.body import CENTRE, Body
from mbs.model.elements import GROUND, Element, Operation
from mbs.model.relaxation import DEFAULT_FILMS, Films
from mbs.model.system import System
from mbs.scene.scene import Scene, SceneBearing

MEMORY_WORDS = "films with memory"
"""How people are told that films relax in linear analyses."""

_SAME = 1e-9
_COMPARED = ("inner_raceway_diameter", "outer_raceway_diameter", "roller_diameter", "roller_length")
_CONSTANT = "constant:"
_LABELS = {"hertz": "dry Hertz", "formula": "film formula"}
_MAP_LABELS = {"reynolds": "Reynolds map", "openfoam": "OpenFOAM map", "formula": "formula map", "hertz": "Hertz map"}


@dataclass(frozen=True, eq=False)
class Model:
    """A scene with a contact law.

    Attributes
    ----------
    scene : Scene
        What it was made from, with the clearance in force.
    system : System
        What is analysed in time. Its first elements are the bearings, then come the gear meshes.
    law : str
        The law in words.
    bearings : tuple of BearingElement
        In the order of the scene; where rollers are bodies, the same with massless rollers, to look at.
    gears : tuple of GearMesh
        In the order of the scene.
    films : mapping of str to FilmSource
        What knows pressures and films of the contacts, by bearing.
    label : str
        The law in two words, as the legend of a figure has it.
    memory : str
        Whether films relax in linear analyses, "memory", or have the stiffness and damping of slow motion there,
        "slow", as laws without films always have.
    """

    scene: Scene
    system: System
    law: str
    bearings: tuple[BearingElement, ...]
    gears: tuple[GearMesh, ...]
    films: Mapping[str, FilmSource]
    label: str
    memory: Films = "slow"

    @property
    def operation(self) -> Operation:
        """The operating speed of the scene, at the start angles of its bearings."""
        return Operation(self.scene.speed)


def choose_law(name: str | None, emap: EHDMap | None) -> str:
    """The law that is meant: by default the map where there is one, else Hertz."""
    return name if name is not None else ("map" if emap is not None else "hertz")


def law_label(law: str, emap: EHDMap | None = None) -> str:
    """A law in two words, such as "dry Hertz"; a map by the solver that made it."""
    if law == "map" and emap is not None:
        return _MAP_LABELS.get(str(emap.dataset.attrs.get("solver", "")), "map")
    return _LABELS.get(law, law.replace(":", " "))


def assemble(
    scene: Scene,
    law: str | None = None,
    emap: EHDMap | str | Path | None = None,
    clearance: float | None = None,
    films: Films | None = None,
) -> Model:
    """Make a system from a scene.

    Parameters
    ----------
    scene : Scene
        Bodies, springs, loads, bearings.
    law : str, optional
        hertz, formula, constant:NAME or map; map by default where there is one, else hertz.
    emap : EHDMap, str or Path, optional
        For the law `map`: a map, or the path of its file.
    clearance : float, optional
        Diametral clearance of all bearings [m], in place of the scene's.
    films : {"slow", "memory"}, optional
        Whether films have the stiffness and damping of slow motion in linear analyses, or relax there; `DEFAULT_FILMS`
        of `mbs.model.relaxation` if left out, where the law allows it. Statics and runs in time do not change.

    Returns
    -------
    Model
        What the analyses take.

    Raises
    ------
    InputError
        With everything that does not fit together.
    EhdmapsError
        If the file of the map cannot be read.

    Examples
    --------
    >>> from mbs import assemble, read_scene
    >>> model = assemble(read_scene("nu308_rigid"), clearance=20e-6)
    >>> model.label, model.system.size
    ('dry Hertz', 8)
    """
    if isinstance(emap, (str, Path)):
        emap = open_map(emap)
    chosen = choose_law(law, emap)
    problems = find_problems(scene, law, emap, clearance, films)
    if problems:
        raise InputError(problems)
    if clearance is not None:
        scene = dataclasses.replace(
            scene, bearings=tuple(_with_clearance(entry, clearance, []) for entry in scene.bearings)
        )

    memory = films or ("slow" if _memory_problems(chosen, scene) else DEFAULT_FILMS)
    made: dict[BearingGeometry, _Laws] = {}
    bearings: list[BearingElement] = []
    elements: list[Element] = []
    rollers: list[Body] = []
    for entry in scene.bearings:
        bearing = Bearing(entry.geometry, entry.profile, entry.slices)
        key = dataclasses.replace(entry.geometry, diametral_clearance=0.0)
        if key not in made:
            made[key] = _Laws(chosen, bearing, scene, emap)
        plain = BearingElement(
            name=entry.name,
            inner=entry.inner,
            outer=entry.outer,
            bearing=bearing,
            force=BearingForce(bearing, made[key].series),
            temperature=scene.temperature,
            inner_spin=_spin(entry.inner, scene.bodies),
            outer_spin=_spin(entry.outer, scene.bodies),
            start_angle=entry.start_angle,
            centrifugal=entry.centrifugal,
            films="slow" if entry.rollers_as_bodies else memory,
        )
        bearings.append(plain)
        if entry.rollers_as_bodies:
            body = roller_body(f"{entry.name}_rollers", bearing)
            rollers.append(body)
            elements.append(RollerElement(plain, RollerContacts(bearing, *made[key].single), body.name, memory))
        else:
            elements.append(plain)
    gears = tuple(_meshing(pair, scene.bodies) for pair in scene.gears)
    system = System((*scene.bodies, *rollers), scene.springs, scene.loads, (*elements, *gears))
    sources = {entry.name: _films(chosen, entry.bearing, scene, emap) for entry in bearings}
    words = _words(chosen, scene, emap) + (f", {MEMORY_WORDS}" if memory == "memory" else "")
    label = law_label(chosen, emap) + (f", {MEMORY_WORDS}" if memory == "memory" else "")
    return Model(scene, system, words, tuple(bearings), gears, sources, label, memory)


def find_problems(
    scene: Scene,
    law: str | None = None,
    emap: EHDMap | None = None,
    clearance: float | None = None,
    films: str | None = None,
) -> list[str]:
    """Everything that does not fit together; arguments as of `assemble`."""
    chosen = choose_law(law, emap)
    problems = _law_problems(chosen, scene, emap)
    if films not in (None, *get_args(Films)):
        problems.append(f"--films: got {films!r:.60}; allowed: {', '.join(get_args(Films))}")
    elif films == "memory":
        problems += _memory_problems(chosen, scene)
    for entry in scene.bearings:
        if clearance is not None:
            _with_clearance(entry, clearance, problems)
        if emap is not None and chosen == "map":
            problems += geometry_problems(f"bearing {entry.name!r}", entry.geometry, emap)
    try:
        plain = System(scene.bodies, scene.springs, scene.loads)
    except InputError as error:
        return problems + list(error.problems)
    for pair in scene.gears:
        missing = [found for place in (pair.on, pair.against) if (found := _gear_place_problem(plain, place))]
        problems += [f"gear pair {pair.name!r}: {found}" for found in missing]
        if not missing:
            try:
                _meshing(pair, scene.bodies)
            except InputError as error:
                problems += error.problems
    places = [
        *((f"input {entry.name!r}", place) for entry in scene.inputs for place in (entry.on, entry.against)),
        *((f"sensor {entry.name!r}", place) for entry in scene.sensors for place in (entry.on, entry.against)),
        *((f"bearing {entry.name!r}", place) for entry in scene.bearings for place in (entry.inner, entry.outer)),
    ]
    wrong = [f"{where}: {found}" for where, place in places if (found := plain.check_place(place))]
    return problems + (wrong or _idle_problems(plain, scene))


def _idle_problems(plain: System, scene: Scene) -> list[str]:
    """What does nothing in the system, which is hardly meant: a load that moves nothing, a bearing of one body."""
    problems = [
        f"bearing {entry.name!r}: got {entry.inner} and {entry.outer}; allowed: rings on two bodies"
        for entry in scene.bearings
        if entry.inner.partition(":")[0] == entry.outer.partition(":")[0]
    ]
    problems += [
        f"spring {spring.name!r}: {spring.on} and {spring.against} do not move against each other; allowed: places of "
        "two bodies, or of one that moves and the ground"
        for spring in scene.springs
        if not np.any(plain.relative(spring.on, spring.against))
    ]
    for kind, name, direction, on, against in (
        *(("load", load.name, load.force, load.on, load.against) for load in scene.loads),
        *(("input", entry.name, entry.direction, entry.on, entry.against) for entry in scene.inputs),
        *(("sensor", entry.name, entry.direction, entry.on, entry.against) for entry in scene.sensors),
    ):
        if np.any(direction) and not np.any(direction @ plain.relative(on, against)):
            problems.append(
                f"{kind} {name!r}: no freedom moves {on} against {against} along its direction; allowed: a direction "
                "in which the body is free"
            )
    return problems


def constant_name(law: str) -> str | None:
    """NAME of a law constant:NAME, else None."""
    return law.removeprefix(_CONSTANT) if law.startswith(_CONSTANT) else None


def _law_problems(chosen: str, scene: Scene, emap: EHDMap | None) -> list[str]:
    """What is wrong about the choice of the law."""
    names = tuple(f"{_CONSTANT}{name}" for name in scene.laws)
    allowed = ("hertz", "formula", *names, "map")
    if chosen not in allowed:
        return [f"--law: got {chosen!r:.60}{closest(chosen, allowed)}; allowed here: {', '.join(allowed)}"]
    if chosen == "map" and emap is None:
        return ["--law: got 'map' without a map; allowed: with --map MAP.nc, made by `ehdmaps generate`"]
    if chosen == "formula" and scene.lubricant is None:
        return [f"--law: got 'formula', but {scene.name} has no [lubricant]; add the table to the scene"]
    centrifugal = [entry.name for entry in scene.bearings if entry.centrifugal and not entry.rollers_as_bodies]
    if centrifugal and chosen not in ("map", "formula"):
        return [
            f"--law: got {chosen!r} with centrifugal = true in {', '.join(centrifugal)}; allowed: the laws map and "
            "formula, which bring a roller into equilibrium; or centrifugal = false"
        ]
    return []


def _memory_problems(chosen: str, scene: Scene) -> list[str]:
    """Why films cannot relax."""
    if chosen not in ("map", "formula"):
        return [
            f"--films: got 'memory' with the law {chosen!r:.60}; allowed: the laws map and formula, which have films"
        ]
    centrifugal = [entry.name for entry in scene.bearings if entry.centrifugal and not entry.rollers_as_bodies]
    return [f"--films: {NO_CENTRIFUGAL}, in {', '.join(centrifugal)}"] if centrifugal else []


def _with_clearance(entry: SceneBearing, clearance: float, problems: list[str]) -> SceneBearing:
    """The bearing with another clearance."""
    try:
        geometry = dataclasses.replace(entry.geometry, diametral_clearance=clearance)
    except InputError as error:
        problems += [f"--clearance: {problem}" for problem in error.problems]
        return entry
    return dataclasses.replace(entry, geometry=geometry)


def geometry_problems(where: str, geometry: BearingGeometry, emap: EHDMap) -> list[str]:
    """In what a map was made for something else than a bearing, which messages call `where`.

    Parameters
    ----------
    where : str
        How messages call the bearing.
    geometry : BearingGeometry
        Geometry of the bearing.
    emap : EHDMap
        The map.
    """
    made_for = emap.bearing
    if made_for is None:
        return [f"--map: is made for a bare contact; {where} needs a map of {geometry.name}"]
    differing = [
        f"{key} {getattr(made_for, key) * 1e3:.6g} mm and not {getattr(geometry, key) * 1e3:.6g} mm"
        for key in _COMPARED
        if abs(getattr(made_for, key) - getattr(geometry, key)) > _SAME
    ]
    if not differing:
        return []
    return [
        f"--map: is made for {made_for.name}: {', '.join(differing)} as the {geometry.name} of {where}; generate a map "
        "of that bearing"
    ]


def _films(chosen: str, bearing: Bearing, scene: Scene, emap: EHDMap | None) -> FilmSource:
    """What knows the films of a bearing by the law in force."""
    if chosen == "map" and emap is not None:
        return MapFilms(emap)
    contacts = bearing.geometry.contacts(bearing.material, "iso16281")
    return FormulaFilms(contacts, _lubricant(scene)) if chosen == "formula" else DryContacts(contacts)


def _gear_place_problem(system: System, place: str) -> str:
    """What is wrong about the place of a gear; empty if nothing is."""
    return "a gear on the ground cannot turn; name a body" if place == GROUND else system.check_place(place)


def _meshing(pair: GearPair, bodies: tuple[Body, ...]) -> GearMesh:
    """The gear mesh between the bodies of its places."""
    first, second = (_position(place, bodies) for place in (pair.on, pair.against))
    return gear_mesh(pair, first, second, _spin(pair.on, bodies), _spin(pair.against, bodies))


def _position(place: str, bodies: tuple[Body, ...]) -> list[float]:
    """Where a place on a body is [m]."""
    name, _, frame = place.partition(":")
    body = next(body for body in bodies if body.name == name)
    position: list[float] = body.frames[frame or CENTRE].position.tolist()
    return position


def _spin(place: str, bodies: tuple[Body, ...]) -> float:
    """Spin of the body of a place."""
    name = place.partition(":")[0]
    return 0.0 if name == GROUND else next(body.spin for body in bodies if body.name == name)


@dataclass(frozen=True, eq=False)
class _Laws:
    """Laws for one geometry; outside its map a law is held at the edge, and calls there are counted."""

    chosen: str
    bearing: Bearing
    scene: Scene
    emap: EHDMap | None

    @cached_property
    def series(self) -> Law:
        """Of a roller between both raceways."""
        if self.chosen in ("map", "formula"):
            return self._of_kind("series")
        name = constant_name(self.chosen)
        return laws.hertz(self.bearing) if name is None else laws.constant(*self.scene.laws[name])

    @cached_property
    def single(self) -> tuple[Law, Law]:
        """Of the inner and of the outer contact."""
        if isinstance(self.series, DryLaw):
            return self.series.single(), self.series.single()
        return self._of_kind("inner"), self._of_kind("outer")

    def _of_kind(self, kind: LawKind) -> Law:
        """A law with films."""
        if self.chosen == "map" and self.emap is not None:
            return self.emap.law(kind, outside="clamp")
        return laws.formula(self.bearing, _lubricant(self.scene), kind=kind, outside="clamp")


def _lubricant(scene: Scene) -> Lubricant:
    """The oil of the scene, which `_law_problems` saw."""
    assert scene.lubricant is not None
    return scene.lubricant


def _words(chosen: str, scene: Scene, emap: EHDMap | None) -> str:
    """The law, for people."""
    if chosen == "map" and emap is not None:
        solver = emap.dataset.attrs.get("solver", "")
        made_for = emap.bearing.title if emap.bearing else ""
        return f"map of {made_for}, {emap.lubricant.title}, solver {solver}"
    if chosen == "formula":
        return f"film formula moes, {_lubricant(scene).title}"
    name = constant_name(chosen)
    if name is None:
        return "dry Hertz, ISO 16281"
    stiffness, damping = scene.laws[name]
    return f"constant {name}: {stiffness:.4g} N/m and {damping:.4g} N s/m for each contact of a roller"


def law_attributes(model: Model) -> Mapping[str, str]:
    """Provenance of a result."""
    return {"scene": model.scene.name, "scene_toml": model.scene.text, "law": model.law}
