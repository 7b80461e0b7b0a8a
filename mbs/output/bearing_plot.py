"""Figures of bearings: one at a point, over load or speed, and all of a machine at its equilibrium."""

from __future__ import annotations

import math
import textwrap
from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.projections.polar import PolarAxes
from matplotlib.ticker import MaxNLocator

from ehdmaps.arrays import FloatArray
from ehdmaps.figures import COLOURS, WARNING, typeset
from ehdmaps.units import PRESSURE, RPM, written
from mbs.bearings.contact_report import BearingContacts
from mbs.bearings.films import SIDES
from mbs.model.equilibrium import Equilibrium
from mbs.output.one_bearing.kind import Description, Kind, Points, Row, row_of, smallest
from mbs.output.one_bearing.table import WIDE_RANGE, heading, without_numbers
from mbs.output.page import grid, page
from mbs.output.page import grid as quiet_grid
from mbs.scene.assembly import Model
from mbs.scene.fields import FORCE, MICROMETRE

_SIDES = COLOURS[:2]
"""Colours of the inner and the outer contact."""

_MOST_LINES = 8
_WIDE = 130


def bearing_figure(kind: Kind, description: Description, points: Points) -> Figure:
    """Loads of the rolling elements and what contacts feel at one point; curves over load or speed for more.

    Parameters
    ----------
    kind : Kind
        Kind of the bearing.
    description : Description
        What the points have in common.
    points : sequence of sequence
        Points by load, then by speed.
    """
    if len(points) == 1 and len(points[0]) == 1:
        return _page(kind, description, points[0][0])
    return _curves(kind, description, points)


def _page(kind: Kind, description: Description, point: Any) -> Figure:
    """One point: rolling elements on the left, what contacts feel on the right."""
    figure = Figure(figsize=(10.5, 6.8), layout="constrained")
    row = row_of(kind, description, point)
    parameter, roughness = row["film_parameter"], typeset(MICROMETRE.text(description.roughness))
    axial = f" and {FORCE.text(point.axial, 6)} axial" if kind.axial else ""
    summary = (
        f"{FORCE.text(point.size, 6)}{axial}, {RPM.text(point.inner_speed)}: K along the load "
        f"{1e-6 * row['stiffness_along']:.4g} N/µm, across {1e-6 * row['stiffness_across']:.4g} N/µm; c along "
        f"{1e-3 * row['damping_along']:.3g} N s/mm"
        + ("" if math.isnan(parameter) else f"; Λ = {parameter:.3g} at {roughness} roughness")
    )
    _title(figure, heading(kind, description, point), summary, point.problems)
    grid = figure.add_gridspec(3, 2, width_ratios=(1.0, 1.15))
    polar = figure.add_subplot(grid[:, 0], projection="polar")
    assert isinstance(polar, PolarAxes)
    _around(polar, kind, point)
    panels = [figure.add_subplot(grid[0, 1])]
    panels += [figure.add_subplot(grid[i, 1], sharex=panels[0]) for i in (1, 2)]
    _contacts(panels, kind, point)
    return figure


def _around(polar: PolarAxes, kind: Kind, point: Any) -> None:
    """Load of each rolling element at its angle, and the direction of the load."""
    elements, name = point.elements, kind.element
    load = np.atleast_2d(elements.load)[0]
    highest = max(float(load.max()), 1e-9)
    polar.bar(elements.angle, load, width=0.7 * 2.0 * math.pi / load.size, color=COLOURS[0], alpha=0.85)
    y, z = point.axes[0][-2:]
    angle = math.atan2(z, y)
    title = f"load of the {name}s, N\nhighest {highest:.5g} N, {point.loaded} of {load.size} above 1 % of it"
    if point.size > 0.0:
        title += f"\nred: direction of the {'radial ' * kind.axial}load on the inner ring"
        polar.annotate(
            "",
            xy=(angle, 1.22 * highest),
            xytext=(angle, 0.0),
            arrowprops={"arrowstyle": "-|>", "color": COLOURS[1], "lw": 1.6},
        )
    polar.set_ylim(0.0, 1.25 * highest)
    polar.yaxis.set_major_locator(MaxNLocator(4))
    polar.set_rlabel_position(math.degrees(angle) + 180.0)
    polar.set_thetagrids(
        [0.0, 45.0, 90.0, 135.0, 180.0, 225.0, 270.0, 315.0], ["y", "45°", "z", "135°", "180°", "225°", "270°", "315°"]
    )
    polar.tick_params(labelsize=8)
    polar.grid(color="0.85", lw=0.5)
    polar.set_axisbelow(True)
    polar.set_title(title, fontsize=9)


def _contacts(panels: Sequence[Axes], kind: Kind, point: Any) -> None:
    """Load, pressures and films of contacts over their place."""
    curves = kind.curves(point)
    place, colours = curves.place, ("0.2",) if len(curves.load) == 1 else _SIDES
    for load, colour in zip(curves.load, colours, strict=True):
        panels[0].plot(place, load, color=colour, lw=1.2)
    panels[0].set_ylabel(curves.load_words)
    panels[0].set_title(curves.title, fontsize=9)
    # The thick films of contacts without load would hide the others.
    thickest = max(smallest(side) for side in np.where(curves.pressure > 0.0, curves.central_film, math.nan))
    films = not math.isnan(thickest)
    for side, (name, colour) in enumerate(zip(SIDES, _SIDES, strict=True)):
        panels[1].plot(place, 1e-9 * curves.pressure[side], color=colour, lw=1.2, label=name)
        if np.any(np.isfinite(curves.central_film[side])):
            panels[2].plot(place, 1e6 * curves.central_film[side], color=colour, lw=1.2, label=f"{name}, central")
            thinnest = 1e6 * curves.minimum_film[side]
            panels[2].plot(place, thinnest, color=colour, lw=1.2, ls=":", label=f"{name}, smallest")
    panels[1].set_ylabel("Hertz\npressure, GPa")
    panels[2].set_ylabel("film, µm")
    panels[2].set_xlabel(curves.place_words)
    _static_limit(panels[1], kind, curves.pressure)
    for panel in panels:
        panel.set_ylim(0.0, 1.1 * panel.get_ylim()[1])
        quiet_grid(panel)
    films_shown = films and point.entrainment_speed > 0.0
    if films_shown:
        panels[2].set_ylim(0.0, 2.0e6 * thickest)
    for panel in panels[1 : 3 if films_shown else 2]:
        panel.legend(fontsize=7.5, frameon=False, loc="center left", bbox_to_anchor=(1.0, 0.5))
    if not films_shown:
        words = "at rest: no film" if films else "no film is known"
        panels[2].text(0.5, 0.5, words, transform=panels[2].transAxes, ha="center", color="0.4")


def _curves(kind: Kind, description: Description, points: Points) -> Figure:
    """Curves over load (a line a speed), or over speed if there is one load."""
    figure = Figure(figsize=(11.0, 6.8), layout="constrained")
    everything = [point for line in points for point in line]
    over_load = len(points) > 1
    lines = [list(column) for column in zip(*points, strict=True)] if over_load else [list(points[0])]
    first = everything[0]
    held = [] if over_load else [FORCE.text(first.size, 6)]
    held += [f"{FORCE.text(first.axial, 6)} axial"] if kind.axial else []
    held += [RPM.text(first.inner_speed)] * (over_load and len(lines) == 1)
    problems = [line for point in everything for line in point.problems]
    _title(figure, heading(kind, description, first), ", ".join(held), problems)
    panels = list(figure.subplots(2, 3, sharex=True).ravel())
    if len(lines) > _MOST_LINES:  # evenly spaced ones, the ends among them
        lines = [lines[i] for i in np.unique(np.linspace(0, len(lines) - 1, _MOST_LINES).round().astype(int))]
    for order, line in enumerate(lines):
        label = RPM.text(line[0].inner_speed) if len(lines) > 1 else ""
        _line(panels, [row_of(kind, description, point) for point in line], _shade(order, len(lines)), over_load, label)
    rows = [row_of(kind, description, point) for point in everything]
    _label(panels, kind, over_load, typeset(MICROMETRE.text(description.roughness)), rows)
    if len(lines) > 1:
        handles, labels = panels[0].get_legend_handles_labels()
        figure.legend(handles, labels, fontsize=8, frameon=False, loc="outside right center", title="speed")
    return figure


def _line(panels: Sequence[Axes], rows: Sequence[Row], colour: str, over_load: bool, label: str) -> None:
    """One line in each panel."""
    x = np.array([row["load"] if over_load else RPM.value(row["speed"]) for row in rows])

    def of(name: str, factor: float) -> FloatArray:
        return factor * np.array([row[name] for row in rows])

    panels[0].plot(x, of("stiffness_along", 1e-6), color=colour, lw=1.3, label=label)
    panels[0].plot(x, of("stiffness_across", 1e-6), color=colour, lw=1.0, ls="--")
    panels[1].plot(x, of("damping_along", 1e-3), color=colour, lw=1.3)
    panels[1].plot(x, of("damping_across", 1e-3), color=colour, lw=1.0, ls="--")
    panels[2].plot(x, of("highest_raceway_load", 1.0), color=colour, lw=1.3)
    for side, dashes in ((0, "-"), (1, "--")):
        panels[3].plot(x, of("hertz_pressure", 1e-9)[:, side], color=colour, lw=1.2, ls=dashes)
        panels[4].plot(x, of("minimum_film", 1e6)[:, side], color=colour, lw=1.2, ls=dashes)
    panels[5].plot(x, of("film_parameter", 1.0), color=colour, lw=1.3)


def _label(panels: Sequence[Axes], kind: Kind, over_load: bool, roughness: str, rows: Sequence[Row]) -> None:
    """Words on the panels."""
    texts = (
        "stiffness, N/µm\nsolid along, dashed across the load",
        "damping (low-frequency limit), N s/mm\nsolid along, dashed across the load",
        f"highest {kind.element} load, N",
        "largest Hertz pressure, GPa\nsolid inner, dashed outer raceway",
        "smallest film, µm\nsolid inner, dashed outer raceway",
        f"Λ, film over {roughness} of roughness\n(mixed below 3, boundary below 1)",
    )
    spread = rows[-1]["load"] / rows[0]["load"] if over_load and rows[0]["load"] > 0.0 else 1.0
    for panel, text in zip(panels, texts, strict=True):
        panel.set_title(text, fontsize=9)
        quiet_grid(panel)
        if spread > WIDE_RANGE:
            panel.set_xscale("log")
        if spread > WIDE_RANGE and panel is panels[2]:
            panel.set_yscale("log")
        else:  # curves that stand still would lie on the frame
            panel.set_ylim(0.0, 1.08 * max(panel.get_ylim()[1], 1e-9))
        panel.margins(x=0.02)
        if not any(np.any(np.isfinite(line.get_ydata())) for line in panel.get_lines()):
            panel.text(0.5, 0.5, "no film is known", transform=panel.transAxes, ha="center", color="0.4")
    if not any(row["damping_along"] or row["damping_across"] for row in rows):
        panels[1].set_ylim(0.0, 1.0)
        panels[1].text(0.5, 0.5, "dry contacts: no damping", transform=panels[1].transAxes, ha="center", color="0.4")
    top = panels[5].get_ylim()[1]
    for limit in (1.0, 3.0):
        if limit < top:
            panels[5].axhline(limit, color="0.5", lw=0.8, ls=":")
    _static_limit(panels[3], kind, np.array([row["hertz_pressure"] for row in rows]))
    for panel in panels[3:]:
        panel.set_xlabel("load on the inner ring, N" if over_load else "speed of the inner ring, rpm")


def _static_limit(panel: Axes, kind: Kind, pressures: FloatArray) -> None:
    """A line at the static limit, where pressures come near it."""
    limit = kind.static_limit
    if np.nanmax(pressures) > 0.75 * limit:
        panel.axhline(1e-9 * limit, color=WARNING, lw=0.9, ls=":")
        words = f"static limit {PRESSURE.text(limit)}"
        place = panel.get_yaxis_transform()
        panel.text(0.02, 1e-9 * limit, words, color=WARNING, fontsize=7.5, va="bottom", transform=place)


def _title(figure: Figure, heads: Sequence[str], words: str, problems: Sequence[str]) -> None:
    """Write what is shown, what was assumed, and why it may not hold."""
    lines = typeset("\n".join(line.strip() for line in heads)).splitlines()
    lines += [words] if words else []
    figure.suptitle(
        "\n".join(part for line in lines for part in textwrap.wrap(line, _WIDE, break_on_hyphens=False)), fontsize=9.5
    )
    if problems:
        # One of a kind: the numbers differ from point to point.
        kinds = {without_numbers(problem): problem for problem in problems}
        warnings = [part for problem in kinds.values() for part in textwrap.wrap(f"warning: {problem}", _WIDE)]
        figure.supxlabel("\n".join(warnings), color=WARNING, fontsize=8.5)


def _shade(order: int, count: int) -> str:
    """Colour of a line: from blue at the lowest speed to red at the highest."""
    from matplotlib import colormaps
    from matplotlib.colors import to_hex

    return COLOURS[0] if count == 1 else to_hex(colormaps["viridis"](0.9 * order / (count - 1)))


def statics_figure(
    model: Model, balance: Equilibrium, contacts: Sequence[BearingContacts], warnings: Sequence[str] = ()
) -> Figure:
    """Load of each roller or ball around each bearing, with pressures, films and warnings.

    Parameters
    ----------
    model : Model
        The system.
    balance : Equilibrium
        Equilibrium of the model.
    contacts : sequence of BearingContacts
        Pressures and films of each bearing.
    warnings : sequence of str
        What is to be warned of, written on the page.
    """
    count, elements = len(model.on_rings), []
    figure, axes = page(model, f"{written(model.scene.speed * RPM.factor)} rpm", count)
    for bearing, state in zip(model.on_rings, contacts, strict=True):
        motion = model.system.relative(bearing.inner, bearing.outer) @ balance.displacement
        found, words = bearing.loads(motion, balance.operation), _contact_words(state)
        if mean_angle := getattr(found, "mean_angle", None):  # of balls
            angles = " and ".join(f"{math.degrees(mean_angle(side)):.3g}" for side in (0, 1))
            words = f"{words}\ncontact angles {angles}\N{DEGREE SIGN}, inner and outer"
        elements.append((bearing.name, words, found.angle, np.atleast_2d(found.load)[0]))
    for panel, (name, words, angle, load) in zip(axes, elements, strict=False):
        panel.bar(np.degrees(angle), load, width=0.6 * 360.0 / angle.size, color=COLOURS[0])
        panel.set_title(f"{name}\n{words}", fontsize=9)
        panel.set_xlim(-200, 200)
        panel.set_xticks(np.arange(-180, 181, 90))
        grid(panel)
    for panel in axes[count:]:
        panel.set_visible(False)
    kinds = sorted({bearing.rolling_element for bearing in model.on_rings}, reverse=True)
    figure.supylabel(f"load of the {' or '.join(kinds)}, N", fontsize=10)
    words = f"angle of the {' or '.join(kinds)} from y towards z, degrees"
    wrapped = [part for line in warnings for part in textwrap.wrap(f"warning: {line}", 110)]
    if wrapped:
        for panel in axes:
            panel.set_xlabel(words, fontsize=8)
        figure.supxlabel("\n".join(wrapped), fontsize=8, color=WARNING)
    else:
        figure.supxlabel(words, fontsize=10)
    return figure


def _contact_words(contacts: BearingContacts) -> str:
    """Largest pressure and smallest film of a bearing."""
    pressure = f"Hertz pressure up to {1e-9 * contacts.hertz_pressure.max():.3g} GPa"
    film = 1e6 * float(np.min(contacts.minimum_film))
    return pressure if math.isnan(film) else f"{pressure}, film down to {film:.3g} µm"
