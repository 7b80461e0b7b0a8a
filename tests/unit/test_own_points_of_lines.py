"""Maps by a slow solver with lines of a fast one, corrected at points of the map; a scaled `reynolds` is the CFD."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import pytest

from ehdmaps.ehl.solver import ReynoldsSolver
from ehdmaps.jobs.make.generate import Generated, generate, planned_tasks, summary
from ehdmaps.jobs.make.law_check import at_loads
from ehdmaps.jobs.reader import parse_job
from ehdmaps.jobs.show.describe import describe
from ehdmaps.maps.emap import open_map
from ehdmaps.maps.records import MODEL_ERRORS, SPACING_ERRORS
from ehdmaps.physics.contact import OperatingPoint
from ehdmaps.physics.solution import ContactSolverDefaults, FilmSolution, Status, contact_solution

TEXT = """schema = 1
[bearing]
name = "NU308"
[lubricant]
name = "FVA3"
[grid]
load = { from = "1 N/mm", to = "300 N/mm", points = 5, spacing = "log" }
entrainment_speed = ["0.5 m/s", "2 m/s"]
temperature = ["60 degC", "80 degC"]
[solver]
name = "openfoam"
structural_law = "iso16281"
line_steps = { load = 0.15, entrainment_speed = 1.5, temperature = "30 K" }
"""
JOB = parse_job(TEXT, "a", "a")
THICKER = 1.05
HOLE = max(JOB.loads), 0.5


@dataclass(frozen=True)
class Dear(ContactSolverDefaults):
    """Films of `reynolds`, 5 % thicker at all loads, by the name of the CFD; without one at the heaviest load."""

    name: str = "openfoam"
    slow: bool = True

    def settings(self):
        return {}

    def solve_line(self, contact, lubricant, loads, entrainment_speed, temperature):
        films = ReynoldsSolver().solve_line(contact, lubricant, loads, entrainment_speed, temperature)
        return tuple(
            FilmSolution(Status.STAGNATED, "no")
            if (load, entrainment_speed) == HOLE
            else replace(film, film_offset=THICKER * film.film_offset, film_compliance=THICKER * film.film_compliance)
            for load, film in zip(loads, films, strict=True)
        )


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> tuple[Generated, object]:
    path = tmp_path_factory.mktemp("map") / "a.nc"
    return generate(JOB, path, workers=1, solver=Dear()), path


def test_laws_between_the_points_are_those_of_the_dear_solver(made):
    """In the middle of the cells, where films of five loads alone are wrong by percents; the hole is no matter."""
    emap = open_map(made[1])
    assert emap.backbone is not None and np.sum(emap.dataset["status"] == int(Status.STAGNATED)) == 4
    assert not set(SPACING_ERRORS) & set(emap.dataset.variables) and set(MODEL_ERRORS) <= set(emap.dataset.variables)
    for contact in emap.contacts:
        law = emap.law(contact.name)
        for load in np.sqrt(np.array(JOB.loads[1:]) * JOB.loads[:-1]):
            (film,) = Dear().solve_line(contact, JOB.lubricant, (float(load),), 1.0, 343.15)
            true = contact_solution(film, contact, OperatingPoint(float(load), 1.0, 343.15))
            approach, k, _ = at_loads(law, *(np.array([x]) for x in (true.approach, load, 1.0, 343.15)))
            # lines with long steps, and a correction that is constant: a twentieth of what is corrected
            assert abs(approach[0] - true.approach) < 0.05 * (THICKER - 1.0) * true.film_offset
            assert k[0] == pytest.approx(true.stiffness, rel=2e-3)


def test_it_is_said(made):
    generated, path = made
    assert generated.dataset.attrs["title"].endswith("by the solver openfoam")
    for text in (summary(generated, path), describe(open_map(path), "a.nc")):
        assert "refinement lines by reynolds, corrected at points of the map by openfoam" in text
    assert "errors of its model" in open_map(path).law_errors.words


def test_points_of_the_map_are_all_that_the_dear_solver_is_asked_for():
    assert sum(task.points for task in planned_tasks(JOB, Dear())) == JOB.points


def test_without_lines_where_they_are_declined(tmp_path):
    job = parse_job(f'{TEXT}backbone = "none"\n'.replace("points = 5", "points = 2"), "a", "a")
    generated = generate(replace(job, temperatures=job.temperatures[:1]), tmp_path / "b.nc", 1, True, solver=Dear())
    assert generated.backbone is None
    assert set(SPACING_ERRORS) <= set(generated.dataset.variables)


class AskedError(Exception):
    """The tasks that a map begins with."""


@pytest.mark.parametrize(("more", "lines"), [("", True), ('physics = "thermal"', False)])
def test_films_that_know_heat_have_no_lines_between_the_points(tmp_path, monkeypatch, more, lines):
    """They would take as long as the map."""

    def ask(tasks, *_, **__):
        raise AskedError(tasks)

    monkeypatch.setattr("ehdmaps.jobs.make.generate.sweep", ask)
    job = parse_job(f"{TEXT}{more}\n", "a", "a")
    with pytest.raises(AskedError) as found:
        generate(job, tmp_path / "b.nc", workers=1, solver=Dear())
    (tasks,) = found.value.args
    assert (max(len(task.loads) for task in tasks) > 2 * len(job.loads)) == lines


def test_too_few_solutions_make_no_lines(tmp_path):
    class Lost(Dear):
        """No films but at one load."""

        def solve_line(self, contact, lubricant, loads, entrainment_speed, temperature):
            no = FilmSolution(Status.STAGNATED, "no")
            return tuple(no for _ in loads)

    one = TEXT.replace('["0.5 m/s", "2 m/s"]', '["0.5 m/s"]').replace('["60 degC", "80 degC"]', '["60 degC"]')
    generated = generate(parse_job(one, "a", "a"), tmp_path / "c.nc", 1, solver=Lost())
    assert generated.backbone is None and "correction" not in generated.dataset.attrs
