"""Inner geometry of ball bearings of several rows that only a catalogue describes: estimated, and marked so.

Both ratings of a double row angular contact bearing, of ISO 76 and ISO 281, tell number and size of its balls: of all
in the table they agree on balls within 2 %, nearly all of them 32nds of an inch, as balls are made. The distance of its
pressure centres tells that of the rows.

A four-point contact bearing has two arcs on each raceway, and one row of balls. It is two rows here, at one place,
which carry either way: a ball in balance along the line through two of its contacts does not disturb the balance along
the other one, as long as contact angles hardly move. It has its mass where its contacts are, see the kernel. Its balls
are those of the deep groove bearing of the same section; the static rating, 5 f0 Z Dw^2 sin(alpha) by the pressure of
radial bearings, gives whole numbers of them within 0.3 to 130 mm.

Self-aligning bearings have two rows on one sphere about the middle of the bearing: tilts of the inner ring turn it with
its balls, and nothing presses more. Their contact angle is that of the factor e = 1.5 tan(alpha). Both ratings
tell their balls, the static one by 4600 MPa. ISO 281 reduces the dynamic one by a factor that is taken as that of other
bearings, 0.95: with 0.90 and 1.0 they would have a tenth fewer and more, at equal Z Dw^2.

Both ratings of a single direction thrust bearing tell its balls, of 37 bearings their number too: 35 of these have
balls of a whole number of 32nds of an inch within 0.4 %. Of the others two or three numbers are within the digits of C;
balls as they are made decide.

The clearance of the others is axial. It takes no part of the radial distance of grooves, but shifts the rows.

References
----------
Dimensions, ratings, pressure centres: NSK, Rolling Bearings, catalogue E1102e (52, 53; QJ2, QJ3, QJ10; 511 to 514).
Axial clearances C2 to C4: SKF, Rolling bearings (general catalogue, edition in Russian), tables of 32 A, 33 A, QJ, and
of self-aligning bearings. ISO 76, ISO 281.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable

from scipy.optimize import brentq

from ehdmaps.errors import InputError, short
from ehdmaps.physics.designations.affixes import PAIR
from ehdmaps.physics.designations.clearance import delivered, own_range, refuse_affixes
from ehdmaps.physics.designations.families import not_known
from ehdmaps.physics.designations.reader import DOUBLE_ROW, FOUR_POINT, THRUST, Designation, bore_code, table
from ehdmaps.physics.point.ball_geometry import LARGEST_ANGLE, BallGeometry, BallRow
from ehdmaps.physics.point.ball_ratings import (
    INNER_CONFORMITY,
    OUTER_CONFORMITY,
    THRUST_FACTOR,
    ball_diameter,
    ball_dynamic_rating,
    rating_of_ball,
)
from ehdmaps.physics.solids import STEEL, Material

FOUR_POINT_ANGLE = 35.0
"""Contact angle of four-point contact bearings [deg]."""

SETS = {
    "DB": (1, -1), "DF": (-1, 1), "DT": (1, 1), "TBT": (1, 1, -1), "TFT": (-1, -1, 1), "TT": (1, 1, 1),
    "QBC": (1, 1, -1, -1), "QFC": (-1, -1, 1, 1), "QBT": (1, 1, 1, -1), "QFT": (-1, -1, -1, 1), "QT": (1, 1, 1, 1),
}  # fmt: skip
"""Ways of the bearings of a set, from -x to +x."""

PRELOADS = ("EL", "L", "M", "H")
"""Classes of preload of NSK."""

DOUBLE_ANGLES = {"": 25.0, "B": 25.0, "A": 30.0}
"""Contact angles of double row bearings by their suffix [deg]: NSK's 52, 53, and B of Schaeffler; A of SKF."""

SPHERE_CONFORMITY, SPHERE_PRESSURE = 0.53, 4.6e9
"""Inner groove radius over the ball diameter with which ISO 76 rates self-aligning bearings, and its pressure [Pa]."""

_SPHERE_ERRORS = (
    "contact angle to 0.5 deg, pitch diameter to 2 %, ball diameter 10 %, inner groove radius 0.52 to 0.55 of it, "
    "number of balls +-3"
)

THRUST_CONFORMITY = 0.54
"""Groove radius over ball diameter with which ISO 76 and ISO 281 rate thrust ball bearings."""

_THRUST_ERRORS = "pitch diameter to 2 %, ball diameter 4 %, groove radii 0.52 to 0.56 of it, number of balls +-1"

_ERRORS = (
    "contact angle to {} deg, pitch diameter to 2 %, ball diameter {} %, groove radii 0.515 to 0.53 of it (axial K "
    "10 %), number of balls +-1"
)
_MM, _INCH_PART = 1e-3, 25.4e-3 / 32.0
_RATED = 0.016
"""Logarithm of C within which the catalogue's and that of ISO 281 are alike: its ratings have two or three digits."""


Estimate = Callable[[str], BallGeometry]


def row_estimate(
    designation: str, found: Designation, estimate: Estimate, width: Callable[[str], float]
) -> BallGeometry:
    """Inner geometry of a double row angular contact or a four-point contact ball bearing, or of a matched set.

    Parameters
    ----------
    designation : str
        Designation as it was typed: 32, 33 (or 52, 53) with bores of 10 to 85 mm; QJ2, QJ3 (30 to 200 mm), QJ10.
    found : Designation
        Parts of it.
    estimate : callable
        Designation of a bearing of one row to its geometry.
    width : callable
        The same to its width [m].

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
    if found.matched:
        return _matched_set(designation, found, estimate(found.single), width(found.single))
    if found.kind == THRUST:
        delivered(designation, 0.0)  # refuses classes of clearance
        bearing = _thrust(found)
    elif found.kind == FOUR_POINT:
        bearing = _four_point(found, estimate)
    else:
        bearing = _double_row(found) if found.kind == DOUBLE_ROW else _self_aligning(found)
    if bearing is None:
        raise not_known(
            designation,
            "ball bearing",
            row_designations(),
            "32, 33 with bores of 10 to 85 and 15 to 70 mm, 12, 13, 22, 23 with 20 to 110 mm as far as NSK makes them, "
            "QJ2, QJ3 with 30 to 200 mm, QJ10 with 80 to 200 mm, 511, 512 with 10 to 190, 513 with 25 to 190 and 514 "
            "with 25 to 180 mm",
        )
    return bearing


def _matched_set(designation: str, found: Designation, one: BallGeometry, width: float) -> BallGeometry:
    """Bearings that stand side by side, preloaded by their class."""
    series, code, suffix = found.parts
    sets = [name for name in SETS if found.matched.startswith(name)]
    name = max(sets, key=len, default="")
    preload, level = 0.0, found.matched.removeprefix(name)
    level = level or "".join(one.text for one in found.affixes if one.effect == PAIR)
    if level:
        rows = table("balls")["preload"].get(series, {}).get(suffix, [])
        row = next((row for row in rows if bore_code(row[0]) == code), None)
        if row is None or level not in PRELOADS:
            raise InputError(
                f"bearing designation: got {short(designation)}; allowed: a set without class of preload, with a force "
                f'by keys, {{ name = "{found.single} {name}", preload = "200 N" }}; NSK\'s classes '
                f"{', '.join(PRELOADS)} are known for 719, 70, 72 C and AC, those of others are not"
            )
        preload = row[1 + PRELOADS.index(level)]
    ways = SETS[name]
    middle = 0.5 * (len(ways) - 1)
    rows = tuple(BallRow(way, (place - middle) * width) for place, way in enumerate(ways))
    made = dataclasses.replace(one, name=found.name, rows=rows, clearance=0.0, clearance_range=None)
    if preload and made.axial_play:  # each bearing is ground for a pair: three or four press each other by as much way
        ground = pressed_by(made, preload)
        pressed = dataclasses.replace(made, rows=tuple(row._replace(shift=ground) for row in rows))
        preload = preload_of(pressed)
    return preloaded(made, preload)


def preloaded(geometry: BallGeometry, preload: float) -> BallGeometry:
    """A bearing whose rows press each other with a force, at rest, dry, centred; each way shares it evenly.

    Parameters
    ----------
    geometry : BallGeometry
        Rows that carry either way; others have no preload of their own.
    preload : float
        Force of all rows of a way [N].

    Raises
    ------
    InputError
        For a preload that is negative or not finite, and one of rows that all carry the same way.
    """
    if not (math.isfinite(preload) and preload >= 0.0) or (preload and not geometry.axial_play):
        raise InputError(
            f"preload: got {preload:.6g} N for {geometry.name}; allowed: zero or more, of rows that carry either way"
        )
    count = {way: sum(row.way == way for row in geometry.rows) for way in (1.0, -1.0)}
    shifts = {way: pressed_by(geometry, preload / rows) if rows else 0.0 for way, rows in count.items()}
    return dataclasses.replace(geometry, rows=tuple(row._replace(shift=shifts[row.way]) for row in geometry.rows))


def pressed_by(geometry: BallGeometry, force: float, material: Material = STEEL) -> float:
    """Axial way by which a row of centred rings is pressed by an axial force [m], see `row_force`.

    Parameters
    ----------
    geometry : BallGeometry
        The bearing.
    force : float
        Force on one row [N].
    material : Material
        Material of balls and rings, where the geometry has none of its own.
    """
    if force == 0.0:
        return 0.0
    most = geometry.groove_distance
    return float(brentq(lambda way: row_force(geometry, way, material) - force, 0.0, most, xtol=1e-15, rtol=1e-14))


def row_force(geometry: BallGeometry, way: float, material: Material = STEEL) -> float:
    """Axial force of a row of centred rings by the way that presses it, dry and at rest [N].

    Both contacts are in series, and go with the power 2/3 of the load.

    Parameters
    ----------
    geometry : BallGeometry
        The bearing.
    way : float
        Axial way from where balls of the nominal geometry just touch [m].
    material : Material
        Material of balls and rings, where the geometry has none of its own.
    """
    inner, outer = geometry.contacts(material)
    axial = geometry.groove_distance * math.sin(abs(geometry.contact_angle)) + way
    length = math.hypot(axial, geometry.radial_distance)
    pressed = max(length - geometry.groove_distance, 0.0)
    load = (pressed / (float(inner.approach(1.0)) + float(outer.approach(1.0)))) ** 1.5
    return float(geometry.balls * load * axial / length)


def preload_of(geometry: BallGeometry) -> float:
    """Force with which the rows of a bearing press each other: at rest, dry, centred, at the place without a load [N].

    Parameters
    ----------
    geometry : BallGeometry
        Rows that carry either way; of others it is zero.
    """
    if not geometry.axial_play:
        return 0.0
    rows = geometry.shifted_rows

    def left(x: float) -> float:
        return sum(row.way * row_force(geometry, row.shift + row.way * x) for row in rows)

    most = 0.5 * geometry.groove_distance
    x = float(brentq(left, -most, most, xtol=1e-15))
    return math.fsum(row_force(geometry, row.shift + x) for row in rows if row.way > 0.0)


def _self_aligning(found: Designation) -> BallGeometry | None:
    """Two rows on one sphere: balls by the pressure of the static rating, as many as the dynamic one takes."""
    series, code = found.parts
    row = _entry("self_aligning", series, code)
    if row is None:
        return None
    bore, outside, _, dynamic, static, factor = row
    pitch, angle = 0.5 * (bore + outside) * _MM, math.atan(factor / 1.5)

    def made(balls: int, diameter: float) -> BallGeometry:
        sphere = 0.5 * (1.0 + pitch / (diameter * math.cos(angle)))
        rows = BallRow(1.0), BallRow(-1.0)
        return BallGeometry(found.name, diameter, pitch, balls, SPHERE_CONFORMITY, sphere, angle, rows=rows)

    def left(diameter: float, balls: int) -> float:
        loads = [(SPHERE_PRESSURE / float(one.max_pressure(1.0))) ** 3 for one in made(3, diameter).contacts(STEEL)]
        return 0.4 * balls * math.cos(angle) * min(loads) - static

    tried = []
    for balls in range(8, 30):
        ends = 0.05 * (outside - bore) * _MM, 0.85 * pitch / balls * math.pi
        if left(ends[0], balls) < 0.0 < left(ends[1], balls):
            one = made(balls, float(brentq(left, *ends, args=(balls,))))
            tried.append((abs(math.log(ball_dynamic_rating(one) / dynamic)), balls, one))
    if not tried:
        return None
    words = f"inner geometry estimated from catalogue dimensions and NSK's ratings (ISO 76, ISO 281): {_SPHERE_ERRORS}"
    return min(tried)[2].known({}, words).delivered(own_range(found, bore * _MM))


def row_designations() -> tuple[str, ...]:
    """Designations that `row_estimate` knows."""
    rows = table("balls")
    return tuple(
        f"{prefix}{series}{bore_code(row[0])}"
        for prefix, kind in (("", "double_row"), ("QJ", "four_point"), ("", "self_aligning"), ("", "thrust"))
        for series, entries in rows[kind].items()
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
    return best[1].known({"contact_angle": angle}, words + _ERRORS.format(2, 4)).delivered(own_range(found, bore * _MM))


def _thrust(found: Designation) -> BallGeometry | None:
    """One row between washers: balls by the static rating, as many as the dynamic one takes; of numbers with which it
    agrees, that whose balls are nearest to 32nds of an inch, as they are made.
    """
    series, code = found.parts
    row = _entry("thrust", series, code)
    if row is None:
        return None
    bore, outside, _, dynamic, static = row
    pitch, tried = 0.5 * (bore + outside) * _MM, []
    for balls in range(6, 40):
        diameter = _MM * math.sqrt(static / (THRUST_FACTOR * balls))
        if balls * diameter < 0.97 * math.pi * pitch:
            grooves = THRUST_CONFORMITY, THRUST_CONFORMITY
            one = BallGeometry(found.name, diameter, pitch, balls, *grooves, LARGEST_ANGLE)
            sizes, doubt = diameter / _INCH_PART, abs(math.log(ball_dynamic_rating(one) / dynamic))
            tried.append((max(doubt, _RATED), abs(round(sizes) / sizes - 1.0), balls, one))
    words = f"inner geometry estimated from catalogue dimensions and NSK's ratings (ISO 76, ISO 281): {_THRUST_ERRORS}"
    return min(tried)[3].known({}, words)


def _four_point(found: Designation, estimate: Estimate) -> BallGeometry | None:
    """Two rows at one place."""
    _, series, code = found.parts
    row = _entry("four_point", series, code)
    if row is None:
        return None
    bore, outside, _, static = row
    pitch, angle = 0.5 * (bore + outside) * _MM, math.radians(FOUR_POINT_ANGLE)
    diameter = estimate({"10": "60", "2": "62", "3": "63"}[series] + code).ball_diameter
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
    ).delivered(own_range(found, bore * _MM))
