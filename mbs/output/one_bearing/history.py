"""Life of one bearing under operating points that take turns: a line a point, the sum of what each takes, the file.

Each point takes its part of the life, 1/L = sum of q/L with the shares q of the revolutions; with the factor a_ISO of
each, 1/L = sum of q/(a_ISO L).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ehdmaps.units import FILM, RPM
from mbs.life import CLEAN, CONTAMINATED, life_of_history
from mbs.output.one_bearing.kind import Description, Kind, Number, Row, row_of
from mbs.output.one_bearing.table import heading, life_factors, rating_words, unsound_lines, warning_lines
from mbs.scene.fields import FORCE

if TYPE_CHECKING:
    import xarray as xr

_HEADS = (
    ("point", "share", "load", "axial", "speed", "P_ref", "L10r", "kappa", "a_ISO", "film", "Lambda", "takes"),
    ("", "%", "N", "N", "rpm", "N", "1e6", "", "dirty/clean", "um", "", "%"),
)
_WIDTHS = (5, 7, 9, 9, 8, 9, 10, 6, 11, 7, 7, 6)


class _Lives(NamedTuple):
    """Lives under all points, in millions of revolutions: by the loads, with slight contamination, and filtered oil."""

    reference: float
    modified: tuple[float, float]
    parts: list[float]


def _lives(points: Sequence[Row], factors: Sequence[Sequence[float]], shares: Sequence[float]) -> _Lives:
    """Lives by the numbers of all points; NaN with a factor that ISO 281 does not have."""
    each = [row["reference_life"] for row in points]
    reference = life_of_history(shares, each)
    modified = []
    for place in (0, 1):
        lives = [a[place] * life for a, life in zip(factors, each, strict=True)]
        turning = [life for share, life in zip(shares, lives, strict=True) if share > 0.0]
        unknown = any(math.isnan(life) for life in turning)
        known = [1.0 if math.isnan(life) else life for life in lives]  # of points that do not turn
        modified.append(math.nan if unknown else life_of_history(shares, known))
    parts = [share / life * reference for share, life in zip(shares, each, strict=True)]
    return _Lives(reference, (modified[0], modified[1]), parts)


def history_lines(
    kind: Kind, description: Description, points: Sequence[Any], shares: Sequence[float], path: str
) -> list[str]:
    """Lines on the points of a history, and on the life under all of them.

    Parameters
    ----------
    kind : Kind
        Kind of the bearing.
    description : Description
        What the points have in common.
    points : sequence
        The points.
    shares : sequence of float
        Shares of the revolutions.
    path : str
        File of the history.
    """
    rows = [row_of(kind, description, point) for point in points]
    factors = [life_factors(kind.element, point, row) for point, row in zip(points, rows, strict=True)]
    lives = _lives(rows, factors, shares)
    lines = [
        *unsound_lines(points),
        *heading(kind, description, points[0]),
        f"history {path}, by shares of revolutions",
    ]
    lines += [_joined(words) for words in _HEADS]
    together = zip(points, rows, factors, shares, lives.parts, strict=True)
    lines += [_line(k, *one) for k, one in enumerate(together, 1)]
    speed = 1.0 / math.fsum(share / abs(p.inner_speed) for share, p in zip(shares, points, strict=True) if share > 0.0)
    hour = 2.0 * math.pi * 1e6 / 3600.0 / speed
    rating, power = points[0].ratings[0], 3.0 if kind.element == "ball" else 10.0 / 3.0
    mean = rating * lives.reference ** (-1.0 / power)
    worst = int(np.argmax(lives.parts))
    lines += [
        f"L10r of all {lives.reference:.4g} million turns, {hour * lives.reference:.4g} h at a mean of "
        f"{RPM.text(speed)}: 1/L = sum of share/L; equivalent load {FORCE.text(mean)} "
        f"{rating_words(kind.element, points[0])}",
        *_modified(lives, hour),
        f"point {worst + 1} takes {100.0 * lives.parts[worst]:.3g} % of it with {100.0 * shares[worst]:.3g} % of the "
        "turns",
    ]
    return lines + warning_lines(points)


def _modified(lives: _Lives, hour: float) -> list[str]:
    """A line on the life with oil and dirt."""
    dirty, clean = lives.modified
    if math.isnan(dirty):
        return ["with a_ISO: not known, as ISO 281 has none for a viscosity ratio below 0.1, or for no oil"]
    return [
        f"with a_ISO of each point {dirty:.4g} million turns ({hour * dirty:.4g} h) in slightly contaminated, "
        f"{clean:.4g} ({hour * clean:.4g} h) in filtered oil (e_C {CONTAMINATED:g}, {CLEAN:g})"
    ]


def _line(k: int, point: Any, row: Row, factors: Sequence[float], share: float, part: float) -> str:
    """A line of the table."""
    film, along = point.smallest_film, getattr(point, "axial", 0.0)
    words = (
        f"{k}",
        f"{100.0 * share:.4g}",
        f"{point.size:.5g}",
        f"{along:.5g}",
        f"{RPM.value(point.inner_speed):.5g}",
        f"{row['equivalent_load']:.4g}",
        f"{row['reference_life']:.4g}",
        _known(row["viscosity_ratio"], 2),
        "/".join(_known(factor, 2) for factor in factors),
        _known(FILM.value(film), 3),
        _known(row["film_parameter"], 3),
        f"{100.0 * part:.3g}",
    )
    return _joined(words) + " !" * bool(point.problems)


def _known(value: float, digits: int) -> str:
    """A number; a stroke where there is none."""
    return "-" if math.isnan(value) else f"{value:.{digits}g}"


def _joined(words: Sequence[str]) -> str:
    """A line of the table."""
    return " ".join(f"{word:>{width}s}" for word, width in zip(words, _WIDTHS, strict=True)).rstrip()


_SHARE = Number("share", "1", "share of the revolutions", lambda *_: math.nan)
_AXIAL = Number("axial", "N", "axial load on the inner ring", lambda p, _: getattr(p, "axial", 0.0))


def write_history(
    kind: Kind, description: Description, points: Sequence[Any], shares: Sequence[float], path: str
) -> str:
    """Write a row a point, and return what was written in words.

    Parameters
    ----------
    kind : Kind
        Kind of the bearing.
    description : Description
        What the points have in common.
    points : sequence
        The points.
    shares : sequence of float
        Shares of the revolutions.
    path : str
        The file.

    Raises
    ------
    InputError
        If it may not be replaced, or cannot be written.
    """
    from mbs.output.one_bearing.files import point_dataset, write_csv

    datasets: list[xr.Dataset] = []
    for point, share in zip(points, shares, strict=True):
        found = point_dataset(kind, description, [[point]])
        for number, value in ((_SHARE, share), (_AXIAL, getattr(point, "axial", 0.0))):
            found[number.name] = (("load", "speed"), [[value]], {"units": number.unit, "long_name": number.words})
        datasets.append(found)
    write_csv(kind, (_SHARE, _AXIAL, *kind.numbers_of(description)), datasets, path)
    return f"{path}: written"
