"""A tolerance instead of settings: what trials and runs choose and confirm, where they could not, what is refused."""

from __future__ import annotations

import argparse
import dataclasses
import importlib

import numpy as np
import pytest

from ehdmaps.errors import InputError
from mbs import parse_scene, read_scene
from mbs.analyses.campbell import campbell
from mbs.analyses.sensors import looked_at
from mbs.laboratory.tradeoff.ramp_parts import WINDOWS, ramp_of
from mbs.model.profiles import Advanced, Course, Harmonic, SpeedProfile
from mbs.planning import tolerance as tolerance_module
from mbs.planning.tolerance import Numerics, read_tolerance
from mbs.scene import changes
from mbs.scene.subject import LawChoice, Subject
from tests.cases.swinging import SWINGING

DRY = LawChoice("dry", "hertz")
DAMPED = LawChoice("damped", "hertz:1.25e-5 s")


def run(subject):
    """The run-up of a subject, and the errors that it states."""
    found = campbell(subject.model())
    return found, found.runs[0].steps


def within(subject, tolerance):
    """What is chosen; the run is passed over."""
    return tolerance_module.within(subject, tolerance, run)[0]


@pytest.fixture(scope="module")
def swinging():
    return parse_scene(SWINGING, "swinging", "swinging.toml")


class TestReading:
    @pytest.mark.parametrize("text", ["0 dB", "-1 dB", "nan dB", "nan", "1 %", "21 dB", "1", "dB", "", "1 dB x"])
    def test_what_is_no_tolerance_is_refused(self, text):
        with pytest.raises(InputError, match=r"got .*; allowed: above 0 dB, from 0.01 dB up to 20 dB, such as '1 dB'"):
            read_tolerance(text)

    def test_with_and_without_a_space(self):
        assert read_tolerance("1dB") == read_tolerance(" 1 dB ") == 1.0

    def test_within_refuses_too(self, swinging):
        with pytest.raises(InputError, match="tolerance: got nan dB"):
            within(Subject(swinging, DRY), float("nan"))


class TestParts:
    def test_a_part_of_a_run_has_its_speeds_and_loads(self, swinging):
        part = changes.with_part(swinging, 0.25, 0.5)
        assert part.run_up.duration == 0.25
        # Round-off of an interpolation.
        assert part.run_up.speed.at(0.1)[0] == pytest.approx(swinging.run_up.speed.at(0.35)[0], rel=1e-12)
        assert part.loads[0].profile(0.1) == pytest.approx(swinging.loads[0].profile(0.35), rel=1e-12)
        assert changes.with_part(swinging, 0.0, 0.5).loads[0].profile is swinging.loads[0].profile

    def test_speeds_between_given_ones_are_kept(self):
        speed = SpeedProfile(Course((0.0, 1.0, 2.0), (0.0, 10.0, 0.0))).part(0.5, 1.5)
        assert speed.course == Course((0.0, 0.5, 1.0), (5.0, 10.0, 5.0))
        assert Advanced(Harmonic(1.0), 0.25)(0.0) == pytest.approx(1.0)

    def test_parts_follow_each_other_and_start_a_window_before(self, swinging):
        model = Subject(swinging, DRY).model()
        ramp = ramp_of(model, swinging.campbell, looked_at(swinging, swinging.campbell))
        assert ramp.parts[0].start == ramp.parts[0].begin == 0.0
        for before, after in zip(ramp.parts[:-1], ramp.parts[1:], strict=True):
            assert after.begin == pytest.approx(before.end)
            assert after.begin - after.start == pytest.approx(ramp.window)
        assert ramp.parts[0].end == pytest.approx(WINDOWS * ramp.window)
        # 2.5 samples a period at 2 kHz allow 200 us; 20 us doubled three times.
        assert ramp.coarsest == pytest.approx(160e-6)


class TestCutoff:
    def test_modes_are_left_out_as_by_a_lower_cutoff(self):
        gearbox = read_scene("gearbox")
        less = changes.with_cutoff(gearbox, 5000.0)
        sizes = [Subject(scene, DRY).model().system.size for scene in (gearbox, less)]
        # 54 and 36 coordinates of the housing with 38 and 15 modes; shafts reduced to fewer modes, too.
        assert sizes[0] == 84
        housing = Subject(less, DRY).model().system.bodies[2]
        assert len(housing.coordinates) == 54 - 38 + 15
        assert sizes[1] < 84 - 22

    def test_more_modes_than_a_file_has_are_refused_where_nothing_can_follow(self):
        scene = read_scene("gearbox")
        stiff = dataclasses.replace(scene, bodies=[scene.bodies[2]])
        with pytest.raises(InputError, match="allowed: up to 7853 Hz, the highest mode of the reduced files"):
            changes.with_cutoff(stiff, 9000.0)
        with pytest.raises(InputError, match="no flexible body with a cut-off"):
            changes.with_cutoff(read_scene("nu308_rigid"), 9000.0)


class TestHurried:
    def test_a_hurried_run_has_all_speeds_in_a_part_of_the_time(self, swinging):
        trial = changes.hurried(swinging, 1.0 / 16.0)
        assert trial.run_up.duration == pytest.approx(0.0625)
        assert trial.run_up.speed.at(0.03125)[0] == pytest.approx(swinging.run_up.speed.at(0.5)[0], rel=1e-9)
        assert trial.run_up.settings.sample == swinging.run_up.settings.step

    def test_a_drive_is_followed_by_its_torques_alone(self):
        rotor = read_scene("overhung_rotor")
        trial = changes.hurried(rotor, 0.5)
        assert type(trial.run_up.speed) is SpeedProfile
        at = 0.4 * rotor.run_up.duration
        # Between points of the course.
        assert trial.run_up.speed.at(0.5 * at)[0] == pytest.approx(rotor.run_up.speed.at(at)[0], rel=1e-6)


class TestChoosing:
    @pytest.mark.slow
    def test_what_is_chosen_keeps_the_tolerance_on_the_whole_ramp(self, swinging):
        subject = Subject(changes.with_step(swinging, 80e-6), DRY)
        found, result = tolerance_module.within(subject, 0.5, run)
        assert found.met
        assert found.confirmed <= 0.5
        assert found.numerics.slices is found.numerics.cutoff is None
        assert "chosen: step" in "\n".join(found.lines)
        finest = Numerics(5e-6, None, None).applied(subject)
        coarse, fine = result.runs[0].spectra[0].campbell, run(finest)[0].runs[0].spectra[0].campbell
        levels = np.interp(coarse.speeds, fine.speeds, fine.sum_level)
        # The tolerance itself, which is of 95 % of the windows.
        assert np.quantile(np.abs(levels - coarse.sum_level), 0.95) <= 0.5

    def test_the_settings_of_the_scene_stay_where_they_do(self, swinging):
        found = within(Subject(swinging, DRY), 10.0)
        assert found.met and found.numerics.step == 20e-6
        text = "\n".join(found.lines)
        assert "chosen: step 20 us, as the scene has it" in text
        assert (
            "confirmed by the run, its sum level of S1 up to 2000 Hz, at equal speed in 95 % of windows of 25 ms"
            in text
        )
        assert "trials" not in text  # there are no slices

    @pytest.mark.slow
    def test_a_run_that_does_not_confirm_is_made_again(self, swinging):
        subject, steps = Subject(swinging, DRY), []

        def doubtful(changed):
            found, check = run(changed)
            steps.append(changed.scene.run_up.settings.step)
            return found, dataclasses.replace(check, by_level=check.by_level * 0.0 + (3.0, 2.1, 0.3)[len(steps) - 1])

        found, _ = tolerance_module.within(subject, 2.0, doubtful)
        assert found.met and steps == [20e-6, 10e-6, 5e-6] and found.numerics.step == 5e-6
        assert found.confirmed == pytest.approx(0.3)
        assert "step 20 us: 3 dB by the run, so that it is made again" in "\n".join(found.lines)

    @pytest.mark.slow
    def test_a_shorter_step_that_brings_nothing_is_the_last(self, swinging):
        steps = []

        def doubtful(changed):
            found, check = run(changed)
            steps.append(changed.scene.run_up.settings.step)
            return found, dataclasses.replace(check, by_level=check.by_level * 0.0 + 9.0)

        found, _ = tolerance_module.within(Subject(swinging, DRY), 2.0, doubtful)
        assert not found.met and steps == [20e-6, 10e-6]
        assert "no shorter one is tried" in "\n".join(found.lines)
        assert "does not forget its start" in "\n".join(found.lines)

    def test_a_run_without_an_error_confirms_nothing(self, swinging):
        found, _ = tolerance_module.within(Subject(swinging, DRY), 10.0, lambda changed: (run(changed)[0], None))
        assert not found.met and np.isnan(found.confirmed)
        assert "could not: the run does not confirm it" in "\n".join(found.lines)

    def test_where_no_step_is_short_enough_it_says_so(self, swinging):
        errors = iter((9.0, 5.0, 3.0, 2.0))

        def doubtful(changed):
            found, check = run(changed)
            return found, dataclasses.replace(check, by_level=check.by_level * 0.0 + next(errors))

        found, _ = tolerance_module.within(Subject(changes.with_step(swinging, 160e-6), DRY), 1.0, doubtful)
        assert not found.met and found.numerics.step == 20e-6
        assert "could not: the sum level still changes too much by step 20 us" in "\n".join(found.lines)

    @pytest.mark.slow
    def test_a_shorter_step_is_no_cure_for_slices(self, monkeypatch):
        """Levels that still change with the most slices are told after one run, not sought by ever shorter steps."""
        monkeypatch.setattr(tolerance_module, "MOST_SLICES", 81)
        runs = []

        def counted(changed):
            runs.append(changed)
            return run(changed)

        found, _ = tolerance_module.within(Subject(read_scene("nu308_rigid"), DAMPED), 3.0, counted)
        assert not found.met and len(runs) == 1
        assert found.numerics.step == Numerics.of(read_scene("nu308_rigid")).step
        assert "could not: the sum level still changes too much by slices" in "\n".join(found.lines)

    @pytest.mark.slow
    def test_few_slices_are_doubled(self, monkeypatch):
        """Trials with 3 and 5 slices are 20 dB apart, those with 5 and 9 a fifth of one: 5 are taken, and run."""
        found_by = {3: 1.0, 5: 10.0, 9: 10.2}
        monkeypatch.setattr(
            tolerance_module._Trials, "sizes", lambda self, numerics: np.full((40, 1), found_by[numerics.slices])
        )
        scene = changes.with_slices(changes.with_duration(read_scene("nu308_rigid"), 0.2), 3)
        runs = []

        def counted(changed):
            runs.append(changed.scene.bearings[0].slices)
            return run(changed)

        found, _ = tolerance_module.within(Subject(scene, DAMPED), 20.0, counted)
        assert found.met and found.numerics.slices == 5 and runs == [3, 5]
        assert "  3 slices: 27 dB" in "\n".join(found.lines)


class TestCommand:
    def test_it_runs_with_what_it_chose_and_says_so(self, tmp_path):
        scene = tmp_path / "swinging.toml"
        scene.write_text(SWINGING.replace('"1 s"', '"0.5 s"'))
        names = (
            "law",
            "bands",
            "map",
            "films",
            "supply",
            "clearance",
            "structural_law",
            "output",
            "plot",
            "waterfall",
            "highest",
            "window",
            "sensor",
            "bands",
        )
        given = argparse.Namespace(**dict.fromkeys(names), scene=str(scene), tolerance="20 dB", modes=False, workers=1)
        given.load_factor = given.start_angle = given.executor = None
        text, status = importlib.import_module("mbs.commands.campbell").run(given)
        assert status == 0
        assert "tolerance 20 dB of the sum level of S1" in text
        assert "chosen: step" in text
        for tolerance, problem in (("1 %", "--tolerance: got '1 %'"), ("1 dB", "--tolerance: got 2 combinations")):
            given.tolerance, given.law = tolerance, ["hertz", "hertz:1.25e-5 s"]
            with pytest.raises(InputError) as caught:
                importlib.import_module("mbs.commands.campbell").run(given)
            assert any(problem in one for one in caught.value.problems)

    def test_a_run_up_keeps_a_tolerance_too(self, tmp_path, monkeypatch):
        asked = []

        def answer(subject, tolerance, run, settings, progress):
            asked.append(tolerance)
            numerics = Numerics(1e-5, None, None)
            chosen = numerics.applied(subject)
            return tolerance_module.Tolerated(chosen, numerics, ("chosen",), True, 0.3), run(chosen)[0]

        monkeypatch.setattr("mbs.planning.tolerance.within", answer)
        scene = tmp_path / "swinging.toml"
        text = SWINGING.replace('"1 s"', '"0.05 s"').replace('step = "20 us"', 'step = "20 us"\nsample = "0.1 ms"')
        scene.write_text(text)
        given = argparse.Namespace(
            scene=str(scene), tolerance="20 dB", workers=1, output=None, plot=None, executor=None
        )
        runup = importlib.import_module("mbs.commands.runup").run
        text, status = runup(given)
        assert status == 0 and asked == [20.0]
        assert "chosen\n" in text and "in 0.05 s: 5000 steps" in text
        assert "estimated error of the step of 10 us: S1 " in text
        given.tolerance = "1 %"
        with pytest.raises(InputError, match=r"--tolerance: got '1 %'; allowed: above 0 dB"):
            runup(given)
        given.tolerance, given.law = "1 dB", ["hertz", "hertz:1.25e-5 s"]
        with pytest.raises(InputError, match="--tolerance: got 2 combinations of laws"):
            runup(given)
