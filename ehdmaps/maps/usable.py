"""Conditions for a law from a map: where its points are known, and that their films and stiffness are positive.

Only what the law reads is looked at: the backbone where a map has one, else the grid, of the law's own contacts.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from ehdmaps.arrays import BoolArray, FloatArray, IntArray
from ehdmaps.errors import MapError
from ehdmaps.maps import schema
from ehdmaps.maps.backbone import FILMS, IMAGINARY, REAL
from ehdmaps.maps.backbone_plan import zeta_span
from ehdmaps.maps.schema import BACKBONE_DIMS, DIMS, NOT_NEEDED
from ehdmaps.physics.contact import LineContact
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.solution import Status, usable_points
from ehdmaps.units import LOAD, SPEED, TEMPERATURE, point_text

if TYPE_CHECKING:
    import xarray as xr

    from ehdmaps.maps.edges.reach import Reach

_SHOWN = 3
_AGAIN = "generate the map again"
_ENDED = (Status.STAGNATED, Status.DIVERGED, Status.OUTSIDE_VALIDITY)
"""How points end that the same solver does not solve the next time either."""

_SLOWEST = 1.0
"""Longest time c/k in which a contact answers that a map may state [s]. Films of real oils take up to 10 ms."""

_CONTRADICTS = 0.3, 0.2
"""Change of the logarithm of the film over all loads, as its compliance gives it, may differ by this part of it, and by
this much, from what it is: coarse axes of loads differ by 0.08 and 0.2 of it."""

_ROUND_OFF = 1e-9
"""Relative: what an axis of the backbone differs by from the axis of the map that it was laid for."""


def check_loads(loads: FloatArray, contacts: Sequence[LineContact]) -> None:
    """Refuse a law of a map with one load: nothing is known of how load and approach change together.

    Parameters
    ----------
    loads : ndarray
        Axis of the map [N/m].
    contacts : sequence of LineContact
        Contacts that the law uses.

    Raises
    ------
    MapError
        With what to do.
    """
    if loads.size < 2:
        raise MapError(
            f"law of {', '.join(contact.name for contact in contacts)}: the map has one load, "
            f"{LOAD.text(float(loads[0]))}; a law needs two or more; add some to `load` of [grid] in the job, and "
            "generate the map again"
        )


def known_grid(dataset: xr.Dataset, contacts: Sequence[LineContact]) -> tuple[Reach, BoolArray]:
    """Reach of a law of these contacts, from a map without a backbone.

    Parameters
    ----------
    dataset : xarray.Dataset
        The map, with its films.
    contacts : sequence of LineContact
        Contacts that the law uses.

    Returns
    -------
    reach : Reach
        Loads, speeds and temperatures of the law.
    read : array (contacts, n_w, n_u, n_T)
        Points that it reads, all with a speed.

    Raises
    ------
    MapError
        Where no law can be made at all: with every reason, each with places and what to do.
    """
    from ehdmaps.maps.edges.reach import known_runs, reach_of, whole_reach  # with points, that others do not need

    names = [contact.name for contact in contacts]
    chosen = dataset.sel(contact=names).transpose(*DIMS, ...)
    filled = chosen["filled"].values.astype(bool) if "filled" in chosen else np.zeros(_shape(chosen), bool)
    usable = usable_points(chosen["status"].values) | filled
    for name in FILMS:
        usable &= np.isfinite(chosen[name].values)
    # of filled points beside one another nothing is known
    clusters = _clusters(filled)
    loads, speeds, temperatures = (chosen[name].values.astype(np.float64) for name in DIMS[1:])
    axes, moving = (loads, speeds, temperatures), speeds > 0.0
    known = known_runs(usable & ~clusters)
    reach: Reach | None = whole_reach(axes)
    if not np.all(known[:, :, moving]):
        reach = reach_of(known, axes)
    if reach is None:
        missing = ~known & moving[:, None]
        raise MapError(
            f"law of {', '.join(names)}: no two loads are known at any speed and temperature; the map has "
            f"{np.count_nonzero(missing)} holes, {_places(chosen, missing)}; solve them again with other settings of "
            "the solver, let `generate` fill them, or take films that need no points: --law table"
        )
    read = np.zeros_like(known)
    read[:, :, reach.rows[:, None], reach.columns] = True
    read &= known
    if np.any(np.nan_to_num(chosen["film_offset"].values)):  # else a dry map, of which all is known
        check_loads(loads, contacts)
        problems = _unphysical(chosen, contacts, read)
        if problems:
            raise MapError("\n".join(f"law of {', '.join(names)}: the map has {problem}" for problem in problems))
    return reach, read


def check_backbone(
    group: xr.Dataset,
    reference: LineContact,
    contacts: Sequence[LineContact],
    lubricant: Lubricant,
    loads: tuple[float, float],
    speeds: tuple[float, float],
) -> None:
    """Refuse a backbone that holds no numbers where it says that it was solved, or two unsolved points in a row.

    One unsolved point is bridged as one of the grid is filled. The ends of a line are continued as far as they lie
    beyond the loads of the map; within them, every place of a contact of the law counts.

    Parameters
    ----------
    group : xarray.Dataset
        Group "backbone" of a map.
    reference : LineContact
        Contact of that group.
    contacts : sequence of LineContact
        Contacts that the law uses.
    lubricant : Lubricant
        The oil.
    loads, speeds : tuple of float
        Range of the map's axes [N/m], [m/s]; speeds > 0.

    Raises
    ------
    MapError
        With every reason, each with places and what to do.
    """
    group = group.transpose(*BACKBONE_DIMS, ...)
    status = group["status"].values
    usable = usable_points(status)
    solved = usable & (group["film_offset"].values > 0.0)
    for name in FILMS:
        solved &= np.isfinite(group[name].values)
    if schema.NATURAL in group.variables:
        for name in (REAL, IMAGINARY):
            solved &= np.isfinite(group[name].values).all(axis=-1)
    problems = []
    if np.any(usable & ~solved):
        problems.append(
            f"{np.count_nonzero(usable & ~solved)} solved points without a number or with no positive film, "
            f"{_lines(group, usable & ~solved)}"
        )
    slow = solved & (
        group["loss_compliance"].values
        > _SLOWEST * (np.abs(group["film_compliance"].values) + 1.0 / reference.reduced_modulus)
    )
    if np.any(slow):
        problems.append(
            f"{np.count_nonzero(slow)} points whose loss compliance is more than {_SLOWEST:g} s times their "
            f"compliance, {_lines(group, slow)}"
        )
    between = np.logical_or.accumulate(solved, 0) & np.logical_or.accumulate(solved[::-1], 0)[::-1]
    missing = ~solved & (between | _within(group, reference, contacts, lubricant, loads, speeds))
    clusters = missing & (status == NOT_NEEDED)
    clusters[1:] |= missing[1:] & missing[:-1]
    if np.any(clusters):
        problems.append(
            f"{np.count_nonzero(clusters)} unsolved points beside one another within a line, {_lines(group, clusters)}"
        )
    if problems:
        unsolved = _unsolved_remedy(status[clusters])
        remedies = [_AGAIN] * (len(problems) - 1) + [unsolved if np.any(clusters) else _AGAIN]
        found = zip(problems, remedies, strict=True)
        raise MapError("\n".join(f"backbone of the map: has {problem}; {remedy}" for problem, remedy in found))


def _unsolved_remedy(status: IntArray) -> str:
    """Remedy for points that a solver left unsolved, by how each ended: the same job would end so again."""
    ended = [known for known in _ENDED if np.any(status == int(known))]
    if not ended or np.any(~np.isin(status, [int(known) for known in _ENDED])):
        return _AGAIN
    words = " and ".join(known.name.lower().replace("_", " ") for known in ended)
    return (
        f"the solver ended there ({words}), and the same job ends there again; in the job, leave these speeds, "
        "temperatures or loads out of [grid], or change [solver]: without its shear or physics, or with another density"
    )


def _within(
    group: xr.Dataset,
    reference: LineContact,
    contacts: Sequence[LineContact],
    lubricant: Lubricant,
    loads: tuple[float, float],
    speeds: tuple[float, float],
) -> BoolArray:
    """Places of the backbone that are points within the map for one of the contacts."""
    zeta = group["zeta"].values
    found = np.zeros(group["status"].shape, bool)
    low, high = speeds[0] * (1.0 - _ROUND_OFF), speeds[1] * (1.0 + _ROUND_OFF)
    for j, speed in enumerate(group["reference_speed"].values):
        here = [contact for contact in contacts if low <= speed * contact.radius / reference.radius <= high]
        for k, temperature in enumerate(group["temperature"].values if here else ()):
            first, last = zeta_span(here, lubricant, reference, loads, float(speed), float(temperature))
            found[:, j, k] = (zeta >= first) & (zeta <= last)
    return found


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


def _unphysical(chosen: xr.Dataset, contacts: Sequence[LineContact], known: BoolArray) -> list[str]:
    """Values of known points of which no law can be made.

    A damping that is negative at the bottom of its valley is for the film field to lift.
    """
    problems = []
    dry = np.array([contact.structural_compliance(chosen["load"].values) for contact in contacts])[:, :, None, None]
    compliance = dry + chosen["film_compliance"].values
    for values, word in ((chosen["film_offset"].values, "film offset"), (compliance, "stiffness")):
        wrong = known & ~(values > 0.0)
        if np.any(wrong):
            problems.append(
                f"{np.count_nonzero(wrong)} points whose {word} is not positive, {_places(chosen, wrong)}; "
                "a law needs it positive; solve them again with a finer grid"
            )
    if problems:
        return problems
    slow = known & ~(chosen["loss_compliance"].values <= _SLOWEST * compliance)
    if np.any(slow):
        problems.append(
            f"{np.count_nonzero(slow)} points whose damping is more than {_SLOWEST:g} s times the stiffness, "
            f"{_places(chosen, slow)}; look at loss_compliance, or damping, there: the unit is m2 s/N, or N s/m2"
        )
    return problems + _contradicting(chosen, known)


def _contradicting(chosen: xr.Dataset, known: BoolArray) -> list[str]:
    """Lines over the loads whose film compliance is not the slope of their film offset."""
    loads, offset = chosen["load"].values[:, None, None], np.where(known, chosen["film_offset"].values, 1.0)
    steps = np.diff(np.log(loads), axis=0) * (known[:, 1:] & known[:, :-1])
    slope = np.where(known, chosen["film_compliance"].values * loads / offset, 0.0)
    by_compliance = np.sum(0.5 * (slope[:, 1:] + slope[:, :-1]) * steps, axis=1)
    found = -np.sum(np.diff(np.log(offset), axis=1) * (steps > 0.0), axis=1)
    part, least = _CONTRADICTS
    # between two loads the slope is anything between those there
    unknown = np.sum(0.5 * np.abs(np.diff(slope, axis=1)) * steps, axis=1)
    wrong = np.abs(by_compliance - found) > part * np.maximum(np.abs(found), np.abs(by_compliance)) + least + unknown
    if not np.any(wrong):
        return []
    i, k, m = np.argwhere(wrong)[0]
    place = f"{SPEED.text(float(chosen['entrainment_speed'].values[k]))}, " + TEMPERATURE.text(
        float(chosen["temperature"].values[m])
    )
    return [
        f"{np.count_nonzero(wrong)} lines over the load whose film_offset contradicts film_compliance, or stiffness: "
        f"of {chosen['contact'].values[i]} at {place} the film offset falls by a factor of "
        f"{np.exp(found[i, k, m]):.4g}, and by its compliance, which is minus its slope, by one of "
        f"{np.exp(min(by_compliance[i, k, m], 700.0)):.4g}; generate the map again, or correct the one or the other"
    ]


def _places(chosen: xr.Dataset, where: BoolArray) -> str:
    """Name the first few points."""
    names = []
    for i, j, k, m in np.argwhere(where)[:_SHOWN]:
        at = (float(chosen[name].values[index]) for name, index in zip(schema.DIMS[1:], (j, k, m), strict=True))
        names.append(f"{chosen['contact'].values[i]} at {point_text(*at)}")
    more = np.count_nonzero(where) - len(names)
    return "; ".join(names) + (f"; and {more} more" if more > 0 else "")
