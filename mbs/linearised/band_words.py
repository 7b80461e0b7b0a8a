"""Errors in the bands of a system, in words."""

from __future__ import annotations

from mbs.model.elements import OnRings
from mbs.model.system import System

NO_MAP = "none stated: the law is not that of a map or a film table"
"""What is said where laws state no errors."""


def error_words(system: System, film_share: float = 0.0) -> str:
    """Name the errors in the bands of a system, for people, the largest first; empty without bearings.

    Parameters
    ----------
    system : System
        The system.
    film_share : float
        Part of the bands that is what films with memory leave out; 0 if that is not in them.
    """
    bearings = [entry.element for entry in system.elements if isinstance(entry.element, OnRings)]
    if not bearings:
        return ""
    words = {element.error_words for element in bearings}
    if "" in words:
        return NO_MAP
    stated = "; ".join(sorted(words))
    if film_share == 0.0:
        return f"{stated}; how films relax is not in it"
    memories = {element.memory_words for element in bearings}
    memory = memories.pop() if len(memories) == 1 else OnRings.memory_words
    films = f"what {memory} out ({100.0 * film_share:.2g} % of the median band)"
    return f"{films}, then {stated}" if film_share > 0.5 else f"{stated}; then {films}"
