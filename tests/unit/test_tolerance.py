"""A map by its tolerance: chosen, confirmed, repeated, interrupted, unmet, refused."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

import ehdmaps
from ehdmaps.ehl.solver import ReynoldsSolver
from ehdmaps.errors import InputError
from ehdmaps.jobs import tolerance
from ehdmaps.jobs.cli import main
from ehdmaps.jobs.describe import describe
from ehdmaps.jobs.generate import generate
from ehdmaps.jobs.law_points import DAMPING, OFFSET, STIFFNESS, errors_of, fresh_points, law_values, random_points
from ehdmaps.jobs.reader import parse_job, read_job
from ehdmaps.jobs.sweep import NoProgress
from ehdmaps.jobs.tolerance import read_tolerance
from ehdmaps.maps.law_errors import LawErrors
from tests.cases.jobs import LINE

ONE_SPEED = '["0 m/s", "1 m/s"]', '["1 m/s"]'
TEXT = LINE.replace('"formula"', '"reynolds"').replace(*ONE_SPEED)
JOB = parse_job(TEXT + "law_check = 50\n", "tiny", "tiny")
TOLERANCE = 0.1


@pytest.fixture(autouse=True, scope="module")
def few_points():
    """Few points in each round: the choice is what is tested here, not the sample."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(tolerance, "POINTS", 20)
        patch.setattr(tolerance, "TRIALS", 10)
        yield


class Stopping(NoProgress):
    """Ctrl-C after some points."""

    left = 30

    def solved(self, points: int) -> None:
        Stopping.left -= points
        if Stopping.left < 0:
            raise KeyboardInterrupt


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> tuple[xr.Dataset, Path]:
    """A map by its tolerance, whose making was stopped once; another solver's density gives way."""
    path = tmp_path_factory.mktemp("tolerance") / "a.nc"
    with pytest.raises(KeyboardInterrupt):
        generate(JOB, path, 1, tolerance=TOLERANCE, progress=lambda _: Stopping())
    assert not path.exists()
    again = generate(JOB, path, 1, tolerance=TOLERANCE)
    # what was told before the interrupt is in the store; a line that ends with it is too
    assert again.sweep.taken_over >= 30
    assert again.sweep.taken_over + again.sweep.solved == sum(a["status"].size for a in again.sweep.arrays.values())
    return again.dataset, path


def test_it_is_confirmed_and_holds_at_other_points(made: tuple[xr.Dataset, Path]) -> None:
    dataset, path = made
    attributes = dataset.attrs
    assert attributes["tolerance"] == TOLERANCE
    assert attributes["tolerance_met"] == 1
    assert attributes["tolerance_points"] == 20
    assert "tolerance_unmet" not in attributes
    emap = ehdmaps.open_map(path)
    points = random_points(JOB, ReynoldsSolver(density=13.0), 20, np.random.default_rng(3))
    fresh = fresh_points(points, {task.key: task.run() for task in points.tasks})
    errors = errors_of(law_values({"line": emap.law("line", "clamp")}, fresh), fresh)
    for name in (STIFFNESS, DAMPING, OFFSET):
        # the tolerance itself: 99 % of many points, one of twenty may be outside
        assert np.sort(np.abs(errors[name]))[-2] <= TOLERANCE


def test_its_own_job_repeats_it(made: tuple[xr.Dataset, Path], tmp_path: Path) -> None:
    dataset, path = made
    job = read_job(path)
    settings = dataset.attrs["tolerance_settings"]
    assert f"density {job.solver_options['density']:g}, steps of the lines {job.line_steps.load:.3g}" in settings
    assert (job.law_check, job.sha256) == (0, dataset.attrs["job_sha256"])
    assert dataset.attrs["tolerance_job_sha256"] == JOB.sha256
    again = generate(job, tmp_path / "again.nc", 1)
    first, second = ehdmaps.open_map(path), ehdmaps.open_map(tmp_path / "again.nc")
    xr.testing.assert_equal(first.dataset.drop_vars("solve_seconds"), second.dataset.drop_vars("solve_seconds"))
    assert first.backbone is not None
    assert again.backbone is not None
    xr.testing.assert_equal(first.backbone, second.backbone)
    assert "tolerance" not in again.dataset.attrs


def test_it_is_shown(made: tuple[xr.Dataset, Path]) -> None:
    text = describe(ehdmaps.open_map(made[1]), "a.nc")
    assert "tolerance of the contact laws 10 %: confirmed by fresh solves at new random points" in text
    assert re.search(r"damping error +median .*largest", text)
    assert re.search(r"points within +100.00%", text)


def test_bands_of_modes_take_its_errors(made: tuple[xr.Dataset, Path]) -> None:
    emap = ehdmaps.open_map(made[1])
    known = LawErrors(emap.dataset, emap.contacts, emap.lubricant)
    assert known.checked_points == 20
    assert "errors of its law (95 % of 20 checked points)" in known.words


@pytest.mark.slow
def test_lines_are_added_until_there_would_be_too_many(tmp_path: Path, capsys, monkeypatch) -> None:
    monkeypatch.setattr(tolerance, "USUAL", 1e-6)  # begins with lines far too coarse
    monkeypatch.setattr(tolerance, "MOST_LINE_POINTS", 30)
    (tmp_path / "tiny.toml").write_text(TEXT)
    output = tmp_path / "a.nc"
    status = main(
        ["generate", str(tmp_path / "tiny.toml"), "-o", str(output), "--workers", "1", "--tolerance", "0.5 %"]
    )
    out = capsys.readouterr().out
    assert status == 1
    assert re.search(r"unmet: the contact laws are not within 0.5 % .*: finer lines would take \d+ points", out)
    assert re.search(r"worst points: .*damping \S+ at line, ", out)
    attributes = ehdmaps.open_map(output).dataset.attrs
    assert attributes["tolerance_met"] == 0
    first, last = (re.search(r"steps of the lines (\S+) over", attributes[f"tolerance_round_{n}"])[1] for n in (1, 2))
    assert float(last) == pytest.approx(tolerance.FINER * float(first), rel=5e-3)  # three digits are told
    # each round has new points
    assert attributes["tolerance_seed"] == tolerance.SEED + attributes["tolerance_rounds"]


@pytest.mark.parametrize("text", ["1e-9 %", "-1 %", "nan", "5 mm", "50 %", "1", "inf %"])
def test_tolerances_that_are_none_are_refused(text: str, tmp_path: Path, capsys) -> None:
    with pytest.raises(InputError, match=r'--tolerance: got .*; allowed: .* from "0.1 %" to "20 %"'):
        read_tolerance(text)
    assert main(["generate", "nu308", "-o", str(tmp_path / "a.nc"), f"--tolerance={text}"]) == 2
    assert not list(tmp_path.iterdir())
    assert capsys.readouterr().out == ""


@pytest.mark.parametrize(
    ("change", "value", "message"),
    [
        (('"reynolds"', '"formula"'), 0.01, "solver 'formula' has no grid density .* allowed: the solver reynolds"),
        (('"reynolds"', '"reynolds"\nbackbone = "none"'), 0.01, 'backbone = "none", .* allowed: backbone = "law"'),
        (
            ('"reynolds"', '"reynolds"\ncorrected_by = "formula"'),
            0.01,
            r"has \[solver\] corrected_by, .*; allowed: a job",
        ),
        (('["1 m/s"]', '["0 m/s"]'), 0.01, "no speed above zero: nothing lies between its points; allowed"),
        (('"reynolds"', '"reynolds"'), 1e-11, "tolerance: got 1e-11; allowed: .* 0.01 in Python"),
        (('"reynolds"', '"reynolds"'), float("nan"), "tolerance: got nan; allowed"),
        (('"reynolds"', '"reynolds"'), True, "tolerance: got True; allowed"),
    ],
)
def test_jobs_and_values_for_which_there_is_none_are_refused(change, value, message, tmp_path: Path) -> None:
    job = parse_job(TEXT.replace(*change), "tiny", "tiny")
    with pytest.raises(InputError, match=message):
        ehdmaps.generate(job, tmp_path / "a.nc", tolerance=value)
    assert not list(tmp_path.iterdir())


def test_the_solver_that_takes_the_place_of_the_jobs_is_in_its_text() -> None:
    text = LINE.replace('"formula"', '"formula"\nfilm_formula = "moes"\nfill = "none"\nlaw_check = 9')
    job = parse_job(text, "tiny", "tiny", solver="reynolds")
    settings = tolerance.Settings(4.0, tolerance.STEPS)
    chosen = tolerance._chosen(job, ReynoldsSolver(inlet_length=500.0), settings)
    assert (chosen.solver, chosen.fill, chosen.law_check) == ("reynolds", "none", 0)
    assert chosen.solver_options == {"density": 4.0, "inlet_length": 500.0, "tolerance": 1e-6}
    assert parse_job(chosen.text, "tiny", "tiny") == chosen
    assert (chosen.loads, chosen.contacts, chosen.lubricant) == (job.loads, job.contacts, job.lubricant)


def test_a_tolerance_needs_a_file() -> None:
    with pytest.raises(InputError, match=r"tolerance: got one without output, .*; allowed: with output"):
        ehdmaps.generate(JOB, tolerance=0.01)


def test_steps_of_lines_are_read_and_written(tmp_path: Path) -> None:
    table = 'line_steps = { load = 0.1, temperature = "9 K" }\n'
    job = parse_job(TEXT + table, "tiny", "tiny")
    assert (job.line_steps.load, job.line_steps.entrainment_speed, job.line_steps.temperature) == (0.1, 0.66, 9.0)
    built = ehdmaps.Job.build(
        lubricant=job.lubricant,
        loads=job.loads,
        entrainment_speeds=job.entrainment_speeds,
        temperatures=job.temperatures,
        contact=job.contacts[0],
        line_steps=job.line_steps,
    )
    assert built.line_steps == job.line_steps
    wrong = 'line_steps = { load = 0.0, speed = 1, temperature = "0 K" }\n'
    with pytest.raises(InputError) as caught:
        parse_job(TEXT + wrong, "tiny", "tiny")
    assert [problem.split("; allowed")[0] for problem in caught.value.problems] == [
        "tiny: [solver] line_steps load: got 0.0",
        "tiny: [solver] line_steps temperature: got '0 K'",
        "tiny: [solver] line_steps speed: unknown key",
    ]
