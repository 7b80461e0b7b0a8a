"""Universal files (UFF): hammer hits and frequency responses, by the library pyuff.

Datasets 58 (time records, function type 1; frequency responses, 4; coherences, 6), 151 (header) and 164 (units).
Values are divided by the factors of dataset 164, by the dimension of what was measured; without it they are taken for
SI. Labels of axes are not read: values in g stay in g, which changes no frequency and no damping.

The decay of an exponential window that responses, or records of hits, have been through stands in ID line 4 of those
written here. Dataset 1858 may say that there was one, but not which.

Hits: a record of the force (data type 13) belongs to the place in its response fields, a record of a response to the
place in its reference fields, and the version number counts the hits; where it does not, their order in the file
does. The step of evenly spaced values has six digits in such a file.

pyuff reads files that are cut off, headers that announce other counts, and zeros that fill up a last line without a
word. All of that is looked at here, and so is what belongs together.
"""

from __future__ import annotations

import re
import warnings
from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import InputError, Problems, problems_after
from ehdmaps.extras import needs
from ehdmaps.inputs import check_input
from ehdmaps.outputs import MARK, Kind, has_mark, written_aside
from mbs.modal.records import LONGEST, Channel, Hits, Measured, Responses

UFF = Kind("a universal file of mbs", (".uff", ".unv", ".uf", ".58"), has_mark)

TIME, RESPONSE, COHERENCE = 1, 4, 6
"""Function types of datasets 58 that are read and written."""

KINDS: dict[int, Measured] = {8: "displacement", 9: "force", 11: "velocity", 12: "acceleration", 13: "force"}
"""What was measured, by its type in a file."""

CODES: dict[Measured, int] = {"displacement": 8, "velocity": 11, "acceleration": 12, "force": 13, "unknown": 0}
"""Types that are written."""

WINDOW = "exponential window, decay {} 1/s"
"""ID line 4 of responses that have been through such a window."""

Dataset = dict[str, Any]
"""A dataset as pyuff has it."""


@dataclass(frozen=True, eq=False)
class Measurement:
    """Content of a universal file.

    Attributes
    ----------
    title : str
        Title of the measurement.
    hits : tuple of Hits
        An entry a place hit; none if the file has no time records.
    responses : Responses or None
        If the file has any.
    notes : tuple of str
        What was assumed.
    """

    title: str
    hits: tuple[Hits, ...] = ()
    responses: Responses | None = None
    notes: tuple[str, ...] = ()


def load_pyuff() -> Any:
    """Return pyuff.

    Raises
    ------
    DependencyError
        If it is not installed.
    """
    with needs("modal", "pyuff", "universal files"):
        import pyuff
    return pyuff


LARGEST = 2**29
"""Bytes of a file that is still read."""

_SHOWN_PROBLEMS = 20

_A_LINE = {(2, True): 6, (4, True): 4, (5, True): 3, (6, True): 2, (2, False): 3, (4, False): 2, (5, False): 2}
"""Values on a full line of a text by their type (single, double, complex single, complex double) and whether their
abscissa is even: a program may fill up the last line, with less than one of these."""
_WINDOW = re.compile(re.escape(WINDOW).replace(r"\{\}", r"([0-9.e+-]{1,24})"))

_QUALIFIERS, _EXPONENTIAL = 1858, (4, 6)
"""Dataset that may tell of a window, and types of exponential ones."""

_Place = tuple[str, int, int]


def read_uff(path: Path) -> Measurement:
    """Read a universal file.

    Parameters
    ----------
    path : Path
        The file.

    Raises
    ------
    InputError
        With everything that is wrong about it.
    """
    functions = _functions(path, (TIME, RESPONSE, COHERENCE))
    with problems_after(f"{path}: "):
        hits = _hits([entry for entry in functions.usable if entry["func_type"] == TIME], functions.factors)
        responses = _responses(functions.usable, functions.factors)
    return Measurement(functions.title, hits, responses, tuple(functions.notes))


class _Functions(NamedTuple):
    """Parts of a file that are used: title, datasets 58, factors of length and force, notes."""

    title: str
    usable: list[Dataset]
    factors: tuple[float, float]
    notes: list[str]


def time_records(path: Path) -> tuple[str, list[Dataset], list[float]]:
    """Title, time records of a file as pyuff has them, and the divisor to SI of each.

    Parameters
    ----------
    path : Path
        The file.

    Raises
    ------
    InputError
        With everything that is wrong about it.
    """
    functions = _functions(path, (TIME,))
    places = [int(entry.get("rsp_dir", 0)) for entry in functions.usable]
    divisors = [
        _to_si(entry, "ordinate", direction, functions.factors)
        for entry, direction in zip(functions.usable, places, strict=True)
    ]
    return functions.title, functions.usable, divisors


def _functions(path: Path, kinds: Sequence[int]) -> _Functions:
    """The functions of some types."""
    sets = _sets(path)
    problems: list[str] = []
    notes: list[str] = []
    factors = _factors(sets, problems, notes)
    functions = [entry for entry in sets if entry.get("type") == 58]
    usable = [
        entry
        for number, entry in enumerate(functions, start=1)
        if entry["func_type"] in kinds and _sound(entry, number, problems)
    ]
    if any(entry.get("window_type") in _EXPONENTIAL for entry in sets) and not any(map(_decay, usable)):
        notes.append(
            "dataset 1858: records have been through an exponential window, which adds to the damping: state it "
            "(--windowed)"
        )
    others = Counter(entry["func_type"] for entry in functions if entry["func_type"] not in kinds)
    notes += [f"{count} functions of type {kind} are left out" for kind, count in sorted(others.items())]
    if not problems and not usable:
        what = "time record" if tuple(kinds) == (TIME,) else "time record or a frequency response"
        problems.append(
            f"got {len(sets)} datasets, none of them a {what}; allowed: datasets 58 of "
            f"function type {' or '.join(str(kind) for kind in kinds if kind != COHERENCE)}"
        )
    if problems:
        more = [f"and {len(problems) - _SHOWN_PROBLEMS} more"] if len(problems) > _SHOWN_PROBLEMS else []
        raise InputError([f"{path}: {problem}" for problem in (*problems[:_SHOWN_PROBLEMS], *more)])
    title = next((str(entry.get("model_name", "")) for entry in sets if entry.get("type") == 151), "")
    return _Functions(title, usable, factors, notes)


def _sets(path: Path) -> list[Dataset]:
    """All datasets of a file as the library reads them."""
    pyuff = load_pyuff()
    size = check_input(path, LARGEST, "a universal file (.uff, .unv)", "measure fewer records in one file")
    try:
        with path.open("rb") as file:
            file.seek(max(size - 200, 0))
            # The library leaves out what an end is missing for.
            complete = file.read().rstrip().endswith(b"-1")
        with warnings.catch_warnings():
            # The library's own, about how it uses numpy; what it reads is checked here.
            warnings.simplefilter("ignore")
            library = pyuff.UFF(str(path))
            kinds = [int(kind) for kind in library.get_set_types()]
            indices = [index for index, kind in enumerate(kinds) if kind in (58, 151, 164, _QUALIFIERS)]
            read = [_one(library, index, kinds[index], path) for index in indices]
    except InputError:
        raise
    except Exception as error:  # the library raises nothing more special
        raise InputError(f"{path}: cannot be read as a universal file ({error})") from error
    if not read:
        raise InputError(
            f"{path}: got no datasets 58 between lines of -1; allowed: a universal file (.uff, .unv) with time records "
            "or frequency responses"
        )
    if not complete:
        raise InputError(f"{path}: does not end with a line of -1, as universal files do; the file is cut off")
    return read


def _one(file: Any, index: int, kind: int, path: Path) -> Dataset:
    """One dataset."""
    try:
        dataset = file.read_sets(index)
    except Exception as error:  # the library raises nothing more special
        if kind == _QUALIFIERS:  # nothing that is needed
            return {}
        raise InputError(
            f"{path}: dataset {index + 1}, of type {kind}, cannot be read ({error}); it is damaged or of another format"
        ) from error
    return dict(dataset)


def _factors(sets: Iterable[Dataset], problems: list[str], notes: list[str]) -> tuple[float, float]:
    """Factors of length and force from SI to the units of the file."""
    units = {(float(entry["length"]), float(entry["force"])) for entry in sets if entry.get("type") == 164}
    if not units:
        notes.append("no dataset 164: values are taken for SI")
        return 1.0, 1.0
    if len(units) > 1:
        problems.append(f"got {len(units)} datasets 164 with different units; allowed: one system of units in a file")
    factors = next(iter(units))
    if not all(np.isfinite(factor) and 1e-12 <= factor <= 1e12 for factor in factors):
        problems.append(
            f"dataset 164: got the factors {factors[0]:.6g} for length and {factors[1]:.6g} for force; allowed: 1e-12 "
            "to 1e12"
        )
    return factors


def _cut_to_count(entry: Dataset) -> None:
    """Leave out what fills the last line of a text behind the values that the header announces."""
    count, size = int(entry.get("num_pts", 0)), np.size(entry.get("data", ()))
    form, even = int(entry.get("ord_data_type", 0)), int(entry.get("abscissa_spacing", 0)) == 1
    if not entry.get("binary") and 0 < count < size < count + _A_LINE.get((form, even), 0):
        entry["data"], entry["x"] = np.asarray(entry["data"])[:count], np.asarray(entry["x"])[:count]


def _sound(entry: Dataset, number: int, problems: list[str]) -> bool:
    """Tell whether a function has the values that its header announces; else note what is wrong."""
    _cut_to_count(entry)
    values, axis = np.asarray(entry.get("data", ())), np.asarray(entry.get("x", ()))
    where = f"function {number}"
    count = int(entry.get("num_pts", 0))
    if values.ndim != 1 or values.size != count or axis.shape != values.shape:
        cause = "the file is cut off" if values.size < count else "the header or the values are of another record"
        problems.append(f"{where}: got {values.size} values and not {count}, as its header says; {cause}")
    elif not 2 <= count <= LONGEST:
        problems.append(f"{where}: got {count} values; allowed: 2 to {LONGEST}")
    elif not (np.all(np.isfinite(values)) and np.all(np.isfinite(axis))):
        problems.append(f"{where}: got values that are not finite; leave that record out")
    elif np.any(np.diff(axis) <= 0.0):
        problems.append(f"{where}: got an abscissa that does not rise")
    else:
        return True
    return False


def _place(entry: Dataset, side: str) -> _Place:
    """Name, node and direction of the response (rsp) or reference (ref) side."""
    name = str(entry.get(f"{side}_ent_name", "")).strip()
    return ("" if name.upper() == "NONE" else name), int(entry.get(f"{side}_node", 0)), int(entry.get(f"{side}_dir", 0))


def _kind(entry: Dataset, part: str) -> Measured:
    """Quantity of an ordinate, or of its denominator."""
    return KINDS.get(int(entry.get(f"{part}_spec_data_type", 0)), "unknown")


def _to_si(entry: Dataset, part: str, direction: int, factors: tuple[float, float]) -> float:
    """Divisor from the units of the file to SI of an ordinate or its denominator."""
    kind, rotational = _kind(entry, part), abs(direction) > 3
    lengths, forces = {
        "displacement": (0 if rotational else 1, 0),
        "velocity": (0 if rotational else 1, 0),
        "acceleration": (0 if rotational else 1, 0),
        "force": (1 if rotational else 0, 1),
        "unknown": (0, 0),
    }[kind]
    given = int(entry.get(f"{part}_len_unit_exp", 0)), int(entry.get(f"{part}_force_unit_exp", 0))
    # The exponents of the file count where the type or the direction does not say.
    if (kind == "unknown" or direction == 0) and any(given):
        lengths, forces = max(min(given[0], 9), -9), max(min(given[1], 9), -9)
    return float(factors[0] ** lengths * factors[1] ** forces)


def _hits(entries: Sequence[Dataset], factors: tuple[float, float]) -> tuple[Hits, ...]:
    """Time records put together by place hit."""
    if not entries:
        return ()
    forces: dict[_Place, list[Dataset]] = {}
    answers: dict[_Place, dict[Channel, list[Dataset]]] = {}
    for entry in entries:
        kind, place = _kind(entry, "ordinate"), _place(entry, "rsp")
        if kind == "force":
            forces.setdefault(place, []).append(entry)
        else:
            by_sensor = answers.setdefault(_place(entry, "ref"), {})
            by_sensor.setdefault(Channel(*place, kind), []).append(entry)
    if not forces or not answers:
        raise InputError(
            f"got {len(entries)} time records, {sum(map(len, forces.values()))} of a force; allowed: records of the "
            "hammer's force (ordinate data type 13) and of responses, for each hit"
        )
    if len(forces) == 1 and len(answers) == 1:
        # With one place hit there is no doubt, whatever the reference fields say.
        answers = {next(iter(forces)): next(iter(answers.values()))}
    missing = [place for place in answers if place not in forces]
    if missing:
        shown = ", ".join(Channel(*place, "force").label for place in missing)
        raise InputError(f"got responses to hits at {shown} without records of that force; allowed: both for each hit")
    hits = []
    problems = Problems()
    for place, by_sensor in answers.items():
        with problems:
            hits.append(_hits_at(place, forces[place], by_sensor, factors))
    problems.check()
    return tuple(hits)


def _hits_at(
    place: _Place, forces: list[Dataset], by_sensor: dict[Channel, list[Dataset]], factors: tuple[float, float]
) -> Hits:
    """Hits at one place."""
    reference = Channel(*place, "force")
    numbered = {"the force": _numbered(forces), **{key.label: _numbered(value) for key, value in by_sensor.items()}}
    wanted = sorted(numbered["the force"])
    problems = Problems(
        f"hits at {reference.label}: got {len(records)} records of {name} and {len(wanted)} of the force; allowed: one "
        "of each for each hit"
        for name, records in numbered.items()
        if sorted(records) != wanted
    )
    everything = [*forces, *(entry for value in by_sensor.values() for entry in value)]
    steps = np.array([(entry["x"][-1] - entry["x"][0]) / (entry["num_pts"] - 1) for entry in everything])
    uneven = max(
        float(np.max(np.abs(np.diff(entry["x"]) * (entry["num_pts"] - 1) / (entry["x"][-1] - entry["x"][0]) - 1.0)))
        for entry in everything
    )
    lengths = {int(entry["num_pts"]) for entry in everything}
    if len(lengths) > 1 or np.ptp(steps) > 1e-4 * steps[0] or uneven > 1e-2:
        problems.append(
            f"hits at {reference.label}: got records of {min(lengths)} to {max(lengths)} samples, every "
            f"{steps.min():.6g} to {steps.max():.6g} s; allowed: one length and one even step"
        )
    problems.check()

    def values(records: dict[int, Dataset], direction: int) -> FloatArray:
        return np.stack(
            [np.real(records[hit]["data"]) / _to_si(records[hit], "ordinate", direction, factors) for hit in wanted]
        )

    force = values(numbered["the force"], place[2])
    response = np.stack([values(numbered[sensor.label], sensor.direction) for sensor in by_sensor], axis=1)
    decays = {_decay(entry) for value in by_sensor.values() for entry in value}
    if len(decays) > 1:
        raise InputError(f"hits at {reference.label}: got records with different exponential windows; allowed: one")
    windowed_force = any(_decay(entry) > 0.0 for entry in forces)
    return Hits(float(steps[0]), force, response, reference, tuple(by_sensor), decays.pop(), windowed_force)


def _numbered(records: list[Dataset]) -> dict[int, Dataset]:
    """Records of a channel by number of the hit: their version numbers if they count, else their order."""
    numbers = [int(entry.get("ver_num", 0)) for entry in records]
    if len(set(numbers)) == len(numbers) and min(numbers) > 0:
        return dict(zip(numbers, records, strict=True))
    return dict(enumerate(records, start=1))


def _responses(entries: Sequence[Dataset], factors: tuple[float, float]) -> Responses | None:
    """Frequency responses with their coherences."""
    functions = [entry for entry in entries if entry["func_type"] == RESPONSE]
    if not functions:
        return None
    known = {
        (_place(entry, "rsp"), _place(entry, "ref")): entry for entry in entries if entry["func_type"] == COHERENCE
    }
    axis = np.asarray(functions[0]["x"], dtype=np.float64)
    values, coherence, pairs = [], [], []
    for entry in functions:
        if np.shape(entry["x"]) != axis.shape or not np.allclose(entry["x"], axis, rtol=1e-5, atol=1e-9):
            raise InputError("got frequency responses at different frequencies; allowed: one list of frequencies")
        sensor = Channel(*_place(entry, "rsp"), _kind(entry, "ordinate"))
        reference = Channel(*_place(entry, "ref"), "force")
        by = _to_si(entry, "ordinate", sensor.direction, factors)
        by /= _to_si(entry, "orddenom", reference.direction, factors)
        values.append(np.asarray(entry["data"], dtype=np.complex128) / by)
        beside = known.get((sensor.place, reference.place))
        there = beside is not None and np.shape(beside["data"]) == axis.shape
        coherence.append(np.clip(np.real(beside["data"]), 0.0, 1.0) if there and beside else np.full(axis.size, np.nan))
        pairs.append((sensor, reference))
    decays = {_decay(entry) for entry in functions}
    if len(decays) > 1:
        raise InputError("got frequency responses with different exponential windows; allowed: one for all")
    return Responses(axis, np.stack(values), np.stack(coherence), tuple(pairs), decay=decays.pop())


def _decay(entry: Dataset) -> float:
    """Decay of the window of a response [1/s], where this package wrote it; 0 elsewhere."""
    note = _WINDOW.fullmatch(str(entry.get("id4", "")).strip())
    try:
        return float(note[1]) if note else 0.0
    except ValueError:
        return 0.0


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
    model_name = ascii_text(title, 78) or "NONE"
    header = pyuff.prepare_151(model_name=model_name, description=MARK, db_app="mbs", program="mbs")
    units = pyuff.prepare_164(1, "SI: metre, newton", temp_mode=1, length=1.0, force=1.0, temp=1.0, temp_offset=0.0)
    sets: list[Dataset] = [header, units, *functions]
    # The library would turn them into zeros.
    if not all(np.all(np.isfinite(entry["data"])) for entry in sets if "data" in entry):
        raise InputError(f"{path}: got values that are not finite; leave those records out")
    with written_aside(path, UFF) as aside:
        try:
            aside.unlink(missing_ok=True)  # the library adds to what is there
            pyuff.UFF(str(aside)).write_sets(sets, mode="overwrite")
        except Exception as error:  # the library raises nothing more special
            raise OSError(str(error)) from error


def _hit_sets(hits: Hits) -> list[Dataset]:
    """Datasets 58 of all hits at a place."""
    time = np.asarray(np.arange(hits.force.shape[1]) * hits.step, dtype=np.float64)
    names = _names([hits.reference, *hits.sensors])
    sets = []
    for hit in range(hits.force.shape[0]):
        records = [hits.force[hit], *hits.response[hit]]
        for channel, name, record in zip((hits.reference, *hits.sensors), names, records, strict=True):
            entry = _function(TIME, time, record, channel, name, hits.reference, names[0])
            if hits.decay and (channel is not hits.reference or hits.force_decays):
                entry["id4"] = WINDOW.format(f"{hits.decay:.12g}")
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
    spacing = (axis[-1] - axis[0]) / (axis.size - 1)
    # Evenly spaced, to what a file keeps of the values.
    even = np.max(np.abs(axis - axis[0] - spacing * np.arange(axis.size))) <= 1e-3 * spacing
    return {
        "type": 58,
        "binary": 0,
        "func_type": kind,
        "abscissa_spacing": int(even),
        "x": axis,
        "data": np.array(values),
        "orddenom_spec_data_type": 0,
    }


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
