"""Profiles of rollers in scenes: arcs and tables beside their closed forms, and what is refused."""

from __future__ import annotations

import dataclasses
import math
from importlib import resources

import numpy as np
import pytest

from ehdmaps.errors import InputError
from ehdmaps.physics.bearing import BearingGeometry
from ehdmaps.physics.surface import CrownedProfile, TabulatedProfile, iso_profile
from mbs import assemble
from mbs.bearings.bearing import Bearing
from mbs.bearings.bearing_force import BearingForce
from mbs.bearings.laws import hertz
from mbs.scene.reader import parse_scene

TEXT = (resources.files("mbs") / "systems" / "nu308_rigid.toml").read_text(encoding="utf-8")
NU308 = BearingGeometry.named("NU308").without_clearance
HALF = 0.5 * NU308.roller_length


def scene(profile):
    return parse_scene(TEXT.replace('profile = "iso"', f"profile = {profile}"), "shaft", "shaft.toml")


def test_an_arc_is_that_of_a_circle_and_its_drop_that_of_the_ends():
    x = np.linspace(-HALF, HALF, 31)
    radius, straight = 0.05, 6e-3
    beyond = np.maximum(np.abs(x) - 0.5 * straight, 0.0)
    circle = radius - np.sqrt(radius**2 - beyond**2)
    # round-off of the closed form, which takes the difference of two radii
    np.testing.assert_allclose(CrownedProfile(radius, straight)(x), circle, atol=1e-16)
    by_drop = CrownedProfile.of_drop(8e-6, 2.0 * HALF, straight)
    assert by_drop(np.array([HALF]))[0] == pytest.approx(8e-6, rel=1e-12)


def test_a_scene_takes_an_arc_or_a_table():
    arc, table = scene('{ crown_drop = "8 um", straight = "6 mm" }'), "positions = {}, depths = {}"
    assert arc.bearings[0].profile == CrownedProfile.of_drop(8e-6, 2.0 * HALF, 6e-3)
    assert scene('{ crown_radius = "5 m" }').bearings[0].profile == CrownedProfile(5.0)
    words = table.format(["-8 mm", "0 mm", "8 mm"], ["3 um", "0 um", "5 um"])
    given = scene(f"{{ {words} }}".replace("'", '"'))
    assert given.bearings[1].profile == TabulatedProfile((-8e-3, 0.0, 8e-3), (3e-6, 0.0, 5e-6))
    bearing = assemble(given).bearings[0].bearing
    np.testing.assert_allclose(
        bearing.profile_depths[[0, -1]], np.array([3e-6, 5e-6]) * bearing.slice_positions[-1] / 8e-3
    )


def test_a_table_of_the_iso_profile_bears_as_the_iso_profile_does():
    places = np.linspace(0.0, HALF * (1.0 - 1e-6), 4001)
    depths = iso_profile(places, NU308.roller_diameter, NU308.roller_length)
    table = TabulatedProfile((*places, HALF), (*depths, depths[-1]))
    iso, tabled = (BearingForce(bearing, hertz(bearing)) for bearing in (Bearing(NU308), Bearing(NU308, table)))
    pose = np.array([0.0, 8e-6, 3e-6, 0.0, 2e-4, 1e-4])
    still = np.zeros(6)
    speeds = {"entrainment_speed": 0.8, "temperature": 313.15}
    # straight lines between 4001 points: h^2 P''/8 of the steepest slice, 3e-5 of its depth
    np.testing.assert_allclose(tabled(pose, still, **speeds)[0], iso(pose, still, **speeds)[0], rtol=2e-4, atol=1e-6)


def test_crowned_rollers_under_a_tilt_bear_as_the_closed_integral_says():
    # one roller at y, pressed by s, tilted by psi: q(x) = c (s + psi x - 2 x^2/(2 R))^(10/9), summed finely
    bearing = Bearing(dataclasses.replace(NU308, rollers=1), CrownedProfile(2.0), 201)
    pose = np.array([0.0, 2e-5, 0.0, 0.0, 0.0, 3e-4])
    found = BearingForce(bearing, hertz(bearing))(pose, np.zeros(6), entrainment_speed=0.8, temperature=313.15)
    load = -found[0][1]
    constant = 35948.0 * (NU308.roller_length * 1e3) ** (8.0 / 9.0)
    fine = np.linspace(-HALF, HALF, 200_001)
    inside = np.maximum(2e-5 + 3e-4 * fine - fine**2 / 2.0, 0.0) * 1e3
    expected = constant * np.trapezoid(inside ** (10.0 / 9.0), fine) / (2.0 * HALF)
    assert load == pytest.approx(expected, rel=1e-4)  # midpoint rule of 201 slices


@pytest.mark.parametrize(
    ("profile", "words"),
    [
        ('"crowned"', "profile: got 'crowned'; allowed: iso, straight, { crown_radius"),
        ('{ crown_drop = "8 um", crown_radius = "1 m" }', "allowed: iso, straight"),
        ('{ crown_radius = "5 mm" }', "crown_radius: got 5 mm; allowed: an arc that reaches the ends"),
        ('{ crown_radius = "5 m", straight = "15 mm" }', "straight: got 15 mm; allowed: below the roller"),
        ('{ crown_drop = "8 um", straight = "15 mm" }', "crowned profile, drop: got 8e-06 m"),
        ('{ positions = ["0 mm", "5 mm"], depths = ["0 um", "1 um"] }', "positions: got 0 mm to 5 mm; allowed: from 0"),
        ('{ positions = ["0 mm", "8 mm"], depths = ["0 um"] }', "got 2 positions and 1 depths"),
        (
            '{ positions = ["8 mm", "0 mm"], depths = ["0 um", "1 um"] }',
            "positions: got .* finite and rising",
        ),
        ('{ positions = "0 mm", depths = ["0 um"] }', "positions: got '0 mm'; allowed: a list of lengths"),
        ('{ crown_drop = "8 um", depth = "1 um" }', "depth"),
    ],
)
def test_profiles_that_no_roller_has(profile, words):
    with pytest.raises(InputError, match=words):
        scene(profile)


def test_values_that_are_no_profile():
    for make, words in (
        (lambda: CrownedProfile(0.0), "radius: got 0.0 m"),
        (lambda: CrownedProfile(1.0, math.nan), "straight: got nan m"),
        (lambda: TabulatedProfile((0.0, 1.0), (0.0, math.inf)), "depths: got"),
    ):
        with pytest.raises(InputError, match=words):
            make()
