"""Inner geometry of ball bearings that only a catalogue describes: estimated, and marked so.

Catalogues give boundary dimensions and the static rating of ISO 76, C0 = f0 Z Dw^2 cos(alpha) [N, mm], whose factor f0
knows Dw cos(alpha)/d_m. From them:

- pitch diameter d_m = (d + D)/2;
- deep groove: each Z has one Dw by the rating. The catalogue's own f0 and the arc through which balls are put in
  between the eccentric rings, (Z - 1) 2 asin(Dw/d_m) near `FILLING_ARC`, tell which Z it is;
- angular contact: balls as large as in the deep groove bearing of the same section (60, 62, 63), Z from the rating,
  then Dw from the rating once more;
- groove radii `INNER_CONFORMITY` and `OUTER_CONFORMITY` of the ball diameter; `THIN_CONFORMITIES` of 718, 719.

Makers differ, in balls and in ratings; an own rating scales the balls of the table.

References
----------
ISO 15 and ISO 12044: boundary dimensions. ISO 76: static ratings, factors f0 (table 1). Dimensions, ratings
and f0 of the series 60, 62, 63, ratings of 70 C, 72 C, 72 B, 73 B, and the constant K of axial clearance, from which
the sum of the groove radii comes: NSK, Rolling Bearings, catalogue E1102e; there, too, 618, 619 and 160. Ratings of
719, and of 70, 72 C above 100 mm: NSK, Super Precision Bearings; of 718: NTN, Ball and Roller Bearings, 2202-E. Series
64: SKF, Rolling bearings (general catalogue). 72 C of 160 to 200 mm, 70, 72 of 220 and 240 mm: Koyo, Ball and Roller
Bearings, B2001RUS, half of its sets of two; 7244B: SKF. It has no C of 220 and 240 mm: the rating at 30 or 40 degrees
times that of 7040C over 7040, of 7240C over 7240B.
"""

from __future__ import annotations

import dataclasses
import math
from typing import NamedTuple

from ehdmaps.errors import InputError
from ehdmaps.physics.designations.clearance import delivered
from ehdmaps.physics.designations.families import not_known
from ehdmaps.physics.designations.reader import BALLS, HC, OF_ROWS, bore_code, plain_name, read_designation, table
from ehdmaps.physics.point.ball_geometry import BallGeometry
from ehdmaps.physics.point.ball_ratings import (
    FACTORS,
    INNER_CONFORMITY,
    OUTER_CONFORMITY,
    ball_diameter,
    rating_of_ball,
    static_factor,
)
from ehdmaps.physics.solids import SILICON_NITRIDE

MOST_FILLED = 0.93
"""Most of the pitch circle that balls of angular contact bearings take, Z Dw/(pi d_m): the rest is cage."""

FILLING_ARC = math.radians(189.0)
"""Arc that the balls of a deep groove bearing take while they are put in [rad]; most have 183 to 198 degrees."""

_FACTOR_ERROR, _ARC_ERROR = 0.1, math.radians(8.0)
"""By how much factor and arc tell the number of balls: a digit of the one, what bearings scatter of the other [rad]."""

ANGLES = {"C": 15.0, "AC": 25.0, "B": 40.0}
"""Contact angle by its suffix [deg]."""

ERRORS = (
    "pitch diameter to {} %, ball diameter {} %, groove radii 0.515 to 0.53 of it (radial K {} %, axial and tilt K "
    "{} %, of held rings {} %), number of balls +-{}"
)
"""What an estimate is good for: measured on bearings whose inner geometry is known, see the tests."""

THIN, THIN_CONFORMITIES = ("718", "719"), (0.52, 0.53)
"""Angular contact bearings of thin section, and their grooves: those with which ISO 281 rates. Makers' pairs of 719 are
softer than tighter ones would make them, by 8 % with GMN's own balls, and 11 % (NSK)."""

THIN_ERRORS = (
    "pitch diameter to 2 %, ball diameter 10 %, groove radii 0.515 to 0.55 of it (K 10 % up, 20 % down), number of "
    "balls +-3"
)
"""The same of angular contact bearings of thin section."""

GROOVES, ANGULAR_GROOVES = (5, 22, 50), (5, 10, 15)
"""Change of K by an outer groove of 0.53 of the ball, of deep groove and of angular contact bearings [%]: radial; axial
and against tilt; axial of rings that are held. K is smaller."""

_MM = 1e-3


class BallCatalogue(NamedTuple):
    """Entry of a catalogue: lengths [m], C0 [N], f0 of ISO 76; None where the table has none."""

    bore: float
    outside_diameter: float
    width: float
    basic_static_rating: float | None
    factor: float | None


def ball_estimate(designation: str, basic_static_rating: float | None = None) -> BallGeometry:
    """Inner geometry of a ball bearing by its designation.

    Parameters
    ----------
    designation : str
        Deep groove of series 618, 619, 160, 60, 62, 63 (bores to 300 mm; 68, 69 are 618, 619), 64 (20 to 90 mm);
        angular contact of series 718, 719, 70, 72, 73 with the suffix C (15 degrees), AC (25) or B (40), such as
        "7208B". Blanks and suffixes of seals, cages and accuracy do not matter.
    basic_static_rating : float, optional
        C0 [N] of the bearing's own catalogue; else that of the table.

    Returns
    -------
    BallGeometry
        The bearing with `estimated` set, and a clearance by its class, see `ehdmaps.physics.designations.clearance`;
        angular contact bearings have none.

    Raises
    ------
    InputError
        If there is no such bearing, or no balls fit the rating.

    Examples
    --------
    >>> bearing = ball_estimate("6208-2RS C3")
    >>> bearing.balls, round(1e3 * bearing.ball_diameter, 2), round(1e3 * bearing.pitch_diameter, 1)
    (9, 11.91, 60.0)
    """
    parts = read_designation(designation)
    if parts is not None and (parts.kind in OF_ROWS or parts.matched):
        from ehdmaps.physics.point.row_catalogue import row_estimate  # with what few bearings need

        bearing = row_estimate(designation, parts, ball_estimate, _width)
        material = SILICON_NITRIDE if parts.hybrid else None
        return dataclasses.replace(bearing, ball_material=material).typed(designation)
    series, code, suffix = _parts(designation)
    entry = _entry(series, code, suffix)
    if entry is None:
        raise not_known(
            designation,
            "ball bearing",
            ball_designations(),
            "618, 619, 160, 60, 62 with bores of 10 to 300 mm, 63 to 280 mm, 64 with 20 to 90 mm, such as '6208'; 718 "
            "with 25 to 170 mm, 719 to 280 mm, 70, 72 to 240 mm, 73 to 200 mm with the suffix C, AC or B for the "
            "contact angle, such as '7208B'",
        )
    name = plain_name(designation, BALLS)
    pitch = 0.5 * (entry.bore + entry.outside_diameter)
    own = basic_static_rating is not None
    rating = entry.basic_static_rating if basic_static_rating is None else basic_static_rating
    if own and not (isinstance(rating, int | float) and math.isfinite(rating) and rating > 0.0):
        raise InputError(f"ball bearing estimate: got basic_static_rating {rating!r:.60} N; allowed: finite and > 0")
    angle = math.radians(ANGLES[suffix]) if suffix else 0.0
    section = 0.5 * (entry.outside_diameter - entry.bore)
    if not suffix:
        balls, diameter = _filled(name, float(entry.basic_static_rating or 0.0), entry.factor, pitch, section)
        if own:
            diameter = ball_diameter(name, float(rating or 0.0) / balls, pitch, 0.0, section)
    else:
        deep = ball_estimate("6" + series[1:] + code)
        if rating is None:  # as many balls as the next angle has
            near = ball_estimate(series + code + _OTHER[suffix][series])
            balls, diameter = near.balls, near.ball_diameter
        else:
            each = rating_of_ball(deep.ball_diameter, pitch, angle)
            balls = max(round(rating / each), 3) + 1
            diameter = math.inf
            while balls * diameter > MOST_FILLED * math.pi * pitch:  # fewer, larger ones, which leave room for a cage
                balls -= 1
                diameter = ball_diameter(name, rating / balls, pitch, angle, section)
    whose = "own" if own else {"64": "SKF's", "718": "NTN's"}.get(series, "NSK's")
    if (
        not own
        and suffix
        and series in ("70", "72")
        and entry.bore > (0.15 if series == "72" and suffix != "B" else 0.2)
    ):
        whose = "Koyo's or SKF's"
    basis = f"inner geometry estimated from catalogue dimensions and {whose} static rating (ISO 76): "
    thin = series in THIN
    errors = THIN_ERRORS if thin else ERRORS.format(2, 8, *(ANGULAR_GROOVES if suffix else GROOVES), 2 if suffix else 1)
    bearing = BallGeometry(
        name,
        diameter,
        pitch,
        balls,
        *(THIN_CONFORMITIES if thin else (INNER_CONFORMITY, OUTER_CONFORMITY)),
        angle,
        0.0,
        estimated=basis + errors,
        ball_material=SILICON_NITRIDE if HC in name else None,
    )
    return bearing.delivered(delivered(designation, entry.bore)).typed(designation)


def ball_boundary(designation: str) -> BallCatalogue | None:
    """Boundary dimensions and rating of a ball bearing by its designation; None where it is not in the table.

    Parameters
    ----------
    designation : str
        Such as "6208".

    Examples
    --------
    >>> ball_boundary("6208").outside_diameter
    0.08
    """
    return _entry(*_parts(designation))


def _width(designation: str) -> float:
    """Width of a bearing of one row by its designation [m]."""
    entry = ball_boundary(designation)
    assert entry is not None  # there is an estimate of it
    return entry.width


def ball_designations() -> tuple[str, ...]:
    """Designations that `ball_estimate` knows."""
    deep = [f"{series}{bore_code(row[0])}" for series, rows in _DEEP.items() for row in rows]
    angular = [
        f"{series}{bore_code(row[0])}{suffix}"
        for series, tables in _ANGULAR.items()
        for suffix in ANGLES
        for row in tables.get(_OTHER.get(suffix, {}).get(series, suffix), ())
    ]
    return (*deep, *angular)


_DEEP: dict[str, list[list[float]]] = table("balls")["deep"]
_ANGULAR: dict[str, dict[str, list[list[float]]]] = table("balls")["angular"]
_OTHER = {"AC": {"718": "C", "719": "C", "70": "C", "72": "C", "73": "B"}, "B": {"70": "C"}}
"""Suffixes whose balls those of another angle have, by series: catalogues have their ratings by the same balls."""


def _parts(designation: str) -> tuple[str, str, str]:
    """Series, bore code and suffix of the contact angle; empty where it is no designation of a ball bearing."""
    found = read_designation(designation)
    if found is None or found.kind not in BALLS or found.kind in OF_ROWS:
        return "", "", ""
    series, code, *suffix = found.parts
    return series, code, "".join(suffix)


def _row(rows: list[list[float]], code: str) -> list[float] | None:
    """Row of a bore."""
    return next((row for row in rows if bore_code(row[0]) == code), None)


def _entry(series: str, code: str, suffix: str) -> BallCatalogue | None:
    """The entry of the table; None where there is none."""
    row = _row(_DEEP.get(f"6{series[1:]}" if suffix else series, []), code)
    if row is None:
        return None
    rating, factor = row[3], row[4] if len(row) > 4 else None
    if suffix:
        other = _OTHER.get(suffix, {}).get(series)
        found = _row(_ANGULAR.get(series, {}).get(other or suffix, []), code)
        if found is None:
            return None
        rating, factor = math.nan if other else found[1], None
    lengths = (row[0] * _MM, row[1] * _MM, row[2] * _MM)
    return BallCatalogue(*lengths, None if math.isnan(rating) else float(rating), factor)


def _filled(name: str, rating: float, factor: float | None, pitch: float, section: float) -> tuple[int, float]:
    """Number and diameter of the balls of a deep groove bearing."""
    found: list[tuple[float, int, float]] = []
    thin = factor is not None and factor > max(FACTORS)  # rated by the inner contact alone
    least, most = (rating_of_ball(part * section, pitch, 0.0, of_inner=thin) for part in (0.2, 0.95))
    for balls in range(5, 40):
        if least < rating / balls < most:
            diameter = ball_diameter(name, rating / balls, pitch, 0.0, section, of_inner=thin)
            arc = (balls - 1) * 2.0 * math.asin(diameter / pitch)
            doubt = ((arc - FILLING_ARC) / _ARC_ERROR) ** 2
            if factor is not None:
                doubt += ((static_factor(diameter / pitch, of_inner=thin) - factor) / _FACTOR_ERROR) ** 2
            found.append((doubt, balls, diameter))
    return min(found)[1:]
