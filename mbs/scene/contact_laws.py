"""Contact law that a scene gets: its choice, what is wrong about it, the laws of each geometry; points from a file."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property, lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Literal, get_args

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import InputError, Problems
from ehdmaps.physics.bearing import BearingGeometry
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.oil_supply import FLOODED, FilmConditions, OilSupply
from ehdmaps.physics.solids import Material
from ehdmaps.physics.surface import SMOOTH, Surface
from ehdmaps.units import DAMPER, SPRING, closest, quantity
from mbs.bearings import laws
from mbs.bearings.bearing import Bearing
from mbs.bearings.bearing_element import NO_CENTRIFUGAL
from mbs.bearings.bearing_force import NO_COUPLED_MEMORY
from mbs.bearings.films import DryContacts, FilmSource, FormulaFilms, MapFilms
from mbs.bearings.laws import FORMULAS, DryLaw, Law
from mbs.model.relaxation import DEFAULT_FILMS, FILM_WORDS, Films
from mbs.scene.fields import read_columns
from mbs.scene.map_set import TABLE_LAW, speeds_of_laws, table_maps

if TYPE_CHECKING:
    from ehdmaps.maps.emap import EHDMap
    from ehdmaps.maps.law import ContactLaw, LawKind
    from ehdmaps.physics.closed_form import DampingFormula
    from mbs.scene.map_set import MapSet
    from mbs.scene.scene import Scene
    from mbs.scene.specs import BearingSpec, LocatingSpec


_LONGEST, _MOST = 1_000_000, 10_000
"""Longest file [bytes], and most points."""

_UNITS = {"approach": "m", "contact approach": "m", "load": "N/m", "damping": "N s/m^2"}
_ALLOWED = (
    "columns 'approach [um]' of both contacts in series, or 'contact approach [um]' of one; "
    "'load [N/mm]'; and 'damping [N s/m^2]' or none"
)


def read_law(path: Path, roller_length: float) -> DryLaw:
    """Law of a roller between both raceways from a file of points, held above its last one.

    Parameters
    ----------
    path : Path
        CSV file: lines that begin with # are left out, a line of names with units, a line for each point.
    roller_length : float
        Length by which load and damping per unit length become those of a roller [m].

    Raises
    ------
    InputError
        With what is wrong about the file, and where.
    """
    from mbs.scene.table_law import TableLaw, curve_problems  # laws by points alone need it

    name = f"law table:{path}"
    columns = read_columns(path, _UNITS, _ALLOWED, _MOST, _LONGEST, name)
    if "load" not in columns or ("approach" in columns) == ("contact approach" in columns):
        raise InputError(f"{name}: got the columns {', '.join(columns)}; allowed: {_ALLOWED}")
    found: dict[str, FloatArray] = {key: np.array(values) for key, values in columns.items()}
    kind: Literal["series", "single"] = "series" if "approach" in found else "single"
    approach = found.get("approach", found.get("contact approach"))
    assert approach is not None
    damping = found.get("damping", np.zeros(approach.size))
    if problems := curve_problems(approach, found["load"], damping):
        raise InputError([f"{name}, {line}" for line in problems])
    short = f"table:{path.name}"
    law = TableLaw(short, kind, approach, found["load"], damping, roller_length, "clamp")
    return law.series()


_HERTZ, _CONSTANT, _TABLE = "hertz:", "constant:", "table:"
_LONGEST_TIME, _STRONGEST = 1e-2, 1e9
"""Largest damper of a dry contact: by its ratio to the stiffness [s], and as a constant [N s/m], as in [laws.NAME]."""

HERTZ_FORMS = "hertz:TIME such as 'hertz:1.25e-5 s', hertz:DAMPING such as 'hertz:100 N s/m'"
"""The forms of the dry law with a damper, for messages."""

TABLE_FORM = "table:FILE.csv"
"""The form of the dry law by points, for messages."""

_FILM_LAWS = "map, formula and dietl"
"""Laws of cylindrical roller bearings that have films, in words."""

NO_LAW = "no contact law"
"""Label of a law in a scene without roller bearings."""

_LABELS = {"hertz": "dry Hertz", TABLE_LAW: "film table", **{name: one.label for name, one in FORMULAS.items()}}


def law_in_force(
    name: str | None, maps: MapSet | None, scene: Scene, inlet_heat: bool | None = None
) -> tuple[str, MapSet | None]:
    """The law that is meant, and its maps: all commands and `mbs.assemble` ask here.

    Parameters
    ----------
    name : str or None
        The law as it was asked for. None for the default: the maps where there are some, else films of the film
        table, and dry contacts of a scene without oil, see `dry_reason`.
    maps : MapSet or None
        The maps that were given.
    scene : Scene
        Bearings and oil.
    inlet_heat : bool or None
        Whether heat in the inlet thins films of the film table; None for the default.

    Raises
    ------
    InputError
        If the film table does not serve the scene.
    """
    if name is None:
        has_films = scene.lubricant is not None and scene.has_bearings
        name = "map" if maps is not None else TABLE_LAW if has_films else "hertz"
    if name == TABLE_LAW and maps is None and (scene.bearings or not scene.has_bearings):
        return "map", table_maps(scene, inlet_heat)
    return name, maps


def dry_reason(scene: Scene) -> str:
    """Reason why the bearings of a scene are dry by default, for people; empty where they are not.

    Parameters
    ----------
    scene : Scene
        Bearings and oil.
    """
    if scene.lubricant is not None or not scene.has_bearings:
        return ""
    return "dry, and so without damping, as the scene has no [lubricant]"


def law_label(law: str, maps: MapSet | None = None) -> str:
    """A law in two words, such as "dry Hertz"; maps by the solver that made them."""
    if law == "map" and maps is not None:
        return maps.label
    try:
        damper = hertz_damper(law)
    except InputError:
        damper = None  # whoever reads the law says what is wrong about it
    if damper is not None:
        return ", ".join(part for part in (_LABELS["hertz"], damper.words) if part)
    if (path := table_path(law)) is not None:
        return f"table {path.name}"
    return _LABELS.get(law, law.replace(":", " "))


def supply_words(supplies: Mapping[str, OilSupply]) -> str:
    """The oil supplies of the bearings of a scene, for people: one where all have the same.

    Parameters
    ----------
    supplies : mapping of str to OilSupply
        Supplies by the names of the bearings.

    Examples
    --------
    >>> supply_words({"left": FLOODED, "right": OilSupply(5e-6)})
    'left flooded, right oil layer 5 um'
    """
    if len(set(supplies.values())) <= 1:
        return next((supply.label for supply in supplies.values()), "")
    return ", ".join(f"{name} {supply.label}" for name, supply in supplies.items())


def surface_label(surface: Surface) -> str:
    """Label of the surfaces of a result.

    Examples
    --------
    >>> surface_label(SMOOTH), surface_label(Surface(2e-7))
    ('smooth surfaces', 'roughness 0.2 um')
    """
    return "smooth surfaces" if surface.smooth else surface.label


@dataclass(frozen=True)
class Damper:
    """Damper of a dry Hertzian contact.

    Attributes
    ----------
    constant : float
        c of each contact of a roller [N s/m].
    time : float
        Ratio of damping and stiffness of each contact [s].
    """

    constant: float = 0.0
    time: float = 0.0

    @property
    def words(self) -> str:
        """The damper of each contact of a roller, for people; empty without one."""
        if self.time:
            return f"c = {1e6 * self.time:.4g} us times k"
        return f"c = {DAMPER.text(self.constant)}" if self.constant else ""


def hertz_damper(law: str) -> Damper | None:
    """The damper of the law hertz, hertz:TIME or hertz:DAMPING; None for other laws.

    Parameters
    ----------
    law : str
        The law as it was given.

    Raises
    ------
    InputError
        If what follows hertz: is no damping with a unit, or is out of range.

    Examples
    --------
    >>> hertz_damper("hertz:1.25e-5 s")
    Damper(constant=0.0, time=1.25e-05)
    >>> hertz_damper("hertz:100 N s/m").words
    'c = 0.1 N s/mm'
    """
    if law == "hertz":
        return Damper()
    if not law.startswith(_HERTZ):
        return None
    text = law.removeprefix(_HERTZ)
    for unit, largest in (("s", _LONGEST_TIME), ("N s/m", _STRONGEST)):
        try:
            value = quantity(text, unit)
        except InputError:
            continue
        if 0.0 <= value <= largest:
            return Damper(time=value) if unit == "s" else Damper(constant=value)
        raise InputError(f"--law: got {law!r:.60}; allowed: dampers from 0 to {largest:g} {unit}")
    raise InputError(f"--law: got {law!r:.60}; allowed: {HERTZ_FORMS}")


def table_path(law: str) -> Path | None:
    """File of a law table:FILE, else None."""
    return Path(law.removeprefix(_TABLE)) if law.startswith(_TABLE) else None


def dry_words(law: str) -> str:
    """A law hertz, with or without a damper, or table:FILE, for people; empty for other laws.

    Examples
    --------
    >>> dry_words("hertz:100 N s/m")
    'dry Hertz, ISO 16281, c = 0.1 N s/mm of each contact of a roller'
    """
    if (path := table_path(law)) is not None:
        return f"table {path}, dry"
    if (damper := hertz_damper(law)) is None:
        return ""
    return "dry Hertz, ISO 16281" + (f", {damper.words} of each contact of a roller" if damper.words else "")


def table_problems(law: str) -> list[str]:
    """Problems with the file of a law table:FILE; nothing for other laws."""
    problems = Problems()
    if (path := table_path(law)) is not None:
        with problems.after("--law: "):
            read_law(path, 1.0)
    return problems


@dataclass(frozen=True, eq=False)
class ContactLaws:
    """The contact laws of a scene.

    Attributes
    ----------
    chosen : str
        hertz, hertz:TIME, hertz:DAMPING, one of `FORMULAS`, constant:NAME, table:FILE or map.
    scene : Scene
        Scene with its oil and its constant laws.
    maps : MapSet or None
        The maps of the law `map`.
    asked : {"slow", "memory"} or None
        Which films linear analyses are to have; None for `DEFAULT_FILMS` of `mbs.model.relaxation`, where they can.
    inlet_heat : bool
        Whether heat in the inlet thins films of the film table.
    """

    chosen: str
    scene: Scene
    maps: MapSet | None
    asked: Films | None = None
    inlet_heat: bool = False
    _made: dict[tuple[BearingGeometry, OilSupply], BearingLaws] = field(default_factory=dict, repr=False)

    def problems(self) -> list[str]:
        """Problems with the choice of the law."""
        scene = self.scene
        names = tuple(f"{_CONSTANT}{name}" for name in scene.laws)
        allowed = ("hertz", *FORMULAS, *names, TABLE_LAW, "map")
        try:
            damper = hertz_damper(self.chosen)
        except InputError as error:
            return list(error.problems)
        if wrong := table_problems(self.chosen):
            return wrong
        if self.chosen not in allowed and damper is None and table_path(self.chosen) is None:
            got = f"--law: got {self.chosen!r:.60}{closest(self.chosen, allowed)}"
            return [f"{got}; allowed here: {', '.join(allowed)}; {HERTZ_FORMS}; {TABLE_FORM}"]
        if self.chosen == "map" and self.maps is None:
            return ["--law: got 'map' without a map; allowed: with --map MAP.nc, made by `ehdmaps generate`"]
        maps = self._maps_in_force if scene.surface is None else None
        if maps is not None and (wrong := maps.surface_problems()):
            return wrong
        if self.chosen in FORMULAS and scene.lubricant is None:
            return [f"--law: got {self.chosen!r}, but {scene.name} has no [lubricant]; add the table to the scene"]
        centrifugal = [entry.name for entry in scene.bearings if entry.centrifugal and not entry.rollers_as_bodies]
        if centrifugal and not self._has_films:
            return [
                f"--law: got {self.chosen!r} with centrifugal = true in {', '.join(centrifugal)}; allowed: the laws "
                f"{_FILM_LAWS}, which bring a roller into equilibrium; or centrifugal = false"
            ]
        if self.asked not in (None, *get_args(Films)):
            return [f"--films: got {self.asked!r:.60}; allowed: {', '.join(get_args(Films))}"]
        return self._memory_problems() if self.asked == "memory" else []

    @property
    def memory(self) -> Films:
        """Films of linear analyses: they relax, "memory", or have stiffness and damping of slow motion, "slow"."""
        return self.asked or ("slow" if self._memory_problems() else DEFAULT_FILMS)

    def _memory_problems(self) -> list[str]:
        """Reasons why films cannot relax."""
        if self.chosen == TABLE_LAW:  # without bearings like NU
            return []
        if not self._has_films:
            got = f"--films: got 'memory' with the law {self.chosen!r:.60}"
            return [f"{got}; allowed: the laws {_FILM_LAWS}, which have films"]
        bearings = self.scene.bearings
        centrifugal = [entry.name for entry in bearings if entry.centrifugal and not entry.rollers_as_bodies]
        coupled = [entry.name for entry in bearings if entry.slices_coupled]
        return [
            f"--films: {words}; so has {', '.join(names)}"
            for words, names in ((NO_CENTRIFUGAL, centrifugal), (NO_COUPLED_MEMORY, coupled))
            if names
        ]

    def bearing_problems(self, name: str, geometry: BearingGeometry) -> list[str]:
        """In what the map in force was made for something else than a bearing."""
        maps = self._maps_in_force
        return [] if maps is None else maps.problems(f"bearing {name!r}", geometry)

    def supply(self, spec: BearingSpec) -> OilSupply:
        """The oil supply of a bearing: its own goes before that of the scene, and that of the map."""
        emap = self.map_of(spec.geometry)
        return spec.supply or self.scene.supply or (emap.supply if emap is not None else FLOODED)

    @property
    def supplies(self) -> dict[str, OilSupply]:
        """The oil supply of each bearing by its name; none of bearings without films."""
        rollers = {spec.name: self.supply(spec) for spec in self.scene.bearings} if self._has_films else {}
        located = {spec.name: self.conditions.supply for spec in self.scene.located if self.films_of(spec)}
        return rollers | located

    def films_of(self, spec: LocatingSpec) -> bool:
        """Tell whether a bearing that carries axial load has films."""
        return self.chosen in (TABLE_LAW, "map") or (self.chosen in FORMULAS and not spec.of_points)

    @property
    def conditions(self) -> FilmConditions:
        """Conditions of the films of bearings that carry axial load."""
        supply, surface = self.scene.supply, self.surface or self.scene.surface
        return FilmConditions(self.inlet_heat, supply or FLOODED, surface or SMOOTH)

    @property
    def oils(self) -> dict[str, Lubricant]:
        """The oil of each bearing by its name, that of its map where there is one; none for laws without films."""
        if not self._has_films:
            return {}
        bearings, maps = self.scene.bearings, self._maps_in_force
        return {spec.name: self.lubricant for spec in bearings} if maps is None else maps.oils(bearings)

    @property
    def _maps_in_force(self) -> MapSet | None:
        """The maps, where the law is that of maps."""
        return self.maps if self.chosen == "map" else None

    def map_of(self, geometry: BearingGeometry) -> EHDMap | None:
        """The map of a bearing, where the law is that of maps."""
        maps = self._maps_in_force
        return None if maps is None else maps.of(geometry)

    @property
    def surface(self) -> Surface | None:
        """Surfaces of all contacts: those of the scene go before those of the map; None for laws without films."""
        if not self._has_films:
            return self.scene.surface if self.chosen == TABLE_LAW else None
        maps = self._maps_in_force
        return self.scene.surface or (SMOOTH if maps is None else maps.maps[0].surface)

    def of(self, bearing: Bearing, supply: OilSupply) -> BearingLaws:
        """The laws of the contacts of a bearing with an oil supply; those of the same contacts are made once."""
        key = bearing.geometry.without_clearance, supply
        if key not in self._made:
            self._made[key] = BearingLaws(self, bearing, supply)
        return self._made[key]

    def films(self, bearing: Bearing, supply: OilSupply) -> FilmSource:
        """Source of the films of a bearing with an oil supply."""
        if (emap := self.map_of(bearing.geometry)) is not None:
            return MapFilms(emap, supply)
        contacts = bearing.geometry.contacts(bearing.material, "iso16281")
        return FormulaFilms(contacts, self.lubricant, supply) if self.chosen in FORMULAS else DryContacts(contacts)

    @property
    def lubricant(self) -> Lubricant:
        """The oil of the scene, which `problems` saw."""
        assert self.scene.lubricant is not None
        return self.scene.lubricant

    @property
    def label(self) -> str:
        """The law in a few words, as the legend of a figure has it; of its films only what is not the default."""
        films = self._film_words if self.memory != DEFAULT_FILMS else ""
        rough = "" if self.surface is None or self.surface.smooth else f", {self.surface.label}"
        return law_label(self.chosen, self.maps) + films + self.supply_label + rough

    @property
    def supply_label(self) -> str:
        """Addition to a legend on the oil supply: nothing where all bearings are flooded, or the law has no films."""
        found = set(self.supplies.values())
        if all(supply.flooded for supply in found):
            return ""
        return f", {found.pop().short}" if len(found) == 1 else ", supply by bearing"

    @property
    def words(self) -> str:
        """The law, for people."""
        supply = supply_words(self.supplies)
        surface = "" if self.surface is None else f", {surface_label(self.surface)}"
        return self._law_words + (f", {supply}" if supply else "") + surface + self._film_words

    @property
    def _film_words(self) -> str:
        """Kind of films that the law has, where it has films."""
        return f", {FILM_WORDS[self.memory]}" if self._has_films or self.chosen == TABLE_LAW else ""

    @property
    def _has_films(self) -> bool:
        """True where the law has films."""
        return self.chosen == "map" or self.chosen in FORMULAS

    @property
    def _law_words(self) -> str:
        """The law without its films."""
        if (maps := self._maps_in_force) is not None:
            return maps.words
        if self.chosen in FORMULAS:
            return f"{FORMULAS[self.chosen].words}, {self.lubricant.title}"
        if words := dry_words(self.chosen):
            return words
        name = self.chosen.removeprefix(_CONSTANT)
        stiffness, damping = self.scene.laws[name]
        return f"constant {name}: {SPRING.text(stiffness)} and {DAMPER.text(damping)} for each contact of a roller"


@dataclass(frozen=True, eq=False)
class BearingLaws:
    """Laws for one geometry; outside its map a law is held at the edge, and calls there are counted.

    Attributes
    ----------
    given : ContactLaws
        The choice.
    bearing : Bearing
        One with that geometry.
    supply : OilSupply
        Oil supply of its contacts, where they have films.
    """

    given: ContactLaws
    bearing: Bearing
    supply: OilSupply

    @cached_property
    def series(self) -> Law:
        """Law of a roller between both raceways."""
        if self.given.chosen == "map" or self.given.chosen in FORMULAS:
            return self._of_kind("series")
        if (path := table_path(self.given.chosen)) is not None:
            return read_law(path, self.bearing.geometry.roller_length)
        damper = hertz_damper(self.given.chosen)
        if damper is not None:
            return laws.hertz(self.bearing, damper.constant, damper.time)
        return laws.constant(*self.given.scene.laws[self.given.chosen.removeprefix(_CONSTANT)])

    @cached_property
    def single(self) -> tuple[Law, Law]:
        """Laws of the inner and of the outer contact."""
        if isinstance(self.series, DryLaw):
            return self.series.single(), self.series.single()
        return self._of_kind("inner"), self._of_kind("outer")

    def _of_kind(self, kind: LawKind) -> Law:
        """A law with films."""
        surface = self.given.surface
        if (emap := self.given.map_of(self.bearing.geometry)) is not None:
            return emap.law(kind, outside="clamp", supply=self.supply, surface=surface)
        speeds = speeds_of_laws(self.bearing.geometry, self.given.scene)
        bearing, oil, damping = self.bearing, self.given.lubricant, FORMULAS[self.given.chosen].damping
        return _of_formula(bearing.geometry, bearing.material, oil, speeds, damping, kind, self.supply, surface).again()


@lru_cache(maxsize=8)
def _of_formula(
    geometry: BearingGeometry,
    material: Material,
    lubricant: Lubricant,
    speeds: tuple[float, float],
    damping: DampingFormula,
    kind: LawKind,
    supply: OilSupply,
    surface: Surface | None,
) -> ContactLaw:
    """Law of the film formula, made once for all models with such bearings, however many slices their rollers have."""
    bearing = Bearing(geometry, material=material)
    return laws.formula(
        bearing,
        lubricant,
        entrainment_speed=speeds,
        damping=damping,
        kind=kind,
        outside="clamp",
        supply=supply,
        surface=surface,
    )
