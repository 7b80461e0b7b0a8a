"""Figure of frequency responses."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from ehdmaps.arrays import ComplexArray, FloatArray
from ehdmaps.figures import COLOURS, typeset
from ehdmaps.units import RPM, written
from mbs.linearised.linear import response_display
from mbs.output.band_text import HEAD
from mbs.output.page import BAND_ALPHA, BAND_WORDS, ESTIMATED, grid, headed, page, shade
from mbs.scene.assembly import Model

if TYPE_CHECKING:
    from mbs.unknowns.of_peaks import PeakBands

MOST_COMPARED = 8
"""Responses that are drawn for several cases."""

_DASHES = ("-", "--", "-.", ":")
_ROUND_OFF = 1e-6
"""Of a phase [degrees]: -180 degrees less than this beside is +180 degrees."""


@dataclass(frozen=True, eq=False)
class Curves:
    """Responses of one case.

    Attributes
    ----------
    label : str
        What the case is.
    frequencies : array, shape (frequencies,)
        [Hz].
    responses : array, shape (frequencies, sensors, inputs)
        Sensor unit per N or N m.
    limit : float
        Frequency from which on the films are notably wrong [Hz].
    level_error : array, shape (frequencies, sensors, inputs), optional
        Bands of the levels, either way [dB]; none are drawn without.
    pitch_range : array, shape (2, frequencies, sensors, inputs), optional
        Least and largest size at each angle of the cage; drawn as thin lines.
    peaks : PeakBands, optional
        What is not known of peaks; drawn as crosses.
    """

    label: str
    frequencies: FloatArray
    responses: ComplexArray
    limit: float = math.inf
    level_error: FloatArray | None = None
    pitch_range: FloatArray | None = None
    peaks: PeakBands | None = None


def response_figure(model: Model, case: Curves, notes: Sequence[str] = ()) -> Figure:
    """Magnitude of each response, a panel a unit, and phase.

    Parameters
    ----------
    model : Model
        Model with its sensors and inputs.
    case : Curves
        Responses of the case; the range in which its films are notably wrong is shaded.
    notes : sequence of str
        Lines below the panels, such as warnings.
    """
    kinds: dict[str, str] = {}
    for sensor in model.scene.sensors:
        for entry in model.scene.inputs:
            kinds.setdefault(typeset(response_display(sensor, entry).unit), sensor.quantity)
    figure, axes = page(model, f"{written(RPM.value(model.scene.speed))} rpm", len(kinds) + 1, stacked=True)
    panels, phase = dict(zip(kinds, axes[:-1], strict=True)), axes[-1]
    colours = iter(COLOURS * 20)
    for s, sensor in enumerate(model.scene.sensors):
        for i, entry in enumerate(model.scene.inputs):
            colour, display = next(colours), response_display(sensor, entry)
            words = f"{sensor.name} by {entry.name}"
            _magnitude(panels[typeset(display.unit)], case, (s, i), display.factor, color=colour, label=words)
            phase.semilogx(*_phase(case.frequencies, case.responses[:, s, i]), color=colour, lw=0.9)
    for unit, panel in panels.items():
        panel.set_ylabel(f"{kinds[unit]}, {unit}")
        panel.legend(fontsize=8, frameon=False)
    phase.set(xlabel="frequency, Hz", ylabel="phase, degrees", yticks=[-180, -90, 0, 90, 180])
    for panel in axes:
        grid(panel)
    _limit(axes, case.limit)
    notes = [*_band_note([case]), *notes]
    if notes:
        figure.supxlabel("\n".join(notes), fontsize=7)
    return figure


def comparison_figure(model: Model, cases: Sequence[Curves], notes: Sequence[str] = ()) -> Figure:
    """Magnitude and phase of each response, a row each, up to `MOST_COMPARED`; a colour a case.

    Parameters
    ----------
    model : Model
        Model of the first case, with its sensors and inputs.
    cases : sequence of Curves
        Responses of each case. A line of its colour begins the range in which its films are notably wrong.
    notes : sequence of str
        Lines below the panels, such as warnings.
    """
    pairs = [(s, i) for s in range(len(model.scene.sensors)) for i in range(len(model.scene.inputs))]
    left_out = len(pairs) - MOST_COMPARED
    pairs = pairs[:MOST_COMPARED]
    size = (9.0, 1.7 + 1.8 * len(pairs) + 0.2 * (len(cases) + len(notes)))
    figure = headed(model, f"{written(RPM.value(model.scene.speed))} rpm", size, "laws side by side")
    rows = figure.subplots(len(pairs), 2, sharex=True, squeeze=False)
    styles = list(zip(cases, COLOURS * 6, _DASHES * 6, strict=False))
    for (s, i), (panel, phase) in zip(pairs, rows, strict=True):
        sensor, entry = model.scene.sensors[s], model.scene.inputs[i]
        for case, colour, dashes in styles:
            _magnitude(panel, case, (s, i), response_display(sensor, entry).factor, color=colour, ls=dashes)
            phase.semilogx(*_phase(case.frequencies, case.responses[:, s, i]), color=colour, ls=dashes, lw=0.9)
        panel.set_title(f"{sensor.name} by {entry.name}", fontsize=8.5)
        panel.set_ylabel(typeset(f"{sensor.quantity}, {response_display(sensor, entry).unit}"), fontsize=8)
        phase.set(yticks=[-180, -90, 0, 90, 180])
        phase.set_ylabel("phase, degrees", fontsize=8)
    handles = []
    low, high = rows[0, 0].get_xlim()
    for case, colour, dashes in styles:
        label = typeset(case.label)
        if case.limit < high:
            label += f" (from the upright line at {case.limit:.4g} Hz on: {ESTIMATED})"
            for panel in rows.flat:
                panel.axvline(max(case.limit, low), color=colour, lw=0.7, ls=":")
        handles.append(Line2D([], [], color=colour, ls=dashes, lw=1.2, label=label))
    for panel in rows.flat:
        grid(panel)
        panel.set_xlim(low, high)
    for panel in rows[-1]:
        panel.set_xlabel("frequency, Hz")
    below = [*_band_note(cases), *notes, *([f"{left_out} more responses not drawn"] if left_out > 0 else [])]
    figure.legend(
        handles=handles, title="\n".join(below), title_fontsize=7, fontsize=8, frameon=False, loc="outside lower center"
    )
    return figure


def _magnitude(panel: Axes, case: Curves, pair: tuple[int, int], unit: float, **style: str) -> None:
    """The size of a response in its unit, a factor; nothing where it is zero."""
    size = unit * np.abs(case.responses[:, pair[0], pair[1]])
    panel.loglog(case.frequencies, np.where(size > 0.0, size, np.nan), lw=1.0, **style)
    if case.pitch_range is not None:
        for edge in unit * case.pitch_range[:, :, pair[0], pair[1]]:
            seen = np.where(edge > 0.0, edge, np.nan)
            panel.loglog(case.frequencies, seen, lw=0.5, ls=":", color=style["color"])
    if case.peaks is not None:
        of = np.flatnonzero(np.all(case.peaks.places[:, 1:] == pair, axis=1))
        at, level = case.peaks.frequency.of(of), case.peaks.level.of(of)
        high = size[case.peaks.places[of, 0]]
        falls, rises = (high * np.abs(1.0 - 10.0 ** (part / 20.0)) for part in (-level.fall, level.rise))
        reach = (falls, rises), (at.fall, at.rise)
        panel.errorbar(at.value, high, *reach, fmt="none", ecolor=style["color"], elinewidth=0.8, capsize=2.0)
    if case.level_error is not None:
        factor = 10.0 ** (case.level_error[:, pair[0], pair[1]] / 20.0)
        panel.fill_between(
            case.frequencies, size / factor, size * factor, color=style["color"], alpha=BAND_ALPHA, lw=0.0, zorder=1.5
        )


def _band_note(cases: Sequence[Curves]) -> list[str]:
    """Note on what the shade about the curves is; nothing where no case has one."""
    shaded = [f"shaded: {BAND_WORDS}"] if any(case.level_error is not None for case in cases) else []
    crosses = [f"crosses at peaks: {HEAD}"] if any(case.peaks is not None for case in cases) else []
    dotted = ["dotted: least and largest size over the angles of the cage"]
    return shaded + crosses + (dotted if any(case.pitch_range is not None for case in cases) else [])


def _phase(frequencies: FloatArray, response: ComplexArray) -> tuple[FloatArray, FloatArray]:
    """Phase [degrees] over frequency, with a gap where it passes 180 degrees instead of a line across the panel."""
    phase = np.degrees(np.angle(response))
    phase = np.where(phase < _ROUND_OFF - 180.0, phase + 360.0, phase)
    jumps = np.flatnonzero(np.abs(np.diff(phase)) > 270.0) + 1
    return np.insert(frequencies, jumps, frequencies[jumps]), np.insert(phase, jumps, np.nan)


def _limit(axes: Sequence[Axes], limit: float) -> None:
    """Shade frequencies at which the films are notably wrong, and say so in the first panel."""
    low, high = axes[0].get_xlim()
    if not limit < high:
        return
    for panel in axes:
        shade(panel, max(limit, low), high)
        panel.set_xlim(low, high)
    axes[0].annotate(
        ESTIMATED,
        (0.99, 0.03),
        xycoords="axes fraction",
        ha="right",
        fontsize=7,
    )
