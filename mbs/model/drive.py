"""Speed by torques: the spin of a system as a freedom with inertia, under motor and load torques over speed.

    J w' = motor(w) - sign(w) load(|w|) - what the moving system takes

The motor drives forwards or, with a torque below zero, backwards. The load resists either way. At rest it holds the
shaft up to its torque there.
All torques and J are those on the shaft that turns with the speed of the system. What the system takes is the power of
its turning loads and of the turning of its cages, tables and gears, over the speed: it is known after some steps, and
its mean over them acts in the next ones, so that energy is kept with that delay.
"""

from __future__ import annotations

import bisect
import math
from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np

from ehdmaps.errors import InputError, Problems
from mbs.model.profiles import Course, SpeedProfile

LONGEST_STEP = 1e-4
"""Longest step in which the speed is integrated [s]."""

FOLLOWED, FEWEST = 2e-3, 20
"""Time after which the torque that the moving system takes is found anew [s], and fewest steps of a run in it."""

SLOWEST = 1e-3
"""Angle of a turn over which power becomes a torque [rad]; below it the torque before holds. At rest there is none."""

_POINTS = 4000


@dataclass(frozen=True)
class TorqueCurve:
    """A torque over speed: straight lines between given values, the first and the last of which hold beyond.

    Attributes
    ----------
    speeds : tuple of float
        Rising [rad/s].
    torques : tuple of float
        Torque at each [N m].

    Raises
    ------
    InputError
        If they make no course, or one that jumps.
    """

    speeds: tuple[float, ...]
    torques: tuple[float, ...]
    _course: Course = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        course = Course(self.speeds, self.torques)
        if course.jumps:
            raise InputError(f"torque, speeds: got {self.speeds!r:.80}; allowed: each above the last")
        object.__setattr__(self, "_course", course)

    @classmethod
    def constant(cls, torque: float) -> TorqueCurve:
        """The same torque [N m] at any speed."""
        return cls((0.0,), (torque,))

    def __call__(self, speed: float) -> float:
        """Torque [N m] at a speed [rad/s]."""
        return self._course(speed)


@dataclass(frozen=True)
class Drive:
    """Motor that turns a system, and load that resists.

    Attributes
    ----------
    inertia : float
        Moment of inertia of all that turns, on the shaft with the speed of the system [kg m2], > 0.
    motor : TorqueCurve
        Torque that drives, over the speed with its sign [N m]; below zero it drives backwards.
    load : TorqueCurve
        Torque that resists turning, over the speed without its sign [N m].
    motor_until : float
        Time at which the motor is switched off [s].

    Raises
    ------
    InputError
        For an inertia that no body has, or a time that is not positive.
    """

    inertia: float
    motor: TorqueCurve
    load: TorqueCurve
    motor_until: float = math.inf

    def __post_init__(self) -> None:
        problems = Problems()
        if not (math.isfinite(self.inertia) and self.inertia > 0.0):
            problems.append(f"drive, inertia: got {self.inertia!r} kg m2; allowed: finite and > 0")
        if not self.motor_until > 0.0:
            problems.append(f"drive, motor_until: got {self.motor_until!r} s; allowed: > 0")
        problems.check()

    def rate(self, time: float, speed: float, taken: float = 0.0) -> float:
        """Rate at which the speed rises [rad/s2]; a load brings to rest, and does not turn back.

        Parameters
        ----------
        time : float
            [s].
        speed : float
            [rad/s].
        taken : float
            Torque that the moving system takes [N m].
        """
        towards = self.towards(time, speed, taken)
        return self._rate(time, speed, taken, towards) if towards else 0.0

    def towards(self, time: float, speed: float, taken: float = 0.0) -> float:
        """Direction in which the shaft turns, or sets off from rest: 1, -1, or 0 where it stays at rest.

        Parameters
        ----------
        time : float
            [s].
        speed : float
            [rad/s].
        taken : float
            Torque that the moving system takes, which the motor has to overcome as well [N m].
        """
        if speed != 0.0:
            return math.copysign(1.0, speed)
        motor = self._driving(time, speed)
        return math.copysign(1.0, motor) if abs(motor) > self.load(0.0) + abs(taken) else 0.0

    def _driving(self, time: float, speed: float) -> float:
        """Torque of the motor [N m], as long as it is on."""
        return self.motor(speed) if time < self.motor_until else 0.0

    def _rate(self, time: float, speed: float, taken: float, towards: float) -> float:
        """Rate while the shaft turns in a direction."""
        return (self._driving(time, speed) - towards * self.load(towards * speed) - taken) / self.inertia

    def after(self, time: float, speed: float, taken: float, h: float, towards: float) -> tuple[float, float]:
        """Speed after a step [rad/s] and angle turned in it [rad], by Runge and Kutta's rule of fourth order.

        Parameters
        ----------
        time : float
            Time at which the step begins [s].
        speed : float
            Speed there [rad/s].
        taken : float
            Torque that the moving system takes [N m].
        h : float
            Length of the step [s].
        towards : float
            Direction in which the load is overcome all through the step, 1 or -1.
        """
        k1 = self._rate(time, speed, taken, towards)
        k2 = self._rate(time, speed + 0.5 * h * k1, taken, towards)
        k3 = self._rate(time, speed + 0.5 * h * k2, taken, towards)
        k4 = self._rate(time, speed + h * k3, taken, towards)
        return speed + h * (k1 + 2.0 * k2 + 2.0 * k3 + k4) / 6.0, h * speed + h * h * (k1 + k2 + k3) / 6.0


@dataclass(frozen=True)
class DrivenSpeed(SpeedProfile):
    """The speed that a drive makes.

    The course is that of the torques alone. A run `started` from it also has what the moving system takes.

    Attributes
    ----------
    drive : Drive
        What turns the system.
    """

    drive: Drive = field(kw_only=True)

    @classmethod
    def of(cls, drive: Drive, begin: float, duration: float) -> DrivenSpeed:
        """The speed from a first one on.

        Parameters
        ----------
        drive : Drive
            What turns the system.
        begin : float
            First speed [rad/s], either way round.
        duration : float
            How long [s].
        """
        run = DrivenRun(drive, begin)
        times = np.linspace(0.0, duration, _POINTS).tolist()
        return cls(Course(tuple(times), tuple(run.at(time)[0] for time in times)), drive=drive)

    def started(self) -> DrivenRun:
        """The same drive at the beginning of a run."""
        return DrivenRun(self.drive, self.course.values[0])


@dataclass(frozen=True)
class DriveAccount:
    """Energies of a drive over a run [J].

    Attributes
    ----------
    motor, load : float
        Work of the motor, and what the load took.
    taken : float
        What the moving system took from the shaft.
    stored : float
        Change of the kinetic energy of turning.
    """

    motor: float
    load: float
    taken: float
    stored: float

    @property
    def residual(self) -> float:
        """Residual of the balance [J]: what is taken is known a little later than it acts."""
        return self.motor - self.load - self.taken - self.stored


class DrivenRun:
    """The speed of a run, as far as it is known; it goes on under the torque that the system took last.

    Parameters
    ----------
    drive : Drive
        What turns the system.
    begin : float
        First speed [rad/s].
    """

    def __init__(self, drive: Drive, begin: float) -> None:
        self._drive = drive
        self._torque = 0.0
        self._times, self._knots = [0.0], [(begin, 0.0, drive.rate(0.0, begin))]
        self._motor = self._load = self._taken = 0.0
        self._settled = 0.0

    def at(self, time: float) -> tuple[float, float]:
        """Speed [rad/s] and angle [rad] at a time >= 0 [s]."""
        self._reach(time)
        return self._between(time)

    def rate(self, time: float) -> float:
        """Rate at which the speed rises at a time >= 0 [rad/s2]."""
        self._reach(time)
        index = max(bisect.bisect_right(self._times, time) - 1, 0)
        if index + 1 == len(self._times):
            return self._knots[index][2]
        part = (time - self._times[index]) / (self._times[index + 1] - self._times[index])
        return self._knots[index][2] + part * (self._knots[index + 1][2] - self._knots[index][2])

    def settle(self, time: float, taken: float) -> None:
        """Go on from a time that the run has reached, with the mean torque of what was taken since the last one.

        Parameters
        ----------
        time : float
            Time that was reached [s].
        taken : float
            What the moving system took from the shaft since then [J].
        """
        speed, angle = self.at(time)
        self._account(time)
        turned = angle - self._between(self._settled)[1]
        if abs(turned) > SLOWEST:
            self._torque = taken / turned
        elif speed == 0.0:
            self._torque = 0.0
        self._taken += taken
        self._settled = time
        keep = bisect.bisect_left(self._times, time)
        del self._times[keep:], self._knots[keep:]
        self._times.append(time)
        self._knots.append((speed, angle, self._drive.rate(time, speed, self._torque)))

    def account(self) -> DriveAccount:
        """Energies up to the last time that was settled."""
        first, last = self._knots[0][0], self._between(self._settled)[0]
        stored = 0.5 * self._drive.inertia * (last**2 - first**2)
        return DriveAccount(self._motor, self._load, self._taken, stored)

    def _between(self, time: float) -> tuple[float, float]:
        """Speed and angle between two knots, by cubics."""
        times, knots = self._times, self._knots
        index = max(bisect.bisect_right(times, time) - 1, 0)
        if index + 1 == len(times):
            return knots[index][0], knots[index][1]
        h = times[index + 1] - times[index]
        x = (time - times[index]) / h
        (w0, a0, r0), (w1, a1, r1) = knots[index], knots[index + 1]
        both = 3.0 * x * x - 2.0 * x**3
        first, last = x * (1.0 - x) ** 2 * h, x * x * (x - 1.0) * h
        return (
            w0 + both * (w1 - w0) + first * r0 + last * r1,
            a0 + both * (a1 - a0) + first * w0 + last * w1,
        )

    def _reach(self, time: float) -> None:
        """Integrate up to a time, by Runge and Kutta's rule of fourth order."""
        drive, taken = self._drive, self._torque
        while self._times[-1] < time:
            here, (w, angle, _) = self._times[-1], self._knots[-1]
            there = here + LONGEST_STEP
            # Not over the end of the motor.
            if here < drive.motor_until < there:
                there = drive.motor_until
            h = there - here
            inside = min(here, math.nextafter(there, here))
            towards = drive.towards(inside, w, taken)
            after, turned = drive.after(inside, w, taken, h, towards) if towards else (0.0, 0.0)
            if towards * after < 0.0:
                # Up to rest and no further: from there on it may stay, or turn the other way.
                if w != 0.0:
                    h *= w / (w - after)
                    there = max(here + h, math.nextafter(here, math.inf))
                after, turned = 0.0, drive.after(inside, w, taken, h, towards)[1] if w != 0.0 else 0.0
            self._times.append(there)
            self._knots.append((after, angle + turned, drive.rate(there, after, taken)))

    def _account(self, time: float) -> None:
        """Add the work of motor and load up to a time, by Simpson's rule between knots."""
        begin = bisect.bisect_right(self._times, self._settled) - 1
        ends = [self._settled, *(t for t in self._times[begin + 1 :] if t < time), time]
        for first, last in pairwise(ends):
            h = last - first
            if h <= 0.0:
                continue
            for part, weight in ((0.0, 1.0), (0.5, 4.0), (1.0, 1.0)):
                w = self._between(first + part * h)[0]
                running = 0.5 * (first + last) < self._drive.motor_until
                self._motor += weight * h / 6.0 * w * (self._drive.motor(w) if running else 0.0)
                self._load += weight * h / 6.0 * abs(w) * self._drive.load(abs(w))
