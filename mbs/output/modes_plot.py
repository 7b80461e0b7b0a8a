"""Figure of the modes at one speed: where their strain energy is."""

from __future__ import annotations

import itertools
import math

import numpy as np
from matplotlib.figure import Figure

from ehdmaps.arrays import IntArray
from mbs.linearised.modes import Modes
from mbs.output.page import BAND_WORDS, ESTIMATED, headed, shade, shade_handle
from mbs.scene.assembly import Model

_RPM = 30.0 / np.pi
_MOST_LEVEL_LABELS = 12
_MOST_LABELS = 60
"""That stand upright beside each other."""

_FILLS = ("#4477aa", "#ee6677", "#228833", "#ccbb44", "#66ccee", "#aa3377", "#999999")
"""Apart also for the colour-blind; with each hatch in turn for more parts than these."""

_HATCHES = ("", "////", "....", "xxxx") * 20
_TOP = 104.0
_ROUND_OFF = 1e-12


def modes_figure(model: Model, found: Modes, shown: IntArray, limit: float = math.inf, words: str = "") -> Figure:
    """Strain-energy shares of modes, with their numbers, frequencies and damping ratios.

    Parameters
    ----------
    model : Model
        Whose modes they are.
    found : Modes
        All of them.
    shown : array of int, shape (k,)
        Those to draw, in this order.
    limit : float
        Frequency from which on the films are notably wrong [Hz]: modes from there on are shaded.
    words : str
        What is not drawn, below the axis.
    """
    figure = headed(model, f"{model.scene.speed * _RPM:.4g} rpm")
    panel = figure.subplots()
    places = np.arange(shown.size)
    bottom = np.zeros(places.size)
    styles = itertools.product(_HATCHES, _FILLS)
    for part, share, (hatch, colour) in zip(found.parts, 100.0 * found.shares[:, shown], styles, strict=False):
        panel.bar(places, share, bottom=bottom, label=part, color=colour, hatch=hatch, edgecolor="w", lw=0.0)
        bottom += share
    level = places.size <= _MOST_LEVEL_LABELS
    labels = [_label(found, int(mode), level) for mode in shown]
    every = math.ceil(max(places.size, 1) / _MOST_LABELS)
    panel.set_xticks(places[::every], labels[::every], fontsize=7 if level else 6.5, rotation=0 if level else 90)
    panel.set_xlim(-0.8, max(places.size, 1) - 0.2)
    panel.set_ylim(0.0, _TOP)
    panel.set_yticks(np.arange(0, 101, 20))
    quick = places[found.frequency[shown] > limit]
    if quick.size:
        # A strip above the bars, which keep their colours.
        shade(panel, quick[0] - 0.5, quick[-1] + 0.5, bottom=100.0 / _TOP)
    panel.set_xlabel(
        "mode: frequency |eigenvalue|/(2π), damping ratio ζ" + _bands(found, level) + (f"\n{words}" if words else "")
    )
    panel.set_ylabel("part of the strain energy, %")
    handles = panel.get_legend_handles_labels()[0] + ([shade_handle(_quick(limit))] if quick.size else [])
    panel.legend(handles=handles, fontsize=7, loc="upper left", bbox_to_anchor=(1.0, 1.0), frameon=False)
    return figure


def _label(found: Modes, mode: int, level: bool) -> str:
    """Number, frequency and damping ratio of a mode."""
    ratio = float(found.damping_ratio[mode])
    parts = [f"{mode + 1}:", f"{found.frequency[mode]:.5g} Hz", f"ζ {ratio if abs(ratio) > _ROUND_OFF else 0.0:.2g}"]
    if level and found.bands is not None:
        parts[1:] = [
            *(parts[1], f"± {found.bands.frequency[mode]:.1g} Hz"),
            *(parts[2], f"± {found.bands.damping_ratio[mode]:.1g}"),
        ]
    return "\n".join(parts) if level else " ".join(parts)


def _bands(found: Modes, level: bool) -> str:
    """What the label of the axis adds on bands."""
    return f", ±: {BAND_WORDS}" if level and found.bands is not None else ""


def _quick(limit: float) -> str:
    """What the shade says."""
    return f"{ESTIMATED.replace(' of the films ', chr(10) + 'of the films ')}\n(from {limit:.4g} Hz on)"
