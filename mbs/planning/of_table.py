"""Physics of films that are read from the film table alone: which are needed, and what the table leaves out.

Whether contacts may be dry is judged by equilibria of the bearings, dry and with films. Of points no closed form says
how supply, roughness, heat or a limiting stress change k and c: verdicts say so, with what is known of the film.
"""

from __future__ import annotations

import math

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import AnalysisError, InputError
from ehdmaps.physics.heat import ISOTHERMAL, thermal_loading, viscosity_slope
from ehdmaps.physics.oil_supply import OilSupply
from ehdmaps.physics.surface import FINEST, Surface
from ehdmaps.units import RPM, SPEED
from mbs.model.elements import Operation
from mbs.model.equilibrium import equilibrium
from mbs.model.relaxation import Films
from mbs.planning.criteria import TOUCHING, film_factor
from mbs.planning.machine import largest_change
from mbs.planning.plan import PlanResult
from mbs.planning.seen import PointContact, held_films, unmapped
from mbs.planning.verdicts import Range, Verdict, beside, memory_verdict, up_to
from mbs.scene.assembly import Model
from mbs.scene.fields import MICROMETRE


def film_verdict(found: PlanResult, model: Model, tolerance: float, frequency: float, asked: Films | None) -> Verdict:
    """Judge whether contacts need their films, by equilibria of dry ones beside those with slow films.

    Parameters
    ----------
    found : PlanResult
        The plan; the lowest and the highest of its speeds count.
    model : Model
        The scene with films of the film table.
    tolerance : float
        Accepted change of stiffness, damping or, of an equilibrium, contact load, as a part.
    frequency : float
        Highest frequency that is looked at [Hz]; 0 for an equilibrium.
    asked : {"slow", "memory"} or None
        What was asked for.

    Raises
    ------
    AnalysisError
        If films were asked for that the film table has not.
    """
    name = "films"
    missing = [held.missing for entry in found.seen if (held := held_films(entry, model, found.speeds)).missing]
    if missing:
        if asked is not None:
            raise AnalysisError(f"auto, --films: got {asked}; the film table has {missing[0]}; leave --films out")
        return Verdict(name, False, math.nan, f"the film table has {missing[0]}; contacts are dry", warns=True)
    changes = [_changes(found.filled, model, speed) for speed in dict.fromkeys(found.speeds)]
    size, speed = max(zip(changes, found.speeds, strict=False), key=lambda entry: max(entry[0]))
    stiffness, load = size
    words = (
        f"dry contacts would change k of a bearing by {up_to(stiffness)} along some motion, the largest load of a "
        f"contact by {up_to(load)} at {RPM.text(speed)}"
    )
    largest = max(stiffness, load)
    if frequency > 0.0:
        largest, words = max(largest, 1.0), f"{words}, and have no damping"
    if asked is not None:
        return Verdict(name, True, largest, f"as asked; {words}")
    errors = stiffness, float(frequency > 0.0)
    return Verdict(name, largest > tolerance, largest, f"{words} ({beside(largest, tolerance)})", errors=errors)


def _changes(dry: Model, model: Model, speed: float) -> tuple[float, float]:
    """Largest changes of stiffness and of contact loads of the bearings by dry contacts; NaN without an equilibrium."""
    operation, found = Operation(speed), []
    try:
        for one in (model, dry):
            balance = equilibrium(one.system, operation)
            loads = one.largest_loads(balance.displacement, operation)
            found.append(([balance.element_stiffness[place] for place in one.ring_places], loads))
    except (AnalysisError, InputError):
        return math.inf, math.inf
    (stiffness, loads), (dry_stiffness, dry_loads) = found
    arms = [0.5 * entry.force.geometry.pitch_diameter for entry in unmapped(model)]
    largest = max(
        change_of_matrix(other, own, arm) for other, own, arm in zip(dry_stiffness, stiffness, arms, strict=True)
    )
    return largest, largest_change(dry_loads, loads)


_MOVES = (0, 1, 2, 4, 5)
_SOFTEST = 1e-6


def change_of_matrix(other: FloatArray, own: FloatArray, arm: float) -> float:
    """Largest change of a stiffness in any direction, as a part: of x' K x over all motions x that K holds.

    Parameters
    ----------
    other, own : array (6, 6)
        Stiffness of a bearing, and the one that the change is a part of [N/m, N, N m].
    arm : float
        Length by which tilts count beside displacements [m].
    """
    scale = np.array([1.0, 1.0, 1.0, 1.0 / arm, 1.0 / arm])
    first, second = (
        0.5 * (matrix + matrix.T)[np.ix_(_MOVES, _MOVES)] * np.multiply.outer(scale, scale) for matrix in (other, own)
    )
    values, directions = np.linalg.eigh(second)
    held = values > _SOFTEST * values.max()
    root = directions[:, held] / np.sqrt(values[held])
    return float(np.max(np.abs(np.linalg.eigvalsh(root.T @ first @ root) - 1.0)))


def point_verdicts(
    found: Range, frequency: float, asked: Films | None, surface: Surface | None, supply: OilSupply
) -> tuple[Verdict, ...]:
    """Judge memory, supply, roughness, heat and shear of points.

    Parameters
    ----------
    found : Range
        Operating points, of points.
    frequency : float
        Highest frequency that is looked at [Hz]; 0 for an equilibrium.
    asked : {"slow", "memory"} or None
        Films that were asked for.
    surface : Surface or None
        Surfaces that the scene states.
    supply : OilSupply
        Supply in force, which is flooded: others are refused with films.
    """
    return (
        memory_verdict(found, frequency, asked),
        Verdict("oil supply", False, math.nan, f"not judged of points, whose films are {supply.label}"),
        _roughness(found, surface),
        _heat(found),
        Verdict("limiting shear stress", False, math.nan, "not judged of points, whose films are Newtonian"),
    )


def _roughness(found: Range, surface: Surface | None) -> Verdict:
    """Lambda of points; what asperities change is not known."""
    name = "roughness"
    thinnest, state = found.carrying(lambda entry: -entry.minimum_film)
    if surface is None or surface.smooth:
        least = max(-thinnest / TOUCHING, FINEST)
        words = f"none is stated; above {MICROMETRE.text(least, 2)} asperities of points would touch"
        return Verdict(name, False, math.nan, words)
    size = -thinnest / surface.roughness
    touch = "asperities touch" if size < TOUCHING else "asperities do not touch"
    words = (
        f"Lambda of points down to {size:.2g} at {SPEED.text(state.speed)} ({touch}; they do below {TOUCHING:g}); not "
        "judged in k and c, as films of points are smooth"
    )
    return Verdict(name, False, size, words, warns=size < TOUCHING)


def _heat(found: Range) -> Verdict:
    """Heating of the inlet of points by the factor of Gupta et al., as the part by which films are thinner."""
    name, oil = "inlet heating", found.lubricant

    def thinner(state: PointContact) -> FloatArray:
        conductivity = oil.thermal_conductivity
        if conductivity is None:
            return np.full(state.load.shape, np.nan)
        loading = thermal_loading(viscosity_slope(oil, state.temperature), state.speed, conductivity)
        pressures = np.asarray(state.contact.max_pressure(state.load))
        modulus = state.contact.reduced_modulus
        return np.array([1.0 - film_factor(pressure, modulus, loading) for pressure in pressures.tolist()])

    size, state = found.carrying(thinner)
    if math.isnan(size):
        return Verdict(name, False, size, f"unknown: no thermal conductivity of {oil.title} is known")
    words = (
        f"films of points would be thinner by {'more than the formula covers' if size >= 1.0 else up_to(size)} at "
        f"{SPEED.text(state.speed)} ({beside(size, found.tolerance)}); not judged in c, and the film table is "
        f"{ISOTHERMAL}"
    )
    return Verdict(name, False, size, words, warns=size > found.tolerance)
