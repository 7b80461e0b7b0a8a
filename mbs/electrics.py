"""A bearing in an electric circuit: capacitance, time constant and breakdown, by the films of all its contacts.

The inner and the outer contact of a rolling element are in series, the elements are in parallel. Contacts without load
are open: balls and rollers are taken in the middle of their gap, opened by the thickest film that is known on that
side. All contacts have the same time constant, so that the voltage of an element is shared in the same way at all
frequencies, V_i = V C_o/(C_i + C_o): the film that breaks down first is that with the smallest h (C_i + C_o)/C_o.

Bands have the stated errors of films of balls; films of lines and those of formulas add none.

Left out: shoulders of the rings (some 3 pF), cage, ribs, and how far open slices of rollers between ribs are.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ehdmaps.arrays import BoolArray, FloatArray
from ehdmaps.electrics.contact import ContactElectrics, electrics_of
from ehdmaps.electrics.dielectric import FIELDS, USUAL_FIELD, VACUUM, Dielectric, under_pressure
from ehdmaps.electrics.gaps import LINE_ERROR, line_integral, open_line, open_point, point_integral
from ehdmaps.physics.bearing import BearingGeometry
from ehdmaps.physics.contact import LineContact
from ehdmaps.physics.hertz import max_pressure
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.point.ball_geometry import BallGeometry
from ehdmaps.physics.point.ellipse import Ellipse
from ehdmaps.physics.rollers.ribbed_geometry import RibbedGeometry
from ehdmaps.physics.rollers.tapered_geometry import TaperedGeometry
from mbs.bearings.films import FormulaFilms

if TYPE_CHECKING:
    from mbs.bearings.contact_report import BearingPoint
    from mbs.bearings.tapered.tapered_point import TaperedPoint

LEAST_GAP = 1e-8
"""Gap of contacts that just touch without a film that is known [m]."""


class Side(NamedTuple):
    """Contacts of all elements with one raceway.

    Attributes
    ----------
    capacitance, low, high : array (Z,)
        [F].
    film : array (Z,)
        Smallest films, or gaps [m].
    loaded : array (Z,) of bool
        Whether it carries load on a film.
    """

    capacitance: FloatArray
    low: FloatArray
    high: FloatArray
    film: FloatArray
    loaded: BoolArray


@dataclass(frozen=True, eq=False)
class BearingElectrics:
    """A bearing between its rings; NaN where it has no films.

    Attributes
    ----------
    capacitance, low, high : float
        Capacitance, and its band by the outlet and by the errors of films and rule [F].
    idle : float
        Part of it of elements without load.
    time_constant : float
        R C [s]; NaN where no conductivity is known.
    film : float
        Film that breaks down first [m].
    share : float
        Part of the voltage of the bearing that lies at that film.
    """

    capacitance: float
    low: float
    high: float
    idle: float
    time_constant: float
    film: float
    share: float

    @property
    def resistance(self) -> float:
        """R [ohm]; NaN where no conductivity is known."""
        return self.time_constant / self.capacitance

    @property
    def breakdown(self) -> tuple[float, float]:
        """Band of the voltage at which it breaks down [V]."""
        low, high = (field * self.film / self.share for field in FIELDS)
        return low, high

    @property
    def usual_breakdown(self) -> float:
        """Voltage at the field that is taken most [V]."""
        return USUAL_FIELD * self.film / self.share


def bearing_electrics(point: Any, lubricant: Lubricant, temperature: float, oil: Dielectric) -> BearingElectrics:
    """Electric properties of a bearing at a point.

    Parameters
    ----------
    point : BallPoint, TaperedPoint or BearingPoint
        The bearing at rest.
    lubricant : Lubricant
        The oil.
    temperature : float
        Temperature of the raceways [K].
    oil : Dielectric
        The oil as a dielectric.
    """
    nan = math.nan
    none = BearingElectrics(nan, nan, nan, nan, nan, nan, nan)
    if point.failed or not point.entrainment_speed > 0.0:
        return none
    of_side = _SIDES[type(point.geometry)]
    sides = [of_side(point, side, _State(lubricant, temperature, oil)) for side in (0, 1)]
    if not all(np.any(side.loaded) for side in sides):
        return none
    inner, outer = sides
    together = [a * b / (a + b) for a, b in zip(inner[:3], outer[:3], strict=True)]
    idle = ~(inner.loaded & outer.loaded)
    shares = np.array([outer.capacitance, inner.capacitance]) / (inner.capacitance + outer.capacitance)
    films = np.array([inner.film, outer.film])
    first = np.unravel_index(np.argmin(films / shares), films.shape)
    total, low, high = (float(np.sum(each)) for each in together)
    part = float(np.sum(together[0][idle])) / total
    return BearingElectrics(total, low, high, part, oil.time_constant, float(films[first]), float(shares[first]))


class _State(NamedTuple):
    """The oil at a temperature [K], and as a dielectric."""

    lubricant: Lubricant
    temperature: float
    oil: Dielectric

    @property
    def permittivity(self) -> float:
        """Without pressure."""
        return self.oil.at(self.lubricant, self.temperature)


def _balls(point: Any, side: int, state: _State) -> Side:
    """Contacts of all balls with a raceway."""
    from mbs.bearings.balls.ball_findings import groove_half_width

    force, balls = point.force, point.elements
    ellipse: Ellipse = force.geometry.contacts(force.material)[side]
    outer_gap = state.oil.outer_gap
    if outer_gap is None:
        outer_gap = 2.0 * groove_half_width(force.geometry, side) ** 2 / ellipse.transverse_radius
    numbers = (balls.load, point.central_film, point.minimum_film, point.film_offset)
    load, central, minimum, offset = (values[side] for values in numbers)
    known = np.isfinite(central) & (load > 0.0)
    films = central[known], minimum[known], offset[known]
    whole = point_integral(ellipse, load[known], *films, outer_gap)
    pressure = np.asarray(ellipse.max_pressure(load[known]))
    error = float(np.nan_to_num(point.film_errors[side, :2]).sum())
    zone = under_pressure(state.permittivity, state.lubricant, state.temperature, pressure, "point")
    found = electrics_of(whole, state.oil, state.lubricant, state.temperature, zone, error, minimum[known])
    gap = _gaps(balls.approach[side], central)[~known]
    return _side(known, found, gap, VACUUM * state.permittivity * open_point(ellipse, gap, outer_gap))


def _lines(contact: LineContact, load: FloatArray, films: Any, gap: FloatArray, length: float, state: _State) -> Side:
    """Contacts of all slices (Z, n) with a raceway, by their films and gaps; of rollers (Z,)."""
    known = np.isfinite(films.central_film) & (load > 0.0)
    numbers = (load, films.central_film, films.minimum_film)
    whole = line_integral(contact, *(values[known] for values in numbers))
    pressure = np.asarray(max_pressure(load[known], contact.radius, contact.reduced_modulus))
    zone = under_pressure(state.permittivity, state.lubricant, state.temperature, pressure, "line")
    # the error of the rule is that of slices with next to no load: others have 0.5 %
    found = electrics_of(
        whole._replace(error=LINE_ERROR), state.oil, state.lubricant, state.temperature, zone, 0.0, numbers[2][known]
    )
    between = gap[~known]
    slices = _side(known, found, between, VACUUM * state.permittivity * open_line(contact.radius, between))
    total, low, high = (length * values.sum(axis=1) for values in (slices.capacitance, slices.low, slices.high))
    films_of = np.where(known | ~known.any(axis=1)[:, None], slices.film, np.inf).min(axis=1)
    return Side(total, low, high, films_of, known.any(axis=1))


def _rollers(point: BearingPoint, side: int, state: _State) -> Side:
    """Contacts of all cylindrical rollers with a raceway."""
    bearing, films = point.bearing, point.contacts.sides[side]
    contact = bearing.geometry.contacts(bearing.material, "iso16281")[side]
    gap = _gaps(0.5 * point.elements.approach, films.central_film)
    return _lines(contact, point.elements.load_per_length, films, gap, bearing.slice_length, state)


def _between_ribs(point: TaperedPoint, side: int, state: _State) -> Side:
    """Contacts of all rollers between ribs with a raceway: films of the middle of a roller, open slices touch."""
    force, rollers = point.force, point.elements
    contacts = force.geometry.contacts(force.material)
    load = rollers.slices[side]
    films = FormulaFilms(contacts, state.lubricant).state(side, load, point.entrainment_speed, state.temperature)
    gap = _gaps(np.zeros(load.shape), films.central_film)
    return _lines(contacts[side], load, films, gap, force.geometry.roller_length / load.shape[1], state)


_SIDES: dict[type, Callable[[Any, int, _State], Side]] = {
    BearingGeometry: _rollers,
    BallGeometry: _balls,
    TaperedGeometry: _between_ribs,
    RibbedGeometry: _between_ribs,
}
"""Contacts with a raceway by the geometry of a bearing."""


def _gaps(approach: FloatArray, films: FloatArray) -> FloatArray:
    """Gaps of contacts by their approaches, opened by the thickest film of the side [m]."""
    known = films[np.isfinite(films)]
    return np.asarray(np.maximum(-approach, 0.0) + max(float(known.max(initial=0.0)), LEAST_GAP))


def _side(known: BoolArray, found: ContactElectrics, gap: FloatArray, opened: FloatArray) -> Side:
    """Contacts that carry on films that are known, and open ones by their gaps and capacitances."""

    def whole(loaded: FloatArray, empty: FloatArray) -> FloatArray:
        values = np.empty(known.shape)
        values[known], values[~known] = loaded, empty
        return values

    low, high, film = whole(found.low, opened), whole(found.high, opened), whole(found.minimum_film, gap)
    return Side(whole(found.capacitance, opened), low, high, film, known)
