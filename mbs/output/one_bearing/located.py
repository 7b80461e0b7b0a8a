"""Lines on the bearings of a machine that carry axial load: forces, loads, pressures, stiffness and damping."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import cast

from mbs.bearings.balls.ball_bearing import BallForce
from mbs.bearings.locating.locating_element import LocatingElement
from mbs.bearings.locating.locating_force import LocatingForce, Settled
from mbs.bearings.tapered.tapered_bearing import TaperedForce
from mbs.model.equilibrium import Equilibrium
from mbs.output.one_bearing.balls import ball_words
from mbs.output.one_bearing.ribs import roller_words
from mbs.output.one_bearing.table import matrix_line
from mbs.output.state_text import life_lines
from mbs.scene.assembly import Model

_WORDS: dict[type[LocatingForce], Callable[[Settled], tuple[str, list[str]]]] = {
    BallForce: ball_words,
    TaperedForce: roller_words,
}
"""By class of the force: what is said behind the force on the inner ring, and in further lines."""


def located_lines(model: Model, balance: Equilibrium) -> list[str]:
    """Lines on each bearing that carries axial load.

    Parameters
    ----------
    model : Model
        Scene with its law.
    balance : Equilibrium
        Equilibrium of its system.
    """
    lines = []
    for place, element, at in located(model, balance):
        force, (words, more) = balance.forces[place], _WORDS[type(at.force)](at)
        lines += [
            f"{element.name}: {force[0]:.5g} N along x, {math.hypot(force[1], force[2]):.5g} N across it on the inner "
            f"ring; {words}",
            *more,
            *life_lines(element, at.force.geometry, at.loads, balance.operation),
            matrix_line(balance, place),
        ]
    return lines


def located(model: Model, balance: Equilibrium) -> list[tuple[int, LocatingElement, Settled]]:
    """Bearings that carry axial load, each with its place among the elements, at the equilibrium.

    Parameters
    ----------
    model : Model
        Scene with its law.
    balance : Equilibrium
        Equilibrium of its system.
    """
    found = []
    for place in model.ring_places[len(model.bearings) :]:
        connected = model.system.elements[place]
        element = cast("LocatingElement", connected.element)
        at = element.settled(connected.transform @ balance.displacement, balance.operation)
        found.append((place, element, at))
    return found
