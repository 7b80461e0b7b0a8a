"""A night's run that is killed, interrupted or started twice."""

import importlib.util
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from ehdmaps import errors
from ehdmaps.jobs import cli, solvers
from ehdmaps.maps.emap import open_map
from tests.cases.interruptible import start
from tests.cases.jobs import map_job, spaced

pytestmark = pytest.mark.slow  # each starts some processes

JOB = map_job(
    spaced("1 N/mm", "1000 N/mm", 5),
    spaced("0.1 m/s", "10 m/s", 10),
    '["20 degC", "40 degC", "60 degC", "80 degC", "100 degC"]',
)
LINES = 100
POINTS = 500

# The command line with a solver that takes its time and writes down every line that it begins.
DRIVER = """
import os, sys, time
from dataclasses import dataclass
from ehdmaps.jobs import cli, solvers
from ehdmaps.physics.closed_form import FormulaSolver

@dataclass(frozen=True)
class Patient(FormulaSolver):
    version: str = "1"
    pause: float = 0.03
    def solve_line(self, contact, lubricant, loads, entrainment_speed, temperature):
        with open("log", "a") as log:
            log.write(f"{os.getpid()} {contact.name} {entrainment_speed!r} {temperature!r}\\n")
        time.sleep(self.pause)
        while "HOLD" in os.environ and not os.path.exists("release"):
            time.sleep(self.pause)
        return super().solve_line(contact, lubricant, loads, entrainment_speed, temperature)

if __name__ == "__main__":
    solvers.build = lambda name, options: Patient()
    sys.exit(cli.main(sys.argv[1:]))
"""


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    # The commands run in another folder, where only an installed package would be found.
    monkeypatch.setenv("PYTHONPATH", str(Path(errors.__file__).parents[1]))
    (tmp_path / "job.toml").write_text(JOB)
    (tmp_path / "driver.py").write_text(DRIVER)
    return tmp_path


@pytest.fixture(scope="module")
def undisturbed(tmp_path_factory):
    """The map of the job, made in one go in this process."""
    folder = tmp_path_factory.mktemp("undisturbed")
    (folder / "job.toml").write_text(JOB)
    path = folder / "job.nc"
    assert cli.main(["generate", str(folder / "job.toml"), "-o", str(path), "--workers", "1"]) == 0
    return open_map(path).dataset


@pytest.fixture
def go_on(folder, monkeypatch, capsys):
    """Give the same command again, in this process; what is found of its points."""
    spec = importlib.util.spec_from_file_location("driver", folder / "driver.py")
    driver = importlib.util.module_from_spec(spec)

    def again():
        spec.loader.exec_module(driver)
        monkeypatch.setattr(solvers, "build", lambda name, options: driver.Patient())
        assert cli.main(["generate", "job.toml", "--workers", "1"]) == 0
        return counts(capsys.readouterr().out)

    return again


def command(*arguments):
    return [sys.executable, "driver.py", "generate", "job.toml", *arguments]


def begun(folder):
    log = folder / "log"
    return [line.split() for line in log.read_text().splitlines()] if log.exists() else []


def wait_for(condition, seconds=60.0):
    """Wait for something that must happen; the limit only ends a test that hangs."""
    end = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end, "it never happened"
        time.sleep(0.01)


def counts(out):
    (line,) = [line for line in out.splitlines() if line.startswith("points: ")]
    words = line.replace(",", "").split()
    return int(words[1]), int(words[4])


def alive(pid):
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    with open(f"/proc/{pid}/stat") as file:  # a zombie waits for nobody but its reaper
        return file.read().rsplit(")", 1)[1].split()[0] != "Z"


def test_kill_9_loses_at_most_what_ran(folder, undisturbed, go_on):
    first = subprocess.Popen(command("--workers", "2"), cwd=folder, stderr=subprocess.DEVNULL)
    wait_for(lambda: len(begun(folder)) >= 45)
    first.kill()
    first.wait()
    killed_after = begun(folder)
    assert 45 <= len(killed_after) < LINES
    assert not (folder / "job.nc").exists()
    wait_for(lambda: not any(alive(int(pid)) for pid, *_ in killed_after))  # no orphan waits for ever
    killed_after = begun(folder)
    (folder / "log").unlink()

    taken_over, solved = go_on()
    assert taken_over + solved == POINTS
    # Every line that the second run did not begin was taken over: none was solved again.
    assert len(begun(folder)) * 5 == solved
    # At 0.03 s a line, a second holds 33 lines a worker; the store is committed four times as often, so what two
    # workers did in less than half a second may be lost.
    assert taken_over >= 5 * (len(killed_after) - 30)

    resumed = open_map(folder / "job.nc").dataset
    xr.testing.assert_identical(
        resumed.drop_vars("solve_seconds").drop_attrs(), undisturbed.drop_vars("solve_seconds").drop_attrs()
    )
    assert np.isfinite(resumed["stiffness"].values).all()


@pytest.mark.parametrize(
    ("workers", "number", "status", "to_all"),
    [("1", signal.SIGTERM, 143, True), ("2", signal.SIGINT, 130, True)],
)
def test_ctrl_c_stops_cleanly_and_says_how_to_go_on(folder, workers, number, status, to_all, go_on):
    run = start(command("--workers", workers), cwd=folder, stderr=subprocess.PIPE, text=True, start_new_session=True)
    wait_for(lambda: len(begun(folder)) >= 20)
    # A terminal and a batch system send it to the workers too, `kill` does not.
    os.killpg(run.pid, number) if to_all else os.kill(run.pid, number)
    _, err = run.communicate(timeout=60)
    assert run.returncode == status
    assert "stopped; what is solved is kept in job.nc.store: the same command goes on from there" in err
    assert "Traceback" not in err and "leaked" not in err
    lines = len(begun(folder))
    wait_for(lambda: not any(alive(int(pid)) for pid, *_ in begun(folder)))
    taken_over, solved = go_on()
    assert taken_over + solved == POINTS
    assert taken_over >= 5 * (lines - 3 * int(workers) - 1)  # all but the lines that were out


def deaf_workers(pid):
    """Of the workers of a process: whether they block Ctrl-C, which a starting Python answers with a traceback."""
    found = []
    try:
        for task in Path(f"/proc/{pid}/task").iterdir():
            for child in (task / "children").read_text().split():
                blocked = Path(f"/proc/{child}/status").read_text().split("SigBlk:")[1].split()[0]
                if "spawn_main" in Path(f"/proc/{child}/cmdline").read_text():
                    found.append(bool(int(blocked, 16) >> (signal.SIGINT - 1) & 1))
    except OSError:
        return []
    return found


def test_workers_that_just_start_are_quiet_about_ctrl_c(folder):
    if not Path(f"/proc/self/task/{os.getpid()}/children").exists():
        pytest.skip("no list of children here")
    run = start(command("--workers", "2"), cwd=folder, stderr=subprocess.PIPE, text=True, start_new_session=True)
    wait_for(lambda: len(deaf_workers(run.pid)) == 2)
    assert deaf_workers(run.pid) == [True, True]
    os.killpg(run.pid, signal.SIGINT)
    _, err = run.communicate(timeout=60)
    assert run.returncode == 130
    assert "stopped; what is solved is kept in job.nc.store" in err
    assert "Traceback" not in err


def test_a_second_job_on_the_same_store_is_refused(folder, capsys):
    first = subprocess.Popen(
        command("--workers", "1"),
        cwd=folder,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        text=True,
        env={**os.environ, "HOLD": "until the file release is there"},
    )
    try:
        wait_for(lambda: len(begun(folder)) >= 1)
        for further in ([], ["--fresh"]):
            assert cli.main(["generate", "job.toml", "--workers", "1", *further]) == 2
            assert "job.nc.store: is in use by another job" in capsys.readouterr().err
    finally:
        (folder / "release").touch()
        out, _ = first.communicate(timeout=60)
    assert (first.returncode, counts(out)) == (0, (0, POINTS))


def test_a_running_job_can_be_looked_at_until_it_is_killed_and_after(folder, capsys):
    def run(*arguments):
        code = cli.main(arguments)
        return code, *capsys.readouterr()

    first = subprocess.Popen(
        command("--workers", "1"),
        cwd=folder,
        stderr=subprocess.DEVNULL,
        env={**os.environ, "HOLD": "until the file release is there"},
    )
    wait_for(lambda: len(begun(folder)) >= 1)
    code, out, err = run("status", "job.nc")
    assert (code, err) == (0, "")
    assert f"job.nc: running, process {first.pid} on " in out
    assert f"points   0 of {POINTS} (0.0 %)" in out
    first.kill()
    first.wait()
    code, out, err = run("status", "job.nc")
    assert (code, err) == (1, "")
    assert f"job.nc: not finished: interrupted, process {first.pid} on " in out and "the same command goes on" in out
    code, out, _ = run("generate", "job.toml", "--workers", "1")
    assert (code, counts(out)) == (0, (0, POINTS))
    assert run("status", "job.nc") == (0, "job.nc: finished; no process works on it; see `ehdmaps show`\n", "")
