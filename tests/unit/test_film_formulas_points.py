"""Films of elliptical contacts by formula: against the table of their authors, and their exponents."""

from __future__ import annotations

import numpy as np
import pytest

from ehdmaps.physics.point.film_formulas import hamrock_dowson_central, hamrock_dowson_minimum

SOLUTIONS = {1.0: 3.367, 1.25: 4.105, 1.5: 4.565, 2.0: 5.255, 3.0: 6.091, 4.0: 6.636, 6.0: 6.969, 8.0: 7.048}
"""Computed h_min/Rx 1e6 by k at U = 0.1683e-11, W = 0.1106e-6, G = 4522 (Hamrock and Dowson 1977, table 2)."""


@pytest.mark.parametrize("ellipticity", SOLUTIONS)
def test_minimum_films_of_the_authors(ellipticity) -> None:
    """Their fit is within 5 % of their own solutions."""
    found = 1e6 * hamrock_dowson_minimum(0.1683e-11, 0.1106e-6, 4522.0, ellipticity)
    assert found == pytest.approx(SOLUTIONS[ellipticity], rel=0.05)


def test_exponents() -> None:
    loads = np.array([1e-7, 1e-6])
    for formula, speed, load, material in (
        (hamrock_dowson_minimum, 0.68, -0.073, 0.49),
        (hamrock_dowson_central, 0.67, -0.067, 0.53),
    ):
        base = formula(1e-11, loads, 4500.0, 6.0)
        np.testing.assert_allclose(base[1] / base[0], 10.0**load, rtol=1e-12)
        np.testing.assert_allclose(formula(2e-11, loads, 4500.0, 6.0) / base, 2.0**speed, rtol=1e-12)
        np.testing.assert_allclose(formula(1e-11, loads, 9000.0, 6.0) / base, 2.0**material, rtol=1e-12)
        assert np.all(formula(1e-11, loads, 4500.0, 1.0) < base)


def test_central_film_is_thicker() -> None:
    for ellipticity in (1.0, 3.0, 9.0):
        arguments = (1e-11, 1e-6, 4500.0, ellipticity)
        assert hamrock_dowson_central(*arguments) > hamrock_dowson_minimum(*arguments)
