"""Contact laws without a map: lines from the film table, made into a law as the lines of a map are."""

from __future__ import annotations

from collections.abc import Sequence

from ehdmaps.ehl.solver import ReynoldsSolver
from ehdmaps.errors import InputError
from ehdmaps.jobs.job import Job
from ehdmaps.jobs.refinement import backbone_group, refinement
from ehdmaps.maps.law import ContactLaw, OutsidePolicy
from ehdmaps.maps.own_lines import line_field
from ehdmaps.maps.rolling_film import rolling_film_of_lines
from ehdmaps.physics.approach import StructuralLaw
from ehdmaps.physics.bearing import BearingGeometry
from ehdmaps.physics.contact import LineContact
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.oil_supply import FLOODED, OilSupply
from ehdmaps.physics.roughness import SMOOTH, Surface
from ehdmaps.physics.solids import STEEL, Material
from ehdmaps.physics.solution import ContactSolver
from ehdmaps.table.family import GRID
from ehdmaps.table.solver import TableSolver

LOADS, SPEEDS, TEMPERATURES = (100.0, 1e6), (0.05, 10.0), (293.15, 393.15)
"""Ranges of a law for which nothing else is said: those of the shipped jobs [N/m], [m/s], [K]."""


def law(
    of: BearingGeometry | LineContact,
    lubricant: Lubricant,
    kind: str | None = None,
    loads: tuple[float, float] = LOADS,
    entrainment_speeds: tuple[float, float] = SPEEDS,
    temperatures: tuple[float, float] = TEMPERATURES,
    outside: OutsidePolicy = "error",
    supply: OilSupply = FLOODED,
    surface: Surface = SMOOTH,
    structural_law: StructuralLaw = "iso16281",
    material: Material = STEEL,
    solver: ContactSolver | None = None,
) -> ContactLaw:
    """Make a contact law without a map, in about a second.

    Films come from the film table; what it does not know is solved.

    Parameters
    ----------
    of : BearingGeometry or LineContact
        A bearing, or one contact.
    lubricant : Lubricant
        The oil.
    kind : {"series", "inner", "outer", "line"}, optional
        Contact of a bearing, or a roller between both raceways, which is the default.
    loads, entrainment_speeds, temperatures : (float, float)
        Ranges of the law [N/m], [m/s] > 0, [K].
    outside, supply, surface
        Arguments of `EHDMap.law`.
    structural_law : str
        Law of the solids of a bearing's contacts.
    material : Material
        Material of a bearing.
    solver : ContactSolver, optional
        What gives the films; the table if left out.

    Raises
    ------
    InputError
        For a kind that there is not, and for ranges that no map could have.
    MapError
        If films are missing that the law needs.

    Examples
    --------
    >>> import ehdmaps
    >>> nu308 = ehdmaps.law(ehdmaps.BearingGeometry.named("NU308"), ehdmaps.Lubricant.named("FVA3"))  # doctest: +SKIP
    """
    bearing = of if isinstance(of, BearingGeometry) else None
    contacts = of.contacts(material, structural_law) if isinstance(of, BearingGeometry) else (of,)
    by_name = {contact.name: contact for contact in contacts}
    allowed = (["series"] if bearing else []) + list(by_name)
    chosen = kind or allowed[0]
    if chosen not in allowed:
        raise InputError(f"contact law, kind: got {kind!r}; allowed: {', '.join(allowed)}")
    job = Job.build(
        lubricant=lubricant,
        loads=loads,
        entrainment_speeds=entrainment_speeds,
        temperatures=temperatures,
        bearing=bearing,
        contact=None if bearing else contacts[0],
        material=material,
        structural_law=structural_law,
    )
    refined = refinement(job, solver or TableSolver(ReynoldsSolver(**GRID)))
    assert refined is not None
    group = backbone_group(refined, {task.key: task.run() for task in refined.tasks})
    read: Sequence[LineContact] = contacts if chosen == "series" else (by_name[chosen],)
    return ContactLaw(
        chosen,  # type: ignore[arg-type]
        read,
        job.lubricant,
        line_field(group, read, job.lubricant, loads, entrainment_speeds, temperatures),
        outside,
        rolling=rolling_film_of_lines(group, contacts, job.lubricant, loads, temperatures),
        supply=supply,
        surface=surface,
    )
