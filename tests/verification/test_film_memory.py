"""The contact law with memory against the film solver: complex stiffness over frequency, and loads over time.

Few points; more of them, and the worst ones: `python -m tests.benchmarks.film_memory`. Of the oils, FVA 3 is the one
with which the numbers of the closed formula of the locked film were fitted. The laws of maps take a factor of it from
the film compliance at natural frequencies that the map holds.
"""

from __future__ import annotations

import numpy as np
import pytest

from ehdmaps.ehl.solver import ReynoldsSolver
from ehdmaps.maps.kernels.memory_table import equilibrium_at
from ehdmaps.maps.law_films import LawAtPoint
from ehdmaps.physics.contact import OperatingPoint
from ehdmaps.physics.solution import natural_to_hertz
from ehdmaps.physics.spectrum import contact_spectrum
from tests.cases.film_memory import (
    CONTACT,
    FVA3,
    NATURAL,
    THICK,
    THIN,
    Course,
    NoSolutionError,
    Oil,
    approach_of,
    errors,
    law_at,
    relaxing,
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
    # The model's error: one pole for a film that is a transport line; the closed formula for its locked stiffness too.
    assert found.memory < bound
    assert found.formula < bound
    # The factor is the best in the mean square, not in the largest difference.
    assert found.memory < found.formula + 0.005
    assert found.stated < 0.1 * ASKED


@pytest.mark.parametrize("oil", STATES)
@pytest.mark.parametrize("part", [0.06, 0.25, 0.57, 1.07, 1.9, 5.3])
def test_law_of_a_map_takes_what_it_holds_between_its_points(oil: str, part: float) -> None:
    """The factor that the law reads from its map beside that of a response which is solved at the same point."""
    state = STATES[oil]
    at, load = law_at(state), state.load(part)
    point = OperatingPoint(load, state.speed, state.temperature)
    found = response(CONTACT, state.lubricant, point)
    table, delta = at.memory.table, approach_of(at, load)
    _, k, _, dy, _, dg = equilibrium_at(table, delta)
    wrong = complex_error(at, point, float(k / (1.0 - dy)))
    # Interpolation of films and factors: what it changes in the complex stiffness, and the cells of the table.
    assert wrong < found.memory + 0.003
    assert dg > 0.0


def complex_error(at: LawAtPoint, point: OperatingPoint, stiff: float) -> float:
    """Largest relative error of the complex stiffness of a law with a stiffness of its locked film."""
    lubricant = at.law._films.lubricant
    (film,) = ReynoldsSolver().solve_line(CONTACT, lubricant, (point.load,), point.entrainment_speed, point.temperature)
    frequencies = natural_to_hertz(tuple(NATURAL), film, CONTACT, point)
    exact = contact_spectrum(
        ReynoldsSolver().film_spectrum(CONTACT, lubricant, point, frequencies), CONTACT, point
    ).dynamic_stiffness
    _, k, c = at(approach_of(at, point.load), 0.0)
    return float(np.max(np.abs(relaxing(float(k), float(c), stiff, 2.0 * np.pi * frequencies) / exact - 1.0)))


@pytest.mark.parametrize("oil", ["fva 3", "thick"])
def test_no_course_gives_work_with_the_response_of_a_map(oil: str) -> None:
    """Through the valley, where the film compliance passes zero, with steps of up to micrometres."""
    state = STATES[oil]
    at = law_at(state)
    middle = approach_of(at, state.load(0.9))
    random = np.random.default_rng(9)
    times = np.linspace(0.0, 1.0, 61)
    orders = np.arange(1, 7)[:, None]
    least = np.inf
    for amplitude in (1e-9, 1e-8, 1e-7, 3e-7):
        phases = random.uniform(0.0, 2.0 * np.pi, (6, 40, 1))
        waves = np.sin(2.0 * np.pi * orders[:, :, None] * times + phases) - np.sin(phases)
        sizes = amplitude * random.normal(size=(6, 40, 1))
        deltas = middle * random.uniform(0.9, 1.1, (40, 1)) + np.sum(sizes * waves, axis=0)
        deltas[:, -1] = deltas[:, 0]
        films, work, size = at.memory.settled(deltas[:, 0]), np.zeros(40), np.zeros(40)
        for i in range(1, times.size):
            w, _, films = at.memory.advance(films, deltas[:, i], 1e-6)
            work += w * (deltas[:, i] - deltas[:, i - 1])
            size += w * np.abs(deltas[:, i] - deltas[:, i - 1])
        least = min(least, float(np.min(work / size)))
    # The table's cubics stand for functions that fit each other: their mismatch is some 1e-8 of the work.
    assert least > -1e-8


@pytest.mark.parametrize(
    ("oil", "part", "course"),
    [
        (oil, *pair)
        for place, oil in enumerate(STATES)
        for pair in (
            (0.12, sine(0.5, 1.0, 2)),
            (0.12, sine(0.06, 10.0)),
            (0.6, sine(0.15, 4.0, 2)),
            (0.95, up_and_down()),
            (2.2, sine(0.3, 2.0, 2)),
        )[place::2]
    ],
    ids=lambda value: value.name if isinstance(value, Course) else str(value),
)
def test_loads_over_time(oil: str, part: float, course: Course) -> None:
    """The film in time under a prescribed load; the law is fed with its approach."""
    state = STATES[oil]
    found = errors(law_at(state), resting(state, state.load(part)).followed(course))
    # The model's error. Film and law are integrated to 2e-3 of the load's variation.
    assert found.memory < ASKED
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
