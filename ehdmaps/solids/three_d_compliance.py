"""How far the surface of a body of bricks yields under forces on it: its layers are eliminated one after the other."""

from __future__ import annotations

import numpy as np
from scipy.linalg import cho_factor, cho_solve

from ehdmaps.arrays import BoolArray, FloatArray
from ehdmaps.physics.solids import Material
from ehdmaps.solids.three_d_elements import CORNERS, brick_stiffness
from ehdmaps.solids.three_d_mesh import Block

_NEAR = np.flatnonzero(np.repeat(CORNERS[:, 1] < 0.0, 3))
_FAR = np.flatnonzero(np.repeat(CORNERS[:, 1] > 0.0, 3))


def surface_compliance(block: Block, material: Material) -> tuple[FloatArray, FloatArray]:
    """Displacements in z of the nodes that may touch by forces in z on them, (n, n) [m/N], of a quarter model.

    Layers are eliminated from the free end to the middle of the roller, where the plane is one of symmetry or of
    antisymmetry: only the last layer differs.

    Parameters
    ----------
    block : Block
        The body; nodes are counted layer by layer.
    material : Material
        Material of the body.

    Returns
    -------
    even, odd : array (n, n)
        Compliance under loads that are even along the roller, and under those that are odd: nodes of the middle do
        not move then.
    """
    layers, nx, nz, _ = block.positions.shape
    size = 3 * nx * nz
    diagonal = [np.zeros((size, size)) for _ in range(layers)]
    off = [np.zeros((0, 0))] * (layers - 1)
    elements = block.layer_elements()
    freedoms = (3 * elements[:, :, None] + np.arange(3)).reshape(len(elements), 24)
    near, far = freedoms[:, _NEAR], freedoms[:, _FAR] - size
    for j in range(layers - 1):
        stiffness = brick_stiffness(block.positions[j : j + 2].reshape(-1, 3)[elements], material)
        upper = np.zeros((size, size))
        for target, rows, columns, r, c in (
            (diagonal[j], near, near, _NEAR, _NEAR),
            (diagonal[j + 1], far, far, _FAR, _FAR),
            (upper, near, far, _NEAR, _FAR),
        ):
            np.add.at(target, (rows[:, :, None], columns[:, None, :]), stiffness[:, r][:, :, c])
        off[j] = upper
    answers = []
    held = block.held.reshape(layers, size)
    odd = np.ones((nx * nz, 3), dtype=bool)
    # Along the roller one node is held, where the body stands: else it could float.
    odd[:, 1] = False
    odd[np.flatnonzero(block.held[0, 0, :, 2]), 1] = True
    touching = np.zeros((layers, nx * nz, 3), dtype=bool)
    touching[..., 2] = block.touching.reshape(layers, -1)
    counts = touching.sum(axis=(1, 2))
    starts = np.concatenate([[0], np.cumsum(counts)])
    factors, rights = _eliminate(diagonal, off, ~held, touching.reshape(layers, size))
    for middle in (~held[0], ~odd.ravel()):
        free = [middle, *(~row for row in held[1:])]
        answers.append(_back(diagonal, off, free, touching.reshape(layers, size), starts, factors, rights))
    return answers[0], answers[1]


def _loads(free: BoolArray, touching: BoolArray) -> FloatArray:
    """Unit forces on the nodes of a layer that may touch, a column each, in its free freedoms."""
    found = np.zeros((free.size, int(touching.sum())))
    found[np.flatnonzero(touching), np.arange(found.shape[1])] = 1.0
    return found[free]


def _reduced(
    diagonal: FloatArray, upper: FloatArray, free: BoolArray, next_free: BoolArray, factor: tuple[FloatArray, bool]
) -> FloatArray:
    """Stiffness of a layer with all beyond it eliminated."""
    between = upper[np.ix_(free, next_free)]
    return np.asarray(diagonal[np.ix_(free, free)] - between @ cho_solve(factor, between.T, check_finite=False))


def _right(
    upper: FloatArray,
    free: BoolArray,
    next_free: BoolArray,
    factor: tuple[FloatArray, bool],
    beyond: FloatArray,
    touching: BoolArray,
) -> FloatArray:
    """Loads of a layer: its own columns, then what those beyond bring into it."""
    brought = -upper[np.ix_(free, next_free)] @ cho_solve(factor, beyond, check_finite=False)
    return np.hstack([_loads(free, touching), brought])


def _eliminate(
    diagonal: list[FloatArray], off: list[FloatArray], free: BoolArray, touching: BoolArray
) -> tuple[list[tuple[FloatArray, bool]], list[FloatArray]]:
    """Factors and loads of all layers but the first, from the last one on, listed by layer (index 0 is the second)."""
    last = len(diagonal) - 1
    factors = [cho_factor(diagonal[last][np.ix_(free[last], free[last])], lower=True, check_finite=False)]
    rights = [_loads(free[last], touching[last])]
    for j in range(last - 1, 0, -1):
        rights.insert(0, _right(off[j], free[j], free[j + 1], factors[0], rights[0], touching[j]))
        reduced = _reduced(diagonal[j], off[j], free[j], free[j + 1], factors[0])
        factors.insert(0, cho_factor(reduced, lower=True, check_finite=False))
    return factors, rights


def _back(
    diagonal: list[FloatArray],
    off: list[FloatArray],
    free: list[BoolArray],
    touching: BoolArray,
    starts: FloatArray,
    factors: list[tuple[FloatArray, bool]],
    rights: list[FloatArray],
) -> FloatArray:
    """The first layer, and back through all others."""
    total = int(starts[-1])
    right = _right(off[0], free[0], free[1], factors[0], rights[0], touching[0])
    reduced = _reduced(diagonal[0], off[0], free[0], free[1], factors[0])
    moved = cho_solve(cho_factor(reduced, lower=True, check_finite=False), right, check_finite=False)
    found = np.zeros((total, total))
    for j in range(len(diagonal)):
        if j > 0:
            loads = np.zeros((int(free[j].sum()), total))
            loads[:, int(starts[j]) :] = rights[j - 1]
            loads -= off[j - 1][np.ix_(free[j - 1], free[j])].T @ moved
            moved = cho_solve(factors[j - 1], loads, check_finite=False)
        here = touching[j][free[j]]
        rows = np.flatnonzero(touching[j])
        seen = free[j][rows]
        found[np.arange(int(starts[j]), int(starts[j + 1]))[seen]] = moved[here]
    return found
