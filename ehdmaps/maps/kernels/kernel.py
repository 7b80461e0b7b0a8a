"""The law at run time: load, its derivative with approach and with rate, in compiled code.

Three functions are meant to be called from other compiled code, one point at a time and without allocation:

- `evaluate_at(point, delta, rate, counts)` for one speed, temperature and centrifugal load;
- `collapse(table, workspace, entrainment_speed, temperature, centrifugal_load, counts)` -> the `Point` for it;
- `evaluate(table, workspace, delta, rate, entrainment_speed, temperature, centrifugal_load, counts)`.

A bearing calls `collapse` once a time step and `evaluate_at` once a slice::

    point = collapse(law.table, workspace, u, T, q, counts)
    for j in range(slices):
        w, dw_ddelta, dw_drate = evaluate_at(point, delta[j], rate[j], counts)

Python calls the law in C, see `ehdmaps.maps.law_in_c`; this text of it is for kernels that numba compiles.

`counts` (int64, 4) is counted up at `LOAD`, `SPEED` or `TEMPERATURE` for arguments outside the map, whatever the
policy of the law, and at `NOT_FINITE`; speed and temperature are then held at the edge, and above the held load
the law is its tangent. The caller looks at the counts when its loop is done.

The state of a contact at rest is (w, dw/ddelta, c/w, dc/ddelta) throughout.
"""

from __future__ import annotations

import math

from ehdmaps.arrays import FloatArray, IntArray
from ehdmaps.compiled import njit
from ehdmaps.maps.kernels.lines import (
    FAST,
    State,
    collapsed_line,
    end_at,
    exp,
    force_of,
    line_approach,
    line_state,
    log,
    stretched,
    table_state,
)
from ehdmaps.maps.kernels.roller_balance import LEAST_LOAD, balanced_state
from ehdmaps.maps.kernels.tables import (
    EDGE_TOLERANCE,
    HALF_SPACE,
    LOAD,
    LOAD_TOLERANCE,
    NOT_FINITE,
    SPEED,
    TEMPERATURE,
    LawTable,
    Point,
)
from ehdmaps.physics.contact import Force

_STEPS = 100


@njit(error_model="numpy", fastmath=FAST, forceinline=True)
def structural_state(structure: FloatArray, centrifugal_load: float, load: float) -> tuple[float, float]:
    """Structural approach of the contacts at a load, and its derivative; the last one carries more.

    Parameters
    ----------
    structure : array (n, 3)
        Structural law of each contact, as of `LawTable`.
    centrifugal_load, load : float
        What the last contact carries more, and the load of all [N/m].
    """
    approach = compliance = 0.0
    last = structure.shape[0] - 1
    for i in range(last + 1):
        w = load + centrifugal_load if i == last else load
        if w > LEAST_LOAD:
            kind, a, b = structure[i, 0], structure[i, 1], structure[i, 2]
            if kind == HALF_SPACE:
                part = a * w * (b - 0.5 * log(w))
                compliance += part / w - 0.5 * a
            else:
                part = a * exp(b * log(w))
                compliance += b * part / w
            approach += part
    return approach, compliance


@njit(error_model="numpy", fastmath=FAST)
def full_state(point: Point, delta: float) -> State:
    """State with the whole film, at rest."""
    if point.centrifugal_load > 0.0:
        return balanced_state(point, delta)
    return line_state(point.own, delta)


@njit(error_model="numpy", fastmath=FAST, forceinline=True)
def _faded_state(point: Point, delta: float) -> State:
    """State with a part of the film: film offset and c at equal load are that part of the whole ones.

    With the approach y of the whole film, (1 - part) E(w(y)) + part y = delta, E the structural approach.
    """
    part, structure, q = point.film, point.structure, point.centrifugal_load
    empty, _ = structural_state(structure, q, 0.0)
    if delta <= (1.0 - part) * empty + part * point.lift_off:
        return 0.0, 0.0, 0.0, 0.0
    offset, scale = point.own.offset, 1.0 / point.own.inverse_scale
    low, _ = stretched((point.lift_off - offset) * point.own.inverse_scale)
    high, _ = stretched((delta - offset) * point.own.inverse_scale)
    high = max(high, low)
    place = high
    state = (0.0, 0.0, 0.0, 0.0)
    slope = 1.0
    last = False
    for _ in range(_STEPS):
        growth = exp(place)
        y = offset + 0.5 * scale * (growth - 1.0 / growth)
        state = full_state(point, y)
        dry, compliance = structural_state(structure, q, state[0])
        excess = (1.0 - part) * dry + part * y - delta
        slope = part
        if state[0] > 0.0:
            slope += (1.0 - part) * compliance * state[1]
        if last:
            break
        if excess > 0.0:
            high = place
        else:
            low = place
            if place >= high:  # only a table's error makes y > delta
                high = place + 1.0
        per_place = 0.5 * slope * scale * (growth + 1.0 / growth)
        following = place - excess / per_place if per_place > 0.0 else low - 1.0
        if not low <= following <= high:
            following = 0.5 * (low + high)
        last = abs(following - place) <= 1e-9
        place = following
    w, dw, ratio, dc = state
    if w < LEAST_LOAD:
        return 0.0, 0.0, 0.0, 0.0
    return w, dw / slope, part * ratio, part * dc / slope


@njit(error_model="numpy", fastmath=FAST)
def _rest_state(point: Point, delta: float) -> State:
    """State at rest, before the hold above the highest load."""
    if point.film < 1.0:
        return _faded_state(point, delta)
    return full_state(point, delta)


@njit(error_model="numpy", fastmath=FAST, forceinline=True)
def _held(point: Point, delta: float) -> State:
    """State on the tangent above the held load."""
    w = point.held_load + point.held_stiffness * (delta - point.held_approach)
    return w, point.held_stiffness, point.held_damping / w, 0.0


@njit(error_model="numpy", fastmath=FAST, forceinline=True)
def evaluate_at(point: Point, delta: float, rate: float, counts: IntArray) -> Force:
    """Load and derivatives at a point of speed, temperature and centrifugal load.

    Parameters
    ----------
    point : Point
        Point from `collapse`, or `LawAtPoint.point`.
    delta, rate : float
        Approach [m] and its rate [m/s].
    counts : array (4,)
        int64, counted up.

    Returns
    -------
    w, dw_ddelta, dw_drate : float
        [N/m], [N/m2], [N s/m2].
    """
    if not (abs(delta) < math.inf and abs(rate) < math.inf):
        counts[NOT_FINITE] += 1
        return math.nan, math.nan, math.nan
    if delta > point.held_approach:
        state = _held(point, delta)
    elif point.film == 1.0 and point.centrifugal_load == 0.0:
        state = line_state(point.own, delta)
    else:
        state = _rest_state(point, delta)
    if state[0] <= 0.0:
        return 0.0, 0.0, 0.0
    if state[0] > point.highest_load * (1.0 + LOAD_TOLERANCE):
        counts[LOAD] += 1
    return force_of(state, rate)


@njit(error_model="numpy", forceinline=True)
def within_map(table: LawTable, entrainment_speed: float, temperature: float, counts: IntArray) -> tuple[float, float]:
    """Size of the speed, and temperature, held at the edges of the table and counted outside the map.

    Parameters
    ----------
    table : LawTable
        The law.
    entrainment_speed : float
        u [m/s], of either sign.
    temperature : float
        T [K].
    counts : ndarray
        Calls outside the map, counted by cause.
    """
    speed = abs(entrainment_speed)
    if speed > table.counted_speed * (1.0 + EDGE_TOLERANCE):
        counts[SPEED] += 1
    cold, hot = table.counted_cold, table.counted_hot
    if not cold * (1.0 - EDGE_TOLERANCE) <= temperature <= hot * (1.0 + EDGE_TOLERANCE):
        counts[TEMPERATURE] += 1
    low, high = table.lowest_temperature, table.highest_temperature
    return min(speed, table.highest_speed), min(max(temperature, low), high)


@njit(error_model="numpy", fastmath=FAST, forceinline=True)
def film_part(speed: float, film_speed: float) -> float:
    """Part of the film that is there at a speed >= 0 [m/s]: 0 at standstill, 1 from `film_speed` on."""
    part = 1.0 if speed >= film_speed else speed / film_speed
    film: float = part * part * part * (10.0 - part * (15.0 - 6.0 * part))
    return film


@njit(error_model="numpy", fastmath=FAST)
def collapse(
    table: LawTable,
    workspace: FloatArray,
    entrainment_speed: float,
    temperature: float,
    centrifugal_load: float,
    counts: IntArray,
) -> Point:
    """Law at one speed, temperature and centrifugal load.

    Parameters
    ----------
    table : LawTable
        `ContactLaw.table`.
    workspace : array (4, n, 8)
        Workspace from `ContactLaw.workspace`; the `Point` lives in it until the next call with it.
    entrainment_speed, temperature, centrifugal_load : float
        u [m/s], T [K], q >= 0 [N/m]; finite.
    counts : array (4,)
        int64, counted up.
    """
    speed, temperature = within_map(table, entrainment_speed, temperature, counts)
    film = film_part(speed, table.film_speed)
    log_speed = log(max(speed, table.lowest_speed))
    q = centrifugal_load
    sums = workspace[3].reshape(-1)
    highest_load = end_at(table.ends, log_speed, temperature)
    held_load = table.held_load * (highest_load / table.highest_load)
    if q >= held_load:
        counts[LOAD] += 1
        q = 0.5 * held_load
    highest_load, held_load = highest_load - q, held_load - q
    own = collapsed_line(table.own, workspace[0], sums, log_speed, temperature)
    inner, outer, inner_lift_off, outer_start = own, own, 0.0, 0.0
    if q > 0.0:
        inner = collapsed_line(table.inner, workspace[1], sums, log_speed, temperature)
        outer = collapsed_line(table.outer, workspace[2], sums, log_speed, temperature)
        inner_lift_off, outer_start = line_approach(inner, 0.0), line_approach(outer, q)
        lift_off = inner_lift_off + outer_start
        held = line_approach(inner, held_load) + line_approach(outer, held_load + q)
    else:
        lift_off = line_approach(own, 0.0)
        held = line_approach(own, held_load)
    dry, compliance = structural_state(table.structure, q, held_load)
    held = (1.0 - film) * dry + film * held
    unheld = Point(
        own, inner, outer, table.structure, film, q, inner_lift_off, outer_start, lift_off,
        highest_load, held_load, held, 1.0 / compliance, 0.0,
    )  # fmt: skip
    _, _, ratio, _ = _rest_state(unheld, held)
    return Point(
        own, inner, outer, table.structure, film, q, inner_lift_off, outer_start, lift_off,
        highest_load, held_load, held, 1.0 / compliance, ratio * held_load,
    )  # fmt: skip


@njit(error_model="numpy", fastmath=FAST)
def _through_point(
    table: LawTable,
    workspace: FloatArray,
    delta: float,
    rate: float,
    entrainment_speed: float,
    temperature: float,
    centrifugal_load: float,
    counts: IntArray,
) -> Force:
    """`evaluate` by way of `collapse`."""
    point = collapse(table, workspace, entrainment_speed, temperature, centrifugal_load, counts)
    return evaluate_at(point, delta, rate, counts)


@njit(error_model="numpy", fastmath=FAST)
def evaluate(
    table: LawTable,
    workspace: FloatArray,
    delta: float,
    rate: float,
    entrainment_speed: float,
    temperature: float,
    centrifugal_load: float,
    counts: IntArray,
) -> Force:
    """Load and derivatives; arguments and results as of `evaluate_at` and `collapse`.

    Below the lowest mapped speed, with a centrifugal load and outside the map it collapses the table first, which
    costs some microseconds.
    """
    finite = abs(delta) < math.inf and abs(rate) < math.inf and abs(entrainment_speed) < math.inf
    if not (finite and abs(temperature) < math.inf and abs(centrifugal_load) < math.inf):
        counts[NOT_FINITE] += 1
        return math.nan, math.nan, math.nan
    speed = abs(entrainment_speed)
    if (
        table.film_speed <= speed
        and table.lowest_speed <= speed <= table.counted_speed
        and table.counted_cold <= temperature <= table.counted_hot
        and centrifugal_load == 0.0
    ):
        state = table_state(table.own, delta, log(speed), temperature, workspace[3, 0])
        if state[0] <= table.known_load:
            return force_of(state, rate)
    return _through_point(table, workspace, delta, rate, entrainment_speed, temperature, centrifugal_load, counts)
