"""A point contact in groups: what is asked of the solver, and how far films of points have been studied.

Hertz-dimensionless: lengths in a, the semi-axis of the dry contact in the direction of rolling (x), P in p_H, H in
a^2/Rx, time in a/u. With kappa = b/a, D = Rx/Ry, g and K of `ehdmaps.physics.point.ellipse` and q = 3 M/(pi kappa g),

    H = H0 + X^2/2 + D Y^2/2 + (g/pi) Int P/r dX dY,      Int P dX dY = 2 pi kappa/3,
    div(rho H^3/(lambda eta) grad P) = d(rho H)/dX + d(rho H)/dT,      lambda = 12/g q^(-4/3).

M = F/(E' Rx^2) U^(-3/4) and L = alpha E' U^(1/4) with U = eta0 2u/(E' Rx) are Moes' groups of points; films in
units of Rx U^(1/2) are H q^(2/3). The approach is -H0: in three dimensions the deflection decays, there is no datum to
choose.
"""

from __future__ import annotations

import math
from functools import lru_cache
from typing import NamedTuple, Protocol

from ehdmaps.physics.isotherm import Isotherm
from ehdmaps.physics.point.ellipse import EllipticNumbers, elliptic_numbers

_numbers = lru_cache(maxsize=64)(elliptic_numbers)


class FilmProblem(Protocol):
    """Groups that Newton's method asks of a contact."""

    @property
    def isotherm(self) -> Isotherm:
        """Viscosity and density over P: pressures in p_H."""
        ...

    @property
    def load(self) -> float:
        """Integral of P."""
        ...

    @property
    def wedge(self) -> float:
        """Wedge number lambda."""
        ...


class PointProblem(NamedTuple):
    """Dimensionless groups of one point contact.

    Attributes
    ----------
    ellipticity : float
        kappa = b/a, below 1 where the ellipse is longer in the direction of rolling.
    load_number, oil_number : float
        Moes' M and L.
    isotherm : Isotherm
        Viscosity and density over P: pressures in p_H.
    """

    ellipticity: float
    load_number: float
    oil_number: float
    isotherm: Isotherm

    @property
    def numbers(self) -> EllipticNumbers:
        """Elliptic numbers of the dry contact."""
        return _numbers(self.ellipticity)

    @property
    def load_scale(self) -> float:
        """q = 3 M/(pi kappa g): (a/Rx)^3 = q U^(3/4)."""
        return 3.0 * self.load_number / (math.pi * self.ellipticity * float(self.numbers.pressure_factor))

    @property
    def wedge(self) -> float:
        """lambda = 12/g q^(-4/3)."""
        return float(12.0 / self.numbers.pressure_factor * self.load_scale ** (-4.0 / 3.0))

    @property
    def moes(self) -> float:
        """Films in units of Rx U^(1/2) over films in a^2/Rx."""
        return float(self.load_scale ** (2.0 / 3.0))

    @property
    def load(self) -> float:
        """Integral of P, 2 pi kappa/3."""
        return 2.0 * math.pi * self.ellipticity / 3.0

    @property
    def dry_approach(self) -> float:
        """Approach of the dry contact, g K [a^2/Rx]."""
        return float(self.numbers.pressure_factor) * float(self.numbers.integral)

    @property
    def dry_compliance(self) -> float:
        """Derivative of the dry approach by the integral of P, g K/(pi kappa): approach goes with the load's 2/3."""
        return self.dry_approach / (math.pi * self.ellipticity)

    def at_load(self, factor: float) -> PointProblem:
        """The same contact, oil and speed under a load that is `factor` times as large."""
        return self._replace(
            load_number=self.load_number * factor, isotherm=self.isotherm.scaled(factor ** (1.0 / 3.0))
        )


def start_film(problem: PointProblem) -> float:
    """Film from which a solution is sought [a^2/Rx]: the largest of the minimum films of four regimes.

    Its only use is a start; how far off it is changes the number of steps.

    References
    ----------
    B. J. Hamrock, D. Dowson, Minimum film thickness in elliptical contacts for different regimes of fluid-film
    lubrication, Proc. 5th Leeds-Lyon Symposium on Tribology, 1979, 22-27.
    """
    kappa, M, D = problem.ellipticity, problem.load_number, float(problem.numbers.curvature_ratio)
    viscous, elastic = 4.0 * problem.oil_number * M**3, 4.0 * M ** (8.0 / 3.0)
    side = 1.0 - math.exp(-0.68 * kappa)
    leak = 1.0 / (1.0 + 2.0 * D / 3.0)
    films = (
        128.0 / D * (leak * (0.131 * math.atan(0.5 / D) + 1.683)) ** 2,
        1.66 * viscous ** (2.0 / 3.0) * side,
        8.70 * elastic**0.67 * (1.0 - 0.85 * math.exp(-0.31 * kappa)),
        3.42 * viscous**0.49 * elastic**0.17 * side,
    )
    return float(max(films)) / (4.0 * M * M * problem.moes)
