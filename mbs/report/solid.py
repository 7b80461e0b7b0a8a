"""Machine in space for shapes that move: its skeleton, with the surfaces of its shafts and their discs."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator
from functools import partial

import numpy as np

from ehdmaps.arrays import FloatArray, IntArray
from mbs.linearised.shapes import Skeleton, skeleton, turned
from mbs.model.body import Body, Frame
from mbs.report.sketch import ring_of
from mbs.scene.assembly import Model
from mbs.scene.specs import ShaftSpec

_AROUND = 16
"""Places around a ring."""


def dressed(model: Model) -> Skeleton:
    """Return the skeleton of a machine with the surfaces of its shafts.

    Parameters
    ----------
    model : Model
        The machine.
    """
    bones, system = skeleton(model.system), model.system
    points, transforms, owners = [bones.points], [bones.transforms], [bones.owners]
    triangles, count = [bones.triangles], len(bones.points)
    specs = {spec.name: spec for spec in model.scene.bodies if isinstance(spec, ShaftSpec)}
    for index, body in enumerate(system.bodies):
        if body.name not in specs or not body.line:
            continue
        for places, moved in _rings(specs[body.name], body):
            whole = np.zeros((len(places), 3, system.size))
            whole[:, :, system.own(body.name)] = moved
            points.append(places)
            transforms.append(whole)
            owners.append(np.full(len(places), index))
            triangles.append(count + _sides())
            count += len(places)
    return dataclasses.replace(
        bones,
        points=np.concatenate(points),
        transforms=np.concatenate(transforms),
        owners=np.concatenate(owners),
        triangles=np.concatenate(triangles),
    )


def _rings(spec: ShaftSpec, body: Body) -> Iterator[tuple[FloatArray, FloatArray]]:
    """Yield places of both ends of each section and disc, (2 n, 3), and their motion by the body, (2 n, 3, q)."""
    for part in spec.sections:
        ends = ((part.begin, part.begin, part.diameter), (part.end, part.end, part.last_diameter))
        yield _tube(spec, body, ends)
    for disc, (begin, end, bore, diameter) in zip(spec.discs, map(partial(ring_of, spec), spec.discs), strict=True):
        if end > begin and diameter > bore:
            # a disc is rigid: both of its ends follow its place
            yield _tube(spec, body, ((disc.position, begin, diameter), (disc.position, end, diameter)))


def _tube(spec: ShaftSpec, body: Body, ends: tuple[tuple[float, float, float], ...]) -> tuple[FloatArray, FloatArray]:
    """Both ends of a cylinder, each by the place on the axis that it follows, its own place, and its diameter."""
    stations = np.array([node.position[0] for node in body.line])
    angles = np.linspace(0.0, 2.0 * np.pi, _AROUND, endpoint=False)
    places, moved = [], []
    for follows, at, diameter in ends:
        x = spec.position[0] + follows
        after = int(np.clip(np.searchsorted(stations, x), 1, len(stations) - 1))
        width = stations[after] - stations[after - 1]
        part = float(np.clip((x - stations[after - 1]) / width, 0.0, 1.0)) if width > 0.0 else 0.0
        both = body.line[after - 1].transform, body.line[after].transform
        node = Frame(np.array([x, *spec.position[1:]]), (1.0 - part) * both[0] + part * both[1])
        for angle in angles.tolist():
            lever = np.array([at - follows, 0.5 * diameter * np.cos(angle), 0.5 * diameter * np.sin(angle)])
            places.append(node.position + lever)
            moved.append(node.transform[:3] + turned(node, lever))
    return np.array(places), np.array(moved)


def _sides() -> IntArray:
    """Triangles of a cylinder with both of its ends, by the places of `_tube`."""
    ring = np.arange(_AROUND)
    after = (ring + 1) % _AROUND
    sides = [
        np.column_stack(part) for part in ((ring, after, ring + _AROUND), (after, after + _AROUND, ring + _AROUND))
    ]
    fan = np.column_stack([np.zeros(_AROUND - 2, dtype=np.int64), ring[1:-1], ring[2:]])
    return np.concatenate([*sides, fan, fan + _AROUND])
