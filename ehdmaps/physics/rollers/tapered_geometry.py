"""Geometry of a tapered roller bearing: cones that meet in one apex, the rib, speeds of pure rolling.

All of a roller happens in the plane of the bearing's axis and the roller. The axis of the roller stands under
theta = alpha - beta to that of the bearing, alpha the angle of the cup (the contact angle), beta half the cone angle of
the roller; the raceway of the cone stands under alpha - 2 beta. Their apexes are one point of the bearing's axis where

    tan(beta) = (D/d_m) sin(alpha - beta),

D and d_m the diameters of roller and pitch circle in the middle of the roller. Then all surfaces roll: radius and speed
grow in proportion to the distance from the apex.

The large end of the roller is a sphere around a point of its axis, which leans on the rib of the cone. Catalogues do
not tell sphere and rib; `END_SHARE` and `RIB_SHARE` stand for them.

References
----------
T. A. Harris, M. N. Kotzalas, Advanced Concepts of Bearing Technology, CRC, 2007. Ends of 0.85, 0.9 and 0.95 of the
rib's radius, which is about the apex distance, are compared in Machines 13 (2025) 910.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import cached_property
from typing import ClassVar, NamedTuple

from ehdmaps.errors import InputError, label_problem
from ehdmaps.physics.contact import LineContact
from ehdmaps.physics.designations.clearance import Named
from ehdmaps.physics.point.ellipse import Ellipse
from ehdmaps.physics.solids import Material, reduced_modulus

END_SHARE = 0.9
"""Radius of the end's sphere over the distance of the large end from the apex, where none is given."""

RIB_SHARE = 0.125
"""Height of the rib's contact above the raceway over the mean roller diameter, where none is given."""

LARGEST_ANGLE = math.radians(45.0)
"""Largest contact angle of a radial bearing, ISO 281 [rad]."""


class Rib(NamedTuple):
    """Contact of the end of a roller with a rib, in the plane of the roller and the bearing's axis.

    Attributes
    ----------
    outer : bool
        Whether the rib is that of the outer ring.
    normal : (float, float)
        Normal, axial and radial: from an inner rib into the roller, from the roller into an outer one.
    lever : float
        Lever of the normal about the middle of the roller, as rotations go from the axis outwards [m].
    radius : float
        Distance of the contact from the bearing's axis [m].
    play : float
        Distance of rib and end where nothing has moved [m].
    contact : Ellipse
        The dry contact, x the direction of sliding.
    """

    outer: bool
    normal: tuple[float, float]
    lever: float
    radius: float
    play: float
    contact: Ellipse


@dataclass(frozen=True)
class TaperedGeometry(Named):
    """A single row tapered roller bearing.

    Attributes
    ----------
    name : str
        Name for provenance and messages.
    roller_diameter, roller_length : float
        D in the middle of the roller, and its effective length L [m].
    pitch_diameter : float
        d_m, on which the middles of the rollers lie [m].
    rollers : int
        Number Z of rollers.
    contact_angle : float
        alpha, that of the cup [rad]. Positive: an axial force on the inner ring in +x is carried; negative: one in -x.
        Zero is a cylindrical roller bearing, without a rib.
    end_radius, rib_height : float or None
        Radius of the sphere of the large end, and height of its contact with the rib above the raceway [m]; None for
        what is usual.
    label : str or None
        Free text shown instead of the name; no part of what makes bearings equal.
    estimated : str or None
        How its inner geometry was estimated and how well, see `ehdmaps.physics.rollers.tapered_catalogue`; None where
        it is known.
    spelled : str or None
        What each part of the designation means; no part of what makes bearings equal, nor of records.

    Raises
    ------
    InputError
        With every problem of the geometry.

    Examples
    --------
    >>> bearing = TaperedGeometry("32208", 10e-3, 15e-3, 60e-3, 17, math.radians(14.0))
    >>> [round(math.degrees(angle), 2) for angle in (bearing.half_cone_angle, bearing.cone_angle)]
    [1.99, 10.03]
    """

    kind: ClassVar[str] = "tapered bearing"
    name: str
    roller_diameter: float
    roller_length: float
    pitch_diameter: float
    rollers: int
    contact_angle: float
    end_radius: float | None = None
    rib_height: float | None = None
    label: str | None = field(default=None, compare=False)
    estimated: str | None = None
    spelled: str | None = field(default=None, compare=False)

    def __post_init__(self) -> None:
        problems = _problems(self)
        if problems:
            raise InputError(problems)

    def carries_along(self, way: float) -> bool:
        """Tell whether it carries a force on the inner ring along x, `way` > 0, or along -x."""
        return self.contact_angle * way > 0.0

    @property
    def row_places(self) -> tuple[float, ...]:
        """Places of its rows along the axis, the one with ribs first [m]."""
        return (0.0,)

    @property
    def raceway_play(self) -> float:
        """Distance of a roller in the middle of its play from either raceway, where nothing has moved [m]."""
        return 0.0

    @property
    def cup_angle(self) -> float:
        """Contact angle without its sign [rad]."""
        return abs(self.contact_angle)

    @cached_property
    def half_cone_angle(self) -> float:
        """Half the cone angle beta of the rollers [rad]."""
        ratio, beta = self.roller_diameter / self.pitch_diameter, 0.0
        for _ in range(50):  # tan(beta) = ratio sin(alpha - beta), by Newton's method
            rest = math.tan(beta) - ratio * math.sin(self.cup_angle - beta)
            beta -= rest / (1.0 + math.tan(beta) ** 2 + ratio * math.cos(self.cup_angle - beta))
        return beta

    @property
    def axis_angle(self) -> float:
        """Angle theta of a roller's axis to that of the bearing [rad]."""
        return self.cup_angle - self.half_cone_angle

    @property
    def cone_angle(self) -> float:
        """Angle of the raceway of the inner ring, alpha - 2 beta [rad]."""
        return self.cup_angle - 2.0 * self.half_cone_angle

    @property
    def apex_distance(self) -> float:
        """Distance of the apex from the middle of a roller, along its axis [m]; infinite for cylinders."""
        sine = math.sin(self.axis_angle)
        return 0.5 * self.pitch_diameter / sine if sine > 0.0 else math.inf

    @property
    def lean(self) -> float:
        """Cosine of the angle between the axes of rollers and bearing."""
        return math.cos(self.axis_angle)

    @property
    def gamma(self) -> float:
        """Ratio D cos(theta)/d_m, by which rollers and cage turn."""
        return self.roller_diameter * self.lean / self.pitch_diameter

    @property
    def raceway_diameters(self) -> tuple[float, float]:
        """Diameters of cone and cup in the middle of the rollers [m]."""
        return self.pitch_diameter * (1.0 - self.gamma), self.pitch_diameter * (1.0 + self.gamma)

    @property
    def pressure_centre(self) -> float:
        """Distance of the pressure centre from the middle of the bearing, r_o tan(alpha) beyond the cup's contact [m].

        It lies towards the large ends, on the side of -x for a positive contact angle.
        """
        outer, beyond = 0.5 * self.raceway_diameters[1], 0.5 * self.roller_diameter * math.sin(self.axis_angle)
        return outer * math.tan(self.cup_angle) - beyond

    @property
    def end_sphere(self) -> float:
        """Radius of the sphere of the large end [m]; infinite for cylinders."""
        usual = END_SHARE * (self.apex_distance + 0.5 * self.roller_length)
        return usual if self.end_radius is None else self.end_radius

    @property
    def rib_lever(self) -> float:
        """Distance of the rib's contact from the roller's axis [m]."""
        half = 0.5 * self.roller_diameter
        end = half + 0.5 * self.roller_length * math.tan(self.half_cone_angle)
        return end - (RIB_SHARE * self.roller_diameter if self.rib_height is None else self.rib_height)

    @property
    def rib_radius(self) -> float:
        """Distance of the rib's contact from the bearing's axis [m]."""
        end = 0.5 * self.pitch_diameter + 0.5 * self.roller_length * math.sin(self.axis_angle)
        return end - self.rib_lever * math.cos(self.axis_angle)

    @property
    def rib_angle(self) -> float:
        """Angle phi of the rib's normal to the roller's axis [rad]: the normal goes through the sphere's centre."""
        return math.asin(self.rib_lever / self.end_sphere) if math.isfinite(self.end_sphere) else 0.0

    @property
    def rib_reach(self) -> float:
        """Distance of the rib's normal from the middle of the roller [m]."""
        return (self.end_sphere - 0.5 * self.roller_length) * math.sin(self.rib_angle)

    def entrainment_speed(self, inner_speed: float, outer_speed: float = 0.0) -> float:
        """Speed of both surfaces against the cage in the middle of a roller, in pure rolling [m/s].

        Parameters
        ----------
        inner_speed, outer_speed : float
            Speeds of the rings [rad/s].
        """
        return 0.25 * self.pitch_diameter * abs(inner_speed - outer_speed) * (1.0 - self.gamma**2)

    def cage_speed(self, inner_speed: float, outer_speed: float = 0.0) -> float:
        """Speed of the cage [rad/s] in pure rolling.

        Parameters
        ----------
        inner_speed, outer_speed : float
            Speeds of the rings [rad/s].
        """
        return 0.5 * (inner_speed * (1.0 - self.gamma) + outer_speed * (1.0 + self.gamma))

    def roller_speed(self, inner_speed: float, outer_speed: float = 0.0) -> float:
        """Speed of a roller about its axis against the cage [rad/s], opposite to the inner ring's where that leads.

        Parameters
        ----------
        inner_speed, outer_speed : float
            Speeds of the rings [rad/s].
        """
        return -0.5 * (inner_speed - outer_speed) * (1.0 / self.gamma - self.gamma) * self.lean

    def rib_speeds(
        self, inner_speed: float, outer_speed: float = 0.0, *, outer: bool = False, radius: float | None = None
    ) -> tuple[float, float]:
        """Speeds of the rib and of the roller's end at their contact, against the cage [m/s].

        Parameters
        ----------
        inner_speed, outer_speed : float
            Speeds of the rings [rad/s].
        outer : bool
            Whether the rib is that of the outer ring.
        radius : float, optional
            Distance of the contact from the bearing's axis [m]; that of the rib of the cone if left out.
        """
        ring = outer_speed if outer else inner_speed
        rib = (ring - self.cage_speed(inner_speed, outer_speed)) * (self.rib_radius if radius is None else radius)
        end = self.roller_speed(inner_speed, outer_speed) * self.rib_lever
        return rib, end if outer else -end

    def roller_mass(self, material: Material) -> float:
        """Mass of a roller, a truncated cone [kg].

        Parameters
        ----------
        material : Material
            Material of the rollers.
        """
        slope = 0.5 * self.roller_length * math.tan(self.half_cone_angle)
        mean_square = 0.25 * self.roller_diameter**2 + slope**2 / 3.0
        return material.density * math.pi * self.roller_length * mean_square

    def roller_inertia(self, material: Material) -> tuple[float, float]:
        """Moments of inertia of a roller about its axis and across it, as of a cylinder [kg m2].

        Parameters
        ----------
        material : Material
            Material of the rollers.
        """
        mass = self.roller_mass(material)
        along = 0.125 * mass * self.roller_diameter**2
        return along, 0.5 * along + mass * self.roller_length**2 / 12.0

    def radius_at(self, place: float, side: int) -> float:
        """Reduced radius of a line contact across the roller [m], of cones by their radii of curvature.

        Parameters
        ----------
        place : float
            Distance from the middle of the roller along its axis, towards the apex [m].
        side : int
            0 for the cone, 1 for the cup.
        """
        share = 1.0 - place / self.apex_distance
        roller = 0.5 * self.roller_diameter * share / math.cos(self.half_cone_angle)
        ring, sign = self.raceway_diameters[side], (1.0, -1.0)[side]
        angle = (self.cone_angle, self.cup_angle)[side]
        return 1.0 / (1.0 / roller + sign * math.cos(angle) / (0.5 * ring * share))

    def contacts(self, material: Material) -> tuple[LineContact, LineContact]:
        """The contacts with cone and cup in the middle of a roller.

        Parameters
        ----------
        material : Material
            Material of rollers and rings.
        """
        inner, outer = (
            LineContact(name, self.radius_at(0.0, side), material, "iso16281", self.roller_length)
            for side, name in enumerate(("inner", "outer"))
        )
        return inner, outer

    def rib_contact(self, material: Material) -> Ellipse | None:
        """The dry contact of end and rib, x the direction of sliding; None for cylinders.

        Parameters
        ----------
        material : Material
            Material of rollers and rings.
        """
        if not math.isfinite(self.end_sphere):
            return None
        hollow = self.rib_radius / math.sin(self.axis_angle - self.rib_angle)
        along = 1.0 / (1.0 / self.end_sphere - 1.0 / hollow)
        return Ellipse(along, self.end_sphere, reduced_modulus(material, material))

    def ribs(self, material: Material) -> tuple[Rib, ...]:
        """The ribs that hold a roller along its axis; none for cylinders.

        Parameters
        ----------
        material : Material
            Material of rollers and rings.
        """
        contact = self.rib_contact(material)
        if contact is None:
            return ()
        way, angle = (-1.0 if self.contact_angle < 0.0 else 1.0), self.axis_angle - self.rib_angle
        normal = way * math.cos(angle), -math.sin(angle)
        return (Rib(False, normal, way * self.rib_reach, self.rib_radius, 0.0, contact),)


def _problems(geometry: TaperedGeometry) -> list[str]:
    """Everything that is wrong with a geometry."""
    where = f"{geometry.kind} {geometry.name!r}" if isinstance(geometry.name, str) else geometry.kind
    problems = [] if isinstance(geometry.name, str) and geometry.name else [f"{where}: has no name"]
    problems += [f"{where}, label: {problem}" for problem in label_problem(geometry.label)]
    for name in ("roller_diameter", "roller_length", "pitch_diameter", "end_radius", "rib_height"):
        value = getattr(geometry, name)
        if value is None and name in ("end_radius", "rib_height"):
            continue
        if not (isinstance(value, int | float) and math.isfinite(value) and value > 0.0):
            problems.append(f"{where}, {name}: got {value!r:.60} m; allowed: finite and > 0")
    angle = geometry.contact_angle
    if not (isinstance(angle, int | float) and abs(angle) <= LARGEST_ANGLE):
        problems.append(f"{where}, contact_angle: got {angle!r:.60} rad; allowed: from -45 to 45 deg")
    count = geometry.rollers
    if not isinstance(count, int) or isinstance(count, bool) or count < 3:
        problems.append(f"{where}, rollers: got {count!r:.60}; allowed: a whole number >= 3")
    if problems:
        return problems
    room = geometry.pitch_diameter * math.sin(math.pi / count) / geometry.roller_diameter
    if room < 1.0:
        problems.append(f"{where}, rollers: got {count}, which overlap on the pitch circle; allowed: fewer or slimmer")
    if 0.5 * geometry.roller_length >= geometry.apex_distance:
        problems.append(f"{where}, roller_length: got rollers that reach the apex; allowed: shorter ones")
    elif geometry.cup_angle > 0.0:
        lever, sphere = geometry.rib_lever, geometry.end_sphere
        if not 0.0 < lever < sphere:
            problems.append(
                f"{where}, rib_height: got a contact {1e3 * lever:.4g} mm from the roller's axis; allowed: above zero "
                "and less than end_radius"
            )
        elif not sphere < geometry.rib_radius / math.sin(geometry.axis_angle - geometry.rib_angle):
            problems.append(f"{where}, end_radius: got {1e3 * sphere:.4g} mm; allowed: less than the rib's own radius")
    return problems
