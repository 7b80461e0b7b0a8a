"""Needle roller bearings by designation, and rollers by both ratings of a catalogue."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest

from ehdmaps.errors import InputError
from ehdmaps.physics.catalogue import boundary, designated
from ehdmaps.physics.designations.reader import ROLLERS, bore_code, plain_name, table
from ehdmaps.physics.rollers import needle_catalogue as needles
from ehdmaps.physics.rollers.ratings import Rollers, by_ratings, dynamic_rating, static_rating
from mbs.bearings import laws
from mbs.bearings.bearing import Bearing
from mbs.bearings.bearing_force import BearingForce

# NSK, catalogue E1102e: both raceways [mm], C and C0 [N]; series 10, 4, E
CYLINDRICAL = (
    (47, 61, 27300, 29000), (58, 92, 95500, 89000), (52.5, 67.5, 32500, 35500), (64.5, 100.5, 107000, 102000),
    (70.8, 110.8, 129000, 124000), (77.2, 117.2, 139000, 138000), (49.5, 71.5, 72500, 77500), (52, 80, 83000, 81500),
    (59.5, 81.5, 69000, 76500), (65, 97, 163000, 187000),
)  # fmt: skip
# SKF, general catalogue 2018: raceways of shaft and housing [mm], C and C0 [N] of cages
CAGES = (
    (10, 13, 4570, 5700), (12, 18, 9520, 10000), (15, 21, 18700, 24500), (20, 24, 9520, 14600),
    (25, 35, 44600, 62000), (30, 40, 46800, 69500), (35, 42, 23300, 37500), (40, 48, 34700, 58500),
    (50, 55, 25500, 60000), (70, 78, 57200, 137000), (90, 97, 42900, 114000), (100, 108, 55000, 143000),
)  # fmt: skip


@pytest.mark.parametrize(("table", "filled", "quality"), [(CYLINDRICAL, 0.8, 1.1), (CAGES, 0.75, needles.QUALITY)])
def test_both_ratings_tell_the_diameter_of_rollers_that_are_known(table, filled, quality) -> None:
    # 4 %: ratings of three digits, and cages that fill more or less than assumed
    for inner, outer, dynamic, static in table:
        found = by_ratings(0.5e-3 * (inner + outer), (dynamic, static), filled, quality=quality)
        assert found.diameter == pytest.approx(0.5e-3 * (outer - inner), rel=0.04), (inner, outer)


def test_ratings_come_back_from_the_rollers_that_they_tell() -> None:
    angle = math.radians(14.0)
    found = by_ratings(60e-3, (77e3, 90.5e3), 0.9, angle)
    assert static_rating(found, 60e-3, angle) == pytest.approx(90.5e3, rel=1e-12)  # round-off
    assert dynamic_rating(found, 60e-3, angle) == pytest.approx(77e3, rel=1e-9)  # bisection
    with pytest.raises(InputError, match=r"got C = 1e\+06 N, C0 = 1000 N, to which no roller fits"):
        by_ratings(60e-3, (1e6, 1e3), 0.9)


def test_needles_of_machined_rings_have_half_millimetres() -> None:
    for bore, raceway, outside, _, dynamic, static in needles._MACHINED:
        diameter = 1e3 * needles.needle_diameter(1e-3 * raceway, (dynamic, static))
        assert abs(diameter - 0.5 * round(2.0 * diameter)) < 0.25
        geometry = designated(f"NA49{bore_code(bore)}")
        assert 1e3 * geometry.outer_raceway_diameter < outside - 2.0  # a ring of more than a millimetre
        assert abs(diameter - 1e3 * geometry.roller_diameter) < 0.23  # 4 % of the largest of them


@pytest.mark.parametrize("name", ["NA4908", "RNA 4908-XL", "K40x48x20", "k 25x30x20"])
def test_the_rating_of_a_needle_bearing_is_that_of_its_catalogue(name) -> None:
    geometry = designated(name)
    rollers = Rollers(geometry.roller_diameter, geometry.roller_length, geometry.rollers)
    rating = {"A": 71e3, "4": 58.5e3, "2": 36.5e3}[geometry.name.removeprefix("R")[1]]
    assert static_rating(rollers, geometry.pitch_diameter) == pytest.approx(rating, rel=1e-12)  # round-off
    own = needles.needle_estimate(name, 0.9 * rating)
    assert own.roller_length == pytest.approx(0.9 * geometry.roller_length, rel=1e-12)
    assert "estimated" in (geometry.estimated or "")


def test_full_complement_has_as_many_needles_as_go_in() -> None:
    full, caged = designated("NAV 4908"), designated("NA4908")
    room = math.pi / math.asin(full.roller_diameter / full.pitch_diameter)
    assert full.rollers == int(room) == 33
    assert (full.roller_length, full.roller_diameter) == (caged.roller_length, caged.roller_diameter)
    assert boundary("NAV4908") == boundary("NA4908") and boundary("K40x48x20") is None
    assert boundary("RNA4908").bore == caged.inner_raceway_diameter


@pytest.mark.parametrize("name", ["NA4908", "NAV4908", "K40x48x20"])
def test_the_force_is_the_sum_over_needles(name) -> None:
    """The cylindrical element, whose needles carry c_L (delta cos)^(10/9) each."""
    bearing = Bearing(dataclasses.replace(designated(name), diametral_clearance=0.0), "straight", 5)
    law = laws.hertz(bearing)
    angles = 2.0 * math.pi * np.arange(bearing.geometry.rollers) / bearing.geometry.rollers
    cos = np.maximum(np.cos(angles), 0.0)
    expected = -law.coefficient * float(np.sum((4e-6 * cos) ** (10.0 / 9.0) * cos))
    force, _, _ = BearingForce(bearing, law)([0.0, 4e-6, 0.0, 0.0, 0.0, 0.0])
    assert force[1] == pytest.approx(expected, rel=1e-13)  # round-off of the sums


def test_what_is_no_needle_bearing_is_refused() -> None:
    assert plain_name("NA4921A", ROLLERS) == ""
    with pytest.raises(InputError, match=r"got 'NA4999' \(did you mean 'NA4919'\?\); allowed: NA, RNA, NAV, RNAV"):
        designated("NA4999")
    with pytest.raises(InputError, match=r"takes needles of 2.008 mm in a width of 22 mm; .* C0 and not C"):
        needles.needle_estimate("NA4908", 10e3)
    with pytest.raises(InputError, match=r"basic_static_rating nan N; allowed: finite and > 0"):
        needles.needle_estimate("NA4908", math.nan)


def test_drawn_cups_have_needles_as_they_are_made():
    """By both ratings all are near half millimetres, by chance a fifth; what is left of the section is the cup."""
    names = [name for name in needles.needle_designations() if name.startswith("HK")]
    rows = table("needles")["drawn"]
    assert len(names) == len(rows) == 47
    for name, (within, width, outside, dynamic, static) in zip(names, rows, strict=True):
        found = needles.needle_estimate(name)
        diameter = needles.needle_diameter(1e-3 * within, (dynamic, static), needles.DRAWN_QUALITY)
        assert diameter == pytest.approx(found.roller_diameter, rel=0.05 if within < 8 else 0.03), name
        assert found.inner_raceway_diameter == pytest.approx(1e-3 * within)
        assert 0.4e-3 < 0.5 * (1e-3 * outside - found.outer_raceway_diameter) < 1.1e-3, name
        assert found.roller_length < 0.95e-3 * width and found.clearance_range.name == "F8/h5"
