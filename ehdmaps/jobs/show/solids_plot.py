"""Figures of the finite elements of a bearing: meshes, displacement, laws over load; pressure over the length."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ehdmaps.figures import COLOURS, typeset, write_heading
from ehdmaps.outputs import write_figure
from ehdmaps.physics.approach import STRUCTURAL_LAWS
from ehdmaps.physics.bearing import BearingGeometry, with_law
from ehdmaps.physics.contact import LineContact
from ehdmaps.solids.mesh_plane import PlaneMesh
from ehdmaps.solids.plane_bearing import contact_meshes
from ehdmaps.solids.sections import Sections
from ehdmaps.solids.three_d_compare import LengthComparison
from ehdmaps.solids.three_d_reference import LengthReference
from ehdmaps.units import COMPLIANCE, LOAD, written

SHOWN_GRADING = 0.3
"""Grading of the meshes that are drawn: those that are solved are too fine to be seen."""

_FONT: Any = {"font.size": 8.5, "axes.linewidth": 0.6, "xtick.major.width": 0.6, "ytick.major.width": 0.6}
_STYLES = {
    "fe": ("k", "-"),
    "iso16281": ("#1b6ca8", "-"),
    "palmgren": ("#1b6ca8", "--"),
    "half_space": ("#c8102e", "-"),
}


def plot_solids(contacts: Sequence[LineContact], bearing: BearingGeometry, sections: Sections, output: Path) -> None:
    """Draw the page and write it.

    Parameters
    ----------
    contacts : sequence of LineContact
        Contacts that know their approach by finite elements.
    bearing : BearingGeometry
        Bearing of the contacts.
    sections : Sections
        Bodies of the bearing.
    output : Path
        The picture; its ending decides the format (png, pdf, svg).

    Raises
    ------
    DependencyError
        If gmsh is missing.
    InputError
        If it cannot be written, or the ending is not known.
    """
    import matplotlib as mpl

    with mpl.rc_context(_FONT):
        write_figure(solids_figure(contacts, bearing, sections), output)


def solids_figure(contacts: Sequence[LineContact], bearing: BearingGeometry, sections: Sections) -> Figure:
    """Draw the page: a row a contact.

    Parameters
    ----------
    contacts, bearing, sections
        The same as for `plot_solids`.
    """
    figure = Figure(figsize=(11.0, 3.6 * len(contacts)), layout="constrained")
    axes = figure.subplots(len(contacts), 3, squeeze=False)
    for row, contact in zip(axes, contacts, strict=True):
        roller, ring = contact_meshes(sections, contact.name, SHOWN_GRADING)
        _meshes(row[0], roller, ring)
        row[0].set_title(f"{contact.name} contact, meshes (coarser than solved)", fontsize=8.5)
        _laws(row[1], row[2], contact, bearing)
    estimated = f"\n{bearing.estimated}" if bearing.estimated else ""
    write_heading(figure, f"{bearing.title}: solids by plane finite elements{estimated}", 10)
    return figure


def _meshes(axes: Axes, roller: PlaneMesh, ring: PlaneMesh) -> None:
    """Draw quarter of the roller and half of the ring where they stand, in mm."""
    inside = ring.far < ring.surface
    sign, centre = (-1.0, ring.surface + roller.surface) if inside else (1.0, ring.surface - roller.surface)
    for mesh, factor, shift in ((roller, sign, centre), (ring, 1.0, 0.0)):
        x, y = mesh.positions.T
        axes.triplot(1e3 * x, 1e3 * (factor * y + shift), mesh.elements[:, :3], lw=0.3, color="0.35")
    axes.set_aspect("equal")
    unit = 1e3 * roller.surface
    axes.set_xlim(-0.05 * unit, 1.8 * unit)
    axes.set_ylim(*sorted((1e3 * centre - 0.1 * sign * unit, 1e3 * ring.surface + 1.6 * sign * unit)))
    axes.set_xlabel("mm")


def _laws(over_load: Axes, ratio: Axes, contact: LineContact, bearing: BearingGeometry) -> None:
    """Draw the approach over load by all laws, and their stiffness over that of fe."""
    loads = np.geomspace(1e3, 1e6, 121)
    reference = contact.structural_compliance(loads)
    for law in STRUCTURAL_LAWS:
        line = with_law(contact, law, bearing)
        colour, style = _STYLES[law]
        shown = LOAD.factor * loads
        secant = COMPLIANCE.factor * np.asarray(line.structural_approach(loads)) / loads
        over_load.semilogx(shown, secant, style, color=colour, lw=1.0, label=law)
        ratio.semilogx(shown, reference / line.structural_compliance(loads), style, color=colour, lw=1.0, label=law)
    over_load.set_xlabel(f"load, {LOAD.unit}")
    over_load.set_ylabel(typeset(f"approach over load, {COMPLIANCE.unit}"))
    ratio.set_xlabel(f"load, {LOAD.unit}")
    ratio.set_ylabel("stiffness over that of fe")
    over_load.legend(fontsize=7)


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
