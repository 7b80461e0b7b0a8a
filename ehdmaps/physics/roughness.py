"""Rough surfaces: the roughness of both surfaces together, and what their asperities are like.

What asperities carry is in `ehdmaps.maps.asperities`.

References
----------
J. A. Greenwood, J. H. Tripp, "The contact of two nominally flat rough surfaces", Proc. IMechE 185, 1970, 625: the
statistics of asperities. Usual values of eta sigma beta (0.03 to 0.05) and sigma/beta (0.0001 to 0.01) of steel: M.
Teodorescu, S. Balakrishnan, H. Rahnejat, "Integrated tribological analysis within a multi-physics approach to system
dynamics", Tribology and Interface Engineering Series 48, 2005, 725.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

from ehdmaps.errors import InputError

FINEST, ROUGHEST = 1e-9, 1e-5
"""Roughness that is taken [m]: below a nanometre there is no continuum, above ten micrometres no rolling surface."""

HARDNESS = 7e9
"""Hardness of through-hardened bearing steel of 60 HRC [Pa], some 700 HV."""

LIMITS: Mapping[str, tuple[float, float]] = MappingProxyType(
    {"asperity_product": (0.02, 0.5), "asperity_slope": (1e-4, 0.1), "hardness": (1e9, 1e11)}
)
"""Smallest and largest value of each property of asperities that is taken; hardness in Pa."""

_UNITS = {"hardness": " Pa"}


@dataclass(frozen=True)
class Surface:
    """Roughness of the two surfaces of a contact together.

    Attributes
    ----------
    roughness : float
        Combined root mean square roughness sigma = sqrt(sigma_1^2 + sigma_2^2) [m]; 0 where the surfaces are smooth.
    asperity_product : float
        eta sigma beta of density eta [1/m2] and radius beta [m] of the asperities; usually 0.03 to 0.05.
    asperity_slope : float
        sigma/beta; usually 0.0001 to 0.01.
    hardness : float
        Most pressure within the spots where asperities touch [Pa].

    Raises
    ------
    InputError
        With every value that is out of its limits.
    """

    roughness: float
    asperity_product: float = 0.05
    asperity_slope: float = 0.01
    hardness: float = HARDNESS

    def __post_init__(self) -> None:
        problems = []
        if not (self.roughness == 0.0 or FINEST <= self.roughness <= ROUGHEST):
            problems.append(
                f"surface, roughness: got {self.roughness!r} m; allowed: {FINEST:g} to {ROUGHEST:g} m, or 0 (smooth)"
            )
        for name, (least, most) in LIMITS.items():
            value, unit = getattr(self, name), _UNITS.get(name, "")
            if not least <= value <= most:
                problems.append(f"surface, {name}: got {value!r}{unit}; allowed: {least:g} to {most:g}{unit}")
        if problems:
            raise InputError(problems)

    @property
    def smooth(self) -> bool:
        """Whether there are no asperities."""
        return self.roughness == 0.0

    @property
    def label(self) -> str:
        """Name for tables, legends and messages."""
        return "smooth" if self.smooth else f"roughness {1e6 * self.roughness:.3g} um"


SMOOTH = Surface(0.0)
"""Surfaces without asperities."""
