"""True machines: a scene with everything that it leaves open drawn at random, solved whole at cages that stand.

Nothing here is of the code of bands: what is drawn, how far, how a scene is changed, and which mode is which are said
anew. Ranges have the sources that `mbs.unknowns.held_open` names: clearances of CN less a fit, 5 K, 10 % of a
viscosity class, 25 % of alpha by a correlation, errors of estimated geometries, 20 % of a preload, cages anywhere.
"""

from __future__ import annotations

import dataclasses
import math
from typing import Any, NamedTuple

import numpy as np
from scipy.optimize import linear_sum_assignment

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import InputError
from mbs import Scene, assemble
from mbs.linearised.linear import frequency_response
from mbs.linearised.modes import Modes, modes
from mbs.model.elements import OnRings, Operation
from mbs.model.equilibrium import Equilibrium, equilibrium

STATED = 5e-6
"""Half-width of a clearance that is stated bare [m]."""

UNSTATED = {"NU208": (5e-6, 50e-6), "NU207": (5e-6, 50e-6)}
"""Clearances of bearings that state none: CN of ISO 5753-1, 25 to 50 um of bores above 30 to 40 mm, less 20 um [m]."""

_PLACES = np.linspace(-3.0, 3.0, 61)
"""Places beside a mode where a peak is sought, in half-widths."""


class Truth(NamedTuple):
    """What is found of a true machine, in the order of a reference.

    Attributes
    ----------
    modes : array, shape (2, modes)
        Frequency [Hz] and damping ratio; NaN without a partner.
    matrices : array, shape (bearings, 2, 2)
        K [N/m] and C [N s/m] along y and z.
    peaks : array, shape (modes,)
        Response of the first sensor to the first input at the peak of each mode [its unit].
    """

    modes: FloatArray
    matrices: FloatArray
    peaks: FloatArray


def drawn(scene: Scene, random: np.random.Generator) -> Scene:
    """A machine that the scene may be."""
    u = lambda: float(random.uniform(-1.0, 1.0))  # noqa: E731
    oil = scene.lubricant
    thicker, steeper = 1.0 + 0.10 * u(), 1.0 + 0.25 * u()
    alpha = steeper * oil.at(scene.temperature).pressure_viscosity.pressure_viscosity
    law = oil.viscosity
    fields = {f.name: getattr(law, f.name) for f in dataclasses.fields(law)}
    law = dataclasses.replace(
        law, **{k: thicker * v for k, v in fields.items() if k in ("viscosity_40", "viscosity_100")}
    )
    both = {"pressure_viscosity_40": alpha, "pressure_viscosity_100": alpha}
    own = dataclasses.replace(oil.pressure_viscosity, **both)
    oil = dataclasses.replace(oil, viscosity=law, correlation=None, pressure_viscosity=own)
    loads = [
        dataclasses.replace(one, force=(1.0 + 0.2 * u()) * np.asarray(one.force)) if one.name == "preload" else one
        for one in scene.loads
    ]
    elements = [_possible(one, random) if hasattr(one, "geometry") else one for one in scene.elements]
    kelvin = scene.temperature + 5.0 * u()
    return dataclasses.replace(scene, temperature=kelvin, lubricant=oil, loads=loads, elements=elements)


def _possible(spec: Any, random: np.random.Generator) -> Any:
    """A bearing that can be built: what overlaps on its pitch circle is drawn again."""
    while True:
        try:
            return _bearing(spec, random)
        except InputError:
            continue


def _bearing(spec: Any, random: np.random.Generator) -> Any:
    """A bearing with another clearance, geometry, profile and cage."""
    u = lambda: float(random.uniform(-1.0, 1.0))  # noqa: E731
    geometry, rollers = spec.geometry, hasattr(spec.geometry, "roller_diameter")
    if rollers:
        low, high = UNSTATED[geometry.name]
        count = geometry.rollers + int(random.integers(-1, 2))
        inner = geometry.inner_raceway_diameter * (1.0 + 0.03 * u())
        changed = dataclasses.replace(
            geometry,
            estimated=None,
            clearance_range=None,
            diametral_clearance=float(random.uniform(low, high)),
            inner_raceway_diameter=inner,
            outer_raceway_diameter=inner + geometry.outer_raceway_diameter - geometry.inner_raceway_diameter,
            roller_diameter=geometry.roller_diameter * (1.0 + 0.12 * u()),
            roller_length=geometry.roller_length * (1.0 + 0.20 * u()),
            rollers=count,
        )
        profile = ("iso", "straight")[int(random.integers(2))]
        start = 2.0 * math.pi / count * float(random.random())
        return dataclasses.replace(spec, geometry=changed, profile=profile, start_angle=start)
    count = geometry.balls + int(random.integers(-1, 2))
    changed = dataclasses.replace(
        geometry,
        estimated=None,
        clearance=geometry.clearance + STATED * u(),
        ball_diameter=geometry.ball_diameter * (1.0 + 0.08 * u()),
        pitch_diameter=geometry.pitch_diameter * (1.0 + 0.02 * u()),
        balls=count,
        inner_conformity=float(random.uniform(0.515, 0.53)),
        outer_conformity=float(random.uniform(0.515, 0.53)),
    )
    return dataclasses.replace(spec, geometry=changed, start_angle=2.0 * math.pi / count * float(random.random()))


def solved(scene: Scene) -> tuple[Equilibrium, Modes]:
    """A machine at its speed, with cages that stand as they are."""
    balance = equilibrium(assemble(scene).system, Operation(scene.speed))
    return balance, modes(balance)


def truth(scene: Scene, reference: Equilibrium, known: Modes, chosen: Any) -> Truth:
    """Solve a true machine, and put its modes in the order of a reference."""
    balance, found = solved(scene)
    partner = _partners(reference, known.shapes[:, chosen], balance, found)
    partner = _planes(known.frequency[chosen], known.damping_ratio[chosen], partner, found.frequency)
    there = partner >= 0
    values = np.where(there, [found.frequency[partner], found.damping_ratio[partner]], np.nan)
    peaks = np.full(partner.size, np.nan)
    for k in np.flatnonzero(there):
        beside = values[0, k] * (1.0 + values[1, k] * _PLACES)
        peaks[k] = np.abs(frequency_response(balance, scene.inputs[:1], scene.sensors[:1], beside)).max()
    matrices = [
        [[matrix[i][axis, axis] for axis in (1, 2)] for matrix in (balance.element_stiffness, balance.element_damping)]
        for i in balance.system.select(OnRings)
    ]
    return Truth(values, np.array(matrices), peaks)


def _partners(first: Equilibrium, shapes: Any, second: Equilibrium, found: Modes) -> Any:
    """Mode of the second system that is each of the first, by shapes of translations and tilts of bodies alone."""
    names = [name for name in first.system.coordinates if name in second.system.coordinates]
    rows = [[list(one.system.coordinates).index(name) for name in names] for one in (first, second)]
    mass = first.system.mass[np.ix_(rows[0], rows[0])]
    a, b = shapes[rows[0]], found.shapes[rows[1]]
    norms = [np.sqrt(np.real(np.einsum("ik,ij,jk->k", x.conj(), mass, x))) for x in (a, b)]
    mac = np.abs(a.conj().T @ mass @ b) ** 2 / np.outer(*norms) ** 2
    i, j = linear_sum_assignment(-mac)
    partner = np.full(shapes.shape[1], -1)
    partner[i] = np.where(mac[i, j] > 0.5, j, -1)
    return partner


def _planes(frequency: FloatArray, ratio: FloatArray, partner: Any, found: FloatArray) -> Any:
    """Two modes within 3 %, damped alike to a factor of two, are two planes: the lower one is the lower one."""
    result, k = partner.copy(), 0
    while k + 1 < result.size:
        alike = 0.5 <= ratio[k + 1] / ratio[k] <= 2.0 and frequency[k + 1] / frequency[k] < 1.03
        if alike and result[k] >= 0 and result[k + 1] >= 0:
            result[k], result[k + 1] = sorted(result[k : k + 2], key=lambda mode: found[mode])
            k += 1
        k += 1
    return result
