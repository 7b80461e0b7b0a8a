"""Effect of roughness on the films of a map, on one page: Lambda and the film's share of the load."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from ehdmaps.figures import WARNING, spread, typeset
from ehdmaps.jobs.show.plot import (
    A4_LANDSCAPE,
    FONT,
    MOST_TEMPERATURES,
    at_temperatures,
    contact_words,
    mark_entries,
    page_legend,
    speed_bar,
    what_is_mapped,
    write_estimated,
    write_line,
)
from ehdmaps.jobs.show.plot_curves import Sheet, draw_curves
from ehdmaps.maps.emap import EHDMap
from ehdmaps.maps.rough_layer import (
    BOUNDARY,
    FILM_PARAMETER,
    FILM_SHARE,
    LEAST_SPEED,
    MEAN_DISTANCE,
    MIXED,
    RoughLayer,
    least_share,
    overlapping,
    rough_variables,
)
from ehdmaps.outputs import write_figure
from ehdmaps.units import LOAD, Display

_PLAIN = Display("")

LOWEST, HIGHEST = 0.01, 100.0
"""Lambda that is drawn: what lies beyond is the same as rough, or as smooth, as these."""

_LINES = (
    (BOUNDARY, "-", "Λ = 1: usually called boundary lubrication below"),
    (MIXED, (0, (4, 2)), "Λ = 3: usually called mixed below"),
)
_BEYOND: Any = {"facecolor": WARNING, "alpha": 0.13, "lw": 0.0, "zorder": 0}
_LOADS = 200


def plot_roughness(emap: EHDMap, output: Path) -> None:
    """Draw the page and write it.

    Parameters
    ----------
    emap : EHDMap
        A map with rough surfaces, see `EHDMap.with_surface`.
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

    derived = rough_variables(emap.dataset, emap.contacts, emap.lubricant, emap.surface)
    with mpl.rc_context(FONT):
        write_figure(_page(Sheet(emap, None, derived)), output)


def _page(sheet: Sheet) -> Figure:
    """Draw two rows of panels a contact, one column a temperature."""
    figure, dataset, surface = Figure(figsize=A4_LANDSCAPE), sheet.dataset, sheet.emap.surface
    temperatures = spread(dataset.sizes["temperature"], MOST_TEMPERATURES)
    what, oil = what_is_mapped(sheet.emap)
    write_line(figure, 0.963, typeset(f"Films and {surface.label}: {what}, {oil}"), 13, "bold")
    parameter = f"Λ: minimum film between smooth surfaces over it; {_below(sheet)}."
    write_line(figure, 0.934, f"Combined rms roughness of both surfaces. {parameter}", 8)
    share = "film and asperities in balance (Johnson, Greenwood and Poon; asperities of Greenwood and Tripp)"
    write_line(figure, 0.916, f"Share of the load: {share}; a guess where the mean planes overlap.", 8)
    write_estimated(figure, 0.9, sheet.emap)
    place = {"left": 0.062, "right": 0.92, "top": 0.875, "bottom": 0.122, "wspace": 0.08, "hspace": 0.12}
    contacts = map(contact_words, map(str, dataset["contact"].values))
    labels = [f"{words}\n{shown}" for words in contacts for shown in ("Λ", "film's share of the load")]

    def draw(axes: Axes, row: int, temperature: int) -> None:
        _panel(axes, sheet, (row // 2, temperature), row % 2 == 0)

    at_temperatures(figure, sheet, place, temperatures, labels, draw, fontsize=8.5, fontweight="bold", pad=3)
    speed_bar(figure, sheet, (0.936, 0.122, 0.011, 0.753))
    entries: list[Line2D | Patch] = [
        Line2D([], [], color="black", lw=0.8, ls=style, label=words) for _, style, words in _LINES
    ]
    if overlapping(dataset[FILM_SHARE].values, dataset[MEAN_DISTANCE].values).any():
        entries.append(Patch(label="mean planes overlap: out of the range of load sharing, a guess", **_BEYOND))
    page_legend(figure, [*entries, *mark_entries(sheet)], 0.005)
    return figure


def _panel(axes: Axes, sheet: Sheet, place: tuple[int, int], parameter: bool) -> None:
    """Draw Lambda with its usual limits, or the share of the film."""
    draw_curves(axes, sheet, FILM_PARAMETER if parameter else FILM_SHARE, _PLAIN, place, width=0.8)
    if not parameter:
        axes.set_yscale("linear")
        axes.set_ylim(0.0, 1.05)
        _shade_shares(axes, sheet, place[0])
        return
    known = sheet.dataset[FILM_PARAMETER].values
    positive = known[known > 0.0]
    if positive.size:  # the axis of the whole row
        axes.set_ylim(0.7 * max(float(positive.min()), LOWEST), 1.4 * min(max(float(positive.max()), MIXED), HIGHEST))
    for limit, style, _ in _LINES:
        axes.axhline(limit, color="black", lw=0.8, ls=style, zorder=1)
    _shade_parameters(axes, sheet, place)


def _shade_shares(axes: Axes, sheet: Sheet, contact: int) -> None:
    """Shade the shares at which the mean planes overlap: one limit over load, at any speed and temperature."""
    emap, axis = sheet.emap, sheet.dataset["load"].values
    layer = RoughLayer(emap.surface, emap.contacts[contact], emap.lubricant, LEAST_SPEED)
    loads = np.geomspace(axis[0], axis[-1], _LOADS)
    axes.fill_between(LOAD.factor * loads, 0.0, np.maximum(least_share(layer, loads), 0.0), **_BEYOND)


def _shade_parameters(axes: Axes, sheet: Sheet, place: tuple[int, int]) -> None:
    """Shade the Lambda below which the mean planes overlap, between the speeds of the map where they meet."""
    here = sheet.dataset.isel(contact=place[0], temperature=place[1]).transpose("load", "entrainment_speed", ...)
    limits = np.full(here.sizes["load"], np.nan)
    for i, (distance, known) in enumerate(zip(here[MEAN_DISTANCE].values, here[FILM_PARAMETER].values, strict=True)):
        moving = np.isfinite(distance) & (known > 0.0)
        if moving.any() and distance[moving].min() < 0.0:  # it rises with speed
            limits[i] = np.exp(np.interp(0.0, distance[moving], np.log(known[moving])))
    axes.fill_between(LOAD.factor * here["load"].values, 1e-9, limits, where=np.isfinite(limits), **_BEYOND)


def _below(sheet: Sheet) -> str:
    """Say how many points lie below the limits."""
    values = sheet.dataset[FILM_PARAMETER].values
    known = values[np.isfinite(values)]
    shares = ", ".join(f"{100.0 * np.mean(known < limit):.0f} % below {limit:g}" for limit in (BOUNDARY, MIXED))
    return f"{shares} of the points"
