"""How a finite-element body is turned as it is put into a system: turns about the axes of the system, one by one."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import InputError

AXES = ("x", "y", "z")
_WHOLE = 1e-13
"""A sine this close to a whole number is one: angles in degrees read back with 15 digits."""


@dataclass(frozen=True)
class Turn:
    """A turn of a body about an axis of the system.

    Attributes
    ----------
    about : {"x", "y", "z"}
        The axis.
    angle : float
        Angle by the right-hand rule [rad].

    Raises
    ------
    InputError
        For another axis, or an angle that is not finite.
    """

    about: str
    angle: float

    def __post_init__(self) -> None:
        problems = []
        if self.about not in AXES:
            problems.append(f"rotation, about: got {self.about!r:.40}; allowed: {', '.join(AXES)}")
        if not math.isfinite(self.angle):
            problems.append(f"rotation, angle: got {self.angle!r} rad; allowed: finite")
        if problems:
            raise InputError(problems)

    @property
    def matrix(self) -> FloatArray:
        """Matrix of the turn, shape (3, 3); that of a quarter turn has zeros and ones alone."""
        cosine, sine = _snapped(math.cos(self.angle)), _snapped(math.sin(self.angle))
        first, second = {"x": (1, 2), "y": (2, 0), "z": (0, 1)}[self.about]
        matrix = np.eye(3)
        matrix[first, first] = matrix[second, second] = cosine
        matrix[first, second], matrix[second, first] = -sine, sine
        return matrix


def rotation_of(turns: Sequence[Turn]) -> FloatArray:
    """Matrix of some turns, the first one first, shape (3, 3).

    Parameters
    ----------
    turns : sequence of Turn
        Turns about the axes of the system, which stay where they are.

    Examples
    --------
    >>> quarter = math.pi / 2.0
    >>> (rotation_of([Turn("z", quarter), Turn("x", quarter)]) @ [1.0, 0.0, 0.0]).tolist()
    [0.0, 0.0, 1.0]
    """
    matrix = np.eye(3)
    for turn in turns:
        matrix = turn.matrix @ matrix
    return matrix


def _snapped(value: float) -> float:
    """A sine or cosine without the round-off of quarter turns."""
    whole = float(round(value))
    return whole if abs(value - whole) < _WHOLE else value
