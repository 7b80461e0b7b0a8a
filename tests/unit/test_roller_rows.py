"""Cylindrical roller bearings of two rows: against single ones at their places, and what catalogues tell of them."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from ehdmaps.errors import InputError
from ehdmaps.jobs.job_text import bearing_keys
from ehdmaps.jobs.reader import parse_job
from ehdmaps.physics.bearing import BearingGeometry
from ehdmaps.physics.catalogue import _doubles, designated, estimate
from ehdmaps.physics.designations.reader import table
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.rollers.ratings import cylindrical_ratings
from ehdmaps.physics.rollers.ribbed_geometry import mirrored_ribs, ribbed_estimate
from mbs.bearings import laws
from mbs.bearings.bearing import Bearing
from mbs.bearings.bearing_force import BearingForce
from mbs.bearings.roller_contacts import RollerContacts
from mbs.bearings.tapered.tapered_bearing import TaperedForce
from mbs.cli import main

NN = designated("NN3014").with_clearance(5e-6)
ONE = dataclasses.replace(NN, row_distance=None)
POSE = np.array([0.0, 12e-6, 3e-6, 0.0, 2e-4, -3e-4])
VELOCITY = np.array([0.0, 1e-4, 2e-4, 0.0, 1e-2, 2e-2])
AT = {"entrainment_speed": 3.0, "temperature": 313.15, "cage_angle": 0.1}


def film(bearing):
    return laws.formula(bearing, Lubricant.named("FVA3"))


def carried(place):
    """Pose of a ring at a place along the axis by that of the shaft."""
    found = np.eye(6)
    found[1, 5], found[2, 4] = place, -place
    return found


def both_alike(found, wanted):
    for ours, theirs in zip(found, wanted, strict=True):
        assert np.max(np.abs(ours - theirs)) <= 1e-12 * np.max(np.abs(theirs))


@pytest.mark.parametrize(
    ("law", "coupled"),
    [(lambda bearing: laws.hertz(bearing, damping_time=1e-5), True), (film, False)],
    ids=["dry, coupled slices", "films"],
)
def test_two_rows_are_two_bearings_at_their_places(law, coupled):
    """Force, K and C, the films of a step in time, and the small motions of films, to round-off."""
    pair, single = (Bearing(geometry, slices=6, coupled=coupled) for geometry in (NN, ONE))
    two, one = (BearingForce(bearing, law(bearing)) for bearing in (pair, single))
    wanted, stepped = [np.zeros(6), np.zeros((6, 6)), np.zeros((6, 6))], np.zeros(6)
    steps = not coupled and law is film
    for place in NN.row_places:
        moves = carried(place)
        answer = one.evaluate(moves @ POSE, moves @ VELOCITY, **AT)
        wanted[0] += moves.T @ answer.force
        wanted[1] += moves.T @ answer.stiffness @ moves
        wanted[2] += moves.T @ answer.damping @ moves
        if steps:
            _, state = one.advance(None, moves @ POSE, 1e-5, **AT)
            stepped += moves.T @ one.advance(state, 1.1 * moves @ POSE, 1e-5, **AT)[0].force
    found = two.evaluate(POSE, VELOCITY, **AT)
    both_alike((found.force, found.stiffness, found.damping), wanted)
    loads = two.rollers(POSE, **AT)
    assert loads.load.size == 2 * NN.rollers == NN.rolling_elements
    if steps:
        _, state = two.advance(None, POSE, 1e-5, **AT)
        both_alike([two.advance(state, 1.1 * POSE, 1e-5, **AT)[0].force], [stepped])


@pytest.mark.parametrize("way", [1.0, -1.0])
def test_two_rows_of_which_one_leans_on_ribs(way):
    """NNCF under axial load: an NCF at the rib of its outer ring and one without ribs (they stand 1 mm off), to the
    balance of rollers, 1e-10 of their forces; the same turned round, at speed."""
    geometry = ribbed_estimate("NNCF5010", 5e-6)
    geometry = geometry if way > 0.0 else mirrored_ribs(geometry)
    assert np.sign(geometry.row_places[0]) == way and geometry.rolling_elements == 2 * geometry.rollers
    ribs = dataclasses.replace(geometry, row_distance=None)
    forces = [TaperedForce(one, 1e2, 1e-5) for one in (ribs, dataclasses.replace(ribs, axial_clearance=4e-3))]
    two = TaperedForce(geometry, 1e2, 1e-5)
    pose = np.array([way * 2e-5, *POSE[1:]])
    wanted = [np.zeros(6), np.zeros((6, 6)), np.zeros((6, 6))]
    for place, one in zip(geometry.row_places, forces, strict=True):
        moves = carried(place)
        force, *matrices = one(moves @ pose, VELOCITY * 0.0, cage_angle=0.1, inner_speed=300.0)
        wanted[0] += moves.T @ force
        for n, more in enumerate(matrices, 1):
            wanted[n] += moves.T @ more @ moves
    found = two(pose, VELOCITY * 0.0, cage_angle=0.1, inner_speed=300.0)
    assert way * found[0][0] < -100.0
    for ours, theirs in zip(found, wanted, strict=True):
        assert np.max(np.abs(ours - theirs)) <= 1e-9 * np.max(np.abs(theirs))
    loads = two.loads(pose, cage_angle=0.1, inner_speed=300.0)
    assert loads.ribs[:, : geometry.rollers].max() > 10.0 and np.all(loads.ribs[:, geometry.rollers :] == 0.0)
    step, axes = 1e-9, np.eye(6)[[0, 1, 2, 4, 5]]
    for axis in axes:  # K against difference quotients, whose error is 1e-5 of the largest
        scale = 1.0 if axis[:3].any() else 30.0
        ahead, behind = (two(pose + s * step * scale * axis, cage_angle=0.1, inner_speed=300.0)[0] for s in (1.0, -1.0))
        quotient, column = (behind - ahead) / (2.0 * step * scale), found[1] @ axis
        assert np.max(np.abs(quotient - column)) <= 3e-5 * np.max(np.abs(found[1] @ axis))


def test_rollers_as_bodies_stand_in_both_rows():
    """Forces on both rings and on rollers, K and C, against bearings of one row, to round-off: the place of a roller is
    counted from the mean of both rings there."""
    pair, single = (Bearing(geometry, slices=6) for geometry in (NN, ONE))
    law = laws.hertz(pair, damping_time=1e-5).single()
    two, one = (RollerContacts(bearing, law, law) for bearing in (pair, single))
    places = 6e-6 + 1e-6 * np.sin(np.arange(NN.rolling_elements))
    q = np.concatenate([POSE, [0.0, -2e-6, 1e-6, 0.0, -1e-4, 2e-4], places])
    v, count, angle = 1e2 * q, NN.rollers, 0.1 + single.roller_angles
    found = two(q, v, cage_angle=0.1)
    wanted = [np.zeros(q.size), np.zeros((q.size, q.size)), np.zeros((q.size, q.size))]
    for row, place in enumerate(NN.row_places):
        moves = np.zeros((12 + count, q.size))
        moves[:6, :6] = moves[6:12, 6:12] = carried(place)
        own = 12 + np.arange(count)
        moves[own, own + row * count] = 1.0
        for ring in (0, 6):
            moves[own, ring + 4], moves[own, ring + 5] = -0.5 * place * np.sin(angle), 0.5 * place * np.cos(angle)
        force, *matrices = one(moves @ q, moves @ v, cage_angle=0.1)
        wanted[0] += moves.T @ force
        for n, more in enumerate(matrices, 1):
            wanted[n] += moves.T @ more @ moves
    both_alike(found, wanted)


def test_the_catalogue_has_rollers_as_they_are_made():
    """Both ratings of NN and NNU agree on rollers of whole or half millimetres within 1.5 % of C; NNCF has NCF's."""
    ratios = []
    for name in _doubles():
        found = estimate(name)
        apart, length = found.row_distance, found.roller_length
        assert apart > length and 2.0 * apart + length < 3.0 * found.pitch_diameter  # rows have room beside each other
        dynamic, static = cylindrical_ratings(found)
        if name.startswith("NNCF"):
            single = estimate(name[1:].replace("NCF50", "NCF30"))
            assert (found.rollers, found.roller_diameter) == (single.rollers, single.roller_diameter)
            assert static == pytest.approx(2.0 * cylindrical_ratings(single)[1])
            continue
        rows = table("cylindrical")["double"][name[:-2]]
        (row,) = (one for one in rows if one[0] == 5 * int(name[-2:]))
        assert static == pytest.approx(row[5], rel=1e-9)
        assert 2e3 * found.roller_diameter == pytest.approx(round(2e3 * found.roller_diameter), abs=1e-9)
        ratios.append(dynamic / row[4])
    assert len(ratios) == 39 and np.max(np.abs(np.array(ratios) - 1.0)) < 0.015


def test_the_page_has_its_rows(capsys):
    assert main(["bearing", "NN3014", "--load", "5 kN", "--speed", "1000 rpm", "--law", "hertz"]) == 0
    out = capsys.readouterr().out
    assert "50 rollers in 2 rows, 12.67 mm apart" in out and "of 50 rollers carry" in out
    assert main(["bearing", "NN3014", "--load", "5 kN", "--axial", "1 kN", "--speed", "1000 rpm"]) == 2
    assert "N, NU, NN and NNU have ribs on one ring only" in capsys.readouterr().err
    ask = ["bearing", "NNCF5010", "--load", "5 kN", "--axial", "1 kN", "--speed", "1000 rpm", "--law", "hertz"]
    assert main(ask) == 0
    out = capsys.readouterr().out
    assert "44 rollers of 9 x" in out and "2 rows at 8.852 and -8.852 mm, ribs in the first" in out


def test_its_keys_come_back():
    geometry = BearingGeometry("by hand", 80e-3, 100e-3, 10e-3, 9e-3, 24, 1e-5, row_distance=13e-3)
    keys = "\n".join(
        f"{key} = {value!r}" if isinstance(value, int) else f'{key} = "{value}"'
        for key, value in bearing_keys(geometry).items()
    )
    found = parse_job(f"[bearing]\n{keys}\n", "job", "job.toml").bearing
    assert found.row_places == (-6.5e-3, 6.5e-3) and found.row_words == " in 2 rows, 13 mm apart"
    assert dataclasses.replace(found, name="by hand") == geometry
    assert bearing_keys(estimate("NN3014")) == {"estimate": "NN3014"}


@pytest.mark.parametrize("apart", [7e-3, float("inf"), -1.0])
def test_rows_that_overlap_are_refused(apart):
    with pytest.raises(InputError, match=r"row_distance: got .*; allowed: finite, and more than the roller_length"):
        dataclasses.replace(NN, row_distance=apart)


@pytest.mark.parametrize(
    ("typed", "name", "told"),
    [
        ("NN 3014 KTN/SPW33", "NN3014", "K: tapered bore"),
        ("NN3014-AS-K-M-SP", "NN3014", "AS: groove and holes"),
        ("NN3014MBKRE44CC1P4", "NN3014 CC1", "MB: cage"),
        ("NNU 4920 B/SPW33", "NNU4920", "SP: class of accuracy"),
        ("NNCF 5010 CV", "NNCF5010", ""),
    ],
)
def test_names_of_makers(typed, name, told):
    from ehdmaps.physics.designations.reader import read_designation

    found = read_designation(typed)
    assert found.text == name and told in found.words
    if name.endswith("CC1"):  # a class of the maker's own changes forces: it is never dropped
        with pytest.raises(InputError, match="got 'NN3014MBKRE44CC1P4'; allowed: one of the classes C2"):
            designated(typed)
    else:
        assert designated(typed).name == name
