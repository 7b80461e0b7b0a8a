"""Finite-element bodies for the tests of flexible bodies: blocks of bricks, assembled by scikit-fem."""

from __future__ import annotations

import functools

import numpy as np
import skfem
from skfem.helpers import dot
from skfem.models.elasticity import lame_parameters, linear_elasticity

from mbs.flexible.finite_elements import FiniteElementModel
from mbs.flexible.spiders import Interface, nodes_in_plane

YOUNG, POISSON, DENSITY = 2.1e11, 0.3, 7850.0
SIZE = (0.2, 0.05, 0.04)


@functools.cache
def block(elements=(4, 2, 2), size=SIZE, fixed=False):
    """A steel block along x from the origin, of trilinear bricks; `fixed` takes the nodes at x = 0 away."""
    mesh = skfem.MeshHex.init_tensor(*(np.linspace(0.0, s, n + 1) for s, n in zip(size, elements, strict=True)))
    basis = skfem.Basis(mesh, skfem.ElementVector(skfem.ElementHex1()), intorder=3)
    stiffness = skfem.asm(linear_elasticity(*lame_parameters(YOUNG, POISSON)), basis)
    mass = skfem.asm(skfem.BilinearForm(lambda u, v, w: DENSITY * dot(u, v)), basis)
    nodes, directions = np.zeros(basis.N, dtype=int), np.zeros(basis.N, dtype=int)
    for direction in range(3):
        nodes[basis.nodal_dofs[direction]] = np.arange(1, mesh.p.shape[1] + 1)
        directions[basis.nodal_dofs[direction]] = direction
    kept = np.flatnonzero(mesh.p[0][nodes - 1] > 1e-9) if fixed else np.arange(basis.N)
    return FiniteElementModel(
        stiffness[kept][:, kept],
        mass[kept][:, kept],
        nodes[kept],
        directions[kept],
        np.arange(1, mesh.p.shape[1] + 1),
        mesh.p.T,
    )


def ends(model, kind="averaging", **keywords):
    """Interfaces of the end faces of a block; that at x = 0 only if it is free."""
    far = model.positions.max(axis=0)
    return {
        name: Interface(
            np.array([x, 0.5 * far[1], 0.5 * far[2]]),
            nodes_in_plane(model, (x, 0.0, 0.0), (1.0, 0.0, 0.0), 1e-9),
            kind,
            **keywords,
        )
        for name, x in (("left", 0.0), ("right", far[0]))
        if model.position(int(model.nodes[0]))[0] == 0.0 or x > 0.0
    }


def rigid_motion(model, about=(0.0, 0.0, 0.0)):
    """Displacement (N, 6) of all degrees of freedom when the body moves as one."""
    motion = np.zeros((model.size, 6))
    place = {int(number): position for number, position in zip(model.numbers, model.positions, strict=True)}
    for row, (node, direction) in enumerate(zip(model.nodes, model.directions, strict=True)):
        x, y, z = place[int(node)] - np.array(about)
        motion[row, direction] = 1.0
        motion[row, 3:] = [[0.0, z, -y], [-z, 0.0, x], [y, -x, 0.0]][direction]
    return motion
