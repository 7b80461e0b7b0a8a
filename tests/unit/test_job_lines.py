"""Refinement lines whose steps follow the bars of the laws: where fresh solves miss between them, and where not."""

from __future__ import annotations

import dataclasses
import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest

import ehdmaps
from ehdmaps.errors import InputError
from ehdmaps.jobs import solvers
from ehdmaps.jobs.commands.generate import read_tolerance
from ehdmaps.jobs.job import Job
from ehdmaps.jobs.make import generate as story
from ehdmaps.jobs.make.generate import Generated, generate, generate_in_memory
from ehdmaps.jobs.make.law_check import HALVED, TOLERANCE, met, unmet
from ehdmaps.jobs.make.tasks import refinement
from ehdmaps.jobs.reader import parse_job, read_job
from ehdmaps.maps.backbone_plan import STEPS, Steps, plan_backbone
from ehdmaps.physics.closed_form import FormulaSolver
from tests.cases.jobs import LINE
from tests.cases.laws import CONTACTS, OIL

AXES = {
    "temperature": ('["1 m/s"]', '["20 degC", "100 degC"]'),
    "entrainment_speed": ('["0.2 m/s", "2 m/s"]', '["40 degC"]'),
}
"""80 K or a decade of speeds: six lines, the fewest there are."""


@dataclass(frozen=True)
class WavySolver(FormulaSolver):
    """The film formula with a loss that waves along one axis, and with lines as the solver reynolds has them."""

    axis: str = "temperature"
    period: float = 30.0
    height: float = 0.5
    stated: float = 0.0

    @property
    def wants_backbone(self) -> bool:
        return True

    def solve_line(self, contact, lubricant, loads, entrainment_speed, temperature):
        films = super().solve_line(contact, lubricant, loads, entrainment_speed, temperature)
        # equal groups need equal losses: u/R is the same for all contacts
        at = {"temperature": temperature, "entrainment_speed": math.log(entrainment_speed / contact.radius)}
        wave = 1.0 + self.height * math.sin(2.0 * math.pi * at[self.axis] / self.period)
        return tuple(
            dataclasses.replace(film, loss_compliance=film.loss_compliance * wave, film_offset_error=self.stated)
            for film in films
        )


def _job(axis: str = "temperature", law_check: int = 100) -> Job:
    text = LINE.replace('["1 N/mm", "10 N/mm", "100 N/mm"]', '["20 N/mm", "60 N/mm"]')
    for default, wanted in zip(('["0 m/s", "1 m/s"]', '["40 degC"]'), AXES[axis], strict=True):
        text = text.replace(default, wanted)
    return parse_job(text + f"law_check = {law_check}\n", "wavy", "wavy")


def _made(axis: str = "temperature", period: float = 28.0, height: float = 0.5) -> Generated:
    return generate_in_memory(_job(axis), workers=1, solver=WavySolver(axis=axis, period=period, height=height))


def test_smooth_films_leave_the_lines_as_they_are() -> None:
    generated = _made(height=0.0)
    assert met(generated.dataset.attrs)
    assert HALVED not in generated.dataset.attrs


@pytest.mark.parametrize(("axis", "period"), [("temperature", 28.0), ("entrainment_speed", 0.8)])
def test_steps_are_halved_along_the_axis_that_misses(axis: str, period: float, monkeypatch: pytest.MonkeyPatch) -> None:
    """A wave of two steps: what six lines miss of it is beyond the bar of 5 %, with half the step it is not."""
    monkeypatch.setattr(story, "MOST_HALVINGS", 0)
    before = _made(axis, period)
    assert not met(before.dataset.attrs)
    assert HALVED not in before.dataset.attrs
    monkeypatch.undo()
    after = _made(axis, period)
    assert met(after.dataset.attrs)
    assert set(after.dataset.attrs[HALVED].split(", ")) == {axis}
    assert after.backbone is not None and before.backbone is not None
    name = "reference_speed" if axis == "entrainment_speed" else axis
    assert after.backbone.sizes[name] > before.backbone.sizes[name]
    # points that were solved for lines which were given up count as solved
    assert after.sweep.solved > before.sweep.solved


def test_a_tolerance_is_the_bar(tmp_path: Path) -> None:
    """A wave whose lines keep the usual bar of 5 %: a tolerance of 1 % has them laid more closely, and says so."""
    solver = WavySolver(period=28.0, height=0.1)
    usual = generate(_job(), tmp_path / "usual.nc", workers=1, solver=solver)
    assert met(usual.dataset.attrs) and HALVED not in usual.dataset.attrs
    assert TOLERANCE not in usual.dataset.attrs and "law_film_offset_within_bar" not in usual.dataset.attrs
    within = generate(_job(), tmp_path / "within.nc", workers=1, solver=solver, tolerance=0.01)
    assert met(within.dataset.attrs) and within.dataset.attrs[HALVED].startswith("temperature")
    assert within.dataset.attrs[TOLERANCE] == 0.01
    assert within.dataset.attrs["law_film_offset_within_bar"] >= 0.99
    assert unmet(within.dataset, with_backbone=True) == []


def test_what_fresh_solves_state_to_be_wrong_counts(tmp_path: Path) -> None:
    solver = WavySolver(height=0.0, stated=0.02)
    for tolerance, kept in (0.05, True), (0.01, False):
        found = generate(_job(), tmp_path / f"{tolerance}.nc", workers=1, solver=solver, tolerance=tolerance)
        assert met(found.dataset.attrs) is kept
        missed = unmet(found.dataset, with_backbone=True)
        assert any(line.startswith("unmet: film offset of the contact laws") for line in missed) is not kept


@pytest.mark.parametrize(("law_check", "tolerance"), [(0, 0.01), (100, 0.2), (100, 1e-4), (100, math.nan)])
def test_what_is_no_tolerance(tmp_path: Path, law_check: int, tolerance: float) -> None:
    with pytest.raises(InputError, match=r"tolerance: got .* and law_check = \d+; allowed: 0\.001 to 0\.1"):
        generate(_job(law_check=law_check), tmp_path / "a.nc", workers=1, solver=WavySolver(), tolerance=tolerance)
    assert list(tmp_path.iterdir()) == []
    with pytest.raises(InputError, match="tolerance: got one without output; allowed: with an output file"):
        ehdmaps.generate(_job(), tolerance=0.01)


@pytest.mark.parametrize("text", ["0.01 %", "20 %", "one", "1 mm"])
def test_shares_that_are_none(text: str) -> None:
    with pytest.raises(InputError, match=r"--law-tolerance: got .*; allowed: a share of k, c and film .*\"0\.1 %\""):
        read_tolerance(text)


def test_there_is_an_end_to_it(monkeypatch: pytest.MonkeyPatch) -> None:
    """A wave that no lines of this size resolve: the limit of points is kept, and what is missed is said."""
    monkeypatch.setattr(story, "MOST_LINE_POINTS", 10)
    generated = _made()
    assert HALVED not in generated.dataset.attrs
    (*missed, advice) = unmet(generated.dataset, with_backbone=True)
    assert missed and all(line.startswith("unmet: damping") for line in missed)
    assert "whose steps are halved where the films between them miss" in advice


def test_half_a_step_is_half_a_step() -> None:
    axes = (2e4, 6e4), (0.2, 2.0), (273.15, 373.15)
    plans = [
        plan_backbone(CONTACTS, OIL, *axes, steps) for steps in (STEPS, *map(STEPS.finer, dataclasses.asdict(STEPS)))
    ]
    coarse, loads, speeds, temperatures = (plan for plan in plans if plan is not None)
    assert Steps().finer("temperature").temperature == 0.5 * STEPS.temperature
    assert np.max(np.diff(temperatures.temperatures)) <= 0.5 * STEPS.temperature < np.max(np.diff(coarse.temperatures))
    assert np.max(np.diff(np.log(speeds.speeds))) <= 0.5 * STEPS.entrainment_speed
    assert np.min(np.diff(loads.zeta)) == pytest.approx(0.5 * STEPS.load)


def test_the_job_of_a_cold_thick_oil_begins_with_the_same_lines() -> None:
    """What it costs: 3900 points of lines, with the steps that every job begins with."""
    job = read_job(str(Path(__file__).parents[2] / "docs" / "vg320.toml"))
    lines = refinement(job, solvers.build(job.solver, job.solver_options))
    assert lines is not None
    assert lines.steps == STEPS
    assert lines.points < 4200
    assert job.law_check == 500
