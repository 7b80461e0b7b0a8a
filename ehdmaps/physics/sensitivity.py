"""What an error of the pressure-viscosity coefficient makes of the film, by the film formula of Moes."""

from __future__ import annotations

from ehdmaps.physics.contact import LineContact
from ehdmaps.physics.films import moes_central
from ehdmaps.physics.lubricant import LubricantState
from ehdmaps.physics.moes import moes_groups


def film_change(contact: LineContact, state: LubricantState, load: float, speed: float, factor: float) -> float:
    """Relative change of the central film where alpha is `factor` times what is taken.

    Only L changes: it goes with alpha. In the piezoviscous-elastic regime a film goes with about the square root of
    alpha; where the oil is nearly isoviscous or the contact nearly rigid, with less or a little more.

    Parameters
    ----------
    contact : LineContact
        The contact.
    state : LubricantState
        The oil at its temperature.
    load, speed : float
        w [N/m] and entrainment speed u [m/s], both > 0.
    factor : float
        alpha over the alpha of the oil, >= 0.
    """
    alpha = state.pressure_viscosity.pressure_viscosity
    M, L = moes_groups(load, speed, state.viscosity, alpha, contact.radius, contact.reduced_modulus)
    return float(moes_central(M, factor * L) / moes_central(M, L) - 1.0)
