"""Laws of maps with holes: where they are known, that they read nothing else, and what happens beyond."""

from __future__ import annotations

import numpy as np
import pytest

from ehdmaps.errors import MapError, OutsideMapError
from ehdmaps.exports.csv import Chosen, table
from ehdmaps.exports.map_curves import film_between
from ehdmaps.exports.resampled import Grid, Resampled, differences, resampled
from ehdmaps.jobs import cli
from ehdmaps.jobs.make.report import reach_lines
from ehdmaps.maps.edges.reach import known_runs, reach_of
from ehdmaps.maps.emap import EHDMap
from ehdmaps.maps.law import ContactLaw
from ehdmaps.maps.records import DERIVED
from ehdmaps.physics.oil_supply import OilSupply
from ehdmaps.physics.surface import Surface
from ehdmaps.units import LOAD, RPM
from tests.cases import commands
from tests.cases.jobs import map_job
from tests.cases.laws import LOADS, dataset_of, dry_dataset, with_holes

FAST, COLD = 3, 0
"""Places of the highest speed, 2.4 m/s, and the lowest temperature, 40 degC."""

LOST = 13
"""First load that is lost there: 147 N/mm, the one before is 100 N/mm."""


@pytest.fixture(scope="module")
def whole():
    return EHDMap(dataset_of())


@pytest.fixture(scope="module")
def corner(whole):
    """A map without the heaviest loads at the highest speed and the lowest temperature, of the inner contact."""
    return EHDMap(with_holes(whole.dataset, (0, slice(LOST, None), FAST, COLD)))


def test_the_longer_part_of_a_line_is_kept():
    line = np.array([1, 1, 0, 1, 1, 1, 0, 1, 1, 1], bool)
    kept = known_runs(line[None, :, None, None])[0, :, 0, 0]
    assert kept.tolist() == [False] * 3 + [True] * 3 + [False] * 4  # of equal ones that of lower loads


def test_reach_in_words(corner, whole):
    assert whole.reach().text == "1 to 1000 N/mm, 0.3 to 2.4 m/s, 40 to 70 degC"
    assert whole.reach().whole and not corner.reach(("inner",)).whole and corner.reach(("outer",)).whole
    text = "1 to 1000 N/mm, 0.3 to 2.4 m/s, 40 to 70 degC; up to 100 N/mm at 2.4 m/s and 40 degC"
    assert corner.reach().text == corner.reach(("inner",)).text == text
    assert list(reach_lines(corner)) == [
        "contact laws",
        "  series, inner        1 to 1000 N/mm, 0.3 to 2.4 m/s, 40 to 70 degC",
        "                       up to 100 N/mm at 2.4 m/s and 40 degC",
        "  outer                1 to 1000 N/mm, 0.3 to 2.4 m/s, 40 to 70 degC",
    ]


def test_a_speed_without_two_loads_is_left_out(whole):
    """With its neighbours known, what lies between them is read from these."""
    lost = EHDMap(with_holes(whole.dataset, (0, slice(1, None), 0, 2)))
    assert lost.reach().text == "1 to 1000 N/mm, 0.6 to 2.4 m/s, 40 to 70 degC; without 0.3 m/s"
    assert lost.law("inner").speed_range == (0.6, 2.4)
    assert lost.law("outer").speed_range == (0.3, 2.4)


def test_lines_that_share_no_loads_are_not_kept_together():
    runs = np.ones((1, 6, 3, 1), bool)
    runs[0, 3:, 0] = runs[0, :3, 1] = False
    reach = reach_of(runs, (2.0 ** np.arange(6.0), np.array([1.0, 2.0, 3.0]), np.array([300.0])))
    assert reach.speeds.tolist() == [2.0, 3.0]
    assert (reach.first[:, 0].tolist(), reach.last[:, 0].tolist()) == ([8.0, 1.0], [32.0, 32.0])


def test_no_law_can_be_made_where_nothing_is_known(whole):
    lost = EHDMap(with_holes(whole.dataset, (0, slice(1, None)), (1, slice(1, None), 0)))
    told = r"law of inner, outer: no two loads are known at any speed and temperature; the map has .* holes, inner at"
    with pytest.raises(MapError, match=told):
        lost.law("series")
    assert lost.law("outer").speed_range == (0.6, 2.4)
    lines = list(reach_lines(lost))
    assert lines[1].startswith("  series               none: law of inner, outer: no two loads")
    assert lines[-1] == "                       without 0.3 m/s"


def test_a_dry_map_needs_no_films():
    assert EHDMap(dry_dataset()).reach().whole


WITHIN = {"load": slice(4, LOST), "entrainment_speed": slice(1, None), "temperature": slice(None, 3)}
"""Places of a map that is known away from the edges of each axis."""


@pytest.mark.parametrize(
    ("kind", "outside", "more", "cut"),
    [
        ("series", "asymptote", {}, WITHIN),
        ("inner", "clamp", {"supply": OilSupply(2e-6)}, {"load": slice(None, LOST)}),
        ("inner", "clamp", {"surface": Surface(roughness=3e-7)}, {"load": slice(None, LOST)}),
    ],
    ids=["all axes", "on a layer", "rough"],
)
def test_a_law_is_that_of_a_map_whose_axes_end_at_the_reach(whole, kind, outside, more, cut):
    """Within the reach and beyond it, to the round-off of splines over another number of nodes."""
    ended = whole.dataset.isel(cut)
    lost = np.zeros(whole.dataset["status"].shape, bool)
    for place, name in enumerate(("contact", "load", "entrainment_speed", "temperature")):
        if name in cut:
            shape = [-1 if one == place else 1 for one in range(4)]
            lost |= ~np.isin(whole.dataset[name].values, ended[name].values).reshape(shape)
    holey = with_holes(whole.dataset, lost)
    laws = [EHDMap(one).law(kind, outside, **more) for one in (holey, ended.drop_vars(list(DERIVED), errors="ignore"))]
    assert (laws[0].load_range, laws[0].speed_range) == (laws[1].load_range, laws[1].speed_range)
    random = np.random.default_rng(5)
    at = random.uniform(-5e-7, 2e-5, 300), 0.0, random.uniform(0.0, 4.0, 300), random.uniform(300.0, 360.0, 300)
    for found, wanted in zip(*(law(*at) for law in laws), strict=True):
        assert found == pytest.approx(wanted, rel=1e-9, abs=1e-12 * np.max(np.abs(wanted)))
    assert laws[0].outside_counts == laws[1].outside_counts


def test_away_from_its_holes_a_law_gives_the_map_back(corner):
    """Also next to them; tolerances as for a whole map."""
    data, law = EHDMap(dataset_of()).dataset.sel(contact="inner"), corner.law("inner")
    for i, j, k in ((LOST - 1, FAST, COLD), (18, FAST - 1, COLD), (18, FAST, COLD + 1), (5, FAST, COLD), (18, 0, 3)):
        point = data.isel(load=i, entrainment_speed=j, temperature=k)
        at = float(point["approach"]), 0.0, float(point["entrainment_speed"]), float(point["temperature"])
        w, stiffness, damping = law(*at)
        assert w == pytest.approx(float(point["load"]), rel=3e-4)
        assert stiffness == pytest.approx(float(point["stiffness"]), rel=1e-3)
        assert damping == pytest.approx(float(point["damping"]), rel=1e-2)


def test_loads_end_between_points_as_films_do(corner):
    """In ln of load and speed and in temperature straight."""
    law, kelvins, speeds = corner.law("series"), corner.axis("temperature"), corner.axis("entrainment_speed")
    ends = {(FAST, COLD): 1e5, (FAST - 1, COLD): 1e6, (FAST, COLD + 1): 1e6, (0, 3): 1e6}
    for (j, k), end in ends.items():
        known = law.known_load(float(speeds[j]), float(kelvins[k]))
        assert known == pytest.approx(end, rel=1e-14)
    half = float(np.sqrt(speeds[FAST] * speeds[FAST - 1]))
    assert law.known_load(-half, float(kelvins[COLD])) == pytest.approx(np.sqrt(1e5 * 1e6), rel=1e-14)
    assert law.known_load(99.0, 0.0) == law.known_load(float(speeds[FAST]), float(kelvins[COLD]))
    assert law.load_range == (1e3, 1e6)


def approach_at(law: ContactLaw, load: float, speed: float, temperature: float) -> float:
    """Approach at a load, by the table of the law."""
    return law.at(speed, temperature).approach(load)


def test_a_load_is_refused_only_where_it_is_not_known(corner):
    law = corner.law("series")
    u, T = (float(corner.axis(name)[at]) for name, at in (("entrainment_speed", FAST), ("temperature", COLD)))
    slow = u / 2.0
    assert law(approach_at(law, 5e5, slow, T), 0.0, slow, T)[0] == pytest.approx(5e5, rel=1e-6)
    end = law.known_load(u, T)
    told = rf"contact law 'series', load: got about 200000 N/m above the map, which ends at {end:.6g} N/m, at the app"
    point = law.at(u, T).point
    high = point.held_approach + (2e5 - point.held_load) / point.held_stiffness
    with pytest.raises(OutsideMapError, match=told):
        law.at(u, T)(high, 0.0)
    deltas = np.array([approach_at(law, 5e5, slow, T), high])
    with pytest.raises(OutsideMapError, match=told):
        law(deltas, 0.0, np.array([slow, u]), T)
    assert law.outside_counts == {"load": 2, "entrainment_speed": 0, "temperature": 0}
    (one,) = law.excursions
    assert (one.axis, one.side, one.calls, one.limit) == ("load", "above", 2, end)
    assert one.extreme == pytest.approx(2e5, rel=1e-3)


@pytest.mark.parametrize("outside", ["clamp", "asymptote"])
def test_blocks_and_points_agree_on_both_sides_of_the_end(corner, outside):
    law = corner.law("series", outside)
    random = np.random.default_rng(2)
    u, T = np.exp(random.uniform(np.log(1.2), np.log(3.0), 200)), random.uniform(310.0, 325.0, 200)
    delta = random.uniform(1e-6, 3e-5, 200)
    block = np.array(law(delta, 1e-4, u, T))
    counts = law.counts.copy()
    assert 20 < counts[0] < 180
    each = np.array([law.at(*at)(d, 1e-4) for at, d in zip(zip(u, T, strict=True), delta, strict=True)]).T
    assert block == pytest.approx(each, rel=1e-11)
    law.reset_counts()
    one = [law(d, 1e-4, v, t) for d, v, t in zip(delta, u, T, strict=True)]
    assert pytest.approx(block, rel=1e-11) == np.array(one).T
    assert law.counts.tolist() == counts.tolist()


def test_above_its_end_a_clamped_law_is_the_dry_tangent_and_is_continuous(corner):
    law, T = corner.law("series", "clamp"), 313.15
    u = 2.4
    end = law.known_load(u, T)
    compliance = sum(contact.structural_compliance(end) for contact in law.contacts)
    begin = approach_at(law, end, u, T)
    w, stiffness, damping = law(begin + 1e-6, 0.0, u, T)
    assert stiffness == pytest.approx(1.0 / compliance, rel=1e-9)
    assert w == pytest.approx(end + 1e-6 / compliance, rel=1e-9)
    assert damping == pytest.approx(law(begin * (1.0 - 1e-9), 0.0, u, T)[2], rel=1e-4)
    speeds = np.linspace(1.2, 2.4, 4001)  # over the edge of what is known, at one approach
    loads = law(begin, 0.0, speeds, T)[0]
    assert np.max(np.abs(np.diff(loads))) < 5.0 * np.ptp(loads) / speeds.size


def test_a_centrifugal_load_ends_where_the_loads_do(corner):
    """The outer contact carries more than the inner one: what is known of it ends the load of that."""
    law = corner.law("series", "clamp")
    end = law.known_load(2.4, 313.15)
    point = law.at(2.4, 313.15, 0.25 * end).point
    assert (point.highest_load, point.held_load) == pytest.approx((0.75 * end, 0.75 * end), rel=1e-12)
    law.reset_counts()
    law.at(2.4, 313.15, 1.5 * end)
    assert law.outside_counts["load"] == 1
    with pytest.raises(OutsideMapError, match=rf"more than is mapped in the outer contact, .* ends at {end:.6g} N/m"):
        corner.law("series").at(2.4, 313.15, 1.5 * end)


def test_a_table_of_curves_ends_with_the_loads(corner):
    rows = [
        line.split(",") for line in table(corner, Chosen("inner", (1.2, 2.4), (313.15,), 5), "map.nc").splitlines()[2:]
    ]
    assert [float(row[2]) for row in rows[4::5]] == pytest.approx([1e6, 1e5], rel=1e-9)
    assert not any("nan" in row for row in rows)


def test_films_of_points_are_not_known_beyond_them(corner, whole):
    loads = np.array([LOADS[LOST - 1], LOADS[LOST]])
    found, wanted = (film_between(emap, "central_film", "inner", loads, 2.4, 313.15) for emap in (corner, whole))
    assert found[0] == pytest.approx(wanted[0], rel=1e-12) and np.isnan(found[1])
    assert film_between(corner, "central_film", "inner", loads, 1.2, 313.15) == pytest.approx(
        film_between(whole, "central_film", "inner", loads, 1.2, 313.15), rel=1e-12
    )


def test_a_bearing_is_refused_nothing_that_it_does_not_read(corner, tmp_path, monkeypatch, capsys):
    """The same load at half the speed is within the map; at the full one the law is held, and says where it ends."""
    monkeypatch.chdir(tmp_path)
    corner.dataset.to_netcdf("map.nc")
    outputs = []
    for speed, wanted in (("700 rpm", 0), ("1450 rpm", 1)):
        asked = ("NU308", "--map", "map.nc", "--load", "5 kN", "--speed", speed, "--temperature", "40 degC")
        status, out, err = commands.run(capsys, "bearing", *asked)
        assert status == wanted, err
        outputs.append(out)
    assert "outside the map" not in outputs[0]
    u = corner.bearing.entrainment_speed(1450.0 / RPM.factor, 0.0)
    end = LOAD.text(corner.law("series").known_load(u, 313.15))
    assert f"is outside the map (1 to {end}), where the law is held at its edge" in outputs[1]


def test_a_resampled_law_ends_where_the_loads_do(corner):
    """Where nothing is known it has no number; elsewhere it is as close to the law as it says."""
    law = corner.law("inner")
    grid = resampled(law, Grid.of(40), Resampled)
    read = grid.at(np.array([2e-5, 2e-5]), np.array([2.4, 1.2]), np.array([313.15, 340.0]))
    assert np.isnan(read[0, 0]) and read[0, 1] == pytest.approx(law(2e-5, 0.0, 1.2, 340.0)[0], rel=0.02)
    assert all(np.all(np.isfinite(values)) for values in differences(grid, law).values())


def test_below_missing_light_loads_the_film_is_a_guess(whole):
    """The tail begins where points are known; loads below are within the law, and are told."""
    lost = EHDMap(with_holes(whole.dataset, (0, slice(None, 6), 0, 0)))
    law, u, T = lost.law("series"), 0.3, 313.15
    assert lost.reach().text.endswith("; from 10 N/mm at 0.3 m/s and 40 degC")
    assert lost.low_loads.begins == law.low_loads.begins == pytest.approx((1e3, 1e4), rel=1e-12)
    assert law.guessed_below(u, T) == pytest.approx(1e4, rel=1e-12)
    for load, told in ((2e4, 0), (5e3, 1)):
        law.reset_counts()
        assert law(approach_at(law, load, u, T), 0.0, u, T)[0] == pytest.approx(load, rel=1e-3)
        assert [(one.side, one.limit) for one in law.excursions] == [("below", law.guessed_below(u, T))] * told


def test_a_map_of_a_standstill_alone_is_known(tmp_path, capsys):
    """It is made, shown and read; its contacts are dry."""
    grid = ('["1 N/mm", "9 N/mm", "300 N/mm"]', '["0 m/s"]', '["40 degC"]')
    (tmp_path / "job.toml").write_text(map_job(*grid, solver="hertz"))
    path = str(tmp_path / "still.nc")
    assert cli.main(["generate", str(tmp_path / "job.toml"), "-o", path, "--workers", "1"]) == 0
    assert "series, inner, outer 1 to 300 N/mm, 0 m/s, 40 degC" in capsys.readouterr().out
    status, out, _ = commands.run(capsys, "bearing", "NU308", "--map", path, "--load", "1 kN", "--speed", "0 rpm")
    assert status == 0
    assert "smallest film                    um                  0            0" in out
