"""Sounds of sensors, and waterfalls of levels."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.io import wavfile

from ehdmaps.errors import InputError
from ehdmaps.outputs import has_mark
from mbs import cli
from mbs.output.waterfall_plot import Waterfall, waterfall_figure
from mbs.timedata.records import TimeChannel, TimeRecord
from mbs.timedata.wav_file import RATE, sound_channel, write_sound

STEP = 1e-5
TIME = np.arange(20_001) * STEP


def record(*channels):
    values = np.column_stack([3.0 + 2.0 * np.sin(2.0 * np.pi * f * TIME) for f in (1000.0, 400.0)])
    return TimeRecord("run", TIME, channels, values)


class TestSound:
    def test_a_tone_is_heard_as_it_is(self, tmp_path):
        path = tmp_path / "s.wav"
        channels = TimeChannel("d", "displacement", "m"), TimeChannel("S1", "acceleration", "m/s2")
        run = record(*channels)
        assert sound_channel(run, None, "--sound") is channels[1]
        assert sound_channel(run, "D", "--sound") is channels[0]
        with pytest.raises(InputError, match="--sound: 'S9' is not there"):
            sound_channel(run, "S9", "--sound")
        (line,) = write_sound(path, run, channels[1])
        rate, samples = wavfile.read(path)
        assert (rate, samples.dtype, samples.ndim) == (RATE, np.int16, 1)
        assert samples.size == pytest.approx(TIME[-1] * RATE, abs=2)
        spectrum = np.abs(np.fft.rfft(samples * np.hanning(samples.size)))
        # lines of 5 Hz; the mean of 3 is not heard
        assert np.fft.rfftfreq(samples.size, 1.0 / RATE)[np.argmax(spectrum)] == pytest.approx(400.0, abs=5.0)
        # 2 m/s2 is 0.9 of full scale, but for the ripple of the filter at both ends of the record
        assert float(line.rpartition("full scale ")[2].split()[0]) == pytest.approx(2.0 / 0.9, rel=0.1)
        assert has_mark(path)
        write_sound(path, run, channels[1])
        (tmp_path / "mine.wav").write_bytes(path.read_bytes()[:1000])
        with pytest.raises(InputError, match="is not a sound of mbs"):
            write_sound(tmp_path / "mine.wav", run, channels[1])

    def test_of_a_recorded_run(self, tmp_path, monkeypatch, capsys):
        monkeypatch.chdir(tmp_path)
        rows = ["time [s],S1 [m/s2]", *(f"{t:.6g},{np.sin(3000.0 * t):.6g}" for t in TIME[:2000].tolist())]
        (tmp_path / "r.csv").write_text("\n".join(rows) + "\n")
        assert cli.main(["runup", "r.csv", "--sound", "s.wav", "S1"]) == 0
        assert "s.wav: written, S1 over" in capsys.readouterr().out
        for more, message in (
            (["s.wav", "S2"], "--sound: 'S2' is not there"),
            (["s.wav", "S1", "S2"], "--sound: got 3 values; allowed: a file, and a sensor"),
            (["s.mp3"], "--sound: got s.mp3; allowed: a file that ends in .wav"),
        ):
            assert cli.main(["runup", "r.csv", "--sound", *more]) == 2
            assert message in capsys.readouterr().err


class TestWaterfall:
    @pytest.mark.parametrize("frequencies", [np.linspace(10.0, 500.0, 80), np.geomspace(10.0, 500.0, 80)])
    def test_lines_of_orders_lie_on_the_ridge(self, frequencies):
        speeds = np.linspace(20.0, 100.0, 50)
        ridge = 21.0 * speeds / (2.0 * np.pi)
        level = 100.0 - 0.5 * np.abs(frequencies[None, :] - ridge[:, None])
        figure = waterfall_figure("title", [Waterfall("law $x$", speeds, frequencies, level)], "dB", [(21.0, "21")])
        figure.canvas.draw()
        left, right = figure.axes[:2]
        (line,), (other,) = left.lines, right.lines
        rpm, place = line.get_data()
        np.testing.assert_allclose(place, 21.0 * rpm / 60.0, rtol=1e-12)
        np.testing.assert_allclose(np.column_stack(other.get_data()), np.column_stack([place, rpm]), rtol=1e-12)
        # the map is brightest there, within a line of the frequencies
        best = frequencies[np.argmax(left.collections[0].get_array().reshape(level.T.shape), axis=0)]
        apart = np.max(np.diff(frequencies))
        np.testing.assert_allclose(best, np.clip(ridge, frequencies[0], frequencies[-1]), atol=apart)

    def test_orders_beyond_the_axes_are_left_out(self):
        case = Waterfall("a", np.array([10.0, 20.0]), np.array([1.0, 2.0, 3.0]), np.zeros((2, 3)))
        figure = waterfall_figure("title", [case], "dB", [(100.0, "100")])
        assert not figure.axes[0].lines and not figure.axes[1].lines
