"""Pictures of mode shapes: lines of shafts, points of bodies, at rest and deformed."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from ehdmaps.arrays import FloatArray
from ehdmaps.figures import COLOURS, legend_columns
from mbs.linearised.modes import Modes
from mbs.linearised.shapes import AXIS, EDGE, JOINT, MARK, Skeleton
from mbs.output.page import headed
from mbs.scene.assembly import Model

MOST_SHAPES = 6
"""Modes on a page."""

_LARGEST = 0.18
"""Drawn displacement, as a part of the system."""

_WIDTHS = {AXIS: 2.2, EDGE: 0.9, MARK: 1.4, JOINT: 1.6}
_FLATTEST = 0.35
"""Least extent of a box, as a part of the largest one."""

_NOTHING, _ROUND_OFF = 1e-9, 1e-12
_CELL, _HEAD, _FOOT = (4.0, 3.1), 0.6, 0.4
"""Size of the place of a mode, and least height of what is above and below all of them [inch]."""

_ABOVE, _LINE = 0.3, 0.2
"""Room above and below the heading, and height of a line of the legend [inch]."""

_LETTERS = 68
"""Letters of a legend that have room over a mode."""

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
    moving = [index for index in range(len(bones.bodies)) if np.any(bones.owners == index)]
    handles = [
        Line2D([], [], color=_colour(index), lw=2.0, label=bones.bodies[index]) for index in moving[:_MOST_NAMES]
    ]
    if JOINT in bones.kinds:
        handles.append(Line2D([], [], color=COLOURS[1], lw=1.6, label="bearings and gears"))
    handles.append(Line2D([], [], color="0.8", lw=1.2, label="at rest"))
    names = legend_columns([str(handle.get_label()) for handle in handles], _LETTERS * columns, 3 * columns)
    foot = max(_FOOT, _LINE * math.ceil(len(handles) / names))
    (heading,) = figure.texts
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
        panel: Any = figure.add_axes(where, projection="3d")
        panel.patch.set_visible(False)
        _mode(panel, found, bones, mode)
        at = (x / width, (y + 0.5 * _CELL[1] + 0.1) / height)
        figure.text(*at, _title(found, bones, mode), fontsize=9, ha="center", va="top")
    figure.legend(handles=handles, loc="lower center", ncols=names, fontsize=8, frameon=False)
    return figure


def _mode(panel: Any, found: Modes, bones: Skeleton, mode: int) -> None:
    """One mode."""
    moved = bones.displacement(found.shapes[:, mode]).real
    largest = float(np.max(np.abs(moved), initial=0.0))
    scale = _LARGEST * bones.size / largest if _moves(largest, bones) else 0.0
    places = bones.points + scale * moved
    for (begin, end), kind in zip(bones.lines, bones.kinds, strict=True):
        pair = [begin, end]
        if kind != JOINT:
            panel.plot(*bones.points[pair].T, color="0.82", lw=0.5 * _WIDTHS[kind], zorder=1)
        colour = COLOURS[1] if kind == JOINT else _colour(int(bones.owners[begin]))
        panel.plot(*places[pair].T, color=colour, lw=_WIDTHS[kind], solid_capstyle="round", zorder=3)
    lines = zip(bones.lines, bones.kinds, strict=True)
    joined = {int(place) for pair, kind in lines if kind in (AXIS, MARK) for place in pair}
    alone = [place for place in range(len(places)) if place not in joined]
    colours = [_colour(int(bones.owners[place])) for place in alone]
    panel.scatter(*places[alone].T, s=7.0, c=colours, depthshade=False, zorder=4)
    _box(panel, np.concatenate([bones.points, places]))


def _moves(largest: float, bones: Skeleton) -> bool:
    """Whether a place moves at all."""
    return largest > _NOTHING * bones.size


def _title(found: Modes, bones: Skeleton, mode: int) -> str:
    """Number, frequency and damping ratio of a mode."""
    largest = float(np.max(np.abs(bones.displacement(found.shapes[:, mode])), initial=0.0))
    ratio = float(found.damping_ratio[mode])
    text = f"{mode + 1}: {found.frequency[mode]:.5g} Hz, ζ {ratio if abs(ratio) > _ROUND_OFF else 0.0:.2g}"
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
