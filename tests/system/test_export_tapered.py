"""Tapered rollers, NJ and NUP in C and as units: `mbs bearing ... -o NAME.c`, `NAME.fmu`, against them in Python."""

from __future__ import annotations

import dataclasses
from unittest import mock

import numpy as np
import pytest
from fmpy import simulate_fmu
from fmpy.fmi1 import FMICallException
from fmpy.validation import validate_fmu

from ehdmaps.errors import InputError
from ehdmaps.exports.fmu.binaries import platforms
from ehdmaps.physics.rollers.ribbed_geometry import mirrored_ribs, ribbed_estimate
from ehdmaps.physics.rollers.tapered_catalogue import tapered_estimate
from mbs.bearings.locating.locating_element import LocatingElement
from mbs.bearings.tapered.line_film import LineFilms
from mbs.bearings.tapered.tapered_bearing import TaperedForce
from mbs.cli import main
from mbs.exports.one_bearing.rollers import RIBBED, TAPERED
from mbs.exports.one_bearing.source import source_texts, write_source
from mbs.exports.one_bearing.speed_laws import error_between
from mbs.model.elements import Operation
from tests.cases.c_balls import BallKernel, compiled_balls
from tests.cases.fmu import Unit
from tests.cases.line_films import made_up_films

RPM = np.pi / 30.0
EXACT = 1e-11
"""Newton's method leaves 1e-13 of the forces on a roller; stiffness and damping follow by the change of the place."""

ONE_CONTACT = (1e3, 1e9, 1e4)
"""Load, stiffness, damping of a contact: centrifugal loads on ribs press rings apart that have nearly no stiffness."""

NOT_FINITE, TOO_FAR, BAD_ARGUMENT, OUTSIDE_SPEED = 8, 32, 64, 2
OUTPUTS = ("force.x", "force.y", "force.z", "moment.y", "moment.z")
POSE = ["pose.x", "pose.y", "pose.z", "pose.theta_y", "pose.theta_z"]
VELOCITY = [name.replace("pose", "velocity") for name in POSE]
FREE = [0, 1, 2, 4, 5]
DAMPER = 1.25e-5
OUTER = -0.1
SIZES = np.array([15e-6, 15e-6, 15e-6, 0.0, 5e-4, 5e-4])
ARM = np.array([1.0, 1.0, 1.0, 0.03, 0.03, 0.03])


def geometry_of(name):
    return tapered_estimate(name) if name[0].isdigit() else ribbed_estimate(name, 20e-6, 30e-6)


def kind_of(name):
    return TAPERED if name[0].isdigit() else RIBBED


def turned(geometry):
    """The same bearing the other way round."""
    if geometry.contact_angle:
        return dataclasses.replace(geometry, contact_angle=-geometry.contact_angle)
    return mirrored_ribs(geometry)


@pytest.fixture(scope="module")
def exported(tmp_path_factory):
    """Bearing, laws over the speed and compiled kernel: tapered, with films, between ribs both ways and one way."""
    folder, found = tmp_path_factory.mktemp("tapered"), {}
    for name, filmed in (("32208", False), ("30205", True), ("NUP210", False), ("NNCF5010", False)):
        geometry = geometry_of(name)
        # a constant damper jumps where a line begins to carry: rollers between ribs are at that edge by themselves
        force = TaperedForce(geometry, 0.0 if filmed or name.startswith("N") else 50.0, 0.0 if filmed else DAMPER)
        laws = kind_of(name).speed_laws(force, made_up_films(geometry) if filmed else None, (1.0, 8.0))
        source = folder / f"{name}.c"
        write_source(kind_of(name), source, force, laws, ("made by ehdmaps",))
        prefix = name.lower() if name.startswith("N") else f"roller_{name}"
        kernel = BallKernel(compiled_balls(source), prefix, "rollers")
        assert kernel.make(kind_of(name).play(force.geometry)) == 0
        found[name] = force, laws, kernel
    return found


@pytest.mark.parametrize("mirrored", [False, True])
@pytest.mark.parametrize("name", ["32208", "30205", "NUP210", "NNCF5010"])
def test_kernel_is_that_of_python(exported, name, mirrored):
    """At random poses and velocities, pressed and with some or all rollers lifted off, at rest and fast."""
    force, laws, kernel = exported[name]
    kernel.make(kind_of(name).play(force.geometry), mirrored)
    way, geometry = (-1.0, turned(force.geometry)) if mirrored else (1.0, force.geometry)
    other = TaperedForce(geometry, force.damping, force.damping_time)
    rng, loaded, partly = np.random.default_rng(4), 0, 0
    for inner, outer in ((0.0, 0.0), (300.0, 0.0), (900.0, -80.0), (0.0, 700.0), (850.0, -700.0)):
        law = laws.at(geometry.entrainment_speed(inner, outer))
        at = other if laws.dry else other.with_films(LineFilms(law.inner, law.outer))
        for shift in (20e-6, 0.0, -60e-6):
            pose, velocity = rng.normal(size=(2, 6)) * SIZES
            pose[0] += way * shift
            angle = rng.uniform(-7.0, 7.0)
            given = {"cage_angle": angle, "inner_speed": inner, "outer_speed": outer}
            status, found = kernel.call(pose, 100.0 * velocity, angle, inner, outer)
            assert status & ~OUTSIDE_SPEED == 0
            wanted = at(pose, 100.0 * velocity, **given)
            if np.max(np.abs(wanted[0])) < 1e-6:  # within the balance, 1e-10 N a roller: no stiffness to be compared
                assert np.max(np.abs(found[0])) < 1e-6
                continue
            loaded += 1
            partly += np.any(at.last_rows[:, 3] == 0.0)
            scales = (ARM, np.outer(ARM, ARM), np.outer(ARM, ARM))
            each = zip((found[0], found[1:7], found[7:]), wanted, scales, ONE_CONTACT, strict=True)
            for rows, matrix, size, least in each:
                largest = max(np.max(np.abs(matrix / size)), least)
                assert np.max(np.abs((rows - matrix) / size)) <= EXACT * largest
    assert loaded >= 8
    assert partly > 2 or not laws.dry


@pytest.mark.parametrize("name", ["32208", "NUP210"])
def test_slow_rollers_find_their_balance(exported, name):
    """Idle rollers in a play of 1e4 times what their centrifugal loads press them in: from nothing, and in sequence."""
    force, _, kernel = exported[name]
    kernel.make(kind_of(name).play(force.geometry))
    rng = np.random.default_rng(3)
    for speed in (0.01, 0.1, 1.0, 10.0):
        for pose in rng.normal(size=(40, 6)) * SIZES:
            for angle in (0.0, 0.1):
                status, found = kernel.call(pose, np.zeros(6), angle, speed, 0.0)
                assert status == 0
                # light loads are left out, 1e-6 N a roller; the rest is that of the balance
                wanted = force(pose, cage_angle=angle, inner_speed=speed)[0]
                assert np.max(np.abs(found[0] - wanted) / ARM) <= 1e-9 * np.max(np.abs(wanted) / ARM) + 1e-6


@pytest.mark.parametrize("name", ["32208", "30205", "NUP210"])
def test_stiffness_is_the_derivative_of_the_force(exported, name):
    """Quotients of differences over 4 nm, to their second order; 1e-13 of a force of 10 kN over 4 nm is less."""
    force, _, kernel = exported[name]
    kernel.make(kind_of(name).play(force.geometry))
    pose = np.array([25e-6, 12e-6, -7e-6, 0.0, 3e-4, -2e-4])
    _, found = kernel.call(pose, np.zeros(6), 0.3, 300.0, 0.0)
    for axis in FREE:
        step = np.zeros(6)
        step[axis] = 2e-9 / ARM[axis]
        ahead, behind = (kernel.call(pose + way * step, np.zeros(6), 0.3, 300.0, 0.0)[1][0] for way in (1.0, -1.0))
        quotient = (behind - ahead) / (2.0 * step[axis])
        column = found[1:7, axis]
        assert np.max(np.abs(quotient - column) / ARM) < 1e-5 * np.max(np.abs(column) / ARM)


def test_films_between_the_speeds(exported):
    """The polynomial of four speeds in ln u; stiffness at the ends of the tables, where it goes on straight."""
    force, laws, _ = exported["30205"]
    assert laws.speeds.size > 20
    load, stiffness, damping = error_between(laws, made_up_films(force.geometry), of_largest=True)
    assert 0.0 < load < 5e-5
    assert stiffness < 2e-3
    assert damping < 2e-4


def test_statuses(exported):
    """What is refused has no values; and the next call is as if nothing had been."""
    _, laws, kernel = exported["30205"]
    kernel.make(0.0)
    still, pose = np.zeros(6), np.array([20e-6, 0.0, 0.0, 0.0, 1e-4, 0.0])
    before = kernel.call(pose, still, 0.0, 300.0, 0.0)
    for given, rings, angle, expected in (
        (pose * np.nan, 300.0, 0.0, NOT_FINITE),
        (pose, 300.0, np.inf, NOT_FINITE),
        (1e3 * pose, 300.0, 0.0, TOO_FAR),
        (pose, 3e4, 0.0, BAD_ARGUMENT),
        (pose, np.nan, 0.0, BAD_ARGUMENT),
    ):
        status, found = kernel.call(given, still, angle, rings, 0.0)
        assert status == expected and np.all(np.isnan(found))
    assert kernel.make(1.0) == kernel.make(np.nan) == BAD_ARGUMENT
    assert kernel.make(0.0) == 0
    assert kernel.call(pose, still, 0.0, 0.1, 0.0)[0] == OUTSIDE_SPEED
    np.testing.assert_allclose(kernel.call(pose, still, 0.0, 300.0, 0.0)[1], before[1], rtol=1e-9, atol=1e-6)
    geometry = turned(tapered_estimate("32208"))
    with pytest.raises(InputError, match="carries along -x"):
        source_texts(TAPERED, TaperedForce(geometry), laws, ())


LOAD = ("--load", "5 kN", "--axial", "2 kN", "--law", "hertz:1.25e-5 s", "--speed", "6000 rpm")


@pytest.fixture(scope="module")
def units(tmp_path_factory):
    """A 32208 by FMI 2.0 and a NUP210 by FMI 3.0, as the command writes them."""
    folder, files = tmp_path_factory.mktemp("units"), {"32208": "b.fmu", "NUP210": "b.fmi3.fmu"}
    with mock.patch("ehdmaps.exports.fmu.unit.platforms", return_value=platforms()[:1]):
        for name, file in files.items():
            assert main(["bearing", name, *LOAD, "-o", str(folder / file)]) == 0
    return {name: (folder / file, Unit(folder / file, folder / f"unit_{name}")) for name, file in files.items()}


def element_of(geometry, offset=0.0):
    """The bearing of the units in a machine."""
    force = TaperedForce(geometry, 0.0, DAMPER)
    return LocatingElement("b", "i", "o", force, outer_spin=OUTER, axial_offset=offset)


@pytest.mark.parametrize("mirrored", [False, True])
@pytest.mark.parametrize("name", ["32208", "NUP210"])
def test_unit(units, name, mirrored):
    """FMPy finds no problem; it begins in equilibrium, found to 1e-6; forces, -K and -C are those of a machine."""
    path, unit = units[name]
    assert validate_fmu(str(path)) == []
    rng, model = np.random.default_rng(2), unit.instance()
    np.testing.assert_allclose(unit.get(model, OUTPUTS)[:3], [-2000.0, -5000.0, 0.0], atol=1e-2)
    geometry = tapered_estimate(name) if name[0].isdigit() else ribbed_estimate(name)
    own, offset = ("axial_offset", 12e-6) if geometry.contact_angle else ("clearance", 15e-6)
    way = -1.0 if mirrored else 1.0
    if own == "axial_offset":
        element = element_of(turned(geometry) if mirrored else geometry, way * offset)
    else:
        element = element_of(dataclasses.replace(geometry, diametral_clearance=offset))
    pose, velocity = rng.normal(size=(2, 6)) * SIZES
    pose[0] += way * 20e-6
    operation = Operation(6000.0 * RPM, angle=0.7)
    wanted = element.evaluate(pose, 100.0 * velocity, operation)
    unit.put(model, ["mirrored", own], [float(mirrored), way * offset if own == "axial_offset" else offset])
    unit.put(model, [*POSE, *VELOCITY], [*pose[FREE], *100.0 * velocity[FREE]])
    turning = np.array([operation.angle, operation.speed])
    unit.put(model, ["spin.inner", "speed.inner", "spin.outer", "speed.outer"], [*turning, *OUTER * turning])
    np.testing.assert_allclose(unit.get(model, OUTPUTS), wanted.force[FREE], rtol=1e-8, atol=1e-5)
    for matrix, names in ((wanted.stiffness, POSE), (wanted.damping, VELOCITY)):
        found = np.array([unit.derivatives(model, each, OUTPUTS) for each in names]).T
        np.testing.assert_allclose(found, -matrix[np.ix_(FREE, FREE)], atol=1e-9 * np.max(np.abs(matrix)))
    begin = unit.get(model, (own,))[0]
    sides = []
    for step in (1e-8, -1e-8):
        unit.put(model, [own], [begin + step])
        sides.append(unit.get(model, OUTPUTS))
    quotient = (sides[0] - sides[1]) / 2e-8
    unit.put(model, [own], [begin])
    difference = unit.derivatives(model, own, OUTPUTS) - quotient  # slices begin to carry in between
    assert np.max(np.abs(difference)) < 2e-2 * np.max(np.abs(quotient))
    unit.put(model, ["pose.x"], [1.0])
    with pytest.raises(FMICallException):  # discarded
        unit.get(model, OUTPUTS)
    model.freeInstance()


def test_simulation(units):
    """FMPy's own loop: the bearing rests under the load of the export, and holds it; to the equilibrium, 1e-6."""
    for path, _ in units.values():
        found = simulate_fmu(str(path), fmi_type="CoSimulation", stop_time=1e-3, output_interval=1e-4)
        np.testing.assert_allclose(found["force.x"], -2000.0, rtol=1e-5)


def test_one_load(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert main(["bearing", "32208", *LOAD, "--load", "1 kN", "-o", "c.fmu"]) == 2
    assert "-o: got c.fmu for 2 loads and 1 speeds; allowed: one load" in capsys.readouterr().err
