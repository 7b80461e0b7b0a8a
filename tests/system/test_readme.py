"""What README and the pages of the documentation tell a user to type."""

from __future__ import annotations

import re
import runpy
import shlex
import shutil
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from ehdmaps.jobs import cli as ehdmaps_cli
from mbs import cli
from mbs.scene.reader import shipped_systems
from tests.benchmarks.page_block import FIGURES

ROOT = Path(__file__).parents[2]
README = (ROOT / "README.md").read_text(encoding="utf-8")
PYTHON = (ROOT / "docs" / "python.md").read_text(encoding="utf-8")
NUMBER = re.compile(r"-?\d+(?:\.\d*)?")


@pytest.fixture
def made_map(reynolds_map, tmp_path):
    """A folder with a map as README's programs read it."""
    shutil.copy(reynolds_map, tmp_path / "nu308.nc")
    return tmp_path


@pytest.mark.slow
def test_script_prints_what_is_shown(made_map, monkeypatch, capsys):
    found = re.search(
        r"```python\n([^`]*from mbs import[^`]*)```\n\nprints\n\n<!-- [^\n]* -->\n```\n([^`]*)```", PYTHON
    )
    assert found is not None
    script, shown = found.groups()
    assert script.count("\n") <= 30
    monkeypatch.chdir(made_map)
    Path("script.py").write_text(script)
    capsys.readouterr()
    runpy.run_path("script.py", run_name="__main__")
    printed = capsys.readouterr().out
    assert NUMBER.sub("", printed).split() == NUMBER.sub("", shown).split()
    values = [np.array([float(text) for text in NUMBER.findall(part)]) for part in (printed, shown)]
    # the laws of both maps differ by less than 1 %; what is shown has a digit after the point
    np.testing.assert_allclose(*values, rtol=0.01, atol=0.1)


def test_blocks_of_python_compile():
    blocks = re.findall(r"```python\n(.*?)```", README + PYTHON, re.DOTALL)
    assert len(blocks) == 9
    for block in blocks:
        compile(block, "README.md", "exec")


def test_the_scene_made_in_python_has_an_equilibrium():
    (block,) = (text for text in re.findall(r"```python\n(.*?)```", PYTHON, re.DOTALL) if "RigidSpec" in text)
    names = {}
    exec(f"from mbs import assemble, statics\n{block.replace('statics(', 'found = statics(')}", names)
    left, right = names["found"].values
    # without a load all rollers are pressed alike: rounding of twelve of them
    assert left[1, 1] == pytest.approx(left[2, 2], rel=1e-9)
    assert left[1, 1] > 1e8
    assert np.array_equal(left, right)


@pytest.mark.slow
def test_films_with_memory_from_python(made_map, monkeypatch):
    (block,) = (text for text in re.findall(r"```python\n(.*?)```", PYTHON, re.DOTALL) if "memory" in text)
    monkeypatch.chdir(made_map)
    Path("memory.py").write_text(block)
    found = runpy.run_path("memory.py")
    rest, _, _ = found["fixed"](found["deltas"], 0.0)
    # pressed together at 0.1 mm/s: a little more than at rest
    assert np.all(found["w"] > rest) and np.all(found["w"] < 1.2 * rest)


@pytest.mark.slow
def test_a_bearing_in_time_from_python(made_map, monkeypatch):
    (block,) = (text for text in re.findall(r"```python\n(.*?)```", PYTHON, re.DOTALL) if "force.advance(" in text)
    monkeypatch.chdir(made_map)
    Path("bearing.py").write_text(block)
    found = runpy.run_path("bearing.py")
    # the inner ring moves along y and z: rollers there are loaded, and push it back
    assert found["films"].load.max() > 1e3
    assert np.all(found["forces"].force[1:3] < 0.0)


@pytest.mark.slow
def test_a_law_by_its_address(made_map, monkeypatch):
    (block,) = (text for text in re.findall(r"```python\n(.*?)```", PYTHON, re.DOTALL) if "law.address" in text)
    monkeypatch.chdir(made_map)
    Path("address.py").write_text(block)
    found = runpy.run_path("address.py")
    assert found["status"] == 0
    np.testing.assert_allclose(found["force"], found["law"](2e-6, 0.0, 1.7, 313.15), rtol=1e-12)  # round-off


@pytest.mark.slow
def test_a_bearing_by_its_address(made_map, monkeypatch):
    (block,) = (text for text in re.findall(r"```python\n(.*?)```", PYTHON, re.DOTALL) if "force.address" in text)
    monkeypatch.chdir(made_map)
    Path("address.py").write_text(block)
    found = runpy.run_path("address.py")
    assert found["status"] == 0
    answer, force = found["force"].answer.copy(), found["force"]
    for part, same in zip(force(force.state[:6].copy()), (answer[0], answer[1:7], answer[7:]), strict=True):
        assert np.array_equal(part, same)


@pytest.mark.slow
def test_a_whole_machine_from_python(made_map, monkeypatch):
    (block,) = (text for text in re.findall(r"```python\n(.*?)```", PYTHON, re.DOTALL) if "SweepRange" in text)
    monkeypatch.chdir(made_map)
    Path("machine.py").write_text(block)
    found = runpy.run_path("machine.py")
    assert found["over_speed"]["case"].values.tolist() == ["dry Hertz", "film table"]


@pytest.mark.slow
def test_first_block_of_python_runs(made_map, monkeypatch):
    block = re.findall(r"```python\n(.*?)```", README, re.DOTALL)[0]
    monkeypatch.chdir(made_map)
    Path("block.py").write_text(block)
    found = runpy.run_path("block.py")
    # round-off: a law at a fixed point is to give equal values
    fixed = found["emap"].law("series").at(1.7, 313.15)
    np.testing.assert_allclose(fixed(2e-6, 0.0), [found[name] for name in "wkc"], rtol=1e-9)


PAGES = (
    "README.md",
    "docs/index.md",
    "docs/first_steps.md",
    "docs/guide_map.md",
    "docs/guide_bearing.md",
    "docs/guide_machine.md",
    "docs/guide_cfd.md",
    "docs/ball_bearings.md",
    "docs/real_films.md",
    "docs/tradeoffs.md",
    "docs/measured.md",
    "docs/accuracy.md",
    "docs/evidence.md",
    "docs/cfd.md",
    "docs/solids.md",
    "docs/reference_ehdmaps.md",
    "docs/reference_mbs.md",
    "docs/machines.md",
    "docs/openfoam_results.md",
    "examples/first_steps.sh",
)
PARSERS = {"ehdmaps": cache(ehdmaps_cli.parser), "mbs": cli.parser}
LEFT_OUT = {
    "ehdmaps solve": ["n1014", "--load", "1 N/mm", "--speed", "1 m/s", "--temperature", "40 degC"],
    "ehdmaps generate": ["n1014"],
    "mbs bearing": ["--load", "1 kN", "--speed", "500 rpm"],
}
"""What commands need that are shown in part: with "..." or with words in capitals for their arguments."""


def commands_of(page):
    """Command lines of a page: in blocks, in lists of commands, and within the text."""
    text = (ROOT / page).read_text(encoding="utf-8")
    blocks = re.findall(r"(?m)^(?: {4})?((?:ehdmaps|mbs) [a-z-]+ .*)$", text)
    # a comment, or after a gap what the command is for
    lines = [re.sub(r" {3,}\S.*", "", re.sub(r"^(\S+ \S+) +", r"\1 ", line.partition("#")[0])) for line in blocks]
    return lines + [" ".join(span.split()) for span in re.findall(r"`((?:ehdmaps|mbs)\s[a-z-]+\s[^`]*)`", text)]


def words_of(command):
    """Words of a command after the program's name; what was left out is filled in, options in brackets are taken."""
    program, name, *words = shlex.split(re.sub(r"[\[\]]", " ", command))
    if "..." in words:
        words.remove("...")
        words = [*LEFT_OUT[f"{program} {name}"], *words]
    elif words[0].isupper() and "--load" not in words:
        words += LEFT_OUT.get(f"{program} {name}", [])
    return program, [name, *words]


FIGURES_FROM = sorted(
    {command for origin in FIGURES.values() for command in origin["commands"] if not command.startswith("python")}
)
"""What the figures of the pages come from."""

OWN = "mine.toml"
"""What `mbs new` writes."""


@pytest.mark.parametrize("page", [*PAGES, "figures.toml"])
def test_commands_are_understood(page):
    for command in FIGURES_FROM if page == "figures.toml" else commands_of(page):
        program, words = words_of(command)
        try:
            scene = getattr(PARSERS[program]().parse_args(words), "scene", None)
        except SystemExit:
            pytest.fail(f"{page}: {command}")
        recorded = scene is not None and scene.endswith((".nc", ".csv", ".uff", ".wav"))
        assert recorded or scene in {None, "SCENE", OWN, *shipped_systems()}, command


@pytest.mark.parametrize(
    ("program", "page"), [("ehdmaps", "docs/reference_ehdmaps.md"), ("mbs", "docs/reference_mbs.md")]
)
def test_pages_show_every_command(program, page):
    (commands,) = (action.choices for action in PARSERS[program]()._actions if action.dest == "command")
    text = (ROOT / page).read_text(encoding="utf-8") + README
    assert [name for name in commands if not re.search(rf"\b{program} {name}\b", text)] == []


@pytest.mark.parametrize(
    "wrong", ["mbs sweeps nu308_rigid", "mbs sweep nu308_rigid --mapp a.nc", "ehdmaps solve n1014"]
)
def test_wrong_commands_are_found(wrong, capsys):
    program, words = words_of(wrong)
    with pytest.raises(SystemExit):
        PARSERS[program]().parse_args(words)
    assert "error: " in capsys.readouterr().err
