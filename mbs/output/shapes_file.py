"""Mode shapes as a file for ParaView: lines at rest, and the displacement of each mode as a vector to warp by."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from ehdmaps.extras import needs
from ehdmaps.outputs import MARK, Kind, has_mark, written_aside
from mbs.linearised.modes import Modes
from mbs.linearised.shapes import AXIS, EDGE, JOINT, Skeleton
from mbs.linearised.shapes import MARK as ACROSS

SHAPES = Kind("mode shapes of mbs", (".vtu",), has_mark)

MOST_SHAPES = 500
_KINDS = (AXIS, EDGE, ACROSS, JOINT)


def write_shapes(path: Path, found: Modes, bones: Skeleton, shown: Sequence[int]) -> None:
    """Write some modes: point data ``mode_003_1234Hz_real`` and ``_imaginary``, of which the largest is 1.

    Parameters
    ----------
    path : Path
        A .vtu file.
    found : Modes
        All modes.
    bones : Skeleton
        Places and lines of the system.
    shown : sequence of int
        Indices of the modes that are written.

    Raises
    ------
    InputError
        If it cannot be written.
    DependencyError
        If meshio is not installed.
    """
    with needs("flexible", "meshio", "mode shapes for ParaView"):
        import meshio

    data: dict[str, Any] = {"body": bones.owners.astype(np.int32)}
    for mode in shown[:MOST_SHAPES]:
        moved = bones.displacement(found.shapes[:, mode])
        largest = float(np.max(np.abs(moved), initial=0.0))
        moved = moved / largest if largest > 0.0 else moved
        name = f"mode_{mode + 1:03d}_{found.frequency[mode]:.4g}Hz"
        data |= {f"{name}_real": moved.real.copy(), f"{name}_imaginary": moved.imag.copy()}
    kinds = np.array([_KINDS.index(kind) for kind in bones.kinds], dtype=np.int32)
    mesh = meshio.Mesh(bones.points, [("line", bones.lines)], point_data=data, cell_data={"kind": [kinds]})
    with written_aside(path, SHAPES) as aside:
        mesh.write(aside)
        with aside.open("a", encoding="utf-8") as file:
            file.write(f"<!-- {MARK} -->\n")
