"""Time data as universal files (UFF): datasets 58 of function type 1, by the library pyuff.

Displacements, velocities and accelerations have the data types 8, 11 and 12, the speed has 19 (rpm); values are in SI,
as dataset 164 says. The full name of a channel stands in ID line 1. Numbers have 12 digits.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from ehdmaps.errors import InputError
from ehdmaps.units import RPM
from mbs.modal.uff import CODES, TIME, Dataset, ascii_text, function_of, time_records, write_sets
from mbs.timedata.records import Recorded, TimeChannel, TimeData, TimeRecord, read_unit

_RPM = 19
"""Data type of a rotational speed."""

_UNITS: dict[Recorded, str] = {"displacement": "m", "velocity": "m/s", "acceleration": "m/s2"}
_NAMES = {8: "displacement", 11: "velocity", 12: "acceleration"}


def write_time_uff(path: Path, data: TimeData) -> None:
    """Write the one record of time data, by the rule of all files that are written.

    Parameters
    ----------
    path : Path
        The file.
    data : TimeData
        Time data of one record.

    Raises
    ------
    InputError
        If it cannot be written.
    DependencyError
        If pyuff is not installed.
    """
    (record,) = data.records
    time = record.time - record.time[0]
    sets: list[Dataset] = []
    if record.speed is not None:
        sets.append(_dataset(1, TimeChannel("speed", "speed", "rpm"), time, RPM.value(1.0) * record.speed))
    for number, channel in enumerate(record.channels, start=len(sets) + 1):
        sets.append(_dataset(number, channel, time, record.column(channel)))
    write_sets(path, f"{data.title}, {record.label}", sets)


def read_time_uff(path: Path) -> TimeData:
    """Read time data from a universal file.

    Parameters
    ----------
    path : Path
        The file.

    Raises
    ------
    InputError
        With what is wrong about it.
    DependencyError
        If pyuff is not installed.
    """
    title, sets, divisors = time_records(path)
    lengths = sorted({int(entry["num_pts"]) for entry in sets})
    steps = np.array([(entry["x"][-1] - entry["x"][0]) / (entry["num_pts"] - 1) for entry in sets])
    if len(lengths) > 1 or np.ptp(steps) > 1e-6 * steps[0]:
        raise InputError(
            f"{path}: got time records of {lengths[0]} to {lengths[-1]} samples, every {steps.min():.6g} to "
            f"{steps.max():.6g} s; allowed: one length and one step; write what belongs together into one file"
        )
    channels, columns = [], []
    for number, (entry, divisor) in enumerate(zip(sets, divisors, strict=True), start=1):
        channel, factor = _channel(entry, number)
        channels.append(channel)
        columns.append(np.real(np.asarray(entry["data"])) * factor / divisor)
    return TimeData(
        title, (TimeRecord(path.name, np.asarray(sets[0]["x"], float), tuple(channels), np.column_stack(columns)),)
    )


def _dataset(number: int, channel: TimeChannel, time: Any, values: Any) -> Dataset:
    """A dataset 58 of a channel."""
    rotational = channel.unit.startswith("rad")
    entry = function_of(TIME, time, values)
    entry |= {
        "id1": ascii_text(channel.name, 78) or "NONE",
        "rsp_ent_name": ascii_text(channel.name, 10) or "NONE",
        "rsp_node": number,
        "rsp_dir": 4 if rotational else 0,
        "ref_ent_name": "NONE",
        "ref_node": 0,
        "ref_dir": 0,
        "abscissa_spec_data_type": 17,
        "ordinate_axis_units_lab": ascii_text(channel.unit, 20),
    }
    moved = channel.recorded in _UNITS
    entry["ordinate_spec_data_type"] = (
        CODES[channel.recorded] if moved else _RPM if channel.recorded == "speed" else 0  # type: ignore[index]
    )
    entry["ordinate_len_unit_exp"] = int(moved and not rotational)
    return entry


def _channel(entry: Dataset, number: int) -> tuple[TimeChannel, float]:
    """Channel that a dataset holds, and the factor to SI beside the units of dataset 164."""
    names = (str(entry.get(key, "")).strip() for key in ("id1", "rsp_ent_name"))
    name = next((name for name in names if name and name.upper() != "NONE"), f"channel {number}")
    kind, rotational = int(entry.get("ordinate_spec_data_type", 0)), abs(int(entry.get("rsp_dir", 0))) > 3
    if kind == _RPM:
        return TimeChannel(name, "speed", "rad/s"), 1.0 / RPM.value(1.0)
    if kind in _NAMES:
        recorded: Any = _NAMES[kind]
        unit = _UNITS[recorded]
        return TimeChannel(name, recorded, unit.replace("m", "rad", 1) if rotational else unit), 1.0
    # Of no type that says what it is, the label of the axis does, where it is a unit.
    label = str(entry.get("ordinate_axis_units_lab", "")).strip()
    try:
        recorded, unit, factor = read_unit(label, name)
    except InputError:
        return TimeChannel(name, "other", "1"), 1.0
    return TimeChannel(name, recorded, unit), factor
