"""Energy that dry contacts of tapered rollers store, and the work of centrifugal loads and gyroscopic moments on them.

Contacts at rest store U, the sum of the integrals of their loads over the approaches. With the balance of each roller

    dU/dt = f . dD/dt + F . dV/dt,

V and D of `ehdmaps/kernel/c/taper/taper_balance.c`, f the forces of the ring on its rollers: the first part is the work
of the ring and of the turning cage, the second one that of speed.
"""

from __future__ import annotations

import numpy as np

from ehdmaps.arrays import FloatArray
from mbs.bearings.tapered.kernel_structs import FIRST_RIB, functions
from mbs.bearings.tapered.tapered_shape import RollerLaws, TaperedShape


def place_work(rollers: FloatArray, loads: tuple[float, float], last: FloatArray) -> float:
    """Work of the centrifugal loads and gyroscopic moments since the last call [J], by the trapezoidal rule.

    Parameters
    ----------
    rollers : array (Z, COLUMNS)
        Numbers of the rollers, see `mbs.bearings.tapered.kernel_structs`.
    loads : (float, float)
        Centrifugal load [N], and moment [N m].
    last : array (Z, 4)
        Places of the last call, radial [m] and turned [rad], and its loads; written.
    """
    given = np.array(loads)
    return functions().speed_work(rollers.shape[0], rollers.ctypes.data, given.ctypes.data, last.ctypes.data)


def dry_energy(laws: RollerLaws, shape: TaperedShape, rollers: FloatArray) -> float:
    """Energy of dry contacts [J], 9/19 Q times the approach of each slice, and 2/5 of ribs.

    Parameters
    ----------
    laws, shape : RollerLaws, TaperedShape
        Laws of the contacts, lengths of the bearing.
    rollers : array (Z, COLUMNS)
        Numbers of the rollers, see `mbs.bearings.tapered.kernel_structs`.
    """
    place, ring = rollers[:, 9:12], rollers[:, 12:15]
    count = shape.ribs.laws.size
    ribs = rollers[:, FIRST_RIB : FIRST_RIB + count]
    total = 0.4 * float(np.sum(ribs ** (5.0 / 3.0) * shape.ribs.laws ** (-2.0 / 3.0)))
    for coefficient, normal, moved in ((laws.cup, shape.cup, place), (laws.cone, shape.cone, ring - place)):
        approach = moved[:, :2] @ np.array(normal)
        depth = approach[:, None] + moved[:, 2:] * shape.levers - shape.profile
        total += 9.0 / 19.0 * coefficient / shape.levers.size * float(np.sum(depth.clip(min=0.0) ** (19.0 / 9.0)))
    return total
