"""Figures of levels of run-ups: Campbell diagrams of all laws, several sensors, differences between two laws."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import xarray as xr
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.patheffects import withStroke

from ehdmaps.arrays import FloatArray
from ehdmaps.figures import COLOURS, SHADE, WARNING, legend_columns, typeset, write_heading
from ehdmaps.units import written
from mbs.output.page import BAND_ALPHA, BAND_WORDS, ESTIMATED, grid, left_out, shade_handle, whole_numbers
from mbs.spectral.campbell import Campbell, RunUpSpectra
from mbs.spectral.levels import Reference, level
from mbs.spectral.run_signal import RPM

MOST_LAWS = 4
"""That are readable side by side."""

_WIDTH, _HEIGHT = 7.2, 5.4
"""Of a page with a margin [inch]."""

_DASHES = ("-", "--", "-.", ":")
_MAP = "viridis"
_RANGE, _LEAST_RANGE, _WIDEST_RANGE = 80.0, 40.0, 120.0
"""Of the colours [dB]: for one law at most, below the strongest line of each law at least, and at most for all."""

_FAINTEST = 20.0
"""Percentile of the levels of the loudest law where the colours begin, if its range is less."""

_NAMED_AT = 0.96
_SPARSE = (0.0, (1.0, 4.0))
"""Dots, between which the ridge of an order is still seen."""

_LIMIT = (0.0, (5.0, 1.5, 1.0, 1.5))
_LIMIT_COLOUR = "#ff7f0e"
"""Of the frequency from which on the films are notably wrong: seen on the colours of the levels and on paper."""

_LEAST_LEVELS = 1.0
"""Least range of sum levels that is shown [dB]: what changes by less is flat."""

_LEGEND = 120
"""Letters that have room beside each other in the legend of the sum levels."""

_LETTERS = 88
"""Of the names of all laws beside one another, above their diagrams; longer ones are wrapped."""

_LEAST_HEIGHT, _LEAST_WIDTH = 0.05, 0.12
"""Between two names of orders, as parts of a diagram."""

_SHORT = 6.0
"""Letters of a name that this width holds."""

_KILO = 2000.0
"""Highest frequency that is still shown in Hz."""


@dataclass(frozen=True, eq=False)
class Overlay:
    """Natural frequencies of the linear system over speed.

    Attributes
    ----------
    speeds : array, shape (speeds,)
        [rad/s].
    frequencies : array, shape (speeds, modes)
        [Hz].
    """

    speeds: FloatArray
    frequencies: FloatArray


@dataclass(frozen=True, eq=False)
class Reach:
    """Reach of the films of a law over speed.

    Attributes
    ----------
    speeds : array, shape (speeds,)
        [rad/s].
    limit : array, shape (speeds,)
        Frequency from which on the films are notably wrong [Hz]; NaN for laws without films.
    below : float
        Speed up to which windows reach below the map, where the film fades to the dry contact [rad/s]; 0 for none.
    """

    speeds: FloatArray
    limit: FloatArray
    below: float


def campbell_figure(
    title: str,
    laws: Sequence[str],
    results: Sequence[RunUpSpectra],
    reference: Reference,
    orders: Sequence[tuple[float, str]] = (),
    overlays: Sequence[Overlay | None] = (),
    reaches: Sequence[Reach | None] = (),
    bands: Sequence[FloatArray | None] = (),
) -> Figure:
    """Draw up to four laws.

    Parameters
    ----------
    title : str
        Heading of the page.
    laws : sequence of str
        Names of the contact laws.
    results : sequence of RunUpSpectra
        Spectra of each law, of the same run; a measured run may stand among them.
    reference : Reference
        Reference of the levels.
    orders : sequence of (float, str)
        Lines to draw in, with their names.
    overlays : sequence of Overlay or None
        Natural frequencies to draw into the diagram of each law.
    reaches : sequence of Reach or None
        How far the films of each law reach.
    bands : sequence of array, shape (windows,), or None
        Band of the sum level of each law, either way [dB].
    """
    figure = Figure(figsize=(_WIDTH, _HEIGHT), layout="constrained")
    write_heading(figure, title, 8)
    bands = bands or [None] * len(laws)
    upper, lower = np.ravel(figure.subfigures(2, 1, squeeze=False, height_ratios=(1.35, 1.0)))
    panels = upper.subplots(1, len(laws), sharex=True, sharey=True, squeeze=False)[0]
    colours = colour_scale(results)
    for index, (panel, law, result) in enumerate(zip(panels, laws, results, strict=True)):
        diagram(panel, result, colours)
        order_lines(panel, result, orders)
        overlay = overlays[index] if index < len(overlays) else None
        if overlay is not None:
            factor = frequency_unit(result)[0]
            panel.plot(overlay.speeds * RPM, overlay.frequencies * factor, "--", color="w", lw=0.6, alpha=0.8)
        reach = reaches[index] if index < len(reaches) else None
        if reach is not None:
            _reach(panel, reach, frequency_unit(result)[0])
        panel.set_title(textwrap.fill(law, _LETTERS // len(laws)), fontsize=8)
        panel.set_xlabel("speed, rpm", fontsize=7)
        panel.tick_params(labelsize=7)
    # A measured run has speeds of its own.
    panels[0].set_xlim(*speed_range(results))
    panels[0].set_ylabel(f"frequency, {frequency_unit(results[0])[1]}", fontsize=7)
    bar = upper.colorbar(ScalarMappable(colours, _MAP), ax=list(panels), pad=0.01, aspect=25, extend="min")
    bar.set_label(f"{reference.quantity} level, {reference_text(reference)}", fontsize=7)
    bar.ax.tick_params(labelsize=7)
    there = [reach for reach in reaches if reach is not None]
    handles = _handles(orders, overlays, there, results[0].campbell)
    if handles:
        upper.legend(handles=handles, loc="outside lower center", ncols=4, fontsize=6, frameon=False)
    left, right = lower.subplots(1, 2)
    last = _highest_order(results[0], orders)
    for order, _ in orders:
        right.axvline(order, color="0.7", lw=0.5, ls=":")
    for law, result, band, colour, dashes in zip(laws, results, bands, COLOURS, _DASHES, strict=False):
        sums, rpm = result.campbell.sum_level, result.campbell.speeds * RPM
        left.plot(rpm, sums, dashes, color=colour, lw=1.0, label=law)
        if band is not None:
            left.fill_between(rpm, sums - band, sums + band, color=colour, alpha=BAND_ALPHA, lw=0.0, zorder=1.5)
        spectrum = level(result.spectra.mean(), reference.value)
        place = result.spectra.orders
        # Below two lines is the mean.
        shown = (place > 2.0 / result.spectra.window) & (place <= last) & np.isfinite(spectrum)
        right.plot(place[shown], spectrum[shown], dashes, color=colour, lw=0.8)
    left.set_xlabel("speed, rpm", fontsize=7)
    left.set_ylabel(f"sum level, {reference_text(reference)}", fontsize=7)
    shaded = (
        [Patch(color="0.3", alpha=BAND_ALPHA, lw=0.0, label=BAND_WORDS)] if any(b is not None for b in bands) else []
    )
    named = [*left.lines, *shaded]
    columns = legend_columns([str(entry.get_label()) for entry in named], _LEGEND, MOST_LAWS)
    lower.legend(handles=named, loc="outside lower center", ncols=columns, fontsize=7, frameon=False)
    right.set_xlabel("order (periods a turn)", fontsize=7)
    right.set_ylabel(f"mean level, {reference_text(reference)}", fontsize=7)
    right.set_xlim(0.0, last)
    left.set_xlim(panels[0].get_xlim())
    low, high = left.get_ylim()
    spare = max(0.5 * (_LEAST_LEVELS - (high - low)), 0.0)
    left.set_ylim(low - spare, high + spare)
    for panel in (left, right):
        whole_numbers(panel)
        panel.grid(color="0.88", lw=0.5)
        panel.set_axisbelow(True)
        panel.tick_params(labelsize=7)
    return figure


def speed_range(results: Sequence[RunUpSpectra]) -> tuple[float, float]:
    """Lowest and highest speed of some results [rpm].

    Parameters
    ----------
    results : sequence of RunUpSpectra
        Results, at least one.
    """
    speeds = [result.campbell.speeds for result in results]
    return min(float(part.min()) for part in speeds) * RPM, max(float(part.max()) for part in speeds) * RPM


def _reach(panel: Axes, reach: Reach, factor: float) -> None:
    """Draw as a line where the films are notably wrong, shade what lies below the map; the axes stay as they are."""
    limits = panel.get_xlim(), panel.get_ylim()
    panel.plot(reach.speeds * RPM, reach.limit * factor, color=_LIMIT_COLOUR, lw=0.9, ls=_LIMIT)
    if reach.below * RPM >= limits[0][0]:
        # A line of its own width also where it is the first window alone.
        panel.axvspan(limits[0][0], reach.below * RPM, color=SHADE, alpha=0.6, lw=1.5)
    panel.set_xlim(*limits[0])
    panel.set_ylim(*limits[1])


def _handles(
    orders: Sequence[tuple[float, str]], overlays: Sequence[Overlay | None], reaches: Sequence[Reach], drawn: Campbell
) -> list[Artist]:
    """Handles of the lines that are seen in the diagrams, whose speeds and frequencies are those of `drawn`."""
    handles: list[Artist] = []
    if orders:
        handles.append(Line2D([], [], color="0.5", lw=0.8, ls=_SPARSE, label="orders"))
    if any(overlay is not None for overlay in overlays):
        handles.append(Line2D([], [], color="0.5", lw=0.8, ls="--", label="linear modes (|eigenvalue|/2π)"))
    if any((reach.limit < drawn.frequencies.max()).any() for reach in reaches):
        words = f"above the line: {ESTIMATED}"
        handles.append(Line2D([], [], color=_LIMIT_COLOUR, lw=0.9, ls=_LIMIT, label=words))
    slow = max((reach.below for reach in reaches), default=0.0)
    if slow >= drawn.speeds.min():
        handles.append(shade_handle(f"up to {written(slow * RPM)} rpm: below the map, film fades to dry"))
    return handles


def colour_scale(results: Sequence[RunUpSpectra]) -> Normalize:
    """One scale for all diagrams: from the faint parts of the loudest law, or deeper for the sake of others.

    Parameters
    ----------
    results : sequence of RunUpSpectra
        What is drawn beside one another.
    """
    tops = [result.campbell.level.max() for result in results]
    loudest = results[int(np.argmax(tops))].campbell.level
    top = 5.0 * np.ceil(max(tops) / 5.0)
    bottom = min(max(np.percentile(loudest, _FAINTEST), top - _RANGE), min(tops) - _LEAST_RANGE)
    return Normalize(float(max(5.0 * np.floor(bottom / 5.0), top - _WIDEST_RANGE)), float(top))


def frequency_unit(result: RunUpSpectra) -> tuple[float, str]:
    """Factor and unit of the frequency axis.

    Parameters
    ----------
    result : RunUpSpectra
        What is drawn.
    """
    return (1e-3, "kHz") if result.campbell.frequencies[-1] > _KILO else (1.0, "Hz")


def diagram(panel: Axes, result: RunUpSpectra, colours: Normalize) -> None:
    """Levels as colours; pixels also in vector files, where each value would be a path.

    Parameters
    ----------
    panel : Axes
        The panel.
    result : RunUpSpectra
        Levels of a run.
    colours : Normalize
        Scale of the colours.
    """
    campbell = result.campbell
    speeds, frequencies = campbell.speeds * RPM, campbell.frequencies * frequency_unit(result)[0]
    panel.pcolormesh(speeds, frequencies, campbell.level.T, norm=colours, cmap=_MAP, shading="nearest", rasterized=True)
    panel.set_xlim(speeds.min(), speeds.max())
    panel.set_ylim(frequencies[0], frequencies[-1])


def order_lines(panel: Axes, result: RunUpSpectra, orders: Sequence[tuple[float, str]]) -> None:
    """Thin lines of the orders, each named near where it leaves the diagram if there is room.

    Parameters
    ----------
    panel : Axes
        The panel.
    result : RunUpSpectra
        What is drawn there.
    orders : sequence of (float, str)
        Orders with their names.
    """
    factor = frequency_unit(result)[0] / (2.0 * np.pi)
    begin, end = float(result.campbell.speeds.min()), float(result.campbell.speeds.max())
    top = float(result.campbell.frequencies[-1]) * frequency_unit(result)[0]
    named: list[tuple[float, float]] = []
    for order, name in orders:
        stop = min(end, top / (order * factor))
        if stop <= begin:
            continue
        ends = np.array([begin, stop])
        panel.plot(ends * RPM, ends * order * factor, color="w", lw=0.6, ls=_SPARSE)
        at = begin + _NAMED_AT * (stop - begin)
        place = ((at - begin) / (end - begin), at * order * factor / top)
        if all(
            abs(place[1] - y) > _LEAST_HEIGHT or abs(place[0] - x) > _LEAST_WIDTH * max(1.0, len(name) / _SHORT)
            for x, y in named
        ):
            named.append(place)
            side = "bottom" if place[1] < 1.0 - _LEAST_HEIGHT else "top"
            text = panel.annotate(name, (at * RPM, at * order * factor), fontsize=6, color="w", ha="right", va=side)
            text.set_path_effects([withStroke(linewidth=1.2, foreground="0.15")])


def _highest_order(result: RunUpSpectra, orders: Sequence[tuple[float, str]]) -> float:
    """End of the axis of orders: beyond the last one drawn, else what the band holds at the highest speed."""
    if orders:
        return float(min(1.15 * max(order for order, _ in orders), result.spectra.orders[-1]))
    top = float(result.campbell.speeds.max())
    return float(2.0 * np.pi * result.campbell.frequencies[-1] / top)


def reference_text(reference: Reference) -> str:
    """Unit of the levels as figures show it, such as dB re 1 um/s2.

    Parameters
    ----------
    reference : Reference
        Reference of the levels.
    """
    prefix = {1e-12: "p", 1e-9: "n", 1e-6: "µ"}[reference.value]
    return f"dB re 1 {prefix}{reference.unit.replace('s2', 's²')}"


MOST_SENSORS = 6
"""Rows that are drawn."""

_COLUMN, _ROW = 2.6, 1.9
"""Size of a panel [inch]."""


def sensors_figure(
    title: str,
    laws: Sequence[str],
    results: Sequence[Sequence[RunUpSpectra]],
    sensors: Sequence[tuple[str, Reference]],
    orders: Sequence[tuple[float, str]] = (),
) -> Figure:
    """Draw up to `MOST_SENSORS` sensors; how many are left out is said.

    Parameters
    ----------
    title : str
        Heading of the page.
    laws : sequence of str
        Names of the runs: of the laws, of a measured one.
    results : sequence of sequence of RunUpSpectra
        Spectra of each run, one a sensor.
    sensors : sequence of (str, Reference)
        Names, and references of their levels.
    orders : sequence of (float, str)
        Lines to draw in, with their names.
    """
    rows = min(len(sensors), MOST_SENSORS)
    figure = Figure(figsize=(_COLUMN * (len(laws) + 1) + 0.8, _ROW * rows + 1.0), layout="constrained")
    write_heading(figure, title, 8)
    axes = figure.subplots(rows, len(laws) + 1, squeeze=False, sharex=True)
    for row, (name, reference) in enumerate(sensors[:rows]):
        here = [spectra[row] for spectra in results]
        colours = colour_scale(here)
        for panel, law, result in zip(axes[row, :-1], laws, here, strict=True):
            diagram(panel, result, colours)
            order_lines(panel, result, orders)
            if row == 0:
                panel.set_title(textwrap.fill(law, 30), fontsize=8)
        axes[row, 0].set_ylabel(f"{name}\nfrequency, {frequency_unit(here[0])[1]}", fontsize=7)
        bar = figure.colorbar(ScalarMappable(colours, "viridis"), ax=axes[row, -2], pad=0.02, aspect=15, extend="min")
        bar.ax.tick_params(labelsize=6)
        sums = axes[row, -1]
        for law, result, colour, dashes in zip(laws, here, COLOURS, _DASHES * 2, strict=False):
            campbell = result.campbell
            sums.plot(campbell.speeds * RPM, campbell.sum_level, dashes, color=colour, lw=0.9, label=law)
        sums.set_ylabel(f"sum level,\n{reference_text(reference)}", fontsize=7)
        grid(sums)
    axes[0, -1].set_title("sum level", fontsize=8)
    axes[0, 0].set_xlim(*speed_range([spectra[0] for spectra in results]))
    for panel in axes.flat:
        panel.tick_params(labelsize=7)
    for panel in axes[-1]:
        panel.set_xlabel("speed, rpm", fontsize=7)
    left_out(figure, axes[0, -1].lines if len(laws) > 1 else [], len(sensors) - rows, min(len(laws), 3))
    return figure


_BROAD, _TOP, _LINE = 7.2, 1.6, 0.19
"""Width of the page, what stands above and below, and height of a line [inch]."""

_MARKS = (
    ("highest_difference", "D", COLOURS[3], "highest of each, at any speed"),
    ("energy_difference", "s", COLOURS[2], "mean energy"),
    ("median_difference", "o", COLOURS[0], "median of the windows"),
)


def variants_figure(title: str, dataset: xr.Dataset, labels: Sequence[str]) -> Figure:
    """Draw the table of `mbs variants`.

    Parameters
    ----------
    title : str
        Heading of the page.
    dataset : xarray.Dataset
        The table, see `mbs.laboratory.variants`.
    labels : sequence of str
        The two laws.
    """
    names = [
        typeset(f"{key} {value}") if key else "base"
        for key, value in zip(dataset["key"].values.tolist(), dataset["value"].values.tolist(), strict=True)
    ]
    sensors = dataset["sensor"].values.tolist()
    figure = Figure(figsize=(_BROAD, _TOP + _LINE * len(names)), layout="constrained")
    write_heading(figure, typeset(f"{title}\nsum level of {labels[1]} minus that of {labels[0]}"), 8)
    panels = figure.subplots(1, len(sensors), sharex=True, sharey=True, squeeze=False)[0]
    lines = np.arange(len(names))
    for column, (panel, sensor) in enumerate(zip(panels, sensors, strict=True)):
        data = dataset.isel(sensor=column)
        panel.hlines(lines, data["low_difference"], data["high_difference"], color="0.75", lw=4.0)
        for name, marker, colour, words in _MARKS:
            panel.plot(data[name], lines, marker, color=colour, ms=3.5, ls="none", label=words)
        for line in lines[np.isnan(data["median_difference"].values)].tolist():
            panel.text(0.5, line, "no result", transform=panel.get_yaxis_transform(), color=WARNING, fontsize=6,
                       ha="center", va="center")  # fmt: skip
        panel.axvline(0.0, color="0.4", lw=0.7)
        panel.axhline(0.5, color="0.4", lw=0.4)
        panel.set_title(f"sensor {sensor}", fontsize=8)
        panel.set_xlabel("dB", fontsize=7)
        panel.tick_params(labelsize=7)
        panel.grid(axis="x", lw=0.3)
    panels[0].set_yticks(lines, names)
    panels[0].invert_yaxis()
    handles, words_of = panels[0].get_legend_handles_labels()
    bar = panels[0].collections[0]
    figure.legend([*handles, bar], [*words_of, "5 to 95 % of the windows"], loc="outside lower center", ncols=4,
                  fontsize=7, frameon=False)  # fmt: skip
    return figure
