"""Some panels of a map: quantities of its contacts over load at one temperature, as a figure or in CSV."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from ehdmaps.errors import InputError, closest, short
from ehdmaps.exports.map_curves import law_field
from ehdmaps.figures import spread, typeset
from ehdmaps.jobs.show.plot import (
    FILMS,
    FONT,
    PANELS,
    SHOWN_TEMPERATURE,
    page_entries,
    page_legend,
    shade_thin,
    speed_bar,
    what_is_mapped,
    write_line,
)
from ehdmaps.jobs.show.plot_curves import MOST_CURVES, Sheet, dense_curve, draw_curves
from ehdmaps.maps.emap import EHDMap
from ehdmaps.outputs import MARK, TABLE, write_figure, write_text
from ehdmaps.physics.solution import Status
from ehdmaps.units import LOAD, MASS_FLOW, PRESSURE, ROLLING_FORCE, TEMPERATURE, Display, quantity

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
