"""The bearing force element: against its law slice by slice, its derivatives, its limits and its messages."""

from __future__ import annotations

import math
import subprocess
import sys

import numpy as np
import pytest
from numba import njit

from ehdmaps.errors import InputError, MapError, OutsideMapError, SolverError
from ehdmaps.maps.emap import EHDMap
from ehdmaps.maps.law import ContactLaw
from ehdmaps.physics.bearing import BearingGeometry
from ehdmaps.physics.solids import STEEL, Material
from mbs.bearings import laws
from mbs.bearings.bearing import Bearing, iso_profile
from mbs.bearings.bearing_force import BearingForce
from mbs.bearings.bearing_kernel import force_of_arrays
from mbs.bearings.kinematics import RingState, axial_rotation, relative_motion, spin
from mbs.bearings.roller_contacts import RollerContacts
from tests.unit.law_cases import CONTACTS, OIL, SMALL_FIELD, dataset_of
from tests.unit.mbs_cases import AT, LAWS, PLANE, bearing, central_difference, force, map_law, single_law

POSE = np.array([0.0, 7e-6, 9e-6, 0.0, 1e-4, -2e-4])
VELOCITY = np.array([0.0, 2e-4, -3e-4, 0.0, 1e-2, 2e-2])


def test_import_is_light():
    code = "import mbs, sys; print([m for m in ('numba', 'scipy', 'xarray', 'matplotlib') if m in sys.modules])"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


# The sum over slices


def summed(element, pose, velocity, cage_angle, law):
    """Force, stiffness and damping by summing a law over slices, law(delta, rate) -> w, k, c per unit length."""
    each = element.bearing
    x, geometry = each.slice_positions, each.geometry
    f, K, C = np.zeros(6), np.zeros((6, 6)), np.zeros((6, 6))
    for j in range(geometry.rollers):
        angle = cage_angle + 2.0 * math.pi * j / geometry.rollers
        c, s = math.cos(angle), math.sin(angle)
        row = np.array([0 * x, c + 0 * x, s + 0 * x, 0 * x, -x * s, x * c])
        delta = pose @ row - 0.5 * geometry.diametral_clearance - 2.0 * each.profile_depths
        w, k, d = (part * each.slice_length for part in law(delta, velocity @ row))
        f -= row @ w
        K += row * k @ row.T
        C += row * d @ row.T
    return f, K, C


CONDITIONS = {
    "mapped": (1.0, 330.0, 0.0),
    "slowest": (0.3, 330.0, 0.0),
    "faded": (0.1, 330.0, 0.0),
    "backwards": (-1.3, 320.0, 0.0),
    "standstill": (0.0, 330.0, 0.0),
    "centrifugal": (2.0, 320.0, 300.0),
    "faded and centrifugal": (0.1, 320.0, 40.0),
    "standstill and centrifugal": (0.0, 320.0, 40.0),
    "too fast": (5.0, 320.0, 0.0),
    "too hot": (1.0, 390.0, 0.0),
}


@pytest.mark.parametrize("velocity", [0.0, 1.0, 300.0])
@pytest.mark.parametrize("conditions", CONDITIONS.values(), ids=CONDITIONS)
def test_map_law_is_summed_over_the_slices(conditions, velocity):
    law = map_law()
    element = force(clearance=4e-6)
    speed, temperature, centrifugal_load = conditions
    *got, outside = element.evaluate(
        POSE,
        velocity * VELOCITY,
        cage_angle=0.4,
        entrainment_speed=speed,
        temperature=temperature,
        centrifugal_load=centrifugal_load,
    )
    expected = summed(element, POSE, velocity * VELOCITY, 0.4, lambda d, r: law(d, r, *conditions))
    assert outside == (speed > 3.0 or temperature > 343.15)
    for a, b in zip(got, expected, strict=True):
        scale = np.sqrt(np.abs(np.outer(np.diag(b), np.diag(b)))) if b.ndim == 2 else np.max(np.abs(b))
        # the table of the element against the law; more where a coordinate has little stiffness at a high rate
        assert np.all(np.abs(a - b) <= (1e-6 if velocity < 100.0 else 5e-6) * scale + 1e-300)


@pytest.mark.parametrize("speed", [0.0, 0.1, 1.0])
def test_above_the_highest_load_the_law_goes_on(speed):
    pose = np.array([0.0, 60e-6, 0.0, 0.0, 0.0, 0.0])
    element, law = force(), map_law()
    *got, outside = element.evaluate(pose, entrainment_speed=speed, temperature=330.0)
    expected = summed(element, pose, np.zeros(6), 0.0, lambda d, r: law(d, r, speed, 330.0))
    for a, b in zip(got, expected, strict=True):
        np.testing.assert_allclose(a, b, rtol=1e-7, atol=1e-7 * np.max(np.abs(b)))
    assert outside
    assert not element.evaluate(0.1 * pose, entrainment_speed=speed, temperature=330.0).outside
    f, K, C = element(pose, entrainment_speed=speed, temperature=330.0)
    for a, b in zip((f, K, C), got, strict=True):
        np.testing.assert_array_equal(a, b)


@pytest.mark.parametrize("name", ["hertz", "damped hertz", "constant"])
def test_dry_laws_are_summed_over_the_slices(name):
    element, law = force(name, clearance=4e-6), LAWS[name]()
    for velocity in (0.0 * VELOCITY, VELOCITY, 300.0 * VELOCITY):
        got = element(POSE, velocity, cage_angle=0.4)
        expected = summed(
            element,
            POSE,
            velocity,
            0.4,
            lambda d, r: tuple(part / element.bearing.geometry.roller_length for part in law.evaluate(d, r)),
        )
        for a, b in zip(got, expected, strict=True):
            np.testing.assert_allclose(a, b, rtol=1e-12, atol=1e-12 * np.max(np.abs(b)))


def test_constant_law_is_half_of_each_contact():
    element = BearingForce(bearing(profile="straight"), laws.constant(2e8, 50.0))
    # one roller in line with the displacement, two at 30 and two at 60 degrees
    total = 1.0 + 2.0 * 0.75 + 2.0 * 0.25
    f, K, C = element([0.0, 5e-6, 0.0, 0.0, 0.0, 0.0], [0.0, 1e-3, 0.0, 0.0, 0.0, 0.0])
    assert f[1] == pytest.approx(-(1e8 * 5e-6 + 25.0 * 1e-3) * total, rel=1e-9)
    assert K[1, 1] == pytest.approx(1e8 * total, rel=1e-9)
    assert C[1, 1] == pytest.approx(25.0 * total, rel=1e-9)


def test_formula_law_stands_between_dry_and_film():
    each = bearing()
    law = laws.formula(
        each, OIL, load=(1e3, 1e6), entrainment_speed=(0.3, 3.0), temperature=(313.15, 343.15), outside="clamp"
    )
    element = BearingForce(each, law)
    pose = [0.0, 8e-6, 0.0, 0.0, 0.0, 0.0]
    film, _, C = element(pose, **AT)
    dry, _, no_damping = element(pose, entrainment_speed=0.0, temperature=330.0)
    # films take room: the same pose carries more
    assert film[1] < 1.05 * dry[1] < 0.0
    assert C[1, 1] > 0.0
    assert np.all(no_damping == 0.0)


def test_at_gives_the_same_numbers_as_calling():
    element = force()
    point = element.at(1.0, 330.0)
    for got, expected in zip(point(POSE, VELOCITY, 0.3), element(POSE, VELOCITY, cage_angle=0.3, **AT), strict=True):
        np.testing.assert_array_equal(got, expected)
    # results are their own, whatever is called next
    f, K, _ = point(POSE)
    kept = f.copy(), K.copy()
    point(2.0 * POSE)
    np.testing.assert_array_equal(f, kept[0])
    np.testing.assert_array_equal(K, kept[1])


def test_results_do_not_depend_on_what_was_called_before():
    element = force()
    first = element(POSE, **AT)
    element(POSE, entrainment_speed=0.0, temperature=330.0)
    element(POSE, entrainment_speed=0.1, temperature=330.0)
    element([0.0, 60e-6, 0.0, 0.0, 0.0, 0.0], **AT)
    for got, expected in zip(element(POSE, **AT), first, strict=True):
        np.testing.assert_array_equal(got, expected)


def test_other_compiled_code_calls_the_kernel():
    point = force().at(1.0, 330.0)
    expected = point(POSE, VELOCITY, 0.3)

    @njit
    def twice(state, sizes, slices, angles, numbers, cells, rows, states, out):
        status = 0
        for _ in range(2):
            status += force_of_arrays(state, sizes, slices, angles, numbers, cells, rows, states, out)
        return status

    out = np.empty((13, 6))
    assert twice(*point.arrays, out) == 0
    np.testing.assert_array_equal(out, np.vstack([expected[0], expected[1], expected[2]]))


# Derivatives


def near_edges(element, random):
    """Random poses, half of them with a roller within nanometres of the edge of the load zone."""
    for i in range(24):
        pose = np.zeros(6)
        pose[PLANE] = random.normal(0.0, [8e-6, 8e-6, 2e-4, 2e-4])
        if i % 2:
            # let the middle of roller 3 be at the edge
            angle = 0.2 + 2.0 * math.pi * 3 / element.bearing.geometry.rollers
            gap = random.normal(0.0, 3e-9) + 0.5 * element.bearing.geometry.diametral_clearance
            pose[1] += (gap - pose[1] * math.cos(angle) - pose[2] * math.sin(angle)) / math.cos(angle)
        yield pose


@pytest.mark.parametrize("conditions", [(1.0, 330.0), (0.1, 330.0), (0.0, 330.0)])
@pytest.mark.parametrize("name", LAWS)
@pytest.mark.parametrize("clearance", [0.0, 10e-6])
def test_matrices_are_the_derivatives(name, clearance, conditions):
    if name != "map" and conditions[0] != 1.0:
        return
    random = np.random.default_rng(7)
    element = force(name, clearance=clearance).at(*conditions)
    step = np.array([1e-9, 2e-11, 2e-11, 1e-6, 2e-9, 2e-9])
    dry = name != "map" or conditions[0] == 0.0
    for pose in near_edges(force(name, clearance=clearance), random):
        velocity = np.zeros(6)
        velocity[PLANE] = random.normal(0.0, [1e-3, 1e-3, 0.1, 0.1])
        if dry:
            # the dry slope is singular, or jumps, at lift-off: leave out slices within the step of it
            approach = element.rollers(pose, velocity, 0.2).approach
            if np.min(np.abs(approach)) < 2e-9:
                continue
        _, K, C = element(pose, velocity, 0.2)
        for matrix, found in (
            (K, -central_difference(lambda at, v=velocity: element(at, v, 0.2)[0], pose, step)),
            (C, -central_difference(lambda at, p=pose: element(p, at, 0.2)[0], velocity, 1e6 * step)),
        ):
            scale = np.sqrt(np.outer(np.diag(K), np.diag(K)) if matrix is K else np.outer(np.diag(C), np.diag(C)))
            assert np.all(np.abs(matrix - found) <= 1e-6 * scale + 1e-300)
            np.testing.assert_array_equal(matrix, matrix.T)
            assert np.all(matrix[[0, 3]] == 0.0)


def test_dry_derivatives_stay_exact_outside_the_singular_edge():
    # this is a check of the test above: most poses are not left out
    element, kept = force("hertz").at(), 0
    for pose in near_edges(force("hertz"), np.random.default_rng(7)):
        kept += np.min(np.abs(element.rollers(pose, None, 0.2).approach)) >= 2e-9
    assert kept >= 12


# No jumps


def largest_step(values):
    return np.max(np.abs(np.diff(values, axis=0)))


@pytest.mark.parametrize("clearance", [0.0, 20e-6])
def test_force_has_no_jump_from_rest_to_full_speed(clearance):
    element = force(clearance=clearance)
    pose = np.array([0.0, 0.5 * clearance + 4e-6, 1e-6, 0.0, 1e-4, 0.0])

    def along(speeds):
        return np.array([element(pose, entrainment_speed=u, temperature=330.0)[0] for u in speeds])

    speeds = np.linspace(0.0, 3.0, 61)
    coarse, fine = largest_step(along(speeds)), largest_step(along(np.linspace(0.0, 3.0, 481)))
    assert fine < 0.2 * coarse  # a jump would stay
    for u in (0.0, 0.3):  # where the element changes its way of evaluation
        f = along([u - 1e-12, u, u + 1e-12])
        np.testing.assert_allclose(f[[0, 2]], f[[1, 1]], atol=2e-8 * np.max(np.abs(f)))


@pytest.mark.parametrize("name", ["hertz", "map"])
def test_force_has_no_jump_at_light_load_and_lift_off(name):
    element = force(name, clearance=20e-6).at(1.0, 330.0)
    places = np.linspace(-3e-4, 2e-5, 20001)
    f = np.array([element([0.0, y, 0.0, 0.0, 0.0, 0.0])[0][1] for y in places])
    stiffest = element([0.0, -3e-4, 0.0, 0.0, 0.0, 0.0])[1][1, 1] if name == "hertz" else None
    steps = np.abs(np.diff(f))
    k = np.array([element([0.0, y, 0.0, 0.0, 0.0, 0.0])[1][1, 1] for y in places[:: len(places) - 1]])
    assert np.max(steps) <= 1.01 * (stiffest or np.max(k)) * (places[1] - places[0])


def test_a_slice_that_is_torn_off_does_not_pull():
    element = force().at(1.0, 330.0)
    for speed in np.geomspace(1e-6, 10.0, 15):
        loads = element.rollers(POSE, [0.0, -speed, -speed, 0.0, 0.0, 0.0]).load_per_length
        assert np.all(loads >= 0.0)


# What it shows


def test_roller_loads_add_up_to_the_force():
    element = force(clearance=10e-6)
    f, _, _ = element(POSE, VELOCITY, cage_angle=0.3, **AT)
    rollers = element.rollers(POSE, VELOCITY, cage_angle=0.3, **AT)
    assert rollers.load.shape == (12,)
    assert rollers.load_per_length.shape == rollers.approach.shape == (12, 41)
    c, s = np.cos(rollers.angle), np.sin(rollers.angle)
    parts = [-c @ rollers.load, -s @ rollers.load, s @ rollers.moment, -c @ rollers.moment]
    np.testing.assert_allclose(parts, f[PLANE], rtol=1e-9)


def test_load_zone_widens_with_the_load():
    element = force("hertz", clearance=20e-6)
    light = element.rollers([0.0, 11e-6, 0.0, 0.0, 0.0, 0.0]).load_zone()
    heavy = element.rollers([0.0, 40e-6, 0.0, 0.0, 0.0, 0.0]).load_zone()
    np.testing.assert_allclose(light, [0.0], atol=1e-12)
    np.testing.assert_allclose(np.degrees(heavy), [-60.0, -30.0, 0.0, 30.0, 60.0], atol=1e-9)


def test_films_are_those_of_the_map():
    emap = EHDMap(dataset_of())
    element = BearingForce(bearing(clearance=20e-6), emap.law("series", "clamp"))
    rollers = element.rollers([0.0, 14e-6, 0.0, 0.0, 0.0, 0.0], entrainment_speed=1.2, temperature=323.15)
    films = rollers.films(emap, 1.2, 323.15)
    assert films.shape == (12, 2)
    heaviest = int(np.argmax(rollers.load))
    data = emap.dataset["central_film"].sel(entrainment_speed=1.2, temperature=323.15)
    for i, contact in enumerate(("inner", "outer")):
        expected = np.exp(
            np.interp(
                np.log(rollers.load[heaviest] / 15e-3),
                np.log(data["load"].values),
                np.log(data.sel(contact=contact).values),
            )
        )
        assert films[heaviest, i] == pytest.approx(expected, rel=1e-9)
    assert np.isnan(films[rollers.load < 1e3 * 15e-3]).all()
    assert np.isnan(rollers.films(emap, 99.0, 323.15)).all()
    with pytest.raises(InputError, match=r"rollers, film: got 'oil'; allowed: central_film, minimum_film"):
        rollers.films(emap, 1.2, 323.15, variable="oil")
    bare = EHDMap(dataset_of(bearing=None))
    with pytest.raises(MapError, match="got the map of a bare contact"):
        rollers.films(bare, 1.2, 323.15)


def test_rolling_average_is_between_the_extremes_and_even():
    element = force("hertz", clearance=20e-6)
    pose = [0.0, 20e-6, 0.0, 0.0, 0.0, 0.0]
    stiffness = [element(pose, cage_angle=angle)[1][1, 1] for angle in np.linspace(0.0, 2.0 * math.pi / 12, 33)]
    f, K, C = element.rolling_average(pose)
    assert min(stiffness) < K[1, 1] < max(stiffness)
    assert abs(f[2]) < 1e-9 * abs(f[1])  # no side force on the average
    assert np.all(C == 0.0)
    with pytest.raises(InputError, match="angles: got 0; allowed: a whole number >= 1"):
        element.rolling_average(pose, angles=0)


# Kinematics


def test_spin_counts_full_turns_through_tilts():
    tilt = np.linalg.qr(np.array([[1.0, 1e-3, 2e-3], [-1e-3, 1.0, 0.0], [-2e-3, 0.0, 1.0]]))[0]
    tilt *= np.sign(np.diag(tilt))
    last = 0.0
    for angle in np.linspace(0.0, 40.0, 400):
        last = spin(tilt @ axial_rotation(angle), near=last)
        assert last == pytest.approx(angle, abs=1e-5)


def test_pose_of_a_spinning_tilted_ring_is_steady():
    tilt_y, tilt_z = 2e-4, -3e-4
    cy, sy, cz, sz = math.cos(tilt_y), math.sin(tilt_y), math.cos(tilt_z), math.sin(tilt_z)
    tilt = np.array([[cz, -sz, 0], [sz, cz, 0], [0, 0, 1.0]]) @ np.array([[cy, 0, sy], [0, 1.0, 0], [-sy, 0, cy]])
    for angle in (0.0, 1.0, math.pi / 2, 4.0):
        inner = RingState([1e-5, 2e-6, 3e-6], tilt @ axial_rotation(angle), np.zeros(3), tilt[:, 0] * 100.0)
        pose, velocity = relative_motion(inner, RingState.at_rest())
        np.testing.assert_allclose(pose, [1e-5, 2e-6, 3e-6, 0.0, math.sin(tilt_y), sz * cy], rtol=1e-12)
        np.testing.assert_allclose(velocity, 0.0, atol=1e-12)


def test_spinning_outer_ring_leaves_the_frame_where_it_is():
    outer = RingState(np.zeros(3), axial_rotation(2.0), np.zeros(3), [50.0, 0.0, 0.0])
    inner = RingState([0.0, 1e-5, 0.0], np.eye(3), np.zeros(3), np.zeros(3))
    pose, velocity = relative_motion(inner, outer, 2.0, 50.0)
    np.testing.assert_allclose(pose, [0.0, 1e-5, 0.0, 0.0, 0.0, 0.0], atol=1e-20)
    np.testing.assert_allclose(velocity, 0.0, atol=1e-18)


def test_cage_turns_with_both_rings():
    each = bearing()
    assert each.cage_angle(1.0, 1.0) == pytest.approx(1.0)
    assert each.cage_angle(1.0, 0.0) + each.cage_angle(0.0, 1.0) == pytest.approx(1.0)


def test_outer_ring_with_the_rollers_gives_the_same_as_the_inner():
    # rings move apart by the same amount whichever is displaced
    element = force()
    inner, outer = RingState.at_rest([0.0, 7e-6, 0.0]), RingState.at_rest()
    one = element.rings(inner, outer, **AT)
    two = element.rings(RingState.at_rest(), RingState.at_rest([0.0, -7e-6, 0.0]), **AT)
    np.testing.assert_allclose(one.vector[:3], two.vector[:3], rtol=1e-12)


# Input


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
        (lambda: laws.DryLaw("x", "series", 1.0, 0.5, 0.0), "exponent: got 0.5; allowed: 1 to 3"),
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


def test_bad_rings():
    with pytest.raises(InputError) as caught:
        RingState([0.0, 0.0], np.eye(3), [0.0, 0.0, math.nan], "fast")
    assert len(caught.value.problems) == 3
    with pytest.raises(InputError, match=r"rotation: got a matrix that is .* from a rotation"):
        RingState.at_rest(rotation=1.1 * np.eye(3))


def test_bad_roller_contacts():
    each, single = bearing(), LAWS["hertz"]().single()
    with pytest.raises(InputError) as caught:
        RollerContacts(each, LAWS["hertz"](), "hertz")
    assert "got the law 'hertz' of a whole roller; allowed: that of one contact" in str(caught.value)
    assert "law of the outer contact: got str" in str(caught.value)
    with pytest.raises(InputError, match="law of the inner contact: got the law 'outer'; allowed: 'inner'"):
        RollerContacts(each, single_law("outer"), single)
    with pytest.raises(InputError, match="the bearing 'N1014' has"):
        RollerContacts(Bearing.named("N1014"), single_law("inner"), single)
    contacts = RollerContacts(each, single_law("inner"), single)
    with pytest.raises(InputError, match=r"displacement: got an array of shape \(6,\); allowed: \(24,\)"):
        contacts(np.zeros(6), **AT)
    with pytest.raises(InputError, match="velocity: got 'no'; allowed: real numbers"):
        contacts(np.zeros(24), "no", **AT)
    with pytest.raises(InputError, match=r"displacement: got .*nan.*; allowed: finite numbers"):
        contacts(np.full(24, math.nan), **AT)
    with pytest.raises(InputError, match="got the entrainment_speed nan and the temperature nan"):
        contacts(np.zeros(24))
    assert not contacts.evaluate(np.zeros(24), **AT).outside
    for _ in range(2):  # the law at these conditions is kept, and so is that they are outside
        assert contacts.evaluate(np.zeros(24), entrainment_speed=9.0, temperature=330.0).outside


def test_roller_contacts_have_exact_derivatives():
    contacts = RollerContacts(bearing(), single_law("inner"), single_law("outer"))
    q = contacts.settled(POSE, **AT)
    random = np.random.default_rng(3)
    q[12:] += random.normal(0.0, 2e-7, 12)
    q[6:12] = random.normal(0.0, [1e-7, 1e-7, 1e-7, 1e-5, 1e-5, 1e-5])
    v = random.normal(0.0, 1e-4, 24)
    _, K, C = contacts(q, v, **AT)
    step = np.full(24, 2e-11)
    step[[3, 4, 5, 9, 10, 11]] = 2e-9
    for matrix, found in (
        (K, -central_difference(lambda at: contacts(at, v, **AT)[0], q, step)),
        (C, -central_difference(lambda at: contacts(q, at, **AT)[0], v, 1e4 * step)),
    ):
        scale = np.sqrt(np.outer(np.diag(matrix), np.diag(matrix)))
        assert np.all(np.abs(matrix - found) <= 1e-6 * scale + 1e-300)


def test_bearing_of_another_material_is_softer():
    soft = Bearing(BearingGeometry.named("NU308"), material=Material(70e9, 0.3, 2700.0))
    assert laws.hertz(soft).coefficient == pytest.approx(laws.hertz(bearing()).coefficient / 3.0)
    assert soft.roller_mass == pytest.approx(2700.0 * math.pi / 4 * 14e-3**2 * 15e-3)
    assert soft.material is not STEEL
