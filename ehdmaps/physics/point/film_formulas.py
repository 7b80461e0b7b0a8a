"""Published films of lubricated elliptical contacts: flooded, isothermal, Newtonian, rolling along the short axis.

Groups of Hamrock and Dowson: U = eta0 u/(E' Rx) with the mean speed u, W = F/(E' Rx^2), G = alpha E', and the
ellipticity k = b/a >= 1.

Beside them are Moes' groups, and by these the film of a rigid contact of constant viscosity.

References
----------
B. J. Hamrock, D. Dowson, Isothermal elastohydrodynamic lubrication of point contacts, part III, Journal of Lubrication
Technology 99 (1977) 264-276.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from ehdmaps.arrays import FloatArray, Values, as_given
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


def film_of(
    formula: Callable[..., FloatArray],
    ellipse: Ellipse,
    state: LubricantState,
    load: FloatArray,
    entrainment_speed: FloatArray | float,
) -> FloatArray:
    """Film of a contact by one of these formulas [m], in the shape of the loads.

    Parameters
    ----------
    formula : callable
        Formula for h/Rx over U, W, G and k.
    ellipse : Ellipse
        The contact.
    state : LubricantState
        The oil at its temperature.
    load : array
        F [N], > 0.
    entrainment_speed : float or array
        u [m/s], > 0.
    """
    modulus, radius = ellipse.reduced_modulus, ellipse.rolling_radius
    numbers = (
        state.viscosity * entrainment_speed / (modulus * radius),
        load / (modulus * radius**2),
        state.pressure_viscosity.pressure_viscosity * modulus,
    )
    return np.asarray(radius * formula(*numbers, ellipse.ellipticity))


def hamrock_dowson_minimum(
    speed_number: FloatArray | float, load_number: Values, material_number: float, ellipticity: float
) -> Values:
    """Minimum film, h/Rx = 3.63 U^0.68 G^0.49 W^-0.073 (1 - exp(-0.68 k)).

    Fitted to 34 solutions of the piezoviscous-elastic regime, k = 1 to 8; its authors' own solutions lie within 5 % of
    it, later ones 10 to 40 % below at high M.

    Parameters
    ----------
    speed_number : float or array
        Speed number U.
    load_number : float or array
        W, > 0.
    material_number, ellipticity : float
        G, k.

    Examples
    --------
    >>> round(1e6 * hamrock_dowson_minimum(0.1683e-11, 0.1106e-6, 4522.0, 6.0), 3)
    7.001
    """
    shape = 1.0 - np.exp(-0.68 * ellipticity)
    return as_given(3.63 * speed_number**0.68 * material_number**0.49 * load_number**-0.073 * shape, load_number)


def hamrock_dowson_central(
    speed_number: FloatArray | float, load_number: Values, material_number: float, ellipticity: float
) -> Values:
    """Central film, h/Rx = 2.69 U^0.67 G^0.53 W^-0.067 (1 - 0.61 exp(-0.73 k)).

    Parameters
    ----------
    speed_number : float or array
        Speed number U.
    load_number : float or array
        W, > 0.
    material_number, ellipticity : float
        G, k.

    Examples
    --------
    >>> round(1e6 * hamrock_dowson_central(0.1683e-11, 0.1106e-6, 4522.0, 6.0), 3)
    8.736
    """
    shape = 1.0 - 0.61 * np.exp(-0.73 * ellipticity)
    return as_given(2.69 * speed_number**0.67 * material_number**0.53 * load_number**-0.067 * shape, load_number)
