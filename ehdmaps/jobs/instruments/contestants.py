"""Who takes part in `ehdmaps tradeoff`: the one table, to which a further solver or physics is added.

An entry is a way of computing a contact. It stands in a group, whose truth is the best affordable solution of the same
physics, and may name the finest affordable solution of its own model, by which its numerical error is told from that of
the model.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, get_args

from ehdmaps.ehl.limits import SETTING_LIMITS
from ehdmaps.ehl.solver import ReynoldsSolver
from ehdmaps.jobs import solvers
from ehdmaps.jobs.instruments.contact_ways import (
    AtFrequency,
    ContactModel,
    Flooded,
    LayerRule,
    LockedPole,
    OnLayer,
    RoughRule,
    RoughSolved,
    Slow,
)
from ehdmaps.jobs.job import Job
from ehdmaps.physics.closed_form import FilmFormula, FormulaSolver
from ehdmaps.physics.heat import INLET_HEAT, THERMAL
from ehdmaps.physics.oil_supply import OilSupply
from ehdmaps.physics.solution import ContactSolver
from ehdmaps.physics.surface import Surface

REFINEMENT = 4.0
"""Grid density of the reference over that of the job; its inlet is as many times as long, squared."""

RULE_REFINEMENT = 2.0
"""Grid density of the films of the finest solution of a rule, over that of the job."""

OPENFOAM_REFINEMENT = 1.5
"""Cells each way of the finest solution by openfoam, over those of the job: twice as many take most of a minute."""

OPENFOAM_TIMEOUT = 900.0
"""Seconds after which a point of openfoam is stopped: a slow machine is no property of a solver."""

OIL_LAYER, ROUGHNESS = OilSupply.named("oil air"), Surface(2e-7)
"""Oil supply and surface that are measured where the job states none of its own."""

NEWTONIAN = "newtonian"

_RESOLUTIONS = (0.5, 0.7, 1.0, 1.4, 2.0)
"""Grid densities that are measured, over that of the job."""

_INLETS = (0.5, 2.0)
"""Inlets that are measured, over that of the job."""


@dataclass(frozen=True)
class Group:
    """Entries with one truth.

    Attributes
    ----------
    name : str
        What is chosen, in words.
    truth : ContactModel
        Best affordable solution of the same physics.
    reference : str
        The truth in words, where it is not that of the flooded, smooth, slow film.
    least_film : float
        Film that errors of films are relative to at least [m], where films go through zero.
    """

    name: str
    truth: ContactModel
    reference: str = ""
    least_film: float = 0.0


@dataclass(frozen=True)
class Entry:
    """One way of computing a contact, as it is measured.

    Attributes
    ----------
    group : Group
        Group that it stands in.
    label : str
        Name in the table, different from all others.
    model : ContactModel
        What answers.
    finest : ContactModel, optional
        Finest affordable solution of the same model; None where it has no discretisation, or that is not affordable.
    closed : bool
        Whether it is a closed form: all of its error is that of the model.
    default : bool
        Whether it is what is used where nothing is said.
    few : bool
        Whether a point takes seconds: it is asked at a few points only.
    """

    group: Group
    label: str
    model: ContactModel
    finest: ContactModel | None = None
    closed: bool = False
    default: bool = False
    few: bool = False


def contestants(job: Job, openfoam: bool) -> tuple[Entry, ...]:
    """Return who is measured; the one place to change it.

    Parameters
    ----------
    job : Job
        Job whose settings, oil supply and surface are taken, where it states them.
    openfoam : bool
        Whether the solver `openfoam` takes part; it has to be installed.
    """
    stated = _own(job, "reynolds")
    own = {key: value for key, value in stated.items() if key not in solvers.PHYSICAL}
    usual, fine, rule = _finer(own, 1.0), _finer(own, REFINEMENT), _finer(own, RULE_REFINEMENT)
    layer = OIL_LAYER if job.supply is None or job.supply.flooded else job.supply
    surface = ROUGHNESS if job.surface is None or job.surface.smooth else job.surface
    density = f"density {usual.density:g}"
    solved = Flooded(fine)
    closed, grids = Group("closed forms", solved), Group("reynolds", solved)
    supplied = Group(layer.label, OnLayer(fine, layer), f"reynolds with it, density {fine.density:g}")
    rough = Group(
        surface.label,
        RoughSolved(usual, surface),
        f"reynolds for the film of each share, {density}",
        surface.roughness,
    )
    moving = Group("at a frequency", AtFrequency(fine), f"reynolds at it, density {fine.density:g}")
    return (
        Entry(closed, "hertz", Flooded(solvers.build("hertz", {})), closed=True),
        *(
            Entry(closed, f"formula, {word}", Flooded(FormulaSolver(word)), closed=True, default=word == "moes")
            for word in get_args(FilmFormula)
        ),
        *(
            Entry(grids, f"reynolds, density {grid.density:g}", Flooded(grid), solved, default=grid == ReynoldsSolver())
            for grid in dict.fromkeys(_finer(own, factor) for factor in _RESOLUTIONS)
        ),
        *(
            Entry(grids, f"reynolds, {density}, inlet {grid.resolution.inlet:g}", Flooded(grid), solved)
            for grid in dict.fromkeys(_finer(own, 1.0, factor) for factor in _INLETS)
        ),
        *(_openfoam_entries(job, solved) if openfoam else ()),
        *_shear_entries(own, stated),
        *(_heat_entries(own) if job.lubricant.thermal_conductivity is not None else ()),
        Entry(supplied, "layer: flooded film", Flooded(usual), solved, default=True),
        Entry(supplied, "layer: rule of contact laws", LayerRule(usual, layer), LayerRule(rule, layer)),
        Entry(supplied, f"layer: reynolds, {density}", OnLayer(usual, layer), supplied.truth),
        Entry(rough, "rough: smooth film", Flooded(usual), solved, default=True),
        Entry(rough, "rough: rule of contact laws", RoughRule(usual, surface), RoughRule(rule, surface)),
        Entry(moving, "frequency: slow motion", Slow(usual), Slow(rule)),
        Entry(moving, "frequency: one pole, formula", LockedPole(usual, False), LockedPole(rule, False)),
        Entry(moving, "frequency: one pole, fitted", LockedPole(usual, True), LockedPole(rule, True), default=True),
        Entry(moving, f"frequency: reynolds, {density}", AtFrequency(usual), moving.truth),
        *(_openfoam_responses(job, moving) if openfoam else ()),
    )


def _shear_entries(own: dict[str, Any], stated: dict[str, Any]) -> tuple[Entry, ...]:
    """Entries of films with a law of shear: the job's, else a limiting stress; and the Newtonian film beside it."""
    law = {key: value for key, value in stated.items() if key in solvers.PHYSICAL and key != "physics"}
    if law.get("shear", NEWTONIAN) == NEWTONIAN:
        law = {"shear": "limiting"}
    fine, usual = (_finer({**own, **law}, factor) for factor in (RULE_REFINEMENT, 1.0))
    newtonian = _finer(own, 1.0)
    name = f"shear, {law['shear']}"
    group = Group(name, Flooded(fine), f"reynolds, {law['shear']}, density {fine.density:g}")
    return (
        Entry(group, "shear: newtonian", Flooded(newtonian), Flooded(_finer(own, RULE_REFINEMENT)), default=True),
        Entry(group, f"shear: {law['shear']}, density {usual.density:g}", Flooded(usual), group.truth),
    )


def _heat_entries(own: dict[str, Any]) -> tuple[Entry, ...]:
    """Entries of films with heat: none, that of the inlet by its rule, and solved; none where nothing solves it."""
    if not solvers.takes("reynolds", "physics", THERMAL):
        return ()
    fine, usual = (_finer({**own, "physics": THERMAL}, factor) for factor in (RULE_REFINEMENT, 1.0))
    group = Group("heat", Flooded(fine), f"reynolds, thermal, density {fine.density:g}")
    rule = {**own, "physics": INLET_HEAT}
    return (
        Entry(
            group, "heat: isothermal", Flooded(_finer(own, 1.0)), Flooded(_finer(own, RULE_REFINEMENT)), default=True
        ),
        Entry(group, "heat: rule of the inlet", Flooded(_finer(rule, 1.0)), Flooded(_finer(rule, RULE_REFINEMENT))),
        Entry(group, f"heat: solved, density {usual.density:g}", Flooded(usual), group.truth),
    )


def _openfoam_entries(job: Job, solved: ContactModel) -> tuple[Entry, ...]:
    """Entries of the solver `openfoam`: half, all and more of the cells of the job."""
    group = Group("openfoam", solved)
    thin, full = (Flooded(_openfoam(job, flow, OPENFOAM_REFINEMENT)) for flow in ("thin_film", "full_stress"))
    coarse, usual = (_openfoam(job, "thin_film", factor) for factor in (0.5, 1.0))
    return (
        Entry(group, f"openfoam, thin_film, {_cells(coarse)}", Flooded(coarse), thin, few=True),
        Entry(
            group, f"openfoam, thin_film, {_cells(usual)}", Flooded(usual), thin, few=True,
            default=not _own(job, "openfoam"),
        ),
        Entry(
            group, f"openfoam, full_stress, {_cells(usual)}", Flooded(_openfoam(job, "full_stress")), full, few=True
        ),
    )  # fmt: skip


def _openfoam_responses(job: Job, moving: Group) -> tuple[Entry, ...]:
    """Entry of the solver `openfoam` at a frequency; a finer grid of it is not affordable."""
    usual = _openfoam(job, "thin_film")
    return (Entry(moving, f"frequency: openfoam, {_cells(usual)}", AtFrequency(usual), few=True),)


def _openfoam(job: Job, flow: str, factor: float = 1.0) -> ContactSolver:
    """The solver `openfoam` with more or less than the cells of the job."""
    own = _own(job, "openfoam")
    cells = {"columns": own.get("columns", 400), "rows": own.get("rows", 6)}
    # each has to be even: half of them are the coarse grid
    used = {name: 2 * max(round(count * factor / 2), 2) for name, count in cells.items()}
    return solvers.build("openfoam", {"timeout": OPENFOAM_TIMEOUT, **own, **used, "flow": flow})


def _cells(solver: ContactSolver) -> str:
    """Cells along and across the film, in words."""
    settings = solver.settings()
    return f"{settings['columns']} x {settings['rows']}"


def _own(job: Job, solver: str) -> dict[str, Any]:
    """Settings of a solver that the job states."""
    return dict(job.solver_options) if job.solver == solver else {}


def _finer(own: dict[str, Any], density: float, inlet: float = 1.0) -> ReynoldsSolver:
    """`reynolds` with other grids, as far as they are allowed; their inlets go with the square of the density."""
    used = ReynoldsSolver(**own)
    if density == inlet == 1.0:
        return used
    (low, high), (short, long) = SETTING_LIMITS["density"], SETTING_LIMITS["inlet_length"]
    cells = min(max(round(used.density * density, 2), low), high)
    length = used.resolution.inlet * (cells / used.density) ** 2 * inlet
    return ReynoldsSolver(**{**own, "density": cells, "inlet_length": min(max(round(length, 1), short), long)})
