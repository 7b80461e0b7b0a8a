"""From a scene and a contact law to a system, in one pass that finds every problem.

Bodies are matrices of shafts, and reduced finite elements; one of the same content is built once.
Analyses compare several laws, clearances and loads on the same bodies. So bodies are known by what they are made
from, files included, and those of the last scenes are at hand.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeAlias, cast

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import InputError, Problems, problems_after
from ehdmaps.physics.heat import heat_in_force
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.oil_supply import OilSupply
from ehdmaps.physics.surface import Surface
from mbs.bearings.bearing_element import BearingElement
from mbs.bearings.thermal import BearingState
from mbs.model.elements import Operation
from mbs.model.relaxation import Films
from mbs.model.system import Places, System
from mbs.model.turning import TurningLoad
from mbs.scene import kinds
from mbs.scene.changes import with_clearance, with_supply
from mbs.scene.contact_laws import NO_LAW, ContactLaws, dry_reason, law_in_force, supply_words, surface_label
from mbs.scene.gears import axial_problems, mesh_input_problems
from mbs.scene.kinds import ElementKind
from mbs.scene.map_set import OTHER_OIL, MapSet, again_from_table
from mbs.scene.oils import oil_warnings
from mbs.scene.scene import Scene
from mbs.scene.surroundings import Built, Surroundings
from mbs.scene.turning import turning_loads, with_places

if TYPE_CHECKING:
    from ehdmaps.maps.emap import EHDMap
    from mbs.bearings.locating.locating_element import LocatingElement
    from mbs.gears.gear import GearMesh

import functools

from mbs.model.body import Body, rigid_body
from mbs.scene.specs import BodySpec, FlexibleSpec, RigidSpec, ShaftSpec

MOST_AT_HAND = 64
"""Bodies."""


def build_bodies(specs: Iterable[BodySpec]) -> tuple[Body, ...]:
    """Build all bodies of a scene.

    Parameters
    ----------
    specs : iterable of RigidSpec, ShaftSpec, FlexibleSpec or Body
        What they are.

    Raises
    ------
    InputError
        With the problems of all bodies.
    AnalysisError
        If the modes or static shapes of a reduction are not found.
    """
    problems = Problems()
    bodies = []
    for spec in specs:
        with problems:
            bodies.append(build_body(spec))
    problems.check()
    return tuple(bodies)


def build_body(spec: BodySpec) -> Body:
    """Build one body, or return it from before; its arrays are read-only.

    Parameters
    ----------
    spec : RigidSpec, ShaftSpec, FlexibleSpec or Body
        What it is. A `Body` is returned as it is.

    Raises
    ------
    InputError
        With everything that does not fit together.
    AnalysisError
        If the modes or static shapes of a reduction are not found.
    """
    if isinstance(spec, Body):
        return spec
    if not isinstance(spec, FlexibleSpec):
        return _built(_ByContent(repr(spec), spec))
    from mbs.scene.flexible import build_flexible, content_of

    with problems_after(f"flexible body {spec.name!r}: "):
        content = content_of(spec.source)
        if content is None:
            return build_flexible(spec)
        rest = repr(dataclasses.replace(spec, source=Path()))
        return _built(_ByContent(f"{content} {rest}", spec))


@dataclass(frozen=True)
class _ByContent:
    """A spec that is known by its content: for a body from files, a hash of these."""

    content: str
    spec: RigidSpec | ShaftSpec | FlexibleSpec = field(compare=False)


@functools.lru_cache(maxsize=MOST_AT_HAND)
def _built(given: _ByContent) -> Body:
    """Build a body."""
    spec = given.spec
    if isinstance(spec, RigidSpec):
        body = rigid_body(spec.name, spec.parts, spec.freedoms, spec.position, spec.frames, spec.spin)
    elif isinstance(spec, ShaftSpec):
        from mbs.scene.shafts.tables import build_shaft

        body = build_shaft(spec)
    else:
        from mbs.scene.flexible import build_flexible

        body = build_flexible(spec)
    left_out = () if body.left_out is None else (body.left_out,)
    shared = (body.mass, body.gyroscopic, body.damping, body.stiffness, *left_out)
    for array in (*shared, *(part for frame in body.frames.values() for part in (frame.position, frame.transform))):
        array.setflags(write=False)  # several systems have it
    return body


AnyBearing: TypeAlias = "BearingElement | LocatingElement"
"""A bearing in a system, of any kind."""

GivenMaps: TypeAlias = "EHDMap | str | Path | Sequence[EHDMap | str | Path] | MapSet | None"
"""What `assemble` takes as maps."""


@dataclass(frozen=True, eq=False)
class Recipe:
    """Making of a model of its scene, so that a scene that is a little different can be made alike.

    Attributes
    ----------
    law : str or None
        The law as it was asked for.
    maps : MapSet or None
        The maps that were given, or read from the film table.
    films : {"slow", "memory"} or None
        Which films were asked for.
    inlet_heat : bool or None
        Whether heat in the inlet was asked for; None for the default.
    """

    law: str | None = None
    maps: MapSet | None = None
    films: Films | None = None
    inlet_heat: bool | None = None


@dataclass(frozen=True, eq=False)
class Model:
    """A scene with a contact law.

    Attributes
    ----------
    scene : Scene
        What it was made from, with the clearance and the oil supply in force.
    system : System
        What is analysed in time. Its first elements are the bearings, then come the gear meshes.
    law : str
        The law in words.
    bearings : tuple of BearingElement
        Bearings in the order of the scene; where rollers are bodies, with massless rollers, to look at.
    gears : tuple of GearMesh
        Gear meshes in the order of the scene.
    label : str
        The law in two words, as the legend of a figure has it.
    memory : {"slow", "memory"}
        Whether films relax, or have the stiffness and damping of slow motion at any frequency, as laws without films
        always have.
    states : tuple of BearingState
        Temperatures, clearance and heat of each bearing, of a model that is in operation at some speed, see
        `mbs.analyses.operating`; empty before, and where no bearing has temperatures, heat or fits of its own.
    found : dict of float to Model
        The same model in operation, by speed, where it was asked for.
    supplies : mapping of str to OilSupply
        Oil supply of each bearing by its name; empty for laws without films.
    surface : Surface or None
        Surfaces of the contacts; None for laws without films.
    oils : mapping of str to Lubricant
        Oil of each bearing by its name, that of its map where there is one; empty for laws without films.
    chosen : mapping of str to str
        What was chosen of the scene beside its law, see `mbs.scene.choices`.
    recipe : Recipe
        How it was made of its scene.
    """

    scene: Scene
    system: System
    law: str
    bearings: tuple[BearingElement, ...]
    gears: tuple[GearMesh, ...]
    label: str
    memory: Films = "slow"
    states: tuple[BearingState, ...] = ()
    found: dict[float, Model] = field(default_factory=dict, repr=False)
    supplies: Mapping[str, OilSupply] = field(default_factory=dict)
    surface: Surface | None = None
    oils: Mapping[str, Lubricant] = field(default_factory=dict)
    chosen: Mapping[str, str] = field(default_factory=dict)
    recipe: Recipe = field(default_factory=Recipe, repr=False)

    def again(self, scene: Scene) -> Model:
        """Another scene with the law of this model; laws whose bearing and oil stay the same are not made anew.

        Parameters
        ----------
        scene : Scene
            This model's scene with something changed. Films of the film table follow its oil and its bearings; maps
            from files are what they are.

        Raises
        ------
        InputError
            With everything that does not fit together, such as a map from a file with other rollers or another oil.
        """
        recipe = self.recipe
        maps = recipe.maps
        if maps is not None and all(emap.from_table for emap in maps.maps):
            maps = again_from_table(maps, scene)
        elif maps is not None and scene.lubricant != self.scene.lubricant:
            raise InputError(OTHER_OIL)
        model = assemble(scene, recipe.law, maps, films=recipe.films, inlet_heat=recipe.inlet_heat)
        return dataclasses.replace(model, chosen=self.chosen)

    @property
    def has_films(self) -> bool:
        """Tell whether its law has films, of some bearing at least."""
        return bool(self.supplies) or any(entry.films is not None for entry in self.located)

    @property
    def warnings(self) -> list[str]:
        """Warnings of every analysis about the machine and its law: oils that contradict each other."""
        return oil_warnings(self.oils, self.scene.lubricant)

    @property
    def on_rings(self) -> tuple[AnyBearing, ...]:
        """Bearings of all kinds: those of `bearings`, then the others in the order of the elements."""
        return (*self.bearings, *self.located)

    @property
    def located(self) -> tuple[LocatingElement, ...]:
        """Bearings that carry axial load, in the order of the elements."""
        names = {entry.name for entry in self.scene.located}
        found = [entry.element for entry in self.system.elements if entry.element.name in names]
        return tuple(cast("list[LocatingElement]", found))

    @property
    def balls(self) -> tuple[LocatingElement, ...]:
        """Those of balls among them."""
        return tuple(entry for entry in self.located if entry.force.of_points)

    @property
    def ring_places(self) -> tuple[int, ...]:
        """Place of each of `on_rings` among the elements of the system, by its name."""
        places = {entry.element.name: index for index, entry in enumerate(self.system.elements)}
        return tuple(places[entry.name] for entry in self.on_rings)

    def largest_loads(self, displacement: FloatArray, operation: Operation) -> FloatArray:
        """Load of the most loaded contact of each of `on_rings`, see `OnRings.largest_load`.

        Parameters
        ----------
        displacement : array (n,)
            Displacement of all coordinates.
        operation : Operation
            Speed and angle.
        """
        loads = [
            entry.largest_load(self.system.relative(entry.inner, entry.outer) @ displacement, operation)
            for entry in self.on_rings
        ]
        return np.array(loads, dtype=np.float64)

    @property
    def operation(self) -> Operation:
        """The operating speed of the scene, at the start angles of its bearings."""
        return Operation(self.scene.speed)


def assemble(
    scene: Scene,
    law: str | None = None,
    emap: GivenMaps = None,
    clearance: float | None = None,
    films: Films | None = None,
    supply: OilSupply | None = None,
    inlet_heat: bool | None = None,
) -> Model:
    """Make a system from a scene.

    Parameters
    ----------
    scene : Scene
        Bodies, springs, loads, machine elements.
    law : str, optional
        hertz, formula, constant:NAME, table (films of the scene's oil from the film table, no file is needed) or map.
        By default as of all commands: map where there is one, else table, and hertz of a scene without oil.
    emap : EHDMap, str or Path, or several of these in a list, or MapSet, optional
        Map of the law `map`, or the path of its file; of a scene with several types of bearing one map for each.
    clearance : float, optional
        Diametral clearance of all bearings [m], in place of the scene's.
    films : {"slow", "memory"}, optional
        Whether films have the stiffness and damping of slow motion at any frequency, or relax, in linear analyses and
        in runs in time; `DEFAULT_FILMS` of `mbs.model.relaxation` if left out, where the law allows it. Statics do not
        change.
    supply : OilSupply, optional
        Oil supply of all bearings, in place of that of the scene and of its bearings; without either it is that which
        the job of the map states, and flooded where it states none. Laws without films have none.
    inlet_heat : bool, optional
        Whether heat in the inlet thins films of the film table, by its rule (`ehdmaps.physics.heat`); if left out yes,
        where the conductivity of the oil is known. Maps from files have the physics that they were made with.

    Returns
    -------
    Model
        What the analyses take.

    Raises
    ------
    InputError
        With everything that does not fit together.
    AnalysisError
        If a body of finite elements cannot be reduced.
    EhdmapsError
        If the file of the map cannot be read.

    Notes
    -----
    Bodies are built once: a second model of the same scene, with another law, clearance or load, has the same ones.

    Examples
    --------
    >>> from mbs import assemble, read_scene
    >>> model = assemble(read_scene("nu308_rigid"), clearance=20e-6)
    >>> model.label, model.system.size
    ('film table', 8)
    """
    chosen, maps = law_in_force(law, _opened(emap), scene, inlet_heat)
    problems = Problems()
    if clearance is not None:
        with problems.after("--clearance: "):
            scene = with_clearance(scene, clearance)
    if supply is not None:
        scene = with_supply(scene, supply)
    laws = ContactLaws(chosen, scene, maps, films, heat_in_force(inlet_heat, scene.lubricant))
    wrong_law = laws.problems()
    problems[:0] = wrong_law
    try:
        bodies = build_bodies(with_places(scene.bodies, scene.unbalances))
    except InputError as error:
        raise InputError([*problems, *error.problems]) from error
    places = Places(bodies)
    built, found = _elements(scene, Surroundings(places, laws, scene.temperature), may_build=not wrong_law)
    problems += found
    turning, found = turning_loads(scene.unbalances, scene.excitations, places)
    problems += found
    parts = [part for group in built.values() for part in group]
    own_bodies = [body for part in parts for body in part.bodies]
    wrong_places = _place_problems(places, scene)
    with problems:
        elements = [part.element for part in parts]
        system = System((*bodies, *own_bodies), scene.springs, scene.loads, elements, turning, scene.gravity)
        problems += [] if wrong_places else _idle_problems(system, scene, turning)
        problems += axial_problems(system, scene.gears, Operation(scene.speed))
    problems += wrong_places
    problems.check()
    bearings = tuple(_shown(built, "bearings", BearingElement))
    words = [laws.words] if bearings else []
    if scene.located:
        from mbs.scene.locating.element import located_law_words

        words += located_law_words(laws)
    if law is None and chosen == "hertz":
        words += filter(None, [dry_reason(scene)])
    return Model(
        scene=scene,
        system=system,
        law="; ".join(words) or "none",
        bearings=bearings,
        gears=cast("tuple[GearMesh, ...]", tuple(part.shown for part in built["gears"])),
        label=laws.label if scene.has_bearings else NO_LAW,
        memory=laws.memory,
        supplies=laws.supplies,
        surface=laws.surface,
        oils=laws.oils,
        recipe=Recipe(law if maps is None else chosen, maps, films, inlet_heat),
    )


def with_bodies(model: Model, bodies: Sequence[BodySpec]) -> Model:
    """The model with other reductions of its bodies: with the same places, elements and laws.

    Parameters
    ----------
    model : Model
        Scene with its law, not in operation.
    bodies : sequence of RigidSpec, ShaftSpec, FlexibleSpec or Body
        Bodies in the order of the scene.

    Raises
    ------
    InputError
        If one cannot be reduced so.
    """
    scene = dataclasses.replace(model.scene, bodies=bodies)
    built = build_bodies(with_places(scene.bodies, scene.unbalances))
    names = {body.name for body in built}
    own_bodies = [body for body in model.system.bodies if body.name not in names]
    turning, _ = turning_loads(scene.unbalances, scene.excitations, Places(built))
    elements = [connected.element for connected in model.system.elements]
    system = System((*built, *own_bodies), scene.springs, scene.loads, elements, turning, scene.gravity)
    return dataclasses.replace(model, scene=scene, system=system, found={})


def _opened(given: GivenMaps) -> MapSet | None:
    """Maps, or the paths of their files, as a set."""
    if given is None or isinstance(given, MapSet):
        return given
    from ehdmaps.maps.emap import open_map

    several = given if isinstance(given, Sequence) and not isinstance(given, str) else [given]
    return MapSet([open_map(entry) if isinstance(entry, (str, Path)) else entry for entry in several])


def law_attributes(model: Model) -> Mapping[str, str]:
    """Provenance of a result."""
    named = {"scene": model.scene.name, "scene_toml": model.scene.text, "law": model.law}
    surface = {} if model.surface is None else {"surface": surface_label(model.surface)}
    warned = {"warnings": "; ".join(model.warnings)} if model.warnings else {}
    weight = {"weight": model.scene.weight}
    return {**named, **weight, **choice_attributes([(model.label, model)]), **surface, **warned}


def laws_attributes(labels: Sequence[str], models: Sequence[Model]) -> dict[str, str]:
    """Attributes of a result of several laws, on them and on what was chosen with them.

    Parameters
    ----------
    labels : sequence of str
        What each law is called.
    models : sequence of Model
        Their models.
    """
    named = list(zip(labels, models, strict=True))
    return {"law": "; ".join(f"{label}: {model.law}" for label, model in named), **choice_attributes(named)}


def choice_attributes(models: Sequence[tuple[str, Model]]) -> dict[str, str]:
    """Attributes of a result on oil supplies and choices of its models, each with a label where there are more of them.

    Parameters
    ----------
    models : sequence of (str, Model)
        Labels and models. Those whose law has no films have no oil supply.
    """
    found: dict[str, list[str]] = {"oil_supply": [], "choices": []}
    for label, model in models:
        # a surface is called by its roughness already
        chosen = ", ".join(text if text.startswith(name) else f"{name} {text}" for name, text in model.chosen.items())
        for name, words in (("oil_supply", supply_words(model.supplies)), ("choices", chosen)):
            if words:
                found[name].append(f"{label}: {words}" if len(models) > 1 else words)
    return {name: "; ".join(words) for name, words in found.items() if words}


def _elements(scene: Scene, surroundings: Surroundings, *, may_build: bool) -> tuple[dict[str, list[Built]], list[str]]:
    """Build the machine elements by the key of their kind, and say what is wrong about them."""
    built: dict[str, list[Built]] = {kind.key: [] for kind in kinds.KINDS}
    problems = Problems(
        f"scene, elements: got {entry.name!r} of class {type(entry).__name__}; allowed: "
        f"{', '.join(kind.spec.__name__ for kind in kinds.KINDS)}"
        for entry in scene.elements
        if kinds.kind_of(entry) is None
    )
    for kind in kinds.KINDS:
        for spec in scene.elements:
            if kinds.kind_of(spec) is not kind:
                continue
            problems += (found := _problems(kind, spec, surroundings))
            if not found and may_build:
                with problems:
                    built[kind.key].append(kind.build(spec, surroundings))
    return built, problems


def _problems(kind: ElementKind, spec: Any, surroundings: Surroundings) -> list[str]:
    """Problems with a machine element and its places."""
    places = surroundings.places
    missing = [found for place in kind.places(spec) if (found := places.problem(place))]
    return [*(f"{kind.word} {spec.name!r}: {found}" for found in missing), *kind.problems(spec, surroundings)]


def _shown(built: Mapping[str, list[Built]], key: str, expected: type[Any]) -> Iterable[Any]:
    """Elements of a kind as results show them."""
    return (part.shown for part in built.get(key, ()) if isinstance(part.shown, expected))


def _place_problems(places: Places, scene: Scene) -> list[str]:
    """Places of inputs and sensors that do not exist."""
    return mesh_input_problems(scene.inputs, scene.gears) + [
        f"{word} {name!r}: {found}"
        for word, name, named in (
            *(("input", entry.name, entry.places) for entry in scene.inputs),
            *(("sensor", entry.name, (entry.on, entry.against)) for entry in scene.sensors),
        )
        for place in named
        if (found := places.problem(place))
    ]


def _idle_problems(system: System, scene: Scene, turning: Sequence[TurningLoad]) -> list[str]:
    """Parts that do nothing in the system, which is hardly meant: an unstrained spring, a load that moves nothing."""
    problems = [
        f"spring {spring.name!r}: {spring.on} and {spring.against} do not move against each other; allowed: places of "
        "two bodies, or of one that moves and the ground"
        for spring in scene.springs
        if not np.any(system.relative(spring.on, spring.against))
    ]
    problems += [
        f"{entry.name!r}: no freedom moves its place along it; allowed: an unbalance or excitation in a direction in "
        "which the body is free"
        for entry in turning
        if not np.any(system.relative(entry.on, entry.against).T @ entry.vector)
    ]
    for kind, name, direction, on, against in (
        *(("load", load.name, load.force, load.on, load.against) for load in scene.loads),
        *(("input", entry.name, entry.direction, entry.on, entry.against) for entry in scene.inputs if entry.places),
        *(("sensor", entry.name, entry.direction, entry.on, entry.against) for entry in scene.sensors),
    ):
        if np.any(direction) and not np.any(direction @ system.relative(on, against)):
            problems.append(
                f"{kind} {name!r}: no freedom moves {on} against {against} along its direction; allowed: a direction "
                "in which the body is free"
            )
    return problems


def ring_motions(model: Model, displacement: FloatArray) -> list[tuple[BearingElement, FloatArray]]:
    """Each bearing with the displacement (6,) of its inner ring against the outer one."""
    return [(bearing, model.system.relative(bearing.inner, bearing.outer) @ displacement) for bearing in model.bearings]
