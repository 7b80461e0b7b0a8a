"""The shipped spindle and electric drive over speed: flooded isothermal films, with heat, and with heat on oil layers.

`python -m tests.benchmarks.spindle_films docs/real_films.png`: a row a machine, speed and condition with the largest
load that a raceway of each bearing carries, its radial stiffness and damping in slow motion, and the first modes with
their damping ratios, films with memory; and the figure of the first bearing and of the first two modes over speed.
Without a file, the table alone.
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import NamedTuple

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.physics.oil_supply import FLOODED, OilSupply
from mbs.analyses.modes import modes
from mbs.analyses.statics import statics
from mbs.model.elements import Operation
from mbs.scene.assembly import assemble
from mbs.scene.reader import read_scene

CONDITIONS = (
    ("flooded, isothermal", False, FLOODED, "0.5"),
    ("inlet heat", True, FLOODED, "C3"),
    ("inlet heat, oil air", True, OilSupply.named("oil air"), "C0"),
    ("inlet heat, grease", True, OilSupply.named("grease"), "C2"),
)
"""Words, heat, supply, colour."""

MACHINES = (
    ("spindle", (1000.0, 2000.0, 4000.0, 8000.0, 12000.0, 16000.0), (8000.0, 16000.0)),
    ("electric_drive", (1000.0, 2000.0, 4000.0, 8000.0, 12000.0), (4000.0, 12000.0)),
)
"""Scene, speeds of the figure and of the table [rpm]."""

MODES = 4

RPM = np.pi / 30.0


class Point(NamedTuple):
    """A machine at a speed.

    Attributes
    ----------
    loads, stiffness, damping : array (bearings,)
        Highest load of a raceway [N], radial K [N/m] and C [N s/m] of slow motion.
    frequency, ratio : array (MODES,)
        The first modes [Hz], and their damping ratios.
    """

    loads: FloatArray
    stiffness: FloatArray
    damping: FloatArray
    frequency: FloatArray
    ratio: FloatArray


def at(name: str, rpm: float, heat: bool, supply: OilSupply) -> Point:
    """A machine at a speed.

    Parameters
    ----------
    name : str
        Shipped scene.
    rpm : float
        Speed [rpm].
    heat : bool
        Whether heat in the inlet thins the films.
    supply : OilSupply
        Supply of all bearings.
    """
    model = assemble(read_scene(name), "table", supply=supply, inlet_heat=heat)
    found = statics(model, Operation(rpm * RPM)).dataset
    told = modes(model, Operation(rpm * RPM)).dataset
    K, C = (found[f"bearing_{kind}"].values[:, 1, 1] for kind in ("stiffness", "damping"))
    return Point(
        found["highest_raceway_load"].values,
        K,
        C,
        told["frequency"].values.ravel()[:MODES],
        told["damping_ratio"].values.ravel()[:MODES],
    )


def main(path: Path | None) -> None:
    """Print the table, and draw the figure.

    Parameters
    ----------
    path : Path or None
        File of the figure.
    """
    print("| machine | rpm | films | highest loads, N | K, N/um | C, N s/mm | modes, Hz (damping ratio, %) |")
    print("|---|---|---|---|---|---|---|")
    drawn: dict[tuple[str, str], list[Point]] = {}
    for name, every, told in MACHINES:
        for rpm in every if path else told:
            for words, heat, supply, _ in CONDITIONS:
                point = at(name, rpm, heat, supply)
                drawn.setdefault((name, words), []).append(point)
                if rpm in told:
                    print(_row(name, rpm, words, point), flush=True)
    if path is not None:
        _draw(path, drawn)


def _row(name: str, rpm: float, words: str, point: Point) -> str:
    """A row of the table."""
    cells = (
        name,
        f"{rpm:.0f}",
        words,
        ", ".join(f"{value:.0f}" for value in point.loads),
        ", ".join(f"{1e-6 * value:.0f}" for value in point.stiffness),
        ", ".join(f"{1e-3 * value:.3f}" for value in point.damping),
        ", ".join(f"{f:.0f} ({100.0 * ratio:.3f})" for f, ratio in zip(point.frequency, point.ratio, strict=True)),
    )
    return f"| {' | '.join(cells)} |"


def _draw(path: Path, drawn: dict[tuple[str, str], list[Point]]) -> None:
    """Draw the first bearing and the first two modes of both machines over speed."""
    import matplotlib as mpl

    mpl.use("Agg")
    from matplotlib import pyplot as plt

    panels = (
        ("highest load of a raceway, N", lambda p: p.loads[:1]),
        ("radial stiffness K, N/um", lambda p: 1e-6 * p.stiffness[:1]),
        ("damping C, N s/mm", lambda p: 1e-3 * p.damping[:1]),
        ("first two modes, Hz", lambda p: p.frequency[:2]),
        ("their damping ratios, %", lambda p: 100.0 * p.ratio[:2]),
    )
    figure, grid = plt.subplots(len(MACHINES), len(panels), figsize=(16.0, 6.4), layout="constrained")
    for row, (name, speeds, _) in zip(grid, MACHINES, strict=True):
        for axes, (words, read) in zip(row, panels, strict=True):
            for label, _, _, colour in CONDITIONS:
                values = np.array([read(point) for point in drawn[name, label]])
                for mode, line in enumerate(("-", "--")[: values.shape[1]]):
                    axes.plot(
                        1e-3 * np.array(speeds), values[:, mode], line, color=colour, marker="o", ms=3,
                        label=None if mode else label,
                    )  # fmt: skip
            axes.set_title(words, fontsize=9)
            axes.set_ylim(bottom=0.0)
            axes.grid(alpha=0.3)
        row[0].set_ylabel(name.replace("_", " ") + ", first bearing")
        for axes in row:
            axes.set_xlabel("speed, 1000 rpm")
    grid[0][0].legend(fontsize=8)
    figure.savefig(path, dpi=80)


if __name__ == "__main__":
    main(Path(sys.argv[1]) if sys.argv[1:] else None)
