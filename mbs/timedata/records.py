"""Units of channels: what was measured by them, and how they become SI.

Channels over time: what files hold, and what levels are made from.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import InputError
from ehdmaps.units import closest
from mbs.model.elements import Quantity
from mbs.settings import CampbellSettings
from mbs.spectral.levels import Reference
from mbs.spectral.run_signal import RunSignal

Recorded = Literal["displacement", "velocity", "acceleration", "speed", "time", "other"]
"""What a channel may be: motion, the speed of the system, time, or anything else, such as the voltage of a tacho."""

STANDARD_GRAVITY = 9.80665
"""[m/s2], of a channel in g."""

_TURN = 2.0 * math.pi
_UNITS: dict[str, tuple[Recorded, str, float]] = {
    "m/s2": ("acceleration", "m/s2", 1.0),
    "mm/s2": ("acceleration", "m/s2", 1e-3),
    "g": ("acceleration", "m/s2", STANDARD_GRAVITY),
    "rad/s2": ("acceleration", "rad/s2", 1.0),
    "m/s": ("velocity", "m/s", 1.0),
    "mm/s": ("velocity", "m/s", 1e-3),
    "rad/s": ("velocity", "rad/s", 1.0),
    "m": ("displacement", "m", 1.0),
    "mm": ("displacement", "m", 1e-3),
    "um": ("displacement", "m", 1e-6),
    "nm": ("displacement", "m", 1e-9),
    "rad": ("displacement", "rad", 1.0),
    "deg": ("displacement", "rad", _TURN / 360.0),
    "rpm": ("speed", "rad/s", _TURN / 60.0),
    "1/min": ("speed", "rad/s", _TURN / 60.0),
    "min-1": ("speed", "rad/s", _TURN / 60.0),
    "r/min": ("speed", "rad/s", _TURN / 60.0),
    "U/min": ("speed", "rad/s", _TURN / 60.0),
    "Hz": ("speed", "rad/s", _TURN),
    "1/s": ("speed", "rad/s", _TURN),
    "s-1": ("speed", "rad/s", _TURN),
    "s": ("time", "s", 1.0),
    "ms": ("time", "s", 1e-3),
    "us": ("time", "s", 1e-6),
    "V": ("other", "V", 1.0),
    "mV": ("other", "V", 1e-3),
    "N": ("other", "N", 1.0),
    "1": ("other", "1", 1.0),
}
_SPEED_NAMES = ("speed", "rotational speed", "n")

SPEED_UNITS = ("rpm", "rad/s", "Hz")
"""Some units of a speed, for messages."""

SHOWN = "m/s2, g, m/s, mm/s, m, um, rad, rpm, Hz, V"
"""Some units, for messages."""


def plain(unit: str) -> str:
    """A unit in the letters of the table: ``m/s^2`` and ``m/s²`` are ``m/s2``.

    Examples
    --------
    >>> plain("m/s^2"), plain("µm"), plain("RPM")
    ('m/s2', 'um', 'rpm')
    """
    text = unit.strip().replace("²", "2").replace("**", "").replace("^", "").replace("µ", "u").replace("μ", "u")
    return "rpm" if text.lower() == "rpm" else text


def read_unit(unit: str, name: str) -> tuple[Recorded, str, float]:
    """Quantity of a channel by its unit, the SI unit, and the factor to it.

    Parameters
    ----------
    unit : str
        Unit as it stands in a file.
    name : str
        Name of the channel: one in rad/s that is called a speed is the speed of the system.

    Raises
    ------
    InputError
        If the unit is not known; the caller says where.

    Examples
    --------
    >>> read_unit("g", "S1")
    ('acceleration', 'm/s2', 9.80665)
    """
    entry = _UNITS.get(plain(unit))
    if entry is None:
        raise InputError(f"got the unit {unit!r:.40}{closest(plain(unit), tuple(_UNITS))}; allowed: {SHOWN}")
    if entry[1] == "rad/s" and name.strip().lower() in _SPEED_NAMES:
        return ("speed", "rad/s", entry[2])
    return entry


def motion(recorded: Recorded) -> Quantity | None:
    """The quantity of a channel that has levels; None of any other channel."""
    return recorded if recorded in ("displacement", "velocity", "acceleration") else None


FEWEST, MOST = 2, 5_000_000
"""Samples of a record: those that make a step, and as many as a run may have."""

MOST_CHANNELS = 256

LARGEST = 1e100
"""Of a value: squares of larger numbers, and their sums, would be infinite."""

_OFF_GRID = 0.01
"""Of a step, by which rounded times in a file may lie beside equal steps."""


@dataclass(frozen=True)
class TimeChannel:
    """Description of one column of a record.

    Attributes
    ----------
    name : str
        Name of the sensor.
    recorded : {"displacement", "velocity", "acceleration", "speed", "time", "other"}
        What it holds.
    unit : str
        Unit of the values: SI, as m/s2, or rad/s of a speed.
    """

    name: str
    recorded: Recorded
    unit: str

    @property
    def reference(self) -> Reference | None:
        """Reference of its levels; None of a channel that has none."""
        quantity = motion(self.recorded)
        return None if quantity is None else Reference.of_quantity(quantity, self.unit.startswith("rad"))


@dataclass(frozen=True, eq=False)
class TimeRecord:
    """Channels of one run over time.

    Attributes
    ----------
    label : str
        What run it is, such as the law of a simulated one.
    time : array, shape (samples,)
        Equally spaced [s].
    channels : tuple of TimeChannel
        What the columns are.
    values : array, shape (samples, channels)
        Values in the unit of each channel.
    speed, angle : array, shape (samples,), or None
        Speed of the system [rad/s] and angle turned [rad], where they are known.

    Raises
    ------
    InputError
        With everything that does not fit together.
    """

    label: str
    time: FloatArray
    channels: tuple[TimeChannel, ...]
    values: FloatArray
    speed: FloatArray | None = None
    angle: FloatArray | None = None

    def __post_init__(self) -> None:
        problems = [*_shape_problems(self)]
        problems = problems or _value_problems(self)
        if problems:
            raise InputError(problems)
        object.__setattr__(self, "time", on_grid(self.time))

    @property
    def names(self) -> tuple[str, ...]:
        """Names of all channels."""
        return tuple(channel.name for channel in self.channels)

    @property
    def sensors(self) -> tuple[TimeChannel, ...]:
        """The channels that have levels."""
        return tuple(channel for channel in self.channels if channel.reference is not None)

    def column(self, channel: TimeChannel) -> FloatArray:
        """Values of a channel, shape (samples,)."""
        return np.ascontiguousarray(self.values[:, self.channels.index(channel)])

    def signal(self, channel: TimeChannel) -> RunSignal:
        """A channel with the speed, for spectra.

        Raises
        ------
        InputError
            If the record has no speed; see `mbs.timedata.speed`.
        """
        if self.speed is None or self.angle is None:
            raise InputError(f"{self.label}: got no speed; allowed: one of `mbs.timedata.speed.with_speed`")
        return RunSignal(self.time, self.speed, self.angle, self.column(channel))

    def part(self, begin: int, end: int) -> TimeRecord:
        """The samples from `begin` up to, not including, `end`."""
        here = slice(begin, end)
        return TimeRecord(
            self.label,
            self.time[here],
            self.channels,
            self.values[here],
            None if self.speed is None else self.speed[here],
            None if self.angle is None else self.angle[here],
        )


@dataclass(frozen=True, eq=False)
class TimeData:
    """Content of a file of time data.

    Attributes
    ----------
    title : str
        Title of the machine or the measurement; empty if the file does not say.
    records : tuple of TimeRecord
        One, or one for each law of a simulated run.
    orders : tuple of (float, str)
        Orders that the machine excites, with their names, where they are known.
    attributes : dict of str to str
        Provenance of the data.
    look : CampbellSettings or None
        What the scene of a simulated run looks at; None where there is none.
    """

    title: str
    records: tuple[TimeRecord, ...]
    orders: tuple[tuple[float, str], ...] = ()
    attributes: dict[str, str] | None = None
    look: CampbellSettings | None = None


def chosen(record: TimeRecord, name: str, option: str) -> TimeChannel:
    """The channel of a name.

    Parameters
    ----------
    record : TimeRecord
        The record.
    name : str
        Name of a channel; letters may be small or large.
    option : str
        Begins the message.

    Raises
    ------
    InputError
        If there is none, or more than one.
    """
    channels = [channel for channel in record.channels if channel.name == name]
    channels = channels or [channel for channel in record.channels if channel.name.lower() == name.lower()]
    if len(channels) == 1:
        return channels[0]
    words = f"stands for {len(channels)} channels" if channels else f"is not there{closest(name, record.names)}"
    raise InputError(f"{option}: {name!r:.60} {words}; allowed: {', '.join(record.names)}")


def on_grid(time: FloatArray) -> FloatArray:
    """Times without the rounding that a file gave them: equal steps from the first to the last.

    Parameters
    ----------
    time : array, shape (samples,)
        Times that lie on such a grid within a hundredth of a step [s].
    """
    return np.asarray(time[0] + _step(time) * np.arange(time.size), dtype=np.float64)


def _step(time: FloatArray) -> float:
    """Mean step [s]."""
    return float(time[-1] - time[0]) / (time.size - 1)


def _shape_problems(record: TimeRecord) -> list[str]:
    """Problems with sizes and names."""
    samples, names = record.time.size, record.names
    problems = []
    if record.time.ndim != 1 or not FEWEST <= samples <= MOST:
        problems.append(f"{record.label}: got {samples} samples; allowed: {FEWEST} to {MOST}; record longer, or cut it")
    if not 1 <= len(names) <= MOST_CHANNELS:
        problems.append(f"{record.label}: got {len(names)} channels; allowed: 1 to {MOST_CHANNELS}")
    problems += [
        f"{record.label}: got {names.count(name)} channels named {name!r:.60}; allowed: each name once; rename them"
        for name in sorted(set(names))
        if names.count(name) > 1
    ]
    if record.values.shape != (samples, len(names)):
        problems.append(
            f"{record.label}: got values of shape {record.values.shape} for {samples} samples of {len(names)} "
            "channels; allowed: a column a channel, of equal length"
        )
    for name in ("speed", "angle"):
        given = getattr(record, name)
        if given is not None and given.shape != record.time.shape:
            problems.append(f"{record.label}: got {name} of shape {given.shape}; allowed: ({samples},)")
    return problems


def _value_problems(record: TimeRecord) -> list[str]:
    """Problems with numbers; each channel with its first bad sample."""
    problems = []
    columns = [(channel.name, record.values[:, place]) for place, channel in enumerate(record.channels)]
    columns += [("speed", record.speed)] if record.speed is not None else []
    for name, column in (("time", record.time), *columns):
        sound = np.abs(column) <= LARGEST
        if not sound.all():
            at = int(np.argmin(sound))
            problems.append(
                f"{record.label}, channel {name!r:.60}: got {column[at]} at sample {at + 1}; allowed: finite numbers "
                f"up to {LARGEST:g}; leave that part of the record out, or mend it"
            )
    if problems:
        return problems
    step = _step(record.time)
    off = np.abs(record.time - record.time[0] - step * np.arange(record.time.size))
    if not step > 0.0 or float(off.max()) > _OFF_GRID * step:
        steps = np.diff(record.time)
        at = int(np.argmax(np.abs(steps - np.median(steps))))
        problems.append(
            f"{record.label}, time: got steps of {steps.min():.6g} to {steps.max():.6g} s, the first odd one after "
            f"sample {at + 1}; allowed: equal and > 0; bring the record to equal times first"
        )
    return problems
