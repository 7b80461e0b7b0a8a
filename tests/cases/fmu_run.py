"""Units beside something that moves: Model Exchange, all states of both in FMPy's CVODE, and Co-Simulation in steps."""

from __future__ import annotations

from collections.abc import Sequence
from ctypes import c_double
from typing import Any, Protocol

import numpy as np
from fmpy.fmi1 import FMICallException
from fmpy.sundials import CVodeSolver

from ehdmaps.arrays import FloatArray
from tests.cases.fmu import Unit


class Mover(Protocol):
    """What the units act on."""

    start: FloatArray
    """States at the beginning, shape (n,)."""

    nominals: FloatArray
    """Sizes of the states; tolerances are parts of them, shape (n,)."""

    def inputs(self, time: float, states: FloatArray) -> Sequence[dict[str, float]]:
        """Inputs of each unit by name."""
        ...

    def rates(self, time: float, states: FloatArray, outputs: Sequence[FloatArray]) -> FloatArray:
        """Rates of the states for what the units put out, shape (n,)."""
        ...


class Attached:
    """An instance of a unit in the mode for continuous time, with whatever states it has."""

    def __init__(self, unit: Unit, start: dict[str, float]) -> None:
        self._unit, self._model = unit, unit.instance(begun=False)
        model = self._model
        model.enterInitializationMode()
        unit.put(model, list(start), list(start.values()))
        model.exitInitializationMode()
        (model.newDiscreteStates if unit.second else model.updateDiscreteStates)()
        model.enterContinuousTimeMode()
        self.size = unit.description.numberOfContinuousStates
        self._room = (c_double * self.size)()

    def _read(self, call: Any) -> FloatArray:
        """What a call writes for each state; without states it is not called."""
        if self.size:
            call(self._room, self.size)
        return np.array(self._room)

    @property
    def nominals(self) -> FloatArray:
        """Sizes of the states."""
        return self._read(self._model.getNominalsOfContinuousStates)

    @property
    def states(self) -> FloatArray:
        """Continuous states."""
        return self._read(self._model.getContinuousStates)

    def go(self, time: float, states: FloatArray) -> None:
        """Set the time and the states."""
        self._model.setTime(time)
        if self.size:
            self._model.setContinuousStates((c_double * self.size)(*states), self.size)

    def outputs(self, inputs: dict[str, float]) -> FloatArray:
        """Set the inputs, and return the outputs."""
        self._unit.put(self._model, list(inputs), list(inputs.values()))
        return self._unit.get(self._model)

    def rates(self) -> FloatArray:
        """Rates of the states, for the inputs that were set."""
        model = self._model
        return self._read(model.getDerivatives if self._unit.second else model.getContinuousStateDerivatives)

    def step_is_done(self) -> None:
        """Tell the end of a step."""
        assert self._model.completedIntegratorStep() == (False, False), "the unit has no events"

    def free(self) -> None:
        """Leave it."""
        self._model.terminate()
        self._model.freeInstance()


class _Solver(CVodeSolver):
    """CVODE of FMPy, which tries a shorter step where a unit discards."""

    discarded: FMICallException | None = None

    def f(self, t: float, y: Any, ydot: Any, user_data: Any) -> int:
        """Return the rates; a positive status is an error that can be mended, by the convention of CVODE."""
        try:
            return int(super().f(t, y, ydot, user_data))
        except FMICallException as error:
            self.discarded = error
            return 1


class _Joint:
    """States of the mover and of all units in one row, as the solver asks for them."""

    def __init__(self, mover: Mover, units: Sequence[Attached]) -> None:
        self._mover, self._units = mover, units
        self._ends = np.cumsum([mover.start.size, *(unit.size for unit in units)])
        self._time, self._own, self.calls = 0.0, mover.start.copy(), 0

    @property
    def size(self) -> int:
        """How many states there are."""
        return int(self._ends[-1])

    def apply(self, time: float) -> None:
        """Inputs over time, which the solver wants to set: there are none, all follow from the states."""

    def set_time(self, time: float) -> None:
        """Keep the time of what follows."""
        self._time = time

    def get_x(self, room: Any, size: int) -> None:
        """Write all states."""
        _all(room, size)[:] = np.concatenate([self._own, *(unit.states for unit in self._units)])

    def set_x(self, room: Any, size: int) -> None:
        """Take all states."""
        own, *parts = np.split(_all(room, size).copy(), self._ends[:-1])
        self._own = own
        for unit, part in zip(self._units, parts, strict=True):
            unit.go(self._time, part)

    def get_dx(self, room: Any, size: int) -> None:
        """Write the rates of all states: the units see where the mover is, and it gets what they put out."""
        self.calls += 1
        inputs = self._mover.inputs(self._time, self._own)
        outputs = [unit.outputs(values) for unit, values in zip(self._units, inputs, strict=True)]
        own = self._mover.rates(self._time, self._own, outputs)
        _all(room, size)[:] = np.concatenate([own, *(unit.rates() for unit in self._units)])

    def get_z(self, room: Any, size: int) -> None:
        """Write the event indicators, of which there are none."""

    def get_nominals(self, room: Any, size: int) -> None:
        """Write the sizes of all states."""
        _all(room, size)[:] = np.concatenate([self._mover.nominals, *(unit.nominals for unit in self._units)])


def _all(room: Any, size: int) -> FloatArray:
    """The numbers behind a pointer."""
    return np.ctypeslib.as_array(room, (size,))


def coupled_run(mover: Mover, units: Sequence[Unit], times: FloatArray, tolerance: float) -> tuple[FloatArray, int]:
    """Run a mover on units in FMPy's CVODE, an instance of each, all states together.

    Parameters
    ----------
    mover : Mover
        What the units act on.
    units : sequence of Unit
        One for each of its `inputs`; the same one may stand there again.
    times : array, shape (m,)
        Rising [s]; the run begins at the first.
    tolerance : float
        Relative tolerance of CVODE; its absolute ones are this part of the nominal values.

    Returns
    -------
    states : array, shape (m, n)
        States of the mover at the times.
    calls : int
        How often rates were asked for.
    """
    begin = mover.inputs(float(times[0]), mover.start)
    attached = [Attached(unit, values) for unit, values in zip(units, begin, strict=True)]
    joint = _Joint(mover, attached)
    solver = _Solver(
        nx=joint.size,
        nz=0,
        get_x=joint.get_x,
        set_x=joint.set_x,
        get_dx=joint.get_dx,
        get_z=joint.get_z,
        get_nominals=joint.get_nominals,
        set_time=joint.set_time,
        input=joint,
        startTime=float(times[0]),
        relativeTolerance=tolerance,
        maxNumSteps=100_000,
    )
    found, room = [mover.start], (c_double * joint.size)()
    try:
        for now, then in zip(times[:-1].tolist(), times[1:].tolist(), strict=True):
            solver.step(now, then)
            for unit in attached:
                unit.step_is_done()
            joint.get_x(room, joint.size)
            found.append(np.array(room)[: mover.start.size])
    except RuntimeError as error:
        raise (solver.discarded or error) from error
    finally:
        for unit in attached:
            unit.free()
    return np.array(found), joint.calls


def stepped_run(
    mover: Mover, units: Sequence[Unit], times: FloatArray, step: float, extrapolated: bool = True
) -> FloatArray:
    """Run a mover on units in Co-Simulation, in steps of one length.

    Over a step the mover has the force that follows from those at the last two communication points, in its middle; or
    it holds the last one. Its states are displacements, then velocities.

    Parameters
    ----------
    mover, units, times
        As of `coupled_run`; times are evenly spaced, by a whole number of steps.
    step : float
        [s].
    extrapolated : bool
        1.5 times the last force minus half of the one before, or the last force.

    Returns
    -------
    array, shape (m, n)
        States of the mover at the times.
    """
    states, half = mover.start.copy(), mover.start.size // 2
    models = [unit.stepped(list(values), list(values.values())) for unit, values in
              zip(units, mover.inputs(float(times[0]), states), strict=True)]  # fmt: skip
    last = force = np.array([unit.get(model) for unit, model in zip(units, models, strict=True)])
    each, found, change = round(float(times[1] - times[0]) / step), [states.copy()], np.zeros(half)
    for number in range(each * (times.size - 1)):
        time = float(times[0]) + number * step
        taken = 1.5 * force - 0.5 * last if extrapolated else force
        middle = np.concatenate([states[:half], states[half:] + 0.5 * change])
        change = step * mover.rates(time + 0.5 * step, middle, list(taken))[half:]
        states = np.concatenate([states[:half] + step * (states[half:] + 0.5 * change), states[half:] + change])
        last, outputs = force, []
        for unit, model, values in zip(units, models, mover.inputs(time + step, states), strict=True):
            unit.put(model, list(values), list(values.values()))
            model.doStep(time, step)
            outputs.append(unit.get(model))
        force = np.array(outputs)
        if (number + 1) % each == 0:
            found.append(states.copy())
    for model in models:
        model.freeInstance()
    return np.array(found)
