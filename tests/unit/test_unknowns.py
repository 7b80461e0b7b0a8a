"""What a scene leaves open: half-widths, the machines at their ends, and the statements that narrow them."""

from __future__ import annotations

import math

import numpy as np
import pytest

from ehdmaps.errors import InputError
from ehdmaps.physics.lubricant import Lubricant
from mbs.cli import main
from mbs.scene.reader import parse_scene
from mbs.unknowns.held_open import CAGES, held_open
from mbs.unknowns.statement import known, read_statements

MACHINE = """
schema = 1
{top}
[operation]
speed = "2400 rpm"
temperature = "60 degC"
[lubricant]
name = "ISO VG 68"
[[shafts]]
name = "shaft"
freedoms = ["x", "y", "z", "theta_y", "theta_z"]
sections = [{{ length = "300 mm", diameter = "40 mm" }}]
[[bearings]]
name = "left"
bearing = "NU208"
shaft = "shaft"
position = "20 mm"
{left}
[[bearings]]
name = "right"
bearing = "6206"
shaft = "shaft"
position = "280 mm"
diametral_clearance = "10 um"
[[loads]]
name = "preload"
on = "shaft:left"
force = ["200 N", "0 N", "-400 N"]
"""


def scene(top="", left=""):
    return parse_scene(MACHINE.format(top=top, left=left), "machine", "machine.toml")


def opened(*given):
    return {unknown.name: unknown for unknown in held_open(scene(*given))}


def test_each_unknown_has_the_machines_at_its_ends():
    found, base = opened(), scene()
    clearances = [look.bearings[0].geometry.diametral_clearance for look in found["clearance of left"].looks]
    assert clearances == [5e-6, 50e-6]
    assert base.bearings[0].geometry.diametral_clearance == 27.5e-6
    assert [look.located[0].geometry.clearance for look in found["clearance of right"].looks] == pytest.approx(
        [5e-6, 15e-6]
    )
    assert [look.temperature - base.temperature for look in found["temperature"].looks] == pytest.approx([-5.0, 5.0])
    thin, thick = (base.lubricant.at(look.temperature).viscosity for look in found["viscosity"].looks)
    # a shift of temperature by the slope at the middle: its curvature leaves a thousandth
    here = base.lubricant.at(base.temperature).viscosity
    assert [math.log(thin / here), math.log(thick / here)] == pytest.approx([-0.1, 0.1], rel=0.02)
    (alpha,) = found["pressure-viscosity"].looks
    both = [each.lubricant.at(333.15).pressure_viscosity.pressure_viscosity for each in (base, alpha)]
    assert both[1] / both[0] == pytest.approx(1.25)
    assert found["pressure-viscosity"].reflected
    assert [look.bearings[0].geometry.rollers for look in found["roller count of left"].looks] == [13, 15]
    grooves = [look.located[0].geometry.outer_conformity for look in found["outer groove of right"].looks]
    assert grooves == pytest.approx([0.515, 0.53])
    assert [look.loads[0].force[0] for look in found["preload"].looks] == pytest.approx([160.0, 240.0])
    (straight,) = found["profile of left"].looks
    assert straight.bearings[0].profile == "straight"
    lengths = [look.bearings[0].geometry.roller_length for look in found["roller length of left"].looks]
    assert np.array(lengths) / base.bearings[0].geometry.roller_length == pytest.approx([1.2, 0.8])


def test_oil_layers_are_known_to_a_factor_of_two():
    """All layers together, those of single bearings too; flooded is held, and says nothing."""
    found = opened('[supply]\nlubrication = "oil air"', 'supply = { oil_layer = "5 um" }')["oil layer"]
    assert found.held == "1 to 4 um, 2.5 to 10 um"
    layers = [(look.supply.oil_layer, look.bearings[0].supply.oil_layer) for look in found.looks]
    np.testing.assert_allclose(layers, [(1e-6, 2.5e-6), (4e-6, 10e-6)], rtol=1e-12)
    assert "oil layer" not in opened('[supply]\nlubrication = "flooded"')
    base = scene('[supply]\nlubrication = "oil air"')
    (held,) = [
        one.held for one in held_open(known(base, read_statements("oil_layer = +- 10 %"))) if "layer" in one.name
    ]
    assert held == "1.8 to 2.2 um"


def test_frozen_cages_spread_over_a_pitch_each():
    cages = opened()["cage angle"]
    assert cages.frozen_cage and len(cages.looks) == CAGES
    for place, pitch in ((0, 2.0 * math.pi / 14), (1, 2.0 * math.pi / 9)):
        angles = [look.of_all_kinds[place].start_angle / pitch for look in cages.looks]
        assert np.sort(angles) == pytest.approx((np.arange(CAGES) + 0.5) / CAGES)


def test_another_alpha_keeps_the_curve_near_the_temperature():
    oil = Lubricant.named("ISO VG 68")
    changed = oil.with_alpha(1.1, 333.15)
    for kelvin, within in ((333.15, 1e-9), (335.0, 5e-4)):  # the curvature of ln alpha
        alphas = [each.at(kelvin).pressure_viscosity.pressure_viscosity for each in (changed, oil)]
        assert alphas[0] / alphas[1] == pytest.approx(1.1, rel=within)
    fva3 = Lubricant.named("FVA3")
    alphas = [one.at(313.15).pressure_viscosity.pressure_viscosity for one in (fva3, fva3.with_alpha(1.1, 313.15))]
    assert alphas[1] / alphas[0] == pytest.approx(1.1, rel=1e-12)  # round-off


def test_statements_are_nearest_first():
    """A command goes before a bearing, a bearing before the table; nothing at all is exact."""
    top = '[tolerances]\nclearance = "2 um"\ntemperature = "0 K"\ngeometry = "50 %"\nviscosity = "0 %"'
    found = opened(top, 'profile = "iso"\ndiametral_clearance = "20 um +- 10 %"')
    assert (found["clearance of left"].held, found["clearance of right"].held) == ("20 um +-2 um", "10 um +-2 um")
    assert not {"temperature", "viscosity", "profile of left"} & set(found)
    assert found["ball diameter of right"].held == "+-4 %"
    outer = [look.located[0].geometry.outer_conformity for look in found["outer groove of right"].looks]
    assert outer == pytest.approx([0.5175, 0.525])  # half way from 0.52
    base = scene(top, 'diametral_clearance = "20 um +- 10 %"')
    for text, left, right in (
        ("clearance = 30 um +- 3 um", "30 um +-3 um", "30 um +-3 um"),
        ("clearance of left = +- 1 um", "20 um +-1 um", "10 um +-2 um"),
        ("clearance = 15 um; clearance of right = 12 um +- 4 um", "15 um +-5 um", "12 um +-4 um"),
    ):
        held = {one.name: one.held for one in held_open(known(base, read_statements(text)))}
        assert (held["clearance of left"], held["clearance of right"]) == (left, right)
    exact = known(base, read_statements("; ".join(f"{key} = +- {0} {unit}" for key, unit in UNITS.items())))
    assert [one.name for one in held_open(exact)] == []
    assert {one.group for one in held_open(known(base, read_statements("load = 5 %".replace("=", "= +-"))))} >= {"load"}


UNITS = {"clearance": "um", "temperature": "K", "cage_angle": "deg"} | dict.fromkeys(
    ("viscosity", "pressure_viscosity", "oil_layer", "geometry", "preload", "load", "profile"), "%"
)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("clearence = +- 0 um", r"got 'clearence' \(did you mean 'clearance'\?\); allowed: clearance, temperature"),
        ("clearance", "got 'clearance' without a number"),
        ("clearance = 20 um +- 5 K", "clearance: got '5 K'; allowed: 0 to 1000 um, or 0 % to 100 %, such as 5 um"),
        ("temperature = +- 5 %", "temperature: got '5 %'; allowed: 0 to 50 K, such as 2 K"),
        ("viscosity = 3 um +- 5 %", "allowed: a tolerance alone"),
        ("geometry = +- 2 mm", "geometry: got '2 mm'; allowed: 0 % to 100 %"),
        ("", "got ''; allowed: such as"),
    ],
)
def test_statements_that_are_none(text, said):
    with pytest.raises(InputError, match=said):
        read_statements(text)


def test_what_files_and_commands_refuse(tmp_path, capsys):
    wrong = MACHINE.format(
        top='[tolerances]\nclearence = "2 um"\nload = "2 N"', left='diametral_clearance = "9 um +- 1 K"'
    )
    with pytest.raises(InputError) as caught:
        parse_scene(wrong, "machine", "machine.toml")
    for words in (
        "[tolerances] clearence: unknown key (did you mean 'clearance'?)",
        "[tolerances] load: got '2 N'; allowed: 0 % to 100 %",
        "[[bearings]] left diametral_clearance: got '1 K'",
    ):
        assert any(words in problem for problem in caught.value.problems)
    path = tmp_path / "machine.toml"
    path.write_text(MACHINE.format(top="", left=""))
    assert main(["check", str(path), "--law", "hertz", "--know", "clearance of middle = +- 1 um"]) == 2
    assert "--know: got 'clearance of middle = +- 1 um', but no bearing 'middle'" in capsys.readouterr().err
    stated = ["--know", "clearance of left = 20 um +- 3 um", "--know", "temperature = 70 degC +- 2 K"]
    assert main(["check", str(path), "--law", "hertz", *stated]) == 0
    said = capsys.readouterr().out
    assert "assumed: nothing" not in said
    assert "held open: clearance of left 20 um +-3 um (as stated), clearance of right 10 um +-5 um (stated bare" in said
    assert "70 degC" in said and "    temperature +-" not in said  # which no dry law feels
    assert "    outer groove of right 0.515 to 0.53 of the ball (estimated from a catalogue)\n" in said


SEAT = """
[[bodies]]
name = "foot"
freedoms = ["x", "y", "z"]
mass = "1 kg"
polar_inertia = "1e-3 kg m^2"
transverse_inertia = "1e-3 kg m^2"
[[springs]]
name = "bolts"
on = "foot"
stiffness = "assumed"
"""


def test_an_assumed_stiffness_is_open_to_a_factor_of_three():
    one = parse_scene(MACHINE.format(top="", left="") + SEAT, "machine", "machine.toml")
    (spring,) = one.springs
    np.testing.assert_array_equal(spring.stiffness, np.diag([3e8, 3e8, 3e8, 0.0, 0.0, 0.0]))
    (found,) = [unknown for unknown in held_open(one) if unknown.group == "stiffness"]
    assert found.text == "stiffness of bolts 100 to 900 N/um (not stated: assumed)"
    assert [look.springs[0].stiffness[1, 1] for look in found.looks] == pytest.approx([1e8, 9e8], rel=1e-12)
    for said, ends in (("+- 20 %", [2.4e8, 3.6e8]), ("+- 0 %", [])):
        better = known(one, read_statements(f"stiffness = {said}"))
        looks = [look for unknown in held_open(better) if unknown.group == "stiffness" for look in unknown.looks]
        assert [look.springs[0].stiffness[2, 2] for look in looks] == pytest.approx(ends, rel=1e-12)
    with pytest.raises(InputError, match="stiffness"):
        speeds = SEAT + 'speeds = ["0 rpm", "1 rpm"]\n'
        parse_scene(MACHINE.format(top="", left="") + speeds, "machine", "machine.toml")
