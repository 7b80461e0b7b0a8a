"""Strings with units: the one place where they are read, and where numbers are written for people.

Inside the package and in files everything is SI, temperatures in K. `quantity` turns what a person typed
("62 N/mm", "40 degC") into that; the `Display` values turn it back into an engineer's units, one for each quantity in
whatever is printed or drawn: the table "Units" of docs/reference_ehdmaps.md has them.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING, Any

from ehdmaps.errors import InputError
from ehdmaps.errors import closest as closest  # noqa: PLC0414  # what readers of texts take from here, too
from ehdmaps.errors import short as short  # noqa: PLC0414

if TYPE_CHECKING:
    import pint

LONGEST_QUANTITY = 80
"""Characters; no sensible quantity is longer, and a parser should not be asked to try."""

_NUMBER = re.compile(r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]{1,3})?")
# One power a unit, of one digit: pint evaluates powers, and "m^9^9^9" would keep it busy for ever.
_ATOM = r"[A-Za-zµμ°%]+(?:(?:(?:\^|\*\*)-?)?[1-9]|[²³])?"
_PLAIN_POWER = re.compile(r"(?<=[A-Za-zµμ])([1-9])")
"""As all output writes it: "kg m2", "m/s2"."""

_UNIT = re.compile(rf"(?:1 ?/ ?)?\(?{_ATOM}(?:(?: ?[*/·] ?| )\(?{_ATOM}\)?)*")

_COMMON: dict[str, dict[str, tuple[float, float]]] = {
    "N": {"kN": (1e3, 0.0)},
    "N/m": {"N/mm": (1e3, 0.0)},
    "N/m^2": {"N/(um mm)": (1e9, 0.0)},
    "m": {"mm": (1e-3, 0.0), "um": (1e-6, 0.0)},
    "K": {"degC": (1.0, 273.15)},
    "Pa": {"MPa": (1e6, 0.0), "GPa": (1e9, 0.0)},
    "1/Pa": {"1/GPa": (1e-9, 0.0)},
    "Pa s": {"mPa s": (1e-3, 0.0)},
    "m^2/s": {"mm^2/s": (1e-6, 0.0)},
    "s": {"ms": (1e-3, 0.0), "us": (1e-6, 0.0)},
    "Hz": {"kHz": (1e3, 0.0)},
    "rad": {"deg": (0.0174532925199433, 0.0)},
}
"""Factor and offset of common units, as pint has them, which takes a third of a second to load."""

_TURNING = {
    **dict.fromkeys(
        ("rpm", "1/min", "/min", "min-1", "min^-1", "r/min", "u/min", "min⁻¹", "rev/min"), 0.10471975511966
    ),
    "hz": 6.28318530717959,
}
"""Radians a second of a speed of rotation in the units of catalogues, drawings and analysers, in small letters."""

_EXAMPLES = {
    "N/m": "62 N/mm",
    "N": "62 N",
    "m": "0.7 mm",
    "m/s": "1.7 m/s",
    "K": "40 degC",
    "Pa": "210 GPa",
    "1/Pa": "22.4 1/GPa",
    "Pa s": "84.5 mPa s",
    "m^2/s": "95 mm^2/s",
    "kg/m^3": "880 kg/m^3",
    "Hz": "1 kHz",
    "rad/s": '500 rpm", "25 Hz',
}


def quantity(text: object, unit: str) -> float:
    """Read a number with its unit, in SI.

    Parameters
    ----------
    text : object
        What was typed; anything but a string such as "62 N/mm" is refused.
    unit : str
        The SI unit of the result, which also says what units are allowed ("N/m", "K", "rad/s").

    Returns
    -------
    float
        The value in `unit`; always finite.

    Raises
    ------
    InputError
        With one problem, which does not say where: the caller knows that.

    Examples
    --------
    >>> quantity("62 N/mm", "N/m")
    62000.0
    >>> quantity("40 degC", "K")
    313.15
    """
    if not isinstance(text, str):
        raise InputError(f"got {short(text)} without a unit; allowed: {_allowed(unit)}")
    stripped = text.strip()
    if len(stripped) > LONGEST_QUANTITY:
        raise InputError(f"got {short(text)}, {len(text)} characters long; allowed: {_allowed(unit)}")
    number = _NUMBER.match(stripped)
    if number is None:
        raise InputError(f"got {short(text)}, which does not start with a number; allowed: {_allowed(unit)}")
    unit_text = " ".join(stripped[number.end() :].split())
    if not unit_text:
        raise InputError(f"got {short(text)} without a unit; allowed: {_allowed(unit)}")
    common = (1.0, 0.0) if unit_text == unit else _COMMON.get(unit, {}).get(unit_text)
    if common is None and unit == "rad/s" and (turning := _TURNING.get(unit_text.lower().replace(" ", ""))):
        common = turning, 0.0
    if common is None and not _UNIT.fullmatch(unit_text):
        raise InputError(
            f"got {short(text)}, where {short(unit_text)} does not read as a unit; allowed: {_allowed(unit)}"
        )
    factor, offset = common or _conversion(unit_text, unit)
    value = float(number.group()) * factor + offset
    if not math.isfinite(value):
        raise InputError(f"got {short(text)}, which is too large for a number; allowed: {_allowed(unit)}")
    return float(f"{value:.15g}")  # 273.15 + 40 is 313.15, not 313.15000000000003


def quantity_within(text: object, unit: str, low: float, high: float, wrong: str) -> float:
    """Read a number with its unit within limits, of which one sentence says all that may be wrong.

    Parameters
    ----------
    text : object
        What was typed.
    unit : str
        SI unit of the result.
    low, high : float
        Smallest and largest value allowed, in SI.
    wrong : str
        What is said of a text that does not read, and of a value beyond the limits.

    Raises
    ------
    InputError
        With that text.
    """
    try:
        return quantity_between(text, unit, low, high, Display(unit))
    except InputError as error:
        raise InputError(wrong) from error


_ROUND_OFF = 1e-12
"""Part of a limit by which a value of just its size may miss it, as 1e5 rpm do in rad/s."""


def quantity_between(text: object, unit: str, low: float, high: float, display: Display) -> float:
    """Read a number with its unit that has to lie within limits, which are shown where it does not.

    Parameters
    ----------
    text : object
        What was typed.
    unit : str
        SI unit of the result.
    low, high : float
        Smallest and largest value allowed, in SI.
    display : Display
        How the limits are shown.

    Raises
    ------
    InputError
        For a text that does not read, and a value beyond the limits.

    Examples
    --------
    >>> quantity_between("1e5 rpm", "rad/s", 0.0, 1e5 * math.pi / 30.0, RPM) == 1e5 * math.pi / 30.0
    True
    """
    value = quantity(text, unit)
    if not low - _ROUND_OFF * abs(low) <= value <= high + _ROUND_OFF * abs(high):
        limits = f"{display.text(low)} to {display.text(high)}"
        raise InputError(f"got {short(text)}; allowed: {limits}; check value and unit")
    return min(max(value, low), high)


def whole_number(text: str, low: int, high: int) -> int:
    """Read a whole number within limits.

    Parameters
    ----------
    text : str
        What was typed: digits alone.
    low, high : int
        Smallest and largest number allowed.

    Raises
    ------
    InputError
        For anything else.

    Examples
    --------
    >>> whole_number("12", 1, 20)
    12
    """
    if text.isascii() and text.isdigit() and len(text) < 10 and low <= int(text) <= high:
        return int(text)
    raise InputError(f"got {short(text)}; allowed: a whole number from {low} to {high}")


def _allowed(unit: str) -> str:
    """Say what a quantity of this unit looks like."""
    example = _EXAMPLES.get(unit)
    return f'a number with a unit of {unit}, such as "{example}"' if example else f"a number with a unit of {unit}"


@lru_cache(maxsize=1)
def _registry() -> pint.UnitRegistry[float]:
    """Return pint's registry; it takes a quarter of a second to build, so nobody does without need."""
    import pint

    return pint.UnitRegistry()


@lru_cache(maxsize=1024)
def _conversion(unit_text: str, unit: str) -> tuple[float, float]:
    """Return factor and offset from the typed unit to the SI unit."""
    import tokenize

    import pint

    registry = _registry()
    wrong = f"got the unit {short(unit_text)}; allowed: {_allowed(unit)}"
    if unit_text == "C" and unit == "K":
        raise InputError(f"{wrong}; C is the coulomb, write degC")
    target = registry.parse_units(unit)
    try:
        given = registry.parse_units(_PLAIN_POWER.sub(r"^\1", unit_text.replace("·", "*")))
        if given.dimensionality != target.dimensionality:
            raise InputError(wrong)
        if _turns(given) != _turns(target) and target.dimensionality == registry.Unit("Hz").dimensionality:
            # pint takes 1 Hz for 1 rad/s, which is wrong by 2 pi either way.
            raise InputError(f"{wrong}; cycles (Hz) and angles (rad, rpm) are not converted into each other")
        zero = float(registry.Quantity(0.0, given).to(target).magnitude)
        thousand = float(registry.Quantity(1000.0, given).to(target).magnitude)
    except (
        pint.PintError,
        ValueError,
        AttributeError,
        TypeError,
        AssertionError,
        tokenize.TokenError,
    ) as error:
        raise InputError(wrong) from error
    return float(f"{(thousand - zero) / 1000.0:.15g}"), float(f"{zero:.15g}")


def _turns(unit: pint.Unit) -> float:
    """Return the power of the angle in a unit: pint keeps it as 'radian' although it has no dimension."""
    _, root = _registry().get_root_units(unit)
    power: Any = dict(root._units).get("radian", 0.0)
    return float(power)


@dataclass(frozen=True)
class Display:
    """Form in which a quantity is shown to people.

    Attributes
    ----------
    unit : str
        Unit as printed and as on a figure's axis.
    factor, offset : float
        shown = SI * factor + offset.
    """

    unit: str
    factor: float = 1.0
    offset: float = 0.0

    def value(self, si: float) -> float:
        """Return the number in the display unit."""
        return si * self.factor + self.offset

    def text(self, si: float, digits: int = 4) -> str:
        """Return the number with its unit, such as '62 N/mm'."""
        return f"{written(self.value(si), digits)} {self.unit}"


def written(value: float, digits: int = 4) -> str:
    """Return a number for people: with so many digits, and whole up to a million, where an exponent would stand.

    Parameters
    ----------
    value : float
        The number.
    digits : int
        How many digits count.

    Examples
    --------
    >>> written(12000.0), written(0.123456), written(-12345.6), written(2.5e7)
    ('12000', '0.1235', '-12346', '2.5e+07')
    """
    return f"{value:.0f}" if 10.0**digits <= abs(value) < 1e6 else f"{value:.{digits}g}"


LOAD = Display("N/mm", 1e-3)
SPEED = Display("m/s")
RPM = Display("rpm", 30.0 / math.pi)
TEMPERATURE = Display("degC", 1.0, -273.15)
KELVIN = Display("K")
FILM = Display("um", 1e6)
LENGTH = Display("mm", 1e3)
PRESSURE = Display("GPa", 1e-9)
# Of a contact, per length.
STIFFNESS = Display("N/(um mm)", 1e-9)
DAMPING = Display("N s/mm2", 1e-6)
COMPLIANCE = Display("um mm/N", 1e9)
# Of a roller, a bearing, a spring.
SPRING = Display("N/um", 1e-6)
DAMPER = Display("N s/mm", 1e-3)
ROLLING_FORCE = Display("N/m")
MASS_FLOW = Display("g/(m s)", 1e3)

MOTIONS = {
    "m": Display("um", 1e6),
    "m/s": Display("mm/s", 1e3),
    "m/s2": Display("m/s2"),
    "rad": Display("urad", 1e6),
    "rad/s": Display("mrad/s", 1e3),
    "rad/s2": Display("rad/s2"),
}
"""How people are shown displacements, velocities and accelerations, by SI unit; so are responses, per N or N m."""


def point_text(load: float, entrainment_speed: float, temperature: float) -> str:
    """Return an operating point of a line contact in words, such as '62 N/mm, 1.7 m/s, 40 degC'.

    Parameters
    ----------
    load, entrainment_speed, temperature : float
        w [N/m], u [m/s], T [K].
    """
    return f"{LOAD.text(load)}, {SPEED.text(entrainment_speed)}, {TEMPERATURE.text(temperature)}"


def span(values: Iterable[float], display: Display) -> str:
    """Return the range of some values in words, such as '0.1 to 1000 N/mm'.

    Parameters
    ----------
    values : iterable of float
        The values, in SI.
    display : Display
        How they are shown.
    """
    shown = [display.value(float(value)) for value in values]
    low, high = min(shown), max(shown)
    return f"{low:.4g} {display.unit}" if low == high else f"{low:.4g} to {high:.4g} {display.unit}"


# How well a number is known: beside values ("25 um +- 5 um"), and in [tolerances]. A tolerance is a half-width, size
# ("5 um", "2 K") or part ("10 %"); nothing at all ("0 um", "0 %") says that the number is exact.

_SIGN = re.compile(r"\+-|\+/-|±")
_PART = re.compile(r"([0-9]+\.?[0-9]*|\.[0-9]+) ?%")

OF = " of "
"""Between a key and the name of a bearing."""

MOST = 1.0
"""Largest tolerance that is a part."""


@dataclass(frozen=True)
class Tolerated:
    """Row of what a tolerance may be stated of: a key of [tolerances].

    Attributes
    ----------
    name : str
        The key.
    unit : str
        SI unit of an absolute tolerance; empty where it is a part.
    most : float
        Largest absolute tolerance [unit].
    part : bool
        Whether it may be a part.
    display : Display
        How messages show an absolute one.
    examples : str
        What may be written, for messages.
    """

    name: str
    unit: str
    most: float
    part: bool
    display: Display
    examples: str


TOLERATED: Mapping[str, Tolerated] = {
    row.name: row
    for row in (
        Tolerated("clearance", "m", 1e-3, True, Display("um", 1e6), "5 um, or 10 %"),
        Tolerated("temperature", "K", 50.0, False, Display("K"), "2 K"),
        Tolerated("viscosity", "", 0.0, True, Display("%", 100.0), "5 %"),
        Tolerated("pressure_viscosity", "", 0.0, True, Display("%", 100.0), "10 %"),
        Tolerated("oil_layer", "", 0.0, True, Display("%", 100.0), "20 %"),
        Tolerated(
            "geometry", "", 0.0, True, Display("%", 100.0), "0 %: as drawn, or 50 % of the errors of an estimate"
        ),
        Tolerated("preload", "N", 1e7, True, Display("N"), "20 N, or 10 %"),
        Tolerated("stiffness", "", 0.0, True, Display("%", 100.0), "30 %"),
        Tolerated("load", "", 0.0, True, Display("%", 100.0), "5 %"),
        Tolerated("profile", "", 0.0, False, Display("%", 100.0), "0 %: as the scene has it"),
        Tolerated("cage_angle", "rad", 2.0 * math.pi, False, Display("deg", 180.0 / math.pi), "0 deg: as it starts"),
    )
}
"""Keys of [tolerances], in the order of the reference."""


@dataclass(frozen=True)
class Tolerance:
    """Half-width of what a number may be off.

    Attributes
    ----------
    size : float
        Half-width in SI, or the part.
    part : bool
        Whether it is a part of the number.
    text : str
        Text as it was written.
    """

    size: float
    part: bool
    text: str

    @property
    def exact(self) -> bool:
        """Tell whether the number is known."""
        return self.size == 0.0

    def half_width(self, value: float) -> float:
        """Half-width at a value [unit of the value]."""
        return self.size * abs(value) if self.part else self.size


def read_tolerance(text: object, name: str) -> Tolerance:
    """Read one tolerance.

    Parameters
    ----------
    text : object
        Such as "5 um" or "10 %", with or without a sign before it.
    name : str
        What it belongs to, one of `TOLERATED`.

    Raises
    ------
    InputError
        With one problem, which does not say where: the caller knows that.

    Examples
    --------
    >>> read_tolerance("+- 5 um", "clearance").half_width(20e-6), read_tolerance("25 %", "clearance").half_width(20e-6)
    (5e-06, 5e-06)
    """
    row = TOLERATED[name]
    wrong = InputError(f"got {short(text)}; allowed: {_tolerable(row)}")
    if not isinstance(text, str):
        raise wrong
    plain = _SIGN.sub("", text, count=1).strip()
    if found := _PART.fullmatch(plain):
        part = float(f"{0.01 * float(found.group(1)):.15g}")
        if part > MOST or (part and not row.part):
            raise wrong
        return Tolerance(part, True, f"+-{plain}")
    if not row.unit:
        raise wrong
    try:
        size = quantity(plain, row.unit)
    except InputError:
        raise wrong from None
    if not 0.0 <= size <= row.most:
        raise wrong
    return Tolerance(size, False, f"+-{plain}")


def split(text: str) -> tuple[str, str]:
    """A value and its tolerance as they were typed; either is empty where it is not there.

    Examples
    --------
    >>> split("25 um +- 5 um"), split("25 um"), split("+- 10 %")
    (('25 um', '5 um'), ('25 um', ''), ('', '10 %'))
    """
    value, _, tolerance = _SIGN.sub("\0", text, count=1).partition("\0")
    return value.strip(), tolerance.strip()


OF_JOBS = ("clearance", "temperature", "viscosity", "pressure_viscosity", "geometry")
"""Keys of these that a job has."""

OF_OILS = {
    "viscosity": "viscosity",
    "viscosity_40": "viscosity",
    "viscosity_100": "viscosity",
    "pressure_viscosity": "pressure_viscosity",
    "pressure_viscosity_40": "pressure_viscosity",
    "pressure_viscosity_100": "pressure_viscosity",
}
"""Keys of [lubricant] whose values may have a tolerance, and what it is of."""


def without_tolerance(
    table: object, keys: Mapping[str, str], where: str, problems: list[str]
) -> tuple[Any, dict[str, Tolerance]]:
    """A table with plain values in place of values with tolerances, and these: the larger one of a kind.

    Parameters
    ----------
    table : object
        The table as it was parsed; what is none is returned as it is.
    keys : mapping of str to str
        Keys that may have tolerances, and what each is of, one of `TOLERATED`.
    where : str
        Name of the table in messages.
    problems : list of str
        List that takes what is wrong.

    Examples
    --------
    >>> without_tolerance({"viscosity": "80 mPa s +- 5 %"}, OF_OILS, "[lubricant]", [])[0]
    {'viscosity': '80 mPa s'}
    """
    if not isinstance(table, dict):
        return table, {}
    plain, found = dict(table), dict[str, Tolerance]()
    for key, name in keys.items():
        text = table.get(key)
        if not isinstance(text, str) or not all(parts := split(text)):
            continue
        plain[key] = parts[0]
        try:
            stated = read_tolerance(parts[1], name)
        except InputError as error:
            problems.append(f"{where} {key}: {error.problems[0]}")
            continue
        if name not in found or found[name].size < stated.size:
            found[name] = stated
    return plain, found


def read_tolerances(section: Any, names: Sequence[str] = tuple(TOLERATED)) -> dict[str, Tolerance]:
    """Read [tolerances]; whoever calls closes it.

    Parameters
    ----------
    section : ehdmaps.jobs.table.Table
        The table.
    names : sequence of str
        Keys that it may have.
    """
    found = {}
    for name in names:
        text = section.get(name)
        if name not in section:
            continue
        try:
            found[name] = read_tolerance(text, name)
        except InputError as error:
            section.note(name, error.problems[0])
    return found


def of_bearing(group: str, bearing: str) -> str:
    """Key of a statement on one bearing."""
    return f"{group}{OF}{bearing}"


def of_all(tolerances: Mapping[str, Tolerance], group: str) -> dict[str, Tolerance]:
    """Statements without those on single bearings of a group, which a nearer statement on all has outdone."""
    return {key: value for key, value in tolerances.items() if not key.startswith(group + OF)}


def _tolerable(row: Tolerated) -> str:
    """Words on what a tolerance of a row may be, for messages."""
    ways = [f"0 to {row.display.text(row.most)}"] if row.unit else []
    ways += [f"0 % to {100.0 * MOST:g} %"] if row.part else [] if row.unit else ["0 %"]
    return f"{', or '.join(ways)}, such as {row.examples}"
