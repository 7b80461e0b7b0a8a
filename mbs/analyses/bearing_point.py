"""One bearing at an operating point: where its inner ring comes to rest, and what its contacts feel there.

The outer ring is held, the inner one moves in the radial plane without tilting and turns at the given speed. Its
equilibrium is that of `mbs.model.equilibrium`, with the ring as the only body: the potential of the contacts is convex,
so that it is found from any load and clearance. The rollers' centrifugal load is left out.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import AnalysisError, InputError
from ehdmaps.maps.rough_films import LEAST_SPEED, load_sharing, overlapping
from ehdmaps.maps.rough_layer import RoughLayer
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.roughness import Surface
from ehdmaps.physics.solids import reduced_modulus
from mbs.bearings.bearing import Bearing
from mbs.bearings.bearing_element import BearingElement
from mbs.bearings.bearing_force import BearingForce
from mbs.bearings.contact_report import (
    BearingContacts,
    bearing_contacts,
    extrapolated,
    fading,
    guessed,
    heated,
    outside_map,
    overload,
    spike_tip,
)
from mbs.bearings.films import FilmSource
from mbs.bearings.laws import Law
from mbs.bearings.roller_loads import RollerLoads
from mbs.bearings.rolling_loss import RollingLoss, rolling_loss
from mbs.model.body import Inertia, rigid_body
from mbs.model.elements import Load, Operation
from mbs.model.equilibrium import Equilibrium, equilibrium
from mbs.model.system import System

SHARE = 0.01
"""A roller counts as loaded if it carries more than this part of the highest roller load: films load all a little."""

RING = "inner ring"
"""Name of the body that a bearing alone carries."""

_FREE = 1e-9
"""Stiffness across the load over that along it, below which there is none."""


@dataclass(frozen=True, eq=False)
class BearingPoint:
    """A bearing in equilibrium.

    Attributes
    ----------
    bearing : Bearing
        Geometry, clearance, profile, slices.
    load : array, shape (2,)
        Load on the inner ring, y and z [N].
    speed : float
        Speed of the inner ring [rad/s].
    entrainment_speed, temperature : float
        u [m/s], T [K].
    displacement : array, shape (2,)
        Displacement of the inner ring against the outer one, y and z [m].
    stiffness, damping : array, shape (2, 2)
        Stiffness and damping of the bearing in y and z [N/m], [N s/m].
    rollers : RollerLoads
        Loads of rollers and slices.
    contacts : BearingContacts
        Pressures and films of all slices.
    loss : RollingLoss
        What rolling costs.
    problems : tuple of str
        Limits of the laws that the point exceeds, in words.
    notes : tuple of str
        What else should be known about it.
    """

    bearing: Bearing
    load: FloatArray
    speed: float
    entrainment_speed: float
    temperature: float
    displacement: FloatArray
    stiffness: FloatArray
    damping: FloatArray
    rollers: RollerLoads
    contacts: BearingContacts
    loss: RollingLoss
    problems: tuple[str, ...]
    notes: tuple[str, ...]

    @property
    def size(self) -> float:
        """Size of the load [N]."""
        return float(np.hypot(*self.load))

    @property
    def axes(self) -> FloatArray:
        """Unit vectors along and across the load, in rows (2, 2)."""
        along = self.load / self.size
        return np.array([along, [-along[1], along[0]]])

    def along_across(self, matrix: FloatArray) -> FloatArray:
        """Diagonal of a matrix (2, 2) in the directions along and across the load, shape (2,)."""
        return np.asarray(np.diag(self.axes @ matrix @ self.axes.T))

    @property
    def loaded(self) -> int:
        """Number of rollers that carry more than `SHARE` of the highest roller load."""
        return int(self.rollers.load_zone(SHARE).size)

    @property
    def most_loaded(self) -> int:
        """Index of the roller with the highest load."""
        return int(np.argmax(self.rollers.load))

    def film_parameter(self, roughness: float) -> float:
        """Lambda: smallest film of all contacts over the combined rms roughness [m]; NaN where no film is known."""
        return float(np.min(self.contacts.minimum_film)) / roughness

    def film_share(self, surface: Surface, lubricant: Lubricant) -> float:
        """Share of the film in the load of the most loaded roller, of the contact where it is less; NaN without films.

        By its central films; 1 between smooth surfaces.

        Parameters
        ----------
        surface : Surface
            Surfaces of the contacts.
        lubricant : Lubricant
            The oil.
        """
        return self.load_sharing(surface, lubricant)[0]

    def load_sharing(self, surface: Surface, lubricant: Lubricant) -> tuple[float, bool]:
        """`film_share`, and whether the mean planes overlap in a slice, see `ehdmaps.maps.rough_films`.

        Parameters
        ----------
        surface, lubricant
            Arguments of `film_share`.
        """
        if surface.smooth:
            return 1.0, False
        loads = self.rollers.load_per_length[self.most_loaded]
        loaded = loads > 0.0
        contacts = self.bearing.geometry.contacts(self.bearing.material, "iso16281")
        place = loads[loaded], np.array([self.entrainment_speed]), np.array([self.temperature])
        shares, overlap = [], False
        for contact, side in zip(contacts, self.contacts.sides, strict=True):
            film = side.central_film[self.most_loaded][loaded][:, None, None]
            layer = RoughLayer(surface, contact, lubricant, max(self.entrainment_speed, LEAST_SPEED))
            part, distance = (values[:, 0, 0] for values in load_sharing(layer, film, *place))
            overlap = overlap or bool(np.any(overlapping(part, distance)))
            shares.append(float(np.sum(part * loads[loaded]) / np.sum(loads)) if loaded.any() else math.nan)
        return min(shares), overlap


def bearing_points(
    bearing: Bearing,
    law: Law,
    films: FilmSource,
    loads: Iterable[Sequence[float]],
    speeds: Sequence[float],
    temperature: float,
) -> list[list[BearingPoint]]:
    """Points of a bearing at every load and every speed.

    Parameters
    ----------
    bearing : Bearing
        Geometry, clearance, profile, slices.
    law : Law
        Law of a roller between both raceways, see `mbs.bearings.laws`.
    films : FilmSource
        Pressures and films, see `mbs.bearings.films`.
    loads : iterable of (float, float)
        Loads on the inner ring, y and z [N].
    speeds : sequence of float
        Speeds of the inner ring [rad/s].
    temperature : float
        Temperature of the raceways [K].

    Returns
    -------
    list of list of BearingPoint
        The points, by load, then by speed.

    Raises
    ------
    InputError
        For a load of zero, and for a law that does not belong to the bearing.
    AnalysisError
        Where no equilibrium is found.
    """
    force = BearingForce(bearing, law)
    return [[bearing_point(force, films, load, speed, temperature) for speed in speeds] for load in loads]


def ring_at_rest(element: BearingElement, load: Sequence[float], operation: Operation) -> Equilibrium:
    """Where the inner ring of a bearing comes to rest in the radial plane, without tilting.

    Parameters
    ----------
    element : BearingElement
        The bearing, between the body `RING` and ground.
    load : (float, float)
        Load on the inner ring, y and z [N].
    operation : Operation
        Speed of the inner ring.

    Raises
    ------
    InputError
        For a load of zero.
    AnalysisError
        Where no equilibrium is found.
    """
    given = np.array(load, dtype=np.float64)
    if given.shape != (2,) or not np.all(np.isfinite(given)) or not np.any(given):
        raise InputError(f"bearing point, load: got {load!r} N; allowed: two finite numbers, y and z, not both zero")
    ring = rigid_body(RING, [Inertia(1.0, 1.0, 1.0)], ["y", "z"])
    system = System([ring], loads=[Load("load", RING, np.array([0.0, *given, 0.0, 0.0, 0.0]))], elements=[element])
    try:
        return equilibrium(system, operation)
    except AnalysisError as error:
        if not isinstance(error.__cause__, InputError):
            raise
        raise AnalysisError(  # the ring went further than small displacements allow
            f"no equilibrium of {element.bearing.geometry.name} under {np.hypot(*given):.4g} N: {error.__cause__}; the "
            "load is beyond what the bearing can carry"
        ) from error


def bearing_point(
    force: BearingForce, films: FilmSource, load: Sequence[float], speed: float, temperature: float
) -> BearingPoint:
    """One point; arguments and errors as of `bearing_points`."""
    element = BearingElement("bearing", RING, "ground", force.bearing, force, temperature)
    operation = Operation(speed)
    balance = ring_at_rest(element, load, operation)
    given = np.array(load, dtype=np.float64)
    pose = np.array([0.0, *balance.displacement, 0.0, 0.0, 0.0])
    rollers, u = element.rollers(pose, operation), element.entrainment_speed(operation)
    contacts = bearing_contacts(films, rollers, u, temperature)
    stiffness = balance.element_stiffness[0][1:3, 1:3]
    problems = [overload(contacts), *outside_map(force.law, float(rollers.load_per_length.max()), u, temperature)]
    modulus = reduced_modulus(force.bearing.material, force.bearing.material)
    notes = [
        spike_tip(contacts),
        extrapolated(contacts, films.lubricant),
        fading(force.law, u),
        guessed(force.law, rollers.load_per_length, u, temperature),
        heated(contacts, films.lubricant, modulus, u, temperature),
        _loose(stiffness, given),
    ]
    return BearingPoint(
        bearing=force.bearing,
        load=given,
        speed=speed,
        entrainment_speed=u,
        temperature=temperature,
        displacement=balance.displacement,
        stiffness=stiffness,
        damping=balance.element_damping[0][1:3, 1:3],
        rollers=rollers,
        contacts=contacts,
        loss=rolling_loss(contacts, rollers.load, force.bearing.slice_length, u, speed),
        problems=tuple(filter(None, problems)),
        notes=tuple(filter(None, notes)),
    )


def _loose(stiffness: FloatArray, load: FloatArray) -> str:
    """A sentence where nothing holds the ring across the load."""
    across = np.array([-load[1], load[0]]) / np.hypot(*load)
    if across @ stiffness @ across > _FREE * float(np.trace(stiffness)):
        return ""
    return "one roller carries all: nothing holds the ring across the load, where its position is arbitrary"
