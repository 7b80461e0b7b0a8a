"""Refinement lines of a job: their steps, and what is said where their laws miss."""

from __future__ import annotations

from pathlib import Path

from ehdmaps.jobs import solvers
from ehdmaps.jobs.reader import read_job
from ehdmaps.jobs.refinement import refinement
from ehdmaps.maps.backbone_plan import STEPS


def test_the_job_of_a_cold_thick_oil_begins_with_the_same_lines() -> None:
    """What it costs: 3900 points of lines, with the steps that every job begins with."""
    job = read_job(str(Path(__file__).parents[2] / "docs" / "vg320.toml"))
    lines = refinement(job, solvers.build(job.solver, job.solver_options))
    assert lines is not None
    assert job.line_steps == STEPS
    assert lines.points < 4200
    assert job.law_check == 500
