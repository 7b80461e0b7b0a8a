"""Dry elliptical contact: elliptic integrals, published tables, the pressure put into the half space."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy import integrate, special

from ehdmaps.errors import InputError
from ehdmaps.physics.point.ellipse import (
    ELLIPTICITIES,
    Ellipse,
    curvature_ratio,
    elliptic_numbers,
    ellipticity,
)

MODULUS = 230.769e9

HARRIS = (
    (0.0, 1.0, 1.0, 1.0),
    (0.1075, 1.0760, 0.9318, 0.9974),
    (0.3204, 1.2623, 0.8114, 0.9761),
    (0.4795, 1.4556, 0.7278, 0.9429),
    (0.5916, 1.6440, 0.6687, 0.9077),
    (0.6716, 1.8258, 0.6245, 0.8733),
    (0.7332, 2.011, 0.5881, 0.8394),
    (0.7948, 2.265, 0.5480, 0.7961),
    (0.83495, 2.494, 0.5186, 0.7602),
    (0.87366, 2.800, 0.4863, 0.7169),
    (0.90999, 3.233, 0.4499, 0.6636),
    (0.93657, 3.738, 0.4166, 0.6112),
    (0.95738, 4.395, 0.3830, 0.5551),
    (0.97290, 5.267, 0.3490, 0.4960),
    (0.983797, 6.448, 0.3150, 0.4352),
    (0.990902, 8.062, 0.2814, 0.3745),
    (0.995112, 10.222, 0.2497, 0.3176),
    (0.997300, 12.789, 0.2232, 0.2705),
)
"""F(rho), a*, b*, delta* of T. A. Harris, Rolling Bearing Analysis, table 6.1; a* is the longer semi-axis."""

RANGE = np.concatenate((np.geomspace(*ELLIPTICITIES, 61), 1.0 + np.array([-1e-3, -1e-8, -1e-15, 0.0, 1e-15, 1e-6])))


def test_integrals_are_those_of_scipy() -> None:
    """Round-off of K and E, of either sign of m. scipy's own 1 - m loses digits at large ellipticity."""
    numbers = elliptic_numbers(RANGE)
    np.testing.assert_allclose(numbers.integral, special.ellipkm1(RANGE**-2.0), rtol=2e-15)
    np.testing.assert_allclose(numbers.second_integral, special.ellipe(1.0 - RANGE**-2.0), rtol=1e-12)


def test_curvature_ratio_is_the_quotient_of_integrals_away_from_the_circle() -> None:
    """Cancellation in the plain quotient: some 1e-16/m^2, below 1e-12 here."""
    kappa = np.concatenate((np.geomspace(0.05, 0.9, 20), np.geomspace(1.1, 30.0, 20)))
    first, second = special.ellipkm1(kappa**-2.0), special.ellipe(1.0 - kappa**-2.0)
    np.testing.assert_allclose(curvature_ratio(kappa), (first - second) / (kappa**2 * second - first), rtol=1e-12)
    factor = (kappa**2 - 1.0) / (2.0 * (kappa**2 * second - first))
    np.testing.assert_allclose(elliptic_numbers(kappa).pressure_factor, factor, rtol=1e-12)


def test_near_the_circle_nothing_cancels() -> None:
    """D = kappa^(-3/2) to first order: the error of the series is the square of the distance."""
    for distance in (1e-3, 1e-6, 1e-12):
        found = curvature_ratio(1.0 + distance) - 1.0
        assert found == pytest.approx(-1.5 * distance, rel=2.5 * distance + 2e-16 / distance)


def test_turning_the_axes_turns_the_ellipse() -> None:
    """The same contact seen along y: D and kappa inverted, g with Rx/a; round-off."""
    np.testing.assert_allclose(curvature_ratio(1.0 / RANGE) * curvature_ratio(RANGE), 1.0, rtol=1e-13)
    one, other = Ellipse(4e-3, 30e-3, MODULUS), Ellipse(30e-3, 4e-3, MODULUS)
    assert one.coefficient == pytest.approx(other.coefficient, rel=1e-13)
    assert one.semi_axes(50.0) == pytest.approx(other.semi_axes(50.0)[::-1], rel=1e-13)
    assert one.max_pressure(50.0) == pytest.approx(other.max_pressure(50.0), rel=1e-13)


def test_ellipticity_inverts_the_curvature_ratio() -> None:
    np.testing.assert_allclose(ellipticity(curvature_ratio(RANGE[:61])), RANGE[:61], rtol=1e-13)
    assert ellipticity(1.0) == 1.0
    assert isinstance(ellipticity(0.1), float)


def test_exponent_is_the_derivative() -> None:
    """Central differences of ln D, error some step^2 of order 1."""
    step = 1e-4
    slope = np.log(curvature_ratio(RANGE * math.exp(step)) / curvature_ratio(RANGE * math.exp(-step))) / (2.0 * step)
    np.testing.assert_allclose(elliptic_numbers(RANGE).exponent, slope, rtol=1e-7)


@pytest.mark.parametrize(("difference", "long", "short", "approach"), HARRIS)
def test_table_of_harris(difference: float, long: float, short: float, approach: float) -> None:
    """Four digits of the table; where it has F(rho) to four digits only, that is the error."""
    ratio = (1.0 - difference) / (1.0 + difference)
    contact = Ellipse(1e-3, 1e-3 / ratio, MODULUS)
    total, load = (1.0 + ratio) / 1e-3, 80.0
    length = (1.5 * load / (total * 0.5 * MODULUS)) ** (1.0 / 3.0)
    a, b = contact.semi_axes(load)
    of_input = 5e-5 / (1.0 - difference) if difference < 0.8 and difference else 5e-6 / (1.0 - difference)
    assert b / length == pytest.approx(long, rel=1.5e-4 + of_input)
    assert a / length == pytest.approx(short, rel=2.5e-4 + of_input)
    assert contact.approach(load) / (length**2 * 0.5 * total) == pytest.approx(approach, rel=2.5e-4 + of_input)


@pytest.mark.parametrize("kappa", [0.2, 1.0, 3.0, 9.0, 30.0])
def test_pressure_bends_the_half_space_as_the_bodies_ask_for(kappa: float) -> None:
    """Deflection of the half space by quadrature = approach - x^2/2Rx - y^2/2Ry inside; error of the quadrature 1e-9.

    In polar coordinates about the place, rays see p along their length in closed form: an independent way to the
    integrals.
    """
    ratio = curvature_ratio(kappa)
    radius = 5e-3
    contact, load = Ellipse(radius, radius / ratio, MODULUS), 100.0
    a, b = contact.semi_axes(load)
    peak = contact.max_pressure(load)
    for x, y in ((0.0, 0.0), (0.5, 0.0), (0.0, 0.5), (0.4, -0.6)):

        def along(angle: float, x: float = x, y: float = y) -> float:
            # p = peak sqrt(C - 2 B s - A s^2) on the ray; both of its halves together
            cos, sin = math.cos(angle) / a, math.sin(angle) / b
            square, mixed, rest = cos * cos + sin * sin, x * cos + y * sin, 1.0 - x * x - y * y
            return 0.5 * math.pi * (rest + mixed * mixed / square) / math.sqrt(square)

        deflection = integrate.quad(along, 0.0, math.pi, epsrel=1e-11, limit=400)[0] * peak
        deflection /= math.pi * 0.5 * MODULUS
        bodies = contact.approach(load) - (x * a) ** 2 / (2.0 * radius) - (y * b) ** 2 * ratio / (2.0 * radius)
        assert deflection == pytest.approx(bodies, rel=1e-9)
    assert peak == pytest.approx(1.5 * load / (math.pi * a * b), rel=1e-14)


def test_long_ellipse_is_a_line() -> None:
    """Half-width and pressure of Hertz's line with the load per length of the middle, p_H; error some D."""
    contact = Ellipse(5e-3, 5e-3 / curvature_ratio(300.0), MODULUS)
    a, _ = contact.semi_axes(100.0)
    peak = contact.max_pressure(100.0)
    assert peak * 5e-3 / (0.5 * MODULUS * a) == pytest.approx(0.5, rel=5e-5)


def test_load_and_approach_are_each_others_inverse() -> None:
    contact = Ellipse(4e-3, 60e-3, MODULUS)
    loads = np.array([0.0, 1e-9, 1.0, 1e4])
    np.testing.assert_allclose(contact.load(contact.approach(loads)), loads, rtol=1e-14)
    np.testing.assert_array_equal(contact.load(np.array([-1e-6, 0.0])), 0.0)
    step = 1e-5
    slope = (contact.load(1e-6 * (1.0 + step)) - contact.load(1e-6 * (1.0 - step))) / (2e-6 * step)
    assert contact.stiffness(contact.load(1e-6)) == pytest.approx(slope, rel=1e-9)
    assert contact.stiffness(0.0) == 0.0
    assert isinstance(contact.approach(5.0), float)


@pytest.mark.parametrize("ratio", [math.nan, 0.0, -0.1, 1e-9, math.inf])
def test_ratios_that_are_none_are_refused(ratio: float) -> None:
    with pytest.raises(InputError, match="curvature ratio Rx/Ry: got"):
        ellipticity(np.array([0.5, ratio]))


def test_values_that_are_none_are_refused_together() -> None:
    with pytest.raises(InputError, match="rolling_radius: got nan") as error:
        Ellipse(math.nan, -1.0, MODULUS)
    assert len(error.value.problems) == 2
