"""Entries of an OpenFOAM dictionary: nothing but finite numbers, by `repr`, and words of fixed tables.

OpenFOAM dictionaries can execute code.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from numbers import Real
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ehdmaps.errors import InputError, problems_after
from ehdmaps.physics.lubricant import LubricantState

HEADER = """FoamFile
{
    version     2.0;
    format      ascii;
    class       dictionary;
    object      ehlProperties;
}

// All values in SI"""

NOTES: Mapping[str, str] = {
    "reducedRadius": "R [m]",
    "reducedModulus": "E' [Pa]",
    "load": "per length [N/m]",
    "lowerSpeed": "of the surfaces, in +x [m/s]",
    "upperSpeed": "[m/s]",
    "viscosity": "at ambient pressure [Pa s]",
    "pressureViscosity": "there [1/Pa]",
    "pressureScale": "[Pa]",
    "density": "at ambient pressure [kg/m^3]",
    "stress": "[Pa]",
    "pressureRange": "from full film to no liquid [Pa]",
    "columns": "cells along the film",
    "rows": "and across it",
    "film": "expected film, h R/b^2",
    "inletLength": "in sqrt(2 h R), from the Hertz zone",
    "outletLength": "in widths of the exit zone",
    "spikePosition": "in half-widths b from the centre",
    "spikeWidth": "[b], 0: no spike",
    "temperature": "of the surfaces, and of the oil that comes in [K]",
    "oilConductivity": "[W/(m K)]",
    "oilHeatCapacity": "[J/(kg K)]",
    "solidConductivity": "[W/(m K)]",
    "solidHeatCapacity": "[J/(kg K)]",
    "solidDensity": "[kg/m^3]",
    "first": "[K]",
    "step": "[K]",
    "x": "from the contact centre [m]",
    "pressure": "[Pa]",
    "centralFilm": "[m]",
    "levels": "across the film, 0 and 1 at its surfaces",
    "temperatures": "at each level over all x [K]",
    "frequencies": "[Hz], 0 is the low-frequency limit",
    "frequency": "[Hz]",
    "amplitude": "of the load",
}
"""What is said behind an entry of the file."""

NUMBERS_A_LINE = 5
"""Of a long list."""


def camel(name: str) -> str:
    """Return a name in the dictionary's spelling.

    Parameters
    ----------
    name : str
        Name with underscores.

    Examples
    --------
    >>> camel("pressure_scale")
    'pressureScale'
    """
    first, *others = name.split("_")
    return first + "".join(map(str.capitalize, others))


def block(name: str, entries: Sequence[str]) -> Iterator[str]:
    """Yield the lines of a sub-dictionary.

    Parameters
    ----------
    name : str
        Name of the sub-dictionary.
    entries : sequence of str
        Entries, of one line or more.
    """
    yield from (name, "{", *(f"    {text}" for each in entries for text in each.split("\n")), "}")


def line(key: str, value: str, note: str | None = None) -> str:
    """Return an entry with its note.

    Parameters
    ----------
    key, value : str
        Both words of the entry.
    note : str, optional
        What is said behind it; that of `NOTES` where left out.
    """
    said = NOTES.get(key, "") if note is None else note
    text = f"{key:<20}{value};"
    return f"{text:<45}// {said}" if said else text


def entry(key: str, value: object, note: str | None = None) -> str:
    """Return the entry of a number.

    Parameters
    ----------
    key : str
        Key of the entry.
    value : object
        A finite number.
    note : str, optional
        See `line`.

    Raises
    ------
    InputError
        For anything else.
    """
    # repr of a float is exact and has no character that a dictionary could take for anything else
    if isinstance(value, bool) or not isinstance(value, Real) or not math.isfinite(value):
        raise InputError(f"ehlProperties, {key}: got {value!r:.60}; allowed: a finite number")
    return line(key, repr(float(value)), note)


def count(key: str, value: object, note: str | None = None) -> str:
    """Return the entry of a whole number.

    Parameters
    ----------
    key : str
        Key of the entry.
    value : object
        A whole number >= 1.
    note : str, optional
        See `line`.

    Raises
    ------
    InputError
        For anything else.
    """
    if isinstance(value, bool) or not isinstance(value, int) or value < 1:
        raise InputError(f"ehlProperties, {key}: got {value!r:.60}; allowed: a whole number >= 1")
    return line(key, repr(int(value)), note)


def switch(key: str, value: object) -> str:
    """Return the entry of true or false.

    Parameters
    ----------
    key : str
        Key of the entry.
    value : object
        True or False.

    Raises
    ------
    InputError
        For anything else.
    """
    if not isinstance(value, bool):
        raise InputError(f"ehlProperties, {key}: got {value!r:.60}; allowed: true or false")
    return line(key, "true" if value else "false")


def number_list(key: str, values: ArrayLike) -> str:
    """Return the entry of a list of numbers, a long one over many lines.

    Parameters
    ----------
    key : str
        Key of the entry.
    values : array_like, shape (n,)
        Finite numbers.

    Raises
    ------
    InputError
        For anything else.
    """
    array = np.asarray(values)
    if array.ndim != 1 or (array.size and array.dtype.kind not in "iuf") or not np.isfinite(array.astype(float)).all():
        raise InputError(f"ehlProperties, {key}: got {array.ravel()[:3]!r:.60}; allowed: a list of finite numbers")
    numbers = [repr(number) for number in array.astype(float).tolist()]
    if len(numbers) <= NUMBERS_A_LINE:
        return line(key, f"({' '.join(numbers)})")
    starts = range(0, len(numbers), NUMBERS_A_LINE)
    lines = (f"    {' '.join(numbers[start : start + NUMBERS_A_LINE])}" for start in starts)
    return "\n".join((f"{key:<45}// {NOTES[key]}" if key in NOTES else key, "(", *lines, ");"))


def word(key: str, value: object, table: Mapping[Any, str]) -> str:
    """Return the dictionary's word for a word of the job file.

    Parameters
    ----------
    key : str
        Key of the entry.
    value : object
        A key of the table.
    table : mapping
        Words of the dictionary.

    Raises
    ------
    InputError
        For a word that is not in the table.
    """
    if not isinstance(value, str | int) or isinstance(value, bool) or value not in table:
        raise InputError(f"ehlProperties, {key}: got {value!r:.60}; allowed: {', '.join(map(str, table))}")
    return table[value]


def oil_blocks(oil: LubricantState) -> Iterator[str]:
    """Yield the lines of the laws of viscosity and density of an isotherm.

    Parameters
    ----------
    oil : LubricantState
        Oil at its temperature.

    Raises
    ------
    InputError
        If its law is none of `ehlFoam`.
    """
    isotherm = [entry(key, value) for key, value in oil_numbers(oil).items()]
    yield from block("viscosity", [line("type", oil.pressure_viscosity.case_name), *isotherm])
    yield from block("density", [line("type", density_law(oil)), entry("density", oil.density)])


def oil_numbers(oil: LubricantState) -> dict[str, float]:
    """Return the numbers of an isotherm, in SI, in the dictionary's spelling.

    Parameters
    ----------
    oil : LubricantState
        Oil at its temperature.

    Raises
    ------
    InputError
        If its law is none of `ehlFoam`.
    """
    with problems_after("ehlProperties, "):
        numbers = oil.pressure_viscosity.case_numbers()
    return {"viscosity": oil.viscosity} | {camel(key): value for key, value in numbers.items()}


def density_law(oil: LubricantState) -> str:
    """Return the name of the law of density.

    Parameters
    ----------
    oil : LubricantState
        Oil at its temperature.
    """
    return "DowsonHigginson" if oil.compressible else "incompressible"
