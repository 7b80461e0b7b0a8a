"""Differences between two maps: on the points that they share, and between points, from the films of their laws.

Maps with the same axes, or where one has all points of the other, are compared on these points. Where only some points
or none are shared, films are compared at random points of the range that both maps have, see
`ehdmaps.jobs.compare_films`.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr

from ehdmaps.arrays import BoolArray, FloatArray
from ehdmaps.errors import InputError, MapError
from ehdmaps.jobs.compare_films import COMPARED_FILMS, FilmSample, sampled_films
from ehdmaps.jobs.report import AXES
from ehdmaps.maps.emap import EHDMap
from ehdmaps.maps.records import record_from_json
from ehdmaps.physics.solution import Status

COMPARED = (
    "stiffness",
    "damping",
    "approach",
    "film_offset",
    "film_compliance",
    "loss_compliance",
    "central_film",
    "minimum_film",
    "max_pressure",
    "rolling_force",
)
"""Variables that are compared, as far as both maps have them."""

_SAME_AXIS_VALUE = 1e-9
"""Relative: what two ways of writing one number differ by."""

_PROVENANCE = ("solver", "solver_settings", "structural_law", "lubricant", "geometry", "contacts")

_OF_THE_OFFSET = "film_offset"
"""The approach has the error of the film offset: the solids are exact."""


@dataclass(frozen=True)
class Difference:
    """How far one variable of two maps lies apart, over the points at which both have it.

    A difference is (B - A)/|A|: positive where B is the larger one.

    Attributes
    ----------
    variable : str
        Name of the variable.
    points : int
        How many points were compared.
    median, high, largest : float
        Median, 95 % quantile and largest value of its size; NaN where no point can be compared.
    bias : float
        Median of the signed differences.
    worst : float
        The largest one with its sign.
    place : mapping
        Contact, load [N/m], entrainment speed [m/s] and temperature [K] of the largest; empty where there is none.
    left_out : int
        Points where A is zero.
    over_stated : float
        Median of the size over the stated numerical errors of both maps together; NaN where one states none. Above one
        the maps differ by more than their numbers are uncertain.
    beyond_stated : float
        Share of the points where the size is above the stated errors; NaN where one states none.
    """

    variable: str
    points: int
    median: float
    high: float
    largest: float
    bias: float
    worst: float
    place: Mapping[str, str | float]
    left_out: int
    over_stated: float = np.nan
    beyond_stated: float = np.nan


@dataclass(frozen=True)
class Between:
    """Films of two maps at random points of the range that both have.

    Attributes
    ----------
    sample : FilmSample
        The points, their seed and range.
    differences : tuple of Difference
        One for each variable of `ehdmaps.jobs.compare_films.COMPARED_FILMS` that both maps have.
    """

    sample: FilmSample
    differences: tuple[Difference, ...]


@dataclass(frozen=True, eq=False)
class Comparison:
    """Two maps A and B.

    Attributes
    ----------
    names, titles : tuple of str
        What the maps are called here, and their own titles.
    points : tuple of int
        Points of each map.
    differing : tuple of str
        Attributes in which they differ.
    relative : xarray.Dataset
        (B - A)/|A| of each compared variable, on the points that both maps have; NaN where not both are solved, or A
        is zero and B is not. Empty where no point is shared.
    solved : int
        Points solved in both.
    differences : tuple of Difference
        One for each compared variable; none where no point is solved in both.
    between : Between or None
        Films at random points, where the maps share some of their points only, or none; None where they share all.
    not_between : str
        Why there are none where they would be wanted; empty otherwise.
    """

    names: tuple[str, str]
    titles: tuple[str, str]
    points: tuple[int, int]
    differing: tuple[str, ...]
    relative: xr.Dataset
    solved: int
    differences: tuple[Difference, ...]
    between: Between | None = None
    not_between: str = ""

    @property
    def common(self) -> int:
        """Number of points that both maps have."""
        return int(self.relative[COMPARED[0]].size) if self.relative.data_vars else 0


def compare(
    first: EHDMap | xr.Dataset, second: EHDMap | xr.Dataset, names: tuple[str, str], seed: int = 1
) -> Comparison:
    """Compare two maps, on the points that they share and between them.

    Parameters
    ----------
    first, second : EHDMap or xarray.Dataset
        The maps.
    names : tuple of str
        What messages call them.
    seed : int
        Seed of the random points, where points are not shared.

    Raises
    ------
    MapError
        If they have no contact, or no range of an axis, in common; or where they share no point and one makes no film
        between its points.
    """
    a, b = (source.dataset if isinstance(source, EHDMap) else source for source in (first, second))
    _check_contacts(a, b, names)
    here, there = _common(a, b)
    common = int(here["status"].size)
    between, reason = None, ""
    if common < min(a["status"].size, b["status"].size):
        try:
            emaps = [source if isinstance(source, EHDMap) else EHDMap(source) for source in (first, second)]
            between = _between(sampled_films(emaps[0], emaps[1], names, seed))
        except (MapError, InputError) as error:
            if common == 0:
                raise
            reason = str(error)
    usable = _usable(here) & _usable(there)
    variables = [name for name in COMPARED if name in here and name in there] if common else []
    found = {name: _relative(here[name].values, there[name].values, usable) for name in variables}
    left_out = {name: int(np.count_nonzero(np.isinf(values))) for name, values in found.items()}
    known = {name: np.where(np.isfinite(values), values, np.nan) for name, values in found.items()}
    dims = here["status"].dims
    place = _Grid(here)
    return Comparison(
        names=names,
        titles=(str(a.attrs["title"]), str(b.attrs["title"])),
        points=(int(a["status"].size), int(b["status"].size)),
        differing=tuple(name for name in _PROVENANCE if _without_label(a, name) != _without_label(b, name)),
        relative=xr.Dataset({name: (dims, values) for name, values in known.items()}, coords=here.coords),
        solved=int(usable.sum()),
        differences=tuple(
            _difference(name, known[name], _stated(here, there, name), left_out[name], place)
            for name in (variables if usable.any() else ())
        ),
        between=between,
        not_between=reason,
    )


@dataclass(frozen=True)
class _Grid:
    """Places of the points of a map."""

    dataset: xr.Dataset

    def __call__(self, index: int) -> dict[str, str | float]:
        """Place of a point, by its flat index."""
        data = self.dataset
        at = np.unravel_index(index, data["status"].shape)
        place: dict[str, str | float] = {"contact": str(data["contact"].values[at[0]])}
        return place | {axis: float(data[axis].values[at[position]]) for position, (axis, _) in enumerate(AXES, 1)}


def _between(sample: FilmSample) -> Between:
    """Sum up the differences of films at random points."""
    every = np.ones(len(sample.places), dtype=bool)
    differences = []
    for name in COMPARED_FILMS:
        if name in sample.first and name in sample.second:
            found = _relative(sample.first[name], sample.second[name], every)
            lost = int(np.count_nonzero(np.isinf(found)))
            known = np.where(np.isfinite(found), found, np.nan)
            differences.append(_difference(name, known, np.full(known.shape, np.nan), lost, sample.places.__getitem__))
    return Between(sample, tuple(differences))


def _without_label(dataset: xr.Dataset, name: str) -> object:
    """An attribute; of a record all that is more than shown."""
    text = dataset.attrs.get(name)
    if name not in ("lubricant", "geometry") or text is None:
        return text
    return {key: value for key, value in record_from_json(text, name).items() if key != "label"}


def _relative(a: FloatArray, b: FloatArray, usable: BoolArray) -> FloatArray:
    """Return (b - a)/|a| where both are usable: infinite where a alone is zero, NaN elsewhere."""
    with np.errstate(divide="ignore", invalid="ignore"):
        relative = np.where(a == b, 0.0, (b - a) / np.abs(a))
    return np.where(usable, relative, np.nan)


def _stated(here: xr.Dataset, there: xr.Dataset, name: str) -> FloatArray:
    """Stated errors of both maps together, over |A|; NaN where one states none."""
    of = _OF_THE_OFFSET if name == "approach" else name
    a, b = here[name].values, there[name].values
    total = np.zeros(a.shape)
    for dataset in (here, there):
        error = f"{of}_error"
        if error not in dataset:
            return np.full(a.shape, np.nan)
        total += np.abs(dataset[error].values * dataset[of].values)
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where((a == 0.0) & (b == 0.0), np.nan, total / np.abs(a))


def _difference(name: str, relative: FloatArray, stated: FloatArray, left_out: int, place: Any) -> Difference:
    """Sum up the differences of one variable."""
    signed = relative.ravel()
    known = np.isfinite(signed)
    if not known.any():
        return Difference(name, 0, np.nan, np.nan, np.nan, np.nan, np.nan, {}, left_out)
    size = np.abs(signed)
    middle, high = (float(value) for value in np.quantile(size[known], (0.5, 0.95)))
    worst = int(np.argmax(np.where(known, size, -1.0)))
    told = known & np.isfinite(stated.ravel()) & (stated.ravel() > 0.0)
    ratio = size[told] / stated.ravel()[told]
    return Difference(
        variable=name,
        points=int(known.sum()),
        median=middle,
        high=high,
        largest=float(size[worst]),
        bias=float(np.median(signed[known])),
        worst=float(signed[worst]),
        place=place(worst),
        left_out=left_out,
        over_stated=float(np.median(ratio)) if ratio.size else np.nan,
        beyond_stated=float(np.mean(ratio > 1.0)) if ratio.size else np.nan,
    )


def _usable(dataset: xr.Dataset) -> BoolArray:
    """Whether a point was solved; filled ones were not."""
    return np.isin(dataset["status"].values, [int(status) for status in Status if status.usable])


def _check_contacts(first: xr.Dataset, second: xr.Dataset, names: tuple[str, str]) -> None:
    """Refuse maps that share no contact."""
    if not set(map(str, first["contact"].values)) & set(map(str, second["contact"].values)):
        raise MapError(
            f"{names[0]} and {names[1]}: contacts are {', '.join(map(str, first['contact'].values))} and "
            f"{', '.join(map(str, second['contact'].values))}; allowed: maps that share a contact"
        )


def _common(first: xr.Dataset, second: xr.Dataset) -> tuple[xr.Dataset, xr.Dataset]:
    """Return both maps on the points that they share; with empty axes where they share none."""
    here: dict[str, Any] = {}
    there: dict[str, Any] = {}
    contacts = [str(name) for name in first["contact"].values if name in second["contact"].values]
    here["contact"] = [list(map(str, first["contact"].values)).index(name) for name in contacts]
    there["contact"] = [list(map(str, second["contact"].values)).index(name) for name in contacts]
    for name, _ in AXES:
        a, b = first[name].values, second[name].values
        rows, columns = np.nonzero(np.abs(a[:, None] - b[None, :]) <= _SAME_AXIS_VALUE * np.abs(a[:, None]))
        here[name], there[name] = rows, columns
    return first.isel(here), second.isel(there)
