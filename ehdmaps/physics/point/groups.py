"""Moes' groups of a point contact, and the film of a rigid one of constant viscosity by them."""

from __future__ import annotations

import math

import numpy as np

from ehdmaps.physics.lubricant import LubricantState
from ehdmaps.physics.point.ellipse import Ellipse


def point_groups(ellipse: Ellipse, state: LubricantState, load: float, entrainment_speed: float) -> tuple[float, float]:
    """Moes' groups M and L of a point contact.

    Parameters
    ----------
    ellipse : Ellipse
        The contact.
    state : LubricantState
        The oil at its temperature.
    load : float
        F [N].
    entrainment_speed : float
        u [m/s], > 0.
    """
    modulus, radius = ellipse.reduced_modulus, ellipse.rolling_radius
    speed = 2.0 * state.viscosity * entrainment_speed / (modulus * radius)
    with np.errstate(all="ignore"):
        M = float(np.float64(load) / (modulus * radius**2) * np.float64(speed) ** -0.75)
    return M, state.pressure_viscosity.pressure_viscosity * modulus * speed**0.25


def kapitza_film(load_number: float, curvature_ratio: float) -> float:
    """Central film of a rigid contact in units of Rx U^(1/2), full where the gap narrows and without pressure behind.

    H = 2/D (6 pi/((3 + 2 D) M))^2 has the load of p = 12 eta u |x|/((3 + 2 D) h^2). Where pressure ends with its slope
    a film carries more, so that this one is too thin.

    Parameters
    ----------
    load_number : float
        Moes' M, > 0.
    curvature_ratio : float
        D = Rx/Ry, > 0.

    References
    ----------
    P. L. Kapitza, Hydrodynamic theory of lubrication during rolling, Zh. Tekh. Fiz. 25, 1955, 747-762.

    Examples
    --------
    A circle:

    >>> round(kapitza_film(1.0, 1.0), 1)
    28.4
    """
    return 2.0 / curvature_ratio * (6.0 * math.pi / ((3.0 + 2.0 * curvature_ratio) * load_number)) ** 2
