"""Points and solves that several verification tests share, in the groups of the problem."""

from __future__ import annotations

import math
from functools import cache

from ehdmaps.ehl.group_solution import GroupSolution
from ehdmaps.ehl.limits import Resolution
from ehdmaps.ehl.line import solve_groups
from ehdmaps.ehl.reynolds import LineProblem
from ehdmaps.physics.isotherm import PressureViscosity


def roelands_problem(M: float, L: float) -> LineProblem:
    """The oil of the reference points: Roelands z = 0.67, p0 = 1.96e8 Pa, alpha = 1.7e-8 1/Pa, compressible."""
    alpha = L * math.sqrt(M / (2.0 * math.pi))
    peak = alpha / 1.7e-8
    isotherm = PressureViscosity(1.7e-8, 0.67, 1.96e8).isotherm(peak, compressible=True)._replace(alpha=alpha)
    return LineProblem(3.0 * math.pi**2 / (8.0 * M * M), isotherm)


def isoviscous_problem(M: float) -> LineProblem:
    """Constant viscosity and density."""
    return LineProblem(3.0 * math.pi**2 / (8.0 * M * M), PressureViscosity(0.0, 1.0, math.inf).isotherm())


def incompressible_problem(M: float, L: float) -> LineProblem:
    """The same viscosity law, incompressible: the fluid for which the bands of the film formulas are stated."""
    problem = roelands_problem(M, L)
    return problem._replace(isotherm=problem.isotherm._replace(density_curvature=0.0))


def moes_film(film: float, M: float) -> float:
    """Moes' film number of a film in b^2/R."""
    return film * 8.0 * M / math.pi


@cache
def solved(M: float, L: float, law: str = "roelands", **settings: float) -> GroupSolution:
    """Solve one point at one resolution."""
    problem = (
        {"roelands": roelands_problem, "incompressible": incompressible_problem}[law](M, L)
        if L > 0
        else isoviscous_problem(M)
    )
    return solve_groups(problem, M, L, Resolution(**settings))
