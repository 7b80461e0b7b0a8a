"""Coordinates of the film table: zeta, the size of the speed, two of the oil; what is outside of the family.

The equations of a smooth, flooded, Newtonian, isothermal line contact know, in Hertz' units, the wedge 3 pi^2/(8 M^2),
and of the oil alpha p_H, the curvature p_H/p_0 of its viscosity with the exponent z, and p_H/p_r of its density,
p_r = 0.59 GPa. p_0 of Roelands and p_r are pressures that all oils share, and p_H = P sqrt(M/(2 pi)) with the
pressure P = L/alpha = E' (eta0 us/(E' R))^(1/4). So M, P, alpha and z say all: neither the viscosity nor E' or R is
left over, and one table serves every material.

Of an oil with a piezoviscosity to speak of, L and not P is what films hang on; of oils with hardly any it is P. The
table has a part for either, see `ehdmaps.table.films`:

============  =========================================================
piezoviscous  zeta, ln L, ln alpha, and the bend (1 - z) sqrt(ALPHA/alpha)
isoviscous    zeta, ln P, alpha, and 1 - z
============  =========================================================

z itself is no good axis where alpha is large: of two oils with the same z the one with the smaller alpha bends more
before its film is shut in. With the bend the nodes of all alpha hold oils that there are. Barus' law has the bend 0.

zeta is counted from the bottom of the damping valley, so that what happens there stands at the same place for all oils:

    zeta = ln(M/M_valley(L)) - shift,    shift = 0.17 ln(1 + (L/40)^2) + (0.62 q + 0.18 B + 0.115 B^2)/(1 + (9.2/L)^2),

with the bend B and q = (1 - z)/(alpha p_0). The shift is a fit: with it films between the nodes are read best, L = 7 to
52, alpha = 5 to 60 /GPa. It is a coordinate, never a result. The isoviscous part, whose valley is wide, goes without.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.physics.moes import valley_load_number
from ehdmaps.physics.solution import ContactSolver
from ehdmaps.physics.viscosity import ROELANDS_PRESSURE

ALPHA = 17e-9
"""alpha at which the bend is 1 - z [1/Pa]."""

HARDENING_L, BENDING_L = 40.0, 9.2
"""L at which the valley begins to move with L, and with the curvature of ln eta."""

LEAST_ALPHA = 1e-18
"""alpha that stands for none at all [1/Pa]."""


def bend_of(alpha: FloatArray, exponent: FloatArray) -> FloatArray:
    """Bend of an oil.

    Parameters
    ----------
    alpha : ndarray
        Pressure-viscosity coefficient [1/Pa], > 0.
    exponent : ndarray
        z of Roelands' law.
    """
    return np.asarray((1.0 - exponent) * np.sqrt(ALPHA / alpha))


def valley_shift(oil_number: FloatArray, alpha: FloatArray, exponent: FloatArray) -> FloatArray:
    """Height of the valley above its formula, in ln M.

    Parameters
    ----------
    oil_number : ndarray
        L, > 0.
    alpha : ndarray
        Pressure-viscosity coefficient [1/Pa], > 0.
    exponent : ndarray
        z of Roelands' law.
    """
    bend, curvature = bend_of(alpha, exponent), (1.0 - exponent) / (alpha * ROELANDS_PRESSURE)
    squared = np.square(oil_number)
    moved = 0.62 * curvature + 0.18 * bend + 0.115 * np.square(bend)
    return np.asarray(0.17 * np.log1p(squared / HARDENING_L**2) + moved * squared / (squared + BENDING_L**2))


def zeta_of(load_number: FloatArray, oil_number: FloatArray, shift: FloatArray | float = 0.0) -> FloatArray:
    """Coordinate zeta.

    Parameters
    ----------
    load_number, oil_number : ndarray
        Moes' M > 0, and L.
    shift : ndarray or float
        That of `valley_shift`; zero in the isoviscous part.
    """
    return np.asarray(np.log(load_number / valley_load_number(oil_number)) - shift)


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
    """Reason why films of a solver are not those of the table; empty where they are.

    Roughness, layers and starvation come on top of these films: what adds them asks for smooth, flooded films first.

    Parameters
    ----------
    solver : ContactSolver
        The solver, with its settings.
    """
    if solver.name != TABLE_OF:
        return f"film table: holds films of the solver {TABLE_OF}, not of {solver.name}; solve them"
    settings = solver.settings()
    unknown = [f"{meaning} ({key} = {settings[key]})" for key, meaning in _MEANING.items() if key in settings]
    if unknown:
        return f"film table: knows nothing of {', '.join(unknown)}; solve these films"
    return ""
