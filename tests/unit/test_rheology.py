"""The laws of shear: stress and rate are inverses, slopes are derivatives, kernels give the same numbers."""

from __future__ import annotations

import numpy as np
import pytest
from numba import njit

from ehdmaps.errors import InputError
from ehdmaps.physics.rheology import CARREAU, EYRING, LIMITING, NEWTONIAN, ShearLaw, shear_law, thinning, yielding

LAWS = (
    ShearLaw(NEWTONIAN),
    ShearLaw(EYRING, 2.0),
    ShearLaw(CARREAU, 2.0, exponent=0.4),
    ShearLaw(LIMITING, 2.0, ratio=0.05),
)
PRESSURE = 20.0


@pytest.mark.parametrize("law", LAWS)
def test_rate_and_stress_are_inverses(law):
    # round-off of the powers, up to an exponent of 500, bounds the differences
    for newton in np.geomspace(1e-8, 1e14, 60):
        share, slope = yielding(law, newton, PRESSURE)
        factor, rise = thinning(law, share * newton, PRESSURE)
        assert factor * share == pytest.approx(1.0, rel=1e-10)
        assert rise * slope == pytest.approx(1.0, rel=1e-10)
        assert slope > 0.0


@pytest.mark.parametrize("law", LAWS)
def test_slope_is_the_derivative(law):
    # central differences: second order in a step of 1e-5, and round-off over the step
    for tau in (0.3, 1.5, 2.9, 2.99, 3.05, 40.0):
        step = 1e-6 * tau
        ends = [thinning(law, tau + sign * step, PRESSURE)[0] * (tau + sign * step) for sign in (1.0, -1.0)]
        assert (ends[0] - ends[1]) / (2.0 * step) == pytest.approx(thinning(law, tau, PRESSURE)[1], rel=1e-5)


@pytest.mark.parametrize("law", LAWS)
def test_even_finite_and_newtonian_at_rest(law):
    assert thinning(law, 0.0, PRESSURE) == (1.0, 1.0)
    assert yielding(law, 0.0, PRESSURE) == (1.0, 1.0)
    assert thinning(law, -1.7, PRESSURE) == thinning(law, 1.7, PRESSURE)
    assert np.all(np.isfinite(thinning(law, 1e300, PRESSURE)))
    assert np.all(np.isfinite(yielding(law, 1e300, -PRESSURE)))


def test_limiting_stress_is_approached_from_below():
    law = LAWS[3]
    bound = 2.0 + 0.05 * PRESSURE
    stresses = [yielding(law, newton, PRESSURE)[0] * newton for newton in (1.0, 10.0, 60.0)]
    assert stresses == sorted(stresses)
    assert stresses[2] < bound
    # the power law beyond 0.999 of the bound adds ln(y/22)/500 to it
    assert yielding(law, 1e4 * bound, PRESSURE)[0] * 1e4 < 1.02


def test_units_scale():
    law = LAWS[3].scaled(1e6, 1e9)
    assert thinning(law, 1.5e-6, 2e-8) == pytest.approx(thinning(LAWS[3], 1.5, PRESSURE), rel=1e-14)


def test_compiled_kernels_give_the_same():
    for law in LAWS:
        assert njit(thinning)(law, 2.5, PRESSURE) == pytest.approx(thinning(law, 2.5, PRESSURE), rel=1e-15)
        assert njit(yielding)(law, 2.5, PRESSURE) == pytest.approx(yielding(law, 2.5, PRESSURE), rel=1e-15)


def test_laws_by_their_words():
    assert shear_law() == ShearLaw()
    assert shear_law("eyring") == ShearLaw(EYRING, 6e6)
    assert shear_law("carreau", 5e6, carreau_exponent=0.7) == ShearLaw(CARREAU, 5e6, exponent=0.7)
    assert shear_law("limiting", limiting_ratio=0.08) == ShearLaw(LIMITING, 2e6, 0.08)
    for options, problem in (
        ({"shear": "plastic"}, "shear: got 'plastic'; allowed: newtonian, eyring, carreau, limiting"),
        ({"shear_stress": 1e6}, "shear_stress: got 1000000.0 with shear newtonian, which has none; leave it out"),
        ({"shear": "eyring", "limiting_ratio": 0.1}, "limiting_ratio: got 0.1 with shear eyring, which has none"),
        ({"shear": "limiting", "limiting_ratio": 0.0}, "limiting_ratio: got 0.0; allowed: 0.001 to 1"),
        ({"shear": "carreau", "carreau_exponent": 2.0}, "carreau_exponent: got 2.0; allowed: 0.05 to 1"),
    ):
        with pytest.raises(InputError, match=problem):
            shear_law(**options)
