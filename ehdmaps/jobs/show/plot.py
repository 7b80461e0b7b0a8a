"""A map on one page: families of curves over load, coloured by speed, for every contact and temperature.

Some panels of a map: quantities of its contacts over load at one temperature, as a figure or in CSV.
"""

from __future__ import annotations

import csv
import io
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.figure import Figure
from matplotlib.legend import Legend
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import FuncFormatter, NullLocator

from ehdmaps.errors import InputError, closest, short
from ehdmaps.exports.map_curves import law_field
from ehdmaps.figures import keep_within, spread, typeset
from ehdmaps.jobs.make.report import status_counts
from ehdmaps.jobs.show.plot_curves import (
    ASYMPTOTE,
    BELOW,
    FILLED,
    HATCH,
    LOST,
    MOST_CURVES,
    REACH,
    Sheet,
    dense_curve,
    draw_curves,
    keep_corners_free,
)
from ehdmaps.maps import schema
from ehdmaps.maps.emap import EHDMap
from ehdmaps.maps.records import record_from_json
from ehdmaps.outputs import MARK, TABLE, write_figure, write_text
from ehdmaps.physics.closed_form import BELOW_ROUGHNESS, CONTINUUM, NO_CONTINUUM
from ehdmaps.physics.solution import Status, usable_points
from ehdmaps.program import plain
from ehdmaps.units import (
    DAMPING,
    FILM,
    LOAD,
    MASS_FLOW,
    PRESSURE,
    ROLLING_FORCE,
    SPEED,
    STIFFNESS,
    TEMPERATURE,
    Display,
    quantity,
    span,
)

A4_LANDSCAPE = (11.69, 8.27)
MOST_TEMPERATURES = 6
SHOWN_TEMPERATURE = 313.15
"""The full panels are at the mapped temperature nearest to this one [K]: where oils are compared."""

PANELS: tuple[tuple[str, str, Display], ...] = (
    ("stiffness", "stiffness k", STIFFNESS),
    ("damping", "damping c", DAMPING),
    ("approach", "approach", FILM),
    ("central_film", "central film", FILM),
    ("minimum_film", "minimum film", FILM),
)
_SMALL = PANELS[:2]
FILMS = ("central_film", "minimum_film")
THIN: Mapping[str, Any] = {
    BELOW_ROUGHNESS: {"facecolor": "0.93", "edgecolor": "none", "zorder": 0},
    NO_CONTINUUM: {"facecolor": "0.8", "edgecolor": "none", "zorder": 0},
}
_LOGARITHMIC = ("stiffness", "damping", "central_film", "minimum_film")
FONT: Any = {
    "font.size": 7.5,
    **dict.fromkeys(("axes.linewidth", "xtick.major.width", "ytick.major.width"), 0.6),
    "text.usetex": False,  # the legend is measured as it is made
}


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

    with mpl.rc_context(FONT):
        write_figure(_page(Sheet(emap, law_field(emap))), output)


def _page(sheet: Sheet) -> Figure:
    """Draw the page: a row of panels a contact, then small ones a temperature."""
    figure, dataset = Figure(figsize=A4_LANDSCAPE), sheet.dataset
    temperatures = spread(dataset.sizes["temperature"], MOST_TEMPERATURES)
    shown = int(np.argmin(np.abs(dataset["temperature"].values - SHOWN_TEMPERATURE)))
    contacts = dataset.sizes["contact"]
    small = len(temperatures) > 1
    _heading(figure, sheet.emap, shown)

    middle = 0.385 if small else 0.10
    grid = figure.add_gridspec(
        contacts,
        len(PANELS),
        left=0.057,
        right=0.92,
        top=0.875,
        bottom=middle + 0.055,
        wspace=0.30,
        hspace=0.16,
    )
    for row in range(contacts):
        for column, (name, label, display) in enumerate(PANELS):
            axes = figure.add_subplot(grid[row, column])
            draw_curves(axes, sheet, name, display, (row, shown))
            if name in FILMS:
                shade_thin(axes, sheet, display)
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
    speed_bar(figure, sheet, (0.936, middle + 0.055, 0.011, 0.875 - middle - 0.055))
    page_legend(figure, page_entries(sheet))
    write_line(figure, 0.014, _facts(sheet.dataset, sheet.emap.surface.roughness), 6.5, colour="0.35")
    return figure


def speed_bar(figure: Figure, sheet: Sheet, place: tuple[float, float, float, float]) -> None:
    """Draw the scale of the speed's colours.

    Parameters
    ----------
    figure : Figure
        The page.
    sheet : Sheet
        The map.
    place : tuple of float
        Left, bottom, width and height, as shares of the page.
    """
    scale = figure.add_axes(place)
    bar = figure.colorbar(ScalarMappable(sheet.colours, "viridis"), cax=scale)
    shown_speeds = [sheet.speeds[index] for index in spread(sheet.speeds.size, MOST_CURVES)]
    bar.set_ticks([speed for speed in shown_speeds if speed > 0.0], minor=False)
    bar.ax.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:.2g}"))
    bar.ax.yaxis.set_minor_locator(NullLocator())
    bar.ax.tick_params(length=2.0, pad=1.5)
    bar.set_label(f"entrainment speed, {SPEED.unit}", labelpad=1)


def _thin(sheet: Sheet) -> list[tuple[float, str]]:
    """Films that are too thin for the theory: below which [m], and why; those that the map has."""
    films, roughness = sheet.dataset["minimum_film"].values, sheet.emap.surface.roughness
    limits = ((roughness, BELOW_ROUGHNESS), (CONTINUUM, NO_CONTINUUM))
    return [(limit, words) for limit, words in limits if np.any((films > 0.0) & (films < limit))]


def shade_thin(axes: Axes, sheet: Sheet, display: Display) -> None:
    """Shade the films that are too thin for the theory.

    Parameters
    ----------
    axes : Axes
        Panel of a film.
    sheet : Sheet
        The map.
    display : Display
        Unit of the film on the page.
    """
    bottom, top = axes.get_ylim()
    for limit, words in _thin(sheet):
        axes.axhspan(bottom, display.value(limit), **THIN[words])
    axes.set_ylim(bottom, top)


def _small_multiples(figure: Figure, sheet: Sheet, temperatures: list[int], top: float) -> None:
    """Draw stiffness and damping of the first contact at each temperature, on common axes."""
    first = str(sheet.dataset["contact"].values[0])
    figure.text(
        0.057,
        top - 0.012,
        f"{contact_words(first)}, over temperature of the raceways",
        fontsize=8.5,
        fontweight="bold",
    )

    def draw(axes: Axes, row: int, temperature: int) -> None:
        name, _, display = _SMALL[row]
        draw_curves(axes, sheet, name, display, (0, temperature), width=0.7)

    place = {"left": 0.057, "right": 0.92, "top": top - 0.05, "bottom": 0.112, "wspace": 0.06, "hspace": 0.08}
    labels = [f"{label}\n{typeset(display.unit)}" for _, label, display in _SMALL]
    at_temperatures(figure, sheet, place, temperatures, labels, draw, fontsize=7.5, pad=2.5)


def at_temperatures(
    figure: Figure,
    sheet: Sheet,
    place: Mapping[str, float],
    temperatures: Sequence[int],
    labels: Sequence[str],
    draw: Callable[[Axes, int, int], None],
    **title: Any,
) -> None:
    """Draw panels over load with a column a temperature; those of a row have common axes.

    Parameters
    ----------
    figure : Figure
        The page.
    sheet : Sheet
        The map.
    place : mapping of str to float
        Edges of the panels and spaces between them, as of a GridSpec of matplotlib.
    temperatures : sequence of int
        Temperatures of the columns, by their places in the map.
    labels : sequence of str
        Labels of the rows.
    draw : callable
        Draws a panel, of its axes, its row and the place of its temperature.
    **title
        How the temperature is written above each column.
    """
    grid = figure.add_gridspec(len(labels), len(temperatures), **place)
    for row, label in enumerate(labels):
        left: Axes | None = None
        for column, temperature in enumerate(temperatures):
            axes = figure.add_subplot(grid[row, column], sharex=left, sharey=left)
            left = left or axes
            draw(axes, row, temperature)
            axes.tick_params(which="both", labelleft=column == 0, labelbottom=row == len(labels) - 1)
            keep_corners_free(axes)
            if row == 0:
                degrees = float(sheet.dataset["temperature"].values[temperature])
                axes.set_title(typeset(TEMPERATURE.text(degrees)), **title)
            if row == len(labels) - 1:
                axes.set_xlabel(f"load, {LOAD.unit}", labelpad=1)
            if column == 0:
                axes.set_ylabel(label, labelpad=2)


def _heading(figure: Figure, emap: EHDMap, shown: int) -> None:
    """Write the title and, below it, what the page shows."""
    dataset, attributes = emap.dataset, emap.dataset.attrs
    what, oil = what_is_mapped(emap)
    rough = "" if emap.surface.smooth else ", smooth surfaces"
    at = typeset(TEMPERATURE.text(float(dataset["temperature"].values[shown])))
    write_line(figure, 0.963, f"EHD contact map: {what}, {oil}", 13, "bold")
    write_line(
        figure,
        0.928,
        f"Per unit length of contact, at {at} over load and entrainment speed.  "
        f"Solver {plain(attributes['solver'])}, structural law {plain(attributes['structural_law'])}{rough}.  "
        f"Mapped: {span(dataset['load'].values, LOAD)}, {span(dataset['entrainment_speed'].values, SPEED)}, "
        f"{typeset(span(dataset['temperature'].values, TEMPERATURE))} of the raceways.",
        8,
    )
    write_estimated(figure, 0.909, emap)


def write_estimated(figure: Figure, height: float, emap: EHDMap) -> None:
    """Write how the inner geometry of the bearing was estimated, where it was.

    Parameters
    ----------
    figure : Figure
        The page.
    height : float
        Place of the middle of the line, as a share of the page.
    emap : EHDMap
        The map.
    """
    if emap.bearing is not None and emap.bearing.estimated:
        write_line(figure, height, f"{emap.bearing.name}: {emap.bearing.estimated}.", 7.5)


def what_is_mapped(emap: EHDMap) -> tuple[str, str]:
    """Return bearing or contact, and oil, in the words of a title.

    Parameters
    ----------
    emap : EHDMap
        The map.
    """
    what = emap.bearing.title if emap.bearing else f"line contact, R = {emap.contacts[0].radius * 1e3:.4g} mm"
    estimated = "pressure-viscosity estimated" if emap.lubricant.estimated else "data not verified"
    unverified = "" if emap.lubricant.verified else f" ({estimated})"
    oil = emap.lubricant.title if emap.lubricant.title.endswith("oil") else f"oil {emap.lubricant.title}"
    return what, f"{oil}{unverified}"


def write_line(
    figure: Figure, height: float, text: str, size: float, weight: str = "normal", colour: str = "black"
) -> None:
    """Write a line of the page, in smaller letters where it is long; texts of a map are no formulas.

    Parameters
    ----------
    figure : Figure
        The page.
    height : float
        Place of the middle of the line, as a share of the page.
    text : str
        The line.
    size : float
        Size of its letters [pt].
    weight, colour : str
        Their weight and colour.
    """
    line = figure.text(
        0.057, height, text, fontsize=size, fontweight=weight, color=colour, va="center", parse_math=False
    )
    keep_within(figure, line)


def page_legend(figure: Figure, entries: Sequence[Line2D | Patch], bottom: float = 0.022) -> Legend:
    """Write a legend at the foot of a page: three columns, or as few as long texts need.

    Parameters
    ----------
    figure : Figure
        The page.
    entries : sequence of Line2D or Patch
        What is explained.
    bottom : float
        Height of its lower edge, as a part of the page.
    """
    for columns in (3, 2, 1):
        legend = figure.legend(
            handles=entries,
            loc="lower left",
            bbox_to_anchor=(0.047, bottom),
            ncols=columns,
            frameon=False,
            fontsize=7.5,
            columnspacing=2.5,
        )
        # letters are up to 3 % wider at the resolution of the file
        if legend.get_window_extent().x1 <= 0.96 * figure.bbox.x1 or columns == 1:
            break
        legend.remove()
    return legend


def page_entries(sheet: Sheet) -> list[Line2D | Patch]:
    """Entries of the legend.

    Parameters
    ----------
    sheet : Sheet
        The map.
    """
    entries: list[Line2D | Patch] = [
        Line2D([], [], color="black", lw=0.8, ls=(0, (4, 2)), label="dry (structural law alone)")
    ]
    if sheet.field is not None:
        curve = "k, c, approach between the points (dots): films of the contact laws"
        entries.append(Line2D([], [], color="0.3", lw=1.0, marker=".", ms=3, label=curve))
    entries += [Patch(label=words, **THIN[words]) for _, words in _thin(sheet)]
    entries += mark_entries(sheet)
    if any((sheet.dataset[name].values <= 0).any() and (sheet.dataset[name].values > 0).any() for name in _LOGARITHMIC):
        entries.append(Line2D([], [], ls="", color="0.3", label="zero or negative", **BELOW))
    return entries


def mark_entries(sheet: Sheet) -> list[Line2D | Patch]:
    """Return the entries of a legend for what is marked in every panel.

    Parameters
    ----------
    sheet : Sheet
        The map.
    """
    dataset = sheet.dataset
    status, filled = dataset["status"].values, dataset["filled"].values.astype(bool)
    unsolved = ~usable_points(status)
    entries: list[Line2D | Patch] = []
    if sheet.extrapolated_from:
        oil = sheet.emap.lubricant
        above = f"at some speed above {PRESSURE.text(oil.fitted_pressure)}"
        if oil.reach_assumed:
            where = f"right of it {above}: how far the viscosity law reaches is assumed, not stated"
            entries.append(Line2D([], [], label=where, **REACH))
        else:
            entries.append(Patch(label=f"viscosity extrapolated: {above}", **HATCH))
    if (status == int(Status.ASYMPTOTE)).any():
        entries.append(Line2D([], [], ls="", mec="0.3", label=f"asymptote: {_limits(dataset)}", **ASYMPTOTE))
    if (unsolved & filled).any():
        entries.append(Line2D([], [], ls="", label="no solution, filled from neighbours", **FILLED))
    if (unsolved & ~filled).any():
        entries.append(Line2D([], [], ls="", label="no solution", **LOST))
    return entries


def _limits(dataset: xr.Dataset) -> str:
    """Say which limit the points stand for that are one; their first words, where there are several."""
    reasons = dataset["reason"].values[dataset["status"].values == int(Status.ASYMPTOTE)]
    causes = sorted({plain(reason).split(":")[0] for reason in reasons if reason})
    return typeset("; ".join(causes[:2])) if causes else "a stated limit"


def _facts(dataset: xr.Dataset, roughness: float) -> str:
    """Return the line on how the map was made."""
    attributes = dataset.attrs
    masks = status_counts(dataset, roughness)
    counts = [f"{np.count_nonzero(here)} {words}" for words, here in masks.items()]
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
        f"{dataset['status'].size} points: {', '.join(counts)}.  {estimates}"
        f"ehdmaps {versions.get('ehdmaps', '')}, {plain(attributes.get('created', ''))[:10]}, "
        f"job {plain(attributes.get('job_name', ''))} {plain(attributes['job_sha256'])[:12]}"
    )


def contact_words(name: str) -> str:
    """Return how a contact is called in a heading.

    Parameters
    ----------
    name : str
        Name of the contact in the map.
    """
    return "Line contact" if name in schema.CONTACT_NAMES[1] else f"{name.capitalize()} contact"


_MORE: tuple[tuple[str, str, Display], ...] = (
    ("film_offset", "film offset", Display("um", 1e6)),
    ("max_pressure", "largest pressure", PRESSURE),
    ("rolling_force", "rolling force", ROLLING_FORCE),
    ("mass_flow", "mass flow", MASS_FLOW),
)

_NEAR = 0.05
"""How far a temperature may be from one of the map [K]."""


@dataclass(frozen=True)
class Panels:
    """Panels of a map.

    Attributes
    ----------
    quantities : tuple of (str, str, Display)
        Variable, its label, and its unit on the page.
    contacts : tuple of int
        Places of the contacts in the map.
    temperature : int
        Place of the temperature.
    """

    quantities: tuple[tuple[str, str, Display], ...]
    contacts: tuple[int, ...]
    temperature: int


def chosen_panels(emap: EHDMap, names: str | None, contact: str | None, temperature: str | None) -> Panels:
    """Choose panels by what was typed.

    Parameters
    ----------
    emap : EHDMap
        The map.
    names : str or None
        Variables with commas between, such as "stiffness, central_film"; None for those of the page.
    contact : str or None
        One of its contacts; None for all.
    temperature : str or None
        A mapped temperature, such as "40 degC"; None for that of the page.

    Raises
    ------
    InputError
        With every problem.
    """
    dataset, problems = emap.dataset, list[str]()
    known = {row[0]: row for row in (*PANELS, *_MORE) if row[0] in dataset}
    asked = [row[0] for row in PANELS] if names is None else [name.strip() for name in names.split(",")]
    for name in asked:
        if name not in known:
            near = closest(name, tuple(known))
            problems.append(f"--quantity: got {short(name)}{near}; allowed: {', '.join(known)}, with commas between")
    contacts = [str(name) for name in dataset["contact"].values]
    if contact is not None and contact not in contacts:
        problems.append(f"--contact: got {short(contact)}; allowed: {', '.join(contacts)}")
    mapped = np.asarray(dataset["temperature"].values, dtype=np.float64)
    wanted = SHOWN_TEMPERATURE
    if temperature is not None:
        try:
            wanted = quantity(temperature, "K")
        except InputError as error:
            problems.append(f"--temperature: {error.problems[0]}")
    place = int(np.argmin(np.abs(mapped - wanted)))
    if temperature is not None and abs(mapped[place] - wanted) > _NEAR and not problems:
        allowed = ", ".join(TEMPERATURE.text(float(one)) for one in mapped)
        problems.append(f"--temperature: got {short(temperature)}; allowed: those of the map, {allowed}")
    if problems:
        raise InputError(problems)
    rows = tuple(range(len(contacts))) if contact is None else (contacts.index(contact),)
    return Panels(tuple(known[name] for name in dict.fromkeys(asked)), rows, place)


def plot_panels(emap: EHDMap, panels: Panels, output: Path) -> None:
    """Draw panels, a row a contact, and write them.

    Parameters
    ----------
    emap : EHDMap
        The map.
    panels : Panels
        Panels to be drawn.
    output : Path
        The picture; its ending decides the format (png, pdf, svg).

    Raises
    ------
    InputError
        If it cannot be written, or the ending is not known.
    """
    import matplotlib as mpl

    with mpl.rc_context(FONT):
        write_figure(_figure(Sheet(emap, law_field(emap)), panels), output)


def _figure(sheet: Sheet, panels: Panels) -> Figure:
    """Draw panels."""
    rows, columns = len(panels.contacts), len(panels.quantities)
    height = 2.4 + 2.9 * rows
    figure = Figure(figsize=(max(6.6, 1.5 + 3.0 * columns), height))
    what, oil = what_is_mapped(sheet.emap)
    at = TEMPERATURE.text(float(sheet.dataset["temperature"].values[panels.temperature]))
    write_line(figure, 1.0 - 0.25 / height, f"{what}, {oil}", 11, "bold")
    write_line(figure, 1.0 - 0.5 / height, f"per unit length of contact, at {at} of the raceways", 8)
    bottom, top = 1.35 / height, 1.0 - 0.85 / height
    right = 1.0 - 0.95 / figure.get_figwidth()
    place = {"left": 0.65 / figure.get_figwidth(), "right": right, "top": top, "bottom": bottom}
    grid = figure.add_gridspec(rows, columns, **place, wspace=0.3, hspace=0.12)
    for row, contact in enumerate(panels.contacts):
        for column, (name, label, display) in enumerate(panels.quantities):
            axes = figure.add_subplot(grid[row, column])
            draw_curves(axes, sheet, name, display, (contact, panels.temperature))
            if name in FILMS:
                shade_thin(axes, sheet, display)
            axes.set_ylabel(f"{label}, {typeset(display.unit)}", labelpad=1)
            axes.tick_params(labelbottom=row == rows - 1)
            if row == rows - 1:
                axes.set_xlabel(f"load, {LOAD.unit}", labelpad=1)
            if column == 0:
                words = str(sheet.dataset["contact"].values[contact])
                axes.annotate(words, (0.95, 0.06), xycoords="axes fraction", fontweight="bold", ha="right")
    speed_bar(figure, sheet, (right + 0.2 / figure.get_figwidth(), bottom, 0.013, top - bottom))
    page_legend(figure, page_entries(sheet))
    return figure


_PLACE = ("temperature [K]", "entrainment_speed [m/s]", "load [N/m]")
_HEAD = ("quantity", "contact", *_PLACE, "value", "unit", "of", "status")


def write_drawn(emap: EHDMap, panels: Panels, output: Path) -> None:
    """Write what panels show as CSV, in SI: a row a point of a curve.

    Parameters
    ----------
    emap : EHDMap
        The map.
    panels : Panels
        Panels as they would be drawn.
    output : Path
        The file.

    Raises
    ------
    InputError
        If it cannot be written.
    """
    text = io.StringIO()
    rows = csv.writer(text, lineterminator="\n")
    text.write(f"# table {MARK}: curves of a map over load, SI\n")
    rows.writerow(_HEAD)
    rows.writerows(_drawn(Sheet(emap, law_field(emap)), panels))
    write_text(output, text.getvalue(), TABLE)


def _drawn(sheet: Sheet, panels: Panels) -> Iterator[Sequence[object]]:
    """Rows of all curves: those between points by the films of contact laws, and the points of the map."""
    dataset, kelvin = sheet.dataset, float(sheet.dataset["temperature"].values[panels.temperature])
    for name, _, _ in panels.quantities:
        unit = dataset[name].attrs["units"]
        for contact in panels.contacts:
            here = dataset.isel(contact=contact, temperature=panels.temperature)
            words = str(dataset["contact"].values[contact])
            for index in spread(sheet.speeds.size, MOST_CURVES):
                begin = (name, words, f"{kelvin:.9g}", f"{sheet.speeds[index]:.9g}")
                dense = dense_curve(sheet, name, (contact, panels.temperature), index)
                for load, value in zip(*dense, strict=True) if dense is not None else ():
                    yield (*begin, f"{load:.9g}", _text(value), unit, "contact law", "")
                columns = (here[variable].values[:, index] for variable in (name, "status"))
                for load, value, status in zip(here["load"].values, *columns, strict=True):
                    yield (*begin, f"{load:.9g}", _text(value), unit, "map", Status(int(status)).name.lower())
            if name == "stiffness":
                dry = 1.0 / np.asarray(sheet.emap.contacts[contact].structural_compliance(dataset["load"].values))
                for load, value in zip(dataset["load"].values, dry, strict=True):
                    yield (name, words, f"{kelvin:.9g}", "", f"{load:.9g}", _text(value), unit, "dry", "")


def _text(value: float) -> str:
    """A number; nothing where there is none."""
    return f"{value:.9g}" if np.isfinite(value) else ""
