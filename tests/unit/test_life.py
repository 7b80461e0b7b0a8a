"""Life of bearings: ISO/TS 16281 beside a public code, and a_ISO of ISO 281."""

from __future__ import annotations

import math
import re

import numpy as np
import pytest
from scipy.optimize import brentq

from ehdmaps.errors import InputError
from ehdmaps.physics.point.ball_catalogue import ball_estimate
from ehdmaps.physics.point.ball_geometry import BallGeometry
from ehdmaps.physics.point.ball_ratings import ball_dynamic_rating
from mbs.cli import main
from mbs.life import (
    a_iso,
    ball_reference_life,
    fatigue_limit,
    life_of_history,
    required_viscosity,
    roller_reference_life,
)


@pytest.mark.parametrize(
    ("profiled", "edges", "displacement", "life"),
    [(True, False, 12.404854, 183859.86), (False, False, 9.932438, 468398.94), (False, True, 9.932438, 160603.02)],
)
def test_rollers_by_laminae_written_out(profiled, edges, displacement, life) -> None:
    """N305 under 1 kN by the equations of the standard; the straight one is that of minzhun/ISO16281, a public code."""
    count, diameter, length, slices = 6, 9.0, 13.6, 40
    angle = 2.0 * np.pi * np.arange(count) / count
    place = (np.arange(slices) + 0.5) / slices * length - 0.5 * length
    depth = -0.00035 * diameter * np.log(1.0 - (2.0 * place / length) ** 2) * profiled

    def loads(way: float) -> np.ndarray:
        approach = (way * np.cos(angle) - 0.005)[:, None] - 2.0 * depth
        return 35948.0 * length ** (8.0 / 9.0) / slices * np.maximum(approach, 0.0) ** (10.0 / 9.0)

    way = brentq(lambda x: 1000.0 - np.sum(loads(x) * np.cos(angle)[:, None]), 1e-3, 0.1, xtol=1e-14)
    assert 1e3 * way == pytest.approx(displacement, rel=1e-6)
    found = roller_reference_life(np.stack([loads(way)] * 2), 31500.0, diameter / 43.5, 0.0, edges=edges)
    assert found.life == pytest.approx(life, rel=1e-6)


def test_half_a_ring_of_points_lives_as_the_rating_says() -> None:
    """C is defined at half of the balls loaded, Qmax = 4.37 Fr/(Z cos alpha): P_ref is then the load, within what the
    discrete balls and the standard's rounded factors 0.407, 0.389 leave (1 %)."""
    geometry = BallGeometry("x", 0.8e-3, 60e-3, 200, 0.52, 0.52, 0.0, 0.0)
    angle = 2.0 * np.pi * np.arange(200) / 200
    shape = np.maximum(np.cos(angle), 0.0) ** 1.5
    load = 1000.0
    balls = shape * load / np.sum(shape * np.cos(angle))
    assert ball_reference_life(geometry, np.stack([balls, balls]), 30e3).load == pytest.approx(load, rel=0.01)
    outer_turns = ball_reference_life(geometry, np.stack([balls, balls]), 30e3, inner_turns=False)
    assert outer_turns.load > load  # the weaker inner contact stands under its highest load


def test_no_load_lives_for_ever() -> None:
    geometry = ball_estimate("6208")
    assert ball_reference_life(geometry, np.zeros((2, 9)), 30e3) == (0.0, math.inf)
    assert roller_reference_life(np.zeros((2, 6, 5)), 30e3, 0.2, 0.0) == (0.0, math.inf)


@pytest.mark.parametrize(("name", "rating"), [("6208", 29.1), ("6308", 40.5), ("6205", 14.0), ("7208B", 32.0)])
def test_ratings_of_balls_are_near_those_of_a_maker(name, rating) -> None:
    """NSK's dynamic ratings [kN], by balls that were estimated from static ratings: 2 %."""
    assert 1e-3 * ball_dynamic_rating(ball_estimate(name)) == pytest.approx(rating, rel=0.02)


@pytest.mark.parametrize(
    ("kappa", "load", "ball", "roller"),
    [(1.0, 0.1, 2.43052, 0.39865), (2.0, 0.1, 4.20161, 0.51610), (0.5, 0.5, 2.13792, 0.37375)],
)
def test_a_iso_by_a_makers_catalogue(kappa, load, ball, roller) -> None:
    """The numbers of IBC's catalogue, which prints the same equations; 1e-4 as they are printed."""
    assert a_iso(kappa, load, "ball") == pytest.approx(ball, rel=1e-4)
    assert a_iso(kappa, load, "roller") == pytest.approx(roller, rel=1e-4)


def test_a_iso_over_its_range() -> None:
    assert math.isnan(a_iso(0.09, 1.0, "ball"))
    assert a_iso(50.0, 0.3, "roller") == a_iso(4.0, 0.3, "roller")
    assert a_iso(4.0, 5.0, "ball") == 50.0
    assert a_iso(1.0, 0.0, "ball") == pytest.approx(0.1)
    for join in (0.4, 1.0):  # the pieces meet within the rounding of their numbers
        for kind in ("ball", "roller"):
            assert a_iso(join * (1 - 1e-9), 0.2, kind) == pytest.approx(a_iso(join, 0.2, kind), rel=2e-3)
    for wrong in ((-1.0, 0.1, "ball"), (1.0, -0.1, "ball"), (math.nan, 0.1, "ball"), (1.0, math.inf, "ball")):
        with pytest.raises(InputError, match=r"a_ISO: got kappa"):
            a_iso(*wrong)
    with pytest.raises(InputError, match="allowed: ball, roller"):
        a_iso(1.0, 0.1, "needle")


def test_a_history_counts_turns() -> None:
    """Palmgren and Miner: half of the turns at each of two loads."""
    assert life_of_history([0.25, 0.75], [100.0, math.inf]) == pytest.approx(400.0)
    for shares, lives in (([0.5], [1.0, 2.0]), ([0.5, 0.6], [1.0, 2.0]), ([1.0], [0.0]), ([], [])):
        with pytest.raises(InputError, match=r"life, (history|shares|lives): got"):
            life_of_history(shares, lives)


@pytest.mark.parametrize(
    "shares",
    ["time [h]\n1, 0.2, 600, 50\n5, 0.5, 1200, 25\n2, 0, 0, 9", "share [%]\n1, 0.2, 600, 50\n5, 0.5, 1200, 50"],
)
def test_a_bearing_lives_through_a_history(tmp_path, capsys, shares) -> None:
    """Both halves of the turns wear it as each alone would; a point at rest wears nothing."""
    path, out = tmp_path / "duty.csv", tmp_path / "lives.csv"
    path.write_text(f"load [kN], axial [kN], speed [rpm], {shares}\n")
    assert main(["bearing", "6208", "--load", str(path), "--clearance", "10 um", "-o", str(out)]) == 0
    said = capsys.readouterr().out
    lines = [line.split(",") for line in out.read_text().splitlines() if not line.startswith("#")]
    rows = [dict(zip(lines[0], line, strict=True)) for line in lines[1:]]
    assert [float(row["share [1]"]) for row in rows][:2] == [0.5, 0.5]
    assert [float(row["axial [N]"]) for row in rows][:2] == [200.0, 500.0]
    one, other = (float(row["reference_life [1]"]) for row in rows[:2])
    both, hours, speed = map(
        float, re.search(r"L10r of all (\S+) million turns, (\S+) h at a mean of (\S+) rpm", said).groups()
    )
    assert both == pytest.approx(2.0 / (1.0 / one + 1.0 / other), rel=1e-3)
    assert speed == pytest.approx(800.0, rel=1e-6)  # of the time per turn
    assert hours == pytest.approx(both * 1e6 / 800.0 / 60.0, rel=1e-3)
    assert (
        main(
            [
                "bearing",
                "6208",
                "--load",
                "1 kN",
                "--axial",
                "200 N",
                "--speed",
                "600 rpm",
                "--clearance",
                "10 um",
                "--bands",
                "numerics",
            ]
        )
        == 0
    )
    assert f"L10r {one:.4g} million turns" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("text", "options", "wrong"),
    [
        ("load [kN], speed [rpm]\n1, 600", [], "got the columns load, speed; allowed: columns 'load [kN]'"),
        ("load [kN], speed [rpm], share [%]\n1, 600, 60", [], "got shares with a sum of 60 %; allowed: 100 %"),
        ("load [kN], speed [rpm], share [%]\n-1, 600, 100", [], "point 1: got a load of -1000 N, axial 0 N"),
        ("load [kN], speed [rpm], share [%]\n1, 0, 100", [], "point 1: got 1; allowed: a share of the revolutions"),
        ("load [kN], speed [rpm], time [h]\n1, 0, 2", [], "got no revolution"),
        ("load [kN], speed [rpm], time [h]\n1, 1e9, nan", [], "point 1: got 1e+09 rpm; allowed: 0 to 100000 rpm"),
        ("load [kN], speed [rpm], share [%]\n1, 600, 100", ["--speed", "1 rpm"], "--speed: got"),
        ("load [kN], axial [N], speed [rpm], share [%]\n1, 1, 600, 100", ["--axial", "1 N"], "--axial: got '1 N'"),
        ("load [kN], speed [rpm], share [%]\n1, 600, 100", ["-o", "a.nc"], "-o: "),
        ("load [kN], speed [rpm], share [%]\n", [], "got no points"),
    ],
)  # fmt: skip
def test_histories_that_are_refused(tmp_path, capsys, text, options, wrong) -> None:
    path = tmp_path / "duty.csv"
    path.write_text(text)
    assert main(["bearing", "6208", "--load", str(path), *options]) == 2
    assert wrong in capsys.readouterr().err


def test_a_bearing_needs_a_speed(capsys) -> None:
    assert main(["bearing", "6208", "--load", "1 kN"]) == 2
    assert '--speed: missing; allowed: of the inner ring, such as "1500 rpm"' in capsys.readouterr().err


def test_limits_of_viscosity_and_fatigue() -> None:
    """Both formulas of nu_1 meet at 1000 rpm within 2 %; C_u falls with large bearings alone."""
    rpm = math.pi / 30.0
    slow, fast = required_viscosity(999.999 * rpm, 0.06), required_viscosity(1000.0 * rpm, 0.06)
    assert slow == pytest.approx(fast, rel=0.03)
    assert required_viscosity(-500.0 * rpm, 0.06) == required_viscosity(500.0 * rpm, 0.06)
    assert fatigue_limit(22e3, 0.1, "ball") == pytest.approx(1e3)
    assert fatigue_limit(22e3, 0.4, "ball") == pytest.approx(0.5e3)


def test_each_bearing_of_a_machine_has_its_life(capsys) -> None:
    assert main(["statics", "nu308_rigid", "--law", "hertz"]) == 0
    said = capsys.readouterr().out
    found = re.findall(r"equivalent load (\S+) N, L10r (\S+) million turns \(ISO/TS 16281", said)
    assert len(found) == len(re.findall(r"Hertz pressure up to ", said)) == 2
    assert all(float(load) > 0.0 and float(life) > 0.0 for load, life in found)
    assert main(["statics", "nu308_rigid", "--law", "hertz", "--speed", "0 rpm"]) in (0, 1)
    assert "L10r" not in capsys.readouterr().out  # nothing turns
