"""Friction of a whole bearing by catalogue formulas, where that of its films is not known or not all of it.

References
----------
A. Palmgren, Ball and Roller Bearing Engineering, SKF, 1959.
T. A. Harris, M. N. Kotzalas, Essential Concepts of Bearing Technology, CRC, 2007, chapter on friction. Factors of
cylindrical roller bearings with a cage, from memory: f0 0.6 to 1 with grease and 2.2 to 4 in an oil bath, f1 2e-4 to
4e-4.
"""

from __future__ import annotations

import math

_STIFF_OIL = 2000.0
_RPM = 30.0 / math.pi


def viscous_torque(f0: float, viscosity: float, speed: float, pitch_diameter: float) -> float:
    """Palmgren's torque of the oil in a bearing, whatever its load [N m].

    M_0 = 1e-7 f0 (nu n)^(2/3) d_m^3 in N mm, mm2/s, rpm and mm, with nu n of 2000 at least.

    Parameters
    ----------
    f0 : float
        Factor of the kind of bearing and lubrication.
    viscosity : float
        Kinematic viscosity nu [m2/s] at the temperature of operation.
    speed : float
        Speed of one ring against the other [rad/s], of either sign.
    pitch_diameter : float
        d_m [m].

    Examples
    --------
    An NU308 in a bath of 95 mm2/s, at 1500 rpm:

    >>> round(1e3 * viscous_torque(2.2, 95e-6, 1500.0 / _RPM, 66e-3), 1)
    172.6
    """
    product = max(viscosity * 1e6 * abs(speed) * _RPM, _STIFF_OIL)
    torque: float = 1e-3 * 1e-7 * f0 * product ** (2.0 / 3.0) * (1e3 * pitch_diameter) ** 3
    return torque


def load_torque(f1: float, load: float, pitch_diameter: float) -> float:
    """Palmgren's torque of the load, M_1 = f1 F d_m [N m].

    Parameters
    ----------
    f1 : float
        Factor of the kind of bearing.
    load : float
        Radial force F [N].
    pitch_diameter : float
        d_m [m].
    """
    return f1 * abs(load) * pitch_diameter
