"""Options of the command line that are read without a scene."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from ehdmaps.errors import InputError
from ehdmaps.physics.oil_supply import OilSupply
from ehdmaps.units import Display, quantity

if TYPE_CHECKING:
    from mbs.instruments.varied import Value, VariedKey

NO_MAP = "--structure: got {!r:.60} without a map; allowed: with --map MAP.nc, made by `ehdmaps generate`"
"""What is said where a structural law is given for no map."""


def read_supplies(given: Sequence[str], problems: list[str]) -> list[OilSupply]:
    """Read what was given for --supply; what is wrong about it is noted, and left out.

    Parameters
    ----------
    given : sequence of str
        What was given.
    problems : list of str
        Appended to.
    """
    if not given:
        return []
    from ehdmaps.jobs.supply import supply_from_text

    found: list[OilSupply] = []
    for text in given:
        try:
            supply = supply_from_text(text)
        except InputError as error:
            problems += [f"--supply: {problem}" for problem in error.problems]
            continue
        if supply in found:
            problems.append(f"--supply: got {text!r:.60} twice; allowed: each once")
        else:
            found.append(supply)
    return found


def read_clearance(text: str, problems: list[str]) -> float | None:
    """Read what was given for --clearance [m]; None where a problem was noted."""
    value = read_varied("clearance", text, problems)
    return None if value is None else float(value)


def varied_key(key: str) -> VariedKey:
    """The row of a key that is varied, with all that changes a scene."""
    from mbs.instruments.varied import VARIED

    return VARIED[key]


def read_varied(key: str, text: str, problems: list[str]) -> Value | None:
    """Read what was given for the option of a key that is varied; None where a problem was noted.

    Parameters
    ----------
    key : str
        A key of `mbs.instruments.varied.VARIED`.
    text : str
        What was given.
    problems : list of str
        Appended to.
    """
    try:
        return varied_key(key).read(text)
    except InputError as error:
        problems.append(f"--{key}: {error.problems[0]}")
        return None


def read_option(
    option: str, text: str | None, unit: str, limits: tuple[float, float], display: Display, problems: list[str]
) -> float | None:
    """Read a quantity of the command line within limits; None if absent or wrong, with the problem noted.

    Parameters
    ----------
    option : str
        Name of the option, such as "--highest".
    text : str or None
        What was given; None if it was left out.
    unit : str
        SI unit of the value.
    limits : (float, float)
        Smallest and largest value that is allowed, in SI.
    display : Display
        How messages show them.
    problems : list of str
        Appended to.
    """
    if text is None:
        return None
    try:
        value = quantity(text, unit)
    except InputError as error:
        problems.append(f"{option}: {error.problems[0]}")
        return None
    if not limits[0] <= value <= limits[1]:
        problems.append(f"{option}: got {text!r:.60}; allowed: {display.text(limits[0])} to {display.text(limits[1])}")
        return None
    return value
