"""The shipped gearbox of two stages and the shaft on NU2210: forces by hand, and what they say of themselves."""

from __future__ import annotations

import math

import numpy as np
import pytest

from ehdmaps.physics.catalogue import static_rating
from mbs import assemble, plan, read_scene, statics
from mbs.model.elements import GROUND
from mbs.output.model_text import heading
from mbs.output.results import gear_forces
from mbs.scene.changes import with_slices


@pytest.fixture(scope="module")
def gearbox():
    """The gearbox of two stages at rest with dry contacts."""
    return statics(assemble(with_slices(read_scene("two_stage"), 5), "hertz"))


def test_two_stages_hand_the_torque_on_and_the_thrusts_on_the_middle_shaft_oppose(gearbox):
    forces = gear_forces(gearbox.model, gearbox.balance)
    torque = 80.0
    for name, normal, angle, teeth in (("mesh_1", 3e-3, 15.0, (23, 57)), ("mesh_2", 4e-3, -12.0, (21, 55))):
        helix = math.radians(angle)
        radius = 0.5 * normal * teeth[0] / math.cos(helix)
        tangential, radial, axial = forces[name]
        # the soft couplings take 0.03 % of the torques
        assert abs(tangential) == pytest.approx(torque / radius, rel=1e-3)
        assert radial == pytest.approx(abs(tangential) * math.tan(math.radians(20.0)) / math.cos(helix), rel=1e-9)
        assert axial == pytest.approx(tangential * math.tan(helix), rel=1e-9)
        torque *= teeth[1] / teeth[0]
    names = [connected.element.name for connected in gearbox.model.system.elements]
    held = {name: force[0] for name, force in zip(names, gearbox.balance.forces, strict=True)}
    # the locating bearings take the thrusts, that of the middle the difference of both: the residual of the balance
    thrusts = {"input_left": forces["mesh_1"][2], "output_left": -forces["mesh_2"][2]}
    thrusts["middle_left"] = forces["mesh_2"][2] - forces["mesh_1"][2]
    for name, thrust in thrusts.items():
        assert abs(held[name]) == pytest.approx(abs(thrust), rel=1e-6)
    assert all(held[name] == 0.0 for name in held if name.endswith("_right"))
    assert abs(held["middle_left"]) < 0.7 * abs(held["output_left"])


def test_the_feet_and_couplings_carry_what_the_machine_is_loaded_with(gearbox):
    """Balance of the whole machine about the origin: outside forces are the torques, four feet and two couplings."""
    scene, system, place = gearbox.model.scene, gearbox.model.system, gearbox.balance.displacement
    places = {body.name: body.frames for body in system.bodies}
    total = np.zeros(6)
    outside = [(load.on, load.force) for load in scene.loads]
    outside += [
        (spring.on, -spring.stiffness @ system.relative(spring.on) @ place)
        for spring in scene.springs
        if spring.against == GROUND
    ]
    for on, force in outside:
        body, _, frame = on.partition(":")
        total[:3] += force[:3]
        total[3:] += force[3:] + np.cross(places[body][frame].position, force[:3])
    # the file gives the centres to 1 nm, an arm of the 5 kN of a mesh
    np.testing.assert_allclose(total, 0.0, atol=1e-5)


def test_the_gearbox_needs_two_maps_one_for_each_type_of_bearing():
    jobs = plan(read_scene("two_stage")).jobs()
    assert [job.bearing.name for job in jobs] == ["NU308", "N1014"]


def test_the_shaft_says_that_its_bearings_are_estimated_and_stands_by_the_lever_rule():
    scene = read_scene("nu2210_shaft")
    geometry = scene.bearings[0].geometry
    assert static_rating(geometry) == pytest.approx(88e3, rel=1e-9)
    assert (geometry.rollers, round(1e3 * geometry.roller_diameter, 6)) == (16, 11.0)
    found = statics(assemble(scene, "hertz"))
    assert "  NU2210 (left, right): inner geometry estimated from catalogue dimensions" in "\n".join(
        heading(found.model)
    )
    left, right = (force[2] for force in found.balance.forces)
    assert left + right == pytest.approx(2000.0, rel=1e-8)
    # 2 kN at 330 mm from the left bearing, 220 mm apart; the tilted rollers take a moment, some per cent of it
    assert right == pytest.approx(3000.0, rel=0.01)
