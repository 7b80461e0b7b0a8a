"""List of all that a scene leaves open: unknowns with their half-widths, taken as uniform, and the sources of these.

====================  ===========================  ===================================================================
unknown               half-width                   source
====================  ===========================  ===================================================================
clearance, not stated  class of ISO 5753-1          from 20 um (balls 10 um) below its least value, at least 0, to its
                                                   largest: what fits and warmth take
clearance, stated     5 um                         k5 in a ring of class P0: 2 to 25 um of interference; 5 K between
                                                   the rings of a bore of 40 mm: 4 um
temperature           5 K                          assumed
====================  ===========================  ===================================================================

Whatever states a tolerance replaces its row, see `mbs.unknowns.statement`.
"""

from __future__ import annotations

from collections.abc import Iterator

from ehdmaps.physics.designations.clearance import STATED, clearance_range
from mbs.scene.changes import warmed, with_clearance_of
from mbs.scene.fields import MICROMETRE
from mbs.scene.scene import Scene
from mbs.scene.specs import BearingSpec, LocatingSpec
from mbs.unknowns.statement import tolerance_of
from mbs.unknowns.unknown import Unknown

LOOSER = 5e-6
"""Half-width of a clearance that is stated without a tolerance [m]."""

WARMER = 5.0
"""Half-width of a temperature that is stated without a tolerance [K]."""


def held_open(scene: Scene) -> tuple[Unknown, ...]:
    """List all that a scene leaves open; what is stated to be exact is not among it.

    Parameters
    ----------
    scene : Scene
        The scene, with the clearances and temperatures in force: that of a `Model`.
    """
    return tuple((*_clearances(scene), *_temperature(scene)))


def _clearances(scene: Scene) -> Iterator[Unknown]:
    """The clearance of each bearing that has one."""
    entries: tuple[BearingSpec | LocatingSpec, ...] = (*scene.bearings, *scene.located)
    for entry in entries:
        if (value := clearance_of(entry)) is None:
            continue
        name, stated = f"clearance of {entry.name}", tolerance_of(scene, "clearance", entry.name)
        reach = clearance_range(entry.geometry)
        if stated is None and reach is not None and reach.taken != STATED:
            least, largest = reach.reach
            held = f"{1e6 * least:.4g} to {MICROMETRE.text(largest)}"
            why = reach.why
        else:
            half = LOOSER if stated is None else stated.half_width(value)
            least, largest = value - half, value + half
            held = f"{MICROMETRE.text(value)} +-{MICROMETRE.text(half)}"
            why = "stated bare: fits and warmth of rings" if stated is None else "as stated"
        if least < largest:
            looks = tuple(with_clearance_of(scene, entry.name, end) for end in (least, largest))
            yield Unknown(name, "clearance", held, why, looks)


def _temperature(scene: Scene) -> Iterator[Unknown]:
    """The temperature of all bearings together."""
    stated = tolerance_of(scene, "temperature")
    half = WARMER if stated is None else stated.size
    if half and scene.has_bearings:
        why = "stated bare: assumed" if stated is None else "as stated"
        yield Unknown("temperature", "temperature", f"+-{half:g} K", why, (warmed(scene, -half), warmed(scene, half)))


def clearance_of(entry: BearingSpec | LocatingSpec) -> float | None:
    """Diametral clearance of a bearing [m]; None for tapered rollers, whose play is set along the axis."""
    if isinstance(entry, BearingSpec):
        return entry.geometry.diametral_clearance
    found: float | None = entry.geometry.clearance
    return found
