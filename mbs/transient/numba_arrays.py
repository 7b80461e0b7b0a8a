"""The arrays of a run for `numba_kernel`, as named tuples that numba takes as they are."""

from __future__ import annotations

from typing import NamedTuple

from ehdmaps.arrays import FloatArray, IntArray


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
    alone : int
        How many ports at the beginning move only by their own forces: the receptance couples them with nothing.
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
    alone: int
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


class Course(NamedTuple):
    """Values prescribed at the end of each step.

    Attributes
    ----------
    times, speeds, angles : array (steps,)
        [s], [rad/s], [rad].
    steady, varying, factors : array (n,), (loads, n), (steps, loads)
        Loads, by mode.
    rows : array (steps,), of int
        Rows to record in; negative for not at all.
    """

    times: FloatArray
    speeds: FloatArray
    angles: FloatArray
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
    """Arrays of what is recorded.

    Attributes
    ----------
    rows : array (outputs, n)
        What is seen of the modes.
    orders : array (outputs,), of int
        Whether of their displacement, velocity or acceleration.
    outputs : array (rows, outputs)
        Outputs, filled row by row.
    forces : array (samples, m)
        Forces, filled sample by sample.
    motions : array (samples, 3, n)
        Motions, filled sample by sample; of no samples where not asked for.
    stride : int
        Rows from sample to sample: forces and motions are kept less often than outputs where it is above 1.
    """

    rows: FloatArray
    orders: IntArray
    outputs: FloatArray
    forces: FloatArray
    motions: FloatArray
    stride: int


class Energies(NamedTuple):
    """Energies of the steps of a run, summed up as `mbs.transient.energy` says, and what the last step left for that.

    Attributes
    ----------
    load : array (n,)
        Loads at the end of the last step, by mode.
    felt : array (2, m)
        What the elements felt there, and its rate.
    powers : array (elements, 3)
        Numbers of `mbs.model.elements.Powers` of each element there.
    sums : array (2,)
        Work of the loads, and what the method took [J].
    works : array (m,)
        Work of the forces of the elements, by what they feel [J].
    exchanged : array (elements, 2)
        What elements dissipated, and what their courses brought in [J].
    lost : array (parts,)
        What parts of the linear system dissipated [J].
    starts : array (parts + 1,), of int
        First entry of each part, and the number of all.
    rows, columns, values : array (entries,)
        Entries of the damping of all parts by the modes, on and above the diagonal; those above it doubled.
    """

    load: FloatArray
    felt: FloatArray
    powers: FloatArray
    sums: FloatArray
    works: FloatArray
    exchanged: FloatArray
    lost: FloatArray
    starts: IntArray
    rows: IntArray
    columns: IntArray
    values: FloatArray
