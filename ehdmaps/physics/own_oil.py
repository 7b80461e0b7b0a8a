"""The laws of an own oil, from what its user states; what nobody measured is estimated by correlations.

An estimate holds at each temperature: it follows viscosity and density there. Its error is not small; see
`Correlation.error`. Where one alpha is stated beside the viscosities at two temperatures, the correlation goes through
it, and says only how it changes with temperature; see `Anchor`.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass
from typing import Literal, NamedTuple, Required, TypedDict

from ehdmaps.errors import InputError, problems_after
from ehdmaps.physics.designations.oil_class import DENSITY_SLOPE
from ehdmaps.physics.viscosity import (
    PRESSURE_LAWS,
    ZERO_CELSIUS,
    AstmViscosity,
    ConstantViscosity,
    PressureViscosityLaw,
    ViscosityLaw,
)

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
    change : str
        How far its change with temperature is from that of measured oils, from the value at 30 degC on.
    rms : float
        Root mean square of the error, relative.
    needs_slope : bool
        Whether it needs the slope of viscosity over temperature (ASTM D341).
    formula : callable
        alpha [1e-8 1/Pa] of viscosity [mm2/s], density [g/cm3] and slope [-].
    """

    name: str
    authors: str
    error: str
    change: str
    rms: float
    needs_slope: bool
    formula: Callable[[float, float, float], float]

    @property
    def sentence(self) -> str:
        """Sentence that a map says of it."""
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
            "from 30 degC on 13 % low on average against 24 published values of mineral oils, 15 % rms",
            0.17,
            True,
            so_klaus,
        ),
        Correlation(
            "gold-mineral",
            "Gold et al. (2001) for mineral oils",
            "against 38 published values of mineral oils 25 % low on average, 27 % rms",
            "from 30 degC on 6 % high on average against 24 published values of mineral oils, 12 % rms",
            0.27,
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


class Anchor(NamedTuple):
    """A stated alpha [1/Pa] and its temperature [K], through which a correlation goes."""

    coefficient: float
    temperature: float


STATED_AT = ZERO_CELSIUS + 40.0
"""Temperature of an alpha of which none is stated [K]: that of most data sheets."""


DensityLaw = Literal["dowson-higginson", "incompressible"]


class OilData(TypedDict, total=False):
    """Stated data of an own oil, whatever its law over pressure; explained at `Lubricant.own`."""

    density: Required[float]
    pressure_viscosity: float | str | None
    pressure_viscosity_40: float | None
    pressure_viscosity_100: float | None
    pressure_viscosity_temperature: float | None
    viscosity: float | None
    viscosity_40: float | None
    viscosity_100: float | None
    density_slope: float | None
    density_law: DensityLaw
    fitted_pressure: float
    thermal_conductivity: float | None
    heat_capacity: float
    name: str


class Stated(NamedTuple):
    """Viscosity and pressure-viscosity as stated: a constant, or values at 40 and 100 degC.

    `coefficient` may be the name of a correlation, or hold at the temperature `coefficient_at` [K].
    """

    viscosity: float | None
    viscosity_40: float | None
    viscosity_100: float | None
    coefficient: float | str | None
    coefficient_40: float | None
    coefficient_100: float | None
    coefficient_at: float | None = None

    @property
    def coefficients(self) -> tuple[float | str | None, float | None, float | None]:
        """All that is stated of alpha."""
        return self.coefficient, self.coefficient_40, self.coefficient_100


_SOUND = {"viscosity": 0.1, "viscosity_40": 1e-4, "viscosity_100": 1e-5}


class Laws(NamedTuple):
    """Laws that an own oil consists of; `correlation` is the name of the one that gives alpha, if one does.

    With an `anchor` it goes through a stated alpha. `assumed` are the keys of what nobody stated, see
    `Lubricant.assumed`.
    """

    viscosity: ViscosityLaw
    pressure_viscosity: PressureViscosityLaw
    correlation: str | None
    anchor: Anchor | None
    density_slope: float
    assumed: str


def own_laws(
    name: str, word: str, stated: Stated, density: float, density_slope: float | None, numbers: Mapping[str, float]
) -> Laws:
    """Laws of an own oil.

    Parameters
    ----------
    name : str
        Name of the oil, for messages.
    word : str
        Law over pressure, one of `PRESSURE_LAWS`.
    stated : Stated
        Stated numbers in SI.
    density : float
        Density at 15 degC [kg/m3].
    density_slope : float or None
        Density over temperature [kg/(m3 K)]; None where it is not stated: that of mineral oils then, of an oil whose
        viscosity changes with temperature.
    numbers : mapping of str to float
        Attributes of that law, beside the pressure-viscosity coefficient.

    Raises
    ------
    InputError
        With everything that is missing, doubly given or out of its limits.
    """
    problems = _law_problems(name, word, stated, numbers)
    viscosity, correlation, pair = _looked_at(name, word, stated, problems)
    if problems or viscosity is None:
        raise InputError(problems)
    assumed, constant = [], isinstance(viscosity, ConstantViscosity)
    if density_slope is None:
        assumed.append("density_slope")
        density_slope = 0.0 if constant else DENSITY_SLOPE
    oil, anchor = OilOverTemperature(viscosity, density, density_slope), None
    if correlation:
        pair = _estimated_pair(name, correlation, oil)
    elif isinstance(stated.coefficient, (int, float)) and stated.coefficient > 0.0 and not constant:
        anchor = Anchor(stated.coefficient, stated.coefficient_at or STATED_AT)
        correlation = _reaching(oil, anchor)
        if correlation is None:
            anchor = None
            assumed.append("pressure_viscosity")
        else:
            assumed += ["pressure_viscosity_temperature"] if stated.coefficient_at is None else []
            pair = (
                anchored_coefficient(correlation, oil, anchor, ZERO_CELSIUS + 40.0),
                anchored_coefficient(correlation, oil, anchor, ZERO_CELSIUS + 100.0),
            )
    return Laws(viscosity, _isotherms(word, pair, numbers), correlation, anchor, density_slope, ", ".join(assumed))


class OilOverTemperature(NamedTuple):
    """Viscosity over temperature, density at 15 degC [kg/m3] and its slope [kg/(m3 K)]: what a correlation asks for."""

    viscosity: ViscosityLaw
    density_15: float
    density_slope: float

    def estimate(self, correlation: str, temperature: float) -> float:
        """Alpha [1/Pa] by a correlation at a temperature [K]."""
        rho = self.density_15 + self.density_slope * (temperature - ZERO_CELSIUS - 15.0)
        return estimated_coefficient(correlation, self.viscosity, self.viscosity.at(temperature, rho), rho)


def _reaching(oil: OilOverTemperature, anchor: Anchor) -> str | None:
    """The correlation that named oils of this viscosity have, or the next one that holds at 40 and 100 degC."""
    for correlation in CORRELATIONS:
        try:
            for temperature in (anchor.temperature, ZERO_CELSIUS + 40.0, ZERO_CELSIUS + 100.0):
                oil.estimate(correlation, temperature)
        except InputError:
            continue
        return correlation
    return None


def anchored_coefficient(correlation: str, oil: OilOverTemperature, anchor: Anchor, temperature: float) -> float:
    """Alpha [1/Pa] by a correlation that goes through a stated value.

    Beyond the temperatures to which the correlation reaches it stays as it is at their end: a stated oil is refused
    nowhere for the sake of an estimate.

    Parameters
    ----------
    correlation : str
        Name of a correlation.
    oil : OilOverTemperature
        The oil.
    anchor : Anchor
        What is stated.
    temperature : float
        [K].
    """
    known = oil.estimate(correlation, anchor.temperature)
    try:
        return anchor.coefficient * oil.estimate(correlation, temperature) / known
    except InputError:
        inside, outside, end = anchor.temperature, temperature, known
        for _ in range(_HALVINGS):
            middle = 0.5 * (inside + outside)
            try:
                inside, end = middle, oil.estimate(correlation, middle)
            except InputError:
                outside = middle
        return anchor.coefficient * end / known


def anchored_error(correlation: str, oil: OilOverTemperature, anchor: Anchor, temperature: float) -> float:
    """Relative error of an alpha by a correlation that goes through a stated value: what the other ones have there.

    Parameters
    ----------
    correlation : str
        Name of a correlation.
    oil : OilOverTemperature
        The oil.
    anchor : Anchor
        What is stated.
    temperature : float
        [K].
    """
    alpha, errors = anchored_coefficient(correlation, oil, anchor, temperature), [0.0]
    for other in CORRELATIONS:
        with suppress(InputError):
            errors.append(abs(anchored_coefficient(other, oil, anchor, temperature) / alpha - 1.0))
    return max(errors)


_HALVINGS = 40


def stated_problems(name: str, word: str | None, stated: Stated) -> list[str]:
    """Data of an own oil that are missing or doubly given, beside what is wrong about its values already.

    Parameters
    ----------
    name : str
        Name of the oil, for messages.
    word : str or None
        Law over pressure, one of `PRESSURE_LAWS`; None where it is not known.
    stated : Stated
        Stated numbers in SI; nan for one that is stated and no number.
    """
    problems: list[str] = []
    if any(value is not None and math.isnan(value) for value in stated[:3]):
        # What is stated of the viscosity counts then, not its values.
        stated = stated._replace(**{key: value for key, value in _SOUND.items() if getattr(stated, key) is not None})
    if word is not None:
        problems += _law_problems(name, word, stated, {entry.field: 0.0 for entry in PRESSURE_LAWS[word].parameters})
    _looked_at(name, word, stated, problems)
    return problems


def _looked_at(
    name: str, word: str | None, stated: Stated, problems: list[str]
) -> tuple[ViscosityLaw | None, str | None, tuple[float, float] | None]:
    """Viscosity over temperature, and the correlation or the pair that gives alpha; problems are noted."""
    viscosity = _viscosity_law(name, stated, problems)
    correlation = _correlation(name, stated, viscosity, problems)
    pair = _coefficient_pair(name, stated, problems)
    if stated.coefficients == (None, None, None) and word is not None and PRESSURE_LAWS[word].coefficient == "needed":
        problems.append(
            f"lubricant {name!r}, pressure_viscosity: got none; viscosity_law {word} needs it; give it in 1/Pa, or the "
            f"name of a correlation that estimates it: {', '.join(CORRELATIONS)}"
        )
    return viscosity, correlation, pair


def estimated_coefficient(correlation: str, law: ViscosityLaw, viscosity: float, density: float) -> float:
    """Alpha [1/Pa] by a correlation where an oil has these eta0 [Pa s] and rho0 [kg/m3].

    Parameters
    ----------
    correlation : str
        Name of a correlation.
    law : ViscosityLaw
        Viscosity over temperature, from which a correlation takes its slope.
    viscosity : float
        eta0 [Pa s].
    density : float
        rho0 [kg/m3].
    """
    slope = law.slope if isinstance(law, AstmViscosity) else 0.0
    return estimate(correlation, viscosity / density, density, slope)


def _law_problems(name: str, word: str, stated: Stated, numbers: Mapping[str, float]) -> list[str]:
    """An unknown law, and numbers that do not belong to it or that it lacks."""
    where = f"lubricant {name!r}"
    if word not in PRESSURE_LAWS:
        raise InputError(f"{where}, viscosity_law: got {word!r:.60}; allowed: {', '.join(PRESSURE_LAWS)}")
    kind = PRESSURE_LAWS[word]
    known = [parameter.field for parameter in kind.parameters]
    problems = [
        f"{where}, {field}: stands beside viscosity_law = {word!r}, which has: {', '.join(known) or 'none'}; delete it"
        for field in numbers
        if field not in known
    ]
    if kind.coefficient == "none":
        if stated.coefficients != (None, None, None):
            problems.append(
                f"{where}, pressure_viscosity: stands beside viscosity_law = {word!r}, whose numbers give it; delete it"
            )
        lacking = [field for field in known if field not in numbers]
        problems += [f"{where}, {field}: missing; viscosity_law {word} needs it" for field in lacking]
    return problems


def _isotherms(word: str, pair: tuple[float, float] | None, numbers: Mapping[str, float]) -> PressureViscosityLaw:
    """The law over pressure."""
    kind = PRESSURE_LAWS[word]
    values: dict[str, float | None] = dict(numbers)
    if kind.coefficient != "none":
        cold, hot = pair or (None, None)
        values |= {"pressure_viscosity_40": cold, "pressure_viscosity_100": hot}
        values |= {parameter.field: None for parameter in kind.parameters if parameter.field not in numbers}
    return kind(**values)  # type: ignore[arg-type]


def _estimated_pair(name: str, correlation: str, oil: OilOverTemperature) -> tuple[float, float]:
    """Alpha at 40 and 100 degC by a correlation."""
    values = []
    for celsius in (40.0, 100.0):
        with problems_after(f"lubricant {name!r}, ", f" (at {celsius:g} degC)"):
            values.append(oil.estimate(correlation, ZERO_CELSIUS + celsius))
    return values[0], values[1]


def _viscosity_law(name: str, stated: Stated, problems: list[str]) -> ViscosityLaw | None:
    """The law that is given, or None with its problems noted."""
    where = f"lubricant {name!r}"
    constant, cold, hot = stated[:3]
    try:
        if constant is not None and cold is None and hot is None:
            return ConstantViscosity(constant)
        if constant is None and cold is not None and hot is not None:
            return AstmViscosity(cold, hot)
    except InputError as error:
        problems.extend(f"{where}, {problem}" for problem in error.problems)
        return None
    problems.append(
        f"{where}, viscosity: got "
        f"{_listed(viscosity=constant, viscosity_40=cold, viscosity_100=hot)}; "
        "allowed: either viscosity, or viscosity_40 and viscosity_100; give one of the two"
    )
    return None


def _correlation(name: str, stated: Stated, law: ViscosityLaw | None, problems: list[str]) -> str | None:
    """Name of the correlation that is asked for; None if none is, or with its problems noted."""
    word = stated.coefficient
    if not isinstance(word, str):
        return None
    where = f"lubricant {name!r}, pressure_viscosity"
    if word not in CORRELATIONS:
        problems.append(f"{where}: got {word!r:.60}; allowed: a number in 1/Pa, or {', '.join(CORRELATIONS)}")
    elif CORRELATIONS[word].needs_slope and law is not None and not isinstance(law, AstmViscosity):
        problems.append(
            f"{where}: got {word!r}, which needs the viscosity at two temperatures; allowed: with viscosity_40 and "
            "viscosity_100; give them, or pressure_viscosity in 1/Pa"
        )
    return word if word in CORRELATIONS else None


def _coefficient_pair(name: str, stated: Stated, problems: list[str]) -> tuple[float, float] | None:
    """Alpha at 40 and 100 degC, or None if none is given (or with its problems noted)."""
    constant, cold, hot = stated.coefficients
    if stated.coefficient_at is not None and not (isinstance(constant, (int, float)) and stated.viscosity is None):
        problems.append(
            f"lubricant {name!r}, pressure_viscosity_temperature: stands without one pressure_viscosity in 1/Pa beside "
            "viscosity_40 and viscosity_100; allowed: with them; delete it"
        )
    if isinstance(constant, str):
        return None
    if constant is not None and cold is None and hot is None:
        return constant, constant
    if constant is None and cold is not None and hot is not None:
        return cold, hot
    if constant is not None or cold is not None or hot is not None:
        given = _listed(pressure_viscosity=constant, pressure_viscosity_40=cold, pressure_viscosity_100=hot)
        problems.append(
            f"lubricant {name!r}, pressure_viscosity: got {given}; allowed: either pressure_viscosity, or "
            "pressure_viscosity_40 and pressure_viscosity_100; give one of the two"
        )
    return None


def _listed(**values: float | None) -> str:
    """Names of the values that are given."""
    return " and ".join(name for name, value in values.items() if value is not None) or "none"
