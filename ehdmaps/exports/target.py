"""Targets of `ehdmaps export`, which of them are registered, what every export says of itself; exports as folders.

A target is one module that holds a `Target`, and one line of the entry points `ehdmaps.exports` in `pyproject.toml`.
Packages beside this one register theirs in the same way, so that a target may use what stands above the maps, such as
the bearing element.
"""

from __future__ import annotations

import argparse
import os
import shutil
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from importlib.metadata import EntryPoint, entry_points
from pathlib import Path
from typing import Any

from ehdmaps.errors import InputError, Problems
from ehdmaps.maps import schema
from ehdmaps.maps.emap import EHDMap
from ehdmaps.maps.law import LawKind
from ehdmaps.outputs import MARK, has_mark
from ehdmaps.program import plain
from ehdmaps.units import LOAD, SPEED, TEMPERATURE, Display, quantity
from ehdmaps.version import version


def check_folder(path: Path, read: Iterable[Path] = ()) -> None:
    """Refuse a folder that may not be written, before anything is computed.

    Parameters
    ----------
    path : Path
        The folder of `-o`. It may be there if it is empty, or holds nothing but files with our mark.
    read : iterable of Path
        Files that the command reads; none may lie in it.

    Raises
    ------
    InputError
        With the reason and what to do.
    """
    what = f"-o: got {str(path)!r:.300}"
    parent = Path(os.path.realpath(path)).parent
    if not parent.is_dir():
        raise InputError(f"{what}, but {parent} is no folder; allowed: a new folder in one that exists")
    if not path.exists() and not path.is_symlink():
        return
    if path.is_symlink() or not path.is_dir():
        raise InputError(f"{what}, which is there and is no folder; allowed: a new folder; choose another name")
    place = path.resolve()
    for name in read:
        if place == name.resolve().parent:
            raise InputError(f"{what}, which holds {name}, which is read; choose another name")
    foreign = sorted(entry.name for entry in path.iterdir() if not _ours(entry))
    if foreign:
        raise InputError(
            f"{what}, which holds {foreign[0]!r}, which no export made; allowed: a new folder, or one that holds an "
            "export and nothing else; choose another name, or remove it"
        )


def write_folder(path: Path, files: Mapping[str, str]) -> None:
    """Write a folder of texts, which carry our mark themselves; a folder that was there is replaced.

    Parameters
    ----------
    path : Path
        The folder; look at it with `check_folder` first.
    files : mapping of str to str
        Texts by the names of their files.

    Raises
    ------
    InputError
        If it may not be replaced or cannot be written.
    """
    target = Path(os.path.realpath(path))
    aside, before = (target.with_name(f".{target.name[:100]}.{os.getpid()}.{kind}") for kind in ("part", "old"))
    try:
        try:
            aside.mkdir()
            for name, text in files.items():
                (aside / name).write_text(text, encoding="utf-8")
            check_folder(path)  # something may have come while we computed
            if target.exists():
                target.rename(before)
            aside.rename(target)
        finally:
            shutil.rmtree(aside, ignore_errors=True)
            if before.exists() and not target.exists():
                before.rename(target)
            shutil.rmtree(before, ignore_errors=True)
    except OSError as error:
        raise InputError(
            f"{path}: cannot be written ({error.strerror or error}); allowed: a new folder in one that may be written, "
            "with space on the disk"
        ) from error


def _ours(entry: Path) -> bool:
    """Tell whether an entry of a folder is a file that an export made."""
    return entry.is_file() and not entry.is_symlink() and has_mark(entry)


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
        `--list`, `-o`, `--structural-law` and `--roughness` itself.
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
        *(
            f"range of {axis.replace('_', ' ')}: {_span(emap, axis, display)}; {beyond} beyond"
            for axis, display in _AXES
        ),
    )


def _span(emap: EHDMap, axis: str, display: Display) -> str:
    """Return a range of the map in words."""
    values = emap.dataset[axis].values
    low, high = display.text(float(values[0])), display.text(float(values[-1]))
    return low if values.size == 1 else f"{low} to {high}"


def chosen_kind(emap: EHDMap, contact: str | None, problems: Problems) -> LawKind:
    """Read which contact law of a map --contact means; the whole of a bearing where it is not given.

    Parameters
    ----------
    emap : EHDMap
        The map.
    contact : str, optional
        What was given.
    problems : list of str
        Gets what is wrong.
    """
    names = [one.name for one in emap.contacts]
    kinds: list[Any] = ["series", *names] if "inner" in names else names
    if contact is not None and contact not in kinds:
        problems.append(f"--contact: got {contact!r:.60}; allowed in this map: {', '.join(kinds)}")
    return contact or kinds[0]  # type: ignore[return-value]


def chosen_place(emap: EHDMap, axis: str, text: str | None, unit: str, display: Display, problems: Problems) -> float:
    """Read --speed or --temperature within a map; a map with one value has it.

    Parameters
    ----------
    emap : EHDMap
        The map.
    axis : str
        entrainment_speed or temperature; the option is called after the last word.
    text : str, optional
        What was given.
    unit : str
        Unit of the axis.
    display : Display
        How its limits are shown.
    problems : list of str
        Gets what is wrong.
    """
    values, option = emap.axis(axis), f"--{axis.rpartition('_')[2]}"
    # A standstill is a point of some maps, but between it and the lowest speed films fade by another rule.
    low, high = float(min(values[values > 0.0], default=0.0)), float(values[-1])
    value, limits = high, f"allowed in this map: {display.text(low)} to {display.text(high)}"
    if text is None:
        if values.size > 1:
            problems.append(f"{option}: missing; {limits}")
        return value
    with problems.after(f"{option}: "):
        value = quantity(text, unit)
        if not low <= value <= high and value not in values:
            raise InputError(f"got {text!r:.60}; {limits}")
    return value
