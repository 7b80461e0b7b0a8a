"""Bearings whose films no map has, of balls, tapered or ribbed rollers: what the film table has where they run.

Their films are those of the film table of points, or of lines at the middle of a roller. They are asked the questions
of bearings with maps: loads, speeds and temperature (`mbs.planning.ranges`).
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ehdmaps.errors import AnalysisError
from ehdmaps.units import RPM, SPEED
from mbs.planning.ranges import Needed
from mbs.scene.assembly import Model

_SPEEDS = 5


@dataclass(frozen=True)
class Held:
    """Part of the film table that the bearings of one geometry see.

    Attributes
    ----------
    loads : (float, float)
        Loads that it has at all speeds that have films, in the unit of `Needed.load`; NaN where it has none.
    missing : str
        Speed at which it has no films, and why; empty where it has them at all speeds.
    """

    loads: tuple[float, float]
    missing: str

    def lacks(self, seen: Needed) -> bool:
        """Tell whether loads at rest lie beyond it."""
        return not seen.static_load <= self.loads[1]


def held_films(seen: Needed, model: Model, speeds: tuple[float, float]) -> Held:
    """Loads that the film table has over the speeds of a scene.

    Parameters
    ----------
    seen : Needed
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
