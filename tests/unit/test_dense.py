"""Dense linear systems: factors and solutions against numpy, pivots, scales, and matrices without a solution."""

import numpy as np
import pytest

from ehdmaps.ehl.dense import factorised, solved


@pytest.mark.parametrize("size", [1, 2, 3, 4, 5, 31, 64, 97])
def test_solutions_are_those_of_numpy(size: int) -> None:
    rng = np.random.default_rng(size)
    # rows of any size: they are scaled
    matrix = rng.normal(size=(size, size)) * 10.0 ** rng.uniform(-9, 9, (size, 1))
    right, before = matrix @ rng.normal(size=size), matrix.copy()
    found = solved(factorised(matrix), right)
    # round-off: the condition of the scaled matrices is below 1e4
    np.testing.assert_allclose(found, np.linalg.solve(matrix, right), rtol=1e-9, atol=1e-11)
    np.testing.assert_array_equal(matrix, before)


def test_rows_are_exchanged_where_a_pivot_is_zero() -> None:
    matrix = np.roll(np.diag(np.arange(1.0, 8.0)), 3, axis=0)
    np.testing.assert_array_equal(solved(factorised(matrix), matrix @ np.arange(7.0)), np.arange(7.0))


@pytest.mark.parametrize("matrix", [np.zeros((3, 3)), np.ones((5, 5)), np.full((2, 2), np.nan)])
def test_a_matrix_without_inverse_is_said_to_be_singular(matrix: np.ndarray) -> None:
    found = factorised(matrix)
    assert found.singular
    assert np.all(np.isinf(solved(found, np.ones(len(matrix)))))
