"""Interfaces of a finite-element body: a place, the nodes around it, and how the one follows the other.

rigid      u_k = q + theta x r_k           the nodes follow the place as if cast together: stiffens what they hold
averaging  sum w |u_k - q - theta x r_k|^2 -> min    the place follows the nodes in the least-squares mean: adds nothing

r_k is from the place to the node. A force on an averaging place spreads over the nodes as w_k (f + ...), so that it
strains the body as a soft pressure would; the true seat of a bearing lies between the two.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ehdmaps.arrays import FloatArray, IntArray
from ehdmaps.errors import InputError
from mbs.flexible.finite_elements import FiniteElementModel, named
from mbs.flexible.plan import KINDS, Kind
from mbs.model.body import FREEDOMS, lever_arm

_DEGENERATE = 1e-8
"""Smallest over largest eigenvalue of the nodes' moments, below which they lie on a line to rounding."""

_TRANSLATIONS = frozenset(FREEDOMS[:3])


@dataclass(frozen=True, eq=False)
class Interface:
    """A place, the nodes around it, and how the one follows the other.

    Attributes
    ----------
    position : array, shape (3,)
        Position of the place [m]; it need not be a node.
    nodes : array of int, shape (n,)
        Node numbers.
    kind : {"rigid", "averaging"}
        Whether the nodes follow the place, or the place their mean.
    freedoms : tuple of str
        Those of the place that become coordinates of the reduced body; the others are left to the body.
    weights : array, shape (n,), optional
        Weights of the nodes in the mean, such as the areas that they stand for; equal if left out.

    Raises
    ------
    InputError
        For values that no interface can have.
    """

    position: FloatArray
    nodes: IntArray
    kind: Kind = "averaging"
    freedoms: tuple[str, ...] = FREEDOMS
    weights: FloatArray | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "position", np.asarray(self.position, dtype=np.float64))
        object.__setattr__(self, "nodes", np.asarray(self.nodes, dtype=np.int64))
        object.__setattr__(self, "freedoms", tuple(self.freedoms))
        problems = []
        if self.position.shape != (3,) or not np.all(np.isfinite(self.position)):
            problems.append(f"interface, position: got {self.position!r:.80}; allowed: three finite lengths in m")
        if self.nodes.ndim != 1 or self.nodes.size == 0:
            problems.append(f"interface, nodes: got shape {self.nodes.shape}; allowed: a list of at least one node")
        elif np.unique(self.nodes).size != self.nodes.size:
            problems.append("interface, nodes: a node is there twice; allowed: each once")
        if self.kind not in KINDS:
            problems.append(f"interface, kind: got {self.kind!r:.40}; allowed: {', '.join(KINDS)}")
        wrong = [freedom for freedom in self.freedoms if freedom not in FREEDOMS]
        if wrong or not self.freedoms or len(set(self.freedoms)) < len(self.freedoms):
            problems.append(
                f"interface, freedoms: got {self.freedoms!r:.80}; allowed: some of {', '.join(FREEDOMS)}, each once"
            )
        if self.weights is not None:
            weights = np.asarray(self.weights, dtype=np.float64)
            object.__setattr__(self, "weights", weights)
            if weights.shape != self.nodes.shape or not np.all(np.isfinite(weights) & (weights > 0.0)):
                problems.append(
                    f"interface, weights: got shape {weights.shape}; allowed: a finite number > 0 for each of "
                    f"{self.nodes.size} nodes"
                )
        if problems:
            raise InputError(problems)


@dataclass(frozen=True, eq=False)
class Spider:
    """An interface in the degrees of freedom of a model.

    Attributes
    ----------
    rows : array of int, shape (s,)
        The degrees of freedom of its nodes.
    rigid : array, shape (s, 6)
        How they move with the place when all is rigid.
    mean : array, shape (6, s)
        The place's displacement as the mean of theirs; mean @ rigid is the unit matrix.
    """

    rows: IntArray
    rigid: FloatArray
    mean: FloatArray


def spider(model: FiniteElementModel, name: str, interface: Interface) -> Spider:
    """Find the degrees of freedom of an interface.

    Parameters
    ----------
    model : FiniteElementModel
        The body.
    name : str
        Name of the interface, for messages.
    interface : Interface
        A single node of a solid has translations only: then the interface has no rotations either and is at the node.

    Raises
    ------
    InputError
        If nodes have no position or no displacement in the matrices, or do not tell how the place turns.
    """
    where = f"interface {name!r}"
    unknown = [node for node in interface.nodes.tolist() if not model.has_position(node)]
    if unknown:
        raise InputError(
            f"{where}, nodes: {named(np.array(unknown))} without a position; allowed: nodes of the mesh, which has "
            f"{model.numbers.size}; check the numbers, or the mesh file"
        )
    held = [node for node in interface.nodes.tolist() if None in [model.row(node, d) for d in range(3)]]
    if held:
        raise InputError(
            f"{where}, nodes: {named(np.array(held))} without displacements in the matrices: fixed, following others "
            "by a constraint, or of no element; allowed: nodes that move freely; leave these out"
        )
    weights = np.ones(interface.nodes.size) if interface.weights is None else interface.weights
    rows, parts, weight = [], [], []
    for node, share in zip(interface.nodes.tolist(), weights.tolist(), strict=True):
        lever = lever_arm((model.position(node) - interface.position).tolist())
        for direction in range(6):
            row = model.row(node, direction)
            if row is not None:
                rows.append(row)
                parts.append(lever[direction])
                # Rotations of the nodes say nothing to the mean: that would need a length to weigh them by.
                weight.append(share if direction < 3 else 0.0)
    rigid = np.array(parts)
    if interface.kind == "rigid" and any(model.row(node, d) is not None for node in interface.nodes for d in (3, 4, 5)):
        weight = [1.0] * len(weight)
    mean = _mean(where, interface, rigid, np.array(weight))
    return Spider(np.array(rows, dtype=np.int64), rigid, mean)


def _mean(where: str, interface: Interface, rigid: FloatArray, weight: FloatArray) -> FloatArray:
    """Least-squares mean of the nodes, shape (6, s)."""
    apart = rigid[weight > 0.0]
    # Lengths in units of the spread of the nodes, so that translations and rotations compare.
    spread = float(np.sqrt(np.mean(apart[:, 3:] ** 2))) or 1.0
    scale = np.array([1.0, 1.0, 1.0, 1.0 / spread, 1.0 / spread, 1.0 / spread])
    scaled = rigid * scale
    moments = scaled.T @ (weight[:, None] * scaled)
    values = np.linalg.eigvalsh(moments)
    if values[0] > _DEGENERATE * values[-1]:
        return np.asarray(scale[:, None] * np.linalg.solve(moments, (weight[:, None] * scaled).T))
    alone = interface.nodes.size == 1 and np.max(np.abs(rigid[:, 3:])) <= 1e-9
    if alone and set(interface.freedoms) <= _TRANSLATIONS:
        return np.vstack([rigid[:, :3].T, np.zeros((3, rigid.shape[0]))])
    if interface.nodes.size == 1:
        raise InputError(
            f"{where}, nodes: got one, which does not say how the place turns; allowed: three or more that are not on "
            "a line; or freedoms x, y, z alone, with the place at the node"
        )
    raise InputError(
        f"{where}, nodes: got {interface.nodes.size} on a line, which do not say how the place turns about it; "
        "allowed: three or more that are not on a line, widely enough apart for their distance from the place"
    )


def nodes_on_cylinder(
    model: FiniteElementModel,
    point: Sequence[float],
    direction: Sequence[float],
    radius: float,
    begin: float,
    end: float,
    tolerance: float,
) -> IntArray:
    """Nodes on a cylindrical surface, such as the bore of a bearing seat.

    Parameters
    ----------
    model : FiniteElementModel
        The body.
    point, direction : sequence of float, shape (3,)
        A point on the axis [m] and the direction of the axis, of any length.
    radius : float
        [m].
    begin, end : float
        Distances from the point along the axis [m].
    tolerance : float
        How far off the surface and beyond its ends a node may lie [m].

    Returns
    -------
    array of int
        Node numbers; those that have displacements. May be empty.
    """
    axis = np.asarray(direction, dtype=np.float64)
    away = model.positions - np.asarray(point, dtype=np.float64)
    along = away @ (axis / np.linalg.norm(axis))
    across = np.sqrt(np.maximum(np.sum(away**2, axis=1) - along**2, 0.0))
    kept = (np.abs(across - radius) <= tolerance) & (along >= begin - tolerance) & (along <= end + tolerance)
    return _moving(model, kept)


def nodes_in_plane(
    model: FiniteElementModel,
    point: Sequence[float],
    normal: Sequence[float],
    tolerance: float,
    radius: float = math.inf,
) -> IntArray:
    """Nodes in the plane through a point [m] with a normal of any length, to a tolerance [m], up to a radius [m].

    Parameters
    ----------
    model : FiniteElementModel
        The finite element model.
    point : sequence of float
        A point of the plane, shape (3,) [m].
    normal : sequence of float
        Normal of the plane, of any length, shape (3,).
    tolerance : float
        Largest distance from the plane [m].
    radius : float
        Largest distance from the point [m].
    """
    unit = np.asarray(normal, dtype=np.float64)
    away = model.positions - np.asarray(point, dtype=np.float64)
    off = np.abs(away @ (unit / np.linalg.norm(unit)))
    return _moving(model, (off <= tolerance) & (np.linalg.norm(away, axis=1) <= radius + tolerance))


def nearest_node(model: FiniteElementModel, position: Sequence[float]) -> int:
    """The node with displacements that is nearest to a position [m].

    Raises
    ------
    InputError
        If no node has a position and displacements.
    """
    moving = np.isin(model.numbers, model.nodes)
    if not moving.any():
        raise InputError(
            "finite-element body: no node of the mesh has displacements in the matrices; allowed: a mesh and matrices "
            "with the same node numbers"
        )
    away = np.sum((model.positions[moving] - np.asarray(position, dtype=np.float64)) ** 2, axis=1)
    return int(model.numbers[moving][int(np.argmin(away))])


def _moving(model: FiniteElementModel, kept: np.ndarray[tuple[int], np.dtype[np.bool_]]) -> IntArray:
    """Numbers of the kept nodes that have displacements, sorted."""
    return np.sort(model.numbers[kept & np.isin(model.numbers, model.nodes)])
