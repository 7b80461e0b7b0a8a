"""Speed against accuracy of a scene: laws, supplies, maps, slices, cut-off, step and cage angles, as measured.

What differs in a linear analysis, and what in a run-up, is measured apart, because the one takes a second and the other
a minute: each choice has a row for either. Of the run-up two parts are run, each from its equilibrium.

Choices of the model are compared with the most complete model, both with the settings of the scene. Choices of
numbers are compared with the finest number, the rest being that of the scene. So errors of one do not stand in those of
another; a row of its own compares the settings of the scene with the finest of all at once.
"""

from __future__ import annotations

import contextlib
import dataclasses
import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import Any, TypeVar

import numpy as np

from ehdmaps.errors import AnalysisError, EhdmapsError, InputError
from ehdmaps.maps.emap import EHDMap
from ehdmaps.trade.record import Choice, Entry, ErrorSummary, Group, Judged, Scope, Source, Trade
from ehdmaps.units import RPM
from mbs.analyses.case import Progress, silent
from mbs.analyses.operating import held
from mbs.analyses.ramp import recorded_run, run_course
from mbs.analyses.sensors import looked_at
from mbs.budget import (
    DAMPING,
    FREQUENCY,
    HEIGHT,
    LINEAR,
    LinearDifferences,
    LinearLook,
    LinearReference,
    Tried,
    differences_row,
    linear_look,
    linear_row,
    model_choices,
    model_sources,
    open_rows,
    open_runs,
    settled_base,
)
from mbs.laboratory.tradeoff.ramp_parts import PartRun, Ramp, RampPart, ramp_of, run_part
from mbs.linearised.averaged import pitch
from mbs.planning.tolerance import Numerics
from mbs.scene import changes
from mbs.scene.assembly import Model
from mbs.scene.choices import CHOICES
from mbs.scene.fields import HERTZ, MILLISECOND
from mbs.scene.map_set import TABLE_LAW, MapSet
from mbs.scene.scene import Scene
from mbs.scene.subject import LawChoice, Subject, named_law
from mbs.settings import CAGE_ANGLES, CampbellSettings
from mbs.spectral.levels import Reference

T = TypeVar("T")

LEVEL, FORCE = "sum level", "bearing force"
JUDGED = (*LINEAR, Judged(LEVEL, "dB"), Judged(FORCE, "dB"))
"""What is compared: the first four in a linear analysis, the others in a run-up."""

SLICES = (6, 11, 21, 41, 81)
"""Slices of a roller that are tried; the last ones are the reference."""

COARSER, FINER = (4.0, 2.0), (0.5, 0.25)
"""Steps that are tried, as multiples of that of the scene; the last one is the reference."""

ANGLES = (1, 2, 4, 8, 16)
"""Numbers of cage angles within one pitch that are tried; the last one is the reference."""

STARTS = 4
"""Places of the first of them, of which the worst counts."""

NUMBERS = ("slices", "cut-off", "step", "cage angles")
"""Groups of choices."""

PLACES = (0.25, 0.75)
"""Which parts of a ramp are run, as parts of its length."""

_WARM_STEPS = 128

FINEST = {
    "slices": "the most slices",
    "cut-off": "the highest cut-off",
    "step": "the shortest step",
    "cage angles": "the most cage angles",
}
"""What the numbers of a group are held against, by the name of the group; models are held against that of the trade."""


@dataclass(frozen=True)
class TradeoffSettings:
    """Choice of what is measured of a scene.

    Attributes
    ----------
    campbell : CampbellSettings
        Sensor, highest frequency and window of the levels.
    runs : bool
        Whether run-ups are measured, too; linear analyses always are.
    """

    campbell: CampbellSettings
    runs: bool = True


def tradeoff(
    scene: Scene,
    laws: Sequence[LawChoice],
    clearance: float | None = None,
    settings: TradeoffSettings | None = None,
    progress: Progress | None = None,
) -> Trade:
    """Measure what the choices of a scene cost, and how wrong they are.

    Parameters
    ----------
    scene : Scene
        The scene; without [runup] only linear analyses are measured.
    laws : sequence of LawChoice
        Laws of maps, the first of which is the reference; without any the film formula is.
    clearance : float, optional
        Diametral clearance of all bearings [m]; that of the scene if left out.
    settings : TradeoffSettings, optional
        What is measured; [campbell] of the scene, and run-ups, if left out.
    progress : callable, optional
        Told how many measurements are done, and of how many at most.

    Raises
    ------
    InputError
        If scene, laws and settings do not fit together.
    AnalysisError
        If the reference has no equilibrium.
    """
    settings = settings or TradeoffSettings(scene.campbell)
    maps = [law for law in laws if law.maps is not None]
    films = maps[0] if maps else named_law(TABLE_LAW if scene.lubricant is not None else "formula", scene)
    base = Subject(scene, dataclasses.replace(films, films="memory"), clearance)
    runs = settings.runs and scene.run_up is not None
    numerics = Numerics.of(scene) if scene.run_up is not None else None
    base, model = settled_base(base, settings.campbell.highest)
    scene = base.scene
    models = [*model_choices(base, model), *_maps(base, maps)]
    linear = [*models, *_numbers(base, ("slices", "cutoff"), settings)]
    ramp = ramp_of(model, settings.campbell, looked_at(scene, settings.campbell)) if runs else None
    numbers = ("step", "slices", "cutoff")
    tried = [*models, *open_runs(base, model), *_numbers(base, numbers, settings)] if ramp else []
    parts = () if ramp is None else tuple(ramp.parts[int(place * len(ramp.parts))] for place in PLACES)
    measure = _Measured(ramp, parts, progress or silent, 2 * (len(linear) + len(tried)) + STARTS * len(ANGLES))
    choices = [_linear_choice(one, measure, settings) for one in linear]
    choices += _open_choices(base, model, measure, settings)
    choices += _angle_choices(base, measure, settings)
    if ramp is not None and numerics is not None:
        tried.append(_together(base, numerics))
        choices += [_run_choice(one, measure) for one in tried]
    measure.finish()
    lines = [
        f"linear: modes and responses up to {HERTZ.text(settings.campbell.highest)} at {RPM.text(scene.speed)}; "
        "contact load: of the most loaded slice or ball of each bearing; cost: processor time of one analysis"
    ]
    if ramp is not None:
        lines += _run_frame(base, ramp, parts)
    lines += model.warnings
    return Trade(
        level="system",
        title=f"Speed against accuracy of {scene.title}",
        cost="s",
        reference=f"{base.law.label} with memory of its films; of numbers the finest of each group",
        judged=JUDGED if ramp is not None else JUDGED[:4],
        choices=tuple(choices),
        frame=tuple(lines),
        scopes=_scopes(choices),
        sources=_sources(base, choices),
        shown=(FREQUENCY, DAMPING, HEIGHT if ramp is None else LEVEL),
    )


def _scopes(choices: Sequence[Choice]) -> tuple[Scope, ...]:
    """Questions that are answered: one setting of each number, of a linear analysis and of a run-up."""
    known = {choice.group for choice in choices}
    scopes = []
    for kind, words, judged in (
        ("linear", "a linear analysis", (FREQUENCY, DAMPING, HEIGHT)),
        ("run-up", "a run-up", (LEVEL,)),
    ):
        groups = tuple((name,) for part in NUMBERS if (name := f"{kind}: {part}") in known)
        if groups:
            scopes.append(Scope(words, groups, judged))
    return tuple(scopes)


def _sources(base: Subject, choices: Sequence[Choice]) -> tuple[Source, ...]:
    """Sources of error: what a law leaves out, what a scene states and may be wrong, and the numbers as they are."""
    found = model_sources(base, choices)
    for part in NUMBERS:
        labels = [choice for choice in choices if choice.group.endswith(f": {part}")]
        usual = next((index for index, choice in enumerate(labels) if choice.default), None)
        if usual is not None:
            finer = labels[usual + 1].label if usual + 1 < len(labels) else ""
            # "1 angle" says least of all what it is
            name = f"{labels[usual].label} of the cages" if part == "cage angles" else labels[usual].label
            found.append(Source(name, labels[usual].label, finer))
    return tuple(found)


def _maps(base: Subject, maps: Sequence[LawChoice]) -> Iterable[Tried]:
    """Other maps, and the map of the reference with fewer points."""
    group = Group("map", base)
    for law in maps[1:]:
        yield Entry(group, law.label, dataclasses.replace(base, law=dataclasses.replace(law, films="memory")))
    given = base.law.maps
    if given is None:
        return
    yield Entry(group, "as given", base, default=True)
    for label, thin in _thinned(given):
        yield Entry(group, label, dataclasses.replace(base, law=dataclasses.replace(base.law, maps=thin)))


def _thinned(given: MapSet) -> Iterable[tuple[str, MapSet]]:
    """Maps without what it costs most to make; only what are maps still."""
    if any(emap.backbone is not None for emap in given.maps):
        with contextlib.suppress(EhdmapsError):
            yield "no lines of refinement", given.each(lambda emap: EHDMap(emap.dataset))
    if any(_every_second(emap) and not emap.from_table for emap in given.maps):
        # What is left may be too little for a law.
        with contextlib.suppress(EhdmapsError):
            yield (
                "every second load, no such lines",
                given.each(lambda emap: EHDMap(emap.dataset.isel(_every_second(emap)))),
            )


def _every_second(emap: EHDMap) -> dict[str, slice]:
    """Every second load of a map; all where the last one would be lost."""
    return {"load": slice(None, None, 2)} if emap.dataset.sizes["load"] % 2 else {}


def _numbers(base: Subject, keys: Sequence[str], settings: TradeoffSettings) -> Iterable[Tried]:
    """Numbers from coarse to fine, each with the finest one as its reference."""
    scene = base.scene
    for key in keys:
        values, finest, own = _values(scene, key, settings.campbell.highest)
        # One subject each, because what is measured is known by it.
        reference = base if finest == own or not values else _with(base, key, finest)
        name = "cut-off" if key == "cutoff" else key
        group = Group(name, reference, FINEST[name])
        for value in values:
            subject = base if value == own else _with(base, key, value)
            yield Entry(group, CHOICES[key].words(value), subject, default=value == own)


def _values(scene: Scene, key: str, highest: float) -> tuple[list[float | int], float | int, float | int]:
    """Values of a number that are tried, the finest one, and that of the scene; none where the scene has no such."""
    if key == "step":
        assert scene.run_up is not None
        own = scene.run_up.settings.step
        longest = (1.0 + 1e-6) / (2.5 * highest)
        values = [own * factor for factor in (*COARSER, 1.0, *FINER) if own * factor <= longest]
        return list(values[:-1]), values[-1], own
    if key == "slices":
        many = max(
            [0, *(entry.slices for entry in scene.bearings), *(getattr(entry, "slices", 0) for entry in scene.located)]
        )
        found = sorted({*SLICES[:-1], many, 2 * many - 1 if many > SLICES[-2] else SLICES[-1]})
        return ([], 0, 0) if not many else (list(found[:-1]), found[-1], many)
    top = changes.cutoff_of(scene)
    if top is None:
        return [], 0.0, 0.0
    return [value for k in range(20) if (value := highest * 2.0 ** (0.25 * k)) < 0.95 * top] + [top], top, top


def _with(base: Subject, key: str, value: float | int) -> Subject:
    """The subject with one number changed."""
    return CHOICES[key].change(base, value)


def _together(base: Subject, numerics: Numerics) -> Tried:
    """All settings of the scene beside the finest of all."""
    finest = base
    for key in ("step", "slices"):
        values, best, _ = _values(base.scene, key, base.scene.campbell.highest)
        finest = _with(finest, key, best) if values else finest
    group = Group("all settings of the scene", finest, "the shortest step and the most slices")
    return Entry(group, numerics.words(), base, default=True)


class _Measured:
    """Measured results, none measured twice; texts say why there are none."""

    def __init__(self, ramp: Ramp | None, parts: tuple[RampPart, ...], tell: Progress, most: int) -> None:
        self.ramp, self.parts = ramp, parts
        self._tell, self._most, self._done = tell, most, 0
        self._warm: set[str] = set()
        self._known: dict[tuple[str, int, float, int], Any] = {}
        self._kept: list[Subject] = []

    def linear(self, subject: Subject, angle: float = 0.0, cage_angles: int = CAGE_ANGLES) -> LinearLook | str:
        """The linear system with means over some cage angles, the first of them at an angle of the system."""

        def look(new: bool) -> LinearLook:
            model = subject.model()
            if new:
                linear_look(model, angle, cage_angles)
            return linear_look(model, angle, cage_angles)

        return self._once("linear", subject, (angle, cage_angles), look)

    def runs(self, subject: Subject) -> tuple[PartRun, ...] | str:
        """The runs of all parts."""

        def run(new: bool) -> tuple[PartRun, ...]:
            assert self.ramp is not None
            if new:
                _warm(subject, self.ramp)
            return tuple(run_part(subject, self.ramp, part) for part in self.parts)

        return self._once("run", subject, (0.0, 1), run)

    def finish(self) -> None:
        """Say that nothing more is measured."""
        self._tell(self._most, self._most)

    def _once(self, kind: str, subject: Subject, cages: tuple[float, int], measure: Callable[[bool], T]) -> T | str:
        """Measure what was not measured yet; `measure` is told whether its like has not run in this process."""
        key, like = (kind, id(subject), *cages), f"{kind} {subject.law.name} {subject.law.films}"
        if key not in self._known:
            self._kept.append(subject)
            try:
                new = like not in self._warm
                self._warm.add(like)
                self._known[key] = measure(new)
            except (AnalysisError, InputError) as error:
                self._known[key] = str(error)
            self._done = min(self._done + 1, self._most - 1)
            self._tell(self._done, self._most)
        found: T | str = self._known[key]
        return found


def _warm(subject: Subject, ramp: Ramp) -> None:
    """Make some steps, so that what is imported and made once is no cost of a run."""
    assert subject.scene.run_up is not None
    scene = changes.with_part(subject.scene, 0.0, _WARM_STEPS * subject.scene.run_up.settings.step)
    course = run_course(scene, ramp.highest, [])
    if course is not None:
        recorded_run(held(dataclasses.replace(subject, scene=scene).model()), course, ramp.sensors)


def _linear_choice(one: Tried, measure: _Measured, settings: TradeoffSettings) -> Choice:
    """A row of the linear analyses."""
    reference, found = _reference(one, measure.linear(one.group.truth)), measure.linear(one.way)
    if isinstance(found, str):
        return one.choice("linear: ", math.nan, {}, solved=0, asked=1, lost=(found,))
    return linear_row(one, found, LinearReference.of(reference, settings.campbell.highest))


def _reference(one: Tried, found: T | str) -> T:
    """Reference of a choice; an error where there is none."""
    if isinstance(found, str):
        raise AnalysisError(f"{one.group.name}, reference: {found}")
    return found


def _open_choices(base: Subject, model: Model, measure: _Measured, settings: TradeoffSettings) -> list[Choice]:
    """Rows of what the scene leaves open, beside the reference."""
    found = measure.linear(base)
    return (
        [] if isinstance(found, str) else open_rows(base, model, LinearReference.of(found, settings.campbell.highest))
    )


def _angle_choices(base: Subject, measure: _Measured, settings: TradeoffSettings) -> list[Choice]:
    """Rows of the cage angles: means over some, from several places on, beside the mean over the most."""
    finest = measure.linear(base, 0.0, ANGLES[-1])
    if isinstance(finest, str):
        return []
    turn = max((pitch(entry.element) for entry in finest.balance.system.elements), default=0.0)
    if turn == 0.0:
        return []
    beside = LinearReference.of(finest, settings.campbell.highest)
    group, choices = Group("cage angles", base, FINEST["cage angles"]), []
    for count in ANGLES[:-1]:
        starts = [turn * part / (STARTS * count) for part in range(STARTS)]
        looks = [look for at in starts if not isinstance(look := measure.linear(base, at, count), str)]
        if len(looks) < STARTS:
            continue
        worst = LinearDifferences.worst([beside.beside(look) for look in looks])
        # Loads are those of the first place, whatever is averaged.
        worst = dataclasses.replace(worst, load=np.full_like(worst.load, np.nan))
        entry = Entry(group, f"{count} angle{'s' if count > 1 else ''}", base, default=count == CAGE_ANGLES)
        choices.append(differences_row(entry, sum(look.seconds for look in looks) / STARTS, beside, worst))
    return choices


def _run_choice(one: Tried, measure: _Measured) -> Choice:
    """A row of the run-ups."""
    reference, found = _reference(one, measure.runs(one.group.truth)), measure.runs(one.way)
    asked = sum(run.speeds.size for run in reference)
    if isinstance(found, str):
        return one.choice("run-up: ", math.nan, {}, solved=0, asked=asked, lost=(found,))
    levels = np.concatenate([own.differences(run)[0] for own, run in zip(reference, found, strict=True)])
    speeds = [RPM.text(speed) for own in reference for speed in own.speeds.tolist()]
    with np.errstate(divide="ignore", invalid="ignore"):
        forces = [20.0 * np.log10(run.forces / own.forces) for own, run in zip(reference, found, strict=True)]
    places = [f"{name}, {RPM.text(own.speeds[0])}" for own in reference for name in reference[0].bearings]
    errors = {LEVEL: ErrorSummary.of(levels, speeds), FORCE: ErrorSummary.of(np.concatenate(forces), places)}
    return one.choice("run-up: ", _whole(one.way, found, measure), errors, solved=asked, asked=asked)


def _whole(subject: Subject, runs: Sequence[PartRun], measure: _Measured) -> float:
    """Time that the whole run-up would take, by what its parts took [s]."""
    assert subject.scene.run_up is not None
    part = sum(one.end - one.start for one in measure.parts)
    return sum(run.seconds for run in runs) * subject.scene.run_up.duration / part


def _run_frame(base: Subject, ramp: Ramp, parts: Sequence[RampPart]) -> list[str]:
    """Facts that a reader must know of the run-ups."""
    sensor = ramp.sensors[0]
    spans = " and ".join(f"{RPM.value(part.speeds[0]):.4g} to {RPM.text(part.speeds[1])}" for part in parts)
    top = changes.cutoff_of(base.scene)
    return [
        f"run-up: {spans}, sum level of {sensor.name}, {Reference.of(sensor).text}, up to {HERTZ.text(ramp.highest)} "
        f"at equal speed in windows of {MILLISECOND.text(ramp.window)}; bearing force: root mean square of what "
        "oscillates; cost: processor time of the whole run-up, from that of these parts",
        "a dry run without damping does not forget its start: its levels scatter, and its median counts",
        *([] if top is None else [f"modes above {HERTZ.text(top)} are in no row, nor in the reference"]),
    ]
