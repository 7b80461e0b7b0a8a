"""Pressure-viscosity coefficients estimated from the viscosity at ambient pressure, for oils that nobody measured.

An estimate holds at each temperature: it follows viscosity and density there. Its error is not small; see
`Correlation.error`.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass

from ehdmaps.errors import InputError

_MM2 = 1e-6
_GRAM_PER_CM3 = 1e3
_UNIT = 1e-8  # 1/Pa, in which both formulas are printed
_STEP = 1e-4


@dataclass(frozen=True)
class Correlation:
    """A published formula for alpha of a family of oils.

    Attributes
    ----------
    name : str
        Name in a job file.
    authors : str
        Whose it is.
    error : str
        How far it is from measured oils, and of which.
    needs_slope : bool
        Whether it needs the slope of viscosity over temperature (ASTM D341).
    formula : callable
        alpha [1e-8 1/Pa] of viscosity [mm2/s], density [g/cm3] and slope [-].
    """

    name: str
    authors: str
    error: str
    needs_slope: bool
    formula: Callable[[float, float, float], float]

    @property
    def sentence(self) -> str:
        """What a map says of it."""
        return f"pressure-viscosity estimated by {self.authors}; {self.error}"


def so_klaus(viscosity: float, density: float, slope: float) -> float:
    """Alpha [1e-8 1/Pa] of So and Klaus, for mineral and other liquid lubricants.

    1.216 + 4.143 (log nu)^3.0627 + 2.848e-4 m^5.1903 (log nu)^1.5976 - 3.999 (log nu)^3.0975 rho^0.1162

    Parameters
    ----------
    viscosity : float
        nu at ambient pressure [mm2/s], >= 1.
    density : float
        rho at ambient pressure [g/cm3].
    slope : float
        m = -d log10 log10(nu + 0.7)/d log10 T.

    References
    ----------
    B. Y. C. So, E. E. Klaus, Viscosity-pressure correlation of liquids, ASLE Trans. 23, 1980, 409-421.

    Examples
    --------
    >>> round(so_klaus(40.0, 0.86, 3.5), 3)
    2.248
    """
    log = math.log10(viscosity)
    alpha: float = 1.216 + 4.143 * log**3.0627 - 3.999 * log**3.0975 * density**0.1162
    alpha += 2.848e-4 * slope**5.1903 * log**1.5976
    return alpha


def gold_mineral(viscosity: float, density: float = 0.0, slope: float = 0.0) -> float:
    """Alpha [1e-8 1/Pa] of Gold and others for mineral oils, 0.9904 nu^0.139, nu in mm2/s.

    Parameters
    ----------
    viscosity : float
        Kinematic viscosity nu [mm2/s].
    density : float
        Not used; for a common signature with the other correlations.
    slope : float
        Not used either.

    References
    ----------
    P. W. Gold, A. Schmidt, H. Dicke, J. Loos, C. Assmann, Viscosity-pressure-temperature behaviour of mineral and
    synthetic oils, J. Synthetic Lubrication 18, 2001, 51-79.

    Examples
    --------
    >>> round(gold_mineral(100.0), 3)
    1.878
    """
    alpha: float = 0.9904 * viscosity**0.139
    return alpha


CORRELATIONS: Mapping[str, Correlation] = {
    entry.name: entry
    for entry in (
        Correlation(
            "so-klaus",
            "So and Klaus (1980)",
            "against 38 published values of mineral oils 10 % high on average, 17 % rms",
            True,
            so_klaus,
        ),
        Correlation(
            "gold-mineral",
            "Gold et al. (2001) for mineral oils",
            "against 38 published values of mineral oils 25 % low on average, 27 % rms",
            False,
            gold_mineral,
        ),
    )
}
"""By the name that a job file gives instead of a pressure-viscosity."""


def estimate(name: str, viscosity: float, density: float, slope: float) -> float:
    """Alpha [1/Pa] of an oil at one temperature.

    Parameters
    ----------
    name : str
        One of `CORRELATIONS`.
    viscosity : float
        Kinematic, at ambient pressure [m2/s].
    density : float
        [kg/m3].
    slope : float
        Slope of the viscosity-temperature line of ASTM D341, see `so_klaus`; any where the correlation does not need
        it.

    Raises
    ------
    InputError
        Below 1 mm2/s, and where the formula falls with viscosity: measured oils do not, so it is out of reach there.

    Examples
    --------
    >>> round(1e9 * estimate("so-klaus", 40e-6, 860.0, 3.5), 2)
    22.48
    """
    formula = CORRELATIONS[name].formula
    nu, rho = viscosity / _MM2, density / _GRAM_PER_CM3
    words = f"pressure_viscosity {name}: got {nu:.4g} mm2/s, density {density:.4g} kg/m3 and slope {slope:.3g}"
    if not nu >= 1.0:
        raise InputError(f"{words}; allowed: 1 mm2/s and above; give pressure_viscosity in 1/Pa")
    alpha = formula(nu, rho, slope)
    if not formula(nu * (1.0 + _STEP), rho, slope) > alpha > 0.0:
        raise InputError(
            f"{words}, where its formula falls with viscosity; allowed: thinner or lighter oils, or higher "
            "temperatures; give pressure_viscosity in 1/Pa"
        )
    return alpha * _UNIT
