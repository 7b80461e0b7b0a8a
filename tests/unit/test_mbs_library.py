"""`mbs` as a library: every analysis from Python, without files, gives what its command writes."""

from __future__ import annotations

import dataclasses
import importlib
import pkgutil
import subprocess
import sys
from importlib import resources

import numpy as np
import pytest
import xarray as xr

import mbs
from ehdmaps.errors import AnalysisError, InputError, MapError
from ehdmaps.jobs import cli as jobs_cli
from ehdmaps.maps.emap import open_map
from ehdmaps.outputs import MADE_AS
from ehdmaps.units import quantity
from mbs import (
    CampbellSettings,
    Case,
    HammerSettings,
    LsaSettings,
    Operation,
    PlanSettings,
    SweepRange,
    SweepSettings,
    analyses,
    assemble,
    campbell,
    cli,
    hammer,
    lsa,
    modes,
    parse_scene,
    plan,
    read_scene,
    runup,
    statics,
    sweep,
)
from mbs.linearised.linear import peak_places
from mbs.modal.uff import read_uff
from mbs.model.elements import OnRings
from tests.cases.jobs import map_job
from tests.cases.masses import MASSES, OIL, masses_on

JOB = map_job(
    '["1 N/mm", "10 N/mm", "100 N/mm", "400 N/mm"]', '["0.1 m/s", "0.5 m/s", "2 m/s", "10 m/s"]', '["40 degC"]'
)


@pytest.fixture(scope="module")
def path(tmp_path_factory):
    """The shipped NU308 with a short run and few frequencies."""
    text = (resources.files("mbs") / "systems" / "nu308_rigid.toml").read_text(encoding="utf-8")
    path = tmp_path_factory.mktemp("scene") / "short.toml"
    path.write_text(
        text.replace('from = "0 rpm"', 'from = "2000 rpm"')
        .replace('to = "2000 rpm"', 'to = "5000 rpm"')
        .replace('duration = "0.2 s"', 'duration = "0.08 s"')
        .replace('sample = "0.1 ms"', "")
        .replace("slices = 41", "slices = 5")
    )
    return path


@pytest.fixture(scope="module")
def model(path):
    return assemble(read_scene(str(path)), "hertz")


@pytest.fixture
def written(path, tmp_path, capsys):
    """What a command on the scene writes."""

    def run(command, *options):
        out = tmp_path / "out.nc"
        law = () if "--law" in options else ("--law", "hertz")
        assert cli.main([command, str(path), *law, *options, "-o", str(out)]) == 0
        capsys.readouterr()
        with xr.open_dataset(out) as data:
            found = data.load()
        del found.attrs[MADE_AS]
        return found

    return run


def counted():
    """A progress, and what it was told."""
    told = []
    return told, lambda done, total: told.append((done, total))


def check_told(told, total):
    assert told[0] == (0, total)
    assert told[-1] == (total, total)
    assert told == sorted(told)


def test_every_name_is_there():
    assert set(mbs.__all__) <= set(dir(mbs))
    assert [getattr(mbs, name).__name__ for name in mbs.__all__] == list(mbs.__all__)


def test_the_table_of_the_package_has_every_module():
    table = {line.split("  ")[0] for line in (analyses.__doc__ or "").splitlines()}
    assert {entry.name for entry in pkgutil.iter_modules(analyses.__path__)} <= table


@pytest.mark.slow
def test_analyses_load_no_command_and_neither_they_nor_commands_load_figures():
    code = (
        "import importlib, pkgutil, sys, mbs; [getattr(mbs, name) for name in mbs.__all__]; print([*sys.modules]); "
        "import mbs.commands; names = {each.name for each in pkgutil.iter_modules(mbs.commands.__path__)}; "
        "[importlib.import_module('mbs.commands.' + name) for name in names - {'report'}]; print([*sys.modules])"
    )
    result = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    library, commands = result.stdout.splitlines()
    assert "mbs.analyses.campbell" in library and "mbs.commands.sweep" in commands
    assert not [name for name in ("mbs.commands", "mbs.cli", "matplotlib") if f"'{name}'" in library]
    # half a second each, in every process: loaded where something is drawn or filtered; reports always draw
    assert not [name for name in ("matplotlib", "scipy.signal", "pyuff", "sdypy") if f"'{name}'" in commands]


class TestDefaultLaw:
    """Without a law commands and `assemble` take the films of the table for every kind of bearing."""

    def test_library_and_command_agree(self, tmp_path, capsys):
        scene = str(tmp_path / "own.toml")
        (tmp_path / "own.toml").write_text(MASSES)
        model = assemble(read_scene(scene))
        for command, analysis in (("statics", statics), ("modes", modes)):
            assert cli.main([command, scene, "-o", str(tmp_path / f"{command}.nc")]) == 0
            page = capsys.readouterr().out
            found = analysis(assemble(model.scene)).dataset
            assert "films from the film table" in page and model.law in page
            with xr.open_dataset(tmp_path / f"{command}.nc") as data:
                del data.attrs[MADE_AS]
                xr.testing.assert_identical(found, data.load())
        for connected, damping in zip(model.system.elements, analysis(model).balance.element_damping, strict=True):
            assert not isinstance(connected.element, OnRings) or damping[1, 1] > 0.0

    @pytest.mark.parametrize("masses", [masses_on("32208", "NUP210", "6208"), masses_on("6208")])
    def test_a_scene_without_oil_is_dry_and_says_so(self, tmp_path, capsys, masses):
        (tmp_path / "own.toml").write_text(masses.replace(OIL, ""))
        words = "dry, and so without damping, as the scene has no [lubricant]"
        model = assemble(read_scene(str(tmp_path / "own.toml")))
        assert words in model.law and words not in assemble(model.scene, "hertz").law
        assert cli.main(["statics", str(tmp_path / "own.toml")]) == 0
        assert words in capsys.readouterr().out


class TestAsTheCommand:
    def test_statics(self, model, written):
        xr.testing.assert_identical(statics(model).dataset, written("statics"))

    def test_modes(self, model, written):
        xr.testing.assert_identical(modes(model).dataset, written("modes"))

    def test_lsa(self, model, written):
        xr.testing.assert_identical(lsa(model).dataset, written("lsa"))

    @pytest.mark.slow
    def test_sweep_of_two_laws(self, model, written):
        other = assemble(model.scene, "formula")
        told, progress = counted()
        found = sweep(
            [model, other],
            SweepSettings(SweepRange(quantity("1000 rpm", "rad/s"), quantity("2000 rpm", "rad/s"), 2), 2),
            progress,
        )
        speeds = ("--speed", "1000 rpm", "2000 rpm", "2")
        xr.testing.assert_identical(
            found.dataset, written("sweep", "--law", "hertz", "--law", "formula", *speeds, "--cage-angles", "2")
        )
        check_told(told, 2)

    def test_runup(self, model, written):
        told, progress = counted()
        found = runup(model, progress=progress)
        xr.testing.assert_identical(found.dataset, written("runup"))
        check_told(told, found.record.steps)

    def test_runup_with_signals_only(self, model, written):
        whole, lean = (runup(model, states=states) for states in (True, False))
        # the same steps, so not a bit differs
        for name in ("signals", "signal_time", "signal_speed", "time"):
            np.testing.assert_array_equal(getattr(lean.record, name), getattr(whole.record, name))
        for one, other in zip((*lean.record.forces, *lean.record.motions),
                              (*whole.record.forces, *whole.record.motions), strict=True):  # fmt: skip
            np.testing.assert_array_equal(one, other)
        of_all = whole.dataset.variables
        coordinates = {name for name in of_all if any("coordinate" in dim for dim in of_all[name].dims)}
        assert {"displacement", "velocity", "acceleration"} <= coordinates
        xr.testing.assert_identical(lean.dataset, whole.dataset.drop_vars(coordinates))
        assert lean.record.states.displacement.size == 0
        assert coordinates <= set(written("runup").variables)

    def test_picture_shows_the_rings_as_the_coordinates_say(self, model):
        # rounding of two sums over the modes
        found = runup(model)
        bearing, moved = model.bearings[0], found.record.states.displacement
        relative = moved @ model.system.relative(bearing.inner, bearing.outer).T
        expected = np.hypot(relative[:, 1], relative[:, 2])
        shown = found.plot().axes[len(model.bearings)].lines[0].get_ydata()
        np.testing.assert_allclose(shown / shown.max(), expected / expected.max(), atol=1e-9)

    @pytest.mark.slow
    def test_campbell_of_two_laws(self, model, written):
        other = assemble(model.scene, "constant:hertz")
        told, progress = counted()
        settings = CampbellSettings(sensor="S1", highest=3000.0)
        found = campbell([model, other], settings, progress, with_modes=True)
        xr.testing.assert_identical(
            found.dataset,
            written("campbell", "--law", "hertz", "--law", "constant:hertz", "--sensor", "S1", "--highest", "3 kHz"),
        )
        check_told(told, sum(entry.record.steps for entry in found.runs))
        assert found.failed == ()
        assert all(entry.modes is not None for entry in found.runs)

    @pytest.mark.slow
    @pytest.mark.parametrize("nonlinear", [False, True])
    def test_hammer(self, path, model, tmp_path, capsys, nonlinear):
        out = tmp_path / "hits.uff"
        options = ["--law", "hertz", "--hits", "2", "--duration", "50 ms", *(["--nonlinear"] if nonlinear else [])]
        assert cli.main(["hammer", str(path), *options, "-o", str(out)]) == 0
        capsys.readouterr()
        told, progress = counted()
        found = hammer(model, HammerSettings(duration=0.05, hits=2, nonlinear=nonlinear), progress)
        for ours, theirs in zip(found.hits, read_uff(out).hits, strict=True):
            # 1e-6: single precision of a universal file.
            scale = np.abs(ours.response).max()
            np.testing.assert_allclose(theirs.response, ours.response, rtol=0.0, atol=1e-6 * scale)
        assert told == ([(0, 2), (1, 2), (2, 2)] if nonlinear else [])

    def test_plan(self, path, tmp_path, capsys):
        out = tmp_path / "job.toml"
        assert cli.main(["plan", str(path), "--margin", "2", "-o", str(out)]) == 0
        capsys.readouterr()
        (job,) = plan(read_scene(str(path)), PlanSettings(margin=2.0)).jobs(["job"])
        assert job.text.strip() in out.read_text(encoding="utf-8")


def test_the_operation_goes_before_that_of_the_scene(model):
    turned = Operation(2.0 * model.scene.speed)
    for analysis in (statics, modes):
        assert analysis(model, turned).dataset.attrs["speed_rad_per_s"] == turned.speed
    asked = LsaSettings(frequencies=(50.0, 60.0), operation=turned)
    assert lsa(model, asked).dataset.attrs["speed_rad_per_s"] == turned.speed
    assert lsa(model, asked).asked == 2


def test_a_map_may_be_a_path(model, tmp_path):
    path = tmp_path / "map.nc"
    with pytest.raises(MapError, match=r"map\.nc: cannot be read"):
        assemble(model.scene, emap=path)
    (tmp_path / "job.toml").write_text(JOB)
    assert jobs_cli.main(["generate", str(tmp_path / "job.toml"), "-o", str(path), "--workers", "1"]) == 0
    for emap in (path, str(path), open_map(path)):
        assert assemble(model.scene, emap=emap).label == "formula map"


def test_models_of_one_law_need_labels(model):
    other = assemble(model.scene, "hertz", clearance=20e-6)
    with pytest.raises(InputError, match=r"models: got 2 with the labels dry Hertz, dry Hertz; allowed: .* a Case"):
        sweep([model, other])
    with pytest.raises(InputError, match=r"models: got 0 with the labels none; allowed: at least one"):
        campbell([])
    settings = SweepSettings(SweepRange(100.0, 200.0, 2))
    found = sweep([Case("tight", model, 0.0), Case("loose", other, 20e-6)], settings)
    assert found.dataset["case"].values.tolist() == ["tight", "loose"]


def test_what_a_scene_lacks_is_said(model):
    bare = dataclasses.replace(
        model,
        scene=dataclasses.replace(
            model.scene, run_up=None, sweep=None, inputs=(), sensors=(), lubricant=None, frequencies=()
        ),
    )
    for analysis, words in (
        (runup, r"\[runup\] missing; a run needs"),
        (campbell, r"\[runup\] missing; a run-up needs"),
        (sweep, r"no speeds; allowed: --speed"),
        (lsa, r"\[\[sensors\]\] missing; a linear analysis needs"),
        (hammer, r"\[\[inputs\]\] missing; a hammer test needs"),
    ):
        with pytest.raises(InputError, match=words):
            analysis(bare)
    with pytest.raises(InputError, match=r"got no \[lubricant\], which a map is made for"):
        plan(bare.scene)


class TestStopped:
    """What Ctrl-C and a failing law leave of a comparison."""

    def run(self, model, monkeypatch, error, **keywords):
        module = importlib.import_module("mbs.analyses.ramp")
        whole, calls = module.run_system, []

        def fails_second(*values, **more):
            calls.append(None)
            if len(calls) == 2:
                raise error
            return whole(*values, **more)

        monkeypatch.setattr(module, "run_system", fails_second)
        return campbell([Case(name, model, 0.0) for name in "abc"], **keywords)

    def test_stopped_it_is_raised(self, model, monkeypatch):
        with pytest.raises(KeyboardInterrupt):
            self.run(model, monkeypatch, KeyboardInterrupt())

    def test_stopped_it_keeps_what_is_done_if_it_is_asked_to(self, model, monkeypatch):
        found = self.run(model, monkeypatch, KeyboardInterrupt(), keep_partial=True)
        assert found.dataset["law"].values.tolist() == ["a"]
        assert found.failed == ("b: stopped, no result", "c: stopped, no result")

    def test_a_failing_law_leaves_the_others(self, model, monkeypatch):
        told, progress = counted()
        found = self.run(model, monkeypatch, AnalysisError("no solution"), progress=progress)
        assert found.dataset["law"].values.tolist() == ["a", "c"]
        assert found.failed == ("b: no solution",)
        check_told(told, 3 * found.runs[0].record.steps)


def test_a_scene_needs_no_file():
    scene = parse_scene(read_scene("nu308_rigid").text, "mine", "mine.toml")
    assert scene.name == "mine"
    # Both bearings carry half of the load.
    forces = statics(assemble(scene, "hertz")).dataset["bearing_force"].sum("bearing").values
    loads = sum(load.force[:3] for load in scene.loads)
    np.testing.assert_allclose(forces[1:], -loads[1:], rtol=1e-8)  # the equilibrium is found to 1e-10


def test_responses_over_a_pitch_are_those_at_each_cage_angle():
    model = assemble(read_scene("nu308_rigid"), "hertz")
    frequencies, turned = (300.0, 900.0), model.operation
    found = lsa(model, LsaSettings(frequencies, turned, cage_angles=2))
    half = np.pi / next(bearing.excitation.order for bearing in model.bearings if bearing.excitation)
    angles = [
        lsa(model, LsaSettings(frequencies, turned._replace(angle=turned.angle + by), cage_angles=1))
        for by in (0.0, half)
    ]
    data = found.dataset.sel(frequency=list(frequencies))
    sizes = []
    for one in angles:
        there = one.dataset.sel(frequency=list(frequencies))
        sizes.append(np.hypot(there["response_real"], there["response_imaginary"]).values)
    # the same linear systems, by equilibria that Newton reaches from other starts
    np.testing.assert_allclose(data["response_least"], np.min(sizes, axis=0), rtol=1e-6)
    np.testing.assert_allclose(data["response_most"], np.max(sizes, axis=0), rtol=1e-6)
    assert np.all(data["response_most"] > data["response_least"])


def test_peaks_of_a_sweep_are_those_of_a_linear_analysis_at_the_same_speed():
    """A coarse axis steps over every peak: both look between its frequencies, at the same places."""
    scene = read_scene("n1014_testrig")
    model = assemble(dataclasses.replace(scene, frequencies=tuple(np.linspace(130.0, 3030.0, 30))), "formula")
    speeds = SweepRange(150.0, 200.0, 2)
    found = sweep(model, SweepSettings(speeds)).sweeps[0].responses
    for index, speed in enumerate(speeds.speeds.tolist()):
        single = lsa(model, LsaSettings(operation=model.operation._replace(speed=speed, angle=0.0)))
        for s, i in np.ndindex(single.responses.shape[1:]):
            size = np.abs(single.responses[:, s, i])
            places = peak_places(size)
            for values, expected in (
                (found.peak_frequency, single.frequencies[places]),
                (found.peak_size, size[places]),
            ):
                there = values[index, :, s, i]
                # equilibria from other starts; a sum over modes beside direct solutions
                np.testing.assert_allclose(there[np.isfinite(there)], expected, rtol=1e-5)
    assert np.nanmax(found.peak_size[:, :, 0, 0]) > 1.1 * np.abs(found.values[:, :, 0, 0]).max()
