"""What a target of `ehdmaps export` is, which ones are registered, and what every export says of itself.

A target is one module that holds a `Target`, and one line of the entry points `ehdmaps.exports` in `pyproject.toml`.
Packages beside this one register theirs in the same way, so that a target may use what stands above the maps, such as
the bearing element.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable
from dataclasses import dataclass
from importlib.metadata import EntryPoint, entry_points
from pathlib import Path

from ehdmaps.errors import InputError
from ehdmaps.maps import schema
from ehdmaps.maps.emap import EHDMap
from ehdmaps.outputs import MARK
from ehdmaps.program import plain
from ehdmaps.units import LOAD, SPEED, TEMPERATURE, Display
from ehdmaps.version import version

GROUP = "ehdmaps.exports"
"""Group of entry points under which targets are registered."""


@dataclass(frozen=True)
class Target:
    """A format that maps can be written in.

    Attributes
    ----------
    summary : str
        What it is, in half a line.
    writes : str
        File or files that it makes, such as "a folder of C sources".
    read_back_by : str
        Program by which the tests read the export back; empty where none does, so that only the format is checked.
    add_arguments : callable
        Adds the target's own options to the parser of `ehdmaps export MAP.nc --to NAME`, which has the map, `--to`,
        `--list`, `-o`, `--structure` and `--roughness` itself.
    write : callable
        Takes the map, its path, that of `-o` (None where it was not given) and all arguments. It writes, and returns
        the line that is printed. It raises `InputError` or `MapError` before it writes anything.
    """

    summary: str
    writes: str
    read_back_by: str
    add_arguments: Callable[[argparse.ArgumentParser], None]
    write: Callable[[EHDMap, Path, Path | None, argparse.Namespace], str]


def registered() -> dict[str, EntryPoint]:
    """Return the entry points of all targets by their names, in order of the alphabet."""
    return {point.name: point for point in sorted(entry_points(group=GROUP), key=lambda point: point.name)}


def find(name: str) -> Target:
    """Load a target.

    Parameters
    ----------
    name : str
        Name of the target.

    Raises
    ------
    InputError
        If no target has this name, or its module cannot be loaded.
    """
    known = registered()
    if name not in known:
        raise InputError(
            f"--to: got {name!r:.60}; allowed: {', '.join(known) or 'nothing, since no target is registered'}"
            + ("" if known else "; install ehdmaps again")
        )
    try:
        target = known[name].load()
    except (ImportError, AttributeError) as error:
        raise InputError(
            f"--to {name}: {known[name].value} cannot be loaded ({error}); install ehdmaps again"
        ) from error
    if not isinstance(target, Target):
        raise InputError(f"--to {name}: {known[name].value} is no target; allowed: a Target of ehdmaps.exports.target")
    return target


def listing() -> str:
    """Return the table of all targets: name, files, who reads them back, summary."""
    rows = [("target", "files", "read back by", "what it is")]
    for name in registered():
        try:
            target = find(name)
        except InputError as error:
            rows.append((name, "", "", error.problems[0]))
            continue
        rows.append((name, target.writes, target.read_back_by or "nothing: format only", target.summary))
    widths = [max(len(row[i]) for row in rows) for i in range(3)]
    return "\n".join(
        "  ".join([*(cell.ljust(w) for cell, w in zip(row, widths, strict=False)), row[3]]) for row in rows
    )


BEARING_AXES = (
    "axes: x along the axis of the bearing (axial), y and z radial; rotations tx, ty, tz about them, right-handed",
    "signs: forces and moments act on the inner ring, whose pose is relative to the outer ring; "
    "K = -d f / d pose, C = -d f / d velocity",
    "units: SI (m, rad, N, N m, s), temperatures in kelvin",
)
"""Axes, signs and units of bearings, for people."""

_AXES = (("load", LOAD), ("entrainment_speed", SPEED), ("temperature", TEMPERATURE))


def origin(emap: EHDMap, name: str, beyond: str = "refused") -> tuple[str, ...]:
    """Return the lines that tell where an export comes from; the first carries the mark of our files.

    Parameters
    ----------
    emap : EHDMap
        The map.
    name : str
        Name of its file.
    beyond : str
        What happens to points outside of the map.
    """
    attributes = emap.dataset.attrs
    stated = [
        ("map", name),
        ("title", attributes.get("title", "EHD map")),
        ("content sha256", attributes.get(schema.CHECKSUM, "none, the map is older than this checksum")),
        ("structural law", attributes.get("structural_law", "")),
        ("surfaces", emap.surface.label),
        ("solver", attributes.get("solver", "")),
    ]
    return (
        f"{MARK} {version()}",
        *(f"{key}: {plain(value)}" for key, value in stated if value),
        *(f"{label}: {_span(emap, axis, display)}; {beyond} beyond" for axis, label, display in _ranges()),
    )


def _ranges() -> tuple[tuple[str, str, Display], ...]:
    """Return axes of the map with the words for them."""
    return tuple((axis, f"range of {axis.replace('_', ' ')}", display) for axis, display in _AXES)


def _span(emap: EHDMap, axis: str, display: Display) -> str:
    """Return a range of the map in words."""
    values = emap.dataset[axis].values
    low, high = display.text(float(values[0])), display.text(float(values[-1]))
    return low if values.size == 1 else f"{low} to {high}"
