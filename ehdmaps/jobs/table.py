"""From the text of a TOML file to its tables, read key by key; every problem is noted, none stops the reading."""

from __future__ import annotations

import math
import re
import tomllib
from collections.abc import Callable, Iterator
from typing import Any, TypeVar

from ehdmaps.errors import InputError
from ehdmaps.units import Display, closest, quantity_between, short

DEEPEST = 64
"""Parts of a dotted key: the time to read one goes with their square, and no table of ours is deeper than five."""

_ENDS_OF_KEYS = re.compile(r"[=,\[\]{}#]")


def parse(text: str, where: str) -> dict[str, Any]:
    """Tables of a TOML text; `where` is how messages call the file.

    Raises
    ------
    InputError
        If it is not TOML.
    """
    for number, line in enumerate(text.splitlines(), start=1):
        if line.count(".") >= DEEPEST and _deepest_key(line) > DEEPEST:
            raise InputError(
                f"{where}: is not TOML of this program: line {number} has a dotted key of more than {DEEPEST} parts; "
                "allowed: tables as the reference names them"
            )
    try:
        return tomllib.loads(text)
    except (ValueError, RecursionError) as error:
        # ValueError covers TOMLDecodeError and numbers with too many digits.
        raise InputError(
            f"{where}: is not TOML: {error}; allowed: TOML 1.0; strings with units stand in quotes"
        ) from error


def inline(text: str, option: str, problems: list[str]) -> Any:
    """A table in braces, as an option has it; None where a problem was noted.

    Parameters
    ----------
    text : str
        The table.
    option : str
        Name of the option, for messages.
    problems : list of str
        Takes what is wrong.

    Examples
    --------
    >>> inline('{ outlet = "gas" }', "--permittivity", [])
    {'outlet': 'gas'}
    """
    try:
        # A line break would let a text go on after the table.
        return parse(f"value = {' '.join(text.splitlines())}", option)["value"]
    except InputError as error:
        problems += error.problems
        return None


def _deepest_key(line: str) -> int:
    """Most parts, with dots between them, of what may be a key in a line."""
    dense = "".join(line.split())
    return max(sum(bool(part) for part in run.split(".")) for run in _ENDS_OF_KEYS.split(dense))


_Read = TypeVar("_Read")

_LONGEST_NAME = 200
"""Letters of the name of a table or key in a message."""


class Table:
    """A table and the list of problems that it shares with the other tables of its file.

    Every reading method returns None where it noted a problem (or where an optional key is absent), so that
    reading goes on. `close` notes the keys that nobody asked for.

    Parameters
    ----------
    values : object
        What stands in the file; a table, or a slip.
    where : str
        How messages call the table, such as "[grid]".
    problems : list of str
        Problems of the file, appended to.
    """

    def __init__(self, values: object, where: str, problems: list[str]) -> None:
        self.where = _brief(where)
        self.problems = problems
        self._known: list[str] = []
        self._values: dict[str, Any] = {}
        if isinstance(values, dict):
            self._values = values
        else:
            self.note("", f"got {short(values)}; allowed: a table; write {where} and its keys below it")

    def __contains__(self, key: str) -> bool:
        return key in self._values

    def entries(self) -> tuple[str, ...]:
        """Return the keys that the table has, for tables whose keys are names that the user chose."""
        return tuple(self._values)

    def note(self, key: str, problem: str) -> None:
        """Note a problem of a key."""
        self.problems.append(f"{self.where}{' ' if key else ''}{_brief(key)}: {problem}")

    def get(self, key: str, required: str = "") -> Any:
        """Return the raw value; `required` is what a missing key should have been."""
        self._known.append(key)
        if key not in self._values and required:
            self.note(key, f"missing; allowed: {required}")
        return self._values.get(key)

    def table(self, key: str, where: str, required: str = "") -> Table | None:
        """Return the table under a key.

        Parameters
        ----------
        key : str
            Key in this table.
        where : str
            How messages call the table under the key.
        required : str
            What a missing key should have been; empty if it may be absent.
        """
        values = self.get(key, required)
        return None if key not in self else Table(values, where, self.problems)

    def optional(
        self,
        key: str,
        where: str,
        read: Callable[[Table], _Read | None],
        close: Callable[[Table], None] | None = None,
    ) -> _Read | None:
        """Read the table under a key, where there is one, and note the keys that nobody asked for.

        Parameters
        ----------
        key : str
            Key in this table.
        where : str
            How messages call the table under the key.
        read : callable
            What reads it; None where it notes a problem.
        close : callable, optional
            What closes it; `close` if left out.
        """
        section = self.table(key, where)
        if section is None:
            return None
        value = read(section)
        (close or Table.close)(section)
        return value

    def made(self, make: Callable[[], _Read], key: str = "", said: str = "") -> _Read | None:
        """Make a value of what was read; None where it cannot be, which is noted.

        Parameters
        ----------
        make : callable
            What makes it.
        key : str
            Key that it is made of; the whole table if left out.
        said : str
            End of what the key says already of a problem: its words up to there are left out.
        """
        try:
            return make()
        except InputError as error:
            for problem in error.problems:
                self.note(key, (problem.partition(said)[2] if said else "") or problem)
        except (ValueError, OverflowError, ZeroDivisionError) as error:
            self.note("", f"its values together give no usable {self.where} ({error}); check their units")
        return None

    def quantity(
        self, key: str, unit: str, low: float, high: float, display: Display, *, required: bool = False
    ) -> float | None:
        """Return a string with a unit as a number in SI, within [low, high].

        Parameters
        ----------
        key : str
            Key in this table.
        unit : str
            SI unit of the result.
        low : float
            Smallest value allowed.
        high : float
            Largest value allowed.
        display : Display
            How messages show the limits.
        required : bool
            Whether an absent key is a problem.
        """
        limits = f"{display.text(low)} to {display.text(high)}"
        text = self.get(key, f"a quantity of {limits}" if required else "")
        if key not in self:
            return None
        return self.quantity_of(text, key, unit, low, high, display)

    def quantity_of(self, text: object, key: str, unit: str, low: float, high: float, display: Display) -> float | None:
        """Return one string with a unit (an entry of a list, say) as a number in SI, within [low, high].

        Parameters
        ----------
        text : object
            The string, as read.
        key : str
            How messages call the entry.
        unit : str
            SI unit of the result.
        low : float
            Smallest value allowed.
        high : float
            Largest value allowed.
        display : Display
            How messages show the limits.
        """
        return self.made(lambda: quantity_between(text, unit, low, high, display), key)

    def number(self, key: str, low: float, high: float, *, required: bool = False) -> float | None:
        """Return a bare number within [low, high].

        Parameters
        ----------
        key : str
            Key in this table.
        low : float
            Smallest value allowed.
        high : float
            Largest value allowed.
        required : bool
            Whether an absent key is a problem.
        """
        value = self.get(key, f"a number from {low:g} to {high:g}" if required else "")
        if key not in self:
            return None
        if isinstance(value, bool) or not isinstance(value, (int, float)):
            self.note(key, f"got {short(value)}; allowed: a bare number from {low:g} to {high:g}")
            return None
        if not (low <= value <= high and math.isfinite(value)):
            self.note(key, f"got {short(value)}; allowed: {low:g} to {high:g}")
            return None
        return float(value)

    def integer(self, key: str, low: int, high: int, *, required: bool = False) -> int | None:
        """Return a whole number within [low, high].

        Parameters
        ----------
        key : str
            Key in this table.
        low : int
            Smallest value allowed.
        high : int
            Largest value allowed.
        required : bool
            Whether an absent key is a problem.
        """
        value = self.get(key, f"a whole number from {low} to {high}" if required else "")
        if key not in self:
            return None
        if isinstance(value, bool) or not isinstance(value, int) or not low <= value <= high:
            self.note(key, f"got {short(value)}; allowed: a whole number from {low} to {high}, without quotes")
            return None
        return value

    def choice(self, key: str, allowed: tuple[str, ...], *, required: bool = False) -> str | None:
        """Return one of some words.

        Parameters
        ----------
        key : str
            Key in this table.
        allowed : tuple of str
            The words.
        required : bool
            Whether an absent key is a problem.
        """
        listed = ", ".join(repr(word) for word in allowed)
        value = self.get(key, listed if required else "")
        if key not in self:
            return None
        if not isinstance(value, str):
            self.note(key, f"got {short(value)}; allowed: {listed}, in quotes")
            return None
        if value not in allowed:
            self.note(key, f"got {short(value)}{closest(value, allowed)}; allowed: {listed}")
            return None
        return value

    def flag(self, key: str) -> bool:
        """Return whether a key is true; false where it is absent."""
        value = self.get(key)
        if key in self and not isinstance(value, bool):
            self.note(key, f"got {short(value)}; allowed: true, false")
        return value is True

    def tables(self, key: str, allowed: str) -> Iterator[Table]:
        """Yield the tables of a list; none where it is absent.

        Parameters
        ----------
        key : str
            Key in this table.
        allowed : str
            How messages say what is allowed, a list of tables with such keys.
        """
        given = self.get(key)
        if key in self and not isinstance(given, list):
            self.note(key, f"got {short(given)}; allowed: {allowed}")
        for index, values in enumerate(given if isinstance(given, list) else []):
            yield Table(values, f"{self.where} {key}[{index}]", self.problems)

    def close(self, others: tuple[str, ...] = ()) -> None:
        """Note every key that nobody asked for; `others` are keys that were not due this time."""
        known = tuple(dict.fromkeys(self._known + list(others)))
        for key in self._values:
            if key not in self._known:
                self.note(short(key)[1:-1], f"unknown key{closest(key, known)}; allowed: {', '.join(known)}")


def _brief(name: str) -> str:
    """A name as it is, or its ends: a user may choose names of any length."""
    return name if len(name) <= _LONGEST_NAME else f"{name[:50]}...{name[-50:]}"
