"""Figures of modes: where their strain energy is, their shapes, and how they were identified from responses."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from ehdmaps.arrays import FloatArray, IntArray
from ehdmaps.figures import COLOURS, legend_columns, typeset, without_latex, write_heading
from ehdmaps.units import MOTIONS, RPM, Display, written
from mbs.linearised.modes import Modes
from mbs.linearised.shapes import AXIS, EDGE, JOINT, MARK, Skeleton
from mbs.modal.records import Channel
from mbs.modal.result import ModalFit
from mbs.output.band_text import HEAD, bounds_text, value_text
from mbs.output.page import BAND_WORDS, ESTIMATED, headed, shade, shade_handle
from mbs.scene.assembly import Model
from mbs.unknowns.of_modes import ModeBands

_MOST_LEVEL_LABELS = 12
_MOST_LABELS = 60
"""That stand upright beside each other."""

_FILLS = ("#4477aa", "#ee6677", "#228833", "#ccbb44", "#66ccee", "#aa3377", "#999999")
"""Apart also for the colour-blind; with each hatch in turn for more parts than these."""

_HATCHES = ("", "////", "....", "xxxx") * 20
_TOP = 104.0
_ROUND_OFF = 1e-12


def modes_figure(
    model: Model,
    found: Modes,
    shown: IntArray,
    limit: float = math.inf,
    words: str = "",
    unknown: ModeBands | None = None,
) -> Figure:
    """Strain-energy shares of modes, with their numbers, frequencies and damping ratios.

    Parameters
    ----------
    model : Model
        Whose modes they are.
    found : Modes
        All of them.
    shown : array of int, shape (k,)
        Those to draw, in this order.
    limit : float
        Frequency from which on the films are notably wrong [Hz]: modes from there on are shaded.
    words : str
        What is not drawn, below the axis.
    unknown : ModeBands, optional
        Bands of what is not known, told in place of numerics.
    """
    figure = headed(model, f"{written(model.scene.speed * RPM.factor)} rpm")
    panel = figure.subplots()
    places = np.arange(shown.size)
    bottom = np.zeros(places.size)
    styles = itertools.product(_HATCHES, _FILLS)
    for part, share, (hatch, colour) in zip(found.parts, 100.0 * found.shares[:, shown], styles, strict=False):
        panel.bar(places, share, bottom=bottom, label=part, color=colour, hatch=hatch, edgecolor="w", lw=0.0)
        bottom += share
    level = places.size <= _MOST_LEVEL_LABELS
    labels = [_label(found, int(mode), level, unknown) for mode in shown]
    every = math.ceil(max(places.size, 1) / _MOST_LABELS)
    panel.set_xticks(places[::every], labels[::every], fontsize=7 if level else 6.5, rotation=0 if level else 90)
    panel.set_xlim(-0.8, max(places.size, 1) - 0.2)
    panel.set_ylim(0.0, _TOP)
    panel.set_yticks(np.arange(0, 101, 20))
    quick = places[found.frequency[shown] > limit]
    shades = []
    if quick.size:
        # A strip above the bars, which keep their colours.
        shade(panel, quick[0] - 0.5, quick[-1] + 0.5, bottom=100.0 / _TOP)
        estimated = ESTIMATED.replace(" of the films ", "\nof the films ")
        shades = [shade_handle(f"{estimated}\n(from {limit:.4g} Hz on)")]
    bands = f", ±: {BAND_WORDS}" if level and found.bands is not None and unknown is None else ""
    bands = f", each with {HEAD}" if level and unknown is not None else bands
    panel.set_xlabel(f"mode: frequency |eigenvalue|/(2π), damping ratio ζ{bands}" + (f"\n{words}" if words else ""))
    panel.set_ylabel("part of the strain energy, %")
    handles = panel.get_legend_handles_labels()[0] + shades
    panel.legend(handles=handles, fontsize=7, loc="upper left", bbox_to_anchor=(1.0, 1.0), frameon=False)
    return figure


def _label(modes: Modes, mode: int, level: bool, unknown: ModeBands | None) -> str:
    """Number, frequency and damping ratio of a mode, with what is not known of them where there is room."""
    place = None if unknown is None or not level else unknown.place(mode)
    if unknown is not None and place is not None:
        frequency, damping = unknown.frequency, unknown.damping_ratio
        values = f"{value_text(frequency, place)} Hz", f"ζ {value_text(damping, place)}"
        bounds = [
            bounds_text(band, place).replace(" unsure", "").replace(" to ", " to\n") for band in (frequency, damping)
        ]
        return "\n".join((f"{mode + 1}:", values[0], bounds[0], values[1], bounds[1]))
    ratio = float(modes.damping_ratio[mode])
    parts = [f"{mode + 1}:", f"{modes.frequency[mode]:.5g} Hz", f"ζ {ratio if abs(ratio) > _ROUND_OFF else 0.0:.2g}"]
    if level and modes.bands is not None:
        parts[1:] = [
            *(parts[1], f"± {modes.bands.frequency[mode]:.1g} Hz"),
            *(parts[2], f"± {modes.bands.damping_ratio[mode]:.1g}"),
        ]
    return "\n".join(parts) if level else " ".join(parts)


MOST_SHAPES = 6
"""Modes on a page."""

_LARGEST = 0.18
"""Drawn displacement, as a part of the system."""

_WIDTHS = {AXIS: 2.2, EDGE: 0.9, MARK: 1.4, JOINT: 1.6}
_FLATTEST = 0.35
"""Least extent of a box, as a part of the largest one."""

_NOTHING, _LEAST_RATIO = 1e-9, 1e-12
_CELL, _HEAD, _FOOT = (4.0, 3.1), 0.6, 0.4
"""Size of the place of a mode, and least height of what is above and below all of them [inch]."""

_ABOVE, _LINE = 0.3, 0.2
"""Room above and below the heading, and height of a line of the legend [inch]."""

_LETTERS = 68
"""Letters of a legend that have room over a mode."""

_SURFACE = colormaps["viridis"]
_OPAQUE = 0.55
"""Of a surface: shafts and bearings within are seen."""

_LIGHT = np.array([0.45, -0.75, 0.48])
"""Unit vector towards the light."""

_ZOOM = 0.95
_MOST_NAMES = 12


def shapes_figure(model: Model, found: Modes, bones: Skeleton, shown: Sequence[int], words: str) -> Figure:
    """Draw some modes: thick lines are shafts, thin ones other bodies, red ones bearings and gear meshes.

    Parameters
    ----------
    model : Model
        Whose modes they are.
    found : Modes
        All of them.
    bones : Skeleton
        Places and lines of the system.
    shown : sequence of int
        Indices of up to `MOST_SHAPES` modes.
    words : str
        What the heading says after the law.
    """
    columns = min(len(shown), 3) or 1
    rows = math.ceil(len(shown) / columns) or 1
    width = _CELL[0] * columns
    figure = headed(model, words, (width, _CELL[1] * rows))
    figure.set_layout_engine("none")
    skinned = set(bones.owners[bones.triangles[:, 0]].tolist())
    moving = [index for index in range(len(bones.bodies)) if np.any(bones.owners == index) and index not in skinned]
    handles: list[Any] = [
        Line2D([], [], color=_colour(index), lw=2.0, label=bones.bodies[index]) for index in moving[:_MOST_NAMES]
    ]
    if JOINT in bones.kinds:
        handles.append(Line2D([], [], color=COLOURS[1], lw=1.6, label="bearings and gears"))
    if bones.triangles.size:
        handles.append(Patch(color=_SURFACE(0.75), label="surface: dark moves little, bright most"))
    handles.append(Line2D([], [], color="0.8", lw=1.2, label="at rest"))
    names = legend_columns([str(handle.get_label()) for handle in handles], _LETTERS * columns, 3 * columns)
    foot = max(_FOOT, _LINE * math.ceil(len(handles) / names))
    (heading,) = figure.texts
    without_latex(heading)
    head = max(_HEAD, heading.get_window_extent().height / figure.dpi + _ABOVE)
    height = _CELL[1] * rows + head + foot
    figure.set_size_inches(width, height)
    heading.set_y(1.0 - 0.5 * _ABOVE / height)
    # A picture in three dimensions has wide margins of its own, which may lie over those of its neighbours.
    side = _ZOOM * _CELL[0]
    for place, mode in enumerate(shown):
        x = (place % columns + 0.5) * _CELL[0]
        y = foot + (rows - place // columns - 0.5) * _CELL[1] - 0.15
        where = ((x - 0.5 * side) / width, (y - 0.5 * side) / height, side / width, side / height)
        panel: Any = figure.add_axes(where, projection="3d", computed_zorder=False)
        panel.patch.set_visible(False)
        _mode(panel, found, bones, mode)
        at = (x / width, (y + 0.5 * _CELL[1] + 0.1) / height)
        figure.text(*at, _title(found, bones, mode), fontsize=9, ha="center", va="top")
    figure.legend(handles=handles, loc="lower center", ncols=names, fontsize=8, frameon=False)
    return figure


def _mode(panel: Any, modes: Modes, bones: Skeleton, mode: int) -> None:
    """One mode."""
    moved = bones.displacement(modes.shapes[:, mode]).real
    largest = float(np.max(np.abs(moved), initial=0.0))
    scale = _LARGEST * bones.size / largest if _moves(largest, bones) else 0.0
    places = bones.points + scale * moved
    if bones.triangles.size:
        _surface(panel, bones, places, np.linalg.norm(moved, axis=1))
    for (begin, end), kind in zip(bones.lines, bones.kinds, strict=True):
        pair = [begin, end]
        if kind != JOINT:
            panel.plot(*bones.points[pair].T, color="0.82", lw=0.5 * _WIDTHS[kind], zorder=1)
        colour = COLOURS[1] if kind == JOINT else _colour(int(bones.owners[begin]))
        panel.plot(*places[pair].T, color=colour, lw=_WIDTHS[kind], solid_capstyle="round", zorder=3)
    lines = zip(bones.lines, bones.kinds, strict=True)
    joined = {int(place) for pair, kind in lines if kind in (AXIS, MARK) for place in pair}
    joined |= set(bones.triangles.ravel().tolist())
    alone = [place for place in range(len(places)) if place not in joined]
    colours = [_colour(int(bones.owners[place])) for place in alone]
    panel.scatter(*places[alone].T, s=7.0, c=colours, depthshade=False, zorder=4)
    _box(panel, np.concatenate([bones.points, places]))


def _surface(panel: Any, bones: Skeleton, places: FloatArray, moved: FloatArray) -> None:
    """Surfaces of bodies as they are displaced, coloured by how far; what stands behind is seen through them."""
    from mpl_toolkits.mplot3d.art3d import Poly3DCollection

    corners = places[bones.triangles]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), np.finfo(np.float64).tiny)
    largest = float(np.max(moved[bones.triangles], initial=0.0))
    share = moved[bones.triangles].mean(axis=1) / largest if largest > 0.0 else np.zeros(len(corners))
    colours = _SURFACE(share)
    # Light from the side of the viewer, the same for both faces of a triangle.
    colours[:, :3] *= (0.6 + 0.4 * np.abs(normal @ _LIGHT))[:, np.newaxis]
    colours[:, 3] = _OPAQUE
    panel.add_collection3d(Poly3DCollection(corners, facecolors=colours, edgecolors="none", linewidths=0.0, zorder=2))


def _moves(largest: float, bones: Skeleton) -> bool:
    """Tell whether a place moves at all."""
    return largest > _NOTHING * bones.size


def _title(modes: Modes, bones: Skeleton, mode: int) -> str:
    """Number, frequency and damping ratio of a mode."""
    largest = float(np.max(np.abs(bones.displacement(modes.shapes[:, mode])), initial=0.0))
    ratio = float(modes.damping_ratio[mode])
    text = f"{mode + 1}: {modes.frequency[mode]:.5g} Hz, ζ {ratio if abs(ratio) > _LEAST_RATIO else 0.0:.2g}"
    return text if _moves(largest, bones) else f"{text}; no place moves"


def _box(panel: Any, places: FloatArray) -> None:
    """Equal scales along all axes, and a small cross of axes in place of walls."""
    low, high = places.min(axis=0), places.max(axis=0)
    extent = np.maximum(high - low, _FLATTEST * float(np.max(high - low)))
    middle = 0.5 * (low + high)
    for name, centre, width in zip("xyz", middle, extent, strict=True):
        getattr(panel, f"set_{name}lim")(centre - 0.5 * width, centre + 0.5 * width)
    panel.set_box_aspect(tuple(extent))  # an array would be changed
    panel.set_axis_off()
    panel.view_init(elev=18.0, azim=-62.0)
    corner = middle - 0.5 * extent
    length = 0.12 * float(extent.max())
    for axis, name in enumerate("xyz"):
        tip = corner.copy()
        tip[axis] += length
        panel.plot(*np.column_stack([corner, tip]), color="0.45", lw=0.8)
        panel.text(*tip, name, fontsize=6.5, color="0.35")
    for artist in (*panel.lines, *panel.collections, *panel.texts):
        artist.set_clip_on(False)


def _colour(body: int) -> str:
    """Colour of a body; red is for bearings."""
    own = (COLOURS[0], *COLOURS[2:])
    return own[body % len(own)]


_SIZE = (9.0, 8.5)
_MOST_ROWS = 5
"""Responses drawn: those with the most energy; more would hide each other."""

_UNITS = {"displacement": "m", "velocity": "m/s", "acceleration": "m/s2", "force": "N", "unknown": ""}


def fit_figure(title: str, fit: ModalFit) -> Figure:
    """Magnitude and phase of the responses with the fit, their coherence, and the poles over the order.

    Parameters
    ----------
    title : str
        Heading of the page.
    fit : ModalFit
        What is drawn.
    """
    figure = Figure(figsize=_SIZE, layout="constrained")
    write_heading(figure, f"{title}\n{_summary(fit)}", 10)
    energy = np.sum(np.abs(fit.responses.response) ** 2, axis=1)
    shown = sorted(np.argsort(-energy, kind="stable")[:_MOST_ROWS].tolist())
    known = np.any(np.isfinite(fit.responses.coherence[shown]))
    units = list(dict.fromkeys(_display(*fit.responses.pairs[row]).unit for row in shown))
    heights = [*[3.0 / len(units) ** 0.5] * len(units), 1.4, *([1.0] if known else []), 2.2]
    axes = list(figure.subplots(len(heights), 1, sharex=True, height_ratios=heights))
    magnitudes = dict(zip(units, axes, strict=False))
    _responses(magnitudes, axes[len(units)], fit, shown)
    if known:
        panel = axes[len(units) + 1]
        for row, colour in zip(shown, COLOURS, strict=False):
            panel.plot(fit.responses.frequency, fit.responses.coherence[row], color=colour, lw=0.7)
        panel.set(ylabel=f"coherence,\n{fit.responses.hits} hits", ylim=(0.0, 1.05))
    _diagram(axes[-1], fit)
    for panel in axes:
        for frequency in fit.frequency:
            panel.axvline(frequency, color="0.75", lw=0.7, zorder=0)
        panel.grid(color="0.9", lw=0.5)
        panel.set_axisbelow(True)
        panel.tick_params(labelsize=8)
    axes[0].set_xlim(fit.responses.frequency[0], fit.responses.frequency[-1])
    axes[-1].set_xlabel("frequency, Hz")
    return figure


def _responses(magnitudes: dict[str, Axes], phase: Axes, fit: ModalFit, shown: Sequence[int]) -> None:
    """Measured responses as pale lines, the fit over them."""
    frequency = fit.responses.frequency
    fine = np.unique(np.concatenate([np.linspace(frequency[0], frequency[-1], 4000), *_near(fit)]))
    curves = fit.synthesise(fine)
    for row, colour in zip(shown, COLOURS, strict=False):
        measured = fit.responses.response[row]
        display = _display(*fit.responses.pairs[row])
        magnitude = magnitudes[display.unit]
        label = f"{fit.responses.labels[row]}, {100.0 * fit.error[row]:.2g} % left"
        magnitude.semilogy(frequency, display.factor * np.abs(measured), color=colour, lw=2.2, alpha=0.35)
        magnitude.semilogy(fine, display.factor * np.abs(curves[row]), color=colour, lw=0.9, label=label)
        phase.plot(frequency, np.degrees(np.angle(measured)), ".", color=colour, ms=1.2, alpha=0.35)
        angle = np.degrees(np.angle(curves[row]))
        angle[1:][np.abs(np.diff(angle)) > 180.0] = np.nan  # no line where it jumps from -180 to 180 degrees
        phase.plot(fine, angle, color=colour, lw=0.9)
    for unit, magnitude in magnitudes.items():
        magnitude.set_ylabel(f"response, {unit}")
        magnitude.legend(fontsize=8, frameon=False, title="pale: measured, thin: fit", title_fontsize=8)
    phase.set(ylabel="phase, degrees", yticks=[-180, -90, 0, 90, 180])


def _diagram(panel: Axes, fit: ModalFit) -> None:
    """Poles over the order: stable ones filled."""
    # The window is taken out, so that the poles stand over the peaks.
    poles = np.array([entry.pole for entry in fit.candidates]) + fit.responses.decay
    orders = np.array([entry.order for entry in fit.candidates])
    stable = np.array([entry.stable for entry in fit.candidates], dtype=bool)
    frequency = np.abs(poles) / (2.0 * np.pi)
    panel.plot(frequency[stable], orders[stable], "^", color=COLOURS[1], ms=3.5, label="p-LSCF: stable")
    panel.plot(frequency[~stable], orders[~stable], "^", color=COLOURS[1], ms=2.5, mfc="none", mew=0.4, alpha=0.5)
    panel.set(ylabel="order, pole pairs\n(hollow: not stable)", ylim=(0, int(orders.max()) + 1))
    panel.legend(fontsize=8, frameon=False, ncols=2, loc="lower right", bbox_to_anchor=(1.0, 1.0), borderpad=0.1)


def _near(fit: ModalFit) -> list[np.ndarray[tuple[int], np.dtype[np.float64]]]:
    """Frequencies around each mode, close enough to draw its peak."""
    low, high = fit.responses.frequency[0], fit.responses.frequency[-1]
    frequencies = []
    for pole in fit.poles:
        centre, width = abs(pole) / (2.0 * np.pi), max(abs(pole.real), 1e-6 * abs(pole)) / (2.0 * np.pi)
        frequencies.append(np.clip(centre + width * np.linspace(-8.0, 8.0, 161), low, high))
    return frequencies


def _display(sensor: Channel, reference: Channel) -> Display:
    """Display of a response."""
    unit = _UNITS[sensor.quantity].replace("m", "rad", 1) if sensor.rotational else _UNITS[sensor.quantity]
    shown = MOTIONS.get(unit, Display(unit or "1"))
    return Display(f"{typeset(shown.unit)}/{'(N m)' if reference.rotational else 'N'}", shown.factor)


def _summary(fit: ModalFit) -> str:
    """The modes in a line."""
    modes = [f"{f:.5g} Hz, ζ {100.0 * z:.3g} %" for f, z in zip(fit.frequency[:5], fit.damping_ratio[:5], strict=True)]
    return "; ".join(modes) + (" ..." if fit.poles.size > 5 else "")
