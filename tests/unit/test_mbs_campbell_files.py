"""Campbell diagrams: the table of a scene, the file and the figure."""

from __future__ import annotations

import dataclasses
import importlib
import itertools
import types

import numpy as np
import pytest
import xarray as xr

from ehdmaps.jobs.table import Table
from mbs.analyses.reach import Fade
from mbs.output.campbell_plot import Overlay, Reach, campbell_figure
from mbs.output.campbell_table import campbell_dataset
from mbs.scene.reader import read_campbell
from mbs.settings import CampbellSettings
from mbs.spectral.campbell import run_up_spectra
from mbs.spectral.levels import Reference
from mbs.spectral.orders import order_peaks
from mbs.spectral.run_signal import RPM
from tests.cases.run_up import ramp, refused

REFERENCE = Reference("acceleration", 1e-6, "m/s2")


def test_settings_are_checked():
    problems = refused(
        lambda: CampbellSettings(highest=-1.0, window=np.nan, orders=(21.0, 0.0)),
        "highest: got -1.0 Hz",
        "window: got nan s",
        "orders: got [21.0, 0.0]",
    )
    assert len(problems) == 3


def read(**values):
    problems = []
    section = Table(values, "[campbell]", problems)
    settings = read_campbell(section)
    section.close()
    return settings, problems


def test_the_table_of_a_scene_is_read():
    settings, problems = read(sensor="top", highest="2 kHz", window="0.1 s", orders=[21, 42.5])
    assert problems == []
    assert settings == CampbellSettings("top", 2000.0, 0.1, (21.0, 42.5))
    assert read() == (CampbellSettings(None, 5000.0, None, ()), [])


def test_the_table_of_a_scene_is_refused_with_every_problem():
    settings, problems = read(sensor=3, highest="2 m", window="1 h", orders=[21, True], more=1)
    assert settings is None
    assert [problem.partition(":")[0] for problem in problems] == [
        "[campbell] sensor",
        "[campbell] highest",
        "[campbell] window",
        "[campbell] orders",
        "[campbell] more",
    ]


@pytest.mark.parametrize("orders", ["21", [], [0], [-3], [float("nan")], [float("inf")], ["21"], [[21]], [1] * 51])
def test_orders_of_a_scene_are_checked(orders):
    settings, problems = read(orders=orders)
    assert settings is None
    assert len(problems) == 1
    assert "a list of 1 to 50 numbers above 0" in problems[0]


@pytest.fixture(scope="module")
def spectra():
    return run_up_spectra(ramp(), 1e-6, 500.0, None, [5.0, 10.0])


def test_everything_in_a_file_has_units(spectra, tmp_path):
    data = campbell_dataset(["a", "b"], [spectra, spectra], REFERENCE, "top")
    path = tmp_path / "out.nc"
    data.to_netcdf(path)
    with xr.open_dataset(path) as read_back:
        for name, variable in read_back.variables.items():
            if name not in ("law",):
                assert variable.attrs["units"] and variable.attrs["long_name"], name
        assert read_back["level"].dims == ("law", "speed", "frequency")
        assert read_back["level"].attrs["units"] == "dB re 1e-06 m/s2"
        assert read_back.attrs["sensor"] == "top"
        np.testing.assert_array_equal(read_back["track"], [5.0, 10.0])


def test_results_of_other_runs_do_not_go_into_one_file(spectra):
    other = run_up_spectra(ramp(end=1400.0), 1e-6, 500.0, None, [5.0])
    with pytest.raises(ValueError, match="different speeds"):
        campbell_dataset(["a", "b"], [spectra, other], REFERENCE, "top")


def test_laws_with_fewer_peaks_are_filled(spectra):
    fewer = dataclasses.replace(spectra, peaks=())
    one = dataclasses.replace(spectra, peaks=order_peaks(spectra.tracks, 1e-6, prominence=1e-9))
    assert one.peaks
    data = campbell_dataset(["a", "b"], [fewer, one], REFERENCE, "top")
    assert np.all(np.isnan(data["peak_level"][0]))
    np.testing.assert_array_equal(data["peak_speed"][1], [peak.speed for peak in one.peaks])


@pytest.mark.parametrize(("count", "ending"), [(1, "png"), (2, "svg"), (4, "pdf")])
def test_figures_are_drawn(spectra, tmp_path, count, ending):
    overlay = Overlay(np.array([300.0, 1500.0]) / RPM, np.array([[200.0, 300.0], [210.0, np.nan]]))
    figure = campbell_figure(
        "title", list("abcd")[:count], [spectra] * count, REFERENCE, [(5.0, "5"), (10.0, "10")], [overlay, None]
    )
    panels = [panel for panel in figure.axes if panel.get_title()]
    assert [panel.get_title() for panel in panels] == list("abcd")[:count]
    assert {panel.collections[0].norm for panel in panels} == {panels[0].collections[0].norm}
    path = tmp_path / f"figure.{ending}"
    figure.savefig(path)
    assert path.stat().st_size > 10_000


def test_what_is_not_valid_is_drawn_and_named(spectra):
    speeds = np.array([300.0, 1500.0]) / RPM
    films = Reach(speeds, np.array([100.0, 500.0]), 400.0 / RPM)
    nothing = Reach(speeds, np.full(2, np.nan), 0.0)
    figure = campbell_figure("title", ["a", "b"], [spectra] * 2, REFERENCE, reaches=[films, nothing])
    with_films, without = (panel for panel in figure.axes if panel.get_title())
    assert any(np.array_equal(line.get_ydata(), [100.0, 500.0]) for line in with_films.lines)
    (band,) = with_films.patches
    assert band.get_x() + band.get_width() == pytest.approx(400.0)
    assert not without.patches
    words = [text.get_text() for part in figure.subfigs for legend in part.legends for text in legend.get_texts()]
    assert words == [
        "above the line: estimated error of the films above 5 %",
        "up to 400 rpm: below the map, film fades to dry",
        "a",
        "b",
    ]


@pytest.mark.parametrize(
    ("words", "count"), [("law", 1), ("law", 4), ("Reynolds map, films with memory, oil air, half space", 4)]
)
def test_the_legend_of_the_laws_lies_below_the_curves_and_on_the_page(spectra, words, count):
    figure = campbell_figure("title", [f"{words} {k}" for k in range(count)], [spectra] * count, REFERENCE)
    figure.draw_without_rendering()
    ((lower, legend),) = ((part, entry) for part in figure.subfigs for entry in part.legends)
    box = legend.get_window_extent()
    assert all(box.y1 <= panel.get_window_extent().y0 for panel in lower.axes)
    assert box.x0 >= figure.bbox.x0 and box.x1 <= figure.bbox.x1


def test_a_flat_sum_level_is_flat_and_has_no_offset(spectra):
    figure = campbell_figure("title", ["a"], [spectra], REFERENCE)
    figure.draw_without_rendering()
    sums = next(axes for axes in figure.axes if axes.get_ylabel().startswith("sum level"))
    assert np.ptp(sums.lines[0].get_ydata()) < 0.1
    assert np.ptp(sums.get_ylim()) >= 1.0
    assert sums.yaxis.get_offset_text().get_text() == ""


def test_four_long_names_stay_beside_one_another(spectra):
    """Names over the diagrams do not touch, and the legend of the sum levels lies below its panel."""
    names = [
        "dry Hertz",
        *(f"Reynolds map, films with memory, {supply}" for supply in ("flooded", "oil air", "grease")),
    ]
    figure = campbell_figure("title", names, [spectra] * 4, REFERENCE)
    figure.draw_without_rendering()
    boxes = [axes.title.get_window_extent() for axes in figure.axes if axes.get_title()]
    assert len(boxes) == 4
    assert all(one.x1 <= other.x0 for one, other in itertools.pairwise(boxes))
    ((lower, legend),) = ((part, entry) for part in figure.subfigs for entry in part.legends)
    assert [text.get_text() for text in legend.get_texts()] == names
    assert legend.get_window_extent().y1 <= lower.axes[0].get_window_extent().y0


def test_silence_can_be_drawn(tmp_path):
    nothing = run_up_spectra(ramp(signal=np.zeros_like), 1e-6, 500.0)
    campbell_figure("title", ["a"], [nothing], REFERENCE).savefig(tmp_path / "figure.png")


@pytest.mark.parametrize(
    ("lowest", "words"), [(0.0, ""), (400.0, "in windows that do not reach there"), (2e3, "all windows")]
)
def test_a_highest_level_below_the_map_is_said_to_be_one(spectra, monkeypatch, lowest, words):
    command = importlib.import_module("mbs.commands.campbell")
    analysis = importlib.import_module("mbs.analyses.campbell")
    monkeypatch.setattr(analysis, "fade_of", lambda model: Fade(lowest / RPM, 0.05, "the map") if lowest else None)
    loud = spectra.campbell.sum_level.copy()
    loud[0] = 300.0
    changed = dataclasses.replace(spectra, campbell=dataclasses.replace(spectra.campbell, sum_level=loud))
    run = ramp()
    entry = types.SimpleNamespace(spectra=(changed,), record=run, case=types.SimpleNamespace(model=None))
    fading = analysis.fading(entry)
    speeds, half = changed.campbell.speeds, 0.5 * changed.campbell.window * 300.0 / RPM
    # The speed rises by 300 rpm a second; windows that begin within a sample of the edge are left open.
    assert np.all(fading[speeds - half < 0.99 * lowest / RPM])
    assert not np.any(fading[speeds - half > 1.01 * lowest / RPM])
    said = command._elsewhere(entry)
    assert words in said and bool(said) == bool(lowest)
    if lowest == 400.0:
        best = int(np.argmax(np.where(fading, -np.inf, loud)))
        assert f"{loud[best]:.1f} dB at {speeds[best] * RPM:.4g} rpm" in said
