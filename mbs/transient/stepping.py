"""Steps in time by the generalised-alpha method with the exact Jacobian, and what it takes from an oscillation.

Steps in time: the generalised-alpha method with the exact Jacobian, for elements of any kind.

In the form that keeps the equations of motion fulfilled at the end of every step, so that it is of second order for
nonlinear forces too, and becomes the trapezoidal rule for a spectral radius of 1. This is the reference: it calls
each element as Python does. `mbs.transient.run` makes the same steps in compiled code, for the elements that it knows.

What the generalised-alpha method takes from an oscillation, and by how much it lengthens the period.

The method damps what its steps cannot resolve, by the spectral radius at infinite frequency, and a little of what they
do: an oscillation loses energy by the fourth power of its frequency times the cube of the step. Both follow exactly
from the largest eigenvalues of a step of an undamped oscillator.

References
----------
J. Chung, G. M. Hulbert, J. Appl. Mech. 60 (1993) 371-375 (the parameters); M. Arnold, O. Bruels, Multibody Syst.
Dyn. 18 (2007) 185-202 (equilibrium at the end of the step); O. C. Zienkiewicz, Y. M. Xie, Earthquake Eng. Struct.
Dyn. 20 (1991) 871-887 (the estimate of the error).
J. Chung, G. M. Hulbert, J. Appl. Mech. 60 (1993) 371-375. M. Arnold, O. Bruels, Multibody Syst. Dyn. 18 (2007) 185-202
(the form with forces in equilibrium at the end of each step).

The dense algebra of a time step, by the C library: for a dozen coordinates calling numpy costs more than computing.

`ehdmaps/kernel/c/dense.c` has the equations.
"""

from __future__ import annotations

import cmath
import ctypes
import dataclasses
import functools
import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.kernel.library import checked, function
from ehdmaps.kernel.record import Record, address, numbers
from mbs.model.elements import Operation
from mbs.model.profiles import Speed
from mbs.model.system import System
from mbs.settings import Settings
from mbs.transient.energy import Account, Instant

_DTYPE = np.dtype(np.float64)


class StepperData(Record):
    """Linear part and elements of steps in Python; arrays may be overwritten.

    Attributes
    ----------
    n, m : int
        Coordinates and ports.
    mass, damping, stiffness : array (n, n)
        Matrices of the linear part.
    linear : array (n, n)
        Jacobian without the elements.
    transform : array (m, n)
        Displacements of the ports by the coordinates.
    weight : array (n,)
        Makes forces and moments comparable.
    port_stiffness, port_damping : array (m, m)
        Those of the elements.
    room : array (n, n)
        Work space.
    """

    _fields_ = (
        ("n", ctypes.c_int64),
        ("m", ctypes.c_int64),
        *(
            (name, numbers)
            for name in (
                "mass", "damping", "stiffness", "linear", "transform", "weight", "port_stiffness", "port_damping",
                "room",
            )
        ),
    )  # fmt: skip
    shapes: ClassVar = {
        **dict.fromkeys(("mass", "damping", "stiffness", "linear", "room"), ("n", "n")),
        "transform": ("m", "n"),
        "weight": ("n",),
        "port_stiffness": ("m", "m"),
        "port_damping": ("m", "m"),
    }


@functools.cache
def _functions() -> tuple[Callable[..., Any], ...]:
    """Functions of the library: motion of the ports, forces out of balance, Newton's change."""
    checked(StepperData, "ehd_stepper_data")
    pointer, number = ctypes.c_void_p, ctypes.c_double
    return (
        function("ehd_port_motion", pointer, pointer, pointer, pointer, result=None),
        function("ehd_unbalanced", *[pointer] * 8, result=None),
        function("ehd_correction", pointer, number, number, pointer),
    )


def port_motion(data: StepperData, q: FloatArray, v: FloatArray, motion: FloatArray) -> None:
    """Displacement and velocity of all ports, into `motion` (2, m), from those of the coordinates.

    Parameters
    ----------
    data : StepperData
        The step.
    q, v : array, shape (n,)
        Coordinates and their rates.
    motion : array, shape (2, m)
        Displacements of the ports and their rates, the result.
    """
    _functions()[0](data.address, _at(q), _at(v), _at(motion))


def unbalanced(
    data: StepperData,
    state: tuple[FloatArray, FloatArray, FloatArray],
    loads: FloatArray,
    port_force: FloatArray,
    force: FloatArray,
) -> tuple[float, float]:
    """Forces that are out of balance; their weighted size, and that of the forces that balance.

    Parameters
    ----------
    data : StepperData
        The step.
    state : tuple of array
        Displacement, velocity and acceleration, shape (n,) each.
    loads, port_force : array
        Loads on the coordinates, shape (n,), and forces of the elements at the ports, shape (m,).
    force : array, shape (n,)
        Forces out of balance, the result.
    """
    sizes = (ctypes.c_double * 2)()
    _functions()[1](data.address, *map(_at, (*state, loads, port_force, force)), ctypes.addressof(sizes))
    return sizes[0], sizes[1]


def correction(data: StepperData, by_q: float, by_v: float, force: FloatArray) -> FloatArray | None:
    """Newton's change of the acceleration, shape (n,); None if there is none.

    Parameters
    ----------
    data : StepperData
        The step.
    by_q, by_v : float
        Derivatives of displacement and rate by the acceleration [s2], [s].
    force : array, shape (n,)
        Forces that are out of balance.
    """
    change = force.copy()
    return change if _functions()[2](data.address, by_q, by_v, _at(change)) else None


def _at(array: FloatArray) -> int:
    """Address of the numbers of an array."""
    return address(array, _DTYPE, "time step")


ITERATIONS = 12
"""Newton iterations of a step at most."""


@dataclass(frozen=True)
class Method:
    """Parameters of the generalised-alpha method with a spectral radius."""

    spectral_radius: float

    @property
    def alpha_m(self) -> float:
        """Weight of the old acceleration in the inertia."""
        return (2.0 * self.spectral_radius - 1.0) / (self.spectral_radius + 1.0)

    @property
    def alpha_f(self) -> float:
        """Weight of the old forces."""
        return self.spectral_radius / (self.spectral_radius + 1.0)

    @property
    def gamma(self) -> float:
        """Newmark's gamma, for second order."""
        return 0.5 + self.alpha_f - self.alpha_m

    @property
    def beta(self) -> float:
        """Newmark's beta, for the most dissipation of the highest frequencies."""
        return 0.25 * (self.gamma + 0.5) ** 2

    @property
    def ratio(self) -> float:
        """Algorithmic acceleration for the one at the end of the step."""
        return (1.0 - self.alpha_f) / (1.0 - self.alpha_m)

    def weights(self, h: float) -> tuple[float, float]:
        """Displacement and velocity at the end of a step for the acceleration there."""
        return h * h * self.beta * self.ratio, h * self.gamma * self.ratio

    def error_weight(self, h: float) -> float:
        """Estimated error of a displacement for the change of the acceleration over a step."""
        return abs(self.beta - 1.0 / 6.0) * h * h


@dataclass(frozen=True, eq=False)
class Mark:
    """State of a run at a time, from which it can go on with other steps.

    Attributes
    ----------
    time : float
        When that was [s].
    motion : array, shape (4, n)
        Displacement, velocity, acceleration, and what the method carries of it, of all coordinates.
    forces : array, shape (ports,)
        Forces of all elements in their ports [N or N m].
    states : tuple
        What elements with states of their own have, see `Element.advance`.
    """

    time: float
    motion: FloatArray
    forces: FloatArray
    states: tuple[Any, ...]

    def stepped(self, ratio: float) -> Mark:
        """The mark for a run whose steps have another length.

        Parameters
        ----------
        ratio : float
            Length of its step, as a part of the one of the run that was marked.

        Notes
        -----
        What the method carries is the acceleration at a time that is off by a part of the step.
        """
        q, v, acceleration, carried = self.motion
        shifted = acceleration + ratio * (carried - acceleration)
        return dataclasses.replace(self, motion=np.array([q, v, acceleration, shifted]))


class Stepper:
    """State of a system in time, and how it goes on by a step.

    Attributes
    ----------
    q, v, acceleration : array, shape (n,)
        Motion of the coordinates [m or rad, per s, per s2].
    carried : array, shape (n,)
        Algorithmic acceleration, which the method carries along.
    iterations : int
        Newton iterations so far.
    outside : array of int, shape (elements,)
        How often each element was evaluated outside its map so far.
    states : list
        What each element with states of its own returned at the end of the last step, see `Element.advance`.
    account : Account
        Energies of the steps.
    """

    def __init__(
        self,
        system: System,
        speed: Speed,
        settings: Settings,
        displacement: FloatArray,
        velocity: FloatArray,
        begin: Mark | None = None,
    ) -> None:
        self._system, self._speed, self._settings = system, speed, settings
        ends = np.cumsum([0, *(connected.transform.shape[0] for connected in system.elements)]).tolist()
        self._elements = [
            (connected.element, slice(begin, end))
            for connected, begin, end in zip(system.elements, ends[:-1], ends[1:], strict=True)
        ]
        self.states: list[Any] = [None] * len(self._elements)
        self._trial = list(self.states)
        self._transform = np.concatenate([np.zeros((0, system.size)), *(c.transform for c in system.elements)])
        ports = ends[-1]
        self._motion, self._port_force, self._unbalanced = np.zeros((2, ports)), np.zeros(ports), np.zeros(system.size)
        self._port_stiffness, self._port_damping = np.zeros((ports, ports)), np.zeros((ports, ports))
        self._damping, self._damped_at = np.array(system.damping, order="C"), math.nan
        self._linear, self._linear_steps = np.array(system.mass, order="C"), (math.nan, math.nan)
        self._method = Method(settings.spectral_radius)
        self._data = StepperData(
            n=system.size,
            m=ports,
            mass=np.ascontiguousarray(system.mass),
            damping=self._damping,
            stiffness=np.ascontiguousarray(system.stiffness),
            linear=self._linear,
            transform=self._transform,
            weight=1.0 / np.sqrt(np.diag(system.mass)),
            port_stiffness=self._port_stiffness,
            port_damping=self._port_damping,
            room=np.empty_like(self._linear),
        )
        self.q, self.v = displacement.copy(), velocity.copy()
        self.iterations = 0
        self.outside = np.zeros(len(self._elements), dtype=np.int64)
        time = 0.0 if begin is None else begin.time
        self._residual(self.q, self.v, np.zeros(system.size), time)
        self.states = list(self._trial)
        self.acceleration = np.asarray(np.linalg.solve(system.mass, -self._unbalanced), dtype=np.float64)
        self.carried = self.acceleration.copy()
        if begin is not None:
            # What the films of a system at rest in this pose would do has been evaluated; they are in motion.
            self.q, self.v, self.acceleration, self.carried = begin.motion.copy()
            self.states, self._port_force[:] = list(begin.states), begin.forces
        self.account = Account(system, [rows for _, rows in self._elements], self._instant(time))

    def step(self, time: float, h: float) -> float:
        """Make a step and return the estimate of its error; leave the state as it is where that is too large.

        Parameters
        ----------
        time : float
            Time at the end of the step [s].
        h : float
            How long [s].
        """
        method = self._method
        by_q, by_v = method.weights(h)
        # Algorithmic acceleration without the part of the unknown one.
        known = (method.alpha_f * self.acceleration - method.alpha_m * self.carried) / (1.0 - method.alpha_m)
        q0 = self.q + h * self.v + h * h * ((0.5 - method.beta) * self.carried + method.beta * known)
        v0 = self.v + h * ((1.0 - method.gamma) * self.carried + method.gamma * known)
        unknown = self.acceleration
        largest = 0.0
        for _ in range(ITERATIONS):
            self.iterations += 1
            q, v = q0 + by_q * unknown, v0 + by_v * unknown
            size, scale = self._residual(q, v, unknown, time)
            largest = max(largest, scale)
            if size <= self._settings.residual * largest:
                break
            change = self._correction(by_q, by_v)
            if change is None:
                return math.inf
            unknown = unknown - change
        else:
            return math.inf
        error = method.error_weight(h) * float(np.max(np.abs(unknown - self.acceleration)))
        if error <= self._settings.tolerance:
            self.q, self.v = q, v
            self.carried = known + method.ratio * unknown
            self.acceleration = unknown
            self.states = list(self._trial)
            self.account.add(h, self._instant(time))
        return error

    def mark(self, time: float) -> Mark:
        """The state at a time, that of the last step.

        Parameters
        ----------
        time : float
            The time [s].
        """
        motion = np.array([self.q, self.v, self.acceleration, self.carried])
        return Mark(time, motion, self._port_force.copy(), tuple(self.states))

    def _instant(self, time: float) -> Instant:
        """The end of the step that was evaluated last."""
        speed, angle = self._speed.at(time)
        operation = Operation(speed, angle, time)
        x, rate = self._motion.copy()
        force, powers = self._port_force.copy(), np.full((len(self._elements), 3), math.nan)
        for row, state, (element, rows) in zip(powers, self.states, self._elements, strict=True):
            of_element = element.powers(state, force[rows], x[rows], rate[rows], operation)
            if of_element is not None:
                row[:] = of_element
        load = self._load(time)
        return Instant(self.q, self.v, self.acceleration, load, x, rate, force, powers)

    def _residual(self, q: FloatArray, v: FloatArray, acceleration: FloatArray, time: float) -> tuple[float, float]:
        """Find the forces that are out of balance: their size, and that of those which balance each other."""
        system = self._system
        speed, angle = self._speed.at(time)
        operation = Operation(speed, angle, time)
        if speed != self._damped_at:
            self._damping[:], self._damped_at = system.damping + speed * system.gyroscopic, speed
            self._linear_steps = (math.nan, math.nan)
        port_motion(self._data, q, v, self._motion)
        x, rate = self._motion
        for index, (element, rows) in enumerate(self._elements):
            answer, self._trial[index] = element.advance(self.states[index], x[rows], rate[rows], operation)
            f, k, c, outside = answer
            self._port_force[rows] = f
            self._port_stiffness[rows, rows] = k
            self._port_damping[rows, rows] = c
            if outside:
                self.outside[index] += 1
        return unbalanced(self._data, (q, v, acceleration), self._load(time), self._port_force, self._unbalanced)

    def _load(self, time: float) -> FloatArray:
        """All loads at a time."""
        load = self._system.loads(time)
        if self._system.turning:
            load += self._system.turning_loads(*self._speed.at(time), self._speed.rate(time))
        return load

    def _correction(self, by_q: float, by_v: float) -> FloatArray | None:
        """Newton's change of the acceleration at the end of the step, for the last residual; None if there is none."""
        if self._linear_steps != (by_q, by_v):
            system = self._system
            self._linear[:] = system.mass + by_v * self._damping + by_q * system.stiffness
            self._linear_steps = (by_q, by_v)
        return correction(self._data, by_q, by_v, self._unbalanced)

    @property
    def forces(self) -> FloatArray:
        """Force of all elements in their ports at the last evaluation, one after the other."""
        return self._port_force


RESOLVED = 10.0
"""Steps a period from which on an oscillation counts as resolved: its period is 3 % too long then."""


def principal_root(spectral_radius: float, step: float, frequency: float) -> complex:
    """Factor by which a step turns and damps an undamped oscillation.

    Parameters
    ----------
    spectral_radius : float
        Spectral radius at the highest frequencies, 0 to 1.
    step : float
        Length of a step [s].
    frequency : float
        Frequency of the oscillation [Hz], > 0.

    Returns
    -------
    complex
        exp((-zeta + i) omega step) but for the errors of the method.

    Examples
    --------
    Without numerical damping it has the size 1:

    >>> round(abs(principal_root(1.0, 1e-5, 5000.0)), 12)
    1.0
    """
    method = Method(spectral_radius)
    h, square = step, (2.0 * math.pi * frequency) ** 2
    forward, turned = method.weights(h)
    old = -method.alpha_m / (1.0 - method.alpha_m)
    older = method.alpha_f / (1.0 - method.alpha_m)
    # c_new = older a + old c + ratio a_new with a = -square q; q and v by Newmark with c.
    known = np.array([-square * older, 0.0, old])
    place = np.array([1.0, h, h * h * (0.5 - method.beta)]) + h * h * method.beta * known
    rate = np.array([0.0, 1.0, h * (1.0 - method.gamma)]) + h * method.gamma * known
    place = place / (1.0 + forward * square)
    amplification = np.array([place, rate - turned * square * place, known - method.ratio * square * place])
    roots = np.linalg.eigvals(amplification)
    return complex(roots[np.argmax(np.abs(roots) * (roots.imag > 0.0))])


def numerical_damping_ratio(spectral_radius: float, step: float, frequency: float) -> float:
    """Damping ratio that the method gives to an undamped oscillation.

    Parameters
    ----------
    spectral_radius, step, frequency
        The same as for `principal_root`.

    Examples
    --------
    >>> f"{numerical_damping_ratio(0.8, 1e-5, 4000.0):.1e}"
    '1.1e-05'
    """
    exponent = cmath.log(principal_root(spectral_radius, step, frequency))
    return max(-exponent.real, 0.0) / abs(exponent)


def energy_lost(spectral_radius: float, step: float, frequency: float, duration: float = 1.0) -> float:
    """Part of the energy of an undamped oscillation that the method takes within a time, 0 to 1.

    Parameters
    ----------
    spectral_radius, step, frequency
        The same as for `principal_root`.
    duration : float
        The time [s].

    Examples
    --------
    >>> round(energy_lost(0.8, 1e-5, 4000.0), 2)
    0.42
    """
    size = abs(principal_root(spectral_radius, step, frequency))
    return -math.expm1(2.0 * math.log(min(size, 1.0)) * duration / step) if size > 0.0 else 1.0
