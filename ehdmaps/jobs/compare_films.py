"""Films of two maps at random points of the range that both have: what their contact laws are made from."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import MapError
from ehdmaps.jobs.report import AXES, span
from ehdmaps.jobs.sampling import log_uniform
from ehdmaps.maps.emap import EHDMap
from ehdmaps.physics.contact import structured

COMPARED_FILMS = (
    "stiffness",
    "damping",
    "approach",
    "film_offset",
    "film_compliance",
    "loss_compliance",
    "rolling_force",
)
"""Variables that are known between the points of a map, `rolling_force` where the map holds it."""

POINTS = 300
"""Random points."""


@dataclass(frozen=True, eq=False)
class FilmSample:
    """Two maps at random points.

    Attributes
    ----------
    seed : int
        Seed of the points.
    ranges : mapping of str to (float, float)
        Range by axis from which they were drawn: load [N/m] and entrainment speed [m/s], log-uniform, and temperature
        [K], uniform.
    places : tuple of mapping
        Contact, load, entrainment speed and temperature of each point.
    first, second : mapping of str to array (n,)
        Variables of both maps there, SI, by the structural law of each.
    """

    seed: int
    ranges: Mapping[str, tuple[float, float]]
    places: tuple[Mapping[str, str | float], ...]
    first: Mapping[str, FloatArray]
    second: Mapping[str, FloatArray]


def sampled_films(first: EHDMap, second: EHDMap, names: tuple[str, str], seed: int, count: int = POINTS) -> FilmSample:
    """Read the films of two maps at random points of the range that both have.

    Parameters
    ----------
    first, second : EHDMap
        The maps; they share a contact.
    names : tuple of str
        What messages call them.
    seed, count : int
        Seed and number of the points.

    Raises
    ------
    MapError
        If an axis has no range in common, or a map has holes left: it has no films between its points.
    """
    ranges = _ranges(first, second, names)
    contacts = [contact.name for contact in first.contacts if contact.name in second.dataset["contact"].values]
    rng = np.random.default_rng(seed)
    (loads, speeds, temperatures) = (ranges[name] for name, _ in AXES)
    places: list[Mapping[str, str | float]] = [
        {
            "contact": contacts[rng.integers(len(contacts))],
            "load": log_uniform(rng, *loads),
            "entrainment_speed": log_uniform(rng, *speeds),
            "temperature": float(rng.uniform(*temperatures)),
        }
        for _ in range(count)
    ]
    found = []
    for emap, name in zip((first, second), names, strict=True):
        try:
            found.append(_films(emap, places))
        except MapError as error:
            raise MapError(f"{name}: {error}") from error
    return FilmSample(seed, ranges, tuple(places), found[0], found[1])


def _ranges(first: EHDMap, second: EHDMap, names: tuple[str, str]) -> dict[str, tuple[float, float]]:
    """Range of each axis that both maps have; of speeds above zero."""
    ranges = {}
    for name, display in AXES:
        a, b = (emap.dataset[name].values.astype(np.float64) for emap in (first, second))
        if name == "entrainment_speed" and np.any(a > 0.0) and np.any(b > 0.0):
            a, b = a[a > 0.0], b[b > 0.0]
        low, high = max(a.min(), b.min()), min(a.max(), b.max())
        if not low <= high or (name == "entrainment_speed" and low == 0.0):
            raise MapError(
                f"{names[0]} and {names[1]}: no {name} in common ({a.size} values, {span(a, display)}, "
                f"against {b.size}, {span(b, display)}); allowed: maps whose ranges overlap; generate one of them on "
                "the other's axis"
            )
        ranges[name] = float(low), float(high)
    return ranges


def _films(emap: EHDMap, places: list[Mapping[str, str | float]]) -> dict[str, FloatArray]:
    """Variables of a map at some places."""
    field = emap.film_field(tuple(sorted({str(place["contact"]) for place in places})))
    contacts = {contact.name: contact for contact in emap.contacts}
    rolling = emap.rolling_film
    rows = []
    for place in places:
        name = str(place["contact"])
        load, speed, temperature = (float(place[axis]) for axis, _ in AXES)
        offset = compliance = loss = 0.0
        if not field.dry:
            at = np.array([[[load]]]), np.array([speed]), np.array([temperature])
            offset, compliance, loss = (float(values.item()) for values in field.films(name, *at))
        whole = structured(contacts[name], load, offset, compliance, loss, np.nan, np.nan)
        force = np.nan if rolling is None else float(rolling.rolling_force(name, load, speed, temperature))
        rows.append((whole.stiffness, whole.damping, whole.approach, offset, compliance, loss, force))
    table = dict(zip(COMPARED_FILMS, np.array(rows, dtype=np.float64).T, strict=True))
    if rolling is None:
        del table["rolling_force"]
    return table
