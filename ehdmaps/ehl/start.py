"""Start that the Reynolds solution of a point gives to another solver: a pressure, and a place for its grid."""

from __future__ import annotations

from dataclasses import dataclass

from ehdmaps.arrays import FloatArray
from ehdmaps.ehl.limits import Resolution
from ehdmaps.ehl.line import solve_groups
from ehdmaps.ehl.newton import CONVERGED
from ehdmaps.ehl.solver import NEWTONIAN_LAW, _beyond_reach, line_problem
from ehdmaps.physics.contact import LineContact
from ehdmaps.physics.hertz import half_width, max_pressure
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.rheology import ShearLaw


@dataclass(frozen=True)
class ReynoldsStart:
    """A start from a solution of the Reynolds equation.

    Attributes
    ----------
    x : ndarray, shape (n,)
        Positions from the contact centre, increasing; the last one is the exit of the film [m].
    pressure : ndarray, shape (n,)
        [Pa].
    central_film : float
        [m].
    expected_film : float
        Film H about which the grid is laid [b^2/R].
    spike_position, spike_width : float
        Place of the pressure spike from the contact centre, and width of the finest cells around it [b]; a width of
        zero says that there is no spike.
    """

    x: FloatArray
    pressure: FloatArray
    central_film: float
    expected_film: float
    spike_position: float
    spike_width: float


_RESOLUTION = Resolution(inlet_length=300.0)
"""Grid of the start. Cells of the other solver are laid by it, so that it does not follow a default of this one."""


def reynolds_start(
    contact: LineContact,
    lubricant: Lubricant,
    load: float,
    entrainment_speed: float,
    temperature: float,
    shear: ShearLaw = NEWTONIAN_LAW,
    slide_to_roll: float = 0.0,
) -> ReynoldsStart | None:
    """Solve a point for the start of another solver.

    Where the film has no solution with a law of shear, the start is that of a Newtonian oil.

    Parameters
    ----------
    contact, lubricant
        What is solved.
    load : float
        [N/m].
    entrainment_speed : float
        > 0 [m/s].
    temperature : float
        [K].
    shear : ShearLaw
        Law of shear in SI.
    slide_to_roll : float
        (u_upper - u_lower)/u.

    Returns
    -------
    ReynoldsStart or None
        None where the Reynolds equation has no converged solution.
    """
    peak = float(max_pressure(load, contact.radius, contact.reduced_modulus))
    profile = None
    for law in dict.fromkeys((shear, NEWTONIAN_LAW)):
        problem, M, L = line_problem(contact, lubricant.at(temperature), load, entrainment_speed, law, slide_to_roll)
        if _beyond_reach(peak, M, L):
            return None
        solution = solve_groups(problem, M, L, _RESOLUTION)
        if solution.outcome == CONVERGED and solution.profile is not None:
            profile = solution.profile
            break
    if profile is None:
        return None
    half = float(half_width(load, contact.radius, contact.reduced_modulus))
    spike = profile.spike
    exit_at = float(profile.position[-1])
    return ReynoldsStart(
        x=profile.position * half,
        pressure=profile.pressure * peak,
        central_film=profile.measures.central * half * half / contact.radius,
        expected_film=profile.layout.film,
        spike_position=0.0 if spike is None else exit_at + spike.position,
        spike_width=0.0 if spike is None else spike.width,
    )
