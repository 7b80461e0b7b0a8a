"""The linearised system over speed: equilibrium, modes, bearing stiffness and damping, frequency responses.

At each speed the equilibrium is found from that of the last one, at a fixed angle, which is a fixed cage angle, or at
several, whose stiffness and damping are averaged. Modes are solved there twice: undamped, because the film of a lightly
loaded bearing damps so strongly that its complex modes become overdamped, and complex with all of damping and
gyroscopic terms. Each mode is followed from speed to speed by its shape (`mbs.linearised.tracking`); where two speeds
are too far apart for that, speeds between them are solved too, for the following only. Where damped modes cross,
undamped ones are followed straight on too (`mbs.linearised.sweep_result`). Gear meshes count with their mean stiffness.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from ehdmaps.arrays import ComplexArray, FloatArray, IntArray
from ehdmaps.errors import AnalysisError, Problems
from mbs.linearised.averaged import AveragedEquilibrium, PitchSpread, mean_equilibrium, pitch_spread
from mbs.linearised.bands import film_share, law_bands, with_reduction
from mbs.linearised.dynamic import LostMode
from mbs.linearised.linear import checked_response, peak_places, responses, with_peaks
from mbs.linearised.mode_part import ModePart
from mbs.linearised.modes import StateModes, UndampedModes, energy_shares, state_modes, undamped_modes
from mbs.linearised.reduction import reduction_part, undamped_part
from mbs.linearised.sweep_result import BearingSweep, ComplexSweep, ResponseSweep, Sweep, UndampedSweep, straightened
from mbs.linearised.tracking import Match, ModeSet, compose, match, numbers, tracks
from mbs.linearised.validity import DynamicLoad, dynamic_loads
from mbs.model.elements import Input, OnRings, Operation, Sensor
from mbs.model.equilibrium import Equilibrium
from mbs.model.on_rings import ring_matrices
from mbs.model.system import System
from mbs.settings import MOST_ANGLES, MOST_SPEEDS

__all__ = ["Sweep", "sweep"]


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
        """True where every mode is surely followed."""
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
    # Squares of the parts that undamped modes have in complex ones, in rows that sum to 1.
    kinship = np.abs((undamped.shapes.T @ system.mass @ shapes).T) ** 2
    kinship = kinship / np.maximum(kinship.sum(axis=1, keepdims=True), 1e-300)
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
        kinship,
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
    """Indices of the parts of the stiffness that are bearings, shape (bearings,)."""
    bearings = {balance.system.elements[index].element.name for index in balance.system.select(OnRings)}
    return np.array([index for index, name in enumerate(balance.parts) if name in bearings], dtype=np.int64)


def along_load(balance: Equilibrium) -> FloatArray:
    """Force [N] of each bearing, its stiffness [N/m] and damping [N s/m] along that force, shape (3, bearings).

    Rollers that are bodies follow in equilibrium. NaN for stiffness and damping of a bearing without force.
    """
    rows = []
    for index in balance.system.select(OnRings):
        radial = balance.forces[index][1:3]
        load = float(np.linalg.norm(radial))
        direction = np.array([0.0, *(radial / load if load > 0.0 else radial * np.nan), 0.0, 0.0, 0.0])
        stiffness, damping = ring_matrices(balance.element_stiffness[index], balance.element_damping[index])
        rows.append([load, direction @ stiffness @ direction, direction @ damping @ direction])
    return np.array(rows).reshape(-1, 3).T


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


FEWEST_BETWEEN = 16
"""Speeds that may be put in between, however few are asked for."""

MOST_RESPONSES = 10_000_000
"""Speeds times frequencies times inputs times sensors."""


def sweep(
    system: System | Callable[[float], System],
    speeds: FloatArray,
    angle: float = 0.0,
    inputs: Sequence[Input] = (),
    sensors: Sequence[Sensor] = (),
    frequencies: FloatArray | Sequence[float] = (),
    cage_angles: int = 1,
) -> Sweep:
    """Equilibria, modes, bearings and frequency responses over speed.

    Parameters
    ----------
    system : System, or callable
        Bodies, springs, loads, elements; or the system at a speed [rad/s], all with the same coordinates.
    speeds : array, shape (speeds,)
        [rad/s], at least one.
    angle : float
        What the system has turned [rad]: where the cages stand.
    inputs, sensors : sequence
        Inputs and sensors of the responses; no responses if left out.
    frequencies : array, shape (frequencies,)
        Frequencies of the responses [Hz].
    cage_angles : int
        Angles within one pitch of the rollers over which stiffness and damping of the bearings are averaged, for
        modes and responses too; the displacement is that of the first.

    Raises
    ------
    InputError
        For missing speeds or frequencies, or more responses than memory should hold.
    AnalysisError
        If there is no equilibrium at a speed.
    """
    speeds = np.atleast_1d(np.asarray(speeds, dtype=np.float64))
    frequencies = np.asarray(frequencies, dtype=np.float64)
    _check(speeds, frequencies, len(inputs) * len(sensors), cage_angles)

    def at(speed: float, start: FloatArray | None) -> Point:
        there = system if isinstance(system, System) else system(speed)
        try:
            return solve_modes(mean_equilibrium(there, Operation(speed, angle), cage_angles, start))
        except AnalysisError as error:
            raise AnalysisError(f"at {speed:.6g} rad/s: {error}") from error

    points: list[_Recorded] = []
    links: list[Along] = []
    values = np.empty((speeds.size, frequencies.size, len(sensors), len(inputs)), dtype=np.complex128)
    errors = np.zeros(speeds.size)
    peaks: list[list[FloatArray]] = []
    lifted: list[tuple[DynamicLoad, ...]] = []
    # Speeds in between cost as much as others: together at most as many as were asked for.
    spare = max(speeds.size, FEWEST_BETWEEN)
    first = before = at(float(speeds[0]), None)
    for index, speed in enumerate(speeds.tolist()):
        point = at(speed, before.balance.displacement) if index else first
        if index:
            links.append(bridge(before, point, at, spare))
            spare -= links[-1].between
        axis = with_peaks(frequencies, point.damped.eigenvalues)
        there, errors[index] = checked_response(point.balance, point.states, inputs, sensors, axis)
        values[index] = there[np.searchsorted(axis, frequencies)]
        peaks.append(_peaks(axis, np.abs(there)))
        lifted.append(_lifted(point, inputs, frequencies, peaks[-1]))
        points.append(_record(point))
        before = point
    peak_frequency, peak_size = _padded(peaks, values)
    return Sweep(
        speeds=speeds,
        displacement=np.array([point.displacement for point in points]),
        forces=tuple(np.array(part) for part in zip(*(point.forces for point in points), strict=True)),
        outside={name: np.array([point.outside[name] for point in points]) for name in first.balance.outside},
        parts=tuple(first.balance.parts),
        undamped=straightened(_undamped(points, links, first, before)),
        damped=_damped(points, links, bearing_parts(first.balance)),
        bearings=_bearings(points, first),
        responses=ResponseSweep(frequencies, tuple(inputs), tuple(sensors), values, peak_frequency, peak_size, errors),
        between=sum(link.between for link in links),
        lifted=tuple(lifted),
        film_share=film_share(*np.hstack([[point.by_films[1], point.complex_errors[1]] for point in points])),
    )


@dataclass(frozen=True, eq=False)
class _Recorded:
    """Values kept of a speed, without the vectors of its modes."""

    displacement: FloatArray
    forces: tuple[FloatArray, ...]
    outside: dict[str, bool]
    frequency: FloatArray
    damping_ratio: FloatArray
    shares: FloatArray
    eigenvalues: ComplexArray
    complex_shares: FloatArray
    whirl: FloatArray
    bearings: FloatArray
    kinship: FloatArray
    lost: tuple[LostMode, ...]
    frequency_error: FloatArray
    complex_errors: FloatArray
    bearing_errors: FloatArray
    by_films: FloatArray
    reduction: FloatArray
    spread: PitchSpread


def _record(point: Point) -> _Recorded:
    """Keep the light part of a point."""
    over = point.balance.over if isinstance(point.balance, AveragedEquilibrium) else (point.balance,)
    n, kept, states = point.balance.system.size, point.kept, point.states
    return _Recorded(
        point.balance.displacement,
        point.balance.forces,
        point.balance.outside,
        point.undamped.frequency,
        point.undamped.damping_ratio,
        point.undamped.shares,
        point.damped.eigenvalues,
        point.complex_shares,
        point.whirl,
        np.array([along_load(balance) for balance in over]),
        point.kinship,
        point.lost,
        *_errors(point),
        pitch_spread(
            point.balance,
            point.undamped.frequency,
            point.undamped.shapes,
            point.damped.eigenvalues,
            states.right[:n, kept],
            states.left[kept, n : 2 * n],
        ),
    )


def _errors(point: Point) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray, FloatArray]:
    """Bands of undamped frequencies (n,), complex modes (2, modes) and bearings (2, bearings), and two parts of them.

    The parts of the bands of complex modes are those by films, and what bodies leave out, (2, modes) each. NaN if
    unknown.
    """
    n, kept, states, system = point.balance.system.size, point.kept, point.states, point.balance.system
    laws = law_bands(point.balance)
    vectors = states.right[:n, kept], states.left[kept, n : 2 * n]
    reduction = reduction_part(system, point.damped.eigenvalues, *vectors)
    parts = np.full((2, kept.size), np.nan) if reduction is None else np.array(reduction)
    if laws is None:
        shape = (2, bearing_parts(point.balance).size)
        unknown = np.full((2, kept.size), np.nan)
        return np.full(n, np.nan), unknown, np.full(shape, np.nan), unknown, parts
    damped = with_reduction(laws.of_modes(point.damped.eigenvalues, *vectors), reduction)
    found = point.undamped.frequency, point.undamped.shapes
    undamped = laws.of_undamped(*found) + np.abs(undamped_part(system, *found)) * found[0]
    return undamped, np.array([damped.frequency, damped.damping_ratio]), laws.of_bearings(), damped.by_films, parts


def _peaks(axis: FloatArray, size: FloatArray) -> list[FloatArray]:
    """Frequency and size of the peaks of each response (frequencies, sensors, inputs), shape (2, peaks) each."""
    columns = size.reshape(axis.size, math.prod(size.shape[1:])).T
    return [np.array([axis[at], column[at]]) for column in columns for at in [peak_places(column)]]


def _lifted(
    point: Point, inputs: Sequence[Input], frequencies: FloatArray, peaks: Sequence[FloatArray]
) -> tuple[DynamicLoad, ...]:
    """Loads that lift contacts off, at the peaks of the responses and at the ends of the frequencies."""
    if not inputs or not frequencies.size:
        return ()
    looked = np.unique(np.concatenate([frequencies[[0, -1]], *(pairs[0] for pairs in peaks)]))
    found = dynamic_loads(point.balance, inputs, looked, responses(point.balance, inputs, looked))
    return tuple(load for load in found if load.exceeds)


def _padded(peaks: Sequence[Sequence[FloatArray]], values: ComplexArray) -> FloatArray:
    """Peaks of each speed and response of `values`, shape (2, speeds, peaks, sensors, inputs); NaN beyond the last."""
    most = max((pairs.shape[1] for row in peaks for pairs in row), default=0)
    filled = np.full((2, len(peaks), most, math.prod(values.shape[2:])), np.nan)
    for index, row in enumerate(peaks):
        for column, pairs in enumerate(row):
            filled[:, index, : pairs.shape[1], column] = pairs
    return filled.reshape(*filled.shape[:3], *values.shape[2:])


def _check(speeds: FloatArray, frequencies: FloatArray, pairs: int, cage_angles: int) -> None:
    """Raise with what is wrong about speeds and frequencies."""
    problems = Problems()
    if speeds.ndim != 1 or not 1 <= speeds.size <= MOST_SPEEDS or not np.all(np.isfinite(speeds)):
        problems.append(f"sweep, speeds: got {speeds.size} values; allowed: 1 to {MOST_SPEEDS} finite ones in a row")
    if frequencies.ndim != 1 or not np.all(np.isfinite(frequencies)) or np.any(frequencies < 0.0):
        problems.append(f"sweep, frequencies: got {frequencies.size} values; allowed: finite ones from 0 Hz on")
    if speeds.size * frequencies.size * pairs > MOST_RESPONSES:
        problems.append(
            f"sweep: got {speeds.size} speeds, {frequencies.size} frequencies and {pairs} pairs of input and sensor; "
            f"allowed: a product of at most {MOST_RESPONSES}; take fewer speeds, or fewer frequencies"
        )
    if not 1 <= cage_angles <= MOST_ANGLES:
        problems.append(f"sweep, cage angles: got {cage_angles}; allowed: a whole number from 1 to {MOST_ANGLES}")
    problems.check()


def _undamped(points: Sequence[_Recorded], links: Sequence[Along], first: Point, last: Point) -> UndampedSweep:
    """Put the undamped modes in the order of the first speed."""
    size = points[0].frequency.size
    order = tracks(size, [link.undamped for link in links])
    sure = np.ones(order.shape)
    logarithm = np.zeros(order.shape)
    for index, link in enumerate(links):
        sure[index + 1] = link.undamped.assurance[order[index]]
        logarithm[index + 1] = logarithm[index] + link.logarithm[order[index]]
    shares = np.stack([point.shares[:, row] for point, row in zip(points, order, strict=True)], axis=1)
    return UndampedSweep(
        frequency=np.array([point.frequency[row] for point, row in zip(points, order, strict=True)]),
        damping_ratio=np.array([point.damping_ratio[row] for point, row in zip(points, order, strict=True)]),
        shares=shares,
        bearing_share=shares[bearing_parts(first.balance)].sum(axis=0),
        frequency_error=np.array([point.frequency_error[row] for point, row in zip(points, order, strict=True)]),
        frequency_spread=np.array([point.spread.frequency[row] for point, row in zip(points, order, strict=True)]),
        assurance=sure,
        summed_shift=np.expm1(logarithm),
        direct_shift=first_order_shift(first, last)[0],
        resembles=np.argsort(order[-1])[match(first.shapes, last.shapes).chosen],
    )


def _damped(points: Sequence[_Recorded], links: Sequence[Along], here: IntArray) -> ComplexSweep:
    """Put the complex modes into tracks, with NaN where there is none."""
    order = tracks(points[0].eigenvalues.size, [link.damped for link in links])
    plain = tracks(points[0].frequency.size, [link.undamped for link in links])
    number = numbers(order, plain, [point.kinship for point in points])
    shape = order.shape
    values = np.full(shape, complex(np.nan, np.nan))
    whirl, sure = np.full(shape, np.nan), np.full(shape, np.nan)
    shares = np.full((points[0].complex_shares.shape[0], *shape), np.nan)
    errors, spreads, reduction = (np.full((2, *shape), np.nan) for _ in range(3))
    for index, (point, row) in enumerate(zip(points, order, strict=True)):
        there = np.nonzero(row >= 0)[0]
        values[index, there] = point.eigenvalues[row[there]]
        whirl[index, there] = point.whirl[row[there]]
        shares[:, index, there] = point.complex_shares[:, row[there]]
        errors[:, index, there] = point.complex_errors[:, row[there]]
        reduction[:, index, there] = point.reduction[:, row[there]]
        spreads[0, index, there] = point.spread.complex_frequency[row[there]]
        spreads[1, index, there] = point.spread.complex_damping_ratio[row[there]]
        sure[index, there] = 1.0
        if index:
            old = there[order[index - 1, there] >= 0]
            sure[index, old] = links[index - 1].damped.assurance[order[index - 1, old]]
    lost = tuple(point.lost for point in points)
    return ComplexSweep(
        values,
        shares,
        shares[here].sum(axis=0),
        whirl,
        sure,
        number,
        errors[0],
        errors[1],
        spreads[0],
        spreads[1],
        lost,
        ModePart(*reduction),
    )


def _bearings(points: Sequence[_Recorded], first: Point) -> BearingSweep:
    """Stack the bearings."""
    parts = list(first.balance.parts)
    names = tuple(parts[index] for index in bearing_parts(first.balance))
    values = np.array([point.bearings for point in points])
    load, stiffness, damping = np.moveaxis(values.mean(axis=1), 1, 0)
    half = 0.5 * np.ptp(values, axis=1)
    spread = np.divide(half, values.mean(axis=1), out=np.zeros_like(half), where=half != 0.0)
    errors = np.moveaxis(np.array([point.bearing_errors for point in points]), 1, 0)
    return BearingSweep(
        names, load, stiffness, damping, spread[:, 1], spread[:, 2], values.shape[1], errors[0], errors[1]
    )
