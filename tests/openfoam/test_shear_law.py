"""Shear laws where they have to vanish, and against the Reynolds equation with the same laws."""

from __future__ import annotations

from typing import Any

import pytest

from ehdmaps.ehl.solver import ReynoldsSolver
from ehdmaps.ehl.start import reynolds_start
from ehdmaps.openfoam.parameters import Flow
from ehdmaps.openfoam.results import Results
from ehdmaps.openfoam.solver import OpenFoamSolver
from ehdmaps.physics.solution import FilmSolution
from tests.cases import openfoam_runs
from tests.cases.openfoam_points import OIL, Place

pytestmark = pytest.mark.openfoam

SLIDING: dict[str, Any] = {"slide_to_roll": 0.3}


def _numbers(results: Results) -> list[float]:
    return [
        results.film_offset,
        results.minimum_film,
        results.film_compliance[0],
        results.loss_compliance[0],
    ]


@pytest.mark.parametrize("shear", ["eyring", "carreau", "limiting"])
def test_high_stress_is_newtonian(shear: str) -> None:
    newtonian = openfoam_runs.results(5.0, 5.0, 100, 8, **SLIDING)
    limited = openfoam_runs.results(5.0, 5.0, 100, 8, shear=shear, shear_stress=1e10, **SLIDING)
    # the laws leave Newton's by s^2/2 at most, s = some 1e7 Pa over the stress of the law; then what Newton's method
    # leaves after a last step of 1e-9
    assert _numbers(limited) == pytest.approx(_numbers(newtonian), rel=1e-6)


def test_sliding_alone_changes_nothing() -> None:
    """A Newtonian, isothermal thin film knows the mean speed of its surfaces only."""
    rolling = openfoam_runs.results(5.0, 5.0, 100, 8)
    assert _numbers(openfoam_runs.results(5.0, 5.0, 100, 8, **SLIDING)) == pytest.approx(_numbers(rolling), rel=1e-8)


def test_sliding_thins_the_film_of_a_shear_thinning_oil() -> None:
    newtonian = openfoam_runs.results(5.0, 5.0, 100, 8, **SLIDING)
    thinning = openfoam_runs.results(5.0, 5.0, 100, 8, shear="eyring", shear_stress=5e6, **SLIDING)
    assert thinning.central_film < newtonian.central_film


STEEP = Place("NU308", 0, 5e4, 4.0, 80.0)
"""Where a Newtonian film has a wall stress of a fifth of its pressure."""

VALLEY = Place("NU308", 0, 2.1e4, 4.125, 40.0)
"""Where a Newtonian film has its least damping, below zero."""


def _both(place: Place, flow: Flow, **law: Any) -> tuple[FilmSolution, FilmSolution]:
    """The film of a point by ehlFoam and by the Reynolds equation."""
    at = (place.contact, OIL, (place.load,), place.speed, place.celsius + 273.15)
    (film,) = OpenFoamSolver(flow=flow, columns=200, starter=reynolds_start, **law).solve_line(*at)
    (reynolds,) = ReynoldsSolver(**law).solve_line(*at)
    assert film.status.usable, film.reason
    return film, reynolds


def _damping(film: FilmSolution, place: Place) -> float:
    return film.loss_compliance / (place.contact.structural_compliance(place.load) + film.film_compliance) ** 2


@pytest.mark.parametrize("flow", ["thin_film", "full_stress"])
def test_a_sliding_film_with_a_limiting_stress(flow: Flow) -> None:
    """Another discretisation of the same equations: the grids of both."""
    film, reynolds = _both(STEEP, flow, shear="limiting", slide_to_roll=0.1)
    assert film.central_film == pytest.approx(reynolds.central_film, rel=0.001)
    assert film.minimum_film == pytest.approx(reynolds.minimum_film, rel=0.001)
    assert _damping(film, STEEP) == pytest.approx(_damping(reynolds, STEEP), rel=0.01)
    assert film.traction == pytest.approx(reynolds.traction, rel=0.01)
    # the limit at the largest pressure, and some hundredths beyond it that the power law allows
    assert 0.9 < film.wall_stress / (2e6 + 0.05 * film.max_pressure) < 1.03


def test_thinning_lifts_the_damping_of_the_valley_above_zero() -> None:
    thinned, reynolds = _both(VALLEY, "thin_film", shear="eyring")
    newtonian, _ = _both(VALLEY, "thin_film")
    assert newtonian.loss_compliance < 0.0 < thinned.loss_compliance
    # 5 % is what the compliances of both leave where they pass zero
    assert _damping(thinned, VALLEY) == pytest.approx(_damping(reynolds, VALLEY), rel=0.05)


@pytest.mark.parametrize("slide", [-2.0, 2.0])
def test_one_surface_at_rest(slide: float) -> None:
    """Traction has the sign of the sliding, and the film does not know which surface is the faster one."""
    film = openfoam_runs.results(5.0, 5.0, 100, 8, shear="limiting", slide_to_roll=slide)
    other = openfoam_runs.results(5.0, 5.0, 100, 8, shear="limiting", slide_to_roll=-slide)
    assert _numbers(film) == pytest.approx(_numbers(other), rel=1e-7)
    assert film.traction * slide > 0.0
    assert film.traction == pytest.approx(-other.traction, rel=1e-7)
