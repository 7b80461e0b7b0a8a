"""What nothing holds at an equilibrium: motions without stiffness, along which the position is arbitrary.

A free motion without a load along it is legal: an unloaded roller, a ring in its clearance. A load along it means that
there is no equilibrium, however small it is beside the other loads.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.linalg as sl

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import AnalysisError
from mbs.model.equilibrium import SKEW, Equilibrium

NOTHING = 1e-16
"""Stiffness over mass of a coordinate, as a part of the largest one, up to which it is round-off."""

SINGULAR = 1e-10
"""Eigenvalue of the stiffness, scaled to a unit diagonal, up to which a motion of several coordinates is free."""

_ROUND_OFF = 1e-12
_ROLLER = ".roller_"


@dataclass(frozen=True, eq=False)
class FreeMotion:
    """A motion without stiffness.

    Attributes
    ----------
    coordinates : tuple of str
        Coordinates of the system that take part.
    shape : array, shape (n,)
        Motion of all coordinates [m or rad]; 1 at the first that takes part.
    """

    coordinates: tuple[str, ...]
    shape: FloatArray

    @property
    def words(self) -> str:
        """Who moves, and how."""
        if len(self.coordinates) > 1:
            return f"{', '.join(self.coordinates)} move freely together"
        body, _, freedom = self.coordinates[0].rpartition(".")
        if freedom.startswith("theta_"):
            return f"{body} tilts freely about {freedom.removeprefix('theta_')}"
        return f"{body} moves freely along {freedom}"


def free_motions(balance: Equilibrium) -> tuple[FreeMotion, ...]:
    """Motions that nothing holds at an equilibrium.

    Parameters
    ----------
    balance : Equilibrium
        What was found.

    Raises
    ------
    AnalysisError
        If a load acts along one of them.
    """
    stiffness, mass = balance.stiffness, np.diag(balance.system.mass)
    if np.max(np.abs(stiffness - stiffness.T)) <= SKEW * np.max(np.abs(stiffness)):
        stiffness = 0.5 * (stiffness + stiffness.T)
    size = _size(stiffness)
    rate = size / mass
    loose = rate <= NOTHING * max(float(np.max(rate)), 0.0)
    shapes = [np.eye(balance.system.size)[index] for index in np.flatnonzero(loose)]
    held = np.flatnonzero(~loose)
    if held.size:
        for column in _null_space(stiffness[np.ix_(held, held)]).T:
            shape = np.zeros(balance.system.size)
            shape[held] = column
            shapes.append(shape)
    names = balance.system.coordinates
    found = tuple(FreeMotion(tuple(names[i] for i in np.flatnonzero(shape)), shape) for shape in shapes)
    _check_loads(balance, found)
    return found


def free_lines(found: tuple[FreeMotion, ...]) -> list[str]:
    """A sentence for each free motion; unloaded rollers of a bearing are counted."""
    rollers: dict[str, int] = {}
    lines = []
    for motion in found:
        if len(motion.coordinates) == 1 and _ROLLER in motion.coordinates[0]:
            body = motion.coordinates[0].partition(_ROLLER)[0]
            rollers[body] = rollers.get(body, 0) + 1
        else:
            together = len(motion.coordinates) > 1
            lines.append(f"{motion.words}: {'their positions are' if together else 'its position is'} arbitrary")
    return lines + [
        f"{body}: {count} unloaded rollers move freely; their places are arbitrary" for body, count in rollers.items()
    ]


def _size(stiffness: FloatArray) -> FloatArray:
    """Size of the stiffness of each coordinate, shape (n,).

    It is the diagonal where the forces have a potential with a minimum. Where the stiffness is not symmetric, or
    negative somewhere, a coordinate may be held by others alone.
    """
    diagonal = np.diag(stiffness)
    if np.all(diagonal >= 0.0) and np.array_equal(stiffness, stiffness.T):
        return diagonal
    return np.asarray(np.max(np.abs(stiffness), axis=1))


def _null_space(stiffness: FloatArray) -> FloatArray:
    """Motions (n, k) without stiffness of coordinates that each have one; each with as few coordinates as can be."""
    scale = 1.0 / np.sqrt(_size(stiffness))
    scaled = scale[:, None] * stiffness * scale
    if np.array_equal(stiffness, stiffness.T):
        values, vectors = np.linalg.eigh(scaled)
    else:
        _, values, rows = np.linalg.svd(scaled)
        vectors = rows.T
    free = vectors[:, np.abs(values) <= SINGULAR]
    if free.shape[1] == 0:
        return free
    pivots = sl.qr(free.T, mode="r", pivoting=True)[1][: free.shape[1]]
    shapes = scale[:, None] * (free @ np.linalg.inv(free[pivots]))
    shapes /= np.max(np.abs(shapes), axis=0)
    shapes[np.abs(shapes) < np.sqrt(SINGULAR)] = 0.0
    return np.asarray(shapes)


def _check_loads(balance: Equilibrium, found: tuple[FreeMotion, ...]) -> None:
    """Refuse a remaining force along a free motion."""
    system = balance.system
    loads = system.loads(balance.operation.time)
    remaining = loads - system.stiffness @ balance.displacement
    for connected, inside in zip(system.elements, balance.forces, strict=True):
        remaining += connected.transform.T @ inside
    largest = max(float(np.max(np.abs(loads))), *(float(np.max(np.abs(f))) for f in balance.forces), 0.0)
    wrong = [
        f"{motion.words}, and a load of {abs(force):.4g} {'N m' if 'tilts' in motion.words else 'N'} acts that way"
        for motion in found
        if abs(force := float(motion.shape @ remaining)) > _ROUND_OFF * largest
        and abs(float(motion.shape @ loads)) > _ROUND_OFF * float(np.abs(motion.shape) @ np.abs(loads))
    ]
    if wrong:
        raise AnalysisError(
            f"no equilibrium: {'; '.join(wrong)}; hold it by a spring, take the freedom away, or take the load away"
        )
