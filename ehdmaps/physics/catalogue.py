"""Inner geometry of cylindrical roller bearings that only a catalogue describes: estimated, and marked so.

Boundary dimensions (ISO 15) and raceway diameters are in catalogues; number and length of the rollers mostly are not.
Raceways F and E here are those of today's reinforced design (suffix E; series 10: plain), which makers share with few
exceptions. From them:

- roller diameter D = (E - F)/2;
- number of rollers Z: they fill 0.8 of the pitch circle, the rest is cage;
- length L: what the static rating of ISO 76 takes, C0 = 44 (1 - D/d_m) Z L D [N, mm], where C0 is given; else a share
  of the width.

Full complement bearings NCF have as many rollers as go in. E and both ratings are those of SKF's general catalogue
(edition in Russian): together they tell rollers of whole or half millimetres within 3 %. They carry as NJ do.

NCF2240 is SKF's NCF 2240 ECJB, of high capacity, whose rollers a cage parts: those of NU2240 E, which F = 241 mm and
the ratings of Koyo (NU2240R), FAG (NU2240E.M1) and SKF (NU 2240 EC, with 15 % less C, as theirs is raised) tell within
1 % of 42 mm, and as 17 of them. SKF's C of both, 1460 kN (its page of 2020, as a public model of a drivetrain quotes
it) and 1370 kN, take (1460/1370)^(4/3) times as many; 19 are taken, and a C0 of 1.96 MN, 1.8 MN times that.

Double row bearings NN 30 and NNU 49 have E or F, and both ratings, which tell rollers of whole or half millimetres:
of all in the table the dynamic rating then is within 1.5 %. NNCF 50 have two rows of the rollers of NCF 30: SKF's E of
both are alike, and C0 is twice as much within 3 %. How far the rows stand apart no catalogue says: three ribs of equal
width are taken. Rollers of both rows stand side by side, where force over an angle of the cage changes most.

An older design, or one for high speeds, may differ by more than the errors that are stated.

References
----------
ISO 15, Rolling bearings - Radial bearings - Boundary dimensions. ISO 76, Rolling bearings - Static load ratings.
Raceways of series 2, 22, 3, 23: catalogues of Schaeffler and Koyo, which agree; of series 10: Schaeffler, some makers
differ by 0.5 mm or so. Static ratings: SKF, Rolling bearings (general catalogue), suffix ECP. NN, NNU: NSK, Super
Precision Bearings.
"""

from __future__ import annotations

import math
from functools import cache
from typing import NamedTuple

from ehdmaps.errors import InputError
from ehdmaps.physics.bearing import BEARINGS, BearingGeometry
from ehdmaps.physics.designations.clearance import ClearanceRange, class_range, delivered
from ehdmaps.physics.designations.families import not_known, words_for_lines
from ehdmaps.physics.designations.reader import (
    CYLINDRICAL,
    NEEDLES,
    ROLLERS,
    bore_code,
    plain_name,
    read_designation,
    table,
)
from ehdmaps.physics.rollers.needle_catalogue import needle_boundary, needle_designations, needle_estimate
from ehdmaps.physics.rollers.ratings import RATING, by_ratings

FILLED = 0.8
"""Share of the pitch circle that rollers take: gives the published number for NU308, NU205, NU206, NU2205, N204."""

INNER_SHARE, OUTER_SHARE = 0.244, 0.219
"""Ring thickness below the raceway over the section (D - d): means of the table below."""

LENGTH_SHARE = {"10": 0.42, "2": 0.62, "22": 0.62, "3": 0.63, "23": 0.65}
"""Effective roller length over width: means of what ISO 76 gives for the static ratings of one catalogue."""

ERRORS = "raceways to about 3 %, roller diameter {} %, roller length {} %, number of rollers +-{}"
"""What an estimate is good for: measured on bearings whose inner geometry is known, and on the table, see the tests."""

DOUBLE_ERRORS = (
    "raceways to about 1 %, roller diameter {} %, roller length {} %, number of rollers +-2, row distance 15 %"
)
"""The same of bearings with two rows."""

_MM = 1e-3

_RATINGS = table("cylindrical")["ratings"]
"""Static ratings C0 [N] by series and bore code, as far as they are certain; others are estimated without."""


class Catalogue(NamedTuple):
    """Entry of a catalogue: lengths [m]; `series` is empty for dimensions by hand."""

    series: str
    bore: float
    outside_diameter: float
    width: float
    inner_raceway: float
    outer_raceway: float
    rollers: int = 0
    """Number of rollers of bearings NCF with a cage; 0: as many as the series has."""


_TABLE = table("cylindrical")["bearings"]

FULL = "NCF"
"""Beginning of the series of full complement bearings."""

_FULL_ROWS = {(series, bore_code(row[0])): row for series, rows in table("cylindrical")["full"].items() for row in rows}
_FULL = {
    key: Catalogue(FULL + key[0], *(x * _MM for x in (*row[:3], row[3] - 2 * row[4], row[3])), *row[6:])
    for key, row in _FULL_ROWS.items()
}
_FULL_RATINGS = {key: float(row[5]) for key, row in _FULL_ROWS.items()}

DOUBLE = {"30": "NN30", "49": "NNU49", "50": "NNCF50"}
"""Series of bearings with two rows."""


class _Double(NamedTuple):
    """Bearing with two rows, and its static rating [N]."""

    entry: Catalogue
    rating: float


@cache
def _double(series: str, code: str) -> _Double | None:
    """Bearing with two rows by the numbers of its designation; None where there is none."""
    name = DOUBLE[series]
    row = next((row for row in table("cylindrical")["double"][name] if bore_code(row[0]) == code), None)
    if row is None:
        return None
    if name == "NNCF50":
        single = _FULL["30", code]
        return _Double(single._replace(series=name, width=row[1] * _MM), 2.0 * _FULL_RATINGS["30", code])
    bore, outside, width, raceway = (length * _MM for length in row[:4])
    way = -1.0 if name == "NN30" else 1.0  # from the raceway of the catalogue to the other one
    diameter = 0.2 * (outside - bore)
    for _ in range(5):
        of_row = by_ratings(raceway + way * diameter, (row[4] / 2.0 ** (7.0 / 9.0), 0.5 * row[5]), FILLED)
        diameter = 0.5 * _MM * round(of_row.diameter / (0.5 * _MM))
    inner, outer = sorted((raceway, raceway + 2.0 * way * diameter))
    return _Double(Catalogue(name, bore, outside, width, inner, outer), float(row[5]))


def estimate(designation: str, basic_static_rating: float | None = None) -> BearingGeometry:
    """Inner geometry of a bearing by its designation.

    Parameters
    ----------
    designation : str
        N, NU, NJ or NUP of series 10, 2, 22, 3, 23 with bores of 20 to 100 mm, such as "NU206"; they differ in their
        ribs alone. NCF of series 18, 22, 29, 30 with 20 to 260 mm. Two rows: NN30 with 25 to 200 mm, NNU49 with 100
        to 200 mm, NNCF50 as NCF30. Blanks and the suffixes of today's design do not matter: "NU 206 ECP". Or what
        `needle_estimate` takes.
    basic_static_rating : float, optional
        C0 [N] of the bearing's catalogue; without it that of the table here, and where it has none, the roller length
        is a share of the width.

    Returns
    -------
    BearingGeometry
        The bearing with `estimated` set, and a clearance by its class, see `ehdmaps.physics.designations.clearance`.

    Raises
    ------
    InputError
        If there is no such bearing, or no roller length fits the rating.

    Examples
    --------
    >>> nu206 = estimate("NU206", 39e3)
    >>> nu206.rollers, round(1e3 * nu206.roller_diameter, 2), round(1e3 * nu206.roller_length, 2)
    (13, 9.0, 9.39)
    """
    if plain_name(designation, NEEDLES):
        return needle_estimate(designation, basic_static_rating)
    entry = _looked_up(designation)
    name = plain_name(designation, ROLLERS)
    clearance = delivered(designation, entry.bore)
    rating = tabulated_rating(designation) if basic_static_rating is None else basic_static_rating
    # makers' ratings of one bearing differ by up to a fifth, and so do their rollers
    length, table_of = (20, "SKF's ") if basic_static_rating is None else (6, "")
    if entry.series in DOUBLE.values():
        errors = DOUBLE_ERRORS.format(4, length)
        table_of = "NSK's " * bool(table_of) if FULL not in entry.series else table_of
    else:
        errors = ERRORS.format(4 if entry.series.startswith(FULL) else 12, length, 1)
    return _geometry(name, entry, rating, errors, clearance, table_of)


def designated(designation: str) -> BearingGeometry:
    """Bearing by its designation: its known inner geometry, else an estimate that is marked so.

    Parameters
    ----------
    designation : str
        One of `BEARINGS`, or what `estimate` takes; blanks and suffixes of today's design do not matter.

    Raises
    ------
    InputError
        If there is no such bearing.

    Examples
    --------
    >>> designated("NU 308 ECP").estimated is None, designated("nu 210 C3").clearance_range.words
    (True, 'clearance not stated: C3 of ISO 5753-1, less a fit: 55 um, the middle of 30 to 80 um')
    """
    known = BEARINGS.get(plain_name(designation, ROLLERS))
    bearing = estimate(designation) if known is None else known.delivered(_delivered(designation))
    return bearing.typed(designation)


def _delivered(designation: str) -> ClearanceRange | None:
    """Clearance of a cylindrical roller bearing by its designation."""
    entry = boundary(designation)
    return None if entry is None else delivered(designation, entry.bore)


def tabulated_rating(designation: str) -> float | None:
    """Static rating C0 [N] that the table has of a bearing; None where it has none.

    Parameters
    ----------
    designation : str
        Such as "NU206".

    Examples
    --------
    >>> tabulated_rating("NJ 210 ECP"), tabulated_rating("NU2210")
    (69500.0, None)
    """
    found = read_designation(designation)
    if found is None or found.kind != CYLINDRICAL:
        return None
    _, series, code = found.parts
    if series in DOUBLE and found.parts[0] != FULL:
        double = _double(series, code)
        return None if double is None else double.rating
    rating: float | None = _FULL_RATINGS.get((series, code), _RATINGS.get(series + code))
    return rating


def estimate_from_dimensions(
    bore: float, outside_diameter: float, width: float, basic_static_rating: float
) -> BearingGeometry:
    """Inner geometry of a bearing by its boundary dimensions [m] and static rating C0 [N].

    The raceways divide the section as they do in the mean of the table.

    Parameters
    ----------
    bore : float
        d [m].
    outside_diameter : float
        D [m].
    width : float
        B [m].
    basic_static_rating : float
        C0 [N].

    Raises
    ------
    InputError
        If they are no dimensions of a bearing, or no roller length fits the rating.

    Examples
    --------
    >>> geometry = estimate_from_dimensions(40e-3, 90e-3, 23e-3, 82.7e3)
    >>> round(1e3 * geometry.inner_raceway_diameter, 1), round(1e3 * geometry.outer_raceway_diameter, 1)
    (52.2, 79.0)
    """
    section = outside_diameter - bore
    if not (0.0 < bore < outside_diameter and width > 0.0 and math.isfinite(outside_diameter + width)):
        raise InputError(
            f"bearing estimate: got bore {bore!r}, outside_diameter {outside_diameter!r}, width {width!r} m; "
            "allowed: 0 < bore < outside_diameter and width > 0; exchange them?"
        )
    inner, outer = bore + INNER_SHARE * section, outside_diameter - OUTER_SHARE * section
    entry = Catalogue("", bore, outside_diameter, width, inner, outer)
    name = f"bearing {bore / _MM:g} x {outside_diameter / _MM:g} x {width / _MM:g} mm"
    clearance = class_range(CYLINDRICAL, bore)
    return _geometry(name, entry, basic_static_rating, ERRORS.format(18, 13, 4), clearance)


def static_rating(geometry: BearingGeometry) -> float:
    """Static rating C0 of ISO 76 [N]; of a bearing that was estimated by its rating, this rating.

    Parameters
    ----------
    geometry : BearingGeometry
        The bearing.

    Examples
    --------
    >>> round(static_rating(estimate("NU206", 39e3)), 6)
    39000.0
    """
    rollers = geometry.rolling_elements * geometry.roller_length * geometry.roller_diameter
    return RATING * (1.0 - geometry.gamma) * rollers


def designations() -> tuple[str, ...]:
    """Designations of cylindrical roller bearings that `estimate` knows, written with NU."""
    return tuple(f"NU{series}{code}" for series, code in _entries())


def boundary(designation: str) -> Catalogue | None:
    """Boundary dimensions of a bearing by its designation; None where it is not in the table.

    Parameters
    ----------
    designation : str
        Such as "NU308" or "N1014".

    Examples
    --------
    >>> boundary("N1014").bore
    0.07
    """
    found = read_designation(designation)
    if found is None or found.kind != CYLINDRICAL:
        needle = needle_boundary(designation)
        return None if needle is None else Catalogue("", *needle, math.nan, math.nan)
    which, series, code = found.parts
    if series in DOUBLE and which != FULL:
        double = _double(series, code)
        return None if double is None else double.entry
    return (_FULL if which == FULL else _entries()).get((series, code))


def _entries() -> dict[tuple[str, str], Catalogue]:
    """The table by dimension series and bore code."""
    found = {}
    for diameter_series, bore, outside, width, wide, inner, outer in _TABLE:
        code = f"{bore // 5:02d}"
        series = {0: "10", 2: "2", 3: "3"}[diameter_series]
        for name, b in ((series, width), (f"2{diameter_series}", wide)):
            if b:
                found[name, code] = Catalogue(name, *(value / 1e3 for value in (bore, outside, b, inner, outer)))
    return found


def _doubles() -> tuple[str, ...]:
    """Designations of bearings with two rows."""
    return tuple(f"{name}{bore_code(row[0])}" for name, rows in table("cylindrical")["double"].items() for row in rows)


def _looked_up(designation: str) -> Catalogue:
    """The entry of a designation."""
    entry = boundary(designation)
    if entry is None:
        raise not_known(
            designation,
            "bearing",
            (
                *designations(),
                *(f"{FULL}{series}{code}" for series, code in _FULL),
                *_doubles(),
                *needle_designations(),
            ),
            f"{', '.join(BEARINGS)}, and N, NU, NJ or NUP of series 10, 2, 22, 3, 23 with bores of 20 mm (25 mm in "
            "series 10) to 100 mm, such as 'NU206'; NCF of series 18, 22, 29, 30; two rows NN30, NNU49, "
            "NNCF50; needles as 'NA4908', 'K40x48x20'; give others by bore, outside_diameter, width and "
            "basic_static_rating",
            words_for_lines(designation),
        )
    return entry


def _geometry(
    name: str,
    entry: Catalogue,
    rating: float | None,
    errors: str,
    clearance: ClearanceRange | None,
    whose: str = "",
) -> BearingGeometry:
    """Rollers between two raceways."""
    diameter = 0.5 * (entry.outer_raceway - entry.inner_raceway)
    pitch = 0.5 * (entry.outer_raceway + entry.inner_raceway)
    full, rows = FULL in entry.series, 2 if entry.series in DOUBLE.values() else 1
    rollers = int(math.pi / math.asin(diameter / pitch)) if full else round(FILLED * math.pi * pitch / diameter)
    rollers = entry.rollers or rollers
    if rating is None:
        length = LENGTH_SHARE[entry.series] * entry.width
        basis = "width"
    else:
        length = rating / rows / (RATING * (1.0 - diameter / pitch) * rollers * diameter)
        basis = f"{whose}static rating (ISO 76)" + ", full complement" * full
        basis = "ratings of NU2240 and NCF 2240 ECJB (SKF), whose rollers a cage parts" if entry.rollers else basis
    if not 0.25 * entry.width < rows * length < 0.9 * entry.width:
        raise InputError(
            f"bearing estimate: got basic_static_rating {rating!r} N, which takes rollers of {length / _MM:.4g} mm"
            f"{' in each of two rows' * (rows > 1)} in a width of {entry.width / _MM:g} mm; "
            "allowed: 0.25 to 0.9 of the width; check its unit, C0 and not C"
        )
    sentence = f"inner geometry estimated from catalogue dimensions and {basis}: {errors}"
    apart = (entry.width + length) / 3.0 if rows > 1 else None
    lengths = entry.inner_raceway, entry.outer_raceway, diameter, length
    return BearingGeometry(name, *lengths, rollers, 0.0, estimated=sentence, row_distance=apart).delivered(clearance)
