"""Figure of frequency responses."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ehdmaps.arrays import ComplexArray, FloatArray
from ehdmaps.figures import COLOURS, typeset
from ehdmaps.units import RPM
from mbs.linearised.linear import response_unit
from mbs.output.page import ESTIMATED, grid, page, shade
from mbs.scene.assembly import Model

_ROUND_OFF = 1e-6
"""Of a phase [degrees]: -180 degrees less than this beside is +180 degrees."""


def response_figure(
    model: Model,
    frequencies: FloatArray,
    responses: ComplexArray,
    limit: float = math.inf,
    notes: Sequence[str] = (),
) -> Figure:
    """Magnitude of each response, a panel a unit, and phase.

    Parameters
    ----------
    model : Model
        Model with its sensors and inputs.
    frequencies : array, shape (frequencies,)
        [Hz].
    responses : array, shape (frequencies, sensors, inputs)
        Sensor unit per N or N m.
    limit : float
        Frequency above which omega b/u exceeds 0.3 [Hz]: shaded from there on.
    notes : sequence of str
        Lines below the panels, such as warnings.
    """
    kinds: dict[str, str] = {}
    for sensor in model.scene.sensors:
        for entry in model.scene.inputs:
            kinds.setdefault(typeset(response_unit(sensor, entry)), sensor.quantity)
    figure, axes = page(model, f"{RPM.value(model.scene.speed):.4g} rpm", len(kinds) + 1, stacked=True)
    panels, phase = dict(zip(kinds, axes[:-1], strict=True)), axes[-1]
    colours = iter(COLOURS * 20)
    for s, sensor in enumerate(model.scene.sensors):
        for i, entry in enumerate(model.scene.inputs):
            colour, panel = next(colours), panels[typeset(response_unit(sensor, entry))]
            size = np.abs(responses[:, s, i])
            values = np.where(size > 0.0, size, np.nan)
            panel.loglog(frequencies, values, color=colour, lw=1.0, label=f"{sensor.name} by {entry.name}")
            phase.semilogx(*_phase(frequencies, responses[:, s, i]), color=colour, lw=0.9)
    for unit, panel in panels.items():
        panel.set_ylabel(f"{kinds[unit]}, {unit}")
        panel.legend(fontsize=8, frameon=False)
    phase.set(xlabel="frequency, Hz", ylabel="phase, degrees", yticks=[-180, -90, 0, 90, 180])
    for panel in axes:
        grid(panel)
    _limit(axes, limit)
    if notes:
        figure.supxlabel("\n".join(notes), fontsize=7)
    return figure


def _phase(frequencies: FloatArray, response: ComplexArray) -> tuple[FloatArray, FloatArray]:
    """Phase [degrees] over frequency, with a gap where it passes 180 degrees instead of a line across the panel."""
    phase = np.degrees(np.angle(response))
    phase = np.where(phase < _ROUND_OFF - 180.0, phase + 360.0, phase)
    jumps = np.flatnonzero(np.abs(np.diff(phase)) > 270.0) + 1
    return np.insert(frequencies, jumps, frequencies[jumps]), np.insert(phase, jumps, np.nan)


def _limit(axes: Sequence[Axes], limit: float) -> None:
    """Shade frequencies above the low-frequency limit of the films, and say so in the first panel."""
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
