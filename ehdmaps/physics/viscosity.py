"""Viscosity over temperature and pressure: constant, ASTM D341, Vogel; Barus, Roelands, FVA 3, Tait-Doolittle.

Each law gives the isotherm of a temperature by `at(temperature, viscosity)`. `PRESSURE_LAWS` is the table from which
job files and the records of maps are read. A new law is a class here with a row of that table, and where its isotherm
has a new form, that form in `isotherm`.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, fields
from typing import Any, ClassVar, Literal, NamedTuple

from ehdmaps.errors import InputError, Problems
from ehdmaps.physics.isotherm import FreeVolume, PressureViscosity

ZERO_CELSIUS = 273.15
ROELANDS_PRESSURE = 1.96e8
"""p0 of Roelands' law [Pa]."""
ROELANDS_LOG = 9.67
"""-ln of the viscosity 6.31e-5 Pa s at which Roelands' isotherms meet."""

_COLD, _HOT = 40.0, 100.0  # degC, at which a pressure-viscosity coefficient over temperature is given

Coefficient = Literal["needed", "allowed", "none"]
"""Whether a law takes a pressure-viscosity coefficient."""


class Parameter(NamedTuple):
    """A number of a law as job files and records have it.

    Attributes
    ----------
    field : str
        Attribute of the law.
    key : str
        Key in job files and records.
    low, high : float
        What a job file may state, in SI.
    unit : str
        SI unit; empty for a bare number.
    shown : tuple of str and float
        Unit of messages, and its factor.
    """

    field: str
    key: str
    low: float
    high: float
    unit: str = ""
    shown: tuple[str, float] = ("", 1.0)


@dataclass(frozen=True)
class Barus:
    """Barus' law, ln(eta/eta0) = alpha p, with ln alpha linear in temperature.

    Attributes
    ----------
    pressure_viscosity_40, pressure_viscosity_100 : float
        alpha at 40 and 100 degC [1/Pa]; alike for a constant.

    References
    ----------
    C. Barus, Isothermals, isopiestics and isometrics relative to viscosity, Am. J. Science 45, 1893, 87-96.
    """

    parameters: ClassVar[tuple[Parameter, ...]] = ()
    coefficient: ClassVar[Coefficient] = "needed"

    pressure_viscosity_40: float
    pressure_viscosity_100: float

    def __post_init__(self) -> None:
        _check_coefficients(self.pressure_viscosity_40, self.pressure_viscosity_100)

    def at(self, temperature: float, viscosity: float) -> PressureViscosity:
        """The isotherm of a temperature [K]; `viscosity` eta0 [Pa s] does not matter here."""
        alpha = _coefficient(self.pressure_viscosity_40, self.pressure_viscosity_100, temperature)
        return PressureViscosity(alpha or 0.0, exponent=1.0, pressure_scale=math.inf)


@dataclass(frozen=True)
class Roelands:
    """Roelands' law, ln(eta/eta0) = (ln eta0 + 9.67) [(1 + p/p0)^z - 1], p0 = 1.96e8 Pa.

    Given are z, or the pressure-viscosity coefficient, or both. One alone gives the other at each
    temperature by alpha = z (ln eta0 + 9.67)/p0. Both hold as stated where both are given: the factor (ln
    eta0 + 9.67) is then replaced by alpha p0/z.

    Attributes
    ----------
    exponent : float or None
        z, > 0.
    pressure_viscosity_40, pressure_viscosity_100 : float or None
        alpha at 40 and 100 degC [1/Pa], ln alpha linear in temperature; alike for a constant.
    """

    parameters: ClassVar[tuple[Parameter, ...]] = (Parameter("exponent", "roelands_z", 0.05, 2.0),)
    coefficient: ClassVar[Coefficient] = "allowed"

    exponent: float | None
    pressure_viscosity_40: float | None
    pressure_viscosity_100: float | None

    def __post_init__(self) -> None:
        if self.exponent is not None and not (math.isfinite(self.exponent) and self.exponent > 0):
            raise InputError(f"roelands_z: got {self.exponent!r}; allowed: finite and > 0; oils have 0.4 to 0.8")
        _check_coefficients(self.pressure_viscosity_40, self.pressure_viscosity_100)
        if self.exponent is None and self.pressure_viscosity_40 is None:
            raise InputError(
                "viscosity_law roelands: got neither pressure_viscosity nor roelands_z; "
                "allowed: one of them or both; "
                "give pressure_viscosity [1/Pa]"
            )

    def at(self, temperature: float, viscosity: float) -> PressureViscosity:
        """The isotherm of a temperature [K], at which the oil has the viscosity eta0 [Pa s]."""
        alpha = _coefficient(self.pressure_viscosity_40, self.pressure_viscosity_100, temperature)
        if alpha is not None and self.exponent is not None:
            return PressureViscosity(alpha, self.exponent, ROELANDS_PRESSURE)
        log_viscosity = math.log(viscosity) + ROELANDS_LOG
        if log_viscosity <= 0:
            raise InputError(
                f"viscosity: got {viscosity:.4g} Pa s at {temperature - ZERO_CELSIUS:.6g} degC; "
                "allowed: above "
                f"{math.exp(-ROELANDS_LOG):.3g} Pa s for viscosity_law roelands; "
                "use barus, or give both roelands_z "
                "and pressure_viscosity"
            )
        if self.exponent is not None:
            alpha = self.exponent * log_viscosity / ROELANDS_PRESSURE
            return PressureViscosity(alpha, self.exponent, ROELANDS_PRESSURE)
        if not alpha:  # z = 0: isoviscous, which is the same oil as Barus' with alpha = 0
            return PressureViscosity(0.0, exponent=1.0, pressure_scale=math.inf)
        return PressureViscosity(alpha, alpha * ROELANDS_PRESSURE / log_viscosity, ROELANDS_PRESSURE)


@dataclass(frozen=True)
class Fva3:
    """Law of the FVA reference oils, ln(eta/eta0) = p/(a1 + a2 theta + (b1 + b2 theta) p), theta in degC.

    Attributes
    ----------
    a1, a2 : float
        [Pa], [Pa/K].
    b1, b2 : float
        [-], [1/K].
    pressure_viscosity_40, pressure_viscosity_100 : float or None
        If given, alpha [1/Pa] at these temperatures takes the place of 1/(a1 + a2 theta).

    References
    ----------
    Lubricants 11, 2023, 369, table A1 (with p in bar there).
    """

    parameters: ClassVar[tuple[Parameter, ...]] = ()
    coefficient: ClassVar[Coefficient] = "needed"

    a1: float = 327.7918e5
    a2: float = 2.9862e5
    b1: float = 4.419e-3
    b2: float = 3.0115e-4
    pressure_viscosity_40: float | None = None
    pressure_viscosity_100: float | None = None

    def __post_init__(self) -> None:
        _check_coefficients(self.pressure_viscosity_40, self.pressure_viscosity_100)

    def at(self, temperature: float, viscosity: float) -> PressureViscosity:
        """The isotherm of a temperature [K]; `viscosity` eta0 [Pa s] does not matter here."""
        celsius = temperature - ZERO_CELSIUS
        a = self.a1 + self.a2 * celsius
        b = self.b1 + self.b2 * celsius
        if a <= 0 or b < 0:
            raise InputError(
                f"temperature: got {celsius:.6g} degC; the law of FVA 3 over pressure has a1 + a2 theta = "
                f"{a:.4g} Pa and "
                f"b1 + b2 theta = {b:.4g} there, which makes the viscosity infinite at a finite pressure; "
                "allowed: a > 0 and b >= 0, which is -14.67 degC and above for FVA 3; raise the temperature"
            )
        given = _coefficient(self.pressure_viscosity_40, self.pressure_viscosity_100, temperature)
        alpha = 1.0 / a if given is None else given
        if alpha * b == 0.0:
            return PressureViscosity(alpha, exponent=1.0, pressure_scale=math.inf)
        return PressureViscosity(alpha, exponent=-1.0, pressure_scale=1.0 / (alpha * b))


@dataclass(frozen=True)
class TaitDoolittle:
    """Doolittle's free-volume law with the volume of Tait's equation: one set of numbers over pressure and temperature.

    With V_R the volume at p = 0 and the reference temperature T_R, and T in K,

        ln eta = const + B R0 (V_occ/V_occR)/(V/V_R - R0 V_occ/V_occR),  V_occ/V_occR = 1 + epsilon (T - T_R),
        V/V0 = 1 - ln(1 + (1 + K0') p/K0)/(1 + K0'),  V0/V_R = 1 + a_V (T - T_R),  K0 = K00 exp(-beta_K T).

    It is used over pressure only; the viscosity at ambient pressure is stated for itself, as for the other laws. The
    numbers are fits to viscosities and volumes measured under pressure, and hold in that range: as a rule to 1 GPa,
    since viscosities above some 1e7 Pa s are not measured. The density of the film remains that of the `density_law`.

    Attributes
    ----------
    doolittle_slope : float
        B, 0.1 to 100.
    occupied_fraction : float
        R0, occupied part of the volume at T_R and p = 0, 0.05 to 0.99.
    occupied_expansion : float
        epsilon [1/K], within 0.01.
    volume_expansion : float
        a_V [1/K], within 0.01.
    bulk_modulus : float
        K00, bulk modulus at p = 0 extrapolated to 0 K [Pa], 0.1 GPa to 1 TPa.
    bulk_modulus_decay : float
        beta_K [1/K], 0 to 0.1.
    bulk_modulus_slope : float
        K0' = dK/dp at p = 0, 2 to 100; liquids have about 11.
    reference_temperature : float
        T_R [K], 150 to 600.

    Raises
    ------
    InputError
        With every value out of these limits.

    References
    ----------
    R. L. Cook, H. E. King, C. A. Herbst, D. R. Herschbach, Pressure and temperature dependent viscosity of two glass
    forming liquids: glycerol and dibutyl phthalate, J. Chem. Phys. 100, 1994, 5178-5189 (the form); see `FreeVolume`
    for Doolittle's and Tait's laws.

    Examples
    --------
    At T_R: alpha = B R0/((1 - R0)^2 K0), here 4.5 * 0.66/(0.34^2 * 1.2 GPa).

    >>> oil = TaitDoolittle(4.5, 0.66, 0.0, 8e-4, 1.2e9, 0.0, 11.0, 313.15)
    >>> round(1e9 * oil.at(313.15, 0.03).pressure_viscosity, 2), round(4.5 * 0.66 / (0.34**2 * 1.2), 2)
    (21.41, 21.41)
    """

    parameters: ClassVar[tuple[Parameter, ...]] = (
        Parameter("doolittle_slope", "doolittle_slope", 0.1, 100.0),
        Parameter("occupied_fraction", "occupied_fraction", 0.05, 0.99),
        Parameter("occupied_expansion", "occupied_expansion", -1e-2, 1e-2, "1/K", ("1/K", 1.0)),
        Parameter("volume_expansion", "volume_expansion", -1e-2, 1e-2, "1/K", ("1/K", 1.0)),
        Parameter("bulk_modulus", "bulk_modulus", 1e8, 1e12, "Pa", ("GPa", 1e-9)),
        Parameter("bulk_modulus_decay", "bulk_modulus_decay", 0.0, 0.1, "1/K", ("1/K", 1.0)),
        Parameter("bulk_modulus_slope", "bulk_modulus_slope", 2.0, 100.0),
        Parameter("reference_temperature", "reference_temperature", 150.0, 600.0, "K", ("K", 1.0)),
    )
    coefficient: ClassVar[Coefficient] = "none"

    doolittle_slope: float
    occupied_fraction: float
    occupied_expansion: float
    volume_expansion: float
    bulk_modulus: float
    bulk_modulus_decay: float
    bulk_modulus_slope: float
    reference_temperature: float

    def __post_init__(self) -> None:
        problems = Problems(
            f"{key}: got {getattr(self, field)!r}{' ' * bool(unit)}{unit}; allowed: {low:g} to {high:g}"
            for field, key, low, high, unit, _ in self.parameters
            if not low <= getattr(self, field) <= high
        )
        problems.check()

    def at(self, temperature: float, viscosity: float) -> FreeVolume:
        """The isotherm of a temperature [K]; `viscosity` eta0 [Pa s] does not matter here."""
        warmer = temperature - self.reference_temperature
        volume = 1.0 + self.volume_expansion * warmer
        occupied = self.occupied_fraction * (1.0 + self.occupied_expansion * warmer)
        if not 0.0 < occupied < volume:
            raise InputError(
                f"temperature: got {temperature - ZERO_CELSIUS:.6g} degC, where the law tait-doolittle has an occupied "
                f"volume of {occupied:.4g} in a volume of {volume:.4g}; allowed: above 0 and below the volume; stay "
                "near the reference_temperature"
            )
        part = occupied / volume
        free = 1.0 - part
        modulus = self.bulk_modulus * math.exp(-self.bulk_modulus_decay * temperature)
        return FreeVolume(
            self.doolittle_slope * part / (free * free * modulus),
            pressure_scale=modulus / (1.0 + self.bulk_modulus_slope),
            free_volume=(1.0 + self.bulk_modulus_slope) * free,
        )


PressureViscosityLaw = Barus | Roelands | Fva3 | TaitDoolittle

PRESSURE_LAWS: Mapping[str, type[PressureViscosityLaw]] = {
    "barus": Barus,
    "roelands": Roelands,
    "fva3": Fva3,
    "tait-doolittle": TaitDoolittle,
}
"""The laws by their word in job files and records."""


def law_record(law: PressureViscosityLaw) -> dict[str, float | str]:
    """Word and numbers of a law, for the record of an oil; values not given are left out."""
    (word,) = (word for word, kind in PRESSURE_LAWS.items() if type(law) is kind)
    keys = _keys(type(law))
    values = {key: getattr(law, field) for field, key in keys.items() if getattr(law, field) is not None}
    return {"viscosity_law": word, **values}


def law_from_record(record: Mapping[str, Any]) -> PressureViscosityLaw:
    """The law of a record made by `law_record`, other entries in it disregarded.

    Raises
    ------
    KeyError
        If its word, or one of its numbers, is missing or unknown.
    InputError
        If a number is out of its limits.

    Examples
    --------
    >>> law_from_record({"viscosity_law": "barus", "pressure_viscosity_40": 2e-8, "pressure_viscosity_100": 1e-8})
    Barus(pressure_viscosity_40=2e-08, pressure_viscosity_100=1e-08)
    """
    kind = PRESSURE_LAWS[record["viscosity_law"]]
    may_lack = {field.name for field in fields(kind) if "None" in str(field.type)}
    values: dict[str, Any] = {
        field: record.get(key) if field in may_lack else record[key] for field, key in _keys(kind).items()
    }
    return kind(**values)


def _keys(kind: type[PressureViscosityLaw]) -> dict[str, str]:
    """Key in a record by attribute: those of the job file, where it has one."""
    stated = {parameter.field: parameter.key for parameter in kind.parameters}
    return {field.name: stated.get(field.name, field.name) for field in fields(kind)}


def _check_coefficients(cold: float | None, hot: float | None) -> None:
    """Refuse coefficients between which no logarithm can be interpolated, and one without the other."""
    if cold is None and hot is None:
        return
    problems = Problems(
        f"{key}: got {value!r} 1/Pa; allowed: finite and >= 0, > 0 if it varies; mineral oils have about 2e-8 1/Pa"
        for key, value in (("pressure_viscosity_40", cold), ("pressure_viscosity_100", hot))
        if value is None or not (math.isfinite(value) and value >= 0 and (value > 0 or cold == hot))
    )
    problems.check()


def _coefficient(cold: float | None, hot: float | None, temperature: float) -> float | None:
    """Alpha with its logarithm linear in temperature; None if it is not given."""
    if cold is None or hot is None or cold == hot:
        return cold
    part = (temperature - ZERO_CELSIUS - _COLD) / (_HOT - _COLD)
    return cold * math.exp(part * math.log(hot / cold))


_COLD_KELVIN, _HOT_KELVIN = ZERO_CELSIUS + 40.0, ZERO_CELSIUS + 100.0
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
        problems = Problems(
            f"{key}: got {value!r} m2/s = {value / _MM2:.6g} mm2/s; allowed: finite and > 0.3 mm2/s; check its unit"
            for key, value in (("viscosity_40", self.viscosity_40), ("viscosity_100", self.viscosity_100))
            if not (math.isfinite(value) and value > 0.3 * _MM2)
        )
        if not problems and self.viscosity_100 >= self.viscosity_40:
            problems.append(
                f"viscosity_100: got {self.viscosity_100 / _MM2:.6g} mm2/s; allowed: below viscosity_40 = "
                f"{self.viscosity_40 / _MM2:.6g} mm2/s; exchange them?"
            )
        problems.check()

    @classmethod
    def through(cls, first: tuple[float, float], second: tuple[float, float]) -> AstmViscosity:
        """The law through two kinematic viscosities.

        Parameters
        ----------
        first, second : (float, float)
            Temperature [K] and kinematic viscosity [m2/s].

        Examples
        --------
        >>> oil = AstmViscosity(100e-6, 11e-6)
        >>> again = AstmViscosity.through((333.15, oil.at(333.15, 1.0)), (353.15, oil.at(353.15, 1.0)))
        >>> round(again.viscosity_40 * 1e6, 6), round(again.viscosity_100 * 1e6, 6)
        (100.0, 11.0)
        """
        logs = [(math.log10(temperature), _double_log(viscosity / _MM2)) for temperature, viscosity in (first, second)]
        rise = (logs[1][1] - logs[0][1]) / (logs[1][0] - logs[0][0])
        at = (logs[0][1] + rise * (math.log10(kelvin) - logs[0][0]) for kelvin in (_COLD_KELVIN, _HOT_KELVIN))
        return cls(*(_MM2 * (10.0 ** (10.0**double) - 0.7) for double in at))

    @property
    def slope(self) -> float:
        """m = -d log10 log10(nu + 0.7)/d log10 T."""
        span = math.log10(_HOT_KELVIN / _COLD_KELVIN)
        return (_double_log(self.viscosity_40 / _MM2) - _double_log(self.viscosity_100 / _MM2)) / span

    def at(self, temperature: float, density: float) -> float:
        """eta0 [Pa s] at a temperature [K], at which the oil has the density [kg/m3]."""
        cold = _double_log(self.viscosity_40 / _MM2)
        hot = _double_log(self.viscosity_100 / _MM2)
        part = math.log(temperature / _COLD_KELVIN) / math.log(_HOT_KELVIN / _COLD_KELVIN)
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
