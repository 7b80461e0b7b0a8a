"""Scene files: what they say, and that every slip is found and said, all at once."""

from __future__ import annotations

import math

import numpy as np
import pytest

from ehdmaps.errors import InputError
from mbs.model.body import Inertia
from mbs.model.profiles import Course, Harmonic
from mbs.scene.assembly import assemble
from mbs.scene.reader import parse_scene, read_scene, shipped_systems

SCENE = """
schema = 1
title = "a test"
[operation]
speed = "1000 rpm"
temperature = "60 degC"
[[bodies]]
name = "shaft"
freedoms = ["y", "z", "theta_z"]
position = ["10 mm", "0 mm", "0 mm"]
spin = 2.0
mass = "2 kg"
polar_inertia = "0.01 kg m^2"
transverse_inertia = "0.02 kg m^2"
frames = { end = ["50 mm", "0 mm", "0 mm"] }
assumed = ["mass"]
[[bodies]]
name = "ring"
freedoms = ["y", "z"]
position = ["60 mm", "0 mm", "0 mm"]
cylinders = [{ from = "-10 mm", to = "10 mm", diameter = "90 mm", bore = "80 mm", density = "7000 kg/m^3" }]
[[springs]]
name = "mount"
on = "ring"
stiffness = { y = "1 kN/mm", z = "2 kN/mm" }
damping = { y = "5 N s/m" }
[[springs]]
name = "guide"
on = "shaft"
stiffness = { theta_z = "1e6 N m/rad", y = "1 N/m" }
[[loads]]
name = "weight"
on = "shaft"
force = ["0 N", "100 N", "0 N"]
moment = ["0 N m", "0 N m", "1 N m"]
[[loads]]
name = "shake"
on = "ring"
force = ["0 N", "1 N", "0 N"]
frequency = "50 Hz"
phase = "90 deg"
[[loads]]
name = "step"
on = "ring"
force = ["0 N", "1 N", "0 N"]
times = ["0 s", "1 ms"]
factors = [0, 1]
[[bearings]]
name = "main"
inner = "shaft:end"
outer = "ring"
geometry = { name = "NU308", diametral_clearance = "15 um" }
slices = 21
start_angle = "10 deg"
[laws.soft]
stiffness = "1e7 N/m"
damping = "3 N s/m"
[[inputs]]
name = "E"
on = "shaft:end"
direction = [0, 3, 4]
amplitude = "2 N"
[[sensors]]
name = "S"
on = "ring"
against = "shaft:end"
direction = "z"
quantity = "velocity"
[linear]
frequencies = ["10 Hz", "20 Hz"]
[runup]
from = "0 rpm"
to = "600 rpm"
duration = "10 ms"
step = "10 us"
sample = "0.1 ms"
spectral_radius = 1
tolerance = "1 nm"
"""


def problems_of(text):
    with pytest.raises(InputError) as caught:
        parse_scene(text, "test", "test.toml")
    assert all(problem.startswith("test.toml: ") for problem in caught.value.problems)
    return "\n".join(caught.value.problems)


def test_a_scene_is_read():
    scene = parse_scene(SCENE, "test", "test.toml")
    assert scene.title == "a test"
    assert scene.speed == pytest.approx(1000.0 * math.pi / 30.0)
    assert scene.temperature == 333.15
    assert scene.lubricant is None
    shaft, ring = scene.bodies
    assert shaft.spin == 2.0
    np.testing.assert_allclose([shaft.position[0], shaft.frames["end"][0]], [0.01, 0.05])
    assert shaft.parts == (Inertia(2.0, 0.01, 0.02),)
    assert sum(part.mass for part in ring.parts) == pytest.approx(7000.0 * math.pi / 4.0 * (0.09**2 - 0.08**2) * 0.02)
    np.testing.assert_allclose(np.diag(scene.springs[0].stiffness), [0, 1e6, 2e6, 0, 0, 0])
    np.testing.assert_allclose(np.diag(scene.springs[0].damping), [0, 5, 0, 0, 0, 0])
    np.testing.assert_allclose(scene.loads[0].force, [0, 100, 0, 0, 0, 1])
    assert scene.loads[1].profile == Harmonic(50.0, pytest.approx(math.pi / 2.0))
    assert scene.loads[2].profile == Course((0.0, 0.001), (0.0, 1.0))
    (bearing,) = scene.bearings
    assert bearing.geometry.diametral_clearance == pytest.approx(15e-6)
    assert (bearing.slices, bearing.start_angle) == (21, pytest.approx(math.radians(10.0)))
    assert scene.laws == {"soft": (1e7, 3.0)}
    np.testing.assert_allclose(scene.inputs[0].direction[:3], [0.0, 0.6, 0.8])
    assert scene.inputs[0].amplitude == 2.0
    assert (scene.sensors[0].against, scene.sensors[0].quantity) == ("shaft:end", "velocity")
    assert scene.frequencies == (10.0, 20.0)
    assert scene.run_up is not None
    assert scene.run_up.settings.tolerance == pytest.approx(1e-9)
    assert scene.assumed == ("[[bodies]] shaft mass",)
    model = assemble(scene, "constant:soft")
    assert model.bearings[0].inner_spin == 2.0
    assert model.system.coordinates == ("shaft.y", "shaft.z", "shaft.theta_z", "ring.y", "ring.z")


@pytest.mark.parametrize("name", shipped_systems())
def test_shipped_systems_are_read_and_mark_what_is_assumed(name):
    scene = read_scene(name)
    assert scene.assumed
    assert scene.bearings
    assert scene.run_up is not None


def test_problems_come_all_at_once():
    text = problems_of(
        SCENE.replace('speed = "1000 rpm"', 'speed = "1000"')
        .replace("spin = 2.0", "spni = 2.0")
        .replace('freedoms = ["y", "z"]', 'freedoms = ["y", "q"]')
        .replace("slices = 21", "slices = 0")
        .replace('quantity = "velocity"', 'quantity = "speed"')
    )
    for words in (
        "[operation] speed: got '1000' without a unit",
        "[[bodies]] shaft spni: unknown key (did you mean 'spin'?)",
        "[[bodies]] ring freedoms: got ['q']; allowed: a list of x, y",
        "[[bearings]] main slices: got 0; allowed: a whole number from 1",
        "[[sensors]] S quantity: got 'speed'; allowed: 'displacement'",
    ):
        assert words in text


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("schema = 1", "schema = 2", "schema: got 2; allowed: 1"),
        ("schema = 1", "", "schema: missing"),
        ('title = "a test"', "title = 5", "title: got 5; allowed: a short text"),
        ('name = "ring"', 'name = "ri:ng"', "without : and ."),
        ("[operation]", "[oparation]", "unknown key"),
        ('temperature = "60 degC"', 'temperature = "60 bar"', "got the unit 'bar'"),
        ('assumed = ["mass"]', 'assumed = ["weight"]', "allowed: a list of the names of keys of this table"),
        ('mass = "2 kg"\n', "", "stands without its companions"),
        ('frames = { end = ["50 mm", "0 mm", "0 mm"] }', 'frames = { end = "50 mm" }', "allowed: three lengths"),
        ("cylinders = [{", "cylinders = {", "is not TOML"),
        ('diameter = "90 mm"', 'diameter = "70 mm"', "0 <= bore < diameter"),
        ('stiffness = { y = "1 kN/mm", z = "2 kN/mm" }', "", "stiffness: missing"),
        ('y = "1 kN/mm"', 'w = "1 kN/mm"', "unknown key"),
        ('on = "ring"\nstiffness', "on = 5\nstiffness", 'allowed: a place such as "shaft"'),
        ('force = ["0 N", "100 N", "0 N"]', 'force = "100 N"', "allowed: three values"),
        ('frequency = "50 Hz"\n', "", "stands without frequency"),
        ("factors = [0, 1]", "factors = [0]", "as many numbers as there are times"),
        ('times = ["0 s", "1 ms"]', 'times = ["1 ms", "0 s"]', "allowed: finite and rising"),
        ('name = "NU308"', 'name = "NU309"', "geometry: name: got 'NU309'"),
        ("direction = [0, 3, 4]", "direction = [0, 0, 0]", "not all zero"),
        ("direction = [0, 3, 4]", "direction = [0, 3]", "allowed: one of x, y"),
        ('sample = "0.1 ms"', 'sample = "15 us"', "allowed: a whole multiple of the step"),
        ('stiffness = "1e7 N/m"', 'stiffness = "1e7 N"', "got the unit 'N'"),
        ('frequencies = ["10 Hz", "20 Hz"]', 'frequencies = ["20 Hz", "10 Hz"]', "allowed: rising values"),
    ],
)
def test_slips(old, new, message):
    assert old in SCENE
    assert message in problems_of(SCENE.replace(old, new, 1))


def test_files_that_are_none(tmp_path):
    with pytest.raises(InputError, match=r"n1014_rigit: cannot be read .*did you mean 'n1014_rigid'"):
        read_scene("n1014_rigit")
    path = tmp_path / "a.toml"
    path.write_bytes(b"\xff")
    with pytest.raises(InputError, match="is not UTF-8 text"):
        read_scene(str(path))
    path.write_bytes(b"#" * 1_000_001)
    with pytest.raises(InputError, match="longer than 1000000 bytes"):
        read_scene(str(path))


def test_places_and_laws_that_do_not_exist_are_said_together():
    scene = parse_scene(
        SCENE.replace('inner = "shaft:end"', 'inner = "shaft:edge"').replace(
            'against = "shaft:end"', 'against = "shat"'
        ),
        "test",
        "test.toml",
    )
    with pytest.raises(InputError) as caught:
        assemble(scene, "formula", clearance=1.0)
    text = "\n".join(caught.value.problems)
    for words in (
        "--law: got 'formula', but test has no [lubricant]",
        "--clearance: bearing 'NU308', diametral_clearance: got 1.0 m",
        "sensor 'S': got the body 'shat' (did you mean 'shaft'?)",
        "bearing 'main': got the frame 'edge' of 'shaft'; allowed: centre, end",
    ):
        assert words in text
    with pytest.raises(
        InputError, match=r"--law: got 'constant:sfot' .*allowed here: hertz, formula, constant:soft, map"
    ):
        assemble(parse_scene(SCENE, "test", "test.toml"), "constant:sfot")
    felt = SCENE.replace("slices = 21", "slices = 21\ncentrifugal = true")
    with pytest.raises(InputError, match="centrifugal = true in main; allowed: the laws map and formula"):
        assemble(parse_scene(felt, "test", "test.toml"))
