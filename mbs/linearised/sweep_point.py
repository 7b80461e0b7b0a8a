"""One speed of a sweep, and the way from one speed to the next."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ehdmaps.arrays import ComplexArray, FloatArray, IntArray
from mbs.bearings.bearing_element import RingElement, ring_matrices
from mbs.linearised.modes import StateModes, UndampedModes, energy_shares, state_modes, undamped_modes
from mbs.linearised.own_frequency import LostMode
from mbs.linearised.tracking import Match, ModeSet, compose, match
from mbs.model.equilibrium import Equilibrium

SURE = 0.8
"""Assurance below which speeds are put in between."""

LEAST = 0.3
"""Assurance below which a complex mode ends, after speeds were put in between. At the middle of a sharp
veering two continuations are equally good and the MAC is 0.5; the MAC of unrelated modes is close to zero."""

FINEST = 1.0 / 16.0
"""Part of a step of the sweep below which no speed is put in between."""


@dataclass(frozen=True, eq=False)
class Point:
    """Equilibrium and modes at one speed.

    Attributes
    ----------
    balance : Equilibrium
        Equilibrium at this speed.
    undamped : UndampedModes
        Modes of mass and stiffness.
    states : StateModes
        All eigenvalues of the state.
    shapes, damped : ModeSet
        Undamped modes, and oscillating complex ones in the order of their frequency, to be compared.
    complex_shares : array, shape (parts, complex modes)
        Part of the strain energy.
    whirl : array, shape (complex modes,)
        d omega/d Omega by gyroscopic terms [1]; of an equal pair, as at rest, anything between those of both.
    kinship : array, shape (complex modes, n)
        Part of each undamped mode in the shape of a complex one, by kinetic energy: rows sum to 1.
    kept : array of int, shape (complex modes,)
        Which of `states` the complex modes are.
    lost : tuple of LostMode
        Complex modes that could not be brought to the films of their own frequency; they are not there.
    """

    balance: Equilibrium
    undamped: UndampedModes
    states: StateModes
    shapes: ModeSet
    damped: ModeSet
    complex_shares: FloatArray
    whirl: FloatArray
    kinship: FloatArray
    kept: IntArray
    lost: tuple[LostMode, ...] = ()


@dataclass(frozen=True, eq=False)
class Along:
    """The way from one speed to the next.

    Attributes
    ----------
    undamped, damped : Match
        Which modes continue which.
    logarithm : array, shape (n,)
        Logarithm of the frequency of each undamped mode, its change by energy.
    between : int
        Speeds that were put in between.
    """

    undamped: Match
    damped: Match
    logarithm: FloatArray
    between: int = 0

    @property
    def sure(self) -> bool:
        """Whether every mode is surely followed."""
        return min(float(step.assurance.min(initial=1.0)) for step in (self.undamped, self.damped)) >= SURE


def solve_modes(balance: Equilibrium) -> Point:
    """Solve both eigenproblems at an equilibrium.

    Raises
    ------
    AnalysisError
        If a stiffness or damping is not finite.
    """
    system = balance.system
    undamped = undamped_modes(balance)
    states = state_modes(balance, undamped)
    kept = np.nonzero(states.oscillates)[0]
    kept = kept[np.argsort(np.abs(states.eigenvalues[kept]), kind="stable")]
    own = states.at_own_frequency(balance, kept)
    kept, values = kept[own.found], own.eigenvalues[own.found]
    n = system.size
    shapes = states.right[:n, kept]
    turned = np.linalg.solve(system.mass, system.gyroscopic @ states.right[n : 2 * n, kept])
    plain = np.asarray(2j * np.pi * undamped.frequency, dtype=np.complex128)
    return Point(
        balance,
        undamped,
        states,
        ModeSet(plain, undamped.shapes, undamped.shapes.T @ system.mass),
        ModeSet(values, *states.comparable(kept)),
        energy_shares(balance, shapes, np.abs(values)),
        # d lambda/d Omega = left . dA/dOmega . right, exact with damping too.
        -np.sum(states.left[kept, n : 2 * n].T * turned, axis=0).imag,
        _kinship(undamped.shapes.T @ system.mass @ shapes),
        kept,
        own.lost,
    )


def bridge(first: Point, last: Point, at: Callable[[float, FloatArray | None], Point], spare: int) -> Along:
    """Follow all modes from one speed to another, over speeds in between where they change too much.

    Parameters
    ----------
    first, last : Point
        Both ends.
    at : callable
        Point at a speed [rad/s], from a first guess of the displacement.
    spare : int
        How many speeds may be put in between.
    """
    path, links = [first, last], [_link(first, last)]
    begin, end = (point.balance.operation.speed for point in (first, last))
    # Halved so often: FINEST is a power of two.
    smallest = 1.5 * FINEST * abs(end - begin)
    index = 0
    while index < len(links):
        here, there = path[index].balance, path[index + 1].balance
        width = there.operation.speed - here.operation.speed
        if links[index].sure or len(path) - 2 >= spare or abs(width) < smallest:
            index += 1
            continue
        middle = at(here.operation.speed + 0.5 * width, here.displacement)
        path.insert(index + 1, middle)
        links[index : index + 1] = [_link(path[index], middle), _link(middle, path[index + 2])]
    logarithm = np.zeros(links[0].logarithm.size)
    order = np.arange(logarithm.size)
    for link in links:
        logarithm += link.logarithm[order]
        order = link.undamped.chosen[order]
    return Along(
        compose([link.undamped for link in links]),
        compose([link.damped for link in links]),
        logarithm,
        len(path) - 2,
    )


def bearing_parts(balance: Equilibrium) -> IntArray:
    """Which of the parts of the stiffness are bearings, shape (bearings,)."""
    bearings = {balance.system.elements[index].element.name for index in balance.system.select(RingElement)}
    return np.array([index for index, name in enumerate(balance.parts) if name in bearings], dtype=np.int64)


def along_load(balance: Equilibrium) -> FloatArray:
    """Force [N] of each bearing, its stiffness [N/m] and damping [N s/m] along that force, shape (3, bearings).

    Rollers that are bodies follow in equilibrium. NaN for stiffness and damping of a bearing without force.
    """
    found = []
    for index in balance.system.select(RingElement):
        radial = balance.forces[index][1:3]
        load = float(np.linalg.norm(radial))
        direction = np.array([0.0, *(radial / load if load > 0.0 else radial * np.nan), 0.0, 0.0, 0.0])
        stiffness, damping = ring_matrices(balance.element_stiffness[index], balance.element_damping[index])
        found.append([load, direction @ stiffness @ direction, direction @ damping @ direction])
    return np.array(found).reshape(-1, 3).T


def _kinship(parts: ComplexArray) -> FloatArray:
    """Squares of the parts (n, complex modes) that undamped modes have in complex ones, in rows that sum to 1."""
    squares = np.abs(parts.T) ** 2
    return np.asarray(squares / np.maximum(squares.sum(axis=1, keepdims=True), 1e-300), dtype=np.float64)


def first_order_shift(first: Point, last: Point) -> tuple[FloatArray, FloatArray]:
    """d f/f of each undamped mode by the change dK of the bearings: phi' dK phi/(2 phi' K phi).

    Both with the shapes and K of `first`, in its order, and with those of `last`, in the order of that; 0 for free
    motions. Shape (n,) each.
    """
    parts = bearing_parts(first.balance)
    begin, end = (np.array(list(point.balance.parts.values())) for point in (first, last))
    change = end[parts].sum(axis=0) - begin[parts].sum(axis=0)
    shifts = []
    for point in (first, last):
        phi, squares = point.undamped.shapes, (2.0 * np.pi * point.undamped.frequency) ** 2
        energy = np.sum(phi * (change @ phi), axis=0)
        free = squares <= 1e-12 * squares.max(initial=0.0)
        shifts.append(np.where(free, 0.0, 0.5 * energy / np.where(free, 1.0, squares)))
    return shifts[0], shifts[1]


def _link(first: Point, last: Point) -> Along:
    """Both matches from a point to the next, and the change by energy, by the trapezoidal rule."""
    undamped = match(first.shapes, last.shapes)
    ahead, behind = first_order_shift(first, last)
    return Along(undamped, match(first.damped, last.damped, LEAST), 0.5 * (ahead + behind[undamped.chosen]))
