"""Observed order of convergence of films and response."""

from __future__ import annotations

import math

import pytest

from tests.cases.ehl import solved

DENSITIES = (5.0, 10.0)
FINE = 40.0


def _order(M: float, L: float, name: str) -> float:
    """Order from the errors of two grids against one with four times the cells of the finer; inlet the same."""
    reference = getattr(solved(M, L, density=FINE), name)
    coarse, fine = (abs(getattr(solved(M, L, density=d), name) - reference) for d in DENSITIES)
    return math.log(coarse / fine) / math.log(DENSITIES[1] / DENSITIES[0])


@pytest.mark.parametrize("name", ["film_offset", "film_compliance", "loss"])
@pytest.mark.parametrize(("M", "L"), [(0.3, 3.0), (1.0, 2.0), (5.0, 3.0)])
def test_order_of_a_smooth_contact(M: float, L: float, name: str) -> None:
    # the scheme is of fourth order but for density at the faces; 3 leaves room for pre-asymptotic grids
    assert _order(M, L, name) > 3.0


@pytest.mark.parametrize(("M", "L"), [(5.0, 15.0), (20.0, 12.0)])
def test_error_with_a_spike(M: float, L: float) -> None:
    """A front narrower than a cell: the order is lost, the error is not large, and no larger on the finer grid."""
    reference = solved(M, L, density=FINE).film_offset
    errors = [abs(solved(M, L, density=d).film_offset / reference - 1.0) for d in (6.5, 13.0)]
    assert errors[0] < 3e-4  # a third of the bar for the default grid
    assert errors[1] < errors[0]
