"""Dry laws by points: beside the power law they were taken from, their bounds, and files that are refused."""

import re

import numpy as np
import pytest

from ehdmaps.errors import InputError, OutsideMapError
from mbs.bearings import laws
from mbs.bearings.bearing import Bearing
from mbs.bearings.bearing_force import BearingForce
from mbs.bearings.table_law import TableLaw
from mbs.scene.law_file import read_law

NU308 = Bearing.named("NU308")
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


def test_points_of_hertz_are_hertz():
    """1e-5 of force and 1e-3 of K and C bound what cubics between 400 points, in cells, leave of a power law."""
    wanted = BearingForce(NU308, laws.hertz(NU308, damping_time=1.25e-5))(POSE, VELOCITY)
    for law in (of_hertz(400), of_hertz(400, "single").series()):
        for got, exact, error in zip(BearingForce(NU308, law)(POSE, VELOCITY), wanted, (1e-5, 1e-3, 1e-3), strict=True):
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


def test_above_the_last_point_it_is_said():
    far = np.array([0.0, 3e-4, 0.0, 0.0, 0.0, 0.0])
    with pytest.raises(OutsideMapError, match="has points up to"):
        BearingForce(NU308, of_hertz(20))(far)
    assert BearingForce(NU308, of_hertz(20, outside="clamp")).at().evaluate(far).outside


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
