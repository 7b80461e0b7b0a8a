"""Pairs of tapered roller bearings in scenes: O and X arrangement, preload by displacement and by force."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest

from ehdmaps.errors import AnalysisError, InputError
from ehdmaps.physics.rollers.tapered_catalogue import mirrored, tapered_estimate
from mbs import assemble, parse_scene
from mbs.analyses.soundness import findings_at_rest
from mbs.bearings.tapered.tapered_bearing import TaperedForce
from mbs.bearings.tapered.tapered_point import TaperedPoint
from mbs.linearised.modes import modes
from mbs.model.elements import Operation
from mbs.model.equilibrium import equilibrium
from mbs.model.findings import Cause
from mbs.output.one_bearing.located import located_lines
from mbs.scene.matrices import MatrixSpec

GEOMETRY = tapered_estimate("32208")
HALF, MASS, INERTIA, SPEED = 60e-3, 20.0, 0.2, 500.0


def text(left="", right="", outer="ground", more="", bearing="32208"):
    """A stiff rotor on two bearings, which has no polar inertia: modes are those of springs."""
    return f"""
schema = 1
[operation]
speed = "{SPEED} rad/s"
temperature = "60 degC"
[[bodies]]
name = "rotor"
freedoms = ["x", "y", "z", "theta_y", "theta_z"]
spin = 1
mass = "{MASS} kg"
polar_inertia = "0 kg m^2"
transverse_inertia = "{INERTIA} kg m^2"
frames = {{ left = ["-60 mm", "0 mm", "0 mm"], right = ["60 mm", "0 mm", "0 mm"] }}
[[bearings]]
name = "left"
bearing = "{bearing}"
inner = "rotor:left"
outer = "ground"
{left}
[[bearings]]
name = "right"
bearing = "HR {bearing} J"
inner = "rotor:right"
outer = "{outer}"
{right}
{more}
"""


RING = """
[[bodies]]
name = "ring"
freedoms = ["x"]
position = ["60 mm", "0 mm", "0 mm"]
mass = "0.2 kg"
[[springs]]
name = "guide"
on = "ring"
stiffness = { x = "1e3 N/m" }
[[loads]]
name = "preload"
on = "ring"
force = ["1500 N", "0 N", "0 N"]
"""
WEIGHT = """
[[loads]]
name = "weight"
on = "rotor"
force = ["0 N", "-4000 N", "0 N"]
"""
WEAR = '[laws.x]\nstiffness = "1e8 N/m"\ndamping = "1e3 N s/m"\n'
O_PAIR = {"left": 'axial_offset = "15 um"', "right": 'axial_offset = "-15 um"\nmirrored = true'}
X_PAIR = {"left": 'axial_offset = "-15 um"\nmirrored = true', "right": 'axial_offset = "15 um"'}


def model(law="hertz:1.25e-5 s", **keys):
    return assemble(parse_scene(text(**keys), "rotor", "rotor.toml"), law)


@pytest.mark.parametrize(("pair", "way"), [(O_PAIR, 1.0), (X_PAIR, -1.0)])
def test_modes_of_a_preloaded_pair_are_those_of_its_springs(pair, way) -> None:
    """Two springs each way; against tilts they stand in the pressure centres, outside of an O, inside of an X pair."""
    machine = model("hertz", **pair)
    balance = equilibrium(machine.system, machine.operation)
    forces, stiffness, _ = TaperedForce(GEOMETRY)([15e-6, 0.0, 0.0, 0.0, 0.0, 0.0], inner_speed=SPEED)
    assert balance.forces[0][0] == pytest.approx(way * forces[0], rel=1e-9)
    found = np.sort(np.abs(modes(balance).eigenvalues))
    axial, radial = (math.sqrt(2.0 * stiffness[i, i] / MASS) for i in (0, 1))
    for value in (axial, radial, radial):
        assert np.min(np.abs(found - value)) < 1e-8 * value  # round-off of the balance of rollers
    span = HALF + way * GEOMETRY.pressure_centre
    tilt = math.sqrt(2.0 * stiffness[1, 1] * span**2 / INERTIA)
    # lines hold tilts of their own: K L^2/12 of 15 mm beside K span^2
    own = GEOMETRY.roller_length**2 / 12.0 / span**2
    assert np.min(np.abs(found / tilt - 1.0)) < own


def test_preload_by_force_gives_both_bearings_that_force() -> None:
    """Modes, too, are those on tables of the bearings alone under the loads that they have."""
    right = "mirrored = true"
    machine = model(right=right, outer="ring", more=RING + WEIGHT)
    balance = equilibrium(machine.system, machine.operation)
    place = balance.displacement[machine.system.coordinates.index("ring.x")]
    axial = 1500.0 - 1e3 * place
    # the right inner ring is pushed along -x by it, the left one along +x: each force is against its push
    tables = []
    for index, (name, on, against, geometry, way) in enumerate(
        (("left", "rotor:left", "ground", GEOMETRY, -1.0), ("right", "rotor:right", "ring", mirrored(GEOMETRY), 1.0))
    ):
        assert way * balance.forces[index][0] == pytest.approx(axial, rel=1e-8)  # of the equilibrium, 1e-10
        alone = TaperedPoint.at(
            TaperedForce(geometry, damping_time=1.25e-5), (-way * axial, *(-balance.forces[index][1:3])), SPEED
        )
        tables.append(MatrixSpec(name, on, alone.stiffness[None], alone.damping[None], against))
    other = assemble(dataclasses.replace(machine.scene, elements=tables), "hertz")
    ours, theirs = (modes(found).eigenvalues for found in (balance, equilibrium(other.system, other.operation)))
    assert ours.size == theirs.size
    for value in ours:
        # both arrangements of rollers and rings are alike, so that nothing tilts; equilibria to 1e-10 of the loads
        assert np.min(np.abs(theirs - value)) < 1e-6 * abs(value)
    lines = "\n".join(located_lines(machine, balance))
    assert "left: -1" in lines and "17 of 17 rollers loaded" in lines and "N s/mm" in lines
    assert "tapered roller bearings dry Hertz, c = 12.5 us times k" in machine.law


def test_runs_in_time_stay_in_the_equilibrium_and_say_where_rings_come_apart() -> None:
    machine = model(**O_PAIR)
    element = machine.system.elements[0].element
    away = np.array([-2e-3, 0.0, 0.0, 0.0, 0.0, 0.0])
    with pytest.raises(AnalysisError, match=r"'left': its rings are apart by .* at 0.25 s, .*: preload is lost"):
        element.advance(None, away, np.zeros(6), Operation(SPEED, 0.0, 0.25))
    with pytest.raises(InputError, match=r"pose: got \[nan, .*; allowed: finite numbers"):
        element.advance(None, np.full(6, np.nan), np.zeros(6), Operation(SPEED, 0.0, 0.25))
    force, states = element.advance(None, np.zeros(6), np.zeros(6), Operation(SPEED, 0.0, 0.25))
    assert states.time == 0.25 and force.force[0] < 0.0
    loose = model(left='axial_offset = "-15 um"', right='axial_offset = "15 um"\nmirrored = true')
    found = findings_at_rest(loose, np.zeros(loose.system.size), loose.operation)
    assert [one.cause for one in found if one.bearing == "left"] == [Cause.UNLOADED]


@pytest.mark.parametrize(
    ("keys", "law", "words"),
    [
        ({"bearing": "32299"}, "hertz", "bearing: got '32299'"),
        ({"left": "mirrored = 1"}, "hertz", "mirrored: got 1; allowed: true, false"),
        ({"outer": "rotor:left"}, "hertz", "got rotor:right and rotor:left; allowed: rings on two bodies"),
        ({"more": WEAR}, "constant:x", "got the law 'constant:x' for a tapered roller bearing; allowed: hertz"),
        ({"left": 'diametral_clearance = "5 um"'}, "hertz", "diametral_clearance"),
    ],
)
def test_refusals(keys, law, words) -> None:
    with pytest.raises(InputError) as caught:
        model(law, **keys)
    assert words in str(caught.value)


def test_tapered_rollers_have_films_beside_those_of_balls() -> None:
    oil = '[lubricant]\nname = "ISO VG 15"\n'
    scene = (
        text(**O_PAIR)
        .replace('bearing = "HR 32208 J"', 'bearing = "7208B"')
        .replace("[operation]", oil + "[operation]")
    )
    machine = assemble(parse_scene(scene, "rotor", "rotor.toml"), "table", inlet_heat=False)
    assert "flooded, films with memory; tapered roller bearings with films from the film table" in machine.law
    assert machine.law.count("isothermal, flooded") == 2
    heated = assemble(machine.scene, "table")
    assert heated.law.count("inlet heat, flooded") == 2
    tapered = [one for one in machine.on_rings if one not in machine.balls]
    warm = [one for one in heated.on_rings if one not in heated.balls]
    place = np.array([30e-6, 0.0, 0.0, 0.0, 0.0, 0.0]) * np.sign(tapered[0].force.geometry.contact_angle or 1.0)
    cold_force, warm_force = (one.evaluate(place, np.zeros(6), machine.operation) for one in (tapered[0], warm[0]))
    assert 0.0 < abs(warm_force.force[0]) < abs(cold_force.force[0])
    assert 0.0 < warm_force.damping[0, 0] < cold_force.damping[0, 0]
