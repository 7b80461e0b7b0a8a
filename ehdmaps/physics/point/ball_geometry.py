"""Geometry of a ball bearing: curvatures of its contacts, groove centres, free contact angle, speeds of rolling.

The groove of a raceway is an arc of radius f Dw about a centre; f is its conformity. A ball that both rings touch
without load has the two groove centres A = (f_i + f_o - 1) Dw apart, on a line at the free contact angle alpha_0 to the
radial plane. Centred rings with a diametral clearance s have

    A cos alpha_0 = A cos alpha - s/2,

with alpha the nominal contact angle: zero for deep groove bearings, whose clearance gives them an angle of their own.
A negative clearance beyond that (preload) has no free angle: it is zero, and all balls carry load in the middle.

References
----------
T. A. Harris, M. N. Kotzalas, Essential Concepts of Bearing Technology, CRC, 2007. ISO/TS 16281, Rolling bearings -
Methods for calculating the modified reference rating life for universally loaded bearings.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any, ClassVar, NamedTuple

from ehdmaps.errors import InputError, label_problem
from ehdmaps.physics.designations.clearance import ClearanceRange, Named
from ehdmaps.physics.point.ellipse import Ellipse
from ehdmaps.physics.solids import Material, reduced_modulus

HYPOTHESES = OUTER, INNER, BISECTOR, NO_MOMENT = "outer race control", "inner race control", "bisector", "no moment"
"""Hypotheses on the axis about which a ball turns: it does not drill at the outer or at the inner raceway, stands half
way between the contact angles, or does that without a gyroscopic moment. See `mbs.bearings.balls.ball_speed`."""

MOST_BALLS = 500
LARGEST_ANGLE = math.radians(90.0)
"""Largest nominal contact angle, that of thrust bearings [rad]."""

_CONFORMITIES = (0.5, 1.0)
_SPHERE, _OFF_MIDDLE = 20.0, 0.25
"""Largest radius of a sphere over the ball diameter; how far it may be off the one about the middle (estimates)."""


class BallRow(NamedTuple):
    """A row of balls.

    Attributes
    ----------
    way : float
        1: it carries an axial force on the inner ring in +x; -1: one in -x. Alike for a contact angle of zero.
    place : float
        Place along the axis [m].
    shift : float
        Way by which its inner groove stands beside where balls just touch [m]; > 0 presses them.
    """

    way: float = 1.0
    place: float = 0.0
    shift: float = 0.0


ONE_ROW = (BallRow(),)


@dataclass(frozen=True)
class BallGeometry(Named):
    """A deep groove or angular contact ball bearing, of one row or several.

    Attributes
    ----------
    name : str
        Name for provenance and messages.
    ball_diameter, pitch_diameter : float
        Dw and d_m [m], d_m the diameter on which the centres of the balls lie.
    balls : int
        Number Z of balls of a row.
    inner_conformity, outer_conformity : float
        Radius of each groove over the ball diameter, f, 0.5 < f <= 1; of an outer raceway that is a sphere above 1.
    contact_angle : float
        Nominal contact angle alpha [rad], 0 for deep groove bearings. Positive: an axial force on the inner ring in +x
        is carried; negative: one in -x. At most 90 degrees either way: a thrust bearing.
    clearance : float
        Diametral clearance s [m], < 0 for preload. Of angular contact bearings it is what fits and temperature add to
        the nominal geometry; of rows that carry either way it is axial, see `axial_play`.
    label : str or None
        Free text shown instead of the name; no part of what makes bearings equal.
    estimated : str or None
        How its inner geometry was estimated and how well, see `ehdmaps.physics.point.ball_catalogue`; None where it
        is known.
    clearance_range : ClearanceRange or None
        What the clearance may be by the designation; no part of what makes bearings equal, nor of records. None where
        it is stated.
    spelled : str or None
        What each part of the designation means; no part of what makes bearings equal, nor of records.
    ball_material, ring_material : Material or None
        Materials of balls and of both rings; None: those that a question states, steel by default.
    rows : tuple of BallRow
        Rows of `balls` balls each; those of double row bearings and of matched sets have places of their own.
    tightening : float
        Part of the radial distance of both raceways that fits and warmth take where the clearance is axial; of
        diameters [m].
        Its rows, each of `balls` balls; those of double row bearings and of matched sets have places of their own.
    hypothesis : str
        Which axis a ball turns about, one of `HYPOTHESES`.

    Raises
    ------
    InputError
        With every problem of the geometry.

    Examples
    --------
    >>> bearing = BallGeometry("6305", 11.5e-3, 43.5e-3, 7, 0.52, 0.53, 0.0, 10e-6)
    >>> round(1e3 * bearing.groove_distance, 4), round(math.degrees(bearing.free_angle), 3)
    (0.575, 7.561)
    """

    kind: ClassVar[str] = "ball bearing"
    clearance_field: ClassVar[str] = "clearance"
    name: str
    ball_diameter: float
    pitch_diameter: float
    balls: int
    inner_conformity: float
    outer_conformity: float
    contact_angle: float = 0.0
    clearance: float = 0.0
    label: str | None = field(default=None, compare=False)
    estimated: str | None = None
    clearance_range: ClearanceRange | None = field(default=None, compare=False)
    spelled: str | None = field(default=None, compare=False)
    ball_material: Material | None = None
    ring_material: Material | None = None
    rows: tuple[BallRow, ...] = ONE_ROW
    tightening: float = 0.0
    hypothesis: str = OUTER

    def __post_init__(self) -> None:
        problems = _problems(self)
        if problems:
            raise InputError(problems)

    @property
    def rolling_elements(self) -> int:
        """Number of its balls, of all rows."""
        return self.balls * len(self.rows)

    @property
    def bodies(self) -> int:
        """Number of its balls; those with four contacts count once."""
        return self.balls * self.ball_rows

    @property
    def thrust(self) -> bool:
        """Tell whether its grooves face each other along the axis: a thrust bearing, without a radial clearance."""
        return abs(self.contact_angle) == LARGEST_ANGLE

    @property
    def has_clearance(self) -> bool:
        """Tell whether it has a clearance: washers have none."""
        return not self.thrust

    @property
    def row_elements(self) -> int:
        """Number of the balls of a row."""
        return self.balls

    def known(self, values: Mapping[str, Any], estimated: str) -> BallGeometry:
        """The same bearing with parts that are known.

        Parameters
        ----------
        values : mapping of str to object
            Fields that are known.
        estimated : str
            What is left of the estimate, in words; empty where nothing is.
        """
        return replace(self, **values, estimated=estimated or None)

    def record(self) -> dict[str, float | str]:
        """See `Named.record`; materials in words."""
        found = super().record()
        del found["rows"]
        if self.tightening == 0.0:
            del found["tightening"]
        if len(self.rows) > 1:
            found["rows"] = self.row_words
        for part in ("ball", "ring"):
            material: Material | None = getattr(self, f"{part}_material")
            if material is not None:
                modulus, ratio = 1e-9 * material.youngs_modulus, material.poisson_ratio
                found[f"{part}_material"] = f"{modulus:g} GPa, {ratio:g}, {material.density:g} kg/m3"
        return found

    @property
    def others(self) -> tuple[int, ...]:
        """Rows from each row to that of the other contacts of its balls; 0 where balls have two contacts."""
        return (1, -1) if len(self.rows) == 2 and self.ball_rows == 1 else (0,) * len(self.rows)

    @property
    def ball_rows(self) -> int:
        """Number of rows of balls: those of a four-point contact bearing are at one place, and one row."""
        return len(self.rows) if self.spherical else len({row.place for row in self.rows})

    @property
    def row_words(self) -> str:
        """Its rows in words; empty for one."""
        if self.rows == ONE_ROW:
            return ""
        if self.spherical:
            return f"{len(self.rows)} rows on a sphere, free to tilt"
        if self.ball_rows == 1:
            return "two arcs on each raceway: contacts that carry either way are told as balls of their own"
        ways = "".join("+" if row.way > 0.0 else "-" for row in self.rows)
        places = " and ".join(f"{row.place / 1e-3:.4g}" for row in self.rows)
        pressed = {round(1e6 * row.shift, 6) for row in self.rows} - {0.0}
        shifts = f", pressed by {' and '.join(f'{one:.4g}' for one in sorted(pressed))} um" if pressed else ""
        return f"{len(self.rows)} rows ({ways}) at {places} mm{shifts}"

    @property
    def gamma(self) -> float:
        """Ratio Dw cos(alpha)/d_m, by the nominal contact angle."""
        return self.ball_diameter * math.cos(self.contact_angle) / self.pitch_diameter

    @property
    def lean(self) -> float:
        """Cosine of the angle between the axes of a rolling ball and the bearing, by the nominal contact angle."""
        return math.cos(self.contact_angle)

    @property
    def groove_distance(self) -> float:
        """Distance A of the groove centres where both rings touch a ball without load [m]."""
        return (self.inner_conformity + self.outer_conformity - 1.0) * self.ball_diameter

    @property
    def radial_distance(self) -> float:
        """Radial distance of the groove centres of centred rings, A cos(alpha) - s/2 [m]; 0 of thrust bearings."""
        if self.thrust:
            return 0.0
        play = 0.0 if self.axial_play else self.clearance
        return self.groove_distance * math.cos(self.contact_angle) - 0.5 * (play - self.tightening)

    @property
    def axial_play(self) -> bool:
        """Tell whether its clearance is axial: rows that carry either way have one by where their grooves stand."""
        return self.contact_angle != 0.0 and len({row.way for row in self.rows}) > 1 and not self.spherical

    @property
    def spherical(self) -> bool:
        """Tell whether its outer raceway is a sphere about its middle."""
        return self.outer_conformity > _CONFORMITIES[1]

    @property
    def tilt_arm(self) -> float:
        """Arm by which tilts move the inner groove's centre along the axis: none about the middle of a sphere [m]."""
        return 0.0 if self.spherical else self.inner_groove_radius

    @property
    def most_travel(self) -> float:
        """Largest way of the inner ring that is no mistake [m]."""
        return min(self.groove_distance, 0.05 * self.ball_diameter) if self.spherical else self.groove_distance

    @property
    def shifted_rows(self) -> tuple[BallRow, ...]:
        """Rows with what an axial clearance loosens them."""
        if not self.axial_play:
            return self.rows
        return tuple(row._replace(shift=row.shift - 0.5 * self.clearance) for row in self.rows)

    @property
    def free_angle(self) -> float:
        """Free contact angle alpha_0 of centred rings without load [rad], with the sign of the contact angle.

        Zero where the rings press on the balls in the middle.
        """
        return math.copysign(math.acos(min(self.radial_distance / self.groove_distance, 1.0)), self.contact_angle)

    @property
    def inner_groove_radius(self) -> float:
        """Distance of the inner groove's centre from the axis, d_m/2 + (f_i - 1/2) Dw cos(alpha_0) [m]."""
        return 0.5 * self.pitch_diameter + (self.inner_conformity - 0.5) * self.ball_diameter * math.cos(
            self.free_angle
        )

    def contacts(self, material: Material, rings: Material | None = None) -> tuple[Ellipse, Ellipse]:
        """Dry ellipses of the inner and the outer contact.

        Parameters
        ----------
        material : Material
            Material of the balls.
        rings : Material, optional
            Material of both rings; that of the balls if left out. What the geometry says of materials goes before.
        """
        other = material if rings is None else rings
        modulus = reduced_modulus(self.ball_material or material, self.ring_material or other)
        half = 0.5 * self.ball_diameter
        return (
            Ellipse(half * (1.0 - self.gamma), _across(half, self.inner_conformity), modulus, half),
            Ellipse(half * (1.0 + self.gamma), _across(half, self.outer_conformity), modulus, half),
        )

    def ball_mass(self, material: Material) -> float:
        """Mass of a ball [kg], of its own material where that is known."""
        return (self.ball_material or material).density * math.pi / 6.0 * self.ball_diameter**3

    def entrainment_speed(self, inner_speed: float, outer_speed: float = 0.0) -> float:
        """Entrainment speed u = (d_m/4) abs(omega_i - omega_o) (1 - gamma^2) [m/s] at both races, in pure rolling.

        Parameters
        ----------
        inner_speed, outer_speed : float
            Speeds of the rings [rad/s].

        Examples
        --------
        >>> bearing = BallGeometry("6305", 11.5e-3, 43.5e-3, 7, 0.52, 0.53)
        >>> round(bearing.entrainment_speed(3000 * math.pi / 30), 3)
        3.178
        """
        return 0.25 * self.pitch_diameter * abs(inner_speed - outer_speed) * (1.0 - self.gamma**2)

    def carries_along(self, way: float) -> bool:
        """Tell whether it carries a force on the inner ring along x, `way` > 0, or along -x."""
        return self.contact_angle == 0.0 or any(self.contact_angle * row.way * way > 0.0 for row in self.rows)

    def cage_speed(self, inner_speed: float, outer_speed: float = 0.0) -> float:
        """Speed of the cage [rad/s] in pure rolling at the nominal contact angle.

        Parameters
        ----------
        inner_speed, outer_speed : float
            Speeds of the rings [rad/s].
        """
        return 0.5 * (inner_speed * (1.0 - self.gamma) + outer_speed * (1.0 + self.gamma))


def _across(half: float, conformity: float) -> float:
    """Reduced radius of a ball of radius `half` in a groove, across the direction of rolling [m]."""
    return half * 2.0 * conformity / (2.0 * conformity - 1.0)


def _problems(geometry: BallGeometry) -> list[str]:
    """Everything that is wrong with a geometry."""
    where = f"ball bearing {geometry.name!r}" if isinstance(geometry.name, str) else "ball bearing"
    problems = [] if isinstance(geometry.name, str) and geometry.name else [f"{where}: has no name"]
    problems += [f"{where}, label: {problem}" for problem in label_problem(geometry.label)]
    if geometry.hypothesis not in HYPOTHESES:
        problems.append(f"{where}, hypothesis: got {geometry.hypothesis!r:.60}; allowed: {', '.join(HYPOTHESES)}")
    numbers = (
        ("ball_diameter", "m", 0.0, math.inf, "> 0"),
        ("pitch_diameter", "m", 0.0, math.inf, "> 0"),
        ("inner_conformity", "", *_CONFORMITIES, "above 0.5 and at most 1; it is radius over ball diameter"),
        ("outer_conformity", "", 0.5, _SPHERE, "above 0.5 and at most 1; it is radius over ball diameter"),
        ("contact_angle", "rad", -math.inf, LARGEST_ANGLE, "from -90 to 90 deg"),
        ("clearance", "m", -math.inf, math.inf, ""),
    )
    for name, unit, above, most, allowed in numbers:
        value = getattr(geometry, name)
        number = isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)
        inside = number and above < value <= most and not (name == "contact_angle" and value < -LARGEST_ANGLE)
        if not inside:
            words = f"finite and {allowed}" if allowed else "a finite number"
            problems.append(f"{where}, {name}: got {value!r:.60}{' ' + unit if unit else ''}; allowed: {words}")
    count = geometry.balls
    if not isinstance(count, int) or isinstance(count, bool) or not 3 <= count <= MOST_BALLS:
        problems.append(f"{where}, balls: got {count!r:.60}; allowed: a whole number from 3 to {MOST_BALLS}")
    if problems:
        return problems
    if not geometry.ball_diameter < geometry.pitch_diameter * math.sin(math.pi / count) * (1.0 + 1e-9):
        problems.append(
            f"{where}: got {count} balls of {1e3 * geometry.ball_diameter:.4g} mm on a pitch diameter of "
            f"{1e3 * geometry.pitch_diameter:.4g} mm; allowed: balls that have room beside each other"
        )
    middle = 0.5 + 0.5 * geometry.pitch_diameter / (geometry.ball_diameter * math.cos(geometry.contact_angle))
    if geometry.spherical and abs(geometry.outer_conformity / middle - 1.0) > _OFF_MIDDLE:
        problems.append(
            f"{where}, outer_conformity: got {geometry.outer_conformity:.4g}; allowed: above 0.5 and at most 1; it is "
            f"radius over ball diameter; or that of a sphere about the middle of the bearing, {middle:.4g}"
        )
    if geometry.thrust and (geometry.clearance or geometry.tightening):
        problems.append(
            f"{where}, clearance: got {1e6 * (geometry.clearance or geometry.tightening):.4g} um; allowed: 0, as "
            "washers of thrust bearings have none, and none is taken by fits or warmth"
        )
    elif not abs(geometry.clearance) < geometry.groove_distance * math.cos(geometry.contact_angle):
        problems.append(
            f"{where}, clearance: got {1e6 * geometry.clearance:.4g} um; allowed: less than the distance of the groove "
            f"centres, {1e6 * geometry.groove_distance * math.cos(geometry.contact_angle):.4g} um, either way; check "
            "its unit"
        )
    return problems
