"""Ball bearings in scenes: against the bearing alone, and at the ends of what they carry."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest

from ehdmaps.errors import AnalysisError, InputError
from ehdmaps.physics.oil_supply import OilSupply
from ehdmaps.physics.point.ball_catalogue import ball_estimate
from mbs import assemble, parse_scene, read_scene
from mbs.bearings.balls.ball_bearing import BallForce
from mbs.bearings.balls.ball_point import BallPoint
from mbs.bearings.balls.laws import dry_law
from mbs.cli import main
from mbs.linearised.modes import modes
from mbs.model.elements import Operation
from mbs.model.equilibrium import equilibrium
from mbs.output.one_bearing.located import located_lines
from mbs.scene.matrices import MatrixSpec

LAW = "hertz:1.25e-5 s"
WEIGHT, PRELOAD, SPEED = 1200.0, 400.0, 1500.0


def text(bearing="6208", left="", right="", ring_spin=0.0, loads=True):
    """A stiff rotor between two bearings, the outer ring of the right one pushed against it along x."""
    given = f"""
[[loads]]
name = "weight"
on = "rotor"
force = ["0 N", "{-WEIGHT} N", "0 N"]
[[loads]]
name = "preload"
on = "ring"
force = ["{-PRELOAD} N", "0 N", "0 N"]
"""
    return f"""
schema = 1
[operation]
speed = "{SPEED} rad/s"
temperature = "60 degC"
[[bodies]]
name = "rotor"
freedoms = ["x", "y", "z", "theta_y", "theta_z"]
spin = 1
mass = "20 kg"
polar_inertia = "0.05 kg m^2"
transverse_inertia = "0.2 kg m^2"
frames = {{ left = ["-100 mm", "0 mm", "0 mm"], right = ["100 mm", "0 mm", "0 mm"] }}
[[bodies]]
name = "ring"
freedoms = ["x"]
spin = {ring_spin}
position = ["100 mm", "0 mm", "0 mm"]
mass = "0.1 kg"
[[springs]]
name = "wave"
on = "ring"
stiffness = {{ x = "1e3 N/m" }}
[[bearings]]
name = "left"
bearing = "{bearing}"
inner = "rotor:left"
outer = "ground"
{left}
[[bearings]]
name = "right"
bearing = "{bearing}"
inner = "rotor:right"
outer = "ring"
{right}
""" + (given if loads else "")


def model(law=LAW, **keys):
    return assemble(parse_scene(text(**keys), "rotor", "rotor.toml"), law)


def test_modes_are_those_on_tables_of_the_bearing_alone():
    """Both ways find an equilibrium to 1e-10 of the loads; K and C follow to some 1e-8 and 1e-6 bounds that."""
    clearance = 12e-6
    machine = model(left='diametral_clearance = "12 um"', right='diametral_clearance = "12 um"')
    found = equilibrium(machine.system, machine.operation)
    # what the spring takes of the preload by the way of the ring
    axial = PRELOAD + 1e3 * found.displacement[machine.system.coordinates.index("ring.x")]
    geometry = dataclasses.replace(ball_estimate("6208"), clearance=clearance)
    tables = []
    for name, on, against, way in (("left", "rotor:left", "ground", -1.0), ("right", "rotor:right", "ring", 1.0)):
        force = BallForce(geometry, dry_law(geometry, damping_time=1.25e-5))
        alone = BallPoint.at(force, (way * axial, -0.5 * WEIGHT, 0.0), SPEED)
        tables.append(MatrixSpec(name, on, alone.stiffness[None], alone.damping[None], against))
    other = assemble(dataclasses.replace(machine.scene, elements=tables), "hertz")
    on_tables = equilibrium(other.system, other.operation)
    ours, theirs = (modes(rest).eigenvalues for rest in (found, on_tables))
    assert ours.size == theirs.size == 6
    for value in ours:
        assert np.min(np.abs(theirs - value)) < 1e-6 * abs(value)
    # the centrifugal load of the balls is in it
    still = modes(equilibrium(machine.system, Operation(0.0)))
    assert abs(np.abs(still.eigenvalues).max() / np.abs(ours).max() - 1.0) > 1e-3


class TestExtremes:
    """A value, or a refusal that says why."""

    def test_pure_axial_load_is_carried_by_all_balls_alike(self):
        machine = model(left='axial_offset = "0 um"')
        loads = [load for load in machine.scene.loads if load.name == "preload"]
        machine = assemble(dataclasses.replace(machine.scene, loads=loads), LAW)
        found = equilibrium(machine.system, machine.operation)
        for ball, way in zip(machine.balls, (-1.0, 1.0), strict=True):
            index = [entry.element for entry in machine.system.elements].index(ball)
            balls = ball.loads(machine.system.relative(ball.inner, ball.outer) @ found.displacement, machine.operation)
            assert np.ptp(balls.load[0]) < 1e-9 * balls.load[0].max()
            assert way * found.forces[index][0] < 0.0 < way * balls.mean_angle(0)

    def test_no_load_with_clearance_holds_nothing(self):
        machine = model(left='diametral_clearance = "10 um"', right='diametral_clearance = "10 um"', loads=False)
        found = equilibrium(machine.system, Operation(0.0))
        assert not np.any(found.displacement)
        assert not any(np.any(force) for force in found.forces)

    def test_an_offset_preloads_a_pair_without_any_load(self):
        """The offset is a displacement of the pair: each bearing takes half, and the axial force is that of one."""
        scene = parse_scene(text("7208B", 'axial_offset = "8 um"', "mirrored = true", loads=False), "pair", "pair.toml")
        scene = dataclasses.replace(scene, speed=0.0)
        scene = dataclasses.replace(scene, springs=[])
        held = dataclasses.replace(scene, elements=[dataclasses.replace(e, outer="ground") for e in scene.located])
        held = dataclasses.replace(held, bodies=[body for body in held.bodies if body.name == "rotor"])
        machine = assemble(held, "hertz")
        found = equilibrium(machine.system, machine.operation)
        geometry = ball_estimate("7208B")
        alone, _, _ = BallForce(geometry, dry_law(geometry))([4e-6, 0.0, 0.0, 0.0, 0.0, 0.0])
        # to what the balance leaves of the force
        assert found.forces[0][0] == pytest.approx(alone[0], rel=1e-8)
        assert found.forces[1][0] == pytest.approx(-alone[0], rel=1e-8)

    def test_lost_preload_is_refused(self):
        """An angular contact bearing that is pushed the other way falls apart."""
        with pytest.raises(AnalysisError, match=r"no equilibrium"):
            rest = model(bearing="7208B")
            equilibrium(rest.system, rest.operation)

    def test_an_outer_ring_that_turns_drives_the_balls(self):
        """Rings that turn alike carry the balls round with them: no rolling, and the whole centrifugal load."""
        machine = model(ring_spin=1.0)
        ball = machine.balls[1]
        at = ball.settled(np.array([2e-5, 0.0, 0.0, 0.0, 0.0, 0.0]), machine.operation)
        np.testing.assert_allclose(at.loads.speed, SPEED, rtol=1e-12)
        geometry = ball.force.geometry
        load = 0.5 * geometry.ball_mass(ball.force.material) * geometry.pitch_diameter * SPEED**2
        outward = at.loads.load * np.cos(at.loads.contact_angle)
        np.testing.assert_allclose(outward[1] - outward[0], load, rtol=1e-6)


def test_films_are_in_statics_and_time():
    machine = assemble(read_scene("electric_drive"), "table", inlet_heat=False)
    assert machine.law.endswith("isothermal, flooded, films with memory")
    assert machine.label == "film table"
    found = equilibrium(machine.system, machine.operation)
    dry = assemble(machine.scene, "hertz")
    ball, still = machine.balls[0], np.zeros(6)
    place = machine.system.relative(ball.inner, ball.outer) @ found.displacement
    with_films, without = (one.balls[0].evaluate(place, still, machine.operation) for one in (machine, dry))
    assert with_films.damping[1, 1] > 10.0
    assert not np.any(without.damping)
    # films of 0.1 um and more in both contacts press the rings apart
    assert abs(with_films.force[0]) > abs(without.force[0])
    heated = assemble(machine.scene, "table")
    assert "inlet heat, flooded" in heated.law and "isothermal" not in heated.law
    warm = heated.balls[0].evaluate(place, still, machine.operation)
    assert abs(with_films.force[0]) > abs(warm.force[0]) > abs(without.force[0])
    assert 0.0 < warm.damping[1, 1] < with_films.damping[1, 1]
    in_time, _ = ball.advance(None, place, still, machine.operation)
    np.testing.assert_allclose(in_time.force, with_films.force, rtol=1e-9, atol=1e-9 * abs(with_films.force[0]))
    with pytest.raises(AnalysisError, match=r"'drive': no films at 1e\+07 rpm of the system .*hertz:1.25e-5 s"):
        ball.force_at(Operation(1e7 * math.pi / 30.0))


def test_wrong_bearings_and_laws_are_all_said():
    wrong = text("6299", 'mirrored = 1\naxial_offset = "5 mm"', "slices = 5")
    with pytest.raises(InputError) as caught:
        parse_scene(wrong, "rotor", "rotor.toml")
    said = "\n".join(caught.value.problems)
    for part in ("got '6299'", "mirrored: got 1; allowed: true, false", "axial_offset", "slices: unknown key"):
        assert part in said
    with pytest.raises(InputError, match=r"mirrored: got true for 6208, which is alike both ways"):
        parse_scene(text(left="mirrored = true"), "rotor", "rotor.toml")
    with pytest.raises(InputError, match=r"diametral_clearance"):
        parse_scene(text(left='diametral_clearance = "9 mm"'), "rotor", "rotor.toml")
    with pytest.raises(InputError, match=r"films need the oil of the scene; add \[lubricant\]"):
        model("table")
    layered = assemble(read_scene("electric_drive"), "table", supply=OilSupply(5e-6))
    assert "inlet heat, oil layer 5 um" in layered.law and set(layered.supplies.values()) == {OilSupply(5e-6)}
    with pytest.raises(InputError, match=r"got the law 'formula' for a ball bearing; allowed: hertz"):
        assemble(read_scene("electric_drive"), "formula")


def test_check_says_how_each_bearing_stands(capsys):
    assert main(["check", "spindle", "--law", "hertz"]) == 0
    said = capsys.readouterr().out
    for words in (
        "bearing front: 7014C (estimated), 20 balls, clearance 0 um, contact angle 15 deg, inner ring offset by 12 um,",
        "bearing rear_inside: 7012C (estimated), 19 balls, clearance 0 um, contact angle 15 deg, mirrored,",
    ):
        assert words in said


def test_balls_that_hardly_touch_are_not_loaded():
    """Films of a loose bearing carry some load at every ball; those above 1 % of the highest count."""
    loose = 'diametral_clearance = "25 um"'
    given = (
        text(left=loose, right=loose, loads=False)
        + """
[lubricant]
name = "ISO VG 32"
[[loads]]
name = "weight"
on = "rotor"
force = ["0 N", "-1 kN", "0 N"]
"""
    )
    machine = assemble(parse_scene(given, "rotor", "rotor.toml"), "table")
    rest = equilibrium(machine.system, machine.operation)
    place = machine.system.relative("rotor:left", "ground") @ rest.displacement
    loads = machine.balls[0].loads(place, machine.operation)
    assert np.all(loads.load[0] > 0.0) and loads.loaded < loads.angle.size
    assert f"  {loads.loaded} of {loads.angle.size} balls loaded" in "\n".join(located_lines(machine, rest))


def test_heat_beyond_its_rule_is_said_and_kept_by_changed_machines():
    """Films of QL above 3 say so; a model that is made again of a changed scene keeps heat and supply."""
    model = assemble(read_scene("spindle"), "table", supply=OilSupply(2e-6), inlet_heat=True)
    again = model.again(model.scene)
    for one in (model, again):
        assert all(ball.films.conditions.words == "inlet heat, oil layer 2 um" for ball in one.balls)
    films = model.balls[0].films
    assert "QL" not in films.note(10.0, 0.0) and films.note(5000.0, 0.0).startswith("inlet heat beyond its rule: QL = ")
