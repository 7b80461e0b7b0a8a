"""Error of a run by its step: going on from a mark, what is estimated beside the truth, where nothing is."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from ehdmaps.errors import InputError
from mbs import assemble, parse_scene, read_scene, runup
from mbs.analyses.campbell import campbell
from mbs.analyses.step_error import FEWEST, NOTABLE, PART, PARTS, SWINGING_IN, _compared, step_check, up_to
from mbs.model.drive import DrivenSpeed
from mbs.scene.changes import with_duration, with_step
from mbs.settings import CampbellSettings
from mbs.transient.run import Options
from mbs.transient.run import run as run_system
from tests.cases.swinging import SWINGING

KEPT = Options(every_step=True, marks=True)


@pytest.fixture(scope="module")
def swinging():
    return parse_scene(SWINGING, "swinging", "swinging.toml")


def ran(scene, step, law="hertz"):
    """The scene's run with a step, and a mark to go on from."""
    return runup(assemble(with_step(scene, step), law))


class TestMarks:
    @pytest.mark.parametrize("compiled", [True, False])
    def test_going_on_with_the_same_step_is_the_same_run(self, swinging, compiled):
        model = assemble(with_duration(swinging, 0.1), "hertz")
        course, options = model.scene.run_up, dataclasses.replace(KEPT, compiled=compiled)
        given = (model.system, course.speed, course.duration, course.settings, model.scene.sensors)
        whole = run_system(*given, options=options)
        assert [mark.time for mark in whole.marks] == pytest.approx(np.linspace(0.0, 0.1, 101))
        again = run_system(model.system, course.speed, 0.02, *given[3:], options=options, begin=whole.marks[40])
        assert again.time == pytest.approx(whole.time[2000:3001])
        assert again.angle == pytest.approx(whole.angle[2000:3001])
        # Round-off of modal coordinates there and back.
        size = np.max(np.abs(whole.signals))
        assert np.max(np.abs(again.signals - whole.signals[2000:3001])) < 1e-9 * size
        assert again.energy.relative_residual == pytest.approx(0.0, abs=1e-6)

    @pytest.mark.slow
    def test_films_with_memory_go_on_as_they_were(self):
        scene = with_duration(read_scene("nu308_rigid"), 0.05)
        whole = runup(assemble(scene, "formula"))
        course, model = whole.course, whole.model
        mark = next(mark for mark in whole.record.marks if mark.time > 0.0399)
        again = run_system(
            model.system, course.speed, 0.004, course.settings, model.scene.sensors, options=KEPT, begin=mark
        )
        before = whole.record.signals[2000:2201]
        # Tables of the law are blended between other speeds: 1e-6 of the signal.
        assert np.max(np.abs(again.signals - before)[:, 0]) < 1e-5 * np.std(before[:, 0])

    def test_nothing_is_kept_that_was_not_asked_for(self, swinging):
        model = assemble(with_duration(swinging, 0.01), "hertz")
        course = model.scene.run_up
        assert run_system(model.system, course.speed, course.duration, course.settings).marks == ()

    def test_a_drive_has_a_state_of_its_own(self):
        model = assemble(read_scene("overhung_rotor"), "hertz")
        course = model.scene.run_up
        assert isinstance(course.speed, DrivenSpeed)
        whole = run_system(model.system, course.speed, 0.01, course.settings, options=KEPT)
        with pytest.raises(
            InputError, match=r"run, begin: got a mark beside a speed by torques, .*; allowed: a prescribed"
        ):
            run_system(model.system, course.speed, 0.01, course.settings, begin=whole.marks[0])


class TestEstimate:
    @pytest.mark.parametrize("step", [4e-5, 1.6e-4])
    def test_it_is_as_large_as_the_error_of_a_swinging_mass(self, swinging, step):
        coarse, fine = ran(swinging, step), ran(swinging, step / 8.0)
        levels = [20.0 * np.log10(np.std(entry.record.signals, axis=0)) for entry in (coarse, fine)]
        true = np.abs(levels[0] - levels[1])
        # An estimate, of single parts: a third to three times, of errors of 0.1 to 10 dB.
        assert coarse.steps.largest / true == pytest.approx(1.0, abs=2.0)
        assert np.all(coarse.steps.largest > true / 3.0)

    def test_it_stands_in_the_results(self, swinging):
        found = ran(swinging, 8e-5)
        assert found.dataset["step_error"].dims == ("sensor",)
        assert found.dataset["step_error"].attrs["units"] == "dB"
        assert found.dataset["step_error"].values == pytest.approx(found.steps.largest)
        looked = campbell(assemble(swinging, "hertz"), CampbellSettings(sensor="S1", highest=2000.0))
        assert looked.dataset["step_error"].values == pytest.approx(looked.runs[0].steps.largest)

    def test_it_costs_a_tenth_of_the_run(self, swinging):
        steps = round(1.0 / 2e-5)
        found = ran(swinging, 2e-5).steps
        # Twice the step makes half as many.
        assert len(found.speeds) == PARTS
        assert 0.5 * len(found.speeds) * round(found.duration / found.step) <= 0.1001 * steps
        assert found.duration == pytest.approx(max(PART * steps, FEWEST) * found.step)

    def test_parts_lie_in_all_of_the_run_and_not_at_its_start(self, swinging):
        found = ran(swinging, 2e-5).steps
        first, last = swinging.run_up.speed.at(0.0)[0], swinging.run_up.speed.at(1.0)[0]
        places = (np.array(found.speeds)[:, 0] - first) / (last - first)
        assert places.min() >= SWINGING_IN
        # One in each eighth, to a mark.
        assert np.floor(PARTS * (places + 1e-3)).tolist() == pytest.approx(np.arange(PARTS), abs=1.0)
        assert len(set(places)) == PARTS

    def test_signals_that_have_nothing_in_common_have_no_order(self):
        rng = np.random.default_rng(1)
        one, other = rng.standard_normal((4000, 1)), 2.0 * rng.standard_normal((4000, 1))
        *_, errors, growing = _compared(one, other, np.array([1e-9]))
        # All of the change of 6.02 dB, to what 3000 random numbers leave: 3 % or 0.3 dB.
        assert errors == pytest.approx(6.02, abs=0.3) and not growing.any()
        *_, errors, _ = _compared(one, 1.1 * one, np.array([1e-9]))
        assert errors == pytest.approx(20.0 * np.log10(1.1) / 3.0)

    def test_steps_that_are_too_long_are_warned_of(self):
        """A dry spindle: over its whole run-up S2 has 0.081 m/s2 with steps of 20 us, and 0.104 with 5 us."""
        scene = with_duration(read_scene("n1014_testrig"), 0.1)
        long, short = ran(scene, 2e-5).steps, ran(scene, 2.5e-6).steps
        assert not long.converged and long.largest.max() > NOTABLE > short.largest.max() and short.converged
        (line,) = long.lines
        beginnings = (
            f"warning: this run {words} converged with steps of 20 us: " for words in ("is not", "may not be")
        )
        assert line.startswith(tuple(beginnings))
        assert " dB off at " in line and "with twice the step" in line
        assert line.endswith("take shorter steps in [runup], or --tolerance")
        (line,) = short.lines
        assert (
            line.startswith("estimated error of the step of 2.5 us: S1 ")
            and "by twice the step in 8 parts of 2.5 ms" in line
        )

    def test_signals_that_still_come_apart_have_an_error_of_at_least_that(self):
        """Dry rollers without damping: two runs drift apart for as long as they last."""
        found = ran(with_duration(read_scene("nu308_rigid"), 0.1), 1e-5).steps
        assert found.growing[:, 0].any()
        (line,) = found.lines
        assert "up to" in line and "signals still come apart at the end of a part" in line

    def test_a_sensor_that_is_loud_only_as_it_swings_in_is_not_judged(self, swinging):
        found = ran(swinging, 8e-5)
        loud_at_first = found.record.signals * np.where(found.record.signal_time < 0.05, 100.0, 1.0)[:, None]
        record = dataclasses.replace(found.record, signals=loud_at_first)
        check = step_check(found.model, found.course, record)
        # Its 20 dB on both sides are the same.
        np.testing.assert_array_equal(check.by_level, 0.0)
        assert check.lines[0].startswith(
            "estimated error of the step of 80 us: S1 not judged, 20 dB below its swinging in; by twice the step"
        )

    def test_where_nothing_can_be_compared_nothing_is_said(self, swinging):
        found = ran(with_duration(swinging, 0.02), 2e-5)
        model, course, record = found.model, found.course, found.record
        assert step_check(model, course, record) is not None
        assert step_check(model, course, dataclasses.replace(record, marks=())) is None
        deaf = dataclasses.replace(model, scene=dataclasses.replace(model.scene, sensors=()))
        assert step_check(deaf, course, record) is None
        adapting = dataclasses.replace(course, settings=dataclasses.replace(course.settings, tolerance=1e-9))
        assert step_check(model, adapting, record) is None

    def test_what_lies_above_the_highest_frequency_does_not_count(self):
        times = np.arange(1000) * 1e-4
        slow, fast = (np.sin(2.0 * np.pi * f * times)[:, None] for f in (100.0, 3000.0))
        # Both have whole periods, so that the line from end to end is short of none by a sample's change at the ends.
        off = np.abs(up_to(slow + fast, 1e-4, 1000.0) - slow)
        assert off.max() < 0.7 * np.abs(slow[-1] + fast[-1])[0]
        assert off[100:-100].max() < 1e-2
        assert up_to(fast, 1e-4, 1e6) is fast
