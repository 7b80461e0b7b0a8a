"""Steps in C of machines with gears, connections by matrices, gyroscopic terms and loads: against steps in Python."""

from __future__ import annotations

import dataclasses
import pickle

import numpy as np
import pytest

from mbs.model.body import Inertia, rigid_body
from mbs.model.elements import Load, Operation, Sensor, Spring
from mbs.model.matrices import MatrixElement
from mbs.model.profiles import Harmonic, SpeedProfile
from mbs.model.system import System
from mbs.settings import Settings
from mbs.transient.run import Options, run
from tests.unit.test_mbs_gear import mesh

Y, Z = np.eye(6)[1], np.eye(6)[2]
SETTINGS = Settings(2e-5, 1e-4, residual=1e-13)
RAMP = SpeedProfile.ramp(20.0, 60.0, 0.02)
SENSORS = (Sensor("first", "shaft_1:gear", Y), Sensor("second", "shaft_2:gear", Z, "velocity"))
FREEDOMS = ["x", "y", "z", "theta_x", "theta_y", "theta_z"]


def machine() -> System:
    """Two shafts with a gear pair, each on a spring, one on a connection by matrices over the speed besides."""
    shafts = [
        rigid_body(name, [Inertia(2.0, 0.01, 0.02)], FREEDOMS, spin=spin, frames={"gear": place})
        for name, spin, place in (("shaft_1", 1.0, (0.0, 0.0, 0.0)), ("shaft_2", -21.0 / 23.0, (0.0, 0.099, 0.0)))
    ]
    held = np.diag([1e7, 2e7, 3e7, 1e4, 1e5, 1e5])
    springs = [Spring(f"held {body.name}", body.name, "ground", held) for body in shafts]
    rng = np.random.default_rng(3)
    size = np.sqrt(np.diag(held) / 10.0)
    stiffness = np.array(
        [np.diag(size**2) + 0.1 * np.outer(size, size) * rng.uniform(-1.0, 1.0, (6, 6)) for _ in "abc"]
    )
    damping = 1e-5 * stiffness
    seal = MatrixElement("seal", "shaft_2", stiffness, damping, speeds=np.array([25.0, 40.0, 50.0]))
    loads = [
        Load("drive", "shaft_1", np.array([0.0, 0.0, 0.0, 20.0, 0.0, 0.0])),
        Load("shaker", "shaft_1", 150.0 * (Y + 0.2 * Z), profile=Harmonic(60.0)),
    ]
    return System(shafts, springs, loads, [mesh(), seal])


def test_steps_in_c_are_those_of_python():
    """They differ by what Newton leaves over, 1e-13 of the forces, grown over the run; energies likewise."""
    system, options = machine(), Options(states=True, every_step=True)
    compiled, reference = (
        run(system, RAMP, 0.02, SETTINGS, SENSORS, options=dataclasses.replace(options, compiled=c))
        for c in (True, False)
    )
    assert compiled.compiled == compiled.steps == reference.steps == 1000
    assert compiled.notes == ()
    assert compiled.outside["seal"] > 0
    pairs = zip(
        (*compiled.signals.T, *compiled.forces, *compiled.motions, compiled.states.acceleration),
        (*reference.signals.T, *reference.forces, *reference.motions, reference.states.acceleration),
        strict=True,
    )
    for got, wanted in pairs:
        np.testing.assert_allclose(got, wanted, rtol=0.0, atol=1e-9 * np.abs(wanted).max())
    one, other = compiled.energy, reference.energy
    level = other.through
    for got, wanted in zip(one.elements, other.elements, strict=True):
        told = [(got.work, wanted.work), (got.driven, wanted.driven), (got.dissipated, wanted.dissipated)]
        np.testing.assert_allclose(*np.array(told).T, rtol=0.0, atol=1e-9 * level)
    for key in ("loads", "numerical", "kinetic", "elastic"):
        assert getattr(one, key) == pytest.approx(getattr(other, key), abs=1e-9 * level)
    assert one.parts == pytest.approx(other.parts, abs=1e-9 * level)
    assert one.relative_residual < 1e-3  # the trapezoidal rule


def test_the_error_of_steps_halves_them_as_in_python():
    system = machine()
    settings = dataclasses.replace(SETTINGS, tolerance=1e-11)
    compiled, reference = (
        run(system, RAMP, 2e-3, settings, SENSORS, options=Options(compiled=c)) for c in (True, False)
    )
    assert compiled.halved == reference.halved > 0
    assert compiled.steps == reference.steps
    np.testing.assert_allclose(compiled.signals, reference.signals, rtol=1e-8, atol=1e-15)


def test_a_run_goes_on_from_a_mark():
    system, options = machine(), Options(marks=True)
    whole = run(system, RAMP, 0.01, SETTINGS, SENSORS, options=options)
    mark = whole.marks[len(whole.marks) // 2]
    rest = run(system, RAMP, 0.01 - mark.time, SETTINGS, SENSORS, begin=mark)
    count = rest.signals.shape[0]
    np.testing.assert_allclose(rest.signals, whole.signals[-count:], rtol=1e-8, atol=1e-12)


def test_a_gear_mesh_that_was_used_pickles():
    element = mesh()
    motion, rate = np.full(12, 1e-6), np.zeros(12)
    at = [pickle.loads(pickle.dumps(element)).flanks(motion, rate, at) for at in _operations()]
    np.testing.assert_array_equal(at, [element.flanks(motion, rate, at) for at in _operations()])


def _operations():
    """Some moments."""
    return [Operation(30.0, angle) for angle in (0.0, 0.1, 0.2)]
