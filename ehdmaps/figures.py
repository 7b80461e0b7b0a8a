"""Common parts of all figures of this distribution: colours, titles that fit, spelling of units; imports no library."""

from __future__ import annotations

import math
import re
import textwrap
from collections.abc import Sequence
from typing import Any

COLOURS = ("#1f5fa8", "#c8102e", "#2a7f3f", "#8a5a00", "#6a3d9a", "#0b8a8f", "#d95f02", "#444444")
"""Colours of lines, in this order: dark enough for thin lines on white paper."""

WARNING = COLOURS[1]
"""Colour of what is wrong or missing, and of limits."""

SHADE, SHADE_ALPHA = "#f2c14e", 0.35
"""Colour of ranges that are no longer valid, or not known."""

_MARGIN = 0.02
"""Right of a line, as a part of the width of its figure."""

_HANDLE = 8
"""Letters that the handle of a label takes, with the room beside it."""

_LETTERS = {"um": "µm", "urad": "µrad", "degC": "°C", "deg": "°", "s2": "s²", "mm2": "mm²"}
_UNIT = re.compile(r"(?<![A-Za-z0-9])(?:um|urad|degC|s2|mm2)(?![A-Za-z0-9])|(?<=[0-9]) deg(?![A-Za-z])")


def typeset(text: str) -> str:
    """A text with units as figures write them: with the letters that a terminal may lack.

    Examples
    --------
    >>> typeset("15 deg, 40 degC, 20 um; N/um, m/s2, album")
    '15°, 40 °C, 20 µm; N/µm, m/s², album'
    """
    return _UNIT.sub(lambda match: _LETTERS[match.group().strip()], text)


_FILLED, _LETTER = 0.92, 0.5
"""Part of the width of a figure that its heading may fill, and width of a letter by its size."""


def write_heading(figure: Any, text: str, size: float, weight: str = "normal") -> None:
    """Write the heading of a figure; lines that are longer than it is wide are broken.

    Parameters
    ----------
    figure : matplotlib.figure.Figure
        The figure.
    text : str
        The heading.
    size : float
        Size of its letters [pt].
    weight : str
        Their weight.
    """
    fits = max(int(_FILLED * 72.0 * figure.get_figwidth() / (_LETTER * size)), 1)
    lines: list[str] = []
    for line in text.split("\n"):
        # lines of about one length rather than a long one and a word
        count = max(math.ceil(len(line) / fits), 1)
        lines += textwrap.wrap(line, min(math.ceil(1.1 * len(line) / count), fits) if count > 1 else fits) or [""]
    figure.suptitle("\n".join(lines), fontsize=size, fontweight=weight, wrap=True)


def without_latex(figure: Any) -> None:
    """Have matplotlib set all texts of a figure, or of a part of it, itself, whatever a matplotlibrc asks for.

    LaTeX need not be there, and takes units and names of files for its commands.

    Parameters
    ----------
    figure : matplotlib.artist.Artist
        The figure, or a part.
    """
    for text in figure.findobj(lambda artist: hasattr(artist, "set_usetex")):
        text.set_usetex(False)


def keep_within(figure: Any, text: Any) -> None:
    """Make the letters of a line smaller where it would run out of its figure on the right.

    Parameters
    ----------
    figure : matplotlib.figure.Figure
        The figure.
    text : matplotlib.text.Text
        A line that begins within it.
    """
    without_latex(text)
    box, end = text.get_window_extent(), (1.0 - _MARGIN) * figure.bbox.width
    if box.x1 > end:
        text.set_fontsize(text.get_fontsize() * (end - box.x0) / box.width)


def legend_columns(labels: Sequence[str], letters: int, most: int) -> int:
    """Number of columns that a legend has room for.

    Parameters
    ----------
    labels : sequence of str
        Labels of the legend.
    letters : int
        Letters that have room beside each other.
    most : int
        Most columns that are wanted.

    Examples
    --------
    >>> legend_columns(["dry Hertz", "film formula"], 150, 4), legend_columns(["a" * 60], 150, 4)
    (4, 2)
    """
    longest = max(map(len, labels), default=0)
    return max(1, min(most, letters // (longest + _HANDLE)))


def spread(size: int, most: int) -> list[int]:
    """Return at most so many places of an axis, evenly, both ends among them.

    Parameters
    ----------
    size : int
        Number of values on the axis.
    most : int
        Largest number of places.
    """
    count = min(size, most)
    return sorted({0, *(round(i * ((size - 1) / (count - 1))) for i in range(1, count))})
