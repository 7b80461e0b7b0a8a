"""Bearings whose films have a memory: compiled slices, runs in time against Python, and the linear analyses."""

from __future__ import annotations

import ctypes
import dataclasses
import functools
import math

import numpy as np
import pytest

from ehdmaps.errors import InputError, OutsideMapError
from ehdmaps.kernel.library import function
from ehdmaps.maps.kernels.memory import FilmState
from ehdmaps.maps.law import ContactLaw
from ehdmaps.physics.oil_supply import OilSupply
from mbs import assemble, read_scene
from mbs.bearings.bearing import Bearing
from mbs.bearings.bearing_element import BearingElement
from mbs.bearings.bearing_force import BearingForce
from mbs.bearings.laws import hertz
from mbs.bearings.memory_block import MEMORY, STEP, resume
from mbs.bearings.speed_tables import MOST_KEPT, CourseOfFilms, SpeedWindow
from mbs.model.body import Inertia, rigid_body
from mbs.model.elements import Load, Operation
from mbs.model.equilibrium import equilibrium
from mbs.model.profiles import Course, Harmonic, SpeedProfile
from mbs.model.system import System
from mbs.settings import Settings
from mbs.transient.run import Options, run
from tests.cases.laws import CONTACTS, NU308, OIL, SMALL_FIELD

SPEED = 100.0


@functools.cache
def law(outside="clamp"):
    return ContactLaw("series", CONTACTS, OIL, SMALL_FIELD, outside)


def bearing(outside="clamp", **changes):
    shape = Bearing(dataclasses.replace(NU308, diametral_clearance=20e-6), slices=9)
    force = BearingForce(shape, law(outside))
    return BearingElement("b", "shaft", "housing", shape, force, 330.0, films="memory", **changes)


@functools.cache
def kernel():
    """The three parts of a step of slices in C."""
    table, number, whole, array = ctypes.c_void_p, ctypes.c_double, ctypes.c_int64, ctypes.c_void_p
    return (
        function("ehd_film_slices_begin", table, number, whole, whole, whole, array, result=None),
        function("ehd_film_slices_loads", table, number, number, whole, *(array,) * 5, result=None),
        function("ehd_film_slices_commit", table, whole, array, array, result=None),
    )


def by_kernel(at, h, deltas):
    """Loads of slices over a course, by parabolas."""
    begin, loads, commit = kernel()
    count, slices = deltas.shape
    table, state = at.memory.table.address, at.memory.settled(deltas[0])
    memory, out, (tangent, *work) = np.zeros((MEMORY, slices)), np.empty((count, slices)), np.empty((3, slices))
    work, out[0] = np.concatenate(work), state.load
    resume(FilmState(deltas[0], state.change, state.load), memory)
    for k in range(1, count):
        last = 0.0 if k == 1 else h
        begin(table, last / h, k, MOST_KEPT, slices, memory.ctypes.data)
        places = [row.ctypes.data for row in (memory, deltas[k], out[k], tangent, work)]
        loads(table, h, last, slices, *places)
        commit(table, slices, memory.ctypes.data, out[k].ctypes.data)
    return out


def by_table(at, h, deltas):
    """The same from the table itself."""
    state = dataclasses.replace(at.memory.settled(deltas[0]), approach=deltas[0])
    out = [state.load]
    for delta in deltas[1:]:
        w, _, state = at.memory.advance(state, delta, h)
        out.append(w)
    return np.array(out)


@pytest.mark.parametrize(("frequency", "amplitude"), [(300.0, 2e-6), (3000.0, 1e-7), (1000.0, 1e-5)])
def test_slices_by_parabolas_are_those_of_the_table(frequency, amplitude):
    at = law().at(1.2, 330.0)
    random = np.random.default_rng(5)
    times = 1e-5 * np.arange(300)
    swing = np.sin(2.0 * math.pi * frequency * times)[:, None] * random.uniform(-1.0, 1.0, 100)
    deltas = random.uniform(-2e-5, 1e-5, 100) + amplitude * swing
    exact = by_table(at, 1e-5, deltas)
    # What parabolas leave out in third order; of light slices, whose load matters little, a few 1e-4.
    assert by_kernel(at, 1e-5, deltas) == pytest.approx(exact, rel=1e-3, abs=1e-6 * np.max(exact))


@pytest.mark.parametrize("layer", [0.7e-6, 2e-6])
def test_slices_on_an_oil_layer_lift_off_and_touch_as_those_of_the_table(layer):
    """Films end within a micrometre there: steps of parabolas that do not settle, and slices out of contact."""
    supplied = ContactLaw("series", CONTACTS, OIL, SMALL_FIELD, "clamp", supply=OilSupply(layer))
    at = supplied.at(1.2, 330.0)
    random = np.random.default_rng(6)
    swing = np.sin(2.0 * math.pi * 1500.0 * 1e-5 * np.arange(200))[:, None] * random.uniform(-2e-6, 2e-6, 100)
    deltas = at.memory.table.lift_off + random.uniform(-2e-6, 3e-6, 100) + swing
    exact = by_table(at, 1e-5, deltas)
    assert np.any(exact < 1e-6) and np.max(exact) > 1e3
    assert by_kernel(at, 1e-5, deltas) == pytest.approx(exact, rel=1e-3, abs=1e-3 * np.max(exact))


def test_a_slice_out_of_contact_has_no_stiffness():
    """A tangent without a load that changes would keep Newton's steps of a machine from settling."""
    supplied = ContactLaw("series", CONTACTS, OIL, SMALL_FIELD, "clamp", supply=OilSupply(1e-6))
    memory = supplied.at(1.2, 330.0).memory
    low = memory.table.lift_off
    for h in (1e-5, 1e-8):
        w, tangent, end = memory.advance(memory.settled(low), low - 1e-6, h)
        assert (w, tangent, end.approach) == (pytest.approx(0.0, abs=1e-20), 0.0, low)


@functools.cache
def model(films="memory", outside_speed=1.0):
    scene = read_scene("nu308_rigid")
    return assemble(scene, law="formula", films=films)


def trajectory(system, compiled, duration=2e-3, **changes):
    settings = dataclasses.replace(read_scene("nu308_flexible").run_up.settings, step=1e-5, sample=1e-5, **changes)
    balance = equilibrium(system, Operation(SPEED))
    start = balance.displacement * 1.02
    speed = SpeedProfile.constant(SPEED)
    return run(system, speed, duration, settings, (), start, options=Options(states=True, compiled=compiled))


@pytest.mark.slow
def test_steps_that_are_taken_back_leave_no_trace():
    free = trajectory(model().system, True)
    held = trajectory(model().system, True, tolerance=1e-11)
    assert held.halved > 0
    last = -1
    # Steps of half the length differ by what the steps are wrong themselves.
    assert held.states.displacement[last] == pytest.approx(
        free.states.displacement[last], abs=0.05 * np.max(np.abs(free.states.displacement[last]))
    )


def rotor(element, shaken=True):
    """A mass of 2 kg on a bearing, shaken along the load or not."""
    y, z = np.eye(6)[1], np.eye(6)[2]
    body = rigid_body("shaft", [Inertia(2.0, 0.01, 0.02)], ["y", "z"])
    shaker = Load("shaker", "shaft", 300.0 * y, profile=Harmonic(1500.0))
    return System([body], [], [Load("load", "shaft", 1000.0 * y + 300.0 * z), *([shaker] if shaken else [])], [element])


def test_steps_in_python_go_on_with_the_films_of_compiled_ones_and_back():
    """A law that refuses what is outside its map has no table beside its highest speed: such steps are in Python."""
    element = dataclasses.replace(bearing("error"), outer="ground", temperature=315.0)
    system, highest = rotor(element), law("error").speed_range[1] / element.rates[1]
    speed = SpeedProfile(Course((0.0, 5e-4, 1e-3), (0.994 * highest, 0.9999 * highest, 0.994 * highest)))
    settings = Settings(1e-5, 2e-4)  # tables of twenty steps, a sample, at once
    start = equilibrium(system, Operation(0.994 * highest)).displacement
    mixed, python = (
        run(system, speed, 1e-3, settings, (), start, options=Options(states=True, compiled=how))
        for how in (True, False)
    )
    assert 20 < mixed.compiled < 90 and mixed.steps == 100
    # Parabolas, 1e-5 of the force. Films that stay behind in one of the two make 5e-3 and more.
    assert mixed.forces[0] == pytest.approx(python.forces[0], abs=1e-4 * np.max(np.abs(python.forces[0])))


def test_compiled_films_keep_up_with_a_speed_that_rises_steeply():
    """Tables that are kept for eight steps whatever the speed does shake the rotor, by 0.95 m/s2; found: 8e-5."""
    element = dataclasses.replace(bearing(), outer="ground")
    system = rotor(element, shaken=False)
    begin, rise = 40.0, 1e4
    speed, settings = SpeedProfile(Course((0.0, 2e-3), (begin, begin + 2e-3 * rise))), Settings(1e-5, 1e-5)
    start = equilibrium(system, Operation(begin)).displacement
    compiled, python = (
        run(system, speed, 2e-3, settings, (), start, options=Options(states=True, compiled=how))
        for how in (True, False)
    )
    assert compiled.compiled == compiled.steps
    moved = np.max(np.abs(python.states.acceleration[10:]))
    assert compiled.states.acceleration == pytest.approx(python.states.acceleration, abs=1e-3 * moved)


class Placed(SpeedWindow):
    """A window whose tables are all there."""

    def __init__(self):
        super().__init__(STEP, 1, 50.0)

    def prepare(self, speeds, nodes, weights):
        return nodes, np.ones(nodes.size, dtype=bool), np.zeros_like(nodes)


def test_tables_are_kept_as_long_as_the_speed_allows():
    course = CourseOfFilms([Placed()], in_turns=True)
    found = {}
    for rise in (0.0, 2e-6, 1e-5, 3e-5, 1e-3):
        course.begin(100.0 * np.exp(rise * np.arange(20)))
        found[rise] = course.prepare(5, 20)[0].given("kept")
    assert all(kept.shape == (15,) and np.all(kept == kept[0]) for kept in found.values())
    assert [int(kept[0]) for kept in found.values()] == [MOST_KEPT, MOST_KEPT, 4, 2, 1]
    course.begin(np.array([100.0]))
    assert course.prepare(0, 1)[0].given("kept").tolist() == [1]


def test_slices_lag_behind_the_speed_by_nothing_on_the_mean():
    """Tables are mixed every `kept` steps, slices read them in turns: mean place of what they hold, at every step.

    Bounded is rounding; without places ahead the mean is 7 steps old, 0.0175 of the distance of two tables.
    """
    course = CourseOfFilms([Placed()], in_turns=True)
    steps, slices = 64, np.arange(24)
    speeds = 100.0 * np.exp(1e-5 * 0.6 * np.arange(steps))
    course.begin(speeds)
    found = course.prepare(0, steps)[0]
    nodes, weights, kept_for = (found.given(name) for name in ("nodes", "weights", "kept"))
    table, held = math.nan, np.full(slices.size, math.nan)
    right = np.log(speeds / 50.0) / STEP
    for step, kept in enumerate(kept_for.tolist()):
        if step % kept == 0:
            table = nodes[step, 0] + weights[step, 0]
        held[(step + slices) % kept == 0] = table
        if step >= 16:
            assert np.mean(held) == pytest.approx(right[step], abs=1e-9)
    assert kept == MOST_KEPT


def test_a_force_goes_from_step_to_step_as_its_bearing_does():
    element = bearing(start_angle=0.1)
    force, states, films, time = BearingForce(element.bearing, law()), None, None, 0.0
    pose = np.array([0.0, 12e-6, 3e-6, 0.0, 1e-5, 2e-5])
    for index, step in enumerate((1e-5, 1e-5, 1.1e-5, 4e-6)):
        moved, time = pose * (1.0 + 0.02 * index), time + step
        operation = Operation(SPEED + index, 0.3 * index, time)
        conditions = {
            "cage_angle": element.cage_angle(operation),
            "entrainment_speed": element.entrainment_speed(operation),
            "temperature": element.temperature,
        }
        at_rest = force.evaluate(moved, **conditions)
        if states is None:
            answer, states = element.advance(None, moved, np.zeros(6), operation)
            found, _ = force.advance(None, moved, step, **conditions)
            # The table's cubics, of some 1e-6 of the load; and a law of its own beside it.
            assert found.force == pytest.approx(at_rest.force, rel=1e-5, abs=1e-5)
            (films,) = states.films
            continue
        answer, states = element.advance(states, moved, np.zeros(6), operation)
        found, films = force.advance(films, moved, step, **conditions)
        assert found.force == pytest.approx(answer.force, rel=1e-12, abs=1e-12)
        assert found.stiffness == pytest.approx(answer.stiffness, rel=1e-12, abs=1e-12)
        assert np.max(np.abs(found.force - at_rest.force)) > 1e-3 * np.max(np.abs(at_rest.force))
    assert films.load.shape == (element.bearing.geometry.rollers, element.bearing.slices)


def test_the_stiffness_of_a_step_is_the_difference_quotient_of_its_force():
    force, at = BearingForce(bearing().bearing, law()), {"entrainment_speed": 1.2, "temperature": 330.0}
    pose = np.array([0.0, 12e-6, 3e-6, 0.0, 1e-5, 2e-5])
    _, films = force.advance(None, pose, 1e-5, **at)
    _, films = force.advance(films, 1.02 * pose, 1e-5, **at)
    moved, scale = 1.05 * pose, np.array([0.0, 1.0, 1.0, 0.0, 100.0, 100.0])
    found, _ = force.advance(films, moved, 1e-5, **at)
    for axis in (1, 2, 4, 5):
        h = 1e-10 * scale[axis] * np.eye(6)[axis]
        ahead, back = (force.advance(films, moved + side * h, 1e-5, **at)[0].force for side in (1.0, -1.0))
        quotient = (back - ahead) / (2.0 * h[axis])
        # Central differences over 1e-10 m of a C1 law: round-off of 1e-13 of the force, and the bend where slices turn.
        assert quotient == pytest.approx(found.stiffness[:, axis], abs=1e-5 * np.max(np.abs(found.stiffness[:, axis])))
    assert not np.any(found.damping)


def test_a_force_in_time_says_what_it_does_not_take():
    shape = Bearing(NU308)
    with pytest.raises(InputError, match=r"bearing force, advance: got the law 'hertz', which has no films"):
        BearingForce(shape, hertz(shape)).advance(None, np.zeros(6), 1e-5)
    force, at = BearingForce(shape, law()), {"entrainment_speed": 1.2, "temperature": 330.0}
    with pytest.raises(InputError, match="bearing force, entrainment_speed: got nan"):
        force.advance(None, np.zeros(6), 1e-5)
    with pytest.raises(InputError, match=r"bearing force, pose: got an array of shape \(5,\)"):
        force.advance(None, np.zeros(5), 1e-5, **at)
    with pytest.raises(InputError, match=r"bearing force, pose: got y = 1 m"):
        force.advance(None, np.eye(6)[1], 1e-5, **at)
    with pytest.raises(InputError, match=r"film memory, dt: got 0\.0 s"):
        force.advance(None, np.zeros(6), 0.0, **at)
    _, films = force.advance(None, np.zeros(6), 1e-5, **at)
    with pytest.raises(InputError, match="film memory, delta: got the shape"):
        BearingForce(shape, law(), slices=5).advance(films, np.zeros(6), 1e-5, **at)


def test_loads_above_the_map_are_refused_or_counted():
    deep = np.array([0.0, 1.2e-4, 0.0, 0.0, 0.0, 0.0])
    operation = Operation(SPEED)
    with pytest.raises(OutsideMapError, match="above the map"):
        bearing("error").advance(None, deep, np.zeros(6), operation)
    answer, _ = bearing().advance(None, deep, np.zeros(6), operation)
    assert np.all(np.isfinite(answer.force)) and answer.outside
    assert not bearing().advance(None, 0.1 * deep, np.zeros(6), operation)[0].outside


def test_what_has_no_memory_is_refused():
    shape = Bearing(NU308)
    with pytest.raises(InputError, match="films: got 'memory' with a law without films; allowed: laws map and formula"):
        BearingElement("b", "shaft", "housing", shape, BearingForce(shape, hertz(shape)), 330.0, films="memory")
    with pytest.raises(InputError, match="films: got 'memory' with centrifugal"):
        bearing(centrifugal=True)
