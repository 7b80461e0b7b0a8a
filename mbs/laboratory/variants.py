"""Dependence of a difference between two contact laws in a run-up on what was assumed, changed one at a time.

The run-up of a scene is made with two laws, as `mbs.analyses.campbell` makes it; then again with each change of
clearance, temperature, damping, ramp and so on. All sensors of an acceleration are taken from one run. Runs that a
change does not concern are not made again: a dry law knows no temperature.
"""

from __future__ import annotations

import contextlib
import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
import xarray as xr

from ehdmaps.arrays import FloatArray, variable
from ehdmaps.errors import AnalysisError, InputError, Problems
from mbs.analyses.case import Failed, Progress, Workers, side_by_side
from mbs.analyses.operating import held
from mbs.analyses.ramp import recorded_run, run_course, silent_run
from mbs.analyses.sensors import followed_orders
from mbs.model.elements import Sensor
from mbs.output.files import described
from mbs.scene.assembly import Model, choice_attributes
from mbs.scene.choices import VARIED
from mbs.scene.scene import Scene
from mbs.scene.subject import LawChoice, Subject
from mbs.settings import CampbellSettings, RunUp
from mbs.spectral.campbell import campbell
from mbs.spectral.levels import LevelDifference, Reference, at_equal_speeds
from mbs.spectral.run_signal import RunSignal

MOST_VARIANTS = 100

STOPPED = "stopped, no result"

_OPTION = re.compile(r"^--[\w-]+: ")


@dataclass(frozen=True)
class Variation:
    """One change of what is compared.

    Attributes
    ----------
    key : str
        A name of `mbs.scene.choices.VARIED`.
    value : object
        Value of the key, in SI; a text is read as `--vary` reads it.
    """

    key: str
    value: Any

    def __post_init__(self) -> None:
        if isinstance(self.value, str) and self.key in VARIED:
            object.__setattr__(self, "value", VARIED[self.key].read(self.value))

    @property
    def text(self) -> str:
        """The value for people."""
        return VARIED[self.key].text(self.value)


@dataclass(frozen=True)
class Variant:
    """Result of a change.

    Attributes
    ----------
    key, value : str
        What was changed, and to what; empty for the base.
    differences : tuple of LevelDifference
        Differences of the sum levels, second law beside the first, of each sensor; none where there is no result.
    problem : str
        Why there is none, else empty.
    outside : dict of str to int
        How often each bearing was evaluated outside its map, over both runs.
    """

    key: str
    value: str
    differences: tuple[LevelDifference, ...]
    problem: str
    outside: dict[str, int]

    @property
    def words(self) -> str:
        """Key and value."""
        return f"{self.key} {self.value}" if self.key else "base"


@dataclass(frozen=True, eq=False)
class VariantsResult:
    """Differences between two laws under single changes.

    Attributes
    ----------
    settings : CampbellSettings
        What was looked at.
    course : RunUp
        The run of the base.
    models : tuple of Model
        The base with the first law and with the second.
    labels : tuple of str
        The two laws.
    sensors : tuple of Sensor
        Whose signals are compared.
    variants : tuple of Variant
        The base, and each change.
    runs : int
        How many runs were made.
    dataset : xarray.Dataset
        What `mbs variants -o` writes.
    """

    settings: CampbellSettings
    course: RunUp
    models: tuple[Model, Model]
    labels: tuple[str, str]
    sensors: tuple[Sensor, ...]
    variants: tuple[Variant, ...]
    runs: int
    dataset: xr.Dataset

    @property
    def found(self) -> tuple[Variant, ...]:
        """Those with a result."""
        return tuple(entry for entry in self.variants if entry.differences)


@dataclass(frozen=True, eq=False)
class _Run:
    """A run that is to be made."""

    model: Model
    course: RunUp
    highest_order: float | None

    @property
    def samples(self) -> int:
        """Steps, and samples, of the run."""
        return round(self.course.duration / self.course.settings.sample)


@dataclass(frozen=True, eq=False)
class _Outcome:
    """Outcome of a run: sum level of each sensor with the speeds of its windows, or why there is none."""

    levels: tuple[tuple[FloatArray, FloatArray], ...]
    outside: dict[str, int]
    problem: str = ""


def variants(
    scene: Scene,
    laws: tuple[LawChoice, LawChoice],
    variations: Sequence[Variation],
    clearance: float | None = None,
    settings: CampbellSettings | None = None,
    progress: Progress | None = None,
    *,
    keep_partial: bool = False,
    workers: Workers = 1,
) -> VariantsResult:
    """Run up with two laws, and again with each single change; compare the sum levels of all acceleration sensors.

    Parameters
    ----------
    scene : Scene
        The scene; its [runup] says how the speed goes.
    laws : (LawChoice, LawChoice)
        The reference, and what is compared with it.
    variations : sequence of Variation
        Changes, one at a time around the base.
    clearance : float, optional
        Diametral clearance of all bearings of the base [m]; that of the scene if left out.
    settings : CampbellSettings, optional
        Band and window; [campbell] of the scene if left out. Its sensor is not looked at.
    progress : callable, optional
        Told how many steps are done, and of how many, over all runs.
    keep_partial : bool
        Whether Ctrl-C returns the changes that have come to the end, if there are any; else it is raised.
    workers : int or concurrent.futures.Executor
        Number of processes among which the runs are divided, or what computes them in their place.

    Raises
    ------
    InputError
        With everything about scene, laws and changes that is not possible; before anything runs.
    AnalysisError
        If no comparison came to the end. If some did, the others say in `Variant.problem` why they did not.

    Examples
    --------
    The shipped scene takes some seconds::

        dry, film = LawChoice("dry Hertz", "hertz"), LawChoice("film formula", "formula")
        found = variants(read_scene("nu308_rigid"), (dry, film), [Variation("clearance", 20e-6)])
        found.dataset["median_difference"]
    """
    settings = settings or scene.campbell
    sensors = tuple(sensor for sensor in scene.sensors if sensor.quantity == "acceleration")
    runs, pairs = _planned(scene, laws, variations, clearance, settings, sensors)
    outcomes = _made(runs, sensors, settings, progress, keep_partial, workers)
    rows = tuple(_variant(change, pair, outcomes) for change, pair in zip([None, *variations], pairs, strict=True))
    if not any(row.differences for row in rows):
        raise AnalysisError("\n".join(f"warning: {row.words}: {row.problem}" for row in rows))
    first, second = (runs[place].model for place in pairs[0])
    base = (held(first), held(second)) if rows[0].differences else (first, second)
    labels = laws[0].label, laws[1].label
    dataset = described(
        variants_dataset(rows, sensors),
        scene=scene.name,
        scene_toml=scene.text,
        law=f"{labels[0]}: {base[0].law}; {labels[1]}: {base[1].law}",
        **choice_attributes(list(zip(labels, base, strict=True))),
    )
    course = runs[pairs[0][0]].course
    return VariantsResult(settings, course, base, labels, sensors, rows, len(outcomes), dataset)


def _planned(
    scene: Scene,
    laws: tuple[LawChoice, LawChoice],
    variations: Sequence[Variation],
    clearance: float | None,
    settings: CampbellSettings,
    sensors: tuple[Sensor, ...],
) -> tuple[list[_Run], list[tuple[int, int]]]:
    """All different runs, and which two of them each comparison is of; all problems at once."""
    problems = Problems()
    if not sensors:
        names = ", ".join(sensor.name for sensor in scene.sensors)
        problems.append(
            f"{scene.name}: got the sensors {names or 'none'}; allowed: at least one [[sensors]] of an acceleration"
        )
    if len(variations) > MOST_VARIANTS:
        problems.append(f"--vary: got {len(variations)} values; allowed: at most {MOST_VARIANTS}")
    problems.check()
    bases = tuple(Subject(scene, law, clearance) for law in laws)
    runs: list[_Run] = []
    places: dict[str, int] = {}
    pairs = []
    for change in (None, *variations):
        where = f"--vary {change.key} {change.text}" if change else scene.name
        pair = []
        for subject, first in zip(bases, (True, False), strict=True):
            try:
                changed = VARIED[change.key].varied(subject, change.value, first) if change else subject
                pair.append(_place(changed, settings, runs, places))
            except InputError as error:
                problems += [
                    text if text.startswith("--") and not change else f"{where}: {_OPTION.sub('', text)}"
                    for text in error.problems
                ]
        pairs.append((pair[0], pair[-1]) if pair else (0, 0))
        if problems and not change:
            # What is wrong about the base is wrong about each change of it.
            break
    problems.check()
    return runs, pairs


def _place(subject: Subject, settings: CampbellSettings, runs: list[_Run], places: dict[str, int]) -> int:
    """Index of the run of a subject among all runs; the run is appended where it is a new one."""
    asked = (
        f"{_law_content(subject)} {subject.law.films} {subject.law.supply!r} {subject.clearance!r} {subject.scene!r}"
    )
    if asked not in places:
        model = subject.model()
        # Films, oil supply and clearance that were not named are those that the model has.
        same = f"{_law_content(subject)} {model.memory} {model.supplies!r} {model.scene!r}"
        if same not in places:
            problems: list[str] = []
            course = run_course(subject.scene, settings.highest, problems)
            if problems or course is None:
                raise InputError(problems)
            order = max((order for order, _ in followed_orders(model, settings, course)), default=None)
            if not any(run.course == course and run.highest_order == order for run in runs):
                campbell(silent_run(course), 1.0, settings.highest, settings.window, order)
            # Bad input is said before anything runs; a bearing that runs away is said in its row.
            with contextlib.suppress(AnalysisError):
                held(model)
            places[same] = len(runs)
            runs.append(_Run(model, course, order))
        places[asked] = places[same]
    return places[asked]


def _law_content(subject: Subject) -> str:
    """The law of a subject without its films and their oil supply, as a text: the same text, the same law."""
    return f"{subject.law.name} {id(subject.law.maps)}"


def _made(
    runs: Sequence[_Run],
    sensors: tuple[Sensor, ...],
    settings: CampbellSettings,
    progress: Progress | None,
    keep_partial: bool,
    workers: Workers,
) -> list[_Outcome]:
    """Make all runs, side by side; fewer where they were stopped."""
    found: list[_Outcome] = []
    outcomes = side_by_side(
        partial(_outcome, sensors, settings),
        runs,
        [run.samples for run in runs],
        workers,
        progress,
        lambda index: f"run {index + 1} of {len(runs)}",
    )
    try:
        for entry in outcomes:
            # Where a run has no result the others are worth minutes; keep them.
            found.append(_Outcome((), {}, str(entry.error)) if isinstance(entry, Failed) else entry)
    except KeyboardInterrupt:
        if not (keep_partial and len(found) > 1):
            raise
    return found


def _outcome(
    sensors: tuple[Sensor, ...], settings: CampbellSettings, run: _Run, told: Callable[[int], None]
) -> _Outcome:
    """Make a run."""
    try:
        record = recorded_run(held(run.model), run.course, sensors, told)
    except AnalysisError as error:
        return _Outcome((), {}, str(error))
    levels = []
    for column, sensor in enumerate(sensors):
        signal = RunSignal(record.time, record.speed, record.angle, record.signals[:, column])
        reference = Reference.of(sensor).value
        found = campbell(signal, reference, settings.highest, settings.window, run.highest_order)
        levels.append((found.speeds, found.sum_level))
    return _Outcome(tuple(levels), {name: calls for name, calls in record.outside.items() if calls})


def _variant(change: Variation | None, pair: tuple[int, int], outcomes: Sequence[_Outcome]) -> Variant:
    """The comparison of two runs."""
    key, value = (change.key, change.text) if change else ("", "")
    made = [outcomes[place] for place in pair if place < len(outcomes)]
    problem = "; ".join(dict.fromkeys(entry.problem for entry in made if entry.problem))
    if len(made) < len(pair):
        problem = problem or STOPPED
    if problem:
        return Variant(key, value, (), problem, {})
    # A drive reaches other speeds against other torques of rolling.
    pairs = [at_equal_speeds(*first, *other) for first, other in zip(made[0].levels, made[1].levels, strict=True)]
    differences = tuple(LevelDifference.of(*both) for both in pairs if both is not None)
    if len(differences) < len(pairs):
        return Variant(key, value, (), "the two runs have no speeds in common", {})
    outside = {name: sum(entry.outside.get(name, 0) for entry in made) for entry in made for name in entry.outside}
    return Variant(key, value, differences, "", outside)


_QUANTITIES = (
    ("median_difference", "median", "median of the differences of the sum level at the same speed"),
    ("low_difference", "low", "5 % of the windows differ by less"),
    ("high_difference", "high", "95 % of the windows differ by less"),
    ("energy_difference", "energy", "difference of the mean energies of all windows"),
    ("highest_difference", "highest", "difference of the highest sum levels, at any speed"),
)


def variants_dataset(rows: Sequence[Variant], sensors: Sequence[Sensor]) -> xr.Dataset:
    """The table of all changes and sensors; NaN where there is no result.

    Parameters
    ----------
    rows : sequence of Variant
        The base and all changes.
    sensors : sequence of Sensor
        The sensors, in the order of `Variant.differences`.
    """
    unknown, of_both = [np.nan] * len(sensors), ("variant", "sensor")
    variables: dict[str, Any] = {}
    for name, part, words in _QUANTITIES:
        values = [[getattr(entry, part) for entry in row.differences] or unknown for row in rows]
        variables[name] = variable(
            of_both, np.array(values, dtype=np.float64), "dB", f"{words}, second law minus first"
        )
    texts = {
        name: variable("variant", [str(getattr(row, name)) for row in rows], "", words)
        for name, words in (
            ("key", "what was changed; empty for the base"),
            ("value", "to what it was changed"),
            ("problem", "why there is no result"),
        )
    }
    calls = np.array([sum(row.outside.values()) for row in rows], dtype=np.int64)
    outside = {"outside_calls": variable("variant", calls, "1", "law calls outside the map")}
    return xr.Dataset(
        {**variables, **texts, **outside},
        coords={"sensor": [sensor.name for sensor in sensors]},
        attrs={"reference": "; ".join(dict.fromkeys(Reference.of(sensor).text for sensor in sensors))},
    )
