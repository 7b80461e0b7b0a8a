"""Parts of a shaft: cylinders and cones that bend, rigid discs, how they fit together, and where its nodes are."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations, pairwise

import numpy as np

from ehdmaps.errors import InputError, Problems
from ehdmaps.physics.solids import STEEL
from mbs.flexible.beam import CrossSection, element_length, wave_length
from mbs.flexible.taper import Along
from mbs.model.body import FREEDOMS, Inertia

FARTHEST = 1e4
"""Places and diameters of shafts are within this [m]."""

TOGETHER = 1e-6
"""Places closer than this are one [m]."""

MOST_PARTS = 400
"""Sections, discs or frames of one shaft."""

GROUPS = (("x",), ("theta_x",), ("y", "theta_z"), ("z", "theta_y"))
"""Freedoms that a straight shaft at rest couples; each group is kept as a whole, or held."""


@dataclass(frozen=True)
class Section:
    """A hollow cylinder or cone of a shaft. Sections may lie one upon the other, as a ring that is pressed on.

    Attributes
    ----------
    begin, end : float
        Distances along x from the position of the shaft [m].
    diameter, bore : float
        Diameters at `begin`, 0 <= bore < diameter [m].
    youngs_modulus : float
        [Pa]; 0 of a layer that has mass and does not stiffen what it lies upon.
    poisson_ratio : float
        -1 < nu < 0.5.
    density : float
        [kg/m3].
    end_diameter, end_bore : float or None
        Diameters at `end` of a cone, 0 <= bore < diameter [m]; None: the same as at `begin`.

    Raises
    ------
    InputError
        With all values that no cylinder has.
    """

    begin: float
    end: float
    diameter: float
    bore: float = 0.0
    youngs_modulus: float = STEEL.youngs_modulus
    poisson_ratio: float = STEEL.poisson_ratio
    density: float = STEEL.density
    end_diameter: float | None = None
    end_bore: float | None = None

    def __post_init__(self) -> None:
        problems = Problems(
            f"section, {name}: got {value!r} {unit}; allowed: {low:g} to {high:g} {unit}"
            for name, value, unit, low, high in (
                ("begin", self.begin, "m", -FARTHEST, FARTHEST),
                ("end", self.end, "m", -FARTHEST, FARTHEST),
                ("diameter", self.diameter, "m", 1e-6, FARTHEST),
                ("end_diameter", self.last_diameter, "m", 1e-6, FARTHEST),
                ("youngs_modulus", self.youngs_modulus, "Pa", 0.0, 1e15),
                ("density", self.density, "kg/m3", 1e-6, 1e6),
            )
            if not low <= value <= high
        )
        if self.end - self.begin <= TOGETHER:
            problems.append(
                f"section, end: got {self.end!r} m, begin {self.begin!r} m; allowed: end > begin, by more than "
                f"{TOGETHER:g} m"
            )
        problems += [
            f"section, {end}bore: got {bore!r} m, {end}diameter {diameter!r} m; allowed: 0 <= bore < diameter"
            for end, bore, diameter in (
                ("", self.bore, self.diameter),
                ("end_", self.last_bore, self.last_diameter),
            )
            if not 0.0 <= bore < diameter and (end == "" or self.tapered)
        ]
        if not -1.0 < self.poisson_ratio < 0.5:
            problems.append(f"section, poisson_ratio: got {self.poisson_ratio!r}; allowed: -1 < nu < 0.5")
        problems.check()

    @property
    def last_diameter(self) -> float:
        """Outer diameter at `end` [m]."""
        return self.diameter if self.end_diameter is None else self.end_diameter

    @property
    def last_bore(self) -> float:
        """Bore at `end` [m]."""
        return self.bore if self.end_bore is None else self.end_bore

    @property
    def tapered(self) -> bool:
        """Tell whether diameter or bore change along it."""
        return (self.diameter, self.bore) != (self.last_diameter, self.last_bore)

    @property
    def mass(self) -> float:
        """[kg]."""
        outer, inner = (
            one**2 + one * other + other**2
            for one, other in ((self.diameter, self.last_diameter), (self.bore, self.last_bore))
        )
        return self.density * math.pi / 12.0 * (outer - inner) * (self.end - self.begin)

    def diameters(self, place: float) -> tuple[float, float]:
        """Outer diameter and bore at a place along x [m]."""
        part = (place - self.begin) / (self.end - self.begin)
        return (
            self.diameter + part * (self.last_diameter - self.diameter),
            self.bore + part * (self.last_bore - self.bore),
        )

    def at(self, place: float) -> CrossSection:
        """Properties that it has per length at a place along x [m]."""
        diameter, bore = self.diameters(place) if self.tapered else (self.diameter, self.bore)
        return CrossSection.annulus(diameter, bore, self.youngs_modulus, self.poisson_ratio, self.density)


@dataclass(frozen=True)
class Disc:
    """A rigid part on a shaft, fixed to its axis at one place; it has mass and does not stiffen the shaft.

    Attributes
    ----------
    position : float
        Distance along x from the position of the shaft [m].
    inertia : Inertia
        Mass and moments of inertia; the offset is that of the centre of mass from `position`.
    """

    position: float
    inertia: Inertia


def misfits(
    sections: Sequence[Section], discs: Sequence[Disc], freedoms: Sequence[str], frames: Mapping[str, float]
) -> list[str]:
    """Everything about the parts of a shaft that does not fit together, in words.

    Parameters
    ----------
    sections, discs : sequence
        Parts of the shaft.
    freedoms : sequence of str
        Those that are kept.
    frames : mapping of str to float
        Places along x [m].
    """
    problems = list(_freedoms(freedoms))
    if not frames:
        problems.append("frames: got none; allowed: at least one place on the axis, such as a bearing's")
    problems += [f"frames: got the name {key!r}; allowed: a short text" for key in frames if not key]
    for kind, count, fewest in (("sections", len(sections), 1), ("discs", len(discs), 0), ("frames", len(frames), 0)):
        if not fewest <= count <= MOST_PARTS:
            problems.append(f"{kind}: got {count}; allowed: {fewest} to {MOST_PARTS}")
            return problems
    problems += _gaps(sections) or _limp(sections)
    problems += _clashes(sections)
    begin, end = min(section.begin for section in sections), max(section.end for section in sections)
    places = [(f"discs[{index}]", disc.position) for index, disc in enumerate(discs)]
    places += [(f"frames {key}", place) for key, place in frames.items()]
    problems += [
        f"{label}: got x = {place * 1e3:.6g} mm; allowed: {begin * 1e3:.6g} to {end * 1e3:.6g} mm, on the sections"
        for label, place in places
        if not begin - TOGETHER <= place <= end + TOGETHER
    ]
    return problems


def _freedoms(freedoms: Sequence[str]) -> Iterator[str]:
    """Yield what is wrong about the freedoms."""
    for index, freedom in enumerate(freedoms):
        if freedom not in FREEDOMS or freedom in freedoms[:index]:
            yield f"freedoms: got {freedom!r}; allowed: {', '.join(FREEDOMS)}, each once"
    if not freedoms:
        yield f"freedoms: got none; allowed: some of {', '.join(FREEDOMS)}"
    for group in GROUPS:
        there = [freedom for freedom in group if freedom in freedoms]
        if 0 < len(there) < len(group):
            yield f"freedoms: got {there[0]} alone; allowed: {' and '.join(group)} together, as bending needs both"


def _gaps(sections: Sequence[Section]) -> list[str]:
    """Each gap between sections along x."""
    problems = []
    ordered = sorted(sections, key=lambda section: section.begin)
    reached = ordered[0].end
    for section in ordered[1:]:
        if section.begin > reached + TOGETHER:
            problems.append(
                f"sections: nothing from {reached * 1e3:.6g} to {section.begin * 1e3:.6g} mm; allowed: no gap; close "
                "it with a section, or make two shafts"
            )
        reached = max(reached, section.end)
    return problems


def _limp(sections: Sequence[Section]) -> list[str]:
    """The places along x where no section is stiff."""
    stiff = [section for section in sections if section.youngs_modulus > 0.0]
    if not stiff:
        return ["sections: got no youngs_modulus above 0; allowed: one that bends at each place"]
    begin, end = min(section.begin for section in sections), max(section.end for section in sections)
    problems, reached = [], begin
    for section in [*sorted(stiff, key=lambda section: section.begin), None]:
        onward = end if section is None else section.begin
        if onward > reached + TOGETHER:
            problems.append(
                f"sections: nothing that bends from {reached * 1e3:.6g} to {onward * 1e3:.6g} mm; allowed: layers "
                "without stiffness upon one with a youngs_modulus above 0"
            )
        reached = reached if section is None else max(reached, section.end)
    return problems


def _clashes(sections: Sequence[Section]) -> Iterator[str]:
    """Yield each pair of sections that takes up the same space."""
    for (i, one), (j, other) in combinations(enumerate(sections), 2):
        begin, end = max(one.begin, other.begin), min(one.end, other.end)
        if end - begin <= TOGETHER:
            continue
        tapered = one.tapered or other.tapered
        inner, outer = max(
            (_common(one, other, place) for place in np.linspace(begin, end, _LOOKS if tapered else 2).tolist()),
            key=lambda both: both[1] - both[0],
        )
        if outer - inner > TOGETHER:
            yield (
                f"sections[{i}] and sections[{j}]: both fill x = {begin * 1e3:.6g} to {end * 1e3:.6g} mm between "
                f"d = {inner * 1e3:.6g} and {outer * 1e3:.6g} mm; allowed: one in the bore of the other; give the ring "
                "a bore"
            )


def _common(one: Section, other: Section, place: float) -> tuple[float, float]:
    """Inner and outer diameter of what two sections both fill at a place [m]; the inner one is larger if nothing."""
    (diameter, bore), (outer, inner) = one.diameters(place), other.diameters(place)
    return max(bore, inner), min(diameter, outer)


_LOOKS = 33
"""Places along two sections, one of them a cone, at which they are compared."""

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
    problems = Problems(misfits(sections, discs, freedoms, frames))
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
        with problems:
            divide(sections, [*(disc.position for disc in discs), *frames.values()], largest_element, cutoff)
    return problems


def divide(
    sections: Sequence[Section], places: Sequence[float], largest_element: float | None, cutoff: float | None
) -> tuple[list[float], list[CrossSection | Along]]:
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
    sections : list of CrossSection or callable
        What is between each node and the next; where a cone is, its section by the part of the length.

    Raises
    ------
    InputError
        For too many elements, and a cut-off beyond the theory of beams.
    """
    spans = _spans(sections, places)
    if cutoff is not None and all(wave_length(span.at(0.5), cutoff) < span.diameter for span in spans):
        raise InputError(
            f"cutoff: got {cutoff:.6g} Hz, where bending waves are shorter than the diameter all along the shaft; "
            "allowed: where sections stay plane, at waves of a few diameters; lower it"
        )
    nodes = [spans[0].begin]
    elements: list[CrossSection | Along] = []
    for span in spans:
        longest = largest_element or (0.5 * span.diameter if cutoff is None else span.longest(cutoff))
        # A span that is a multiple of the largest element but for round-off is not cut once more.
        wanted = (span.end - span.begin) / longest - 1e-9
        if not len(elements) + wanted <= MOST_ELEMENTS:
            raise InputError(
                f"largest_element: got {longest * 1e3:.4g} mm{'' if largest_element else ' by default'}, which makes "
                f"more than {MOST_ELEMENTS} elements; allowed: up to {MOST_ELEMENTS}; make it longer"
                f"{'' if cutoff is None else ', or lower the cut-off'}"
            )
        count = max(1, math.ceil(wanted))
        nodes += np.linspace(span.begin, span.end, count + 1)[1:].tolist()
        elements += [span.piece(index, count) for index in range(count)]
    return nodes, elements


def longest_element(sections: Sequence[Section], frequency: float) -> float:
    """Longest element that bending waves of a frequency [Hz] allow all along a shaft [m], to `WAVE_ERROR`.

    Parameters
    ----------
    sections : sequence of Section
        Cylinders and cones.
    frequency : float
        [Hz].
    """
    return min(span.longest(frequency) for span in _spans(sections, ()))


def _spans(sections: Sequence[Section], places: Sequence[float]) -> list[_Span]:
    """Spans between all places at which anything begins, ends or sits."""
    marks = sorted([*(place for section in sections for place in (section.begin, section.end)), *places])
    steps = [marks[0]]
    for mark in marks:
        if mark - steps[-1] > TOGETHER:
            steps.append(mark)
    return [_Span.of(sections, begin, end) for begin, end in pairwise(steps)]


@dataclass(frozen=True)
class _Span:
    """Sections between two places along x at which anything begins or ends [m]."""

    sections: Sequence[Section]
    begin: float
    end: float

    @classmethod
    def of(cls, sections: Sequence[Section], begin: float, end: float) -> _Span:
        """The sections that are there."""
        place = 0.5 * (begin + end)
        there = [section for section in sections if section.begin < place < section.end] or [
            # Between two sections that are so close that they count as touching.
            min(sections, key=lambda section: max(section.begin - place, place - section.end))
        ]
        return cls(there, begin, end)

    @property
    def diameter(self) -> float:
        """Outer diameter in the middle [m]."""
        return max(section.diameters(0.5 * (self.begin + self.end))[0] for section in self.sections)

    def at(self, part: float) -> CrossSection:
        """Cross-section at a part of the length, 0 to 1."""
        place = self.begin + part * (self.end - self.begin)
        # A place may lie beyond a section by as much as counts as touching.
        found = [one.at(min(max(place, one.begin), one.end)) for one in self.sections]
        total = found[0]
        for one in found[1:]:
            total += one
        return total

    def longest(self, cutoff: float) -> float:
        """Longest element up to a cut-off [Hz], [m]."""
        tapered = any(section.tapered for section in self.sections)
        return min(element_length(self.at(part), cutoff, WAVE_ERROR) for part in ((0.0, 1.0) if tapered else (0.5,)))

    def piece(self, index: int, count: int) -> CrossSection | Along:
        """One of so many elements."""
        if not any(section.tapered for section in self.sections):
            return self.at(0.5)
        return lambda part: self.at((index + part) / count)
