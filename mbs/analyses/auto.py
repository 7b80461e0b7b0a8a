"""An analysis that makes its own maps: planned, made or reused, run, and checked; again with a wider plan where needed.

The order of things: the ranges of the scene (`mbs.analyses.plan`), the physics that they require
(`mbs.analyses.film_verdicts`), a map for each type of bearing (`mbs.analyses.kept_map`), the analysis, and a look at
what it visited. Loads outside a map widen its plan; films of slow motion that turn out too wrong at the bearings get
their memory.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from types import NoneType
from typing import Generic, TypeVar

import numpy as np

from ehdmaps.errors import InputError, MapError
from ehdmaps.jobs.job_text import Entry
from ehdmaps.physics.heat import PHYSICS
from ehdmaps.physics.oil_supply import FLOODED, OilSupply
from ehdmaps.physics.rheology import SHEARS
from mbs.analyses import film_verdicts, planning
from mbs.analyses.campbell import CampbellResult
from mbs.analyses.case import LawChoice, Subject
from mbs.analyses.film_errors import film_errors
from mbs.analyses.film_verdicts import Verdict
from mbs.analyses.hammer import HammerResult
from mbs.analyses.kept_map import KeptMap, TellMap, kept_map
from mbs.analyses.lsa import LsaResult
from mbs.analyses.modes import ModesResult
from mbs.analyses.operating import operating
from mbs.analyses.plan import PlanResult, PlanSettings, plan
from mbs.analyses.reach import faster_than_laws
from mbs.analyses.runup import RunUpResult
from mbs.analyses.statics import StaticsResult
from mbs.analyses.sweep import CriticalResult, SweepResult
from mbs.instruments.tolerance import Tolerated
from mbs.model.elements import Operation
from mbs.model.equilibrium import equilibrium
from mbs.model.relaxation import Films
from mbs.scene.assembly import Model
from mbs.scene.contact_laws import law_label
from mbs.scene.map_set import MapSet
from mbs.scene.scene import Scene

R = TypeVar("R")

TOLERANCE = 0.05
"""Change of a stiffness or damping of a contact above which physics is switched on, as a part of it."""

MOST_MAPS = 3
"""How many plans are tried."""

WIDER = 3.0
"""Highest load of the next plan over that of the last one."""

MOST_TOLERANCE = 9.0
"""A tenfold stiffness or damping, 20 dB."""


@dataclass(frozen=True, kw_only=True)
class AutoSettings:
    """What an analysis that makes its own map is to look at.

    Attributes
    ----------
    tolerance : float
        Change of a stiffness or damping, as a part of it, above which physics is switched on.
    highest : float or None
        Highest frequency that matters [Hz]; None for that of [linear] of the scene, else of [campbell]; 0 for none.
    folder : Path
        Folder in which maps are made and kept.
    others : tuple of Path
        Further folders with maps.
    clearance : float or None
        Diametral clearance of all bearings [m]; None for those of the scene.
    films : {"slow", "memory"} or None
        Films that are asked for, whatever is required.
    supply : OilSupply or None
        Oil supply of all bearings that is asked for.
    physics : {"isothermal", "inlet-heat", "thermal"} or None
        What films are to know of heat, whatever is required.
    shear : {"newtonian", "eyring", "carreau", "limiting"} or None
        Law of the shear stress that is asked for, whatever is required.
    workers : int or None
        Processes that make a map; all cores if None.

    Raises
    ------
    InputError
        For a tolerance out of range.
    """

    tolerance: float = TOLERANCE
    highest: float | None = None
    folder: Path = Path()
    others: tuple[Path, ...] = ()
    clearance: float | None = None
    films: Films | None = None
    supply: OilSupply | None = None
    physics: str | None = None
    shear: str | None = None
    workers: int | None = None

    def __post_init__(self) -> None:
        if not 0.0 < self.tolerance <= MOST_TOLERANCE:
            raise InputError(
                f"auto, tolerance: got {self.tolerance!r}; allowed: above 0 up to {MOST_TOLERANCE:g}, a part of a "
                "stiffness or damping"
            )
        if self.physics is not None and self.physics not in PHYSICS:
            raise InputError(f"auto, physics: got {self.physics!r:.60}; allowed: {', '.join(PHYSICS)}")
        if self.shear is not None and self.shear not in SHEARS:
            raise InputError(f"auto, shear: got {self.shear!r:.60}; allowed: {', '.join(SHEARS)}")


@dataclass(frozen=True, eq=False)
class Automatic(Generic[R]):
    """An analysis with the maps that were made for it.

    Attributes
    ----------
    result : R
        What the analysis gave.
    subject : Subject
        Scene and law that it was made with.
    maps : tuple of KeptMap
        Maps that were tried, plan by plan.
    margins : tuple of float
        Highest load of each of them over the largest one at rest.
    kept : tuple of KeptMap
        The last ones, which count: one for each type of bearing.
    verdicts : tuple of Verdict
        Which physics is on, and why: memory, supply, roughness, and heat of each map.
    left : mapping of str to int
        How often each bearing was still outside its last map; empty where it never was.
    too_fast : frozenset of str
        Those of them that turned faster than their map, or their table over speed, goes.
    """

    result: R
    subject: Subject
    maps: tuple[KeptMap, ...]
    margins: tuple[float, ...]
    kept: tuple[KeptMap, ...]
    verdicts: tuple[Verdict, ...]
    left: Mapping[str, int]
    too_fast: frozenset[str]


def automatic(
    scene: Scene,
    analysis: Callable[[Model], R],
    settings: AutoSettings | None = None,
    progress: TellMap | None = None,
) -> Automatic[R]:
    """Analyse a scene with maps that are planned and made, or reused, for it.

    Parameters
    ----------
    scene : Scene
        Scene with bearings and a lubricant.
    analysis : callable
        One of `mbs.statics`, `modes`, `lsa`, `sweep`, `critical`, `runup`, `campbell`, `hammer`, or a function that
        calls one.
    settings : AutoSettings, optional
        Tolerance, frequencies, folder of the maps.
    progress : callable, optional
        Told about maps that are made.

    Raises
    ------
    InputError
        With everything because of which there is no plan, or no map.
    AnalysisError
        If there is no equilibrium, or what the analysis raises.

    Examples
    --------
    The map takes half a minute of processor time, and is there the next time::

        from mbs import automatic, modes, read_scene

        found = automatic(read_scene("nu308_rigid"), modes)
        found.maps[-1].path, [verdict.line for verdict in found.verdicts]
        found.result.dataset["frequency"]
    """
    return settled(scene, lambda subject: analysis(subject.model()), settings, progress)


def settled(
    scene: Scene,
    analyse: Callable[[Subject], R],
    settings: AutoSettings | None = None,
    progress: TellMap | None = None,
    planned_for: Scene | None = None,
) -> Automatic[R]:
    """As `automatic`, for an analysis of a subject, which may change its scene.

    Parameters
    ----------
    scene : Scene
        Scene with bearings and a lubricant.
    analyse : callable
        The analysis.
    settings : AutoSettings, optional
        Tolerance, frequencies, folder of the maps.
    progress : callable, optional
        Told about maps that are made.
    planned_for : Scene, optional
        The scene as the analysis changes it: with its speeds, loads and clearances.
    """
    settings = settings or AutoSettings()
    highest = settings.highest
    if highest is None:
        highest = max(scene.frequencies, default=scene.campbell.highest)
    looked_at = planned_for or scene
    found = _plan(looked_at, settings.clearance, planning.MARGIN)
    plans = [found] * len(found.needed)
    margins = [planning.MARGIN] * len(plans)
    supplies = _supplies(scene, settings.supply)
    verdicts = _verdicts(scene, found, settings, supplies, highest)
    tried: list[tuple[KeptMap, float]] = []
    for attempt in range(1, MOST_MAPS + 1):
        keys = _solver_keys(verdicts, len(plans))
        jobs = [one.jobs(solvers=keys)[index] for index, one in enumerate(plans)]
        kept = tuple(
            kept_map(scene.name, job, settings.folder, settings.others, settings.workers, progress) for job in jobs
        )
        tried += zip(kept, margins, strict=True)
        subject = _subject(scene, kept, verdicts, supplies, settings)
        try:
            result = analyse(subject)
        except MapError as error:
            raise MapError("\n".join([str(error), *_remedies(verdicts)])) from error
        left = outside_calls(result)
        more = _with_memory(subject, looked_at, found, verdicts, settings, highest)
        widened = False
        too_fast = left.keys() & _too_fast(result)
        for index, one in enumerate(plans):
            # Another margin of the load brings nothing to bearings that turn faster than their map goes.
            if (left.keys() - too_fast) & set(one.needed[index].bearings):
                wider = _wider(looked_at, settings.clearance, WIDER * margins[index])
                if wider is not None:
                    plans[index], margins[index], widened = wider, WIDER * margins[index], True
        if attempt == MOST_MAPS or (not widened and more is None):
            break
        verdicts = more or verdicts
    maps, their_margins = zip(*tried, strict=True)
    return Automatic(result, subject, maps, their_margins, kept, verdicts, left, frozenset(too_fast))


def _remedies(verdicts: tuple[Verdict, ...]) -> list[str]:
    """What gives another map where one cannot be used: without the physics that it was made with."""
    plain = {"limiting shear stress": "--shear newtonian", "inlet heating": "--physics isothermal"}
    return [
        f"auto: the map was made with {verdict.physics} ({verdict.words}); {plain[verdict.physics]} makes one without, "
        "whose films leave that out"
        for verdict in verdicts
        if verdict.on and verdict.solver
    ]


def outside_calls(result: object) -> dict[str, int]:
    """How often each bearing was outside its map in an analysis, by name; none that never was.

    Parameters
    ----------
    result : object
        What an analysis gave: `StaticsResult`, `ModesResult`, `LsaResult`, `SweepResult`, `RunUpResult`,
        `CampbellResult`, `HammerResult`, or a sequence of these, with labels or without.

    Raises
    ------
    InputError
        For anything else.
    """
    counts: list[Mapping[str, int]]
    if isinstance(result, (list, tuple)):
        # Labels stand beside results, and how numerical settings were chosen for them.
        counts = [outside_calls(entry) for entry in result if not isinstance(entry, (str, Tolerated, NoneType))]
    elif isinstance(result, (StaticsResult, ModesResult, LsaResult)):
        counts = [result.balance.outside]
    elif isinstance(result, HammerResult):
        counts = [result.balance.outside, result.outside_hits]
    elif isinstance(result, CriticalResult):
        counts = [result.outside]
    elif isinstance(result, SweepResult):
        counts = list(result.outside)
    elif isinstance(result, RunUpResult):
        counts = [result.record.outside]
    elif isinstance(result, CampbellResult):
        counts = [run.record.outside for run in result.runs]
    else:
        raise InputError(
            f"auto, analysis: got a result of the type {type(result).__name__}; allowed: what statics, modes, lsa, "
            "sweep, critical, runup, campbell and hammer give"
        )
    total: dict[str, int] = {}
    for entry in counts:
        for name, count in entry.items():
            if count:
                total[name] = total.get(name, 0) + int(count)
    return total


def _too_fast(result: object) -> set[str]:
    """Bearings, and elements by tables over speed, that turn faster in an analysis than their law goes."""
    if isinstance(result, (list, tuple)):
        return {name for entry in result for name in _too_fast(entry)}
    visited: list[tuple[Model, float]] = []
    if isinstance(result, (StaticsResult, ModesResult, LsaResult, HammerResult)):
        visited = [(result.model, abs(result.balance.operation.speed))]
    elif isinstance(result, CriticalResult):
        visited = [(result.model, float(np.abs(result.sweep.speeds).max()))]
    elif isinstance(result, SweepResult):
        fastest = (float(np.abs(found.speeds).max()) for found in result.sweeps)
        visited = list(zip((case.model for case in result.cases), fastest, strict=True))
    elif isinstance(result, RunUpResult):
        visited = [(result.model, float(np.abs(result.record.speed).max()))]
    elif isinstance(result, CampbellResult):
        visited = [(run.case.model, float(np.abs(run.record.speed).max())) for run in result.runs]
    return {name for model, speed in visited for name in faster_than_laws(model, speed)}


def _plan(scene: Scene, clearance: float | None, margin: float) -> PlanResult:
    """The plan of a scene."""
    return plan(scene, PlanSettings(clearance=clearance, margin=margin))


def _wider(scene: Scene, clearance: float | None, margin: float) -> PlanResult | None:
    """A plan with another margin; None beyond what a job allows."""
    if margin > planning.MOST_MARGIN:
        return None
    try:
        found = _plan(scene, clearance, margin)
        found.jobs()
    except InputError:
        return None
    return found


def _supplies(scene: Scene, asked: OilSupply | None) -> tuple[OilSupply, ...]:
    """The oil supply of each bearing."""
    return tuple(asked or entry.supply or scene.supply or FLOODED for entry in scene.bearings)


def _verdicts(
    scene: Scene, found: PlanResult, settings: AutoSettings, supplies: tuple[OilSupply, ...], highest: float
) -> tuple[Verdict, ...]:
    """Which physics is required: memory, supply and roughness, each where it matters most; heat and shear by type."""
    assert scene.lubricant is not None  # the plan saw to it
    possible = not any(entry.centrifugal and not entry.rollers_as_bodies for entry in scene.bearings)
    memory, supply, rough, heat, shear = (list[Verdict]() for _ in range(5))
    for entry in found.needed:
        there = film_verdicts.visited(entry, scene.lubricant, settings.tolerance)
        theirs = tuple(
            given for spec, given in zip(scene.bearings, supplies, strict=True) if spec.name in entry.bearings
        )
        verdicts = (
            film_verdicts.memory_verdict(there, highest, settings.films, possible),
            film_verdicts.supply_verdict(there, theirs, settings.supply is not None),
            film_verdicts.roughness_verdict(there, scene.surface),
            film_verdicts.heat_verdict(there, settings.physics),
            film_verdicts.shear_verdict(there, settings.shear),
        )
        for group, verdict in zip((memory, supply, rough, heat, shear), verdicts, strict=True):
            named = f"{entry.geometry.name}: {verdict.words}" if len(found.needed) > 1 else verdict.words
            group.append(dataclasses.replace(verdict, words=named))
    return _worst(memory), _worst(supply), _worst(rough, least=True), *heat, *shear


def _worst(verdicts: list[Verdict], least: bool = False) -> Verdict:
    """The verdict that counts for all bearings: one that is on, and of these the largest, or least, size.

    What was not looked at, having no size, is told of all.
    """
    if all(math.isnan(verdict.size) for verdict in verdicts):
        words = dict.fromkeys(verdict.words for verdict in verdicts)
        return dataclasses.replace(verdicts[0], on=any(verdict.on for verdict in verdicts), words="; ".join(words))

    def weight(verdict: Verdict) -> tuple[bool, float]:
        size = -verdict.size if least else verdict.size
        return verdict.on, -math.inf if math.isnan(size) else size

    return max(verdicts, key=weight)


def _solver_keys(verdicts: tuple[Verdict, ...], types: int) -> list[dict[str, Entry]]:
    """Keys of [solver] of the map of each bearing type: what its verdicts on heat and shear ask for."""
    heat, shear = verdicts[3 : 3 + types], verdicts[3 + types :]
    return [{**warm.solver, **limited.solver} for warm, limited in zip(heat, shear, strict=True)]


def _subject(
    scene: Scene,
    kept: tuple[KeptMap, ...],
    verdicts: tuple[Verdict, ...],
    supplies: tuple[OilSupply, ...],
    settings: AutoSettings,
) -> Subject:
    """Scene and law with what is switched on."""
    memory, supply, rough = verdicts[:3]
    maps = MapSet([one.emap for one in kept])
    surface = film_verdicts.surface_in_force(scene.surface, rough)
    law = LawChoice(
        law_label("map", maps),
        "map",
        maps,
        "memory" if memory.on else "slow",
        settings.supply or film_verdicts.in_force(supplies, supply),
    )
    return Subject(dataclasses.replace(scene, surface=surface), law, settings.clearance)


def _with_memory(
    subject: Subject,
    scene: Scene,
    found: PlanResult,
    verdicts: tuple[Verdict, ...],
    settings: AutoSettings,
    highest: float,
) -> tuple[Verdict, ...] | None:
    """The verdicts with memory, where films without it turn out more than the tolerance wrong at a bearing."""
    memory, *others = verdicts
    if memory.on or settings.films is not None or highest == 0.0 or subject.law.films != "slow":
        return None
    error = slow_film_error(dataclasses.replace(subject, scene=scene), found.speeds, highest)
    possible = not any(entry.centrifugal and not entry.rollers_as_bodies for entry in scene.bearings)
    if error <= settings.tolerance or not possible:
        return None
    words = f"{memory.words}, but {100.0 * error:.2g} % at a bearing"
    return (Verdict(memory.physics, True, max(memory.size, error), words), *others)


def slow_film_error(subject: Subject, speeds: tuple[float, float], highest: float) -> float:
    """Largest estimated error of films of slow motion at the bearings, at two speeds and one frequency, as a part.

    Parameters
    ----------
    subject : Subject
        Scene and law.
    speeds : (float, float)
        Lowest and highest speed [rad/s].
    highest : float
        Frequency [Hz].
    """
    model, errors = subject.model(), [0.0]
    for speed in speeds:
        there, operation = operating(model, speed), Operation(speed)
        place = equilibrium(there.system, operation).displacement
        errors += [entry.at(highest) for entry in film_errors(there, place, operation, "slow")]
    return max(error for error in errors if math.isfinite(error))
