"""A finite-element body as its matrices: stiffness, mass, degrees of freedom, nodes; how heavy and how large it is.

A finite-element body as its matrices: stiffness, mass, what each degree of freedom is, where the nodes are.

Where the matrices come from (a file, a program, a test) is of no interest here; degrees of freedom that were fixed to
the ground are simply not in them.

How heavy and how large a finite-element body is, from its matrices and mesh alone: a wrong unit is seen there.

A body that moves without turning has the kinetic energy of its mass, whatever its elements: t' M t with t = 1 at all
displacements of one direction. A slow turn, which moves each node by theta x r, gives the first moments likewise.
Nodes that are fixed are not in the matrices: their share of the mass, and of the centre, is missing.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np
from scipy import sparse

from ehdmaps.arrays import FloatArray, IntArray
from ehdmaps.errors import InputError, Problems
from ehdmaps.extras import lacking
from mbs.flexible.plan import UNIT_SYSTEMS
from mbs.model.body import lever_arm

MOST_BY_LU = 300_000
"""Degrees of freedom up to which SuperLU factorises: of more it has no memory."""

MOST_FREEDOMS = 2_000_000
"""Degrees of freedom that are taken: of a million CHOLMOD takes gigabytes where walls are thin, more else."""

COARSER = "take a coarser mesh"

TOO_MANY = f"allowed: at most {MOST_FREEDOMS}; {COARSER}"
"""Words on what is allowed, and what to do."""


def check_size(where: str, size: int) -> None:
    """Refuse more degrees of freedom than can be reduced, before much is read.

    Parameters
    ----------
    where : str
        Source of the numbers, for messages.
    size : int
        Their number.

    Raises
    ------
    InputError
        For too many, or if there are more than SuperLU takes, and cvxopt is not installed.
    """
    if size > MOST_FREEDOMS:
        raise InputError(f"{where}: got {size} degrees of freedom; {TOO_MANY}")
    if size > MOST_BY_LU:
        Problems(lacking("large", "cvxopt", f"{where}: {size} degrees of freedom, more than {MOST_BY_LU}")).check()


_OVERREACH = 1.0 + 1e-6
"""Square of an entry over the product of its diagonals, which is at most 1 but for rounding."""

ASYMMETRY = 1e-9
"""Of the largest entry; text files of 10 digits and more stay below it."""


_LARGEST_ENTRY = 1e100
"""Magnitude beyond which an entry of a matrix in SI is damage; products of two of them are still numbers."""

_FARTHEST = 1e9
"""Distance of a node from the origin beyond which it is damage [m]."""


@dataclass(frozen=True, eq=False)
class FiniteElementModel:
    """Matrices of a body and what their rows mean.

    Attributes
    ----------
    stiffness, mass : sparse array, shape (N, N)
        K [N/m, N m/rad] and M [kg, kg m2]; symmetric.
    nodes : array of int, shape (N,)
        Node number of each degree of freedom.
    directions : array of int, shape (N,)
        0, 1, 2: displacement along x, y, z; 3, 4, 5: rotation about them.
    numbers : array of int, shape (P,)
        Nodes whose position is known.
    positions : array, shape (P, 3)
        Positions of the nodes [m].

    Raises
    ------
    InputError
        With everything that does not fit together: shapes, entries that are no numbers, matrices that are not
        symmetric, a degree of freedom without mass or that is there twice.
    """

    stiffness: sparse.csc_array
    mass: sparse.csc_array
    nodes: IntArray
    directions: IntArray
    numbers: IntArray
    positions: FloatArray
    _place: dict[int, int] = field(init=False, repr=False)
    _row: dict[tuple[int, int], int] = field(init=False, repr=False)

    def __post_init__(self) -> None:
        for name, dtype in (("nodes", np.int64), ("directions", np.int64), ("numbers", np.int64), ("positions", float)):
            object.__setattr__(self, name, np.asarray(getattr(self, name), dtype=dtype))
        problems = Problems(self._shape_problems())
        if not problems:
            for name in ("stiffness", "mass"):
                matrix = sparse.csc_array(getattr(self, name), dtype=np.float64)
                wrong = _matrix_problems(name, matrix)
                problems += wrong
                if not wrong:
                    object.__setattr__(self, name, sparse.csc_array(0.5 * (matrix + matrix.T)))
            problems += self._label_problems()
        if not problems:
            massless = np.flatnonzero(self.mass.diagonal() <= 0.0)
            unstrained = np.flatnonzero(self.stiffness.diagonal() <= 0.0)
            problems += self._list(
                "stiffness", unstrained, f"no stiffness; allowed: some for each; {self._cause(unstrained, 'stiffness')}"
            )
            problems += self._list(
                "mass",
                massless,
                f"no mass or a negative one; allowed: a mass for each; {self._cause(massless, 'mass')}",
            )
        problems.check()
        object.__setattr__(self, "_place", {int(number): k for k, number in enumerate(self.numbers)})
        labels = zip(self.nodes.tolist(), self.directions.tolist(), strict=True)
        object.__setattr__(self, "_row", {label: k for k, label in enumerate(labels)})

    @property
    def size(self) -> int:
        """Number N of degrees of freedom."""
        return int(self.nodes.size)

    def position(self, node: int) -> FloatArray:
        """Position of a node, shape (3,) [m]; KeyError if that is not known."""
        return np.asarray(self.positions[self._place[node]])

    def has_position(self, node: int) -> bool:
        """Tell whether it is known where a node is."""
        return node in self._place

    def row(self, node: int, direction: int) -> int | None:
        """Index of a degree of freedom; None if the node has none in that direction."""
        return self._row.get((node, direction))

    def _shape_problems(self) -> list[str]:
        """List problems with the shapes."""
        size = self.nodes.size
        problems = []
        if not 1 <= size <= MOST_FREEDOMS or self.nodes.ndim != 1:
            problems.append(
                f"finite-element body, nodes: got shape {self.nodes.shape}, one a degree of freedom; {TOO_MANY}"
            )
        if self.directions.shape != self.nodes.shape:
            problems.append(
                f"finite-element body, directions: got shape {self.directions.shape}; allowed: {self.nodes.shape}, as "
                "many as nodes"
            )
        for name in ("stiffness", "mass"):
            shape = getattr(self, name).shape
            if shape != (size, size):
                problems.append(
                    f"finite-element body, {name}: got shape {shape}; allowed: {(size, size)}, one row and column for "
                    "each degree of freedom"
                )
        if self.numbers.ndim != 1 or self.positions.shape != (self.numbers.size, 3):
            problems.append(
                f"finite-element body, positions: got shape {self.positions.shape}; allowed: three coordinates for "
                f"each of {self.numbers.size} numbers"
            )
        return problems

    def _label_problems(self) -> list[str]:
        """List problems with nodes, directions and positions."""
        problems = self._list(
            "directions",
            np.flatnonzero((self.directions < 0) | (self.directions > 5)),
            "got a direction that is none; allowed: 0 to 5",
        )
        labels = np.stack([self.nodes, self.directions], axis=1)
        _, first, counts = np.unique(labels, axis=0, return_index=True, return_counts=True)
        problems += self._list("nodes", first[counts > 1], "is there twice; allowed: each degree of freedom once")
        if np.unique(self.numbers).size != self.numbers.size:
            problems.append("finite-element body, numbers: a node has two positions; allowed: one for each")
        placed = np.all(np.abs(self.positions) <= _FARTHEST, axis=1)
        if not np.all(placed):
            problems.append(
                f"finite-element body, positions: got values that are no finite numbers, or too large ones, at "
                f"{named(self.numbers[~placed])}; allowed: lengths up to {_FARTHEST:g} m; check the file and its units"
            )
        return problems

    def _cause(self, rows: IntArray, name: str) -> str:
        """Cause of degrees of freedom without stiffness or mass, and what to do."""
        turns = bool(np.any(self.directions[rows] > 2))
        if name == "mass":
            return (
                "rotations of shells, beams and lumped masses have none where their mass is lumped: let the program "
                "write consistent masses (Nastran: PARAM,COUPMASS,1), or condense these rotations"
                if turns
                else "condense it"
            )
        return (
            "shells have none about their normal, nodes of solids none at all, whatever lumped mass turns with them: "
            "give some (Nastran: PARAM,K6ROT,100.), or leave the rotation out"
            if turns
            else "a lumped mass is joined to nothing: tie it to the body, or leave it out"
        )

    def _list(self, name: str, rows: IntArray, problem: str) -> list[str]:
        """A problem of some degrees of freedom; empty for none."""
        if rows.size == 0:
            return []
        shown = ", ".join(f"node {self.nodes[k]} direction {self.directions[k]}" for k in rows[:5])
        more = f" and {rows.size - 5} more" if rows.size > 5 else ""
        return [f"finite-element body, {name}: {shown}{more}: {problem}"]


class NodePositions(NamedTuple):
    """Nodes with known positions: numbers (P,), positions (P, 3) in the units of the file."""

    numbers: IntArray
    positions: FloatArray


def named(nodes: IntArray) -> str:
    """Some nodes for a message."""
    shown = ", ".join(str(node) for node in nodes[:5].tolist())
    return f"node{'s' if nodes.size > 1 else ''} {shown}" + (f" and {nodes.size - 5} more" if nodes.size > 5 else "")


def _matrix_problems(name: str, matrix: sparse.csc_array) -> list[str]:
    """List problems with the entries of a matrix."""
    if not np.all(np.isfinite(matrix.data)):
        return [f"finite-element body, {name}: got entries that are no finite numbers; allowed: finite ones"]
    if np.any(np.abs(matrix.data) > _LARGEST_ENTRY):
        return [
            f"finite-element body, {name}: got an entry of {np.max(np.abs(matrix.data)):.3g}; allowed: up to "
            f"{_LARGEST_ENTRY:g}; check the file and its units"
        ]
    largest = float(np.max(np.abs(matrix.data), initial=0.0))
    apart = float(np.max(np.abs((matrix - matrix.T).data), initial=0.0))
    if apart > ASYMMETRY * largest:
        return [
            f"finite-element body, {name}: is not symmetric: entries differ by {apart:.3g} where the largest is "
            f"{largest:.3g}; allowed: symmetric matrices, without friction, follower loads or gyroscopic terms"
        ]
    diagonal = matrix.diagonal()
    triplets = sparse.coo_array(matrix)
    between = diagonal[triplets.row] * diagonal[triplets.col]
    if np.any(diagonal < 0.0) or np.any(triplets.data**2 > between * _OVERREACH + (ASYMMETRY * largest) ** 2):
        return [
            f"finite-element body, {name}: has a negative diagonal, or entries larger than their diagonals allow, so "
            "some motion would have negative energy; allowed: positive semi-definite matrices; check signs and files"
        ]
    return []


DENSITIES = (1.0, 25e3)
"""Mean density over the box [kg/m3]: osmium has 22.6e3; a frame of rods in a large box has some kilograms."""

SIZES = (1e-3, 50.0)
"""Longest side of the box [m]."""

_FLAT = 1e-3
"""Sides of a box below this part of the longest one: plates and beams of no thickness have no density."""

_TO_SI = {"SI": (1.0, 1.0), "mm-t-s": (1e-3, 1e3)}
"""Length and mass of each system of units."""


@dataclass(frozen=True, eq=False)
class Extent:
    """Mass and size of a body.

    Attributes
    ----------
    mass : float
        Mass without the share of fixed nodes [kg].
    centre : array, shape (3,)
        Centre of that mass [m].
    lower, upper : array, shape (3,)
        Corners of the box around all nodes of the mesh [m].
    """

    mass: float
    centre: FloatArray
    lower: FloatArray
    upper: FloatArray

    @property
    def longest(self) -> float:
        """Longest side of the box [m]."""
        return float(np.max(self.upper - self.lower))

    @property
    def density(self) -> float | None:
        """Mass over the volume of the box [kg/m3]; None where the box is flat."""
        sides = self.upper - self.lower
        return float(self.mass / np.prod(sides)) if np.all(sides > _FLAT * self.longest) else None

    def warnings(self, units: str) -> tuple[str, ...]:
        """Say what no body is like, and which units would make it one.

        Parameters
        ----------
        units : str
            One of UNIT_SYSTEMS: what the files were taken for.

        Returns
        -------
        tuple of str
            One sentence; none where size and density can be.
        """
        wrong = _absurd(self.longest, self.density)
        if not wrong:
            return ()
        others = [name for name in UNIT_SYSTEMS if name != units and not _absurd(*self._as(units, name))]
        advice = "; ".join(f'units = "{name}" would give {_shown(*self._as(units, name))}' for name in others)
        return (
            f'{wrong} with units = "{units}"; allowed: {SIZES[0]:g} to {SIZES[1]:g} m, {DENSITIES[0]:g} to '
            f"{DENSITIES[1]:g} kg/m3; {advice or 'no units of this program fit: check mesh and matrices'}",
        )

    def _as(self, units: str, others: str) -> tuple[float, float | None]:
        """Longest side and density if the numbers of the files were of other units."""
        length, mass = (_TO_SI[others][k] / _TO_SI[units][k] for k in range(2))
        return self.longest * length, None if self.density is None else self.density * mass / length**3


def extent(model: FiniteElementModel) -> Extent:
    """Find mass, centre and box of a body.

    Parameters
    ----------
    model : FiniteElementModel
        The body; at least one node has a position.

    Returns
    -------
    Extent
        The centre along an axis is NaN where no displacement across it is free.
    """
    motion = np.zeros((model.size, 6))
    for row, (node, direction) in enumerate(zip(model.nodes.tolist(), model.directions.tolist(), strict=True)):
        if model.has_position(node):
            motion[row] = lever_arm(model.position(node).tolist())[direction]
        elif direction < 3:  # it moves along as the others do; of its turn nothing is known
            motion[row, direction] = 1.0
    inertia = motion.T @ (model.mass @ motion)
    masses = np.diag(inertia)[:3]
    # Force along an axis for a turn about another one, both ways: y with theta_z and z with theta_y for x.
    moments = [(1, 5, 2, 4), (2, 3, 0, 5), (0, 4, 1, 3)]
    centre = [
        (inertia[a, b] - inertia[c, d]) / (masses[a] + masses[c]) if masses[a] + masses[c] > 0.0 else np.nan
        for a, b, c, d in moments
    ]
    return Extent(
        float(np.max(masses)), np.array(centre), np.min(model.positions, axis=0), np.max(model.positions, axis=0)
    )


def _absurd(longest: float, density: float | None) -> str:
    """Size and density where one of them is that of no body; else nothing."""
    sane = SIZES[0] <= longest <= SIZES[1] and (density is None or DENSITIES[0] <= density <= DENSITIES[1])
    return "" if sane else f"got {_shown(longest, density)}"


def _shown(longest: float, density: float | None) -> str:
    """Size and density in words."""
    mean = "" if density is None else f" and {density:.3g} kg/m3 over it"
    return f"a box of {longest:.3g} m{mean}"
