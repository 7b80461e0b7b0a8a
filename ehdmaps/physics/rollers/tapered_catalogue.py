"""Inner geometry of tapered roller bearings that only a catalogue describes: estimated, and marked so.

- contact angle alpha by the factor e = 1.5 tan(alpha) of ISO 281;
- pitch diameter d_m = (d + D)/2;
- rollers by both ratings, see `ehdmaps.physics.rollers.ratings`: of cylindrical roller bearings of the same catalogue,
  whose rollers are known, they tell the diameter within 2 %. `FILLED` of the pitch circle gives their number;
- cone, apex and rib follow, see `ehdmaps.physics.rollers.tapered_geometry`.

The catalogue's distance of the pressure centre is not used. With rollers in the middle of the cup the estimate's is
1.4 mm less in the mean of all, from 0.2 to 2.8 mm: rollers sit towards the large end.

References
----------
ISO 355: boundary dimensions. ISO 76, ISO 281. Dimensions, ratings, pressure centres and factors e: NSK, Rolling
Bearings, catalogue E1102e, series HR with the suffix J.
"""

from __future__ import annotations

import dataclasses
import math
from typing import NamedTuple

from ehdmaps.errors import InputError, closest, short
from ehdmaps.physics.designations.clearance import delivered
from ehdmaps.physics.designations.families import not_served
from ehdmaps.physics.designations.reader import TAPERED, plain_name
from ehdmaps.physics.rollers.ratings import Rollers, by_ratings, ratings, with_static_rating
from ehdmaps.physics.rollers.tapered_geometry import TaperedGeometry

FILLED = 0.9
"""Share of the pitch circle that rollers take: pressed cages of today's designs leave a tenth."""

ERRORS = (
    "contact angle to 0.5 deg, pitch diameter 3 %, roller diameter 5 %, roller length 8 %, number of rollers +-1; "
    "profile, end and rib are assumed"
)

_MM = 1e-3

# bore, outside diameter, widths T, B, C [mm], C and C0 [N], distance a of the pressure centre [mm], e
_TABLE = {
    "302": (
        (17, 40, 13.25, 12, 11, 20100, 19900, 9.7, 0.35), (20, 47, 15.25, 14, 12, 27900, 28500, 11, 0.35),
        (25, 52, 16.25, 15, 13, 32000, 35000, 12.7, 0.37), (30, 62, 17.25, 16, 14, 43000, 47500, 13.9, 0.37),
        (35, 72, 18.25, 17, 15, 54000, 59500, 15, 0.37), (40, 80, 19.75, 18, 16, 63500, 70000, 16.6, 0.37),
        (45, 85, 20.75, 19, 16, 68500, 79500, 18.3, 0.41), (50, 90, 21.75, 20, 17, 76000, 91500, 19.6, 0.42),
        (55, 100, 22.75, 21, 18, 94500, 113000, 20.9, 0.41), (60, 110, 23.75, 22, 19, 104000, 123000, 22, 0.41),
        (65, 120, 24.75, 23, 20, 122000, 151000, 23.8, 0.41), (70, 125, 26.25, 24, 21, 132000, 163000, 25.7, 0.42),
        (75, 130, 27.25, 25, 22, 143000, 182000, 27, 0.44), (80, 140, 28.25, 26, 22, 157000, 195000, 28.1, 0.42),
    ),
    "303": (
        (15, 42, 14.25, 13, 11, 23600, 21100, 9.5, 0.29), (17, 47, 15.25, 14, 12, 29200, 26700, 10.4, 0.29),
        (20, 52, 16.25, 15, 13, 35000, 33500, 11.6, 0.3), (25, 62, 18.25, 17, 15, 47500, 46000, 13.2, 0.3),
        (30, 72, 20.75, 19, 16, 59500, 60000, 15.1, 0.32), (35, 80, 22.75, 21, 18, 76000, 79000, 16.7, 0.32),
        (40, 90, 25.25, 23, 20, 90500, 101000, 19.5, 0.35), (45, 100, 27.25, 25, 22, 112000, 127000, 21.1, 0.35),
        (50, 110, 29.25, 27, 23, 130000, 148000, 23.1, 0.35), (55, 120, 31.5, 29, 25, 150000, 171000, 24.6, 0.35),
        (60, 130, 33.5, 31, 26, 174000, 201000, 26, 0.35), (65, 140, 36, 33, 28, 200000, 233000, 27.9, 0.35),
        (70, 150, 38, 35, 30, 227000, 268000, 29.7, 0.35), (75, 160, 40, 37, 31, 253000, 300000, 31.8, 0.35),
        (80, 170, 42.5, 39, 33, 276000, 330000, 34, 0.35),
    ),
    "313": (
        (25, 62, 18.25, 17, 13, 38000, 40500, 19.9, 0.83), (30, 72, 20.75, 19, 14, 49000, 52500, 23.1, 0.83),
        (35, 80, 22.75, 21, 15, 62000, 68000, 25.2, 0.83), (40, 90, 25.25, 23, 17, 80000, 89500, 28.7, 0.83),
        (45, 100, 27.25, 25, 18, 95500, 109000, 31.5, 0.83), (50, 110, 29.25, 27, 19, 114000, 132000, 34.2, 0.83),
        (55, 120, 31.5, 29, 21, 131000, 153000, 37, 0.83), (60, 130, 33.5, 31, 22, 151000, 177000, 40.3, 0.83),
        (65, 140, 36, 33, 23, 173000, 205000, 43.2, 0.83), (70, 150, 38, 35, 25, 192000, 229000, 45.7, 0.83),
        (75, 160, 40, 37, 26, 211000, 251000, 48.7, 0.83), (80, 170, 42.5, 39, 27, 235000, 283000, 51.8, 0.83),
    ),
    "320": (
        (20, 42, 15, 15, 12, 24600, 27400, 10.6, 0.37), (25, 47, 15, 15, 11.5, 27400, 33000, 11.8, 0.43),
        (30, 55, 17, 17, 13, 36000, 44500, 13.5, 0.43), (35, 62, 18, 18, 14, 43500, 55500, 15, 0.45),
        (40, 68, 19, 19, 14.5, 53000, 71000, 15, 0.38), (45, 75, 20, 20, 15.5, 60000, 83000, 16.6, 0.39),
        (50, 80, 20, 20, 15.5, 61000, 87000, 17.9, 0.42), (55, 90, 23, 23, 17.5, 81500, 117000, 19.7, 0.41),
        (60, 95, 23, 23, 17.5, 85500, 127000, 20.9, 0.43), (65, 100, 23, 23, 17.5, 86500, 132000, 22.4, 0.46),
        (70, 110, 25, 25, 19, 104000, 158000, 23.7, 0.43), (75, 115, 25, 25, 19, 109000, 171000, 25.1, 0.46),
        (80, 125, 29, 29, 22, 140000, 222000, 26.9, 0.42),
    ),
    "322": (
        (17, 40, 17.25, 16, 14, 27100, 28000, 11.2, 0.31), (20, 47, 19.25, 18, 15, 35500, 37500, 12.6, 0.33),
        (25, 52, 19.25, 18, 16, 40000, 45000, 13.5, 0.36), (30, 62, 21.25, 20, 17, 52000, 60000, 15.4, 0.37),
        (35, 72, 24.25, 23, 19, 70500, 83500, 17.9, 0.37), (40, 80, 24.75, 23, 19, 77000, 90500, 18.9, 0.37),
        (45, 85, 24.75, 23, 19, 83000, 102000, 20.1, 0.41), (50, 90, 24.75, 23, 19, 87500, 109000, 21, 0.42),
        (55, 100, 26.75, 25, 21, 110000, 137000, 22.7, 0.41), (60, 110, 29.75, 28, 24, 131000, 167000, 24.1, 0.41),
        (65, 120, 32.75, 31, 27, 157000, 202000, 27.1, 0.41), (70, 125, 33.25, 31, 27, 157000, 205000, 28.6, 0.42),
        (75, 130, 33.25, 31, 27, 165000, 219000, 29.8, 0.44), (80, 140, 35.25, 33, 28, 192000, 254000, 30.6, 0.42),
    ),
    "323": (
        (17, 47, 20.25, 19, 16, 37500, 36500, 12.5, 0.29), (20, 52, 22.25, 21, 18, 45500, 47500, 13.9, 0.3),
        (25, 62, 25.25, 24, 20, 62500, 66000, 15.6, 0.3), (30, 72, 28.75, 27, 23, 80000, 88500, 18, 0.32),
        (35, 80, 32.75, 31, 25, 99000, 111000, 20.7, 0.32), (40, 90, 35.25, 33, 27, 120000, 145000, 23.4, 0.35),
        (45, 100, 38.25, 36, 30, 144000, 177000, 25, 0.35), (50, 110, 42.25, 40, 33, 176000, 220000, 27.9, 0.35),
        (55, 120, 45.5, 43, 35, 204000, 258000, 29.9, 0.35), (60, 130, 48.5, 46, 37, 233000, 295000, 31.4, 0.35),
        (65, 140, 51, 48, 39, 267000, 340000, 34, 0.35), (70, 150, 54, 51, 42, 300000, 390000, 36, 0.35),
        (75, 160, 58, 55, 45, 340000, 445000, 38.9, 0.35), (80, 170, 61.5, 58, 48, 385000, 505000, 41.3, 0.35),
    ),
}  # fmt: skip


class TaperedCatalogue(NamedTuple):
    """Entry of a catalogue.

    Attributes
    ----------
    bore, outside_diameter, width, cone_width, cup_width : float
        Boundary dimensions d, D, T, B, C [m].
    dynamic_rating, static_rating : float
        C and C0 [N].
    pressure_centre : float
        Distance a of the pressure centre from the back face of the cup [m].
    axial_factor : float
        Factor e of ISO 281.
    """

    bore: float
    outside_diameter: float
    width: float
    cone_width: float
    cup_width: float
    dynamic_rating: float
    static_rating: float
    pressure_centre: float
    axial_factor: float

    @property
    def thrust_factor(self) -> float:
        """Factor Y = 0.4/tan(alpha) of the axial load, for loads with Fa/Fr > e."""
        return 0.6 / self.axial_factor


def tapered_estimate(designation: str) -> TaperedGeometry:
    """Inner geometry of a tapered roller bearing by its designation.

    Parameters
    ----------
    designation : str
        Series 302, 303, 313, 320, 322, 323 with bores of 15 to 80 mm, such as "32208"; blanks and suffixes of makers do
        not matter.

    Raises
    ------
    InputError
        If there is no such bearing.

    Examples
    --------
    >>> bearing = tapered_estimate("32208 J2/Q")
    >>> bearing.rollers, [round(1e3 * x, 2) for x in (bearing.roller_diameter, bearing.roller_length)]
    (17, [9.96, 14.92])
    """
    entry = tapered_boundary(designation)
    if entry is None:
        if words := not_served(designation):
            raise InputError(f"bearing designation: {words}")
        raise InputError(
            f"tapered bearing designation: got {short(designation)}"
            f"{closest(designation.upper(), tapered_designations())}; allowed: 302, 303, 313, 320, 322, 323 with bores "
            "of 15 to 80 mm, as far as NSK makes them, such as '32208'"
        )
    delivered(designation, entry.bore)  # refuses a class of radial clearance
    angle = math.atan(entry.axial_factor / 1.5)
    pitch = 0.5 * (entry.bore + entry.outside_diameter)
    found = by_ratings(pitch, (entry.dynamic_rating, entry.static_rating), FILLED, angle)
    count = round(found.number)
    rollers = with_static_rating(found.diameter, count, pitch, entry.static_rating, angle)
    sentence = f"inner geometry estimated from catalogue dimensions and NSK's ratings (ISO 76, ISO 281): {ERRORS}"
    name = plain_tapered_designation(designation)
    return TaperedGeometry(name, rollers.diameter, rollers.length, pitch, count, angle, estimated=sentence)


def mirrored(geometry: TaperedGeometry) -> TaperedGeometry:
    """The same bearing turned round.

    Parameters
    ----------
    geometry : TaperedGeometry
        The bearing.
    """
    return dataclasses.replace(geometry, contact_angle=-geometry.contact_angle)


def plain_tapered_designation(designation: str) -> str:
    """Designation without blanks and suffixes, such as "32208"; empty where it is none.

    Parameters
    ----------
    designation : str
        Designation as it was typed.

    Examples
    --------
    >>> plain_tapered_designation("HR 32008 XJ"), plain_tapered_designation("32 208")
    ('32008', '')
    """
    return plain_name(designation, (TAPERED,))


def tapered_boundary(designation: str) -> TaperedCatalogue | None:
    """Entry of a bearing by its designation; None where it is not in the table.

    Parameters
    ----------
    designation : str
        Such as "32208".

    Examples
    --------
    >>> tapered_boundary("32208").axial_factor
    0.37
    """
    name = plain_tapered_designation(designation)
    for row in _TABLE.get(name[:3], ()):
        if _code(row[0]) == name[3:]:
            d, outside, width, cone, cup, dynamic, static, centre, factor = row
            lengths = (d * _MM, outside * _MM, width * _MM, cone * _MM, cup * _MM)
            return TaperedCatalogue(*lengths, dynamic, static, centre * _MM, factor)
    return None


def tapered_designations() -> tuple[str, ...]:
    """Designations that `tapered_estimate` knows."""
    return tuple(series + _code(row[0]) for series, table in _TABLE.items() for row in table)


def tapered_ratings(geometry: TaperedGeometry) -> tuple[float, float]:
    """C of ISO 281 and C0 of ISO 76 [N].

    Parameters
    ----------
    geometry : TaperedGeometry
        The bearing.
    """
    rollers = Rollers(geometry.roller_diameter, geometry.roller_length, geometry.rollers)
    return ratings(rollers, geometry.pitch_diameter, geometry.cup_angle)


def _code(bore: float) -> str:
    """Bore code of a bore [mm]."""
    return {15: "02", 17: "03"}.get(int(bore), f"{int(bore) // 5:02d}")
