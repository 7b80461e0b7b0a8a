"""The units of work of a map, each with the key of everything that shapes its numbers."""

from __future__ import annotations

import hashlib
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from ehdmaps.jobs.job import Job, record_json
from ehdmaps.jobs.store import Arrays
from ehdmaps.physics.contact import LineContact
from ehdmaps.physics.heat import ISOTHERMAL
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.solids import Material
from ehdmaps.physics.solution import ContactSolver, FilmSolution, FilmSpectrum, Status, no_spectrum
from ehdmaps.provenance import PACKAGES, code_hash

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

LATER_FIELDS = ("rolling_force", "mass_flow", "rolling_force_error", "mass_flow_error", *FOUND_BY_SOME)
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
        record = {
            "kind": "line",
            "radius": self.contact.radius,
            "youngs_modulus": self.contact.material.youngs_modulus,
            "poisson_ratio": self.contact.material.poisson_ratio,
            **_solid_heat(self.contact.material, self.solver),
            "lubricant": {key: value for key, value in self.lubricant.record().items() if key not in _SHOWN},
            "loads": self.loads,
            "entrainment_speed": self.entrainment_speed,
            "temperature": self.temperature,
            "solver": self.solver.name,
            "settings": self.solver.settings(),
            "version": solver_version(self.solver),
            "fields": [name for name in FILM_FIELDS if name not in LATER_FIELDS],
            **({"natural_frequencies": self.natural_frequencies} if self.natural_frequencies else {}),
        }
        return hashlib.sha256(record_json(record).encode()).hexdigest()

    @property
    def points(self) -> int:
        """Number of points in the task."""
        return len(self.loads)

    @property
    def slow(self) -> bool:
        """Whether every point deserves to be brought to the disk at once."""
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
        """Whether no point failed: a crash, a kill or an end of time may not happen again."""
        return not (arrays["status"] == int(Status.FAILED)).any()


def knows_heat(solver: ContactSolver) -> bool:
    """Whether films of a solver hang on heat, which its settings say by the key physics."""
    return solver.settings().get("physics", ISOTHERMAL) != ISOTHERMAL


def _solid_heat(material: Material, solver: ContactSolver) -> dict[str, dict[str, float]]:
    """What heat takes of the solids, for the key of a task; nothing of an isothermal solver."""
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
