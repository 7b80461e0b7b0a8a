"""Waterfalls: levels over speed and frequency as a map and as spectra one behind the other, with lines of orders."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.patheffects import withStroke

from ehdmaps.arrays import FloatArray
from ehdmaps.figures import typeset, write_heading
from ehdmaps.units import RPM
from mbs.output.page import frequency_scale

MOST_CASES = 4
"""That are drawn, one below the other."""

_WIDTH, _ROW, _HEAD = 10.0, 3.9, 0.6
_SPECTRA = 36
"""Spectra behind one another: more hide each other."""

_RANGE, _LEAST_RANGE = 60.0, 20.0
"""Of the colours, and of the height of a spectrum [dB]."""

_FAINTEST = 20.0
"""Percentile of the levels where the colours begin, if their range is less."""

_HEIGHT = 5.0
"""Height of the whole range, in distances between spectra."""

_MAP = "viridis"
_DOTS = (0, (1.0, 3.0))
_LEAST_APART = 0.05
"""Between two names of orders, as a part of the axis."""


_KILO = 2000.0
"""Highest frequency that is still shown in Hz."""


@dataclass(frozen=True, eq=False)
class Waterfall:
    """Levels over speed and frequency.

    Attributes
    ----------
    label : str
        What they are of.
    speeds : array, shape (speeds,)
        Rising or falling [rad/s].
    frequencies : array, shape (frequencies,)
        Rising [Hz].
    level : array, shape (speeds, frequencies)
        [dB].
    """

    label: str
    speeds: FloatArray
    frequencies: FloatArray
    level: FloatArray


class _Range(NamedTuple):
    """Range of the colours [dB]."""

    low: float
    high: float

    @property
    def span(self) -> float:
        """Distance of both ends [dB]."""
        return self.high - self.low

    @property
    def norm(self) -> Normalize:
        """The same for matplotlib."""
        return Normalize(self.low, self.high)


def waterfall_figure(
    title: str, cases: Sequence[Waterfall], unit: str, orders: Sequence[tuple[float, str]] = ()
) -> Figure:
    """Draw up to `MOST_CASES` cases: on the left the map, on the right spectra over their speeds.

    Parameters
    ----------
    title : str
        Heading of the page.
    cases : sequence of Waterfall
        One a law.
    unit : str
        What the levels are of, with the reference.
    orders : sequence of (float, str)
        Orders, periods a turn of the system, with their names.
    """
    shown = cases[:MOST_CASES]
    figure = Figure(figsize=(_WIDTH, _ROW * len(shown) + _HEAD), layout="constrained")
    write_heading(figure, title, 9)
    axes = figure.subplots(len(shown), 2, squeeze=False, width_ratios=(1.0, 1.15))
    colours = _colours(shown)
    for (left, right), case in zip(axes, shown, strict=True):
        _map(left, case, colours, orders)
        _spectra(right, case, colours, orders)
        left.set_title(typeset(case.label), fontsize=8.5)
        right.set_title(f"height of a spectrum: {colours.span:.0f} dB over {_HEIGHT:g} spacings", fontsize=7.5)
        for panel in (left, right):
            panel.tick_params(labelsize=7.5)
    bar = figure.colorbar(
        ScalarMappable(colours.norm, _MAP), ax=list(axes[:, 0]), location="left", pad=0.02, aspect=28, extend="both"
    )
    bar.set_label(unit, fontsize=8)
    bar.ax.tick_params(labelsize=7.5)
    return figure


def _colours(cases: Sequence[Waterfall]) -> _Range:
    """One scale for all cases, from the faint parts of the loudest one."""
    loudest = max(cases, key=lambda case: float(case.level.max()))
    top = 5.0 * np.ceil(float(loudest.level.max()) / 5.0)
    bottom = 5.0 * np.floor(max(float(np.percentile(loudest.level, _FAINTEST)), top - _RANGE) / 5.0)
    return _Range(float(min(bottom, top - _LEAST_RANGE)), float(top))


def _unit(case: Waterfall) -> tuple[float, str]:
    """Factor and unit of the frequencies."""
    return (
        (1e-3, "kHz") if case.frequencies[-1] > _KILO and frequency_scale(case.frequencies) == "linear" else (1.0, "Hz")
    )


def _map(panel: Axes, case: Waterfall, colours: _Range, orders: Sequence[tuple[float, str]]) -> None:
    """Levels as colours."""
    factor, unit = _unit(case)
    rpm = case.speeds * RPM.factor
    panel.pcolormesh(
        rpm, factor * case.frequencies, case.level.T, norm=colours.norm, cmap=_MAP, shading="nearest", rasterized=True
    )
    panel.set_yscale(frequency_scale(case.frequencies))
    panel.set_xlim(float(rpm.min()), float(rpm.max()))
    panel.set_ylim(factor * case.frequencies[0], factor * case.frequencies[-1])
    panel.set_xlabel("speed, rpm", fontsize=8)
    panel.set_ylabel(f"frequency, {unit}", fontsize=8)
    taken: list[float] = []
    for order, name in orders:
        at = _course(case, order)
        if at.size:
            places = factor * order * at / (2.0 * np.pi)
            panel.plot(at * RPM.factor, places, color="w", lw=0.7, ls=_DOTS)
            _name(panel, name, (float(at[-1]) * RPM.factor, float(places[-1])), taken, "w", "0.15")


def _spectra(panel: Axes, case: Waterfall, colours: _Range, orders: Sequence[tuple[float, str]]) -> None:
    """Spectra one behind the other; the base of each lies at its speed."""
    factor, unit = _unit(case)
    ordered = np.argsort(case.speeds)
    places = np.unique(np.linspace(0, ordered.size - 1, min(_SPECTRA, ordered.size)).round().astype(np.int64))
    kept = ordered[places]
    rpm = case.speeds[kept] * RPM.factor
    apart = float(np.ptp(rpm)) / max(kept.size - 1, 1) or 1.0
    frequencies = factor * case.frequencies
    share = (np.clip(case.level[kept], colours.low, colours.high) - colours.low) / (colours.span)
    for depth, (base, part) in enumerate(zip(rpm[::-1], share[::-1], strict=True)):
        course = np.column_stack([frequencies, base + _HEIGHT * apart * part])
        area = np.vstack([course, [frequencies[-1], base], [frequencies[0], base]])
        # Those in front hide what lies behind.
        order = 2.0 + 0.01 * depth
        panel.add_collection(PolyCollection([area], facecolors="w", edgecolors="none", zorder=order))
        pieces = np.stack([course[:-1], course[1:]], axis=1)
        values = colours.low + 0.5 * (part[:-1] + part[1:]) * (colours.span)
        colourful = LineCollection(list(pieces), cmap=_MAP, norm=colours.norm, linewidths=0.9, zorder=order + 0.005)
        colourful.set_array(values)
        panel.add_collection(colourful)
    panel.set_xscale(frequency_scale(case.frequencies))
    panel.set_xlim(frequencies[0], frequencies[-1])
    panel.set_ylim(float(rpm.min()) - 0.5 * apart, float(rpm.max()) + (_HEIGHT + 0.5) * apart)
    panel.set_xlabel(f"frequency, {unit}", fontsize=8)
    panel.set_ylabel("speed, rpm", fontsize=8)
    taken: list[float] = []
    for order, name in orders:
        at = _course(case, order)
        if at.size:
            line = factor * order * at / (2.0 * np.pi)
            panel.plot(line, at * RPM.factor, color="#c8102e", lw=0.8, ls=_DOTS, zorder=4.0)
            _name(panel, name, (float(line[-1]), float(at[-1]) * RPM.factor), taken, "#c8102e", "w", across=True)


def _course(case: Waterfall, order: float) -> FloatArray:
    """Speeds at which an order lies within the frequencies, rising; none where it never does [rad/s]."""
    inside = 2.0 * np.pi / order * np.array([case.frequencies[0], case.frequencies[-1]])
    low, high = max(inside[0], float(case.speeds.min())), min(inside[1], float(case.speeds.max()))
    return np.linspace(low, high, 50) if high > low else np.zeros(0)


def _name(
    panel: Axes, name: str, at: tuple[float, float], taken: list[float], colour: str, around: str, across: bool = False
) -> None:
    """Name an order at the end of its line, where there is room beside those that have theirs."""
    x, y = panel.transAxes.inverted().transform(panel.transData.transform(at))
    place = float(x) if across and y < 1.0 - _LEAST_APART else float(y) + (10.0 if x > 1.0 - _LEAST_APART else float(x))
    if any(abs(place - other) < _LEAST_APART for other in taken):
        return
    taken.append(place)
    side = "top" if y > 1.0 - 2.0 * _LEAST_APART else "bottom"
    text = panel.annotate(
        name, at, (-2, 1), textcoords="offset points", fontsize=6.5, color=colour, ha="right", va=side, zorder=5.0
    )
    text.set_path_effects([withStroke(linewidth=1.2, foreground=around)])
