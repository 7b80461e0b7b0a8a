"""Modes of reduced bodies that are left out: by how much they would move the modes of a system, to first order.

A body has static shapes Psi of its places, and its modes phi with these held up to a cut-off (Craig, Bampton). A mode
that is left out would add to the dynamic stiffness of the static shapes

    dZ(s) = -s^4 m m'/(w^2 + s^2),    m = Psi' M phi,

and all of them together, far below their frequencies w, -s^4 R with

    R = Psi' M K^-1 M Psi - sum of m m'/w^2 over the modes that are kept,    K with the places held,

which needs no further mode. At a frequency f each has at most 1/(1 - (f/f_c)^2) of that below the cut-off f_c. An
eigenvalue moves by d lambda = -y' dZ(lambda) x. Damping and gyroscopic terms of what is left out are not in it.

Frequencies of a shaft of two NU bearings with modes up to 20 kHz are wrong by 0.001 to 0.037 % beside all of its beams,
damping ratios by up to 0.47 %; both are told within a tenth (`tests/verification/test_mbs_shaft.py`).
"""

from __future__ import annotations

from collections.abc import Collection

import numpy as np

from ehdmaps.arrays import ComplexArray, FloatArray
from mbs.linearised.mode_part import ModePart, moved
from mbs.model.system import System

REACH = 0.9
"""Part of a cut-off up to which modes are told how wrong they are; what is left out resonates from there on."""


def cut_off(system: System) -> float:
    """Lowest cut-off of the bodies of a system [Hz]; infinite where none is reduced."""
    return min(body.cutoff for body in system.bodies)


def unknown_ends(system: System) -> tuple[str, ...]:
    """Names of the reduced bodies of which it is not known what is left out."""
    return tuple(body.name for body in system.bodies if np.isfinite(body.cutoff) and body.left_out is None)


def left_out(
    system: System,
    eigenvalues: ComplexArray,
    right: ComplexArray,
    rows: ComplexArray,
    bodies: Collection[str] | None = None,
) -> ComplexArray:
    """First-order change of eigenvalues by the modes of its bodies that are left out, shape (modes,) [1/s].

    Parameters
    ----------
    system : System
        The system.
    eigenvalues : array, shape (modes,)
        [1/s].
    right : array, shape (n, modes)
        Displacements x.
    rows : array, shape (modes, n)
        y' with y' Z'(lambda) x = 1.
    bodies : collection of str, optional
        Names of the bodies that are looked at; all if left out.
    """
    change = np.zeros(eigenvalues.shape, dtype=np.complex128)
    for body in system.bodies:
        if body.left_out is None or not (bodies is None or body.name in bodies):
            continue
        own = system.own(body.name)
        near = np.minimum(np.abs(eigenvalues) / (2.0 * np.pi * body.cutoff), REACH)
        quiet = np.sum(rows[:, own].T * (body.left_out @ right[own]), axis=0)
        change += eigenvalues**4 * quiet / (1.0 - near**2)
    return change


def reduction_part(
    system: System, eigenvalues: ComplexArray, right: ComplexArray, left: ComplexArray
) -> ModePart | None:
    """Part of frequencies and damping ratios that is left out; None where no body is reduced, or none tells.

    Parameters
    ----------
    system : System
        The system.
    eigenvalues, right, left
        The same as for `mbs.linearised.bands.LawBands.eigenvalue_changes`.
    """
    if all(body.left_out is None for body in system.bodies):
        return None
    rows = np.asarray(np.linalg.solve(system.mass.T, left.T).T, dtype=np.complex128)
    return moved(eigenvalues, left_out(system, eigenvalues, right, rows))


def undamped_part(
    system: System, frequency: FloatArray, shapes: FloatArray, bodies: Collection[str] | None = None
) -> FloatArray:
    """The same for undamped modes, as a part of their frequency, shape (modes,).

    Parameters
    ----------
    system : System
        The system.
    frequency : array, shape (modes,)
        [Hz].
    shapes : array, shape (n, modes)
        Columns phi with phi' M phi = 1.
    bodies : collection of str, optional
        Names of the bodies that are looked at; all if left out.
    """
    omega = 2.0 * np.pi * frequency
    values = np.asarray(1j * omega, dtype=np.complex128)
    # y' = phi'/(2 lambda), and d lambda/lambda is asked for
    change = left_out(system, values, shapes.astype(np.complex128), shapes.T.astype(np.complex128), bodies)
    return np.asarray(np.where(omega > 0.0, -change.real / (2.0 * np.where(omega > 0.0, omega, 1.0) ** 2), 0.0))
