"""One bearing that carries axial load at an operating point: what points of its kinds have in common.

The outer ring is held in its place, the inner one moves along x, y and z, and tilts if it may.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import AnalysisError, InputError
from ehdmaps.units import written
from mbs.bearings.locating.locating_element import LocatingElement
from mbs.model.body import Inertia, rigid_body
from mbs.model.elements import Load, Operation
from mbs.model.equilibrium import Equilibrium, equilibrium
from mbs.model.findings import Finding, WithFindings
from mbs.model.system import System

RING, TURNING = "inner ring", Operation(1.0)
"""The ring; speeds are those of the rings at a speed of the system of one."""


@dataclass(frozen=True, eq=False, kw_only=True)
class LocatingPoint(WithFindings):
    """A bearing that carries axial load in equilibrium; kinds inherit from it.

    Attributes
    ----------
    force : LocatingForce
        Geometry and laws.
    load : array (3,)
        Load on the inner ring, x, y and z [N].
    inner_speed, outer_speed : float
        [rad/s].
    pose : array (6,)
        Pose of the inner ring in the outer one.
    stiffness, damping : array (6, 6)
        -d force/d pose and -d force/d velocity.
    pressure, central_film, minimum_film : array (2, Z)
        Largest Hertz pressure [Pa] and smallest films [m] of the inner and outer contacts; NaN for films of contacts
        without load, or without an oil.
    findings : tuple of Finding
        What is beyond its laws, and what else is to be known.
    failed : bool
        Whether it has no answer: numbers are NaN, and `problems` say why.
    """

    force: Any
    load: FloatArray
    inner_speed: float
    outer_speed: float
    pose: FloatArray
    stiffness: FloatArray
    damping: FloatArray
    pressure: FloatArray
    central_film: FloatArray
    minimum_film: FloatArray
    findings: tuple[Finding, ...]
    failed: bool = False

    @property
    def size(self) -> float:
        """Size of the radial load [N]."""
        return math.hypot(self.load[1], self.load[2])

    @property
    def axial(self) -> float:
        """Axial load [N]."""
        return float(self.load[0])

    @property
    def axes(self) -> FloatArray:
        """Unit vectors along and across the radial load, (2, 3); along y without one."""
        y, z = (self.load[1:] / self.size) if self.size > 0.0 else (1.0, 0.0)
        return np.array([[0.0, y, z], [0.0, -z, y]])

    def along_across(self, matrix: FloatArray) -> tuple[float, float, float]:
        """Entries of a matrix (6, 6) along the radial load, across it, and along the axis."""
        along, across = self.axes
        part = matrix[:3, :3]
        return float(along @ part @ along), float(across @ part @ across), float(part[0, 0])

    @property
    def smallest_film(self) -> float:
        """Smallest of all minimum films [m]; NaN where none is known."""
        known = self.minimum_film[np.isfinite(self.minimum_film)]
        return float(known.min()) if known.size else math.nan


class Rested(NamedTuple):
    """A bearing whose ring is at rest.

    Attributes
    ----------
    load : array (3,)
        Load on the inner ring [N].
    pose : array (6,)
        Pose of the inner ring in the outer one.
    loads : BallLoads or TaperedLoads
        State of its rolling elements.
    balance : Equilibrium
        Equilibrium of the ring.
    """

    load: FloatArray
    pose: FloatArray
    loads: Any
    balance: Equilibrium


def ring_load(load: Sequence[float]) -> FloatArray:
    """Load on a ring, x, y and z [N].

    Parameters
    ----------
    load : (float, float, float)
        The load as it was given.

    Raises
    ------
    InputError
        For loads that are no finite numbers, or all zero.
    """
    given = np.array(load, dtype=np.float64)
    if given.shape != (3,) or not np.all(np.isfinite(given)) or not np.any(given):
        raise InputError(f"bearing point, load: got {load!r} N; allowed: three finite numbers, x, y, z, not all zero")
    return given


def ring_at_rest(
    element: LocatingElement, load: FloatArray, advice: str, *, tilts: bool, start: FloatArray | None = None
) -> Rested:
    """Find where the inner ring of a bearing comes to rest.

    Parameters
    ----------
    element : LocatingElement
        The bearing between `RING` and ground, with the speeds of the rings as its spins.
    load : array (3,)
        Load on the inner ring [N].
    advice : str
        What to do where there is no equilibrium.
    tilts : bool
        Whether the inner ring tilts freely, without a moment; else it is held.
    start : array (3,), optional
        Displacement to start from [m].

    Raises
    ------
    AnalysisError
        Where no equilibrium is found.
    """
    free = ["x", "y", "z", "theta_y", "theta_z"] if tilts else ["x", "y", "z"]
    ring = rigid_body(RING, [Inertia(1.0, 1.0, 1.0)], free)
    system = System([ring], loads=[Load("load", RING, np.array([*load, 0.0, 0.0, 0.0]))], elements=[element])
    begin = None if start is None else np.concatenate([start, np.zeros(len(free) - 3)])
    try:
        balance = equilibrium(system, TURNING, begin)
    except AnalysisError as error:
        under = f"{written(load[0])} N axial, {written(math.hypot(*load[1:]))} N radial"
        words = f"no equilibrium of {element.force.geometry.name} under {under}{advice}"
        raise AnalysisError(f"{words}: {error.__cause__ or error}") from error
    pose = np.zeros(6)
    pose[[0, 1, 2, 4, 5][: len(free)]] = balance.displacement
    return Rested(load, pose, element.loads(pose, TURNING), balance)
