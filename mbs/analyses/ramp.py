"""The run-up of a scene with a sample a step: its course, a silent one before it, and the recording."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Sequence

import numpy as np

from mbs.analyses.drive import course_of
from mbs.model.elements import Operation, Sensor
from mbs.model.equilibrium import equilibrium
from mbs.scene.assembly import Model
from mbs.scene.fields import HERTZ
from mbs.scene.scene import Scene
from mbs.settings import CampbellSettings, RunUp
from mbs.spectral.campbell import RunUpSpectra, run_up_spectra
from mbs.spectral.run_signal import RunSignal
from mbs.spectral.spectra import LEAST_OVERSAMPLING
from mbs.transient.run import Recording
from mbs.transient.run import run as run_system

LEAST_SAMPLES, MOST_SAMPLES = 64, 5_000_000
"""Steps of a run: the fewest that have a spectrum, and 50 s of 10 us, beyond any run-up that is waited for."""


def run_course(scene: Scene, highest: float, problems: list[str]) -> RunUp | None:
    """The run of the scene with a sample a step, so that nothing above the band is folded into it.

    Parameters
    ----------
    scene : Scene
        The scene.
    highest : float
        Highest frequency that is looked at [Hz].
    problems : list of str
        What is wrong about it is appended.

    Returns
    -------
    RunUp or None
        None where there is no run, or none of a possible length.
    """
    course = scene.run_up
    if course is None:
        problems.append(f"{scene.name}: [runup] missing; a run-up needs from, to, duration and step")
        return None
    longest = 1.0 / (LEAST_OVERSAMPLING * highest)
    if course.settings.step > longest * (1.0 + 1e-6):
        problems.append(
            f"{scene.name}: [runup] step: got {1e6 * course.settings.step:.4g} us; allowed: up to "
            f"{1e6 * longest:.4g} us for frequencies up to {HERTZ.text(highest)}; take smaller steps, or a "
            "lower --highest"
        )
    samples = course.duration / course.settings.step
    if not LEAST_SAMPLES <= samples <= MOST_SAMPLES:
        problems.append(
            f"{scene.name}: [runup] duration: got {course.duration:.4g} s, which is {samples:.4g} steps; allowed: "
            f"{LEAST_SAMPLES} to {MOST_SAMPLES}"
        )
        return None
    every_step = dataclasses.replace(course.settings, sample=course.settings.step)
    return dataclasses.replace(course, settings=every_step)


def silent_run(course: RunUp) -> RunSignal:
    """A silent run of a course: what does not fit it is said before minutes are spent, not after.

    Parameters
    ----------
    course : RunUp
        The run.

    Raises
    ------
    InputError
        If there is none.
    """
    samples = math.ceil(course.duration / course.settings.sample - 1e-9)
    times = np.asarray(np.arange(samples + 1) * course.settings.sample, dtype=np.float64)
    speed, angle = np.array([course.speed.at(at) for at in times.tolist()]).T
    return RunSignal(times, speed, angle, np.zeros_like(times))


def rehearsed(settings: CampbellSettings, course: RunUp, orders: Sequence[tuple[float, str]]) -> RunUpSpectra:
    """What a silent run of a course gives: windows, speeds and frequencies of any signal of it.

    Parameters
    ----------
    settings : CampbellSettings
        What is looked at.
    course : RunUp
        The run.
    orders : sequence of (float, str)
        Orders to follow, with their names.

    Raises
    ------
    InputError
        If settings and orders do not fit the run.
    """
    return run_up_spectra(silent_run(course), 1.0, settings.highest, settings.window, [order for order, _ in orders])


def recorded_run(
    model: Model,
    course: RunUp,
    sensors: Sequence[Sensor],
    told: Callable[[int], None] | None = None,
    *,
    nudge: float = 0.0,
) -> Recording:
    """Run up from the equilibrium at the first speed, and record sensors.

    Parameters
    ----------
    model : Model
        Scene with a law.
    course : RunUp
        The run.
    sensors : sequence of Sensor
        What is recorded.
    told : callable, optional
        Told the number of samples done.
    nudge : float
        Distance of all coordinates from their equilibrium at the beginning [m or rad], to see what becomes of it.

    Raises
    ------
    AnalysisError
        If there is no equilibrium, or a step finds no solution.
    """
    start = equilibrium(model.system, Operation(course.speed.at(0.0)[0]))
    return run_system(
        model.system,
        course_of(model, course),
        course.duration,
        course.settings,
        sensors=sensors,
        displacement=start.displacement + nudge,
        progress=told,
    )
