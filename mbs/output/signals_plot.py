"""Signals of sensors over time, and their amplitudes about chosen speeds: a row a sensor, a colour a law."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import FigureBase
from matplotlib.lines import Line2D

from ehdmaps.arrays import FloatArray
from ehdmaps.figures import COLOURS, typeset
from ehdmaps.units import RPM
from mbs.output.page import grid
from mbs.spectral.spectra import AmplitudeSpectrum
from mbs.timedata.records import TimeRecord

MOST_SENSORS = 6
"""Rows that are drawn."""

_POINTS = 3000
"""Of a line across a panel: more are drawn as least and largest value of each part."""

_PREFIXES = ((1e-1, "", 1.0), (1e-4, "m", 1e3), (1e-7, "µ", 1e6), (0.0, "n", 1e9))


def signal_panels(
    figure: FigureBase,
    records: Sequence[TimeRecord],
    spectra: Sequence[Sequence[Sequence[AmplitudeSpectrum]]] = (),
    labelled: bool = False,
) -> list[Axes]:
    """Draw up to `MOST_SENSORS` sensors into a figure or a part of one; the panels over time are returned.

    Parameters
    ----------
    figure : FigureBase
        Where to draw.
    records : sequence of TimeRecord
        A run each, of the same channels.
    spectra : sequence of sequence of sequence of AmplitudeSpectrum
        About each speed, of each run, of each sensor; a column a speed.
    labelled : bool
        Whether a legend says which colour is which run, also of one alone.
    """
    sensors = records[0].sensors[:MOST_SENSORS]
    rows, columns = len(sensors), 1 + len(spectra)
    # Constrained layout ties columns of one grid together: each column its own width.
    axes = figure.subplots(rows, columns, squeeze=False, width_ratios=[1.3, *[1.0] * len(spectra)])
    for row, channel in enumerate(sensors):
        columns_of = [record.column(channel) for record in records]
        prefix, factor = _prefix(columns_of)
        unit = typeset(f"{prefix}{channel.unit}")
        for record, values, colour in zip(records, columns_of, COLOURS, strict=False):
            time, course = _envelope(record.time, factor * values)
            # What moves least lies on top.
            axes[row, 0].plot(time, course, color=colour, lw=0.5, zorder=2.0 + 1.0 / (1.0 + factor * np.ptp(values)))
        axes[row, 0].set_ylabel(f"{channel.name}\n{channel.recorded}, {unit}", fontsize=7.5)
        for column, about in enumerate(spectra, start=1):
            panel = axes[row, column]
            for found, colour in zip(about, COLOURS, strict=False):
                amplitude = found[row].amplitude
                panel.semilogy(found[row].frequencies, factor * amplitude, color=colour, lw=0.7)
            _decades(panel)
            if row == 0:
                panel.set_title(f"amplitude at {RPM.text(about[0][row].speed)}", fontsize=8)
            panel.set_ylabel(unit, fontsize=7.5)
    for panel in axes[-1, 1:]:
        panel.set_xlabel("frequency, Hz", fontsize=8)
    axes[-1, 0].set_xlabel("time, s", fontsize=8)
    for panel in axes.flat:
        grid(panel)
        panel.tick_params(labelsize=7)
        if panel.get_subplotspec().rowspan.stop < rows:
            panel.tick_params(labelbottom=False)
    for row in range(1, rows):
        for panel, above in zip(axes[row], axes[0], strict=True):
            panel.sharex(above)
    left_out = len(records[0].sensors) - rows
    if records[1:] or labelled or left_out:
        handles = [
            Line2D([], [], color=colour, lw=1.2, label=typeset(record.label))
            for record, colour in zip(records, COLOURS, strict=False)
        ]
        figure.legend(
            handles=handles if records[1:] or labelled else [],
            title=f"{left_out} more sensors not drawn" if left_out else None,
            title_fontsize=7,
            loc="outside lower center",
            ncols=3,
            fontsize=7.5,
            frameon=False,
        )
    return list(axes[:, 0])


def _prefix(columns: Sequence[FloatArray]) -> tuple[str, float]:
    """Prefix and factor with which the largest of some values is a readable number."""
    largest = max(float(np.max(np.abs(column))) for column in columns)
    return next((name, factor) for least, name, factor in _PREFIXES if largest >= least)


def _envelope(time: FloatArray, values: FloatArray) -> tuple[FloatArray, FloatArray]:
    """A course with least and largest value of each part of it, where it has more points than are seen."""
    if values.size <= 2 * _POINTS:
        return time, values
    size = values.size // _POINTS
    kept = values[: size * (values.size // size)].reshape(-1, size)
    middles = time[: kept.size].reshape(-1, size)[:, size // 2]
    return np.repeat(middles, 2), np.column_stack([kept.min(axis=1), kept.max(axis=1)]).ravel()


def _decades(panel: Axes) -> None:
    """At most six decades below the highest amplitude: what lies deeper is nothing."""
    highest = max((float(np.max(line.get_ydata())) for line in panel.lines), default=0.0)
    lowest = min((float(np.min(line.get_ydata())) for line in panel.lines), default=0.0)
    if highest > 0.0:
        panel.set_ylim(max(lowest, 1e-6 * highest), 2.0 * highest)
