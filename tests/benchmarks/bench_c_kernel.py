"""What a call of the exported C costs beside that of the library, and whether the Windows build gives the same numbers.

    python -m tests.benchmarks.bench_c_kernel MAP.nc [--wine]

`--wine` builds by the package ziglang and runs by wine, which Debian has as `wine64`.
"""

from __future__ import annotations

import argparse
import ctypes
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
from numba import njit

from ehdmaps.exports.c.kernel import KernelOptions, kernel_files
from ehdmaps.kernel.library import function
from ehdmaps.maps.emap import open_map
from mbs import Bearing, BearingForce

TIMING = Path(__file__).parents[1] / "data" / "c" / "timing.c"
LOOSE = "-O3 -march=native -fno-math-errno -fno-trapping-math -fassociative-math -fno-signed-zeros"
FLAGS = ("-O2", "-O3", "-O3 -march=native", "-O3 -march=native -ffp-contract=fast", LOOSE)
U, T = 1.0, 313.15


FORCE = function("ehd_cylinder_force", ctypes.c_void_p)


@njit
def called(address, state, answer, count):
    total = 0.0
    for i in range(count):
        state[2] = 1e-6 + 1e-12 * i
        FORCE(address)
        total += answer[0, 1]
    return total


def python_time(force, tilt, calls=20000):
    """Microseconds of a call of the library that Python calls, from compiled code."""
    at = force.at(U, T)
    at([0.0, 3e-6, 1e-6, 0.0, tilt, 2.0 * tilt], [0.0, 1e-4, 0.0, 0.0, 10.0 * tilt, 0.0], 0.1)
    best, given = np.inf, (at.address.data, at.state, at.answer)
    called(*given, 10)
    for _ in range(15):
        begin = time.process_time()
        called(*given, calls)
        best = min(best, (time.process_time() - begin) / calls)
    return 1e6 * best


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("map", type=Path)
    parser.add_argument("--wine", action="store_true")
    arguments = parser.parse_args()
    emap = open_map(arguments.map)
    force = BearingForce(Bearing(emap.bearing), emap.law("series"))
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for file, text in kernel_files(emap, KernelOptions(clearance=0.0), ["timing"]).items():
            (folder / file).write_text(text)
        source = [str(TIMING), "ehd.c", "-I."]
        printed = {}
        print(f"{emap.bearing.rollers} x 41 slices, us a call: level, tilted; a new speed; one call of the law")
        for flags in FLAGS:
            subprocess.run(["gcc", "-std=c99", *flags.split(), *source, "-o", "run", "-lm"], cwd=folder, check=True)
            *forces, took = subprocess.run(
                [folder / "run", str(U), str(T)], capture_output=True, text=True, check=True
            ).stdout.splitlines()
            printed[flags] = forces
            level, tilted, prepared, law = map(float, took.split())
            ratios = level / python_time(force, 0.0), tilted / python_time(force, 1e-5)
            print(
                f"gcc {flags}: {level:.2f}, {tilted:.2f}; {prepared:.1f}; {law:.3f}; "
                f"times the library: {ratios[0]:.2f}, {ratios[1]:.2f}"
            )
        if arguments.wine:
            zig = [sys.executable, "-m", "ziglang", "cc", "-target", "x86_64-windows-gnu"]
            command = [*zig, "-std=c99", "-D__USE_MINGW_ANSI_STDIO=1", "-O2", *source]
            subprocess.run([*command, "-o", "run.exe", "-lm"], cwd=folder, check=True)
            wine = next(path for path in ("/usr/lib/wine/wine64", "wine") if path == "wine" or Path(path).exists())
            found = subprocess.run(
                [wine, "run.exe", str(U), str(T)], cwd=folder, capture_output=True, text=True, check=True,
                env={"WINEPREFIX": str(folder / "prefix"), "WINEDEBUG": "-all", "PATH": "/usr/bin:/bin", "HOME": name},
            ).stdout.splitlines()[:-1]  # fmt: skip
            values = [
                np.array([float.fromhex(text) for line in lines for text in line.split()])
                for lines in (printed["-O2"], found)
            ]
            print(f"wine: largest relative difference of forces {np.max(np.abs(values[1] / values[0] - 1.0)):.1e}")


if __name__ == "__main__":
    main()
