"""Figure of critical speeds: damped modes with the lines of orders, and the orbits or sensors over speed."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from ehdmaps.arrays import FloatArray
from ehdmaps.figures import COLOURS
from mbs.linearised.critical import CriticalSpeed, OrderResponse
from mbs.linearised.sweep_result import Sweep
from mbs.output.critical_data import orbits
from mbs.output.page import grid, headed
from mbs.scene.assembly import Model

_RPM = 30.0 / np.pi
_LEAST = 1e-15
"""Radius below which an orbit is drawn as none [m]."""

_PART = 1e-5
"""Least radius that is drawn, as a part of the largest one: the response at rest is none."""

_ROOM = 1.6
"""Height of the frequencies over the highest line of an order."""


@dataclass(frozen=True, eq=False)
class CriticalCurves:
    """What is drawn of a law.

    Attributes
    ----------
    label : str
        What the law is called.
    model : Model
        Scene with the law.
    sweep : Sweep
        Modes over speed.
    found : sequence of CriticalSpeed
        Critical speeds, which are marked.
    speeds : array, shape (speeds,)
        Speeds of the responses [rad/s].
    responses : sequence of OrderResponse
        Response to the loads of each order; a panel each.
    orders : sequence of float
        Orders whose lines are drawn.
    """

    label: str
    model: Model
    sweep: Sweep
    found: Sequence[CriticalSpeed]
    speeds: FloatArray
    responses: Sequence[OrderResponse]
    orders: Sequence[float]


def critical_figure(laws: Sequence[CriticalCurves]) -> Figure:
    """Modes over speed with critical speeds, and the response below them.

    Parameters
    ----------
    laws : sequence of CriticalCurves
        One law, whose places have a colour each; or several of one scene, which have a colour each, and the places
        their kinds of lines.
    """
    first, several = laws[0], len(laws) > 1
    rows = 1 + len(first.responses)
    figure = headed(first.model, "critical speeds", (9.0, 3.0 + 2.6 * rows), "laws side by side" if several else None)
    panels = figure.subplots(rows, 1, sharex=True, squeeze=False)[:, 0]
    turns = first.sweep.speeds * _RPM
    for index, law in enumerate(laws):
        _modes(panels[0], law, COLOURS[index % len(COLOURS)], COLOURS[index if several else 1])
        for panel, response in zip(panels[1:], law.responses, strict=True):
            _orbits(panel, law, response, COLOURS[index % len(COLOURS)] if several else None)
    for panel in panels[1:]:
        # After all laws: a limit that is set ends the scaling of the other one.
        panel.set_ylim(bottom=max(_PART * panel.dataLim.ymax, _LEAST * 1e6))
    _lines(panels[0], first)
    if several:
        names = [Line2D([], [], color=COLOURS[k], lw=1.2, label=law.label) for k, law in enumerate(laws)]
        panels[0].legend(handles=names, fontsize=7, loc="upper left")
    if first.responses:
        panels[1].legend(handles=_places(first, several), fontsize=7, frameon=False)
    for panel in panels:
        grid(panel)
    panels[-1].set(xlabel="speed of the system, rpm", xlim=(turns[0], turns[-1]))
    return figure


def _modes(panel: Axes, law: CriticalCurves, colour: str, marked: str) -> None:
    """Damped modes over speed, and the critical speeds."""
    frequencies = law.sweep.damped.eigenvalues.imag / (2.0 * np.pi)
    panel.plot(law.sweep.speeds * _RPM, frequencies, color=colour, lw=1.0)
    for entry in law.found:
        marker = "o" if math.isnan(entry.whirl) else "^" if entry.whirl > 0.0 else "v"
        panel.plot(entry.speed * _RPM, entry.eigenvalue.imag / (2.0 * np.pi), marker, color=marked, ms=6)


def _lines(panel: Axes, law: CriticalCurves) -> None:
    """The lines of the orders, and what the panel shows."""
    speeds = law.sweep.speeds
    for order in law.orders:
        frequencies = order * speeds / (2.0 * np.pi)
        panel.plot(speeds * _RPM, frequencies, color="0.5", lw=0.9, ls="--")
        panel.annotate(f"order {order:.4g}", (speeds[-1] * _RPM, frequencies[-1]), fontsize=7, ha="right", va="bottom")
    panel.set(
        ylabel="frequency of damped modes, Hz",
        ylim=(0.0, _ROOM * max(law.orders) * float(speeds[-1]) / (2.0 * np.pi)),
    )
    panel.set_title(
        "triangles: critical speeds, upwards with the spin, downwards against it; circles: along or about the axis",
        fontsize=8,
        loc="left",
    )


def _orbits(panel: Axes, law: CriticalCurves, response: OrderResponse, colour: str | None) -> None:
    """Largest radius of the orbit of each place over speed; in a colour each if none is given."""
    places, axes = orbits(law.model.system, response)
    for index in range(len(places)):
        style = {"color": COLOURS[index % len(COLOURS)]} if colour is None else {"color": colour, "ls": _style(index)}
        panel.semilogy(law.speeds * _RPM, np.maximum(axes[:, index, 0], _LEAST) * 1e6, lw=1.1, **style)
    panel.set_ylabel(f"orbit by order {response.order:.4g},\nlargest radius, um")


def _places(law: CriticalCurves, several: bool) -> list[Line2D]:
    """Entries of a legend for the places."""
    places, _ = orbits(law.model.system, law.responses[0])
    return [
        Line2D([], [], lw=1.1, label=place, color="0.2", ls=_style(index))
        if several
        else Line2D([], [], lw=1.1, label=place, color=COLOURS[index % len(COLOURS)])
        for index, place in enumerate(places)
    ]


def _style(index: int) -> str:
    """Kind of line of a place."""
    return ("-", "--", ":", "-.")[index % 4]
