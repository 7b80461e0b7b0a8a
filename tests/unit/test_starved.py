"""The starved contact between rigid surfaces: its differential equation solved again, published and measured ratios."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import brentq

from ehdmaps.physics.films import RIGID_ROLLING_CONSTANT
from ehdmaps.physics.oil_supply import (
    RIGID_FLOW,
    compliance_ratio,
    damping_ratio,
    film_ratio,
    passing,
    pressure_ratio,
    rolling_ratio,
)


def gap(x):
    return 1.0 + x * x


def integral(function, low, high):
    return quad(function, low, high, epsabs=1e-13, epsrel=1e-12, limit=200)[0]


def pressure_at_exit(flow, inlet):
    """p at the exit h = flow, with p = 0 at the meniscus; units of h0, sqrt(2 R h0) and 12 eta u sqrt(2 R/h0^3)."""
    return integral(lambda x: (gap(x) - flow) / gap(x) ** 3, inlet, math.sqrt(flow - 1.0))


def rigid(inlet):
    """m, w, c, rolling force and largest pressure of the film from a meniscus on, by quadrature."""
    flow = brentq(lambda m: pressure_at_exit(m, inlet), 1.0 + 1e-9, 1.24, xtol=1e-14)
    end = math.sqrt(flow - 1.0)
    load = -integral(lambda x: x * (gap(x) - flow) / gap(x) ** 3, inlet, end)
    moments = [integral(lambda x, n=n: x**n / gap(x) ** 3, inlet, end) for n in range(3)]
    squeeze = moments[2] - moments[1] ** 2 / moments[0]
    force = integral(lambda x: (gap(x) - flow) / gap(x) ** 2, inlet, end)
    return flow, load, squeeze, force, integral(lambda x: (gap(x) - flow) / gap(x) ** 3, inlet, -end)


FLOODED = rigid(-np.inf)


@pytest.mark.parametrize("inlet", [-0.3, -1.0, -4.0, -40.0])
def test_ratios_are_those_of_reynolds_equation(inlet):
    """A second method: quadrature over the film. 1e-8 is what its differences of nearly equal integrals leave."""
    flow, load, squeeze, force, pressure = rigid(inlet)
    # At equal w ~ load/h0 the flooded gap is that of its own load number.
    wider = FLOODED[1] / load
    r = flow / (FLOODED[0] * wider)
    s = math.sqrt(r)
    assert r == pytest.approx((1.0 - flow / gap(inlet)) ** 2, rel=1e-8)
    s = np.array([s])
    assert r * film_ratio(s)[0] == pytest.approx(1.0 / wider, rel=1e-8)
    assert damping_ratio(s) * s**-1.5 == pytest.approx(squeeze / FLOODED[2] * wider**1.5, rel=1e-7)
    assert rolling_ratio(s) == pytest.approx(force / FLOODED[3] * wider**0.5, rel=1e-7)
    assert pressure_ratio(s) * s**-1.5 == pytest.approx(pressure / FLOODED[4] * wider**1.5, rel=1e-7)


@pytest.mark.parametrize("inlet", [-0.5, -2.0, -10.0])
def test_held_compliance_is_a_difference_quotient(inlet):
    """The meniscus stays where it is while the gap changes; 1e-4: steps of 1e-4 in a quotient of second order."""

    def load(gap_):  # w in units of 24 eta u R/h, at a meniscus that is fixed in metres
        return rigid(inlet / math.sqrt(gap_))[1] / gap_

    exponent = -(math.log(load(1.0001)) - math.log(load(0.9999))) / math.log(1.0001 / 0.9999)
    flow, own = rigid(inlet)[:2]
    s = np.array([1.0 - flow / gap(inlet)])
    wider = FLOODED[1] / own
    assert compliance_ratio(s) * s**2 == pytest.approx(1.0 / (wider * exponent), rel=1e-4)


def test_limits():
    """Flooded: Martin's film and the rolling force 4.159; thin: w = 54 eta u R (m - h0)^2/m^3."""
    assert pytest.approx(FLOODED[0], rel=1e-10) == RIGID_FLOW
    assert 24.0 * FLOODED[1] == pytest.approx(4.895, rel=2e-4)
    in_load = 12.0 * math.sqrt(2.0) * FLOODED[3] / math.sqrt(24.0 * FLOODED[1])
    assert in_load == pytest.approx(RIGID_ROLLING_CONSTANT, rel=1e-6)
    ends = np.array([0.0, 1.0])
    np.testing.assert_allclose(film_ratio(ends)[0], [RIGID_FLOW, 1.0], rtol=1e-10)
    for ratio in (damping_ratio, pressure_ratio, compliance_ratio):
        assert ratio(ends)[1] == pytest.approx(1.0, rel=1e-9)
    np.testing.assert_allclose(rolling_ratio(ends), ends, atol=1e-10)
    # h0/m = 1 - s/3 + ...: with r = m w/(6 eta u R) = s^2 that is the load near the end of the layer.
    s = np.array([1e-4, 2e-4])
    np.testing.assert_allclose((1.0 - film_ratio(s)[0] / RIGID_FLOW) / s, 1.0 / 3.0, rtol=2e-4)


def test_published_and_measured_ratios():
    """Films of starved contacts at r = 0.99 to 0.4, and the response of a light one with its meniscus held.

    Wolveridge, Baglin and Archard's ratios are for Grubin's limit, of a loaded contact: the rigid ones are 0.7 % off at
    most. The others are of a numerical solution at 0.5 N/mm, to the digits given.
    """
    r = np.array([0.99, 0.95, 0.9, 0.8, 0.6, 0.4])
    np.testing.assert_allclose(r * film_ratio(np.sqrt(r))[0], [0.9904, 0.952, 0.904, 0.806, 0.611, 0.415], rtol=7e-3)
    r = np.array([0.9, 0.6, 0.2])
    s = np.sqrt(r)
    held = compliance_ratio(s) * s**2
    np.testing.assert_allclose(r * film_ratio(s)[0], [0.902, 0.614, 0.218], atol=1.5e-3)
    np.testing.assert_allclose(held, [0.82, 0.42, 0.10], atol=8e-3)
    np.testing.assert_allclose(damping_ratio(s) * s**-1.5 * held**2, [0.77, 0.32, 0.05], atol=5e-3)


def test_derivative_and_order():
    """1e-7: of a difference quotient. Film and pressures fall with s, and go on straight below it."""
    s = np.linspace(-0.1, 0.999, 300)
    quotient = (film_ratio(s + 1e-6)[0] - film_ratio(s - 1e-6)[0]) / 2e-6
    np.testing.assert_allclose(film_ratio(s)[1], quotient, atol=1e-7)
    assert film_ratio(np.array([1.0]))[1] == 0.0
    fine = np.linspace(-0.2, 1.0, 4001)
    for ratio in (lambda s: film_ratio(s)[0], damping_ratio, pressure_ratio):
        assert np.all(np.diff(ratio(fine)) < 1e-12)
    assert np.all(np.diff(rolling_ratio(fine)) >= -1e-12)


def test_passing_flow():
    """The flooded flow, or the layer, rounded where they are alike: 8 % less there, 1 % a third away."""
    np.testing.assert_allclose(passing(np.array([1e-9, 1e-3, np.inf]), 1e-6), [1.0, 1e-3, 0.0], rtol=1e-12)
    # a contact that carries next to nothing has the layer as its film, whose power would overflow
    np.testing.assert_allclose(passing(np.array([1e3, 1e9, 1e60]), 1e-6), [1e-9, 1e-15, 1e-66], rtol=1e-12)
    assert passing(1e-6, np.inf) == 1.0
    assert passing(1e-6, 1e-6) == pytest.approx(0.917, abs=1e-3)
    assert passing(0.66e-6, 1e-6) > 0.99 and passing(1.5e-6, 1e-6) > 0.99 / 1.5


@pytest.mark.parametrize("meniscus", [0.3, 1.0, 4.0, 30.0])
def test_rolling_force_of_a_loaded_contact_is_that_of_grubins_inlet(meniscus):
    """By adaptive quadrature of the inlet with its pressure; 1e-3 bounds the table and its last place."""

    def inlet(x):
        return quad(lambda t: 2.0 * t**4 / (1.0 + t**3) ** 3, 0.0, math.sqrt(x), epsabs=0.0)[0]

    def force(end):  # Int (h - m) dp, dp = dq/(1 - alpha q)
        return quad(lambda t: 2.0 * t**7 / (1.0 + t**3) ** 3 * inlet(end) / inlet(t * t), 0.0, math.sqrt(end))[0]

    far = 1e7
    ratio = (inlet(meniscus) / inlet(far)) ** 0.75
    expected = ratio ** (-1.0 / 3.0) * force(meniscus) / force(far)
    found = rolling_ratio(np.array([math.sqrt(ratio)]), 0.0)
    assert found == pytest.approx(expected, rel=1e-3)


def test_rolling_force_between_both_limits():
    """Exponent 1 is rigid, 0 loaded; between them it is between them, and it falls with the oil."""
    s = np.sqrt(np.linspace(0.01, 1.0, 50))
    rigid, loaded = rolling_ratio(s), rolling_ratio(s, 0.0)
    between = rolling_ratio(s, np.full(s.size, 0.4))
    assert np.all(loaded <= between + 1e-12) and np.all(between <= rigid + 1e-12)
    assert np.all(np.diff(between) > 0.0) and between[-1] == pytest.approx(1.0, abs=1e-9)
