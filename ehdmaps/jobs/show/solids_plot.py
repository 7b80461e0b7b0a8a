"""Figures of the finite elements of a bearing: meshes, displacement, laws over load."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ehdmaps.figures import typeset, write_heading
from ehdmaps.outputs import write_figure
from ehdmaps.physics.approach import STRUCTURAL_LAWS
from ehdmaps.physics.bearing import BearingGeometry, with_law
from ehdmaps.physics.contact import LineContact
from ehdmaps.solids.mesh_plane import PlaneMesh
from ehdmaps.solids.plane_bearing import contact_meshes
from ehdmaps.solids.sections import Sections
from ehdmaps.units import COMPLIANCE, LOAD

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
