"""Parts of a run-up: short runs around some speeds of its ramp, and their sum levels.

A part begins from the equilibrium at its first speed. What swings in there is left out: windows are looked at from one
window after the beginning on. A part that begins with the ramp itself swings in as the whole run does, and has all of
its windows.
"""

from __future__ import annotations

import math
import time
from dataclasses import dataclass

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import AnalysisError, InputError
from mbs.analyses.operating import held
from mbs.analyses.ramp import recorded_run, run_course, silent_run
from mbs.analyses.sensors import followed_orders
from mbs.model.elements import Sensor
from mbs.scene import changes
from mbs.scene.assembly import Model
from mbs.scene.subject import Subject
from mbs.settings import CampbellSettings, RunUp
from mbs.spectral.campbell import campbell
from mbs.spectral.levels import Reference
from mbs.spectral.run_signal import RunSignal
from mbs.spectral.spectra import LEAST_OVERSAMPLING, LEAST_PERIODS

WINDOWS = 3
"""Length of a part, in windows; they overlap, so that it has 9 of them."""

LONGEST_WINDOW = 1.0 / 50.0
"""Of the ramp: with longer windows a part were no short run."""


@dataclass(frozen=True)
class RampPart:
    """A part of a ramp.

    Attributes
    ----------
    start : float
        When its run begins, in the time of the whole run [s].
    begin, end : float
        Times between which windows are looked at [s].
    speeds : (float, float)
        Speeds there [rad/s].
    """

    start: float
    begin: float
    end: float
    speeds: tuple[float, float]


@dataclass(frozen=True, eq=False)
class Ramp:
    """Settings with which the ramp of a scene is examined in parts.

    Attributes
    ----------
    sensors : tuple of Sensor
        The sensor that was asked for, then all others of an acceleration.
    highest : float
        Highest frequency [Hz].
    window : float
        Length of the windows [s].
    coarsest : float
        Longest step for that frequency: the step of the scene, doubled as often as can be, or halved [s].
    parts : tuple of RampPart
        All parts, one after the other.
    """

    sensors: tuple[Sensor, ...]
    highest: float
    window: float
    coarsest: float
    parts: tuple[RampPart, ...]


@dataclass(frozen=True, eq=False)
class PartRun:
    """Result of a run of a part.

    Attributes
    ----------
    speeds : array, shape (windows,)
        Speed at the middle of each window, rising [rad/s].
    levels : array, shape (sensors, windows)
        Sum level of each sensor [dB].
    forces : array, shape (bearings,)
        Root mean square of the oscillating force of each bearing, across its axis [N].
    bearings : tuple of str
        Names of the bearings.
    steps : int
        Steps made.
    outside : int
        Evaluations outside the map.
    seconds : float
        Processor time of the run [s].
    """

    speeds: FloatArray
    levels: FloatArray
    forces: FloatArray
    bearings: tuple[str, ...]
    steps: int
    outside: int
    seconds: float

    def differences(self, other: PartRun) -> FloatArray:
        """Levels of another run minus those of this one at the same speeds, shape (sensors, windows) [dB].

        Parameters
        ----------
        other : PartRun
            A run of the same part, with other settings.
        """
        return np.array(
            [
                np.interp(self.speeds, other.speeds, row) - own
                for row, own in zip(other.levels, self.levels, strict=True)
            ]
        )


def ramp_of(model: Model, settings: CampbellSettings, sensors: tuple[Sensor, ...]) -> Ramp:
    """Cut the ramp of a model into parts.

    Parameters
    ----------
    model : Model
        Scene with a law; held speeds before and after its ramp are in no part.
    settings : CampbellSettings
        Highest frequency, and window; a window that is left out, and one longer than `LONGEST_WINDOW`, is shortened to
        that.
    sensors : tuple of Sensor
        Whose levels are looked at.

    Raises
    ------
    InputError
        If the run is no ramp, or does not fit the settings.
    """
    problems: list[str] = []
    course = run_course(model.scene, settings.highest, problems)
    if problems or course is None:
        raise InputError(problems)
    silent = silent_run(course)
    order = max((order for order, _ in followed_orders(model, settings, course)), default=None)
    whole = campbell(silent, 1.0, settings.highest, settings.window, order)
    ramp = silent.ramp()
    coarsest = _coarsest(course, settings.highest)
    # Whole numbers of the coarsest steps, so that windows of all steps are at the same speeds.
    unit = 8.0 * coarsest
    window = min(whole.window, LONGEST_WINDOW * ramp.duration)
    window = unit * max(round(window / unit), math.ceil(LEAST_PERIODS / settings.highest / unit - 1e-9))
    length = WINDOWS * window
    first, count = float(ramp.time[0]), int(ramp.duration / length + 1e-9)
    parts = []
    for index in range(count):
        begin = first + index * length
        start = max(begin - window, first)
        speeds = tuple(course.speed.at(at)[0] for at in (begin, begin + length))
        parts.append(RampPart(start, begin, begin + length, (speeds[0], speeds[1])))
    return Ramp(sensors, settings.highest, window, coarsest, tuple(parts))


def run_part(subject: Subject, ramp: Ramp, part: RampPart) -> PartRun:
    """Run a part of a ramp.

    Parameters
    ----------
    subject : Subject
        Scene, with its settings, and law.
    ramp : Ramp
        How its ramp is looked at.
    part : RampPart
        One of its parts.

    Raises
    ------
    AnalysisError
        If there is no equilibrium, or a step finds no solution.
    """
    problems: list[str] = []
    scene = changes.with_part(subject.scene, part.start, part.end)
    course = run_course(scene, ramp.highest, problems)
    if problems or course is None:
        raise InputError(problems)
    model = held(Subject(scene, subject.law, subject.clearance).model())
    begin = time.process_time()
    record = recorded_run(model, course, ramp.sensors)
    seconds = time.process_time() - begin
    if not np.all(np.isfinite(record.signals)):
        raise AnalysisError("time integration: the motion grows beyond all numbers; take shorter steps")
    levels, speeds = [], np.empty(0)
    for column, sensor in enumerate(ramp.sensors):
        signal = RunSignal(record.time, record.speed, record.angle, record.signals[:, column])
        found = campbell(signal, Reference.of(sensor).value, ramp.highest, ramp.window)
        seen = found.time > part.begin - part.start + 0.5 * ramp.window - 0.5 * ramp.coarsest
        order = np.argsort(found.speeds[seen])
        speeds = found.speeds[seen][order]
        levels.append(found.sum_level[seen][order])
    late = record.time >= part.begin - part.start
    across = [record.forces[place][late][:, 1:3] for place in model.ring_places]
    forces = [float(np.sqrt(np.sum(np.var(force, axis=0)))) for force in across]
    outside, names = sum(record.outside.values()), tuple(entry.name for entry in model.on_rings)
    return PartRun(
        speeds,
        np.array(levels),
        np.array(forces),
        names,
        record.steps,
        outside,
        seconds,
    )


def _coarsest(course: RunUp, highest: float) -> float:
    """The step of a run, doubled as often as the highest frequency allows."""
    step, longest = course.settings.step, (1.0 + 1e-6) / (LEAST_OVERSAMPLING * highest)
    return step * 2.0 ** max(math.floor(math.log2(longest / step)), 0)
