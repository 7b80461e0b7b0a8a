"""The dense algebra of a time step, by the C library: for a dozen coordinates calling numpy costs more than computing.

`ehdmaps/kernel/c/dense.c` has the equations.
"""

from __future__ import annotations

import ctypes
import functools
from collections.abc import Callable
from typing import Any, ClassVar

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.kernel.library import checked, function
from ehdmaps.kernel.record import Record, address, numbers

_DTYPE = np.dtype(np.float64)


class StepperData(Record):
    """Linear part and elements of steps in Python; arrays may be overwritten.

    Attributes
    ----------
    n, m : int
        Coordinates and ports.
    mass, damping, stiffness : array (n, n)
        Matrices of the linear part.
    linear : array (n, n)
        Jacobian without the elements.
    transform : array (m, n)
        Displacements of the ports by the coordinates.
    weight : array (n,)
        Makes forces and moments comparable.
    port_stiffness, port_damping : array (m, m)
        Those of the elements.
    room : array (n, n)
        Work space.
    """

    _fields_ = (
        ("n", ctypes.c_int64),
        ("m", ctypes.c_int64),
        *(
            (name, numbers)
            for name in (
                "mass", "damping", "stiffness", "linear", "transform", "weight", "port_stiffness", "port_damping",
                "room",
            )
        ),
    )  # fmt: skip
    shapes: ClassVar = {
        **dict.fromkeys(("mass", "damping", "stiffness", "linear", "room"), ("n", "n")),
        "transform": ("m", "n"),
        "weight": ("n",),
        "port_stiffness": ("m", "m"),
        "port_damping": ("m", "m"),
    }


@functools.cache
def _functions() -> tuple[Callable[..., Any], ...]:
    """Functions of the library: motion of the ports, forces out of balance, Newton's change, elimination."""
    checked(StepperData, "ehd_stepper_data")
    pointer, number = ctypes.c_void_p, ctypes.c_double
    return (
        function("ehd_port_motion", pointer, pointer, pointer, pointer, result=None),
        function("ehd_unbalanced", *[pointer] * 8, result=None),
        function("ehd_correction", pointer, number, number, pointer),
        function("ehd_eliminate", ctypes.c_int64, pointer, pointer),
    )


def port_motion(data: StepperData, q: FloatArray, v: FloatArray, motion: FloatArray) -> None:
    """Displacement and velocity of all ports, into `motion` (2, m), from those of the coordinates.

    Parameters
    ----------
    data : StepperData
        The step.
    q, v : array, shape (n,)
        Coordinates and their rates.
    motion : array, shape (2, m)
        Displacements of the ports and their rates, the result.
    """
    _functions()[0](data.address, _at(q), _at(v), _at(motion))


def unbalanced(
    data: StepperData,
    state: tuple[FloatArray, FloatArray, FloatArray],
    loads: FloatArray,
    port_force: FloatArray,
    force: FloatArray,
) -> tuple[float, float]:
    """Forces that are out of balance; their weighted size, and that of the forces that balance.

    Parameters
    ----------
    data : StepperData
        The step.
    state : tuple of array
        Displacement, velocity and acceleration, shape (n,) each.
    loads, port_force : array
        Loads on the coordinates, shape (n,), and forces of the elements at the ports, shape (m,).
    force : array, shape (n,)
        Forces out of balance, the result.
    """
    sizes = (ctypes.c_double * 2)()
    _functions()[1](data.address, *map(_at, (*state, loads, port_force, force)), ctypes.addressof(sizes))
    return sizes[0], sizes[1]


def correction(data: StepperData, by_q: float, by_v: float, force: FloatArray) -> FloatArray | None:
    """Newton's change of the acceleration, shape (n,); None if there is none.

    Parameters
    ----------
    data : StepperData
        The step.
    by_q, by_v : float
        Derivatives of displacement and rate by the acceleration [s2], [s].
    force : array, shape (n,)
        Forces that are out of balance.
    """
    change = force.copy()
    return change if _functions()[2](data.address, by_q, by_v, _at(change)) else None


def eliminate(matrix: FloatArray, right: FloatArray) -> bool:
    """Gaussian elimination with partial pivoting, in place; False if singular or not finite.

    Parameters
    ----------
    matrix : array, shape (n, n)
        The matrix, overwritten.
    right : array, shape (n,)
        Right-hand side; the solution afterwards.
    """
    return bool(_functions()[3](right.size, _at(matrix), _at(right)))


def _at(array: FloatArray) -> int:
    """Address of the numbers of an array."""
    return address(array, _DTYPE, "time step")
