"""Stiffness and damping of a unit with films of memory: by its equations, in steps, of a mass that swings on it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.optimize import least_squares

from tests.cases.fmu import OUTPUTS, Unit

POSE = ("pose.y", "pose.z", "pose.theta_y", "pose.theta_z")
VELOCITY = ("velocity.y", "velocity.z", "velocity.theta_y", "velocity.theta_z")


@dataclass(frozen=True)
class Rest:
    """What a ring swings about: displacement along z [m], speed of the inner ring [rad/s], temperature [K]."""

    place: float
    speed: float
    temperature: float

    @property
    def inputs(self) -> dict[str, float]:
        """Inputs of a unit."""
        return {"pose.z": self.place, "speed.inner": self.speed, "temperature": self.temperature}


def states(unit: Unit, kind: str = "film.xi") -> tuple[str, ...]:
    """Names of all states, or of their rates."""
    return tuple(name for name in unit.references if name.startswith(kind))


def linearised(unit: Unit, rest: Rest, frequency: float, direction: int = 1) -> tuple[float, float]:
    """Stiffness [N/m] and damping [N s/m] at a frequency [Hz], by the derivatives of outputs and rates of a unit."""
    model = unit.instance(begun=False)
    model.enterInitializationMode()
    unit.put(model, [*rest.inputs], [*rest.inputs.values()])
    model.exitInitializationMode()
    output, rates = OUTPUTS[direction], states(unit, "der(film.xi")
    by_pose = unit.derivatives(model, POSE[direction], (output, *rates))
    own = [unit.derivatives(model, name, (output, rate)) for name, rate in zip(states(unit), rates, strict=True)]
    of_states, relaxing = np.transpose(own)
    model.freeInstance()
    turning = 2j * np.pi * frequency
    dynamic = -by_pose[0] - np.sum(of_states * by_pose[1:] / (turning - relaxing))
    return float(dynamic.real), float(dynamic.imag / abs(turning))


def stepped(
    unit: Unit, rest: Rest, frequency: float, step: float, direction: int = 1, velocities: bool = True
) -> tuple[float, float]:
    """The same in steps [s]: the force after each step beside the place that was set before it, in the third period."""
    turning, amplitude, count = 2.0 * np.pi * frequency, 2e-8, round(3.0 / frequency / step)
    names, rate = (POSE[direction], VELOCITY[direction]), amplitude * turning * velocities
    middle = rest.inputs.get(names[0], 0.0)
    begin = {**rest.inputs, names[0]: middle, names[1]: rate}
    model = unit.stepped([*begin], [*begin.values()])
    times, forces = step * np.arange(1, count + 1), []
    for time in times:
        unit.put(model, [*names], [middle + amplitude * np.sin(turning * time), rate * np.cos(turning * time)])
        model.doStep(time - step, step)
        forces.append(unit.get(model)[direction])
    model.freeInstance()
    last = times > times[-1] - 1.0 / frequency
    shapes = np.column_stack([np.sin(turning * times), np.cos(turning * times), np.ones(count)])
    found = -np.linalg.lstsq(shapes[last], np.array(forces)[last], rcond=None)[0] / amplitude
    return float(found[0]), float(found[1] / turning)


def swung(unit: Unit, rest: Rest, mass: float, frequency: float, step: float, extrapolated: bool) -> float:
    """Damping [N s/m] of a mass [kg] on a unit, whose force the master holds or extrapolates over a step."""
    model = unit.stepped([*rest.inputs], [*rest.inputs.values()])
    begun = force = last = unit.get(model)[1]
    x, v, places = 0.0, 1e-8 * 2.0 * np.pi * frequency, []
    for n in range(round(4.0 / frequency / step)):
        rate = ((1.5 * force - 0.5 * last if extrapolated else force) - begun) / mass
        x, v = x + step * v + 0.5 * step**2 * rate, v + step * rate
        unit.put(model, ["pose.z", "velocity.z"], [rest.place + x, v])
        model.doStep(n * step, step)
        last, force = force, unit.get(model)[1]
        places.append(x)
    model.freeInstance()
    kept = np.array(places)[len(places) // 8 :] / np.max(np.abs(places))  # films forget how it began
    angle = 2.0 * np.pi * frequency * step * np.arange(kept.size)

    def difference(p: np.ndarray) -> np.ndarray:
        return np.exp(-p[0] * angle) * (p[1] * np.sin(p[2] * angle) + p[3] * np.cos(p[2] * angle)) + p[4] - kept

    decay = least_squares(difference, [0.0, 1.0, 1.0, 0.1, 0.0]).x[0]
    return float(2.0 * mass * decay * 2.0 * np.pi * frequency)
