"""Estimated errors of the films of a machine, over frequency: those of slow motion, and those with memory."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.units import RPM
from mbs.analyses.operating import operating
from mbs.bearings.bearing_element import RingElement, ring_following
from mbs.linearised.validity import ContactsInBalance, FilmError, LoadedContacts
from mbs.model.elements import Element, Forces, Operation
from mbs.model.equilibrium import equilibrium
from mbs.model.relaxation import FILM_WORDS, NOTABLE, Films, Relaxation
from mbs.scene.assembly import Model

if TYPE_CHECKING:
    from mbs.bearings.balls.ball_element import MachineBalls
    from mbs.bearings.tapered.tapered_element import TaperedElement


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
    system = model.system
    speeds = {bearing.name: bearing.entrainment_speed(operation) for bearing in model.bearings}
    for index in system.select(RingElement):
        connected = system.elements[index]
        element, ports = connected.element, connected.transform @ displacement
        error = film_error(element, ports, operation, films or model.memory, speeds[element.name] == 0.0)
        found += [] if error is None else [error]
    if model.scene.tapered:
        from mbs.bearings.tapered.tapered_element import TaperedElement  # with kernels that others do not need

        for index in system.select(TaperedElement):
            connected = system.elements[index]
            element, ports = connected.element, connected.transform @ displacement
            assert isinstance(element, TaperedElement)
            error = line_error(element, ports, operation, films or element.memory)
            found += [] if error is None else [error]
    if model.scene.balls:
        from mbs.bearings.balls.ball_element import MachineBalls

        for index in system.select(MachineBalls):
            connected = system.elements[index]
            element, ports = connected.element, connected.transform @ displacement
            assert isinstance(element, MachineBalls)
            error = ball_error(element, ports, operation, films or element.memory)
            found += [] if error is None else [error]
    return found


def ball_error(element: MachineBalls, ports: FloatArray, operation: Operation, films: Films) -> FilmError | None:
    """Estimated error of the films of balls along their load; None without films, and without a load.

    Parameters
    ----------
    element : MachineBalls
        The bearing.
    ports : array, shape (6,)
        Displacement of its inner ring against the outer one at the equilibrium.
    operation : Operation
        Speed and angle.
    films : {"slow", "memory"}
        Films whose error is estimated: by what their springs and dampers leave out of the film table.
    """
    if element.films is None:
        return None
    forces = element.evaluate(ports, np.zeros(6), operation)
    motion = _along_load(forces)
    if motion is None:
        return None
    condensed = element.law_errors(ports, operation)
    contacts = () if condensed is None else (ContactsInBalance(condensed, motion),)
    along = element.name, films, forces, motion
    return _error(along, condensed is None, element.film_relaxation(ports, operation), np.zeros(0), contacts)


def line_error(element: TaperedElement, ports: FloatArray, operation: Operation, films: Films) -> FilmError | None:
    """Estimated error of the films of tapered rollers along their load; None without films, and without a load.

    Parameters
    ----------
    element : TaperedElement
        The bearing.
    ports : array, shape (6,)
        Displacement of its inner ring against the outer one at the equilibrium.
    operation : Operation
        Speed and angle.
    films : {"slow", "memory"}
        Films whose error is estimated; with memory by the slices one by one as they move in slow motion.
    """
    if element.films is None:
        return None
    forces = element.evaluate(ports, np.zeros(6), operation)
    motion = _along_load(forces)
    if motion is None:
        return None
    slices = element.film_slices(ports, operation)
    relaxation, natural = slices or (element.film_relaxation(ports, operation), np.zeros(0))
    if films == "slow":
        relaxation = element.film_relaxation(ports, operation)
    return _error((element.name, films, forces, motion), slices is None, relaxation, natural)


def _along_load(forces: Forces) -> FloatArray | None:
    """Unit motion of the inner ring along its load, shape (6,); None without a load."""
    load = float(np.linalg.norm(forces.force[:3]))
    return np.array([*(forces.force[:3] / load), 0.0, 0.0, 0.0]) if load > 0.0 else None


def _error(
    along: tuple[str, Films, Forces, FloatArray],
    at_rest: bool,
    relaxation: Relaxation,
    natural: FloatArray,
    contacts: Sequence[LoadedContacts | ContactsInBalance] = (),
) -> FilmError:
    """Error of a bearing by its name, its films, its forces, and a motion of its ports."""
    name, films, forces, motion = along
    return FilmError(
        bearing=name,
        films=films,
        at_rest=at_rest,
        stiffness=float(motion @ forces.stiffness @ motion),
        damping=float(motion @ forces.damping @ motion),
        springs=(relaxation.rows @ motion) ** 2,
        times=relaxation.times,
        natural=natural,
        contacts=tuple(contacts),
    )


def film_error(
    element: Element, ports: FloatArray, operation: Operation, films: Films, at_rest: bool
) -> FilmError | None:
    """Estimated error of the films of a bearing; None without films, and without a load.

    Parameters
    ----------
    element : Element
        The bearing, a `RingElement`.
    ports : array, shape (m,)
        Displacements of its ports at the equilibrium.
    operation : Operation
        Speed and angle.
    films : {"slow", "memory"}
        Films whose error is estimated.
    at_rest : bool
        Whether its surfaces stand still, so that there is no film.
    """
    assert isinstance(element, RingElement)
    relaxation = element.film_relaxation(ports, operation)
    if relaxation is None:
        return None
    forces = element.evaluate(ports, np.zeros_like(ports), operation)
    load = float(np.linalg.norm(forces.force[1:3]))
    if load == 0.0:
        return None
    along = np.array([0.0, *(forces.force[1:3] / load), 0.0, 0.0, 0.0])
    motion = ring_following(forces.stiffness) @ along
    contacts = _contacts(element, ports, operation, relaxation, motion)
    natural = element.natural_times(ports, operation)
    return _error((element.name, films, forces, motion), at_rest, relaxation, natural, contacts)


def _contacts(
    element: RingElement, ports: FloatArray, operation: Operation, relaxation: Relaxation, motion: FloatArray
) -> tuple[LoadedContacts, ...]:
    """The loaded slices of a bearing along a motion of its ports; none where no response of the films is known."""
    found: list[LoadedContacts] = []
    begin = 0
    for group in element.contact_groups(ports, operation):
        # The slices of groups are those of the relaxation, one after the other.
        part = slice(begin, begin + group.approach.size)
        begin = part.stop
        load, stiffness, _, _ = group.state()
        on = load > 0.0
        loaded = dataclasses.replace(group, rows=group.rows[on], approach=group.approach[on])
        response = loaded.film_response()
        if response is None:
            return ()
        springs = (relaxation.rows[part][on] @ motion) ** 2
        found.append(
            LoadedContacts(stiffness[on] * (loaded.rows @ motion) ** 2, springs, relaxation.times[part][on], response)
        )
    return tuple(found)


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
