"""Differences between two maps, on the points that they share and between points; as a table, and as JSON.

Maps with the same axes, or where one has all points of the other, are compared on these points. Where only some points
or none are shared, films are compared at random points of the range that both maps have, see
`ehdmaps.jobs.show.compare`.
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
import xarray as xr

from ehdmaps.arrays import BoolArray, FloatArray
from ehdmaps.errors import InputError, MapError
from ehdmaps.jobs.make.report import AXES, NONE_STATED
from ehdmaps.jobs.make.sampling import log_uniform
from ehdmaps.maps.emap import EHDMap
from ehdmaps.maps.film_field import known_at
from ehdmaps.maps.records import record_from_json
from ehdmaps.physics.contact import structured
from ehdmaps.physics.solution import usable_points
from ehdmaps.units import point_text, span

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


def _between(first: EHDMap, second: EHDMap, names: tuple[str, str], seed: int, count: int = POINTS) -> Between:
    """Compare the films of two maps, which share a contact, at random points of the range that both have."""
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
    for emap, name in zip((first, second), names, strict=True):
        try:
            places = _known(emap, places)
        except MapError as error:
            raise MapError(f"{name}: {error}") from error
    if not places:
        raise MapError(f"{names[0]} and {names[1]}: no films between points in common; generate one of them again")
    a, b = (_films(emap, places) for emap in (first, second))
    every, none_stated = np.ones(len(places), dtype=bool), np.full(len(places), np.nan)
    differences = (
        _difference(name, *_relative(a[name], b[name], every), none_stated, places.__getitem__)
        for name in a
        if name in b
    )
    return Between(seed, ranges, tuple(places), tuple(differences))


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


def _known(emap: EHDMap, places: list[Mapping[str, str | float]]) -> list[Mapping[str, str | float]]:
    """Places of which a map knows the films."""
    fields = {name: emap.film_field((name,)) for name in sorted({str(place["contact"]) for place in places})}

    def known(contact: str, load: float, speed: float, temperature: float) -> bool:
        return bool(known_at(fields[contact], np.array([load]), speed, temperature).all())

    return [place for place in places if known(*place.values())]  # type: ignore[arg-type]


def _films(emap: EHDMap, places: list[Mapping[str, str | float]]) -> dict[str, FloatArray]:
    """Variables of a map at some places."""
    field = emap.film_field(tuple(sorted({str(place["contact"]) for place in places})))
    contacts, rolling = {contact.name: contact for contact in emap.contacts}, emap.rolling_film

    def row(name: str, load: float, speed: float, temperature: float) -> tuple[float, ...]:
        offset = compliance = loss = 0.0
        if not field.dry:
            at = np.array([[[load]]]), np.array([speed]), np.array([temperature])
            offset, compliance, loss = (float(values.item()) for values in field.films(name, *at))
        whole = structured(contacts[name], load, offset, compliance, loss, np.nan, np.nan)
        force = [] if rolling is None else [float(rolling.rolling_force(name, load, speed, temperature))]
        return (whole.stiffness, whole.damping, whole.approach, offset, compliance, loss, *force)

    rows = [row(*place.values()) for place in places]  # type: ignore[arg-type]
    return dict(zip(COMPARED_FILMS, np.array(rows, dtype=np.float64).T, strict=False))


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
    """Difference of one variable between two maps, over the points at which both have it.

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
    seed : int
        Seed of the points.
    ranges : mapping of str to (float, float)
        Range by axis from which they were drawn: load [N/m] and entrainment speed [m/s], log-uniform, and temperature
        [K], uniform.
    places : tuple of mapping
        Contact, load, entrainment speed and temperature of each point.
    differences : tuple of Difference
        One for each variable of `ehdmaps.jobs.show.compare.COMPARED_FILMS` that both maps have.
    """

    seed: int
    ranges: Mapping[str, tuple[float, float]]
    places: tuple[Mapping[str, str | float], ...]
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
    here, there = _common(a, b, names)
    common = int(here["status"].size)
    between, reason = None, ""
    if common < min(a["status"].size, b["status"].size):
        try:
            emaps = [source if isinstance(source, EHDMap) else EHDMap(source) for source in (first, second)]
            between = _between(emaps[0], emaps[1], names, seed)
        except (MapError, InputError) as error:
            if common == 0:
                raise
            reason = str(error)
    usable = usable_points(here["status"]) & usable_points(there["status"])
    variables = [name for name in COMPARED if name in here and name in there] if common else []
    relative = {name: _relative(here[name].values, there[name].values, usable) for name in variables}
    dims = here["status"].dims

    def place(index: int) -> dict[str, str | float]:
        at = np.unravel_index(index, usable.shape)
        axes = {axis: float(here[axis].values[at[position]]) for position, (axis, _) in enumerate(AXES, 1)}
        return {"contact": str(here["contact"].values[at[0]]), **axes}

    return Comparison(
        names=names,
        titles=(str(a.attrs["title"]), str(b.attrs["title"])),
        points=(int(a["status"].size), int(b["status"].size)),
        differing=tuple(name for name in _PROVENANCE if _without_label(a, name) != _without_label(b, name)),
        relative=xr.Dataset({name: (dims, values) for name, (values, _) in relative.items()}, coords=here.coords),
        solved=int(usable.sum()),
        differences=tuple(
            _difference(name, *relative[name], _stated(here, there, name), place)
            for name in (variables if usable.any() else ())
        ),
        between=between,
        not_between=reason,
    )


def _without_label(dataset: xr.Dataset, name: str) -> object:
    """An attribute; of a record all that is more than shown."""
    text = dataset.attrs.get(name)
    if name not in ("lubricant", "geometry") or text is None:
        return text
    return {key: value for key, value in record_from_json(text, name).items() if key != "label"}


def _relative(a: FloatArray, b: FloatArray, usable: BoolArray) -> tuple[FloatArray, int]:
    """Return (b - a)/|a| where both are usable, NaN elsewhere; and at how many of these a alone is zero, NaN too."""
    with np.errstate(divide="ignore", invalid="ignore"):
        relative = np.where(usable, np.where(a == b, 0.0, (b - a) / np.abs(a)), np.nan)
    return np.where(np.isfinite(relative), relative, np.nan), int(np.count_nonzero(np.isinf(relative)))


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


def _difference(name: str, relative: FloatArray, left_out: int, stated: FloatArray, place: Any) -> Difference:
    """Sum up the differences of one variable."""
    signed = relative.ravel()
    known = np.isfinite(signed)
    if not known.any():
        return Difference(name, 0, np.nan, np.nan, np.nan, np.nan, np.nan, {}, left_out)
    size = np.abs(signed)
    middle, high = (float(value) for value in np.quantile(size[known], (0.5, 0.95)))
    worst = int(np.argmax(np.where(known, size, -1.0)))
    has_stated = known & np.isfinite(stated.ravel()) & (stated.ravel() > 0.0)
    ratio = size[has_stated] / stated.ravel()[has_stated]
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


def _common(first: xr.Dataset, second: xr.Dataset, names: tuple[str, str]) -> tuple[xr.Dataset, xr.Dataset]:
    """Return both maps on the points that they share, with empty axes where they share none; refuse other contacts."""
    contacts = [list(map(str, dataset["contact"].values)) for dataset in (first, second)]
    shared = [name for name in contacts[0] if name in contacts[1]]
    if not shared:
        raise MapError(
            f"{names[0]} and {names[1]}: contacts are {', '.join(contacts[0])} and {', '.join(contacts[1])}; "
            "allowed: maps that share a contact"
        )
    here, there = ({"contact": [of.index(name) for name in shared]} for of in contacts)
    for name, _ in AXES:
        a, b = first[name].values, second[name].values
        rows, columns = np.nonzero(np.abs(a[:, None] - b[None, :]) <= _SAME_AXIS_VALUE * np.abs(a[:, None]))
        here[name], there[name] = rows.tolist(), columns.tolist()
    return first.isel(here), second.isel(there)


def comparison_text(comparison: Comparison) -> str:
    """Return a comparison as the table that is printed.

    Parameters
    ----------
    comparison : Comparison
        The comparison.
    """
    return "\n".join(_lines(comparison))


def comparison_json(comparison: Comparison) -> str:
    """Return a comparison as JSON: its fields by their names, without single points; null for what is not known.

    Parameters
    ----------
    comparison : Comparison
        The comparison.
    """
    between = comparison.between
    record = {
        "names": comparison.names,
        "titles": comparison.titles,
        "points": comparison.points,
        "common": comparison.common,
        "solved": comparison.solved,
        "differing": comparison.differing,
        "differences": _records(comparison.differences),
        "between": None
        if between is None
        else {
            "points": len(between.places),
            "seed": between.seed,
            "ranges": between.ranges,
            "differences": _records(between.differences),
        },
        "not_between": comparison.not_between,
    }
    return json.dumps(record, indent=2, allow_nan=False, ensure_ascii=False)


def _records(differences: Sequence[Difference]) -> list[dict[str, Any]]:
    """Differences as plain values."""
    return [
        {
            key: None if isinstance(value, float) and not math.isfinite(value) else value
            for key, value in asdict(entry).items()
        }
        for entry in differences
    ]


def _lines(comparison: Comparison) -> Iterator[str]:
    yield f"A  {comparison.names[0]}: {comparison.titles[0]}"
    yield f"B  {comparison.names[1]}: {comparison.titles[1]}"
    yield (
        f"   differ in {', '.join(comparison.differing)}" if comparison.differing else "   made from the same settings"
    )
    yield (
        f"   {comparison.common} points in common, {comparison.solved} of them solved in both "
        f"(A has {comparison.points[0]}, B {comparison.points[1]})"
    )
    yield from _table(comparison.differences, True)
    if (between := comparison.between) is not None:
        ends = ((between.ranges[axis], display) for axis, display in AXES)
        ranges = ", ".join(f"{display.text(low)} to {display.text(high)}" for (low, high), display in ends)
        yield (
            f"   not all points are shared: films between them, as contact laws read them, at {len(between.places)} "
            f"random points (seed {between.seed}) of the common range, {ranges}; what each map is off by between its "
            "points is part of the differences"
        )
        yield from _table(between.differences, False)
    if comparison.not_between:
        yield f"   not all points are shared, and nothing is compared between them: {comparison.not_between}"


def _table(differences: Sequence[Difference], stated: bool) -> Iterator[str]:
    """Yield a table of differences."""
    if not differences:
        return
    heads = f"{'over stated error':>20s}" if stated else ""
    yield f"{'(B - A)/|A|':27s}{'median size':>13s} {'95 %':>10s} {'largest':>10s} {'median':>10s}{heads}  largest at"
    for entry in differences:
        note = f"  ({entry.left_out} points where A is zero left out)" if entry.left_out else ""
        if not entry.place:
            yield f"  {entry.variable:25s} no point to compare{note}"
            continue
        numbers = f"{entry.median:13.3g} {entry.high:10.3g} {_signed(entry.worst):>10s} {_signed(entry.bias):>10s}"
        over = f"{_over(entry):>20s}" if stated else ""
        yield f"  {entry.variable:25s} {numbers}{over}  {_place(entry.place)}{note}"


def _signed(value: float) -> str:
    """A difference with its sign, nothing as 0."""
    return f"{value:+.3g}" if value else "0"


def _over(entry: Difference) -> str:
    """Median of the difference over stated errors, and share of the points above one."""
    if not math.isfinite(entry.over_stated):
        return NONE_STATED
    return f"{entry.over_stated:.2g}, {entry.beyond_stated:.0%} > 1"


def _place(place: Mapping[str, str | float]) -> str:
    """Say where a point lies."""
    return f"{place['contact']}, {point_text(*(float(place[name]) for name, _ in AXES))}"
