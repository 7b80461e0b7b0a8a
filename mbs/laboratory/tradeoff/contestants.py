"""Who takes part in `ehdmaps tradeoff`: the one table, to which a further solver or physics is added."""

from __future__ import annotations

from dataclasses import replace
from typing import Any, get_args

from ehdmaps.ehl.solver import ReynoldsSolver
from ehdmaps.errors import MapError
from ehdmaps.jobs import solvers
from ehdmaps.jobs.budget.contact_ways import (
    ContactModel,
    Flooded,
    FromLaw,
    LayerRule,
    LockedPole,
    RoughRule,
    Slow,
)
from ehdmaps.jobs.budget.entries import (
    TABLE,
    ContactEntry,
    data_entries,
    finer,
    own_settings,
    supply_and_surface,
)
from ehdmaps.jobs.job import Job
from ehdmaps.jobs.make.table_law import job_map
from ehdmaps.maps.law import LawKind
from ehdmaps.physics.closed_form import FilmFormula, FormulaSolver
from ehdmaps.physics.heat import INLET_HEAT, THERMAL
from ehdmaps.physics.solution import ContactSolver
from ehdmaps.trade.record import Entry, Group
from mbs.laboratory.tradeoff.solved_ways import AtFrequency, FromTable, OnLayer, RoughSolved

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
