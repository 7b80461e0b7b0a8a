"""Operating points over all that inputs may declare and a decade beyond, and what theory says of a contact there."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import partial
from typing import NamedTuple

import numpy as np

from ehdmaps.ehl.solver import ReynoldsSolver
from ehdmaps.errors import problems_after
from ehdmaps.jobs.job import Job
from ehdmaps.jobs.make.sampling import SamplePoint, log_uniform
from ehdmaps.jobs.problem import LOAD_AXIS, SPEED_AXIS
from ehdmaps.jobs.solids import FE_APPROACHES
from ehdmaps.physics.approach import STRUCTURAL_LAWS
from ehdmaps.physics.closed_form import THICKEST_FILM, THIN_FILM_LIMIT, FormulaSolver, HertzSolver
from ehdmaps.physics.contact import OIL_TEMPERATURES, LineContact
from ehdmaps.physics.films import MARTIN_CONSTANT, asymptotes
from ehdmaps.physics.heat import INLET_HEAT, THERMAL
from ehdmaps.physics.hertz import half_width
from ehdmaps.physics.lubricant import DENSITY_LAWS, LUBRICANTS, Lubricant
from ehdmaps.physics.moes import film_from_moes, moes_groups
from ehdmaps.physics.solids import Material
from ehdmaps.physics.solution import ContactSolution, ContactSolver, FilmSolution, Status
from ehdmaps.physics.viscosity import PRESSURE_LAWS, Barus

DECADE = 10.0
"""Factor by which every range is left at both ends."""

SLOWEST = 1e-9
"""Entrainment speed from which speeds above zero are drawn [m/s]."""

BEYOND = 36.0
"""Temperature by which the range of oils is left at both ends, a tenth of it [K]."""

_LENGTHS, _MODULI = (1e-5, 100.0), (1e8, 2e12)
_VISCOSITIES, _COEFFICIENTS, _DENSITIES = (1e-5, 1e3), (1e-10, 1e-7), (300.0, 3000.0)
_CONDUCTIVITIES = (1e-2, 10.0)
"""What a job file may state of contacts [m], solids [Pa] and oils [Pa s, 1/Pa, kg/m3, W/(m K)]."""


class WildPoint(NamedTuple):
    """A point with its oil, and the words that repeat it."""

    point: SamplePoint
    oil: Lubricant
    label: str


def wild_point(job: Job, seed: int, number: int) -> WildPoint:
    """Draw a point; the same one for the same arguments.

    Every second point has a contact and an oil of its own, the others a contact of the job and an oil of the catalogue.

    Parameters
    ----------
    job : Job
        Job with the contacts and the oil.
    seed : int
        Seed of the search.
    number : int
        Number of the point.

    Raises
    ------
    InputError
        If what was drawn is refused.
    """
    rng = np.random.default_rng([seed, number])
    load = log_uniform(rng, LOAD_AXIS.low / DECADE, LOAD_AXIS.high * DECADE)
    speed = 0.0 if rng.random() < 0.02 else log_uniform(rng, SLOWEST, SPEED_AXIS.high * DECADE)
    temperature = float(rng.uniform(OIL_TEMPERATURES[0] - BEYOND, OIL_TEMPERATURES[1] + BEYOND))
    words = f"seed {seed}, number {number}: w = {load:.6g} N/m, u = {speed:.6g} m/s, {temperature:.6g} K"
    with problems_after(f"{words}: "):
        if number % 2:
            contact, oil = own_contact(rng), own_oil(rng)
        else:
            contact = job.contacts[int(rng.integers(len(job.contacts)))]
            oils = (job.lubricant, *map(Lubricant.named, LUBRICANTS))
            oil = oils[int(rng.integers(len(oils)))]
    words += f", {contact.name} R = {contact.radius:.4g} m, E = {contact.material.youngs_modulus:.3g} Pa, {oil.name}"
    return WildPoint(SamplePoint(contact, load, speed, temperature), oil, words)


def own_contact(rng: np.random.Generator) -> LineContact:
    """Draw a bare contact.

    Raises
    ------
    InputError
        If what was drawn is refused.
    """
    material = Material(_beyond(rng, _MODULI), float(rng.uniform(0.0, 0.499)))
    law = STRUCTURAL_LAWS[int(rng.integers(len(STRUCTURAL_LAWS)))]
    radius, length, depth = (_beyond(rng, _LENGTHS) for _ in range(3))
    approach = log_uniform(rng, *FE_APPROACHES) if law == "fe" else None
    return LineContact("line", radius, material, law, length, depth, approach)


def own_oil(rng: np.random.Generator) -> Lubricant:
    """Draw an oil of any law.

    Raises
    ------
    InputError
        If what was drawn is refused.
    """
    word = list(PRESSURE_LAWS)[int(rng.integers(len(PRESSURE_LAWS)))]
    kind = PRESSURE_LAWS[word]
    numbers: dict[str, float] = {}
    if kind.coefficient == "none":
        numbers = {entry.field: float(rng.uniform(entry.low, entry.high)) for entry in kind.parameters}
    alpha: float | None = None if kind.coefficient == "none" else _beyond(rng, _COEFFICIENTS)
    if word == "barus" and rng.random() < 0.1:
        alpha = 0.0
    return Lubricant.own(
        word,
        numbers,
        viscosity=_beyond(rng, _VISCOSITIES),
        density=_beyond(rng, _DENSITIES),
        density_slope=float(rng.uniform(-5.0, 0.0)) if rng.random() < 0.2 else 0.0,
        density_law=DENSITY_LAWS[int(rng.integers(len(DENSITY_LAWS)))],
        name=word,
        thermal_conductivity=log_uniform(rng, *_CONDUCTIVITIES),
        **({} if alpha is None else {"pressure_viscosity": alpha}),
    )


def _beyond(rng: np.random.Generator, limits: tuple[float, float]) -> float:
    """Draw from a range and a decade around it."""
    return log_uniform(rng, limits[0] / DECADE, limits[1] * DECADE)


def refusals(job: Job, solver: ContactSolver) -> Iterator[tuple[str, Callable[[], object]]]:
    """Yield inputs that no number may come of, zero, negative, infinite, no number, each with what makes use of it.

    Parameters
    ----------
    job : Job
        Job with a contact and an oil that are good.
    solver : ContactSolver
        What is given loads, speeds and temperatures.
    """
    contact, oil = job.contacts[0], job.lubricant

    def solve(load: float, speed: float, temperature: float) -> Callable[[], object]:
        return lambda: solver.solve_line(contact, oil, (load,), speed, temperature)[0]

    for label, value in _WRONG:
        yield f"load {label}", solve(value, 1.0, 313.15)
        yield f"temperature {label}", solve(1e5, 1.0, value)
        if value != 0.0:  # a contact at rest is one, and so is an isoviscous oil
            yield f"speed {label}", solve(1e5, value, 313.15)
            yield f"pressure_viscosity {label}", partial(_barus, "pressure_viscosity", value)
        for name in ("radius", "roller_length"):
            yield f"{name} {label}", partial(_contact, contact, name, value)
        yield f"modulus {label}", partial(Material, value, 0.3)
        for name in ("viscosity", "density"):
            yield f"{name} {label}", partial(_barus, name, value)
    for nu in (0.5, -1.0, math.nan, math.inf):
        yield f"Poisson ratio {nu}", partial(Material, 210e9, nu)


_WRONG: tuple[tuple[str, float], ...] = (
    ("zero", 0.0),
    ("below zero", -1.0),
    ("minus infinite", -math.inf),
    ("infinite", math.inf),
    ("no number", math.nan),
)


def _contact(good: LineContact, name: str, value: float) -> LineContact:
    """A contact with a value of its own."""
    values = {"radius": good.radius, "roller_length": 0.015} | {name: value}
    return LineContact("line", values["radius"], good.material, "iso16281", values["roller_length"])


def _barus(name: str, value: float) -> Lubricant:
    """An oil with a value of its own, at a temperature."""
    values = {"viscosity": 0.1, "density": 880.0, "pressure_viscosity": 2e-8} | {name: value}
    oil = Lubricant.barus(
        viscosity=values["viscosity"], density=values["density"], pressure_viscosity=values["pressure_viscosity"]
    )
    oil.at(313.15)
    return oil


HAIR = 1e-6
"""Relative change of load and speed between points a hair apart; a thousandth of a degree of temperature."""

_VALUES = ("film_offset", "film_compliance", "loss_compliance", "central_film", "minimum_film", "max_pressure")


JUMP = 1e-3
"""What a hair may change: a thousand times the hair, which is more than any power of load, speed or viscosity."""

_GROSS = 3.0
"""Factor beyond the asymptotes of Moes that a film may have: other laws of the oil over pressure, compressibility."""


@dataclass(frozen=True)
class Groups:
    """A point as theory sees it: Moes' numbers, the unit of his film number [m], pressure of Hertz [Pa], half-width."""

    M: float
    L: float
    unit: float
    peak: float
    half: float


Judge = Callable[[WildPoint, FilmSolution, ContactSolution], tuple[str, float]]
"""Says what is wrong with a value, or nothing, and how much of its bound it takes."""


def groups_of(wild: WildPoint) -> Groups:
    """Return what theory needs of a point.

    Parameters
    ----------
    wild : WildPoint
        The point.
    """
    contact, load, speed, temperature = wild.point
    state, modulus = wild.oil.at(temperature), contact.reduced_modulus
    alpha = state.pressure_viscosity.pressure_viscosity
    M, L = moes_groups(load, speed, state.viscosity, alpha, contact.radius, modulus)
    unit = film_from_moes(1.0, speed, state.viscosity, contact.radius, modulus)
    peak = math.sqrt(load * modulus / (2.0 * math.pi * contact.radius))
    return Groups(float(M), float(L), float(unit), peak, float(half_width(load, contact.radius, modulus)))


def status_problem(film: FilmSolution) -> str:
    """Fault in the status of a film."""
    values = [getattr(film, name) for name in _VALUES]
    if not film.status.usable:
        if not film.reason:
            return f"status {film.status.word} without a reason"
        return "" if all(map(math.isnan, values)) else f"status {film.status.word} with numbers"
    return "" if all(map(math.isfinite, values)) else f"a value that is not finite: {film!r:.300}"


def _whole_problem(film: FilmSolution, whole: ContactSolution) -> str:
    """Fault of a contact whatever its solver."""
    numbers = (whole.approach, whole.stiffness, whole.damping)
    if not all(map(math.isfinite, numbers)):
        return f"approach, stiffness, damping are {numbers}"
    if not whole.stiffness > 0.0:
        return f"a stiffness of {whole.stiffness:.4g} N/m2"
    if not 0.0 <= film.minimum_film <= film.central_film * (1.0 + 1e-4):
        return f"a minimum film of {film.minimum_film:.4g} m beside a central one of {film.central_film:.4g} m"
    return ""


def _hertz_problem(wild: WildPoint, film: FilmSolution, whole: ContactSolution) -> tuple[str, float]:
    """Pressure of Hertz, and stiffness as the slope of the structural law."""
    contact, load, _, _ = wild.point
    step = 1e-4
    peak = math.sqrt(load * contact.reduced_modulus / (2.0 * math.pi * contact.radius))
    rise = contact.structural_approach(load * (1.0 + step)) - contact.structural_approach(load * (1.0 - step))
    # The third derivative of w^0.9 and of w ln w leaves a share of step^2; round-off leaves 1e-16/step.
    off = max(abs(film.max_pressure / peak - 1.0), abs(whole.stiffness * rise / (2.0 * step * load) - 1.0))
    wrong = _whole_problem(film, whole) or (f"pressure or stiffness off by {off:.3g}" if off > 1e-6 else "")
    return wrong, off / 1e-6


def _formula_problem(wild: WildPoint, film: FilmSolution, whole: ContactSolution) -> tuple[str, float]:
    """A film that falls with load; without a reason it lies near what the asymptotes of Moes allow."""
    wrong = _whole_problem(film, whole)
    if wrong or film.film_offset == 0.0:
        return wrong, 0.0
    if not film.film_compliance > 0.0 or not film.loss_compliance >= 0.0:
        return f"film compliance {film.film_compliance:.4g} m2/N, loss {film.loss_compliance:.4g} m2 s/N", 0.0
    return ("", 0.0) if film.reason else _gross_problem(film, groups_of(wild))


def _gross_problem(film: FilmSolution, groups: Groups, barus: bool = True) -> tuple[str, float]:
    """A film beside the asymptotes of Moes; by laws other than Barus' it may be as thin as an isoviscous one."""
    low, high = _moes_range(groups)
    if not barus:
        low, _ = _moes_range(replace(groups, L=0.0))
    H = film.film_offset / groups.unit
    share = abs(math.log(H / math.sqrt(low * high))) / (0.5 * math.log(high / low) + math.log(_GROSS))
    words = f"H = {H:.4g} at M = {groups.M:.4g}, L = {groups.L:.4g}; asymptotes of Moes {low:.4g} to {high:.4g}"
    return (words if share > 1.0 else ""), share


def _moes_problem(wild: WildPoint, film: FilmSolution, whole: ContactSolution) -> tuple[str, float]:
    """The film number between the largest asymptote and what their sums can be at most."""
    wrong, share = _formula_problem(wild, film, whole)
    if wrong or film.film_offset == 0.0:
        return wrong, share
    groups = groups_of(wild)
    low, high = _moes_range(groups)
    H = film.film_offset / groups.unit
    if not low * (1.0 - 1e-9) <= H <= high * (1.0 + 1e-9):
        return f"H = {H:.6g} at M = {groups.M:.4g}, L = {groups.L:.4g}; asymptotes allow {low:.6g} to {high:.6g}", 0.0
    return "", (H / low - 1.0) / (high / low - 1.0)


def _moes_range(groups: Groups) -> tuple[float, float]:
    """Lowest and highest film number that the four asymptotes allow, whatever the exponents that join them."""
    rigid, elastic, rigid_viscous, elastic_viscous = asymptotes(groups.M, groups.L)
    low = max(rigid, elastic)
    high = low * 2.0 ** (3.0 / 7.0)
    if groups.L > 0.0:
        viscous = min(rigid_viscous, elastic_viscous)
        low, high = max(low, viscous * 2.0 ** (-2.0 / 7.0)), max(high, viscous)
    return low, high * 2.0 ** (5.0 / 7.0)  # the exponent s is 7/5 at least


def film_problem(wild: WildPoint, film: FilmSolution, whole: ContactSolution) -> tuple[str, float]:
    """A solved film beside Martin's, Hertz' and Moes'.

    Parameters
    ----------
    wild : WildPoint
        The point.
    film, whole
        Film and contact of the point.
    """
    wrong = _whole_problem(film, whole)
    if wrong or film.film_offset == 0.0:
        return wrong, 0.0
    groups = groups_of(wild)
    thick = film.film_offset / wild.point.contact.radius
    if thick > THICKEST_FILM or (film.status is Status.ASYMPTOTE) != (thick > THIN_FILM_LIMIT):
        return f"status {film.status.word} with h/R = {thick:.4g}", 0.0
    wrong, share = _gross_problem(film, groups, isinstance(wild.oil.pressure_viscosity, Barus))
    if wrong:
        return wrong, share
    speed_root = math.sqrt(groups.unit / wild.point.contact.radius)  # (eta us/(E'R))^(1/4)
    alpha = groups.L / wild.point.contact.reduced_modulus / max(speed_root, 1e-300)
    if groups.M < 0.01 and alpha * film.max_pressure < 1e-3 and film.max_pressure < 1e6:
        # Elastic and viscous shares are below 0.1 %, compressibility below 0.06 %.
        martin = MARTIN_CONSTANT / groups.M * groups.unit
        off = abs(film.minimum_film / martin - 1.0) / (2e-3 + 3.0 * stated_size(film.minimum_film_error))
        share = max(share, off)
        if off > 1.0:
            return f"a film of {film.minimum_film / martin:.6g} times Martin's", off
    if groups.M > 100.0:
        # A spike may stand above Hertz' pressure, a film only takes some per cent from it.
        lacking = (1.0 - film.max_pressure / groups.peak) / 0.1
        share = max(share, lacking)
        if lacking > 1.0:
            return f"a pressure of {film.max_pressure / groups.peak:.4g} times Hertz' at M = {groups.M:.4g}", lacking
    return "", share


def _warm_film_problem(wild: WildPoint, film: FilmSolution, whole: ContactSolution) -> tuple[str, float]:
    """A film with heat in its inlet beside those of Moes, thinner by a third at most."""
    wrong = _whole_problem(film, whole)
    if wrong or film.film_offset == 0.0:
        return wrong, 0.0
    return _gross_problem(film, groups_of(wild), isinstance(wild.oil.pressure_viscosity, Barus))


def _hot_film_problem(wild: WildPoint, film: FilmSolution, whole: ContactSolution) -> tuple[str, float]:
    """A film with temperatures: numbers that fit together."""
    return _whole_problem(film, whole), 0.0


def stated_size(error: float) -> float:
    """Size of a stated error; 0 where none is stated."""
    return 0.0 if math.isnan(error) else abs(error)


Solved = tuple[FilmSolution, ContactSolution]
"""Film and contact of a point."""


def jump(wild: WildPoint, solved: Solved, beside: Solved) -> tuple[str, float]:
    """Quantities that change too much between points a hair apart, and the share of its bound that the largest takes.

    Parameters
    ----------
    wild : WildPoint
        The point.
    solved, beside : Solved
        Solution of it, and of the point beside it.
    """
    worst, share = "", 0.0
    for name, apart, size, error in _differences(wild, solved, beside):
        bound = JUMP * size + error
        if apart > share * bound:
            worst, share = (
                f"{name} changes by {apart / size if size else math.inf:.3g} within a hair",
                apart / max(bound, 1e-300),
            )
    return (worst if share > 1.0 else ""), share


def error_ratios(wild: WildPoint, solved: Solved, exact: Solved) -> dict[str, float]:
    """Errors over what is stated of them; round-off counts as stated.

    Parameters
    ----------
    wild, solved
        What `jump` takes.
    exact : Solved
        The solution on a finer grid.
    """
    film, whole = solved
    stated = {"film": film.film_offset_error, "stiffness": whole.stiffness_error, "damping": whole.damping_error}
    ratios = {}
    for name, apart, size, _ in _differences(wild, solved, exact):
        own = abs(whole.damping) if name == "damping" else size
        ratios[name] = apart / (stated_size(stated[name]) * own + 1e-6 * size)
    return ratios


def _differences(wild: WildPoint, solved: Solved, beside: Solved) -> Iterator[tuple[str, float, float, float]]:
    """Yield name, difference, size and stated error of what is compared between two solutions."""
    (film, whole), (other, its) = solved, beside
    contact, load, speed, _ = wild.point
    half = float(half_width(load, contact.radius, contact.reduced_modulus))
    # Damping goes through zero in its valley: there its size is that of the stiffness times the time of passage.
    passage = whole.stiffness * half / speed if speed > 0.0 else 0.0
    rows = (
        ("film", film.film_offset, other.film_offset, 0.0, film.film_offset_error),
        ("stiffness", whole.stiffness, its.stiffness, 0.0, whole.stiffness_error),
        ("damping", whole.damping, its.damping, 1e-3 * passage, whole.damping_error),
    )
    for name, first, second, scale, error in rows:
        yield name, abs(first - second), max(abs(first), scale), 2.0 * stated_size(error) * abs(first)


_LIKE_MOES = "film within a factor of 3 of what the asymptotes of Moes allow, with pressure or without"

_RULES = {
    "hertz": "pressure of Hertz to 1e-6; stiffness is the slope of the structural law, to 1e-6 (a difference of 1e-4)",
    "moes": "a film that falls with load, where the four asymptotes allow",
    "formula": "a film that falls with load; within a factor of 3 of what the asymptotes of Moes allow, or outside its "
    "range",
    "reynolds": f"{_LIKE_MOES}; Martin's to 0.2 % and three times the stated error where M < 0.01 and alpha p < 0.001; "
    "0.9 of the pressure of Hertz at least where M > 100; thick films said to be so",
    "limiting": "the same as of reynolds: in pure rolling a bound of the stress takes nothing of a film",
    "thermal": "a status with its reason, or numbers that fit together; no bound of the film is known",
}
"""When a value counts as right."""


class Tried(NamedTuple):
    """A solver that is searched.

    Attributes
    ----------
    name : str
        What it is called in a check.
    solver : ContactSolver
        The solver.
    judge : callable
        What judges a value.
    rule : str
        When a value counts as right.
    share : float
        Number of its points over that of the search; 1 where a point takes milliseconds.
    """

    name: str
    solver: ContactSolver
    judge: Judge
    rule: str
    share: float = 1.0


def tried_solvers() -> tuple[Tried, ...]:
    """Return the solvers that are searched, the quick ones first.

    The one with temperatures takes minutes to be compiled, and is no part of a small search.
    """
    limited, warm = ReynoldsSolver(shear="limiting"), ReynoldsSolver(physics=INLET_HEAT)
    hot = ReynoldsSolver(physics=THERMAL)
    return (
        Tried("hertz", HertzSolver(), _hertz_problem, _RULES["hertz"]),
        Tried("formula moes", FormulaSolver("moes"), _moes_problem, _RULES["moes"]),
        Tried("formula dowson-toyoda", FormulaSolver("dowson-toyoda"), _formula_problem, _RULES["formula"]),
        Tried("formula pan-hamrock", FormulaSolver("pan-hamrock"), _formula_problem, _RULES["formula"]),
        Tried("reynolds", ReynoldsSolver(), film_problem, _RULES["reynolds"]),
        Tried("reynolds, limiting", limited, film_problem, _RULES["limiting"], 1.0 / 10.0),
        Tried("reynolds, inlet-heat", warm, _warm_film_problem, _LIKE_MOES, 1.0 / 10.0),
        Tried("reynolds, thermal", hot, _hot_film_problem, _RULES["thermal"], 1.0 / 1000.0),
    )
