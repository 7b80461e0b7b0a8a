"""The dense algebra of a time step, compiled: for a dozen coordinates calling numpy costs more than computing."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import numpy.typing as npt
from numba import njit

from ehdmaps.arrays import FloatArray


@njit(cache=True, error_model="numpy")
def port_motion(transform: FloatArray, q: FloatArray, v: FloatArray, motion: FloatArray) -> None:
    """Displacement and velocity of all ports, into `motion` (2, m), from those of the coordinates.

    Parameters
    ----------
    transform : ndarray
        Ports by coordinates, shape (m, n).
    q : ndarray
        Coordinates, shape (n,).
    v : ndarray
        Their rates, shape (n,).
    motion : ndarray
        Result, shape (2, m).
    """
    for i in range(transform.shape[0]):
        x = rate = 0.0
        for j in range(q.size):
            t = transform[i, j]
            x += t * q[j]
            rate += t * v[j]
        motion[0, i] = x
        motion[1, i] = rate


@njit(cache=True, error_model="numpy")
def unbalanced(
    mass: FloatArray,
    damping: FloatArray,
    stiffness: FloatArray,
    transform: FloatArray,
    weight: FloatArray,
    state: tuple[FloatArray, FloatArray, FloatArray],
    loads: FloatArray,
    port_force: FloatArray,
    force: FloatArray,
) -> tuple[float, float]:
    """Forces that are out of balance, into `force` (n,); their weighted size, and that of the forces that balance.

    `state` is displacement, velocity, acceleration; `weight` makes forces and moments comparable.
    """
    q, v, a = state
    size = by_load = by_contact = by_inertia = 0.0
    for i in range(q.size):
        inertia = linear = contact = 0.0
        for j in range(q.size):
            inertia += mass[i, j] * a[j]
            linear += damping[i, j] * v[j] + stiffness[i, j] * q[j]
        for j in range(port_force.size):
            contact += transform[j, i] * port_force[j]
        force[i] = inertia + linear - loads[i] - contact
        size += (weight[i] * force[i]) ** 2
        by_load += (weight[i] * loads[i]) ** 2
        by_contact += (weight[i] * contact) ** 2
        by_inertia += (weight[i] * inertia) ** 2
    return math.sqrt(size), math.sqrt(max(by_load, by_contact, by_inertia))


@njit(cache=True, error_model="numpy")
def correction(
    linear: FloatArray,
    transform: FloatArray,
    port_stiffness: FloatArray,
    port_damping: FloatArray,
    by_q: float,
    by_v: float,
    force: FloatArray,
) -> npt.NDArray[np.floating[Any]]:
    """Newton's change of the acceleration, (n,): the Jacobian is `linear` and what the elements add to it."""
    ports = by_q * port_stiffness + by_v * port_damping
    return np.linalg.solve(linear + transform.T @ (ports @ transform), force)
