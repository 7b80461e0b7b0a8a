"""Nodes of line contacts stand at equal steps of their map; chords solve the equations as Newton's method does."""

from __future__ import annotations

import math

import numpy as np
import pytest

from ehdmaps.ehl.grid import Spike, lay_out, log_kernel
from ehdmaps.ehl.limits import Resolution
from ehdmaps.ehl.line import solve_groups
from ehdmaps.ehl.solver import line_problem
from tests.benchmarks.bench_ehl import CONTACT, OIL, numpy_residual


@pytest.mark.parametrize("film", [1e-5, 0.1, 100.0])
@pytest.mark.parametrize("spike", [None, Spike(-0.1, 0.003)])
def test_nodes_stand_at_equal_steps(film: float, spike: Spike | None) -> None:
    layout = lay_out(film, 200.0, spike=spike)
    grid = layout.grid(45)
    x, (centres, widths, weights) = grid.x, layout.terms
    index = (weights * np.arcsinh((x[:, None] - centres) / widths)).sum(axis=1)
    index += layout.core * (np.hypot(x - layout.inlet_edge, layout.blur) - np.hypot(x, layout.blur))
    steps = np.diff(index) / (layout.span / 45)
    np.testing.assert_allclose(steps, 1.0, atol=1e-9)  # what Halley's method leaves of a cell
    by_x = (weights / np.hypot(x[:, None] - centres, widths)).sum(axis=1)
    by_x += layout.core * ((x - layout.inlet_edge) / np.hypot(x - layout.inlet_edge, layout.blur))
    by_x -= layout.core * x / np.hypot(x, layout.blur)
    np.testing.assert_allclose(grid.step * by_x * 45 / layout.span, 1.0, atol=1e-6)  # its last step's square


def test_kernel_has_the_logarithms_of_the_distances() -> None:
    x = -np.geomspace(1e4, 1e-7, 120)
    step = np.gradient(x)
    kernel = log_kernel(x, step)
    apart = np.log(np.abs(x[:, None] - x) + np.eye(120))
    far = np.abs(np.subtract.outer(range(120), range(120))) > 1  # next to the singular node stand corrections
    scale = 1.0 + np.abs(apart)
    assert np.max(np.abs(kernel * math.pi / step - apart)[far] / scale[far]) < 1e-15  # the last digit of a logarithm


@pytest.mark.parametrize(("load", "speed", "kelvin"), [(1e3, 10.0, 300.0), (2e4, 5.0, 330.0), (3e5, 0.3, 380.0)])
def test_chords_leave_no_more_than_the_square_of_the_tolerance(load: float, speed: float, kelvin: float) -> None:
    problem, M, L = line_problem(CONTACT, OIL.at(kelvin), load, speed)
    found = solve_groups(problem, M, L, Resolution())
    for profile in (found.profile, found.rough):
        assert profile is not None
        left = np.linalg.solve(*reversed(numpy_residual(problem, profile, profile.unknowns)))
        pressure, (outflow, exit_at, height) = np.abs(left[:-3]), np.abs(left[-3:])
        flow = profile.mass_flow
        size = max(pressure.max() / profile.pressure.max(), outflow / flow, exit_at, height / flow)
        assert size < 1e-10  # 1e-12, and the round-off of the deflection in a thin film
