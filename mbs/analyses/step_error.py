"""Error of the signals of a run by its step, estimated by parts of it that are made again with half the step.

What steps resolve cannot be told from frequencies alone: contacts lift off, films fade, speeds rise. So two parts of a
run are made again, from the state that it had there, films included, with half of its step: the one where it is
loudest, and the fastest one. The first quarter of a part is left out, in which films take another step; not so where
the run itself begins. The larger error of both parts is stated, for each sensor.

Where both signals have come apart as far as they will, their levels tell the error: a method of second order that
changes by d is 4/3 d away from its limit. Where they still come apart at the end of the part, as with little damping,
their levels are yet those of their common start, and the distance of the signals themselves in the last quarter says by
how much levels may differ; such errors are told as "up to". A run that does not forget its start may be farther off.
Levels that are more than 20 dB below the loudest ones count as these 20 dB.
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
from mbs.transient.run import Options, Recording
from mbs.transient.run import run as run_system
from mbs.transient.stepping import Mark

PART = 0.025
"""Part of a run that each of the parts is: with half the step both cost a tenth of it."""

FEWEST = 200
"""Fewest steps of a part, for short runs."""

NOTABLE = 1.0
"""Estimated error of a level from which on it is warned of [dB]."""

QUIET = 0.1
"""Part of the largest root mean square of a sensor below which levels are not judged."""

GROWING = 1.2
"""Distance of both signals in the last quarter beside that in the second one, from which on it still grows."""

_LIMIT = 4.0 / 3.0
_QUARTERS = 4


@dataclass(frozen=True, eq=False)
class StepCheck:
    """Signals of parts of a run with its step and with half of it.

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
    with_step, with_half : array, shape (parts, sensors)
        Root mean square of each signal about its mean.
    errors : array, shape (parts, sensors)
        Estimated error of each level [dB].
    growing : array of bool, shape (parts, sensors)
        Whether the signals still come apart at the end of the part, so that the error is that of their distance.
    """

    duration: float
    step: float
    speeds: tuple[tuple[float, float], ...]
    names: tuple[str, ...]
    units: tuple[str, ...]
    with_step: FloatArray
    with_half: FloatArray
    errors: FloatArray
    growing: BoolArray

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
        parts = " and ".join(
            f"{RPM.value(abs(first)):.4g} to {RPM.text(abs(last))}" for first, last in dict.fromkeys(self.speeds)
        )
        how = f"by half of it over {MILLISECOND.text(self.duration)} at {parts}"
        step = MICROSECOND.text(self.step)
        if self.converged:
            each = ", ".join(f"{name} {self._size(k)}" for k, name in enumerate(self.names))
            return [f"estimated error of the step of {step}: {each}; {how}{self._growth}"]
        wrong, sure = [], False
        for k in np.flatnonzero(self.largest > NOTABLE).tolist():
            at = int(np.argmax(self.errors[:, k]))
            sure = sure or not self.growing[at, k]
            wrong.append(
                f"{self.names[k]} {self._size(k)} off, {self.with_step[at, k]:.3g} {self.units[k]} rms and "
                f"{self.with_half[at, k]:.3g} with half the step"
            )
        is_not = "is not" if sure else "may not be"
        return [
            f"warning: this run {is_not} converged with steps of {step}: {'; '.join(wrong)}; estimated {how}"
            f"{self._growth}; take shorter steps in [runup], or --tolerance"
        ]

    def _size(self, sensor: int) -> str:
        """The error of a sensor in words."""
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
        None without sensors and without marks, with steps that adapt to a tolerance, and where half the step finds no
        solution.
    """
    sensors, settings = model.scene.sensors, course.settings
    if not sensors or not record.marks or math.isfinite(settings.tolerance):
        return None
    step, total = settings.step, record.signal_time.size - 1
    rows = min(max(round(PART * total), FEWEST), total)
    speed = course.speed
    if isinstance(speed, DrivenSpeed):
        # As it was: a drive would have to be started anew.
        speed = SpeedProfile(Course(tuple(record.time.tolist()), tuple(record.speed.tolist())))
    finer = dataclasses.replace(settings, step=0.5 * step, sample=step)
    speeds, found = [], []
    chosen, largest = _chosen(record, step, rows, highest)
    for mark, seen in chosen:
        try:
            half = run_system(
                model.system,
                speed,
                rows * step,
                finer,
                sensors=sensors,
                options=Options(every_step=True),
                begin=mark.stepped(0.5),
            ).signals
        except EhdmapsError:
            return None
        begins = mark is record.marks[0]
        found.append(_compared(seen, up_to(half, 0.5 * step, highest)[::2], QUIET * largest, begins))
        first = round(mark.time / step)
        speeds.append((float(record.signal_speed[first]), float(record.signal_speed[first + rows])))
    names, units = tuple(sensor.name for sensor in sensors), tuple(Reference.of(sensor).unit for sensor in sensors)
    with_step, with_half, errors, growing = (np.array(values) for values in zip(*found, strict=True))
    return StepCheck(rows * step, step, tuple(speeds), names, units, with_step, with_half, errors, growing)


def up_to(signals: FloatArray, step: float, highest: float) -> FloatArray:
    """Signals without what lies above a frequency.

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
    >>> np.std(up_to(both[:, None], 1e-4, 1000.0), axis=0).round(3)
    array([0.707])
    """
    count = signals.shape[0]
    if highest >= 0.5 / step:
        return signals
    lines = np.fft.rfft(signals, axis=0)
    lines[np.fft.rfftfreq(count, step) > highest] = 0.0
    return np.asarray(np.fft.irfft(lines, count, axis=0))


def _compared(
    one: FloatArray, half: FloatArray, floor: FloatArray, begins: bool
) -> tuple[FloatArray, FloatArray, FloatArray, BoolArray]:
    """Sizes of two signals, error of the level of the first one [dB], whether it grows; shape (sensors,) each."""
    late = slice(0 if begins else one.shape[0] // _QUARTERS, None)
    sizes = [np.std(signal[late], axis=0) for signal in (one, half)]
    floor = np.maximum(floor, np.finfo(np.float64).tiny)
    by_level = _LIMIT * np.abs(20.0 * np.log10(np.maximum(sizes[0], floor) / np.maximum(sizes[1], floor)))
    pairs = zip(np.array_split(one, _QUARTERS), np.array_split(one - half, _QUARTERS), strict=True)
    apart = [np.std(d, axis=0) / np.maximum(np.std(signal, axis=0), floor) for signal, d in pairs]
    growing = apart[-1] > GROWING * apart[1]
    by_distance = 20.0 * np.log10(1.0 + _LIMIT * apart[-1])
    return sizes[0], sizes[1], np.where(growing, np.maximum(by_level, by_distance), by_level), growing


def _chosen(
    record: Recording, step: float, rows: int, highest: float
) -> tuple[list[tuple[Mark, FloatArray]], FloatArray]:
    """Marks from which the loudest and the fastest part are made again, with the signals there; the largest sizes."""
    begins = {round(mark.time / step): mark for mark in record.marks}
    fitting = [first for first in begins if first + rows < record.signal_time.size]
    seen = [up_to(record.signals[first : first + rows + 1], step, highest) for first in fitting]
    sizes = np.array([np.std(part, axis=0) for part in seen])
    largest = sizes.max(axis=0)
    # Each sensor counts alike.
    loudness = (sizes / np.maximum(largest, np.finfo(np.float64).tiny)).sum(axis=1)
    speeds = np.abs([record.signal_speed[first + rows] for first in fitting])
    places = dict.fromkeys((int(np.argmax(loudness)), int(np.argmax(speeds))))
    return [(begins[fitting[place]], seen[place]) for place in places], largest
