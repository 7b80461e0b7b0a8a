"""The arrays of a compiled law, as named tuples that numba takes as they are.

`ApproachTable` and `LawTable` hold a law over approach, entrainment speed and temperature; `Line` and `Point` hold
what is left of them at one speed, temperature and centrifugal load.

Tables whose cells are fine near 1, and as wide as they are far from it, have 32 cells to each doubling of a number
a >= 1, found without a logarithm: its leading binary digits are the number of its cell, the others its place
there.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ehdmaps.arrays import FloatArray

_BITS = 5

FIRST = np.int64(np.float64(1.0).view(np.int64) >> (52 - _BITS))
"""Number of the cell that begins at 1."""


def rows_of(octaves: int) -> int:
    """Number of cells up to a = 2^octaves."""
    return octaves << _BITS


def nodes_of(rows: int) -> FloatArray:
    """Ends of so many cells, shape (rows + 1,), as values of a from 1 on."""
    nodes: FloatArray = ((FIRST + np.arange(rows + 1)) << np.int64(52 - _BITS)).view(np.float64)
    return nodes


def last_of(nodes: FloatArray) -> float:
    """The largest a that is still in a cell."""
    return float(np.nextafter(nodes[-1], 0.0))


LOAD, SPEED, TEMPERATURE, NOT_FINITE = 0, 1, 2, 3
"""Places in an array of counts: calls outside by cause, and values that are no finite numbers."""

LOAD_TOLERANCE = 1e-3
"""Part of the highest load by which a load may pass it: the error of a table, not of a caller."""

EDGE_TOLERANCE = 1e-6
"""Part of the highest speed, and of the temperatures, by which they may be passed: single precision."""


def film_part(speed: float, film_speed: float) -> float:
    """Part of the film that is there at a speed: 0 at standstill, 1 from `film_speed` on, smooth between.

    Parameters
    ----------
    speed, film_speed : float
        Speeds >= 0 [m/s].
    """
    part = 1.0 if speed >= film_speed else speed / film_speed
    return part * part * part * (10.0 - part * (15.0 - 6.0 * part))


POWER_LAW, HALF_SPACE = 0.0, 1.0
"""Kinds of structural law in `LawTable.structure`."""


COLDEST = 170.0
"""Temperature at which the viscosity of mineral oils tends to infinity [K], by Vogel's law about."""


class ApproachTable(NamedTuple):
    """g = w^(1/3) and ln(c/w) of one contact, or of two in series, over speed, temperature and approach.

    The axes are uniform in ln u, in 1/(T - `COLDEST`), in which ln eta0 of an oil is nearly straight, and in
    s = asinh((delta - offset)/scale). Over u and T the B-splines are quadratic, with the coefficients i to i + 2 around
    the node i; over s they are cubic, with the coefficients i to i + 3 between the nodes i and i + 1.

    Attributes
    ----------
    coefficients : array (n_u, n_T, 2 n_s)
        Coefficients of g [(N/m)^(1/3)] and ln(c/w) [c/w in s/m], in turns.
    place : array (n_u, n_T, 2)
        Coefficients of the offset [m] and of 1/scale [1/m].
    log_speed_start, log_speed_step : float
        First node and inverse distance of nodes of ln u; step 0 for a single speed.
    temperature_start, temperature_step : float
        First node [1/K], inverse distance of nodes [K]; step 0 for a single temperature.
    start, step : float
        First node and inverse distance of nodes of s.
    """

    coefficients: FloatArray
    place: FloatArray
    log_speed_start: float
    log_speed_step: float
    temperature_start: float
    temperature_step: float
    start: float
    step: float


class LawTable(NamedTuple):
    """Everything that a law needs at run time.

    Attributes
    ----------
    own : ApproachTable
        The law without centrifugal load.
    inner, outer : ApproachTable
        The two contacts, for the equilibrium of a roller with centrifugal load; `own` again where the law has
        no centrifugal load.
    structure : array (n, 3)
        Structural law of each contact: kind, and two parameters.
    ends : array (1 + n_u, 1 + n_T)
        Mapped loads, see `ehdmaps.maps.kernels.ends`; those above are counted.
    film_speed : float
        Speed below which the film is faded [m/s]; inf for a map without films, 0 where it goes over into asperities.
    lowest_speed, highest_speed : float
        Speeds at which the table is held [m/s], > 0.
    lowest_temperature, highest_temperature : float
        Temperatures at which the table is held [K].
    highest_load : float
        Highest mapped load at any speed and temperature [N/m].
    known_load, known_root : float
        Load that is mapped at all speeds and temperatures [N/m], and its cube root.
    held_load : float
        Load above which the law is its dry tangent [N/m], where the highest load is mapped; less by as much elsewhere.
    counted_speed : float
        Speeds above it are counted [m/s].
    counted_cold, counted_hot : float
        Temperatures below and above them are counted [K].
    """

    own: ApproachTable
    inner: ApproachTable
    outer: ApproachTable
    structure: FloatArray
    ends: FloatArray
    film_speed: float
    lowest_speed: float
    highest_speed: float
    lowest_temperature: float
    highest_temperature: float
    highest_load: float
    known_load: float
    known_root: float
    held_load: float
    counted_speed: float
    counted_cold: float
    counted_hot: float


class Line(NamedTuple):
    """An `ApproachTable` at one speed and temperature.

    Attributes
    ----------
    coefficients : array (cells, 8)
        Cubics over the cells of s, in the part of the cell: four coefficients of g, four of ln(c/w).
    offset, inverse_scale : float
        [m], [1/m].
    start, step : float
        The same as in the table.
    """

    coefficients: FloatArray
    offset: float
    inverse_scale: float
    start: float
    step: float


class Point(NamedTuple):
    """A `LawTable` at one speed, temperature and centrifugal load.

    Attributes
    ----------
    own, inner, outer : Line
        Lines as in the table.
    structure : array (n, 3)
        The same as in the table.
    film : float
        Part of the film that is there, 1 at and above `LawTable.film_speed`, 0 at standstill.
    centrifugal_load : float
        q [N/m].
    inner_lift_off, outer_start : float
        Approach of the inner contact without load, of the outer one under the centrifugal load alone [m].
    lift_off : float
        Approach at and below which there is no load, with the whole film [m].
    highest_load : float
        Loads above it are counted [N/m].
    held_load, held_approach, held_stiffness, held_damping : float
        Load and approach above which the law is the tangent with this stiffness and this damping.
    """

    own: Line
    inner: Line
    outer: Line
    structure: FloatArray
    film: float
    centrifugal_load: float
    inner_lift_off: float
    outer_start: float
    lift_off: float
    highest_load: float
    held_load: float
    held_approach: float
    held_stiffness: float
    held_damping: float
