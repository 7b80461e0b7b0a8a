"""Shear laws where they have to vanish."""

from __future__ import annotations

from typing import Any

import pytest

from ehdmaps.openfoam.results import Results
from tests.cases import openfoam_runs

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
