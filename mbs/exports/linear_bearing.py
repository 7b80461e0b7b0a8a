"""A bearing that is linear around a load, and the formats of linear programs that take it."""

from __future__ import annotations

import argparse
from collections.abc import Callable
from dataclasses import dataclass
from importlib import import_module

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import Problems
from ehdmaps.outputs import Kind
from ehdmaps.units import whole_number


@dataclass(frozen=True, eq=False)
class LinearBearing:
    """Stiffness and damping of a bearing over speed and frequency.

    Attributes
    ----------
    name : str
        Name of the bearing.
    speeds : array, shape (n,)
        Speeds of the inner ring [rad/s].
    frequencies : array, shape (m,)
        Frequencies of the oscillation [Hz]; zero is slow motion.
    stiffness, damping : array, shape (n, m, 6, 6)
        K and C of the inner ring against the outer one: x (axial), y, z [m], rotations about them [rad].
    """

    name: str
    speeds: FloatArray
    frequencies: FloatArray
    stiffness: FloatArray
    damping: FloatArray

    @property
    def axial(self) -> bool:
        """True for a bearing that is stiff along its axis."""
        return bool(np.any(self.stiffness[..., 0, 0]))

    def left_out(self, *, axial_terms: bool) -> tuple[str, ...]:
        """Lines on what nodes without tilts leave out of a bearing that is stiff along its axis, and what mends most.

        A radial force that acts at x = s has K between y and the tilt about z of s Kyy, and between z and the tilt
        about y of -s Kzz.

        Parameters
        ----------
        axial_terms : bool
            Whether terms between axial and radial motion are left out, too.
        """
        if not self.axial:
            return ()
        k = self.stiffness[:, 0]
        places = 1e3 * np.array([k[:, 1, 5] / k[:, 1, 1], -k[:, 2, 4] / k[:, 2, 2]])
        low, high = (f"{place:.3g}" for place in (places.min(), places.max()))
        between = low if low == high else f"{low} to {high}"
        tilts = f"tilts: radial forces act at x = {between} mm of the bearing; a node there feels most of what tilts do"
        coupled = float(np.max(np.abs(k[:, 0, 1:3])) / np.max(np.abs(k[:, 1:3, 1:3])))
        axial = f"left out: terms between axial and radial motion, up to {coupled:.1e} of K"
        return (tilts, axial) if axial_terms else (tilts,)

    def dynamic_error(self) -> FloatArray:
        """Estimated |dZ/Z| along the load at each frequency, shape (n, m); NaN where it is not known."""
        return np.full((self.speeds.size, self.frequencies.size), np.nan)


Text = Callable[[LinearBearing, tuple[str, ...], argparse.Namespace], str]
"""Bearing, lines of the header and options of the format to the text of its file."""


def no_arguments(parser: argparse.ArgumentParser) -> None:
    """Add nothing: the format has no options of its own."""


@dataclass(frozen=True)
class Format:
    """Format of one text file.

    Attributes
    ----------
    kind : Kind
        Kind of the file; its first ending is that of the default name.
    summary : str
        What it is, in half a line.
    read_back_by : str
        Program that reads it back in the tests, or empty.
    text : callable
        Writes the file, see `Text`.
    add_arguments : callable
        Adds the options that the format has.
    one_speed : bool
        Whether a file has one speed only.
    """

    kind: Kind
    summary: str
    read_back_by: str
    text: Text
    add_arguments: Callable[[argparse.ArgumentParser], None] = no_arguments
    one_speed: bool = False

    def plain(self, bearing: LinearBearing, header: tuple[str, ...]) -> str:
        """Text of the file with the defaults of all options.

        Parameters
        ----------
        bearing : LinearBearing
            The bearing.
        header : tuple of str
            Lines that say where it comes from.

        Raises
        ------
        InputError
            For several speeds or frequencies where the format has one.
        """
        parser = argparse.ArgumentParser()
        self.add_arguments(parser)
        return self.text(bearing, header, parser.parse_args([]))


ENDINGS = {".toml": "ross", ".bdf": "nastran", ".inp": "calculix", ".txt": "ansys"}
"""Modules of the formats by the endings of their files."""


def format_of(ending: str) -> Format:
    """Format of the files with an ending of `ENDINGS`."""
    found: Format = import_module(f"mbs.exports.{ENDINGS[ending]}").FORMAT
    return found


def refuse_speeds(bearing: LinearBearing, problems: list[str]) -> None:
    """Note a problem where a format of one speed is given several.

    Parameters
    ----------
    bearing : LinearBearing
        The bearing.
    problems : list of str
        Takes what is wrong.
    """
    if bearing.speeds.size > 1:
        problems.append(f"--speed: got {bearing.speeds.size} values; allowed: one; export a file for each speed")


def whole(option: str, text: str, problems: Problems) -> int:
    """Read the number of a node or element.

    Parameters
    ----------
    option : str
        Name of the option.
    text : str
        What was given.
    problems : Problems
        Takes what is wrong.
    """
    with problems.after(f"{option}: "):
        return whole_number(text, 1, 99_999_999)
    return 1
