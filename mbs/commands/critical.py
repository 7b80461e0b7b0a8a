"""`mbs critical`: critical speeds, and the response to unbalances and orders over speed, with each law."""

from __future__ import annotations

import argparse
import dataclasses
import math
from typing import NamedTuple

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import Problems
from ehdmaps.units import MOTIONS, RPM, written
from mbs.analyses.case import Case
from mbs.analyses.operating import operating
from mbs.analyses.reach import axes_outside, fade_lines, outside_lines, sources_of
from mbs.analyses.soundness import Judged
from mbs.analyses.sweep import CriticalResult, SweepSettings, critical_of, critical_plot, dataset_of_laws
from mbs.commands.auto import analysed
from mbs.commands.cases import load_cases
from mbs.commands.common import Looked, read_cage_angles, with_bands, write
from mbs.commands.lsa import MOST_COMPARED_CASES
from mbs.commands.sweep import read_speeds
from mbs.linearised.critical import CriticalSpeed, orders
from mbs.linearised.linear import sensor_unit
from mbs.output.band_text import HEAD, LOPSIDED, about_lines, bounds_text, deserved, term_words
from mbs.output.excitation.table import line_rows
from mbs.output.model_text import clean, heading
from mbs.output.reduction_text import reduction_lines
from mbs.output.sweep_data import orbits, sensed
from mbs.planning.question import over_speeds
from mbs.unknowns.held_open import held_open_of

_HEAD = "critical speeds      order       speed   frequency/Hz   damping ratio   whirl"
_WIDTH = 102
"""Of the rows of that table: the longest words on the whirl are 32 letters."""

_MIXED = 0.1
"""Size of the direction of whirl below which a mode counts as one in a plane."""


def run(arguments: argparse.Namespace) -> tuple[str, int]:
    """Find critical speeds and responses with each law."""
    done = analysed(
        arguments,
        _asked,
        lambda asked: list(
            zip(
                [case.label for case in asked.cases],
                critical_of([case.model for case in asked.cases], asked.settings),
                strict=True,
            )
        ),
        _looks_at,
    )
    found = done.result
    banded = with_bands(arguments, []) and found[0][1].model.scene.has_bearings
    arguments.found = None if found[1:] else found[0][1]  # for `mbs run`, whose report tells of it
    judged = Judged([(label, entry.findings) for label, entry in found])
    lines, outside = [*judged.first, *done.lines], list[str]()
    for label, entry in found:
        outside += [line for line in _outside(entry) if line not in outside]
        lines += _report(entry, label if found[1:] else "", banded)
    if found[1:]:
        lines += _beside(found)
    labels, results = [label for label, _ in found], [entry for _, entry in found]
    banded = banded and not found[1:]
    figure = critical_plot(labels, results, banded) if arguments.plot else None
    dataset = results[0].bounded() if banded else dataset_of_laws(labels, results)
    lines += judged.last + outside + write(arguments, judged.marked(dataset), figure)
    return "\n".join(lines), 1 if outside or judged.status else 0


class _Asked(NamedTuple):
    """Cases that are examined, and the speeds."""

    cases: list[Case]
    settings: SweepSettings


def _asked(arguments: argparse.Namespace) -> _Asked:
    """A case for each law, map, kind of films, oil supply and clearance, and the speeds; all problems at once."""
    problems = Problems()
    settings, cases = SweepSettings(), list[Case]()
    with problems:
        settings = SweepSettings(read_speeds(arguments.speed) if arguments.speed else None)
    with_bands(arguments, problems)
    settings = dataclasses.replace(settings, cage_angles=read_cage_angles(arguments, problems))
    with problems:
        cases = load_cases(arguments, most=MOST_COMPARED_CASES)
    problems.check()
    scene = cases[0].model.scene
    return _Asked(cases, dataclasses.replace(settings, besides=(*scene.operating_range, abs(scene.speed))))


def _outside(found: CriticalResult) -> list[str]:
    """Lines on bearings that lie outside their map at some speeds."""
    model = found.model
    fastest = float(np.abs(found.speeds).max())
    words = f"lies outside the map at {{}} of {found.sweep.speeds.size} speeds"
    axes = axes_outside(operating(model, fastest), fastest)
    return outside_lines(found.outside, words, axes, sources=sources_of(model))


def _report(found: CriticalResult, label: str, banded: bool) -> list[str]:
    """Lines of one law; its label is empty if it is the only one, else critical speeds come in a table of all."""
    model, swept = found.model, found.sweep.speeds
    more = np.setdiff1d(found.speeds, swept).size
    return [
        *heading(model),
        *([f"  case: {label}"] if label else []),
        f"  {swept.size} speeds from {_rpm(swept[0])} to {_rpm(np.abs(swept).max())}, {more} more around critical ones "
        "and of operation",
        *([] if label else _critical(found, banded)),
        *_responses(found, banded and not label),
        *line_rows(found.lines, model.scene.sensors),
        *_reduction(found),
        *fade_lines(model, swept),
    ]


def _reduction(found: CriticalResult) -> list[str]:
    """Lines on what the reduction of bodies leaves out of the critical modes, by the modes up to their frequencies."""
    damped = found.sweep.damped
    highest = max((entry.eigenvalue.imag / (2.0 * math.pi) for entry in found.found), default=0.0)
    seen = np.where(damped.frequency <= highest, damped.frequency, np.nan)
    return reduction_lines(found.model.system, seen, damped.damping_ratio, damped.reduction)


def _beside(found: list[tuple[str, CriticalResult]]) -> list[str]:
    """A table of the critical speeds of all laws, for each order in rising speed."""
    rows = [(entry, label) for label, result in found for entry in result.found]
    if not rows:
        return _critical(found[0][1], False)
    rows.sort(key=lambda row: (row[0].order, row[0].speed))
    none = [f"  none of {label}" for label, result in found if not result.found]
    return [f"{_HEAD:{_WIDTH}}   law", *(f"{_row(entry):{_WIDTH}}   {label}" for entry, label in rows), *none]


def _looks_at(asked: _Asked) -> Looked:
    """The scene with the speeds, and the highest frequency of an order."""
    model = asked.cases[0].model
    speeds = asked.settings.speeds or model.scene.sweep
    end = 0.0 if speeds is None else speeds.end
    highest = max(orders(model.system), default=1.0) * end / (2.0 * math.pi)
    return Looked(over_speeds(model.scene, speeds), highest)


def _critical(result: CriticalResult, banded: bool) -> list[str]:
    """A table of the critical speeds, and one of their bands."""
    tried = ", ".join(f"{order:.4g}" for order in orders(result.model.system))
    if not result.found:
        return [f"no critical speed for order {tried}"]
    bands = (
        [_band_row(entry, bounds) for entry, bounds in zip(result.found, result.bounds, strict=True)] if banded else []
    )
    if bands:
        bands = [
            f"  {HEAD:36s} speed                  damping ratio",
            *bands,
            *about_lines(result.model.scene, held_open_of(result.model), result.bands.told),
        ]
    return [_HEAD, *map(_row, result.found), *bands]


def _band_row(entry: CriticalSpeed, bounds: FloatArray) -> str:
    """Line of the bounds of a critical speed."""
    words = []
    for value, bound in ((RPM.value(entry.speed), RPM.value(1.0) * bounds[:2]), (entry.damping_ratio, bounds[2:])):
        fall, rise = value - float(bound[0]), float(bound[1]) - value
        side = max(min(fall, rise), LOPSIDED * max(fall, rise))
        known = math.isfinite(side)
        words.append(f"{deserved(value - fall, side)} to {deserved(value + rise, side)}" if known else "-")
    return f"  mode {entry.mode + 1:4d} {entry.order:14.4g} {'':11s} {words[0] + ' rpm':22s} {words[1]}"


def _row(entry: CriticalSpeed) -> str:
    """Line of a critical speed."""
    frequency, damping_ratio = entry.eigenvalue.imag / (2.0 * math.pi), clean(entry.damping_ratio)
    return (
        f"  mode {entry.mode + 1:4d} {entry.order:14.4g} {_rpm(entry.speed):>13} {frequency:12.5g} "
        f"{damping_ratio:15.3g}   {_whirl_words(entry.whirl)}"
    )


def _rpm(speed: float) -> str:
    """A speed [rad/s] in words, with the digits that a critical speed is known by."""
    return f"{written(RPM.value(float(speed)), 5)} rpm"


def _whirl_words(whirl: float) -> str:
    """Direction of whirl in words."""
    if not math.isfinite(whirl):
        return "none: along or about the axis"
    if abs(whirl) < _MIXED:
        return "in a plane"
    return f"{'forward' if whirl > 0.0 else 'backward'} ({whirl:+.2f})"


def _responses(result: CriticalResult, banded: bool) -> list[str]:
    """Largest responses of each order: orbits, sensors, forces of elements, with their bands."""
    lines = []
    system, sensors = result.model.system, result.model.scene.sensors
    bands = result.largest if banded else {}

    def reach(name: str, place: tuple[int, int], factor: float) -> str:
        """Words on the band of a response, and on what decides it."""
        own = bands.get(name)
        if own is None or not own.value[place]:
            return ""
        one = own.of(place).scaled(factor).of(None)
        return f"; {bounds_text(one, 0)}, decided by {term_words(one.largest(0)) or 'nothing'}"

    if bands and result.responses:
        lines.append(f"  beside largest responses {HEAD}, in their units")
    for row, response in enumerate(result.responses):
        lines.append(f"order {response.order:.4g} ({', '.join(response.names)}), largest over the speeds:")
        places, axes = orbits(system, response)
        for index, place in enumerate(places):
            worst = int(np.argmax(axes[:, index, 0]))
            lines.append(
                f"  orbit of {place}: {axes[worst, index, 0] * 1e6:.4g} by {abs(axes[worst, index, 1]) * 1e6:.4g} um "
                f"(semi-axes) at {_rpm(result.speeds[worst])}{reach('orbit_largest', (row, index), 1e6)}"
            )
        seen = np.abs(sensed(system, sensors, result.speeds, response))
        for index, sensor in enumerate(sensors):
            worst = int(np.argmax(seen[:, index]))
            shown = MOTIONS[sensor_unit(sensor)]
            lines.append(
                f"  sensor {sensor.name}: {shown.text(seen[worst, index])} at {_rpm(result.speeds[worst])}"
                f"{reach('response_largest', (row, index), shown.factor)}"
            )
        for index, connected in enumerate(system.elements):
            force = result.dataset["element_force"].sel(order=response.order).values[:, index]
            worst = int(np.argmax(force))
            if force[worst] > 0.0:
                lines.append(
                    f"  force of {connected.element.name}: {written(force[worst])} N at {_rpm(result.speeds[worst])}"
                    f"{reach('element_force_largest', (row, index), 1.0)}"
                )
    return lines
