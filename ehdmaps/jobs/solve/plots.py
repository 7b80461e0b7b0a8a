"""Pictures of `ehdmaps solve`, each on one page: films by openfoam, films of point contacts, contacts over frequency.

Films have a row a contact: pressure, film, velocity and temperature in it; of a point contact film and pressure in plan
view, and along both axes. The complex stiffness over frequency has a column a contact.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import matplotlib as mpl
import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ehdmaps.arrays import BoolArray, FloatArray
from ehdmaps.figures import COLOURS, WARNING, typeset, write_heading
from ehdmaps.jobs.solve.spectrum import spectrum_place
from ehdmaps.outputs import write_figure
from ehdmaps.physics.solution import Status
from ehdmaps.units import COMPLIANCE, FILM, LENGTH, PRESSURE, STIFFNESS, TEMPERATURE

if TYPE_CHECKING:
    from ehdmaps.openfoam.grid_solver import GridSolution
    from ehdmaps.openfoam.results import FilmTable
    from ehdmaps.point.solver import PointSolution

ROW = (11.69, 3.6)
"""Size of a row [inch]."""

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


def write_page(output: Path, draw: Callable[..., Figure], *given: object) -> None:
    """Draw a page and write it.

    Parameters
    ----------
    output : Path
        The picture; its ending decides the format (png, pdf, svg).
    draw : callable
        `films_figure`, `points_figure` or `spectrum_figure`.
    *given
        What it takes.

    Raises
    ------
    InputError
        If it cannot be written, or the ending is not known.
    """
    with mpl.rc_context(_FONT):
        write_figure(draw(*given), output)


def films_figure(rows: Sequence[FilmRow], heading: str) -> Figure:
    """Draw the page of films by openfoam.

    Parameters
    ----------
    rows : sequence of FilmRow
        One a contact.
    heading : str
        Heading of the page.
    """
    figure = Figure(figsize=(ROW[0], ROW[1] * len(rows) + 0.4), layout="constrained")
    write_heading(figure, heading, 10, "bold")
    warm = any(row.grid.fields is not None and row.grid.fields.T is not None for row in rows)
    panels = figure.subplots(len(rows), 4 if warm else 3, squeeze=False)
    for row, axes in zip(rows, panels, strict=True):
        _film_row(row, *axes[:3])
        if warm:
            _temperatures(row, axes[3], figure)
    return figure


def places(x: FloatArray, pressure: FloatArray) -> dict[str, float]:
    """Return where velocities are shown [m].

    The inlet is where the pressure first comes to a tenth of its largest; the spike is the last local maximum of the
    pressure above that, which is the largest pressure where there is no spike.
    """
    high = pressure > 0.1 * pressure.max()
    peaks = np.flatnonzero((pressure[1:-1] > pressure[:-2]) & (pressure[1:-1] >= pressure[2:]) & high[1:-1]) + 1
    spike = peaks[-1] if peaks.size else int(np.argmax(pressure))
    return {"inlet": float(x[np.argmax(high)]), "centre": 0.0, "spike": float(x[spike])}


def _film_row(row: FilmRow, pressures: Axes, films: Axes, velocities: Axes) -> None:
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
        rows = fields.corners.shape[0] // x.size
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


SHOWN = 1.5
"""Part of the plane that is shown, over the semi-axes."""

_THICKEST = 3.0
"""Largest film of the colours, over the central one."""


def points_figure(solutions: Mapping[str, PointSolution], heading: str) -> Figure:
    """Draw the page of point contacts.

    Parameters
    ----------
    solutions : mapping of str to PointSolution
        Solutions by the name of their contact.
    heading : str
        Heading of the page.
    """
    figure = Figure(figsize=(ROW[0], ROW[1] * len(solutions) + 0.4), layout="constrained")
    write_heading(figure, typeset(heading), 10, "bold")
    panels = figure.subplots(len(solutions), 4, squeeze=False)
    for (name, solution), axes in zip(solutions.items(), panels, strict=True):
        _point_row(name, solution, list(axes), figure)
    return figure


def _point_row(name: str, solution: PointSolution, panels: list[Axes], figure: Figure) -> None:
    """Draw the panels of a contact."""
    film_map, pressure_map, along, across = panels
    film_map.set_title(name, fontsize=9, fontweight="bold", loc="left")
    field = solution.field
    if field is None:
        why = "dry" if solution.status is Status.ASYMPTOTE else f"{solution.status.word}: no solution"
        film_map.text(0.5, 0.5, why, ha="center", transform=film_map.transAxes)
        for axes in panels:
            axes.set_axis_off()
        return
    a, b = (float(value) for value in solution.ellipse.semi_axes(solution.load))
    x, y = LENGTH.factor * field.x, LENGTH.factor * np.r_[-field.y[:0:-1], field.y]
    reach = SHOWN * LENGTH.factor * a, SHOWN * LENGTH.factor * b
    film, pressure = FILM.factor * _both(field.film), PRESSURE.factor * _both(field.pressure)
    thickest = _THICKEST * FILM.factor * solution.central_film
    thinnest = FILM.factor * float(np.min(field.film))
    levels = np.linspace(0.95 * thinnest, thickest, 25)
    for axes, values, steps, label in (
        (film_map, np.minimum(film, thickest), levels, f"film, {typeset(FILM.unit)}"),
        (pressure_map, pressure, np.linspace(0.0, float(np.max(pressure)), 25), f"pressure, {PRESSURE.unit}"),
    ):
        drawn = axes.contourf(x, y, values.T, levels=steps, cmap="viridis" if axes is film_map else "magma")
        figure.colorbar(drawn, ax=axes, label=label, shrink=0.9)
        turn = np.linspace(0.0, 2.0 * np.pi, 200)
        axes.plot(LENGTH.factor * a * np.cos(turn), LENGTH.factor * b * np.sin(turn), color="white", lw=0.7)
        axes.set_xlim(-reach[0], reach[0])
        axes.set_ylim(-reach[1], reach[1])
        axes.set_xlabel(f"x, {LENGTH.unit}, in the direction of rolling")
        axes.set_ylabel(f"y, {LENGTH.unit}, across")
    middle = int(np.argmin(np.abs(field.x)))
    _profile(along, x, film[:, field.y.size - 1], pressure[:, field.y.size - 1], reach[0], thickest)
    along.set_xlabel(f"x, {LENGTH.unit}, at y = 0")
    _profile(across, y, film[middle], pressure[middle], reach[1], thickest)
    across.set_xlabel(f"y, {LENGTH.unit}, at x = 0")


def _profile(
    axes: Axes, place: FloatArray, film: FloatArray, pressure: FloatArray, reach: float, thickest: float
) -> None:
    """Film and pressure along a line."""
    axes.plot(place, film, color=COLOURS[0], lw=1.1)
    axes.set_ylim(0.0, thickest)
    axes.set_xlim(-reach, reach)
    axes.set_ylabel(f"film, {typeset(FILM.unit)}", color=COLOURS[0])
    axes.grid(color="0.9", lw=0.4)
    beside = axes.twinx()
    beside.plot(place, pressure, color=COLOURS[1], lw=1.1)
    beside.set_ylim(bottom=0.0)
    beside.set_ylabel(f"pressure, {PRESSURE.unit}", color=COLOURS[1])


def _both(half: FloatArray) -> FloatArray:
    """Both halves of a field."""
    return np.concatenate([half[:, :0:-1], half], axis=1)


COLUMN = (5.6, 7.6)
"""Size of a column [inch]."""

_LINE, _SLOW, _NEGATIVE = "#1b6ca8", "0.45", "#c8102e"


def spectrum_figure(dataset: xr.Dataset, title: str) -> Figure:
    """Draw the page of contacts over frequency.

    Parameters
    ----------
    dataset : xarray.Dataset
        See `ehdmaps.jobs.solve.spectrum.spectrum_dataset`.
    title : str
        Bearing and oil.
    """
    contacts = dataset["contact"].values.tolist()
    figure = Figure(figsize=(COLUMN[0] * max(len(contacts), 1), COLUMN[1]), layout="constrained")
    place = spectrum_place(dataset).replace("degC", "°C")
    write_heading(figure, f"{title}: {place}; {dataset.attrs['solver']}", 10, "bold")
    panels = figure.subplots(3, len(contacts), squeeze=False, sharex=True)
    for contact, column in zip(contacts, panels.T, strict=True):
        _column(dataset.sel(contact=contact), contact, list(column))
    return figure


def _column(chosen: xr.Dataset, contact: str, panels: list[Axes]) -> None:
    """Draw the panels of a contact."""
    real, loss, film = panels
    real.set_title(contact, fontsize=9, fontweight="bold", loc="left")
    film.set_xlabel("frequency, Hz")
    status = Status(int(chosen["status"]))
    if not status.usable:
        real.text(0.5, 0.5, f"{status.word}: no solution", ha="center", transform=real.transAxes)
        return
    frequency = np.asarray(chosen["frequency"].values)
    omega = 2.0 * np.pi * frequency
    k, c = chosen["stiffness"].values, chosen["damping"].values
    _banded(real, frequency, STIFFNESS.factor * k, chosen["stiffness_error"].values)
    real.axhline(STIFFNESS.factor * float(chosen["slow_stiffness"]), color=_SLOW, lw=0.9, ls=(0, (5, 2)))
    real.set_ylabel(f"real part k, {STIFFNESS.unit}".replace("um", "µm"))

    lossy = STIFFNESS.factor * omega * c
    _banded(loss, frequency, lossy, chosen["damping_error"].values)
    slow = STIFFNESS.factor * omega * float(chosen["slow_damping"])
    band = np.nan_to_num(chosen["damping_error"].values)
    low, high = _limits(lossy * (1.0 - band), lossy * (1.0 + band))
    loss.plot(frequency, slow, color=_SLOW, lw=0.9, ls=(0, (5, 2)), label="k and c of slow motion")
    loss.set_ylim(low, high)
    loss.set_ylabel(f"loss part ωc, {STIFFNESS.unit}".replace("um", "µm"))

    compliance, share = COMPLIANCE.factor * chosen["film_compliance"].values, chosen["film_compliance_error"].values
    error = share * np.abs(compliance)
    for values, colour, name in ((compliance.real, "#444444", "real part"), (-compliance.imag, "#d17b0f", "loss part")):
        film.plot(frequency, values, color=colour, lw=1.1, label=f"{name} of S")
        film.fill_between(frequency, values - error, values + error, color=colour, alpha=0.25, lw=0.0)
    film.axhline(0.0, color="black", lw=0.5)
    film.set_ylabel(f"film compliance S, {COMPLIANCE.unit}".replace("um", "µm"))

    fed = c < 0.0
    for axes in panels:
        axes.set_xscale("log")
        axes.grid(color="0.9", lw=0.4)
        axes.margins(x=0.0)
        for first, last in _bands(fed):
            ends = _edges(frequency, first, last)
            words = (
                "negative damping: the film feeds the oscillation" if axes is loss and first == np.argmax(fed) else None
            )
            axes.axvspan(*ends, facecolor=_NEGATIVE, alpha=0.13, lw=0.0, label=words)
    loss.axhline(0.0, color="black", lw=0.5)
    loss.legend(frameon=False, fontsize=7.5, loc="best")
    film.legend(frameon=False, fontsize=7.5, loc="best")
    _second_axis(real, frequency, chosen["omega_b_over_u"].values)


def _banded(axes: Axes, frequency: FloatArray, values: FloatArray, error: FloatArray) -> None:
    """A curve with the band of its estimated numerical error, where there is one."""
    stated = np.isfinite(error).any()
    label = "at the frequency, with its estimated error" if stated else "at the frequency"
    axes.plot(frequency, values, color=_LINE, lw=1.2, label=label)
    axes.fill_between(frequency, values * (1.0 - error), values * (1.0 + error), color=_LINE, alpha=0.25, lw=0.0)


def _limits(low: FloatArray, high: FloatArray) -> tuple[float, float]:
    """Range of a panel that shows all of a band, and zero."""
    bottom, top = min(float(np.min(low)), 0.0), max(float(np.max(high)), 0.0)
    margin = 0.08 * (top - bottom or 1.0)
    return bottom - margin, top + margin


def _bands(fed: BoolArray) -> list[tuple[int, int]]:
    """First and last index of each run of frequencies."""
    steps = np.flatnonzero(np.diff(np.r_[False, fed, False].astype(int)))
    return [(int(first), int(last) - 1) for first, last in zip(steps[::2], steps[1::2], strict=True)]


def _edges(frequency: FloatArray, first: int, last: int) -> tuple[float, float]:
    """Ends of a band, half-way to the frequencies beside it."""
    middles = np.sqrt(frequency[1:] * frequency[:-1])
    return float(np.r_[frequency[0], middles][first]), float(np.r_[middles, frequency[-1]][last])


def _second_axis(axes: Axes, frequency: FloatArray, reduced: FloatArray) -> None:
    """Omega b/u above the panel; none at a standstill."""
    ratio = float(reduced[0] / frequency[0])
    if not np.isfinite(ratio):
        return
    to_ratio, to_frequency = (partial(np.multiply, factor) for factor in (ratio, 1.0 / ratio))
    above = axes.secondary_xaxis("top", functions=(to_ratio, to_frequency))
    above.set_xlabel("ω b/u")
