"""Cubics beside those of scipy: the same steps, so that at most the last bits differ, where products are fused."""

import numpy as np
import pytest
from scipy.interpolate import CubicHermiteSpline, CubicSpline, PchipInterpolator

from ehdmaps.cubics import Pieces, cubic_spline, hermite_cubic, monotone_cubic

RNG = np.random.default_rng(5)
LAST_BITS = {"rtol": 1e-13, "atol": 1e-13}
"""Numbers are of order one, and sums of some hundred of them; processors that fuse products round otherwise."""


def line(count, shape=()):
    return np.cumsum(RNG.uniform(0.2, 1.5, count)), RNG.normal(size=(count, *shape))


def same(ours, scipys):
    places = RNG.uniform(ours.x[0] - 1.0, ours.x[-1] + 1.0, (30, 2))
    assert isinstance(ours, Pieces)
    np.testing.assert_allclose(ours.c, scipys.c, **LAST_BITS)
    for at in (places, ours.x, 0.5):
        for order in range(5):
            np.testing.assert_allclose(ours(at, order), scipys(at, order), rtol=1e-12, atol=1e-10)


@pytest.mark.parametrize("shape", [(), (3,), (2, 3)])
@pytest.mark.parametrize("count", [2, 3, 4, 5, 60])
def test_splines_and_their_integrals(count, shape):
    x, y = line(count, shape)
    ours, scipys = cubic_spline(x, y), CubicSpline(x, y)
    same(ours, scipys)
    same(ours.antiderivative(), scipys.antiderivative())
    same(ours.derivative(), scipys.derivative())


def test_ends_that_are_given_and_complex_values():
    x, y = line(9, (4,))
    y = y + 1j * RNG.normal(size=y.shape)
    for left, right in ((1, 2), (2, 1)):
        ends = (left, y[3]), (right, y[4])
        same(cubic_spline(x, y, ends), CubicSpline(x, y, bc_type=ends))


@pytest.mark.parametrize("count", [2, 3, 40])
def test_monotone_cubics(count):
    x, y = line(count, (5,))
    y[:, 1:] = np.round(y[:, 1:])  # with flats
    same(monotone_cubic(x, y), PchipInterpolator(x, y))
    same(monotone_cubic(x, y[:, 0]), PchipInterpolator(x, y[:, 0]))
    same(hermite_cubic(x, y, np.sin(y)), CubicHermiteSpline(x, y, np.sin(y)))
