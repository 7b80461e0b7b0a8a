"""Courses prescribed over time: the factor of a load, and the speed with its angle."""

from __future__ import annotations

import bisect
import math
from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

import numpy as np

from ehdmaps.errors import InputError, Problems


class LoadProfile(Protocol):
    """Factor of a load over time."""

    def __call__(self, time: float) -> float:
        """Factor at a time [s]."""
        ...


@dataclass(frozen=True)
class Constant:
    """The whole load at all times."""

    def __call__(self, time: float) -> float:
        """One."""
        return 1.0


@dataclass(frozen=True)
class Harmonic:
    """sin(2 pi frequency time + phase); frequency [Hz], phase [rad]."""

    frequency: float
    phase: float = 0.0

    def __call__(self, time: float) -> float:
        """Factor at a time [s]."""
        return math.sin(2.0 * math.pi * self.frequency * time + self.phase)


@dataclass(frozen=True)
class HalfSine:
    """The half-sine of a blow: it begins at a time and lasts a duration, both [s]; zero before and after."""

    begin: float
    duration: float

    def __call__(self, time: float) -> float:
        """Factor at a time [s]."""
        part = (time - self.begin) / self.duration
        return math.sin(math.pi * part) if 0.0 < part < 1.0 else 0.0


@dataclass(frozen=True)
class Advanced:
    """A profile from a later time on.

    Attributes
    ----------
    profile : LoadProfile
        The profile.
    time : float
        Time of that profile at time zero [s].
    """

    profile: LoadProfile
    time: float

    def __call__(self, time: float) -> float:
        """Factor at a time [s]."""
        return self.profile(self.time + time)


@dataclass(frozen=True)
class Course:
    """Straight lines between given values; the first and the last value hold before and after.

    Attributes
    ----------
    times : tuple of float
        Rising [s]. The same time twice makes a jump, at which the later value holds.
    values : tuple of float
        Factors, or speeds [rad/s], as many.

    Raises
    ------
    InputError
        If times and values make no course.
    """

    times: tuple[float, ...]
    values: tuple[float, ...]

    def __post_init__(self) -> None:
        if len(self.times) != len(self.values) or not self.times:
            raise InputError(
                f"course: got {len(self.times)} times and {len(self.values)} values; allowed: as many of each, at "
                "least one"
            )
        problems = Problems()
        thrice = any(first == third for first, third in zip(self.times, self.times[2:], strict=False))
        if not np.all(np.isfinite(self.times)) or np.any(np.diff(self.times) < 0.0) or thrice:
            problems.append(
                f"course, times: got {self.times!r:.80}; allowed: finite and rising, the same one twice for a jump"
            )
        if not np.all(np.isfinite(self.values)):
            problems.append(f"course, values: got {self.values!r:.80}; allowed: finite")
        problems.check()

    @property
    def jumps(self) -> bool:
        """True where it has two values at one time."""
        return bool(np.any(np.diff(self.times) == 0.0))

    def __call__(self, time: float) -> float:
        """Value at a time [s]."""
        index = bisect.bisect_right(self.times, time) - 1
        if index < 0 or index + 1 == len(self.times):
            return self.values[max(index, 0)]
        part = (time - self.times[index]) / (self.times[index + 1] - self.times[index])
        return self.values[index] + part * (self.values[index + 1] - self.values[index])


class Speed(Protocol):
    """Speed of a system over time."""

    def at(self, time: float) -> tuple[float, float]:
        """Speed [rad/s] and angle [rad] at a time >= 0 [s]."""
        ...

    def rate(self, time: float) -> float:
        """Rate at which the speed rises at a time >= 0 [rad/s2]."""
        ...


@dataclass(frozen=True)
class SpeedProfile:
    """Prescribed speed of the system over time, and the angle turned since time zero.

    Attributes
    ----------
    course : Course
        Speed [rad/s] over time, either way round; the first time is 0.

    Raises
    ------
    InputError
        For another first time, and for a speed that jumps.
    """

    course: Course

    def __post_init__(self) -> None:
        if self.course.times[0] != 0.0:
            raise InputError(f"speed, times: got {self.course.times[0]!r} s as the first; allowed: 0 s")
        if self.course.jumps:
            raise InputError(
                f"speed, times: got {self.course.times!r:.80}, of which two are the same; allowed: rising, as no shaft "
                "changes its speed in no time"
            )

    @cached_property
    def _angles(self) -> tuple[float, ...]:
        """Angle at each time of the course [rad]."""
        times, speeds = self.course.times, self.course.values
        angles = [0.0]
        for i in range(len(times) - 1):
            angles.append(angles[-1] + 0.5 * (speeds[i] + speeds[i + 1]) * (times[i + 1] - times[i]))
        return tuple(angles)

    @classmethod
    def constant(cls, speed: float) -> SpeedProfile:
        """The same speed [rad/s] at all times."""
        return cls(Course((0.0,), (speed,)))

    @classmethod
    def ramp(cls, begin: float, end: float, duration: float) -> SpeedProfile:
        """From one speed to another [rad/s] within a duration [s], then held.

        Parameters
        ----------
        begin : float
            First speed [rad/s].
        end : float
            Last speed [rad/s].
        duration : float
            [s].
        """
        return cls(Course((0.0, duration), (begin, end)))

    def part(self, begin: float, end: float) -> SpeedProfile:
        """The speed between two times, as a profile that begins at time and angle zero.

        Parameters
        ----------
        begin, end : float
            Times of this profile [s], 0 <= begin < end.
        """
        inner = [time for time in self.course.times if begin < time < end]
        times = [begin, *inner, end]
        return SpeedProfile(Course(tuple(time - begin for time in times), tuple(self.course(time) for time in times)))

    def at(self, time: float) -> tuple[float, float]:
        """Speed [rad/s] and angle [rad] at a time >= 0 [s]."""
        times, speeds = self.course.times, self.course.values
        index = max(bisect.bisect_right(times, time) - 1, 0)
        speed = self.course(time)
        return speed, self._angles[index] + 0.5 * (speeds[index] + speed) * (time - times[index])

    def rate(self, time: float) -> float:
        """Rate at which the speed rises at a time >= 0 [rad/s2]; at a corner, from there on."""
        times, speeds = self.course.times, self.course.values
        index = max(bisect.bisect_right(times, time) - 1, 0)
        if index + 1 == len(times):
            return 0.0
        return (speeds[index + 1] - speeds[index]) / (times[index + 1] - times[index])
