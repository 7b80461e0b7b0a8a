"""Oils whose viscosity does not change with pressure, and the exponent 0 of the viscosity family, in every solver."""

import dataclasses
import math
import re

import numpy as np
import pytest

from ehdmaps.ehl.reynolds import LineProblem, oil
from ehdmaps.ehl.solver import ReynoldsSolver, line_problem
from ehdmaps.errors import InputError
from ehdmaps.openfoam.parameters import Mesh, Parameters
from ehdmaps.physics.bearing import BearingGeometry
from ehdmaps.physics.closed_form import FormulaSolver
from ehdmaps.physics.lubricant import Lubricant, PressureViscosity
from ehdmaps.physics.solids import STEEL

CONTACT = BearingGeometry.named("NU308").contacts(STEEL, "iso16281")[0]
DATA = {"viscosity": 0.05, "pressure_viscosity": 0.0, "density": 870.0}
BARUS = Lubricant.barus(**DATA)
OTHERS = [
    pytest.param(Lubricant.roelands(**DATA), id="roelands"),
    pytest.param(Lubricant.roelands(roelands_z=0.6, **DATA), id="roelands with z"),
    pytest.param(Lubricant.fva3(**DATA), id="fva3"),
]


@pytest.mark.parametrize("other", OTHERS)
@pytest.mark.parametrize("solver", [ReynoldsSolver(density=4.0), FormulaSolver()], ids=lambda solver: solver.name)
def test_isoviscous_oils_agree_in_the_solvers(other, solver):
    """The same equations: nothing but round-off of the last Newton step may differ."""
    line = ((2e3, 2e4), 1.0, 313.15)
    found, expected = solver.solve_line(CONTACT, other, *line), solver.solve_line(CONTACT, BARUS, *line)
    for film, same in zip(found, expected, strict=True):
        assert same.status.usable and film.status is same.status
        for field in ("film_offset", "film_compliance", "loss_compliance", "minimum_film", "max_pressure"):
            assert getattr(film, field) == pytest.approx(getattr(same, field), rel=1e-9)


def test_the_kernel_takes_the_exponent_zero():
    """The limit of the family, against the same isotherm outside the kernel, and the slope by differences."""
    law = PressureViscosity(2e-8, 0.0, 1.96e8)
    state = dataclasses.replace(BARUS.at(313.15), pressure_viscosity=law)
    problem, _, _ = line_problem(CONTACT, state, 2e4, 1.0)
    peak = problem.isotherm.alpha / 2e-8
    pressure = np.array([0.0, 0.3, 0.3 + 1e-6, 1.0])
    out = oil(problem, pressure)
    np.testing.assert_allclose(out[0], law.log_ratio(pressure * peak), rtol=1e-14, atol=1e-14)  # round-off
    assert (out[0][2] - out[0][1]) / 1e-6 == pytest.approx(out[1][1], rel=1e-5)  # truncation 1e-6, round-off 1e-10
    near = PressureViscosity(2e-8, 1e-9, 1.96e8).isotherm(peak)
    beside = oil(LineProblem(problem.wedge, near), pressure)
    np.testing.assert_allclose(out[0], beside[0], rtol=1e-6)  # z ln(1 + q P) and round-off over z


def test_openfoam_is_told_an_isoviscous_oil_and_no_exponent_zero():
    def text(state):
        return Parameters(5e-3, 2.3e11, 1e4, 1.0, 1.0, state, 500.0, Mesh(0.2), 40, 4).text()

    told = " ".join(re.sub("//.*", "", text(Lubricant.roelands(**DATA).at(313.15))).split())
    assert "type Barus; viscosity 0.05; pressureViscosity 0.0;" in told
    state = BARUS.at(313.15)
    assert math.isinf(state.pressure_viscosity.pressure_scale)
    odd = dataclasses.replace(state, pressure_viscosity=PressureViscosity(2e-8, 0.0, 1.96e8))
    with pytest.raises(InputError, match=r"ehlProperties, exponent: got 0.0; allowed: > 0 \(Roelands\), 1 \(Barus\)"):
        text(odd)
