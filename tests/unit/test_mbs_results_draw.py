"""Results of functions: each draws what its command draws with --plot, and has the dataset that its command writes."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
from matplotlib.figure import Figure

import mbs
from ehdmaps.errors import InputError
from mbs import HammerSettings, SweepRange, SweepSettings, assemble, read_scene
from mbs.analyses.hammer import hammer
from mbs.modal.uff import Measurement


@pytest.fixture(scope="module")
def model():
    return assemble(read_scene("nu308_rigid"), law="hertz", clearance=20e-6)


SPEEDS = SweepSettings(SweepRange(100.0, 200.0, 3))


@pytest.mark.parametrize(
    ("find", "panels"),
    [
        (mbs.statics, 2),
        (mbs.modes, 1),
        (mbs.lsa, 2),
        (lambda model: mbs.sweep(model, SPEEDS), 4),
        (lambda model: mbs.critical(model, SPEEDS), 1),
    ],
    ids=["statics", "modes", "lsa", "sweep", "critical"],
)
def test_a_result_draws_itself_and_has_a_dataset(find, panels, model):
    found = find(model)
    figure = found.plot()
    assert isinstance(figure, Figure)
    assert len([panel for panel in figure.axes if panel.has_data()]) >= panels
    assert found.dataset.attrs["weight"] == "without weight (no gravity in [operation])"


def test_modes_are_drawn_up_to_a_frequency(model):
    found = mbs.modes(model)
    low, high = (found.plot(highest) for highest in (1.0, 1e6))
    count = [sum(len(panel.patches) + len(panel.lines) for panel in figure.axes) for figure in (low, high)]
    assert count[0] < count[1]


def test_hits_have_a_dataset_and_responses_that_are_fitted(model):
    found = hammer(model, HammerSettings(hits=2, highest=2000.0))
    dataset = found.dataset
    assert dict(dataset.sizes) == {
        "input": len(model.scene.inputs),
        "hit": 2,
        "sensor": len(model.scene.sensors),
        "time": found.hits[0].force.shape[1],
    }
    np.testing.assert_array_equal(dataset["response"].values[0], found.hits[0].response)
    figure = found.plot()
    # Each response by each input is a line, with the values of the fit's own estimate.
    fit = mbs.modal_fit(found, (50.0, 2000.0))
    assert isinstance(fit.plot(), Figure)
    assert fit.dataset.attrs["title"] == model.scene.title
    drawn = [line for panel in figure.axes for line in panel.lines if len(line.get_xdata()) > 10]
    assert len(drawn) >= len(model.scene.inputs) * len(model.scene.sensors)
    away = np.abs(fit.fit.frequency[:, None] / found.modes.frequency[found.modes.frequency > 0.0] - 1.0).min(axis=1)
    # Noise of one per cent in two hits.
    assert fit.fit.frequency.size > 0
    assert away.max() < 1e-2


@pytest.mark.slow
def test_runs_in_time_draw_themselves(model):
    course = dataclasses.replace(model.scene.run_up, duration=0.02)
    assert isinstance(mbs.runup(model, course).plot(), Figure)


def test_one_bearing_is_a_function():
    found = mbs.bearing("NU308", ["1 kN", "5 kN"], "0 rpm", choices={"law": "hertz", "clearance": "20 um"})
    assert found.dataset.sizes["load"] == 2
    assert "law dry Hertz" in found.text or "dry Hertz" in found.text
    assert isinstance(found.plot(), Figure)
    # It is the command: the same points.
    assert [row[0].load[1] for row in found.points] == [1000.0, 5000.0]
    ball = mbs.bearing("7208B", "1 kN", "0 rpm", axial="1 kN", choices={"law": "hertz"})
    assert ball.dataset["stiffness_axial"].shape == (1, 1) and "mean contact angle" in ball.text
    with pytest.raises(InputError, match="bearing, choices: got 'colour'; allowed: law, map, "):
        mbs.bearing("NU308", "1 kN", "0 rpm", choices={"colour": "red"})
    with pytest.raises(InputError, match="--load: "):
        mbs.bearing("NU308", "1 m", "0 rpm")


def test_a_file_without_hits_and_responses_is_refused(tmp_path):
    with pytest.raises(InputError, match=r"no\.uff"):
        mbs.modal_fit(tmp_path / "no.uff")


def test_a_file_with_coherences_only_is_refused(monkeypatch):
    monkeypatch.setattr("mbs.modal.uff.read_uff", lambda path: Measurement("", (), None))
    with pytest.raises(InputError, match=r"own\.uff: has coherences only; allowed: frequency responses, or hits"):
        mbs.modal_fit("own.uff")


def test_a_body_that_is_not_there_is_refused(tmp_path):
    with pytest.raises(InputError, match=r"no\.toml: cannot be read"):
        mbs.reduce(tmp_path / "no.toml")


def test_a_report_is_a_page(tmp_path, model):
    mbs.write_report(model, tmp_path / "page.html")
    assert "mbs.write_report(model, " in (tmp_path / "page.html").read_text(encoding="utf-8")
    (tmp_path / "other.html").write_text("mine")
    with pytest.raises(InputError, match=r"other\.html"):
        mbs.write_report(model, tmp_path / "other.html")
