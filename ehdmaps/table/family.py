"""Which films the table knows: those of smooth, flooded, Newtonian, isothermal line contacts."""

from __future__ import annotations

from typing import Any

from ehdmaps.physics.solution import ContactSolver

TABLE_OF = "reynolds"
"""Solver whose films the table holds."""

GRID: dict[str, Any] = {"density": 10.0, "inlet_length": 700.0}
"""Settings of that solver: finer than its own, so that what is read and what is solved beside it fit together."""

_MEANING = {
    "physics": "heat in the film",
    "shear": "a law of shear",
    "slide_to_roll": "traction of a sliding contact",
}


def outside_family(solver: ContactSolver) -> str:
    """Why films of a solver are not those of the table; empty where they are.

    Roughness, layers and starvation come on top of these films: what adds them asks for smooth, flooded films first.

    Parameters
    ----------
    solver : ContactSolver
        The solver, with its settings.
    """
    if solver.name != TABLE_OF:
        return f"film table: holds films of the solver {TABLE_OF}, not of {solver.name}; solve them"
    settings = solver.settings()
    asked = [f"{meaning} ({key} = {settings[key]})" for key, meaning in _MEANING.items() if key in settings]
    if asked:
        return f"film table: knows nothing of {', '.join(asked)}; solve these films"
    return ""
