"""`mbs critical`: critical speeds, and the response to unbalances and orders over speed."""

from __future__ import annotations

import argparse
import dataclasses
import math

import numpy as np

from ehdmaps.errors import InputError
from ehdmaps.units import RPM
from mbs.analyses.critical import CriticalResult, critical, orders
from mbs.analyses.operating import operating
from mbs.analyses.reach import axes_outside, sources_of
from mbs.analyses.sweep import SweepSettings
from mbs.commands.auto import Looked, analysed
from mbs.commands.cases import load_model
from mbs.commands.common import heading, write
from mbs.commands.reach import fade_lines, outside_lines
from mbs.commands.sweep import read_speeds
from mbs.linearised.linear import sensor_unit
from mbs.output.critical_data import orbits, sensed
from mbs.output.critical_plot import critical_figure
from mbs.scene.assembly import Model

_MIXED = 0.1
"""Size of the direction of whirl below which a mode counts as one in a plane."""


def run(arguments: argparse.Namespace) -> tuple[str, int]:
    """Find critical speeds and responses."""
    done = analysed(arguments, _asked, lambda asked: critical(*asked), _looks_at)
    result = done.result
    model = result.model
    fastest = float(np.abs(result.speeds).max())
    words = f"lies outside the map at {{}} of {result.sweep.speeds.size} speeds"
    outside = outside_lines(
        result.outside, words, axes_outside(operating(model, fastest), fastest), sources=sources_of(model)
    )
    lines = [
        *done.lines,
        *heading(model),
        f"  {result.sweep.speeds.size} speeds from {_rpm(result.speeds[0])} to {_rpm(fastest)}, "
        f"{result.speeds.size - result.sweep.speeds.size} more around critical ones",
        *_critical(result),
        *_responses(result),
        *_lifting(result),
        *fade_lines(model, result.sweep.speeds),
    ]
    figure = None
    if arguments.plot:
        figure = critical_figure(
            model, result.sweep, result.found, result.speeds, result.responses, orders(model.system)
        )
    lines += outside + write(arguments, result.dataset, figure)
    return "\n".join(lines), 1 if outside else done.status


def _asked(arguments: argparse.Namespace) -> tuple[Model, SweepSettings]:
    """The model and the speeds; all problems at once."""
    problems: list[str] = []
    settings, model = SweepSettings(), None
    try:
        settings = SweepSettings(read_speeds(arguments.speeds) if arguments.speeds else None)
    except InputError as error:
        problems += error.problems
    try:
        model = load_model(arguments)
    except InputError as error:
        problems += error.problems
    if problems or model is None:
        raise InputError(problems)
    return model, settings


def _looks_at(asked: tuple[Model, SweepSettings]) -> Looked:
    """The scene with the speeds, and the highest frequency of an order."""
    model, settings = asked
    speeds = settings.speeds or model.scene.sweep
    end = 0.0 if speeds is None else speeds.end
    highest = max(orders(model.system), default=1.0) * end / (2.0 * math.pi)
    return Looked(dataclasses.replace(model.scene, sweep=speeds), highest)


def _critical(result: CriticalResult) -> list[str]:
    """A table of the critical speeds."""
    tried = ", ".join(f"{order:.4g}" for order in orders(result.model.system))
    if not result.found:
        return [f"no critical speed for order {tried}"]
    lines = ["critical speeds      order       speed   frequency/Hz   damping ratio   whirl"]
    for entry in result.found:
        lines.append(
            f"  mode {entry.mode + 1:4d} {entry.order:14.4g} {_rpm(entry.speed):>13} "
            f"{entry.eigenvalue.imag / (2.0 * math.pi):12.5g} {entry.damping_ratio:15.3g}   {_whirl_words(entry.whirl)}"
        )
    return lines


def _rpm(speed: float) -> str:
    """A speed [rad/s] in words, with the digits that a critical speed is known by."""
    return f"{RPM.value(float(speed)):.5g} rpm"


def _whirl_words(whirl: float) -> str:
    """Direction of whirl in words."""
    if not math.isfinite(whirl):
        return "none: along or about the axis"
    if abs(whirl) < _MIXED:
        return "in a plane"
    return f"{'forward' if whirl > 0.0 else 'backward'} ({whirl:+.2f})"


def _responses(result: CriticalResult) -> list[str]:
    """Largest responses of each order: orbits, sensors, forces of elements."""
    lines = []
    system, sensors = result.model.system, result.model.scene.sensors
    for response in result.responses:
        lines.append(f"order {response.order:.4g} ({', '.join(response.names)}), largest over the speeds:")
        places, axes = orbits(system, response)
        for index, place in enumerate(places):
            worst = int(np.argmax(axes[:, index, 0]))
            lines.append(
                f"  orbit of {place}: {axes[worst, index, 0] * 1e6:.4g} by {abs(axes[worst, index, 1]) * 1e6:.4g} um "
                f"(semi-axes) at {_rpm(result.speeds[worst])}"
            )
        seen = np.abs(sensed(system, sensors, result.speeds, response))
        for index, sensor in enumerate(sensors):
            worst = int(np.argmax(seen[:, index]))
            lines.append(
                f"  sensor {sensor.name}: {seen[worst, index]:.4g} {sensor_unit(sensor)} at "
                f"{_rpm(result.speeds[worst])}"
            )
        for index, connected in enumerate(system.elements):
            force = result.dataset["element_force"].sel(order=response.order).values[:, index]
            worst = int(np.argmax(force))
            if force[worst] > 0.0:
                lines.append(
                    f"  force of {connected.element.name}: {force[worst]:.4g} N at {_rpm(result.speeds[worst])}"
                )
    return lines


def _lifting(result: CriticalResult) -> list[str]:
    """Warnings of bearings whose dynamic force is above the static one, so that contacts lift off."""
    lines = []
    for index, bearing in enumerate(result.model.bearings):
        static = np.hypot(*result.sweep.forces[index][:, 1:3].T)
        at_rest = np.interp(result.speeds, result.sweep.speeds, static)
        for response in result.responses:
            force = result.dataset["element_force"].sel(order=response.order, element=bearing.name).values
            if np.any(force > at_rest):
                first = int(np.argmax(force > at_rest))
                lines.append(
                    f"warning: {bearing.name}: the force of order {response.order:.4g} is above the static one of "
                    f"{at_rest[first]:.4g} N from {_rpm(result.speeds[first])} on, where contacts lift off: small "
                    "motions no more; see mbs runup"
                )
    return lines
