"""Loads of slices of a roller that know of their neighbours, or do not, by Newton's method."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import AnalysisError
from ehdmaps.physics.approach import half_space, half_space_compliance
from ehdmaps.solids.finite_line import FiniteLine
from ehdmaps.solids.slices import plane_depth
from tests.finite_length.solution import Profile

SliceLaw = Callable[[FloatArray], tuple[FloatArray, FloatArray]]
"""Loads per length and their slopes by approaches."""


_MOST_STEPS = 60
_CLOSE = 1e-11
_TABLE = 600


def coupled_loads(overlap: FloatArray, law: SliceLaw, coupling: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Loads of slices by how far rigid bodies overlap there, and their slopes.

    Newton's method on the part s of the approach that the law takes: s = overlap - C w(s).

    Parameters
    ----------
    overlap : array (n,)
        Overlap of the slices [m]; below zero a gap.
    law : callable
        Load per length [N/m] and its slope [N/m2] by the approach [m].
    coupling : array (n, n)
        The matrix C [m2/N]; zeros for slices on their own.

    Returns
    -------
    load : array (n,)
        w [N/m].
    stiffness : array (n, n)
        dw_i/d overlap_j [N/m2].

    Raises
    ------
    AnalysisError
        If no loads are found: contacts may be wider than the coupling was made for.
    """
    own = overlap.copy()
    identity = np.eye(overlap.size)
    for _ in range(_MOST_STEPS):
        load, slope = law(own)
        step = np.linalg.solve(identity + coupling * slope, overlap - own - coupling @ load)
        own = own + step
        if np.abs(step).max() <= _CLOSE * max(float(np.abs(own).max()), 1e-9):
            load, slope = law(own)
            return load, slope[:, None] * np.linalg.inv(identity + coupling * slope)
    raise AnalysisError(
        f"slice coupling: no loads after {_MOST_STEPS} steps; the contact may be wider than the coupling was made for"
    )


def balanced_loads(
    line: FiniteLine, law: SliceLaw, coupling: FloatArray, profile: Profile, load: float, moment: float = 0.0
) -> tuple[FloatArray, FloatArray, float, float]:
    """Loads of slices under a load and a moment.

    Parameters
    ----------
    line : FiniteLine
        Roller and raceway.
    law, coupling
        What `coupled_loads` takes.
    profile : callable
        P(y) [m].
    load, moment : float
        [N], [N m].

    Returns
    -------
    places, load_per_length : array (n,)
        Middles of the slices [m], loads [N/m].
    approach, tilt : float
        Approach in the middle [m], tilt.

    Raises
    ------
    AnalysisError
        If no balance is found.
    """
    count = len(coupling)
    width = line.length / count
    places = ((np.arange(count) + 0.5) / count - 0.5) * line.length
    depths = profile(places)
    rigid = np.stack([np.ones(count), places / line.length], axis=1)
    wanted = np.array([load, moment / line.length])
    # From an overlap that is surely too deep: loads are convex functions of it.
    motion = np.array([float(np.median(depths)), 0.0])
    while coupled_loads(motion[0] - depths, law, coupling)[0].sum() * width < load:
        motion[0] = 1.5 * motion[0] + 1e-6
    for _ in range(_MOST_STEPS):
        w, stiffness = coupled_loads(rigid @ motion - depths, law, coupling)
        step = np.linalg.solve(width * rigid.T @ stiffness @ rigid, wanted - width * rigid.T @ w)
        motion = motion + step
        if np.abs(step).max() <= _CLOSE * np.abs(motion).max():
            w, _ = coupled_loads(rigid @ motion - depths, law, coupling)
            return places, w, float(motion[0]), float(motion[1]) / line.length
    raise AnalysisError(f"slices: no balance after {_MOST_STEPS} steps; the load may lie outside the roller")


def plane_law(line: FiniteLine) -> SliceLaw:
    """The law `half_space` that belongs to the bodies of a line, as loads by approaches.

    Parameters
    ----------
    line : FiniteLine
        Roller and raceway.
    """
    depth, modulus = plane_depth(line), 1.0 / (math.pi * line.body_compliance)
    # Up to where the contact is as wide as the depth allows.
    widest = math.pi * modulus * depth**2 / (8.0 * line.radius)
    loads = np.concatenate([[0.0], np.geomspace(1e-9 * widest, 0.99 * widest, _TABLE)])
    approaches = half_space(loads, depth, line.radius, modulus)

    def law(approach: FloatArray) -> tuple[FloatArray, FloatArray]:
        loaded = approach > 0.0
        load = np.maximum(np.interp(approach, approaches, loads), loads[1])
        for _ in range(2):  # from the table to round-off
            missing = approach - half_space(load, depth, line.radius, modulus)
            load += missing / half_space_compliance(load, depth, line.radius, modulus)
            load = np.clip(load, loads[1], loads[-1])
        slope = 1.0 / half_space_compliance(load, depth, line.radius, modulus)
        return np.where(loaded, load, 0.0), np.where(loaded, slope, 0.0)

    return law
