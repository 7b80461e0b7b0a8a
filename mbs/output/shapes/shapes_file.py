"""Mode shapes for ParaView: lines and surfaces at rest, and the displacement of each mode as a vector to warp by."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from xml.sax.saxutils import quoteattr

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.extras import needs
from ehdmaps.outputs import MARK, Kind, has_mark, written_aside
from mbs.linearised.modes import Modes
from mbs.linearised.shapes import AXIS, EDGE, JOINT, Skeleton
from mbs.linearised.shapes import MARK as ACROSS

SHAPES = Kind("mode shapes of mbs", (".vtu", ".pvd"), has_mark)

MOST_SHAPES = 500
FRAMES = 24
"""Of a period of a series."""

_KINDS = (AXIS, EDGE, ACROSS, JOINT, "surface")


def write_shapes(path: Path, found: Modes, bones: Skeleton, shown: Sequence[int]) -> list[Path]:
    """Write some modes, of which the largest displacement is 1, and return the files.

    A .vtu has point data ``mode_003_1234Hz_real`` and ``_imaginary``. A .pvd is a series of `FRAMES` files beside it
    over a period, with the displacement ``mode_003_1234Hz`` at each time, a part of the period.

    Parameters
    ----------
    path : Path
        A .vtu or .pvd file.
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
    shapes = {
        f"mode_{mode + 1:03d}_{found.frequency[mode]:.4g}Hz": bones.scaled(found.shapes[:, mode])
        for mode in shown[:MOST_SHAPES]
    }
    if path.suffix.lower() != ".pvd":
        data: dict[str, FloatArray] = {}
        for name, moved in shapes.items():
            data |= {f"{name}_real": moved.real.copy(), f"{name}_imaginary": moved.imag.copy()}
        _write_mesh(path, bones, data)
        return [path]
    files = series_files(path)
    for frame, file in enumerate(files):
        turned = np.exp(2j * np.pi * frame / FRAMES)
        _write_mesh(file, bones, {name: (moved * turned).real for name, moved in shapes.items()})
    sets = [
        f'<DataSet timestep="{frame / FRAMES:.6g}" file={quoteattr(file.name)}/>' for frame, file in enumerate(files)
    ]
    head = '<?xml version="1.0"?>\n<VTKFile type="Collection" version="0.1">\n<Collection>'
    with written_aside(path, SHAPES) as aside:
        lines = [head, *sets, "</Collection>", "</VTKFile>", f"<!-- {MARK} -->", ""]
        aside.write_text("\n".join(lines), encoding="utf-8")
    return [path, *files]


def series_files(path: Path) -> list[Path]:
    """Files of a series: those of ``modes.pvd`` are ``modes_00.vtu`` and so on, beside it.

    Parameters
    ----------
    path : Path
        The .pvd file.
    """
    return [path.with_name(f"{path.stem}_{frame:02d}.vtu") for frame in range(FRAMES)]


def _write_mesh(path: Path, bones: Skeleton, data: Mapping[str, FloatArray]) -> None:
    """Write lines and surfaces at rest, with point data."""
    with needs("flexible", "meshio", "mode shapes for ParaView"):
        import meshio

    cells = [("line", bones.lines), ("triangle", bones.triangles)]
    kinds = [[_KINDS.index(kind) for kind in bones.kinds], [len(_KINDS) - 1] * len(bones.triangles)]
    there = [place for place, (_, corners) in enumerate(cells) if len(corners)]
    mesh = meshio.Mesh(
        bones.points,
        [cells[place] for place in there],
        point_data={"body": bones.owners.astype(np.int32), **data},
        cell_data={"kind": [np.array(kinds[place], dtype=np.int32) for place in there]},
    )
    with written_aside(path, SHAPES) as aside:
        mesh.write(aside)
        with aside.open("a", encoding="utf-8") as file:
            file.write(f"<!-- {MARK} -->\n")
