"""The dense algebra of a time step, compiled: for a dozen coordinates calling numpy costs more than computing."""

from __future__ import annotations

import math

from ehdmaps.arrays import FloatArray
from ehdmaps.compiled import njit


@njit(error_model="numpy", _nrt=False)
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


@njit(error_model="numpy", _nrt=False)
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
    """Forces that are out of balance; their weighted size, and that of the forces that balance.

    Parameters
    ----------
    mass, damping, stiffness : ndarray, shape (n, n)
        Matrices of the linear part.
    transform : ndarray, shape (m, n)
        Motion of the ports from that of the coordinates.
    weight : ndarray, shape (n,)
        Makes forces and moments comparable.
    state : tuple of ndarray
        Displacement, velocity and acceleration, shape (n,) each.
    loads, port_force : ndarray
        Loads on the coordinates, shape (n,), and forces of the elements at the ports, shape (m,).
    force : ndarray, shape (n,)
        Forces out of balance, the result.
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


@njit(error_model="numpy", _nrt=False)
def eliminate(matrix: FloatArray, right: FloatArray) -> bool:
    """Gaussian elimination with partial pivoting, in place: no allocation; False if singular or not finite.

    numpy's `solve` takes seconds to compile.

    Parameters
    ----------
    matrix : ndarray
        Shape (n, n), overwritten.
    right : ndarray
        Right-hand side, shape (n,); the solution afterwards.
    """
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


@njit(error_model="numpy")
def correction(
    linear: FloatArray,
    transform: FloatArray,
    port_stiffness: FloatArray,
    port_damping: FloatArray,
    by_q: float,
    by_v: float,
    force: FloatArray,
    change: FloatArray,
) -> bool:
    """Newton's change of the acceleration, into `change` (n,); False if there is none.

    The Jacobian is `linear` and what the elements add to it: T^T (by_q K + by_v C) T.

    Parameters
    ----------
    linear : ndarray, shape (n, n)
        Jacobian without the elements.
    transform : ndarray, shape (m, n)
        Displacements of the ports by the coordinates, T.
    port_stiffness, port_damping : ndarray, shape (m, m)
        K and C of the ports.
    by_q, by_v : float
        Derivatives of displacement and rate by the acceleration [s2], [s].
    force : ndarray, shape (n,)
        Forces that are out of balance.
    change : ndarray, shape (n,)
        Change of the acceleration; written.
    """
    matrix = linear.copy()
    m, n = transform.shape
    for i in range(m):
        for k in range(m):
            slope = by_q * port_stiffness[i, k] + by_v * port_damping[i, k]
            if slope != 0.0:
                for a in range(n):
                    part = slope * transform[i, a]
                    for b in range(n):
                        matrix[a, b] += part * transform[k, b]
    for a in range(n):
        change[a] = force[a]
    solvable: bool = eliminate(matrix, change)
    return solvable
