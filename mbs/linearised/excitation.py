"""Bearings that excite their machine: the orders of their deviations and of the passing of their rolling elements.

A deviation adds e to the approach of a contact. To first order the force on the inner ring is G(psi, s) e, with psi the
angle of the rolling element and s = i w of e in the cage; at a held place of the rings G is periodic in psi,

    G = sum_q g_q exp(i q psi),

so that n waves of a ring, which turns by f_r where the cage turns by f_c, make on Z elements forces of the orders

    k Z f_c - n f_r,    with the coefficient g_q of q = k Z - n.

Of a bearing whose elements carry alike q is 1 and -1 alone: n = k Z +- 1. n waves of an element have the orders
q f_c + n f_b, with f_b of its own turns, and an element of another size q f_c. What the perfect bearing makes by
itself, its variable compliance, is the force at a held place as its elements pass: k Z f_c. The machine answers by its
mean stiffness: products of two deviations, and of one with the passing of elements, are of second order and left out.
Rollers that are bodies follow in balance.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from ehdmaps.arrays import ComplexArray, FloatArray, IntArray
from mbs.linearised.averaged import mean_equilibrium
from mbs.linearised.dynamic import dynamic_stiffness
from mbs.linearised.linear import sensor_matrix
from mbs.model.elements import OnRings, Operation, Sensor
from mbs.model.equilibrium import Equilibrium
from mbs.model.system import System

POSITIONS = 8
"""Places of the cage within a pitch."""

MOST_LINES = 24
"""Lines of a machine that are kept: those with the largest forces."""

_LEAST, _MOST_HARMONICS = 1e-4, 200
"""Force of a line by the largest of its bearing, and size of a harmonic by the largest of its table, below which they
are left out; harmonics of a table."""

_STEP, _RATE = 1e-9, 1e-6
"""Approach [m] and rate [m/s] by which forces of dry contacts are differentiated."""

SOURCES = ("inner ring", "outer ring", "elements", "sizes", "passing")
"""What excites: deviations of rings and elements, and the passing of the elements of a perfect bearing."""


class Line(NamedTuple):
    """A line of the excitation by a bearing.

    Attributes
    ----------
    bearing, source : str
        Name of the bearing, and which of `SOURCES` it is.
    name : str
        Order in words, such as 1 BPFI +1.
    order : float
        Oscillations for each turn of the system, > 0.
    """

    bearing: str
    source: str
    name: str
    order: float


@dataclass(frozen=True, eq=False)
class Excited:
    """Lines over speed: force F, sensor signal y, Re[F exp(i order angle)].

    Attributes
    ----------
    lines : tuple of Line
        The lines.
    speeds : array (speeds,)
        [rad/s].
    forces : array (speeds, lines, 6), complex
        Force on the inner ring of the bearing at held places [N], [N m].
    seen : array (speeds, lines, sensors), complex
        Signals of the sensors.
    """

    lines: tuple[Line, ...]
    speeds: FloatArray
    forces: ComplexArray
    seen: ComplexArray


def excited(
    system_at: Callable[[float], System], speeds: Sequence[float], sensors: Sequence[Sensor], cage_angles: int = 1
) -> Excited | None:
    """Find the lines of all bearings with deviations over speed; None without such bearings.

    Parameters
    ----------
    system_at : callable
        System at a speed [rad/s].
    speeds : sequence of float
        [rad/s]; lines are those with the largest forces at any of them.
    sensors : sequence of Sensor
        What is seen.
    cage_angles : int
        Cage angles over which the stiffness of the machine is averaged.

    Raises
    ------
    AnalysisError
        If there is no equilibrium at a speed.
    """
    if not any(_deviates(entry.element) for entry in system_at(float(speeds[0])).elements):
        return None
    balances: list[Equilibrium] = []
    for speed in map(float, speeds):
        start = balances[-1].displacement if balances else None
        balances.append(mean_equilibrium(system_at(speed), Operation(speed), cage_angles, start))
    return excited_at(balances, sensors)


def excited_at(balances: Sequence[Equilibrium], sensors: Sequence[Sensor]) -> Excited | None:
    """Find the lines of all bearings with deviations at some equilibria; None without such bearings, and at rest.

    Parameters
    ----------
    balances : sequence of Equilibrium
        Equilibria of one machine, one a speed.
    sensors : sequence of Sensor
        What is seen.
    """
    found = [lines_of(balance) for balance in balances]
    largest: dict[Line, float] = {}
    for each in found:
        for line, force in each.items():
            largest[line] = max(largest.get(line, 0.0), float(np.linalg.norm(force[:3])))
    if not largest:
        return None
    kept = sorted(sorted(largest, key=lambda line: -largest[line])[:MOST_LINES], key=lambda line: (line.order, line))
    nothing = np.zeros(6, dtype=np.complex128)
    forces = np.array([[each.get(line, nothing) for line in kept] for each in found]).reshape(len(found), -1, 6)
    seen = [_seen(balance, kept, force, sensors) for balance, force in zip(balances, forces, strict=True)]
    speeds = np.array([balance.operation.speed for balance in balances])
    return Excited(tuple(kept), speeds, forces, np.array(seen))


def _deviates(element: Any) -> bool:
    """Tell whether an element is a bearing with deviations."""
    return isinstance(element, OnRings) and element.deviation_data is not None


def _seen(balance: Equilibrium, lines: Sequence[Line], forces: ComplexArray, sensors: Sequence[Sensor]) -> ComplexArray:
    """Signals of the sensors by each line, (lines, sensors)."""
    elements: list[Any] = [getattr(entry.element, "plain", entry.element) for entry in balance.system.elements]
    places = {element.name: element for element in elements}
    rate = 1j * np.array([line.order for line in lines]) * balance.operation.speed
    loads = [
        balance.system.relative(places[line.bearing].inner, places[line.bearing].outer).T @ force
        for line, force in zip(lines, forces, strict=True)
    ]
    motion = np.linalg.solve(dynamic_stiffness(balance, rate), np.array(loads)[..., None])[..., 0]
    orders = np.array([sensor.order for sensor in sensors], dtype=np.int64)
    return np.asarray((motion @ sensor_matrix(balance, sensors).T) * rate[:, None] ** orders)


def lines_of(balance: Equilibrium) -> dict[Line, ComplexArray]:
    """Forces (6,) on the inner rings of all bearings with deviations, line by line.

    Parameters
    ----------
    balance : Equilibrium
        Equilibrium of the machine, at whose places of the rings they are.
    """
    found: dict[Line, ComplexArray] = {}
    for entry in balance.system.elements:
        if not _deviates(entry.element) or balance.operation.speed == 0.0:
            continue
        # rollers that are bodies follow in balance
        element: Any = getattr(entry.element, "plain", entry.element)
        moved = balance.system.relative(element.inner, element.outer) @ balance.displacement
        own = _Bearing(element, moved, balance.operation).lines()
        largest = max((float(np.linalg.norm(force[:3])) for force in own.values()), default=0.0)
        found |= {line: f for line, f in own.items() if float(np.linalg.norm(f[:3])) > _LEAST * largest}
    return found


class _Bearing:
    """A bearing at a place of its rings, with its cage at several angles within a pitch."""

    def __init__(self, element: Any, displacement: FloatArray, operation: Operation) -> None:
        self._data, self._displacement, self._operation = element.deviation_data, displacement, operation
        self._places = self._data.given("places") * (2.0 * math.pi / self._data.nodes)
        self._name, places = element.name, self._places
        self._cage, self._rings, self._own = self._data.turns[0], self._data.turns[1:3], self._data.turns[3]
        self._count = int(np.unique(np.round(np.cos(places) + 1j * np.sin(places), 9)).size)
        # the pitch of a row, by what `passed` takes for it
        pitch = 2.0 * math.pi / self._count / abs(element.passed(1.0).start_angle - element.start_angle)
        self._passed = [element.passed(pitch * m / POSITIONS) for m in range(POSITIONS)]
        turn = math.copysign(2.0 * math.pi / self._count, self._cage) * np.arange(POSITIONS) / POSITIONS
        start = self._data.start + self._cage * operation.angle
        self._angles = start + turn[:, None] + places[: self._count]
        self._most = self._count * POSITIONS // 2 - 1
        q = np.arange(-self._most, self._most + 1)
        self._to_orders = np.exp(-1j * q[:, None] * self._angles.ravel()) / self._angles.size
        self._found: dict[Line, ComplexArray] = {}

    def lines(self) -> dict[Line, ComplexArray]:
        """Find all lines."""
        tables = self._data.given("tables")
        for side in (0, 1):
            if tables[0, side] >= 0:
                self._add_ring(side, int(tables[0, side]))
        if np.any(tables[:, 2] >= 0):
            self._add_elements(tables[:, 2])
        sizes = self._data.given("sizes")
        if np.any(sizes):
            spectrum = self._coefficients(np.zeros(1))[0].sum(axis=2)
            for j in np.flatnonzero(sizes).tolist():
                self._add_element(j, 0, sizes[j] * spectrum[:, j // self._count], "sizes")
        self._add_passing()
        return self._found

    def _coefficients(self, turns: Any) -> ComplexArray:
        """Coefficients g_q at rates of e by turns of the system, (k, 2 most + 1, rows, 2, 6)."""
        s = np.asarray(1j * turns * self._operation.speed, dtype=np.complex128)
        response = np.stack([_by_approach(one, self._displacement, self._operation, s) for one in self._passed])
        by_row = response.reshape(POSITIONS, s.size, -1, self._count, 2, 6)
        flat = np.moveaxis(by_row, (0, 3), (1, 2)).reshape(s.size, self._angles.size, -1)
        return np.asarray(np.matmul(self._to_orders, flat).reshape(s.size, self._to_orders.shape[0], -1, 2, 6))

    def _harmonics(self, values: FloatArray) -> tuple[IntArray, ComplexArray]:
        """Numbers and amplitudes of the waves of a table, Re[c exp(i n angle)], those that matter."""
        found = 2.0 * np.fft.rfft(values) / values.size
        found[0] *= 0.5
        size = np.abs(found[:-1])
        kept = np.flatnonzero(size > max(_LEAST * size.max(), np.sort(size)[-min(_MOST_HARMONICS, size.size)] * 0.999))
        return np.asarray(kept, dtype=np.int64), found[kept]

    def _add(self, source: str, name: str, order: float, force: ComplexArray) -> None:
        """Add the force of a line, turned so that its order is positive."""
        if abs(order) < 1e-9:
            return
        line = Line(self._name, source, name, round(abs(order), 9))
        self._found[line] = self._found.get(line, 0.0) + (force if order > 0.0 else force.conj())

    def _add_ring(self, side: int, table: int) -> None:
        """Add the waves of a ring."""
        waves, amplitudes = self._harmonics(self._data.given("table")[table, :, 0])
        ring, passing = self._rings[side], self._cage - self._rings[side]
        spectrum = self._coefficients(waves * passing)[..., side, :].sum(axis=2)
        for n, amplitude, by_order in zip(waves.tolist(), amplitudes, spectrum, strict=True):
            for k in range(math.ceil((n - self._most) / self._count), (n + self._most) // self._count + 1):
                force = amplitude * self._count * by_order[k * self._count - n + self._most]
                force = force * np.exp(1j * k * self._count * self._data.start)
                order, way = k * self._count * self._cage - n * ring, math.copysign(1.0, k * passing)
                beside = -round(way * math.copysign(1.0, ring) * (n - k * self._count)) if ring else 0
                passes = f"{abs(k)} {('BPFI', 'BPFO')[side]}" if k else ""
                self._add(SOURCES[side], f"{passes}{f' {beside:+d}' if beside else ''}".strip(), order, force)

    def _add_elements(self, tables: Any) -> None:
        """Add the waves of rolling elements."""
        for table in np.unique(tables[tables >= 0]).tolist():
            waves, amplitudes = self._harmonics(self._data.given("own")[:, table, 0])
            spectrum = self._coefficients(waves * self._own)
            half = np.exp(1j * np.pi * waves)[:, None, None, None]
            both = (spectrum[..., 0, :] * half + spectrum[..., 1, :]) * amplitudes[:, None, None, None]
            for j in np.flatnonzero(tables == table).tolist():
                for n, of_wave in zip(waves.tolist(), both, strict=True):
                    self._add_element(j, n, of_wave[:, j // self._count], "elements")

    def _add_element(self, j: int, n: int, by_order: ComplexArray, source: str) -> None:
        """Add n waves of an element."""
        angle = self._data.start + self._places[j]
        for q in range(-self._most, self._most + 1):
            order, way = q * self._cage + n * self._own, round(math.copysign(1.0, self._own if n else q))
            own = f"{n} BSF " if n else ""
            name = f"{own}{way * q:+d} FTF" if n else f"{abs(q)} FTF"
            self._add(source, name if q else own.strip(), order, by_order[q + self._most] * np.exp(1j * q * angle))

    def _add_passing(self) -> None:
        """Add what the perfect bearing makes."""
        still = np.zeros(6)
        forces = np.array([one.evaluate(self._displacement, still, self._operation).force for one in self._passed])
        for k in range(1, POSITIONS // 2):
            turned = np.exp(-1j * k * self._count * (self._angles[:, 0] - self._data.start))
            name = f"{k} BPFO" if self._rings[1] == 0.0 else f"{k * self._count} FTF"
            force = 2.0 * np.mean(forces * turned[:, None], axis=0)
            self._add("passing", name, k * self._count * self._cage, force)


def _by_approach(element: Any, displacement: FloatArray, operation: Operation, s: ComplexArray) -> ComplexArray:
    """Force on the inner ring by approaches that are added to the contacts, shape (k, Z, 2, 6) [N/m]."""
    count = element.deviation_data.elements
    condensed = element.small_motions(displacement, operation)
    if condensed is not None:
        found: ComplexArray = condensed.by_approach(s, count)
        return found
    still, slopes = np.zeros(6), np.zeros((2, count, 2, 6))
    for part, step in enumerate((_STEP, _RATE)):
        for contact in np.ndindex(count, 2):
            for way in (step, -step):
                added = np.zeros((count, 2, 2))
                added[(*contact, part)] = way
                element.deviate(added)
                try:
                    slopes[(part, *contact)] += element.evaluate(displacement, still, operation).force / (2.0 * way)
                finally:
                    element.deviate(None)
    return np.asarray(slopes[0] + s[:, None, None, None] * slopes[1])
