"""Dear ways of computing a contact: solved behind a layer, on rough surfaces, at a frequency, and from the film table.

Load sharing of film and asperities with solved films is what the rule of rough contact laws is measured against. A film
that carries the share g of the pressure is that of solids with the modulus g E' under the load g w (K. L. Johnson,
J. A. Greenwood, S. Y. Poon, Wear 19, 1972, 91). `ehdmaps.maps.rough_layer` scales it from the film between smooth
surfaces by a formula; here every film on the way is solved. Asperities are those of `ehdmaps.maps.asperities` in both.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.optimize import brentq

from ehdmaps.ehl.solver import ReynoldsSolver
from ehdmaps.errors import SolverError
from ehdmaps.jobs.budget.answers import Answer, Question, film_answer, known
from ehdmaps.maps.rough_layer import asperity_pressure, mean_gap
from ehdmaps.physics.contact import LineContact, OperatingPoint
from ehdmaps.physics.hertz import max_pressure
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.oil_supply import OilSupply
from ehdmaps.physics.solution import ContactSolver
from ehdmaps.physics.spectrum import contact_spectrum
from ehdmaps.physics.surface import Surface
from ehdmaps.table.file import film_table

LEAST_SHARE = 1e-3
"""Share of the film below which no balance is sought."""

THICK = 8.0
"""Film over the roughness from which on asperities carry nothing that a double can hold beside the load."""

STEP = 0.01
"""Step of the load for the compliance, relative; its error is of second order."""

_FARTHEST, _DEEPEST = 14.0, -35.0
_NEAR = 0.3
_CLOSE = 1e-9


@dataclass(frozen=True)
class SolvedSharing:
    """A rough contact whose film is solved.

    Attributes
    ----------
    share : float
        Part of the load that the film carries.
    offset : float
        Distance of the mean planes, what the film offset becomes [m]; below zero where they overlap.
    compliance : float
        -d(offset)/dw [m2/N].
    """

    share: float
    offset: float
    compliance: float


def solved_sharing(
    solver: ContactSolver, contact: LineContact, lubricant: Lubricant, point: OperatingPoint, surface: Surface
) -> SolvedSharing:
    """Share the load between a solved film and asperities.

    Parameters
    ----------
    solver : ContactSolver
        What solves the films between smooth surfaces.
    contact : LineContact
        The contact.
    lubricant : Lubricant
        The oil.
    point : OperatingPoint
        Load, speed and temperature.
    surface : Surface
        Rough surfaces.

    Raises
    ------
    SolverError
        Where a film has no solution, or it carries less than `LEAST_SHARE`.
    """
    film = _Film(solver, contact, lubricant, point, surface)
    share = film.share(point.load, LEAST_SHARE, 1.0)
    low, high = max(LEAST_SHARE, share * (1.0 - _NEAR)), min(1.0, share * (1.0 + _NEAR))
    less, more = ((1.0 + sign * STEP) * point.load for sign in (-1.0, 1.0))
    thick, thin = (film.offset(load, film.share(load, low, high)) for load in (less, more))
    return SolvedSharing(share, film.offset(point.load, share), (thick - thin) / (more - less))


@dataclass(frozen=True)
class _Film:
    """Films of soft solids at one speed and temperature."""

    solver: ContactSolver
    contact: LineContact
    lubricant: Lubricant
    point: OperatingPoint
    surface: Surface

    def thickness(self, load: float, share: float) -> float:
        """Film that carries a share of a load [m]."""
        material = self.contact.material
        soft = replace(self.contact, material=replace(material, youngs_modulus=share * material.youngs_modulus))
        speed, temperature = self.point.entrainment_speed, self.point.temperature
        (film,) = self.solver.solve_line(soft, self.lubricant, (share * load,), speed, temperature)
        if not film.status.usable:
            raise SolverError(f"film of the share {share:.3g}: {film.status.word}; {film.reason}")
        return film.film_offset

    def offset(self, load: float, share: float) -> float:
        """Distance of the mean planes at which a film of this share is the mean gap [m]."""
        sigma = self.surface.roughness
        film = self.thickness(load, share)
        if film > THICK * sigma:
            return film
        return sigma * float(brentq(lambda x: float(mean_gap(x)[0]) - film / sigma, _DEEPEST, _FARTHEST, xtol=1e-12))

    def share(self, load: float, low: float, high: float) -> float:
        """Share at which film and asperities carry the load, between two others."""
        pressure = 0.25 * math.pi * float(max_pressure(load, self.contact.radius, self.contact.reduced_modulus))

        def excess(log_share: float) -> float:
            share = math.exp(log_share)
            distance = self.offset(load, share) / self.surface.roughness
            if distance > THICK:
                return share - 1.0
            carried = float(asperity_pressure(self.surface, distance, self.contact.reduced_modulus)[0])
            return carried / pressure + share - 1.0

        ends = math.log(low), math.log(high)
        if high == 1.0 and excess(0.0) == 0.0:
            return 1.0
        if excess(ends[0]) > 0.0:
            raise SolverError(f"the film carries less than {low:.3g} of the load")
        return math.exp(brentq(excess, *ends, xtol=_CLOSE))


@dataclass(frozen=True)
class OnLayer:
    """The film behind an oil layer, solved with the place of its meniscus.

    Stiffness and film compliance are those of a contact whose meniscus follows until all of the layer goes through
    again, as for slow changes; damping is that of a meniscus that stays where it is.

    Attributes
    ----------
    solver : ReynoldsSolver
        The solver.
    supply : OilSupply
        Oil layer before the contact.
    """

    solver: ReynoldsSolver
    supply: OilSupply

    def __call__(self, question: Question) -> Answer:
        """Answer of the supplied film."""
        supplied = self.solver.supplied_film(question.contact, question.lubricant, question.point, self.supply)
        answer = film_answer(supplied.film, question)
        if answer.lost or not math.isfinite(supplied.supplied_compliance):
            return answer
        stiffness = 1.0 / (question.dry_compliance + supplied.supplied_compliance)
        following = {
            "film compliance": supplied.supplied_compliance,
            "stiffness": stiffness,
            "loss compliance": answer.values["damping"] / stiffness**2,
        }
        stated = {name: error for name, error in answer.stated.items() if name not in following}
        return Answer({**answer.values, **following}, stated)


@dataclass(frozen=True)
class RoughSolved:
    """Film and asperities, every film on the way to their balance solved. Damping is not known.

    Attributes
    ----------
    solver : ContactSolver
        What solves the films.
    surface : Surface
        Rough surfaces.
    """

    solver: ContactSolver
    surface: Surface

    def __call__(self, question: Question) -> Answer:
        """Answer of the balance."""
        contact, point = question.contact, question.point
        try:
            balance = solved_sharing(self.solver, contact, question.lubricant, point, self.surface)
        except SolverError as error:
            return Answer(lost=str(error))
        return Answer(
            {
                "approach": float(contact.structural_approach(point.load)) - balance.offset,
                "stiffness": 1.0 / (question.dry_compliance + balance.compliance),
                "film offset": balance.offset,
                "film compliance": balance.compliance,
            }
        )


@dataclass(frozen=True)
class AtFrequency:
    """Stiffness and damping at the frequency, from the linearised equations there.

    Attributes
    ----------
    solver : ContactSolver
        The solver; one whose films have no memory gives its limit of slow motion.
    """

    solver: ContactSolver

    def __call__(self, question: Question) -> Answer:
        """Answer of the response."""
        contact, point = question.contact, question.point
        film = self.solver.film_spectrum(contact, question.lubricant, point, np.array([question.frequency]))
        if not film.film.status.usable:
            return film_answer(film.film, question)
        spectrum = contact_spectrum(film, contact, point)
        k, c = float(spectrum.stiffness[0]), float(spectrum.damping[0])
        stated = {
            "stiffness": abs(k) * float(spectrum.stiffness_error[0]),
            "damping": abs(c) * float(spectrum.damping_error[0]),
        }
        return Answer({"stiffness": k, "damping": c}, known(stated))


@dataclass(frozen=True)
class FromTable:
    """Films from the film table, all points of a contact in one call."""

    def __call__(self, question: Question) -> Answer:
        """Answer of one point."""
        return self.many([question])[0]

    def many(self, questions: Sequence[Question]) -> tuple[Answer, ...]:
        """Answers to several questions.

        Parameters
        ----------
        questions : sequence of Question
            Contacts at operating points, of one oil.
        """
        answers: dict[int, Answer] = {}
        for contact in dict.fromkeys(question.contact for question in questions):
            places = [index for index, question in enumerate(questions) if question.contact == contact]
            here = [questions[index] for index in places]
            w, u, T = (
                np.array([getattr(question.point, name) for question in here])
                for name in ("load", "entrainment_speed", "temperature")
            )
            oil = here[0].lubricant
            read = film_table(oil).films(contact, oil, w, u, T, thickest_film=math.inf)
            for row, index in enumerate(places):
                answers[index] = film_answer(read.solution(row), questions[index])
        return tuple(answers[index] for index in range(len(questions)))
