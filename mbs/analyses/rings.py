"""How the rings of the bearings of a model move."""

from __future__ import annotations

from ehdmaps.arrays import FloatArray
from mbs.bearings.bearing_element import BearingElement
from mbs.scene.assembly import Model


def ring_motions(model: Model, displacement: FloatArray) -> list[tuple[BearingElement, FloatArray]]:
    """Each bearing with the displacement (6,) of its inner ring against the outer one."""
    return [(bearing, model.system.relative(bearing.inner, bearing.outer) @ displacement) for bearing in model.bearings]
