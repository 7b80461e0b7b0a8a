"""The speed of a run by torques, with the rolling torque of the bearings among those that resist."""

from __future__ import annotations

import dataclasses

import numpy as np

from ehdmaps.arrays import FloatArray
from mbs.analyses.losses import losses_over_speed
from mbs.linearised.averaged import steady_system
from mbs.model.drive import Drive, DrivenSpeed, TorqueCurve
from mbs.model.elements import Operation
from mbs.model.equilibrium import equilibrium
from mbs.model.profiles import SpeedProfile
from mbs.scene.assembly import Model
from mbs.settings import RunUp

SPEEDS = 8
"""Speeds at which the rolling torque is found, between rest and the highest one of the drive alone."""


def course_of(model: Model, course: RunUp) -> SpeedProfile:
    """The speed of a run; where it follows from torques, with the rolling torque of the bearings of a model.

    Parameters
    ----------
    model : Model
        Scene with its law, in operation. Its films take a torque where its map has rolling forces.
    course : RunUp
        The run.

    Raises
    ------
    AnalysisError
        If there is no equilibrium at a speed.
    """
    speed = course.speed
    if not isinstance(speed, DrivenSpeed) or not model.bearings:
        return speed
    speeds = max(speed.course.values) * np.arange(1, SPEEDS + 1) / SPEEDS
    if speeds[0] <= 0.0:
        return speed
    system = steady_system(model.system)
    displacements = [equilibrium(system, Operation(at)).displacement for at in speeds.tolist()]
    power = losses_over_speed([model] * SPEEDS, speeds, np.array(displacements))[1].sum(axis=1)
    if not np.all(np.isfinite(power)):
        return speed
    return DrivenSpeed.of(_resisted(speed.drive, speeds, power / speeds), speed.course.values[0], course.duration)


def _resisted(drive: Drive, speeds: FloatArray, torques: FloatArray) -> Drive:
    """The drive with a torque over speed more that resists."""
    rolling = TorqueCurve(tuple(speeds.tolist()), tuple(torques.tolist()))
    at = tuple(sorted({*drive.load.speeds, *rolling.speeds}))
    load = TorqueCurve(at, tuple(drive.load(w) + rolling(w) for w in at))
    return dataclasses.replace(drive, load=load)
