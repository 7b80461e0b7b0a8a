"""Films with memory in the kernel in C: what the table of the locked film costs in accuracy, and what calls take.

Run: python -m tests.benchmarks.film_export nu308.nc
"""

from __future__ import annotations

import argparse
import contextlib
import io
import math
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.exports.c.kernel import locked_table
from ehdmaps.jobs.cli import main as export
from ehdmaps.maps.emap import open_map
from ehdmaps.maps.kernels.memory import FilmMemory
from ehdmaps.maps.law import ContactLaw
from tests.cases.c_kernel import Kernel, compiled

PLACES, STEPS = 60, (1e-6, 1e-5, 1e-4)
"""Random speeds and temperatures of the map, and lengths of the quick step [s]."""


def main() -> None:
    """Print errors and times."""
    parser = argparse.ArgumentParser(description="Films with memory in the kernel in C.")
    parser.add_argument("map", help="map of a bearing")
    given = parser.parse_args()
    errors = _errors(open_map(given.map).law("series"))
    print(
        f"stiffness of quick steps with the table against the map, largest over the load at each of {PLACES} places: "
        f"median {np.median(errors):.1e}, 90 % {np.quantile(errors, 0.9):.1e}, largest {np.max(errors):.1e}"
    )
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name) / "c"
        with contextlib.redirect_stdout(io.StringIO()):
            assert export(["export", given.map, "--to", "c", "-o", str(folder)]) == 0
        _times(Kernel(compiled(folder, "-shared", "-fPIC")))


def _errors(law: ContactLaw) -> FloatArray:
    """Largest relative error of the stiffness at the end of quick steps, at random places."""
    table, rng, delta = locked_table(law), np.random.default_rng(0), np.linspace(1e-6, 3e-5, 200)
    (slow, fast), found = law.speed_range, []
    for _ in range(PLACES):
        u, T = math.exp(rng.uniform(math.log(slow), math.log(fast))), rng.uniform(*law.temperature_range)
        exact = law.at(u, T).memory
        held = FilmMemory(law.at(u, T).point, law.contacts, u, table.at(u, T), lambda loads: None)
        inside = exact.settled(delta).load > law.load_range[0]
        pairs = [
            [memory.advance(memory.settled(delta), 1.01 * delta, step)[1] for memory in (exact, held)] for step in STEPS
        ]
        found.append(max(float(np.max(np.abs(other / one - 1.0)[inside])) for one, other in pairs))
    return np.array(found)


def _times(kernel: Kernel) -> None:
    """Print what calls take from Python, of a bearing of 12 rollers with 41 slices."""
    pose, speeds = np.array([0.0, 1e-5, 0.0, 0.0, 0.0, 0.0]), iter(np.linspace(1.0, 2.0, 1000))
    kernel.make(0.0, 41)
    kernel.film_at(1.0, 313.15)
    _, states = kernel.settled(pose, 0.0, 12 * 41)
    for words, call in (
        ("a new speed", lambda: kernel.film_at(next(speeds), 313.15)),
        ("a step of 492 films", lambda: kernel.advance(states, pose + 1e-9, 0.0, 1e-5, 1e-5)),
        ("rates of 492 films", lambda: kernel.rates(pose + 1e-9, 0.0, states[:, 0])),
    ):
        print(f"{words}: {1e6 * _usual(call):.0f} us")


def _usual(call: Callable[[], object]) -> float:
    """Median of many calls [s]."""
    took = []
    for _ in range(200):
        begin = time.perf_counter()
        call()
        took.append(time.perf_counter() - begin)
    return float(np.median(took))


if __name__ == "__main__":
    main()
