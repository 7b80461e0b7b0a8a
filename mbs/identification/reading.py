"""Measurements from files: universal files of hits or responses, tables of responses, tables of modes.

::

    frequency [Hz],seat/hammer real [m/s2/N],seat/hammer imag [m/s2/N],seat/hammer coherence [1]
    speed [rpm],frequency [Hz],damping ratio [1]

A table of modes may have, beside these, "frequency deviation [Hz]", "damping ratio deviation [1]", and a shape, as
"SENSOR real [1]" and "SENSOR imag [1]". Hits become responses as in `mbs modal-fit`.
"""

from __future__ import annotations

import dataclasses
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TypeVar, cast

import numpy as np

from ehdmaps.arrays import ComplexArray, FloatArray
from ehdmaps.errors import InputError, Problems, closest
from ehdmaps.units import quantity
from mbs.identification.measured import (
    DAMPING_DEVIATION,
    FREQUENCY_DEVIATION,
    POOREST,
    Measured,
    MeasuredModes,
    MeasuredResponses,
    assumed_deviation,
    noise_of,
)
from mbs.modal.estimation import estimate, needed_decay
from mbs.modal.records import Channel, Responses
from mbs.modal.uff import UFF, read_uff
from mbs.model.elements import Input, Quantity, Sensor
from mbs.scene.scene import Scene
from mbs.timedata.csv_file import titled_columns

EXAMPLE = "frequency [Hz],SENSOR/INPUT real [m/s2/N],SENSOR/INPUT imag [m/s2/N]"

_ROW = re.compile(r"(?P<sensor>.+?)/(?P<input>.+) (?P<part>real|imag|coherence)")
_SHAPE = re.compile(r"(?P<sensor>.+) (?P<part>real|imag)")
_QUANTITIES = {"m": "displacement", "m/s": "velocity", "m/s^2": "acceleration"}
_LEAST_HITS = 2


@dataclass(frozen=True)
class Reading:
    """Choices of how files are read.

    Attributes
    ----------
    names : mapping of str to str
        Sensor or input of the scene by its name in the files.
    averages : int or None
        Averages of responses from files that do not tell; None where coherence says nothing then.
    band : (float, float)
        Lines that are used [Hz].
    """

    names: Mapping[str, str] = dataclasses.field(default_factory=dict)
    averages: int | None = None
    band: tuple[float, float] = (0.0, np.inf)


def read_measured(path: Path, speed: float | None, scene: Scene, reading: Reading) -> tuple[list[Measured], list[str]]:
    """Read what was measured of a machine, and what is to be said of it.

    Parameters
    ----------
    path : Path
        The file.
    speed : float or None
        Speed of the system [rad/s]; None where the file has it.
    scene : Scene
        Sensors and inputs.
    reading : Reading
        How it is read.

    Raises
    ------
    InputError
        With every problem.
    """
    if path.suffix.lower() not in UFF.endings:
        titles, values = titled_columns(path, EXAMPLE)
        if any(name.strip().lower() == "damping ratio" or name.strip().lower() == "speed" for name, _ in titles):
            return _modes(path, titles, values, speed, scene, reading)
        responses: Responses | None = _from_table(path, titles, values, reading.averages)
        notes: list[str] = []
    else:
        measurement = read_uff(path)
        responses, notes = measurement.responses, [f"{path}: {note}" for note in measurement.notes]
        if measurement.hits:
            decay = max(needed_decay(entry.response, entry.step) for entry in measurement.hits)
            made = estimate(measurement.hits, "h1", decay)
            responses = made.responses
            used = ", ".join(
                f"{count} hits at {entry.reference.label}"
                for entry, count in zip(measurement.hits, made.used, strict=True)
            )
            notes.append(f"{path}: {used}" + (f", window of {1.0 / decay:.3g} s" if decay else ""))
            notes += [f"{path}: hit {one.hit} left out: {one.reason}, {one.detail}" for one in made.rejected]
    if responses is None:
        raise InputError(f"{path}: has coherences only; allowed: frequency responses, or hits")
    if speed is None:
        raise InputError(
            f'--measured: got {path} without a speed; allowed: --measured {path} "1500 rpm", "0 rpm" at rest'
        )
    found, said = responses_of(path, responses, speed, scene, reading)
    return [found], [*notes, *said]


def responses_of(
    path: Path, responses: Responses, speed: float, scene: Scene, reading: Reading
) -> tuple[MeasuredResponses, list[str]]:
    """Responses as those of sensors and inputs of a scene, and what is to be said of them.

    Parameters
    ----------
    path : Path
        Name of the measurement, for messages.
    responses : Responses
        Responses of a file, or what `mbs.modal.estimation.estimate` makes of hits.
    speed : float
        Speed of the system [rad/s].
    scene : Scene
        Sensors and inputs.
    reading : Reading
        Choices of how it is read.

    Raises
    ------
    InputError
        With every problem.
    """
    problems = Problems()
    notes: list[str] = []
    low, high = reading.band
    responses = responses.within(low, high)
    sensors = {one.name: one for one in scene.sensors}
    inputs = {one.name: one for one in scene.inputs}
    rows, columns, signs = [], [], []
    for k, (sensor_channel, input_channel) in enumerate(responses.pairs):
        with problems:
            sensor = _matched(sensor_channel, sensors, "sensor", reading, path)
            entry = _matched(input_channel, inputs, "input", reading, path)
            sign = _sign(sensor_channel, sensor.direction, path) * _sign(input_channel, entry.direction, path)
            if sensor_channel.quantity in _QUANTITIES.values():
                sensor = dataclasses.replace(sensor, quantity=cast("Quantity", sensor_channel.quantity))
            rows.append((sensor, entry))
            columns.append(k)
            signs.append(sign)
    problems.check()
    response = np.asarray(responses.response[columns].T * np.array(signs))
    coherence = responses.coherence[columns].T
    count = responses.hits or reading.averages or 0
    known = np.isfinite(coherence) & (count >= _LEAST_HITS)
    deviation = np.where(known, noise_of(response, coherence, count), assumed_deviation(response))
    if not np.any(known):
        notes.append(f"{path}: no coherence, or averages not known: 2 % of each value and 1 % of its median assumed")
    deviation = np.where(np.abs(response) > 0.0, deviation, np.inf)
    found = MeasuredResponses(path.name, speed, responses.frequency, response, deviation, tuple(rows), responses.decay)
    left = int(np.count_nonzero(found.deviation < POOREST))
    if left < found.deviation.size:
        notes.append(f"{path}: {left} of {found.deviation.size} values used, the others are in their noise")
    if not left:
        raise InputError(
            f"{path}: all its lines are in their noise; allowed: responses with coherence; average more hits"
        )
    return found, notes


_There = TypeVar("_There", Sensor, Input)


def _matched(channel: Channel, there: Mapping[str, _There], what: str, reading: Reading, path: Path) -> _There:
    """Sensor or input of a scene by the name of a channel."""
    name = reading.names.get(channel.name, channel.name)
    if name in there:
        return there[name]
    lower = {own.lower(): own for own in there}
    if name.lower() in lower:
        return there[lower[name.lower()]]
    raise InputError(
        f"{path}: no {what} is called {name!r:.60}{closest(name, tuple(there))}; allowed: {', '.join(there) or 'none'}"
        f", or --channel '{name or 'NAME'}={what.upper()}'"
    )


def _sign(channel: Channel, direction: FloatArray, path: Path) -> float:
    """Sign of a channel along the direction of a sensor or an input; one whose axis is not known has that."""
    axis = abs(channel.direction) - 1
    if axis < 0:
        return 1.0
    part = float(direction[axis])
    if part == 0.0:
        raise InputError(
            f"{path}: {channel.label} is measured along another axis than {channel.name} of the scene has; allowed: "
            "the same one; state another sensor by --channel"
        )
    return float(np.sign(part)) * (1.0 if channel.direction > 0 else -1.0)


def _unit(text: str, path: Path) -> tuple[str, float]:
    """Quantity of a sensor by the unit of its response, and the factor to SI."""
    over, _, per = text.strip().rpartition("/")
    for unit, name in _QUANTITIES.items():
        try:
            return name, quantity(f"1 {over}", unit) / quantity(f"1 {per}", "N")
        except InputError:
            continue
    raise InputError(f"{path}: got the unit {text!r:.40}; allowed: such as m/s2/N, m/s/N, um/N")


def _from_table(path: Path, titles: Sequence[tuple[str, str]], values: FloatArray, averages: int | None) -> Responses:
    """Responses of a table."""
    problems = Problems()
    axis = [k for k, (name, _) in enumerate(titles) if name.strip().lower() == "frequency"]
    if len(axis) != 1:
        raise InputError(f"{path}: got {len(axis)} columns of a frequency; allowed: one, as in {EXAMPLE}")
    frequency = values[:, axis[0]] * quantity(f"1 {titles[axis[0]][1]}", "Hz")
    parts: dict[tuple[str, str], dict[str, FloatArray]] = {}
    kinds: dict[tuple[str, str], str] = {}
    for k, (name, unit) in enumerate(titles):
        if k == axis[0]:
            continue
        title = _ROW.fullmatch(name.strip())
        if title is None:
            problems.append(f"{path}, column {k + 1}: got {name!r:.60}; allowed: SENSOR/INPUT real, imag or coherence")
            continue
        key = title["sensor"], title["input"]
        with problems:
            factor = 1.0
            if title["part"] != "coherence":
                kinds[key], factor = _unit(unit, path)
            parts.setdefault(key, {})[title["part"]] = factor * values[:, k]
    for key, own in parts.items():
        if not {"real", "imag"} <= set(own):
            problems.append(
                f"{path}: {'/'.join(key)} has {', '.join(own)}; allowed: real and imag, with coherence or not"
            )
    problems.check()
    if not parts:
        raise InputError(f"{path}: has no responses; allowed: {EXAMPLE}")
    none = np.full(frequency.size, np.nan)
    return Responses(
        frequency,
        np.stack([own["real"] + 1j * own["imag"] for own in parts.values()]),
        np.stack([own.get("coherence", none) for own in parts.values()]),
        tuple(
            (Channel(sensor, 0, 0, kinds[sensor, entry]), Channel(entry, 0, 0, "force"))  # type: ignore[arg-type]
            for sensor, entry in parts
        ),
        averages or 0,
    )


def _modes(
    path: Path,
    titles: Sequence[tuple[str, str]],
    values: FloatArray,
    speed: float | None,
    scene: Scene,
    reading: Reading,
) -> tuple[list[Measured], list[str]]:
    """Modes of a table, by speed."""
    places = {name.strip().lower(): k for k, (name, _) in enumerate(titles)}

    def column(name: str, unit: str, otherwise: Callable[[], FloatArray]) -> FloatArray:
        if name not in places:
            return otherwise()
        given = titles[places[name]][1].strip()
        factor = 1.0 if unit == "1" else quantity(f"1 {given}", unit)
        return np.asarray((0.01 if given == "%" else factor) * values[:, places[name]])

    if "frequency" not in places:
        raise InputError(f"{path}: has no column of a frequency; allowed: speed [rpm],frequency [Hz],damping ratio [1]")
    count = values.shape[0]
    frequency = column("frequency", "Hz", lambda: np.empty(0))
    ratio = column("damping ratio", "1", lambda: np.full(count, np.nan))
    wide = column("frequency deviation", "Hz", lambda: FREQUENCY_DEVIATION * frequency)
    damped = column("damping ratio deviation", "1", lambda: DAMPING_DEVIATION * ratio)
    if speed is None and "speed" not in places:
        raise InputError(f"{path}: has no speeds; allowed: a column speed [rpm], or a speed behind the file")
    speeds = column("speed", "rad/s", lambda: np.full(count, float(speed or 0.0)))
    with np.errstate(invalid="ignore"):
        wrong = ~(np.isfinite(frequency) & (frequency > 0.0) & (wide > 0.0) & np.isfinite(speeds)) | (ratio <= 0.0)
    if np.any(wrong):
        row = int(np.flatnonzero(wrong)[0]) + 1
        raise InputError(f"{path}, row {row}: got numbers of a mode that are not finite and above 0")
    sensors = {one.name: one for one in scene.sensors}
    shaped: dict[str, ComplexArray] = {}
    for name, _ in titles:
        title = _SHAPE.fullmatch(name.strip())
        if title and (own := reading.names.get(title["sensor"], title["sensor"])) in sensors:
            turn = 1.0 if title["part"] == "real" else 1j
            shaped[own] = shaped.get(own, np.zeros(count, complex)) + turn * values[:, places[name.strip().lower()]]
    shapes = np.stack(list(shaped.values()), axis=1) if shaped else None
    low, high = reading.band
    found: list[Measured] = []
    for at in np.unique(speeds):
        rows = np.flatnonzero((speeds == at) & (frequency >= low) & (frequency <= high))
        rows = rows[np.argsort(frequency[rows])]
        if rows.size:
            found.append(
                MeasuredModes(
                    path.name,
                    float(at),
                    frequency[rows],
                    wide[rows],
                    ratio[rows],
                    damped[rows],
                    None if shapes is None else shapes[rows],
                    tuple(sensors[name] for name in shaped),
                )
            )
    said = [] if shapes is not None else [f"{path}: modes without shapes are paired by their frequencies"]
    return found, said
