"""One bearing at an operating point: where its inner ring comes to rest, and what its contacts feel there.

The outer ring is held, the inner one moves in the radial plane without tilting and turns at the given speed. Its
equilibrium is that of `mbs.model.equilibrium`, with the ring as the only body: the potential of the contacts is convex,
so that it is found from any load and clearance. The rollers' centrifugal load is left out.

Of points at many loads and speeds, of any kind of bearing, one that fails is a hole with its reason, and the others
stand (`points_over`).
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Iterable, Sequence
from typing import Any, TypeVar

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import AnalysisError, InputError
from ehdmaps.physics.heat import ISOTHERMAL
from ehdmaps.units import written
from mbs.bearings.bearing import Bearing
from mbs.bearings.bearing_element import BearingElement
from mbs.bearings.bearing_force import BearingForce
from mbs.bearings.contact_report import (
    BearingPoint,
    bearing_contacts,
    extrapolated,
    fading,
    guessed,
    heated,
    outside_map,
    rolling_loss,
    spike_tip,
)
from mbs.bearings.films import FilmSource, MapFilms
from mbs.bearings.laws import Law
from mbs.model.body import Inertia, rigid_body
from mbs.model.elements import Load, Operation
from mbs.model.equilibrium import Equilibrium, equilibrium
from mbs.model.findings import Cause, Finding, RingPoint
from mbs.model.system import System

RING = "inner ring"
"""Name of the body that a bearing alone carries."""

_FREE = 1e-9
"""Stiffness across the load over that along it, below which there is none."""


P = TypeVar("P", bound=RingPoint)

_NOTABLE = 0.01, 0.05
"""Errors of k and c along the load from which on they are told."""

_KEPT = ("bearing", "force", "angle", "position", "temperature", "outer_speed")
"""Fields of points that are known without an answer."""


def points_over(loads: Sequence[Any], speeds: Sequence[float], solve: Callable[[Any, float], P]) -> list[list[P]]:
    """Solve a point at every load and every speed.

    Parameters
    ----------
    loads, speeds : sequence
        Loads on the inner ring, as `solve` takes them, and its speeds [rad/s].
    solve : callable
        Point at a load and a speed.

    Returns
    -------
    list of list
        The points, by load, then by speed; NaN, with `failed` and the reason in `problems`, where `solve` failed.

    Raises
    ------
    InputError, AnalysisError
        What the first point failed with, where all did.
    """
    found: dict[tuple[int, int], P] = {}
    errors: dict[tuple[int, int], AnalysisError | InputError] = {}
    for i, load in enumerate(loads):
        for j, speed in enumerate(speeds):
            try:
                found[i, j] = solve(load, speed)
            except (AnalysisError, InputError) as error:
                errors[i, j] = error
    if errors and not found:
        raise next(iter(errors.values()))
    for (i, j), reason in errors.items():
        # any point tells how many rolling bodies there are; loads and speeds are those of the row and the column
        row = [point for (k, _), point in found.items() if k == i] or list(found.values())
        found[i, j] = _hole(row[0], loads[i], speeds[j], str(reason))
    return [[found[i, j] for j in range(len(speeds))] for i in range(len(loads))]


def without_holes(path: str, points: list[P]) -> list[P]:
    """Points for a file that can have no holes.

    Parameters
    ----------
    path : str
        The file, for messages.
    points : list of points
        Points over the speed.

    Raises
    ------
    AnalysisError
        If one has no answer.
    """
    holes = [point.problems[0] for point in points if point.failed]
    if holes:
        raise AnalysisError(
            f"{path}: not written: {len(holes)} of {len(points)} points have no answer; leave them out: {holes[0]}"
        )
    return points


def _hole(point: P, load: Any, speed: float, reason: str) -> P:
    """A point without an answer in the shape of one that has one."""
    size = np.array(load, dtype=np.float64)
    blank: Any = _blank(point)
    failed = (Finding(Cause.FAILED, reason),)
    hole: P = dataclasses.replace(blank, load=size, inner_speed=speed, findings=failed, failed=True)
    return hole


def _blank(value: Any) -> Any:
    """The same with NaN in the place of all numbers that hang on an answer."""
    if isinstance(value, np.ndarray) and value.dtype == np.float64:
        return np.full_like(value, math.nan)
    if isinstance(value, float):
        return math.nan
    if isinstance(value, tuple) and hasattr(value, "_fields"):
        return type(value)(*(_blank(each) for each in value))
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        names = [field.name for field in dataclasses.fields(value) if field.init and field.name not in _KEPT]
        return dataclasses.replace(value, **{name: _blank(getattr(value, name)) for name in names})
    return value


def bearing_points(
    bearing: Bearing,
    law: Law,
    films: FilmSource,
    loads: Iterable[Sequence[float]],
    speeds: Sequence[float],
    temperature: float,
) -> list[list[BearingPoint]]:
    """Points of a bearing at every load and every speed.

    Parameters
    ----------
    bearing : Bearing
        Geometry, clearance, profile, slices.
    law : Law
        Law of a roller between both raceways, see `mbs.bearings.laws`.
    films : FilmSource
        Pressures and films, see `mbs.bearings.films`.
    loads : iterable of (float, float)
        Loads on the inner ring, y and z [N].
    speeds : sequence of float
        Speeds of the inner ring [rad/s].
    temperature : float
        Temperature of the raceways [K].

    Returns
    -------
    list of list of BearingPoint
        The points, by load, then by speed; NaN with the reason where one of several has no equilibrium.

    Raises
    ------
    InputError
        For a load of zero, and for a law that does not belong to the bearing.
    AnalysisError
        Where no equilibrium is found at any of them.
    """
    force = BearingForce(bearing, law)
    given = [(0.0, *load) for load in loads]
    return points_over(given, speeds, lambda load, speed: bearing_point(force, films, load[1:], speed, temperature))


def ring_at_rest(element: BearingElement, load: Sequence[float], operation: Operation) -> Equilibrium:
    """Find where the inner ring of a bearing comes to rest in the radial plane, without tilting.

    Parameters
    ----------
    element : BearingElement
        The bearing, between the body `RING` and ground.
    load : (float, float)
        Load on the inner ring, y and z [N].
    operation : Operation
        Speed of the inner ring.

    Raises
    ------
    InputError
        For a load of zero.
    AnalysisError
        Where no equilibrium is found.
    """
    given = np.array(load, dtype=np.float64)
    if given.shape != (2,) or not np.all(np.isfinite(given)) or not np.any(given):
        raise InputError(f"bearing point, load: got {load!r} N; allowed: two finite numbers, y and z, not both zero")
    ring = rigid_body(RING, [Inertia(1.0, 1.0, 1.0)], ["y", "z"])
    system = System([ring], loads=[Load("load", RING, np.array([0.0, *given, 0.0, 0.0, 0.0]))], elements=[element])
    try:
        return equilibrium(system, operation)
    except AnalysisError as error:
        if not isinstance(error.__cause__, InputError):
            raise
        raise AnalysisError(  # the ring went further than small displacements allow
            f"no equilibrium of {element.bearing.geometry.name} under {written(np.hypot(*given))} N: "
            f"{error.__cause__}; the "
            "load is beyond what the bearing can carry"
        ) from error


def bearing_point(
    force: BearingForce, films: FilmSource, load: Sequence[float], speed: float, temperature: float
) -> BearingPoint:
    """One point; arguments and errors as of `bearing_points`."""
    element = BearingElement("bearing", RING, "ground", force.bearing, force, temperature)
    operation = Operation(speed)
    balance = ring_at_rest(element, load, operation)
    given = np.array(load, dtype=np.float64)
    pose = np.array([0.0, *balance.displacement, 0.0, 0.0, 0.0])
    rollers, u = element.loads(pose, operation), element.entrainment_speed(operation)
    contacts = bearing_contacts(films, rollers, u, temperature)
    gauge = element.gauge(pose, operation)
    assert gauge is not None  # it has a `BearingForce`
    problems = outside_map(force.law, float(rollers.load_per_length.max()), u, temperature)
    inner, heaviest = (
        force.bearing.geometry.contacts(force.bearing.material, "iso16281")[0],
        rollers.load_per_length.max(),
    )
    isothermal = np.isfinite(contacts.central_film).any() and not _knows_heat(films)
    notes = [
        spike_tip(contacts),
        extrapolated(contacts, films.lubricant),
        fading(force.law, u),
        guessed(force.law, rollers.load_per_length, u, temperature),
        heated(inner, films.lubricant, heaviest, u, temperature) if isothermal else "",
        _loose(balance.element_stiffness[0][1:3, 1:3], given),
        _between_points(films, element, pose, operation, given),
    ]
    return BearingPoint(
        bearing=force.bearing,
        load=np.array([0.0, *given]),
        inner_speed=speed,
        entrainment_speed=u,
        temperature=temperature,
        pose=pose,
        stiffness=balance.element_stiffness[0],
        damping=balance.element_damping[0],
        balance=balance,
        elements=rollers,
        contacts=contacts,
        film_error=contacts.film_error,
        loss=rolling_loss(force.bearing, films, contacts, rollers, u, speed, temperature),
        findings=(
            *gauge.findings,
            *(Finding(Cause.REACH, words) for words in problems),
            *(Finding(Cause.FILM, words) for words in notes if words),
        ),
    )


def _knows_heat(films: FilmSource) -> bool:
    """Tell whether films are those of a map with heat."""
    return isinstance(films, MapFilms) and films.emap.physics != ISOTHERMAL


def _between_points(
    films: FilmSource, element: BearingElement, pose: FloatArray, operation: Operation, load: FloatArray
) -> str:
    """A sentence where laws of the points of a map alone are wrong by more than the bars of other laws."""
    if not isinstance(films, MapFilms) or films.emap.known_between or not films.emap.law_errors.has_spacing_errors:
        return ""
    wrong, whole = np.zeros(2), np.zeros(2)
    for side in element.sides(pose, operation):
        loads, k, c = (part.ravel() for part in side.state())
        if (bounds := side.law.bounds(loads)) is None:
            return ""
        along = np.array([k, c]) * ((side.feel @ side.pose)[..., 1:3].reshape(-1, 2) @ load / np.hypot(*load)) ** 2
        wrong += np.sum(along * [bounds.stiffness, bounds.damping], axis=1)
        whole += np.sum(along, axis=1)
    shares = wrong / np.maximum(whole, 1e-300)
    if np.all(shares < _NOTABLE):
        return ""
    if not np.all(np.isfinite(shares)):
        return "how wrong stiffness and damping are is not known: the map has holes there; `ehdmaps show` says where"
    of_k, of_c = (f"{100.0 * share:.2g} %" for share in shares)
    return (
        f"stiffness along the load may be wrong by {of_k}, damping by {of_c}: by the errors of the map, and by "
        "what its axes lose between its points; `ehdmaps show` says more"
    )


def _loose(stiffness: FloatArray, load: FloatArray) -> str:
    """A sentence where nothing holds the ring across the load."""
    across = np.array([-load[1], load[0]]) / np.hypot(*load)
    if across @ stiffness @ across > _FREE * float(np.trace(stiffness)):
        return ""
    return "one roller carries all: nothing holds the ring across the load, where its position is arbitrary"
