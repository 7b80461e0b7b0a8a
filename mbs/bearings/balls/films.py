"""Films of a ball bearing's contacts at one speed and temperature, solved at some loads and read along them.

Each contact is solved by `ehdmaps.point.solver` at loads that are evenly spaced in the logarithm. Between them film
offset, damping and films are cubics in the logarithms of value and load; beyond the loads that have a solution they go
on straight. Stiffness comes from the slope of the film offset, which is smoother than the tangents of single solutions.
A load that has no solution is left out where its neighbours have one on both sides, and the loads end there else.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.interpolate import CubicSpline

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import SolverError
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.point.ball_geometry import BallGeometry
from ehdmaps.physics.point.ellipse import Ellipse
from ehdmaps.physics.solids import STEEL, Material
from ehdmaps.point.solver import PointSolution, solve
from mbs.bearings.balls.laws import BallLaw, film_normal_law

LOADS_PER_DECADE = 3
FEWEST = 4
"""Solutions that a curve needs."""

LIGHTEST, HIGHEST_PRESSURE = 2.0, 4.2e9
"""Lightest load [N], and Hertz pressure of the heaviest one [Pa]: the static limit of ISO 76."""

_BEYOND = 30.0
"""Factor by which the law's table goes on above the heaviest load; below the lightest the kernel goes on straight."""


@dataclass(frozen=True, eq=False)
class ContactFilms:
    """Films of one contact over load.

    Attributes
    ----------
    loads : array (n,)
        Loads that have a solution [N].
    values : array (n, 4)
        Film offset, central film, minimum film [m], damping [N s/m].
    errors : array (n, 4)
        Stated relative errors of the same.
    left_out : tuple of str
        Loads that have no solution, and why.
    """

    loads: FloatArray
    values: FloatArray
    errors: FloatArray
    left_out: tuple[str, ...]

    def read(self, load: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Values at loads (k,) and their slopes by ln load, each (4, k).

        Parameters
        ----------
        load : array (k,)
            Loads [N], > 0.
        """
        places, logs = np.log(self.loads), np.log(self.values)
        spline = CubicSpline(places, logs, axis=0)
        asked = np.log(load)
        inside = np.clip(asked, places[0], places[-1])
        slopes = spline(inside, 1)
        values = np.exp(spline(inside) + slopes * (asked - inside)[:, None])
        return values.T, (values * slopes).T

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
        return (
            f"solved at {self.inner.loads.size} and {self.outer.loads.size} loads, {low:.3g} to {high:.4g} N; errors "
            f"up to {offset:.1%} of the film offset, {central:.1%} of the central and {minimum:.1%} of the smallest "
            f"film, {damping:.1%} of the damping"
        )


def solved_films(
    geometry: BallGeometry, oil: Lubricant, entrainment_speed: float, temperature: float, material: Material = STEEL
) -> BallFilms:
    """Solve both contacts over load.

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

    Raises
    ------
    SolverError
        If too few loads of a contact have a solution.
    InputError
        If the oil has no such temperature.
    """
    contacts = geometry.contacts(material)
    films = [
        _contact_films(side, contact, oil, entrainment_speed, temperature)
        for side, contact in zip(("inner", "outer"), contacts, strict=True)
    ]
    low, high = max(float(side.loads[0]) for side in films), min(float(side.loads[-1]) for side in films)
    inner, outer = (
        film_normal_law(contact, side.curve, (low, _BEYOND * high))
        for contact, side in zip(contacts, films, strict=True)
    )
    return BallFilms(films[0], films[1], BallLaw(f"films of {oil.title}", inner, outer, (low, high)))


def _contact_films(side: str, contact: Ellipse, oil: Lubricant, speed: float, temperature: float) -> ContactFilms:
    """Solutions of a contact over load."""
    heaviest = float((HIGHEST_PRESSURE / contact.max_pressure(1.0)) ** 3)
    count = max(FEWEST, math.ceil(LOADS_PER_DECADE * math.log10(heaviest / LIGHTEST)) + 1)
    loads = np.geomspace(LIGHTEST, heaviest, count)
    found = [solve(contact, oil, float(load), speed, temperature) for load in loads]
    kept = _together(found)
    left_out = tuple(f"{one.load:.4g} N: {one.reason}" for one in found if one not in kept)
    if len(kept) < FEWEST:
        raise SolverError(
            f"films of the {side} contact: {len(kept)} of {count} loads from {LIGHTEST:g} to {heaviest:.4g} N have a "
            f"solution at {speed:.4g} m/s; at least {FEWEST} are needed ({'; '.join(left_out[:2])})"
        )
    values = [[one.film_offset, one.central_film, one.minimum_film, one.damping] for one in kept]
    errors = [
        [one.film_offset_error, one.central_film_error, one.minimum_film_error, one.damping_error] for one in kept
    ]
    return ContactFilms(np.array([one.load for one in kept]), np.array(values), np.array(errors), left_out)


def _together(found: Sequence[PointSolution]) -> list[PointSolution]:
    """The longest row of usable solutions in which no two neighbours are missing."""
    rows: list[list[PointSolution]] = [[]]
    missing = 0
    for one in found:
        if one.status.usable and one.damping > 0.0 and one.film_offset > 0.0:
            rows[-1].append(one)
            missing = 0
        else:
            missing += 1
            if missing == 2:
                rows.append([])
    return max(rows, key=len)
