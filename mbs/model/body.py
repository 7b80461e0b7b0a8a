"""Bodies: mass, gyroscopic, damping and stiffness blocks in coordinates of their own, and the frames on them.

A body moves a little about a reference position, in which all frames are parallel to the axes of the system; its spin
about x is prescribed and no coordinate. A rigid body has up to six coordinates, a flexible one brings its reduced
blocks, with as many coordinates as its reduction has. Whoever assembles a system sees blocks and frames only.

Tilts are small rotations: terms of second order in tilts and displacements are left out. A coordinate theta_x is a
small rotation on top of the prescribed spin.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Literal, get_args

import numpy as np

from ehdmaps.arrays import FloatArray, IntArray
from ehdmaps.errors import InputError, Problems
from ehdmaps.physics.solids import STEEL

Freedom = Literal["x", "y", "z", "theta_x", "theta_y", "theta_z"]
FREEDOMS: tuple[str, ...] = get_args(Freedom)
"""Freedoms of a rigid body and of a frame, in the order of a bearing's pose."""

CENTRE = "centre"
"""Name of the frame that every rigid body has at its position."""


@dataclass(frozen=True, eq=False)
class Frame:
    """A place on a body where something is attached.

    Attributes
    ----------
    position : array, shape (3,)
        Place in the system [m].
    transform : array, shape (6, n)
        Small displacement of the frame (three translations [m], three rotations [rad]) by the body's coordinates.
    """

    position: FloatArray
    transform: FloatArray


@dataclass(frozen=True, eq=False)
class Skin:
    """Surface of a body as triangles, for pictures of its shape.

    Attributes
    ----------
    positions : array, shape (p, 3)
        Places in the system, or from the origin of the body [m].
    transforms : array, shape (p, 3, n)
        Their displacement by the coordinates of the body [m].
    triangles : array of int, shape (t, 3)
        Indices of the corners among the places.
    """

    positions: FloatArray
    transforms: FloatArray
    triangles: IntArray


@dataclass(frozen=True, eq=False)
class Body:
    """Blocks of the equations of motion of one body: M q'' + (D + speed G) q' + K q = forces.

    Attributes
    ----------
    name : str
        Name for messages and results.
    coordinates : tuple of str
        Names of the coordinates; the order of all arrays.
    units : tuple of str
        "m", "rad" or "1" (a modal coordinate).
    mass, damping, stiffness : array, shape (n, n)
        M, D, K; symmetric, in the units of the coordinates.
    gyroscopic : array, shape (n, n)
        G, skew, per speed of the body [1/(rad/s)].
    frames : mapping of str to Frame
        Places at which springs, bearings, loads and sensors attach.
    spin : float
        Prescribed speed of the body about x as a multiple of the system's.
    line : tuple of Frame
        Places one after the other along a shaft, for pictures of its shape; none of other bodies.
    skin : Skin or None
        Surface of the body, for pictures of its shape; None where that is not known.
    gravity : array, shape (n, 3), or None
        Load on the coordinates by gravity along x, y, z of 1 m/s2 [kg or kg m]; None where `mbs.model.system` finds it.
    cutoff : float
        Frequency above which modes of the body are left out [Hz]; infinite where none are.
    left_out : array, shape (n, n), or None
        What these add to the mass where they follow slowly, by the square of the frequency, see
        `mbs.linearised.reduction` [s2 times the unit of the mass]; None where that is not known.
    """

    name: str
    coordinates: tuple[str, ...]
    units: tuple[str, ...]
    mass: FloatArray
    gyroscopic: FloatArray
    damping: FloatArray
    stiffness: FloatArray
    frames: Mapping[str, Frame] = field(default_factory=dict)
    spin: float = 0.0
    line: tuple[Frame, ...] = ()
    skin: Skin | None = None
    gravity: FloatArray | None = None
    cutoff: float = math.inf
    left_out: FloatArray | None = None

    @property
    def size(self) -> int:
        """Number of coordinates."""
        return len(self.coordinates)


@dataclass(frozen=True)
class Inertia:
    """A part of a rigid body, symmetric about its own axis, which is parallel to x.

    Attributes
    ----------
    mass : float
        [kg], > 0.
    polar, transverse : float
        Moments of inertia about x and about y or z, through the part's centre of mass [kg m2]; 0 of a point mass.
    offset : float
        Place of the centre of mass along x, from the position of the body [m].

    Raises
    ------
    InputError
        For values no body can have.
    """

    mass: float
    polar: float
    transverse: float
    offset: float = 0.0

    def __post_init__(self) -> None:
        problems = Problems()
        if not (math.isfinite(self.mass) and self.mass > 0.0):
            problems.append(f"inertia, mass: got {self.mass!r} kg; allowed: finite and > 0")
        for name in ("polar", "transverse"):
            value = getattr(self, name)
            if not (math.isfinite(value) and value >= 0.0):
                problems.append(f"inertia, {name}: got {value!r} kg m2; allowed: finite and >= 0")
        if not problems and self.polar > 2.0 * self.transverse * (1.0 + 1e-9):
            problems.append(
                f"inertia, polar: got {self.polar!r} kg m2; allowed: at most twice the transverse {self.transverse!r}; "
                "no body has more"
            )
        if not math.isfinite(self.offset):
            problems.append(f"inertia, offset: got {self.offset!r} m; allowed: finite")
        problems.check()

    @classmethod
    def cylinder(
        cls, begin: float, end: float, diameter: float, bore: float = 0.0, density: float = STEEL.density
    ) -> Inertia:
        """Hollow cylinder from `begin` to `end` along x [m], of outer diameter and bore [m] and density [kg/m3].

        Parameters
        ----------
        begin : float
            Left end along x [m].
        end : float
            Right end [m].
        diameter : float
            Outer diameter [m].
        bore : float
            Diameter of the bore [m].
        density : float
            [kg/m3].

        Examples
        --------
        >>> round(Inertia.cylinder(-0.108, 0.108, 0.04).mass, 3)
        2.131

        Raises
        ------
        InputError
            If it has no volume.
        """
        if not (end > begin and diameter > bore >= 0.0 and density > 0.0):
            raise InputError(
                f"cylinder: got x from {begin!r} to {end!r} m, diameter {diameter!r} m, bore {bore!r} m, density "
                f"{density!r} kg/m3; allowed: from < to, 0 <= bore < diameter, density > 0"
            )
        length, outer, inner = end - begin, 0.5 * diameter, 0.5 * bore
        mass = density * math.pi * (outer**2 - inner**2) * length
        polar = 0.5 * mass * (outer**2 + inner**2)
        return cls(mass, polar, 0.5 * polar + mass * length**2 / 12.0, 0.5 * (begin + end))


def rigid_body(
    name: str,
    parts: Sequence[Inertia],
    freedoms: Sequence[str],
    position: Sequence[float] = (0.0, 0.0, 0.0),
    frames: Mapping[str, Sequence[float]] | None = None,
    spin: float = 0.0,
) -> Body:
    """A rigid body with chosen freedoms.

    Parameters
    ----------
    name : str
        Name of the body.
    parts : sequence of Inertia
        What it is made of; the centre of mass need not be at the position.
    freedoms : sequence of str
        Some of x, y, z, theta_x, theta_y, theta_z; the others are held.
    position : sequence of float, shape (3,)
        Place of the frame "centre" [m].
    frames : mapping, optional
        Further frames, from the position [m].
    spin : float
        Speed about x as a multiple of the system's.

    Raises
    ------
    InputError
        With everything that `rigid_problems` finds.
    """
    problems = Problems(rigid_problems(name, parts, freedoms, position, frames or {}, spin))
    problems.check()
    free = [FREEDOMS.index(freedom) for freedom in freedoms]
    mass, gyroscopic = np.zeros((6, 6)), np.zeros((6, 6))
    for part in parts:
        lever = lever_arm((part.offset, 0.0, 0.0))
        m = part.mass
        mass += lever.T @ np.diag([m, m, m, part.polar, part.transverse, part.transverse]) @ lever
        # The angular momentum I_p Omega along the tilted axis (1, theta_z, -theta_y) turns with the tilt.
        gyroscopic[4, 5] += part.polar
        gyroscopic[5, 4] -= part.polar
    places = {CENTRE: (0.0, 0.0, 0.0), **(frames or {})}
    here = np.asarray(position, dtype=np.float64)
    size = len(free)
    return Body(
        name=name,
        coordinates=tuple(freedoms),
        units=tuple("rad" if freedom.startswith("theta") else "m" for freedom in freedoms),
        mass=mass[np.ix_(free, free)],
        gyroscopic=gyroscopic[np.ix_(free, free)],
        damping=np.zeros((size, size)),
        stiffness=np.zeros((size, size)),
        frames={
            key: Frame(here + np.asarray(place, dtype=np.float64), lever_arm(place)[:, free])
            for key, place in places.items()
        },
        spin=spin,
        gravity=mass[free, :3],
    )


def rigid_problems(
    name: str,
    parts: Sequence[Inertia],
    freedoms: Sequence[str],
    position: Sequence[float],
    frames: Mapping[str, Sequence[float]],
    spin: float,
) -> list[str]:
    """Everything about a rigid body that does not fit together, in words.

    Parameters
    ----------
    name : str
        Name of the body.
    parts : sequence of Inertia
        What it is made of; at least one.
    freedoms : sequence of str
        Names of FREEDOMS, each once.
    position : sequence of float, shape (3,)
        Position of the frame "centre" [m].
    frames : mapping of str to sequence of float, shape (3,)
        Further frames, from the position [m]; none called "centre".
    spin : float
        Speed about x as a multiple of the system's.
    """
    problems = [
        f"body {name!r}, freedoms: got {freedom!r}; allowed: {', '.join(FREEDOMS)}, each once"
        for index, freedom in enumerate(freedoms)
        if freedom not in FREEDOMS or freedom in freedoms[:index]
    ]
    if not freedoms:
        problems.append(f"body {name!r}, freedoms: got none; allowed: some of {', '.join(FREEDOMS)}; or use ground")
    if not parts:
        problems.append(f"body {name!r}, parts: got none; allowed: at least one part with a mass")
    problems += [
        f"body {name!r}, freedoms: got {freedom}, about which its parts have no moment of inertia; allowed: parts with "
        "one; leave the freedom out, or state the moments"
        for freedom in FREEDOMS[3:]
        if parts and freedom in freedoms and not _turning_inertia(parts, freedom) > 0.0
    ]
    if CENTRE in frames:
        problems.append(f"body {name!r}, frames: {CENTRE!r} is there already, at the position; choose another name")
    problems += [
        f"body {name!r}, {where}: got {place!r:.80} m; allowed: three finite numbers"
        for where, place in (("position", position), *((f"frames {key}", place) for key, place in frames.items()))
        if not (len(place) == 3 and all(math.isfinite(value) for value in place))
    ]
    if not math.isfinite(spin):
        problems.append(f"body {name!r}, spin: got {spin!r}; allowed: finite")
    return problems


def _turning_inertia(parts: Sequence[Inertia], freedom: str) -> float:
    """Moment of inertia of parts about an axis through the centre of mass of all [kg m2]."""
    if freedom == "theta_x":
        return sum(part.polar for part in parts)
    mass = sum(part.mass for part in parts)
    centre = sum(part.mass / mass * part.offset for part in parts)
    return sum(part.transverse + part.mass * (part.offset - centre) ** 2 for part in parts)


def lever_arm(offset: Sequence[float]) -> FloatArray:
    """Displacement (6,) of a place at `offset` [m] on a rigid body by that of the body, as a matrix (6, 6)."""
    x, y, z = offset
    matrix = np.eye(6)
    matrix[:3, 3:] = [[0.0, z, -y], [-z, 0.0, x], [y, -x, 0.0]]
    return matrix
