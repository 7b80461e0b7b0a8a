"""Shapes of modes in space: places of all bodies, how they move, and the lines that make a picture of them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse.csgraph import minimum_spanning_tree
from scipy.spatial.distance import cdist

from ehdmaps.arrays import ComplexArray, FloatArray, IntArray
from mbs.model.body import Body, Frame
from mbs.model.elements import GROUND
from mbs.model.system import System

AXIS, EDGE, MARK, JOINT = "axis", "edge", "mark", "joint"
"""Kinds of lines: of a shaft, of another body, what shows its turning about x, and a bearing or a mesh of gears."""

_MARK = 0.05
"""Length of a mark across a shaft, as a part of the system."""

_APART = 1e-9
"""Places that are nearer are one, as a part of the system."""


@dataclass(frozen=True, eq=False)
class Skeleton:
    """Places and lines of a system.

    Attributes
    ----------
    points : array, shape (p, 3)
        Places at rest [m].
    transforms : array, shape (p, 3, n)
        Their displacement by the coordinates of the system [m].
    owners : array of int, shape (p,)
        Body of each place.
    lines : array of int, shape (l, 2)
        Places that a line joins.
    kinds : tuple of str
        What each line is.
    bodies : tuple of str
        Names of the bodies.
    size : float
        Largest extent of the system [m].
    triangles : array of int, shape (t, 3)
        Places that are corners of the surface of a body.
    """

    points: FloatArray
    transforms: FloatArray
    owners: IntArray
    lines: IntArray
    kinds: tuple[str, ...]
    bodies: tuple[str, ...]
    size: float
    triangles: IntArray

    def displacement(self, shape: ComplexArray) -> ComplexArray:
        """Displacements of all places in a mode, turned in phase so that they are as real as can be, shape (p, 3).

        Parameters
        ----------
        shape : array of complex, shape (n,)
            A column of `mbs.linearised.modes.Modes.shapes`.
        """
        moved = self.transforms @ shape
        turned = np.exp(-0.5j * np.angle(np.sum(moved * moved)))
        return np.asarray(moved * turned, dtype=np.complex128)

    def scaled(self, shape: ComplexArray) -> ComplexArray:
        """The same as `displacement`, with 1 as the largest part of a displacement; zero where no place moves.

        Parameters
        ----------
        shape : array of complex, shape (n,)
            A column of `mbs.linearised.modes.Modes.shapes`.
        """
        moved = self.displacement(shape)
        largest = float(np.max(np.abs(moved), initial=0.0))
        return moved / largest if largest > 0.0 else moved


def skeleton(system: System) -> Skeleton:
    """Places and lines of a system: shafts along their nodes, other bodies by their surface, else between their frames.

    Parameters
    ----------
    system : System
        The system.
    """
    everything = [frame.position for body in system.bodies for frame in (*body.frames.values(), *body.line)]
    everything += [place for body in system.bodies if body.skin is not None for place in body.skin.positions]
    size = float(np.max(np.ptp(everything, axis=0), initial=0.0)) or 1.0
    points: list[FloatArray] = []
    transforms: list[FloatArray] = []
    owners: list[int] = []
    lines: list[tuple[int, int]] = []
    kinds: list[str] = []
    triangles: list[IntArray] = []

    def add(body: int, place: FloatArray, moved: FloatArray) -> int:
        whole = np.zeros((3, system.size))
        whole[:, system.own(system.bodies[body].name)] = moved
        points.append(place)
        transforms.append(whole)
        owners.append(body)
        return len(points) - 1

    for index, body in enumerate(system.bodies):
        if body.skin is not None:
            triangles.append(len(points) + body.skin.triangles)
            for place, moved in zip(body.skin.positions, body.skin.transforms, strict=True):
                add(index, place, moved)
        nodes = body.line or (() if body.skin is not None else _apart(body, size))
        first = len(points)
        for node in nodes:
            add(index, node.position, node.transform[:3])
        chain = [(place, place + 1) for place in range(len(nodes) - 1)]
        own = chain if body.line else _tree(np.array([node.position for node in nodes]))
        lines += [(first + begin, first + end) for begin, end in own]
        kinds += [AXIS if body.line or body.spin else EDGE] * len(own)
        # Turning about x moves nothing on the axis: a mark beside it does.
        across = np.array([0.0, 0.0, _MARK * size])
        for frame in body.frames.values() if body.spin else ():
            if np.any(frame.transform[3]):
                begin = add(index, frame.position, frame.transform[:3])
                end = add(index, frame.position + across, frame.transform[:3] + turned(frame, across))
                lines.append((begin, end))
                kinds.append(MARK)
    names = {body.name: index for index, body in enumerate(system.bodies)}
    for connected in system.elements:
        for port in connected.element.ports:
            if GROUND in (port.on, port.against):
                continue
            ends = []
            for place in (port.on, port.against):
                body = system.body(place.partition(":")[0])
                frame = body.frames[place.partition(":")[2] or "centre"]
                ends.append(add(names[body.name], frame.position, frame.transform[:3]))
            lines.append((ends[0], ends[1]))
            kinds.append(JOINT)
    return Skeleton(
        np.array(points).reshape(-1, 3),
        np.array(transforms).reshape(-1, 3, system.size),
        np.array(owners, dtype=np.int64),
        np.array(lines, dtype=np.int64).reshape(-1, 2),
        tuple(kinds),
        tuple(names),
        size,
        np.concatenate([np.zeros((0, 3), dtype=np.int64), *triangles]),
    )


def turned(frame: Frame, across: FloatArray) -> FloatArray:
    """Displacement of a place beside a frame by its rotations, shape (3, n).

    Parameters
    ----------
    frame : Frame
        The frame.
    across : array, shape (3,)
        Way from it to the place [m].
    """
    x, y, z = across
    return np.array([[0.0, z, -y], [-z, 0.0, x], [y, -x, 0.0]]) @ frame.transform[3:]


def _apart(body: Body, size: float) -> tuple[Frame, ...]:
    """Frames of a body at different places."""
    frames: list[Frame] = []
    for frame in body.frames.values():
        if all(np.max(np.abs(frame.position - other.position)) > _APART * size for other in frames):
            frames.append(frame)
    return tuple(frames)


def _tree(points: FloatArray) -> list[tuple[int, int]]:
    """The shortest lines that join all places."""
    if len(points) < 2:
        return []
    tree = minimum_spanning_tree(cdist(points, points)).tocoo()
    return [(int(begin), int(end)) for begin, end in zip(tree.row, tree.col, strict=True)]
