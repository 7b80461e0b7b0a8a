"""Spectra over speed and orders against closed forms, energy balances and second methods."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.integrate import quad, solve_ivp
from scipy.signal import get_window

from mbs.spectral.campbell import campbell, run_up_spectra
from mbs.spectral.orders import angle_signal, order_peaks, order_spectra, track_orders
from mbs.spectral.run_signal import RPM, RunSignal
from mbs.spectral.spectra import default_window, short_time_spectra

TURN = 2.0 * math.pi

BETWEEN_LINES = 0.09
"""By how much a sine between two lines is lower [dB]: sinc(d)/(1 - d^2) of a Hann window at d = 1/8."""


def run_up(begin, end, duration, rate, signal):
    """A linear ramp [rpm] and a signal of (time, angle)."""
    time = np.arange(round(duration * rate) + 1) / rate
    rise = (end - begin) / duration / RPM
    speed = begin / RPM + rise * time
    angle = begin / RPM * time + 0.5 * rise * time**2
    return RunSignal(time, speed, angle, signal(time, angle))


@pytest.mark.parametrize("window", [0.02, 0.05, 0.1, 0.3333])
@pytest.mark.parametrize("frequency", [250.0, 301.7, 999.3])
def test_the_level_of_a_sine_is_that_of_its_effective_value(window, frequency):
    run = run_up(500.0, 600.0, 2.0, 10000.0, lambda t, a: 3.0 * np.sin(TURN * frequency * t + 0.7))
    found = campbell(run, 1e-6, 2000.0, window)
    expected = 20.0 * math.log10(3.0 / math.sqrt(2.0) / 1e-6)
    peak = found.level.max(axis=1)
    # Below: between two lines. Above: the mirror image at the negative frequency, whose lobes at 5 lines from it and
    # beyond are under 1e-3 of the main one.
    assert np.all(peak > expected - BETWEEN_LINES - 0.01)
    assert np.all(peak < expected + 0.01)
    # Half the distance of lines, which are four times denser than 1/window or a little more.
    assert np.all(np.abs(found.frequencies[found.level.argmax(axis=1)] - frequency) <= 0.13 / window)


def test_the_sum_over_all_lines_is_the_mean_square_in_the_window():
    random = np.random.default_rng(3)
    run = run_up(500.0, 900.0, 1.0, 8000.0, lambda t, a: 5.0 + random.normal(size=t.size))
    spectra = short_time_spectra(run, 0.05, (0.0, 3200.0))
    # Nothing of the sum is left out here: the same with all lines up to half the rate, by the module's own parts.
    length = round(0.05 * 8000.0)
    weights = get_window("hann", length)
    low = np.fft.rfftfreq(length * 4, 1.0 / 8000.0) <= 3200.0
    for index in (0, 7, spectra.time.size - 1):
        middle = round(spectra.time[index] * 8000.0)
        part = run.signal[middle - length // 2 : middle - length // 2 + length]
        values = (part - np.average(part, weights=weights)) * weights
        padded = np.fft.irfft(np.where(low, np.fft.rfft(values, 4 * length), 0.0), 4 * length)
        # Round-off: both are sums of some 1000 squares.
        assert spectra.mean_square()[index] == pytest.approx(np.sum(padded**2) / np.sum(weights**2), rel=1e-10)


def test_windows_together_hold_the_energy_of_noise_in_the_band():
    random = np.random.default_rng(5)
    run = run_up(500.0, 900.0, 20.0, 8000.0, lambda t, a: random.normal(size=t.size))
    found = campbell(run, 1.0, 3200.0, 0.05)
    part = (3200.0 - found.frequencies[0]) / 4000.0
    # Four standard deviations of the variance of 160 000 samples, 4 sqrt(2/160000) = 1.4 %, and half a line at either
    # end of the band, 0.2 %.
    assert np.mean(10.0 ** (found.sum_level / 10.0)) == pytest.approx(part, rel=0.016)


def test_the_sum_level_of_two_sines_adds_their_squares():
    run = run_up(
        500.0, 600.0, 2.0, 10000.0, lambda t, a: 3.0 * np.sin(TURN * 300.0 * t) + 4.0 * np.cos(TURN * 811.0 * t)
    )
    found = campbell(run, 1.0, 2000.0, 0.1)
    # Beyond the lowest line and the highest are side lobes of less than 1e-6 of the power of a sine: 1e-5 dB.
    np.testing.assert_allclose(found.sum_level, 10.0 * math.log10(12.5), atol=1e-4)


@pytest.mark.parametrize("order", [11.0, 21.0, 42.0])
def test_an_order_is_as_low_as_a_chirp_in_a_hann_window(order):
    rise = 20.0  # turns/s2
    run = run_up(600.0, 600.0 + 60.0 * rise * 2.0, 2.0, 20000.0, lambda t, a: np.sin(order * a + 0.4))
    found = campbell(run, 1.0, 5000.0, None, 42.0)
    assert found.window == pytest.approx(math.sqrt(1.44 / (42.0 * rise)), rel=2e-3)  # whole samples
    there = (order * found.speeds / TURN > 400.0) & (order * found.speeds / TURN < 4500.0)
    measured = found.level[there].max(axis=1) - 20.0 * math.log10(1.0 / math.sqrt(2.0))

    # The same by quadrature: the phase of a chirp, pi (sweep) t^2, over the weights of the window.
    sweep = order * rise * found.window**2

    def part(function):
        return quad(lambda t: math.cos(math.pi * t) ** 2 * function(math.pi * sweep * t * t), -0.5, 0.5)[0] / 0.5

    expected = 20.0 * math.log10(math.hypot(part(math.cos), part(math.sin)))
    assert expected > -0.14  # what the module says of its default window: 0.13 dB
    assert np.all(measured < expected + 0.01)
    assert np.all(measured > expected - BETWEEN_LINES - 0.01)


def test_a_locked_order_is_one_sharp_line_at_all_speeds():
    run = run_up(500.0, 2500.0, 5.0, 20000.0, lambda t, a: 2.5 * np.cos(21.0 * a + 0.3))
    signal = angle_signal(run, 2000.0)
    spectra = order_spectra(signal)
    assert spectra.window == pytest.approx(8.0)
    assert spectra.speeds.min() < 700.0 / RPM and spectra.speeds.max() > 2400.0 / RPM
    place = np.argmin(np.abs(spectra.orders - 21.0))
    assert spectra.orders[place] == pytest.approx(21.0, abs=1e-9)
    # Filter (100 dB) and splines keep the amplitude within 1e-4 (module docstring).
    np.testing.assert_allclose(np.sqrt(2.0 * spectra.power[:, place]), 2.5, rtol=1e-4)
    # Beyond the main lobe of 2/window are the side lobes of a Hann window, sinc(x)/(1 - x^2); 1 % for the mirror image.
    beside = np.abs(spectra.orders - 21.0) > 2.0 / spectra.window
    x = np.linspace(2.001, 4.0, 1000)
    side_lobe = np.max(np.abs(np.sinc(x) / (1.0 - x**2)))
    assert np.nanmax(spectra.power[:, beside]) < 0.5 * 2.5**2 * side_lobe**2 * 1.01

    tracks = track_orders(signal, [21.0, 20.0, 22.0, 42.0])
    np.testing.assert_allclose(tracks.amplitude[:, 0], 2.5 * np.exp(0.3j), rtol=1e-4)
    # 2/window beside it and beyond: zeros of the window at whole numbers, and what the filter leaves.
    assert np.nanmax(np.abs(tracks.amplitude[:, 1:])) < 2.5 * 2e-4


def test_orders_of_another_shaft_are_found_too():
    other = 21.0 / 23.0
    run = run_up(500.0, 2500.0, 5.0, 20000.0, lambda t, a: np.cos(other * a) + 0.5 * np.cos(21.0 * a))
    tracks = track_orders(angle_signal(run, 2000.0), [other, 21.0], 8.0)
    # The transform of the window is below 1/(pi x^3) at x lines: 1e-4 from the mirror image of the first order,
    # 2 x 0.913 x 8 = 14.6 lines away, and 1e-7 from the other order, 160 lines away. Filter and splines: 1e-4.
    np.testing.assert_allclose(np.abs(tracks.amplitude), np.broadcast_to([1.0, 0.5], tracks.amplitude.shape), rtol=3e-4)


@pytest.mark.parametrize("rate", [5000.0, 7000.0, 50000.0])
def test_the_whole_band_survives_the_way_to_angles(rate):
    highest = 2000.0
    frequency = 0.999 * highest
    run = run_up(1000.0, 2000.0, 2.0, rate, lambda t, a: np.cos(TURN * frequency * t + 0.2))
    signal = angle_signal(run, highest)
    # Ripple of the filter 1e-5, interpolation at ten samples a period 2 (1/9)^6 = 4e-6; the time of an angle is off by
    # (rise of the speed) dt^2/8 over the speed, 5e-9 s at most: 6e-5 of a period.
    np.testing.assert_allclose(signal.signal, np.cos(TURN * frequency * signal.time + 0.2), atol=2e-5 + 6.3e-5)


def test_what_lies_above_the_band_is_not_folded_into_it():
    run = run_up(1000.0, 2000.0, 2.0, 20000.0, lambda t, a: np.cos(TURN * 2600.0 * t) + np.cos(TURN * 7777.0 * t))
    # 100 dB of attenuation from 1.25 times the highest frequency on.
    assert np.max(np.abs(angle_signal(run, 2000.0).signal)) < 2e-5


def resonance(frequency, natural, damping):
    """Acceleration of an oscillator over that of its base, amplitude."""
    ratio = frequency / natural
    return ratio**2 / np.hypot(1.0 - ratio**2, 2.0 * damping * ratio)


def test_peaks_along_orders_are_where_a_resonance_is():
    """Two orders whose amplitudes follow the steady response of an oscillator, in closed form."""
    natural, damping = 500.0, 0.03

    def signal(time, angle):
        speed = (500.0 + 400.0 * time) / 60.0
        return sum(resonance(order * speed, natural, damping) * np.cos(order * angle) for order in (21.0, 42.0))

    run = run_up(500.0, 2500.0, 5.0, 20000.0, signal)
    tracks = track_orders(angle_signal(run, 4000.0), [21.0, 42.0])
    peaks = order_peaks(tracks, 1.0, count=2)
    # Largest acceleration at w0/sqrt(1 - 2 z^2), of the size 1/(2 z sqrt(1 - z^2)).
    at, size = natural / math.sqrt(1.0 - 2.0 * damping**2), 1.0 / (2.0 * damping * math.sqrt(1.0 - damping**2))
    assert {peak.order for peak in peaks} == {21.0, 42.0}
    for peak in peaks:
        speed = peak.speed / TURN
        # The distance of windows, an eighth of 2 turns at a rise of 6.67 turns/s2.
        distance = peak.order * 6.67 / speed * 0.25
        assert abs(peak.frequency - at) < distance
        # Averaged over a window (variance 0.0327 T^2) the top, of curvature size/(z natural)^2, is lower by half of
        # their product; and by the same for half a distance.
        sweep = peak.order * 6.67 * 2.0 / speed
        lower = 0.5 * (0.0327 * sweep**2 + distance**2 / 4.0) / (damping * natural) ** 2
        level = 20.0 * math.log10(size / math.sqrt(2.0))
        assert level + 20.0 * math.log10(1.0 - lower) - 0.05 < peak.level < level + 0.01


def test_an_oscillator_in_a_real_run_up_peaks_behind_its_resonance():
    """Its equation of motion solved in time: the peak comes later than at rest, by less than its half-power band."""
    natural, damping, order = 150.0, 0.02, 5.0
    omega, rise = TURN * natural, 900.0 / 60.0 * TURN / 3.0

    def angle(time):
        return 1200.0 / RPM * time + 0.5 * rise * time * time

    rate = 2500.0
    time = np.arange(round(3.0 * rate) + 1) / rate
    solution = solve_ivp(
        lambda t, y: (y[1], math.cos(order * angle(t)) - 2.0 * damping * omega * y[1] - omega**2 * y[0]),
        (0.0, 3.0),
        (0.0, 0.0),
        t_eval=time,
        method="DOP853",
        rtol=1e-8,
        atol=1e-12,
    )
    run = RunSignal(time, 1200.0 / RPM + rise * time, angle(time), solution.y[0])
    found = run_up_spectra(run, 1e-12, 400.0, None, [order])
    (peak,) = found.peaks
    static = natural * math.sqrt(1.0 - 2.0 * damping**2)
    # Half-power band: 2 z f = 6 Hz; sweep 25 Hz/s, time constant 1/(z w) = 53 ms: 1.3 Hz of delay.
    assert static < peak.frequency < static + 3.0
    # Steady amplitude 1/(2 z w^2); it has not enough time to reach it, and the window lowers it: within 1 dB.
    steady = 20.0 * math.log10(1.0 / (2.0 * damping * omega**2) / math.sqrt(2.0) / 1e-12)
    assert steady - 1.0 < peak.level < steady + 0.05
    # The diagram, another way of analysis, has its ridge at the same place within a line.
    row, column = np.unravel_index(np.argmax(found.campbell.level), found.campbell.level.shape)
    assert found.campbell.frequencies[column] == pytest.approx(peak.frequency, abs=found.campbell.line_width)
    assert found.campbell.level[row, column] == pytest.approx(peak.level, abs=0.5)  # two windows over one resonance


def test_ridges_are_wider_with_half_the_window_and_with_four_times_of_it():
    run = run_up(600.0, 3000.0, 2.0, 20000.0, lambda t, a: np.cos(42.0 * a))
    best = default_window(run, 42.0)

    def width(window):
        found = campbell(run, 1.0, 4000.0, window)
        row = np.argmin(np.abs(found.speeds * RPM - 1500.0))
        high = found.frequencies[found.level[row] > found.level[row].max() - 3.0103]
        return high[-1] - high[0]

    # 1.46/T at rest and sweep together; 1.44/T alone at half of it; by the sweep alone, over the part 0.364 T of the
    # window that weighs more than 3 dB, at four times of it. Errors: a line at either end, 1/(4 T).
    assert width(best) == pytest.approx(1.46 / best, abs=0.5 / best)
    assert width(0.5 * best) == pytest.approx(1.44 / (0.5 * best), abs=0.5 / (0.5 * best))
    assert width(4.0 * best) == pytest.approx(0.364 * 42.0 * 20.0 * 4.0 * best, rel=0.25)
    assert width(best) < min(width(0.5 * best), width(4.0 * best))
