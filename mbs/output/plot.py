"""Figures of the analyses."""

from __future__ import annotations

import itertools
import math
import textwrap
from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ehdmaps.physics._values import FloatArray
from ehdmaps.units import TEMPERATURE
from mbs.assembly import Model
from mbs.bearings.contact_report import BearingContacts
from mbs.linearised.linear import ComplexArray, response_unit
from mbs.linearised.modes import Modes
from mbs.reading.fields import MICROMETRE
from mbs.statics import Equilibrium
from mbs.transient.integration import Trajectory

_RPM = 30.0 / np.pi
_SIZE = (9.0, 5.5)
_MOST_LEVEL_LABELS = 12
_MOST_LABELS = 45
"""That stand upright beside each other."""

_COLOURS = ("#1f5fa8", "#c8102e", "#2a7f3f", "#8a5a00", "#6a3d9a")
_FILLS = ("#4477aa", "#ee6677", "#228833", "#ccbb44", "#66ccee", "#aa3377", "#999999")
"""Apart also for the colour-blind; with each hatch in turn for more parts than these."""

_HATCHES = ("", "////", "....", "xxxx") * 20


def statics_figure(
    model: Model, balance: Equilibrium, contacts: Sequence[BearingContacts], warnings: Sequence[str] = ()
) -> Figure:
    """Load of each roller around each bearing, with its pressures and films, and what is to be warned of."""
    figure, axes = _page(model, f"{model.scene.speed * _RPM:.4g} rpm", len(model.bearings))
    for panel, bearing, state in zip(axes, model.bearings, contacts, strict=False):
        motion = model.system.relative(bearing.inner, bearing.outer) @ balance.displacement
        rollers = bearing.rollers(motion, balance.operation)
        panel.bar(np.degrees(rollers.angle), rollers.load, width=0.6 * 360.0 / rollers.angle.size, color=_COLOURS[0])
        panel.set_title(f"{bearing.name}\n{_contact_words(state)}", fontsize=9)
        panel.set_xlim(-200, 200)
        panel.set_xticks(np.arange(-180, 181, 90))
        _grid(panel)
    for panel in axes[len(model.bearings) :]:
        panel.set_visible(False)
    figure.supylabel("load of the roller, N", fontsize=10)
    words = "angle of the roller from y towards z, degrees"
    wrapped = [part for line in warnings for part in textwrap.wrap(f"warning: {line}", 110)]
    if wrapped:
        for panel in axes:
            panel.set_xlabel(words, fontsize=8)
        figure.supxlabel("\n".join(wrapped), fontsize=8, color=_COLOURS[1])
    else:
        figure.supxlabel(words, fontsize=10)
    return figure


def _contact_words(contacts: BearingContacts) -> str:
    """Largest pressure and smallest film of a bearing."""
    pressure = f"Hertz pressure up to {1e-9 * contacts.hertz_pressure.max():.3g} GPa"
    film = 1e6 * float(np.min(contacts.minimum_film))
    return pressure if math.isnan(film) else f"{pressure}, film down to {film:.3g} µm"


def modes_figure(model: Model, found: Modes) -> Figure:
    """Strain-energy shares of each mode."""
    figure, (panel,) = _page(model, f"{model.scene.speed * _RPM:.4g} rpm", 1)
    places = np.arange(found.eigenvalues.size)
    bottom = np.zeros(places.size)
    styles = itertools.product(_HATCHES, _FILLS)
    for part, share, (hatch, colour) in zip(found.parts, found.shares, styles, strict=False):
        panel.bar(places, share, bottom=bottom, label=part, color=colour, hatch=hatch, edgecolor="w", lw=0.0)
        bottom += share
    level = places.size <= _MOST_LEVEL_LABELS
    mark = "\n" if level else ", "
    labels = [f"{f:.5g} Hz{mark}ζ {z:.2g}" for f, z in zip(found.frequency, found.damping_ratio, strict=True)]
    every = math.ceil(max(places.size, 1) / _MOST_LABELS)
    panel.set_xticks(places[::every], labels[::every], fontsize=7, rotation=0 if level else 90)
    panel.set_xlim(-0.8, max(places.size, 1) - 0.2)
    panel.set_xlabel("frequency |eigenvalue|/(2π) and damping ratio ζ of the mode")
    panel.set_ylabel("part of the strain energy")
    panel.legend(fontsize=7, loc="upper left", bbox_to_anchor=(1.0, 1.0), frameon=False)
    return figure


def response_figure(model: Model, frequencies: FloatArray, responses: ComplexArray) -> Figure:
    """Magnitude of each response, a panel a unit, and phase."""
    kinds: dict[str, str] = {}
    for sensor in model.scene.sensors:
        for entry in model.scene.inputs:
            kinds.setdefault(_shown(response_unit(sensor, entry)), sensor.quantity)
    figure, axes = _page(model, f"{model.scene.speed * _RPM:.4g} rpm", len(kinds) + 1, stacked=True)
    panels, phase = dict(zip(kinds, axes[:-1], strict=True)), axes[-1]
    colours = iter(_COLOURS * 20)
    for s, sensor in enumerate(model.scene.sensors):
        for i, entry in enumerate(model.scene.inputs):
            colour, panel = next(colours), panels[_shown(response_unit(sensor, entry))]
            size = np.abs(responses[:, s, i])
            panel.loglog(
                frequencies,
                np.where(size > 0.0, size, np.nan),
                color=colour,
                lw=1.0,
                label=f"{sensor.name} by {entry.name}",
            )
            phase.semilogx(frequencies, np.degrees(np.angle(responses[:, s, i])), color=colour, lw=0.9)
    for unit, panel in panels.items():
        panel.set_ylabel(f"{kinds[unit]}, {unit}")
        panel.legend(fontsize=8, frameon=False)
    phase.set(xlabel="frequency, Hz", ylabel="phase, degrees", yticks=[-180, -90, 0, 90, 180])
    for panel in axes:
        _grid(panel)
    return figure


def run_figure(model: Model, run: Trajectory) -> Figure:
    """Bearing forces and displacements of the inner rings over time, with the speed."""
    figure, axes = _page(model, "", 3, stacked=True)
    lines = zip(model.bearings, run.forces, _COLOURS * 20, ("-", "--") * 50, strict=False)
    for bearing, force, colour, dashes in lines:
        motion = run.displacement @ model.system.relative(bearing.inner, bearing.outer).T
        place = 1e6 * np.hypot(motion[:, 1], motion[:, 2])
        axes[0].plot(run.time, np.hypot(force[:, 1], force[:, 2]), dashes, color=colour, lw=0.9, label=bearing.name)
        axes[1].plot(run.time, place, dashes, color=colour, lw=0.9)
    axes[2].plot(run.time, run.speed * _RPM, color="0.2", lw=1.0)
    axes[0].set_ylabel("bearing force, N")
    axes[1].set_ylabel("inner ring against\nthe outer one, µm")
    axes[2].set(xlabel="time, s", ylabel="speed, rpm")
    if model.bearings:
        axes[0].legend(fontsize=8, frameon=False, ncols=4, loc="lower left", bbox_to_anchor=(0.0, 1.0))
    for panel in axes:
        _grid(panel)
    return figure


def _page(model: Model, words: str, panels: int, stacked: bool = False) -> tuple[Figure, list[Axes]]:
    """A figure with its heading and rows, or a stack, of at least so many panels; `words` follow the law."""
    clearances = sorted({entry.geometry.diametral_clearance for entry in model.scene.bearings})
    at = [
        *([words] if words else []),
        TEMPERATURE.text(model.scene.temperature).replace("deg", "°"),
        *([f"clearance {', '.join(_shown(MICROMETRE.text(value)) for value in clearances)}"] if clearances else []),
    ]
    figure = _figure(model.scene.title, f"{model.law}; {', '.join(at)}")
    rows = panels if stacked else max(round(math.sqrt(panels / 1.5)), 1)
    shape = (rows, math.ceil(panels / rows))
    axes = figure.subplots(*shape, sharex=stacked, squeeze=False)
    return figure, list(axes.ravel())


def _figure(title: str, words: str) -> Figure:
    """A figure with its heading."""
    figure = Figure(figsize=_SIZE, layout="constrained")
    figure.suptitle(f"{title}\n{words}", fontsize=10)
    return figure


def _shown(unit: str) -> str:
    """A unit as figures show it."""
    return unit.replace("s2", "s²").replace("um", "µm")


def _grid(panel: Axes) -> None:
    """A quiet grid."""
    panel.grid(color="0.88", lw=0.5)
    panel.set_axisbelow(True)
    panel.tick_params(labelsize=8)
