"""Films of a ball bearing's contacts at one speed and temperature over load: read from the table of points, or solved.

The table is read at its own loads; where it has too few, a contact is solved by `ehdmaps.point.solver` at loads that
are evenly spaced in the logarithm. Between loads film offset, damping and films are cubics in the logarithms of value
and load, which at the table's loads are the table's own; beyond the loads that have a film they go on straight. On an
oil layer and between rough surfaces these are what `ehdmaps.maps.points.layers` begins with; the offset is then a cubic
itself, as it may be below zero.
Stiffness comes from the slope of the film offset, which is smoother than the tangents of single solutions. A load that
has no film is left out where its neighbours have one on both sides, and the loads end there else.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from scipy.interpolate import CubicSpline, PPoly

from ehdmaps.arrays import FloatArray, IntArray
from ehdmaps.errors import SolverError
from ehdmaps.maps.kernels.tables import film_part
from ehdmaps.physics.hertz import POINT_LIMIT
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.oil_supply import PLAIN, FilmConditions
from ehdmaps.physics.point.ball_geometry import BallGeometry
from ehdmaps.physics.point.ellipse import Ellipse
from ehdmaps.physics.solids import STEEL, Material
from ehdmaps.table.points.file import shipped_point_table
from ehdmaps.table.points.films import PointFilms
from ehdmaps.units import written
from mbs.bearings.balls.laws import BallLaw, film_normal_law
from mbs.bearings.balls.response import ContactResponse

if TYPE_CHECKING:
    from ehdmaps.maps.points.layers import LayeredFilms, PointPlace

LOADS_PER_DECADE = 3
FEWEST = 4
"""Films that a curve needs."""

MISSING = 2
"""Neighbouring loads without a film at which a curve ends."""

LIGHTEST = 2.0
"""Lightest load [N]; the heaviest one has the Hertz pressure of the static limit."""

_BEYOND = 30.0
"""Factor by which the law's table goes on above the heaviest load; below the lightest the kernel goes on straight."""


@dataclass(frozen=True, eq=False)
class ContactFilms:
    """Films of one contact over load.

    Attributes
    ----------
    loads : array (n,)
        Loads that have a film [N].
    values : array (n, 4)
        Film offset, central film, minimum film [m], damping [N s/m].
    errors : array (n, 4)
        Stated relative errors of the same.
    left_out : tuple of str
        Loads that have no film, and why.
    read_loads : int
        How many loads were read from the table, all or none.
    response : ContactResponse or None
        Response over frequency; None of films that were solved.
    layered : LayeredFilms or None
        What oil supply and surfaces make of the values; None of flooded films of smooth surfaces.
    """

    loads: FloatArray
    values: FloatArray
    errors: FloatArray
    left_out: tuple[str, ...]
    read_loads: int = 0
    response: ContactResponse | None = None
    layered: LayeredFilms | None = None

    def read(self, load: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Values at loads (k,) and their slopes by ln load, each (4, k).

        Parameters
        ----------
        load : array (k,)
            Loads [N], > 0.
        """
        spline, slope = self._splines
        asked = np.log(load)
        inside = np.clip(asked, spline.x[0], spline.x[-1])
        slopes = slope(inside)
        values = spline(inside) + slopes * (asked - inside)[:, None]
        logs = slice(0 if self.layered is None else 1, None)
        values[:, logs] = np.exp(values[:, logs])
        slopes[:, logs] *= values[:, logs]
        values[:, 2] = np.minimum(values[:, 2], values[:, 1])  # cubics and straight ends may cross
        return values.T, slopes.T

    @cached_property
    def _splines(self) -> tuple[PPoly, PPoly]:
        """Logarithms of the values over that of the load, and their slopes; the offset itself under layers."""
        if self.layered is None:
            places, values = np.log(self.loads), np.log(self.values)
        else:
            places, values = np.log(self.layered.loads), self.layered.values.copy()
            values[:, 1:] = np.log(values[:, 1:])
        spline = CubicSpline(places, values, axis=0)
        return spline, spline.derivative()

    def under(self, place: PointPlace, conditions: FilmConditions) -> ContactFilms:
        """The same films under an oil supply and between surfaces; their errors are added.

        Parameters
        ----------
        place : PointPlace
            The contact.
        conditions : FilmConditions
            Oil supply and surfaces.
        """
        from ehdmaps.maps.points.layers import fine_loads, layered_films, on_layer  # with what only layers need

        loads = fine_loads(float(self.loads[0]), float(self.loads[-1]))
        found = layered_films(place, conditions, loads, self.read(loads)[0].T)
        errors, response = self.errors, self.response
        if not conditions.supply.flooded:
            more = on_layer(place, conditions.supply, self.loads, self.values).errors
            errors = errors + more
            response = None if response is None else response.with_errors(more[:, 0], more[:, 3])
        return dataclasses.replace(self, errors=errors, response=response, layered=found)

    def largest_errors(self, load: FloatArray) -> FloatArray:
        """Largest errors at loads: of the films on both sides of each, (4,); NaN without loads.

        Parameters
        ----------
        load : array (k,)
            Loads [N], > 0.
        """
        if not load.size:
            return np.full(self.errors.shape[1], math.nan)
        above = np.searchsorted(self.loads, load)
        beside = np.clip(np.r_[above - 1, above], 0, self.loads.size - 1)
        return np.asarray(self.errors[beside].max(axis=0))

    def curve(self, load: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Offset, its slope and damping, see `mbs.bearings.balls.laws.FilmCurve`."""
        values, slopes = self.read(np.atleast_1d(load))
        return values[0], slopes[0], values[3]


@dataclass(frozen=True, eq=False)
class BallFilms:
    """Films of both contacts, and the law that they make.

    Attributes
    ----------
    inner, outer : ContactFilms
        Films over load.
    law : BallLaw
        Law of both contacts.
    """

    inner: ContactFilms
    outer: ContactFilms
    law: BallLaw

    @property
    def sides(self) -> tuple[ContactFilms, ContactFilms]:
        """Inner and outer."""
        return self.inner, self.outer

    @property
    def words(self) -> str:
        """Errors and loads, for people."""
        offset, central, minimum, damping = (
            max(float(side.errors[:, column].max()) for side in self.sides) for column in range(4)
        )
        low, high = self.law.loads
        read = sum(side.read_loads for side in self.sides)
        solved = sum(side.loads.size for side in self.sides) - read
        parts = [f"read from the table at {read}"] * (read > 0) + [f"solved at {solved}"] * (solved > 0)
        return (
            f"{', '.join(parts)} loads, {low:.3g} to {written(high)} N; errors "
            f"up to {offset:.1%} of the film offset, {central:.1%} of the central and {minimum:.1%} of the smallest "
            f"film, {damping:.1%} of the damping"
        )

    def faded(self, geometry: BallGeometry, speed: float, material: Material = STEEL) -> BallLaw:
        """Law at a lower speed of films that fade to the dry contacts at rest, film offset and damping alike.

        Parameters
        ----------
        geometry : BallGeometry
            The bearing.
        speed : float
            The speed by that of these films, above 0 up to 1.
        material : Material
            Material of balls and rings.
        """
        part = max(film_part(speed, 1.0), 1e-30)  # as those of maps fade
        low, high = self.law.loads
        laws = []
        for contact, side in zip(geometry.contacts(material), self.sides, strict=True):

            def curve(load: FloatArray, side: ContactFilms = side) -> tuple[FloatArray, FloatArray, FloatArray]:
                offset, slope, damping = side.curve(load)
                return part * offset, part * slope, part * damping

            laws.append(film_normal_law(contact, curve, (low, _BEYOND * high)))
        return dataclasses.replace(self.law, inner=laws[0], outer=laws[1])


def slowest_films(geometry: BallGeometry, oil: Lubricant, temperature: float, material: Material = STEEL) -> float:
    """Lowest entrainment speed at which the film table of points has films of both contacts [m/s].

    Parameters
    ----------
    geometry : BallGeometry
        The bearing.
    oil : Lubricant
        The oil.
    temperature : float
        Temperature of the raceways [K].
    material : Material
        Material of balls and rings.
    """
    table = shipped_point_table()
    return max(table.slowest(contact, oil, temperature) for contact in geometry.contacts(material)) * (1.0 + 1e-9)


def ball_films(
    geometry: BallGeometry,
    oil: Lubricant,
    entrainment_speed: float,
    temperature: float,
    material: Material = STEEL,
    *,
    table: bool = True,
    solves: bool = True,
    conditions: FilmConditions = PLAIN,
) -> BallFilms:
    """Films of both contacts over load.

    Parameters
    ----------
    geometry : BallGeometry
        The bearing.
    oil : Lubricant
        The oil.
    entrainment_speed : float
        Mean of the two surface speeds [m/s], > 0.
    temperature : float
        Temperature of the raceways [K].
    material : Material
        Material of balls and rings.
    table : bool
        Whether films are read from the table of points where it has them.
    solves : bool
        Whether films of a contact are solved where the table has too few.
    conditions : FilmConditions
        Heat in the inlet, oil supply and surfaces.

    Raises
    ------
    SolverError
        If too few loads of a contact have a film.
    InputError
        If the oil has no such temperature; for heat of an oil whose conductivity is not known.
    """
    contacts = geometry.contacts(material)
    films = []
    for side, contact in zip(("inner", "outer"), contacts, strict=True):
        point = _Point(oil, entrainment_speed, temperature, conditions.inlet_heat)
        found = _contact_films(side, contact, point, table, solves)
        if not conditions.plain:
            from ehdmaps.maps.points.layers import PointPlace

            found = found.under(PointPlace(contact, oil, entrainment_speed, temperature), conditions)
        films.append(found)
    low, high = max(float(side.loads[0]) for side in films), min(float(side.loads[-1]) for side in films)
    inner, outer = (
        film_normal_law(contact, side.curve, (low, _BEYOND * high))
        for contact, side in zip(contacts, films, strict=True)
    )
    responses = tuple(side.response for side in films if side.response is not None)
    known = responses if len(responses) == len(films) else ()
    return BallFilms(films[0], films[1], BallLaw(inner, outer, (low, high), known))


class _Point(NamedTuple):
    """Oil, entrainment speed [m/s], temperature [K], and whether heat in the inlet thins the films."""

    oil: Lubricant
    speed: float
    temperature: float
    inlet_heat: bool


class _Film(NamedTuple):
    """Film of one load: values and errors in the order of `ContactFilms`, no values where there is none, why, place."""

    load: float
    values: tuple[float, ...]
    errors: tuple[float, ...]
    reason: str
    place: int = 0


_NAMES = ("film_offset", "central_film", "minimum_film", "damping")


def _contact_films(side: str, contact: Ellipse, point: _Point, table: bool, solves: bool) -> ContactFilms:
    """Films of a contact over load."""
    heaviest = float((POINT_LIMIT / contact.max_pressure(1.0)) ** 3)
    found, films = _read(contact, point, heaviest) if table else ([], None)
    kept = _together(found)
    read = len(kept) >= FEWEST
    if solves and not read:
        count = max(FEWEST, math.ceil(LOADS_PER_DECADE * math.log10(heaviest / LIGHTEST)) + 1)
        found = list(_solved(contact, point, np.geomspace(LIGHTEST, heaviest, count)))
        kept = _together(found)
    left_out = tuple(f"{written(one.load)} N: {one.reason}" for one in found if one not in kept)
    if len(kept) < FEWEST:
        raise SolverError(
            f"films of the {side} contact: {len(kept)} of {len(found)} loads from {LIGHTEST:g} to "
            f"{written(heaviest)} N "
            f"have a film at {point.speed:.4g} m/s; at least {FEWEST} are needed ({'; '.join(left_out[:2])})"
        )
    loads = np.array([one.load for one in kept])
    response = None
    if read and films is not None:
        response = ContactResponse(loads, _some(films, np.array([one.place for one in kept])))
    return ContactFilms(
        loads,
        np.array([one.values for one in kept]),
        np.array([one.errors for one in kept]),
        left_out,
        len(kept) if read else 0,
        response,
    )


def _some(films: PointFilms, places: IntArray) -> PointFilms:
    """Some of films."""
    errors = {name: values[places] for name, values in films.errors.items()}
    own = [entry.name for entry in dataclasses.fields(films) if entry.name != "errors"]
    return PointFilms(**{name: getattr(films, name)[places] for name in own}, errors=errors)


def _read(contact: Ellipse, point: _Point, heaviest: float) -> tuple[list[_Film], PointFilms]:
    """Films of the table at its own loads, and at both ends."""
    films = shipped_point_table()
    nodes = films.loads(contact, point.oil, point.speed, point.temperature)
    loads = np.r_[LIGHTEST, nodes[(nodes > LIGHTEST * _NEAR) & (nodes < heaviest / _NEAR)], heaviest]
    read = films.films(contact, point.oil, loads, point.speed, point.temperature, point.inlet_heat)
    usable, reasons = read.usable.tolist(), read.reason.tolist()
    values = np.column_stack([getattr(read, name) for name in _NAMES]).tolist()
    errors = np.column_stack([read.errors[name] for name in _NAMES]).tolist()
    found = [
        _Film(load, tuple(values[i]) if usable[i] else (), tuple(errors[i]), reasons[i], i)
        for i, load in enumerate(loads.tolist())
    ]
    return found, read


_NEAR = 1.02
"""Ratio of a load of the table to an end that it stands beside, at least."""


def _solved(contact: Ellipse, point: _Point, loads: FloatArray) -> Iterator[_Film]:
    """Films of loads from light to heavy that are solved, until neighbours beyond one that has a film have none."""
    from ehdmaps.point.solver import heated_solution, solve

    missing, heavy = 0, False
    for load in map(float, loads):
        one = solve(contact, point.oil, load, point.speed, point.temperature)
        if point.inlet_heat:
            one = heated_solution(one, point.oil)
        good = one.status.usable and one.damping > 0.0 and one.film_offset > 0.0
        values = tuple(getattr(one, name) for name in _NAMES) if good else ()
        heavy = heavy or good
        yield _Film(load, values, tuple(getattr(one, name).error for name in _NAMES), one.reason)
        missing = 0 if good else missing + 1
        if heavy and missing == MISSING:
            break


def _together(found: list[_Film]) -> list[_Film]:
    """The longest row of films in which no two neighbours are missing."""
    rows: list[list[_Film]] = [[]]
    missing = 0
    for one in found:
        if one.values:
            rows[-1].append(one)
            missing = 0
        else:
            missing += 1
            if missing == MISSING:
                rows.append([])
    return max(rows, key=len)
