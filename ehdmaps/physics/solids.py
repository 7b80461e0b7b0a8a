"""Solids of the contact: elastic constants and the reduced modulus, density and what heat needs."""

from __future__ import annotations

import math
from dataclasses import dataclass
from types import MappingProxyType

from ehdmaps.errors import Problems


@dataclass(frozen=True)
class Material:
    """Isotropic linear elastic solid.

    Attributes
    ----------
    youngs_modulus : float
        E [Pa], > 0.
    poisson_ratio : float
        nu, -1 < nu < 0.5.
    density : float
        [kg/m3], > 0. It gives rollers their mass; a contact uses it for heat only.
    conductivity : float
        Thermal conductivity [W/(m K)], > 0; bearing steel has 30 to 50. Isothermal films do not use it.
    heat_capacity : float
        [J/(kg K)], > 0. Isothermal films do not use it.

    Raises
    ------
    InputError
        With every value that is not finite or out of these limits.
    """

    youngs_modulus: float
    poisson_ratio: float
    density: float = 7850.0
    conductivity: float = 46.0
    heat_capacity: float = 460.0

    def __post_init__(self) -> None:
        problems = Problems()
        if not (math.isfinite(self.youngs_modulus) and self.youngs_modulus > 0):
            problems.append(
                f"youngs_modulus: got {self.youngs_modulus!r} Pa; allowed: finite and > 0; steel has 210e9 Pa"
            )
        if not -1.0 < self.poisson_ratio < 0.5:
            problems.append(f"poisson_ratio: got {self.poisson_ratio!r}; allowed: -1 < nu < 0.5; steel has 0.3")
        if not (math.isfinite(self.density) and self.density > 0):
            problems.append(f"density: got {self.density!r} kg/m3; allowed: finite and > 0; steel has 7850 kg/m3")
        if not (math.isfinite(self.conductivity) and self.conductivity > 0):
            problems.append(
                f"conductivity: got {self.conductivity!r} W/(m K); allowed: finite and > 0; steel has 46 W/(m K)"
            )
        if not (math.isfinite(self.heat_capacity) and self.heat_capacity > 0):
            problems.append(
                f"heat_capacity: got {self.heat_capacity!r} J/(kg K); allowed: finite and > 0; steel has 460 J/(kg K)"
            )
        problems.check()


STEEL = Material(youngs_modulus=210e9, poisson_ratio=0.3, density=7850.0)


SILICON_NITRIDE = Material(310e9, 0.26, 3200.0, conductivity=30.0, heat_capacity=800.0)
"""Silicon nitride of balls: usual values."""


MATERIALS = MappingProxyType(
    {
        "steel": STEEL,
        "cast iron": Material(110e9, 0.25, 7200.0),
        "ductile iron": Material(170e9, 0.275, 7100.0),
        "aluminium": Material(70e9, 0.33, 2700.0),
        "magnesium": Material(45e9, 0.35, 1800.0),
        "titanium": Material(114e9, 0.34, 4430.0),
        "copper": Material(120e9, 0.34, 8930.0),
    }
)
"""Materials of machines by name, with usual values."""


def reduced_modulus(first: Material, second: Material) -> float:
    """Reduced modulus of a pair, E' = 2 / ((1 - nu1^2)/E1 + (1 - nu2^2)/E2) [Pa].

    Not the E* of contact mechanics, which is E'/2.

    References
    ----------
    D. Dowson, G. R. Higginson, Elasto-Hydrodynamic Lubrication, Pergamon, 1966.

    Examples
    --------
    >>> round(reduced_modulus(STEEL, STEEL) / 1e9, 3)
    230.769
    """
    compliance = (1.0 - first.poisson_ratio**2) / first.youngs_modulus
    compliance += (1.0 - second.poisson_ratio**2) / second.youngs_modulus
    return 2.0 / compliance
