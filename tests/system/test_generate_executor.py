"""`ehdmaps generate --executor`: the engines of others, with processes of their own, one of them killed."""

from __future__ import annotations

import re
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from ehdmaps.errors import InputError
from ehdmaps.jobs.cli import main
from ehdmaps.jobs.executors import executor_problem, named_executor
from tests.cases.jobs import SMALL

FIELDS = ("stiffness", "damping", "central_film", "film_offset")


@pytest.fixture
def job(tmp_path: Path) -> Path:
    path = tmp_path / "small.toml"
    path.write_text(SMALL)
    return path


@contextmanager
def running(*arguments: str, until: str) -> Iterator[tuple[subprocess.Popen[str], str]]:
    """A process of dask's, with what it says of `until` once it is there."""
    with subprocess.Popen(
        [sys.executable, "-m", "distributed.cli." + arguments[0], *arguments[1:]], stderr=subprocess.PIPE, text=True
    ) as process:
        try:
            assert process.stderr is not None
            for line in process.stderr:
                if found := re.search(until, line):
                    break
            else:
                raise AssertionError(f"{arguments} ended: {process.wait()}")
            yield process, found[1]
        finally:
            process.send_signal(signal.SIGKILL)


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


@pytest.mark.slow  # the same
def test_a_dask_cluster_that_loses_a_worker_makes_the_same_map(job, tmp_path, capsys):
    """A scheduler and two workers; one is killed by SIGKILL once the first points are told."""
    assert main(["generate", str(job), "-o", str(tmp_path / "own.nc"), "--workers", "1"]) == 0
    there = r"Scheduler at: +(tcp://\S+)"
    worker = r"Registered to: +(\S+)"
    ends = ["--no-dashboard", "--nthreads", "1"]
    with running("dask_scheduler", "--host", "127.0.0.1", "--port", "0", "--no-dashboard", until=there) as (_, address):
        with (
            running("dask_worker", address, *ends, until=worker) as (doomed, _),
            running("dask_worker", address, *ends, until=worker),
        ):
            command = [sys.executable, "-m", "ehdmaps", "generate", str(job), "-o", str(tmp_path / "theirs.nc")]
            with subprocess.Popen(
                [*command, "--executor", f"dask:{address}"], stderr=subprocess.PIPE, text=True
            ) as run:
                assert run.stderr is not None
                first = next((line for line in run.stderr if "points" in line), "")
                doomed.send_signal(signal.SIGKILL)
                said = first + run.stderr.read()
        assert run.returncode == 0, said
    same(tmp_path / "own.nc", tmp_path / "theirs.nc")
