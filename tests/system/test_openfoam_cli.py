"""Jobs of the solver `openfoam` from the command line, with a stand-in for ehlFoam: kills, ends, resumption."""

import errno
import json
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

import meshio
import numpy as np
import pytest
import xarray as xr

from ehdmaps import errors
from ehdmaps.jobs import cli
from ehdmaps.jobs.reader import parse_job
from ehdmaps.maps.emap import open_map
from ehdmaps.openfoam.case import remove_leftovers
from tests.cases import openfoam_fake
from tests.cases.interruptible import start
from tests.cases.jobs import map_job, spaced

SETTINGS = """columns = 40
rows = 4
start = "hertz"
fill = "none"
backbone = "none"
"""
JOB = map_job(spaced("2 N/mm", "200 N/mm", 2), '["1 m/s"]', '["40 degC"]', solver="openfoam") + SETTINGS
POINTS = 4


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """Folder with a job, where the commands run; a fake build beside it; `build` is where its mode stands."""
    for key, value in openfoam_fake.build(tmp_path / "build").items():
        monkeypatch.setenv(key, value)
    monkeypatch.setattr("ehdmaps.jobs.make.generate.plan_spacing", lambda *_: None)
    monkeypatch.setattr(tempfile, "tempdir", None)  # python asks for TMPDIR only once
    monkeypatch.setenv("PYTHONPATH", str(Path(errors.__file__).parents[1]))  # for commands in their own process
    monkeypatch.setenv("HOME", str(tmp_path / "home"))
    here = tmp_path / "here"
    here.mkdir()
    (here / "job.toml").write_text(JOB)
    monkeypatch.chdir(here)
    return here


@dataclass(frozen=True)
class Done:
    """What a command printed."""

    stdout: str
    stderr: str


@pytest.fixture
def done(capsys):
    """Run a command in this process; those that are killed run in their own, by `command`."""

    def run(*arguments, status=0):
        capsys.readouterr()
        found = cli.main(arguments)
        captured = Done(*capsys.readouterr())
        assert found == status, captured.stderr
        return captured

    return run


DRIVER = """
import sys
from ehdmaps.jobs import cli
from ehdmaps.jobs.make import generate

if __name__ == "__main__":
    generate.plan_spacing = lambda *_: None
    sys.exit(cli.main(sys.argv[1:]))
"""
"""The program, without the points of `reynolds` that tell what the axes lose: they would be compiled anew."""


def command(folder, *arguments):
    """Return the command line of a process of its own."""
    (folder.parent / "driver.py").write_text(DRIVER)
    return [sys.executable, str(folder.parent / "driver.py"), *arguments]


def counts(out):
    (line,) = [line for line in out.splitlines() if line.startswith("points: ")]
    words = line.replace(",", "").split()
    return int(words[1]), int(words[4]), int(words[7])


def build_of(folder):
    return folder.parent / "build"


def wait_for(condition, seconds=60.0):
    """Wait for something that must happen; the limit only ends a test that hangs."""
    end = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end, "it never happened"
        time.sleep(0.01)


def alive(pid):
    try:
        with open(f"/proc/{pid}/stat") as file:
            return file.read().rsplit(")", 1)[1].split()[0] != "Z"
    except FileNotFoundError:
        return False


def left_cases(folder):
    return sorted(folder.parent.glob("ehdmaps-openfoam-*"))


@pytest.mark.slow
def test_a_map_and_the_same_command_again(folder, done):
    first = done("generate", "job.toml", "--workers", "1")
    assert counts(first.stdout) == (0, POINTS, 0)
    dataset = open_map(folder / "job.nc").dataset
    assert dataset.attrs["openfoam_version"] == "v1912"
    assert dataset.attrs["openfoam_build"] == openfoam_fake.record(build_of(folder))
    assert np.isfinite(dataset["film_compliance_error"].values).all()
    assert "OpenFOAM             v1912; ehlFoam built with openfoam v1912" in done("show", "job.nc").stdout
    assert counts(done("generate", "job.toml", "--workers", "1").stdout) == (POINTS, 0, 0)
    # another build solves its own points
    openfoam_fake.record(build_of(folder), sources="4567")
    assert counts(done("generate", "job.toml", "--workers", "1").stdout) == (0, POINTS, 0)
    assert sorted(os.listdir(folder)) == ["job.nc", "job.nc.log", "job.nc.store", "job.toml"]
    assert left_cases(folder) == []
    assert not (folder.parent / "home").exists()


@pytest.mark.slow
def test_failed_points_are_summed_up_and_tried_again_by_the_next_run(folder, done):
    openfoam_fake.set_mode(build_of(folder), "fatal")
    failed = done("generate", "job.toml", "--workers", "1", status=1)
    assert counts(failed.stdout) == (0, POINTS, POINTS)
    assert "4 x coarse grid: ehlFoam ended with status 1; last lines of the log: viscosity is negative" in failed.stdout
    openfoam_fake.set_mode(build_of(folder), "stagnated")
    stagnated = done("generate", "job.toml", "--workers", "1", status=1)
    assert counts(stagnated.stdout) == (0, POINTS, POINTS)
    openfoam_fake.set_mode(build_of(folder), "good")
    # a failure may not happen again; how a run converges is a result
    assert counts(done("generate", "job.toml", "--workers", "1", status=1).stdout) == (POINTS, 0, POINTS)
    assert counts(done("generate", "job.toml", "--workers", "1", "--fresh").stdout) == (0, POINTS, 0)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("end", "workers"),
    [(signal.SIGINT, "2"), (signal.SIGKILL, "1")],
    ids=["ctrl-c 2", "kill -9 1"],
)
def test_the_end_of_a_job_is_the_end_of_its_solvers(folder, done, end, workers):
    openfoam_fake.set_mode(build_of(folder), "hang")
    job = start(
        command(folder, "generate", "job.toml", "--workers", workers),
        cwd=folder,
        stderr=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
        start_new_session=True,
    )
    wait_for(lambda: len(openfoam_fake.starts(build_of(folder))) >= int(workers))
    if end is signal.SIGINT:
        os.killpg(job.pid, end)  # as a terminal does: to the workers too
    else:
        job.kill()
    out, err = job.communicate(timeout=300)
    assert job.returncode == (130 if end is signal.SIGINT else -9)
    assert out == ""
    assert "Traceback" not in err
    if end is signal.SIGINT:
        assert "stopped; what is solved is kept in job.nc.store" in err
    wait_for(lambda: not any(alive(pid) for pid, *_ in openfoam_fake.starts(build_of(folder))), seconds=10.0)
    openfoam_fake.set_mode(build_of(folder), "good")
    remove_leftovers.cache_clear()
    assert counts(done("generate", "job.toml", "--workers", "1").stdout) == (0, POINTS, 0)
    assert left_cases(folder) == []


def test_a_hanging_solver_is_stopped_after_its_time(folder, done):
    openfoam_fake.set_mode(build_of(folder), "hang")
    (folder / "job.toml").write_text(JOB + "timeout = 1\n")
    result = done("generate", "job.toml", "--workers", "1", status=1)
    assert "4 x coarse grid: ehlFoam did not end within" in result.stdout
    assert not any(alive(pid) for pid, *_ in openfoam_fake.starts(build_of(folder)))


POINT = ("--load", "62 N/mm", "--speed", "1.7 m/s", "--temperature", "40 degC")


@pytest.mark.slow
def test_one_point_with_fields_and_pictures(folder, done):
    result = done("solve", "job.toml", *POINT, "--fields", "film.vtu", "--plot", "film.png", "--json")
    assert [record["status"] for record in json.loads(result.stdout)] == ["converged", "converged"]
    assert result.stderr.splitlines() == [
        "film-inner.vtu: written",
        "film-outer.vtu: written",
        "film.png: written",
    ]
    assert meshio.read(folder / "film-inner.vtu").cells_dict["quad"].shape == (160, 4)
    assert (folder / "film.png").stat().st_size > 10_000
    plain = done("solve", "job.toml", *POINT, "--json")
    first, second = json.loads(result.stdout)[0], json.loads(plain.stdout)[0]
    assert {**first, "solve_seconds": 0} == {**second, "solve_seconds": 0}


def test_one_point_of_a_bare_contact_has_one_file(folder, done):
    bare = JOB.replace('[bearing]\nname = "NU308"', '[contact]\nradius = "5 mm"\nreference_depth = "5 mm"')
    (folder / "job.toml").write_text(bare.replace("iso16281", "half_space"))
    done("solve", "job.toml", *POINT, "--fields", "film.xdmf", "--keep-cases", "cases")
    assert meshio.read(folder / "film.xdmf").cell_data["p"][0].size == 160
    assert sorted(os.listdir(folder / "cases")) == [f"line_w62000_u1.7_T313.15_{grid}" for grid in ("20x2", "40x4")]


def test_a_full_temporary_disk_stops_a_map_that_goes_on_later(folder, done, monkeypatch):
    asked = []

    def copytree(*arguments, **options):
        asked.append(arguments)
        if len(asked) > 10:  # two parts of the template a grid, two grids a point
            raise OSError(errno.ENOSPC, "No space left on device")
        return usual(*arguments, **options)

    usual = shutil.copytree
    command = "generate", "job.toml", "--workers", "1"
    with monkeypatch.context() as full:
        full.setattr(shutil, "copytree", copytree)
        told = done(*command, status=2).stderr
    assert re.search(r"no room for the case of a point .*; the same command goes on: what was solved is kept\n$", told)
    assert left_cases(folder) == [] and not (folder / "job.nc").exists()
    _, every, lost = counts(done(*command, "-o", "whole.nc").stdout)
    taken, solved, _ = counts(done(*command).stdout)
    assert (taken + solved, lost) == (every, 0) and taken > 0
    maps = [open_map(name).dataset.drop_vars("solve_seconds").drop_attrs() for name in ("job.nc", "whole.nc")]
    xr.testing.assert_identical(*maps)


def test_axes_with_other_ends_share_the_points_that_differ_by_round_off_only(folder, done):
    axes = spaced("1 N/mm", "1000 N/mm", 4), spaced("0.1 N/mm", "1000 N/mm", 9)
    coarse, fine = (map_job(axis, '["1 m/s"]', '["40 degC"]', solver="openfoam") + SETTINGS for axis in axes)
    loads = [set(parse_job(text, "job", "job.toml").loads) for text in (coarse, fine)]
    assert len(loads[0] & loads[1]) == 1  # all four are there, three of them with other last bits
    runs = []
    for text in (coarse, fine, fine):
        (folder / "job.toml").write_text(text)
        done("generate", "job.toml", "--workers", "1")
        runs.append(len(openfoam_fake.starts(build_of(folder))))
    assert runs == [2 * 8, 2 * 18, 2 * 18]  # two grids a point, and both contacts


def test_one_point_that_fails_has_no_files(folder, done):
    openfoam_fake.set_mode(build_of(folder), "segv")
    result = done("solve", "job.toml", *POINT, "--fields", "film.vtu", "--plot", "film.png", status=1)
    assert "inner: coarse grid: ehlFoam crashed with signal 11 (SIGSEGV)" in result.stdout
    assert "inner: failed, no film to write" in result.stderr
    assert sorted(os.listdir(folder)) == ["job.toml"]


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--fields", "film.stl"], "--fields: got film-inner.stl; allowed: a file that ends in .vtu, .xdmf"),
        (["--plot", "none/film.png"], "--plot: got none/film.png, but none is no folder; allowed: a file in a folder"),
        (["--plot", "a.png", "--solver", "hertz"], "--plot: the solver 'hertz' has no fields across the film; allowed"),
        (["--keep-cases", "--solver", "hertz"], "--keep-cases: the solver 'hertz' works without cases; allowed: with"),
        (["--keep-cases", "job.toml"], "--keep-cases: got job.toml, a file; allowed: a folder"),
        (["--keep-cases", "my cases"], "OpenFOAM takes no spaces or quotes in the path of a case; choose another"),
    ],
)
def test_options_that_cannot_be(folder, done, arguments, message):
    assert message in done("solve", "job.toml", *POINT, *arguments, status=2).stderr
    assert openfoam_fake.starts(build_of(folder)) == []


def test_a_picture_that_cannot_be_written(folder, done):
    (folder / "film.png").mkdir()
    result = done("solve", "job.toml", *POINT, "--plot", "film.png", status=2)
    assert "--plot: got film.png, which is a folder; allowed: a file in it" in result.stderr


def test_check_tries_points(folder, done):
    told = done("check", "job.toml").stdout
    assert re.search(r"\n  time    about \S+ s of wall time on \d+ cores?\n  memory  about \d+ MB\n", told)
    assert re.search(r"\n    openfoam +4 points, .* \(2 points tried over the map took .*, 0 of them without", told)
    openfoam_fake.set_mode(build_of(folder), "fatal")
    tried = done("check", "job.toml", status=1).stdout
    assert tried.startswith("job.toml: no problems of the job itself, but no point that was tried has a solution\n")
    assert "\n  time    not estimated\n" in tried
    assert re.search(r"not estimated; 2 points tried .* have no solution: coarse grid: .*viscosity is neg", tried)


def test_check_names_what_is_missing_beside_other_problems(folder, done):
    (build_of(folder) / "bin" / "ehlFoam").unlink()
    (folder / "job.toml").write_text(JOB.replace('"FVA3"', '"FVA9"'))
    err = done("check", "job.toml", status=2).stderr
    assert "2 problems" in err
    assert "which needs more than is here: ehlFoam: there is no program" in err
    assert "build it with `ehdmaps openfoam --install`" in err
    assert "FVA9" in err
    for arguments in (["generate", "job.toml"], ["solve", "job.toml", *POINT]):
        assert "ehdmaps openfoam --install" in done(*arguments, status=2).stderr


def test_the_command_calls_the_script_that_builds(tmp_path, monkeypatch, capfd):
    """Options go on to it, its words reach the user, its exit status is that of the command."""
    script = tmp_path / "a folder" / "build"
    script.parent.mkdir()
    script.write_text('echo "got $*" >&2; echo "up to date: $1"; exit $#\n')
    monkeypatch.setattr("ehdmaps.jobs.commands.openfoam.build_script", lambda: script)
    for options in ([], ["--install"], ["--check"]):
        assert cli.main(["openfoam", *options]) == len(options)
        told = capfd.readouterr()
        assert told.out == f"up to date: {''.join(options)}\n"
        assert told.err == f"got {''.join(options)}\n"
    monkeypatch.setenv("PATH", str(tmp_path))
    assert cli.main(["openfoam"]) == 2
    assert f"bash is not in PATH; needed: a shell that runs {script}" in capfd.readouterr().err


@pytest.fixture
def checked(folder, tmp_path, monkeypatch, capfd):
    """A check of a fake build that the script finds up to date: exit status, and what is told."""
    script = tmp_path / "up_to_date"
    script.write_text("echo up to date\n")
    monkeypatch.setattr("ehdmaps.jobs.commands.openfoam.build_script", lambda: script)

    def check(mode: str) -> tuple[int, str]:
        openfoam_fake.set_mode(build_of(folder), mode)
        status = cli.main(["openfoam", "--check"])
        told = capfd.readouterr()
        return status, told.out + told.err

    return check


def test_a_check_runs_the_solver(folder, checked):
    status, told = checked("good")
    assert status == 0
    assert re.fullmatch(
        r"up to date\nruns: a case of 100 x 4 cells \(NU308, FVA3\) has a central film of \S+ um, in \S+ s\n", told
    )
    assert openfoam_fake.grids(build_of(folder)) == ["50x2", "100x4<50"]


@pytest.mark.parametrize(
    ("mode", "cause"),
    [
        ("fatal", "ended as failed: coarse grid: ehlFoam ended with status 1; .*viscosity is negative"),
        ("segv", r"ended as failed: coarse grid: ehlFoam crashed with signal 11 \(SIGSEGV\)"),
        ("nothing", "ended as failed: "),
        ("garbage", "ended as failed: "),
        ("nan", "ended as failed: "),
        ("stagnated", "ended as stagnated: "),
    ],
)
def test_a_check_tells_that_the_solver_does_not_run(checked, mode, cause):
    """Files that are there say nothing of a program that lacks a library, or crashes on this machine."""
    status, told = checked(mode)
    assert status == 1
    assert re.match(rf"up to date\ndoes not run: a case of 100 x 4 cells \(NU308, FVA3\) {cause}", told)


def test_a_check_names_what_a_run_lacks(folder, checked):
    (build_of(folder) / "bin" / "ehlFoam.build").unlink()
    status, told = checked("good")
    assert status == 2 and "ehlFoam: there is no record" in told


FOREIGN = {"WM_PROJECT_VERSION": "v2312", "LD_LIBRARY_PATH": "/opt/foreign/lib"}


@pytest.mark.parametrize("variable", FOREIGN)
def test_a_check_refuses_what_a_map_refuses(folder, checked, capfd, monkeypatch, variable):
    monkeypatch.setenv(variable, FOREIGN[variable])
    if variable == "LD_LIBRARY_PATH":
        program = build_of(folder) / "bin" / "ehlFoam"
        program.write_text('#!/bin/sh\necho "$LD_LIBRARY_PATH/libOpenFOAM.so: undefined symbol"; exit 127\n')
    status, told = checked("good")
    assert cli.main(["generate", "job.toml"]) == 2
    refused = capfd.readouterr().err
    problem = told.partition("\n")[2].strip().rpartition("problem\n")[2].strip()
    assert status == 2 and problem.startswith("ehlFoam: ")
    assert problem in refused and FOREIGN[variable] in problem
    assert not (folder / "job.nc.store").exists()


@pytest.mark.slow
def test_everything_else_works_without_openfoam(folder, done, monkeypatch):
    monkeypatch.setenv("EHDMAPS_OPENFOAM", str(folder / "none"))
    assert counts(done("generate", "job.toml", "--workers", "1", "--solver", "reynolds").stdout) == (0, POINTS, 0)
    code = (
        "import sys; from ehdmaps.jobs.cli import main; status = main(sys.argv[1:]); "
        "assert not [name for name in sys.modules if name.split('.')[0] in ('PyFoam', 'meshio')]; sys.exit(status)"
    )
    arguments = ["solve", "job.toml", *POINT, "--solver", "formula"]  # in a new home `reynolds` is compiled anew
    subprocess.run([sys.executable, "-c", code, *arguments], cwd=folder, check=True, capture_output=True)
