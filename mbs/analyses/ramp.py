"""The run-up of a scene: its course, by torques too, what is recorded, and what its steps resolve."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from ehdmaps.arrays import FloatArray
from mbs.analyses.losses import losses_over_speed
from mbs.linearised.averaged import steady_system
from mbs.linearised.modes import free_motions, undamped_modes
from mbs.model.drive import Drive, DrivenSpeed, TorqueCurve
from mbs.model.elements import Operation, Sensor
from mbs.model.equilibrium import equilibrium
from mbs.model.profiles import SpeedProfile
from mbs.scene.assembly import Model
from mbs.scene.fields import HERTZ, MICROSECOND, MILLISECOND
from mbs.scene.scene import Scene
from mbs.settings import CampbellSettings, RunUp
from mbs.spectral.campbell import RunUpSpectra, run_up_spectra
from mbs.spectral.run_signal import RunSignal
from mbs.spectral.spectra import LEAST_OVERSAMPLING
from mbs.transient.run import Options, Recording
from mbs.transient.run import run as run_system
from mbs.transient.stepping import RESOLVED, energy_lost, numerical_damping_ratio

SPEEDS = 8
"""Speeds at which the rolling torque is found, between rest and the highest one of the drive alone."""


def course_of(model: Model, course: RunUp) -> SpeedProfile:
    """The speed of a run; where it follows from torques, with the rolling torque of the bearings of a model.

    Parameters
    ----------
    model : Model
        Scene with its law, in operation. Its films take a torque where its map has rolling forces.
    course : RunUp
        The run.

    Raises
    ------
    AnalysisError
        If there is no equilibrium at a speed.
    """
    speed = course.speed
    if not isinstance(speed, DrivenSpeed) or not model.on_rings:
        return speed
    speeds = max(map(abs, speed.course.values)) * np.arange(1, SPEEDS + 1) / SPEEDS
    if speeds[0] <= 0.0:
        return speed
    system = steady_system(model.system)
    displacements = [equilibrium(system, Operation(at)).displacement for at in speeds.tolist()]
    power = losses_over_speed([model] * SPEEDS, speeds, np.array(displacements))[1].sum(axis=1)
    if not np.all(np.isfinite(power)):
        return speed
    return DrivenSpeed.of(_resisted(speed.drive, speeds, power / speeds), speed.course.values[0], course.duration)


def _resisted(drive: Drive, speeds: FloatArray, torques: FloatArray) -> Drive:
    """The drive with a torque over speed more that resists."""
    rolling = TorqueCurve(tuple(speeds.tolist()), tuple(torques.tolist()))
    at = tuple(sorted({*drive.load.speeds, *rolling.speeds}))
    load = TorqueCurve(at, tuple(drive.load(w) + rolling(w) for w in at))
    return dataclasses.replace(drive, load=load)


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
    """Outcome of a silent run of a course: windows, speeds and frequencies of any signal of it.

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
    marks: bool = False,
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
    marks : bool
        Whether states are kept from which the run can go on.

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
        displacement=start.displacement,
        progress=told,
        options=Options(marks=marks),
    )


@dataclass(frozen=True)
class Resolution:
    """Resolution of the steps of a run.

    Attributes
    ----------
    step, spectral_radius : float
        Length of the steps [s]; spectral radius of the method.
    highest : float
        Highest frequency of which a period has `RESOLVED` steps [Hz].
    lowest_mode : float
        Lowest natural frequency at the first speed, without free motions and damping [Hz]; NaN if there is none.
    excitation : float
        Highest frequency at which gears mesh, or else rollers pass [Hz]; NaN without either.
    looked_at : float
        Highest frequency that is of interest [Hz].
    """

    step: float
    spectral_radius: float
    highest: float
    lowest_mode: float
    excitation: float
    looked_at: float

    @property
    def unresolved(self) -> tuple[str, ...]:
        """Frequencies for which steps are too long, in words."""
        named = (
            ("the lowest mode of the system is at", self.lowest_mode),
            ("it is excited with up to", self.excitation),
        )
        return tuple(f"{words} {value:.4g} Hz" for words, value in named if value > self.highest)

    @property
    def needed(self) -> float:
        """Longest step that would resolve what is not [s]; the step itself where all is resolved."""
        worst = np.nanmax([self.highest, self.lowest_mode, self.excitation])
        return self.step * self.highest / float(worst)

    def lost(self, frequency: float) -> float:
        """Part of the energy of an oscillation that the method takes in a second, 0 to 1.

        Parameters
        ----------
        frequency : float
            Frequency of the oscillation [Hz].
        """
        return energy_lost(self.spectral_radius, self.step, frequency)

    def ratio(self, frequency: float) -> float:
        """Damping ratio that takes as much.

        Parameters
        ----------
        frequency : float
            Frequency of the oscillation [Hz].
        """
        return numerical_damping_ratio(self.spectral_radius, self.step, frequency)


def resolution(model: Model, course: RunUp) -> Resolution:
    """Find what the steps of a run resolve of its modes at the first speed, and of its excitation.

    Parameters
    ----------
    model : Model
        Scene with its law.
    course : RunUp
        Speed and steps.

    Raises
    ------
    AnalysisError
        If there is no equilibrium at the first speed.
    """
    balance = equilibrium(model.system, Operation(course.speed.at(0.0)[0]))
    found = undamped_modes(balance).frequency
    swinging = found[~free_motions(found)]
    fastest = float(np.max(np.abs(course.speed.course.values))) / (2.0 * np.pi)
    excitations = [entry for one in model.system.elements if (entry := one.element.excitation) is not None]
    rank = max((entry.rank for entry in excitations), default=0)
    orders = [entry.order for entry in excitations if entry.rank == rank]
    settings = course.settings
    return Resolution(
        settings.step,
        settings.spectral_radius,
        1.0 / (RESOLVED * settings.step),
        float(swinging.min()) if swinging.size else float("nan"),
        max(orders) * fastest if orders else float("nan"),
        model.scene.campbell.highest,
    )


def step_lines(found: Resolution) -> list[str]:
    """Lines on what the steps of a run resolve, and on what the method takes from oscillations.

    Parameters
    ----------
    found : Resolution
        What they resolve.
    """
    high = min(found.highest, found.looked_at)
    losses = " and ".join(_lost(found, part * high) for part in (0.5, 1.0))
    taken = (
        "the method of integration takes no energy (spectral radius 1)"
        if found.spectral_radius == 1.0
        else f"numerical damping (spectral radius {found.spectral_radius:g}) takes {losses} of the energy of an "
        "oscillation in 1 s"
    )
    step = MICROSECOND.text(found.step) if found.step < 1e-3 else MILLISECOND.text(found.step)
    lines = [f"steps of {step}: {RESOLVED:g} a period at {HERTZ.text(found.highest)}; {taken}"]
    if found.unresolved:
        needed = MICROSECOND.text(found.needed, 3) if found.needed < 1e-3 else MILLISECOND.text(found.needed, 3)
        lines.append(
            f"warning: steps of {step} do not resolve what moves here: {', and '.join(found.unresolved)}; this run "
            f"is a row of equilibria at best; take steps of {needed} or less in [runup]"
        )
    return lines


def _lost(found: Resolution, frequency: float) -> str:
    """Tell how much an oscillation loses in a second, and the damping ratio that takes as much."""
    part = found.lost(frequency)
    words = f"{100.0 * part:.3g} %" if 1e-6 < part < 0.9995 else "less than 0.0001 %" if part < 0.5 else "all"
    return f"{words} at {HERTZ.text(frequency)} (a damping ratio of {found.ratio(frequency):.2g})"
