"""The machine with other values of its unknowns: responses and modes as they were measured.

Laws of the film table are made once and serve other clearances and temperatures. A machine that stands has no films: it
is looked at with dry contacts. Where an unknown costs new laws, the machine is looked at for a few of its values, and
logarithms of responses are interpolated between them.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import linear_sum_assignment

from ehdmaps.arrays import ComplexArray, FloatArray
from mbs.analyses.operating import operating
from mbs.identification.free import Free
from mbs.identification.measured import Measured, MeasuredModes, MeasuredResponses
from mbs.linearised.averaged import mean_equilibrium
from mbs.linearised.linear import frequency_response, sensor_matrix
from mbs.linearised.modes import modes
from mbs.model.elements import Operation
from mbs.model.equilibrium import Equilibrium
from mbs.scene.assembly import Model, assemble
from mbs.scene.scene import Scene

DRY = "hertz"
"""Law of a machine that stands."""


@dataclass(frozen=True, eq=False)
class Machine:
    """A machine that can be looked at with other values of its unknowns.

    Attributes
    ----------
    model : Model
        Scene with its law, at the highest speed of all that is looked at.
    cage_angles : int
        Angles within a pitch over which stiffness and damping are averaged.
    law : str
        Law in place of that of the model, as `mbs.assemble` takes it; empty for its own.
    """

    model: Model
    cage_angles: int
    law: str = ""

    def balance(self, scene: Scene, speed: float) -> Equilibrium:
        """Equilibrium about which the machine moves at a speed.

        Parameters
        ----------
        scene : Scene
            The machine, as it is looked at.
        speed : float
            [rad/s].

        Raises
        ------
        InputError, AnalysisError
            If it cannot be, or finds no equilibrium.
        """
        law = self.law or ("" if speed else DRY)
        model = assemble(scene, law) if law else self.model.again(scene)
        return mean_equilibrium(operating(model, speed).system, Operation(speed), self.cage_angles if speed else 1)

    def responses(self, scene: Scene, measured: MeasuredResponses) -> ComplexArray:
        """Responses as they were measured, shape (lines, rows).

        Parameters
        ----------
        scene : Scene
            The machine.
        measured : MeasuredResponses
            What was measured.
        """
        balance = self.balance(scene, measured.speed)
        sensors = list({(s.name, s.quantity): s for s, _ in measured.rows}.values())
        inputs = list({one.name: one for _, one in measured.rows}.values())
        found = frequency_response(balance, inputs, sensors, measured.frequencies, measured.decay)
        places = [
            (
                next(k for k, one in enumerate(sensors) if (one.name, one.quantity) == (sensor.name, sensor.quantity)),
                next(k for k, one in enumerate(inputs) if one.name == entry.name),
            )
            for sensor, entry in measured.rows
        ]
        return np.stack([found[:, sensor, entry] for sensor, entry in places], axis=1)

    def modes(self, scene: Scene, measured: MeasuredModes) -> tuple[FloatArray, FloatArray]:
        """Frequencies [Hz] and damping ratios of the modes that were measured; NaN where there is none like it.

        Modes are paired so that the sum of what tells them apart is least: the logarithm of their frequencies, and what
        their shapes lack of each other where shapes were measured, 1 less the modal assurance.

        Parameters
        ----------
        scene : Scene
            The machine.
        measured : MeasuredModes
            What was measured.
        """
        balance = self.balance(scene, measured.speed)
        found = modes(balance, errors=False)
        swings = np.flatnonzero((found.frequency > 1.0) & (found.damping_ratio < 0.9))
        frequency, ratio = found.frequency[swings], found.damping_ratio[swings]
        apart = np.abs(np.log(frequency[None, :] / measured.frequency[:, None]))
        if measured.shapes is not None:
            seen = (sensor_matrix(balance, measured.sensors) @ found.shapes[:, swings]).T
            apart = apart + 1.0 - _alike(measured.shapes, seen)
        rows, columns = linear_sum_assignment(apart)
        result = np.full((2, measured.frequency.size), np.nan)
        result[:, rows] = frequency[columns], ratio[columns]
        return result[0], result[1]


def _alike(first: ComplexArray, second: ComplexArray) -> FloatArray:
    """Modal assurance of each shape of two sets, shape (of the first, of the second)."""
    sizes = [np.sum(np.abs(part) ** 2, axis=1) for part in (first, second)]
    product = np.abs(first.conj() @ second.T) ** 2
    return np.asarray(product / np.maximum(np.multiply.outer(*sizes), 1e-300), dtype=np.float64)


def changed(scene: Scene, free: Sequence[Free], values: Sequence[float]) -> Scene:
    """The scene with other values of its unknowns.

    Parameters
    ----------
    scene : Scene
        The machine.
    free : sequence of Free
        Unknowns of the machine.
    values : sequence of float
        A value each [SI].
    """
    for one, value in zip(free, values, strict=True):
        scene = one.change(scene, value)
    return scene


def looked(
    machine: Machine, scene: Scene, free: Sequence[Free], values: Sequence[float], measured: Measured
) -> ComplexArray:
    """Logarithm of what was measured as the machine has it: responses (lines, rows); or modes, shape (2, modes).

    Parameters
    ----------
    machine : Machine
        The machine.
    scene : Scene
        Scene of the machine; the values below are put in.
    free : sequence of Free
        Unknowns of the machine.
    values : sequence of float
        A value each [SI].
    measured : MeasuredResponses or MeasuredModes
        What was measured.

    Raises
    ------
    InputError, AnalysisError
        If the machine cannot be so.
    """
    for place, one in enumerate(free):
        if one.nodes:
            at = np.log(values[place] / np.array(one.nodes))
            within = np.log(np.array(one.nodes))
            total = None
            for k, node in enumerate(one.nodes):
                others = [j for j in range(len(one.nodes)) if j != k]
                part = np.prod([at[j] / (within[k] - within[j]) for j in others])
                found = looked(machine, scene, _without_nodes(free, place), _with(values, place, node), measured)
                # Phases are unwrapped against the first, or a branch of the logarithm would be interpolated.
                if total is None:
                    first, total = found, part * found
                else:
                    turned = np.round((found - first).imag / (2.0 * np.pi))
                    total = total + part * (found - 2j * np.pi * turned)
            return np.asarray(total)
    whole = changed(scene, free, values)
    for one, value in zip(free, values, strict=True):
        if one.law:
            machine = dataclasses.replace(machine, law=one.law.format(value))
    if isinstance(measured, MeasuredModes):
        return np.log(np.array(machine.modes(whole, measured), dtype=np.complex128))
    response = machine.responses(whole, measured)
    gains = {one.sensor: value for one, value in zip(free, values, strict=True) if one.sensor}
    factors = np.array([gains.get(sensor.name, 1.0) for sensor, _ in measured.rows])
    with np.errstate(divide="ignore"):
        return np.asarray(np.log(response * factors))


def _without_nodes(free: Sequence[Free], place: int) -> list[Free]:
    """Unknowns, of which one is looked at as it is."""
    return [dataclasses.replace(one, nodes=()) if k == place else one for k, one in enumerate(free)]


def _with(values: Sequence[float], place: int, value: float) -> list[float]:
    """Values with another one at a place."""
    return [value if k == place else own for k, own in enumerate(values)]
