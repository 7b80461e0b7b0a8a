"""Statements on how well a number of a scene is known: the nearest one wins.

A command (`--know`) is nearer than a bearing ("25 um +- 5 um"), and a bearing nearer than the table [tolerances].
A scene keeps them in one mapping, `Scene.tolerances`: "clearance of drive" of one bearing, "clearance" of all.
"""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from ehdmaps.errors import InputError, Problems, closest, problems_after, short
from ehdmaps.units import (
    OF,
    OF_OILS,
    TOLERATED,
    Tolerance,
    of_all,
    of_bearing,
    quantity,
    read_tolerance,
    split,
    without_tolerance,
)

if TYPE_CHECKING:
    from mbs.scene.scene import Scene

_VALUES = {"clearance": "m", "temperature": "K"}
"""What a command may state with a value, in its unit; the others are stated by their tolerance alone."""

EXACT = Tolerance(0.0, True, "+-0 %")


def tolerance_of(scene: Scene, group: str, bearing: str = "") -> Tolerance | None:
    """The nearest tolerance that is stated; None where none is.

    Parameters
    ----------
    scene : Scene
        The scene.
    group : str
        A key of [tolerances].
    bearing : str
        Name of a bearing; empty for what all share.
    """
    found = scene.tolerances.get(of_bearing(group, bearing)) if bearing else None
    return found or scene.tolerances.get(group)


@dataclass(frozen=True)
class Statement:
    """Statement of a command, such as "clearance of drive = 20 um +- 5 um".

    Attributes
    ----------
    group : str
        A key of [tolerances].
    bearing : str
        Name of a bearing; empty for all.
    value : float or None
        Value in SI; None where the scene keeps its own.
    tolerance : Tolerance or None
        Half-width; None for a value that is stated bare.
    text : str
        Statement as it was typed.
    """

    group: str
    bearing: str
    value: float | None
    tolerance: Tolerance | None
    text: str


def read_statements(text: str) -> tuple[Statement, ...]:
    """Read statements of a command, with semicolons between several.

    Parameters
    ----------
    text : str
        Such as "clearance = 20 um +- 5 um; temperature = +- 2 K".

    Raises
    ------
    InputError
        With every problem.

    Examples
    --------
    >>> [found] = read_statements("clearance of drive = 20 um +- 5 um")
    >>> found.group, found.bearing, found.value, found.tolerance.half_width(20e-6)
    ('clearance', 'drive', 2e-05, 5e-06)
    """
    problems, found = Problems(), []
    for part in filter(None, map(str.strip, text.split(";"))):
        with problems:
            found.append(_statement(part))
    if problems or not found:
        raise InputError(problems or [f"got {short(text)}; allowed: such as 'clearance = 20 um +- 5 um'"])
    return tuple(found)


def _statement(text: str) -> Statement:
    """Read one statement."""
    key, equals, stated = (part.strip() for part in text.partition("="))
    group, _, bearing = (part.strip() for part in key.partition(OF))
    names = tuple(TOLERATED)
    if group not in names:
        raise InputError(f"got {short(key)}{closest(group, names)}; allowed: {', '.join(names)}")
    example = TOLERATED[group].examples
    if not equals or not stated:
        raise InputError(f"got {short(text)} without a number; allowed: {group} = +- {example}")
    value, tolerance = split(stated)
    if value and group not in _VALUES:
        raise InputError(
            f"got {short(text)}; allowed: a tolerance alone, {group} = +- {example}; values are stated for "
            f"{' and '.join(_VALUES)}"
        )
    with problems_after(f"{group}: "):
        size = quantity(value, _VALUES[group]) if value else None
        width = read_tolerance(tolerance, group) if tolerance else None
    return Statement(group, bearing, size, width, text)


def known(scene: Scene, statements: tuple[Statement, ...]) -> Scene:
    """The scene with statements of a command, but for a value of the temperature.

    Parameters
    ----------
    scene : Scene
        The scene.
    statements : tuple of Statement
        Statements in their order.

    Raises
    ------
    InputError
        For a bearing that there is not, and a value that a bearing cannot have.
    """
    from mbs.scene.changes import with_clearance_of

    names = tuple(entry.name for entry in scene.of_all_kinds)
    for one in statements:
        if one.bearing and one.bearing not in names:
            raise InputError(
                f"got {short(one.text)}, but no bearing {one.bearing!r}{closest(one.bearing, names)}; allowed: "
                f"{', '.join(names) or 'none, without bearings'}"
            )
        if one.group == "clearance" and one.value is not None:
            for name in (one.bearing,) if one.bearing else names:
                scene = with_clearance_of(scene, name, one.value)
        tolerances = dict(scene.tolerances) if one.bearing else of_all(scene.tolerances, one.group)
        key = of_bearing(one.group, one.bearing) if one.bearing else one.group
        if one.tolerance is not None:
            tolerances[key] = one.tolerance
        else:
            tolerances.pop(key, None)
        scene = dataclasses.replace(scene, tolerances=tolerances)
    return scene


def know(scene: Scene, text: str) -> Scene:
    """The scene with statements on how well its numbers are known, as `--know` of a command makes them.

    Parameters
    ----------
    scene : Scene
        The scene.
    text : str
        Statements, such as "clearance of drive = 20 um +- 5 um; temperature = +- 2 K".

    Raises
    ------
    InputError
        For what is no statement, or not of this scene.
    """
    from mbs.scene.changes import with_temperature

    statements = read_statements(text)
    for one in statements:
        if one.group == "temperature" and one.value is not None:
            scene = with_temperature(scene, one.value)
    return known(scene, statements)


def taken_out(values: dict[str, Any], problems: list[str]) -> tuple[dict[str, Any], dict[str, Tolerance]]:
    """Tables of a scene file with plain values in place of values with tolerances, and these tolerances.

    Parameters
    ----------
    values : dict
        The tables as they were parsed.
    problems : list of str
        What is wrong is appended.

    Notes
    -----
    Temperature of [operation], viscosities of [lubricant] and clearances of [[bearings]] may have tolerances. A profile
    that is stated is exact.
    """
    found: dict[str, Tolerance] = {}
    changed = dict(values)
    for name, keys in (("operation", {"temperature": "temperature"}), ("lubricant", OF_OILS)):
        if name in values:
            changed[name], stated = without_tolerance(values[name], keys, f"[{name}]", problems)
            found.update(stated)
    if isinstance(values.get("bearings"), list):
        changed["bearings"] = [_plain_bearing(entry, found, problems) for entry in values["bearings"]]
    return changed, found


def _plain_bearing(entry: object, found: dict[str, Tolerance], problems: list[str]) -> object:
    """A table [[bearings]] with plain values."""
    if not isinstance(entry, dict):
        return entry
    bearing, where = str(entry.get("name", "")), f"[[bearings]] {entry.get('name', '')!s:.60}"
    if "profile" in entry:
        found[of_bearing("profile", bearing)] = EXACT
    keys = {"diametral_clearance": "clearance"}
    outer, stated = without_tolerance(entry, keys, where, problems)
    if "geometry" in outer:
        outer["geometry"], inner = without_tolerance(outer["geometry"], keys, f"{where} geometry", problems)
        stated.update(inner)
    found.update({of_bearing(name, bearing): one for name, one in stated.items()})
    return outer
