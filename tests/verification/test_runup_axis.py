"""A disc that tilts while it runs up, against its angular momentum in space: the torque turns with the shaft."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from mbs import assemble, parse_scene
from mbs.model.profiles import SpeedProfile
from mbs.settings import Settings
from mbs.transient.run import Options, run

POLAR, ACROSS, STIFFNESS, DAMPING, MOMENT = 0.5, 0.3, 3e3, 5.0, 3.0
TIME, SPEED = 0.3, 6000.0 * math.pi / 30.0
SCENE = f"""
schema = 1
title = "disc on a soft tilting support"
[operation]
speed = "0 rpm"
temperature = "40 degC"
[[bodies]]
name = "rotor"
freedoms = ["theta_y", "theta_z"]
spin = 1
mass = "10 kg"
polar_inertia = "{POLAR} kg m^2"
transverse_inertia = "{ACROSS} kg m^2"
[[bearings]]
kind = "table"
name = "b"
inner = "rotor"
outer = "ground"
stiffness = {{ theta_y = "{STIFFNESS} N m/rad", theta_z = "{STIFFNESS} N m/rad" }}
damping = {{ theta_y = "{DAMPING} N m s/rad", theta_z = "{DAMPING} N m s/rad" }}
[[loads]]
name = "t"
on = "rotor"
moment = ["0 N m", "{MOMENT} N m", "0 N m"]
"""
X = np.array([1.0, 0.0, 0.0])


def in_space(along_shaft, times):
    """Tilts (2, n) about y and z: L' = M, L = Ip w n + It n x n', with the drive's torque along n, or along x."""
    drive = POLAR * SPEED / TIME

    def slope(_, state):
        n, momentum = state[:3], state[3:]
        turning = np.cross(momentum, n) / ACROSS
        torque = np.array([0.0, MOMENT, 0.0]) - STIFFNESS * np.cross(X, n) - DAMPING * np.cross(n, turning)
        return np.concatenate([turning, torque + drive * (n if along_shaft else X)])

    begin = np.concatenate([X, np.zeros(3)])
    found = solve_ivp(slope, (0.0, TIME), begin, t_eval=times, rtol=1e-10, atol=1e-13, method="DOP853")
    return np.array([-found.y[2], found.y[1]])


@pytest.mark.slow
def test_a_torque_along_the_shaft_leaves_no_term_of_its_acceleration() -> None:
    """A moment tilts a disc that runs up: as by a torque along the shaft, to the second order of step and tilts. One
    along x would turn the tilt by 19 degrees: Ip dw/dt is a third of the stiffness."""
    machine = assemble(parse_scene(SCENE, "disc", "disc.toml"), "hertz")
    speed, settings = SpeedProfile.ramp(0.0, SPEED, TIME), Settings(step=2e-5, sample=1e-3)
    done = run(machine.system, speed, TIME, settings, displacement=np.zeros(2), options=Options(states=True))
    tilts = done.states.displacement.T
    wanted, other = (in_space(along, done.time) for along in (True, False))
    size = np.max(np.abs(wanted))
    assert np.max(np.abs(tilts - wanted)) < 1e-3 * size
    assert np.max(np.abs(other - wanted)) > 0.2 * size
