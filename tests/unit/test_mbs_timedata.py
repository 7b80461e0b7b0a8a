"""Time data of runs: in and out without a change of level, with any kind of speed, and hostile files refused."""

from __future__ import annotations

import dataclasses
import wave

import numpy as np
import pytest
import xarray as xr

from ehdmaps.errors import InputError
from mbs import cli
from mbs.analyses.recorded import recorded_campbell
from mbs.output.time_files import ENDINGS, read_time_data, write_time_data
from mbs.settings import CampbellSettings
from mbs.spectral.spectra import amplitude_spectrum
from mbs.timedata.pulses import counted, rising_flanks
from mbs.timedata.records import TimeData
from mbs.timedata.speed import AS_IT_IS, SpeedSource, with_speed
from tests.cases.run_up import refused
from tests.cases.time_data import CHIRP, MACHINE, ORDER, RATE, SINE, known

LOOK = CampbellSettings(highest=1000.0, window=0.1, orders=(ORDER,))


def level(amplitude, reference):
    return 20.0 * np.log10(amplitude / np.sqrt(2.0) / reference)


@pytest.fixture
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "machine.toml").write_text(MACHINE, encoding="utf-8")
    return tmp_path


def run(capsys, *arguments):
    status = cli.main([str(entry) for entry in arguments])
    captured = capsys.readouterr()
    return status, captured.out, captured.err


class TestLevels:
    @pytest.mark.parametrize("ending", ENDINGS)
    def test_a_file_changes_no_level(self, here, ending):
        path = here / f"run{ending}"
        said = write_time_data(path, TimeData("closed form", (known(),)))
        assert said[0] == f"{path}: written"
        found = recorded_campbell(read_time_data(path), LOOK, ["all"]).runs[0]
        assert [channel.name for channel in found.channels] == ["S1", "a longer name"]
        # 0.01 dB bounds what the side lobes of the window leave outside the band; files of twelve digits, and of
        # floating numbers of 24 bits, change levels by less than 1e-6 dB.
        sine, chirp = (spectra.campbell.sum_level for spectra in found.spectra)
        np.testing.assert_allclose(sine, level(SINE, 1e-6), rtol=0.0, atol=0.01)
        np.testing.assert_allclose(chirp, level(CHIRP, 1e-9), rtol=0.0, atol=0.01)
        # The order is tracked with the amplitude kept within 1e-4, 0.001 dB.
        track = found.spectra[1].tracks.level(1e-9)[:, 0]
        np.testing.assert_allclose(track, level(CHIRP, 1e-9), rtol=0.0, atol=0.01)

    def test_an_amplitude_about_a_speed(self):
        record = known()
        found = amplitude_spectrum(record.signal(record.channels[0]), 40.0 * np.pi, 0.1, 1000.0)
        assert found.time == pytest.approx(1.0, abs=1.0 / RATE)
        # between two lines a sine is low by up to 0.09 dB, 1 %
        assert found.amplitude.max() == pytest.approx(SINE, rel=0.01)
        assert found.frequencies[np.argmax(found.amplitude)] == pytest.approx(700.0, abs=2.5)
        refused(
            lambda: amplitude_spectrum(record.signal(record.channels[0]), 20.0 * np.pi, 0.1, 1000.0),
            "got 600 rpm; allowed: 630 to 1770 rpm",
        )

    def test_a_wave_of_16_bits_in_g(self, here):
        """What a recorder writes, with a table that somebody wrote by hand."""
        time = np.arange(4000) / 4000.0
        samples = np.stack([np.round(16384 * np.sin(2.0 * np.pi * 400.0 * time)), 8000.0 + 4.0 * np.arange(4000)], 1)
        with wave.open("r.wav", "wb") as file:
            file.setparams((2, 2, 4000, 4000, "NONE", ""))
            file.writeframes(samples.astype("<i2").tobytes())
        (here / "r.wav.toml").write_text(
            'channels = [{ name = "a", unit = "g", full_scale = 2 }, { name = "n", unit = "rpm", full_scale = 3277 }]'
        )
        found = recorded_campbell(read_time_data("r.wav"), LOOK).runs[0].spectra[0]
        # half of 2 g; noise of the quantisation is 98 dB below full scale
        np.testing.assert_allclose(found.campbell.sum_level, level(9.80665, 1e-6), rtol=0.0, atol=0.01)


class TestSpeed:
    def test_a_channel_with_noise_is_smoothed(self):
        record = known(noise=5.0)
        turned = with_speed(record, SpeedSource())
        assert turned.notes == ()  # a record that has its speed keeps it
        bare = dataclasses.replace(
            record,
            channels=(
                *record.channels,
                dataclasses.replace(record.channels[0], name="n", recorded="speed", unit="rad/s"),
            ),
            values=np.column_stack([record.values, record.speed]),
            speed=None,
            angle=None,
        )
        turned = with_speed(bare, SpeedSource())
        assert "speed smoothed by a spline of 20 parts, which leaves 4.99 rpm (rms)" in turned.notes[1]
        exact = (20.0 + 20.0 * turned.record.time) * np.pi
        # noise of 5 rpm over 500 samples a part, three times as much at the ends of the spline
        np.testing.assert_allclose(turned.record.speed, exact, rtol=0.0, atol=3.0 * np.pi / 30.0)
        assert np.all(np.diff(turned.record.speed) > 0.0)
        refused(lambda: with_speed(bare, SpeedSource(channel="S1")), "'S1' is in m/s2; allowed: a channel in rpm")
        refused(lambda: with_speed(bare, SpeedSource(channel="s3")), "--speed-channel: 's3' is not there")

    def test_pulses_of_a_tacho(self):
        record = known()
        pulses = np.where(np.mod(8.0 * record.angle / (2.0 * np.pi), 1.0) < 0.5, 4.8, 0.1)
        channel = dataclasses.replace(record.channels[0], name="tacho", recorded="other", unit="V")
        bare = dataclasses.replace(
            record,
            channels=(*record.channels, channel),
            values=np.column_stack([record.values, pulses]),
            speed=None,
            angle=None,
        )
        turned = with_speed(bare, SpeedSource(tacho="tacho", pulses=8.0))
        assert "pulses of tacho, 8 a turn" in turned.notes[0]
        exact = (20.0 + 20.0 * turned.record.time) * np.pi
        # flanks are known to a sample, a twentieth of the distance of pulses at the highest speed
        np.testing.assert_allclose(turned.record.speed, exact, rtol=0.02)
        halved = dataclasses.replace(bare, values=np.where(np.arange(bare.time.size)[:, None] < 5000, bare.values, 0.1))
        assert with_speed(halved, SpeedSource(tacho="tacho", pulses=8.0)).record.time[-1] < 1.01
        lost = bare.values.copy()
        lost[5000:5060, 2] = 0.1
        gap = dataclasses.replace(bare, values=lost)
        mended = with_speed(gap, SpeedSource(tacho="tacho", pulses=8.0))
        assert "tacho tacho: 1 pulse missing and counted, at 0.9" in mended.notes[1]
        np.testing.assert_allclose(mended.record.angle[-1], turned.record.angle[-1], rtol=1e-9)
        silent = np.where((bare.time > 0.5) & (np.sin(3e3 * bare.time**2) < 0.0), 0.1, pulses)
        odd = dataclasses.replace(bare, values=np.column_stack([record.values, silent]))
        refused(lambda: with_speed(odd, SpeedSource(tacho="tacho", pulses=8.0)), "tacho 'tacho': got")
        wheel = np.where(np.mod(record.angle / (2.0 * np.pi), 1.0) < 0.75, pulses, 0.1)
        toothed = dataclasses.replace(bare, values=np.column_stack([record.values, wheel]))
        found = with_speed(toothed, SpeedSource(tacho="tacho", pulses=8.0))
        assert "a wheel with 6 of 8 teeth; those that are missing are counted" in found.notes[1]
        np.testing.assert_allclose(found.record.speed, np.interp(found.record.time, record.time, exact_speed(record)),
                                   rtol=0.03)  # a sample of a pulse  # fmt: skip
        refused(
            lambda: with_speed(toothed, SpeedSource(tacho="tacho", pulses=6.0)),
            "got 6 pulses a turn of a wheel with 6 of 8 teeth; allowed: 8",
        )

    def test_a_table(self, here):
        record = dataclasses.replace(known(), speed=None, angle=None)
        (here / "n.csv").write_text("time [s];speed [rpm]\n0,5;900\n1,5;1500\n")
        turned = with_speed(record, SpeedSource(table=here / "n.csv"))
        assert turned.record.time[[0, -1]] == pytest.approx([0.5, 1.5])
        np.testing.assert_allclose(turned.record.speed, (20.0 + 20.0 * turned.record.time) * np.pi, rtol=1e-12)
        (here / "n.csv").write_text("time [s];speed [rpm]\n5;900\n6;1500\n")
        refused(lambda: with_speed(record, SpeedSource(table=here / "n.csv")), "on the clock of the record")

    def test_held_speeds_are_cut_and_turning_ones_refused(self):
        record = known()
        held = np.interp(record.time, [0.0, 0.4, 1.6, 2.0], [60.0, 60.0, 180.0, 180.0])
        bare = dataclasses.replace(record, speed=None, angle=None)
        channel = dataclasses.replace(record.channels[0], recorded="speed", unit="rad/s")
        for values, words in (
            (held, None),
            (np.full_like(held, 60.0), "got a speed of 573 rpm throughout"),
            (100.0 + 20.0 * record.time + 8.0 * np.sin(20.0 * record.time), "got a speed that turns round"),
        ):
            given = dataclasses.replace(bare, channels=(channel,), values=values[:, None])
            if words is None:
                cut = with_speed(given, AS_IT_IS).record
                assert cut.time[[0, -1]] == pytest.approx([0.4, 1.6], abs=1.0 / RATE)
            else:
                refused(lambda given=given: with_speed(given, AS_IT_IS), words)

    def test_one_source_at_most(self):
        refused(
            lambda: SpeedSource(channel="a", tacho="b", pulses=0.0), "got channel and tacho", "pulses: got 0.0 a turn"
        )


def exact_speed(record):
    """Speed of `known` [rad/s]."""
    return (20.0 + 20.0 * record.time) * np.pi


def pulse_times(kind, count=150):
    """Times at which a shaft passes whole pitches: steady, from rest and to rest at even acceleration, swinging."""
    pitch = np.arange(count) + 0.3
    if kind == "steady":
        return 0.01 * pitch
    if kind == "swinging":
        time = np.linspace(0.0, 3.0, 300_001)
        angle = np.cumsum(100.0 + 15.0 * np.sin(2.0 * np.pi * 8.0 * time)) * 1e-5
        return np.interp(pitch, angle, time)
    return np.sqrt(pitch * 1e-3) if kind == "from rest" else 1.0 - np.sqrt(pitch[::-1] * 1e-3)


class TestPulses:
    """Whole pitches between the pulses that are kept are those that the shaft has turned."""

    @pytest.mark.parametrize("kind", ["steady", "from rest", "to rest", "swinging"])
    @pytest.mark.parametrize(
        ("lost", "more", "words"),
        [
            ((), (), ""),
            ((60,), (), "1 pulse missing and counted"),
            ((40, 41, 100), (), "2 pulses missing and counted"),
            ((), (75.3,), "1 pulse too many and left out"),
            ((), (75.7, 110.5), "2 pulses too many and left out"),
            ((50,), (90.2,), "1 pulse missing and counted"),
            (tuple(k for k in range(150) if k % 20 > 17), (), "a wheel with 18 of 20 teeth"),
            (tuple(range(7, 150, 8)), (), "a wheel with 7 of 8 teeth"),
        ],
    )
    def test_what_a_tacho_does(self, kind, lost, more, words):
        times = pulse_times(kind)
        pitch = np.delete(np.arange(150.0), list(lost))
        seen = np.interp(np.sort([*pitch, *more]), np.arange(150.0), times)
        found = counted(seen)
        assert words in "; ".join(found.notes)
        truly = np.interp(found.times, times, np.arange(150.0))
        np.testing.assert_allclose(found.counts - found.counts[0], truly - truly[0], atol=1e-9)  # round-off
        assert found.times.size >= pitch.size - 3

    def test_few_samples_a_pulse(self):
        """Seven samples a pulse, of a wheel of 60 - 2 teeth from rest on: the distances scatter by a sample."""
        step, time = 8e-5, np.arange(50_000) * 8e-5
        turned = 60.0 * 4.0 * time**2
        tooth = np.mod(turned, 60.0)
        voltage = np.where((np.mod(turned, 1.0) < 0.5) & (tooth < 58.0), 5.0, 0.0)
        found = counted(rising_flanks(time, voltage))
        assert found.wheel == (58, 60)
        truly = 60.0 * 4.0 * found.times**2
        # A sample of the fastest pulse.
        assert np.max(np.abs(found.counts - found.counts[0] - (truly - truly[0]))) < 60.0 * 8.0 * time[-1] * step

    def test_pulses_that_nobody_can_count(self):
        random = np.random.default_rng(0)
        for times, words in (
            (np.cumsum(random.uniform(0.1, 1.0, 60)), "between pulses at|do not come every|a tenth of"),
            (
                np.delete(pulse_times("steady"), random.choice(np.arange(4, 146), 30, replace=False)),
                "a tenth of|between",
            ),
        ):
            with pytest.raises(InputError, match=words):
                counted(times)


class TestTables:
    """A table as programs of other countries write it gives the same record."""

    @pytest.mark.parametrize(
        ("head", "mark", "comma", "end", "encoding"),
        [
            ("time [s],speed [rpm],S1 [m/s2]", ",", ".", "\n", "utf-8"),
            ("time [s];speed [1/min];S1 [m/s^2]", ";", ",", "\r\n", "utf-8"),
            ("time [s]\tspeed [min-1]\tS1 [m/s²]", "\t", ",", "\r\n", "cp1252"),
            ("time, abs [s]\tspeed, n [RPM]\tS1 [m/s²]", "\t", ",", "\n", "utf-16"),
            ("time [s]\tn; speed [r/min]\tS1 [m/s²]\t", "\t", ",", "\t\n", "utf-8-sig"),
            ('"time [s]"\t"speed [U/min]"\t"S1 [m/s2]"', "\t", ".", "\n", "utf-8"),
        ],
    )
    def test_marks_and_letters(self, here, head, mark, comma, end, encoding):
        rows = [(k * 1e-3, 500.0 + k, 0.125 * k) for k in range(30)]
        text = "".join(mark.join(f"{value:.6f}".replace(".", comma) for value in row) + end for row in rows)
        (here / "a.csv").write_bytes((head + end.replace("\t", "") + text).encode(encoding))
        (record,) = read_time_data(here / "a.csv").records
        np.testing.assert_allclose(record.time, np.array(rows)[:, 0], atol=1e-12)  # six digits, on even steps
        np.testing.assert_allclose(record.values, np.array(rows)[:, 1:] * [np.pi / 30.0, 1.0], rtol=1e-15)
        assert [channel.recorded for channel in record.channels] == ["speed", "acceleration"]

    def test_commas_between_thousands_are_no_decimals(self, here):
        (here / "a.csv").write_text("time [s]\tspeed [rpm]\n0.001\t1,500\n0.002\t1,501\n")
        refused(lambda: read_time_data(here / "a.csv"), "got numbers with commas and numbers with points")


ROWS = "".join(f"{k * 1e-3:.6f},{500 + k},{0.1 * k}\n" for k in range(100))
HOSTILE = {
    "empty": ("", "has no line of names"),
    "no names": ("0,500,1\n" + ROWS, "column 1: got '0' without a unit"),
    "no unit": ("time [s],speed [rpm],S1\n" + ROWS, "column 3: got 'S1' without a unit; allowed: a name and a unit"),
    "unit": ("time [s],speed [rpm],S1 [m/s3]\n" + ROWS, "column 3 (S1): got the unit 'm/s3' (did you mean"),
    "no time": ("t [V],speed [rpm],S1 [g]\n" + ROWS, "got 0 columns of a time"),
    "no rows": ("time [s],speed [rpm],S1 [g]\n", "no numbers below"),
    "text": ("time [s],speed [rpm],S1 [g]\n" + ROWS + "0.1,600,high\n", "line 102: got '0.1,600,high'"),
    "short row": ("time [s],speed [rpm],S1 [g]\n" + ROWS + "0.1,600\n", "line 102: got '0.1,600'; allowed: 3 numbers"),
    "nan": (
        "time [s],speed [rpm],S1 [g]\n" + ROWS + "0.1,600,nan\n",
        "channel 'S1': got nan at sample 101; allowed: finite",
    ),
    "large": ("time [s],speed [rpm],S1 [g]\n" + ROWS + "0.1,600,1e200\n", "e+200 at sample 101; allowed: finite"),
    "uneven": (
        "time [s],speed [rpm],S1 [g]\n" + ROWS + "0.15,600,1\n",
        "time: got steps of 0.001 to 0.051 s, the first odd one after sample 100",
    ),
    "twice": ("time [s],S1 [m/s2],S1 [g]\n" + ROWS, "got 2 channels named 'S1'"),
    "no speed": ("time [s],S2 [m],S1 [g]\n" + ROWS, "got 0 channels of a speed among S2, S1; allowed: one in rpm"),
    "bytes": ("\0\0\0", "column 1: got"),
}


class TestHostile:
    @pytest.mark.parametrize("name", HOSTILE)
    def test_tables(self, here, capsys, name):
        text, words = HOSTILE[name]
        (here / "bad.csv").write_text(text)
        status, out, err = run(capsys, "campbell", "bad.csv", "-o", "o.nc")
        assert (status, out) == (2, "")
        assert words in err and "bad.csv" in err
        assert not (here / "o.nc").exists()

    def test_sound_files(self, here, capsys):
        (here / "a.wav").write_bytes(b"RIFF")
        table = here / "a.wav.toml"
        assert "samples of a sound file have no unit without one" in run(capsys, "campbell", "a.wav")[2]
        table.write_text("[[channels]]\n")
        assert "cannot be read as a sound file" in run(capsys, "campbell", "a.wav")[2]
        table.write_text('channels = [{ name = "S1", unit = "m/s2", full_scale = 1.0 }]\n')
        with wave.open("a.wav", "wb") as file:  # of a recorder that was stopped early
            file.setparams((1, 2, 5000, 0, "NONE", ""))
        assert "a.wav: got 0 samples; allowed: 2 to " in run(capsys, "campbell", "a.wav")[2]
        with wave.open("a.wav", "wb") as file:
            file.setparams((2, 2, 5000, 0, "NONE", ""))
        assert "got 1 channels for a sound file of 2" in run(capsys, "campbell", "a.wav")[2]
        write_time_data("b.wav", TimeData("", (known(),)))
        table = here / "b.wav.toml"
        good = table.read_text()
        for old, new, words in (
            ("full_scale = 1800.0", "full_scale = -3.0", "channel 3, full_scale: got -3.0; allowed: a number above 0"),
            ('unit = "m/s2"', 'unit = "kg"', "channel 1, unit: got the unit 'kg'"),
            ("step = 0.0002", "step = 0.02", "step: got 0.02 for a sound file of 5000 Hz"),
            ("title", "titlx", "'titlx' is not known (did you mean 'title'?)"),
            ('name = "S1"\n', "", "channel 1: got a table of 2 entries; allowed: the keys name, unit, full_scale"),
            (good[good.rindex("[[") :], "", "got 2 channels for a sound file of 3"),
        ):
            assert old in good
            table.write_text(good.replace(old, new))
            assert words in run(capsys, "campbell", "b.wav")[2]

    def test_other_files(self, here, capsys):
        (here / "a.nc").write_bytes(b"no file")
        assert "a.nc: cannot be read" in run(capsys, "campbell", "a.nc")[2]
        xr.Dataset({"speed": 1.0}).to_netcdf("b.nc")
        assert "b.nc: has no signal, signal_time" in run(capsys, "campbell", "b.nc")[2]
        (here / "a.uff").write_text("nothing")
        assert "a.uff: got no datasets 58" in run(capsys, "runup", "a.uff")[2]
        assert "cannot be read" in run(capsys, "campbell", "none.csv")[2]

    def test_what_is_read_is_not_written_over(self, here, capsys):
        for ending in (".csv", ".wav"):
            path = f"run{ending}"
            write_time_data(path, TimeData("", (known(),)))
            before = (here / path).read_bytes()
            for command in ("campbell", "runup"):
                status, _, err = run(capsys, command, path, "--signals", f"./{path}")
                assert status == 2
                assert f"written over {path}, which is read" in err
            status, _, err = run(capsys, "campbell", "machine.toml", "--measured", path, "--signals", path)
            assert status == 2
            assert f"--signals: got {path}, which would be written over {path}" in err
            assert (here / path).read_bytes() == before
        (here / "mine.csv").write_text("my own")
        assert "is not a table of ehdmaps" in run(capsys, "runup", "run.csv", "--signals", "mine.csv")[2]


class TestRuns:
    """A small machine, run up once and looked at again."""

    def test_a_saved_run_gives_what_the_run_itself_gave(self, here, capsys):
        direct = ("campbell", "machine.toml", "--sensor", "all", "-o", "direct.nc", "--signals", "fine.csv")
        status, out, err = run(capsys, *direct, "--plot", "direct.png")
        assert status == 0, err
        assert "top (dB re 1e-06 m/s2): highest sum level" in out and "side (dB re 1e-12 m)" in out
        assert run(capsys, "runup", "machine.toml", "-o", "run.nc")[0] == 0
        for source in ("run.nc", "fine.csv"):
            # the file of a run knows what its scene looks at, a table of numbers does not
            look = () if source == "run.nc" else ("--highest", "1 kHz", "--orders", "5")
            words = (*look, "--sensor", "all", "-o", "again.nc")
            assert run(capsys, "campbell", source, *words)[0] == 0
            with xr.open_dataset("direct.nc") as first, xr.open_dataset("again.nc") as again:
                assert first["level"].dims == ("sensor", "law", "speed", "frequency")
                for name in ("level", "sum_level", "track_level"):
                    # Rounding alone: of times and speeds, and of numbers of twelve digits; levels 120 dB below the
                    # highest one hold nothing else.
                    there = first[name].values > float(first[name].max()) - 120.0
                    np.testing.assert_allclose(again[name].values[there], first[name].values[there], atol=1e-5)
        # one sensor of the same run, with the layout of one
        assert run(capsys, "campbell", "run.nc", "--sensor", "side", "--highest", "1 kHz", "-o", "one.nc")[0] == 0
        with xr.open_dataset("direct.nc") as first, xr.open_dataset("one.nc") as one:
            assert one.attrs["sensor"] == "side"
            np.testing.assert_allclose(one["sum_level"], first["sum_level"].sel(sensor="side"), atol=1e-5)

    def test_sensors_are_recorded_at_every_step(self, here, capsys):
        status, out, _ = run(
            capsys, "runup", "machine.toml", "-o", "run.nc", "--spectrum-at", "1000 rpm", "--plot", "r.png"
        )
        assert status == 0
        (row,) = (line for line in out.splitlines() if line.startswith("  top "))
        with xr.open_dataset("run.nc") as data:
            assert (data.sizes["time"], data.sizes["signal_time"]) == (501, 4001)
            signal = data["signal"].sel(sensor="top").values
            assert float(row.split()[2]) == pytest.approx(signal.std(), rel=1e-3)  # digits
            assert float(row.split()[3].rstrip(",")) == pytest.approx(signal[np.argmax(np.abs(signal))], rel=1e-3)
            # at the samples they are the motion of the coordinate
            states = data["translation_acceleration"] if "translation_acceleration" in data else data["acceleration"]
            np.testing.assert_allclose(signal[::8], states.isel(translation_coordinate=0).values, rtol=1e-9, atol=1e-12)
            spectrum = data["spectrum_amplitude"].sel(sensor="side").squeeze().values
            shaken = data["spectrum_frequency"].values[np.argmax(spectrum)]
            assert shaken == pytest.approx(300.0, abs=60.0)  # half a line of the window
        # of a table the speed is a channel, too, which has no spectrum
        run(capsys, "runup", "machine.toml", "--signals", "sim.csv")
        assert run(capsys, "runup", "sim.csv", "-o", "again.nc", "--spectrum-at", "1000 rpm")[0] == 0
        with xr.open_dataset("again.nc") as data:
            found = data["spectrum_amplitude"].squeeze()
            shaken = data["spectrum_frequency"].values[np.argmax(found.sel(sensor="side").values)]
            assert shaken == pytest.approx(300.0, abs=60.0)
            assert found.sel(sensor="speed").isnull().all()

    def test_a_measured_run_beside_a_simulated_one(self, here, capsys):
        run(capsys, "campbell", "machine.toml", "--signals", "sim.csv")
        table = (here / "sim.csv").read_text().replace("top [m/s2]", "A7 [m/s2]")
        (here / "rig.csv").write_text(table)
        words = ("campbell", "machine.toml", "--measured", "rig.csv", "-o", "both.nc", "--plot", "both.png")
        status, out, err = run(capsys, *words)
        assert status == 0, err
        assert "sum level at the same speed, simulated less measured" in out
        # the same run, read back from twelve digits
        assert "no contact law: median 0.0 dB, 5 to 95 % of the windows 0.0 to 0.0 dB" in out.replace("-0.0", "0.0")
        with xr.open_dataset("both.nc") as data:
            assert data["measured_sum_level"].dims == ("measured_speed",)
            assert data.attrs["measured_sensor"] == "A7"
        for more, message in (
            (("--sensor", "all"), "has no channel 'top' in m/s2; allowed: speed, A7, side"),
            (("--sensor", "all", "--channel", "A7"), "--channel: got 1 names for 2 sensors"),
            (("--channel", "side"), "'side' is in m and sensor top in m/s2"),
        ):
            status, _, err = run(capsys, *words[:4], *more)
            assert status == 2
            assert message in err
        assert run(capsys, *words[:4], "--sensor", "all", "--channel", "A7", "--channel", "side")[0] == 0

    @pytest.mark.parametrize(
        ("words", "message"),
        [
            (("campbell", "machine.toml", "--tacho", "a"), "--tacho: stands without --measured"),
            (("campbell", "run.csv", "--law", "hertz"), "--law: stands beside 'run.csv', a run that is recorded"),
            (("campbell", "run.csv", "--pulses", "3"), "--pulses: stands without --tacho"),
            (("campbell", "run.csv", "--orders", "x"), "--orders: got 'x'; allowed: numbers above 0"),
            (("campbell", "run.csv", "--sensor", "S9"), "--sensor: 'S9' is not there"),
            (("campbell", "run.csv", "--signals", "a.mat"), "--signals: got 'a.mat'; allowed: a file that ends in .nc"),
            (("runup", "run.csv", "--spectrum-at", "9000 rpm"), "got 9000 rpm; allowed:"),
            (("runup", "machine.toml", "--spectrum-at", "100 rpm"), "--spectrum-at: spectrum, speed: got 100 rpm"),
            (("runup", "machine.toml", "--window", "9 ms"), "--window: stands without --spectrum-at"),
            (("runup", "machine.toml", "--speed-table", "a.csv"), "--speed-table: stands beside a scene"),
            (
                ("runup", "machine.toml", "--law", "hertz", "--law", "hertz:1 ms", "--signals", "a.wav"),
                "--signals: got 2 laws for a.wav; allowed in .wav: one; write .nc",
            ),
        ],
    )
    def test_what_is_refused(self, here, capsys, words, message):
        write_time_data("run.csv", TimeData("", (known(),)))
        status, out, err = run(capsys, *words)
        assert (status, out) == (2, "")
        assert message in err

    def test_several_laws_are_one_file(self, here, capsys):
        laws = ("--law", "hertz", "--law", "hertz:1 ms")
        status, out, err = run(capsys, "runup", "machine.toml", *laws, "-o", "two.nc")
        assert status == 0, err
        assert run(capsys, "runup", "machine.toml", "-o", "one.nc")[0] == 0
        with xr.open_dataset("two.nc") as two, xr.open_dataset("one.nc") as one:
            assert two["law"].values.tolist() == ["dry Hertz", "dry Hertz, c = 1000 us times k"]
            assert two["signal"].dims == ("law", "signal_time", "sensor")
            assert two["signal_speed"].dims == ("signal_time",)
            # without a bearing both laws are one machine
            for law in range(2):
                np.testing.assert_array_equal(two["signal"][law], one["signal"])
                np.testing.assert_array_equal(two["displacement"][law], one["displacement"])
        status, out, _ = run(capsys, "campbell", "two.nc", "--highest", "1 kHz", "-o", "c.nc")
        assert status == 0
        assert "dry Hertz, c = 1000 us times k beside dry Hertz: median 0.0 dB" in out
        assert run(capsys, "lsa", "machine.toml", *laws, "-o", "l.nc")[0] == 0
        assert run(capsys, "lsa", "machine.toml", "-o", "l1.nc")[0] == 0
        with xr.open_dataset("l.nc") as two, xr.open_dataset("l1.nc") as one:
            assert two["response_real"].dims == ("law", "frequency", "sensor", "input")
            for name in ("response_real", "A", "B", "C", "D"):
                np.testing.assert_array_equal(two[name][1], one[name])
