"""Shards: what each takes, how they are brought together, and what is refused."""

import argparse
import sqlite3

import numpy as np
import pytest
import xarray as xr

from ehdmaps.errors import InputError, StoreError
from ehdmaps.jobs import cli, shards
from ehdmaps.jobs.batch import parse_batch
from ehdmaps.jobs.shards import Shard, found_shards, read_shard, shard_path, solve_shard, unique
from ehdmaps.jobs.store import Store, store_path
from ehdmaps.jobs.work import merge, read_work, run_shard
from tests.cases.batches import SMALL_LISTS, batch_text
from tests.cases.jobs import SMALL


@pytest.mark.parametrize("text", ["0/0", "5/3", "0/3", "1/0", "x", "1", "1/2/3", "-1/3", "1/100001", "١/٣", "1 /3", ""])
def test_shards_that_there_are_none_of(text):
    with pytest.raises(argparse.ArgumentTypeError, match="allowed: i/n with i from 1 to n"):
        read_shard(text)


def test_shards_are_parts_of_the_whole(tmp_path):
    work = read_work(job_file(tmp_path), tmp_path / "map.nc")
    parts = [Shard(4, index).part(work.tasks) for index in range(1, 5)]
    keys = sorted(task.key for part in parts for task in part)
    assert keys == sorted(task.key for task in work.tasks)
    assert max(map(len, parts)) - min(map(len, parts)) <= 1
    assert unique([*work.tasks, *work.tasks]) == work.tasks
    assert read_shard("3/40") == Shard(40, 3)


def job_file(folder, text=SMALL, name="job.toml"):
    (folder / name).write_text(text)
    return str(folder / name)


def test_a_map_of_shards_is_that_of_one_process(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    job_file(tmp_path)
    for index in (2, 1, 3):
        assert cli.main(["generate", "job.toml", "--shard", f"{index}/3", "--workers", "1"]) == 0
    assert not (tmp_path / "job.nc").exists()
    assert cli.main(["status", "job.toml"]) == 0
    assert "3 of 3 shards finished, 84 of 84 points" in capsys.readouterr().out
    assert cli.main(["merge", "job.toml", "--workers", "1"]) == 0
    told = capsys.readouterr().out
    assert "12 of 12 tasks from the stores of 3 shards" in told
    assert "84 taken over, 0 solved now" in told
    assert cli.main(["generate", "job.toml", "-o", "whole.nc", "--workers", "1"]) == 0
    with xr.open_dataset("job.nc") as merged, xr.open_dataset("whole.nc") as whole:
        for name in ("approach", "stiffness", "damping", "status"):
            np.testing.assert_array_equal(merged[name].values, whole[name].values)


def test_a_batch_in_shards(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    job_file(tmp_path, batch_text(SMALL_LISTS), "cat.toml")
    for index in (1, 2):
        assert cli.main(["generate", "cat.toml", "--shard", f"{index}/2", "--workers", "1"]) == 0
    assert cli.main(["status", "cat.toml"]) == 0
    assert "2 of 2 shards finished" in capsys.readouterr().out
    assert cli.main(["merge", "cat.toml", "--workers", "1"]) == 0
    assert "2 made" in capsys.readouterr().out
    assert parse_batch(batch_text(SMALL_LISTS), "cat", "").sha256


def test_missing_shards_are_listed_and_no_map_is_made(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    job_file(tmp_path)
    assert cli.main(["merge", "job.toml"]) == 2
    assert "no store of a shard is beside it" in capsys.readouterr().err
    assert [path.name for path in tmp_path.iterdir()] == ["job.toml"]
    assert cli.main(["generate", "job.toml", "--shard", "2/4", "--workers", "1"]) == 0
    capsys.readouterr()
    assert cli.main(["status", "job.toml"]) == 1
    assert "not begun: 1/4, 3/4, 4/4" in capsys.readouterr().out
    assert cli.main(["merge", "job.toml"]) == 1
    told = capsys.readouterr().out
    assert "missing shards: 1/4, 3/4, 4/4" in told
    assert "3 of 12 tasks" in told
    assert not (tmp_path / "job.nc").exists()
    assert cli.main(["merge", "job.toml", "--rest", "--workers", "1"]) == 0
    assert "21 taken over, 63 solved now" in capsys.readouterr().out


def test_a_shard_that_was_killed_is_named_and_goes_on(tmp_path):
    work = read_work(job_file(tmp_path), tmp_path / "map.nc")
    part = Shard(2, 1).part(work.tasks)
    solve_shard(part[:2], work.place, Shard(1, 1), work.what, work.sha256, workers=1)
    store_path(shard_path(work.place, Shard(1, 1))).rename(store_path(shard_path(work.place, Shard(2, 1))))
    run_shard(work, Shard(2, 2), workers=1)
    merged = merge(work)
    assert merged.incomplete == ((Shard(2, 1), 2, 6),)
    assert not merged.whole
    result = run_shard(work, Shard(2, 1), workers=1)
    assert (result.taken_over, result.solved) == (14, 28)
    assert merge(work).whole


def test_stores_of_another_job_or_version_are_refused(tmp_path, monkeypatch):
    one, other = (read_work(job_file(tmp_path, text), tmp_path / "map.nc") for text in (SMALL, SMALL + "\n# edited\n"))
    run_shard(one, Shard(1, 1), workers=1)
    with pytest.raises(InputError, match=r"map\.nc\.shard-1-of-1\.store: holds results of another job file"):
        merge(other)
    newer = read_work(job_file(tmp_path, SMALL), tmp_path / "map.nc")
    monkeypatch.setattr(shards, "version", lambda _: "9.9")
    assert merge(newer).whole  # the solver is the same, whatever the number says


def test_a_solver_that_changed_is_another_version(tmp_path, monkeypatch):
    work = read_work(job_file(tmp_path), tmp_path / "map.nc")
    run_shard(work, Shard(1, 1), workers=1)
    monkeypatch.setattr(shards, "version", lambda _: "9.9")
    monkeypatch.setattr("ehdmaps.jobs.tasks.solver_version", lambda _: "another")
    later = read_work(job_file(tmp_path), tmp_path / "map.nc")
    with pytest.raises(InputError, match=r"holds results of ehdmaps .*, and here is 9.9; allowed: the same version"):
        merge(later)


def test_a_store_with_a_number_that_there_is_none_of(tmp_path):
    work = read_work(job_file(tmp_path), tmp_path / "map.nc")
    run_shard(work, Shard(1, 1), workers=1)
    store_path(shard_path(work.place, Shard(1, 1))).rename(store_path(shard_path(work.place, Shard(3, 5))))
    with pytest.raises(InputError, match="is called shard 5/3, which there is none of"):
        merge(work)


def test_a_damaged_store_and_one_in_use(tmp_path):
    work = read_work(job_file(tmp_path), tmp_path / "map.nc")
    run_shard(work, Shard(1, 1), workers=1)
    path = store_path(shard_path(work.place, Shard(1, 1)))
    with Store(path), pytest.raises(StoreError, match="is in use by another job"):
        merge(work)
    database = sqlite3.connect(path)
    database.execute("UPDATE results SET content = x'00' WHERE key = ?", (work.tasks[3].key,))
    database.commit()
    database.close()
    assert merge(work).incomplete == ((Shard(1, 1), 11, 12),)
    path.write_bytes(path.read_bytes()[:3000])
    with pytest.raises(StoreError, match="is not a readable store"):
        merge(work)


def test_what_stands_beside_shards(tmp_path, capsys):
    source = job_file(tmp_path)
    for option in (["nu308"], ["--fresh-films"], ["--keep-cases"]):
        assert cli.main(["generate", source, *option, "--shard", "1/2"]) == 2
        assert "--shard: stands beside" in capsys.readouterr().err


def test_other_files_are_no_shards(tmp_path):
    for name in ("map.nc.shard-1-of-2", "other.nc.shard-1-of-2.store", "map.nc.shard-x-of-2.store"):
        (tmp_path / name).write_text("")
    (tmp_path / "map.nc.shard-2-of-2.store").mkdir()
    assert found_shards(tmp_path / "map.nc") == {}
    assert found_shards(tmp_path / "absent" / "map.nc") == {}


def test_names_that_a_script_cannot_hold(tmp_path, monkeypatch, capsys):
    folder = tmp_path / "a\ntouch PWN"
    folder.mkdir()
    job_file(folder)
    monkeypatch.chdir(tmp_path)
    for more in ([], ["--submit"]):
        assert cli.main(["submit", "a\ntouch PWN/job.toml", "--array", "2", "-o", "a\ntouch PWN/b.nc", *more]) == 2
        out, err = capsys.readouterr()
        assert out == "" and err.startswith("ehdmaps submit: 2 problems\n")
        for what in ("job", "map"):
            assert f"which is not printable; allowed: names of printable characters; rename the {what}" in err
    monkeypatch.chdir(folder)
    assert cli.main(["submit", "job.toml", "--array", "2"]) == 2
    assert "rename the folder" in capsys.readouterr().err


def test_the_script_of_an_array(tmp_path, monkeypatch, capsys):
    folder = tmp_path / "a b"
    folder.mkdir()
    monkeypatch.chdir(folder)
    job_file(folder)
    command = ["submit", "job.toml", "--array", "4", "--time", "1-12", "--partition", "long", "--cpus", "2"]
    assert cli.main(command) == 0
    script = capsys.readouterr().out
    assert script.startswith("#!/bin/sh\n")
    wanted = ("--array=1-4", "--time=1-12", "--partition=long", "--cpus-per-task=2")
    for want in wanted:
        assert f"#SBATCH {want}\n" in script
    assert f"cd '{folder}' || exit 1" in script
    assert '--shard "$SLURM_ARRAY_TASK_ID/4"' in script
    for wrong, told in (
        (["--array", "0"], "allowed: a whole number from 1"),
        (["--array", "13"], "got 13 shards of 12 tasks"),
        (["--array", "2", "--time", "1; rm"], "--time: got '1; rm'; allowed: minutes"),
        (["--array", "2", "--partition", "$(x)"], "--partition: got '$(x)'; allowed: names"),
    ):
        try:
            status = cli.main(["submit", "job.toml", *wrong])
        except SystemExit as ended:
            status = ended.code
        assert status == 2
        assert told in capsys.readouterr().err
