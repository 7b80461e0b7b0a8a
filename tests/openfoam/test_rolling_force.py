"""The stress on both walls, from the velocities of the cells, against the rolling force of pressure and film."""

from __future__ import annotations

import numpy as np
import pytest

from ehdmaps import STEEL, BearingGeometry, Lubricant, OperatingPoint
from ehdmaps.arrays import FloatArray, IntArray
from ehdmaps.ehl.solver import ReynoldsSolver
from ehdmaps.openfoam.fields import FilmFields
from ehdmaps.openfoam.solver import OpenFoamSolver
from ehdmaps.physics.rolling import rolling_force_of_inlet

pytestmark = pytest.mark.openfoam

CONTACT = BearingGeometry.named("NU308").contacts(STEEL, "iso16281")[0]
OIL = Lubricant.named("FVA3")
SPEED = 2.0


def _wall_force(fields: FilmFields, columns: int, rows: int) -> float:
    """Force of the film on both walls against their motion [N/m]: mu dU/dn of the two rows of cells beside them.

    Of the parabola whose means over the rows they are: that is the stress with which the cells' own balance closes.
    """
    corners = fields.points[fields.quads]
    centre = corners.mean(axis=1)
    order = np.argsort(centre[:, 0], kind="stable").reshape(columns, rows)
    order = np.take_along_axis(order, np.argsort(centre[order][:, :, 1], axis=1), axis=1)
    heights = np.sort(corners[:, :, 1], axis=1)

    def stress(first: IntArray, second: IntArray) -> FloatArray:
        thickness = heights[first, 2:].mean(axis=1) - heights[first, :2].mean(axis=1)
        slope = (3.0 * SPEED - 3.5 * fields.U[first, 0] + 0.5 * fields.U[second, 0]) / thickness
        return np.asarray(fields.mu[first] * slope)

    both = stress(order[:, 0], order[:, 1]) + stress(order[:, -1], order[:, -2])
    return float(np.sum(both * np.ptp(corners[order[:, 0]][:, :, 0], axis=1)))


@pytest.mark.parametrize("load", [1e3, 2e4])
def test_the_walls_feel_the_rolling_force(load: float) -> None:
    point = OperatingPoint(load, SPEED, 333.15)
    solver = OpenFoamSolver()
    film, grid = solver.solve_fields(CONTACT, OIL, point, with_fields=True)
    assert grid is not None and grid.fields is not None
    state = OIL.at(point.temperature)
    x, gap = grid.film.x, grid.film.film
    taken_in = film.mass_flow / (state.density * SPEED)
    before = rolling_force_of_inlet(-x[0], gap[0], taken_in, 12.0 * state.viscosity * SPEED, CONTACT.radius)
    walls = _wall_force(grid.fields, solver.columns, solver.rows) + before
    # 1e-3: the balance of forces of the cells, and the rule by which pressure and film are summed up
    assert walls == pytest.approx(film.rolling_force, rel=1e-3)
    (other,) = ReynoldsSolver().solve_line(CONTACT, OIL, (load,), SPEED, point.temperature)
    # the grids of both, which state 0.1 to 0.2 % together
    assert walls == pytest.approx(other.rolling_force, rel=1e-3)
    assert film.mass_flow == pytest.approx(other.mass_flow, rel=1e-3)
    stated = film.rolling_force_error + other.rolling_force_error
    assert abs(film.rolling_force / other.rolling_force - 1.0) < stated < 2e-3
