"""Options of `ehdmaps solve`, read one after the other, with all problems at once."""

from __future__ import annotations

import argparse
import math
from collections.abc import Callable, Sequence
from typing import Protocol

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import InputError, Problems, short
from ehdmaps.physics.contact import OIL_TEMPERATURES
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.spectrum import HIGHEST_FREQUENCY, LOWEST_FREQUENCY, MOST_FREQUENCIES
from ehdmaps.units import RPM, SPEED, TEMPERATURE, Display, quantity, quantity_between, whole_number

HERTZ = Display("Hz")

Limits = tuple[float, float]
"""Lowest and highest value that is allowed."""


class Turning(Protocol):
    """A bearing whose rings turn."""

    def entrainment_speed(self, inner_speed: float, outer_speed: float = 0.0) -> float:
        """Mean speed of the surfaces [m/s] by the speed of the inner ring [rad/s]."""
        ...


def of_unit(text: str, unit: str) -> bool:
    """Tell whether a quantity was given in a unit of this kind.

    Parameters
    ----------
    text : str
        The quantity.
    unit : str
        The unit.
    """
    try:
        quantity(text, unit)
    except InputError:
        return False
    return True


class Options:
    """Reader of options, which notes what is wrong; such an option gives NaN, or None in place of several numbers.

    Parameters
    ----------
    problems : list of str
        Gets a line for each option that cannot be read, or is beyond its limits.
    """

    def __init__(self, problems: Problems) -> None:
        self._problems = problems

    def refuse(self, arguments: argparse.Namespace, names: Sequence[str], words: str) -> None:
        """Note each of some options that is given.

        Parameters
        ----------
        arguments : argparse.Namespace
            What was given.
        names : sequence of str
            The options, as attributes.
        words : str
            What is wrong, and allowed, with ``{}`` in place of the option.
        """
        given = (name for name in names if getattr(arguments, name, None) not in (None, False))
        self._problems += [words.format(f"--{name.replace('_', '-')}") for name in given]

    def quantity(self, option: str, text: str | None, unit: str, limits: Limits, display: Display) -> float:
        """A quantity within limits, all in the unit.

        Parameters
        ----------
        option, text, unit : str
            The option, what was given, and the unit.
        limits : tuple of float
            Lowest and highest value.
        display : Display
            How limits are shown.
        """
        with self._problems.after(f"{option}: "):
            return quantity_between(text, unit, *limits, display)
        return math.nan

    def number(self, option: str, text: str, low: float, high: float) -> float:
        """A bare number within limits.

        Parameters
        ----------
        option, text : str
            The option, and what was given.
        low, high : float
            Lowest and highest value.
        """
        try:
            value = float(text)
        except ValueError:
            value = math.nan
        if not low <= value <= high:
            self._problems.append(f"{option}: got {short(text)}; allowed: a bare number from {low:g} to {high:g}")
            return math.nan
        return value

    def speed(self, text: str, bearing: Turning | None, speeds: Limits, rings: Limits) -> float:
        """Entrainment speed [m/s] by --speed, which may be that of the inner ring of a bearing.

        Parameters
        ----------
        text : str
            What was given.
        bearing : Turning, optional
            The bearing, where there is one that can be read.
        speeds, rings : tuple of float
            Lowest and highest entrainment speed [m/s], and speed of the inner ring [rad/s].
        """
        if not of_unit(text, "rad/s"):
            return self.quantity("--speed", text, "m/s", speeds, SPEED)
        ring = self.quantity("--speed", text, "rad/s", rings, RPM)
        return math.nan if bearing is None else bearing.entrainment_speed(ring)

    def temperature(self, text: str, oil: Lubricant | None) -> float:
        """Temperature [K] by --temperature, at which the oil has a state.

        Parameters
        ----------
        text : str
            What was given.
        oil : Lubricant, optional
            The oil, where there is one that can be read.
        """
        value = self.quantity("--temperature", text, "K", OIL_TEMPERATURES, TEMPERATURE)
        if oil is not None and math.isfinite(value):
            with self._problems.after("--temperature: "):
                oil.at(value)
        return value

    def spaced(self, option: str, given: Sequence[str], read: Callable[[str], float], most: int) -> FloatArray | None:
        """Numbers from the first to the second, even in the logarithm, by FROM TO POINTS.

        Parameters
        ----------
        option : str
            The option.
        given : sequence of str
            Texts of FROM, TO and POINTS.
        read : callable
            Reads an end, and notes what is wrong about it.
        most : int
            Largest number of points.
        """
        first, last, count = given
        before = len(self._problems)
        low, high = read(first), read(last)
        if low >= high:
            self._problems.append(f"{option}: got {first:.40} to {last:.40}; allowed: TO above FROM")
        with self._problems.after(f"{option}, POINTS: "):
            points = whole_number(count, 2, most)
        if len(self._problems) > before or not (math.isfinite(low) and math.isfinite(high)):
            return None
        return np.geomspace(low, high, points)

    def frequency(self, text: str) -> float:
        """One frequency of --frequency [Hz].

        Parameters
        ----------
        text : str
            What was given.
        """
        return self.quantity("--frequency", text, "Hz", (LOWEST_FREQUENCY, HIGHEST_FREQUENCY), HERTZ)

    def frequencies(self, given: Sequence[str]) -> FloatArray | None:
        """Frequencies of --frequency [Hz], one or FROM TO POINTS.

        Parameters
        ----------
        given : sequence of str
            Values of the option.
        """
        if len(given) == 1:
            return np.array([self.frequency(given[0])])
        if len(given) == 3:
            return self.spaced("--frequency", given, self.frequency, MOST_FREQUENCIES)
        self._problems.append(f"--frequency: got {len(given)} values; allowed: one, or FROM TO POINTS")
        return None
