"""One bearing of rollers and ribs at an operating point: where its inner ring comes to rest, what its rollers feel.

The outer ring is held, the inner one moves along x, y and z, and tilts if it may. Films of the lines are those of the
law, at the radius and speed of the middle of a roller; beside dry lines they are those of formulas at the load, radius
and speed of each slice, and move nothing. That of a rib is the formula of Hamrock and Dowson, whose ellipses are not
longer along the motion, as ribs' may be: an order of magnitude.
"""

from __future__ import annotations

import dataclasses
import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.physics.oil_supply import FLOODED
from ehdmaps.physics.point.film_formulas import film_of, hamrock_dowson_central
from ehdmaps.units import written
from mbs.bearings.films import FilmSource, FormulaFilms, error_of_smallest
from mbs.bearings.locating.locating_force import Settled
from mbs.bearings.locating.locating_point import Course, LocatingPoint
from mbs.bearings.tapered.roller_findings import line_pressures
from mbs.bearings.tapered.tapered_bearing import TaperedForce, TaperedLoads
from mbs.model.findings import CARRIES

RIB_FRICTION = 0.05
"""Coefficient of friction at ribs, assumed: mixed friction with an oil film."""


@dataclass(frozen=True, eq=False, kw_only=True)
class TaperedPoint(LocatingPoint):
    """A tapered roller bearing, or one with rollers between ribs, in equilibrium, see `LocatingPoint`.

    Attributes
    ----------
    rib_pressure, rib_film : array (m, Z)
        Hertz pressure [Pa] and central film [m] at the ribs.
    sliding_speed : float
        Largest sliding speed at a rib that carries load, or at any where none does [m/s].
    rib_power : float
        Power that all ribs take with the friction `RIB_FRICTION` [W].
    """

    force: TaperedForce
    elements: TaperedLoads
    rib_pressure: FloatArray
    rib_film: FloatArray
    sliding_speed: float
    rib_power: float

    @staticmethod
    def start(force: TaperedForce, load: FloatArray) -> FloatArray:
        """See `LocatingPoint.start`."""
        way = math.copysign(1.0, force.geometry.contact_angle or load[0])
        axial = way * (1e-5 + sum(rib.play for rib in force.ribs if way * rib.normal[0] > 0.0))
        return np.array([axial, *(2e-6 * load[1:] / max(np.abs(load).max(), 1e-300))])

    @staticmethod
    def advice(force: TaperedForce, load: FloatArray, speeds: tuple[float, float]) -> str:
        """Advice on the axial load, see `LocatingPoint.advice`."""
        geometry = force.geometry
        thrown = geometry.rolling_elements * force.speed_loads(*speeds)[0]
        least = math.tan(geometry.cup_angle) * (math.hypot(*load[1:]) + thrown)
        if not (geometry.contact_angle and math.copysign(load[0], load[0] * geometry.contact_angle) < least):
            return ""
        sign = "positive" if geometry.contact_angle > 0.0 else "negative"
        return (
            f"; a tapered roller bearing falls apart without a {sign} axial load above tan(alpha) (Fr + Z Fc) = "
            f"{written(least)} N, Fc the centrifugal load of a roller"
        )

    @staticmethod
    def own(at: Settled, course: Course) -> dict[str, Any]:
        """See `LocatingPoint.own`."""
        force, rollers = at.force, at.loads
        central, minimum, error = _lines(force, rollers, course)
        rib_pressure, rib_film, slides = _ribs(force, rollers, course)
        carries = rollers.ribs.max(axis=1, initial=0.0) > 0.0
        return {
            "pressure": line_pressures(force, rollers),
            "central_film": central,
            "minimum_film": minimum,
            "film_error": error,
            "rib_pressure": rib_pressure,
            "rib_film": rib_film,
            "sliding_speed": float(np.max(slides[carries] if np.any(carries) else slides, initial=0.0)),
            "rib_power": RIB_FRICTION * float(slides @ rollers.ribs.sum(axis=1)),
        }


def _ribs(force: TaperedForce, rollers: TaperedLoads, course: Course) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Hertz pressures and central films of all ribs, (m, Z) each, and their sliding speeds, (m,)."""
    pressure, film = np.zeros(rollers.ribs.shape), np.full(rollers.ribs.shape, np.nan)
    slides = np.zeros(len(force.ribs))
    for index, rib in enumerate(force.ribs):
        contact, loads = rib.contact, rollers.ribs[index]
        pressure[index] = np.asarray(contact.max_pressure(loads))
        ring, end = force.geometry.rib_speeds(*course.speeds, outer=rib.outer, radius=rib.radius)
        slides[index] = abs(ring - end)
        mean, carries = 0.5 * abs(ring + end), loads > 0.0
        if course.oil is not None and mean > 0.0:
            state = course.oil.at(course.temperature)
            film[index, carries] = film_of(hamrock_dowson_central, contact, state, loads[carries], mean)
    return pressure, film, slides


def _lines(force: TaperedForce, rollers: TaperedLoads, course: Course) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Smallest central and smallest films of slices with their own radius and speed, (2, Z); see `film_error`."""
    geometry, oil, speed = force.geometry, course.oil, force.geometry.entrainment_speed(*course.speeds)
    contacts = geometry.contacts(force.material)
    (central, minimum), error = np.full((2, 2, rollers.angle.size), np.nan), np.full(2, np.nan)
    if oil is None or not speed > 0.0:
        return central, minimum, error
    lines: FilmSource | None = getattr(course.films, "lines", None)
    supply = force.films.points[0].law.supply if force.films.points else FLOODED
    for side in range(2):
        if lines is not None:
            state = lines.state(side, rollers.slices[side], speed, course.temperature)
            carries = rollers.slices[side] > CARRIES * rollers.slices[side].max()  # films load all others a little
            thick, thin = (np.where(carries, film, np.nan) for film in (state.central_film, state.minimum_film))
            central[side], minimum[side] = (np.fmin.reduce(film, axis=1) for film in (thick, thin))
            error[side] = error_of_smallest(thin, state.film_error)
            continue
        for index, place in enumerate(force.positions.tolist()):
            radius = geometry.radius_at(place, side)
            local = tuple(dataclasses.replace(each, radius=radius) for each in contacts)
            share = 1.0 - place / geometry.apex_distance
            loads = rollers.slices[side, :, index]
            state = FormulaFilms(local, oil, supply).state(side, loads, speed * share, course.temperature)
            central[side] = np.fmin(central[side], state.central_film)
            minimum[side] = np.fmin(minimum[side], state.minimum_film)
    return central, minimum, error
