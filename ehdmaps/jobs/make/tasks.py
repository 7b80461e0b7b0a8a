"""The units of work of a map, each with the key of what shapes its numbers; which lines are solved for its law."""

from __future__ import annotations

import hashlib
import math
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ehdmaps.jobs.job import Job
from ehdmaps.maps import schema
from ehdmaps.maps.backbone import ERROR, FILMS, IMAGINARY, REAL
from ehdmaps.maps.backbone_plan import BackbonePlan, Steps, plan_backbone, plan_own_lines
from ehdmaps.maps.records import record_json, reference_json
from ehdmaps.maps.rolling_film import NAMES as ROLLING
from ehdmaps.physics.contact import LineContact
from ehdmaps.physics.heat import ISOTHERMAL
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.solids import Material
from ehdmaps.physics.solution import ContactSolver, FilmSolution, FilmSpectrum, Status, no_spectrum, usable_points
from ehdmaps.provenance import PACKAGES, code_hash
from ehdmaps.table.solver import TableSolver
from ehdmaps.units import LOAD, point_text

if TYPE_CHECKING:
    import xarray as xr

    from ehdmaps.jobs.make.store import Arrays, Site

LONGEST_LINE = 32
"""Loads of one task, which is lost as a whole when its process is killed: well under a second."""

_SHOWN = ("label", "estimated", "fitted_pressure_stated")
"""Entries of an oil's record that are only shown."""

_TYPES: Mapping[str, Any] = {
    "status": np.int8,
    "reason": np.str_,
    "iterations": np.int32,
    "viscosity_extrapolated": np.int8,
}
SPECTRUM_FIELDS = ("response_real", "response_imaginary", "response_error")
"""Complex film compliance over load and natural frequency [m2/N], and its error, relative to its magnitude."""

FILM_FIELDS = tuple(field.name for field in fields(FilmSolution))
FOUND_BY_SOME = ("traction", "wall_stress", "film_temperature", "surface_temperature")
"""Fields that only films with sliding, shear laws or heat have: a map without any value of one is made without it."""

ERRORS_OF_SOME = ("film_temperature_error", "surface_temperature_error")
"""Errors of some of these, likewise."""

LATER_FIELDS = ("rolling_force", "mass_flow", "rolling_force_error", "mass_flow_error", *FOUND_BY_SOME, *ERRORS_OF_SOME)
"""Fields that came after maps had been made: results that lack them, and took days, are taken over without them."""


@dataclass(frozen=True)
class LineTask:
    """The films along one line of loads, at fixed contact, speed and temperature.

    A solver may start a load from the one before it, but a line knows nothing of other lines: results do not
    depend on the order of solving or on interruptions. Films only: the structural part is added when the map
    is assembled.

    Attributes
    ----------
    contact, lubricant, solver
        What is solved, and how.
    loads : tuple of float
        [N/m].
    entrainment_speed : float
        [m/s].
    temperature : float
        [K].
    natural_frequencies : tuple of float
        omega sqrt(b^2 + 2 h R)/u at which the film compliance is wanted besides; those of the solver, or none.
    place : tuple of int
        Start of the line in the map: indices of contact, load, entrainment speed, temperature. Not in
        the key.
    """

    contact: LineContact
    lubricant: Lubricant
    loads: tuple[float, ...]
    entrainment_speed: float
    temperature: float
    solver: ContactSolver
    natural_frequencies: tuple[float, ...] = ()
    place: tuple[int, int, int, int] = (0, 0, 0, 0)

    @cached_property
    def key(self) -> str:
        """Hash of what changes the numbers, and of their names; the structural law does not change a film."""
        place = {"loads": self.loads, "entrainment_speed": self.entrainment_speed, "temperature": self.temperature}
        return hashlib.sha256(record_json({**self._family, **place}).encode()).hexdigest()

    @cached_property
    def site(self) -> Site:
        """Site by which the same points on other axes are found: loads, temperature and speed but for round-off."""
        family = hashlib.sha256(record_json(self._family).encode()).hexdigest()
        return family, (*self.loads, self.temperature, self.entrainment_speed)

    @property
    def _family(self) -> dict[str, Any]:
        """All that changes the numbers but the operating points."""
        return {
            "kind": "line",
            "radius": self.contact.radius,
            "youngs_modulus": self.contact.material.youngs_modulus,
            "poisson_ratio": self.contact.material.poisson_ratio,
            **_solid_heat(self.contact.material, self.solver),
            "lubricant": {key: value for key, value in self.lubricant.record().items() if key not in _SHOWN},
            "solver": self.solver.name,
            "settings": self.solver.settings(),
            "version": solver_version(self.solver),
            "fields": [name for name in FILM_FIELDS if name not in LATER_FIELDS],
            **({"natural_frequencies": self.natural_frequencies} if self.natural_frequencies else {}),
        }

    @property
    def points(self) -> int:
        """Number of points in the task."""
        return len(self.loads)

    @property
    def by(self) -> str:
        """Name of the solver."""
        return self.solver.name

    @property
    def slow(self) -> bool:
        """True where every point deserves to be brought to the disk at once."""
        return self.solver.slow

    def run(self) -> Arrays:
        """Solve the line; arrays over the loads, by the names of `FilmSolution` and `SPECTRUM_FIELDS`."""
        line = self.contact, self.lubricant, self.loads, self.entrainment_speed, self.temperature
        if not self.natural_frequencies:
            return film_arrays(self.solver.solve_line(*line))
        return _spectrum_arrays(self.solver.line_spectra(*line))

    def failed(self, reason: str) -> Arrays:
        """Return the result of a line that gave none."""
        film = FilmSolution(Status.FAILED, reason)
        if not self.natural_frequencies:
            return film_arrays([film] * self.points)
        return _spectrum_arrays([no_spectrum(film, np.array(self.natural_frequencies))] * self.points)

    def is_final(self, arrays: Arrays) -> bool:
        """Tell whether no point failed: a crash, a kill or an end of time may not happen again."""
        return not (arrays["status"] == int(Status.FAILED)).any()

    def where(self, points: Sequence[int]) -> str:
        """Say for people which of its points these are."""
        loads = [self.loads[point] for point in points]
        first, *rest = point_text(loads[0], self.entrainment_speed, self.temperature).split(", ")
        load = f"{len(loads)} loads from {first} to {LOAD.text(loads[-1])}" if len(loads) > 1 else first
        return ", ".join([self.contact.name, load, *rest])


def knows_heat(solver: ContactSolver) -> bool:
    """Tell whether films of a solver depend on heat, which its settings say by the key physics."""
    return solver.settings().get("physics", ISOTHERMAL) != ISOTHERMAL


def _solid_heat(material: Material, solver: ContactSolver) -> dict[str, dict[str, float]]:
    """Data of the solids that heat needs, for the key of a task; none for an isothermal solver."""
    if not knows_heat(solver):
        return {}
    return {"solids": {name: getattr(material, name) for name in ("conductivity", "heat_capacity", "density")}}


def film_arrays(films: Sequence[FilmSolution]) -> Arrays:
    """Turn films into arrays by field name."""
    return {
        name: np.array([getattr(film, name) for film in films], _TYPES.get(name, np.float64)) for name in FILM_FIELDS
    }


def with_later_fields(arrays: Arrays) -> Arrays:
    """A line as it was stored, with NaN for the fields that there were not yet when it was solved."""
    missing = {name: np.full(arrays["status"].shape, np.nan) for name in LATER_FIELDS if name not in arrays}
    return {**arrays, **missing}


def _spectrum_arrays(spectra: Sequence[FilmSpectrum]) -> Arrays:
    """Turn films over frequency into arrays by field name."""
    response = np.array([spectrum.compliance for spectrum in spectra])
    error = np.array([spectrum.largest_error for spectrum in spectra])
    added = zip(SPECTRUM_FIELDS, (response.real, response.imag, error), strict=True)
    return {**film_arrays([spectrum.film for spectrum in spectra]), **dict(added)}


def line_tasks(job: Job, solver: ContactSolver) -> tuple[LineTask, ...]:
    """Return the tasks of a whole map: lines of loads, or single points for a slow solver."""
    length = 1 if solver.slow else LONGEST_LINE
    return tuple(
        LineTask(
            contact=contact,
            lubricant=job.lubricant,
            loads=job.loads[start : start + length],
            entrainment_speed=speed,
            temperature=temperature,
            solver=solver,
            place=(i, start, j, k),
        )
        for k, temperature in enumerate(job.temperatures)
        for j, speed in enumerate(job.entrainment_speeds)
        for i, contact in enumerate(job.contacts)
        for start in range(0, len(job.loads), length)
    )


def solver_version(solver: ContactSolver) -> str:
    """Return what tells one version of a solver from the next.

    Its `version` where that is not None: results that took days should not be lost to an edited comment.
    Else the hash of all that numbers are computed with, so that a changed formula never meets stale results; of a
    solver from elsewhere with a hash of its file.
    """
    if solver.version is not None:
        return solver.version
    module = type(solver).__module__
    if module.partition(".")[0] in PACKAGES:
        return code_hash()
    path = getattr(sys.modules.get(module), "__file__", None)
    return f"{code_hash()}-{hashlib.sha256(Path(path).read_bytes()).hexdigest()[:16] if path else module}"


MOST_LINE_POINTS = 40_000
"""Points of the lines that are not exceeded by halving a step: minutes on one core."""


@dataclass(frozen=True)
class Refinement:
    """Plans of a backbone, its steps, and its tasks, one a line and in the plans' order.

    There is one plan for all contacts, or one a contact where films know heat, see `ehdmaps.maps.grid_field`.
    """

    plans: tuple[BackbonePlan, ...]
    steps: Steps
    tasks: tuple[LineTask, ...]

    @property
    def points(self) -> int:
        """Number of points to solve."""
        return sum(task.points for task in self.tasks)


def refinement(job: Job, solver: ContactSolver, steps: Steps | None = None) -> Refinement | None:
    """Plan the backbone of a job; None where the solver does not ask for one or the job declines it.

    Parameters
    ----------
    job : Job
        What to make.
    solver : ContactSolver
        What solves it.
    steps : Steps, optional
        Largest steps of the backbone; those of the job if left out.
    """
    steps = steps or job.line_steps
    if not solver.wants_backbone or job.backbone == "none":
        return None
    axes = job.lubricant, job.loads, job.entrainment_speeds, job.temperatures, steps
    if knows_heat(solver):
        plans = plan_own_lines(job.contacts, *axes)
    else:
        shared = plan_backbone(job.contacts, *axes)
        plans = (shared,) if shared is not None else ()
    if not plans:
        return None
    # these lines stand for their groups: how thick their own film is does not matter
    generous = of_groups(solver)
    tasks = tuple(
        LineTask(
            contact=plan.contact,
            lubricant=job.lubricant,
            loads=line.loads,
            entrainment_speed=line.speed,
            temperature=line.temperature,
            solver=generous,
            natural_frequencies=solver.natural_frequencies,
        )
        for plan in plans
        for line in plan.lines
    )
    return Refinement(plans, steps, tasks)


def of_groups(solver: ContactSolver) -> ContactSolver:
    """The solver for films whose own thickness does not matter.

    Parameters
    ----------
    solver : ContactSolver
        Any solver; `reynolds`, and the film table above it, then refuse no thick film.
    """
    if isinstance(solver, TableSolver):
        return replace(solver, other=of_groups(solver.other), thickest_film=math.inf)
    return replace(solver, thickest_film=math.inf) if solver.name == "reynolds" else solver  # type: ignore[type-var]


def backbone_group(refined: Refinement, results: Mapping[str, Arrays]) -> xr.Dataset:
    """Put the lines in their places: the group "backbone" of the map file."""
    first = refined.plans[0]
    natural = refined.tasks[0].natural_frequencies if refined.tasks else ()
    values: dict[str, npt.NDArray[Any]] = {}
    start = 0
    for plan, prefix in zip(refined.plans, ("", schema.OWN), strict=False):
        tasks = refined.tasks[start : start + len(plan.lines)]
        start += len(plan.lines)
        values |= {f"{prefix}{name}": array for name, array in _films(plan, tasks, natural, results).items()}
    axes = {"zeta": first.zeta, "reference_speed": first.speeds, "temperature": first.temperatures}
    return schema.backbone(
        axes | ({schema.NATURAL: natural} if natural else {}),
        values,
        {
            "title": "films of a reference contact, from which the contact laws of the map are made",
            schema.REFERENCE_CONTACT: reference_json(first.contact),
        },
    )


def _films(
    plan: BackbonePlan, tasks: Sequence[LineTask], natural: tuple[float, ...], results: Mapping[str, Arrays]
) -> dict[str, npt.NDArray[Any]]:
    """Arrays of the films of one plan, by the names of the table."""
    shape = (len(plan.zeta), len(plan.speeds), len(plan.temperatures))
    values = {name: np.full(shape, np.nan) for name in (*FILMS, *ROLLING)}
    sources = {name: name for name in (*FILMS, *ROLLING)}
    if natural:
        sources |= dict(zip((REAL, IMAGINARY, ERROR), SPECTRUM_FIELDS, strict=True))
        values |= {name: np.full((*shape, len(natural)), np.nan) for name in (REAL, IMAGINARY, ERROR)}
    status = np.full(shape, schema.NOT_NEEDED, dtype=np.int8)
    for line, task in zip(plan.lines, tasks, strict=True):
        first, speed, temperature = line.place
        along = slice(first, first + task.points)
        arrays = with_later_fields(results[task.key])
        status[along, speed, temperature] = arrays["status"]
        usable = usable_points(arrays["status"])
        for name, array in values.items():
            column = arrays[sources[name]]
            array[along, speed, temperature] = np.where(usable if column.ndim == 1 else usable[:, None], column, np.nan)
    return {**values, "status": status}
