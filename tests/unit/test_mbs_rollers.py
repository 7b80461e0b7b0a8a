"""Rollers that are bodies in time: compiled answers against Python, films with a memory for each contact, and runs."""

from __future__ import annotations

import dataclasses
import functools
import math

import numpy as np
import pytest

from ehdmaps.errors import InputError, OutsideMapError
from ehdmaps.maps.law import ContactLaw
from mbs import assemble, read_scene
from mbs.bearings.bearing import Bearing
from mbs.bearings.bearing_block import ROLLERS
from mbs.bearings.bearing_element import BearingElement
from mbs.bearings.bearing_force import BearingForce
from mbs.bearings.laws import hertz
from mbs.bearings.memory_block import MEMORY_ROLLERS
from mbs.bearings.roller_contacts import RollerContacts
from mbs.bearings.roller_element import RollerElement
from mbs.model.blocks import FOUND, IN_PYTHON, NO_SOLUTION, Answers, Member, Moment
from mbs.model.elements import Operation
from tests.cases import blocks
from tests.cases.laws import CONTACTS, OIL, SMALL_FIELD

SPEED = 100.0
BEARING = Bearing.named("NU308", clearance=20e-6, slices=5)
RINGS = np.array([0.0, 18e-6, 4e-6, 0.0, 2e-5, -1e-5, 0.0, 1e-6, -2e-6, 0.0, 1e-6, 3e-6])


@functools.cache
def law(kind, outside="clamp"):
    contacts = CONTACTS if kind == "series" else [contact for contact in CONTACTS if contact.name == kind]
    return ContactLaw(kind, contacts, OIL, SMALL_FIELD, outside)


def element(films, outside="clamp", centrifugal=True):
    force = BearingForce(BEARING, law("series"))
    plain = BearingElement("b", "shaft", "housing", BEARING, force, 330.0, start_angle=0.3, centrifugal=centrifugal)
    single = hertz(BEARING, 100.0).single()
    laws = (single, single) if films == "dry" else (law("inner", outside), law("outer", outside))
    return RollerElement(plain, RollerContacts(BEARING, *laws), "rollers", "memory" if films == "memory" else "slow")


def displaced(seed=1):
    """Displacements of both rings and all rollers, and rates."""
    random = np.random.default_rng(seed)
    count = BEARING.geometry.rollers
    return np.concatenate((RINGS, random.uniform(-3e-6, 3e-6, count))), random.uniform(-1e-3, 1e-3, 12 + count)


class Compiled:
    """The block of one bearing, asked step by step."""

    def __init__(self, element, kind, speed=SPEED):
        self.kind, self.rows = kind, np.concatenate((kind.alone(element), kind.feels(element)))
        self.block = kind.gather([Member(element, 0, first=BEARING.geometry.rollers, alone=0)])
        self.block.begin(np.full(20, speed))
        self.arrays, sound = self.block.prepare(0, 20)
        assert sound.all()
        size = self.rows.shape[0]
        # What is left from other calls must not matter.
        self.answers = Answers(np.full(size, 7.0), np.full((size, size), 7.0), np.zeros(1, dtype=np.int64))

    def __call__(self, step, q, v, operation, by_v=0.0, accept=True):
        """Status, force and slope in the ports."""
        moment = Moment(step, operation.time, operation.speed, operation.angle, 1.0, by_v)
        status = blocks.answer(self.kind, self.arrays, moment, np.stack((self.rows @ q, self.rows @ v)), self.answers)
        if accept and self.kind.accept is not None:
            blocks.accept(self.kind, self.arrays, moment)
        slopes, rollers = self.answers.slopes.copy(), BEARING.geometry.rollers
        # Never written, as rollers do not touch each other: a run has zeros there from its beginning.
        slopes[:rollers, :rollers] *= np.eye(rollers)
        return status, self.rows.T @ self.answers.force, self.rows.T @ slopes @ self.rows


@pytest.mark.slow
@pytest.mark.parametrize(("films", "force", "slope"), [("dry", 1e-12, 1e-12), ("slow", 1e-8, 1e-6)])
def test_compiled_contacts_are_those_in_python(films, force, slope):
    """Dry to rounding; with films to what tables are wrong, see `mbs.bearings.cylinder`."""
    given, by_v = element(films), 3e-3
    compiled, (q, v) = Compiled(given, ROLLERS), displaced()
    for step, angle in enumerate((0.0, 0.2, 1.9)):
        operation = Operation(SPEED, angle, 1e-5 * step)
        status, found, slopes = compiled(step, q, v, operation, by_v)
        expected = given.evaluate(q, v, operation)
        assert status == FOUND
        assert np.all(np.isfinite(found)) and np.max(np.abs(expected.force[12:])) > 10.0
        assert found == pytest.approx(expected.force, abs=force * np.max(np.abs(expected.force)))
        wanted = expected.stiffness + by_v * expected.damping
        assert slopes == pytest.approx(wanted, abs=slope * np.max(np.abs(wanted)))


@pytest.mark.slow
def test_compiled_contacts_with_memory_are_those_in_python():
    given = element("memory")
    compiled, (q, v), states = Compiled(given, MEMORY_ROLLERS), displaced(), None
    for step in range(12):
        operation = Operation(SPEED, 0.4 + 1e-3 * step, 1e-5 * step)
        moved = q * (1.0 + 0.02 * math.sin(2e4 * math.pi * operation.time))
        expected, states = given.advance(states, moved, v, operation)
        asked = Operation(SPEED, operation.angle, operation.time)
        if step in (0, 6):  # a run begins, and goes on after steps in Python
            compiled.block.resume([states])
            continue
        compiled(step, 0.9 * moved, v, asked, accept=False)  # a trial leaves no trace
        status, found, slopes = compiled(step, moved, v, asked)
        assert status == FOUND
        # Parabolas of the table's cubics.
        assert found == pytest.approx(expected.force, abs=1e-5 * np.max(np.abs(expected.force)))
        assert slopes == pytest.approx(expected.stiffness, abs=1e-3 * np.max(np.abs(expected.stiffness)))
    ours, theirs = compiled.block.states()[0], states
    assert ours.time == theirs.time
    for got, wanted in zip(ours.films, theirs.films, strict=True):
        assert got.step == pytest.approx(wanted.step, rel=1e-9) and got.load.shape == wanted.load.shape
        assert got.load == pytest.approx(wanted.load, abs=1e-4 * np.max(wanted.load))
    far = np.zeros_like(q)
    far[1] = 1.0
    assert compiled(12, far, v, Operation(SPEED, 0.0, 1.3e-4), accept=False)[0] == NO_SOLUTION


def test_each_contact_answers_small_oscillations_as_the_linear_analyses_have_it():
    """Rings and rollers on their way, each by itself: every entry of the dynamic stiffness counts."""
    given = element("memory")
    u = given.plain.entrainment_speed(Operation(SPEED))
    rest = given.contacts.settled(RINGS[:6], cage_angle=0.3, entrainment_speed=u, temperature=330.0)
    at_rest = given.evaluate(rest, np.zeros_like(rest), Operation(SPEED))
    relaxation = given.relaxation(rest, Operation(SPEED))
    random = np.random.default_rng(3)
    ways = np.zeros((2, rest.size))
    ways[0, 1:3], ways[1, 12:] = (1.0, 0.5), random.uniform(-1.0, 1.0, rest.size - 12)
    for way in ways:
        for frequency in (500.0, 2500.0, 10000.0):
            steps, periods, amplitude = 80, 3, 1e-10
            h = 1.0 / (steps * frequency)
            states, forces = None, []
            for i in range(steps * periods + 1):
                moved = rest + amplitude * math.sin(2.0 * math.pi * frequency * i * h) * way
                answer, states = given.advance(states, moved, np.zeros_like(rest), Operation(SPEED, 0.0, i * h))
                forces.append(answer.force)
            last = np.array(forces[-steps:]) - forces[0]
            place = np.arange(steps * (periods - 1) + 1, steps * periods + 1) / steps
            found = -2j * np.exp(-2j * math.pi * place) @ last / steps / amplitude
            s = np.array([2j * math.pi * frequency])
            z = at_rest.stiffness + s[0] * at_rest.damping + relaxation.more(s)[0]
            # Eighty steps a period make some 2e-3 of the damper's part; cubics of the table the rest.
            assert found == pytest.approx(z @ way, abs=1e-2 * np.max(np.abs(z @ way)))


def test_closed_ways_give_no_work():
    """Random ways of rings and rollers out and back, with steps of up to a micrometre in 10 us."""
    given = element("memory", centrifugal=False)
    q, _ = displaced()
    random = np.random.default_rng(4)
    for size in (1e-8, 1e-7, 1e-6):
        walk = np.cumsum(random.uniform(-size, size, (40, q.size)) * (q != 0.0), axis=0)
        way = np.concatenate((np.zeros((1, q.size)), walk, walk[::-1], np.zeros((200, q.size))))
        states, before, work, turned = None, None, 0.0, 0.0
        for i, moved in enumerate(way):
            answer, states = given.advance(states, q + moved, np.zeros_like(q), Operation(SPEED, 0.0, 1e-5 * i))
            if before is not None:
                part = float(answer.force @ (moved - before))
                work, turned = work + part, turned + abs(part)
            before = moved
        # By the force at the end of each step, as the passivity of the law for steps of any size has it.
        assert work < 0.0 and abs(work) > 1e-6 * turned


def test_loads_above_the_map_are_refused_or_counted():
    deep = np.zeros(24)
    deep[1] = 2e-4
    with pytest.raises(OutsideMapError, match="above the map"):
        element("memory", "error").advance(None, deep, np.zeros(24), Operation(SPEED))
    answer, _ = element("memory").advance(None, deep, np.zeros(24), Operation(SPEED))
    assert np.all(np.isfinite(answer.force))
    # The law is called for each slice in Python and read from its table in compiled code, 1e-8 of the force apart.
    given = element("slow")
    for speed in (0.0, 5.0, SPEED):  # at rest, with a part of the film, with all of it
        wanted, compiled = given.evaluate(deep, np.zeros(24), Operation(speed)), Compiled(given, ROLLERS, speed)
        status, got, _ = compiled(0, deep, np.zeros(24), Operation(speed))
        assert (status, compiled.answers.outside[0], wanted.outside) == (FOUND, 1, True)
        np.testing.assert_allclose(got, wanted.force, rtol=0.0, atol=1e-7 * np.abs(wanted.force).max())
    strict = Compiled(element("slow", "error"), ROLLERS)
    assert strict(0, deep, np.zeros(24), Operation(SPEED))[0] == IN_PYTHON


def test_memory_needs_films():
    with pytest.raises(InputError, match="films: got 'memory' with a law without films; allowed: laws map and formula"):
        dry = element("dry")
        RollerElement(dry.plain, dry.contacts, "rollers", "memory")
    with pytest.raises(InputError, match="roller contacts, films: got the law 'hertz' without films; allowed: map"):
        element("dry").contacts.advance(
            None, displaced()[0], 0.0, cage_angle=0.0, entrainment_speed=1.0, temperature=330.0
        )


def test_each_contact_of_a_scene_has_the_law_of_its_raceway(small_map):
    scene = read_scene("nu308_rigid")
    bearings = [dataclasses.replace(entry, rollers_as_bodies=True, slices=5) for entry in scene.bearings]
    entry = assemble(scene.with_bearings(bearings), "map", small_map).system.elements[0].element
    for contact, name in zip(entry.contacts.laws, ("inner", "outer"), strict=True):
        assert [one.name for one in contact.contacts] == [contact.kind] == [name]
