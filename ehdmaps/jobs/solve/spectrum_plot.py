"""Complex stiffness of contacts over frequency on one page, a column a contact."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ehdmaps.arrays import BoolArray, FloatArray
from ehdmaps.figures import write_heading
from ehdmaps.jobs.solve.spectrum import spectrum_place
from ehdmaps.outputs import write_figure
from ehdmaps.physics.solution import Status
from ehdmaps.units import COMPLIANCE, STIFFNESS

COLUMN = (5.6, 7.6)
"""Size of a column [inch]."""

RESOLUTION = 200
_FONT: Any = {"font.size": 8.5, "axes.linewidth": 0.6, "xtick.major.width": 0.6, "ytick.major.width": 0.6}
_LINE, _SLOW, _NEGATIVE = "#1b6ca8", "0.45", "#c8102e"


def plot_spectrum(dataset: xr.Dataset, title: str, output: Path) -> None:
    """Draw the page and write it.

    Parameters
    ----------
    dataset : xarray.Dataset
        See `ehdmaps.jobs.solve.spectrum.spectrum_dataset`.
    title : str
        Bearing and oil.
    output : Path
        The picture; its ending decides the format (png, pdf, svg).

    Raises
    ------
    InputError
        If it cannot be written, or the ending is not known.
    """
    import matplotlib as mpl

    with mpl.rc_context(_FONT):
        write_figure(spectrum_figure(dataset, title), output, RESOLUTION)


def spectrum_figure(dataset: xr.Dataset, title: str) -> Figure:
    """Draw the page.

    Parameters
    ----------
    dataset : xarray.Dataset
        See `ehdmaps.jobs.solve.spectrum.spectrum_dataset`.
    title : str
        Bearing and oil.
    """
    contacts = dataset["contact"].values.tolist()
    figure = Figure(figsize=(COLUMN[0] * max(len(contacts), 1), COLUMN[1]), layout="constrained")
    place = spectrum_place(dataset).replace("degC", "°C")
    write_heading(figure, f"{title}: {place}; {dataset.attrs['solver']}", 10, "bold")
    panels = figure.subplots(3, len(contacts), squeeze=False, sharex=True)
    for contact, column in zip(contacts, panels.T, strict=True):
        _column(dataset.sel(contact=contact), contact, list(column))
    return figure


def _column(chosen: xr.Dataset, contact: str, panels: list[Axes]) -> None:
    """Draw the panels of a contact."""
    real, loss, film = panels
    real.set_title(contact, fontsize=9, fontweight="bold", loc="left")
    film.set_xlabel("frequency, Hz")
    status = Status(int(chosen["status"]))
    if not status.usable:
        real.text(0.5, 0.5, f"{status.word}: no solution", ha="center", transform=real.transAxes)
        return
    frequency = np.asarray(chosen["frequency"].values)
    omega = 2.0 * np.pi * frequency
    k, c = chosen["stiffness"].values, chosen["damping"].values
    _banded(real, frequency, STIFFNESS.factor * k, chosen["stiffness_error"].values)
    real.axhline(STIFFNESS.factor * float(chosen["slow_stiffness"]), color=_SLOW, lw=0.9, ls=(0, (5, 2)))
    real.set_ylabel(f"real part k, {STIFFNESS.unit}".replace("um", "µm"))

    lossy = STIFFNESS.factor * omega * c
    _banded(loss, frequency, lossy, chosen["damping_error"].values)
    slow = STIFFNESS.factor * omega * float(chosen["slow_damping"])
    band = np.nan_to_num(chosen["damping_error"].values)
    low, high = _limits(lossy * (1.0 - band), lossy * (1.0 + band))
    loss.plot(frequency, slow, color=_SLOW, lw=0.9, ls=(0, (5, 2)), label="k and c of slow motion")
    loss.set_ylim(low, high)
    loss.set_ylabel(f"loss part ωc, {STIFFNESS.unit}".replace("um", "µm"))

    compliance, share = COMPLIANCE.factor * chosen["film_compliance"].values, chosen["film_compliance_error"].values
    error = share * np.abs(compliance)
    for values, colour, name in ((compliance.real, "#444444", "real part"), (-compliance.imag, "#d17b0f", "loss part")):
        film.plot(frequency, values, color=colour, lw=1.1, label=f"{name} of S")
        film.fill_between(frequency, values - error, values + error, color=colour, alpha=0.25, lw=0.0)
    film.axhline(0.0, color="black", lw=0.5)
    film.set_ylabel(f"film compliance S, {COMPLIANCE.unit}".replace("um", "µm"))

    fed = c < 0.0
    for axes in panels:
        axes.set_xscale("log")
        axes.grid(color="0.9", lw=0.4)
        axes.margins(x=0.0)
        for first, last in _bands(fed):
            ends = _edges(frequency, first, last)
            words = (
                "negative damping: the film feeds the oscillation" if axes is loss and first == np.argmax(fed) else None
            )
            axes.axvspan(*ends, facecolor=_NEGATIVE, alpha=0.13, lw=0.0, label=words)
    loss.axhline(0.0, color="black", lw=0.5)
    loss.legend(frameon=False, fontsize=7.5, loc="best")
    film.legend(frameon=False, fontsize=7.5, loc="best")
    _second_axis(real, frequency, chosen["omega_b_over_u"].values)


def _banded(axes: Axes, frequency: FloatArray, values: FloatArray, error: FloatArray) -> None:
    """A curve with the band of its estimated numerical error, where there is one."""
    stated = np.isfinite(error).any()
    label = "at the frequency, with its estimated error" if stated else "at the frequency"
    axes.plot(frequency, values, color=_LINE, lw=1.2, label=label)
    axes.fill_between(frequency, values * (1.0 - error), values * (1.0 + error), color=_LINE, alpha=0.25, lw=0.0)


def _limits(low: FloatArray, high: FloatArray) -> tuple[float, float]:
    """Range of a panel that shows all of a band, and zero."""
    bottom, top = min(float(np.min(low)), 0.0), max(float(np.max(high)), 0.0)
    margin = 0.08 * (top - bottom or 1.0)
    return bottom - margin, top + margin


def _bands(fed: BoolArray) -> list[tuple[int, int]]:
    """First and last index of each run of frequencies."""
    steps = np.flatnonzero(np.diff(np.r_[False, fed, False].astype(int)))
    return [(int(first), int(last) - 1) for first, last in zip(steps[::2], steps[1::2], strict=True)]


def _edges(frequency: FloatArray, first: int, last: int) -> tuple[float, float]:
    """Ends of a band, half-way to the frequencies beside it."""
    middles = np.sqrt(frequency[1:] * frequency[:-1])
    return float(np.r_[frequency[0], middles][first]), float(np.r_[middles, frequency[-1]][last])


def _second_axis(axes: Axes, frequency: FloatArray, reduced: FloatArray) -> None:
    """Omega b/u above the panel; none at a standstill."""
    ratio = float(reduced[0] / frequency[0])
    if not np.isfinite(ratio):
        return
    to_ratio, to_frequency = (partial(np.multiply, factor) for factor in (ratio, 1.0 / ratio))
    above = axes.secondary_xaxis("top", functions=(to_ratio, to_frequency))
    above.set_xlabel("ω b/u")
