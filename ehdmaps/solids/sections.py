"""Dimensions of the parts that the finite elements mesh: roller, rings and the seats of the rings."""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass, fields
from typing import Literal

from ehdmaps.errors import InputError
from ehdmaps.physics.bearing import BearingGeometry
from ehdmaps.physics.catalogue import boundary
from ehdmaps.physics.solids import STEEL, Material

Seat = Literal["elastic", "rigid"]
SEATS: tuple[Seat, ...] = ("elastic", "rigid")

HOUSING_RATIO = 1.5
"""Outer diameter of a housing over that of the bearing, where none is given."""

THINNEST_SHARE = 0.02
"""Least thickness of a ring or of the wall of a roller over the roller's diameter: what a mesh still resolves."""


@dataclass(frozen=True)
class Sections:
    """Roller and rings of a bearing in the plane across its axis, and their length.

    Attributes
    ----------
    roller_diameter, roller_bore : float
        D and the diameter of a hollow roller's bore [m]; bore 0 for a solid roller.
    roller_length : float
        Effective length L [m]; the plane model does not use it.
    inner_raceway_diameter, outer_raceway_diameter : float
        Nominal raceway diameters [m].
    bore, outside_diameter : float
        Boundary diameters of the bearing [m], where the rings end. Ribs are left out.
    rollers : int
        Number of rollers.
    seat : {"elastic", "rigid"}
        What both rings are fixed to: shaft and housing of the same material, or rigid surfaces.
    shaft_bore : float
        Diameter of the bore of the shaft [m]; 0 for a solid shaft. An elastic seat has it.
    housing_diameter : float
        Outer diameter of the housing [m], which is held there. An elastic seat has it.
    material : Material
        Material of all bodies.

    Raises
    ------
    InputError
        With every dimension that does not fit.
    """

    roller_diameter: float
    roller_length: float
    inner_raceway_diameter: float
    outer_raceway_diameter: float
    bore: float
    outside_diameter: float
    rollers: int
    seat: Seat
    shaft_bore: float
    housing_diameter: float
    roller_bore: float = 0.0
    material: Material = STEEL

    def __post_init__(self) -> None:
        problems = list(self._problems())
        if problems:
            raise InputError(problems)

    def _problems(self) -> list[str]:
        """All that is impossible about the dimensions."""
        lengths = {field.name: getattr(self, field.name) for field in fields(self) if field.name not in _NO_LENGTHS}
        problems = [
            f"solids, {name}: got {value!r} m; allowed: finite and {'>= 0' if name in _MAY_BE_ZERO else '> 0'}"
            for name, value in lengths.items()
            if not (math.isfinite(value) and (value > 0.0 or (value == 0.0 and name in _MAY_BE_ZERO)))
        ]
        if self.seat not in SEATS:
            problems.append(f"solids, seat: got {self.seat!r}; allowed: {', '.join(SEATS)}")
        if problems:
            return problems
        least = 2.0 * THINNEST_SHARE * self.roller_diameter
        walls = [
            ("roller_bore", self.roller_bore, "roller_diameter", self.roller_diameter),
            ("bore", self.bore, "inner_raceway_diameter", self.inner_raceway_diameter),
            ("outer_raceway_diameter", self.outer_raceway_diameter, "outside_diameter", self.outside_diameter),
            ("shaft_bore", self.shaft_bore, "bore", self.bore),
            ("outside_diameter", self.outside_diameter, "housing_diameter", self.housing_diameter),
        ]
        return [
            f"solids, {inner}: got {a!r} m with the {outer} {b!r} m; allowed: smaller by {least:.4g} m or more"
            for inner, a, outer, b in walls
            if b - a < least
        ]

    def record(self) -> dict[str, object]:
        """Everything that defines the sections, for provenance; SI units."""
        return asdict(self)


_NO_LENGTHS = ("rollers", "seat", "material")
_MAY_BE_ZERO = ("roller_bore", "shaft_bore")


def sections_of(
    bearing: BearingGeometry,
    material: Material = STEEL,
    *,
    bore: float | None = None,
    outside_diameter: float | None = None,
    roller_bore: float = 0.0,
    seat: Seat = "elastic",
    shaft_bore: float = 0.0,
    housing_diameter: float | None = None,
) -> Sections:
    """Sections of a bearing.

    Parameters
    ----------
    bearing : BearingGeometry
        Rollers and raceways.
    material : Material
        Material of all bodies.
    bore, outside_diameter : float, optional
        Boundary diameters of the bearing [m]; those of its designation by ISO 15 if left out.
    roller_bore, seat, shaft_bore
        See `Sections`.
    housing_diameter : float, optional
        Outer diameter of the housing [m]; `HOUSING_RATIO` times the outside diameter if left out.

    Raises
    ------
    InputError
        If dimensions do not fit, or bore and outside diameter are neither given nor known.

    Examples
    --------
    >>> nu308 = sections_of(BearingGeometry.named("NU308"))
    >>> round(1e3 * nu308.bore), round(1e3 * nu308.outside_diameter)
    (40, 90)
    """
    if bore is None or outside_diameter is None:
        known = boundary(bearing.name)
        if known is None:
            raise InputError(
                f"solids: got no bore and outside_diameter of the bearing {bearing.name!r}, whose designation is not "
                "known; give both, see the bearing's catalogue"
            )
        bore = known.bore if bore is None else bore
        outside_diameter = known.outside_diameter if outside_diameter is None else outside_diameter
    return Sections(
        roller_diameter=bearing.roller_diameter,
        roller_length=bearing.roller_length,
        inner_raceway_diameter=bearing.inner_raceway_diameter,
        outer_raceway_diameter=bearing.outer_raceway_diameter,
        bore=bore,
        outside_diameter=outside_diameter,
        rollers=bearing.rollers,
        roller_bore=roller_bore,
        seat=seat,
        shaft_bore=shaft_bore,
        housing_diameter=HOUSING_RATIO * outside_diameter if housing_diameter is None else housing_diameter,
        material=material,
    )
