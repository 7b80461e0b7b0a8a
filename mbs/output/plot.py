"""Figure of an equilibrium."""

from __future__ import annotations

import math
import textwrap
from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure

from ehdmaps.figures import COLOURS, WARNING
from mbs.bearings.contact_report import BearingContacts
from mbs.model.equilibrium import Equilibrium
from mbs.output.page import grid, page
from mbs.scene.assembly import Model

_RPM = 30.0 / np.pi


def statics_figure(
    model: Model, balance: Equilibrium, contacts: Sequence[BearingContacts], warnings: Sequence[str] = ()
) -> Figure:
    """Load of each roller around each bearing, with its pressures and films, and what is to be warned of.

    Parameters
    ----------
    model : Model
        The system.
    balance : Equilibrium
        Equilibrium of the model.
    contacts : sequence of BearingContacts
        Pressures and films of each bearing.
    warnings : sequence of str
        What is to be warned of, written on the page.
    """
    figure, axes = page(model, f"{model.scene.speed * _RPM:.4g} rpm", len(model.bearings))
    for panel, bearing, state in zip(axes, model.bearings, contacts, strict=False):
        motion = model.system.relative(bearing.inner, bearing.outer) @ balance.displacement
        rollers = bearing.rollers(motion, balance.operation)
        panel.bar(np.degrees(rollers.angle), rollers.load, width=0.6 * 360.0 / rollers.angle.size, color=COLOURS[0])
        panel.set_title(f"{bearing.name}\n{_contact_words(state)}", fontsize=9)
        panel.set_xlim(-200, 200)
        panel.set_xticks(np.arange(-180, 181, 90))
        grid(panel)
    for panel in axes[len(model.bearings) :]:
        panel.set_visible(False)
    figure.supylabel("load of the roller, N", fontsize=10)
    words = "angle of the roller from y towards z, degrees"
    wrapped = [part for line in warnings for part in textwrap.wrap(f"warning: {line}", 110)]
    if wrapped:
        for panel in axes:
            panel.set_xlabel(words, fontsize=8)
        figure.supxlabel("\n".join(wrapped), fontsize=8, color=WARNING)
    else:
        figure.supxlabel(words, fontsize=10)
    return figure


def _contact_words(contacts: BearingContacts) -> str:
    """Largest pressure and smallest film of a bearing."""
    pressure = f"Hertz pressure up to {1e-9 * contacts.hertz_pressure.max():.3g} GPa"
    film = 1e6 * float(np.min(contacts.minimum_film))
    return pressure if math.isnan(film) else f"{pressure}, film down to {film:.3g} µm"
