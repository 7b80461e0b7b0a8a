"""A bearing in equilibrium under a load: what its rollers carry and their contacts feel, and what speaks against it."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.roughness import Surface
from mbs.bearings.bearing import Bearing
from mbs.bearings.contact_report import BearingContacts
from mbs.bearings.roller_loads import RollerLoads
from mbs.bearings.rolling_loss import RollingLoss

SHARE = 0.01
"""A roller counts as loaded if it carries more than this part of the highest roller load: films load all a little."""


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
        from ehdmaps.maps.rough_films import LEAST_SPEED, load_sharing, overlapping
        from ehdmaps.maps.rough_layer import RoughLayer

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
