"""Shards on a real Slurm: a job array, one of whose tasks is killed, submitted again and merged."""

import json
import os
import re
import signal
import subprocess
import time

import numpy as np
import pytest

import ehdmaps
from ehdmaps.jobs import cli
from ehdmaps.jobs.status import status_path
from tests.cases.batches import SMALL_LISTS, batch_text
from tests.cases.jobs import SMALL, map_job, spaced
from tests.cases.slurm import running_slurm

JOB = (
    map_job(spaced("1 N/mm", "300 N/mm", 8), spaced("0.5 m/s", "4 m/s", 3), '["40 degC"]', solver="reynolds")
    + 'law_check = 20\nline_steps = { entrainment_speed = 0.3 }\nfilms = "solved"\n'
)
"""Some seconds of solving, so that a task can be killed in the middle."""

SAME = 1e-8
"""What maps of shards may differ by: nothing but the order of sums could differ, and nothing does."""


@pytest.fixture(scope="module")
def slurm():
    with running_slurm() as cluster:
        yield cluster


def kill_in_the_middle(output, seconds=60.0):
    """Kill the process of a shard with signal 9 as soon as some of its points are solved, and say how many were."""
    path, end = status_path(output), time.monotonic() + seconds
    while time.monotonic() < end:
        try:
            status = json.loads(path.read_bytes())
        except (FileNotFoundError, ValueError):
            status = {"done": 0}
        store = output.with_name(f"{output.name}.store")
        if "process" in status and store.exists() and store.stat().st_size > 40_000:
            os.kill(status["process"], signal.SIGKILL)
            return status
        time.sleep(0.01)
    raise AssertionError("the shard does not begin")


@pytest.mark.slow  # three processes that load the solver, and a cluster
def test_an_array_with_a_killed_task_gives_the_map_of_one_process(slurm, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "job.toml").write_text(JOB)
    assert cli.main(["submit", "job.toml", "--array", "2", "-o", "shards.nc"]) == 0
    (tmp_path / "array.sh").write_text(capsys.readouterr().out)

    array = slurm.submit("array.sh")
    kill_in_the_middle(tmp_path / "shards.nc.shard-2-of-2")
    assert slurm.wait(array) == {"COMPLETED", "FAILED"}
    assert cli.main(["status", "job.toml", "-o", "shards.nc"]) == 1
    told = capsys.readouterr().out
    assert "1 of 2 shards finished" in told
    assert "2/2  interrupted" in told
    assert cli.main(["merge", "job.toml", "-o", "shards.nc"]) == 1  # and makes no map
    assert "shard 2/2: not finished" in capsys.readouterr().out
    assert not (tmp_path / "shards.nc").exists()

    again = slurm.submit("--array=2", "array.sh")
    assert slurm.wait(again) == {"COMPLETED"}
    log = (tmp_path / f"shards.nc.slurm-{again}_2.log").read_text()
    assert " 0 points taken over" not in log
    merge = slurm.submit(f"--dependency=afterany:{again}", "--array=0", "array.sh")
    assert slurm.wait(merge) == {"COMPLETED"}

    assert cli.main(["generate", "job.toml", "-o", "whole.nc", "--workers", "1"]) == 0
    shards, whole = (ehdmaps.open_map(tmp_path / name) for name in ("shards.nc", "whole.nc"))
    for one, other in ((shards.dataset, whole.dataset), (shards.backbone, whole.backbone)):
        for name in one.data_vars:
            if name == "solve_seconds":
                continue
            if one[name].dtype.kind == "f":
                np.testing.assert_allclose(one[name].values, other[name].values, rtol=SAME, err_msg=name)
            else:
                np.testing.assert_array_equal(one[name].values, other[name].values, err_msg=name)
    checks = {name: value for name, value in whole.dataset.attrs.items() if name.startswith("law_")}
    assert checks == {name: shards.dataset.attrs[name] for name in checks}


@pytest.mark.slow  # six short processes, one after the other
def test_submitit_submits_the_array_and_the_merge(slurm, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("SLURM_CONF", slurm.environment["SLURM_CONF"])
    (tmp_path / "cat.toml").write_text(batch_text(SMALL_LISTS))
    assert cli.main(["submit", "cat.toml", "--array", "2", "--submit", "--time", "10"]) == 0
    array, last = re.findall(r"array (\d+) of 2 shards, and merge (\d+) after it", capsys.readouterr().out)[0]
    assert slurm.wait(array) == {"COMPLETED"}
    assert slurm.wait(last) == {"COMPLETED"}
    for name in ("NU308_FVA3", "N1014_FVA3"):
        assert ehdmaps.open_map(tmp_path / "cat" / f"{name}.nc").dataset.attrs["job_name"] == name
    assert cli.main(["status", "cat.toml"]) == 0
    assert "2 of 2 shards finished" in capsys.readouterr().out


@pytest.mark.slow  # two short processes, one after the other
def test_slurm_reads_any_name_as_it_is(slurm, tmp_path, monkeypatch, capsys):
    """Blanks, quotes, signs of a shell and of Slurm in names of job, map and folder: nothing is run or expanded."""
    folder = tmp_path / "50 %j $HOME"
    folder.mkdir()
    monkeypatch.chdir(folder)
    name = "-a %j \"q\" 'x' `touch PWN` $(touch PWN) ;&|<> ü #"
    (folder / f"{name}.toml").write_text(SMALL)
    assert cli.main(["submit", "--array", "2", "--", f"{name}.toml"]) == 0
    (folder / "array.sh").write_text(capsys.readouterr().out)
    assert subprocess.run(["bash", "-n", "array.sh"], check=False).returncode == 0
    array = slurm.submit("array.sh")
    shown = slurm.run("scontrol", "show", "job", array)
    assert slurm.wait(array) == {"COMPLETED"}
    merge = slurm.submit("--array=0", "array.sh")
    assert slurm.wait(merge) == {"COMPLETED"}
    logs = {f"{name}.nc.slurm-{job}_{task}.log" for job, task in ((array, 1), (array, 2), (merge, 0))}
    stores = {f"{name}.nc{shard}.store{end}" for shard in (".shard-1-of-2", ".shard-2-of-2") for end in ("", ".status")}
    found = {path.name for path in folder.iterdir()}
    assert found == {"array.sh", f"{name}.toml", f"{name}.nc", f"{name}.nc.store"} | logs | stores
    assert f"JobName=ehdmaps-{name}"[:60] in shown
    assert ehdmaps.open_map(folder / f"{name}.nc").dataset.attrs["job_name"] == name


def test_submitit_is_not_given_signs_of_slurm(tmp_path, monkeypatch, capsys):
    pytest.importorskip("submitit")
    folder = tmp_path / "50 %j"
    folder.mkdir()
    monkeypatch.chdir(folder)
    (folder / "cat.toml").write_text(batch_text(SMALL_LISTS))
    assert cli.main(["submit", "cat.toml", "--array", "2", "--submit"]) == 2
    assert "where Slurm takes % for a sign of its own; allowed with --submit: names" in capsys.readouterr().err
    assert [path.name for path in folder.iterdir()] == ["cat.toml"]


def test_a_machine_without_slurm_is_told_so(tmp_path, monkeypatch, capsys):
    pytest.importorskip("submitit")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("PATH", str(tmp_path))
    (tmp_path / "cat.toml").write_text(batch_text(SMALL_LISTS))
    assert cli.main(["submit", "cat.toml", "--array", "2", "--submit"]) == 2
    assert "the cluster does not take the job" in capsys.readouterr().err
