"""Critical speeds, and the response to loads that turn, over speed.

A speed is critical for an order where the frequency of a damped mode is that order times the speed: there an unbalance
(order: spin of its body), or an excitation by that order, meets a resonance. A mode with a damping ratio above
1/sqrt(2) has no resonance, and no critical speed. The response to such loads is solved at
their own frequency at each speed, with all of stiffness, damping, gyroscopic terms and films that relax.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Iterator, Sequence
from dataclasses import dataclass, field

import numpy as np

from ehdmaps.arrays import ComplexArray, FloatArray
from mbs.linearised.averaged import mean_equilibrium
from mbs.linearised.dynamic import dynamic_stiffness, element_dynamic_stiffness
from mbs.linearised.sweep import Point, solve_modes
from mbs.linearised.sweep_result import ComplexSweep
from mbs.linearised.validity import lifting
from mbs.model.elements import OnRings, Operation
from mbs.model.equilibrium import Equilibrium
from mbs.model.system import System

CLOSE = 1e-7
"""Distance of the frequency of a mode from order times speed, as a part of it, at which a critical speed is found."""

AROUND = (-4.0, -2.0, -1.0, -0.5, 0.0, 0.5, 1.0, 2.0, 4.0)
"""Speeds around a critical one at which responses are found besides, in damping ratios of it."""

HIGHEST_DAMPING_RATIO = math.sqrt(0.5)
"""Damping ratio above which the response of an oscillator has no peak over frequency."""

_ACROSS = 1e-6
"""Square of the motion across the axis over that along it, up to which it is none."""

_UNDAMPED = 1e-9
"""Damping ratio up to which a mode has no finite response at its critical speed, to rounding."""

_EVALUATIONS = 12
_WIDE, _NARROWED = 0.02, 8
"""A quarter of the range in which a resonance is sought first, as a part of its speed, and times that it is narrowed to
a quarter about the largest motion, until its points are closer than an eighth of the width of the resonance."""

_WIDEST = 0.1


@dataclass(frozen=True, eq=False)
class CriticalSpeed:
    """A speed at which an order meets a mode.

    Attributes
    ----------
    order : float
        Oscillations for each turn of the system.
    speed : float
        Speed of the system [rad/s].
    eigenvalue : complex
        Eigenvalue of the mode there [1/s]; its imaginary part is order times speed.
    whirl : float
        Direction in which the places of turning bodies go round: 1 with their spin on circles, -1 against it, 0 in a
        plane. NaN where no turning body moves across its axis.
    mode : int
        Undamped mode, from 0 on, that the mode is nearest to where its track begins.
    """

    order: float
    speed: float
    eigenvalue: complex
    whirl: float
    mode: int

    @property
    def damping_ratio(self) -> float:
        """-real part over magnitude."""
        return -self.eigenvalue.real / abs(self.eigenvalue)

    @property
    def resonates(self) -> bool:
        """Tell whether the response to the order has a peak there."""
        return self.damping_ratio <= HIGHEST_DAMPING_RATIO


@dataclass(frozen=True, eq=False)
class OrderResponse:
    """Response to all loads of an order over speed.

    Attributes
    ----------
    order : float
        Oscillations for each turn of the system.
    names : tuple of str
        Names of the loads.
    motion : array, shape (speeds, n), complex
        Amplitudes of the coordinates [m or rad]: q = Re[motion exp(i order angle)].
    forces : array, shape (speeds, elements, 2), complex
        Amplitudes of the forces along y and z of each element in its first port [N].
    lifting : array, shape (speeds, bearings, 2)
        Dynamic and static load that decide whether contacts of each bearing lift off, see `mbs.linearised.validity`
        [N].
    lifted : tuple of tuple of str, (speeds, bearings)
        What they are loads of.
    speeds : array, shape (speeds,), or None
        Speeds [rad/s], where they are the response's own.
    drawn_speeds, drawn_forces : array, shapes (d,), (d, elements, 2)
        Rising speeds that lie close together [rad/s], and the forces there [N], for figures: between the speeds the
        dynamic stiffness is linear in the speed. Empty where none were asked for.
    """

    order: float
    names: tuple[str, ...]
    motion: ComplexArray
    forces: ComplexArray
    lifting: FloatArray
    lifted: tuple[tuple[str, ...], ...]
    speeds: FloatArray | None = None
    drawn_speeds: FloatArray = field(default_factory=lambda: np.zeros(0))
    drawn_forces: ComplexArray = field(default_factory=lambda: np.zeros((0, 0, 2), dtype=np.complex128))


def critical_speeds(
    system_at: Callable[[float], System],
    speeds: FloatArray,
    damped: ComplexSweep,
    orders: Sequence[float],
    cage_angles: int = 1,
) -> tuple[CriticalSpeed, ...]:
    """Find the critical speeds between the speeds of a sweep.

    Parameters
    ----------
    system_at : callable
        System at a speed [rad/s].
    speeds : array, shape (speeds,)
        Speeds of the sweep, rising [rad/s].
    damped : ComplexSweep
        Complex modes of the sweep.
    orders : sequence of float
        Positive orders.
    cage_angles : int
        Cage angles over which stiffness and damping are averaged, those of the sweep.

    Returns
    -------
    tuple of CriticalSpeed
        Critical speeds in rising order, for each order in turn. A mode that is overdamped at an end of a step of the
        sweep has none in it, and one whose damping ratio is above `HIGHEST_DAMPING_RATIO` has none at all.

    Raises
    ------
    AnalysisError
        If there is no equilibrium at a speed.
    """

    def balance_at(speed: float) -> Equilibrium:
        return mean_equilibrium(system_at(speed), Operation(speed), cage_angles)

    critical = []
    for order in sorted(orders):
        apart = damped.eigenvalues.imag - order * speeds[:, None]
        here: list[CriticalSpeed] = []
        for mode in range(apart.shape[1]):
            for index in range(speeds.size - 1):
                ends = apart[index : index + 2, mode]
                if not np.all(np.isfinite(ends)) or ends[0] * ends[1] > 0.0 or (ends[1] == 0.0 and ends[0] != 0.0):
                    continue
                values = damped.eigenvalues[index : index + 2, mode].tolist()
                span, number = (speeds[index], speeds[index + 1]), int(damped.number[mode])
                one = _refined(balance_at, span, values, order, number)
                if taken := [other for other in here if abs(one.speed - other.speed) <= 10.0 * CLOSE * one.speed]:
                    # coarse speeds led two modes that lie close together to the same one
                    one = _refined(balance_at, span, values, order, number, [other.eigenvalue for other in taken])
                here.append(one)
        critical += sorted((one for one in here if one.resonates), key=lambda entry: entry.speed)
    return tuple(critical)


def order_responses(
    system_at: Callable[[float], System], speeds: FloatArray, cage_angles: int = 1, drawn: int = 0
) -> tuple[OrderResponse, ...]:
    """Respond to the loads of a system that follow its angle, at each speed.

    Parameters
    ----------
    system_at : callable
        System at a speed [rad/s].
    speeds : array, shape (speeds,)
        [rad/s].
    cage_angles : int
        Cage angles over which stiffness and damping are averaged.
    drawn : int
        Number of parts of the range of speeds at whose ends forces are found for figures; none for 0.

    Returns
    -------
    tuple of OrderResponse
        One for each order, of loads that may differ in what they are.

    Raises
    ------
    AnalysisError
        If there is no equilibrium at a speed.
    """
    motions: dict[float, list[ComplexArray]] = {}
    forces: dict[float, list[ComplexArray]] = {}
    lifts: dict[float, list[list[tuple[float, float]]]] = {}
    lifted: list[tuple[str, ...]] = []
    names: dict[float, dict[str, None]] = {}
    curves: dict[float, list[tuple[float, ComplexArray]]] = {}
    before: Equilibrium | None = None
    for speed in speeds.tolist():
        start = None if before is None else before.displacement
        balance = mean_equilibrium(system_at(speed), Operation(speed), cage_angles, start)
        system = balance.system
        rules = [(index, lifting(balance, index)) for index in system.select(OnRings)]
        lifted.append(tuple(rule.of for _, rule in rules))
        for order in _orders(system):
            loads = [load for load in system.turning if abs(load.order) == order]
            moved, felt = _answer([(1.0, balance)], order, speed)
            if drawn:
                curve = curves.setdefault(order, [])
                if before is not None:
                    curve += _between(before, balance, order, (speeds[-1] - speeds[0]) / drawn)
                curve.append((speed, _across_axis(felt)))
            motions.setdefault(order, []).append(moved)
            forces.setdefault(order, []).append(_across_axis(felt))
            lifts.setdefault(order, []).append([rule.worst(felt[index]) for index, rule in rules])
            names.setdefault(order, {}).update(dict.fromkeys(name for load in loads for name in load.names))
        before = balance
    return tuple(
        OrderResponse(
            order,
            tuple(names[order]),
            np.array(motions[order]),
            np.array(forces[order]),
            np.array(lifts[order]).reshape(len(lifted), -1, 2),
            tuple(lifted),
            None,
            np.array([speed for speed, _ in curves.get(order, [])]),
            np.array([np.zeros_like(forces[order][0]), *(force for _, force in curves.get(order, []))])[1:],
        )
        for order in motions
    )


def _across_axis(felt: Sequence[ComplexArray]) -> ComplexArray:
    """Forces of all elements along y and z, (elements, 2)."""
    return np.array([force[1:3] for force in felt]).reshape(-1, 2)


def _between(
    before: Equilibrium, after: Equilibrium, order: float, step: float
) -> Iterator[tuple[float, ComplexArray]]:
    """Speeds at most a step apart between those of two equilibria, and the forces of an order there."""
    low, high = before.operation.speed, after.operation.speed
    parts = math.ceil((high - low) / step)
    for k in range(1, parts):
        share = k / parts
        speed = low + share * (high - low)
        yield speed, _across_axis(_answer([(1.0 - share, before), (share, after)], order, speed)[1])


def orders(system: System) -> tuple[float, ...]:
    """Orders for which speeds may be critical: of loads that turn, else spins of bodies; and of bearings that deviate.

    Parameters
    ----------
    system : System
        The system.
    """
    found = turning_orders(system)
    for entry in system.elements:
        if isinstance(entry.element, OnRings) and (data := entry.element.deviation_data) is not None:
            found |= {round(order, 9) for order in data.named_orders().values()}
    return tuple(sorted(found))


def turning_orders(system: System) -> set[float]:
    """Orders of the loads that turn, else the spins of the bodies.

    Parameters
    ----------
    system : System
        The system.
    """
    found = {abs(load.order) for load in system.turning} or {abs(body.spin) for body in system.bodies if body.spin}
    return {order for order in found if math.isfinite(order)}


def _orders(system: System) -> list[float]:
    """Orders of the loads that turn, rising."""
    return sorted({abs(load.order) for load in system.turning})


def _answer(
    parts: Sequence[tuple[float, Equilibrium]], order: float, speed: float
) -> tuple[ComplexArray, list[ComplexArray]]:
    """Motion (n,) by all loads of an order, and forces of all elements, of a dynamic stiffness that has parts."""
    loads = [load for load in parts[0][1].system.turning if abs(load.order) == order]
    size = np.sum([load.amplitude(speed) for load in loads], axis=0)
    rate = np.array([1j * order * speed])
    matrix = np.sum([share * dynamic_stiffness(balance, rate)[0] for share, balance in parts], axis=0)
    moved = np.linalg.solve(matrix, size)
    felt = [[share * force for force in _forces(balance, rate, moved)] for share, balance in parts]
    return moved, [np.sum(each, axis=0) for each in zip(*felt, strict=True)]


def responses_between(
    balances: Sequence[Equilibrium], speeds: FloatArray, crossings: Sequence[tuple[float, float, float]]
) -> tuple[OrderResponse, ...]:
    """Respond to the loads that turn by equilibria at few speeds: what lies between them is linear in the speed.

    That is exact of inertia and gyroscopic terms. Loads that lift contacts off are not looked at.

    Parameters
    ----------
    balances : sequence of Equilibrium
        Equilibria at rising speeds.
    speeds : array, shape (speeds,)
        Speeds between the first and the last of them [rad/s].
    crossings : sequence of (float, float, float)
        Orders, speeds [rad/s] and damping ratios about which a resonance is sought: the largest motion there is one
        speed more.

    Returns
    -------
    tuple of OrderResponse
        One for each order; each has speeds of its own, in no order.
    """
    known = np.array([balance.operation.speed for balance in balances])

    def answer(order: float, speed: float) -> tuple[ComplexArray, list[ComplexArray]]:
        shares = [float(np.interp(speed, known, row)) for row in np.eye(known.size)]
        there = [(share, balance) for share, balance in zip(shares, balances, strict=True) if share]
        return _answer(there, order, speed)

    responses = []
    for order in _orders(balances[0].system):
        found = [(speed, *answer(order, speed)) for speed in speeds.tolist()]
        for crossing, ratio in ((speed, ratio) for of, speed, ratio in crossings if of == order):
            place, wide = crossing, _WIDE
            for _ in range(_NARROWED):
                tried = np.clip(place * (1.0 + wide * np.array(AROUND)), known[0], known[-1])
                around = [(speed, *answer(order, speed)) for speed in np.unique(tried).tolist()]
                best = max(around, key=lambda one: float(np.linalg.norm(one[1])))
                place, wide = best[0], 0.25 * wide
                if wide < 0.25 * ratio:
                    break
            found.append(best)
        motion = np.array([moved for _, moved, _ in found])
        forces = np.array([_across_axis(felt) for _, _, felt in found])
        at = np.array([speed for speed, _, _ in found])
        responses.append(OrderResponse(order, (), motion, forces, np.zeros((len(found), 0, 2)), (), at))
    return tuple(responses)


def with_critical(speeds: FloatArray, found: Sequence[CriticalSpeed], turning: Collection[float]) -> FloatArray:
    """The speeds and each critical one that is lightly damped, with some around it for loads, rising [rad/s].

    Parameters
    ----------
    speeds : array, shape (speeds,)
        Rising [rad/s].
    found : sequence of CriticalSpeed
        Critical speeds between them.
    turning : collection of float
        Orders of loads, whose responses are drawn over speed.
    """
    added = [
        entry.speed * (1.0 + min(entry.damping_ratio, _WIDEST) * part)
        for entry in found
        for part in (AROUND if entry.order in turning else (0.0,))
        if entry.damping_ratio > _UNDAMPED
    ]
    inside = [speed for speed in added if speeds[0] < speed < speeds[-1]]
    return np.asarray(np.unique(np.concatenate([speeds, inside])))


def orbit(along_y: ComplexArray, along_z: ComplexArray) -> tuple[FloatArray, FloatArray]:
    """Semi-axes of the ellipse that two complex amplitudes make.

    Parameters
    ----------
    along_y, along_z : array
        Amplitudes of both directions, of one shape.

    Returns
    -------
    major, minor : array
        Semi-axes; the minor one is negative where the motion goes from z to y.
    """
    ahead, back = 0.5 * np.abs(along_y + 1j * along_z), 0.5 * np.abs(along_y - 1j * along_z)
    return np.asarray(ahead + back), np.asarray(ahead - back)


def _refined(
    balance_at: Callable[[float], Equilibrium],
    ends: tuple[float, float],
    values: Sequence[complex],
    order: float,
    number: int,
    taken: Sequence[complex] = (),
) -> CriticalSpeed:
    """Find a critical speed between two speeds by the false position (Illinois), on the mode between their values.

    Modes that are nearest to eigenvalues that are `taken` are others.
    """
    low, high = ends
    low_value, high_value = values
    low_apart, high_apart = (value.imag - order * speed for value, speed in zip(values, ends, strict=True))
    for _ in range(_EVALUATIONS):
        part = low_apart / (low_apart - high_apart) if low_apart != high_apart else 0.5
        speed = low + part * (high - low)
        point = solve_modes(balance_at(speed))
        guess = low_value + (high_value - low_value) * (speed - ends[0]) / (ends[1] - ends[0])
        apart_from = np.abs(point.damped.eigenvalues - guess)
        apart_from[[int(np.argmin(np.abs(point.damped.eigenvalues - other))) for other in taken]] = np.inf
        which = int(np.argmin(apart_from))
        value = complex(point.damped.eigenvalues[which])
        apart = value.imag - order * speed
        if abs(apart) <= CLOSE * abs(value):
            break
        if apart * high_apart < 0.0:
            low, low_apart = high, high_apart
        else:
            low_apart *= 0.5
        high, high_apart = speed, apart
    return CriticalSpeed(order, speed, value, _whirl(point, which), number)


def _whirl(point: Point, which: int) -> float:
    """Roundness of the orbits of places of turning bodies in a complex mode, and whether with their spin."""
    system = point.balance.system
    shape = point.states.right[: system.size, point.kept[which]]
    area = size = along = 0.0
    for place, spin in turning_places(system):
        x, y, z = system.relative(place)[:3] @ shape
        area += math.copysign(2.0, spin) * (y * z.conjugate()).imag
        size += abs(y) ** 2 + abs(z) ** 2
        along += abs(x) ** 2
    return float(area / size) if size > _ACROSS * along else math.nan


def turning_places(system: System) -> list[tuple[str, float]]:
    """All frames of bodies that spin, each with the spin of its body.

    Parameters
    ----------
    system : System
        The system.
    """
    return [
        (f"{body.name}:{frame}", body.spin)
        for body in system.bodies
        if body.spin
        for frame in body.frames
        if frame != "centre" or len(body.frames) == 1
    ]


def _forces(balance: Equilibrium, rate: ComplexArray, moved: ComplexArray) -> list[ComplexArray]:
    """Amplitudes of the forces of all elements in their first ports, (6,) each."""
    return [
        -(element_dynamic_stiffness(balance, index, rate)[0] @ (connected.transform @ moved))[:6]
        for index, connected in enumerate(balance.system.elements)
    ]
