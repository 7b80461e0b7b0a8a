"""Shear stress at the walls of a film in pure rolling, against the pressure: where an oil cannot be Newtonian.

The gradient of the pressure is held by the walls: tau = (h/2) dp/dx at each of them. An oil bears a shear stress of
some hundredths of its pressure, and gives way beyond (E. Hoglund, B. Jacobson, J. Tribology 108 (1986) 571-578).
"""

from __future__ import annotations

import numpy as np

from ehdmaps.arrays import FloatArray

NEWTONIAN_LIMIT = 0.1
"""Wall stress over pressure above which a point is flagged: a choice, above the limiting stresses that oils have."""

NEWTONIAN_STRESS = 1e6
"""Shear stress up to which every oil is taken as Newtonian [Pa], a choice: mineral oils have Eyring stresses of 2 to
10 MPa. Thick films under little load have small pressures, steep beside themselves, and hardly any stress."""

LOADED = 0.1
"""Part of the largest pressure below which a place does not count: at the exit the pressure itself goes to zero."""


def wall_stress_share(position: FloatArray, pressure: FloatArray, film: FloatArray) -> float:
    """Largest ratio of wall stress to pressure, between neighbouring places.

    At the front of a pressure spike it is that of the steepest cell; narrower cells show more.

    Parameters
    ----------
    position, pressure, film : ndarray, shape (n,)
        Rising places, pressures that are not negative [Pa], and film thicknesses there; lengths in one unit.

    Returns
    -------
    float
        max of (h/2) abs(dp/dx)/p where p is above a tenth of the largest pressure and the stress above
        `NEWTONIAN_STRESS`; 0 where there is no such place.

    Examples
    --------
    A film of 1 um, whose pressure falls from 1 to 0.6 GPa over 2 um:

    >>> x = np.array([0.0, 2e-6])
    >>> wall_stress_share(x, np.array([1e9, 0.6e9]), np.array([1e-6, 1e-6]))
    0.125
    """
    between = 0.5 * (pressure[1:] + pressure[:-1])
    stress = 0.25 * (film[1:] + film[:-1]) * np.abs(pressure[1:] - pressure[:-1]) / (position[1:] - position[:-1])
    counted = (between > LOADED * float(np.max(pressure))) & (stress > NEWTONIAN_STRESS)
    return float(np.max(stress[counted] / between[counted], initial=0.0))


def wall_stress_note(position: FloatArray, pressure: FloatArray, film: FloatArray) -> str:
    """What a solution says of a wall stress that no Newtonian oil has; empty where it is admissible.

    Parameters
    ----------
    position, pressure, film : ndarray, shape (n,)
        The arguments of `wall_stress_share`.
    """
    share = wall_stress_share(position, pressure, film)
    if share <= NEWTONIAN_LIMIT:
        return ""
    return f"wall stress {share:.2g} of the pressure, above {NEWTONIAN_LIMIT:g}: no oil is Newtonian there"
