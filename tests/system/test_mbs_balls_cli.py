"""`mbs bearing` of ball bearings as a newcomer meets it."""

from __future__ import annotations

import csv
import math
import tomllib
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from ehdmaps.physics.hertz import POINT_LIMIT
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.point.ball_catalogue import ball_estimate
from ehdmaps.physics.solids import STEEL
from mbs.bearings.balls.ball_bearing import BallForce
from mbs.bearings.balls.ball_point import BallPoint
from mbs.bearings.balls.laws import dry_law
from tests.cases import commands

RPM = math.pi / 30.0
LOADED = ("6208", "--load", "2 kN", "--axial", "500 N", "--speed", "3000 rpm")


@pytest.fixture
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


def run(capsys, *arguments):
    return commands.run(capsys, "bearing", *arguments)


def numbers(out, label):
    """Numbers of the line of the page that begins with its label."""
    line = next(line for line in out.splitlines() if line.startswith(f"  {label}"))
    return [float(word) for word in line[42:].split()]


def test_one_point(capsys, here) -> None:
    status, out, err = run(capsys, *LOADED, "--law", "hertz", "--clearance", "0 um")
    assert (status, err) == (0, "")
    geometry = ball_estimate("6208").with_clearance(0.0)
    force = BallForce(geometry, dry_law(geometry))
    point = BallPoint.at(force, (500.0, 2000.0, 0.0), 3000.0 * RPM, oil=Lubricant.named("FVA3"))
    assert numbers(out, "stiffness") == pytest.approx([1e-6 * point.stiffness[i, i] for i in (1, 2, 0)], rel=1e-4)
    assert numbers(out, "Hertz pressure") == pytest.approx(1e-9 * point.pressure.max(axis=1), rel=1e-4)
    angles = [math.degrees(point.elements.mean_angle(side)) for side in (0, 1)]
    assert numbers(out, "mean contact angle") == pytest.approx(angles, rel=1e-4)
    assert "inner geometry estimated from catalogue dimensions" in out
    assert "7 of 9 balls carry more than 1 %" in out
    assert "assumed: temperature 40 degC" in out


def test_balance_of_the_balls(capsys, here) -> None:
    """Radial and axial parts of all inner loads are the load: of the equilibrium, 1e-9."""
    assert run(capsys, *LOADED, "-o", "out.nc")[0] == 0
    with xr.open_dataset("out.nc") as data:
        load = data["ball_load"].sel(contact="inner").values[0, 0]
        angle = data["ball_contact_angle"].sel(contact="inner").values[0, 0]
        assert np.sum(load * np.sin(angle)) == pytest.approx(500.0, rel=1e-8)
        assert np.sum(load * np.cos(angle) * np.cos(data["ball"].values)) == pytest.approx(2000.0, rel=1e-8)
        assert data.attrs["axial_load_N"] == 500.0
        assert data.attrs["bearing_balls"] == 9
        matrix = data["stiffness_matrix"].values[0, 0]
        assert matrix[1, 1] == pytest.approx(float(data["stiffness_along"].values[0, 0]), rel=1e-12)


def test_table_over_load_and_speed(capsys, here) -> None:
    command = ("7208 BEP", "--load", "500 N", "1 kN", "2", "--axial", "3 kN", "--speed", "1000 rpm", "15000 rpm", "3")
    status, out, _ = run(capsys, *command, "-o", "out.csv", "--law", "hertz:1.25e-5 s")
    assert status == 0
    with open("out.csv", encoding="utf-8") as file:
        rows = list(csv.reader(line for line in file if not line.startswith("#")))
    assert len(rows) == 1 + 2 * 3
    column = rows[0].index("contact_angle_outer [rad]")
    fast = [float(row[column]) for row in rows[1:4]]
    assert fast[0] > fast[1] > fast[2]
    damping, stiffness = (rows[0].index(name) for name in ("damping_axial [N s/m]", "stiffness_axial [N/m]"))
    # each contact has c = tau k along its normal; what turns has none
    ratio = float(rows[1][damping]) / float(rows[1][stiffness])
    assert 0.8 * 1.25e-5 < ratio < 1.0001 * 1.25e-5
    assert "note: the gyroscopic moment asks for a traction" in out


def test_films_follow_the_speed(capsys, here) -> None:
    """h_min goes with U^0.68 at one load: 2^0.68 = 1.602."""
    films = [
        numbers(run(capsys, *LOADED[:-1], speed, "--law", "hertz")[1], "smallest film")[0]
        for speed in ("400 rpm", "800 rpm")
    ]
    assert films[1] / films[0] == pytest.approx(2.0**0.68, rel=1e-3)


@pytest.mark.parametrize("law", ["films", "table"])
def test_laws_with_films_are_read(capsys, here, law) -> None:
    """Films move the contact angle of a bearing without clearance, and damp; at rest there are none."""
    command = (*LOADED[:-2], "--temperature", "60 degC", "--clearance", "0 um")
    status, out, err = run(capsys, *command, "--speed", "3000 rpm", "--law", law)
    assert status == 0 and "read from the film table" in out
    assert "3000 rpm: films read from the table at" in err and "solved" not in err
    dry = run(capsys, *command, "--speed", "3000 rpm", "--law", "hertz")[1]
    angles = [numbers(page, "mean contact angle")[0] for page in (out, dry)]
    assert 0.4 < angles[1] - angles[0] < 2.0
    assert min(numbers(out, "damping")) > 0.0 == max(numbers(dry, "damping"))
    assert all(0.0 < error < 10.0 for error in numbers(out, "stated error of film offset"))
    assert "stated error" not in dry
    still = run(capsys, *command, "--speed", "0 rpm", "--law", law)[1]
    assert max(numbers(still, "damping")) == 0.0


def test_films_are_the_default(capsys, here) -> None:
    """Without --law the films are those of the table, at the oil that was typed."""
    oils = ("FVA3", "ISO VG 10")
    by_default, asked = (
        [run(capsys, *LOADED, "--oil", oil, *law)[1] for oil in oils] for law in ((), ("--law", "table"))
    )
    assert by_default == asked
    assert numbers(by_default[0], "damping") > numbers(by_default[1], "damping") > [0.0, 0.0, 0.0]


def test_speeds_without_films_are_dry_and_say_why(capsys, here) -> None:
    """By default a speed beyond the table is dry, with a reason; below the table films fade to dry contacts."""
    ask = ("6208", "--load", "1 kN", "--temperature", "20 degC", "--oil", "ISO VG 68")
    status, out, _ = run(capsys, *ask, "--speed", "30 rpm", "--speed", "30000 rpm", "-o", "out.nc")
    assert status == 1
    assert (
        "warning: 30000 rpm: dry and without damping, as the film table has no films there (films of the inner" in out
    )
    with xr.open_dataset("out.nc") as data:
        damping, words = data["damping_along"].values[0], data["outside"].values[0].tolist()
    assert damping[0] > 0.0 == damping[1] and words[0] == "" and "no films there" in words[1]
    status, _, err = run(capsys, *ask, "--speed", "30000 rpm", "--law", "table")
    assert status == 1 and "rpm: film table has no films there (films of the inner contact" in err
    # a lowest speed of the table of 19.6 rpm
    fading = ("6208", "--load", "1 kN", "--oil", "ISO VG 10", "--speed", "0 rpm", "2 rpm", "3", "-o", "slow.nc")
    status, out, _ = run(capsys, *fading)
    assert status == 0 and "note: 2 rpm: films fade, as the film table of points begins at 0.0" in out
    with xr.open_dataset("slow.nc") as data:
        still, slow, faster = data["stiffness_along"].values[0]
    assert abs(slow - still) < abs(faster - still) < 0.01 * still


@pytest.mark.parametrize(
    "bearing",
    [("6208", "--axial", "0.5 kN"), ("32208", "--axial", "1 kN"), ("NUP210", "--axial", "0.5 kN"), ("NU308",)],
)
def test_smooth_surfaces_have_the_assumed_roughness_in_lambda(capsys, here, bearing) -> None:
    ask = (*bearing, "--load", "2 kN", "--speed", "1000 rpm")
    status, smooth, _ = run(capsys, *ask, "--roughness", "smooth")
    assert status == 0 and "combined rms roughness 0.3 um (for Lambda only)" in smooth
    assert smooth == run(capsys, *ask)[1]


def test_outer_ring_turns(capsys, here) -> None:
    """The cage is faster, and so is the centrifugal load; radial stiffness hardly knows."""
    inner = run(capsys, "6208", "--load", "1 kN", "--speed", "10000 rpm")[1]
    outer = run(capsys, "6208", "--load", "1 kN", "--speed", "0 rpm", "--outer-speed", "10000 rpm")[1]
    cages = [float(out.split("cage ")[1].split()[0]) for out in (inner, outer)]
    assert cages[0] + cages[1] == pytest.approx(10000.0, rel=1e-3)
    assert cages[1] > cages[0]


def test_clearance_and_tilt(capsys, here) -> None:
    tight = numbers(run(capsys, *LOADED, "--clearance", "0 um")[1], "mean contact angle")
    loose = numbers(run(capsys, *LOADED, "--clearance", "20 um")[1], "mean contact angle")
    assert loose[0] > tight[0] + 1.0
    out = run(capsys, *LOADED, "--tilts")[1]
    assert "tilts freely" in out
    assert abs(numbers(out, "tilt about y and z")[1]) > 0.01


def test_overload_is_a_problem(capsys, here) -> None:
    status, out, _ = run(capsys, "6208", "--load", "60 kN", "--speed", "0 rpm")
    assert status == 1
    assert "static limit of ISO 76" in out


def test_static_rating_is_at_the_static_limit() -> None:
    """ISO 76: C0 gives 4.2 GPa at the most loaded ball with 5 F/Z; its f0 is for grooves of 0.52, ours are closer."""
    geometry = ball_estimate("6208")
    inner = geometry.contacts(STEEL)[0]
    pressure = inner.max_pressure(5.0 * 17900.0 / geometry.balls)
    assert pressure == pytest.approx(POINT_LIMIT, rel=0.12)


def test_angular_contact_without_axial_load_is_said(capsys, here) -> None:
    status, out, _ = run(capsys, "7208B", "--load", "1 kN", "--speed", "1000 rpm")
    assert status == 0
    assert "the axial load is too small to hold the contact angle" in out
    status, _, err = run(capsys, "7208B", "--load", "1 N", "--axial=-2 kN", "--speed", "1000 rpm")
    assert status != 0
    assert "angular contact bearing falls apart" in err


@pytest.mark.parametrize(
    ("command", "words"),
    [
        (("7208", "--load", "1 kN", "--speed", "0 rpm"), "without its contact angle; allowed: 7208C"),
        (("6299", "--load", "1 kN", "--speed", "0 rpm"), "ball bearing designation: got '6299'"),
        (("6208", "--load", "0 N", "--speed", "0 rpm"), "--load: got '0 N'"),
        (("6208", "--load", "1 kN", "--speed", "2e5 rpm"), "--speed: got '2e5 rpm'"),
        (("6208", "--load", "1 kN", "--speed", "0 rpm", "--law", "map"), "--law: got 'map' for a ball bearing"),
        (("6208", "--load", "1 kN", "--speed", "0 rpm", "--slices", "9"), "--slices: not for ball bearings"),
        (("6208", "--load", "1 kN", "--speed", "0 rpm", "--axial", "many"), "--axial: "),
        (("6208", "--load", "1 kN", "--speed", "0 rpm", "--clearance", "1 m"), "--clearance: "),
        (("NU308", "--load", "1 kN", "--speed", "0 rpm", "--axial", "1 N"), "--axial: got cylindrical rollers without"),
    ],
)
def test_wrong_options_are_refused(capsys, here, command, words) -> None:
    status, _, err = run(capsys, *command)
    assert status == 2
    assert words in err


def test_all_problems_at_once(capsys, here) -> None:
    status, _, err = run(capsys, "7208", "--load", "x", "--speed", "y", "--axial", "z")
    assert status == 2
    assert "4 problems" in err


def test_a_bearing_for_ross_has_the_matrices_of_the_result(capsys, here) -> None:
    """x and y of ROSS are y and z of the bearing; written digits, no error."""
    ask = (
        "7208B",
        "--load",
        "1 kN",
        "--axial",
        "3 kN",
        "--speed",
        "1000 rpm",
        "9000 rpm",
        "3",
        "--law",
        "hertz:1e-5 s",
    )
    for file in ("b.toml", "b.nc", "b.toml"):  # its own file may be replaced
        assert run(capsys, *ask, "-o", file)[0] == 0
    element = tomllib.loads(Path("b.toml").read_text())["BearingElement_7208B"]
    with xr.open_dataset("b.nc") as result:
        assert element["frequency"] == pytest.approx(result["speed"].values, rel=1e-11)
        for name, letter in (("stiffness_matrix", "k"), ("damping_matrix", "c")):
            matrix = result[name][0].values
            for term, row, column in (("xx", 1, 1), ("xy", 1, 2), ("yx", 2, 1), ("yy", 2, 2), ("zz", 0, 0)):
                expected = matrix[:, row, column]
                assert element[letter + term] == pytest.approx(expected, rel=1e-11, abs=1e-3)
        assert np.ptp(element["kxx"]) > 0.1 * element["kxx"][0]
    status, _, err = run(capsys, "6208", "--load", "1 kN", "--load", "2 kN", "--speed", "0 rpm", "-o", "b.toml")
    assert status == 2 and "-o: got b.toml for 2 loads and 1 speeds; allowed: one load, or a file .nc or .csv" in err


def test_the_largest_speed_in_rpm_is_allowed(capsys, here) -> None:
    """1e5 rpm is larger than its own limit by the rounding of the unit."""
    ask = ("7208B", "--load", "1 kN", "--axial", "2 kN", "--speed")
    status, out, _ = run(capsys, *ask, "100000 rpm", "--law", "hertz")
    assert status == 1 and "balls run on the outer raceway alone" in out and "static limit of ISO 76" in out
    assert run(capsys, *ask, "100001 rpm")[0] == 2
