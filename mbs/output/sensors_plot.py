"""The figure of a run-up at several sensors: a row each, with the diagrams of all laws and their sum levels."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence

from matplotlib.cm import ScalarMappable
from matplotlib.figure import Figure

from ehdmaps.figures import COLOURS, write_heading
from mbs.output.campbell_plot import (
    colour_scale,
    diagram,
    frequency_unit,
    order_lines,
    reference_text,
    speed_range,
)
from mbs.output.page import grid
from mbs.spectral.campbell import RunUpSpectra
from mbs.spectral.levels import Reference
from mbs.spectral.run_signal import RPM

MOST_SENSORS = 6
"""Rows that are drawn."""

_DASHES = ("-", "--", "-.", ":")
_COLUMN, _ROW = 2.6, 1.9
"""Size of a panel [inch]."""


def sensors_figure(
    title: str,
    laws: Sequence[str],
    results: Sequence[Sequence[RunUpSpectra]],
    sensors: Sequence[tuple[str, Reference]],
    orders: Sequence[tuple[float, str]] = (),
) -> Figure:
    """Draw up to `MOST_SENSORS` sensors; how many are left out is said.

    Parameters
    ----------
    title : str
        Heading of the page.
    laws : sequence of str
        Names of the runs: of the laws, of a measured one.
    results : sequence of sequence of RunUpSpectra
        Spectra of each run, one a sensor.
    sensors : sequence of (str, Reference)
        Names, and references of their levels.
    orders : sequence of (float, str)
        Lines to draw in, with their names.
    """
    rows = min(len(sensors), MOST_SENSORS)
    figure = Figure(figsize=(_COLUMN * (len(laws) + 1) + 0.8, _ROW * rows + 1.0), layout="constrained")
    write_heading(figure, title, 8)
    axes = figure.subplots(rows, len(laws) + 1, squeeze=False, sharex=True)
    for row, (name, reference) in enumerate(sensors[:rows]):
        here = [spectra[row] for spectra in results]
        colours = colour_scale(here)
        for panel, law, result in zip(axes[row, :-1], laws, here, strict=True):
            diagram(panel, result, colours)
            order_lines(panel, result, orders)
            if row == 0:
                panel.set_title(textwrap.fill(law, 30), fontsize=8)
        axes[row, 0].set_ylabel(f"{name}\nfrequency, {frequency_unit(here[0])[1]}", fontsize=7)
        bar = figure.colorbar(ScalarMappable(colours, "viridis"), ax=axes[row, -2], pad=0.02, aspect=15, extend="min")
        bar.ax.tick_params(labelsize=6)
        sums = axes[row, -1]
        for law, result, colour, dashes in zip(laws, here, COLOURS, _DASHES * 2, strict=False):
            found = result.campbell
            sums.plot(found.speeds * RPM, found.sum_level, dashes, color=colour, lw=0.9, label=law)
        sums.set_ylabel(f"sum level,\n{reference_text(reference)}", fontsize=7)
        grid(sums)
    axes[0, -1].set_title("sum level", fontsize=8)
    axes[0, 0].set_xlim(*speed_range([spectra[0] for spectra in results]))
    for panel in axes.flat:
        panel.tick_params(labelsize=7)
    for panel in axes[-1]:
        panel.set_xlabel("speed, rpm", fontsize=7)
    left_out = len(sensors) - rows
    if left_out or len(laws) > 1:
        figure.legend(
            handles=axes[0, -1].lines if len(laws) > 1 else [],
            title=f"{left_out} more sensors not drawn" if left_out else None,
            title_fontsize=7,
            loc="outside lower center",
            ncols=min(len(laws), 3),
            fontsize=7,
            frameon=False,
        )
    return figure
