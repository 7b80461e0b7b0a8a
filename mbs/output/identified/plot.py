"""Figure of an identification: what was measured beside the machine before and after, and the unknowns' bands."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.figure import Figure

from ehdmaps.figures import COLOURS, typeset
from ehdmaps.units import RPM
from mbs.identification.measured import MeasuredModes, MeasuredResponses
from mbs.linearised.linear import response_display
from mbs.output.page import grid, headed

if TYPE_CHECKING:
    from mbs.identification.search import Fit

MOST_ROWS = 8
"""Channels that are drawn."""


def identify_figure(fit: Fit) -> Figure:
    """A panel a channel, measured, before and after; modes of all speeds in one panel.

    Parameters
    ----------
    fit : Fit
        The best fit.
    """
    question = fit.question
    responses = [one for one in question.measured if isinstance(one, MeasuredResponses)]
    modes = [one for one in question.measured if isinstance(one, MeasuredModes)]
    rows = [(one, row) for one in responses for row in range(len(one.rows))][:MOST_ROWS]
    count = len(rows) + bool(modes)
    figure = headed(question.machine.model, "", (8.0, 1.6 + 2.1 * count), "identified")
    axes = figure.subplots(count, 1, squeeze=False)[:, 0]
    starts = [one.start for one in question.free]
    before = {id(one): question.look(starts, one) for one in question.measured}
    after = {id(one): question.look(fit.values, one) for one in question.measured}
    for panel, (one, row) in zip(axes, rows, strict=False):
        sensor, entry = one.rows[row]
        shown = response_display(sensor, entry)
        measured = np.abs(one.response[:, row])
        used = one.weights()[:, row] > 0.0
        panel.loglog(one.frequencies, shown.factor * measured, ".", ms=2.0, color="0.7")
        panel.loglog(one.frequencies[used], shown.factor * measured[used], ".", ms=2.5, color="0.35", label="measured")
        for words, own, style in (("scene", before, "--"), ("found", after, "-")):
            values = own[id(one)]
            if values is not None:
                colour = COLOURS[1] if style == "--" else COLOURS[0]
                size = shown.factor * np.exp(values[:, row].real)
                panel.loglog(one.frequencies, size, style, lw=1.0, color=colour, label=words)
        panel.set_ylabel(typeset(shown.unit))
        panel.set_title(one.channels[row], fontsize=8, loc="left")
        panel.legend(fontsize=7, frameon=False)
        grid(panel)
    if modes:
        panel = axes[-1]
        for n, own_modes in enumerate(modes):
            at = np.full(own_modes.frequency.size, RPM.value(own_modes.speed))
            panel.plot(at, own_modes.frequency, "o", ms=4.0, color="0.35", label="" if n else "measured")
            for words, own, mark, colour in (("scene", before, "x", COLOURS[1]), ("found", after, "+", COLOURS[0])):
                values = own[id(own_modes)]
                if values is not None:
                    panel.plot(at, np.exp(values[0].real), mark, color=colour, label="" if n else words)
        panel.set(xlabel=f"speed, {RPM.unit}", ylabel="frequency, Hz")
        panel.legend(fontsize=7, frameon=False)
        grid(panel)
    if rows:
        axes[len(rows) - 1].set_xlabel("frequency, Hz")
    return figure
