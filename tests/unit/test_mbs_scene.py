"""Scene files: what they say, and that every slip is found and said, all at once."""

from __future__ import annotations

import argparse
import dataclasses
import math
import re
import subprocess
import sys
from dataclasses import dataclass
from importlib import resources
from pathlib import Path

import numpy as np
import pytest

import mbs
from ehdmaps.errors import InputError
from ehdmaps.jobs.reader import parse_job
from ehdmaps.physics.bearing import BearingGeometry
from ehdmaps.physics.lubricant import Lubricant
from mbs.bearings.laws import hertz
from mbs.cli import main
from mbs.commands.cases import load_cases
from mbs.flexible.plan import Attached
from mbs.flexible.shaft_parts import Disc, Section
from mbs.gears.pair import GearPair
from mbs.model.body import Inertia, rigid_body
from mbs.model.elements import ElementDefaults, Forces, Load, Operation, Port, Spring
from mbs.model.equilibrium import equilibrium
from mbs.model.profiles import Course, Harmonic
from mbs.model.system import System
from mbs.planning.plan import plan
from mbs.scene import kinds
from mbs.scene.assembly import assemble, build_bodies
from mbs.scene.kinds import KINDS, ElementKind
from mbs.scene.matrices import MatrixSpec
from mbs.scene.reader import parse_scene, read_scene, shipped_systems
from mbs.scene.scene import Scene
from mbs.scene.specs import BallSpec, BearingSpec, FlexibleSpec, RigidSpec, ShaftSpec, TaperedSpec
from mbs.scene.surroundings import Built

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
    assert scene.has_bearings
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
        ("factors = [0, 1]", "factors = [0]", "as many finite numbers as there are times"),
        ('times = ["0 s", "1 ms"]', 'times = ["1 ms", "0 s"]', "allowed: finite and rising"),
        ('name = "NU308"', 'name = "NU3009"', "geometry: got 'NU3009'"),
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
        InputError, match=r"--law: got 'constant:sfot' .*allowed here: hertz, formula, dietl, constant:soft, table, map"
    ):
        assemble(parse_scene(SCENE, "test", "test.toml"), "constant:sfot")
    for law, words in (
        ("hertz:1 kg", "--law: got 'hertz:1 kg'; allowed: hertz:TIME such as 'hertz:1.25e-5 s', hertz:DAMPING such as"),
        ("hertz:", "--law: got 'hertz:'; allowed: hertz:TIME"),
        ("hertz:-1 us", "--law: got 'hertz:-1 us'; allowed: dampers from 0 to 0.01 s"),
        ("hertz:1e30 N s/m", "--law: got 'hertz:1e30 N s/m'; allowed: dampers from 0 to 1e+09 N s/m"),
    ):
        with pytest.raises(InputError, match=re.escape(words)):
            assemble(parse_scene(SCENE, "test", "test.toml"), law)
    felt = SCENE.replace("slices = 21", "slices = 21\ncentrifugal = true")
    with pytest.raises(InputError, match="centrifugal = true in main; allowed: the laws map, formula and dietl"):
        assemble(parse_scene(felt, "test", "test.toml"), "hertz")


def test_dry_contacts_with_a_damper():
    """Both forms against the law of the same numbers; the equilibrium is that without a damper."""
    scene = parse_scene(SCENE, "test", "test.toml")
    plain = assemble(scene, "hertz")
    for law, words, damping, time in (
        ("hertz:12.5 us", "c = 12.5 us times k", 0.0, 1.25e-5),
        ("hertz:100 N s/m", "c = 0.1 N s/mm", 100.0, 0.0),
    ):
        model = assemble(scene, law)
        assert model.label == f"dry Hertz, {words}"
        assert model.law == f"dry Hertz, ISO 16281, {words} of each contact of a roller"
        assert model.bearings[0].force.law == hertz(model.bearings[0].bearing, damping, time)
        found, wanted = (equilibrium(one.system, Operation()) for one in (model, plain))
        np.testing.assert_array_equal(found.displacement, wanted.displacement)
        assert np.any(found.damping) and not np.any(wanted.damping - plain.system.damping)


def own_scene(**changes):
    """A rigid shaft on two bearings, without any text."""
    pull = Load("pull", "shaft", np.array([0.0, 0.0, -300.0, 0.0, 0.0, 0.0]))
    shaft = RigidSpec(
        "shaft",
        [Inertia.cylinder(-0.15, 0.15, 0.04), Inertia.cylinder(-0.02, 0.02, 0.2)],
        ["y", "z", "theta_y", "theta_z"],
        frames={"left": (-0.1, 0.0, 0.0), "right": (0.1, 0.0, 0.0)},
        spin=1.0,
    )
    nu308 = BearingGeometry.named("NU308")
    bearings = [BearingSpec(side, f"shaft:{side}", "ground", nu308) for side in ("left", "right")]
    said = {"name": "own", "speed": 50.0, "temperature": 313.15, "lubricant": Lubricant.named("FVA3")}
    return Scene(**{**said, "bodies": [shaft], "loads": [pull], "elements": bearings, **changes})


OWN = """
schema = 1
operation = { speed = "50 rad/s", temperature = "40 degC" }
lubricant = { name = "FVA3" }
loads = [{ name = "pull", on = "shaft", force = ["0 N", "0 N", "-300 N"] }]
bearings = [
    { name = "left", inner = "shaft:left", outer = "ground", geometry = { name = "NU308" } },
    { name = "right", inner = "shaft:right", outer = "ground", geometry = { name = "NU308" } }]
[[bodies]]
name = "shaft"
freedoms = ["y", "z", "theta_y", "theta_z"]
position = ["0 mm", "0 mm", "0 mm"]
spin = 1
cylinders = [
    { from = "-0.15 m", to = "0.15 m", diameter = "0.04 m" },
    { from = "-0.02 m", to = "0.02 m", diameter = "0.2 m" }]
frames = { left = ["-0.1 m", "0 m", "0 m"], right = ["0.1 m", "0 m", "0 m"] }
"""


class TestSceneInPython:
    def test_it_is_that_of_a_file(self):
        found, wanted = own_scene(), parse_scene(OWN, "own", "own.toml")
        assert found.bodies == wanted.bodies
        assert found.elements == wanted.elements
        assert (found.title, found.text, found.files) == ("own", "", ())
        first, second = (assemble(scene, "hertz", clearance=-2e-6).system for scene in (found, wanted))
        assert first.coordinates == second.coordinates
        for name in ("mass", "stiffness", "gyroscopic", "steady_loads"):
            assert np.array_equal(getattr(first, name), getattr(second, name))

    @pytest.mark.parametrize("given", [own_scene(), parse_scene(OWN, "own", "own.toml")], ids=["specs", "text"])
    def test_it_can_be_planned(self, given):
        (job,) = plan(given).jobs()
        assert job.bearing == given.bearings[0].geometry
        assert job.lubricant == given.lubricant
        assert job.temperatures == (313.15,)
        assert parse_job(job.text, "again", "again.toml").loads == job.loads

    def test_every_law_over_pressure_can_be_planned(self):
        numbers = {
            "doolittle_slope": 4.5, "occupied_fraction": 0.66, "occupied_expansion": -7e-4, "volume_expansion": 8e-4,
            "bulk_modulus": 8.7e9, "bulk_modulus_decay": 6.3e-3, "bulk_modulus_slope": 11.0,
            "reference_temperature": 313.15,
        }  # fmt: skip
        oils = [
            Lubricant.own("tait-doolittle", numbers, viscosity=0.02, density=800.0),
            Lubricant.barus(viscosity_40=100e-6, viscosity_100=11e-6, pressure_viscosity=2e-8, density=880.0),
            Lubricant.roelands(viscosity=0.04, roelands_z=0.6, density=870.0),
        ]
        for oil in oils:
            (job,) = plan(own_scene(lubricant=oil, temperature=318.456)).jobs()
            assert job.lubricant.record() == oil.record()
            assert job.temperatures == (318.456,)
        with pytest.raises(
            InputError, match=r"lubricant: .*pressure_viscosity_40 of 'own oil' cannot be said in a job"
        ):
            stated = dict(viscosity_40=100e-6, viscosity_100=11e-6, density=880.0, pressure_viscosity_40=2e-8)
            own = Lubricant.barus(**stated, pressure_viscosity_100=2e-8)
            estimated = dataclasses.replace(own, correlation="so-klaus")  # beside an alpha of its own
            plan(own_scene(lubricant=estimated)).jobs()

    def test_a_body_of_matrices_is_taken_as_it_is(self):
        body = rigid_body("mass", [Inertia(2.0, 0.01, 0.01)], ["y"])
        assert build_bodies([body]) == (body,)
        spring = Spring("spring", "mass", "ground", np.diag([0.0, 8.0, 0, 0, 0, 0]))
        model = assemble(own_scene(bodies=[body], springs=[spring], loads=(), elements=()), "hertz")
        assert model.system.stiffness == np.array([[8.0]])

    def test_specs_say_what_is_wrong_with_them(self):
        with pytest.raises(InputError) as caught:
            RigidSpec("a", [], ["y", "y", "w"], (0.0, math.nan, 0.0), {"centre": (0.0, 0.0, 0.0)}, math.inf)
        text = "\n".join(caught.value.problems)
        for words in ("freedoms: got 'y'", "freedoms: got 'w'", "parts: got none", "'centre' is there already",
                      "position: got (0.0, nan, 0.0) m", "spin: got inf"):  # fmt: skip
            assert words in text
        with pytest.raises(InputError, match="shaft 's', frames: got none"):
            ShaftSpec("s", [Section(0.0, 0.1, 0.02)], ["x"], {}, 1e3)
        with pytest.raises(InputError, match="makes more than 400 elements"):
            ShaftSpec("s", [Section(0.0, 0.1, 0.02)], ["x"], {"a": 0.0}, None, largest_element=1e-9)
        with pytest.raises(InputError) as caught:
            own_scene(speed=math.nan, temperature=40.0)
        assert "scene, speed: got nan rad/s" in caught.value.problems[0]
        assert "scene, temperature: got 40.0 K; allowed: 213.15 to 573.15 K" in caught.value.problems[1]

    def test_specs_are_values(self):
        shaft = ShaftSpec("s", [Section(0.0, 0.1, 0.02)], ["x"], {"a": 0.0}, None, [Disc(0.05, Inertia(1.0, 1.0, 1.0))])
        assert shaft == dataclasses.replace(shaft)
        assert hash(shaft) == hash(dataclasses.replace(shaft))
        assert shaft != dataclasses.replace(shaft, frames={"a": 0.01})
        with pytest.raises(TypeError):
            shaft.frames["b"] = 0.1
        assert build_bodies([shaft])[0] is build_bodies([dataclasses.replace(shaft)])[0]
        # the order of the frames is that of the coordinates, and no other body
        two, reverse = ({"a": 0.0, "b": 0.1}, {"b": 0.1, "a": 0.0})
        first, second = build_bodies(
            [dataclasses.replace(shaft, frames=frames, cutoff=1e4) for frames in (two, reverse)]
        )
        assert first.coordinates != second.coordinates


def test_reading_loads_nothing_that_computes():
    """What a scene says is read without the analyses, numba, xarray, and without building bodies."""
    code = (
        "import sys; from mbs.scene.reader import read_scene; "
        "heavy = ('numba', 'scipy', 'xarray', 'netCDF4', 'meshio', 'matplotlib', 'mbs.linearised', 'mbs.spectral', "
        "'mbs.transient', 'mbs.scene.assembly', 'mbs.scene.assembly', 'mbs.flexible.reduction', 'mbs.flexible.shaft'); "
        "print([m for m in heavy if m in sys.modules]); "
        "read_scene('gearbox'); heavy = [m for m in heavy if m != 'scipy']; "  # pint looks whether there is scipy
        "print([m for m in heavy if m in sys.modules])"
    )
    result = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert result.stdout.split("\n")[:2] == ["[]", "[]"]


@pytest.fixture
def built_systems(monkeypatch):
    """A list that grows by one with each system that is built."""
    calls, original = [], System.__init__

    def counting(self, *arguments, **keywords):
        calls.append(self)
        original(self, *arguments, **keywords)

    monkeypatch.setattr(System, "__init__", counting)
    return calls


def test_a_model_is_one_system_and_models_share_their_bodies(built_systems):
    laws = ["hertz", "constant:hertz"]
    options = {"scene": "nu308_rigid", "output": None, "plot": None, "law": laws, "map": None}
    cases = load_cases(argparse.Namespace(**options, clearance=["10 um", "20 um"], load_factor=["1", "2"]))
    assert len(cases) == len(built_systems) == 8
    first = cases[0].model.system.bodies
    assert all(a is b for case in cases for a, b in zip(case.model.system.bodies, first, strict=True))


def test_everything_about_places_is_said_at_once():
    """Bodies apart, a name twice, a spring and a sensor without a place, and a bearing of one body."""
    text = SCENE.replace('position = ["60 mm"', 'position = ["61 mm"').replace('name = "guide"', 'name = "mount"')
    text = text.replace('on = "shaft"\nstiffness', 'on = "shat"\nstiffness')
    text = text.replace('against = "shaft:end"', 'against = "shaft:ned"')
    more = '[[bearings]]\nname = "one"\ninner = "ring"\nouter = "ring:left"\ngeometry = { name = "NU308" }\n[laws.soft]'
    scene = parse_scene(text.replace("[laws.soft]", more), "test", "test.toml")
    with pytest.raises(InputError) as caught:
        assemble(scene, "hertz")
    found = "\n".join(caught.value.problems)
    for words in (
        "element 'main': shaft:end and ring are 1 mm apart",
        "'mount': is there twice",
        "spring 'mount': got the body 'shat'",
        "sensor 'S': got the frame 'ned'",
        "bearing 'one': got the frame 'left' of 'ring'",
        "bearing 'one': got ring and ring:left; allowed: rings on two bodies",
    ):
        assert words in found
    assert len(caught.value.problems) == len(set(caught.value.problems))


def test_bodies_that_cannot_be_built_are_said_together(tmp_path):
    (tmp_path / "b.nc").write_text("no body")
    bodies = [FlexibleSpec(name, tmp_path / "b.nc", attached=[Attached("a", Inertia(1, 1, 1))]) for name in ("a", "b")]
    with pytest.raises(InputError) as caught:
        assemble(own_scene(bodies=bodies), "formulae")
    assert [problem.partition(":")[0] for problem in caught.value.problems] == [
        "--law",
        "flexible body 'a'",
        "flexible body 'b'",
    ]


@dataclass(frozen=True)
class Coupling:
    """A torsional spring between two shafts."""

    name: str
    on: str
    against: str
    stiffness: float


class CouplingElement(ElementDefaults):
    def __init__(self, spec):
        self.name, self.ports = spec.name, (Port(spec.on, spec.against),)
        self._matrix = np.diag([0.0, 0.0, 0.0, spec.stiffness, 0.0, 0.0])

    def evaluate(self, displacement, velocity, operation):
        return Forces(-self._matrix @ displacement, self._matrix, np.zeros((6, 6)))


def read_coupling(section, name):
    stiffness = section.quantity("stiffness", "N m/rad", 0.0, 1e9, kinds.bearings.DEGREE, required=True)
    on, against = section.get("on"), section.get("against")
    return None if stiffness is None else Coupling(name, on, against, stiffness)


def coupling_problems(spec, surroundings):
    return [f"coupling {spec.name!r}: got no stiffness; allowed: some"] if spec.stiffness == 0.0 else []


def build_coupling(spec, surroundings):
    element = CouplingElement(spec)
    return Built(element, element)


COUPLED = """
schema = 1
operation = { speed = "50 rad/s", temperature = "40 degC" }
couplings = [{ name = "coupling", on = "a", against = "b", stiffness = "100 N m/rad" }]
""" + "".join(
    f"""
[[bodies]]
name = "{name}"
freedoms = ["theta_x"]
position = ["0 mm", "0 mm", "0 mm"]
spin = 1
cylinders = [{{ from = "0 mm", to = "100 mm", diameter = "40 mm" }}]
"""
    for name in "ab"
)


class TestKinds:
    @pytest.fixture
    def with_couplings(self, monkeypatch):
        row = ElementKind(
            "couplings",
            "coupling",
            Coupling,
            read_coupling,
            lambda spec: (spec.on, spec.against),
            coupling_problems,
            build_coupling,
        )
        monkeypatch.setattr(kinds, "KINDS", (*KINDS, row))

    def test_one_row_brings_an_element_from_the_file_into_the_system(self, with_couplings):
        scene = parse_scene(COUPLED, "coupled", "coupled.toml")
        assert scene.elements == (Coupling("coupling", "a", "b", 100.0),)
        model = assemble(scene, "hertz")
        (connected,) = model.system.elements
        assert connected.element.name == "coupling"
        turn = connected.transform @ np.array([0.01, 0.0])
        force = connected.element.evaluate(turn, np.zeros(6), model.operation).force
        assert force[3] == pytest.approx(-1.0, rel=1e-15)
        assert (model.bearings, model.gears) == ((), ())

    def test_its_problems_come_with_the_others(self, with_couplings):
        text = COUPLED.replace('against = "b"', 'against = "c"').replace("100 N m/rad", "0 N m/rad")
        with pytest.raises(InputError) as caught:
            assemble(parse_scene(text, "coupled", "coupled.toml"), "hertz")
        assert caught.value.problems == (
            "coupling 'coupling': got the body 'c'; allowed: a, b, ground",
            "coupling 'coupling': got no stiffness; allowed: some",
        )

    def test_what_has_no_row_is_refused(self):
        with pytest.raises(InputError, match=r"couplings: unknown key"):
            parse_scene(COUPLED, "coupled", "coupled.toml")
        with pytest.raises(InputError, match=r"got 'c' of class Coupling; allowed: BearingSpec, GearPair"):
            assemble(own_scene(elements=[Coupling("c", "shaft", "ground", 1.0)]), "hertz")

    def test_rows_are_told_by_their_keys_and_classes(self):
        assert [kind.key for kind in KINDS] == ["bearings", "gears", "", "", ""]
        assert [kind.spec for kind in KINDS] == [BearingSpec, GearPair, MatrixSpec, BallSpec, TaperedSpec]


def test_check_says_what_is_assumed_of_an_oil(tmp_path, capsys):
    """One alpha of an own oil: its temperature, its change and that of the density are not the user's."""
    shipped = (Path(mbs.__file__).parent / "systems" / "nu308_rigid.toml").read_text()
    own = """[lubricant]
label = "PAO"
viscosity_law = "roelands"
viscosity_40 = "46.5 mm^2/s"
viscosity_100 = "7.8 mm^2/s"
density = "833 kg/m^3"
pressure_viscosity = "16.5 1/GPa"
"""
    scene = tmp_path / "own.toml"
    scene.write_text(re.sub(r"\[lubricant\].*\nname = .*\n", own, shipped))
    assert main(["check", str(scene), "--law", "hertz"]) == 0
    assert (
        "  oil PAO: density -0.6 kg/m3 a K (assumed); pressure-viscosity 16.5 1/GPa at 40 degC (assumed), its change "
        "with temperature estimated by So and Klaus (1980), "
    ) in capsys.readouterr().out


def test_a_job_is_no_scene_and_a_scene_no_job():
    job = (resources.files("ehdmaps.jobs") / "shipped" / "nu308.toml").read_text()
    scene = (resources.files("mbs") / "systems" / "gearbox.toml").read_text()
    with pytest.raises(InputError, match=r"is a job of ehdmaps, no scene; .*`ehdmaps generate`"):
        parse_scene(job, "nu308", "nu308.toml")
    with pytest.raises(InputError, match=r"is a scene of mbs, no job; .*`mbs run`"):
        parse_job(scene, "gearbox", "gearbox.toml")
