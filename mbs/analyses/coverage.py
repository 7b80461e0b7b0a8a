"""Whether maps cover what the bearings of a scene need."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.maps.emap import EHDMap
from mbs.analyses import planning
from mbs.analyses.planning import Needed
from mbs.scene.map_set import MapSet

ROUND_OFF = 1e-9
"""Of units that a map was written with, relative."""


@dataclass(frozen=True)
class AxisCover:
    """What is mapped of an axis, and where it falls short.

    Attributes
    ----------
    mapped : (float, float)
        Lowest and highest value of the map, in SI; rest is left out.
    below, above : bool
        Whether more is needed there.
    """

    mapped: tuple[float, float]
    below: bool
    above: bool


@dataclass(frozen=True)
class Coverage:
    """What a map has of what the bearings of one geometry need.

    Attributes
    ----------
    needed : Needed
        The ranges, with the lowest load that a map may begin at.
    load, entrainment_speed, temperature : AxisCover
        The axes of the map beside them.
    """

    needed: Needed
    load: AxisCover
    entrainment_speed: AxisCover
    temperature: AxisCover

    @property
    def axes(self) -> tuple[AxisCover, AxisCover, AxisCover]:
        """All axes: load, entrainment speed, temperature."""
        return self.load, self.entrainment_speed, self.temperature

    @property
    def whole(self) -> bool:
        """Whether everything that is needed is mapped."""
        return not any(axis.below or axis.above for axis in self.axes)


def coverage(needed: Sequence[Needed], maps: EHDMap | MapSet) -> tuple[Coverage, ...]:
    """Compare maps with what is needed.

    Parameters
    ----------
    needed : sequence of Needed
        Ranges by geometry, as `mbs.plan` finds them.
    maps : EHDMap or MapSet
        One map for all, or one for each geometry.

    Raises
    ------
    EhdmapsError
        If no contact law can be made of the map, whatever its axes are.
    """
    found = []
    for entry in needed:
        emap = maps if isinstance(maps, EHDMap) else maps.of(entry.geometry)
        assert emap is not None  # `dry_model` of the plan saw to it
        emap.check_usable(("inner", "outer"))
        axes = [emap.dataset[key].values for key in ("load", "entrainment_speed", "temperature")]
        # At rest there is no film to be mapped; only a dry map has no other speed.
        mapped = [axis[axis > 0.0] if np.any(axis > 0.0) else axis for axis in axes]
        highest = entry.load[1]
        wanted = dataclasses.replace(entry, load=(min(planning.LIGHT_ENOUGH * highest, planning.LIGHT), highest))
        temperatures = (wanted.temperature, wanted.temperature)
        ranges = (wanted.load, wanted.entrainment_speed, temperatures)
        found.append(Coverage(wanted, *(_cover(ends, axis) for ends, axis in zip(ranges, mapped, strict=True))))
    return tuple(found)


def _cover(needed: tuple[float, float], axis: FloatArray) -> AxisCover:
    """One axis of a map beside what is needed of it."""
    low, high = float(axis.min()), float(axis.max())
    return AxisCover((low, high), needed[0] < low * (1.0 - ROUND_OFF), needed[1] > high * (1.0 + ROUND_OFF))
