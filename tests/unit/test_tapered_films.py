"""Films of tapered rollers: beside the cylindrical element, in scenes, and in runs in time."""

from __future__ import annotations

import dataclasses
import math
from pathlib import Path

import numpy as np
import pytest

from ehdmaps.errors import AnalysisError, InputError
from ehdmaps.jobs.make.table_law import table_map
from ehdmaps.physics.bearing import BearingGeometry
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.rollers.ribbed_geometry import ribbed_estimate
from ehdmaps.physics.rollers.tapered_geometry import TaperedGeometry
from mbs import assemble, parse_scene
from mbs.analyses.film_errors import film_course, film_error, film_errors, notable_from
from mbs.analyses.reach import fade_lines, fade_of
from mbs.bearings.bearing import Bearing
from mbs.bearings.bearing_element import BearingElement
from mbs.bearings.bearing_force import BearingForce
from mbs.bearings.locating.locating_block import FELT
from mbs.bearings.locating.locating_element import LocatingElement
from mbs.bearings.locating.normal_law import contact
from mbs.bearings.roller_contacts import RollerContacts
from mbs.bearings.slices_in_balance import relaxation_times, slice_relaxation
from mbs.bearings.tapered.line_film import LOADS, LineFilms, line_films
from mbs.bearings.tapered.rollers_in_balance import line_relaxation
from mbs.bearings.tapered.tapered_bearing import TaperedForce
from mbs.bearings.tapered.tapered_block import TAPERED, TaperedBlock
from mbs.linearised.linear import frequency_response, state_space
from mbs.linearised.modes import modes
from mbs.model.blocks import FOUND, Member, Moment
from mbs.model.contacts import slow_springs
from mbs.model.elements import Input, Operation, Sensor
from mbs.model.equilibrium import equilibrium
from tests.cases import commands
from tests.cases.c_blocks import AskedBlock
from tests.unit.test_tapered_runs import PLACE, RATE
from tests.unit.test_tapered_scenes import GEOMETRY, O_PAIR, text

WARM = 333.15
OIL = '[lubricant]\nname = "FVA3"\n'
POSE = np.array([0.0, 12e-6, 5e-6, 0.0, 0.0, 0.0])
CYLINDER = BearingGeometry("plain", 50e-3, 70e-3, 10e-3, 15e-3, 17, 0.0)
U = 3.0


@pytest.fixture(scope="module")
def emap():
    """Map in memory of one speed and temperature of a cylindrical roller bearing."""
    return table_map(CYLINDER, Lubricant.named("FVA3"), LOADS, (0.9 * U, 1.1 * U), (WARM, WARM))


@pytest.fixture(scope="module")
def films(emap):
    return line_films((emap.law("inner", "clamp"), emap.law("outer", "clamp")), 15e-3, U, WARM)


def scene(law="table", more="", films=None, **keys):
    given = text(**(keys or O_PAIR)).replace("[operation]", OIL + "[operation]") + more
    return assemble(parse_scene(given, "rotor", "rotor.toml"), law, films=films)


@pytest.mark.parametrize(
    ("angle", "profile", "tilt", "within"),
    [
        # the law of both contacts in series is made of points, its parts are tables: 1e-7 of each
        (0.0, "straight", 0.0, (1e-7, 1e-6, 1e-6)),
        # normals that lean: 1 - cos of 1e-3 and its square root by the tangential way of the ring
        (1e-3, "straight", 0.0, (1e-3, 1e-3, 1e-3)),
        # a roller moves as a body, where each slice of the other element finds its own place between the rings
        (0.0, "iso", 2e-4, (1e-4, 3e-4, 2e-2)),
    ],
)
def test_without_an_angle_it_is_the_cylindrical_element_with_these_films(emap, films, angle, profile, tilt, within):
    force = TaperedForce(TaperedGeometry("plain", 10e-3, 15e-3, 60e-3, 17, angle), films=films, profile=profile)
    pose = POSE + np.array([0.0, 0.0, 0.0, 0.0, 0.5 * tilt, tilt])
    bearing = Bearing(CYLINDER, profile, 21)
    other = BearingForce(bearing, emap.law("series", "clamp"))
    theirs = other.evaluate(pose, np.zeros(6), entrainment_speed=U, temperature=WARM)
    for ours, expected, part in zip(force(pose), (theirs.force, theirs.stiffness, theirs.damping), within, strict=True):
        radial = (slice(1, 3),) * ours.ndim
        assert np.max(np.abs(ours - expected)[radial]) < part * np.max(np.abs(expected[radial]))


def test_a_scene_has_the_point_of_the_bearing_alone(capsys, tmp_path, monkeypatch):
    """Both read the same law: a mass that one bearing holds, beside `mbs bearing` at the same load."""
    monkeypatch.chdir(tmp_path)
    one = text(right='kind = "x"').split("[[bearings]]")
    given = one[0] + "[[bearings]]" + one[1]
    given = given.replace('freedoms = ["x", "y", "z", "theta_y", "theta_z"]', 'freedoms = ["x", "y", "z"]')
    given = given.replace("[operation]", OIL + "[operation]").replace(f"{500.0} rad/s", "3000 rpm")
    push = '[[loads]]\nname = "push"\non = "rotor:left"\nforce = ["3 kN", "2 kN", "0 N"]\n'
    machine = assemble(parse_scene(given + push, "rotor", "rotor.toml"), "table")
    balance = equilibrium(machine.system, machine.operation)
    asked = ("32208", "--load", "2 kN", "--axial", "3 kN", "--speed", "3000 rpm", "--temperature", "60 degC")
    status, out, _ = commands.run(capsys, "bearing", *asked, "--law", "table", "-o", "b.csv")
    assert status == 0 and "film table at radius and speed of the middle, inlet heat, rib dry" in out
    head, row = [line.split(",") for line in Path("b.csv").read_text("utf-8").splitlines() if not line.startswith("#")]
    found = {name.split(" ")[0].split("[")[0]: value for name, value in zip(head, row, strict=True)}
    for name, axis in (("along", 1), ("axial", 0)):
        # digits of the file, and of both equilibria
        stiffness, damping = balance.element_stiffness[0][axis, axis], balance.element_damping[0][axis, axis]
        assert float(found[f"stiffness_{name}"]) == pytest.approx(stiffness, rel=1e-7)
        assert float(found[f"damping_{name}"]) == pytest.approx(damping, rel=1e-7)
        assert float(found[f"displacement_{name}"]) == pytest.approx(balance.displacement[axis], rel=1e-7)


def test_films_stiffen_a_pair_that_displacement_preloads():
    """Both films of both rows are thicker than the lines are flattened by 0.2 um of the way along the axis."""
    dry, wet = scene("hertz"), scene("table")
    at_dry, at_wet = (equilibrium(one.system, one.operation) for one in (dry, wet))
    assert 1.1 * abs(at_dry.forces[0][0]) < abs(at_wet.forces[0][0]) < 3.0 * abs(at_dry.forces[0][0])
    assert modes(at_wet).damping_ratio.min() > 1e-5
    assert wet.law.count("films with memory, ribs dry") == 1
    assert "FVA3, inlet heat, flooded, smooth surfaces" in wet.law


def test_what_has_no_films_is_said():
    with pytest.raises(InputError, match=r"bearing 'left': films need the oil of the scene; add \[lubricant\]"):
        assemble(parse_scene(text(**O_PAIR), "rotor", "rotor.toml"), "table")
    hot = parse_scene(text(**O_PAIR).replace("[operation]", OIL + "[operation]"), "rotor", "rotor.toml")
    with pytest.raises(InputError, match=r"bearing 'left', -58 degC: "):
        assemble(dataclasses.replace(hot, temperature=215.15), "table")

    def none(*_):
        raise InputError("no film here")

    element = dataclasses.replace(scene().system.elements[0].element, films=none)
    with pytest.raises(AnalysisError, match=r"bearing 'left': no films at 4775 rpm of the system \(no film here\)"):
        element.evaluate(PLACE, RATE, Operation(500.0))
    assert element.evaluate(PLACE, RATE, Operation(0.0)).force[0] < 0.0  # dry where nothing rolls


def answers(block, speeds, step):
    """Force and by_q K + by_v C of the only bearing of a block at a step of some speeds."""
    data, sound = block.prepare(step, step + 1)
    assert sound[0]
    asked = AskedBlock(TAPERED, data, 5)
    assert asked.answer(Moment(0, 0.0, float(speeds[step]), 0.3, 1.0, 1e3), [PLACE[FELT], RATE[FELT]]) == FOUND
    return asked.found


def test_compiled_block_is_the_element_with_films():
    """At one speed the same table; over the speed straight in ln g between nodes that are 4 % apart, which is wrong by
    at most (0.67 * 0.04)^2/8 = 9e-5 of the films, and these are a tenth of the approach."""
    element = scene().system.elements[0].element
    assert isinstance(element, LocatingElement)
    block, one = TaperedBlock([Member(element, 0, 0)]), np.array([400.0])
    block.begin(one)
    for speeds, steps, within in (
        (one, [0], 1e-9),
        (np.linspace(0.0, 1000.0, 240), [60, 239], 1e-4),
        (np.linspace(100.0, 900.0, 240), [3, 160], 1e-4),
    ):
        block.begin(speeds)
        for step in steps:
            found = answers(block, speeds, step)
            theirs, _ = element.advance(None, PLACE, RATE, Operation(float(speeds[step]), 0.3))
            slopes = (theirs.stiffness + 1e3 * theirs.damping)[np.ix_(FELT, FELT)]
            assert np.max(np.abs(found.force - theirs.force[FELT])) < within * np.max(np.abs(theirs.force))
            assert np.max(np.abs(found.slopes - slopes)) < 5.0 * within * np.max(np.abs(slopes))
            assert not found.outside[0]
    crushed = LineFilms(*[element.law_at(400.0).inner] * 2, loads=(0.0, 1.0))
    assert dataclasses.replace(element, films=lambda *_: crushed).evaluate(PLACE, RATE, Operation(400.0)).outside


def test_films_of_slow_motion_say_from_where_they_are_wrong(emap, films):
    """Springs in series have the dampers that act in slow motion, so that their sum is C, to what the table of damping
    is wrong at its corners. Without an angle the error is that of the cylindrical element, whose slices have both
    contacts in series: one relaxation time for two that are alike within a tenth."""
    machine = scene()
    balance = equilibrium(machine.system, machine.operation)
    element = machine.system.elements[0].element
    ports = machine.system.elements[0].transform @ balance.displacement
    condensed = element.small_motions(ports, machine.operation)
    relaxation = slow_springs(condensed.contacts, condensed.pose)
    damping, free = balance.element_damping[0], np.ix_(FELT, FELT)
    assert np.max(np.abs(relaxation.damping - damping)[free]) < 1e-6 * np.max(np.abs(damping))
    rest = film_errors(machine, balance.displacement, Operation(0.0))
    assert rest[0].at_rest and rest[0].at(1e3) == 0.0
    assert film_errors(scene("hertz"), balance.displacement, machine.operation) == []

    plain = TaperedForce(TaperedGeometry("plain", 10e-3, 15e-3, 60e-3, 17, 0.0), profile="straight")
    ours = LocatingElement("ours", "ring", "ground", plain, films=lambda *_: films)
    bearing = Bearing(CYLINDER, "straight", 21)
    theirs = BearingElement(
        "theirs", "ring", "ground", bearing, BearingForce(bearing, emap.law("series", "clamp")), WARM, films="slow"
    )
    at = Operation(U / CYLINDER.entrainment_speed(1.0))
    one, other = film_error(ours, POSE, at, "slow"), film_error(theirs, POSE, at, "slow")
    frequencies, plain_error = np.geomspace(100.0, 1e4, 5), dataclasses.replace(other, contacts=None)
    np.testing.assert_allclose(one.error(frequencies), plain_error.error(frequencies), rtol=0.1)
    assert one.frequency == pytest.approx(plain_error.frequency, rel=0.1)
    # with memory what is left is that of the relaxing contacts themselves
    kept = film_error(ours, POSE, at, "memory").error(frequencies)
    theirs = dataclasses.replace(film_error(theirs, POSE, at, "memory"), contacts=None)
    np.testing.assert_allclose(kept, theirs.error(frequencies), rtol=0.1)
    assert film_errors(machine, balance.displacement, machine.operation)[0].films == "memory"
    (line,) = film_course(machine, (500.0,))
    (at_memory,) = notable_from(machine, np.array([500.0]))
    (at_slow,) = notable_from(scene(films="slow"), np.array([500.0]))
    assert line.startswith("films with memory: ") and f" {at_memory:.4g} Hz at " in line
    assert at_slow < at_memory


def by_hand(force, cage_angle, s):
    """Z(s) (6, 6) by the complex stiffness of each slice, with the place of each roller eliminated at s."""
    shape, rows, found = force.shape, force.last_rows, np.zeros((6, 6), dtype=np.complex128)
    for angle, row in zip(force.angles + cage_angle, rows, strict=True):
        place, ring, parts = row[9:12], row[12:15], np.zeros((2, 3, 3), dtype=np.complex128)
        sides = ((shape.cone, ring - place, "inner", 0), (shape.cup, place, "outer", 1))
        for normal, moved, name, side in sides:
            normals = np.array([(*normal, lever) for lever in shape.levers])
            approach = normals @ moved - shape.profile
            law, times = getattr(force.films, name), relaxation_times(force.films.points[side], approach)
            for n, g, time in zip(normals, approach, times, strict=True):
                _, k, c = contact(law, g)
                parts[side] += (k + s * c / (1.0 + s * time)) / shape.levers.size * np.outer(n, n)
        for m in range(shape.ribs.levers.size):
            n, g = np.array([*shape.ribs.normals[m], shape.ribs.levers[m]]), 0.0
            g = n @ (place if shape.ribs.outer[m] else ring - place) - shape.ribs.plays[m]
            parts[int(shape.ribs.outer[m])] += 1.5 * shape.ribs.laws[m] * math.sqrt(max(g, 0.0)) * np.outer(n, n)
        own = parts[0] - parts[0] @ np.linalg.pinv(parts.sum(axis=0), 1e-12) @ parts[0]
        c, s_angle, radius = math.cos(angle), math.sin(angle), shape.pitch_radius
        turn = np.array([0.0, 0.0, 0.0, 0.0, -s_angle, c])
        by_pose = np.array([np.eye(6)[0] - radius * turn, [0.0, c, s_angle, 0.0, 0.0, 0.0], turn])
        found += by_pose.T @ own @ by_pose
    return found


def scaled(matrix, stiffness):
    """Entries of five freedoms over the roots of the diagonal of K."""
    size = np.sqrt(np.diag(stiffness))[FELT]
    return matrix[np.ix_(FELT, FELT)] / np.outer(size, size)


@pytest.mark.parametrize("geometry", [GEOMETRY, ribbed_estimate("NUP210")])
def test_memory_is_that_of_all_slices_with_rollers_in_balance(films, geometry):
    """At poses by chance, most with rollers without load. Both are exact; K of the kernel has balances to 1e-13 of the
    loads, and ends of tables bend: 1e-7. A roller that hardly carries takes part by 1e-9 of the damping."""
    force, random = TaperedForce(geometry).with_films(films), np.random.default_rng(3)
    for _ in range(3):
        pose = random.uniform(-1.0, 1.0, 6) * np.array([8e-6, 15e-6, 15e-6, 0.0, 1e-4, 1e-4])
        pose[0] += 12e-6 * math.copysign(1.0, geometry.contact_angle)
        _, stiffness, damping = force(pose, cage_angle=0.1, inner_speed=300.0)
        relaxation = line_relaxation(force, None, {"cage_angle": 0.1})
        previous = np.zeros((5, 5))
        for frequency in (1e-3, 100.0, 1e3, 4e3, 2e4):
            s = 2j * math.pi * frequency
            found = scaled(stiffness + s * damping + relaxation.more(np.array([s]))[0], stiffness)
            np.testing.assert_allclose(found, scaled(by_hand(force, 0.1, s), stiffness), rtol=0.0, atol=1e-7)
            # it takes energy in all motions, and stiffens in all as they become faster
            assert np.linalg.eigvalsh(found.imag)[0] > 0.0
            assert np.linalg.eigvalsh(found.real - previous)[0] > -1e-12
            previous = found.real
        # slow motion stays: the rest is of second order, omega theta of the longest time
        omega, damped = 2e-3 * math.pi, scaled(damping, stiffness)
        slow = scaled(relaxation.more(np.array([1j * omega]))[0], stiffness)
        assert np.max(np.abs(slow)) < 1e-6 * omega * np.max(damped)
        assert np.max(np.abs(scaled(relaxation.damping, stiffness) - damped)) < 1e-8 * np.max(damped)
    assert np.linalg.norm(found.real) > 1.02 * np.linalg.norm(scaled(stiffness, stiffness))


def test_without_an_angle_memory_is_that_of_cylindrical_rollers_as_bodies(emap, films):
    """The same laws of both contacts and their times, and rollers without mass between: only that laws are tables here,
    1e-6 of k and c. With both contacts in series as one law, and one time, it is 3e-3."""
    plain = TaperedForce(TaperedGeometry("plain", 10e-3, 15e-3, 60e-3, 17, 0.0), films=films, profile="straight")
    bearing, radial, at = Bearing(CYLINDER, "straight", 21), np.ix_([1, 2], [1, 2]), (U, WARM)
    conditions = dict(zip(("entrainment_speed", "temperature"), at, strict=True), cage_angle=0.0)
    contacts = RollerContacts(bearing, emap.law("inner", "clamp"), emap.law("outer", "clamp"))
    place = contacts.settled(POSE, **conditions)
    _, k, c = contacts(place, **conditions)
    bodies = slice_relaxation(contacts.sides(place, **conditions))
    series = BearingForce(bearing, emap.law("series", "clamp"))
    element = BearingElement("series", "ring", "ground", bearing, series, WARM, films="memory")
    turning = Operation(U / CYLINDER.entrainment_speed(1.0))
    one = element.evaluate(POSE, np.zeros(6), turning)
    relaxation = element.relaxation(POSE, turning)
    _, stiffness, damping = plain(POSE)
    ours = line_relaxation(plain, None, {"cage_angle": 0.0})
    for s in 2j * math.pi * np.array([100.0, 1e3, 4e3]):
        found = (stiffness + s * damping + ours.more(np.array([s]))[0])[radial]
        whole = k + s * c + bodies.more(np.array([s]))[0]
        rollers = whole[12:, 12:]
        theirs = (whole[:6, :6] - whole[:6, 12:] @ np.linalg.solve(rollers, whole[12:, :6]))[radial]
        assert np.max(np.abs(found - theirs)) < 1e-6 * np.max(np.abs(theirs))
        theirs = (one.stiffness + s * one.damping + relaxation.more(np.array([s]))[0])[radial]
        assert np.max(np.abs(found - theirs)) < 3e-3 * np.max(np.abs(theirs))


def test_modes_and_states_of_a_pair_have_the_memory_of_all_slices():
    """Each eigenvalue is where Z of the machine, put together by hand, is singular: 1e-8 of its square for the first
    order by which few states become all slices. States have the responses within 1e-7, as of cylindrical rollers."""
    machine, slow = scene(), scene(films="slow")
    balance, other = (equilibrium(one.system, one.operation) for one in (machine, slow))
    np.testing.assert_array_equal(balance.displacement, other.displacement)
    assert other.relaxations == (None, None) and slow.law.count("slow films, ribs dry") == 1
    rest = [each.element.relaxation(np.zeros(6), Operation()) for each in machine.system.elements]
    assert [one.rows.shape for one in rest] == [one.rows.shape for one in balance.relaxations]
    assert not np.any(rest[0].rows)
    found, plain, mass = modes(balance), modes(other), machine.system.mass
    assert not found.lost and np.all(found.damping_ratio < plain.damping_ratio)
    for value in found.eigenvalues[found.eigenvalues.imag > 0.0]:
        whole = value**2 * mass + value * balance.damping + balance.stiffness
        for index, connected in enumerate(machine.system.elements):
            element, ports = connected.element, connected.transform @ balance.displacement
            force, angle = element.force_at(machine.operation), element.conditions(machine.operation)["cage_angle"]
            element.evaluate(ports, np.zeros(6), machine.operation)
            slices = by_hand(force, angle, value)
            slices -= balance.element_stiffness[index] + value * balance.element_damping[index]
            whole = whole + connected.transform.T @ slices @ connected.transform
        assert np.min(np.abs(np.linalg.eigvals(np.linalg.solve(mass, whole)))) < 1e-8 * abs(value) ** 2
    push = [Input("push", "rotor:left", np.array([1.0, 1.0, 0.0, 0.0, 0.0, 0.0]))]
    seen = [Sensor("seen", "rotor:right", np.array([0.0, 1.0, 0.0, 0.0, 0.0, 0.0]))]
    space, frequencies = state_space(balance, push, seen), np.geomspace(50.0, 1e4, 20)
    direct, unit = frequency_response(balance, push, seen, frequencies), np.eye(space.A.shape[0])
    states = [space.C @ np.linalg.solve(2j * math.pi * f * unit - space.A, space.B) + space.D for f in frequencies]
    assert np.all(np.abs(np.array(states) - direct) <= 1e-7 * np.abs(direct).max(axis=0))


def test_it_is_said_below_which_speed_films_fade():
    """The lowest speed of the law, by the speed of the bearing: by definition."""
    model = scene()
    fade, bearing = fade_of(model), model.on_rings[0]
    assert fade.source == "the film table"
    assert fade.entrainment_speed == bearing.law_at(10.0).points[0].law.speed_range[0]
    (line,) = fade_lines(model, np.array([0.5 * fade.speed]))
    assert "below the film table" in line and not fade_lines(model, np.array([1.1 * fade.speed]))
