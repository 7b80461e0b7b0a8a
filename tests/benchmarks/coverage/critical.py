"""Critical speeds and the largest response to an unbalance of true machines, beside their bands.

The first critical speed of each machine is looked for between parts of the lowest mode; a true machine is solved at the
cage angles where it stands, as `mbs critical --cage-angles 1` does it, with resonances of its own.
"""

from __future__ import annotations

import dataclasses
import math
from typing import NamedTuple

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import AnalysisError
from mbs import Scene, SweepSettings, Unbalance, assemble, critical, modes
from mbs.analyses.sweep import CriticalResult
from mbs.settings import SweepRange
from tests.benchmarks.coverage.draws import drawn

POINTS = 7
"""Speeds of a sweep."""

RANGE = (0.45, 1.7)
"""First and last speed, as parts of that at which the lowest mode meets order 1."""

MOMENT = 2e-5
"""Unbalance at the place of the first input [kg m]."""


class Bounds(NamedTuple):
    """A value with its bounds, shape (1,) each."""

    value: FloatArray
    low: FloatArray
    high: FloatArray


class Measured(NamedTuple):
    """Bounds with what was found of true machines, shape (draws, 1) each.

    Attributes
    ----------
    speed, ratio, response : (Bounds, array)
        First critical speed [rad/s], damping ratio there, and largest amplitude of the first sensor over the speeds.
    """

    speed: tuple[Bounds, FloatArray]
    ratio: tuple[Bounds, FloatArray]
    response: tuple[Bounds, FloatArray]


def measured(scene: Scene, draws: int, seed: int) -> Measured:
    """Find the bands, and true machines.

    Parameters
    ----------
    scene : Scene
        The machine as it is stated.
    draws : int
        How many true machines.
    seed : int
        Of the draws.
    """
    place = scene.inputs[0].on
    scene = dataclasses.replace(scene, unbalances=(Unbalance("unbalance", place, MOMENT),))
    model = assemble(scene)
    found = modes(model).modes
    swings = found.frequency[(found.damping_ratio < 0.5) & (found.frequency > 1.0)]
    begin, end = (2.0 * math.pi * float(swings[0]) * part for part in RANGE)
    speeds = SweepRange(begin, end, POINTS)
    known = critical(model, SweepSettings(speeds))
    centre, bounds = _values(known), known.bounds[0]
    own = known.largest["response_largest"].of((0, 0)).of(None)
    random = np.random.default_rng(seed)
    truths = []
    for _ in range(draws):
        try:
            truths.append(_values(critical(assemble(drawn(known.model.scene, random)), SweepSettings(speeds, 1))))
        except AnalysisError:
            truths.append((math.nan, math.nan, math.nan))
    values = np.array(truths)

    return Measured(
        (Bounds(*np.array([[centre[0]], bounds[:1], bounds[1:2]])), values[:, :1]),
        (Bounds(*np.array([[centre[1]], bounds[2:3], bounds[3:]])), values[:, 1:2]),
        (Bounds(own.value, own.low, own.high), values[:, 2:]),
    )


def _values(found: CriticalResult) -> tuple[float, float, float]:
    """First critical speed, its damping ratio, and the largest response; NaN without."""
    first = found.found[0] if found.found else None
    data = found.dataset
    largest = float(np.hypot(data["response_real"], data["response_imaginary"])[0, :, 0].max())
    return (first.speed, first.damping_ratio, largest) if first else (math.nan, math.nan, largest)
