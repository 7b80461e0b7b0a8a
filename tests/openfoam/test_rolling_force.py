"""The stress on both walls, from the velocities of the cells: rolling force and traction."""

from __future__ import annotations

import numpy as np
import pytest

from ehdmaps import STEEL, BearingGeometry, Lubricant, OperatingPoint
from ehdmaps.ehl.solver import ReynoldsSolver
from ehdmaps.openfoam.solver import OpenFoamSolver
from ehdmaps.physics.films import rolling_force_of_inlet

pytestmark = pytest.mark.openfoam

CONTACT = BearingGeometry.named("NU308").contacts(STEEL, "iso16281")[0]
OIL = Lubricant.named("FVA3")
SPEED = 2.0


@pytest.mark.parametrize(("load", "shear"), [(1e3, "newtonian"), (2e4, "newtonian"), (2e4, "limiting")])
def test_the_walls_feel_the_rolling_force(load: float, shear: str) -> None:
    point = OperatingPoint(load, SPEED, 333.15)
    solver = OpenFoamSolver(shear=shear)
    film, grid = solver.solve_fields(CONTACT, OIL, point)
    assert grid is not None
    state = OIL.at(point.temperature)
    x, gap = grid.film.x, grid.film.film
    taken_in = film.mass_flow / (state.density * SPEED)
    before = rolling_force_of_inlet(-x[0], gap[0], taken_in, 12.0 * state.viscosity * SPEED, CONTACT.radius)
    walls = grid.results.rolling_force + before
    # 1e-3: the balance of forces of the cells, and the rule by which pressure and film are summed up
    assert walls == pytest.approx(film.rolling_force, rel=1e-3)
    # the stress of pure rolling is h/2 dp/dx at both walls; round-off of the sum
    assert abs(film.traction) < 1e-9 * film.rolling_force
    steepest = 0.5 * gap * np.abs(np.gradient(grid.film.pressure, x))
    assert film.wall_stress == pytest.approx(steepest.max(), rel=0.1)
    if shear != "newtonian":
        return
    (other,) = ReynoldsSolver().solve_line(CONTACT, OIL, (load,), SPEED, point.temperature)
    # the grids of both, which state 0.1 to 0.2 % together
    assert walls == pytest.approx(other.rolling_force, rel=1e-3)
    assert film.mass_flow == pytest.approx(other.mass_flow, rel=1e-3)
    stated = film.rolling_force_error + other.rolling_force_error
    assert abs(film.rolling_force / other.rolling_force - 1.0) < stated < 2e-3
