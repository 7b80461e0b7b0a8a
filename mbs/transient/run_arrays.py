"""The arrays of a run, as named tuples that numba takes as they are; `run_kernel` says what is done with them."""

from __future__ import annotations

from typing import NamedTuple

from ehdmaps.arrays import FloatArray, IntArray

FIRST, FILM, ROLLERS, SLICES, AT_SLICES, AT_ANGLES, AT_CELLS, AT_ROLLERS = range(8)
"""Columns of the table of bearings: first of its ports, its film, numbers of rollers and slices, and where its part
of the pools begins: slices, angles, arrays over all slices, arrays over rollers."""

START_ANGLE, CAGE_RATE, GEOMETRY = range(3)
"""Columns of the numbers of bearings; the geometry is the rest."""


class Linear(NamedTuple):
    """The linear part at one size of steps, about a reference speed.

    Attributes
    ----------
    eigenvalues : array (n,)
        Diagonal of the stiffness.
    damping, gyroscopic : array (n, n)
        D + reference G, and G.
    inverse : array (3, n, n)
        Coefficients of L^-1 in powers of speed - reference.
    ports : array (m, n)
        Matrix T of the ports.
    reach : array (3, m, n)
        Transposed L^-1 T^T, likewise.
    receptance : array (3, m, m)
        T L^-1 T^T, likewise.
    size : array (m, m)
        T T^T.
    physical : array (n, n)
        Coordinates of the system by the modes; shape (0, n) if errors are not controlled.
    reference : float
        Speed [rad/s].
    turning : bool
        Whether there are gyroscopic terms.
    """

    eigenvalues: FloatArray
    damping: FloatArray
    gyroscopic: FloatArray
    inverse: FloatArray
    ports: FloatArray
    reach: FloatArray
    receptance: FloatArray
    size: FloatArray
    physical: FloatArray
    reference: float
    turning: bool


class Numbers(NamedTuple):
    """Numbers of the method at one size of steps; see `mbs.transient.stepping.Method`."""

    h: float
    by_q: float
    by_v: float
    alpha_m: float
    alpha_f: float
    beta: float
    gamma: float
    ratio: float
    error_weight: float
    tolerance: float
    residual: float
    iterations: int


class Elements(NamedTuple):
    """Elements as arrays.

    Attributes
    ----------
    bearings : array (bearings, 8), of int
        See `FIRST` and the others.
    bearing_numbers : array (bearings, 8)
        Angle of the first roller, cage angle by that of the system, and the geometry for `bearing_force`.
    slices, angles, states, rows, rollers, sums : array
        Pools of what `bearing_force` takes.
    counts : array (bearings,), of int
        Calls outside the map.
    mesh_ports : array (meshes,), of int
        First port of each gear mesh.
    mesh_constants, mesh_series : array (meshes, 5), (meshes, 4, harmonics)
        The same as for `mesh_force`.
    """

    bearings: IntArray
    bearing_numbers: FloatArray
    slices: FloatArray
    angles: FloatArray
    states: FloatArray
    rows: IntArray
    rollers: FloatArray
    sums: FloatArray
    counts: IntArray
    mesh_ports: IntArray
    mesh_constants: FloatArray
    mesh_series: FloatArray


class Films(NamedTuple):
    """Tables of the laws at nodes over the speed, and the tables in use.

    Attributes
    ----------
    tables, numbers : array (films, nodes, rows, 8), (films, nodes, 10)
        The same as in `mbs.bearings.slice_table`.
    cells, current : array (films, rows, 8), (films, 10)
        Tables in use.
    in_use : array (films, 2)
        Node and weight of those.
    """

    tables: FloatArray
    numbers: FloatArray
    cells: FloatArray
    current: FloatArray
    in_use: FloatArray


class Course(NamedTuple):
    """What is prescribed at the end of each step.

    Attributes
    ----------
    speeds, angles : array (steps,)
        [rad/s], [rad].
    nodes, weights : array (steps, films)
        Node below the speed, and the part of the way to the next one.
    outside : array (steps, films), of int
        Whether speed or temperature lie outside the map.
    steady, varying, factors : array (n,), (loads, n), (steps, loads)
        Loads, by mode.
    rows : array (steps,), of int
        Rows to record in; negative for not at all.
    """

    speeds: FloatArray
    angles: FloatArray
    nodes: IntArray
    weights: FloatArray
    outside: IntArray
    steady: FloatArray
    varying: FloatArray
    factors: FloatArray
    rows: IntArray


class State(NamedTuple):
    """State of a run, overwritten.

    Attributes
    ----------
    motion : array (4, n)
        Displacement, velocity, acceleration and carried acceleration of the modes.
    forces : array (3, m)
        Forces of the elements after the last steps, the latest first.
    """

    motion: FloatArray
    forces: FloatArray


class Records(NamedTuple):
    """What is recorded.

    Attributes
    ----------
    rows : array (outputs, n)
        What is seen of the modes.
    orders : array (outputs,), of int
        Whether of their displacement, velocity or acceleration.
    outputs : array (samples, outputs)
        Outputs, filled row by row.
    forces : array (samples, m)
        Forces, filled row by row.
    motions : array (samples, 3, n)
        Motions, filled row by row; of no samples where not asked for.
    """

    rows: FloatArray
    orders: IntArray
    outputs: FloatArray
    forces: FloatArray
    motions: FloatArray
