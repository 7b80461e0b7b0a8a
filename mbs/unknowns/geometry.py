"""Unknowns of the inner geometry of bearings: what an estimate may be off, by its own words, and profiles.

Each part is taken to its error alone, both ways where its effect is uneven: the diameter of rollers acts evenly to 2 %,
their length unevenly by up to 38 %. What no bearing can be is left out, and the other way stands for it. Parts and
errors are those of `ehdmaps.physics.designations.estimates`.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Iterator
from typing import Any

from ehdmaps.physics.designations.estimates import estimated_parts
from mbs.scene.changes import with_bearing
from mbs.scene.scene import Scene
from mbs.scene.specs import BearingSpec, LocatingSpec
from mbs.unknowns.statement import tolerance_of
from mbs.unknowns.unknown import Unknown, looks_of


def geometries(scene: Scene) -> Iterator[Unknown]:
    """Parts of estimated geometries, of each bearing its own.

    Parameters
    ----------
    scene : Scene
        The scene.
    """
    for entry in scene.of_all_kinds:
        stated = tolerance_of(scene, "geometry", entry.name)
        share = 1.0 if stated is None else stated.size
        if not entry.geometry.estimated or not share:
            continue
        why = "estimated from a catalogue" if stated is None else f"estimated; {stated.text} of its errors as stated"
        for part in estimated_parts(entry.geometry, share):
            ends = part.ends[:1] if part.even else part.ends
            looks, reflected = looks_of([_changed(scene, entry.name, end) for end in ends])
            yield Unknown(f"{part.name} of {entry.name}", "geometry", part.held, why, looks, reflected)


def profiles(scene: Scene) -> Iterator[Unknown]:
    """Profiles of rollers that are not stated: crowned by ISO 16281, or straight.

    Parameters
    ----------
    scene : Scene
        The scene.
    """
    entries: tuple[BearingSpec | LocatingSpec, ...] = (*scene.bearings, *scene.located)
    for entry in entries:
        if getattr(entry, "profile", None) == "iso" and tolerance_of(scene, "profile", entry.name) is None:
            straight = with_bearing(scene, entry.name, lambda one: dataclasses.replace(one, profile="straight"))
            yield Unknown(f"profile of {entry.name}", "profile", "iso or straight", "not stated: assumed", (straight,))


def _changed(scene: Scene, name: str, values: dict[str, Any]) -> Callable[[], Scene]:
    """Maker of the scene with other parts of the geometry of a bearing, which is no estimate then."""

    def changed(entry: Any) -> Any:
        return dataclasses.replace(entry, geometry=dataclasses.replace(entry.geometry, estimated=None, **values))

    return lambda: with_bearing(scene, name, changed)
