"""One bearing of rollers and ribs at an operating point: where its inner ring comes to rest, what its rollers feel.

The outer ring is held, the inner one moves along x, y and z, and tilts if it may. Contacts are dry. Films of the lines
are those of formulas at the load, radius and speed of each slice; that of a rib is the formula of Hamrock and Dowson,
whose ellipses are not longer along the motion, as ribs' may be: an order of magnitude. Films move nothing.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.point.film_formulas import hamrock_dowson_central
from ehdmaps.physics.rollers.tapered_catalogue import tapered_ratings
from ehdmaps.physics.rollers.tapered_geometry import TaperedGeometry
from ehdmaps.units import written
from mbs.bearings.films import FormulaFilms
from mbs.bearings.locating.locating_point import RING, LocatingPoint, ring_at_rest, ring_load
from mbs.bearings.tapered.roller_findings import line_pressures, roller_gauge
from mbs.bearings.tapered.tapered_bearing import TaperedForce, TaperedLoads
from mbs.bearings.tapered.tapered_element import TaperedElement
from mbs.life import ReferenceLife

RIB_FRICTION = 0.05
"""Coefficient of friction at ribs, assumed: mixed friction with an oil film."""


@dataclass(frozen=True, eq=False, kw_only=True)
class TaperedPoint(LocatingPoint):
    """A tapered roller bearing, or one with rollers between ribs, in equilibrium, see `LocatingPoint`.

    Attributes
    ----------
    cage_speed : float
        [rad/s].
    entrainment_speed : float
        Speed of both surfaces against the cage in the middle of a roller [m/s].
    rollers : TaperedLoads
        Loads of rollers and slices.
    rib_pressure, rib_film : array (m, Z)
        Hertz pressure [Pa] and central film [m] at the ribs.
    sliding_speed : float
        Largest sliding speed at a rib that carries load, or at any where none does [m/s].
    rib_power : float
        Power that all ribs take with the friction `RIB_FRICTION` [W].
    centrifugal_load : float
        Centrifugal load of a roller [N].
    reference : ReferenceLife
        Equivalent load and life of ISO/TS 16281.
    """

    force: TaperedForce
    cage_speed: float
    entrainment_speed: float
    rollers: TaperedLoads
    rib_pressure: FloatArray
    rib_film: FloatArray
    sliding_speed: float
    rib_power: float
    centrifugal_load: float
    reference: ReferenceLife

    @property
    def geometry(self) -> TaperedGeometry:
        """Geometry of the bearing."""
        return self.force.geometry

    @property
    def ratings(self) -> tuple[float, float]:
        """C of ISO 281 and C0 of ISO 76 by the inner geometry [N]."""
        return tapered_ratings(self.geometry)

    @property
    def loaded(self) -> int:
        """Number of rollers that carry more than 1 % of the highest load of the cone."""
        return self.rollers.loaded


def tapered_point(
    force: TaperedForce,
    load: Sequence[float],
    inner_speed: float,
    outer_speed: float = 0.0,
    *,
    tilts: bool = False,
    oil: Lubricant | None = None,
    temperature: float = 313.15,
) -> TaperedPoint:
    """Equilibrium of a tapered roller bearing, or of one with cylindrical rollers between ribs.

    Parameters
    ----------
    force : TaperedForce
        Geometry and laws.
    load : (float, float, float)
        Load on the inner ring, x, y and z [N]; x with the sign of the contact angle, or as ribs carry it.
    inner_speed, outer_speed : float
        Speeds of the rings [rad/s].
    tilts : bool
        Whether the inner ring tilts freely, without a moment; else it is held.
    oil : Lubricant, optional
        Oil of the films; no films without one.
    temperature : float
        Temperature of the raceways, and so of the oil [K].

    Raises
    ------
    InputError
        For loads that are no finite numbers, or all zero.
    AnalysisError
        Where no equilibrium is found.
    """
    given, geometry = ring_load(load), force.geometry
    way = math.copysign(1.0, geometry.contact_angle if geometry.contact_angle else given[0])
    start = np.array(
        [
            way * (1e-5 + sum(rib.play for rib in force.ribs if way * rib.normal[0] > 0.0)),
            *(2e-6 * given[1:] / max(np.abs(given).max(), 1e-300)),
        ]
    )
    thrown = geometry.rollers * force.speed_loads(inner_speed, outer_speed)[0]
    least, advice = math.tan(geometry.cup_angle) * (math.hypot(*given[1:]) + thrown), ""
    if geometry.contact_angle and math.copysign(given[0], given[0] * geometry.contact_angle) < least:
        sign = "positive" if geometry.contact_angle > 0.0 else "negative"
        advice = (
            f"; a tapered roller bearing falls apart without a {sign} axial load above tan(alpha) (Fr + Z Fc) = "
            f"{written(least)} N, Fc the centrifugal load of a roller"
        )
    element = TaperedElement("bearing", RING, "ground", force, inner_speed, outer_speed)
    _, pose, rollers, balance = ring_at_rest(element, given, advice, tilts=tilts, start=start)
    speed = geometry.entrainment_speed(inner_speed, outer_speed)
    central, minimum = _lines(force, rollers, speed, oil, temperature)
    rib_pressure, rib_film, slides = _ribs(force, rollers, (inner_speed, outer_speed), oil, temperature)
    carries = rollers.ribs.max(axis=1, initial=0.0) > 0.0
    reference = rollers.life(geometry, abs(inner_speed) >= abs(outer_speed))
    centrifugal, _ = force.speed_loads(inner_speed, outer_speed)
    return TaperedPoint(
        force=force,
        load=given,
        inner_speed=inner_speed,
        outer_speed=outer_speed,
        cage_speed=geometry.cage_speed(inner_speed, outer_speed),
        entrainment_speed=speed,
        pose=pose,
        stiffness=balance.element_stiffness[0],
        damping=balance.element_damping[0],
        rollers=rollers,
        pressure=line_pressures(force, rollers),
        central_film=central,
        minimum_film=minimum,
        rib_pressure=rib_pressure,
        rib_film=rib_film,
        sliding_speed=float(np.max(slides[carries] if np.any(carries) else slides, initial=0.0)),
        rib_power=RIB_FRICTION * float(slides @ rollers.ribs.sum(axis=1)),
        centrifugal_load=centrifugal,
        reference=reference,
        findings=(*roller_gauge(force, rollers).findings, *filter(None, [force.reach_of(rollers.load[:2])])),
    )


def _ribs(
    force: TaperedForce,
    rollers: TaperedLoads,
    speeds: tuple[float, float],
    oil: Lubricant | None,
    temperature: float,
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Hertz pressures and central films of all ribs, (m, Z) each, and their sliding speeds, (m,)."""
    pressure, film = np.zeros(rollers.ribs.shape), np.full(rollers.ribs.shape, np.nan)
    slides = np.zeros(len(force.ribs))
    for index, rib in enumerate(force.ribs):
        contact, loads = rib.contact, rollers.ribs[index]
        pressure[index] = np.asarray(contact.max_pressure(loads))
        ring, end = force.geometry.rib_speeds(*speeds, outer=rib.outer, radius=rib.radius)
        slides[index] = abs(ring - end)
        mean, carries = 0.5 * abs(ring + end), loads > 0.0
        if oil is not None and mean > 0.0:
            state = oil.at(temperature)
            film[index, carries] = contact.rolling_radius * hamrock_dowson_central(
                state.viscosity * mean / (contact.reduced_modulus * contact.rolling_radius),
                loads[carries] / (contact.reduced_modulus * contact.rolling_radius**2),
                state.pressure_viscosity.pressure_viscosity * contact.reduced_modulus,
                contact.ellipticity,
            )
    return pressure, film, slides


def _lines(
    force: TaperedForce, rollers: TaperedLoads, speed: float, oil: Lubricant | None, temperature: float
) -> tuple[FloatArray, FloatArray]:
    """Smallest central and smallest films of the slices, each with its own radius and speed, (2, Z) each."""
    geometry = force.geometry
    contacts = geometry.contacts(force.material)
    central, minimum = np.full((2, 2, rollers.angle.size), np.nan)
    if oil is None or not speed > 0.0:
        return central, minimum
    for side in range(2):
        for index, place in enumerate(force.positions.tolist()):
            radius = geometry.radius_at(place, side)
            local = tuple(dataclasses.replace(each, radius=radius) for each in contacts)
            share = 1.0 - place / geometry.apex_distance
            loads = rollers.slices[side, :, index]
            state = FormulaFilms(local, oil).state(side, loads, speed * share, temperature)
            central[side] = np.fmin(central[side], state.central_film)
            minimum[side] = np.fmin(minimum[side], state.minimum_film)
    return central, minimum
