"""Films of point contacts on one page, a row a contact: film and pressure in plan view, and along both axes."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ehdmaps.arrays import FloatArray
from ehdmaps.figures import COLOURS, typeset, write_heading
from ehdmaps.outputs import write_figure
from ehdmaps.physics.solution import Status
from ehdmaps.point.solver import PointSolution
from ehdmaps.units import FILM, LENGTH, PRESSURE

ROW = (11.69, 3.6)
"""Size of a row [inch]."""

RESOLUTION = 200
SHOWN = 1.5
"""Part of the plane that is shown, over the semi-axes."""

_THICKEST = 3.0
"""Largest film of the colours, over the central one."""

_FONT: Any = {"font.size": 8.5, "axes.linewidth": 0.6, "xtick.major.width": 0.6, "ytick.major.width": 0.6}


def plot_points(solutions: Mapping[str, PointSolution], heading: str, output: Path) -> None:
    """Draw the page and write it.

    Parameters
    ----------
    solutions : mapping of str to PointSolution
        Solutions by the name of their contact.
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
        write_figure(points_figure(solutions, heading), output, RESOLUTION)


def points_figure(solutions: Mapping[str, PointSolution], heading: str) -> Figure:
    """Draw the page.

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
        _row(name, solution, list(axes), figure)
    return figure


def _row(name: str, solution: PointSolution, panels: list[Axes], figure: Figure) -> None:
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
