"""A family of bearings as `mbs bearing` asks for it: what differs between them is a row."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, NamedTuple

from ehdmaps.errors import Problems
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.oil_supply import FilmConditions, OilSupply
from ehdmaps.physics.solids import STEEL, Material
from ehdmaps.physics.surface import Surface
from ehdmaps.units import Tolerance
from mbs.bearings.thermal import BearingState
from mbs.output.one_bearing.kind import Description, Kind, Points
from mbs.scene.contact_laws import Damper

if TYPE_CHECKING:
    from ehdmaps.maps.emap import EHDMap
    from mbs.bearings.deviating.tables import Deviations
    from mbs.bearings.locating.normal_law import PairLaw
    from mbs.exports.one_bearing.kind import ExportKind
    from mbs.one_bearing.linear_files import Oscillating


class Operating(NamedTuple):
    """Loads and speeds that are asked for.

    Attributes
    ----------
    loads : tuple of float
        Sizes of the radial load on the inner ring [N].
    axial : float
        Axial load on the inner ring [N].
    way : (float, float)
        Direction of the radial load, y and z; a unit vector.
    speeds : tuple of float
        Speeds of the inner ring [rad/s].
    outer_speed : float
        Speed of the outer ring [rad/s].
    """

    loads: tuple[float, ...]
    axial: float
    way: tuple[float, float]
    speeds: tuple[float, ...]
    outer_speed: float


class Asked(NamedTuple):
    """A bearing as it was asked for; what nothing states is None.

    Attributes
    ----------
    geometry : BearingGeometry, BallGeometry or TaperedGeometry
        Geometry with its clearance.
    options : mapping
        What its scene says of it beside: profile, slices, by their names there.
    assumed : tuple of str
        What is assumed of it, in words.
    material : Material
        Material of rings and rolling elements.
    oil, supply, surface : Lubricant, OilSupply, Surface or None
        What its file, or its map, states.
    state : BearingState or None
        Temperatures of its raceways, where they are stated.
    emap : EHDMap or None
        Map of its films.
    structure : str or None
        Structural law of the films of the table.
    tolerances : mapping of str to Tolerance
        How well its numbers are known, as its file says.
    """

    geometry: Any
    options: Mapping[str, Any]
    assumed: tuple[str, ...] = ()
    material: Material = STEEL
    oil: Lubricant | None = None
    supply: OilSupply | None = None
    surface: Surface | None = None
    state: BearingState | None = None
    emap: EHDMap | None = None
    structure: str | None = None
    tolerances: Mapping[str, Tolerance] = MappingProxyType({})


class AtSpeed(NamedTuple):
    """The force at a speed, its films where a point tells of them, and what is to be said of it.

    Attributes
    ----------
    force : BearingForce, BallForce or TaperedForce
        Geometry and law.
    films : FilmSource or BallFilms or None
        What knows the films of its contacts.
    problems, notes : tuple of str
        Why films are lacking, and what is to be known of them.
    """

    force: Any
    films: Any = None
    problems: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()


@dataclass(frozen=True, eq=False)
class Request:
    """Bearing with its law and films, loads and speeds, as asked for on the command line.

    Attributes
    ----------
    family : Family
        Family of the bearing.
    asked : Asked
        The bearing, with what is stated of it.
    law : str
        Law of its contacts.
    damper : Damper
        Damper of a dry law.
    by_default : bool
        Whether the law is that of the default: speeds without films are dry then, and say why.
    physics : str or None
        What films are to know of heat, as it was asked for; None for the default.
    memory : bool
        Whether the films of a file for another program have a memory.
    stated_supply : OilSupply or None
        Oil supply that is stated; None where contacts are only assumed to be flooded.
    oil : Lubricant
        Oil of the films.
    conditions : FilmConditions
        Heat in the inlet, oil supply and surfaces of contacts with films; smooth where a roughness is only assumed.
    operating : Operating
        Loads and speeds.
    description : Description
        The same in words.
    trial : bool
        Whether it is a changed one, for a band: its films are not told of.
    deviations : Deviations or None
        Deviations of the bearing from its form, for what is written of it and runs in time.
    """

    family: Family
    asked: Asked
    law: str
    damper: Damper
    by_default: bool
    physics: str | None
    memory: bool
    stated_supply: OilSupply | None
    oil: Lubricant
    conditions: FilmConditions
    operating: Operating
    description: Description
    trial: bool = False
    deviations: Deviations | None = None

    @property
    def films(self) -> str:
        """Law with films, by name; empty where the law is dry."""
        return self.law if self.law in self.family.film_laws else ""

    @cached_property
    def force(self) -> Any:
        """Geometry and law, the dry one where films are those of a speed: what `Family.force` makes."""
        return self.family.force(self)

    def entrainment_speed(self, speed: float) -> float:
        """Entrainment speed at a speed of the inner ring [rad/s], in m/s."""
        return float(self.force.geometry.entrainment_speed(speed, self.operating.outer_speed))


@dataclass(frozen=True)
class Family:
    """A family of bearings: what its command takes, and how it is answered.

    Attributes
    ----------
    kind : Kind
        Table of its points.
    words : str
        How a bearing is called.
    taken, own : tuple of str
        Choices that it takes, and further options: profile, slices.
    film_laws : tuple of str
        Laws with films, by name.
    beside_laws : str
        What a message says after the laws that are allowed.
    memory : tuple of str
        Endings of files whose films may have a memory.
    spec : type
        What a scene holds of it.
    read : callable
        (arguments, choices, problems) -> bearing as it was asked for; None where a problem was noted.
    wrong : callable
        (bearing as it was asked for, loads and speeds) -> what is wrong with these; empty where nothing is.
    force : callable
        (request) -> force, with the dry law where films are those of a speed.
    words_of : callable
        (request) -> law, and films, in words.
    at_speed : callable
        (request) -> function of the speed of the inner ring [rad/s].
    point : callable
        (force, load, speeds of both rings, and by name tilts, oil, temperature and films) -> point.
    films : callable
        (request) -> law with the films of an entrainment speed [m/s]; None without any.
    exported : callable or None
        () -> what its sources and units have of their own; None of those that are made of maps.
    oscillating : callable or None
        (points) -> K and C of films with memory.
    own_law : callable
        (law) -> problems of a law that no other family has; None of other laws.
    finished : callable
        (request) -> the request with what is made of all of it: maps.
    beside : callable
        (request, points) -> further lines on a single point.
    """

    kind: Kind
    words: str
    taken: tuple[str, ...]
    own: tuple[str, ...]
    film_laws: tuple[str, ...]
    beside_laws: str
    memory: tuple[str, ...]
    spec: type
    read: Callable[[argparse.Namespace, Mapping[str, Any], Problems], Asked | None]
    wrong: Callable[[Asked, Operating], str]
    force: Callable[[Request], Any]
    words_of: Callable[[Request], tuple[str, str]]
    at_speed: Callable[[Request], Callable[[float], AtSpeed]]
    point: Callable[..., Any]
    films: Callable[[Request], Callable[[float], PairLaw] | None] = lambda request: None
    exported: Callable[[], ExportKind] | None = None
    oscillating: Callable[[Sequence[Any]], Oscillating] | None = None
    own_law: Callable[[str], list[str] | None] = lambda law: None
    finished: Callable[[Request], Request] = lambda request: request
    beside: Callable[[Request, Points], list[str]] = lambda request, points: []
