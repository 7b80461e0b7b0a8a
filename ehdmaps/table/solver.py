"""The film table as a contact solver: reads films where the table has them, and has the others solved.

Whatever takes a solver takes it: maps, lines of a law, single points.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from ehdmaps.arrays import BoolArray, FloatArray
from ehdmaps.physics.closed_form import THICKEST_FILM
from ehdmaps.physics.contact import LineContact, OperatingPoint
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.solution import (
    ContactSolver,
    ContactSolverDefaults,
    FilmSolution,
    FilmSpectrum,
    Status,
    natural_to_hertz,
    no_spectrum,
)
from ehdmaps.table.family import outside_family
from ehdmaps.table.fields import FILMS, NATURAL_FREQUENCIES
from ehdmaps.table.file import CHECKSUM, film_table, shipped_tables
from ehdmaps.table.films import TableFilms

TOLERANCE = 0.05
"""`TableFilms.law_error` above which a film is solved: some per mille of a stiffness."""


@dataclass(frozen=True)
class TableSolver(ContactSolverDefaults):
    """Films from the table, and from another solver where the table has none.

    Attributes
    ----------
    other : ContactSolver
        Solves what the table does not know: its films are the same ones, see `outside_family`.
    tolerance : float
        Largest `TableFilms.law_error` of a film that is read.
    thickest_film : float
        Largest h/R that is read; infinite for lines that stand for their groups only, for which `other` has to be as
        generous.
    """

    other: ContactSolver
    tolerance: float = TOLERANCE
    thickest_film: float = THICKEST_FILM

    @property
    def name(self) -> str:
        """Name of the solver."""
        return self.other.name

    @property
    def wants_backbone(self) -> bool:
        """As the other solver."""
        return self.other.wants_backbone

    @property
    def natural_frequencies(self) -> tuple[float, ...]:
        """As the other solver."""
        return self.other.natural_frequencies

    def settings(self) -> dict[str, float | int | str]:
        """Settings of the other solver, and which table is read."""
        table = shipped_tables().attributes[CHECKSUM]
        return {**self.other.settings(), "film_table": table, "table_tolerance": self.tolerance}

    def solve_line(
        self,
        contact: LineContact,
        lubricant: Lubricant,
        loads: tuple[float, ...],
        entrainment_speed: float,
        temperature: float,
    ) -> tuple[FilmSolution, ...]:
        """Films at each load; arguments as of `ContactSolver.solve_line`."""
        films, known = self._read(contact, lubricant, loads, entrainment_speed, temperature, False)
        rest = tuple(load for load, here in zip(loads, known, strict=True) if not here)
        solved = iter(self.other.solve_line(contact, lubricant, rest, entrainment_speed, temperature) if rest else ())
        return tuple(_solution(films, i) if here else next(solved) for i, here in enumerate(known))

    def line_spectra(
        self,
        contact: LineContact,
        lubricant: Lubricant,
        loads: tuple[float, ...],
        entrainment_speed: float,
        temperature: float,
    ) -> tuple[FilmSpectrum, ...]:
        """Films over the natural frequencies; arguments as of `ContactSolver.solve_line`."""
        films, known = self._read(contact, lubricant, loads, entrainment_speed, temperature, True)
        known &= self.natural_frequencies == NATURAL_FREQUENCIES
        rest = tuple(load for load, here in zip(loads, known, strict=True) if not here)
        solved = iter(self.other.line_spectra(contact, lubricant, rest, entrainment_speed, temperature) if rest else ())
        spectra = []
        for i, (load, here) in enumerate(zip(loads, known, strict=True)):
            if not here:
                spectra.append(next(solved))
                continue
            film, point = _solution(films, i), OperatingPoint(load, entrainment_speed, temperature)
            frequencies = natural_to_hertz(NATURAL_FREQUENCIES, film, contact, point)
            if entrainment_speed == 0.0:
                spectra.append(no_spectrum(film, frequencies))
                continue
            errors = films.errors["response"][i] * films.response[i]
            spectra.append(FilmSpectrum(film, frequencies, films.response[i], errors[:, None]))
        return tuple(spectra)

    def film_spectrum(
        self, contact: LineContact, lubricant: Lubricant, point: OperatingPoint, frequencies: FloatArray
    ) -> FilmSpectrum:
        """As the other solver: the table has its own frequencies only; arguments as of `ContactSolver`."""
        return self.other.film_spectrum(contact, lubricant, point, frequencies)

    def _read(
        self,
        contact: LineContact,
        lubricant: Lubricant,
        loads: tuple[float, ...],
        speed: float,
        temperature: float,
        response: bool,
    ) -> tuple[TableFilms, BoolArray]:
        """Films from the table, and which of them are taken."""
        table = film_table(lubricant)
        films = table.films(
            contact, lubricant, np.array(loads), speed, temperature, response=response, thickest_film=self.thickest_film
        )
        if outside_family(self.other):
            return films, np.zeros(len(loads), dtype=bool)
        return films, films.usable & (films.law_error <= self.tolerance)


def _solution(films: TableFilms, i: int) -> FilmSolution:
    """One film as solvers give it."""
    numbers: dict[str, Any] = {field.name: float(getattr(films, field.name)[i]) for field in FILMS}
    errors: dict[str, Any] = {
        f"{name}_error": float(films.errors[name][i]) for name in numbers if name != "wall_stress"
    }
    return FilmSolution(
        status=Status(int(films.status[i])),
        reason=str(films.reason[i]),
        traction=0.0,
        viscosity_extrapolated=bool(films.viscosity_extrapolated[i]),
        **numbers,
        **errors,
    )
