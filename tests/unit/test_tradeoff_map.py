"""The trade of whole maps: rows, order of errors, structural laws told apart, what cannot be compared."""

from __future__ import annotations

import pytest

from ehdmaps.errors import InputError
from ehdmaps.jobs import tradeoff_map
from ehdmaps.jobs.cli import main
from ehdmaps.jobs.reader import parse_job
from ehdmaps.jobs.tradeoff_map import measure_map
from ehdmaps.trade.record import Choice, Trade
from ehdmaps.trade.text import trade_text
from tests.cases.jobs import LINE, map_job

SMALL = (
    LINE.replace('"formula"', '"reynolds"')
    .replace('["0 m/s", "1 m/s"]', '["1 m/s"]')
    .replace('"half_space"', '"iso16281"')
    .replace('reference_depth = "5 mm"', 'reference_depth = "5 mm"\nroller_length = "15 mm"')
)
"""A bare contact at one speed and temperature, with the lengths of all structural laws: lines of one speed."""


@pytest.fixture(scope="module")
def trade() -> Trade:
    """With two kinds of lines and two grid densities."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(tradeoff_map, "LOAD_STEPS", (4.0, 1.0))
        patch.setattr(tradeoff_map, "DENSITIES", (0.5, 1.0))
        told: list[str] = []
        found = measure_map(parse_job(SMALL, "small", "small"), 20, 3, told.append)
        assert len(told) == len(found.choices) + 1
        return found


def group(trade: Trade, name: str) -> dict[str, Choice]:
    return {choice.label.split(",")[0].split(" (that")[0]: choice for choice in trade.choices if name in choice.group}


def test_finer_lines_and_grids_cost_more_and_are_better(trade: Trade) -> None:
    lines, grids = group(trade, "refinement lines"), group(trade, "grid of the solver")
    assert list(lines) == ["step 0.24", "step 0.06"]
    assert lines["step 0.06"].default
    # interpolation of fourth order over a step of a quarter
    assert (
        lines["step 0.24"].errors["damping, valley"].largest > 10 * lines["step 0.06"].errors["damping, valley"].largest
    )
    assert list(grids) == ["density 3.25", "density 6.5"]
    assert grids["density 3.25"].errors["film offset"].median > 2 * grids["density 6.5"].errors["film offset"].median
    assert all(choice.seconds > 0.0 and choice.solved == choice.asked == 20 for choice in lines.values())


def test_maps_without_lines_know_no_valley(trade: Trade) -> None:
    bare = list(group(trade, "no lines").values())
    assert [choice.label.rsplit(": ")[-1] for choice in bare] == ["2 points", "3 points", "5 points"]
    lines = group(trade, "refinement lines")["step 0.06"]
    assert (
        min(choice.errors["damping, valley"].median for choice in bare) > 100 * lines.errors["damping, valley"].median
    )


def test_structural_laws_are_told_apart_from_numerical_errors(trade: Trade) -> None:
    laws = group(trade, "structural law")
    assert set(laws) == {"iso16281", "palmgren", "half_space", "fe"}
    assert laws["iso16281"].default
    assert laws["iso16281"].model["stiffness"].largest == 0.0
    # another law of the solids moves k far more than all that is numerical
    assert laws["half_space"].errors["stiffness"].median > 0.05
    assert laws["half_space"].numerical["stiffness"].median < 1e-3
    assert laws["half_space"].errors["film offset"].median < 1e-3  # by the same films


def test_closed_forms_have_errors_of_the_model(trade: Trade) -> None:
    forms = group(trade, "closed form")
    assert forms["hertz"].errors["film offset"].median == pytest.approx(1.0)
    assert forms["hertz"].errors["damping"].median == pytest.approx(1.0)
    assert forms["formula"].model["film offset"].median < 0.1


def test_it_is_printed(trade: Trade) -> None:
    text = trade_text(trade)
    assert "20 random points, seed 3; 4 in the damping valley" in text
    assert "structural law iso16281" in text


def test_the_command_has_it(trade: Trade, monkeypatch, capsys) -> None:
    asked = []
    monkeypatch.setattr(
        "ehdmaps.jobs.commands.tradeoff.measure_map", lambda job, *rest, tell: asked.append((job.name, *rest)) or trade
    )
    assert main(["tradeoff", "nu308", "--level", "map", "--points", "20", "--seed", "3"]) == 0
    assert asked == [("nu308", 20, 3)]
    assert "refinement lines" in capsys.readouterr().out


def test_a_bare_contact_lacks_the_lengths_of_other_laws(monkeypatch) -> None:
    text = SMALL.replace('roller_length = "15 mm"', "").replace('"iso16281"', '"half_space"')
    monkeypatch.setattr(tradeoff_map, "_line_rows", lambda *_: iter(()))
    monkeypatch.setattr(tradeoff_map, "_density_rows", lambda *_: iter(()))
    found = group(measure_map(parse_job(text, "tiny", "tiny"), 5, 3), "structural law")
    assert found["half_space"].solved == 5
    assert found["palmgren"].solved == 0
    assert "roller_length" in found["palmgren"].lost[0]


def test_a_job_of_one_point_is_refused() -> None:
    text = map_job('["20 N/mm"]', '["0.5 m/s"]', '["60 degC"]', solver="reynolds")
    with pytest.raises(
        InputError, match=r"tradeoff, level map: the job has one point, .*; allowed: a job with an axis"
    ):
        measure_map(parse_job(text, "one", "one"), 5, 1)
