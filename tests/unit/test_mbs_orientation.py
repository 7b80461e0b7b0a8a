"""Bodies of finite elements that are turned: a system that is turned as a whole does the same thing, turned."""

from __future__ import annotations

import math
from importlib import resources
from pathlib import Path

import numpy as np
import pytest

from ehdmaps.errors import InputError
from mbs import Scene, assemble
from mbs.flexible.plan import Turn, rotation_of
from mbs.model.elements import GROUND, Load, Spring
from mbs.scene.reader import parse_scene
from mbs.scene.specs import FlexibleSpec

HOUSING = Path(str(resources.files("mbs") / "systems" / "n1014_housing.nc"))
TURNS = (Turn("z", math.radians(30.0)), Turn("x", math.radians(-50.0)))
RNG = np.random.default_rng(5)
PULL = RNG.standard_normal(6)
STIFF = np.diag([1e7, 2e7, 5e7, 1e5, 2e5, 3e5])


def placed(turns, position=(0.1, 0.2, 0.3)):
    """The housing, held by one spring and pulled by one load, which turn with it."""
    both = np.kron(np.eye(2), rotation_of(turns))
    body = FlexibleSpec("housing", HOUSING, position, rotation=turns)
    frames = list(
        assemble(Scene(name="alone", speed=0.0, temperature=313.15, bodies=[body])).system.body("housing").frames
    )
    held, pulled = f"housing:{frames[0]}", f"housing:{frames[-1]}"
    spring = Spring("feet", held, GROUND, both @ STIFF @ both.T, np.zeros((6, 6)))
    scene = Scene(
        name="held",
        speed=0.0,
        temperature=313.15,
        bodies=[body],
        springs=[spring],
        loads=[Load("pull", pulled, both @ PULL)],
    )
    return assemble(scene).system, pulled


def test_a_turned_system_moves_as_the_other_one_turned():
    (plain, place), (turned, _) = placed(()), placed(TURNS)
    rotation = rotation_of(TURNS)
    np.testing.assert_allclose(rotation.T @ rotation, np.eye(3), atol=1e-15)
    moved = [
        system.relative(place) @ np.linalg.solve(system.stiffness, system.loads(0.0)) for system in (plain, turned)
    ]
    # round-off of two solutions with a condition of 1e6 or so
    expected = np.kron(np.eye(2), rotation) @ moved[0]
    np.testing.assert_allclose(moved[1], expected, rtol=1e-7, atol=1e-8 * np.abs(expected[3:]).max())
    squares = [np.sort(np.linalg.eigvals(np.linalg.solve(s.mass, s.stiffness)).real) for s in (plain, turned)]
    np.testing.assert_allclose(squares[1], squares[0], rtol=1e-7)
    first, second = (system.body("housing").frames for system in (plain, turned))
    origin = np.array([0.1, 0.2, 0.3])
    for name, frame in first.items():
        np.testing.assert_allclose(second[name].position, origin + rotation @ (frame.position - origin), atol=1e-15)


def test_turns_are_about_the_axes_of_the_system_in_their_order():
    quarter = math.pi / 2.0
    for about, expected in (
        ("x", [[1, 0, 0], [0, 0, -1], [0, 1, 0]]),
        ("y", [[0, 0, 1], [0, 1, 0], [-1, 0, 0]]),
        ("z", [[0, -1, 0], [1, 0, 0], [0, 0, 1]]),
    ):
        np.testing.assert_array_equal(rotation_of([Turn(about, quarter)]), expected)
    np.testing.assert_array_equal(
        rotation_of([Turn("z", quarter), Turn("x", quarter)]) @ [1, 0, 0], [0, 0, 1]
    )  # to y, then to z


TEXT = (resources.files("mbs") / "systems" / "n1014_testrig.toml").read_text(encoding="utf-8")


def scene(rotation):
    line = 'reduced = "n1014_housing.nc"'
    assert line in TEXT
    return parse_scene(TEXT.replace(line, f"{line}\nrotation = {rotation}"), "rig", "rig.toml", HOUSING.parent)


def test_a_scene_says_one_turn_or_several():
    flexible = [body for body in scene('{ about = "y", angle = "180 deg" }').bodies if isinstance(body, FlexibleSpec)]
    (turn,) = flexible[0].rotation
    np.testing.assert_array_equal(turn.matrix, np.diag([-1.0, 1.0, -1.0]))
    two = scene('[{ about = "z", angle = "30 deg" }, { about = "x", angle = "-50 deg" }]')
    read = next(body for body in two.bodies if isinstance(body, FlexibleSpec)).rotation
    # degrees are read with 15 digits
    np.testing.assert_allclose(rotation_of(read), rotation_of(TURNS), atol=1e-14)


@pytest.mark.parametrize(
    ("rotation", "words"),
    [
        ('"90 deg"', "rotation: got '90 deg'; allowed: { about = "),
        ('{ about = "w", angle = "90 deg" }', "about: got 'w'"),
        ('{ about = "x" }', "angle: missing"),
        ('{ about = "x", angle = "90 deg", at = 1 }', "at"),
    ],
)
def test_turns_that_are_none(rotation, words):
    with pytest.raises(InputError, match=words):
        scene(rotation)


def test_values_that_are_no_turn():
    with pytest.raises(InputError) as caught:
        Turn("w", math.inf)
    assert "about: got 'w'; allowed: x, y, z" in str(caught.value)
    assert "angle: got inf rad; allowed: finite" in str(caught.value)
