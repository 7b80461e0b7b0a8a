"""Traction of the contacts of a job over the slide-to-roll ratio: solved, as a table, and as plain values for JSON."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.ehl.solver import ReynoldsSolver
from ehdmaps.physics.contact import LineContact, OperatingPoint
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.rheology import (
    LIMITING_STRESS_AT_REST,
    eyring_stress,
    limiting_stress,
    newtonian_stress,
    traction_coefficients,
)
from ehdmaps.physics.solution import FilmSolution
from ehdmaps.units import Display

LAWS = ("newtonian", "eyring", "limiting")
"""Laws of shear stress, in the order of the columns."""

LEAST_SLIP, MOST_SLIP, MOST_SLIPS = 1e-6, 2.0, 1000
"""Slide-to-roll ratios that may be asked for: beyond 2 one surface runs backwards."""

STRESS = Display("MPa", 1e-6)


@dataclass(frozen=True)
class TractionRequest:
    """Traction that is asked for.

    Attributes
    ----------
    slide_to_roll : ndarray, shape (k,)
        Ratios S = (u2 - u1)/u.
    eyring : float
        Eyring stress [Pa].
    limiting : float
        Rise of the limiting stress with pressure.
    """

    slide_to_roll: FloatArray
    eyring: float
    limiting: float


def solve_traction(
    solver: ReynoldsSolver, contact: LineContact, oil: Lubricant, point: OperatingPoint, request: TractionRequest
) -> tuple[FilmSolution, dict[str, FloatArray]]:
    """Solve one contact: its film, and its traction coefficients by law, each of shape (k,); NaN without a film.

    Parameters
    ----------
    solver : ReynoldsSolver
        The solver.
    contact : LineContact
        The contact.
    oil : Lubricant
        The oil.
    point : OperatingPoint
        Load, speed and temperature.
    request : TractionRequest
        Ratios and stresses.
    """
    film, profile = solver.film_profile(contact, oil, point)
    if profile is None:
        return film, {law: np.full(request.slide_to_roll.shape, np.nan) for law in LAWS}
    laws = (newtonian_stress, eyring_stress(request.eyring), limiting_stress(profile.pressure, request.limiting))
    at = oil.at(point.temperature), point.load, point.entrainment_speed
    coefficients = (traction_coefficients(profile, *at, request.slide_to_roll, law) for law in laws)
    return film, dict(zip(LAWS, coefficients, strict=True))


def traction_record(request: TractionRequest, coefficients: dict[str, FloatArray]) -> dict[str, Any]:
    """Return the traction of one contact as plain values; None where there is no film.

    Parameters
    ----------
    request : TractionRequest
        Ratios and stresses.
    coefficients : dict of str to ndarray
        Traction coefficients by law.
    """
    plain = {law: [float(mu) if np.isfinite(mu) else None for mu in values] for law, values in coefficients.items()}
    return {
        "slide_to_roll": request.slide_to_roll.tolist(),
        "eyring_stress": request.eyring,
        "limiting_ratio": request.limiting,
        **{f"traction_{law}": values for law, values in plain.items()},
    }


def traction_table(request: TractionRequest, coefficients: dict[str, dict[str, FloatArray]]) -> str:
    """Return the printed table: a column a contact and law, a line a ratio.

    Parameters
    ----------
    request : TractionRequest
        Ratios and stresses.
    coefficients : dict
        Traction coefficients by law, by the name of the contact.
    """
    lines = [
        "traction coefficient on the film of pure rolling, isothermal: too high where slip heats it, above 0.1 or so",
        f"  eyring: {STRESS.text(request.eyring)}; limiting: {STRESS.text(LIMITING_STRESS_AT_REST)} + "
        f"{request.limiting:g} p; newtonian oil has no bound: of no use above 0.6 GPa",
        f"  {'slide to roll':>13s}" + "".join(f"{contact:>12s}{'':24s}" for contact in coefficients),
        f"  {'':13s}" + "".join(f"{law:>12s}" for law in LAWS) * len(coefficients),
    ]
    for index, slip in enumerate(request.slide_to_roll):
        values = [mu[index] for laws in coefficients.values() for mu in laws.values()]
        lines.append(
            f"  {slip:13.4g}" + "".join(f"{'-' if np.isnan(value) else f'{value:.4g}':>12s}" for value in values)
        )
    return "\n".join(line.rstrip() for line in lines)
