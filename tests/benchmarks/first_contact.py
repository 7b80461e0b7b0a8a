"""What the first use of each command costs, with empty caches: processor time [s] with all of its children.

Run: python -m tests.benchmarks.first_contact [NAME ...] [--beside TREE]

Each command runs in a new folder with caches of its own, which are empty at first; `again` is the same once more. The
files of Python are compiled, as pip leaves them. --beside runs each in another checkout of this project as well, right
before, so that both see the same machine: its ratio is what to trust where other work runs.
"""

from __future__ import annotations

import argparse
import os
import resource
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

REPOSITORY = Path(__file__).parents[2]


UNCHECKED = """
from pathlib import Path
from ehdmaps.jobs import solvers
from ehdmaps.jobs.reader import read_job
from ehdmaps.jobs.make.generate import read_in_memory, write_map
job = read_job("nu308")
write_map(read_in_memory(job, solvers.of_map(job)), Path("nu308.nc"), None)
"""

COMMANDS: dict[str, list[str]] = {
    "python": ["-c", "import numpy, scipy.linalg"],
    "bearing of rollers": ["-m", "mbs", "bearing", "NU308", "--load", "5 kN", "--speed", "1500 rpm"],
    "bearing of balls": ["-m", "mbs", "bearing", "6208", "--load", "2 kN", "--speed", "3000 rpm"],
    "law": ["-c", "import ehdmaps; ehdmaps.law('NU308', 'FVA3')"],
    "map without its check": ["-c", UNCHECKED],
    "map": ["-m", "ehdmaps", "generate", "nu308"],
    "run-up of the gearbox, 0.2 s": ["-m", "mbs", "runup", "short.toml"],
}


def prepared(folder: Path, tree: Path) -> None:
    """Scene of the commands: the shipped one, with a short run-up."""
    shutil.copy(next(tree.glob("mbs/**/gearbox_housing.nc")), folder)
    scene = next(tree.glob("mbs/**/gearbox.toml")).read_text()
    folder.joinpath("short.toml").write_text(scene.replace('duration = "5 s"', 'duration = "0.2 s"'))


def spent(command: list[str], folder: Path, tree: Path) -> float:
    """Processor time of a command and its children [s]."""
    caches = {"XDG_CACHE_HOME": str(folder / "caches"), "NUMBA_CACHE_DIR": str(folder / "numba")}
    environment = os.environ | caches | {"PYTHONPATH": str(tree)}
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    call = [sys.executable, *command]
    done = subprocess.run(call, check=False, cwd=folder, env=environment, capture_output=True, text=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    if done.returncode:
        raise SystemExit(f"{command} ended with {done.returncode}:\n{done.stdout[-2000:]}{done.stderr[-2000:]}")
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description="Processor time of the first use of each command, with empty caches.")
    parser.add_argument("names", nargs="*", help=f"of {', '.join(COMMANDS)}; default: all")
    parser.add_argument("--beside", type=Path, metavar="TREE", help="another checkout, run right before")
    arguments = parser.parse_args()
    trees = [REPOSITORY] if arguments.beside is None else [arguments.beside.resolve(), REPOSITORY]
    print(f"{'':30s}" + "".join(f"{'first':>10s}{'again':>8s}" for _ in trees) + ("   ratio" if trees[1:] else ""))
    for name in arguments.names or COMMANDS:
        row = []
        for tree in trees:
            with tempfile.TemporaryDirectory() as made:
                folder = Path(made)
                prepared(folder, tree)
                row += [spent(COMMANDS[name], folder, tree) for _ in range(2)]
        text = "".join(f"{value:{10 if i % 2 == 0 else 8}.2f}" for i, value in enumerate(row))
        print(f"{name:30s}{text}" + (f"{row[2] / row[0]:8.3f}" if trees[1:] else ""), flush=True)


if __name__ == "__main__":
    main()
