"""Words on what is held open of a machine: a few lines at the head of a result, and the whole list of `mbs check`."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from mbs.scene.scene import Scene
from mbs.unknowns.unknown import Unknown

_FIRST, _SECOND = ("clearance",), ("temperature", "viscosity", "pressure_viscosity", "oil_layer", "load")
"""Groups of the first two lines of a head; the third has the others."""

NOT_IN_IT = "damping of seats and joints, loads, and masses and bodies of the scene"
"""Unknowns that no band holds, of any machine."""


def open_lines(unknowns: Sequence[Unknown], more: str = "; each is listed by mbs check") -> list[str]:
    """Head of a result: what is held open, by how much and why, in three lines at most; none without bearings.

    Parameters
    ----------
    unknowns : sequence of Unknown
        What is held open.
    more : str
        Words on where the rest is told.

    Examples
    --------
    >>> from mbs import read_scene
    >>> from mbs.unknowns.held_open import held_open
    >>> print(*open_lines(held_open(read_scene("nu308_rigid")))[:1])
      held open: clearance of bearing_left, bearing_right 0 um +-5 um (stated bare: fits and warmth of rings)
    """
    return [f"  {'  ' if k else 'held open: '}{line}" for k, line in enumerate(open_words(unknowns, more))]


def open_words(unknowns: Sequence[Unknown], more: str = "") -> list[str]:
    """The same without its heading.

    Parameters
    ----------
    unknowns : sequence of Unknown
        What is held open.
    more : str
        Words on where the rest is told.
    """
    unknowns = [one for one in unknowns if not one.beside]
    first, second = (_together(one for one in unknowns if one.group in groups) for groups in (_FIRST, _SECOND))
    lines = [", ".join(words) for words in (first, second) if words]
    rest = [one for one in unknowns if one.group not in (*_FIRST, *_SECOND)]
    if rest:
        short = dict.fromkeys(_short(one, rest) for one in rest)
        lines.append(f"{', '.join(short)}{more}")
    return lines


def open_list(scene: Scene, unknowns: Sequence[Unknown]) -> list[str]:
    """All that is held open, a line each, and what no band holds.

    Parameters
    ----------
    scene : Scene
        The scene.
    unknowns : sequence of Unknown
        What is held open of it.
    """
    if not scene.has_bearings:
        return []
    lines = [f"    {one.text}" for one in unknowns if not one.beside]
    head = ["  held open, until --know or [tolerances] state it better:"] if lines else ["  held open: nothing"]
    return [*head, *lines, f"  {missing_words(scene, unknowns)}"]


def missing_words(scene: Scene, unknowns: Sequence[Unknown]) -> str:
    """Words on what no band of a scene holds.

    Parameters
    ----------
    scene : Scene
        The scene.
    unknowns : sequence of Unknown
        What is held open of it.
    """
    held = [one.name for one in unknowns if not one.looks]
    groups = {one.group for one in unknowns}
    for words, group in (("oil supply", "supply"), ("axis of balls", "hypothesis")):
        if group in groups:
            held.append(f"{words} ({', '.join(one.name for one in unknowns if one.group == group)})")
    if "supply" not in groups and groups & {"temperature", "pressure_viscosity"} and "oil_layer" not in groups:
        held.append("oil supply")  # films that nobody looked at on other supplies
    return f"not in it: {', '.join([NOT_IN_IT, *held])}"


def _together(unknowns: Iterable[Unknown]) -> list[str]:
    """Unknowns of one kind, half-width and reason together."""
    kinds: dict[tuple[str, str, str], list[str]] = {}
    for one in unknowns:
        kind, _, bearing = one.name.partition(" of ")
        kinds.setdefault((kind, one.held, one.why), []).append(bearing)
    return [f"{_of(kind, bearings)} {held} ({why})" for (kind, held, why), bearings in kinds.items()]


def _short(unknown: Unknown, all_of_them: Sequence[Unknown]) -> str:
    """A group of unknowns of all bearings in few words."""
    kind, geometry = unknown.name.partition(" of ")[0], unknown.group == "geometry"
    same = [one.name.partition(" of ") for one in all_of_them if one.group == unknown.group]
    bearings = list(dict.fromkeys(bearing for name, _, bearing in same if geometry or name == kind))
    return f"{_of('inner geometry', bearings)} (estimated)" if geometry else f"{_of(kind, bearings)} {unknown.held}"


def _of(kind: str, bearings: Sequence[str]) -> str:
    """A kind of unknowns, and the bearings that it is of."""
    named = [name for name in bearings if name]
    return f"{kind} of {', '.join(named)}" if named else kind
