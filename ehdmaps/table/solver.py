"""Films of a map that are to be read from the film table, as a contact solver: what is solved beside them."""

from __future__ import annotations

from dataclasses import dataclass

from ehdmaps.arrays import FloatArray
from ehdmaps.physics.closed_form import THICKEST_FILM
from ehdmaps.physics.contact import LineContact, OperatingPoint
from ehdmaps.physics.heat import INLET_HEAT
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.solution import ContactSolver, ContactSolverDefaults, FilmSolution, FilmSpectrum
from ehdmaps.table.file import CHECKSUM, shipped_tables


@dataclass(frozen=True)
class TableSolver(ContactSolverDefaults):
    """Says that the films of a map are those of the table; single points, as those of a check, another solver solves.

    Attributes
    ----------
    other : ContactSolver
        Solves on the grid of the table, see `ehdmaps.table.coordinates.GRID`.
    thickest_film : float
        Largest h/R that is no refusal; infinite for maps that are there for their laws only.
    inlet_heat : bool
        Whether heat in the inlet thins the films, by its rule; what another solver solves is isothermal.
    """

    other: ContactSolver
    thickest_film: float = THICKEST_FILM
    inlet_heat: bool = False

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
        heat = {"physics": INLET_HEAT} if self.inlet_heat else {}
        return {**self.other.settings(), **heat, "film_table": shipped_tables().attributes[CHECKSUM]}

    def solve_line(
        self,
        contact: LineContact,
        lubricant: Lubricant,
        loads: tuple[float, ...],
        entrainment_speed: float,
        temperature: float,
    ) -> tuple[FilmSolution, ...]:
        """As the other solver; arguments as of `ContactSolver.solve_line`."""
        return self.other.solve_line(contact, lubricant, loads, entrainment_speed, temperature)

    def film_spectrum(
        self, contact: LineContact, lubricant: Lubricant, point: OperatingPoint, frequencies: FloatArray
    ) -> FilmSpectrum:
        """As the other solver; arguments as of `ContactSolver.film_spectrum`."""
        return self.other.film_spectrum(contact, lubricant, point, frequencies)
