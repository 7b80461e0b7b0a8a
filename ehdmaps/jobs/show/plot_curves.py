"""One panel of the page of a map: a variable over load, one curve a speed, with marks on what is no plain solution."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.colors import LogNorm, Normalize
from matplotlib.ticker import FixedLocator, FuncFormatter, LogLocator, NullLocator

from ehdmaps.arrays import FloatArray
from ehdmaps.exports.map_curves import curves
from ehdmaps.figures import WARNING, spread
from ehdmaps.maps.emap import EHDMap
from ehdmaps.maps.film_field import FilmField, known_at
from ehdmaps.physics.solution import Status, usable_points
from ehdmaps.units import LOAD, Display

MOST_CURVES = 12

_OF_LAWS = ("stiffness", "damping", "approach")
"""Variables that are drawn from the films of contact laws, where a map has them between its points."""

CURVE_POINTS = 400
"""Loads of such a curve: the damping valley is a few per cent wide."""

LINEAR_APPROACH = 1.0
"""Approach [um] below which its axis is linear: it is negative where films are thicker than the bodies give way."""

ASYMPTOTE: Any = {"marker": "^", "ms": 2.8, "mfc": "white", "mew": 0.6}
BELOW: Any = {"marker": "v", "ms": 3.5}
FILLED: Any = {"marker": "o", "ms": 4, "mfc": "none", "mec": WARNING, "mew": 0.9}
LOST: Any = {"marker": "x", "ms": 4, "color": WARNING}
HATCH: Any = {"facecolor": "none", "edgecolor": "0.8", "hatch": "////", "lw": 0.0, "zorder": 0}
"""Pressures beyond those to which the viscosity of the oil is stated."""

REACH: Any = {"color": "0.35", "lw": 0.9, "ls": (0, (1, 1.5)), "zorder": 1}
"""Where pressures pass a reach of the viscosity that nobody stated: a line, because nothing is known to end there."""


@dataclass(frozen=True)
class Sheet:
    """The map and what its panels share.

    Attributes
    ----------
    emap : EHDMap
        The map.
    field : FilmField or None
        Films of its contact laws; None where it makes none.
    derived : xarray.Dataset or None
        Variables of its points that follow from it, and are drawn as its own.
    """

    emap: EHDMap
    field: FilmField | None
    derived: xr.Dataset | None = None

    @cached_property
    def dataset(self) -> xr.Dataset:
        """Data of the map, and those derived from it."""
        return self.emap.dataset if self.derived is None else self.emap.dataset.assign(self.derived.data_vars)

    @property
    def speeds(self) -> FloatArray:
        """Entrainment speeds [m/s]."""
        return np.asarray(self.dataset["entrainment_speed"].values, dtype=np.float64)

    @cached_property
    def colours(self) -> Normalize:
        """The scale of the speed's colours; a standstill takes the colour of the lowest speed."""
        low, high = _lowest(self.speeds), float(max(self.speeds.max(), 1e-6))
        return LogNorm(low, high if high > low else 2 * low)

    @cached_property
    def extrapolated_from(self) -> dict[tuple[int, int], float]:
        """Lowest load with an extrapolated viscosity [N/m], of the contacts and temperatures that have one."""
        beyond = np.asarray(self.dataset["viscosity_extrapolated"].values.max(axis=2) > 0)
        loads = self.dataset["load"].values
        return {(i, k): float(loads[beyond[i, :, k]][0]) for i, k in zip(*np.nonzero(beyond.any(axis=1)), strict=True)}


def draw_curves(
    axes: Axes, sheet: Sheet, name: str, display: Display, place: tuple[int, int], width: float = 1.0
) -> None:
    """Draw one variable over load, one curve a speed, with marks on the points that are not converged.

    Parameters
    ----------
    axes : Axes
        The panel.
    sheet : Sheet
        The map.
    name : str
        The variable.
    display : Display
        Unit of the variable on the page.
    place : tuple of int
        Indices of contact and temperature.
    width : float
        Width of the curves, as a share of that in the large panels.
    """
    contact, temperature = place
    dataset = sheet.dataset
    loads = LOAD.factor * dataset["load"].values
    here = dataset.isel(contact=contact, temperature=temperature)
    values = display.factor * here[name].values
    if name != "approach":
        values = np.where(values > 0, values, np.nan)
    for index in spread(sheet.speeds.size, MOST_CURVES):
        colour = _colour(sheet, index)
        dense = dense_curve(sheet, name, (contact, temperature), index)
        if dense is None:
            axes.plot(loads, values[:, index], color=colour, lw=width)
            if loads.size == 1 or sheet.field is not None:
                axes.plot(loads, values[:, index], ls="", marker=".", ms=1.6 * width, color=colour)
        else:
            axes.plot(LOAD.factor * dense[0], display.factor * dense[1], color=colour, lw=width)
            axes.plot(loads, values[:, index], ls="", marker=".", ms=1.6 * width, color=colour)
        _marks(axes, here, name, index, loads, values[:, index], colour)
    if name == "stiffness":
        dry = sheet.emap.contacts[contact].structural_compliance(dataset["load"].values)
        axes.plot(loads, display.factor / dry, color="black", lw=0.8, ls=(0, (4, 2)), zorder=1)
    _scales(axes, loads, display.factor * here[name].values, name)
    if place in sheet.extrapolated_from:
        start = LOAD.factor * sheet.extrapolated_from[place]
        if sheet.emap.lubricant.reach_assumed:
            axes.axvline(start, **REACH)
        else:
            axes.axvspan(start, max(loads[-1], start), **HATCH)


def dense_curve(sheet: Sheet, name: str, place: tuple[int, int], speed: int) -> tuple[FloatArray, FloatArray] | None:
    """Loads [N/m] and values [SI] between the solved points; None where nothing is known there.

    Parameters
    ----------
    sheet : Sheet
        The map.
    name : str
        The variable.
    place : tuple of int
        Indices of contact and temperature.
    speed : int
        Index of the speed.
    """
    contact, temperature = place
    u, axis = float(sheet.speeds[speed]), sheet.dataset["load"].values
    if sheet.field is None or name not in _OF_LAWS or u == 0.0 or axis.size == 1:
        return None
    loads = np.geomspace(axis[0], axis[-1], CURVE_POINTS)
    celsius = float(sheet.dataset["temperature"].values[temperature])
    curve = curves(sheet.field, (sheet.emap.contacts[contact],), loads, u, celsius)
    return loads, np.where(known_at(sheet.field, loads, u, celsius), getattr(curve, name), np.nan)


def _marks(
    axes: Axes,
    here: xr.Dataset,
    name: str,
    index: int,
    loads: FloatArray,
    curve: FloatArray,
    colour: Any,
) -> None:
    """Mark the points of one curve that are no plain solutions."""
    status, filled = here["status"].values[:, index], here["filled"].values[:, index].astype(bool)
    below = here[name].values[:, index] <= 0
    if name != "approach" and below.any() and (here[name].values > 0).any():
        low = np.full(np.count_nonzero(below), 0.03)
        axes.plot(loads[below], low, ls="", **BELOW, color=colour, transform=axes.get_xaxis_transform())
    asymptote = status == int(Status.ASYMPTOTE)
    axes.plot(loads[asymptote], curve[asymptote], ls="", mec=colour, **ASYMPTOTE)
    axes.plot(loads[filled], curve[filled], ls="", **FILLED)
    unsolved = ~usable_points(status) & ~filled
    low = np.full(np.count_nonzero(unsolved), 0.03)
    axes.plot(loads[unsolved], low, ls="", **LOST, transform=axes.get_xaxis_transform())


def _colour(sheet: Sheet, index: int) -> Any:
    """Return the colour of a speed."""
    import matplotlib as mpl

    return mpl.colormaps["viridis"](sheet.colours(max(sheet.speeds[index], _lowest(sheet.speeds))))


def _scales(axes: Axes, loads: FloatArray, values: FloatArray, name: str) -> None:
    """Set log scales where there is something to show, and a quiet grid."""
    axes.set_xscale("log")
    # one load stands alone in the middle of two decades
    beside = 1.0 if loads.size > 1 else 10.0
    axes.set_xlim(loads[0] / beside, loads[-1] * beside)
    known = values[np.isfinite(values)]
    positive = known[known > 0]
    if name == "approach" and known.size:
        _approach_scale(axes, known)
    elif positive.size:
        _positive_scale(axes, positive, name)
    else:
        axes.annotate("zero" if known.size else "no solution", (0.5, 0.5), xycoords="axes fraction", ha="center")
        axes.set_yticks([])
    axes.xaxis.set_major_locator(LogLocator(numticks=7))
    axes.grid(color="0.88", lw=0.4)
    axes.tick_params(length=2.5, pad=1.5)


def _approach_scale(axes: Axes, known: FloatArray) -> None:
    """Logarithmic both ways from zero, linear about it."""
    axes.set_yscale("symlog", linthresh=LINEAR_APPROACH, linscale=0.6)
    low, high = (1.5 * limit if abs(limit) > LINEAR_APPROACH else 1.1 * limit for limit in (known.min(), known.max()))
    if low < high:
        axes.set_ylim(low, high)
    decades = 10.0 ** np.arange(0, 8)
    axes.yaxis.set_major_locator(FixedLocator([*(-decades[::-1]), 0.0, *decades]))
    axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axes.yaxis.set_minor_locator(NullLocator())
    axes.axhline(0.0, color="0.6", lw=0.5, zorder=0)


def _positive_scale(axes: Axes, positive: FloatArray, name: str) -> None:
    """Logarithmic, with more numbers where there is less than two decades."""
    axes.set_yscale("log")
    # The film's tail at light load, and the law's floor in the valley, run over decades in which nobody reads.
    low, high = float(positive.min()), float(positive.max())
    floor = {"stiffness": 1e-3 * high, "damping": 1e-5 * high}.get(name, low)
    axes.set_ylim(max(low * 0.7, floor), high * 2.0)
    axes.yaxis.set_major_locator(LogLocator(numticks=7))
    if np.ptp(np.log10(positive)) > 2:
        axes.yaxis.set_minor_locator(NullLocator())
    else:
        axes.yaxis.set_minor_locator(LogLocator(subs=(2, 5)))
        axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
        axes.yaxis.set_minor_formatter(FuncFormatter(lambda value, _: f"{value:g}"))


def keep_corners_free(axes: Axes) -> None:
    """Label no decade at the ends of the load axis, where the numbers of two panels would meet."""
    low, high = axes.get_xlim()
    decades = 10.0 ** np.arange(np.floor(np.log10(low)), np.ceil(np.log10(high)) + 1)
    inside = decades[(decades > 1.5 * low) & (decades < high / 1.5)]
    axes.xaxis.set_major_locator(FixedLocator((inside if inside.size else decades).tolist()))


def _lowest(speeds: FloatArray) -> float:
    """Return the lowest speed above zero."""
    positive = speeds[speeds > 0]
    return float(positive.min()) if positive.size else 1e-6
