"""Simulated hammer tests: which are possible, and how long a record is."""

import numpy as np
import pytest

from ehdmaps.errors import InputError
from mbs.linearised.modes import Modes
from mbs.transient.hammer import HammerTest, suggested_duration


@pytest.mark.parametrize(
    ("values", "words"),
    [
        ({"highest": np.inf}, "highest: got inf Hz"),
        ({"duration": 1e9}, "duration: got 1000000000.0 s"),
        ({"duration": np.nan}, "duration: got nan s"),
        ({"hits": 0}, "hits: got 0"),
        ({"noise": -0.1}, "noise: got -0.1"),
        ({"seed": -1}, "seed: got -1"),
        ({"spread": 1.0}, "spread: got 1.0"),
    ],
)
def test_hammer_tests_that_are_not_possible(values, words):
    with pytest.raises(InputError) as caught:
        HammerTest(**{"highest": 1000.0, "duration": 1.0} | values)
    assert words in str(caught.value)


def test_duration_follows_the_slowest_mode():
    def of(*poles):
        return suggested_duration(
            Modes(np.array(poles), np.ones((1, len(poles))), (), np.zeros((0, len(poles)))), 1000.0
        )

    np.testing.assert_allclose(of(-5.0 + 2000.0j, -50.0 + 3000.0j), np.log(1e3) / 5.0)
    assert of(-5.0 + 2000.0j, -1e-9 + 2000.0j) == of(0.0 + 2000.0j) == 2**14 / 2560.0
    assert of(-1e5 + 0j) == 1024.0 / 2560.0
