"""Films of balls over frequency: the bearing against contacts in series, the table, and complex stiffness by hand."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest

from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.point.ball_catalogue import ball_estimate
from ehdmaps.physics.point.ball_geometry import HYPOTHESES
from ehdmaps.table.points.file import shipped_point_table
from ehdmaps.table.points.response import read_response
from mbs.bearings.balls.ball_bearing import BallForce
from mbs.bearings.balls.balls_in_balance import ball_relaxation, balls_in_balance
from mbs.bearings.balls.films import ball_films
from mbs.bearings.locating.normal_law import contact
from mbs.linearised.linear import frequency_response
from mbs.model.elements import Operation
from mbs.model.equilibrium import equilibrium
from mbs.scene.assembly import assemble
from mbs.scene.reader import read_scene
from tests.cases.balls import FREE, rolls

OIL, KELVIN = Lubricant.named("FVA3"), 333.15
FREQUENCIES = np.array([1e-3, 30.0, 1e3, 5e3, 2e4])


def bearing(name, rpm, pose, turns=True):
    """Force, K and C (6, 6), balls, speed, and what relaxes, with the films of a speed."""
    geometry, speed = ball_estimate(name).with_clearance(0.0), rpm * math.pi / 30.0
    films = ball_films(geometry, OIL, geometry.entrainment_speed(speed, 0.0), KELVIN, solves=False)
    force, conditions = BallForce(geometry, films.law), {"inner_speed": speed if turns else 0.0}
    _, K, C = force(pose, **conditions)
    balls = force.loads(pose, **conditions)
    relaxation = ball_relaxation(force, balls, conditions)
    return force, K, C, balls, conditions["inner_speed"], relaxation


def speed_forces(force, ai, ao, speed):
    """Centrifugal load and traction of a ball (2,), by the velocities of its surfaces in space."""
    geometry, mass = force.geometry, force.geometry.ball_mass(force.material)
    half, spot = 0.5 * geometry.ball_diameter, np.array([0.0, 0.5 * geometry.pitch_diameter, 0.0])
    touches = [-half * np.array([math.sin(ai), math.cos(ai), 0.0]), half * np.array([math.sin(ao), math.cos(ao), 0.0])]
    around, spin, _ = rolls(spot, touches, (speed, 0.0))
    traction = 0.4 * mass * half * around * spin[1]
    return np.array([-traction * math.cos(ao), mass * spot[1] * around**2 + traction * math.sin(ao)])


def by_hand(force, balls, speed, s):
    """Z(s) (6, 6) of all balls at one frequency: complex stiffness of both contacts, the ball's place eliminated."""
    rows, shape, law, found = force.last_rows, force.shape, force.law, np.zeros((6, 6), dtype=np.complex128)
    springs = [response.springs(rows[:, 10 + side]) for side, response in enumerate(law.responses)]
    for j, (row, angle) in enumerate(zip(rows, balls.angle, strict=True)):
        parts = []
        for side, arm in enumerate((shape.inner_arm, shape.outer_arm)):
            e = np.array([math.sin(row[12 + side]), math.cos(row[12 + side])])
            _, k, c = contact(law.inner if side == 0 else law.outer, row[14 + side])
            z = k + np.sum(s * c * springs[side].shares[j] / (1.0 + s * springs[side].times[j]))
            turns = row[10 + side] / (arm + row[14 + side])
            parts.append((z - turns) * np.outer(e, e) + turns * np.eye(2))
        step, (ai, ao) = 1e-5, row[12:14]
        by_angle = [
            (speed_forces(force, ai + a, ao + o, speed) - speed_forces(force, ai - a, ao - o, speed)) / (2.0 * step)
            for a, o in ((step, 0.0), (0.0, step))
        ]
        inner, outer = (
            np.outer(by, [math.cos(angle), -math.sin(angle)]) / (arm + approach)
            for by, angle, arm, approach in zip(
                by_angle, (ai, ao), (shape.inner_arm, shape.outer_arm), row[14:16], strict=True
            )
        )
        own = parts[0] - parts[0] @ np.linalg.solve(sum(parts) + inner - outer, parts[0] + inner)
        lever = shape.arm
        seen = np.array(
            [
                [1.0, 0.0, 0.0, 0.0, lever * math.sin(angle), -lever * math.cos(angle)],
                [0.0, math.cos(angle), math.sin(angle), 0.0, 0.0, 0.0],
            ]
        )
        found += seen.T @ own @ seen
    return found


@pytest.mark.parametrize(
    ("name", "rpm", "pose"),
    [("6208", 3000, [20e-6, 10e-6, 0, 0, 0, 1e-4]), ("7208B", 15000, [5e-6, 2e-6, 0, 0, 0, 0])],
)
def test_springs_are_the_balls_in_balance_and_take_up_energy(name, rpm, pose):
    """At 15000 rpm the traction that turns the balls is up to a tenth of their loads; the unsymmetric part of what
    speed does is not relaxed: that is less than 1e-3 of Z across its diagonal, and gives less than 1e-3 of what dampers
    take."""
    force, K, C, balls, speed, relaxation = bearing(name, rpm, pose)
    s = 2j * np.pi * FREQUENCIES
    Z = K + s[:, None, None] * C + relaxation.more(s)
    for one, at in zip(Z, s, strict=True):
        hand = by_hand(force, balls, speed, at)
        size = np.sqrt(np.abs(np.diag(hand)))[FREE]
        scale = np.outer(size, size)
        error = (one - hand)[np.ix_(FREE, FREE)] / scale
        np.testing.assert_allclose(0.5 * (error + error.T), 0.0, atol=1e-4)
        np.testing.assert_allclose(error, 0.0, atol=1e-3 if rpm > 1e4 else 1e-4)
        lost = ((one - one.conj().T) / 2j).real[np.ix_(FREE, FREE)] / scale
        assert np.linalg.eigvalsh(lost).min() > (-1e-3 * np.linalg.eigvalsh(lost).max() if rpm > 1e4 else 0.0)
    # slow motion is exact: the difference is of second order
    slow = 2.0 * np.pi * FREQUENCIES[0]
    assert np.abs(relaxation.more(s[:1])[0]).max() < slow**2 * relaxation.times.max() * np.abs(C).max()
    # films of slow motion would have much more damping at 20 kHz
    assert Z[4, 1, 1].imag < 0.7 * (s[4] * C[1, 1]).imag
    assert np.abs(balls.traction).max() < 0.1 * balls.load[1].max()


@pytest.mark.parametrize("hypothesis", HYPOTHESES)
def test_slow_motion_of_balls_in_balance_is_that_of_their_force(hypothesis):
    """K and C of the balls condensed in Python, by closed formulas, and by the force in C, whichever axis they turn
    about and whichever raceway holds them: round-off."""
    geometry = dataclasses.replace(ball_estimate("7208B").with_clearance(0.0), hypothesis=hypothesis)
    speed, pose = 12e3 * math.pi / 30.0, [15e-6, 4e-6, -2e-6, 0.0, 1e-4, 0.0]
    films = ball_films(geometry, OIL, geometry.entrainment_speed(speed, 0.0), KELVIN, solves=False)
    force, conditions = BallForce(geometry, films.law), {"inner_speed": speed}
    _, K, C = force(pose, **conditions)
    condensed = balls_in_balance(force, force.loads(pose, **conditions), conditions, relaxes=True)
    np.testing.assert_allclose(condensed.stiffness, K, atol=1e-12 * np.abs(K).max())
    np.testing.assert_allclose(condensed.damping, C, atol=1e-12 * np.abs(C).max())


def test_balls_in_line_are_two_contacts_in_series():
    """Under axial displacement at rest: 1/Z of the contacts adds, as the table has it. The limit is that of three times
    of a contact beside the table, 4 % of Z."""
    force, K, C, balls, _, relaxation = bearing("7208B", 1000, [6e-6, 0, 0, 0, 0, 0], turns=False)
    frequencies = np.array([10.0, 300.0, 1e3, 2e3, 4e3, 8e3])
    s = 2j * np.pi * frequencies
    Z = (K + s[:, None, None] * C + relaxation.more(s))[:, 0, 0]
    load, angle = balls.load[0], balls.contact_angle[0]
    np.testing.assert_allclose(balls.load[1], load, rtol=1e-9)
    np.testing.assert_allclose(balls.contact_angle[1], angle, rtol=1e-9)
    compliance = np.zeros(frequencies.size, dtype=np.complex128)
    speed = force.geometry.entrainment_speed(1000.0 * math.pi / 30.0, 0.0)
    for ellipse in force.geometry.contacts(force.material):
        read = read_response(shipped_point_table().films(ellipse, OIL, load[0], speed, KELVIN), frequencies)
        compliance += 1.0 / (read.stiffness + s * read.damping)
    lengths = sum(
        arm + balls.approach[side][0] for side, arm in enumerate((force.shape.inner_arm, force.shape.outer_arm))
    )
    across = load[0] / lengths
    series = load.size * (math.sin(angle[0]) ** 2 / compliance + math.cos(angle[0]) ** 2 * across)
    np.testing.assert_allclose(np.abs(Z / series - 1.0), 0.0, atol=0.04)
    # which slow motion is not
    assert np.abs((K[0, 0] + s[-1] * C[0, 0]) / series[-1] - 1.0) > 0.15


def test_machines_have_films_that_relax_in_linear_analyses():
    scene = read_scene("electric_drive")
    relaxing, slow = (assemble(scene, "table", films=films) for films in (None, "slow"))
    assert relaxing.label == "film table"
    assert slow.label == "film table, slow films"
    at, still = Operation(relaxing.operation.speed), Operation()
    found = equilibrium(relaxing.system, at)
    same = equilibrium(slow.system, at)
    np.testing.assert_array_equal(found.displacement, same.displacement)
    assert same.relaxations == (None, None)
    sensors, inputs = scene.sensors[:1], scene.inputs[:1]
    fast, plain = (frequency_response(one, inputs, sensors, np.array([0.1, 2900.0])) for one in (found, same))
    np.testing.assert_allclose(fast[0], plain[0], rtol=1e-6)
    assert abs(fast[1] / plain[1] - 1.0).max() > 0.01
    # as many springs at any speed, so that modes are followed; none without films
    shapes = {tuple(one.rows.shape) for one in (*found.relaxations, *equilibrium(relaxing.system, still).relaxations)}
    assert shapes == {(54, 6)}
    assert not any(np.any(one.rows) for one in equilibrium(relaxing.system, still).relaxations)
