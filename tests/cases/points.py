"""Point contacts that several verification tests share, in the groups of the problem."""

from __future__ import annotations

import math

from ehdmaps.physics.isotherm import PressureViscosity
from ehdmaps.physics.point.ellipse import elliptic_numbers
from ehdmaps.point.problem import PointProblem


def point_problem(M: float, L: float, kappa: float, alpha: float = 1.7e-8) -> PointProblem:
    """The oil of the reference points of lines: Roelands z = 0.67, p0 = 1.96e8 Pa, compressible; L = 0 isoviscous."""
    if L == 0.0:
        return PointProblem(kappa, M, 0.0, PressureViscosity(0.0, 1.0, math.inf).isotherm())
    factor = float(elliptic_numbers(kappa).pressure_factor)
    piezoviscosity = 0.5 * factor * L * (3.0 * M / (math.pi * kappa * factor)) ** (1.0 / 3.0)  # alpha p_H
    isotherm = PressureViscosity(alpha, 0.67, 1.96e8).isotherm(piezoviscosity / alpha, compressible=True)
    return PointProblem(kappa, M, L, isotherm)
