"""The rule without tension: its two branches, its derivatives, and the C that has it too."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from ehdmaps.physics.contact import Force
from mbs.bearings.laws import unilateral_forces
from mbs.gears.gear_kernel import TOUCH
from tests.cases.c_functions import flank_force

RATES = np.array([-1e3, -3.0, -1.001, -0.999, -0.5, 0.0, 2.0])
"""Both sides of x = -1/2, which is at the rate -1 of the state below [m/s]."""

W, DW, C, DC = 8.0, 2.0, 4.0, 0.7


def unilateral_force(w: float, dw: float, c: float, dc: float, rate: float) -> Force:
    """The rule as scalar text: load, and its derivatives by approach and rate."""
    part = c * rate
    if part >= -0.5 * w:
        return w + part, dw + dc * rate, c
    ratio = w / part
    return -0.25 * w * ratio, 0.25 * ratio * (ratio * dc * rate - 2.0 * dw), 0.25 * ratio * ratio * c


@pytest.mark.parametrize("rate", RATES)
def test_branches(rate: float) -> None:
    x = C * rate / W
    wanted = W * (1.0 + x) if x >= -0.5 else -W / (4.0 * x)
    assert unilateral_force(W, DW, C, DC, rate)[0] == pytest.approx(wanted, rel=1e-14)  # round-off


@pytest.mark.parametrize("rate", RATES)
def test_derivatives(rate: float) -> None:
    """Against central differences of states that go linearly with the approach; their error is step^2."""
    step = 1e-5

    def load(delta: float, at: float) -> float:
        return unilateral_force(W + DW * delta, DW, C + DC * delta, DC, at)[0]

    _, stiffness, damping = unilateral_force(W, DW, C, DC, rate)
    assert stiffness == pytest.approx((load(step, rate) - load(-step, rate)) / (2.0 * step), rel=1e-8, abs=1e-9)
    assert damping == pytest.approx((load(0.0, rate + step) - load(0.0, rate - step)) / (2.0 * step), rel=1e-8)


def test_branches_meet_with_their_slopes() -> None:
    """Load and both derivatives change over x = -1/2 by no more than their own slopes let them."""
    near, gap = -0.5 * W / C, 1e-9
    above, below = (np.array(unilateral_force(W, DW, C, DC, near + side * gap)) for side in (1.0, -1.0))
    assert np.max(np.abs(above - below) / np.abs(above)) < 10.0 * gap


@given(st.floats(0.0, 1e7), st.floats(0.0, 1e6), st.floats(-1e3, 1e3))
def test_no_tension_and_passive(w: float, c: float, rate: float) -> None:
    load, _, damping = unilateral_force(w, 0.0, c if w > 0.0 else 0.0, 0.0, rate)
    assert load >= 0.0
    assert damping >= 0.0


def test_the_c_library_has_the_same_rule() -> None:
    """Of bearings and of gears, and over arrays; to round-off of rearranged sums."""
    wanted = np.array([unilateral_force(W, DW, C, DC, rate) for rate in RATES])
    # A flank half in touch: s = 1/2, stiffness and damping that make it the state above.
    state = W, 4.0 * W / TOUCH, 0.5 * C, 1.5 * C / TOUCH
    got = np.array([flank_force(0.5 * TOUCH, rate, 8.0 * W / TOUCH, C) for rate in RATES])
    np.testing.assert_allclose(got, [unilateral_force(*state, rate) for rate in RATES], rtol=1e-14)
    state = tuple(np.full((1, RATES.size), number) for number in (W, DW, C, DC))
    got = np.array(unilateral_forces(*state, RATES[None]))
    assert got.shape == (3, 1, RATES.size)
    np.testing.assert_allclose(got[:, 0].T, wanted, rtol=1e-14)
