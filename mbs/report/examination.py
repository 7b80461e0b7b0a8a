"""Everything that the report of a scene tells: equilibrium, modes, and modes over speed; what fails is told, too."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeVar

from ehdmaps.errors import AnalysisError, InputError
from ehdmaps.trade.record import Trade
from mbs.analyses.modes import ModesResult, modes
from mbs.analyses.statics import StaticsResult, statics
from mbs.analyses.sweep import SweepResult, SweepSettings, sweep
from mbs.budget.sources import error_budget
from mbs.model.findings import Finding
from mbs.scene.assembly import Model
from mbs.scene.map_set import MapSet
from mbs.scene.scene import Scene
from mbs.scene.subject import Subject
from mbs.settings import SweepRange

R = TypeVar("R")

MOST_SPEEDS = 9
"""Speeds of the short sweep: modes are followed between them."""

_BELOW, _ABOVE = 0.25, 1.5
"""Speeds of a scene without [sweep], as parts of its operating speed."""


@dataclass(frozen=True, eq=False)
class Examination:
    """Findings about a scene.

    Attributes
    ----------
    statics : StaticsResult
        Equilibrium of the scene.
    modes : ModesResult or str
        Modes at the equilibrium, or why there are none.
    sweep : SweepResult or str
        Modes over speed, or why there are none.
    maps : MapSet or None
        The maps of its law.
    budget : Trade or str
        Error budget of the machine, or why there is none; empty where it was not looked for.
    banded : bool
        Whether bands of what is not known stand beside modes.
    """

    statics: StaticsResult
    modes: ModesResult | str
    sweep: SweepResult | str
    maps: MapSet | None
    budget: Trade | str = ""
    banded: bool = False

    @property
    def findings(self) -> tuple[Finding, ...]:
        """Findings about the bearings, in operation and over speed."""
        swept = self.sweep.findings[0] if isinstance(self.sweep, SweepResult) else ()
        known = {(one.bearing, one.cause) for one in self.statics.findings}
        return (*self.statics.findings, *(one for one in swept if (one.bearing, one.cause) not in known))

    @property
    def model(self) -> Model:
        """The model in operation."""
        return self.statics.model


def examined(
    model: Model,
    maps: MapSet | None,
    speeds: SweepRange | None,
    swept: bool = True,
    subject: Subject | None = None,
    banded: bool = False,
) -> Examination:
    """Find it.

    Parameters
    ----------
    model : Model
        Scene with its law.
    maps : MapSet or None
        The maps of the law.
    speeds : SweepRange or None
        Speeds of the sweep; a few of [sweep] of the scene, or about its operating speed, if None.
    swept : bool
        Whether there is a sweep at all.
    subject : Subject, optional
        The scene with its law, of which there is an error budget; none if left out.
    banded : bool
        Whether bands of what is not known stand beside modes.

    Raises
    ------
    AnalysisError
        If there is no equilibrium.
    """
    budget: Trade | str = ""
    if subject is not None and model.bearings:
        budget = _or_reason(lambda: error_budget(subject, highest_of(model.scene)))
    return Examination(
        statics(model),
        _or_reason(lambda: modes(model)),
        _or_reason(lambda: _sweep(model, speeds)) if swept else "",
        maps,
        budget,
        banded and model.scene.has_bearings,
    )


def highest_of(scene: Scene) -> float:
    """Highest frequency that matters to a scene [Hz].

    Parameters
    ----------
    scene : Scene
        The scene.
    """
    return float(max(scene.frequencies, default=scene.campbell.highest))


def speeds_of(scene: Scene) -> SweepRange | None:
    """Speeds of the Campbell diagram where none are given: those of [sweep], or around the operating speed.

    Parameters
    ----------
    scene : Scene
        The scene; None for one that stands still and has no [sweep].
    """
    if scene.sweep is not None:
        return SweepRange(scene.sweep.begin, scene.sweep.end, min(scene.sweep.points, MOST_SPEEDS))
    return SweepRange(_BELOW * scene.speed, _ABOVE * scene.speed, MOST_SPEEDS) if scene.speed > 0.0 else None


def _sweep(model: Model, speeds: SweepRange | None) -> SweepResult:
    """Modes over a few speeds, without frequency responses."""
    scene = model.scene
    speeds = speeds or speeds_of(scene)
    if speeds is None:
        raise AnalysisError("the scene stands still and has no [sweep]; --speed gives speeds")
    return sweep(dataclasses.replace(model, scene=dataclasses.replace(scene, frequencies=())), SweepSettings(speeds))


def _or_reason(find: Callable[[], R]) -> R | str:
    """The result, or why there is none."""
    try:
        return find()
    except (AnalysisError, InputError) as error:
        return str(error)
