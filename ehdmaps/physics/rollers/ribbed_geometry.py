"""Cylindrical roller bearings whose ribs carry axial load: NJ, NCF and NNCF one way, NUP both ways.

A force along the axis goes from a rib of the inner ring through the roller to the rib of the outer ring on the other
side. Both lean on the ends of the roller, one above its axis and one below: a couple, which tilts the roller and which
the raceways hold by loads off its middle. N and NU have ribs on one ring only. NNCF have three ribs on the inner ring
and one at an end of the outer ring: the row there carries axial load, the other one is that of an N.

Ends of rollers are spheres around points of their axes, and ribs are cones that open, as those of tapered rollers.
Catalogues do not tell them: `OPENING` and `RIB_SHARE` stand for them.

References
----------
SKF, Rolling bearings, Single row cylindrical roller bearings: dynamic axial load carrying capacity.
"""

from __future__ import annotations

import dataclasses
import math
import re
from dataclasses import dataclass, field
from typing import ClassVar

from ehdmaps.errors import InputError
from ehdmaps.physics.bearing import BearingGeometry
from ehdmaps.physics.catalogue import boundary, designated
from ehdmaps.physics.designations.clearance import ClearanceRange
from ehdmaps.physics.designations.reader import ROLLERS, plain_name
from ehdmaps.physics.point.ellipse import Ellipse
from ehdmaps.physics.rollers.tapered_geometry import Rib, TaperedGeometry
from ehdmaps.physics.solids import Material, reduced_modulus

OPENING = math.radians(0.5)
"""Angle of ribs to the plane across the axis, where no radius of the ends is given: an assumption [rad]."""

WAYS = ("both", "+x", "-x")
"""Ways in which the ribs carry a force on the inner ring."""

LARGEST_SHARE = 0.5
"""Largest axial over radial load of single row cylindrical roller bearings, SKF."""

_TYPES = {"NUP": "both", "NJ": "+x", "NCF": "+x", "NNCF": "+x"}
_MM = 1e-3


@dataclass(frozen=True)
class RibbedGeometry(TaperedGeometry):
    """A cylindrical roller bearing with ribs on both rings, as a tapered one without contact angle.

    Attributes
    ----------
    carries : str
        Way in which an axial force on the inner ring is carried: one of `WAYS`.
    axial_clearance : float
        Way of the inner ring between its ends, where both carry [m]; half of it beside the middle for one way too.
    diametral_clearance : float
        Clearance between rollers and raceways [m].
    row_distance : float or None
        Distance of the middles of two rows of `rollers` each, of which the one at the outer ring's rib carries axial
        load [m]; None for one row.
    clearance_range : ClearanceRange or None
        What it may be by the designation; no part of what makes bearings equal. None where it is stated.

    Raises
    ------
    InputError
        With every problem of the geometry.

    Notes
    -----
    Other attributes are those of `TaperedGeometry`, with a contact angle of zero.

    Examples
    --------
    >>> bearing = RibbedGeometry("NUP", 10e-3, 15e-3, 60e-3, 14, 0.0)
    >>> round(bearing.rib_lever, 6), round(bearing.end_sphere, 3)
    (0.00375, 0.43)
    """

    clearance_field: ClassVar[str] = "diametral_clearance"
    kind: ClassVar[str] = "ribbed bearing"
    carries: str = "both"
    axial_clearance: float = 0.0
    diametral_clearance: float = 0.0
    row_distance: float | None = None
    clearance_range: ClearanceRange | None = field(default=None, compare=False)

    def __post_init__(self) -> None:
        where, problems = f"{self.kind} {self.name!r}", []
        if self.contact_angle != 0.0:
            raise InputError(f"{where}, contact_angle: got {self.contact_angle!r:.60} rad; allowed: 0")
        super().__post_init__()
        if self.carries not in WAYS:
            problems.append(f"{where}, carries: got {self.carries!r:.60}; allowed: {', '.join(WAYS)}")
        for name in ("axial_clearance", "diametral_clearance"):
            value = getattr(self, name)
            if not (isinstance(value, int | float) and math.isfinite(value)):
                problems.append(f"{where}, {name}: got {value!r:.60} m; allowed: a finite number")
        if not 0.0 < self.rib_lever < self.end_sphere:
            problems.append(
                f"{where}, rib_height, end_radius: got a contact {self.rib_lever / _MM:.4g} mm from the roller's axis "
                f"on a sphere of {self.end_sphere / _MM:.4g} mm; allowed: above zero and within the sphere"
            )
        if problems:
            raise InputError(problems)

    def carries_along(self, way: float) -> bool:
        """Tell whether ribs carry a force on the inner ring along x, `way` > 0, or along -x."""
        return self.carries in ("both", "+x" if way > 0.0 else "-x")

    @property
    def row_places(self) -> tuple[float, ...]:
        """See `TaperedGeometry.row_places`: an outer ring with one rib has it at its end, in the way it carries."""
        if self.row_distance is None:
            return (0.0,)
        place = 0.5 * self.row_distance * (-1.0 if self.carries == "-x" else 1.0)
        return place, -place

    @property
    def rolling_elements(self) -> int:
        """Number of its rollers, of all rows."""
        return self.rollers * len(self.row_places)

    @property
    def ways(self) -> str:
        """Way in which an axial force on the inner ring is carried, in words."""
        return {"both": "both ways", "+x": "along x", "-x": "along -x"}[self.carries]

    @property
    def raceway_play(self) -> float:
        """Distance of a roller in the middle of its play from either raceway, where nothing has moved [m]."""
        return 0.25 * self.diametral_clearance

    @property
    def end_sphere(self) -> float:
        """Radius of the sphere of the ends [m]."""
        return self.rib_lever / math.sin(OPENING) if self.end_radius is None else self.end_radius

    def ribs(self, material: Material) -> tuple[Rib, ...]:
        """The ribs that hold a roller along its axis, of the inner ring and of the outer one on the other side.

        Parameters
        ----------
        material : Material
            Material of rollers and rings.
        """
        found, sine = [], math.sin(self.rib_angle)
        for way, name in ((1.0, "+x"), (-1.0, "-x")):
            if self.carries not in ("both", name):
                continue
            for outer, side in ((False, 1.0), (True, -1.0)):
                radius = 0.5 * self.pitch_diameter - side * self.rib_lever
                # inner ribs open as cones that are convex, outer ones are hollow
                along = 1.0 / (1.0 / self.end_sphere + side * sine / radius)
                contact = Ellipse(along, self.end_sphere, reduced_modulus(material, material))
                normal = way * math.cos(self.rib_angle), sine
                lever = side * way * self.rib_reach
                play = 0.25 * self.axial_clearance * math.cos(self.rib_angle)
                found.append(Rib(outer, normal, lever, radius, play, contact))
        return tuple(found)


def with_ribs(bearing: BearingGeometry, carries: str = "both", axial_clearance: float = 0.0) -> RibbedGeometry:
    """A cylindrical roller bearing with ribs on both rings.

    Parameters
    ----------
    bearing : BearingGeometry
        Raceways, rollers, diametral clearance.
    carries : str
        Way in which an axial force on the inner ring is carried: one of `WAYS`.
    axial_clearance : float
        Way of the inner ring between its ends [m].
    """
    return RibbedGeometry(
        bearing.name,
        bearing.roller_diameter,
        bearing.roller_length,
        bearing.pitch_diameter,
        bearing.rollers,
        0.0,
        label=bearing.label,
        estimated=bearing.estimated,
        carries=carries,
        axial_clearance=axial_clearance,
        diametral_clearance=bearing.diametral_clearance,
        row_distance=bearing.row_distance,
        clearance_range=bearing.clearance_range,
        spelled=bearing.spelled,
    )


def ribbed_way(designation: str) -> str:
    """Way in which the ribs of a bearing carry a force on its inner ring, by its designation; empty for none.

    Parameters
    ----------
    designation : str
        Such as "NJ308"; one way is +x, until the bearing is turned round.

    Examples
    --------
    >>> ribbed_way("NUP 210 ECP"), ribbed_way("NJ308"), ribbed_way("NU210")
    ('both', '+x', '')
    """
    match = re.match("|".join(_TYPES), plain_name(designation, ROLLERS))
    return _TYPES[match.group()] if match else ""


def ribbed_estimate(
    designation: str, diametral_clearance: float | None = None, axial_clearance: float = 0.0
) -> RibbedGeometry:
    """A bearing NJ, NUP, NCF or NNCF by its designation.

    Parameters
    ----------
    designation : str
        What `ehdmaps.physics.catalogue.designated` takes, of type NJ, NUP, NCF or NNCF.
    diametral_clearance : float, optional
        [m]; that of the designation if left out.
    axial_clearance : float
        [m].

    Raises
    ------
    InputError
        For bearings without ribs on both rings.

    Examples
    --------
    >>> ribbed_estimate("NJ308").carries
    '+x'
    """
    way = ribbed_way(designation)
    if not way:
        raise InputError(f"bearing designation: got {designation!r:.60}; {NO_RIBS}")
    bearing = designated(designation)
    if diametral_clearance is not None:
        bearing = bearing.with_clearance(diametral_clearance)
    return with_ribs(bearing, way, axial_clearance)


NO_RIBS = (
    "allowed for axial loads: balls, tapered rollers, NJ, NUP, NCF and NNCF; N, NU, NN and NNU have ribs on one ring "
    "only, needles none"
)
"""Why a bearing carries no axial load."""


def mirrored_ribs(geometry: RibbedGeometry) -> RibbedGeometry:
    """The same bearing turned round.

    Parameters
    ----------
    geometry : RibbedGeometry
        The bearing.
    """
    return dataclasses.replace(geometry, carries={"+x": "-x", "-x": "+x"}.get(geometry.carries, geometry.carries))


def axial_limit(designation: str) -> float | None:
    """Largest constant axial load of a catalogue, lest ribs break [N]; None where the bearing is not in the table.

    0.0045 D^1.5 in series 2, 0.0023 D^1.7 in others, in kN with the outside diameter D in mm. Oil, heat and speed may
    allow less.

    Parameters
    ----------
    designation : str
        Such as "NJ308".

    Examples
    --------
    >>> [round(axial_limit(name)) for name in ("NUP210", "NJ308")]
    [3842, 4830]
    """
    entry = boundary(designation)
    if entry is None or not entry.series:
        return None
    outside = entry.outside_diameter / _MM
    return float(1e3 * (0.0045 * outside**1.5 if entry.series == "2" else 0.0023 * outside**1.7))
