"""Force of a gear mesh along its line of action, by the C library: `ehdmaps/kernel/c/run/gear.c` has the equations.

Each flank feels one compression and its rate. Stiffness and damping act while it is compressed; within `TOUCH` of first
contact they rise from zero, so that the force is C1 in compression and rate.
"""

from __future__ import annotations

import ctypes
import functools
from collections.abc import Callable
from typing import Any, ClassVar

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.kernel.library import checked, function
from ehdmaps.kernel.record import Record, numbers

TOUCH = 1e-7
"""Compression over which contact becomes whole [m]."""

STIFFNESS, DAMPING, BACKLASH, TEETH, PHASE = range(5)
"""Places in the array `constants` of a mesh: mean stiffness [N/m], damping [N s/m], backlash [m], mesh phase for each
angle of the system, and its beginning [rad]."""

BY_STIFFNESS, STIFFNESS_PHASE, BY_ERROR, ERROR_PHASE = range(4)
"""Rows of the array `series` of a mesh: amplitudes and phases of the harmonics of stiffness and transmission error."""

FORCE, SLOPE, BY_RATE = range(3)
"""Columns of what a flank returns."""


class MeshData(Record):
    """A mesh as C takes it.

    Attributes
    ----------
    harmonics : int
        How many harmonics.
    constants, series : array (5,), (4, harmonics)
        Constants and series; see the names of the places above.
    """

    _fields_ = (("harmonics", ctypes.c_int64), ("constants", numbers), ("series", numbers))
    shapes: ClassVar = {"constants": (5,), "series": (4, "harmonics")}


@functools.cache
def _functions() -> tuple[Callable[..., Any], ...]:
    """Functions of the library for forces, powers and energy of a mesh."""
    checked(MeshData, "ehd_gear_mesh")
    pointer, number = ctypes.c_void_p, ctypes.c_double
    return (
        function("ehd_gear_force", pointer, number, number, pointer, pointer, pointer, result=None),
        function("ehd_gear_powers", pointer, number, number, pointer, pointer, pointer, result=None),
        function("ehd_gear_energy", pointer, number, pointer, result=number),
    )


def mesh_force(mesh: MeshData, angle: float, speed: float, motion: FloatArray, rate: FloatArray) -> FloatArray:
    """Force of both flanks.

    Parameters
    ----------
    mesh : MeshData
        The mesh.
    angle, speed : float
        Angle and speed of the system [rad], [rad/s].
    motion, rate : array (2,)
        Compression of the driving and of the other flank without error and backlash [m], and its rate [m/s].

    Returns
    -------
    array (2, 3)
        Force, derivative by compression, derivative by rate, for each flank: [N], [N/m], [N s/m].
    """
    x, v, out = _pair(motion), _pair(rate), np.empty((2, 3))
    _functions()[0](mesh.address, angle, speed, x.ctypes.data, v.ctypes.data, out.ctypes.data)
    return out


def mesh_powers(
    mesh: MeshData, angle: float, speed: float, motion: FloatArray, rate: FloatArray
) -> tuple[float, float]:
    """Power that both flanks dissipate, and that stiffness and transmission error bring in as they turn [W].

    Parameters
    ----------
    mesh, angle, speed, motion, rate
        What `mesh_force` takes.
    """
    x, v, out = _pair(motion), _pair(rate), np.empty(2)
    _functions()[1](mesh.address, angle, speed, x.ctypes.data, v.ctypes.data, out.ctypes.data)
    dissipated, driven = out.tolist()
    return dissipated, driven


def mesh_energy(mesh: MeshData, angle: float, motion: FloatArray) -> float:
    """Energy that both flanks store [J].

    Parameters
    ----------
    mesh, angle, motion
        What `mesh_force` takes.
    """
    x = _pair(motion)
    return float(_functions()[2](mesh.address, angle, x.ctypes.data))


def _pair(values: FloatArray) -> FloatArray:
    """Two numbers one behind the other."""
    return np.ascontiguousarray(values, dtype=np.float64).reshape(2)
