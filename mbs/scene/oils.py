"""The oils of a machine: each bearing has that of its map, and what speaks against it is told by every analysis."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping

from ehdmaps.physics.lubricant import Lubricant

_TEMPERATURE = 313.15
"""Temperature at which oils are told apart, that of their viscosity grades [K]."""


def by_oil(oils: Mapping[str, Lubricant]) -> dict[Lubricant, list[str]]:
    """The bearings that run on each oil.

    Parameters
    ----------
    oils : mapping of str to Lubricant
        The oil of each bearing, by its name.
    """
    found: dict[Lubricant, list[str]] = {}
    for name, oil in oils.items():
        found.setdefault(oil, []).append(name)
    return found


def oil_warnings(oils: Mapping[str, Lubricant], stated: Lubricant | None) -> list[str]:
    """Lines on bearings that run on different oils, or on another one than the scene states.

    Parameters
    ----------
    oils : mapping of str to Lubricant
        The oil that counts in each bearing, by its name: that of its map. Empty for laws without oil.
    stated : Lubricant or None
        [lubricant] of the scene.
    """
    found = by_oil(oils)
    lines = []
    if len(found) > 1:
        words = "; ".join(f"{_words(oil)}: {', '.join(names)}" for oil, names in found.items())
        lines.append(
            f"warning: the maps of the bearings are made for different oils ({words}), which differ in "
            f"{_differing(*found)}; each bearing has the oil of its map; make maps of one oil if the machine has one"
        )
    others = {oil: names for oil, names in found.items() if stated is not None and oil != stated}
    lines += [
        f"warning: [lubricant] of the scene, {_words(stated)}, is not the oil of the map of {', '.join(names)}, "
        f"{_words(oil)}: they differ in {_differing(stated, oil)}; the oil of the map counts; correct [lubricant], or "
        "make a map of that oil"
        for oil, names in others.items()
        if stated is not None
    ]
    return lines


def _words(oil: Lubricant) -> str:
    """An oil, for people: labels and names of two may be the same."""
    return f"{oil.title} ({1e3 * oil.at(_TEMPERATURE).viscosity:.4g} mPa s at {_TEMPERATURE - 273.15:g} degC)"


def _differing(first: Lubricant, *others: Lubricant) -> str:
    """In which of their data oils differ."""
    return ", ".join(
        field.name
        for field in dataclasses.fields(first)
        if field.compare and any(getattr(first, field.name) != getattr(other, field.name) for other in others)
    )
