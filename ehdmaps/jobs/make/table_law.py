"""Contact laws without a file of a map: a map in memory, with films from the film table."""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import InputError, MapError
from ehdmaps.jobs import solvers
from ehdmaps.jobs.balls import balls_of
from ehdmaps.jobs.job import Job
from ehdmaps.jobs.make.table_films import table_films, unserved
from ehdmaps.jobs.make.tasks import of_groups
from ehdmaps.jobs.solvers import TABLE
from ehdmaps.maps.emap import EHDMap
from ehdmaps.maps.kernels.kept_tables import KeptPickles, keeping, key_of
from ehdmaps.maps.law import ContactLaw, LawKind, OutsidePolicy
from ehdmaps.physics.approach import StructuralLaw
from ehdmaps.physics.bearing import BearingGeometry
from ehdmaps.physics.catalogue import designated
from ehdmaps.physics.contact import LineContact
from ehdmaps.physics.heat import INLET_HEAT, ISOTHERMAL, heat_data, heat_in_force
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.oil_supply import FLOODED, FilmConditions, OilSupply
from ehdmaps.physics.point.ball_geometry import BallGeometry
from ehdmaps.physics.solids import STEEL, Material
from ehdmaps.physics.solution import ContactSolver
from ehdmaps.physics.surface import SMOOTH, Surface
from ehdmaps.table.solver import TableSolver

if TYPE_CHECKING:
    import xarray as xr

    from ehdmaps.maps.points.law import PointLaw

LOADS, SPEEDS, TEMPERATURES = (100.0, 1e6), (0.05, 10.0), (293.15, 393.15)
"""Ranges of a law for which nothing else is said: those of the shipped jobs [N/m], [m/s], [K]."""

_MOST_MADE = 8
_made: dict[str, EHDMap] = {}
"""The last maps of this process by what was asked for, with the laws that were made of them."""

VARIABLE = "EHDMAPS_LAWS"
"""Environment variable that names the folder of laws that were made before; ``off`` keeps none."""

_MOST_KEPT = 20
"""Laws that are kept there, of some 7 MB each."""

_laws: dict[str, ContactLaw] = {}
"""Laws of this process that are kept, by what was asked for."""

_POINTS = (25, 12, 6)
"""Loads, speeds and temperatures of a map in memory: for its error estimates, as laws read the film table."""


class ReadMap(EHDMap):
    """A map in memory whose films the table has: its laws do without a dataset, which is made when it is asked for.

    Parameters
    ----------
    job : Job
        Job of the map, which the film table serves, see `ehdmaps.jobs.make.table_films.unserved`.
    solver : TableSolver
        What gives its films.
    """

    from_table = True

    def __init__(self, job: Job, solver: TableSolver) -> None:
        self._job, self._read = job, solver
        self.backbone = None
        self.contacts, self.lubricant, self.bearing = job.contacts, job.lubricant, job.bearing
        self.supply, self.surface = job.supply or FLOODED, job.surface or SMOOTH
        self.solver = solver.name
        self.inlet_heat = solver.inlet_heat
        self.physics = INLET_HEAT if solver.inlet_heat else ISOTHERMAL

    def __getstate__(self) -> dict[str, Any]:
        """For other processes, which make again what follows from the job."""
        made = ("dataset", "_values", "rolling_film", "_laws")
        return {name: value for name, value in self.__dict__.items() if name not in made}

    @cached_property
    def dataset(self) -> xr.Dataset:
        """All that the map holds."""
        from ehdmaps.jobs.make.generate import read_in_memory

        return EHDMap(read_in_memory(self._job, self._read)).dataset

    @property
    def attributes(self) -> dict[str, Any]:
        """Nothing that its laws or their errors ask for: they were not checked."""
        return {}

    def axis(self, name: str) -> FloatArray:
        """Values of an axis; see `EHDMap.axis`."""
        job = self._job
        axes = {"load": job.loads, "entrainment_speed": job.entrainment_speeds, "temperature": job.temperatures}
        return np.array(axes[name], dtype=np.float64)

    def points(self, name: str) -> FloatArray | None:
        """A variable at all points; see `EHDMap.points`."""
        return self._values.get(name)

    @cached_property
    def _values(self) -> dict[str, npt.NDArray[Any]]:
        """Variables by name."""
        from ehdmaps.jobs.make.assemble import assembled

        return assembled(self._job, table_films(self._job, self._read))


def table_map(
    of: BearingGeometry | LineContact,
    lubricant: Lubricant,
    loads: tuple[float, float] = LOADS,
    entrainment_speeds: tuple[float, float] = SPEEDS,
    temperatures: tuple[float, float] | None = None,
    structural_law: StructuralLaw = "iso16281",
    material: Material = STEEL,
    supply: OilSupply | None = None,
    surface: Surface | None = None,
    solver: ContactSolver | None = None,
    inlet_heat: bool | None = False,
) -> EHDMap:
    """Make a map in memory, in about a second, with few points: it is there for its laws.

    Films come from the film table; where it does not serve, all are solved. The laws are not checked by fresh solves.
    What was made is kept: the same map, with its laws, is a moment's work when it is asked for again.

    Parameters
    ----------
    of : BearingGeometry or LineContact
        A bearing, or one contact.
    lubricant : Lubricant
        The oil.
    loads, entrainment_speeds : (float, float)
        Ranges of the laws [N/m], [m/s] > 0.
    temperatures : (float, float), optional
        The same [K]; if left out `TEMPERATURES`, as far as the laws of the oil hold and films are known.
    structural_law : str
        Law of the solids of a bearing's contacts.
    material : Material
        Material of a bearing.
    supply, surface : OilSupply, Surface, optional
        Oil supply and surfaces that the laws have by default; flooded and smooth if left out.
    solver : ContactSolver, optional
        What gives the films; the table if left out.
    inlet_heat : bool or None
        Whether heat in the inlet thins the films of the table, by its rule (`ehdmaps.physics.heat`); None for yes where
        the conductivity of the oil is known and the table serves.

    Raises
    ------
    InputError
        For ranges that no map could have; for heat where the table does not serve, or of an oil without conductivity.
    """
    bearing = of if isinstance(of, BearingGeometry) else None
    if temperatures is None:
        from ehdmaps.jobs.defaults import served  # with the texts of jobs, which others do without

        contacts = of.contacts(material, structural_law) if isinstance(of, BearingGeometry) else (of,)
        every = tuple(np.linspace(*TEMPERATURES, _POINTS[2]).tolist())
        known = served(lubricant, every, contacts, entrainment_speeds[1])
        temperatures = known[0], known[-1]
    ranges, solids = (loads, entrainment_speeds, temperatures), (structural_law, material)
    asked = of, lubricant, *ranges, *solids, supply, surface, inlet_heat
    key = key_of(*asked) if keeping() and solver is None else ""
    if key in _made:
        return _made[key]
    job = Job.build(
        lubricant=lubricant,
        loads=np.geomspace(*loads, _POINTS[0]),
        entrainment_speeds=np.geomspace(*entrainment_speeds, _points(entrainment_speeds, _POINTS[1])),
        temperatures=np.linspace(*temperatures, _points(temperatures, _POINTS[2])),
        bearing=bearing,
        contact=of if isinstance(of, LineContact) else None,
        material=material,
        supply=supply,
        surface=surface,
        solver_options={"films": TABLE},
        structural_law=structural_law,
    )
    # laws let films fade where they are too thick for the points of a map
    chosen = of_groups(solver or solvers.of_map(job))
    why = unserved(job, chosen)
    if inlet_heat is None:
        inlet_heat = not why and heat_in_force(None, lubricant)
    if inlet_heat:
        heat_data(lubricant, material)
        if why:
            raise InputError(
                f"inlet heat of {job.title}: its films have to be solved ({why}); allowed: films of the film table; "
                'or physics isothermal; or a map by `ehdmaps generate` of a job with physics = "inlet-heat" in [solver]'
            )
    if isinstance(chosen, TableSolver) and not why:
        made: EHDMap = ReadMap(job, replace(chosen, inlet_heat=inlet_heat))
    else:
        from ehdmaps.jobs.make.generate import generate_in_memory  # with all that solves and writes a map

        solved = generate_in_memory(job, workers=1, solver=chosen)
        made = EHDMap(solved.dataset, solved.backbone)
    if key:
        while len(_made) >= _MOST_MADE:
            _made.pop(next(iter(_made)))
        _made[key] = made
    return made


def _points(ends: tuple[float, float], most: int) -> int:
    """Points of an axis: one where both ends are the same."""
    return most if ends[1] > ends[0] else 1


def job_map(job: Job, source: str) -> EHDMap:
    """Make the map of a job in memory, with films from the film table; its laws are not checked by fresh solves.

    Parameters
    ----------
    job : Job
        The job.
    source : str
        How it was given, for messages.

    Raises
    ------
    MapError
        If its films have to be solved.
    """
    solver = solvers.of_map(job)
    why = unserved(job, solver)
    if why:
        raise MapError(f"{source}: its films have to be solved ({why}); give the map that `ehdmaps generate` makes")
    from ehdmaps.jobs.make.generate import generate_in_memory

    made = generate_in_memory(replace(job, law_check=0), 1, solver=solver)
    return EHDMap(made.dataset, made.backbone)


def law(
    of: BearingGeometry | BallGeometry | LineContact | str,
    lubricant: Lubricant | str,
    kind: LawKind | None = None,
    loads: tuple[float, float] = LOADS,
    entrainment_speeds: tuple[float, float] = SPEEDS,
    temperatures: tuple[float, float] | None = None,
    outside: OutsidePolicy = "error",
    supply: OilSupply | None = None,
    surface: Surface | None = None,
    structural_law: StructuralLaw = "iso16281",
    material: Material = STEEL,
    solver: ContactSolver | None = None,
    inlet_heat: bool | None = None,
) -> ContactLaw | PointLaw:
    """Make a contact law without a map, in about a second; the same one again in a millisecond.

    It is kept in the user's folder for caches: another process reads it there in some 50 ms.

    Films come from the film table; where it does not serve, all are solved. The law of a ball bearing has the load of
    one ball [N], and reads the film table of points alone: of what follows it takes kind, material, supply, surface and
    heat.

    Parameters
    ----------
    of : BearingGeometry, BallGeometry, LineContact or str
        A bearing, or one contact; or the designation of a bearing, "NU210" or "6208", whose inner geometry is estimated
        where it is not known.
    lubricant : Lubricant or str
        The oil, or its name or class: "FVA3", "ISO VG 46".
    kind : {"series", "inner", "outer", "line"}, optional
        Contact of a bearing, or a roller between both raceways, which is the default.
    loads, entrainment_speeds : (float, float)
        Ranges of the law [N/m], [m/s] > 0.
    temperatures : (float, float), optional
        The same [K]; if left out 20 to 120 degC, as far as the laws of the oil hold and films are known.
    outside, supply, surface
        Arguments of `EHDMap.law`.
    structural_law : str
        Law of the solids of a bearing's contacts.
    material : Material
        Material of a bearing.
    solver : ContactSolver, optional
        What gives the films; the table if left out.
    inlet_heat : bool, optional
        Whether heat in the inlet thins the films of the table, by its rule (`ehdmaps.physics.heat`); if left out yes,
        where the conductivity of the oil is known and the table serves. False for isothermal films.

    Raises
    ------
    InputError
        For a kind that there is not, for ranges that no map could have, and for heat of an oil without conductivity.
    MapError
        If films are missing that the law needs.

    Examples
    --------
    >>> import ehdmaps
    >>> nu308 = ehdmaps.law(ehdmaps.BearingGeometry.named("NU308"), ehdmaps.Lubricant.named("FVA3"))  # doctest: +SKIP
    """
    if isinstance(of, str):
        of = balls_of(of) or designated(of)
    lubricant = oil = Lubricant.named(lubricant) if isinstance(lubricant, str) else lubricant
    if isinstance(of, BallGeometry):
        if solver is not None:
            raise InputError("contact law of a ball: got a solver; allowed: none, films are read from the table")
        from ehdmaps.maps.points.law import PointLaw

        conditions = FilmConditions(heat_in_force(inlet_heat, lubricant), supply or FLOODED, surface or SMOOTH)
        return PointLaw(of, lubricant, "series" if kind is None else kind, material, conditions)
    source: BearingGeometry | LineContact = of
    allowed: tuple[LawKind, ...] = ("series", "inner", "outer") if isinstance(of, BearingGeometry) else ("line",)
    chosen = kind or allowed[0]
    if chosen not in allowed:
        raise InputError(f"contact law, kind: got {kind!r}; allowed: {', '.join(allowed)}")

    def made() -> ContactLaw:
        emap = table_map(
            source,
            oil,
            loads,
            entrainment_speeds,
            temperatures,
            structural_law=structural_law,
            material=material,
            solver=solver,
            inlet_heat=inlet_heat,
        )
        return emap.law(chosen, outside, supply=supply, surface=surface)

    ranges, states = (loads, entrainment_speeds, temperatures), (outside, supply, surface, inlet_heat)
    asked = of, lubricant, chosen, ranges, states, structural_law, material
    return made() if solver is not None else _kept(asked, made)


def _kept(asked: tuple[Any, ...], make: Callable[[], ContactLaw]) -> ContactLaw:
    """The law of this process or of an earlier one, or a law that is made, and kept."""
    key = key_of("law", *asked) if keeping() and os.environ.get(VARIABLE) != "off" else ""
    if key in _laws:
        return _laws[key].again()
    kept = KeptPickles("whole_laws", VARIABLE, _MOST_KEPT, [key])
    law = kept.get(0)
    if not isinstance(law, ContactLaw):
        law = make()
        kept.put(0, law)
    if kept.keeps:
        while len(_laws) >= _MOST_MADE:
            _laws.pop(next(iter(_laws)))
        _laws[key] = law
    return law
