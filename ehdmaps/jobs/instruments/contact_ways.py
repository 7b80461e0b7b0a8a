"""Ways of computing a contact, from one question to one answer: solvers, oil layers, rough surfaces, frequencies.

Load sharing of film and asperities with solved films: what the rule of rough contact laws is measured against.

A film that carries the share g of the pressure is that of solids with the modulus g E' under the load g w (K. L.
Johnson, J. A. Greenwood, S. Y. Poon, Wear 19, 1972, 91). `ehdmaps.maps.rough_layer` scales it from the film between
smooth surfaces by a formula; here every film on the way is solved. Asperities are those of `ehdmaps.maps.asperities`
in both.

Each is a frozen value that is called with a `Question`. `contestants` lists those that are
measured.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, Protocol

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.optimize import brentq

from ehdmaps.ehl.solver import ReynoldsSolver
from ehdmaps.errors import SolverError
from ehdmaps.jobs.instruments.answers import Answer, Question, film_answer, known
from ehdmaps.maps.contact_curve import FilmSamples, Tail
from ehdmaps.maps.kernels.locked_film import film_of, fitted_factors, locked_stiffness, response_error
from ehdmaps.maps.law import ContactLaw
from ehdmaps.maps.oil_layer import OilLayer
from ehdmaps.maps.rolling_film import FlowFilm
from ehdmaps.maps.rough_layer import RoughLayer, asperity_pressure, mean_gap
from ehdmaps.physics.approach import StructuralLaw
from ehdmaps.physics.bearing import BearingGeometry, with_law
from ehdmaps.physics.contact import LineContact, OperatingPoint
from ehdmaps.physics.hertz import max_pressure
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.oil_supply import OilSupply
from ehdmaps.physics.solution import ContactSolver, ContactSolverDefaults, FilmSolution
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
_MOST_STEPS = 50


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


_STEP = 0.01
"""Step of the load over which the flow of the flooded film is read, relative."""


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
        return film_answer(_film(self.solver, question), question)


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
        smooth = _film(self.solver, question)
        if not smooth.status.usable:
            return film_answer(smooth, question)
        point = question.point
        layer = RoughLayer(self.surface, question.contact, question.lubricant, point.entrainment_speed)
        speeds, temperatures = np.array([point.entrainment_speed]), np.array([point.temperature])
        return _sampled(layer(_samples(smooth, point.load), speeds, temperatures), smooth, question)


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
        slow = film_answer(_film(self.solver, question), question)
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


def _film(solver: ContactSolver, question: Question) -> FilmSolution:
    """The film of the point, solved on its own."""
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
class Warmer:
    """Answers at another temperature than that of the question, as where rings are warmer than one thinks.

    Attributes
    ----------
    model : ContactModel
        What answers.
    kelvins : float
        How much warmer [K].
    """

    model: ContactModel
    kelvins: float

    def __call__(self, question: Question) -> Answer:
        """Answer at the other temperature."""
        point = replace(question.point, temperature=question.point.temperature + self.kelvins)
        return self.model(replace(question, point=point))


@dataclass(frozen=True)
class MorePiezoviscous:
    """Answers for an oil with another pressure-viscosity coefficient, as its data may be wrong.

    Attributes
    ----------
    model : ContactModel
        What answers.
    factor : float
        Coefficient over that of the oil.
    """

    model: ContactModel
    factor: float

    def __call__(self, question: Question) -> Answer:
        """Answer for the other oil."""
        oil = question.lubricant
        alpha = self.factor * oil.at(question.point.temperature).pressure_viscosity.pressure_viscosity
        coefficients: dict[str, Any] = {"pressure_viscosity_40": alpha, "pressure_viscosity_100": alpha}
        other = replace(oil, pressure_viscosity=replace(oil.pressure_viscosity, **coefficients), correlation=None)
        return self.model(replace(question, lubricant=other))


@dataclass(frozen=True)
class OtherSolids:
    """Answers with another structural law of the solids.

    Attributes
    ----------
    model : ContactModel
        What answers.
    structural_law : str
        The law.
    bearing : BearingGeometry or None
        Bearing of the contacts.
    """

    model: ContactModel
    structural_law: StructuralLaw
    bearing: BearingGeometry | None

    def __call__(self, question: Question) -> Answer:
        """Answer by the other law."""
        return self.model(replace(question, contact=with_law(question.contact, self.structural_law, self.bearing)))


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
