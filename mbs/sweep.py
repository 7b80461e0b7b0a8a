"""Modes over speed: an equilibrium and its undamped modes at each speed, each mode followed from speed to speed.

Undamped, because the film of a lightly loaded bearing damps so strongly that its complex modes stop to oscillate;
gyroscopic terms are left out with them.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ehdmaps.physics._values import FloatArray
from mbs.elements import Operation
from mbs.modes import UndampedModes, follow, undamped_modes
from mbs.statics import equilibrium
from mbs.system import System


@dataclass(frozen=True, eq=False)
class Sweep:
    """Modes over speed, in the order that they have at the first one.

    Attributes
    ----------
    speeds : array, shape (speeds,)
        [rad/s].
    frequency, damping_ratio : array, shape (speeds, n)
        Of mass and stiffness [Hz]; modal [1].
    bearing_share : array, shape (speeds, n)
        Part of the strain energy in all bearings.
    displacement : array, shape (speeds, n)
        Equilibrium [m or rad].
    forces : tuple of array, shape (speeds, m)
        Of each element [N or N m].
    """

    speeds: FloatArray
    frequency: FloatArray
    damping_ratio: FloatArray
    bearing_share: FloatArray
    displacement: FloatArray
    forces: tuple[FloatArray, ...]


def sweep(system: System, speeds: FloatArray, angle: float = 0.0) -> Sweep:
    """Equilibria and undamped modes over speed at a fixed angle, which is a fixed cage angle.

    Parameters
    ----------
    system : System
        Bodies, springs, loads, elements.
    speeds : array, shape (speeds,)
        [rad/s].
    angle : float
        What the system has turned [rad].
    """
    elements = {connected.element.name for connected in system.elements}
    place: FloatArray | None = None
    before: UndampedModes | None = None
    order = np.arange(system.size)
    out = np.empty((3, len(speeds), system.size))
    places, forces = [], []
    for index, speed in enumerate(speeds):
        balance = equilibrium(system, Operation(float(speed), angle), place)
        place, found = balance.displacement, undamped_modes(balance)
        if before is not None:
            order = follow(before.shapes, found.shapes, system.mass)[order]
        before = found
        bearings = found.shares[[part in elements for part in found.parts]].sum(axis=0)
        out[:, index] = found.frequency[order], found.damping_ratio[order], bearings[order]
        places.append(place)
        forces.append(balance.forces)
    frequency, ratio, share = out
    return Sweep(
        np.asarray(speeds, dtype=np.float64),
        frequency,
        ratio,
        share,
        np.array(places),
        tuple(np.array(part) for part in zip(*forces, strict=True)),
    )
