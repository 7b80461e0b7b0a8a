"""`mbs lsa`: state space and frequency responses at the equilibrium."""

from __future__ import annotations

import argparse
import math
from collections.abc import Sequence

import numpy as np
from scipy.signal import find_peaks

from ehdmaps.arrays import ComplexArray, FloatArray
from mbs.analyses.lsa import lsa
from mbs.commands.cases import load_model
from mbs.commands.common import film_lines, heading, outside_at, write
from mbs.commands.reach import fade_lines
from mbs.linearised.linear import response_unit
from mbs.linearised.validity import DynamicLoad
from mbs.output.response_plot import response_figure
from mbs.scene.assembly import Model


def run(arguments: argparse.Namespace) -> tuple[str, int]:
    """Linearise, and compute the responses over the frequencies of the scene."""
    found = lsa(load_model(arguments))
    model, scene, frequencies = found.model, found.model.scene, found.frequencies
    figure = None
    if arguments.plot:
        limit = min((entry.frequency for entry in found.errors), default=math.inf)
        figure = response_figure(model, frequencies, found.responses, limit, _lifting_notes(found.lifting))
    outside = outside_at(model, found.balance)
    amplitudes = {
        entry.name: f"{entry.amplitude:.4g} {'N m' if np.any(entry.direction[3:]) else 'N'}" for entry in scene.inputs
    }
    lines = [
        *heading(model, scene.speed),
        f"state space: {found.space.A.shape[0]} states, {len(scene.inputs)} inputs, {len(scene.sensors)} outputs; "
        f"{found.asked} frequencies, and {frequencies.size - found.asked} more around lightly "
        "damped modes",
        *_peaks(model, frequencies, found.responses),
        *film_lines(found.errors, frequencies),
        *(
            f"warning: {load.element}: {load.dynamic:.3g} N of dynamic load at {load.frequency:.4g} Hz exceed the "
            f"static {load.static:.4g} N (input {load.input} at its amplitude of {amplitudes[load.input]}): contacts "
            "lift off, a linear analysis is not valid there"
            for load in found.lifting
        ),
        *(fade_lines(model, np.array([scene.speed])) if scene.speed else []),
        *outside,
        *write(arguments, found.dataset, figure),
    ]
    return "\n".join(lines), 1 if outside else 0


def _lifting_notes(loads: Sequence[DynamicLoad]) -> list[str]:
    """Notes below the figure on loads that lift off, a line for each frequency and input."""
    names: dict[tuple[str, str], list[str]] = {}
    for load in loads:
        names.setdefault((f"{load.frequency:.4g} Hz", load.input), []).append(load.element)
    return [
        f"contacts lift off near {at} with the amplitude of {entry}, a linear analysis is not valid there: "
        + ", ".join(elements)
        for (at, entry), elements in names.items()
    ]


def _peaks(model: Model, frequencies: FloatArray, responses: ComplexArray) -> list[str]:
    """Lines of the peaks of each response."""
    lines = []
    for s, sensor in enumerate(model.scene.sensors):
        for i, entry in enumerate(model.scene.inputs):
            size = np.abs(responses[:, s, i])
            # A peak stands out of both valleys beside it.
            places, _ = find_peaks(np.log(np.maximum(size, 1e-300)), prominence=0.05)
            shown = [f"{frequencies[k]:.5g} Hz ({size[k]:.3g})" for k in places]
            lines.append(
                f"  {sensor.name} ({sensor.quantity}, {response_unit(sensor, entry)}) by {entry.name}: "
                + (f"peaks at {', '.join(shown)}" if shown else "no peak")
            )
    return lines
