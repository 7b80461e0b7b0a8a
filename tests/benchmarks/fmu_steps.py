"""Stiffness and damping of a unit with films of memory in Co-Simulation, over the step, beside those of its equations.

    python -m tests.benchmarks.fmu_steps MAP.nc

The ring of the bearing swings by 20 nm along its load. MAP.nc is a map of a bearing, for instance nu308.nc.
"""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

import numpy as np

from ehdmaps.jobs.cli import main
from tests.cases.fmu import Unit
from tests.cases.fmu_steps import Rest, linearised, stepped, swung

REST = Rest(place=25e-6, speed=150.0, temperature=313.15)
STEPS = (1e-6, 5e-6, 9e-6, 10e-6, 20e-6, 50e-6)


def compare(source: str) -> None:
    """Print the table."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "unit.fmu"
        options = ["--films", "memory", "--slices", "9", "--clearance", "20 um"]
        assert main(["export", source, "--to", "fmu", "-o", str(file), *options]) == 0
        unit = Unit(file, Path(folder) / "unit")
        print("beside the equations of the unit: stiffness and damping with velocities, the same without;")
        print("damping of a mass on a held force, on an extrapolated one")
        for frequency in (300.0, 1e3, 3e3):
            stiffness, damping = linearised(unit, REST, frequency)
            print(f"{frequency:g} Hz: {stiffness * 1e-6:.4g} N/um, {damping * 1e-3:.4g} N s/mm")
            mass = stiffness / (2.0 * np.pi * frequency) ** 2
            for step in STEPS:
                found = []
                for given in (True, False):
                    k, c = stepped(unit, REST, frequency, step, velocities=given)
                    found += [k / stiffness, c / damping]
                found += [swung(unit, REST, mass, frequency, step, way) / damping for way in (False, True)]
                print(f"  {step * 1e6:3g} us  " + "  ".join(f"{part:8.4f}" for part in found))


if __name__ == "__main__":
    compare(sys.argv[1])
