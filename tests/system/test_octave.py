"""Maps in Octave: the example of the reference page, run as it stands there."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

import numpy as np
import pytest

import ehdmaps
from ehdmaps.jobs.cli import main
from tests.cases.jobs import SMALL
from tests.cases.programs import needed

PAGE = Path(__file__).parents[2] / "docs" / "reference_ehdmaps.md"


@pytest.fixture
def octave():
    """The program; its tests are skipped without it, but in CI that is a failure."""
    program = needed("octave-cli")

    def run(script, folder):
        (folder / "script.m").write_text(script)
        done = subprocess.run(
            [program, "--no-gui", "script.m"], cwd=folder, capture_output=True, text=True, timeout=120, check=False
        )
        assert done.returncode == 0, done.stderr
        return done.stdout

    return run


def test_the_example_of_the_page_runs(octave, tmp_path):
    # thick films, which have a reason
    (tmp_path / "job.toml").write_text(SMALL.replace('"2 m/s"', '"9 m/s"').replace('"1 N/mm"', '"0.1 N/mm"'))
    assert main(["generate", str(tmp_path / "job.toml"), "-o", str(tmp_path / "nu308.nc"), "--workers", "1"]) == 0
    (example,) = re.findall(r"```octave\n(.*?)```", PAGE.read_text(), re.DOTALL)
    assert len(example.splitlines()) == 5
    texts = "reason = ncread('nu308.nc', 'reason');\nprintf('%s|', reason(:, 1, 3, 1, 1)');\n"
    printed = octave(f"format long g\n{example}\n{texts}", tmp_path).splitlines()
    dataset = ehdmaps.open_map(tmp_path / "nu308.nc").dataset
    curve = dataset["stiffness"].sel(contact="inner").isel(temperature=1, entrainment_speed=2)
    shown = np.array([line.split() for line in printed[:7]], dtype=float)
    # 1e-12: digits that Octave prints
    np.testing.assert_allclose(shown, np.column_stack([dataset["load"].values, curve.values]), rtol=1e-12)
    reason = str(dataset["reason"].values[0, 0, 2, 0])
    assert "outside thin-film theory" in reason
    assert printed[-1].replace("\0", "").strip("| ") == reason
