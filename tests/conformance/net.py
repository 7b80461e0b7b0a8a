"""Net of values: what every law and every kind of bearing answers, to hold a change of the kernels against.

Run it before a change that must change no number by more than round-off, and again after it:

    python -m tests.conformance.net --out before.npz
    python -m tests.conformance.net --against before.npz

laws        of a roller's contacts and of both in series, flooded, starved, rough: scalars, arrays, `at`, steps with
            memory
elements    the bearing of each kind: force, K and C at random poses about its balance, springs of its films, steps with
            memory
runs        every kind alone, and the machine of all kinds, with a residual of 1e-13: forces at every step, and energies

A value may differ by `WITHIN` of the largest of its array; of runs, in which round-off grows, by `RUNS_WITHIN`. The
table names what differs by more, and how far the rest is off. Exit status 1: something does.
"""

from __future__ import annotations

import argparse
import math
import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np

import ehdmaps
from ehdmaps.arrays import FloatArray
from ehdmaps.physics.oil_supply import OilSupply
from ehdmaps.physics.surface import Surface
from mbs import assemble, parse_scene
from mbs.model.elements import Operation
from mbs.model.equilibrium import equilibrium
from mbs.model.profiles import SpeedProfile
from mbs.settings import Settings
from mbs.transient.run import run
from tests.conformance.machines import KINDS, MIXED, Machine

WITHIN, RUNS_WITHIN = 1e-11, 1e-9
"""Differences that round-off may leave, of the largest value of an array."""

SEED = 48
DRY = "hertz:1.25e-5 s"
SPEED, POSES, STEPS, STEP = 150.0, 12, 40, 2e-5

Values = Iterator[tuple[str, FloatArray]]


def law_values() -> Values:
    """Laws at random approaches, rates, speeds and temperatures, beyond the edges of the films, too."""
    rng = np.random.default_rng(SEED)
    count = 200
    approach = rng.uniform(-1e-6, 3e-5, count)
    rate, speed = rng.uniform(-1e-3, 1e-3, count), np.exp(rng.uniform(np.log(0.01), np.log(12.0), count))
    kelvin = rng.uniform(300.0, 370.0, count)
    ways = {
        "flooded": {},
        "starved": {"supply": OilSupply(1e-6)},
        "rough": {"surface": Surface(3e-7)},
    }
    for kind in ("inner", "outer", "series"):
        for way, options in ways.items():
            law = ehdmaps.law("NU308", "FVA3", kind, outside="asymptote", **options)
            name = f"law/{kind} {way}"
            for what, values in zip(("w", "k", "c"), law(approach, rate, speed, kelvin), strict=True):
                yield f"{name} {what}", values
            ones = [law(*one) for one in zip(approach[:20], rate[:20], speed[:20], kelvin[:20], strict=True)]
            yield f"{name} scalars", np.array(ones)[:, 0]
            at = law.at(2.0, 330.0)
            yield f"{name} at", np.concatenate(at(approach, rate))
            if kind == "series":
                yield f"{name} centrifugal", law(approach, rate, speed, kelvin, 50.0)[0]
            if way != "rough":
                state, loads = None, []
                for delta in 1e-5 + 2e-6 * np.sin(0.4 * np.arange(STEPS)):
                    load, _, state = law.advance(state, float(delta), STEP, 2.0, 330.0)
                    loads.append(load)
                yield f"{name} memory", np.array(loads)


def element_values(kind: Machine) -> Values:
    """The bearing of a kind about its balance, dry and with films."""
    rng = np.random.default_rng(SEED)
    for law in (DRY, "table") if kind.films else (DRY,):
        system = assemble(parse_scene(kind.text(), "machine", "machine.toml"), law).system
        operation, connected = Operation(SPEED, 0.1), system.elements[0]
        name, element = f"element/{kind.name}, {law.partition(':')[0]}", connected.element
        rest = connected.transform @ equilibrium(system, operation, tolerance=1e-13).displacement
        size = np.where(np.arange(rest.size) % 6 < 3, 3e-6, 1e-4)
        poses = rest + size * rng.uniform(-1.0, 1.0, (POSES, rest.size))
        speeds = rng.uniform(-1e-3, 1e-3, (POSES, rest.size)) * np.where(size > 1e-5, 10.0, 1.0)
        answers = [element.evaluate(*motion, operation) for motion in zip(poses, speeds, strict=True)]
        for what in ("force", "stiffness", "damping"):
            yield f"{name} {what}", np.array([getattr(answer, what) for answer in answers])
        if law == "table" and hasattr(element, "relaxation"):
            s = 2j * math.pi * np.array([50.0, 1000.0, 8000.0])
            more = element.relaxation(rest, operation).more(s)
            yield f"{name} relaxation", np.concatenate([more.real.ravel(), more.imag.ravel()])
            states, forces = None, []
            for step, phase in enumerate(0.4 * np.arange(STEPS)):
                pose = rest + 0.1 * size * np.sin(phase)
                at = Operation(SPEED, 0.1 + SPEED * STEP * step, STEP * step)
                answer, states = element.advance(states, pose, np.zeros_like(pose), at)
                forces.append(answer.force)
            yield f"{name} memory", np.array(forces)


def run_values(machine: Machine) -> Values:
    """A run-up of a machine whose rotor is pushed, so that contacts part: forces at every step, and energies."""
    for law in (DRY, "table") if machine.films else (DRY,):
        model = assemble(parse_scene(machine.text(), "machine", "machine.toml"), law)
        start = equilibrium(model.system, model.operation, tolerance=1e-13).displacement.copy()
        start[model.system.coordinates.index("rotor.y")] += 4e-6
        course, settings = SpeedProfile.ramp(150.0, 160.0, STEPS * STEP), Settings(STEP, STEP, residual=1e-13)
        found = run(model.system, course, STEPS * STEP, settings, displacement=start)
        name = f"run/{machine.name}, {law.partition(':')[0]}"
        yield f"{name} forces", np.concatenate([np.array(forces).ravel() for forces in found.forces])
        told = [energy for energy in found.energy.elements if energy.told]
        if told:
            yield f"{name} energies", np.array([[one.driven, one.dissipated, one.change] for one in told])


def values(only: str) -> Values:
    """All values whose row has a text in its name."""
    rows = [("law", law_values)]
    rows += [(f"element {kind.name}", lambda kind=kind: element_values(kind)) for kind in KINDS]
    rows += [(f"run {machine.name}", lambda machine=machine: run_values(machine)) for machine in (*KINDS, MIXED[-1])]
    for name, found in rows:
        if only in name:
            yield from found()


def differences(now: dict[str, FloatArray], before: dict[str, FloatArray]) -> list[tuple[float, float, str]]:
    """How far each array is off, over its largest value, and what is allowed, the farthest first."""
    found = []
    for name in sorted(set(now) | set(before)):
        allowed = RUNS_WITHIN if name.startswith("run/") else WITHIN
        one, other = now.get(name), before.get(name)
        if one is None or other is None or one.shape != other.shape or np.any(np.isfinite(one) != np.isfinite(other)):
            found.append((math.inf, allowed, name))
            continue
        largest = np.nanmax(np.abs(np.where(np.isfinite(other), other, 0.0)), initial=0.0)
        off = np.nanmax(np.abs(np.where(np.isfinite(other), one - other, 0.0)), initial=0.0)
        found.append((off / largest if largest else off, allowed, name))
    return sorted(found, key=lambda row: row[0] / row[1], reverse=True)


def main() -> int:
    """Keep the values, or compare them."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    which = parser.add_mutually_exclusive_group(required=True)
    which.add_argument("--out", type=Path)
    which.add_argument("--against", type=Path)
    parser.add_argument("--only", default="", metavar="TEXT", help="rows with a text in their names")
    asked = parser.parse_args()
    now = dict(values(asked.only))
    if asked.out:
        np.savez_compressed(asked.out, **now)
        print(f"{asked.out}: {len(now)} arrays, {sum(array.size for array in now.values())} values")
        return 0
    with np.load(asked.against) as file:
        before = {name: file[name] for name in file.files if not asked.only or name in now}
    rows = differences(now, before)
    wrong = [row for row in rows if row[0] > row[1]]
    for off, allowed, name in [*wrong, *rows[len(wrong) : len(wrong) + 10]]:
        print(f"{'differs' if off > allowed else 'equal  '} {off:9.2g} of the largest, allowed {allowed:g}  {name}")
    print(f"{len(rows) - len(wrong)} of {len(rows)} arrays within round-off")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
