"""Rolling force of a line contact: what the film resists with to pure rolling, per unit length.

Both walls run at u, so that only the pressure gradient shears the film: tau = dp/dx (y - h/2). Each wall feels
h/2 dp/dx against its motion, and the two together

    F = Int h dp/dx dx,        power lost in the film: F u.

The integral runs to the exit of the film; behind it the oil runs along with the walls. No shear law enters.
"""

from __future__ import annotations

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.physics._values import Values, as_given

RIGID_ROLLING_CONSTANT = 4.159245
"""F/sqrt(eta u w) of the rigid isoviscous rolling film with the Reynolds exit; see `rigid_rolling_force`."""


def film_times_rise(film: FloatArray, pressure: FloatArray) -> float:
    """Int h dp over the nodes of a grid, to fourth order in the index of the nodes.

    The nodes may be graded, as long as they are smoothly so; dp vanishes at both ends, as it does at the exit of a film
    and far before it. The unit is that of film times pressure.

    Parameters
    ----------
    film, pressure : ndarray, shape (n,)
        h and p at the nodes, along the rolling; n >= 4.

    Examples
    --------
    >>> x = np.linspace(-1.0, 1.0, 41)
    >>> round(film_times_rise(1.0 - x, (1.0 - x**2) ** 2), 5), round(16 / 15, 5)
    (1.06667, 1.06667)
    """
    middle = 0.5 * (film[1:] + film[:-1])
    bend = film[:-3] - film[1:-2] - film[2:-1] + film[3:]
    # h half-way less h''/24: -1/16 and -1/48 of the bend, which is 2 h''
    middle[1:-1] -= bend / 12.0
    return float(middle @ (pressure[1:] - pressure[:-1]))


def rolling_force_of_inlet(distance: float, film: float, flow: float, wedge: float, radius: float) -> float:
    """Int h dp/dx dx over all of the inlet before a place, where the gap is a parabola and the oil as at rest.

    dp/dx = wedge (h - flow)/h^3 and h = film + (s^2 - distance^2)/(2 radius) at the distances s beyond. In SI wedge is
    12 eta0 u.

    Parameters
    ----------
    distance : float
        Distance of the place before the contact centre, many film lengths sqrt(2 h R).
    film : float
        h at the place.
    flow : float
        Mass flow over density at rest and speed: the film whose oil at rest the contact takes in.
    wedge : float
        Factor of Reynolds' equation.
    radius : float
        Reduced radius R; it is 1 where films are in b^2/R and lengths in b.
    """
    least = film - 0.5 * distance**2 / radius
    once = 2.0 * radius / distance * (1.0 - 2.0 * least * radius / (3.0 * distance**2))
    twice = 4.0 * radius**2 / (3.0 * distance**3)
    return wedge * (once - flow * twice)


def rigid_rolling_force(load: Values, speed: float, viscosity: float) -> Values:
    """Rolling force of a rigid isoviscous film, F = 4.159 sqrt(eta u w) [N/m], both walls together.

    The limit of light loads, whatever the radius: w = 4.895 eta u R/h and F = 9.202 eta u sqrt(R/h), with the free exit
    of Reynolds' condition.

    Parameters
    ----------
    load : float or array
        w [N/m].
    speed : float
        Entrainment speed u [m/s].
    viscosity : float
        eta [Pa s].

    Examples
    --------
    >>> round(rigid_rolling_force(100.0, speed=2.0, viscosity=0.1), 3)
    18.601
    """
    return as_given(RIGID_ROLLING_CONSTANT * np.sqrt(viscosity * speed * np.asarray(load)), load)


def matsuyama_rolling_force(
    load_number: Values, speed_number: float, material_number: float, radius: float, reduced_modulus: float
) -> Values:
    """Rolling force of a loaded contact, F = 14.2 E' R U^0.75 G^-0.04 W^0.08 [N/m], both walls together.

    A fit to numerical solutions of isothermal line contacts; its moment on a roller, per length, is F R.

    Parameters
    ----------
    load_number : float or array
        W = w/(E'R).
    speed_number : float
        U = eta0 u/(E'R), u the mean of the surface speeds; see `ehdmaps.physics.moes.dowson_groups`.
    material_number : float
        G = alpha E'.
    radius : float
        R [m].
    reduced_modulus : float
        E' [Pa].

    References
    ----------
    Matsuyama's fit as quoted in Machines 11, 2023, 801.

    Examples
    --------
    >>> round(matsuyama_rolling_force(2e-4, 1e-10, 3745.0, 0.01, 2.2753e11), 2)
    371.94
    """
    number = speed_number**0.75 * material_number**-0.04 * load_number**0.08
    return as_given(14.2 * reduced_modulus * radius * number, load_number)
