"""Maps and run-ups by engines of others, with faults injected: what is survived, and whether a bit differs.

Run: python -m tests.benchmarks.faults [--seed S]

A map of solved films is made by processes of this program, then by a dask cluster of processes (a scheduler, two
workers), by executorlib and by MPI; a run-up with two laws likewise. Faults come at random moments.
"""

from __future__ import annotations

import argparse
import os
import random
import re
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path

import numpy as np
import xarray as xr

from tests.cases.dask_cluster import Cluster, cluster, kill

JOB = """
schema = 1
[bearing]
name = "NU308"
[lubricant]
name = "FVA3"
[grid]
load = { from = "1 N/mm", to = "500 N/mm", points = 8, spacing = "log" }
entrainment_speed = { from = "0.2 m/s", to = "8 m/s", points = 6, spacing = "log" }
temperature = ["40 degC", "70 degC", "100 degC"]
[solver]
name = "reynolds"
structural_law = "iso16281"
backbone = "none"
films = "solved"
"""

RUN = ["-m", "mbs", "campbell", "nu308_rigid", "--law", "hertz", "--law", "formula", "--law", "constant:hertz"]

TIMES = ("solve_seconds", "iterations")
"""What differs from run to run."""


def same(one: Path, other: Path) -> str:
    """Whether all numbers of two files are equal to the bit."""
    with xr.open_dataset(one) as first, xr.open_dataset(other) as second:
        assert set(first.variables) == set(second.variables)
        names = [name for name in first.variables if name not in TIMES]
        apart = [
            n
            for n in names
            if not np.array_equal(first[n].values, second[n].values, equal_nan=first[n].dtype.kind == "f")
        ]
    return "equal to the bit" if not apart else f"differ: {', '.join(map(str, apart))}"


class Bench:
    """A folder with the job, and commands that run there."""

    def __init__(self, folder: Path, seed: int) -> None:
        self.folder, self.random = folder, random.Random(seed)
        (folder / "job.toml").write_text(JOB)
        self.environment = {**os.environ, "EHDMAPS_CASES": str(folder / "cases")}

    def begun(self, command: list[str], launcher: tuple[str, ...] = ()) -> subprocess.Popen[str]:
        """A command that has begun."""
        call = [*launcher, sys.executable, *command]
        return subprocess.Popen(
            call, cwd=self.folder, env=self.environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
        )

    def done(self, command: list[str], launcher: tuple[str, ...] = ()) -> tuple[int, str]:
        """Exit status and output of a command."""
        process = self.begun(command, launcher)
        said, _ = process.communicate()
        return process.returncode, said

    def after(self, process: subprocess.Popen[str], begun: str, fault: Callable[[], object]) -> tuple[int, str]:
        """Exit status and output of a command with a fault a random moment after it has said something."""
        assert process.stdout is not None
        said = ""
        for line in process.stdout:
            said += line
            if re.search(begun, line):
                break
        time.sleep(self.random.uniform(0.0, 2.0))
        alive = process.poll() is None
        fault()
        said += process.stdout.read()
        return process.wait(), said if alive else f"{said}\n(the fault came too late)"


def generate(name: str, *more: str) -> list[str]:
    """The command that makes the map."""
    return ["-m", "ehdmaps", "generate", "job.toml", "-o", f"{name}.nc", *more]


def row(words: str, end: str, equal: str) -> None:
    """Print a row of the table."""
    print(f"{words:58s} {end:34s} {equal}", flush=True)


def taken(said: str) -> str:
    """How many points were taken over, as a run says."""
    found = re.findall(r"(\d+) taken over, (\d+) solved now, (\d+) without", said)
    return f"{found[-1][0]} taken over, {found[-1][1]} solved" if found else said.strip().splitlines()[-1][-90:]


def of_dask(bench: Bench, own: Path) -> None:
    """Maps by dask, with each fault."""
    faults: dict[str, Callable[[Cluster, subprocess.Popen[str]], object]] = {
        "none": lambda made, process: None,
        "a worker killed by -9": lambda made, process: kill(made.workers[0]),
        "both workers killed, another one comes": lambda made, process: (*map(kill, made.workers), made.worker()),
        "scheduler killed, started again with workers": lambda made, process: made.restart_scheduler(),
        "driver killed by -9, same command again": lambda made, process: process.send_signal(signal.SIGKILL),
    }
    for number, (words, fault) in enumerate(faults.items()):
        with cluster() as made:
            command = generate(f"dask{number}", "--executor", f"dask:{made.address}")
            process = bench.begun(command)
            status, said = bench.after(process, r"[1-9]\d* of \d+ points", partial(fault, made, process))
            again = 0
            while status and again < 3:
                again += 1
                status, said = bench.done(command)
        end = f"status {status}{f' at run {again + 1}' if again else ''}, {taken(said)}"
        row(f"map, dask: {words}", end, same(own, bench.folder / f"dask{number}.nc"))


def of_others(bench: Bench, own: Path) -> None:
    """Maps by executorlib and MPI."""
    status, said = bench.done(generate("executorlib", "--executor", "executorlib:local", "--workers", "2"))
    row("map, executorlib:local: none", f"status {status}, {taken(said)}", same(own, bench.folder / "executorlib.nc"))
    mpiexec = Path(sys.executable).with_name("mpiexec")
    if mpiexec.exists():
        command = ["-m", "mpi4py.futures", *generate("mpi", "--executor", "mpi")]
        status, said = bench.done(command, (str(mpiexec), "-n", "3"))
        row("map, mpi, 3 ranks: none", f"status {status}, {taken(said)}", same(own, bench.folder / "mpi.nc"))


def killed_once_kept(bench: Bench, process: subprocess.Popen[str]) -> None:
    """Kill a command once one of its runs is kept."""
    until = time.monotonic() + 60.0
    while not list((bench.folder / "cases").glob("*.pickle")) and time.monotonic() < until:
        time.sleep(0.05)
    kill(process)


def of_runs(bench: Bench) -> None:
    """Run-ups by dask, with each fault."""
    status, said = bench.done([*RUN, "-o", "own_run.nc"])
    assert status in (0, 1), said
    own = bench.folder / "own_run.nc"
    for number, words in enumerate(("a worker killed by -9", "driver killed by -9, same command again")):
        with cluster() as made:
            command = [*RUN, "-o", f"run{number}.nc", "--executor", f"dask:{made.address}"]
            process = bench.begun(command)

            fault = partial(killed_once_kept, bench, process) if number else partial(kill, made.workers[0])
            status, _ = bench.after(process, "step", fault)
            kept = len(list((bench.folder / "cases").glob("*.pickle")))
            if status not in (0, 1):
                status, _ = bench.done(command)
        end = f"status {status}" + (f", {kept} of 3 runs were kept" if number else "")
        row(f"run-up with 3 laws, dask: {words}", end, same(own, bench.folder / f"run{number}.nc"))


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description="Faults injected into runs by engines of others.")
    parser.add_argument("--seed", type=int, default=1, help="of the moments of faults; 1")
    with tempfile.TemporaryDirectory() as place:
        bench = Bench(Path(place), parser.parse_args().seed)
        row("what, by which engine: fault", "end", "numbers beside those of own processes")
        status, said = bench.done(generate("own", "--workers", "2"))
        row("map, own processes: none", f"status {status}, {taken(said)}", "")
        of_dask(bench, Path(place) / "own.nc")
        of_others(bench, Path(place) / "own.nc")
        of_runs(bench)


if __name__ == "__main__":
    main()
