"""Whether the parts of a shaft make one, and where its nodes are: what can be said without any matrix."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from itertools import pairwise

import numpy as np

from ehdmaps.errors import InputError
from mbs.flexible.beam import CrossSection, element_length, wave_length
from mbs.flexible.shaft_parts import TOGETHER, Disc, Section, misfits

CUTOFFS = (1e-3, 1e7)
"""Lowest and highest cut-off [Hz]."""

WAVE_ERROR = 1e-4
"""Relative error of the frequency of bending waves at the cut-off that elements may make; much less below it."""

MOST_ELEMENTS = 400
"""Of one shaft; more would take long and show nothing that a beam can tell."""


def shaft_problems(
    sections: Sequence[Section],
    discs: Sequence[Disc],
    freedoms: Sequence[str],
    position: Sequence[float],
    frames: Mapping[str, float],
    spin: float,
    largest_element: float | None,
    cutoff: float | None,
    damping_ratio: float,
) -> list[str]:
    """Everything about a shaft that does not fit together, in words; parameters as of `flexible_shaft`.

    Parameters
    ----------
    sections, discs : sequence
        Parts of the shaft.
    freedoms : sequence of str
        Freedoms that are kept.
    position : sequence of float, shape (3,)
        [m].
    frames : mapping of str to float
        Places along x [m].
    spin : float
        Spin as a multiple of the speed of the system.
    largest_element : float or None
        [m].
    cutoff : float or None
        [Hz].
    damping_ratio : float
        Damping ratio of the modes.
    """
    problems = misfits(sections, discs, freedoms, frames)
    if not (len(position) == 3 and all(math.isfinite(value) for value in position)):
        problems.append(f"position: got {tuple(position)!r} m; allowed: three finite numbers")
    if not math.isfinite(spin):
        problems.append(f"spin: got {spin!r}; allowed: finite")
    if largest_element is not None and not (math.isfinite(largest_element) and largest_element > 0.0):
        problems.append(f"largest_element: got {largest_element!r} m; allowed: finite and > 0")
    if cutoff is not None and not CUTOFFS[0] <= cutoff <= CUTOFFS[1]:
        problems.append(f"cutoff: got {cutoff!r} Hz; allowed: {CUTOFFS[0]:g} to {CUTOFFS[1]:g} Hz")
    if not (math.isfinite(damping_ratio) and 0.0 <= damping_ratio < 1.0):
        problems.append(f"damping_ratio: got {damping_ratio!r}; allowed: 0 <= ratio < 1")
    if not problems:
        try:
            divide(sections, [*(disc.position for disc in discs), *frames.values()], largest_element, cutoff)
        except InputError as error:
            problems += error.problems
    return problems


def divide(
    sections: Sequence[Section], places: Sequence[float], largest_element: float | None, cutoff: float | None
) -> tuple[list[float], list[CrossSection]]:
    """Divide a shaft into elements: nodes where anything begins, ends or sits, and as many between as are needed.

    Parameters
    ----------
    sections : sequence of Section
        Parts that fit together.
    places : sequence of float
        Further places of nodes [m].
    largest_element : float, optional
        [m].
    cutoff : float, optional
        [Hz].

    Returns
    -------
    nodes : list of float
        Places along x, rising [m].
    sections : list of CrossSection
        What is between each node and the next.

    Raises
    ------
    InputError
        For too many elements, and a cut-off beyond the theory of beams.
    """
    marks = sorted([*(place for section in sections for place in (section.begin, section.end)), *places])
    steps = [marks[0]]
    for mark in marks:
        if mark - steps[-1] > TOGETHER:
            steps.append(mark)
    spans = [_span(sections, 0.5 * (begin + end)) for begin, end in pairwise(steps)]
    if cutoff is not None and all(wave_length(span, cutoff) < diameter for span, diameter in spans):
        raise InputError(
            f"cutoff: got {cutoff:.6g} Hz, where bending waves are shorter than the diameter all along the shaft; "
            "allowed: where sections stay plane, at waves of a few diameters; lower it"
        )
    nodes = [steps[0]]
    elements: list[CrossSection] = []
    for (span, diameter), (begin, end) in zip(spans, pairwise(steps), strict=True):
        longest = largest_element or (0.5 * diameter if cutoff is None else element_length(span, cutoff, WAVE_ERROR))
        # A span that is a multiple of the largest element but for round-off is not cut once more.
        wanted = (end - begin) / longest - 1e-9
        if not len(elements) + wanted <= MOST_ELEMENTS:
            raise InputError(
                f"largest_element: got {longest * 1e3:.4g} mm{'' if largest_element else ' by default'}, which makes "
                f"more than {MOST_ELEMENTS} elements; allowed: up to {MOST_ELEMENTS}; make it longer"
                f"{'' if cutoff is None else ', or lower the cut-off'}"
            )
        count = max(1, math.ceil(wanted))
        nodes += np.linspace(begin, end, count + 1)[1:].tolist()
        elements += [span] * count
    return nodes, elements


def _span(sections: Sequence[Section], place: float) -> tuple[CrossSection, float]:
    """Cross-section and outer diameter [m] at a place along x [m]."""
    there = [section for section in sections if section.begin < place < section.end] or [
        # Between two sections that are so close that they count as touching.
        min(sections, key=lambda section: max(section.begin - place, place - section.end))
    ]
    total = there[0].cross_section
    for section in there[1:]:
        total += section.cross_section
    return total, max(section.diameter for section in there)
