"""Sources of error of a contact that are looked at in a report: a few entries, of what answers cheaply.

An entry is a way of computing a contact. It stands in a group, whose truth is the best affordable solution of the same
physics, and may name the finest affordable solution of its own model, by which its numerical error is told from that of
the model.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import Any

from ehdmaps.ehl.limits import SETTING_LIMITS
from ehdmaps.ehl.solver import ReynoldsSolver
from ehdmaps.errors import InputError
from ehdmaps.jobs import solvers
from ehdmaps.jobs.budget.contact_ways import (
    Changed,
    ContactModel,
    Flooded,
    FromLaw,
    LayerRule,
    LockedPole,
    RoughRule,
    Slow,
    TableReader,
    more_piezoviscous,
    other_solids,
    warmer,
)
from ehdmaps.jobs.job import Job
from ehdmaps.maps.law import ContactLaw
from ehdmaps.physics.approach import StructuralLaw
from ehdmaps.physics.bearing import with_law
from ehdmaps.physics.heat import INLET_HEAT
from ehdmaps.physics.oil_supply import OilSupply
from ehdmaps.physics.solution import ContactSolver
from ehdmaps.physics.surface import Surface
from ehdmaps.table.solver import TableSolver
from ehdmaps.trade.record import Entry, Group, Source

ContactEntry = Entry[ContactModel]

TABLE = "film table"
"""Group, and source of error, of what is read from it."""

OIL_LAYER, ROUGHNESS = OilSupply.named("oil air"), Surface(2e-7)
"""Oil supply and surface that are measured where the job states none of its own."""

DATA, RINGS = 1.1, 5.0
"""Coefficient of pressure-viscosity over that of the oil, and how much warmer rings are [K], in the error budget."""


def sources(entries: Sequence[ContactEntry]) -> tuple[Source, ...]:
    """Sources of error that stand in some entries, each with who has it.

    Parameters
    ----------
    entries : sequence of Entry
        The entries.
    """
    having = {entry.has: entry.label for entry in entries if entry.has}
    return tuple(Source(entry.lacks, entry.label, having.get(entry.lacks, "")) for entry in entries if entry.lacks)


def supply_and_surface(job: Job) -> tuple[OilSupply, Surface]:
    """Oil supply and surface that are measured: those of the job, where it states some.

    Parameters
    ----------
    job : Job
        The job.
    """
    return (
        OIL_LAYER if job.supply is None or job.supply.flooded else job.supply,
        ROUGHNESS if job.surface is None or job.surface.smooth else job.surface,
    )


def quick(job: Job, laws: Mapping[str, ContactLaw]) -> tuple[ContactEntry, ...]:
    """Return few contestants for the error budget of a report: films of the table where it serves, rules, few solves.

    Parameters
    ----------
    job : Job
        Job of the map.
    laws : mapping of str to ContactLaw
        Flooded, smooth laws of the map, one a contact; empty where none can be made.
    """
    own = {key: value for key, value in own_settings(job, "reynolds").items() if key in solvers.GRID_KEYS}
    usual = finer(own, 1.0)
    solved, plain = Flooded(usual), replace(job, supply=None, surface=None, law_check=0)
    mapped = solvers.of_map(plain)
    films: ContactSolver = TableReader() if isinstance(mapped, TableSolver) else usual
    read = Flooded(films) if isinstance(films, TableReader) else solved
    layer, surface = supply_and_surface(job)
    limited = Flooded(finer({**own, "shear": "limiting"}, 1.0))
    entries = [
        _beside("film memory", LockedPole(films, False), Slow(films)),
        _beside(layer.label, LayerRule(usual, layer), solved),
        _beside(surface.label, RoughRule(films, surface), read, surface.roughness),
        _beside("limiting shear stress", limited, solved),
        *data_entries(job, read),
    ]
    if job.lubricant.thermal_conductivity is not None:
        heated = Flooded(finer({**own, "physics": INLET_HEAT}, 1.0))
        entries.append(_beside("heat of the inlet, by its rule", heated, solved))
    if read is not solved:
        entries.append(_beside(TABLE, solved, read))
    if laws:
        entries.append(_beside("contact law between its points", Flooded(mapped), FromLaw(laws)))
    return tuple(entries)


def _beside(source: str, truth: ContactModel, without: ContactModel, least_film: float = 0.0) -> ContactEntry:
    """An entry that leaves a source of error out, beside what has it."""
    group = Group(source, truth, f"{source}, as it is known cheaply", least_film)
    return Entry(group, f"without {source}", without, lacks=source)


def data_entries(job: Job, stated: ContactModel) -> tuple[ContactEntry, ...]:
    """Entries of what is stated, beside what may be: the oil's coefficient, the law of the solids, the temperature.

    Parameters
    ----------
    job : Job
        The job.
    stated : ContactModel
        What answers as the job states it.
    """
    other: StructuralLaw = "iso16281" if job.contacts[0].structural_law == "half_space" else "half_space"
    others: list[tuple[str, str, ContactModel]] = [
        ("temperature", f"rings {RINGS:g} K warmer than stated", Changed(stated, partial(warmer, RINGS)))
    ]
    if job.lubricant.pressure_viscosity.coefficient != "none":
        more = f"pressure-viscosity data {DATA - 1.0:.0%} off"
        others.append(("pressure-viscosity", more, Changed(stated, partial(more_piezoviscous, DATA))))
    try:
        with_law(job.contacts[0], other, job.bearing)
    except InputError:
        pass  # a contact without the lengths that this law needs
    else:
        words = f"structural law {other} in place of {job.contacts[0].structural_law}"
        others.append(("structural law", words, Changed(stated, partial(other_solids, other, job.bearing))))
    return tuple(
        Entry(Group("as stated", model, name), f"{what} as stated", stated, lacks=name) for what, name, model in others
    )


def own_settings(job: Job, solver: str) -> dict[str, Any]:
    """Settings of a solver that the job states.

    Parameters
    ----------
    job : Job
        The job.
    solver : str
        Name of the solver.
    """
    return dict(job.solver_options) if job.solver == solver else {}


def finer(own: dict[str, Any], density: float, inlet: float = 1.0) -> ReynoldsSolver:
    """`reynolds` with other grids, as far as they are allowed; their inlets go with the square of the density.

    Parameters
    ----------
    own : dict
        Settings of the solver.
    density, inlet : float
        Density of the grid and length of the inlet, over those of the settings.
    """
    used = ReynoldsSolver(**own)
    if density == inlet == 1.0:
        return used
    (low, high), (short, long) = SETTING_LIMITS["density"], SETTING_LIMITS["inlet_length"]
    cells = min(max(round(used.density * density, 2), low), high)
    length = used.resolution.inlet * (cells / used.density) ** 2 * inlet
    return ReynoldsSolver(**{**own, "density": cells, "inlet_length": min(max(round(length, 1), short), long)})
