"""Single direction thrust ball bearings: closed Hertz, ratings, what washers do not have; and balls beyond a groove."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest
from scipy.special import ellipe, ellipk

from ehdmaps.errors import InputError
from ehdmaps.jobs.balls import balls_of
from ehdmaps.physics.designations.reader import bore_code, table
from ehdmaps.physics.point.ball_catalogue import ball_estimate
from ehdmaps.physics.point.ball_geometry import BallGeometry
from ehdmaps.physics.point.ball_ratings import ball_dynamic_rating, ball_static_rating
from ehdmaps.physics.solids import STEEL
from mbs.bearings.balls.ball_bearing import BallForce
from mbs.bearings.balls.ball_mounting import mounted
from mbs.bearings.balls.laws import dry_law
from mbs.bearings.thermal import Mounting
from mbs.cli import main
from mbs.life import ball_reference_life

THRUST = ball_estimate("51208")


def force_of(geometry: BallGeometry) -> BallForce:
    return BallForce(geometry, dry_law(geometry, damping_time=1e-5))


def hertz_approach(load: float, diameter: float, conformity: float) -> float:
    """Approach of a ball in a straight groove, by the complete elliptic integrals and bisection of their equation."""
    modulus = STEEL.youngs_modulus / (1.0 - STEEL.poisson_ratio**2) / 2.0  # of both bodies together
    along, across = 2.0 / diameter, 2.0 / diameter - 1.0 / (conformity * diameter)  # curvatures of the pair
    low, high = 1e-9, 1.0 - 1e-9  # (b/a)^2
    for _ in range(200):
        k2 = 0.5 * (low + high)
        m = 1.0 - k2
        ratio = (ellipe(m) / k2 - ellipk(m)) / (ellipk(m) - ellipe(m))
        low, high = (k2, high) if ratio > along / across else (low, k2)
    m = 1.0 - k2
    a = (3.0 * load * ellipe(m) / (2.0 * math.pi * k2 * (along + across) / 2.0 * modulus)) ** (1.0 / 3.0)
    return 3.0 * load * ellipk(m) / (2.0 * math.pi * modulus * a)


def test_axial_stiffness_is_that_of_closed_hertz():
    """F = Z Q, and both contacts in series yield 2 delta(Q); K = 1.5 F/x. Grooves stand A apart: no angle changes."""
    for force in (100.0, 5e3, 40e3):
        yields = 2.0 * hertz_approach(force / THRUST.balls, THRUST.ball_diameter, THRUST.inner_conformity)
        found, stiffness, _ = force_of(THRUST)(np.array([yields, 0.0, 0.0, 0.0, 0.0, 0.0]))
        assert found[0] == pytest.approx(-force, rel=1e-6)  # iterations of both
        assert stiffness[0, 0] == pytest.approx(1.5 * force / yields, rel=1e-6)
        np.testing.assert_allclose(found[1:], 0.0, atol=1e-9 * force)
        # against a tilt springs stand on the pitch circle, and across it balls swing on the line of both grooves
        pitch, length = 0.5 * THRUST.pitch_diameter, THRUST.groove_distance + yields
        assert stiffness[4, 4] == pytest.approx(0.5 * pitch**2 * stiffness[0, 0], rel=1e-6)
        assert stiffness[1, 1] == pytest.approx(0.5 * force / length, rel=1e-6)


def test_turned_round_it_carries_the_other_way():
    back = force_of(BallGeometry("back", 10e-3, 54e-3, 15, 0.54, 0.54, -0.5 * math.pi))
    for x, carries in ((-1e-5, True), (1e-5, False)):
        force = back(np.array([x, 0.0, 0.0, 0.0, 0.0, 0.0]))[0]
        assert (force[0] > 0.0) == carries


def test_catalogues_tell_balls_as_they_are_made():
    """Where one number of balls alone fits C and C0, balls are of a whole number of 32nds of an inch: by chance a third
    would be within 0.4 %. Of all the table C is within 1.6 %, its digits, and balls are so."""
    alone, near = [], []
    for series, rows in table("balls")["thrust"].items():
        for bore, outside, _, dynamic, static in rows:
            found = ball_estimate(series + bore_code(bore))
            assert ball_static_rating(found) == pytest.approx(static, rel=1e-9)
            assert ball_dynamic_rating(found) == pytest.approx(dynamic, rel=0.016)
            size, pitch = found.ball_diameter / 25.4e-3 * 32.0, 0.5e-3 * (bore + outside)
            near.append(abs(size / round(size) - 1.0) < 0.004)
            others = (
                dataclasses.replace(found, balls=number, ball_diameter=1e-3 * math.sqrt(static / 61.6 / number))
                for number in range(6, 40)
                if 1e-3 * math.sqrt(static * number / 61.6) < 0.97 * math.pi * pitch
            )
            alone.append(sum(abs(math.log(ball_dynamic_rating(one) / dynamic)) < 0.016 for one in others) == 1)
    assert len(near) == 105 and sum(near) == 101
    assert sum(alone) == 37 and sum(np.array(near)[alone]) == 35


def test_an_axial_load_is_its_equivalent_load():
    load = np.full((2, THRUST.balls), 5e3 / THRUST.balls)
    life = ball_reference_life(THRUST, load, ball_dynamic_rating(THRUST))
    assert life.load == pytest.approx(5e3, rel=1e-12)


@pytest.mark.parametrize(
    ("ask", "said"),
    [
        (lambda: ball_estimate("51208 C3"), "allowed: no class of radial clearance: washers of thrust ball bearings"),
        (lambda: THRUST.with_clearance(1e-5), "clearance: got 10 um; allowed: 0, as washers of thrust bearings have"),
        (lambda: mounted(THRUST, Mounting(), 320.0, 300.0), "fit of the ball bearing 51208: got a fit"),
        (lambda: balls_of('{ name = "51208", diametral_clearance = "9 um" }'), "clearance: got 9 um; allowed: 0"),
        (lambda: ball_estimate("51299"), "designation: got '51299'"),
        (lambda: ball_estimate("7208B").known({"contact_angle": 1.6}, ""), "allowed: finite and from -90 to 90 deg"),
    ],
)
def test_what_washers_do_not_have_is_refused(ask, said):
    with pytest.raises(InputError, match=said):
        ask()


def test_the_command_asks_for_an_axial_load(capsys):
    ask = ["bearing", "51208", "--speed", "1500 rpm", "--law", "hertz"]
    assert main([*ask, "--load", "1 kN"]) == 1
    assert "a thrust bearing carries a positive axial load alone" in capsys.readouterr().err
    assert main([*ask, "--axial", "5 kN"]) == 0
    out = capsys.readouterr().out
    assert "a_ISO of thrust bearings: not yet" in out and "clearance" not in out.replace("clearance 0", "clearance")
    assert "51208: thrust ball bearing" in out


@pytest.mark.parametrize("speed", [0.0, 300.0])
@pytest.mark.parametrize("name", ["6208", "7208B", "3208"])
def test_balls_beyond_the_grooves_are_free(name, speed):
    """A ring further off than A cos(alpha): balls behind it carry nothing by an inner raceway that is not there, thrown
    outwards or not; those before it carry as near by as the ring has come, within 3 %, the change of their angles."""
    geometry = ball_estimate(name)
    force, far = force_of(geometry), geometry.radial_distance
    forces = [force(np.array([0.0, -part * far, 0.0, 0.0, 0.0, 0.0]), inner_speed=speed)[0] for part in (1.002, 1.006)]
    behind = np.cos(force.angles) > 0.999
    assert np.all(force.last_rows[behind, 10] == 0.0) and np.all(force.last_rows[~behind, 10].max() > 0.0)
    still = force(np.array([0.0, -1.006 * far, 0.0, 0.0, 0.0, 0.0]))[0]
    assert forces[1][1] > forces[0][1] > 0.0
    assert forces[1][1] == pytest.approx(still[1], rel=0.03)
