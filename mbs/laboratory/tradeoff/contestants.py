"""Dear ways of computing a contact: solved behind a layer, on rough surfaces, at a frequency, and from the film table.

Load sharing of film and asperities with solved films is what the rule of rough contact laws is measured against. A film
that carries the share g of the pressure is that of solids with the modulus g E' under the load g w (K. L. Johnson,
J. A. Greenwood, S. Y. Poon, Wear 19, 1972, 91). `ehdmaps.maps.rough_layer` scales it from the film between smooth
surfaces by a formula; here every film on the way is solved. Asperities are those of `ehdmaps.maps.asperities` in both.

Who takes part in `ehdmaps tradeoff`: the one table, to which a further solver or physics is added.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, get_args

import numpy as np
from scipy.optimize import brentq

from ehdmaps.ehl.solver import ReynoldsSolver
from ehdmaps.errors import MapError, SolverError
from ehdmaps.jobs import solvers
from ehdmaps.jobs.budget.contact_ways import (
    Answer,
    ContactModel,
    Flooded,
    FromLaw,
    LayerRule,
    LockedPole,
    Question,
    RoughRule,
    Slow,
    film_answer,
    known,
)
from ehdmaps.jobs.budget.entries import TABLE, ContactEntry, data_entries, finer, own_settings, supply_and_surface
from ehdmaps.jobs.job import Job
from ehdmaps.jobs.make.table_law import job_map
from ehdmaps.maps.law import LawKind
from ehdmaps.maps.rough_layer import asperity_pressure, mean_gap
from ehdmaps.physics.closed_form import FilmFormula, FormulaSolver
from ehdmaps.physics.contact import LineContact, OperatingPoint
from ehdmaps.physics.heat import INLET_HEAT, THERMAL
from ehdmaps.physics.hertz import max_pressure
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.oil_supply import OilSupply
from ehdmaps.physics.solution import ContactSolver
from ehdmaps.physics.spectrum import contact_spectrum
from ehdmaps.physics.surface import Surface
from ehdmaps.table.file import film_table
from ehdmaps.trade.record import Entry, Group

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


REFINEMENT = 4.0
"""Grid density of the reference over that of the job; its inlet is as many times as long, squared."""

RULE_REFINEMENT = 2.0
"""Grid density of the films of the finest solution of a rule, over that of the job."""

OPENFOAM_REFINEMENT = 1.5
"""Cells each way of the finest solution by openfoam, over those of the job: twice as many take most of a minute."""

OPENFOAM_TIMEOUT = 900.0
"""Seconds after which a point of openfoam is stopped: a slow machine is no property of a solver."""

NEWTONIAN = "newtonian"

NUMBERS, MEMORY = "grid of the solver", "film memory"
"""Sources of error, for the error budget."""

_RESOLUTIONS = (0.5, 0.7, 1.0, 1.4, 2.0)
"""Grid densities that are measured, over that of the job."""

_INLETS = (0.5, 2.0)
"""Inlets that are measured, over that of the job."""


def contestants(job: Job, openfoam: bool) -> tuple[ContactEntry, ...]:
    """Return who is measured; the one place to change it.

    Parameters
    ----------
    job : Job
        Job whose settings, oil supply and surface are taken, where it states them.
    openfoam : bool
        Whether the solver `openfoam` takes part; it has to be installed.
    """
    stated = own_settings(job, "reynolds")
    own = {key: value for key, value in stated.items() if key not in solvers.PHYSICAL}
    usual, fine, rule = finer(own, 1.0), finer(own, REFINEMENT), finer(own, RULE_REFINEMENT)
    layer, surface = supply_and_surface(job)
    density, plain, solved = f"density {usual.density:g}", Flooded(usual), Flooded(fine)
    closed, grids = Group("closed forms", solved), Group("reynolds", solved)
    supplied = Group(layer.label, OnLayer(fine, layer), f"reynolds with it, density {fine.density:g}")
    shares = f"reynolds for the film of each share, {density}"
    rough = Group(surface.label, RoughSolved(usual, surface), shares, surface.roughness)
    moving = Group("at a frequency", AtFrequency(fine), f"reynolds at it, density {fine.density:g}")
    read, fitted, poles = _table_entries(job, solved), LockedPole(usual, True), "more than one pole of memory"
    by_rule, on_layer = "rule of contact laws", (LayerRule(usual, layer), LayerRule(rule, layer))
    return (
        Entry(closed, "hertz", Flooded(solvers.build("hertz", {})), closed=True),
        *(
            Entry(closed, f"formula, {word}", Flooded(FormulaSolver(word)), closed=True, default=word == "moes")
            for word in get_args(FilmFormula)
        ),
        *read,
        *(
            Entry(
                grids,
                f"reynolds, density {grid.density:g}",
                Flooded(grid),
                solved,
                default=grid == ReynoldsSolver() and not read,
                lacks=NUMBERS if grid == usual else "",
                has=NUMBERS if grid == rule else TABLE if grid == usual else "",
            )
            for grid in dict.fromkeys(finer(own, factor) for factor in _RESOLUTIONS)
        ),
        *(
            Entry(grids, f"reynolds, {density}, inlet {grid.resolution.inlet:g}", Flooded(grid), solved)
            for grid in dict.fromkeys(finer(own, 1.0, factor) for factor in _INLETS)
        ),
        *(_openfoam_entries(job, solved) if openfoam else ()),
        *_shear_entries(own, stated),
        *(_heat_entries(own) if job.lubricant.thermal_conductivity is not None else ()),
        *data_entries(job, plain),
        Entry(supplied, "layer: flooded film", plain, solved, default=True, lacks=layer.label),
        Entry(supplied, f"layer: {by_rule}", *on_layer, has=layer.label),
        Entry(supplied, f"layer: reynolds, {density}", OnLayer(usual, layer), supplied.truth),
        Entry(rough, "rough: smooth film", plain, solved, default=True, lacks=surface.label),
        Entry(rough, f"rough: {by_rule}", RoughRule(usual, surface), RoughRule(rule, surface), has=surface.label),
        Entry(moving, "frequency: slow motion", Slow(usual), Slow(rule), lacks=MEMORY),
        Entry(moving, "frequency: one pole, formula", LockedPole(usual, False), LockedPole(rule, False)),
        Entry(
            moving, "frequency: one pole, fitted", fitted, LockedPole(rule, True), default=True, lacks=poles, has=MEMORY
        ),
        Entry(moving, f"frequency: reynolds, {density}", AtFrequency(usual), moving.truth, has=poles),
        *(_openfoam_responses(job, moving) if openfoam else ()),
    )


def _table_entries(job: Job, solved: ContactModel) -> tuple[ContactEntry, ...]:
    """Entries of what is read from the film table: films, and contact laws; none where it does not serve the job."""
    flooded = replace(job, supply=None, surface=None, law_check=0)
    try:
        emap = job_map(flooded, job.name)
    except MapError:
        return ()
    names = {contact.name for contact in job.contacts}
    laws = FromLaw({kind: emap.law(kind, outside="asymptote") for kind in get_args(LawKind) if kind in names})
    group, law = Group(TABLE, solved), "contact law, from the film table"
    return (
        Entry(group, TABLE, FromTable(), solved, default=True, lacks=TABLE, has="law over load, speed, temperature"),
        Entry(group, law, laws, solved, lacks="law over load, speed, temperature"),
    )


def _shear_entries(own: dict[str, Any], stated: dict[str, Any]) -> tuple[ContactEntry, ...]:
    """Entries of films with a law of shear: the job's, else a limiting stress; and the Newtonian film beside it."""
    law = {key: value for key, value in stated.items() if key in solvers.PHYSICAL and key != "physics"}
    if law.get("shear", NEWTONIAN) == NEWTONIAN:
        law = {"shear": "limiting"}
    fine, usual = (finer({**own, **law}, factor) for factor in (RULE_REFINEMENT, 1.0))
    group = Group(f"shear, {law['shear']}", Flooded(fine), f"reynolds, {law['shear']}, density {fine.density:g}")
    stress, plain, finest = f"{law['shear']} shear stress", *_with_finest(own)
    return (
        Entry(group, "shear: newtonian", plain, finest, default=True, lacks=stress),
        Entry(group, f"shear: {law['shear']}, density {usual.density:g}", Flooded(usual), group.truth, has=stress),
    )


def _heat_entries(own: dict[str, Any]) -> tuple[ContactEntry, ...]:
    """Entries of films with heat: none, that of the inlet by its rule, and solved; none where nothing solves it."""
    if not solvers.takes("reynolds", "physics", THERMAL):
        return ()
    fine, usual = (finer({**own, "physics": THERMAL}, factor) for factor in (RULE_REFINEMENT, 1.0))
    group = Group("heat", Flooded(fine), f"reynolds, thermal, density {fine.density:g}")
    heat, rule = "heat in the film", {**own, "physics": INLET_HEAT}
    return (
        Entry(group, "heat: isothermal", *_with_finest(own), default=True, lacks=heat),
        Entry(group, "heat: rule of the inlet", *_with_finest(rule)),
        Entry(group, f"heat: solved, density {usual.density:g}", Flooded(usual), group.truth, has=heat),
    )


def _with_finest(own: dict[str, Any]) -> tuple[Flooded, Flooded]:
    """A film of `reynolds`, and the finest solution of the same model."""
    return Flooded(finer(own, 1.0)), Flooded(finer(own, RULE_REFINEMENT))


def _openfoam_entries(job: Job, solved: ContactModel) -> tuple[ContactEntry, ...]:
    """Entries of the solver `openfoam`: half, all and more of the cells of the job."""
    group = Group("openfoam", solved)
    thin, full = (Flooded(_openfoam(job, flow, OPENFOAM_REFINEMENT)) for flow in ("thin_film", "full_stress"))
    coarse, usual = (_openfoam(job, "thin_film", factor) for factor in (0.5, 1.0))
    first, stress, own = f"openfoam, thin_film, {_cells(coarse)}", _openfoam(job, "full_stress"), _cells(usual)
    default = not own_settings(job, "openfoam")
    return (
        Entry(group, first, Flooded(coarse), thin, few=True),
        Entry(group, f"openfoam, thin_film, {own}", Flooded(usual), thin, few=True, default=default),
        Entry(group, f"openfoam, full_stress, {own}", Flooded(stress), full, few=True),
    )


def _openfoam_responses(job: Job, moving: Group[ContactModel]) -> tuple[ContactEntry, ...]:
    """Entry of the solver `openfoam` at a frequency; a finer grid of it is not affordable."""
    usual = _openfoam(job, "thin_film")
    return (Entry(moving, f"frequency: openfoam, {_cells(usual)}", AtFrequency(usual), few=True),)


def _openfoam(job: Job, flow: str, factor: float = 1.0) -> ContactSolver:
    """The solver `openfoam` with more or less than the cells of the job."""
    own = own_settings(job, "openfoam")
    cells = {"columns": own.get("columns", 400), "rows": own.get("rows", 6)}
    # each has to be even: half of them are the coarse grid
    used = {name: 2 * max(round(count * factor / 2), 2) for name, count in cells.items()}
    return solvers.build("openfoam", {"timeout": OPENFOAM_TIMEOUT, **own, **used, "flow": flow})


def _cells(solver: ContactSolver) -> str:
    """Cells along and across the film, in words."""
    settings = solver.settings()
    return f"{settings['columns']} x {settings['rows']}"
