"""Helical gears in scenes: their axial force is held and told, or refused; several meshes on one shaft."""

from __future__ import annotations

import math

import numpy as np
import pytest

from ehdmaps.errors import InputError
from mbs import assemble, modes, statics
from mbs.output.results import gear_forces, gear_lines
from mbs.scene.reader import parse_scene

HELIX, TORQUE = math.radians(15.0), 40.0
APART = 0.5 * 3e-3 * 60 / math.cos(HELIX)
HEAD = """
schema = 1
[operation]
speed = "600 rpm"
temperature = "40 degC"
"""
BODY = """
[[bodies]]
name = "{name}"
freedoms = [{freedoms}]
position = ["{x!r} m", "{y!r} m", "0 m"]
spin = {spin!r}
mass = "2 kg"
polar_inertia = "2e-3 kg m^2"
transverse_inertia = "4e-3 kg m^2"
frames = {{ far = ["0.1 m", "0 m", "0 m"] }}
[[springs]]
name = "mount_{name}"
on = "{name}"
stiffness = {{ {axial}y = "1e8 N/m", z = "1e8 N/m", theta_y = "1e6 N m/rad", theta_z = "1e6 N m/rad" }}
"""
GEARS = """
[[gears]]
name = "{name}"
on = "{on}"
against = "{against}"
teeth = [{teeth}]
module = "3 mm"
pressure_angle = "20 deg"
helix_angle = "{angle!r} deg"
face_width = "30 mm"
stiffness = "14 N/(um mm)"
backlash = "0.1 mm"
harmonics = 0
"""
LOAD = """
[[loads]]
name = "{name}"
on = "{on}"
moment = ["{moment!r} N m", "0 N m", "0 N m"]
"""
FREE = '"x", "y", "z", "theta_x", "theta_y", "theta_z"'
AXIAL = 'x = "2e7 N/m", '


def stage(freedoms=FREE, axial=AXIAL, angle=15.0, more=""):
    """Two shafts, 20 and 40 teeth, the second one held against turning; with more elements if wanted."""
    apart, held = 0.09 / math.cos(math.radians(angle)), f'{axial}theta_x = "1e7 N m/rad", '
    bodies = [
        BODY.format(name="one", freedoms=freedoms, x=0.0, y=0.0, spin=1.0, axial=axial),
        BODY.format(name="two", freedoms=freedoms, x=0.0, y=apart, spin=-0.5, axial=held),
    ]
    gears = GEARS.format(name="mesh", on="one", against="two", teeth="20, 40", angle=angle)
    load = LOAD.format(name="drive", on="one", moment=TORQUE)
    return parse_scene(HEAD + "".join(bodies) + gears + load + more, "stage", "stage.toml")


def test_the_axial_force_is_in_the_springs_along_the_shafts_and_told():
    found = statics(assemble(stage()))
    place = dict(zip(found.model.system.coordinates, found.balance.displacement, strict=True))
    tangential = TORQUE / (0.5 * 3e-3 * 20 / math.cos(HELIX))
    # Newton leaves 1e-10 of the largest force
    assert 2e7 * place["one.x"] == pytest.approx(tangential * math.tan(HELIX), rel=1e-8)
    assert 2e7 * place["two.x"] == pytest.approx(-tangential * math.tan(HELIX), rel=1e-8)
    parts = gear_forces(found.model, found.balance)["mesh"]
    apart = tangential * math.tan(math.radians(20.0)) / math.cos(HELIX)
    np.testing.assert_allclose(parts, (tangential, apart, tangential * math.tan(HELIX)), rtol=1e-8)
    np.testing.assert_allclose(found.dataset["gear_force"].sel(gear_mesh="mesh"), parts)
    (line,) = gear_lines(found.model, found.balance)
    assert f"{tangential:.6g} N tangential" in line
    assert f"{parts[2]:+.6g} N axial on one, {-parts[2]:+.6g} N on two" in line


@pytest.mark.parametrize(("bearing", "mirrored"), [("6208", (0, 0)), ("7208B", (0, 1)), ("32208", (0, 1))])
def test_a_bearing_that_locates_a_shaft_takes_its_thrust(bearing, mirrored):
    """Newton leaves 1e-10 of the largest force; bearings without play touch at rest, where they have no stiffness."""
    thrust = TORQUE / (0.5 * 3e-3 * 20 / math.cos(HELIX)) * math.tan(HELIX)
    more = "".join(
        f'[[bearings]]\nname = "b_{body}"\ninner = "{body}"\nouter = "ground"\nbearing = "{bearing}"\n'
        + ("mirrored = true\n" if turned else "")
        for body, turned in zip(("one", "two"), mirrored, strict=True)
    )
    found = statics(assemble(stage(axial="", more=more), "hertz"))
    names = [connected.element.name for connected in found.model.system.elements]
    held = {name: force[0] for name, force in zip(names, found.balance.forces, strict=True)}
    assert [abs(held["b_one"]), abs(held["b_two"])] == pytest.approx([thrust, thrust], rel=1e-8)


def test_a_shaft_that_nothing_holds_along_x_is_refused_and_one_without_the_freedom_told():
    with pytest.raises(InputError) as caught:
        assemble(stage(axial=""))
    text = str(caught.value)
    for body in ("one", "two"):
        assert f"gear pair 'mesh': its helix pushes {body!r} along x, and nothing holds {body!r} there" in text
    assert "give it a locating bearing, such as a ball bearing, or a spring with a stiffness x" in text
    assert assemble(stage(axial="", angle=0.0)).system.size == 12  # spur gears push nothing
    found = statics(assemble(stage(freedoms=FREE.replace('"x", ', ""), axial="")))
    assert "  one and two: no freedom x" in "\n".join(gear_lines(found.model, found.balance))


def two_stages(angle):
    """Three shafts: the middle one has a gear of each stage, 0.1 m apart, both driven from the same side."""
    both = 'theta_x = "1e7 N m/rad", '
    bodies = [
        BODY.format(name="one", freedoms=FREE, x=0.0, y=0.0, spin=1.0, axial=AXIAL),
        BODY.format(name="two", freedoms=FREE, x=0.0, y=APART, spin=-0.5, axial=AXIAL),
        BODY.format(name="three", freedoms=FREE, x=0.1, y=2 * APART, spin=0.25, axial=AXIAL + both),
    ]
    gears = [
        GEARS.format(name="first", on="one", against="two", teeth="20, 40", angle=15.0),
        GEARS.format(name="second", on="two:far", against="three", teeth="20, 40", angle=angle),
    ]
    text = HEAD + "".join(bodies) + "".join(gears) + LOAD.format(name="drive", on="one", moment=TORQUE)
    return assemble(parse_scene(text, "two stages", "two.toml"))


def test_two_meshes_on_one_shaft_hand_the_torque_on_and_their_axial_forces_add():
    """On the middle shaft both gears have the same hand where their thrusts go against each other."""
    model = two_stages(-15.0)
    found = statics(model)
    place = dict(zip(model.system.coordinates, found.balance.displacement, strict=True))
    radius = 0.5 * 3e-3 * 20 / math.cos(HELIX)
    first, second = TORQUE / radius, 2.0 * TORQUE / radius
    assert 1e7 * place["three.theta_x"] == pytest.approx(4.0 * TORQUE, rel=1e-8)
    # gears of the middle shaft: left-handed against the first pinion, and left-handed itself
    thrusts = gear_forces(model, found.balance)
    assert thrusts["first"][2] == pytest.approx(first * math.tan(HELIX), rel=1e-8)
    assert thrusts["second"][2] == pytest.approx(second * math.tan(HELIX), rel=1e-8)
    assert 2e7 * place["two.x"] == pytest.approx((second - first) * math.tan(HELIX), rel=1e-8)
    other = two_stages(15.0)
    along = other.system.coordinates.index("two.x")
    moved = statics(other).balance.displacement[along]
    assert 2e7 * moved == pytest.approx(-(second + first) * math.tan(HELIX), rel=1e-8)
    assert model.gears[0].order == 20.0
    assert model.gears[1].order == 10.0  # of the speed of the first shaft: 20 teeth at half of it
    assert np.all(modes(model).dataset["frequency"] > 0.0)
