"""Estimated inner geometry: against known bearings, its stated errors, and that it is never taken for known."""

import cmath
import json
import math
import re

import pytest

import ehdmaps
from ehdmaps.errors import InputError
from ehdmaps.jobs.cli import main
from ehdmaps.jobs.reader import parse_job
from ehdmaps.physics.bearing import BearingGeometry
from ehdmaps.physics.catalogue import boundary, designations, estimate, estimate_from_dimensions
from ehdmaps.physics.rollers.ratings import cylindrical_ratings
from ehdmaps.physics.rollers.ribbed_geometry import ribbed_way
from mbs import Bearing

from .test_job_reader import GOOD, NAMED

# C0 of the catalogue from which the raceways of series 2 and 3 are, N
RATINGS = {"NU308": 82.7e3, "NU206": 39.0e3, "NU204": 26.5e3, "NU209": 68.9e3, "NU2206": 51.5e3}


def stated(geometry):
    """Errors that a geometry states: raceways, roller diameter, roller length (relative), number of rollers."""
    found = re.search(
        r"about (\d+) %, roller diameter (\d+) %, roller length (\d+) %, .* \+-(\d+)$", geometry.estimated
    )
    raceways, diameter, length, number = map(int, found.groups())
    return raceways / 100, diameter / 100, length / 100, number


def errors(found, known):
    """The same errors, as they are."""
    relative = [
        abs(getattr(found, key) / getattr(known, key) - 1.0)
        for key in ("inner_raceway_diameter", "outer_raceway_diameter", "roller_diameter", "roller_length")
    ]
    return max(relative[:2]), relative[2], relative[3], abs(found.rollers - known.rollers)


@pytest.mark.parametrize(("name", "rating"), [("NU308", None), ("N1014", None), ("NU308", RATINGS["NU308"])], ids=str)
def test_known_bearings_are_within_the_stated_errors(name, rating):
    found = estimate(name, rating)
    for error, bound in zip(errors(found, BearingGeometry.named(name)), stated(found), strict=True):
        assert error <= bound


@pytest.mark.parametrize(
    ("name", "rollers", "roller_diameter", "pitch_diameter"),
    [
        ("N204", 11, 7.5e-3, 34e-3),
        ("NU205", 13, 7.5e-3, 38.5e-3),
        ("NU206", 13, 9.0e-3, 46.5e-3),
        ("NU2205", 13, 7.5e-3, 39e-3),
    ],
)
def test_published_rollers(name, rollers, roller_diameter, pitch_diameter):
    """From papers and reports on bearing data sets, most by their fault frequencies; the pitch to 2 % (NU205)."""
    found = estimate(name)
    assert found.rollers == rollers
    assert found.roller_diameter == pytest.approx(roller_diameter, rel=1e-9)
    assert found.pitch_diameter == pytest.approx(pitch_diameter, rel=0.02)


@pytest.mark.parametrize("name", RATINGS)
def test_the_static_rating_of_iso_76_comes_back(name):
    found = estimate(name, RATINGS[name])
    diameter, length = 1e3 * found.roller_diameter, 1e3 * found.roller_length
    rating = 44.0 * (1.0 - found.gamma) * found.rollers * length * diameter
    assert rating == pytest.approx(RATINGS[name], rel=1e-12)  # round-off


@pytest.mark.parametrize("name", RATINGS)
def test_the_share_of_the_width_is_within_its_error_of_the_rating(name):
    by_width, by_rating = estimate(name), estimate(name, RATINGS[name])
    assert by_width.roller_length == pytest.approx(by_rating.roller_length, rel=stated(by_width)[2])


def test_dimensions_alone_are_within_the_stated_errors_of_every_designation():
    from ehdmaps.physics.catalogue import _entries

    for (series, code), entry in _entries().items():
        known = estimate(f"NU{series}{code}")
        rating = 44e6 * (1.0 - known.gamma) * known.rollers * known.roller_length * known.roller_diameter
        found = estimate_from_dimensions(entry.bore, entry.outside_diameter, entry.width, rating)
        for error, bound in zip(errors(found, known), stated(found), strict=True):
            assert error <= bound


def test_the_table_has_the_boundary_dimensions_of_iso_15():
    """Bearings of all five series, and those of the project."""
    from ehdmaps.physics.catalogue import _entries

    sizes = {key: tuple(round(1e3 * v, 6) for v in entry[1:4]) for key, entry in _entries().items()}
    assert sizes["3", "08"] == (40, 90, 23) and sizes["10", "14"] == (70, 110, 20)
    assert sizes["2", "06"] == (30, 62, 16) and sizes["22", "05"] == (25, 52, 18) and sizes["23", "09"] == (45, 100, 36)
    assert len(designations()) == len(sizes) == 16 + 2 * 17 + 2 * 17


@pytest.mark.parametrize(
    ("name", "rating"),
    [
        ("NCF3004", 28.1),
        ("NCF 3005 CV", 31.9),
        ("NCF3006V", 39.6),
        ("NCF3007", 48.4),
        ("NCF3008/C3", 57.2),
        ("NCF3010", 76.5),
        ("NCF2912", 55.0), ("NCF3016 CV", 165.0), ("NCF2924", 172.0), ("NCF3024", 292.0), ("NCF2228 V", 693.0),
        ("NCF1840 CV", 176.0),
    ],
)  # fmt: skip
def test_full_complement_rollers_have_both_ratings_of_their_catalogue(name, rating):
    """C of ISO 281, which the estimate does not know; 3 % of the diameter, the rounding of rollers, is 1.5 % of C."""
    found = estimate(name)
    assert cylindrical_ratings(found)[0] == pytest.approx(1e3 * rating, rel=0.015)
    apart = found.pitch_diameter * abs(cmath.exp(2j * math.pi / found.rollers) - 1.0)  # of neighbours, twice
    apart_of_more = found.pitch_diameter * abs(cmath.exp(2j * math.pi / (found.rollers + 1)) - 1.0)
    assert apart_of_more < 2.0 * found.roller_diameter <= apart and "full complement" in found.estimated
    assert ribbed_way(name) == "+x" and boundary(name).series.startswith("NCF")


def test_high_capacity_rollers_are_those_of_nu2240():
    """E by F = 241 mm (Koyo); C by ISO 281 is within 3 %, half of a roller in 19, of SKF's 1460 kN, raised by 15 %."""
    found = estimate("NCF 2240 ECJB")
    assert found.inner_raceway_diameter == pytest.approx(0.241) and found.rollers == 19
    assert 1.15 * cylindrical_ratings(found)[0] == pytest.approx(1.46e6, rel=0.03)
    assert ribbed_way("SKF NCF 2240 ECJB/C3") == "+x" and estimate("NCF2240") == found
    assert "whose rollers a cage parts" in found.estimated
    for other in ("NCF 2240 V", "NCF 2240 CV", "NCF 2238 ECJB", "NCF 2244 ECJB/PEX"):
        with pytest.raises(InputError, match="other rollers than tables here have; allowed: without it"):
            estimate(other)


@pytest.mark.parametrize("name", ["NU406", "NU219X", "NU1004", "NU221", ""])
def test_other_designations_are_refused(name):
    with pytest.raises(
        InputError,
        match=rf"bearing designation: got {name!r}.*; allowed: N1014, NU308, and N, NU, NJ or NUP of series 10",
    ):
        estimate(name)


def test_impossible_estimates_are_refused():
    with pytest.raises(
        InputError, match=r"basic_static_rating 39.0 N, which takes rollers of 0.009394 mm in a width of 16"
    ):
        estimate("NU206", 39.0)
    with pytest.raises(InputError, match=r"got bore 0.09, outside_diameter 0.04, .* 0 < bore < outside_diameter"):
        estimate_from_dimensions(0.09, 0.04, 0.023, 78e3)


def parse(bearing):
    return parse_job(GOOD.replace(NAMED, f"[bearing]\n{bearing}\n"), name="job", where="job.toml")


def test_a_job_with_an_estimated_bearing():
    job = parse('estimate = "NU206"\nbasic_static_rating = "39 kN"\ndiametral_clearance = "30 um"\nlabel = "A"')
    assert job.bearing.roller_length == estimate("NU206", 39e3).roller_length
    assert job.bearing.diametral_clearance == 30e-6
    words = "inner geometry estimated from catalogue dimensions and static rating (ISO 76): raceways to about 3 %"
    assert job.title == "A"
    assert job.estimates[0].startswith(f"  bearing: {words}")
    by_hand = parse(
        'estimate = { bore = "30 mm", outside_diameter = "62 mm", width = "16 mm" }\nbasic_static_rating = "39 kN"'
    )
    assert by_hand.bearing == estimate_from_dimensions(0.03, 0.062, 0.016, 39e3)


@pytest.mark.parametrize(
    ("bearing", "text"),
    [
        (
            'name = "NU221"',
            r"\[bearing\] name: bearing designation: got 'NU221' \(did you mean 'NU2219'\?\); allowed: N1014",
        ),
        ("name = 206", r"name: got 206; allowed: a designation such as \"NU206\"$"),
        ('estimate = "NU206"\nrollers = 13', r"\[bearing\] rollers: stands beside estimate; allowed: one of the two"),
        ('estimate = "NU206"\nname = "NU308"', r"\[bearing\] name: stands beside estimate; allowed: one of the two"),
        ("estimate = 206", r"estimate: got 206; allowed: a designation such as \"NU206\", or \{ bore = "),
        (
            'estimate = "NU999"',
            r"\[bearing\] estimate: bearing designation: got 'NU999'.*; allowed: N1014, NU308, and N, NU, NJ",
        ),
        ('estimate = { bore = "30 mm" }', r"\[bearing\] basic_static_rating: missing; allowed: C0 of the catalogue"),
        ('estimate = { bore = "30 mm" }', r"\[bearing\] estimate width: missing"),
        ('estimate = "NU206"\nbasic_static_rating = "39 mm"', r"basic_static_rating: got the unit 'mm'"),
        ('name = "NU308"\nbasic_static_rating = "78 kN"', r"\[bearing\] basic_static_rating: unknown key"),
    ],
)
def test_wrong_estimates(bearing, text):
    with pytest.raises(InputError, match=text):
        parse(bearing)


def test_a_map_and_check_say_what_is_estimated(tmp_path, capsys):
    path, made = tmp_path / "job.toml", tmp_path / "map.nc"
    path.write_text(GOOD.replace(NAMED, '[bearing]\nestimate = "NU206"\n'))
    assert main(["check", str(path)]) == 0
    assert f"  bearing: {estimate('NU206').estimated}" in capsys.readouterr().out
    assert main(["generate", str(path), "-o", str(made), "--workers", "1"]) == 0
    emap = ehdmaps.open_map(made)
    assert emap.dataset.attrs["title"].startswith("EHD map of NU206, FVA3")
    assert capsys.readouterr().out.count(estimate("NU206").estimated) == 1
    assert json.loads(emap.dataset.attrs["geometry"])["estimated"] == estimate("NU206").estimated
    assert emap.bearing == estimate("NU206")


def test_an_estimate_is_no_known_bearing_and_serves_mbs():
    assert estimate("NU308").estimated and BearingGeometry.named("NU308").estimated is None
    assert estimate("NU308") != BearingGeometry.named("NU308")
    assert Bearing(estimate("NU206")).geometry.rollers == 13
