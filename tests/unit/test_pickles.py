"""Laws, forces and models go to other processes: what comes out of a pickle gives the same numbers."""

from __future__ import annotations

import dataclasses
import multiprocessing
import pickle

import numpy as np
import pytest

import ehdmaps
from ehdmaps.physics.oil_supply import OilSupply
from ehdmaps.physics.surface import Surface
from mbs import Bearing, BearingForce, assemble, modes, parse_scene, read_scene, runup, statics
from mbs.bearings import laws
from mbs.bearings.bearing_force import ForceAtPoint
from mbs.model.profiles import SpeedProfile
from mbs.settings import RunUp, Settings
from tests.cases.bearings import bearing, map_law
from tests.cases.masses import MASSES

WARM = 330.0
DELTA = np.linspace(-2e-6, 6e-6, 9)
POSES = ([0.0, 9e-6, 4e-6, 0.0, 1e-4, 0.0], [0.0, -3e-6, 1.2e-5, 0.0, 0.0, -2e-4])


def again(thing):
    return pickle.loads(pickle.dumps(thing))


def of_film_table():
    return ehdmaps.law("NU308", "FVA3")


def of_a_file(path):
    return ehdmaps.open_map(path).law("series", outside="asymptote")


def check_law(law, other):
    """Equal bit by bit, at a speed of its own and at one that the first has been asked for before."""
    assert repr(other) == repr(law)
    for u in (1.7, -0.3):
        for q in (0.0, 2e3):
            np.testing.assert_array_equal(law(DELTA, 1e-3, u, WARM, q), other(DELTA, 1e-3, u, WARM, q))
            one, two = law.at(u, WARM, q), other.at(u, WARM, q)
            np.testing.assert_array_equal(one(DELTA, 1e-3), two(DELTA, 1e-3))
            np.testing.assert_array_equal(one(DELTA, 1e-3), again(one)(DELTA, 1e-3))
        memories = [at.at(u, WARM).memory for at in (law, other)]
        states = [memory.settled(DELTA) for memory in memories]
        first, second = (
            memory.advance(state, DELTA + 1e-8, 1e-5) for memory, state in zip(memories, states, strict=True)
        )
        np.testing.assert_array_equal(first[:2], second[:2])


def test_laws_of_films():
    fresh, used = map_law().again(), map_law().again()
    used(DELTA, 0.0, 1.7, WARM)
    used.at(1.7, WARM)
    for law in (fresh, used):
        check_law(law, again(law))


@pytest.mark.slow
def test_laws_of_files(formula_map):
    plain = ehdmaps.open_map(formula_map)
    for law in (plain.law("series", "asymptote"), plain.law("series", "clamp", OilSupply(5e-6), Surface(2e-7))):
        check_law(law, again(law))


@pytest.mark.slow
def test_the_law_of_the_film_table_says_what_it_is_and_states_the_same_errors():
    law = of_film_table()
    # tables that every process has stay at home; that of the law is 6 MB
    assert len(pickle.dumps(law)) < 10e6
    other = again(law)
    check_law(law, other)
    assert repr(law) == (
        "<ContactLaw series of NU308, FVA3: 100 to 1e+06 N/m, 0.05 to 10 m/s, 20 to 120 degC; outside: error>"
    )
    assert repr(law.at(1.7, 313.15)) == f"<LawAtPoint 1.7 m/s, 40 degC, of {law!r}>"
    loads = np.array([1e3, 1e5])
    one, two = (at.at(1.7, WARM) for at in (law, other))
    for name in ("stiffness", "damping", "film_offset"):
        np.testing.assert_array_equal(getattr(one.bounds(loads), name), getattr(two.bounds(loads), name))
    np.testing.assert_array_equal(one.rolling_force(loads), two.rolling_force(loads))


@pytest.mark.parametrize("law", [laws.hertz(bearing(), damping_time=1e-5), laws.constant(2e8, 50.0), map_law()])
@pytest.mark.parametrize("used", [False, True])
def test_forces(law, used):
    force = BearingForce(bearing(clearance=20e-6), law)
    if used:
        force(POSES[0], entrainment_speed=1.7, temperature=WARM)
    other = again(force)
    assert repr(other) == repr(force) and "NU308, clearance 20 um, 41 slices" in repr(force)
    for u in (1.7, 0.9):
        fixed = force.at(u, WARM)
        for pose in POSES:
            expected = force(pose, entrainment_speed=u, temperature=WARM)
            for found in (other(pose, entrainment_speed=u, temperature=WARM), again(fixed)(pose), fixed(pose)):
                for one, two in zip(found, expected, strict=True):
                    np.testing.assert_array_equal(one, two)
    assert isinstance(again(fixed), ForceAtPoint) and "NU308 at 0.9 m/s" in repr(again(fixed))


SCENES = {
    "bodies": lambda: _with(read_scene("nu308_rigid"), rollers_as_bodies=True),
    "coupled": lambda: _with(read_scene("nu308_rigid"), slices_coupled=True, slices=5),
    "tapered, ribs, balls": lambda: parse_scene(MASSES, "masses", "masses.toml"),
    "gears, housing": lambda: read_scene("gearbox"),
}


def _with(scene, **changes):
    return scene.with_bearings(dataclasses.replace(entry, **changes) for entry in scene.bearings)


@pytest.mark.slow
@pytest.mark.parametrize("name", SCENES)
def test_models(name):
    """As they were made: what analyses have left in a model does not go with it."""
    model = assemble(SCENES[name]())
    fresh = again(model)
    expected = statics(model).dataset, modes(model).dataset
    used = again(model)
    assert fresh.law == used.law == model.law
    for found, data in zip((statics(used).dataset, modes(fresh).dataset), expected, strict=True):
        for one in ("bearing_stiffness", "bearing_damping", "frequency", "damping_ratio"):
            if one in data:
                # balances that Newton reaches from other starts
                np.testing.assert_allclose(found[one], data[one], rtol=1e-6, atol=1e-6 * np.abs(data[one]).max())


def _forces_of(law_and_pose):
    law, pose = law_and_pose
    return BearingForce(Bearing.named("NU308", clearance=20e-6), law).at(1.7, WARM)(pose)


def _run_of(model):
    course = RunUp(SpeedProfile.ramp(100.0, 110.0, 2e-3), 2e-3, Settings(1e-4, 1e-4))
    return runup(model, course).dataset["signal"].values


@pytest.mark.slow
def test_processes_that_share_nothing(formula_map):
    """A pool of spawned processes: a law, a force at a point, a machine in time."""
    law, model = of_a_file(formula_map), assemble(read_scene("nu308_rigid"), emap=formula_map)
    fixed = law.at(1.7, WARM)
    with multiprocessing.get_context("spawn").Pool(1) as pool:
        calls = pool.starmap(fixed, [(delta, 0.0) for delta in DELTA.tolist()])
        forces = pool.map(_forces_of, [(law, pose) for pose in POSES])
        (signals,) = pool.map(_run_of, [model])
    np.testing.assert_array_equal(calls, [fixed(delta, 0.0) for delta in DELTA.tolist()])
    for pose, found in zip(POSES, forces, strict=True):
        for one, two in zip(found, _forces_of((law, pose)), strict=True):
            np.testing.assert_array_equal(one, two)
    np.testing.assert_array_equal(signals, _run_of(model))
