"""A mesh of second-order tetrahedra as arrays."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ehdmaps.arrays import FloatArray, IntArray
from ehdmaps.errors import InputError

_NODES = 10
_FACES = ((0, 2, 1, 6, 5, 4), (0, 1, 3, 4, 8, 7), (1, 2, 3, 5, 9, 8), (0, 3, 2, 7, 9, 6))
"""Nodes of the faces, seen from outside: three corners, then the nodes on the edges 1-2, 2-3, 1-3 of the face."""

_PARTS = ((0, 3, 5), (1, 4, 3), (2, 5, 4), (3, 4, 5))
"""The four triangles into which its nodes divide a face."""

_EDGES = ((0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3))
"""Ends of the edges on which nodes 5 to 10 of an element lie: the order of CalculiX."""


@dataclass(frozen=True, eq=False)
class Mesh:
    """Nodes and second-order tetrahedra.

    Attributes
    ----------
    positions : array, shape (nodes, 3)
        [m]; node numbers count from 1 in this order.
    elements : array of int, shape (elements, 10)
        Indices into `positions`, in the order of CalculiX' C3D10: four corners, then the nodes on the edges 1-2, 2-3,
        1-3, 1-4, 2-4, 3-4.

    Raises
    ------
    InputError
        For arrays that are no such mesh.
    """

    positions: FloatArray
    elements: IntArray

    def __post_init__(self) -> None:
        problems = []
        if self.positions.ndim != 2 or self.positions.shape[1] != 3 or not np.isfinite(self.positions).all():
            problems.append(f"mesh, positions: got {self.positions.shape}; allowed: (nodes, 3), all finite")
        if self.elements.ndim != 2 or self.elements.shape[1] != _NODES or not self.elements.size:
            problems.append(f"mesh, elements: got {self.elements.shape}; allowed: (elements, {_NODES})")
        elif not problems and not np.array_equal(np.unique(self.elements), np.arange(len(self.positions))):
            problems.append("mesh, elements: got indices that are not those of all nodes; allowed: each node is used")
        if problems:
            raise InputError(problems)

    @cached_property
    def surface(self) -> IntArray:
        """Faces of one element only, shape (faces, 6): corners, seen from outside, then the nodes on the edges."""
        faces = np.concatenate([self.elements[:, list(face)] for face in _FACES])
        _, first, count = np.unique(np.sort(faces[:, :3], axis=1), axis=0, return_index=True, return_counts=True)
        return np.asarray(faces[first[count == 1]])

    @cached_property
    def volume(self) -> float:
        """Volume [m3], with curved edges."""
        jacobians, weights = self._jacobians()
        return float((jacobians @ weights).sum())

    def least_quality(self) -> float:
        """Smallest ratio of least to largest volume of an element, from its map; <= 0 if one is turned inside out."""
        jacobians, _ = self._jacobians()
        return float((jacobians.min(axis=1) / jacobians.max(axis=1)).min())

    def near_height(self, height: float, tolerance: float = 1e-6) -> IntArray:
        """Indices of the nodes at z = `height` [m]."""
        return np.flatnonzero(np.abs(self.positions[:, 2] - height) <= tolerance)

    def areas(self, nodes: IntArray) -> FloatArray:
        """Areas [m2] that some nodes stand for in the faces between them, shape of `nodes`; zero for one in no face."""
        faces = self.surface[np.isin(self.surface, nodes).all(axis=1)]
        triangles = np.concatenate([faces[:, list(part)] for part in _PARTS])
        corners = self.positions[triangles]
        normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        shares = np.zeros(len(self.positions))
        np.add.at(shares, triangles, (np.linalg.norm(normal, axis=1) / 6.0)[:, None])
        return np.asarray(shares[nodes])

    def _jacobians(self) -> tuple[FloatArray, FloatArray]:
        """Volume ratios at the integration points, shape (elements, points) [m3], and the weights of the points."""
        places, weights = _quadrature()
        gradients = np.stack([_gradients(place) for place in places])
        jacobian = np.einsum("qni,enj->eqij", gradients, self.positions[self.elements])
        return np.asarray(np.linalg.det(jacobian), dtype=np.float64), weights


def _quadrature() -> tuple[FloatArray, FloatArray]:
    """Points and weights on the unit tetrahedron: Gauss rules of a cube whose one side is drawn to a point.

    They are exact for the volume of a curved second-order tetrahedron, whose Jacobian is a cubic polynomial.
    """
    x, w = np.polynomial.legendre.leggauss(3)
    x, w = 0.5 * (x + 1.0), 0.5 * w
    a, b, c = (part.ravel() for part in np.meshgrid(x, x, x, indexing="ij"))
    weights = np.einsum("i,j,k->ijk", w, w, w).ravel() * (1.0 - a) ** 2 * (1.0 - b)
    return np.stack([a, b * (1.0 - a), c * (1.0 - a) * (1.0 - b)], axis=1), weights


def _gradients(place: FloatArray) -> FloatArray:
    """Derivatives of the ten shape functions by the three local coordinates, shape (10, 3)."""
    share = np.array([1.0 - place.sum(), *place])
    slope = np.vstack([-np.ones(3), np.eye(3)])
    corners = (4.0 * share - 1.0)[:, None] * slope
    edges = [4.0 * (share[i] * slope[j] + share[j] * slope[i]) for i, j in _EDGES]
    return np.vstack([corners, *edges])
