"""Rolling moment of a bearing by the formula of a manufacturer's catalogue."""

from __future__ import annotations

import math


def skf_rolling_moment(speed_rpm: float, viscosity: float, load: float) -> float:
    """SKF's M_rr of an NU bearing of series 3 with d 40 and D 90 mm, in an oil bath of low level [N mm].

    M_rr = phi_ish phi_rs R1 dm^2.41 F^0.31 (nu n)^0.6 as in SKF's catalogue, "Rolling bearings", table of G_rr. The
    constants R1 = 1.09e-6 (series 3), K_rs = 3e-8 (low oil bath) and K_Z = 5.1 are from memory, and not checked.

    Parameters
    ----------
    speed_rpm : float
        Speed [rpm].
    viscosity : float
        Kinematic viscosity [mm2/s].
    load : float
        Radial load [N].
    """
    bore, outside, mean = 40.0, 90.0, 65.0
    heating = 1.0 / (1.0 + 1.84e-9 * (speed_rpm * mean) ** 1.28 * viscosity**0.64)
    starved = math.exp(-3e-8 * viscosity * speed_rpm * (bore + outside) * math.sqrt(5.1 / (2.0 * (outside - bore))))
    return heating * starved * 1.09e-6 * mean**2.41 * load**0.31 * (viscosity * speed_rpm) ** 0.6
