"""Time data as sound files (WAV), with a table beside them: ``run.wav`` and ``run.wav.toml``.

Samples of a WAV have no unit, and its rate is a whole number of hertz. The table says both: for each channel, in the
order of the file, its name, its unit, and the value of a sample of full scale. Files written here have samples of 32
bits, floating, with the largest value of all channels of a unit at full scale. Read are samples of 8, 16, 24 and 32
bits, and floating ones.

::

    step = 1e-05          # time between samples [s]; that of the rate if left out
    [[channels]]
    name = "S1"
    unit = "m/s2"
    full_scale = 12.5

A sensor as a sound to listen to: one channel of 16 bits and 48 kHz, its largest value near full scale.

The mean is left out, and what lies above 24 kHz. Time is that of the run: what is heard is how the machine sounds where
the sensor is, not what it radiates.
"""

from __future__ import annotations

import json
import math
import tomllib
import warnings
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
from scipy.io import wavfile

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import InputError, Problems, problems_after
from ehdmaps.inputs import check_input, first_bytes, read_text
from ehdmaps.outputs import MARK, Kind, has_mark, written_aside
from ehdmaps.units import RPM, closest, short
from mbs.timedata.records import LARGEST, MOST_CHANNELS, TimeChannel, TimeData, TimeRecord, chosen, read_unit

LONGEST_FILE = 2**32 - 1
"""Bytes: more do not fit into the format."""

_LONGEST_TABLE = 1_000_000
_EXAMPLE = 'channels = [{ name = "S1", unit = "m/s2", full_scale = 12.5 }]'
_KEYS = ("step", "title", "channels")
_CHANNEL_KEYS = ("name", "unit", "full_scale")
_OFFSET, _HALF = 128.0, 128.0
"""Of samples of 8 bits, which have no sign."""


def scale_path(path: Path) -> Path:
    """The table beside a sound file."""
    return path.with_name(f"{path.name}.toml")


def _ours(path: Path) -> bool:
    """Tell whether a sound file has a table of ours beside it."""
    table = scale_path(path)
    return first_bytes(path, 4, "a WAV file") == b"RIFF" and table.is_file() and has_mark(table)


WAV = Kind("a sound file of mbs with its table", (".wav",), _ours)
SCALE = Kind("the table of a sound file of mbs", (".toml",), has_mark)


def write_wav(path: Path, data: TimeData) -> list[str]:
    """Write the one record of time data and its table, by the rule of all files that are written; say the scales.

    Parameters
    ----------
    path : Path
        The sound file.
    data : TimeData
        Time data of one record.

    Raises
    ------
    InputError
        If they cannot be written.
    """
    (record,) = data.records
    channels, columns = list(record.channels), [record.column(channel) for channel in record.channels]
    if record.speed is not None:
        channels.append(TimeChannel("speed", "speed", "rpm"))
        columns.append(np.asarray(RPM.value(1.0) * record.speed))
    scales: dict[str, float] = {}
    for channel, column in zip(channels, columns, strict=True):
        scales[channel.unit] = max(scales.get(channel.unit, 0.0), float(np.max(np.abs(column))))
    full = [scales[channel.unit] or 1.0 for channel in channels]
    step = float(record.time[-1] - record.time[0]) / (record.time.size - 1)
    samples = np.column_stack([column / scale for column, scale in zip(columns, full, strict=True)])
    lines = [
        f"# {MARK}: scale of {path.name}",
        f"title = {_quoted(f'{data.title}, {record.label}')}",
        f"step = {step!r}",
    ]
    for channel, scale in zip(channels, full, strict=True):
        lines += [
            "[[channels]]",
            f"name = {_quoted(channel.name)}",
            f'unit = "{channel.unit}"',
            f"full_scale = {scale!r}",
        ]
    # The table goes first: a sound file of ours is known by it.
    with written_aside(path, WAV) as sound:
        wavfile.write(sound, max(round(1.0 / step), 1), np.asarray(samples, dtype=np.float32))
        with written_aside(scale_path(path), SCALE) as aside:
            aside.write_text("\n".join(lines) + "\n", encoding="utf-8")
    words = [f"{scale:.6g} {unit}" for unit, scale in {c.unit: s for c, s in zip(channels, full, strict=True)}.items()]
    return [f"{scale_path(path)}: written; full scale of {path.name} is {', '.join(words)}"]


def read_wav(path: Path) -> TimeData:
    """Read a sound file with its table.

    Parameters
    ----------
    path : Path
        The sound file.

    Raises
    ------
    InputError
        With what is wrong about one of them.
    """
    check_input(path, LONGEST_FILE, "a sound file (.wav)", "cut the record")
    table = _table(path)
    try:
        with warnings.catch_warnings():
            # Of chunks that are no samples, such as the name of a recorder.
            warnings.simplefilter("ignore", wavfile.WavFileWarning)
            rate, given = wavfile.read(path)
    except Exception as error:  # the library raises all sorts of errors for damaged files
        raise InputError(
            f"{path}: cannot be read as a sound file ({error}); allowed: a WAV of 8, 16, 24 or 32 bits, or floating"
        ) from error
    samples = _floating(given[:, np.newaxis] if given.ndim == 1 else given)
    channels, factors = _channels(path, table)
    if samples.shape[1] != len(channels):
        raise InputError(
            f"{scale_path(path)}: got {len(channels)} channels for a sound file of {samples.shape[1]}; allowed: a "
            "table [[channels]] for each, in its order"
        )
    step = _step(path, table, rate)
    time = np.asarray(np.arange(samples.shape[0]) * step, dtype=np.float64)
    record = TimeRecord(path.name, time, tuple(channels), samples * factors)
    return TimeData(str(table.get("title", "")), (record,))


def _table(path: Path) -> dict[str, Any]:
    """The table beside a sound file."""
    beside = scale_path(path)
    with problems_after("", "; samples of a sound file have no unit without one"):
        text = read_text(beside, _LONGEST_TABLE, f"a table of its scale: {_EXAMPLE}")
    try:
        table = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise InputError(f"{beside}: {error}; allowed: TOML, such as {_EXAMPLE}") from error
    unknown = [key for key in table if key not in _KEYS]
    if unknown:
        raise InputError(
            [
                f"{beside}: {short(key)} is not known{closest(key, _KEYS)}; allowed: {', '.join(_KEYS)}"
                for key in unknown
            ]
        )
    return table


def _channels(path: Path, table: dict[str, Any]) -> tuple[list[TimeChannel], FloatArray]:
    """Channels, and the value in SI of a sample of 1."""
    given, beside = table.get("channels"), scale_path(path)
    if not isinstance(given, list) or not 1 <= len(given) <= MOST_CHANNELS:
        raise InputError(f"{beside}: got no list [[channels]]; allowed: 1 to {MOST_CHANNELS}, such as {_EXAMPLE}")
    problems = Problems()
    channels, factors = [], []
    for number, entry in enumerate(given, start=1):
        where = f"{beside}, channel {number}"
        if not isinstance(entry, dict) or set(entry) != set(_CHANNEL_KEYS):
            problems.append(f"{where}: got {short(entry)}; allowed: the keys {', '.join(_CHANNEL_KEYS)}")
            continue
        name, unit, full = (entry[key] for key in _CHANNEL_KEYS)
        scale = float(full) if isinstance(full, (int, float)) and not isinstance(full, bool) else math.nan
        if not 0.0 < scale <= LARGEST:
            problems.append(f"{where}, full_scale: got {short(full)}; allowed: a number above 0 up to {LARGEST:g}")
        with problems.after(f"{where}, unit: "):
            recorded, si, factor = read_unit(str(unit), str(name))
            channels.append(TimeChannel(str(name), recorded, si))
            factors.append(factor * scale)
    problems.check()
    return channels, np.array(factors)


def _step(path: Path, table: dict[str, Any], rate: int) -> float:
    """Time between samples [s]."""
    step = table.get("step", 1.0 / rate if rate > 0 else math.nan)
    # The rate in the file is rounded to whole hertz.
    if isinstance(step, bool) or not isinstance(step, (int, float)) or not abs(step * rate - 1.0) <= 1.0 / max(rate, 1):
        raise InputError(
            f"{scale_path(path)}, step: got {short(step)} for a sound file of {rate} Hz; allowed: 1/rate, but for the "
            "rounding of the rate to whole hertz; leave it out to take the rate"
        )
    return float(step)


def _floating(samples: Any) -> FloatArray:
    """Samples as parts of full scale."""
    if samples.dtype == np.uint8:
        return np.asarray((samples - _OFFSET) / _HALF, dtype=np.float64)
    if np.issubdtype(samples.dtype, np.integer):
        return np.asarray(samples / float(-int(np.iinfo(samples.dtype).min)), dtype=np.float64)
    return np.asarray(samples, dtype=np.float64)


def _quoted(text: str) -> str:
    """A text of TOML."""
    return json.dumps("".join(letter if letter.isprintable() else " " for letter in text), ensure_ascii=False)


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
