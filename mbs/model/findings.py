"""Findings about bearings: what lies beyond their laws, with the same cause, words and status for every kind.

A bearing says what its contacts feel, as a `Gauge`, and what only its kind can know. Limits and words that all kinds
have in common are here. How grave a finding is follows from its cause alone. `RingPoint` is one bearing at a load,
with its findings.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace
from enum import Enum
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.physics.surface import HARDNESS
from ehdmaps.units import PRESSURE

if TYPE_CHECKING:
    from mbs.life import ReferenceLife

SIDES = ("inner", "outer")

MEANINGLESS = "the figures below mean nothing: "
"""Begin of the error that a result is unsound; its reasons follow."""

OPEN = 1e-6
"""Largest load of a contact up to which a bearing carries none [N]: films never quite let go."""

CARRIES = 0.01
"""Part of the highest load of a bearing from which on a rolling element carries load: films load all a little."""


class Severity(Enum):
    """Gravity of a finding: the word before it, and the exit status that it asks for."""

    NOTE = ("note", 0)
    WARNING = ("warning", 0)
    BEYOND = ("warning", 1)
    UNSOUND = ("error", 1)

    @property
    def word(self) -> str:
        """The word before it."""
        return str(self.value[0])

    @property
    def status(self) -> int:
        """Exit status."""
        return int(self.value[1])


class Cause(Enum):
    """Kinds of findings."""

    PRESSURE = "pressure that no contact carries"
    ENERGY = "energy of a run"
    OUTSIDE = "most calls of a run outside the map"
    OVERLOAD = "static limit"
    SHOULDER = "shoulder"
    REACH = "outside of what a law holds"
    FAILED = "no answer"
    UNLOADED = "no load"
    LIFT_OFF = "lift-off"
    SLIDING = "gyroscopic sliding"
    SLACK = "too little axial load"
    THROWN = "balls on the outer raceway alone"
    RIB = "axial load of ribs"
    EDGE = "loads at the end of rollers"
    FILM = "films"

    @property
    def severity(self) -> Severity:
        """Gravity of the finding."""
        return _SEVERITY.get(self, Severity.NOTE)


_SEVERITY = MappingProxyType(
    {
        **dict.fromkeys((Cause.PRESSURE, Cause.ENERGY, Cause.OUTSIDE), Severity.UNSOUND),
        **dict.fromkeys((Cause.OVERLOAD, Cause.SHOULDER, Cause.REACH, Cause.FAILED), Severity.BEYOND),
        **dict.fromkeys((Cause.UNLOADED, Cause.LIFT_OFF), Severity.WARNING),
    }
)


@dataclass(frozen=True)
class Finding:
    """One thing that was found about a bearing, or a run.

    Attributes
    ----------
    cause : Cause
        What it is.
    words : str
        The same for people, with what was found and what is allowed.
    bearing : str
        Name of the bearing; empty for what is not about one.
    excess : float
        How far it is beyond its limit, as a part of it: by this the worst of several is known.
    """

    cause: Cause
    words: str
    bearing: str = ""
    excess: float = 1.0

    @property
    def severity(self) -> Severity:
        """Gravity of the finding."""
        return self.cause.severity

    @property
    def told(self) -> str:
        """The words with the name of the bearing."""
        return f"{self.bearing}: {self.words}" if self.bearing else self.words


class Gauge(NamedTuple):
    """Loads and pressures of the contacts of a bearing at rest, and findings of its own.

    Attributes
    ----------
    element : str
        Kind of its rolling elements: ball, roller.
    load : array (2, Z)
        Loads of the inner and the outer contact of each [N].
    pressure : array (2,)
        Largest Hertz pressure of the inner and the outer contacts [Pa].
    static_limit : float
        Hertz pressure of its static load rating [Pa].
    own : tuple of Finding
        What only its kind can say.
    """

    element: str
    load: FloatArray
    pressure: FloatArray
    static_limit: float
    own: tuple[Finding, ...] = ()

    @property
    def findings(self) -> tuple[Finding, ...]:
        """Everything that is found, the gravest first."""
        side = int(np.argmax(self.pressure))
        largest, found = float(self.pressure[side]), list[Finding]()
        if largest > HARDNESS:
            words = (
                f"Hertz pressure of {PRESSURE.text(largest)} is above {PRESSURE.text(HARDNESS)}, the hardness of "
                "bearing steel, which no contact carries"
            )
            found.append(Finding(Cause.PRESSURE, words, excess=largest / HARDNESS))
        if largest > self.static_limit:
            words = (
                f"Hertz pressure of {PRESSURE.text(largest)} ({SIDES[side]} raceway) is above "
                f"{PRESSURE.text(self.static_limit)}, the static limit of ISO 76: permanent deformation; elastic "
                "contacts and films no longer hold"
            )
            found.append(Finding(Cause.OVERLOAD, words, excess=largest / self.static_limit))
        if not np.any(self.load[0] > OPEN):
            words = f"no {self.element} carries load: nothing holds the shaft there, preload is lost"
            found.append(Finding(Cause.UNLOADED, words))
        return (*found, *self.own)

    def findings_of(self, bearing: str) -> tuple[Finding, ...]:
        """The findings with the name of a bearing.

        Parameters
        ----------
        bearing : str
            Name of the bearing.
        """
        return tuple(replace(finding, bearing=bearing) for finding in self.findings)


def worst_of(found: Sequence[Iterable[Finding]], places: Sequence[str], kind: str) -> tuple[Finding, ...]:
    """The worst finding of each cause and bearing over several places, with where it is.

    Parameters
    ----------
    found : sequence of iterable of Finding
        Findings at each place.
    places : sequence of str
        The places in words, such as "3000 rpm".
    kind : str
        What the places are, in the plural.
    """
    groups: dict[tuple[str, Cause], list[tuple[Finding, str]]] = {}
    for findings, place in zip(found, places, strict=True):
        for finding in findings:
            groups.setdefault((finding.bearing, finding.cause), []).append((finding, place))
    told = []
    for group in groups.values():
        worst, place = max(group, key=lambda pair: pair[0].excess)
        most = f", here at {place}" if places[1:] else ""
        told.append(replace(worst, words=f"{worst.words} (at {len(group)} of {len(places)} {kind}{most})"))
    return tuple(told)


def is_unsound(found: Iterable[Finding]) -> bool:
    """Tell whether the figures mean nothing.

    Parameters
    ----------
    found : iterable of Finding
        What was found.
    """
    return any(one.severity is Severity.UNSOUND for one in found)


def warned(found: Iterable[Finding]) -> list[str]:
    """Words of all findings that are more than a note, with their bearings.

    Parameters
    ----------
    found : iterable of Finding
        What was found.
    """
    return [one.told for one in found if one.severity is not Severity.NOTE]


class WithFindings:
    """Words of the findings of a point, by how grave they are; to inherit from."""

    findings: tuple[Finding, ...]

    @property
    def unsound(self) -> tuple[str, ...]:
        """Reasons why its figures mean nothing."""
        return _words(self.findings, (Severity.UNSOUND,))

    @property
    def problems(self) -> tuple[str, ...]:
        """Reasons why its laws do not hold there."""
        return _words(self.findings, (Severity.UNSOUND, Severity.BEYOND))

    @property
    def notes(self) -> tuple[str, ...]:
        """Notes on it."""
        return _words(self.findings, (Severity.WARNING, Severity.NOTE))


@dataclass(frozen=True, eq=False, kw_only=True)
class RingPoint(WithFindings):
    """A bearing in equilibrium; kinds inherit from it.

    Attributes
    ----------
    load : array (3,)
        Load on the inner ring, x, y and z [N].
    inner_speed, outer_speed : float
        Speeds of the rings [rad/s].
    elements : RollerLoads, BallLoads or TaperedLoads
        State of its rolling elements.
    pose : array (6,)
        Pose of the inner ring in the outer one [m, rad].
    stiffness, damping : array (6, 6)
        -d force/d pose and -d force/d velocity.
    findings : tuple of Finding
        What is beyond its laws, and what else is to be known.
    film_error : array (2,)
        Stated error of the smallest film of the inner and of the outer raceway, over it; NaN where none is stated.
    failed : bool
        Whether it has no answer: numbers are NaN, and `problems` say why.
    balance : Equilibrium or None
        The equilibrium of the bearing as a system of its own; None where there is none.
    """

    load: FloatArray
    inner_speed: float
    outer_speed: float = 0.0
    elements: Any
    pose: FloatArray
    stiffness: FloatArray
    damping: FloatArray
    findings: tuple[Finding, ...]
    film_error: FloatArray = field(default_factory=lambda: np.full(2, np.nan))
    failed: bool = False
    balance: Any = None

    @property
    def geometry(self) -> Any:
        """Geometry of the bearing."""
        raise NotImplementedError

    @property
    def reference(self) -> ReferenceLife:
        """Equivalent load and life of ISO/TS 16281, by the rating of ISO 281."""
        life: ReferenceLife = self.elements.life(self.geometry, abs(self.inner_speed) >= abs(self.outer_speed))
        return life

    @property
    def loaded(self) -> int:
        """Number of rolling elements that carry more than 1 % of the highest inner load."""
        return int(self.elements.loaded)

    @property
    def size(self) -> float:
        """Size of the radial load [N]."""
        return math.hypot(self.load[1], self.load[2])

    @property
    def axial(self) -> float:
        """Axial load [N]."""
        return float(self.load[0])

    @property
    def axes(self) -> FloatArray:
        """Unit vectors along and across the radial load, (2, 3); along y without one."""
        y, z = (self.load[1:] / self.size) if self.size > 0.0 else (1.0, 0.0)
        return np.array([[0.0, y, z], [0.0, -z, y]])

    def along_across(self, matrix: FloatArray) -> FloatArray:
        """Entries of a matrix (6, 6) along the radial load, across it, and along the axis, (3,)."""
        along, across = self.axes
        part = matrix[:3, :3]
        return np.array([along @ part @ along, across @ part @ across, part[0, 0]])


def _words(found: Iterable[Finding], kinds: tuple[Severity, ...]) -> tuple[str, ...]:
    """Words of the findings of some kinds."""
    return tuple(finding.words for finding in found if finding.severity in kinds)
