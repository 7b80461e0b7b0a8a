"""Time integration with the motion of all coordinates, for runs that are short enough to record it.

The method is that of `mbs.transient.stepping`; `mbs.transient.run` makes the steps, in compiled code where it knows
the elements.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from ehdmaps.arrays import FloatArray
from mbs.model.profiles import SpeedProfile
from mbs.model.system import System
from mbs.settings import Settings
from mbs.transient.run import record


@dataclass(frozen=True, eq=False)
class Trajectory:
    """Recorded states of a run.

    Attributes
    ----------
    time, speed, angle : array, shape (samples,)
        [s], [rad/s], [rad].
    displacement, velocity, acceleration : array, shape (samples, n)
        Motion of the coordinates [m or rad, per s, per s2].
    forces : tuple of array, shape (samples, m)
        Forces of each element in its ports [N or N m].
    steps, halved, iterations : int
        Steps made, steps taken back, and Newton iterations in all.
    """

    time: FloatArray
    speed: FloatArray
    angle: FloatArray
    displacement: FloatArray
    velocity: FloatArray
    acceleration: FloatArray
    forces: tuple[FloatArray, ...]
    steps: int
    halved: int
    iterations: int


def integrate(
    system: System,
    speed: SpeedProfile,
    duration: float,
    settings: Settings,
    displacement: FloatArray | None = None,
    velocity: FloatArray | None = None,
    progress: Callable[[int], None] | None = None,
    *,
    compiled: bool = True,
) -> Trajectory:
    """Integrate a system in time, and record all coordinates.

    Parameters
    ----------
    system : System
        Bodies, springs, loads, elements.
    speed : SpeedProfile
        Prescribed speed.
    duration : float
        How long [s]; rounded up to whole samples.
    settings : Settings
        Method and steps.
    displacement, velocity : array, shape (n,), optional
        Motion at time zero; zero if left out.
    progress : callable, optional
        Told the number of samples done: once for each, some at a time.
    compiled : bool
        False: the reference, step by step in Python.

    Raises
    ------
    InputError
        For an invalid start or duration, and for more samples than can be recorded.
    AnalysisError
        If a step finds no solution although it was halved ten times.
    """
    run, states = record(
        system, speed, duration, settings, (), displacement, velocity, progress, compiled=compiled, states=True
    )
    return Trajectory(
        run.time,
        run.speed,
        run.angle,
        states.displacement,
        states.velocity,
        states.acceleration,
        run.forces,
        run.steps,
        run.halved,
        run.iterations,
    )
