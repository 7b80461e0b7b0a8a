"""How the films of a bearing relax: for linear analyses in which each slice answers at its own frequency.

The film of a slice moves like a damper as long as it can follow, and is locked at high frequency: stiffness and damping
k and c of the map become k + s c/(1 + s theta), with the relaxation time theta of `ehdmaps.maps.memory_table`. That is
the law which films with memory follow in time, for small oscillations about an equilibrium.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.compiled import njit
from ehdmaps.maps.memory_table import equilibrium_at
from ehdmaps.physics.hertz import half_width
from mbs.bearings.roller_loads import RollerLoads
from mbs.model.relaxation import Relaxation

if TYPE_CHECKING:
    from ehdmaps.maps.law import LawAtPoint
    from ehdmaps.maps.memory_table import MemoryTable


@njit(error_model="numpy")
def _fill_times(table: MemoryTable, approaches: FloatArray, times: FloatArray) -> None:
    """Relaxation times of contacts at rest; 0 without load."""
    for i in range(approaches.size):
        _, k, _, dy, _, dg = equilibrium_at(table, approaches[i])
        # k_s = k/(1 - dy) and G' = c k_s/(k_s - k) make theta = c/(k_s - k) = G'/k_s.
        times[i] = dg * (1.0 - dy) / k if k > 0.0 else 0.0


def relaxation_times(law: LawAtPoint, approach: FloatArray) -> FloatArray:
    """Relaxation times theta of contacts at rest [s], in the shape of their approaches [m]; 0 without load or film.

    Parameters
    ----------
    law : LawAtPoint
        The law at a speed and temperature, without centrifugal load.
    approach : array
        Approaches [m].
    """
    times = np.zeros(approach.size)
    _fill_times(law.memory.table, np.ascontiguousarray(approach, dtype=np.float64).reshape(-1), times)
    return times.reshape(approach.shape)


@njit(error_model="numpy")
def _fill_rest(table: MemoryTable, approaches: FloatArray, loads: FloatArray, films: FloatArray) -> None:
    """Loads of contacts at rest, and their films: what the approach is less than that of the structure."""
    for i in range(approaches.size):
        loads[i], _, y, _, _, _ = equilibrium_at(table, approaches[i])
        films[i] = max(-y, 0.0)


def natural_times(law: LawAtPoint, approach: FloatArray) -> FloatArray:
    """Natural times sqrt(b^2 + 2 h R)/u of contacts at rest [s], in the shape of their approaches; infinite at rest.

    h is the film of each contact in series, from which the little is left out by which oil stiffens the structure.

    Parameters
    ----------
    law : LawAtPoint
        The law at a speed and temperature, without centrifugal load.
    approach : array
        Approaches [m].
    """
    loads, films = np.zeros(approach.size), np.zeros(approach.size)
    _fill_rest(law.memory.table, np.ascontiguousarray(approach, dtype=np.float64).reshape(-1), loads, films)
    contacts = law.law.contacts
    radius = sum(contact.radius for contact in contacts) / len(contacts)
    half = half_width(np.maximum(loads, 0.0), radius, contacts[0].reduced_modulus)
    size = np.sqrt(half**2 + 2.0 * films / len(contacts) * radius)
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.asarray(size / abs(law.entrainment_speed)).reshape(approach.shape)


def relaxing(rows: FloatArray, damping: FloatArray, times: FloatArray) -> Relaxation:
    """Contacts whose films relax; those that do not have a row of zeros.

    Parameters
    ----------
    rows : array, shape (r, m)
        Approach of each contact by the displacements of the ports.
    damping, times : array, shape (r,)
        c of each contact [N s/m] and theta [s].
    """
    relaxes = (damping > 0.0) & (times > 0.0)
    some = float(times[relaxes].max()) if relaxes.any() else 1.0
    times = np.where(relaxes, times, some)
    return Relaxation(rows * np.sqrt(np.where(relaxes, damping, 0.0) / times)[:, None], times)


def massless_rows(rollers: RollerLoads) -> FloatArray:
    """Approach of each slice of massless rollers by the pose of the inner ring, shape (Z n, 6).

    Parameters
    ----------
    rollers : RollerLoads
        The rollers at rest.
    """
    x = rollers.position
    cos, sin = (np.repeat(part[:, None], x.size, axis=1) for part in (np.cos(rollers.angle), np.sin(rollers.angle)))
    nothing = np.zeros_like(cos)
    return np.stack([nothing, cos, sin, nothing, -sin * x, cos * x], axis=-1).reshape(-1, 6)


def bearing_relaxation(law: LawAtPoint, rollers: RollerLoads, slice_length: float) -> Relaxation:
    """Relaxation of all slices of a bearing with massless rollers, in the pose (6,) of its inner ring.

    Parameters
    ----------
    law : LawAtPoint
        The law at the speed and temperature, without centrifugal load.
    rollers : RollerLoads
        The rollers at rest.
    slice_length : float
        Length of a slice [m].
    """
    times = relaxation_times(law, rollers.approach)
    return relaxing(massless_rows(rollers), rollers.damping.reshape(-1) * slice_length, times.reshape(-1))
