"""A measurement of speed against accuracy as one picture: the error budget; cost and error of every choice."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from ehdmaps.figures import COLOURS, typeset, write_heading
from ehdmaps.trade.record import BUDGET_WORDS, Bar, Choice, Judged, Trade, budget, budget_axis, budget_marks
from mbs.laboratory.tradeoff.answer import number

_COLUMNS, _PANEL = 2, (4.0, 3.2)
_KEY, _KEY_LINE = 3.4, 0.155
"""Width of the key, and height of one of its lines [inch]."""
_WORDS = {"1": "relative error", "dB": "error [dB]"}


def trade_figure(trade: Trade, everything: bool = False) -> Figure:
    """Draw the error budget: bars of what is wrong where a source is left out; of measurements without one all choices.

    Parameters
    ----------
    trade : Trade
        The measurement.
    everything : bool
        Whether cost and error of every choice are drawn in its place.
    """
    bars = budget(trade)
    if everything or not bars:
        return choices_figure(trade)
    figure = Figure(figsize=(8.0, max(0.42, 0.16 * len(trade.shown)) * len(bars) + 1.6), layout="constrained")
    write_heading(figure, typeset("\n".join([trade.title, *trade.frame[:1]])), 8)
    budget_panel(figure.add_subplot(), trade, bars)
    return figure


def budget_panel(panel: Axes, trade: Trade, bars: Sequence[Bar]) -> None:
    """Draw an error budget: a bar from the median to 95 % of the points for each source and quantity, on one log axis.

    A number is the end of its bar. A bar whose median lies below the axis begins with a triangle.

    Parameters
    ----------
    panel : Axes
        Axes to draw on.
    trade : Trade
        The measurement.
    bars : sequence of Bar
        Lines of the budget, the largest first.
    """
    wide = 0.8 / len(trade.shown)
    left, right = budget_axis(trade, bars)
    for mark in budget_marks(trade, bars):
        y = mark.row + (mark.place - 0.5 * (len(trade.shown) - 1)) * wide
        low, colour = max(mark.low, left), COLOURS[mark.place]
        # with an edge, as the bar of one point has no width
        panel.barh(y, mark.high - low, wide * 0.85, left=low, color=colour, edgecolor=colour, lw=1.0)
        panel.annotate(
            number(mark.high), (mark.high, y), xytext=(2, 0), textcoords="offset points", fontsize=6.5, va="center"
        )
        if mark.low < left:
            panel.plot(left, y, "<", color=colour, ms=5, clip_on=False)
    handles: list[Patch | Line2D] = [
        Patch(color=COLOURS[place], label=f"{name} [{trade.quantity(name).printed_unit}]")
        for place, name in enumerate(trade.shown)
    ]
    if any(mark.low < left for mark in budget_marks(trade, bars)):
        handles.append(Line2D([], [], ls="", marker="<", color="0.3", ms=5, label="median below the axis"))
    panel.legend(handles=handles, fontsize=7, loc="lower right")
    panel.set_xscale("log")
    panel.set_xlim(left, right)
    panel.set_yticks(range(len(bars)), [typeset(_budget_name(bar)) for bar in bars], fontsize=7.5)
    panel.invert_yaxis()
    panel.set_xlabel(BUDGET_WORDS, fontsize=7.5)
    panel.tick_params(axis="x", labelsize=7)
    panel.grid(axis="x", lw=0.3, which="major")
    panel.set_axisbelow(True)


def _budget_name(bar: Bar) -> str:
    """Source with what it costs."""
    return f"{bar.name}\n(costs x {number(bar.cost)})" if math.isfinite(bar.cost) else bar.name


def choices_figure(trade: Trade) -> Figure:
    """Draw cost and median error of each choice, a panel a quantity; a bar goes up to the 95 % quantile.

    Parameters
    ----------
    trade : Trade
        The measurement. Choices without an error above zero have no place on a logarithmic axis: the key says so.
    """
    groups = list(dict.fromkeys(choice.group for choice in trade.choices))
    judged = [entry for entry in trade.judged if any(_shown(choice, entry) for choice in trade.choices)]
    rows = max(math.ceil(len(judged) / _COLUMNS), 1)
    lines = len(trade.choices) + len(groups) + 3
    height = max(rows * _PANEL[1], lines * _KEY_LINE) + 0.6
    figure = Figure(figsize=(_COLUMNS * _PANEL[0] + _KEY, height), layout="constrained")
    write_heading(figure, typeset(f"{trade.title}\nreference: {trade.reference}"), 8)
    grid = figure.add_gridspec(rows, _COLUMNS + 1, width_ratios=[*[_PANEL[0]] * _COLUMNS, _KEY])
    for place, entry in enumerate(judged):
        panel = figure.add_subplot(grid[place // _COLUMNS, place % _COLUMNS])
        _panel(panel, trade, entry, groups)
    _key(figure.add_subplot(grid[:, _COLUMNS]), trade, groups, judged)
    return figure


def _panel(panel: Axes, trade: Trade, judged: Judged, groups: list[str]) -> None:
    """Draw the choices of one quantity, and which of them no other one with the same reference beats."""
    places: dict[str, list[tuple[float, float]]] = {}
    for index, choice in enumerate(trade.choices):
        if not _shown(choice, judged):
            continue
        summary = choice.errors[judged.name]
        colour = COLOURS[groups.index(choice.group) % len(COLOURS)]
        high = summary.high if math.isfinite(summary.high) else summary.median
        panel.plot([choice.seconds] * 2, [summary.median, max(high, summary.median)], color=colour, lw=0.8, alpha=0.6)
        panel.plot(
            choice.seconds,
            summary.median,
            "D" if choice.default else "o",
            color=colour,
            ms=5.5 if choice.default else 4.0,
        )
        panel.annotate(
            str(index + 1), (choice.seconds, summary.median), xytext=(4, 2), textcoords="offset points", fontsize=6.5
        )
        places.setdefault(choice.reference, []).append((choice.seconds, summary.median))
    # errors that are relative to one thing do not beat those that are relative to another
    for points in places.values():
        best = front([x for x, _ in points], [y for _, y in points])
        panel.plot([points[i][0] for i in best], [points[i][1] for i in best], color="0.5", lw=0.9, ls="--", zorder=0)
    panel.set_xscale("log")
    panel.set_yscale("log")
    panel.margins(0.12)
    panel.set_title(judged.name, fontsize=8)
    panel.set_xlabel(trade.cost, fontsize=7)
    panel.set_ylabel(_WORDS[judged.unit], fontsize=7)
    panel.tick_params(labelsize=6.5, which="both")
    panel.grid(lw=0.3, which="major")


def front(cost: Sequence[float], error: Sequence[float]) -> tuple[int, ...]:
    """Indices of the choices that no other one beats, by rising cost.

    Parameters
    ----------
    cost : sequence of float
        Cost of each choice.
    error : sequence of float
        Error of each choice; one whose cost or error is not finite is never on the front.

    Returns
    -------
    tuple of int
        Each further one costs more than the one before, and has a smaller error.

    Examples
    --------
    >>> front([1.0, 2.0, 3.0, 2.5], [0.5, 0.1, 0.2, math.nan])
    (0, 1)
    """
    known = [index for index in range(len(cost)) if math.isfinite(cost[index]) and math.isfinite(error[index])]
    best: list[int] = []
    for index in sorted(known, key=lambda index: (cost[index], error[index])):
        if not best or error[index] < error[best[-1]]:
            best.append(index)
    return tuple(best)


def _key(panel: Axes, trade: Trade, groups: list[str], judged: list[Judged]) -> None:
    """List the choices by their numbers."""
    panel.set_axis_off()
    texts: list[tuple[str, dict[str, Any]]] = []
    for group in groups:
        colour = COLOURS[groups.index(group) % len(COLOURS)]
        texts.append((group, {"color": colour, "weight": "bold"}))
        for index, choice in enumerate(trade.choices):
            if choice.group == group:
                seen = any(_shown(choice, entry) for entry in judged)
                words = f"{index + 1}  {choice.label}" + ("" if seen else " (no error above zero)")
                texts.append((words, {"color": colour}))
    texts += [
        ("point: median, bar: up to 95 %", {"color": "0.3"}),
        ("diamond: used where nothing is said", {"color": "0.3"}),
        ("broken line: no other choice is better in both", {"color": "0.3"}),
    ]
    for line, (words, style) in enumerate(texts):
        panel.annotate(typeset(words), (0.0, 1.0), xycoords="axes fraction", xytext=(0, -11.0 * (line + 1)),
                       textcoords="offset points", fontsize=7, **style)  # fmt: skip


def _shown(choice: Choice, judged: Judged) -> bool:
    """Tell whether a choice has a place on logarithmic axes."""
    summary = choice.errors.get(judged.name)
    return summary is not None and summary.points > 0 and summary.median > 0.0 and 0.0 < choice.seconds < math.inf
