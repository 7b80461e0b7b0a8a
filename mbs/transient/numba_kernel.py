"""Many steps of a run in compiled code: the linear part by its own inverse, Newton on the forces of the elements.

The steps are those of `mbs.transient.stepping`. Coordinates are M-orthonormal modes of the linear part, so that mass
is the unit matrix and stiffness a diagonal; damping and gyroscopic terms stay whole. With the acceleration a at the
end of a step as unknown the equation of motion is

    L a = loads - B v0 - lambda p0 + T^T f,  L = 1 + by_v B + by_q lambda,  B = D + speed G,

where T are the rows of the ports and f the forces of the elements. So the motion of the ports is linear in f, by the
receptance R = T L^-1 T^T, and Newton has as few unknowns as the elements have ports:

    f - F(x0 + by_q R f, y0 + by_v R f) = 0.

What the elements answer is compiled into the steps, for the types of their blocks (`mbs.model.blocks`).

The inverse follows the speed by its expansion to second order about a reference; the caller moves the reference
before the third order matters.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, NamedTuple, TypeVar

import numpy as np
from llvmlite import ir
from numba import types
from numba.extending import intrinsic, overload

from ehdmaps.arrays import FloatArray, IntArray
from ehdmaps.compiled import in_python, njit
from ehdmaps.copies import put
from ehdmaps.maps.kernels.lines import FAST
from mbs.model.blocks import FOUND, NO_SOLUTION, Answers, Kind, Moment
from mbs.transient.kinds import KINDS
from mbs.transient.numba_arrays import Course, Energies, Linear, Numbers, Records, State

DONE, TOO_LARGE = FOUND, 3
"""How `advance` ended, besides `NO_SOLUTION` and `IN_PYTHON`: all steps made; error above the tolerance."""

_F = TypeVar("_F")

_OPTIONS: Any = {"error_model": "numpy", "_nrt": False}
"""See `ehdmaps.compiled.njit`."""


@njit(error_model="numpy", fastmath=FAST, _nrt=False)
def _times(matrix: FloatArray, x: FloatArray, out: FloatArray) -> None:
    """Matrix times vector."""
    for i in range(matrix.shape[0]):
        row = matrix[i]
        total = 0.0
        for j in range(x.size):
            total += row[j] * x[j]
        out[i] = total


@njit(error_model="numpy", fastmath=FAST, _nrt=False)
def _expanded_times(matrices: FloatArray, by: float, x: FloatArray, out: FloatArray) -> None:
    """(M0 + by M1 + by^2 M2) times vector."""
    for i in range(matrices.shape[1]):
        r0, r1, r2 = matrices[0, i], matrices[1, i], matrices[2, i]
        t0 = t1 = t2 = 0.0
        for j in range(x.size):
            t0 += r0[j] * x[j]
            t1 += r1[j] * x[j]
            t2 += r2[j] * x[j]
        out[i] = t0 + by * (t1 + by * t2)


@njit(error_model="numpy", fastmath=FAST, _nrt=False)
def _expanded(matrices: FloatArray, by: float, out: FloatArray) -> None:
    """M0 + by M1 + by^2 M2."""
    for i in range(out.shape[0]):
        r0, r1, r2, row = matrices[0, i], matrices[1, i], matrices[2, i], out[i]
        for j in range(row.size):
            row[j] = r0[j] + by * (r1[j] + by * r2[j])


@njit(error_model="numpy", fastmath=FAST, _nrt=False)
def _size(matrix: FloatArray, x: FloatArray) -> float:
    """Root of x^T M x."""
    total = 0.0
    for i in range(x.size):
        row = matrix[i]
        part = 0.0
        for j in range(x.size):
            part += row[j] * x[j]
        total += part * x[i]
    return math.sqrt(max(total, 0.0))


@njit(error_model="numpy", fastmath=FAST, _nrt=False)
def _norm(x: FloatArray) -> float:
    """Euclidean norm."""
    total = 0.0
    for i in range(x.size):
        total += x[i] * x[i]
    return math.sqrt(total)


@njit(error_model="numpy", _nrt=False)
def eliminate(matrix: FloatArray, right: FloatArray) -> bool:
    """Gaussian elimination with partial pivoting, in place; False if singular or not finite."""
    n = right.size
    for k in range(n):
        pivot = k
        for i in range(k + 1, n):
            if abs(matrix[i, k]) > abs(matrix[pivot, k]):
                pivot = i
        if not 0.0 < abs(matrix[pivot, k]) < math.inf:
            return False
        if pivot != k:
            for j in range(k, n):
                matrix[k, j], matrix[pivot, j] = matrix[pivot, j], matrix[k, j]
            right[k], right[pivot] = right[pivot], right[k]
        inverse = 1.0 / matrix[k, k]
        upper = matrix[k]
        for i in range(k + 1, n):
            factor = matrix[i, k] * inverse
            if factor != 0.0:
                row = matrix[i]
                for j in range(k + 1, n):
                    row[j] -= factor * upper[j]
                right[i] -= factor * right[k]
    for k in range(n - 1, -1, -1):
        total = right[k]
        for j in range(k + 1, n):
            total -= matrix[k, j] * right[j]
        right[k] = total / matrix[k, k]
    return True


class Native(NamedTuple):
    """Blocks with functions in C, which steps by numba call by their addresses.

    Attributes
    ----------
    blocks : array (blocks, 4), of int
        Structs ``ehd_block``.
    at, step : array (6,), array (1,) of int
        A struct ``ehd_moment``, and its first number.
    answers : array (4,), of int
        A struct ``ehd_answers``.
    """

    blocks: IntArray
    at: FloatArray
    step: IntArray
    answers: IntArray


@intrinsic
def _address(context: Any, array: Any) -> Any:
    """Address of the numbers of an array."""

    def code(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        data = context.make_array(signature.args[0])(context, builder, arguments[0]).data
        return builder.ptrtoint(data, context.get_value_type(types.intp))

    return types.intp(array), code


@intrinsic
def _call(context: Any, function: Any, data: Any, at: Any, motion: Any, answers: Any, out: Any) -> Any:
    """Call a C function by its address; functions that take fewer arguments do not see the last ones."""

    def code(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        word = context.get_value_type(types.intp)
        kind = ir.FunctionType(ir.IntType(32), [word] * 5)
        return builder.call(builder.inttoptr(arguments[0], kind.as_pointer()), arguments[1:])

    return types.int32(*[types.intp] * 6), code


@njit(error_model="numpy", _nrt=False)
def _tell(native: Native, moment: Moment, answers: Answers) -> None:
    """Fill the structs of C."""
    native.at[1], native.at[2], native.at[3] = moment.time, moment.speed, moment.angle
    native.at[4], native.at[5], native.step[0] = moment.by_q, moment.by_v, moment.step
    native.answers[0], native.answers[1] = _address(answers.force), _address(answers.slopes)
    native.answers[2], native.answers[3] = _address(answers.outside), answers.force.size


@njit(error_model="numpy", _nrt=False)
def _native_answer(native: Native, moment: Moment, motion: FloatArray, answers: Answers) -> int:
    """Answers of blocks with functions in C; see `mbs.model.blocks.Kind`."""
    _tell(native, moment, answers)
    for row in native.blocks:
        found = _call(row[0], row[3], _address(native.at), _address(motion), _address(native.answers), 0)
        if found != FOUND:
            return int(found)
    return FOUND


@njit(error_model="numpy", _nrt=False)
def _native_accept(native: Native, moment: Moment) -> None:
    """Tell blocks with functions in C that the step is made; their structs are those of the last answer."""
    for row in native.blocks:
        if row[1] != 0:
            _call(row[1], row[3], _address(native.at), 0, 0, 0)


@njit(error_model="numpy", _nrt=False)
def _native_powers(native: Native, moment: Moment, motion: FloatArray, answers: Answers, out: FloatArray) -> None:
    """Powers of elements of blocks with functions in C."""
    for row in native.blocks:
        if row[2] != 0:
            _call(row[2], row[3], _address(native.at), _address(motion), _address(native.answers), _address(out))


def _none(*_: Any) -> Any:
    """Stand for what is not asked of this kind."""
    raise NotImplementedError


NATIVE = Kind(
    arrays=Native, answer=_native_answer, feels=_none, gather=_none, accept=_native_accept, powers=_native_powers
)
"""All blocks with functions in C, as one more block of a run by numba."""


def _kind(arrays: type) -> Any:
    """Kind of a block by the class of its arrays."""
    return {kind.arrays: kind for kind in (*KINDS.values(), NATIVE)}[arrays]


def _counted(function: _F) -> _F:
    """Function of a kind, which may make arrays where it says nothing else: one of a user's own, by `numba.njit`."""
    options = getattr(function, "targetoptions", None)  # there is none under NUMBA_DISABLE_JIT
    if options is not None:
        options.setdefault("_nrt", True)
    return function


def all_answer(blocks: tuple[Any, ...], moment: Moment, motion: FloatArray, answers: Answers) -> int:
    """Answers of all elements: each block by the function of its kind.

    Parameters
    ----------
    blocks : tuple of NamedTuple
        Arrays of all blocks.
    moment : Moment
        The step that is asked for.
    motion : array (2, m)
        What the elements feel, and its rate.
    answers : Answers
        Answers of all elements, filled.
    """
    for block in blocks:
        status: int = _kind(type(block)).answer(block, moment, motion, answers)
        if status != FOUND:
            return status
    return FOUND


@overload(all_answer, jit_options=_OPTIONS)
def _all_answer(blocks: Any, moment: Any, motion: Any, answers: Any) -> Callable[..., int]:
    """Compile for the types of some blocks: the first one, and then the rest likewise."""
    if len(blocks) == 0:

        def none(blocks: Any, moment: Any, motion: Any, answers: Any) -> int:
            return FOUND

        return none
    answer = _counted(_kind(blocks[0].instance_class).answer)

    def first_and_rest(blocks: Any, moment: Any, motion: Any, answers: Any) -> int:
        status: int = answer(blocks[0], moment, motion, answers)
        if status != FOUND:
            return status
        return all_answer(blocks[1:], moment, motion, answers)

    return first_and_rest


def all_accept(blocks: tuple[Any, ...], moment: Moment) -> None:
    """Tell all elements with states of their own that a step is made.

    Parameters
    ----------
    blocks : tuple of NamedTuple
        Arrays of all blocks.
    moment : Moment
        The step.
    """
    for block in blocks:
        accept = _kind(type(block)).accept
        if accept is not None:
            accept(block, moment)


@overload(all_accept, jit_options=_OPTIONS)
def _all_accept(blocks: Any, moment: Any) -> Callable[..., None]:
    """Compile for the types of some blocks: the first one, and then the rest likewise."""
    if len(blocks) == 0:

        def none(blocks: Any, moment: Any) -> None:
            return

        return none
    accept = _counted(_kind(blocks[0].instance_class).accept)
    if accept is None:

        def rest(blocks: Any, moment: Any) -> None:
            all_accept(blocks[1:], moment)

        return rest

    def first_and_rest(blocks: Any, moment: Any) -> None:
        accept(blocks[0], moment)
        all_accept(blocks[1:], moment)

    return first_and_rest


def all_powers(blocks: tuple[Any, ...], moment: Moment, motion: FloatArray, answers: Answers, out: FloatArray) -> None:
    """Powers of all elements at the end of a step that is made.

    Parameters
    ----------
    blocks, moment, motion, answers
        The same as of `all_answer`.
    out : array (elements, 3)
        Numbers of `mbs.model.elements.Powers` of each; written where its kind says so.
    """
    for block in blocks:
        powers = _kind(type(block)).powers
        if powers is not None:
            powers(block, moment, motion, answers, out)


@overload(all_powers, jit_options=_OPTIONS)
def _all_powers(blocks: Any, moment: Any, motion: Any, answers: Any, out: Any) -> Callable[..., None]:
    """Compile for the types of some blocks: the first one, and then the rest likewise."""
    if len(blocks) == 0:

        def none(blocks: Any, moment: Any, motion: Any, answers: Any, out: Any) -> None:
            return

        return none
    powers = _counted(_kind(blocks[0].instance_class).powers)
    if powers is None:

        def rest(blocks: Any, moment: Any, motion: Any, answers: Any, out: Any) -> None:
            all_powers(blocks[1:], moment, motion, answers, out)

        return rest

    def first_and_rest(blocks: Any, moment: Any, motion: Any, answers: Any, out: Any) -> None:
        powers(blocks[0], moment, motion, answers, out)
        all_powers(blocks[1:], moment, motion, answers, out)

    return first_and_rest


@njit(error_model="numpy", fastmath=FAST, _nrt=False)
def _account(
    linear: Linear,
    numbers: Numbers,
    state: State,
    begun: FloatArray,
    found_a: FloatArray,
    load: FloatArray,
    motion: FloatArray,
    force: FloatArray,
    energies: Energies,
    mean: FloatArray,
) -> None:
    """Add the energies of a step before its state is overwritten; see `mbs.transient.energy`.

    `begun` (2, n) is what the step begins with, of displacement and velocity; `mean` (n,) is work space.
    """
    h, by_q, by_v = numbers.h, numbers.by_q, numbers.by_v
    p, v, a = state.motion[0], state.motion[1], state.motion[2]
    p0, v0 = begun[0], begun[1]
    work = taken = 0.0
    for i in range(p.size):
        p1, v1 = p0[i] + by_q * found_a[i], v0[i] + by_v * found_a[i]
        moved, middle, pull = p1 - p[i], 0.5 * (v[i] + v1), 0.5 * (energies.load[i] + load[i])
        work += pull * moved
        taken -= middle * (v1 - v[i] - 0.5 * h * (a[i] + found_a[i]))
        taken -= (h * middle - moved) * (pull - 0.5 * linear.eigenvalues[i] * (p[i] + p1))
        mean[i] = middle
        energies.load[i] = load[i]
    latest, x, rate = state.forces[0], energies.felt[0], energies.felt[1]
    for i in range(force.size):
        middle, moved = 0.5 * (latest[i] + force[i]), motion[0, i] - x[i]
        energies.works[i] += middle * moved
        taken -= (0.5 * h * (rate[i] + motion[1, i]) - moved) * middle
        x[i], rate[i] = motion[0, i], motion[1, i]
    energies.sums[0] += work
    energies.sums[1] += taken
    for part in range(energies.lost.size):
        power = 0.0
        for e in range(energies.starts[part], energies.starts[part + 1]):
            power += energies.values[e] * mean[energies.rows[e]] * mean[energies.columns[e]]
        energies.lost[part] += h * power


@njit(error_model="numpy", fastmath=FAST, _nrt=False)
def _jacobian(slopes: FloatArray, receptance: FloatArray, alone: int, out: FloatArray) -> None:
    """1 + (by_q K + by_v C) R; slopes are zero but for the elements' own, R is diagonal for what is alone."""
    m = out.shape[0]
    for i in range(m):
        row = out[i]
        row[:] = 0.0
        row[i] = 1.0
        for k in range(alone):
            row[k] += slopes[i, k] * receptance[k, k]
        for k in range(alone, m):
            slope = slopes[i, k]
            if slope != 0.0:
                by = receptance[k]
                for j in range(alone, m):
                    row[j] += slope * by[j]


@njit(error_model="numpy", _nrt=False)
def observe(state: State, records: Records, row: int) -> None:
    """Record the state.

    Parameters
    ----------
    state : State
        The state of the run.
    records : Records
        What is recorded.
    row : int
        Index of the row of outputs.
    """
    for i in range(records.orders.size):
        seen, motion = records.rows[i], state.motion[records.orders[i]]
        total = 0.0
        for j in range(motion.size):
            total += seen[j] * motion[j]
        records.outputs[row, i] = total
    if row % records.stride != 0:
        return
    sample = row // records.stride
    put(state.forces[0], records.forces[sample])
    if records.motions.shape[0] > 0:
        for order in range(3):
            put(state.motion[order], records.motions[sample, order])


@njit(error_model="numpy")
def advance(
    linear: Linear,
    numbers: Numbers,
    blocks: tuple[Any, ...],
    course: Course,
    state: State,
    records: Records,
    energies: Energies,
    outside: IntArray,
    counters: IntArray,
) -> tuple[int, int, float]:
    """Make the steps of a course.

    Parameters
    ----------
    linear, numbers, blocks, course
        What moves.
    state : State
        Overwritten after each step that is made.
    records : Records
        Records of the run, filled.
    energies : Energies
        Energies of the run, added to.
    outside : array (elements,), of int
        Evaluations outside the map, counted up.
    counters : array (1,), of int
        Newton iterations, counted up.

    Returns
    -------
    done, status, error : int, int, float
        How many steps were made; how it ended; the estimated error of the last step, infinite where there is no
        solution. The step that failed has left no trace in the state.
    """
    n, m = linear.eigenvalues.size, linear.ports.shape[0]
    p, v, a, carried = state.motion[0], state.motion[1], state.motion[2], state.motion[3]
    begun, known, right, free, mean = np.empty((2, n)), np.empty(n), np.empty(n), np.empty(n), np.empty(n)
    p0, v0, powers = begun[0], begun[1], energies.powers.copy()
    found_a, load = np.empty(n), np.empty(n)
    unmoved, motion, answers = np.empty((2, m)), np.empty((2, m)), Answers(np.zeros(m), np.zeros((m, m)), outside)
    u, short, jacobian = np.empty(m), np.empty(m), np.empty((m, m))
    reach, receptance = linear.reach[0].copy(), linear.receptance[0].copy()
    h, by_q, by_v = numbers.h, numbers.by_q, numbers.by_v
    latest, before, earlier = state.forces[0], state.forces[1], state.forces[2]
    error = 0.0
    for step in range(course.speeds.size):
        speed, angle = course.speeds[step], course.angles[step]
        by = speed - linear.reference
        put(course.steady, load)
        for i in range(course.varying.shape[0]):
            factor = course.factors[step, i]
            for j in range(n):
                load[j] += factor * course.varying[i, j]
        for i in range(n):
            known[i] = (numbers.alpha_f * a[i] - numbers.alpha_m * carried[i]) / (1.0 - numbers.alpha_m)
            p0[i] = p[i] + h * v[i] + h * h * ((0.5 - numbers.beta) * carried[i] + numbers.beta * known[i])
            v0[i] = v[i] + h * ((1.0 - numbers.gamma) * carried[i] + numbers.gamma * known[i])
        _times(linear.damping, v0, right)
        for i in range(n):
            right[i] = load[i] - right[i] - linear.eigenvalues[i] * p0[i]
        if linear.turning and by != 0.0:
            _times(linear.gyroscopic, v0, free)
            for i in range(n):
                right[i] -= by * free[i]
            _expanded_times(linear.inverse, by, right, free)
        else:
            _times(linear.inverse[0], right, free)
        if linear.turning:
            _expanded(linear.reach, by, reach)
            _expanded(linear.receptance, by, receptance)
        for i in range(n):
            right[i] = p0[i] + by_q * free[i]
        _times(linear.ports, right, unmoved[0])
        for i in range(n):
            right[i] = v0[i] + by_v * free[i]
        _times(linear.ports, right, unmoved[1])
        for i in range(m):
            u[i] = 3.0 * (latest[i] - before[i]) + earlier[i]
        moment = Moment(step, course.times[step], speed, angle, by_q, by_v)
        by_load, largest = _norm(load), 0.0
        status = NO_SOLUTION
        for _ in range(numbers.iterations):
            counters[0] += 1
            _times(receptance, u, short)
            for i in range(m):
                motion[0, i] = unmoved[0, i] + by_q * short[i]
                motion[1, i] = unmoved[1, i] + by_v * short[i]
            reached = all_answer(blocks, moment, motion, answers)
            if reached != FOUND:
                status = reached
                break
            for i in range(n):
                found_a[i] = free[i]
            for k in range(m):
                row = reach[k]
                for i in range(n):
                    found_a[i] += u[k] * row[i]
            for i in range(m):
                short[i] = u[i] - answers.force[i]
            largest = max(largest, by_load, _size(linear.size, answers.force), _norm(found_a))
            if _size(linear.size, short) <= numbers.residual * largest:
                status = DONE
                break
            _jacobian(answers.slopes, receptance, linear.alone, jacobian)
            if not eliminate(jacobian, short):
                break
            for i in range(m):
                u[i] -= short[i]
        if status != DONE:
            return step, status, math.inf
        error = 0.0
        if numbers.tolerance < math.inf:
            for i in range(n):
                right[i] = found_a[i] - a[i]
            _times(linear.physical, right, free)
            error = numbers.error_weight * np.max(np.abs(free))
            if not error <= numbers.tolerance:
                return step, TOO_LARGE, error
        _account(linear, numbers, state, begun, found_a, load, motion, u, energies, mean)
        for i in range(n):
            p[i], v[i] = p0[i] + by_q * found_a[i], v0[i] + by_v * found_a[i]
            carried[i], a[i] = known[i] + numbers.ratio * found_a[i], found_a[i]
        for i in range(m):
            earlier[i], before[i], latest[i] = before[i], latest[i], u[i]
        all_accept(blocks, moment)
        all_powers(blocks, moment, motion, answers, powers)
        for i in range(powers.shape[0]):
            energies.exchanged[i, 0] += powers[i, 2]
            for k in range(2):
                energies.exchanged[i, k] += 0.5 * h * (energies.powers[i, k] + powers[i, k])
                energies.powers[i, k] = powers[i, k]
        if course.rows[step] >= 0:
            observe(state, records, course.rows[step])
    return course.speeds.size, DONE, error


advance_anew = njit(error_model="numpy", cache=False)(in_python(advance))
"""`advance`, compiled anew in each process: for kinds of elements from elsewhere, see `mbs.transient.kinds`."""
