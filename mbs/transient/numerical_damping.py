"""What the generalised-alpha method takes from an oscillation, and by how much it lengthens the period.

The method damps what its steps cannot resolve, by the spectral radius at infinite frequency, and a little of what they
do: an oscillation loses energy by the fourth power of its frequency times the cube of the step. Both follow exactly
from the largest eigenvalues of a step of an undamped oscillator.

References
----------
J. Chung, G. M. Hulbert, J. Appl. Mech. 60 (1993) 371-375. M. Arnold, O. Bruels, Multibody Syst. Dyn. 18 (2007) 185-202
(the form with forces in equilibrium at the end of each step).
"""

from __future__ import annotations

import cmath
import math

import numpy as np

from mbs.transient.stepping import Method

RESOLVED = 10.0
"""Steps a period from which on an oscillation counts as resolved: its period is 3 % too long then."""


def principal_root(spectral_radius: float, step: float, frequency: float) -> complex:
    """Factor by which a step turns and damps an undamped oscillation.

    Parameters
    ----------
    spectral_radius : float
        Spectral radius at the highest frequencies, 0 to 1.
    step : float
        Length of a step [s].
    frequency : float
        Frequency of the oscillation [Hz], > 0.

    Returns
    -------
    complex
        exp((-zeta + i) omega step) but for the errors of the method.

    Examples
    --------
    Without numerical damping it has the size 1:

    >>> round(abs(principal_root(1.0, 1e-5, 5000.0)), 12)
    1.0
    """
    method = Method(spectral_radius)
    h, square = step, (2.0 * math.pi * frequency) ** 2
    forward, turned = method.weights(h)
    old = -method.alpha_m / (1.0 - method.alpha_m)
    older = method.alpha_f / (1.0 - method.alpha_m)
    # c_new = older a + old c + ratio a_new with a = -square q; q and v by Newmark with c.
    known = np.array([-square * older, 0.0, old])
    place = np.array([1.0, h, h * h * (0.5 - method.beta)]) + h * h * method.beta * known
    rate = np.array([0.0, 1.0, h * (1.0 - method.gamma)]) + h * method.gamma * known
    place = place / (1.0 + forward * square)
    amplification = np.array([place, rate - turned * square * place, known - method.ratio * square * place])
    roots = np.linalg.eigvals(amplification)
    return complex(roots[np.argmax(np.abs(roots) * (roots.imag > 0.0))])


def numerical_damping_ratio(spectral_radius: float, step: float, frequency: float) -> float:
    """Damping ratio that the method gives to an undamped oscillation.

    Parameters
    ----------
    spectral_radius, step, frequency
        The same as for `principal_root`.

    Examples
    --------
    >>> f"{numerical_damping_ratio(0.8, 1e-5, 4000.0):.1e}"
    '1.1e-05'
    """
    exponent = cmath.log(principal_root(spectral_radius, step, frequency))
    return max(-exponent.real, 0.0) / abs(exponent)


def energy_lost(spectral_radius: float, step: float, frequency: float, duration: float = 1.0) -> float:
    """Part of the energy of an undamped oscillation that the method takes within a time, 0 to 1.

    Parameters
    ----------
    spectral_radius, step, frequency
        The same as for `principal_root`.
    duration : float
        The time [s].

    Examples
    --------
    >>> round(energy_lost(0.8, 1e-5, 4000.0), 2)
    0.42
    """
    size = abs(principal_root(spectral_radius, step, frequency))
    return -math.expm1(2.0 * math.log(min(size, 1.0)) * duration / step) if size > 0.0 else 1.0
