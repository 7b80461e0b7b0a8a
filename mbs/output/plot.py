"""Figure of an equilibrium."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from mbs.assembly import Model
from mbs.output.page import COLOURS as _COLOURS
from mbs.output.page import grid as _grid
from mbs.output.page import page as _page
from mbs.statics import Equilibrium

_RPM = 30.0 / np.pi


def statics_figure(model: Model, balance: Equilibrium) -> Figure:
    """Load of each roller around each bearing."""
    figure, axes = _page(model, f"{model.scene.speed * _RPM:.4g} rpm", len(model.bearings))
    for panel, bearing in zip(axes, model.bearings, strict=False):
        motion = model.system.relative(bearing.inner, bearing.outer) @ balance.displacement
        rollers = bearing.rollers(motion, balance.operation)
        panel.bar(np.degrees(rollers.angle), rollers.load, width=0.6 * 360.0 / rollers.angle.size, color=_COLOURS[0])
        panel.set_title(bearing.name, fontsize=9)
        panel.set_xlim(-200, 200)
        panel.set_xticks(np.arange(-180, 181, 90))
        _grid(panel)
    for panel in axes[len(model.bearings) :]:
        panel.set_visible(False)
    figure.supxlabel("angle of the roller from y towards z, degrees", fontsize=10)
    figure.supylabel("load of the roller, N", fontsize=10)
    return figure
