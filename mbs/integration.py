"""Time integration: the generalised-alpha method with the exact Jacobian.

In the form that keeps the equations of motion fulfilled at the end of every step, so that it is of second order for
nonlinear forces too, and becomes the trapezoidal rule for a spectral radius of 1.

References
----------
J. Chung, G. M. Hulbert, J. Appl. Mech. 60 (1993) 371-375 (the parameters); M. Arnold, O. Bruels, Multibody Syst.
Dyn. 18 (2007) 185-202 (equilibrium at the end of the step); O. C. Zienkiewicz, Y. M. Xie, Earthquake Eng. Struct.
Dyn. 20 (1991) 871-887 (the estimate of the error).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ehdmaps.errors import InputError
from ehdmaps.physics._values import FloatArray
from mbs.elements import Operation
from mbs.errors import AnalysisError
from mbs.integration_kernel import correction, port_motion, unbalanced
from mbs.profiles import SpeedProfile
from mbs.system import System

_ITERATIONS = 12
_HALVINGS = 10
"""How often a step is halved at most, where Newton or the error estimate asks for it."""


@dataclass(frozen=True)
class Settings:
    """How to integrate.

    Attributes
    ----------
    step : float
        Longest time step [s].
    sample : float
        Time between recorded states [s]; a whole multiple of the step.
    spectral_radius : float
        Of the highest frequencies, 0 to 1: 1 dissipates nothing, 0 all of it within a step.
    tolerance : float
        Largest error a step may make in a coordinate [m or rad], by estimate; steps are halved where it is larger.
        Infinite: steps are equal.
    residual : float
        Remaining force after Newton, as a part of the forces in the system.

    Raises
    ------
    InputError
        With every value that is not possible.
    """

    step: float
    sample: float
    spectral_radius: float = 0.8
    tolerance: float = math.inf
    residual: float = 1e-10

    def __post_init__(self) -> None:
        problems = []
        if not (math.isfinite(self.step) and self.step > 0.0):
            problems.append(f"integration, step: got {self.step!r} s; allowed: finite and > 0")
        elif not (math.isfinite(self.sample) and _whole(self.sample / self.step)):
            problems.append(
                f"integration, sample: got {self.sample!r} s; allowed: a whole multiple of the step {self.step!r} s"
            )
        if not 0.0 <= self.spectral_radius <= 1.0:
            problems.append(f"integration, spectral_radius: got {self.spectral_radius!r}; allowed: 0 to 1")
        if not self.tolerance > 0.0:
            problems.append(f"integration, tolerance: got {self.tolerance!r}; allowed: > 0 (m or rad)")
        if not 0.0 < self.residual < 1.0:
            problems.append(f"integration, residual: got {self.residual!r}; allowed: between 0 and 1")
        if problems:
            raise InputError(problems)


@dataclass(frozen=True, eq=False)
class Trajectory:
    """Recorded states of a run.

    Attributes
    ----------
    time, speed, angle : array, shape (samples,)
        [s], [rad/s], [rad].
    displacement, velocity, acceleration : array, shape (samples, n)
        Of the coordinates [m or rad, per s, per s2].
    forces : tuple of array, shape (samples, m)
        Of each element in its ports [N or N m].
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
) -> Trajectory:
    """Integrate a system in time.

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
        At time zero; zero if left out.
    progress : callable, optional
        Told the number of samples done, after each.

    Raises
    ------
    AnalysisError
        If a step finds no solution although it was halved ten times.
    """
    samples = math.ceil(duration / settings.sample - 1e-9)
    run = _Run(system, speed, settings, displacement, velocity)
    times = np.asarray(np.arange(samples + 1) * settings.sample, dtype=np.float64)
    states = np.empty((3, samples + 1, system.size))
    forces = tuple(np.empty((samples + 1, connected.transform.shape[0])) for connected in system.elements)
    for index in range(samples + 1):
        if index:
            run.advance(index)
        states[:, index] = run.q, run.v, run.acceleration
        for record, force in zip(forces, run.forces, strict=True):
            record[index] = force
        if progress and index:
            progress(index)
    courses = np.array([speed.at(time) for time in times])
    q, v, a = states
    return Trajectory(
        np.asarray(times, dtype=np.float64),
        courses[:, 0],
        courses[:, 1],
        q,
        v,
        a,
        forces,
        run.steps,
        run.halved,
        run.iterations,
    )


class _Run:
    """State of a run, and how it goes on to the next sample."""

    def __init__(
        self,
        system: System,
        speed: SpeedProfile,
        settings: Settings,
        displacement: FloatArray | None,
        velocity: FloatArray | None,
    ) -> None:
        self._system, self._speed, self._settings = system, speed, settings
        ends = np.cumsum([0, *(connected.transform.shape[0] for connected in system.elements)]).tolist()
        self._elements = [
            (connected.element.evaluate, slice(begin, end))
            for connected, begin, end in zip(system.elements, ends[:-1], ends[1:], strict=True)
        ]
        self._transform = np.concatenate([np.zeros((0, system.size)), *(c.transform for c in system.elements)])
        ports = ends[-1]
        self._motion, self._port_force, self._unbalanced = np.zeros((2, ports)), np.zeros(ports), np.zeros(system.size)
        self._port_stiffness, self._port_damping = np.zeros((ports, ports)), np.zeros((ports, ports))
        self._damping, self._damped_at = system.damping, math.nan
        self._linear, self._linear_steps = system.mass, (math.nan, math.nan)
        self.q = np.zeros(system.size) if displacement is None else np.array(displacement, dtype=np.float64)
        self.v = np.zeros(system.size) if velocity is None else np.array(velocity, dtype=np.float64)
        self.steps = self.halved = self.iterations = 0
        self._per_sample = round(settings.sample / settings.step)
        self._level = 0
        rho = settings.spectral_radius
        self._alpha_m, self._alpha_f = (2.0 * rho - 1.0) / (rho + 1.0), rho / (rho + 1.0)
        self._gamma = 0.5 + self._alpha_f - self._alpha_m
        self._beta = 0.25 * (self._gamma + 0.5) ** 2
        self._weight = 1.0 / np.sqrt(np.diag(system.mass))
        self._residual(self.q, self.v, np.zeros(system.size), 0.0)
        self.acceleration = np.asarray(np.linalg.solve(system.mass, -self._unbalanced), dtype=np.float64)
        self._carried = self.acceleration.copy()

    def advance(self, sample: int) -> None:
        """Step from the sample before to this one."""
        finest = 1 << _HALVINGS
        ticks, end = 0, self._per_sample * finest
        begin = (sample - 1) * self._settings.sample
        tick = self._settings.step / finest
        while ticks < end:
            stride = finest >> self._level
            error = self._step(begin + (ticks + stride) * tick, stride * tick)
            if error > self._settings.tolerance or math.isinf(error):
                self.halved += 1
                self._level += 1
                if self._level > _HALVINGS:
                    raise AnalysisError(
                        f"time integration: no solution at {begin + ticks * tick:.6g} s with steps of {tick:.3g} s; "
                        "start nearer to an equilibrium, or check units and signs of the loads"
                    )
                continue
            ticks += stride
            self.steps += 1
            # The error goes with the third power of the step.
            if self._level and ticks % (2 * stride) == 0 and 8.0 * error < self._settings.tolerance:
                self._level -= 1

    def _step(self, time: float, h: float) -> float:
        """Make a step and return the estimate of its error; leave the state as it is where that is too large."""
        ratio = (1.0 - self._alpha_f) / (1.0 - self._alpha_m)
        by_q, by_v = h * h * self._beta * ratio, h * self._gamma * ratio
        # Algorithmic acceleration without the part of the unknown one.
        known = (self._alpha_f * self.acceleration - self._alpha_m * self._carried) / (1.0 - self._alpha_m)
        q0 = self.q + h * self.v + h * h * ((0.5 - self._beta) * self._carried + self._beta * known)
        v0 = self.v + h * ((1.0 - self._gamma) * self._carried + self._gamma * known)
        unknown = self.acceleration
        largest = 0.0
        for _ in range(_ITERATIONS):
            self.iterations += 1
            q, v = q0 + by_q * unknown, v0 + by_v * unknown
            size, scale = self._residual(q, v, unknown, time)
            largest = max(largest, scale)
            if size <= self._settings.residual * largest:
                break
            try:
                unknown = unknown - self._correction(by_q, by_v)
            except np.linalg.LinAlgError:
                return math.inf
        else:
            return math.inf
        error = abs(self._beta - 1.0 / 6.0) * h * h * float(np.max(np.abs(unknown - self.acceleration)))
        if error <= self._settings.tolerance:
            self.q, self.v = q, v
            self._carried = known + ratio * unknown
            self.acceleration = unknown
        return error

    def _residual(self, q: FloatArray, v: FloatArray, acceleration: FloatArray, time: float) -> tuple[float, float]:
        """Find the forces that are out of balance: their size, and that of those which balance each other."""
        system = self._system
        speed, angle = self._speed.at(time)
        operation = Operation(speed, angle, time)
        if speed != self._damped_at:
            self._damping, self._damped_at = system.damping + speed * system.gyroscopic, speed
            self._linear_steps = (math.nan, math.nan)
        port_motion(self._transform, q, v, self._motion)
        x, rate = self._motion
        for evaluate, rows in self._elements:
            f, k, c = evaluate(x[rows], rate[rows], operation)
            self._port_force[rows] = f
            self._port_stiffness[rows, rows] = k
            self._port_damping[rows, rows] = c
        matrices = (system.mass, self._damping, system.stiffness, self._transform, self._weight)
        state = (q, v, acceleration)
        sizes: tuple[float, float] = unbalanced(
            *matrices, state, system.loads(time), self._port_force, self._unbalanced
        )
        return sizes

    def _correction(self, by_q: float, by_v: float) -> FloatArray:
        """Newton's change of the acceleration at the end of the step, for the last residual."""
        if self._linear_steps != (by_q, by_v):
            system = self._system
            self._linear = system.mass + by_v * self._damping + by_q * system.stiffness
            self._linear_steps = (by_q, by_v)
        ports = (self._transform, self._port_stiffness, self._port_damping)
        change = np.asarray(correction(self._linear, *ports, by_q, by_v, self._unbalanced), dtype=np.float64)
        return change

    @property
    def forces(self) -> list[FloatArray]:
        """Force of each element in its ports at the last evaluation."""
        return [self._port_force[rows] for _, rows in self._elements]


def _whole(ratio: float) -> bool:
    """Whether a ratio is a whole number >= 1, to rounding."""
    return round(ratio) >= 1 and abs(ratio - round(ratio)) <= 1e-6 * ratio
