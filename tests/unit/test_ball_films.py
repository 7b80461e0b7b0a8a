"""Laws of ball contacts with films: the table against what it was made from, and the bearing that has them."""

from __future__ import annotations

import math

import numpy as np
import pytest

from ehdmaps.errors import InputError
from ehdmaps.physics.solids import STEEL
from mbs.bearings.balls.ball_bearing import BallForce
from mbs.bearings.balls.ball_kernel import contact, load_approach
from mbs.bearings.balls.laws import BallLaw, dry_law, film_normal_law
from tests.cases.balls import DEEP, FREE, LOOSE, rest

LOADS = (1e-2, 2e4)


def curve(load):
    """Offset of 0.6 um at 100 N that falls with F^-0.07, damping of 110 N s/m that hardly rises."""
    offset = 0.6e-6 * (load / 100.0) ** -0.07
    return offset, -0.07 * offset, 110.0 * (load / 100.0) ** 0.03


def film_law(geometry):
    inner, outer = (film_normal_law(ellipse, curve, LOADS) for ellipse in geometry.contacts(STEEL))
    return BallLaw("films", inner, outer, LOADS)


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


@pytest.mark.parametrize("speed", [0.0, 1000.0])
def test_stiffness_with_films_is_the_difference_quotient(speed) -> None:
    """Central differences of 2 nm: round-off, and the table's steps of slope, 1e-4."""
    force = BallForce(LOOSE, film_law(LOOSE))
    pose = np.array([10e-6, 12e-6, 3e-6, 0.0, 1e-4, -1e-4])
    scale = np.array([1.0, 1.0, 1.0, 1.0, force.shape.arm, force.shape.arm])
    _, stiffness, damping = force(pose, inner_speed=speed)
    found = np.zeros((6, 6))
    for i in FREE:
        step = np.zeros(6)
        step[i] = 2e-9 / scale[i]
        ahead, back = (force(pose + way * step, inner_speed=speed)[0] for way in (1.0, -1.0))
        found[:, i] = (back - ahead) / (2.0 * step[i])
    size = np.max(np.abs(stiffness / np.outer(scale, scale)))
    assert np.max(np.abs((found - stiffness) / np.outer(scale, scale))) < 1e-4 * size
    parts = np.linalg.eigvalsh(0.5 * (damping + damping.T)[np.ix_(FREE, FREE)])
    assert parts.min() > -1e-3 * parts.max()


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
    filmed = BallForce(DEEP, BallLaw("films", inner, outer, LOADS))(pose)
    dry = BallForce(DEEP, dry_law(DEEP))(pose)
    np.testing.assert_allclose(filmed[0], dry[0], rtol=1e-3, atol=1e-3 * np.max(np.abs(dry[0])))
