"""`mbs modes`: modes at the operating speed, or over a range of speeds for one or more clearances."""

from __future__ import annotations

import argparse

import numpy as np

from ehdmaps.errors import InputError
from ehdmaps.physics._values import FloatArray
from ehdmaps.units import TEMPERATURE, quantity
from mbs.assembly import Model
from mbs.commands.common import film_limits, film_warnings, heading, load_models, outside_at, write
from mbs.elements import Operation
from mbs.modes import Modes, modes
from mbs.plot import modes_figure, sweep_figure
from mbs.reading.fields import MICROMETRE, RPM
from mbs.results import modes_dataset, sweep_dataset
from mbs.statics import equilibrium
from mbs.sweep import Sweep, sweep
from mbs.validity import HIGHEST_RATIO

MOST_SPEEDS = 2000
_LEAST_SHARE = 0.05


def run(arguments: argparse.Namespace) -> tuple[str, int]:
    """Find the modes."""
    speeds = _speeds(arguments.speeds) if arguments.speeds else None
    models = load_models(arguments)
    if speeds is not None:
        return _over_speed(arguments, models, speeds)
    if len(models) > 1:
        raise InputError(f"--clearance: got {len(models)} of them; allowed: one, or more with --speeds")
    (model,) = models
    balance = equilibrium(model.system, model.operation)
    found = modes(balance)
    figure = modes_figure(model, found) if arguments.plot else None
    outside = outside_at(model, balance)
    lines = [
        *heading(model, model.scene.speed),
        *_table(found),
        *film_warnings(film_limits(model, balance.displacement, balance.operation), found.frequency),
        *outside,
        *write(arguments, model, modes_dataset(found, balance), figure),
    ]
    return "\n".join(lines), 1 if outside else 0


def _table(found: Modes) -> list[str]:
    """Lines of the modes: frequency, damping ratio, and the parts that have most of the strain energy."""
    lines = ["  mode   frequency/Hz   damping ratio   strain energy        (frequency: |eigenvalue|/(2 pi))"]
    for k in range(found.eigenvalues.size):
        order = np.argsort(-found.shares[:, k], kind="stable")
        shares = [
            f"{found.parts[i]} {100.0 * found.shares[i, k]:.3g} %" for i in order if found.shares[i, k] >= _LEAST_SHARE
        ]
        lines.append(
            f"  {k + 1:4d} {found.frequency[k]:14.6g} {found.damping_ratio[k]:15.4g}   {', '.join(shares) or 'none'}"
        )
    return lines


def _over_speed(arguments: argparse.Namespace, models: tuple[Model, ...], speeds: FloatArray) -> tuple[str, int]:
    """Modes over speed for each clearance."""
    sweeps = [sweep(model.system, speeds) for model in models]
    lines = []
    outside: list[str] = []
    for model, result in zip(models, sweeps, strict=True):
        outside += [
            f"warning: {name}: {count} calls outside the map" for name, count in model.outside_calls.items() if count
        ]
        lines += [*heading(model), *_changes(result), *_too_quick(model, result)]
    clearances = [model.scene.bearings[0].geometry.diametral_clearance for model in models]
    labels = [MICROMETRE.text(value) for value in clearances]
    law = f"{models[0].law}; {TEMPERATURE.text(models[0].scene.temperature).replace('deg', '°')}"
    figure = sweep_figure(models[0].scene.title, law, sweeps, labels) if arguments.plot else None
    lines += outside + write(arguments, models[0], sweep_dataset(sweeps, clearances), figure)
    return "\n".join(lines), 1 if outside else 0


def _changes(result: Sweep) -> list[str]:
    """Lines on how the frequencies of modes with strain energy in the bearings change."""
    first, last = RPM.text(float(result.speeds[0])), RPM.text(float(result.speeds[-1]))
    lines = [f"  mode at {first:12s} at {last:12s}   change   strain energy in the bearings at {first}"]
    for k in range(result.frequency.shape[1]):
        share = float(result.bearing_share[0, k])
        if share >= _LEAST_SHARE:
            begin, end = float(result.frequency[0, k]), float(result.frequency[-1, k])
            lines.append(
                f"  {k + 1:4d} {begin:11.5g} Hz {end:12.5g} Hz {100.0 * (end / begin - 1.0):+8.2f} % {share:10.2f}"
            )
    return lines


def _too_quick(model: Model, result: Sweep) -> list[str]:
    """A line for each bearing whose films are too slow for the highest mode, with the worst speed; none at rest."""
    worst: dict[str, tuple[float, float, float]] = {}
    for index, speed in enumerate(result.speeds.tolist()):
        highest = float(result.frequency[index].max())
        for limit in film_limits(model, result.displacement[index], Operation(speed)):
            ratio = limit.ratio(highest)
            if speed > 0.0 and ratio > max(HIGHEST_RATIO, worst.get(limit.bearing, (0.0,))[0]):
                worst[limit.bearing] = ratio, highest, speed
    return [
        f"warning: {name}: omega b/u is up to {ratio:.2g} ({highest:.5g} Hz at {RPM.text(speed)}): above "
        f"{HIGHEST_RATIO} low-frequency stiffness and damping no longer hold"
        for name, (ratio, highest, speed) in worst.items()
    ]


def _speeds(texts: list[str]) -> FloatArray:
    """Read FROM TO POINTS."""
    problems = []
    ends = []
    for text in texts[:2]:
        try:
            ends.append(quantity(text, "rad/s"))
        except InputError as error:
            problems.append(f"--speeds: {error.problems[0]}")
    points = int(texts[2]) if texts[2].isascii() and texts[2].isdigit() and len(texts[2]) < 6 else 0
    if not 2 <= points <= MOST_SPEEDS:
        problems.append(f"--speeds: got {texts[2]!r:.40} points; allowed: a whole number from 2 to {MOST_SPEEDS}")
    if len(ends) == 2 and not 0.0 <= ends[0] < ends[1]:
        problems.append(f"--speeds: got from {texts[0]!r:.40} to {texts[1]!r:.40}; allowed: rising, from 0 rpm on")
    if problems:
        raise InputError(problems)
    return np.linspace(ends[0], ends[1], points)
