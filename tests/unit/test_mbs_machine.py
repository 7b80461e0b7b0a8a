"""Verdicts on what a scene file switches: their sizes beside equilibria with films, and which analysis has them."""

from __future__ import annotations

import dataclasses
import math
from importlib import resources

import numpy as np
import pytest

from mbs import AutoSettings, assemble, automatic, parse_scene, read_scene, statics
from mbs.planning.machine import machine_verdicts
from mbs.planning.plan import plan
from mbs.planning.question import at_one_speed, in_time
from mbs.planning.verdicts import Verdict, visited
from mbs.scene.scene import Scene
from mbs.scene.specs import FlexibleSpec
from tests.cases.commands import run

THERMAL = 'thermal = { inner_ring = "70 degC", outer_ring = "60 degC" }\n'


def judged(scene: Scene, frequency: float = 0.0) -> dict[str, Verdict]:
    """Verdicts by their names."""
    found = plan(scene)
    ranges = [visited(needed, scene.lubricant, 0.05) for needed in found.needed]
    return {verdict.physics: verdict for verdict in machine_verdicts(found, ranges, frequency, True)}


def stiffness(scene: Scene) -> np.ndarray:
    """k of each bearing along its load, with films of the film table."""
    balance = statics(assemble(scene, "table", films="slow")).balance
    found = []
    for index, _ in enumerate(scene.bearings):
        along = balance.forces[index][1:3] / np.linalg.norm(balance.forces[index][1:3])
        found.append(along @ balance.element_stiffness[index][1:3, 1:3] @ along)
    return np.array(found)


EVERY = {"centrifugal load", "slices", "coupled slices", "ring temperatures and fits", "structural law"}


@pytest.mark.parametrize("name", ["nu308_rigid", "n1014_rigid", "nu2210_shaft"])
def test_sizes_are_those_of_equilibria_with_films(name):
    """Dry contacts stand in for films: within a factor of two, above what no tolerance asks for."""
    scene = at_one_speed(read_scene(name))
    scene = scene.with_bearings(
        dataclasses.replace(entry, rollers_as_bodies=False, centrifugal=False) for entry in scene.bearings
    )
    verdicts, plain = judged(scene), stiffness(scene)

    def warm(entry):
        less = entry.geometry.diametral_clearance - 11.7e-6 * 10.0 * entry.geometry.pitch_diameter
        return dataclasses.replace(entry, geometry=dataclasses.replace(entry.geometry, diametral_clearance=less))

    for physics, changed in (
        ("slices", lambda entry: dataclasses.replace(entry, slices=1)),
        ("ring temperatures and fits", warm),
    ):
        full = np.max(np.abs(stiffness(scene.with_bearings(map(changed, scene.bearings))) / plain - 1.0))
        assert full / 2.0 < verdicts[physics].size < 2.0 * full, physics


def test_what_cannot_matter_to_an_analysis_has_no_verdict():
    gearbox = read_scene("gearbox")
    at_rest, linear, run_up = (
        judged(at_one_speed(gearbox)),
        judged(at_one_speed(gearbox), 5e3),
        judged(in_time(gearbox), 5e3),
    )
    assert set(at_rest) == EVERY | {"flexible housing", "not decided"}
    assert set(linear) == set(at_rest) | {"rollers as bodies"}
    assert set(run_up) == set(linear) | {"gear mesh excitation"}
    assert run_up["gear mesh excitation"].on and run_up["gear mesh excitation"].size > 0.05
    # centrifugal loads go with the square of the speed: 2500 rpm of the run-up beside 1500 rpm
    ratio = run_up["centrifugal load"].size / at_rest["centrifugal load"].size
    assert 2.0 < ratio < (2500.0 / 1500.0) ** 2 * 1.2


def test_what_the_scene_has_is_said_with_the_key_that_switches_it():
    scene = at_one_speed(read_scene("nu308_rigid"))
    first, *others = scene.bearings
    some = scene.with_bearings([dataclasses.replace(first, centrifugal=True, rollers_as_bodies=True), *others])
    plain, mixed = judged(scene, 5e3), judged(some, 5e3)
    assert plain["centrifugal load"].line.startswith(
        "centrifugal load: off, as the scene has it; it changes k or c of a bearing"
    )
    assert mixed["centrifugal load"].line.startswith("centrifugal load: on, in 1 of 2 bearings, as the scene has it; ")
    assert mixed["rollers as bodies"].on and mixed["rollers as bodies"].words.endswith("; rollers in [[bearings]]")
    assert math.isnan(plain["flexible housing"].size) and "[[flexible]] has it" in plain["flexible housing"].words
    assert plain["not decided"].on is None and plain["not decided"].line.startswith(
        "not decided: clearance (as stated; "
    )


def test_a_housing_that_gives_way_is_told_by_its_part():
    gearbox = at_one_speed(read_scene("gearbox"))
    verdict = judged(gearbox)["flexible housing"]
    assert any(isinstance(body, FlexibleSpec) for body in gearbox.bodies)
    assert verdict.on and 0.0 < verdict.size < 1.0 and verdict.words.startswith("housing gives way by ")


def test_coupled_slices_have_slow_films(tmp_path):
    scene = at_one_speed(read_scene("nu308_rigid"))
    coupled = scene.with_bearings(dataclasses.replace(entry, slices=5, slices_coupled=True) for entry in scene.bearings)
    found = automatic(coupled, statics, AutoSettings(folder=tmp_path, highest=10e3, shear="newtonian"))
    memory = found.verdicts[0]
    assert not memory.on and memory.warns and memory.words.endswith("with coupled slices there is none")
    assert found.subject.law.films == "slow"


def test_rings_of_other_temperatures_have_films_of_the_table(tmp_path, monkeypatch):
    monkeypatch.setattr("mbs.planning.verdicts.shear_effect", lambda *given: (0.1, 2.68))
    text = (resources.files("mbs") / "systems" / "nu308_rigid.toml").read_text(encoding="utf-8")
    warm = parse_scene(text.replace('profile = "iso"', f'{THERMAL}profile = "iso"'), "warm", "warm.toml")
    found = automatic(warm, statics, AutoSettings(folder=tmp_path, highest=0.0), planned_for=at_one_speed(warm))
    shear = next(verdict for verdict in found.verdicts if verdict.physics == "limiting shear stress")
    assert (
        not shear.on and shear.warns and "rings have temperatures of their own, and a map that is made" in shear.words
    )
    assert next(verdict for verdict in found.verdicts if verdict.physics == "ring temperatures and fits").on
    assert not found.made and found.result.model.states


def test_three_analyses_of_a_scene_have_three_lists(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    text = (resources.files("mbs") / "systems" / "nu308_rigid.toml").read_text(encoding="utf-8")
    short = text.replace("slices = 41", "slices = 3").replace('duration = "0.2 s"', 'duration = "2 ms"')
    (tmp_path / "short.toml").write_text(short)
    newtonian = ("--auto", "--shear", "newtonian")
    lists = []
    for command in ("statics", "modes", "runup"):
        _, out, _ = run(capsys, command, "short.toml", *newtonian)
        lists.append(tuple(line for line in out.splitlines() if line.startswith(("auto: ", "warning: auto: "))))
    assert len(set(lists)) == 3
    at_rest, linear, run_up = ("\n".join(lines) for lines in lists)
    assert "film memory: off, as an equilibrium has no frequency" in at_rest and "rollers as bodies" not in at_rest
    assert "film memory: on" in linear and "rollers as bodies" in linear and "at 500 rpm" in linear
    assert "at 2000 rpm" in run_up and "at 500 rpm" not in run_up
