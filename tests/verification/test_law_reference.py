"""The law in C against its equations, written down once more without a rule of it: see `tests.cases.law_reference`."""

from __future__ import annotations

import numpy as np
import pytest

from ehdmaps.maps.law import ContactLaw
from tests.cases.law_reference import Reference
from tests.cases.laws import CONTACTS, OIL, SMALL_FIELD

SERIES = {outside: ContactLaw("series", CONTACTS, OIL, SMALL_FIELD, outside) for outside in ("clamp", "asymptote")}
INNER = ContactLaw("inner", CONTACTS[:1], OIL, SMALL_FIELD, "clamp")
LOADS = (3e-2, 40.0, 2e3, 6e4, 8e5, 1.5e6)


@pytest.mark.parametrize(
    ("law", "u", "T", "q"),
    [
        (INNER, 1.0, 330.0, 0.0),
        (INNER, 0.1, 300.0, 0.0),
        (SERIES["clamp"], 0.7, 335.0, 0.0),
        (SERIES["clamp"], -5.0, 320.0, 0.0),
        (SERIES["clamp"], 0.2, 320.0, 0.0),
        (SERIES["clamp"], 1.3, 320.0, 300.0),
        (SERIES["clamp"], 0.15, 320.0, 300.0),
        (SERIES["asymptote"], 6.0, 350.0, 0.0),
    ],
)
def test_loads_stiffness_and_damping_are_those_of_the_equations(law, u, T, q):
    """1e-9 bounds the roots that are found by bisection, 1e-5 and 1e-6 quotients of differences."""
    reference, at = Reference(law, u, T, q), law.at(u, T, q)
    for load in LOADS:
        approach, damping = reference.approach(load)
        w, k, c = at(approach, 0.0)
        assert w == pytest.approx(load, rel=1e-8)
        assert c == pytest.approx(damping, rel=1e-5)
        step = 1e-5 * load
        slope = (reference.approach(load + step)[0] - reference.approach(load - step)[0]) / (2.0 * step)
        assert k == pytest.approx(1.0 / slope, rel=1e-5)
        # the rule without tension: linear to half of the load, and the hyperbola beyond it
        if c > 0.0:
            assert at(approach, -0.3 * load / c)[0] == pytest.approx(0.7 * load, rel=1e-7)
            assert at(approach, -2.0 * load / c)[0] == pytest.approx(load / 8.0, rel=1e-7)
        together = law(np.array([approach]), np.array([-2.0 * load / c if c > 0.0 else 0.0]), u, T, q)[0][0]
        assert together == pytest.approx(load / 8.0 if c > 0.0 else load, rel=1e-7)
