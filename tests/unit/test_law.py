"""The contact law against the field that it is made from, its own derivatives, closed forms and brute force."""

from __future__ import annotations

import dataclasses
import functools
import math
import pickle
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from scipy.optimize import brentq

from ehdmaps.errors import InputError, OutsideMapError
from ehdmaps.maps.kernels.law_in_c import LawInC
from ehdmaps.maps.kernels.tables import LOAD, NOT_FINITE, SPEED, TEMPERATURE
from ehdmaps.maps.law import LOAD_REACH, ContactLaw
from tests.cases.laws import CONTACTS, LINE, OIL, SMALL_FIELD, ValleyField, exact_law

FULL_FIELD = ValleyField()
LENGTH_MM = 15.0


@functools.cache
def law(kind="series", outside="error", full=False):
    contacts = CONTACTS if kind == "series" else [c for c in CONTACTS if c.name == kind]
    return ContactLaw(kind, contacts, OIL, FULL_FIELD if full else SMALL_FIELD, outside)


def approach_of(at_point, load):
    """Approach at which a law carries a load."""

    def excess(delta):
        return at_point._made.forces(np.array([delta]), np.zeros(1))[0][0, 0] - load

    return brentq(excess, -0.1, 0.1, xtol=1e-18, rtol=1e-15)


def random_points(count, seed=0, full=True):
    """Log-uniform loads and speeds and uniform temperatures of the field."""
    field = FULL_FIELD if full else SMALL_FIELD
    random = np.random.default_rng(seed)
    loads = np.exp(random.uniform(*np.log(field.load_range), count))
    speeds = np.exp(random.uniform(*np.log(field.speed_range), count))
    return loads, speeds, random.uniform(*field.temperature_range, count)


def test_table_is_exact_enough_across_the_map_and_the_valley():
    errors = []
    for load, speed, temperature in zip(*random_points(300), strict=True):
        loads = np.array([load])
        delta, stiffness, damping = exact_law(FULL_FIELD, CONTACTS, loads, speed, temperature)
        w, k, c = law(full=True)(delta, 0.0, speed, temperature)
        errors.append(np.abs([w / loads - 1.0, k / stiffness - 1.0, c / damping - 1.0])[:, 0])
    # Interpolation between the nodes of the table; the corner next to the lowest load is the worst.
    assert np.quantile(errors, 0.5, axis=0) == pytest.approx(0.0, abs=2e-5)
    assert np.quantile(errors, 0.99, axis=0) == pytest.approx(0.0, abs=5e-3)
    assert np.all(np.quantile(errors, 0.99, axis=0) < [3e-4, 4e-4, 5e-3])


def zones():
    """Points of every zone of the law: (speed, centrifugal load, load)."""
    return {
        "high load": (1.0, 0.0, 5e5),
        "valley": (1.0, 0.0, 6e4),
        "lowest load": (1.0, 0.0, 1e3),
        "tail": (1.0, 0.0, 60.0),
        "fade": (1.0, 0.0, 0.2),
        "deep fade": (1.0, 0.0, 1e-3),
        "slow": (0.1, 0.0, 3e4),
        "slow tail": (0.02, 0.0, 30.0),
        "centrifugal": (1.0, 500.0, 3e4),
        "centrifugal lift-off": (1.0, 500.0, 1.0),
        "slow centrifugal": (0.1, 50.0, 300.0),
        "small centrifugal": (1.0, 1e-3, 1e4),
        "standstill": (0.0, 0.0, 1e4),
        "standstill centrifugal": (0.0, 300.0, 1e3),
    }


@pytest.mark.parametrize("zone", zones())
def test_derivatives_are_exact(zone):
    speed, centrifugal, load = zones()[zone]
    point = law().at(speed, 330.0, centrifugal)
    delta = approach_of(point, load)
    w, k, c = point(delta, 0.0)
    assert w == pytest.approx(load, rel=1e-9)
    for x in (0.0, 0.8, -0.3, -0.5 - 1e-9, -0.9, -30.0):
        rate = x * w / c if c > 0.0 else x * 1e-3
        _, dw_ddelta, dw_drate = point(delta, rate)
        step = 3e-5 * w / k
        quotient = (point(delta + step, rate)[0] - point(delta - step, rate)[0]) / (2.0 * step)
        within = 1e-3 if abs(x + 0.5) < 1e-3 else 1e-6  # at the bend the quotient has an error of first order
        assert dw_ddelta == pytest.approx(quotient, abs=within * max(k, abs(dw_ddelta))), x
        step = 1e-4 * max(abs(rate), w / c if c > 0.0 else 1e-3)
        quotient = (point(delta, rate + step)[0] - point(delta, rate - step)[0]) / (2.0 * step)
        assert dw_drate == pytest.approx(quotient, abs=within * max(c, dw_drate)), x


@pytest.mark.parametrize("kind", ["series", "inner", "outer"])
def test_load_and_slopes_have_no_jump(kind):
    # Fine steps over the lowest load, the fade and nearly to lift-off.
    for speed in (0.3, 0.1, 2.9):
        point = law(kind).at(speed, 320.0)
        ends = approach_of(point, 1e-9), approach_of(point, 5e3)
        delta = 1e-8 * np.sinh(np.linspace(*np.arcsinh(np.array(ends) / 1e-8), 20_000))
        w, k, c = point(delta, 0.0)
        assert np.all(np.diff(w) >= 0.0)
        assert np.all(k >= 0.0)
        assert np.all(c >= 0.0)
        loaded = w > 1e-2  # below it w goes to zero as a cube
        for values in (w, k, c):
            assert np.max(np.abs(np.diff(np.log(values[loaded])))) < 5e-2


@pytest.mark.parametrize("name", ["speed", "temperature"])
def test_law_is_smooth_over_speed_and_temperature(name):
    low, high = SMALL_FIELD.speed_range if name == "speed" else SMALL_FIELD.temperature_range
    x = np.linspace(low, high, 4001)
    arguments = (x, 325.0) if name == "speed" else (1.0, x)
    for values in law()(3e-6, 0.0, *arguments):
        slope = np.diff(values) / np.diff(x)
        # C1: the slope changes little from step to step; a jump would stand out by orders of magnitude.
        assert np.max(np.abs(np.diff(slope))) < 2e-2 * np.max(np.abs(slope))


def test_slope_over_speed_is_continuous_from_the_lowest_speed_up():
    lowest = SMALL_FIELD.speed_range[0]
    speeds = lowest * (1.0 + np.array([0.0, 1e-5, 2e-5, 3e-5]))
    w, _, _ = law()(3e-6, 0.0, speeds, 325.0)
    slopes = np.diff(w) / np.diff(speeds)
    assert slopes == pytest.approx(slopes[0], rel=1e-3)
    below, _, _ = law()(3e-6, 0.0, lowest * (1.0 - 1e-9), 325.0)
    assert below == pytest.approx(w[0], rel=1e-7)


@pytest.mark.parametrize(("speed", "temperature"), [(0.3, 343.0), (2.0, 320.0)])
@pytest.mark.parametrize("kind", ["inner", "outer"])
def test_tail_is_the_formula(kind, speed, temperature):
    (contact,) = (c for c in CONTACTS if c.name == kind)
    low = np.full((1, 1, 1), 1e3)
    film, compliance, _ = SMALL_FIELD.films(kind, low, np.array([speed]), np.array([temperature]))
    h1, s1 = float(film[0, 0, 0]), float(compliance[0, 0, 0])
    A, hs, ha = 1e6 * s1, h1 - 1e3 * s1, max(0.005 * contact.radius, h1)
    h = np.geomspace(1.001 * h1, 3.5 * ha, 60)
    t = np.clip((4.0 * ha - h) / (3.0 * ha), 0.0, 1.0)
    load = t**3 * (10.0 - 15.0 * t + 6.0 * t**2) * A / (h - hs)
    delta = contact.structural_approach(load) - h
    w, _, _ = law(kind)(delta, 0.0, speed, temperature)
    assert w == pytest.approx(load, rel=3e-3)  # table
    assert np.all(np.array(law(kind)(-4.001 * ha, 1.0, speed, temperature)) == 0.0)


def test_no_tension_and_exact_limits_of_the_rate():
    point = law().at(1.0, 330.0)
    delta = approach_of(point, 2e4)
    w, _, c = point(delta, 0.0)
    rates = np.array([-1e6, -10.0, -1.0, -0.5, -0.25, 0.0, 1.0]) * w / c
    loads, _, _ = point(delta, rates)
    assert loads == pytest.approx(w * np.array([2.5e-7, 0.025, 0.25, 0.5, 0.75, 1.0, 2.0]), rel=1e-9)
    assert np.all(loads > 0.0)
    assert np.all(np.array(point(-1e-2, np.array([-1.0, 0.0, 1.0]))) == 0.0)


@pytest.mark.parametrize("centrifugal", [0.0, 200.0])
def test_standstill_is_the_dry_law(centrifugal):
    load = np.array([1e-3, 0.5, 30.0, 1e3, 2e4, 9e5])
    delta = CONTACTS[0].structural_approach(load) + CONTACTS[1].structural_approach(load + centrifugal)
    w, k, c = law()(delta, 1e-3, 0.0, 330.0, centrifugal)
    assert w == pytest.approx(load, rel=1e-11)  # round-off
    compliance = CONTACTS[0].structural_compliance(load) + CONTACTS[1].structural_compliance(load + centrifugal)
    assert k == pytest.approx(1.0 / compliance, rel=1e-9)
    assert np.all(c == 0.0)
    assert law()(-1e-9, 0.0, 0.0, 330.0)[0] == 0.0
    if centrifugal == 0.0:
        iso = 35948.0 * LENGTH_MM ** (8.0 / 9.0) / LENGTH_MM * (1e3 * delta) ** (10.0 / 9.0) * 1e3
        assert w == pytest.approx(iso, rel=1e-11)


def test_faded_film_is_the_quintic_share_at_equal_load():
    lowest = SMALL_FIELD.speed_range[0]
    full, faded = law().at(lowest, 330.0), law().at(0.4 * lowest, 330.0)
    share = 0.4**3 * (10.0 - 15.0 * 0.4 + 6.0 * 0.4**2)
    for load in (0.05, 20.0, 1e3, 5e4):
        y = approach_of(full, load)
        dry = sum(contact.structural_approach(load) for contact in CONTACTS)
        assert approach_of(faded, load) == pytest.approx((1.0 - share) * dry + share * y, rel=1e-10)
        assert faded(approach_of(faded, load), 0.0)[2] == pytest.approx(share * full(y, 0.0)[2], rel=1e-9)


@pytest.mark.parametrize("centrifugal", [0.0, 1e-4, 300.0, 5e4])
def test_series_is_both_contacts_at_equal_load(centrifugal):
    for speed, temperature in ((0.35, 340.0), (2.5, 315.0)):
        inner, outer = law("inner").at(speed, temperature), law("outer").at(speed, temperature)
        point = law().at(speed, temperature, centrifugal)
        for load in (0.5, 50.0, 1e3, 3e4, 8e5):
            a, b = approach_of(inner, load), approach_of(outer, load + centrifugal)
            _, k_i, c_i = inner(a, 0.0)
            _, k_o, c_o = outer(b, 0.0)
            w, k, c = point(a + b, 0.0)
            damping = c_i * (k_o / (k_i + k_o)) ** 2 + c_o * (k_i / (k_i + k_o)) ** 2
            # With a centrifugal load it is the same equation; without, the error of one more table.
            exact = centrifugal > 0.0
            assert w == pytest.approx(load, rel=1e-9 if exact else 3e-3 if load < 1.0 else 2e-4)
            assert k == pytest.approx(k_i * k_o / (k_i + k_o), rel=1e-8 if exact else 2e-3)
            assert c == pytest.approx(damping, rel=1e-8 if exact else 5e-3)


def test_small_centrifugal_loads_go_over_into_none():
    deltas = np.linspace(-2e-6, 2e-5, 9)
    without, little = law()(deltas, 0.0, 1.0, 330.0), law()(deltas, 0.0, 1.0, 330.0, 1e-7)
    for a, b in zip(without, little, strict=True):
        assert b == pytest.approx(a, rel=3e-4)  # table


def test_law_is_smooth_over_the_centrifugal_load():
    q = np.linspace(1.0, 3000.0, 301)
    for values in law()(2e-6, 1e-5, 1.0, 330.0, q):
        slope = np.diff(values) / np.diff(q)
        assert np.max(np.abs(np.diff(slope))) < 0.1 * np.max(np.abs(slope))


def test_law_at_a_point_equals_the_law():
    random = np.random.default_rng(5)
    for centrifugal in (0.0, 100.0):
        for speed in (0.0, 0.1, 0.3, 1.3, 3.0, -2.0):
            temperature = float(random.uniform(*SMALL_FIELD.temperature_range))
            delta = random.uniform(-4e-5, 2e-5, 700)
            rate = random.normal(0.0, 1e-3, 700)
            expected = law()(delta, rate, speed, temperature, centrifugal)
            got = law().at(speed, temperature, centrifugal)(delta, rate)
            for a, b in zip(expected, got, strict=True):
                assert b == pytest.approx(a, rel=1e-11, abs=1e-300)  # round-off


def test_points_of_every_kind_in_one_call():
    clamped = law(outside="clamp")
    random = np.random.default_rng(11)
    delta, rate = random.uniform(-1e-5, 6e-5, 600), random.normal(0.0, 1e-3, 600)
    speed = random.choice([0.0, 0.1, 0.5, 0.5, 2.0, 5.0], 600)
    temperature = random.choice([300.0, 320.0, 330.0], 600)
    q = random.choice([0.0, 0.0, 250.0], 600)
    clamped.reset_counts()
    together = np.array(clamped(delta, rate, speed, temperature, q))
    counted = clamped.outside_counts
    clamped.reset_counts()
    alone = np.array([clamped(*point) for point in zip(delta, rate, speed, temperature, q, strict=True)]).T
    assert together == pytest.approx(alone, rel=1e-11, abs=1e-300)
    assert counted == clamped.outside_counts
    assert counted["entrainment_speed"] == np.count_nonzero(speed == 5.0)
    assert counted["temperature"] == np.count_nonzero(temperature == 300.0)


def test_what_is_outside_is_counted_by_cause():
    series = law(outside="clamp")
    in_c = LawInC(series.table, centrifugal=True)
    delta = np.array([1e-3, 1e-6, 1e-6, np.nan, 1e-6, 1e-6])
    speed = np.array([1.0, 4.0, 1.0, 1.0, 1.0, -3.0])
    temperature = np.array([330.0, 330.0, 300.0, 330.0, 360.0, 330.0])
    forces, counts = in_c.forces((delta, np.zeros(6), speed, temperature, np.zeros(6)))
    assert (counts[LOAD], counts[SPEED], counts[TEMPERATURE], counts[NOT_FINITE]) == (1, 1, 2, 1)
    for i in range(6):
        assert (in_c.force(delta[i], 0.0, speed[i], temperature[i], 0.0) is None) == (i < 5)
        one, _ = in_c.forces([np.array([part[i]]) for part in (delta, np.zeros(6), speed, temperature, np.zeros(6))])
        assert one[:, 0] == pytest.approx(forces[:, i], rel=1e-11, nan_ok=True)
    assert in_c.point(1.0, 330.0, 2e6).counts.tolist() == [1, 0, 0, 0]
    point = in_c.point(1.0, 330.0, 0.0)
    assert point.force(np.inf, 0.0) is None
    forces, counts = point.forces(np.array([np.inf, 1e-6, 1e-3]), np.zeros(3))
    assert np.all(np.isnan(forces[:, 0])) and counts.tolist() == [1, 0, 0, 1]
    assert point.force(1e-6, 0.0) == pytest.approx(forces[:, 1], rel=1e-12)


def test_a_law_is_pickled_with_its_points():
    series = law(outside="clamp")
    at = series.at(1.0, 330.0, 200.0)
    again, point = pickle.loads(pickle.dumps((series, at)))
    assert again(1e-6, 1e-4, 1.0, 330.0, 200.0) == series(1e-6, 1e-4, 1.0, 330.0, 200.0) == point(1e-6, 1e-4)
    assert point.law.outside_counts == again.outside_counts


def test_numbers_and_arrays_have_the_same_law():
    series = law()
    for q in (0.0, 200.0):
        one = series(1e-6, 1e-4, 1.0, 330.0, q)
        assert [type(value) for value in one] == [np.float64] * 3
        assert one == pytest.approx([float(v[0]) for v in series(np.array([1e-6]), 1e-4, 1.0, 330.0, q)], rel=1e-11)
        assert series.at(1.0, 330.0, q)(1e-6, 1e-4) == pytest.approx(one, rel=1e-11)


def test_threads_call_one_law():
    series = law()
    delta = np.linspace(1e-6, 1e-5, 50)
    wanted = [series(float(d), 1e-4, 0.05, 330.0) for d in delta]

    def all_of_them(_):
        return [series(float(d), 1e-4, 0.05, 330.0) for d in delta]

    with ThreadPoolExecutor(4) as pool:
        assert all(found == wanted for found in pool.map(all_of_them, range(8)))


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (
            (1e-3, 0.0, 1.0, 330.0),
            r"'series', load: got about .* above the map, which ends at 1e\+06 N/m, at .* 0\.001 m",
        ),
        (
            (1e-6, 0.0, [1.0, -5.0], 330.0),
            r"entrainment_speed: got 5 m/s above the map, .* at 3 m/s\n.*outside='clamp'",
        ),
        ((1e-6, 0.0, 1.0, 290.0), r"temperature: got 290 K below the map, which begins at 313\.15 K"),
        ((1e-3, 0.0, 9.0, 400.0), r"load.*\n.*entrainment_speed.*\n.*temperature: got 400 K"),
        ((1e-3, 0.0, 1.0, 330.0, 50.0), "load: got about"),
    ],
)
def test_outside_the_map_is_an_error_by_default(arguments, message):
    series = law()
    series.reset_counts()
    with pytest.raises(OutsideMapError, match=message):
        series(*arguments)
    assert sum(series.outside_counts.values()) >= 1
    series.reset_counts()
    assert series.outside_counts == {"load": 0, "entrainment_speed": 0, "temperature": 0}


def test_what_was_outside_is_told_by_axis_and_side_with_the_farthest_value():
    clamped = law(outside="clamp")
    clamped.reset_counts()
    clamped(1e-6, 0.0, [1.0, 3.0, 0.0], [330.0, 313.15, 343.15])
    assert clamped.excursions == ()
    clamped(1e-6, 0.0, [[5.0], [-9.0]], [290.0, 330.0, 400.0])
    clamped(1e-6, 0.0, -4.0, 300.0)
    told = [(one.axis, one.side, one.calls, one.extreme, one.limit) for one in clamped.excursions]
    assert told == [
        ("entrainment_speed", "above", 7, 9.0, 3.0),
        ("temperature", "above", 2, 400.0, 343.15),
        ("temperature", "below", 3, 290.0, 313.15),
    ]
    counts = clamped.outside_counts
    assert (counts["entrainment_speed"], counts["temperature"]) == (7, 5)
    assert clamped.excursions[2].text == "temperature 290 K below the map, which begins at 313.15 K"
    point = clamped.at(1.0, 330.0)
    deltas = [approach_of(point, load) for load in (9e5, 1.2e6, 1.5e6)]
    clamped.reset_counts()
    point(deltas, 1e-3)
    clamped(deltas[1], 0.0, 1.0, 330.0)
    (load,) = clamped.excursions
    assert (load.axis, load.side, load.calls, load.limit) == ("load", "above", 3, 1e6)
    assert load.extreme == pytest.approx(1.5e6, rel=1e-6)  # solution of the approach
    clamped.reset_counts()
    assert clamped.excursions == ()


def test_a_centrifugal_load_counts_for_the_outer_contact():
    clamped = law(outside="clamp")
    clamped.reset_counts()
    point = clamped.at(1.0, 330.0, 400.0)
    point(approach_of(point, 1e6 + 5e3), 0.0)
    (load,) = clamped.excursions
    assert clamped.outside_counts["load"] == load.calls == 1
    assert load.extreme == pytest.approx(1e6 + 5e3 + 400.0, rel=1e-4)
    clamped.reset_counts()


def test_outside_is_an_error_at_a_point_too():
    with pytest.raises(OutsideMapError, match="entrainment_speed: got 5 m/s"):
        law().at(5.0, 330.0)
    point = law().at(1.0, 330.0)
    with pytest.raises(OutsideMapError, match="load: got about"):
        point([1e-6, 1e-3], 0.0)
    law().reset_counts()


def test_what_is_inside_is_no_error():
    low, high = SMALL_FIELD.temperature_range
    delta, _, _ = exact_law(SMALL_FIELD, CONTACTS, np.array([1e6]), 3.0, high)
    law()(delta, 0.0, 3.0, high)
    law()([-1.0, -1e-4, 0.0, 1e-6], [[-1e3], [0.0], [1e3]], np.float32(-3.0), np.float32(low))
    law()(1e-6, 0.0, 0.0, np.float32(high))
    assert sum(law().outside_counts.values()) == 0


@pytest.mark.parametrize("speed", [1.0, 0.1, 0.0])
@pytest.mark.parametrize("centrifugal", [0.0, 400.0])
def test_clamp_goes_on_as_the_dry_tangent(speed, centrifugal):
    clamped = law(outside="clamp")
    clamped.reset_counts()
    highest = 1e6 - centrifugal
    point = clamped.at(speed, 330.0, centrifugal)
    delta = approach_of(point, highest)
    w, k, c = point(delta + np.array([0.0, 5e-6, 1e-4]), 0.0)
    dry = CONTACTS[0].structural_compliance(highest) + CONTACTS[1].structural_compliance(1e6)
    assert w[1:] == pytest.approx(highest + np.array([5e-6, 1e-4]) / dry, rel=2e-5)
    assert k[1:] == pytest.approx(1.0 / dry, rel=1e-4)
    assert c[1:] == pytest.approx(c[0], rel=1e-3)
    assert clamped.outside_counts["load"] == 2


def test_clamp_holds_speed_and_temperature():
    clamped = law(outside="clamp")
    clamped.reset_counts()
    for got, wanted in zip(clamped(2e-6, 1e-5, [30.0, -30.0], 400.0), clamped(2e-6, 1e-5, 3.0, 343.15), strict=True):
        assert got == pytest.approx(wanted, rel=1e-12)
    assert clamped.outside_counts == {"load": 0, "entrainment_speed": 2, "temperature": 2}


def test_asymptote_goes_on_with_the_exponents_at_the_end():
    beyond = law(outside="asymptote")
    beyond.reset_counts()
    point = beyond.at(1.0, 330.0)

    def film_and_damping(load):
        delta = approach_of(point, load)
        return sum(contact.structural_approach(load) for contact in CONTACTS) - delta, point(delta, 0.0)[2]

    films, dampings = zip(*(film_and_damping(load) for load in (9e5, 1e6, 2e6, 4e6, 3e7)), strict=True)
    for values in (films, dampings):
        logs = np.log(values)
        inside = (logs[1] - logs[0]) / math.log(1.0 / 0.9)
        first, second = (logs[2] - logs[1]) / math.log(2.0), (logs[3] - logs[2]) / math.log(2.0)
        assert first == pytest.approx(second, abs=0.02)
        assert first == pytest.approx(inside, abs=0.05)
    inside = law()(3e-6, 0.0, 2.0, 330.0)
    for got, wanted in zip(beyond(3e-6, 0.0, 2.0, 330.0), inside, strict=True):
        assert got == pytest.approx(wanted, rel=3e-3)
    # The film at higher speeds, against the field itself, which is known there.
    for speed in (4.0, 12.0, 29.0):
        delta, _, _ = exact_law(SMALL_FIELD, CONTACTS, np.array([5e4, 5e5]), speed, 330.0)
        assert beyond(delta, 0.0, speed, 330.0)[0] == pytest.approx([5e4, 5e5], rel=1e-3)
    far = approach_of(beyond.at(1.0, 330.0), 1.5 * LOAD_REACH * 1e6)
    assert beyond(far, 0.0, 1.0, 330.0)[0] == pytest.approx(1.5 * LOAD_REACH * 1e6)
    assert beyond.outside_counts["load"] > 0
    assert beyond.outside_counts["entrainment_speed"] == 6


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ((np.nan, 0.0, 1.0, 330.0), r"delta: got nan \(1 of 1\); allowed: finite"),
        (([0.0, 1e-6], [0.0, np.inf], 1.0, 330.0), r"rate: got inf \(1 of 2\)"),
        ((0.0, 0.0, np.nan, 330.0), "entrainment_speed: got nan"),
        ((0.0, 0.0, 1.0, [330.0, np.nan]), "temperature: got nan"),
        ((0.0, 0.0, 1.0, 330.0, np.nan), "centrifugal_load: got nan"),
        ((0.0, 0.0, 0.1, np.nan), "temperature: got nan"),
        ((0.0, 0.0, 1.0, 330.0, -5.0), "centrifugal_load: got -5 N/m; allowed: 0 to below"),
        ((0.0, 0.0, 1.0, 330.0, 1e6), "centrifugal_load: got 1e[+]06 N/m; allowed: 0 to below"),
        (("much", 0.0, 1.0, 330.0), "delta: got 'much'; allowed: real numbers"),
        (([0.0, 1.0], [0.0, 1.0, 2.0], 1.0, 330.0), r"do not broadcast: delta \(2,\), rate \(3,\)"),
    ],
)
def test_unusable_arguments_are_refused(arguments, message):
    with pytest.raises(InputError, match=message):
        law()(*arguments)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: law().at(np.nan, 330.0), "entrainment_speed: got nan"),
        (lambda: law().at([1.0, 2.0], 330.0), "entrainment_speed: got an array; allowed: one number"),
        (lambda: law().at(1.0, 330.0)(np.nan, 0.0), "delta: got nan"),
        (lambda: law().at(1.0, 330.0)([0.0, 1.0], [0.0, 1.0, 2.0]), "do not broadcast"),
        (lambda: law("inner")(0.0, 0.0, 1.0, 330.0, 5.0), "'inner', centrifugal_load: got 5 N/m; allowed: 0"),
        (lambda: law("outer").at(1.0, 330.0, 5.0), "only the law 'series'"),
        (
            lambda: ContactLaw("inner", CONTACTS[:1], OIL, SMALL_FIELD, "ignore"),
            "outside: got 'ignore'; allowed: error",
        ),
    ],
)
def test_unusable_calls_are_refused(call, message):
    with pytest.raises(InputError, match=message):
        call()


def test_shapes_and_types():
    w, k, c = law()(1e-6, 0.0, 1.0, 330.0)
    assert all(isinstance(value, float) for value in (w, k, c))
    many = law()(np.full((3, 1), 1e-6), np.zeros(4), 1, np.float32(330.0))
    assert [value.shape for value in many] == [(3, 4)] * 3
    assert many[0] == pytest.approx(w, rel=1e-12)
    assert [value.shape for value in law()(np.empty((0, 2)), 0.0, 1.0, 330.0)] == [(0, 2)] * 3
    assert law()(np.float32(1e-6), 0, -1, 330)[0] == pytest.approx(w, rel=1e-6)
    strided = law()(np.full(10, 1e-6)[::2], 0.0, 1.0, 330.0)[0]
    assert strided == pytest.approx(np.full(5, w))


@pytest.mark.parametrize("single", ["speed", "temperature", "both"])
def test_maps_of_one_speed_or_temperature_work(single):
    changes = {}
    if single != "temperature":
        changes["speed_range"] = (1.0, 1.0)
    if single != "speed":
        changes["temperature_range"] = (330.0, 330.0)
    field = dataclasses.replace(SMALL_FIELD, **changes)
    one = ContactLaw("series", CONTACTS, OIL, field)
    assert one(3e-6, 1e-5, 1.0, 330.0) == pytest.approx(law()(3e-6, 1e-5, 1.0, 330.0), rel=2e-4)
    assert one(3e-6, 0.0, 0.0, 330.0)[0] == pytest.approx(law()(3e-6, 0.0, 0.0, 330.0)[0], rel=1e-10)
    if single != "temperature":
        with pytest.raises(OutsideMapError, match=r"1\.1 m/s above the map, which ends at 1 m/s"):
            one(3e-6, 0.0, 1.1, 330.0)
    if single != "speed":
        with pytest.raises(OutsideMapError, match="331 K above the map, which ends at 330 K"):
            one(3e-6, 0.0, 1.0, 331.0)


def test_bare_contact_with_a_half_space():
    field = dataclasses.replace(SMALL_FIELD, line_contacts=(LINE,))
    for outside in ("error", "asymptote"):
        bare = ContactLaw("line", (LINE,), OIL, field, outside)
        loads = np.array([2e3, 5e4, 9e5])
        delta, stiffness, damping = exact_law(field, (LINE,), loads, 1.0, 330.0)
        w, k, c = bare(delta, 0.0, 1.0, 330.0)
        assert w == pytest.approx(loads, rel=5e-4)
        assert k == pytest.approx(stiffness, rel=1e-3)
        assert c == pytest.approx(damping, rel=1e-2)
        dry, stiffness, _ = bare(LINE.structural_approach(loads), 0.0, 0.0, 330.0)
        assert dry == pytest.approx(loads, rel=1e-10)
        assert 1.0 / stiffness == pytest.approx(LINE.structural_compliance(loads), rel=1e-9)
