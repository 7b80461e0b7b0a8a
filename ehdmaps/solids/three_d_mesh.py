"""Bricks of a roller and of a raceway, finest at the contact and at the end of the roller; a quarter of the contact.

Both bodies have the same nodes where they may touch. x is across the contact, y along the roller, z up; the planes
x = 0 and y = 0 are planes of symmetry, the contact lies at z = 0.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ehdmaps.arrays import BoolArray, FloatArray, IntArray

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
    found = np.empty((y.size, x.size, parts.size, 3))
    found[..., 0], found[..., 1] = x[None, :, None], y[:, None, None]
    found[..., 2] = surface[None, :, None] + (ground - surface)[None, :, None] * parts
    return found


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
