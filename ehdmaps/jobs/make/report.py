"""Lines about a map that both the summary of a run and `show` print: statuses by cause, error estimates."""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import zip_longest
from typing import Any

import numpy as np
import xarray as xr

from ehdmaps.arrays import BoolArray
from ehdmaps.errors import MapError
from ehdmaps.jobs.make.correction import JUDGED
from ehdmaps.jobs.make.law_check import AGAINST
from ehdmaps.maps import schema
from ehdmaps.maps.emap import EHDMap
from ehdmaps.maps.records import MODEL_ERRORS, SPACING_ERRORS, lubricant_from_json, record_from_json
from ehdmaps.maps.schema import FILM_TABLE, OWN_POINTS, UNSERVED
from ehdmaps.physics.closed_form import BELOW_ROUGHNESS, CONTINUUM, NO_CONTINUUM
from ehdmaps.physics.solution import Status, tip_words, usable_points
from ehdmaps.program import plain
from ehdmaps.table.checked import checked_text
from ehdmaps.units import (
    DAMPING,
    FILM,
    LOAD,
    MASS_FLOW,
    PRESSURE,
    ROLLING_FORCE,
    SPEED,
    STIFFNESS,
    TEMPERATURE,
    point_text,
    span,
)

AXES = (("load", LOAD), ("entrainment_speed", SPEED), ("temperature", TEMPERATURE))
"""Numeric axes and how people read them."""

_LAW_PREFIX = "law_"
ERRORS = (
    "film_offset_error",
    "film_compliance_error",
    "stiffness_error",
    "damping_error",
    "central_film_error",
    "minimum_film_error",
    "max_pressure_error",
    "rolling_force_error",
    "mass_flow_error",
)
"""Error estimates in the order in which they are listed; the last five are missing in maps made before they were."""

FOUND_BY_SOME = (
    ("traction", "traction", ROLLING_FORCE),
    ("wall_stress", "largest wall stress", PRESSURE),
    ("film_temperature", "hottest of the film", TEMPERATURE),
    ("surface_temperature", "hottest of the surfaces", TEMPERATURE),
)
"""What only films with sliding, shear laws or heat have: name, words and display."""

NONE_STATED = "none stated"
"""What stands in place of an error that the solver does not state."""

_NUMBER = re.compile(r"[-+]?[0-9]+(?:\.[0-9]+)?(?:[eE][-+]?[0-9]+)?")
LOG_TAIL = re.compile(r"; last lines of the log:.*")
"""What a failed run of a program says of its log, behind its cause."""


def holes(dataset: xr.Dataset) -> int:
    """Return the number of points without a solution, filled or not."""
    return int(np.count_nonzero(~usable_points(dataset["status"].values)))


def status_counts(dataset: xr.Dataset, roughness: float = 0.0) -> dict[str, BoolArray]:
    """Return which points have each status, flat, by its words; those that no point has are left out.

    Parameters
    ----------
    dataset : xarray.Dataset
        The map.
    roughness : float
        Combined rms roughness [m]; 0 where none is known.
    """
    status, film = dataset["status"].values.ravel(), dataset["minimum_film"].values.ravel()
    converged = (status == int(Status.CONVERGED)) & (film > 0.0)
    below = converged & (film < CONTINUUM)
    rough = converged & ~below & (film < roughness)
    word = Status.CONVERGED.word
    masks = {known.word: status == int(known) for known in Status}
    masks = {
        word: masks[word] & ~below & ~rough,
        f"{word}, {BELOW_ROUGHNESS}": rough,
        f"{word}, {NO_CONTINUUM}": below,
        **{known: here for known, here in masks.items() if known != word},
    }
    return {words: here for words, here in masks.items() if here.any()}


def status_lines(dataset: xr.Dataset, roughness: float = 0.0) -> Iterator[str]:
    """Yield the statuses, grouped by cause, with the corner of the map where each is found.

    Reasons that differ in their numbers or their logs only count as one cause; the first is shown.

    Parameters
    ----------
    dataset : xarray.Dataset
        The map.
    roughness : float
        Combined rms roughness [m]; 0 where none is known.
    """
    for group in status_rows(dataset, roughness):
        yield f"  {group.words:17s} {group.count:7d}  {100.0 * group.share:6.2f} %"
        if "," in group.words:
            yield f"              {group.where}"
        for cause in group.causes:
            yield f"    {cause.count:7d} x {cause.text}"
            yield f"              {cause.where}"
    filled = int(np.count_nonzero(dataset["filled"].values))
    if filled:
        yield f"  of the points without a solution {filled} are isolated and filled from their neighbours"


@dataclass(frozen=True)
class Cause:
    """Points of one status that have one reason.

    Attributes
    ----------
    count : int
        How many there are.
    text : str
        The reason of the first, and whether numbers differ in those of the others.
    where : str
        Ranges of the axes in which they lie.
    """

    count: int
    text: str
    where: str


@dataclass(frozen=True)
class StatusGroup:
    """Points of one status.

    Attributes
    ----------
    words : str
        The status.
    count : int
        How many there are.
    share : float
        Their share of all points.
    where : str
        Ranges of the axes in which they lie.
    causes : tuple of Cause
        Their reasons, where they have some.
    """

    words: str
    count: int
    share: float
    where: str
    causes: tuple[Cause, ...]


def status_rows(dataset: xr.Dataset, roughness: float = 0.0) -> Iterator[StatusGroup]:
    """Yield the points by status and cause.

    Parameters
    ----------
    dataset : xarray.Dataset
        The map.
    roughness : float
        Combined rms roughness [m]; 0 where none is known.
    """
    reasons = np.array([plain(reason) for reason in dataset["reason"].values.ravel()], dtype=object)
    kinds = np.array([_NUMBER.sub("#", LOG_TAIL.sub("", reason)) for reason in reasons], dtype=object)
    for words, here in status_counts(dataset, roughness).items():
        causes = []
        for kind in sorted(set(kinds[here]) - {""}):
            of_cause = here & (kinds == kind)
            bare = {LOG_TAIL.sub("", reason) for reason in reasons[of_cause]}
            differ = " (numbers differ)" if len(bare) > 1 else ""
            text = f"{reasons[of_cause][0]}{differ}"
            causes.append(Cause(int(np.count_nonzero(of_cause)), text, _corner(dataset, of_cause)))
        yield StatusGroup(words, int(np.count_nonzero(here)), float(here.mean()), _corner(dataset, here), tuple(causes))


def _corner(dataset: xr.Dataset, chosen: BoolArray) -> str:
    """Say in which ranges of the axes the chosen points lie."""
    index = np.nonzero(chosen.reshape(dataset["status"].shape))
    names = [str(dataset["contact"].values[i]) for i in np.unique(index[0])]
    ranges = [
        span(dataset[name].values[index[position]], display) for position, (name, display) in enumerate(AXES, start=1)
    ]
    return f"{' and '.join(names)}, {', '.join(ranges)}"


def extrapolated_lines(dataset: xr.Dataset) -> Iterator[str]:
    """Yield how many points lie beyond the pressures to which the viscosity holds, and where; or nothing."""
    beyond = dataset["viscosity_extrapolated"].values.astype(bool)
    if beyond.any():
        share = f"{np.count_nonzero(beyond)} points, {100.0 * beyond.mean():.2f} %"
        yield f"  viscosity extrapolated: {share}, with pressures above {fitted_pressure(dataset)}"
        yield f"              {_corner(dataset, beyond.ravel())}"


def fitted_pressure(dataset: xr.Dataset) -> str:
    """Say up to which pressure the viscosity of the map's oil holds, and whether that is known."""
    return lubricant_from_json(dataset.attrs["lubricant"]).reach


def films_lines(dataset: xr.Dataset) -> Iterator[str]:
    """Say where the films of a map come from; nothing of a map that was to be solved."""
    if why := dataset.attrs.get(OWN_POINTS):
        yield f"films: points of your own, {why}; laws read these points, and were not checked"
    elif FILM_TABLE in dataset.attrs:
        points = dataset["status"].size
        yield f"films: {points} points read from the film table, as the films of the laws are; none solved"
        if text := checked_text(str(dataset.attrs[FILM_TABLE])):
            yield f"  {text}"
    elif why := dataset.attrs.get(UNSERVED):
        yield f"films: all solved; {why}"


def error_lines(dataset: xr.Dataset) -> Iterator[str]:
    """Yield median, 95 % quantile and maximum of the error estimates over the solved points."""
    yield "  estimated relative error       median       95 %    largest"
    for label, numbers in error_rows(dataset):
        if numbers is None:
            yield f"  {label:25s} {NONE_STATED:>11s}"
        else:
            middle, high, most = numbers
            yield f"  {label:25s} {middle:11.2g} {high:10.2g} {most:10.2g}"
    if tip := tip_line(dataset):
        yield f"  {tip}"


def tip_line(dataset: xr.Dataset) -> str:
    """Say what the largest pressures of a map lack of sharp spikes; empty where they lack nothing."""
    name = "max_pressure_error"
    return tip_words(float(np.max(dataset[name].fillna(0.0)))) if name in dataset else ""


def error_rows(dataset: xr.Dataset) -> Iterator[tuple[str, tuple[float, float, float] | None]]:
    """Yield each quantity with median, 95 % quantile and maximum of its error estimates; None where none is stated."""
    for name in ERRORS:
        yield name.removesuffix("_error").replace("_", " "), _quantiles(dataset, name)


def _quantiles(
    dataset: xr.Dataset, name: str, shares: tuple[float, float, float] = (0.5, 0.95, 1.0)
) -> tuple[float, float, float] | None:
    """Quantiles of the known values of a variable; None where it is not there or none is known."""
    values = dataset[name].values if name in dataset else np.empty(0)
    known = values[np.isfinite(values)]
    if not known.size:
        return None
    low, middle, high = map(float, np.quantile(known, shares))
    return low, middle, high


def value_lines(dataset: xr.Dataset) -> Iterator[str]:
    """Yield the ranges of the main variables over the points that have values."""
    shown = (
        ("approach", FILM),
        ("film_offset", FILM),
        ("stiffness", STIFFNESS),
        ("damping", DAMPING),
        ("central_film", FILM),
        ("minimum_film", FILM),
        ("max_pressure", PRESSURE),
        ("rolling_force", ROLLING_FORCE),
        ("mass_flow", MASS_FLOW),
        *((name, display) for name, _, display in FOUND_BY_SOME if name in dataset),
    )
    yield "  variable                     smallest     median    largest  unit"
    for name, display in shown:
        if (numbers := _quantiles(dataset, name, (0.0, 0.5, 1.0))) is None:
            yield f"  {name:25s}        none"
        else:
            low, middle, high = map(display.value, numbers)
            yield f"  {name:25s} {low:11.4g} {middle:10.4g} {high:10.4g}  {display.unit}"


def reach_lines(emap: EHDMap) -> Iterator[str]:
    """Yield the reach of the contact laws of a map, laws with the same one together, and why there is none.

    Parameters
    ----------
    emap : EHDMap
        The map.
    """
    names = [contact.name for contact in emap.contacts]
    kinds = [*([("series", ("inner", "outer"))] if "inner" in names else []), *((name, (name,)) for name in names)]
    by_text = defaultdict(list)
    for kind, contacts in kinds:
        try:
            emap.check_usable(contacts)
            by_text[emap.reach(contacts).parts].append(kind)
        except MapError as error:
            by_text[(f"none: {error}",)].append(kind)
    yield "contact laws"
    for parts, which in by_text.items():
        yield from (f"  {words:20s} {part}" for words, part in zip_longest([", ".join(which)], parts, fillvalue=""))


def law_lines(dataset: xr.Dataset) -> Iterator[str]:
    """Yield what the check of the contact laws found; nothing where there was none."""
    law = list(law_rows(dataset))
    if law:
        yield f"accuracy of the contact laws, at random points against {against(dataset)}"
        yield from (f"  {label:36s} {text}" for label, text in law)


def against(dataset: xr.Dataset) -> str:
    """Films that the laws of a map were held against, in words.

    Parameters
    ----------
    dataset : xarray.Dataset
        The map.
    """
    return str(dataset.attrs.get(AGAINST, "fresh solves"))


def law_rows(dataset: xr.Dataset) -> Iterator[tuple[str, str]]:
    """Yield what that check looked at, and what it found."""
    for key, value in dataset.attrs.items():
        if key.startswith(_LAW_PREFIX):
            text = f"{value:.2%}" if key.endswith("_within_bar") else plain(value)
            yield key.removeprefix(_LAW_PREFIX).replace("_", " "), text


def spacing_lines(dataset: xr.Dataset) -> Iterator[str]:
    """Yield what laws lose between the points of a map, and where most; nothing of a map that does not state it."""
    rows = list(spacing_rows(dataset))
    if not rows:
        return
    yield f"contact laws between the points of the map: what its axes lose, by films of {_reference(dataset)}"
    yield "  estimated relative error       median       95 %    largest"
    for label, (middle, high, most), where in rows:
        yield f"  {label:25s} {middle:11.2g} {high:10.2g} {most:10.2g}  {where}"
    if text := spacing_coverage(dataset):
        yield f"  {text}"
    yield f"  bounds of the laws have these errors; {spacing_remedy(str(dataset.attrs.get('solver', '')))}"


def spacing_remedy(solver: str) -> str:
    """Say what makes the laws of a map better between its points.

    Parameters
    ----------
    solver : str
        Name of the solver of the map.
    """
    more = "more loads, speeds and temperatures make them smaller"
    return {
        "reynolds": '`backbone = "law"` solves lines between the points, which leaves hardly any',
        "openfoam": "a map of reynolds that a few points of openfoam correct has hardly any, as nu308_cfd, nor have "
        f'isothermal films with `backbone = "law"`; {more}',
    }.get(solver, more)


def spacing_rows(dataset: xr.Dataset) -> Iterator[tuple[str, tuple[float, float, float], str]]:
    """Yield each quantity with median, 95 % quantile and largest of what laws lose, and where that is."""
    for name in SPACING_ERRORS if all(name in dataset for name in SPACING_ERRORS) else ():
        values = dataset[name].transpose(*schema.DIMS).values
        if numbers := _quantiles(dataset, name):
            i, *place = np.unravel_index(int(np.nanargmax(values)), values.shape)
            at = zip(AXES, place, strict=True)
            near = [display.text(float(dataset[axis].values[n])) for (axis, display), n in at]
            label = name.removesuffix("_spacing_error").replace("_", " ")
            yield label, numbers, f"around {dataset['contact'].values[i]}, {', '.join(near)}"


def _reference(dataset: xr.Dataset) -> str:
    """Name of the solver of the films that told."""
    return plain(dataset.attrs.get("spacing_solver", "a solver that is not named"))


def spacing_coverage(dataset: xr.Dataset) -> str:
    """Say how often these errors are enough; empty where that was not looked at."""
    points = int(dataset.attrs.get("spacing_points", 0))
    shares = [
        f"{name.removesuffix('_spacing_error').replace('_', ' ')} {float(dataset.attrs[f'{name}_within']):.0%}"
        for name in SPACING_ERRORS
        if f"{name}_within" in dataset.attrs
    ]
    return f"not exceeded at {points} random points: {', '.join(shares)}" if points and shares else ""


_LEVELS = ("median", "95 %", "largest")
_WIDTH = 49
_USABLE = ("converged", "asymptote")


def correction_lines(dataset: xr.Dataset) -> Iterator[str]:
    """Yield by what a map is corrected, by how many points, and how well; nothing for a map that is not.

    Parameters
    ----------
    dataset : xarray.Dataset
        The map.

    Raises
    ------
    MapError
        If its attribute `correction` is not as `generate` writes it.
    """
    if schema.CORRECTION not in dataset.attrs:
        return
    try:
        lines = list(_lines(dataset, record_from_json(dataset.attrs[schema.CORRECTION], schema.CORRECTION)))
    except (KeyError, TypeError, ValueError, AttributeError) as error:
        raise MapError(
            f"attribute {schema.CORRECTION} is not as `ehdmaps generate` writes it; generate the map again"
        ) from error
    yield from lines


def unsolved(dataset: xr.Dataset) -> int:
    """Number of points that the correcting solver was asked for and that have no solution by both.

    Parameters
    ----------
    dataset : xarray.Dataset
        A map, just made.
    """
    if schema.CORRECTION not in dataset.attrs:
        return 0
    record = record_from_json(dataset.attrs[schema.CORRECTION], schema.CORRECTION)
    return int(record["asked"]) - int(record["usable"])


def _lines(dataset: xr.Dataset, record: Mapping[str, Any]) -> Iterator[str]:
    """Yield the lines of a correction."""
    settings = ", ".join(f"{plain(key).replace('_', ' ')} {plain(value)}" for key, value in record["settings"].items())
    what = (
        f"refinement lines by {plain(record['lines'])}, corrected at points of the map"
        if "lines" in record
        else "correction"
    )
    yield f"{what} by {plain(record['solver'])}{f' ({settings})' if settings else ''}"
    counts = f"{int(record['asked'])} points, {int(record['usable'])} of them with a solution by both solvers"
    yield f"  {counts}; {float(record['solve_seconds']):.3g} s of processor time for solving"
    failed = defaultdict(list)
    for point in record["points"]:
        if point["status"] not in _USABLE:
            failed[plain(point["status"])].append(point)
    for status, points in failed.items():
        yield f"  {status:17s} {len(points):7d}"
        for point in points:
            yield f"    {_place(point)}: {plain(point.get('reason', 'no reason given'))}"
    for name in record["not_applied"]:
        words = plain(name).replace("_", " ")
        yield f"  {words} left as it was: points left out one by one are no better with the correction"
    yield f"  {'difference from it, relative':{_WIDTH}s}" + "".join(f"{level:>11s}" for level in _LEVELS)
    kinds = {"before": "not corrected", "leave_one_out": "corrected, leaving out each point"}
    kinds |= {"witnesses": "corrected, at others"} if "witnesses" in record else {}
    for kind, words in kinds.items():
        for name in JUDGED:
            values = "".join(f"{float(record[kind][name][level]):11.2g}" for level in _LEVELS)
            yield f"  {name.replace('_', ' ') + ', ' + words:{_WIDTH}s}{values}"
    for name in MODEL_ERRORS:
        if numbers := _quantiles(dataset, name):
            values = "".join(f"{value:11.2g}" for value in numbers)
            yield f"  {name.partition('_')[0] + ', one deviation, at all points':{_WIDTH}s}{values}"


def _place(point: Mapping[str, Any]) -> str:
    """Say where a point lies."""
    place = point_text(*(float(point[name]) for name, _ in AXES))
    return f"{plain(point['contact'])} at {place}"
