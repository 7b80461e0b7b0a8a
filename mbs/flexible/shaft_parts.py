"""What a shaft is made of: cylinders that bend, rigid discs, and whether they fit together."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations

from ehdmaps.errors import InputError
from ehdmaps.physics.solids import STEEL
from mbs.flexible.beam import CrossSection
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
    """A hollow cylinder of a shaft. Sections may lie one upon the other, as a ring that is pressed on.

    Attributes
    ----------
    begin, end : float
        Distances along x from the position of the shaft [m].
    diameter, bore : float
        0 <= bore < diameter [m].
    youngs_modulus : float
        [Pa].
    poisson_ratio : float
        -1 < nu < 0.5.
    density : float
        [kg/m3].

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

    def __post_init__(self) -> None:
        problems = [
            f"section, {name}: got {value!r} {unit}; allowed: {low:g} to {high:g} {unit}"
            for name, value, unit, low, high in (
                ("begin", self.begin, "m", -FARTHEST, FARTHEST),
                ("end", self.end, "m", -FARTHEST, FARTHEST),
                ("diameter", self.diameter, "m", 1e-6, FARTHEST),
                ("youngs_modulus", self.youngs_modulus, "Pa", 1.0, 1e15),
                ("density", self.density, "kg/m3", 1e-6, 1e6),
            )
            if not low <= value <= high
        ]
        if self.end - self.begin <= TOGETHER:
            problems.append(
                f"section, end: got {self.end!r} m, begin {self.begin!r} m; allowed: end > begin, by more than "
                f"{TOGETHER:g} m"
            )
        if not 0.0 <= self.bore < self.diameter:
            problems.append(
                f"section, bore: got {self.bore!r} m, diameter {self.diameter!r} m; allowed: 0 <= bore < diameter"
            )
        if not -1.0 < self.poisson_ratio < 0.5:
            problems.append(f"section, poisson_ratio: got {self.poisson_ratio!r}; allowed: -1 < nu < 0.5")
        if problems:
            raise InputError(problems)

    @property
    def cross_section(self) -> CrossSection:
        """What it has per length."""
        return CrossSection.annulus(self.diameter, self.bore, self.youngs_modulus, self.poisson_ratio, self.density)


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
    problems += _gaps(sections)
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


def _gaps(sections: Sequence[Section]) -> Iterator[str]:
    """Yield each gap between sections along x."""
    ordered = sorted(sections, key=lambda section: section.begin)
    reached = ordered[0].end
    for section in ordered[1:]:
        if section.begin > reached + TOGETHER:
            yield (
                f"sections: nothing from {reached * 1e3:.6g} to {section.begin * 1e3:.6g} mm; allowed: no gap; close "
                "it with a section, or make two shafts"
            )
        reached = max(reached, section.end)


def _clashes(sections: Sequence[Section]) -> Iterator[str]:
    """Yield each pair of sections that takes up the same space."""
    for (i, one), (j, other) in combinations(enumerate(sections), 2):
        begin, end = max(one.begin, other.begin), min(one.end, other.end)
        inner, outer = max(one.bore, other.bore), min(one.diameter, other.diameter)
        if end - begin > TOGETHER and outer - inner > TOGETHER:
            yield (
                f"sections[{i}] and sections[{j}]: both fill x = {begin * 1e3:.6g} to {end * 1e3:.6g} mm between "
                f"d = {inner * 1e3:.6g} and {outer * 1e3:.6g} mm; allowed: one in the bore of the other; give the ring "
                "a bore"
            )
