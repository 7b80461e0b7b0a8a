"""Force of a roller bearing: the sum over rollers and slices, its derivatives, edges and films."""

from __future__ import annotations

import dataclasses
import math
import subprocess
import sys

import numpy as np
import pytest
from numba import njit
from scipy.optimize import brentq

from ehdmaps.errors import InputError
from ehdmaps.kernel.library import checked
from ehdmaps.physics.films import dietl_damping
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.oil_supply import FLOODED
from mbs.bearings import laws
from mbs.bearings.bearing import Bearing
from mbs.bearings.bearing_force import BearingForce
from mbs.bearings.cylinder import Cylinder, CylinderCall, CylinderLaw, CylinderWork
from mbs.bearings.roller_contacts import RollerContacts
from mbs.scene import contact_laws
from mbs.scene.contact_laws import ContactLaws
from mbs.scene.reader import read_scene
from tests.cases.bearings import AT, LAWS, PLANE, bearing, central_difference, force, map_law, single_law
from tests.cases.laws import OIL

POSE = np.array([0.0, 7e-6, 9e-6, 0.0, 1e-4, -2e-4])


VELOCITY = np.array([0.0, 2e-4, -3e-4, 0.0, 1e-2, 2e-2])


def test_import_is_light():
    code = "import mbs, sys; print([m for m in ('numba', 'scipy', 'xarray', 'matplotlib') if m in sys.modules])"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


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


def test_damping_time_is_the_ratio_of_damping_and_stiffness():
    """c = tau k of a bearing at rest, and w + tau k rate of a roller in moderate motion: identities, to round-off."""
    tau = 1.25e-5
    _, K, C = BearingForce(bearing(), laws.hertz(bearing(), damping_time=tau)).at()(POSE)
    np.testing.assert_allclose(C, tau * K, rtol=1e-14)
    law = laws.hertz(bearing(), damping_time=tau)
    for one in (law, law.single()):
        at = np.array([4e-6])
        load, stiffness, damping = one.evaluate(at, np.array([1e-2]))
        k = one.exponent * one.load(at) / at
        np.testing.assert_allclose(damping, tau * k, rtol=1e-14)
        np.testing.assert_allclose(load, one.load(at) + 1e-2 * tau * k, rtol=1e-14)
        np.testing.assert_allclose(stiffness, k * (1.0 + 1e-2 * tau * (one.exponent - 1.0) / at), rtol=1e-14)


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


def test_dietl_is_the_formula_with_the_damping_of_equation_23():
    """At 1.8 kN on a roller of an NU308: 3 % is twice the share of the film in the compliance."""
    each, oil = Bearing.named("NU308"), Lubricant.named("FVA3")
    assert set(laws.FORMULAS) == {"formula", "dietl"}
    made = ContactLaws("dietl", dataclasses.replace(read_scene("nu308_rigid"), lubricant=oil), None).of(each, FLOODED)
    law, contact, state = made.single[0], each.geometry.contacts(each.material, "iso16281")[0], oil.at(313.15)
    approach = brentq(lambda delta: float(law(delta, 0.0, 1.7, 313.15)[0]) - 1.8e5, 1e-6, 3e-5)
    damping = float(law(approach, 0.0, 1.7, 313.15)[2]) * each.geometry.roller_length
    numbers = state.viscosity, state.pressure_viscosity.pressure_viscosity, contact.radius, contact.reduced_modulus
    assert damping == pytest.approx(dietl_damping(1.8e5, 1.7, *numbers, each.geometry.roller_length), rel=0.03)


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
    at = point.address
    called = at.PROTOTYPE(at.function)

    @njit
    def twice(data, state, angle):
        status = 0
        for _ in range(2):
            state[12] = angle
            status += called(data)
        return status

    point(POSE, VELOCITY, 0.1)
    assert not np.array_equal(point.answer[0], expected[0])
    assert twice(at.data, point.state, 0.3) == 0
    np.testing.assert_array_equal(point.answer, np.vstack([expected[0], expected[1], expected[2]]))


def test_the_struct_of_a_bearing_is_that_of_c():
    """Each is as long as in C, and so is the table that Python makes room for."""
    for record in (CylinderLaw, Cylinder, CylinderWork, CylinderCall):
        name = {"CylinderLaw": "law", "CylinderWork": "work", "CylinderCall": "call"}.get(record.__name__)
        assert checked(record, f"ehd_cylinder_{name}" if name else "ehd_cylinder") is record


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
    # The damper that follows the stiffness bends at the rate -delta/(2 b tau): 7e-5 m/s at 2 nm from lift-off.
    rate_step = (1e4 if "time" in name else 1e6) * step
    for pose in near_edges(force(name, clearance=clearance), random):
        velocity = np.zeros(6)
        velocity[PLANE] = random.normal(0.0, [1e-3, 1e-3, 0.1, 0.1])
        if dry:
            # the dry slope is singular, or jumps, at lift-off: leave out slices within the step of it
            approach = element.rollers(pose, velocity, 0.2).approach
            if np.min(np.abs(approach)) < 2e-9:
                continue
        f, K, C = element(pose, velocity, 0.2)
        for matrix, found, by in (
            (K, -central_difference(lambda at, v=velocity: element(at, v, 0.2)[0], pose, step), step),
            (C, -central_difference(lambda at, p=pose: element(p, at, 0.2)[0], velocity, rate_step), rate_step),
        ):
            scale = np.sqrt(np.outer(np.diag(K), np.diag(K)) if matrix is K else np.outer(np.diag(C), np.diag(C)))
            # Of the forces, in their differences, up to 1.6e-6 of the scale; a matrix of zeros has none.
            rounding = np.where(scale > 0.0, np.finfo(float).eps * np.abs(f)[:, None] / by, 0.0)
            assert np.all(np.abs(matrix - found) <= 1e-6 * scale + rounding + 1e-300)
            np.testing.assert_array_equal(matrix, matrix.T)
            assert np.all(matrix[[0, 3]] == 0.0)


def test_dry_derivatives_stay_exact_outside_the_singular_edge():
    # this is a check of the test above: most poses are not left out
    element, kept = force("hertz").at(), 0
    for pose in near_edges(force("hertz"), np.random.default_rng(7)):
        kept += np.min(np.abs(element.rollers(pose, None, 0.2).approach)) >= 2e-9
    assert kept >= 12


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
    light = element.rollers([0.0, 11e-6, 0.0, 0.0, 0.0, 0.0])
    heavy = element.rollers([0.0, 40e-6, 0.0, 0.0, 0.0, 0.0])
    assert (light.loaded, heavy.loaded) == (1, 5)
    assert np.degrees(np.sort(heavy.angle[heavy.load > 0.0])) == pytest.approx([-60.0, -30.0, 0.0, 30.0, 60.0])


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


@pytest.mark.parametrize(
    ("inner", "outer"),
    [
        (single_law("inner"), single_law("outer")),
        (LAWS["hertz with a damping time"]().single(), LAWS["hertz with a damping time"]().single()),
    ],
)
def test_roller_contacts_have_exact_derivatives(inner, outer):
    contacts = RollerContacts(bearing(), inner, outer)
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


@pytest.mark.parametrize("rpm, highest", [(500.0, 10.0), (15000.0, 1.05 * 2.0 * 24.7525)])
def test_a_film_formula_reaches_as_far_as_the_scene(monkeypatch, rpm, highest):
    """Its table ends at 10 m/s, or 5 % above the speed that rings of the scene can have against each other."""
    asked = []

    def told(*_, entrainment_speed, **__):
        asked.append(entrainment_speed)
        raise LookupError

    contact_laws._of_formula.cache_clear()  # of other tests
    monkeypatch.setattr(laws, "formula", told)
    scene = read_scene("nu308_rigid")
    given = dataclasses.replace(scene, run_up=None, speed=rpm * math.pi / 30.0)
    made = ContactLaws("formula", given, None).of(bearing(clearance=20e-6), FLOODED)
    with pytest.raises(LookupError):
        _ = made.series
    # Entrainment speed of an NU308: 0.82508 m/s at 500 rpm.
    assert asked == [(0.05, pytest.approx(highest, rel=1e-4))]
