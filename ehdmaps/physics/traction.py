"""Traction of a line contact over the slide-to-roll ratio, on a film that is solved already.

Where the surfaces differ in speed by du = S u, the film is sheared besides. Its mean stress across the film, tau,
follows from the viscosity at the pressure p and from a law of shear stress; the traction coefficient is Int tau dx/w,
of the mean of both walls. Each wall feels half of the rolling force besides, see `ehdmaps.physics.rolling`.

The film is that of pure rolling, Newtonian and isothermal: slip of 0.1 changes its central film by less than 2 % where
it does not heat it. Heat is what a traction above S = 0.1 lacks most: at 0.9 GPa and S = 1 the real one is about half.
Behind the exit of the film, where it ruptures, nothing is counted.

References
----------
H. Eyring, Journal of Chemical Physics 4, 1936, 283-291. R.-T. Lee, B. J. Hamrock, Journal of Tribology 112, 1990,
486-496.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.physics.lubricant import LubricantState
from ehdmaps.physics.rheology import LIMITING, LIMITING_STRESS_AT_REST, ShearLaw, yielding

_LARGEST = 300.0

StressLaw = Callable[[FloatArray, FloatArray, FloatArray], FloatArray]
"""From viscosity [Pa s], shear rate du/h [1/s] and h/2 dp/dx [Pa] to the mean stress [Pa]."""


@dataclass(frozen=True)
class FilmProfile:
    """Pressure and film along a contact, from the inlet to the exit of the film.

    Attributes
    ----------
    x, pressure, film : ndarray, shape (n,)
        Positions from the contact centre, increasing [m]; p [Pa]; h [m].
    """

    x: FloatArray
    pressure: FloatArray
    film: FloatArray


def newtonian_stress(viscosity: FloatArray, rate: FloatArray, gradient_stress: FloatArray) -> FloatArray:
    """Mean stress of a Newtonian film, eta du/h [Pa]; it knows no bound, and leaves what oils can bear above 0.6 GPa.

    Parameters
    ----------
    viscosity, rate : ndarray
        eta [Pa s] and du/h [1/s].
    gradient_stress : ndarray
        Stress h/2 dp/dx that the pressure gradient adds on the walls [Pa]: of no effect here.
    """
    return np.asarray(viscosity * rate)


def eyring_stress(stress: float) -> StressLaw:
    """Law of Eyring, rate = (tau0/eta) sinh(tau/tau0) at every height, with the stress tau0 [Pa].

    The mean stress is tau0 asinh(eta du/(h tau0) q/sinh q) with q = h/(2 tau0) dp/dx: the pressure gradient thins too.
    """

    def law(viscosity: FloatArray, rate: FloatArray, gradient_stress: FloatArray) -> FloatArray:
        q = np.minimum(np.abs(gradient_stress) / stress, _LARGEST)
        thinning = np.where(q > 1e-6, q / np.sinh(np.maximum(q, 1e-6)), 1.0)
        return np.asarray(stress * np.arcsinh(viscosity * rate / stress * thinning))

    return law


def limiting_stress(pressure: FloatArray, ratio: float, stress: float = LIMITING_STRESS_AT_REST) -> StressLaw:
    """Law with a limiting stress that rises with pressure, that of `ehdmaps.physics.rheology`.

    The shear of the pressure gradient is left out: where the bound acts, it is far below it.

    Parameters
    ----------
    pressure : ndarray, shape (n,)
        p along the film [Pa].
    ratio, stress : float
        Lambda, and tau0 [Pa].
    """
    shear = ShearLaw(LIMITING, stress, ratio)

    def law(viscosity: FloatArray, rate: FloatArray, gradient_stress: FloatArray) -> FloatArray:
        newton = viscosity * rate
        factors = [yielding(shear, y, p)[0] for y, p in zip(newton.tolist(), pressure.tolist(), strict=True)]
        return np.asarray(newton * np.array(factors))

    return law


def traction_coefficients(
    profile: FilmProfile, oil: LubricantState, load: float, speed: float, slide_to_roll: FloatArray, law: StressLaw
) -> FloatArray:
    """Traction coefficient at each slide-to-roll ratio, of the sign of that, shape (k,).

    Parameters
    ----------
    profile : FilmProfile
        The film.
    oil : LubricantState
        The oil at the temperature of the film.
    load, speed : float
        w [N/m], u [m/s].
    slide_to_roll : ndarray, shape (k,)
        S = (u2 - u1)/u.
    law : callable
        `newtonian_stress`, or one that `eyring_stress` or `limiting_stress` gives.
    """
    viscosity = oil.viscosity * np.exp(oil.pressure_viscosity.log_ratio(profile.pressure))
    gradient = 0.5 * profile.film * np.gradient(profile.pressure, profile.x)
    found = [
        np.trapezoid(law(viscosity, abs(slip) * speed / profile.film, gradient), profile.x) for slip in slide_to_roll
    ]
    return np.asarray(np.sign(slide_to_roll) * np.array(found) / load)
