"""Bearings in words: temperatures, clearances, heat, what rolling costs, and the units of their matrices."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

from ehdmaps.physics.designations.clearance import STATED, clearance_range
from ehdmaps.physics.oil_supply import OilSupply
from ehdmaps.units import TEMPERATURE
from mbs.bearings.contact_report import TRACTION, RollingLoss
from mbs.bearings.thermal import BearingHeat, BearingState
from mbs.scene.fields import FORCE, MICROMETRE

if TYPE_CHECKING:
    from mbs.life import ReferenceLife
    from mbs.model.elements import Operation
    from mbs.scene.scene import Scene

FLOODED_NOTE = (
    "note: all contacts are taken as flooded, so that idle rollers drag too; --supply gives them less oil, such as "
    "--supply 'oil bath'"
)
"""What is said beside the rolling torque of flooded bearings."""

STIFFNESSES = "N/um, N/urad; N m/um, N m/urad"
"""Units of a stiffness matrix on forces and moments: one factor from SI, that of `SPRING`."""

DAMPINGS = "N s/mm, N s/mrad; N m s/mm, N m s/mrad"
"""Those of a damping matrix, with the factor of `DAMPER`."""

HIGHEST_LOAD = "highest load of a rolling element on the inner raceway"
LOADED = "rolling elements that carry more than 1 % of the highest load"
"""Numbers that results of machines and of one bearing have in common, in words."""


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


def beside_class(geometry: object) -> str:
    """The class of clearance of a designation, in brackets, where a clearance that is stated counts instead.

    Parameters
    ----------
    geometry : object
        Geometry of a bearing.
    """
    reach = clearance_range(geometry)
    return f" ({reach.words})" if reach is not None and reach.taken == STATED else ""


def class_lines(scene: Scene) -> list[str]:
    """A line for each kind of bearing whose clearance is stated beside a class of its designation.

    Parameters
    ----------
    scene : Scene
        Machine, as it was read.
    """
    kinds: dict[tuple[str, str], list[str]] = {}
    for bearing, (name, reach) in scene.clearance_ranges.items():
        if reach.taken == STATED:
            kinds.setdefault((name, reach.words), []).append(bearing)
    return [f"  {name} ({', '.join(bearings)}): {words}" for (name, words), bearings in kinds.items()]


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


def loss_words(loss: RollingLoss, elements: str = "rollers") -> str:
    """Rolling loss of a bearing with its rolling elements, in words."""
    if math.isnan(loss.total):
        return "rolling torque: none, no map with rolling forces"
    words = f"rolling torque {1e3 * loss.torque:.4g} N mm, power {loss.total:.4g} W"
    if not loss.total:
        return words
    words = f"{words}, {loss.idle:.0%} of it in idle {elements}"
    if elements != "rollers":
        more = f"{1e3 * loss.sliding_torque:.3g} N mm more by drilling and ribs at a traction of {TRACTION:g}"
        return f"{words} (films only: no cage, seals, churning); {more}"
    if loss.slowest == 1.0:
        return f"{words} (films only: no flanges, cage, seals, churning)"
    return f"{words}, the slowest at {loss.slowest:.2g} of rolling (films and pockets: no flanges, seals, churning)"


def life_lines(bearing: Any, geometry: Any, loads: Any, operation: Operation) -> list[str]:
    """A line on the life of a bearing of a machine that turns and carries; none of a kind whose life no rule tells.

    Parameters
    ----------
    bearing : BearingElement or LocatingElement
        Element of the bearing.
    geometry : BearingGeometry, BallGeometry or TaperedGeometry
        Geometry of the bearing.
    loads : RollerLoads, BallLoads or TaperedLoads
        State of its rolling elements.
    operation : Operation
        Speed of the system.
    """
    inner, outer = bearing.inner_spin, bearing.outer_spin
    if inner == outer or operation.speed == 0.0 or not hasattr(loads, "life"):
        return []
    found: ReferenceLife = loads.life(geometry, abs(inner) >= abs(outer))
    if not math.isfinite(found.life):
        return []
    return [
        f"  equivalent load {FORCE.text(found.load)}, L10r {found.life:.4g} million turns (ISO/TS 16281, C of ISO 281 "
        "by inner geometry)"
    ]


def largest_torque(losses: Iterable[RollingLoss]) -> float:
    """Return the largest rolling torque that is known [N m]; NaN where none is."""
    return max((loss.torque for loss in losses if not math.isnan(loss.torque)), default=math.nan)


def flooded_note(torque: float, supplies: Iterable[OilSupply]) -> list[str]:
    """A line on the rolling torque of bearings that are flooded all round, and on what to do; else none.

    Parameters
    ----------
    torque : float
        The largest rolling torque that is shown [N m]; NaN where none is known.
    supplies : iterable of OilSupply
        Oil supplies of the bearings.
    """
    if not torque > 0.0 or not any(supply.flooded for supply in supplies):
        return []
    return [FLOODED_NOTE]
