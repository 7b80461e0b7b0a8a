"""Values of the options of one bearing: loads and speeds with ranges, directions, choices; every problem is noted."""

from __future__ import annotations

import argparse
import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from ehdmaps.choices import texts_of
from ehdmaps.errors import InputError
from ehdmaps.units import Display, quantity, short
from mbs.output.point_words import WIDE_RANGE
from mbs.scene.choices import OPTIONS

MOST_POINTS = 500

_ROUND_OFF = 1e-12
"""Part of a limit by which a value of just its size may miss it, as 1e5 rpm do in rad/s."""

LOADS, SPEEDS = (1e-3, 1e7), (0.0, 1e5 * math.pi / 30.0)
"""Smallest and largest load [N] and speed [rad/s]."""

SLOWEST = 1e-6
"""Smallest speed that is not zero [rad/s]: a turn in two months. Groups of films are no numbers below."""


def read_choices(arguments: argparse.Namespace, problems: list[str]) -> dict[str, Any]:
    """Values that were chosen, once each, by the names of the choices."""
    chosen: dict[str, Any] = {}
    for choice in OPTIONS:
        texts = texts_of(arguments, choice)
        if len(texts) > 1:
            problems.append(
                f"--{choice.name}: got {len(texts)} of them; allowed: one; run the command again for another"
            )
        for value in choice.values(texts[:1], problems):
            chosen[choice.name] = value
    return chosen


def read_direction(given: Sequence[str] | None, problems: list[str]) -> tuple[float, float]:
    """Unit vector of the load: an angle from y towards z, or two components."""
    allowed = 'an angle from y towards z, such as "30 deg", or two numbers, the parts along y and z, not both zero'
    texts = list(given or ["0 deg"])
    try:
        if len(texts) == 1:
            angle = math.radians(float(texts[0])) if _is_number(texts[0]) else quantity(texts[0], "rad")
            parts = (math.cos(angle), math.sin(angle))
        else:
            y, z = (float(text) for text in texts)
            size = math.hypot(y, z)
            parts = (y / size, z / size)
    except (ValueError, ZeroDivisionError, InputError):
        parts = (math.nan, math.nan)
    if not np.all(np.isfinite(parts)):
        problems.append(f"--direction: got {' '.join(texts)!r:.80}; allowed: {allowed}")
        return 1.0, 0.0
    # No part of a load along an axis by round-off.
    clean = [0.0 if abs(part) < 1e-15 else part for part in parts]
    return clean[0], clean[1]


def _is_number(text: str) -> bool:
    """Tell whether a text is a bare number."""
    try:
        float(text)
    except ValueError:
        return False
    return True


def read_values(
    option: str,
    given: Sequence[Sequence[str]],
    unit: str,
    limits: tuple[float, float],
    display: Display,
    problems: list[str],
) -> tuple[float, ...]:
    """Rising values of an option: single ones, and ranges FROM TO POINTS, evenly spaced, wide ones in the logarithm.

    Parameters
    ----------
    option : str
        Name of the option; begins the messages.
    given : sequence of sequences of str
        What was given for it, once for each time that it was given.
    unit : str
        Unit of the values.
    limits : (float, float)
        Smallest and largest allowed value [unit].
    display : Display
        How messages show values.
    problems : list of str
        Takes what is wrong.
    """
    found: list[float] = []
    for texts in given:
        if len(texts) not in (1, 3):
            problems.append(
                f"{option}: got {len(texts)} values ({' '.join(texts)!r:.60}); allowed: one, or FROM TO POINTS; give "
                "the option more than once for a list"
            )
            continue
        before = len(problems)
        ends = [_quantity(option, text, unit, limits, display, problems) for text in texts[:2]]
        if len(texts) == 1:
            found += ends
            continue
        points = read_whole(f"{option}, POINTS", texts[2], 2, MOST_POINTS, problems)
        if len(problems) == before and not ends[0] < ends[1]:
            problems.append(f"{option}: got {texts[0]!r} to {texts[1]!r}; allowed: rising")
        elif len(problems) == before:
            wide = 0.0 < WIDE_RANGE * ends[0] < ends[1]
            space = np.geomspace if wide else np.linspace
            # Numbers as they were typed, and not one bit beside.
            found += [float(f"{value:.12g}") for value in space(ends[0], ends[1], points)]
    return tuple(sorted(set(found)))


def read_one(
    option: str,
    text: str | None,
    unit: str,
    limits: tuple[float, float],
    display: Display,
    default: float,
    problems: list[str],
) -> float:
    """One value, or its default where none was given, or where a problem was noted.

    Parameters
    ----------
    option : str
        Name of the option; begins the messages.
    text : str or None
        Text that was given.
    unit : str
        Unit of the value.
    limits : (float, float)
        Smallest and largest allowed value [unit].
    display : Display
        Form in which messages show values.
    default : float
        Value where none was given [unit].
    problems : list of str
        List that takes what is wrong.
    """
    if text is None:
        return default
    value = _quantity(option, text, unit, limits, display, problems)
    return default if math.isnan(value) else value


def _quantity(
    option: str, text: str, unit: str, limits: tuple[float, float], display: Display, problems: list[str]
) -> float:
    """One quantity within its limits; NaN where a problem was noted."""
    try:
        value = quantity(text, unit)
    except InputError as error:
        problems.append(f"{option}: {error.problems[0]}")
        return math.nan
    reach = _ROUND_OFF * max(abs(limits[0]), abs(limits[1]))
    if not limits[0] - reach <= value <= limits[1] + reach:
        problems.append(
            f"{option}: got {short(text)}; allowed: {display.text(limits[0])} to {display.text(limits[1])}; check its "
            "unit"
        )
        return math.nan
    if unit == "rad/s" and 0.0 < abs(value) < SLOWEST:
        problems.append(f"{option}: got {short(text)}; allowed: zero, or from {display.text(SLOWEST)} up")
        return math.nan
    return min(max(value, limits[0]), limits[1])


def read_whole(option: str, text: str, low: int, high: int, problems: list[str]) -> int:
    """A whole number; the lowest one where a problem was noted.

    Parameters
    ----------
    option, text : str
        Name of the option, and what was given.
    low, high : int
        Smallest and largest allowed number.
    problems : list of str
        List that takes what is wrong.
    """
    if text.isascii() and text.isdigit() and len(text) < 10 and low <= int(text) <= high:
        return int(text)
    problems.append(f"{option}: got {short(text)}; allowed: a whole number from {low} to {high}")
    return low
