"""Error of the signals of a run by its step, estimated by parts of it that are made again with twice the step.

What steps resolve cannot be told from frequencies alone: contacts lift off, films fade, speeds rise. So eight parts of
a run are made again, from the state that it had there, films included, with twice its step: the loudest one of each
eighth of the run. Twice the step costs half, so that a fifth of the run is seen for a tenth of its steps: errors are
large where a resonance is passed, and change their sign there, which two parts alone miss. The first quarter of a part
is left out, in which films take another step, and so is the first twentieth of the run, in which it swings in. The
largest error of all parts is stated, for each sensor.

A method of second order whose levels change by d with twice the step is d/3 away from its limit. Where signals are half
as far apart as they are large, there is no order, and all of d counts. Where they still come apart at the end of the
part, as with little damping, their levels are yet those of their common start, and a third of the distance of the
signals themselves in the last quarter says by how much levels may differ; such errors are told as "up to". Levels that
are more than 20 dB below the loudest ones of the whole run count as these 20 dB; a sensor that is so quiet in all parts
is told as not judged.
"""

from __future__ import annotations

import dataclasses
import math
from dataclasses import dataclass

import numpy as np

from ehdmaps.arrays import BoolArray, FloatArray
from ehdmaps.errors import EhdmapsError
from ehdmaps.units import RPM
from mbs.model.drive import DrivenSpeed
from mbs.model.profiles import Course, SpeedProfile
from mbs.scene.assembly import Model
from mbs.scene.fields import MICROSECOND, MILLISECOND
from mbs.settings import RunUp
from mbs.spectral.levels import Reference
from mbs.transient.run import Recording
from mbs.transient.run import run as run_system
from mbs.transient.stepping import Mark

PART = 0.025
"""Part of a run that each of the parts is: with twice the step all of them cost a tenth of it."""

PARTS = 8
"""Parts that are made again, at most."""

FEWEST = 200
"""Fewest steps of a part, for short runs."""

SWINGING_IN = 0.05
"""Part of a run at its start that is not judged: two of 40 windows, as many as levels within a tolerance may miss. A
smooth machine is loudest there, by a ringing that its run was not made for."""

NOTABLE = 1.0
"""Estimated error of a level from which on it is warned of [dB]."""

QUIET = 0.1
"""Part of the largest root mean square of a sensor below which levels are not judged."""

GROWING = 1.2
"""Distance of both signals in the last quarter beside that in the second one, from which on it still grows."""

APART = 0.5
"""Distance of both signals beside their size from which on their change has no order."""

_LIMIT = 3.0
"""Change of a level by twice the step beside its distance from the limit, of a method of second order."""

_QUARTERS = 4


@dataclass(frozen=True, eq=False)
class StepCheck:
    """Signals of parts of a run with its step and with twice that.

    Attributes
    ----------
    duration : float
        Length of each part [s].
    step : float
        Step of the run [s].
    speeds : tuple of (float, float)
        Speeds of each part, at its beginning and its end [rad/s].
    names, units : tuple of str
        Sensors, and units of their signals.
    with_step, with_twice : array, shape (parts, sensors)
        Root mean square of each signal about its mean.
    by_level : array, shape (parts, sensors)
        Error of each level as its change in the part tells it [dB].
    errors : array, shape (parts, sensors)
        Estimated error of each level, where signals still come apart that of their distance [dB].
    growing : array of bool, shape (parts, sensors)
        Whether the signals still come apart at the end of the part, so that the error is that of their distance.
    floor : array, shape (sensors,)
        Root mean square of each signal below which its levels are not judged.
    """

    duration: float
    step: float
    speeds: tuple[tuple[float, float], ...]
    names: tuple[str, ...]
    units: tuple[str, ...]
    with_step: FloatArray
    with_twice: FloatArray
    by_level: FloatArray
    errors: FloatArray
    growing: BoolArray
    floor: FloatArray

    @property
    def largest(self) -> FloatArray:
        """Estimated error of the level of each sensor with the step of the run, shape (sensors,) [dB]."""
        return np.asarray(self.errors.max(axis=0))

    def of(self, sensor: str) -> float:
        """Estimated error of the level of a sensor [dB].

        Parameters
        ----------
        sensor : str
            Name of the sensor.
        """
        return float(self.largest[self.names.index(sensor)])

    @property
    def converged(self) -> bool:
        """True where all are within `NOTABLE`."""
        return bool(np.all(self.largest <= NOTABLE))

    @property
    def lines(self) -> list[str]:
        """One line of words on the estimate; a warning where steps are too long."""
        how = f"by twice the step in {len(self.speeds)} parts of {MILLISECOND.text(self.duration)}"
        step = MICROSECOND.text(self.step)
        if self.converged:
            each = ", ".join(f"{name} {self._size(k)}" for k, name in enumerate(self.names))
            return [f"estimated error of the step of {step}: {each}; {how}{self._growth}"]
        wrong, sure = [], False
        for k in np.flatnonzero(self.largest > NOTABLE).tolist():
            at = int(np.argmax(self.errors[:, k]))
            sure = sure or not self.growing[at, k]
            first, last = (abs(speed) for speed in self.speeds[at])
            wrong.append(
                f"{self.names[k]} {self._size(k)} off at {RPM.value(first):.4g} to {RPM.text(last)}, "
                f"{self.with_step[at, k]:.3g} {self.units[k]} rms and {self.with_twice[at, k]:.3g} with twice the step"
            )
        is_not = "is not" if sure else "may not be"
        return [
            f"warning: this run {is_not} converged with steps of {step}: {'; '.join(wrong)}; estimated {how}"
            f"{self._growth}; take shorter steps in [runup], or --tolerance"
        ]

    def _size(self, sensor: int) -> str:
        """The error of a sensor in words."""
        if np.all(self.with_step[:, sensor] < self.floor[sensor]):
            return "not judged, 20 dB below its swinging in"
        at = int(np.argmax(self.errors[:, sensor]))
        return f"{'up to ' if self.growing[at, sensor] else ''}{self.errors[at, sensor]:.2g} dB"

    @property
    def _growth(self) -> str:
        """Reason of "up to", where it is said."""
        largest = np.argmax(self.errors, axis=0), np.arange(len(self.names))
        return "; up to: signals still come apart at the end of a part" if self.growing[largest].any() else ""


def step_check(model: Model, course: RunUp, record: Recording, highest: float = math.inf) -> StepCheck | None:
    """Estimate the error of a run by its step.

    Parameters
    ----------
    model : Model
        Scene with its law, in operation.
    course : RunUp
        The run.
    record : Recording
        What it recorded: all sensors of the scene at every step, and marks.
    highest : float
        Highest frequency that is looked at [Hz].

    Returns
    -------
    StepCheck or None
        None without sensors and without marks, with steps that adapt to a tolerance, and where twice the step finds no
        solution.
    """
    sensors, settings = model.scene.sensors, course.settings
    if not sensors or not record.marks or math.isfinite(settings.tolerance):
        return None
    step, total = settings.step, record.signal_time.size - 1
    rows = min(max(round(PART * total), FEWEST), total) // 2 * 2
    if rows == 0:
        return None
    # What twice the step has no samples for cannot be compared.
    highest = min(highest, 0.25 / step)
    speed = course.speed
    if isinstance(speed, DrivenSpeed):
        # As it was: a drive would have to be started anew.
        speed = SpeedProfile(Course(tuple(record.time.tolist()), tuple(record.speed.tolist())))
    coarser = dataclasses.replace(settings, step=2.0 * step, sample=2.0 * step)
    speeds, found = [], []
    chosen = _chosen(record, step, rows, highest)
    floor = QUIET * window_sizes(up_to(record.signals, step, highest), total // rows).max(axis=0)
    for mark, seen in chosen:
        begin = mark.stepped(2.0)
        try:
            again = run_system(model.system, speed, rows * step, coarser, sensors=sensors, begin=begin).signals
        except EhdmapsError:
            return None
        found.append(_compared(seen[::2], up_to(again, 2.0 * step, highest), floor))
        first = round(mark.time / step)
        speeds.append((float(record.signal_speed[first]), float(record.signal_speed[first + rows])))
    names, units = tuple(sensor.name for sensor in sensors), tuple(Reference.of(sensor).unit for sensor in sensors)
    columns = (*map(np.array, zip(*found, strict=True)), floor)
    return StepCheck(rows * step, step, tuple(speeds), names, units, *columns)


def up_to(signals: FloatArray, step: float, highest: float) -> FloatArray:
    """Signals without what lies above a frequency; a line from their first to their last value stays as it is.

    Parameters
    ----------
    signals : array, shape (rows, sensors)
        Signals at equal times.
    step : float
        Time between these [s].
    highest : float
        The frequency [Hz].

    Examples
    --------
    >>> import numpy as np
    >>> times = np.arange(4000) * 1e-4
    >>> both = np.sin(2.0 * np.pi * 100.0 * times) + 5.0 * np.sin(2.0 * np.pi * 3000.0 * times)
    >>> np.std(up_to(both[:, None], 1e-4, 1000.0), axis=0).round(2)
    array([0.71])
    """
    count = signals.shape[0]
    if highest >= 0.5 / step:
        return signals
    # A jump from the end to the beginning would ring at both.
    line = np.linspace(signals[0], signals[-1], count)
    lines = np.fft.rfft(signals - line, axis=0)
    lines[np.fft.rfftfreq(count, step) > highest] = 0.0
    return np.asarray(np.fft.irfft(lines, count, axis=0) + line)


def window_sizes(signals: FloatArray, count: int) -> FloatArray:
    """Root mean squares of signals about their mean in windows of equal length.

    Parameters
    ----------
    signals : array, shape (rows, sensors)
        Signals at equal times.
    count : int
        Number of windows.

    Returns
    -------
    array, shape (windows, sensors)
        Sizes in the units of the signals.
    """
    return np.array([np.std(window, axis=0) for window in np.array_split(signals, count)])


def level_change(one: FloatArray, other: FloatArray, floor: FloatArray | None = None) -> FloatArray:
    """Difference of the levels of two sizes, where what is quiet counts as the floor.

    Parameters
    ----------
    one, other : array, shape (..., sensors)
        Root mean squares.
    floor : array, shape (sensors,), optional
        Size below which levels are not judged; `QUIET` times the largest of `one` if left out.

    Returns
    -------
    array, shape (..., sensors)
        Either way [dB].

    Examples
    --------
    >>> import numpy as np
    >>> level_change(np.array([[10.0], [0.1]]), np.array([[5.0], [0.2]])).round(2).tolist()
    [[6.02], [0.0]]
    """
    floor = np.maximum(QUIET * one.max(axis=0) if floor is None else floor, np.finfo(np.float64).tiny)
    return np.asarray(np.abs(20.0 * np.log10(np.maximum(one, floor) / np.maximum(other, floor))))


def _compared(
    one: FloatArray, twice: FloatArray, floor: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray, BoolArray]:
    """Columns of `StepCheck` for a part, from `with_step` to `growing`, shape (sensors,) each."""
    late = slice(one.shape[0] // _QUARTERS, None)
    sizes = [np.std(signal[late], axis=0) for signal in (one, twice)]
    floor = np.maximum(floor, np.finfo(np.float64).tiny)
    change = level_change(sizes[0], sizes[1], floor)
    pairs = zip(np.array_split(one, _QUARTERS), np.array_split(one - twice, _QUARTERS), strict=True)
    apart = [np.std(d, axis=0) / np.maximum(np.std(signal, axis=0), floor) for signal, d in pairs]
    by_level = np.where(np.max(apart[1:], axis=0) > APART, change, change / _LIMIT)
    growing = apart[-1] > GROWING * apart[1]
    by_distance = 20.0 * np.log10(1.0 + apart[-1] / _LIMIT)
    return *sizes, by_level, np.where(growing, np.maximum(by_level, by_distance), by_level), growing


def _chosen(record: Recording, step: float, rows: int, highest: float) -> list[tuple[Mark, FloatArray]]:
    """Marks from which the loudest part of each stretch is made again, with the signals there."""
    begins = {round(mark.time / step): mark for mark in record.marks}
    fitting = [first for first in begins if first + rows < record.signal_time.size]
    fitting = [first for first in fitting if first >= SWINGING_IN * record.signal_time.size] or fitting
    seen = [up_to(record.signals[first : first + rows + 1], step, highest) for first in fitting]
    sizes = np.array([np.std(part, axis=0) for part in seen])
    largest = sizes.max(axis=0)
    # Each sensor counts alike.
    loudness = (sizes / np.maximum(largest, np.finfo(np.float64).tiny)).sum(axis=1)
    count = min(PARTS, len(fitting), max(record.signal_time.size // (5 * rows), 1))
    stretches = np.array_split(np.arange(len(fitting)), count)
    places = [int(stretch[np.argmax(loudness[stretch])]) for stretch in stretches]
    return [(begins[fitting[place]], seen[place]) for place in places]
