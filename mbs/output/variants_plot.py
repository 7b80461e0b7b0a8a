"""The figure of differences between two contact laws under single changes: a panel a sensor, a line a change."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from ehdmaps.figures import COLOURS, WARNING, typeset, write_heading

_WIDTH, _TOP, _LINE = 7.2, 1.6, 0.19
"""Width of the page, what stands above and below, and height of a line [inch]."""

_MARKS = (
    ("highest_difference", "D", COLOURS[3], "highest of each, at any speed"),
    ("energy_difference", "s", COLOURS[2], "mean energy"),
    ("median_difference", "o", COLOURS[0], "median of the windows"),
)


def variants_figure(title: str, dataset: xr.Dataset, labels: Sequence[str]) -> Figure:
    """Draw the table of `mbs variants`.

    Parameters
    ----------
    title : str
        Heading of the page.
    dataset : xarray.Dataset
        The table, see `mbs.output.variants_data`.
    labels : sequence of str
        The two laws.
    """
    names = [
        typeset(f"{key} {value}") if key else "base"
        for key, value in zip(dataset["key"].values.tolist(), dataset["value"].values.tolist(), strict=True)
    ]
    sensors = dataset["sensor"].values.tolist()
    figure = Figure(figsize=(_WIDTH, _TOP + _LINE * len(names)), layout="constrained")
    write_heading(figure, typeset(f"{title}\nsum level of {labels[1]} minus that of {labels[0]}"), 8)
    panels = figure.subplots(1, len(sensors), sharex=True, sharey=True, squeeze=False)[0]
    lines = np.arange(len(names))
    for column, (panel, sensor) in enumerate(zip(panels, sensors, strict=True)):
        data = dataset.isel(sensor=column)
        panel.hlines(lines, data["low_difference"], data["high_difference"], color="0.75", lw=4.0)
        for name, marker, colour, words in _MARKS:
            panel.plot(data[name], lines, marker, color=colour, ms=3.5, ls="none", label=words)
        for line in lines[np.isnan(data["median_difference"].values)].tolist():
            panel.text(0.5, line, "no result", transform=panel.get_yaxis_transform(), color=WARNING, fontsize=6,
                       ha="center", va="center")  # fmt: skip
        panel.axvline(0.0, color="0.4", lw=0.7)
        panel.axhline(0.5, color="0.4", lw=0.4)
        panel.set_title(f"sensor {sensor}", fontsize=8)
        panel.set_xlabel("dB", fontsize=7)
        panel.tick_params(labelsize=7)
        panel.grid(axis="x", lw=0.3)
    panels[0].set_yticks(lines, names)
    panels[0].invert_yaxis()
    handles, words_of = panels[0].get_legend_handles_labels()
    bar = panels[0].collections[0]
    figure.legend([*handles, bar], [*words_of, "5 to 95 % of the windows"], loc="outside lower center", ncols=4,
                  fontsize=7, frameon=False)  # fmt: skip
    return figure
