"""Laws of ball contacts with films: the table against what it was made from, and the bearing that has them."""

from __future__ import annotations

import math

import numpy as np
import pytest

from ehdmaps.errors import InputError, SolverError
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.point.ball_catalogue import ball_estimate
from ehdmaps.physics.solids import STEEL
from ehdmaps.point import solve
from ehdmaps.table.points.file import shipped_point_table
from mbs.bearings.balls.ball_bearing import BallForce
from mbs.bearings.balls.films import ball_films
from mbs.bearings.balls.laws import BallLaw, dry_law, film_normal_law
from mbs.bearings.locating.normal_law import contact, load_approach
from tests.cases.balls import DEEP, LOOSE, rest

LOADS = (1e-2, 2e4)


def curve(load):
    """Offset of 0.6 um at 100 N that falls with F^-0.07, damping of 110 N s/m that hardly rises."""
    offset = 0.6e-6 * (load / 100.0) ** -0.07
    return offset, -0.07 * offset, 110.0 * (load / 100.0) ** 0.03


def film_law(geometry):
    inner, outer = (film_normal_law(ellipse, curve, LOADS) for ellipse in geometry.contacts(STEEL))
    return BallLaw(inner, outer, LOADS)


def test_table_is_what_it_was_made_from() -> None:
    """Between the nodes: cubics of 400 nodes, 1e-6 of the load, 1e-4 of stiffness and damping."""
    ellipse = DEEP.contacts(STEEL)[0]
    law = film_normal_law(ellipse, curve, LOADS)
    for load in np.geomspace(2.0 * LOADS[0], 0.5 * LOADS[1], 97):
        offset, slope, damping = curve(load)
        approach = ellipse.approach(load) - offset
        found = contact(law, approach)
        compliance = 2.0 / 3.0 * ellipse.approach(load) / load - slope / load
        assert found[0] == pytest.approx(load, rel=2e-6)
        assert found[1] == pytest.approx(1.0 / compliance, rel=2e-4)
        assert found[2] == pytest.approx(damping, rel=1e-4)
        assert load_approach(law, load) == pytest.approx(approach, abs=1e-11)


def test_table_rises_and_goes_on_beyond_its_ends() -> None:
    law = film_normal_law(DEEP.contacts(STEEL)[0], curve, LOADS)
    approaches = np.linspace(-20e-6, 120e-6, 4001)
    values = np.array([contact(law, approach) for approach in approaches])
    assert np.all(np.isfinite(values))
    assert np.all(np.diff(values[:, 0]) > 0.0)
    assert np.all(values[:, 1:] > 0.0)


@pytest.mark.parametrize(
    "wrong",
    [
        lambda load: (1e-6 * load, 1e-6 * load, np.full_like(load, 100.0)),
        lambda load: (1e-6 * load**-0.07, -0.07e-6 * load**-0.07, np.zeros_like(load)),
        lambda load: (np.full_like(load, math.nan), load, load),
    ],
)
def test_films_that_are_none_are_refused(wrong) -> None:
    with pytest.raises(InputError, match="ball law: got a film"):
        film_normal_law(DEEP.contacts(STEEL)[0], wrong, LOADS)


def test_films_move_a_loose_bearing() -> None:
    """Axial load: each contact comes together by the dry approach of its load less the film; to the table, 1e-6."""
    load = 500.0 * np.eye(6)[0]
    dry_pose, _, dry = rest(LOOSE, load)
    pose, found, balls = rest(LOOSE, load, law=film_law(LOOSE))
    for side, ellipse in enumerate(LOOSE.contacts(STEEL)):
        each = float(balls.load[side, 0])
        expected = ellipse.approach(each) - float(curve(each)[0])
        assert balls.approach[side, 0] == pytest.approx(expected, rel=1e-5)
    assert pose[0] < dry_pose[0]
    assert balls.mean_angle(0) < dry.mean_angle(0)
    assert found.damping[0, 0] > 0.0


def test_thin_films_are_dry_contacts() -> None:
    """Offsets a million times smaller: 1e-5 of the approach at most."""

    def thin(load):
        offset, slope, damping = curve(load)
        return 1e-6 * offset, 1e-6 * slope, damping

    inner, outer = (film_normal_law(ellipse, thin, LOADS) for ellipse in DEEP.contacts(STEEL))
    pose = np.array([5e-6, 10e-6, 2e-6, 0.0, 0.0, 0.0])
    filmed = BallForce(DEEP, BallLaw(inner, outer, LOADS))(pose)
    dry = BallForce(DEEP, dry_law(DEEP))(pose)
    np.testing.assert_allclose(filmed[0], dry[0], rtol=1e-3, atol=1e-3 * np.max(np.abs(dry[0])))


@pytest.fixture(scope="module")
def read_films():
    """Films of a 6208 with FVA 3 at 4.5 m/s and 60 degC, from the table alone."""
    return ball_films(ball_estimate("6208"), Lubricant.named("FVA3"), 4.5, 333.15, solves=False)


def test_read_films_are_those_of_solved_points(read_films) -> None:
    """Film offset, films and damping within what table and solver state, between the table's loads."""
    oil = Lubricant.named("FVA3")
    for ellipse, side in zip(ball_estimate("6208").contacts(STEEL), read_films.sides, strict=True):
        found = solve(ellipse, oil, 130.0, 4.5, 333.15)
        values, _ = side.read(np.array([130.0]))
        names = ("film_offset", "central_film", "minimum_film", "damping")
        nearest = side.errors[np.argmin(np.abs(np.log(side.loads / 130.0)))]
        for name, value, error in zip(names, values[:, 0], nearest, strict=True):
            exact = getattr(found, name)
            assert abs(value / exact - 1.0) < error + getattr(found, name).error, name
        assert side.read_loads == side.loads.size and nearest[0] < 0.05


def test_errors_at_loads_are_those_of_both_neighbours(read_films) -> None:
    side = read_films.inner
    between = float(np.sqrt(side.loads[5] * side.loads[6]))
    np.testing.assert_array_equal(side.largest_errors(np.array([between])), side.errors[5:7].max(axis=0))
    np.testing.assert_array_equal(side.largest_errors(np.array([1e9])), side.errors[-1])
    assert np.all(np.isnan(side.largest_errors(np.array([]))))


def test_read_films_are_those_of_the_table(read_films) -> None:
    """Away from both ends the table's own cubics, 1e-4; stiffness is the slope of the offset, 1e-3."""
    ellipse, side = ball_estimate("6208").contacts(STEEL)[0], read_films.inner
    loads = np.geomspace(20.0, 200.0, 40)
    films = shipped_point_table().films(ellipse, Lubricant.named("FVA3"), loads, 4.5, 333.15)
    offset, slope, damping = side.curve(loads)
    np.testing.assert_allclose(offset, films.film_offset, rtol=1e-4)
    np.testing.assert_allclose(damping, films.damping, rtol=2e-3)
    compliance = 1.0 / ellipse.stiffness(loads) - slope / loads
    np.testing.assert_allclose(1.0 / compliance, films.stiffness, rtol=1e-3)


def test_read_laws_are_passive_and_rise(read_films) -> None:
    """From separate bodies to deep approaches: load rises, damping is positive, no step where the table ends."""
    for law in (read_films.law.inner, read_films.law.outer):
        approaches = np.linspace(-20e-6, 60e-6, 2001)
        values = np.array([contact(law, approach) for approach in approaches])
        assert np.all(np.diff(values[:, 0]) > 0.0) and np.all(values[:, 1:] > 0.0)
        assert np.max(np.diff(np.log(values[:, 0]))) < 0.5


def test_what_is_not_in_the_table_is_refused_or_solved(monkeypatch) -> None:
    """L of 2 at 0.5 rpm: no film to read; with leave to solve, the solver is asked."""
    arguments = ball_estimate("6208"), Lubricant.named("FVA3"), 1e-3, 333.15
    with pytest.raises(SolverError, match=r"0 of \d+ loads .* have a film .*table of points: L outside of its nodes"):
        ball_films(*arguments, solves=False)
    asked = []
    none = solve(arguments[0].contacts(STEEL)[0], arguments[1], 0.0, 1.0, 333.15)
    monkeypatch.setattr("ehdmaps.point.solver.solve", lambda *given: asked.append(given) or none)
    with pytest.raises(SolverError, match="no load"):
        ball_films(*arguments)
    assert len(asked) > 3
