"""The structs of a run as `ehd_advance` takes them; `ehdmaps/kernel/c/run/advance.c` says what is done with them."""

from __future__ import annotations

import ctypes
import functools
from collections.abc import Callable
from typing import Any, ClassVar

from ehdmaps.kernel.library import checked, function
from ehdmaps.kernel.record import Record, integers, numbers


class Linear(Record):
    """The linear part at one size of steps, about a reference speed.

    Attributes
    ----------
    n, m : int
        Modes, and what the elements feel.
    coordinates : int
        Rows of `physical`: 0 if errors are not controlled.
    alone : int
        How many ports at the beginning move only by their own forces: the receptance couples them with nothing.
    turning : int
        Whether there are gyroscopic terms.
    reference : float
        Speed [rad/s].
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
    physical : array (coordinates, n)
        Coordinates of the system by the modes.
    """

    _fields_ = (
        *((name, ctypes.c_int64) for name in ("n", "m", "coordinates", "alone", "turning")),
        ("reference", ctypes.c_double),
        *(
            (name, numbers)
            for name in (
                "eigenvalues", "damping", "gyroscopic", "inverse", "ports", "reach", "receptance", "size", "physical"
            )
        ),
    )  # fmt: skip
    shapes: ClassVar = {
        "eigenvalues": ("n",),
        "damping": ("n", "n"),
        "gyroscopic": ("n", "n"),
        "inverse": (3, "n", "n"),
        "ports": ("m", "n"),
        "reach": (3, "m", "n"),
        "receptance": (3, "m", "m"),
        "size": ("m", "m"),
        "physical": ("coordinates", "n"),
    }


class Numbers(Record):
    """Numbers of the method at one size of steps; see `mbs.transient.stepping.Method`."""

    _fields_ = (
        *(
            (name, ctypes.c_double)
            for name in (
                "h", "by_q", "by_v", "alpha_m", "alpha_f", "beta", "gamma", "ratio", "error_weight", "tolerance",
                "residual",
            )
        ),
        ("iterations", ctypes.c_int64),
    )  # fmt: skip


class Course(Record):
    """Values prescribed at the end of each step.

    Attributes
    ----------
    steps, loads : int
        How many.
    times, speeds, angles : array (steps,)
        [s], [rad/s], [rad].
    steady, varying, factors : array (n,), (loads, n), (steps, loads)
        Loads, by mode.
    rows : array (steps,), of int
        Rows to record in; negative for not at all.
    """

    _fields_ = (
        ("steps", ctypes.c_int64),
        ("loads", ctypes.c_int64),
        *((name, numbers) for name in ("times", "speeds", "angles", "steady", "varying", "factors")),
        ("rows", integers),
    )
    shapes: ClassVar = {
        "times": ("steps",),
        "speeds": ("steps",),
        "angles": ("steps",),
        "factors": ("steps", "loads"),
        "rows": ("steps",),
    }


class Run(Record):
    """A run: its state, its records and its energies, all overwritten.

    Attributes
    ----------
    n, m, elements : int
        Modes, what the elements feel, elements.
    motion : array (4, n)
        Displacement, velocity, acceleration and carried acceleration of the modes.
    forces : array (3, m)
        Forces of the elements after the last steps, the latest first.
    outputs, stride, motions_kept : int
        How many outputs; rows from sample to sample, above 1 where forces and motions are kept less often than outputs;
        whether motions are recorded.
    seen, orders : array (outputs, n), (outputs,) of int
        What is seen of the modes, and whether of their displacement, velocity or acceleration.
    output, sampled_forces, sampled_motions : array (rows, outputs), (samples, m), (samples, 3, n)
        Records, filled row by row and sample by sample.
    load, felt, powers : array (n,), (2, m), (elements, 3)
        Loads by mode at the end of the last step, what the elements felt there, and its rate, and numbers of
        `mbs.model.elements.Powers` of each element.
    sums : array (2,)
        Work of the loads, and what the method took [J].
    works : array (m,)
        Work of the forces of the elements, by what they feel [J].
    exchanged : array (elements, 2)
        What elements dissipated, and what their courses brought in [J].
    parts, lost : int, array (parts,)
        What parts of the linear system dissipated [J].
    starts : array (parts + 1,), of int
        First entry of each part, and the number of all.
    rows, columns, values : array (entries,)
        Entries of the damping of all parts by the modes, on and above the diagonal; those above it doubled.
    outside, counter : array (elements,), (1,), of int
        Evaluations outside the map, and Newton iterations, counted up.
    room : array
        Work space.
    """

    _fields_ = (
        *((name, ctypes.c_int64) for name in ("n", "m", "elements")),
        *((name, numbers) for name in ("motion", "forces")),
        *((name, ctypes.c_int64) for name in ("outputs", "stride", "motions_kept")),
        ("seen", numbers),
        ("orders", integers),
        *((name, numbers) for name in ("output", "sampled_forces", "sampled_motions")),
        *((name, numbers) for name in ("load", "felt", "powers", "sums", "works", "exchanged")),
        ("parts", ctypes.c_int64),
        ("lost", numbers),
        *((name, integers) for name in ("starts", "rows", "columns")),
        ("values", numbers),
        ("outside", integers),
        ("counter", integers),
        ("room", numbers),
    )
    shapes: ClassVar = {
        "motion": (4, "n"),
        "forces": (3, "m"),
        "seen": ("outputs", "n"),
        "orders": ("outputs",),
        "load": ("n",),
        "felt": (2, "m"),
        "powers": ("elements", 3),
        "sums": (2,),
        "works": ("m",),
        "exchanged": ("elements", 2),
        "lost": ("parts",),
        "outside": ("elements",),
        "counter": (1,),
    }


class BlockRow(ctypes.Structure):
    """A block as `ehd_advance` takes it: addresses of functions and of data, see `ehdmaps/kernel/c/run/block.h`."""

    _fields_ = tuple((name, ctypes.c_void_p) for name in ("answer", "accept", "powers", "data"))


@functools.cache
def functions() -> tuple[Callable[..., Any], Callable[..., Any], Callable[..., Any]]:
    """Return `ehd_advance`, `ehd_observe` and `ehd_run_room`, after all structs were compared with those in C."""
    for record, name in (
        (Linear, "ehd_linear"), (Numbers, "ehd_numbers"), (Course, "ehd_course"), (Run, "ehd_run"),
        (BlockRow, "ehd_block"),
    ):  # fmt: skip
        checked(record, name)
    pointer, whole = ctypes.c_void_p, ctypes.c_int64
    return (
        function("ehd_advance", pointer, pointer, pointer, pointer, whole, pointer, pointer, pointer, result=whole),
        function("ehd_observe", pointer, whole, result=None),
        function("ehd_run_room", whole, whole, whole, result=whole),
    )
