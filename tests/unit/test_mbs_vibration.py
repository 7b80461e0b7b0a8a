"""Vibration of a bearing on a test spindle: bands, envelopes, and the orders of a public data set of seeded defects."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr

from ehdmaps.errors import InputError
from mbs.cli import main
from mbs.vibration import BEGINNING, SPEED, band_levels, envelope_spectrum, ring_vibration

SKF_6205 = """
geometry = { balls = 9, ball_diameter = "7.94004 mm", pitch_diameter = "39.0398 mm", inner_groove_radius = 0.52, \
outer_groove_radius = 0.52, diametral_clearance = "8 um" }
"""
"""Drive end bearing of the data set: ball 0.3126 in, pitch 1.537 in."""

PUBLISHED = {"inner": 5.4152, "outer": 3.5848, "elements": 4.7135}
"""Defect frequencies of the drive end bearing by the speed of the shaft, as the Bearing Data Center of Case Western
Reserve University prints them (bearing information, 6205-2RS JEM SKF): inner ring, outer ring, rolling element."""


def test_an_envelope_has_the_beat_of_its_carrier():
    time = np.arange(20000) / 20000.0
    signal = (1.0 + 0.3 * np.cos(2.0 * np.pi * 37.0 * time)) * np.sin(2.0 * np.pi * 3000.0 * time) + time
    frequency, amplitude = envelope_spectrum(signal, 20000.0, (2000.0, 4000.0))
    assert frequency[np.argmax(amplitude)] == 37.0 and amplitude.max() == pytest.approx(0.3, rel=1e-3)
    assert band_levels(signal, 20000.0, [(2500.0, 3500.0)])[0] == pytest.approx((0.5 * (1.0 + 0.045)) ** 0.5, rel=1e-3)


@pytest.mark.slow
@pytest.mark.parametrize("part", PUBLISHED)
def test_seeded_defects_have_the_published_orders(part):
    """Frequency of the line of the envelope to 1e-3, which bounds the interpolation between lines of the transform.

    Sensors of the data set stand on a motor, which makes the levels: they are not looked at.
    """
    element = ", element = 1" if part == "elements" else ""
    hole = f'spall = [{{ on = "{part}", length = "0.53 mm", depth = "280 um"{element} }}]'
    found = ring_vibration(SKF_6205, hole, 150.0, 0.06, laws=["hertz:1.25e-5 s"], duration=1.0)
    frequency, amplitude = envelope_spectrum(found.signals[0], found.rate, (1000.0, 10000.0))
    wanted = PUBLISHED[part] * SPEED / (2.0 * np.pi)
    near = np.abs(frequency - wanted) < 4.0
    assert amplitude[near].max() > 20.0 * np.median(amplitude[(frequency > 20.0) & (frequency < 1000.0)])
    # between the lines of the transform: the two about the peak of a Hann window
    place = int(np.flatnonzero(near)[np.argmax(amplitude[near])])
    beside = place + (1 if amplitude[place + 1] > amplitude[place - 1] else -1)
    ratio = amplitude[beside] / amplitude[place]
    at = frequency[place] + (beside - place) * (2.0 * ratio - 1.0) / (ratio + 1.0) * frequency[1]
    assert at == pytest.approx(wanted, rel=1e-3)


def test_the_bands_are_told_by_case():
    wave = 'waviness = [{ on = "inner", waves = 10, amplitude = "0.2 um" }]'
    given = {"laws": ["hertz:1e-4 s"], "temperatures": [303.0, 313.0], "duration": 0.1}
    found = ring_vibration(SKF_6205, wave, 150.0, 0.06, **given)
    assert len(found.cases) == 2 and found.bands.shape == (2, 3) and BEGINNING < 1.0
    low, high = found.band("hertz:1e-4 s")
    # n = Z + 1: at BPFI + 1, 192.5 Hz, in the low band, as fast as the wave goes by
    assert np.all(low <= high) and low[0] > 10.0 * low[2]
    with pytest.raises(InputError, match="allowed: a duration > 0 s, an axial load"):
        ring_vibration("6205", wave, 0.0, 0.06)


@pytest.mark.slow
def test_the_command_has_bands_and_the_order_of_a_spall(tmp_path, capsys):
    """The envelope has BPFO; the perfect bearing stands beside; the file has what is printed."""
    spall = 'spall = [{ on = "outer", length = "0.5 mm", depth = "20 um" }]'
    given = ["--axial", "150 N", "--vibration", "60 g", "--law", "hertz:1.25e-5 s", "--temperature", "40 degC"]
    path = tmp_path / "v.nc"
    assert main(["bearing", f'{{ name = "6205", {spall} }}', *given, "--clearance", "10 um", "-o", str(path)]) == 0
    page = capsys.readouterr().out
    with xr.open_dataset(path) as data:
        assert data["velocity_band"].shape == (1, 3) and data["velocity"].attrs["units"] == "m/s"
        high = float(data["velocity_band"][0, 2])
    own, perfect = (
        next(float(line.split()[-1]) for line in page.splitlines() if line.startswith(begin))
        for begin in ("  hertz:1.25e-5 s   ", "    of the perfect bearing")
    )
    assert own == pytest.approx(1e6 * high, rel=5e-3)  # three digits are printed
    assert perfect < 1e-4 * own
    assert "1 BPFO, " in page


@pytest.mark.parametrize(
    ("given", "said"),
    [
        (["NU308", "--axial", "1 N", "--vibration", "1 kg"], "allowed: bearings that carry axial load"),
        (["6205", "--vibration", "1 kg"], "--axial: got None; allowed: the load along the axis"),
        (["6205", "--vibration", "1 kg", "--speed", "3 rpm"], "--speed: has no part in --vibration"),
        (["6205", "--vibration", "1 kg", "--films", "memory"], "--films: has no part in --vibration; allowed: --law"),
        (["6205"], "--load: missing; allowed: on the inner ring"),
        (["22208"], "BEARING: got '22208', spherical roller bearing: not yet"),
    ],
)
def test_what_the_command_does_not_take(given, said, capsys):
    assert main(["bearing", *given]) == 2
    assert said in capsys.readouterr().err
