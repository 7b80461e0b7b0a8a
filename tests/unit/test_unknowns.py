"""What a scene leaves open: half-widths, the machines at their ends, and the statements that narrow them."""

from __future__ import annotations

import math

import numpy as np
import pytest

from ehdmaps.physics.lubricant import Lubricant
from mbs.scene.reader import parse_scene
from mbs.unknowns.held_open import CAGES, held_open

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
on = "shaft"
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
    assert [look.bearings[0].geometry.rollers for look in found["number of rollers of left"].looks] == [13, 15]
    grooves = [look.located[0].geometry.outer_conformity for look in found["outer groove of right"].looks]
    assert grooves == pytest.approx([0.515, 0.53])
    assert [look.loads[0].force[0] for look in found["preload"].looks] == pytest.approx([160.0, 240.0])
    (straight,) = found["profile of left"].looks
    assert straight.bearings[0].profile == "straight"
    lengths = [look.bearings[0].geometry.roller_length for look in found["roller length of left"].looks]
    assert np.array(lengths) / base.bearings[0].geometry.roller_length == pytest.approx([1.2, 0.8])


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
    assert Lubricant.named("FVA3").with_alpha(1.1, 333.15) is None  # whose measured law gives alpha
