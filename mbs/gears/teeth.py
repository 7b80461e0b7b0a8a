"""Stiffness of a pair of teeth by ISO 6336-1:2006, clause 9, method B."""

from __future__ import annotations

import math


def tooth_stiffness(
    teeth: tuple[int, int],
    shifts: tuple[float, float] = (0.0, 0.0),
    helix_angle: float = 0.0,
    pressure_angle: float = math.radians(20.0),
) -> float:
    """Single stiffness c' of a pair of steel teeth for each metre of face width [N/m2], ISO 6336-1, method B.

    Parameters
    ----------
    teeth : (int, int)
        Numbers of teeth z1 <= z2.
    shifts : (float, float)
        Profile shifts x1, x2.
    helix_angle, pressure_angle : float
        Helix angle, pressure angle of the normal section [rad].

    Notes
    -----
    Of solid discs, virtual teeth z/(cos(beta_b)^2 cos(beta)), and the basic rack A of ISO 53, under 100 N/mm of
    specific load and more; below, flanks are softer, (w/100 N/mm)^(1/4). The standard's regression is for x1 >= x2 and
    -0.5 <= x1 + x2 <= 2.

    Examples
    --------
    >>> round(1e-9 * tooth_stiffness((21, 23)), 2)
    11.85
    """
    helix, (x1, x2) = math.cos(helix_angle), shifts
    # teeth of the virtual spur gears, about z/cos(beta)^3
    one, other = (z / (helix * (1.0 - (math.sin(helix_angle) * math.cos(pressure_angle)) ** 2)) for z in teeth)
    flexibility = 0.04723 + 0.15551 / one + 0.25791 / other
    flexibility += -0.00635 * x1 - 0.11654 * x1 / one - 0.00193 * x2 - 0.24188 * x2 / other
    flexibility += 0.00529 * x1**2 + 0.00182 * x2**2
    rack = (1.0 + 0.5 * (1.2 - _DEDENDUM)) * (1.0 - 0.02 * (20.0 - math.degrees(pressure_angle)))
    return 1e9 / flexibility * _MEASURED * rack * helix


_MEASURED = 0.8
"""Factor C_M of the standard: what measured teeth have of calculated stiffness."""

_DEDENDUM = 1.25
"""Dedendum of the basic rack, in modules."""
