"""Places where a dearer solver tells most about what a cheaper one gets wrong, over a job's own range.

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

from ehdmaps.arrays import FloatArray, IndexArray
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
    """Random points of a job, which stand for its range.

    Attributes
    ----------
    points : tuple of SamplePoint
        The points; none of them at the place of another one.
    places : array (n, 3)
        Their places.
    stiffness_shares : array (n,)
        k h/w with the film h of Moes' formula: by how much k changes, relatively, with the exponent of the film over
        the load.
    """

    points: tuple[SamplePoint, ...]
    places: FloatArray
    stiffness_shares: FloatArray

    @cached_property
    def ranges(self) -> FloatArray:
        """Ranges of the coordinates, shape (3,)."""
        return np.asarray(np.ptp(self.places, axis=0))

    @cached_property
    def scaled(self) -> FloatArray:
        """Places in units of the ranges."""
        return self.in_ranges(self.places)

    def in_ranges(self, places: FloatArray) -> FloatArray:
        """Places in units of the ranges.

        Parameters
        ----------
        places : array (m, 3)
            Places (s, ln(1 + L), T).
        """
        return np.asarray(places / np.where(self.ranges > 0.0, self.ranges, 1.0))

    def nearest(self, to: FloatArray) -> IndexArray:
        """Index of the nearest of some places for each candidate, shape (n,).

        Parameters
        ----------
        to : array (m, 3)
            The places, at least one.
        """
        return np.asarray(np.argmin(_distances(self.scaled, self.in_ranges(to)), axis=1))

    def shares(self, of: FloatArray) -> FloatArray:
        """Share of the candidates that each of some places is nearest to, shape (m,); one in all.

        Parameters
        ----------
        of : array (m, 3)
            The places, at least one.
        """
        return np.bincount(self.nearest(of), minlength=len(of)) / len(self.points)


def candidates(job: Job) -> Candidates:
    """Draw points of a job; those whose film Moes' formula cannot give are left out, as no solver is made for them.

    Parameters
    ----------
    job : Job
        The job; of one that is all standstill there are none.
    """
    if max(job.entrainment_speeds) <= 0.0:
        return Candidates((), np.empty((0, 3)), np.empty(0))
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
    kept, places, shares = [], [], []
    solver = FormulaSolver()
    for point in drawn:
        (film,) = solver.solve_line(point.contact, job.lubricant, (point.load,), point.speed, point.temperature)
        if not film.status.usable:
            continue
        compliance = point.contact.structural_compliance(point.load) + film.film_compliance
        places.append(
            places_of(point.contact, job.lubricant, np.array([point.load]), point.speed, point.temperature)[0]
        )
        shares.append(film.film_offset / point.load / compliance)
        kept.append(point)
    if not kept:
        return Candidates((), np.empty((0, 3)), np.empty(0))
    _, first = np.unique(np.round(np.array(places) / _SAME_PLACE), axis=0, return_index=True)
    first = np.sort(first)
    return Candidates(tuple(kept[i] for i in first), np.array(places)[first], np.array(shares)[first])


def spread_out(among: Candidates, count: int) -> list[int]:
    """Indices of candidates that fill the range: each in the middle of those that are nearest to it.

    Parameters
    ----------
    among : Candidates
        The candidates.
    count : int
        How many, at most.
    """
    scaled = among.scaled
    chosen = [int(np.argmin(np.sum((scaled - scaled.mean(axis=0)) ** 2, axis=1)))]
    while len(chosen) < min(count, len(scaled)):
        chosen.append(int(np.argmax(np.min(_distances(scaled, scaled[chosen]), axis=1))))
    for _ in range(_CENTRES):
        owner = np.argmin(_distances(scaled, scaled[chosen]), axis=1)
        centres = np.array([scaled[owner == i].mean(axis=0) for i in range(len(chosen))])
        moved = [int(i) for i in np.argmin(_distances(scaled, centres), axis=0)]
        if moved == chosen or len(set(moved)) < len(moved):
            break
        chosen = moved
    return chosen


def free(among: Candidates, taken: Sequence[int]) -> IndexArray:
    """Indices of the candidates that are not taken yet."""
    return np.setdiff1d(np.arange(len(among.points)), taken)


def _distances(one: FloatArray, other: FloatArray) -> FloatArray:
    """Squares of the distances, shape (n, m)."""
    return np.asarray(np.sum((one[:, None, :] - other[None, :, :]) ** 2, axis=2))
