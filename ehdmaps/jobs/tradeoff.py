"""Speed against accuracy, measured: solvers and settings on a sample of a job, against a fine solve."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ehdmaps.arrays import BoolArray, FloatArray
from ehdmaps.jobs import solvers
from ehdmaps.jobs.job import Job
from ehdmaps.jobs.tasks import LineTask, film_arrays, line_tasks
from ehdmaps.physics.solution import ContactSolver, Status
from ehdmaps.units import LOAD, SPEED, TEMPERATURE

JUDGED = ("film_offset", "film_compliance", "loss_compliance", "central_film", "minimum_film")
REFINEMENT = 4
"""Grid density of the reference over that of the default; its inlet is twice as long."""

_RESOLUTIONS = (0.5, 0.7, 1.0, 1.4, 2.0)
"""Grid densities that are measured, over that of the default."""

_DENSITIES = (3.0, 60.0)


@dataclass(frozen=True)
class Contestant:
    """One solver with its settings, and what it is called in the table."""

    label: str
    solver: ContactSolver


@dataclass(frozen=True)
class Measured:
    """What one contestant did on the sample.

    Attributes
    ----------
    label : str
        Name of the contestant.
    seconds_per_point : float
        Wall time on one core.
    solved : int
        Points with a usable status.
    lost : tuple of str
        Points of the reference without a solution, each with its place and cause: nothing is compared there.
    errors : dict
        Relative errors by variable, at the points that it and the reference solved.
    """

    label: str
    seconds_per_point: float
    solved: int
    lost: tuple[str, ...]
    errors: dict[str, FloatArray]


def contestants(job: Job) -> tuple[tuple[Contestant, ...], Contestant]:
    """Return who is measured, and the reference; the one place to change either."""
    own = dict(job.solver_options) if job.solver == "reynolds" else {}
    settings = solvers.build("reynolds", own).settings()
    density, inlet = float(settings["density"]), float(settings["inlet_length"])

    def reynolds(factor: float, **further: float) -> Contestant:
        used = round(min(max(density * factor, _DENSITIES[0]), _DENSITIES[1]), 2)
        return Contestant(f"reynolds, density {used:g}", solvers.build("reynolds", {**own, "density": used, **further}))

    field = [Contestant("hertz", solvers.build("hertz", {}))]
    field += [
        Contestant(f"formula, {formula}", solvers.build("formula", {"film_formula": formula}))
        for formula in ("moes", "dowson-toyoda", "pan-hamrock")
    ]
    field += [reynolds(factor) for factor in _RESOLUTIONS]
    return tuple(field), reynolds(REFINEMENT, inlet_length=2.0 * inlet)


def measure(
    job: Job, lines: int, entries: Sequence[Contestant], reference: Contestant
) -> tuple[tuple[Measured, ...], Measured]:
    """Solve a sample of load lines with every contestant and the reference.

    Parameters
    ----------
    job : Job
        Job whose lines are sampled evenly.
    lines : int
        How many.
    entries : sequence of Contestant
        Measured one after the other, on one core.
    reference : Contestant
        What the others are compared with.

    Returns
    -------
    measured : tuple of Measured
        One a contestant.
    truth : Measured
        The reference itself, without errors, with the points that it could not solve.
    """
    chosen = _sample(job, lines)
    truth, seconds = _solve(reference.solver, chosen)
    known = _usable(truth["status"])
    lost = _lost(chosen, truth)
    measured = []
    for entry in entries:
        films, spent = _solve(entry.solver, chosen)
        both = known & _usable(films["status"])
        errors = {}
        for name in JUDGED:
            scale = np.abs(truth[name][both])
            difference = np.abs(films[name][both] - truth[name][both])
            errors[name] = difference[scale > 0] / scale[scale > 0]
        measured.append(Measured(entry.label, spent / known.size, int(_usable(films["status"]).sum()), (), errors))
    return tuple(measured), Measured(reference.label, seconds / known.size, int(known.sum()), lost, {})


def table(measured: Sequence[Measured], truth: Measured, points: int) -> str:
    """Return the measurement as a printed table.

    Parameters
    ----------
    measured : sequence of Measured
        Settings with their cost and errors.
    truth : Measured
        The fine solution that errors are measured against.
    points : int
        Number of points of the measurement.
    """
    lines = [
        f"{points} points; errors relative to {truth.label} ({truth.seconds_per_point * 1e3:.3g} ms a point, "
        f"{truth.solved} solved); median / 95 %",
        f"{'':26s}{'ms/point':>9s}{'solved':>8s}" + "".join(f"{name.replace('_', ' '):>20s}" for name in JUDGED),
    ]
    for entry in measured:
        cells = []
        for name in JUDGED:
            errors = entry.errors[name]
            if errors.size:
                middle, high = (float(value) for value in np.quantile(errors, (0.5, 0.95)))
                cells.append(f"{middle:.1e} / {high:.1e}")
            else:
                cells.append("-")
        numbers = f"{entry.seconds_per_point * 1e3:9.3g}{entry.solved:8d}"
        lines.append(f"{entry.label:26s}{numbers}" + "".join(f"{cell:>20s}" for cell in cells))
    if truth.lost:
        lines.append(f"without a solution by {truth.label}, and left out of the errors:")
        lines += [f"  {point}" for point in truth.lost]
    return "\n".join(lines)


def _sample(job: Job, lines: int) -> tuple[LineTask, ...]:
    """Return lines spread over contacts, speeds and temperatures; the same ones each time."""
    tasks = line_tasks(job, solvers.build("hertz", {}))
    order = np.random.default_rng(0).permutation(len(tasks))[:lines]
    return tuple(tasks[index] for index in sorted(order))


def _solve(solver: ContactSolver, chosen: Sequence[LineTask]) -> tuple[dict[str, FloatArray], float]:
    """Return the films of all lines, and the time; a first solve that compiles is not in it."""
    first = chosen[0]
    solver.solve_line(first.contact, first.lubricant, first.loads[:1], first.entrainment_speed, first.temperature)
    begin = time.perf_counter()
    films = [
        film
        for line in chosen
        for film in solver.solve_line(
            line.contact, line.lubricant, line.loads, line.entrainment_speed, line.temperature
        )
    ]
    return film_arrays(films), time.perf_counter() - begin


def _lost(chosen: Sequence[LineTask], truth: dict[str, FloatArray]) -> tuple[str, ...]:
    """Place, status and cause of each point without a solution."""
    points = [(line, load) for line in chosen for load in line.loads]
    return tuple(
        f"{line.contact.name}, {LOAD.text(load)}, {SPEED.text(line.entrainment_speed)}, "
        f"{TEMPERATURE.text(line.temperature)}: {Status(int(status)).word}" + (f"; {reason}" if reason else "")
        for (line, load), status, reason in zip(points, truth["status"], truth["reason"], strict=True)
        if not Status(int(status)).usable
    )


def _usable(status: FloatArray) -> BoolArray:
    """Whether points have a solution."""
    return np.isin(status, [int(known) for known in Status if known.usable])
