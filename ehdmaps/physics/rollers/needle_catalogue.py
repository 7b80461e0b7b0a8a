"""Needle roller bearings that only a catalogue describes: estimated, and marked so.

Two kinds have a designation that tells dimensions:

- cages K (K40x48x20): the raceways of shaft and housing, and so the diameter of the needles, are in the designation;
- machined rings of series 49: NA with, RNA without inner ring, whose raceway is that of a cage of needles. Their
  diameter comes from both ratings, see `ehdmaps.physics.rollers.ratings`. NAV and RNAV have the same needles without a
  cage, as many as go in: full complement.

The static rating gives Z L D as a whole; how it divides into number and length is an estimate, with `FILLED` of the
pitch circle, and hardly matters for stiffness.

The factor b_m of this maker's needle bearings is that of its cages, whose needles are known: 1.038, with a scatter of
1 % over 119 cages. By it the needles of series 49 come out within 0.25 mm of half millimetres, to which they are
rounded.

References
----------
Dimensions and ratings: SKF, Rolling bearings (general catalogue, 2018). Raceways of series 49: ISO 1206.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from ehdmaps.errors import InputError, closest, short
from ehdmaps.physics.bearing import BearingGeometry
from ehdmaps.physics.designations.clearance import delivered
from ehdmaps.physics.designations.families import not_served
from ehdmaps.physics.designations.reader import NEEDLES, plain_name
from ehdmaps.physics.rollers.ratings import by_ratings, with_static_rating

FILLED, FULL = 0.75, 0.995
"""Share of the pitch circle that needles in a cage take, and at most without one."""

QUALITY = 1.038
"""Factor b_m of ISO 281 in the ratings of needle cages whose needles are known."""

ERRORS = "raceways to about 1 %, roller diameter {} %, roller length 15 %, number of rollers +-{}"

_MM = 1e-3

# raceways of shaft and housing, width [mm], C0 [N]
_CAGES = (
    (10, 13, 10, 5700), (10, 13, 13, 8000), (10, 14, 10, 6100), (10, 14, 13, 8500), (10, 16, 12, 7200),
    (12, 15, 10, 6200), (12, 15, 13, 8650), (12, 16, 13, 9500), (12, 17, 13, 10400), (12, 18, 12, 10000),
    (14, 18, 10, 8650), (14, 18, 13, 10200), (14, 18, 15, 12500), (14, 18, 17, 14600), (15, 19, 13, 11200),
    (15, 19, 17, 15600), (15, 21, 15, 16300), (15, 21, 21, 24500), (16, 20, 10, 10000), (16, 20, 13, 12000),
    (16, 20, 17, 17000), (16, 22, 12, 12500), (16, 22, 16, 17600), (16, 22, 20, 22800), (16, 24, 20, 23600),
    (17, 21, 10, 10800), (18, 24, 12, 15000), (19, 23, 13, 13700), (20, 24, 10, 12900), (20, 24, 13, 14600),
    (20, 24, 17, 20800), (20, 26, 17, 26000), (20, 26, 20, 29000), (20, 28, 20, 28500), (20, 28, 25, 39000),
    (20, 30, 30, 41500), (21, 25, 13, 15300), (22, 26, 10, 13700), (22, 26, 13, 16300), (22, 26, 17, 22800),
    (22, 28, 17, 27000), (22, 29, 16, 25500), (22, 30, 15, 23600), (23, 35, 16, 23200), (24, 28, 10, 15000),
    (24, 28, 13, 18000), (24, 30, 17, 27500), (25, 29, 10, 15600), (25, 29, 13, 18600), (25, 30, 17, 30500),
    (25, 30, 20, 36500), (25, 32, 16, 27500), (25, 33, 20, 38000), (25, 35, 30, 62000), (26, 30, 13, 19600),
    (28, 33, 13, 24500), (28, 33, 17, 33500), (30, 35, 13, 25500), (30, 35, 17, 34000), (30, 35, 27, 60000),
    (30, 37, 18, 39000), (30, 40, 30, 69500), (32, 37, 13, 25500), (32, 37, 17, 35500), (32, 38, 20, 45000),
    (32, 40, 25, 58500), (35, 40, 13, 28000), (35, 40, 17, 39000), (35, 40, 27, 49000), (35, 42, 16, 37500),
    (35, 42, 18, 44000), (35, 45, 20, 50000), (37, 42, 17, 43000), (38, 43, 17, 39000), (38, 46, 32, 100000),
    (40, 45, 17, 41500), (40, 45, 27, 73500), (40, 48, 20, 58500), (42, 47, 17, 43000), (42, 50, 20, 57000),
    (43, 48, 17, 43000), (45, 50, 17, 46500), (45, 50, 27, 81500), (45, 53, 28, 98000), (47, 52, 17, 49000),
    (50, 55, 20, 60000), (50, 55, 30, 98000), (50, 57, 18, 64000), (50, 58, 25, 81500), (55, 60, 20, 67000),
    (55, 60, 30, 108000), (55, 62, 18, 71000), (55, 63, 32, 129000), (60, 65, 20, 72000), (60, 68, 25, 112000),
    (65, 73, 30, 125000), (70, 76, 20, 86500), (70, 78, 30, 137000), (75, 83, 23, 110000), (80, 88, 30, 176000),
    (85, 92, 20, 108000), (90, 97, 20, 114000), (90, 98, 30, 173000), (95, 103, 30, 180000), (100, 108, 27, 143000),
)  # fmt: skip
# bore, inner raceway, outside diameter, width [mm], C and C0 [N]; bore 0.1 of 00 to 03
_MACHINED = (
    (10, 14, 22, 13, 8800, 10400), (12, 16, 24, 13, 9900, 12200), (15, 20, 28, 13, 11200, 15300),
    (17, 22, 30, 13, 11400, 16300), (20, 25, 37, 17, 21600, 28000), (25, 30, 42, 17, 24200, 34500),
    (30, 35, 47, 17, 25500, 39000), (35, 42, 55, 20, 31900, 54000), (40, 48, 62, 22, 42900, 71000),
    (45, 52, 68, 22, 45700, 78000), (50, 58, 72, 22, 47300, 85000), (55, 63, 80, 25, 57200, 106000),
    (60, 68, 85, 25, 60500, 114000), (65, 72, 90, 25, 61600, 120000), (70, 80, 100, 30, 84200, 163000),
    (75, 85, 105, 30, 84200, 170000), (80, 90, 110, 30, 88000, 183000), (85, 100, 120, 35, 108000, 250000),
    (90, 105, 125, 35, 112000, 265000), (95, 110, 130, 35, 114000, 270000), (100, 115, 140, 40, 125000, 280000),
)  # fmt: skip


class NeedleBoundary(NamedTuple):
    """Boundary dimensions [m]: bore of the inner ring, outside diameter, width; raceways where there is no ring."""

    bore: float
    outside_diameter: float
    width: float


def plain_needle_designation(designation: str) -> str:
    """Designation without blanks and suffixes, such as "NA4908" or "K40x48x20"; empty where it is none.

    Parameters
    ----------
    designation : str
        Designation as it was typed.

    Examples
    --------
    >>> plain_needle_designation("na 4908-XL"), plain_needle_designation("K 40x48x20")
    ('NA4908', 'K40x48x20')
    """
    return plain_name(designation, NEEDLES)


def needle_estimate(designation: str, basic_static_rating: float | None = None) -> BearingGeometry:
    """Inner geometry of a needle roller bearing by its designation.

    Parameters
    ----------
    designation : str
        NA, RNA, NAV, RNAV of series 49 with bores of 10 to 100 mm; K with raceways and width in mm.
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
    name = plain_needle_designation(designation)
    found = _cage(name) or _rings(name)
    if found is None:
        if words := not_served(designation):
            raise InputError(f"bearing designation: {words}")
        raise InputError(
            f"needle bearing designation: got {short(designation)}{closest(designation.upper(), needle_designations())}"
            "; allowed: NA, RNA, NAV, RNAV of series 49 with bores of 10 to 100 mm, such as 'NA4908'; cages such as "
            "'K40x48x20'; give others by their dimensions"
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
    whose = "own" if own else "SKF's"
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
    ).delivered(delivered(designation, _bore(name)))


def _bore(name: str) -> float | None:
    """Bore of the inner ring [m]; None where there is none."""
    boundary = None if name[0] in "KR" else needle_boundary(name)
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
    name = plain_needle_designation(designation)
    row = _row(name) if name and name[0] != "K" else None
    if row is None:
        return None
    return NeedleBoundary((row[1] if name[0] == "R" else row[0]) * _MM, row[2] * _MM, row[3] * _MM)


def needle_designations() -> tuple[str, ...]:
    """Designations that `needle_estimate` knows, machined rings written with NA."""
    return (
        *(f"NA49{_code(row[0])}" for row in _MACHINED),
        *(f"K{inner}x{outer}x{width}" for inner, outer, width, _ in _CAGES),
    )


def _code(bore: int) -> str:
    """Bore code of a bore [mm]."""
    return {10: "00", 12: "01", 15: "02", 17: "03"}.get(bore, f"{bore // 5:02d}")


def _row(name: str) -> tuple[int, ...] | None:
    """Row of the table of machined rings."""
    return next((row for row in _MACHINED if name[-2:] == _code(row[0])), None)


def _cage(name: str) -> tuple[float, float, float, float] | None:
    """Inner raceway, needle diameter, width [m], C0 [N] of a cage."""
    for inner, outer, width, rating in _CAGES:
        if name == f"K{inner}x{outer}x{width}":
            return inner * _MM, 0.5 * (outer - inner) * _MM, width * _MM, float(rating)
    return None


def _rings(name: str) -> tuple[float, float, float, float] | None:
    """The same of machined rings."""
    row = _row(name) if name and name[0] != "K" else None
    if row is None:
        return None
    _, raceway, _, width, dynamic, static = row
    diameter = needle_diameter(raceway * _MM, (float(dynamic), float(static)))
    return raceway * _MM, round(2.0 * diameter / _MM) * 0.5 * _MM, width * _MM, float(static)


def needle_diameter(inner_raceway: float, ratings: tuple[float, float]) -> float:
    """Diameter of needles by the raceway of the inner ring [m] and C and C0 [N], before it is rounded.

    Parameters
    ----------
    inner_raceway : float
        F_w [m].
    ratings : (float, float)
        C and C0 [N].
    """
    diameter = 0.1 * inner_raceway
    for _ in range(30):  # the pitch diameter knows the needles
        diameter = by_ratings(inner_raceway + diameter, ratings, FILLED, quality=QUALITY).diameter
    return diameter
