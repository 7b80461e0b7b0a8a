"""Published damping formulas of line contacts, per unit length unless said otherwise.

The rigid films follow from the Reynolds equation of a parabolic gap h + x^2/(2R); their constants are
verified by quadrature in the tests.
"""

from __future__ import annotations

import math

from ehdmaps.physics._values import Values, as_given

ROLLING_FILM_CONSTANT = 6.548276
"""c/(eta (R/h)^1.5) of the rigid isoviscous rolling film with the Reynolds exit."""


def rolling_film_damping(film: Values, viscosity: float, radius: float) -> Values:
    """Damping of a rigid isoviscous rolling film, c = 6.548 eta (R/h)^1.5 [N s/m2].

    The exit of the film is free (Reynolds condition) and moves with the squeeze; linear in the squeeze
    velocity, at a rate small against the rolling.

    Parameters
    ----------
    film : float or array
        h, the smallest film [m], h << R.
    viscosity : float
        eta [Pa s].
    radius : float
        R [m].

    Examples
    --------
    >>> round(rolling_film_damping(1e-6, viscosity=0.1, radius=5e-3))
    231517
    """
    return as_given(ROLLING_FILM_CONSTANT * viscosity * (radius / film) ** 1.5, film)


def squeeze_film_damping(film: Values, viscosity: float, radius: float) -> Values:
    """Damping of a rigid isoviscous squeeze film without cavitation, c = 3 sqrt(2) pi eta (R/h)^1.5 [N s/m2].

    The whole parabola carries, under tension too when the bodies part.

    Parameters
    ----------
    film : float or array
        h, the smallest film [m], h << R.
    viscosity : float
        eta [Pa s].
    radius : float
        R [m].

    Examples
    --------
    >>> round(squeeze_film_damping(1e-6, viscosity=0.1, radius=5e-3))
    471239
    """
    return as_given(3.0 * math.sqrt(2.0) * math.pi * viscosity * (radius / film) ** 1.5, film)


def rigid_inlet_damping(film: Values, viscosity: float, radius: float) -> Values:
    """Damping of the inlet half of a rigid squeeze film, c = (3/sqrt 2) pi eta (R/h)^1.5 [N s/m2].

    Half of `squeeze_film_damping`, as if the gap ended at its narrowest place. A bound only: elastic contacts
    yield, and share the velocity between film and solids.

    Parameters
    ----------
    film : float or array
        h, the smallest film [m], h << R.
    viscosity : float
        eta [Pa s].
    radius : float
        R [m].

    Examples
    --------
    >>> round(rigid_inlet_damping(1e-6, viscosity=0.1, radius=5e-3))
    235619
    """
    return as_given(0.5 * squeeze_film_damping(film, viscosity, radius), film)


def dietl_damping(
    load: Values,
    sum_speed: float,
    viscosity: float,
    pressure_viscosity: float,
    radius: float,
    reduced_modulus: float,
    length: float,
    inlet_length_factor: float,
) -> Values:
    """Dietl's regression for the damping of a whole contact [N s/m], not per unit length.

    c = K0 R^0.781 l^0.769 E'^1.069 eta0^0.531 alpha^0.424 q^-0.136 us^-0.434 f^-0.563, K0 = 0.1963,
    everything in SI units (the further factor 1e-3 of the source converts to N s/mm).

    Parameters
    ----------
    load : float or array
        q [N/m], per unit length: only so do the dimensions close, with K0 in kg^-0.04 m^0.06 s^0.115.
    sum_speed : float
        us, the sum of the surface speeds, 2u [m/s].
    viscosity, pressure_viscosity : float
        eta0 [Pa s] and alpha [1/Pa] at ambient pressure.
    radius : float
        Reduced radius [m].
    reduced_modulus : float
        E' [Pa].
    length : float
        l of the contact [m]. The formula is not additive over slices.
    inlet_length_factor : float
        f, the length factor of the inlet zone [-]. The accessible sources do not say how to find it, so
        that the formula cannot be reproduced from them alone: compare with it, do not build on it.

    References
    ----------
    P. Dietl, Damping and stiffness characteristics of rolling element bearings, PhD thesis, TU Wien, 1997;
    the regression is taken from later work that quotes it.

    Examples
    --------
    >>> c = dietl_damping(88571.4, 3.4, 0.0845, 2.24e-8, 5.5152e-3, 230.769e9, 0.7e-3, 1.0)
    >>> f"{c:.4g}"
    '341.5'
    """
    lengths: float = 0.1963 * radius**0.781 * length**0.769
    oil = viscosity**0.531 * pressure_viscosity**0.424
    speed = sum_speed**-0.434 * inlet_length_factor**-0.563
    return as_given(lengths * reduced_modulus**1.069 * oil * load**-0.136 * speed, load)
