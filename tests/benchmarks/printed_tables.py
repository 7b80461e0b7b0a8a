"""Tables that `mbs sweep` and `mbs variants` print, read back."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass

NUMBER = r"([-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?)"


@dataclass(frozen=True)
class Output:
    """A command and what it prints."""

    command: str
    text: str


@dataclass(frozen=True)
class Mode:
    """A row of a mode in a sweep: frequency [Hz], damping ratio, energy in the bearings at the first and last speed."""

    first: float
    last: float
    energy: tuple[float, float] = (0.0, 0.0)
    damping_ratio: float = 0.0
    last_ratio: float = 0.0

    @property
    def change(self) -> float:
        """Change over the speeds [%]."""
        return 100.0 * (self.last / self.first - 1.0)


@dataclass(frozen=True)
class Along:
    """Stiffness [N/um] and damping [N s/mm] of the first bearing along the load, at the first and last speed."""

    k: tuple[float, float]
    c: tuple[float, float]

    @property
    def changes(self) -> tuple[float, float]:
        """Changes of k and c [%]."""
        return (100.0 * (self.k[1] / self.k[0] - 1.0), 100.0 * (self.c[1] / self.c[0] - 1.0))


@dataclass(frozen=True)
class Case:
    """A case of `mbs sweep`."""

    title: str
    along: Along
    undamped: dict[int, Mode]
    complex: dict[int, Mode]
    text: str

    def steepest(self) -> float:
        """Change of the complex mode that falls most [%]."""
        return min(mode.change for mode in self.complex.values())

    def highest_rise(self) -> float:
        """Change of the complex mode that rises most [%]."""
        return max(mode.change for mode in self.complex.values())

    def bearing_modes(self) -> list[Mode]:
        """Complex modes along the load with half and more of their energy in the bearings (0.45 at either end).

        Those across the load lie below 1.5 kHz.
        """
        return [
            mode
            for number, mode in self.complex.items()
            if number in self.undamped and max(self.undamped[number].energy) >= 0.45 and mode.first > 1500.0
        ]


def sweep_cases(text: str) -> list[Case]:
    """Read the cases that `mbs sweep` prints."""
    found = []
    for part in re.split(r"(?m)^(?=\S.*: law )", text)[1:]:
        along = re.search(rf"along the load k {NUMBER} to {NUMBER} N/um \([^)]*\), c {NUMBER} to {NUMBER} N s/mm", part)
        assert along is not None
        k0, k1, c0, c1 = map(float, along.groups())
        tables = part.split("complex modes  ")
        row = rf"(?m)^ +(\d+) +{NUMBER} to +{NUMBER} +[-+][\d.]+ %"
        undamped = {
            int(number): Mode(float(first), float(last), (float(low), float(high)))
            for number, first, last, low, high in re.findall(
                row + rf" .*%.*%.* {NUMBER} to {NUMBER}(?:; .*)?$", tables[0].rstrip()
            )
        }
        modes = {
            int(number): Mode(float(first), float(last), (0.0, 0.0), float(ratio), float(last_ratio))
            for number, first, last, ratio, last_ratio in re.findall(row + rf" +{NUMBER} to {NUMBER}", tables[1])
        }
        case = re.search(r"(?m)^  case: (.*)$", part)
        found.append(
            Case(case[1] if case else part.partition("\n")[0], Along((k0, k1), (c0, c1)), undamped, modes, part)
        )
    return found


def one_case(texts: Sequence[str], title: str) -> Case:
    """The case with a title, of several sweeps.

    Raises
    ------
    ValueError
        There is none, or there are several.
    """
    found = [case for text in texts for case in sweep_cases(text) if title in case.title]
    if len(found) != 1:
        raise ValueError(f"{len(found)} cases are called '{title}'")
    return found[0]


@dataclass(frozen=True)
class Variant:
    """A row of `mbs variants`: differences of two laws [dB]."""

    median: float
    low: float
    high: float
    energy: float
    highest: float


def variants(text: str, sensor: str) -> dict[tuple[str, str], Variant]:
    """Rows of a sensor that `mbs variants` prints, by what is varied and its value."""
    part = re.split(r"(?m)^(?=sensor |range over)", text)
    (own,) = (each for each in part if each.startswith(f"sensor {sensor},"))
    row = rf"(?m)^  (\S+) +(\S.*?) +{NUMBER} +{NUMBER} to {NUMBER} +{NUMBER} +{NUMBER}$"
    return {(key, value): Variant(*map(float, numbers)) for key, value, *numbers in re.findall(row, own)}
