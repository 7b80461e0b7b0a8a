"""A finite-element body as plain data: its files, how they are reduced, how it is turned, what it carries.

Nothing is computed here, and no file is opened but to see that it is there: `mbs.flexible.carry_out` does the work.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Literal, get_args

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import InputError, Problems
from ehdmaps.inputs import check_input
from mbs.flexible.number_table import check_file
from mbs.frozen import frozen
from mbs.model.body import FREEDOMS, Body, Inertia, lever_arm

AXES = ("x", "y", "z")
_WHOLE = 1e-13
"""A sine this close to a whole number is one: angles in degrees read back with 15 digits."""


@dataclass(frozen=True)
class Turn:
    """A turn of a body about an axis of the system.

    Attributes
    ----------
    about : {"x", "y", "z"}
        The axis.
    angle : float
        Angle by the right-hand rule [rad].

    Raises
    ------
    InputError
        For another axis, or an angle that is not finite.
    """

    about: str
    angle: float

    def __post_init__(self) -> None:
        problems = Problems()
        if self.about not in AXES:
            problems.append(f"rotation, about: got {self.about!r:.40}; allowed: {', '.join(AXES)}")
        if not math.isfinite(self.angle):
            problems.append(f"rotation, angle: got {self.angle!r} rad; allowed: finite")
        problems.check()

    @property
    def matrix(self) -> FloatArray:
        """Matrix of the turn, shape (3, 3); that of a quarter turn has zeros and ones alone."""
        cosine, sine = _snapped(math.cos(self.angle)), _snapped(math.sin(self.angle))
        first, second = {"x": (1, 2), "y": (2, 0), "z": (0, 1)}[self.about]
        matrix = np.eye(3)
        matrix[first, first] = matrix[second, second] = cosine
        matrix[first, second], matrix[second, first] = -sine, sine
        return matrix


def rotation_of(turns: Sequence[Turn]) -> FloatArray:
    """Matrix of some turns, the first one first, shape (3, 3).

    Parameters
    ----------
    turns : sequence of Turn
        Turns about the axes of the system, which stay where they are.

    Examples
    --------
    >>> quarter = math.pi / 2.0
    >>> (rotation_of([Turn("z", quarter), Turn("x", quarter)]) @ [1.0, 0.0, 0.0]).tolist()
    [0.0, 0.0, 1.0]
    """
    matrix = np.eye(3)
    for turn in turns:
        matrix = turn.matrix @ matrix
    return matrix


def _snapped(value: float) -> float:
    """A sine or cosine without the round-off of quarter turns."""
    whole = float(round(value))
    return whole if abs(value - whole) < _WHOLE else value


@dataclass(frozen=True)
class Attached:
    """A rigid part on a frame.

    Attributes
    ----------
    frame : str
        Name of the frame.
    inertia : Inertia
        Mass and moments of inertia; the offset is that of the centre of mass from the frame, along x.
    """

    frame: str
    inertia: Inertia


def attach(body: Body, parts: Sequence[Attached]) -> Body:
    """The body with rigid parts fixed to its frames; they add mass, and stiffen nothing.

    Parameters
    ----------
    body : Body
        The reduced body. Modes that it was reduced to stay its coordinates, so parts much heavier than what they sit on
        ask for a higher cut-off.
    parts : sequence of Attached
        Parts on frames whose six displacements are known.

    Raises
    ------
    InputError
        For frames that the body does not have.
    """
    problems = Problems(
        f"body {body.name!r}, attached: got the frame {part.frame!r}; allowed: {', '.join(body.frames)}"
        for part in parts
        if part.frame not in body.frames
    )
    problems.check()
    mass, gyroscopic = body.mass.copy(), body.gyroscopic.copy()
    for part in parts:
        m, polar, transverse = part.inertia.mass, part.inertia.polar, part.inertia.transverse
        transform = lever_arm((part.inertia.offset, 0.0, 0.0)) @ body.frames[part.frame].transform
        mass += transform.T @ np.diag([m, m, m, polar, transverse, transverse]) @ transform
        about_y, about_z = transform[4], transform[5]
        gyroscopic += polar * (np.outer(about_y, about_z) - np.outer(about_z, about_y))
    return replace(body, mass=mass, gyroscopic=gyroscopic)


FORMATS = ("calculix", "matrix-market", "abaqus", "nastran")

NASTRAN_NAMES = ("KAAX", "MAAX")
"""Names of stiffness and mass as Nastran gives them to a reduced part."""

UNIT_SYSTEMS = ("SI", "mm-t-s")
"""N, m, kg, s; or N, mm, tonne, s, as finite-element models are often made."""

REDUCED_SUFFIXES = (".nc", ".npz")
"""Endings of the files of reduced bodies."""

LONGEST_REDUCED = 1_000_000_000
"""Bytes of such a file."""

TOLERANCE = 1e-4
"""How far off its surface a node of an interface may lie, if nothing else is said [m]."""

Kind = Literal["rigid", "averaging"]
KINDS: tuple[str, ...] = get_args(Kind)

Triple = tuple[float, float, float]


@dataclass(frozen=True)
class NodeList:
    """Nodes by their numbers."""

    numbers: tuple[int, ...]


@dataclass(frozen=True)
class CylinderSurface:
    """Nodes on a cylindrical surface about an axis through the place of the interface.

    Attributes
    ----------
    axis : (float, float, float)
        Direction of the axis, of any length.
    diameter : float
        [m].
    begin, end : float
        Ends along the axis, from the place [m].
    tolerance : float
        How far off the surface a node may lie [m].
    """

    axis: Triple
    diameter: float
    begin: float
    end: float
    tolerance: float = TOLERANCE


@dataclass(frozen=True)
class PlaneSurface:
    """Nodes in a plane through the place of the interface.

    Attributes
    ----------
    axis : (float, float, float)
        Normal of the plane, of any length.
    diameter : float
        Nodes are taken up to this diameter about the place [m]; infinite for all of the plane.
    tolerance : float
        How far off the plane a node may lie [m].
    """

    axis: Triple
    diameter: float = math.inf
    tolerance: float = TOLERANCE


Surface = NodeList | CylinderSurface | PlaneSurface


@dataclass(frozen=True)
class PlannedInterface:
    """An interface before its nodes are found.

    Attributes
    ----------
    position : (float, float, float)
        Place of the interface [m].
    surface : NodeList, CylinderSurface or PlaneSurface
        Surface on which its nodes are.
    kind : {"rigid", "averaging"}
        Whether the nodes follow the place, or the place their mean.
    freedoms : tuple of str
        Freedoms of the place that become coordinates.
    """

    position: Triple
    surface: Surface
    kind: Kind = "averaging"
    freedoms: tuple[str, ...] = FREEDOMS


PlannedPoint = PlannedInterface | Triple | int
"""Where a body is observed: a surface whose mean is taken, a place [m], or a node number."""


@dataclass(frozen=True)
class ReductionPlan:
    """Choice of the matrices that are reduced, and how.

    Attributes
    ----------
    form : str
        One of FORMATS.
    stiffness, mass, mesh : Path
        Files of the matrices and the mesh.
    dofs : Path or None
        File that says what the rows of the matrices are.
    units : str
        One of UNIT_SYSTEMS.
    cutoff : float
        Highest frequency of the modes that are kept [Hz].
    interfaces : mapping of str to PlannedInterface
        Places where forces act, in the order of the coordinates.
    points : mapping of str to PlannedInterface, (float, float, float) or int
        Places where the body is observed.
    source : Path or None
        The file that says all this, if it is one of its own.
    names : (str, str)
        Names of stiffness and mass in their files, of the format nastran.
    """

    form: str
    stiffness: Path
    mass: Path
    mesh: Path
    dofs: Path | None
    units: str
    cutoff: float
    interfaces: Mapping[str, PlannedInterface] = field(hash=False)
    points: Mapping[str, PlannedPoint] = field(default_factory=dict, hash=False)
    source: Path | None = None
    names: tuple[str, str] = NASTRAN_NAMES

    def __post_init__(self) -> None:
        object.__setattr__(self, "interfaces", frozen(self.interfaces))
        object.__setattr__(self, "points", frozen(self.points))

    @property
    def files(self) -> tuple[Path, ...]:
        """All files that are read for it."""
        named = (self.source, self.stiffness, self.mass, self.dofs, self.mesh)
        return tuple(path for path in named if path is not None)

    def file_problems(self) -> list[str]:
        """Say which of the files are not there, or too long; they are not read."""
        problems = Problems()
        for path in self.files:
            with problems:
                check_file(path)
        return problems


def check_reduced(path: Path) -> None:
    """Raise InputError if there is no such file, or its name is that of another kind; it is not read."""
    check_reduced_suffix(path)
    check_input(path, LONGEST_REDUCED, "a file written by mbs reduce")


def check_reduced_suffix(path: Path) -> None:
    """Raise InputError if a file has another kind of name."""
    if path.suffix not in REDUCED_SUFFIXES:
        raise InputError(f"{path}: got the ending {path.suffix!r}; allowed: {', '.join(REDUCED_SUFFIXES)}")
