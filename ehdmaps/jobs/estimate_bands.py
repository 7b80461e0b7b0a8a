"""Effect of what is estimated, or open by [tolerances]: geometry, oil and temperature, to their errors one by one.

The bearing keeps its load and speed, so that fewer or shorter rollers carry more each: stiffness and damping are those
of all rollers in the middle of the map, Z L k(F/(Z L)). The parts of the geometry are independent of one another, and
their effects are added as squares.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

from ehdmaps.errors import InputError
from ehdmaps.jobs import solvers
from ehdmaps.jobs.job import Job
from ehdmaps.physics.bearing import BearingGeometry
from ehdmaps.physics.contact import OperatingPoint
from ehdmaps.physics.designations.estimates import estimated_parts
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.solution import ContactSolver, contact_solution
from ehdmaps.units import LOAD, SPEED, TEMPERATURE

Answer = tuple[float, float, float]
"""Stiffness, damping and thinner central film of a bearing, in proportion."""


@dataclass(frozen=True)
class Band:
    """Relative half-widths of stiffness, damping and central film.

    Attributes
    ----------
    stiffness, damping, film : float
        Half-widths; nan where a point has no solution.
    """

    stiffness: float
    damping: float
    film: float

    @property
    def words(self) -> str:
        """The band for people."""
        return f"k {self.stiffness:.0%}, c {self.damping:.0%}, film {self.film:.0%}"


def geometry_band(job: Job, point: OperatingPoint, solver: ContactSolver) -> Band | None:
    """Band of an estimated inner geometry; None where it is known.

    Parameters
    ----------
    job : Job
        A job with a bearing.
    point : OperatingPoint
        Point of the estimated bearing.
    solver : ContactSolver
        What gives the films.
    """
    bearing = job.bearing
    if bearing is None or bearing.estimated is None:
        return None
    stated = job.tolerances.get("geometry")
    share = 1.0 if stated is None else stated.size
    if not share:
        return None
    parts = tuple(estimated_parts(bearing, share))
    if not parts:
        raise InputError(f"bearing {bearing.name!r}: states no errors; allowed: a bearing that `estimate` made")
    oil = job.lubricant
    base = _answer(job, bearing, oil, point, solver)

    def changed(end: dict[str, Any]) -> Answer:
        return _answer(job, replace(bearing, **end), oil, point, solver)

    return _added([_largest(base, [partial(changed, end) for end in part.ends]) for part in parts])


def oil_bands(job: Job, point: OperatingPoint, solver: ContactSolver) -> Iterator[tuple[str, Band]]:
    """Bands of the oil and its temperature, to the errors that are stated or estimated, with what each is of.

    Parameters
    ----------
    job : Job
        A job.
    point : OperatingPoint
        The point.
    solver : ContactSolver
        What gives the films.
    """
    oil, stated = job.lubricant, job.tolerances

    def answer(oil: Lubricant, kelvin: float = 0.0) -> Answer:
        return _answer(job, job.bearing, oil, replace(point, temperature=point.temperature + kelvin), solver)

    def both(kelvin: float) -> Band:
        return _largest(answer(oil), [partial(answer, oil, by) for by in (-kelvin, kelvin)])

    if (one := stated.get("temperature")) is not None and not one.exact:
        yield f"temperature, {one.text}", both(one.size)
    if (one := stated.get("viscosity")) is not None and not one.exact:
        made = [oil.thickened(1.0 + sign * one.size) for sign in (-1.0, 1.0)]
        if all(made):
            ends = [partial(answer, end) for end in made if end is not None]
            yield f"viscosity, {one.text}", _largest(answer(oil), ends)
        # an equal viscosity by another temperature
        cold, hot = (oil.at(point.temperature + by).viscosity for by in (-1.0, 1.0))
        if not all(made) and cold > hot:
            yield f"viscosity, {one.text}", both(one.size / (0.5 * math.log(cold / hot)))
    one = stated.get("pressure_viscosity")
    error = oil.coefficient_error(point.temperature) if one is None else one.size
    changed = [oil.with_alpha(1.0 + sign * error, point.temperature) for sign in (-1.0, 1.0)]
    if error and all(changed):
        ends = [partial(answer, end) for end in changed if end is not None]
        words = "estimated pressure-viscosity" if one is None else f"pressure-viscosity, {one.text}"
        yield words, _largest(answer(oil), ends)


def band_lines(job: Job, point: OperatingPoint | None = None) -> Iterator[str]:
    """Lines on the effect of what is estimated or stated to be open; none for solvers without films, or slow ones.

    Parameters
    ----------
    job : Job
        The job.
    point : OperatingPoint, optional
        Operating point; the middle of the map if left out.
    """
    solver = solvers.of_map(job)
    if job.solver == "hertz" or solver.slow:
        return
    middle = "" if point is not None else "the middle of the map; "
    if point is None:
        axes = (job.loads, job.entrainment_speeds, job.temperatures)
        point = OperatingPoint(*(axis[len(axis) // 2] for axis in axes))
    held = "load and speed of the bearing held" if job.bearing is not None else "load and speed held"
    place = (
        f"({LOAD.text(point.load)}, {SPEED.text(point.entrainment_speed)}, {TEMPERATURE.text(point.temperature)}, "
        f"{middle}{held})"
    )
    if job.bearing is None and not job.tolerances:
        return
    bands = []
    own = geometry_band(job, point, solver)
    if own is not None:
        bands.append(("estimated inner geometry", own))
    bands += oil_bands(job, point, solver)
    for what, band in bands:
        yield f"  the {what} may change, either way: {band.words} {place}"
    if job.tolerances and len(bands) > 1:
        yield f"  all of them together, as squares: {_added([band for _, band in bands]).words}"


def _answer(
    job: Job, bearing: BearingGeometry | None, oil: Lubricant, point: OperatingPoint, solver: ContactSolver
) -> Answer:
    """Stiffness, damping and film of a bearing whose load and speed are those of the job's own at its point.

    Without a bearing they are those of the contact of the job.
    """
    mine, at, contacts = 1.0, point, list(job.contacts)
    if bearing is not None and job.bearing is not None:
        mine = bearing.rolling_elements * bearing.roller_length
        share = job.bearing.rolling_elements * job.bearing.roller_length / mine
        speed = bearing.entrainment_speed(job.bearing.inner_speed(point.entrainment_speed))
        at = OperatingPoint(point.load * share, speed, point.temperature)
        law = job.contacts[0].structural_law
        # the law of finite elements is known for no estimated bearing but by the approaches of the job
        contacts = [
            replace(new, structural_law=law, fe_approach=old.fe_approach)
            for new, old in zip(bearing.contacts(job.contacts[0].material, "half_space"), job.contacts, strict=True)
        ]
    found = []
    for contact in contacts:
        (film,) = solver.solve_line(contact, oil, (at.load,), at.entrainment_speed, at.temperature)
        found.append(contact_solution(film, contact, at))
    compliance = sum(1.0 / one.stiffness for one in found)
    loss = sum(one.damping / one.stiffness**2 for one in found)
    return mine / compliance, mine * loss / compliance**2, min(one.central_film for one in found)


def _largest(base: Answer, ends: Iterable[Callable[[], Answer]]) -> Band:
    """The larger change at either end; at one that no bearing can have, that of the other."""
    changes = []
    for end in ends:
        try:
            changes.append([abs(new / old - 1.0) for new, old in zip(end(), base, strict=True)])
        except InputError:
            continue
    return Band(*(max(values, default=math.nan) for values in zip(*changes, strict=True)))


def _added(bands: list[Band]) -> Band:
    """Independent bands together."""
    return Band(*(math.hypot(*(getattr(band, key) for band in bands)) for key in ("stiffness", "damping", "film")))
