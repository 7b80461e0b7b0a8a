"""Rolling forces of ellipses by strips: integrals that are known, and places enough."""

from __future__ import annotations

import numpy as np
import pytest

from ehdmaps.physics.point.ball_catalogue import ball_estimate
from ehdmaps.physics.point.ellipse import Ellipse
from ehdmaps.physics.solids import STEEL
from mbs.bearings.balls import ball_report
from mbs.bearings.balls.ball_report import drilling_power, strips
from mbs.bearings.contact_report import TRACTION

ELLIPSE = ball_estimate("6208").contacts(STEEL)[0]
LOADS = np.array([1.0, 300.0, 5e3])


def test_strips_of_hertz_carry_the_load_over_the_width_of_the_ellipse():
    """Parabolas and constants are exact to round-off."""
    np.testing.assert_allclose(strips(ELLIPSE, LOADS, lambda w: w), LOADS, rtol=1e-13)
    np.testing.assert_allclose(strips(ELLIPSE, LOADS, np.ones_like), 2.0 * ELLIPSE.semi_axes(LOADS)[1], rtol=1e-13)


def test_a_force_that_ends_steeply_has_places_enough(monkeypatch):
    """The rigid film's, by sqrt(w), integrates to pi/2 of its middle: Gauss' rule bends at the ends, 1e-3."""
    half = np.asarray(ELLIPSE.semi_axes(LOADS)[1])
    exact = 0.5 * np.pi * half * np.sqrt(0.75 * LOADS / half)
    np.testing.assert_allclose(strips(ELLIPSE, LOADS, np.sqrt), exact, rtol=1e-3)
    monkeypatch.setattr(ball_report, "STRIPS", 48)
    assert strips(ELLIPSE, LOADS, np.sqrt) == pytest.approx(exact, rel=2e-5)


def test_drilling_takes_the_moment_of_hertz_pressure():
    """mu times the sum of pressure and distance over the ellipse, by Gauss' rule in radius and angle: 1e-10."""
    ellipse, load = Ellipse(4e-3, 60e-3, 230.769e9), np.array([300.0])
    a, b = (float(x[0]) for x in map(np.asarray, ellipse.semi_axes(load)))
    peak = 1.5 * load[0] / (np.pi * a * b)
    places, weights = np.polynomial.legendre.leggauss(400)
    turn = 0.25 * np.pi * (1.0 + places)  # a quarter, of which there are four
    rho = np.sin(turn)  # so that sqrt(1 - rho^2) is smooth
    radial = float(weights @ (rho**2 * np.cos(turn) ** 2)) * 0.25 * np.pi
    around = 4.0 * float(weights @ np.hypot(a * np.cos(turn), b * np.sin(turn))) * 0.25 * np.pi
    moment = TRACTION * peak * a * b * radial * around
    assert drilling_power(ellipse, load, np.array([-200.0]))[0] == pytest.approx(200.0 * moment, rel=1e-10)
