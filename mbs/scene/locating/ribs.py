"""Bearings NJ, NUP, NCF and NNCF of a scene: where a ring moves along x they are held by their ribs.

Elsewhere nothing leans on a rib, and they are bearings like NU, with all that those take.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

from ehdmaps.physics.rollers.ribbed_geometry import NO_RIBS, RibbedGeometry, mirrored_ribs, ribbed_way, with_ribs
from mbs.gears.pair import GearPair
from mbs.scene.fields import FORCE, MICROMETRE
from mbs.scene.shafts.standing import FARTHEST
from mbs.scene.specs import RIB_KEYS, BearingSpec, LocatingSpec, RigidSpec, ShaftSpec, TaperedSpec

if TYPE_CHECKING:
    from ehdmaps.jobs.table import Table
    from mbs.scene.scene import Scene
    from mbs.scene.specs import BodySpec, ElementSpec

_WITHOUT = ("rollers", "thermal", "fit", "expansion", "supply", "slices_coupled", "pocket_clearance")
"""Keys of bearings like NU that ribs do not take."""


def read_ribs(section: Table, spec: BearingSpec) -> BearingSpec:
    """The bearing with what its ribs make of it, if it is NJ or NUP; else the bearing as it is.

    Parameters
    ----------
    section : Table
        The table; the caller closes it.
    spec : BearingSpec
        The bearing as it is without ribs.
    """
    designation = section.get("bearing")
    way = ribbed_way(designation) if isinstance(designation, str) else ""
    given = [key for key in RIB_KEYS if key in section]
    clearance = section.quantity("axial_clearance", "m", 0.0, FARTHEST, MICROMETRE) or 0.0
    offset = section.quantity("axial_offset", "m", -FARTHEST, FARTHEST, MICROMETRE) or 0.0
    mirrored = section.flag("mirrored")
    if not way:
        for key in given:
            section.note(key, f"got a bearing without ribs on both rings; {NO_RIBS}")
        return spec
    geometry = with_ribs(spec.geometry, way, clearance)
    held = TaperedSpec(
        spec.name,
        spec.inner,
        spec.outer,
        mirrored_ribs(geometry) if mirrored else geometry,
        spec.start_angle,
        offset,
        profile=spec.profile,
        slices=spec.slices,
        without=tuple(key for key in _WITHOUT if key in section),
        given=tuple(given),
    )
    return dataclasses.replace(spec, between_ribs=held)


def held_by_ribs(elements: Sequence[ElementSpec], bodies: Sequence[BodySpec], problems: list[str]) -> list[ElementSpec]:
    """The elements of a scene with NJ and NUP by their ribs where one of their rings moves along x.

    Parameters
    ----------
    elements : sequence of ElementSpec
        Machine elements as they were read.
    bodies : sequence of BodySpec
        Bodies of the scene; those of finite elements only bend along x.
    problems : list of str
        What is wrong; added to.
    """
    moving = {body.name for body in bodies if isinstance(body, RigidSpec | ShaftSpec) and "x" in body.freedoms}
    found: list[ElementSpec] = []
    for spec in elements:
        if not isinstance(spec, BearingSpec) or spec.between_ribs is None:
            found.append(spec)
            continue
        held = spec.between_ribs
        if {spec.inner.partition(":")[0], spec.outer.partition(":")[0]} & moving:
            found.append(dataclasses.replace(held, without=(), given=()))
            problems += [
                f"[[bearings]] {spec.name}, {key}: got {spec.geometry.name}, whose ring moves along x: its ribs hold "
                f"it, without {key}; allowed: NU with a locating bearing, or no freedom x"
                for key in held.without
            ]
        else:
            found.append(dataclasses.replace(spec, between_ribs=None))
            problems += [
                f"[[bearings]] {spec.name}, {key}: has no effect on a bearing whose rings do not move along x; "
                "allowed: on a body with the freedom x; delete it"
                for key in held.given
            ]
    return found


def open_sides(scene: Scene) -> list[str]:
    """Sentences on bearings NJ that loads and weight push to their open side, where nothing else holds the body.

    Forces of gears are not known before an analysis, and left out.

    Parameters
    ----------
    scene : Scene
        The scene, with its bearings between ribs.
    """
    problems = []
    for body in scene.bodies:
        if not isinstance(body, RigidSpec | ShaftSpec) or "x" not in body.freedoms:
            continue
        force = _axial(scene, body)
        way = math.copysign(1.0, force)
        held = [entry for entry in scene.elements if _touches(entry, body.name)]
        springs = any(body.name in (_body(entry.on), _body(entry.against)) for entry in scene.springs)
        if force == 0.0 or springs or any(_carries(entry, body.name, way) for entry in held):
            continue
        problems += [
            f"[[bearings]] {entry.name}: {entry.geometry.name} is pushed to its open side by {FORCE.text(abs(force))} "
            f"along {'x' if force > 0.0 else '-x'} on {body.name}; it carries {entry.geometry.ways}, and nothing else "
            "holds the body; allowed: mirrored = true, NUP in its place, or a locating bearing"
            for entry in held
            if isinstance(entry, TaperedSpec) and isinstance(entry.geometry, RibbedGeometry)
        ]
    return problems


def _body(place: str) -> str:
    """Body of a place."""
    return place.partition(":")[0]


def _axial(scene: Scene, body: RigidSpec | ShaftSpec) -> float:
    """Force of loads and weight along x on a body [N]."""
    pushed = 0.0
    for load in scene.loads:
        pushed += float(load.force[0]) * ((_body(load.on) == body.name) - (_body(load.against) == body.name))
    if isinstance(body, RigidSpec):
        mass = sum(part.mass for part in body.parts)
    else:
        mass = sum(part.mass for part in body.sections) + sum(disc.inertia.mass for disc in body.discs)
    return pushed + scene.gravity[0] * mass


def _touches(entry: ElementSpec, body: str) -> bool:
    """Tell whether a machine element is at a body."""
    places = [getattr(entry, name, "") for name in ("inner", "outer", "on", "against")]
    return body in map(_body, places)


def _carries(entry: ElementSpec, body: str, way: float) -> bool:
    """Tell whether an element holds a body that is pushed along x, or along -x; what is not known, does."""
    if isinstance(entry, BearingSpec):
        return False
    if isinstance(entry, GearPair):
        return False
    on_inner = way if _body(getattr(entry, "inner", "")) == body else -way
    return not isinstance(entry, LocatingSpec) or bool(entry.geometry.carries_along(on_inner))
