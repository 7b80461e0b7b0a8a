"""Ball bearings in C and as units: `mbs bearing ... -o NAME.c`, `NAME.fmu`, against the same bearing in Python."""

from __future__ import annotations

import dataclasses
import tomllib
from pathlib import Path
from unittest import mock

import numpy as np
import pytest
from fmpy import simulate_fmu
from fmpy.fmi1 import FMICallException
from fmpy.validation import validate_fmu

from ehdmaps.errors import InputError
from ehdmaps.exports.fmu.binaries import platforms
from ehdmaps.jobs.cli import main as export
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.point.ball_catalogue import ball_estimate
from ehdmaps.physics.point.ball_geometry import HYPOTHESES
from mbs.bearings.balls.ball_bearing import BallForce
from mbs.bearings.balls.films import ball_films
from mbs.bearings.balls.laws import dry_law
from mbs.bearings.locating.locating_element import LocatingElement
from mbs.cli import main
from mbs.exports.one_bearing.balls import BALLS
from mbs.exports.one_bearing.source import source_texts, write_source
from mbs.exports.one_bearing.speed_laws import error_between
from mbs.model.elements import Operation
from tests.cases.c_balls import BallKernel, compiled_balls
from tests.cases.fmu import Unit

RPM = np.pi / 30.0
WARM = 333.15
EXACT, OF_SPHERES = 1e-11, 1e-10
"""Newton's method leaves 1e-13 of the forces on a ball; stiffness and damping follow by the change of the place.
Lengths of a sphere are a hundred times those of grooves, and so is their round-off."""

TOLD = 3
ABOVE_LOAD, OUTSIDE_SPEED, NOT_FINITE, TOO_FAR, BAD_ARGUMENT = 1, 2, 8, 32, 64
OUTPUTS = ("force.x", "force.y", "force.z", "moment.y", "moment.z")
POSE = ["pose.x", "pose.y", "pose.z", "pose.theta_y", "pose.theta_z"]
VELOCITY = [name.replace("pose", "velocity") for name in POSE]
FREE = [0, 1, 2, 4, 5]
DAMPER, OUTER = 1.25e-5, -0.1
"""Damping over stiffness [s]; turns of the outer ring by those of the inner one."""


def films(geometry):
    """Law with the films of FVA 3 at 60 degC, of an entrainment speed."""
    oil = Lubricant.named("FVA3")
    return lambda u: ball_films(geometry, oil, u, WARM, solves=False).law


@pytest.fixture(scope="module")
def exported(tmp_path_factory):
    """Bearing, laws over the speed and compiled kernel: dry deep groove, balls about the bisector; angular, films."""
    folder, found = tmp_path_factory.mktemp("balls"), {}
    for name, filmed in (("6208", False), ("7208B", True), ("3208", True), ("1208", True), ("51208", False)):
        geometry = dataclasses.replace(ball_estimate(name), hypothesis=HYPOTHESES[2 if name == "6208" else 0])
        ends = (geometry.entrainment_speed(rpm * RPM) for rpm in (1000.0, 6000.0))
        dry = dry_law(geometry, damping_time=DAMPER)
        laws = BALLS.speed_laws(BallForce(geometry, dry), films(geometry) if filmed else None, tuple(ends))
        source = folder / f"{name}.c"
        write_source(BALLS, source, BallForce(geometry, dry), laws, ("made by ehdmaps",))
        found[name] = geometry, laws, BallKernel(compiled_balls(source), f"ball_{name}".lower())
    return found


def assert_same(found, wanted, arm, within=EXACT):
    """Force, K and C, with angles by the arm of the grooves, to a part of the largest term."""
    scale = np.array([1.0, 1.0, 1.0, arm, arm, arm])
    for rows, matrix, size in zip(
        (found[0], found[1:7], found[7:]), wanted, (scale, *2 * (np.outer(scale, scale),)), strict=True
    ):
        largest = np.max(np.abs(matrix / size))
        assert np.max(np.abs((rows - matrix) / size)) <= within * largest


@pytest.mark.parametrize("mirrored", [False, True])
@pytest.mark.parametrize("name", ["6208", "7208B", "3208", "1208", "51208"])
def test_kernel_is_that_of_python(exported, name, mirrored):
    """At random poses and velocities, with clearance and preload, at rest and fast, with rings against each other."""
    nominal, laws, kernel = exported[name]
    rng = np.random.default_rng(4)
    scale = np.array([15e-6, 15e-6, 15e-6, 0.0, 5e-4, 5e-4])
    way = -1.0 if mirrored else 1.0
    loaded = 0
    for clearance in (20e-6, 0.0, -10e-6):
        if nominal.thrust and clearance:
            assert kernel.make(clearance, mirrored) == BAD_ARGUMENT
            continue
        assert kernel.make(clearance, mirrored) == 0
        geometry = dataclasses.replace(nominal, clearance=clearance, contact_angle=way * nominal.contact_angle)
        for inner, outer in ((0.0, 0.0), (300.0, 0.0), (900.0, -80.0), (0.0, 700.0), (850.0, -700.0)):
            u, cage = geometry.entrainment_speed(inner, outer), 1.05 * geometry.cage_speed(inner, outer)
            kernel.prepare(u)
            force = BallForce(geometry, laws.at(u))
            for _ in range(4):
                pose, velocity = rng.normal(size=(2, 6)) * scale
                pose[0] += 20e-6 * way * (geometry.contact_angle != 0.0)
                angle = rng.uniform(-7.0, 7.0)
                status, found = kernel.at(pose, 100.0 * velocity, angle, cage, outer)
                assert status & ~TOLD == 0
                wanted = force(
                    pose, 100.0 * velocity, cage_angle=angle, inner_speed=inner, outer_speed=outer, cage_speed=cage
                )
                assert_same(found, wanted, force.shape.arm or 0.02, OF_SPHERES if name == "1208" else EXACT)
                loaded += bool(np.any(wanted[0]))
    assert loaded > (15 if nominal.thrust else 40)


def test_cage_settles_as_in_machines(exported):
    """The speed of the cage is found to 1e-8 of the ring's; centrifugal loads are a tenth of the force."""
    geometry, laws, kernel = exported["7208B"]
    kernel.make(0.0)
    pose = np.array([20e-6, 4e-6, -3e-6, 0.0, 1e-4, 0.0])
    element = LocatingElement("b", "i", "o", BallForce(geometry, dry_law(geometry)), films=None)
    for speed in (200.0, 600.0):
        force = BallForce(geometry, laws.at(geometry.entrainment_speed(speed)))
        element = dataclasses.replace(element, force=force)
        at = element.settled(pose, Operation(speed))
        status, found = kernel.call(pose, np.zeros(6), 0.0, speed, 0.0)
        assert status == 0
        assert kernel.cage_speed == pytest.approx(at.loads.cage_speed, rel=1e-9)
        np.testing.assert_allclose(found[0], element.evaluate(pose, np.zeros(6), Operation(speed)).force, rtol=1e-8)


def test_films_between_the_speeds(exported):
    """The polynomial of four speeds in ln u leaves 2e-4 of the load: a tenth of what the film table states."""
    geometry, laws, _ = exported["7208B"]
    load, stiffness, damping = error_between(laws, films(geometry))
    assert 0.0 < load < 2e-4
    assert stiffness < 1e-3
    assert damping < 2e-2


def test_statuses(exported):
    """What is told keeps its values, what is refused has none; and the next call is as if nothing had been."""
    geometry, laws, kernel = exported["7208B"]
    kernel.make(0.0)
    still, speed = np.zeros(6), 300.0
    pose = np.array([20e-6, 0.0, 0.0, 0.0, 0.0, 0.0])
    before = kernel.call(pose, still, 0.0, speed, 0.0)
    far, apart = 1e3 * pose, -0.99 * geometry.groove_distance * pose / pose[0]
    for given, rings, expected in (
        (pose * np.nan, speed, NOT_FINITE),
        (far, speed, TOO_FAR),
        (apart, speed, TOO_FAR),
        (pose, 3e4, BAD_ARGUMENT),
    ):
        status, found = kernel.call(given, still, 0.0, rings, 0.0)
        assert status == expected and np.all(np.isnan(found))
    assert kernel.make(1.0) == BAD_ARGUMENT
    held = [kernel.call(pose, still, 0.0, rings, 0.0) for rings in (0.5, 1e-3)]
    assert [status for status, _ in held] == [OUTSIDE_SPEED] * 2
    np.testing.assert_allclose(held[0][1][0], held[1][1][0], rtol=1e-6, atol=1e-6)
    assert kernel.prepare(float(f"{laws.speeds[-1]:.6g}") * (1.0 + 1e-6)) == 0  # as typed
    heavy, found = kernel.call(10.0 * pose, still, 0.0, speed, 0.0)
    assert heavy == ABOVE_LOAD and np.all(np.isfinite(found))
    status, found = kernel.call(pose, still, 0.0, speed, 0.0)
    assert status == before[0] == 0
    np.testing.assert_allclose(found, before[1], rtol=1e-9, atol=1e-6)


LOAD = ("--load", "500 N", "--axial", "2 kN", "--temperature", "60 degC", "--law", "hertz:1.25e-5 s")
FAST = ("--speed", "6000 rpm")


@pytest.fixture(scope="module")
def units(tmp_path_factory):
    """A 7208B by FMI 2.0 and 3.0, and as an element for ROSS, as the command writes them."""
    folder = tmp_path_factory.mktemp("units")
    names = {"2": "b.fmu", "3": "b.fmi3.fmu", "ross": "b.toml"}
    here = platforms()[:1]
    with mock.patch("ehdmaps.exports.fmu.unit.platforms", return_value=here):
        for name in names.values():
            assert main(["bearing", "7208B", *LOAD, *FAST, "-o", str(folder / name)]) == 0
    return {key: folder / name for key, name in names.items()}


@pytest.fixture(scope="module")
def unpacked(units, tmp_path_factory):
    return {fmi: Unit(units[fmi], tmp_path_factory.mktemp(f"unit{fmi}")) for fmi in "23"}


def element_of(geometry):
    """The bearing of the units in a machine."""
    force = BallForce(geometry, dry_law(geometry, damping_time=DAMPER))
    return LocatingElement("b", "i", "o", force, outer_spin=OUTER)


@pytest.mark.parametrize("fmi", ["2", "3"])
def test_unit(units, unpacked, fmi):
    """FMPy finds no problem; it begins in equilibrium; forces, -K and -C are those of a machine at any pose.

    Both find the speed of the cage to 1e-8; at the start K and C are those of the file for ROSS, whose equilibrium is
    found to 1e-6.
    """
    assert validate_fmu(str(units[fmi])) == []
    unit, rng = unpacked[fmi], np.random.default_rng(2)
    model = unit.instance()
    np.testing.assert_allclose(unit.get(model, OUTPUTS)[:3], [-2000.0, -500.0, 0.0], atol=1e-3)
    ross = tomllib.loads(units["ross"].read_text())["BearingElement_7208B"]
    for letter, axes in (("k", POSE), ("c", VELOCITY)):
        found = np.array([unit.derivatives(model, name, OUTPUTS) for name in axes]).T
        for term, row, column in (("xx", 1, 1), ("xy", 1, 2), ("yx", 2, 1), ("yy", 2, 2), ("zz", 0, 0)):
            assert -found[row, column] == pytest.approx(ross[letter + term], rel=1e-5, abs=1e-6 * ross[letter + "zz"])
    element = element_of(ball_estimate("7208B"))
    scale = np.array([10e-6, 10e-6, 10e-6, 0.0, 3e-4, 3e-4])
    pose, velocity = rng.normal(size=(2, 6)) * scale
    pose[0] += 20e-6
    operation = Operation(6000.0 * RPM, angle=0.7)
    wanted = element.evaluate(pose, 100.0 * velocity, operation)
    unit.put(model, [*POSE, *VELOCITY], [*pose[FREE], *100.0 * velocity[FREE]])
    turning = np.array([operation.angle, operation.speed])
    unit.put(model, ["spin.inner", "speed.inner", "spin.outer", "speed.outer"], [*turning, *OUTER * turning])
    np.testing.assert_allclose(unit.get(model, OUTPUTS), wanted.force[FREE], rtol=1e-8, atol=1e-5)
    for matrix, names in ((wanted.stiffness, POSE), (wanted.damping, VELOCITY)):
        found = np.array([unit.derivatives(model, name, OUTPUTS) for name in names]).T
        size = np.max(np.abs(matrix))
        np.testing.assert_allclose(found, -matrix[np.ix_(FREE, FREE)], atol=1e-7 * size)
    for name, step in (("speed.inner", 0.1), ("spin.inner", 1e-4), ("clearance", 1e-8)):  # to their second order
        begin = unit.get(model, (name,))[0]
        sides = []
        for way in (step, -step):
            unit.put(model, [name], [begin + way])
            sides.append(unit.get(model, OUTPUTS))
        unit.put(model, [name], [begin])
        quotient = (sides[0] - sides[1]) / (2.0 * step)
        found = unit.derivatives(model, name, OUTPUTS)
        assert np.max(np.abs(found - quotient)) < 1e-3 * np.max(np.abs(quotient))
    with pytest.raises(FMICallException):
        unit.put(model, ["mirrored"], [0.5])
    unit.put(model, ["pose.x"], [-1e-3])
    with pytest.raises(FMICallException):  # discarded: there is no raceway
        unit.get(model, OUTPUTS)
    unit.put(model, ["pose.x"], [pose[0]])
    np.testing.assert_array_equal(unit.get(model, OUTPUTS) * 0.0, np.zeros(5))
    model.freeInstance()


def test_pair_in_o_arrangement(unpacked):
    """A shaft on a mirrored and a plain unit, preloaded by 20 um along the axis: force and moment at some places.

    Python and C find the speeds of the cages to 1e-8.
    """
    unit, half, preload = unpacked["2"], 40e-3, 10e-6
    models = {way: unit.instance() for way in (-1.0, 1.0)}
    unit.put(models[-1.0], ["mirrored"], [1.0])
    nominal, operation = ball_estimate("7208B"), Operation(9000.0 * RPM)
    elements = {
        way: element_of(dataclasses.replace(nominal, contact_angle=way * nominal.contact_angle)) for way in models
    }
    rng = np.random.default_rng(3)
    for place in (np.zeros(5), *rng.normal(size=(3, 5)) * np.array([4e-6, 4e-6, 4e-6, 5e-5, 5e-5])):
        sums = np.zeros((2, 5))
        for way, model in models.items():
            x, y, z, about_y, about_z = place
            # the plain one, which takes +x, stands at -x: lines of contact meet the axis far outside
            arm = -way * half
            pose = np.array([x + way * preload, y + arm * about_z, z - arm * about_y, 0.0, about_y, about_z])
            unit.put(
                model, [*POSE, "speed.inner", "speed.outer"], [*pose[FREE], operation.speed, OUTER * operation.speed]
            )
            at = elements[way].evaluate(pose, np.zeros(6), operation).force[FREE]
            for side, force in enumerate((unit.get(model, OUTPUTS), at)):
                sums[side] += force
                sums[side, 3:] += -arm * force[2], arm * force[1]
            assert -way * at[0] > 100.0
        np.testing.assert_allclose(*sums, rtol=1e-7, atol=1e-5)
    for model in models.values():
        model.freeInstance()


def test_simulation(units):
    """FMPy's own loop: the bearing rests under the load of the export, and holds it; to the equilibrium, 1e-6."""
    for kind in ("CoSimulation", "ModelExchange"):
        found = simulate_fmu(str(units["2"]), fmi_type=kind, stop_time=1e-3, output_interval=1e-4)
        np.testing.assert_allclose(found["force.x"], -2000.0, rtol=1e-6)


def test_two_files_of_a_source(tmp_path, monkeypatch, capsys):
    """A header that is not ours is not replaced, and nothing is written; several loads are refused."""
    monkeypatch.chdir(tmp_path)
    Path("b.h").write_text("mine")
    assert main(["bearing", "7208B", *LOAD, *FAST, "-o", "b.c"]) == 2
    assert "b.h, which is there and is not the header of a bearing" in capsys.readouterr().err
    assert sorted(path.name for path in Path().iterdir()) == ["b.h"]
    assert main(["bearing", "7208B", *LOAD, "--load", "1 kN", *FAST, "-o", "c.c"]) == 2
    assert "-o: got c.c for 2 loads and 1 speeds; allowed: one load" in capsys.readouterr().err


@pytest.mark.parametrize("ending", ["c", "fmu"])
def test_rollers_are_exported_with_films(ending, capsys):
    asked = ["bearing", "NU308", "--load", "1 kN", "--speed", "0 rpm", "-o", f"x.{ending}"]
    assert main([*asked, "--law", "hertz"]) == 2
    assert (
        f"-o x.{ending}: got the law dry Hertz, ISO 16281; allowed: --law table, or --map MAP.nc"
        in capsys.readouterr().err
    )
    assert main([*asked, "--profile", '{ crown_drop = "10 um" }']) == 2
    assert "allowed: without --coupled, and --profile iso or straight" in capsys.readouterr().err
    assert export(["export", "6208", "--to", ending]) == 2
    assert "the bearing itself: -o NAME.c, NAME.fmu" in capsys.readouterr().err


def test_mirrored_bearings_are_not_exported_twice():
    geometry = dataclasses.replace(ball_estimate("7208B"), contact_angle=-0.7)
    law = dry_law(geometry)
    with pytest.raises(InputError, match="ball bearing: got one that carries along -x"):
        source_texts(BALLS, BallForce(geometry, law), BALLS.speed_laws(BallForce(geometry, law)), ())
