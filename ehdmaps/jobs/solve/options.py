"""Options of `ehdmaps solve` that are quantities within limits, read one after the other, with all problems at once."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVar

from ehdmaps.errors import InputError, short
from ehdmaps.units import Display, quantity

_Missing = TypeVar("_Missing", float, None)


def option_reader(
    problems: list[str], missing: _Missing
) -> Callable[[str, str | None, str, float, float, Display], float | _Missing]:
    """Reader of options, which notes what is wrong.

    Parameters
    ----------
    problems : list of str
        Gets a line for each option that is no quantity, or beyond its limits.
    missing : float or None
        What such an option gives.

    Returns
    -------
    callable
        (option, text, unit, lowest, highest, display) -> value in the unit, or `missing`; limits in the unit, too.
    """

    def read(option: str, text: str | None, unit: str, low: float, high: float, display: Display) -> float | _Missing:
        try:
            value = quantity(text, unit)
        except InputError as error:
            problems.append(f"{option}: {error.problems[0]}")
            return missing
        if low <= value <= high:
            return value
        problems.append(f"{option}: got {short(text)}; allowed: {display.text(low)} to {display.text(high)}")
        return missing

    return read
