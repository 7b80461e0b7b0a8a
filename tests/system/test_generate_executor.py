"""`ehdmaps generate --executor`: the engines of others, with processes of their own, one of them killed."""

from __future__ import annotations

import os
import random
import shlex
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from ehdmaps.errors import InputError
from ehdmaps.jobs.cli import main
from ehdmaps.jobs.executors import executor_problem, named_executor
from mbs import identify, read_scene
from mbs.analyses.case import side_by_side
from mbs.cli import main as mbs
from tests.cases.dask_cluster import cluster, kill
from tests.cases.identify_twins import balls
from tests.cases.jobs import SMALL

FIELDS = ("stiffness", "damping", "central_film", "film_offset")


@pytest.fixture
def job(tmp_path: Path) -> Path:
    path = tmp_path / "small.toml"
    path.write_text(SMALL)
    return path


def same(one: Path, other: Path) -> None:
    with xr.open_dataset(one) as first, xr.open_dataset(other) as second:
        for name in FIELDS:
            np.testing.assert_array_equal(first[name].values, second[name].values)
        assert np.isfinite(first["stiffness"].values).all()


@pytest.mark.parametrize("text", ["dask:tcp://head:8786", "executorlib:local", "executorlib:slurm", "mpi"])
def test_names_of_engines(text):
    assert executor_problem(text) == ""


@pytest.mark.parametrize("text", ["dask", "dask:", "executorlib", "executorlib:flux", "mpi:8", "slurm"])
def test_other_names_are_refused_with_those_that_are_allowed(text, job, tmp_path, capsys):
    assert "allowed: dask:ADDRESS of a scheduler" in executor_problem(text)
    assert main(["generate", str(job), "-o", str(tmp_path / "m.nc"), "--executor", text]) == 2
    assert f"--executor: got {text!r}" in capsys.readouterr().err
    assert not (tmp_path / "m.nc").exists()


def test_without_a_name_there_is_none():
    with named_executor(None) as executor:
        assert executor is None


def test_a_scheduler_that_does_not_answer(monkeypatch):
    monkeypatch.setattr("ehdmaps.jobs.executors._ANSWERS_WITHIN", "0.2s")
    with (
        pytest.raises(InputError, match=r"no dask scheduler answers at 'tcp://127.0.0.1:9'.*dask scheduler"),
        named_executor("dask:tcp://127.0.0.1:9"),
    ):
        pass


@pytest.mark.slow  # processes that import all of it
def test_processes_of_executorlib_make_the_same_map(job, tmp_path, capsys):
    maps = [tmp_path / "own.nc", tmp_path / "theirs.nc"]
    for path, engine in zip(maps, ([], ["--executor", "executorlib:local"]), strict=True):
        assert main(["generate", str(job), "-o", str(path), "--workers", "1", *engine]) == 0
    same(*maps)


@pytest.mark.slow  # the same
def test_processes_of_executorlib_find_the_same_unknowns():
    scene, lines = read_scene("electric_drive"), np.arange(40.0, 1800.0, 64.0)
    measured = balls(angles=1).responses([6000.0], lines, np.random.default_rng(5))
    with named_executor("executorlib:local", 2) as engine:
        assert engine is not None
        own, theirs = (
            identify(scene, measured, ["drive.clearance"], cage_angles=1, workers=workers).dataset
            for workers in (1, engine)
        )
    xr.testing.assert_equal(own, theirs)  # to the bit


@pytest.mark.slow  # the same
def test_ranks_of_mpi_make_the_same_map(job, tmp_path, capsys):
    mpiexec = Path(sys.executable).with_name("mpiexec")
    if not mpiexec.exists():
        pytest.skip("no mpiexec beside Python: pip install mpich")
    assert main(["generate", str(job), "-o", str(tmp_path / "own.nc"), "--workers", "1"]) == 0
    command = [sys.executable, "-m", "mpi4py.futures", "-m", "ehdmaps", "generate", str(job)]
    command += ["-o", str(tmp_path / "theirs.nc"), "--executor", "mpi"]
    done = subprocess.run([mpiexec, "-n", "2", *command], capture_output=True, text=True, timeout=240, check=False)
    assert done.returncode == 0, done.stderr
    same(tmp_path / "own.nc", tmp_path / "theirs.nc")


RUN = ["campbell", "nu308_rigid", "--law", "hertz", "--law", "constant:hertz"]


@pytest.mark.slow  # the same
def test_a_dask_cluster_that_loses_a_worker_and_its_scheduler(job, tmp_path, capsys, monkeypatch):
    """A scheduler and two workers: one is killed by SIGKILL, then the scheduler, which begins anew at its address.

    The map is that of this process, and so is a run-up with two laws.
    """
    monkeypatch.setenv("EHDMAPS_CASES", str(tmp_path / "cases"))
    assert main(["generate", str(job), "-o", str(tmp_path / "own.nc"), "--workers", "1"]) == 0
    with cluster() as made:
        engine = ["--executor", f"dask:{made.address}"]
        command = [sys.executable, "-m", "ehdmaps", "generate", str(job), "-o", str(tmp_path / "theirs.nc"), *engine]
        with subprocess.Popen(command, stderr=subprocess.PIPE, text=True) as run:
            assert run.stderr is not None
            said = next((line for line in run.stderr if "points" in line), "")
            time.sleep(random.uniform(0.0, 0.5))
            kill(made.workers[0])
            made.restart_scheduler()
            said += run.stderr.read()
        if run.returncode:  # what was lost twice is left for the same command
            assert main(command[3:]) == 0, said
        same(tmp_path / "own.nc", tmp_path / "theirs.nc")
        for path, more in (("run.nc", []), ("runs.nc", engine)):
            assert mbs([*RUN, "-o", str(tmp_path / path), *more]) in (0, 1)
    with xr.open_dataset(tmp_path / "run.nc") as one, xr.open_dataset(tmp_path / "runs.nc") as other:
        assert set(one.variables) == set(other.variables)
        for name in one.variables:
            np.testing.assert_array_equal(one[name].values, other[name].values)
    assert not list((tmp_path / "cases").glob("*"))  # all are there: nothing is kept any more


class Stops(Exception):  # noqa: N818  # as others call theirs
    """What a stopped driver says here."""


def test_runs_of_a_driver_that_stopped_are_kept(tmp_path, monkeypatch):
    """The same cases again do the rest only; what is damaged is done again."""
    monkeypatch.setenv("EHDMAPS_CASES", str(tmp_path / "cases"))
    told: list[int] = []

    def look(done: int, total: int) -> None:
        told.append(done)
        if done == 2:
            raise Stops

    with ThreadPoolExecutor(1) as pool:
        with pytest.raises(Stops):
            list(side_by_side(squared, range(4), [1] * 4, pool, look, str))
        kept = sorted((tmp_path / "cases").glob("*.pickle"))
        assert len(kept) == 2
        kept[0].write_bytes(b"no pickle")
        DONE.clear()
        assert list(side_by_side(squared, range(4), [1] * 4, pool, None, str)) == [0, 1, 4, 9]
    assert len(DONE) == 3
    assert not list((tmp_path / "cases").glob("*"))


DONE: list[int] = []


def squared(value, told):
    DONE.append(value)
    return value * value


SRUN = """#!/bin/sh
printf '%s ' "$@" >> "$SRUN_LOG"
while [ "$1" != "{python}" ]; do shift; done
exec "$@"
"""
"""A stand-in for Slurm's: it runs the command here."""


@pytest.mark.slow  # processes that import all of it
def test_what_a_user_of_slurm_types(job, tmp_path, monkeypatch, capsys):
    """The command of the page runs, with a stand-in for `srun`; so does the one of an array, by its text."""
    page = (Path(__file__).parents[2] / "docs" / "clusters.md").read_text()
    lines = [line for line in page.splitlines() if line.startswith("sbatch ")]
    words = [shlex.split(line) for line in lines]
    folder = tmp_path / "bin"
    folder.mkdir()
    (folder / "srun").write_text(SRUN.format(python=sys.executable))
    (folder / "ehdmaps").write_text(f'#!/bin/sh\nexec {sys.executable} -m ehdmaps "$@"\n')
    for program in folder.iterdir():
        program.chmod(0o755)
    names = {"PATH": f"{folder}{os.pathsep}{os.environ['PATH']}", "SRUN_LOG": str(tmp_path / "log")}
    environment = {**os.environ, **names, "SLURM_ARRAY_TASK_ID": "2"}
    assert main(["generate", str(job), "-o", str(tmp_path / "own.nc"), "--workers", "1"]) == 0
    wrapped = words[0][words[0].index("--wrap") + 1]
    assert "--executor executorlib:slurm" in wrapped
    command = wrapped.replace("nu308_night", str(job)).replace("--workers 32", "--workers 2")
    subprocess.run(["sh", "-c", command], cwd=tmp_path, env=environment, check=True, timeout=300, capture_output=True)
    same(tmp_path / "own.nc", tmp_path / "small.nc")
    assert "-n 1" in (tmp_path / "log").read_text()
    (tmp_path / "jobs.txt").write_text(f"nu308\n{job.with_name('second.toml')}\n")
    job.with_name("second.toml").write_text(SMALL)
    array = words[1][words[1].index("--wrap") + 1]
    subprocess.run(["sh", "-c", array], cwd=tmp_path, env=environment, check=True, timeout=300, capture_output=True)
    same(tmp_path / "own.nc", tmp_path / "second.nc")
