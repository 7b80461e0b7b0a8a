"""A rotor that runs up on two units in FMPy's CVODE, beside `mbs runup`.

Run: python -m tests.benchmarks.fmu_rotor nu308.nc
     python -m tests.benchmarks.fmu_rotor nu308.nc --films memory

It exports the map twice, by FMI 2.0 for one bearing and by FMI 3.0 for the other, and prints the largest difference of
each coordinate as a part of what it moves, and what both runs cost. Films with memory are then run in Co-Simulation,
by a master that extrapolates the force. `mbs` makes its steps at three lengths: its error
is of second order, so that the difference has to fall by four each time until that of CVODE is left.
"""

from __future__ import annotations

import argparse
import contextlib
import dataclasses
import io
import tempfile
from pathlib import Path

from ehdmaps.jobs.cli import main as export
from tests.cases.fmu import Unit
from tests.cases.fmu_rotor import Beside, Rotor, RotorOnUnits, side_by_side
from tests.cases.fmu_run import stepped_run

STEPS, TOLERANCES = (8e-6, 4e-6, 2e-6), (1e-6, 1e-8)
"""Of `mbs` [s], and of CVODE."""

ROTOR = Rotor(
    mass=20.0, polar=0.1, transverse=0.15, arm=0.07, place=0.02, load=(300.0, 800.0), unbalance=0.01,
    clearance=10e-6, temperature=313.15, speeds=(0.0, 209.4), duration=1.0, step=STEPS[0], sample=0.2e-3,
)  # fmt: skip
"""From standstill to 2000 rpm."""

ON_FILMS = dataclasses.replace(ROTOR, speeds=(150.0, 152.0), duration=0.05, slices=9)
"""From 1432 to 1451 rpm: with memory each slice has a state, and `mbs` reads its tables of films every eight steps."""

FILM_STEPS = (5e-6, 2.5e-6, 1.25e-6)
MASTER_STEPS = (5e-6, 10e-6, 20e-6, 50e-6)
"""Of Co-Simulation [s]."""


def main() -> None:
    """Print differences and costs."""
    parser = argparse.ArgumentParser(description="A rotor on two units beside mbs runup.")
    parser.add_argument("map", help="map of the NU308, by `ehdmaps generate nu308`")
    parser.add_argument("--films", choices=("slow", "memory"), default="slow", help="films of both")
    given = parser.parse_args()
    rotor, steps = (ROTOR, STEPS) if given.films == "slow" else (ON_FILMS, FILM_STEPS)
    with tempfile.TemporaryDirectory() as name, contextlib.redirect_stderr(io.StringIO()):
        folder = Path(name)
        units = []
        for fmi in "23":
            options = ["--to", "fmu", "--fmi", fmi, "--clearance", "10 um", "-o", str(folder / f"{fmi}.fmu")]
            options += ["--films", given.films, "--slices", str(rotor.slices)]
            with contextlib.redirect_stdout(io.StringIO()):
                assert export(["export", given.map, *options]) == 0
            units.append(Unit(folder / f"{fmi}.fmu", folder / fmi))
        left, right = units
        states = left.description.numberOfContinuousStates
        print(
            f"{rotor.duration:g} s from {rotor.speeds[0]:g} to {rotor.speeds[1]:g} rad/s, {states} states in a unit; "
            "differences of y, z, theta_y, theta_z"
        )
        _one(rotor, given.map, (left, right), folder, TOLERANCES[-1], "to compile, not to be counted")
        for step in steps:
            found = _one(dataclasses.replace(rotor, step=step), given.map, (left, right), folder, TOLERANCES[-1])
        if states:
            for step in MASTER_STEPS:
                stepped = stepped_run(RotorOnUnits(rotor, found.start), (left, right), found.times, step)
                parts = ", ".join(f"{part:.1e}" for part in found.difference(stepped[:, :4]))
                print(f"Co-Simulation in steps of {1e6 * step:g} us: {parts}", flush=True)
        for tolerance in TOLERANCES[:-1]:
            _one(dataclasses.replace(rotor, step=steps[-1]), given.map, (left, right), folder, tolerance)


def _one(
    rotor: Rotor, map_file: str, units: tuple[Unit, Unit], folder: Path, tolerance: float, note: str = ""
) -> Beside:
    """Print one pair of runs, and return it."""
    with contextlib.redirect_stdout(io.StringIO()):
        found = side_by_side(rotor, map_file, units, folder, tolerance)
    runup, cvode = found.seconds
    print(
        f"steps of {1e6 * rotor.step:g} us, CVODE to {tolerance:g}: "
        f"{', '.join(f'{part:.1e}' for part in found.differences)} of what they move "
        f"({', '.join(f'{1e6 * part:.2g}' for part in found.moved)} um or urad); "
        f"mbs runup {runup:.1f} s, CVODE {cvode:.1f} s with {found.calls} calls of each unit"
        + (f"; {note}" if note else ""),
        flush=True,
    )
    return found


if __name__ == "__main__":
    main()
