"""Figures over speed: modes, stiffness and damping of the bearings, responses, critical speeds with their orders."""

from __future__ import annotations

import itertools
import math
import textwrap
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure, SubFigure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from ehdmaps.arrays import ComplexArray, FloatArray
from ehdmaps.figures import COLOURS, legend_columns, typeset, write_heading
from ehdmaps.units import DAMPER, RPM, SPRING, written
from mbs.linearised.critical import CriticalSpeed, OrderResponse
from mbs.linearised.linear import response_display
from mbs.linearised.sweep_result import Sweep, UndampedSweep
from mbs.output.band_text import HEAD
from mbs.output.page import (
    BAND_ALPHA,
    BAND_WORDS,
    ESTIMATED,
    frequency_scale,
    grid,
    headed,
    shade,
    shade_handle,
    whole_numbers,
)
from mbs.output.sweep_data import orbits
from mbs.scene.assembly import Model
from mbs.scene.fields import MICROMETRE

if TYPE_CHECKING:
    from mbs.unknowns.over_speed import SpeedBands

_LEAST_SHARE = 0.05
_MAPS_IN_A_ROW = 4
_MARKS = 16
_LEVELS_SHOWN = 50.0
_NOTHING = 1e-4
_DASHES = ("-", "--", "-.", ":", (0, (6.0, 1.0, 1.0, 1.0, 1.0, 1.0)), (0, (1.0, 4.0)))
_LEAST_UNKNOWN = 0.05
"""Strain energy in the bearings from which on what is not known of a complex mode is shaded."""

_LIMIT = (0.0, (5.0, 1.5, 1.0, 1.5))
"""Dashes of the frequency from which on the films are notably wrong."""

_ABOVE = f"above the line: {ESTIMATED}"
_BELOW = "below the map, film fades to dry"
_LEAST_ROOM = 0.028
"""Between two numbers of modes, as a part of the axis."""

_LEAST_CHANGE = 0.01
"""Least range of changes that is shown, either way [%]: less is round-off."""

_LETTERS, _TITLES = 150, 100
"""Letters that have room beside each other in a legend, and in titles of maps over the width of the page."""

_NAME = 32
"""Letters of the name of a bearing in the legend."""

_LEGEND_ROW, _ROWS_WITHIN = 0.17, 3
"""Height of a row of the legend of all lines [inch], and rows for which the page has room."""

_WIDTH = 9.0
_ROW = 3.1


def sweep_figure(
    title: str,
    words: str,
    sweeps: Sequence[Sweep],
    labels: Sequence[str],
    limits: Sequence[FloatArray] = (),
    below: float = 0.0,
    relaxing: Sequence[bool] = (),
    bands: Sequence[SpeedBands] = (),
) -> Figure:
    """Modes, bearings and the response of the first sensor to the first input over speed, a colour a case.

    Parameters
    ----------
    title, words : str
        Heading of the page; the words are its second line.
    sweeps : sequence of Sweep
        Sweeps over the same speeds.
    labels : sequence of str
        What each is.
    limits : sequence of array, shape (speeds,)
        Frequency of each sweep from which on the films are notably wrong [Hz]; NaN for laws without films.
    below : float
        Speed below which the film fades to the dry contact: shaded [rad/s].
    relaxing : sequence of bool
        Which sweeps have films that relax; changes and damping ratios of these are shown of complex modes, because
        undamped ones see films of slow motion.
    bands : sequence of SpeedBands
        What is not known of the complex modes of each sweep, shaded; nothing is without.
    """
    relaxing = relaxing or [False] * len(sweeps)
    limits = limits or [np.full(entry.speeds.size, np.nan) for entry in sweeps]
    mapped = [index for index, entry in enumerate(sweeps) if entry.responses.values.size]
    maps = [sweeps[index] for index in mapped]
    heights = [1.0, 1.0, *([float(math.ceil(len(maps) / _MAPS_IN_A_ROW))] if maps else [])]
    figure = Figure(figsize=(_WIDTH, _ROW * sum(heights) + 0.4), layout="constrained")
    write_heading(figure, f"{title}\n{typeset(words)}", 10)
    parts = figure.subfigures(len(heights), 1, squeeze=False, height_ratios=heights)[:, 0]
    top, middle = parts[0].subplots(1, 2), parts[1].subplots(1, 3)
    handles = []
    for index, (entry, label, colour) in enumerate(zip(sweeps, labels, itertools.cycle(COLOURS), strict=False)):
        _modes((*top, middle[0]), entry, colour, relaxing[index])
        _bearings(middle[1:], entry, colour)
        top[0].plot(entry.speeds * RPM.factor, limits[index], color=colour, lw=1.2, ls=_LIMIT)
        handles.append(Line2D([], [], color=colour, lw=1.6, label=typeset(label)))
    for entry, own, colour in zip(sweeps, bands, COLOURS, strict=False):
        _unknown((top[0], middle[0]), entry, own, colour)
    _axes(top[0], "frequency, Hz", "log")
    _axes(top[1], "change of frequency, %" if any(relaxing) else "change of undamped frequency, %")
    _axes(middle[0], "damping ratio, %", "log")
    _axes(middle[1], typeset(f"bearing k along its load, {SPRING.unit}"))
    _axes(middle[2], f"bearing c along its load, {DAMPER.unit}")
    for panel in middle[1:]:
        panel.set_ylim(0.0, 1.05 * panel.get_ylim()[1])
    _limit(top[0], sweeps, lambda modes: modes.frequency)
    _limit(middle[0], sweeps, lambda modes: 100.0 * modes.damping_ratio)
    if maps:
        top[0].set_ylim(top=min(top[0].get_ylim()[1], 1.4 * _highest(maps[0])))
    _room(top[1])
    # With more cases their numbers would lie on each other.
    for entry, colour, last in zip(sweeps, COLOURS, (False, True), strict=False):
        _numbers(top[0], entry, colour, last)
    if len(handles) > 1:
        columns = legend_columns(labels, _LETTERS, 4)
        parts[0].legend(handles=handles, loc="outside upper center", ncols=columns, fontsize=8, frameon=False)
    styles: list[Artist] = [
        Line2D([], [], color="0.3", lw=1.8, label="undamped, all energy in the bearings"),
        Line2D([], [], color="0.3", lw=0.6, label="undamped, 5 % there"),
        Line2D([], [], color="0.3", lw=0, marker="o", ms=3.2, mfc="white", label="complex, with gyroscopic terms"),
        Line2D([], [], color="0.75", lw=0.7, label="undamped, less than 5 % there"),
    ]
    if bands:
        styles.append(Patch(color="0.3", alpha=BAND_ALPHA, lw=0.0, label=f"complex, {HEAD}"))
    if any(relaxing):
        styles.append(
            Line2D(
                [],
                [],
                color="0.3",
                lw=1.2,
                marker="o",
                ms=3.2,
                mfc="white",
                label="films with memory: complex modes alone",
            )
        )
    if any(np.isfinite(entry.bearings.stiffness_error).any() for entry in sweeps):
        styles.append(Patch(color="0.3", alpha=BAND_ALPHA, lw=0.0, label=BAND_WORDS))
    if any(np.isfinite(limit).any() for limit in limits):
        styles.append(Line2D([], [], color="0.3", lw=1.2, ls=_LIMIT, label=_ABOVE))
    if below > sweeps[0].speeds[0]:
        styles.append(shade_handle(f"below {written(below * RPM.factor)} rpm: {_BELOW}"))
    styles += _bearing_names(sweeps[0].bearings.names)
    figure.set_figheight(figure.get_figheight() + _LEGEND_ROW * max(math.ceil(len(styles) / 3) - _ROWS_WITHIN, 0))
    parts[1].legend(handles=styles, loc="outside lower center", ncols=3, fontsize=7.5, frameon=False)
    if maps:
        _maps(parts[2], maps, [labels[index] for index in mapped], [limits[index] for index in mapped])
    if below > sweeps[0].speeds[0]:
        for panel in (*top, *middle):
            low, high = panel.get_xlim()
            shade(panel, low, below * RPM.factor)
            panel.set_xlim(low, high)
    return figure


def _modes(axes: Sequence[Axes], entry: Sweep, colour: str, relaxing: bool) -> None:
    """Modes over speed: thick where the strain energy is in the bearings, grey where hardly any is."""
    rpm = entry.speeds * RPM.factor
    plain, damped = entry.undamped, entry.damped
    highest = _highest(entry)
    for k in range(plain.frequency.shape[1]):
        share = float(plain.bearing_share[:, k].max())
        shown = share >= _least(entry)
        shade, width = (colour, 0.6 + 1.2 * share) if shown else ("0.75", 0.7)
        axes[0].plot(rpm, _positive(plain.frequency[:, k]), color=shade, lw=width, zorder=2 if shown else 1)
        if shown and not relaxing and plain.frequency[:, k].min() <= highest:
            axes[1].plot(rpm, 100.0 * plain.shift[:, k], color=shade, lw=width)
            axes[2].plot(rpm, _positive(100.0 * plain.damping_ratio[:, k]), color=shade, lw=width)
    every = max(rpm.size // _MARKS, 1)
    for k in range(damped.eigenvalues.shape[1]):
        if np.nanmax(damped.bearing_share[:, k]) >= _least(entry) and np.nanmin(damped.frequency[:, k]) <= highest:
            for panel, values in ((axes[0], damped.frequency), (axes[2], 100.0 * damped.damping_ratio)):
                panel.plot(
                    rpm[::every], _positive(values[::every, k]), "o", ms=3.2, mfc="white", mec=colour, mew=0.8, zorder=3
                )
            if relaxing:
                width = 0.6 + 1.2 * float(np.nanmax(damped.bearing_share[:, k]))
                there = np.isfinite(damped.frequency[:, k])
                first = damped.frequency[there, k][0]
                _band(
                    axes[1],
                    rpm,
                    100.0 * (damped.frequency[:, k] / first - 1.0),
                    100.0 * damped.frequency_error[:, k] / first,
                    colour,
                )
                _band(
                    axes[2], rpm, 100.0 * damped.damping_ratio[:, k], 100.0 * damped.damping_ratio_error[:, k], colour
                )
                axes[1].plot(rpm, 100.0 * (damped.frequency[:, k] / first - 1.0), color=colour, lw=width)
                axes[2].plot(rpm, _positive(100.0 * damped.damping_ratio[:, k]), color=colour, lw=width)


def _bearings(axes: Sequence[Axes], entry: Sweep, colour: str) -> None:
    """Stiffness and damping of each bearing over speed; bearings that do the same lie on each other."""
    rpm = entry.speeds * RPM.factor
    for index, dashes in zip(range(len(entry.bearings.names)), _DASHES * 16, strict=False):
        axes[0].plot(rpm, SPRING.factor * entry.bearings.stiffness[:, index], ls=dashes, color=colour, lw=1.3)
        axes[1].plot(rpm, DAMPER.factor * entry.bearings.damping[:, index], ls=dashes, color=colour, lw=1.3)
        of = entry.bearings
        for panel, display, values, errors in (
            (axes[0], SPRING, of.stiffness, of.stiffness_error),
            (axes[1], DAMPER, of.damping, of.damping_error),
        ):
            _band(panel, rpm, display.factor * values[:, index], display.factor * errors[:, index], colour)


def _band(panel: Axes, rpm: FloatArray, values: FloatArray, errors: FloatArray, colour: str) -> None:
    """Shade what the errors that the map states may change; nothing where none are stated."""
    if np.isfinite(errors).any():
        panel.fill_between(rpm, values - errors, values + errors, color=colour, alpha=BAND_ALPHA, lw=0.0, zorder=1.5)


def _numbers(panel: Axes, entry: Sweep, colour: str, last: bool) -> None:
    """Write the numbers of the modes beside the first speed, or the last one, where there is room for them."""
    low, high = np.log(panel.get_ylim())
    rpm = float(entry.speeds[-1 if last else 0]) * RPM.factor
    heights = entry.undamped.frequency[-1 if last else 0]
    taken: list[float] = []
    for k in np.flatnonzero(entry.undamped.bearing_share.max(axis=0) >= _least(entry)):
        place = (math.log(max(float(heights[k]), _NOTHING)) - low) / (high - low)
        if not 0.0 < place < 1.0 or any(abs(place - other) < _LEAST_ROOM for other in taken):
            continue
        taken.append(place)
        panel.annotate(
            str(k + 1), (rpm, heights[k]), (3 if last else -3, 0), textcoords="offset points", fontsize=6, color=colour,
            ha="left" if last else "right", va="center",
        )  # fmt: skip


def _bearing_names(names: Sequence[str]) -> list[Artist]:
    """Entries of a legend that show which dashes are which bearing."""
    return [
        Line2D([], [], color="0.3", lw=1.3, ls=dashes, label=f"k, c of {_shortened(name)}")
        for name, dashes in zip(names, _DASHES * 16, strict=False)
    ]


def _shortened(name: str) -> str:
    """A name that has room in the legend."""
    return name if len(name) <= _NAME else f"{name[: _NAME - 1]}…"


def _room(panel: Axes) -> None:
    """Widen an axis of changes that would show round-off."""
    low, high = panel.get_ylim()
    panel.set_ylim(min(low, -_LEAST_CHANGE), max(high, _LEAST_CHANGE))


def _maps(part: SubFigure, maps: Sequence[Sweep], labels: Sequence[str], limits: Sequence[FloatArray]) -> None:
    """The first response of each case as a level over speed and frequency, with one scale for all."""
    rows = math.ceil(len(maps) / _MAPS_IN_A_ROW)
    grid = part.subplots(rows, math.ceil(len(maps) / rows), sharex=True, sharey=True, squeeze=False)
    axes = grid.ravel()
    responses = maps[0].responses
    display = response_display(responses.sensors[0], responses.inputs[0])
    levels = [_level(display.factor * entry.responses.largest(0, 0)) for entry in maps]
    # Not the tips of resonances, which would take the scale for themselves.
    beside = _level(display.factor * np.stack([entry.responses.values[:, :, 0, 0] for entry in maps]))
    lowest, highest = (5.0 * np.round(np.percentile(beside, part) / 5.0) for part in (1.0, 99.7))
    lowest, highest = max(lowest, highest - _LEVELS_SHOWN), max(highest, lowest + 5.0)
    # The axis goes as the frequencies were asked for: the middle of a logarithmic one lies low.
    scale = frequency_scale(responses.frequencies)
    image = None
    for panel, entry, level, label, limit in zip(axes, maps, levels, labels, limits, strict=False):
        image = panel.pcolormesh(
            entry.speeds * RPM.factor,
            responses.frequencies,
            level.T,
            vmin=lowest,
            vmax=highest,
            cmap="viridis",
            shading="nearest",
            rasterized=True,
        )
        panel.set_xlim(entry.speeds[0] * RPM.factor, entry.speeds[-1] * RPM.factor)
        panel.set_yscale(scale)
        panel.plot(entry.speeds * RPM.factor, limit, color="w", lw=1.2, ls=_LIMIT)
        if responses.frequencies[0] < responses.frequencies[-1]:
            panel.set_ylim(responses.frequencies[0], responses.frequencies[-1])
        panel.set_title(textwrap.fill(typeset(label), _TITLES // grid.shape[1]), fontsize=8.5)
        panel.tick_params(labelsize=8)
    for panel in axes[len(maps) :]:
        panel.remove()
    for panel in grid[:, 0]:
        panel.set_ylabel("frequency, Hz", fontsize=9)
    for column in grid.T:
        lowest_panel = [panel for panel in column if panel in axes[: len(maps)]][-1]
        lowest_panel.set_xlabel("speed, rpm", fontsize=9)
        lowest_panel.tick_params(labelbottom=True)
    if image is not None:
        bar = part.colorbar(image, ax=list(axes[: len(maps)]), pad=0.01, extend="both")
        bar.set_label(
            f"{responses.sensors[0].name} by {responses.inputs[0].name}, dB re 1 {typeset(display.unit)}", fontsize=8
        )
        bar.ax.tick_params(labelsize=8)


def _level(response: ComplexArray | FloatArray) -> FloatArray:
    """Level of a response in dB re 1 of its unit."""
    return np.asarray(20.0 * np.log10(np.maximum(np.abs(response), 1e-300)))


def _axes(panel: Axes, label: str, scale: str = "linear") -> None:
    """Labels and a quiet grid."""
    panel.set_yscale(scale)
    panel.set_xlabel("speed, rpm", fontsize=9)
    panel.set_ylabel(label, fontsize=9)
    panel.grid(color="0.9", lw=0.5, which="both" if scale == "log" else "major")
    panel.set_axisbelow(True)
    panel.tick_params(labelsize=8, which="both")
    if scale == "linear":
        whole_numbers(panel)


def _limit(panel: Axes, sweeps: Sequence[Sweep], read: Callable[[UndampedSweep], FloatArray]) -> None:
    """Show the range of the modes with strain energy in the bearings, with room around it."""
    inside = [
        (entry.undamped.bearing_share.max(axis=0) >= _least(entry))
        & (entry.undamped.frequency.min(axis=0) <= _highest(entry))
        for entry in sweeps
    ]
    values = np.concatenate(
        [read(entry.undamped)[:, shown].ravel() for entry, shown in zip(sweeps, inside, strict=True)]
    )
    values = values[values > _NOTHING]
    if values.size:
        panel.set_ylim(values.min() / 1.4, values.max() * 1.4)


def _least(entry: Sweep) -> float:
    """Part of the strain energy in the bearings from which a mode is of interest; none without bearings."""
    return _LEAST_SHARE if entry.bearings.names else 0.0


def _highest(entry: Sweep) -> float:
    """Highest frequency of the responses, up to which modes are of interest; no limit without responses [Hz]."""
    return float(entry.responses.frequencies.max(initial=0.0)) if entry.responses.values.size else math.inf


def _positive(values: FloatArray) -> FloatArray:
    """Values for a logarithmic axis; damping below a millionth of the critical one is none."""
    return np.where(values > _NOTHING, values, np.nan)


_LEAST = 1e-15
"""Radius below which an orbit is drawn as none [m]."""

_PART = 1e-5
"""Least radius that is drawn, as a part of the largest one: the response at rest is none."""

_ROOM = 1.6
"""Height of the frequencies over the highest line of an order."""


@dataclass(frozen=True, eq=False)
class CriticalCurves:
    """Curves that are drawn of a law.

    Attributes
    ----------
    label : str
        What the law is called.
    model : Model
        Scene with the law.
    sweep : Sweep
        Modes over speed.
    found : sequence of CriticalSpeed
        Critical speeds, which are marked.
    speeds : array, shape (speeds,)
        Speeds of the responses [rad/s].
    responses : sequence of OrderResponse
        Response to the loads of each order; a panel each.
    orders : sequence of float
        Orders whose lines are drawn.
    bounds : array, shape (critical, 4), optional
        Low and high speed [rad/s] of each critical one, drawn as a bar.
    """

    label: str
    model: Model
    sweep: Sweep
    found: Sequence[CriticalSpeed]
    speeds: FloatArray
    responses: Sequence[OrderResponse]
    orders: Sequence[float]
    bounds: FloatArray | None = None


def critical_figure(laws: Sequence[CriticalCurves]) -> Figure:
    """Modes over speed with critical speeds, and the response below them.

    Parameters
    ----------
    laws : sequence of CriticalCurves
        One law, whose places have a colour each; or several of one scene, which have a colour each, and the places
        their kinds of lines.
    """
    first, several = laws[0], len(laws) > 1
    rows = 1 + len(first.responses)
    figure = headed(first.model, "critical speeds", (9.0, 3.0 + 2.6 * rows), "laws side by side" if several else None)
    panels = figure.subplots(rows, 1, sharex=True, squeeze=False)[:, 0]
    turns = first.sweep.speeds * RPM.factor
    for index, law in enumerate(laws):
        _damped_modes(panels[0], law, COLOURS[index % len(COLOURS)], COLOURS[index if several else 1])
        for panel, response in zip(panels[1:], law.responses, strict=True):
            _orbits(panel, law, response, COLOURS[index % len(COLOURS)] if several else None)
    for panel in panels[1:]:
        # After all laws: a limit that is set ends the scaling of the other one.
        panel.set_ylim(bottom=max(_PART * panel.dataLim.ymax, _LEAST * 1e6))
    _lines(panels[0], first)
    if several:
        names = [Line2D([], [], color=COLOURS[k], lw=1.2, label=law.label) for k, law in enumerate(laws)]
        panels[0].legend(handles=names, fontsize=7, loc="upper left")
    if first.responses:
        panels[1].legend(handles=_places(first, several), fontsize=7, frameon=False)
    for panel in panels:
        grid(panel)
    panels[-1].set(xlabel="speed of the system, rpm", xlim=(turns[0], turns[-1]))
    return figure


def _unknown(panels: tuple[Axes, Axes], entry: Sweep, bands: SpeedBands, colour: str) -> None:
    """Shade what is not known of frequencies and damping ratios of complex modes with strain energy in the bearings."""
    damped = entry.damped
    shares = np.nanmax(damped.bearing_share, axis=0, initial=0.0)
    values = ((damped.frequency, bands.frequency), (100.0 * damped.damping_ratio, bands.damping_ratio))
    for panel, (value, (fall, rise)) in zip(panels, values, strict=True):
        for k in np.flatnonzero(shares >= _LEAST_UNKNOWN):
            low, high = value[:, k] * (1.0 - np.minimum(fall[:, k], 1.0)), value[:, k] * (1.0 + rise[:, k])
            panel.fill_between(entry.speeds * RPM.factor, low, high, color=colour, alpha=BAND_ALPHA, lw=0.0, zorder=1.0)


def _damped_modes(panel: Axes, law: CriticalCurves, colour: str, marked: str) -> None:
    """Damped modes over speed, and the critical speeds."""
    frequencies = law.sweep.damped.eigenvalues.imag / (2.0 * np.pi)
    panel.plot(law.sweep.speeds * RPM.factor, frequencies, color=colour, lw=1.0)
    for index, entry in enumerate(law.found):
        if law.bounds is not None and np.all(np.isfinite(law.bounds[index, :2])):
            reach = np.abs(law.bounds[index, :2, None] - entry.speed) * RPM.factor
            at = entry.speed * RPM.factor, entry.eigenvalue.imag / (2.0 * np.pi)
            panel.errorbar(*at, xerr=reach, fmt="none", ecolor=marked, elinewidth=1.2, capsize=3.0)
        marker = "o" if math.isnan(entry.whirl) else "^" if entry.whirl > 0.0 else "v"
        panel.plot(entry.speed * RPM.factor, entry.eigenvalue.imag / (2.0 * np.pi), marker, color=marked, ms=6)


def _lines(panel: Axes, law: CriticalCurves) -> None:
    """The lines of the orders, and what the panel shows."""
    speeds = law.sweep.speeds
    for order in law.orders:
        frequencies = order * speeds / (2.0 * np.pi)
        panel.plot(speeds * RPM.factor, frequencies, color="0.5", lw=0.9, ls="--")
        panel.annotate(
            f"order {order:.4g}", (speeds[-1] * RPM.factor, frequencies[-1]), fontsize=7, ha="right", va="bottom"
        )
    panel.set(
        ylabel="frequency of damped modes, Hz",
        ylim=(0.0, _ROOM * max(law.orders) * float(speeds[-1]) / (2.0 * np.pi)),
    )
    panel.set_title(
        "triangles: critical speeds, upwards with the spin, downwards against it; circles: along or about the axis"
        + (f"; bars: {HEAD}" if law.bounds is not None else ""),
        fontsize=8,
        loc="left",
    )


def _orbits(panel: Axes, law: CriticalCurves, response: OrderResponse, colour: str | None) -> None:
    """Largest radius of the orbit of each place over speed; in a colour each if none is given."""
    places, axes = orbits(law.model.system, response)
    for index in range(len(places)):
        style = {"color": COLOURS[index % len(COLOURS)]} if colour is None else {"color": colour, "ls": _style(index)}
        panel.semilogy(law.speeds * RPM.factor, np.maximum(axes[:, index, 0], _LEAST) * 1e6, lw=1.1, **style)
    panel.set_ylabel(f"orbit by order {response.order:.4g},\nlargest radius, {typeset(MICROMETRE.unit)}")


def _places(law: CriticalCurves, several: bool) -> list[Line2D]:
    """Entries of a legend for the places."""
    places, _ = orbits(law.model.system, law.responses[0])
    return [
        Line2D([], [], lw=1.1, label=place, color="0.2", ls=_style(index))
        if several
        else Line2D([], [], lw=1.1, label=place, color=COLOURS[index % len(COLOURS)])
        for index, place in enumerate(places)
    ]


def _style(index: int) -> str:
    """Kind of line of a place."""
    return ("-", "--", ":", "-.")[index % 4]
