"""Bricks of a roller and of a raceway: their mesh, their stiffness, and how far the surface yields under forces.

Both bodies have the same nodes where they may touch. x is across the contact, y along the roller, z up; the planes
x = 0 and y = 0 are planes of symmetry, the contact lies at z = 0.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.linalg import cho_factor, cho_solve

from ehdmaps.arrays import BoolArray, FloatArray, IntArray
from ehdmaps.physics.solids import Material

_ROLLER_SHARE = 0.96
"""Part of the radius of the roller that is meshed: columns beyond would have no height."""

_FINE_WIDTHS, _FINE_DEPTHS, _CONTACT_WIDTHS = 1.8, 1.0, 3.2
"""Up to where cells are even, across and down, and up to where surfaces may touch, in half-widths."""


@dataclass(frozen=True)
class QuarterModel:
    """Sizes of the model.

    Attributes
    ----------
    roller_diameter, roller_length : float
        D and L [m]; the roller ends in plane faces.
    raceway_diameter : float
        Diameter of the raceway, of an inner ring [m].
    race_depth, race_width, beyond : float
        Depth of the raceway's body, half its width, and how far it goes on beyond the end of the roller [m].
    half_width : float
        Half-width of the contact for which the mesh is made [m].
    """

    roller_diameter: float
    roller_length: float
    raceway_diameter: float
    race_depth: float
    race_width: float
    beyond: float
    half_width: float

    @property
    def reduced_radius(self) -> float:
        """Reduced radius of the contact [m]."""
        return 0.5 / (1.0 / self.roller_diameter + 1.0 / self.raceway_diameter)


@dataclass(frozen=True, eq=False)
class Block:
    """A body of bricks in layers along y.

    Attributes
    ----------
    positions : array (ny, nx, nz, 3)
        Nodes [m].
    held : array of bool (ny, nx, nz, 3)
        Freedoms that are held: on planes of symmetry, and in z where the body stands.
    touching : array of bool (ny, nx, nz)
        Nodes that may touch the other body.
    """

    positions: FloatArray
    held: BoolArray
    touching: BoolArray

    def layer_elements(self) -> IntArray:
        """Nodes of the elements of the first layer, (e, 8), in the order of CalculiX, numbered through both planes."""
        _, nx, nz, _ = self.positions.shape
        i, k = (part.ravel() for part in np.meshgrid(np.arange(nx - 1), np.arange(nz - 1), indexing="ij"))
        corners = [i * nz + k, (i + 1) * nz + k]
        near = [corners[0], corners[1], corners[1] + nx * nz, corners[0] + nx * nz]
        return np.stack([*near, *(corner + 1 for corner in near)], axis=1)


def quarter_meshes(model: QuarterModel, level: float) -> tuple[Block, Block]:
    """Bricks of roller and raceway.

    Parameters
    ----------
    model : QuarterModel
        The sizes.
    level : float
        Size of the elements: 1 has six in a half-width of the contact, 2 has three.
    """
    b, radius, half_length = model.half_width, 0.5 * model.roller_diameter, 0.5 * model.roller_length
    fine = b / 6.0 * level
    across = _graded(fine, _FINE_WIDTHS * b, _ROLLER_SHARE * radius, 1.0 + 0.4 * level)
    race_across = _graded(fine, _FINE_WIDTHS * b, model.race_width, 1.0 + 0.4 * level)
    along = _along(model.roller_length, level)
    on = half_length + _graded(along[-1] - along[-2], along[-1] - along[-2], model.beyond, 1.0 + 0.45 * level)[1:]
    count = int(np.searchsorted(across, _CONTACT_WIDTHS * b))
    # The same columns where both may touch.
    race_across = np.concatenate([across[:count], race_across[race_across > 1.2 * across[count - 1]]])
    roller = _block(
        across,
        along,
        lambda x: (radius - np.sqrt(radius**2 - x**2), np.full_like(x, radius)),
        _graded(fine, _FINE_DEPTHS * b, radius, 1.0 + 0.35 * level) / radius,
    )
    race_radius = 0.5 * model.raceway_diameter
    race = _block(
        race_across,
        np.concatenate([along, on]),
        lambda x: (np.sqrt(race_radius**2 - x**2) - race_radius, np.full_like(x, -model.race_depth)),
        _graded(fine, _FINE_DEPTHS * b, model.race_depth, 1.0 + 0.35 * level) / model.race_depth,
    )
    bodies = []
    for positions, surface, stands in ((roller, 0, -1), (race[:, :, ::-1], -1, 0)):
        held = np.zeros(positions.shape, dtype=bool)
        held[:, 0, :, 0], held[0, :, :, 1], held[:, :, stands, 2] = True, True, True
        touching = np.zeros(positions.shape[:3], dtype=bool)
        touching[: along.size, :count, surface] = True
        bodies.append(Block(positions, held, touching))
    return bodies[0], bodies[1]


def _block(x: FloatArray, y: FloatArray, ends: object, parts: FloatArray) -> FloatArray:
    """Nodes in columns from the surface down to where a body stands, (ny, nx, nz, 3)."""
    assert callable(ends)
    surface, ground = ends(x)
    nodes = np.empty((y.size, x.size, parts.size, 3))
    nodes[..., 0], nodes[..., 1] = x[None, :, None], y[:, None, None]
    nodes[..., 2] = surface[None, :, None] + (ground - surface)[None, :, None] * parts
    return nodes


def _graded(first: float, even: float, end: float, growth: float) -> FloatArray:
    """Places from 0 to `end`: even steps `first` up to about `even`, then growing ones."""
    count = max(round(even / first), 1)
    steps = [first] * count
    while sum(steps) < end:
        steps.append(steps[-1] * growth)
    places = np.concatenate([[0.0], np.cumsum(steps)])
    places[count:] = places[count] + (places[count:] - places[count]) * (end - places[count]) / (
        places[-1] - places[count]
    )
    return places


def _along(length: float, level: float) -> FloatArray:
    """Nodes along half a roller, from its middle: fine at its end, and where the contact under a profile ends."""
    from_end = [0.0]
    for step, until in ((0.004 * length, 0.02 * length), (0.011 * length, 0.2 * length)):
        count = max(round((until - from_end[-1]) / (step * level)), 1)
        from_end += list(from_end[-1] + (until - from_end[-1]) * np.arange(1, count + 1) / count)
    last = from_end[-1] - from_end[-2]
    rest = 0.5 * length - from_end[-1]
    tail = _graded(last, last, rest, 1.0 + 0.25 * level)[1:]
    return np.asarray(0.5 * length - np.concatenate([from_end, from_end[-1] + tail]))[::-1].clip(min=0.0)


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
    strains = np.zeros((count, 6, nodes, 3))
    for row, axis in enumerate((0, 1, 2)):
        strains[:, row, :, axis] = gradients[..., axis]
    for row, (first, second) in enumerate(((0, 1), (1, 2), (0, 2)), start=3):
        strains[:, row, :, first] = gradients[..., second]
        strains[:, row, :, second] = gradients[..., first]
    return strains.reshape(count, 6, 3 * nodes)


def _elasticity(material: Material) -> FloatArray:
    """Stresses by strains, (6, 6) [Pa]."""
    e, nu = material.youngs_modulus, material.poisson_ratio
    elasticity = np.zeros((6, 6))
    elasticity[:3, :3] = e * nu / ((1.0 + nu) * (1.0 - 2.0 * nu))
    shear = 0.5 * e / (1.0 + nu)
    elasticity[range(3), range(3)] += 2.0 * shear
    elasticity[range(3, 6), range(3, 6)] = shear
    return elasticity


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
    forces = np.zeros((free.size, int(touching.sum())))
    forces[np.flatnonzero(touching), np.arange(forces.shape[1])] = 1.0
    return forces[free]


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
    compliance = np.zeros((total, total))
    for j in range(len(diagonal)):
        if j > 0:
            loads = np.zeros((int(free[j].sum()), total))
            loads[:, int(starts[j]) :] = rights[j - 1]
            loads -= off[j - 1][np.ix_(free[j - 1], free[j])].T @ moved
            moved = cho_solve(factors[j - 1], loads, check_finite=False)
        here = touching[j][free[j]]
        rows = np.flatnonzero(touching[j])
        seen = free[j][rows]
        compliance[np.arange(int(starts[j]), int(starts[j + 1]))[seen]] = moved[here]
    return compliance
