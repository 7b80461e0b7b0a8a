"""An error budget as a section of a report: bars of `ehdmaps.trade`, drawn without a picture."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

from ehdmaps.figures import COLOURS, typeset
from ehdmaps.report.chart import number
from ehdmaps.report.page import Markup, Section, sentences, tag
from ehdmaps.trade.record import BUDGET_WORDS, Bar, Mark, Trade, budget, budget_axis, budget_marks

_WIDTH, _LEFT, _RIGHT, _TOP, _FOOT = 860.0, 270.0, 20.0, 10.0, 46.0
_BAR, _GAP = 13.0, 9.0
"""Height of a bar, and room between two sources [px]."""


def budget_section(trade: Trade | str) -> Section:
    """Return the error budget of a measurement, with its sample, or why there is none.

    Parameters
    ----------
    trade : Trade or str
        The measurement, or the reason.
    """
    title = "What makes these numbers wrong, and by how much"
    if isinstance(trade, str):
        return Section("budget", title, [tag("p", typeset(f"There is no error budget: {trade}"))])
    bars = budget(trade)
    if not bars:
        return Section("budget", title, [tag("p", "Nothing that was looked at changes these numbers.")])
    drawn = tag("figure", _drawing(trade, bars), _legend(trade, bars))
    return Section("budget", title, [sentences(map(typeset, trade.frame)), drawn])


def _drawing(trade: Trade, bars: Sequence[Bar]) -> Markup:
    """The bars on one logarithmic axis."""
    low, high = budget_axis(trade, bars)
    pitch = len(trade.shown) * _BAR + _GAP
    bottom = _TOP + len(bars) * pitch

    def x(value: float) -> float:
        part = math.log(max(value, low) / low) / math.log(high / low)
        return _LEFT + part * (_WIDTH - _LEFT - _RIGHT)

    parts: list[Markup] = []
    for power in range(math.ceil(math.log10(low)), math.floor(math.log10(high)) + 1):
        at = f"{x(10.0**power):.1f}"
        parts += [
            tag("path", d=f"M{at} {_TOP:g}V{bottom:g}", class_="grid"),
            tag("text", number(10.0**power), x=at, y=bottom + 15.0, text_anchor="middle"),
        ]
    for row, bar in enumerate(bars):
        middle = _TOP + (row + 0.5) * pitch + 4.0
        parts.append(tag("text", typeset(bar.name), x=_LEFT - 12.0, y=middle, text_anchor="end"))
    for mark in budget_marks(trade, bars):
        top = _TOP + mark.row * pitch + 0.5 * _GAP + mark.place * _BAR
        parts += _bar(
            mark, x(mark.low), x(mark.high), top, mark.low < low, f"{bars[mark.row].name}, {_words(trade, mark)}"
        )
    parts += [
        tag("rect", x=_LEFT, y=_TOP, width=_WIDTH - _LEFT - _RIGHT, height=bottom - _TOP, class_="frame"),
        tag("text", BUDGET_WORDS, x=0.5 * (_LEFT + _WIDTH - _RIGHT), y=bottom + 34.0, text_anchor="middle"),
    ]
    size = f"0 0 {_WIDTH:g} {bottom + _FOOT:g}"
    return tag("svg", tag("title", "Error budget", id="budget-title"), *parts, viewBox=size, role="img",
               aria_labelledby="budget-title")  # fmt: skip


def _bar(mark: Mark, begin: float, end: float, top: float, cut: bool, words: str) -> Iterator[Markup]:
    """One bar, with the number at its end, and a triangle where it begins below the axis."""
    colour, middle = COLOURS[mark.place], top + 0.5 * _BAR
    box = {"x": f"{begin:.1f}", "y": f"{top + 1.0:.1f}", "width": f"{max(end - begin, 1.0):.1f}"}
    yield tag("rect", tag("title", typeset(words)), **box, height=_BAR - 2.0, fill=colour)
    if cut:
        tip = f"M{begin - 7.0:.1f} {middle:.1f}l8 -5v10z"
        yield tag("path", d=tip, fill=colour)
    yield tag("text", number(mark.high, 2), x=f"{end + 3.0:.1f}", y=f"{middle + 4.0:.1f}")


def _words(trade: Trade, mark: Mark) -> str:
    """Quantity, median and 95 % quantile of a bar."""
    name = trade.shown[mark.place]
    return f"{name}: {number(mark.low, 2)} to {number(mark.high, 2)} {trade.quantity(name).printed_unit}"


def _legend(trade: Trade, bars: Sequence[Bar]) -> Markup:
    """Colours of the quantities; the triangle, where there is one."""
    low, _ = budget_axis(trade, bars)
    entries = [
        (
            tag("rect", x="1", y="1", width="24", height="10", fill=COLOURS[place]),
            f"{name}, {trade.quantity(name).printed_unit}",
        )
        for place, name in enumerate(trade.shown)
    ]
    if any(mark.low < low for mark in budget_marks(trade, bars)):
        entries.append((tag("path", d="M9 6l8 -5v10z", fill="#444444"), "median below the axis"))
    return tag(
        "ul",
        *(
            tag("li", tag("svg", drawn, viewBox="0 0 26 12", class_="key", aria_hidden="true"), tag("span", words))
            for drawn, words in entries
        ),
        class_="legend",
    )
