"""Observed order of convergence of film offset, film compliance and loss compliance."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import pytest

from ehdmaps.openfoam.parameters import Flow
from ehdmaps.openfoam.results import Results
from tests.cases import openfoam_runs

pytestmark = pytest.mark.openfoam

M, L = 5.0, 8.0
"""A film whose response has a pressure spike to resolve."""

SLIDING: dict[str, Any] = {"shear": "eyring", "shear_stress": 5e6, "slide_to_roll": 0.3}

QUANTITIES: dict[str, Callable[[Results], float]] = {
    "film_offset": lambda results: results.film_offset,
    "film_compliance": lambda results: results.film_compliance[0],
    "loss_compliance": lambda results: results.loss_compliance[0],
}


def _order(coarse: float, middle: float, fine: float) -> float:
    """Order from three grids, each twice as fine as the one before."""
    return math.log2(abs((middle - coarse) / (fine - middle)))


@pytest.mark.parametrize("quantity", QUANTITIES)
def test_a_newtonian_thin_film_needs_no_rows(quantity: str) -> None:
    few, many = (QUANTITIES[quantity](openfoam_runs.results(M, L, 100, rows)) for rows in (2, 12))
    # the parabola across the film is exact; what Newton's method leaves, in a derivative
    assert few == pytest.approx(many, rel=1e-7)


@pytest.mark.parametrize("quantity", QUANTITIES)
@pytest.mark.parametrize("changes", [{}, SLIDING], ids=["newtonian", "sliding"])
def test_error_of_six_rows(changes: dict[str, Any], quantity: str) -> None:
    """With all stresses, and where sliding thins the oil beside the walls more than elsewhere."""
    few, many = (
        QUANTITIES[quantity](openfoam_runs.results(M, L, 100, rows, "full_stress", **changes)) for rows in (6, 16)
    )
    # discretisation across the film
    assert few == pytest.approx(many, rel=5e-4 if changes else 2e-5)


@pytest.mark.parametrize("flow", ["thin_film", "full_stress"])
def test_order_of_the_film_along_it(flow: Flow) -> None:
    found = [openfoam_runs.results(M, L, columns, 6, flow).film_offset for columns in (100, 200, 400)]
    # second order; 1.7 leaves room for the place of the film's rupture among the columns, which comes and goes
    assert _order(*found) > 1.7


@pytest.mark.slow
@pytest.mark.parametrize("quantity", ["film_compliance", "loss_compliance"])
def test_error_of_the_response_along_the_film(quantity: str) -> None:
    """The response is of first order only: its columns stand, while the rupture of the film moves among them.

    A wiggle of second order in the film offset, one column long, is of first order in its derivative.
    """
    value = QUANTITIES[quantity]
    reference = value(openfoam_runs.results(M, L, 1000, 6))
    for columns in (100, 160, 200, 320, 400):
        error = value(openfoam_runs.results(M, L, columns, 6)) / reference - 1.0
        # discretisation: 3 % at 100 columns and, of first order, 0.75 % at 400, errors of the reference among them
        assert abs(error) < 0.03 * 100 / columns
