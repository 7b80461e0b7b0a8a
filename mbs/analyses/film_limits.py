"""Up to which frequency films of slow motion hold, and how wrong they are above."""

from __future__ import annotations

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.maps.law import ContactLaw
from mbs.bearings.bearing_element import BearingElement, RingElement
from mbs.bearings.bearing_force import BearingForce
from mbs.bearings.roller_element import ring_following
from mbs.linearised.validity import FilmLimit, SlowFilmError, film_limit
from mbs.model.elements import Operation
from mbs.model.equilibrium import equilibrium
from mbs.scene.assembly import Model


def film_limits(model: Model, displacement: FloatArray, operation: Operation) -> list[FilmLimit]:
    """Up to which frequency the films of each bearing follow as in slow motion.

    Empty for dry laws and constant ones, and for films with memory, except at rest, where there is no film.

    Parameters
    ----------
    model : Model
        The machine with its law.
    displacement : array, shape (n,)
        Displacement of all coordinates at the equilibrium.
    operation : Operation
        Speed and angle of the system.
    """
    limits = []
    for bearing, motion in ring_motions(model, displacement):
        if not isinstance(bearing.force, BearingForce) or not isinstance(bearing.force.law, ContactLaw):
            continue
        load = float(bearing.rollers(motion, operation).load_per_length.max())
        speed = bearing.entrainment_speed(operation)
        if model.memory == "memory" and speed != 0.0:
            continue
        limits.append(film_limit(bearing.name, bearing.bearing, load, speed))
    return limits


def slow_film_errors(model: Model, displacement: FloatArray, operation: Operation) -> list[SlowFilmError]:
    """How wrong films of slow motion are; empty where films relax, where there are none, and without a load.

    Parameters
    ----------
    model, displacement, operation
        The same as for `film_limits`.
    """
    found = []
    system = model.system
    for index in system.select(RingElement) if model.memory == "slow" else ():
        connected = system.elements[index]
        element, ports = connected.element, connected.transform @ displacement
        assert isinstance(element, RingElement)
        relaxation = element.film_relaxation(ports, operation)
        forces = element.evaluate(ports, np.zeros_like(ports), operation)
        load = float(np.linalg.norm(forces.force[1:3]))
        if relaxation is None or load == 0.0:
            continue
        along = np.array([0.0, *(forces.force[1:3] / load), 0.0, 0.0, 0.0])
        motion = ring_following(forces.stiffness) @ along
        stiffness, damping = (float(motion @ matrix @ motion) for matrix in (forces.stiffness, forces.damping))
        springs = (relaxation.rows @ motion) ** 2
        found.append(SlowFilmError(element.name, stiffness, damping, springs, relaxation.times))
    return found


def ring_motions(model: Model, displacement: FloatArray) -> list[tuple[BearingElement, FloatArray]]:
    """Each bearing with the displacement (6,) of its inner ring against the outer one."""
    return [(bearing, model.system.relative(bearing.inner, bearing.outer) @ displacement) for bearing in model.bearings]


def lowest_limits(model: Model, speeds: FloatArray, displacements: FloatArray | None = None) -> FloatArray:
    """Frequency [Hz] above which omega b/u exceeds 0.3 in one of the bearings, at each speed, shape (speeds,).

    Parameters
    ----------
    model : Model
        Model with its law.
    speeds : array, shape (speeds,)
        [rad/s].
    displacements : array, shape (speeds, n), optional
        Displacements at the equilibria; they are found if left out.

    Returns
    -------
    array, shape (speeds,)
        NaN for laws without films; 0 at rest.
    """
    found = np.full(speeds.size, np.nan)
    for index, speed in enumerate(speeds.tolist()):
        operation = Operation(speed)
        place = equilibrium(model.system, operation).displacement if displacements is None else displacements[index]
        limits = film_limits(model, place, operation)
        if not limits:
            break
        found[index] = min(limit.frequency for limit in limits)
    return found
