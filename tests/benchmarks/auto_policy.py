"""Answer of `--auto` beside that of all physics that can be had: a grease, a rough, a fast, a tilted and a hot bearing.

Run: python -m tests.benchmarks.auto_policy [--scenes grease rough]

Each scene has two bearings on a shaft, at one speed. All physics are film memory, oil supply and roughness as stated,
inlet heat where its rule holds, and a limiting stress, whatever they change. The differences of stiffness and damping
stand beside what `--auto` itself states as left out.
"""

from __future__ import annotations

import argparse
import dataclasses
import math
import tempfile
from importlib import resources
from pathlib import Path

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.physics.oil_supply import OilSupply
from ehdmaps.physics.surface import Surface
from mbs.budget.linear_look import LinearLook, LinearReference, linear_look
from mbs.planning.auto import Automatic, AutoSettings, automatic
from mbs.planning.question import at_one_speed
from mbs.planning.verdicts import percent
from mbs.scene.reader import parse_scene
from mbs.scene.scene import Scene

HIGHEST = 5000.0
"""Frequency up to which modes count [Hz]."""

EVERYTHING = 1e-9
"""Tolerance above which all that changes anything is switched on."""


def scenes() -> dict[str, Scene]:
    """The scenes by their names."""
    text = (resources.files("mbs") / "systems" / "nu308_rigid.toml").read_text(encoding="utf-8").split("[runup]")[0]
    tilting = text.replace('force = ["0 N", "100 N", "100 N"]', 'force = ["0 N", "100 N", "900 N"]', 1)
    plain, tilted = (at_one_speed(parse_scene(one, "policy", "policy.toml")) for one in (text, tilting))
    return {
        "grease": dataclasses.replace(plain, supply=OilSupply.named("grease")),
        "rough": dataclasses.replace(plain, surface=Surface(3e-7)),
        "fast": dataclasses.replace(plain, speed=6000.0 * math.pi / 30.0),
        "tilted": tilted,
        "hot": dataclasses.replace(plain, temperature=383.15),
    }


def analysed(scene: Scene, tolerance: float, folder: Path) -> Automatic[LinearLook]:
    """The linear system with the physics of a tolerance."""
    settings = AutoSettings(tolerance=tolerance, highest=HIGHEST, folder=folder)
    return automatic(scene, linear_look, settings)


def along_loads(look: LinearLook) -> FloatArray:
    """Stiffness and damping of each bearing along its load, (2, bearings)."""
    found = []
    balance = look.balance
    for force, *matrices in zip(balance.forces, balance.element_stiffness, balance.element_damping, strict=True):
        size = float(np.linalg.norm(force[1:3]))
        along = force[1:3] / size
        found.append([float(along @ matrix[1:3, 1:3] @ along) for matrix in matrices])
    return np.array(found[: look.loads.size]).T


def row(name: str, scene: Scene, folder: Path) -> str:
    """A row of the table."""
    auto = analysed(scene, 0.05, folder)
    full = analysed(scene, EVERYTHING, folder)
    on, more = (
        [verdict.physics for verdict in found.verdicts[: 3 + 2 * len(scene.bearings)] if verdict.on]
        for found in (auto, full)
    )
    stiffness, damping = np.max(np.abs(along_loads(auto.result) / along_loads(full.result) - 1.0), axis=1)
    beside = LinearReference.of(full.result, HIGHEST).beside(auto.result)
    parts = [stiffness, damping, *(float(np.nanmax(np.abs(one))) for one in (beside.frequency, beside.damping))]
    left_out = auto.verdicts[-1].words.split(" of a contact")[0]
    switched = f"{', '.join(dict.fromkeys(on)) or 'nothing'} | {', '.join(dict.fromkeys(more))}"
    return f"| {name} | {switched} | {' | '.join(percent(part) for part in parts)} | {left_out} |"


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    known = scenes()
    parser.add_argument("--scenes", nargs="+", choices=list(known), default=list(known))
    asked = parser.parse_args()
    print("| scene | `--auto` has | all physics has | k | c | frequency | damping ratio | left out, as stated |")
    print("|---|---|---|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as folder:
        for name in asked.scenes:
            print(row(name, known[name], Path(folder)), flush=True)


if __name__ == "__main__":
    main()
