"""Marked blocks of the pages: where figures stand, the commands they come from, and number for number comparison.

A marker is a comment on a line of its own, <!-- figures NAME -->. It opens a block that ends at
<!-- end of figures -->. Rows of a table have a tag within the line, <!-- row NAME -->, and their block is the rest of
that line. `figures.toml` has a table for each name: the recipe (left out: the name, up to a slash), the weight and the
commands. The weight is quick (seconds), long (a minute and more) or openfoam (needs the built ehlFoam).
"""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

MARKER = re.compile(r"(?m)^<!-- figures ([\w-]+) -->\n")
TAG = re.compile(r"<!-- row ([\w/-]+) -->")
END = "<!-- end of figures -->"
WEIGHTS = ("quick", "long", "openfoam")
NUMBER = re.compile(r"(?:(?<![\w.\])])[-+])?(?<![\w.])\d+(?:\.\d+)?(?:e[-+]?\d+)?(?![\w.]*_)")
FIGURES = tomllib.loads((Path(__file__).parent / "figures.toml").read_text(encoding="utf-8"))
"""Recipe, weight and commands of each name."""

SPAN = re.compile(r"`[^`\n]*`|\]\([^)]*\)|\*\*")


@dataclass(frozen=True)
class Given:
    """A number that is no figure: it is given to the command, or is quoted; it must stand on the page as it is."""

    text: str


@dataclass(frozen=True)
class Time:
    """A time or a ratio of times: shown anew by --write, and exempt from comparison."""

    value: float


Figure = Given | Time | float


def given(text: str) -> list[Figure]:
    """Numbers that are no figures, separated by blanks."""
    return [Given(part) for part in text.split()]


def significant(value: float, digits: int) -> float:
    """A value rounded to so many digits, as prose does."""
    return float(f"{value:.{digits - 1}e}")


@dataclass(frozen=True)
class Block:
    """A marked block of a page; `begin` and `end` are offsets of its text in that of the page."""

    page: str
    name: str
    recipe: str
    weight: str
    commands: tuple[str, ...]
    text: str
    begin: int
    end: int
    line: int

    @property
    def place(self) -> str:
        """Page, line and name."""
        return f"{self.page}:{self.line} {self.name}"


@dataclass(frozen=True)
class Difference:
    """A number of a page beside the one that its command gives now."""

    shown: str
    found: str


@dataclass(frozen=True)
class Compared:
    """How many numbers of a block are figures, how many of them are equal, and which are not; times are exempt."""

    figures: int
    times: int
    different: tuple[Difference, ...]
    problem: str = ""

    @property
    def equal(self) -> int:
        """Figures that are as shown."""
        return self.figures - len(self.different)


def blocks(page: str, text: str, origins: Mapping[str, Mapping[str, Any]] = FIGURES) -> list[Block]:
    """Find the marked blocks of a page, in its order.

    Raises
    ------
    ValueError
        A marker is not closed, or its name has no table of recipe, weight and commands; a comment looks like a marker
        and is none.
    """
    found = []
    for mark in MARKER.finditer(text):
        end = text.find(END, mark.end())
        if end < 0 or "<!-- figures" in text[mark.end() : end]:
            raise ValueError(f"{page}:{line_of(text, mark.start())}: the marker has no '{END}'")
        found.append(_block(page, text, mark[1], origins, (mark.end(), end)))
    if text.count("<!-- figures") != len(found):
        raise ValueError(f"{page}: {text.count('<!-- figures')} comments '<!-- figures', not all of them markers")
    for tag in TAG.finditer(text):
        found.append(_block(page, text, tag[1], origins, (tag.end(), text.find("\n", tag.end()))))
    return sorted(found, key=lambda block: block.begin)


def line_of(text: str, at: int) -> int:
    """Line of an offset, from 1."""
    return text.count("\n", 0, at) + 1


def _block(page: str, text: str, name: str, origins: Mapping[str, Mapping[str, Any]], span: tuple[int, int]) -> Block:
    """The block of a marker."""
    begin, end = span
    line = line_of(text, begin)
    origin = origins.get(name)
    if origin is None:
        raise ValueError(f"{page}:{line}: figures.toml has no table '{name}'")
    recipe = str(origin.get("recipe", name.partition("/")[0]))
    return Block(page, name, recipe, origin["weight"], tuple(origin["commands"]), text[begin:end], begin, end, line)


def numbers(text: str) -> list[re.Match[str]]:
    """Numbers of a text; in text outside fences, those of code spans, links and names are left out."""
    if not text.lstrip().startswith("```"):
        text = SPAN.sub(lambda found: "~" * len(found[0]), text)
    return list(NUMBER.finditer(text))


def shown_as(value: float, like: str) -> str:
    """A value with the digits of a number that is shown."""
    mantissa, _, exponent = like.lstrip("+-").partition("e")
    digits = len(mantissa.partition(".")[2])
    if exponent:
        text = re.sub(r"e([-+])0*(\d)", lambda found: f"e{found[1].replace('+', '')}{found[2]}", f"{value:.{digits}e}")
    else:
        text = f"{value:.{digits}f}"
    if like.startswith("+") and not text.startswith("-"):
        text = f"+{text}"
    return text.lstrip("-") if float(text) == 0.0 else text


def compared_in_order(text: str, figures: Sequence[Figure]) -> Compared:
    """Compare the numbers of a text with figures, one after the other."""
    found = numbers(text)
    times = sum(isinstance(figure, Time) for figure in figures)
    count = sum(isinstance(figure, float | int) for figure in figures)
    if len(found) != len(figures):
        shown = " ".join(match[0] for match in found)
        return Compared(
            count, times, (), f"the page has {len(found)} numbers, the recipe {len(figures)}: {shown} | {figures}"
        )
    different = []
    for match, figure in zip(found, figures, strict=True):
        expected = _expected(match[0], figure)
        if expected != match[0]:
            different.append(Difference(match[0], expected))
    return Compared(count, times, tuple(different))


def _expected(shown: str, figure: Figure) -> str:
    """What is to stand in a number's place; times stand as they are."""
    if isinstance(figure, Given):
        return figure.text
    return shown if isinstance(figure, Time) else shown_as(figure, shown)


def with_figures(text: str, figures: Sequence[Figure]) -> str:
    """A text with its numbers replaced, one after the other; times too."""
    parts, last = [], 0
    for match, figure in zip(numbers(text), figures, strict=True):
        value = figure.value if isinstance(figure, Time) else figure
        parts += [text[last : match.start()], _expected(match[0], value)]
        last = match.end()
    return "".join([*parts, text[last:]])


def compared_texts(shown: str, found: str, times: Iterable[re.Pattern[str]] = ()) -> Compared:
    """Compare two texts word for word; numbers within a match of `times` are exempt."""
    first, second = ([line.rstrip() for line in text.strip("\n").splitlines()] for text in (shown, found))
    figures = exempt = 0
    different: list[Difference] = []
    problem = ""
    for one, two in zip(first, second, strict=False):
        a, b = (list(NUMBER.finditer(line)) for line in (one, two))
        spans = [match.span(match.lastindex or 0) for pattern in times for match in pattern.finditer(one)]
        if NUMBER.sub("", one).split() != NUMBER.sub("", two).split() or len(a) != len(b):
            different.append(Difference(one.strip(), two.strip()))
            figures += 1
            continue
        for left, right in zip(a, b, strict=True):
            if any(begin <= left.start() < end for begin, end in spans):
                exempt += 1
                continue
            figures += 1
            if left[0] != right[0]:
                different.append(Difference(left[0], right[0]))
    if len(first) != len(second):
        problem = f"{len(first)} lines are shown, {len(second)} found"
    return Compared(figures, exempt, tuple(different), problem)
