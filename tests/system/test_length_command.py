"""`ehdmaps length` as a user calls it."""

from __future__ import annotations

import pytest

from ehdmaps.jobs.cli import main
from ehdmaps.jobs.show import solids_plot
from ehdmaps.physics.bearing import BearingGeometry
from ehdmaps.solids.three_d_compare import compare_lengths
from ehdmaps.solids.three_d_reference import FOLDER, shipped_reference

BARE = """
schema = 1
[contact]
radius = "10 mm"
reference_depth = "5 mm"
[lubricant]
name = "FVA3"
[grid]
load = ["1 N/mm", "10 N/mm"]
entrainment_speed = ["1 m/s", "2 m/s"]
temperature = ["40 degC"]
[solver]
name = "formula"
structural_law = "half_space"
"""


@pytest.mark.slow
def test_it_prints_all_cases_of_a_bearing(capsys):
    assert main(["length", "n1014"]) == 0
    text = capsys.readouterr().out
    assert text.startswith("N1014: a roller with plane end faces on its inner raceway")
    assert text.count("finite elements ") >= 12 and text.count("slices on their own") == 12
    assert "profile iso, 1679.3 N, tilting moment 1.51 N m" in text
    assert "in three dimensions against finite elements: load per length within" in text


def test_the_figure_has_the_finite_elements_and_what_is_beside_them():
    """A figure of what is compared: six cases, two panels each."""
    reference = shipped_reference("NU308")
    cases = compare_lengths(reference, BearingGeometry.named("NU308"), (6, 24))
    figure = solids_plot.length_figure(reference, cases)
    assert len(figure.axes) == 12
    found = figure.axes[0].get_lines()[0]
    assert found.get_ydata().max() == pytest.approx(1e-3 * cases[0].case.load_per_length.max())
    assert [len(axes.patches) for axes in figure.axes[:3]] == [2, 2, 2]


def test_what_is_wrong_is_said_at_once(capsys, tmp_path):
    (tmp_path / "bare.toml").write_text(BARE)
    (tmp_path / "no.json").write_text("{}")
    (tmp_path / "old.json").write_text('{"format": 0}')
    own = FOLDER / "NU308.json"
    for arguments, words in (
        ([str(tmp_path / "bare.toml")], "is the job of a bare [contact]; allowed: one with [bearing]"),
        (["nu308", "--solve", "x.txt"], "--solve: got 'x.txt'; allowed: a new file that ends with .json"),
        (["nu308", "--solve", "x.json", "--reference", str(own)], "--solve, --reference: got both"),
        (["nu308", "--reference", str(tmp_path / "no.json")], "is no file of contacts over the length"),
        (["nu308", "--reference", str(tmp_path / "old.json")], "got format 0; allowed: 1; make the file anew"),
    ):
        assert main(["length", *arguments]) == 2
        assert words in " ".join(capsys.readouterr().err.split())
    assert main(["length", "nu308", "--reference", str(own)]) == 0
