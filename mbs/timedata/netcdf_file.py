"""Time data in netCDF: the variables of signals that results of `mbs runup` have, and files of signals alone.

signal (law, signal_time, sensor), signal_speed and signal_angle (signal_time), quantity and signal_unit (sensor), and
followed_order (excited) where the machine says which orders it excites. The dimension law is there in files of several.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from ehdmaps.arrays import variable
from ehdmaps.errors import InputError
from ehdmaps.inputs import check_input
from ehdmaps.netcdf_structure import DAMAGE, structure_problem
from mbs.settings import CampbellSettings
from mbs.timedata.records import MOST, MOST_CHANNELS, TimeChannel, TimeData, TimeRecord, read_unit

LONGEST_FILE = 2**34
"""Bytes."""

_MOST_LAWS = 64
_NEEDED = ("signal", "signal_time", "signal_speed", "signal_angle", "sensor", "signal_unit")
_ALLOWED = "a result of `mbs runup -o` or a file of `--signals`"
_WORDS = ("title", "law", "scene", "scene_toml", "schema_version", "ehdmaps_version", "oil_supply", "surface")
"""Attributes that go on into what is made from a file."""

_LOOK = ("campbell_sensor", "campbell_highest_hz", "campbell_window_s")
"""Attributes of what the scene of a simulated run looks at."""


def signal_variables(data: TimeData) -> xr.Dataset:
    """Signals as variables of a dataset.

    Parameters
    ----------
    data : TimeData
        Records of the same times and channels, each with speed and angle.
    """
    first, several = data.records[0], len(data.records) > 1
    dims = (*(("law",) if several else ()), "signal_time", "sensor")
    values = np.stack([record.values for record in data.records]) if several else first.values
    variables: dict[str, Any] = {
        "signal": variable(dims, values, "by signal_unit", "signals of the sensors, one a step"),
        "signal_unit": variable("sensor", _texts([c.unit for c in first.channels]), "", "unit of the signal"),
        "quantity": variable("sensor", _texts([c.recorded for c in first.channels]), "", "what the sensor measures"),
    }
    coordinates: dict[str, Any] = {
        "signal_time": variable("signal_time", first.time, "s", "time of the signals"),
        "sensor": _texts(list(first.names)),
    }
    for name, unit, words in (("speed", "rad/s", "speed of the system"), ("angle", "rad", "angle turned")):
        column = getattr(first, name)
        if column is not None:
            attrs = {"units": unit, "long_name": f"{words}, at the times of the signals"}
            variables[f"signal_{name}"] = ("signal_time", column, attrs)
    if several:
        coordinates["law"] = _texts([record.label for record in data.records])
    if data.orders:
        words = "orders that the machine excites: periods a turn of the system"
        coordinates["excited"] = _texts([name for _, name in data.orders])
        values = np.array([order for order, _ in data.orders])
        variables["followed_order"] = variable("excited", values, "1", words)
    attributes: dict[str, Any] = {"label": first.label, **(data.attributes or {}), "title": data.title}
    if data.look is not None:
        given = (data.look.sensor, data.look.highest, data.look.window)
        attributes |= {name: value for name, value in zip(_LOOK, given, strict=True) if value is not None}
    return xr.Dataset(variables, coords=coordinates, attrs=attributes)


def read_netcdf(path: Path) -> TimeData:
    """Read the signals of a result.

    Parameters
    ----------
    path : Path
        The file.

    Raises
    ------
    InputError
        With what is wrong about it.
    """
    check_input(path, LONGEST_FILE, _ALLOWED)
    if problem := structure_problem(path):
        raise InputError(f"{path}: {problem}; allowed: {_ALLOWED}")
    try:
        with xr.open_dataset(path, engine="netcdf4") as dataset:
            missing = [name for name in _NEEDED if name not in dataset.variables]
            sizes = {name: int(dataset.sizes.get(name, 1)) for name in ("law", "signal_time", "sensor")}
            limits = {"law": _MOST_LAWS, "signal_time": MOST, "sensor": MOST_CHANNELS}
            if missing:
                raise InputError(
                    f"{path}: has no {', '.join(missing)}; allowed: {_ALLOWED}; other results have no signals"
                )
            if any(sizes[name] > most for name, most in limits.items()):
                raise InputError(f"{path}: got {sizes}; allowed: at most {limits}")
            names = [*_NEEDED, *(name for name in ("law", "followed_order", "excited") if name in dataset.variables)]
            return _data(path, dataset[names].load())
    except InputError:
        raise
    except DAMAGE as error:
        raise InputError(f"{path}: cannot be read ({error}); allowed: {_ALLOWED}") from error


def _data(path: Path, dataset: xr.Dataset) -> TimeData:
    """The records of a dataset that has all variables."""
    channels = []
    for name, unit in zip(dataset["sensor"].values.tolist(), dataset["signal_unit"].values.tolist(), strict=True):
        recorded, si, _ = read_unit(str(unit), "")
        channels.append(TimeChannel(str(name), recorded, si))
    time, speed, angle = (np.asarray(dataset[name].values, float) for name in _NEEDED[1:4])
    several = "law" in dataset["signal"].dims
    signals = dataset["signal"].transpose(..., "signal_time", "sensor").values.astype(float)
    labels = [str(name) for name in dataset["law"].values] if several else [str(dataset.attrs.get("label", path.stem))]
    orders: list[tuple[float, str]] = []
    if "followed_order" in dataset:
        values, names = dataset["followed_order"].values.tolist(), dataset["excited"].values.tolist()
        orders = [(float(order), str(name)) for order, name in zip(values, names, strict=True)]
    records = tuple(
        TimeRecord(label, time, tuple(channels), values, speed, angle)
        for label, values in zip(labels, signals if several else signals[None], strict=True)
    )
    words = {key: str(dataset.attrs[key]) for key in _WORDS if key in dataset.attrs}
    return TimeData(words.get("title", ""), records, tuple(orders), words, _look(path, dataset.attrs))


def _look(path: Path, attributes: dict[str, Any]) -> CampbellSettings | None:
    """Settings of what the scene of a run looks at."""
    sensor, highest, window = (attributes.get(name) for name in _LOOK)
    if highest is None:
        return None
    try:
        return CampbellSettings(
            None if sensor is None else str(sensor), float(highest), None if window is None else float(window)
        )
    except (TypeError, ValueError) as error:
        raise InputError(f"{path}: {', '.join(_LOOK)}: got no numbers ({error}); the file is damaged") from error


def _texts(values: Sequence[str]) -> Any:
    """Texts, also where there are none."""
    return np.array(values, dtype=np.str_)
