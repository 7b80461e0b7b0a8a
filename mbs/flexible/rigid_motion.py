"""A body that moves as one is not strained: what its stiffness says of its mesh.

A shift t and a turn theta of all nodes, u = t + theta x r, cost no energy, so K u = 0 in each row, but for those next
to what is held. Shifts do not depend on where the nodes are: rows in which K t = 0 are next to nothing that is held,
and there a turn must give nothing, too. If it does, nodes are not where the mesh says, or not of the number that it
says.

Turns are taken about the node of each row, so that a place far from the origin costs no digits. Finite elements of any
kind are exact in this, and texts have four digits and more; springs between nodes apart, across the line between
them, are strained by a turn, and ties over a gap.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy import sparse

from ehdmaps.arrays import FloatArray, IntArray
from ehdmaps.errors import Problems
from mbs.flexible.finite_elements import FiniteElementModel, named

TOLERANCE = 0.01
"""Sum of a row over the sum of sizes of what adds up to it, from which on it is not zero: positions and stiffness in
fields of eight characters leave up to a thousandth."""

MOST_DISPLACED = 0.02
"""Of the nodes that are next to nothing held: springs and gaps of a sound model make no more of them."""

MOST_HELD = 0.9
"""Of the nodes, where the matrix is sparse: more are next to what is held in no body, but where values are lost."""

_BLOCK = 2_000_000
"""Entries that are looked at in one piece."""

_DENSE = 0.5
"""Part of a matrix that is filled by one that another program has reduced: there each node may feel what is held."""


class Strained(NamedTuple):
    """Nodes by what a motion of the body as one does to them.

    Attributes
    ----------
    held : array of int
        Nodes that a shift strains: next to what is held.
    displaced : array of int
        Nodes that a turn strains, and a shift does not.
    nodes : int
        Number of all nodes that were looked at.
    """

    held: IntArray
    displaced: IntArray
    nodes: int

    def warnings(self) -> tuple[str, ...]:
        """Say which nodes a turn strains, few as they are; one sentence, or none."""
        if self.displaced.size == 0:
            return ()
        return (
            f"a turn of the whole body strains {named(self.displaced)}, which a shift does not: springs between nodes "
            "apart, ties over a gap, or nodes that are not where the mesh says",
        )


def strained(model: FiniteElementModel) -> Strained:
    """Find the nodes that are strained when the body moves as one.

    Parameters
    ----------
    model : FiniteElementModel
        The body. Nodes without a position, and what is joined to them, are not looked at; coordinates of modes stay.
    """
    matrix = sparse.coo_array(model.stiffness)
    nodes, of_row = np.unique(model.nodes, return_inverse=True)
    places = np.full((nodes.size, 3), np.nan)
    known = np.isin(nodes, model.numbers)
    order = np.argsort(model.numbers)
    places[known] = model.positions[order[np.searchsorted(model.numbers[order], nodes[known])]]
    # A node without displacements and place is a coordinate of a mode, which a motion as one leaves at zero.
    abstract = ~known & (np.bincount(of_row, model.directions < 3, nodes.size) == 0)
    size = model.size
    reach, unknown = np.zeros(size), np.zeros(size, dtype=np.bool_)
    shift, turn = np.zeros((3, size)), np.zeros((3, size))
    shift_scale, turn_scale = np.zeros(size), np.zeros(size)
    blocks = [slice(begin, begin + _BLOCK) for begin in range(0, matrix.nnz, _BLOCK)]

    def away(block: slice) -> FloatArray:
        """From the node of the row to that of the column, shape (entries, 3)."""
        found = places[of_row[matrix.col[block]]] - places[of_row[matrix.row[block]]]
        found[abstract[of_row[matrix.col[block]]]] = 0.0
        return np.asarray(found)

    for block in blocks:
        distance = np.linalg.norm(away(block), axis=1)
        np.maximum.at(reach, matrix.row[block], np.nan_to_num(distance))
        unknown[matrix.row[block][np.isnan(distance)]] = True
    for block in blocks:
        row, between = matrix.row[block], np.nan_to_num(away(block))
        value = np.where(abstract[of_row[matrix.col[block]]], 0.0, matrix.data[block])
        direction = model.directions[matrix.col[block]]
        distance = np.linalg.norm(between, axis=1)
        # A rotation beside displacements counts by the length over which it acts.
        length = np.where(direction < 3, 1.0, np.where(reach[row] > 0.0, reach[row], np.inf))
        shift_scale += np.bincount(row, np.abs(value) / length, size)
        # By the distance, not by the lever: of nodes in line with an axis that is rounding alone.
        turn_scale += np.bincount(row, np.abs(value) * np.where(direction < 3, distance, 1.0), size)
        for axis in range(3):
            shift[axis] += np.bincount(row, np.where(direction == axis, value, 0.0), size)
            turn[axis] += np.bincount(row, value * _lever(between, direction, axis), size)
    shifted = np.max(np.abs(shift), axis=0) > TOLERANCE * shift_scale
    turned = np.max(np.abs(turn), axis=0) > TOLERANCE * turn_scale
    judged = np.bincount(of_row, unknown, nodes.size) == 0
    held = judged & (np.bincount(of_row, shifted, nodes.size) > 0)
    displaced = judged & ~held & (np.bincount(of_row, turned, nodes.size) > 0)
    return Strained(nodes[held], nodes[displaced], int(np.count_nonzero(judged & ~abstract)))


def _lever(away: FloatArray, direction: IntArray, axis: int) -> FloatArray:
    """Displacement along a direction, 0 to 2, by a turn of one about an axis; the turn itself for 3 to 5."""
    first, second = (axis + 1) % 3, (axis + 2) % 3
    return np.where(
        direction == first,
        -away[:, second],
        np.where(direction == second, away[:, first], np.where(direction == 3 + axis, 1.0, 0.0)),
    )


def check_rigid_motion(model: FiniteElementModel) -> None:
    """Refuse a body whose stiffness does not fit its mesh.

    Parameters
    ----------
    model : FiniteElementModel
        The body.

    Raises
    ------
    InputError
        If more nodes are strained by a motion as one than supports, springs and gaps of a sound model explain.
    """
    found = strained(model)
    free = found.nodes - found.held.size
    problems = Problems()
    if found.displaced.size > MOST_DISPLACED * free:
        problems.append(
            f"finite-element body: a turn of the whole body strains {found.displaced.size} of {free} nodes that a "
            f"shift does not strain, such as {named(found.displaced)}; allowed: nodes where the mesh of these "
            "matrices has them; check numbers and positions of nodes, systems of coordinates and units"
        )
    filled = model.stiffness.nnz / model.size**2
    if found.held.size > MOST_HELD * found.nodes and filled < _DENSE:
        problems.append(
            f"finite-element body: a shift of the whole body strains {found.held.size} of {found.nodes} nodes, such as "
            f"{named(found.held)}; allowed: a stiffness that is whole, of a body that is free or held at a part of its "
            "nodes; were values lost?"
        )
    problems.check()
