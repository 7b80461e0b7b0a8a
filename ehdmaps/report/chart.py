"""Charts as inline SVG, and numbers as people read them.

The numbers that the script shows stand in the document beside the chart, with `DIGITS` digits; they are not measured
from the drawing. The legend is text of the page: it is printed, wraps, and holds names of any length.
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.figures import typeset
from ehdmaps.report.axis import Axis
from ehdmaps.report.page import Markup, joined, tag
from ehdmaps.units import Display


def number(value: float, digits: int = 3) -> str:
    """Return a number with some digits, without an exponent where people do not need one.

    Parameters
    ----------
    value : float
        The number.
    digits : int
        How many digits count.

    Examples
    --------
    >>> number(14123.4), number(0.01239), number(1.2e-7)
    ('14100', '0.0124', '1.2e-07')
    """
    return f"{float(f'{value:.{digits}g}'):.10g}"


def known(value: float, digits: int = 3) -> str:
    """Return a number as `number` does, or a dash where it is none or infinite.

    Parameters
    ----------
    value : float
        The number.
    digits : int
        How many digits count.

    Examples
    --------
    >>> known(1.0), known(math.inf)
    ('1', '-')
    """
    return number(value, digits) if math.isfinite(value) else "-"


def shown(display: Display, value: float, digits: int = 3) -> str:
    """Return a number with its unit.

    Parameters
    ----------
    display : Display
        Unit of the number.
    value : float
        Value in SI.
    digits : int
        How many digits count.

    Examples
    --------
    >>> from ehdmaps.units import FILM
    >>> shown(FILM, 1.23456e-6)
    '1.23 µm'
    """
    return typeset(f"{number(display.value(value), digits)} {display.unit}".rstrip())


DIGITS = 5
"""Digits of the numbers that are read off."""

LEFT, RIGHT, TOP, BOTTOM = 58.0, 18.0, 10.0, 42.0
"""Margins of a chart [px of the drawing]."""


@dataclass(frozen=True)
class Frame:
    """Size of a chart with its margins [px of the drawing]."""

    width: float = 460.0
    height: float = 300.0

    @property
    def right(self) -> float:
        """Right end of the curves."""
        return self.width - RIGHT

    @property
    def bottom(self) -> float:
        """Lower end of the curves."""
        return self.height - BOTTOM

    def across(self, axis: Axis, values: FloatArray) -> FloatArray:
        """Return the places of values on the horizontal axis [px].

        Parameters
        ----------
        axis : Axis
            The axis.
        values : ndarray
            Values in its unit.
        """
        part = axis.places(np.asarray(values, dtype=np.float64))
        return np.asarray(LEFT + part * (self.right - LEFT))

    def along(self, axis: Axis, values: FloatArray) -> FloatArray:
        """Return the places of values on the vertical axis [px].

        Parameters
        ----------
        axis : Axis
            The axis.
        values : ndarray
            Values in its unit.
        """
        part = axis.places(np.asarray(values, dtype=np.float64))
        return np.asarray(self.bottom - part * (self.bottom - TOP))


USUAL, WIDE = Frame(), Frame(820.0, 420.0)
"""Charts of which two stand side by side, and a single one."""

SEQUENCE = ("#440154", "#453781", "#33638d", "#238a8d", "#20a387", "#55b030", "#a8a800")
"""Colours of a family of curves in their order, from dark to light, each legible on white."""

GREY = "#5c5c5c"

_FAR = 4000.0
"""Places beyond a drawing at which lines are held [px]."""


@dataclass(frozen=True, eq=False)
class Curve:
    """A curve over the axis that all curves of a chart share.

    Attributes
    ----------
    label : str
        Name in the legend, where an empty one has no place; may be foreign text.
    values : ndarray, shape (n,)
        Values in the unit of the vertical axis; NaN where there is none.
    colour : str
        Colour of the line.
    dash : str
        Dashes as SVG writes them; empty for none.
    width : float
        Width of the line [px].
    read : bool
        Whether the cursor reads it off; it needs a label then.
    note : str
        Text at its last place inside the chart where no other one is.
    """

    label: str
    values: FloatArray
    colour: str
    dash: str = ""
    width: float = 1.6
    read: bool = True
    note: str = ""


@dataclass(frozen=True, eq=False)
class Points:
    """Marks at places of a chart.

    Attributes
    ----------
    label : str
        Their name in the legend; none if empty.
    across, along : ndarray, shape (n,)
        Values on the horizontal and on the vertical axis; NaN on the vertical one puts a mark at its low end.
    shape : {"dot", "ring", "cross", "triangle", "diamond"}
        What marks them.
    colour : str
        Colour of the marks.
    """

    label: str
    across: FloatArray
    along: FloatArray
    shape: str
    colour: str


@dataclass(frozen=True)
class Shade:
    """A range of the horizontal axis behind the curves: its label, its ends."""

    label: str
    begin: float
    end: float


@dataclass(frozen=True, eq=False)
class Chart:
    """A chart.

    Attributes
    ----------
    name : str
        Name in the document: letters, digits and hyphens, the only one of its kind.
    title, description : str
        What it shows, and what that says.
    x, y : Axis
        Both axes of the chart.
    places : ndarray, shape (n,)
        Values on the horizontal axis at which the curves are known, rising.
    curves : sequence of Curve
        The curves.
    points : sequence of Points
        Marks at single places.
    shades : sequence of Shade
        Ranges that are shaded.
    levels : sequence of (float, str)
        Horizontal lines with their names.
    behind : Markup or None
        What is drawn first, in the places of the frame.
    frame : Frame
        Size of the drawing.
    """

    name: str
    title: str
    description: str
    x: Axis
    y: Axis
    places: FloatArray
    curves: Sequence[Curve]
    points: Sequence[Points] = ()
    shades: Sequence[Shade] = ()
    levels: Sequence[tuple[float, str]] = ()
    behind: Markup | None = None
    frame: Frame = USUAL


_SHAPES = {
    "dot": "h0",
    "ring": "m-3.5 0a3.5 3.5 0 1 0 7 0a3.5 3.5 0 1 0 -7 0",
    "cross": "m-3.5 -3.5l7 7m-7 0l7 -7",
    "triangle": "m0 -3.2l3 5.4h-6z",
    "diamond": "m0 -6l5 6l-5 6l-5 -6z",
}


def figure(chart: Chart) -> Markup:
    """Return the chart as a figure with caption, drawing, legend, words and the numbers for the cursor.

    Parameters
    ----------
    chart : Chart
        The chart.
    """
    readable = [curve for curve in chart.curves if curve.read]
    return tag(
        "figure",
        tag("figcaption", chart.title),
        drawing(chart),
        tag("p", f"{chart.x.label}: ", tag("output", "-"), f" {chart.x.unit}", class_="cursor") if readable else None,
        _legend(chart),
        tag("p", chart.description, class_="says") if chart.description else None,
        _data(chart, readable) if readable and chart.places.size else None,
        class_="chart",
        id=chart.name,
    )


def drawing(chart: Chart) -> Markup:
    """Return the drawing alone.

    Parameters
    ----------
    chart : Chart
        The chart.
    """
    inside = f"{chart.name}-inside"
    across, along = chart.frame.right - LEFT, chart.frame.bottom - TOP
    frame = {"x": LEFT, "y": TOP, "width": across, "height": along}
    known = any(np.isfinite(chart.frame.along(chart.y, curve.values)).any() for curve in chart.curves) or any(
        points.across.size for points in chart.points
    )
    parts = [
        tag("title", chart.title, id=f"{chart.name}-title"),
        tag("desc", chart.description or chart.title, id=f"{chart.name}-desc"),
        tag("defs", tag("clipPath", tag("rect", **frame), id=inside)),
        tag("g", chart.behind, clip_path=f"url(#{inside})") if chart.behind else None,
        *(_shade(chart, shade) for shade in chart.shades),
        *_grid(chart),
        tag(
            "g",
            *(_level(chart, value, words) for value, words in chart.levels),
            *(_line(chart, curve) for curve in chart.curves),
            clip_path=f"url(#{inside})",
        ),
        *(_marks(chart, points) for points in chart.points),
        *_notes(chart),
        tag("rect", class_="frame", **frame),
        tag("path", d=f"M{LEFT:g} {TOP:g}v{along:g}", class_="line"),
        None if known else tag("text", "no values", x=LEFT + across / 2.0, y=TOP + along / 2.0, text_anchor="middle"),
    ]
    return tag(
        "svg",
        *parts,
        viewBox=f"0 0 {chart.frame.width:g} {chart.frame.height:g}",
        role="img",
        tabindex="0",
        aria_labelledby=f"{chart.name}-title {chart.name}-desc",
    )


def _grid(chart: Chart) -> list[Markup]:
    """Lines of the grid, the numbers beside them, and the titles of both axes."""
    bottom, right = chart.frame.bottom, chart.frame.right
    parts, lines = [], []
    for value, text in chart.x.ticks:
        place = float(chart.frame.across(chart.x, np.array([value]))[0])
        lines.append(f"M{place:.1f} {TOP:g}V{bottom:g}")
        parts.append(tag("text", text, x=f"{place:.1f}", y=bottom + 15.0, text_anchor="middle"))
    for value, text in chart.y.ticks:
        place = float(chart.frame.along(chart.y, np.array([value]))[0])
        lines.append(f"M{LEFT:g} {place:.1f}H{right:g}")
        parts.append(tag("text", text, x=LEFT - 5.0, y=f"{place + 3.5:.1f}", text_anchor="end"))
    middle = TOP + (bottom - TOP) / 2.0
    return [
        tag("path", d="".join(lines), class_="grid"),
        *parts,
        tag(
            "text", chart.x.title, x=LEFT + (right - LEFT) / 2.0, y=chart.frame.height - 8.0, text_anchor="middle",
            class_="axis",
        ),
        tag(
            "text", chart.y.title, transform=f"translate(13 {middle:g}) rotate(-90)", text_anchor="middle",
            class_="axis",
        ),
    ]  # fmt: skip


def path_of(across: FloatArray, along: FloatArray) -> str:
    """Return the path of a line through points [px]; it is interrupted where one is not finite.

    Parameters
    ----------
    across, along : ndarray, shape (n,)
        The points; far beyond a drawing they are held.
    """
    pieces, pen = [], False
    for x, y in zip(np.clip(across, -_FAR, _FAR).tolist(), np.clip(along, -_FAR, _FAR).tolist(), strict=True):
        if not (np.isfinite(x) and np.isfinite(y)):
            pen = False
            continue
        pieces.append(f"{'L' if pen else 'M'}{x:.1f} {y:.1f}")
        pen = True
    return "".join(pieces)


def _line(chart: Chart, curve: Curve) -> Markup | None:
    """A curve."""
    path = path_of(chart.frame.across(chart.x, chart.places), chart.frame.along(chart.y, curve.values))
    if not path:
        return None
    dash = curve.dash or None
    return tag("path", d=path, stroke=curve.colour, stroke_width=curve.width, stroke_dasharray=dash, class_="curve")


_LETTER, _TALL = 6.2, 12.0
"""Width of a letter of a note, and height of its line [px]."""

_TRIED, _LOOKED_AT = 101, 13
"""Places along a curve at which its text is tried, and along a text at which curves are looked at."""


def _notes(chart: Chart) -> list[Markup]:
    """Texts of the curves, each at its last place inside the chart where neither another text nor a curve or mark is.

    Places are tried from the end of a curve back to its begin, above the line, then below; where another text leaves
    none free the text is left to the legend, and where only curves do it lies upon them.
    """
    taken: list[tuple[float, float, float]] = []
    parts = []
    for curve in chart.curves:
        if not curve.note:
            continue
        free = [place for place in _beside(chart, curve) if not _upon(place, taken)]
        if not free:
            continue
        left, right, row = next((place for place in free if not _crossed(chart, curve, place)), free[0])
        taken.append((left, right, row))
        parts.append(tag("text", curve.note, x=f"{right:.1f}", y=f"{row:.1f}", text_anchor="end", class_="note"))
    return parts


def _beside(chart: Chart, curve: Curve) -> Iterator[tuple[float, float, float]]:
    """Places of the text of a curve, last first: its left and right end and its base line [px]."""
    width = _LETTER * len(curve.note)
    known = np.isfinite(curve.values)
    if not known.any():
        return
    # finely, for a curve of few places leaves its chart between two of them
    places = np.linspace(chart.places[known][0], chart.places[known][-1], _TRIED)
    values = np.interp(places, chart.places[known], curve.values[known])
    inside = (values >= chart.y.low) & (values <= chart.y.high)
    across, along = chart.frame.across(chart.x, places[inside]), chart.frame.along(chart.y, values[inside])
    for x, y in zip(across[::-1].tolist(), along[::-1].tolist(), strict=True):
        if x - 3.0 - width >= LEFT:
            yield x - 3.0 - width, x - 3.0, max(y - 4.0, TOP + 10.0)
        if x + 3.0 + width <= chart.frame.right and y + _TALL + 2.0 <= chart.frame.bottom:
            yield x + 3.0, x + 3.0 + width, y + _TALL


def _upon(place: tuple[float, float, float], taken: Sequence[tuple[float, float, float]]) -> bool:
    """Tell whether a text lies upon another."""
    left, right, row = place
    return any(left <= end and right >= begin and abs(row - line) <= _TALL for begin, end, line in taken)


def _crossed(chart: Chart, own: Curve, place: tuple[float, float, float]) -> bool:
    """Tell whether another curve, or a mark, runs through a text."""
    left, right, row = place
    at = np.linspace(left, right, _LOOKED_AT)
    across = chart.frame.across(chart.x, chart.places)
    for curve in chart.curves:
        along = chart.frame.along(chart.y, curve.values)
        there = np.interp(at, across, along, np.nan, np.nan)
        if curve is not own and np.any((there > row - _TALL) & (there < row + 3.0)):
            return True
    for points in chart.points:
        x, y = chart.frame.across(chart.x, points.across), chart.frame.along(chart.y, points.along)
        if np.any((x > left - 5.0) & (x < right + 5.0) & (y > row - _TALL - 4.0) & (y < row + 6.0)):
            return True
    return False


def _marks(chart: Chart, points: Points) -> Markup | None:
    """Marks of one kind, as one path; those beyond the axes are left out."""
    across, along = chart.frame.across(chart.x, points.across), chart.frame.along(chart.y, points.along)
    along = np.where(np.isfinite(along), along, chart.frame.bottom - 6.0)
    inside = np.isfinite(across) & (across > LEFT - 1.0) & (across < chart.frame.right + 1.0)
    inside &= (along > TOP - 1.0) & (along < chart.frame.bottom + 1.0)
    path = "".join(
        f"M{x:.1f} {y:.1f}{_SHAPES[points.shape]}"
        for x, y in zip(across[inside].tolist(), along[inside].tolist(), strict=True)
    )
    return tag("path", d=path, stroke=points.colour, class_=points.shape) if path else None


def _level(chart: Chart, value: float, words: str) -> Markup:
    """A horizontal line with its name."""
    place = float(chart.frame.along(chart.y, np.array([value]))[0])
    return joined(
        tag("path", d=f"M{LEFT:g} {place:.1f}H{chart.frame.right:g}", class_="level"),
        tag("text", words, x=chart.frame.right - 4.0, y=f"{place - 4.0:.1f}", text_anchor="end", class_="level"),
    )


def _shade(chart: Chart, shade: Shade) -> Markup:
    """A shaded range."""
    ends = np.clip(chart.frame.across(chart.x, np.array([shade.begin, shade.end])), LEFT, chart.frame.right)
    width = max(float(ends[1] - ends[0]), 1.0)
    return tag("rect", x=f"{ends[0]:.1f}", y=TOP, width=f"{width:.1f}", height=chart.frame.bottom - TOP, class_="shade")


def _legend(chart: Chart) -> Markup | None:
    """Legend of what is drawn, each with its name, and a place for the value at the cursor."""
    entries = [
        _entry(
            tag("path", d="M1 6H25", stroke=curve.colour, stroke_width=max(curve.width, 1.6),
                stroke_dasharray=curve.dash or None, class_="curve"),
            curve.label, tag("output") if curve.read else None,
        )
        for curve in chart.curves
        if curve.label
    ]  # fmt: skip
    named = {points.label: points for points in chart.points if points.label}
    entries += [
        _entry(tag("path", d=f"M13 6{_SHAPES[points.shape]}", stroke=points.colour, class_=points.shape), label)
        for label, points in named.items()
    ]
    entries += [
        _entry(tag("rect", x="1", y="1", width="24", height="10", class_="shade"), shade.label)
        for shade in chart.shades
    ]
    return tag("ul", *entries, class_="legend") if entries else None


def _entry(drawn: Markup, label: str, value: Markup | None = None) -> Markup:
    """One line of a legend."""
    return tag(
        "li", tag("svg", drawn, viewBox="0 0 26 12", class_="key", aria_hidden="true"), tag("span", label), value
    )


def _data(chart: Chart, curves: Sequence[Curve]) -> Markup:
    """The numbers that the cursor reads off, as a block that no browser executes."""
    record = {
        "x": {
            "values": _numbers(chart.places),
            "pixels": [round(p, 1) for p in chart.frame.across(chart.x, chart.places).tolist()],
        },
        "frame": [LEFT, TOP, chart.frame.right, chart.frame.bottom],
        "unit": chart.y.unit,
        "curves": [_numbers(curve.values) for curve in curves],
    }
    # A number has no "<", a unit of ours neither; nothing may end the block early all the same.
    text = json.dumps(record, separators=(",", ":"), allow_nan=False).replace("<", "\\u003c")
    return Markup(f'<script type="application/json">{text}</script>')


def _numbers(values: FloatArray) -> list[float | None]:
    """Numbers with some digits; None where there is none."""
    numbers: list[float | None] = []
    for value in values.tolist():
        short = float(f"{value:.{DIGITS}g}") if np.isfinite(value) else None
        numbers.append(int(short) if short is not None and short.is_integer() and abs(short) < 1e15 else short)
    return numbers
