"""Maps of a scene that no file holds: of its bearings and its oil, made in memory with films from the film table."""

from __future__ import annotations

import dataclasses
from functools import lru_cache

from ehdmaps.errors import InputError
from ehdmaps.jobs.make.table_law import TEMPERATURES, table_map
from ehdmaps.maps.emap import EHDMap
from ehdmaps.physics.bearing import BearingGeometry
from ehdmaps.physics.lubricant import Lubricant
from mbs.scene.contact_laws import TABLE_LAW, speeds_of_laws
from mbs.scene.map_set import MapSet, suits
from mbs.scene.scene import Scene


def table_maps(scene: Scene) -> MapSet:
    """Maps of all types of bearing of a scene, over the usual ranges and those of the scene; a second each.

    Parameters
    ----------
    scene : Scene
        Bearings and oil.

    Raises
    ------
    InputError
        If the scene has no oil or no bearing.
    """
    if scene.lubricant is None:
        raise InputError(
            f"--law: got {TABLE_LAW!r}, but {scene.name} has no [lubricant]; add the table to the scene, or give a map"
        )
    if not scene.bearings:
        raise InputError(f"--law: got {TABLE_LAW!r}, but {scene.name} has no bearings; leave it out")
    temperatures = min(TEMPERATURES[0], scene.temperature), max(TEMPERATURES[1], scene.temperature)
    maps: list[EHDMap] = []
    for spec in scene.bearings:
        if not any(suits(emap, spec.geometry) for emap in maps):
            plain = dataclasses.replace(spec.geometry, diametral_clearance=0.0)
            maps.append(_made(plain, scene.lubricant, speeds_of_laws(plain, scene), temperatures))
    return MapSet(maps)


@lru_cache(maxsize=16)
def _made(
    geometry: BearingGeometry,
    lubricant: Lubricant,
    speeds: tuple[float, float],
    temperatures: tuple[float, float],
) -> EHDMap:
    """Map of one type of bearing, made once in a process."""
    return table_map(geometry, lubricant, entrainment_speeds=speeds, temperatures=temperatures)
