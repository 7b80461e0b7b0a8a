"""Needle roller bearings that only a catalogue describes: estimated, and marked so.

Three kinds have a designation that tells dimensions:

- cages K (K40x48x20): the raceways of shaft and housing, and so the diameter of the needles, are in the designation;
- machined rings of series 49: NA with, RNA without inner ring, whose raceway is that of a cage of needles. Their
  diameter comes from both ratings, see `ehdmaps.physics.rollers.ratings`. NAV and RNAV have the same needles without a
  cage, as many as go in: full complement;
- drawn cups HK (HK2020): the shaft and the width. The cup is taken as rigid, as a housing holds it; it yields more than
  a ring.

The static rating gives Z L D as a whole; how it divides into number and length is an estimate, with `FILLED` of the
pitch circle, and hardly matters for stiffness.

The factor b_m of this maker's needle bearings is that of its cages, whose needles are known: 1.038, with a scatter of
1 % over 119 cages. By it the needles of series 49 come out within 0.25 mm of half millimetres, to which they are
rounded.

References
----------
Dimensions and ratings: SKF, Rolling bearings (general catalogue, 2018). Raceways of series 49: ISO 1206. Drawn cups:
NTN, Needle roller bearings.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from ehdmaps.errors import InputError
from ehdmaps.physics.bearing import BearingGeometry
from ehdmaps.physics.designations.clearance import delivered
from ehdmaps.physics.designations.families import not_known
from ehdmaps.physics.designations.reader import NEEDLES, bore_code, plain_name, table
from ehdmaps.physics.rollers.ratings import by_ratings, with_static_rating

FILLED, FULL = 0.75, 0.995
"""Share of the pitch circle that needles in a cage take, and at most without one."""

QUALITY = 1.038
"""Factor b_m of ISO 281 in the ratings of needle cages whose needles are known."""

DRAWN_QUALITY = 1.1
"""The same of drawn cups: needles of all in the table are then of whole or half millimetres within 3 %."""

ERRORS = "raceways to about 1 %, roller diameter {} %, roller length 15 %, number of rollers +-{}"

_MM = 1e-3

_CAGES, _MACHINED, _DRAWN = (table("needles")[name] for name in ("cages", "machined", "drawn"))


class NeedleBoundary(NamedTuple):
    """Boundary dimensions [m]: bore of the inner ring, outside diameter, width; raceways where there is no ring."""

    bore: float
    outside_diameter: float
    width: float


def needle_estimate(designation: str, basic_static_rating: float | None = None) -> BearingGeometry:
    """Inner geometry of a needle roller bearing by its designation.

    Parameters
    ----------
    designation : str
        NA, RNA, NAV, RNAV of series 49 with bores of 10 to 100 mm; drawn cups HK for shafts of 4 to 50 mm; K with
        raceways and width in mm.
    basic_static_rating : float, optional
        C0 [N] of the bearing's own catalogue; else that of the table.

    Raises
    ------
    InputError
        If there is no such bearing, or no length of needles fits the rating.

    Examples
    --------
    >>> bearing = needle_estimate("NA4908")
    >>> bearing.rollers, round(1e3 * bearing.roller_diameter, 2), round(1e3 * bearing.roller_length, 2)
    (25, 5.0, 14.25)
    """
    name = plain_name(designation, NEEDLES)
    found = _cage(name) or _drawn(name) or _rings(name)
    if found is None:
        raise not_known(
            designation,
            "needle bearing",
            needle_designations(),
            "NA, RNA, NAV, RNAV of series 49 with bores of 10 to 100 mm, such as 'NA4908'; drawn cups such as 'HK2020'"
            "; cages such as 'K40x48x20'; give others by their dimensions",
        )
    inner, diameter, width, rating = found
    pitch, own = inner + diameter, basic_static_rating is not None
    most = int(math.pi / math.asin(diameter / pitch))
    count = round(FILLED * math.pi * pitch / diameter)
    rating = rating if basic_static_rating is None else basic_static_rating
    if not (isinstance(rating, int | float) and math.isfinite(rating) and rating > 0.0):
        raise InputError(f"bearing estimate: got basic_static_rating {rating!r:.60} N; allowed: finite and > 0")
    length = with_static_rating(diameter, count, pitch, rating).length
    if not 0.25 * width < length < 0.95 * width:
        raise InputError(
            f"bearing estimate: got basic_static_rating {rating!r} N, which takes needles of {length / _MM:.4g} mm in "
            f"a width of {width / _MM:g} mm; allowed: 0.25 to 0.95 of the width; check its unit, C0 and not C"
        )
    full = "V" in name
    if full:
        count = min(most, int(FULL * math.pi * pitch / diameter))
    whose = "own" if own else "NTN's" if name[0] == "H" else "SKF's"
    basis = f"catalogue dimensions and {whose} static rating (ISO 76)" + (", full complement" if full else "")
    errors = ERRORS.format(1 if name[0] == "K" else 4, 1 if full else 4)
    return BearingGeometry(
        name,
        inner,
        inner + 2.0 * diameter,
        diameter,
        length,
        count,
        0.0,
        estimated=f"inner geometry estimated from {basis}: {errors}",
    ).delivered(delivered(designation, _bore(name), inner))


def _bore(name: str) -> float | None:
    """Bore of the inner ring [m]; None where there is none."""
    boundary = None if name[0] in "KRH" else needle_boundary(name)
    return None if boundary is None else boundary.bore


def needle_boundary(designation: str) -> NeedleBoundary | None:
    """Boundary dimensions of a bearing of series 49; None for others: cages run on shaft and housing.

    Parameters
    ----------
    designation : str
        Such as "NA4908".

    Examples
    --------
    >>> needle_boundary("NA4908"), needle_boundary("K40x48x20")
    (NeedleBoundary(bore=0.04, outside_diameter=0.062, width=0.022), None)
    """
    name = plain_name(designation, NEEDLES)
    row = _row(name) if name and name[0] not in "KH" else None
    if row is None:
        return None
    return NeedleBoundary((row[1] if name[0] == "R" else row[0]) * _MM, row[2] * _MM, row[3] * _MM)


def needle_designations() -> tuple[str, ...]:
    """Designations that `needle_estimate` knows, machined rings written with NA."""
    return (
        *(f"NA49{bore_code(row[0])}" for row in _MACHINED),
        *(f"HK{row[0]:02d}{row[1]:02d}" for row in _DRAWN),
        *(f"K{inner}x{outer}x{width}" for inner, outer, width, _ in _CAGES),
    )


def _row(name: str) -> tuple[int, ...] | None:
    """Row of the table of machined rings."""
    return next((row for row in _MACHINED if name[-2:] == bore_code(row[0])), None)


def _cage(name: str) -> tuple[float, float, float, float] | None:
    """Inner raceway, needle diameter, width [m], C0 [N] of a cage."""
    for inner, outer, width, rating in _CAGES:
        if name == f"K{inner}x{outer}x{width}":
            return inner * _MM, 0.5 * (outer - inner) * _MM, width * _MM, float(rating)
    return None


def _drawn(name: str) -> tuple[float, float, float, float] | None:
    """The same of a drawn cup."""
    for within, width, _, dynamic, static in _DRAWN:
        if name == f"HK{within:02d}{width:02d}":
            diameter = needle_diameter(within * _MM, (dynamic, static), DRAWN_QUALITY)
            return within * _MM, round(2.0 * diameter / _MM) * 0.5 * _MM, width * _MM, float(static)
    return None


def _rings(name: str) -> tuple[float, float, float, float] | None:
    """The same of machined rings."""
    row = _row(name) if name and name[0] not in "KH" else None
    if row is None:
        return None
    _, raceway, _, width, dynamic, static = row
    diameter = needle_diameter(raceway * _MM, (float(dynamic), float(static)))
    return raceway * _MM, round(2.0 * diameter / _MM) * 0.5 * _MM, width * _MM, float(static)


def needle_diameter(inner_raceway: float, ratings: tuple[float, float], quality: float = QUALITY) -> float:
    """Diameter of needles by the raceway of the inner ring [m] and C and C0 [N], before it is rounded.

    Parameters
    ----------
    inner_raceway : float
        F_w [m].
    ratings : (float, float)
        C and C0 [N].
    quality : float
        Factor b_m of ISO 281 in them.
    """
    diameter = 0.1 * inner_raceway
    for _ in range(30):  # the pitch diameter knows the needles
        diameter = by_ratings(inner_raceway + diameter, ratings, FILLED, quality=quality).diameter
    return diameter
