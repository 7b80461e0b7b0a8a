"""Who takes part in `ehdmaps tradeoff`: the one table, to which a further solver or physics is added.

An entry is a way of computing a contact. It stands in a group, whose truth is the best affordable solution of the same
physics, and may name the finest affordable solution of its own model, by which its numerical error is told from that of
the model.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, get_args

from ehdmaps.ehl.limits import SETTING_LIMITS
from ehdmaps.ehl.solver import ReynoldsSolver
from ehdmaps.errors import InputError, MapError
from ehdmaps.jobs import solvers
from ehdmaps.jobs.instruments.contact_ways import (
    AtFrequency,
    ContactModel,
    Flooded,
    FromLaw,
    FromTable,
    LayerRule,
    LockedPole,
    MorePiezoviscous,
    OnLayer,
    OtherSolids,
    RoughRule,
    RoughSolved,
    Slow,
    TableReader,
    Warmer,
)
from ehdmaps.jobs.job import Job
from ehdmaps.jobs.make.table_law import job_map
from ehdmaps.maps.law import ContactLaw, LawKind
from ehdmaps.physics.approach import StructuralLaw
from ehdmaps.physics.bearing import with_law
from ehdmaps.physics.closed_form import FilmFormula, FormulaSolver
from ehdmaps.physics.heat import INLET_HEAT, THERMAL
from ehdmaps.physics.oil_supply import OilSupply
from ehdmaps.physics.solution import ContactSolver
from ehdmaps.physics.surface import Surface
from ehdmaps.table.solver import TableSolver
from ehdmaps.trade.record import Source

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

NUMBERS, TABLE, MEMORY = "grid of the solver", "film table", "film memory"
"""Sources of error, for the error budget."""

DATA, RINGS = 1.1, 5.0
"""Coefficient of pressure-viscosity over that of the oil, and how much warmer rings are [K], in the error budget."""

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
    lacks, has : str
        Source of error, for the error budget, that it leaves out, and one that it has; empty where it stands for none.
    """

    group: Group
    label: str
    model: ContactModel
    finest: ContactModel | None = None
    closed: bool = False
    default: bool = False
    few: bool = False
    lacks: str = ""
    has: str = ""


def sources(entries: Sequence[Entry]) -> tuple[Source, ...]:
    """Sources of error that stand in some entries, each with who has it.

    Parameters
    ----------
    entries : sequence of Entry
        The entries.
    """
    having = {entry.has: entry.label for entry in entries if entry.has}
    return tuple(Source(entry.lacks, entry.label, having.get(entry.lacks, "")) for entry in entries if entry.lacks)


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
    read = _table_entries(job, solved)
    moving = Group("at a frequency", AtFrequency(fine), f"reynolds at it, density {fine.density:g}")
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
            for grid in dict.fromkeys(_finer(own, factor) for factor in _RESOLUTIONS)
        ),
        *(
            Entry(grids, f"reynolds, {density}, inlet {grid.resolution.inlet:g}", Flooded(grid), solved)
            for grid in dict.fromkeys(_finer(own, 1.0, factor) for factor in _INLETS)
        ),
        *(_openfoam_entries(job, solved) if openfoam else ()),
        *_shear_entries(own, stated),
        *(_heat_entries(own) if job.lubricant.thermal_conductivity is not None else ()),
        *_data_entries(job, Flooded(usual)),
        Entry(supplied, "layer: flooded film", Flooded(usual), solved, default=True, lacks=layer.label),
        Entry(
            supplied, "layer: rule of contact laws", LayerRule(usual, layer), LayerRule(rule, layer), has=layer.label
        ),
        Entry(supplied, f"layer: reynolds, {density}", OnLayer(usual, layer), supplied.truth),
        Entry(rough, "rough: smooth film", Flooded(usual), solved, default=True, lacks=surface.label),
        Entry(
            rough, "rough: rule of contact laws", RoughRule(usual, surface), RoughRule(rule, surface), has=surface.label
        ),
        Entry(moving, "frequency: slow motion", Slow(usual), Slow(rule), lacks=MEMORY),
        Entry(moving, "frequency: one pole, formula", LockedPole(usual, False), LockedPole(rule, False)),
        Entry(
            moving,
            "frequency: one pole, fitted",
            LockedPole(usual, True),
            LockedPole(rule, True),
            default=True,
            lacks="more than one pole of memory",
            has=MEMORY,
        ),
        Entry(
            moving,
            f"frequency: reynolds, {density}",
            AtFrequency(usual),
            moving.truth,
            has="more than one pole of memory",
        ),
        *(_openfoam_responses(job, moving) if openfoam else ()),
    )


def quick(job: Job, laws: Mapping[str, ContactLaw]) -> tuple[Entry, ...]:
    """Return few contestants for the error budget of a report: films of the table where it serves, rules, few solves.

    Parameters
    ----------
    job : Job
        Job of the map.
    laws : mapping of str to ContactLaw
        Flooded, smooth laws of the map, one a contact; empty where none can be made.
    """
    own = {key: value for key, value in _own(job, "reynolds").items() if key in solvers.GRID_KEYS}
    usual = _finer(own, 1.0)
    solved, plain = Flooded(usual), replace(job, supply=None, surface=None, law_check=0)
    mapped = solvers.of_map(plain)
    films: ContactSolver = TableReader() if isinstance(mapped, TableSolver) else usual
    read = Flooded(films) if isinstance(films, TableReader) else solved
    layer = OIL_LAYER if job.supply is None or job.supply.flooded else job.supply
    surface = ROUGHNESS if job.surface is None or job.surface.smooth else job.surface
    limited = Flooded(_finer({**own, "shear": "limiting"}, 1.0))
    entries = [
        _beside("film memory", LockedPole(films, False), Slow(films)),
        _beside(layer.label, LayerRule(usual, layer), solved),
        _beside(surface.label, RoughRule(films, surface), read, surface.roughness),
        _beside("limiting shear stress", limited, solved),
        *_data_entries(job, read),
    ]
    if job.lubricant.thermal_conductivity is not None:
        heated = Flooded(_finer({**own, "physics": INLET_HEAT}, 1.0))
        entries.append(_beside("heat of the inlet, by its rule", heated, solved))
    if read is not solved:
        entries.append(_beside(TABLE, solved, read))
    if laws:
        entries.append(_beside("contact law between its points", Flooded(mapped), FromLaw(laws)))
    return tuple(entries)


def _beside(source: str, truth: ContactModel, without: ContactModel, least_film: float = 0.0) -> Entry:
    """An entry that leaves a source of error out, beside what has it."""
    group = Group(source, truth, f"{source}, as it is known cheaply", least_film)
    return Entry(group, f"without {source}", without, lacks=source)


def _table_entries(job: Job, solved: ContactModel) -> tuple[Entry, ...]:
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


def _data_entries(job: Job, stated: ContactModel) -> tuple[Entry, ...]:
    """Entries of what is stated, beside what may be: the oil's coefficient, the law of the solids, the temperature."""
    other: StructuralLaw = "iso16281" if job.contacts[0].structural_law == "half_space" else "half_space"
    others: list[tuple[str, str, ContactModel]] = [
        ("temperature", f"rings {RINGS:g} K warmer than stated", Warmer(stated, RINGS))
    ]
    if job.lubricant.pressure_viscosity.coefficient != "none":
        more = f"pressure-viscosity data {DATA - 1.0:.0%} off"
        others.append(("pressure-viscosity", more, MorePiezoviscous(stated, DATA)))
    try:
        with_law(job.contacts[0], other, job.bearing)
    except InputError:
        pass  # a contact without the lengths that this law needs
    else:
        words = f"structural law {other} in place of {job.contacts[0].structural_law}"
        others.append(("structural law", words, OtherSolids(stated, other, job.bearing)))
    return tuple(
        Entry(Group("as stated", model, name), f"{what} as stated", stated, lacks=name) for what, name, model in others
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
        Entry(
            group,
            "shear: newtonian",
            Flooded(newtonian),
            Flooded(_finer(own, RULE_REFINEMENT)),
            default=True,
            lacks=f"{law['shear']} shear stress",
        ),
        Entry(
            group,
            f"shear: {law['shear']}, density {usual.density:g}",
            Flooded(usual),
            group.truth,
            has=f"{law['shear']} shear stress",
        ),
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
            group,
            "heat: isothermal",
            Flooded(_finer(own, 1.0)),
            Flooded(_finer(own, RULE_REFINEMENT)),
            default=True,
            lacks="heat in the film",
        ),
        Entry(group, "heat: rule of the inlet", Flooded(_finer(rule, 1.0)), Flooded(_finer(rule, RULE_REFINEMENT))),
        Entry(group, f"heat: solved, density {usual.density:g}", Flooded(usual), group.truth, has="heat in the film"),
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
