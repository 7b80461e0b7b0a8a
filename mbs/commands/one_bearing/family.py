"""A family of bearings that carry axial load, as `mbs bearing` asks for them: what differs between them is a row."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple

from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.oil_supply import FilmConditions
from mbs.output.one_bearing.kind import Description, Kind
from mbs.scene.contact_laws import Damper

if TYPE_CHECKING:
    from mbs.bearings.locating.film_tables import PairLaw
    from mbs.bearings.locating.locating_point import LocatingPoint
    from mbs.commands.one_bearing.linear_files import Oscillating
    from mbs.commands.one_bearing.shared import Operating
    from mbs.exports.one_bearing.kind import ExportKind


class Asked(NamedTuple):
    """A bearing as it was asked for.

    Attributes
    ----------
    geometry : BallGeometry or TaperedGeometry
        Geometry with its clearance.
    options : mapping
        What its force takes beside: profile, slices.
    """

    geometry: Any
    options: Mapping[str, Any]


class AtSpeed(NamedTuple):
    """The force at a speed, its films where a point tells of them, and what is to be said of it.

    Attributes
    ----------
    force : BallForce or TaperedForce
        Geometry and law.
    films : BallFilms or None
        Films of balls.
    problems, notes : tuple of str
        Why films are lacking, and what is to be known of them.
    """

    force: Any
    films: Any = None
    problems: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()


@dataclass(frozen=True, eq=False)
class Request:
    """Bearing by designation with its law and films, loads and speeds, as asked for on the command line.

    Attributes
    ----------
    family : Family
        Family of the bearing.
    asked : Asked
        The bearing, with what its force takes beside.
    damper : Damper
        Damper of its dry law.
    films : str
        Law with films, by name; empty where the law is dry.
    by_default : bool
        Whether films are those of the default: speeds without any are dry then, and say why.
    memory : bool
        Whether the films of a file for another program have a memory.
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
    """

    family: Family
    asked: Asked
    damper: Damper
    films: str
    by_default: bool
    memory: bool
    oil: Lubricant
    conditions: FilmConditions
    operating: Operating
    description: Description
    trial: bool = False

    @cached_property
    def force(self) -> Any:
        """Geometry, and its dry law: a BallForce or a TaperedForce."""
        return self.family.force(self.asked, self.damper)

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
    read : callable
        (arguments, choices, problems) -> bearing as it was asked for; None where a problem was noted.
    axial_problem : callable
        (geometry, axial load) -> what is wrong with an axial load; empty where nothing is.
    force : callable
        (asked, damper) -> force with the dry law.
    words_of : callable
        (law with films or empty, oil, damper, conditions of the films) -> law, and films, in words.
    films : callable
        (request) -> law with the films of an entrainment speed [m/s]; None without any.
    at_speed : callable
        (request) -> function of the speed of the inner ring [rad/s].
    point : type
        Class of its points.
    exported : callable
        () -> what its sources and units have of their own.
    oscillating : callable or None
        (points) -> K and C of films with memory.
    assumed : tuple of str
        What is assumed of each of them.
    """

    kind: Kind
    words: str
    taken: tuple[str, ...]
    own: tuple[str, ...]
    film_laws: tuple[str, ...]
    beside_laws: str
    memory: tuple[str, ...]
    read: Callable[[argparse.Namespace, Mapping[str, Any], list[str]], Asked | None]
    axial_problem: Callable[[Any, float], str]
    force: Callable[[Asked, Damper], Any]
    words_of: Callable[[str, Lubricant, Damper, FilmConditions], tuple[str, str]]
    films: Callable[[Request], Callable[[float], PairLaw] | None]
    at_speed: Callable[[Request], Callable[[float], AtSpeed]]
    point: type[LocatingPoint]
    exported: Callable[[], ExportKind]
    oscillating: Callable[[Sequence[Any]], Oscillating] | None = None
    assumed: tuple[str, ...] = ()
