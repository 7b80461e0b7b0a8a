"""Reading of the values of a scene file: texts, places, vectors, directions. Problems are noted, reading goes on."""

from __future__ import annotations

import dataclasses
import math
import re
from collections.abc import Mapping
from importlib import resources
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import InputError
from ehdmaps.physics.solids import MATERIALS, Material
from ehdmaps.units import LENGTH, Display, quantity, short
from mbs.model.body import FREEDOMS, Inertia
from mbs.model.elements import GROUND

if TYPE_CHECKING:
    from ehdmaps.jobs.table import Table

FORCE = Display("N")
MOMENT = Display("N m")
ACCELERATION = Display("m/s^2")
MICROMETRE = Display("um", 1e6)
MILLISECOND = Display("ms", 1e3)
MICROSECOND = Display("us", 1e6)

LONGEST_FILE = 1_000_000
"""Bytes of a scene file."""
HERTZ = Display("Hz")
DEGREE = Display("deg", 180.0 / math.pi)

LARGEST = 1e15
"""Largest entry of a stiffness or damping that is read."""

_TRANSLATIONS = FREEDOMS[:3]


def cylinder(table: Table) -> Inertia | None:
    """Read a hollow cylinder."""
    begin = table.quantity("from", "m", -100.0, 100.0, LENGTH, required=True)
    end = table.quantity("to", "m", -100.0, 100.0, LENGTH, required=True)
    diameter = table.quantity("diameter", "m", 1e-5, 100.0, LENGTH, required=True)
    bore = table.quantity("bore", "m", 0.0, 100.0, LENGTH)
    density = material(table).density
    table.close()
    if begin is None or end is None or diameter is None:
        return None
    return solid_cylinder(table, begin, end, diameter, bore, density)


def material(table: Table) -> Material:
    """Read the material of a part, by its name, and its density where that is stated; steel if left out.

    Parameters
    ----------
    table : Table
        The table of the part.
    """
    found = MATERIALS[table.choice("material", tuple(MATERIALS)) or "steel"]
    density = table.quantity("density", "kg/m^3", 100.0, 25000.0, Display("kg/m^3"))
    return found if density is None else dataclasses.replace(found, density=density)


def solid_cylinder(
    table: Table, begin: float, end: float, diameter: float, bore: float | None, density: float
) -> Inertia | None:
    """Inertia of a cylinder from its ends and diameters [m] and density [kg/m3]; without holes if left out.

    Parameters
    ----------
    table : Table
        Takes what is wrong.
    begin, end, diameter : float
        Dimensions [m].
    bore : float or None
        [m].
    density : float
        [kg/m3].
    """
    return table.made(lambda: Inertia.cylinder(begin, end, diameter, bore or 0.0, density))


def text(section: Table, key: str, required: bool = False) -> str | None:
    """Read a short text.

    Parameters
    ----------
    section : Table
        The table of the scene file.
    key : str
        Key in the table.
    required : bool
        Whether an absent key is a problem.
    """
    value = section.get(key, "a short text" if required else "")
    if key not in section:
        return None
    if not isinstance(value, str) or not 1 <= len(value) <= 200 or (key == "name" and (":" in value or "." in value)):
        section.note(key, f"got {short(value)}; allowed: a short text{', without : and .' if key == 'name' else ''}")
        return None
    return value


def named(section: Table, key: str) -> bool:
    """Tell whether a key that the user chose is the name of a place; note a problem."""
    good = 1 <= len(key) <= 100 and ":" not in key and "." not in key
    if not good:
        section.note("", f"got the name {short(key)}; allowed: a short name without : and .")
    return good


def words(section: Table, key: str, allowed: tuple[str, ...]) -> tuple[str, ...] | None:
    """Read a list of words.

    Parameters
    ----------
    section : Table
        The table of the scene file.
    key : str
        Key in the table.
    allowed : tuple of str
        The words that may stand there.
    """
    value = section.get(key, f"a list of {', '.join(allowed)}")
    if key not in section:
        return None
    wrong = value if not isinstance(value, list) else [word for word in value if word not in allowed]
    if not isinstance(value, list) or wrong:
        section.note(key, f"got {wrong!r:.80}; allowed: a list of {', '.join(allowed)}")
        return None
    return tuple(value)


def place(section: Table, key: str) -> str | None:
    """Read a place; whether it exists is seen when the system is put together."""
    value = section.get(key, 'a place such as "shaft" or "shaft:left"')
    if key not in section:
        return None
    if not isinstance(value, str) or not value:
        section.note(key, f'got {short(value)}; allowed: a place such as "shaft" or "shaft:left"')
        return None
    return value


def file_path(section: Table, key: str, folder: Path | None) -> Path | None:
    """Read the path of a file, which is not opened; None if absent or wrong.

    Parameters
    ----------
    section : Table
        The table of the scene file.
    key : str
        Key in the table.
    folder : Path or None
        Folder in which relative paths begin; None for that of the shipped systems.
    """
    value = section.get(key, "the path of a file")
    if key not in section:
        return None
    if not isinstance(value, str) or not 1 <= len(value) <= 1000 or "\0" in value:
        section.note(key, f"got {short(value)}; allowed: the path of a file, beside this one or absolute")
        return None
    beside = Path(str(resources.files("mbs") / "systems")) if folder is None else folder
    return beside / value


def places(section: Table) -> tuple[str | None, str]:
    """Read on and against."""
    return place(section, "on"), against(section)


def against(section: Table) -> str:
    """Read against: the ground where none is stated."""
    return (place(section, "against") or GROUND) if "against" in section else GROUND


def lengths(section: Table, key: str, value: Any) -> tuple[float, float, float] | None:
    """Read three lengths; None if absent or wrong.

    Parameters
    ----------
    section : Table
        The table of the scene file.
    key : str
        How messages call the value.
    value : Any
        What was read.
    """
    if value is None:
        return None
    if not isinstance(value, list) or len(value) != 3:
        section.note(key, f'got {short(value)}; allowed: three lengths, x y z, such as ["70 mm", "0 mm", "0 mm"]')
        return None
    x, y, z = (
        section.quantity_of(part, f"{key}[{index}]", "m", -100.0, 100.0, LENGTH) or 0.0
        for index, part in enumerate(value)
    )
    return x, y, z


def vector(
    section: Table, key: str, unit: str, display: Display, largest: float = 1e9
) -> tuple[float, float, float] | None:
    """Read three forces or moments; zeros if absent, None if wrong.

    Parameters
    ----------
    section : Table
        The table of the scene file.
    key : str
        Key in the table.
    unit : str
        SI unit of the result.
    display : Display
        How messages show the limits.
    largest : float
        Largest size of each.
    """
    value = section.get(key)
    if key not in section:
        return (0.0, 0.0, 0.0)
    if not isinstance(value, list) or len(value) != 3:
        section.note(
            key, f'got {short(value)}; allowed: three values, x y z, such as ["0 {unit}", "1 {unit}", "0 {unit}"]'
        )
        return None
    x, y, z = (
        section.quantity_of(part, f"{key}[{index}]", unit, -largest, largest, display)
        for index, part in enumerate(value)
    )
    return None if x is None or y is None or z is None else (x, y, z)


def wrench(section: Table) -> FloatArray | None:
    """Read force and moment of a load, (6,) [N], [N m]; one of them may be absent. None where a problem was noted."""
    force = vector(section, "force", "N", FORCE)
    moment = vector(section, "moment", "N m", MOMENT)
    if "force" not in section and "moment" not in section:
        section.note("force", 'missing; allowed: force = ["0 N", "100 N", "0 N"], or moment, or both')
    return None if force is None or moment is None else np.array([*force, *moment])


def matrices(
    section: Table, key: str, force: str, moment: str, count: int, least: float = -LARGEST
) -> FloatArray | None:
    """Read a matrix by names of its entries, or as many as there are speeds; shape (count, 6, 6).

    The entry `y_z` is what a motion along z makes along y. `y` is short for `y_y`. What is not there is 0.

    Parameters
    ----------
    section : Table
        The table of the scene file.
    key : str
        Key in the table.
    force, moment : str
        Unit of a force over a translation, and of a moment over a rotation.
    count : int
        Number of speeds; an entry is then one value for all of them, or a list of as many.
    least : float
        Least value on the diagonal.

    Returns
    -------
    array or None
        Zeros if absent; None if wrong.
    """
    found = np.zeros((count, 6, 6))
    table = section.table(key, f"{section.where} {key}")
    if table is None:
        return found
    before = len(section.problems)
    for i, row in enumerate(FREEDOMS):
        for j, column in enumerate(FREEDOMS):
            turned = (row not in _TRANSLATIONS) + (column not in _TRANSLATIONS)
            unit = (force, force.replace("/m", "/rad"), moment)[turned]
            if turned == 1 and row not in _TRANSLATIONS:
                unit = moment.replace("/rad", "/m")
            for name in (f"{row}_{column}", *((row,) if i == j else ())):
                if name in table:
                    found[:, i, j] = _entries(table, name, unit, count, least if i == j else -LARGEST)
    table.close((*FREEDOMS, "y_z", "z_y", "and the like"))
    return found if len(section.problems) == before else None


def _entries(table: Table, name: str, unit: str, count: int, least: float) -> FloatArray:
    """Read an entry of a matrix, at each speed; zeros where a problem was noted."""
    value = table.get(name)
    if not isinstance(value, list):
        return np.full(count, table.quantity_of(value, name, unit, least, LARGEST, Display(unit)) or 0.0)
    if len(value) != count or count == 1:
        table.note(name, f"got {len(value)} values; allowed: one value, or a list of as many as there are speeds")
        return np.zeros(count)
    return np.array(
        [
            table.quantity_of(part, f"{name}[{k}]", unit, least, LARGEST, Display(unit)) or 0.0
            for k, part in enumerate(value)
        ]
    )


def direction(section: Table) -> FloatArray | None:
    """Read a direction: the name of a freedom, or three numbers x y z, which are normalised; shape (6,)."""
    allowed = f"one of {', '.join(FREEDOMS)}, or three numbers x y z"
    value = section.get("direction", allowed)
    if "direction" not in section:
        return None
    direction = np.zeros(6)
    if value in FREEDOMS:
        direction[FREEDOMS.index(value)] = 1.0
        return direction
    numbers = real_numbers(value)
    if numbers is None or len(numbers) != 3:
        section.note("direction", f"got {short(value)}; allowed: {allowed}")
        return None
    # Divided first: the length of numbers near the largest one is none.
    largest = max(map(abs, numbers))
    if largest == 0.0:
        section.note("direction", f"got {value!r:.60}; allowed: {allowed}, not all zero")
        return None
    scaled = np.array(numbers) / largest
    direction[:3] = scaled / math.hypot(*scaled)
    return direction


def real_numbers(value: object) -> list[float] | None:
    """Finite numbers of a list; None if it is no list of such numbers, without units and quotes.

    Parameters
    ----------
    value : object
        What was read.
    """
    if not isinstance(value, list) or any(
        isinstance(part, bool) or not isinstance(part, (int, float)) for part in value
    ):
        return None
    try:
        numbers = [float(part) for part in value]
    except OverflowError:  # a whole number of any length stands in a TOML file
        return None
    return numbers if all(map(math.isfinite, numbers)) else None


_COLUMN = re.compile(r"\s*([a-z ]+?)\s*\[([^\[\]]*)\]\s*")
_BETWEEN = {",": "commas", ";": "semicolons", "\t": "tabulators"}


def read_columns(
    path: str | Path, units: Mapping[str, str], allowed: str, most: int, longest: int, name: str = ""
) -> dict[str, list[float]]:
    """Numbers of a CSV file by the names of its columns, in SI; at least one column and one row.

    Parameters
    ----------
    path : str or Path
        Text in UTF-8 with commas, semicolons or tabulators; its first line has names with units, such as
        "load [kN]". Empty lines and lines that begin with # are passed over.
    units : mapping of str to str
        Names that columns may have, and a unit of each.
    allowed : str
        Columns, for messages.
    most, longest : int
        Rows and bytes that it may have.
    name : str
        Name of the file in messages; its path if left out.

    Raises
    ------
    InputError
        With what is wrong about the file, and where.
    """
    from ehdmaps.inputs import read_text, separator  # of files with columns alone

    name = name or str(path)
    text = read_text(path, longest, f"a CSV file of at most {longest // 1_000_000} MB in UTF-8", name=name)
    lines = [(i, line) for i, line in enumerate(text.splitlines(), 1) if line.strip() and not line.startswith("#")]
    if not lines:
        raise InputError(f"{name}: got an empty file; allowed: {allowed}")
    if len(lines) > most + 1:
        raise InputError(f"{name}: got {len(lines) - 1} points; allowed: up to {most}")
    (number, head), between = lines[0], separator(lines[0][1])
    factors: dict[str, float] = {}
    for title in head.split(between):
        match = _COLUMN.fullmatch(title)
        if match is None or match[1] not in units or match[1] in factors:
            raise InputError(f"{name}, line {number}: got the column {title.strip()!r:.60}; allowed: {allowed}")
        try:
            factors[match[1]] = quantity(f"1 {match[2]}", units[match[1]])
        except InputError as error:
            raise InputError(f"{name}, line {number}, column {match[1]}: {error}") from None
    rows = [_numbers(name, *line, len(factors), between) for line in lines[1:]]
    return {key: [row[k] * factor for row in rows] for k, (key, factor) in enumerate(factors.items())}


def _numbers(name: str, number: int, line: str, count: int, between: str) -> list[float]:
    """Numbers of a line."""
    from ehdmaps.inputs import decimal_points

    try:
        values = [float(text) for text in decimal_points(line, between).split(between)]
    except ValueError:
        values = []
    if len(values) != count:
        raise InputError(
            f"{name}, line {number}: got {line.strip()!r:.60}; allowed: {count} numbers with {_BETWEEN[between]} "
            "between"
        )
    return values
