import numpy as np
import pytest

from ehdmaps.jobs.make.assemble import filled, isolated_holes

LOADS = np.geomspace(1.0, 81.0, 5)


def test_power_laws_are_filled_exactly():
    exact = (3.0 * LOADS**-0.7).reshape(1, 5, 1, 1)
    hole = np.zeros(exact.shape, bool)
    hole[0, 2] = True
    found = filled(np.where(hole, np.nan, exact), hole, 1, LOADS)
    assert found == pytest.approx(exact, rel=1e-14)  # round-off of log and exp


def test_values_that_change_sign_are_filled_linearly_in_log_load():
    values = np.array([-1.0, np.nan, 3.0, 5.0, 7.0])
    assert filled(values, np.isnan(values), 0, LOADS)[1] == pytest.approx(1.0, rel=1e-14)


def test_a_coordinate_at_zero_is_linear():
    values = np.array([2.0, np.nan, 2.0])
    assert filled(values, np.isnan(values), 0, np.array([0.0, 1.0, 3.0]))[1] == pytest.approx(2.0, rel=1e-14)


def test_only_isolated_holes_are_found_and_edges_look_along_the_speed():
    usable = np.ones((1, 5, 3, 1), bool)
    usable[0, 2, 0, 0] = False  # isolated along the load
    usable[0, 0, 1, 0] = False  # at the end of the load axis: along the speed
    usable[0, 3:5, 2, 0] = False  # a cluster at the edge of both axes
    along_load, along_speed = isolated_holes(usable)
    assert np.argwhere(along_load).tolist() == [[0, 2, 0, 0]]
    assert np.argwhere(along_speed).tolist() == [[0, 0, 1, 0]]
