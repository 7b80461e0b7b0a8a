"""Load and pressure over the length of a roller by four methods, as a figure."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ehdmaps.figures import COLOURS, write_heading
from ehdmaps.units import written
from tests.finite_length.compare import LengthComparison
from tests.finite_length.reference import LengthReference


def length_figure(reference: LengthReference, cases: list[LengthComparison]) -> Figure:
    """Load per length and pressure in the middle of the width, of all cases.

    Parameters
    ----------
    reference : LengthReference
        The finite elements.
    cases : list of LengthComparison
        Cases of the reference beside the other solutions.
    """
    figure = Figure(figsize=(13.0, 8.4), layout="constrained")
    profiles = list(dict.fromkeys(entry.case.profile for entry in cases))
    columns = max(sum(entry.case.profile == name for entry in cases) for name in profiles)
    panels = figure.subplots(2 * len(profiles), columns, sharex=True, squeeze=False)
    for row, name in enumerate(profiles):
        for column, entry in enumerate(entry for entry in cases if entry.case.profile == name):
            _loads(panels[2 * row, column], entry)
            _pressures(panels[2 * row + 1, column], entry)
        panels[2 * row, 0].set_ylabel("load per\nlength, N/mm")
        panels[2 * row + 1, 0].set_ylabel("pressure in the\nmiddle, GPa")
    for panel in panels[-1]:
        panel.set_xlabel("place along the roller, mm")
    handles, labels = panels[0, 0].get_legend_handles_labels()
    figure.legend(handles, labels, ncols=4, fontsize=9, frameon=False, loc="outside lower center")
    write_heading(
        figure,
        f"{reference.bearing}: a roller on its inner raceway, dry; finite elements with "
        f"{max(reference.unknowns.values())} unknowns",
        10.5,
    )
    return figure


def _loads(panel: Axes, entry: LengthComparison) -> None:
    """Load per length by all ways."""
    case = entry.case
    panel.plot(1e3 * case.places, 1e-3 * case.load_per_length, "o", ms=3.0, color="0.35", label="finite elements")
    panel.plot(1e3 * case.places, 1e-3 * entry.load_per_length, color=COLOURS[0], lw=1.3, label="in three dimensions")
    for slices, colour, dashes, label in (
        (entry.coupled, COLOURS[2], "-", "coupled slices"),
        (entry.alone, COLOURS[1], "--", "slices on their own"),
    ):
        edges = np.linspace(case.places[0], case.places[-1], slices.places.size + 1)
        panel.stairs(1e-3 * slices.load_per_length, 1e3 * edges, baseline=None, color=colour, ls=dashes, label=label)
    tilted = f", {case.moment:.3g} N m" if case.moment else ""
    panel.set_title(f"{case.profile}, {written(case.load)} N{tilted}", fontsize=9.5)
    _quiet(panel)


def _pressures(panel: Axes, entry: LengthComparison) -> None:
    """Pressures by finite elements and in three dimensions."""
    case = entry.case
    panel.plot(1e3 * case.places, 1e-9 * case.peak_pressure, "o", ms=3.0, color="0.35")
    panel.plot(1e3 * case.places, 1e-9 * entry.peak_pressure, color=COLOURS[0], lw=1.3)
    _quiet(panel)


def _quiet(panel: Axes) -> None:
    """Axes from zero, with a faint grid."""
    panel.set_ylim(0.0, 1.06 * panel.get_ylim()[1])
    panel.grid(color="0.88", lw=0.5)
    panel.set_axisbelow(True)
    panel.tick_params(labelsize=8.5)
