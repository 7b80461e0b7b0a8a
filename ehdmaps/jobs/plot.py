"""A map on one page: families of curves over load, coloured by speed, for every contact and temperature."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import LogNorm, Normalize
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import FixedLocator, FuncFormatter, LogLocator, NullLocator

from ehdmaps.arrays import FloatArray
from ehdmaps.figures import WARNING, typeset
from ehdmaps.jobs.curves import curves, law_field
from ehdmaps.jobs.report import fitted_pressure, plain, span
from ehdmaps.maps import schema
from ehdmaps.maps.emap import EHDMap
from ehdmaps.maps.film_field import FilmField
from ehdmaps.maps.records import record_from_json
from ehdmaps.outputs import write_figure
from ehdmaps.physics.solution import Status
from ehdmaps.units import DAMPING, FILM, LOAD, SPEED, STIFFNESS, TEMPERATURE, Display

A4_LANDSCAPE = (11.69, 8.27)
RESOLUTION = 200
MOST_CURVES = 12
MOST_TEMPERATURES = 6
SHOWN_TEMPERATURE = 313.15
"""The full panels are at the mapped temperature nearest to this one [K]: where oils are compared."""

_PANELS: tuple[tuple[str, str, Display], ...] = (
    ("stiffness", "stiffness k", STIFFNESS),
    ("damping", "damping c", DAMPING),
    ("approach", "approach", FILM),
    ("central_film", "central film", FILM),
    ("minimum_film", "minimum film", FILM),
)
_SMALL = _PANELS[:2]
_OF_LAWS = ("stiffness", "damping", "approach")
"""Variables that are drawn from the films of contact laws, where a map has them between its points."""

CURVE_POINTS = 400
"""Loads of such a curve: the damping valley is a few per cent wide."""

LINEAR_APPROACH = 1.0
"""Approach [um] below which its axis is linear: it is negative where films are thicker than the bodies give way."""

_FONT: Any = {"font.size": 7.5, "axes.linewidth": 0.6, "xtick.major.width": 0.6, "ytick.major.width": 0.6}
_LOGARITHMIC = ("stiffness", "damping", "central_film", "minimum_film")
_ASYMPTOTE: Any = {"marker": "^", "ms": 2.8, "mfc": "white", "mew": 0.6}
_BELOW: Any = {"marker": "v", "ms": 3.5}
_FILLED: Any = {"marker": "o", "ms": 4, "mfc": "none", "mec": WARNING, "mew": 0.9}
_LOST: Any = {"marker": "x", "ms": 4, "color": WARNING}
_HATCH: Any = {"facecolor": "none", "edgecolor": "0.8", "hatch": "////", "lw": 0.0, "zorder": 0}


@dataclass(frozen=True)
class _Sheet:
    """The map and what its panels share."""

    emap: EHDMap
    field: FilmField | None

    @property
    def dataset(self) -> xr.Dataset:
        """What the map holds."""
        return self.emap.dataset

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


def plot_map(emap: EHDMap, output: Path) -> None:
    """Draw the page and write it.

    Parameters
    ----------
    emap : EHDMap
        The map.
    output : Path
        The picture; its ending decides the format (png, pdf, svg).

    Raises
    ------
    InputError
        If it cannot be written, or the ending is not known.
    MapError
        If its contacts, its bearing or its oil do not read.
    """
    import matplotlib as mpl

    with mpl.rc_context(_FONT):
        write_figure(_page(_Sheet(emap, law_field(emap))), output, RESOLUTION)


def _page(sheet: _Sheet) -> Figure:
    """Draw the page: a row of panels a contact, then small ones a temperature."""
    figure, dataset = Figure(figsize=A4_LANDSCAPE), sheet.dataset
    temperatures = _spread(dataset.sizes["temperature"], MOST_TEMPERATURES)
    shown = int(np.argmin(np.abs(dataset["temperature"].values - SHOWN_TEMPERATURE)))
    contacts = dataset.sizes["contact"]
    small = len(temperatures) > 1
    _heading(figure, sheet.emap, shown)

    middle = 0.385 if small else 0.10
    grid = figure.add_gridspec(
        contacts,
        len(_PANELS),
        left=0.057,
        right=0.92,
        top=0.875,
        bottom=middle + 0.055,
        wspace=0.30,
        hspace=0.16,
    )
    for row in range(contacts):
        for column, (name, label, display) in enumerate(_PANELS):
            axes = figure.add_subplot(grid[row, column])
            _curves(axes, sheet, name, display, (row, shown))
            axes.set_ylabel(f"{label}, {typeset(display.unit)}", labelpad=1)
            if row == 0:
                axes.set_title(label, fontsize=8.5, fontweight="bold", pad=4)
            if row == contacts - 1:
                axes.set_xlabel(f"load, {LOAD.unit}", labelpad=1)
            axes.tick_params(labelbottom=row == contacts - 1)
            if column == 0:
                axes.annotate(
                    str(dataset["contact"].values[row]),
                    (0.95, 0.06),
                    xycoords="axes fraction",
                    fontweight="bold",
                    ha="right",
                )
    if small:
        _small_multiples(figure, sheet, temperatures, middle)
    scale = figure.add_axes((0.936, middle + 0.055, 0.011, 0.875 - middle - 0.055))
    bar = figure.colorbar(ScalarMappable(sheet.colours, "viridis"), cax=scale)
    shown_speeds = [sheet.speeds[index] for index in _spread(sheet.speeds.size, MOST_CURVES)]
    bar.set_ticks([speed for speed in shown_speeds if speed > 0.0], minor=False)
    bar.ax.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:.2g}"))
    bar.ax.yaxis.set_minor_locator(NullLocator())
    bar.ax.tick_params(length=2.0, pad=1.5)
    bar.set_label(f"entrainment speed, {SPEED.unit}", labelpad=1)
    _legend(figure, sheet)
    return figure


def _small_multiples(figure: Figure, sheet: _Sheet, temperatures: list[int], top: float) -> None:
    """Draw stiffness and damping of the first contact at each temperature, on common axes."""
    dataset = sheet.dataset
    grid = figure.add_gridspec(
        len(_SMALL),
        len(temperatures),
        left=0.057,
        right=0.92,
        top=top - 0.05,
        bottom=0.112,
        wspace=0.06,
        hspace=0.08,
    )
    first = str(dataset["contact"].values[0])
    figure.text(
        0.057,
        top - 0.012,
        f"{_contact_words(first)}, over temperature of the oil",
        fontsize=8.5,
        fontweight="bold",
    )
    for row, (name, label, display) in enumerate(_SMALL):
        left: Axes | None = None
        for column, temperature in enumerate(temperatures):
            axes = figure.add_subplot(grid[row, column], sharey=left, sharex=left)
            left = left or axes
            _curves(axes, sheet, name, display, (0, temperature), width=0.7)
            axes.tick_params(which="both", labelleft=column == 0, labelbottom=row == len(_SMALL) - 1)
            if row == 0:
                heading = typeset(TEMPERATURE.text(float(dataset["temperature"].values[temperature])))
                axes.set_title(heading, fontsize=7.5, pad=2.5)
            _keep_corners_free(axes)
            if column == 0:
                axes.set_ylabel(f"{label}\n{typeset(display.unit)}", labelpad=2)
            if row == len(_SMALL) - 1:
                axes.set_xlabel(f"load, {LOAD.unit}", labelpad=1)


def _curves(axes: Axes, sheet: _Sheet, name: str, display: Display, place: tuple[int, int], width: float = 1.0) -> None:
    """Draw one variable over load, one curve a speed, with marks on the points that are not converged."""
    contact, temperature = place
    dataset = sheet.dataset
    loads = LOAD.factor * dataset["load"].values
    here = dataset.isel(contact=contact, temperature=temperature)
    values = display.factor * here[name].values
    if name != "approach":
        values = np.where(values > 0, values, np.nan)
    for index in _spread(sheet.speeds.size, MOST_CURVES):
        colour = _colour(sheet, index)
        dense = _dense(sheet, name, contact, temperature, index)
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
        axes.axvspan(start, max(loads[-1], start), **_HATCH)


def _dense(
    sheet: _Sheet, name: str, contact: int, temperature: int, speed: int
) -> tuple[FloatArray, FloatArray] | None:
    """Loads [N/m] and values [SI] between the solved points; None where nothing is known there."""
    u, axis = float(sheet.speeds[speed]), sheet.dataset["load"].values
    if sheet.field is None or name not in _OF_LAWS or u == 0.0 or axis.size == 1:
        return None
    loads = np.geomspace(axis[0], axis[-1], CURVE_POINTS)
    celsius = float(sheet.dataset["temperature"].values[temperature])
    found = curves(sheet.field, (sheet.emap.contacts[contact],), loads, u, celsius)
    return loads, getattr(found, name)


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
        axes.plot(loads[below], low, ls="", **_BELOW, color=colour, transform=axes.get_xaxis_transform())
    asymptote = status == int(Status.ASYMPTOTE)
    axes.plot(loads[asymptote], curve[asymptote], ls="", mec=colour, **_ASYMPTOTE)
    axes.plot(loads[filled], curve[filled], ls="", **_FILLED)
    lost = ~np.isin(status, [int(known) for known in Status if known.usable]) & ~filled
    low = np.full(np.count_nonzero(lost), 0.03)
    axes.plot(loads[lost], low, ls="", **_LOST, transform=axes.get_xaxis_transform())


def _colour(sheet: _Sheet, index: int) -> Any:
    """Return the colour of a speed."""
    import matplotlib as mpl

    return mpl.colormaps["viridis"](sheet.colours(max(sheet.speeds[index], _lowest(sheet.speeds))))


def _scales(axes: Axes, loads: FloatArray, values: FloatArray, name: str) -> None:
    """Set log scales where there is something to show, and a quiet grid."""
    axes.set_xscale("log")
    if loads.size > 1:
        axes.set_xlim(loads[0], loads[-1])
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
    axes.set_ylim(
        *(1.5 * limit if abs(limit) > LINEAR_APPROACH else 1.1 * limit for limit in (known.min(), known.max()))
    )
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


def _keep_corners_free(axes: Axes) -> None:
    """Label no decade at the ends of the load axis, where the numbers of two panels would meet."""
    low, high = axes.get_xlim()
    decades = 10.0 ** np.arange(np.floor(np.log10(low)), np.ceil(np.log10(high)) + 1)
    inside = decades[(decades > 1.5 * low) & (decades < high / 1.5)]
    axes.xaxis.set_major_locator(FixedLocator((inside if inside.size else decades).tolist()))


def _heading(figure: Figure, emap: EHDMap, shown: int) -> None:
    """Write the title and, below it, what the page shows."""
    dataset, attributes = emap.dataset, emap.dataset.attrs
    at = typeset(TEMPERATURE.text(float(dataset["temperature"].values[shown])))
    what = emap.bearing.title if emap.bearing else f"line contact, R = {emap.contacts[0].radius * 1e3:.4g} mm"
    estimated = "pressure-viscosity estimated" if emap.lubricant.estimated else "data not verified"
    unverified = "" if emap.lubricant.verified else f" ({estimated})"
    oil = emap.lubricant.title if emap.lubricant.title.endswith("oil") else f"oil {emap.lubricant.title}"
    _write(figure, 0.963, f"EHD contact map: {what}, {oil}{unverified}", 13, "bold")
    _write(
        figure,
        0.928,
        f"Per unit length of contact, at {at} over load and entrainment speed.  "
        f"Solver {plain(attributes['solver'])}, structural law {plain(attributes['structural_law'])}.  "
        f"Mapped: {span(dataset['load'].values, LOAD)}, {span(dataset['entrainment_speed'].values, SPEED)}, "
        f"{typeset(span(dataset['temperature'].values, TEMPERATURE))}.",
        8,
    )


def _write(
    figure: Figure, height: float, text: str, size: float, weight: str = "normal", colour: str = "black"
) -> None:
    """Write a line of the page; texts of a map are no formulas."""
    figure.text(0.057, height, text, fontsize=size, fontweight=weight, color=colour, va="center", parse_math=False)


def _legend(figure: Figure, sheet: _Sheet) -> None:
    """Explain what is drawn, and only that, and write how the map was made."""
    entries = _entries(sheet)
    figure.legend(
        handles=entries,
        loc="lower left",
        bbox_to_anchor=(0.047, 0.022),
        ncols=3,
        frameon=False,
        fontsize=7.5,
        columnspacing=2.5,
    )
    _write(figure, 0.014, _facts(sheet.dataset), 6.5, colour="0.35")


def _entries(sheet: _Sheet) -> list[Line2D | Patch]:
    """Entries of the legend."""
    dataset = sheet.dataset
    status, filled = dataset["status"].values, dataset["filled"].values.astype(bool)
    lost = ~np.isin(status, [int(known) for known in Status if known.usable])
    entries: list[Line2D | Patch] = [
        Line2D([], [], color="black", lw=0.8, ls=(0, (4, 2)), label="dry (structural law alone)")
    ]
    if sheet.field is not None:
        curve = "k, c, approach between the points (dots): films of the contact laws"
        entries.append(Line2D([], [], color="0.3", lw=1.0, marker=".", ms=3, label=curve))
    if sheet.extrapolated_from:
        where = f"viscosity extrapolated at some speed: above {fitted_pressure(dataset)}"
        entries.append(Patch(label=where, **_HATCH))
    if (status == int(Status.ASYMPTOTE)).any():
        entries.append(Line2D([], [], ls="", mec="0.3", label=f"asymptote: {_limits(dataset)}", **_ASYMPTOTE))
    if any((dataset[name].values <= 0).any() and (dataset[name].values > 0).any() for name in _LOGARITHMIC):
        entries.append(Line2D([], [], ls="", color="0.3", label="zero or negative", **_BELOW))
    if (lost & filled).any():
        entries.append(Line2D([], [], ls="", label="no solution, filled from neighbours", **_FILLED))
    if (lost & ~filled).any():
        entries.append(Line2D([], [], ls="", label="no solution", **_LOST))
    return entries


def _limits(dataset: xr.Dataset) -> str:
    """Say which limit the points stand for that are one; their first words, where there are several."""
    reasons = dataset["reason"].values[dataset["status"].values == int(Status.ASYMPTOTE)]
    causes = sorted({plain(reason).split(":")[0] for reason in reasons if reason})
    return typeset("; ".join(causes[:2])) if causes else "a stated limit"


def _facts(dataset: xr.Dataset) -> str:
    """Return the line on how the map was made."""
    attributes = dataset.attrs
    status = dataset["status"].values
    counts = [
        f"{np.count_nonzero(status == int(known))} {known.word}" for known in Status if (status == int(known)).any()
    ]
    filled = int(np.count_nonzero(dataset["filled"].values))
    if filled:
        counts.append(f"{filled} filled")
    errors = []
    for name in ("film_compliance_error", "damping_error"):
        known = dataset[name].values[np.isfinite(dataset[name].values)]
        if known.size:
            label = name.removesuffix("_error").replace("_", " ")
            errors.append(f"{label} {float(np.quantile(known, 0.95)):.1g}")
    versions = record_from_json(attributes["package_versions"], "package_versions")
    estimates = f"Estimated relative error (95 % of points): {', '.join(errors)}.  " if errors else ""
    return (
        f"{status.size} points: {', '.join(counts)}.  {estimates}"
        f"ehdmaps {versions.get('ehdmaps', '')}, {plain(attributes.get('created', ''))[:10]}, "
        f"job {plain(attributes.get('job_name', ''))} {plain(attributes['job_sha256'])[:12]}"
    )


def _contact_words(name: str) -> str:
    """Return how a contact is called in a heading."""
    return "Line contact" if name in schema.CONTACT_NAMES[1] else f"{name.capitalize()} contact"


def _lowest(speeds: FloatArray) -> float:
    """Return the lowest speed above zero."""
    positive = speeds[speeds > 0]
    return float(positive.min()) if positive.size else 1e-6


def _spread(size: int, most: int) -> list[int]:
    """Return at most so many indices, spread over an axis, both ends among them."""
    return sorted({round(index) for index in np.linspace(0, size - 1, min(size, most))})
