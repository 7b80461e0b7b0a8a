import dataclasses
import fcntl
import json
import os
import platform
from dataclasses import dataclass

import numpy as np
import pytest

from ehdmaps.errors import InputError
from ehdmaps.jobs import cli
from ehdmaps.jobs.make import status
from ehdmaps.jobs.make.status import RunStatus, StatusFile, about, look, status_path
from ehdmaps.jobs.reader import parse_job
from ehdmaps.physics.solution import Status
from tests.cases.jobs import DRY

GOOD = RunStatus("a job", 12, "here", 2, "2026-01-01T00:00:00+00:00", "2026-01-01T01:00:00+00:00", 100, 40, 10)


@dataclass(frozen=True)
class Line:
    """A task of four points."""

    points: int = 4
    slow: bool = False
    by: str = "openfoam"


@pytest.fixture
def job():
    return parse_job(DRY, "mine", "mine.toml")


@pytest.fixture
def output(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path / "mine.nc"


def arrays(*values):
    return {"status": np.array([int(value) for value in values], np.int8)}


def seen(output):
    found = look(output)
    return found.status, found.running


def test_a_run_can_be_looked_at_and_leaves_nothing_behind(output, job, monkeypatch):
    monkeypatch.setattr(status, "WRITE_SECONDS", 0.0)
    with StatusFile(output, about(job), 12, workers=3) as written:
        assert seen(output)[0].done == 0
        written.found(Line(), arrays(*[Status.CONVERGED] * 3, Status.STAGNATED), now=False)
        of_reference = arrays(Status.FAILED, Status.STAGNATED, Status.ASYMPTOTE, Status.CONVERGED)
        written.found(Line(by="reynolds"), of_reference, now=True)
        found, running = seen(output)
    assert running
    assert (found.done, found.total, found.taken_over) == (8, 12, 4)
    assert found.failed == {"stagnated by openfoam": 1, "stagnated by reynolds": 1, "failed by reynolds": 1}
    assert (found.process, found.workers) == (os.getpid(), 3)
    assert "NU308, FVA3, solver hertz" in found.job
    assert look(output) is None
    assert list(output.parent.iterdir()) == []


def test_a_run_that_ends_early_leaves_its_last_status(output, job):
    with pytest.raises(KeyboardInterrupt), StatusFile(output, about(job), 12, workers=1) as written:
        written.found(Line(), arrays(*[Status.CONVERGED] * 4), now=True)
        raise KeyboardInterrupt
    found, running = seen(output)
    assert (found.done, running) == (4, False)


def test_it_is_written_now_and_then_and_after_every_point_that_took_long(output, job):
    with StatusFile(output, about(job), 100, workers=1) as written:
        for _ in range(5):
            written.found(Line(), arrays(*[Status.CONVERGED] * 4), now=True)
        assert seen(output)[0].done == 0  # the first one is younger than WRITE_SECONDS
        written.found(Line(slow=True), arrays(*[Status.CONVERGED] * 4), now=True)
        assert seen(output)[0].done == 24


def test_who_looks_does_not_disturb(output, job, monkeypatch):
    monkeypatch.setattr(status, "WRITE_SECONDS", 0.0)
    with StatusFile(output, about(job), 100, workers=1) as written:
        held = [status_path(output).open("rb") for _ in range(3)]
        for file in held:
            with pytest.raises(BlockingIOError):
                fcntl.flock(file, fcntl.LOCK_SH | fcntl.LOCK_NB)
        written.found(Line(), arrays(*[Status.CONVERGED] * 4), now=True)
        fcntl.flock(held[0], fcntl.LOCK_EX)  # of the version before, which nobody needs any more
        written.found(Line(), arrays(*[Status.CONVERGED] * 4), now=True)
        assert seen(output) == (seen(output)[0], True)
        assert seen(output)[0].done == 8
        for file in held:
            file.close()


@pytest.mark.parametrize("obstacle", ["folder", "file"])
def test_a_status_that_cannot_be_written_is_no_reason_to_stop(output, job, obstacle):
    path = status_path(output)
    path.mkdir() if obstacle == "folder" else path.write_text("mine")
    with StatusFile(output, about(job), 4, workers=1) as written:
        written.found(Line(), arrays(*[Status.CONVERGED] * 4), now=True)
    assert path.is_dir() if obstacle == "folder" else path.read_text() == "mine"


@pytest.mark.parametrize(
    "content",
    [
        "", "{", "[]", "[" * 90_000, json.dumps({"mark": 1}), json.dumps(dataclasses.asdict(GOOD)),
        *(
            json.dumps({"mark": "", **dataclasses.asdict(GOOD), key: value})
            for key, value in (
                ("total", -1), ("total", "1"), ("done", 1.5), ("done", True), ("failed", []), ("failed", {"a": "b"}),
                ("rate", 0.0), ("rate", float("nan")), ("rate", "fast"), ("job", 1), ("written", "today"),
                ("written", "2026-01-01T00:00:00"), ("written", 7), ("more", 1),
            )
        ),
    ],
)  # fmt: skip
def test_what_is_no_status_is_refused(output, content):
    status_path(output).write_text(content)
    with pytest.raises(InputError, match="is not the status of a map that is being made"):
        look(output)


def command(capsys, *arguments):
    found = cli.main(["status", *arguments])
    return found, *capsys.readouterr()


def left(output, **changes):
    content = {"mark": "made by ehdmaps", **dataclasses.asdict(dataclasses.replace(GOOD, **changes))}
    status_path(output).write_text(json.dumps(content))


@pytest.mark.parametrize("name", ["mine.nc", "mine.nc.store", "mine.nc.store.status", "mine.toml", None])
def test_an_interrupted_run_by_all_its_names(output, capsys, name):
    (output.parent / "mine.toml").write_text(DRY)
    left(output, host=platform.node(), failed={"outside_validity": 3, "failed": 1})
    code, out, err = command(capsys, *([name] if name else []))
    assert (code, err) == (1, "")
    lines = out.splitlines()
    ended = f"process 12 on {platform.node()} has ended"
    assert lines[0] == f"mine.nc: not finished: interrupted, {ended}; the same command goes on"
    assert lines[2] == "  points   40 of 100 (40.0 %), 10 of them taken over"
    assert lines[3] == "  rate     not known"
    assert lines[4] == "  failed   1 failed, 3 outside validity"
    assert lines[6].startswith("  written  2026-01-01T01:00:00+00:00, ")


def test_of_another_machine_only_the_last_sign_is_known(output, capsys):
    left(output, host="node7")
    code, out, _ = command(capsys, "mine.nc")
    assert code == 0
    assert "mine.nc: process 12 on node7: only there it can be told whether it runs; it was heard of " in out


def test_a_file_system_without_locks_is_no_reason_to_stop(output, job, capsys, monkeypatch):
    def refuse(*_):
        raise OSError(38, "Function not implemented")

    monkeypatch.setattr(status.fcntl, "flock", refuse)
    with StatusFile(output, about(job), 12, workers=3):
        code, out, _ = command(capsys, "mine.nc")
    assert code == 0
    assert "only there it can be told whether it runs" in out


def test_a_running_one(output, job, capsys):
    with StatusFile(output, about(job), 12, workers=3):
        code, out, _ = command(capsys, "mine.nc")
    assert code == 0
    assert f"mine.nc: running, process {os.getpid()} on " in out and "with 3 workers" in out
    assert "rate     not known yet" in out and "failed   none" in out


def test_the_time_left_is_told(output, capsys):
    left(output, rate=0.5)
    with status_path(output).open("rb") as file:
        fcntl.flock(file, fcntl.LOCK_EX)
        out = command(capsys, "mine.nc")[1]
    assert "rate     0.5 points/s, 2.0 min left" in out


def test_a_finished_map(output, capsys):
    (output.parent / "mine.toml").write_text(DRY)
    assert cli.main(["generate", "mine.toml", "--workers", "1"]) == 0
    capsys.readouterr()
    for name in ("mine.nc", "mine.nc.store", "mine.toml"):
        assert command(capsys, name) == (0, "mine.nc: finished; no process works on it; see `ehdmaps show`\n", "")


def test_a_store_without_a_status(output, capsys):
    (output.parent / "mine.nc.store").write_bytes(b"")
    code, out, _ = command(capsys)
    assert (code, out) == (
        1,
        "mine.nc: not finished; what is solved is kept in mine.nc.store; how far it is, is not known\n",
    )


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ([], "no store of a map is in this folder; allowed: "),
        (["none.nc"], "none.nc: is not there, nor its store; allowed: "),
        (["nu308"], "nu308.nc: is not there, nor its store; allowed: "),
        (["none.nc.store"], "none.nc: is not there, nor its store; allowed: "),
        (["bad.toml"], "bad.toml: "),
    ],
)
def test_nothing_to_look_at(output, capsys, arguments, message):
    (output.parent / "bad.toml").write_text("schema = 1")
    code, out, err = command(capsys, *arguments)
    assert (code, out) == (2, "")
    assert err.startswith("ehdmaps status: ") and message in err
