"""Viscosity at ambient pressure over temperature: constant, ASTM D341, Vogel."""

from __future__ import annotations

import math
from dataclasses import dataclass

from ehdmaps.errors import InputError
from ehdmaps.physics.pressure_viscosity import ZERO_CELSIUS

_COLD, _HOT = ZERO_CELSIUS + 40.0, ZERO_CELSIUS + 100.0
_MM2 = 1e-6


@dataclass(frozen=True)
class ConstantViscosity:
    """A viscosity that does not change with temperature.

    Attributes
    ----------
    viscosity : float
        eta0 [Pa s], > 0.
    """

    viscosity: float

    def __post_init__(self) -> None:
        if not (math.isfinite(self.viscosity) and self.viscosity > 0):
            raise InputError(f"viscosity: got {self.viscosity!r} Pa s; allowed: finite and > 0")

    def at(self, temperature: float, density: float) -> float:
        """eta0 [Pa s]."""
        return self.viscosity


@dataclass(frozen=True)
class AstmViscosity:
    """Viscosity between 40 and 100 degC: log10 log10(nu + 0.7) linear in log10 T, nu in mm2/s, T in K.

    Attributes
    ----------
    viscosity_40, viscosity_100 : float
        Kinematic viscosities [m2/s]; above 0.3 mm2/s, where the double logarithm is defined.

    Notes
    -----
    The law is meant for 2 mm2/s and more; thinner oils need the further terms of the standard, which are
    left out.

    References
    ----------
    ASTM D341, Standard practice for viscosity-temperature charts for liquid petroleum products; the same
    law is in ISO 3448.

    Examples
    --------
    ISO VG 100 with a viscosity index near 95:

    >>> oil = AstmViscosity(100e-6, 11e-6)
    >>> round(oil.at(273.15 + 40, density=1.0) * 1e6, 3), round(oil.at(273.15 + 70, density=1.0) * 1e6, 2)
    (100.0, 27.02)
    """

    viscosity_40: float
    viscosity_100: float

    def __post_init__(self) -> None:
        problems = [
            f"{key}: got {value!r} m2/s = {value / _MM2:.6g} mm2/s; allowed: finite and > 0.3 mm2/s; check its unit"
            for key, value in (("viscosity_40", self.viscosity_40), ("viscosity_100", self.viscosity_100))
            if not (math.isfinite(value) and value > 0.3 * _MM2)
        ]
        if not problems and self.viscosity_100 >= self.viscosity_40:
            problems.append(
                f"viscosity_100: got {self.viscosity_100 / _MM2:.6g} mm2/s; allowed: below viscosity_40 = "
                f"{self.viscosity_40 / _MM2:.6g} mm2/s; exchange them?"
            )
        if problems:
            raise InputError(problems)

    @property
    def slope(self) -> float:
        """m = -d log10 log10(nu + 0.7)/d log10 T."""
        span = math.log10(_HOT / _COLD)
        return (_double_log(self.viscosity_40 / _MM2) - _double_log(self.viscosity_100 / _MM2)) / span

    def at(self, temperature: float, density: float) -> float:
        """eta0 [Pa s] at a temperature [K], at which the oil has the density [kg/m3]."""
        cold = _double_log(self.viscosity_40 / _MM2)
        hot = _double_log(self.viscosity_100 / _MM2)
        part = math.log(temperature / _COLD) / math.log(_HOT / _COLD)
        try:
            kinematic: float = 10.0**10.0 ** (cold + (hot - cold) * part) - 0.7
        except OverflowError:
            kinematic = math.inf
        if not math.isfinite(kinematic):
            raise InputError(
                f"temperature: got {temperature - ZERO_CELSIUS:.6g} degC, where the viscosity of ASTM D341 "
                "overflows; "
                "allowed: temperatures at which the oil flows; raise it"
            )
        return kinematic * _MM2 * density


@dataclass(frozen=True)
class VogelViscosity:
    """Vogel's law, eta0 = K exp(B/(C + theta)), theta in degC.

    Attributes
    ----------
    factor : float
        K [Pa s].
    slope : float
        B [K].
    offset : float
        C [degC].

    References
    ----------
    H. Vogel, Das Temperaturabhaengigkeitsgesetz der Viskositaet von Fluessigkeiten, Phys. Z. 22, 1921,
    645-646.
    """

    factor: float
    slope: float
    offset: float

    def at(self, temperature: float, density: float) -> float:
        """eta0 [Pa s] at a temperature [K]."""
        celsius = temperature - ZERO_CELSIUS
        distance = self.offset + celsius
        exponent = self.slope / distance if distance > 0 else math.inf
        if exponent > 100.0:
            raise InputError(
                f"temperature: got {celsius:.6g} degC; Vogel's law breaks down at {-self.offset:.6g} degC; "
                f"allowed: > {self.slope / 100.0 - self.offset:.6g} degC; raise it"
            )
        return self.factor * math.exp(exponent)


ViscosityLaw = ConstantViscosity | AstmViscosity | VogelViscosity


def _double_log(kinematic_mm2: float) -> float:
    """log10 log10(nu + 0.7) of a kinematic viscosity in mm2/s."""
    return math.log10(math.log10(kinematic_mm2 + 0.7))
