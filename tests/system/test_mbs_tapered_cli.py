"""`mbs bearing` of tapered roller bearings as a newcomer meets it, and the point behind it."""

from __future__ import annotations

import csv
import math

import numpy as np
import pytest
import xarray as xr

from ehdmaps.errors import AnalysisError, InputError
from ehdmaps.jobs.make.table_law import table_map
from ehdmaps.physics.hertz import LINE_LIMIT
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.rollers.tapered_catalogue import tapered_boundary, tapered_estimate
from ehdmaps.physics.rollers.tapered_geometry import TaperedGeometry
from mbs.bearings.locating.normal_law import contact
from mbs.bearings.tapered.line_film import LOADS, cylinder_of, line_film
from mbs.bearings.tapered.tapered_bearing import TaperedForce
from mbs.bearings.tapered.tapered_point import TaperedPoint
from mbs.life import roller_reference_life
from tests.cases import commands

RPM = math.pi / 30.0
LOADED = ("32208", "--load", "5 kN", "--axial", "2 kN", "--speed", "3000 rpm")
FORCE = TaperedForce(tapered_estimate("32208"))


@pytest.fixture
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


def run(capsys, *arguments):
    return commands.run(capsys, "bearing", *arguments)


def test_one_point(capsys, here) -> None:
    status, out, err = run(capsys, *LOADED, "--law", "hertz")
    assert (status, err) == (0, "")
    point = TaperedPoint.at(FORCE, (2000.0, 5000.0, 0.0), 3000.0 * RPM, oil=Lubricant.named("FVA3"))
    line = next(line for line in out.splitlines() if line.startswith("  stiffness"))
    numbers = [float(word) for word in line[42:].split()]
    assert numbers == pytest.approx([1e-6 * point.stiffness[i, i] for i in (1, 2, 0)], rel=1e-4)  # digits shown
    for words in ("inner geometry estimated", "assumed: temperature 40 degC", "slides with 1.37 m/s", "L10r"):
        assert words in out
    assert f"{point.loaded} of 17 rollers carry more than 1 %" in out


def test_films_are_the_default_and_feel_oil_and_roughness(capsys, here) -> None:
    """Thinner oil damps less; rough surfaces carry a part of the load that the film has without them."""
    ask = ("32208", "--axial", "2 kN", "--load", "5 kN", "--speed", "3000 rpm")
    pages = {
        words: run(capsys, *ask, *words)[1]
        for words in (
            *((), ("--law", "table"), ("--law", "formula"), ("--oil", "ISO VG 10"), ("--roughness", "0.5 um")),
            *(("--physics", "isothermal"), ("--supply", "grease")),
        )
    }

    def along(words, label):
        line = next(line for line in pages[words].splitlines() if line.startswith(f"  {label} "))
        return float(line[42:].split()[0])

    assert pages[()] == pages["--law", "table"]
    assert along((), "damping,") > along(("--oil", "ISO VG 10"), "damping,") > 0.0
    assert along(("--roughness", "0.5 um"), "damping,") < along((), "damping,")
    assert "roughness 0.5 um" in pages["--roughness", "0.5 um"]
    formula = along(("--law", "formula"), "stiffness")
    cold = ("--physics", "isothermal")
    assert formula == pytest.approx(along(cold, "stiffness"), rel=0.03)  # of the formula's film offset
    films = [along(words, "smallest central film") for words in (cold, (), ("--supply", "grease"))]
    assert films == sorted(films, reverse=True) and 0.0 < films[2] < 0.75 < films[1] < 0.97 * films[0]
    assert "damping is far too low" in pages["--law", "formula"]


def test_tables_hold_the_balance(capsys, here) -> None:
    """Loads of all rollers are the load on the ring: of the equilibrium, 1e-9."""
    command = ("HR 32208 J", "--load", "5 kN", "--axial", "2 kN", "--speed", "1000 rpm", "6000 rpm", "2")
    assert run(capsys, *command, "--law", "hertz:1e-5 s", "--slices", "9", "-o", "out.nc")[0] == 0
    with xr.open_dataset("out.nc") as data:
        cup = data["roller_load"].sel(contact="outer").values[0, 0]
        angle, alpha = data["roller"].values, FORCE.geometry.cup_angle
        centrifugal = float(data["centrifugal_load"][0, 0])
        assert np.sum(cup * math.sin(alpha)) == pytest.approx(2000.0, rel=1e-8)
        radial = (cup * math.cos(alpha) - centrifugal) * np.cos(angle)
        assert np.sum(radial) == pytest.approx(5000.0, rel=1e-8)
        stiffness, damping = (data[f"{name}_matrix"].values for name in ("stiffness", "damping"))
        assert np.max(np.abs(damping - 1e-5 * stiffness)) < 1e-9 * 1e-5 * np.max(stiffness)
    status, out, _ = run(capsys, *command, "-o", "out.csv")
    assert status == 0 and "P_ref" in out
    with open("out.csv", encoding="utf-8") as file:
        rows = list(csv.reader(line for line in file if not line.startswith("#")))
    assert "equivalent_load" in ",".join(rows[0]) and len(rows) == 3


@pytest.mark.parametrize(
    ("command", "words"),
    [
        (("32208", "--load", "5 kN", "--speed", "0 rpm"), "--axial: got 0 N; allowed: above zero"),
        ((*LOADED, "--clearance", "5 um", "--coupled"), "--clearance, --coupled: not for tapered roller bearings"),
        ((*LOADED, "--law", "films"), "for a tapered roller bearing; allowed: hertz, hertz:TIME"),
        (
            (*LOADED, "--profile", "a.csv"),
            "--profile: got 'a.csv' for a tapered roller bearing; allowed: iso, straight",
        ),
        (("32299", *LOADED[1:]), "BEARING: tapered bearing designation: got '32299'"),
        (
            ("32208", *LOADED[1:5], "--speed", "0 rpm", "9 rpm", "400", "--load", "1 N", "2 N", "2"),
            "--load, --speed: got 1200 points",
        ),
    ],
)
def test_refusals(capsys, here, command, words) -> None:
    status, _, err = run(capsys, *command)
    assert status == 2 and words in err


@pytest.mark.parametrize(
    ("command", "words"),
    [
        (
            ("NU308", "--axial", "1 kN"),
            "--axial: got cylindrical rollers without --axial, or without ribs for it; allowed for",
        ),
        (("NA4908", "--axial", "1 kN"), "needles none"),
        (("NJ308", "--axial=-1 kN"), "--axial: got -1000 N; allowed: above zero: NJ308 carries one way"),
        (("NUP210", "--axial", "0 N"), "--axial: got 0 N; allowed: not zero"),
        (("NUP210", "--axial", "1 kN", "--profile", "isso"), "--profile: got 'isso' (did you mean 'iso'?)"),
        (("NUP210", "--axial", "1 kN", "--coupled"), "--coupled: not for ribbed roller bearings"),
    ],
)
def test_ribs_are_refused_where_there_are_none(capsys, here, command, words) -> None:
    status, _, err = run(capsys, *command, "--load", "5 kN", "--speed", "0 rpm")
    assert status == 2 and words in err


def test_ribs_of_cylindrical_rollers(capsys, here) -> None:
    """Loads of the table are in balance with the axial load: of the equilibrium."""
    command = ("NUP 210 ECP", "--axial=-3 kN", "--load", "5 kN", "--speed", "3000 rpm", "--clearance", "20 um")
    status, out, err = run(capsys, *command, "-o", "out.nc", "--profile", "{ crown_drop = '8 um' }")
    assert "profile crowned with a radius of" in out
    assert (status, err) == (0, "")
    for words in ("clearance 20 um; ribs carry both ways, open by 0.5 deg", "0.5 Fr = 2500 N", "no axial clearance"):
        assert words in out
    with xr.open_dataset("out.nc") as data:
        leans = math.cos(math.radians(0.5))
        assert float(data["rib_load"].sum()) * leans == pytest.approx(3000.0, rel=1e-8)
        assert data.attrs["bearing_carries"] == "both"


def test_no_equilibrium_and_overload_are_said() -> None:
    with pytest.raises(
        AnalysisError, match=r"falls apart without a positive axial load above tan.alpha. .Fr . Z Fc. = 1233 N, Fc the"
    ):
        TaperedPoint.at(FORCE, (0.0, 5000.0, 0.0), 0.0)
    with pytest.raises(InputError, match=r"bearing point, load: got .*; allowed: three finite numbers"):
        TaperedPoint.at(FORCE, (0.0, 0.0, 0.0), 0.0)
    with pytest.raises(
        AnalysisError, match=r"no equilibrium of 32208 under 1e\+07 N axial, 0 N radial: tapered bearing"
    ):
        TaperedPoint.at(FORCE, (1e7, 0.0, 0.0), 0.0)
    # centrifugal loads press rollers into the cup, which asks for an axial load of its own
    with pytest.raises(AnalysisError, match=r"above tan.alpha. .Fr . Z Fc. = 21\d\d N"):
        TaperedPoint.at(FORCE, (2000.0, 5000.0, 0.0), 20000.0 * RPM)
    point = TaperedPoint.at(FORCE, (1e5, 2e5, 0.0), 0.0)
    assert point.pressure.max() > LINE_LIMIT and "the static limit of ISO 76" in point.problems[0]
    little = TaperedPoint.at(FORCE, (1350.0, 5000.0, 0.0), 0.0)
    assert "less than half" in " ".join(little.notes) and little.reference.life > 0.0
    free = TaperedPoint.at(FORCE, (2000.0, 5000.0, 0.0), 0.0, tilts=True)
    assert "crowd at an end" in " ".join(free.notes)


def test_the_reference_load_is_that_of_a_public_code() -> None:
    """minzhun/ISO16281, RollerBearing(1, 12, 9.0, 43.5, 13.6, 0.0, 0.0, 1, 40), straight, 3 kN, C = 40 kN, no edges."""
    force = TaperedForce(TaperedGeometry("x", 9e-3, 13.6e-3, 43.5e-3, 12, 0.0), profile="straight", slices=40)
    pose = [0.0, 5.024242357274666e-6, 0.0, 0.0, 0.0, 0.0]
    assert force(pose)[0][1] == pytest.approx(-3000.0, rel=1e-9)  # digits of its displacement
    slices = force.loads(pose).slices * 13.6e-3 / 40
    load, life = roller_reference_life(slices, 40e3, 9.0 / 43.5, 0.0, edges=False)
    assert load == pytest.approx(1435.1519996562806, rel=1e-9)
    assert life == pytest.approx(65645.8036738807, rel=1e-9)
    assert roller_reference_life(slices, 40e3, 9.0 / 43.5, 0.0, inner_turns=False, edges=False)[1] < life
    assert roller_reference_life(0.0 * slices, 40e3, 9.0 / 43.5, 0.0) == (0.0, math.inf)


def test_factors_of_catalogues_come_near_the_lives_of_slices() -> None:
    """Pure axial load against half of the rollers loaded: 0.377/tan(alpha) by mean loads, Y = 0.4/tan(alpha)."""
    force = TaperedForce(tapered_estimate("32208"), profile="straight")
    thrust = tapered_boundary("32208").thrust_factor
    half = TaperedPoint.at(force, (0.5 * 5000.0 / thrust, 5000.0, 0.0), 300.0)
    axial = TaperedPoint.at(force, (5000.0, 0.0, 0.0), 300.0)
    equal = (
        5000.0 * (half.reference.life / axial.reference.life) ** 0.25 / 5000.0
    )  # lives go with the fourth power of lines
    assert equal == pytest.approx(0.377 / math.tan(force.geometry.cup_angle), rel=0.03)  # rounding of both factors
    assert equal == pytest.approx(thrust, rel=0.08)  # catalogues are on the safe side


@pytest.mark.slow
def test_films_of_the_table_act_in_the_balance(capsys, here) -> None:
    """The table of the kernel is the law; films lift the ring out of the cup, and are softer in series."""
    law = line_law("inner")
    speed, length = FORCE.geometry.entrainment_speed(3000.0 * RPM), FORCE.geometry.roller_length
    film = line_film(law, length, speed, 313.15)
    places = np.array([-20e-6, -1e-6, -0.2e-6, 0.3e-6, 2e-6, 10e-6, 30e-6])
    expected = np.array(law.at(speed, 313.15).evaluate(places, np.zeros(7))[:3]) * length
    found = np.array([contact(film, place) for place in places]).T
    assert np.max(np.abs(found[0] / expected[0] - 1.0)) < 1e-8  # cubics between 1200 nodes
    assert np.max(np.abs(found / expected - 1.0)) < 2e-2  # the law has corners at its own points, rounded in a cell
    status, out, _ = run(capsys, *LOADED, "--law", "table")
    assert status == 0 and "film table at radius and speed of the middle, inlet heat, rib dry" in out
    rows = {line[2:10].strip(): line[42:].split() for line in out.splitlines() if line[42:].strip()}
    dry = TaperedPoint.at(FORCE, (2000.0, 5000.0, 0.0), 3000.0 * RPM)
    assert 0.8e-6 * dry.stiffness[1, 1] < float(rows["stiffnes"][0]) < 1e-6 * dry.stiffness[1, 1]
    assert float(rows["damping,"][0]) > 1.0
    # by both films over the sine of the contact angle: a third of 1.3 and 1.4 um more than central films are stiff
    lifted = (1e6 * dry.pose[0] - float(rows["inner ri"][2])) * math.sin(FORCE.geometry.cup_angle)
    assert 2.7 < lifted < 1.35 * 2.7
    assert "17 of 17 rollers carry" in out


def line_law(side):
    speed = FORCE.geometry.entrainment_speed(3000.0 * RPM)
    speeds, kelvin = (0.9 * speed, 1.1 * speed), (313.15, 313.15)
    emap = table_map(cylinder_of(FORCE.geometry), Lubricant.named("FVA3"), LOADS, speeds, kelvin)
    return emap.law(side, "clamp")
