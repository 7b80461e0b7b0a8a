"""Figure of a run in time: bearing forces and displacements, a column a bearing, and the speed."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ehdmaps.arrays import BoolArray, FloatArray
from ehdmaps.figures import COLOURS
from mbs.output.page import grid, headed, shade, shade_handle, whole_numbers
from mbs.scene.assembly import Model
from mbs.transient.run import Recording

_RPM = 30.0 / np.pi
_WIDTH, _COLUMN, _HEIGHT = 9.0, 2.6, 5.8
_LEAST_SPAN = 1e-6
"""Of an axis, as a part of its largest value: less is round-off."""

_LENGTHS = ((1e-6, "µm", 1e6), (1e-9, "nm", 1e9), (0.0, "pm", 1e12))
_FORCES = ((1e4, "kN", 1e-3), (1e-1, "N", 1.0), (0.0, "mN", 1e3))


def run_figure(model: Model, run: Recording, below: float = 0.0, words: str = "") -> Figure:
    """Bearing force, displacement of the inner ring and speed over time; every bearing in panels of its own.

    Parameters
    ----------
    model : Model
        What ran.
    run : Recording
        The run, with its states.
    below : float
        Speed [rad/s] below which the film fades to the dry contact: these times are shaded.
    words : str
        What the shade means, for the legend.
    """
    columns = max(len(model.bearings), 1)
    figure = headed(model, "", (max(_WIDTH, _COLUMN * columns), _HEIGHT))
    axes = figure.subplots(3, columns, sharex=True, sharey="row", squeeze=False)
    forces = [np.hypot(force[:, 1], force[:, 2]) for force in run.forces[: len(model.bearings)]]
    places = [_place(model, run, index) for index in range(len(model.bearings))]
    force_unit, force_factor = _unit(forces, _FORCES)
    length_unit, length_factor = _unit(places, _LENGTHS)
    for index, (bearing, force, place) in enumerate(zip(model.bearings, forces, places, strict=True)):
        colour = COLOURS[index % len(COLOURS)]
        axes[0, index].plot(run.time, force_factor * force, color=colour, lw=0.8)
        axes[1, index].plot(run.time, length_factor * place, color=colour, lw=0.8)
        axes[0, index].set_title(bearing.name, fontsize=9)
    for panel in axes[2]:
        panel.plot(run.time, run.speed * _RPM, color="0.2", lw=1.0)
        panel.set_xlabel("time, s")
    axes[0, 0].set_ylabel(f"bearing force, {force_unit}")
    axes[1, 0].set_ylabel(f"inner ring against\nthe outer one, {length_unit}")
    axes[2, 0].set_ylabel("speed, rpm")
    for panel in axes[:2].ravel():
        panel.set_visible(bool(model.bearings))
    for panel in axes.ravel():
        _room(panel)
        whole_numbers(panel)
        grid(panel)
    if np.any(slow := np.abs(run.speed) < below):
        _shade(figure, axes.ravel().tolist(), run.time, slow, words)
    return figure


def _place(model: Model, run: Recording, index: int) -> FloatArray:
    """Radial displacement of an inner ring against the outer one [m]."""
    bearing = model.bearings[index]
    motion = run.states.displacement @ model.system.relative(bearing.inner, bearing.outer).T
    return np.asarray(np.hypot(motion[:, 1], motion[:, 2]))


def _unit(values: Sequence[FloatArray], units: Sequence[tuple[float, str, float]]) -> tuple[str, float]:
    """Unit and factor in which the largest of some values has a readable number."""
    largest = max((float(part.max(initial=0.0)) for part in values), default=0.0)
    chosen = next(entry for entry in units if largest >= entry[0]) if largest > 0.0 else units[0]
    return chosen[1], chosen[2]


def _room(panel: Axes) -> None:
    """Widen an axis that would show round-off."""
    low, high = panel.get_ylim()
    least = _LEAST_SPAN * max(abs(low), abs(high))
    if high - low < least:
        middle = 0.5 * (low + high)
        panel.set_ylim(middle - 0.5 * least, middle + 0.5 * least)


def _shade(figure: Figure, panels: Sequence[Axes], time: FloatArray, slow: BoolArray, words: str) -> None:
    """Shade the times at which the film fades, and say so."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], slow.astype(np.int64), [0]])))
    for begin, end in zip(edges[::2], edges[1::2], strict=True):
        for panel in panels:
            shade(panel, float(time[begin]), float(time[min(end, time.size - 1)]))
    figure.legend(handles=[shade_handle(words)], loc="outside lower center", fontsize=8, frameon=False)
