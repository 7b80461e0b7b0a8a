"""Designs of the shipped housings: dimensions, material, bearing seats, feet and places of sensors.

No drawing of the machines is published. All dimensions here are assumptions: those of the bearings and gears are
given, walls, feet and heights are chosen as a designer of such a machine would choose them. None is tuned to a
frequency. Cover, joints, screws and outer rings are left out: each housing is one piece.

Frequencies of the shipped meshes are 1 to 2 % too high, as ``--convergence`` shows: the edges of the clamped feet and
the corners between the walls are sharp, and there the mesh converges slowly.

Axes: x along the shafts, z up; the origin is on the axis of the (first) shaft, midway between its bearings.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from ehdmaps.errors import InputError
from ehdmaps.physics.solids import STEEL, Material
from ehdmaps.units import closest

Place = tuple[float, float, float]

CAST_IRON = Material(youngs_modulus=110e9, poisson_ratio=0.26, density=7200.0)
"""EN-GJL-250; EN 1561 gives 103 to 118 GPa, 0.26 and 7200 kg/m3 for it."""


@dataclass(frozen=True)
class Seat:
    """Cylindrical bore that holds the outer ring of a bearing; its axis is parallel to x.

    Attributes
    ----------
    centre : tuple of float
        [m].
    diameter, width : float
        Diameter and width of the outer ring [m].
    """

    centre: Place
    diameter: float
    width: float


@dataclass(frozen=True)
class GearboxShape:
    """Box around a pair of gears on two parallel shafts; lengths in m.

    Attributes
    ----------
    centre_distance : float
        Distance between the shafts, along y.
    span : float
        Distance between the bearings of a shaft.
    seat_diameter, seat_width : float
        Outer rings of the bearings; the bosses around the seats are as wide.
    boss_diameter : float
        Outer diameter of the bosses.
    end_wall, side_wall, bottom, top : float
        Thickness of the walls.
    inner_y, inner_z : tuple of float
        Limits of the inside of the box, from and to.
    foot_length, foot_reach, foot_height : float
        Feet along x, outwards from the side wall, and thickness.
    foot_below : float
        How far the feet stand below the bottom.
    gusset : float
        Thickness of the ribs between feet and side walls; they are as high as the feet reach.
    """

    centre_distance: float
    span: float
    seat_diameter: float
    seat_width: float
    boss_diameter: float
    end_wall: float
    side_wall: float
    bottom: float
    top: float
    inner_y: tuple[float, float]
    inner_z: tuple[float, float]
    foot_length: float
    foot_reach: float
    foot_height: float
    foot_below: float
    gusset: float

    @property
    def half_length(self) -> float:
        """Outside of the end walls along x."""
        return 0.5 * (self.span + self.end_wall)

    @property
    def outer_y(self) -> tuple[float, float]:
        """Outside of the side walls."""
        return self.inner_y[0] - self.side_wall, self.inner_y[1] + self.side_wall

    @property
    def outer_z(self) -> tuple[float, float]:
        """Underside of the bottom and upside of the top."""
        return self.inner_z[0] - self.bottom, self.inner_z[1] + self.top

    @property
    def ground(self) -> float:
        """Height of the undersides of the feet."""
        return self.outer_z[0] - self.foot_below


@dataclass(frozen=True)
class PedestalShape:
    """Two pedestals on a base plate with four feet; lengths in m.

    Attributes
    ----------
    span : float
        Distance between the seats, along x.
    seat_diameter, seat_width : float
        Outer rings of the bearings; the pedestals are as thick as the rings are wide.
    head_diameter : float
        Outer diameter of the pedestals around the seats.
    base_width : float
        Width of a pedestal along y at the plate; its flanks are tangents of the head.
    axis_height : float
        Height of the axis above the plate.
    plate_length, plate_width, plate_thickness : float
        Base plate along x, y, z.
    foot_size, foot_height : float
        Square pads under the corners of the plate.
    gusset_length, gusset_height, gusset_thickness : float
        Triangular rib at the inner side of each pedestal, along x, z, y.
    """

    span: float
    seat_diameter: float
    seat_width: float
    head_diameter: float
    base_width: float
    axis_height: float
    plate_length: float
    plate_width: float
    plate_thickness: float
    foot_size: float
    foot_height: float
    gusset_length: float
    gusset_height: float
    gusset_thickness: float

    @property
    def ground(self) -> float:
        """Height of the undersides of the feet."""
        return -self.axis_height - self.plate_thickness - self.foot_height


@dataclass(frozen=True)
class Housing:
    """A housing of a shipped system.

    Attributes
    ----------
    name : str
        Name of the file, without its ending.
    title : str
        Title for figures and messages.
    shape : GearboxShape or PedestalShape
        Dimensions [m].
    material : Material
        Material of the whole housing.
    seats : mapping of str to Seat
        Interfaces of the reduced body.
    sensors : mapping of str to tuple of float
        Places on the surface that are observed [m].
    size : float
        Size of the elements of the shipped file [m].
    cutoff : float
        Modes with the seats held are kept up to here in the shipped file [Hz].
    """

    name: str
    title: str
    shape: GearboxShape | PedestalShape
    material: Material
    seats: Mapping[str, Seat]
    sensors: Mapping[str, Place]
    size: float
    cutoff: float

    @property
    def ground(self) -> float:
        """Height of the undersides of the feet [m]; all nodes there are clamped."""
        return self.shape.ground


def _gearbox() -> Housing:
    """Housing of the gearbox: module 4.5 mm, 21 and 23 teeth, so 99 mm between the shafts; four NU308."""
    shape = GearboxShape(
        centre_distance=99e-3,  # 4.5 mm * (21 + 23)/2
        span=160e-3,
        seat_diameter=90e-3,
        seat_width=23e-3,
        boss_diameter=116e-3,
        end_wall=18e-3,
        side_wall=12e-3,
        bottom=12e-3,
        top=12e-3,
        # Tips of the gears: 51.75 mm around the first shaft, 56.25 mm around the second one; 8 mm clear of the walls,
        # more below, for the oil.
        inner_y=(-60e-3, 164e-3),
        inner_z=(-72e-3, 64e-3),
        foot_length=44e-3,
        foot_reach=40e-3,
        foot_height=20e-3,
        foot_below=6e-3,
        gusset=14e-3,
    )
    middle = 0.5 * (shape.inner_y[0] + shape.inner_y[1])
    foot = shape.half_length - 0.25 * (shape.foot_length - shape.gusset)  # beside the rib
    half = 0.5 * shape.span
    seats = {
        f"bearing_{shaft}_{side}": Seat((sign * half, y, 0.0), shape.seat_diameter, shape.seat_width)
        for shaft, y in ((1, 0.0), (2, shape.centre_distance))
        for side, sign in (("left", -1.0), ("right", 1.0))
    }
    sensors: dict[str, Place] = {
        "sensor_top": (0.0, middle, shape.outer_z[1]),
        "sensor_wall_left": (-shape.half_length, 0.5 * shape.centre_distance, 55e-3),
        "sensor_side": (0.0, shape.outer_y[1], 0.0),
        "sensor_foot": (foot, shape.outer_y[1] + 0.75 * shape.foot_reach, shape.ground + shape.foot_height),
    }
    return Housing("gearbox_housing", "Gearbox housing", shape, CAST_IRON, seats, sensors, 16e-3, cutoff=8e3)


def _pedestals(name: str, title: str, shape: PedestalShape, size: float, cutoff: float) -> Housing:
    """Two pedestals on a plate, of steel."""
    half = 0.5 * shape.span
    seats = {
        side: Seat((sign * half, 0.0, 0.0), shape.seat_diameter, shape.seat_width)
        for side, sign in (("left", -1.0), ("right", 1.0))
    }
    sensors: dict[str, Place] = {
        "sensor_left": (-half, 0.0, 0.5 * shape.head_diameter),
        "sensor_right": (half, 0.0, 0.5 * shape.head_diameter),
        "sensor_plate": (0.0, 0.0, -shape.axis_height),
    }
    return Housing(name, title, shape, STEEL, seats, sensors, size, cutoff)


def _nu308() -> Housing:
    """Housing of two NU308, 140 mm apart."""
    shape = PedestalShape(
        span=140e-3,
        seat_diameter=90e-3,
        seat_width=23e-3,
        head_diameter=130e-3,
        base_width=150e-3,
        axis_height=90e-3,
        plate_length=230e-3,
        plate_width=190e-3,
        plate_thickness=20e-3,
        foot_size=45e-3,
        foot_height=10e-3,
        gusset_length=35e-3,
        gusset_height=38e-3,
        gusset_thickness=16e-3,
    )
    # The stiff pedestals have few modes below 8 kHz, and one just above that shares in the low frequencies.
    return _pedestals("nu308_housing", "Housing of two NU308", shape, 13e-3, cutoff=12e3)


def _n1014() -> Housing:
    """Housing of two N1014, 300 mm apart."""
    shape = PedestalShape(
        span=300e-3,
        seat_diameter=110e-3,
        seat_width=20e-3,
        head_diameter=154e-3,
        base_width=180e-3,
        axis_height=110e-3,
        plate_length=390e-3,
        plate_width=230e-3,
        plate_thickness=25e-3,
        foot_size=55e-3,
        foot_height=12e-3,
        gusset_length=50e-3,
        gusset_height=48e-3,
        gusset_thickness=18e-3,
    )
    return _pedestals("n1014_housing", "Housing of two N1014", shape, 16e-3, cutoff=8e3)


HOUSINGS: Mapping[str, Housing] = {entry.name: entry for entry in (_gearbox(), _nu308(), _n1014())}
"""The shipped housings by name."""


def housing(name: Any) -> Housing:
    """Find a shipped housing.

    Raises
    ------
    InputError
        For a name that none has.
    """
    if not isinstance(name, str) or name not in HOUSINGS:
        words = tuple(HOUSINGS)
        hint = closest(name, words) if isinstance(name, str) else ""
        raise InputError(f"housing: got {name!r:.60}{hint}; allowed: {', '.join(words)}")
    return HOUSINGS[name]
