"""Marked blocks of the pages, and the comparison of their figures with what commands print."""

from __future__ import annotations

import re
import shlex

import pytest

from tests.benchmarks.page_block import (
    FIGURES,
    WEIGHTS,
    Block,
    Given,
    Time,
    blocks,
    compared_in_order,
    compared_texts,
    numbers,
    shown_as,
    with_figures,
)
from tests.benchmarks.page_recipes import RECIPES, TIMES, compared, printed, rewritten
from tests.benchmarks.pages import PAGES, PROGRAMS, ROOT, whole_outputs
from tests.benchmarks.printed_tables import Output, sweep_cases

ALL = [block for page in PAGES for block in blocks(page, (ROOT / page).read_text(encoding="utf-8"))]
SWEEP = """Gearbox: law map of NU308
  case: Reynolds map, 30 um
  left: 923.21 N; along the load k 296.4 to 277.1 N/um (-6.50 %), c 4.07 to 1.984 N s/mm (-51.25 %)
  undamped modes      frequency/Hz        change  by energy: summed, one step   damping ratio   energy in the bearings
    14       2449.9 to    2395.9     -2.20 %          -2.20 %,    -1.56 %    0.0587 to 0.0446         0.50 to 0.77
  complex modes       frequency/Hz        change   damping ratio   whirl d omega/d Omega   oscillates
     2       684.39 to     695.3     +1.59 %      0.053 to 0.0344       -5.5e-07           everywhere
    14       2469.1 to    2398.9     -2.84 %     0.0892 to 0.0456       +0.00014           everywhere
"""


def test_every_block_has_a_recipe_and_commands_that_can_be_run():
    assert len(ALL) >= 35
    for block in ALL:
        assert re.fullmatch(r"printed(\[-?\d*:-?\d*(,-?\d*:-?\d*)*\])?", block.recipe) or block.recipe in RECIPES, (
            block.place
        )
        assert block.weight in WEIGHTS, block.place
        assert block.commands, block.place
        assert {shlex.split(command)[0] for command in block.commands} <= set(PROGRAMS), block.place


def test_every_name_stands_on_one_page():
    assert sorted(block.name for block in ALL) == sorted(FIGURES)


def test_the_ten_rows_of_the_trade_have_the_figures_of_its_tables():
    page = (ROOT / "docs" / "tradeoffs.md").read_text(encoding="utf-8")
    rows = [row for row in page.partition("## One contact")[0].splitlines() if row.startswith("| ")][1:]
    assert len(rows) == 10
    tables = "\n".join(block.text for block in ALL if block.name.startswith(("budget-of", "trade-of")))
    told = re.findall(r"\d[\d.]* / \d[\d.]*|x \d[\d.]*", " ".join(rows))
    assert len(told) >= 25
    assert [figure for figure in told if not re.search(rf"(?<![\d.]){re.escape(figure)}(?![\d.])", tables)] == []


def test_printed_output_on_pages_has_a_marker():
    for page in PAGES:
        text = (ROOT / page).read_text(encoding="utf-8")
        fences = re.findall(r"(?ms)^```(\w*)\n(.*?)^```$", text)
        bare = [body for language, body in fences if not language]
        assert sum(block.page == page and "```" in block.text for block in ALL) == len(bare), page


def test_a_block_is_equal_to_itself():
    for block in ALL:
        if block.recipe.startswith("printed"):
            same = compared_texts(block.text, block.text, TIMES)
            assert not same.different and same.figures > 0, block.place
        else:
            assert numbers(block.text), block.place


def test_a_wrong_digit_is_found():
    found = compared_texts("k 1.528e7, 37.3 N s/m in 2.1 s", "k 1.529e7, 37.3 N s/m in 3.9 s", TIMES)
    assert (found.figures, found.times) == (2, 1)
    assert [(each.shown, each.found) for each in found.different] == [("1.528e7", "1.529e7")]


def test_the_cost_of_a_choice_is_a_time_and_its_errors_are_figures():
    row = "* reynolds, density 6.5   {}   60/60   0.0029 / 0.018"
    found = compared_texts(row.format("0.0072"), row.format("4.7e-05"), TIMES)
    assert (found.figures, found.times, found.different) == (5, 1, ())


def test_other_words_and_missing_lines_are_found():
    assert compared_texts("a 1\nb 2", "a 1\nc 2").different
    assert "2 lines are shown, 1 found" in compared_texts("a 1\nb 2", "a 1").problem


def test_numbers_are_those_of_the_text_only():
    text = "**-2.8 %** of NU308 at `--speed 3`, 500-2500 rpm, [page](a/b2.md), 1.5e-3, +4"
    assert [match[0] for match in numbers(text)] == ["-2.8", "500", "2500", "1.5e-3", "+4"]


@pytest.mark.parametrize(
    ("value", "like", "text"),
    [
        (1.5284e7, "1.528e7", "1.528e7"),
        (9.16e-5, "9.2e-5", "9.2e-5"),
        (-0.004, "-0.01", "0.00"),
        (58.21, "+58", "+58"),
        (2469.1, "2400", "2469"),
    ],
)
def test_values_are_shown_with_the_digits_of_the_page(value, like, text):
    assert shown_as(value, like) == text


def test_figures_are_compared_and_replaced_in_their_order():
    text = "30 um: -2.8 % in 1.5 s"
    same = compared_in_order(text, [Given("30"), -2.84, Time(9.9)])
    assert (same.figures, same.equal, same.times) == (1, 1, 1)
    other = [Given("30"), -2.94, Time(9.9)]
    assert [(each.shown, each.found) for each in compared_in_order(text, other).different] == [("-2.8", "-2.9")]
    assert with_figures(text, other) == "30 um: -2.9 % in 9.9 s"
    assert "3 numbers, the recipe 1" in compared_in_order(text, [1.0]).problem
    assert compared_in_order(text, [Given("20"), -2.84, Time(9.9)]).different


ORIGINS = {
    "statics-of-a": {"recipe": "printed[1:-1]", "weight": "quick", "commands": ["mbs modes a"]},
    "solvers/a": {"weight": "long", "commands": ["mbs modes a", "mbs modes b"]},
}


def test_a_printed_block_is_made_of_lines_of_the_output():
    page = "x\n<!-- figures statics-of-a -->\n```\nk 1\n```\n<!-- end of figures -->\n"
    (block,) = blocks("page.md", page, ORIGINS)
    made = [Output("mbs modes a", "title\nk 2\nend\n")]
    assert printed(block, made) == rewritten(block, made) == "```\nk 2\n```\n"
    assert [each.found for each in compared(block, made).different] == ["2"]


def test_a_printed_block_may_leave_out_lines_between():
    origins = {"statics-of-a": {"recipe": "printed[:1,-2:]", "weight": "quick", "commands": ["mbs modes a"]}}
    page = "<!-- figures statics-of-a -->\n```\nk 1\nc 3\nend\n```\n<!-- end of figures -->\n"
    (block,) = blocks("page.md", page, origins)
    assert printed(block, [Output("mbs modes a", "k 1\nk 2\nc 3\nend\n")]) == block.text


def test_a_row_is_the_rest_of_its_line():
    page = "| a | <!-- row solvers/a --> 1 | 2 |\nnext\n"
    (block,) = blocks("page.md", page, ORIGINS)
    commands = ("mbs modes a", "mbs modes b")
    assert block == Block("page.md", "solvers/a", "solvers", "long", commands, " 1 | 2 |", block.begin, block.end, 1)


@pytest.mark.parametrize(
    ("page", "message"),
    [
        ("<!-- figures statics-of-a -->\nk 1\n", "has no '<!-- end of figures -->'"),
        ("<!-- figures other -->\nk 1\n<!-- end of figures -->\n", "figures.toml has no table 'other'"),
        ("<!-- figures printed, slow -->\nk 1\n<!-- end of figures -->\n", "not all of them markers"),
        ("| <!-- row other --> 1 |\n", "page.md:1: figures.toml has no table 'other'"),
    ],
)
def test_wrong_markers_are_named(page, message):
    with pytest.raises(ValueError, match=message):
        blocks("page.md", page, ORIGINS)


def test_sweeps_are_read():
    (case,) = sweep_cases(SWEEP)
    assert case.title == "Reynolds map, 30 um"
    assert case.along.k == (296.4, 277.1)
    assert case.undamped[14].energy == (0.5, 0.77)
    assert [mode.first for mode in case.bearing_modes()] == [2469.1]
    assert (case.steepest(), case.highest_rise()) == pytest.approx((-2.843, 1.594), abs=1e-3)


def test_whole_outputs_name_lines_that_only_one_has():
    found = whole_outputs("a 1\nb 2\n", "a 1\nb 3\nc 4\n")
    assert [(each.shown, each.found) for each in found.different] == [("2", "3"), ("(no such line)", "c 4")]


FENCE = re.compile(r"(?ms)^```.*?^```")
ALL_PAGES = sorted(
    path
    for folder in (".", "docs", "ehdmaps", "mbs", "examples", "openfoam_cases")
    for path in (ROOT / folder).glob("*.md")
)


def anchors(page):
    """Names by which headings of a page are linked, as repositories make them."""
    found = []
    for heading in re.findall(r"(?m)^#+ (.*)$", FENCE.sub("", page.read_text(encoding="utf-8"))):
        words = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading.strip().lower())
        name = re.sub(r"[^\w\- ]", "", words).replace(" ", "-")
        found.append(f"{name}-{found.count(name)}" if name in found else name)
    return found


@pytest.mark.parametrize("page", ALL_PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_links_lead_to_files_and_headings(page):
    for target in re.findall(r"\]\(([^)\s]+)\)", FENCE.sub("", page.read_text(encoding="utf-8"))):
        path, _, heading = target.partition("#")
        if "://" in target or "gallery_pages" in target:
            continue
        linked = (page.parent / path).resolve() if path else page
        assert linked.exists(), target
        assert not heading or linked.suffix != ".md" or heading in anchors(linked), target


def test_the_readme_stays_short():
    """README has 120 lines at most."""
    assert len((ROOT / "README.md").read_text(encoding="utf-8").splitlines()) <= 120
