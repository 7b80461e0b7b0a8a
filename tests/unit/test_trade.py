"""Records of speed against accuracy: their tables, files and picture."""

from __future__ import annotations

import json
import math
from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
from matplotlib.collections import LineCollection

from ehdmaps.errors import InputError
from ehdmaps.jobs.show.budget_chart import budget_section
from ehdmaps.trade.record import Choice, ErrorSummary, Judged, Scope, Source, Trade, budget, budget_axis, budget_marks
from mbs.laboratory.tradeoff.answer import answer_lines, budget_lines, cheapest, number, time_text
from mbs.laboratory.tradeoff.data import check_trade_files, trade_dataset, trade_json, write_trade
from mbs.laboratory.tradeoff.figure import front, trade_figure
from mbs.laboratory.tradeoff.text import trade_text

PLACES = ("inner, 1 N/mm", "outer, 30 N/mm", "inner, 7 N/mm")


def choice(label: str, seconds: float, errors: list[float], group: str = "resolution", **further) -> Choice:
    """A choice whose films state an error of 1 %."""
    found = ErrorSummary.of(np.array(errors), PLACES, np.full(3, 0.01))
    levels = ErrorSummary.of(10.0 * np.array(errors), PLACES)
    return Choice(group, label, seconds, {"film": found, "level": levels}, solved=3, asked=3, **further)


@pytest.fixture(scope="module")
def trade() -> Trade:
    coarse = choice("coarse", 1e-3, [0.02, -0.005, 0.004])
    return Trade(
        level="contact",
        title="three points",
        cost="s a point",
        reference="the exact solution",
        judged=(Judged("film"), Judged("level", "dB")),
        choices=(
            coarse,
            choice("fine", 1e-2, [0.001, 0.002, -0.001], default=True),
            choice("dear", 2e-2, [0.01, 0.01, 0.01], lost=("inner, 2 N/mm: no convergence",)),
            choice("exact", 1.0, [0.0, 0.0, 0.0]),
            Choice("law", "none", 1e-6, {}, numerical={}, model={}, solved=0, asked=3),
            Choice("law", "apart", 5e-3, coarse.errors, numerical=coarse.errors, model={"film": coarse.errors["film"]}),
        ),
        frame=("seed 1",),
    )


def test_sizes_and_places_of_errors() -> None:
    found = ErrorSummary.of(np.array([-0.02, 0.005, np.nan]), PLACES, np.array([0.01, 0.01, 0.01]))
    assert (found.points, found.largest, found.worst, found.covered, found.stated) == (2, 0.02, PLACES[0], 0.5, 0.01)
    # the mean of the two in the middle, and of their signed values: exact arithmetic but for rounding
    assert found.median == pytest.approx(0.0125, rel=1e-12)
    assert found.bias == pytest.approx(-0.0075, rel=1e-12)
    empty = ErrorSummary.of(np.array([np.nan]), ["a"])
    assert (empty.points, empty.worst) == (0, "")
    assert math.isnan(empty.median)


def test_front_keeps_what_no_other_choice_beats() -> None:
    assert front([1.0, 2.0, 3.0, 4.0], [4.0, 5.0, 1.0, 1.0]) == (0, 2)
    assert front([2.0, 2.0], [1.0, 0.5]) == (1,)
    assert front([math.nan, math.inf, 1.0], [1.0, 0.0, math.nan]) == ()


def test_tables_name_default_worst_and_lost(trade: Trade) -> None:
    text = trade_text(trade)
    lines = text.splitlines()
    assert lines[:3] == ["three points", "reference: the exact solution", "seed 1"]
    (fine,) = [line for line in lines if line.startswith("* fine") and "0.1 / " in line]
    assert fine.split()[2:5] == ["0.01", "3/3", "0.1"]
    assert "  coarse: film 2 %, level 0.2 dB at inner, 1 N/mm" in lines
    assert "  dear: inner, 2 N/mm: no convergence" in lines
    (stated,) = [line for line in lines if line.startswith("  coarse") and "67%" in line]
    assert "1 / 67%" in stated  # states 1 %, and two of three points keep it


def test_dataset_and_json_hold_the_same_numbers(trade: Trade) -> None:
    dataset, record = trade_dataset(trade), json.loads(trade_json(trade))
    assert dataset["median"].dims == ("choice", "quantity")
    for index, entry in enumerate(record["choices"]):
        assert float(dataset["seconds"][index]) == entry["seconds"]
        if "film" in entry["errors"]:
            assert float(dataset["largest"].sel(quantity="film")[index]) == entry["errors"]["film"]["largest"]
    assert np.isnan(dataset["median"].sel(choice="none")).all()
    assert record["choices"][0]["errors"]["level"]["stated"] is None
    assert dataset["unit"].values.tolist() == ["1", "dB"]


def test_picture_shows_choices_with_an_error_and_the_front(trade: Trade) -> None:
    figure = trade_figure(trade)
    film, level, key = figure.axes
    assert (film.get_title(), level.get_title()) == ("film", "level")
    assert [text.get_text() for text in film.texts] == ["1", "2", "3", "6"]
    (best,) = [line for line in film.lines if line.get_linestyle() == "--"]
    assert best.get_xdata().tolist() == [1e-3, 1e-2]
    assert any("4  exact (no error above zero)" in text.get_text() for text in key.texts)
    assert not [entry for entry in film.collections if isinstance(entry, LineCollection)]


def test_choices_with_another_reference_have_a_front_and_a_heading_of_their_own(trade: Trade) -> None:
    own = choice("wet", 2e-3, [0.003, 0.003, 0.003], group="layer", reference="films on it")
    both = replace(trade, choices=(*trade.choices, own))
    film, *_ = trade_figure(both).axes
    fronts = [line.get_xdata().tolist() for line in film.lines if line.get_linestyle() == "--"]
    assert fronts == [[1e-3, 1e-2], [2e-3]]  # it beats "fine" in cost and error, of something else
    assert "layer, against films on it" in trade_text(both).splitlines()
    assert trade_dataset(both)["against"].values.tolist()[-2:] == ["", "films on it"]


def test_long_tables_are_broken_into_columns_that_fit(trade: Trade) -> None:
    many = (Judged("film"), *(Judged(f"quantity {index}") for index in range(3)), Judged("level", "dB"))
    lines = trade_text(replace(trade, judged=many)).splitlines()
    # a choice without any answer stands in the first table, and not in the next, which has nothing of it
    rows = [
        line.split()[0]
        for line in lines[lines.index("resolution") : lines.index("* what is used where nothing is said")]
    ]
    assert (rows.count("none"), rows.count("coarse")) == (1, 2)
    many = tuple(Judged(f"quantity {index}") for index in range(5))
    heads = [line for line in trade_text(replace(trade, judged=many)).splitlines() if "s a point" in line]
    assert [line.count("quantity") for line in heads[:2]] == [4, 1]  # errors; further tables are broken likewise


def test_files_follow_the_rule_of_outputs(trade: Trade, tmp_path) -> None:
    output, plot, foreign = tmp_path / "t.nc", tmp_path / "t.png", tmp_path / "mine.nc"
    for _ in range(2):  # an own file is replaced
        assert len(write_trade(trade, str(output), str(plot))) == 2
    with xr.open_dataset(output) as read:
        assert read.attrs["level"] == "contact"
        np.testing.assert_array_equal(read["median"], trade_dataset(trade)["median"])
    foreign.write_text("mine")
    with pytest.raises(InputError, match="is not a trade of ehdmaps"):
        check_trade_files(str(foreign), None, [])
    with pytest.raises(InputError, match="is not a trade of ehdmaps"):
        write_trade(trade, str(foreign), None)
    assert foreign.read_text() == "mine"


@pytest.fixture(scope="module")
def answered(trade: Trade) -> Trade:
    """The same with questions and sources."""
    scopes = (
        Scope("three points", (("resolution",),), ("film",)),
        Scope("all", (("resolution",), ("law",)), ("film",)),
    )
    sources = (Source("grid", "coarse", "fine"), Source("little", "fine"), Source("lost", "nothing of that name"))
    return replace(trade, scopes=scopes, sources=sources, shown=("film", "level"))


def test_the_cheapest_choice_that_keeps_a_tolerance(answered: Trade) -> None:
    """95 % quantiles of three sizes by hand: those of coarse 1.85 %, fine 0.19 %, dear 1 %, exact 0."""
    one, all_of = answered.scopes
    names = [[choice.label for choice in cheapest(answered, one, tolerance)] for tolerance in (0.1, 0.2, 1.0, 5.0)]
    assert names == [["exact"], ["fine"], ["fine"], ["coarse"]]
    # of the laws none has an error of 1 %, and one none at all
    assert cheapest(answered, all_of, 1.0) == ()
    assert [choice.label for choice in cheapest(answered, all_of, 5.0)] == ["coarse", "apart"]
    lines = list(answer_lines(answered))
    assert lines[0] == "three points: what to use where 95 % of the points may be wrong by no more than"
    assert [line.split() for line in lines[1:5]] == [
        *(["0.1", "%", "exact:", "1", "s", "a", "point,", "100", "of", "the", "default's"],),
        *(["1", "%", "fine:", "10", "ms", "a", "point"],),
        *(["5", "%", "coarse:", "1", "ms", "a", "point,", "0.1", "of", "the", "default's"],),
        *(["default", "fine:", "10", "ms", "a", "point;", "wrong", "by", "0.19", "%", "of", "film"],),
    ]
    assert "nothing that was measured keeps it" in lines[6]


def test_a_choice_that_lost_a_point_keeps_no_tolerance(answered: Trade) -> None:
    lossy = [replace(choice, solved=2) if choice.label == "fine" else choice for choice in answered.choices]
    assert [one.label for one in cheapest(replace(answered, choices=tuple(lossy)), answered.scopes[0], 1.0)] == ["dear"]


def test_the_budget_has_the_largest_source_first_and_what_it_costs(answered: Trade) -> None:
    bars = budget(answered)
    assert [bar.name for bar in bars] == ["grid", "little"]
    assert bars[0].cost == pytest.approx(10.0, rel=1e-12)
    assert math.isnan(bars[1].cost)
    table = list(budget_lines(answered))
    # median and 95 % quantile of 2, 0.5 and 0.4 %, of ten times that in dB
    name, film, _, most, level, _, loudest, *cost = table[2].split()
    assert (name, cost) == ("grid", ["x", "10"])
    # printed to two digits
    assert [float(text) for text in (film, most, level, loudest)] == pytest.approx([0.5, 1.85, 0.05, 0.185], rel=0.03)
    assert table[3].split()[-1] == "-"


def test_short_text_has_the_answer_and_says_where_the_rest_is(answered: Trade) -> None:
    short, whole = trade_text(answered, everything=False), trade_text(answered)
    assert len(short.splitlines()) < 20 < len(whole.splitlines())
    assert short.splitlines()[:2] == ["three points", "seed 1"]
    assert "--all" in short.splitlines()[-1]
    assert "largest error of each, and where" in whole and "largest error of each, and where" not in short


def test_the_picture_of_a_budget_has_a_bar_a_source_and_quantity(answered: Trade) -> None:
    (panel,) = trade_figure(answered).axes
    assert panel.get_xscale() == "log"
    assert [label.get_text() for label in panel.get_yticklabels()] == ["grid\n(costs x 10)", "little"]
    ends = sorted(bar.get_x() + bar.get_width() for bar in panel.patches)
    highs = sorted(found.high * unit for bar in budget(answered)
                   for found, unit in ((bar.errors["film"], 100.0), (bar.errors["level"], 1.0)))  # fmt: skip
    assert ends == pytest.approx(highs, rel=1e-9)
    # each bar ends with its number, and none begins before the axis does
    assert [text.get_text() for text in panel.texts] == [
        number(mark.high) for mark in budget_marks(answered, budget(answered))
    ]
    assert min(bar.get_x() for bar in panel.patches) >= panel.get_xlim()[0]
    assert len(trade_figure(answered, everything=True).axes) == 3


def test_a_bar_that_begins_below_the_axis_is_marked(trade: Trade) -> None:
    """A median of zero has no place on a logarithmic axis: a triangle for such a bar, in picture and report."""
    rare = choice("rare", 1e-3, [0.0, 0.0, 0.03])
    plain = replace(trade, choices=(rare,), sources=(Source("seldom", "rare"),), shown=("film",))
    low, high = budget_axis(plain, budget(plain))
    assert 0.0 < low < plain.quantity("film").printed(budget(plain)[0].errors["film"].high) < high
    (panel,) = trade_figure(plain).axes
    assert [line.get_marker() for line in panel.lines] == ["<"]
    section = str(budget_section(plain).content[-1])
    assert section.count("<path") - section.count('class="grid"') == 2  # the bar's and the key's
    assert "median below the axis" in section and "seldom" in section


def test_a_report_without_a_budget_says_why(trade: Trade) -> None:
    assert "no error budget: no speed" in str(budget_section("no speed").content[0])
    assert "Nothing that was looked at" in str(budget_section(replace(trade, sources=())).content[0])


@pytest.mark.parametrize(("seconds", "text"), [(1.3e-6, "1.3 us"), (0.0022, "2.2 ms"), (72.0, "72 s"), (0.5, "500 ms")])
def test_times_are_short(seconds, text) -> None:
    assert time_text(seconds) == text
