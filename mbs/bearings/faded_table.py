"""The table of a film of which only a part is there, below the lowest mapped speed, from the nodes of the whole one."""

from __future__ import annotations

import math

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.compiled import njit
from ehdmaps.maps.kernel import structural_state
from ehdmaps.maps.lines import FAST
from ehdmaps.maps.tables import Point
from mbs.bearings.slice_table import (
    KNOTS,
    NODES,
    PLACES,
    LawNumbers,
    law_numbers,
    node_states,
    nodes_up_to,
    place_numbers,
    store_numbers,
)

WHOLE, DRY, RISE, LOADS, SLOPES, DAMPINGS, BENDS = range(7)
"""Columns of the nodes of a faded film: approach with the whole film and without [m], growth of the latter by the
former; load [N/m] and damping [N s/m2], each with its slope by the approach with the whole film."""


@njit(error_model="numpy")
def write_film(point: Point, nodes: FloatArray, out: FloatArray, highest: float, numbers: FloatArray) -> bool:
    """Nodes of a film of which only a part is there: what holds for every part of it.

    At equal load the approach is that part of the one with the whole film, and the rest of that without any, see
    `ehdmaps.maps.kernel`. So the nodes of a whole film serve all parts, as knots that move.

    Parameters
    ----------
    point : Point
        Law at a point.
    nodes : array (4, NODES)
        Work space, overwritten.
    out : array (2 ROWS, 8)
        Filled: columns `WHOLE` to `BENDS` of all nodes but the outermost; the held load in the last row.
    highest : float
        Load above which slices are outside the map [N/m].
    numbers : array (NUMBERS,)
        Filled with `LawNumbers`, if the nodes fit; `lift_off` and `safe_approach` are the numbers of their nodes.
    """
    whole = place_numbers(point, highest)
    centre, scale = whole.centre, 1.0 / whole.inverse_scale
    first = nodes_up_to(centre, scale, point.lift_off)
    if first < 2:
        return False
    node_states(point, whole, np.arange(NODES), nodes)
    w, dw, c, dc = nodes[0], nodes[1], nodes[2], nodes[3]
    safe, most, last = 0, min(highest, point.held_load), out.shape[0] - 1
    structure, q = point.structure, point.centrifugal_load
    for i in range(last):
        k = i + 1
        dry, compliance = structural_state(structure, q, w[k])
        out[i, WHOLE], out[i, DRY], out[i, RISE] = centre + PLACES[k] * scale, dry, compliance * dw[k]
        out[i, LOADS], out[i, SLOPES], out[i, DAMPINGS], out[i, BENDS] = w[k], dw[k], c[k], dc[k]
        if w[k] <= most:
            safe = i
    dry, _ = structural_state(structure, q, point.held_load)
    out[last, WHOLE], out[last, DRY] = whole.held_approach, dry
    out[last, LOADS], out[last, DAMPINGS] = point.held_load, whole.held_damping
    found = LawNumbers(
        kind=KNOTS, coefficient=0.0, exponent=0.0, damping=0.0, damping_time=0.0, centre=0.0, inverse_scale=0.0,
        highest=highest, safe_approach=float(safe), lift_off=float(first - 2), slope=1.0, held_approach=0.0,
        held_load=point.held_load, held_stiffness=point.held_stiffness, held_damping=0.0,
    )  # fmt: skip
    store_numbers(found, numbers)
    return True


@njit(error_model="numpy", fastmath=FAST)
def fade(
    film: FloatArray, given: FloatArray, part: float, cells: FloatArray, knots: FloatArray, numbers: FloatArray
) -> None:
    """The table of a part of a film, from the nodes of the film.

    Parameters
    ----------
    film, given : array (2 ROWS, 8), (NUMBERS,)
        What `write_film` wrote.
    part : float
        Part of the film that is there, 0 to 1.
    cells, knots : array (2 ROWS, 8), (2 ROWS,)
        Filled: coefficients as of `tabulate`, over the distance from the lower end of a cell [m]; where
        cells begin [m].
    numbers : array (NUMBERS,)
        Filled with `LawNumbers`.
    """
    last, rest = film.shape[0] - 1, 1.0 - part
    slopes, bends = np.empty(last), np.empty(last)
    for i in range(last):
        knots[i] = rest * film[i, DRY] + part * film[i, WHOLE]
        stretch = rest * film[i, RISE] + part
        loaded = film[i, LOADS] > 0.0
        slopes[i] = film[i, SLOPES] / (stretch if loaded else 1.0)
        bends[i] = part * film[i, BENDS] / (stretch if loaded else 1.0)
    knots[last] = math.inf
    for i in range(last - 1):
        h = knots[i + 1] - knots[i]
        # Without film all nodes without load are one.
        rise = 3.0 * (film[i + 1, LOADS] - film[i, LOADS]) / h if h > 0.0 else 0.0
        slopes[i], slopes[i + 1] = min(slopes[i], rise), min(slopes[i + 1], rise)
        if h > 0.0:
            bends[i] = max(bends[i], -3.0 * part * film[i, DAMPINGS] / h)
            bends[i + 1] = min(bends[i + 1], 3.0 * part * film[i + 1, DAMPINGS] / h)
    for i in range(last - 1):
        h, cell = knots[i + 1] - knots[i], cells[i]
        by = 1.0 / h if h > 0.0 else 0.0
        secant = (film[i + 1, LOADS] - film[i, LOADS]) * by
        cell[0], cell[1] = film[i, LOADS], slopes[i]
        cell[2] = (3.0 * secant - 2.0 * slopes[i] - slopes[i + 1]) * by
        cell[3] = (slopes[i] + slopes[i + 1] - 2.0 * secant) * by * by
        secant = part * (film[i + 1, DAMPINGS] - film[i, DAMPINGS]) * by
        cell[4], cell[5] = part * film[i, DAMPINGS], bends[i]
        cell[6] = (3.0 * secant - 2.0 * bends[i] - bends[i + 1]) * by
        cell[7] = (bends[i] + bends[i + 1] - 2.0 * secant) * by * by
    for k in range(8):
        for i in range(last - 1, last + 1):
            cells[i, k] = 0.0
    found = law_numbers(given)
    faded = LawNumbers(
        kind=KNOTS, coefficient=0.0, exponent=0.0, damping=0.0, damping_time=0.0, centre=0.0, inverse_scale=0.0,
        highest=found.highest, safe_approach=knots[int(found.safe_approach)], lift_off=knots[int(found.lift_off)],
        slope=1.0, held_approach=rest * film[last, DRY] + part * film[last, WHOLE], held_load=found.held_load,
        held_stiffness=found.held_stiffness, held_damping=part * film[last, DAMPINGS],
    )  # fmt: skip
    store_numbers(faded, numbers)
