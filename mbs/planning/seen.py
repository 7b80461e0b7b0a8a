"""Bearings whose films no map has, of balls, tapered or ribbed rollers: what they see, what the film table has there.

Their films are those of the film table of points, or of lines at the middle of a roller. They are asked the questions
of bearings with maps: loads, speeds and temperature (`mbs.planning.ranges`).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ehdmaps.errors import AnalysisError
from ehdmaps.units import LOAD, RPM, SPEED, Display
from mbs.bearings.locating.locating_element import LocatingElement
from mbs.planning.ranges import LIGHT, LIGHTEST, idle_problem
from mbs.scene.assembly import Model
from mbs.scene.fields import FORCE


@dataclass(frozen=True)
class Seen:
    """Operating ranges of the bearings of one geometry, of which no map is made.

    Attributes
    ----------
    geometry : BallGeometry or TaperedGeometry
        One of theirs.
    bearings : tuple of str
        Their names.
    load : (float, float)
        Lowest and highest load of a ball [N], or of a slice of a roller [N/m].
    entrainment_speed : (float, float)
        Lowest and highest [m/s].
    temperature : float
        Temperature of the raceways [K].
    static_load : float
        Largest load at rest, in the unit of `load`.
    of_points : bool
        Whether its contacts are points, else lines.
    """

    geometry: Any
    bearings: tuple[str, ...]
    load: tuple[float, float]
    entrainment_speed: tuple[float, float]
    temperature: float
    static_load: float
    of_points: bool

    @property
    def display(self) -> Display:
        """Unit in which its loads are told."""
        return FORCE if self.of_points else LOAD


def seen_ranges(
    bearings: Sequence[LocatingElement],
    static_loads: Sequence[float],
    speeds: tuple[float, float],
    temperature: float,
    margin: float,
) -> tuple[Seen, ...]:
    """Ranges of each geometry of which no map is made, in the order of the bearings.

    Parameters
    ----------
    bearings : sequence of LocatingElement
        Bearings of the system that have no maps.
    static_loads : sequence of float
        Largest load of each, from `mbs.planning.ranges.largest_loads`.
    speeds : (float, float)
        Lowest and highest speed of the system [rad/s].
    temperature : float
        Temperature of the raceways [K].
    margin : float
        Highest load over the static one.

    Raises
    ------
    AnalysisError
        If all bearings of a geometry are unloaded or stand still.
    """
    groups: dict[object, list[tuple[LocatingElement, float]]] = {}
    for bearing, load in zip(bearings, static_loads, strict=True):
        groups.setdefault(bearing.same_films, []).append((bearing, load))
    found = []
    for members in groups.values():
        names = tuple(bearing.name for bearing, _ in members)
        highest = max(load for _, load in members)
        rates = [bearing.entrainment_rate for bearing, _ in members if bearing.entrainment_rate > 0.0]
        if problem := idle_problem(names, highest, rates):
            raise AnalysisError(problem)
        one = members[0][0]
        geometry, of_points = one.force.geometry, one.of_points
        lowest = LIGHTEST * margin * highest
        found.append(
            Seen(
                geometry=geometry,
                bearings=names,
                load=(lowest if of_points else min(lowest, LIGHT), margin * highest),
                entrainment_speed=(min(rates) * speeds[0], max(rates) * speeds[1]),
                temperature=temperature,
                static_load=highest,
                of_points=of_points,
            )
        )
    return tuple(found)


_SPEEDS = 5


@dataclass(frozen=True)
class Held:
    """Part of the film table that the bearings of one geometry see.

    Attributes
    ----------
    loads : (float, float)
        Loads that it has at all speeds that have films, in the unit of `Seen.load`; NaN where it has none.
    missing : str
        Speed at which it has no films, and why; empty where it has them at all speeds.
    """

    loads: tuple[float, float]
    missing: str

    def lacks(self, seen: Seen) -> bool:
        """Tell whether loads at rest lie beyond it."""
        return not seen.static_load <= self.loads[1]


def held_films(seen: Seen, model: Model, speeds: tuple[float, float]) -> Held:
    """Loads that the film table has over the speeds of a scene.

    Parameters
    ----------
    seen : Seen
        The bearings.
    model : Model
        The scene with films of the table.
    speeds : (float, float)
        Lowest and highest speed of the system [rad/s].
    """
    element = next(entry for entry in model.located if entry.name == seen.bearings[0])
    length = 1.0 if seen.of_points else seen.geometry.roller_length
    low, high, missing = 0.0, math.inf, ""
    for speed in np.unique(np.geomspace(*speeds, _SPEEDS)).tolist():
        try:
            first, last = element.law_at(speed).loads
        except AnalysisError as error:
            rate = SPEED.text(element.entrainment_rate * speed)
            missing = missing or f"none at {RPM.text(speed)}, {rate}: {_reason(str(error))}"
        else:
            low, high = max(low, first / length), min(high, last / length)
    return Held((low, high) if math.isfinite(high) else (math.nan, math.nan), missing)


def _reason(text: str) -> str:
    """The reason in a message of `law_at`, without its remedy."""
    whole = text.partition("of the system (")[2].rpartition("); ")[0] or text
    head, _, rest = whole.partition("; at least")
    first = rest.partition("(")[2].partition("; ")[0].rstrip(")")
    return f"{head} ({first})" if first else head
