"""Bearings NJ and NUP of a scene: where a ring moves along x they are held by their ribs.

Elsewhere nothing leans on a rib, and they are bearings like NU, with all that those take.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from typing import TYPE_CHECKING

from ehdmaps.physics.rollers.ribbed_geometry import NO_RIBS, RibbedGeometry, mirrored_ribs, ribbed_way, with_ribs
from ehdmaps.units import short
from mbs.scene.fields import MICROMETRE
from mbs.scene.shafts.standing import FARTHEST
from mbs.scene.specs import RIB_KEYS, BearingSpec, RigidSpec, ShaftSpec, TaperedSpec

if TYPE_CHECKING:
    from ehdmaps.jobs.table import Table
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
    mirrored = section.get("mirrored")
    if "mirrored" in section and not isinstance(mirrored, bool):
        section.note("mirrored", f"got {short(mirrored)}; allowed: true, false")
    if not way:
        for key in given:
            section.note(key, f"got a bearing without ribs on both rings; {NO_RIBS}")
        return spec
    geometry = with_ribs(spec.geometry, way, clearance)
    held = TaperedSpec(
        spec.name,
        spec.inner,
        spec.outer,
        mirrored_ribs(geometry) if mirrored is True else geometry,
        spec.start_angle,
        offset,
        spec.profile,
        spec.slices,
        tuple(key for key in _WITHOUT if key in section),
        tuple(given),
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


def with_clearance(spec: TaperedSpec, clearance: float) -> TaperedSpec:
    """The bearing with another diametral clearance, if it has one.

    Parameters
    ----------
    spec : TaperedSpec
        The bearing.
    clearance : float
        [m].
    """
    if not isinstance(spec.geometry, RibbedGeometry):
        return spec
    return dataclasses.replace(spec, geometry=spec.geometry.with_clearance(clearance))
