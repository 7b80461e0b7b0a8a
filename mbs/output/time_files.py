"""Files of time data, by the ending of their name."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from pathlib import Path

from ehdmaps.errors import InputError
from ehdmaps.extras import lacking
from ehdmaps.outputs import TABLE, Output
from mbs.modal.uff import UFF
from mbs.output.files import RESULT, described, write_dataset
from mbs.timedata.csv_file import read_csv, write_csv
from mbs.timedata.netcdf_file import read_netcdf, signal_variables
from mbs.timedata.records import TimeData, TimeRecord
from mbs.timedata.uff_file import read_time_uff, write_time_uff
from mbs.timedata.wav_file import SCALE, WAV, read_wav, scale_path, write_wav

ENDINGS = (".nc", ".csv", ".uff", ".unv", ".wav")

_KINDS = {".nc": RESULT, ".csv": TABLE, ".uff": UFF, ".unv": UFF, ".wav": WAV}
_READERS: dict[str, Callable[[Path], TimeData]] = {
    ".nc": read_netcdf,
    ".csv": read_csv,
    ".uff": read_time_uff,
    ".unv": read_time_uff,
    ".wav": read_wav,
}


def is_time_data(name: str) -> bool:
    """Tell whether a name is that of a file of time data, by its ending."""
    return Path(name).suffix.lower() in ENDINGS


def read_time_data(path: str | Path) -> TimeData:
    """Read a file of time data.

    Parameters
    ----------
    path : str or Path
        The file; its ending says what it is.

    Raises
    ------
    InputError
        With what is wrong about it; also for another ending.
    DependencyError
        If a library that it needs is not installed.
    """
    place = Path(path)
    reader = _READERS.get(place.suffix.lower())
    if reader is None:
        raise InputError(f"{str(path)!r:.300}: allowed: a file that ends in {', '.join(ENDINGS)}")
    try:
        return reader(place)
    except InputError as error:
        name = str(place)
        raise InputError([line if name in line else f"{name}: {line}" for line in error.problems]) from error


def write_time_data(path: str | Path, data: TimeData) -> list[str]:
    """Write a file of time data; a line for each file that was written.

    Parameters
    ----------
    path : str or Path
        The file; its ending says what it becomes.
    data : TimeData
        Records, with their speed. One record, but in netCDF, which holds more.

    Raises
    ------
    InputError
        If it cannot be written.
    DependencyError
        If a library that it needs is not installed.
    """
    place = Path(path)
    ending = place.suffix.lower()
    data = dataclasses.replace(data, records=tuple(_without_speeds(record) for record in data.records))
    lines: list[str] = []
    if ending == ".nc":
        attributes = {key: words for key, words in (data.attributes or {}).items() if not key.endswith("version")}
        write_dataset(described(signal_variables(data), **attributes), place)
    elif len(data.records) > 1:
        raise InputError(
            f"{place}: got {len(data.records)} laws; allowed in {ending}: one; write .nc, or one law at a time"
        )
    elif ending == ".csv":
        write_csv(place, data)
    elif ending == ".wav":
        lines = write_wav(place, data)
    elif ending in ENDINGS:
        write_time_uff(place, data)
    else:
        raise InputError(f"{place}: allowed: a file that ends in {', '.join(ENDINGS)}")
    return [f"{place}: written", *lines]


def _without_speeds(record: TimeRecord) -> TimeRecord:
    """A record without channels of a speed, where it has the speed itself."""
    kept = [place for place, channel in enumerate(record.channels) if channel.recorded != "speed"]
    if record.speed is None or len(kept) in (0, len(record.channels)):
        return record
    return dataclasses.replace(
        record, channels=tuple(record.channels[place] for place in kept), values=record.values[:, kept]
    )


def signal_outputs(option: str, path: str | None, laws: int = 1) -> tuple[list[Output], list[str]]:
    """Files that `write_time_data` writes, to be checked before anything runs, and what is wrong about the name.

    Parameters
    ----------
    option : str
        That names the file.
    path : str or None
        Path as it was given.
    laws : int
        How many records there will be.
    """
    if path is None:
        return [], []
    ending = Path(path).suffix.lower()
    if ending not in ENDINGS:
        return [], [f"{option}: got {path!r:.300}; allowed: a file that ends in {', '.join(ENDINGS)}"]
    if laws > 1 and ending != ".nc":
        return [], [f"{option}: got {laws} laws for {path}; allowed in {ending}: one; write .nc, or one law at a time"]
    problems = list(lacking("modal", "pyuff", option)) if _KINDS[ending] is UFF else []
    outputs = [Output(option, path, _KINDS[ending])]
    return outputs + ([Output(option, scale_path(Path(path)), SCALE)] if ending == ".wav" else []), problems
