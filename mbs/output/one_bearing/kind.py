"""A kind of bearings as a table of one bearing asks for it: numbers, columns and lines, and parts that kinds share.

The kinds are rows: `mbs.output.one_bearing.cylindrical`, `mbs.output.one_bearing.balls`, `mbs.output.one_bearing.ribs`.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.oil_supply import OilSupply
from ehdmaps.physics.surface import SMOOTH, Surface
from ehdmaps.units import DAMPER, FILM, PRESSURE, RPM, SPRING, Display, written
from mbs.bearings.thermal import BearingState
from mbs.life import required_viscosity
from mbs.output.state_text import HIGHEST_LOAD, LOADED
from mbs.passes import passes_of

if TYPE_CHECKING:
    from ehdmaps.electrics.dielectric import Dielectric
    from mbs.unknowns.statement import Statement

Points = Sequence[Sequence[Any]]
"""Points of one kind, by load, then by speed."""

Row = Mapping[str, Any]
"""Numbers of a point by name, SI: single ones, and pairs of the inner and the outer contact."""


@dataclass(frozen=True, eq=False)
class Description:
    """Description that all points of a result have in common, in words and numbers.

    Attributes
    ----------
    law, films : str
        Law of the contacts and source of the films, in words.
    direction : float
        Direction of the radial load, from y towards z [deg].
    temperature, roughness : float
        [K], [m].
    tilts : bool
        Whether the inner ring tilts freely.
    assumed : tuple of str
        What was not given.
    surface : Surface
        Surfaces of the contacts, whose load film and asperities share where they are rough.
    supply : OilSupply or None
        Oil supply of the contacts; None where it is always flooded.
    oil : Lubricant or None
        The oil; None where the points do not need it.
    state : BearingState or None
        Temperatures of the raceways, and what they make of the clearance; None where both have `temperature`.
    known : tuple of Statement
        Statements on how well numbers are known.
    dielectric : Dielectric or None
        Oil as a dielectric; None where no electric numbers are asked for.
    more : tuple of Number
        Numbers that are asked for beside those of the kind.
    """

    law: str
    films: str
    direction: float
    temperature: float
    roughness: float
    tilts: bool
    assumed: tuple[str, ...]
    surface: Surface = SMOOTH
    supply: OilSupply | None = None
    oil: Lubricant | None = None
    state: BearingState | None = None
    known: tuple[Statement, ...] = ()
    dielectric: Dielectric | None = None
    more: tuple[Number, ...] = ()


class Number(NamedTuple):
    """A number of a point, a pair of its inner and outer contacts, or an array over its rolling elements.

    Attributes
    ----------
    name, unit, words : str
        Name and unit in files, and meaning.
    read : callable or None
        (point, description) -> number or array, SI; None: the attribute of that name.
    dims : tuple of str
        Dimensions of an array.
    """

    name: str
    unit: str
    words: str
    read: Callable[[Any, Description], Any] | None = None
    dims: tuple[str, ...] = ()

    def of(self, point: Any, description: Description) -> FloatArray:
        """Value at a point.

        Parameters
        ----------
        point : object
            The point.
        description : Description
            What all points have in common.
        """
        value = getattr(point, self.name) if self.read is None else self.read(point, description)
        return np.asarray(value, dtype=np.float64)


class Column(NamedTuple):
    """A column of the table of several points.

    Attributes
    ----------
    head, unit : str
        Two lines of its heading.
    width : int
        Letters that it takes.
    text : callable
        (row) -> text of its number.
    rough : bool
        Whether it stands with rough surfaces alone.
    """

    head: str
    unit: str
    width: int
    text: Callable[[Row], str]
    rough: bool = False


class Pair(NamedTuple):
    """A line of the page of one point: a number of the inner and the outer contact.

    Attributes
    ----------
    label : str
        What it is.
    shown : Display
        How it is shown.
    name : str
        Name of the numbers.
    """

    label: str
    shown: Display
    name: str


class Curves(NamedTuple):
    """Loads, pressures and films of one point over a place.

    Attributes
    ----------
    title, place_words, load_words : str
        What is shown, and names of the axes.
    place : array (n,)
        Places, as they are shown.
    load : array (1 or 2, n)
        Loads, as they are shown: of both raceways, or of the inner one.
    pressure, central_film, minimum_film : array (2, n)
        Those of the inner and outer contacts, SI.
    """

    title: str
    place_words: str
    load_words: str
    place: FloatArray
    load: FloatArray
    pressure: FloatArray
    central_film: FloatArray
    minimum_film: FloatArray


def _around(element: str, point: Any) -> Curves:
    """Loads, pressures and films of all rolling elements, around the bearing."""
    elements = point.elements
    rows = len(getattr(point.force.geometry, "rows", (None,)))
    row = np.arange(elements.angle.size) * rows // elements.angle.size
    order = np.lexsort((elements.angle, row))
    ends = np.flatnonzero(np.diff(row)) + 1  # lines of rows do not go on in the next one
    values = (elements.load[:2], point.pressure, point.central_film, point.minimum_film)
    load, pressure, central, minimum = (np.insert(side[:, order], ends, np.nan, axis=1) for side in values)
    place = np.insert(np.degrees(elements.angle[order]), ends, np.nan)
    words = f"angle of the {element} from y towards z, degrees"
    return Curves("around the bearing", words, f"load of the\n{element}, N", place, load, pressure, central, minimum)


def _record(_: Description, point: Any) -> dict[str, Any]:
    """Attributes on the geometry of a point."""
    return {f"bearing_{name}": value for name, value in point.force.geometry.record().items() if name != "name"}


@dataclass(frozen=True)
class Kind:
    """A kind of bearings: what its points have, and what is told of them.

    Attributes
    ----------
    element, words : str
        How a rolling element and the bearing are called.
    static_limit : float
        Hertz pressure of its static load rating [Pa].
    axial : bool
        Whether loads, motions and matrices have all directions; else they are radial ones.
    numbers, sides, each : tuple of Number
        Numbers of a point, pairs of its contacts, and arrays over its rolling elements.
    columns : tuple of Column
        Columns of the table of several points.
    about : callable
        (description, point) -> lines of the heading.
    closing : callable
        (point, row) -> last lines of the page of one point.
    heads : (str, str)
        Two lines of heading of the rolling elements, after those of number and angle.
    of_one : callable
        (point, index) -> what is told of a rolling element.
    pairs : callable
        (point) -> lines on its contacts between pressure and films, and after them.
    attributes : callable
        (description, point) -> attributes of a dataset; by default the geometry.
    coordinates : callable
        (point) -> further coordinates of a dataset, by name.
    curves_of : callable or None
        (point) -> what a figure shows of one point; by default what all rolling elements feel.
    beside_lambda : callable
        (point, description) -> words after those on Lambda.
    last : callable
        (point) -> lines after those of the rolling elements.
    remarks : callable
        (points, description) -> lines before the warnings.
    """

    element: str
    words: str
    static_limit: float
    axial: bool
    numbers: tuple[Number, ...]
    sides: tuple[Number, ...]
    each: tuple[Number, ...]
    columns: tuple[Column, ...]
    about: Callable[[Description, Any], list[str]]
    closing: Callable[[Any, Row], list[str]]
    heads: tuple[str, str]
    of_one: Callable[[Any, int], str]
    pairs: Callable[[Any], tuple[Sequence[Pair], Sequence[Pair]]] = lambda point: ((), ())
    attributes: Callable[[Description, Any], dict[str, Any]] = _record
    coordinates: Callable[[Any], dict[str, Any]] = lambda point: {}
    curves_of: Callable[[Any], Curves] | None = None
    beside_lambda: Callable[[Any, Description], str] = lambda point, description: ""
    last: Callable[[Any], list[str]] = lambda point: []
    remarks: Callable[[Sequence[Any], Description], list[str]] = lambda points, description: []

    def curves(self, point: Any) -> Curves:
        """Curves that a figure shows of one point."""
        return self.curves_of(point) if self.curves_of else _around(self.element, point)

    def numbers_of(self, description: Description) -> tuple[Number, ...]:
        """Numbers of its points, with further ones that are asked for."""
        return (*self.numbers, *description.more)

    @property
    def old_names(self) -> dict[str, str]:
        """Names of variables that each kind had for itself, and what they are copies of until the next release."""
        return {f"loaded_{self.element}s": "loaded_elements", f"highest_{self.element}_load": "highest_raceway_load"}


SI = Display("")
"""Numbers as they are."""

_WORDS = {"along": "along the radial load", "across": "across the radial load", "axial": "along the axis"}
_MATRICES = (("stiffness", "N/m", ""), ("damping", "N s/m", ", low-frequency limit"))


def numbers_of(own: Sequence[Number], *, axial: bool, speed: str = "") -> tuple[Number, ...]:
    """Numbers that all kinds have, with those of a kind between speeds and loads.

    Parameters
    ----------
    own : sequence of Number
        Numbers of the kind.
    axial : bool
        Whether the kind moves along its axis.
    speed : str
        Place of the entrainment speed, in words.
    """
    ways = tuple(_WORDS)[: 3 if axial else 2]
    matrices = [
        Number(f"{name}_{way}", unit, f"{name} of the bearing {_WORDS[way]}{more}", _entry(name, place))
        for name, unit, more in _MATRICES
        for place, way in enumerate(ways)
    ]
    moved = [
        Number(f"displacement_{way}", "m", f"inner ring against the outer one, {_WORDS[way]}", _place(place))
        for place, way in enumerate(ways)
    ]
    tilts = [
        Number(f"tilt_{axis}", "rad", f"tilt of the inner ring about {axis}", _tilt(place))
        for place, axis in ((4, "y"), (5, "z"))
    ]
    passing = [
        Number(f"{name}_frequency", "Hz", words, _passes(place))
        for place, (name, words) in enumerate(
            (
                ("cage", "turns of the cage (FTF)"),
                ("outer_pass", "passes of a place of the outer raceway (BPFO)"),
                ("inner_pass", "passes of a place of the inner raceway (BPFI)"),
                ("element", "turns of a rolling element about its axis (BSF)"),
            )
        )
    ]
    film = "Lambda, smallest film over the combined rms roughness"
    return (
        *matrices,
        *moved,
        *(tilts if axial else []),
        Number("entrainment_speed", "m/s", f"mean of the two surface speeds{speed}"),
        *own,
        Number("highest_raceway_load", "N", HIGHEST_LOAD, lambda p, _: np.max(first_row(p.elements.load))),
        Number("loaded_elements", "1", LOADED, lambda p, _: p.loaded),
        *passing,
        Number("film_parameter", "1", film, lambda p, description: p.smallest_film / description.roughness),
        Number("equivalent_load", "N", "equivalent load P_ref of ISO/TS 16281", lambda p, _: p.reference.load),
        Number("reference_life", "1", "basic reference life L10r in millions of turns", lambda p, _: p.reference.life),
        Number("viscosity_ratio", "1", "viscosity ratio kappa of ISO 281", _viscosity_ratio),
    )


def _passes(place: int) -> Callable[[Any, Description], float]:
    """Reader of one of the frequencies of `Passes`."""

    def read(point: Any, description: Description) -> float:
        found = passes_of(point.geometry, point.geometry.row_elements, point.inner_speed, point.outer_speed)
        return found[place] / (2.0 * math.pi)

    return read


def _viscosity_ratio(point: Any, description: Description) -> float:
    """Ratio kappa of ISO 281; NaN where nothing turns, or no oil is known."""
    speed = abs(point.inner_speed - point.outer_speed)
    if description.oil is None or speed == 0.0:
        return math.nan
    oil = description.oil.at(description.temperature)
    return oil.viscosity / oil.density / required_viscosity(speed, point.geometry.pitch_diameter)


def first_row(load: FloatArray) -> FloatArray:
    """Loads of the inner raceway of all rolling elements."""
    return np.asarray(np.atleast_2d(load)[0])


def _entry(name: str, way: int) -> Callable[[Any, Description], Any]:
    """Reader of the entry of a matrix in a direction."""
    return lambda point, _: point.along_across(getattr(point, name))[way]


def _place(way: int) -> Callable[[Any, Description], Any]:
    """Reader of the displacement in a direction."""
    return lambda point, _: point.pose[0] if way == 2 else (point.axes @ point.pose[:3])[way]


def _tilt(place: int) -> Callable[[Any, Description], Any]:
    """Reader of a tilt."""
    return lambda point, _: point.pose[place]


CONTACT_SIDES = (
    Number("hertz_pressure", "Pa", "largest Hertz pressure", lambda p, _: [side.max() for side in p.pressure]),
    Number("central_film", "m", "smallest central film", lambda p, _: [smallest(side) for side in p.central_film]),
    Number("minimum_film", "m", "smallest film", lambda p, _: [smallest(side) for side in p.minimum_film]),
)
"""Pairs of points that know each rolling element."""


def column(head: str, unit: str, width: int, digits: int, name: str, shown_as: Display = SI) -> Column:
    """A column of a number.

    Parameters
    ----------
    head, unit, width
        See `Column`.
    digits : int
        Digits that count.
    name : str
        Name of the number.
    shown_as : Display
        How it is shown.
    """
    return Column(head, unit, width, lambda row: f"{shown_as.value(row[name]):.{digits}g}")


def columns_of(element: str, before: Sequence[Column], after: Sequence[Column], *, axial: bool) -> tuple[Column, ...]:
    """Columns of the table of a kind: those of all kinds, and its own before and after pressure and films.

    Parameters
    ----------
    element : str
        Name of a rolling element.
    before, after : sequence of Column
        Columns of the kind.
    axial : bool
        Whether the kind moves along its axis.
    """
    return (
        column("load", "N", 10, 5, "load"),
        column("speed", "rpm", 8, 5, "speed", RPM),
        column("K along", SPRING.unit, 9, 4, "stiffness_along", SPRING),
        column("across", SPRING.unit, 9, 4, "stiffness_across", SPRING),
        *([column("axial", SPRING.unit, 9, 4, "stiffness_axial", SPRING)] if axial else []),
        column("c along", DAMPER.unit, 9, 4, "damping_along", DAMPER),
        column(f"{element}s", "loaded", max(len(element) + 1, len("loaded")), 5, "loaded_elements"),
        column("highest", "N", 9, 5, "highest_raceway_load"),
        *before,
        Column("Hertz", PRESSURE.unit, 7, lambda row: f"{PRESSURE.value(max(row['hertz_pressure'])):.4g}"),
        Column("smallest", f"film, {FILM.unit}", 9, lambda row: shown(FILM.value(smallest(row["minimum_film"])), 4)),
        Column("Lambda", "", 7, lambda row: shown(row["film_parameter"], 3)),
        column("P_ref", "N", 9, 5, "equivalent_load"),
        *after,
    )


def row_of(kind: Kind, description: Description, point: Any) -> dict[str, Any]:
    """Numbers of a point by name, SI; NaN where it has no answer.

    Parameters
    ----------
    kind : Kind
        Kind of the bearing.
    description : Description
        What all points have in common.
    point : object
        Point of the kind.
    """
    row: dict[str, Any] = {"load": point.size, "speed": point.inner_speed}
    for number in kind.numbers_of(description):
        row[number.name] = math.nan if point.failed else float(number.of(point, description))
    for number in kind.sides:
        row[number.name] = np.full(2, math.nan) if point.failed else number.of(point, description)
    return row


def tilting(description: Description, element: str) -> str:
    """Tell how the load acts, and whether the ring tilts.

    Parameters
    ----------
    description : Description
        What all points have in common.
    element : str
        Name of a rolling element.
    """
    return (
        f"load at {description.direction:.4g} deg from y (a {element}) towards z, inner ring "
        f"{'tilts freely' if description.tilts else 'does not tilt'}"
    )


def smallest(values: FloatArray) -> float:
    """Smallest number; NaN if there is none.

    Parameters
    ----------
    values : ndarray
        Any of them may be NaN.
    """
    known = values[np.isfinite(values)]
    return float(known.min()) if known.size else math.nan


def shown(value: float, digits: int = 5) -> str:
    """A number; a dash where there is none.

    Parameters
    ----------
    value : float
        The number, or NaN.
    digits : int
        Digits that count.
    """
    return "-" if math.isnan(value) else written(value, digits)


def no_dust(value: float) -> float:
    """Zero in place of round-off."""
    return 0.0 if abs(value) < 1e-9 else value
