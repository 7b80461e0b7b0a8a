"""How much a limiting shear stress changes a contact: by two solutions, as no closed form says it.

Where the pressure has a steep spike, a Newtonian oil would carry more shear stress at the walls than any oil bears
(`ehdmaps.physics.rheology`). A solution takes some hundredths of a second.
"""

from __future__ import annotations

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.jobs import solvers
from ehdmaps.physics.contact import OperatingPoint
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.solution import ContactSolution, ContactSolver, contact_solution
from mbs.analyses.film_criteria import ClosedContact


def shear_effect(state: ClosedContact, lubricant: Lubricant, loads: FloatArray) -> float:
    """By how much a limiting stress changes k or c, the largest over some loads, as a part of the Newtonian value.

    Parameters
    ----------
    state : ClosedContact
        Contact, speed and temperature.
    lubricant : Lubricant
        The oil.
    loads : ndarray, shape (n,)
        Loads [N/m], > 0, rising.

    Returns
    -------
    float
        -1 where no load has both solutions.
    """
    both = (solvers.build("reynolds", {"shear": shear}) for shear in ("newtonian", "limiting"))
    pairs = zip(*(_solved(solver, state, lubricant, loads) for solver in both), strict=True)
    sizes = [
        max(abs(limited.stiffness / plain.stiffness - 1.0), abs(limited.damping / plain.damping - 1.0))
        for plain, limited in pairs
        if plain.status.usable and limited.status.usable and plain.damping != 0.0
    ]
    return float(np.max(sizes, initial=-1.0))


def _solved(
    solver: ContactSolver, state: ClosedContact, lubricant: Lubricant, loads: FloatArray
) -> list[ContactSolution]:
    """Solutions at all loads."""
    films = solver.solve_line(state.contact, lubricant, tuple(loads.tolist()), state.speed, state.temperature)
    return [
        contact_solution(film, state.contact, OperatingPoint(load, state.speed, state.temperature))
        for film, load in zip(films, loads.tolist(), strict=True)
    ]
