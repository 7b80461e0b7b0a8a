"""Run-ups as levels over speed, frequency and order: what is refused, what is kept, files and figures."""

from __future__ import annotations

import argparse
import dataclasses
import importlib
import types
from importlib import resources

import numpy as np
import pytest
import xarray as xr

from ehdmaps.errors import InputError
from ehdmaps.jobs.table import Table
from mbs.analyses.reach import Fade
from mbs.errors import AnalysisError
from mbs.model.elements import Sensor
from mbs.output.campbell_data import campbell_dataset
from mbs.output.campbell_plot import Overlay, Reach, campbell_figure
from mbs.scene.campbell import read_campbell
from mbs.settings import CampbellSettings
from mbs.spectral.campbell import campbell, run_up_spectra
from mbs.spectral.levels import LOWEST, Reference, difference_text, level
from mbs.spectral.orders import OrderTracks, angle_signal, order_peaks, order_spectra, track_orders
from mbs.spectral.run_signal import RPM, RunSignal
from mbs.spectral.spectra import default_window, short_time_spectra
from mbs.transient.run import run

RATE = 4000.0
REFERENCE = Reference("acceleration", 1e-6, "m/s2")


def ramp(begin=300.0, end=1500.0, duration=4.0, rate=RATE, signal=None):
    """A run from one speed to another [rpm]; by default with a signal of order 5 and of 200 Hz."""
    time = np.arange(round(duration * rate) + 1) / rate
    rise = (end - begin) / duration
    speed = (begin + rise * time) / RPM
    angle = (begin * time + 0.5 * rise * time**2) / RPM
    values = np.sin(5.0 * angle) + 0.1 * np.sin(2.0 * np.pi * 200.0 * time) if signal is None else signal(time)
    return RunSignal(time, speed, angle, values)


def refused(call, *parts):
    with pytest.raises(InputError) as caught:
        call()
    text = str(caught.value)
    assert all(part in text for part in parts), text
    return caught.value.problems


# The signal


def test_a_signal_is_refused_with_every_problem():
    run = ramp()
    problems = refused(
        lambda: RunSignal(run.time, run.speed[:-1], run.angle[:5], ["a"]),
        "speed: got 16000 samples; allowed: as many as times",
        "angle: got shape (5,); allowed: (samples,) with at least 64",
        "signal: got no array of real numbers",
    )
    assert len(problems) == 3


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf, 1e200])
@pytest.mark.parametrize("name", ["time", "speed", "angle", "signal"])
def test_values_that_are_no_numbers_are_refused(name, value):
    run = ramp()
    values = getattr(run, name).copy()
    values[7] = value
    refused(lambda: dataclasses.replace(run, **{name: values}), f"{name}: got {value} at sample 7")


def test_times_are_equally_far_apart():
    run = ramp()
    time = run.time.copy()
    time[9] += 1e-5
    refused(lambda: dataclasses.replace(run, time=time), "time: got steps of", "interpolate the record")
    refused(lambda: dataclasses.replace(run, time=-run.time), "allowed: equal and > 0")


def test_angle_is_the_integral_of_the_speed():
    run = ramp()
    refused(
        lambda: dataclasses.replace(run, angle=run.angle / (2.0 * np.pi)), "check rad and rad/s against turns and rpm"
    )
    refused(lambda: dataclasses.replace(run, angle=-run.angle), "angle: got")


def test_a_rotation_that_reverses_is_refused():
    refused(lambda: ramp(-500.0, 500.0), "got -500 to 500 rpm, a rotation that reverses", "cut the record")


def test_backwards_is_forwards():
    run = ramp()
    back = RunSignal(run.time, -run.speed, -run.angle, run.signal)
    np.testing.assert_array_equal(back.speed, run.speed)
    np.testing.assert_array_equal(back.angle, run.angle)


def held(times, speeds):
    """A run through given speeds [rpm] at given times."""
    time = np.arange(round(times[-1] * RATE) + 1) / RATE
    speed = np.interp(time, times, speeds) / RPM
    angle = np.concatenate([[0.0], np.cumsum(0.5 * (speed[1:] + speed[:-1])) / RATE])
    return RunSignal(time, speed, angle, np.cos(5.0 * angle))


def test_held_speeds_at_the_ends_are_left_out():
    part = held([0.0, 1.0, 3.0, 4.0], [300.0, 300.0, 1500.0, 1500.0]).ramp()
    # One sample: where a kink lies between two of them, either may count.
    assert part.time[0] == pytest.approx(1.0, abs=1.0 / RATE)
    assert part.time[-1] == pytest.approx(3.0, abs=1.0 / RATE)


def test_a_diagram_needs_a_ramp():
    constant = held([0.0, 4.0], [900.0, 900.0])
    refused(constant.ramp, "got 900 to 900 rpm", "`mbs lsa`", "order spectra")
    refused(lambda: campbell(constant, 1.0, 500.0), "allowed: a ramp from one speed to another")
    refused(held([0.0, 1.0, 4.0], [300.0, 900.0, 300.0]).ramp, "got 300 to 300 rpm")
    refused(held([0.0, 1.0, 2.0, 4.0], [300.0, 900.0, 900.0, 1500.0]).ramp, "held or turns round at 1 s and 900 rpm")
    refused(held([0.0, 2.0, 4.0], [300.0, 1500.0, 900.0]).ramp, "turns round at 2 s and 1500 rpm")
    refused(held([0.0, 4.0], [0.0, 0.0]).ramp, "got 0 to 0 rpm")


def test_order_spectra_exist_at_constant_speed():
    spectra = order_spectra(angle_signal(held([0.0, 4.0], [900.0, 900.0]), 500.0))
    assert spectra.orders[np.argmax(spectra.mean())] == pytest.approx(5.0, abs=1e-9)


# Spectra


def test_a_record_that_is_too_slow_says_what_is_needed():
    refused(
        lambda: campbell(ramp(), 1.0, 2000.0), "at least 5000 Hz for a band up to 2000 Hz", "every 0.2 ms", "1600 Hz"
    )
    refused(lambda: angle_signal(ramp(), 2000.0), "at least 5000 Hz")


@pytest.mark.parametrize("window", [0.0, -1.0, np.nan, np.inf, 1e-4, 2.1])
def test_windows_that_do_not_fit_are_refused(window):
    refused(lambda: campbell(ramp(), 1.0, 500.0, window), "spectra, window: got", "0.016 s (8 periods", "to 2 s (half")


def test_a_run_that_is_too_short_is_refused():
    short = ramp(duration=0.02)
    refused(lambda: campbell(short, 1.0, 500.0), "window: got 0.016 s", "record a longer run")
    refused(lambda: angle_signal(ramp(duration=0.05), 500.0), "orders, record: got 0.05 s; allowed: at least")


@pytest.mark.parametrize("band", [(0.0, np.nan), (-1.0, 5.0), (5.0, 5.0), (9.0, np.inf), (7.0, 5.0)])
def test_bands_are_checked(band):
    refused(lambda: short_time_spectra(ramp(), 0.1, band), "band: got", "0 <= lowest < highest")


@pytest.mark.parametrize("highest", [0.0, -5.0, np.nan, np.inf])
def test_highest_frequencies_are_checked(highest):
    refused(lambda: campbell(ramp(), 1.0, highest), "campbell, highest")
    refused(lambda: angle_signal(ramp(), highest), "orders, highest frequency")


def test_a_result_that_is_too_large_is_refused():
    long = ramp(duration=1000.0, rate=5000.0)
    refused(lambda: short_time_spectra(long, 0.004, (0.0, 2000.0)), "allowed: 20000 windows, and 40000000 values")
    refused(lambda: order_spectra(angle_signal(ramp(duration=100.0), 500.0), 0.05), "20000 windows", "longer window")
    refused(lambda: angle_signal(long, 2000.0), "got 20000000 samples", "allowed: 5000000", "higher lowest")


def test_nothing_has_the_lowest_level():
    found = run_up_spectra(ramp(signal=np.zeros_like), 1e-6, 500.0, None, [5.0])
    assert np.all(found.campbell.level == LOWEST)
    assert np.all(found.campbell.sum_level == LOWEST)
    assert np.all(found.tracks.level(1e-6) == LOWEST)
    assert found.peaks == ()


@pytest.mark.parametrize("size", [1e100, 1e-150])
def test_signals_of_any_size_have_levels(size):
    found = run_up_spectra(
        ramp(signal=lambda time: size * np.sin(2.0 * np.pi * 200.0 * time)), size, 500.0, None, [5.0]
    )
    # The sum over all lines of a sine: its effective value; side lobes beyond the band are below 1e-4 dB.
    np.testing.assert_allclose(found.campbell.sum_level, -10.0 * np.log10(2.0), atol=1e-4)


def test_too_many_windows_for_orders_are_refused():
    signal = angle_signal(ramp(duration=100.0), 500.0)
    refused(lambda: track_orders(signal, [100.0] * 50, 0.05), "windows for 50 orders; allowed: 10000000 values")


def test_a_run_from_rest_is_possible():
    found = run_up_spectra(ramp(begin=0.0), 1e-6, 500.0, None, [5.0])
    assert np.all(np.isfinite(found.campbell.level))
    # The order domain begins at a tenth of the highest speed; interpolated between samples.
    assert found.spectra.speeds.min() >= 0.0999 * 1500.0 / RPM


def test_a_coast_down_has_the_same_levels_as_the_run_up():
    up = ramp()
    down = RunSignal(up.time, up.speed[::-1].copy(), up.angle[-1] - up.angle[::-1], up.signal[::-1].copy())
    levels = [
        np.interp(1000.0 / RPM, *zip(*sorted(zip(found.speeds, found.sum_level, strict=True)), strict=True))
        for found in (campbell(run, 1.0, 500.0) for run in (up, down))
    ]
    # The windows lie at other places in a signal that beats; both see the same sines.
    assert levels[0] == pytest.approx(levels[1], abs=0.1)


def test_the_default_window_follows_from_the_sweep():
    run = ramp(300.0, 1500.0, 40.0)
    # 1200 rpm in 40 s are 0.5 turns/s2, order 20 sweeps with 10 Hz/s: sqrt(1.44/10).
    assert default_window(run, 20.0) == pytest.approx(np.sqrt(0.144), rel=1e-6)
    found = campbell(run, 1.0, 500.0, None, 20.0)
    assert found.smear == pytest.approx(found.line_width, rel=1e-2)  # whole samples in a window
    assert default_window(run, 1e-3) == pytest.approx(2.0)


# Orders


@pytest.mark.parametrize("orders", [[], [0.0], [-1.0], [np.nan], [1e9], [[1.0]]])
def test_orders_are_checked(orders):
    signal = angle_signal(ramp(), 500.0)
    refused(lambda: track_orders(signal, orders), "orders: got", "above 0 and below")


@pytest.mark.parametrize("window", [0.0, -1.0, np.nan, np.inf, 1e9])
def test_windows_over_turns_are_checked(window):
    signal = angle_signal(ramp(), 500.0)
    refused(lambda: order_spectra(signal, window), "orders, window of the spectra: got")
    refused(lambda: track_orders(signal, [5.0], window), "orders, window")


def test_a_window_holds_two_periods_of_an_order():
    signal = angle_signal(ramp(), 500.0)
    refused(lambda: track_orders(signal, [0.5], 3.0), "at least 4 turns, 2 periods of order 0.5")
    assert track_orders(signal, [0.5]).window == pytest.approx(4.0, rel=1e-3)  # whole samples in a window


@pytest.mark.parametrize("speed", [0.0, -1.0, np.nan, 1e6])
def test_lowest_speeds_are_checked(speed):
    refused(lambda: angle_signal(ramp(), 500.0, speed), "orders, lowest speed: got", "below the highest of 1500 rpm")


def test_orders_above_the_band_are_no_numbers():
    signal = angle_signal(ramp(), 500.0)
    tracks, spectra = track_orders(signal, [5.0, 50.0]), order_spectra(signal)
    above = 50.0 * tracks.speeds > 2.0 * np.pi * 500.0
    assert above.any() and not above.all()
    np.testing.assert_array_equal(np.isnan(tracks.amplitude[:, 1]), above)
    assert np.all(np.isfinite(tracks.amplitude[:, 0]))
    np.testing.assert_array_equal(
        np.isnan(spectra.power), spectra.speeds[:, None] * spectra.orders > 2.0 * np.pi * 500.0
    )


def test_peaks_are_local_maxima_strongest_first():
    speeds = np.linspace(10.0, 20.0, 101)
    amplitude = np.stack(
        [1.0 + 9.0 * np.exp(-((speeds - 12.0) ** 2)) + 4.0 * np.exp(-((speeds - 17.0) ** 2)), speeds], axis=1
    ).astype(complex)
    amplitude[90:, 0] = np.nan
    tracks = OrderTracks(speeds, speeds, np.array([3.0, 6.0]), amplitude, 2.0)
    first, second = order_peaks(tracks, 1.0)
    assert (first.order, first.speed) == (3.0, pytest.approx(12.0))
    assert second.speed == pytest.approx(17.0)
    assert first.frequency == pytest.approx(3.0 * 12.0 / (2.0 * np.pi))
    assert first.level == pytest.approx(20.0 * np.log10(10.0 / np.sqrt(2.0)))
    # From the end of what is known, which is the higher valley, to 5; the first peak's tail is 1e-6 there.
    assert second.prominence == pytest.approx(20.0 * np.log10(5.0 / (1.0 + 4.0 * np.exp(-(1.9**2)))), rel=1e-5)
    assert order_peaks(tracks, 1.0, count=1) == (first,)
    assert order_peaks(tracks, 1.0, prominence=17.0) == (first,)


# Levels and settings


def test_references_are_those_of_the_quantity():
    along, about = np.array([0, 1, 0, 0, 0, 0]), np.array([0, 0, 0, 0, 1, 0])
    texts = {
        kind: Reference.of(Sensor("s", "body", along, kind)).text
        for kind in ("displacement", "velocity", "acceleration")
    }
    # ISO 1683:2015 as another public implementation of it has the values; the standard itself was not at hand.
    assert texts == {
        "displacement": "dB re 1e-12 m",
        "velocity": "dB re 1e-09 m/s",
        "acceleration": "dB re 1e-06 m/s2",
    }
    assert Reference.of(Sensor("s", "body", about, "velocity")).text == "dB re 1e-09 rad/s"


def test_levels_keep_what_is_not_known():
    np.testing.assert_array_equal(level(np.array([np.nan, 0.0, 1e-300]), 1.0), [np.nan, LOWEST, LOWEST])


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


# Files and figures


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
        "omega b/u = 0.3: films not valid above",
        "up to 400 rpm: below the map, film fades to dry",
    ]


def test_an_oscillation_leaves_nothing_at_order_and_frequency_zero():
    """Windows cut it anywhere; the plain mean of a window is then -60 dB of it, and seen at the lowest lines."""
    run = ramp(signal=lambda time: np.sin(2.0 * np.pi * 303.7 * time))
    turned = order_spectra(angle_signal(run, 800.0))
    low = turned.orders < 3.0
    # The side lobes of a Hann window fall with the cube of the distance: 303.7 Hz are 12 orders or more, 97 lines.
    assert 10.0 * np.log10(np.nanmax(turned.mean()[low]) / np.nanmax(turned.mean())) < -100.0
    found = short_time_spectra(run, 0.2, (0.0, 800.0))
    slow = found.frequencies < 60.0
    assert 10.0 * np.log10(found.power[:, slow].max() / found.power.max()) < -100.0


def test_a_constant_is_no_oscillation():
    turned = order_spectra(angle_signal(ramp(signal=lambda time: 0.0 * time + 3.0), 800.0))
    # 1e-9: the band filter keeps a constant to 100 dB
    assert np.nanmax(turned.power) < 9.0 * 1e-9


def test_silence_can_be_drawn(tmp_path):
    nothing = run_up_spectra(ramp(signal=np.zeros_like), 1e-6, 500.0)
    campbell_figure("title", ["a"], [nothing], REFERENCE).savefig(tmp_path / "figure.png")


# The command


def arguments(scene, **values):
    names = ("law", "map", "clearance", "output", "plot", "sensor", "highest", "window")
    return argparse.Namespace(**{**dict.fromkeys(names), "modes": False, "scene": str(scene), **values})


@pytest.fixture(scope="module")
def scene(tmp_path_factory):
    """The shipped NU308 with a short run."""
    text = (resources.files("mbs") / "systems" / "nu308_rigid.toml").read_text(encoding="utf-8")
    path = tmp_path_factory.mktemp("scene") / "short.toml"
    path.write_text(
        text.replace('from = "0 rpm"', 'from = "2000 rpm"')
        .replace('to = "2000 rpm"', 'to = "5000 rpm"')
        .replace('duration = "0.2 s"', 'duration = "0.08 s"')
        .replace('sample = "0.1 ms"', "")
        .replace("slices = 41", "slices = 5")
    )
    return path


def run_command(*values, **more):
    return importlib.import_module("mbs.commands.campbell").run(arguments(*values, **more))


def test_the_command_compares_laws(scene, tmp_path, capsys):
    out, plot = tmp_path / "out.nc", tmp_path / "figure.png"
    text, status = run_command(
        scene, law=["hertz", "constant:hertz"], clearance=["20 um"], output=str(out), plot=str(plot), modes=True
    )
    assert status == 0
    assert "sensor S1, dB re 1e-06 m/s2" in text
    assert text.count("highest sum level") == 2
    with xr.open_dataset(out) as data:
        dry, other = data["sum_level"].values
    # told at the same speed, and not only where each is highest
    assert f"  constant hertz beside dry Hertz: {difference_text(dry, other)}" in text
    assert f"median {np.median(other - dry):.1f} dB" in text
    assert plot.stat().st_size > 10_000
    with xr.open_dataset(out) as data:
        assert data["law"].values.tolist() == ["dry Hertz", "constant hertz"]
        assert np.all(np.isfinite(data["level"]))
        # Rollers pass 12 times a turn of the cage.
        assert data["track"].values[0] == pytest.approx(12.0 * 0.3939, rel=1e-3)  # digits of the cage's speed
        assert data.attrs["law"].startswith("dry Hertz: dry Hertz, ISO 16281; constant hertz: constant hertz: ")
    assert capsys.readouterr().out == ""


@pytest.mark.parametrize(
    ("lowest", "words"), [(0.0, ""), (400.0, "in windows that do not reach there"), (2e3, "all windows")]
)
def test_a_highest_level_below_the_map_is_said_to_be_one(spectra, monkeypatch, lowest, words):
    command = importlib.import_module("mbs.commands.campbell")
    monkeypatch.setattr(command, "fade_of", lambda model: Fade(lowest / RPM, 0.05, "the map") if lowest else None)
    loud = spectra.campbell.sum_level.copy()
    loud[0] = 300.0
    changed = dataclasses.replace(spectra, campbell=dataclasses.replace(spectra.campbell, sum_level=loud))
    run = ramp()
    entry = types.SimpleNamespace(spectra=changed, record=run, case=types.SimpleNamespace(model=None))
    fading = command._fading(entry)
    speeds, half = changed.campbell.speeds, 0.5 * changed.campbell.window * 300.0 / RPM
    # The speed rises by 300 rpm a second; windows that begin within a sample of the edge are left open.
    assert np.all(fading[speeds - half < 0.99 * lowest / RPM])
    assert not np.any(fading[speeds - half > 1.01 * lowest / RPM])
    said = command._elsewhere(entry, 0)
    assert words in said and bool(said) == bool(lowest)
    if lowest == 400.0:
        best = int(np.argmax(np.where(fading, -np.inf, loud)))
        assert f"{loud[best]:.1f} dB at {speeds[best] * RPM:.4g} rpm" in said


def test_the_command_lists_every_problem(scene):
    problems = refused(
        lambda: run_command(
            scene, law=["hertz", "hertz", "nonsense", "formula", "map"], clearance=["20 kg"], window="3 m"
        ),
        "--law: got 'hertz' twice",
        "--law: got 'nonsense'",
        "--clearance",
        "--window: got the unit 'm'",
    )
    assert len(problems) == len(set(problems))
    laws = ["hertz", "constant:hertz", "constant:reynolds", "constant:cfd"]
    refused(
        lambda: run_command(scene, law=laws, clearance=["0 um", "20 um"]), "got 8 combinations; allowed: up to 4 side"
    )
    refused(
        lambda: run_command(scene, sensor="aproach", highest="50 kHz", window="3 m"),
        "sensor 'aproach' is not there (did you mean 'approach'?); allowed: S1, approach",
        "step: got 20 us; allowed: up to 8 us for frequencies up to 5e+04 Hz",
        "--window: got",
    )
    refused(lambda: run_command(scene, plot="figure.xyz"), "--plot: got figure.xyz; allowed: a file that ends in .png")
    refused(lambda: run_command(scene, highest="1 nHz"), "--highest: got '1 nHz'; allowed: 1 Hz to 1e+06 Hz")


def test_orders_above_the_band_are_left_out(scene, tmp_path):
    out, path = tmp_path / "out.nc", tmp_path / "longer.toml"
    path.write_text(scene.read_text().replace('"0.08 s"', '"0.25 s"'))
    # Rollers pass 4.73 times a turn, which is 158 Hz at 2000 rpm and twice that for the second harmonic.
    run_command(path, highest="250 Hz", output=str(out))
    with xr.open_dataset(out) as data:
        np.testing.assert_allclose(data["track"], [4.727], rtol=1e-3)  # digits


GEARS = """
schema = 1
[operation]
speed = "1000 rpm"
temperature = "60 degC"
[[bodies]]
name = "first"
freedoms = ["y", "z", "theta_x"]
position = ["0 mm", "0 mm", "0 mm"]
spin = -2
mass = "2 kg"
polar_inertia = "0.01 kg m^2"
transverse_inertia = "0.01 kg m^2"
[[bodies]]
name = "second"
freedoms = ["y", "z", "theta_x"]
position = ["0 mm", "99 mm", "0 mm"]
spin = 1.826086956521739
mass = "2 kg"
polar_inertia = "0.01 kg m^2"
transverse_inertia = "0.01 kg m^2"
[[springs]]
name = "hold_first"
on = "first"
stiffness = { y = "1e8 N/m", z = "1e8 N/m", theta_x = "10 N m/rad" }
damping = { y = "500 N s/m", z = "500 N s/m" }
[[springs]]
name = "hold_second"
on = "second"
stiffness = { y = "1e8 N/m", z = "1e8 N/m", theta_x = "10 N m/rad" }
damping = { y = "500 N s/m", z = "500 N s/m" }
[[loads]]
name = "drive"
on = "first"
moment = ["82 N m", "0 N m", "0 N m"]
[[loads]]
name = "brake"
on = "second"
moment = ["89.8 N m", "0 N m", "0 N m"]
[[gears]]
name = "mesh"
on = "first"
against = "second"
teeth = [21, 23]
module = "4.5 mm"
pressure_angle = "20 deg"
face_width = "25 mm"
stiffness = "14 N/(um mm)"
damping = "1e3 N s/m"
backlash = "0.1 mm"
transmission_error = ["0.5 um"]
[[sensors]]
name = "top"
on = "second"
direction = "y"
quantity = "acceleration"
[campbell]
highest = "3 kHz"
[runup]
from = "500 rpm"
to = "1500 rpm"
duration = "0.3 s"
step = "40 us"
"""


def test_orders_are_those_of_the_gears(tmp_path):
    out, path = tmp_path / "out.nc", tmp_path / "gears.toml"
    path.write_text(GEARS)
    assert run_command(path, output=str(out))[1] == 0
    with xr.open_dataset(out) as data:
        # 21 teeth on a shaft that turns twice as fast as the system.
        np.testing.assert_allclose(data["track"], 42.0 * np.arange(1, 6))
        # Each stands out of the orders half way to the next one; by more than 25 dB in a longer run.
        order, level = data["order"].values, data["order_level"].values[0]
        for mesh in (42.0, 84.0, 126.0):
            assert np.interp(mesh, order, level) > np.interp(mesh + 21.0, order, level) + 10.0
        assert data.attrs["sensor"] == "top"


def test_options_go_before_the_scene(tmp_path):
    out, path = tmp_path / "out.nc", tmp_path / "gears.toml"
    path.write_text(GEARS.replace('highest = "3 kHz"', 'highest = "3 kHz"\nwindow = "20 ms"\norders = [42]'))
    run_command(path, output=str(out), highest="2 kHz", window="30 ms")
    with xr.open_dataset(out) as data:
        assert data.attrs["window_s"] == pytest.approx(0.03, rel=1e-2)  # whole samples
        assert 1950.0 < data["frequency"][-1] <= 2000.0
        np.testing.assert_array_equal(data["track"], [42.0])


def test_the_command_needs_a_run_and_a_sensor(scene, tmp_path):
    text = scene.read_text()
    path = tmp_path / "still.toml"
    path.write_text(text[: text.index("[runup]")].replace('"acceleration"', '"velocity"'))
    refused(
        lambda: run_command(path), "[runup] missing", "has no sensor of an acceleration; allowed: one of S1, approach"
    )


def test_the_command_refuses_a_constant_speed(scene, tmp_path):
    path = tmp_path / "constant.toml"
    path.write_text(scene.read_text().replace('to = "5000 rpm"', 'to = "2000 rpm"'))
    refused(lambda: run_command(path), "allowed: a ramp from one speed to another", "mbs lsa")


def test_the_command_looks_at_the_window_before_it_runs(scene, monkeypatch):
    command = importlib.import_module("mbs.analyses.campbell")
    monkeypatch.setattr(command, "run_system", lambda *_, **__: pytest.fail("ran"))
    refused(lambda: run_command(scene, window="1 s"), "spectra, window: got 1.0 s")


def test_a_law_without_a_result_leaves_the_others(scene, monkeypatch):
    command = importlib.import_module("mbs.analyses.campbell")
    first = []

    def fails_once(*values, **more):
        if not first:
            first.append(True)
            raise AnalysisError("no solution at 0.1 s")
        return run(*values, **more)

    monkeypatch.setattr(command, "run_system", fails_once)
    text, status = run_command(scene, law=["hertz", "constant:hertz"])
    assert status == 1
    assert "warning: dry Hertz: no solution at 0.1 s" in text
    assert text.count("highest sum level") == 1
    monkeypatch.setattr(command, "run_system", fails_once)
    first.clear()
    with pytest.raises(AnalysisError, match="dry Hertz: no solution"):
        run_command(scene)
