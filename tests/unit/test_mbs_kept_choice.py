"""A choice of step, slices and cut-off that is kept: taken again for the same question, and for no other one."""

from __future__ import annotations

import argparse
import dataclasses
import importlib
import math

import pytest

from ehdmaps.errors import InputError
from ehdmaps.maps.emap import EHDMap, open_map
from ehdmaps.maps.schema import CHECKSUM
from mbs import parse_scene
from mbs.instruments import kept_choice
from mbs.instruments.kept_choice import choice_key
from mbs.instruments.tolerance import Numerics, Tolerated
from mbs.scene.changes import with_step
from mbs.scene.choices import LawChoice, Subject
from tests.cases.swinging import SWINGING

DRY = LawChoice("dry", "hertz")


def kept_within(subject, tolerance):
    """What is chosen, with a run that tells its step."""
    tolerated, step = kept_choice.kept_within(
        subject, tolerance, lambda changed: (changed.scene.run_up.settings.step, None)
    )
    assert step == tolerated.numerics.step
    return tolerated


@pytest.fixture
def subject():
    return Subject(parse_scene(SWINGING, "swinging", "swinging.toml"), DRY)


@pytest.fixture
def trials(monkeypatch, tmp_path):
    """Questions that were asked, each answered by a step of 10 us; choices are kept in a folder of the test."""
    asked = []

    def answer(subject, tolerance, run, settings=None, progress=None):
        asked.append(tolerance)
        numerics = Numerics(1e-5, None, None)
        chosen = numerics.applied(subject)
        return Tolerated(chosen, numerics, ("chosen",), True, 0.3, 5.0), run(chosen)[0]

    monkeypatch.setattr(kept_choice, "within", answer)
    monkeypatch.setenv("EHDMAPS_CHOICES", str(tmp_path / "choices"))
    return asked


def test_the_second_time_nothing_is_tried(subject, trials):
    first, second = kept_within(subject, 1.0), kept_within(subject, 1.0)
    assert trials == [1.0]
    assert first.lines == ("chosen",)
    assert second.lines[0] == "chosen" and second.lines[1].startswith("  chosen before, and kept for this scene, law ")
    assert second.numerics == first.numerics and second.met and second.confirmed == 0.3
    assert first.seconds == 5.0 and second.seconds == 0.0
    assert second.subject.scene.run_up.settings.step == 1e-5


def test_another_question_is_another_choice(subject, trials):
    settings = subject.scene.campbell
    key = choice_key(subject, 1.0, settings)
    assert key == choice_key(Subject(parse_scene(SWINGING, "other", "elsewhere.toml"), DRY), 1.0, settings)
    shaken = parse_scene(SWINGING.replace("1.05 kHz", "1.06 kHz"), "swinging", "swinging.toml")
    others = [
        choice_key(subject, 2.0, settings),
        choice_key(subject, 1.0, dataclasses.replace(settings, highest=1500.0)),
        choice_key(dataclasses.replace(subject, law=LawChoice("damped", "hertz:1.25e-5 s")), 1.0, settings),
        choice_key(dataclasses.replace(subject, clearance=1e-5), 1.0, settings),
        choice_key(dataclasses.replace(subject, scene=with_step(subject.scene, 1e-5)), 1.0, settings),
        choice_key(dataclasses.replace(subject, scene=shaken), 1.0, settings),
    ]
    assert len({key, *others}) == 7


def test_what_cannot_be_read_or_written_is_chosen_again(subject, trials, tmp_path, monkeypatch):
    kept_within(subject, 1.0)
    (place,) = (tmp_path / "choices").iterdir()
    for text in ("{", "[]", '{"step": 1e-5}', '{"step": "x", "slices": null, "cutoff": null}'):
        place.write_text(text)
        assert kept_within(subject, 1.0).lines == ("chosen",)
    assert len(trials) == 5
    monkeypatch.setenv("EHDMAPS_CHOICES", str(place))  # a file, and no folder
    assert kept_within(subject, 1.0).met and kept_within(subject, 1.0).met
    assert len(trials) == 7


def test_a_choice_without_confirmation_is_kept_too(subject, trials, monkeypatch):
    numerics = Numerics(2e-5, None, None)
    unmet = Tolerated(numerics.applied(subject), numerics, ("could not",), False, math.nan, 1.0)
    monkeypatch.setattr(kept_choice, "within", lambda *_: (unmet, 2e-5))
    kept_within(subject, 1.0)
    found = kept_within(subject, 1.0)
    assert found.seconds == 0.0 and not found.met and math.isnan(found.confirmed)


@pytest.mark.parametrize(
    ("content", "problem"),
    [(lambda: 0, "got function, whose content cannot be told"), (object(), "got object, whose content cannot be told")],
)
def test_what_has_no_content_is_not_kept(subject, trials, content, problem):
    odd = dataclasses.replace(subject, clearance=content)
    with pytest.raises(TypeError, match=problem):
        choice_key(odd, 1.0, subject.scene.campbell)


def test_values_without_an_end_and_maps_without_a_checksum_are_not_kept(subject, formula_map):
    settings = subject.scene.campbell
    endless = []
    endless.append(endless)
    with pytest.raises(TypeError, match="got values within each other that have no end"):
        choice_key(dataclasses.replace(subject, clearance=endless), 1.0, settings)
    emap = open_map(formula_map)
    assert choice_key(dataclasses.replace(subject, clearance=emap), 1.0, settings)
    unsigned = emap.dataset.copy()
    unsigned.attrs = {name: text for name, text in unsigned.attrs.items() if name != CHECKSUM}
    bare = EHDMap(unsigned)
    with pytest.raises(TypeError, match="got a map without a checksum"):
        choice_key(dataclasses.replace(subject, clearance=bare), 1.0, settings)


def test_a_run_up_keeps_a_tolerance_too(tmp_path, trials):
    scene = tmp_path / "swinging.toml"
    text = SWINGING.replace('"1 s"', '"0.05 s"').replace('step = "20 us"', 'step = "20 us"\nsample = "0.1 ms"')
    scene.write_text(text)
    given = argparse.Namespace(scene=str(scene), tolerance="20 dB", workers=1, output=None, plot=None)
    runup = importlib.import_module("mbs.commands.runup").run
    text, status = runup(given)
    assert status == 0 and trials == [20.0]
    assert "chosen\n" in text and "in 0.05 s: 5000 steps" in text
    assert "estimated error of the step of 10 us: S1 " in text
    text, status = runup(given)
    assert "chosen before, and kept" in text and trials == [20.0]
    given.tolerance = "1 %"
    with pytest.raises(InputError, match=r"--tolerance: got '1 %'; allowed: above 0 dB"):
        runup(given)
    given.tolerance, given.law = "1 dB", ["hertz", "hertz:1.25e-5 s"]
    with pytest.raises(InputError, match="--tolerance: got 2 combinations of laws"):
        runup(given)
