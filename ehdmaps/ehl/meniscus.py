"""Starved contact: the place of the inlet meniscus at which the contact takes what an oil layer brings.

Before the contact lies a layer of oil, of both surfaces together, that moves with them. A line has no side flow: in the
steady state all of the layer goes through the contact. Where that is less than the flooded contact would take, the gap
fills up to a meniscus only, where the film begins with P = 0; its distance is an unknown, and the flow m = h_oil the
equation for it. The grid begins at the meniscus.

The distance is found on the coarse grid, from the flooded contact inwards, and corrected on the fine one. There the
number of cells stands still, so that the flow is a smooth function of the length.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import NamedTuple

from ehdmaps.ehl.grid import lay_out, zone_width
from ehdmaps.ehl.group_solution import GroupSolution, assembled
from ehdmaps.ehl.limits import Resolution
from ehdmaps.ehl.linearisation import Linearisation
from ehdmaps.ehl.newton import STAGNATED
from ehdmaps.ehl.profile import Profile, moved, starved_start
from ehdmaps.ehl.ways import converged, expected_film, on_coarse_grid, on_fine_grid

FLOW_TOLERANCE = 1e-8
"""Relative difference of flow and layer that is left."""

NEAR = 0.05
"""Relative difference of flow and layer up to which the meniscus is sought with grids that follow the spike."""

LAYER_STEP = 0.1
"""Ratio of the layers, one after another, on the way from the flooded contact to a thin layer."""

LARGEST_FALL = 0.7
"""Fall of ln m over one step of the meniscus towards the contact."""

FIRST_MOVE = 1e-3
"""First move of the meniscus about a known solution, in widths of the inlet zone."""

LARGEST_MOVE = 0.2
"""Largest move of the meniscus about a known solution, relative to its distance from the inlet's edge and the exit."""

MOST_PLACES = 60
"""Places of the meniscus that are tried on one grid."""


@dataclass(frozen=True)
class StarvedGroups:
    """Solution of a starved contact, in units of the groups.

    Attributes
    ----------
    solution : GroupSolution
        Film, and response with the meniscus held. Outcome other than converged where no place was found.
    meniscus : float
        Place of the meniscus [b]: negative before the contact centre.
    supplied_compliance : float
        Film compliance with the meniscus following, see `Linearisation.supplied_compliance`.
    """

    solution: GroupSolution
    meniscus: float = math.nan
    supplied_compliance: float = math.nan


class _Place(NamedTuple):
    """A solution at one place of the meniscus: its scaled distance, ln(flow/layer) there, and the solution."""

    at: float
    excess: float
    profile: Profile


def starved_groups(M: float, L: float, resolution: Resolution, layer: float, flooded: GroupSolution) -> StarvedGroups:
    """Film behind an oil layer that brings less than a flooded contact takes.

    Parameters
    ----------
    M, L : float
        Moes' load and lubricant parameters of the point.
    resolution : Resolution
        Accuracy and cost.
    layer : float
        Oil layer before the contact, of both surfaces together [b^2/R], > 0 and below the flow of `flooded`.
    flooded : GroupSolution
        Converged solution of the flooded contact.
    """
    start = flooded.rough
    assert start is not None and 0.0 < layer < flooded.mass_flow
    ratio = layer / flooded.mass_flow
    coarse, steps = _coarse(M, L, resolution, ratio, start)
    steps += flooded.steps
    fine: Profile | None = None
    if coarse is not None:
        fine, more, _ = on_fine_grid(coarse, resolution.tolerance)
        steps += more
    if fine is not None:
        fine, more = _corrected(fine, layer, resolution.tolerance)
        steps += more
    if coarse is None or fine is None:
        return StarvedGroups(GroupSolution(outcome=STAGNATED, profile=None, steps=steps))
    solution = assembled(M, L, fine, coarse, resolution, steps)
    if not isinstance(solution.linear, Linearisation):
        return StarvedGroups(solution)
    return StarvedGroups(solution, float(fine.position[0]), solution.linear.supplied_compliance())


def _coarse(M: float, L: float, resolution: Resolution, ratio: float, flooded: Profile) -> tuple[Profile | None, int]:
    """Coarse solution with a part of the flow of the flooded one, by way of larger parts; Newton steps.

    The same part, and not the same flow: the coarse grid may have less flow even where it is flooded.
    """
    film, total = expected_film(M, L), 0
    rungs = math.ceil(math.log(ratio) / math.log(LAYER_STEP))
    near: Profile | None = flooded
    for k in range(1, rungs + 1):
        assert near is not None
        part = ratio ** (k / rungs)
        search = _Search(resolution, part * film, part * flooded.mass_flow)
        # far away 1 - r falls with the square of the distance
        far = math.sqrt(2.0 * film) * math.sqrt(1.5 / (1.0 - part)) if k == 1 else math.inf
        near = search.run(near, far)
        total += search.steps
        if near is None:
            return None, total
    assert near is not None
    profile, steps = _corrected(near, ratio * flooded.mass_flow, resolution.tolerance)
    return profile, total + steps


class _Search:
    """Search for the meniscus on coarse grids laid for one film.

    Parameters
    ----------
    resolution : Resolution
        Accuracy and cost.
    film : float
        Film about which the grid is laid [b^2/R].
    layer : float
        Flow that is wanted [b^2/R].
    """

    def __init__(self, resolution: Resolution, film: float, layer: float) -> None:
        self.resolution, self.film, self.layer = resolution, film, layer
        self.edge, self.zone = lay_out(film, resolution.inlet, resolution.shape).inlet_edge, zone_width(film)
        self.steps = 0
        self.known: list[_Place] = []

    def run(self, start: Profile, guess: float) -> Profile | None:
        """Steps towards the contact until the flow is below the layer, then false position.

        Parameters
        ----------
        start : Profile
            Solution with more flow.
        guess : float
            First distance of the meniscus from the exit [b]; beyond that of `start` for a step from there.
        """
        over = _Place(self._scaled(start.layout.length), math.log(start.mass_flow / self.layer), start)
        under: _Place | None = None
        nearest = self._scaled(0.0)
        self.known = [over]
        at = min(self._scaled(guess), over.at) if guess < start.layout.length else over.at - 1.0
        at = max(at, 0.5 * (over.at + nearest))
        for _ in range(MOST_PLACES):
            place = self._solved(at)
            if place is None:  # too far from what is known
                at = 0.5 * (at + self._closest(at).at)
                continue
            self.known.append(place)
            if abs(place.excess) < NEAR:
                return place.profile
            if place.excess > 0.0:
                over = place
            else:
                under = place
            if under is None:
                at = max(over.at - self._step_inwards(over), 0.5 * (over.at + nearest))
            else:
                share = over.excess / (over.excess - under.excess)
                at = over.at + min(max(share, 0.1), 0.9) * (under.at - over.at)
        return None

    def _scaled(self, length: float) -> float:
        """Length of the film in a measure that is even near the inlet's edge and logarithmic far from it."""
        return math.asinh((length + self.edge) / self.zone)

    def _closest(self, at: float) -> _Place:
        """The known place that is closest."""
        return min(self.known, key=lambda place: abs(place.at - at))

    def _solved(self, at: float) -> _Place | None:
        """Solution with the meniscus at a place, from the closest one; None where Newton finds none."""
        length = self.zone * math.sinh(at) - self.edge
        start = self._closest(at).profile
        profile, steps, _ = on_coarse_grid(start.problem, self.film, self.resolution, start, length)
        self.steps += steps
        return None if profile is None else _Place(at, math.log(profile.mass_flow / self.layer), profile)

    def _step_inwards(self, over: _Place) -> float:
        """Step by the slope of the flow outside, of bounded length and fall of the flow."""
        outside = [place for place in self.known if place.at > over.at and place.excess > over.excess]
        if not outside:
            return 1.0
        next_to = min(outside, key=lambda place: place.at)
        slope = (next_to.excess - over.excess) / (next_to.at - over.at)
        return min(1.0, (over.excess + 0.5 * NEAR) / slope, LARGEST_FALL / slope)


def _corrected(near: Profile, layer: float, tolerance: float) -> tuple[Profile | None, int]:
    """Solution with the flow of the layer, by moving the meniscus of one nearby with its grid's cells; Newton steps."""
    profile, total = near, 0
    zone = zone_width(near.layout.film)
    last: tuple[float, float] | None = None
    step = FIRST_MOVE * zone
    for _ in range(MOST_PLACES):
        length, excess = profile.layout.length, math.log(profile.mass_flow / layer)
        if abs(excess) < FLOW_TOLERANCE:
            return profile, total
        if last is not None and (excess - last[1]) * (length - last[0]) > 0.0:
            step = -excess * (length - last[0]) / (excess - last[1])
        else:
            step = -math.copysign(step, excess)
        longest = LARGEST_MOVE * min(math.hypot(length + near.layout.inlet_edge, zone), length)
        step = max(-longest, min(longest, step))
        last = length, excess
        layout = replace(profile.layout, length=length + step)
        grid = layout.grid(profile.cells)
        start = starved_start(profile, grid) if profile.spike is None else moved(profile, grid, by_index=True)
        trial, steps, _ = converged(profile.problem, layout, grid, start, profile.spike, tolerance)
        total += steps
        if trial is None:
            return None, total
        profile = trial
    return None, total
