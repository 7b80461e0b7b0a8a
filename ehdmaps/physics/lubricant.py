"""Oils: viscosity and density over pressure and temperature.

A `Lubricant` holds laws over temperature; `Lubricant.at` gives the `LubricantState` that a solver works with.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass, field, fields, replace
from typing import Any, Unpack

from ehdmaps.errors import InputError, Problems, closest, label_problem, problems_after, short
from ehdmaps.physics.designations.oil_class import CLASSES, CONDUCTIVITY, DENSITY, DENSITY_SLOPE, OilClass
from ehdmaps.physics.isotherm import FreeVolume, LubricantState, PressureViscosity
from ehdmaps.physics.own_oil import (
    CORRELATIONS,
    Anchor,
    DensityLaw,
    OilData,
    OilOverTemperature,
    Stated,
    anchored_coefficient,
    anchored_error,
    estimated_coefficient,
    own_laws,
)
from ehdmaps.physics.viscosity import (
    ROELANDS_LOG,
    ROELANDS_PRESSURE,
    ZERO_CELSIUS,
    AstmViscosity,
    ConstantViscosity,
    Fva3,
    PressureViscosityLaw,
    Roelands,
    ViscosityLaw,
    VogelViscosity,
    law_record,
)

__all__ = ["DENSITY_LAWS", "LUBRICANTS", "DensityLaw", "FreeVolume", "Lubricant", "LubricantState", "PressureViscosity"]

DENSITY_LAWS: tuple[DensityLaw, ...] = ("dowson-higginson", "incompressible")

FITTED_PRESSURE = 0.6e9
"""Pressure [Pa] above which viscosity counts as extrapolated where nobody stated a range; our assumption."""


HEAT_CAPACITY = 2000.0
"""c_p of oils where none is stated [J/(kg K)]: assumed. Mineral oils have 1700 to 2400 from 20 to 150 degC."""


@dataclass(frozen=True)
class Lubricant:
    """An oil as laws over temperature; comparable, and equal oils give equal numbers.

    Make one by `named`; or by hand with `barus`, `roelands` or `fva3` (called after their law over pressure), or with
    `own` for any law over pressure.

    Attributes
    ----------
    name : str
        Name for provenance and messages.
    verified : bool
        Whether its numbers have a stated source (`named`), or are vouched for by the user (own oils).
    viscosity : ConstantViscosity, AstmViscosity or VogelViscosity
        eta0 over temperature.
    pressure_viscosity : Barus, Roelands, Fva3 or TaitDoolittle
        Isotherms over temperature.
    density_15 : float
        rho0 at 15 degC [kg/m3].
    density_slope : float
        d rho0/dT [kg/(m3 K)].
    density_law : {"dowson-higginson", "incompressible"}
        Density over pressure.
    fitted_pressure : float
        Highest pressure [Pa] at which the viscosity law was fitted; it is extrapolated above; `FITTED_PRESSURE` unless
        stated.
    thermal_conductivity : float or None
        k_f [W/(m K)].
    heat_capacity : float
        c_p [J/(kg K)]; `HEAT_CAPACITY` unless stated.
    correlation : str or None
        One of `CORRELATIONS`, which then gives alpha at each temperature; the coefficients of `pressure_viscosity` are
        its values at 40 and 100 degC.
    stated_coefficient, stated_temperature : float or None
        An alpha [1/Pa] and its temperature [K] that somebody stated, through which the correlation goes; None for one
        that gives alpha itself.
    assumed : str
        Keys of what nobody stated of an own oil: density_slope, pressure_viscosity_temperature, or pressure_viscosity
        for its change with temperature, where no correlation knows that; no part of what makes oils equal.
    label : str or None
        Free text shown instead of the name; no part of what makes oils equal.
    fitted_pressure_stated : bool
        Whether somebody stated `fitted_pressure` where it is `FITTED_PRESSURE`; any other pressure was stated.

    Raises
    ------
    InputError
        With every value out of its limits.

    Examples
    --------
    >>> state = Lubricant.named("FVA3").at(313.15)
    >>> round(1e3 * state.viscosity, 1), round(1e8 * state.pressure_viscosity.pressure_viscosity, 2)
    (84.5, 2.24)
    """

    name: str
    verified: bool
    viscosity: ViscosityLaw
    pressure_viscosity: PressureViscosityLaw
    density_15: float
    density_slope: float = 0.0
    density_law: DensityLaw = "dowson-higginson"
    fitted_pressure: float = FITTED_PRESSURE
    thermal_conductivity: float | None = None
    heat_capacity: float = HEAT_CAPACITY
    correlation: str | None = None
    stated_coefficient: float | None = None
    stated_temperature: float | None = None
    assumed: str = field(default="", compare=False)
    label: str | None = field(default=None, compare=False)
    fitted_pressure_stated: bool = field(default=False, compare=False)

    def __post_init__(self) -> None:
        where = f"lubricant {self.name!r}"
        problems = Problems(f"{where}, label: {problem}" for problem in label_problem(self.label))
        if not (math.isfinite(self.density_15) and self.density_15 > 0):
            problems.append(
                f"{where}, density: got {self.density_15!r} kg/m3; allowed: finite and > 0; oils have about 880 kg/m3"
            )
        if not math.isfinite(self.density_slope):
            problems.append(f"{where}, density_slope: got {self.density_slope!r} kg/(m3 K); allowed: finite")
        if self.density_law not in DENSITY_LAWS:
            problems.append(f"{where}, density_law: got {self.density_law!r}; allowed: {', '.join(DENSITY_LAWS)}")
        if not self.fitted_pressure > 0:
            problems.append(f"{where}, fitted_pressure: got {self.fitted_pressure!r} Pa; allowed: > 0, inf if unknown")
        conductivity = self.thermal_conductivity
        if conductivity is not None and not (math.isfinite(conductivity) and conductivity > 0):
            problems.append(f"{where}, thermal_conductivity: got {conductivity!r} W/(m K); allowed: finite and > 0")
        if not (math.isfinite(self.heat_capacity) and self.heat_capacity > 0):
            problems.append(f"{where}, heat_capacity: got {self.heat_capacity!r} J/(kg K); allowed: finite and > 0")
        if self.correlation is not None and self.correlation not in CORRELATIONS:
            problems.append(f"{where}, correlation: got {self.correlation!r}; allowed: {', '.join(CORRELATIONS)}")
        if self.correlation is not None and self.pressure_viscosity.coefficient == "none":
            problems.append(
                f"{where}, correlation: got {self.correlation!r} with a law whose numbers give alpha; allowed: none"
            )
        problems.check()

    @property
    def title(self) -> str:
        """Name of the oil in titles: its label, else its name."""
        return self.label or self.name

    @property
    def reach_assumed(self) -> bool:
        """True where `fitted_pressure` is our assumption, because nobody stated how far the viscosity law reaches."""
        return self.fitted_pressure == FITTED_PRESSURE and not self.fitted_pressure_stated

    @property
    def reach(self) -> str:
        """Up to which pressure its viscosity holds, and whether that is known, in words.

        Examples
        --------
        >>> Lubricant.named("FVA3").reach
        '0.6 GPa, the reach that is assumed for FVA3 (none is stated)'
        """
        if math.isinf(self.fitted_pressure):
            return "those of its data"
        pressure = f"{1e-9 * self.fitted_pressure:.4g} GPa"
        if self.reach_assumed:
            return f"{pressure}, the reach that is assumed for {self.title} (none is stated)"
        return f"{pressure}, up to which {self.title} is stated"

    @property
    def estimated(self) -> str:
        """Statement of what is estimated or assumed, and how well, in words; empty where nothing is."""
        words, oil_class = [], self.oil_class
        if "density_slope" in self.assumed:
            constant = isinstance(self.viscosity, ConstantViscosity)
            slope = f"density {self.density_slope:+g} kg/m3 a K (assumed)"
            words.append("density and viscosity constant over temperature" if constant else slope)
        if "pressure_viscosity" in self.assumed.split(", "):
            words.append("pressure-viscosity constant over temperature: no correlation knows so thin an oil")
        if self.correlation and self._anchor:
            by, (alpha, temperature) = CORRELATIONS[self.correlation], self._anchor
            assumed = " (assumed)" if "pressure_viscosity_temperature" in self.assumed else ""
            words.append(
                f"pressure-viscosity {1e9 * alpha:.4g} 1/GPa at {temperature - ZERO_CELSIUS:.4g} degC{assumed}, its "
                f"change with temperature estimated by {by.authors}, {by.change}"
            )
        elif self.correlation:
            words += [*([oil_class.sentence] if oil_class else []), CORRELATIONS[self.correlation].sentence]
        return "; ".join(words)

    @property
    def _over_temperature(self) -> OilOverTemperature:
        """All that a correlation asks for."""
        return OilOverTemperature(self.viscosity, self.density_15, self.density_slope)

    def coefficient_error(self, temperature: float) -> float:
        """Relative error of the alpha that a correlation gives at a temperature [K]; 0 of a stated one.

        Of a correlation that goes through a stated value it is what the other correlations have there.
        """
        if self.correlation is None:
            return 0.0
        if self._anchor is None:
            return CORRELATIONS[self.correlation].rms
        return anchored_error(self.correlation, self._over_temperature, self._anchor, temperature)

    @property
    def _anchor(self) -> Anchor | None:
        """The stated alpha through which the correlation goes, if there is one."""
        if self.stated_coefficient is None or self.stated_temperature is None:
            return None
        return Anchor(self.stated_coefficient, self.stated_temperature)

    @property
    def oil_class(self) -> OilClass | None:
        """Class of ISO 3448 from which all its data are; None for an oil that has data of its own."""
        try:
            found = OilClass.of(self.name)
            same = found and self.viscosity == AstmViscosity(*found.viscosities) and self.density_15 == DENSITY
        except InputError:
            return None
        return found if same else None

    @classmethod
    def named(cls, name: str) -> Lubricant:
        """One of the oils of `LUBRICANTS`, or an oil of a viscosity class, such as "ISO VG 46" or "ISO VG 46, VI 120".

        Case, blanks and hyphens do not matter.

        FVA 3
            Reference oil; Lubricants 11, 2023, 369, table A1. The source of the viscosity law was not found
            to state its range in pressure: fitted_pressure = 0.6 GPa is an assumption. The law holds from
            -14.67 degC up.
        Spirax MA 80W
            No data sheet was found: typical values of an SAE 80W gear oil, marked unverified. nu40 = 87.5
            mm2/s, nu100 = 9.5 mm2/s, rho15 = 887 kg/m3, the density slope of FVA 3, and Roelands' law with
            the z that gives alpha = 2e-8 1/Pa at 40 degC.
        ISO VG 7 to 3200
            Viscosity by class and index, all else estimated, see `OilClass`; Roelands' law.

        Raises
        ------
        InputError
            If there is no oil of that name.
        """
        known = {_plain(word): oil for word, oil in _NAMED.items()}.get(_plain(name))
        if known is not None:
            return known
        oil_class = OilClass.of(name)
        if oil_class is not None:
            return _of_class(oil_class)
        raise InputError(
            f"lubricant name: got {short(name)}{closest(name, LUBRICANTS)}; allowed: {', '.join(LUBRICANTS)}, or "
            f"ISO VG {', '.join(map(str, CLASSES))} (ISO 3448), with an index as in 'ISO VG 46, VI 120'; give other "
            "oils by their data"
        )

    @classmethod
    def barus(cls, **data: Unpack[OilData]) -> Lubricant:
        """An oil with Barus' law, eta = eta0 exp(alpha p).

        Parameters
        ----------
        **data
            The same as for `own`.

        Examples
        --------
        >>> oil = Lubricant.barus(viscosity=0.1, pressure_viscosity=2e-8, density=880.0)
        >>> round(oil.at(313.15).viscosity_at(50e6), 4)
        0.2718
        """
        return cls.own("barus", {}, **data)

    @classmethod
    def roelands(cls, *, roelands_z: float | None = None, **data: Unpack[OilData]) -> Lubricant:
        """An oil with Roelands' law, p0 = 1.96e8 Pa.

        Parameters
        ----------
        roelands_z : float, optional
            Exponent z. Without it, z = alpha p0/(ln eta0 + 9.67) at each temperature; without a pressure_viscosity,
            alpha follows from z likewise; both hold as stated where both are given.
        **data
            The same as for `own`.

        Examples
        --------
        >>> oil = Lubricant.roelands(viscosity=0.04, pressure_viscosity=1.7e-8, density=870.0)
        >>> round(oil.at(313.15).pressure_viscosity.exponent, 4)
        0.5165
        """
        return cls.own("roelands", {} if roelands_z is None else {"exponent": roelands_z}, **data)

    @classmethod
    def fva3(cls, **data: Unpack[OilData]) -> Lubricant:
        """An own oil with the law p/(a + b p) and the coefficients of FVA 3 over pressure.

        Parameters
        ----------
        **data
            The same as for `own`. 1/a is the pressure_viscosity, which has to be stated; b is that of FVA 3.

        Examples
        --------
        >>> oil = Lubricant.fva3(viscosity=0.05, pressure_viscosity=2e-8, density=880.0)
        >>> round(oil.at(313.15).viscosity_at(0.5e9), 1)
        267.9
        """
        return cls.own("fva3", {}, **data)

    @classmethod
    def own(
        cls,
        viscosity_law: str,
        numbers: Mapping[str, float],
        *,
        density: float,
        pressure_viscosity: float | str | None = None,
        pressure_viscosity_40: float | None = None,
        pressure_viscosity_100: float | None = None,
        pressure_viscosity_temperature: float | None = None,
        viscosity: float | None = None,
        viscosity_40: float | None = None,
        viscosity_100: float | None = None,
        density_slope: float | None = None,
        density_law: DensityLaw = "dowson-higginson",
        fitted_pressure: float | None = None,
        thermal_conductivity: float | None = None,
        heat_capacity: float = HEAT_CAPACITY,
        name: str = "own oil",
    ) -> Lubricant:
        """An oil with any law over pressure; its user vouches for it, but not for an estimate.

        Parameters
        ----------
        viscosity_law : str
            One of `PRESSURE_LAWS`.
        numbers : mapping of str to float
            Attributes of that law in SI; those of Barus' law and the law of FVA 3 are none beside the coefficient.
        density : float
            rho0 at 15 degC [kg/m3].
        pressure_viscosity : float or str, optional
            alpha [1/Pa], or the name of a correlation that estimates it (`CORRELATIONS`); or both of the next two. None
            of them with a law whose numbers give alpha. One alpha beside two viscosities changes with temperature as
            the correlation of named oils does; beside a constant viscosity it is constant.
        pressure_viscosity_40, pressure_viscosity_100 : float, optional
            alpha at 40 and 100 degC [1/Pa]; ln alpha is linear in temperature.
        pressure_viscosity_temperature : float, optional
            Temperature of the one alpha [K]; 40 degC if left out.
        viscosity : float, optional
            eta0 [Pa s], constant; or both of the next two.
        viscosity_40, viscosity_100 : float, optional
            Kinematic viscosities at 40 and 100 degC [m2/s], joined by ASTM D341.
        density_slope : float, optional
            d rho0/dT [kg/(m3 K)]; if left out -0.6, that of mineral oils, and zero beside a constant viscosity.
        density_law : {"dowson-higginson", "incompressible"}
            Density over pressure.
        fitted_pressure : float, optional
            Reach of the viscosity data [Pa]; inf flags nothing. Left out, `FITTED_PRESSURE` is assumed, and called so.
        thermal_conductivity : float, optional
            k_f [W/(m K)]; films with heat need it.
        heat_capacity : float
            c_p [J/(kg K)].
        name : str
            Name for provenance and messages.

        Raises
        ------
        InputError
            With every value that is missing, doubly given, unknown or out of its limits.

        Examples
        --------
        >>> numbers = dict(doolittle_slope=4.5, occupied_fraction=0.66, occupied_expansion=-7e-4, volume_expansion=8e-4,
        ...     bulk_modulus=8.7e9, bulk_modulus_decay=6.3e-3, bulk_modulus_slope=11.0, reference_temperature=313.15)
        >>> oil = Lubricant.own("tait-doolittle", numbers, viscosity=0.02, density=800.0)
        >>> round(oil.at(313.15).viscosity_at(0.5e9), 2)
        17.85
        """
        stated = Stated(
            viscosity,
            viscosity_40,
            viscosity_100,
            pressure_viscosity,
            pressure_viscosity_40,
            pressure_viscosity_100,
            pressure_viscosity_temperature,
        )
        laws = own_laws(name, viscosity_law, stated, density, density_slope, numbers)
        return cls(
            name=name,
            verified=laws.correlation is None or laws.anchor is not None,
            viscosity=laws.viscosity,
            pressure_viscosity=laws.pressure_viscosity,
            density_15=density,
            density_slope=laws.density_slope,
            density_law=density_law,
            fitted_pressure=FITTED_PRESSURE if fitted_pressure is None else fitted_pressure,
            thermal_conductivity=thermal_conductivity,
            heat_capacity=heat_capacity,
            correlation=laws.correlation,
            stated_coefficient=laws.anchor and laws.anchor.coefficient,
            stated_temperature=laws.anchor and laws.anchor.temperature,
            assumed=laws.assumed,
            fitted_pressure_stated=fitted_pressure is not None,
        )

    def at(self, temperature: float) -> LubricantState:
        """The oil at a temperature [K].

        Raises
        ------
        InputError
            Where one of the laws breaks down, with the oil, the temperature, what is allowed and what to do.
        """
        where = f"lubricant {self.name!r}"
        if not (math.isfinite(temperature) and temperature > 0):
            raise InputError(f"{where}, temperature: got {temperature!r} K; allowed: finite and > 0 K")
        density = self.density_15 + self.density_slope * (temperature - ZERO_CELSIUS - 15.0)
        if density <= 0:
            raise InputError(
                f"{where}, temperature: got {temperature - ZERO_CELSIUS:.6g} degC, where its density is "
                f"{density:.6g} kg/m3; allowed: temperatures with a density > 0; check density_slope"
            )
        with problems_after(f"{where}, "):
            viscosity = self.viscosity.at(temperature, density)
            isotherm = self._isotherms(temperature, viscosity, density).at(temperature, viscosity)
        return LubricantState(
            temperature=temperature,
            viscosity=viscosity,
            density=density,
            pressure_viscosity=isotherm,
            compressible=self.density_law == "dowson-higginson",
            fitted_pressure=self.fitted_pressure,
        )

    def _isotherms(self, temperature: float, viscosity: float, density: float) -> PressureViscosityLaw:
        """The law over pressure, with the alpha of the correlation where there is one."""
        if self.correlation is None:
            return self.pressure_viscosity
        if self._anchor:
            alpha = anchored_coefficient(self.correlation, self._over_temperature, self._anchor, temperature)
        else:
            alpha = estimated_coefficient(self.correlation, self.viscosity, viscosity, density)
        coefficients: dict[str, Any] = {"pressure_viscosity_40": alpha, "pressure_viscosity_100": alpha}
        return replace(self.pressure_viscosity, **coefficients)

    def thickened(self, factor: float) -> Lubricant | None:
        """The oil with its constant viscosity times a factor; None of one that changes with the temperature.

        Parameters
        ----------
        factor : float
            Factor of the viscosity, > 0.
        """
        law = self.viscosity
        if not isinstance(law, ConstantViscosity):
            return None
        return replace(self, viscosity=ConstantViscosity(factor * law.viscosity))

    def with_alpha(self, factor: float, temperature: float) -> Lubricant | None:
        """The oil with its alpha times a factor; None where its law takes none.

        Parameters
        ----------
        factor : float
            Factor of alpha at all temperatures.
        temperature : float
            Temperature at which value and slope are kept [K]; further away the curve is another where alpha is by a
            correlation or by the numbers of its law, and that of the viscosity of FVA 3.

        Examples
        --------
        >>> oil = Lubricant.named("ISO VG 68")
        >>> at = [each.at(333.15).pressure_viscosity.pressure_viscosity for each in (oil, oil.with_alpha(1.25, 333.15))]
        >>> round(at[1] / at[0], 9)
        1.25
        """
        law: Any = self.pressure_viscosity
        if not hasattr(law, "pressure_viscosity_40"):
            return None
        cold, hot = law.pressure_viscosity_40, law.pressure_viscosity_100
        viscosity = self.viscosity
        if self.correlation is not None or cold is None or hot is None:
            around = [self.at(temperature + step) for step in (-1.0, 0.0, 1.0)]
            before, here, after = (float(each.pressure_viscosity.pressure_viscosity) for each in around)
            slope = 0.5 * math.log(after / before)
            cold, hot = (here * math.exp(slope * (ZERO_CELSIUS + end - temperature)) for end in (40.0, 100.0))
            if isinstance(viscosity, VogelViscosity):  # of named oils alone: no own oil has it
                ends = zip((-1.0, 1.0), around[::2], strict=True)
                cool, warm = ((temperature + step, each.viscosity / each.density) for step, each in ends)
                viscosity = AstmViscosity.through(cool, warm)
        coefficients: dict[str, Any] = {"pressure_viscosity_40": factor * cold, "pressure_viscosity_100": factor * hot}
        return replace(self, correlation=None, viscosity=viscosity, pressure_viscosity=replace(law, **coefficients))

    def record(self) -> dict[str, float | str | bool]:
        """Everything that defines the oil, flat, for provenance; SI units; values not given are left out.

        So is the heat capacity that is assumed, and whether the reach in pressure was stated where its value tells:
        records that were made before there was any are those of today.
        """
        record: dict[str, float | str | bool] = {}
        for entry in fields(self):
            value = getattr(self, entry.name)
            if entry.name == "viscosity":
                record["viscosity_over_temperature"] = _VISCOSITY_WORDS[type(value)]
                record.update(_given(value, rename=_VOGEL_WORDS))
            elif entry.name == "pressure_viscosity":
                record.update(law_record(value))
            elif entry.name == "fitted_pressure_stated":
                if value and self.fitted_pressure == FITTED_PRESSURE:
                    record[entry.name] = True
            elif value is not None and value != "" and not (entry.name == "heat_capacity" and value == HEAT_CAPACITY):
                record[entry.name] = value
        if self.estimated:
            record["estimated"] = self.estimated
        return record


_VISCOSITY_WORDS: Mapping[type, str] = {
    ConstantViscosity: "constant",
    AstmViscosity: "astm-d341",
    VogelViscosity: "vogel",
}

_VOGEL_WORDS = {"factor": "vogel_factor", "slope": "vogel_slope", "offset": "vogel_offset"}


def _given(law: ViscosityLaw, rename: Mapping[str, str]) -> dict[str, float]:
    """The parameters of a law."""
    return {rename.get(field.name, field.name): getattr(law, field.name) for field in fields(law)}


def _fva3() -> Lubricant:
    """FVA 3 after Lubricants 11, 2023, 369, table A1."""
    return Lubricant(
        name="FVA3",
        verified=True,
        viscosity=VogelViscosity(factor=0.062e-3, slope=1021.7, offset=101.5517),
        pressure_viscosity=Fva3(),
        density_15=887.6,
        density_slope=-0.6,
        fitted_pressure=0.6e9,
        thermal_conductivity=0.134,
    )


def _spirax() -> Lubricant:
    """Guess of an SAE 80W gear oil, see `Lubricant.named`."""
    density, slope = 887.0, -0.6
    viscosity = AstmViscosity(87.5e-6, 9.5e-6)
    cold = ZERO_CELSIUS + 40.0
    z = 2e-8 * ROELANDS_PRESSURE / (math.log(viscosity.at(cold, density + 25.0 * slope)) + ROELANDS_LOG)
    return Lubricant(
        name="Spirax MA 80W",
        verified=False,
        viscosity=viscosity,
        pressure_viscosity=Roelands(z, None, None),
        density_15=density,
        density_slope=slope,
    )


def _of_class(oil_class: OilClass) -> Lubricant:
    """Oil of a viscosity class."""
    return Lubricant.roelands(
        viscosity_40=oil_class.viscosities[0],
        viscosity_100=oil_class.viscosities[1],
        density=DENSITY,
        density_slope=DENSITY_SLOPE,
        pressure_viscosity=oil_class.correlation,
        thermal_conductivity=CONDUCTIVITY,
        name=oil_class.name,
    )


def _plain(name: str) -> str:
    """A name without case, blanks and hyphens."""
    return re.sub(r"[\s_-]+", "", name).casefold()


_NAMED: Mapping[str, Lubricant] = {oil.name: oil for oil in (_fva3(), _spirax())}
DEFAULT_OIL = "FVA3"
"""Oil where none is said: a mineral oil of ISO VG 100 whose data are published."""

LUBRICANTS: tuple[str, ...] = tuple(_NAMED)
"""Names that `Lubricant.named` knows."""
