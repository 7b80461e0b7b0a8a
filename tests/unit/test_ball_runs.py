"""Ball bearings in runs in time: compiled code against the element in Python, and their work on closed paths."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest

from ehdmaps.errors import AnalysisError
from mbs import assemble, parse_scene, read_scene, statics
from mbs.bearings.balls.ball_block import BALLS, BallBlock
from mbs.bearings.locating.locating_block import FELT
from mbs.bearings.locating.locating_element import LocatingStates
from mbs.bearings.locating.locating_force import LAST
from mbs.bearings.locating.normal_law import contact
from mbs.model.blocks import FOUND, Member, Moment
from mbs.model.elements import Operation
from mbs.model.equilibrium import equilibrium
from mbs.model.profiles import SpeedProfile
from mbs.settings import Settings
from mbs.transient.run import Options, run
from tests.cases import commands
from tests.cases.c_blocks import AskedBlock
from tests.unit.test_ball_scenes import LAW, text

RPM = math.pi / 30.0
PLACE = np.array([95e-6, -3e-6, 1e-6, 0.0, 2e-5, -4e-5])
RATE = np.array([1e-3, -2e-3, 1e-3, 0.0, 0.1, 0.2])


def drive(law):
    return assemble(read_scene("electric_drive"), law)


def states_of(element):
    """States before the first step."""
    return LocatingStates(0.0, np.zeros((element.force.geometry.balls, LAST)), 0.0, 0.0, 0.0, np.zeros((1, 1)))


def answers(block, speeds, step, angle, place=PLACE, rate=RATE):
    """Force, by_q K + by_v C and whether outside, of the only bearing of a block at a step of some speeds."""
    data, sound = block.prepare(step, step + 1)
    assert sound[0]
    asked, moment = AskedBlock(BALLS, data, 5), Moment(0, 0.0, float(speeds[step]), angle, 1.0, 1e3)
    assert asked.answer(moment, [place[FELT], rate[FELT]]) == FOUND
    asked.accept(moment)
    return asked.found


@pytest.mark.parametrize(("law", "rpm"), [(LAW, 0.0), (LAW, 12e3), (LAW, -12e3), ("table", 6e3)])
def test_compiled_block_is_the_element(law, rpm):
    """Both end in the balance of the same balls, to 1e-13 of its forces: some 1e-9 where it is stiff across them."""
    element = drive(law).balls[1]
    block, speeds = BallBlock([Member(element, 0, 0)]), np.array([rpm * RPM])
    block.begin(speeds)
    block.resume([states_of(element)])
    found = answers(block, speeds, 0, 0.3)
    theirs, _ = element.advance(states_of(element), PLACE, RATE, Operation(float(speeds[0]), 0.3))
    slopes = theirs.stiffness + 1e3 * theirs.damping
    np.testing.assert_allclose(found.force, theirs.force[FELT], rtol=1e-9, atol=1e-9 * np.abs(theirs.force).max())
    np.testing.assert_allclose(found.slopes, slopes[np.ix_(FELT, FELT)], rtol=1e-8, atol=1e-9 * np.abs(slopes).max())
    assert bool(found.outside[0]) is theirs.outside


def test_films_are_blended_over_the_speed():
    """Straight in ln g between nodes that are 4 % of the speed apart: g = approach + h, h with some u^0.67, is wrong by
    at most (0.67 * 0.04)^2/8 = 9e-5 of itself, and the load by 1.5 times as much."""
    element = drive("table").balls[0]
    block, speeds = BallBlock([Member(element, 0, 0)]), np.linspace(100.0, 1300.0, 240)
    block.begin(speeds)
    block.resume([states_of(element)])
    worst = 0.0
    for step in (3, 80, 160, 238):
        found = answers(block, speeds, step, 0.3)
        block.resume([states_of(element)])
        theirs, _ = element.advance(states_of(element), PLACE, RATE, Operation(float(speeds[step]), 0.3))
        worst = max(worst, float(np.max(np.abs(found.force - theirs.force[FELT])) / np.max(np.abs(theirs.force))))
    assert 1e-12 < worst < 1.2e-4


def test_films_fade_below_the_slowest_of_their_table():
    """Without a step there (part - 1 is below 1e-17), to dry contacts without damping at rest (part is 1e-8)."""
    bearing = drive("table").balls[0]
    rate = bearing.force.geometry.entrainment_speed(bearing.inner_spin, bearing.outer_spin)
    slowest = bearing.films.slowest / rate
    below, at, still = (bearing.law_at(slowest * part) for part in (1.0 - 1e-6, 1.0, 1e-3))
    for approach in (-0.1e-6, 0.5e-6, 4e-6):
        one, other = (contact(law.inner, approach) for law in (below, at))
        assert one == pytest.approx(other, rel=1e-9, abs=1e-9)
    load, stiffness, damping = contact(still.inner, 4e-6)
    dry = contact(bearing.law_at(0.0).inner, 4e-6)
    assert (load, stiffness) == pytest.approx(dry[:2], rel=1e-6) and 0.0 < damping < 1e-4


@pytest.mark.slow
def test_runs_pass_through_rest():
    """In Python films are those of each step: between nodes in compiled code they are within 1e-4 of the load."""
    machine = drive("table")
    rest = equilibrium(machine.system, Operation(20.0 * RPM))
    speed, settings = SpeedProfile.ramp(20.0 * RPM, -20.0 * RPM, 2e-3), Settings(step=5e-5, sample=1e-4)
    ours, theirs = (
        run(machine.system, speed, 2e-3, settings, displacement=rest.displacement, options=Options(compiled=compiled))
        for compiled in (True, False)
    )
    assert ours.compiled > 0.8 * ours.steps
    for one, other in zip(ours.forces, theirs.forces, strict=True):
        np.testing.assert_allclose(one, other, atol=1e-4 * np.abs(other).max())


ONE = """
schema = 1
[operation]
speed = "{speed}"
temperature = "60 degC"
[[bodies]]
name = "rotor"
freedoms = ["x", "y", "z", "theta_y", "theta_z"]
spin = {spins[0]}
mass = "2 kg"
polar_inertia = "0.002 kg m^2"
transverse_inertia = "0.002 kg m^2"
[[bodies]]
name = "ring"
freedoms = ["x"]
spin = {spins[1]}
mass = "1 kg"
[[springs]]
name = "seat"
on = "ring"
stiffness = {{ x = "1e8 N/m" }}
[[loads]]
name = "load"
on = "rotor"
force = {force}
moment = {moment}
[[bearings]]
name = "only"
bearing = "6208"
inner = "rotor"
outer = "ring"
{clearance}
"""
NONE, NO_MOMENT = ["0 N"] * 3, ["0 N m"] * 3
LOOSE = 'diametral_clearance = "15 um"'


@pytest.mark.parametrize(
    ("speed", "spins", "force", "moment", "clearance", "angle"),
    [
        ("3000 rpm", (1, 0), ["2 kN", "0 N", "0 N"], NO_MOMENT, "", 0.0),
        ("3000 rpm", (1, 0), NONE, ["0 N m", "5 N m", "2 N m"], LOOSE, 0.0),
        ("0 rpm", (1, 0), NONE, NO_MOMENT, LOOSE, 0.0),
        ("20000 rpm", (0, 1), ["200 N", "1 kN", "0 N"], NO_MOMENT, LOOSE, 0.0),
        ("1e5 rpm", (1, 0), ["1 kN", "500 N", "0 N"], NO_MOMENT, LOOSE, 0.0),
        ("10000 rpm", (1, 0), ["2 kN", "500 N", "0 N"], NO_MOMENT, "", 60.0),
        ("10000 rpm", (1, 0), ["-2 kN", "500 N", "0 N"], NO_MOMENT, "", 60.0),
        ("3000 rpm", (1, 0), ["0 N", "10 MN", "0 N"], NO_MOMENT, "", 0.0),
    ],
    ids=["axial", "moment", "none", "outer", "fast", "steep", "wrong way", "crushed"],
)
def test_extremes_have_a_value_or_a_refusal(speed, spins, force, moment, clearance, angle):
    """Loads are in balance to 1e-8, and compiled code answers there; or an error of this package."""
    given = ONE.format(speed=speed, spins=spins, force=force, moment=moment, clearance=clearance).replace("'", '"')
    scene = parse_scene(given, "one", "one.toml")
    elements = [
        dataclasses.replace(e, geometry=dataclasses.replace(e.geometry, contact_angle=math.radians(angle)))
        for e in scene.elements
        if hasattr(e, "geometry")
    ]
    machine = assemble(dataclasses.replace(scene, elements=elements), LAW)
    element, refused = machine.balls[0], force[0] == "-2 kN" or force[1] == "10 MN"
    if refused:
        with pytest.raises(AnalysisError, match=r"no equilibrium"):
            equilibrium(machine.system, machine.operation)
        return
    found = equilibrium(machine.system, machine.operation)
    asked = np.asarray(machine.scene.loads[0].force)
    np.testing.assert_allclose(found.forces[0], -asked, atol=1e-8 * np.abs(asked).max() + 1e-12)
    place = machine.system.relative("rotor", "ring") @ found.displacement
    block, speeds = BallBlock([Member(element, 0, 0)]), np.array([machine.operation.speed])
    block.begin(speeds)
    block.resume([element.advance(None, place, np.zeros(6), machine.operation)[1]])
    compiled = answers(block, speeds, 0, 0.0, place, np.zeros(6))
    np.testing.assert_allclose(compiled.force, -asked[FELT], atol=1e-6 * np.abs(asked).max() + 1e-12)
    assert np.all(np.isfinite(compiled.slopes))


def test_balls_are_in_results_and_pictures():
    """Of statics: forces of both bearings are the preload and the weight, and each has a panel with nine bars."""
    done = statics(drive("table"))
    data = done.dataset
    assert data["bearing"].values.tolist() == ["drive", "end"]
    assert float(data["bearing_force"].sum("bearing").values[0]) == pytest.approx(0.0, abs=1e-6)
    assert data["bearing_damping"].values[0, 1, 1] > 10.0
    panels = [axes for axes in done.plot().axes if axes.get_visible()]
    assert [len(axes.patches) for axes in panels] == [9, 9]


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("statics", "--law", "hertz", "--physics", "inlet-heat"), "--physics: got inlet-heat without a map; allowed"),
        (("modes", "--law", "hertz", "--films", "memory"), "without a law that has films; allowed: with --map, --law"),
        (("statics", "--supply", "5 um", "--law", "hertz"), "without a law that has films; allowed: with --map, --law"),
        (("statics", "--structural-law", "fe"), "without roller bearings like NU; allowed: none of it, balls and"),
    ],
)
def test_what_balls_do_not_take_says_what_does(capsys, words, said):
    status, _, err = commands.run(capsys, words[0], "electric_drive", *words[1:])
    assert status == 2 and said in " ".join(err.split())


@pytest.mark.slow
def test_passing_balls_shake_at_their_order():
    """At a steady speed without unbalance all that moves is the cage: the force varies at multiples of Z times its
    speed, here in 16 whole periods, so that lines beside them hold what settles and no leakage."""
    loose = 'diametral_clearance = "12 um"'
    machine = assemble(parse_scene(text(left=loose, right=loose), "rotor", "rotor.toml"), LAW)
    speed, order, count = 150.0, machine.balls[0].excitation.order, 256
    period = 2.0 * math.pi / (order * speed)
    rest = equilibrium(machine.system, Operation(speed))
    settings = Settings(step=period / 128, sample=period / 16)
    course = SpeedProfile.constant(speed)
    done = run(machine.system, course, 0.2 + 16 * period, settings, displacement=rest.displacement)
    names = [entry.element.name for entry in machine.system.elements]
    force = done.forces[names.index("left")][-count:, 2]
    lines = np.abs(np.fft.rfft(force - force.mean()))
    assert np.argmax(lines) == 16
    assert lines[16] > 10.0 * np.delete(lines, [16, 32, 48, 64, 80, 96, 112, 128]).max()


@pytest.mark.slow
@pytest.mark.parametrize("hypothesis", ["outer race control", "inner race control"])
def test_energy_of_a_run_closes(hypothesis):
    """Balls lift off and come back in a run-up: work is what contacts store, dampers take, and cage and speed bring in,
    to the trapezoidal rule. That is of second order: a fourth of the step leaves a sixteenth."""
    left = f'diametral_clearance = "12 um"\ngeometry = {{ hypothesis = "{hypothesis}" }}'
    machine = assemble(parse_scene(text(left=left), "rotor", "rotor.toml"), LAW)
    rest = equilibrium(machine.system, Operation(300.0))
    start = rest.displacement + 4e-6 * (np.arange(rest.displacement.size) == 1)
    course, left = SpeedProfile.ramp(300.0, 900.0, 0.04), []
    for steps in (1000, 4000):
        done = run(machine.system, course, 0.04, Settings(step=0.04 / steps, sample=4e-4), displacement=start)
        assert done.compiled == done.steps and all(one.told for one in done.energy.elements)
        assert min(one.dissipated for one in done.energy.elements) > 0.0
        left.append(done.energy.relative_residual)
    assert left[1] < 5e-4
    assert left[0] > 10.0 * left[1]
