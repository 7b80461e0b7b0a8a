"""Temperatures, clearances and heat of bearings in words."""

from __future__ import annotations

import math
from collections.abc import Iterable

from ehdmaps.units import TEMPERATURE
from mbs.bearings.state import BearingHeat, BearingState
from mbs.scene.fields import MICROMETRE


def state_lines(states: Iterable[BearingState]) -> list[str]:
    """Lines on each bearing in operation; none for a model whose bearings are as the scene states them.

    Parameters
    ----------
    states : iterable of BearingState
        States of a model in operation.
    """
    lines = []
    for state in states:
        lines.append(f"  {state.name}: {state_words(state)}")
        if state.heat is not None:
            lines.append(f"    {_heat(state.heat)}")
    return lines


def state_words(state: BearingState) -> str:
    """Temperatures and clearance of a bearing in operation.

    Parameters
    ----------
    state : BearingState
        The bearing.
    """
    clearance = state.clearance
    oil = "" if math.isnan(state.oil) else f", oil {TEMPERATURE.text(state.oil)}"
    changes = [
        f"{words} {1e6 * value:+.3g} um"
        for words, value in (("temperature", clearance.by_temperature), ("fits", clearance.by_fits))
        if value
    ]
    return (
        f"raceways {TEMPERATURE.value(state.inner):.4g} inner, {TEMPERATURE.text(state.outer)} outer{oil}; operating "
        f"clearance {MICROMETRE.text(clearance.operating)}"
        + (f" ({MICROMETRE.text(clearance.stated)} stated, {', '.join(changes)})" if changes else "")
    )


def _heat(heat: BearingHeat) -> str:
    """Friction, and where it goes."""
    added = f" ({heat.added:.4g} W of it added)" if heat.added else ""
    ways = [
        f"{value:.4g} W {where}"
        for where, value in (
            ("to the shaft", heat.to_shaft),
            ("to the housing", heat.to_housing),
            ("away with the oil", heat.to_oil),
        )
        if value
    ]
    return f"friction {heat.friction:.4g} W{added}; {', '.join(ways) or 'no heat flows'}; {heat.left:.1g} W left"
