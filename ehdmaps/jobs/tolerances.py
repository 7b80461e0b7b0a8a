"""Tolerances say how well a number is known: beside values ("25 um +- 5 um"), and in the table [tolerances] of a file.

A tolerance is a half-width, absolute ("5 um", "2 K") or a part ("10 %") of what it belongs to. Nothing at all ("0 um",
"0 %") says that the number is exact.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from ehdmaps.errors import InputError, short
from ehdmaps.units import Display, quantity

if TYPE_CHECKING:
    from ehdmaps.jobs.table import Table

_SIGN = re.compile(r"\+-|\+/-|±")
_PART = re.compile(r"([0-9]+\.?[0-9]*|\.[0-9]+) ?%")

OF = " of "
"""Between a key and the name of a bearing."""

MOST = 1.0
"""Largest tolerance that is a part."""


@dataclass(frozen=True)
class Tolerated:
    """Row of what a tolerance may be stated of: a key of [tolerances].

    Attributes
    ----------
    name : str
        The key.
    unit : str
        SI unit of an absolute tolerance; empty where it is a part.
    most : float
        Largest absolute tolerance [unit].
    part : bool
        Whether it may be a part.
    display : Display
        How messages show an absolute one.
    examples : str
        What may be written, for messages.
    """

    name: str
    unit: str
    most: float
    part: bool
    display: Display
    examples: str


TOLERATED: Mapping[str, Tolerated] = {
    row.name: row
    for row in (
        Tolerated("clearance", "m", 1e-3, True, Display("um", 1e6), "5 um, or 10 %"),
        Tolerated("temperature", "K", 50.0, False, Display("K"), "2 K"),
        Tolerated("viscosity", "", 0.0, True, Display("%", 100.0), "5 %"),
        Tolerated("pressure_viscosity", "", 0.0, True, Display("%", 100.0), "10 %"),
        Tolerated("oil_layer", "", 0.0, True, Display("%", 100.0), "20 %"),
        Tolerated(
            "geometry", "", 0.0, True, Display("%", 100.0), "0 %: as drawn, or 50 % of the errors of an estimate"
        ),
        Tolerated("preload", "N", 1e7, True, Display("N"), "20 N, or 10 %"),
        Tolerated("load", "", 0.0, True, Display("%", 100.0), "5 %"),
        Tolerated("profile", "", 0.0, False, Display("%", 100.0), "0 %: as the scene has it"),
        Tolerated("cage_angle", "rad", 2.0 * math.pi, False, Display("deg", 180.0 / math.pi), "0 deg: as it starts"),
    )
}
"""Keys of [tolerances], in the order of the reference."""


@dataclass(frozen=True)
class Tolerance:
    """Half-width of what a number may be off.

    Attributes
    ----------
    size : float
        Half-width in SI, or the part.
    part : bool
        Whether it is a part of the number.
    text : str
        Text as it was written.
    """

    size: float
    part: bool
    text: str

    @property
    def exact(self) -> bool:
        """Tell whether the number is known."""
        return self.size == 0.0

    def half_width(self, value: float) -> float:
        """Half-width at a value [unit of the value]."""
        return self.size * abs(value) if self.part else self.size


def read_tolerance(text: object, name: str) -> Tolerance:
    """Read one tolerance.

    Parameters
    ----------
    text : object
        Such as "5 um" or "10 %", with or without a sign before it.
    name : str
        What it belongs to, one of `TOLERATED`.

    Raises
    ------
    InputError
        With one problem, which does not say where: the caller knows that.

    Examples
    --------
    >>> read_tolerance("+- 5 um", "clearance").half_width(20e-6), read_tolerance("25 %", "clearance").half_width(20e-6)
    (5e-06, 5e-06)
    """
    row = TOLERATED[name]
    wrong = InputError(f"got {short(text)}; allowed: {_allowed(row)}")
    if not isinstance(text, str):
        raise wrong
    plain = _SIGN.sub("", text, count=1).strip()
    if found := _PART.fullmatch(plain):
        part = float(f"{0.01 * float(found.group(1)):.15g}")
        if part > MOST or (part and not row.part):
            raise wrong
        return Tolerance(part, True, f"+-{plain}")
    if not row.unit:
        raise wrong
    try:
        size = quantity(plain, row.unit)
    except InputError:
        raise wrong from None
    if not 0.0 <= size <= row.most:
        raise wrong
    return Tolerance(size, False, f"+-{plain}")


def split(text: str) -> tuple[str, str]:
    """A value and its tolerance as they were typed; either is empty where it is not there.

    Examples
    --------
    >>> split("25 um +- 5 um"), split("25 um"), split("+- 10 %")
    (('25 um', '5 um'), ('25 um', ''), ('', '10 %'))
    """
    value, _, tolerance = _SIGN.sub("\0", text, count=1).partition("\0")
    return value.strip(), tolerance.strip()


OF_JOBS = ("temperature", "viscosity", "pressure_viscosity", "geometry")
"""What a job has of these."""


def read_tolerances(section: Table, names: Sequence[str] = tuple(TOLERATED)) -> dict[str, Tolerance]:
    """Read [tolerances]; whoever calls closes it.

    Parameters
    ----------
    section : Table
        The table.
    names : sequence of str
        Its keys.
    """
    found = {}
    for name in names:
        text = section.get(name)
        if name not in section:
            continue
        try:
            found[name] = read_tolerance(text, name)
        except InputError as error:
            section.note(name, error.problems[0])
    return found


def of_bearing(group: str, bearing: str) -> str:
    """Key of a statement on one bearing."""
    return f"{group}{OF}{bearing}"


def of_all(tolerances: Mapping[str, Tolerance], group: str) -> dict[str, Tolerance]:
    """Statements without those on single bearings of a group, which a nearer statement on all has outdone."""
    return {key: value for key, value in tolerances.items() if not key.startswith(group + OF)}


def _allowed(row: Tolerated) -> str:
    """Words on what a tolerance of a row may be, for messages."""
    ways = [f"0 to {row.display.text(row.most)}"] if row.unit else []
    ways += [f"0 % to {100.0 * MOST:g} %"] if row.part else [] if row.unit else ["0 %"]
    return f"{', or '.join(ways)}, such as {row.examples}"
