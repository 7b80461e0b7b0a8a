"""Universal files written: hits and responses as datasets in SI, which pyuff writes."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import InputError
from ehdmaps.outputs import MARK, written_aside
from mbs.modal.records import Channel, Hits, Responses
from mbs.modal.uff import CODES, COHERENCE, RESPONSE, TIME, UFF, WINDOW, Dataset, Measurement, load_pyuff


def write_uff(path: Path, measurement: Measurement) -> None:
    """Write a universal file in SI, by the rule of all files that are written.

    Parameters
    ----------
    path : Path
        The file.
    measurement : Measurement
        Hits, responses, or both; its notes are not written.

    Raises
    ------
    InputError
        If it cannot be written, or has values that are not finite.
    """
    sets: list[Dataset] = []
    for entry in measurement.hits:
        sets += _hit_sets(entry)
    if measurement.responses is not None:
        sets += _response_sets(measurement.responses)
    write_sets(path, measurement.title, sets)


def write_sets(path: Path, title: str, functions: Sequence[Dataset]) -> None:
    """Write functions in SI below a header, by the rule of all files that are written.

    Parameters
    ----------
    path : Path
        The file.
    title : str
        Title of the header.
    functions : sequence of dict
        Datasets 58, as pyuff has them.

    Raises
    ------
    InputError
        If it cannot be written, or has values that are not finite.
    """
    pyuff = load_pyuff()
    sets: list[Dataset] = [_header(title), _si(), *functions]
    # The library would turn them into zeros.
    if not all(np.all(np.isfinite(entry["data"])) for entry in sets if "data" in entry):
        raise InputError(f"{path}: got values that are not finite; leave those records out")
    with written_aside(path, UFF) as aside:
        try:
            aside.unlink(missing_ok=True)  # the library adds to what is there
            pyuff.UFF(str(aside)).write_sets(sets, mode="overwrite")
        except Exception as error:  # the library raises nothing more special
            raise OSError(str(error)) from error


def _header(title: str) -> Dataset:
    """Dataset 151 with a title."""
    return {
        "type": 151,
        "model_name": ascii_text(title, 78) or "NONE",
        "description": MARK,
        "db_app": "mbs",
        "program": "mbs",
    }


def _si() -> Dataset:
    """Dataset 164 for SI."""
    return {
        "type": 164,
        "units_code": 1,
        "units_description": "SI: metre, newton",
        "temp_mode": 1,
        "length": 1.0,
        "force": 1.0,
        "temp": 1.0,
        "temp_offset": 0.0,
    }


def _hit_sets(hits: Hits) -> list[Dataset]:
    """Datasets 58 of all hits at a place."""
    time = np.asarray(np.arange(hits.force.shape[1]) * hits.step, dtype=np.float64)
    names = _names([hits.reference, *hits.sensors])
    sets = []
    for hit in range(hits.force.shape[0]):
        records = [hits.force[hit], *hits.response[hit]]
        for channel, name, record in zip((hits.reference, *hits.sensors), names, records, strict=True):
            entry = _function(TIME, time, record, channel, name, hits.reference, names[0])
            entry |= {"ver_num": hit + 1, "id2": f"hit {hit + 1}", "abscissa_spec_data_type": 17}
            sets.append(entry | _units("ordinate", channel))
    return sets


def _response_sets(responses: Responses) -> list[Dataset]:
    """Datasets 58 of frequency responses and coherences."""
    channels = list(dict.fromkeys(channel for pair in responses.pairs for channel in pair))
    names = dict(zip(channels, _names(channels), strict=True))
    sets = []
    for row, (sensor, reference) in enumerate(responses.pairs):
        ends = (sensor, names[sensor], reference, names[reference])
        entry = _function(RESPONSE, responses.frequency, responses.response[row], *ends)
        entry |= _units("ordinate", sensor) | _units("orddenom", reference)
        sets.append(entry)
        if np.all(np.isfinite(responses.coherence[row])):
            sets.append(_function(COHERENCE, responses.frequency, responses.coherence[row], *ends))
    for entry in sets:
        entry["abscissa_spec_data_type"] = 18
        if responses.decay:
            entry["id4"] = WINDOW.format(f"{responses.decay:.12g}")
    return sets


def _function(
    kind: int, axis: FloatArray, values: Any, sensor: Channel, name: str, reference: Channel, reference_name: str
) -> Dataset:
    """A dataset 58."""
    return function_of(kind, axis, values) | {
        "id1": ascii_text(f"{sensor.label} by {reference.label}", 78),
        "rsp_ent_name": name,
        "rsp_node": sensor.node,
        "rsp_dir": sensor.direction,
        "ref_ent_name": reference_name,
        "ref_node": reference.node,
        "ref_dir": reference.direction,
    }


def function_of(kind: int, axis: FloatArray, values: Any) -> Dataset:
    """A dataset 58 without names and units.

    Parameters
    ----------
    kind : int
        Function type, such as `mbs.modal.uff.TIME`.
    axis : array, shape (k,)
        Times [s] or frequencies [Hz].
    values : array, shape (k,)
        Values at these.
    """
    return {
        "type": 58,
        "binary": 0,
        "func_type": kind,
        "abscissa_spacing": int(_even(axis)),
        "x": axis,
        "data": np.array(values),
        "orddenom_spec_data_type": 0,
    }


def _even(axis: FloatArray) -> bool:
    """Whether values are evenly spaced, to what a file keeps of them."""
    spacing = (axis[-1] - axis[0]) / (axis.size - 1)
    return bool(np.max(np.abs(axis - axis[0] - spacing * np.arange(axis.size))) <= 1e-3 * spacing)


def _units(part: str, channel: Channel) -> Dataset:
    """Type and dimension of an ordinate or its denominator."""
    force = channel.quantity == "force"
    return {
        f"{part}_spec_data_type": CODES[channel.quantity],
        f"{part}_len_unit_exp": int(force == channel.rotational and channel.quantity != "unknown"),
        f"{part}_force_unit_exp": int(force),
    }


def _names(channels: Sequence[Channel]) -> list[str]:
    """Names of ten characters, which is what a file keeps; told apart where that makes two channels the same."""
    short = [ascii_text(channel.name, 10) or "NONE" for channel in channels]
    same = Counter(zip(short, ((c.node, c.direction, c.quantity) for c in channels), strict=True))
    return [
        f"{name[:6]}~{index}" if same[name, (c.node, c.direction, c.quantity)] > 1 else name
        for index, (name, c) in enumerate(zip(short, channels, strict=True))
    ]


def ascii_text(text: str, length: int) -> str:
    """Text that a record of the file can hold."""
    return "".join(letter if " " <= letter <= "~" else "?" for letter in text)[:length].strip()
