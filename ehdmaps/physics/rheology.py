"""Oil under shear: its laws, the stress at the walls in pure rolling, traction over the slide-to-roll ratio.

The laws are those of stress over rate of shear; this is the only place of their formulas. `ShearLaw` is the law as
plain numbers; `thinning` evaluates it by the stress, `yielding` by the rate of shear. They call nothing but `math`, so
that the same lines work as they stand and compiled for a solver by numba; `ehlFoam` has the same formulas under the
same names. `eta` is the viscosity at low shear, at the pressure and temperature of the place.

=========  ============================================================  =======================================
newtonian  eta rate = tau
eyring     eta rate = tau0 sinh(tau/tau0)                                Eyring 1936
carreau    eta rate = tau (1 + (tau/tau0)^2)^((1/n - 1)/2)               Carreau's law in stresses, Bair 2007
limiting   eta rate = tau/sqrt(1 - (tau/tau_L)^2), tau_L = tau0 + L p    circular law, Lee and Hamrock 1990
=========  ============================================================  =======================================

The circular law has a bound that no stress reaches. Above `NEAR` of it the law goes on as the power law that touches it
there: stress hardly rises any more, but its slope by the rate is never zero, and trial stresses beyond the bound are
defined. A stress beyond the bound by more than a few per cent means that the film has no solution with that law.

In pure rolling the gradient of the pressure is held by the walls: tau = (h/2) dp/dx at each of them. An oil bears a
shear stress of some hundredths of its pressure, and gives way beyond (E. Hoglund, B. Jacobson, J. Tribology 108 (1986)
571-578).

Traction is found on a film that is solved already. Where the surfaces differ in speed by du = S u, the film is sheared
besides. Its mean stress across the film, tau, follows from the viscosity at the pressure p and from a law of shear
stress; the traction coefficient is Int tau dx/w, of the mean of both walls. Each wall feels half of the rolling force
besides, see `ehdmaps.physics.films`.

The film is that of pure rolling, Newtonian and isothermal: slip of 0.1 changes its central film by less than 2 % where
it does not heat it. Heat is what a traction above S = 0.1 lacks most: at 0.9 GPa and S = 1 the real one is about half.
Behind the exit of the film, where it ruptures, nothing is counted.

References
----------
H. Eyring, Journal of Chemical Physics 4, 1936, 283-291. S. Bair, High-Pressure Rheology for Quantitative
Elastohydrodynamics, Elsevier, 2007. R.-T. Lee, B. J. Hamrock, A circular non-Newtonian fluid model: part I - used in
elastohydrodynamic lubrication, Journal of Tribology 112, 1990, 486-496.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import InputError, Problems
from ehdmaps.physics.lubricant import LubricantState

NEWTONIAN, EYRING, CARREAU, LIMITING = range(4)
"""Forms of `ShearLaw`."""

SHEARS: Mapping[str, int] = {"newtonian": NEWTONIAN, "eyring": EYRING, "carreau": CARREAU, "limiting": LIMITING}
"""Words for them, in jobs, on command lines and in cases of ehlFoam."""

EYRING_STRESS = 6e6
"""tau0 of the laws of Eyring and Carreau where none is given [Pa]: assumed. Mineral oils are measured with 4 to 10 MPa,
and few of them are."""

LIMITING_STRESS_AT_REST = 2e6
"""tau0 of the limiting law, its bound without pressure, where none is given [Pa]: assumed."""

LIMITING_RATIO = 0.05
"""Rise of the limiting stress with pressure where none is given: assumed. Measured ones are 0.03 to 0.1."""

CARREAU_EXPONENT = 0.5
"""n of Carreau's law where none is given: assumed. Measured ones are 0.3 to 0.8."""

STRESSES: Mapping[int, float] = {EYRING: EYRING_STRESS, CARREAU: EYRING_STRESS, LIMITING: LIMITING_STRESS_AT_REST}
"""tau0 of the forms that have one, where none is given [Pa]."""

SHEAR_LIMITS: Mapping[str, tuple[float, float]] = {
    "shear_stress": (1e3, 1e10),
    "limiting_ratio": (1e-3, 1.0),
    "carreau_exponent": (0.05, 1.0),
}
"""What `shear_law` takes: tau0 [Pa], Lambda and n."""

NEAR = 0.999
"""Part of the limiting stress up to which the circular law holds as written."""

_GROWTH = 1.0 / (1.0 - NEAR * NEAR)
"""d ln(rate)/d ln(tau) of the circular law there: exponent of the power law beyond."""

_MOST = 300.0
"""Largest argument of exp, sinh and powers: what is beyond is a trial far from any solution, and goes on as a line."""


_FARTHEST = 1e150
"""Largest stress over tau0, whose square is a number still."""


class ShearLaw(NamedTuple):
    """One law of shear in plain numbers, with stresses and pressures in units of the caller's choice.

    Attributes
    ----------
    form : int
        NEWTONIAN, EYRING, CARREAU or LIMITING.
    stress : float
        tau0 of the form [unit of stress]; without meaning for NEWTONIAN.
    ratio : float
        Rise L of the limiting stress with pressure [unit of stress per unit of pressure].
    exponent : float
        n of Carreau's law, 0 < n <= 1.
    """

    form: int = NEWTONIAN
    stress: float = 1.0
    ratio: float = 0.0
    exponent: float = 1.0

    def scaled(self, stress_unit: float, pressure_unit: float) -> ShearLaw:
        """The same law for stresses and pressures in units that are as many times as large."""
        return self._replace(stress=self.stress / stress_unit, ratio=self.ratio * pressure_unit / stress_unit)


def shear_law(
    shear: str = "newtonian",
    shear_stress: float | None = None,
    limiting_ratio: float | None = None,
    carreau_exponent: float | None = None,
) -> ShearLaw:
    """Law by its word, in Pa, with the default of each number that is left out.

    Parameters
    ----------
    shear : str
        A word of `SHEARS`.
    shear_stress : float, optional
        tau0 [Pa] of any law but the Newtonian.
    limiting_ratio : float, optional
        Lambda of the limiting law.
    carreau_exponent : float, optional
        n of Carreau's law.

    Raises
    ------
    InputError
        For an unknown word, a number outside `SHEAR_LIMITS`, and one that the law does not have.

    Examples
    --------
    >>> shear_law("limiting")
    ShearLaw(form=3, stress=2000000.0, ratio=0.05, exponent=1.0)
    """
    if not isinstance(shear, str) or shear not in SHEARS:
        raise InputError(f"shear: got {shear!r:.60}; allowed: {', '.join(SHEARS)}")
    form = SHEARS[shear]
    problems = Problems()
    keys = {
        "shear_stress": (shear_stress, form != NEWTONIAN),
        "limiting_ratio": (limiting_ratio, form == LIMITING),
        "carreau_exponent": (carreau_exponent, form == CARREAU),
    }
    for key, (value, belongs) in keys.items():
        low, high = SHEAR_LIMITS[key]
        if value is None:
            continue
        if not belongs:
            problems.append(f"{key}: got {value!r} with shear {shear}, which has none; leave it out")
        elif not low <= value <= high:
            problems.append(f"{key}: got {value!r}; allowed: {low:g} to {high:g}; leave it out for the default")
    problems.check()
    return ShearLaw(
        form,
        STRESSES.get(form, 1.0) if shear_stress is None else shear_stress,
        (LIMITING_RATIO if limiting_ratio is None else limiting_ratio) if form == LIMITING else 0.0,
        (CARREAU_EXPONENT if carreau_exponent is None else carreau_exponent) if form == CARREAU else 1.0,
    )


def thinning(law: ShearLaw, tau: float, p: float) -> tuple[float, float]:
    """eta rate/tau, at least 1, and d(eta rate)/d(tau), at a stress; both even in it.

    Parameters
    ----------
    law : ShearLaw
        The law.
    tau, p : float
        Stress, of either sign, and pressure in the units of the law; a negative pressure acts as zero.
    """
    if law.form == NEWTONIAN:
        return 1.0, 1.0
    if law.form == LIMITING:
        s = abs(tau) / (law.stress + law.ratio * max(p, 0.0))
        if s <= NEAR:
            left = 1.0 - s * s
            factor = 1.0 / math.sqrt(left)
            return factor, factor / left
        factor = 1.0 / math.sqrt(1.0 - NEAR * NEAR)
        growth = (_GROWTH - 1.0) * math.log(s / NEAR)
        if growth <= _MOST:
            factor *= math.exp(growth)
            return factor, factor * _GROWTH
        last = NEAR * math.exp(_MOST / (_GROWTH - 1.0))  # its tangent
        factor *= math.exp(_MOST)
        return factor * (last / s + _GROWTH * (1.0 - last / s)), factor * _GROWTH
    s = min(abs(tau) / law.stress, _FARTHEST)
    if law.form == EYRING:
        if s < 1e-4:
            return 1.0 + s * s / 6.0, 1.0 + 0.5 * s * s
        if s < _MOST:
            return math.sinh(s) / s, math.cosh(s)
        slope = math.cosh(_MOST)  # its tangent
        return math.sinh(_MOST) / s + slope * (1.0 - _MOST / s), slope
    power = 0.5 * (1.0 / law.exponent - 1.0)
    factor = math.exp(min(power * math.log1p(s * s), _MOST))
    return factor, factor * (1.0 + 2.0 * power * s * s / (1.0 + s * s))


def yielding(law: ShearLaw, newton: float, p: float) -> tuple[float, float]:
    """tau/(eta rate), at most 1, and d(tau)/d(eta rate), at a rate of shear; the inverse of `thinning`.

    Parameters
    ----------
    law : ShearLaw
        The law.
    newton, p : float
        eta rate, the stress of a Newtonian oil, of either sign [unit of stress], and pressure; a negative pressure acts
        as zero.
    """
    if law.form == NEWTONIAN:
        return 1.0, 1.0
    bound = law.stress
    if law.form == LIMITING:
        bound += law.ratio * max(p, 0.0)
    y = abs(newton) / bound
    if y < 1e-6:
        return 1.0, 1.0
    if law.form == EYRING:
        return math.asinh(y) / y, 1.0 / math.sqrt(1.0 + y * y)
    if law.form == LIMITING:
        near = NEAR / math.sqrt(1.0 - NEAR * NEAR)
        if y <= near:
            factor = 1.0 / math.sqrt(1.0 + y * y)
            return factor, factor**3
        s = NEAR * math.exp(math.log(y / near) / _GROWTH)
        return s / y, s / (y * _GROWTH)
    # Carreau: Newton in ln s, where ln y = ln s + power ln(1 + s^2) rises with a slope of 1 to 1/n
    power = 0.5 * (1.0 / law.exponent - 1.0)
    wanted = math.log(y)
    log_s = min(wanted, law.exponent * wanted) if wanted > 0.0 else wanted
    for _ in range(50):
        s = math.exp(log_s)
        share = s * s / (1.0 + s * s)
        move = (wanted - log_s - power * math.log1p(s * s)) / (1.0 + 2.0 * power * share)
        log_s += move
        if abs(move) < 1e-14:
            break
    s = math.exp(log_s)
    share = s * s / (1.0 + s * s)
    return s / y, s / (y * (1.0 + 2.0 * power * share))


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
    """Note on a wall stress of a solution that no Newtonian oil has; empty where it is admissible.

    Parameters
    ----------
    position, pressure, film : ndarray, shape (n,)
        The arguments of `wall_stress_share`.
    """
    share = wall_stress_share(position, pressure, film)
    if share <= NEWTONIAN_LIMIT:
        return ""
    return f"wall stress {share:.2g} of the pressure, above {NEWTONIAN_LIMIT:g}: no oil is Newtonian there"


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
