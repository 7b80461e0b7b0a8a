"""A shaft as beam elements between nodes, and its reduction to the motion of a few nodes and modes.

References
----------
R. R. Craig, M. C. C. Bampton, Coupling of substructures for dynamic analyses, AIAA J. 6, 1968, 1313-1319.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.linalg import cho_factor, cho_solve, eigh

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import InputError
from mbs.flexible.beam import element_gyroscopic, element_mass, element_stiffness
from mbs.flexible.shaft_layout import divide
from mbs.flexible.shaft_parts import GROUPS, Disc, Section
from mbs.model.body import FREEDOMS, Inertia, lever_arm

_ROUND_OFF = 1e-6
"""What static shapes may miss of rigid motion; a shaft of a machine stays below 1e-9."""

_SINGULAR = (
    "sections: the held shaft is singular to working precision; allowed: stiffnesses that differ by fewer orders of "
    "magnitude; make a disc of what does not bend"
)


@dataclass(frozen=True, eq=False)
class ShaftModel:
    """Nodes along x, and matrices of the kept freedoms of one node after the other, shape (N, N).

    Attributes
    ----------
    nodes : array, shape (nodes,)
        [m].
    freedoms : tuple of str
        Freedoms of each node.
    mass, gyroscopic, stiffness : array, shape (N, N)
        M, G per speed, K.
    """

    nodes: FloatArray
    freedoms: tuple[str, ...]
    mass: FloatArray
    gyroscopic: FloatArray
    stiffness: FloatArray

    def node(self, place: float) -> int:
        """Node at a place [m]."""
        return int(np.argmin(np.abs(self.nodes - place)))

    def rows(self, nodes: Sequence[int], freedoms: Sequence[str]) -> list[int]:
        """Row of each of some freedoms of each of some nodes."""
        size = len(self.freedoms)
        return [size * node + self.freedoms.index(freedom) for node in nodes for freedom in freedoms]


def shaft_model(
    sections: Sequence[Section],
    discs: Sequence[Disc],
    freedoms: Sequence[str],
    places: Sequence[float],
    largest_element: float | None,
    cutoff: float | None,
) -> ShaftModel:
    """Nodes where anything begins, ends or sits and as many between as are needed, and their matrices.

    Parameters
    ----------
    sections, discs : sequence
        Parts that fit together.
    freedoms : sequence of str
        Kept freedoms.
    places : sequence of float
        Further places of nodes [m].
    largest_element : float, optional
        [m].
    cutoff : float, optional
        [Hz].

    Raises
    ------
    InputError
        For too many elements, a cut-off beyond the theory of beams, and matrices that overflow.
    """
    nodes, elements = divide(sections, [*(disc.position for disc in discs), *places], largest_element, cutoff)
    kept = [FREEDOMS.index(freedom) for freedom in freedoms]
    size = len(kept)
    pair = [*kept, *(6 + index for index in kept)]
    mass, gyroscopic, stiffness = (np.zeros((size * len(nodes), size * len(nodes))) for _ in range(3))
    # What overflows is found below.
    with np.errstate(all="ignore"):
        for index, (element, (begin, end)) in enumerate(zip(elements, pairwise(nodes), strict=True)):
            here = slice(size * index, size * (index + 2))
            mass[here, here] += element_mass(element, end - begin)[np.ix_(pair, pair)]
            gyroscopic[here, here] += element_gyroscopic(element, end - begin)[np.ix_(pair, pair)]
            stiffness[here, here] += element_stiffness(element, end - begin)[np.ix_(pair, pair)]
        model = ShaftModel(np.array(nodes), tuple(freedoms), mass, gyroscopic, stiffness)
        for disc in discs:
            node = model.node(disc.position)
            here = slice(size * node, size * (node + 1))
            block, turning = _disc_matrices(disc.inertia)
            mass[here, here] += block[np.ix_(kept, kept)]
            gyroscopic[here, here] += turning[np.ix_(kept, kept)]
    if not all(np.all(np.isfinite(matrix)) for matrix in (mass, gyroscopic, stiffness)):
        raise InputError("sections: stiffness or mass is not finite; allowed: dimensions and moduli of a machine")
    return model


def reduced(
    model: ShaftModel, masters: Sequence[int], cutoff: float
) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """M, G, K and the basis, in the freedoms of the master nodes and the modes with these held, by Craig and Bampton.

    Static loads at the masters are carried exactly. Modes are mass-normalised and in the order of their frequency;
    each is in one plane, as the shaft is round.

    Parameters
    ----------
    model : ShaftModel
        The whole.
    masters : sequence of int
        Nodes that stay.
    cutoff : float
        Highest frequency of the modes [Hz].

    Raises
    ------
    InputError
        If stiffnesses differ so much that round-off spoils the static shapes.
    """
    size = len(model.freedoms)
    others = [node for node in range(len(model.nodes)) if node not in masters]
    static = np.zeros((len(model.mass), size * len(masters)))
    static[model.rows(masters, model.freedoms), range(size * len(masters))] = 1.0
    squares: list[float] = []
    shapes: list[FloatArray] = []
    # Group by group: both planes have the same frequencies, and solved together would come in any mixture.
    for group in GROUPS:
        if group[0] not in model.freedoms or not others:
            continue
        inner, outer = model.rows(others, group), model.rows(masters, group)
        stiffness, mass = model.stiffness[np.ix_(inner, inner)], model.mass[np.ix_(inner, inner)]
        try:
            columns = [model.rows(masters, model.freedoms).index(row) for row in outer]
            static[np.ix_(inner, columns)] = -cho_solve(cho_factor(stiffness), model.stiffness[np.ix_(inner, outer)])
            # As eigenvalues 1/omega^2, of which the largest are wanted, low frequencies keep all their digits.
            inverse, vectors = eigh(mass, stiffness, subset_by_value=((2.0 * math.pi * cutoff) ** -2, math.inf))
        except np.linalg.LinAlgError as error:
            raise InputError(_SINGULAR) from error
        for value, vector in zip(inverse[::-1], vectors.T[::-1], strict=True):
            shape = np.zeros(len(model.mass))
            shape[inner] = vector / math.sqrt(value)
            squares.append(1.0 / value)
            shapes.append(shape)
    # Where the masters move as a rigid body, the shaft follows: round-off shows in how well it does.
    kept = [FREEDOMS.index(freedom) for freedom in model.freedoms]
    rigid = np.vstack([lever_arm((place, 0.0, 0.0))[np.ix_(kept, kept)] for place in model.nodes])
    missed = np.max(np.abs(static @ rigid[model.rows(masters, model.freedoms)] - rigid))
    if not missed <= _ROUND_OFF * np.max(np.abs(rigid)):
        raise InputError(_SINGULAR)
    order = np.argsort(squares, kind="stable")
    basis = np.column_stack([static, *(shapes[index] for index in order)])
    mass, gyroscopic = basis.T @ model.mass @ basis, basis.T @ model.gyroscopic @ basis
    stiffness = np.zeros_like(mass)
    first = static.shape[1]
    stiffness[:first, :first] = static.T @ model.stiffness @ static
    stiffness[range(first, len(mass)), range(first, len(mass))] = [squares[index] for index in order]
    return 0.5 * (mass + mass.T), 0.5 * (gyroscopic - gyroscopic.T), 0.5 * (stiffness + stiffness.T), basis


def _disc_matrices(inertia: Inertia) -> tuple[FloatArray, FloatArray]:
    """Mass and gyroscopic matrix of a rigid part, shapes (6, 6)."""
    lever = lever_arm((inertia.offset, 0.0, 0.0))
    principal = [inertia.mass, inertia.mass, inertia.mass, inertia.polar, inertia.transverse, inertia.transverse]
    gyroscopic = np.zeros((6, 6))
    gyroscopic[4, 5], gyroscopic[5, 4] = inertia.polar, -inertia.polar
    return lever.T @ np.diag(principal) @ lever, gyroscopic
