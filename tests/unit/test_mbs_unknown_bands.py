"""Bands of what is not known: the sum against draws of a closed form, looks against machines that are made anew."""

from __future__ import annotations

import dataclasses
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
import xarray as xr

import ehdmaps
import mbs
from ehdmaps.errors import AnalysisError, InputError
from ehdmaps.units import Tolerance
from mbs.analyses.modes import modes
from mbs.analyses.sweep import SweepSettings, critical
from mbs.cli import main
from mbs.linearised.pairs import in_order
from mbs.output.band_text import bounds_text, deserved, exact_text, lost_lines, value_text
from mbs.scene.assembly import assemble
from mbs.scene.changes import with_temperature
from mbs.scene.reader import parse_scene, read_scene
from mbs.settings import SweepRange
from mbs.unknowns import held_open
from mbs.unknowns.looks import Band, Term, band
from mbs.unknowns.of_variables import variable_bands
from mbs.unknowns.unknown import Unknown
from tests.benchmarks import coverage
from tests.benchmarks.coverage.draws import drawn, truth

CENTRE = np.array([100.0, 1.0])
SIZES = {"clearance of left": 3.0, "clearance of right": 2.0, "temperature": 2.0, "viscosity": 1.5, "preload": 1.0}
"""Changes of the first value at the ends of uniform unknowns; the second value changes by a hundredth of it."""


def unknown(name, *changes, **more):
    """An unknown whose looks are the changes of the first value."""
    looks = tuple(SimpleNamespace(change=change) for change in changes)
    return Unknown(name, name.partition(" ")[0], "", "", looks, **more)  # type: ignore[arg-type]


def look(scene, standing):
    """Values of such a look; NaN stands for a value that is lost, a text for no result."""
    if isinstance(scene.change, str):
        raise AnalysisError(scene.change)
    return CENTRE + np.array([scene.change, 0.01 * scene.change]) * (2.0 if standing else 1.0)


def found(*unknowns, numerics=0.0):
    """The band by some unknowns."""
    return band(look, CENTRE, unknowns, np.full(2, numerics))


def test_machines_from_a_file_and_from_python_have_the_same_bands():
    """Values with their tolerances in a file; in Python a machine put together from parts, and statements of `know`."""
    text = read_scene("nu308_rigid").text
    for plain, told in (('"0 um"', '"20 um +- 2 um"'), ('temperature = "40 degC"', 'temperature = "50 degC +- 1 K"')):
        assert plain in text
        text = text.replace(plain, told)
    file = parse_scene(text, "file", "file.toml")
    elements = [by_hand(one) if isinstance(one, mbs.BearingSpec) else one for one in file.elements]
    held = {one.name: getattr(file, one.name) for one in dataclasses.fields(mbs.Scene)}
    own = mbs.Scene(**{**held, "name": "own", "temperature": 313.15, "elements": elements, "tolerances": {}})
    # a profile that a file states is exact; in Python it is not told from the default
    own = mbs.know(own, "clearance = 20 um +- 2 um; temperature = 50 degC +- 1 K; profile = +- 0 %")
    bands = [mbs.modes(assemble(scene, "formula")).bands for scene in (file, own)]
    for name in ("frequency", "damping_ratio"):
        first, second = (getattr(one, name) for one in bands)
        assert {term.name for term in first.terms} == {term.name for term in second.terms}
        for side in ("low", "high"):
            np.testing.assert_allclose(getattr(second, side), getattr(first, side), rtol=1e-9)
    with pytest.raises(InputError, match="allowed: clearance"):
        mbs.know(own, "clearnce = 1 um")


def by_hand(one):
    """A bearing of the same place, put together anew."""
    geometry = ehdmaps.BearingGeometry.named("NU308")
    return mbs.BearingSpec(one.name, one.inner, one.outer, geometry, profile=one.profile, slices=one.slices)


def test_nine_tenths_of_drawn_machines_are_inside():
    """Of sums of uniform unknowns, whose share inside follows from draws alone: 0.90 of five of these sizes."""
    both = found(*(unknown(name, -size, size) for name, size in SIZES.items()))
    drawn = np.random.default_rng(7).uniform(-1.0, 1.0, (20_000, len(SIZES))) @ np.array(list(SIZES.values()))
    inside = (drawn >= both.low[0] - CENTRE[0]) & (drawn <= both.high[0] - CENTRE[0])
    assert 0.88 < inside.mean() < 0.92  # 0.004 are two standard deviations of the draws


def test_nine_tenths_are_inside_where_changes_multiply_and_one_is_of_two_kinds():
    """Damping of rollers: factors of uniform logarithms, and one of two profiles, drawn half and half."""
    factors = {"clearance": 1.8, "temperature": 1.3, "viscosity": 1.2}
    each = [unknown(name, 100.0 * (factor - 1.0), 100.0 * (1.0 / factor - 1.0)) for name, factor in factors.items()]
    both = found(*each, unknown("profile", 60.0))
    random = np.random.default_rng(3)
    logs = random.uniform(-1.0, 1.0, (20_000, len(factors))) @ np.log(list(factors.values()))
    for profile in (1.0, 1.6):  # each of the kinds alone, too
        drawn = 100.0 * profile * np.exp(logs)
        inside = (drawn >= both.low[0]) & (drawn <= both.high[0])
        assert 0.9 < inside.mean() <= 1.0
    width = np.quantile(100.0 * random.choice([1.0, 1.6], logs.size) * np.exp(logs), [0.05, 0.95])
    assert both.high[0] - both.low[0] < 1.5 * (width[1] - width[0])


def test_sides_are_apart_and_numerics_a_term():
    unknowns = unknown("clearance", 3.0, -0.5), unknown("temperature", 4.0, 1.0)
    one = dataclasses.replace(found(*unknowns, numerics=1.0), signed=np.ones(2, dtype=bool))
    assert one.rise[0] == pytest.approx(np.sqrt(9.0 + 16.0 + 1.0))
    assert one.fall[0] == pytest.approx(np.sqrt(0.25 + 0.0 + 1.0))
    assert [term.name for term in one.largest(0)] == ["temperature", "clearance"]
    assert one.without("temperature").rise[0] == pytest.approx(np.sqrt(10.0))
    assert found(unknown("clearance", 100.0), unknown("profile", 50.0)).high[0] == pytest.approx(300.0)


def test_a_single_look_stands_for_both_sides_where_it_is_reflected():
    assert found(unknown("pressure", 2.0, reflected=True)).fall[0] == pytest.approx(2.0)
    assert found(unknown("profile", 2.0)).fall[0] == 0.0
    assert found(unknown("clearance", 2.0, "no equilibrium")).fall[0] == pytest.approx(2.0)


def test_cages_that_stand_are_looked_at_as_such():
    assert found(unknown("cage", 1.0, -0.5, 0.25, frozen_cage=True)).rise[0] == pytest.approx(2.0)


def test_what_is_lost_or_refused_is_told():
    one = found(unknown("clearance", np.nan, 2.0), unknown("temperature", "no equilibrium", "neither here"))
    assert one.lost.tolist() == [1, 1] and one.looks == 2
    assert one.low[0] == pytest.approx(98.0)  # the side that was lost is the other one reflected
    lines = list(lost_lines(one, ["mode 1", "mode 2"]))
    assert "mode 1 in 1, mode 2 in 1 of 2 looks" in lines[0]
    assert lines[1].endswith("temperature: no equilibrium")


def test_less_that_is_open_is_never_a_wider_band():
    every = [unknown(name, -size, 0.3 * size) for name, size in SIZES.items()]
    whole = found(*every, numerics=0.1)
    for left_out in range(len(every)):
        less = found(*every[:left_out], *every[left_out + 1 :], numerics=0.1)
        assert np.all(less.low >= whole.low) and np.all(less.high <= whole.high)


def test_forces_may_change_their_sign_and_stiffnesses_do_not():
    """A force of 100 N that one end turns to -200 N has that bound; a stiffness ends at nothing."""
    centre = {"bearing_force": np.array([100.0]), "bearing_stiffness": np.diag(np.full(6, 100.0))}

    def make(changed, standing):
        return {name: values + changed.change * (values != 0.0) for name, values in centre.items()}

    both = variable_bands(make, centre, [unknown("load", -300.0, 10.0)])
    assert both["bearing_force"].low[0] == pytest.approx(-200.0)
    assert both["bearing_force"].high[0] == pytest.approx(110.0)
    assert both["bearing_stiffness"].low[0, 0] == 0.0 and both["bearing_stiffness"].high[0, 0] == pytest.approx(110.0)


def test_damping_has_no_negative_bound():
    wide = found(unknown("clearance", -150.0, 50.0))
    assert wide.low[0] == 0.0 and bounds_text(wide, 0) == "0 to 150 unsure"
    assert exact_text(wide, 0) == "clearance; 100"


def test_numbers_have_the_digits_that_they_deserve():
    one = Band(
        np.array([268.384]), np.zeros(1), (Term("clearance", "c", np.array([11.2]), np.array([16.0])),), np.zeros(1)
    )
    assert (value_text(one, 0), bounds_text(one, 0)) == ("268", "252 to 280")
    assert deserved(0.0123456, 0.00091) == "0.01235" and deserved(1.0, 0.0) == "1"


def test_planes_of_one_frequency_are_paired_by_order():
    frequency = np.array([100.0, 101.0, 200.0, 203.0])
    partner, found = np.array([1, 0, 3, -1]), np.array([90.0, 95.0, 190.0, 199.0])
    alike, unlike = np.full(4, 0.01), np.array([0.01, 0.03, 0.01, 0.01])
    assert in_order(frequency, alike, partner, found).tolist() == [0, 1, 3, -1]
    assert in_order(frequency, unlike, partner, found).tolist() == [1, 0, 3, -1]  # two modes that meet, by shape


@pytest.fixture(scope="module")
def rigid():
    """A rigid shaft on two bearings whose geometry is known."""
    return assemble(read_scene("nu308_rigid"))


def test_a_look_is_the_machine_made_anew(rigid):
    """A model `again` and one that is assembled from the changed scene are one, law and films included."""
    warmer = with_temperature(rigid.scene, rigid.scene.temperature + 5.0)
    again, anew = (modes(model).modes.eigenvalues for model in (rigid.again(warmer), assemble(warmer)))
    assert np.array_equal(again, anew)
    assert rigid.again(warmer).recipe.maps.maps[0] is rigid.recipe.maps.maps[0]


@pytest.fixture
def few_unknowns(monkeypatch):
    """Clearances and temperature alone are open: other looks cost seconds."""
    for name in ("_alpha", "profiles", "_cages", "other_supplies"):
        monkeypatch.setattr(held_open, name, lambda *given: ())


@pytest.mark.usefixtures("few_unknowns")
def test_modes_have_bands_in_files(rigid, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert main(["modes", "nu308_rigid", "--bands", "all", "-o", "all.nc"]) == 0
    out = capsys.readouterr().out
    assert "90 % of what is not known" in out and "decided by" in out and "held open: " in out
    assert main(["modes", "nu308_rigid", "--bands", "numerics", "-o", "numerics.nc"]) == 0
    assert "90 %" not in capsys.readouterr().out
    with xr.open_dataset("all.nc") as one, xr.open_dataset("numerics.nc") as other:
        assert np.all(one["frequency"].values == other["frequency"].values)
        inside = np.isfinite(one["frequency_low"].values)
        assert inside.any() and "frequency_low" not in other
        for name in ("frequency", "damping_ratio"):
            low, value, high, error = (one[f"{name}{end}"].values[inside] for end in ("_low", "", "_high", "_error"))
            assert np.all((low <= value - error) & (high >= value + error))


def test_bands_of_another_kind_are_refused(capsys):
    assert main(["modes", "nu308_rigid", "--bands", "3"]) == 2
    assert "--bands: got '3'; allowed: all, numerics" in capsys.readouterr().err


def test_a_look_at_one_bearing_is_the_command_with_another_clearance(tmp_path, monkeypatch, capsys):
    """Bounds of K reach those of the far end of the clearance, which is an option; dry, so that nothing else counts."""
    monkeypatch.chdir(tmp_path)
    asked = ["bearing", "6208", "--load", "1 kN", "--speed", "0 rpm", "--law", "hertz"]
    assert main([*asked, "--bands", "all", "-o", "all.nc"]) == 0
    assert "held open: clearance 0 to 20 um" in capsys.readouterr().out
    assert main([*asked, "--clearance", "20 um", "-o", "away.nc"]) == 0
    with xr.open_dataset("all.nc") as one, xr.open_dataset("away.nc") as other:
        for name in ("stiffness_along", "stiffness_across"):
            assert one[f"{name}_low"].item() <= other[name].item() * (1.0 + 1e-6)


@pytest.mark.parametrize(
    ("asked", "names"),
    [
        (["lsa"], ["peak_frequency", "peak_level"]),
        (["critical", "--speed", "1000 rpm", "4000 rpm", "3"], ["critical_speed", "critical_damping_ratio"]),
    ],
    ids=["lsa", "critical"],
)
@pytest.mark.usefixtures("few_unknowns")
def test_results_lie_within_their_bands(asked, names, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert main([asked[0], "nu308_rigid", *asked[1:], "--bands", "all", "-o", "all.nc"]) == 0
    assert "held open: " in capsys.readouterr().out
    with xr.open_dataset("all.nc") as found:
        for name in names:
            low, value, high = (found[f"{name}{end}"].values for end in ("_low", "", "_high"))
            known = np.isfinite(low)
            assert known.any() and np.all((low[known] <= value[known]) & (high[known] >= value[known]))
            assert np.any(high[known] > low[known])


@pytest.fixture(scope="module")
def whole(rigid):
    """Bands of the modes of the rigid shaft."""
    return modes(rigid).bands_to(3000.0)


@pytest.mark.parametrize("group", ["clearance", "cage_angle"])
def test_a_statement_never_widens_a_band(group, rigid, whole):
    """What is stated to be exact leaves the other terms as they are: bounds come nearer, whichever they are."""
    exact = Tolerance(0.0, False, "0")
    scene = dataclasses.replace(rigid.scene, tolerances={**rigid.scene.tolerances, group: exact})
    less = modes(rigid.again(scene)).bands_to(3000.0)
    assert group in {term.group for term in whole.frequency.terms}
    assert group not in {term.group for term in less.frequency.terms}
    for name in ("frequency", "damping_ratio"):
        one, other = getattr(whole, name), getattr(less, name)
        assert np.all(other.low >= one.low - 1e-9 * one.value) and np.all(other.high <= one.high + 1e-9 * one.value)


@pytest.mark.slow  # bands and draws of a machine, four seconds
def test_most_of_drawn_machines_are_inside():
    """Draws that share no code with bands; of twelve at 90 % fewer than nine are inside once in a hundred."""
    scene = read_scene(str(Path(coverage.__file__).with_name("balls.toml")))
    found = modes(assemble(scene), highest=2500.0)
    bands = found.bands_to(2500.0)
    random = np.random.default_rng(3)
    truths = [truth(drawn(scene, random), found.balance, found.modes, bands.chosen).modes for _ in range(12)]
    for values, own in zip(np.swapaxes(truths, 0, 1), (bands.frequency, bands.damping_ratio), strict=True):
        inside = (values >= own.low) & (values <= own.high)
        assert inside.mean() > 0.7


@pytest.mark.slow  # three sweeps with their critical speeds
def test_critical_speeds_move_as_those_of_the_changed_machine(rigid, monkeypatch):
    """To first order; what is left of a small change is of second order, a tenth of it at most."""
    speeds = SweepSettings(SweepRange(850.0, 1150.0, 3))
    looks = tuple(with_temperature(rigid.scene, rigid.scene.temperature + by) for by in (-1.0, 1.0))
    one = Unknown("temperature", "temperature", "+-1 K", "", looks)
    monkeypatch.setattr("mbs.unknowns.over_speed.held_open_of", lambda model: (one,))
    found = critical(rigid, speeds)
    low, high = found.bounds[0, :2]
    numerics = found.sweep.damped.frequency_error[1, 0] / found.sweep.damped.frequency[1, 0]
    moved = sorted(critical(rigid.again(scene), speeds).found[0].speed for scene in looks)
    true = np.array([moved[0], moved[-1]]) - found.found[0].speed
    told = np.array([low, high]) - found.found[0].speed
    assert found.found and np.all(np.abs(true) > 0.0)
    slack = 0.1 * np.abs(true) + 2.0 * numerics * found.found[0].speed
    assert np.all(np.abs(told - true) <= slack)


def test_a_map_from_a_file_has_one_oil(formula_maps):
    """What a band cannot look at is named in it, and not taken as nothing."""
    model = assemble(read_scene("nu308_rigid"), emap=formula_maps["NU308"])
    other = dataclasses.replace(model.scene, lubricant=model.scene.lubricant.with_alpha(1.1, 313.15))
    with pytest.raises(InputError, match="holds the films of one oil"):
        model.again(other)
