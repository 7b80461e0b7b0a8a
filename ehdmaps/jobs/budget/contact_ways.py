"""Question asked of a contact at one operating point, and the answer of one way of computing it.

An answer has what a user looks at: approach, films, stiffness, damping, and the compliances of the film. Errors are
relative to the value of a reference. Three quantities go through zero, and take the larger of two scales:

- approach: the dry approach and the film offset together, since the one is taken off the other;
- film compliance: a hundredth of 1/k, where the film hardly gives way beside the solids;
- damping and loss compliance: a fiftieth of k b/u and of b/(u k), since c of an isothermal, Newtonian film goes through
  zero in the damping valley and is below zero at its bottom. Values are compared as they are solved, below zero too.

The last two are the ratios of the bars to which `ehdmaps.jobs.make.law_check` holds contact laws.

Ways of computing a contact, from one question to one answer: solvers, rules of contact laws, other data.

Each is a frozen value that is called with a `Question`. What is dearer is in `mbs.laboratory.tradeoff.contestants`.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from textwrap import shorten
from typing import Any, Protocol

import numpy as np
from scipy.interpolate import CubicSpline

from ehdmaps.jobs.make.sampling import COMPLIANCE_BARS, DAMPING_BARS
from ehdmaps.maps.contact_curve import FilmSamples, Tail
from ehdmaps.maps.kernels.locked_film import film_of, fitted_factors, locked_stiffness, response_error
from ehdmaps.maps.law import ContactLaw
from ehdmaps.maps.oil_layer import OilLayer
from ehdmaps.maps.rolling_film import FlowFilm
from ehdmaps.maps.rough_layer import RoughLayer
from ehdmaps.physics.approach import StructuralLaw
from ehdmaps.physics.bearing import BearingGeometry, with_law
from ehdmaps.physics.contact import LineContact, OperatingPoint
from ehdmaps.physics.hertz import half_width
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.oil_supply import OilSupply
from ehdmaps.physics.solution import ContactSolver, ContactSolverDefaults, FilmSolution, contact_solution
from ehdmaps.physics.surface import Surface
from ehdmaps.table.file import film_table
from ehdmaps.units import point_text

QUANTITIES = (
    "approach",
    "stiffness",
    "damping",
    "film offset",
    "central film",
    "minimum film",
    "film compliance",
    "loss compliance",
)
"""What is judged, by the names of the columns; they are those of a map's variables with a blank for "_"."""

COMPLIANCE_SHARE = COMPLIANCE_BARS[1] / COMPLIANCE_BARS[0]
"""Film compliance that an error is relative to at least, over 1/k."""

DAMPING_SHARE = DAMPING_BARS[1] / DAMPING_BARS[0]
"""Damping that an error is relative to at least, over k b/u."""

_LONGEST = 200


@dataclass(frozen=True)
class Question:
    """One contact at one operating point.

    Attributes
    ----------
    contact : LineContact
        The contact.
    lubricant : Lubricant
        The oil.
    point : OperatingPoint
        Load, speed and temperature; the speed is above zero.
    frequency : float
        Frequency of a small oscillation [Hz], for what is asked over frequency.
    """

    contact: LineContact
    lubricant: Lubricant
    point: OperatingPoint
    frequency: float

    @property
    def place(self) -> str:
        """Contact, load, speed and temperature, in words."""
        at = self.point
        return f"{self.contact.name}, {point_text(at.load, at.entrainment_speed, at.temperature)}"

    @property
    def dry_compliance(self) -> float:
        """d(delta_el)/dw of the solids [m2/N]."""
        return float(self.contact.structural_compliance(self.point.load))

    @property
    def passing_time(self) -> float:
        """b/u, in which the surfaces pass through half of the dry contact [s]."""
        half = half_width(self.point.load, self.contact.radius, self.contact.reduced_modulus)
        return float(half) / self.point.entrainment_speed


@dataclass(frozen=True)
class Answer:
    """Result of one way of computing a contact.

    Attributes
    ----------
    values : mapping of str to float
        Values by quantity, SI, per unit length; a quantity that is not known is left out.
    stated : mapping of str to float
        Numerical errors that the way states of itself, in the units of the values; those that it states.
    lost : str
        Why there is no answer; empty where there is one.
    """

    values: Mapping[str, float] = field(default_factory=dict)
    stated: Mapping[str, float] = field(default_factory=dict)
    lost: str = ""


def film_answer(film: FilmSolution, question: Question) -> Answer:
    """Answer that follows from a film.

    Parameters
    ----------
    film : FilmSolution
        The film, in the limit of slow motion.
    question : Question
        What it belongs to.
    """
    if not film.status.usable:
        # of a program's log the beginning is enough here
        return Answer(
            lost=shorten("; ".join(filter(None, (film.status.word, film.reason))), _LONGEST, placeholder=" ...")
        )
    solution = contact_solution(film, question.contact, question.point)
    values = {name: float(getattr(solution, name.replace(" ", "_"))) for name in QUANTITIES}
    stated = {
        name: abs(getattr(solution, f"{name.replace(' ', '_')}_error") * values[name])
        for name in QUANTITIES
        if name != "approach"
    }
    # the solids are exact: the approach has the error of the film offset
    stated["approach"] = stated["film offset"]
    return Answer(known(values), known(stated))


def known(values: Mapping[str, float]) -> dict[str, float]:
    """Values that are numbers.

    Parameters
    ----------
    values : mapping of str to float
        Values by name; NaN where one is not known.
    """
    return {name: value for name, value in values.items() if math.isfinite(value)}


def scales(truth: Answer, question: Question, least_film: float = 0.0) -> dict[str, float]:
    """Scales that errors are relative to, by quantity, in the units of the values.

    Parameters
    ----------
    truth : Answer
        Answer of the reference.
    question : Question
        What was asked.
    least_film : float
        Film that errors of films are relative to at least [m].
    """
    sizes = {name: abs(value) for name, value in truth.values.items()}
    stiffness, time = sizes.get("stiffness", math.nan), question.passing_time
    floors = {
        "approach": float(question.contact.structural_approach(question.point.load)) + sizes.get("film offset", 0.0),
        "film compliance": COMPLIANCE_SHARE / stiffness,
        "damping": DAMPING_SHARE * stiffness * time,
        "loss compliance": DAMPING_SHARE * time / stiffness,
        "film offset": least_film,
        "central film": least_film,
        "minimum film": least_film,
    }
    return {name: max(value, floors.get(name, 0.0)) for name, value in sizes.items()}


_STEP = 0.01
"""Step of the load over which the flow of the flooded film is read, relative."""

_CLOSE, _MOST_STEPS = 1e-9, 50
"""When the approach of a law is found, and steps after which it is not sought any more."""


class ContactModel(Protocol):
    """A way of computing a contact."""

    def __call__(self, question: Question) -> Answer:
        """Answer a question.

        Parameters
        ----------
        question : Question
            One contact at one operating point.
        """
        ...


@dataclass(frozen=True)
class Flooded:
    """The film of a solver: flooded, smooth, in the limit of slow motion.

    Attributes
    ----------
    solver : ContactSolver
        The solver.
    """

    solver: ContactSolver

    def __call__(self, question: Question) -> Answer:
        """Answer of the film as it is solved."""
        return film_answer(film_of_point(self.solver, question), question)


@dataclass(frozen=True)
class LayerRule:
    """The flooded film, capped by the rule of contact laws on an oil layer.

    Attributes
    ----------
    solver : ContactSolver
        What solves the flooded film; it gives a mass flow.
    supply : OilSupply
        Oil layer before the contact.
    """

    solver: ContactSolver
    supply: OilSupply

    def __call__(self, question: Question) -> Answer:
        """Answer of the capped film."""
        contact, point = question.contact, question.point
        loads = tuple(point.load * factor for factor in (1.0 - _STEP, 1.0, 1.0 + _STEP))
        films = self.solver.solve_line(contact, question.lubricant, loads, point.entrainment_speed, point.temperature)
        for film in films:
            if not film.status.usable:
                return film_answer(film, question)
        full = films[1]
        mass = question.lubricant.at(point.temperature).density * point.entrainment_speed
        # the load is known: nothing is read of the tail but that it begins here
        one = np.ones((1, 1))
        reach = math.log(loads[-1] / loads[0])
        line = CubicSpline(
            np.log(np.array(loads) / loads[0]) / reach, np.log([film.mass_flow / mass for film in films])[:, None, None]
        )
        flow = FlowFilm(line, math.log(loads[0]) * one, reach * one)
        slow = film_answer(full, question).values["damping"]
        tail = Tail(
            point.load * one, full.film_offset * one, full.film_compliance * one, slow * one, one, contact.radius
        )
        layer = OilLayer(contact, self.supply.oil_layer, tail, flow, np.array([point.entrainment_speed]))
        return _sampled(layer(_samples(full, point.load)), full, question)


@dataclass(frozen=True)
class RoughRule:
    """The film between smooth surfaces, shared with asperities by the rule of contact laws of rough surfaces.

    Attributes
    ----------
    solver : ContactSolver
        What solves the film between smooth surfaces.
    surface : Surface
        Rough surfaces.
    """

    solver: ContactSolver
    surface: Surface

    def __call__(self, question: Question) -> Answer:
        """Answer of the film and the asperities."""
        smooth = film_of_point(self.solver, question)
        if not smooth.status.usable:
            return film_answer(smooth, question)
        point = question.point
        layer = RoughLayer(self.surface, question.contact, question.lubricant, point.entrainment_speed)
        speeds, temperatures = np.array([point.entrainment_speed]), np.array([point.temperature])
        return _sampled(layer(_samples(smooth, point.load), speeds, temperatures), smooth, question)


@dataclass(frozen=True)
class Slow:
    """Stiffness and damping at the frequency, taken from the limit of slow motion.

    Attributes
    ----------
    solver : ContactSolver
        The solver.
    """

    solver: ContactSolver

    def __call__(self, question: Question) -> Answer:
        """Answer of slow motion; it states no error of that limit."""
        slow = film_answer(film_of_point(self.solver, question), question)
        return replace(slow, values={name: slow.values[name] for name in _DYNAMIC if name in slow.values}, stated={})


@dataclass(frozen=True)
class LockedPole:
    """Stiffness and damping at the frequency by one pole between slow motion and the locked film, as laws with memory.

    Attributes
    ----------
    solver : ContactSolver
        The solver.
    fitted : bool
        Whether the stiffness of the locked film is fitted to responses at the solver's natural frequencies, as in a map
        that holds them; else it is that of the closed formula.
    """

    solver: ContactSolver
    fitted: bool

    def __call__(self, question: Question) -> Answer:
        """Answer of the pole; damping of slow motion below zero counts as zero, as in contact laws."""
        contact, point = question.contact, question.point
        at = (contact, question.lubricant, (point.load,), point.entrainment_speed, point.temperature)
        spectrum = self.solver.line_spectra(*at)[0] if self.fitted else None
        film = self.solver.solve_line(*at)[0] if spectrum is None else spectrum.film
        slow = film_answer(film, question)
        if slow.lost:
            return slow
        solids, k = question.dry_compliance, slow.values["stiffness"]
        loss = max(film.loss_compliance, 0.0)
        c = loss * k * k
        geometry = film_of((contact,), point.entrainment_speed)
        factor = 1.0
        if spectrum is not None:
            error = response_error(np.array([solids]), spectrum.compliance[None], spectrum.largest_error[None])
            (factor,), _ = fitted_factors(
                geometry, np.array([point.load]), np.array([film.film_offset]), np.array([solids]),
                np.array([film.film_compliance]), np.array([loss]), np.array(self.solver.natural_frequencies),
                spectrum.compliance[None], error,
            )  # fmt: skip
        locked = locked_stiffness(geometry, film.film_offset, point.load, k, c, solids, factor)
        omega = 2.0 * math.pi * question.frequency
        relaxation = c / (locked - k) if locked > k else 0.0
        dynamic = k + 1j * omega * c / (1.0 + 1j * omega * relaxation)
        return Answer({"stiffness": dynamic.real, "damping": dynamic.imag / omega})


_DYNAMIC = ("stiffness", "damping")


def film_of_point(solver: ContactSolver, question: Question) -> FilmSolution:
    """The film of the point, solved on its own.

    Parameters
    ----------
    solver : ContactSolver
        The solver.
    question : Question
        The point.
    """
    point = question.point
    (film,) = solver.solve_line(
        question.contact, question.lubricant, (point.load,), point.entrainment_speed, point.temperature
    )
    return film


def _samples(film: FilmSolution, load: float) -> FilmSamples:
    """A film as contact laws take it; damping below zero counts as zero."""
    root = np.full((1, 1, 1), np.cbrt(load))
    # (c/w) D^2 with D = 3 g^2/k and w = g^3
    loss = 9.0 * root * max(film.loss_compliance, 0.0)
    return FilmSamples(root, np.full_like(root, film.film_offset), -3.0 * root**2 * film.film_compliance, loss)


def _sampled(samples: FilmSamples, film: FilmSolution, question: Question) -> Answer:
    """Answer of one sample; the films themselves, but for the offset, and errors are not told by it."""
    root = samples.root.item()
    changed = replace(
        film,
        film_offset=samples.offset.item(),
        film_compliance=-samples.slope.item() / (3.0 * root**2),
        loss_compliance=samples.loss.item() / (9.0 * root),
        central_film=math.nan,
        minimum_film=math.nan,
    )
    return replace(film_answer(changed, question), stated={})


@dataclass(frozen=True)
class Changed:
    """Answers to another question than the one that is asked, as where what is stated is wrong.

    Attributes
    ----------
    model : ContactModel
        What answers.
    change : callable
        Other question for a question.
    """

    model: ContactModel
    change: Callable[[Question], Question]

    def __call__(self, question: Question) -> Answer:
        """Answer to the other question."""
        return self.model(self.change(question))


def warmer(kelvins: float, question: Question) -> Question:
    """The question at another temperature, as where rings are warmer than one thinks.

    Parameters
    ----------
    kelvins : float
        Rise of the temperature [K].
    question : Question
        The question.
    """
    return replace(question, point=replace(question.point, temperature=question.point.temperature + kelvins))


def more_piezoviscous(factor: float, question: Question) -> Question:
    """The question for an oil with another pressure-viscosity coefficient, as its data may be wrong.

    Parameters
    ----------
    factor : float
        Coefficient over that of the oil.
    question : Question
        The question.
    """
    oil = question.lubricant
    alpha = factor * oil.at(question.point.temperature).pressure_viscosity.pressure_viscosity
    coefficients: dict[str, Any] = {"pressure_viscosity_40": alpha, "pressure_viscosity_100": alpha}
    other = replace(oil, pressure_viscosity=replace(oil.pressure_viscosity, **coefficients), correlation=None)
    return replace(question, lubricant=other)


def other_solids(law: StructuralLaw, bearing: BearingGeometry | None, question: Question) -> Question:
    """The question with another structural law of the solids.

    Parameters
    ----------
    law : str
        The law.
    bearing : BearingGeometry or None
        Bearing of the contacts.
    question : Question
        The question.
    """
    return replace(question, contact=with_law(question.contact, law, bearing))


@dataclass(frozen=True)
class TableReader(ContactSolverDefaults):
    """The film table in the place of a solver, a line of loads in one call."""

    name = "film table"

    def solve_line(
        self,
        contact: LineContact,
        lubricant: Lubricant,
        loads: tuple[float, ...],
        entrainment_speed: float,
        temperature: float,
    ) -> tuple[FilmSolution, ...]:
        """Films of the table at rising loads.

        Parameters
        ----------
        contact, lubricant, loads, entrainment_speed, temperature
            The arguments of `ehdmaps.physics.solution.ContactSolver.solve_line`.
        """
        found = film_table(lubricant).films(
            contact, lubricant, np.array(loads), entrainment_speed, temperature, thickest_film=math.inf
        )
        return tuple(found.solution(row) for row in range(len(loads)))

    def settings(self) -> dict[str, float | int | str]:
        """No settings."""
        return {}


@dataclass(frozen=True, eq=False)
class FromLaw:
    """A contact law, asked for the approach at which it carries the load.

    Attributes
    ----------
    laws : mapping of str to ContactLaw
        Laws by the names of the contacts.
    """

    laws: Mapping[str, ContactLaw]

    def __call__(self, question: Question) -> Answer:
        """Answer of one point."""
        contact, point = question.contact, question.point
        law = self.laws[contact.name].at(point.entrainment_speed, point.temperature)
        delta = float(contact.structural_approach(point.load))
        for _ in range(_MOST_STEPS):
            w, k, c = (float(number) for number in law(delta, 0.0))
            if not k > 0.0:
                return Answer(lost="the law has no stiffness on the way to the load")
            step = (point.load - w) / k
            delta += step
            if abs(step) < _CLOSE * abs(delta):
                break
        values = {"approach": delta, "stiffness": k, "damping": c}
        return Answer({**values, "film offset": float(contact.structural_approach(point.load)) - delta})
