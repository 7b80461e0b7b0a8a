"""Gear meshes in compiled runs: each feels the compressions of its two flanks. Their functions are in `gear.c`."""

from __future__ import annotations

import ctypes
from collections.abc import Sequence
from typing import ClassVar

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.kernel.library import checked
from ehdmaps.kernel.record import Record, integers, numbers
from mbs.gears.gear import GearMesh
from mbs.model.blocks import Kind, Member, SteadyBlock


class Meshes(Record):
    """Gear meshes as C takes them.

    Attributes
    ----------
    count, harmonics : int
        How many meshes, and harmonics of the longest series.
    firsts, places : array (count,), of int
        First of what each mesh feels, and its place among all elements.
    constants, series : array (count, 5), (count, 4, harmonics)
        Those of `mbs.gears.gear_kernel.MeshData`.
    """

    _fields_ = (
        *((name, ctypes.c_int64) for name in ("count", "harmonics")),
        *((name, integers) for name in ("firsts", "places")),
        *((name, numbers) for name in ("constants", "series")),
    )
    shapes: ClassVar = {
        "firsts": ("count",), "places": ("count",), "constants": ("count", 5), "series": ("count", 4, "harmonics")
    }  # fmt: skip


def _gather(members: Sequence[Member]) -> SteadyBlock:
    """Data of some meshes; series as long as the longest."""
    arrays = [member.element.arrays for member in members]
    series = np.zeros((len(arrays), 4, max((part.shape[1] for _, part in arrays), default=0)))
    for row, (_, part) in zip(series, arrays, strict=True):
        row[:, : part.shape[1]] = part
    firsts, places = (np.array([getattr(m, key) for m in members], dtype=np.int64) for key in ("first", "place"))
    return SteadyBlock(
        checked(Meshes, "ehd_gear_block")(
            count=len(arrays),
            harmonics=series.shape[2],
            firsts=firsts,
            places=places,
            constants=np.array([part for part, _ in arrays]).reshape(len(arrays), 5),
            series=series,
        )
    )


def _compressions(mesh: GearMesh) -> FloatArray:
    """Rows of both flanks."""
    return mesh.rows


GEAR_MESHES = Kind(answer="ehd_gear_block_answer", feels=_compressions, gather=_gather, powers="ehd_gear_block_powers")
"""For `mbs.transient.kinds`."""
