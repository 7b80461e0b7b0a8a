"""A bearing as the force element sees it: geometry, clearance, roller profile, slices."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import InputError
from ehdmaps.physics.bearing import BearingGeometry
from ehdmaps.physics.profiles import iso_profile
from ehdmaps.physics.solids import STEEL, Material

Profile = str | Callable[[FloatArray], npt.ArrayLike] | tuple[float, ...] | FloatArray

MOST_SLICES = 100_000

MOST_COUPLED = 100
"""Slices that know of their neighbours: more would be narrower than the contacts are wide."""

STATIC_LIMIT = 4e9
"""Hertz pressure of the static load rating of roller bearings after ISO 76 [Pa]; permanent deformation above it."""

_PROFILES = ("iso", "straight")


@dataclass(frozen=True, eq=False)
class Bearing:
    """A cylindrical roller bearing, cut into slices.

    Attributes
    ----------
    geometry : BearingGeometry
        Raceways, rollers, and the diametral clearance P_d that is in force.
    profile : {"iso", "straight"}, callable, or array (slices,)
        Roller profile P [m] on one side: by name, as P(x) of the distance x [m] from the middle, or its values at the
        middles of the slices. A callable is called once.
    slices : int
        Number of slices of equal length of a roller. Statics want 30 or more.
    material : Material
        Material of the bearing; its density gives the rollers their centrifugal load.
    coupled : bool
        Whether the slices of a roller know of their neighbours, see `mbs.bearings.coupled_kernel`; else each bears
        its load alone.

    Raises
    ------
    InputError
        With every problem.

    Examples
    --------
    >>> bearing = Bearing.named("NU308", clearance=20e-6)
    >>> bearing.geometry.diametral_clearance, bearing.slices
    (2e-05, 41)
    """

    geometry: BearingGeometry
    profile: Profile = "iso"
    slices: int = 41
    material: Material = STEEL
    coupled: bool = False

    def __post_init__(self) -> None:
        count = self.slices
        if not isinstance(count, int) or isinstance(count, bool) or not 1 <= count <= MOST_SLICES:
            raise InputError(f"bearing, slices: got {count!r}; allowed: a whole number from 1 to {MOST_SLICES}")
        if self.coupled and count > MOST_COUPLED:
            raise InputError(f"bearing, slices: got {count} that are coupled; allowed: at most {MOST_COUPLED}")
        _ = self.profile_depths

    @classmethod
    def named(cls, name: str, *, clearance: float = 0.0, profile: Profile = "iso", slices: int = 41) -> Bearing:
        """One of the bearings of `ehdmaps.physics.bearing.BEARINGS`, of steel.

        Parameters
        ----------
        name : str
            Such as "NU308".
        clearance : float
            Diametral clearance P_d [m], < 0 for a preloaded bearing.
        profile, slices
            The same as for the class.
        """
        if isinstance(clearance, bool) or not isinstance(clearance, int | float | np.floating | np.integer):
            raise InputError(f"bearing, clearance: got {clearance!r}; allowed: a number of metres")
        geometry = dataclasses.replace(BearingGeometry.named(name), diametral_clearance=float(clearance))
        return cls(geometry, profile, slices)

    def with_slices(self, slices: int) -> Bearing:
        """The same bearing cut into another number of slices."""
        return dataclasses.replace(self, slices=slices)

    @cached_property
    def slice_positions(self) -> FloatArray:
        """Middles of the slices along the roller, (slices,) [m], from the middle of the bearing."""
        places = (np.arange(self.slices) + 0.5) / self.slices - 0.5
        return np.asarray(places * self.geometry.roller_length)

    @property
    def slice_length(self) -> float:
        """Length of a slice [m]."""
        return self.geometry.roller_length / self.slices

    @cached_property
    def profile_depths(self) -> FloatArray:
        """Profile P at the middles of the slices, on one side, (slices,) [m]."""
        x, geometry = self.slice_positions, self.geometry
        if isinstance(self.profile, str):
            if self.profile not in _PROFILES:
                raise InputError(
                    f"bearing, profile: got {self.profile!r}; allowed: {', '.join(_PROFILES)}, a function P(x), "
                    "or its values at the slices"
                )
            if self.profile == "straight":
                return np.zeros(self.slices)
            return iso_profile(x, geometry.roller_diameter, geometry.roller_length)
        given = self.profile(x.copy()) if callable(self.profile) else self.profile
        try:
            depths = np.array(given, dtype=np.float64)
        except (TypeError, ValueError):
            raise InputError(f"bearing, profile: got {given!r}; allowed: real numbers [m], one a slice") from None
        if depths.shape != (self.slices,):
            raise InputError(
                f"bearing, profile: got values of shape {depths.shape}; allowed: ({self.slices},), one a slice; "
                "a function P(x) suits any number of slices"
            )
        if not np.all(np.abs(depths) < geometry.roller_diameter):
            wrong = depths[~(np.abs(depths) < geometry.roller_diameter)][0]
            raise InputError(
                f"bearing, profile: got {wrong:.6g} m; allowed: finite and smaller than the roller diameter "
                f"{geometry.roller_diameter:.6g} m; check its unit"
            )
        return depths

    @cached_property
    def coupling(self) -> FloatArray:
        """Compliances between the slices of a roller, beyond a plane law of its contacts, (slices, slices) [m2/N].

        Both contacts together, see `ehdmaps.solids.slices`: for contacts up to the static limit of bearings, with free
        end faces of the roller, raceways that go on beyond them, and bodies of the rings as deep as the roller is
        thick.
        """
        # scipy is loaded for those who want it only: scenes are read without
        from ehdmaps.solids.slices import slice_coupling
        from ehdmaps.solids.three_d import FiniteLine

        geometry = self.geometry
        diameter = geometry.roller_diameter
        total = np.zeros((self.slices, self.slices))
        for radius in (geometry.inner_radius, geometry.outer_radius):
            line = FiniteLine(radius, geometry.roller_length, 0.5 * diameter, diameter, self.material)
            total += slice_coupling(line, self.slices, line.half_width_of(STATIC_LIMIT))
        return total

    @property
    def roller_mass(self) -> float:
        """Mass of a roller, as a plain cylinder [kg]."""
        return self._mass_per_length * self.geometry.roller_length

    def cage_angle(self, inner_spin: float, outer_spin: float = 0.0) -> float:
        """Angle of the cage from the spins of the rings [rad]; the rollers roll without slip.

        phi_c = (phi_i (1 - gamma) + phi_o (1 + gamma))/2. The spins must be counted through full turns.
        The same formula gives the speed of the cage from the speeds of the rings [rad/s].

        Examples
        --------
        >>> round(Bearing.named("NU308").cage_angle(1.0), 4)
        0.3939
        """
        gamma = self.geometry.gamma
        return 0.5 * (inner_spin * (1.0 - gamma) + outer_spin * (1.0 + gamma))

    def centrifugal_load(self, inner_speed: float, outer_speed: float = 0.0) -> float:
        """Centrifugal load of a roller for each metre of its length [N/m].

        Parameters
        ----------
        inner_speed, outer_speed : float
            Speeds of the rings [rad/s].

        Examples
        --------
        At 2000 rpm of the inner ring:

        >>> round(Bearing.named("NU308").centrifugal_load(2000.0 * math.pi / 30.0), 1)
        271.5
        """
        cage_speed = self.cage_angle(inner_speed, outer_speed)
        return self._mass_per_length * 0.5 * self.geometry.pitch_diameter * cage_speed**2

    @property
    def _mass_per_length(self) -> float:
        return self.material.density * math.pi / 4.0 * self.geometry.roller_diameter**2
