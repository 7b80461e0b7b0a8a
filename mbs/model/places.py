"""Places of a system: which there are, where they are, how they move with their body, and how fast it spins."""

from __future__ import annotations

from collections.abc import Sequence

from ehdmaps.arrays import FloatArray
from ehdmaps.units import closest, short
from mbs.model.body import CENTRE, Body, Frame
from mbs.model.elements import GROUND


class Places:
    """Places on some bodies, written "body:frame", or "body" for its frame "centre", or "ground".

    Parameters
    ----------
    bodies : sequence of Body
        All bodies of a system.
    """

    def __init__(self, bodies: Sequence[Body]) -> None:
        self._by_name = {body.name: body for body in bodies}

    def problem(self, place: str) -> str:
        """Return what is wrong about a place, in words; empty if it exists."""
        body, _, frame = place.partition(":")
        if place == GROUND:
            return ""
        if body not in self._by_name:
            names = (*self._by_name, GROUND)
            return f"got the body {short(body)}{closest(body, names)}; allowed: {', '.join(names)}"
        frames = self._by_name[body].frames
        if (frame or CENTRE) not in frames:
            return f"got the frame {short(frame or CENTRE)} of {body!r}; allowed: {', '.join(frames)}"
        return ""

    def body_problem(self, body: str) -> str:
        """Return what is wrong about the name of a body, in words; empty if it exists."""
        names = tuple(self._by_name)
        return "" if body in names else f"got the body {short(body)}{closest(body, names)}; allowed: {', '.join(names)}"

    def frame(self, place: str) -> Frame:
        """The frame of a place on a body."""
        body, _, frame = place.partition(":")
        return self._by_name[body].frames[frame or CENTRE]

    def position(self, place: str) -> FloatArray:
        """Where a place on a body is, shape (3,) [m]."""
        return self.frame(place).position

    def spin(self, place: str) -> float:
        """Spin of the body of a place; 0 on the ground."""
        return 0.0 if place == GROUND else self._by_name[place.partition(":")[0]].spin
