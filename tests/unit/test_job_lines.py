"""Refinement lines whose steps follow the bars of the laws: where fresh solves miss between them, and where not."""

from __future__ import annotations

import dataclasses
import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest

from ehdmaps.jobs import solvers
from ehdmaps.jobs.make import generate as story
from ehdmaps.jobs.make.generate import Generated, generate_in_memory
from ehdmaps.jobs.make.law_check import HALVED, met, unmet
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

    @property
    def wants_backbone(self) -> bool:
        return True

    def solve_line(self, contact, lubricant, loads, entrainment_speed, temperature):
        films = super().solve_line(contact, lubricant, loads, entrainment_speed, temperature)
        # equal groups need equal losses: u/R is the same for all contacts
        at = {"temperature": temperature, "entrainment_speed": math.log(entrainment_speed / contact.radius)}
        wave = 1.0 + self.height * math.sin(2.0 * math.pi * at[self.axis] / self.period)
        return tuple(dataclasses.replace(film, loss_compliance=film.loss_compliance * wave) for film in films)


def _made(axis: str = "temperature", period: float = 28.0, height: float = 0.5) -> Generated:
    text = LINE.replace('["1 N/mm", "10 N/mm", "100 N/mm"]', '["20 N/mm", "60 N/mm"]')
    for default, wanted in zip(('["0 m/s", "1 m/s"]', '["40 degC"]'), AXES[axis], strict=True):
        text = text.replace(default, wanted)
    job = parse_job(text + "law_check = 100\n", "wavy", "wavy")
    return generate_in_memory(job, workers=1, solver=WavySolver(axis=axis, period=period, height=height))


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
