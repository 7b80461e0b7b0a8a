"""Unknowns of the inner geometry of bearings: what an estimate may be off, by its own words, and profiles.

Each part is taken to its error alone, both ways where its effect is uneven: the diameter of rollers acts evenly to 2 %,
their length unevenly by up to 38 %. What no bearing can be is left out, and the other way stands for it.
"""

from __future__ import annotations

import dataclasses
import re
from collections.abc import Callable, Iterator
from typing import Any

from mbs.scene.changes import with_bearing
from mbs.scene.scene import Scene
from mbs.scene.specs import BearingSpec, LocatingSpec
from mbs.unknowns.statement import tolerance_of
from mbs.unknowns.unknown import Unknown, looks_of

GROOVES = (0.515, 0.53)
"""Radii of grooves over the ball diameter that makers take, see `ehdmaps.physics.point.ball_catalogue`."""

_PERCENT = ("roller diameter", "roller length", "ball diameter", "pitch diameter")
_EVEN = ("roller diameter",)
"""Parts whose effect is even: one look is enough."""


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
        for name, held, ends in _parts(entry, share):
            looks, reflected = looks_of([_changed(scene, entry.name, end) for end in ends])
            yield Unknown(f"{name} of {entry.name}", "geometry", held, why, looks, reflected)


def _parts(entry: BearingSpec | LocatingSpec, share: float) -> Iterator[tuple[str, str, list[dict[str, Any]]]]:
    """Parts of an estimated geometry: name, how far it is off, and its values at the ends, or at one that is enough."""
    geometry: Any = entry.geometry
    words: str = geometry.estimated
    for name in _PERCENT:
        if found := re.search(rf"{name} (?:to )?(\d+) %", words):
            key, size = name.replace(" ", "_"), share * float(found[1]) / 100.0
            ends = [{key: getattr(geometry, key) * (1.0 + sign * size)} for sign in (1.0, -1.0)]
            yield name, f"+-{100.0 * size:.3g} %", ends[:1] if name in _EVEN else ends
    if entry.of_points:
        for side in ("inner", "outer"):
            key = f"{side}_conformity"
            value = getattr(geometry, key)
            low, high = (value + share * (end - value) for end in GROOVES)
            yield f"{side} groove", f"{low:.4g} to {high:.4g} of the ball", [{key: low}, {key: high}]
    if found := re.search(r"number of (rollers|balls) \+-(\d+)", words):
        key, most = found[1], int(found[2])
        count = getattr(geometry, key)
        yield f"{key[:-1]} count", f"{count} +-{most}", [{key: count - most}, {key: count + most}]


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
