"""A line on the heat that films of the film table leave out, for commands without `--auto`: closed forms alone."""

from __future__ import annotations

import math

from ehdmaps.errors import AnalysisError, InputError
from ehdmaps.units import SPEED
from mbs.planning.criteria import heat_effect
from mbs.planning.plan import plan
from mbs.planning.verdicts import TOLERANCE, up_to, visited
from mbs.scene.scene import Scene


def left_out_line(scene: Scene) -> str:
    """The line; empty where heat does not matter, or nothing can be said.

    A limiting shear stress is weighed by solutions, which `--auto` makes and this does not.

    Parameters
    ----------
    scene : Scene
        The scene as the analysis visits it, with bearings and a lubricant.
    """
    oil = scene.lubricant
    if oil is None:
        return ""
    try:
        needed = plan(scene).needed
    except (AnalysisError, InputError):  # the analysis itself tells what is wrong
        return ""
    ranges = [visited(entry, oil, TOLERANCE) for entry in needed]
    sizes = [there.carrying(lambda state: heat_effect(state, oil)) for there in ranges]
    size, state = max(sizes, key=lambda entry: -math.inf if math.isnan(entry[0]) else entry[0])
    if not size > TOLERANCE:
        return ""
    change = "by more than the formula covers" if size >= 1.0 else f"by {up_to(size)}"
    return (
        f"note: these films have no heat, which would lower c of a contact {change} at {SPEED.text(state.speed)}, and "
        "no limiting shear stress; --auto weighs both"
    )
