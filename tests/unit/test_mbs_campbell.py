"""Spectra of run-ups over speed: windows, bands, orders, levels and peaks."""

from __future__ import annotations

import numpy as np
import pytest

from mbs.model.elements import Sensor
from mbs.spectral.campbell import campbell, run_up_spectra
from mbs.spectral.levels import LOWEST, Reference, level
from mbs.spectral.orders import OrderTracks, angle_signal, order_peaks, order_spectra, track_orders
from mbs.spectral.run_signal import RPM, RunSignal
from mbs.spectral.spectra import default_window, short_time_spectra
from tests.cases.run_up import held, ramp, refused


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


@pytest.mark.slow
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


@pytest.fixture(scope="module")
def spectra():
    return run_up_spectra(ramp(), 1e-6, 500.0, None, [5.0, 10.0])


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
