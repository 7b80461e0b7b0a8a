"""Small motion with the stiffness and damping that bearings and gear meshes have on average over an angle.

A linear system has one stiffness. Which one depends on where the rollers stand, which the start angle of a cage sets by
assumption. Here equilibria are found at several angles within one pitch of the rollers, and stiffness, damping and what
relaxes are averaged: that is the mean part of a system that repeats itself with the passing of rollers. What else it
does, above all excitation at the passing frequency and its combinations with modes, is left out (a method of first
order in the part that varies).
"""

from __future__ import annotations

import copy
import math
from collections.abc import Sequence
from dataclasses import dataclass, fields
from typing import Any, Protocol, runtime_checkable

import numpy as np

from ehdmaps.arrays import ComplexArray, FloatArray
from mbs.linearised.dynamic import dynamic_stiffness
from mbs.model.elements import Element, OnRings, Operation
from mbs.model.equilibrium import Equilibrium, equilibrium
from mbs.model.relaxation import Relaxation
from mbs.model.system import Connected, System


@runtime_checkable
class Varying(Protocol):
    """An element whose stiffness varies with the angle."""

    def steady(self) -> Element:
        """The same element, on the same ports, with its mean stiffness."""
        ...


def steady_system(system: System) -> System:
    """The system with the mean stiffness of elements whose stiffness varies with the angle; else the same system."""
    if not any(isinstance(connected.element, Varying) for connected in system.elements):
        return system
    steady = copy.copy(system)
    steady.elements = tuple(
        Connected(connected.element.steady(), connected.transform)
        if isinstance(connected.element, Varying)
        else connected
        for connected in system.elements
    )
    return steady


@dataclass(frozen=True, eq=False)
class AveragedEquilibrium(Equilibrium):
    """An equilibrium whose stiffness and damping are means over several angles; place and forces are of the first.

    Attributes
    ----------
    over : tuple of Equilibrium
        The equilibria that are averaged, the first of them at the angle of the operation.
    """

    over: tuple[Equilibrium, ...]

    @property
    def relaxations(self) -> tuple[Relaxation | None, ...]:
        """Mean of what needs time: springs and dampers of all angles, each by its part of the whole."""
        part = 1.0 / math.sqrt(len(self.over))
        means: list[Relaxation | None] = []
        for each in zip(*(entry.relaxations for entry in self.over), strict=True):
            there = [relaxation for relaxation in each if relaxation is not None]
            rows, times = ([getattr(entry, name) for entry in there] for name in ("rows", "times"))
            means.append(Relaxation(part * np.concatenate(rows), np.concatenate(times)) if there else None)
        return tuple(means)


@dataclass(frozen=True, eq=False)
class PitchSpread:
    """By how much modes vary over the angles, either way, to first order in the change from the mean.

    Attributes
    ----------
    frequency : array, shape (n,)
        Half of the range of undamped frequencies [Hz].
    complex_frequency, complex_damping_ratio : array, shape (modes,)
        Half of the range of the frequencies [Hz] and damping ratios of complex modes.
    """

    frequency: FloatArray
    complex_frequency: FloatArray
    complex_damping_ratio: FloatArray


def mean_equilibrium(
    system: System, operation: Operation, cage_angles: int, start: FloatArray | None = None
) -> Equilibrium:
    """Equilibrium at which a linear analysis linearises: gear meshes and bearings with their means.

    Parameters
    ----------
    system : System
        Bodies, springs, loads, elements.
    operation : Operation
        Speed, angle and time; place and forces are those of this angle.
    cage_angles : int
        Angles within one pitch of the rollers over which stiffness and damping are averaged; 1 for that of `operation`
        alone.
    start : array, shape (n,), optional
        Displacement to begin with.

    Raises
    ------
    AnalysisError
        If there is no equilibrium at an angle.
    """
    return averaged(over_pitch(equilibrium(steady_system(system), operation, start), cage_angles))


def over_pitch(balance: Equilibrium, count: int) -> tuple[Equilibrium, ...]:
    """Equilibria at several angles within one pitch of the rollers, the first of them the given one.

    Each cage goes on by equal parts of its own pitch, so that all are seen evenly, however fast they turn. Cages whose
    rollers are bodies stand; where no other is there, one equilibrium is all.

    Parameters
    ----------
    balance : Equilibrium
        Equilibrium at the first angle.
    count : int
        How many angles; 1 for that of `balance` alone.

    Raises
    ------
    AnalysisError
        If there is no equilibrium at an angle.
    """
    system, operation = balance.system, balance.operation
    equilibria = [balance]
    elements: list[Any] = [connected.element for connected in system.elements]
    turning = [index for index in system.select(OnRings) if elements[index].passed(0.5) is not elements[index]]
    for part in range(1, count if turning else 1):
        passed = list(elements)
        for index in turning:
            passed[index] = elements[index].passed(part / count)
        equilibria.append(equilibrium(system.with_elements(passed), operation, equilibria[-1].displacement))
    return tuple(equilibria)


def averaged(over: Sequence[Equilibrium]) -> Equilibrium:
    """The mean of equilibria at several angles; of one it is that one.

    Parameters
    ----------
    over : sequence of Equilibrium
        What `over_pitch` finds.
    """
    first = over[0]
    if len(over) == 1:
        return first
    values: dict[str, Any] = {entry.name: getattr(first, entry.name) for entry in fields(Equilibrium)}
    for name in ("stiffness", "damping"):
        values[name] = np.mean([getattr(entry, name) for entry in over], axis=0)
    for name in ("element_stiffness", "element_damping"):
        each = zip(*(getattr(entry, name) for entry in over), strict=True)
        values[name] = tuple(np.mean(matrices, axis=0) for matrices in each)
    values["parts"] = {name: np.mean([entry.parts[name] for entry in over], axis=0) for name in first.parts}
    values["outside"] = {name: any(entry.outside[name] for entry in over) for name in first.outside}
    return AveragedEquilibrium(**values, over=tuple(over))


def pitch_spread(
    balance: Equilibrium,
    frequency: FloatArray,
    shapes: FloatArray,
    eigenvalues: ComplexArray,
    right: ComplexArray,
    left: ComplexArray,
) -> PitchSpread:
    """Find how far modes move while the rollers pass; 0 at one angle.

    d(omega^2) = phi' dK phi of undamped modes, d lambda = -y' dZ(lambda) x of complex ones, with dK and dZ of each
    angle from the mean.

    Parameters
    ----------
    balance : Equilibrium
        What `averaged` returns.
    frequency : array, shape (n,)
        Undamped frequencies [Hz].
    shapes : array, shape (n, n)
        Their shapes phi, with phi' M phi = 1.
    eigenvalues : array, shape (modes,)
        Complex modes [1/s].
    right : array, shape (n, modes)
        Displacements x of the right eigenvectors of the state.
    left : array, shape (modes, n)
        Velocities of the left ones, with left . right = 1 for the whole state.
    """
    over = balance.over if isinstance(balance, AveragedEquilibrium) else (balance,)
    squares, mean = (2.0 * np.pi * frequency) ** 2, dynamic_stiffness(balance, eigenvalues)
    rows = np.linalg.solve(balance.system.mass.T, left.T).T
    plain, turned = [], []
    for entry in over:
        moved = squares + np.sum(shapes * ((entry.stiffness - balance.stiffness) @ shapes), axis=0)
        plain.append(np.sqrt(np.maximum(moved, 0.0)) / (2.0 * np.pi))
        change = np.einsum("kn,knm,mk->k", rows, dynamic_stiffness(entry, eigenvalues) - mean, right, optimize=True)
        turned.append(eigenvalues - change)
    sizes = np.abs(turned)
    circles = sizes / (2.0 * np.pi)
    ratios = -np.real(turned) / np.where(sizes > 0.0, sizes, 1.0)
    return PitchSpread(*(0.5 * np.ptp(values, axis=0) for values in (np.array(plain), circles, ratios)))


def pitch(element: Element) -> float:
    """Angle that the system turns while the cage goes on by one roller [rad]; 0 for a cage that stands."""
    excitation = element.excitation
    return 2.0 * math.pi / excitation.order if excitation is not None else 0.0
