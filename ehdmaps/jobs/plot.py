"""A map on one page: families of curves over load, coloured by speed, for every contact and temperature."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import LogNorm, Normalize
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import FixedLocator, FuncFormatter, LogLocator, NullLocator

from ehdmaps.jobs.report import span
from ehdmaps.maps import schema
from ehdmaps.maps.records import contacts_from_json
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
    ("central_film", "central film", FILM),
    ("minimum_film", "minimum film", FILM),
)
_SMALL = _PANELS[:2]
_FONT: Any = {"font.size": 7.5, "axes.linewidth": 0.6, "xtick.major.width": 0.6, "ytick.major.width": 0.6}
_BAD = "#c8102e"


def plot_map(dataset: xr.Dataset, output: Path) -> None:
    """Draw the page and write it.

    Parameters
    ----------
    dataset : xarray.Dataset
        The map.
    output : Path
        The picture; its ending decides the format (png, pdf, svg).

    Raises
    ------
    InputError
        If it cannot be written, or the ending is not known.
    """
    import matplotlib as mpl

    with mpl.rc_context(_FONT):
        write_figure(_page(dataset), output, RESOLUTION)


def _page(dataset: xr.Dataset) -> Figure:
    """Draw the page: a row of panels a contact, then small ones a temperature."""
    figure = Figure(figsize=A4_LANDSCAPE)
    temperatures = _spread(dataset.sizes["temperature"], MOST_TEMPERATURES)
    shown = int(np.argmin(np.abs(dataset["temperature"].values - SHOWN_TEMPERATURE)))
    contacts = dataset.sizes["contact"]
    small = len(temperatures) > 1
    colours = _colours(dataset)
    _heading(figure, dataset, shown)

    middle = 0.385 if small else 0.10
    grid = figure.add_gridspec(
        contacts,
        len(_PANELS),
        left=0.06,
        right=0.91,
        top=0.875,
        bottom=middle + 0.055,
        wspace=0.27,
        hspace=0.16,
    )
    for row in range(contacts):
        for column, (name, label, display) in enumerate(_PANELS):
            axes = figure.add_subplot(grid[row, column])
            _curves(axes, dataset, name, display, (row, shown), colours)
            axes.set_ylabel(f"{label}, {_drawn(display.unit)}", labelpad=2)
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
        _small_multiples(figure, dataset, temperatures, colours, middle)
    scale = figure.add_axes((0.93, middle + 0.055, 0.011, 0.875 - middle - 0.055))
    bar = figure.colorbar(ScalarMappable(colours, "viridis"), cax=scale)
    bar.set_label(f"entrainment speed, {SPEED.unit}", labelpad=2)
    _legend(figure, dataset)
    return figure


def _small_multiples(
    figure: Figure, dataset: xr.Dataset, temperatures: list[int], colours: Normalize, top: float
) -> None:
    """Draw stiffness and damping of the first contact at each temperature, on common axes."""
    grid = figure.add_gridspec(
        len(_SMALL),
        len(temperatures),
        left=0.06,
        right=0.91,
        top=top - 0.05,
        bottom=0.095,
        wspace=0.06,
        hspace=0.08,
    )
    first = str(dataset["contact"].values[0])
    figure.text(
        0.06,
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
            _curves(axes, dataset, name, display, (0, temperature), colours, width=0.7)
            axes.tick_params(which="both", labelleft=column == 0, labelbottom=row == len(_SMALL) - 1)
            if row == 0:
                heading = _drawn(TEMPERATURE.text(float(dataset["temperature"].values[temperature])))
                axes.set_title(heading, fontsize=7.5, pad=2.5)
            _keep_corners_free(axes)
            if column == 0:
                axes.set_ylabel(f"{label}\n{_drawn(display.unit)}", labelpad=2)
            if row == len(_SMALL) - 1:
                axes.set_xlabel(f"load, {LOAD.unit}", labelpad=1)


def _curves(
    axes: Axes,
    dataset: xr.Dataset,
    name: str,
    display: Display,
    place: tuple[int, int],
    colours: Normalize,
    width: float = 1.0,
) -> None:
    """Draw one variable over load, one curve a speed, with marks on the points that are not converged."""
    import matplotlib as mpl

    contact, temperature = place
    loads = LOAD.factor * dataset["load"].values
    speeds = dataset["entrainment_speed"].values
    here = dataset.isel(contact=contact, temperature=temperature)
    values = display.factor * here[name].values
    status, filled = here["status"].values, here["filled"].values.astype(bool)
    for index in _spread(speeds.size, MOST_CURVES):
        curve = np.where(values[:, index] > 0, values[:, index], np.nan)
        colour = mpl.colormaps["viridis"](colours(max(speeds[index], _lowest(speeds))))
        axes.plot(loads, curve, color=colour, lw=width, marker="." if loads.size == 1 else None)
        asymptote = status[:, index] == int(Status.ASYMPTOTE)
        below = values[:, index] <= 0
        if below.any() and (values > 0).any():
            low = np.full(np.count_nonzero(below), 0.03)
            axes.plot(loads[below], low, ls="", marker="v", ms=3.5, color=colour, transform=axes.get_xaxis_transform())
        axes.plot(loads[asymptote], curve[asymptote], ls="", marker="^", ms=2.8, mfc="white", mec=colour, mew=0.6)
        axes.plot(
            loads[filled[:, index]],
            curve[filled[:, index]],
            ls="",
            marker="o",
            ms=4,
            mfc="none",
            mec=_BAD,
            mew=0.9,
        )
    if name == "stiffness":
        dry = contacts_from_json(dataset.attrs["contacts"])[contact].structural_compliance(dataset["load"].values)
        axes.plot(loads, display.factor / dry, color="black", lw=0.8, ls=(0, (4, 2)), zorder=1)
    holes = ~np.isin(status, [int(known) for known in Status if known.usable]) & ~filled
    lost = loads[holes.any(axis=1)]
    axes.plot(
        lost,
        np.full(lost.size, 0.03),
        ls="",
        marker="x",
        ms=4,
        color=_BAD,
        transform=axes.get_xaxis_transform(),
    )
    _scales(axes, loads, values, name)


def _scales(axes: Axes, loads: npt.NDArray[np.float64], values: npt.NDArray[np.float64], name: str) -> None:
    """Set log scales where there is something positive to show, and a quiet grid."""
    axes.set_xscale("log")
    if loads.size > 1:
        axes.set_xlim(loads[0], loads[-1])
    positive = values[values > 0]
    if positive.size:
        axes.set_yscale("log")
        if name == "stiffness":
            # The film's tail at light load runs over many decades in which nobody reads a stiffness.
            axes.set_ylim(max(positive.min() * 0.7, positive.max() * 1e-3), positive.max() * 2.0)
        axes.yaxis.set_major_locator(LogLocator(numticks=7))
        if np.ptp(np.log10(positive)) > 2:
            axes.yaxis.set_minor_locator(NullLocator())
        else:
            axes.yaxis.set_minor_locator(LogLocator(subs=(2, 5)))
            axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
            axes.yaxis.set_minor_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    else:
        axes.annotate("zero", (0.5, 0.5), xycoords="axes fraction", ha="center", color="0.4")
        axes.set_yticks([])
    axes.xaxis.set_major_locator(LogLocator(numticks=7))
    axes.grid(color="0.88", lw=0.4)
    axes.tick_params(length=2.5, pad=1.5)


def _keep_corners_free(axes: Axes) -> None:
    """Label no decade at the ends of the load axis, where the numbers of two panels would meet."""
    low, high = axes.get_xlim()
    decades = 10.0 ** np.arange(np.floor(np.log10(low)), np.ceil(np.log10(high)) + 1)
    inside = decades[(decades > 1.5 * low) & (decades < high / 1.5)]
    axes.xaxis.set_major_locator(FixedLocator((inside if inside.size else decades).tolist()))


def _heading(figure: Figure, dataset: xr.Dataset, shown: int) -> None:
    """Write the title and, below it, what the page shows."""
    attributes = dataset.attrs
    lubricant, geometry = json.loads(attributes["lubricant"]), json.loads(attributes["geometry"])
    contacts = contacts_from_json(dataset.attrs["contacts"])
    at = _drawn(TEMPERATURE.text(float(dataset["temperature"].values[shown])))
    what = geometry["name"] if geometry else f"line contact, R = {contacts[0].radius * 1e3:.4g} mm"
    unverified = "" if int(attributes.get("lubricant_verified", 1)) else " (data not verified)"
    figure.text(
        0.06,
        0.963,
        f"EHD contact map: {what}, oil {lubricant['name']}{unverified}",
        fontsize=13,
        fontweight="bold",
        va="center",
    )
    figure.text(
        0.06,
        0.928,
        f"Per unit length of contact, at {at} over load and entrainment speed.  "
        f"Solver {attributes['solver']}, structural law {attributes['structural_law']}.  "
        f"Mapped: {span(dataset['load'].values, LOAD)}, {span(dataset['entrainment_speed'].values, SPEED)}, "
        f"{_drawn(span(dataset['temperature'].values, TEMPERATURE))}.",
        fontsize=8,
        va="center",
    )


def _legend(figure: Figure, dataset: xr.Dataset) -> None:
    """Explain the marks, and write how the map was made."""
    entries = [
        Line2D([], [], color="black", lw=0.8, ls=(0, (4, 2)), label="dry (structural law alone)"),
        Line2D([], [], ls="", marker="^", ms=4, mfc="white", mec="0.3", label="asymptote: a stated limit"),
        Line2D([], [], ls="", marker="v", ms=4, color="0.3", label="zero or negative"),
        Line2D(
            [],
            [],
            ls="",
            marker="o",
            ms=4.5,
            mfc="none",
            mec=_BAD,
            label="no solution, filled from neighbours",
        ),
        Line2D([], [], ls="", marker="x", ms=4, color=_BAD, label="no solution at some speed"),
    ]
    figure.legend(handles=entries, loc="lower left", bbox_to_anchor=(0.05, 0.024), ncols=5, frameon=False, fontsize=7.5)
    figure.text(0.06, 0.016, _facts(dataset), fontsize=6.5, color="0.35", va="center")


def _facts(dataset: xr.Dataset) -> str:
    """Return the line on how the map was made."""
    attributes = dataset.attrs
    status = dataset["status"].values
    counts = [
        f"{np.count_nonzero(status == int(known))} {known.word}" for known in Status if (status == int(known)).any()
    ]
    filled = int(np.count_nonzero(dataset["filled"].values))
    errors = []
    for name in ("film_compliance_error", "damping_error"):
        known = dataset[name].values[np.isfinite(dataset[name].values)]
        if known.size:
            label = name.removesuffix("_error").replace("_", " ")
            errors.append(f"{label} {float(np.quantile(known, 0.95)):.1g}")
    versions = json.loads(attributes["package_versions"])
    return (
        f"{status.size} points: {', '.join(counts)}; {filled} filled.  "
        f"Estimated relative error (95 % of points): {', '.join(errors) or 'none'}.  "
        f"ehdmaps {versions.get('ehdmaps', '')}, {attributes.get('created', '')[:10]}, "
        f"job {attributes.get('job_name', '')} {attributes['job_sha256'][:12]}"
    )


def _contact_words(name: str) -> str:
    """Return how a contact is called in a heading."""
    return "Line contact" if name in schema.CONTACT_NAMES[1] else f"{name.capitalize()} contact"


def _drawn(text: str) -> str:
    """Return a unit with the letters that a terminal may lack."""
    return text.replace("um", "µm").replace("degC", "°C")


def _colours(dataset: xr.Dataset) -> Normalize:
    """Return the scale of the speed's colours; a standstill takes the colour of the lowest speed."""
    speeds = dataset["entrainment_speed"].values
    low, high = _lowest(speeds), float(max(speeds.max(), 1e-6))
    return LogNorm(low, high if high > low else 2 * low)


def _lowest(speeds: npt.NDArray[np.float64]) -> float:
    """Return the lowest speed above zero."""
    positive = speeds[speeds > 0]
    return float(positive.min()) if positive.size else 1e-6


def _spread(size: int, most: int) -> list[int]:
    """Return at most so many indices, spread over an axis, both ends among them."""
    return sorted({round(index) for index in np.linspace(0, size - 1, min(size, most))})
