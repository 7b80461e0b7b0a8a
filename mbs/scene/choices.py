"""Choices of a scene: its contact law, films, oil, surfaces, clearance, loads and numbers, one row each in `CHOICES`.

A row knows the option of the command line and its help, reads a text, tells a value, and gives a scene and law with
that value. All commands on scenes take these rows, compare several values of one, and write into their results what was
chosen; `mbs variants --vary` takes each by its name. So a choice more is a row more, with the function that changes a
scene (`mbs.scene.changes`) or its law (here; laws are in `mbs.scene.subject`), and a paragraph of the reference.

What takes long to import is imported by the function that needs it: the command line lists the rows before it knows
what is asked.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal

from ehdmaps.choices import ROUGHNESS, STRUCTURE, SUPPLY, Choice, one_of
from ehdmaps.errors import InputError, Problems
from ehdmaps.units import RPM, TEMPERATURE, Display, quantity, quantity_between, whole_number
from mbs.model.relaxation import DEFAULT_FILMS, FILM_WORDS
from mbs.scene.fields import DEGREE, HERTZ, MICROMETRE
from mbs.scene.map_set import TABLE_LAW
from mbs.scene.subject import Subject, named_law, opened_maps

if TYPE_CHECKING:
    from ehdmaps.physics.oil_supply import OilSupply
    from ehdmaps.physics.surface import Surface

FILMS = ("memory", "slow")
"""What --films takes: films that relax, and those of slow motion."""

WIDEST = 1e-2
"""Largest clearance, either way [m]."""

FASTEST = 1e5
"""Highest speed [rad/s]."""

MOST_FACTOR = 1e3
MOST_SLICES = 10_000

_SECOND, _MICROSECOND = Display("s"), Display("us", 1e6)


Concerned = Literal["all", "relaxing", "heat", "maps", "oil", "first"]
"""Whom a choice concerns: all; laws with films, of maps or the film table, or of
maps; those for which oil has a temperature; the reference."""

_NO_MAP = "without a map; allowed: with --map MAP.nc, made by `ehdmaps generate`, or --law table"

LACKS = {
    "relaxing": "without a law that has films; allowed: with --map, --law table, formula or dietl",
    "heat": _NO_MAP,
    "maps": _NO_MAP,
}
"""What is said where no law is concerned."""

LOCATED_LACK = "without roller bearings like NU; allowed: none of it, balls and tapered rollers have one law of solids"
"""The same of a scene of bearings that carry axial load alone."""


@dataclass(frozen=True)
class SceneChoice(Choice[Subject]):
    """A choice of a scene, see `ehdmaps.choices.Choice`.

    Attributes
    ----------
    example : str
        A value that may be varied, for people; empty where it cannot be.
    concerned : {"all", "relaxing", "heat", "maps", "oil", "first"}
        Which of several laws it concerns.
    option : bool
        Whether the commands on scenes have it as an option; else `mbs variants --vary` alone.
    called : callable or None
        How a case is called by a value of several; by default the value.
    usual : callable
        Whether a law with this value is called like one where nothing was chosen.
    """

    example: str = ""
    concerned: Concerned = "all"
    option: bool = True
    called: Callable[[Any], str] | None = None
    usual: Callable[[Any], bool] = lambda value: True

    def words(self, value: Any) -> str:
        """Name of a case by a value."""
        return (self.called or self.text)(value)

    def concerns(self, subject: Subject) -> bool:
        """Tell whether a subject depends on it."""
        if self.concerned == "maps":
            return subject.law.maps is not None
        if self.concerned == "heat":
            return subject.law.maps is not None or subject.law.name == TABLE_LAW
        if self.concerned == "oil":
            # Rings of other temperatures have another clearance.
            return subject.law.has_films or any(entry.changes_in_operation for entry in subject.scene.bearings)
        if self.concerned == "relaxing":
            return subject.law.may_relax
        return True

    def chosen(self, subject: Subject, value: Any) -> Subject:
        """A subject with a value, which its results tell.

        Parameters
        ----------
        subject : Subject
            Scene and law.
        value : object
            What `read` gives.

        Raises
        ------
        InputError
            Where the value does not fit the scene.
        """
        changed = self.change(subject, value)
        if changed is subject:
            return subject
        return dataclasses.replace(changed, chosen={**subject.chosen, self.name: self.text(value)})

    def varied(self, subject: Subject, value: Any, first: bool) -> Subject:
        """A subject with a value of this choice; the same where the choice does not concern it.

        Parameters
        ----------
        subject : Subject
            Scene and law.
        value : object
            What `read` gives.
        first : bool
            Whether it is the reference.

        Raises
        ------
        InputError
            Where the value does not fit the scene.
        """
        concerned = first if self.concerned == "first" else self.concerns(subject)
        return self.change(subject, value) if concerned else subject


def _between(unit: str, low: float, high: float, display: Display) -> Callable[[str], float]:
    """A reader of a quantity."""
    return lambda text: quantity_between(text, unit, low, high, display)


def _either_way(unit: str, most: float, words: str) -> Callable[[str], float]:
    """A reader of a quantity of either sign."""

    def read(text: str) -> float:
        value = quantity(text, unit)
        if not abs(value) <= most:
            raise InputError(f"got {text!r:.60}; allowed: {words}")
        return value

    return read


def _factor(text: str) -> float:
    """Read a factor."""
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not 0.0 < value <= MOST_FACTOR:
        raise InputError(f"got {text!r:.40}; allowed: above 0 up to {MOST_FACTOR:g}, such as 1.5")
    return value


def _times(value: float) -> str:
    """Tell a factor."""
    return f"{value:g} x"


def _slices(text: str) -> int:
    """Read a number of slices."""
    return whole_number(text, 1, MOST_SLICES)


def _temperature(text: str) -> float:
    """Read a temperature of the raceways [K]."""
    from ehdmaps.physics.contact import OIL_TEMPERATURES

    return _between("K", *OIL_TEMPERATURES, TEMPERATURE)(text)


def _films(text: str) -> str:
    """Read which films."""
    if text == "dry":
        raise InputError("got 'dry'; contacts without films are --law hertz")
    return one_of(lambda: FILMS)(text)


def _law_text(name: str) -> str:
    """Tell a law by its name."""
    from mbs.scene.contact_laws import law_label

    return law_label(name)


def _with_law(subject: Subject, name: str) -> Subject:
    """A subject with another law."""
    return dataclasses.replace(subject, law=named_law(name, subject.scene))


def _with_map(subject: Subject, path: str) -> Subject:
    """A subject with the law of a map."""
    problems = Problems()
    laws = opened_maps([path], subject.scene, problems)
    problems.check()
    return dataclasses.replace(subject, law=laws[0])


def _with_structure(subject: Subject, name: str) -> Subject:
    """A subject whose maps have another structural law."""
    law = subject.law
    if law.maps is None:
        return subject
    maps = law.maps.each(lambda emap: STRUCTURE.change(emap, name))
    return dataclasses.replace(subject, law=dataclasses.replace(law, maps=maps))


def _with_films(subject: Subject, kind: str) -> Subject:
    """A subject with other films; a law without films stays as it is."""
    law = subject.law
    if not law.may_relax:
        return subject
    return dataclasses.replace(subject, law=dataclasses.replace(law, films="memory" if kind == "memory" else "slow"))


def _physics() -> tuple[str, str]:
    """Words for what films of the film table know of heat."""
    from ehdmaps.physics.heat import INLET_HEAT, ISOTHERMAL

    return ISOTHERMAL, INLET_HEAT


def _with_physics(subject: Subject, physics: str) -> Subject:
    """A subject whose films of the film table have heat in the inlet or not; other laws stay as they are."""
    law, maps = subject.law, subject.law.maps
    if maps is None and law.name != TABLE_LAW:
        return subject
    heat = physics != _physics()[0]
    from_files = [] if maps is None else [emap for emap in maps.maps if not emap.from_table]
    if any(emap.physics != physics for emap in from_files):
        raise InputError(
            f"got {physics} with a map, which has the physics that it was made with; allowed: films of the film table; "
            "make the map of a job with this physics in [solver]"
        )
    if heat == law.inlet_heat:
        return subject
    if heat and subject.scene.lubricant is not None:
        from ehdmaps.physics.heat import heat_data
        from ehdmaps.physics.solids import STEEL

        heat_data(subject.scene.lubricant, STEEL)
    if maps is not None and not from_files:
        from mbs.scene.map_set import table_maps

        maps = table_maps(subject.scene, heat)
    return dataclasses.replace(subject, law=dataclasses.replace(law, maps=maps, inlet_heat=heat))


def _films_words(kind: str) -> str:
    """Tell films."""
    return FILM_WORDS["memory" if kind == "memory" else "slow"]


def _with_supply(subject: Subject, supply: OilSupply) -> Subject:
    """A subject with another oil supply of all bearings; a law without films stays as it is."""
    law = subject.law
    return dataclasses.replace(subject, law=dataclasses.replace(law, supply=supply)) if law.may_relax else subject


def _with_roughness(subject: Subject, surface: Surface) -> Subject:
    """A subject with other surfaces of all contacts: the roughness is another, hardness and asperities stay."""
    maps = subject.law.maps
    stated = subject.scene.surface or (maps.maps[0].surface if maps is not None else surface)
    kept = dataclasses.replace(stated, roughness=surface.roughness)
    return dataclasses.replace(subject, scene=dataclasses.replace(subject.scene, surface=kept))


def _with_temperature(subject: Subject, kelvin: float) -> Subject:
    """A subject with raceways of another temperature; films of the film table are read there, too."""
    from mbs.scene.map_set import table_maps

    changed = _of_scene("with_temperature")(subject, kelvin)
    maps = subject.law.maps
    if maps is None or not all(emap.from_table for emap in maps.maps) or maps.known_at(kelvin):
        return changed
    structure = maps.maps[0].structural_law
    wider = table_maps(changed.scene, maps.maps[0].inlet_heat).each(lambda emap: emap.with_structure(structure))
    return dataclasses.replace(changed, law=dataclasses.replace(changed.law, maps=wider))


def _statements(text: str) -> Any:
    """Read statements on what is known."""
    from mbs.unknowns.statement import read_statements

    return read_statements(text)


def _told(statements: Any) -> str:
    """Tell statements."""
    return "; ".join(one.text for one in statements)


def _with_knowledge(subject: Subject, statements: Any) -> Subject:
    """A subject of which more is known."""
    from mbs.scene.changes import with_clearance
    from mbs.unknowns.statement import known

    scene = subject.scene if subject.clearance is None else with_clearance(subject.scene, subject.clearance)
    subject = dataclasses.replace(subject, scene=known(scene, statements), clearance=None)
    for one in statements:
        if one.group == "temperature" and one.value is not None:
            subject = _with_temperature(subject, one.value)
    return subject


def _of_scene(name: str) -> Callable[[Subject, Any], Subject]:
    """A change of the scene by the function of `mbs.scene.changes` of this name."""

    def change(subject: Subject, value: Any) -> Subject:
        from mbs.scene import changes

        return dataclasses.replace(subject, scene=getattr(changes, name)(subject.scene, value))

    return change


_ROWS = (
    SceneChoice(
        "law",
        "LAW",
        "hertz | hertz:TIME | hertz:DAMPING | table:FILE.csv | formula | dietl | table | constant:NAME | map. dietl: "
        "that formula with Dietl's damping. table: films of the scene's oil from the film table, without a map. TIME "
        "is damping over stiffness of a dry contact ('hertz:1.25e-5 s'; usual: 0.25e-5 to 2.5e-5 s), DAMPING a "
        "constant one ('hertz:100 N s/m' of each contact of a roller), FILE.csv has points of approach, load and "
        "damping, NAME a table [laws.NAME]",
        "map with --map, else table, or hertz of a {file} without oil",
        str,
        _with_law,
        _law_text,
        example="hertz:1.25e-5 s",
        concerned="first",
    ),
    SceneChoice(
        "map",
        "MAP.nc",
        "made by `ehdmaps generate` for the same bearing; more than once for other types of bearing",
        "",
        str,
        _with_map,
    ),
    SceneChoice(
        "physics",
        "NAME",
        "heat in films of the film table: inlet-heat, by the rule of the inlet | isothermal",
        "inlet-heat, where the conductivity of the oil is known",
        one_of(_physics),
        _with_physics,
        example="isothermal",
        concerned="heat",
        usual=lambda physics: physics == _physics()[1],
    ),
    SceneChoice(
        STRUCTURE.name,
        STRUCTURE.metavar,
        STRUCTURE.said,
        "that of the map's job",
        STRUCTURE.read,
        _with_structure,
        example="half_space",
        concerned="maps",
        called=lambda name: f"structural law {name}",
    ),
    SceneChoice(
        "films",
        "KIND",
        "memory: films follow oscillations at their own frequency; slow: stiffness and damping of slow motion at any "
        "frequency. Statics are the same; without films: --law hertz",
        DEFAULT_FILMS,
        _films,
        _with_films,
        example="slow",
        concerned="relaxing",
        called=_films_words,
        usual=lambda kind: kind == DEFAULT_FILMS,
    ),
    SceneChoice(
        SUPPLY.name,
        SUPPLY.metavar,
        SUPPLY.said,
        "[supply] of the {file}, else of the job of the map, else flooded",
        SUPPLY.read,
        _with_supply,
        SUPPLY.text,
        example="oil air",
        concerned="relaxing",
        usual=lambda supply: bool(supply.flooded),
    ),
    SceneChoice(
        ROUGHNESS.name,
        ROUGHNESS.metavar,
        ROUGHNESS.said,
        "[surface] of the {file}, else of the job of the map, else smooth",
        ROUGHNESS.read,
        _with_roughness,
        ROUGHNESS.text,
        example="0.2 um",
        concerned="relaxing",
    ),
    SceneChoice(
        "temperature",
        "TEMPERATURE",
        'of the raceways, such as "60 degC"',
        "",
        _temperature,
        _with_temperature,
        TEMPERATURE.text,
        example="100 degC",
        concerned="oil",
    ),
    SceneChoice(
        "clearance",
        "LENGTH",
        'diametral clearance of all bearings, such as "20 um"',
        "",
        _either_way("m", WIDEST, f"within {MICROMETRE.text(WIDEST)} either way"),
        lambda subject, value: dataclasses.replace(subject, clearance=value),
        MICROMETRE.text,
        example="15 um",
    ),
    SceneChoice(
        "know",
        "STATEMENT",
        'how well a number is known, as [tolerances] of a scene: "clearance = 20 um +- 5 um", "clearance of NAME = +- '
        '0 um", "temperature = +- 2 K", "geometry = +- 0 %"',
        "what the {file} states, else usual spreads, which `mbs check` lists",
        _statements,
        _with_knowledge,
        _told,
        together=True,
    ),
    SceneChoice(
        "load-factor",
        "FACTOR",
        "multiplies all loads of the scene",
        "",
        _factor,
        _of_scene("with_loads"),
        _times,
        example="1.5",
        called=lambda factor: f"{_times(factor)} load",
    ),
    SceneChoice(
        "start-angle",
        "ANGLE",
        'at which all cages start, such as "7.5 deg"',
        "",
        _either_way("rad", 2.0 * math.pi, "a turn either way, such as '7.5 deg'"),
        _of_scene("with_start_angle"),
        DEGREE.text,
        example="7.5 deg",
        called=lambda angle: f"cage at {DEGREE.text(angle)}",
    ),
    SceneChoice(
        "speed",
        "SPEED",
        'operating speed, such as "1500 rpm"',
        "that of [operation]",
        _between("rad/s", 0.0, FASTEST, RPM),
        _of_scene("with_speed"),
        RPM.text,
        option=False,
    ),
    SceneChoice(
        "housing-damping",
        "FACTOR",
        "multiplies the damping ratios of bodies of finite elements",
        "",
        _factor,
        _of_scene("with_housing_damping"),
        _times,
        example="0.5",
        option=False,
    ),
    SceneChoice(
        "ramp",
        "TIME",
        "length of the run-up",
        "",
        _between("s", 1e-9, 1e6, _SECOND),
        _of_scene("with_duration"),
        _SECOND.text,
        example="10 s",
        option=False,
    ),
    SceneChoice(
        "step",
        "TIME",
        "time step of the run-up",
        "",
        _between("s", 1e-9, 1.0, _MICROSECOND),
        _of_scene("with_step"),
        _MICROSECOND.text,
        example="5 us",
        option=False,
        called=lambda step: f"step {_MICROSECOND.text(step)}",
    ),
    SceneChoice(
        "slices",
        "COUNT",
        "slices of all rollers",
        "",
        _slices,
        _of_scene("with_slices"),
        example="41",
        option=False,
        called=lambda slices: f"{slices} slices",
    ),
    SceneChoice(
        "cutoff",
        "FREQUENCY",
        "up to which flexible bodies have modes",
        "",
        _between("Hz", 1.0, 1e6, HERTZ),
        _of_scene("with_cutoff"),
        HERTZ.text,
        example="6 kHz",
        option=False,
        called=lambda cutoff: f"modes up to {HERTZ.text(cutoff)}",
    ),
)

CHOICES: Mapping[str, SceneChoice] = {choice.name: choice for choice in _ROWS}
"""What is chosen of a scene, by name; in this order cases are called."""

OPTIONS = tuple(choice for choice in _ROWS if choice.option)
"""Those that all commands on scenes take."""

LAWS = ("law", "map")
"""Those that make a law together: each name of a law and each set of maps is one."""

VARIED = {choice.name: choice for choice in _ROWS if choice.example}
"""Those that `mbs variants --vary` takes."""
