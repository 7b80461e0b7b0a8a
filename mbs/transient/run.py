"""Runs in time: fixed steps in C, recording what is asked for.

Systems of bodies, springs, loads, bearings of all kinds and gear meshes run in the C library (`compiled_run`), as do
elements of one's own that `kinds` lists; with others steps are made in Python (`stepping`). Both make the same steps by
the same method, to what Newton leaves over; for the law of a map C reads tables that are blended over the speed
(`speed_tables`).

The period of a free oscillation at the frequency f comes out longer by the part (2 pi f h)^2 (1/12 + 3/8 s^2) with
s = (1 - rho)/(1 + rho), rho the spectral radius: with rho = 0.8 at 5 kHz by 1.9 % for steps of 15 us, 0.9 % for 10 us.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any, Protocol

import numpy as np

from ehdmaps.arrays import FloatArray, IntArray
from ehdmaps.errors import AnalysisError, InputError
from mbs.model.drive import FEWEST, FOLLOWED, DriveAccount, DrivenRun, DrivenSpeed
from mbs.model.elements import Operation, Sensor
from mbs.model.profiles import Speed, SpeedProfile
from mbs.model.system import System
from mbs.settings import Settings
from mbs.transient.compiled_run import CompiledRun
from mbs.transient.energy import EnergyBalance, Sums, balance, stored_energy
from mbs.transient.run_elements import in_python
from mbs.transient.stepping import Mark, Stepper

HALVINGS = 10
"""How often a step is halved at most, where Newton or the error estimate asks for it."""

CHUNK = 2000
"""Steps between two looks at the caller."""

SHORTEST = 20
"""Steps that are made at once at least: films over the speed are made for them together."""

MARKS = 100
"""Marks of a run at most; the first one is its start."""

MOST_RECORDED = 200_000_000
"""Numbers that a run may record: 1.6 GB."""

SYMMETRIC = 1e-12
"""What the stiffness of bodies and springs may lack of symmetry, as a part of its largest number."""


@dataclass(frozen=True, eq=False)
class States:
    """Motion of all coordinates at the samples, shape (samples, n) each [m or rad, per s, per s2]."""

    displacement: FloatArray
    velocity: FloatArray
    acceleration: FloatArray


@dataclass(frozen=True, eq=False)
class Recording:
    """Record of a run.

    Attributes
    ----------
    time, speed, angle : array, shape (samples,)
        [s], [rad/s], [rad].
    signals : array, shape (rows, sensors)
        Signals of the sensors [m or rad, per s, per s2], at the samples or at every step.
    signal_time, signal_speed, signal_angle : array, shape (rows,)
        When that was [s], [rad/s], [rad].
    forces : tuple of array, shape (samples, m)
        Forces of each element in its ports [N or N m].
    motions : tuple of array, shape (samples, m)
        Displacement of the ports of each element [m or rad].
    steps, halved, iterations : int
        Steps made, steps taken back, and Newton iterations in all.
    outside : dict of str to int
        How often each element was evaluated outside its map, by name.
    compiled : int
        Steps made in compiled code.
    notes : tuple of str
        Why no step could be, in sentences; none where it could or was not asked for.
    states : States
        Motion of all coordinates; of no samples if it was not asked for.
    account : callable
        Makes the energy balance; `energy` has it.
    drive : DriveAccount or None
        Energies of the drive; None where the speed is prescribed.
    marks : tuple of Mark
        States from which the run can go on, rising in time; none if they were not asked for.
    """

    time: FloatArray
    speed: FloatArray
    angle: FloatArray
    signals: FloatArray
    signal_time: FloatArray
    signal_speed: FloatArray
    signal_angle: FloatArray
    forces: tuple[FloatArray, ...]
    motions: tuple[FloatArray, ...]
    steps: int
    halved: int
    iterations: int
    outside: dict[str, int]
    compiled: int
    notes: tuple[str, ...]
    states: States
    account: Callable[[], EnergyBalance]
    drive: DriveAccount | None = None
    marks: tuple[Mark, ...] = ()

    def __getstate__(self) -> dict[str, Any]:
        """For other processes, which have no system to account for or to go on with: with the balance made."""
        return {**self.__dict__, "account": functools.partial(_the_same, self.energy), "marks": ()}

    @functools.cached_property
    def energy(self) -> EnergyBalance:
        """Energy balance: what came in, where it went, what does not close. It is made when it is first asked for."""
        return self.account()


def _the_same(balance: EnergyBalance) -> EnergyBalance:
    """A balance that has been made."""
    return balance


@dataclass(frozen=True)
class Options:
    """Options of how a run is made and what it keeps, besides the method.

    Attributes
    ----------
    states : bool
        Whether the motion of all coordinates is recorded: 24 bytes a coordinate and sample.
    every_step : bool
        Whether sensors are recorded at every step instead of at the samples, so that nothing is folded into their band.
    compiled : bool
        False: the reference, step by step in Python.
    marks : bool
        Whether states are kept from which the run can go on.
    """

    states: bool = False
    every_step: bool = False
    compiled: bool = True
    marks: bool = False


WITH_STATES = Options(states=True)
"""Of a run that records the motion of all coordinates."""


def run(
    system: System,
    speed: SpeedProfile,
    duration: float,
    settings: Settings,
    sensors: Sequence[Sensor] = (),
    displacement: FloatArray | None = None,
    velocity: FloatArray | None = None,
    progress: Callable[[int], None] | None = None,
    options: Options = Options(),
    begin: Mark | None = None,
) -> Recording:
    """Run a system in time, and record sensors and elements.

    Parameters
    ----------
    system : System
        Bodies, springs, loads, elements.
    speed : SpeedProfile
        Prescribed speed, or one that a drive makes.
    duration : float
        How long [s]; rounded up to whole samples.
    settings : Settings
        Method and steps.
    sensors : sequence of Sensor
        What to record.
    displacement, velocity : array, shape (n,), optional
        Motion at time zero; zero if left out.
    progress : callable, optional
        Told the number of samples done: once for each, some at a time.
    options : Options
        What is kept besides, and whether compiled code is used.
    begin : Mark, optional
        State of another run of this system from which to go on, at its time, instead of from a motion at time zero;
        that run may have had other steps.

    Raises
    ------
    InputError
        For an invalid start or duration, and for more samples than can be recorded.
    AnalysisError
        If a step finds no solution although it was halved ten times.
    """
    plan = _Plan.of(system, sensors, duration, settings, options)
    start = [_start(name, given, system) for name, given in (("displacement", displacement), ("velocity", velocity))]
    given: Speed = speed
    followed = None
    if isinstance(speed, DrivenSpeed):
        _check_driven(system)
        given = followed = speed.started()
    if begin is not None:
        if followed is not None:
            raise InputError(
                "run, begin: got a mark beside a speed by torques, which has a state of its own; allowed: a prescribed "
                "speed, such as the one that was recorded"
            )
        start = [begin.motion[0], begin.motion[1]]
    first = 0.0 if begin is None else begin.time
    stepper = Stepper(system, given, settings, start[0], start[1], begin)
    engine: _Engine
    notes = _notes(system) if options.compiled else ()
    if options.compiled and not notes:
        records = (plan.rows, plan.orders, plan.samples + 1, plan.states, plan.stride)
        engine = CompiledRun(system, given, settings, stepper, *records)
    else:
        engine = _Reference(stepper, plan, settings)
    stored = stored_energy(system, stepper.q, stepper.v, stepper.states, Operation(*given.at(first), first))
    shaft = None if followed is None else _Shaft(followed, engine, system)
    marks = [engine.mark(first)] if options.marks else None
    steps, halved = _drive(engine, settings, plan, progress, shaft, first, marks)
    last = first + plan.samples * settings.sample
    end = stored_energy(system, *engine.ends(), Operation(*given.at(last), last))
    outputs, forces, motions = engine.recorded()
    fine = first + plan.times(settings)
    seen_at = np.array([given.at(time) for time in fine.tolist()])
    times, courses = fine[:: plan.stride], seen_at[:: plan.stride]
    ports = [connected.transform.shape[0] for connected in system.elements]
    ends = np.cumsum([0, *ports]).tolist()
    parts = [slice(begin, end) for begin, end in pairwise(ends)]
    count = len(sensors)
    port_motions = tuple(outputs[:: plan.stride, count + part.start : count + part.stop] for part in parts)

    def account() -> EnergyBalance:
        """The balance; what changes of the speed brought takes a second or two, whatever the length of the run."""
        elements = [entry.element for entry in system.elements]
        operations = [Operation(w, angle, at) for (w, angle), at in zip(courses.tolist(), times.tolist(), strict=True)]
        by_speed = [
            element.brought_by_speed(motion, operations) for element, motion in zip(elements, port_motions, strict=True)
        ]
        return balance(system, engine.sums, stored, end, by_speed)

    return Recording(
        time=times,
        speed=courses[:, 0],
        angle=courses[:, 1],
        signals=outputs[:, :count],
        signal_time=fine,
        signal_speed=seen_at[:, 0],
        signal_angle=seen_at[:, 1],
        forces=tuple(forces[:, part] for part in parts),
        motions=port_motions,
        steps=steps,
        halved=halved,
        iterations=engine.iterations,
        outside={entry.element.name: int(calls) for entry, calls in zip(system.elements, engine.outside, strict=True)},
        compiled=engine.compiled,
        notes=notes,
        states=States(motions[:, 0], motions[:, 1], motions[:, 2]),
        account=account,
        drive=None if followed is None else followed.account(),
        marks=tuple(marks or ()),
    )


class _Shaft:
    """Torque that the moving system takes from the shaft that a drive turns: told to the drive after some steps."""

    def __init__(self, followed: DrivenRun, engine: _Engine, system: System) -> None:
        self._followed, self._engine, self._steady = followed, engine, system.steady_loads
        self._last = self._given()

    def _given(self) -> float:
        """Work of the loads that turn, and what turning brought into elements, so far [J]."""
        sums = self._engine.sums
        return sums.loads - float(self._steady @ self._engine.position) + float(np.nansum(sums.exchanged[:, 1]))

    def settle(self, time: float) -> None:
        """Tell the drive what was taken up to a time [s]."""
        given = self._given()
        self._followed.settle(time, given - self._last)
        self._last = given


def _check_driven(system: System) -> None:
    """Refuse loads whose work may or may not come from the shaft."""
    if system.varying_loads:
        raise InputError(
            "run, drive: got loads that vary over time beside a speed by torques, whose work may or may not come from "
            "the shaft; allowed: constant [[loads]], and [[excitations]] by an order"
        )


@dataclass(frozen=True, eq=False)
class _Plan:
    """Plan of a recording: rows of what is seen of the coordinates, and how often it is differentiated."""

    samples: int
    rows: FloatArray
    orders: IntArray
    ports: FloatArray
    states: bool
    stride: int

    @classmethod
    def of(
        cls, system: System, sensors: Sequence[Sensor], duration: float, settings: Settings, options: Options
    ) -> _Plan:
        """Plan a run, or say what is wrong."""
        if not (math.isfinite(duration) and duration > 0.0):
            raise InputError(f"run, duration: got {duration!r} s; allowed: finite and > 0")
        ports = np.concatenate([np.zeros((0, system.size)), *(entry.transform for entry in system.elements)])
        seen = [sensor.direction @ system.relative(sensor.on, sensor.against) for sensor in sensors]
        rows = np.concatenate([np.zeros((0, system.size)), *(row[None, :] for row in seen), ports])
        orders = [*(sensor.order for sensor in sensors), *([0] * ports.shape[0])]
        samples = math.ceil(duration / settings.sample - 1e-9)
        stride = settings.steps_per_sample if options.every_step else 1
        width = rows.shape[0] * stride + ports.shape[0] + (3 * system.size if options.states else 0)
        if (samples + 1) * max(width, 1) > MOST_RECORDED:
            raise InputError(
                f"run, sample: got {settings.sample!r} s over {duration!r} s, which makes {samples + 1:.4g} samples of "
                f"{width} numbers; allowed: {MOST_RECORDED:.4g} numbers; choose longer samples or a shorter run"
            )
        return cls(samples, rows, np.array(orders, dtype=np.int64), ports, options.states, stride)

    def times(self, settings: Settings) -> FloatArray:
        """Times of the rows of outputs [s], shape (rows,)."""
        row, stride = np.arange(self.samples * self.stride + 1), self.stride
        # At the samples just what they are without rows between.
        return np.asarray(row // stride * settings.sample + row % stride * settings.step, dtype=np.float64)


class _Engine(Protocol):
    """Something that makes steps and records."""

    compiled: int

    @property
    def iterations(self) -> int:
        """Newton iterations so far."""
        ...

    @property
    def outside(self) -> IntArray:
        """Number of evaluations of each element outside its map so far."""
        ...

    def steps(self, times: FloatArray, h: float, rows: IntArray) -> tuple[int, float]:
        """Make steps of length h to the given times; how many were made, and the error of the last one tried."""
        ...

    @property
    def sums(self) -> Sums:
        """Energies of the steps so far."""
        ...

    @property
    def position(self) -> FloatArray:
        """Displacement of the coordinates after the last step, shape (n,)."""
        ...

    def ends(self) -> tuple[FloatArray, FloatArray, Sequence[Any]]:
        """Displacement and velocity of the coordinates, and states of the elements, after the last step."""
        ...

    def mark(self, time: float) -> Mark:
        """The state at a time, that of the last step."""
        ...

    def recorded(self) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Outputs, forces in all ports, and motions of all coordinates, at the samples."""
        ...


def _drive(
    engine: _Engine,
    settings: Settings,
    plan: _Plan,
    progress: Callable[[int], None] | None,
    shaft: _Shaft | None,
    first: float = 0.0,
    marks: list[Mark] | None = None,
) -> tuple[int, int]:
    """Step to the end, with halved steps where they are needed, and add marks; steps made, and steps taken back."""
    finest = 1 << HALVINGS
    tick = settings.step / finest
    sample = settings.steps_per_sample * finest
    row = sample // plan.stride
    ticks, end = 0, plan.samples * sample
    apart = end // MARKS
    # The same with marks and without: to look at the error of the step must not change the run.
    if shaft is None:
        each = settings.steps_per_sample
        chunk = min(CHUNK, max(apart // sample, math.ceil(SHORTEST / each)) * each)
    else:
        chunk = max(round(FOLLOWED / settings.step), FEWEST)
    level = steps = halved = samples = 0
    while ticks < end:
        stride = finest >> level
        count = min(chunk, (end - ticks) // finest) if level == 0 else 1
        reached = ticks + stride * np.arange(1, count + 1)
        rows = np.where(reached % row == 0, reached // row, -1)
        done, error = engine.steps(np.asarray(first + reached * tick, dtype=np.float64), stride * tick, rows)
        ticks += done * stride
        steps += done
        if shaft is not None and done:
            shaft.settle(ticks * tick)
        # At rows, where the run has signals to compare with.
        if marks is not None and ticks % row == 0 and first + ticks * tick - marks[-1].time > (apart - 0.5) * tick:
            marks.append(engine.mark(first + ticks * tick))
        if done < count:
            halved += 1
            level += 1
            if level > HALVINGS:
                raise AnalysisError(
                    f"time integration: no solution at {first + ticks * tick:.6g} s with steps of {tick:.3g} s; "
                    "start nearer to an equilibrium, or check units and signs of the loads"
                )
        # The error goes with the third power of the step.
        elif level and ticks % (2 * stride) == 0 and 8.0 * error < settings.tolerance:
            level -= 1
        while progress and samples < ticks // sample:
            samples += 1
            progress(samples)
    return steps, halved


class _Reference:
    """Steps of `mbs.transient.stepping` alone."""

    def __init__(self, stepper: Stepper, plan: _Plan, settings: Settings) -> None:
        self._stepper, self._plan, self._tolerance = stepper, plan, settings.tolerance
        self._outputs = np.empty((plan.samples * plan.stride + 1, plan.rows.shape[0]))
        self._forces = np.empty((plan.samples + 1, plan.ports.shape[0]))
        self._motions = np.empty((plan.samples + 1 if plan.states else 0, 3, plan.rows.shape[1]))
        self.compiled = 0
        self._record(0)

    @property
    def iterations(self) -> int:
        """Newton iterations so far."""
        return self._stepper.iterations

    @property
    def outside(self) -> IntArray:
        """Number of evaluations of each element outside its map so far."""
        return self._stepper.outside

    def steps(self, times: FloatArray, h: float, rows: IntArray) -> tuple[int, float]:
        """Make steps."""
        error = 0.0
        for done, (time, row) in enumerate(zip(times.tolist(), rows.tolist(), strict=True)):
            error = self._stepper.step(time, h)
            if not error <= self._tolerance or math.isinf(error):
                return done, error
            if row >= 0:
                self._record(row)
        return times.size, error

    @property
    def sums(self) -> Sums:
        """Energies of the steps so far."""
        return self._stepper.account.sums

    @property
    def position(self) -> FloatArray:
        """Displacement after the last step."""
        return self._stepper.q

    def ends(self) -> tuple[FloatArray, FloatArray, Sequence[Any]]:
        """Displacement, velocity and states after the last step."""
        return self._stepper.q, self._stepper.v, self._stepper.states

    def mark(self, time: float) -> Mark:
        """The state at a time, that of the last step."""
        return self._stepper.mark(time)

    def recorded(self) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Outputs, forces and motions."""
        return self._outputs, self._forces, self._motions

    def _record(self, row: int) -> None:
        """Record the state."""
        stepper, plan = self._stepper, self._plan
        state = np.stack((stepper.q, stepper.v, stepper.acceleration))
        self._outputs[row] = np.einsum("kn,kn->k", plan.rows, state[plan.orders])
        if row % plan.stride == 0:
            self._forces[row // plan.stride] = stepper.forces
            if plan.states:
                self._motions[row // plan.stride] = state


def _notes(system: System) -> tuple[str, ...]:
    """Reasons why a run cannot go in compiled code, in sentences; none if it can."""
    notes = []
    if slow := in_python(system.elements):
        notes.append(
            f"{', '.join(slow)}: no compiled block, so every step runs in Python, which is many times slower; a kind "
            "of element gets one by mbs.transient.kinds"
        )
    # Real modes need a stiffness that is symmetric, to rounding.
    stiffness = system.stiffness
    symmetric = np.max(np.abs(stiffness - stiffness.T)) <= SYMMETRIC * np.max(np.abs(stiffness))
    if not symmetric:
        notes.append("the stiffness is not symmetric, so every step runs in Python, which is many times slower")
    return tuple(notes)


def _start(name: str, given: FloatArray | None, system: System) -> FloatArray:
    """State at the beginning."""
    values = np.zeros(system.size) if given is None else np.asarray(given, dtype=np.float64)
    if values.shape != (system.size,) or not np.all(np.isfinite(values)):
        raise InputError(
            f"run, {name}: got {'numbers that are not finite' if values.shape == (system.size,) else values.shape}; "
            f"allowed: {system.size} finite numbers, one a coordinate"
        )
    return values
