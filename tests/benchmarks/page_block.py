"""Marked blocks of the pages: where figures stand, the commands they come from, and number for number comparison.

A marker is a comment on a line of its own, <!-- figures RECIPE, WEIGHT: `COMMAND`; `COMMAND` -->. It opens a block that
ends at <!-- end of figures -->. Rows of a table have a tag within the line, <!-- row NAME -->, and their block is the
rest of that line; one comment of the page says what they come from, a row a line: <!-- figures of rows, and below it
NAME, WEIGHT: `COMMAND`. (Comments within a line must not hold two hyphens, which options of commands begin with.) The
recipe of a row is its name up to a slash. WEIGHT is quick (seconds), long (a minute and more) or openfoam (needs the
built ehlFoam).
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

MARKER = re.compile(r"(?m)^<!-- figures ([\w-]+(?:\[[-\d:]*\])?), (quick|long|openfoam): (.*?) -->\n", re.DOTALL)
ROWS = re.compile(r"(?m)^<!-- figures of rows\n(.*?)^-->$", re.DOTALL)
ORIGIN = re.compile(r"([\w/-]+), (quick|long|openfoam): (.*)")
TAG = re.compile(r"<!-- row ([\w/-]+) -->")
END = "<!-- end of figures -->"
WEIGHTS = ("quick", "long", "openfoam")
NUMBER = re.compile(r"(?:(?<![\w.\])])[-+])?(?<![\w.])\d+(?:\.\d+)?(?:e[-+]?\d+)?(?![\w.]*_)")
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
    recipe: str
    weight: str
    commands: tuple[str, ...]
    text: str
    begin: int
    end: int
    line: int

    @property
    def name(self) -> str:
        """Page, line and recipe."""
        return f"{self.page}:{self.line} {self.recipe}"


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


def blocks(page: str, text: str) -> list[Block]:
    """Find the marked blocks of a page, in its order.

    Raises
    ------
    ValueError
        A marker is not closed, or names no command; a row has no line that says what it comes from, or a line no row;
        a comment looks like a marker and is none.
    """
    found = []
    for mark in MARKER.finditer(text):
        end = text.find(END, mark.end())
        if end < 0 or "<!-- figures " in text[mark.end() : end]:
            raise ValueError(f"{page}:{line_of(text, mark.start())}: the marker has no '{END}'")
        found.append(_block(page, text, (mark[1], mark[2], mark[3]), mark.end(), end))
    lists = list(ROWS.finditer(text))
    origins = {match[1]: match for rows in lists for match in map(ORIGIN.fullmatch, rows[1].splitlines()) if match}
    tags = {tag[1]: tag for tag in TAG.finditer(text)}
    if sorted(tags) != sorted(origins):
        raise ValueError(f"{page}: rows {sorted(tags)}, but the list of their commands has {sorted(origins)}")
    for name, tag in tags.items():
        origin = origins[name]
        found.append(_block(page, text, (name, origin[2], origin[3]), tag.end(), text.find("\n", tag.end())))
    if text.count("<!-- figures ") != len(found) - len(tags) + len(lists):
        raise ValueError(f"{page}: {text.count('<!-- figures ')} comments '<!-- figures', not all of them markers")
    return sorted(found, key=lambda block: block.begin)


def line_of(text: str, at: int) -> int:
    """Line of an offset, from 1."""
    return text.count("\n", 0, at) + 1


def _block(page: str, text: str, origin: tuple[str, str, str], begin: int, end: int) -> Block:
    """A block of a marker's words: recipe, weight and commands in backticks."""
    commands = tuple(" ".join(command.split()) for command in re.findall(r"`([^`]+)`", origin[2]))
    if not commands:
        raise ValueError(f"{page}: the marker '{origin[0]}' names no command in backticks")
    return Block(page, origin[0], origin[1], commands, text[begin:end], begin, end, line_of(text, begin))


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
