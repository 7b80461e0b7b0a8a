"""The solver `openfoam` with a stand-in for ehlFoam: statuses, errors, what is missing, what is left behind."""

import errno
import hashlib
import os
import re
import resource
import shutil
import subprocess
import sys
import tempfile
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from ehdmaps.ehl.start import reynolds_start
from ehdmaps.errors import DiskFullError, InputError
from ehdmaps.jobs import solvers
from ehdmaps.jobs.make.tasks import line_tasks
from ehdmaps.jobs.reader import parse_job, read_job
from ehdmaps.jobs.solve.plots import colour_limits, places
from ehdmaps.openfoam import installation as installed
from ehdmaps.openfoam.case import CLAIM, PREFIX, claimed, remove_leftovers
from ehdmaps.openfoam.grid_solver import GridSolution
from ehdmaps.openfoam.parameters import Temperatures
from ehdmaps.openfoam.pyfoam import parse, waited_for_processor
from ehdmaps.openfoam.results import FilmTable, Results
from ehdmaps.openfoam.run import RunError, TimeLimit, run
from ehdmaps.openfoam.solver import OpenFoamSolver
from ehdmaps.physics.contact import OperatingPoint
from ehdmaps.physics.hertz import DRY_COMPLIANCE
from ehdmaps.physics.solution import Status
from tests.cases import openfoam_fake
from tests.cases.programs import needed

JOB = read_job("nu308_openfoam")
CONTACT, OIL = JOB.contacts[0], JOB.lubricant
POINT = OperatingPoint(2e4, 1.0, 313.15)
OF_GRID = 4 / 400**2 + 1 / 6**2
"""What the fake of ehlFoam adds to its numbers on the fine grid, relative."""


@pytest.fixture
def fake(tmp_path, monkeypatch):
    """Folder of a fake build, in which ehlFoam does what `set_mode` says; the working folder and home are empty."""
    needed("setpriv")
    folder = tmp_path / "build"
    for key, value in openfoam_fake.build(folder).items():
        monkeypatch.setenv(key, value)
    for place in ("temporary", "home", "here"):
        (tmp_path / place).mkdir()
    monkeypatch.setenv("HOME", str(tmp_path / "home"))
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path / "temporary"))
    monkeypatch.chdir(tmp_path / "here")
    return folder


def solved(solver, load=POINT.load, speed=POINT.entrainment_speed):
    (film,) = solver.solve_line(CONTACT, OIL, (load,), speed, POINT.temperature)
    return film


def left(fake, place):
    return sorted(os.listdir(fake.parent / place))


def test_a_point_on_two_grids(fake, capfd):
    film = solved(OpenFoamSolver())
    assert (film.status, film.reason, film.iterations) == (Status.CONVERGED, "", 14)
    # the fake is of second order: a third of the difference is the error, and its sign says that values are too large
    assert film.film_offset_error == pytest.approx(OF_GRID / (1.0 + OF_GRID))
    assert film.film_compliance_error > 0.0
    assert film.loss_compliance_error > 0.0
    assert film.central_film_error == pytest.approx(OF_GRID / (1.0 + OF_GRID))
    # the fake's smallest film and largest pressure do not depend on the grid: what is left stands between the columns
    assert film.minimum_film_error == 0.0
    assert 0.0 < film.max_pressure_error < 1e-3
    assert film.solve_seconds > 0.0
    assert [Path(case).name.split("-")[1] for *_, case in openfoam_fake.starts(fake)] == ["openfoam"] * 2
    assert left(fake, "temporary") == left(fake, "home") == left(fake, "here") == []
    assert capfd.readouterr().out == ""


def test_a_line_of_loads(fake):
    films = OpenFoamSolver().solve_line(CONTACT, OIL, (1e4, 2e4), 1.0, 313.15)
    assert films[0].film_offset != films[1].film_offset


def test_many_frequencies_from_one_run_a_grid(fake):
    frequencies = np.array([9.0, 99.0, 999.0])
    found = OpenFoamSolver().film_spectrum(CONTACT, OIL, POINT, frequencies)
    assert len(openfoam_fake.starts(fake)) == 2  # one a grid
    slow = solved(OpenFoamSolver())
    assert found.film.loss_compliance == slow.loss_compliance
    # the fake's loss falls with 1/(1 + frequency), its film compliance does not
    assert found.compliance.real == pytest.approx(np.full(3, slow.film_compliance), rel=1e-12)
    loss = -found.compliance.imag / (2.0 * np.pi * frequencies)
    assert loss == pytest.approx(slow.loss_compliance / np.array([10.0, 100.0, 1000.0]), rel=1e-12)
    # and the fake is of second order: four times its error on half the columns, so that the difference, which is stated
    # of what is of first order, is three times what is left
    assert found.errors.shape == (3, 5)
    assert not found.errors[:, 3:].any()
    share = found.errors[:, 0].real / found.compliance.real
    assert share == pytest.approx(np.full(3, 3.0 * OF_GRID / (1.0 + OF_GRID)))


def test_what_the_krylov_space_leaves_is_an_error(fake):
    found = OpenFoamSolver().film_spectrum(CONTACT, OIL, POINT, np.array([9.0, 5e6]))
    at_rest = found.film.film_compliance + 4.0 * DRY_COMPLIANCE / CONTACT.reduced_modulus
    assert np.abs(found.errors[:, 3]) == pytest.approx([0.0, 0.1 * at_rest], rel=1e-12)
    assert np.abs(found.errors[:, 4]) == pytest.approx([0.0, 0.1 * at_rest], rel=1e-12)


def test_a_spectrum_that_fails_has_its_cause(fake):
    openfoam_fake.set_mode(fake, "stagnated")
    found = OpenFoamSolver().film_spectrum(CONTACT, OIL, POINT, np.array([9.0]))
    assert found.film.status is Status.STAGNATED
    assert np.isnan(found.compliance).all()


def test_a_spectrum_at_a_standstill_is_that_of_the_dry_contact(fake):
    found = OpenFoamSolver().film_spectrum(CONTACT, OIL, OperatingPoint(2e4, 0.0, 313.15), np.array([9.0]))
    assert found.film.status is Status.ASYMPTOTE
    assert found.compliance == 0.0


FAILURES = {
    "fatal": (Status.FAILED, r"ehlFoam ended with status 1; last lines of the log: viscosity is negative \| file"),
    "segv": (Status.FAILED, r"ehlFoam crashed with signal 11 \(SIGSEGV\); .*\| Newton step 3; log /"),
    "killed": (Status.FAILED, r"killed twice: ehlFoam was killed by signal 9 \(SIGKILL\)"),
    "hang": (
        Status.FAILED,
        r"ehlFoam did not end within the [0-9.]+ s that it had and was stopped; last lines of the log: fake",
    ),
    "silent": (Status.FAILED, r"ehlFoam did not end within the [0-9.]+ s that it had and was stopped"),
    "flood": (Status.FAILED, r"ehlFoam printed more than 50 MB and was stopped"),
    "nothing": (Status.FAILED, r"results: is not there; last lines of the log: fake ehlFoam"),
    "garbage": (Status.FAILED, r"results: is no OpenFOAM dictionary"),
    "no_response": (Status.FAILED, r"results: got responses at \(\) Hz; allowed: as asked"),
    "nan": (Status.FAILED, r"results, filmOffset: got 'nan'; allowed: a finite number"),
    "table": (Status.FAILED, r"film.dat: is no table of numbers"),
    "cut": (Status.FAILED, r"film.dat: got an array of shape \(3, 6\)"),
    "stagnated": (Status.STAGNATED, r"ehlFoam stagnated: residual 1e-3 after 200 iterations"),
    "diverged": (Status.DIVERGED, r"ehlFoam diverged: residual 1e-3 after 200 iterations"),
}


@pytest.mark.parametrize("mode", FAILURES)
def test_a_run_that_fails_is_a_point_with_its_cause(fake, capfd, mode):
    status, message = FAILURES[mode]
    openfoam_fake.set_mode(fake, mode)
    film = solved(OpenFoamSolver(timeout=60.0 if mode == "flood" else 1.5))
    assert film.status is status
    assert re.match(r"coarse grid: .*" + message, film.reason)
    assert np.isnan(film.film_offset)
    assert film.iterations == (7 if status is not Status.FAILED else 0)
    # the log stands where the reason says, in a folder whose name differs from others in numbers only
    log = Path(re.search(r"; log (\S+)$", film.reason)[1])
    assert log.is_file()
    assert re.fullmatch(r"ehdmaps-openfoam-[0-9-]+", log.parent.name)
    assert left(fake, "home") == left(fake, "here") == []
    assert capfd.readouterr().out == ""
    for pid, *_ in openfoam_fake.starts(fake):
        assert not Path(f"/proc/{pid}").exists()


def test_a_start_that_compiles_takes_no_time_of_the_runs(fake, monkeypatch):
    """The first one of a process may take minutes in a fresh installation."""
    clock, passed = time.monotonic, [0.0]
    monkeypatch.setattr(time, "monotonic", lambda: clock() + passed[0])

    def long(*_):
        passed[0] += 1e4

    assert solved(OpenFoamSolver(starter=long)).status is Status.CONVERGED
    assert passed[0] >= 1e4


def test_a_fine_grid_that_fails(fake):
    openfoam_fake.set_mode(fake, "hang_fine")
    film = solved(OpenFoamSolver(timeout=2.0))
    assert film.status is Status.FAILED
    assert film.reason.startswith("fine grid: ehlFoam did not end within")
    assert film.iterations == 7
    assert len(left(fake, "temporary")) == 1  # the coarse case was good


FINE = ["400x6<200", "300x4<200", "400x6<300", "400x6", "440x6"]
"""Runs on the fine grid that may follow each other: from the coarse one, over one between, on its own, elsewhere."""


@pytest.mark.parametrize(
    ("stagnates", "tried"),
    [
        ([], ["200x3", "400x6<200"]),
        (["200x3"], ["200x3", "220x3", "400x6<220"]),
        (["400x6<200"], ["200x3", *FINE[:3]]),
        (["400x6<200", "300x4<200"], ["200x3", *FINE[:2], *FINE[3:4]]),
        (["400x6<200", "400x6<300"], ["200x3", *FINE[:4]]),
        (["400x6<200", "400x6<300", "400x6"], ["200x3", *FINE]),
    ],
)
def test_a_grid_that_stagnates_is_tried_otherwise_and_leaves_nothing(fake, stagnates, tried):
    openfoam_fake.set_mode(fake, " ".join(["stagnates_on", *stagnates]))
    film = solved(OpenFoamSolver())
    assert film.status is Status.CONVERGED
    assert openfoam_fake.grids(fake) == tried
    notes = [f"solved on {columns} columns" for columns in (220, 440) if f"{columns}x" in " ".join(tried)]
    assert film.reason == "; ".join(notes)
    assert left(fake, "temporary") == []


def test_only_the_last_case_of_a_point_that_failed_stays(fake):
    openfoam_fake.set_mode(fake, " ".join(["stagnates_on", "400x6<200", "400x6<300", "400x6", "440x6"]))
    film = solved(OpenFoamSolver())
    assert film.status is Status.STAGNATED
    assert openfoam_fake.grids(fake) == ["200x3", *FINE]
    (folder,) = left(fake, "temporary")
    assert f"/{folder}/log.ehlFoam.logfile" in film.reason
    openfoam_fake.set_mode(fake, "killed")
    assert "killed twice" in solved(OpenFoamSolver()).reason
    assert len(left(fake, "temporary")) == 2


def test_all_stresses_without_a_solution_where_no_oil_is_newtonian(fake):
    openfoam_fake.set_mode(fake, "steep")
    flagged = [solved(OpenFoamSolver(flow=flow)) for flow in ("thin_film", "full_stress")]
    assert all(film.status is Status.CONVERGED and "no oil is Newtonian there" in film.reason for film in flagged)
    openfoam_fake.set_mode(fake, "stagnated")
    assert solved(OpenFoamSolver(flow="full_stress")).status is Status.STAGNATED
    openfoam_fake.set_mode(fake, "stagnated steep")
    film = solved(OpenFoamSolver(flow="full_stress"))
    assert film.status is Status.OUTSIDE_VALIDITY
    assert re.match(
        r"coarse grid: ehlFoam outside_validity: the thin film has a wall stress [\d.]+ of the pressure, above 0.1: "
        r"no oil is Newtonian there; with all stresses residual 1e-3 after 200 iterations: take flow thin_film, or a "
        r"law of shear that limits the stress; last lines of the log",
        film.reason,
    )
    assert openfoam_fake.grids(fake)[-2:] == ["200x3", "220x3"]  # it might have converged on other columns
    assert solved(OpenFoamSolver()).status is Status.STAGNATED
    assert solved(OpenFoamSolver(flow="full_stress", shear="eyring", shear_stress=5e6)).status is Status.STAGNATED


def test_kept_cases_are_those_of_all_tries(fake, tmp_path):
    openfoam_fake.set_mode(fake, "stagnates_on 400x6<200 200x3")
    assert solved(OpenFoamSolver(keep_cases=tmp_path / "kept")).status is Status.CONVERGED
    grids = [name.rpartition("_")[2] for name in left(fake, "kept")]
    assert grids == sorted(["200x3", "220x3", "400x6"])


def test_a_process_that_is_killed_by_somebody_is_tried_again(fake):
    openfoam_fake.set_mode(fake, "killed_once")
    film = solved(OpenFoamSolver())
    assert film.status is Status.CONVERGED
    assert film.reason == "solved at the second try, the first ehlFoam was killed by signal 9 (SIGKILL)"
    assert left(fake, "temporary") == []


def test_a_program_that_cannot_be_started(fake, tmp_path):
    with pytest.raises(RunError, match=r"none ended with status 127; .*failed to execute"):
        (tmp_path / "case").mkdir()
        run(tmp_path / "none", tmp_path / "case", os.environ, TimeLimit(5.0))
    with pytest.raises(RunError, match=r"ehlFoam cannot be started: No such file or directory; case "):
        run(fake / "bin" / "ehlFoam", tmp_path / "case", {"PATH": "/none"}, TimeLimit(5.0))


@pytest.mark.parametrize(
    ("mode", "status", "reason"),
    [
        ("thick", Status.ASYMPTOTE, "film thicker than 1 % of the radius"),
        ("negative", Status.CONVERGED, "negative damping at the valley"),
        ("steep", Status.CONVERGED, "wall stress 2.1 of the pressure, above 0.1: no oil is Newtonian there"),
    ],
)
def test_solutions_with_a_remark(fake, mode, status, reason):
    openfoam_fake.set_mode(fake, mode)
    film = solved(OpenFoamSolver())
    assert film.status is status
    assert film.reason.startswith(reason)


def test_points_that_need_no_run(fake):
    solver = OpenFoamSolver()
    dry = solved(solver, speed=0.0)
    assert (dry.status, dry.film_offset, dry.reason) == (Status.ASYMPTOTE, 0.0, "no entrainment: dry contact")
    heavy = solved(solver, load=1e9)
    assert heavy.status is Status.OUTSIDE_VALIDITY
    assert "GPa above 10 GPa" in heavy.reason
    assert openfoam_fake.starts(fake) == []


def test_numbers_that_are_none_reach_no_case(fake):
    nowhere = replace(reynolds_start(CONTACT, OIL, 2e4, 1.0, 313.15), expected_film=float("nan"))
    film = solved(OpenFoamSolver(starter=lambda *_: nowhere))
    assert film.status is Status.OUTSIDE_VALIDITY
    assert film.reason == "ehlProperties, pressureRange: got nan; allowed: a finite number"
    assert openfoam_fake.starts(fake) == []


def test_a_point_starts_from_the_reynolds_solution(fake, tmp_path):
    solver = OpenFoamSolver(starter=reynolds_start, keep_cases=tmp_path / "kept", slide_to_roll=0.5)
    solved(solver)
    coarse, fine = (
        parse(tmp_path / "kept" / f"inner_w20000_u1_T313.15_{grid}" / "constant" / "ehlProperties")
        for grid in ("200x3", "400x6")
    )
    start = reynolds_start(CONTACT, OIL, POINT.load, POINT.entrainment_speed, POINT.temperature)
    np.testing.assert_array_equal(coarse["start"]["pressure"], start.pressure)
    assert coarse["start"]["centralFilm"] == start.central_film
    assert coarse["mesh"] == fine["mesh"]
    assert coarse["mesh"]["spikeWidth"] == start.spike_width > 0.0
    assert (coarse["columns"], coarse["rows"], fine["columns"], fine["rows"]) == (200, 3, 400, 6)
    assert (coarse["lowerSpeed"], coarse["upperSpeed"]) == (0.75, 1.25)
    # the fine grid starts from what the coarse one found
    assert len(list(fine["start"]["x"])) == 200
    assert fine["writeFields"] is True or fine["writeFields"] == "true"
    assert left(fake, "temporary") == []


def test_a_start_is_a_pressure_that_carries_the_load():
    start = reynolds_start(CONTACT, OIL, 2e5, 1.0, 313.15)
    assert np.trapezoid(start.pressure, start.x) == pytest.approx(2e5, rel=0.01)
    front = start.x[np.argmin(np.gradient(start.pressure, start.x))]
    half = np.sqrt(8 * 2e5 * CONTACT.radius / (np.pi * CONTACT.reduced_modulus))
    assert start.spike_position * half == pytest.approx(front, abs=start.spike_width * half)
    light = reynolds_start(CONTACT, OIL, 1e3, 1.0, 313.15)
    assert (light.spike_position, light.spike_width) == (0.0, 0.0)


def test_a_point_without_a_reynolds_solution_has_no_start():
    assert reynolds_start(CONTACT, OIL, 1e6, 5.0, 263.15) is None  # Newton gives up
    assert reynolds_start(CONTACT, OIL, 1e300, 1e-300, 313.15) is None


def test_a_point_without_a_start(fake):
    for starter in (None, lambda *_: None):
        parameters = OpenFoamSolver(starter=starter).parameters(CONTACT, OIL, POINT)
        assert parameters.start is None
        assert parameters.mesh.spike_width == 0.0
        assert 0.3 < parameters.mesh.film / reynolds_start(CONTACT, OIL, 2e4, 1.0, 313.15).expected_film < 3.0


def test_kept_cases_of_a_second_run_stand_beside_the_first(fake, tmp_path):
    solver = OpenFoamSolver(keep_cases=tmp_path / "kept")
    solved(solver)
    solved(solver)
    assert left(fake, "kept") == [
        f"inner_w20000_u1_T313.15_{grid}{number}" for grid in ("200x3", "400x6") for number in ("", "-1")
    ]
    assert (tmp_path / "kept" / "inner_w20000_u1_T313.15_200x3" / "1" / "p").is_file()


def test_a_case_that_cannot_be_made(fake):
    (fake / "file").touch()
    film = solved(OpenFoamSolver(keep_cases=fake / "file" / "kept"))
    assert film.status is Status.FAILED
    assert re.match(r"coarse grid: a case cannot be made in .*file/kept \(Not a directory\); allowed: ", film.reason)


def no_room(*_, **__):
    raise OSError(errno.ENOSPC, "No space left on device")


FULL = r"temporary: no room for the case of a point \(No space left on device, .* MB are free\); allowed: 1 MB or more"


@pytest.mark.parametrize(
    "error", [OSError(errno.ENOSPC, "No space left on device"), shutil.Error([("a", "b", "full")])]
)
def test_a_case_that_finds_no_room_is_no_point_that_failed(fake, monkeypatch, error):
    """`copytree` collects errors into one that has no number: then the disk itself is asked."""

    def copytree(*_, **__):
        raise error

    monkeypatch.setattr("ehdmaps.openfoam.case.shutil.copytree", copytree)
    monkeypatch.setattr(os, "posix_fallocate", no_room)
    with pytest.raises(DiskFullError, match=FULL):
        solved(OpenFoamSolver())
    assert left(fake, "temporary") == []


def test_a_case_that_cannot_be_made_leaves_nothing(fake, monkeypatch):
    def refused(*_, **__):
        raise OSError(errno.EIO, "Input/output error")

    monkeypatch.setattr("ehdmaps.openfoam.case.shutil.copytree", refused)
    assert "(Input/output error); allowed: " in solved(OpenFoamSolver()).reason
    assert left(fake, "temporary") == []


@pytest.mark.parametrize("mode", ["fatal", "nothing", "garbage", "stagnated"])
def test_a_run_that_fails_on_a_full_disk_is_no_point_that_failed(fake, monkeypatch, mode):
    """What the program says, if anything, is not asked: it cannot say that its files are cut off."""
    openfoam_fake.set_mode(fake, mode)
    monkeypatch.setattr(os, "posix_fallocate", no_room)
    with pytest.raises(DiskFullError, match=FULL):
        solved(OpenFoamSolver())
    assert left(fake, "temporary") == []


def test_files_that_the_system_cuts_off(fake):
    """The program writes 3000 bytes of its columns, and no more."""
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    solver = OpenFoamSolver()
    resource.setrlimit(resource.RLIMIT_FSIZE, (3000, hard))
    try:
        with pytest.raises(DiskFullError, match=r"no room for the case of a point \(File too large, "):
            solved(solver)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))
    assert solved(solver).status is Status.CONVERGED


def test_a_log_that_the_disk_does_not_take(fake, monkeypatch):
    monkeypatch.setattr("ehdmaps.openfoam.grid_solver.run", no_room)
    with pytest.raises(DiskFullError, match=FULL):
        solved(OpenFoamSolver())
    assert left(fake, "temporary") == []


def test_only_what_a_killed_run_of_our_own_left_is_removed(tmp_path):
    def folder(name):
        (tmp_path / name).mkdir()
        return tmp_path / name

    user = os.getuid()
    working = folder(f"{PREFIX}{user}-1-0")
    abandoned, failed = folder(f"{PREFIX}{user}-1-1"), folder(f"{PREFIX}{user}-1-2")
    foreign, other = folder(f"{PREFIX}{user + 1}-1-3"), folder("somebody-else")
    (tmp_path / f"{PREFIX}{user}-1-4").symlink_to(other)
    for left_behind in (abandoned, foreign, other):
        (left_behind / CLAIM).touch()
    with claimed(working):
        remove_leftovers.__wrapped__(tmp_path)
        assert not abandoned.exists()
        assert all(each.exists() for each in (working, failed, foreign, other, tmp_path / f"{PREFIX}{user}-1-4"))
    assert list(working.iterdir()) == []  # from now on it is one that is kept


def test_the_time_of_a_point_is_that_of_both_grids(fake):
    openfoam_fake.set_mode(fake, "patient 0.7")
    film = solved(OpenFoamSolver(timeout=1.2))
    assert film.reason.startswith("fine grid: ehlFoam did not end within the 0.")


def test_what_a_program_waits_for_a_processor_is_not_of_its_time(fake, tmp_path):
    """0.6 s of work beside three others on one processor, more than 0.8 s by the clock, which are all that it has; as a
    session of its own it has half of the processor."""
    if waited_for_processor(os.getpid()) == 0.0:
        pytest.skip("this system does not tell how long a process waits: no /proc/PID/schedstat")
    program = tmp_path / "works"
    program.write_text(f"#!{sys.executable}\nimport time\nwhile time.process_time() < 0.6: pass\nprint('End')\n")
    program.chmod(0o755)
    (case := tmp_path / "case").mkdir()
    allowed = os.sched_getaffinity(0)
    os.sched_setaffinity(0, {min(allowed)})
    others = [subprocess.Popen([sys.executable, "-c", "while True: pass"]) for _ in range(3)]
    try:
        begin, limit = time.monotonic(), TimeLimit(0.8)
        run(program, case, os.environ, limit)
        assert limit.waited > 0.2
        assert time.monotonic() - begin > 0.8
    finally:
        for other in others:
            other.kill()
            other.wait()
        os.sched_setaffinity(0, allowed)


def test_what_is_left_of_a_case_that_ran_by_hand_is_not_copied(fake):
    case = fake / "lineContact"
    (case / "constant" / "polyMesh").mkdir()
    (case / "1").mkdir()
    (case / "results").write_text("old")
    openfoam_fake.set_mode(fake, "nothing")
    log = Path(solved(OpenFoamSolver()).reason.rpartition("log ")[2])
    assert sorted(os.listdir(log.parent / "constant")) == ["ehlProperties"]
    assert not (log.parent / "1").exists()
    assert not (log.parent / "results").exists()


OPTIONS = {
    "columns": (dict(columns=20), "columns: got 20; allowed: 40 to 4000"),
    "odd columns": (dict(columns=401), "columns: got 401; allowed: an even number"),
    "rows": (dict(rows=65), "rows: got 65; allowed: 4 to 64"),
    "flow": (dict(flow="thick"), "flow: got 'thick'; allowed: thin_film, full_stress"),
    "shear": (dict(shear="plastic"), "solver, shear: got 'plastic'; allowed: newtonian, eyring, carreau, limiting"),
    "no stress": (dict(shear="eyring", shear_stress=0.0), "solver, shear_stress: got 0.0; allowed: 1000 to 1e.10"),
    "a stress": (dict(shear_stress=5e6), "solver, shear_stress: got 5000000.0 with shear newtonian, which has none"),
    "a ratio": (dict(shear="eyring", limiting_ratio=0.1), "limiting_ratio: got 0.1 with shear eyring, which has none"),
    "slide": (dict(slide_to_roll=3.0), "slide_to_roll: got 3.0; allowed: -2 to 2"),
    "nan": (dict(slide_to_roll=float("nan")), "slide_to_roll: got nan; allowed: -2 to 2"),
    "physics": (dict(physics="inlet-heat"), "physics: got 'inlet-heat'; allowed: isothermal, thermal"),
    "a wall that stands": (dict(physics="thermal", slide_to_roll=-2.0), "slide_to_roll: got -2.0 with physics thermal"),
    "timeout": (dict(timeout=0.0), "timeout: got 0.0; allowed: 0.1 to"),
    "folder": (dict(keep_cases=Path("/tmp/my cases")), "OpenFOAM takes no spaces or quotes in the path of a case"),
}


@pytest.mark.parametrize("name", OPTIONS)
def test_settings_out_of_range(fake, name):
    options, message = OPTIONS[name]
    with pytest.raises(InputError, match=message):
        OpenFoamSolver(**options)


def test_a_shear_law_with_its_stress(fake):
    solver = OpenFoamSolver(shear="eyring", shear_stress=5e6)
    assert re.search(r"shear\n{\n +type +Eyring;\n +stress +5000000.0;", solver.parameters(CONTACT, OIL, POINT).text())
    usual = OpenFoamSolver(shear="limiting")
    numbers = r"type +limiting;\n +stress +2000000.0; .*\n +ratio +0.05;"
    assert re.search(numbers, usual.parameters(CONTACT, OIL, POINT).text())
    assert usual.settings()["shear_stress"] == 2e6 and "limiting_ratio" not in usual.settings()
    assert OpenFoamSolver(shear="limiting", limiting_ratio=0.07).settings()["limiting_ratio"] == 0.07


def test_settings_and_build_are_in_the_key_of_a_task_but_the_timeout_is_not(fake):
    def key(**options):
        return line_tasks(JOB, solvers.build("openfoam", {**JOB.solver_options, **options}))[0].key

    first = key()
    assert key(timeout=5.0) == first
    assert key(columns=200) != first
    assert key(start="hertz") != first
    (fake / "lineContact" / "constant" / "ehlProperties").write_text("another default")
    assert key() == first
    (fake / "lineContact" / "system" / "controlDict").write_text("another scheme")
    second = key()
    assert second != first
    openfoam_fake.record(fake, sources="4567")
    assert key() not in (first, second)


def test_provenance(fake):
    solver = OpenFoamSolver()
    assert solver.provenance == {
        "openfoam_version": "v1912",
        "openfoam_build": openfoam_fake.record(fake),
    }
    assert solver.slow
    unknown = replace(solver.installed, build="built by hand")
    assert replace(solver, installed=unknown).provenance["openfoam_version"] == "unknown"


MISSING = {
    "ehlFoam": r"there is no program .*bin/ehlFoam; build it with `ehdmaps openfoam --install`",
    "ehlFoam.build": r"there is no record .*ehlFoam.build of its build; build it again with `ehdmaps openfoam`",
}


@pytest.mark.parametrize("name", MISSING)
def test_what_is_missing_is_named_with_what_to_do(fake, monkeypatch, name):
    (fake / "bin" / name).unlink()
    monkeypatch.setenv("PATH", f"{fake / 'bin'}")
    setpriv = fake / "bin" / "setpriv"
    setpriv.write_text("#!/bin/sh\n")
    setpriv.chmod(0o755)
    (problem,) = installed.missing()
    assert re.search(MISSING[name], problem)
    with pytest.raises(InputError, match="solver 'openfoam': ehlFoam"):
        solvers.build("openfoam", {})
    with pytest.raises(InputError, match=r"\[solver\] name: got 'openfoam', which needs more than is here: "):
        read_job("nu308_openfoam", to_run=True)
    assert read_job("nu308_openfoam").solver == "openfoam"
    assert read_job("nu308_openfoam", "reynolds", to_run=True).solver == "reynolds"


def test_a_build_for_another_openfoam_is_refused(fake, monkeypatch):
    openfoam_fake.record(fake, version="1912.200626-1")  # the distribution's words for the same
    assert installed.missing() == ()
    monkeypatch.setenv("WM_PROJECT_VERSION", "v2312")
    (problem,) = installed.missing()
    assert re.search(r"is built for OpenFOAM 1912.200626-1, found is OpenFOAM v2312; source etc/bashrc of", problem)
    assert "or build it again with `ehdmaps openfoam`" in problem
    (fake / "bin" / "ehlFoam.build").write_text(f"processor {installed.processor()}\n")
    assert "without the version of OpenFOAM in its record, found is OpenFOAM v2312" in installed.missing()[0]


STARTS = {
    "cat no_such_library": r"does not start \(cat: no_such_library: .*\); see to .* LD_LIBRARY_PATH '/o/lib'",
    "exit 3": r"does not start \(status 3\); see to WM_PROJECT_DIR",
    "echo 'Using: OpenFOAM-v2312 (2312)'": r"for OpenFOAM v1912, the libraries that it finds are of OpenFOAM 2312; ",
}


@pytest.mark.parametrize("script", STARTS)
def test_a_program_that_finds_foreign_libraries_is_refused_before_anything_is_solved(fake, monkeypatch, script):
    (fake / "bin" / "ehlFoam").write_text(f"#!/bin/sh\n{script}\n")
    monkeypatch.setenv("LD_LIBRARY_PATH", "/o/lib")
    (problem,) = installed.missing()
    assert re.search(STARTS[script], problem)
    assert problem.endswith("or build it again with `ehdmaps openfoam`")
    monkeypatch.delenv("LD_LIBRARY_PATH")
    assert "LD_LIBRARY_PATH" not in installed.missing()[0]


def test_a_program_that_is_none_is_refused(fake):
    (fake / "bin" / "ehlFoam").write_text("")
    assert re.search(r"cannot be started \(.*Exec format error.*\); build it again", installed.missing()[0])


def test_a_build_on_another_processor_is_refused(fake, tmp_path):
    openfoam_fake.record(fake, machine="0123456789abcdef")
    (problem,) = installed.missing()
    assert f"of another processor (record 0123456789abcdef, here {installed.processor()})" in problem
    assert "build it again with `ehdmaps openfoam`, or set EHDMAPS_OPENFOAM to a folder" in problem
    (fake / "bin" / "ehlFoam.build").write_text("openfoam v1912\n")
    assert "(record none, here " in installed.missing()[0]
    flags = tmp_path / "cpuinfo"
    flags.write_text("model name : one\nflags : fpu avx\nmodel name : two\nflags : fpu avx\n")
    assert installed.processor(flags) == hashlib.sha256(b"flags : fpu avx\n").hexdigest()[:16]
    assert installed.processor(tmp_path / "none") == hashlib.sha256(b"").hexdigest()[:16]


def test_the_processor_is_the_one_that_the_build_command_records():
    script = (Path(__file__).parents[2] / "openfoam_cases" / "build").read_text()
    function = re.search(r"(?ms)^processor\(\).*?^}$", script)[0]
    told = subprocess.run([needed("bash"), "-c", f"{function}\nprocessor"], capture_output=True, text=True, check=True)
    assert told.stdout.strip() == installed.processor()


def test_everything_that_is_missing_is_named_at_once(tmp_path, monkeypatch):
    monkeypatch.setattr(installed, "cases_folder", lambda: None)
    monkeypatch.setattr(tempfile, "tempdir", "/tmp/with space")
    monkeypatch.setitem(sys.modules, "PyFoam", None)
    with pytest.raises(InputError) as raised:
        installed.installation({"PATH": "", "EHDMAPS_OPENFOAM": str(tmp_path)})
    found = "\n".join(raised.value.problems)
    for part in (
        "the solver 'openfoam': the package PyFoam cannot be loaded",
        "setpriv is not in PATH; install the package util-linux",
        "ehlFoam: there is no program",
        f"case lineContact: is not in {tmp_path}, and no folder openfoam_cases is beside the package ehdmaps, nor in",
        "the folder for temporary files: got '/tmp/with space'; OpenFOAM takes no spaces",
    ):
        assert part in found
    assert len(raised.value.problems) == 5


def test_cases_of_an_installation_are_in_its_package_and_a_clone_has_its_own(tmp_path):
    package = tmp_path / "a b" / "site-packages" / "ehdmaps"
    assert installed.cases_folder(package) is None
    for folder in (package, package.parent):
        (folder / "openfoam_cases").mkdir(parents=True)
        assert installed.cases_folder(package) != folder / "openfoam_cases"  # a folder without the script
        (folder / "openfoam_cases" / "build").write_text("")
        assert installed.cases_folder(package) == folder / "openfoam_cases"


def test_the_script_that_builds_is_that_of_the_clone(monkeypatch):
    assert installed.build_script() == Path(__file__).parents[2] / "openfoam_cases" / "build"
    monkeypatch.setattr(installed, "cases_folder", lambda: None)
    with pytest.raises(
        InputError, match=r"^the sources of ehlFoam: no folder .*; install ehdmaps again, from its wheel"
    ):
        installed.build_script()


def test_a_build_in_a_folder_with_blanks_is_refused(fake, monkeypatch):
    """OpenFOAM would end with a message of its own at every point."""
    shutil.copytree(fake, fake.parent / "a build")
    monkeypatch.setenv("EHDMAPS_OPENFOAM", str(fake.parent / "a build"))
    (problem,) = installed.missing()
    assert re.search(
        r"got the program '.*/a build/bin/ehlFoam'; OpenFOAM takes no spaces .*; set EHDMAPS_OPENFOAM", problem
    )


def test_openfoam_without_its_environment(fake, tmp_path, monkeypatch):
    known = {key: value for key, value in os.environ.items() if key != "WM_PROJECT_DIR"}
    monkeypatch.setattr(installed, "DEBIAN", tmp_path)
    assert dict(installed.installation(known).environment) == installed.DEBIAN_ENVIRONMENT
    monkeypatch.setattr(installed, "DEBIAN", tmp_path / "none")
    with pytest.raises(
        InputError, match=r"WM_PROJECT_DIR is not set .*; install the package openfoam, or source etc/bashrc"
    ):
        installed.installation(known)


def test_the_folder_of_the_build():
    assert installed.build_folder({"EHDMAPS_OPENFOAM": "/opt/x"}) == Path("/opt/x")
    assert installed.build_folder({"XDG_CACHE_HOME": "/c"}) == Path("/c/ehdmaps/openfoam")
    assert installed.build_folder({}) == Path("~/.cache/ehdmaps/openfoam").expanduser()


def test_the_shipped_job():
    assert JOB.shape == (2, 6, 4, 2)
    assert JOB.solver_options["flow"] == "thin_film"
    assert JOB.solver_options["columns"] == 400


HOSTILE_KEYS = {
    'flow = "thin_film; #calc"': "flow: got 'thin_film; #calc' .*; allowed: 'thin_film', 'full_stress'",
    'columns = "400"': "columns: got '400'; allowed: a whole number from 40 to 4000",
    "columns = 400.0": "columns: got 400.0; allowed: a whole number",
    "rows = 100": "rows: got 100; allowed: a whole number from 4 to 64",
    "shear_stress = nan": "shear_stress: got nan; allowed: 1000 to 1e.10",
    "shear_stress = inf": "shear_stress: got inf",
    'shear_stress = "$load"': r"shear_stress: got '\$load', which does not start with a number",
    'physics = "inlet-heat"': "physics: got 'inlet-heat'; allowed: 'isothermal', 'thermal'",
    "slide_to_roll = -3": "slide_to_roll: got -3; allowed: -2 to 2",
    "inlet_length = 2": "inlet_length: got 2; allowed: 5 to",
    'start = "zero"': "start: got 'zero'; allowed: 'reynolds', 'hertz'",
    "timeout = 0": "timeout: got 0; allowed: 1 to",
    "density = 6.5": "density: unknown key",
}


@pytest.mark.parametrize("line", HOSTILE_KEYS)
def test_keys_of_a_job_that_are_refused(line):
    key = line.split()[0]
    above, solver = JOB.text.split("[solver]\n")
    text = above + "[solver]\n" + re.sub(rf"^{key} .*\n", "", solver, flags=re.MULTILINE) + line + "\n"
    with pytest.raises(InputError, match=HOSTILE_KEYS[line]):
        parse_job(text, "job", "job.toml")


def test_keys_of_a_job_that_are_taken():
    text = JOB.text + "limiting_ratio = 0.07\ninlet_length = 40\n"
    options = parse_job(text, "job", "job.toml").solver_options
    assert (options["shear"], options["limiting_ratio"], options["inlet_length"]) == ("limiting", 0.07, 40.0)


def test_places_of_velocity_profiles():
    x = np.linspace(-2.0, 2.0, 401)
    hertz = np.sqrt(np.maximum(0.0, 1.0 - x**2))
    spiked = hertz + np.exp(-(((x - 0.8) / 0.02) ** 2))
    assert places(x, spiked)["spike"] == pytest.approx(0.8, abs=0.01)
    assert places(x, hertz)["spike"] == 0.0
    assert places(x, hertz)["inlet"] == pytest.approx(-0.99, abs=0.01)
    assert places(x, np.minimum(hertz[::-1], hertz.max()))["centre"] == 0.0
    assert places(x, x + 2.0)["spike"] == 2.0


def test_a_thin_streak_takes_no_colours():
    """Columns of unlike width: a hundredth of the area may be colder by any amount; a tenth may not."""
    x = np.array([0.0, 1.0, 1.98, 2.0, 2.02, 3.0, 4.0])
    values = np.tile([60.0, 61.0, 62.0, 20.0, 60.5, 60.2, 60.1], (3, 1))
    assert colour_limits(x, values) == (60.0, 62.0)
    values[:, 1] = 20.0
    assert colour_limits(x, values)[0] == 20.0
    assert colour_limits(x, np.full((3, 7), 60.0)) == (60.0, 60.0)


def test_a_start_with_heat_has_values_between_its_columns():
    x = np.linspace(-2.0, 3.0, 11)
    cubic = x**3 - 2.0 * x
    film = FilmTable(x, cubic, *[np.ones(11)] * 4)
    warmth = Temperatures(np.array([0.0, 1.0]), np.array([300.0 + x, np.where(x < 0.1, 300.0, 350.0)]))
    start = GridSolution(Results(Status.CONVERGED, central_film=1e-7), film, None, 1.0, warmth).start
    np.testing.assert_allclose(start.x[::3], x, rtol=1e-15, atol=1e-15)
    # a cubic is itself but where it turns, and at the ends; a straight line everywhere
    inside = (start.x > 1.4) & (start.x < 2.4)
    np.testing.assert_allclose(start.pressure[inside], (start.x**3 - 2.0 * start.x)[inside], rtol=1e-13)
    np.testing.assert_allclose(start.temperatures.values[0, 3:-3], 300.0 + start.x[3:-3], rtol=1e-14)
    # a front stays between the columns at its sides
    assert set(np.round(start.temperatures.values[1], 6)) >= {300.0, 350.0}
    assert start.temperatures.values[1].min() == 300.0 and start.temperatures.values[1].max() == 350.0
