"""Finite-element bodies for the tests of flexible bodies: blocks of bricks, assembled by scikit-fem."""

from __future__ import annotations

import functools

import numpy as np
import skfem
from scipy import io, sparse
from skfem.helpers import dot
from skfem.models.elasticity import lame_parameters, linear_elasticity

from mbs.flexible.finite_elements import FiniteElementModel
from mbs.flexible.reduction import Interface, nodes_in_plane

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


def spring(k=1e6, m=1.0):
    """Two nodes with three displacements each, joined by springs along x, y, z."""
    one = np.eye(3)
    return {
        "stiffness": sparse.csc_array(k * np.block([[one, -one], [-one, one]])),
        "mass": sparse.csc_array(m * np.eye(6)),
        "nodes": np.array([1, 1, 1, 2, 2, 2]),
        "directions": np.array([0, 1, 2, 0, 1, 2]),
        "numbers": np.array([1, 2]),
        "positions": np.array([[0.0, 0.0, 0.0], [0.1, 0.0, 0.0]]),
    }


def upper(matrix, labels=None):
    """Lines of the upper half, as CalculiX writes them, or with labels as Abaqus does."""
    rows, columns = np.nonzero(np.triu(matrix))
    if labels is None:
        return "".join(f"{i + 1} {j + 1}  {matrix[i, j]:.17e}\n" for i, j in zip(rows, columns, strict=True))
    pairs = zip(rows, columns, strict=True)
    return "".join(
        f"{labels[i][0]},{labels[i][1]}, {labels[j][0]},{labels[j][1]}, {matrix[i, j]:.17e}\n" for i, j in pairs
    )


def written(folder):
    """A block in the files of every format, in mm, tonne, s for Abaqus; nodes with numbers of their own."""
    model = block(elements=(2, 1, 1))
    labels = [(int(n) * 10, int(d) + 1) for n, d in zip(model.nodes, model.directions, strict=True)]
    k, m = model.stiffness.toarray(), model.mass.toarray()
    (folder / "b.sti").write_text(upper(k))
    (folder / "b.mas").write_text(upper(m))
    (folder / "b.dof").write_text("".join(f"{n}.{d}\n" for n, d in labels))
    (folder / "dofs.txt").write_text("# node direction\n" + "".join(f"{n} {d}\n" for n, d in labels))
    io.mmwrite(folder / "k.mtx", sparse.coo_array(k), symmetry="symmetric", precision=17)
    io.mmwrite(folder / "m.mtx", sparse.coo_array(m), symmetry="general", precision=17)
    (folder / "k_abaqus.mtx").write_text("** STIFFNESS\n" + upper(k / 1e3, labels))
    (folder / "m_abaqus.mtx").write_text(upper(m / 1e3, labels))
    for name, factor in (("m", 1.0), ("mm", 1e3)):
        lines = [
            f"{10 * n}, " + ", ".join(f"{factor * x:.17g}" for x in p)
            for n, p in zip(model.numbers, model.positions, strict=True)
        ]
        (folder / f"{name}.inp").write_text(
            "*HEADING\n*NODE, NSET=ALL\n" + "\n".join(lines) + "\n** a comment\n*ELEMENT, TYPE=C3D8\n1, 2, 3\n"
        )
    return folder, model
