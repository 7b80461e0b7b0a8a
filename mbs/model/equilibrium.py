"""Static equilibrium: Newton with the exact Jacobian, in steps that neither leap nor overshoot.

At rest the forces have a potential which is convex, because every contact force rises with its approach and the
approaches are linear in the coordinates. So along a Newton step the slope of the potential tells where to stop, and
the search arrives from anywhere: from zero, from a gap (where the Jacobian is singular) and from overload.

What nothing holds at an equilibrium: motions without stiffness, along which the position is arbitrary.

A free motion without a load along it is legal: an unloaded roller, a ring in its clearance. A load along it means that
there is no equilibrium, however small it is beside the other loads.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.linalg as sl

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import AnalysisError, InputError
from mbs.model.elements import OnRings, Operation
from mbs.model.relaxation import Relaxation
from mbs.model.system import System

FIRST_STEP = 5e-6
"""How far a coordinate moves at most in the first step [m or rad]; doubled while steps fall short."""

SKEW = 1e-8
"""Part of the largest entry that the Jacobian may lack of symmetry for its forces to have a potential, to rounding."""

FARTHEST = 0.1
"""A step that would have to be longer than this [m or rad] means that something moves freely."""

NEGLIGIBLE = 1e-15
"""Newton stops at steps below this [m or rad]: without a load there is no force scale for the relative tolerance."""

_STEPS = 200
_CUTS = 40


@dataclass(frozen=True, eq=False)
class Equilibrium:
    """A system at rest in its coordinates, its bodies turning at a prescribed speed.

    Attributes
    ----------
    system : System
        Whose equilibrium it is.
    operation : Operation
        Speed, angle, and the time at which the loads were taken.
    displacement : array, shape (n,)
        Coordinates [m or rad].
    forces : tuple of array, shape (m,)
        Force of each element in its ports [N or N m].
    stiffness, damping : array, shape (n, n)
        -d force/d q and -d force/d q' of the whole system there, gyroscopic terms included.
    parts : dict of str to array, shape (n, n)
        Stiffness by flexible body, spring and element.
    element_stiffness, element_damping : tuple of array, shape (m, m)
        Matrices of each element in its ports.
    outside : dict of str to bool
        Whether each element lies outside its map there, by name.
    residual : float
        Largest remaining force, as a part of the largest load.
    steps : int
        Newton steps.
    """

    system: System
    operation: Operation
    displacement: FloatArray
    forces: tuple[FloatArray, ...]
    stiffness: FloatArray
    damping: FloatArray
    parts: dict[str, FloatArray]
    element_stiffness: tuple[FloatArray, ...]
    element_damping: tuple[FloatArray, ...]
    outside: dict[str, bool]
    residual: float
    steps: int

    @cached_property
    def relaxations(self) -> tuple[Relaxation | None, ...]:
        """Part of the stiffness of each element that needs time, in its ports; None where nothing does."""
        return tuple(
            connected.element.relaxation(connected.transform @ self.displacement, self.operation)
            for connected in self.system.elements
        )


def equilibrium(
    system: System, operation: Operation, start: FloatArray | None = None, tolerance: float = 1e-10
) -> Equilibrium:
    """Static equilibrium of a system.

    Parameters
    ----------
    system : System
        Bodies, springs, loads, elements.
    operation : Operation
        Speed, angle, and the time of the loads; ``Operation()`` is at rest, with angle and time zero.
    start : array, shape (n,), optional
        Displacement to begin with; zero if left out.
    tolerance : float
        Remaining force over the largest force in the system.

    Raises
    ------
    AnalysisError
        If there is no equilibrium: a load on something that moves freely, or one that an element cannot hold.
    """
    try:
        return _found(system, operation, start, tolerance)
    except InputError as error:
        raise AnalysisError(
            f"no equilibrium: on the way to it an element is moved farther than it can be ({error}); check units and "
            "size of the loads, and whether springs hold what they push"
        ) from error


def _found(system: System, operation: Operation, start: FloatArray | None, tolerance: float) -> Equilibrium:
    """The equilibrium; elements refuse what they cannot take."""
    loads = system.loads(operation.time)
    rest = np.zeros(system.size)
    weight = 1.0 / np.sqrt(np.diag(system.mass))
    for connected in system.elements:
        if isinstance(connected.element, OnRings):
            connected.element.forget(operation)

    def residual(q: FloatArray) -> tuple[FloatArray, float]:
        internal = -system.stiffness @ q
        scale = float(np.linalg.norm(weight * internal)) + float(np.linalg.norm(weight * loads))
        for connected in system.elements:
            part = connected.transform.T @ connected.evaluate(q, rest, operation).force
            scale += float(np.linalg.norm(weight * part))
            internal += part
        return internal + loads, scale

    q = rest.copy() if start is None else np.asarray(start, dtype=np.float64).copy()
    longest = FIRST_STEP
    force, scale = residual(q)
    for steps in range(_STEPS):
        if float(np.linalg.norm(weight * force)) <= tolerance * scale:
            return _result(system, operation, q, force, loads, steps)
        direction = _newton_step(system, operation, q, force)
        length = float(np.max(np.abs(direction)))
        if length <= NEGLIGIBLE:
            q = q + direction
            return _result(system, operation, q, residual(q)[0], loads, steps + 1)
        clipped = length > longest
        if clipped:
            direction *= longest / length
        q, force, scale, whole = _along(residual, q, direction, float(force @ direction))
        if clipped and whole:
            longest *= 2.0
        if longest > FARTHEST:
            break
    worst = int(np.argmax(np.abs(weight * force)))
    raise AnalysisError(
        f"no equilibrium after {steps + 1} steps: {force[worst]:.4g} {'N m' if system.units[worst] == 'rad' else 'N'} "
        f"remain on {system.coordinates[worst]} at {q[worst]:.4g} {system.units[worst]}; something moves freely under "
        f"its load, or by more than the small displacements that are computed (steps of {FARTHEST} m or rad): hold it "
        "by a spring, take the freedom away, or check units and signs of the loads"
    )


def _newton_step(system: System, operation: Operation, q: FloatArray, force: FloatArray) -> FloatArray:
    """Newton step, with as little mass added to the Jacobian as makes it regular."""
    jacobian = system.stiffness.copy()
    rest = np.zeros(system.size)
    for connected in system.elements:
        jacobian += connected.transform.T @ connected.evaluate(q, rest, operation).stiffness @ connected.transform
    size = max(float(np.trace(jacobian) / np.trace(system.mass)), 1.0)
    if np.max(np.abs(jacobian - jacobian.T)) <= SKEW * np.max(np.abs(jacobian)):
        jacobian = 0.5 * (jacobian + jacobian.T)
    return np.asarray(np.linalg.solve(jacobian + 1e-9 * size * system.mass, force), dtype=np.float64)


def _along(
    residual: Callable[[FloatArray], tuple[FloatArray, float]], q: FloatArray, direction: FloatArray, slope: float
) -> tuple[FloatArray, FloatArray, float, bool]:
    """Go along a descent direction until the potential rises again: place, force, scale, and whether all the way.

    Where a stiffness is negative Newton's direction may lead up the potential, and it is gone until that falls again.
    """
    sign, slope = (-1.0 if slope < 0.0 else 1.0), abs(slope)
    low, high = 0.0, 1.0
    low_slope = high_slope = slope
    part = 1.0
    for _ in range(_CUTS):
        place = q + part * direction
        force, scale = residual(place)
        here = sign * float(force @ direction)
        if part == 1.0 and here >= -0.1 * slope:
            return place, force, scale, True
        if abs(here) <= 0.2 * slope:
            break
        if here > 0.0:
            low, low_slope = part, here
        else:
            high, high_slope = part, here
        # Regula falsi, kept off the ends: contact forces are far from linear across a gap.
        guess = low + (high - low) * low_slope / (low_slope - high_slope)
        part = min(max(guess, low + 0.1 * (high - low)), high - 0.1 * (high - low))
    return place, force, scale, False


def _result(
    system: System, operation: Operation, q: FloatArray, force: FloatArray, loads: FloatArray, steps: int
) -> Equilibrium:
    """Evaluate everything once at the equilibrium."""
    stiffness = system.stiffness.copy()
    damping = system.damping + operation.speed * system.gyroscopic
    parts = dict(system.linear_parts)
    answers = system.evaluate(q, np.zeros(system.size), operation)
    for connected, forces in zip(system.elements, answers, strict=True):
        part = connected.transform.T @ forces.stiffness @ connected.transform
        parts[connected.element.name] = part
        stiffness += part
        damping += connected.transform.T @ forces.damping @ connected.transform
    # Without loads there may be no force at all: then by what moves the stiffest coordinate by a negligible length.
    least = max(NEGLIGIBLE * float(np.max(np.abs(np.diag(stiffness)))), 1e-300)
    largest = max(float(np.max(np.abs(loads))), *(float(np.max(np.abs(forces.force))) for forces in answers), least)
    return Equilibrium(
        system=system,
        operation=operation,
        displacement=q,
        forces=tuple(forces.force for forces in answers),
        stiffness=stiffness,
        damping=damping,
        parts=parts,
        element_stiffness=tuple(forces.stiffness for forces in answers),
        element_damping=tuple(forces.damping for forces in answers),
        outside={entry.element.name: forces.outside for entry, forces in zip(system.elements, answers, strict=True)},
        residual=float(np.max(np.abs(force))) / largest,
        steps=steps,
    )


NOTHING = 1e-16
"""Stiffness over mass of a coordinate, as a part of the largest one, up to which it is round-off."""

SINGULAR = 1e-10
"""Eigenvalue of the stiffness, scaled to a unit diagonal, up to which a motion of several coordinates is free."""

_ROUND_OFF = 1e-12
ROLLER = ".roller_"
"""Mark of a coordinate of a roller that is a body: it follows the name of the body, and its number follows it."""


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
    motions = tuple(FreeMotion(tuple(names[i] for i in np.flatnonzero(shape)), shape) for shape in shapes)
    _check_loads(balance, motions)
    return motions


def free_lines(motions: tuple[FreeMotion, ...]) -> list[str]:
    """A sentence for each free motion; unloaded rollers of a bearing are counted."""
    rollers: dict[str, int] = {}
    lines = []
    for motion in motions:
        if len(motion.coordinates) == 1 and ROLLER in motion.coordinates[0]:
            body = motion.coordinates[0].partition(ROLLER)[0]
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


def _check_loads(balance: Equilibrium, motions: tuple[FreeMotion, ...]) -> None:
    """Refuse a remaining force along a free motion."""
    system = balance.system
    loads = system.loads(balance.operation.time)
    remaining = loads - system.stiffness @ balance.displacement
    for connected, inside in zip(system.elements, balance.forces, strict=True):
        remaining += connected.transform.T @ inside
    largest = max(float(np.max(np.abs(loads))), *(float(np.max(np.abs(f))) for f in balance.forces), 0.0)
    wrong = [
        f"{motion.words}, and a load of {abs(force):.4g} {'N m' if 'tilts' in motion.words else 'N'} acts that way"
        for motion in motions
        if abs(force := float(motion.shape @ remaining)) > _ROUND_OFF * largest
        and abs(float(motion.shape @ loads)) > _ROUND_OFF * float(np.abs(motion.shape) @ np.abs(loads))
    ]
    if wrong:
        raise AnalysisError(
            f"no equilibrium: {'; '.join(wrong)}; hold it by a spring, take the freedom away, or take the load away"
        )
