"""Craig-Bampton reduction: a finite-element body by the displacements of its interfaces and a few modes.

Interfaces of a finite-element body: a place, the nodes around it, and how the one follows the other.

rigid      u_k = q + theta x r_k           the nodes follow the place as if cast together: stiffens what they hold
averaging  sum w |u_k - q - theta x r_k|^2 -> min    the place follows the nodes in the least-squares mean: adds nothing

r_k is from the place to the node. A force on an averaging place spreads over the nodes as w_k (f + ...), so that it
strains the body as a soft pressure would; the true seat of a bearing lies between the two.

u = Psi q + Phi p      Psi: shapes at rest, one interface coordinate 1 and the others 0
                           Phi: modes with all interface coordinates held, up to the cut-off

Static forces on the interfaces are exact; what modes above the cut-off leave out of the modes of a machine is kept, too
(Craig and Bampton, AIAA Journal 6, 1968, 1313-1319; `mbs.linearised.reduction`). Rigid interfaces are built into the
matrices first; averaging ones are held in the mean.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy import sparse

from ehdmaps.arrays import FloatArray, IntArray
from ehdmaps.errors import AnalysisError, InputError, Problems
from mbs.flexible.finite_elements import FiniteElementModel, named
from mbs.flexible.held_body import HeldBody
from mbs.flexible.plan import KINDS, Kind
from mbs.flexible.reduced_body import ReducedBody
from mbs.flexible.skin import skin_of
from mbs.model.body import FREEDOMS, Frame, lever_arm

_DEGENERATE = 1e-8
"""Smallest over largest eigenvalue of the nodes' moments, below which they lie on a line to rounding."""

_TRANSLATIONS = frozenset(FREEDOMS[:3])


@dataclass(frozen=True, eq=False)
class Interface:
    """A place, the nodes around it, and how the one follows the other.

    Attributes
    ----------
    position : array, shape (3,)
        Position of the place [m]; it need not be a node.
    nodes : array of int, shape (n,)
        Node numbers.
    kind : {"rigid", "averaging"}
        Whether the nodes follow the place, or the place their mean.
    freedoms : tuple of str
        Those of the place that become coordinates of the reduced body; the others are left to the body.
    weights : array, shape (n,), optional
        Weights of the nodes in the mean, such as the areas that they stand for; equal if left out.

    Raises
    ------
    InputError
        For values that no interface can have.
    """

    position: FloatArray
    nodes: IntArray
    kind: Kind = "averaging"
    freedoms: tuple[str, ...] = FREEDOMS
    weights: FloatArray | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "position", np.asarray(self.position, dtype=np.float64))
        object.__setattr__(self, "nodes", np.asarray(self.nodes, dtype=np.int64))
        object.__setattr__(self, "freedoms", tuple(self.freedoms))
        problems = Problems()
        if self.position.shape != (3,) or not np.all(np.isfinite(self.position)):
            problems.append(f"interface, position: got {self.position!r:.80}; allowed: three finite lengths in m")
        if self.nodes.ndim != 1 or self.nodes.size == 0:
            problems.append(f"interface, nodes: got shape {self.nodes.shape}; allowed: a list of at least one node")
        elif np.unique(self.nodes).size != self.nodes.size:
            problems.append("interface, nodes: a node is there twice; allowed: each once")
        if self.kind not in KINDS:
            problems.append(f"interface, kind: got {self.kind!r:.40}; allowed: {', '.join(KINDS)}")
        wrong = [freedom for freedom in self.freedoms if freedom not in FREEDOMS]
        if wrong or not self.freedoms or len(set(self.freedoms)) < len(self.freedoms):
            problems.append(
                f"interface, freedoms: got {self.freedoms!r:.80}; allowed: some of {', '.join(FREEDOMS)}, each once"
            )
        if self.weights is not None:
            weights = np.asarray(self.weights, dtype=np.float64)
            object.__setattr__(self, "weights", weights)
            if weights.shape != self.nodes.shape or not np.all(np.isfinite(weights) & (weights > 0.0)):
                problems.append(
                    f"interface, weights: got shape {weights.shape}; allowed: a finite number > 0 for each of "
                    f"{self.nodes.size} nodes"
                )
        problems.check()


@dataclass(frozen=True, eq=False)
class Spider:
    """An interface in the degrees of freedom of a model.

    Attributes
    ----------
    rows : array of int, shape (s,)
        The degrees of freedom of its nodes.
    rigid : array, shape (s, 6)
        How they move with the place when all is rigid.
    mean : array, shape (6, s)
        The place's displacement as the mean of theirs; mean @ rigid is the unit matrix.
    """

    rows: IntArray
    rigid: FloatArray
    mean: FloatArray


def spider(model: FiniteElementModel, name: str, interface: Interface) -> Spider:
    """Find the degrees of freedom of an interface.

    Parameters
    ----------
    model : FiniteElementModel
        The body.
    name : str
        Name of the interface, for messages.
    interface : Interface
        A single node of a solid has translations only: then the interface has no rotations either and is at the node.

    Raises
    ------
    InputError
        If nodes have no position or no displacement in the matrices, or do not tell how the place turns.
    """
    where = f"interface {name!r}"
    unknown = [node for node in interface.nodes.tolist() if not model.has_position(node)]
    if unknown:
        raise InputError(
            f"{where}, nodes: {named(np.array(unknown))} without a position; allowed: nodes of the mesh, which has "
            f"{model.numbers.size}; check the numbers, or the mesh file"
        )
    held = [node for node in interface.nodes.tolist() if None in [model.row(node, d) for d in range(3)]]
    if held:
        raise InputError(
            f"{where}, nodes: {named(np.array(held))} without displacements in the matrices: fixed, following others "
            "by a constraint, or of no element; allowed: nodes that move freely; leave these out"
        )
    weights = np.ones(interface.nodes.size) if interface.weights is None else interface.weights
    rows, parts, weight = [], [], []
    for node, share in zip(interface.nodes.tolist(), weights.tolist(), strict=True):
        lever = lever_arm((model.position(node) - interface.position).tolist())
        for direction in range(6):
            row = model.row(node, direction)
            if row is not None:
                rows.append(row)
                parts.append(lever[direction])
                # Rotations of the nodes say nothing to the mean: that would need a length to weigh them by.
                weight.append(share if direction < 3 else 0.0)
    rigid = np.array(parts)
    if interface.kind == "rigid" and any(model.row(node, d) is not None for node in interface.nodes for d in (3, 4, 5)):
        weight = [1.0] * len(weight)
    mean = _mean(where, interface, rigid, np.array(weight))
    return Spider(np.array(rows, dtype=np.int64), rigid, mean)


def _mean(where: str, interface: Interface, rigid: FloatArray, weight: FloatArray) -> FloatArray:
    """Least-squares mean of the nodes, shape (6, s)."""
    apart = rigid[weight > 0.0]
    # Lengths in units of the spread of the nodes, so that translations and rotations compare.
    spread = float(np.sqrt(np.mean(apart[:, 3:] ** 2))) or 1.0
    scale = np.array([1.0, 1.0, 1.0, 1.0 / spread, 1.0 / spread, 1.0 / spread])
    scaled = rigid * scale
    moments = scaled.T @ (weight[:, None] * scaled)
    values = np.linalg.eigvalsh(moments)
    if values[0] > _DEGENERATE * values[-1]:
        return np.asarray(scale[:, None] * np.linalg.solve(moments, (weight[:, None] * scaled).T))
    alone = interface.nodes.size == 1 and np.max(np.abs(rigid[:, 3:])) <= 1e-9
    if alone and set(interface.freedoms) <= _TRANSLATIONS:
        return np.vstack([rigid[:, :3].T, np.zeros((3, rigid.shape[0]))])
    if interface.nodes.size == 1:
        raise InputError(
            f"{where}, nodes: got one, which does not say how the place turns; allowed: three or more that are not on "
            "a line; or freedoms x, y, z alone, with the place at the node"
        )
    raise InputError(
        f"{where}, nodes: got {interface.nodes.size} on a line, which do not say how the place turns about it; "
        "allowed: three or more that are not on a line, widely enough apart for their distance from the place"
    )


def nodes_on_cylinder(
    model: FiniteElementModel,
    point: Sequence[float],
    direction: Sequence[float],
    radius: float,
    begin: float,
    end: float,
    tolerance: float,
) -> IntArray:
    """Nodes on a cylindrical surface, such as the bore of a bearing seat.

    Parameters
    ----------
    model : FiniteElementModel
        The body.
    point, direction : sequence of float, shape (3,)
        A point on the axis [m] and the direction of the axis, of any length.
    radius : float
        [m].
    begin, end : float
        Distances from the point along the axis [m].
    tolerance : float
        How far off the surface and beyond its ends a node may lie [m].

    Returns
    -------
    array of int
        Node numbers; those that have displacements. May be empty.
    """
    axis = np.asarray(direction, dtype=np.float64)
    away = model.positions - np.asarray(point, dtype=np.float64)
    along = away @ (axis / np.linalg.norm(axis))
    across = np.sqrt(np.maximum(np.sum(away**2, axis=1) - along**2, 0.0))
    kept = (np.abs(across - radius) <= tolerance) & (along >= begin - tolerance) & (along <= end + tolerance)
    return _moving(model, kept)


def nodes_in_plane(
    model: FiniteElementModel,
    point: Sequence[float],
    normal: Sequence[float],
    tolerance: float,
    radius: float = math.inf,
) -> IntArray:
    """Nodes in the plane through a point [m] with a normal of any length, to a tolerance [m], up to a radius [m].

    Parameters
    ----------
    model : FiniteElementModel
        The finite element model.
    point : sequence of float
        A point of the plane, shape (3,) [m].
    normal : sequence of float
        Normal of the plane, of any length, shape (3,).
    tolerance : float
        Largest distance from the plane [m].
    radius : float
        Largest distance from the point [m].
    """
    unit = np.asarray(normal, dtype=np.float64)
    away = model.positions - np.asarray(point, dtype=np.float64)
    off = np.abs(away @ (unit / np.linalg.norm(unit)))
    return _moving(model, (off <= tolerance) & (np.linalg.norm(away, axis=1) <= radius + tolerance))


def nearest_node(model: FiniteElementModel, position: Sequence[float]) -> int:
    """The node with displacements that is nearest to a position [m].

    Raises
    ------
    InputError
        If no node has a position and displacements.
    """
    moving = np.isin(model.numbers, model.nodes)
    if not moving.any():
        raise InputError(
            "finite-element body: no node of the mesh has displacements in the matrices; allowed: a mesh and matrices "
            "with the same node numbers"
        )
    away = np.sum((model.positions[moving] - np.asarray(position, dtype=np.float64)) ** 2, axis=1)
    return int(model.numbers[moving][int(np.argmin(away))])


def _moving(model: FiniteElementModel, kept: np.ndarray[tuple[int], np.dtype[np.bool_]]) -> IntArray:
    """Numbers of the kept nodes that have displacements, sorted."""
    return np.sort(model.numbers[kept & np.isin(model.numbers, model.nodes)])


Point = Interface | Sequence[float] | int
"""Where a body is only observed: an averaging interface, a position (its nearest node is taken), or a node number."""

HIGHEST_CUTOFF = 1e9
"""[Hz]."""

NEAREST = 0.05
"""How far the nearest node of a point may be, as a part of the extent of the mesh."""

_NOISE = 1e-13
"""Rounding of a stiffness, of the sum of the sizes of all that adds up to it."""

_COUPLED = 1e-6
"""Largest stiffness between static shapes and modes, which is zero in exact arithmetic, over their own."""


def reduce(
    model: FiniteElementModel,
    interfaces: Mapping[str, Interface],
    points: Mapping[str, Point] | None = None,
    cutoff: float = 1e4,
    attributes: Mapping[str, str] | None = None,
    triangles: IntArray | None = None,
) -> ReducedBody:
    """Reduce a finite-element body to its interfaces and its modes up to a cut-off.

    Parameters
    ----------
    model : FiniteElementModel
        The body; free, or with feet that are fixed already.
    interfaces : mapping of str to Interface
        Places where forces act. With all of them held the body must not move.
    points : mapping, optional
        Places where the body is only observed. At a node of a solid the rotations are not known: zero.
    cutoff : float
        Highest frequency of the modes with all interfaces held [Hz].
    attributes : mapping of str to str, optional
        Provenance, added to the result's own.
    triangles : array of int, shape (t, 3), optional
        Node numbers of its skin, as of `mbs.flexible.skin.skin_triangles`, for pictures; the result has none if left
        out.

    Returns
    -------
    ReducedBody
        Coordinates "left.x" ... in the order of the interfaces, then "mode 1" ... scaled to unit modal mass.

    Raises
    ------
    InputError
        For interfaces, points or a cut-off that do not fit the body, with every problem found before the matrices are
        factorised.
    AnalysisError
        If the modes or static shapes are not found.
    """
    points = points or {}
    spiders, observers = _checked(model, interfaces, points, cutoff)
    parts = _partition(model, interfaces, spiders)
    stiffness = _transformed(parts.transform, model.stiffness)
    mass = _transformed(parts.transform, model.mass)
    inner, held = parts.inner, parts.held
    # What moves: the rest, held in the mean.
    body = HeldBody(
        sparse.csc_array(stiffness[inner][:, inner]),
        sparse.csc_array(mass[inner][:, inner]),
        parts.averages,
        parts.groups[inner],
        cutoff,
    )
    count = held.size + parts.averages.shape[0]
    prescribed = np.zeros((parts.averages.shape[0], count))
    prescribed[:, held.size :] = np.eye(parts.averages.shape[0])
    force = np.zeros((inner.size, count))
    force[:, : held.size] = -stiffness[inner][:, held].toarray()
    basis = np.zeros((parts.transform.shape[1], count + body.squares.size))
    basis[inner, :count] = body.static(force, prescribed)
    basis[held, np.arange(held.size)] = 1.0
    basis[inner, count:] = body.shapes
    # Interface coordinates in the order in which the interfaces were given.
    basis[:, :count] = basis[:, parts.order]
    names = [
        f"{name}.{freedom}" for name, entry in interfaces.items() for freedom in FREEDOMS if freedom in entry.freedoms
    ]
    motion = np.asarray(parts.transform @ basis)
    return ReducedBody(
        mass=_reduced_mass(mass, basis, count),
        stiffness=_reduced_stiffness(model.stiffness, motion, count, body.squares),
        coordinates=(*names, *(f"mode {k + 1}" for k in range(body.squares.size))),
        units=(*("rad" if ".theta" in name else "m" for name in names), *("1" for _ in range(body.squares.size))),
        frames=_frames(interfaces, observers, motion, names),
        attributes={
            "method": "Craig-Bampton",
            "finite_element_freedoms": str(model.size),
            "cutoff": f"{cutoff:.12g} Hz",
            "interfaces": "; ".join(
                f"{name}: {entry.kind}, {entry.nodes.size} nodes" for name, entry in interfaces.items()
            ),
            **(attributes or {}),
        },
        skin=None if triangles is None else skin_of(model, triangles, motion),
        left_out=_left_out(body, (mass @ basis[:, :count])[inner], basis.shape[1]),
    )


def _left_out(body: HeldBody, pushed: FloatArray, size: int) -> FloatArray:
    """Part that modes that are not kept add to the static shapes, whose inertia pushes, shape (size, size)."""
    rest, count = np.zeros((size, size)), pushed.shape[1]
    if pushed.size:
        whole = pushed.T @ body.static(pushed, np.zeros((body.averages.shape[0], count)))
        kept = body.shapes.T @ pushed
        rest[:count, :count] = 0.5 * (whole + whole.T) - kept.T @ (kept / body.squares[:, None])
    return rest


@dataclass(frozen=True, eq=False)
class _Partition:
    """Parts that are prescribed, and parts that move.

    transform (N, n): degrees of freedom by the rest and the places of rigid interfaces; held, inner: columns that are
    prescribed, and the others; averages (m, inner): mean displacements that are prescribed; groups (n,): which columns
    belong together; order (held + m,): prescribed coordinates by the order of the interfaces.
    """

    transform: sparse.csc_array
    held: IntArray
    inner: IntArray
    averages: FloatArray
    groups: IntArray
    order: IntArray


def _partition(
    model: FiniteElementModel, interfaces: Mapping[str, Interface], spiders: Mapping[str, Spider]
) -> _Partition:
    """Sort the degrees of freedom."""
    rigid = {name: spiders[name] for name, entry in interfaces.items() if entry.kind == "rigid"}
    slaves = np.concatenate([np.zeros(0, dtype=np.int64), *(entry.rows for entry in rigid.values())])
    free = np.setdiff1d(np.arange(model.size), slaves)
    column = np.full(model.size, -1)
    column[free] = np.arange(free.size)
    rows, columns, values = [free], [np.arange(free.size)], [np.ones(free.size)]
    groups = [model.nodes[free]]
    held: list[int] = []
    source: list[tuple[int, int]] = []
    averages = []
    size, foreign = free.size, int(model.nodes.max(initial=0)) + 1
    for index, (name, entry) in enumerate(interfaces.items()):
        place = spiders[name]
        kept = [FREEDOMS.index(freedom) for freedom in FREEDOMS if freedom in entry.freedoms]
        if entry.kind == "averaging":
            matrix = np.zeros((len(kept), model.size))
            matrix[:, place.rows] = place.mean[kept]
            averages.append(matrix)
            continue
        # A single node of a solid does not follow rotations: they are no coordinates at all.
        used = [k for k in range(6) if np.any(place.rigid[:, k])]
        block = sparse.coo_array(place.rigid[:, used])
        rows.append(place.rows[block.row])
        columns.append(size + block.col)
        values.append(block.data)
        groups.append(np.full(len(used), foreign + index))
        held += [size + used.index(k) for k in kept]
        source += [(index, k) for k in kept]
        size += len(used)
    source += [
        (index, FREEDOMS.index(freedom))
        for index, entry in enumerate(interfaces.values())
        if entry.kind == "averaging"
        for freedom in FREEDOMS
        if freedom in entry.freedoms
    ]
    transform = sparse.csc_array(
        (np.concatenate(values), (np.concatenate(rows), np.concatenate(columns))), shape=(model.size, size)
    )
    inner = np.setdiff1d(np.arange(size), held)
    gathered = np.concatenate([np.zeros((0, model.size)), *averages])
    return _Partition(
        transform=transform,
        held=np.array(held, dtype=np.int64),
        inner=inner,
        averages=np.asarray((transform.T @ gathered.T).T[:, inner]),
        groups=np.concatenate(groups),
        order=np.array(sorted(range(len(source)), key=source.__getitem__), dtype=np.int64),
    )


def _transformed(transform: sparse.csc_array, matrix: sparse.csc_array) -> sparse.csc_array:
    """T' A T."""
    return sparse.csc_array(transform.T @ matrix @ transform)


def _reduced_mass(mass: sparse.csc_array, basis: FloatArray, count: int) -> FloatArray:
    """Mass in the reduced coordinates; that of the modes is the unit matrix."""
    reduced = basis.T @ (mass @ basis)
    reduced = 0.5 * (reduced + reduced.T)
    reduced[count:, count:] = np.eye(basis.shape[1] - count)
    return np.asarray(reduced)


def _reduced_stiffness(stiffness: sparse.csc_array, motion: FloatArray, count: int, squares: FloatArray) -> FloatArray:
    """Stiffness in the reduced coordinates, whose motion is given, shape (N, n): static shapes and modes are apart."""
    static = motion[:, :count]
    work = stiffness @ static
    full = 0.5 * (static.T @ work + work.T @ static)
    # What adds up to the stiffness, without its cancellation: where a shape is rigid motion, all of it cancels.
    noise = _NOISE * np.einsum("ik,ik->k", np.abs(static), abs(stiffness) @ np.abs(static))
    size = np.sqrt(np.outer(np.maximum(np.diag(full), noise), squares))
    coupled = float(np.max(np.abs(work.T @ motion[:, count:]) / size, initial=0.0))
    if coupled > _COUPLED:
        raise AnalysisError(
            f"reduction: static shapes and modes are coupled by {coupled:.2g} of their stiffness, which should be "
            "zero; the matrices are too badly conditioned: look for elements that are much smaller or stiffer than "
            "the others"
        )
    # A free body shall move freely: what is rounding is zero, and no stiffness is negative.
    scale = np.sqrt(np.where(noise > 0.0, noise, 1.0))
    values, vectors = np.linalg.eigh(full / np.outer(scale, scale))
    vectors = scale[:, None] * vectors[:, values > 1.0]
    reduced = np.zeros((motion.shape[1], motion.shape[1]))
    reduced[:count, :count] = (vectors * values[values > 1.0]) @ vectors.T
    reduced[count:, count:] = np.diag(squares)
    return np.asarray(0.5 * (reduced + reduced.T))


@dataclass(frozen=True, eq=False)
class _Observer:
    """A place and its displacement as a mean of degrees of freedom: position (3,), rows (s,), mean (6, s)."""

    position: FloatArray
    rows: IntArray
    mean: FloatArray


def _frames(
    interfaces: Mapping[str, Interface], observers: Mapping[str, _Observer], motion: FloatArray, names: list[str]
) -> dict[str, Frame]:
    """Motion of interfaces and points, from the motion of all degrees of freedom by the coordinates."""
    frames = {}
    for name, observer in observers.items():
        transform = observer.mean @ motion[observer.rows]
        # What is a coordinate is one without rounding.
        for freedom in interfaces[name].freedoms if name in interfaces else ():
            k = FREEDOMS.index(freedom)
            transform[k] = 0.0
            transform[k, names.index(f"{name}.{freedom}")] = 1.0
        frames[name] = Frame(observer.position, transform)
    return frames


def _checked(
    model: FiniteElementModel, interfaces: Mapping[str, Interface], points: Mapping[str, Point], cutoff: float
) -> tuple[dict[str, Spider], dict[str, _Observer]]:
    """Find the degrees of freedom of interfaces and points; raise with all that does not fit."""
    problems = Problems()
    if not 0.0 < cutoff <= HIGHEST_CUTOFF:
        problems.append(f"cutoff: got {cutoff!r} Hz; allowed: above 0, up to {HIGHEST_CUTOFF:.0e} Hz")
    if not interfaces:
        problems.append("interfaces: got none; allowed: at least one place where forces act")
    problems += [
        f"points: {name!r} is the name of an interface, which is observed anyway; allowed: names apart"
        for name in points
        if name in interfaces
    ]
    spiders: dict[str, Spider] = {}
    observers: dict[str, _Observer] = {}
    for name, entry in interfaces.items():
        with problems:
            spiders[name] = spider(model, name, entry)
            observers[name] = _Observer(entry.position, spiders[name].rows, spiders[name].mean)
    for name, point in points.items():
        with problems:
            observers[name] = _observer(model, name, point)
    owner: dict[int, str] = {}
    for name, entry in sorted(interfaces.items(), key=lambda item: item[1].kind != "rigid"):
        taken = [node for node in entry.nodes.tolist() if node in owner]
        if taken:
            problems.append(
                f"interface {name!r}, nodes: {named(np.array(taken))} belong{'s' if len(taken) == 1 else ''} to the "
                f"rigid interface {owner[taken[0]]!r} too; allowed: a rigid interface has its nodes for itself"
            )
        elif entry.kind == "rigid":
            owner |= dict.fromkeys(entry.nodes.tolist(), name)
    problems.check()
    return spiders, observers


def _observer(model: FiniteElementModel, name: str, point: Point) -> _Observer:
    """Find the degrees of freedom of a point."""
    if isinstance(point, Interface):
        legs = spider(model, name, point)
        return _Observer(point.position, legs.rows, legs.mean)
    if isinstance(point, (int, np.integer)):
        node = int(point)
    else:
        place = np.asarray(point, dtype=np.float64)
        if place.shape != (3,) or not np.all(np.isfinite(place)):
            raise InputError(f"point {name!r}: got {point!r:.80}; allowed: three finite lengths in m, or a node number")
        node = nearest_node(model, place.tolist())
        away = float(np.linalg.norm(model.position(node) - place))
        extent = float(np.max(np.ptp(model.positions, axis=0)))
        if away > NEAREST * extent:
            raise InputError(
                f"point {name!r}: got {place.tolist()} m, {away:.4g} m from the nearest node {node}; allowed: within "
                f"{NEAREST * extent:.4g} m of a node; check place and unit"
            )
    if not model.has_position(node) or model.row(node, 0) is None:
        raise InputError(f"point {name!r}: got node {node}; allowed: a node with a position and displacements")
    rows = {d: row for d in range(6) if (row := model.row(node, d)) is not None}
    mean = np.zeros((6, len(rows)))
    mean[list(rows), np.arange(len(rows))] = 1.0
    return _Observer(model.position(node), np.array(list(rows.values()), dtype=np.int64), mean)
