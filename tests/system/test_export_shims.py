"""User routines of Adams, RecurDyn and Simpack, called through stand-ins for these programs."""

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
from tests.cases.jobs import SMALL
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


def adams_built(path, folder, *options):
    folder = exported(path, folder, "adams", *options)
    sources = ["ehd.c", "bearing_slot.c", "film_history.c", "adams.c", str(MOCKS / "adams_driver.c")]
    made(folder, "gcc", *STRICT, f"-I{MOCKS}", "-I.", *sources, "-o", "driver", "-lm")
    return folder


@pytest.fixture(scope="module")
def adams(path, tmp_path_factory):
    return adams_built(path, tmp_path_factory.mktemp("adams") / "out")


def assert_same(found, wanted, part_of=1e-12):
    """1e-12 of the largest component: rounding of the angles, of the change of units and of the kernel in C."""
    for part in (slice(0, 3), slice(3, 6)):
        np.testing.assert_allclose(found[part], wanted[part], rtol=0, atol=part_of * np.abs(wanted[part]).max())


def adams_input(place=PLACE, kelvin=KELVIN):
    """Markers whose z is the axis: their x, y, z are y, z, x of the bearing; lengths in millimetres."""
    axis, turning = axis_and_turning()
    x, y, z = axis[[1, 2, 0]] / np.linalg.norm(axis)
    angles = [np.arctan2(x, -y), np.arctan2(np.hypot(x, y), z), 0.7]
    order = [1, 2, 0]
    return [*1e3 * place[order], *angles, *1e3 * SPEED[order], *turning[order], CAGE, kelvin, 1e3 * CLEARANCE]


def test_adams_feels_the_bearing(adams, wanted):
    result = called(adams, adams_input())
    found = numbers_of(result.stdout)
    assert_same(np.concatenate([found[[2, 0, 1]], 1e-3 * found[[5, 3, 4]]]), wanted)
    assert result.stderr == ""


def test_films_of_adams_relax(adams, relaxed):
    """Steps that are given up, and calls for derivatives, leave no trace. C is 3e-10 of the load from Python."""
    result = called(adams, [*adams_input(), 1.0, 1e3 * KICK, STEP])
    found = numbers_of(result.stdout)
    assert_same(np.concatenate([found[[2, 0, 1]], 1e-3 * found[[5, 3, 4]]]), relaxed, 1e-9)


def test_adams_is_stopped_outside_of_the_map(adams):
    assert answer(adams, adams_input(kelvin=500.0)).startswith("stopped 3 ")
    assert "stopped 3 " in answer(adams, adams_input(place=np.array([0.0, np.nan, 0.0])))


def test_adams_is_told_once_that_the_law_is_held(path, tmp_path):
    """The driver calls twice; the force is that of a bearing in Python at the highest temperature of the map."""
    result = called(adams_built(path, tmp_path / "out", "--outside", "clamp"), adams_input(kelvin=500.0))
    assert result.stderr == "WARN 3 a temperature outside the map\n"
    found = numbers_of(result.stdout)
    bearing = Bearing.named("NU308", clearance=CLEARANCE)
    force = BearingForce(bearing, open_map(path).law("series", outside="clamp"))
    assert_same(np.concatenate([found[[2, 0, 1]], 1e-3 * found[[5, 3, 4]]]), forced(force, bearing, 500.0))


@pytest.mark.slow
def test_recurdyn_feels_the_contact(path, tmp_path):
    folder = exported(path, tmp_path / "out", "recurdyn")
    sources = ["ehd.c", "film_history.c", "recurdyn.c", str(MOCKS / "recurdyn_driver.c")]
    made(folder, "gcc", *STRICT, "-I.", *sources, "-o", "driver", "-lm")
    law = open_map(path).law("series", outside="error")
    parameters = [1.5, KELVIN, 0.015, 1e-3, -2.0, 2e-3]
    # closes at 0.4 mm/s: along the axis that pushes apart the velocity is against the push
    found = numbers_of(answer(folder, [*parameters, 12e-3, 0.0, 0.4, 0.0]))
    load = law(1e-3 * (12e-3 - 2e-3), 0.4e-3, 1.5, KELVIN)[0]
    np.testing.assert_allclose(found, [0.0, -0.015 * load, 0.0, 0.0, 0.0, 0.0], rtol=1e-12)
    memory = law.at(1.5, KELVIN).memory
    state = memory.settled(1e-3 * (12e-3 - 2e-3))
    for _ in range(2):
        load, _, state = memory.advance(state, 1e-3 * (13e-3 - 2e-3), STEP)
    found_later = numbers_of(answer(folder, [*parameters, 12e-3, 0.0, 0.4, 0.0, 5.0, 1e-3, STEP]))
    np.testing.assert_allclose(found_later[1], -0.015 * load, rtol=1e-9)  # C is 3e-10 of the load from Python
    # the sign of the penetration is not documented
    np.testing.assert_array_equal(numbers_of(answer(folder, [*parameters, -12e-3, 0.0, 0.4, 0.0])), found)
    beyond = numbers_of(answer(folder, [1.5, 600.0, *parameters[2:], 12e-3, 0.0, 0.0, 0.0]))
    assert np.isnan(beyond[1])
    assert np.isnan(numbers_of(answer(folder, [*parameters[:4], 7.0, 0.0, 12e-3, 0.0, 0.0, 0.0]))[0])


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


def test_the_spline_of_adams_is_the_law(path, tmp_path):
    options = ["--speed", "1.5 m/s", "--temperature", "30 degC"]
    text = (exported(path, tmp_path / "out", "adams", *options) / "spline.adm").read_text(encoding="utf-8")
    body = text[text.index("SPLINE/1") :]
    x, y = (numbers_of(part.replace(",", " ")) for part in body.split("X =")[1].split(", Y ="))
    law = open_map(path).law("series", outside="clamp").at(1.5, 303.15)
    assert x.size == y.size == 120
    # ten digits of the approach make this of the load, where the curve is steepest against it
    np.testing.assert_allclose([law(place, 0.0)[0] for place in x], y, rtol=1e-6)


def test_half_a_place_of_the_spline_and_bare_contacts_are_refused(path, tmp_path, capsys):
    assert main(["export", str(path), "--to", "adams", "-o", str(tmp_path / "o"), "--speed", "1 m/s"]) == 2
    assert "--speed, --temperature: one of them is missing" in capsys.readouterr().err
    assert (
        main(
            [
                "export",
                str(path),
                "--to",
                "adams",
                "-o",
                str(tmp_path / "o"),
                "--speed",
                "90 m/s",
                "--temperature",
                "30 degC",
            ]
        )
        == 2
    )
    assert "outside" in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []
