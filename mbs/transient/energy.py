"""Energy balance of a run: what loads and prescribed motion bring in, where it goes, and what does not close.

The equations of motion hold at both ends of a step. With means over the step (bar) and changes over it (Delta),

    Delta(kinetic + elastic) = load_bar Delta q + f_bar Delta x - h v_bar D v_bar - numerical,
    -numerical = v_bar M (Delta v - h a_bar) + (h v_bar - Delta q) (load_bar + T^T f_bar - K q_bar),

to rounding, whatever the step: `numerical` is what the method takes, because its Delta q is not h v_bar and its Delta v
not h a_bar; it is zero for a spectral radius of 1. The work f_bar Delta x of an element is split by what the element
says of itself, at every step:

    work = driven - dissipated - change of what it stores,

driven and dissipated being powers, summed by the trapezoidal rule. What a change of speed brings into films comes
besides, see `Element.brought_by_speed`. What is left is the residual: the trapezoidal rule for the forces and powers of
the elements, of second order in the step, and what Newton leaves over. An element that does not say what it stores and
dissipates has no residual.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from ehdmaps.arrays import FloatArray
from mbs.model.elements import Operation
from mbs.model.system import System

_ROUND_OFF = 1e-13
"""Part of what is stored below which nothing went through a run."""


@dataclass(frozen=True)
class ElementEnergy:
    """Energies of a nonlinear element over a run [J].

    Attributes
    ----------
    name : str
        Name of the element.
    work : float
        What its force did on the system.
    driven, dissipated, change : float or None
        What its prescribed course brought in, what it dissipated, and the change of what it stores; None for an
        element that does not say.
    by_speed : float
        What changes of the speed brought in, by changing its law.
    """

    name: str
    work: float
    driven: float | None
    dissipated: float | None
    change: float | None
    by_speed: float = 0.0

    @property
    def told(self) -> bool:
        """True where the element says what becomes of its work."""
        return self.driven is not None and self.dissipated is not None and self.change is not None

    @property
    def residual(self) -> float:
        """Part of the work that does not close [J]; zero for an element that does not say what becomes of it."""
        if self.driven is None or self.dissipated is None or self.change is None:
            return 0.0
        return self.driven + self.by_speed - self.dissipated - self.change - self.work


@dataclass(frozen=True)
class EnergyBalance:
    """Sources and sinks of the energy of a run [J].

    Attributes
    ----------
    loads : float
        Work of the loads.
    elements : tuple of ElementEnergy
        Nonlinear elements.
    parts : dict of str to float
        What flexible bodies and springs dissipated, by name.
    numerical : float
        What the method of integration took; negative where it gave.
    kinetic, elastic : float
        Change of the kinetic energy, and of the elastic one of bodies and springs.
    level : float
        Energy that is stored at both ends together, by which a run that stays at rest is told.
    """

    loads: float
    elements: tuple[ElementEnergy, ...]
    parts: dict[str, float]
    numerical: float
    kinetic: float
    elastic: float
    level: float = 0.0

    @property
    def driven(self) -> float:
        """Energy that prescribed courses and speeds brought in through elements; all work of those that do not say."""
        return sum((e.driven or 0.0) + e.by_speed if e.told else e.work for e in self.elements)

    @property
    def put_in(self) -> float:
        """Energy that came in: work of the loads, and what prescribed motion brought in."""
        return self.loads + self.driven

    @property
    def dissipated(self) -> float:
        """Energy that bodies, springs and elements dissipated."""
        return sum(self.parts.values()) + sum((e.dissipated or 0.0) if e.told else 0.0 for e in self.elements)

    @property
    def stored(self) -> float:
        """Change of all stored energy."""
        return self.kinetic + self.elastic + sum((e.change or 0.0) if e.told else 0.0 for e in self.elements)

    @property
    def residual(self) -> float:
        """Energy that came in less what is known to have become of it."""
        return self.put_in - self.dissipated - self.numerical - self.stored

    @property
    def through(self) -> float:
        """Energy that went through: half the sum of the sizes of all terms; 0 for round-off of what is stored."""
        terms = [self.loads, self.numerical, self.kinetic, self.elastic, *self.parts.values()]
        for e in self.elements:
            terms += [value or 0.0 for value in (e.driven, e.by_speed, e.dissipated, e.change)] if e.told else [e.work]
        total = 0.5 * sum(abs(value) for value in terms)
        return total if total > _ROUND_OFF * self.level else 0.0

    @property
    def relative_residual(self) -> float:
        """The residual as a part of what went through; 0 where nothing did."""
        return abs(self.residual) / self.through if self.through > 0.0 else 0.0


class Stored(NamedTuple):
    """Stored energies at one time [J]: kinetic, elastic of bodies and springs, and of each element; None: untold."""

    kinetic: float
    elastic: float
    elements: tuple[float | None, ...]


class Sums(NamedTuple):
    """Sums over the steps of a run [J].

    Attributes
    ----------
    loads, numerical : float
        Work of the loads, and what the method took.
    parts : array (parts,)
        What each of `System.damping_parts` dissipated.
    works : array (elements,)
        Work of each element.
    exchanged : array (elements, 2)
        What each dissipated, and what its course brought in; NaN for one that does not say.
    """

    loads: float
    numerical: float
    parts: FloatArray
    works: FloatArray
    exchanged: FloatArray

    def plus(self, other: Sums) -> Sums:
        """Both together."""
        return Sums(
            self.loads + other.loads,
            self.numerical + other.numerical,
            self.parts + other.parts,
            self.works + other.works,
            self.exchanged + other.exchanged,
        )


class Instant(NamedTuple):
    """A system at the end of a step: coordinates, ports and powers of the elements.

    Attributes
    ----------
    q, v, a, load : array (n,)
        Motion of the coordinates, and loads on them.
    x, rate, force : array (ports,)
        Motion of the ports, and forces of the elements in them.
    powers : array (elements, 3)
        Numbers of `Powers` of each element; NaN of those that do not say.
    """

    q: FloatArray
    v: FloatArray
    a: FloatArray
    load: FloatArray
    x: FloatArray
    rate: FloatArray
    force: FloatArray
    powers: FloatArray


class Account:
    """Sums of the energies of steps that are made in Python.

    Parameters
    ----------
    system : System
        The system.
    ports : sequence of slice
        Ports of each element among all.

    Attributes
    ----------
    last : Instant
        The end of the last step.
    """

    def __init__(self, system: System, ports: Sequence[slice], first: Instant) -> None:
        self._system, self._ports, self.last = system, ports, first
        self._parts = list(system.damping_parts.values())
        self._loads = self._numerical = 0.0
        self._dissipated = np.zeros(len(self._parts))
        self._works, self._exchanged = np.zeros(len(ports)), np.zeros((len(ports), 2))

    def add(self, h: float, end: Instant) -> None:
        """Add a step of h [s] that leads from the last instant to this one."""
        last, system = self.last, self._system
        moved, ported = end.q - last.q, end.x - last.x
        v, load, force = 0.5 * (last.v + end.v), 0.5 * (last.load + end.load), 0.5 * (last.force + end.force)
        short, port_short = h * v - moved, 0.5 * h * (last.rate + end.rate) - ported
        missing = system.mass @ (end.v - last.v - 0.5 * h * (last.a + end.a))
        elastic = system.stiffness @ (0.5 * (last.q + end.q))
        self._loads += float(load @ moved)
        self._numerical -= float(v @ missing + short @ (load - elastic) + port_short @ force)
        self._dissipated += [h * float(v @ part @ v) for part in self._parts]
        self._works += [float(force[rows] @ ported[rows]) for rows in self._ports]
        self._exchanged += 0.5 * h * (last.powers + end.powers)[:, :2]
        self._exchanged[:, 0] += end.powers[:, 2]
        self.last = end

    @property
    def sums(self) -> Sums:
        """Sums so far."""
        return Sums(self._loads, self._numerical, self._dissipated, self._works, self._exchanged)


def stored_energy(system: System, q: FloatArray, v: FloatArray, states: Sequence[Any], operation: Operation) -> Stored:
    """Stored energies of a system.

    Parameters
    ----------
    system : System
        The system.
    q, v : array, shape (n,)
        Coordinates and their rates.
    states : sequence
        States of each element, as of `Element.advance`.
    operation : Operation
        Speed, angle and time.
    """
    return Stored(
        0.5 * float(v @ system.mass @ v),
        0.5 * float(q @ system.stiffness @ q),
        tuple(
            connected.element.stored(state, connected.transform @ q, operation)
            for connected, state in zip(system.elements, states, strict=True)
        ),
    )


def balance(system: System, sums: Sums, begin: Stored, end: Stored, by_speed: Sequence[float]) -> EnergyBalance:
    """The balance of a run.

    Parameters
    ----------
    system : System
        The system.
    sums : Sums
        Sums over its steps.
    begin, end : Stored
        Energies at both ends of the run.
    by_speed : sequence of float
        What changes of the speed brought into each element [J].
    """
    elements = []
    for i, connected in enumerate(system.elements):
        (dissipated, driven), first, last = sums.exchanged[i].tolist(), begin.elements[i], end.elements[i]
        known = np.isfinite(dissipated) and first is not None and last is not None
        elements.append(
            ElementEnergy(
                name=connected.element.name,
                work=float(sums.works[i]),
                driven=driven if known else None,
                dissipated=dissipated if known else None,
                change=last - first if first is not None and last is not None and known else None,
                by_speed=by_speed[i] if known else 0.0,
            )
        )
    return EnergyBalance(
        loads=sums.loads,
        elements=tuple(elements),
        parts=dict(zip(system.damping_parts, sums.parts.tolist(), strict=True)),
        numerical=sums.numerical,
        kinetic=end.kinetic - begin.kinetic,
        elastic=end.elastic - begin.elastic,
        level=sum(abs(value or 0.0) for at in (begin, end) for value in (at.kinetic, at.elastic, *at.elements)),
    )
