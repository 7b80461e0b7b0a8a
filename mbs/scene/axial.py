"""Whether what helical gears push along the shafts is held there."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ehdmaps.arrays import FloatArray
from mbs.gears.pair import GearPair
from mbs.model.elements import Operation
from mbs.model.system import System

_ROUND_OFF = 1e-9


def axial_problems(system: System, pairs: Sequence[GearPair], operation: Operation) -> list[str]:
    """Which bodies helical gears push along x while nothing holds them there.

    Parameters
    ----------
    system : System
        The system that they are in.
    pairs : sequence of GearPair
        Gear pairs of the system.
    operation : Operation
        Speed at which elements are looked at.

    Notes
    -----
    A body with several helical gears may float between their axial forces, and is not looked at.
    """
    pushed: dict[str, list[str]] = {}
    for pair in pairs:
        for place in (pair.on, pair.against) if pair.helix_angle else ():
            pushed.setdefault(place.partition(":")[0], []).append(pair.name)
    return [
        f"gear pair {names[0]!r}: its helix pushes {body!r} along x, and nothing holds {body!r} there; give it a "
        "spring with a stiffness x, as a locating bearing has it, or take x from its freedoms"
        for body, names in pushed.items()
        if len(names) == 1 and _free_along_x(system, body, operation)
    ]


def _free_along_x(system: System, body: str, operation: Operation) -> bool:
    """Whether a body moves along x, and neither spring nor bearing resists."""
    from mbs.gears.gear import GearMesh

    own = np.array([name.partition(".")[0] == body and name.endswith(".x") for name in system.coordinates])
    moved = own.astype(np.float64)
    if not np.any(moved) or _resists(system.stiffness, moved):
        return False
    still = np.zeros(system.size)
    for connected in system.elements:
        if not isinstance(connected.element, GearMesh):
            stiffness = connected.evaluate(still, still, operation).stiffness
            if _resists(connected.transform.T @ stiffness @ connected.transform, moved):
                return False
    return True


def _resists(stiffness: FloatArray, motion: FloatArray) -> bool:
    """Whether a motion of the whole body has a stiffness, beyond the round-off of what bends in it."""
    inner = float(np.sum(np.abs(motion) @ np.abs(stiffness) @ np.abs(motion)))
    return float(motion @ stiffness @ motion) > _ROUND_OFF * inner
