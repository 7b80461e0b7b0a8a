"""Films of one operating point on one page, a row a contact: pressure, film, velocity and temperature in the film."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ehdmaps.arrays import BoolArray, FloatArray
from ehdmaps.figures import COLOURS, WARNING, typeset, write_heading
from ehdmaps.openfoam.grid_solver import GridSolution
from ehdmaps.openfoam.results import FilmTable
from ehdmaps.outputs import write_figure
from ehdmaps.units import FILM, PRESSURE, TEMPERATURE

ROW = (11.69, 3.6)
"""Size of a row [inch]."""

RESOLUTION = 200
_FONT: Any = {"font.size": 8.5, "axes.linewidth": 0.6, "xtick.major.width": 0.6, "ytick.major.width": 0.6}
_PLACES = (("inlet", COLOURS[0]), ("centre", COLOURS[7]), ("spike", WARNING))


@dataclass(frozen=True)
class FilmRow:
    """Data that a row shows.

    Attributes
    ----------
    title : str
        Title of the row.
    half_width : float
        b [m].
    surface_speeds : tuple of float
        Speeds of the lower and the upper surface [m/s].
    grid : GridSolution
        Solution on the grid, with its fields.
    """

    title: str
    half_width: float
    surface_speeds: tuple[float, float]
    grid: GridSolution


def plot_films(rows: Sequence[FilmRow], heading: str, output: Path) -> None:
    """Draw the page and write it.

    Parameters
    ----------
    rows : sequence of FilmRow
        One a contact.
    heading : str
        Heading of the page.
    output : Path
        The picture; its ending decides the format (png, pdf, svg).

    Raises
    ------
    InputError
        If it cannot be written, or the ending is not known.
    """
    import matplotlib as mpl

    with mpl.rc_context(_FONT):
        figure = Figure(figsize=(ROW[0], ROW[1] * len(rows) + 0.4), layout="constrained")
        write_heading(figure, heading, 10, "bold")
        warm = any(row.grid.fields is not None and row.grid.fields.T is not None for row in rows)
        panels = figure.subplots(len(rows), 4 if warm else 3, squeeze=False)
        for row, axes in zip(rows, panels, strict=True):
            _row(row, *axes[:3])
            if warm:
                _temperatures(row, axes[3], figure)
        write_figure(figure, output, RESOLUTION)


def places(x: FloatArray, pressure: FloatArray) -> dict[str, float]:
    """Return where velocities are shown [m].

    The inlet is where the pressure first comes to a tenth of its largest; the spike is the last local maximum of the
    pressure above that, which is the largest pressure where there is no spike.
    """
    high = pressure > 0.1 * pressure.max()
    peaks = np.flatnonzero((pressure[1:-1] > pressure[:-2]) & (pressure[1:-1] >= pressure[2:]) & high[1:-1]) + 1
    spike = peaks[-1] if peaks.size else int(np.argmax(pressure))
    return {"inlet": float(x[np.argmax(high)]), "centre": 0.0, "spike": float(x[spike])}


def _row(row: FilmRow, pressures: Axes, films: Axes, velocities: Axes) -> None:
    """Draw the three panels of a contact."""
    table, fields = row.grid.film, row.grid.fields
    x = table.x / row.half_width
    shown = places(table.x, table.pressure)
    window = _window(table, x)
    pressures.plot(x[window], PRESSURE.factor * table.pressure[window], color="black", lw=1.0)
    films.plot(x[window], FILM.factor * table.film[window], color="black", lw=1.0)
    films.set_ylim(bottom=0.0)
    for axes, label in ((pressures, f"pressure, {PRESSURE.unit}"), (films, f"film, {typeset(FILM.unit)}")):
        axes.set_xlabel("x/b, from the contact centre")
        axes.set_ylabel(label)
        axes.grid(color="0.88", lw=0.4)
        for name, colour in _PLACES:
            axes.axvline(shown[name] / row.half_width, color=colour, lw=0.7, ls=(0, (4, 2)))
    pressures.set_title(row.title, fontsize=8.5, fontweight="bold", loc="left")
    if fields is not None:
        rows = fields.quads.shape[0] // x.size
        lower, upper = row.surface_speeds
        for name, colour in _PLACES:
            height, velocity = fields.profile(fields.U[:, 0], shown[name], rows)
            label = f"{name}, x/b {shown[name] / row.half_width:.3g}".replace("-", "−")
            across, along = np.r_[0.0, height, 1.0], np.r_[lower, velocity, upper]
            velocities.plot(along, across, color=colour, lw=1.0, marker=".", ms=3, label=label)
        velocities.legend(
            frameon=False, fontsize=7, ncols=2, loc="lower center", bbox_to_anchor=(0.5, 1.0), borderpad=0.1
        )
    velocities.set_xlabel("velocity along the film, m/s")
    velocities.set_ylabel("y/h, from the lower surface")
    velocities.grid(color="0.88", lw=0.4)


def _window(table: FilmTable, x: FloatArray) -> BoolArray:
    """Columns that are shown: those under load, and some beside."""
    loaded = x[table.pressure > 1e-2 * table.pressure.max()]
    margin = 0.25 * (loaded[-1] - loaded[0])
    return np.asarray((x >= loaded[0] - margin) & (x <= loaded[-1] + margin))


OUTLYING = 0.02
"""Part of the shown area at either end of the temperatures that no colour tells apart: a streak behind the spike, where
the oil is released within a hundredth of the contact, would take the scale from all the rest."""


def colour_limits(x: FloatArray, values: FloatArray) -> tuple[float, float]:
    """Return the values between which colours change: all but `OUTLYING` of the area lies between, at either end.

    Parameters
    ----------
    x : ndarray, shape (n,)
        Places of the columns, rising.
    values : ndarray, shape (rows, n)
        Values in rows of equal height.
    """
    widths = np.broadcast_to(np.gradient(x), values.shape).ravel()
    order = np.argsort(values, axis=None)
    below = np.cumsum(widths[order]) / widths.sum()
    ends = np.searchsorted(below, [OUTLYING, 1.0 - OUTLYING])
    low, high = (float(values.ravel()[order[end]]) for end in ends)
    return (low, high) if low < high else (float(values.min()), float(values.max()))


def _temperatures(row: FilmRow, axes: Axes, figure: Figure) -> None:
    """Draw the temperature in the film of a contact."""
    table, fields = row.grid.film, row.grid.fields
    if fields is None or fields.T is None:
        axes.set_axis_off()
        return
    x = table.x / row.half_width
    window = _window(table, x)
    shown = TEMPERATURE.factor * fields.T.reshape(x.size, -1)[window].T + TEMPERATURE.offset
    heights = (np.arange(shown.shape[0]) + 0.5) / shown.shape[0]
    low, high = colour_limits(x[window], shown)
    image = axes.pcolormesh(
        x[window], heights, shown, shading="nearest", cmap="inferno", vmin=low, vmax=high, rasterized=True
    )
    beyond = {(False, False): "neither", (True, False): "min", (False, True): "max", (True, True): "both"}
    coldest, warmest = float(shown.min()), float(shown.max())
    figure.colorbar(
        image,
        ax=axes,
        extend=beyond[coldest < low, warmest > high],
        label=f"temperature, {typeset(TEMPERATURE.unit)} (all: {coldest:.1f} to {warmest:.1f})",
    )
    axes.set_xlabel("x/b, from the contact centre")
    axes.set_ylabel("y/h, from the lower surface")
