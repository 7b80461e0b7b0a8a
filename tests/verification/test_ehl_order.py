"""Observed order of convergence of films and response."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.integrate import quad

from ehdmaps.ehl.reynolds import LineProblem, cell_means
from ehdmaps.physics.isotherm import PressureViscosity, density, log_viscosity
from tests.cases.ehl import solved

DENSITIES = (5.0, 10.0)
FINE = 40.0
INLET = 300.0


def _order(M: float, L: float, name: str) -> float:
    """Order from the errors of two grids against one with four times the cells of the finer; inlet the same."""
    reference = getattr(solved(M, L, density=FINE, inlet_length=INLET), name)
    coarse, fine = (abs(getattr(solved(M, L, density=d, inlet_length=INLET), name) - reference) for d in DENSITIES)
    return math.log(coarse / fine) / math.log(DENSITIES[1] / DENSITIES[0])


@pytest.mark.parametrize("name", ["film_offset", "film_compliance", "loss"])
@pytest.mark.parametrize(("M", "L"), [(0.3, 3.0), (1.0, 2.0), (5.0, 3.0)])
def test_order_of_a_smooth_contact(M: float, L: float, name: str) -> None:
    # the scheme is of fourth order; 3 leaves room for pre-asymptotic grids
    assert _order(M, L, name) > 3.0


@pytest.mark.parametrize("name", ["central_film", "film_compliance", "loss"])
@pytest.mark.parametrize(("M", "L"), [(20.0, 12.0), (40.0, 16.0)])
def test_order_of_a_loaded_contact(M: float, L: float, name: str) -> None:
    """ln eta rises by several units a cell in the inlet, along a law that bends: the order stays.

    What remains of the second order, with a straight ln eta over a cell, makes it 1.5 to 2 here.
    """
    assert _order(M, L, name) > 3.0


LAWS = [(1.0, math.inf), (0.6, 1.96e8), (-1.0, 2e9), (0.0, 3e8)]
"""z and p_c [Pa] of Barus' law, Roelands', that of FVA 3, and a power law of viscosity."""


@pytest.mark.parametrize(("exponent", "scale"), LAWS)
@pytest.mark.parametrize("start", [0.05, 0.5])
def test_flow_over_a_cell(exponent: float, scale: float, start: float) -> None:
    """Int rho/eta dP over one cell against adaptive quadrature: a relative error of the cell's fourth power."""
    isotherm = PressureViscosity(2e-8, exponent, scale).isotherm(1e9, compressible=True)
    problem = LineProblem(1.0, isotherm)

    def mobility(p: float) -> float:
        return float(density(isotherm, p)[0] / np.exp(log_viscosity(isotherm, p)[0]))

    errors = []
    for step in (0.1, 0.05):
        ends = np.array([start, start + step])
        (log_eta, slope), (rho, rho_slope) = log_viscosity(isotherm, ends), density(isotherm, ends)
        flow = step * cell_means(problem, log_eta - np.log(rho), slope - rho_slope / rho, ends)[0][0]
        errors.append(abs(flow / quad(mobility, *ends, epsrel=1e-12)[0] - 1.0))
    assert errors[0] < 5e-4  # a straight ln eta is wrong by 1 to 4 % where the law bends
    assert errors[1] < errors[0] / 10.0


@pytest.mark.parametrize(("M", "L"), [(5.0, 15.0), (20.0, 12.0)])
def test_error_with_a_spike(M: float, L: float) -> None:
    """A front narrower than a cell: the error of the film offset is not large, and no larger on the finer grid."""
    reference = solved(M, L, density=FINE, inlet_length=INLET).film_offset
    errors = [abs(solved(M, L, density=d, inlet_length=INLET).film_offset / reference - 1.0) for d in (6.5, 13.0)]
    assert errors[0] < 3e-4  # a third of the bar for the default grid
    assert errors[1] < errors[0]
