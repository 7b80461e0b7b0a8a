"""The contact maps of a scene: one for each type of bearing, and how maps that are given together are sorted into sets.

A map is made for raceways and rollers, not for a bearing by name. So each bearing takes the map that was made for its
contacts. Maps for different types of bearing belong together and make one law; of several maps for the same type each
makes a law of its own, to be compared.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING

from ehdmaps.errors import InputError, Problems
from ehdmaps.physics.bearing import BearingGeometry
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.units import LENGTH

if TYPE_CHECKING:
    from ehdmaps.maps.emap import EHDMap
    from mbs.scene.scene import Scene
    from mbs.scene.specs import BearingSpec

_SAME = 1e-9
_COMPARED = ("inner_raceway_diameter", "outer_raceway_diameter", "roller_diameter", "roller_length")

_LABELS = {"reynolds": "Reynolds map", "openfoam": "OpenFOAM map", "formula": "formula map", "hertz": "Hertz map"}

TABLE_LAW = "table"
"""The law of films from the film table: that of maps that `table_maps` makes in memory."""

OTHER_OIL = "--map: holds the films of one oil; make a map of another, or leave it out: the film table has them"
"""What is said where a map from a file would need another oil."""

_SPEEDS, _BEYOND = (0.05, 10.0), 1.05
"""Entrainment speeds of laws that are made for a scene [m/s], and how far they go beyond a scene that is faster."""


@dataclass(frozen=True, eq=False)
class MapSet:
    """Maps that make one law: one for each type of bearing.

    Attributes
    ----------
    maps : tuple of EHDMap
        The maps, at least one; no two for the same contacts.

    Raises
    ------
    InputError
        If there is none, two are made for the same contacts, or their jobs state different surfaces.
    """

    maps: Sequence[EHDMap]

    def __post_init__(self) -> None:
        object.__setattr__(self, "maps", tuple(self.maps))
        problems = Problems([] if self.maps else ["--map: got none; allowed: at least one map"])
        problems += [
            f"--map: got two maps for the same contacts ({_made_for(first)}, {_made_for(second)}); allowed: one map "
            "for each type of bearing; assemble a model for each map to compare them"
            for first, second in itertools.combinations(self.maps, 2)
            if _same_type(first, second)
        ]
        problems.check()

    def of(self, geometry: BearingGeometry) -> EHDMap | None:
        """The map that was made for the contacts of a bearing; None if there is none.

        Parameters
        ----------
        geometry : BearingGeometry
            Geometry of the bearing.
        """
        return next((emap for emap in self.maps if suits(emap, geometry)), None)

    def oils(self, bearings: Iterable[BearingSpec]) -> dict[str, Lubricant]:
        """The oil of each bearing that has a map, by its name: that of the map.

        Parameters
        ----------
        bearings : iterable of BearingSpec
            Bearings of the scene.
        """
        found = {spec.name: self.of(spec.geometry) for spec in bearings}
        return {name: emap.lubricant for name, emap in found.items() if emap is not None}

    def problems(self, where: str, geometry: BearingGeometry) -> list[str]:
        """Reasons why a bearing, which messages call `where`, gets no map of these.

        Parameters
        ----------
        where : str
            How messages call the bearing.
        geometry : BearingGeometry
            Geometry of the bearing.
        """
        if self.of(geometry) is not None:
            return []
        if len(self.maps) == 1:
            return geometry_problems(where, geometry, self.maps[0])
        given = ", ".join(_made_for(emap) + _nearly(emap, geometry) for emap in self.maps)
        return [
            f"--map: {where}, {geometry.name}, has no map; given are maps of {given}; allowed: one map for each "
            "type of bearing; `mbs plan SCENE -o JOB.toml` writes the jobs, and `ehdmaps generate` makes the maps"
        ]

    def surface_problems(self) -> list[str]:
        """Problems with the surfaces of the maps, where the scene states none."""
        found = {emap.surface for emap in self.maps}
        if len(found) <= 1:
            return []
        words = ", ".join(
            f"{_made_for(emap)}: {'smooth' if emap.surface.smooth else emap.surface.label}" for emap in self.maps
        )
        return [f"--map: the jobs of the maps state different surfaces ({words}); state [surface] in the scene"]

    def known_at(self, temperature: float) -> bool:
        """Tell whether a temperature [K] is within all maps.

        Parameters
        ----------
        temperature : float
            Temperature of the raceways [K].
        """
        ends = [emap.axis("temperature")[[0, -1]] for emap in self.maps]
        return all(low <= temperature <= high for low, high in ends)

    def each(self, change: Callable[[EHDMap], EHDMap]) -> MapSet:
        """The set with each map changed.

        Parameters
        ----------
        change : callable
            Gives another map for one of these.
        """
        return MapSet([change(emap) for emap in self.maps])

    @property
    def label(self) -> str:
        """By which solvers they were made, such as "Reynolds map"."""
        return " and ".join(dict.fromkeys(map(_label, self.maps)))

    @property
    def words(self) -> str:
        """The maps, for people; what they have in common is said once."""
        names: dict[str, list[str]] = {}
        for emap in self.maps:
            names.setdefault(f"{emap.lubricant.title}, {_made_by(emap)}", []).append(_made_for(emap))
        return "; ".join(
            f"{'map' if len(several) == 1 else 'maps'} of {' and '.join(several)}, {how}"
            for how, several in names.items()
        )


def _label(emap: EHDMap) -> str:
    """By which solver a map was made, in two words."""
    return "film table" if emap.from_table else _LABELS.get(emap.solver, "map")


def map_sets(maps: Sequence[tuple[str, EHDMap]], bearings: Sequence[BearingSpec] | None) -> list[tuple[str, MapSet]]:
    """Sort maps that are given together into sets, each with what tells it from the others.

    Parameters
    ----------
    maps : sequence of (str, EHDMap)
        Maps with names for people, in the order in which they were given.
    bearings : sequence of BearingSpec or None
        Bearings of the scene; None where it could not be read.

    Returns
    -------
    list of (str, MapSet)
        One map of each type in every combination; those of one oil where there are such. The words name the maps of
        types that have more than one, and are empty where there is one set.

    Raises
    ------
    InputError
        With each map that suits no bearing, where there are several.
    """
    if not maps:
        return []
    groups: list[list[tuple[str, EHDMap]]] = []
    for name, emap in maps:
        group = next((group for group in groups if _same_type(group[0][1], emap)), None)
        if group is None:
            groups.append([(name, emap)])
        else:
            group.append((name, emap))
    if bearings is not None and len(groups) > 1:
        _check_all_suit(maps, bearings)
    several = [len(group) > 1 for group in groups]
    found = []
    for members in itertools.product(*groups):
        words = " ".join(name for (name, _), more in zip(members, several, strict=True) if more)
        found.append((words, MapSet([emap for _, emap in members])))
    of_one_oil = [(words, one) for words, one in found if all(m.lubricant == one.maps[0].lubricant for m in one.maps)]
    return of_one_oil or found


def suits(emap: EHDMap, geometry: BearingGeometry) -> bool:
    """Tell whether a map was made for the contacts of a bearing.

    Parameters
    ----------
    emap : EHDMap
        The map.
    geometry : BearingGeometry
        Geometry of the bearing; clearance and number of rollers are no part of its contacts.
    """
    return emap.bearing is not None and not _differing(emap.bearing, geometry)


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
    differing = _difference_words(made_for, geometry)
    if not differing:
        return []
    return [
        f"--map: is made for {made_for.name}: {differing} as the {geometry.name} of {where}; generate a map "
        "of that bearing"
    ]


def structure_words(emap: EHDMap) -> str:
    """The structural law of a map as the end of a sentence; nothing where it is that of the dry law, ISO 16281."""
    return "" if emap.structural_law == "iso16281" else f", structural law {emap.structural_law}"


def _check_all_suit(maps: Iterable[tuple[str, EHDMap]], bearings: Sequence[BearingSpec]) -> None:
    """Raise with each map that no bearing takes."""
    types: dict[str, list[str]] = {}
    for spec in bearings:
        types.setdefault(spec.geometry.name, []).append(spec.name)
    there = "; ".join(f"{kind} ({', '.join(names)})" for kind, names in types.items())
    problems = Problems(
        f"--map: {name} is made for {_made_for(emap)}{_nearest(emap, bearings)}, which no bearing of the scene is; "
        f"there are {there}; leave it out"
        for name, emap in maps
        if not any(suits(emap, spec.geometry) for spec in bearings)
    )
    problems.check()


def _differing(first: BearingGeometry, second: BearingGeometry) -> list[str]:
    """In which lengths the contacts of two bearings differ."""
    return [key for key in _COMPARED if abs(getattr(first, key) - getattr(second, key)) > _SAME]


def _difference_words(made_for: BearingGeometry, geometry: BearingGeometry) -> str:
    """In which lengths a map was made for something else than a bearing, with both values; empty where in none."""
    return ", ".join(
        f"{key} {LENGTH.text(getattr(made_for, key), 6)} and not {LENGTH.text(getattr(geometry, key), 6)}"
        for key in _differing(made_for, geometry)
    )


def _nearly(emap: EHDMap, geometry: BearingGeometry) -> str:
    """In what a map that could be meant for a bearing differs: one of its name, or with another length alone."""
    if emap.bearing is None or not (differing := _differing(emap.bearing, geometry)):
        return ""
    meant = emap.bearing.name == geometry.name or len(differing) == 1
    return f" ({_difference_words(emap.bearing, geometry)})" if meant else ""


def _nearest(emap: EHDMap, bearings: Sequence[BearingSpec]) -> str:
    """The same for the first bearing that it could be meant for."""
    return next((words for spec in bearings if (words := _nearly(emap, spec.geometry))), "")


def _same_type(first: EHDMap, second: EHDMap) -> bool:
    """Tell whether two maps are made for the same contacts; those of bare contacts count as one type."""
    if first.bearing is None or second.bearing is None:
        return first.bearing is second.bearing
    return suits(first, second.bearing)


def _made_for(emap: EHDMap) -> str:
    """Name of what a map was made for."""
    return emap.bearing.title if emap.bearing else "a bare contact"


def _made_by(emap: EHDMap) -> str:
    """Way in which a map was made."""
    films = "films from the film table" if emap.from_table else f"solver {emap.solver}"
    films += ", inlet heat" if emap.inlet_heat else ", isothermal" if emap.from_table else ""
    return films + structure_words(emap)


def speeds_of_laws(geometry: BearingGeometry, scene: Scene) -> tuple[float, float]:
    """Range of the entrainment speed of laws that are made for a scene [m/s]; no bearing of this geometry exceeds it.

    Parameters
    ----------
    geometry : BearingGeometry
        The bearing.
    scene : Scene
        The scene.
    """
    spin = max((abs(body.spin) for body in scene.bodies), default=0.0)
    # Rings turn against each other at most.
    fastest = abs(geometry.entrainment_speed(spin * scene.fastest, -spin * scene.fastest))
    return _SPEEDS[0], max(_SPEEDS[1], _BEYOND * fastest)


def table_maps(scene: Scene, inlet_heat: bool | None = None) -> MapSet:
    """Maps of all types of bearing of a scene, over the usual ranges and those of the scene; a second each.

    Parameters
    ----------
    scene : Scene
        Bearings and oil.
    inlet_heat : bool or None
        Whether heat in the inlet thins the films, by its rule (`ehdmaps.physics.heat`); None for the default.

    Raises
    ------
    InputError
        If the scene has no oil or no bearing; for heat that the film table cannot have.
    """
    return _from_table(scene, inlet_heat, (), _made)


def again_from_table(maps: MapSet, scene: Scene) -> MapSet:
    """Maps of a scene that is a little different from that of others: those that still hold are taken as they are.

    Parameters
    ----------
    maps : MapSet
        What `table_maps` made of the other scene.
    scene : Scene
        Bearings and oil.

    Raises
    ------
    InputError
        As `table_maps`.

    Notes
    -----
    New maps are not kept: some hundred scenes that are tried once would fill the memory.
    """
    first = maps.maps[0]
    kept = [
        emap for emap in maps.maps if emap.lubricant == scene.lubricant and MapSet([emap]).known_at(scene.temperature)
    ]
    found = _from_table(scene, first.inlet_heat, kept, _made.__wrapped__)
    return found.each(lambda emap: emap if emap in kept else emap.with_structure(first.structural_law))


def _from_table(scene: Scene, inlet_heat: bool | None, known: Sequence[EHDMap], make: Callable[..., EHDMap]) -> MapSet:
    """Maps of a scene: some that are known, and new ones."""
    from ehdmaps.jobs.make.table_law import TEMPERATURES

    if scene.lubricant is None:
        raise InputError(
            f"--law: got {TABLE_LAW!r}, but {scene.name} has no [lubricant]; add the table to the scene, or give a map"
        )
    if not scene.bearings:
        raise InputError(f"--law: got {TABLE_LAW!r}, but {scene.name} has no bearings; leave it out")
    temperatures = min(TEMPERATURES[0], scene.temperature), max(TEMPERATURES[1], scene.temperature)
    maps: list[EHDMap] = []
    for spec in scene.bearings:
        if any(suits(emap, spec.geometry) for emap in maps):
            continue
        there = next((emap for emap in known if suits(emap, spec.geometry)), None)
        if there is None:
            plain = spec.geometry.without_clearance
            there = make(plain, scene.lubricant, speeds_of_laws(plain, scene), temperatures, inlet_heat)
        maps.append(there)
    return MapSet(maps)


@lru_cache(maxsize=16)
def _made(
    geometry: BearingGeometry,
    lubricant: Lubricant,
    speeds: tuple[float, float],
    temperatures: tuple[float, float],
    inlet_heat: bool | None,
) -> EHDMap:
    """Map of one type of bearing, made once in a process."""
    from ehdmaps.jobs.make.table_law import table_map  # with the solver, for what the table does not know

    return table_map(geometry, lubricant, entrainment_speeds=speeds, temperatures=temperatures, inlet_heat=inlet_heat)
