"""Plans of contact maps: ranges, the job that covers them, what is refused."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from ehdmaps.errors import AnalysisError, InputError
from ehdmaps.jobs.reader import parse_job
from mbs.model.elements import Load
from mbs.model.profiles import Course, Harmonic
from mbs.planning.plan import (
    LIGHT,
    LIGHTEST,
    film_room,
    largest_loads,
    needed_ranges,
    outward,
    plan,
    planned_job,
    same_contacts,
    speed_range,
)
from mbs.scene.assembly import assemble
from mbs.scene.reader import parse_scene, read_scene
from tests.cases import commands

TEXT = read_scene("nu308_rigid").text
RPM = math.pi / 30.0
BY_HAND = (
    '{ inner_raceway_diameter = "52 mm", outer_raceway_diameter = "80 mm", roller_diameter = "14 mm", '
    'roller_length = "%s", rollers = 11, diametral_clearance = "10 um" }'
)
NAMED = '{ name = "NU308", diametral_clearance = "0 um" }'


def scene(*changes):
    """The shipped scene with some of its text exchanged, each at its last place."""
    text = TEXT
    for old, new in changes:
        assert old in text
        text = new.join(text.rsplit(old, 1))
    return parse_scene(text, "changed", "changed.toml")


def straight():
    """Without clearance and profile: loads are in proportion to the load on the bearing."""
    return parse_scene(TEXT.replace('profile = "iso"', 'profile = "straight"'), "straight", "straight.toml")


def loads_of(given):
    model = assemble(given, "hertz")
    return largest_loads(model.system, model.bearings, given.speed)


@pytest.fixture
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


def run(capsys, *arguments):
    return commands.run(capsys, "plan", *map(str, arguments))


def test_speeds_go_down_to_a_part_of_the_highest_where_rest_is_passed():
    assert speed_range([3.0, 0.0, -7.0]) == (3.0, 7.0)
    assert speed_range([1.0], [-20.0, 20.0]) == (1.0, 20.0)
    assert speed_range([5.0], [-20.0, 20.0]) == (1.0, 20.0)
    assert speed_range([5.0], [-20.0, -10.0]) == (5.0, 20.0)
    with pytest.raises(AnalysisError, match=r"nothing turns .* analyse it with --law hertz"):
        speed_range([0.0], [0.0, 0.0])


@given(st.floats(1e-6, 1e9), st.floats(1.0, 1e6))
def test_ends_are_rounded_outward_to_two_digits(low, ratio):
    high = low * ratio
    down, up = outward(low, high)
    assert down <= low
    assert up >= high
    # two digits: at most a tenth away, and nothing is lost when they are printed
    assert down > low / 1.1001
    assert up < high * 1.1001
    assert (float(f"{down:.2g}"), float(f"{up:.2g}")) == (down, up)


def test_largest_load_of_a_bearing_is_the_textbook_one():
    # Q_max = 4.08 F/Z for line contacts without clearance (Stribeck's number, in Harris, Rolling Bearing Analysis; from
    # memory, and summed below for Q ~ cos^(10/9)), F = 100 sqrt(2) N, Z = 12, L = 15 mm.
    wanted = 4.08 * 100.0 * math.sqrt(2.0) / 12 / 15e-3
    angles = 2.0 * np.pi * np.arange(12) / 12
    summed = 1.0 / np.sum(np.maximum(np.cos(angles), 1e-300) ** (10.0 / 9.0) * np.cos(angles))
    # three digits, and 12 rollers in place of an integral
    assert 12.0 * summed == pytest.approx(4.08, rel=0.01)
    # one of the 12 angles has a roller on the load
    exact = 100.0 * math.sqrt(2.0) * summed / 15e-3
    assert loads_of(straight()) == pytest.approx((exact, exact), rel=1e-6)
    assert exact == pytest.approx(wanted, rel=0.01)


def test_largest_load_is_over_a_pitch_and_not_at_the_first_angle():
    still = straight()
    model = assemble(still, "hertz")
    balance_free = still.with_bearings(dataclasses.replace(entry, start_angle=0.3) for entry in still.bearings)
    # 12 angles over a pitch lie 2.5 deg apart: next to a peak that is 1e-3 of the load at most
    assert loads_of(balance_free) == pytest.approx(loads_of(still), rel=2e-3)
    assert model.bearings[0].rates[0] > 0.0


@pytest.mark.parametrize(
    "profile",
    [
        Harmonic(50.0, 0.0),
        Harmonic(50.0, 1.234),
        Course((0.0, 1.0, 2.0), (0.0, 1.0, 0.0)),
        Course((0.0, 1.0), (0.0, 1.0)),
    ],
    ids=["sine", "phase", "pulse", "ramp"],
)
def test_loads_that_vary_count_with_their_extremes(profile):
    still = straight()
    more = tuple(
        Load(f"more_{load.name}", load.on, load.force, load.against, profile)  # as much again at its largest
        for load in still.loads
    )
    both = dataclasses.replace(still, loads=(*still.loads, *more))
    # loads scale exactly: round-off and the tolerance of the equilibrium, 1e-10 of the force
    assert loads_of(both) == pytest.approx(2.0 * np.array(loads_of(still)), rel=1e-8)


@pytest.mark.parametrize("clearance", [0.0, 20e-6])
def test_films_in_the_clearance_are_in_the_plan(clearance):
    # The plan takes the films of Moes' formula out of the clearance of dry bearings; here they act in the law.
    given = read_scene("nu308_rigid")
    highest = 2000.0 * RPM
    dry = assemble(given, "hertz", clearance=clearance)
    loads = largest_loads(dry.system, dry.bearings, highest)
    geometry = given.bearings[0].geometry
    room = film_room(geometry, given.lubricant, max(loads), geometry.entrainment_speed(highest), given.temperature)
    planned = assemble(given, "hertz", clearance=clearance - room)
    lubricated = assemble(given, "formula", clearance=clearance)
    found = max(max(largest_loads(lubricated.system, lubricated.bearings, part * highest)) for part in (0.05, 1.0))
    reached = max(*loads, *largest_loads(planned.system, planned.bearings, highest))
    # Films of lightly loaded contacts are thicker than that of the largest load, and spread the load over more rollers:
    # the plan is above, by less than a third, and the margin is for what moves.
    assert 0.7 * reached < found < 1.02 * reached
    if clearance == 0.0:
        assert found > 1.2 * max(loads)  # dry contacts alone would be a plan that is too small


def test_ranges_follow_from_loads_speeds_and_margin():
    model = assemble(read_scene("nu308_rigid"), "hertz")
    (needed,) = needed_ranges(model.bearings, (3e4, 2e4), (1e-6, 2e-6), (10.0, 100.0), margin=2.0)
    assert needed.bearings == ("bearing_left", "bearing_right")
    assert needed.load == (LIGHTEST * 6e4, 6e4)
    geometry = needed.geometry
    assert needed.entrainment_speed == pytest.approx(
        (geometry.entrainment_speed(10.0), geometry.entrainment_speed(100.0)), rel=1e-12
    )
    assert (needed.static_load, needed.film_room, needed.temperature) == (3e4, 2e-6, 313.15)
    (heavy,) = needed_ranges(model.bearings, (3e6, 0.0), (0.0, 0.0), (10.0, 100.0))
    assert heavy.load == (LIGHT, 9e6)
    with pytest.raises(AnalysisError, match=r"bearing_left, bearing_right carry no load in any equilibrium"):
        needed_ranges(model.bearings, (0.0, 0.0), (0.0, 0.0), (10.0, 100.0))
    standing = [dataclasses.replace(entry, inner_spin=0.0) for entry in model.bearings]
    with pytest.raises(AnalysisError, match=r"bearing_left, bearing_right do not roll"):
        needed_ranges(standing, (1.0, 1.0), (0.0, 0.0), (10.0, 100.0))
    for margin in (0.99, math.nan, math.inf):
        with pytest.raises(InputError, match=r"margin: got .*; allowed: 1 to 1000"):
            needed_ranges(model.bearings, (1.0, 1.0), (0.0, 0.0), (10.0, 100.0), margin=margin)


def test_bearings_share_a_map_where_their_contacts_are_alike():
    alike = scene((NAMED, BY_HAND % "15 mm"))
    other = scene((NAMED, BY_HAND % "16 mm"))
    keys = [[same_contacts(entry.geometry) for entry in given.bearings] for given in (alike, other)]
    assert keys[0][0] == keys[0][1]
    assert keys[1][0] != keys[1][1]
    model = assemble(other, "hertz")
    first, second = needed_ranges(model.bearings, (1e4, 2e4), (0.0, 0.0), (10.0, 100.0))
    assert (first.bearings, second.bearings) == (("bearing_left",), ("bearing_right",))
    assert (first.load[1], second.load[1]) == (3e4, 6e4)


def test_job_reads_back_and_covers_what_is_needed():
    given = dataclasses.replace(scene((NAMED, BY_HAND % "16 mm")), name='a\n[bearing]\nname = "N1014"')
    model = assemble(given, "hertz")
    for needed in needed_ranges(model.bearings, (12345.6, 23456.7), (0.0, 0.0), (10.3, 103.7)):
        job = planned_job(given, needed)
        assert same_contacts(job.bearing) == same_contacts(needed.geometry)
        assert job.lubricant == given.lubricant
        assert job.temperatures == (given.temperature,)
        for axis, (low, high) in ((job.loads, needed.load), (job.entrainment_speeds, needed.entrainment_speed)):
            assert axis[0] <= low <= axis[0] * 1.1001
            assert axis[-1] / 1.1001 <= high <= axis[-1]
    exact = dataclasses.replace(needed, entrainment_speed=(0.5, 0.5))
    assert planned_job(given, exact).entrainment_speeds == (0.5,)


def test_a_job_keeps_an_estimated_bearing_and_its_label():
    sizes = '{ bore = "40 mm", outside_diameter = "90 mm", width = "23 mm" }'
    geometry = f'{{ estimate = {sizes}, basic_static_rating = "78 kN", label = "A \\"1\\"" }}'
    given = scene((NAMED, geometry))
    bearings = assemble(given, "hertz").bearings
    needed = next(
        entry for entry in needed_ranges(bearings, (1e4, 2e4), (0.0, 0.0), (10.0, 100.0)) if entry.geometry.estimated
    )
    job = planned_job(given, needed)
    assert job.bearing == needed.geometry
    assert job.bearing.label == 'A "1"'


def test_command_writes_a_job_for_each_geometry(here, capsys):
    text = scene((NAMED, BY_HAND % "16 mm")).text
    (here / "two.toml").write_text(text)
    status, out, err = run(capsys, "two.toml", "-o", "job.toml")
    assert (status, err) == (0, "")
    assert sorted(path.name for path in here.iterdir()) == [
        "job_bearing_left.toml",
        "job_bearing_right.toml",
        "two.toml",
    ]
    assert out.count("read from the film table") == 2
    for side in ("left", "right"):
        name = f"job_bearing_{side}.toml"
        assert f"{name}: written" in out
        parse_job((here / name).read_text(), name, name)


def test_command_without_output_writes_nothing(here, capsys):
    status, out, _ = run(capsys, "nu308_rigid", "--clearance", "20 um", "--margin", "2")
    assert status == 0
    assert "clearance 20 um" in out
    assert "times 2 for what moves" in out
    assert "nothing written" in out
    assert list(here.iterdir()) == []


def test_centrifugal_load_is_added(here, capsys):
    (here / "heavy.toml").write_text(TEXT.replace("slices = 41", "centrifugal = true\nslices = 41"))
    texts = []
    for name in ("nu308_rigid", "heavy.toml"):
        status, out, _ = run(capsys, name)
        assert status == 0
        texts.append(float(out.partition("largest load of a slice at rest ")[2].split()[0]))
    # 0.2715 N/mm at 2000 rpm, see Bearing.centrifugal_load; printed with four digits
    assert texts[1] - texts[0] == pytest.approx(0.2715, abs=0.011)


def test_rollers_as_bodies_are_planned_too(here, capsys):
    status, out, _ = run(capsys, "n1014_rigid")
    assert status == 0
    assert "read from the film table" in out


def test_everything_wrong_is_said_at_once_and_nothing_written(here, capsys):
    without = TEXT.replace(
        "[lubricant]                             # for --law formula; a map brings its own oil\n", ""
    )
    without = without.replace('name = "FVA3"', "# none")
    (here / "dry.toml").write_text(without)
    status, out, err = run(capsys, "dry.toml", "--clearance", "1 m", "--margin", "0.5", "-o", "dry.toml")
    assert (status, out) == (2, "")
    for words in (
        "--clearance: got '1 m'",
        "--margin: got '0.5'",
        "written over dry.toml",
    ):
        assert words in err
    assert (here / "dry.toml").read_text() == without
    status, _, err = run(capsys, "dry.toml")
    assert status == 2
    assert "dry: got no [lubricant], which a map is made for; add the table to the scene" in err
    status, _, err = run(capsys, "nu308_rigid", "-o", "job.nc")
    assert status == 2
    assert "-o: got job.nc; allowed: a file that ends in .toml" in err
    status, _, err = run(capsys, "nu308_rigid", "-o", "job.toml", "--clearance", "-5 mm")
    assert status == 2
    assert "allowed: 0.001 N/mm to 10000 N/mm" in err
    assert [path.name for path in here.iterdir()] == ["dry.toml"]


@pytest.mark.parametrize("margin", ["nan", "inf", "-1", "0", "1e9", "three"])
def test_margins_that_are_refused(here, capsys, margin):
    status, out, err = run(capsys, "nu308_rigid", f"--margin={margin}")
    assert (status, out) == (2, "")
    assert "allowed: a number from 1 to 1000" in err


def test_jobs_must_not_be_written_over_the_scene(here, capsys):
    text = scene((NAMED, BY_HAND % "16 mm")).text
    (here / "job_bearing_left.toml").write_text(text)
    status, _, err = run(capsys, "job_bearing_left.toml", "-o", "job.toml")
    assert status == 2
    assert "written over job_bearing_left.toml" in err
    assert (here / "job_bearing_left.toml").read_text() == text


def test_scenes_that_need_no_map(here, capsys):
    still = TEXT.replace('speed = "500 rpm"', 'speed = "0 rpm"').partition("[runup]")[0]
    (here / "still.toml").write_text(still)
    status, out, err = run(capsys, "still.toml")
    assert (status, out) == (1, "")
    assert "nothing turns" in err
    unloaded = TEXT.replace('force = ["0 N", "100 N", "100 N"]', 'force = ["0 N", "0 N", "0 N"]')
    (here / "unloaded.toml").write_text(unloaded)
    status, out, err = run(capsys, "unloaded.toml", "--clearance", "1 mm")
    assert (status, out) == (1, "")
    assert "carry no load" in err
    (here / "fast.toml").write_text(TEXT.replace('to = "2000 rpm"', 'to = "900000 rpm"'))
    status, out, err = run(capsys, "fast.toml")
    assert (status, out) == (2, "")
    assert "allowed: up to 200 m/s" in err
    bare = TEXT.partition("[[bearings]]")[0] + "[linear]" + TEXT.partition("[linear]")[2]
    (here / "bare.toml").write_text(bare)
    status, out, err = run(capsys, "bare.toml")
    assert (status, out) == (2, "")
    assert "bare: got no bearing; allowed: at least one [[bearings]]" in err


def test_an_unbalance_is_planned_for_with_its_force_on_a_stiff_rotor():
    """Beside the same force as a load that stands still, along the load, where it is largest."""
    before, speed = plan(parse_scene(TEXT, "own", "own")).needed[0].static_load, 500.0
    moment = 50.0 * math.sqrt(2.0) / speed**2
    unbalance = f'\n[[unbalances]]\nname = "u"\non = "shaft:left"\nmoment = "{moment!r} kg m"\nangle = "45 deg"\n'
    load = '\n[[loads]]\nname = "more"\non = "shaft:left"\nforce = ["0 N", "50 N", "50 N"]\n'
    turning, standing = (assemble(parse_scene(TEXT + words, "own", "own"), "hertz") for words in (unbalance, load))
    found = largest_loads(turning.system, turning.bearings, speed)
    # 1e-7: the equilibria begin elsewhere; the first of the angles is that of the load.
    assert max(found) == pytest.approx(max(largest_loads(standing.system, standing.bearings, speed)), rel=1e-7)
    assert max(found) > max(largest_loads(turning.system, turning.bearings, speed, turning=False))
    assert plan(turning.scene).needed[0].static_load > before
