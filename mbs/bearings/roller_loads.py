"""Loads, approaches and films of the rollers of a bearing, to look at."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import InputError, MapError
from mbs.bearings.bearing import Bearing
from mbs.bearings.laws import unilateral_forces

if TYPE_CHECKING:
    from ehdmaps.maps.emap import EHDMap


@dataclass(frozen=True, eq=False)
class RollerLoads:
    """State of all rollers at one pose.

    Attributes
    ----------
    angle : array (Z,)
        Angles of the rollers in O, from y towards z, within -pi to pi [rad].
    load : array (Z,)
        Load of each roller on the inner raceway [N].
    moment : array (Z,)
        Tilting moment of each roller's load about its middle [N m].
    load_per_length : array (Z, n)
        Load of the slices on the inner raceway [N/m].
    damping : array (Z, n)
        Damping of the slices at rest, per unit length [N s/m2].
    approach : array (Z, n)
        Total approach of both contacts of the slices [m]; below zero a gap, or a film. Of coupled slices the part that
        belongs to their own load.
    position : array (n,)
        Middles of the slices [m].
    """

    angle: FloatArray
    load: FloatArray
    moment: FloatArray
    load_per_length: FloatArray
    damping: FloatArray
    approach: FloatArray
    position: FloatArray

    def load_zone(self, share: float = 0.0) -> FloatArray:
        """Angles of the rollers that carry more than a share of the highest roller load, sorted [rad]."""
        return np.sort(self.angle[self.load > share * float(np.max(self.load))])

    def films(
        self,
        emap: EHDMap,
        entrainment_speed: float,
        temperature: float,
        centrifugal_load: float = 0.0,
        variable: str = "central_film",
    ) -> FloatArray:
        """Film of each roller at the inner and the outer race, (Z, 2) [m], at its mean load per length.

        It is read from the map between its points, linearly in the logarithms; NaN for a load, speed or temperature
        outside the map, so for unloaded rollers too.

        Parameters
        ----------
        emap : EHDMap
            Map of this bearing.
        entrainment_speed, temperature, centrifugal_load : float
            u [m/s], T [K], q [N/m].
        variable : {"central_film", "minimum_film"}
            Which film.

        Raises
        ------
        InputError
            For another variable.
        MapError
            For a map without the contacts of a roller.
        """
        from scipy.interpolate import RegularGridInterpolator  # films of a map alone need it

        if variable not in ("central_film", "minimum_film"):
            raise InputError(f"rollers, film: got {variable!r}; allowed: central_film, minimum_film")
        if emap.bearing is None:
            raise MapError("rollers, film: got the map of a bare contact; allowed: a map of the bearing")
        mean = np.mean(self.load_per_length, axis=1)
        out = np.full((mean.size, 2), np.nan)
        data = emap.dataset[variable].transpose("contact", "load", "entrainment_speed", "temperature")
        data = data.sel(entrainment_speed=data["entrainment_speed"] > 0.0)
        axes = (np.log(data["load"].values), np.log(data["entrainment_speed"].values), data["temperature"].values)
        size = abs(entrainment_speed)
        for i, contact in enumerate(("inner", "outer")):
            loads = mean + (centrifugal_load if contact == "outer" else 0.0)
            loaded = loads > 0.0
            if size == 0.0 or not np.any(loaded):
                continue
            kept = tuple(axis.size > 1 for axis in axes)
            with np.errstate(divide="ignore"):
                values = np.log(data.sel(contact=contact).values)
            places = np.stack(
                [np.log(loads[loaded]), np.full(loaded.sum(), math.log(size)), np.full(loaded.sum(), temperature)],
                axis=1,
            )
            found = RegularGridInterpolator(
                tuple(axis for axis, keep in zip(axes, kept, strict=True) if keep), values.squeeze(), bounds_error=False
            )(places[:, kept])
            for axis, keep, place in zip(axes, kept, places.T, strict=True):
                if not keep:
                    found = np.where(np.abs(place - axis[0]) < 1e-9 * max(1.0, abs(axis[0])), found, np.nan)
            out[loaded, i] = np.exp(found)
        return out


def roller_loads(
    bearing: Bearing,
    slices: FloatArray,
    states: FloatArray,
    rollers: FloatArray,
    cage_angle: float,
    own: FloatArray | None = None,
) -> RollerLoads:
    """Make the record from what a call of `bearing_force` leaves.

    Parameters
    ----------
    bearing : Bearing
        The bearing.
    slices : array (2, n)
        Positions of the slices, and twice the profile there [m].
    states : array (4, Z, n)
        States of the slices, see `mbs.bearings.roller_motion.Work`.
    rollers : array (4, Z)
        Motion of the rollers, see `mbs.bearings.roller_motion.rollers_of_arrays`.
    cage_angle : float
        Angle of the first roller [rad].
    own : array (Z, n), optional
        Approaches that the law takes, of slices that are coupled [m]; their loads are those at rest.
    """
    count = bearing.geometry.rollers
    x, lost = slices
    gap, tilt, gap_rate, tilt_rate = (part[:, None] for part in rollers)
    approach = gap + x * tilt - lost
    rate = gap_rate + x * tilt_rate
    if own is None:
        load, _, _ = unilateral_forces(states[0], states[1], states[2], states[3], rate)
    else:
        load, approach = states[0].copy(), own.copy()
    angle = cage_angle + 2.0 * math.pi * np.arange(count) / count
    return RollerLoads(
        angle=np.arctan2(np.sin(angle), np.cos(angle)),
        load=load.sum(axis=1) * bearing.slice_length,
        moment=(load * x).sum(axis=1) * bearing.slice_length,
        load_per_length=load,
        damping=states[2].copy(),
        approach=approach,
        position=x.copy(),
    )
