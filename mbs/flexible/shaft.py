"""Stepped shafts with discs as flexible bodies: beam elements between nodes, reduced to a few nodes and modes.

A shaft is free; springs and bearings of a system hold it. It moves with the freedoms of its frames, with the static
shape that belongs to them, and with the modes that it has when its frames are held, up to a cut-off frequency.

References
----------
R. R. Craig, M. C. C. Bampton, Coupling of substructures for dynamic analyses, AIAA J. 6, 1968, 1313-1319.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.linalg import cho_factor, cho_solve, eigh

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import InputError, problems_after
from mbs.flexible.beam import CrossSection, element_gyroscopic, element_mass, element_stiffness
from mbs.flexible.reduced_body import modal_damping
from mbs.flexible.shaft_parts import GROUPS, Disc, Section, divide, shaft_problems
from mbs.flexible.taper import Along, ElementMatrices, tapered_element
from mbs.model.body import FREEDOMS, Body, Frame, Inertia, lever_arm

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
            matrices = element_matrices(element, end - begin)
            for whole, part in zip((mass, gyroscopic, stiffness), matrices, strict=True):
                whole[here, here] += part[np.ix_(pair, pair)]
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


def element_matrices(element: CrossSection | Along, length: float) -> ElementMatrices:
    """Matrices of an element of a shaft.

    Parameters
    ----------
    element : CrossSection or callable
        Section of the element; by the part of the length where it changes.
    length : float
        [m].
    """
    if not isinstance(element, CrossSection):
        return tapered_element(element, length)
    return ElementMatrices(
        element_mass(element, length), element_gyroscopic(element, length), element_stiffness(element, length)
    )


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


def left_out(model: ShaftModel, masters: Sequence[int], stiffness: FloatArray, basis: FloatArray) -> FloatArray:
    """Part that modes that are not kept add where they follow slowly, shape of `stiffness`; see `Body.left_out`.

    Parameters
    ----------
    model : ShaftModel
        The whole.
    masters : sequence of int
        Nodes that stay.
    stiffness, basis : array
        K and the basis of `reduced`.
    """
    first = len(masters) * len(model.freedoms)
    rest = np.zeros_like(stiffness)
    inner = model.rows([node for node in range(len(model.nodes)) if node not in masters], model.freedoms)
    if not inner:
        return rest
    pushed = (model.mass @ basis[:, :first])[inner]
    whole = pushed.T @ cho_solve(cho_factor(model.stiffness[np.ix_(inner, inner)]), pushed)
    kept = basis[inner, first:].T @ pushed
    rest[:first, :first] = whole - kept.T @ (kept / np.diag(stiffness)[first:, None])
    return rest


def _disc_matrices(inertia: Inertia) -> tuple[FloatArray, FloatArray]:
    """Mass and gyroscopic matrix of a rigid part, shapes (6, 6)."""
    lever = lever_arm((inertia.offset, 0.0, 0.0))
    principal = [inertia.mass, inertia.mass, inertia.mass, inertia.polar, inertia.transverse, inertia.transverse]
    gyroscopic = np.zeros((6, 6))
    gyroscopic[4, 5], gyroscopic[5, 4] = inertia.polar, -inertia.polar
    return lever.T @ np.diag(principal) @ lever, gyroscopic


def flexible_shaft(
    name: str,
    sections: Sequence[Section],
    discs: Sequence[Disc],
    freedoms: Sequence[str],
    position: Sequence[float],
    frames: Mapping[str, float],
    spin: float = 0.0,
    largest_element: float | None = None,
    cutoff: float | None = None,
    damping_ratio: float = 0.0,
) -> Body:
    """A shaft of Timoshenko beams with rigid discs.

    Where sections overlap along x, stiffness and mass add up: one is taken as pressed into the bore of the other all
    along, with plane sections in common. A layer that adds mass only has a Young's modulus of 0; a part that is fixed
    at one place is a disc, and without moments of inertia a point mass on the axis.

    Parameters
    ----------
    name : str
        Name of the body.
    sections : sequence of Section
        Sections, at least one, without a gap along x.
    discs : sequence of Disc
        Rigid parts; within the sections.
    freedoms : sequence of str
        Some of x, y, z, theta_x, theta_y, theta_z; those left out are held all along the shaft. Bending needs two:
        y and theta_z, z and theta_y.
    position : sequence of float, shape (3,)
        Position of x = 0 of sections, discs and frames [m].
    frames : mapping of str to float
        Places on the axis by name, along x from the position [m]; at least one.
    spin : float
        Speed about x as a multiple of the system's.
    largest_element : float, optional
        Length of an element [m]. Left out: what makes an error of 1e-4 in the frequency of bending waves at the
        cut-off; without a cut-off half the diameter.
    cutoff : float, optional
        Modes of the shaft with its frames held are kept up to this frequency [Hz]. Left out: no reduction, and the
        coordinates are those of all nodes.
    damping_ratio : float
        Damping ratio of the modes of the free shaft at rest.

    Returns
    -------
    Body
        Coordinates "left.y" and so on for each frame, then "mode 1" and so on in the order of their frequencies,
        mass-normalised. Frames at the same place share their coordinates, under the name of the first.

    Raises
    ------
    InputError
        With all that does not fit together.

    Notes
    -----
    Valid for waves that are longer than a few diameters: sections stay plane. A cut-off above that all along the
    shaft is an error. How wrong modes of a system are by a cut-off is told with them (`mbs.linearised.reduction`): it
    depends on the spans between frames, and on no part of the cut-off alone.
    """
    problems = shaft_problems(sections, discs, freedoms, position, frames, spin, largest_element, cutoff, damping_ratio)
    if problems:
        raise InputError([f"shaft {name!r}, {problem}" for problem in problems])
    with problems_after(f"shaft {name!r}, "):
        model = shaft_model(sections, discs, freedoms, list(frames.values()), largest_element, cutoff)
        nodes = {key: model.node(place) for key, place in frames.items()}
        if cutoff is None:
            kept = list(range(len(model.nodes)))
            mass, gyroscopic, stiffness = model.mass, model.gyroscopic, model.stiffness
            basis, rest = np.eye(len(mass)), None
        else:
            kept = list(dict.fromkeys(nodes.values()))
            mass, gyroscopic, stiffness, basis = reduced(model, kept, cutoff)
            rest = left_out(model, kept, stiffness, basis)
        damping = modal_damping(mass, stiffness, damping_ratio)
    labels = {node: key for key, node in reversed(nodes.items())}
    own = [(labels.get(node, f"node {node + 1}"), freedom) for node in kept for freedom in freedoms]
    modes = range(1, len(mass) - len(own) + 1)
    here = np.asarray(position, dtype=np.float64)
    places = {}
    for key, node in nodes.items():
        transform = np.zeros((6, len(mass)))
        for column, owner in enumerate(own):
            if owner[0] == labels[node]:
                transform[FREEDOMS.index(owner[1]), column] = 1.0
        places[key] = Frame(here + np.array([frames[key], 0.0, 0.0]), transform)
    return Body(
        name=name,
        coordinates=(*(f"{label}.{freedom}" for label, freedom in own), *(f"mode {number}" for number in modes)),
        units=(*("rad" if freedom.startswith("theta") else "m" for _, freedom in own), *("1" for _ in modes)),
        mass=mass,
        gyroscopic=gyroscopic,
        damping=damping,
        stiffness=stiffness,
        frames=places,
        spin=spin,
        line=_line(model, here, basis),
        cutoff=math.inf if cutoff is None else cutoff,
        left_out=rest,
    )


def _line(model: ShaftModel, here: FloatArray, basis: FloatArray) -> tuple[Frame, ...]:
    """All nodes of a shaft, with how they move by its coordinates."""
    rows = [FREEDOMS.index(freedom) for freedom in model.freedoms]
    frames = []
    for node, place in enumerate(model.nodes.tolist()):
        transform = np.zeros((6, basis.shape[1]))
        transform[rows] = basis[model.rows([node], model.freedoms)]
        frames.append(Frame(here + np.array([place, 0.0, 0.0]), transform))
    return tuple(frames)
