"""An analysis that chooses its physics: what a scene requires, films of the film table, maps of what that has not.

The order of things: the ranges of the scene as the analysis visits it (`mbs.planning.question`, `mbs.planning.plan`),
the physics that they require (`mbs.planning.verdicts`), films of each type of bearing, and the analysis. Films come
from the film table. Where heat or a limiting stress matter, a map is made by `ehdmaps.jobs.make.generate`, whose store
beside it knows what is solved; or one of a wider range is taken that was made before (`mbs.planning.kept_maps`). Where
no contact law can be made of that map, as the solver ended at some of its points, the physics that was chosen for it is
left out again, and its verdict says so.
"""

from __future__ import annotations

import dataclasses
import math
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Generic, TypeVar

from ehdmaps.errors import InputError, MapError
from ehdmaps.jobs.job import Job
from ehdmaps.jobs.job_text import Entry
from ehdmaps.jobs.make.batch_generate import make_folder
from ehdmaps.jobs.make.generate import generate
from ehdmaps.jobs.make.law_check import REFUSED, unmet
from ehdmaps.jobs.make.sweep import Progress, SweepResult
from ehdmaps.maps.emap import EHDMap
from ehdmaps.outputs import MAP, Output, check_outputs
from ehdmaps.physics.heat import ISOTHERMAL, PHYSICS
from ehdmaps.physics.oil_supply import FLOODED, OilSupply
from ehdmaps.physics.rheology import SHEARS
from mbs.model.relaxation import Films
from mbs.planning.kept_maps import covering
from mbs.planning.machine import machine_verdicts
from mbs.planning.plan import PlanResult, PlanSettings, plan
from mbs.planning.verdicts import (
    TOLERANCE,
    Verdict,
    heat_verdict,
    in_force,
    left_out_verdict,
    memory_verdict,
    roughness_verdict,
    shear_verdict,
    supply_verdict,
    surface_in_force,
    visited,
)
from mbs.scene.assembly import Model, assemble
from mbs.scene.choices import LawChoice, Subject, named_law
from mbs.scene.contact_laws import law_label
from mbs.scene.map_set import TABLE_LAW, MapSet, table_maps
from mbs.scene.scene import Scene

if TYPE_CHECKING:
    from mbs.planning.ranges import Needed
    from mbs.planning.seen import Seen

R = TypeVar("R")

MOST_TOLERANCE = 9.0
"""A tenfold stiffness or damping, 20 dB."""

DIGITS = 12
"""Digits of the job's hash in the name of its map."""

_UNSAFE = re.compile(r"[^a-z0-9_-]+")

TellMap = Callable[[int], Progress]
"""Takes the number of points that are to be solved, gives what is told."""


@dataclass(frozen=True, kw_only=True)
class AutoSettings:
    """Settings of an analysis that chooses its physics.

    Attributes
    ----------
    tolerance : float
        Change of a stiffness or damping, as a part of it, above which physics is switched on.
    highest : float or None
        Highest frequency that matters [Hz]; None for that of [linear] of the scene, else of [campbell]; 0 for none.
    folder : Path
        Folder of the maps that are made.
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
class MadeMap:
    """A map that was made for an analysis, now or before.

    Attributes
    ----------
    path : Path
        File of the map.
    emap : EHDMap
        The map.
    sweep : SweepResult or None
        Counts of its points; None for a map of a wider range that was there.
    """

    path: Path
    emap: EHDMap
    sweep: SweepResult | None

    @property
    def refused(self) -> str:
        """Reason why no contact law can be made of it; empty where one can, or where that was not looked at."""
        return str(self.emap.dataset.attrs.get(REFUSED, ""))

    @property
    def unmet(self) -> tuple[str, ...]:
        """Bars that its contact laws miss, without the advice, as the job was planned."""
        lines = unmet(self.emap.dataset, self.emap.backbone is not None)
        return tuple(line for line in lines if line.startswith(("unmet", "no contact law")))


@dataclass(frozen=True, eq=False)
class Automatic(Generic[R]):
    """An analysis with the physics that was chosen for it.

    Attributes
    ----------
    result : R
        What the analysis gave.
    subject : Subject
        Scene and law that it was made with.
    made : tuple of MadeMap
        Maps of the types of bearing whose films the film table has not, made now or before.
    verdicts : tuple of Verdict
        Which physics is on, and why: memory, supply, roughness, then heat of each type of bearing, shear of each, and
        what the scene file switches (`mbs.planning.machine`); last, what films leave out of k and c.
    """

    result: R
    subject: Subject
    made: tuple[MadeMap, ...]
    verdicts: tuple[Verdict, ...]


def automatic(
    scene: Scene,
    analysis: Callable[[Model], R],
    settings: AutoSettings | None = None,
    progress: TellMap | None = None,
    planned_for: Scene | None = None,
) -> Automatic[R]:
    """Analyse a scene with the physics that it requires.

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
    planned_for : Scene, optional
        The scene as the analysis visits it, such as `mbs.planning.question.at_one_speed(scene)` for statics; the scene
        with all its speeds if left out.

    Raises
    ------
    InputError
        With everything because of which there is no plan, or no map.
    AnalysisError
        If there is no equilibrium, or what the analysis raises.
    MapError
        If no contact law can be made of a map with physics that was asked for.

    Examples
    --------
    Without heat and limiting stress no map is made::

        from mbs import automatic, modes, read_scene

        found = automatic(read_scene("nu308_rigid"), modes)
        [verdict.line for verdict in found.verdicts]
        found.result.dataset["frequency"]
    """
    return settled(scene, lambda subject: analysis(subject.model()), settings, progress, planned_for)


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
        The scene as the analysis visits it, see `mbs.planning.question`; the scene with all its speeds if left out.
    """
    settings = settings or AutoSettings()
    highest = settings.highest
    if highest is None:
        highest = max(scene.frequencies, default=scene.campbell.highest)
    looked_at = planned_for or scene
    warm = settings.shear is None and settings.physics is None and any(entry.thermal for entry in scene.bearings)
    found = plan(_of_one_temperature(looked_at) if warm else looked_at, PlanSettings(settings.clearance))
    found = dataclasses.replace(found, scene=looked_at)
    if not found.needed:
        _check_without_map(scene, settings)
    supplies = _supplies(scene, settings.supply)
    required = _verdicts(scene, found, settings, supplies, highest)
    pairs = tuple(pair.of_table(settings, _WARM) for pair in required.of_maps) if warm else required.of_maps
    films, pairs = _films(looked_at, found, pairs, settings, progress)
    summed = [left_out_verdict(required.of(pair)) for pair in pairs]
    maps = [
        (one.emap if isinstance(one, MadeMap) else one).with_left_out(*errors)
        for one, (_, errors) in zip(films, summed, strict=True)
    ]
    subject = _subject(scene, MapSet(maps) if maps else None, required, supplies, settings)
    verdicts = dataclasses.replace(required, of_maps=pairs).all
    if highest > 0.0:  # an equilibrium has no bands
        summed += [left_out_verdict(required.of(pair), in_bands=False) for pair in required.of_seen if pair.judged]
        verdicts = (*verdicts, *([_worst([verdict for verdict, _ in summed])] if summed else []))
    try:
        result = analyse(subject)
    except MapError as error:
        raise MapError("\n".join([str(error), *_remedies(verdicts)])) from error
    return Automatic(result, subject, tuple(one for one in films if isinstance(one, MadeMap)), verdicts)


_WARM = "rings have temperatures of their own, and a map that is made has a single one"


def map_name(scene: str, job: Job) -> str:
    """Name of the map of a job: the scene, the bearing, the beginning of the job's sha256.

    Parameters
    ----------
    scene : str
        Name of the scene.
    job : Job
        The job.

    Examples
    --------
    >>> from mbs import plan, read_scene
    >>> job, = plan(read_scene("nu308_rigid")).jobs()
    >>> map_name("nu308_rigid", job).startswith("nu308_rigid_nu308_")
    True
    """
    bearing = job.bearing.name if job.bearing else job.title
    words = (_UNSAFE.sub("-", text.lower()).strip("-") or "map" for text in (Path(scene).stem, bearing))
    return "_".join((*words, job.sha256[:DIGITS])) + ".nc"


@dataclass(frozen=True)
class _OfMap:
    """Verdicts on the physics that a map of one type of bearing has to have, or else its films are of the table."""

    heat: Verdict
    shear: Verdict

    @property
    def judged(self) -> bool:
        """Tell whether it is known what is left out: of points it is not."""
        return not math.isnan(self.shear.size)

    @property
    def solver(self) -> dict[str, Entry]:
        """Keys of [solver] of the map; none where the film table serves."""
        return {**self.heat.solver, **self.shear.solver}

    def of_table(self, asked: AutoSettings, reason: str) -> _OfMap:
        """The same without all that only a map has, for a reason."""
        less = self.without(asked, reason)
        return self if less is None else less.of_table(asked, reason)

    def without(self, asked: AutoSettings, reason: str) -> _OfMap | None:
        """The same without what was chosen last, for a reason; None where all that is left was asked for."""
        for name, given in (("shear", asked.shear), ("heat", asked.physics)):
            verdict: Verdict = getattr(self, name)
            if verdict.solver and given is None:
                return dataclasses.replace(self, **{name: verdict.left_out(reason)})
        return None


@dataclass(frozen=True)
class _Found:
    """All verdicts: on what laws can have, on what a map of each type has, and films without a map; on the machine."""

    of_films: tuple[Verdict, ...]
    of_laws: tuple[Verdict, ...]
    of_maps: tuple[_OfMap, ...]
    of_seen: tuple[_OfMap, ...]
    of_machine: tuple[Verdict, ...]

    @property
    def dry(self) -> bool:
        """Tell whether contacts have no films."""
        return any(not verdict.on for verdict in self.of_films)

    @property
    def all(self) -> tuple[Verdict, ...]:
        """In the order in which they are told."""
        pairs = (*self.of_maps, *self.of_seen)
        heats, shears = (pair.heat for pair in pairs), (pair.shear for pair in pairs)
        return (*self.of_films, *self.of_laws, *heats, *shears, *self.of_machine)

    def of(self, pair: _OfMap) -> tuple[Verdict, ...]:
        """Those on the films of one type of bearing."""
        return (*self.of_films, *self.of_laws, pair.heat, pair.shear, *self.of_machine)


def _films(
    scene: Scene,
    found: PlanResult,
    pairs: tuple[_OfMap, ...],
    settings: AutoSettings,
    progress: TellMap | None,
) -> tuple[list[EHDMap | MadeMap], tuple[_OfMap, ...]]:
    """Films of each type of bearing, from the film table or of a map, and the verdicts that they could be made by."""
    if any(pair.solver for pair in pairs):
        found.jobs(solvers=[pair.solver for pair in pairs])  # problems of all of them, before one is made
    made = [_usable(scene, found, index, settings, pair, progress) for index, pair in enumerate(pairs)]
    return [films for films, _ in made], tuple(pair for _, pair in made)


def _usable(
    scene: Scene, found: PlanResult, index: int, settings: AutoSettings, pair: _OfMap, progress: TellMap | None
) -> tuple[EHDMap | MadeMap, _OfMap]:
    """Films of one type of bearing that make a contact law: without what was chosen where that makes none."""
    films = _film(scene, found, index, pair, settings, progress)
    refused = films.refused.partition("; ")[0] if isinstance(films, MadeMap) else ""
    less = pair.without(settings, f"the map with it makes no contact law ({refused})") if refused else None
    return (films, pair) if less is None else _usable(scene, found, index, settings, less, progress)


def _film(
    scene: Scene, found: PlanResult, index: int, pair: _OfMap, settings: AutoSettings, progress: TellMap | None
) -> EHDMap | MadeMap:
    """Films of one type of bearing: from the film table, or of a map where its verdicts ask for more."""
    read = None if pair.solver else table_maps(scene).of(found.needed[index].geometry)
    if read is not None:
        return read
    job = found.job(index, solver=pair.solver)
    make_folder(settings.folder, "--maps")
    name = map_name(scene.name, job)
    path = settings.folder / name
    if not path.exists():
        alike = sorted(settings.folder.glob(f"{name.rpartition('_')[0]}_{'?' * DIGITS}.nc"))
        there = covering(alike, job)
        if there is not None:
            return MadeMap(*there, None)
    check_outputs([Output("--maps", path, MAP)])
    made = generate(dataclasses.replace(job, name=path.stem), path, settings.workers, progress=progress)
    return MadeMap(path, EHDMap(made.dataset, made.backbone), made.sweep)


def _remedies(verdicts: tuple[Verdict, ...]) -> list[str]:
    """Advice on how to get another map where one cannot be used: without the physics that it was made with."""
    plain = {"limiting shear stress": "--shear newtonian", "inlet heating": "--physics isothermal"}
    return [
        f"auto: the map was made with {verdict.physics} ({verdict.words}); {plain[verdict.physics]} makes one without, "
        "whose films leave that out"
        for verdict in verdicts
        if verdict.on and verdict.solver
    ]


def _of_one_temperature(scene: Scene) -> Scene:
    """The scene with raceways of its own temperature, by which ranges are planned."""
    return scene.with_bearings(dataclasses.replace(entry, thermal=None) for entry in scene.bearings)


def _check_without_map(scene: Scene, settings: AutoSettings) -> None:
    """Refuse physics that only a map has, for bearings of which none is made."""
    given = (("--physics", settings.physics, ISOTHERMAL), ("--shear", settings.shear, "newtonian"))
    problems = [
        f"{option}: got {value} for bearings whose films are read from the film table, which is {plain}; leave it out"
        for option, value, plain in given
        if value not in (None, plain)
    ]
    if problems:
        raise InputError([f"{scene.name}: {problem}" for problem in problems])


def _supplies(scene: Scene, asked: OilSupply | None) -> dict[str, OilSupply]:
    """The oil supply of each bearing by its name."""
    usual = asked or scene.supply or FLOODED
    found = {entry.name: asked or entry.supply or usual for entry in scene.bearings}
    return found | {entry.name: usual for entry in scene.located}


def _verdicts(
    scene: Scene, found: PlanResult, settings: AutoSettings, supplies: Mapping[str, OilSupply], highest: float
) -> _Found:
    """Find the physics required: memory, supply and roughness, each where it matters most; heat and shear by type."""
    assert scene.lubricant is not None  # the plan saw to it
    without, tolerance = _without_memory(scene), settings.tolerance
    entries: tuple[Needed | Seen, ...] = (*found.needed, *found.seen)
    ranges = [visited(entry, scene.lubricant, tolerance) for entry in entries]
    films: tuple[Verdict, ...] = ()
    if not found.needed:
        from mbs.planning.of_table import film_verdict

        model = assemble(found.scene, TABLE_LAW, clearance=settings.clearance, films="slow", supply=settings.supply)
        films = (film_verdict(found, model, tolerance, highest, settings.films),)
    groups: list[list[Verdict]] = []
    for entry, there in zip(entries, ranges, strict=True):
        theirs = tuple(supplies[name] for name in entry.bearings)
        if there.of_lines:
            own: tuple[Verdict, ...] = (
                memory_verdict(there, highest, settings.films, without),
                supply_verdict(there, theirs, settings.supply is not None),
                roughness_verdict(there, scene.surface),
                heat_verdict(there, settings.physics),
                shear_verdict(there, settings.shear),
            )
        elif there.points:
            from mbs.planning.of_table import point_verdicts

            own = point_verdicts(there, highest, settings.films, scene.surface, theirs[0])
        else:
            continue
        alone = len(entries) == 1
        groups.append([v if alone else dataclasses.replace(v, words=f"{entry.geometry.name}: {v.words}") for v in own])
    flooded = all(supply.flooded for supply in supplies.values())
    machine = machine_verdicts(found, ranges, highest, flooded)
    laws = tuple(_worst([own[index] for own in groups], least=index == _LAMBDA) for index in range(3)) if groups else ()
    pairs = [_OfMap(*own[3:]) for own in groups]
    count = len(found.needed)
    seen = tuple(pair.of_table(AutoSettings(), _NO_MAP) for pair in pairs[count:])
    if films and not films[0].on:
        laws = tuple(dataclasses.replace(one, on=False, warns=False, size=math.nan, words=_DRY) for one in laws)
    return _Found(films, laws, tuple(pairs[:count]), seen, machine)


_DRY = "as contacts are dry"

_LAMBDA = 2
"""Place of the roughness, whose least size counts, among the verdicts."""

_NO_MAP = "these films are read from the film table, which has none"


def _without_memory(scene: Scene) -> str:
    """Name the part of a scene that films with memory do not go with; empty where they do."""
    bearings = scene.bearings
    if any(entry.centrifugal and not entry.rollers_as_bodies for entry in bearings):
        return "a centrifugal load of massless rollers"
    return "coupled slices" if any(entry.slices_coupled for entry in bearings) else ""


def _worst(verdicts: list[Verdict], least: bool = False) -> Verdict:
    """The verdict that counts for all bearings: one that is on, and of these the largest, or least, size.

    What was not looked at, having no size, is told of all.
    """
    if all(math.isnan(verdict.size) for verdict in verdicts):
        words = dict.fromkeys(verdict.words for verdict in verdicts)
        return dataclasses.replace(verdicts[0], on=any(verdict.on for verdict in verdicts), words="; ".join(words))

    def weight(verdict: Verdict) -> tuple[bool, float]:
        size = -verdict.size if least else verdict.size
        return bool(verdict.on), -math.inf if math.isnan(size) else size

    return max(verdicts, key=weight)


def _subject(
    scene: Scene, maps: MapSet | None, required: _Found, supplies: Mapping[str, OilSupply], settings: AutoSettings
) -> Subject:
    """Scene and law with what is switched on."""
    if required.dry:
        return Subject(scene, named_law("hertz", scene), settings.clearance)
    memory, supply, rough = required.of_laws
    surface = surface_in_force(scene.surface, rough)
    name = TABLE_LAW if maps is None else "map"
    law = LawChoice(
        law_label(name, maps),
        name,
        maps,
        "memory" if memory.on else "slow",
        settings.supply or in_force(tuple(supplies.values()), supply),
    )
    return Subject(dataclasses.replace(scene, surface=surface), law, settings.clearance)
