"""Asperities, the mean gap, and what a film loses to them."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.integrate import quad

from ehdmaps.errors import InputError
from ehdmaps.maps.rough_layer import (
    MeanPlanes,
    RoughLayer,
    SmoothContact,
    asperity_integral,
    asperity_pressure,
    mean_gap,
    sharing_effect,
)
from ehdmaps.physics.surface import SMOOTH, Surface
from tests.cases.laws import CONTACTS, OIL

MODULUS = 230.77e9


@pytest.mark.parametrize("order", [1.0, 1.5, 2.0, 2.5])
@pytest.mark.parametrize("x", [-20.0, -8.0, -1.0, 0.0, 1.0, 3.0, 6.0, 14.0])
def test_integral_of_asperities_is_that_of_a_quadrature(order, x):
    def height(t):
        return t**order * math.exp(-0.5 * t * t - x * t)

    end = max(-x, 0.0) + 10.0 if x < 5.0 else 60.0 / x
    peak = [max(-x, 0.0)] if x < 0.0 else None
    exact, _ = quad(height, 0.0, end, epsabs=0.0, epsrel=1e-12, limit=400, points=peak)
    exact *= math.exp(-0.5 * x * x) / math.sqrt(2.0 * math.pi)
    # 2e-9: error of the parabolic cylinder function near x = 6, as stated
    assert float(asperity_integral(order, x)) == pytest.approx(exact, rel=2e-9)


def test_mean_gap_is_the_first_integral_seen_from_below():
    x = np.array([-30.0, -8.0, -2.0, -0.1, 0.0, 2.0, 8.0])
    gap, slope = mean_gap(x)
    np.testing.assert_allclose(gap, asperity_integral(1.0, -x), rtol=1e-12)  # round-off times 1 + x^2
    step = 1e-5
    np.testing.assert_allclose((mean_gap(x + step)[0] - mean_gap(x - step)[0]) / (2 * step), slope, rtol=1e-6)
    assert mean_gap(40.0)[0] == 40.0


def test_pressure_is_the_elastic_one_of_hard_asperities():
    """Greenwood and Tripp at the mean planes, where F_5/2(0) = 2^(3/4) Gamma(7/4)/sqrt(2 pi)."""
    hard = Surface(2e-7, hardness=1e11)
    pressure, _ = asperity_pressure(hard, 0.0, MODULUS)
    elastic = 16.0 * math.sqrt(2.0) / 15.0 * math.pi * 0.05**2 * 0.1 * 0.5 * MODULUS
    elastic *= 2.0**0.75 * math.gamma(1.75) / math.sqrt(2.0 * math.pi)
    assert float(pressure) == pytest.approx(elastic, rel=2e-5)  # what the cap takes: (6.9/100)^4/4


def test_pressure_within_the_spots_stays_below_the_hardness():
    x = np.linspace(-10.0, 5.0, 61)
    surface = Surface(2e-7)
    pressure, slope = asperity_pressure(surface, x, MODULUS)
    spots = math.pi**2 * surface.asperity_product**2 * asperity_integral(2.0, x)
    assert np.all(pressure < surface.hardness * spots)
    # deep in, the spots yield; far out, they are elastic
    assert pressure[0] > 0.9 * surface.hardness * spots[0]
    step = 1e-5
    beside = [asperity_pressure(surface, x + sign * step, MODULUS)[0] for sign in (1.0, -1.0)]
    np.testing.assert_allclose((beside[0] - beside[1]) / (2.0 * step), slope, rtol=1e-6)  # of the difference quotient


def test_labels():
    assert Surface(2e-7).label == "roughness 0.2 um"
    assert SMOOTH.label == "smooth"
    assert SMOOTH.smooth and not Surface(1e-9).smooth


def test_corners_are_the_ends_of_what_is_not_stated():
    assert Surface(2e-7).corners == (Surface(2e-7, 0.03, 1e-4), Surface(2e-7))
    assert Surface(2e-7, 0.04, 1e-3, 5e9).corners == (Surface(2e-7, 0.04, 1e-3, 5e9),) * 2
    x = np.linspace(-8.0, 4.0, 13)
    pressures = [asperity_pressure(each, x, MODULUS)[0] for each in Surface(2e-7).corners]
    assert np.all(pressures[0] < pressures[1])


def test_mean_planes_say_where_no_theory_of_asperities_holds():
    assert [MeanPlanes.of(share, x).name for share, x in ((0.5, 0.1), (0.5, -0.1), (0.0, -0.1), (0.0, -2.1))] == [
        "APART", "OVERLAP", "APART", "MERGED"
    ]  # fmt: skip
    assert MeanPlanes.of(math.nan, math.nan) is MeanPlanes.APART


def test_k_and_c_of_a_rough_contact_over_the_smooth_one():
    """k by a difference quotient of the rough offset, c by the film's share, of a film that falls as w^-0.2."""
    contact, temperature, speed = CONTACTS[0], 333.15, 0.05

    def smooth(load):
        film = 5e-8 * (load / 1e4) ** -0.2
        gives = 0.2 * film / load
        return SmoothContact(load, film, gives, gives * 1e-4, np.asarray(contact.structural_compliance(load)))

    load, step = np.array([5e3, 5e4]), 1e-4
    for surface in Surface(2e-7).corners:
        layer = RoughLayer(surface, contact, OIL, speed)
        there = [
            layer.shared(
                np.cbrt(at)[:, None, None], smooth(at).film[:, None, None], np.zeros((2, 1, 1)),
                np.array([speed]), np.array([temperature]),
            )
            for at in (load * (1.0 - step), load, load * (1.0 + step))
        ]  # fmt: skip
        gives = (there[0].offset - there[2].offset)[:, 0, 0] / (2.0 * step * load)
        given = smooth(load)
        stiffness = (given.solids + given.film_compliance) / (given.solids + gives)
        found = sharing_effect(layer, given, speed, temperature)
        np.testing.assert_allclose(found[0], stiffness, rtol=1e-4)  # of the difference quotient, Newton's 1e-6 in s
        np.testing.assert_allclose(found[1], there[1].share[:, 0, 0] ** 2 * stiffness**2, rtol=1e-4)
    nearly_smooth = RoughLayer(Surface(1e-9), contact, OIL, speed)
    np.testing.assert_array_equal(sharing_effect(nearly_smooth, given, speed, temperature), 1.0)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"roughness": 1e-10}, r"surface, roughness: got 1e-10 m; allowed: 1e-09 to 1e-05 m, or 0 \(smooth\)"),
        ({"roughness": math.nan}, "surface, roughness: got nan m"),
        ({"asperity_product": 2.0}, "surface, asperity_product: got 2.0; allowed: 0.02 to 0.5"),
        ({"asperity_slope": 0.0}, r"surface, asperity_slope: got 0.0; allowed: 0.0001 to 0.1"),
        ({"hardness": 1e3}, r"surface, hardness: got 1000.0 Pa; allowed: 1e\+09 to 1e\+11 Pa"),
    ],
)
def test_surfaces_out_of_their_limits_are_refused(changes, message):
    with pytest.raises(InputError, match=message):
        Surface(**({"roughness": 2e-7} | changes))
