"""Contacts, courses of load and measures that compare the contact law with memory with the film solver.

The approach of a course is that of the nonlinear film in time under a load that is prescribed; the laws are fed with
this approach and are to give the load back.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cache

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.optimize import brentq

from ehdmaps.arrays import ComplexArray, FloatArray
from ehdmaps.ehl.grid import DRY_DATUM
from ehdmaps.ehl.group_solution import GroupSolution
from ehdmaps.ehl.limits import GridShape, Resolution
from ehdmaps.ehl.line import solve_groups
from ehdmaps.ehl.solver import ReynoldsSolver, line_problem
from ehdmaps.ehl.ways import LOAD
from ehdmaps.jobs.job import Job
from ehdmaps.jobs.make.generate import generate_in_memory
from ehdmaps.maps.emap import EHDMap
from ehdmaps.maps.film_field import lifted_loss
from ehdmaps.maps.kernels.film_response import FilmsOfContact
from ehdmaps.maps.kernels.locked_film import film_of, fitted_factors, locked_stiffness, response_error
from ehdmaps.maps.law_films import LawAtPoint
from ehdmaps.physics.contact import LineContact, OperatingPoint
from ehdmaps.physics.hertz import half_width, natural_time
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.moes import moes_groups, valley_load_number
from ehdmaps.physics.solids import STEEL
from ehdmaps.physics.spectrum import contact_spectrum
from tests.cases.film_in_time import follow

CONTACT = LineContact("line", 5.515e-3, STEEL, "iso16281", roller_length=15e-3)

FVA3 = Lubricant.named("FVA3")
"""The oil with which the two fitted numbers of the law were chosen."""

THIN = Lubricant.roelands(viscosity=0.03, pressure_viscosity=12e-9, roelands_z=0.5, density=870.0)
THICK = Lubricant.roelands(viscosity=0.12, pressure_viscosity=30e-9, roelands_z=0.7, density=870.0)
"""Oils with which no number of the law was chosen."""

STANDING = Resolution(density=8.0, shape=GridShape(core=0.7), spike_steepness=1e9)
"""A standing grid with many cells in the Hertz zone, through which the film and the spike may move."""

STEPS = 96
"""Time steps of a period or of a change of load: backward differences are right to (2 pi/96)^2/3 = 1.4e-3."""

FINER = 4
"""Steps of a law for each step of the film, so that what is compared is the law and not its integration."""

NATURAL = np.geomspace(0.01, 10.0, 25)
"""omega T at which complex stiffnesses are compared."""

PLACES = np.array([0.1, 0.3, 1.0, 3.0, 10.0, 30.0])
"""omega T at which errors are told one by one."""

READ = np.array([0.1, 0.3, 0.7, 1.4, 2.8, 5.6, 10.0, 14.0, 30.0])
"""omega T at which it is asked how well the law's error is read from the responses of a map."""

REST = (0.4, 0.7, 1.5, 2.0)
"""Loads at which the curves at rest are compared, over that of the start."""


@dataclass(frozen=True)
class Oil:
    """An oil at a temperature and an entrainment speed.

    Attributes
    ----------
    name : str
        For tables.
    lubricant : Lubricant
        The oil.
    temperature, speed : float
        [K], [m/s].
    """

    name: str
    lubricant: Lubricant
    temperature: float
    speed: float

    @property
    def groups(self) -> tuple[float, float]:
        """Moes' M of 1 N/m, and L."""
        state = self.lubricant.at(self.temperature)
        alpha = state.pressure_viscosity.pressure_viscosity
        M, L = moes_groups(1.0, self.speed, state.viscosity, alpha, CONTACT.radius, CONTACT.reduced_modulus)
        return float(M), float(L)

    def load(self, part: float) -> float:
        """Load at a part of that at the bottom of the damping valley [N/m]."""
        unit, L = self.groups
        return part * float(valley_load_number(L)) / unit


@dataclass(frozen=True)
class Course:
    """A course of load.

    Attributes
    ----------
    name : str
        For tables.
    ratios : tuple of float
        Load over that of the start, at equal steps; the first one is 1.
    step : float
        In natural times.
    """

    name: str
    ratios: tuple[float, ...]
    step: float


def _smooth(t: FloatArray) -> FloatArray:
    """From 0 to 1 over 0 to 1, with two derivatives."""
    t = np.clip(t, 0.0, 1.0)
    return np.asarray(t**3 * (10.0 - 15.0 * t + 6.0 * t * t))


def sine(size: float, frequency: float, periods: int = 3) -> Course:
    """A sine that swells over its first period.

    Parameters
    ----------
    size : float
        Amplitude over the load of the start.
    frequency : float
        omega T.
    periods : int
        How long.
    """
    t = np.arange(periods * STEPS + 1) / STEPS
    ratios = 1.0 + size * _smooth(t) * np.sin(2.0 * math.pi * t)
    name = f"sine {100 * size:.0f} %, omega T {frequency:g}"
    return Course(name, tuple(map(float, ratios)), 2.0 * math.pi / frequency / STEPS)


def up_and_down() -> Course:
    """To twice the load within three natural times, and after five more down to 0.4 within three."""
    step = 12.0 / (2 * STEPS)
    t = step * np.arange(int(16.0 / step) + 1)
    ratios = 1.0 + _smooth(t / 3.0) - 1.6 * _smooth((t - 8.0) / 3.0)
    return Course("up x 2, down to 0.4", tuple(map(float, ratios)), step)


COURSES = (sine(0.6, 0.5), sine(0.5, 1.0), sine(0.3, 2.0), sine(0.15, 4.0), sine(0.06, 10.0), up_and_down())
"""What the law is asked to follow: large where it is slow, small where it is fast, as a roller's load is."""

LARGE_COURSES = (sine(0.8, 0.5), sine(0.5, 2.0), sine(0.3, 4.0), sine(0.15, 10.0))
"""Larger amplitudes, up to where the film solver has no solution at all contacts."""


class NoSolutionError(Exception):
    """The film solver has no solution, at rest or up to the end of a course."""


@dataclass(frozen=True)
class Followed:
    """What the film solver makes of a course.

    Attributes
    ----------
    times, approach, loads : array
        [s], [m], [N/m].
    offset : float
        Film offset at the start [m].
    """

    times: FloatArray
    approach: FloatArray
    loads: FloatArray
    offset: float


@dataclass(frozen=True)
class RestingFilm:
    """A contact at rest on a grid that stands.

    Attributes
    ----------
    oil : Oil
        Oil and speed.
    load : float
        [N/m].
    solution : GroupSolution
        The film.
    """

    oil: Oil
    load: float
    solution: GroupSolution

    @property
    def natural_time(self) -> float:
        """T = sqrt(b^2 + 2 h R)/u [s]."""
        return self._half * math.sqrt(1.0 + 2.0 * self.solution.film_offset) / self.oil.speed

    @property
    def _half(self) -> float:
        return float(half_width(self.load, CONTACT.radius, CONTACT.reduced_modulus))

    def _approach(self, height: FloatArray, ratios: FloatArray) -> FloatArray:
        """Approach [m] at heights H0 and loads, both in units of the start."""
        offset = height - ratios * (DRY_DATUM + 0.25 * np.log(ratios))
        return np.asarray(CONTACT.structural_approach(self.load * ratios) - offset * self._half**2 / CONTACT.radius)

    @property
    def approach(self) -> float:
        """Approach at rest [m]."""
        offset = self.solution.film_offset * self._half**2 / CONTACT.radius
        return float(CONTACT.structural_approach(self.load)) - offset

    def followed(self, course: Course) -> Followed:
        """Follow the film over a course.

        Raises
        ------
        NoSolutionError
            If it does not converge up to the end.
        """
        profile = self.solution.profile
        assert profile is not None
        ratios = np.array(course.ratios)
        step = course.step * self.natural_time
        motion = follow(profile, LOAD * ratios[1:], step * self.oil.speed / self._half)
        if np.isnan(motion.height[-1]):
            raise NoSolutionError(
                f"{course.name}: ends at step {int(np.argmax(np.isnan(motion.height)))} of {ratios.size - 1}"
            )
        offset = self.solution.film_offset * self._half**2 / CONTACT.radius
        return Followed(
            step * np.arange(ratios.size), self._approach(motion.height, ratios), self.load * ratios, offset
        )


def resting(oil: Oil, load: float) -> RestingFilm:
    """Solve a contact at a load [N/m].

    Raises
    ------
    NoSolutionError
        If the solver has none.
    """
    problem, M, L = line_problem(CONTACT, oil.lubricant.at(oil.temperature), load, oil.speed)
    solution = solve_groups(problem, M, L, STANDING)
    if solution.profile is None:
        raise NoSolutionError(f"no film at rest at M = {M:.3g}, L = {L:.3g}")
    return RestingFilm(oil, load, solution)


@cache
def law_at(oil: Oil, lightest: float = 0.02, heaviest: float = 20.0) -> LawAtPoint:
    """The contact law of a small map at one speed and temperature.

    Parameters
    ----------
    oil : Oil
        Oil, temperature and speed.
    lightest, heaviest : float
        Ends of the map, over the load at the valley's bottom.
    """
    job = Job.build(
        lubricant=oil.lubricant,
        contact=CONTACT,
        loads=[oil.load(lightest), oil.load(heaviest)],
        entrainment_speeds=[oil.speed],
        temperatures=[oil.temperature],
    )
    made = generate_in_memory(job, 1)
    return EHDMap(made.dataset, made.backbone).law("line", "error").at(oil.speed, oil.temperature)


def approach_of(at: LawAtPoint, load: float) -> float:
    """Approach [m] at which a law carries a load [N/m] at rest."""
    low, high = at.memory.table.lift_off, float(CONTACT.structural_approach(load))
    return float(brentq(lambda delta: at(delta, 0.0)[0] - load, low, high, xtol=1e-17))


@dataclass(frozen=True)
class Errors:
    """Root-mean-square errors of loads over that of the load's variation.

    Attributes
    ----------
    memory, slow, dry : float
        Of the law with memory; of k and c of slow motion, w_rest + c rate without tension; and of the structure alone
        over a film that keeps its thickness.
    """

    memory: float
    slow: float
    dry: float


def errors(at: LawAtPoint, followed: Followed) -> Errors:
    """Feed laws with the approach of the film solver, and compare the loads.

    Parameters
    ----------
    at : LawAtPoint
        The law.
    followed : Followed
        What the film solver gives. Its approach is moved by a constant, so that both carry the same load at the start:
        the grids differ.
    """
    count = followed.times.size - 1
    times = np.linspace(0.0, followed.times[-1], FINER * count + 1)
    approach = followed.approach - followed.approach[0]
    spline = CubicSpline(followed.times, approach, bc_type=((1, 0.0), "not-a-knot"))
    deltas = approach_of(at, float(followed.loads[0])) + spline(times)
    state = at.memory.settled(deltas[0])
    loads = [followed.loads[0]]
    for delta in deltas[1:]:
        w, _, state = at.memory.advance(state, delta, float(times[1]))
        loads.append(w)
    slow = at(deltas, spline(times, 1))[0]
    dry = [dry_load(delta + followed.offset) for delta in followed.approach]

    def error(found: FloatArray) -> float:
        return float(np.sqrt(np.mean((found - followed.loads) ** 2)) / np.std(followed.loads))

    return Errors(error(np.array(loads)[::FINER]), error(slow[::FINER]), error(np.array(dry)))


@dataclass(frozen=True)
class Response:
    """A contact over frequency.

    Attributes
    ----------
    M, L : float
        Moes' numbers.
    memory, formula, slow, dry : float
        Largest relative error of the complex stiffness by each law: with memory as the response at the solver's natural
        frequencies makes it, and with the closed formula of the locked film.
    worst : float
        omega T at which the law with memory is worst.
    at_places : tuple of float
        Errors of the law with memory at `PLACES`.
    stated : float
        Largest error that the solver states.
    read : tuple of float
        Error of the law's own error at `READ`, as it is read from the natural frequencies of a map.
    """

    M: float
    L: float
    memory: float
    formula: float
    slow: float
    dry: float
    worst: float
    at_places: tuple[float, ...]
    stated: float
    read: tuple[float, ...]


def response(contact: LineContact, oil: Lubricant, point: OperatingPoint) -> Response:
    """Compare the complex stiffness of laws with that of the film solver at `NATURAL`.

    k and c are those of the solver in slow motion, as a contact law takes them, so that only the memory is compared.

    Parameters
    ----------
    contact : LineContact
        The contact.
    oil : Lubricant
        The oil.
    point : OperatingPoint
        Load, speed and temperature.
    """
    solver, load, speed = ReynoldsSolver(), point.load, point.entrainment_speed
    (film,) = solver.solve_line(contact, oil, (load,), speed, point.temperature)
    half = float(half_width(load, contact.radius, contact.reduced_modulus))
    if not film.status.usable:
        raise NoSolutionError(f"none at {load:.6g} N/m, {speed:.6g} m/s, {point.temperature:.6g} K")
    natural = natural_time(load, film.film_offset, speed, contact.radius, contact.reduced_modulus)
    omega, held = NATURAL / natural, np.array(solver.natural_frequencies)
    asked = np.concatenate([NATURAL, PLACES, READ, held]) / (2.0 * math.pi * natural)
    found = solver.film_spectrum(contact, oil, point, asked)
    spectrum = contact_spectrum(found, contact, point)
    exact, k = spectrum.dynamic_stiffness[: omega.size], spectrum.solution.stiffness
    beyond, between = np.split(spectrum.dynamic_stiffness[omega.size : -held.size], [PLACES.size])
    loss = lifted_loss(np.array(spectrum.solution.damping / k**2), np.array(half), speed, np.array(1.0 / k))
    c = float(loss) * k**2
    solids = float(contact.structural_compliance(load))
    kept, locked = found.compliance[-held.size :], film_of((contact,), speed)
    error = response_error(np.array([solids]), kept[None], found.largest_error[None, -held.size :])
    values = (np.array([value]) for value in (load, film.film_offset, solids, film.film_compliance, float(loss)))
    factors, apart = fitted_factors(locked, *values, held, kept[None], error)
    factor = float(factors[0])
    stiff, by_formula = (locked_stiffness(locked, film.film_offset, load, k, c, solids, each) for each in (factor, 1.0))
    wrong = np.abs(relaxing(k, c, stiff, omega) / exact - 1.0)
    relaxation = np.array([c / (stiff - k) if stiff > k else 0.0])
    films = FilmsOfContact(
        *(np.array([value]) for value in (k, c)), relaxation, *(np.array([time]) for time in (natural, half / speed)),
        held, apart,
    )  # fmt: skip
    by_map = films.compliance(1j * READ / natural)[:, 0]
    state = oil.at(point.temperature)
    alpha = state.pressure_viscosity.pressure_viscosity
    M, L = moes_groups(load, speed, state.viscosity, alpha, contact.radius, contact.reduced_modulus)
    return Response(
        float(M),
        float(L),
        float(np.max(wrong)),
        float(np.max(np.abs(relaxing(k, c, by_formula, omega) / exact - 1.0))),
        float(np.max(np.abs((k + 1j * omega * c) / exact - 1.0))),
        float(np.max(np.abs(1.0 / (solids * exact) - 1.0))),
        float(NATURAL[np.argmax(wrong)]),
        tuple(np.abs(relaxing(k, c, stiff, PLACES / natural) / beyond - 1.0).tolist()),
        float(np.max(spectrum.dynamic_stiffness_error[: omega.size])),
        tuple(np.abs(relaxing(k, c, stiff, READ / natural) * (by_map - 1.0 / between)).tolist()),
    )


def relaxing(k: float, c: float, stiff: float, omega: FloatArray) -> ComplexArray:
    """Complex stiffness k + i omega c/(1 + i omega theta), theta = c/(stiff - k), of a law with memory.

    Parameters
    ----------
    k, c : float
        Stiffness [N/m2] and damping [N s/m2] of slow motion.
    stiff : float
        Stiffness of the film that cannot give way [N/m2].
    omega : array
        [1/s].
    """
    if not stiff > k:
        return np.full(omega.shape, k + 0j)
    return np.asarray(k + 1j * omega * c / (1.0 + 1j * omega * c / (stiff - k)))


def dry_load(approach: float) -> float:
    """Load [N/m] of the structure alone."""
    if approach <= 0.0:
        return 0.0
    return float(brentq(lambda w: CONTACT.structural_approach(w) - approach, 0.0, 1e8, xtol=1e-9))


def rest_error(at: LawAtPoint, film: RestingFilm) -> float:
    """Largest relative difference of the loads at rest of law and film solver, at `REST` times the load.

    The approach is moved as by `errors`.
    """
    begin = approach_of(at, film.load) - film.approach
    others = [resting(film.oil, film.load * ratio) for ratio in REST]
    return max(abs(float(at(other.approach + begin, 0.0)[0]) / other.load - 1.0) for other in others)
