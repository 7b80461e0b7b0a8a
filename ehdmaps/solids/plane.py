"""Yield of a body at a line contact: plane linear elasticity by finite elements (scikit-fem).

The load is the pressure of Hertz over a half-width b, and what comes out is its energy: the displacement of the
contact, weighted with the pressure, against what holds the body. That number is as exact as the square of the error
of the displacements, and it needs no iteration: the only nonlinearity of a line contact is its width over load, which
`ehdmaps.solids.law` finds from these numbers.

=========  ==========================================================  ================================================
body       held                                                        displacement of the contact is counted from
=========  ==========================================================  ================================================
roller     its other contact carries the same load                     the plane through its axis, half-way between
ring       its seat is fixed: the rigid seat                           the seat
housing    ring and housing are one, held at the outside               the outside of the housing
shaft      ring and shaft are one; the load is spread evenly over the  the mean displacement of the shaft's section
           section of the shaft
=========  ==========================================================  ================================================
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Literal, NamedTuple

import numpy as np

from ehdmaps.arrays import FloatArray, IntArray
from ehdmaps.extras import needs
from ehdmaps.physics.solids import Material
from ehdmaps.solids.mesh_plane import PlaneMesh

Plane = Literal["strain", "stress"]
PURPOSE = "plane elasticity of roller and rings"

_GAUSS = 12
"""Points over the part of the pressure on one edge, in the angle in which the pressure is smooth."""


class PlaneYield(NamedTuple):
    """Displacements of a body under unit loads [N/m] of several widths.

    Attributes
    ----------
    compliance : array, shape (widths,)
        Displacement of the contact along the load, weighted with the pressure, over the load [m2/N].
    surface : array, shape (widths, nodes)
        Displacement of the nodes of the raceway along the radius, towards the seat, over the load [m2/N].
    angles : array, shape (nodes,)
        Angle of these nodes from the contact [rad].
    """

    compliance: FloatArray
    surface: FloatArray
    angles: FloatArray


def body_yield(
    mesh: PlaneMesh,
    material: Material,
    half_widths: Sequence[float] | FloatArray,
    plane: Plane = "strain",
    shaft_radius: float | None = None,
    roller: bool = False,
) -> PlaneYield:
    """Solve a body for contacts of several widths.

    Parameters
    ----------
    mesh : PlaneMesh
        The body.
    material : Material
        Material of the body.
    half_widths : sequence of float or array
        Half-widths b of the contact [m].
    plane : {"strain", "stress"}
        Plane strain, a long roller; or plane stress, its ends free: a bound.
    shaft_radius : float, optional
        Radius within which the load is spread evenly [m]: a shaft; the body is held nowhere else then.
    roller : bool
        Whether the body is a quarter of a roller with its other contact loaded alike.

    Raises
    ------
    DependencyError
        If scikit-fem is missing.
    """
    with needs("solids", "scikit-fem", PURPOSE):
        import skfem
    from scipy.sparse.linalg import splu

    fe_mesh = skfem.MeshTri2(mesh.positions.T.copy(), mesh.elements.T.copy())
    basis = skfem.Basis(fe_mesh, skfem.ElementVector(skfem.ElementTriP2()), intorder=4)
    dofs = _dofs(basis, mesh)
    push = -1.0 if mesh.far < mesh.surface else 1.0
    loads = np.zeros((len(half_widths), basis.N))
    edges = _contact_edges(mesh)
    for row, half_width in zip(loads, half_widths, strict=True):
        np.add.at(row, dofs[1][edges], push * _shares(mesh.positions[edges, 0], half_width))
    on_symmetry = mesh.on_axis(0)
    fixed = [dofs[0][on_symmetry]]
    spread = np.zeros(basis.N)
    if roller:
        fixed.append(dofs[1][mesh.on_axis(1)])
    elif shaft_radius is None:
        seat = mesh.on_circle(mesh.far)
        fixed += [dofs[0][seat], dofs[1][seat]]
    else:
        within = np.flatnonzero(np.all(mesh.radii[mesh.elements] < shaft_radius * (1.0 + 1e-9), axis=1))
        shaft = skfem.Basis(fe_mesh, basis.elem, intorder=4, elements=within)
        spread = _along_y(skfem).assemble(shaft)
        spread /= spread.sum()
        loads -= 0.5 * push * spread
        fixed.append(dofs[1][np.flatnonzero(on_symmetry)[:1]])  # any one: the loads are in balance
    free = np.setdiff1d(np.arange(basis.N), np.concatenate(fixed))
    stiffness = _elasticity(skfem, material, plane).assemble(basis).tocsc()
    moved = np.zeros_like(loads)
    moved[:, free] = splu(stiffness[free][:, free]).solve(np.ascontiguousarray(loads[:, free].T)).T
    compliance = 2.0 * np.einsum("ij,ij->i", loads, moved)  # energy of both halves
    moved[:, dofs[1]] -= (moved @ spread)[:, None]
    top = np.flatnonzero(mesh.on_circle(mesh.surface))
    top = top[np.argsort(np.arctan2(*mesh.positions[top].T))]
    x, y = mesh.positions[top].T / mesh.surface
    towards = push * (moved[:, dofs[0][top]] * x + moved[:, dofs[1][top]] * y)
    return PlaneYield(compliance, towards, np.asarray(np.arctan2(x, y)))


def _elasticity(skfem: Any, material: Material, plane: Plane) -> Any:
    """Bilinear form of linear elasticity."""
    young, nu = material.youngs_modulus, material.poisson_ratio
    shear = young / (2.0 * (1.0 + nu))
    lame = young * nu / ((1.0 + nu) * (1.0 - 2.0 * nu))
    if plane == "stress":
        lame = 2.0 * lame * shear / (lame + 2.0 * shear)

    @skfem.BilinearForm
    def form(u: Any, v: Any, _: Any) -> Any:
        du, dv = u.grad, v.grad
        strain = [[0.5 * (du[i][j] + du[j][i]) for j in range(2)] for i in range(2)]
        trace = du[0][0] + du[1][1]
        work = lame * trace * (dv[0][0] + dv[1][1])
        for i in range(2):
            for j in range(2):
                work = work + 2.0 * shear * strain[i][j] * dv[i][j]
        return work

    return form


def _along_y(skfem: Any) -> Any:
    """Linear form of a force along y."""

    @skfem.LinearForm
    def form(v: Any, _: Any) -> Any:
        return v[1]

    return form


def _dofs(basis: Any, mesh: PlaneMesh) -> IntArray:
    """Freedoms of the nodes along x and y, shape (2, nodes); scikit-fem numbers them by corners, then edges."""
    dofs = np.zeros((2, len(mesh.positions)), dtype=np.int64)
    for node in range(6):
        for direction in range(2):
            dofs[direction, mesh.elements[:, node]] = basis.element_dofs[2 * node + direction]
    return dofs


def _contact_edges(mesh: PlaneMesh) -> IntArray:
    """Nodes of the edges that lie on the surface, above the axis: begin, middle, end; shape (edges, 3)."""
    edges = np.concatenate([mesh.elements[:, [0, 3, 1]], mesh.elements[:, [1, 4, 2]], mesh.elements[:, [2, 5, 0]]])
    upper = mesh.on_circle(mesh.surface) & (mesh.positions[:, 1] > 0.5 * mesh.surface)
    return np.asarray(edges[upper[edges].all(axis=1)])


def _shares(x: FloatArray, half_width: float) -> FloatArray:
    """Forces at the nodes of edges that the pressure of Hertz gives, of a load of 1 with half of it at x > 0.

    Parameters
    ----------
    x : array, shape (edges, 3)
        Places of the nodes along the surface [m]: begin, middle, end.
    half_width : float
        b [m].
    """
    # x = b sin(angle), in which the pressure times dx is smooth
    ends = np.arcsin(np.clip(np.sort(x[:, [0, 2]], axis=1) / half_width, -1.0, 1.0))
    points, weights = np.polynomial.legendre.leggauss(_GAUSS)
    middle, half = ends.mean(axis=1, keepdims=True), 0.5 * np.diff(ends, axis=1)
    angle = middle + half * points
    load = 2.0 / np.pi * np.cos(angle) ** 2 * half * weights
    place = half_width * np.sin(angle)
    shares = np.empty_like(x)
    for node in range(3):
        a, b = (other for other in range(3) if other != node)
        shape = (place - x[:, [a]]) * (place - x[:, [b]]) / ((x[:, node] - x[:, a]) * (x[:, node] - x[:, b]))[:, None]
        shares[:, node] = np.sum(load * shape, axis=1)
    return shares
