"""Places at which a dearer solver is asked for what a cheaper one gets wrong, over a job's own range.

A place is (s, ln(1 + L), T): zeta = ln(M/M_valley(L)) and Moes' L, by which the film of a contact goes at one
temperature, and the temperature [K]. zeta is stretched around the damping valley, zeta = 0.3 sinh(s): there films
change within some tenths of zeta, elsewhere over several of it, and so does what solvers differ by. Two contacts of a
bearing at equal groups have one place.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.jobs.job import Job
from ehdmaps.jobs.make.sampling import SamplePoint, draw, draw_in_valley
from ehdmaps.physics.closed_form import FormulaSolver
from ehdmaps.physics.contact import LineContact
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.moes import moes_groups, valley_load_number

VALLEY = 0.3
"""zeta beyond which it is no longer stretched."""

SEED = 20261
"""Of the points among which places are chosen."""

CANDIDATES, IN_VALLEY = 1000, 250
"""Points over the axes of the job, and as many more in its damping valley."""

_CENTRES = 20
"""Rounds in which the first places move to the middle of what is nearest to them."""

_SAME_PLACE = 1e-9


def places_of(
    contact: LineContact, lubricant: Lubricant, loads: FloatArray, speed: float, temperature: float
) -> FloatArray:
    """Places (s, ln(1 + L), T) of a line of loads, shape (n, 3).

    Parameters
    ----------
    contact, lubricant
        What is solved.
    loads : array (n,)
        [N/m].
    speed, temperature : float
        [m/s], > 0, and [K].
    """
    state = lubricant.at(temperature)
    alpha = state.pressure_viscosity.pressure_viscosity
    M, L = moes_groups(loads, speed, state.viscosity, alpha, contact.radius, contact.reduced_modulus)
    zeta = np.log(np.asarray(M) / valley_load_number(L))
    return np.column_stack(
        [np.arcsinh(zeta / VALLEY), np.full(zeta.shape, np.log1p(L)), np.full(zeta.shape, temperature)]
    )


def per_zeta(places: FloatArray) -> FloatArray:
    """Derivative of s by zeta, shape (n,).

    Parameters
    ----------
    places : array (n, 3)
        Places (s, ln(1 + L), T).
    """
    return np.asarray(1.0 / (VALLEY * np.cosh(places[:, 0])))


@dataclass(frozen=True, eq=False)
class Candidates:
    """Points of a job, which stand for its range.

    Attributes
    ----------
    points : tuple of SamplePoint
        The points; none of them at the place of another one.
    places : array (n, 3)
        Their places.
    """

    points: tuple[SamplePoint, ...]
    places: FloatArray

    @cached_property
    def ranges(self) -> FloatArray:
        """Ranges of the coordinates, shape (3,)."""
        return np.asarray(np.ptp(self.places, axis=0))

    def apart(self, places: FloatArray) -> FloatArray:
        """Squares of the distances of the candidates from some places, in units of the ranges, shape (n, m).

        Parameters
        ----------
        places : array (m, 3)
            Places (s, ln(1 + L), T).
        """
        apart = (self.places[:, None] - places[None]) / np.where(self.ranges > 0.0, self.ranges, 1.0)
        return np.asarray(np.sum(apart**2, axis=2))

    def shares(self, places: FloatArray) -> FloatArray:
        """Share of the candidates that each of some places is nearest to, shape (m,); one in all.

        Parameters
        ----------
        places : array (m, 3)
            Places (s, ln(1 + L), T), at least one.
        """
        return np.bincount(np.argmin(self.apart(places), axis=1), minlength=len(places)) / len(self.points)


def candidates(job: Job) -> Candidates:
    """Draw points of a job; those whose film Moes' formula cannot give are left out, as no solver is made for them.

    Parameters
    ----------
    job : Job
        The job; of one that is all standstill there are none.
    """
    if max(job.entrainment_speeds) <= 0.0:
        return Candidates((), np.empty((0, 3)))
    rng = np.random.default_rng(SEED)
    drawn = [draw(job, rng) for _ in range(CANDIDATES)]
    drawn += [point for _ in range(IN_VALLEY) if (point := draw_in_valley(job, rng)) is not None]
    return usable(job, drawn)


def usable(job: Job, drawn: Sequence[SamplePoint]) -> Candidates:
    """Points of a job as candidates; those whose film Moes' formula cannot give are left out.

    Parameters
    ----------
    job : Job
        The job.
    drawn : sequence of SamplePoint
        Points of its range, with speeds above zero.
    """
    oil = job.lubricant
    kept: dict[tuple[float, ...], tuple[SamplePoint, FloatArray]] = {}
    for contact, load, speed, temperature in drawn:
        (film,) = FormulaSolver().solve_line(contact, oil, (load,), speed, temperature)
        if film.status.usable:
            place = places_of(contact, oil, np.array([load]), speed, temperature)[0]
            kept.setdefault(
                tuple(np.round(place / _SAME_PLACE)), (SamplePoint(contact, load, speed, temperature), place)
            )
    points, places = zip(*kept.values(), strict=True) if kept else ((), np.empty((0, 3)))
    return Candidates(points, np.array(places))


def spread_out(among: Candidates, count: int) -> list[int]:
    """Indices of candidates that fill the range: each in the middle of those that are nearest to it.

    Parameters
    ----------
    among : Candidates
        The candidates.
    count : int
        How many, at most.
    """
    if not among.points:
        return []
    places = among.places
    chosen = [int(np.argmin(among.apart(places.mean(axis=0)[None])))]
    while len(chosen) < min(count, len(places)):
        chosen.append(int(np.argmax(np.min(among.apart(places[chosen]), axis=1))))
    for _ in range(_CENTRES):
        owner = np.argmin(among.apart(places[chosen]), axis=1)
        centres = np.array([places[owner == i].mean(axis=0) for i in range(len(chosen))])
        moved = [int(i) for i in np.argmin(among.apart(centres), axis=0)]
        if moved == chosen or len(set(moved)) < len(moved):
            break
        chosen = moved
    return chosen
