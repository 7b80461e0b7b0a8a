"""Inner geometry of ball bearings of several rows that only a catalogue describes: estimated, and marked so.

Both ratings of a double row angular contact bearing, of ISO 76 and ISO 281, tell number and size of its balls: of all
in the table they agree on balls within 2 %, nearly all of them 32nds of an inch, as balls are made. The distance of its
pressure centres tells that of the rows.

A four-point contact bearing has two arcs on each raceway, and one row of balls. It is two rows here, at one place,
which carry either way: a ball in balance along the line through two of its contacts does not disturb the balance along
the other one, as long as contact angles hardly move. It has its mass where its contacts are, see the kernel. Its balls
are those of the deep groove bearing of the same section; the static rating, 5 f0 Z Dw^2 sin(alpha) by the pressure of
radial bearings, gives whole numbers of them within 0.3 to 130 mm.

Their clearance is axial. It takes no part of the radial distance of grooves, but shifts the rows.

References
----------
Dimensions, ratings, pressure centres: NSK, Rolling Bearings, catalogue E1102e (52, 53; QJ2, QJ3, QJ10). Axial
clearances C2 to C4: SKF, Rolling bearings (general catalogue, edition in Russian), tables of 32 A, 33 A, and QJ.
ISO 76, ISO 281.
"""

from __future__ import annotations

import math

from ehdmaps.errors import InputError
from ehdmaps.physics.designations.clearance import axial_range, refuse_affixes
from ehdmaps.physics.designations.families import not_known
from ehdmaps.physics.designations.reader import DOUBLE_ROW, FOUR_POINT, Designation, bore_code, table
from ehdmaps.physics.point.ball_catalogue import (
    INNER_CONFORMITY,
    OUTER_CONFORMITY,
    ball_diameter,
    ball_dynamic_rating,
    ball_estimate,
    rating_of_ball,
)
from ehdmaps.physics.point.ball_geometry import BallGeometry, BallRow

FOUR_POINT_ANGLE = 35.0
"""Contact angle of four-point contact bearings [deg]."""

DOUBLE_ANGLES = {"": 25.0, "B": 25.0, "A": 30.0}
"""Contact angles of double row bearings by their suffix [deg]: NSK's 52, 53, and B of Schaeffler; A of SKF."""

_ERRORS = (
    "contact angle to {} deg, pitch diameter to 2 %, ball diameter {} %, groove radii 0.515 to 0.53 of it (axial K "
    "10 %), number of balls +-1"
)
_MM = 1e-3


def row_estimate(designation: str, found: Designation) -> BallGeometry:
    """Inner geometry of a double row angular contact or a four-point contact ball bearing.

    Parameters
    ----------
    designation : str
        Designation as it was typed: 32, 33 (or 52, 53) with bores of 10 to 85 mm; QJ2, QJ3 (30 to 200 mm), QJ10.
    found : Designation
        Its parts.

    Raises
    ------
    InputError
        If there is no such bearing.

    Examples
    --------
    >>> from ehdmaps.physics.point.ball_catalogue import ball_estimate
    >>> bearing = ball_estimate("3208")
    >>> bearing.balls, round(1e3 * bearing.ball_diameter, 2), bearing.row_words[:27]
    (9, 11.95, '2 rows (+-) at -6.761 and 6')
    """
    refuse_affixes(designation, found)
    make = {DOUBLE_ROW: _double_row, FOUR_POINT: _four_point}[found.kind]
    bearing = make(found)
    if bearing is None:
        raise not_known(
            designation,
            "ball bearing",
            row_designations(),
            "32, 33 with bores of 10 to 85 and 15 to 70 mm, QJ2, QJ3 with 30 to 200 mm, QJ10 with 80 to 200 mm",
        )
    return bearing


def row_designations() -> tuple[str, ...]:
    """Designations that `row_estimate` knows."""
    rows = table("balls")
    return tuple(
        f"{prefix}{series}{bore_code(row[0])}"
        for prefix, tables in (("", rows["double_row"]), ("QJ", rows["four_point"]))
        for series, entries in tables.items()
        for row in entries
    )


def _entry(kind: str, series: str, code: str) -> list[float] | None:
    """Row of the table of a kind."""
    rows: list[list[float]] = table("balls")[kind].get(series, [])
    return next((row for row in rows if bore_code(row[0]) == code), None)


def _double_row(found: Designation) -> BallGeometry | None:
    """Two rows in O arrangement."""
    series, code, suffix = (part or "" for part in found.parts)
    row = _entry("double_row", series, code)
    if row is None:
        return None
    bore, outside, _, dynamic, static, apart = row
    pitch, rated = 0.5 * (bore + outside) * _MM, math.radians(DOUBLE_ANGLES[""])  # the catalogue's
    place = 0.5 * (apart * _MM - pitch * math.tan(rated))
    rows = BallRow(1.0, -place), BallRow(-1.0, place)
    best: tuple[float, BallGeometry] | None = None
    for balls in range(6, 20):
        try:
            diameter = ball_diameter(found.name, 0.5 * static / balls, pitch, rated, 0.5 * (outside - bore) * _MM)
        except InputError:
            continue
        one = BallGeometry(found.name, diameter, pitch, balls, INNER_CONFORMITY, OUTER_CONFORMITY, rated, rows=rows)
        doubt = abs(math.log(ball_dynamic_rating(one) / dynamic))
        if best is None or doubt < best[0]:
            best = doubt, one
    if best is None:
        return None
    words = "inner geometry estimated from catalogue dimensions and NSK's ratings (ISO 76, ISO 281): "
    angle = math.radians(DOUBLE_ANGLES[suffix])
    return (
        best[1].known({"contact_angle": angle}, words + _ERRORS.format(2, 4)).delivered(axial_range(found, bore * _MM))
    )


def _four_point(found: Designation) -> BallGeometry | None:
    """Two rows at one place."""
    _, series, code = found.parts
    row = _entry("four_point", series, code)
    if row is None:
        return None
    bore, outside, _, static = row
    pitch, angle = 0.5 * (bore + outside) * _MM, math.radians(FOUR_POINT_ANGLE)
    diameter = ball_estimate({"10": "60", "2": "62", "3": "63"}[series] + code).ball_diameter
    each = 5.0 * rating_of_ball(diameter, pitch, angle) * math.tan(angle)
    most = int(0.9 * math.pi * pitch / diameter)
    words = "inner geometry estimated from catalogue dimensions and NSK's static rating (ISO 76): "
    return BallGeometry(
        found.name,
        diameter,
        pitch,
        min(round(static / each), most),
        INNER_CONFORMITY,
        OUTER_CONFORMITY,
        angle,
        estimated=words + _ERRORS.format(2, 8),
        rows=(BallRow(1.0), BallRow(-1.0)),
    ).delivered(axial_range(found, bore * _MM))
