"""A map of points on one page: stiffness, damping and films over the load of a ball, both contacts."""

from __future__ import annotations

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from ehdmaps.figures import COLOURS, typeset, write_heading
from ehdmaps.jobs.make.points_map import SIDES
from ehdmaps.units import DAMPER, FILM, SPEED, SPRING, TEMPERATURE

SIZE = (11.0, 7.6)
"""Size of the page [inch]."""

_SHOWN = 4
_PANELS = (
    ("stiffness", "stiffness", SPRING, "log"),
    ("damping", "damping", DAMPER, "log"),
    ("film offset", "film_offset", FILM, "linear"),
    ("smallest film", "minimum_film", FILM, "linear"),
)


def points_map_figure(dataset: xr.Dataset) -> Figure:
    """Draw the page: some speeds at the middle temperature; bands are the stated errors.

    Parameters
    ----------
    dataset : xarray.Dataset
        A map of points.
    """
    speeds = dataset["entrainment_speed"].values
    moving = np.flatnonzero(speeds > 0.0)
    chosen = moving[np.unique(np.linspace(0, moving.size - 1, _SHOWN).round().astype(int))]
    middle = dataset.sizes["temperature"] // 2
    temperature = float(dataset["temperature"].values[middle])
    figure = Figure(figsize=SIZE, layout="constrained")
    heading = f"{dataset.attrs['title']}, {TEMPERATURE.text(temperature)}; inner full, outer dashed"
    write_heading(figure, typeset(heading), 10, "bold")
    load = dataset["load"].values
    for axes, (label, name, display, scale) in zip(figure.subplots(2, 2).ravel(), _PANELS, strict=True):
        for colour, index in zip(COLOURS, chosen, strict=False):
            for side, style in zip(SIDES, ("-", "--"), strict=True):
                here = dataset.sel(contact=side).isel(entrainment_speed=int(index), temperature=middle)
                value, error = display.factor * here[name].values, here[f"{name}_error"].values
                speed = SPEED.text(float(speeds[index])) if side == SIDES[0] else None
                axes.plot(load, value, style, color=colour, lw=1.1, label=speed)
                axes.fill_between(load, value * (1.0 - np.minimum(error, 0.99)), value * (1.0 + error),
                                  color=colour, alpha=0.12, lw=0.0)  # fmt: skip
        axes.set_xscale("log")
        axes.set_yscale(scale)
        if scale == "linear":
            top = display.factor * dataset[name].isel(entrainment_speed=int(chosen[-1]), temperature=middle).median()
            if np.isfinite(top) and top > 0.0:
                axes.set_ylim(0.0, 2.5 * float(top))
        axes.set_xlabel("load of a ball, N")
        axes.set_ylabel(f"{label}, {typeset(display.unit)}")
        axes.grid(color="0.9", lw=0.4)
    figure.axes[0].legend(title="entrainment speed", fontsize=8, frameon=False)
    return figure
