"""Pressures and films of the contacts of the bearings of a scene at an equilibrium, and the cost of rolling there."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ehdmaps.arrays import FloatArray
from mbs.bearings.contact_report import BearingContacts, RollingLoss
from mbs.model.elements import Operation
from mbs.scene.assembly import Model


def contacts_and_losses(
    model: Model, displacement: FloatArray, operation: Operation
) -> list[tuple[BearingContacts, RollingLoss]]:
    """Pressures and films of each bearing on rings at an equilibrium, in the order of its elements, and its loss.

    Parameters
    ----------
    model : Model
        Scene with its law.
    displacement : array, shape (n,)
        Displacement of the system.
    operation : Operation
        Speed and angle.
    """
    motions = [model.system.relative(entry.inner, entry.outer) @ displacement for entry in model.on_rings]
    return [entry.felt(motion, operation) for entry, motion in zip(model.on_rings, motions, strict=True)]


def losses_over_speed(
    models: Sequence[Model], speeds: FloatArray, displacements: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Rolling torque [N m] and power [W] of each bearing over speed, each of shape (speeds, bearings).

    NaN for films without rolling forces.

    Parameters
    ----------
    models : sequence of Model
        Scene with its law, as it is at each speed.
    speeds : array, shape (speeds,)
        [rad/s].
    displacements : array, shape (speeds, n)
        Displacements of the system at the equilibria.
    """
    found = np.full((2, speeds.size, len(models[0].on_rings)), np.nan)
    for index, (model, speed) in enumerate(zip(models, speeds.tolist(), strict=True)):
        losses = [loss for _, loss in contacts_and_losses(model, displacements[index], Operation(speed))]
        found[:, index] = [[loss.torque for loss in losses], [loss.total for loss in losses]]
        if np.all(np.isnan(found[:, index])):  # no film of this model knows any, at whatever speed
            break
    return found[0], found[1]
