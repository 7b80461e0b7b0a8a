"""Speed against accuracy of a scene: how two linear systems differ, which choices are rows, what is the reference."""

from __future__ import annotations

import dataclasses
import json

import numpy as np
import pytest

from ehdmaps.maps.emap import EHDMap
from ehdmaps.trade.record import budget
from mbs import assemble, parse_scene, read_scene
from mbs import budget as sources
from mbs.budget import LinearReference, error_budget, linear_look
from mbs.cli import main
from mbs.laboratory.tradeoff import machines as analysis
from mbs.laboratory.tradeoff.answer import answer_lines
from mbs.laboratory.tradeoff.data import trade_json
from mbs.laboratory.tradeoff.machines import TradeoffSettings, tradeoff
from mbs.laboratory.tradeoff.text import trade_text
from mbs.scene import changes
from mbs.scene.map_set import MapSet
from mbs.scene.subject import LawChoice, Subject
from tests.cases.laws import dataset_of
from tests.unit.test_mbs_tolerance import SWINGING

LINEAR = (
    '[[inputs]]\nname = "E1"\non = "mass"\ndirection = "y"\n'
    '[linear]\nfrequencies = { from = "100 Hz", to = "2 kHz", points = 200, spacing = "log" }\n'
)


class TestLinearLook:
    def test_a_stiffer_spring(self):
        soft = parse_scene(SWINGING + LINEAR, "soft", "soft.toml")
        stiff = parse_scene((SWINGING + LINEAR).replace("5e7 N/m", "6e7 N/m"), "stiff", "stiff.toml")
        reference = LinearReference.of(linear_look(assemble(soft, "hertz")), 5000.0)
        same, found = (reference.beside(linear_look(assemble(one, "hertz"))) for one in (soft, stiff))
        assert np.all(same.frequency == 0.0)
        assert np.all(same.height == 0.0)
        # sqrt(k/m) and d/(2 sqrt(k m)): round-off of an eigenproblem. The mode along z is not concerned.
        assert sorted(found.frequency) == pytest.approx([0.0, np.sqrt(1.2) - 1.0], abs=1e-9)
        assert sorted(found.damping) == pytest.approx([1.0 / np.sqrt(1.2) - 1.0, 0.0], abs=1e-9)
        # The peak of an acceleration, omega/d to first order in the damping ratio of 1 %: that is its error.
        assert found.height == pytest.approx([10.0 * np.log10(1.2)], abs=0.01)

    def test_a_mode_that_is_not_there_is_lost(self):
        gearbox = read_scene("gearbox")
        whole, less = (linear_look(assemble(one, "hertz")) for one in (gearbox, changes.with_cutoff(gearbox, 5000.0)))
        found = LinearReference.of(whole, 8000.0).beside(less)
        assert 0 < np.isnan(found.frequency).sum() < found.frequency.size
        # Modes far below both cut-offs: the discarded ones are quasi-static there.
        low = LinearReference.of(whole, 1000.0).beside(less)
        assert np.nanmax(np.abs(low.frequency)) < 2e-3
        assert np.all(low.load == 0.0)


class TestTradeoff:
    @pytest.mark.slow
    def test_rows_references_and_defaults(self, monkeypatch):
        monkeypatch.setattr(sources, "SUPPLIES", ("oil air",))
        monkeypatch.setattr(analysis, "SLICES", (3, 9))
        monkeypatch.setattr(analysis, "ANGLES", (4, 8))
        # Tables of a formula take longer than all the rest.
        every = sources._laws
        monkeypatch.setattr(sources, "_laws", lambda *given: [one for one in every(*given) if "film" not in one.label])
        made = []
        run_part = analysis.run_part
        monkeypatch.setattr(analysis, "run_part", lambda *given: made.append(given[2]) or run_part(*given))
        scene = changes.with_slices(read_scene("nu308_rigid"), 5)
        course = dataclasses.replace(scene.run_up, speed=scene.run_up.speed.part(0.1, 0.12), duration=0.02)
        scene = dataclasses.replace(scene, run_up=course, frequencies=scene.frequencies[::20])
        law = LawChoice("map", "map", MapSet([EHDMap(dataset_of())]))
        found = tradeoff(scene, [law], settings=TradeoffSettings(scene.campbell))
        rows = {(choice.group, choice.label): choice for choice in found.choices}
        assert {group for group, _ in rows} == {
            *(
                f"{kind}: {words}"
                for kind in ("linear", "run-up")
                for words in ("law", "oil supply", "what is held open", "map", "slices")
            ),
            "linear: cage angles",
            "run-up: step",
            "run-up: all settings of the scene",
        }
        best = rows["run-up: law", "map, memory"]
        assert best.default
        assert best.errors["sum level"].largest == 0.0
        assert rows["linear: law", "dry Hertz"].errors["frequency"].largest > 0.0
        assert rows["linear: slices", "5 slices"].default
        assert rows["linear: slices", "3 slices"].errors["contact load"].largest > 0.0
        # None twice: three laws, a supply more, four things that are held open, a map with fewer loads, fewer and more
        # slices, all steps with the finest one, and the finest of all, each of two parts.
        steps = sum(group == "run-up: step" for group, _ in rows)
        assert len(made) == 2 * (3 + 1 + 4 + 1 + 2 + steps + 1)
        assert "reference: map with memory of its films" in trade_text(found)
        assert json.loads(trade_json(found))
        bars = {bar.name: bar for bar in budget(found)}
        films = "films, their stiffness and damping"
        assert {films, "5 slices", "temperature +-5 K", "4 angles of the cages"} <= set(bars)
        # of a run and of a linear analysis in one line
        assert set(bars[films].errors) == {"frequency", "damping ratio", "sum level"}
        assert bars["5 slices"].errors["frequency"] == rows["linear: slices", "5 slices"].errors["frequency"]
        answers = "\n".join(answer_lines(found))
        assert "a linear analysis: what to use" in answers and "a run-up: what to use" in answers

    def test_a_machine_on_balls_has_rows_of_its_laws(self, monkeypatch):
        monkeypatch.setattr(analysis, "ANGLES", (4, 8))
        scene = read_scene("electric_drive")
        scene = dataclasses.replace(scene, frequencies=scene.frequencies[::20])
        found = tradeoff(scene, [], settings=TradeoffSettings(scene.campbell, runs=False))
        rows = {(choice.group, choice.label): choice for choice in found.choices}
        # no formula, no slices: balls have none
        assert {group for group, _ in rows} == {
            f"linear: {words}" for words in ("law", "oil supply", "what is held open", "cut-off", "cage angles")
        }
        for label in ("films without heat in the inlet", "axis of balls: no moment"):
            assert rows["linear: what is held open", label].errors["damping ratio"].largest > 1e-3
        assert all(choice.solved == choice.asked for choice in found.choices)
        dry, slow, memory = (
            rows["linear: law", label].errors for label in ("dry Hertz", "film table, slow films", "film table, memory")
        )
        assert dry["damping ratio"].largest > slow["damping ratio"].largest > 0.0
        assert dry["contact load"].points == 2 and dry["contact load"].largest > 0.0
        assert memory["frequency"].largest == 0.0

    def test_clearances_that_differ_are_rows_of_the_budget(self):
        law = LawChoice("map", "map", MapSet([EHDMap(dataset_of())]), films="memory")
        scene = changes.with_clearance_of(changes.with_slices(read_scene("nu308_rigid"), 5), "bearing_left", 40e-6)
        scene = dataclasses.replace(scene, frequencies=())
        rows = {choice.label: choice for choice in error_budget(Subject(scene, law), 5000.0).choices}
        own = LinearReference.of(linear_look(Subject(scene, law).model()), 5000.0)
        for name in ("bearing_left", "bearing_right"):
            (row,) = [choice for label, choice in rows.items() if label.startswith(f"clearance of {name} ")]
            value = next(one.geometry.diametral_clearance for one in scene.bearings if one.name == name)
            ends = [changes.with_clearance_of(scene, name, value + by) for by in (-5e-6, 5e-6)]
            found = [own.beside(linear_look(Subject(end, law).model())).damping for end in ends]
            # the larger of both ends, of each mode
            largest = np.max(np.abs(found))
            assert row.errors["damping ratio"].largest == pytest.approx(largest, rel=1e-6) and largest > 1e-3

    def test_the_command_refuses_before_it_measures(self, capsys):
        assert main(["tradeoff", "nu308_rigid", "--sensor", "S9", "--highest", "nonsense"]) == 2
        said = capsys.readouterr().err
        assert "--highest: got 'nonsense'" in said
        assert "sensor 'S9' is not there" in said
