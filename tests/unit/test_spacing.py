"""What the spacing of a map costs its laws: the estimate against films at points that it did not use."""

from __future__ import annotations

import re
from dataclasses import dataclass, replace

import numpy as np
import pytest

from ehdmaps.ehl.solver import ReynoldsSolver
from ehdmaps.jobs import solvers
from ehdmaps.jobs.make.generate import generate, generate_in_memory, planned_tasks, summary
from ehdmaps.jobs.make.law_check import at_loads
from ehdmaps.jobs.make.report import spacing_remedy
from ehdmaps.jobs.make.sampling import draw
from ehdmaps.jobs.make.spacing import RAISING, RANDOM, bound_of_most, plan_spacing
from ehdmaps.jobs.reader import parse_job
from ehdmaps.jobs.show.describe import describe
from ehdmaps.maps.emap import EHDMap, open_map
from ehdmaps.maps.records import SPACING_ERRORS
from ehdmaps.physics.closed_form import FormulaSolver
from ehdmaps.physics.contact import OperatingPoint
from ehdmaps.physics.solution import FilmSolution, Status, contact_solution
from mbs.analyses.bearing_point import bearing_point
from mbs.bearings.bearing import Bearing
from mbs.bearings.bearing_force import BearingForce
from mbs.bearings.films import MapFilms
from tests.cases.programs import needs_film_solver

TEXT = """schema = 1
[bearing]
name = "NU308"
[lubricant]
name = "FVA3"
[grid]
load = { from = "0.5 N/mm", to = "500 N/mm", points = 6, spacing = "log" }
entrainment_speed = ["0 m/s", "0.1 m/s", "0.7 m/s", "5 m/s"]
temperature = ["30 degC", "60 degC", "90 degC"]
[solver]
name = "reynolds"
structural_law = "iso16281"
backbone = "none"
"""
JOB = parse_job(TEXT, "a", "a")
CFD = parse_job(TEXT.replace('"reynolds"', '"openfoam"\nphysics = "thermal"\nshear = "limiting"\nrows = 12'), "b", "b")


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    path = tmp_path_factory.mktemp("map") / "a.nc"
    return generate(JOB, path, workers=1), path


def test_bounds_of_a_law_hold_between_its_points(made):
    """The law itself, with its table, at 100 points that are no part of the estimate: 95 % within, 90 % of the few."""
    emap = open_map(made[1])
    rng, solver, within = np.random.default_rng(5), ReynoldsSolver(), []
    points = [draw(JOB, rng) for _ in range(100)]
    for contact in emap.contacts:
        law = emap.law(contact.name)
        for _, load, speed, temperature in (point for point in points if point.contact == contact):
            (film,) = solver.solve_line(contact, JOB.lubricant, (load,), speed, temperature)
            true = contact_solution(film, contact, OperatingPoint(load, speed, temperature))
            at = [np.array([value]) for value in (true.approach, load, speed, temperature)]
            approach, k, c = at_loads(law, *at)
            bound = emap.law_errors.bounds([contact.name], at[1], speed, temperature)
            missed = (approach - true.approach, k - true.stiffness, c - true.damping)
            allowed = (bound.film_offset, bound.stiffness * k, bound.damping * c)
            within.append([abs(error[0]) <= most[0] for error, most in zip(missed, allowed, strict=True)])
    shares = np.mean(within, axis=0)
    assert np.all(shares >= 0.9), shares


def test_the_bound_of_most_values_is_enough_in_nine_of_ten_draws():
    """By drawing: 2000 draws have it within 2 % (three standard deviations of that count)."""
    rng = np.random.default_rng(3)
    for count in (RAISING, 200):
        draws = rng.pareto(0.7, (2000, count))  # with a tail as damping valleys have it
        bounds = bound_of_most(draws.T)
        share = 1.0 - (1.0 + bounds) ** -0.7  # of all values below
        enough = np.mean(share >= 0.95)
        assert 0.88 < enough < 0.96
    assert bound_of_most(np.array([[1.0], [3.0]])) == 3.0


def test_a_closer_axis_loses_less(made):
    finer = generate_in_memory(parse_job(TEXT.replace("points = 6", "points = 24"), "a", "a"), 1).dataset
    for name in SPACING_ERRORS[1:]:  # the film itself is lost along speed and temperature
        assert np.nanmedian(finer[name]) < 0.3 * np.nanmedian(made[0].dataset[name])


def test_the_file_says_it_and_so_do_summary_and_show(made):
    generated, path = made
    data = open_map(path).dataset
    for name in SPACING_ERRORS:
        assert np.all(np.isnan(data[name].sel(entrainment_speed=0.0)))
        assert np.all(data[name].sel(entrainment_speed=[0.1, 0.7, 5.0]) > 0.0)
    assert data.attrs["spacing_points"] == RANDOM - RAISING
    for text in (summary(generated, path), describe(open_map(path), "a.nc")):
        assert "what its axes lose, by films of reynolds" in text
        assert "not exceeded at 20 random points: film offset" in text
    words = open_map(path).law_errors.words
    assert "errors of its law between its points" in words and "it was not checked" not in words


def test_another_structural_law_has_the_same_films(made):
    """Of k the error is k times that of the film compliance, which no structural law changes."""
    emap = open_map(made[1])
    other = emap.with_structure("half_space")
    for one, name in ((0, SPACING_ERRORS[0]), (1, SPACING_ERRORS[1])):
        of = [m.dataset[name] / (m.dataset["stiffness"] if one else 1.0) for m in (emap, other)]
        np.testing.assert_allclose(*of, rtol=1e-9)  # round-off
    assert np.nanmax(np.abs(other.dataset[SPACING_ERRORS[2]] / emap.dataset[SPACING_ERRORS[2]] - 1.0)) > 1e-3


def test_a_bearing_says_what_it_costs(made):
    """Against errors of all slices alike, of which the bearing's has to be the same, beside the numerical ones."""
    emap = open_map(made[1])
    bearing = Bearing.named("NU308", clearance=0.0)
    load = 5e3, 0.0
    for k, c, words in ((0.02, 0.3, r"wrong by 2(\.[0-2])? %, damping by 3[0-3] %"), (0.001, 0.002, None)):
        even = emap.dataset.copy(deep=True)
        for name, value in zip(SPACING_ERRORS, (0.0, k, c), strict=True):
            even[name].values[:] = value
        even.attrs.pop("content_sha256")
        films = MapFilms(EHDMap(even))
        point = bearing_point(BearingForce(bearing, films.emap.law("series")), films, load, 100.0, 333.15)
        told = [finding.words for finding in point.findings if "what its axes lose" in finding.words]
        assert len(told) == (words is not None)
        assert words is None or re.search(words, told[0])


@dataclass(frozen=True)
class Refusing(ReynoldsSolver):
    """Films without a film at one load."""

    def solve_line(self, contact, lubricant, loads, entrainment_speed, temperature):
        films = super().solve_line(contact, lubricant, loads, entrainment_speed, temperature)
        lost = [entrainment_speed == 0.7 and abs(load / 500e3 - 1.0) < 1e-9 for load in loads]
        return tuple(FilmSolution(Status.STAGNATED, "no") if no else f for no, f in zip(lost, films, strict=True))


def test_around_a_hole_nothing_is_stated_and_bounds_take_the_largest():
    job = parse_job(TEXT.replace("points = 6", "points = 3").replace("[solver]", "[solver]\nfill = 'none'"), "a", "a")
    emap = EHDMap(generate_in_memory(job, 1, solver=Refusing()).dataset)
    unknown = np.isnan(emap.dataset[SPACING_ERRORS[1]].values[:, :, 1:])
    assert unknown[:, -1].all() and not unknown[:, :-1].any()  # all cells of the highest load touch one of the holes
    largest = np.nanmax(emap.dataset[SPACING_ERRORS[1]])
    bound = emap.law_errors.bounds(["inner"], np.array([500e3]), 5.0, 363.15)
    assert largest < bound.stiffness[0] < largest + 1e-3  # and the numerical error that the map states


def test_where_there_is_nothing_to_estimate():
    assert plan_spacing(JOB, ReynoldsSolver()) is not None
    assert plan_spacing(JOB, FormulaSolver()) is None  # somebody's own
    assert plan_spacing(replace(JOB, solver="formula"), FormulaSolver()) is None  # which states no errors
    assert plan_spacing(replace(JOB, loads=JOB.loads[:1]), ReynoldsSolver()) is None  # a map without a law
    checked = generate_in_memory(replace(JOB, law_check=5), 1).dataset
    assert not set(SPACING_ERRORS) & set(checked.variables)  # fresh solves say it


def test_beside_cfd_films_are_those_of_reynolds_with_the_same_physics():
    from ehdmaps.openfoam.solver import OpenFoamSolver

    needs_film_solver()
    solver = OpenFoamSolver(physics="thermal", shear="limiting", rows=12)
    fast = solvers.reference(CFD, solver)
    assert isinstance(fast, ReynoldsSolver)
    assert (fast.physics, fast.shear) == ("thermal", "limiting")
    points = sum(task.points for task in planned_tasks(CFD, solver))
    assert points == CFD.points  # what `check` takes for the time of CFD
    assert "nu308_cfd" in spacing_remedy("openfoam")
