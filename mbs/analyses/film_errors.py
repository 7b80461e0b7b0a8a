"""Estimated errors of the films of a machine, over frequency: those of slow motion, and those with memory."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.units import RPM
from mbs.analyses.operating import operating
from mbs.linearised.validity import ContactsInBalance, FilmError
from mbs.model.contacts import slow_springs
from mbs.model.elements import Element, OnRings, Operation
from mbs.model.equilibrium import equilibrium
from mbs.model.on_rings import ring_following
from mbs.model.relaxation import FILM_WORDS, NOTABLE, Films
from mbs.scene.assembly import Model


def film_errors(
    model: Model,
    displacement: FloatArray,
    operation: Operation,
    films: Films | None = None,
) -> list[FilmError]:
    """Estimated errors of the films of all bearings; empty for laws without films, and without a load.

    Parameters
    ----------
    model : Model
        The machine with its law.
    displacement : array, shape (n,)
        Displacement of all coordinates at the equilibrium.
    operation : Operation
        Speed and angle of the system.
    films : {"slow", "memory"}, optional
        Films whose error is estimated; those of the model if left out.
    """
    found = []
    for index in model.ring_places:
        connected = model.system.elements[index]
        ports = connected.transform @ displacement
        error = film_error(connected.element, ports, operation, films or model.memory)
        found += [] if error is None else [error]
    return found


def film_error(element: Element, ports: FloatArray, operation: Operation, films: Films) -> FilmError | None:
    """Estimated error of the films of a bearing along its load; None without films, and without a load.

    By what its springs and dampers leave out, where the response of its films is known; else, of films with memory, by
    its contacts one by one as they move in slow motion.

    Parameters
    ----------
    element : Element
        The bearing, an `OnRings`.
    ports : array, shape (m,)
        Displacements of its ports at the equilibrium.
    operation : Operation
        Speed and angle.
    films : {"slow", "memory"}
        Films whose error is estimated.
    """
    assert isinstance(element, OnRings)
    relaxation = element.film_relaxation(ports, operation)
    if relaxation is None:
        return None
    forces = element.evaluate(ports, np.zeros_like(ports), operation)
    load = float(np.linalg.norm(forces.force[:3]))
    if load == 0.0:
        return None
    motion = ring_following(forces.stiffness) @ np.array([*(forces.force[:3] / load), 0.0, 0.0, 0.0])
    condensed, natural, contacts = element.small_motions(ports, operation), np.zeros(0), None
    if condensed is not None:
        if condensed.left_out is not None:
            contacts = ContactsInBalance(condensed, motion)
        elif films == "memory":
            relaxation = slow_springs(condensed.contacts, condensed.pose)
        if condensed.natural is not None:
            natural = condensed.natural.reshape(-1)
    return FilmError(
        bearing=element.name,
        films=films,
        at_rest=element.entrainment_rate * operation.speed == 0.0,
        stiffness=float(motion @ forces.stiffness @ motion),
        damping=float(motion @ forces.damping @ motion),
        springs=(relaxation.rows @ motion) ** 2,
        times=relaxation.times,
        natural=natural,
        contacts=contacts,
    )


def notable_from(model: Model, speeds: FloatArray, displacements: FloatArray | None = None) -> FloatArray:
    """Frequency [Hz] from which on the films of one of the bearings are more than 5 % wrong, shape (speeds,).

    Parameters
    ----------
    model : Model
        Model with its law and its films.
    speeds : array, shape (speeds,)
        [rad/s].
    displacements : array, shape (speeds, n), optional
        Displacements at the equilibria; they are found if left out.

    Returns
    -------
    array, shape (speeds,)
        NaN for laws without films; infinite where no error is so large, as at rest.
    """
    found = np.full(speeds.size, np.nan)
    for index, speed in enumerate(speeds.tolist()):
        there, operation = operating(model, speed), Operation(speed)
        place = equilibrium(there.system, operation).displacement if displacements is None else displacements[index]
        errors = film_errors(there, place, operation)
        if not errors:
            break
        found[index] = min(entry.frequency for entry in errors)
    return found


def film_course(model: Model, speeds: Iterable[float]) -> list[str]:
    """A line on the frequencies up to which films of a run are nowhere notably wrong, at some speeds [rad/s]."""
    shown = []
    for speed in speeds:
        if speed == 0.0:
            continue
        (frequency,) = notable_from(model, np.array([speed]))
        if not np.isnan(frequency):
            words = f"{frequency:.4g} Hz" if np.isfinite(frequency) else "1 MHz and more"
            shown.append(f"{words} at {RPM.text(abs(speed))}")
    if not shown:
        return []
    return [
        f"{FILM_WORDS[model.memory]}: dynamic stiffness along the load with an estimated error of up to "
        f"{100.0 * NOTABLE:g} % up to {', '.join(shown)}"
    ]
