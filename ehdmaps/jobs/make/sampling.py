"""Random operating points of a job, over its axes and inside the damping valley, and how wrong films may be there."""

from __future__ import annotations

import itertools
from typing import NamedTuple

import numpy as np

from ehdmaps.errors import InputError
from ehdmaps.jobs.job import Job
from ehdmaps.maps.rough_layer import TEMPERATURE_REACH, WHOLE_TO
from ehdmaps.physics.contact import LineContact
from ehdmaps.physics.moes import moes_groups, valley_load_number

COMPLIANCE_BARS, DAMPING_BARS = (0.01, 1e-4), (0.05, 1e-3)
"""An error is within its bar where it is below a share of the film compliance or of 1/k; of c or of k b/u."""

VALLEY_WIDTH = (-0.6, 0.8)
"""Range of ln(M/M_valley) from which points inside the valley are drawn."""


VALLEY_SHARE = 0.2
"""Share of the points of a sample that are drawn inside the damping valley."""

MOST_TRIES = 10
"""Draws per point in the valley: a map may hold a part of it, or none."""


class SamplePoint(NamedTuple):
    """A contact with its load [N/m], entrainment speed [m/s] and temperature [K]."""

    contact: LineContact
    load: float
    speed: float
    temperature: float


def drawable(job: Job) -> bool:
    """Tell whether there is something between the points of a job's axes, and a speed above zero.

    Parameters
    ----------
    job : Job
        The job.
    """
    speeds = [u for u in job.entrainment_speeds if u > 0.0]
    return bool(speeds) and len(speeds) * len(job.loads) * len(job.temperatures) >= 2


def draw_apart(job: Job, rng: np.random.Generator, count: int) -> tuple[list[SamplePoint], list[SamplePoint]]:
    """Draw points over the whole map, and points inside its valley apart; fewer of these where it has hardly one.

    Parameters
    ----------
    job : Job
        Job over whose axes is drawn; see `drawable`.
    rng : numpy.random.Generator
        Source of chance.
    count : int
        How many in all; the share `VALLEY_SHARE` of them in the valley.
    """
    valley = round(VALLEY_SHARE * count)
    over = [draw(job, rng) for _ in range(count - valley)]
    return over, draw_valley_points(job, valley, rng)


def draw(job: Job, rng: np.random.Generator) -> SamplePoint:
    """Draw a point: load and speed log-uniform, temperature uniform, contact at random.

    Parameters
    ----------
    job : Job
        Job over whose axes is drawn; it has a speed above zero.
    rng : numpy.random.Generator
        Source of chance.
    """
    contact = job.contacts[rng.integers(len(job.contacts))]
    speeds = [u for u in job.entrainment_speeds if u > 0.0]
    speed = log_uniform(rng, min(speeds), max(speeds))
    temperature = float(rng.uniform(min(job.temperatures), max(job.temperatures)))
    return SamplePoint(contact, log_uniform(rng, min(job.loads), max(job.loads)), speed, temperature)


def draw_beyond(job: Job, rng: np.random.Generator, count: int) -> tuple[list[SamplePoint], list[SamplePoint]]:
    """Draw points below the lowest speed of a map, and points outside its temperatures.

    Speeds go down to that at which laws begin to fade the film, temperatures as far as laws go at most, where the oil
    has a state.

    Parameters
    ----------
    job : Job
        Job over whose axes is drawn; it has a speed above zero.
    rng : numpy.random.Generator
        Source of chance.
    count : int
        How many of each.
    """
    slow, outside = [], []
    lowest = min(u for u in job.entrainment_speeds if u > 0.0)
    for n in range(count):
        slow.append(draw(job, rng)._replace(speed=lowest * WHOLE_TO ** -rng.uniform()))
        point, away = draw(job, rng), TEMPERATURE_REACH * rng.uniform()
        T = min(job.temperatures) - away if n % 2 else max(job.temperatures) + away
        try:
            job.lubricant.at(T)
        except InputError:
            continue
        outside.append(point._replace(temperature=T))
    return slow, outside


def draw_in_valley(job: Job, rng: np.random.Generator) -> SamplePoint | None:
    """Draw a point with a load in the damping valley; None where the map's loads do not reach it.

    Arguments as of `draw`.
    """
    return _in_valley(job, draw(job, rng), rng.uniform(*VALLEY_WIDTH))


def _in_valley(job: Job, drawn: SamplePoint, place: float) -> SamplePoint | None:
    """A point with its load at a place of the damping valley, ln(M/M_valley); None where the map's loads end before."""
    state, contact = job.lubricant.at(drawn.temperature), drawn.contact
    alpha = state.pressure_viscosity.pressure_viscosity
    unit, L = moes_groups(1.0, drawn.speed, state.viscosity, alpha, contact.radius, contact.reduced_modulus)
    load = float(valley_load_number(L)) / float(unit) * float(np.exp(place))
    return drawn._replace(load=load) if min(job.loads) < load < max(job.loads) else None


def draw_valley_points(job: Job, count: int, rng: np.random.Generator) -> list[SamplePoint]:
    """Draw points with loads in the damping valley: so many, or fewer where the map's loads hardly reach it.

    All tries are drawn, so that what is drawn next is the same for any job; those beyond the count stay unread.

    Parameters
    ----------
    job : Job
        Job over whose axes is drawn; it has a speed above zero.
    count : int
        How many.
    rng : numpy.random.Generator
        Source of chance.
    """
    tries = [(draw(job, rng), rng.uniform(*VALLEY_WIDTH)) for _ in range(MOST_TRIES * count)]
    points = (point for tried in tries if (point := _in_valley(job, *tried)) is not None)
    return list(itertools.islice(points, count))


def draw_sample(job: Job, count: int, rng: np.random.Generator) -> tuple[SamplePoint, ...]:
    """Draw points, a share of them inside the damping valley, in random order: its first ones are a sample too.

    Parameters
    ----------
    job : Job
        Job over whose axes is drawn; it has a speed above zero.
    count : int
        How many.
    rng : numpy.random.Generator
        Source of chance.
    """
    valley = draw_valley_points(job, round(VALLEY_SHARE * count), rng)
    sample = valley + [draw(job, rng) for _ in range(count - len(valley))]
    return tuple(sample[index] for index in rng.permutation(count))


def log_uniform(rng: np.random.Generator, low: float, high: float) -> float:
    """Draw a number whose logarithm is uniform.

    Parameters
    ----------
    rng : numpy.random.Generator
        Source of chance.
    low, high : float
        Ends, > 0.
    """
    return float(np.exp(rng.uniform(np.log(low), np.log(high))))
