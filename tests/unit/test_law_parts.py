"""Parts of the contact law: splines, the tail, the curves and the grid field."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest
from scipy.interpolate import CubicHermiteSpline, CubicSpline

from ehdmaps.errors import MapError
from ehdmaps.maps.backbone import OffsetLine
from ehdmaps.maps.compilation import compile_table, highest_structural_load
from ehdmaps.maps.contact_curve import ContactCurve, Tail
from ehdmaps.maps.film_field import LOSS_FLOOR, DryField, lifted_loss
from ehdmaps.maps.grid_field import GridField
from ehdmaps.maps.kernels.splines import hermite, law_nodes, spline_coefficients, spline_weights
from ehdmaps.maps.table_field import _Lines
from tests.cases.laws import CONTACTS, LINE, OIL, SMALL_FIELD, ValleyField


def basis(degree, t):
    """B-splines that are not zero at t steps from the left node (cubic) or the nearest node (quadratic)."""
    if degree == 2:
        return np.array([0.5 * (0.5 - t) ** 2, 0.75 - t**2, 0.5 * (0.5 + t) ** 2])
    return np.array([(1 - t) ** 3, 4 - 6 * t**2 + 3 * t**3, 4 - 6 * (1 - t) ** 2 + 3 * (1 - t) ** 3, t**3]) / 6


@pytest.mark.parametrize("degree", [2, 3])
@pytest.mark.parametrize("n", [1, 2, 3, 4, 7, 30])
def test_coefficients_reproduce_polynomials(degree, n):
    power = min(n - 1, degree)
    nodes = np.arange(n, dtype=float)
    values = np.stack(((0.3 + nodes / max(n, 4)) ** power, 2.0 - nodes * (power > 0)))
    coefficients = spline_coefficients(values, 1, degree)
    assert coefficients.shape[1] == (n + 2 if n > 1 else degree + 1)
    for x in np.linspace(0.0, n - 1.0, 13):
        node = int(x + 0.5) if degree == 2 else min(int(x), max(n - 2, 0))
        got = coefficients[:, node : node + degree + 1] @ basis(degree, x - node)
        wanted = [(0.3 + x / max(n, 4)) ** power, 2.0 - x * (power > 0)]
        assert got == pytest.approx(wanted, rel=1e-11)  # round-off


def test_weights_are_a_spline_inside_and_a_tangent_outside():
    nodes = np.array([0.0, 1.0, 2.5, 3.0, 5.0])
    values = nodes**3
    wanted = np.array([0.3, 4.2, 6.0])
    got = spline_weights(nodes, wanted) @ values
    assert got == pytest.approx([0.027, 4.2**3, 125.0 + 75.0], rel=1e-12)
    assert spline_weights(np.array([2.0]), wanted) == pytest.approx(np.ones((3, 1)))
    assert spline_weights(np.array([0.0, 1.0]), np.array([2.0])) @ [1.0, 3.0] == pytest.approx([5.0])


@pytest.mark.parametrize("degree", [2, 3])
@pytest.mark.parametrize("n", [3, 4, 5, 30])
def test_coefficients_are_those_of_the_spline_without_a_knot_at_its_ends(degree, n):
    values = np.random.default_rng(n).normal(size=(n, 2))
    found = spline_coefficients(values, 0, degree)
    side = (1.0 / 8.0, 1.0 / 6.0)[degree - 2]
    at_nodes = side * found[:-2] + (1.0 - 2.0 * side) * found[1:-1] + side * found[2:]
    np.testing.assert_allclose(at_nodes, values, rtol=0.0, atol=1e-14)  # round-off
    ends = np.diff(found, min(n, degree + 1), axis=0)[[0, -1]]
    np.testing.assert_allclose(ends, 0.0, atol=1e-12)  # round-off of fourth differences


@pytest.mark.parametrize("held", [-1, 0, 2])
@pytest.mark.parametrize(("count", "lines"), [(4, 1), (5, 9), (300, 16)])
def test_nodes_of_a_table_lie_on_the_cubics_of_scipy(count, lines, held):
    rng = np.random.default_rng(count)
    s = np.cumsum(rng.uniform(0.01, 1.0, (count, lines)), axis=0)
    root, slope = rng.uniform(1.0, 2.0, (count, lines)), rng.uniform(-0.5, 1.0, (count, lines))
    logs = rng.normal(size=(count, lines))
    nodes, found = np.linspace(-2.0, np.max(s) + 0.5, 77), np.empty((lines, 77, 2))
    law_nodes((s, root, slope, logs), nodes, held, found)
    for k in range(lines):
        x, away = np.clip(nodes, s[0, k], s[-1, k]), nodes - np.clip(nodes, s[0, k], s[-1, k])
        g = CubicHermiteSpline(s[:, k], root[:, k], slope[:, k])(x)
        g[away < 0.0] += (slope[0, k] * away)[away < 0.0]
        g[away > 0.0] *= np.exp(slope[-1, k] / root[-1, k] * away)[away > 0.0]
        spline = CubicSpline(s[:, k], logs[:, k])
        ratio = spline(x) + away * spline(x, 1)
        if held >= 0:
            ratio[nodes < s[held, k]] = logs[held, k]
        # 1e-11 of the largest value bounds round-off: close samples have steep slopes
        np.testing.assert_allclose(found[k, :, 0], g, rtol=0.0, atol=1e-11 * np.max(np.abs(g)))
        np.testing.assert_allclose(found[k, :, 1], ratio, rtol=0.0, atol=1e-11 * np.max(np.abs(ratio)))


def test_lines_of_the_film_table_are_the_polynomials_of_scipy():
    rng = np.random.default_rng(3)
    zeta = np.cumsum(rng.uniform(0.02, 0.6, 30)) - 5.0
    film = OffsetLine.through(zeta, *rng.normal(size=(2, 30, 6)))
    lines = _Lines(film, CubicSpline(zeta, rng.normal(size=(30, 6))), None)
    places = rng.uniform(-6.0, 6.0, (50, 2, 3))
    found = lines.at(places).reshape(3, 50, 6)
    for k in range(6):
        x = np.clip(places.reshape(50, 6)[:, k], zeta[0], zeta[-1])
        away = places.reshape(50, 6)[:, k] - x
        slope = film.steep(x)[:, k] + film.bent(x[:, None], 1)[:, k]
        value = film.integral(x)[:, k] + film.bent(x[:, None], 0)[:, k] + slope * away
        share = lines.damping(x)[:, k] + lines.damping(x, 1)[:, k] * away
        for got, wanted in zip(found[..., k], (value, slope, share), strict=True):
            np.testing.assert_allclose(got, wanted, rtol=0.0, atol=1e-12 * np.max(np.abs(wanted)))  # round-off


def test_hermite_has_the_given_values_and_slopes():
    left, right = (np.array([1.0]), np.array([-2.0])), (np.array([0.5]), np.array([3.0]))
    for part, wanted in ((0.0, left), (1.0, right)):
        value, slope = hermite(left, right, np.array([part]), 0.2)
        assert [value[0], slope[0]] == pytest.approx([wanted[0][0], wanted[1][0]], rel=1e-13)


def tail(film=50e-9, exponent=0.7, slope=0.4):
    one = np.ones((1, 1))
    return Tail(100.0, film * one, exponent * film / 100.0 * one, 3.0 * one, slope * one, 5e-3)


@pytest.mark.parametrize("film", [50e-9, 30e-6, 600e-6])
@pytest.mark.parametrize("exponent", [0.1, 1.0, 1.3])
def test_tail_joins_the_map_and_ends_at_four_times_ha(film, exponent):
    it = tail(film, exponent)
    first = 100.0 ** (1.0 / 3.0)
    root = np.array([-0.5, 0.0, 0.3, 0.7, 0.999, 1.0])[:, None, None] * first
    h, slope, log_ratio = it.films(root)
    assert h[-1] == pytest.approx(film, rel=1e-12)
    assert slope[-1] == pytest.approx(-exponent * film / 100.0 * 3.0 * first**2, rel=1e-9)
    assert np.exp(log_ratio[-1]) == pytest.approx(3.0 / 100.0, rel=1e-12)
    fade = max(0.005 * 5e-3, film)
    assert it.fade_film == pytest.approx(fade)
    assert h[1] == pytest.approx(4.0 * fade, rel=1e-12)
    assert np.all(np.diff(h, axis=0) < 0.0)
    # The formula of the tail, from the film it gave back.
    A, hs = 100.0**2 * exponent * film / 100.0, film * (1.0 - exponent)
    t = np.clip((4.0 * fade - h) / (3.0 * fade), 0.0, 1.0)
    load = t**3 * (10.0 - 15.0 * t + 6.0 * t**2) * A / (h - hs)
    assert load == pytest.approx(np.maximum(root, 0.0) ** 3, rel=1e-10)


def test_tail_slopes_are_derivatives():
    it = tail()
    root = np.concatenate((np.linspace(-0.02, 0.6, 40), np.linspace(0.6, 4.6, 40)))[:, None, None]
    step = 1e-6
    low, high = it.films(root - step), it.films(root + step)
    _, slope, _ = it.films(root)
    assert slope == pytest.approx((high[0] - low[0]) / (2.0 * step), rel=1e-5)
    # d ln c/d ln w of the map at w1, three halves for a thick film far above the fade.
    first = 100.0 ** (1.0 / 3.0)
    for factor, wanted in ((1.0, 0.4), (0.3, 1.5)):
        near = np.array([1.0 - 1e-5, 1.0])[:, None, None] * first * factor
        _, _, logs = it.films(near)
        exponent = float((logs[1] - logs[0])[0, 0]) / (3.0 * math.log(near[1, 0, 0] / near[0, 0, 0])) + 1.0
        assert exponent == pytest.approx(wanted, abs=2e-3)


def test_tail_survives_a_compliance_of_noise():
    it = tail(exponent=-1e-5)
    h, slope, _ = it.films(np.linspace(0.0, 4.6, 9)[:, None, None])
    assert np.all(h > 0.0)
    assert np.all(slope < 0.0)


@pytest.mark.parametrize("load", [1e3, 2e4, 1e6, 5e6])
def test_curve_slope_is_its_derivative(load):
    curve = ContactCurve(SMALL_FIELD, CONTACTS[0], np.array([1.0]), np.array([320.0]))
    piece = curve.mapped if load < 1e6 else curve.above
    loads = load * np.array([1.0, 1.0 + 1e-6, 1.0 - 1e-6])[:, None, None]
    got = curve.with_structure(piece(np.clip(loads, 1e3, 1e6) if load < 1e6 else loads))
    root = np.cbrt(loads)
    quotient = (got.approach[1] - got.approach[2]) / (root[1] - root[2])
    if load not in (1e3, 1e6):
        assert got.slope[0] == pytest.approx(quotient, rel=1e-7)


def test_curve_continues_with_the_end_exponents():
    curve = ContactCurve(SMALL_FIELD, CONTACTS[0], np.array([1.0]), np.array([320.0]))
    shape = (-1, 1, 1)
    films = [curve.above(np.array([load]).reshape(shape)).offset[0, 0, 0] for load in (1e6, 2e6, 8e6)]
    assert math.log(films[1] / films[0]) / math.log(2.0) == pytest.approx(
        math.log(films[2] / films[1]) / math.log(4.0), rel=1e-9
    )
    loads = np.array([1e6, 2e6, 8e6]).reshape(shape)
    damping = (curve.with_structure(curve.above(loads)).loss_ratio * loads)[:, 0, 0]
    assert math.log(damping[1] / damping[0]) / math.log(2.0) == pytest.approx(
        math.log(damping[2] / damping[1]) / math.log(4.0), rel=1e-9
    )


@dataclasses.dataclass(frozen=True)
class Broken(ValleyField):
    """A field with a film compliance, loss or film offset of its own."""

    compliance_factor: float = 1.0
    loss_factor: float = 1.0
    offset_factor: float = 1.0

    def films(self, contact, loads, speeds, temperatures):
        film, compliance, loss = super().films(contact, loads, speeds, temperatures)
        return film * self.offset_factor, compliance * self.compliance_factor, loss * self.loss_factor


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"compliance_factor": -1e4}, r"'inner'.*stiffness is not positive at .* N/m.*m/s.*K.*finer grid"),
        ({"loss_factor": -1.0}, "damping is not positive"),
        ({"offset_factor": -1e4}, "does not rise with load at"),
    ],
)
@pytest.mark.filterwarnings("ignore:invalid value encountered")
def test_impossible_fields_are_refused(changes, message):
    field = Broken(load_range=(1e3, 1e6), speed_range=(1.0, 1.0), temperature_range=(320.0, 320.0), **changes)
    with pytest.raises(MapError, match=message):
        compile_table(field, CONTACTS[:1], OIL, (1.0, 1.0), 1e6)


def grid_of(field, loads, speeds, temperatures):
    shape = (len(loads), len(speeds), len(temperatures))
    every = np.broadcast_to(np.asarray(loads)[:, None, None], shape).copy()
    arrays = [field.films(contact, every, np.array(speeds), np.array(temperatures)) for contact in field.contacts]
    film, compliance, loss = (np.stack(values) for values in zip(*arrays, strict=True))
    return GridField(
        field.line_contacts,
        OIL,
        np.array(loads),
        np.array(speeds),
        np.array(temperatures),
        film,
        compliance,
        loss,
    )


def films_at(field, contact, load, speed, temperature):
    return [
        float(values[0, 0, 0])
        for values in field.films(contact, np.array([[[load]]]), np.array([speed]), np.array([temperature]))
    ]


LOADS, SPEEDS, TEMPERATURES = np.geomspace(1e2, 1e6, 25), np.geomspace(0.05, 10, 12), np.linspace(293.15, 393.15, 6)


def test_grid_field_keeps_the_nodes():
    field = ValleyField()
    grid = grid_of(field, LOADS, SPEEDS, TEMPERATURES)
    assert grid.load_range == pytest.approx(field.load_range)
    assert grid.speed_range == pytest.approx(field.speed_range)
    assert grid.temperature_range == pytest.approx(field.temperature_range)
    for i, j, k in ((0, 0, 0), (24, 11, 5), (12, 3, 2), (0, 11, 5), (24, 0, 0)):
        for contact in field.contacts:
            place = (contact, float(LOADS[i]), float(SPEEDS[j]), float(TEMPERATURES[k]))
            got, wanted = films_at(grid, *place), films_at(field, *place)
            # The step of the common axis: the lines are read back through cubics of 0.02 in ln M.
            assert got[0] == pytest.approx(wanted[0], rel=1e-5)
            assert got[1] == pytest.approx(wanted[1], rel=1e-2)
            assert got[2] == pytest.approx(wanted[2], rel=1e-2)


def test_grid_field_between_nodes_is_good_where_the_film_is_smooth():
    field = dataclasses.replace(ValleyField(), depth=0.0, width=50.0)
    grid = grid_of(field, LOADS, SPEEDS, TEMPERATURES)
    random = np.random.default_rng(7)
    for _ in range(100):
        load, speed = np.exp(random.uniform(np.log([100.0, 0.05]), np.log([1e6, 10.0])))
        place = ("inner", float(load), float(speed), float(random.uniform(293.15, 393.15)))
        got, wanted = films_at(grid, *place), films_at(field, *place)
        assert got[0] == pytest.approx(wanted[0], rel=2e-3)  # interpolation
        assert got[1] == pytest.approx(wanted[1], rel=2e-2)
        assert got[2] == pytest.approx(wanted[2], rel=6e-2)


def test_grid_field_compliance_is_the_derivative_of_its_offset():
    grid = grid_of(ValleyField(), LOADS, SPEEDS, TEMPERATURES)
    random = np.random.default_rng(3)
    for _ in range(30):
        load, speed = np.exp(random.uniform(np.log([110.0, 0.05]), np.log([9e5, 10.0])))
        place = (float(speed), float(random.uniform(293.15, 393.15)))
        low, high = (films_at(grid, "outer", load * (1.0 + e), *place)[0] for e in (-1e-5, 1e-5))
        compliance = films_at(grid, "outer", load, *place)[1]
        assert compliance == pytest.approx((low - high) / (2e-5 * load), rel=1e-4)


def test_a_lifted_loss_is_the_larger_one_of_loss_and_floor():
    """Far below zero as well: its logarithm must not fall on, beside which the splines of a law would ring."""
    half_width, speed, compliance = 1e-4, 2.0, 4e-11
    floor = LOSS_FLOOR * half_width / speed * compliance
    loss = floor * np.array([-1e6, -1e3, -10.0, 0.0, 1.0, 10.0, 1e3, 1e6])
    lifted = lifted_loss(loss, np.array(half_width), speed, np.array(compliance))
    assert np.all(np.diff(lifted) > 0.0)
    assert np.all(lifted >= floor)
    # Far from the floor the square root differs from a corner by floor^2/|loss - floor|.
    far = np.abs(loss) >= 1e3 * floor
    assert lifted[far] == pytest.approx(np.maximum(loss, floor)[far], rel=2e-3)
    # Where the loss is zero the law is within a tenth of the bar to which its damping is held, twice.
    assert lifted[3] < 2.0 * floor


def test_grid_field_lifts_a_negative_loss():
    field = ValleyField()
    grid = grid_of(field, LOADS, SPEEDS, TEMPERATURES)
    loss = grid.loss_compliance.copy()
    loss[:, 10:12, 5, 3] *= -1.0
    lifted = dataclasses.replace(grid, loss_compliance=loss)
    got = films_at(lifted, "inner", float(LOADS[10]), float(SPEEDS[5]), float(TEMPERATURES[3]))
    assert 0.0 < got[2] < 1e-2 * grid.loss_compliance[0, 10, 5, 3]


@pytest.mark.parametrize("factor", [1.5, 4.0, 9.0])
def test_grid_field_goes_on_beyond_the_highest_speed_at_constant_load_number(factor):
    field = ValleyField()
    grid = grid_of(field, LOADS, SPEEDS, TEMPERATURES)
    for load in (1e3, 2e4, 2e5, 1e6):
        got, wanted = (films_at(each, "inner", load, 10.0 * factor, 330.0) for each in (grid, field))
        # The trend at the end against the field, which bends: a model error that grows with the distance.
        assert got[0] == pytest.approx(wanted[0], rel=0.015 * factor)
        assert got[1] == pytest.approx(wanted[1], rel=0.1, abs=0.02 * factor * wanted[0] / load)
        assert got[2] > 0.0
        low, high = (films_at(grid, "inner", load * (1.0 + e), 10.0 * factor, 330.0)[0] for e in (-1e-5, 1e-5))
        assert got[1] == pytest.approx((low - high) / (2e-5 * load), rel=1e-4)


def test_grid_field_of_one_speed():
    grid = grid_of(SMALL_FIELD, np.geomspace(1e3, 1e6, 9), [1.0], [330.0])
    assert films_at(grid, "inner", 1e4, 2.0, 330.0)[1] > 0.0


def test_dry_field_keeps_the_ranges():
    field = DryField(SMALL_FIELD)
    assert field.contacts == SMALL_FIELD.contacts
    assert (field.load_range, field.speed_range) == (SMALL_FIELD.load_range, SMALL_FIELD.speed_range)
    assert field.temperature_range == SMALL_FIELD.temperature_range
    assert not field.dry


def test_half_space_has_a_highest_load():
    load = highest_structural_load(LINE)
    assert LINE.structural_approach(load) > 0.0
    assert highest_structural_load(CONTACTS[0]) == math.inf
