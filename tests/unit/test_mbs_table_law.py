"""Dry laws by points: beside the power law they were taken from, their bounds, and files that are refused."""

import re

import numpy as np
import pytest

from ehdmaps.errors import InputError, OutsideMapError
from mbs.analyses.reach import POINTS, axes_outside, source_of
from mbs.bearings import laws
from mbs.bearings.bearing import Bearing
from mbs.bearings.bearing_force import BearingForce
from mbs.scene.assembly import assemble
from mbs.scene.contact_laws import read_law
from mbs.scene.reader import read_scene
from mbs.scene.table_law import TableLaw
from tests.cases.commands import run

NU308 = Bearing.named("NU308", clearance=0.0)
LENGTH = NU308.geometry.roller_length
POSE = np.array([0.0, 25e-6, 8e-6, 0.0, 2e-4, -1e-4])
VELOCITY = np.array([0.0, -2e-3, 1e-3, 0.0, 0.01, 0.02])


def of_hertz(points, kind="series", outside="error"):
    """Points of Hertz' law with a damper."""
    hertz = laws.hertz(NU308, damping_time=1.25e-5)
    law = hertz if kind == "series" else hertz.single()
    at = 1e-4 * np.linspace(0.0, 1.0, points) ** 2
    load, _, damping = law.evaluate(at, np.zeros_like(at))
    return TableLaw("points", kind, at, load / LENGTH, damping / LENGTH, LENGTH, outside)


@pytest.mark.parametrize("points", [100, 200, 400])
def test_error_of_the_interpolation(points):
    """The power law x^p, r = h/x with the distance h of the points, where the distances grow by h^2/(2 x).

    PCHIP takes a weighted harmonic mean of two secants for the slope at a point. Its error over the slope is at most
    r^2 (|p-1|/12 + |(p-1)(p-2)|/6 + (p-1)^2/4): of the weights, of the curvature of the slope, of the harmonic mean;
    0.0288 r^2 with p = 10/9 (load), 0.551 r^2 with p = 1/9 (damping). A cubic between such slopes has at most h/4 of
    their error, which is p/4 r of it over the value, and h^4/384 of the fourth derivative. Cells, 3 % of x wide, add
    the same with r = 0.03. In the last cell damping bends to the constant above it.
    """
    law, hertz = of_hertz(points), laws.hertz(NU308, damping_time=1.25e-5)
    at = np.geomspace(5e-6, 96e-6, 5001)
    r = 2.0 * np.sqrt(1e-4 / at) / (points - 1)
    bounds = 0.0080 * r**3 + 4.4e-10, 0.0288 * r**2 + 4e-8, 0.0153 * r**3 + 0.0014 * r**4 + 1.2e-9
    still = np.zeros_like(at)
    for got, exact, bound in zip(law.evaluate(at, still), hertz.evaluate(at, still), bounds, strict=True):
        assert np.all(np.abs(got / exact - 1.0) < bound)


def test_points_of_hertz_are_hertz():
    """Bounds of the errors of force, K and C of a bearing, over their largest entries.

    The most loaded slices have 22 um, r = 0.011: the bounds above are 1e-8, 3.5e-6 and 2e-8 there. Those of slices
    with less grow as r^3, r^2 and r^3, while they bear less: summed over a roller that makes a factor below 10 for
    force and K, and below 50 for C.
    """
    wanted = BearingForce(NU308, laws.hertz(NU308, damping_time=1.25e-5))(POSE, VELOCITY)
    for law in (of_hertz(400), of_hertz(400, "single").series()):
        for got, exact, error in zip(
            BearingForce(NU308, law)(POSE, VELOCITY), wanted, (1e-7, 3.5e-5, 1e-6), strict=True
        ):
            assert np.max(np.abs(got - exact)) < error * np.max(np.abs(exact))


def test_python_and_compiled_code_read_the_same_cells():
    law = of_hertz(30)
    at = np.linspace(-1e-6, 1e-4, 301)
    h = 1e-10
    slope = (law.load(at[5:-1] + h) - law.load(at[5:-1] - h)) / (2.0 * h)
    _, k, _ = law.evaluate(at[5:-1], np.zeros(at.size - 6))
    assert np.allclose(slope, k, rtol=1e-5)  # rounding of the difference
    parts = law.energy(at + h) - law.energy(at - h)
    assert np.allclose(parts / (2.0 * h), law.load(at), rtol=1e-4, atol=1e-3)  # rounding of the difference
    assert np.all(law.load(at[at <= 0.0]) == 0.0)
    load, _, _ = law.evaluate(at, np.full(at.size, -10.0))
    assert np.all(load >= 0.0)  # a contact never pulls


@pytest.mark.parametrize("middle", [20e-6, 2e-6], ids=["in contact", "lifting off"])
def test_a_cycle_loses_what_the_damper_takes(middle):
    """The load at rest brings back what it took; c rate^2 is lost, less where the contact would have to pull."""
    law = of_hertz(30)
    turn = np.linspace(0.0, 2.0 * np.pi, 4096, endpoint=False)
    omega, amplitude = 2.0 * np.pi * 3000.0, 5e-6
    delta, rate = middle + amplitude * np.sin(turn), amplitude * omega * np.cos(turn)
    (load, _, _), (_, _, c) = law.evaluate(delta, rate), law.evaluate(delta, np.zeros_like(rate))
    lost, bound = np.mean(load * rate), np.mean(c * rate**2)
    assert lost > 0.0
    if middle > amplitude:
        assert lost == pytest.approx(bound, rel=1e-6)  # sums of a function with jumps in its third derivative
    else:
        assert lost < bound * (1.0 + 1e-6)


def test_above_the_last_point_it_is_said(tmp_path, capsys):
    path = tmp_path / "low.csv"
    path.write_text("approach [um], load [N/mm]\n0, 0\n1, 5\n")
    model = assemble(read_scene("nu308_rigid"), law=f"table:{path}")
    assert source_of(model) == POINTS
    words = axes_outside(model, 0.0, {"bearing_left": 6000.0})["bearing_left"]
    assert words == "load per length of 6 N/mm is above the last point of the law, 5 N/mm"
    assert axes_outside(model, 0.0)["bearing_left"] == "a load above 5 N/mm, the last one"
    given = ("bearing", "NU308", "--load", "5 kN", "--speed", "500 rpm", "--law", f"table:{path}")
    status, out, _ = run(capsys, *given)
    assert status == 1 and f"law table {path}, dry; " in out
    assert "is above the last point of the law, 5 N/mm, where the law goes on straight; add points" in out
    status, _, err = run(capsys, *given, "-o", str(path))
    assert status == 2 and "which is read" in err
    status, _, err = run(capsys, *given[:-1], f"table:{path}.csv")
    assert status == 2 and "--law" in err


def test_above_the_last_point_calls_are_counted():
    far = np.array([0.0, 3e-4, 0.0, 0.0, 0.0, 0.0])
    with pytest.raises(OutsideMapError, match="has points up to"):
        BearingForce(NU308, of_hertz(20))(far)
    assert BearingForce(NU308, of_hertz(20, outside="clamp")).at().evaluate(far).outside


def test_laws_at_the_ends_of_what_is_allowed_are_numbers():
    for at, load in (([0.0, 1e-15, 2e-15], [0.0, 1e12 - 1.0, 1e12]), ([-1.0, 0.0, 1.0], [0.0, 1e-9, 2e-9])):
        law = TableLaw("edge", "series", np.array(at), np.array(load), np.array([0.0, 1e18, 0.0]), LENGTH)
        found = law.evaluate(np.linspace(at[0], at[-1], 9), np.linspace(-1.0, 1.0, 9))
        assert np.isfinite(found).all() and np.isfinite(law.energy(np.array(at))).all()


@pytest.mark.parametrize("between", [";", "\t"])
def test_numbers_with_a_decimal_comma(tmp_path, between):
    path, text = tmp_path / "law.csv", "approach [um], load [N/mm]\n0, 0\n1.5, 5.25\n2.5, 9.5\n"
    path.write_text(text)
    plain = read_law(path, LENGTH)
    path.write_text(text.replace(",", between).replace(".", ","))
    at = np.array([1e-6, 2e-6])
    np.testing.assert_array_equal(read_law(path, LENGTH).evaluate(at, 0.0 * at), plain.evaluate(at, 0.0 * at))


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "empty"),
        ("approach [um], load [N/mm]\n0, 0\n", "points: got 1; allowed: two or more"),
        ("approach [um], load [N/mm]\n0, 0\n1, nan\n", "load at point 2: got nan"),
        ("approach [um], load [N/mm]\n0, 0\n1, 5\n1, 6\n", "approach at point 3"),
        ("approach [um], load [N/mm]\n0, 0\n1, 5\n2, 4\n", "load at point 3"),
        ("approach [um], load [N/mm]\n0, 1\n1, 5\n", "load at point 1"),
        ("approach [N], load [N/mm]\n0, 0\n1, 5\n", "column approach"),
        ("approach, load\n0, 0\n1, 5\n", "got the column 'approach'"),
        ("approach [um], load [N/mm]\n0, 0\n1, x\n", "line 3: got '1, x'"),
        ("approach [um], load [N/mm], damping [N s/m^2]\n0, 0, 0\n1, 5, -1\n", "damping at point 2"),
        ("approach [um], load [N/mm]\n0, 0\n1, 5\n2, 1e300\n", "load at point 3: got 1e+303 N/m; allowed: 0 to 1e+12"),
        ("approach [um], load [N/mm]\n0, 0\n1, 1e-300\n2, 2e-300\n", "load at point 2: got 1e-297 N/m; allowed: at"),
        ("approach [um], load [N/mm]\n0, 0\n1e-300, 1\n2e-300, 2\n", "approach at point 2: got 1e-306 m; allowed: at"),
        ("approach [um], load [N/mm]\n0, 0\n1e300, 1\n", "approach at point 2: got 1e+294 m; allowed: -1 to 1 m"),
        ("approach [um], load [N/mm], damping [N s/m^2]\n0, 0, 0\n1, 5, 1e300\n", "damping at point 2: got 1e+300"),
        ("approach [um], load [N/mm]\n" + "1, 2\n" * 10001, "got 10001 points"),
        ("approach [um], load [N/mm]\n" + "1, 2\n" * 1000000, "1 MB"),
        (b"\xff\xfe\x00", "UTF-8"),
    ],
)
def test_files_that_are_refused(tmp_path, text, message):
    path = tmp_path / "law.csv"
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    with pytest.raises(InputError, match=re.escape(message)):
        read_law(path, LENGTH)
