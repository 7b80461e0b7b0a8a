"""Answer of `--auto` beside that of all physics that can be had: a grease, a rough, a fast, a tilted and a hot bearing.

Run: python -m tests.benchmarks.auto_policy [--scenes grease rough]

Each scene has two bearings on a shaft, at one speed. All physics are film memory, oil supply and roughness as stated,
inlet heat where its rule holds, and a limiting stress, whatever they change. The differences of stiffness and damping
stand beside what `--auto` itself states as left out. The last column has what heat in the whole film makes of k and c
of the most loaded inner contact, solved with temperatures and limiting stress beside the shear law of `--auto`.
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
from ehdmaps.ehl.solver import ReynoldsSolver
from ehdmaps.physics.oil_supply import OilSupply
from ehdmaps.physics.surface import Surface
from mbs.bearings.bearing_element import BearingElement
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


def heat_in_the_film(scene: Scene, look: LinearLook, limiting: bool) -> str:
    """Changes of k and c of the most loaded inner contact by heat in its film, the largest of all bearings."""
    plain = ReynoldsSolver(shear="limiting" if limiting else "newtonian")
    warm, changes = ReynoldsSolver(physics="thermal", shear="limiting"), []
    balance, oil = look.balance, scene.lubricant
    elements = [entry.element for entry in balance.system.elements if isinstance(entry.element, BearingElement)]
    assert oil is not None
    for element, load in zip(elements, look.loads.tolist(), strict=True):
        contact = element.bearing.geometry.contacts(element.bearing.material, "iso16281")[0]
        at = contact, oil, (load,), element.entrainment_speed(balance.operation), element.temperature
        found = []
        for solver in (plain, warm):
            film = solver.solve_line(*at)[0]
            if not film.status.usable:
                return f"{film.status.word}: {film.reason}"
            stiffness = 1.0 / (float(contact.structural_compliance(load)) + film.film_compliance)
            found.append((stiffness, film.loss_compliance * stiffness**2))
        changes.append([new / old - 1.0 for old, new in zip(*found, strict=True)])
    return ", ".join(percent(max(map(abs, each))) for each in zip(*changes, strict=True))


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
    heat = heat_in_the_film(scene, auto.result, any("shear" in physics for physics in on))
    return f"| {name} | {switched} | {' | '.join(percent(part) for part in parts)} | {left_out} | {heat} |"


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    known = scenes()
    parser.add_argument("--scenes", nargs="+", choices=list(known), default=list(known))
    asked = parser.parse_args()
    numbers = "k | c | frequency | damping ratio"
    head = f"scene | `--auto` has | all physics has | {numbers} | left out, as stated | k, c by heat"
    print(f"| {head} |")
    print("|---|---|---|---|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as folder:
        for name in asked.scenes:
            print(row(name, known[name], Path(folder)), flush=True)


if __name__ == "__main__":
    main()
