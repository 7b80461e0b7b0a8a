"""An exported bearing read by pyNastran: its numbers beside those of the table that was exported.

Run twice, in one folder for what passes between both environments:

    python -m tests.benchmarks.nastran_export make MAP.nc FOLDER      here: exports a bearing, writes its numbers
    python -m tests.benchmarks.nastran_export compare FOLDER          in an environment with `pip install pyNastran`

Stiffness and damping of the NU308 under 2 kN, 20 deg from y, at 500 rpm and 40 degC, 20 um clearance, 100 Hz to 2 kHz.
"""

from __future__ import annotations

import json
import sys
from argparse import ArgumentParser
from pathlib import Path

import numpy as np

POINT = ["--load", "2 kN", "--direction", "20 deg", "--speed", "500 rpm", "--clearance", "20 um"]
POINT += ["--frequency", "100 Hz", "2 kHz", "9"]
NAME = "bearing.bdf"


def make(source: str, folder: Path) -> None:
    """Export the bearing, and write K and C of its radial plane beside it."""
    from ehdmaps.jobs.cli import main as ehdmaps
    from mbs.exports.linear_table import add_arguments, linear_table

    folder.mkdir(parents=True, exist_ok=True)
    assert ehdmaps(["export", source, "--to", "nastran", "-o", str(folder / NAME), *POINT]) == 0
    parser = ArgumentParser()
    parser.add_argument("--structural-law")
    parser.add_argument("--roughness")
    add_arguments(parser)
    table = linear_table(Path(source), parser.parse_args(POINT))
    found = {"frequencies": table.frequencies, "k": table.stiffness[0], "c": table.damping[0]}
    text = json.dumps({name: values.tolist() for name, values in found.items()})
    (folder / "table.json").write_text(text, encoding="utf-8")


def compare(folder: Path) -> None:
    """Print the largest differences of what pyNastran reads from the table, in the axes of the file."""
    from pyNastran.bdf.bdf import BDF  # type: ignore[import-not-found, unused-ignore]

    model = BDF(debug=False)
    model.read_bdf(str(folder / NAME), punch=True, xref=False)
    wanted = json.loads((folder / "table.json").read_text(encoding="utf-8"))
    (element,) = model.elements.values()
    (dependence,) = model.pbusht.values()
    axes = model.coords[element.cid]
    axes.setup()
    axes = axes.beta()
    for key, ids in (("k", dependence.k_tables), ("c", dependence.b_tables)):
        matrices = np.array(wanted[key])[:, :3, :3]
        along = np.einsum("ai,kij,aj->ka", axes, matrices, axes)
        read = np.array([model.tables_d[number].y for number in ids[:3]]).T
        beside = np.einsum("ai,kij,bj->kab", axes, matrices, axes) - along[:, :, None] * np.eye(3)
        scale = np.max(np.abs(along))
        print(
            f"{key}: largest difference on the diagonal {np.max(np.abs(read - along)) / scale:.1e}, "
            f"left out beside it {np.max(np.abs(beside)) / scale:.1e}, of the largest term"
        )
    frequencies = model.tables_d[dependence.k_tables[1]].x
    print(f"frequencies: largest difference {np.max(np.abs(frequencies - np.array(wanted['frequencies']))):.1e} Hz")


if __name__ == "__main__":
    if sys.argv[1:2] == ["make"]:
        make(sys.argv[2], Path(sys.argv[3]))
    else:
        compare(Path(sys.argv[2]))
