"""What README and the reference page of mbs tell a user to type."""

from __future__ import annotations

import re
import runpy
import shlex
from pathlib import Path

import numpy as np
import pytest

from ehdmaps.jobs import cli as ehdmaps_cli
from mbs import cli
from mbs.scene_reader import shipped_systems

ROOT = Path(__file__).parents[2]
README = (ROOT / "README.md").read_text(encoding="utf-8")
NUMBER = re.compile(r"-?\d+(?:\.\d*)?")

# Of the shipped job's map only what the operating point needs: 0.83 m/s and 40 degC
JOB = """
schema = 1
[bearing]
name = "NU308"
[lubricant]
name = "FVA3"
[grid]
load = { from = "0.1 N/mm", to = "1000 N/mm", points = 25, spacing = "log" }
entrainment_speed = { from = "0.4 m/s", to = "1.6 m/s", points = 4, spacing = "log" }
temperature = ["30 degC", "40 degC", "50 degC", "60 degC"]
[solver]
name = "reynolds"
structural_law = "iso16281"
"""


def test_script_prints_what_is_shown(tmp_path, monkeypatch, capsys):
    found = re.search(r"```python\n([^`]*from mbs import[^`]*)```\n\nprints\n\n```\n([^`]*)```", README)
    assert found is not None
    script, shown = found.groups()
    assert script.count("\n") <= 30
    monkeypatch.chdir(tmp_path)
    Path("nu308.toml").write_text(JOB)
    assert ehdmaps_cli.main(["generate", "nu308.toml", "-o", "nu308.nc"]) == 0
    Path("script.py").write_text(script)
    capsys.readouterr()
    runpy.run_path("script.py", run_name="__main__")
    printed = capsys.readouterr().out
    assert NUMBER.sub("", printed).split() == NUMBER.sub("", shown).split()
    values = [np.array([float(text) for text in NUMBER.findall(part)]) for part in (printed, shown)]
    # the laws of both maps differ by less than 1 %; what is shown has a digit after the point
    np.testing.assert_allclose(*values, rtol=0.01, atol=0.1)


@pytest.mark.parametrize("page", ["README.md", "mbs/REFERENCE.md", "mbs/MACHINES.md"])
def test_commands_of_mbs_are_understood(page):
    text = (ROOT / page).read_text(encoding="utf-8")
    commands = re.findall(
        r"(?m)^(?:`|)(mbs (?:statics|modes|lsa|sweep|runup|campbell|hammer) +[^`#\n]*)(?:`|#|$)", text
    )
    assert len(commands) >= 1
    for command in commands:
        words = shlex.split(command)[1:]
        if "SCENE" not in words:
            assert cli.parser().parse_args(words).scene in shipped_systems()
