"""What a contact law gives at random points, and how far that is from fresh solves there."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ehdmaps.arrays import BoolArray, FloatArray
from ehdmaps.jobs.job import Job
from ehdmaps.jobs.sampling import draw_apart
from ehdmaps.jobs.store import Arrays
from ehdmaps.jobs.tasks import LineTask
from ehdmaps.maps.film_field import FilmField
from ehdmaps.maps.law import ContactLaw
from ehdmaps.physics.contact import LineContact, OperatingPoint
from ehdmaps.physics.hertz import half_width
from ehdmaps.physics.solution import ContactSolution, ContactSolver, FilmSolution, Status, contact_solution
from ehdmaps.units import LOAD, SPEED, TEMPERATURE

STIFFNESS, DAMPING, OFFSET, APPROACH = "stiffness", "damping", "film offset", "approach"
"""Quantities of `errors_of`."""

COMPLIANCE_BARS, DAMPING_BARS = (0.01, 1e-4), (0.05, 1e-3)
"""An error is within its bar where it is below a share of the film compliance or of 1/k; of c or of k b/u."""

READ_COMPLIANCE_BARS = (0.01, 1e-3)
"""The bar of film compliance for laws whose films are read from the film table: a thousandth of a stiffness. Whoever
needs more has the films solved."""

SMALL_DAMPING = DAMPING_BARS[1] / DAMPING_BARS[0]
"""Damping, as a share of k b/u, below which an error is related to this share: damping runs through zero in its valley,
and a share of nothing is no measure."""

SMALL_OFFSET = COMPLIANCE_BARS[1] / COMPLIANCE_BARS[0]
"""Film offset, as a share of the elastic approach, below which an error is related to this share: an approach that is
wrong by 1e-4 of itself is a load that is, however thin the film."""


@dataclass(frozen=True)
class RandomPoints:
    """Random points of a job, and which of them were drawn inside the damping valley."""

    tasks: tuple[LineTask, ...]
    valley: BoolArray


@dataclass(frozen=True)
class FreshPoints:
    """Random points with their fresh solutions, usable ones only; `lost` names the others with their cause."""

    tasks: tuple[LineTask, ...]
    valley: BoolArray
    solutions: tuple[ContactSolution, ...]
    lost: tuple[str, ...]

    @property
    def places(self) -> tuple[str, ...]:
        """Where they are, in words."""
        return tuple(place(task) for task in self.tasks)


def random_points(job: Job, solver: ContactSolver, count: int, rng: np.random.Generator) -> RandomPoints:
    """Draw points of a job, to be solved one by one, each from nothing.

    Parameters
    ----------
    job : Job
        Job over whose axes is drawn.
    solver : ContactSolver
        What solves them.
    count : int
        How many; a fifth of them inside the damping valley.
    rng : numpy.random.Generator
        Source of chance.
    """
    over, valley = draw_apart(job, rng, count)
    tasks = tuple(LineTask(p.contact, job.lubricant, (p.load,), p.speed, p.temperature, solver) for p in over + valley)
    return RandomPoints(tasks, np.arange(len(tasks)) >= len(over))


def by_solver(tasks: Sequence[LineTask], solver: ContactSolver) -> tuple[LineTask, ...]:
    """The same points, to be solved by another solver.

    Parameters
    ----------
    tasks : sequence of LineTask
        Points, one each.
    solver : ContactSolver
        What solves them.
    """
    return tuple(replace(task, solver=solver) for task in tasks)


def fresh_points(points: RandomPoints, results: Mapping[str, Arrays]) -> FreshPoints:
    """Points that have a usable solution.

    Parameters
    ----------
    points : RandomPoints
        The points.
    results : mapping
        Arrays by key of the tasks.
    """
    found = [fresh_solution(task, results[task.key]) for task in points.tasks]
    usable = np.array([one.status.usable for one in found], dtype=bool)
    return FreshPoints(
        tasks=tuple(task for task, known in zip(points.tasks, usable, strict=True) if known),
        valley=points.valley[usable],
        solutions=tuple(one for one in found if one.status.usable),
        lost=tuple(
            f"{place(task)}: {one.status.word}" + (f"; {one.reason}" if one.reason else "")
            for task, one in zip(points.tasks, found, strict=True)
            if not one.status.usable
        ),
    )


def fresh_solution(task: LineTask, arrays: Arrays) -> ContactSolution:
    """The first point of a line with its structure.

    Parameters
    ----------
    task : LineTask
        The line.
    arrays : Arrays
        Films of the line.
    """
    film = FilmSolution(
        **{name: array[0].item() for name, array in arrays.items() if name != "status" and array.ndim == 1},
        status=Status(int(arrays["status"][0])),
    )
    point = OperatingPoint(task.loads[0], task.entrainment_speed, task.temperature)
    return contact_solution(film, task.contact, point)


def place(task: LineTask) -> str:
    """Where the first point of a line is, in words.

    Parameters
    ----------
    task : LineTask
        The line.
    """
    where = LOAD.text(task.loads[0]), SPEED.text(task.entrainment_speed), TEMPERATURE.text(task.temperature)
    return f"{task.contact.name}, {', '.join(where)}"


def at_loads(
    law: ContactLaw, approach: FloatArray, load: FloatArray, speed: FloatArray, temperature: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Approach [m] at which a law of one contact has these loads, with stiffness [N/m2] and damping [N s/m2] there.

    Parameters
    ----------
    law : ContactLaw
        Law of one contact.
    approach : array (n,)
        Begin of the search [m].
    load, speed, temperature : array (n,)
        [N/m], [m/s] and [K].
    """
    dry = np.array([law.contacts[0].structural_compliance(float(w)) for w in load])
    approach = approach.copy()
    for _ in range(8):
        found, stiffness, damping = law(approach, 0.0, speed, temperature)
        approach -= (found - load) / np.maximum(stiffness, 1e-12 / dry)
    _, stiffness, damping = law(approach, 0.0, speed, temperature)
    return approach, stiffness, damping


def law_values(laws: Mapping[str, ContactLaw], points: FreshPoints) -> dict[str, FloatArray]:
    """What the laws of single contacts give at the loads of points.

    Parameters
    ----------
    laws : mapping of str to ContactLaw
        Law of each contact by its name, with the policy `clamp`: the way to a load may lead above the highest one.
    points : FreshPoints
        The points.

    Returns
    -------
    dict
        Arrays (n,) by the names of the quantities, in SI.
    """
    values = {name: np.full(len(points.tasks), np.nan) for name in (STIFFNESS, DAMPING, OFFSET, APPROACH)}
    names = np.array([task.contact.name for task in points.tasks])
    for name, law in laws.items():
        here = np.flatnonzero(names == name)
        if not here.size:
            continue
        (contact,) = law.contacts
        tasks = [points.tasks[i] for i in here]
        load = np.array([task.loads[0] for task in tasks])
        solids = np.array([contact.structural_approach(float(w)) for w in load])
        begin = solids - np.array([points.solutions[i].film_offset for i in here])
        speed = np.array([task.entrainment_speed for task in tasks])
        approach, stiffness, damping = at_loads(law, begin, load, speed, np.array([t.temperature for t in tasks]))
        values[STIFFNESS][here], values[DAMPING][here] = stiffness, damping
        values[OFFSET][here], values[APPROACH][here] = solids - approach, approach
    return values


def film_values(fields: Mapping[str, FilmField], points: FreshPoints) -> dict[str, FloatArray]:
    """The same of the films that laws are made from, without the table of a law.

    Parameters
    ----------
    fields : mapping of str to FilmField
        Films of each contact by its name.
    points : FreshPoints
        The points.
    """
    rows = []
    for task in points.tasks:
        contact, (load,) = task.contact, task.loads
        at = np.array([[[load]]]), np.array([task.entrainment_speed]), np.array([task.temperature])
        offset, compliance, loss = (float(one[0, 0, 0]) for one in fields[contact.name].films(contact.name, *at))
        stiffness = 1.0 / (contact.structural_compliance(load) + compliance)
        rows.append((stiffness, loss * stiffness**2, offset, contact.structural_approach(load) - offset))
    columns = np.array(rows, dtype=np.float64).reshape(-1, 4).T
    return dict(zip((STIFFNESS, DAMPING, OFFSET, APPROACH), columns, strict=True))


def solved_values(solutions: Sequence[ContactSolution], tasks: Sequence[LineTask]) -> dict[str, FloatArray]:
    """The same quantities of solutions; a damping below zero is zero, as a law has it.

    Parameters
    ----------
    solutions : sequence of ContactSolution
        The solutions.
    tasks : sequence of LineTask
        Their points.
    """
    solids = np.array([task.contact.structural_approach(task.loads[0]) for task in tasks])
    offset = np.array([one.film_offset for one in solutions])
    return {
        STIFFNESS: np.array([one.stiffness for one in solutions]),
        DAMPING: np.maximum([one.damping for one in solutions], 0.0),
        OFFSET: offset,
        APPROACH: solids - offset,
    }


def errors_of(values: Mapping[str, FloatArray], points: FreshPoints) -> dict[str, FloatArray]:
    """Signed relative errors against fresh solutions, by quantity; shape (n,).

    Stiffness relative to k; damping to c, or to `SMALL_DAMPING` k b/u where c is less; film offset to h, or to
    `SMALL_OFFSET` of the elastic approach where h is less; the approach to the sum of the elastic one and h.

    Parameters
    ----------
    values : mapping
        Values of a law, or of other solutions of the same points.
    points : FreshPoints
        The points.
    """
    true, scales = solved_values(points.solutions, points.tasks), _scales(points)
    return {name: (values[name] - true[name]) / scales[name] for name in scales}


def judged_by_share(points: FreshPoints) -> float:
    """Share of the points whose error of damping is related to c itself, and not to `SMALL_DAMPING` k b/u; NaN of none.

    Parameters
    ----------
    points : FreshPoints
        The points.
    """
    damping = solved_values(points.solutions, points.tasks)[DAMPING]
    return float(np.mean(damping >= _scales(points)[DAMPING])) if damping.size else float("nan")


def _scales(points: FreshPoints) -> dict[str, FloatArray]:
    """What errors are related to."""
    true = solved_values(points.solutions, points.tasks)
    solids = true[APPROACH] + true[OFFSET]
    time = np.array([_half(task.contact, task.loads[0]) / task.entrainment_speed for task in points.tasks])
    return {
        STIFFNESS: true[STIFFNESS],
        DAMPING: np.maximum(true[DAMPING], SMALL_DAMPING * true[STIFFNESS] * time),
        OFFSET: np.maximum(true[OFFSET], SMALL_OFFSET * solids),
        APPROACH: solids + true[OFFSET],
    }


def _half(contact: LineContact, load: float) -> float:
    """Hertz half-width [m]."""
    return float(half_width(load, contact.radius, contact.reduced_modulus))
