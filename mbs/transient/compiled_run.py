"""A run in C: what `ehd_advance` needs, prepared for a batch of steps, and the steps between.

Steps that an element has no compiled answer for (such as loads above a map whose law refuses them) are made by
`mbs.transient.stepping`, from the same state: motion, and what elements have of their own.

Its linear part has inverses for steps of some sizes, about the speeds of the run.
"""

from __future__ import annotations

import ctypes
import math
from collections.abc import Sequence
from typing import Any

import numpy as np
import scipy.linalg

from ehdmaps.arrays import BoolArray, FloatArray, IntArray
from mbs.model.blocks import IN_PYTHON
from mbs.model.profiles import LoadProfile, Speed
from mbs.model.system import System
from mbs.settings import Settings
from mbs.transient.energy import Instant, Sums
from mbs.transient.run_arrays import BlockRow, Course, Linear, Numbers, Run, functions
from mbs.transient.run_elements import RunElements
from mbs.transient.stepping import ITERATIONS, Mark, Method, Stepper

THIRD_ORDER = 1e-13
"""What the expansion of the inverse over the speed may leave out, as a part of it."""


class LinearPart:
    """The linear part in M-orthonormal modes.

    Parameters
    ----------
    eigenvalues : array, shape (n,)
        Diagonal of the stiffness by the modes [1/s2].
    damping, gyroscopic : array, shape (n, n)
        D and G by the modes [1/s], [1/rad].
    ports : array, shape (m, n)
        What the elements feel of the modes.
    physical : array, shape (n, n) or (0, n)
        Coordinates by the modes, where errors of steps are asked for.
    method : Method
        Method of the steps.
    alone : int
        How many ports at the beginning move only by their own forces.
    """

    def __init__(
        self,
        eigenvalues: FloatArray,
        damping: FloatArray,
        gyroscopic: FloatArray,
        ports: FloatArray,
        physical: FloatArray,
        method: Method,
        alone: int = 0,
    ) -> None:
        self._eigenvalues, self._damping, self._gyroscopic = eigenvalues, damping, gyroscopic
        self._ports, self._physical, self._method, self._alone = ports, physical, method, alone
        self._turning = bool(np.any(gyroscopic))
        self._made: dict[float, tuple[Linear, float]] = {}

    def about(self, h: float, speeds: FloatArray) -> tuple[Linear, int]:
        """The linear part for steps of length h [s] at the first of some speeds [rad/s], and for how many of them."""
        if h in self._made:
            linear, width = self._made[h]
            count = _leading(np.abs(speeds - linear.reference) <= width)
            if count:
                return linear, count
            low, high = np.minimum.accumulate(speeds), np.maximum.accumulate(speeds)
            # A little less than twice the width, for rounding.
            last = max(_leading(high - low <= 1.9 * width), 1) - 1
            reference = 0.5 * float(low[last] + high[last])
        else:
            reference = float(speeds[0])
        linear, width = self._make(h, reference)
        self._made[h] = linear, width
        return linear, max(_leading(np.abs(speeds - reference) <= width), 1)

    def _make(self, h: float, reference: float) -> tuple[Linear, float]:
        """The linear part about a speed, and how far from it the expansion is good.

        With L = L0 + (speed - reference) by_v G the inverse is L0^-1 - S L0^-1 + S^2 L0^-1 ..., S the relative change.
        """
        by_q, by_v = self._method.weights(h)
        damping = self._damping + reference * self._gyroscopic
        inverse = np.linalg.inv(np.diag(1.0 + by_q * self._eigenvalues) + by_v * damping)
        change = -by_v * inverse @ self._gyroscopic
        inverses = np.stack((inverse, change @ inverse, change @ change @ inverse))
        reach = np.ascontiguousarray(np.swapaxes(inverses @ self._ports.T, 1, 2))
        receptance = np.ascontiguousarray(self._ports @ np.swapaxes(reach, 1, 2))
        size = float(np.linalg.norm(change))
        linear = Linear(
            n=self._eigenvalues.size,
            m=self._ports.shape[0],
            coordinates=self._physical.shape[0],
            alone=self._alone,
            turning=self._turning,
            reference=reference,
            eigenvalues=self._eigenvalues,
            damping=damping,
            gyroscopic=self._gyroscopic,
            inverse=inverses,
            ports=self._ports,
            reach=reach,
            receptance=receptance,
            size=self._ports @ self._ports.T,
            physical=self._physical,
        )
        return linear, math.inf if size == 0.0 else THIRD_ORDER ** (1.0 / 3.0) / size


def _leading(marks: BoolArray) -> int:
    """Number of marks at the beginning that are set."""
    return marks.size if np.all(marks) else int(np.argmin(marks))


_NOTHING = 1e-15
"""Damping of a pair of modes, as a part of the largest, that is round-off."""

_AT_ONCE = 1000
"""Samples whose motions are turned into coordinates at once."""


class CompiledRun:
    """Steps of a system in compiled code, with the state that they lead to.

    Parameters
    ----------
    system : System
        System whose elements all have a kind in `mbs.transient.kinds`.
    speed : Speed
        Speed over time.
    settings : Settings
        Method and steps.
    stepper : Stepper
        Stepper at the beginning of the run; it makes the steps that compiled code cannot.
    outputs : array, shape (k, n)
        What is recorded of the coordinates.
    orders : array, shape (k,)
        Whether of displacement, velocity or acceleration: 0, 1, 2.
    samples : int
        How many records of forces there will be.
    states : bool
        Whether all coordinates are recorded with them.
    stride : int
        How many records of outputs there will be from one of forces to the next.
    """

    def __init__(
        self,
        system: System,
        speed: Speed,
        settings: Settings,
        stepper: Stepper,
        outputs: FloatArray,
        orders: IntArray,
        samples: int,
        states: bool,
        stride: int = 1,
    ) -> None:
        self._speed, self._settings, self._stepper = speed, settings, stepper
        values, modes = scipy.linalg.eigh(system.stiffness, system.mass)
        self._modes, self._by_mass = np.ascontiguousarray(modes), np.ascontiguousarray(modes.T @ system.mass)
        self._elements = RunElements.of(system.elements)
        expand = self._elements.expand
        self._back = np.linalg.pinv(expand) if expand.size else expand.T
        ports = np.concatenate([np.zeros((0, system.size)), *(entry.transform for entry in system.elements)])
        self._method = Method(settings.spectral_radius)
        self._linear = LinearPart(
            values,
            np.ascontiguousarray(modes.T @ system.damping @ modes),
            np.ascontiguousarray(modes.T @ system.gyroscopic @ modes),
            np.ascontiguousarray(expand @ ports @ modes),
            self._modes if settings.tolerance < math.inf else self._modes[:0],
            self._method,
            self._elements.alone,
        )
        self._steady, self._varying, self._profiles = _loads(system, modes)
        self._turning = system.turning
        self._transform, self._expand = ports, expand
        self._advance, self._observe, room = functions()
        n, m, count = system.size, expand.shape[0], len(system.elements)
        self._motion, self._forces = np.zeros((4, n)), np.zeros((3, m))
        self._outputs = np.zeros(((samples - 1) * stride + 1, outputs.shape[0]))
        self._sampled = np.zeros((samples, m))
        self._motions = np.zeros((samples if states else 0, 3, n))
        self._load, self._felt, self._powers = np.zeros(n), np.zeros((2, m)), np.zeros((count, 3))
        self._sums, self._works, self._exchanged = np.zeros(2), np.zeros(m), np.zeros((count, 2))
        self._lost, self._counter = np.zeros(len(system.damping_parts)), np.zeros(1, dtype=np.int64)
        self._run = Run(
            n=n,
            m=m,
            elements=count,
            motion=self._motion,
            forces=self._forces,
            outputs=outputs.shape[0],
            stride=stride,
            motions_kept=states,
            seen=np.ascontiguousarray(outputs @ modes),
            orders=orders,
            output=self._outputs,
            sampled_forces=self._sampled,
            sampled_motions=self._motions,
            load=self._load,
            felt=self._felt,
            powers=self._powers,
            sums=self._sums,
            works=self._works,
            exchanged=self._exchanged,
            parts=self._lost.size,
            lost=self._lost,
            **_damping_parts(system, modes),
            outside=self._elements.outside,
            counter=self._counter,
            room=np.zeros(room(n, m, count)),
        )
        self._numbers_of: dict[float, Numbers] = {}
        self.compiled = 0
        self._take_over()
        self._record(0)

    @property
    def iterations(self) -> int:
        """Newton iterations so far."""
        return self._stepper.iterations + int(self._counter[0])

    @property
    def outside(self) -> IntArray:
        """Number of evaluations of each element outside its map so far."""
        return self._stepper.outside + self._elements.outside

    def steps(self, times: FloatArray, h: float, rows: IntArray) -> tuple[int, float]:
        """Make steps of length h [s] to the given times.

        Parameters
        ----------
        times : array, shape (k,)
            Ends of the steps [s].
        h : float
            Their length [s].
        rows : array, shape (k,)
            Rows to record in; negative for not at all.

        Returns
        -------
        done, error : int, float
            How many were made, and the estimated error of the last one that was tried; infinite without a solution.
        """
        courses = np.array([self._speed.at(time) for time in times.tolist()])
        speeds, angles = np.ascontiguousarray(courses[:, 0]), np.ascontiguousarray(courses[:, 1])
        factors = self._factors(times, speeds, angles)
        self._elements.begin(speeds)
        numbers = self._numbers(h)
        self._forces[1:] = self._forces[0]  # the steps before may have had another length
        done, error = 0, 0.0
        while done < times.size:
            linear, reach = self._linear.about(h, speeds[done:])
            blocks, sound = self._elements.prepare(done, min(done + reach, times.size))
            count = sound.size if sound.all() else int(np.argmin(sound))
            made, status = 0, IN_PYTHON
            if count:
                here = slice(done, done + count)
                course = Course(
                    steps=count,
                    loads=factors.shape[1],
                    times=times[here],
                    speeds=speeds[here],
                    angles=angles[here],
                    steady=self._steady,
                    varying=self._varying,
                    factors=factors[here],
                    rows=rows[here],
                )
                made, status, error = self._make(linear, numbers, blocks, course)
                self.compiled += made
                done += made
            if made == count > 0:
                continue
            if status != IN_PYTHON:
                return done, error
            wanted = 1 if count else int(np.argmax(sound)) or sound.size
            made, error = self._uncompiled(times[done : done + wanted], h, rows[done : done + wanted])
            done += made
            if made < wanted:
                return done, error
        return done, error

    def recorded(self) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Outputs (samples, k), forces in all ports (samples, ports), and motions (samples, 3, n) where recorded.

        To be asked once, at the end: motions of the modes become those of the coordinates where they are.
        """
        # Sample by sample, whatever the size of the blocks: a second array of that size would take as much again.
        for first in range(0, self._motions.shape[0], _AT_ONCE):
            block = self._motions[first : first + _AT_ONCE]
            block[:] = block @ self._modes.T
        return self._outputs, self._sampled @ self._elements.expand, self._motions

    @property
    def position(self) -> FloatArray:
        """Displacement of the coordinates after the last step, shape (n,)."""
        return np.asarray(self._modes @ self._motion[0])

    def ends(self) -> tuple[FloatArray, FloatArray, list[Any]]:
        """Displacement and velocity of the coordinates, and states of the elements, after the last step."""
        p, v = self._motion[:2]
        return self._modes @ p, self._modes @ v, self._elements.states(self._stepper.states)

    def mark(self, time: float) -> Mark:
        """The state at a time, that of the last step.

        Parameters
        ----------
        time : float
            The time [s].
        """
        motion = np.array([self._modes @ part for part in self._motion])
        states = tuple(self._elements.states(self._stepper.states))
        return Mark(time, motion, self._forces[0] @ self._expand, states)

    @property
    def sums(self) -> Sums:
        """Energies of the steps so far."""
        elements = self._elements
        works = np.zeros(elements.outside.size)
        np.add.at(works, elements.owners, self._works)
        exchanged = np.where(elements.told[:, None], self._exchanged, math.nan)
        loads, taken = self._sums.tolist()
        return self._stepper.account.sums.plus(Sums(loads, taken, self._lost, works, exchanged))

    def _make(self, linear: Linear, numbers: Numbers, data: Sequence[Any], course: Course) -> tuple[int, int, float]:
        """Make steps in compiled code: how many were made, how it ended, and the error of the last one."""
        rows = [block.row(part) for block, part in zip(self._elements.functions, data, strict=True)]
        error, status = ctypes.c_double(), ctypes.c_int64()
        made = self._advance(
            self._run.address, linear.address, numbers.address, (BlockRow * len(rows))(*rows), len(rows),
            course.address, ctypes.byref(error), ctypes.byref(status),
        )  # fmt: skip
        if self._elements.raised:
            raise self._elements.raised.pop(0)
        return made, status.value, error.value

    def _record(self, row: int) -> None:
        """Record the state."""
        self._observe(self._run.address, row)

    def _uncompiled(self, times: FloatArray, h: float, rows: IntArray) -> tuple[int, float]:
        """Make steps by the reference; as `steps`."""
        stepper = self._stepper
        stepper.q, stepper.v, stepper.acceleration, stepper.carried = (self._modes @ part for part in self._motion)
        stepper.states = self._elements.states(stepper.states)
        stepper.account.last = self._instant()
        error = 0.0
        for done, (time, row) in enumerate(zip(times.tolist(), rows.tolist(), strict=True)):
            error = stepper.step(time, h)
            if not error <= self._settings.tolerance or math.isinf(error):
                return done, error
            self._take_over()
            if row >= 0:
                self._record(row)
        return times.size, error

    def _take_over(self) -> None:
        """Take the state of the reference."""
        stepper = self._stepper
        given = (stepper.q, stepper.v, stepper.acceleration, stepper.carried)
        for part, values in zip(self._motion, given, strict=True):
            part[:] = self._by_mass @ values
        self._forces[:] = stepper.forces @ self._back
        self._elements.resume(stepper.states)
        last = stepper.account.last
        self._load[:] = self._modes.T @ last.load
        self._felt[0], self._felt[1] = self._expand @ last.x, self._expand @ last.rate
        self._powers[:] = np.nan_to_num(last.powers)

    def _instant(self) -> Instant:
        """The end of the last step, for steps in Python."""
        stepper = self._stepper
        powers = np.where(np.isfinite(stepper.account.last.powers), self._powers, math.nan)
        return Instant(
            q=stepper.q,
            v=stepper.v,
            a=stepper.acceleration,
            load=self._by_mass.T @ self._load,
            x=self._transform @ stepper.q,
            rate=self._transform @ stepper.v,
            force=self._forces[0] @ self._expand,
            powers=powers,
        )

    def _factors(self, times: FloatArray, speeds: FloatArray, angles: FloatArray) -> FloatArray:
        """Factors of all loads that vary, shape (times, loads)."""
        columns = [np.array([profile(time) for time in times.tolist()]) for profile in self._profiles]
        if self._turning:
            rates = np.array([self._speed.rate(time) for time in times.tolist()])
            for load in self._turning:
                factors = load.factors(speeds, angles, rates)
                columns += [factors.real, factors.imag]
        return np.ascontiguousarray(np.array(columns).reshape(len(columns), times.size).T)

    def _numbers(self, h: float) -> Numbers:
        """Numbers of the method."""
        if h in self._numbers_of:
            return self._numbers_of[h]
        method = self._method
        by_q, by_v = method.weights(h)
        self._numbers_of[h] = found = Numbers(
            h=h,
            by_q=by_q,
            by_v=by_v,
            alpha_m=method.alpha_m,
            alpha_f=method.alpha_f,
            beta=method.beta,
            gamma=method.gamma,
            ratio=method.ratio,
            error_weight=method.error_weight(h),
            tolerance=self._settings.tolerance,
            residual=self._settings.residual,
            iterations=ITERATIONS,
        )
        return found


def _damping_parts(system: System, modes: FloatArray) -> dict[str, Any]:
    """Damping of the parts of a system by the modes, for `Run`."""
    rows, columns, values, starts = [], [], [np.zeros(0)], [0]
    for part in system.damping_parts.values():
        upper = np.triu(modes.T @ part @ modes)
        upper[np.abs(upper) <= _NOTHING * np.max(np.abs(upper))] = 0.0
        i, j = np.nonzero(upper)
        rows += i.tolist()
        columns += j.tolist()
        values.append(upper[i, j] * np.where(i == j, 1.0, 2.0))
        starts.append(len(rows))
    return {
        "starts": np.array(starts, dtype=np.int64),
        "rows": np.array(rows, dtype=np.int64),
        "columns": np.array(columns, dtype=np.int64),
        "values": np.concatenate(values),
    }


def _loads(system: System, modes: FloatArray) -> tuple[FloatArray, FloatArray, list[LoadProfile]]:
    """Loads by mode: the steady ones; the varying ones, then both parts of the turning ones; profiles of the former."""
    varying = [modes.T @ load for load, _ in system.varying_loads]
    for turning in system.turning:
        vector = modes.T @ turning.vector
        varying += [vector.real, -vector.imag]
    rows = np.array(varying).reshape(len(varying), system.size)
    return modes.T @ system.steady_loads, rows, [profile for _, profile in system.varying_loads]
