"""The contact law with memory against the film solver: complex stiffness over frequency, and loads over time.

Few points; more of them, and the worst ones: `python -m tests.benchmarks.film_memory`. Of the oils, FVA 3 is the one
with which the two fitted numbers of the law were chosen.
"""

from __future__ import annotations

import pytest

from ehdmaps.physics.operating_point import OperatingPoint
from tests.cases.film_memory import (
    CONTACT,
    FVA3,
    THICK,
    THIN,
    Course,
    NoSolutionError,
    Oil,
    errors,
    law_at,
    response,
    rest_error,
    resting,
    sine,
    up_and_down,
)

STATES = {
    "fva 3": Oil("FVA 3, 40 degC", FVA3, 313.15, 1.0),
    "thin": Oil("12 1/GPa", THIN, 313.15, 1.0),
    "thick": Oil("30 1/GPa", THICK, 313.15, 0.4),
}

ASKED = 0.05
"""Error that is asked of the law."""


@pytest.mark.parametrize("oil", STATES)
@pytest.mark.parametrize(("part", "bound"), [(part, ASKED) for part in (0.02, 0.12, 0.3, 0.95, 2.2, 6.0)])
def test_complex_stiffness_to_ten_natural_frequencies(oil: str, part: float, bound: float) -> None:
    state = STATES[oil]
    point = OperatingPoint(state.load(part), state.speed, state.temperature)
    found = response(CONTACT, state.lubricant, point)
    # The model's error: one pole for a film that is a transport line, and a closed formula for its locked stiffness.
    assert found.memory < bound
    assert found.stated < 0.1 * ASKED


@pytest.mark.parametrize("oil", STATES)
@pytest.mark.parametrize(
    ("part", "course", "bound"),
    [
        (0.12, sine(0.5, 1.0, 2), ASKED),
        (0.12, sine(0.06, 10.0), ASKED),
        (0.6, sine(0.15, 4.0, 2), ASKED),
        (0.95, up_and_down(), ASKED),
        (2.2, sine(0.3, 2.0, 2), ASKED),
    ],
    ids=lambda value: value.name if isinstance(value, Course) else str(value),
)
def test_loads_over_time(oil: str, part: float, course: Course, bound: float) -> None:
    """The film in time under a prescribed load; the law is fed with its approach."""
    state = STATES[oil]
    found = errors(law_at(state), resting(state, state.load(part)).followed(course))
    # The model's error. Film and law are integrated to 2e-3 of the load's variation.
    assert found.memory < bound
    # The control: k and c of slow motion are worse, and far off but for slow courses.
    assert found.slow > (1.0 if part == 0.95 else 2.0) * found.memory


@pytest.mark.parametrize("oil", STATES)
@pytest.mark.parametrize("part", [0.12, 2.2])
def test_law_and_film_solver_agree_at_rest(oil: str, part: float) -> None:
    """Else the memory would not be what is compared over time."""
    state = STATES[oil]
    # Two grids: the map's, and the one that stands still. Found 1e-4.
    assert rest_error(law_at(state), resting(state, state.load(part))) < 5e-4


def test_large_sines_at_a_high_oil_number_are_met_less_well() -> None:
    """A film that goes from rigid to elastic and back within each period: half the load at omega T = 2, L = 28.

    It leaves 12 %, and not for the locked film: from none to twice of what this takes off, 10.8 to 11.7 % are left.
    Slow k and c leave 31 %.
    """
    state = Oil("30 1/GPa", THICK, 313.15, 1.5)
    found = errors(law_at(state), resting(state, state.load(0.6)).followed(sine(0.5, 2.0)))
    assert found.memory < 0.13  # what is found, and not what is asked
    assert found.slow > 2.0 * found.memory


def test_film_solver_ends_where_the_exit_outruns_the_surfaces() -> None:
    state = STATES["fva 3"]
    with pytest.raises(NoSolutionError, match=r"sine 15 %, omega T 10: ends at step \d+ of 288"):
        resting(state, state.load(2.2)).followed(sine(0.15, 10.0))
