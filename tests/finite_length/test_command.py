"""`python -m tests.finite_length`: what it prints, its figure, and files that are none."""

from __future__ import annotations

import pytest

from ehdmaps.errors import InputError
from ehdmaps.physics.bearing import BearingGeometry
from tests.finite_length.__main__ import main
from tests.finite_length.compare import compare_lengths
from tests.finite_length.figure import length_figure
from tests.finite_length.reference import read_reference, shipped_reference


@pytest.mark.slow
def test_it_prints_all_cases_of_a_bearing(capsys):
    main(["N1014"])
    text = capsys.readouterr().out
    assert text.startswith("N1014: a roller with plane end faces on its inner raceway")
    assert text.count("finite elements ") >= 12 and text.count("slices on their own") == 12
    assert "profile iso, 1679.3 N, tilting moment 1.51 N m" in text
    assert "in three dimensions against finite elements: load per length within" in text


def test_the_figure_has_the_finite_elements_and_what_is_beside_them():
    """A figure of what is compared: six cases, two panels each."""
    reference = shipped_reference("NU308")
    cases = compare_lengths(reference, BearingGeometry.named("NU308"), (6, 24))
    figure = length_figure(reference, cases)
    assert len(figure.axes) == 12
    found = figure.axes[0].get_lines()[0]
    assert found.get_ydata().max() == pytest.approx(1e-3 * cases[0].case.load_per_length.max())
    assert [len(axes.patches) for axes in figure.axes[:3]] == [2, 2, 2]


@pytest.mark.parametrize(("text", "words"), [("{}", "is no file"), ('{"format": 0}', "got format 0")])
def test_a_file_that_is_none_is_refused(tmp_path, text, words):
    (tmp_path / "no.json").write_text(text)
    with pytest.raises(InputError, match=words):
        read_reference(str(tmp_path / "no.json"))
