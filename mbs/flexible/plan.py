"""What a finite-element body is made from, as plain data: a reduced file, or matrices and how to reduce them.

Nothing is computed here, and no file is opened but to see that it is there: `mbs.flexible.carry_out` does the work.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from types import MappingProxyType
from typing import Literal, get_args

from ehdmaps.errors import InputError
from ehdmaps.inputs import check_input
from mbs.flexible.number_table import check_file
from mbs.model.body import FREEDOMS

FORMATS = ("calculix", "matrix-market", "abaqus")

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
    """Which matrices are reduced, and how.

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

    def __post_init__(self) -> None:
        object.__setattr__(self, "interfaces", MappingProxyType(dict(self.interfaces)))
        object.__setattr__(self, "points", MappingProxyType(dict(self.points)))

    @property
    def files(self) -> tuple[Path, ...]:
        """All files that are read for it."""
        named = (self.source, self.stiffness, self.mass, self.dofs, self.mesh)
        return tuple(path for path in named if path is not None)

    def file_problems(self) -> list[str]:
        """Say which of the files are not there, or too long; they are not read."""
        problems: list[str] = []
        for path in self.files:
            try:
                check_file(path)
            except InputError as error:
                problems += error.problems
        return problems


def check_reduced(path: Path) -> None:
    """Raise InputError if there is no such file, or its name is that of another kind; it is not read."""
    check_reduced_suffix(path)
    check_input(path, LONGEST_REDUCED, "a file written by mbs reduce")


def check_reduced_suffix(path: Path) -> None:
    """Raise InputError if a file has another kind of name."""
    if path.suffix not in REDUCED_SUFFIXES:
        raise InputError(f"{path}: got the ending {path.suffix!r}; allowed: {', '.join(REDUCED_SUFFIXES)}")
