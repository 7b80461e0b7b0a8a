"""What all figures of this distribution share: colours, and how units are written; without a library of figures."""

from __future__ import annotations

import re

COLOURS = ("#1f5fa8", "#c8102e", "#2a7f3f", "#8a5a00", "#6a3d9a", "#0b8a8f", "#d95f02", "#444444")
"""Colours of lines, in this order: dark enough for thin lines on white paper."""

WARNING = COLOURS[1]
"""Colour of what is wrong or missing, and of limits."""

SHADE, SHADE_ALPHA = "#f2c14e", 0.35
"""Colour of ranges that are no longer valid, or not known."""

_LETTERS = {"um": "µm", "degC": "°C", "deg": "°", "s2": "s²"}
_UNIT = re.compile(r"(?<![A-Za-z0-9])(?:um|degC|s2)(?![A-Za-z0-9])|(?<=[0-9]) deg(?![A-Za-z])")


def typeset(text: str) -> str:
    """A text with units as figures write them: with the letters that a terminal may lack.

    Examples
    --------
    >>> typeset("15 deg, 40 degC, 20 um; N/um, m/s2, album")
    '15°, 40 °C, 20 µm; N/µm, m/s², album'
    """
    return _UNIT.sub(lambda found: _LETTERS[found.group().strip()], text)
