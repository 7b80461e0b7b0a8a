"""Gear meshes as inputs of linear analyses: a force along the line of action, and a transmission error."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from ehdmaps.errors import InputError
from mbs import assemble, lsa, parse_scene
from mbs.analyses.hammer import hammer_problems
from mbs.gears.pair import GearPair

MESH = 3e8
DAMPER = 2e3
PAIR = GearPair("m", "a", "b", (21, 23), 4e-3, np.radians(20.0), 1.0, MESH, 1e-4)
SCENE = f"""
schema = 1
[operation]
speed = "0 rpm"
temperature = "40 degC"
[[bodies]]
name = "a"
freedoms = ["theta_x"]
mass = "1 kg"
polar_inertia = "2e-3 kg m^2"
transverse_inertia = "2e-3 kg m^2"
spin = 21
[[bodies]]
name = "b"
freedoms = ["theta_x"]
position = ["0 mm", "88 mm", "0 mm"]
mass = "1 kg"
polar_inertia = "3e-3 kg m^2"
transverse_inertia = "2e-3 kg m^2"
spin = -19.173913043478262
[[springs]]
name = "held"
on = "a"
stiffness = {{ theta_x = "1e3 N m/rad" }}
[[springs]]
name = "held too"
on = "b"
stiffness = {{ theta_x = "1e4 N m/rad" }}
damping = {{ theta_x = "0.2 N m s/rad" }}
[[loads]]
name = "torque"
on = "a"
moment = ["TORQUE N m", "0 N m", "0 N m"]
[[gears]]
name = "m"
on = "a"
against = "b"
teeth = [21, 23]
module = "4 mm"
pressure_angle = "20 deg"
face_width = "1 m"
stiffness = "{MESH} N/m^2"
damping = "{DAMPER} N s/m"
backlash = "0.1 mm"
[[inputs]]
name = "force"
on = "mesh:m"
[[inputs]]
name = "error"
on = "mesh:m"
quantity = "transmission_error"
[[sensors]]
name = "turn"
on = "b"
direction = "theta_x"
quantity = "velocity"
[linear]
frequencies = {{ from = "5 Hz", to = "5 kHz", points = 7 }}
"""


def scene_of(text=SCENE, torque=40.0):
    """A scene as read."""
    return parse_scene(text.replace("TORQUE", str(torque)), "scene", "scene")


@pytest.mark.parametrize(("torque", "side"), [(40.0, 1.0), (-40.0, -1.0)])
def test_two_gears_answer_as_two_turning_masses_in_closed_form(torque, side):
    # Closed form of two inertias with a mesh between them; the bound is the round-off of the solution by modes.
    result = lsa(assemble(scene_of(torque=torque)))
    s = 2j * np.pi * result.frequencies
    first, second = PAIR.base_radii
    mesh = MESH + s * DAMPER
    one = 2e-3 * s**2 + 1e3 + mesh * first**2
    two = 3e-3 * s**2 + 0.2 * s + 1e4 + mesh * second**2
    coupling = mesh * first * second  # both turn the other way round: they compress the driving flank together
    by_force = side * (one * second - coupling * first) / (one * two - coupling**2)
    # The error is what the driving flank lacks; on the other flank the mesh yields to its opposite.
    by_error = (one * second - coupling * first) / (one * two - coupling**2) * mesh
    np.testing.assert_allclose(result.responses[:, 0, 0], s * by_force, rtol=1e-7)
    np.testing.assert_allclose(result.responses[:, 0, 1], s * by_error, rtol=1e-7)
    assert result.dataset["amplitude"].values.tolist() == [1.0, 1e-6]


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ('on = "mesh:m"\nquantity', 'on = "mesh:n"\nquantity', "input 'error': there is no gear pair 'n'"),
        ('on = "mesh:m"\nquantity', 'on = "mesh:m"\ndirection = "y"\nquantity', "stands beside a mesh"),
        ('"transmission_error"', '"error"', "got 'error'"),
    ],
)
def test_what_is_no_mesh_is_refused(old, new, words):
    with pytest.raises(InputError, match=words):
        assemble(scene_of(SCENE.replace(old, new)))


def test_no_hammer_hits_a_mesh():
    scene = scene_of()
    assert "is a gear mesh" in hammer_problems(scene)[0]
    assert not hammer_problems(dataclasses.replace(scene, inputs=[], sensors=[]))[0].count("gear mesh")
