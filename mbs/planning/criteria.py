"""Criteria for the physics of films that matters at a contact, by closed forms alone: no map, no solution.

Each criterion is a size to be held against a tolerance: by how much stiffness k or damping c of a contact would change,
as a part of it. How often the criteria are right is measured by `python -m tests.benchmarks.bench_auto_criteria`.

The contact behind them is that of Moes' central film h(w): the film gives way by s = -dh/dw, the solids by S, so that
k = 1/(S + s). Between rigid surfaces the film follows with the natural time T = sqrt(b^2 + 2 h R)/u, so that its loss
is s T; a loaded contact loses 4/(pi E') n h R/(b u) besides, because its inlet moves with the edge of the Hertz zone (n
is the exponent of the film in the speed). c is k^2 times the loss.

================  ================================================================================================
film memory       |dZ/Z| of the dynamic stiffness k + i omega c beside k + i omega c/(1 + i omega theta)
oil supply        k and c on a layer, by the closed forms of starved rigid surfaces (`ehdmaps.physics.oil_supply`)
inlet heat        film, film compliance and loss by the rule of films with it (`ehdmaps.physics.heat`)
limiting stress   whether a contact is in a deep damping valley; outside it films in pure rolling hardly feel it
roughness         Lambda, the smallest film over the roughness: asperities touch below `TOUCHING`; k and c by the
                  load sharing of contact laws on the closed film
================  ================================================================================================
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from ehdmaps.arrays import BoolArray, ComplexArray, FloatArray
from ehdmaps.maps.rough_layer import RoughLayer, SmoothContact, sharing_effect
from ehdmaps.physics.closed_form import minimum_film, moes_film
from ehdmaps.physics.contact import LineContact, OperatingPoint
from ehdmaps.physics.heat import VALLEY_OIL_NUMBER, inlet_heat, inlet_heats
from ehdmaps.physics.hertz import half_width, natural_time
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.moes import moes_groups, valley_load_number
from ehdmaps.physics.oil_supply import CORNER, compliance_ratio, damping_ratio, edge_compliance, film_ratio, passing
from ehdmaps.physics.surface import Surface

TOUCHING = 3.0
"""Lambda below which asperities touch, as of the usual charts of rolling bearings."""

STRESS_FELT = 0.5
"""Distance from the bottom of the damping valley in ln M within which a limiting shear stress is felt."""

_SPEED_EXPONENT = 0.7
"""Exponent of the film of a loaded line contact in the speed, as of Dowson and Higginson."""

_LONGEST = 1.4
"""Longest relaxation time in natural times, as in `ehdmaps.maps.kernels.locked_film`: a film that hardly gives way."""


@dataclass(frozen=True, eq=False)
class ClosedContact:
    """A contact in closed form, over its loads; arrays of the shape of `load`.

    Attributes
    ----------
    contact : LineContact
        The contact.
    load : array
        w [N/m], > 0.
    speed, temperature : float
        u [m/s], > 0, and T [K].
    film, minimum_film : array
        Moes' central film and the smallest film [m].
    solids, film_compliance : array
        S and s [m2/N].
    loss : array
        Loss compliance [m2 s/N].
    time : array
        Natural time [s].
    zeta : array
        ln(M/M_valley(L)).
    oil_number : float
        Moes' oil number L.
    """

    contact: LineContact
    load: FloatArray
    speed: float
    temperature: float
    film: FloatArray
    minimum_film: FloatArray
    solids: FloatArray
    film_compliance: FloatArray
    loss: FloatArray
    time: FloatArray
    zeta: FloatArray
    oil_number: float

    @property
    def stiffness(self) -> FloatArray:
        """k [N/m2]."""
        return np.asarray(1.0 / (self.solids + self.film_compliance))

    @property
    def damping(self) -> FloatArray:
        """c [N s/m2]."""
        return np.asarray(self.loss * self.stiffness**2)

    def with_memory(self, omega: float) -> ComplexArray:
        """Dynamic stiffness k + i omega c/(1 + i omega theta) at an angular frequency [N/m2].

        The relaxation time is theta = c/(k_s - k) with the stiffness k_s of the solids, as of
        `ehdmaps.maps.kernels.memory_table`.

        Parameters
        ----------
        omega : float
            Angular frequency [rad/s].
        """
        k, c = self.stiffness, self.damping
        with np.errstate(divide="ignore"):
            theta = np.minimum(c * self.solids / (self.film_compliance * k), _LONGEST * self.time)
        return np.asarray(k + 1j * omega * c / (1.0 + 1j * omega * theta))


def closed_contact(
    contact: LineContact, lubricant: Lubricant, load: FloatArray, speed: float, temperature: float
) -> ClosedContact:
    """A contact in closed form.

    Parameters
    ----------
    contact : LineContact
        Radius, solids, structural law.
    lubricant : Lubricant
        The oil.
    load : array
        w [N/m], > 0.
    speed, temperature : float
        u [m/s], > 0, and T [K].

    References
    ----------
    Films as of `ehdmaps.physics.closed_form`: Moes, Dowson and Higginson, Martin.
    """
    state, radius, modulus = lubricant.at(temperature), contact.radius, contact.reduced_modulus
    alpha = state.pressure_viscosity.pressure_viscosity
    M, L = moes_groups(load, speed, state.viscosity, alpha, radius, modulus)
    film, slope = moes_film(contact, state, load, speed)
    smallest, gives = np.minimum(minimum_film(contact, state, load, speed), film), np.maximum(-slope, 0.0)
    time = np.asarray(natural_time(load, film, speed, radius, modulus))
    width = np.asarray(half_width(load, radius, modulus))
    edge = 4.0 / (math.pi * modulus) * _SPEED_EXPONENT * film * radius / (width * speed)
    solids, zeta = np.asarray(contact.structural_compliance(load)), np.log(M / valley_load_number(L))
    lost = gives * time + edge
    return ClosedContact(contact, load, speed, temperature, film, smallest, solids, gives, lost, time, zeta, float(L))


def memory_effect(state: ClosedContact, frequency: float) -> FloatArray:
    """Relative distance of the dynamic stiffness of slow motion from that with memory, |dZ/Z|.

    Parameters
    ----------
    state : ClosedContact
        The contact.
    frequency : float
        Highest frequency that is looked at [Hz].
    """
    omega = 2.0 * math.pi * frequency
    slow, followed = state.stiffness + 1j * omega * state.damping, state.with_memory(omega)
    return np.asarray(np.abs(slow - followed) / np.abs(followed))


def supply_effect(state: ClosedContact, layer: float | FloatArray) -> FloatArray:
    """By how much an oil layer changes k or c of a contact, the larger of the two as a part of the flooded value.

    Parameters
    ----------
    state : ClosedContact
        The flooded contact.
    layer : float or array (n, 1)
        Oil layer before the contact [m]; inf changes nothing.

    Notes
    -----
    Moes' film goes to the flow of the flooded contact at either end: 3/M is 1.2257 times the smallest film of rigid
    surfaces, and a loaded contact carries its central film through. As in the law on a layer, the meniscus follows a
    slow change of the load, which is in k, and is held in c (`ehdmaps.maps.oil_layer`).
    """
    passed = passing(state.film, layer)
    root, exponent = np.sqrt(passed), state.film_compliance * state.load / state.film
    ratio, slope = film_ratio(root)
    capped = 1.0 - passed**CORNER  # -d ln(r)/d ln(flow)
    following = passed * (ratio - capped * (ratio + 0.5 * root * slope))
    held = (compliance_ratio(root) * root**2) ** exponent
    lost = state.loss * (damping_ratio(root) * root**-1.5) ** exponent * held**2
    half = np.asarray(half_width(state.load, state.contact.radius, state.contact.reduced_modulus))
    edge = edge_compliance(root, exponent, passed * ratio * state.film, state.load, half, state.contact.radius)
    flooded = state.solids + state.film_compliance
    k = flooded / (state.solids + state.film_compliance * np.maximum(following, 0.0))
    c = (lost + edge * half / state.speed) / state.loss
    c *= (flooded / (state.solids + state.film_compliance * held + edge)) ** 2
    return np.asarray(np.maximum(np.abs(k - 1.0), np.abs(c - 1.0)))


def heat_effect(state: ClosedContact, lubricant: Lubricant) -> tuple[FloatArray, FloatArray]:
    """By how much heat in the inlet changes k and c of a contact, as parts of the isothermal values.

    Parameters
    ----------
    state : ClosedContact
        The isothermal contact.
    lubricant : Lubricant
        The oil; without a thermal conductivity nothing is known, which is NaN.
    """
    if lubricant.thermal_conductivity is None:
        unknown = np.full(state.load.shape, np.nan)
        return unknown, unknown
    every = (np.full(state.load.shape, value) for value in (state.speed, state.temperature))
    heat = inlet_heats(state.contact, lubricant, state.load, *every)
    warm = replace(
        state,
        film_compliance=heat.compliance(state.film_compliance, state.film),
        loss=state.loss * heat.loss_factor,
    )
    return np.abs(warm.stiffness / state.stiffness - 1.0), np.abs(warm.damping / state.damping - 1.0)


def heat_refused(state: ClosedContact, lubricant: Lubricant) -> str:
    """Say why the rule of heat in the inlet fails at one of the loads; empty where it holds at all.

    Parameters
    ----------
    state, lubricant
        Same as for `heat_effect`; an oil of known conductivity.
    """
    for load in state.load.tolist():
        heat = inlet_heat(state.contact, lubricant, OperatingPoint(load, state.speed, state.temperature))
        if heat.refused:
            return heat.refused.removeprefix("inlet heat: ").split(", ")[0]
    return ""


def stress_felt(state: ClosedContact) -> BoolArray:
    """Tell at which loads a limiting shear stress changes c notably in pure rolling: in deep damping valleys.

    Parameters
    ----------
    state : ClosedContact
        The contact.

    Notes
    -----
    There the loss of a Newtonian film passes near zero, and a little less of it is much. Solutions with a limiting
    stress and without, of FVA 3 and an ISO VG 46 in NU308, differ there in c by 10 % (L = 16) up to a factor of 3
    (L = 25), in k by 5 % at most; everywhere else in c by 5 % up to L = 27, 18 % at L = 35. See `docs/measured.md`.
    """
    return np.asarray((np.abs(state.zeta) < STRESS_FELT) & (state.oil_number > VALLEY_OIL_NUMBER))


def roughness_effect(state: ClosedContact, surface: Surface, lubricant: Lubricant) -> tuple[FloatArray, FloatArray]:
    """By how much rough surfaces change k and c of a contact, as parts of the values of smooth ones.

    Parameters
    ----------
    state : ClosedContact
        The contact of smooth surfaces.
    surface : Surface
        Rough surfaces.
    lubricant : Lubricant
        The oil.

    Notes
    -----
    Load sharing as of `ehdmaps.maps.rough_layer`, on the closed film.
    """
    layer = RoughLayer(surface, state.contact, lubricant, state.speed)
    smooth = SmoothContact(state.load, state.film, state.film_compliance, state.loss, state.solids)
    stiffness, damping = sharing_effect(layer, smooth, state.speed, state.temperature)
    return np.abs(stiffness - 1.0), np.abs(damping - 1.0)
