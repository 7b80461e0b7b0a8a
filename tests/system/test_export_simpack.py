"""The user routine of Simpack, called through a stand-in for it."""

import subprocess
from pathlib import Path

import numpy as np
import pytest

from ehdmaps.jobs.cli import main
from ehdmaps.jobs.make.generate import generate
from ehdmaps.jobs.reader import parse_job
from ehdmaps.maps.emap import open_map
from ehdmaps.physics.closed_form import FormulaSolver
from mbs.bearings.bearing import Bearing
from mbs.bearings.bearing_force import BearingForce
from tests.cases.c_kernel import STRICT
from tests.cases.jobs import LINE, SMALL
from tests.cases.programs import needed

MOCKS = Path(__file__).parents[1] / "data" / "c" / "mocks"
CLEARANCE, KELVIN, SPIN, CAGE = 20e-6, 310.0, 60.0, 0.3
PLACE, SPEED = np.array([0.0, 18e-6, 7e-6]), np.array([0.0, 2e-4, -3e-4])
OBJECTS = ("ehd.o", "bearing_slot.o", "film_history.o")
TILT, TILT_RATE = np.array([2e-4, -3e-4]), np.array([1e-3, 2e-3])
"""Pose and motion of the inner ring; tilts about y and z."""


@pytest.fixture(scope="module")
def path(tmp_path_factory):
    path = tmp_path_factory.mktemp("shims") / "map.nc"
    generate(parse_job(SMALL, "map", "map.toml"), path, workers=1, solver=FormulaSolver())
    return path


@pytest.fixture(scope="module")
def wanted(path):
    """Force and moment by the bearing of Python."""
    bearing = Bearing.named("NU308", clearance=CLEARANCE)
    return forced(BearingForce(bearing, open_map(path).law("series", outside="error")), bearing, KELVIN)


def forced(force, bearing, kelvin):
    """Force and moment of a bearing in the pose and motion above."""
    pose = np.concatenate([PLACE, [0.0], TILT])
    rate = np.concatenate([SPEED, [0.0], TILT_RATE])
    u = bearing.geometry.entrainment_speed(SPIN)
    return force.evaluate(pose, rate, cage_angle=CAGE, entrainment_speed=u, temperature=kelvin).force


KICK, STEP = 1e-6, 2e-5
"""What a ring moves along y [m] within the first of two steps [s]."""


@pytest.fixture(scope="module")
def relaxed(path):
    """Force and moment after a rest in the pose above and two steps with films that have a memory."""
    bearing = Bearing.named("NU308", clearance=CLEARANCE)
    force = BearingForce(bearing, open_map(path).law("series", outside="error"))
    law = force.in_time(bearing.geometry.entrainment_speed(SPIN), KELVIN)
    pose = np.concatenate([PLACE, [0.0], TILT])
    state, kicked = law.settled(pose, CAGE), pose + KICK * np.eye(6)[1]
    for _ in range(2):
        found, state = law.advance(state, kicked, STEP, CAGE)
    return found.force


def axis_and_turning():
    """Axis of the tilted ring (1, tz, -ty), and the angular velocity by which it spins and tilts as above."""
    axis = np.array([1.0, TILT[1], -TILT[0]])
    length = np.linalg.norm(axis)
    # across x, so that the axis moves by (0, TILT_RATE z, -TILT_RATE y); what of this spins the ring is taken off again
    across = np.array([0.0, TILT_RATE[0], TILT_RATE[1]])
    return axis, (SPIN - across @ axis / length) * axis / length + across


def exported(path, folder, target, *options):
    assert main(["export", str(path), "--to", target, "-o", str(folder), *options]) == 0
    return folder


def made(folder, *command):
    program, *rest = command
    result = subprocess.run([needed(program), *rest], cwd=folder, capture_output=True, text=True, check=False)
    assert result.returncode == 0, result.stderr


def called(folder, numbers):
    given = " ".join(f"{number!r}" for number in np.asarray(numbers, dtype=float).tolist())
    return subprocess.run(["./driver"], cwd=folder, input=given, capture_output=True, text=True, check=True)


def answer(folder, numbers):
    return called(folder, numbers).stdout


def numbers_of(text):
    return np.array(text.split(), dtype=float)


def assert_same(found, wanted, part_of=1e-12):
    """1e-12 of the largest component: rounding of the angles, of the change of units and of the kernel in C."""
    for part in (slice(0, 3), slice(3, 6)):
        np.testing.assert_allclose(found[part], wanted[part], rtol=0, atol=part_of * np.abs(wanted[part]).max())


def test_simpack_feels_the_bearing(path, wanted, relaxed, tmp_path):
    """Simpack is given the opposite, which it applies at the outer ring."""
    folder = exported(path, tmp_path / "out", "simpack")
    for source in ("ehd.c", "bearing_slot.c", "film_history.c"):
        made(folder, "gcc", *STRICT, "-c", source)
    sources = [str(MOCKS / "simpack.f90"), "simpack.f90", str(MOCKS / "simpack_driver.f90")]
    made(folder, "gfortran", "-Wall", "-Wno-unused-dummy-argument", *sources, *OBJECTS, "-o", "driver")
    axis, turning = axis_and_turning()
    given = [*PLACE, *(-0.05 * axis), *SPEED, *turning, CAGE]
    found = numbers_of(answer(folder, [*given, KELVIN, CLEARANCE, 0.0, 0.0, 0.0]))
    assert_same(-found, wanted)
    assert_same(-numbers_of(answer(folder, [*given, KELVIN, CLEARANCE, 1.0, KICK, STEP])), relaxed, 1e-9)
    assert "message 3 roller bearing with films, element 5" in answer(folder, [*given, 500.0, CLEARANCE, 0.0, 0.0, 0.0])


def test_bare_contacts_are_refused(tmp_path, capsys):
    generate(parse_job(LINE, "line", "line.toml"), tmp_path / "line.nc", workers=1, solver=FormulaSolver())
    assert main(["export", str(tmp_path / "line.nc"), "--to", "simpack", "-o", str(tmp_path / "o")]) == 2
    assert "allowed: a map of a bearing" in capsys.readouterr().err
    assert not (tmp_path / "o").exists()
