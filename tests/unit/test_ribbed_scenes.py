"""Bearings NJ and NUP in scenes: ribs hold a shaft that moves along x, and are not there for one that does not."""

from __future__ import annotations

import math

import numpy as np
import pytest

from ehdmaps.errors import InputError
from ehdmaps.physics.rollers.ribbed_geometry import ribbed_estimate
from mbs import assemble, parse_scene
from mbs.bearings.locating.locating_element import LocatingElement
from mbs.bearings.tapered.tapered_bearing import TaperedForce
from mbs.cli import main
from mbs.linearised.modes import modes
from mbs.model.equilibrium import equilibrium
from mbs.scene.locating.ribs import open_sides
from tests.cases import commands

MASS = 20.0
CROWN = 'profile = { crown_drop = "6 um" }'


def text(bearing="NUP210", more="", freedoms='"x"', force="1500 N", outer="ground"):
    """A mass on one bearing, pushed along x and y."""
    return f"""
schema = 1
[operation]
speed = "3000 rpm"
temperature = "60 degC"
[[bodies]]
name = "rotor"
freedoms = [{freedoms}]
spin = 1
mass = "{MASS} kg"
polar_inertia = "0.05 kg m^2"
transverse_inertia = "0.2 kg m^2"
[[bearings]]
name = "one"
bearing = "{bearing}"
inner = "rotor"
outer = "{outer}"
{more}
[[loads]]
name = "push"
on = "rotor"
force = ["{force}", "-4000 N", "0 N"]
"""


@pytest.mark.parametrize(
    ("keys", "words"),
    [
        ({"bearing": "NJ210", "force": "-1500 N"}, "pushed to its open side by 1500 N along -x on rotor"),
        ({"bearing": "NJ210", "more": "mirrored = true"}, "pushed to its open side by 1500 N along x on rotor"),
        ({"bearing": "NJ210"}, ""),
        ({"bearing": "NJ210", "more": "mirrored = true", "force": "-1500 N"}, ""),
        ({"bearing": "NUP210", "force": "-1500 N"}, ""),
        ({"bearing": "NJ210", "freedoms": '"y"', "force": "-1500 N"}, ""),
    ],
)
def test_check_finds_a_bearing_on_its_open_side(tmp_path, capsys, keys, words) -> None:
    scene = tmp_path / "rotor.toml"
    scene.write_text(text(**keys), encoding="utf-8")
    assert main(["check", str(scene), "--law", "hertz"]) == (1 if words else 0)
    said = capsys.readouterr().out
    assert ("problem: [[bearings]] one: NJ210 is" in said and words in said) if words else "no problem found" in said


def test_the_ring_decides_and_another_bearing_may_hold(tmp_path) -> None:
    """A body that is the outer ring is held the other way; a ball bearing beside takes the load."""
    plain = text("NJ210", force="-1500 N")
    assert open_sides(parse_scene(plain, "rotor", "rotor.toml"))
    turned = plain.replace('inner = "rotor"', 'inner = "ground"').replace('outer = "ground"', 'outer = "rotor"')
    assert not open_sides(parse_scene(turned, "rotor", "rotor.toml"))
    more = '[[bearings]]\nname = "two"\nbearing = "6210"\ninner = "rotor"\nouter = "ground"\n'
    assert not open_sides(parse_scene(plain + more, "rotor", "rotor.toml"))


def model(law="hertz", clearance=None, **keys):
    return assemble(parse_scene(text(**keys), "rotor", "rotor.toml"), law, clearance=clearance)


@pytest.mark.parametrize(("keys", "way"), [({}, 1.0), ({"bearing": "NJ210"}, 1.0), ({"more": CROWN}, 1.0)])
def test_ribs_hold_a_mass_along_x(keys, way) -> None:
    """Rest and axial mode by the force of the bearing alone; the pose is where both meet."""
    machine = model(**keys)
    (element,) = (connected.element for connected in machine.system.elements)
    assert isinstance(element, LocatingElement)
    balance = equilibrium(machine.system, machine.operation)
    profile = machine.scene.located[0].profile
    alone = TaperedForce(ribbed_estimate("NUP210"), profile=profile, slices=41)
    pose = [float(balance.displacement[0]), 0.0, 0.0, 0.0, 0.0, 0.0]
    force, stiffness, _ = alone(pose, inner_speed=machine.operation.speed)
    assert force[0] == pytest.approx(-1500.0, rel=1e-8)  # of the equilibrium, 1e-10
    found = np.abs(modes(balance).eigenvalues)
    assert np.min(np.abs(found / math.sqrt(stiffness[0, 0] / MASS) - 1.0)) < 1e-8
    assert (profile == "iso") == (keys.get("more") != CROWN)


def test_keys_and_choices_reach_the_ribs() -> None:
    """Clearances and offset shift where the ribs carry; a mirrored NJ carries the other way."""
    keys = 'axial_clearance = "40 um"\naxial_offset = "5 um"\ndiametral_clearance = "12 um"'
    plain, shifted = (
        equilibrium(each.system, each.operation).displacement[0] for each in (model(clearance=12e-6), model(more=keys))
    )
    assert shifted - plain == pytest.approx(15e-6, abs=1e-12)  # of the equilibrium
    mirrored = model(bearing="NJ210", more='mirrored = true\naxial_clearance = "20 um"', force="-1500 N")
    assert mirrored.scene.located[0].geometry.carries == "-x"
    assert equilibrium(mirrored.system, mirrored.operation).displacement[0] < -10e-6
    assert mirrored.law == "ribbed roller bearings dry Hertz"


def test_mbs_check_says_how_ribs_carry(capsys, tmp_path) -> None:
    scene = tmp_path / "rotor.toml"
    scene.write_text(text("NJ210", 'mirrored = true\naxial_clearance = "30 um"', force="-1500 N"), encoding="utf-8")
    status, out, _ = commands.run(capsys, "check", str(scene))
    assert status == 0 and "16 rollers, clearance 35 um, ribs carry along -x, axial clearance 30 um, rotor in" in out


def test_a_shaft_held_along_x_has_bearings_without_ribs() -> None:
    machine = model(freedoms='"y", "z"', more='rollers = "bodies"')
    assert not machine.scene.located
    assert machine.scene.bearings[0].between_ribs is None and machine.scene.bearings[0].rollers_as_bodies


@pytest.mark.parametrize(
    ("keys", "words"),
    [
        (
            {"bearing": "NU210", "more": 'axial_clearance = "5 um"'},
            "axial_clearance: got a bearing without ribs on both",
        ),
        ({"more": 'mirrored = "yes"'}, "mirrored: got 'yes'; allowed: true, false"),
        ({"more": "slices_coupled = true"}, "one, slices_coupled: got NUP210, whose ring moves along x: its ribs hold"),
        ({"more": 'axial_clearance = "5 um"', "freedoms": '"y"'}, "axial_clearance: has no effect on a bearing whose"),
        ({"outer": "rotor"}, "got rotor and rotor; allowed: rings on two bodies"),
    ],
)
def test_refusals(keys, words) -> None:
    with pytest.raises(InputError) as caught:
        model(**keys)
    assert words in str(caught.value)


def test_lines_have_films() -> None:
    oil = '[lubricant]\nname = "FVA3"\n[[loads]]'
    machine = assemble(parse_scene(text().replace("[[loads]]", oil), "rotor", "rotor.toml"), "table")
    assert "ribbed roller bearings with films from the film table" in machine.law
    balance, dry = (equilibrium(one.system, one.operation) for one in (machine, model()))
    # the film carries beside the loaded zone, and adds to what rings approach there
    assert balance.forces[0][1] == pytest.approx(dry.forces[0][1], rel=1e-9)
    assert balance.element_damping[0][1, 1] > 100.0
