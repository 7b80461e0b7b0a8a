"""Results whose own checks failed so grossly that their figures mean nothing."""

from __future__ import annotations

import dataclasses
from importlib import resources
from types import SimpleNamespace

import pytest

from mbs import assemble, lsa, modes, parse_scene, read_scene, runup, statics, sweep
from mbs.analyses.lsa import LsaSettings
from mbs.analyses.soundness import Judged, findings_in_run
from mbs.analyses.sweep import SweepSettings
from mbs.model.findings import Cause, Finding
from mbs.scene.changes import with_loads
from mbs.settings import SweepRange

SCENE = "nu308_rigid"
TEXT = (resources.files("mbs") / "systems" / f"{SCENE}.toml").read_text(encoding="utf-8")


def model(factor=1.0, law="hertz", name=SCENE):
    return assemble(with_loads(read_scene(name), factor), law)


@pytest.mark.parametrize("rollers", ["massless", "bodies"])
def test_a_load_that_no_contact_carries_is_told_by_every_analysis(rollers):
    """1e4 times 141 N: 7 GPa are the hardness of the steel. At 1e3 times it the figures are those of an overload."""
    scene = parse_scene(TEXT.replace('profile = "iso"', f'rollers = "{rollers}"\nprofile = "iso"'), "a", "a.toml")
    crushed, heavy = (assemble(with_loads(scene, factor), "hertz") for factor in (1e4, 1e3))
    for found in (statics(crushed), modes(crushed), lsa(crushed, LsaSettings((50.0, 500.0)))):
        assert [entry.cause for entry in found.findings] == [Cause.PRESSURE, Cause.OVERLOAD] * 2
        assert "bearing_left: Hertz pressure of " in found.dataset.attrs["unsound"]
        assert "above 7 GPa, the hardness of bearing steel, which no contact carries" in found.dataset.attrs["unsound"]
    sound = statics(heavy)
    assert [entry.cause for entry in sound.findings] == [Cause.OVERLOAD] * 2 and "unsound" not in sound.dataset.attrs


def run_of(outside=0, residual=0.0, iterations=1000):
    energy = SimpleNamespace(relative_residual=residual)
    return SimpleNamespace(
        forces=(), motions=(), energy=energy, outside={"bearing_left": outside}, iterations=iterations
    )


def test_runs_say_what_failed():
    plain = model()
    assert findings_in_run(plain, run_of(outside=400, residual=0.09)) == ()
    (energy,) = findings_in_run(plain, run_of(residual=1.6))
    words = "1.6e+02 % of the energy that went through the run is missing or too much (allowed: 10 %)"
    assert energy == Finding(Cause.ENERGY, words, excess=16.0)
    (outside,) = findings_in_run(plain, run_of(outside=720))
    assert outside.cause is Cause.OUTSIDE and outside.told.startswith("bearing_left: 72 % of the calls lie outside")


def test_a_run_under_a_load_that_no_contact_carries():
    crushed = model(1e4)
    course = dataclasses.replace(crushed.scene.run_up, duration=1e-3)
    found = runup(crushed, course)
    assert Cause.PRESSURE in [entry.cause for entry in found.findings] and found.steps is None
    assert "unsound" in found.dataset.attrs


def test_words_of_several_cases_have_their_label():
    reasons = (Finding(Cause.ENERGY, "one"), Finding(Cause.OUTSIDE, "two", "left"), Finding(Cause.SLIDING, "three"))
    both = Judged([("Hertz", reasons), ("map", reasons[2:])])
    assert both.first == ["error: Hertz: the figures below mean nothing: one; left: two"] and both.status == 1
    assert both.last == ["note: Hertz: three", "note: map: three"]
    marked = both.marked(sweep(model(), SweepSettings(SweepRange(30.0, 60.0, 2))).dataset)
    assert marked.attrs["unsound"] == "Hertz: one; Hertz: left: two"
    assert marked.attrs["notes"] == "Hertz: three\nmap: three"
    one = Judged([("Hertz", reasons[2:])])
    assert (one.first, one.last, one.status) == ([], ["note: three"], 0)
