import os
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from ehdmaps.errors import InputError, StoreError
from ehdmaps.jobs import cli
from ehdmaps.jobs.make.log import RunLog, log_path
from ehdmaps.jobs.make.store import NoStore
from ehdmaps.jobs.make.sweep import sweep
from ehdmaps.jobs.make.tasks import line_tasks
from ehdmaps.jobs.reader import parse_job
from ehdmaps.jobs.solvers import of_map
from ehdmaps.physics.solution import Status
from tests.cases.jobs import DRY
from tests.unit.test_sweep import Stub


@pytest.fixture
def output(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "mine.toml").write_text(DRY)
    return tmp_path / "mine.nc"


def lines(output):
    """Lines of a log that have a time, without it."""
    text = log_path(output).read_text()
    return [line[26:] for line in text.splitlines() if re.match(r"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d\+00:00 ", line)]


def results(*points):
    return {
        "status": np.array([int(status) for status, _ in points], np.int8),
        "reason": np.array([reason for _, reason in points]),
    }


def test_a_run_is_told_from_its_command_to_its_summary(output, monkeypatch, capsys):
    monkeypatch.setattr(sys, "argv", ["/usr/bin/ehdmaps", "generate", "mine.toml", "-o", "a b.nc"])
    assert cli.main(["generate", "mine.toml", "--workers", "1"]) == 0
    text = log_path(output).read_text()
    assert lines(output)[0] == "begin: ehdmaps generate mine.toml -o 'a b.nc'"
    assert f"  process {os.getpid()} on " in text and "with 1 workers" in text
    assert re.search(r"^  versions: python \S+, ehdmaps \S+, numpy ", text, re.MULTILINE)
    assert "  job: NU308, FVA3, solver hertz; sha256 " in text and "\n  | [bearing]\n" in text
    assert lines(output)[-1].startswith("end: finished after ")
    summary = capsys.readouterr().out.rstrip("\n")
    assert text.endswith("".join(f"  {line}\n" for line in summary.splitlines()))


def test_later_runs_add_to_it_and_fresh_begins_it_anew(output):
    for _ in range(2):
        assert cli.main(["generate", "mine.toml", "--workers", "1"]) == 0
    starts = [line.partition(" ")[0] for line in lines(output)]
    points = re.search(r"points: (\d+) taken over", log_path(output).read_text().rpartition("begin:")[2])[1]
    assert starts == ["begin:", "end:", "begin:", points, "end:"]
    assert f"{points} points taken over from the store" in lines(output)
    assert cli.main(["generate", "mine.toml", "--workers", "1", "--fresh"]) == 0
    assert [line.partition(" ")[0] for line in lines(output)] == ["begin:", "end:"]


def test_points_that_failed_have_place_and_cause(output):
    job = parse_job(DRY, "mine", "mine.toml")
    task, *_ = line_tasks(job, of_map(job))
    usual = [(Status.CONVERGED, "a note")] * (task.points - 3)
    with RunLog(output, [], 12, 1) as log:
        log.found(task, results((Status.STAGNATED, "old"), *usual, *[(Status.CONVERGED, "")] * 2), now=False)
        log.found(task, results((Status.FAILED, "killed\ntwice"), *usual, *[(Status.DIVERGED, "lost")] * 2), now=True)
    place = r"\S+ m/s, \S+ degC"
    told = lines(output)
    assert told[1] == f"{task.points} points taken over from the store"
    assert re.fullmatch(rf"failed: inner, \S+ N/mm, {place}, by hertz: killed twice", told[2])
    assert re.fullmatch(rf"diverged: inner, 2 loads from \S+ N/mm to \S+ N/mm, {place}, by hertz: lost", told[3])
    assert len(told) == 5  # a note of a solver that is quick is none of the log


def test_what_a_point_notes_that_took_long(output):
    job = parse_job(DRY, "mine", "mine.toml")
    task, *_ = line_tasks(job, of_map(job))

    class Slow:
        points, slow, where, by = task.points, True, task.where, task.by

    with RunLog(output, [], 12, 1) as log:
        log.found(Slow, results(*[(Status.CONVERGED, "solved at the second try")] * task.points), now=True)
    assert "solved at the second try" in lines(output)[1]


@pytest.mark.parametrize(
    ("error", "words"),
    [
        (KeyboardInterrupt(), "end: stopped after .*, by Ctrl-C or SIGTERM; the same command goes on"),
        (StoreError("the disk\nis full"), "end: failed after .*: the disk is full"),
        (ZeroDivisionError("a bug"), "end: failed after .*: ZeroDivisionError: a bug"),
    ],
)
def test_the_end_of_a_run_that_does_not_finish(output, error, words):
    with pytest.raises(type(error)), RunLog(output, [], 1, 1):
        raise error
    assert re.fullmatch(words, lines(output)[-1])


def test_a_run_that_was_killed_is_told_by_the_next_one(output):
    script = (
        "import os, signal; from pathlib import Path; from ehdmaps.jobs.make.log import RunLog\n"
        f"with RunLog(Path({str(output)!r}), ['end: of no run'], 1, 1): os.kill(os.getpid(), signal.SIGKILL)"
    )
    assert subprocess.run([sys.executable, "-c", script], check=False).returncode == -9
    for _ in range(2):
        with RunLog(output, [], 1, 1):
            pass
    kinds = [line.partition(":")[0] for line in lines(output)]
    assert kinds == ["begin", "end", "begin", "end", "begin", "end"]
    assert lines(output)[1] == "end: the run before wrote none: it was killed, or the machine went down"


class Point(Stub):
    """A task with statuses."""

    by = "nobody"

    def failed(self, reason):
        return results((Status.FAILED, reason))


def test_processes_that_died_are_told(output):
    """The one that had others beside it, and the one that tried again alone."""
    with RunLog(output, [], 3, 2) as log:
        sweep([Point(7, "dies")], NoStore(), 2, watches=[log])
    assert lines(output)[1:4] == [
        "a worker process died (signal SIGKILL): the 3 points that were out are tried again one at a time",
        "a worker process died (signal SIGKILL) at Stub 7",
        "failed: Stub 7, by nobody: the worker process died twice (killed, or out of memory); "
        "the same command tries again",
    ]


@pytest.mark.parametrize("fresh", [False, True])
@pytest.mark.parametrize("obstacle", ["file", "folder", "protected"])
def test_what_is_no_log_is_left_as_it_is(output, obstacle, fresh, capsys):
    path = log_path(output)
    path.mkdir() if obstacle == "folder" else path.write_text("mine" if obstacle == "file" else "# made by ehdmaps")
    before = None if obstacle == "folder" else path.read_text()
    if obstacle == "protected":
        path.chmod(0o444)
    assert cli.main(["generate", "mine.toml", "--workers", "1", *["--fresh"] * fresh]) == 2
    said = {"file": "is there and is not a log of ehdmaps", "folder": "a folder", "protected": "may not be written"}
    assert f"log: got {path.name}" in (err := capsys.readouterr().err) and said[obstacle] in err
    assert path.is_dir() if before is None else path.read_text() == before
    assert not output.exists()


def test_a_log_that_cannot_be_begun(output, monkeypatch):
    usual = Path.open

    def full(self, *arguments, **options):
        if self == log_path(output):
            raise OSError(28, "No space left on device")
        return usual(self, *arguments, **options)

    monkeypatch.setattr(Path, "open", full)
    with pytest.raises(InputError, match=r"mine\.nc\.log: cannot be written \(No space left .*allowed: "):
        RunLog(output, [], 1, 1).__enter__()


def test_a_log_that_cannot_go_on_is_no_reason_to_stop(output, monkeypatch):
    with RunLog(output, [], 1, 1) as log:
        log_path(output).unlink()
        log_path(output).mkdir()
        log.told("nobody hears it")
