"""Stiffness of eight-node bricks with incompatible modes, the element C3D8I of CalculiX."""

from __future__ import annotations

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.physics.solids import Material

CORNERS = np.array(
    [(-1, -1, -1), (1, -1, -1), (1, 1, -1), (-1, 1, -1), (-1, -1, 1), (1, -1, 1), (1, 1, 1), (-1, 1, 1)], dtype=float
)
"""Local coordinates of the nodes, in the order of CalculiX."""


def brick_stiffness(positions: FloatArray, material: Material) -> FloatArray:
    """Stiffness of bricks, (e, 24, 24) [N/m]; freedoms x, y, z of node after node.

    Besides the eight trilinear shape functions each element bends by the modes 1 - xi^2, which are its own and are
    eliminated; they are corrected so that even strains are exact.

    Parameters
    ----------
    positions : array (e, 8, 3)
        Nodes of the elements [m].
    material : Material
        E and nu.

    References
    ----------
    R. L. Taylor, P. J. Beresford, E. L. Wilson, A non-conforming element for stress analysis, International Journal for
    Numerical Methods in Engineering 10 (1976) 1211-1219.
    """
    elastic = _elasticity(material)
    middle = np.einsum("ni,enj->eij", _slopes(np.zeros(3)), positions)
    inverse_middle, volume_middle = np.linalg.inv(middle), np.linalg.det(middle)
    count = len(positions)
    own, mixed, modes = np.zeros((count, 24, 24)), np.zeros((count, 24, 9)), np.zeros((count, 9, 9))
    for place in CORNERS / np.sqrt(3.0):
        slopes = _slopes(place)
        jacobian = np.einsum("ni,enj->eij", slopes, positions)
        volume = np.linalg.det(jacobian)
        strain = _strains(np.einsum("eji,ni->enj", np.linalg.inv(jacobian), slopes))
        bent = _strains(np.einsum("eji,ni->enj", inverse_middle, np.diag(-2.0 * place)))
        bent *= (volume_middle / volume)[:, None, None]
        weighted = volume[:, None, None] * np.swapaxes(strain, 1, 2)
        own += weighted @ (elastic @ strain)
        mixed += weighted @ (elastic @ bent)
        modes += (volume[:, None, None] * np.swapaxes(bent, 1, 2)) @ (elastic @ bent)
    return np.asarray(own - mixed @ np.linalg.solve(modes, np.swapaxes(mixed, 1, 2)))


def _slopes(place: FloatArray) -> FloatArray:
    """Derivatives of the eight shape functions by the local coordinates, (8, 3)."""
    factors = 1.0 + CORNERS * place
    return 0.125 * CORNERS * np.stack([factors[:, [1, 2, 0]][:, i] * factors[:, [2, 0, 1]][:, i] for i in range(3)], 1)


def _strains(gradients: FloatArray) -> FloatArray:
    """Strains xx, yy, zz, xy, yz, xz by the freedoms, (e, 6, 3 n), from gradients (e, n, 3)."""
    count, nodes, _ = gradients.shape
    found = np.zeros((count, 6, nodes, 3))
    for row, axis in enumerate((0, 1, 2)):
        found[:, row, :, axis] = gradients[..., axis]
    for row, (first, second) in enumerate(((0, 1), (1, 2), (0, 2)), start=3):
        found[:, row, :, first] = gradients[..., second]
        found[:, row, :, second] = gradients[..., first]
    return found.reshape(count, 6, 3 * nodes)


def _elasticity(material: Material) -> FloatArray:
    """Stresses by strains, (6, 6) [Pa]."""
    e, nu = material.youngs_modulus, material.poisson_ratio
    found = np.zeros((6, 6))
    found[:3, :3] = e * nu / ((1.0 + nu) * (1.0 - 2.0 * nu))
    shear = 0.5 * e / (1.0 + nu)
    found[range(3), range(3)] += 2.0 * shear
    found[range(3, 6), range(3, 6)] = shear
    return found
