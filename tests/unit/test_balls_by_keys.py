"""Ball bearings by their keys: in braces, in files and in scenes."""

from __future__ import annotations

import math

import pytest

from ehdmaps.errors import InputError
from ehdmaps.jobs.balls import balls_of
from ehdmaps.physics.designations.estimates import estimated_parts
from ehdmaps.physics.point.ball_catalogue import ball_estimate
from ehdmaps.physics.point.ball_geometry import BallGeometry
from ehdmaps.physics.solids import STEEL
from mbs.scene.reader import parse_scene
from tests.cases.commands import run

KEYS = """balls = 7
ball_diameter = "11.5 mm"
pitch_diameter = "43.5 mm"
inner_groove_radius = 0.52
outer_groove_radius = "6.095 mm"
contact_angle = "15 deg"
ball_material = "silicon nitride"
"""
SCENE = """
schema = 1
[operation]
speed = "1000 rpm"
temperature = "40 degC"
[[bodies]]
name = "shaft"
freedoms = ["x", "y", "z"]
mass = "1 kg"
polar_inertia = "1e-3 kg m^2"
transverse_inertia = "1e-3 kg m^2"
[[bearings]]
name = "front"
inner = "shaft:centre"
outer = "ground"
geometry = {}
"""


def in_braces(keys: str) -> str:
    return "{ " + ", ".join(keys.strip().splitlines()) + " }"


def test_the_same_keys_everywhere(tmp_path):
    """In braces, in a file and in a scene: one bearing, all of it known."""
    path = tmp_path / "own.toml"
    path.write_text(f"[bearing]\n{KEYS}", encoding="utf-8")
    found = balls_of(in_braces(KEYS))
    assert isinstance(found, BallGeometry)
    assert found.outer_conformity == pytest.approx(6.095 / 11.5)
    assert found.contact_angle == pytest.approx(math.radians(15.0))
    assert found.estimated is None and not list(estimated_parts(found))
    assert balls_of(str(path)) == found
    scene = parse_scene(SCENE.format(in_braces(KEYS)), "one", "one.toml")
    assert scene.located[0].geometry == found


def test_what_is_known_of_a_designation_is_open_no_more():
    found = balls_of('{ name = "7208C", outer_groove_radius = 0.53, balls = 15 }')
    estimate = ball_estimate("7208C")
    assert (found.ball_diameter, found.inner_conformity) == (estimate.ball_diameter, estimate.inner_conformity)
    assert [part.name for part in estimated_parts(found)] == ["pitch diameter", "ball diameter", "inner groove"]


def test_silicon_nitride_is_stiffer_and_lighter():
    """E' of the pair is 1.181 of that of steel, k at equal load goes with its power 2/3; a mass is 0.41."""
    hybrid, steel = balls_of('{ name = "7208C", ball_material = "silicon nitride" }'), ball_estimate("7208C")
    for own, usual in zip(hybrid.contacts(STEEL), steel.contacts(STEEL), strict=True):
        assert own.reduced_modulus / usual.reduced_modulus == pytest.approx(1.181, abs=1e-3)
        assert own.stiffness(100.0) / usual.stiffness(100.0) == pytest.approx(1.181 ** (2.0 / 3.0), abs=1e-3)
    assert hybrid.ball_mass(STEEL) / steel.ball_mass(STEEL) == pytest.approx(3200.0 / 7850.0)


def test_commands_take_keys(capsys, tmp_path, monkeypatch):
    """Looser grooves are softer along the axis, by some 10 to 20 %; `ehdmaps solve` takes the same keys."""
    monkeypatch.chdir(tmp_path)
    ask = ("--load", "0 N", "--axial", "500 N", "--speed", "0 rpm", "--law", "hertz", "-o")
    stiffness = []
    for number, name in enumerate(
        ("7208C", '{ name = "7208C", inner_groove_radius = 0.52, outer_groove_radius = 0.53 }')
    ):
        status, page, err = run(capsys, "bearing", name, *ask, f"{number}.csv")
        assert status == 0, err
        assert ("groove" in page.partition("(ISO 76)")[2].partition("\n")[0]) == (number == 0)
        head, values = (tmp_path / f"{number}.csv").read_text(encoding="utf-8").splitlines()[-2:]
        stiffness.append(float(dict(zip(head.split(","), values.split(","), strict=True))["stiffness_axial [N/m]"]))
    assert 0.75 < stiffness[1] / stiffness[0] < 0.95
    status, page, err = run(capsys, "bearing", in_braces(KEYS), "--load", "100 N", *ask[2:-1])
    assert status == 0, err
    assert "7 balls of 11.5 mm" in page and "balls of 310 GPa, 0.26, 3200 kg/m3" in page


def test_rollers_in_braces(capsys):
    status, page, err = run(
        capsys, "bearing", '{ name = "NU308" }', "--load", "1 kN", "--speed", "0 rpm", "--law", "hertz"
    )
    assert status == 0, err
    assert page.startswith("NU308: ")


@pytest.mark.parametrize(
    ("keys", "words"),
    [
        ("{ balls = 9 }", "ball_diameter: missing"),
        ('{ name = "6208", inner_groove_radius = 0.4 }', "inner_groove_radius: got 0.4; allowed: 0.5 to 1"),
        ('{ name = "6208", ball_material = "gold" }', "ball_material: got 'gold'; allowed: 'steel', 'silicon nitride'"),
        ('{ name = "6208", rollers = 9 }', "rollers: unknown key"),
        ('{ name = "6208", balls = 30 }', "30 balls of"),
        ('{ name = "6299" }', "name: "),
        ("{ balls = ", "is not TOML"),
    ],
)
def test_refused_keys(keys, words):
    with pytest.raises(InputError, match="BEARING") as caught:
        balls_of(keys)
    assert words in str(caught.value)
