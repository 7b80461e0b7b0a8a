"""Whether the steps of a run are short enough, measured: its first part again with half of the step.

What steps resolve cannot be told from frequencies alone: contacts lift off, films fade, speeds rise. So the first part
of a run is made twice more, from the same start, with its step and with half of it, and each sensor's root mean square
is compared. A method of second order that changes by d is 4/3 d away from its limit.
"""

from __future__ import annotations

import dataclasses
import math
from dataclasses import dataclass

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import EhdmapsError
from mbs.analyses.drive import course_of
from mbs.model.equilibrium import Equilibrium
from mbs.scene.assembly import Model
from mbs.settings import RunUp
from mbs.transient.run import Options
from mbs.transient.run import run as run_system

PART = 0.05
"""Part of a run that is made again."""

FEWEST = 500
"""Fewest steps of it."""

NOTABLE = 0.1
"""Estimated error of a root mean square from which on it is warned of; 0.8 dB."""

_LIMIT = 4.0 / 3.0


@dataclass(frozen=True, eq=False)
class StepCheck:
    """Signals of the first part of a run with its step and with half of it.

    Attributes
    ----------
    duration : float
        Length of that part [s].
    step : float
        Step of the run [s].
    names, units : tuple of str
        Sensors, and units of their signals.
    with_step, with_half : array, shape (sensors,)
        Root mean square of each signal about its mean.
    """

    duration: float
    step: float
    names: tuple[str, ...]
    units: tuple[str, ...]
    with_step: FloatArray
    with_half: FloatArray

    @property
    def errors(self) -> FloatArray:
        """Estimated error of each root mean square with the step of the run, as a part of it, shape (sensors,)."""
        size = np.maximum(self.with_half, 1e-300)
        return np.where(self.with_half > 0.0, _LIMIT * np.abs(self.with_step - self.with_half) / size, 0.0)

    @property
    def converged(self) -> bool:
        """Whether all are within `NOTABLE`."""
        return bool(np.all(self.errors <= NOTABLE))


def step_check(model: Model, course: RunUp, start: Equilibrium) -> StepCheck | None:
    """Make the first part of a run with its step and with half of it.

    Parameters
    ----------
    model : Model
        Scene with its law, in operation.
    course : RunUp
        The run.
    start : Equilibrium
        Equilibrium where it begins.

    Returns
    -------
    StepCheck or None
        None without sensors, with steps that adapt to a tolerance, and where a part finds no solution.
    """
    sensors, settings = model.scene.sensors, course.settings
    if not sensors or math.isfinite(settings.tolerance):
        return None
    duration = min(course.duration, max(PART * course.duration, FEWEST * settings.step))
    sizes = []
    for step in (settings.step, 0.5 * settings.step):
        try:
            record = run_system(
                model.system,
                course_of(model, course),
                duration,
                dataclasses.replace(settings, step=step),
                sensors=sensors,
                displacement=start.displacement,
                options=Options(every_step=True),
            )
        except EhdmapsError:
            return None
        # At the same times, so that nothing is but the steps.
        sizes.append(np.std(record.signals[:: round(settings.step / step)], axis=0))
    names, units = tuple(sensor.name for sensor in sensors), tuple(_unit(sensor.quantity) for sensor in sensors)
    return StepCheck(duration, settings.step, names, units, *sizes)


def _unit(quantity: str) -> str:
    """Unit of the signal of a sensor."""
    return {"displacement": "m", "velocity": "m/s", "acceleration": "m/s2"}[quantity]
