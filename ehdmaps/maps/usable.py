"""Whether a law can be made from a map: no holes, no clusters of filled points, films and stiffness positive.

Of a map with a backbone both are looked at: the backbone is what laws read, the grid is what the map promises.
"""

from __future__ import annotations

import numpy as np
import xarray as xr

from ehdmaps.arrays import BoolArray
from ehdmaps.errors import MapError
from ehdmaps.maps.schema import BACKBONE_DIMS, BACKBONE_VARIABLES, DIMS, NOT_NEEDED
from ehdmaps.physics.solution import Status
from ehdmaps.units import LOAD, SPEED, TEMPERATURE

_NEEDED = ("film_offset", "stiffness", "damping")
_SHOWN = 3


def check_usable(dataset: xr.Dataset, contacts: tuple[str, ...]) -> None:
    """Refuse a map that a law of these contacts cannot stand on.

    Parameters
    ----------
    dataset : xarray.Dataset
        The map.
    contacts : tuple of str
        Contacts that the law uses.

    Raises
    ------
    MapError
        With every reason, each with places and what to do.
    """
    chosen = dataset.sel(contact=list(contacts)).transpose(*DIMS, ...)
    filled = chosen["filled"].values.astype(bool) if "filled" in chosen else np.zeros(_shape(chosen), bool)
    usable = np.isin(chosen["status"].values, [int(status) for status in Status if status.usable]) | filled
    for name in _NEEDED:
        usable &= np.isfinite(chosen[name].values)
    problems = []
    if not np.all(usable):
        problems.append(
            f"{np.count_nonzero(~usable)} holes, {_places(chosen, ~usable)}; "
            "solve them again with other settings of the solver, let `generate` fill them, or leave them "
            "out of the axes"
        )
    clusters = _clusters(filled)
    if np.any(clusters):
        problems.append(
            f"{np.count_nonzero(clusters)} filled points beside one another, {_places(chosen, clusters)}; "
            "nothing is known there; solve them again with other settings of the solver"
        )
    if not problems:
        problems = _unphysical(chosen)
    if problems:
        raise MapError("\n".join(f"law of {', '.join(contacts)}: the map has {problem}" for problem in problems))


def check_backbone(group: xr.Dataset) -> None:
    """Refuse a backbone that holds no numbers where it says that it was solved, or two unsolved points in a row.

    One unsolved point between solved ones is bridged as one of the grid is filled; the ends of a line, where the last
    points may be beyond reach, are continued.

    Parameters
    ----------
    group : xarray.Dataset
        Group "backbone" of a map.

    Raises
    ------
    MapError
        With every reason, each with places and what to do.
    """
    group = group.transpose(*BACKBONE_DIMS, ...)
    status = group["status"].values
    usable = np.isin(status, [int(known) for known in Status if known.usable])
    solved = usable & (group["film_offset"].values > 0.0)
    for entry in BACKBONE_VARIABLES:
        solved &= np.isfinite(group[entry.name].values)
    problems = []
    if np.any(usable & ~solved):
        problems.append(
            f"{np.count_nonzero(usable & ~solved)} solved points without a number or with no positive film, "
            f"{_lines(group, usable & ~solved)}"
        )
    between = np.logical_or.accumulate(solved, 0) & np.logical_or.accumulate(solved[::-1], 0)[::-1]
    missing = ~solved & between
    clusters = missing & (status == NOT_NEEDED)
    clusters[1:] |= missing[1:] & missing[:-1]
    if np.any(clusters):
        problems.append(
            f"{np.count_nonzero(clusters)} unsolved points beside one another within a line, {_lines(group, clusters)}"
        )
    if problems:
        raise MapError("\n".join(f"backbone of the map: has {problem}; generate the map again" for problem in problems))


def _lines(group: xr.Dataset, where: BoolArray) -> str:
    """Name the first few lines of the backbone that have such points."""
    found = np.argwhere(where.any(axis=0))
    names = [
        f"at reference speed {float(group['reference_speed'].values[j]):.4g} m/s and "
        f"{TEMPERATURE.text(float(group['temperature'].values[k]))}"
        for j, k in found[:_SHOWN]
    ]
    return "; ".join(names) + (f"; and {len(found) - len(names)} more lines" if len(found) > len(names) else "")


def _shape(chosen: xr.Dataset) -> tuple[int, ...]:
    """Lengths of the axes."""
    return tuple(chosen.sizes[name] for name in DIMS)


def _clusters(filled: BoolArray) -> BoolArray:
    """Filled points with a filled neighbour along load, speed or temperature."""
    found = np.zeros_like(filled)
    for axis in (1, 2, 3):
        rows, marks = np.moveaxis(filled, axis, 0), np.moveaxis(found, axis, 0)
        pairs = rows[1:] & rows[:-1]
        marks[1:] |= pairs
        marks[:-1] |= pairs
    return found


def _unphysical(chosen: xr.Dataset) -> list[str]:
    """Values of which no law can be made; a map without any film is a dry one, which is fine.

    A damping that is negative at the bottom of its valley is for the film field to lift.
    """
    if not np.any(chosen["film_offset"].values):
        return []
    moving = np.broadcast_to((chosen["entrainment_speed"].values > 0.0)[:, None], _shape(chosen))
    problems = []
    for name, word in (("film_offset", "film offset"), ("stiffness", "stiffness")):
        wrong = moving & ~(chosen[name].values > 0.0)
        if np.any(wrong):
            problems.append(
                f"{np.count_nonzero(wrong)} points whose {word} is not positive, {_places(chosen, wrong)}; "
                "a law needs it positive; solve them again with a finer grid"
            )
    return problems


def _places(chosen: xr.Dataset, where: BoolArray) -> str:
    """Name the first few points."""
    names = []
    for i, j, k, m in np.argwhere(where)[:_SHOWN]:
        load, speed, temperature = (
            float(chosen[name].values[index])
            for name, index in (("load", j), ("entrainment_speed", k), ("temperature", m))
        )
        names.append(
            f"{chosen['contact'].values[i]} at {LOAD.text(load)}, {SPEED.text(speed)}, {TEMPERATURE.text(temperature)}"
        )
    more = np.count_nonzero(where) - len(names)
    return "; ".join(names) + (f"; and {more} more" if more > 0 else "")
