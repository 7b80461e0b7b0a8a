"""Traction over the slide-to-roll ratio: closed forms of one column, limits, and the numbers of another program."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.integrate import quad

from ehdmaps import STEEL, BearingGeometry, Lubricant, OperatingPoint
from ehdmaps.ehl.solver import ReynoldsSolver
from ehdmaps.physics.rheology import (
    EYRING_STRESS,
    LIMITING_RATIO,
    FilmProfile,
    eyring_stress,
    limiting_stress,
    newtonian_stress,
    traction_coefficients,
)

CONTACT = BearingGeometry.named("NU308").contacts(STEEL, "iso16281")[0]
OIL = Lubricant.named("FVA3")
SLIPS = np.array([1e-3, 1e-2, 1e-1, 1.0])


@pytest.mark.parametrize(("viscosity", "slip", "gradient"), [(1.0, 1e5, 3e6), (1e3, 1e4, 0.0), (50.0, 2e6, 4e7)])
def test_eyring_s_column(viscosity, slip, gradient):
    """The mean stress moves the walls by just the slip: Int rate dy over the height, by quadrature."""
    law = eyring_stress(6e6)
    (mean,) = law(np.array([viscosity]), np.array([slip]), np.array([gradient]))

    def rate(part: float) -> float:
        return 6e6 / viscosity * math.sinh((mean + 2.0 * gradient * (part - 0.5)) / 6e6)

    assert quad(rate, 0.0, 1.0, epsabs=0.0)[0] == pytest.approx(slip, rel=1e-9)


def test_small_slips_are_newtonian_and_large_ones_are_bounded():
    viscosity, still = np.array([1.0, 1e4]), np.zeros(2)
    for law in (eyring_stress(6e6), limiting_stress(np.array([1e9, 1e9]), 0.05)):
        # s^2/6 and s^2/2 at s = 1e-4 and less, of the two laws
        np.testing.assert_allclose(law(viscosity, 500.0 / viscosity, still), 500.0, rtol=1e-8)
        assert np.all(law(viscosity, still, still) == 0.0)
    # the power law beyond 0.999 of the bound adds ln(y/22)/500 to it
    bounded = limiting_stress(np.array([1e9]), 0.05)(viscosity[:1], np.array([1e12]), still[:1])
    np.testing.assert_allclose(bounded, 2e6 + 5e7, rtol=0.02)
    np.testing.assert_allclose(
        limiting_stress(np.zeros(1), 0.05)(viscosity[:1], np.array([1e9]), still[:1]), 2e6, rtol=0.02
    )


def test_a_film_of_one_height_and_pressure():
    """A band of 0.2 mm at 0.5 GPa: mu is the stress times the band over the load, of the sign of the slip."""
    state = OIL.at(333.15)
    x = np.linspace(-1e-4, 1e-4, 201)
    profile = FilmProfile(x, np.full(x.size, 5e8), np.full(x.size, 1e-6))
    at = state, 1e5, 2.0
    viscosity = state.viscosity * math.exp(state.pressure_viscosity.log_ratio(5e8))
    (newton,) = traction_coefficients(profile, *at, np.array([1e-3]), newtonian_stress)
    assert newton == pytest.approx(viscosity * 1e-3 * 2.0 / 1e-6 * 2e-4 / 1e5, rel=1e-12)
    fast = np.array([30.0, -30.0])
    there, back = traction_coefficients(profile, *at, fast, limiting_stress(profile.pressure, 0.05))
    # as above, and what the power law adds to the bound
    assert there == -back == pytest.approx((2e6 + 0.05 * 5e8) * 2e-4 / 1e5, rel=0.02)


PROTOTYPE = {5e4: (0.0015, 0.0102, 0.029, 0.053), 2e5: (0.022, 0.035, 0.049, 0.064)}
"""Isothermal traction by Eyring's law at 2 m/s and 60 degC by another program, at the slips above, two digits."""


@pytest.mark.parametrize("load", [5e4, 2e5])
def test_traction_is_that_of_a_program_that_solves_the_sheared_film(load):
    """Within 6 %: two digits, and the film, which is that of pure rolling here."""
    profile = ReynoldsSolver().film_profile(CONTACT, OIL, OperatingPoint(load, 2.0, 333.15))[1]
    assert profile is not None
    found = traction_coefficients(profile, OIL.at(333.15), load, 2.0, SLIPS, eyring_stress(EYRING_STRESS))
    assert np.all(np.diff(found) > 0.0)
    np.testing.assert_allclose(found, PROTOTYPE[load], rtol=0.06)


def test_limited_traction_is_that_of_the_sheared_film():
    """Within 3 %: the film, which is that of pure rolling and Newtonian here."""
    load = 2e5
    profile = ReynoldsSolver().film_profile(CONTACT, OIL, OperatingPoint(load, 2.0, 333.15))[1]
    assert profile is not None
    law = limiting_stress(profile.pressure, LIMITING_RATIO)
    found = traction_coefficients(profile, OIL.at(333.15), load, 2.0, SLIPS[:3], law)
    for slip, mu in zip(SLIPS[:3].tolist(), found, strict=True):
        solver = ReynoldsSolver(shear="limiting", slide_to_roll=slip)
        (film,) = solver.solve_line(CONTACT, OIL, (load,), 2.0, 333.15)
        assert film.traction / load == pytest.approx(mu, rel=0.03)


def test_no_profile_without_a_film():
    film, profile = ReynoldsSolver().film_profile(CONTACT, OIL, OperatingPoint(1e4, 0.0, 333.15))
    assert profile is None and film.rolling_force == 0.0 == film.mass_flow
