"""Bearings, profiles, laws and arguments that are refused, and what a material changes."""

from __future__ import annotations

import math

import numpy as np
import pytest

from ehdmaps.errors import InputError, OutsideMapError, SolverError
from ehdmaps.maps.law import ContactLaw
from ehdmaps.physics.bearing import BearingGeometry
from ehdmaps.physics.solids import STEEL, Material
from ehdmaps.physics.surface import iso_profile
from mbs.bearings import laws
from mbs.bearings.bearing import Bearing
from mbs.bearings.bearing_force import BearingForce
from tests.cases.bearings import AT, LAWS, bearing, force, map_law, single_law
from tests.cases.laws import CONTACTS, OIL, SMALL_FIELD

POSE = np.array([0.0, 7e-6, 9e-6, 0.0, 1e-4, -2e-4])


def test_long_rollers_are_straight_in_the_middle():
    x = np.array([0.0, 4e-3, 6e-3, 20e-3, 24.9e-3])
    depth = iso_profile(x, 14e-3, 50e-3)
    part = (2 * 24.9e-3 - 15e-3) / 35e-3
    np.testing.assert_allclose(depth[:3], 0.0, atol=0.0)
    assert depth[4] == pytest.approx(0.0005 * 14e-3 * math.log(1.0 / (1.0 - part**2)), rel=1e-12)


def test_profiles_of_the_user():
    parabola = bearing(profile=lambda x: 0.05 * x**2, slices=31)
    np.testing.assert_allclose(parabola.profile_depths, 0.05 * parabola.slice_positions**2)
    array = bearing(profile=parabola.profile_depths, slices=31)
    pose = [0.0, 8e-6, 0.0, 0.0, 0.0, 0.0]
    law = laws.hertz(parabola)
    np.testing.assert_array_equal(BearingForce(parabola, law)(pose)[1], BearingForce(array, law)(pose)[1])
    assert BearingForce(parabola, law, slices=11).bearing.slices == 11


@pytest.mark.parametrize(
    ("keywords", "text"),
    [
        ({"slices": 0}, "slices: got 0; allowed: a whole number from 1 to 100000"),
        ({"slices": 2.0}, r"slices: got 2\.0"),
        ({"profile": "crowned"}, "profile: got 'crowned'; allowed: iso, straight"),
        ({"profile": [0.0, 1e-6]}, r"shape \(2,\); allowed: \(41,\), one a slice"),
        ({"profile": np.full(41, np.nan)}, "profile: got nan m; allowed: finite and smaller than the roller diameter"),
        ({"profile": lambda x: "deep"}, "profile: got 'deep'; allowed: real numbers"),
        ({"clearance": math.nan}, "diametral_clearance: got nan m; allowed: finite"),
        ({"clearance": 0.02}, "smaller than the roller_diameter"),
        ({"clearance": "20 um"}, "clearance: got '20 um'; allowed: a number of metres"),
    ],
)
def test_bad_bearings(keywords, text):
    with pytest.raises(InputError, match=text):
        bearing(**keywords)


@pytest.mark.parametrize(
    ("call", "text"),
    [
        (
            lambda: laws.hertz(bearing(), damping=-1.0),
            r"law 'hertz', damping: got -0\.5 N s/m; allowed: finite and >= 0",
        ),
        (lambda: laws.constant(0.0), r"law 'constant', coefficient: got 0\.0 N/m\^exponent; allowed: finite and > 0"),
        (lambda: laws.constant(math.inf), "coefficient: got inf"),
        (lambda: laws.constant("stiff"), "law 'constant', stiffness: got 'stiff'; allowed: a finite number"),
        (lambda: laws.PowerLaw("x", "series", 1.0, 0.5, 0.0), "exponent: got 0.5; allowed: 1 to 3"),
        (lambda: laws.formula(bearing(), OIL, load=(1e3, 1e2)), r"law 'formula', load: got \(1000.0, 100.0\)"),
        (lambda: laws.formula(bearing(), OIL, kind="line"), "kind: got 'line'; allowed: series, inner, outer"),
    ],
)
def test_bad_laws(call, text):
    with pytest.raises(InputError, match=text):
        call()


def test_formula_without_a_film_says_where():
    class NoFilm:
        def solve_line(self, contact, lubricant, loads, speed, temperature):
            from ehdmaps.physics.solution import FilmSolution, Status

            return tuple(FilmSolution(status=Status.OUTSIDE_VALIDITY, reason="no film") for _ in loads)

    with pytest.raises(SolverError, match=r"no film at 1000 N/m, 1 m/s, 330 K \(no film\)"):
        laws._films(CONTACTS[0], OIL, NoFilm(), np.array([1e3]), np.array([1.0]), np.array([330.0]))


def test_laws_that_do_not_belong():
    with pytest.raises(InputError, match=r"bearing: got str; allowed: mbs\.Bearing"):
        BearingForce("NU308", LAWS["hertz"]())
    with pytest.raises(InputError, match=r"law: got str; allowed: a law of mbs\.bearings\.laws"):
        BearingForce(bearing(), "hertz")
    with pytest.raises(InputError, match="got the law 'inner'; allowed: 'series'"):
        BearingForce(bearing(), single_law("inner"))
    with pytest.raises(InputError, match="got the law of a single contact"):
        BearingForce(bearing(), LAWS["hertz"]().single())
    with pytest.raises(InputError, match="got 'error' with a law made with 'clamp'"):
        BearingForce(bearing(), map_law(), outside="error")
    with pytest.raises(InputError) as caught:
        BearingForce(Bearing.named("N1014"), map_law())
    assert len(caught.value.problems) == 4
    assert "contact 'inner', radius: got 0.00551515 m; the bearing 'N1014' has 0.00405495 m" in str(caught.value)
    BearingForce(bearing(), map_law(), outside="clamp")


@pytest.mark.parametrize(
    ("arguments", "keywords", "text"),
    [
        (([0.0] * 5,), {}, r"pose: got an array of shape \(5,\); allowed: \(6,\)"),
        ((5e-6,), {}, r"pose: got an array of shape \(\)"),
        (("here",), {}, "pose: got 'here'; allowed: six real numbers"),
        (([0.0] * 6, [0.0] * 3), {}, r"velocity: got an array of shape \(3,\)"),
        (([0.0, math.nan, 0, 0, 0, 0],), {}, r"pose: got \[0.0, nan"),
        (([0.0] * 6, [0.0, 0, 0, 0, 0, math.inf]), {}, "velocity: got .*inf.*; allowed: finite numbers"),
        (([0.0] * 6,), {"cage_angle": math.nan}, r"cage_angle: got \[nan\]"),
        (([0.0, 1.0, 0, 0, 0, 0],), {}, r"y = 1 m, .*; allowed: within 0.014 m \(the roller diameter\)"),
        (([0.0, 0, 0, 0, 0, -1.0],), {}, "theta_z = -1 rad; allowed: .* 0.5 rad"),
        (([0.0] * 6,), {"entrainment_speed": math.nan}, "entrainment_speed: got nan; .* needs a finite number"),
        (([0.0] * 6,), {"temperature": "hot"}, "temperature: got 'hot'; allowed: a finite number"),
        (([0.0] * 6,), {"centrifugal_load": -1.0}, "centrifugal_load: got -1 N/m; allowed: 0 to below the highest"),
        (([0.0] * 6,), {"centrifugal_load": 1e9}, "centrifugal_load: got 1e[+]09 N/m"),
    ],
)
def test_bad_arguments(arguments, keywords, text):
    with pytest.raises(InputError, match=text):
        force()(*arguments, **{**AT, **keywords})


def test_dry_law_takes_no_centrifugal_load():
    with pytest.raises(InputError, match=r"centrifugal_load: got 5\.0 N/m with the law 'hertz'; allowed: 0"):
        force("hertz")(POSE, centrifugal_load=5.0)


def test_outside_the_map_is_an_error_by_default():
    element = BearingForce(bearing(), ContactLaw("series", CONTACTS, OIL, SMALL_FIELD))
    with pytest.raises(OutsideMapError, match=r"load: got about .* N/m in a slice at the pose .*mapped: up to 1e[+]06"):
        element([0.0, 60e-6, 0.0, 0.0, 0.0, 0.0], **AT)
    with pytest.raises(OutsideMapError, match="entrainment_speed: got 9 m/s"):
        element(POSE, entrainment_speed=9.0, temperature=330.0)
    with pytest.raises(OutsideMapError, match="temperature: got 400 K"):
        element(POSE, entrainment_speed=1.0, temperature=400.0)


def test_bearing_of_another_material_is_softer():
    soft = Bearing(BearingGeometry.named("NU308"), material=Material(70e9, 0.3, 2700.0))
    assert laws.hertz(soft).coefficient == pytest.approx(laws.hertz(bearing()).coefficient / 3.0)
    assert soft.roller_mass == pytest.approx(2700.0 * math.pi / 4 * 14e-3**2 * 15e-3)
    assert soft.material is not STEEL
