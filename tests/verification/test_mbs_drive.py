"""Speed by torques: beside closed forms, a coupled integration of spin and bending, and its energy."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from ehdmaps.errors import InputError
from mbs import assemble, parse_scene
from mbs.model.drive import Drive, DrivenSpeed, TorqueCurve
from mbs.settings import Settings
from mbs.transient.run import Options, run
from tests.cases.rotors import DISC

INERTIA = 0.02

ROTOR = (
    DISC
    + """[[unbalances]]
name = "u"
on = "disc"
moment = "2 g m"
"""
)
MASS, STIFFNESS, DAMPING, MOMENT = 2.0, 2e5, 40.0, 2e-3


class TestCourse:
    def test_constant_torque(self):
        speed = DrivenSpeed.of(
            Drive(INERTIA, TorqueCurve.constant(3.0), TorqueCurve.constant(1.0)), 10.0, 2.0
        ).started()
        for time in (0.0, 0.3, 1.7):
            assert speed.at(time) == pytest.approx((10.0 + 100.0 * time, 10.0 * time + 50.0 * time**2), rel=1e-12)
            assert speed.rate(time) == pytest.approx(100.0)

    def test_linear_load_torque(self):
        load = TorqueCurve((0.0, 1000.0), (0.0, 20.0))
        speed = DrivenSpeed.of(Drive(INERTIA, TorqueCurve.constant(3.0), load), 0.0, 2.0)
        tau = INERTIA / 0.02
        for time in (0.5, 1.0, 1.9):
            wanted = 150.0 * (1.0 - math.exp(-time / tau))
            run_of = speed.started()
            # Runge and Kutta with 0.1 ms, and cubics between: rounding.
            assert run_of.at(time)[0] == pytest.approx(wanted, rel=1e-10)
            assert run_of.at(time)[1] == pytest.approx(150.0 * time - tau * wanted, rel=1e-9)
            # The course of straight lines between 4000 points, for what looks at a run before it is made.
            assert speed.at(time)[0] == pytest.approx(wanted, rel=1e-6)

    def test_runs_down_to_rest_and_stays(self):
        drive = Drive(INERTIA, TorqueCurve.constant(3.0), TorqueCurve.constant(1.0), motor_until=0.5)
        speed = DrivenSpeed.of(drive, 0.0, 1.8).started()
        assert speed.at(0.5)[0] == pytest.approx(50.0, rel=1e-9)
        assert speed.at(1.0)[0] == pytest.approx(25.0, rel=1e-9)
        assert speed.at(1.7)[0] == 0.0


def coupled(torque, times):
    """Speed and motion where the disc reacts on its shaft: Lagrange's equations of an unbalanced disc."""

    def slope(time, state):
        (y, z, _, vy, vz, w), here = state, state[2]
        sin, cos = math.sin(here), math.cos(here)
        mass = [[MASS, 0.0, -MOMENT * sin], [0.0, MASS, MOMENT * cos], [-MOMENT * sin, MOMENT * cos, INERTIA]]
        right = [
            MOMENT * w**2 * cos - DAMPING * vy - STIFFNESS * y,
            MOMENT * w**2 * sin - DAMPING * vz - STIFFNESS * z,
            torque,
        ]
        return [vy, vz, w, *np.linalg.solve(mass, right)]

    return solve_ivp(slope, (0.0, times[-1]), np.zeros(6), "DOP853", times, rtol=1e-6, atol=1e-10).y


class TestReaction:
    """An unbalance that takes a good part of the torque while its speed goes through the resonance, at 316 rad/s."""

    @pytest.mark.parametrize(("torque", "captured"), [(5.2, False), (2.4, True)])
    def test_beside_a_coupled_integration(self, torque, captured):
        system = assemble(parse_scene(ROTOR, "rotor", "rotor")).system
        duration = 800.0 * INERTIA / torque * 0.5
        speed = DrivenSpeed.of(Drive(INERTIA, TorqueCurve.constant(torque), TorqueCurve.constant(0.0)), 0.0, duration)
        record = run(system, speed, duration, Settings(1e-4, 1e-3, 1.0), options=Options(states=True))
        wanted = coupled(torque, record.time)
        free = torque / INERTIA * duration
        assert bool(record.speed[-1] < 0.85 * free) is captured
        # The reaction is a mean over 2 ms, a tenth of a turn at resonance, and acts in the next 2 ms.
        np.testing.assert_allclose(record.speed, wanted[5], atol=0.01 * free)
        account = record.drive
        assert account.taken > 0.05 * account.motor
        assert abs(account.residual) <= 5e-3 * account.motor

    def test_loads_over_time_are_refused(self):
        text = ROTOR + '[[loads]]\nname = "f"\non = "disc"\nforce = ["0 N", "1 N", "0 N"]\nfrequency = "5 Hz"\n'
        speed = DrivenSpeed.of(Drive(1.0, TorqueCurve.constant(1.0), TorqueCurve.constant(0.0)), 0.0, 1.0)
        with pytest.raises(InputError, match="loads that vary over time beside a speed by torques"):
            run(assemble(parse_scene(text, "rotor", "rotor")).system, speed, 0.1, Settings(1e-4, 1e-4))


RUNUP = '[runup]\nfrom = "0 rpm"\nduration = "1 s"\nstep = "0.1 ms"\n'
DRIVE = '[drive]\ninertia = "0.05 kg m^2"\nmotor = { speeds = ["0 rpm", "3000 rpm"], torques = ["5 N m", "1 N m"] }\n'


def test_scene_has_a_drive():
    scene = parse_scene(f"{ROTOR}{RUNUP}{DRIVE}load = '0.5 N m'\nmotor_until = '0.8 s'", "rotor", "rotor")
    drive = scene.run_up.speed.drive
    assert drive.motor(50.0 * math.pi) == pytest.approx(3.0)
    assert (drive.inertia, drive.load(7.0), drive.motor_until) == (0.05, 0.5, 0.8)


@pytest.mark.parametrize(
    ("tables", "message"),
    [
        (DRIVE, "stands without .runup."),
        (f'{RUNUP}to = "1 rpm"\n{DRIVE}', "stands beside .drive."),
        (RUNUP, "to: missing"),
        (RUNUP + DRIVE.replace("motor", "engine"), "motor: missing"),
        (RUNUP + DRIVE.replace('"3000 rpm"', '"0 rpm"'), "each above the last"),
        (RUNUP + DRIVE.replace(', "1 N m"', ""), "of each, as many"),
    ],
)
def test_refused(tables, message):
    with pytest.raises(InputError, match=message):
        parse_scene(ROTOR + tables, "rotor", "rotor")


def test_invalid_drives_are_refused():
    with pytest.raises(InputError, match=r"inertia: got 0.0(?s:.*)motor_until: got -1.0"):
        Drive(0.0, TorqueCurve.constant(1.0), TorqueCurve.constant(0.0), -1.0)
