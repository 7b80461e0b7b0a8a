"""Modes of machines with exact films, with memory and with slow films side by side.

Run: python -m tests.benchmarks.film_modes nu308.nc [--scene gearbox] [--speed 500] ...

Exact: films by the solver itself at 72 loads, for both contacts and each speed, at the complex frequency of each mode
(`tests.cases.exact_films`); Newton's method from the mode with memory. Memory and slow: `mbs modes --films memory` and
`--films slow` with the map; memory is the law that runs have in time, for small motion. Corrected: memory with what its
film law leaves out, as `mbs modes` states it. The loads of the slices are those of the map's equilibrium for all.
Listed are the modes below 12 kHz that oscillate and have 5 % and more of their strain energy in bearings; a mode of
slow films is the one whose shape is most alike (MAC, mass-weighted).

Below, for the bearings of each machine: the error of the dynamic stiffness along the load beside exact films, and what
the analyses state as its estimate.
"""

from __future__ import annotations

import argparse
import math
import time

import numpy as np
from threadpoolctl import threadpool_limits

from ehdmaps.arrays import ComplexArray, FloatArray
from ehdmaps.maps.emap import EHDMap, open_map
from mbs.analyses.film_errors import film_errors
from mbs.linearised.averaged import steady_system
from mbs.linearised.dynamic import element_dynamic_stiffness
from mbs.linearised.modes import Modes, modes
from mbs.model.elements import Operation
from mbs.model.equilibrium import Equilibrium, equilibrium
from mbs.scene.assembly import Model, assemble
from mbs.scene.reader import read_scene
from tests.cases.exact_films import HIGHEST, ExactFilms, ExactMachine

MACHINES = (("gearbox", 30e-6), ("nu308_rigid", 0.0), ("nu308_rigid", 20e-6))
"""Scenes with their clearances [m]."""

SPEEDS = (500.0, 1500.0, 2500.0)
"""[rpm]."""

FREQUENCIES = (500.0, 2000.0, 4000.0)
"""At which the stiffness of bearings is compared [Hz]."""

_LEAST_SHARE = 0.05


def kind(emap: EHDMap, scene: str, clearance: float, rpm: float, films: str) -> tuple[Model, Equilibrium, Modes]:
    """A machine with slow films or films with memory: model, equilibrium, modes."""
    model = assemble(read_scene(scene), "map", emap, clearance, "memory" if films == "memory" else "slow")
    balance = equilibrium(steady_system(model.system), Operation(rpm * math.pi / 30.0))
    return model, balance, modes(balance)


def likeness(first: ComplexArray, second: ComplexArray, mass: FloatArray) -> float:
    """Mass-weighted modal assurance criterion of two shapes."""
    sizes = [float((shape.conj() @ mass @ shape).real) for shape in (first, second)]
    return float(abs(first.conj() @ mass @ second) ** 2 / (sizes[0] * sizes[1]))


def compare(
    emap: EHDMap, scene: str, clearance: float, rpm: float, known: dict[tuple[float, float], ExactFilms]
) -> None:
    """Print the modes of a machine at a speed, and the errors of its bearings."""
    begin = time.process_time()
    model, balance, memory = kind(emap, scene, clearance, rpm, "memory")
    _, slow_balance, slow = kind(emap, scene, clearance, rpm, "slow")
    exact = ExactMachine(balance, emap.lubricant, known)
    mass = balance.system.mass
    share = memory.shares[[memory.parts.index(bearing.name) for bearing in exact.bearings]].sum(axis=0)
    print(f"\n{scene}, {1e6 * clearance:g} um, {rpm:g} rpm: f/Hz, damping ratio/%")
    print(f"{'share':>6s}{'exact':>18s}{'memory':>18s}{'corrected':>18s}{'slow':>18s}   MAC with exact: memory, slow")
    found: list[complex] = []
    failed = 0
    for k in np.flatnonzero((memory.eigenvalues.imag > 0.0) & (share >= _LEAST_SHARE) & (memory.frequency < HIGHEST)):
        true = exact.mode(complex(memory.eigenvalues[k]), memory.shapes[:, k])
        if true is None:
            failed += 1
            continue
        value, shape = true
        found.append(value)
        swinging = np.flatnonzero(slow.eigenvalues.imag > 0.0)
        like = [likeness(shape, slow.shapes[:, j], mass) for j in swinging]
        j = int(swinging[int(np.argmax(like))])
        law = memory.film_law
        assert law is not None
        pairs = [
            (abs(one) / (2.0 * math.pi), -one.real / abs(one))
            for one in (value, complex(memory.eigenvalues[k]), complex(slow.eigenvalues[j]))
        ]
        corrected = (memory.frequency[k] + law.frequency[k], memory.damping_ratio[k] + law.damping_ratio[k])
        pairs.insert(2, corrected)
        cells = "".join(f"{frequency:11.1f} /{100.0 * ratio:5.2f}" for frequency, ratio in pairs)
        alike = likeness(shape, memory.shapes[:, k], mass)
        print(f"{100.0 * share[k]:5.0f}%{cells}   {alike:.3f}  {max(like):.3f}")
    apart = np.abs(np.subtract.outer(found, found)) + np.eye(len(found)) * 1e9
    assert apart.size == 0 or apart.min() > 1e-6 * abs(min(found, key=abs)), "two modes became one"
    print(f"  {len(found)} modes, {failed} without an exact one; {len(memory.lost)} lost with memory")
    print("  dynamic stiffness along the load, error beside exact films (estimated) [%]")
    estimates = [film_errors(model, balance.displacement, balance.operation, kind) for kind in ("slow", "memory")]
    names = [connected.element.name for connected in balance.system.elements]
    for n, slices in enumerate(exact.bearings):
        force = balance.forces[names.index(slices.name)][1:3]
        along = np.array([0.0, *(force / np.linalg.norm(force)), 0.0, 0.0, 0.0])
        cells = ""
        for frequency in FREQUENCIES:
            s = 2j * math.pi * frequency
            true_stiffness = slices.stiffness(s)
            cells += f"  {frequency:g} Hz:"
            for word, one, estimate in zip(("slow", "memory"), (slow_balance, balance), estimates, strict=True):
                index = names.index(slices.name)
                z = along @ element_dynamic_stiffness(one, index, np.array([s]))[0] @ along
                error = abs(z - true_stiffness) / abs(true_stiffness)
                cells += f" {word} {100.0 * error:.1f} ({100.0 * estimate[n].at(frequency):.1f})"
        print(f"  {slices.name:<15s}{cells}")
    print(f"  {time.process_time() - begin:.0f} s", flush=True)


def main() -> None:
    """Print all machines."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("map", help="map of NU308, made by `ehdmaps generate nu308`")
    parser.add_argument("--scene", choices=sorted({scene for scene, _ in MACHINES}), help="only this one")
    parser.add_argument("--speed", type=float, action="append", help="[rpm]; more than once")
    given = parser.parse_args()
    emap = open_map(given.map)
    known: dict[tuple[float, float], ExactFilms] = {}
    for scene, clearance in MACHINES:
        for rpm in given.speed or SPEEDS:
            if given.scene in (None, scene):
                compare(emap, scene, clearance, rpm, known)


if __name__ == "__main__":
    with threadpool_limits(1):
        main()
