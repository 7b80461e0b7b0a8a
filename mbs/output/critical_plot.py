"""Figure of critical speeds: damped modes with the lines of orders, and the orbits or sensors over speed."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure

from ehdmaps.arrays import FloatArray
from ehdmaps.figures import COLOURS
from mbs.linearised.critical import CriticalSpeed, OrderResponse
from mbs.linearised.sweep_result import Sweep
from mbs.output.critical_data import orbits
from mbs.output.page import grid, headed
from mbs.scene.assembly import Model

_RPM = 30.0 / np.pi
_ROOM = 1.6
"""Height of the frequencies over the highest line of an order."""


def critical_figure(
    model: Model,
    sweep: Sweep,
    found: Sequence[CriticalSpeed],
    speeds: FloatArray,
    responses: Sequence[OrderResponse],
    orders: Sequence[float],
) -> Figure:
    """Modes over speed with critical speeds, and the response below them.

    Parameters
    ----------
    model : Model
        Scene with its law.
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
    rows = 1 + len(responses)
    figure = headed(model, "critical speeds", (9.0, 3.0 + 2.6 * rows))
    panels = figure.subplots(rows, 1, sharex=True, squeeze=False)[:, 0]
    top, turns = panels[0], sweep.speeds * _RPM
    top.plot(turns, sweep.damped.eigenvalues.imag / (2.0 * np.pi), color=COLOURS[0], lw=1.0)
    for order in orders:
        top.plot(turns, order * sweep.speeds / (2.0 * np.pi), color="0.5", lw=0.9, ls="--")
        top.annotate(
            f"order {order:.4g}", (turns[-1], order * sweep.speeds[-1] / (2.0 * np.pi)), fontsize=7, ha="right"
        )
    for entry in found:
        ahead = entry.whirl > 0.0
        marker = "^" if ahead else "v"
        top.plot(entry.speed * _RPM, entry.eigenvalue.imag / (2.0 * np.pi), marker, color=COLOURS[1], ms=6)
    top.set(
        ylabel="frequency of damped modes, Hz",
        ylim=(0.0, _ROOM * max(orders) * float(sweep.speeds[-1]) / (2.0 * np.pi)),
    )
    top.set_title("triangles: critical speeds, upwards with the spin, downwards against it", fontsize=8, loc="left")
    for panel, response in zip(panels[1:], responses, strict=True):
        places, axes = orbits(model.system, response)
        for index, place in enumerate(places):
            colour = COLOURS[index % len(COLOURS)]
            panel.semilogy(speeds * _RPM, np.maximum(axes[:, index, 0], 1e-15) * 1e6, color=colour, lw=1.1, label=place)
        panel.set_ylabel(f"orbit by order {response.order:.4g},\nlargest radius, um")
        panel.legend(fontsize=7, frameon=False)
        low = np.max(axes[1:, :, 0]) * 1e-5 if axes.shape[0] > 1 else 1e-12
        panel.set_ylim(bottom=max(low, 1e-15) * 1e6)
    for panel in panels:
        grid(panel)
    panels[-1].set(xlabel="speed of the system, rpm", xlim=(turns[0], turns[-1]))
    return figure
