"""Differences between two laws under single changes: the table, what is refused before it runs, what is kept."""

from __future__ import annotations

import argparse
import dataclasses
import importlib
import re
from importlib import resources

import numpy as np
import pytest
import xarray as xr

from ehdmaps.errors import AnalysisError, InputError
from ehdmaps.maps.emap import EHDMap
from mbs import assemble, campbell, read_scene
from mbs.analyses.case import Case
from mbs.laboratory import variants as analysis
from mbs.laboratory.variants import Variation, variants
from mbs.output.campbell_plot import variants_figure
from mbs.scene import changes
from mbs.scene.assembly import build_body
from mbs.scene.choices import VARIED
from mbs.scene.map_set import MapSet
from mbs.scene.subject import LawChoice, Subject
from mbs.spectral.levels import LevelDifference, difference_text
from tests.cases.laws import dataset_of
from tests.cases.run_up import refused

DRY = LawChoice("dry", "hertz")
DAMPED = LawChoice("damped", "hertz:1.25e-5 s")
FORMULA = LawChoice("formula", "formula")
"""Of which no model is made: that takes seconds."""

PAIR = ["hertz", "hertz:1.25e-5 s"]


@pytest.fixture(scope="module")
def path(tmp_path_factory):
    """The shipped NU308 with a short run, and a second sensor."""
    text = (resources.files("mbs") / "systems" / "nu308_rigid.toml").read_text(encoding="utf-8")
    path = tmp_path_factory.mktemp("scene") / "short.toml"
    second = '[[sensors]]\nname = "S2"\non = "shaft:left"\ndirection = "y"\nquantity = "acceleration"\n'
    path.write_text(
        text.replace('from = "0 rpm"', 'from = "2000 rpm"')
        .replace('to = "2000 rpm"', 'to = "5000 rpm"')
        .replace('duration = "0.2 s"', 'duration = "0.08 s"')
        .replace('sample = "0.1 ms"', "")
        .replace("slices = 41", "slices = 5")
        + second
    )
    return path


@pytest.fixture(scope="module")
def scene(path):
    return read_scene(str(path))


@pytest.fixture
def levels(monkeypatch):
    """Run-ups that take no time: levels that depend on the model only; and what was run."""
    made = []

    class Nothing:
        def __init__(self, model):
            self.time, self.signals, self.outside = model, np.zeros((1, 9)), {"left": 0}
            self.speed = self.angle = None

    def recorded(model, course, sensors, told):
        made.append(model)
        told(round(course.duration / course.settings.sample))
        return Nothing(model)

    class Levels:
        def __init__(self, model):
            scene = model.scene
            clearance = 1e6 * scene.bearings[0].geometry.diametral_clearance
            self.speeds = np.linspace(10.0, 20.0, 21)
            self.sum_level = np.linspace(80.0, 90.0, 21) + clearance - 7.0 * (model.law != "dry Hertz, ISO 16281")

    monkeypatch.setattr(analysis, "recorded_run", recorded)
    monkeypatch.setattr(analysis, "RunSignal", lambda model, *_: model)
    monkeypatch.setattr(analysis, "silent_run", lambda course: None)
    monkeypatch.setattr(analysis, "campbell", lambda signal, *_: None if signal is None else Levels(signal))
    return made


def run_command(scene, **values):
    names = ("law", "map", "films", "clearance", "structural_law", "output", "plot", "highest", "window")
    given = argparse.Namespace(
        **{**dict.fromkeys(names), "vary": [], "workers": 1, "executor": None, "scene": str(scene), **values}
    )
    return importlib.import_module("mbs.laboratory.commands.variants").run(given)


class TestChanges:
    def test_all_keys_are_named_in_the_help_and_read_their_example(self, scene):
        for key in VARIED.values():
            assert key.text(key.read(key.example))

    def test_a_ramp_is_stretched(self, scene):
        slow = changes.with_duration(scene, 0.4).run_up
        # The same speed at five times the time; five times the angle, being its integral. Round-off of a product.
        for part in (0.0, 0.3, 1.0):
            speed, angle = scene.run_up.speed.at(part * 0.08)
            assert slow.speed.at(part * 0.4) == pytest.approx((speed, 5.0 * angle), rel=1e-12)

    def test_damping_of_the_housing_is_in_proportion(self):
        gearbox = read_scene("gearbox")
        names = [body.name for body in gearbox.bodies]
        plain = build_body(gearbox.bodies[names.index("housing")])
        double = build_body(changes.with_housing_damping(gearbox, 2.0).bodies[names.index("housing")])
        np.testing.assert_allclose(double.damping, 2.0 * plain.damping, rtol=1e-12, atol=1e-12 * plain.damping.max())
        np.testing.assert_array_equal(double.stiffness, plain.stiffness)
        np.testing.assert_array_equal(double.mass, plain.mass)
        # Shafts keep theirs.
        assert changes.with_housing_damping(gearbox, 2.0).bodies[:2] == gearbox.bodies[:2]
        with pytest.raises(InputError, match=r"got the factor 100 on a damping_ratio of 0.01; allowed: up to 99"):
            changes.with_housing_damping(gearbox, 100.0)

    def test_slices_step_and_angle(self, scene):
        assert {entry.slices for entry in changes.with_slices(scene, 7).bearings} == {7}
        assert {entry.start_angle for entry in changes.with_start_angle(scene, 0.1).bearings} == {0.1}
        settings = changes.with_step(scene, 5e-6).run_up.settings
        assert (settings.step, settings.sample) == (5e-6, 5e-6)
        doubled = changes.with_loads(scene, 2.0)
        np.testing.assert_array_equal(doubled.loads[0].force, 2.0 * scene.loads[0].force)

    def test_keys_concern_what_they_say(self, scene):
        dry, film = Subject(scene, DRY), Subject(scene, FORMULA)
        hot, law, slow = VARIED["temperature"], VARIED["law"], VARIED["films"]
        assert hot.varied(dry, 350.0, first=True) is dry
        assert hot.varied(film, 350.0, first=False).scene.temperature == 350.0
        assert law.varied(film, "hertz:1e-5 s", first=False) is film
        assert law.varied(dry, "hertz:1e-5 s", first=True).law.name == "hertz:1e-5 s"
        assert slow.varied(film, "memory", first=False).law.films == "memory"
        assert slow.varied(dry, "memory", first=True) is dry

    def test_the_base_is_that_of_campbell(self, scene):
        """All sensors of one run give what `campbell` gives of each, to the last digit; a changed scene, too."""
        found = variants(scene, (DRY, DAMPED), [Variation("clearance", 20e-6)])
        assert [sensor.name for sensor in found.sensors] == ["S1", "S2"]
        assert found.runs == 4
        base, changed = found.variants
        cases = [Case(law.label, assemble(scene, law.name, clearance=20e-6), 0.0) for law in (DRY, DAMPED)]
        levels = campbell(cases).dataset["sum_level"].values
        assert changed.differences[0] == LevelDifference.of(levels[0], levels[1]) != base.differences[0]
        # A damper makes it quieter.
        assert base.differences[0].median < 0.0 and changed.differences[0].median < 0.0


class TestTable:
    def test_runs_that_a_change_does_not_concern_are_made_once(self, scene, levels):
        changed = [
            Variation("temperature", 350.0),
            Variation("clearance", scene.bearings[0].geometry.diametral_clearance),
            Variation("films", "slow"),
            Variation("law", "hertz:1e-5 s"),
        ]
        film = LawChoice("map", "map", MapSet([EHDMap(dataset_of())]), "slow")
        found = variants(scene, (DRY, film), changed)
        # dry, film; film at another temperature; the other dry law, which the fake makes as quiet as the film
        assert found.runs == len(levels) == 4
        assert found.variants[4].differences[0].median == 0.0
        assert found.variants[2].differences == found.variants[0].differences == found.variants[3].differences
        assert found.variants[0].differences[0] == LevelDifference(-7.0, -7.0, -7.0, pytest.approx(-7.0), -7.0)

    def test_runs_of_other_speeds_are_compared_where_both_have_them(self, scene, levels, monkeypatch):
        made = analysis.campbell

        def driven(signal, *rest):
            found = made(signal, *rest)
            if found is not None and signal.law == "dry Hertz, ISO 16281":
                # as fast as the other one, but for the last windows
                found.speeds, found.sum_level = found.speeds[:-3], found.sum_level[:-3]
            elif found is not None and signal.scene.temperature == 350.0:
                found.speeds = found.speeds + 100.0
            return found

        monkeypatch.setattr(analysis, "campbell", driven)
        film = LawChoice("map", "map", MapSet([EHDMap(dataset_of())]), "slow")
        found = variants(scene, (DRY, film), [Variation("temperature", 350.0)])
        difference = found.variants[0].differences[0]
        assert difference.median == pytest.approx(-7.0, abs=1e-12)  # round-off of powers and logarithms
        assert difference.highest == pytest.approx(-7.0, abs=1e-12)
        assert found.variants[1].problem == "the two runs have no speeds in common"

    def test_failures_are_rows(self, scene, path, levels, monkeypatch):
        made = analysis.recorded_run

        def failing(model, course, sensors, told):
            if model.scene.bearings[0].geometry.diametral_clearance == 1e-5:
                raise AnalysisError("no step")
            return made(model, course, sensors, told)

        monkeypatch.setattr(analysis, "recorded_run", failing)
        text, status = run_command(path, law=PAIR, vary=[["clearance", "10 um", "20 um"]])
        assert status == 1
        assert len(re.findall("clearance +10 um +no result: no step", text)) == 2  # of both sensors
        assert "warning: clearance 10 um: no step" in text
        assert "range over the base and 1 changes" in text

    def test_what_is_done_is_kept(self, scene, path, levels, monkeypatch):
        made = analysis.recorded_run

        def stopped(model, *rest):
            if len(levels) == 3:
                raise KeyboardInterrupt
            return made(model, *rest)

        monkeypatch.setattr(analysis, "recorded_run", stopped)
        text, status = run_command(path, law=PAIR, vary=[["clearance", "10 um"]])
        assert status == 1
        assert re.search("clearance +10 um +no result: stopped, no result", text)
        with pytest.raises(KeyboardInterrupt):
            variants(scene, (DRY, DAMPED), [Variation("clearance", 1e-5)])

    def test_nothing_came_to_the_end(self, scene, levels, monkeypatch):
        def failing(*_):
            raise AnalysisError("no step")

        monkeypatch.setattr(analysis, "recorded_run", failing)
        with pytest.raises(AnalysisError, match=r"base: no step\nwarning: clearance 10 um: no step"):
            variants(scene, (DRY, DAMPED), [Variation("clearance", 1e-5)])

    def test_file_and_figure(self, path, levels, tmp_path):
        out, plot = tmp_path / "table.nc", tmp_path / "table.png"
        text, status = run_command(
            path, law=PAIR, vary=[["clearance", "10 um", "20 um"]], output=str(out), plot=str(plot)
        )
        assert status == 0
        assert re.search(r"(?m)^  base +- +-7\.0 +-7\.0 to -7\.0 +-7\.0 +-7\.0$", text)
        with xr.open_dataset(out) as data:
            assert data["median_difference"].dims == ("variant", "sensor")
            np.testing.assert_array_equal(data["median_difference"], -7.0)
            assert data["value"].values.tolist() == ["", "10 um", "20 um"]
            assert data["median_difference"].attrs["units"] == "dB"
            figure = variants_figure("title", data.load(), ("dry", "film"))
        assert len(figure.axes) == 2
        labels = [label.get_text() for label in figure.axes[0].get_yticklabels()]
        assert labels == ["base", "clearance 10 µm", "clearance 20 µm"]
        assert plot.stat().st_size > 10_000


class TestRefused:
    def test_every_problem_of_the_command_at_once(self, path):
        problems = refused(
            lambda: run_command(
                path,
                law=["hertz"],
                vary=[["clearence", "1 um"], ["clearance"], ["ramp", "3"], ["slices", "0"], ["films", "wet"]],
                highest="3 m",
            ),
            "--vary: got 'clearence' (did you mean 'clearance'?); allowed: law, physics, structural-law, films,",
            "--vary clearance: got no value; allowed: one or more, such as '15 um'",
            "--vary ramp: got '3' without a unit",
            "--vary slices: got '0'; allowed: a whole number from 1 to 10000",
            "--vary films: got 'wet'; allowed: memory, slow",
            "--highest: got the unit 'm'",
        )
        assert len(problems) == 6
        refused(
            lambda: run_command(path, law=["hertz"], vary=[["ramp", "3 s"]]),
            "got 1 laws (dry Hertz); allowed: two, the reference first, such as --law hertz --map MAP.nc",
        )
        refused(
            lambda: run_command(path, law=PAIR, clearance=["1 um", "2 um"], vary=[["ramp", "3 s"]]),
            "--clearance: got 2 of them; allowed: one, and others by --vary clearance",
        )

    def test_every_change_that_does_not_fit_before_anything_runs(self, path, levels):
        given = [
            ["step", "1 ms"],
            ["housing-damping", "2"],
            ["law", "hertz:1 kg", "constant:none"],
            ["ramp", "1 us"],
        ]
        problems = refused(
            lambda: run_command(path, law=PAIR, vary=given),
            "--vary step 1000 us: short: [runup] step: got 1000 us; allowed: up to",
            "--vary housing-damping 2 x: the scene has no [[flexible]] body with a damping_ratio",
            "--vary law hertz 1 kg: got 'hertz:1 kg'; allowed: hertz:TIME such as 'hertz:1.25e-5 s'",
            "--vary law constant none: got 'constant:none'",
            "--vary ramp 1e-06 s: short: [runup] duration: got 1e-06 s",
        )
        assert len(problems) == 5
        assert not levels

    def test_scenes_without_a_run_or_a_sensor(self, scene):
        bare = dataclasses.replace(scene, run_up=None)
        for change in (changes.with_step, changes.with_duration):
            with pytest.raises(InputError, match=r"the scene has no \[runup\]"):
                change(bare, 1e-5)
        with pytest.raises(InputError, match=r"\[runup\] missing"):
            variants(bare, (DRY, DAMPED), [])
        deaf = dataclasses.replace(scene, sensors=())
        with pytest.raises(InputError, match="got the sensors none; allowed: at least one"):
            variants(deaf, (DRY, DAMPED), [])
        with pytest.raises(InputError, match="--vary: got 101 values; allowed: at most 100"):
            variants(scene, (DRY, DAMPED), [Variation("clearance", 1e-6 * k) for k in range(101)])


def test_levels_apart_by_a_constant_differ_by_it():
    """In all five numbers, to round-off; `difference_text` has them too."""
    first = np.array([70.0, 95.0, 81.0, 88.0])
    found = LevelDifference.of(first, first - 4.0)
    assert (found.low, found.median, found.high, found.energy, found.highest) == pytest.approx((-4.0,) * 5, abs=1e-12)
    assert difference_text(first, first - 4.0).startswith("median -4.0 dB, 5 to 95 % of the windows -4.0 to -4.0 dB")


def test_mean_energies_are_those_of_the_squares():
    """Two windows of 10 and 0 dB against two of 0 dB: (10 + 1)/2 times the energy."""
    found = LevelDifference.of(np.zeros(2), np.array([10.0, 0.0]))
    assert found.energy == pytest.approx(10.0 * np.log10(5.5), abs=1e-12)
