"""One signal of a run at equal times, with speed and angle: what spectra over speed and orders are made from."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import InputError, Problems
from ehdmaps.units import written

RPM = 30.0 / np.pi

_FEWEST = 64
_LARGEST = 1e100
"""Squares of larger numbers, and their sums, would be infinite."""

_SAME_STEP = 1e-6
_SAME_ANGLE = 0.01
_HELD = 1e-12
_LEAST_CHANGE = 1e-3


@dataclass(frozen=True, eq=False)
class RunSignal:
    """A signal over time, and how far and fast the system had turned.

    A system that turns backwards counts as one that turns forwards: orders have no sign.

    Attributes
    ----------
    time : array, shape (samples,)
        Times of the samples, equally spaced [s].
    speed, angle : array, shape (samples,)
        Speed of the system [rad/s] and angle turned [rad]; angle is the integral of speed.
    signal : array, shape (samples,)
        The signal, in any unit.

    Raises
    ------
    InputError
        With every problem: shapes, values that are not finite, unequal steps, a rotation that reverses, an angle that
        does not belong to the speed.
    """

    time: FloatArray
    speed: FloatArray
    angle: FloatArray
    signal: FloatArray

    def __post_init__(self) -> None:
        problems = Problems()
        for name in ("time", "speed", "angle", "signal"):
            try:
                values = np.ascontiguousarray(getattr(self, name), dtype=np.float64)
            except (TypeError, ValueError):
                problems.append(f"run signal, {name}: got no array of real numbers; allowed: shape (samples,)")
                continue
            object.__setattr__(self, name, values)
            if values.ndim != 1 or values.size < _FEWEST:
                problems.append(
                    f"run signal, {name}: got shape {values.shape}; allowed: (samples,) with at least {_FEWEST}; "
                    "record for longer or in smaller steps"
                )
            elif not np.all(np.abs(values) <= _LARGEST):
                bad = int(np.argmin(np.abs(values) <= _LARGEST))
                problems.append(
                    f"run signal, {name}: got {values[bad]} at sample {bad}; allowed: finite, up to {_LARGEST:g}"
                )
            elif values.shape != np.shape(self.time):
                problems.append(f"run signal, {name}: got {values.size} samples; allowed: as many as times")
        problems += [] if problems else self._course_problems()
        problems.check()
        if self.speed.sum() < 0.0:
            object.__setattr__(self, "speed", -self.speed)
            object.__setattr__(self, "angle", -self.angle)

    def _course_problems(self) -> list[str]:
        """Problems with times, speed and angle, of right shapes."""
        problems = []
        steps = np.diff(self.time)
        mean = float(self.time[-1] - self.time[0]) / steps.size
        if not mean > 0.0 or float(np.max(np.abs(steps - mean))) > _SAME_STEP * mean:
            problems.append(
                f"run signal, time: got steps of {steps.min():.6g} to {steps.max():.6g} s; allowed: equal and > 0; "
                "interpolate the record at equal times"
            )
        if np.min(self.speed) < 0.0 < np.max(self.speed):
            problems.append(
                f"run signal, speed: got {written(self.speed.min() * RPM)} to "
                f"{written(self.speed.max() * RPM)} rpm, a rotation "
                "that reverses; allowed: one direction; cut the record where the speed is zero"
            )
        if problems:
            return problems
        turned = np.concatenate([[0.0], np.cumsum(0.5 * (self.speed[1:] + self.speed[:-1]) * steps)])
        error = float(np.max(np.abs(self.angle - self.angle[0] - turned)))
        if error > _SAME_ANGLE * float(np.max(np.abs(turned))):
            problems.append(
                f"run signal, angle: got {self.angle[-1] - self.angle[0]:.6g} rad turned where the speed turns "
                f"{turned[-1]:.6g} rad; allowed: the integral of the speed within {100 * _SAME_ANGLE:g} %; check rad "
                "and rad/s against turns and rpm"
            )
        return problems

    @property
    def rate(self) -> float:
        """Samples per second [Hz]."""
        return (self.time.size - 1) / float(self.time[-1] - self.time[0])

    @property
    def duration(self) -> float:
        """From the first sample to the last [s]."""
        return float(self.time[-1] - self.time[0])

    def part(self, begin: int, end: int) -> RunSignal:
        """The samples from `begin` up to, not including, `end`."""
        here = slice(begin, end)
        return RunSignal(self.time[here], self.speed[here], self.angle[here], self.signal[here])

    def ramp(self) -> RunSignal:
        """The part in which the speed changes, without held speeds at the beginning and at the end.

        Raises
        ------
        InputError
            If the speed is constant, turns round or is held in between: then no speed stands for one time.
        """
        change = np.diff(self.speed)
        top = float(np.max(self.speed))
        moving = np.flatnonzero(np.abs(change) > _HELD * top)
        if moving.size == 0 or abs(self.speed[-1] - self.speed[0]) < _LEAST_CHANGE * top:
            raise InputError(
                f"run, speed: got {written(self.speed[0] * RPM)} to {written(self.speed[-1] * RPM)} rpm with at most "
                f"{written(top * RPM)} rpm; allowed: a ramp from one speed to another; at constant "
                "speed use `mbs lsa`, or "
                "order spectra of the record"
            )
        begin, end = int(moving[0]), int(moving[-1]) + 1
        within = change[begin:end]
        direction = np.sign(self.speed[end] - self.speed[begin])
        wrong = np.flatnonzero(within * direction <= _HELD * top)
        if wrong.size:
            at = begin + int(wrong[0])
            raise InputError(
                f"run, speed: is held or turns round at {self.time[at]:.6g} s and {written(self.speed[at] * RPM)} rpm; "
                "allowed: a ramp that only rises or only falls; cut the record into such ramps"
            )
        return self.part(begin, end + 1)
