"""Effect of what is estimated: inner geometry and pressure-viscosity, taken to their stated errors one by one.

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
from ehdmaps.units import point_text

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
    parts = tuple(estimated_parts(bearing))
    if not parts:
        raise InputError(f"bearing {bearing.name!r}: states no errors; allowed: a bearing that `estimate` made")
    oil = job.lubricant
    base = _answer(job, bearing, oil, point, solver)

    def changed(end: dict[str, Any]) -> Answer:
        return _answer(job, replace(bearing, **end), oil, point, solver)

    return _added([_largest(base, [partial(changed, end) for end in part.ends]) for part in parts])


def pressure_viscosity_band(job: Job, point: OperatingPoint, solver: ContactSolver) -> Band | None:
    """Band of a pressure-viscosity by a correlation, to its error there; None where it is stated.

    Parameters
    ----------
    job : Job
        A job with a bearing.
    point : OperatingPoint
        The point.
    solver : ContactSolver
        What gives the films.
    """
    bearing, error = job.bearing, job.lubricant.coefficient_error(point.temperature)
    if bearing is None or error == 0.0:
        return None

    def changed(sign: float) -> Answer:
        oil = job.lubricant.with_alpha(1.0 + sign * error, point.temperature) or job.lubricant
        return _answer(job, bearing, oil, point, solver)

    return _added([_largest(changed(0.0), [partial(changed, sign) for sign in (-1.0, 1.0)])])


def band_lines(job: Job) -> Iterator[str]:
    """Lines on the effect of what is estimated, in the middle of the map; none for solvers without films, or slow ones.

    Parameters
    ----------
    job : Job
        The job.
    """
    solver = solvers.of_map(job)
    if job.solver == "hertz" or solver.slow:
        return
    point = OperatingPoint(*(axis[len(axis) // 2] for axis in (job.loads, job.entrainment_speeds, job.temperatures)))
    place = (
        f"({point_text(point.load, point.entrainment_speed, point.temperature)}, the "
        "middle of the map; load and speed of the bearing held)"
    )
    for what, band in (
        ("inner geometry", geometry_band(job, point, solver)),
        ("pressure-viscosity", pressure_viscosity_band(job, point, solver)),
    ):
        if band is not None:
            yield f"  the estimated {what} may change, either way: {band.words} {place}"


def _answer(job: Job, bearing: BearingGeometry, oil: Lubricant, point: OperatingPoint, solver: ContactSolver) -> Answer:
    """Stiffness, damping and film of a bearing whose load and speed are those of the job's own at its point."""
    assert job.bearing is not None
    mine = bearing.rollers * bearing.roller_length
    share = job.bearing.rollers * job.bearing.roller_length / mine
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
