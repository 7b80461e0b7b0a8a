"""An oil as a dielectric: permittivity over temperature and pressure, conductivity, field of breakdown.

Permittivity follows the density as Clausius and Mossotti have it, (eps - 1)/(eps + 2) ~ rho, over temperature and
pressure alike. It holds for mineral oils, polyalphaolefins and esters, whose molecules are not or hardly polar. From
39 to 52 degC it takes FVA 3 from 2.07 to 2.057; 2.056 were measured (`docs/electrics.md`).

Breakdown of a film is a band of fields, never a number: asperities and dirt decide. 15 V/um is what work on bearing
currents takes most; 5 to 30 V/um hold what is reported.

References
----------
D. Busse, J. Erdman, R. J. Kerkman, D. Schlegel, G. Skibinski, System electrical parameters and their effects on bearing
currents, IEEE Transactions on Industry Applications 33 (1997) 577: threshold voltage, bearing voltage ratio. Values of
the field: usual ones of that literature, from memory.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal, get_args

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import Problems
from ehdmaps.physics.lubricant import Lubricant

VACUUM = 8.8541878128e-12
"""Permittivity of vacuum [F/m]."""

Outlet = Literal["parallel", "series", "gas", "oil"]
"""What is behind the contact: streamers of oil beside gas, layers of oil under gas, gas alone, or oil everywhere."""

OUTLETS: tuple[Outlet, ...] = get_args(Outlet)

LARGEST = 6.0
"""Largest permittivity that is taken for that of an oil: Clausius and Mossotti do not hold for polar liquids."""

FIELDS = (5e6, 30e6)
"""Ends of the band of fields at which films break down [V/m]."""

USUAL_FIELD = 15e6
"""Field that is taken most [V/m]."""

CONDUCTIVITIES = (1e-15, 1e-3)
"""Limits of conductivities [S/m]."""

_PLACES = 8


@dataclass(frozen=True)
class Dielectric:
    """Electric properties of an oil.

    Attributes
    ----------
    permittivity : float
        Relative permittivity, above 1 and at most `LARGEST`.
    temperature : float or None
        Temperature at which that is known [K]; None where it is that of the contact.
    conductivity : float or None
        [S/m] at the temperature of the contact; None where it is not known.
    outlet : {"parallel", "series", "gas", "oil"}
        What is behind the contact.
    outer_gap : float or None
        Gap at which the oil ends around a point contact [m]; None: as wide as the groove is. Not of lines.

    Raises
    ------
    InputError
        With every problem.

    Examples
    --------
    >>> oil = Lubricant.named("FVA3")
    >>> round(Dielectric(2.07, 312.15).at(oil, 325.15), 3)
    2.057
    """

    permittivity: float
    temperature: float | None = None
    conductivity: float | None = None
    outlet: Outlet = "parallel"
    outer_gap: float | None = None

    def __post_init__(self) -> None:
        problems = Problems()
        if not 1.0 < self.permittivity <= LARGEST:
            problems.append(
                f"permittivity: got {self.permittivity!r}; allowed: above 1, at most {LARGEST:g}, of an oil"
            )
        low, high = CONDUCTIVITIES
        if self.conductivity is not None and not low <= self.conductivity <= high:
            problems.append(f"conductivity: got {self.conductivity!r} S/m; allowed: {low:g} to {high:g} S/m")
        if self.outlet not in OUTLETS:
            problems.append(f"outlet: got {self.outlet!r:.40}; allowed: {', '.join(OUTLETS)}")
        if self.outer_gap is not None and not 0.0 < self.outer_gap <= 1.0:
            problems.append(f"outer gap: got {self.outer_gap!r} m; allowed: above 0, at most 1 m")
        problems.check()

    def at(self, lubricant: Lubricant, temperature: float) -> float:
        """Permittivity at a temperature [K], without pressure.

        Parameters
        ----------
        lubricant : Lubricant
            The oil, whose density it follows.
        temperature : float
            T [K].
        """
        if self.temperature is None:
            return self.permittivity
        return float(
            _denser(self.permittivity, lubricant.at(temperature).density / lubricant.at(self.temperature).density)
        )

    @property
    def time_constant(self) -> float:
        """Time R C of every contact, eps0 eps/sigma [s]; NaN where the conductivity is not known."""
        return math.nan if self.conductivity is None else VACUUM * self.permittivity / self.conductivity


def under_pressure(
    permittivity: float, lubricant: Lubricant, temperature: float, pressure: FloatArray, kind: Literal["point", "line"]
) -> FloatArray:
    """Mean permittivity over the Hertz zones of contacts, (n,).

    Parameters
    ----------
    permittivity : float
        That without pressure.
    lubricant : Lubricant
        The oil.
    temperature : float
        T [K].
    pressure : array (n,)
        Largest Hertz pressures [Pa].
    kind : {"point", "line"}
        Kind of the contacts.
    """
    places, weights = np.polynomial.legendre.leggauss(_PLACES)
    place, weight = 0.5 * (places + 1.0), 0.5 * weights
    # ellipse: equal areas lie evenly over (p/p0)^2; line: p/p0 = sqrt(1 - x^2)
    share, weight = (place, 2.0 * place * weight) if kind == "point" else (np.sqrt(1.0 - place**2), weight)
    ratio = np.asarray(lubricant.at(temperature).density_ratio(np.asarray(pressure)[..., None] * share))
    return np.asarray(_denser(permittivity, ratio) @ weight)


def _denser(permittivity: float, ratio: float | FloatArray) -> FloatArray:
    """Permittivity of the oil at a multiple of its density."""
    part = (permittivity - 1.0) / (permittivity + 2.0) * np.asarray(ratio)
    return np.asarray((1.0 + 2.0 * part) / (1.0 - part))
