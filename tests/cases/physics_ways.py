"""Points by solvers with different physics: their films and what they cost, or that such a solver is not there.

A solver is made with the words of `[solver]` in a job. One that does not know a word is no error here: a table has a
row for it that says so.
"""

from __future__ import annotations

import resource
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from ehdmaps.errors import InputError
from ehdmaps.physics.contact import LineContact, OperatingPoint
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.solution import ContactSolver, FilmSolution

WAYS: Mapping[str, Mapping[str, str]] = {
    "newtonian": {},
    "limiting": {"shear": "limiting"},
    "inlet-heat": {"physics": "inlet-heat"},
    "thermal": {"physics": "thermal"},
    "thermal, limiting": {"physics": "thermal", "shear": "limiting"},
}
"""What the films know, in words of `[solver]`; the numbers of the laws are their defaults."""

LONG = 0.5
"""Processor time after which a point is not solved once more [s]."""

NOT_THERE = "not there"
"""Word of an answer where a solver does not know what it is asked for."""


@dataclass(frozen=True)
class Answer:
    """A film with its processor time, of children too [s]; or no film and a word for why."""

    film: FilmSolution | None
    seconds: float = 0.0
    word: str = NOT_THERE

    @property
    def usable(self) -> bool:
        """Whether there is a solution."""
        return self.film is not None and self.film.status.usable

    def stiffness(self, contact: LineContact, load: float) -> float:
        """Stiffness of the whole contact [N/m2]."""
        assert self.film is not None
        return 1.0 / (contact.structural_compliance(load) + self.film.film_compliance)

    def damping(self, contact: LineContact, load: float) -> float:
        """Damping of the whole contact [N s/m2]."""
        assert self.film is not None
        return self.film.loss_compliance * self.stiffness(contact, load) ** 2


def _reynolds(**options: Any) -> ContactSolver:
    from ehdmaps.ehl.solver import ReynoldsSolver

    return ReynoldsSolver(**options)


def _openfoam(flow: str) -> Callable[..., ContactSolver]:
    def make(**options: Any) -> ContactSolver:
        from ehdmaps.ehl.start import reynolds_start
        from ehdmaps.openfoam.solver import OpenFoamSolver

        return OpenFoamSolver(flow=flow, starter=reynolds_start, **options)

    return make


SOLVERS: Mapping[str, Callable[..., ContactSolver]] = {
    "reynolds": _reynolds,
    "thin_film": _openfoam("thin_film"),
    "full_stress": _openfoam("full_stress"),
}
"""Solvers by the names that tables give them; the last two are flows of `openfoam`."""


def processor_seconds() -> float:
    """Processor time of this process and of its children that have ended [s]."""
    spent = [resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
    return sum(each.ru_utime + each.ru_stime for each in spent)


def solver_of(name: str, way: str, **settings: Any) -> ContactSolver | None:
    """Make a solver with the physics of a way; None where it does not know a key or a word of that."""
    try:
        return SOLVERS[name](**WAYS[way], **settings)
    except (TypeError, InputError):
        SOLVERS[name](**settings)  # another cause is an error
        return None


def answer(
    solver: ContactSolver | None, contact: LineContact, oil: Lubricant, point: OperatingPoint, repeats: int = 1
) -> Answer:
    """Solve a point up to as many times, for the least time; what a solver refuses at the point is its status."""
    if solver is None:
        return Answer(None)
    times: list[float] = []
    while len(times) < repeats and sum(times) < LONG:
        began = processor_seconds()
        (film,) = solver.solve_line(contact, oil, (point.load,), point.entrainment_speed, point.temperature)
        times.append(processor_seconds() - began)
    return Answer(film, min(times), film.status.word)
