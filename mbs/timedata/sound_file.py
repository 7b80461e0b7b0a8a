"""A sensor as a sound to listen to: one channel of 16 bits and 48 kHz, its largest value near full scale.

The mean is left out, and what lies above 24 kHz. Time is that of the run: what is heard is how the machine sounds where
the sensor is, not what it radiates.
"""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path

import numpy as np
from scipy.io import wavfile

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import InputError
from ehdmaps.outputs import MARK, Kind, has_mark, written_aside
from mbs.timedata.records import TimeChannel, TimeRecord, chosen

RATE = 48_000
"""Samples per second [Hz]."""

SOUND = Kind("a sound of mbs", (".wav",), has_mark)

_FINEST = 2000
"""Largest denominator of the ratio of both rates."""

_PEAK = 0.9
"""Largest value, as a part of full scale."""

_FULL = 32767


def sound_channel(record: TimeRecord, name: str | None, option: str) -> TimeChannel:
    """The channel that is heard: that of a name, else the first acceleration, else the first motion.

    Parameters
    ----------
    record : TimeRecord
        The record.
    name : str or None
        Name of a channel.
    option : str
        Begins the message.

    Raises
    ------
    InputError
        If there is none of that name, or of no motion.
    """
    if name is not None:
        return chosen(record, name, option)
    if not record.sensors:
        raise InputError(f"{option}: has no channel of a motion among {', '.join(record.names)}; allowed: one by name")
    return next((channel for channel in record.sensors if channel.recorded == "acceleration"), record.sensors[0])


def sound_samples(values: FloatArray, step: float) -> FloatArray:
    """A signal at `RATE`, without its mean, in its unit.

    Parameters
    ----------
    values : array, shape (samples,)
        Signal at equal steps.
    step : float
        The step [s].

    Examples
    --------
    A tone of 1 kHz keeps its amplitude:

    >>> tone = np.sin(2.0 * np.pi * 1e3 * np.arange(20_000) * 1e-5)
    >>> heard = sound_samples(tone, 1e-5)
    >>> heard.size, round(float(np.abs(heard[1000:-1000]).max()), 2)
    (9600, 1.0)
    """
    from scipy.signal import resample_poly  # half a second, where a sound is written

    ratio = Fraction(RATE * step).limit_denominator(_FINEST)
    plain = values - np.mean(values)
    return np.asarray(resample_poly(plain, ratio.numerator, ratio.denominator), dtype=np.float64)


def write_sound(path: Path, record: TimeRecord, channel: TimeChannel) -> list[str]:
    """Write a channel as a sound, by the rule of all files that are written; say what it is.

    Parameters
    ----------
    path : Path
        The file.
    record : TimeRecord
        The run.
    channel : TimeChannel
        One of its channels.

    Raises
    ------
    InputError
        If it cannot be written.
    """
    step = float(record.time[-1] - record.time[0]) / (record.time.size - 1)
    heard = sound_samples(record.column(channel), step)
    largest = float(np.max(np.abs(heard), initial=0.0)) or 1.0
    with written_aside(path, SOUND) as aside:
        wavfile.write(aside, RATE, np.round(_FULL * _PEAK * heard / largest).astype(np.int16))
        _sign(aside)
    return [
        f"{path}: written, {channel.name} over {heard.size / RATE:.4g} s; {RATE // 1000} kHz, 16 bits, full scale "
        f"{largest / _PEAK:.4g} {channel.unit}"
    ]


def _sign(path: Path) -> None:
    """Add who made it, as the format has it: a list of information behind the samples."""
    words = MARK.encode() + b"\0" * (2 - len(MARK) % 2)
    chunk = b"INFOISFT" + len(words).to_bytes(4, "little") + words
    with path.open("r+b") as file:
        file.seek(0, 2)
        file.write(b"LIST" + len(chunk).to_bytes(4, "little") + chunk)
        size = file.tell() - 8
        file.seek(4)
        file.write(size.to_bytes(4, "little"))
