"""The contact data of the thesis that the project starts from, by all solvers, for two oils and with growing physics.

Run: python -m tests.benchmarks.thesis_points > table.md

N1014: a slice of 0.45 mm; the thesis gives mean cage speeds, the entrainment speed is 1.099 times as much. NU308: a
slice of 0.7 mm under 62 N, 0.43 to 1.7 m/s taken as entrainment speed. Inner / outer contact, ISO 16281 structure. The
thin oil has 16 mm^2/s (its value at 40 degC), 870 kg/m^3 and 20 1/GPa: assumptions, the same at 30 degC. Each oil is
taken as isothermal and Newtonian, then with the limiting shear stress that real oils have, then with heat besides.
"""

from __future__ import annotations

from dataclasses import replace

from ehdmaps.physics.bearing import BearingGeometry
from ehdmaps.physics.closed_form import FormulaSolver, HertzSolver
from ehdmaps.physics.contact import LineContact, OperatingPoint
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.solids import STEEL
from ehdmaps.physics.solution import ContactSolver, contact_solution
from tests.cases.physics_ways import NOT_THERE, solver_of

THIN = replace(
    Lubricant.roelands(viscosity=16e-6 * 870.0, pressure_viscosity=2e-8, density=870.0), thermal_conductivity=0.134
)
OILS = {"FVA 3": Lubricant.named("FVA3"), "16 mm^2/s": THIN}
WAYS = ("newtonian", "limiting", "thermal, limiting")
CLOSED: dict[str, ContactSolver] = {"hertz": HertzSolver(), "formula": FormulaSolver()}
"""Solvers that know nothing of shear and heat."""

FILMS = ("reynolds", "thin_film", "full_stress")
POINTS = (
    ("N1014", 40.0, 0.45e-3, 3.297, 40.0, "CFD 1.8e7, 15; Reynolds 1.49e7, 24; Hertz 2.1e7"),
    ("N1014", 15.5, 0.45e-3, 5.935, 30.0, "CFD 1.595e7, 13.26"),
    ("NU308", 62.0, 0.7e-3, 0.43, 40.0, "k and c fall with speed"),
    ("NU308", 62.0, 0.7e-3, 1.0, 40.0, "k and c fall with speed"),
    ("NU308", 62.0, 0.7e-3, 1.7, 40.0, "k and c fall with speed"),
)


def cell(
    solver: ContactSolver | None,
    contacts: tuple[LineContact, ...],
    oil: Lubricant,
    point: OperatingPoint,
    length: float,
) -> str:
    """Stiffness [N/m] and damping [N s/m] of the slice, inner / outer."""
    if solver is None:
        return NOT_THERE
    solutions = []
    for contact in contacts:
        (film,) = solver.solve_line(contact, oil, (point.load,), point.entrainment_speed, point.temperature)
        solutions.append(contact_solution(film, contact, point))
    if not all(solution.status.usable for solution in solutions):
        return ", ".join(sorted({solution.status.word for solution in solutions})).replace("_", " ")
    stiffness = " / ".join(f"{solution.stiffness * length:.3e}".replace("e+0", "e") for solution in solutions)
    return f"{stiffness}, {' / '.join(f'{solution.damping * length:.3g}' for solution in solutions)}"


def main() -> None:
    """Print the table: k [N/m], c [N s/m] of a slice."""
    names = [*CLOSED, *(f"openfoam {name}" if name != "reynolds" else name for name in FILMS)]
    print(f"| point | oil | physics | {' | '.join(names)} | thesis |")
    print("|" + "---|" * (len(names) + 4))
    for bearing, force, length, speed, celsius, thesis in POINTS:
        contacts = tuple(BearingGeometry.named(bearing).contacts(STEEL, "iso16281"))
        point = OperatingPoint(force / length, speed, celsius + 273.15)
        where = f"{bearing}, {force:g} N, {speed:g} m/s, {celsius:g} degC"
        for name, oil in OILS.items():
            for way in WAYS:
                closed = [
                    cell(solver, contacts, oil, point, length) if way == WAYS[0] else "" for solver in CLOSED.values()
                ]
                solved = [cell(solver_of(film, way), contacts, oil, point, length) for film in FILMS]
                print(f"| {where} | {name} | {way} | {' | '.join([*closed, *solved])} | {thesis} |", flush=True)


if __name__ == "__main__":
    main()
